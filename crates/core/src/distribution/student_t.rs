//! The scaled and shifted t distribution, JCGM 101 6.4.9.

use std::sync::Arc;

use gumption_fault::{Said, say};
use gumption_lanes::Sampler;
use gumption_lanes::quantile::{Curve, OfScore};

use super::extended;
use super::score::SCORES;
use super::stating::{
    Bell, Given, ParameterError, ParameterRule, Parametric, Takes, Word, allowed, finite,
    in_place_of_variance, positive,
};
use super::univariate::{Kind, Parameter, Univariate};
use crate::special::{
    normal_cdf, normal_pdf, student_t_cdf, student_t_pdf, student_t_quantile, student_t_sf,
};

/// Scaled and shifted t, JCGM 101 6.4.9. Standard deviation `scale·√(ν/(ν−2))` for ν > 2.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudentT {
    /// Expectation (ν > 1) and median.
    pub location: f64,
    /// Scale factor; not the standard deviation.
    pub scale: f64,
    /// Degrees of freedom ν; infinite for the normal limit.
    #[serde(with = "extended")]
    pub dof: f64,
}

impl Univariate for StudentT {
    const KIND: Kind = Kind {
        key: "t",
        aliases: &[
            "student-t",
            "student",
            "students-t",
            "student's-t",
            "t-distribution",
        ],
        name_en: "scaled and shifted t",
        name_zh: "t分布",
        parameters: "t_ν(x, s²), ν degrees of freedom",
        expectation: "x, for ν > 1",
        variance: "s²·ν/(ν - 2), for ν > 2",
        source: "JCGM 101:2008, 6.4.9",
        use_when: "the estimate is a mean of repeated readings, or a certificate states U, p and ν",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        ParameterRule::number("location", "Location; the value when left out."),
        ParameterRule::number("scale", "Scale."),
        ParameterRule {
            key: "dof",
            meaning: "Degrees of freedom.",
            takes: Takes::Freedom,
        },
    ];

    const WORD: Word = Word::Bell(Bell::StudentT);

    fn in_place_of(parameter: &str) -> Option<Said> {
        in_place_of_variance(parameter)
    }

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        let (scale, dof) = (given.number("scale")?, given.number("dof")?);
        if dof == f64::INFINITY {
            return Err(ParameterError::Unusable {
                message: say!("a t distribution with infinite dof is normal"),
                help: say!("write normal = {{ sd = … }}"),
            });
        }
        let location = given.optional("location");
        Ok(Parametric {
            distribution: StudentT {
                location: location.unwrap_or(0.0),
                scale,
                dof,
            },
            located: location.is_some(),
            limits: None,
            how: format!("scale = {scale}, ν = {dof}"),
        })
    }

    fn validate(&self) -> Result<(), ParameterError> {
        finite("location", self.location)?;
        positive("scale", self.scale)?;
        allowed("dof", self.dof, self.dof > 0.0, || {
            say!("greater than zero")
        })
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        numbers!(self: location, scale, dof)
    }

    fn shifted(&self, by: f64) -> Self {
        StudentT {
            location: self.location + by,
            ..*self
        }
    }

    fn stretched(&self, by: f64) -> Self {
        StudentT {
            location: self.location * by,
            scale: self.scale * by,
            ..*self
        }
    }

    fn mirrored(&self) -> Option<Self> {
        Some(StudentT {
            location: -self.location,
            ..*self
        })
    }

    fn is_normal(&self) -> bool {
        self.dof.is_infinite()
    }

    fn mean(&self) -> Option<f64> {
        (self.dof > 1.0).then_some(self.location)
    }

    fn variance(&self) -> Option<f64> {
        (self.dof > 2.0).then(|| self.scale * self.scale * over(self.dof, 2.0))
    }

    fn third_central_moment(&self) -> Option<f64> {
        (self.dof > 3.0).then_some(0.0)
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        (self.dof > 4.0)
            .then(|| 3.0 * self.scale.powi(4) * over(self.dof, 2.0) * over(self.dof, 4.0))
    }

    fn cdf(&self, x: f64) -> f64 {
        student_t_cdf((x - self.location) / self.scale, self.dof)
    }

    fn sf(&self, x: f64) -> f64 {
        student_t_sf((x - self.location) / self.scale, self.dof)
    }

    fn quantile(&self, p: f64) -> f64 {
        self.location + self.scale * student_t_quantile(p, self.dof)
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        self.location - self.scale * student_t_quantile(q, self.dof)
    }

    fn support(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn sampler(&self) -> Sampler {
        let StudentT {
            location,
            scale,
            dof,
        } = *self;
        Sampler::StudentT {
            location,
            scale,
            dof,
        }
    }

    fn of_score(&self) -> Option<OfScore> {
        let StudentT {
            location,
            scale,
            dof,
        } = *self;
        Some(if dof.is_infinite() {
            OfScore::Normal {
                mean: location,
                sd: scale,
            }
        } else {
            OfScore::Tabulated {
                table: Arc::new(standard(dof)),
                location,
                scale,
            }
        })
    }
}

/// ν/(ν − less), also for infinite ν.
fn over(dof: f64, less: f64) -> f64 {
    if dof.is_infinite() {
        1.0
    } else {
        dof / (dof - less)
    }
}

/// The t quantile function T(z) of the normal score: T′ = φ(z)/f(T), f the density of t. From node to node a step of Runge
/// and Kutta's method of fourth order predicts, and one of Newton's for F(T) = Φ(z) corrects, so that no error is
/// carried on: what the step does wrong, relatively to T, is squared. Much quicker than to invert F at every node.
fn standard(dof: f64) -> Curve {
    let constant = libm::log(normal_pdf(0.0) / student_t_pdf(0.0, dof));
    let slope = |z: f64, t: f64| {
        let logarithm = 0.5 * (dof + 1.0) * libm::log1p(t * t / dof) - 0.5 * z * z;
        libm::exp(constant + logarithm)
    };
    // dT = dΦ/f(T), and 1/f(T) = T′/φ(z).
    let corrected = |z: f64, t: f64| {
        let short = normal_cdf(z) - student_t_cdf(t, dof);
        t + short * slope(z, t) / normal_pdf(z)
    };
    let half = (Curve::NODES - 1) / 2;
    let h = -SCORES[0] / half as f64;
    let mut t = student_t_quantile(normal_cdf(SCORES[0]), dof);
    let mut lower = Vec::with_capacity(half);
    for node in 0..half {
        let z = SCORES[0] + node as f64 * h;
        let k1 = slope(z, t);
        lower.push([t, k1]);
        let k2 = slope(z + 0.5 * h, t + 0.5 * h * k1);
        let k3 = slope(z + 0.5 * h, t + 0.5 * h * k2);
        let k4 = slope(z + h, t + h * k3);
        t = corrected(z + h, t + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4));
    }
    let upper = lower.iter().rev().map(|[t, slope]| [-t, *slope]);
    let middle = [0.0, slope(0.0, 0.0)];
    let nodes: Vec<[f64; 2]> = lower.iter().copied().chain([middle]).chain(upper).collect();
    Curve::new(SCORES, &nodes)
}
