//! From the parameters of a stated distribution to the distribution.

use std::sync::Arc;

use super::distributions::{DiscreteTable, DistributionTable, LimitsTable, StudentTable};
use super::faults::{DISTRIBUTION, MISSING_KEY, TWO_WAYS};
use crate::distribution::Distribution;
use crate::fault::Fault;
use gumption_format::toml::Stated;

/// A fully stated distribution, and whether its location is stated too.
#[derive(Debug, Clone, PartialEq)]
pub struct Parametric {
    /// The distribution; about zero where no location was stated.
    pub distribution: Distribution,
    /// Whether its parameters say where the quantity is (they then determine the estimate).
    pub located: bool,
    /// Its parameters in words.
    pub how: String,
}

type Outcome = Result<Parametric, Box<Fault>>;

/// Takes required parameters out of a table, naming the missing ones.
struct Parameters<'a> {
    name: &'a str,
    place: &'a Stated<()>,
}

impl Parameters<'_> {
    fn need(&self, key: &str, stated: &Option<Stated<f64>>) -> Result<f64, Box<Fault>> {
        stated.as_ref().map(|stated| stated.value).ok_or_else(|| {
            Box::new(
                Fault::new(
                    MISSING_KEY,
                    self.place.span.clone(),
                    format!("{} needs `{key}`", self.name),
                )
                .label(format!("`{key}` is missing")),
            )
        })
    }

    fn positive(&self, key: &str, stated: &Option<Stated<f64>>) -> Result<f64, Box<Fault>> {
        let number = self.need(key, stated)?;
        let span = stated
            .as_ref()
            .map_or(self.place.span.clone(), |stated| stated.span.clone());
        if number > 0.0 {
            return Ok(number);
        }
        Err(Box::new(
            Fault::new(
                DISTRIBUTION,
                span,
                format!("`{key}` of {} is {number}", self.name),
            )
            .label("must be greater than zero"),
        ))
    }

    fn refuse<T>(&self, message: String, help: &str) -> Result<T, Box<Fault>> {
        Err(Box::new(
            Fault::new(DISTRIBUTION, self.place.span.clone(), message).help(help),
        ))
    }

    /// Lower and upper limit, and whether they are absolute.
    fn limits(&self, table: &LimitsTable) -> Result<(f64, f64, bool), Box<Fault>> {
        match (&table.half_width, &table.lower, &table.upper) {
            (Some(_), None, None) => {
                let a = self.positive("half_width", &table.half_width)?;
                Ok((-a, a, false))
            }
            (None, Some(lower), Some(upper)) if lower.value < upper.value => {
                Ok((lower.value, upper.value, true))
            }
            (None, Some(lower), Some(upper)) => self.refuse(
                format!(
                    "the limits of {} are {} and {}",
                    self.name, lower.value, upper.value
                ),
                "`lower` must be less than `upper`",
            ),
            (Some(half_width), lower, upper) => {
                let other = lower
                    .as_ref()
                    .or(upper.as_ref())
                    .map_or(self.place.span.clone(), |l| l.key.clone());
                Err(Box::new(
                    Fault::new(
                        TWO_WAYS,
                        half_width.key.clone(),
                        format!("{} has two widths", self.name),
                    )
                    .label("half-width stated here")
                    .related(other, "limit stated here")
                    .help("leave out one"),
                ))
            }
            _ => Err(Box::new(
                Fault::new(
                    MISSING_KEY,
                    self.place.span.clone(),
                    format!("{} needs its limits", self.name),
                )
                .label("limits are missing")
                .help("write `lower` and `upper`, or `half_width`"),
            )),
        }
    }

    /// Refuses parameters of another distribution.
    fn only(&self, table: &LimitsTable, own: &[&str]) -> Result<(), Box<Fault>> {
        let foreign = table
            .present
            .iter()
            .find(|(key, _)| !["lower", "upper", "half_width"].contains(key) && !own.contains(key));
        match foreign {
            None => Ok(()),
            Some((key, span)) => Err(Box::new(
                Fault::new(
                    DISTRIBUTION,
                    span.clone(),
                    format!("{} has no parameter `{key}`", self.name),
                )
                .label("remove it"),
            )),
        }
    }
}

