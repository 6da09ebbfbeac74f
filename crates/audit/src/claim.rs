//! A claim: what a laboratory states and what it says it computed from it, as read.

use crate::printed::{Place, Printed};
use gumption_core::special::normal_cdf;

/// One budget as somebody claims it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Claimed {
    /// Title, where there is one.
    pub title: String,
    /// Name of the result.
    pub measurand: String,
    /// Unit of the result, as written; empty for one.
    pub unit: String,
    /// The rows.
    pub rows: Vec<Row>,
    /// Below how many of them each subtotal stands.
    pub subtotals: Vec<usize>,
    /// The right side of the measurement model, as written.
    pub model: Option<String>,
    /// Stated correlations between rows.
    pub correlations: Vec<Correlation>,
    /// How k is to be found.
    pub coverage: Coverage,
    /// How U is to be rounded.
    pub rounding: RoundingStated,
    /// The smallest U that the laboratory may report, in the unit of U.
    pub cmc: Option<Printed>,
    /// Claimed figures of the whole.
    pub footer: Footer,
    /// The number of readings behind the reported value, where a note says so for all rows.
    pub reported_mean_of: Option<f64>,
    /// What notes know of quantities that no row has; rows of their own once the table is understood.
    pub absent: Vec<Row>,
    /// Everything that the sheet says beside its tables.
    pub words: String,
    /// Whether u_c is a number where the other computed cells are formulas.
    pub typed: bool,
    /// Whether u_c is a formula: the sheet went on with the numbers that its cells hold.
    pub computed: bool,
    /// Formulas that give another figure than their cells hold.
    pub stale: Vec<Stale>,
    /// How the columns and cells were understood.
    pub understood: Vec<Understood>,
    /// What could not be placed.
    pub unplaced: Vec<Unplaced>,
}

/// A formula that gives another figure than its cell holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Stale {
    /// The cell.
    pub at: Place,
    /// Its formula, without the equals sign.
    pub formula: String,
    /// What it gives.
    pub gives: f64,
}

/// Claimed figures of the whole.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Footer {
    /// The result.
    pub y: Option<Printed>,
    /// Combined standard uncertainty.
    pub u_c: Option<Printed>,
    /// Effective degrees of freedom.
    pub nu_eff: Option<Printed>,
    /// Coverage factor.
    pub k: Option<Printed>,
    /// Expanded uncertainty.
    pub expanded: Option<Printed>,
}

/// One row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row {
    /// Short name of the quantity.
    pub symbol: String,
    /// Name or source.
    pub name: String,
    /// Where the row begins.
    pub at: Place,
    /// Estimate.
    pub value: Option<Printed>,
    /// Unit of the estimate and of what is stated of it.
    pub unit: String,
    /// What stands behind one of its figures, in the place of a unit, and is none that is known.
    pub unread_unit: Option<Unplaced>,
    /// What its column of distributions says and is none that is known.
    pub unread_distribution: Option<Unplaced>,
    /// What its column of limits says where neither a figure nor words of it were understood.
    pub unread_used: Option<Unplaced>,
    /// What its column of coefficients says and is no number.
    pub unread_c: Option<Unplaced>,
    /// Everything that the sheet says of it in words: name, remarks, notes.
    pub words: String,
    /// What is known of it.
    pub stated: Stated,
    /// Whether what is stated is relative, as a fraction of what.
    pub relative: Relative,
    /// The ± column: what was used.
    pub used: Option<Printed>,
    /// The divisor.
    pub divisor: Option<Printed>,
    /// Standard uncertainty.
    pub u: Option<Printed>,
    /// Sensitivity coefficient.
    pub c: Option<Printed>,
    /// Contribution to u(y), as printed (with or without its sign).
    pub contribution: Option<Printed>,
    /// Degrees of freedom.
    pub dof: Option<Printed>,
    /// Why it is not to be counted, where the sheet says so.
    pub not_counted: Option<String>,
    /// Whether only a note knows of it, and the table has no such row.
    pub is_absent: bool,
    /// What the laboratory's own column calls the distribution.
    pub distribution: String,
    /// What its own column calls the type of evaluation.
    pub evaluation: String,
    /// The share in the variance that the sheet prints.
    pub share: Option<Printed>,
    /// Whether the row is hidden in its workbook.
    pub is_hidden: bool,
    /// Cells of the row that hold formulas.
    pub formulas: Vec<(Figure, String)>,
}

/// A computed figure of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// Standard uncertainty.
    U,
    /// Contribution.
    Contribution,
}

