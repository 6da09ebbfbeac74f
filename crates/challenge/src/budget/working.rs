//! The calculation of a laboratory, right or with slips in it.

use gumption_core::special::student_t_two_sided_quantile;

use super::laboratory::{Budget, Rounding, Rule};
use super::quantity::Step;
use super::words::plain;

/// A calculation before its figures.
#[derive(Debug, Clone)]
pub(super) struct Working {
    pub lines: Vec<Line>,
    pub sum: Sum,
    /// The coefficient that is used, if any.
    pub r: Option<(usize, usize, f64)>,
    pub signs_lost: bool,
    pub nu: Nu,
    pub k: Factor,
    pub power: i32,
    pub digits: usize,
    pub rounding: Rounding,
    pub down: bool,
    pub cmc: Option<f64>,
    /// Factor of a unit that does not belong to U.
    pub wrong_unit: bool,
    /// Which pair of digits of U, or of u_c, are exchanged.
    pub exchanged: Option<(bool, usize)>,
    /// What an unexplainable figure is multiplied by.
    pub strange: f64,
}

/// One row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub step: Step,
    pub c: f64,
    pub summed: bool,
    pub listed: bool,
    /// A number typed where a formula belongs.
    pub stale: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sum {
    Root,
    Linear,
    Squares,
    OneDigit,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Nu {
    Welch,
    Up,
    Total,
    Least,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Factor {
    Rule(Rule),
    OfReadings(f64),
}

/// Its figures.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Figures {
    pub u: Vec<f64>,
    pub contributions: Vec<f64>,
    pub u_c: f64,
    pub nu_eff: f64,
    pub k: f64,
    pub expanded: f64,
    /// U as it is reported.
    pub reported: String,
    /// u_c with digits exchanged, if they are.
    pub u_c_text: Option<String>,
}

impl Working {
    /// Without slips.
    pub(super) fn right(budget: &Budget) -> Working {
        let lines = budget.items.iter().map(|item| Line {
            step: item.known.right(item.blank.estimate),
            c: item.slope,
            summed: !item.contained,
            listed: true,
            stale: None,
        });
        Working {
            lines: lines.collect(),
            sum: Sum::Root,
            r: budget.correlation,
            signs_lost: false,
            nu: Nu::Welch,
            k: Factor::Rule(budget.rule),
            power: 1,
            digits: 2,
            rounding: budget.rounding,
            down: false,
            cmc: budget.cmc,
            wrong_unit: false,
            exchanged: None,
            strange: 1.0,
        }
    }

    /// Computes.
    pub(super) fn figures(&self) -> Figures {
        let u: Vec<f64> = self
            .lines
            .iter()
            .map(|line| line.step.used / line.step.divisor.value())
            .collect();
        let contributions: Vec<f64> = self
            .lines
            .iter()
            .zip(&u)
            .map(|(line, u)| line.stale.unwrap_or(line.c * u))
            .collect();
        let parts: Vec<f64> = self
            .lines
            .iter()
            .zip(&contributions)
            .map(|(line, part)| {
                let part = if line.summed && line.listed {
                    *part
                } else {
                    0.0
                };
                if self.sum == Sum::OneDigit {
                    plain(part, 1).parse().unwrap_or(part)
                } else {
                    part
                }
            })
            .collect();
        let mut squares: f64 = parts.iter().map(|part| part * part).sum();
        if let Some((a, b, r)) = self.r {
            let product = parts[a] * parts[b];
            squares += 2.0
                * r
                * if self.signs_lost {
                    product.abs()
                } else {
                    product
                };
        }
        let u_c = self.strange
            * match self.sum {
                Sum::Linear => parts.iter().map(|part| part.abs()).sum(),
                Sum::Squares => squares,
                _ => libm::sqrt(squares.max(0.0)),
            };
        let finite = || {
            self.lines
                .iter()
                .zip(&parts)
                .filter(|(line, part)| line.step.nu.is_finite() && **part != 0.0)
        };
        let welch = || {
            let below: f64 = finite()
                .map(|(line, part)| libm::pow(*part, 4.0) / line.step.nu)
                .sum();
            if below > 0.0 {
                libm::pow(u_c, 4.0) / below
            } else {
                f64::INFINITY
            }
        };
        let cut = |nu: f64| libm::floor(nu * (1.0 + 1e-12)).max(1.0);
        let nu_eff = match self.nu {
            Nu::Welch => cut(welch()),
            Nu::Up => libm::ceil(welch()),
            Nu::Total => finite().map(|(line, _)| line.step.nu).sum(),
            Nu::Least => finite()
                .map(|(line, _)| line.step.nu)
                .fold(f64::INFINITY, f64::min),
        };
        let k = match self.k {
            Factor::Rule(Rule::Two) => 2.0,
            Factor::Rule(Rule::Student(p)) => student(p, nu_eff),
            Factor::OfReadings(nu) => student(0.95, nu),
            Factor::Rule(Rule::Rectangle) => {
                let largest = parts.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                // EA-4/02 M:2022, S9.14: the rest is no more than 0.3 of the largest.
                if libm::sqrt((u_c * u_c - largest * largest).max(0.0)) <= 0.3 * largest {
                    1.65
                } else {
                    2.0
                }
            }
        };
        let k = libm::round(100.0 * k) / 100.0;
        let expanded = (libm::pow(k, f64::from(self.power)) * u_c).max(self.cmc.unwrap_or(0.0));
        let reported = self.reported(expanded);
        let (reported, u_c_text) = match self.exchanged {
            Some((true, pair)) => (exchanged(&reported, pair), None),
            Some((false, pair)) => (reported, Some(exchanged(&plain(u_c, 3), pair))),
            None => (reported, None),
        };
        Figures {
            u,
            contributions,
            u_c,
            nu_eff,
            k,
            expanded,
            reported,
            u_c_text,
        }
    }

    fn reported(&self, expanded: f64) -> String {
        let nearest = plain(expanded, self.digits);
        let value: f64 = nearest.parse().unwrap_or(expanded);
        let unit = libm::exp10(libm::floor(libm::log10(expanded)) - (self.digits as f64 - 1.0));
        if self.down {
            plain(libm::floor(expanded / unit + 1e-9) * unit, self.digits)
        } else if self.rounding == Rounding::Up && value < expanded * (1.0 - 1e-12) {
            plain(libm::ceil(expanded / unit - 1e-9) * unit, self.digits)
        } else {
            nearest
        }
    }
}

/// Factor of t for a probability.
pub(super) fn student(p: f64, nu: f64) -> f64 {
    student_t_two_sided_quantile(p, nu.clamp(1.0, 1e9))
}

/// The `pair`-th two neighbouring digits that differ, exchanged.
pub(super) fn exchanged(text: &str, pair: usize) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    let end = chars.iter().position(|c| *c == 'E').unwrap_or(chars.len());
    let digits: Vec<usize> = (0..end).filter(|i| chars[*i].is_ascii_digit()).collect();
    let first = digits.iter().position(|i| chars[*i] != '0').unwrap_or(0);
    let pairs: Vec<(usize, usize)> = digits[first..]
        .windows(2)
        .map(|w| (w[0], w[1]))
        .filter(|(a, b)| chars[*a] != chars[*b])
        .collect();
    if let Some((a, b)) = pairs.get(pair % pairs.len().max(1)) {
        chars.swap(*a, *b);
    }
    chars.into_iter().collect()
}
