//! The arc sine distribution, JCGM 101 6.4.6.

use std::f64::consts::PI;

use gumption_lanes::Sampler;
use gumption_lanes::quantile::Quantile;

use super::stating::{
    Given, HALF_WIDTH, LOWER, ParameterError, ParameterRule, Parametric, Spread, UPPER, Width,
    Word, ascending,
};
use super::symmetric::{Symmetric, symmetric};
use super::univariate::{Kind, Parameter, Univariate};

/// U-shaped (arc sine), 6.4.6.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arcsine {
    /// Lower limit a.
    pub lower: f64,
    /// Upper limit b.
    pub upper: f64,
}

impl Univariate for Arcsine {
    const KIND: Kind = Kind {
        key: "arcsine",
        aliases: &[
            "u",
            "u-shape",
            "u-shaped",
            "arc-sine",
            "arcsin",
            "反正弦",
            "反正弦分布",
            "u形",
            "u型",
            "u形分布",
            "u型分布",
            "ushaped",
            "sine",
            "sinusoidal",
            "正弦",
            "正弦分布",
        ],
        name_en: "arc sine (U-shaped)",
        name_zh: "反正弦分布",
        parameters: "U(a, b)",
        expectation: "(a + b)/2",
        variance: "(b - a)²/8",
        source: "JCGM 101:2008, 6.4.6",
        use_when: "the quantity swings sinusoidally between the limits (temperature control, \
                   mismatch of unknown phase)",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[LOWER, UPPER, HALF_WIDTH];

    const WORD: Word = Word::Limits;

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        given.between(|lower, upper| Ok(Arcsine { lower, upper }))
    }

    fn of_width(width: Width, _: f64, how: &str) -> Result<Spread<Self>, ParameterError> {
        Ok(Spread::symmetric(width, (2.0, "2"), how, |a| Arcsine {
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
        Arcsine {
            lower: self.lower * by,
            upper: self.upper * by,
        }
    }

    /// JCGM 101 6.4.6.4.
    fn variance(&self) -> Option<f64> {
        Some((self.upper - self.lower).powi(2) / 8.0)
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        Some(3.0 / 128.0 * (self.upper - self.lower).powi(4))
    }

    fn sampler(&self) -> Sampler {
        let Arcsine { lower, upper } = *self;
        Sampler::Arcsine { lower, upper }
    }

    fn block_quantile(&self) -> Option<Quantile> {
        let Arcsine { lower, upper } = *self;
        Some(Quantile::Arcsine { lower, upper })
    }
}

impl Symmetric for Arcsine {
    fn ends(&self) -> [f64; 2] {
        [self.lower, self.upper]
    }

    fn beyond(&self, u: f64) -> f64 {
        libm::asin((0.5 * (1.0 - u)).sqrt()) * 2.0 / PI
    }

    fn inward(&self, q: f64) -> f64 {
        2.0 * libm::sin(0.5 * PI * q).powi(2)
    }
}
