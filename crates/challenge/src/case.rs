//! Making a sealed case from a seed.

use nalgebra::DVector;
use rand::RngExt;
use rand::seq::IndexedRandom;

use super::files::{CaseFile, case_file, recordings};
use super::further::Further;
use super::random::{Random, Stream, source};
use super::rig::Rig;
use super::scenario::{Class, Drawn, NoiseKnowledge, Scenario, draw};
use super::schedule::Campaign;
use super::simulate::{Readings, duration, simulate};
use super::strength::Visible;
use super::truth::{Truth, salt, seal};

/// What is asked for; chance decides the rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Request {
    /// Decides everything that is left open.
    pub seed: u64,
    /// Mixed into the salt of the truth, so that the truth cannot be guessed from the seed.
    pub entropy: u64,
    /// Only scenarios of this rig.
    pub rig: Option<Rig>,
    /// This scenario.
    pub scenario: Option<Scenario>,
    /// How the noise is claimed.
    pub noise: Option<NoiseKnowledge>,
    /// What is measured after the calibration, if the rig can do it.
    pub further: Option<Further>,
}

/// A case that is sealed.
#[derive(Debug, Clone, PartialEq)]
pub struct SealedCase {
    /// What is handed out; the case file first.
    pub files: Vec<CaseFile>,
    /// What is kept.
    pub truth: Truth,
    /// Its text, of which the case file has the seal.
    pub truth_text: String,
}

/// Makes a sealed case.
pub fn challenge(request: &Request) -> SealedCase {
    let drawn = drawn(request);
    let further = (request.further).filter(|what| what.is_possible(drawn.setup.rig));
    let mut truth = Truth::of(&drawn, &salt(request.seed, request.entropy));
    let mut files = recordings(&drawn, further);
    truth.files = files
        .iter()
        .map(|file| (file.name.into(), seal(&file.text)))
        .collect();
    let truth_text = truth.text();
    files.insert(0, case_file(&drawn, further, &seal(&truth_text)));
    SealedCase {
        files,
        truth,
        truth_text,
    }
}

/// What each concealed effect of a case adds to the readings beside the others, without noise and digits:
/// all rows of the first output, then those of the next, in units of the recording.
pub fn signatures(request: &Request) -> Vec<DVector<f64>> {
    let drawn = drawn(request);
    let visible = Visible::new(&drawn.setup);
    let all = drawn.concealed();
    let of = |at: usize| {
        let mut others = all.clone();
        let own = others.remove(at);
        visible.added(&own, &others) * drawn.setup.rig.sensitivity()
    };
    (0..all.len()).map(of).collect()
}

/// Mean time from one reading of the recording to the next, in hours.
pub fn dwell(request: &Request) -> f64 {
    let setup = drawn(request).setup;
    let rows = simulate(&setup, Campaign::Calibration, &[], Readings::Ideal).len();
    duration(setup.rig, Campaign::Calibration, setup.seed) / 3600.0 / rows as f64
}

fn drawn(request: &Request) -> Drawn {
    let mut random = source(request.seed, Stream::Case, 0);
    let scenario = request
        .scenario
        .unwrap_or_else(|| choose(request.rig, &mut random));
    let by_chance = if random.random() {
        NoiseKnowledge::Stated
    } else {
        NoiseKnowledge::AtRest
    };
    draw(scenario, request.noise.unwrap_or(by_chance), request.seed)
}

/// How often a class is drawn, in percent.
const CLASSES: [(Class, f64); 7] = [
    (Class::Null, 20.0),
    (Class::Single, 32.0),
    (Class::Double, 14.0),
    (Class::Triple, 6.0),
    (Class::Masked, 6.0),
    (Class::Outside, 16.0),
    (Class::Hidden, 6.0),
];

