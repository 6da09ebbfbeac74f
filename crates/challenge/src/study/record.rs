//! What is kept of a run: enough for every table, and little enough to be kept for ever. A line of JSON each.

use serde::{Deserialize, Serialize};

use super::further::Sequel;
use super::trial::{Ablation, Trial};
use crate::case::SealedCase;
use crate::grade::{Answer, Finding, Graded, State};
use crate::scenario::{Class, NoiseKnowledge};

/// What became of one concealed effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// What it was.
    pub physics: String,
    /// Whether it has a name.
    pub nameable: bool,
    /// Whether it happens once, so that nobody can predict it.
    pub once: bool,
    /// λ beside the other effects.
    pub lambda: f64,
    /// What the nearest rival leaves of it, of the simulator or of the catalogue.
    pub kappa: f64,
    /// What became of it.
    pub finding: Finding,
    /// Whether it was identified though another name gives the same recording.
    pub overclaimed: bool,
    /// Deviation of the size from the truth, in half-widths of its 95 % interval.
    pub deviation: Option<f64>,
    /// Whether axis or moment is right, where one is stated.
    pub located: Option<bool>,
}

/// What twin runs of the simulator say of a concealed effect and of the name that it was given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twin {
    /// What the nearest wrong candidate of the catalogue leaves of it, over its length.
    pub nearest: f64,
    /// Deviation of the size, in half-widths of its 95 % interval: from that with which the variant that was
    /// named comes nearest to what the effect adds to the recording.
    pub deviation: Option<f64>,
    /// Whether axis or moment is right, where one is stated.
    pub located: Option<bool>,
}

/// One run of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Seed of the case.
    pub seed: u64,
    /// Rig or instrument.
    pub bench: String,
    /// Bench and what is concealed.
    pub scenario: String,
    /// Its class, as a study counts it.
    pub class: Class,
    /// How the noise was claimed.
    pub noise: NoiseKnowledge,
    /// What was done to the case.
    pub ablation: Ablation,
    /// Verdict of the diagnosis.
    pub verdict: String,
    /// Whether anything was noticed.
    pub noticed: bool,
    /// Concealed effects.
    pub outcomes: Vec<Outcome>,
    /// Identified names that are wrong.
    pub wrong_names: Vec<String>,
    /// Names that it was wrongly said to act like.
    pub wrong_likes: Vec<String>,
    /// Lists that hold nothing right.
    pub wrong_lists: usize,
    /// Lengths of all lists.
    pub lists: Vec<usize>,
    /// Error of the prediction of a fresh recording over the noise that it has in truth.
    pub predicted: Option<f64>,
    /// Seconds that the diagnosis took.
    pub seconds: f64,
    /// Points and the most that could be had.
    pub points: [f64; 2],
    /// What became of a list for which a further measurement was asked.
    pub further: Option<Sequel>,
}

impl Record {
    /// What is kept of a graded answer.
    pub fn of(trial: &Trial, sealed: &SealedCase, graded: &Graded, answer: &Answer) -> Record {
        let outcomes = graded.effects.iter().map(|effect| Outcome {
            physics: effect.truth.physics.clone(),
            nameable: effect.truth.nameable,
            once: effect.truth.once,
            lambda: effect.truth.lambda_beside,
            kappa: effect.truth.kappa,
            finding: effect.finding,
            overclaimed: effect.overclaimed,
            deviation: None,
            located: None,
        });
        let lists = answer
            .effects
            .iter()
            .filter(|effect| effect.state == State::OneOf);
        Record {
            seed: trial.seed,
            bench: sealed.truth.bench.clone(),
            scenario: sealed.truth.scenario.clone(),
            class: sealed.truth.class.counted(),
            noise: trial.noise,
            ablation: trial.ablation,
            verdict: answer.verdict.clone(),
            noticed: answer.has_noticed(),
            outcomes: outcomes.collect(),
            wrong_names: graded.wrong_names.clone(),
            wrong_likes: graded.wrong_likes.clone(),
            wrong_lists: graded.wrong_lists.len(),
            lists: lists.map(|effect| effect.named.len()).collect(),
            predicted: predicted(answer, &sealed.truth.sigma),
            seconds: f64::NAN,
            points: [graded.points, graded.attainable],
            further: None,
        }
    }

    /// Adds what twin runs say of each effect: κ is what the nearest rival leaves, of the simulator or of the
    /// catalogue.
    pub fn complete(&mut self, twins: &[Twin]) {
        for (outcome, twin) in self.outcomes.iter_mut().zip(twins) {
            outcome.kappa = outcome.kappa.min(outcome.lambda * twin.nearest);
            outcome.deviation = twin.deviation;
            outcome.located = twin.located;
        }
    }

    /// Whether nothing was done to the case.
    pub fn is_whole(&self) -> bool {
        self.ablation == Ablation::Whole
    }

    /// Whether it is the record of a trial.
    pub fn is_of(&self, trial: &Trial) -> bool {
        self.seed == trial.seed
            && self.ablation == trial.ablation
            && self.bench == trial.bench.name()
    }
}

impl Outcome {
    /// Whether the right name stands alone, in whichever grade.
    pub(super) fn is_alone(&self) -> bool {
        matches!(self.finding, Finding::Identified | Finding::ActsLike)
    }

    /// Whether the right name is there, alone or in a list.
    pub(super) fn is_named_or_listed(&self) -> bool {
        self.is_alone() || matches!(self.finding, Finding::Listed(_))
    }
}

/// Error of the prediction of the held-out recording over the noise that it has in truth, all outputs together.
fn predicted(answer: &Answer, sigma: &[f64]) -> Option<f64> {
    let held = answer.held_out.as_ref()?;
    let rms = &held.after.as_ref().unwrap_or(&held.before).rms;
    let squares = rms
        .iter()
        .zip(sigma)
        .map(|(rms, sigma)| (rms / sigma) * (rms / sigma));
    (rms.len() == sigma.len()).then(|| libm::sqrt(squares.sum::<f64>() / rms.len() as f64))
}

/// Records as lines.
pub fn write(records: &[Record]) -> String {
    let lines = records
        .iter()
        .filter_map(|record| serde_json::to_string(record).ok());
    lines.map(|line| line + "\n").collect()
}

/// Records from lines; those that are none are left out.
pub fn read(text: &str) -> Vec<Record> {
    text.lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect()
}
