//! Instruments beyond the rigs: an entry of `instruments.toml` each, simulated row by row by one and the same
//! program, with effects and noise whose forms come from wider families than those of any catalogue.
//!
//! | chapter | holds |
//! |---|---|
//! | `campaign` | when and at which stimuli it is read, and what the room does meanwhile |
//! | `family` | what can be concealed, and the forms in which it comes |
//! | `history` | forms that remember: relaxations, plays, hysteresis |
//! | `noise` | the noise of the rows and its covariance |
//! | `bench` | readings with effects, and what of them is visible |
//! | `concealed` | drawing a case, its truth and its files |

mod bench;
mod campaign;
mod concealed;
mod family;
mod history;
mod noise;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use gumption_core::model::{MeasurandSource, Model, Request, Role, Symbol, compile};
use gumption_core::quantity::{Unit, UnitTable};
use serde::Deserialize;

pub(super) use concealed::{Asked, Case};

/// An instrument: how a recording of it is taken, and its textbook model.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instrument {
    /// Its name on the command line and in files.
    pub name: String,
    title: String,
    prose: String,
    /// `output = formula`, dimensionless.
    reads: Vec<String>,
    #[serde(default)]
    declared: Vec<String>,
    compares: Option<String>,
    zero: Option<String>,
    unit: String,
    noise: f64,
    digits: usize,
    interval: f64,
    runs: [usize; 2],
    /// Rows of a run, where no stimulus says it.
    #[serde(default)]
    rows: Option<[usize; 2]>,
    /// Of a converter.
    #[serde(default)]
    bits: u32,
    truth: BTreeMap<String, f64>,
    per: Option<Per>,
    stimuli: Vec<Stimulus>,
    conditions: Vec<String>,
    #[serde(default)]
    extra: String,
}

/// A parameter with a value of its own for each label of a column.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Per {
    parameter: String,
    column: String,
    /// Name of the value in `reads`.
    latent: String,
    low: f64,
    high: f64,
}

/// What is applied.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stimulus {
    name: String,
    #[serde(default)]
    unit: String,
    course: Course,
    low: f64,
    high: f64,
    /// Values of a run, from and to; the first stimulus says how many rows there are.
    #[serde(default)]
    steps: Option<[usize; 2]>,
    #[serde(default)]
    digits: usize,
    #[serde(default = "stimulus")]
    role: String,
}

fn stimulus() -> String {
    "stimulus".into()
}

/// How the values of a stimulus follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Course {
    /// Up and down again.
    Loop,
    /// Up, in each run.
    Rise,
    /// Set points in arbitrary order.
    Shuffled,
    /// Anywhere.
    Random,
    /// Moving all the time, up and down.
    Ramp,
    /// A few plateaus of several rows.
    Hold,
    /// Labels from `low` to `high` in arbitrary order.
    Labels,
    /// A component of a direction that is anywhere on the sphere; three of them follow each other. Not recorded.
    Attitude,
}

impl Stimulus {
    /// Whether it goes to both sides of zero.
    fn is_two_sided(&self) -> bool {
        self.low < 0.0 && self.high > 0.0
    }

    /// Whether effects can follow its value.
    fn is_followed(&self) -> bool {
        !matches!(self.course, Course::Labels | Course::Attitude)
    }

    /// Whether it moves while it is read.
    fn is_moving(&self) -> bool {
        self.course == Course::Ramp
    }

    /// Whether it goes on in its direction, so that what remembers it differs from what does not.
    fn has_history(&self) -> bool {
        matches!(self.course, Course::Loop | Course::Ramp | Course::Hold)
    }
}

impl Instrument {
    /// All instruments, in the order of their entries.
    pub fn all() -> &'static [Instrument] {
        #[derive(Deserialize)]
        struct File {
            instrument: Vec<Instrument>,
        }
        static ALL: LazyLock<Vec<Instrument>> = LazyLock::new(|| {
            let file: Result<File, _> = toml::from_str(include_str!("instruments.toml"));
            // A test holds that the entries, a part of the program, can be read.
            file.map(|file| file.instrument).unwrap_or_default()
        });
        &ALL
    }

    /// Names of the outputs with their formulas.
    fn outputs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.reads
            .iter()
            .filter_map(|text| text.split_once('='))
            .map(|(name, formula)| (name.trim(), formula.trim()))
    }

    /// Whether the declared model compares the length of a vector.
    fn is_norm(&self) -> bool {
        self.compares.is_some()
    }

    /// Quantities that formulas may use: stimuli, the latent value of a label, readings, then parameters.
    fn quantities(&self) -> Vec<String> {
        let stimuli = self.stimuli.iter().map(|s| s.name.clone());
        let latent = self.per.iter().map(|per| per.latent.clone());
        let outputs = self.outputs().map(|(name, _)| name.to_owned());
        let truth = self.truth.keys().cloned();
        stimuli.chain(latent).chain(outputs).chain(truth).collect()
    }

    /// What the readings are, and what the declared model compares with zero, as functions of [`Self::quantities`].
    fn compiled(&self) -> Option<Formulas> {
        let names = self.quantities();
        let symbols: Vec<Symbol> = names
            .iter()
            .enumerate()
            .map(|(place, name)| Symbol {
                name: name.as_str().into(),
                unit: Unit::one(),
                role: Role::Input(place),
            })
            .collect();
        let model = |texts: &[String]| {
            let targets: Vec<String> = (0..texts.len()).map(|k| format!("result_{k}")).collect();
            let measurands: Vec<MeasurandSource<'_>> = targets
                .iter()
                .zip(texts)
                .map(|(name, text)| MeasurandSource {
                    name,
                    model: Some(text),
                    unit: None,
                })
                .collect();
            let request = Request {
                symbols: &symbols,
                shared: None,
                measurands: &measurands,
                units: &UnitTable::default(),
            };
            compile(&request).ok()
        };
        let formulas: Vec<String> = self.outputs().map(|(_, text)| text.to_owned()).collect();
        let residuals = match &self.compares {
            Some(text) => vec![text.clone()],
            None => {
                let residual = |(name, formula): (&str, &str)| format!("{name} - ({formula})");
                self.outputs().map(residual).collect()
            }
        };
        Some(Formulas {
            reads: model(&formulas)?,
            residuals: model(&residuals)?,
        })
    }
}

/// The compiled formulas of an instrument.
#[derive(Debug, Clone)]
struct Formulas {
    reads: Model,
    residuals: Model,
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_entry_can_be_read_and_computed() {
        let all = Instrument::all();
        assert!(all.len() >= 8, "{}", all.len());
        let names: BTreeSet<&str> = all.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names.len(), all.len());
        for one in all {
            assert!(one.compiled().is_some(), "{}", one.name);
            assert_eq!(one.outputs().count(), one.reads.len(), "{}", one.name);
        }
    }
}
