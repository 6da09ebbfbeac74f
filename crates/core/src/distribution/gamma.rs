//! The gamma distribution with origin, JCGM 101 6.4.11.

use gumption_fault::{Said, say};
use gumption_lanes::Sampler;

use super::stating::{Given, ORIGIN, ParameterError, ParameterRule, Parametric, finite, positive};
use super::univariate::{Kind, Parameter, Univariate};
use crate::special::{
    gamma_regularized, gamma_regularized_upper, inverse_gamma_regularized,
    inverse_gamma_regularized_upper,
};

/// Gamma with origin, 6.4.11: `origin + G(shape, scale)`; mean `origin + shape·scale`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gamma {
    /// Smallest value.
    pub origin: f64,
    /// Shape parameter.
    pub shape: f64,
    /// Scale parameter.
    pub scale: f64,
}

impl Univariate for Gamma {
    const KIND: Kind = Kind {
        key: "gamma",
        aliases: &[],
        name_en: "gamma",
        name_zh: "伽马分布",
        parameters: "G(α, θ), shape α, scale θ",
        expectation: "α·θ",
        variance: "α·θ²",
        source: "JCGM 101:2008, 6.4.11",
        use_when: "the quantity is the expectation of a count, or positive with a long upper tail",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        ORIGIN,
        ParameterRule::number("shape", "Shape."),
        ParameterRule::number("scale", "Scale."),
    ];

    fn in_place_of(parameter: &str) -> Option<Said> {
        ["rate", "beta", "lambda"].contains(&parameter).then(|| {
            say!(
                "the scale is 1/{parameter}: gamma = {{ shape = …, scale = … }}, with the mean shape · scale"
            )
        })
    }

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        let (shape, scale) = (given.number("shape")?, given.number("scale")?);
        let origin = given.optional("origin").unwrap_or(0.0);
        Ok(Parametric::located(
            Gamma {
                origin,
                shape,
                scale,
            },
            format!("shape = {shape}, scale = {scale}"),
        ))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        finite("origin", self.origin)?;
        positive("shape", self.shape)?;
        positive("scale", self.scale)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: origin, shape, scale)
    }

    fn shifted(&self, by: f64) -> Self {
        Gamma {
            origin: self.origin + by,
            ..*self
        }
    }

    fn stretched(&self, by: f64) -> Self {
        Gamma {
            origin: self.origin * by,
            scale: self.scale * by,
            ..*self
        }
    }

    fn of_counts(&self, counts: f64) -> Option<Self> {
        Some(Gamma {
            origin: -counts,
            shape: counts,
            ..*self
        })
    }

    fn mean(&self) -> Option<f64> {
        Some(self.origin + self.shape * self.scale)
    }

    fn variance(&self) -> Option<f64> {
        Some(self.shape * self.scale * self.scale)
    }

    fn third_central_moment(&self) -> Option<f64> {
        Some(2.0 * self.shape * self.scale.powi(3))
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        Some(3.0 * self.shape * (self.shape + 2.0) * self.scale.powi(4))
    }

    fn cdf(&self, x: f64) -> f64 {
        gamma_regularized(self.shape, ((x - self.origin) / self.scale).max(0.0))
    }

    fn sf(&self, x: f64) -> f64 {
        gamma_regularized_upper(self.shape, ((x - self.origin) / self.scale).max(0.0))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.origin + self.scale * inverse_gamma_regularized(self.shape, p)
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        self.origin + self.scale * inverse_gamma_regularized_upper(self.shape, q)
    }

    fn support(&self) -> (f64, f64) {
        (self.origin, f64::INFINITY)
    }

    fn sampler(&self) -> Sampler {
        let Gamma {
            origin,
            shape,
            scale,
        } = *self;
        Sampler::Gamma {
            origin,
            shape,
            scale,
        }
    }
}
