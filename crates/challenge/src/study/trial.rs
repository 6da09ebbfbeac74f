//! Which cases are made, and what is done to them where a proof is meant to fail.

use std::path::Path;

use nalgebra::DVector;

use crate::case::{Request, SealedCase, challenge, dwell, signatures};
use crate::files::{CASE, CaseFile, RECORDING};
use crate::further::Further;
use crate::scenario::{Class, NoiseKnowledge, Scenario};

/// What is done to a case before it is diagnosed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Ablation {
    /// Nothing.
    Whole,
    /// The names that are right are taken out of the catalogue.
    WithoutTruth,
    /// Temperature, humidity, pressure, supply and vibration are those of another case.
    ForeignConditions,
}

impl Ablation {
    /// The word in tables and files.
    pub fn word(self) -> &'static str {
        match self {
            Ablation::Whole => "whole",
            Ablation::WithoutTruth => "without-truth",
            Ablation::ForeignConditions => "foreign-conditions",
        }
    }

    /// The ablation of a word.
    pub fn of_word(word: &str) -> Option<Ablation> {
        [
            Ablation::Whole,
            Ablation::WithoutTruth,
            Ablation::ForeignConditions,
        ]
        .into_iter()
        .find(|ablation| ablation.word() == word)
    }
}

/// A case to run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Seed of the case.
    pub seed: u64,
    /// What is concealed.
    pub scenario: Scenario,
    /// How the noise is claimed.
    pub noise: NoiseKnowledge,
    /// What is done to it.
    pub ablation: Ablation,
}

/// The seeds of the study begin here. A batch of seeds is used once: whoever changes the diagnosis after
/// having looked at its results moves on to seeds that nobody has seen.
pub const FIRST_SEED: u64 = 89_000_000;

/// How many cases of every scenario the study has: enough for intervals that decide.
pub const EACH: usize = 15;

/// How many cases of the study conceal nothing.
pub const NULLS: usize = 1000;

/// All trials of a study: every scenario `each` times, half with stated noise and half with noise from
/// a recording at rest; `nulls` cases without any effect; and the ablations, `each` / 3 of every single
/// effect. A trial does not depend on how many there are.
pub fn trials(first_seed: u64, each: usize, nulls: usize) -> Vec<Trial> {
    let all = Scenario::all();
    let mut trials = Vec::new();
    for (number, scenario) in all.iter().enumerate() {
        if scenario.class == Class::Null {
            continue;
        }
        for k in 0..each {
            let whole = trial(first_seed, number, k, *scenario, Ablation::Whole);
            trials.push(whole);
            let covariates = scenario.class == Class::Single
                && scenario
                    .effects
                    .iter()
                    .any(|effect| effect.follows_conditions());
            if scenario.class == Class::Single && k < each.div_ceil(3) {
                trials.push(Trial {
                    ablation: Ablation::WithoutTruth,
                    ..whole
                });
            }
            if covariates {
                trials.push(Trial {
                    ablation: Ablation::ForeignConditions,
                    ..whole
                });
            }
        }
    }
    let quiet: Vec<(usize, Scenario)> = all
        .iter()
        .enumerate()
        .filter(|(_, scenario)| scenario.class == Class::Null)
        .map(|(number, scenario)| (number, *scenario))
        .collect();
    for k in 0..nulls {
        let (number, scenario) = quiet[turn(k, quiet.len())];
        trials.push(trial(first_seed, number, k, scenario, Ablation::Whole));
    }
    trials
}

/// Which rig has its turn: the last one, whose cases take ten times as long, only every tenth time.
fn turn(k: usize, rigs: usize) -> usize {
    if k % 10 == 9 {
        rigs - 1
    } else {
        k % 10 % (rigs - 1).max(1)
    }
}

fn trial(first: u64, number: usize, k: usize, scenario: Scenario, ablation: Ablation) -> Trial {
    let noise = if (number + k / 10 + k).is_multiple_of(2) {
        NoiseKnowledge::Stated
    } else {
        NoiseKnowledge::AtRest
    };
    Trial {
        seed: first + 10_000 * number as u64 + k as u64,
        scenario,
        noise,
        ablation,
    }
}

impl Trial {
    /// The case, as it is handed to the diagnosis.
    pub fn case(&self) -> SealedCase {
        let request = self.request();
        let mut case = challenge(&request);
        if self.ablation == Ablation::ForeignConditions {
            let other = challenge(&Request {
                seed: self.seed ^ 0x5eed,
                ..request
            });
            exchange(&mut case.files, &other.files);
        }
        case
    }

    /// The case with a further measurement behind its calibration.
    pub fn longer_case(&self, further: Further) -> SealedCase {
        challenge(&Request {
            further: Some(further),
            ..self.request()
        })
    }

