//! The distributions that a component of an input may have (JCGM 101:2008, 6.4, and others).
//!
//! | chapter | holds |
//! |---|---|
//! | this file | the distributions and their parameters, validity, affine images |
//! | `moments` | expectation, variance, third and fourth central moment |
//! | `quantile` | distribution function, quantile from either end, support |
//! | `kinds` | names in English and Chinese, formulas, clause and use of every kind |
//! | `copula` | the latent correlation that gives two margins a stated correlation |

mod copula;
pub mod extended;
mod kinds;
mod moments;
mod quantile;

pub use copula::{CopulaError, latent_correlation};
pub use kinds::{KINDS, Kind, kind_named};

use std::sync::Arc;

/// A univariate distribution, fully specified.
///
/// Parameters are in the unit of the component. Moments and quantiles follow from the
/// parameters exactly; see the methods.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Distribution {
    /// N(mean, sd²), JCGM 101 6.4.7.
    Normal {
        /// Expectation µ.
        mean: f64,
        /// Standard deviation σ.
        sd: f64,
    },
    /// Scaled and shifted t, JCGM 101 6.4.9. Standard deviation `scale·√(ν/(ν−2))` for ν > 2.
    #[serde(rename = "t")]
    StudentT {
        /// Expectation (ν > 1) and median.
        location: f64,
        /// Scale factor; not the standard deviation.
        scale: f64,
        /// Degrees of freedom ν; infinite for the normal limit.
        #[serde(with = "extended")]
        dof: f64,
    },
    /// Rectangular R(lower, upper), JCGM 101 6.4.2.
    Uniform {
        /// Lower limit a.
        lower: f64,
        /// Upper limit b.
        upper: f64,
    },
    /// Triangular, symmetric (6.4.5) or not.
    Triangular {
        /// Lower limit a.
        lower: f64,
        /// Most probable value.
        mode: f64,
        /// Upper limit b.
        upper: f64,
    },
    /// Isosceles trapezoid, 6.4.4; `beta` = top width / base width.
    Trapezoidal {
        /// Lower limit a.
        lower: f64,
        /// Upper limit b.
        upper: f64,
        /// Width of the top divided by width of the base.
        beta: f64,
    },
    /// Rectangular with inexactly known limits, 6.4.3: limits `lower ± d`, `upper ± d`.
    CurvilinearTrapezoid {
        /// Nominal lower limit a.
        lower: f64,
        /// Nominal upper limit b.
        upper: f64,
        /// Greatest error of either limit.
        d: f64,
    },
    /// U-shaped (arc sine), 6.4.6.
    Arcsine {
        /// Lower limit a.
        lower: f64,
        /// Upper limit b.
        upper: f64,
    },
    /// Exponential with origin, 6.4.10: `origin + Ex(1/mean)`.
    Exponential {
        /// Smallest value.
        origin: f64,
        /// Expectation of the distance from the origin.
        mean: f64,
    },
    /// Gamma with origin, 6.4.11: `origin + G(shape, scale)`; mean `origin + shape·scale`.
    Gamma {
        /// Smallest value.
        origin: f64,
        /// Shape parameter.
        shape: f64,
        /// Scale parameter.
        scale: f64,
    },
    /// `origin + exp(N(mu, sigma²))`.
    #[serde(rename = "lognormal")]
    LogNormal {
        /// Smallest value.
        origin: f64,
        /// Expectation of the logarithm.
        mu: f64,
        /// Standard deviation of the logarithm.
        sigma: f64,
    },
    /// Beta(alpha, beta) stretched over `lower … upper`.
    Beta {
        /// First shape parameter.
        alpha: f64,
        /// Second shape parameter.
        beta: f64,
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Finitely many values with probabilities (ascending values; probabilities sum to one).
    Discrete {
        /// The values, ascending.
        values: Arc<[f64]>,
        /// Their probabilities.
        probabilities: Arc<[f64]>,
    },
    /// Draws with replacement from a sample (ascending).
    Empirical {
        /// The sample, ascending.
        sample: Arc<[f64]>,
    },
}