fn limits_in_words(lower: f64, upper: f64, located: bool) -> String {
    if located {
        format!("{lower} … {upper}")
    } else {
        format!("a = {upper}")
    }
}

impl DistributionTable {
    /// The distribution that the table states.
    ///
    /// # Errors
    /// Parameters are missing, not positive, or of another distribution; not exactly one distribution.
    pub fn parametric(&self, place: &Stated<()>) -> Outcome {
        match self.present.as_slice() {
            [(name, _)] => self.named(&Parameters { name, place }),
            [] => Err(Box::new(
                Fault::new(MISSING_KEY, place.span.clone(), "no distribution is named")
                    .help("write for example distribution = { uniform = { half_width = 0.5 } }"),
            )),
            [(first, first_span), (second, second_span), ..] => Err(Box::new(
                Fault::new(
                    TWO_WAYS,
                    second_span.clone(),
                    format!("two distributions, {first} and {second}"),
                )
                .label("second distribution")
                .related(first_span.clone(), "first distribution")
                .help("keep one; two reasons for doubt are two entries of `components`"),
            )),
        }
    }

    fn named(&self, p: &Parameters<'_>) -> Outcome {
        if let Some(table) = &self.normal {
            let sd = p.positive("sd", &table.value.sd)?;
            let mean = table.value.mean.as_ref().map(|mean| mean.value);
            return Ok(Parametric {
                distribution: Distribution::Normal {
                    mean: mean.unwrap_or(0.0),
                    sd,
                },
                located: mean.is_some(),
                how: format!("sd = {sd}"),
            });
        }
        if let Some(table) = &self.t {
            return student(p, &table.value);
        }
        if let Some(outcome) = self.between_limits(p) {
            return outcome;
        }
        self.one_sided(p)
    }

    fn between_limits(&self, p: &Parameters<'_>) -> Option<Outcome> {
        let outcome =
            |table: &LimitsTable,
             own: &[&str],
             make: &dyn Fn(f64, f64) -> Result<Distribution, Box<Fault>>| {
                p.only(table, own)?;
                let (lower, upper, located) = p.limits(table)?;
                Ok(Parametric {
                    distribution: make(lower, upper)?,
                    located,
                    how: limits_in_words(lower, upper, located),
                })
            };
        if let Some(table) = &self.uniform {
            return Some(outcome(&table.value, &[], &|lower, upper| {
                Ok(Distribution::Uniform { lower, upper })
            }));
        }
        if let Some(table) = &self.arcsine {
            return Some(outcome(&table.value, &[], &|lower, upper| {
                Ok(Distribution::Arcsine { lower, upper })
            }));
        }
        if let Some(table) = &self.triangular {
            return Some(outcome(&table.value, &["mode"], &|lower, upper| {
                let mode = table
                    .value
                    .mode
                    .as_ref()
                    .map_or((lower + upper) / 2.0, |mode| mode.value);
                if (lower..=upper).contains(&mode) {
                    return Ok(Distribution::Triangular { lower, mode, upper });
                }
                p.refuse(
                    format!("the mode {mode} is not between {lower} and {upper}"),
                    "move `mode` between the limits",
                )
            }));
        }
        if let Some(table) = &self.trapezoidal {
            return Some(outcome(&table.value, &["beta"], &|lower, upper| {
                let beta = p.need("beta", &table.value.beta)?;
                if (0.0..=1.0).contains(&beta) {
                    return Ok(Distribution::Trapezoidal { lower, upper, beta });
                }
                p.refuse(
                    format!("beta is {beta}"),
                    "`beta` is top width / base width, from 0 to 1",
                )
            }));
        }
        if let Some(table) = &self.curvilinear_trapezoid {
            return Some(outcome(&table.value, &["d"], &|lower, upper| {
                let d = p.positive("d", &table.value.d)?;
                if d <= (upper - lower) / 2.0 {
                    return Ok(Distribution::CurvilinearTrapezoid { lower, upper, d });
                }
                p.refuse(
                    format!("d is {d}, more than the half-width"),
                    "`d` is the half-width of the doubt about each limit",
                )
            }));
        }
        None
    }

