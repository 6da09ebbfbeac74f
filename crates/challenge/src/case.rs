//! Making a sealed case from a seed.

use std::str::FromStr;

use nalgebra::DVector;
use rand::RngExt;
use rand::seq::IndexedRandom;

use super::files::{CaseFile, case_file, recordings};
use super::further::Further;
use super::instrument::{Asked, Case, Instrument};
use super::random::{Stream, source};
use super::rig::Rig;
use super::scenario::{Class, Drawn, NoiseKnowledge, Scenario, draw};
use super::schedule::Campaign;
use super::simulate::{Readings, duration, simulate};
use super::strength::Visible;
use super::truth::{Truth, salt, seal};

/// Where a case is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bench {
    /// On a rig for inertial sensors.
    Rig(Rig),
    /// With any other instrument.
    Instrument(&'static Instrument),
}

impl Bench {
    /// All of them: the rigs, then the instruments.
    pub fn all() -> Vec<Bench> {
        let instruments = Instrument::all().iter().map(Bench::Instrument);
        Rig::ALL
            .into_iter()
            .map(Bench::Rig)
            .chain(instruments)
            .collect()
    }

    /// The name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Bench::Rig(rig) => rig.name(),
            Bench::Instrument(instrument) => &instrument.name,
        }
    }

    /// The rig, if it is one.
    pub fn rig(self) -> Option<Rig> {
        match self {
            Bench::Rig(rig) => Some(rig),
            Bench::Instrument(_) => None,
        }
    }
}

impl FromStr for Bench {
    type Err = String;

    fn from_str(text: &str) -> Result<Bench, String> {
        let all = Bench::all();
        let found = all.iter().find(|bench| bench.name() == text);
        found.copied().ok_or_else(|| {
            let names: Vec<&str> = all.iter().map(|bench| bench.name()).collect();
            format!(
                "`{text}` is no rig or instrument: write {}",
                names.join(", ")
            )
        })
    }
}

/// What is asked for; chance decides the rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Request {
    /// Decides everything that is left open.
    pub seed: u64,
    /// Mixed into the salt of the truth, so that the truth cannot be guessed from the seed.
    pub entropy: u64,
    /// Only cases of this rig or instrument.
    pub bench: Option<Bench>,
    /// Only cases of this class, as a study counts it.
    pub class: Option<Class>,
    /// This scenario, of a rig.
    pub scenario: Option<Scenario>,
    /// How the noise is claimed.
    pub noise: Option<NoiseKnowledge>,
    /// What is measured after the calibration, if the rig can do it.
    pub further: Option<Further>,
}

/// A case that is sealed.
#[derive(Debug, Clone, PartialEq)]
pub struct SealedCase {
    /// What is handed out; the experiment first.
    pub files: Vec<CaseFile>,
    /// What is kept.
    pub truth: Truth,
    /// Its text, of which the experiment has the seal.
    pub truth_text: String,
    /// What each concealed effect adds to the readings beside the others, without noise and digits: all rows of the
    /// first output, then those of the next, in units of the recording.
    pub signatures: Vec<DVector<f64>>,
    /// Mean time from one reading of the recording to the next, hours.
    pub dwell: f64,
}

/// A case before it is sealed.
enum Unsealed {
    Rig(Box<Drawn>, Option<Further>),
    Instrument(Box<Case>),
}

/// Makes a sealed case.
pub fn challenge(request: &Request) -> SealedCase {
    let salt = salt(request.seed, request.entropy);
    let unsealed = unsealed(request);
    let (mut truth, mut files) = match &unsealed {
        Unsealed::Rig(drawn, further) => (Truth::of(drawn, &salt), recordings(drawn, *further)),
        Unsealed::Instrument(case) => (case.truth(&salt), case.recordings()),
    };
    truth.files = files
        .iter()
        .map(|file| (file.name.into(), seal(&file.text)))
        .collect();
    let truth_text = truth.text();
    let seal = seal(&truth_text);
    let (file, signatures, dwell) = match &unsealed {
        Unsealed::Rig(drawn, further) => (
            case_file(drawn, *further, &seal),
            signatures(drawn),
            dwell(drawn),
        ),
        Unsealed::Instrument(case) => (case.file(&seal), case.signatures(), case.dwell()),
    };
    files.insert(0, file);
    SealedCase {
        files,
        truth,
        truth_text,
        signatures,
        dwell,
    }
}

fn signatures(drawn: &Drawn) -> Vec<DVector<f64>> {
    let visible = Visible::new(&drawn.setup);
    let all = drawn.concealed();
    let of = |at: usize| {
        let mut others = all.clone();
        let own = others.remove(at);
        visible.added(&own, &others) * drawn.setup.rig.sensitivity()
    };
    (0..all.len()).map(of).collect()
}

fn dwell(drawn: &Drawn) -> f64 {
    let setup = &drawn.setup;
    let rows = simulate(setup, Campaign::Calibration, &[], Readings::Ideal).len();
    duration(setup.rig, Campaign::Calibration, setup.seed) / 3600.0 / rows as f64
}

/// How often a class is drawn, in percent.
const CLASSES: [(Class, f64); 4] = [
    (Class::Null, 20.0),
    (Class::Single, 40.0),
    (Class::Double, 20.0),
    (Class::Outside, 20.0),
];

fn unsealed(request: &Request) -> Unsealed {
    let mut random = source(request.seed, Stream::Case, 0);
    let all = Bench::all();
    let any = all[random.random_range(0..all.len())];
    let class = CLASSES.choose_weighted(&mut random, |(_, share)| *share);
    let class = class.map_or(Class::Single, |(class, _)| *class);
    let (class, turn) = (request.class.unwrap_or(class), random.random::<u64>());
    // At rest only rigs are recorded; that is the last way to know the noise.
    let knowledge = |count: usize| {
        let by_chance = NoiseKnowledge::ALL[turn as usize % count].0;
        request.noise.unwrap_or(by_chance)
    };
    let bench = request.scenario.map(|scenario| Bench::Rig(scenario.rig));
    match bench.or(request.bench).unwrap_or(any) {
        Bench::Instrument(instrument) => {
            let noise = knowledge(NoiseKnowledge::ALL.len() - 1);
            let case = Case::new(Asked {
                instrument,
                class,
                noise,
                seed: request.seed,
            });
            if let Some(case) = case {
                return Unsealed::Instrument(Box::new(case));
            }
            let scenario = of_class(Rig::Tumble, class, turn);
            Unsealed::Rig(Box::new(draw(scenario, noise, request.seed)), None)
        }
        Bench::Rig(rig) => {
            let scenario = request
                .scenario
                .unwrap_or_else(|| of_class(rig, class, turn));
            let noise = knowledge(NoiseKnowledge::ALL.len());
            let further = request.further.filter(|what| what.is_possible(rig));
            Unsealed::Rig(Box::new(draw(scenario, noise, request.seed)), further)
        }
    }
}

/// A scenario of a rig and a class.
fn of_class(rig: Rig, class: Class, turn: u64) -> Scenario {
    let all = Scenario::all().into_iter().filter(|s| s.rig == rig);
    let (fitting, rest): (Vec<Scenario>, Vec<Scenario>) =
        all.partition(|s| s.class == class || s.class.counted() == class);
    let pool = if fitting.is_empty() { rest } else { fitting };
    pool[(turn >> 8) as usize % pool.len()]
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
