//! The lognormal distribution with origin.

use gumption_fault::{Said, say};
use gumption_lanes::Sampler;
use gumption_lanes::quantile::OfScore;

use super::stating::{
    Given, ORIGIN, ParameterError, ParameterRule, Parametric, finite, in_place_of_variance,
    positive,
};
use super::univariate::{Kind, Latent, Parameter, Univariate};
use crate::special::{normal_cdf, normal_quantile, normal_sf};

/// `origin + exp(N(mu, sigma²))`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogNormal {
    /// Smallest value.
    pub origin: f64,
    /// Expectation of the logarithm.
    pub mu: f64,
    /// Standard deviation of the logarithm.
    pub sigma: f64,
}

impl Univariate for LogNormal {
    const KIND: Kind = Kind {
        key: "lognormal",
        aliases: &["log-normal", "对数正态"],
        name_en: "lognormal",
        name_zh: "对数正态分布",
        parameters: "LN(µ, σ²), normal logarithm",
        expectation: "exp(µ + σ²/2)",
        variance: "(exp(σ²) - 1)·exp(2µ + σ²)",
        source: "ISO 3534-1:2006, 2.52",
        use_when: "many small factors multiply, or a positive quantity is known to within a factor",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        ORIGIN,
        ParameterRule::number("mu", "Expectation of the logarithm."),
        ParameterRule::number("sigma", "Standard deviation of the logarithm."),
    ];

    fn in_place_of(parameter: &str) -> Option<Said> {
        let moments = ["mean", "sd", "std"].contains(&parameter).then(|| {
            say!(
                "mu and sigma are mean and standard deviation of the logarithm: for a mean m and a standard deviation s, sigma² = ln(1 + s²/m²) and mu = ln(m) − sigma²/2"
            )
        });
        moments.or_else(|| in_place_of_variance(parameter))
    }

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        let (mu, sigma) = (given.number("mu")?, given.number("sigma")?);
        let origin = given.optional("origin").unwrap_or(0.0);
        Ok(Parametric::located(
            LogNormal { origin, mu, sigma },
            format!("mu = {mu}, sigma = {sigma}"),
        ))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        finite("origin", self.origin)?;
        finite("mu", self.mu)?;
        positive("sigma", self.sigma)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: origin, mu, sigma)
    }

    fn shifted(&self, by: f64) -> Self {
        LogNormal {
            origin: self.origin + by,
            ..*self
        }
    }

    fn stretched(&self, by: f64) -> Self {
        LogNormal {
            origin: self.origin * by,
            mu: self.mu + libm::log(by),
            ..*self
        }
    }

    /// From exp(ρst) − 1 = r·√((exp s² − 1)(exp t² − 1)).
    fn latent_correlation(&self, other: &Self) -> Option<Latent> {
        let (s, t) = (self.sigma, other.sigma);
        let spread = libm::expm1(s * s).sqrt() * libm::expm1(t * t).sqrt();
        Some(Latent {
            smallest: libm::expm1(-s * t) / spread,
            largest: libm::expm1(s * t) / spread,
            of: Box::new(move |r| (libm::log1p(r * spread) / (s * t)).clamp(-1.0, 1.0)),
        })
    }

    fn mean(&self) -> Option<f64> {
        Some(self.origin + libm::exp(self.mu + 0.5 * self.sigma * self.sigma))
    }

    fn variance(&self) -> Option<f64> {
        let square = self.sigma * self.sigma;
        Some(libm::expm1(square) * libm::exp(2.0 * self.mu + square))
    }

    fn third_central_moment(&self) -> Option<f64> {
        let square = self.sigma * self.sigma;
        let grown = libm::expm1(square);
        Some(grown * grown * (grown + 3.0) * libm::exp(3.0 * self.mu + 1.5 * square))
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        let w = libm::exp(self.sigma * self.sigma);
        let kurtosis = w * w * (w * w + 2.0 * w + 3.0) - 3.0;
        self.variance().map(|v| kurtosis * v * v)
    }

    fn cdf(&self, x: f64) -> f64 {
        normal_cdf((libm::log((x - self.origin).max(0.0)) - self.mu) / self.sigma)
    }

    fn sf(&self, x: f64) -> f64 {
        normal_sf((libm::log((x - self.origin).max(0.0)) - self.mu) / self.sigma)
    }

    fn quantile(&self, p: f64) -> f64 {
        self.origin + libm::exp(self.mu + self.sigma * normal_quantile(p))
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        self.origin + libm::exp(self.mu - self.sigma * normal_quantile(q))
    }

    fn support(&self) -> (f64, f64) {
        (self.origin, f64::INFINITY)
    }

    fn sampler(&self) -> Sampler {
        let LogNormal { origin, mu, sigma } = *self;
        Sampler::LogNormal { origin, mu, sigma }
    }

    fn of_score(&self) -> Option<OfScore> {
        let LogNormal { origin, mu, sigma } = *self;
        Some(OfScore::LogNormal { origin, mu, sigma })
    }
}
