//! The rectangle with inexactly known limits, JCGM 101 6.4.3.

use gumption_lanes::Sampler;

use super::stating::{
    Given, HALF_WIDTH, LOWER, ParameterError, ParameterRule, Parametric, Spread, UPPER, Width,
    Word, ascending, positive, within,
};
use super::symmetric::{Symmetric, symmetric};
use super::univariate::{Kind, Parameter, Univariate};
use crate::quantity::show;

/// Rectangular with inexactly known limits, 6.4.3: limits `lower ± d`, `upper ± d`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurvilinearTrapezoid {
    /// Nominal lower limit a.
    pub lower: f64,
    /// Nominal upper limit b.
    pub upper: f64,
    /// Greatest error of either limit.
    pub d: f64,
}

const D: ParameterRule = ParameterRule::number(
    "d",
    "Half-width of the doubt about each limit, at most the half-width between them.",
);

impl Univariate for CurvilinearTrapezoid {
    const KIND: Kind = Kind {
        key: "curvilinear-trapezoid",
        aliases: &["curvilinear-trapezoidal", "ctrap"],
        name_en: "curvilinear trapezoid",
        name_zh: "曲线梯形分布",
        parameters: "CTrap(a, b, d), limits a ± d and b ± d",
        expectation: "(a + b)/2",
        variance: "(b - a)²/12 + d²/9",
        source: "JCGM 101:2008, 6.4.3",
        use_when: "the limits themselves are known only to within ±d",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[LOWER, UPPER, HALF_WIDTH, D];

    const WORD: Word = Word::LimitsAnd(D);

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        given.between(|lower, upper| {
            let d = given.number("d")?;
            positive("d", d)?;
            Ok(CurvilinearTrapezoid { lower, upper, d })
        })
    }

    /// Variance a²/3 + d²/9, 6.4.3.4.
    fn of_width(width: Width, d: f64, how: &str) -> Result<Spread<Self>, ParameterError> {
        positive("d", d)?;
        let (a, u) = match width {
            Width::Half(a) => (a, (a * a / 3.0 + d * d / 9.0).sqrt()),
            Width::U(u) => ((3.0 * (u * u - d * d / 9.0)).max(0.0).sqrt(), u),
        };
        within("d", d, [0.0, a])?;
        Ok(Spread {
            distribution: CurvilinearTrapezoid {
                lower: -a,
                upper: a,
                d,
            },
            u,
            how: format!("√(a²/3 + d²/9), {how}, d = {}", show(d)),
        })
    }

    fn validate(&self) -> Result<(), ParameterError> {
        ascending(self.lower, self.upper)?;
        within("d", self.d, [0.0, 0.5 * (self.upper - self.lower)])
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: lower, upper, d)
    }

    symmetric!();

    fn stretched(&self, by: f64) -> Self {
        CurvilinearTrapezoid {
            lower: self.lower * by,
            upper: self.upper * by,
            d: self.d * by,
        }
    }

    /// 6.4.3.4.
    fn variance(&self) -> Option<f64> {
        Some((self.upper - self.lower).powi(2) / 12.0 + self.d * self.d / 9.0)
    }

    /// Of a rectangular variable times its rectangular half-width h ± d.
    fn fourth_central_moment(&self) -> Option<f64> {
        let (h, d) = (0.5 * (self.upper - self.lower), self.d);
        Some((h.powi(4) + 2.0 * h * h * d * d + d.powi(4) / 5.0) / 5.0)
    }

    fn kinks(&self) -> Vec<f64> {
        vec![self.lower + self.d, self.upper - self.d]
    }

    fn fits_cells(&self) -> bool {
        true
    }

    fn sampler(&self) -> Sampler {
        let CurvilinearTrapezoid { lower, upper, d } = *self;
        Sampler::CurvilinearTrapezoid { lower, upper, d }
    }
}

impl CurvilinearTrapezoid {
    /// With the support scaled to ±1: d, and where the level part ends (JCGM 101 6.4.3.2: half-width w, level to
    /// w − d, falling like ln((w + d)/u) to w + d).
    fn relative_d(&self) -> (f64, f64) {
        let w = 0.5 * (self.upper - self.lower);
        (self.d / (w + self.d), (w - self.d) / (w + self.d))
    }
}

impl Symmetric for CurvilinearTrapezoid {
    fn ends(&self) -> [f64; 2] {
        [self.lower - self.d, self.upper + self.d]
    }

    fn beyond(&self, u: f64) -> f64 {
        let inward = 1.0 - u;
        let (d, flat) = self.relative_d();
        if d == 0.0 {
            return 0.5 * inward;
        }
        if u >= flat {
            curved_area(inward) / (4.0 * d)
        } else {
            // The density is level from here to the middle.
            0.5 + u * libm::log(flat) / (4.0 * d)
        }
    }

    fn inward(&self, q: f64) -> f64 {
        let (d, flat) = self.relative_d();
        if d == 0.0 {
            return 2.0 * q;
        }
        let area = 4.0 * d * q;
        if area < curved_area(1.0 - flat) {
            curved_inward(area)
        } else {
            1.0 - (0.5 - q) * 4.0 * d / -libm::log(flat)
        }
    }
}

/// ∫ ln(1/v) dv from 1 − s to 1, that is s + (1 − s) ln(1 − s), without cancellation.
fn curved_area(s: f64) -> f64 {
    if s >= 1.0 {
        return 1.0;
    }
    if s > 0.1 {
        return s + (1.0 - s) * libm::log1p(-s);
    }
    // Σ sⁿ/(n(n−1)) from n = 2
    let mut power = s * s;
    let mut sum = 0.0;
    let mut n = 2.0;
    while power > 1e-18 * sum {
        sum += power / (n * (n - 1.0));
        power *= s;
        n += 1.0;
    }
    sum
}

/// Inverse of [`curved_area`], 0 ≤ area ≤ 1.
fn curved_inward(area: f64) -> f64 {
    if area >= 1.0 {
        return 1.0;
    }
    // The area is convex in s and not below s²/2: Newton's method descends to the root.
    let mut s = (2.0 * area).sqrt().min(1.0 - 1e-16);
    for _ in 0..60 {
        let step = (curved_area(s) - area) / -libm::log1p(-s);
        if step.is_nan() || step <= 1e-16 * s {
            break;
        }
        s -= step;
    }
    s
}
