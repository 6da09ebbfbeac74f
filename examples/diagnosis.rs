//! The proof of `gumption diagnose` on concealed data: makes sealed cases, diagnoses and grades them,
//! and writes `diagnosis.jsonl` (one line for each case) and `diagnosis.md` (the tables).
//!
//! ```text
//! cargo run --release --example diagnosis -- --out reports
//! ```
//!
//! `--cases N` takes the first N cases of the study, which are a sample of it; `--threads N` (2); `--only TEXT`
//! keeps rigs and instruments whose name contains the text; `--resume` keeps what the file holds already, so that a
//! study may be interrupted; `--tables` only draws the tables anew; `--first-seed N` takes other cases, to develop
//! with; `--whole` leaves out the ablations; `--show` prints every answer; `--program PATH` asks another build of
//! gumption, to hold two versions against the same cases.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use gumption::challenge::grade::{self, Answer, Name, State};
use gumption::challenge::study::{
    Ablation, Advice, CASES, Decision, FIRST_SEED, Record, Request, Sequel, Trial, Twin, decision,
    read, report, request, trials, write,
};
use gumption::challenge::{ALIAS, Accepted, CaseFile, SealedCase, TrueEffect};
use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::{Pick, StandIn, diagnose, stand_ins};
use gumption::report::{self, Language, diagnosis_failure};

/// What was otherwise in the diagnosis, or in what is counted, at each earlier table.
const EARLIER: [&str; 31] = [
    "four rigs, the catalogue scored by slopes",
    "noise judged before the explanation",
    "departures of a form allowed to everything beside it",
    "a delay written as two terms",
    "effects on the scale of specimens not looked for, shapes looked for anew in a held-out recording",
    "aliases with a coefficient more left out of the lists, widths of plays on a grid",
    "rules for accidents and contested names, what stood for several effects kept beside them, waves over fewer than 16 set points not looked for",
    "estimated white noise not tested; the right name with a further order counted as a rival, so that no linear coefficient had a κ",
    "pieces of one course identified; the readings of a norm without noise of their own",
    "set points in small steps taken for ramps; other wrong readings counted as noise of one",
    "the name and the adopted model chosen apart; what other sets have instead of a name left out; slopes never taken anew; noise that walks over the whole recording not among the laws",
    "effects that bend the fit never compared as they are fitted; what bends a course without a name told as a name; straight backgrounds, zeros of conditions and exponents of first powers not looked for",
    "squares, products and rates of change not carried over to a recording held out; noise the same for all labels",
    "estimated noise always normal, steps at one value of a stimulus not in the catalogue",
    "one statistic for all effects beside heavy tails, what is exponential not in the catalogue",
    "no law of rounding beside estimated noise",
    "the fresh recording of a rig with another thermometer, wide exponentials and bends below a value not in the catalogue",
    "a thermal lag behind its own stimulus counted as wrong, names identified that do not show in a recording held out",
    "weights of bits and ringing not in the catalogue",
    "limits of the rate not in the catalogue",
    "scales that wander taken for noise that wanders",
    "a second effect held against noise of one law for all recordings",
    "pairs that do not resemble each other never held against one effect under estimated noise",
    "sizes by label, combinations of labels and drifts from one moment on not in the catalogue",
    "several steps of a staircase not in the catalogue, under a label only what is likeliest over all rows",
    "single values taken for ranges, what dies away with a time of waiting not in the catalogue, names identified whose size differs between parts of the recording",
    "deviations about one value not in the catalogue, staircases of faint steps identified",
    "noise that outputs have in common taken for physics, squares of degrees refused for their size, plays that begin in the middle of their gap alone",
    "lags that follow straight lines between the rows, a delay counted in as many sizes as it has terms, what is known beforehand counted in full against the fit",
    "noise that differs by label taken before effects under labels, variants of one cause in every set that was extended",
    "effects under labels not asked for beside noise that wanders, lists that do less well than what has no name, scatter and all beside a wrong reading excused by the form of an effect",
];

struct Options {
    cases: usize,
    threads: usize,
    only: String,
    out: PathBuf,
    resume: bool,
    tables: bool,
    first_seed: u64,
    whole: bool,
    show: bool,
    program: Option<PathBuf>,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        cases: CASES,
        threads: 2,
        only: String::new(),
        out: PathBuf::from("reports"),
        resume: false,
        tables: false,
        first_seed: FIRST_SEED,
        whole: false,
        show: false,
        program: None,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value"));
        let number = |text: String| {
            text.parse::<usize>()
                .map_err(|_| format!("`{text}` is no number"))
        };
        match name.as_str() {
            "--cases" => options.cases = number(value()?)?,
            "--threads" => options.threads = number(value()?)?.max(1),
            "--only" => options.only = value()?,
            "--out" => options.out = value()?.into(),
            "--resume" => options.resume = true,
            "--first-seed" => options.first_seed = number(value()?)? as u64,
            "--whole" => options.whole = true,
            "--show" => options.show = true,
            "--program" => options.program = Some(value()?.into()),
            "--tables" => options.tables = true,
            other => return Err(format!("`{other}` is not known")),
        }
    }
    Ok(options)
}

