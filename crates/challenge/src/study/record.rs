//! What is kept of a run: enough for every table, and little enough to be kept for ever.

use crate::grade::{Answer, Finding, Graded};
use crate::scenario::{Class, NoiseKnowledge, Scenario};

use super::further::Sequel;
use super::trial::{Ablation, Trial};

/// What became of one concealed effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// What it was.
    pub physics: String,
    /// Whether it has a name.
    pub nameable: bool,
    /// λ beside the other effects.
    pub lambda: f64,
    /// κ.
    pub kappa: f64,
    /// `unique`, `list-3`, `unexplained`, `missed`.
    pub finding: String,
    /// Whether the unique name has an alias.
    pub overclaimed: bool,
    /// Posterior of the right name.
    pub probability: f64,
    /// Deviation of the size from the truth, in half-widths of its 95 % interval.
    pub deviation: f64,
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
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Seed of the case.
    pub seed: u64,
    /// Scenario by name.
    pub scenario: String,
    /// Its class.
    pub class: Class,
    /// How the noise was claimed.
    pub noise: NoiseKnowledge,
    /// What was done to the case.
    pub ablation: Ablation,
    /// Verdict of the diagnosis.
    pub verdict: String,
    /// Concealed effects.
    pub outcomes: Vec<Outcome>,
    /// Unique names that are wrong, with their posteriors.
    pub wrong_names: Vec<(String, f64)>,
    /// Lists that hold nothing right.
    pub wrong_lists: usize,
    /// χ²/dof before and after.
    pub chi: [f64; 2],
    /// Degrees of freedom of χ² after.
    pub dof: f64,
    /// Error of predictions over the noise, before and after.
    pub held_out: [f64; 2],
    /// Points and the most that could be had.
    pub points: [f64; 2],
    /// Names that rivals gave: forward selection by BIC, the w-test.
    pub rivals: Vec<(String, String)>,
    /// What became of a list for which a further measurement was asked.
    pub further: Option<Sequel>,
}

impl Record {
    /// What is kept of a graded answer.
    pub fn of(trial: &Trial, graded: &Graded, answer: &Answer) -> Record {
        let outcomes = graded.effects.iter().map(|effect| Outcome {
            physics: effect.truth.physics.name(),
            nameable: effect.truth.nameable,
            lambda: effect.truth.lambda_beside,
            kappa: effect.truth.kappa,
            finding: word(effect.finding),
            overclaimed: effect.overclaimed,
            probability: effect.probability.unwrap_or(f64::NAN),
            deviation: f64::NAN,
            located: None,
        });
        let quality = |of: fn(&crate::grade::Quality) -> Option<f64>| {
            [&answer.before, &answer.after]
                .map(|quality| quality.as_ref().and_then(of).unwrap_or(f64::NAN))
        };
        Record {
            seed: trial.seed,
            scenario: trial.scenario.name(),
            class: trial.scenario.class,
            noise: trial.noise,
            ablation: trial.ablation,
            verdict: answer.verdict.clone(),
            outcomes: outcomes.collect(),
            wrong_names: graded.wrong_names.clone(),
            wrong_lists: graded.wrong_lists.len(),
            chi: quality(|q| Some(q.reduced())),
            dof: answer.after.as_ref().map_or(f64::NAN, |after| after.dof),
            held_out: quality(|q| q.held_out()),
            points: [graded.points, graded.attainable],
            rivals: Vec::new(),
            further: None,
        }
    }

    /// Adds what twin runs say of each effect: κ is what the nearest rival leaves, of the simulator or of the
    /// catalogue.
    pub fn complete(&mut self, twins: &[Twin]) {
        for (outcome, twin) in self.outcomes.iter_mut().zip(twins) {
            outcome.kappa = outcome.kappa.min(outcome.lambda * twin.nearest);
            // Beside a list of the right name the size is of a part of the effect.
            let whole = twin
                .deviation
                .filter(|_| outcome.finding == word(Finding::Unique));
            outcome.deviation = whole.unwrap_or(f64::NAN);
            outcome.located = twin.located;
        }
    }

    /// Whether the case was given a single effect and nothing was done to it.
    pub fn is_whole(&self) -> bool {
        self.ablation == Ablation::Whole
    }
}

fn word(finding: Finding) -> String {
    match finding {
        Finding::Unique => "unique".into(),
        Finding::Listed(count) => format!("list-{count}"),
        Finding::Unexplained => "unexplained".into(),
        Finding::Missed => "missed".into(),
    }
}

const HEAD: &str = "seed,scenario,noise,ablation,verdict,effects,wrong_names,wrong_lists,chi_before,chi_after,held_out_before,held_out_after,points,attainable,rivals,dof_after,further";

