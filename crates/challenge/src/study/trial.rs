//! Which cases are made, and what is done to them where a proof is meant to fail.

use gumption_lab::diagnose::catalogue::effects;
use serde::{Deserialize, Serialize};

use crate::case::{Bench, Request, SealedCase, challenge};
use crate::files::{CASE, CaseFile, RECORDING};
use crate::further::Further;
use crate::scenario::{Class, NoiseKnowledge};
use crate::truth::Truth;

/// What is done to a case before it is diagnosed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ablation {
    /// Nothing.
    Whole,
    /// The names that are right are taken out of the catalogue.
    WithoutTruth,
    /// Temperature, humidity, pressure, supply and vibration are those of another case.
    ForeignConditions,
}

/// A case to run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Seed of the case.
    pub seed: u64,
    /// Where it is measured.
    pub bench: Bench,
    /// What is concealed.
    pub class: Class,
    /// How the noise is claimed.
    pub noise: NoiseKnowledge,
    /// What is done to it.
    pub ablation: Ablation,
}

/// The seeds of the study begin here. A batch of seeds is used once: whoever changes the diagnosis after
/// having looked at its results moves on to seeds that nobody has seen.
pub const FIRST_SEED: u64 = 671_590_228;

/// How many cases the study has: enough for intervals that decide.
pub const CASES: usize = 4000;

/// The first cases of a study, of which any number is a sample of the whole: in every five one conceals nothing, one
/// something that no catalogue names, one two effects; rigs, instruments and ways to know the noise take turns.
/// Ablations follow their case: the true name is taken out of every other case with one effect, and where that effect
/// follows a condition the conditions are exchanged.
pub fn trials(first_seed: u64, cases: usize) -> Vec<Trial> {
    const CLASSES: [Class; 5] = [
        Class::Null,
        Class::Outside,
        Class::Double,
        Class::Single,
        Class::Single,
    ];
    let benches = Bench::all();
    let mut trials = Vec::new();
    for number in 0..cases {
        let turn = number / CLASSES.len();
        let bench = benches[turn % benches.len()];
        // At rest only rigs are recorded; that is the last way.
        let ways = NoiseKnowledge::ALL.len() - usize::from(bench.rig().is_none());
        let way = turn / benches.len() + number % CLASSES.len() + turn % benches.len();
        let whole = Trial {
            seed: first_seed + number as u64,
            bench,
            class: CLASSES[number % CLASSES.len()],
            noise: NoiseKnowledge::ALL[way % ways].0,
            ablation: Ablation::Whole,
        };
        trials.push(whole);
        let ablation = match number % CLASSES.len() {
            3 => Ablation::WithoutTruth,
            4 => Ablation::ForeignConditions,
            _ => continue,
        };
        trials.push(Trial { ablation, ..whole });
    }
    trials
}

impl Trial {
    /// The case, as it is handed to the diagnosis; nothing where the ablation would not touch what is concealed.
    pub fn case(&self) -> Option<SealedCase> {
        let request = self.request();
        let mut case = challenge(&request);
        match self.ablation {
            Ablation::Whole => {}
            Ablation::WithoutTruth => {
                let excluded = without(&case.truth);
                let file = case.files.iter_mut().find(|file| file.name == CASE)?;
                file.text += &excluded;
            }
            Ablation::ForeignConditions => {
                let names = || case.truth.effects.iter().flat_map(|effect| &effect.names);
                let follows = |column: &String| CONDITIONS.contains(&column.as_str());
                if !names().any(|name| name.along.iter().any(follows)) {
                    return None;
                }
                let other = challenge(&Request {
                    seed: self.seed ^ 0x5eed,
                    ..request
                });
                exchange(&mut case.files, &other.files);
            }
        }
        Some(case)
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
        self.class == Class::Single && self.ablation == Ablation::Whole
    }

    /// How `gumption challenge` makes the case again.
    pub fn command(&self) -> String {
        command(self.seed, self.bench.name(), self.class, self.noise)
    }

    fn request(&self) -> Request {
        Request {
            seed: self.seed,
            bench: Some(self.bench),
            class: Some(self.class),
            noise: Some(self.noise),
            ..Request::default()
        }
    }
}

