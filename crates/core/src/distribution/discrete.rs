//! Finitely many values with probabilities.

use std::sync::Arc;

use gumption_fault::{Said, say};
use gumption_lanes::Sampler;
use gumption_lanes::quantile::OfScore;

use super::finite;
use super::stating::{Given, ParameterError, ParameterRule, Parametric, allowed, within};
use super::univariate::{Kind, Parameter, Univariate};

/// Finitely many values with probabilities (ascending values; probabilities sum to one).
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Discrete {
    /// The values, ascending.
    pub values: Arc<[f64]>,
    /// Their probabilities.
    pub probabilities: Arc<[f64]>,
}

impl Univariate for Discrete {
    const KIND: Kind = Kind {
        key: "discrete",
        aliases: &["two-point", "两点", "两点分布", "离散"],
        name_en: "discrete",
        name_zh: "离散分布",
        parameters: "values x_i with probabilities p_i",
        expectation: "Σ p_i x_i",
        variance: "Σ p_i (x_i - x)²",
        source: "ISO 3534-1:2006, 2.22",
        use_when: "only some values are possible",
        stated_by: None,
    };

    const PARAMETERS: &'static [ParameterRule] = &[
        ParameterRule::numbers("values", "The values."),
        ParameterRule::numbers("probabilities", "Their probabilities; equal when left out."),
    ];

    fn stated(given: &Given) -> Result<Parametric<Self>, ParameterError> {
        let unusable = |message: Said, help| Err(ParameterError::Unusable { message, help });
        let values = given.list("values").unwrap_or_default();
        let count = values.len();
        if count < 2 {
            return unusable(
                say!("a discrete distribution needs at least two values"),
                say!("write values = [0, 1]"),
            );
        }
        let equal = vec![1.0 / count as f64; count];
        let probabilities = given.list("probabilities").unwrap_or(&equal);
        let sum: f64 = probabilities.iter().sum();
        if probabilities.len() != count
            || probabilities.iter().any(|p| *p < 0.0)
            || (sum - 1.0).abs() > 1e-9
        {
            return unusable(
                say!(
                    "{} probabilities with the sum {sum} for {count} values",
                    probabilities.len()
                ),
                say!("give one probability for each value; together they make 1"),
            );
        }
        let mut pairs: Vec<(f64, f64)> = values
            .iter()
            .copied()
            .zip(probabilities.iter().copied())
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (values, probabilities): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        Ok(Parametric::located(
            Discrete {
                values: values.into(),
                probabilities: probabilities.into(),
            },
            format!("{count} values"),
        ))
    }

    fn validate(&self) -> Result<(), ParameterError> {
        let unusable = |message: Said| {
            let help = say!("give one probability for each value; together they make 1");
            Err(ParameterError::Unusable { message, help })
        };
        let (values, probabilities) = (&self.values, &self.probabilities);
        if values.is_empty() {
            return unusable(say!("there are no values, but must be at least one"));
        }
        if values.len() != probabilities.len() {
            return unusable(say!(
                "there are {} values but {} probabilities; every value needs one",
                values.len(),
                probabilities.len()
            ));
        }
        finite::ascending(&say!("list of values"), values)?;
        for p in probabilities.iter() {
            within("probabilities", *p, [0.0, 1.0])?;
        }
        let sum: f64 = probabilities.iter().sum();
        allowed("probabilities", sum, (sum - 1.0).abs() <= 1e-9, || {
            say!("numbers that sum to 1")
        })
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        vec![
            ("values", Parameter::Numbers(&self.values)),
            ("probabilities", Parameter::Numbers(&self.probabilities)),
        ]
    }

    fn shifted(&self, by: f64) -> Self {
        self.with_values(self.values.iter().map(|x| x + by))
    }

    fn stretched(&self, by: f64) -> Self {
        self.with_values(self.values.iter().map(|x| x * by))
    }

    fn mirrored(&self) -> Option<Self> {
        Some(Discrete {
            values: self.values.iter().rev().map(|x| -x).collect(),
            probabilities: self.probabilities.iter().rev().copied().collect(),
        })
    }

    fn mean(&self) -> Option<f64> {
        Some(finite::mean(self.pairs()))
    }

    fn variance(&self) -> Option<f64> {
        Some(finite::moment(self.pairs(), 2))
    }

    fn third_central_moment(&self) -> Option<f64> {
        Some(finite::moment(self.pairs(), 3))
    }

    fn fourth_central_moment(&self) -> Option<f64> {
        Some(finite::moment(self.pairs(), 4))
    }

    fn cdf(&self, x: f64) -> f64 {
        let below = self.pairs().take_while(|(value, _)| *value <= x);
        below.map(|(_, p)| p).sum::<f64>().min(1.0)
    }

    fn quantile(&self, p: f64) -> f64 {
        reached(self.pairs(), p)
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        reached(self.pairs().rev(), q)
    }

    fn support(&self) -> (f64, f64) {
        finite::ends(&self.values)
    }

    fn sum(&self, g: &dyn Fn(f64) -> f64) -> Option<f64> {
        Some(self.pairs().map(|(value, p)| p * g(value)).sum())
    }

    fn steps(&self) -> Vec<[f64; 2]> {
        let mut sum = 0.0;
        finite::steps(&self.values, |index| {
            sum += self.probabilities.get(index).copied().unwrap_or(0.0);
            f64::min(sum, 1.0)
        })
    }

    fn sampler(&self) -> Sampler {
        Sampler::discrete(&self.values, &self.probabilities)
    }

    fn of_score(&self) -> Option<OfScore> {
        None
    }
}

impl Discrete {
    /// Values with their probabilities.
    fn pairs(
        &self,
    ) -> impl DoubleEndedIterator<Item = (f64, f64)> + ExactSizeIterator + Clone + '_ {
        self.values
            .iter()
            .copied()
            .zip(self.probabilities.iter().copied())
    }

    fn with_values(&self, values: impl Iterator<Item = f64>) -> Self {
        Discrete {
            values: values.collect(),
            probabilities: Arc::clone(&self.probabilities),
        }
    }
}

/// First value at which the running sum of probabilities reaches p.
fn reached(pairs: impl Iterator<Item = (f64, f64)>, p: f64) -> f64 {
    let mut sum = 0.0;
    let mut last = f64::NAN;
    for (value, probability) in pairs {
        if probability > 0.0 {
            sum += probability;
            last = value;
            // A sum that misses p by rounding only has reached it.
            if sum >= p * (1.0 - 1e-14) {
                break;
            }
        }
    }
    last
}
