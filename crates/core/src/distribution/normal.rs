//! The normal distribution, JCGM 101 6.4.7.

use gumption_fault::Said;
use gumption_lanes::Sampler;
use gumption_lanes::quantile::OfScore;

use super::stating::{
    Bell, Given, ParameterError, ParameterRule, Parametric, Word, finite, in_place_of_variance,
    positive,
};
use super::univariate::{Kind, Parameter, Univariate};
use crate::special::{normal_cdf, normal_quantile, normal_sf};

/// N(mean, sd²), JCGM 101 6.4.7.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Normal {
    /// Expectation µ.
    pub mean: f64,
    /// Standard deviation σ.
    pub sd: f64,
}

impl Univariate for Normal {
    const KIND: Kind = Kind {
        key: "normal",
        aliases: &["gaussian", "gauss", "正态", "正态分布"],
        name_en: "normal (Gaussian)",
        name_zh: "正态分布",
        parameters: "N(x, u²)",
        expectation: "x",
        variance: "u²",
        source: "JCGM 101:2008, 6.4.7",
        use_when: "an estimate and its standard uncertainty are known and nothing more, or many \
                   small effects add up",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        ParameterRule::number("mean", "Expectation; the value when left out."),
        ParameterRule::number("sd", "Standard deviation."),
    ];

    const WORD: Word = Word::Bell(Bell::Normal);

    fn in_place_of(parameter: &str) -> Option<Said> {
        in_place_of_variance(parameter)
    }

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        let sd = given.number("sd")?;
        let mean = given.optional("mean");
        Ok(Parametric {
            distribution: Normal {
                mean: mean.unwrap_or(0.0),
                sd,
            },
            located: mean.is_some(),
            limits: None,
            how: format!("sd = {sd}"),
        })
    }

    fn validate(&self) -> Result<(), ParameterError> {
        finite("mean", self.mean)?;
        positive("sd", self.sd)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: mean, sd)
    }

    fn shifted(&self, by: f64) -> Self {
        Normal {
            mean: self.mean + by,
            ..*self
        }
    }

    fn stretched(&self, by: f64) -> Self {
        Normal {
            mean: self.mean * by,
            sd: self.sd * by,
        }
    }

    fn mirrored(&self) -> Option<Self> {
        Some(Normal {
            mean: -self.mean,
            ..*self
        })
    }

    fn is_normal(&self) -> bool {
        true
    }

    fn mean(&self) -> Option<f64> {
        Some(self.mean)
    }

    fn variance(&self) -> Option<f64> {
        Some(self.sd * self.sd)
    }

    fn third_central_moment(&self) -> Option<f64> {
        Some(0.0)
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        Some(3.0 * self.sd.powi(4))
    }

    fn cdf(&self, x: f64) -> f64 {
        normal_cdf((x - self.mean) / self.sd)
    }

    fn sf(&self, x: f64) -> f64 {
        normal_sf((x - self.mean) / self.sd)
    }

    fn quantile(&self, p: f64) -> f64 {
        self.mean + self.sd * normal_quantile(p)
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        self.mean - self.sd * normal_quantile(q)
    }

    fn support(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn sampler(&self) -> Sampler {
        let Normal { mean, sd } = *self;
        Sampler::Normal { mean, sd }
    }

    fn of_score(&self) -> Option<OfScore> {
        let Normal { mean, sd } = *self;
        Some(OfScore::Normal { mean, sd })
    }
}
