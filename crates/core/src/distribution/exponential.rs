//! The exponential distribution with origin, JCGM 101 6.4.10.

use gumption_fault::{Said, say};
use gumption_lanes::Sampler;
use gumption_lanes::quantile::Quantile;

use super::stating::{Given, ORIGIN, ParameterError, ParameterRule, Parametric, finite, positive};
use super::univariate::{Kind, Parameter, Univariate};

/// Exponential with origin, 6.4.10: `origin + Ex(1/mean)`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exponential {
    /// Smallest value.
    pub origin: f64,
    /// Expectation of the distance from the origin.
    pub mean: f64,
}

impl Univariate for Exponential {
    const KIND: Kind = Kind {
        key: "exponential",
        aliases: &[],
        name_en: "exponential",
        name_zh: "指数分布",
        parameters: "Ex(1/x), values above zero",
        expectation: "x",
        variance: "x²",
        source: "JCGM 101:2008, 6.4.10",
        use_when: "a quantity cannot be negative and only its estimate is known",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        ORIGIN,
        ParameterRule::number("mean", "Mean above the origin."),
    ];

    fn in_place_of(parameter: &str) -> Option<Said> {
        ["rate", "beta", "lambda"]
            .contains(&parameter)
            .then(|| say!("the mean is 1/{parameter}: exponential = {{ mean = … }}"))
    }

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        let mean = given.number("mean")?;
        let origin = given.optional("origin").unwrap_or(0.0);
        Ok(Parametric::located(
            Exponential { origin, mean },
            format!("mean = {mean}"),
        ))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        finite("origin", self.origin)?;
        positive("mean", self.mean)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: origin, mean)
    }

    fn shifted(&self, by: f64) -> Self {
        Exponential {
            origin: self.origin + by,
            ..*self
        }
    }

    fn stretched(&self, by: f64) -> Self {
        Exponential {
            origin: self.origin * by,
            mean: self.mean * by,
        }
    }

    fn mean(&self) -> Option<f64> {
        Some(self.origin + self.mean)
    }

    fn variance(&self) -> Option<f64> {
        Some(self.mean * self.mean)
    }

    fn third_central_moment(&self) -> Option<f64> {
        Some(2.0 * self.mean.powi(3))
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        Some(9.0 * self.mean.powi(4))
    }

    fn cdf(&self, x: f64) -> f64 {
        -libm::expm1(-((x - self.origin) / self.mean).max(0.0))
    }

    fn sf(&self, x: f64) -> f64 {
        libm::exp(-((x - self.origin) / self.mean).max(0.0))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.origin - self.mean * libm::log1p(-p)
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        self.origin - self.mean * libm::log(q)
    }

    fn support(&self) -> (f64, f64) {
        (self.origin, f64::INFINITY)
    }

    fn sampler(&self) -> Sampler {
        let Exponential { origin, mean } = *self;
        Sampler::Exponential { origin, mean }
    }

    fn block_quantile(&self) -> Option<Quantile> {
        let Exponential { origin, mean } = *self;
        Some(Quantile::Exponential { origin, mean })
    }
}