/// Records as CSV, in the order of scenarios and seeds.
pub fn write(records: &[Record]) -> String {
    let mut text = HEAD.to_string() + "\n";
    for record in records {
        let effects: Vec<String> = record.outcomes.iter().map(outcome).collect();
        let wrong: Vec<String> = record
            .wrong_names
            .iter()
            .map(|(name, p)| format!("{name}:{p:.4}"))
            .collect();
        let rivals: Vec<String> = record
            .rivals
            .iter()
            .map(|(rival, names)| format!("{rival}:{names}"))
            .collect();
        let [before, after] = record.chi;
        let [held_before, held_after] = record.held_out;
        text += &format!(
            "{},{},{},{},{},{},{},{},{before:.3},{after:.3},{held_before:.3},{held_after:.3},{:.2},{:.2},{},{},{}\n",
            record.seed,
            record.scenario,
            noise_word(record.noise),
            record.ablation.word(),
            record.verdict,
            effects.join(" "),
            wrong.join(" "),
            record.wrong_lists,
            record.points[0],
            record.points[1],
            rivals.join(" "),
            record.dof,
            record.further.map_or_else(|| "-".into(), Sequel::word),
        );
    }
    text
}

fn outcome(outcome: &Outcome) -> String {
    format!(
        "{}:{}:{:.2}:{:.2}:{}:{}:{:.4}:{:.3}:{}",
        outcome.physics,
        u8::from(outcome.nameable),
        outcome.lambda,
        outcome.kappa,
        outcome.finding,
        u8::from(outcome.overclaimed),
        outcome.probability,
        outcome.deviation,
        match outcome.located {
            Some(true) => "right",
            Some(false) => "wrong",
            None => "-",
        }
    )
}

fn noise_word(noise: NoiseKnowledge) -> &'static str {
    match noise {
        NoiseKnowledge::Stated => "stated",
        NoiseKnowledge::AtRest => "at-rest",
    }
}

/// Records from CSV; lines that are none are left out.
pub fn read(text: &str) -> Vec<Record> {
    let scenarios = Scenario::all();
    text.lines()
        .skip(1)
        .filter_map(|line| read_line(line, &scenarios))
        .collect()
}

fn read_line(line: &str, scenarios: &[Scenario]) -> Option<Record> {
    let fields: Vec<&str> = line.split(',').collect();
    let number = |at: usize| fields.get(at)?.parse::<f64>().ok();
    let scenario = scenarios.iter().find(|s| s.name() == fields[1])?;
    let list = |at: usize| {
        fields
            .get(at)
            .copied()
            .unwrap_or_default()
            .split_whitespace()
    };
    Some(Record {
        seed: fields[0].parse().ok()?,
        scenario: scenario.name(),
        class: scenario.class,
        noise: if fields[2] == "stated" {
            NoiseKnowledge::Stated
        } else {
            NoiseKnowledge::AtRest
        },
        ablation: Ablation::of_word(fields[3])?,
        verdict: (*fields.get(4)?).into(),
        outcomes: list(5).filter_map(read_outcome).collect(),
        wrong_names: list(6)
            .filter_map(|item| {
                let (name, p) = item.rsplit_once(':')?;
                Some((name.to_string(), p.parse().ok()?))
            })
            .collect(),
        wrong_lists: fields.get(7)?.parse().ok()?,
        chi: [number(8)?, number(9)?],
        held_out: [number(10)?, number(11)?],
        points: [number(12)?, number(13)?],
        rivals: list(14)
            .filter_map(|item| {
                item.split_once(':')
                    .map(|(a, b)| (a.to_string(), b.to_string()))
            })
            .collect(),
        dof: number(15)?,
        further: fields.get(16).copied().and_then(Sequel::of_word),
    })
}

fn read_outcome(item: &str) -> Option<Outcome> {
    let parts: Vec<&str> = item.split(':').collect();
    let [
        physics,
        nameable,
        lambda,
        kappa,
        finding,
        overclaimed,
        probability,
        deviation,
        located,
    ] = parts[..]
    else {
        return None;
    };
    Some(Outcome {
        physics: physics.into(),
        nameable: nameable == "1",
        lambda: lambda.parse().ok()?,
        kappa: kappa.parse().ok()?,
        finding: finding.into(),
        overclaimed: overclaimed == "1",
        probability: probability.parse().ok()?,
        deviation: deviation.parse().ok()?,
        located: match located {
            "right" => Some(true),
            "wrong" => Some(false),
            _ => None,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::super::further::Decision;
    use super::*;

    #[test]
    fn records_survive_the_file() {
        let scenario = Scenario::all()[1];
        let sequel = Sequel::Made("mount=90".parse().unwrap(), Decision::Listed);
        let record = Record {
            seed: 7,
            scenario: scenario.name(),
            class: scenario.class,
            noise: NoiseKnowledge::AtRest,
            ablation: Ablation::Whole,
            verdict: "identified".into(),
            outcomes: vec![Outcome {
                physics: "second-order".into(),
                nameable: true,
                lambda: 9.25,
                kappa: 1.5,
                finding: "list-2".into(),
                overclaimed: false,
                probability: 0.625,
                deviation: -0.5,
                located: Some(true),
            }],
            wrong_names: vec![("drift".into(), 0.99)],
            wrong_lists: 1,
            chi: [4.5, 1.0],
            dof: 33.0,
            held_out: [2.0, 1.125],
            points: [0.9, 1.25],
            rivals: vec![("bic".into(), "drift+step".into())],
            further: Some(sequel),
        };
        assert_eq!(read(&write(std::slice::from_ref(&record))), vec![record]);
    }
}