fn main() -> Result<(), String> {
    let options = options()?;
    std::fs::create_dir_all(&options.out).map_err(|error| error.to_string())?;
    if !options.tables {
        Study::new(&options).run()?;
    }
    save_tables(&options)
}

fn save_tables(options: &Options) -> Result<(), String> {
    let out = &options.out;
    let sample = match options.cases {
        CASES => String::new(),
        some => format!("--cases {some} "),
    };
    // From the file, so that the tables hold what anyone can read there.
    let lines = std::fs::read_to_string(out.join("diagnosis.jsonl")).map_err(|e| e.to_string())?;
    let made = format!(
        "Made by gumption {} with `cargo run --release --example diagnosis -- {sample}--out reports` from sealed cases of `gumption \
         challenge` (docs/challenge.md), on rigs and instruments in turn. λ is the visible strength of an effect in standard \
         deviations of the true noise, κ what its nearest rival leaves of it: both from twin runs of the simulator, with and \
         without the effect. Rivals are every other effect of the simulator, in all its forms, and every wrong candidate of the \
         catalogue that has at most one coefficient more than the right one and is not the right one with a further order. Every case is a line of diagnosis.jsonl.",
        env!("CARGO_PKG_VERSION")
    );
    let tables = report(&read(&lines), &made) + &earlier();
    std::fs::write(out.join("diagnosis.md"), tables).map_err(|e| e.to_string())
}

/// Trials with the records that exist already; nothing is recorded of a trial that is none.
struct Study<'a> {
    options: &'a Options,
    trials: Vec<Trial>,
    done: Mutex<BTreeMap<usize, Option<Record>>>,
    next: AtomicUsize,
    begun: Instant,
}

/// Records after which the file is written.
const OFTEN: usize = 20;

/// The list of the earlier tables.
fn earlier() -> String {
    let lines = EARLIER.iter().enumerate().map(|(at, changed)| {
        let name = format!("diagnosis-{}.md", at + 1);
        format!("- [{name}]({name}): {changed}\n")
    });
    let lines: String = lines.collect();
    format!(
        "\n## Earlier tables\n\nEach stands as it fell, with what was otherwise at it.\n\n{lines}"
    )
}