/// What is known of a quantity: the lowest level that the sheet states.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Stated {
    /// Nothing but what the columns of u or contribution say.
    #[default]
    Nothing,
    /// Expanded uncertainty of a certificate with its coverage factor (2 where it says none).
    Certificate {
        /// U.
        expanded: Printed,
        /// k.
        k: f64,
        /// Whether the certificate states k.
        k_stated: bool,
    },
    /// Limits ± a.
    Limits {
        /// a.
        half_width: Printed,
        /// Their distribution.
        shape: Shape,
        /// Whether the sheet says anything about the distribution beyond limits.
        shape_stated: bool,
    },
    /// A full width.
    FullWidth {
        /// The width.
        width: Printed,
        /// Its distribution.
        shape: Shape,
    },
    /// Step of a digital indication.
    Step {
        /// q.
        step: Printed,
    },
    /// Unequal limits.
    Unequal {
        /// Above.
        plus: Printed,
        /// Below, as a positive number.
        minus: Printed,
    },
    /// Standard deviation of single readings.
    Deviation {
        /// s.
        s: Printed,
        /// Readings from which s was computed.
        n: Option<f64>,
        /// Readings behind the reported value.
        m: f64,
        /// Degrees of freedom of a pooled s.
        pooled: Option<f64>,
    },
    /// Range of readings.
    Range {
        /// The range.
        range: Printed,
        /// Readings.
        n: f64,
        /// Readings behind the reported value.
        m: f64,
    },
    /// A standard uncertainty, as it is.
    Standard {
        /// u.
        u: Printed,
        /// Its degrees of freedom.
        dof: Option<f64>,
    },
}

/// C(n) of the range method for n = 2 … 9 and the degrees of freedom (JJF 1059.1-2012, table 1).
pub const RANGE: [(f64, f64); 8] = [
    (1.13, 0.9),
    (1.69, 1.8),
    (2.06, 2.7),
    (2.33, 3.6),
    (2.53, 4.5),
    (2.70, 5.3),
    (2.85, 6.0),
    (2.97, 6.8),
];

/// C(n) and ν of the range method, for 9 readings at most those of the table.
pub(crate) fn range_factor(n: f64) -> (f64, f64) {
    let table = (n as usize).max(2) - 2;
    RANGE
        .get(table)
        .copied()
        .unwrap_or_else(|| range_of_normal(n))
}

/// Expectation d₂ of the range of n standard normal readings, and the degrees of freedom d₂²/(2 d₃²) of its standard deviation
/// d₃, of which the table has rounded values: d₂ = ∫ 1 − Φⁿ − (1 − Φ)ⁿ, and the second moment is twice the integral over
/// x < y of 1 − Φ(y)ⁿ − (1 − Φ(x))ⁿ + (Φ(y) − Φ(x))ⁿ (L. H. C. Tippett, 1925).
fn range_of_normal(n: f64) -> (f64, f64) {
    const STEP: f64 = 0.1;
    const END: i32 = 80;
    let phi: Vec<f64> = (-END..=END)
        .map(|place| normal_cdf(f64::from(place) * STEP))
        .collect();
    let below: Vec<f64> = phi.iter().map(|phi| libm::pow(*phi, n)).collect();
    let above: Vec<f64> = phi.iter().map(|phi| libm::pow(1.0 - phi, n)).collect();
    let outer = below.iter().zip(&above);
    let mean: f64 = outer.map(|(below, above)| 1.0 - below - above).sum();
    let mut square = 0.0;
    for (y, below) in below.iter().enumerate() {
        for (x, above) in above[..=y].iter().enumerate() {
            let whole = 1.0 - below - above + libm::pow(phi[y] - phi[x], n);
            // The diagonal is an end of each inner integral.
            square += if x == y { whole } else { 2.0 * whole };
        }
    }
    // Trapezia of what ends flat are exact here. The inner integrals end on the diagonal with the slope nφ(1 − Φ)ⁿ⁻¹, whose
    // integral is 1: by Euler and Maclaurin they are too large by STEP²/12 together.
    let d2 = mean * STEP;
    let variance = square * STEP * STEP - STEP * STEP / 6.0 - d2 * d2;
    (d2, d2 * d2 / (2.0 * variance))
}

/// Distribution of limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Nothing but the limits.
    Rectangular,
    /// Triangle.
    Triangular,
    /// Cycling.
    Arcsine,
    /// Trapezoid with this ratio of top to bottom.
    Trapezoidal(f64),
    /// Normal, the limits being this many standard deviations.
    Normal(f64),
    /// Two values.
    TwoPoint,
}

impl Shape {
    /// Half-width divided by standard uncertainty (JCGM 100, 4.3; JCGM 101, 6.4).
    pub fn divisor(self) -> f64 {
        match self {
            Shape::Rectangular => libm::sqrt(3.0),
            Shape::Triangular => libm::sqrt(6.0),
            Shape::Arcsine => libm::sqrt(2.0),
            Shape::Trapezoidal(beta) => libm::sqrt(6.0 / (1.0 + beta * beta)),
            Shape::Normal(k) => k,
            Shape::TwoPoint => 1.0,
        }
    }
}

