//! Draws with replacement from a sample.

use std::sync::Arc;

use gumption_fault::say;
use gumption_lanes::Sampler;
use gumption_lanes::quantile::OfScore;

use super::finite;
use super::stating::ParameterError;
use super::univariate::{Kind, Parameter, Univariate};

/// Draws with replacement from a sample (ascending).
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Empirical {
    /// The sample, ascending.
    pub sample: Arc<[f64]>,
}

impl Univariate for Empirical {
    const KIND: Kind = Kind {
        key: "empirical",
        aliases: &["sample"],
        name_en: "empirical",
        name_zh: "经验分布",
        parameters: "draws with replacement from a sample x_1 … x_n",
        expectation: "Σ x_i/n",
        variance: "Σ (x_i - x)²/n",
        source: "JCGM 101:2008, 6.5",
        use_when: "the sample itself is the knowledge, such as the result of an earlier Monte \
                   Carlo evaluation",
        stated_by: Some("sample"),
    };

    fn validate(&self) -> Result<(), ParameterError> {
        if self.sample.is_empty() {
            return Err(ParameterError::Unusable {
                message: say!("the sample is empty, but must hold at least one value"),
                help: say!("state the values"),
            });
        }
        finite::ascending(&say!("sample"), &self.sample)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        vec![("sample", Parameter::Numbers(&self.sample))]
    }

    fn shifted(&self, by: f64) -> Self {
        self.sample.iter().map(|x| x + by).collect()
    }

    fn stretched(&self, by: f64) -> Self {
        self.sample.iter().map(|x| x * by).collect()
    }

    fn mirrored(&self) -> Option<Self> {
        Some(self.sample.iter().rev().map(|x| -x).collect())
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
        self.sample.partition_point(|value| *value <= x) as f64 / self.sample.len() as f64
    }

    fn quantile(&self, p: f64) -> f64 {
        self.ranked((p * self.sample.len() as f64).ceil())
    }

    fn upper_quantile(&self, q: f64) -> f64 {
        let n = self.sample.len() as f64;
        self.ranked(n - (q * n).ceil() + 1.0)
    }

    fn support(&self) -> (f64, f64) {
        finite::ends(&self.sample)
    }

    fn sum(&self, g: &dyn Fn(f64) -> f64) -> Option<f64> {
        let sum: f64 = self.sample.iter().map(|value| g(*value)).sum();
        Some(sum / self.sample.len() as f64)
    }

    fn steps(&self) -> Vec<[f64; 2]> {
        let count = self.sample.len() as f64;
        finite::steps(&self.sample, |index| (index + 1) as f64 / count)
    }

    fn sampler(&self) -> Sampler {
        Sampler::Empirical {
            sample: Arc::clone(&self.sample),
        }
    }

    fn of_score(&self) -> Option<OfScore> {
        None
    }
}

impl Empirical {
    /// Values with their probabilities.
    fn pairs(&self) -> impl Iterator<Item = (f64, f64)> + Clone + '_ {
        let p = 1.0 / self.sample.len() as f64;
        self.sample.iter().map(move |x| (*x, p))
    }

    /// The value of this rank, counted from 1 and kept inside the sample.
    fn ranked(&self, rank: f64) -> f64 {
        let last = self.sample.len().saturating_sub(1);
        let index = (rank.max(1.0) as usize - 1).min(last);
        self.sample.get(index).copied().unwrap_or(f64::NAN)
    }
}

impl FromIterator<f64> for Empirical {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Empirical {
            sample: values.into_iter().collect(),
        }
    }
}
