//! The proof of `gumption diagnose` on concealed data: makes sealed cases, diagnoses and grades them,
//! and writes `diagnosis.csv` (one line for each case) and `diagnosis.md` (the tables).
//!
//! ```text
//! cargo run --release --example diagnosis -- --out reports
//! ```
//!
//! `--each N` cases of every scenario and `--nulls N` cases without any effect; `--threads N`;
//! `--only TEXT` keeps scenarios whose name contains the text; `--resume` keeps what the file holds
//! already; `--tables` only draws the tables anew; `--first-seed N` takes other cases, to develop with;
//! `--alone` leaves out the methods to compare with; `--singles` keeps whole cases with one effect;
//! `--show` prints every answer.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use gumption::challenge::grade::{self, Answer, Name, State};
use gumption::challenge::study::{
    Advice, Decision, EACH, FIRST_SEED, NULLS, Record, Request, Sequel, Trial, Twin, decision,
    read, report, request, trials, write,
};
use gumption::challenge::{Further, SealedCase};
use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::{Failure, Opinion, Pick, StandIn, diagnose, opinions, stand_ins};
use gumption::report::{self, Language, diagnosis_failure};

struct Options {
    each: usize,
    nulls: usize,
    threads: usize,
    only: String,
    out: PathBuf,
    resume: bool,
    tables: bool,
    first_seed: u64,
    alone: bool,
    singles: bool,
    show: bool,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        each: EACH,
        nulls: NULLS,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        only: String::new(),
        out: PathBuf::from("reports"),
        resume: false,
        tables: false,
        first_seed: FIRST_SEED,
        alone: false,
        singles: false,
        show: false,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value"));
        let number = |text: String| {
            text.parse::<usize>()
                .map_err(|_| format!("`{text}` is no number"))
        };
        match name.as_str() {
            "--each" => options.each = number(value()?)?,
            "--nulls" => options.nulls = number(value()?)?,
            "--threads" => options.threads = number(value()?)?.max(1),
            "--only" => options.only = value()?,
            "--out" => options.out = value()?.into(),
            "--resume" => options.resume = true,
            "--first-seed" => options.first_seed = number(value()?)? as u64,
            "--alone" => options.alone = true,
            "--singles" => options.singles = true,
            "--show" => options.show = true,
            "--tables" => options.tables = true,
            other => return Err(format!("`{other}` is not known")),
        }
    }
    Ok(options)
}

fn main() -> Result<(), String> {
    let options = options()?;
    if !options.tables {
        Study::new(&options).run()?;
    }
    save_tables(&options.out)
}

fn save_tables(out: &Path) -> Result<(), String> {
    // From the file, so that the tables hold what anyone can read there.
    let lines = std::fs::read_to_string(out.join("diagnosis.csv")).map_err(|e| e.to_string())?;
    let made = "Made by `cargo run --release --example diagnosis -- --out reports` from sealed cases of \
        `gumption challenge` (docs/challenge.md). λ is the visible strength of an effect in standard \
        deviations, κ what its nearest rival leaves of it: both from twin runs of the simulator, with and \
        without the effect, and the rivals are every other effect of the simulator and every wrong candidate \
        of the catalogue that has at most one coefficient more than the right one (a wave has a phase where \
        a power has none): what gives the same recording has to be listed. \
        Every case is a line of diagnosis.csv.";
    std::fs::write(out.join("diagnosis.md"), report(&read(&lines), made)).map_err(|e| e.to_string())
}

/// Trials with the records that exist already.
struct Study<'a> {
    options: &'a Options,
    trials: Vec<Trial>,
    done: Mutex<BTreeMap<usize, Record>>,
    next: AtomicUsize,
    begun: Instant,
}

/// Records after which the file is written.
const OFTEN: usize = 50;