    /// Whether one effect is concealed and nothing was done to the case.
    pub fn is_single(&self) -> bool {
        self.scenario.class == Class::Single && self.ablation == Ablation::Whole
    }

    /// What each concealed effect adds to the recording, see [`signatures`].
    pub fn signatures(&self) -> Vec<DVector<f64>> {
        signatures(&self.request())
    }

    /// Mean time between readings, see [`dwell`].
    pub fn dwell(&self) -> f64 {
        dwell(&self.request())
    }

    fn request(&self) -> Request {
        Request {
            seed: self.seed,
            scenario: Some(self.scenario),
            noise: Some(self.noise),
            ..Request::default()
        }
    }

    /// Writes the case into a folder.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, case: &SealedCase, folder: &Path) -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        for file in &case.files {
            let mut text = file.text.clone();
            if file.name == CASE && self.ablation == Ablation::WithoutTruth {
                text += &without(&self.scenario);
            }
            std::fs::write(folder.join(file.name), text)?;
        }
        Ok(())
    }
}

/// The part of a case file that takes the right names away.
fn without(scenario: &Scenario) -> String {
    let mut names: Vec<String> = scenario
        .effects
        .iter()
        .flat_map(|effect| crate::names::accepted_ids(*effect))
        .map(|id| format!("\"{id}\""))
        .collect();
    names.sort();
    names.dedup();
    format!("\n[diagnosis]\nexclude = [{}]\n", names.join(", "))
}

/// Conditions that an ablation exchanges.
const CONDITIONS: [&str; 5] = ["temperature", "humidity", "pressure", "supply", "vibration"];

/// Replaces the conditions of a recording by those of another, row by row.
fn exchange(files: &mut [CaseFile], other: &[CaseFile]) {
    let text = |files: &[CaseFile]| {
        files
            .iter()
            .find(|file| file.name == RECORDING)
            .map(|file| file.text.clone())
    };
    let (Some(own), Some(foreign)) = (text(files), text(other)) else {
        return;
    };
    let mut lines = Vec::new();
    let heads: Vec<&str> = own.lines().next().unwrap_or_default().split(',').collect();
    let foreign_heads: Vec<&str> = foreign
        .lines()
        .next()
        .unwrap_or_default()
        .split(',')
        .collect();
    let condition = |head: &str| CONDITIONS.iter().any(|name| head.starts_with(name));
    for (row, (mine, theirs)) in own.lines().zip(foreign.lines()).enumerate() {
        if row == 0 {
            lines.push(mine.to_string());
            continue;
        }
        let theirs: Vec<&str> = theirs.split(',').collect();
        let fields = heads.iter().zip(mine.split(',')).map(|(head, field)| {
            let at = foreign_heads.iter().position(|other| other == head);
            at.filter(|_| condition(head))
                .and_then(|at| theirs.get(at))
                .unwrap_or(&field)
                .to_string()
        });
        lines.push(fields.collect::<Vec<_>>().join(","));
    }
    if let Some(file) = files.iter_mut().find(|file| file.name == RECORDING) {
        file.text = lines.join("\n") + "\n";
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn a_study_is_as_large_as_it_should_be_and_no_case_comes_twice() {
        let trials = trials(FIRST_SEED, EACH, NULLS);
        let whole: Vec<&Trial> = trials
            .iter()
            .filter(|t| t.ablation == Ablation::Whole)
            .collect();
        let seeds: BTreeSet<u64> = whole.iter().map(|t| t.seed).collect();
        assert_eq!(seeds.len(), whole.len());
        let nulls = whole
            .iter()
            .filter(|t| t.scenario.class == Class::Null)
            .count();
        assert!(nulls >= 1000 && whole.len() - nulls >= 600);
        let outside = whole
            .iter()
            .filter(|t| t.scenario.class == Class::Outside)
            .count();
        assert!(outside > 60);
    }

    #[test]
    fn foreign_conditions_leave_the_outputs() {
        let scenario = Scenario::all()
            .into_iter()
            .find(|s| s.name() == "remount+supply")
            .unwrap();
        let whole = trial(FIRST_SEED, 3, 1, scenario, Ablation::Whole);
        let foreign = Trial {
            ablation: Ablation::ForeignConditions,
            ..whole
        };
        let column = |trial: &Trial, name: &str| -> Vec<String> {
            let case = trial.case();
            let text = &case
                .files
                .iter()
                .find(|f| f.name == RECORDING)
                .unwrap()
                .text;
            let head: Vec<&str> = text.lines().next().unwrap().split(',').collect();
            let at = head.iter().position(|h| h.starts_with(name)).unwrap();
            text.lines()
                .skip(1)
                .map(|l| l.split(',').nth(at).unwrap().to_string())
                .collect()
        };
        assert_eq!(column(&whole, "U"), column(&foreign, "U"));
        assert_ne!(column(&whole, "supply"), column(&foreign, "supply"));
    }
}
