//! The rectangular distribution, JCGM 101 6.4.2.

use std::f64::consts::PI;

use gumption_lanes::Sampler;
use gumption_lanes::quantile::Quantile;

use super::stating::{
    Given, HALF_WIDTH, LOWER, ParameterError, ParameterRule, Parametric, Spread, UPPER, Width,
    Word, ascending,
};
use super::symmetric::{Symmetric, symmetric};
use super::univariate::{Kind, Latent, Parameter, Univariate};
use super::{trapezoidal, triangular};

/// Rectangular R(lower, upper), JCGM 101 6.4.2.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uniform {
    /// Lower limit a.
    pub lower: f64,
    /// Upper limit b.
    pub upper: f64,
}

impl Univariate for Uniform {
    const KIND: Kind = Kind {
        key: "uniform",
        aliases: &[
            "rectangular",
            "rectangle",
            "rect",
            "矩形",
            "均匀",
            "矩形分布",
            "均匀分布",
        ],
        name_en: "rectangular",
        name_zh: "矩形分布(均匀分布)",
        parameters: "R(a, b), limits a < b",
        expectation: "(a + b)/2",
        variance: "(b - a)²/12",
        source: "JCGM 101:2008, 6.4.2",
        use_when: "only a lower and an upper limit are known (digital resolution, tolerance)",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[LOWER, UPPER, HALF_WIDTH];

    const WORD: Word = Word::Limits;

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        given.between(|lower, upper| Ok(Uniform { lower, upper }))
    }

    fn of_width(width: Width, _: f64, how: &str) -> Result<Spread<Self>, ParameterError> {
        Ok(Spread::symmetric(width, (3.0, "3"), how, |a| Uniform {
            lower: -a,
            upper: a,
        }))
    }

    fn half_width(&self) -> Option<f64> {
        Some(0.5 * (self.upper - self.lower))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        ascending(self.lower, self.upper)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: lower, upper)
    }

    symmetric!();

    fn stretched(&self, by: f64) -> Self {
        Uniform {
            lower: self.lower * by,
            upper: self.upper * by,
        }
    }

    fn latent_correlation(&self, _: &Self) -> Option<Latent> {
        Some(Latent {
            smallest: -1.0,
            largest: 1.0,
            of: Box::new(|r| 2.0 * libm::sin(PI * r / 6.0)),
        })
    }

    /// JCGM 101 6.4.2.4.
    fn variance(&self) -> Option<f64> {
        Some((self.upper - self.lower).powi(2) / 12.0)
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        Some((self.upper - self.lower).powi(4) / 80.0)
    }

    fn fits_cells(&self) -> bool {
        true
    }

    fn sampler(&self) -> Sampler {
        let Uniform { lower, upper } = *self;
        Sampler::Uniform { lower, upper }
    }

    fn block_quantile(&self) -> Option<Quantile> {
        let Uniform { lower, upper } = *self;
        Some(Quantile::Uniform { lower, upper })
    }
}

impl Symmetric for Uniform {
    fn ends(&self) -> [f64; 2] {
        [self.lower, self.upper]
    }

    fn beyond(&self, u: f64) -> f64 {
        0.5 * (1.0 - u)
    }

    fn inward(&self, q: f64) -> f64 {
        2.0 * q
    }
}

/// What the sum of two rectangular variables with these half-widths is, in words: a trapezoid, or a triangle where
/// they are equal (JCGM 101 6.4.4 and 6.4.5).
pub fn kind_of_sum(a: f64, b: f64) -> &'static Kind {
    if (a - b).abs() <= 1e-9 * a {
        &triangular::Triangular::KIND
    } else {
        &trapezoidal::Trapezoidal::KIND
    }
}
