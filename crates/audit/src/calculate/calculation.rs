//! A calculation, right or with slips in it: from standard uncertainties to U.

use std::cell::RefCell;
use std::collections::HashMap;

use gumption_core::special::student_t_two_sided_quantile;
use gumption_core::statistics::effective_freedom_of;

use crate::claim::{Correlation, K_OF_RECTANGLE};

/// A calculation of U, right or with slips in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Calculation {
    /// The rows.
    pub lines: Vec<Line>,
    /// Correlations that are taken into account.
    pub correlations: Vec<Correlation>,
    /// How contributions are combined.
    pub combined: Combined,
    /// How ν_eff is found.
    pub freedom: Freedom,
    /// How k is found.
    pub factor: Factor,
    /// How U is made of k and u_c, and reported.
    pub report: Report,
}

/// One row of a calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Standard uncertainty.
    pub u: f64,
    /// Sensitivity coefficient.
    pub c: f64,
    /// What c·u is multiplied by to be in the unit of the result.
    pub to_y: f64,
    /// Degrees of freedom.
    pub dof: f64,
    /// Whether it enters the sum.
    pub counted: bool,
    /// A contribution that was typed in, instead of c·u.
    pub typed: Option<f64>,
}

/// How contributions are combined.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Combined {
    /// Root of the sum of squares and products.
    #[default]
    Root,
    /// Sum.
    Linear,
    /// Sum of squares.
    Squares,
    /// As `Root`, of contributions rounded to one digit, a five that is last of all in this direction.
    Rounded(Ties),
    /// As `Root`, the signs lost in the products.
    Unsigned,
    /// A number that was typed in.
    Typed(f64),
}

/// Where a last five goes: by hand up, or to the even digit; a program whose binary number is below it goes down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ties {
    /// Up.
    Up,
    /// Down.
    Down,
}

/// How ν_eff is found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Freedom {
    /// Welch–Satterthwaite, cut to a whole number.
    #[default]
    Welch,
    /// The same, rounded up.
    Up,
    /// Something else.
    Given(f64),
}

/// How k is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Factor {
    /// A number.
    Fixed(f64),
    /// t at ν_eff.
    StudentT(f64),
    /// t at other degrees of freedom: probability, ν.
    At(f64, f64),
    /// [`K_OF_RECTANGLE`] where one rectangle dominates, else 2.
    Rectangle,
}

/// How U is made of k and u_c, and reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Power of k in U.
    pub power: i32,
    /// What u_c is multiplied by in the place of k.
    pub factor: Option<f64>,
    /// A factor of units that does not belong there.
    pub scale: f64,
    /// Whether the CMC is heeded.
    pub cmc: bool,
    /// Whether U may be rounded down against the rule.
    pub down: bool,
    /// Whether U may have more digits than two.
    pub long: bool,
    /// Digits exchanged: in u_c, in U (which pair, from the front), or none.
    pub exchanged: Option<(Printout, usize)>,
}

/// A final figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Printout {
    /// u_c.
    Combined,
    /// U.
    Expanded,
}

impl Default for Report {
    fn default() -> Self {
        Report {
            power: 1,
            factor: None,
            scale: 1.0,
            cmc: true,
            down: false,
            long: false,
            exchanged: None,
        }
    }
}

/// Figures of the whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// Combined standard uncertainty.
    pub u_c: f64,
    /// Effective degrees of freedom, not cut.
    pub nu_eff: f64,
    /// Coverage factor, not rounded.
    pub k: f64,
    /// Expanded uncertainty, before rounding.
    pub expanded: f64,
}

impl Report {
    /// How many times u_c U is.
    pub fn multiple(&self, k: f64) -> f64 {
        let of_k = || libm::pow(k, f64::from(self.power));
        self.factor.unwrap_or_else(of_k)
    }
}

impl Line {
    /// Contribution, with its sign.
    pub fn contribution(&self) -> f64 {
        self.typed.unwrap_or(self.c * self.u * self.to_y)
    }
}

/// How near to a tie a double is one: some units of its last place, which multiplications leave.
const TIE: f64 = 1e-12;