impl<'a> Study<'a> {
    fn new(options: &'a Options) -> Study<'a> {
        let trials: Vec<Trial> = trials(options.first_seed, options.cases)
            .into_iter()
            .filter(|trial| trial.bench.name().contains(&options.only))
            .filter(|trial| trial.ablation == Ablation::Whole || !options.whole)
            .collect();
        let kept = match std::fs::read_to_string(options.out.join("diagnosis.jsonl")) {
            Ok(text) if options.resume => read(&text),
            _ => Vec::new(),
        };
        let known = trials.iter().enumerate().filter_map(|(at, trial)| {
            let record = kept.iter().find(|record| record.is_of(trial))?;
            Some((at, Some(record.clone())))
        });
        Study {
            options,
            done: Mutex::new(known.collect()),
            trials,
            next: AtomicUsize::new(0),
            begun: Instant::now(),
        }
    }

    /// Runs what is left, on several threads; the file is in the order of the trials.
    fn run(&self) -> Result<(), String> {
        std::thread::scope(|scope| {
            for _ in 0..self.options.threads {
                scope.spawn(|| self.work());
            }
        });
        self.save()
    }

    fn work(&self) {
        let folder = match tempfile::tempdir() {
            Ok(folder) => folder,
            Err(error) => return eprintln!("{error}"),
        };
        loop {
            let at = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(trial) = self.trials.get(at) else {
                break;
            };
            if self.done.lock().is_ok_and(|done| done.contains_key(&at)) {
                continue;
            }
            let record = one(trial, folder.path(), self.options);
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
    }

    fn save(&self) -> Result<(), String> {
        let records: Vec<Record> = match self.done.lock() {
            Ok(done) => done.values().flatten().cloned().collect(),
            Err(_) => return Err("a worker stopped".into()),
        };
        std::fs::write(self.options.out.join("diagnosis.jsonl"), write(&records))
            .map_err(|error| error.to_string())
    }
}

fn one(trial: &Trial, folder: &Path, options: &Options) -> Option<Record> {
    let mut sealed = trial.case()?;
    let begun = Instant::now();
    let both = handed_out(trial, &sealed, folder)
        .and_then(|case| Ok((said(&case, folder, options)?, case)));
    let seconds = begun.elapsed().as_secs_f64();
    let (Said { answer, advice }, case) = match both {
        Ok(both) => both,
        Err(why) => {
            eprintln!("{}: {why}", trial.command());
            let answer = refused();
            let graded = grade::grade(&sealed.truth, &answer);
            let mut record = Record::of(trial, &sealed, &graded, &answer);
            record.seconds = seconds;
            return Some(record);
        }
    };
    let found = likenesses(trial, &sealed, &case);
    // What gives the same recording is right as well: which of the two it was, nobody can know.
    for (effect, likeness) in sealed.truth.effects.iter_mut().zip(&found) {
        effect.aliases.extend(likeness.aliases.clone());
    }
    let graded = grade::grade(&sealed.truth, &answer);
    let mut record = Record::of(trial, &sealed, &graded, &answer);
    record.seconds = seconds;
    record.complete(&twins(&sealed, &found, &answer));
    if options.show {
        eprintln!("{}", shown(&record, trial, &answer, &sealed.truth.effects));
    }
    record.further = match request(trial, &graded, &answer, &advice) {
        Request::None => None,
        Request::InVain(sequel) => Some(sequel),
        Request::Make(further) => {
            let longer = trial.longer_case(further);
            let decided =
                handed_out(trial, &longer, folder).and_then(|case| said(&case, folder, options));
            let decided = decided.map(|Said { answer, advice }| {
                decision(&grade::grade(&longer.truth, &answer), &answer, &advice)
            });
            let decided = decided.unwrap_or(Decision::Unnamed);
            Some(Sequel::Made(further.to_string(), decided))
        }
    };
    Some(record)
}

/// The answer of a diagnosis that ended with an error.
fn refused() -> Answer {
    Answer {
        verdict: "refused".into(),
        effects: Vec::new(),
        before: None,
        after: None,
        held_out: None,
    }
}

/// What a diagnosis says.
struct Said {
    answer: Answer,
    advice: Advice,
}

/// The case as it is read from its files.
fn handed_out(trial: &Trial, sealed: &SealedCase, folder: &Path) -> Result<Case, String> {
    let written = |file: &CaseFile| std::fs::write(folder.join(file.name), &file.text);
    let written =
        std::fs::create_dir_all(folder).and_then(|()| sealed.files.iter().try_for_each(written));
    written.map_err(|error| error.to_string())?;
    let mut case = Case::load(&folder.join("CASE.toml"), Purpose::Diagnosis)
        .map_err(|rejection| rejection.render(false))?;
    case.settings.seed = trial.seed;
    Ok(case)
}

fn said(case: &Case, folder: &Path, options: &Options) -> Result<Said, String> {
    let said = match &options.program {
        None => {
            let failed = |failure| diagnosis_failure(case, &failure, Language::English);
            let diagnosis = diagnose(case, &|_| ControlFlow::Continue(())).map_err(failed)?;
            report::diagnosis(case, &diagnosis, Language::English)
                .machine
                .value()
        }
        Some(program) => {
            let file = folder.join("CASE.toml");
            let output = Command::new(program)
                .arg("diagnose")
                .arg(file)
                .arg("--json")
                .output();
            let output = output.map_err(|error| error.to_string())?;
            let complaint = || String::from_utf8_lossy(&output.stderr).into_owned();
            serde_json::from_slice(&output.stdout).map_err(|_| complaint())?
        }
    };
    let wrong = |error: serde_json::Error| error.to_string();
    Ok(Said {
        advice: serde_json::from_value(said.clone()).map_err(wrong)?,
        answer: serde_json::from_value(said).map_err(wrong)?,
    })
}

/// The catalogue beside the noise-free trace of a concealed effect.
#[derive(Default)]
struct Likeness {
    all: Vec<StandIn>,
    /// What the nearest wrong candidate leaves of it, over its length.
    nearest: f64,
    /// Wrong candidates that give the same recording.
    aliases: Vec<Accepted>,
}

/// The catalogue beside each concealed effect; nothing where the engine cannot hold it there. A wrong candidate is a rival
/// if it has at most one coefficient more than the right one, as a wave has a phase where a power has none.
fn likenesses(trial: &Trial, sealed: &SealedCase, case: &Case) -> Vec<Likeness> {
    // Where the right candidate is missing, whatever fits is a rival.
    const USUAL: usize = usize::MAX;
    if trial.ablation == Ablation::ForeignConditions {
        return Vec::new();
    }
    let effects = &sealed.truth.effects;
    let of = |at: usize| {
        let mut others = sealed.signatures.clone();
        let own = others.remove(at);
        let all = stand_ins(case, &own, &others).unwrap_or_default();
        let accepted = |one: &StandIn, effect| grade::accepts(effect, &name(&one.pick));
        let right = all.iter().filter(|one| accepted(one, &effects[at]));
        let right: Vec<&StandIn> = right.collect();
        let best = right.iter().min_by(|a, b| a.left.total_cmp(&b.left));
        let coefficients = best.map_or(USUAL, |best| best.coefficients);
        let as_well = best.map_or(0.0, |best| best.left.max(ALIAS));
        // A right one with a further order beside it is no other answer: it is the same with a size of zero.
        let extends = |one: &StandIn| {
            let order = |right: &&StandIn| {
                one.pick.id.entry().order_of.contains(&right.pick.id)
                    && one.pick.along == right.pick.along
                    && one.coefficients > right.coefficients
                    && (one.left..=as_well).contains(&right.left)
            };
            right.iter().any(order)
        };
        // What bears the name of another effect of the case is no rival either.
        let rivals: Vec<&StandIn> = all
            .iter()
            .filter(|one| !effects.iter().any(|effect| accepted(one, effect)))
            .filter(|one| one.coefficients <= coefficients.saturating_add(1) && !extends(one))
            .collect();
        // Where the name was taken out, its alias is its nearest kin and no more.
        let is_whole = trial.ablation == Ablation::Whole;
        let same = rivals.iter().filter(|one| is_whole && one.left < ALIAS);
        Likeness {
            nearest: rivals.iter().map(|one| one.left).fold(1.0, f64::min),
            aliases: same
                .map(|one| Accepted {
                    id: one.pick.id.to_string(),
                    along: Vec::new(),
                })
                .collect(),
            all,
        }
    };
    (0..effects.len()).map(of).collect()
}

/// What they say of each concealed effect and of the name that it was given.
fn twins(sealed: &SealedCase, found: &[Likeness], answer: &Answer) -> Vec<Twin> {
    let of = |(truth, likeness): (&TrueEffect, &Likeness)| {
        let alone = (answer.effects.iter())
            .filter(|effect| matches!(effect.state, State::Identified | State::ActsLike))
            .filter_map(|effect| effect.named.first())
            .find(|name| grade::accepts(truth, name));
        Twin {
            nearest: likeness.nearest,
            deviation: alone.and_then(|name| deviation(&likeness.all, name)),
            located: alone
                .and_then(|name| grade::located(&sealed.truth.outputs, sealed.dwell, truth, name)),
        }
    };
    sealed.truth.effects.iter().zip(found).map(of).collect()
}

/// A record and its answer in one line.
fn shown(record: &Record, trial: &Trial, answer: &Answer, effects: &[TrueEffect]) -> String {
    let truths = record.outcomes.iter().zip(effects).map(|(o, effect)| {
        let found = format!("{:?}", o.finding).to_lowercase();
        let same = effect.aliases.iter().map(|alias| alias.id.as_str());
        let same = match o.overclaimed {
            true => format!(" (the same: {})", same.collect::<Vec<_>>().join(", ")),
            false => String::new(),
        };
        format!(
            "{} λ {:.1} κ {:.1} {found}{same}",
            o.physics, o.lambda, o.kappa
        )
    });
    let mut line = format!(
        "{} [{:?}] {}: {} in {:.1} s, predicted {:.2}",
        trial.command(),
        trial.ablation,
        truths.collect::<Vec<_>>().join(" + "),
        answer.verdict,
        record.seconds,
        record.predicted.unwrap_or(f64::NAN),
    );
    for effect in &answer.effects {
        let names = effect.named.iter().map(|name| {
            let variant = name.variants.first().map_or("", |one| one.label.as_str());
            format!("{} {} [{variant}]", name.id, name.along)
        });
        let names: Vec<String> = names.collect();
        line += &format!("; {:?}: {}", effect.state, names.join(" | "));
    }
    line
}

/// Size of a name less that of its variant in the twin run, in half-widths of its 95 % interval.
fn deviation(all: &[StandIn], name: &Name) -> Option<f64> {
    let label = &name.variants.first()?.label;
    let is_it = |l: &&StandIn| {
        l.pick.id.as_str() == name.id.as_str() && l.pick.along == name.along && l.label == *label
    };
    let size = all.iter().find(is_it)?.size?;
    let half_width = name.coverage_factor? * (*name.u.first()?)?;
    Some(((*name.size.first()?)? - size) / half_width)
}

fn name(pick: &Pick) -> Name {
    Name {
        id: pick.id.to_string(),
        node: pick.node.clone(),
        along: pick.along.clone(),
        variants: Vec::new(),
        on_scale: None,
        size: Vec::new(),
        u: Vec::new(),
        coverage_factor: None,
    }
}