fn choose(rig: Option<Rig>, random: &mut Random) -> Scenario {
    let all: Vec<Scenario> = Scenario::all()
        .into_iter()
        .filter(|s| rig.is_none_or(|rig| s.rig == rig))
        .collect();
    let class = CLASSES.choose_weighted(random, |(_, share)| *share);
    let class = class.map_or(Class::Single, |(class, _)| *class);
    let of_class: Vec<Scenario> = all.iter().copied().filter(|s| s.class == class).collect();
    let pool = if of_class.is_empty() { all } else { of_class };
    pool[random.random_range(0..pool.len())]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_case_and_a_seal_that_holds() {
        let request = Request {
            seed: 42,
            ..Request::default()
        };
        let case = challenge(&request);
        assert_eq!(case, challenge(&request));
        assert!(case.files[0].text.contains(&seal(&case.truth_text)));
        let read: Truth = serde_json::from_str(&case.truth_text).unwrap();
        assert_eq!(read, case.truth);
        for file in &case.files[1..] {
            assert_eq!(read.files[file.name], seal(&file.text));
        }
    }

    #[test]
    fn a_further_measurement_leaves_the_calibration_as_it_is() {
        let scenario = |name: &str| Scenario::all().into_iter().find(|s| s.name() == name);
        for (name, further, rows) in [
            ("tumble+drift", "mount=90", 36),
            ("remount+swapped-label", "reversed", 48),
            ("triad+knock", "elevation between", 36),
            ("rate-table+temperature-scale", "rate between", 144),
        ] {
            let request = Request {
                seed: 42,
                scenario: scenario(name),
                noise: Some(NoiseKnowledge::AtRest),
                ..Request::default()
            };
            let longer = Request {
                further: further.parse().ok(),
                ..request
            };
            let (short, long) = (challenge(&request), challenge(&longer));
            let of = |case: &SealedCase| case.files[1].text.lines().map(str::to_owned).collect();
            let (short_rows, long_rows): (Vec<String>, Vec<String>) = (of(&short), of(&long));
            assert_eq!(
                (short_rows.len(), long_rows.len()),
                (1 + rows, 1 + 2 * rows)
            );
            assert_eq!(short_rows, long_rows[..=rows], "{name}");
            assert_eq!(short.files[2..], long.files[2..]);
            assert_eq!(short.truth.effects, long.truth.effects);
            assert!(long.files[0].text.contains(&seal(&long.truth_text)));
            // Time goes on, and runs are new ones.
            let number =
                |row: &str, at: usize| -> f64 { row.split(',').nth(at).unwrap().parse().unwrap() };
            for pair in long_rows[1..].windows(2) {
                assert!(number(&pair[1], 0) > number(&pair[0], 0), "{name}");
            }
            let runs =
                |rows: &[String]| -> Vec<f64> { rows.iter().map(|row| number(row, 1)).collect() };
            let last = runs(&long_rows[1..=rows]).into_iter().fold(0.0, f64::max);
            assert!(runs(&long_rows[rows + 1..]).iter().all(|run| *run > last));
        }
    }

    #[test]
    fn entropy_changes_the_truth_file_and_not_the_recordings() {
        let request = Request {
            seed: 42,
            ..Request::default()
        };
        let (a, b) = (
            challenge(&request),
            challenge(&Request {
                entropy: 9,
                ..request
            }),
        );
        assert_eq!(a.files[1..], b.files[1..]);
        assert_ne!(seal(&a.truth_text), seal(&b.truth_text));
    }

    #[test]
    fn a_case_file_tells_nothing() {
        for scenario in Scenario::all() {
            let of_scenario = |scenario, seed| {
                let noise = Some(NoiseKnowledge::Stated);
                let request = Request {
                    seed,
                    scenario: Some(scenario),
                    noise,
                    ..Request::default()
                };
                let drawn = draw(scenario, NoiseKnowledge::Stated, request.seed);
                case_file(&drawn, None, "").text
            };
            let null = Scenario {
                class: Class::Null,
                effects: &[],
                ..scenario
            };
            let hidden = scenario.class == Class::Hidden;
            let texts = (of_scenario(scenario, 8), of_scenario(null, 8));
            assert!(hidden || texts.0 == texts.1, "{}", scenario.name());
        }
    }
}