impl<'a> Study<'a> {
    fn new(options: &'a Options) -> Study<'a> {
        let trials: Vec<Trial> = trials(options.first_seed, options.each, options.nulls)
            .into_iter()
            .filter(|trial| trial.scenario.name().contains(&options.only))
            .filter(|trial| trial.is_single() || !options.singles)
            .collect();
        let kept = match std::fs::read_to_string(options.out.join("diagnosis.csv")) {
            Ok(text) if options.resume => read(&text),
            _ => Vec::new(),
        };
        let is_of = |record: &Record, trial: &Trial| {
            record.seed == trial.seed
                && record.ablation == trial.ablation
                && record.scenario == trial.scenario.name()
        };
        let done = trials
            .iter()
            .enumerate()
            .filter_map(|(at, trial)| Some((at, kept.iter().find(|r| is_of(r, trial))?.clone())))
            .collect();
        Study {
            options,
            trials,
            done: Mutex::new(done),
            next: AtomicUsize::new(0),
            begun: Instant::now(),
        }
    }

    /// Runs what is left, on several threads; the file is in the order of the trials.
    fn run(&self) -> Result<(), String> {
        std::thread::scope(|scope| {
            for worker in 0..self.options.threads {
                scope.spawn(move || self.work(worker));
            }
        });
        self.save()
    }

    fn work(&self, worker: usize) {
        let folder = std::env::temp_dir().join(format!(
            "gumption-diagnosis-{}-{worker}",
            std::process::id()
        ));
        loop {
            let at = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(trial) = self.trials.get(self.scattered(at)) else {
                break;
            };
            let at = self.scattered(at);
            if self.done.lock().is_ok_and(|done| done.contains_key(&at)) {
                continue;
            }
            let record = one(trial, &folder, self.options);
            let count = self.done.lock().map_or(0, |mut done| {
                done.insert(at, record);
                done.len()
            });
            if count.is_multiple_of(OFTEN) {
                let seconds = self.begun.elapsed().as_secs_f64();
                eprintln!("{count}/{} after {seconds:.0} s", self.trials.len());
                if let Err(why) = self.save() {
                    eprintln!("{why}");
                }
            }
        }
        let _ = std::fs::remove_dir_all(folder);
    }

    /// The order of work: spread over all trials, so that an interrupted study is a sample of the whole.
    fn scattered(&self, at: usize) -> usize {
        const STRIDE: usize = 7919;
        let count = self.trials.len();
        if at >= count || count.is_multiple_of(STRIDE) {
            at
        } else {
            at * STRIDE % count
        }
    }

    fn save(&self) -> Result<(), String> {
        let records: Vec<Record> = match self.done.lock() {
            Ok(done) => done.values().cloned().collect(),
            Err(_) => return Err("a worker stopped".into()),
        };
        std::fs::write(self.options.out.join("diagnosis.csv"), write(&records))
            .map_err(|error| error.to_string())
    }
}

fn one(trial: &Trial, folder: &Path, options: &Options) -> Record {
    let sealed = trial.case();
    match answer(trial, &sealed, folder, options.alone) {
        Ok((Said { answer, advice }, twins, opinions)) => {
            if options.show {
                eprintln!("{}", shown(trial, &answer));
            }
            let graded = grade::grade(&sealed.truth, &answer);
            let mut record = Record::of(trial, &graded, &answer);
            record.complete(&twins);
            record.rivals = opinions
                .iter()
                .map(|opinion| judged(&sealed, opinion))
                .collect();
            record.further = match request(trial, &sealed.truth, &graded, &answer, &advice) {
                Request::None => None,
                Request::InVain(sequel) => Some(sequel),
                Request::Make(further) => Some(followed(trial, further, folder, options)),
            };
            record
        }
        Err(why) => {
            eprintln!("{} {}: {why}", trial.scenario.name(), trial.seed);
            let answer = Answer {
                verdict: "refused".into(),
                effects: Vec::new(),
                before: None,
                after: None,
            };
            Record::of(trial, &grade::grade(&sealed.truth, &answer), &answer)
        }
    }
}

/// What a diagnosis says.
struct Said {
    answer: Answer,
    advice: Advice,
}

fn answer(
    trial: &Trial,
    sealed: &SealedCase,
    folder: &Path,
    alone: bool,
) -> Result<(Said, Vec<Twin>, Vec<Opinion>), String> {
    let case = handed_out(trial, sealed, folder)?;
    let failed = |failure| diagnosis_failure(&case, &failure, Language::English);
    let said = said(&case)?;
    let others = if alone {
        Vec::new()
    } else {
        opinions(&case).map_err(failed)?
    };
    let twins = twins(trial, sealed, &case, &said.answer).map_err(failed)?;
    Ok((said, twins, others))
}

/// The case as it is read from its files.
fn handed_out(trial: &Trial, sealed: &SealedCase, folder: &Path) -> Result<Case, String> {
    trial
        .write(sealed, folder)
        .map_err(|error| error.to_string())?;
    let mut case = Case::load(&folder.join("CASE.toml"), Purpose::Diagnosis)
        .map_err(|rejection| rejection.render(false))?;
    case.settings.seed = trial.seed;
    Ok(case)
}

fn said(case: &Case) -> Result<Said, String> {
    let failed = |failure| diagnosis_failure(case, &failure, Language::English);
    let diagnosis = diagnose(case, &|_| ControlFlow::Continue(())).map_err(failed)?;
    let said = report::diagnosis(case, &diagnosis, Language::English).machine;
    let wrong = |error: serde_json::Error| error.to_string();
    Ok(Said {
        advice: serde_json::from_value(said.clone()).map_err(wrong)?,
        answer: serde_json::from_value(said).map_err(wrong)?,
    })
}

/// What becomes of a list when the further measurement is made.
fn followed(trial: &Trial, further: Further, folder: &Path, options: &Options) -> Sequel {
    let sealed = trial.longer_case(further);
    let said = handed_out(trial, &sealed, folder).and_then(|case| said(&case));
    match said {
        Ok(Said { answer, advice }) => {
            if options.show {
                eprintln!("  {further}: {}", shown(trial, &answer));
            }
            let graded = grade::grade(&sealed.truth, &answer);
            Sequel::Made(further, decision(&graded, &answer, &advice))
        }
        Err(why) => {
            eprintln!("{} {} {further}: {why}", trial.scenario.name(), trial.seed);
            Sequel::Made(further, Decision::Unnamed)
        }
    }
}

/// What twin runs say of each concealed effect. A wrong candidate is a rival if it has at most one
/// coefficient more than the right one, as a wave has a phase where a power has none.
fn twins(
    trial: &Trial,
    sealed: &SealedCase,
    case: &Case,
    answer: &Answer,
) -> Result<Vec<Twin>, Failure> {
    /// Where the right candidate is missing, whatever fits is a rival.
    const USUAL: usize = usize::MAX;
    let traces = trial.signatures();
    let right = |pick: &Pick| {
        let name = name(pick);
        let mut effects = sealed.truth.effects.iter();
        effects.any(|effect| grade::accepts(effect.physics, &name))
    };
    let of = |at: usize| {
        let mut others = traces.clone();
        let own = others.remove(at);
        let all = stand_ins(case, &own, &others)?;
        let (own, wrong): (Vec<&StandIn>, Vec<&StandIn>) =
            all.iter().partition(|likeness| right(&likeness.pick));
        let best = own.iter().min_by(|a, b| a.left.total_cmp(&b.left));
        let coefficients = best.map_or(USUAL, |best| best.coefficients);
        let rivals = wrong
            .iter()
            .filter(|l| l.coefficients <= coefficients.saturating_add(1));
        let truth = &sealed.truth.effects[at];
        let unique = (answer.effects.iter())
            .filter(|effect| effect.state == State::Identified)
            .filter_map(|effect| effect.named.first())
            .find(|name| grade::accepts(truth.physics, name));
        Ok(Twin {
            nearest: rivals.map(|l| l.left).fold(1.0, f64::min),
            deviation: unique.and_then(|name| deviation(&all, name)),
            located: unique
                .and_then(|name| grade::located(sealed.truth.rig, trial.dwell(), truth, name)),
        })
    };
    (0..traces.len()).map(of).collect()
}

/// An answer in one line.
fn shown(trial: &Trial, answer: &Answer) -> String {
    let mut line = format!(
        "{} {} {}: {}",
        trial.scenario.name(),
        trial.seed,
        trial.ablation.word(),
        answer.verdict
    );
    for effect in &answer.effects {
        let names = effect.named.iter().map(|name| {
            let variant = name.variants.first().map_or("", |one| one.label.as_str());
            format!(
                "{} {} [{variant}] {:.3}",
                name.id, name.along, name.probability
            )
        });
        let names: Vec<String> = names.collect();
        line += &format!("; {:?}: {}", effect.state, names.join(" | "));
    }
    line
}

/// A rival's names against the truth.
fn judged(sealed: &SealedCase, opinion: &Opinion) -> (String, String) {
    let names: Vec<Name> = opinion.picks.iter().map(name).collect();
    (
        opinion.method.into(),
        grade::grade_names(&sealed.truth, &names).into(),
    )
}

/// Size of a name less that of its variant in the twin run, in half-widths of its 95 % interval.
fn deviation(all: &[StandIn], name: &Name) -> Option<f64> {
    let label = &name.variants.first()?.label;
    let is_it = |l: &&StandIn| {
        l.pick.id == name.id.as_str() && l.pick.along == name.along && l.label == *label
    };
    let size = all.iter().find(is_it)?.size?;
    let half_width = name.coverage_factor? * (*name.u.first()?)?;
    Some(((*name.size.first()?)? - size) / half_width)
}

fn name(pick: &Pick) -> Name {
    Name {
        id: pick.id.to_string(),
        family: String::new(),
        node: String::new(),
        along: pick.along.clone(),
        probability: f64::NAN,
        variants: Vec::new(),
        size: Vec::new(),
        u: Vec::new(),
        coverage_factor: None,
    }
}