/// How `gumption challenge` makes a case of a study again.
pub(super) fn command(seed: u64, bench: &str, class: Class, noise: NoiseKnowledge) -> String {
    let noise = noise.name();
    format!(
        "--rig {bench} --class {} --noise {noise} --seed {seed}",
        class.name()
    )
}

/// The part of an experiment that takes the right names away.
fn without(truth: &Truth) -> String {
    let names = truth.effects.iter().flat_map(|effect| &effect.names);
    // What the catalogue does not have yet cannot be taken out of it.
    let known = |id: &&str| effects().iter().any(|effect| effect.id.as_str() == *id);
    let mut names: Vec<&str> = names.map(|name| name.id.as_str()).filter(known).collect();
    names.sort_unstable();
    names.dedup();
    format!("\n[diagnosis]\nexclude = {names:?}\n")
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
    let split = |line: &'_ str| -> Vec<String> { line.split(',').map(str::to_owned).collect() };
    let (own, foreign): (Vec<_>, Vec<_>) = (
        own.lines().map(split).collect(),
        foreign.lines().map(split).collect(),
    );
    let [(heads, rows), (foreign_heads, others)] = [&own, &foreign].map(|lines| {
        lines
            .split_first()
            .map_or((&[][..], &[][..]), |(h, r)| (&h[..], r))
    });
    if others.is_empty() {
        return;
    }
    let mut lines = vec![heads.join(",")];
    for (row, mine) in rows.iter().enumerate() {
        // Where the other recording has another length, it is taken as a whole.
        let theirs = &others[row * others.len() / rows.len()];
        let fields = heads.iter().zip(mine).map(|(head, field)| {
            let is_condition = CONDITIONS.iter().any(|name| head.starts_with(name));
            let at = foreign_heads.iter().position(|other| other == head);
            let foreign = at.filter(|_| is_condition).and_then(|at| theirs.get(at));
            foreign.unwrap_or(field).as_str()
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
    fn a_study_has_the_classes_and_benches_that_it_should_have() {
        let trials = trials(FIRST_SEED, 1000);
        let whole: Vec<&Trial> = trials
            .iter()
            .filter(|t| t.ablation == Ablation::Whole)
            .collect();
        let seeds: BTreeSet<u64> = whole.iter().map(|t| t.seed).collect();
        assert_eq!(seeds.len(), 1000);
        for class in [Class::Null, Class::Outside, Class::Double] {
            let of_class = whole.iter().filter(|t| t.class == class);
            assert_eq!(of_class.count(), 200, "{class:?}");
        }
        let benches: BTreeSet<&str> = whole.iter().map(|t| t.bench.name()).collect();
        assert!(benches.len() >= 4 + 8);
        for (noise, name) in NoiseKnowledge::ALL {
            let nulls = whole
                .iter()
                .filter(|t| t.class == Class::Null && t.noise == noise);
            assert!(nulls.count() >= 5, "{name}");
        }
    }

    #[test]
    fn foreign_conditions_leave_the_outputs() {
        for (bench, output) in [("remount", "U"), ("load-cell", "deflection")] {
            let made = (0..400).find_map(|seed| {
                let whole = Trial {
                    seed,
                    bench: bench.parse().ok()?,
                    class: Class::Single,
                    noise: NoiseKnowledge::Stated,
                    ablation: Ablation::Whole,
                };
                let ablation = Ablation::ForeignConditions;
                Some((whole.case()?, Trial { ablation, ..whole }.case()?))
            });
            let (whole, foreign) = made.unwrap();
            let column = |case: &SealedCase, name: &str| -> Vec<String> {
                let text = &case
                    .files
                    .iter()
                    .find(|f| f.name == RECORDING)
                    .unwrap()
                    .text;
                let head: Vec<&str> = text.lines().next().unwrap().split(',').collect();
                let at = head.iter().position(|h| h.starts_with(name)).unwrap();
                let fields = text.lines().skip(1).map(|l| l.split(',').nth(at).unwrap());
                fields.map(str::to_owned).collect()
            };
            assert_eq!(column(&whole, output), column(&foreign, output));
            assert_ne!(column(&whole, "supply"), column(&foreign, "supply"));
        }
    }
}