    fn one_sided(&self, p: &Parameters<'_>) -> Outcome {
        let origin =
            |stated: &Option<Stated<f64>>| stated.as_ref().map_or(0.0, |origin| origin.value);
        let located = |distribution: Distribution, how: String| {
            Ok(Parametric {
                distribution,
                located: true,
                how,
            })
        };
        if let Some(Stated { value: table, .. }) = &self.exponential {
            let mean = p.positive("mean", &table.mean)?;
            let origin = origin(&table.origin);
            return located(
                Distribution::Exponential { origin, mean },
                format!("mean = {mean}"),
            );
        }
        if let Some(Stated { value: table, .. }) = &self.gamma {
            let (shape, scale) = (
                p.positive("shape", &table.shape)?,
                p.positive("scale", &table.scale)?,
            );
            let origin = origin(&table.origin);
            return located(
                Distribution::Gamma {
                    origin,
                    shape,
                    scale,
                },
                format!("shape = {shape}, scale = {scale}"),
            );
        }
        if let Some(Stated { value: table, .. }) = &self.lognormal {
            let (mu, sigma) = (p.need("mu", &table.mu)?, p.positive("sigma", &table.sigma)?);
            let origin = origin(&table.origin);
            return located(
                Distribution::LogNormal { origin, mu, sigma },
                format!("mu = {mu}, sigma = {sigma}"),
            );
        }
        if let Some(Stated { value: table, .. }) = &self.beta {
            let (alpha, beta) = (
                p.positive("alpha", &table.alpha)?,
                p.positive("beta", &table.beta)?,
            );
            let lower = origin(&table.lower);
            let upper = table.upper.as_ref().map_or(1.0, |upper| upper.value);
            if lower >= upper {
                return p.refuse(
                    format!("the limits are {lower} and {upper}"),
                    "`lower` must be less than `upper`",
                );
            }
            return located(
                Distribution::Beta {
                    alpha,
                    beta,
                    lower,
                    upper,
                },
                format!("alpha = {alpha}, beta = {beta}"),
            );
        }
        match &self.discrete {
            Some(table) => discrete(p, &table.value),
            // The only key was refused by the reader, which has reported it.
            None => p.refuse(
                format!("{} cannot be read", p.name),
                "see the fault inside it",
            ),
        }
    }
}

fn student(p: &Parameters<'_>, table: &StudentTable) -> Outcome {
    let scale = p.positive("scale", &table.scale)?;
    let dof = p.positive("dof", &table.dof.as_ref().map(|dof| dof.map(|dof| dof.0)))?;
    if dof.is_infinite() {
        return p.refuse(
            "a t distribution with infinite dof is normal".into(),
            "write normal = { sd = … }",
        );
    }
    let location = table.location.as_ref().map(|location| location.value);
    let distribution = Distribution::StudentT {
        location: location.unwrap_or(0.0),
        scale,
        dof,
    };
    Ok(Parametric {
        distribution,
        located: location.is_some(),
        how: format!("scale = {scale}, ν = {dof}"),
    })
}

fn discrete(p: &Parameters<'_>, table: &DiscreteTable) -> Outcome {
    let numbers = |list: &Option<Stated<Vec<Stated<f64>>>>| -> Option<Vec<f64>> {
        list.as_ref()
            .map(|list| list.value.iter().map(|number| number.value).collect())
    };
    let values = numbers(&table.values).unwrap_or_default();
    let count = values.len();
    if count < 2 {
        return p.refuse(
            "a discrete distribution needs at least two values".into(),
            "write values = [0, 1]",
        );
    }
    let probabilities =
        numbers(&table.probabilities).unwrap_or_else(|| vec![1.0 / count as f64; count]);
    let sum: f64 = probabilities.iter().sum();
    if probabilities.len() != count
        || probabilities.iter().any(|p| *p < 0.0)
        || (sum - 1.0).abs() > 1e-9
    {
        return p.refuse(
            format!(
                "{} probabilities with the sum {sum} for {count} values",
                probabilities.len()
            ),
            "give one probability for each value; together they make 1",
        );
    }
    let mut pairs: Vec<(f64, f64)> = values.into_iter().zip(probabilities).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (values, probabilities): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
    let distribution = Distribution::Discrete {
        values: Arc::from(values),
        probabilities: Arc::from(probabilities),
    };
    Ok(Parametric {
        distribution,
        located: true,
        how: format!("{count} values"),
    })
}