impl Calculation {
    /// The figures, with these contributions in the place of the computed ones where there are some.
    pub fn figures(&self, printed: &[Option<f64>], cmc: Option<f64>) -> Figures {
        let contribution = |i: usize| -> f64 {
            let line = &self.lines[i];
            if !line.counted {
                return 0.0;
            }
            let computed = line.contribution();
            let one_digit = |x: f64, ties: Ties| {
                use gumption_core::quantity::{Decimal, Rounding};
                // A hair to its side decides a tie, and nothing else.
                let hair = match ties {
                    Ties::Up => 1.0 + TIE,
                    Ties::Down => 1.0 - TIE,
                };
                Decimal::from_f64(x * hair)
                    .round_to_significant(1, Rounding::HalfUp)
                    .to_f64()
            };
            let x = printed
                .get(i)
                .copied()
                .flatten()
                .map_or(computed, |p| p.abs().copysign(computed));
            match self.combined {
                Combined::Rounded(ties) => one_digit(x, ties),
                _ => x,
            }
        };
        let parts: Vec<f64> = (0..self.lines.len()).map(contribution).collect();
        let u_c = self.combine(&parts);
        let nu_eff = match self.freedom {
            Freedom::Given(nu) => nu,
            _ => {
                let lines = parts.iter().zip(&self.lines);
                let told = lines.filter(|(_, line)| line.dof > 0.0);
                effective_freedom_of(u_c, told.map(|(part, line)| (*part, line.dof)))
            }
        };
        let k = self.factor.value(self.whole(nu_eff), &parts, u_c);
        let expanded = self.report.multiple(k) * u_c;
        let floor = cmc.filter(|_| self.report.cmc).unwrap_or(0.0);
        Figures {
            u_c,
            nu_eff,
            k,
            expanded: expanded.max(floor) * self.report.scale,
        }
    }

    /// ν_eff as k is looked up.
    pub fn whole(&self, nu_eff: f64) -> f64 {
        match self.freedom {
            // What is printed as a whole number within a few units of the last digits of doubles is that number.
            Freedom::Welch | Freedom::Given(_) => libm::floor(nu_eff * (1.0 + 1e-9)).max(1.0),
            Freedom::Up => libm::ceil(nu_eff),
        }
    }

    fn combine(&self, parts: &[f64]) -> f64 {
        if let Combined::Typed(u_c) = self.combined {
            return u_c;
        }
        if self.combined == Combined::Linear {
            return parts.iter().map(|x| x.abs()).sum();
        }
        let mut sum: f64 = parts.iter().map(|x| x * x).sum();
        for Correlation { a, b, r, .. } in &self.correlations {
            let product = parts[*a] * parts[*b];
            sum += 2.0
                * r
                * if self.combined == Combined::Unsigned {
                    product.abs()
                } else {
                    product
                };
        }
        let sum = sum.max(0.0);
        if self.combined == Combined::Squares {
            sum
        } else {
            libm::sqrt(sum)
        }
    }
}

impl Factor {
    fn value(self, nu: f64, parts: &[f64], u_c: f64) -> f64 {
        match self {
            Factor::Fixed(k) => k,
            Factor::StudentT(p) => t(p, nu),
            Factor::At(p, nu) => t(p, nu),
            Factor::Rectangle => {
                let largest = parts.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                match dominates(largest, u_c) {
                    true => K_OF_RECTANGLE,
                    false => 2.0,
                }
            }
        }
    }
}

/// Whether the rest is at most 0.3 of the largest contribution (EA-4/02 M:2022, S9.14).
pub fn dominates(largest: f64, u_c: f64) -> bool {
    let rest = libm::sqrt((u_c * u_c - largest * largest).max(0.0));
    // Of an infinite u_c nothing is known of the rest.
    u_c.is_finite() && rest <= 0.3 * largest
}

/// The factor of a two-sided interval.
pub fn t(p: f64, nu: f64) -> f64 {
    // A search looks the same few factors up thousands of times.
    thread_local!(static KNOWN: RefCell<HashMap<(u64, u64), f64>> = RefCell::default());
    let quantile = || student_t_two_sided_quantile(p, nu.max(1.0));
    KNOWN.with_borrow_mut(|known| {
        *known
            .entry((p.to_bits(), nu.to_bits()))
            .or_insert_with(quantile)
    })
}