impl Distribution {
    /// Whether the parameters are allowed; otherwise which one is not, and what is allowed.
    ///
    /// The other methods expect a valid distribution and may give NaN for any other.
    ///
    /// # Errors
    /// A sentence without a final stop, with the parameter's name and value in it.
    pub fn validate(&self) -> Result<(), String> {
        match self {
            Self::Normal { mean, sd } => {
                finite("mean", *mean)?;
                positive("standard deviation", *sd)
            }
            Self::StudentT {
                location,
                scale,
                dof,
            } => {
                finite("location", *location)?;
                positive("scale", *scale)?;
                if *dof > 0.0 {
                    Ok(())
                } else {
                    Err(format!(
                        "the degrees of freedom are {dof}, but must be greater than zero"
                    ))
                }
            }
            Self::Uniform { lower, upper } | Self::Arcsine { lower, upper } => {
                ascending(*lower, *upper)
            }
            Self::Triangular { lower, mode, upper } => {
                ascending(*lower, *upper)?;
                within("mode", *mode, *lower, *upper)
            }
            Self::Trapezoidal { lower, upper, beta } => {
                ascending(*lower, *upper)?;
                within("beta (top width divided by base width)", *beta, 0.0, 1.0)
            }
            Self::CurvilinearTrapezoid { lower, upper, d } => {
                ascending(*lower, *upper)?;
                let half_width = 0.5 * (upper - lower);
                within("d (greatest error of the limits)", *d, 0.0, half_width).map_err(|fault| {
                    format!("{fault}, half the distance of the limits {lower} and {upper}")
                })
            }
            Self::Exponential { origin, mean } => {
                finite("origin", *origin)?;
                positive("mean", *mean)
            }
            Self::Gamma {
                origin,
                shape,
                scale,
            } => {
                finite("origin", *origin)?;
                positive("shape", *shape)?;
                positive("scale", *scale)
            }
            Self::LogNormal { origin, mu, sigma } => {
                finite("origin", *origin)?;
                finite("mu", *mu)?;
                positive("sigma", *sigma)
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => {
                positive("alpha", *alpha)?;
                positive("beta", *beta)?;
                ascending(*lower, *upper)
            }
            Self::Discrete {
                values,
                probabilities,
            } => discrete(values, probabilities),
            Self::Empirical { sample } => {
                if sample.is_empty() {
                    return Err("the sample is empty, but must hold at least one value".to_owned());
                }
                sorted("sample", sample)
            }
        }
    }

    /// Distribution of X + `by`.
    #[must_use]
    pub fn shifted(&self, by: f64) -> Self {
        let mut image = self.clone();
        match &mut image {
            Self::Normal { mean: place, .. }
            | Self::StudentT {
                location: place, ..
            }
            | Self::Exponential { origin: place, .. }
            | Self::Gamma { origin: place, .. }
            | Self::LogNormal { origin: place, .. } => *place += by,
            Self::Triangular { lower, mode, upper } => {
                *lower += by;
                *mode += by;
                *upper += by;
            }
            Self::Uniform { lower, upper }
            | Self::Arcsine { lower, upper }
            | Self::Trapezoidal { lower, upper, .. }
            | Self::CurvilinearTrapezoid { lower, upper, .. }
            | Self::Beta { lower, upper, .. } => {
                *lower += by;
                *upper += by;
            }
            Self::Discrete { values, .. } | Self::Empirical { sample: values } => {
                *values = values.iter().map(|x| x + by).collect();
            }
        }
        image
    }

    /// Distribution of X·`by`.
    ///
    /// `None` when it has no place in the enum: for a factor that is zero or not finite, and for
    /// the mirror image of the one-sided kinds (exponential, gamma, lognormal).
    pub fn scaled(&self, by: f64) -> Option<Self> {
        if by == 0.0 || !by.is_finite() {
            return None;
        }
        if by > 0.0 {
            Some(self.stretched(by))
        } else {
            Some(self.mirrored()?.stretched(-by))
        }
    }

    /// Distribution of X·`by` for a positive factor.
    fn stretched(&self, by: f64) -> Self {
        let mut image = self.clone();
        match &mut image {
            Self::Normal {
                mean: place,
                sd: size,
            }
            | Self::StudentT {
                location: place,
                scale: size,
                ..
            }
            | Self::Exponential {
                origin: place,
                mean: size,
            }
            | Self::Gamma {
                origin: place,
                scale: size,
                ..
            }
            | Self::Uniform {
                lower: place,
                upper: size,
            }
            | Self::Arcsine {
                lower: place,
                upper: size,
            }
            | Self::Trapezoidal {
                lower: place,
                upper: size,
                ..
            }
            | Self::Beta {
                lower: place,
                upper: size,
                ..
            } => {
                *place *= by;
                *size *= by;
            }
            Self::Triangular {
                lower,
                mode: third,
                upper,
            }
            | Self::CurvilinearTrapezoid {
                lower,
                upper,
                d: third,
            } => {
                *lower *= by;
                *third *= by;
                *upper *= by;
            }
            Self::LogNormal { origin, mu, .. } => {
                *origin *= by;
                *mu += libm::log(by);
            }
            Self::Discrete { values, .. } | Self::Empirical { sample: values } => {
                *values = values.iter().map(|x| x * by).collect();
            }
        }
        image
    }

    /// Distribution of −X.
    fn mirrored(&self) -> Option<Self> {
        let mut image = self.clone();
        match &mut image {
            Self::Normal { mean: place, .. }
            | Self::StudentT {
                location: place, ..
            } => {
                *place = -*place;
            }
            Self::Uniform { lower, upper }
            | Self::Arcsine { lower, upper }
            | Self::Trapezoidal { lower, upper, .. }
            | Self::CurvilinearTrapezoid { lower, upper, .. } => {
                (*lower, *upper) = (-*upper, -*lower);
            }
            Self::Triangular { lower, mode, upper } => {
                (*lower, *mode, *upper) = (-*upper, -*mode, -*lower);
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => {
                (*alpha, *beta) = (*beta, *alpha);
                (*lower, *upper) = (-*upper, -*lower);
            }
            Self::Discrete {
                values,
                probabilities,
            } => {
                *values = values.iter().rev().map(|x| -x).collect();
                *probabilities = probabilities.iter().rev().copied().collect();
            }
            Self::Empirical { sample } => *sample = sample.iter().rev().map(|x| -x).collect(),
            Self::Exponential { .. } | Self::Gamma { .. } | Self::LogNormal { .. } => return None,
        }
        Some(image)
    }

    /// Whether the distribution is its own mirror image about its median.
    pub fn is_symmetric(&self) -> bool {
        match self {
            Self::Normal { .. }
            | Self::StudentT { .. }
            | Self::Uniform { .. }
            | Self::Arcsine { .. }
            | Self::Trapezoidal { .. }
            | Self::CurvilinearTrapezoid { .. } => true,
            Self::Triangular { lower, mode, upper } => {
                let width = upper - lower;
                ((mode - lower) - (upper - mode)).abs() <= 1e-12 * width
            }
            Self::Beta { alpha, beta, .. } => alpha == beta,
            Self::Exponential { .. } | Self::Gamma { .. } | Self::LogNormal { .. } => false,
            Self::Discrete {
                values,
                probabilities,
            } => {
                balanced(values)
                    && probabilities
                        .iter()
                        .zip(probabilities.iter().rev())
                        .all(|(p, q)| (p - q).abs() <= 1e-12)
            }
            Self::Empirical { sample } => balanced(sample),
        }
    }

    /// Whether it is a normal distribution (t with infinite ν is one).
    pub fn is_normal(&self) -> bool {
        match self {
            Self::Normal { .. } => true,
            Self::StudentT { dof, .. } => dof.is_infinite(),
            _ => false,
        }
    }
}

fn finite(name: &str, x: f64) -> Result<(), String> {
    if x.is_finite() {
        Ok(())
    } else {
        Err(format!("the {name} is {x}, but must be a finite number"))
    }
}

fn positive(name: &str, x: f64) -> Result<(), String> {
    if x > 0.0 && x.is_finite() {
        Ok(())
    } else {
        Err(format!(
            "the {name} is {x}, but must be a finite number greater than zero"
        ))
    }
}

fn within(name: &str, x: f64, low: f64, high: f64) -> Result<(), String> {
    if (low..=high).contains(&x) {
        Ok(())
    } else {
        Err(format!(
            "the {name} is {x}, but must be from {low} to {high}"
        ))
    }
}

fn ascending(lower: f64, upper: f64) -> Result<(), String> {
    finite("lower limit", lower)?;
    finite("upper limit", upper)?;
    if lower < upper {
        Ok(())
    } else {
        Err(format!(
            "the lower limit {lower} must be below the upper limit {upper}"
        ))
    }
}

fn sorted(name: &str, values: &[f64]) -> Result<(), String> {
    if let Some(x) = values.iter().find(|x| !x.is_finite()) {
        return Err(format!(
            "the {name} holds {x}, but must hold finite numbers"
        ));
    }
    match values.windows(2).find(|pair| pair[0] > pair[1]) {
        None => Ok(()),
        Some(pair) => Err(format!(
            "the {name} must ascend, but {} comes before {}",
            pair[0], pair[1]
        )),
    }
}

fn discrete(values: &[f64], probabilities: &[f64]) -> Result<(), String> {
    if values.is_empty() {
        return Err("there are no values, but must be at least one".to_owned());
    }
    if values.len() != probabilities.len() {
        return Err(format!(
            "there are {} values but {} probabilities; every value needs one",
            values.len(),
            probabilities.len()
        ));
    }
    sorted("list of values", values)?;
    for (x, p) in values.iter().zip(probabilities) {
        within(&format!("probability of the value {x}"), *p, 0.0, 1.0)?;
    }
    let sum: f64 = probabilities.iter().sum();
    if (sum - 1.0).abs() > 1e-9 {
        return Err(format!("the probabilities sum to {sum}, but must sum to 1"));
    }
    Ok(())
}

/// Whether ascending values lie symmetrically about their middle.
fn balanced(values: &[f64]) -> bool {
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return true;
    };
    let tolerance = 1e-12 * (last - first);
    values
        .iter()
        .zip(values.iter().rev())
        .all(|(low, high)| ((low - first) - (last - high)).abs() <= tolerance)
}

#[cfg(test)]
mod tests;