/// What a stated figure is a fraction of.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Relative {
    /// It is absolute.
    #[default]
    No,
    /// This fraction of the estimate for each unit (0.01 for percent).
    OfValue(f64),
    /// This fraction of the full scale, which is the second figure.
    OfFullScale(f64, f64),
}

/// A correlation coefficient between two rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correlation {
    /// One row.
    pub a: usize,
    /// The other.
    pub b: usize,
    /// The coefficient.
    pub r: f64,
    /// By how much it may differ from what the sheet computed with, because it was printed with these digits.
    pub open: f64,
}

/// The factor of a rectangle that dominates, 0.95·√3 (EA-4/02 M:2022, S9.14).
pub const K_OF_RECTANGLE: f64 = 1.65;

/// The rule for k.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Coverage {
    /// The sheet states none: k as claimed, 2 if none is.
    #[default]
    Unstated,
    /// A fixed factor.
    Fixed(f64),
    /// From t at ν_eff for this probability.
    StudentT(f64),
    /// [`K_OF_RECTANGLE`] where one rectangle dominates, else 2.
    Rectangle,
    /// [`K_OF_RECTANGLE`], because one rectangle dominates: so the sheet says.
    OfRectangle,
}

/// The rule for rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RoundingStated {
    /// None: to nearest or up.
    #[default]
    Unstated,
    /// To nearest.
    Nearest,
    /// Up.
    Up,
}

/// How a column or a line was understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Understood {
    /// Where it stands.
    pub at: Place,
    /// What stands there.
    pub text: String,
    /// As what it was taken.
    pub role: &'static str,
}

/// What could not be placed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unplaced {
    /// Where it stands.
    pub at: Place,
    /// What stands there.
    pub text: String,
}

impl Row {
    /// As the report calls it: its symbol, or its name.
    pub fn label(&self) -> &str {
        if self.symbol.is_empty() {
            &self.name
        } else {
            &self.symbol
        }
    }
}

/// What cells of a statement of Monte Carlo are taken as.
pub(crate) const OF_MONTE_CARLO: &str = "of Monte Carlo, not recomputed";

impl Claimed {
    /// Whether it states k or U of Monte Carlo, which its rows do not give.
    pub fn is_simulated(&self) -> bool {
        let mut roles = self.understood.iter().map(|read| read.role);
        roles.any(|role| role == OF_MONTE_CARLO)
    }

    /// Takes correlations of pairs that have none yet: what is said again is one correlation all the same.
    pub(crate) fn correlate(&mut self, found: Vec<Correlation>) {
        for new in found {
            let is_pair =
                |old: &Correlation| [(old.a, old.b), (old.b, old.a)].contains(&(new.a, new.b));
            if !self.correlations.iter().any(is_pair) {
                self.correlations.push(new);
            }
        }
    }

    /// Whether the cell of a figure holds something else than its formula gives.
    pub(crate) fn is_stale(&self, figure: &Printed) -> bool {
        self.stale.iter().any(|cell| cell.at == figure.at)
    }

    /// Whether nothing of what it states was computed: then there is nothing to hold a calculation against.
    pub(crate) fn computes_nothing(&self) -> bool {
        let Footer {
            u_c,
            nu_eff,
            expanded,
            ..
        } = &self.footer;
        // k alone is a rule, and no result.
        let whole = [u_c, nu_eff, expanded];
        whole.iter().all(|figure| figure.is_none())
            && self.is_summary()
            && self
                .rows
                .iter()
                // Without a model a coefficient is stated, and not computed.
                .all(|row| (row.c.is_none() || self.model.is_none()) && row.dof.is_none())
    }

    /// Whether the sheet is a summary, which states no standard uncertainty of a row.
    fn is_summary(&self) -> bool {
        self.rows
            .iter()
            .all(|row| row.u.is_none() && row.contribution.is_none())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of JJF 1059.1 to its digits, and d₂ and d₃ of control charts (ASTM E2587, table 2).
    #[test]
    fn ranges_of_normal_readings() {
        for (n, (c, dof)) in (2_u32..).zip(RANGE) {
            let found = range_of_normal(f64::from(n));
            assert!(
                (found.0 - c).abs() < 0.006 && (found.1 - dof).abs() < 0.06,
                "{n}: {found:?}"
            );
        }
        for (n, d2, d3) in [
            (10.0, 3.078, 0.797),
            (15.0, 3.472, 0.756),
            (25.0, 3.931, 0.708),
        ] {
            let (c, dof) = range_factor(n);
            let d = c / (2.0 * dof).sqrt();
            assert!(
                (c - d2).abs() < 0.001 && (d - d3).abs() < 0.001,
                "{n}: {c}, {d}"
            );
        }
    }
}
