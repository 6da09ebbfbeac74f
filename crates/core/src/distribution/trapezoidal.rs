//! The isosceles trapezoid, JCGM 101 6.4.4.

use gumption_lanes::Sampler;
use gumption_lanes::quantile::Quantile;

use super::stating::{
    Given, HALF_WIDTH, LOWER, ParameterError, ParameterRule, Parametric, Spread, UPPER, Width,
    Word, ascending, within,
};
use super::symmetric::{Symmetric, symmetric};
use super::univariate::{Kind, Parameter, Univariate};
use crate::quantity::show;

/// Isosceles trapezoid, 6.4.4; `beta` = top width / base width.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trapezoidal {
    /// Lower limit a.
    pub lower: f64,
    /// Upper limit b.
    pub upper: f64,
    /// Width of the top divided by width of the base.
    pub beta: f64,
}

const BETA: ParameterRule = ParameterRule::number(
    "beta",
    "Top width / base width, from 0 (a triangle) to 1 (a rectangle).",
);

impl Univariate for Trapezoidal {
    const KIND: Kind = Kind {
        key: "trapezoidal",
        aliases: &["trapezoid", "梯形", "梯形分布"],
        name_en: "trapezoidal",
        name_zh: "梯形分布",
        parameters: "Trap(a, b, β), top width β·(b - a)",
        expectation: "(a + b)/2",
        variance: "(b - a)²(1 + β²)/24",
        source: "JCGM 101:2008, 6.4.4",
        use_when: "two independent rectangular effects add up, or values near the limits are less \
                   likely than values near the middle",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[LOWER, UPPER, HALF_WIDTH, BETA];

    const WORD: Word = Word::LimitsAnd(BETA);

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        given.between(|lower, upper| {
            let beta = given.number("beta")?;
            Ok(Trapezoidal { lower, upper, beta })
        })
    }

    /// Variance a²(1 + β²)/6, 6.4.4.4.
    fn of_width(width: Width, beta: f64, how: &str) -> Result<Spread<Self>, ParameterError> {
        within("beta", beta, [0.0, 1.0])?;
        let divisor = 6.0 / (1.0 + beta * beta);
        let make = |a: f64| Trapezoidal {
            lower: -a,
            upper: a,
            beta,
        };
        Ok(Spread::symmetric(
            width,
            (divisor, &show(divisor)),
            how,
            make,
        ))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        ascending(self.lower, self.upper)?;
        within("beta", self.beta, [0.0, 1.0])
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: lower, upper, beta)
    }

    symmetric!();

    fn stretched(&self, by: f64) -> Self {
        Trapezoidal {
            lower: self.lower * by,
            upper: self.upper * by,
            ..*self
        }
    }

    /// 6.4.4.4.
    fn variance(&self) -> Option<f64> {
        Some((self.upper - self.lower).powi(2) * (1.0 + self.beta * self.beta) / 24.0)
    }

    /// Of the sum of two rectangular variables.
    fn fourth_central_moment(&self) -> Option<f64> {
        let wide = 0.25 * (self.upper - self.lower) * (1.0 + self.beta);
        let narrow = 0.25 * (self.upper - self.lower) * (1.0 - self.beta);
        Some((wide.powi(4) + narrow.powi(4)) / 5.0 + 2.0 * wide * wide * narrow * narrow / 3.0)
    }

    fn kinks(&self) -> Vec<f64> {
        let slope = 0.5 * (1.0 - self.beta) * (self.upper - self.lower);
        vec![self.lower + slope, self.upper - slope]
    }

    fn fits_cells(&self) -> bool {
        true
    }

    fn sampler(&self) -> Sampler {
        let Trapezoidal { lower, upper, beta } = *self;
        Sampler::Trapezoidal { lower, upper, beta }
    }

    fn block_quantile(&self) -> Option<Quantile> {
        let Trapezoidal { lower, upper, beta } = *self;
        Some(Quantile::Trapezoidal { lower, upper, beta })
    }
}

impl Symmetric for Trapezoidal {
    fn ends(&self) -> [f64; 2] {
        [self.lower, self.upper]
    }

    /// Area of slope and top from the end inwards; the whole area is 1 + β.
    fn beyond(&self, u: f64) -> f64 {
        let (inward, slope) = (1.0 - u, 1.0 - self.beta);
        if inward < slope {
            0.5 * inward * inward / (slope * (1.0 + self.beta))
        } else {
            (inward - 0.5 * slope) / (1.0 + self.beta)
        }
    }

    fn inward(&self, q: f64) -> f64 {
        let slope = 1.0 - self.beta;
        let at_knee = 0.5 * slope / (1.0 + self.beta);
        if q < at_knee {
            (2.0 * q * slope * (1.0 + self.beta)).sqrt()
        } else {
            q * (1.0 + self.beta) + 0.5 * slope
        }
    }
}
