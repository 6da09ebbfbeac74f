//! The beta distribution between two limits.

use gumption_lanes::Sampler;

use super::stating::{Given, ParameterError, ParameterRule, Parametric, ascending, positive};
use super::univariate::{Kind, Parameter, Univariate};
use crate::special::{beta_regularized, beta_regularized_upper, inverse_beta_regularized};

/// Beta(alpha, beta) stretched over `lower … upper`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beta {
    /// First shape parameter.
    pub alpha: f64,
    /// Second shape parameter.
    pub beta: f64,
    /// Lower limit.
    pub lower: f64,
    /// Upper limit.
    pub upper: f64,
}

impl Univariate for Beta {
    const KIND: Kind = Kind {
        key: "beta",
        aliases: &[],
        name_en: "beta",
        name_zh: "贝塔分布",
        parameters: "Be(α, β) on a … b",
        expectation: "a + (b - a)·α/(α + β)",
        variance: "(b - a)²·αβ/((α + β)²(α + β + 1))",
        source: "ISO 3534-1:2006, 2.59",
        use_when: "limits and a shape between them are known, or the quantity is a proportion",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        ParameterRule::number("alpha", "First shape."),
        ParameterRule::number("beta", "Second shape."),
        ParameterRule::number("lower", "Lower limit (default 0)."),
        ParameterRule::number("upper", "Upper limit (default 1)."),
    ];

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        let (alpha, beta) = (given.number("alpha")?, given.number("beta")?);
        Ok(Parametric::located(
            Beta {
                alpha,
                beta,
                lower: given.optional("lower").unwrap_or(0.0),
                upper: given.optional("upper").unwrap_or(1.0),
            },
            format!("alpha = {alpha}, beta = {beta}"),
        ))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        positive("alpha", self.alpha)?;
        positive("beta", self.beta)?;
        ascending(self.lower, self.upper)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: alpha, beta, lower, upper)
    }

    fn shifted(&self, by: f64) -> Self {
        Beta {
            lower: self.lower + by,
            upper: self.upper + by,
            ..*self
        }
    }

    fn stretched(&self, by: f64) -> Self {
        Beta {
            lower: self.lower * by,
            upper: self.upper * by,
            ..*self
        }
    }

    fn mirrored(&self) -> Option<Self> {
        Some(Beta {
            alpha: self.beta,
            beta: self.alpha,
            lower: -self.upper,
            upper: -self.lower,
        })
    }

    fn mean(&self) -> Option<f64> {
        let Beta {
            alpha,
            beta,
            lower,
            upper,
        } = *self;
        Some((lower * beta + upper * alpha) / (alpha + beta))
    }

    fn variance(&self) -> Option<f64> {
        let Beta {
            alpha,
            beta,
            lower,
            upper,
        } = *self;
        let n = alpha + beta;
        Some((upper - lower).powi(2) * (alpha / n) * (beta / n) / (n + 1.0))
    }

    fn third_central_moment(&self) -> Option<f64> {
        let (alpha, beta) = (self.alpha, self.beta);
        let n = alpha + beta;
        let variance = self.variance()?;
        let skewness =
            2.0 * (beta - alpha) * (n + 1.0).sqrt() / ((n + 2.0) * alpha.sqrt() * beta.sqrt());
        Some(skewness * libm::pow(variance, 1.5))
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        let (alpha, beta) = (self.alpha, self.beta);
        let n = alpha + beta;
        let excess = 6.0 * ((alpha - beta).powi(2) * (n + 1.0) - alpha * beta * (n + 2.0))
            / (alpha * beta * (n + 2.0) * (n + 3.0));
        self.variance().map(|v| (3.0 + excess) * v * v)
    }

    fn cdf(&self, x: f64) -> f64 {
        let [from_lower, from_upper] = self.distances(x);
        if from_lower <= 0.5 {
            beta_regularized(self.alpha, self.beta, from_lower)
        } else {
            beta_regularized_upper(self.beta, self.alpha, from_upper)
        }
    }

    fn sf(&self, x: f64) -> f64 {
        let [from_lower, from_upper] = self.distances(x);
        if from_lower <= 0.5 {
            beta_regularized_upper(self.alpha, self.beta, from_lower)
        } else {
            beta_regularized(self.beta, self.alpha, from_upper)
        }
    }

    fn quantile(&self, p: f64) -> f64 {
        let width = self.upper - self.lower;
        self.lower + width * inverse_beta_regularized(self.alpha, self.beta, p)
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        let width = self.upper - self.lower;
        self.upper - width * inverse_beta_regularized(self.beta, self.alpha, q)
    }

    fn support(&self) -> (f64, f64) {
        (self.lower, self.upper)
    }

    fn sampler(&self) -> Sampler {
        let Beta {
            alpha,
            beta,
            lower,
            upper,
        } = *self;
        Sampler::Beta {
            alpha,
            beta,
            lower,
            upper,
        }
    }
}

impl Beta {
    /// From both limits, as parts of the width: the nearer one has the digits.
    fn distances(&self, x: f64) -> [f64; 2] {
        let width = self.upper - self.lower;
        [(x - self.lower), (self.upper - x)].map(|distance| (distance / width).clamp(0.0, 1.0))
    }
}
