//! The proof of `gumption audit` on concealed slips: makes sealed budgets, audits and grades them, and writes
//! `audit.md`.
//!
//! ```text
//! cargo run --release --example audit -- --out reports
//! ```
//!
//! Beside it stand the audits of two published tables, `audit-sources.md`. `--sheets N` and `--seed N` take other budgets, to develop with; `--keep DIR` writes them, with the truth, and
//! `--misses` prints what went wrong.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use gumption::audit::read::Mapping;
use gumption::audit::{audit, claims};
use gumption::challenge::budget::{self, Sheet, SheetAnswer, SheetGrade};
use gumption::files::write::{Output, Replacing, write};
use gumption::report::{self, Language};

/// The seed of the published table: drawn once, after everything else was done.
const SEED: u64 = 2288877;

struct Options {
    sheets: u64,
    seed: u64,
    misses: bool,
    keep: Option<PathBuf>,
    out: Option<PathBuf>,
}

/// Grades of one group of budgets.
#[derive(Default)]
struct Tally {
    grades: BTreeMap<SheetGrade, usize>,
    /// Those of which the digits leave no other reading.
    unique: usize,
    first_of_unique: usize,
    listed: usize,
    /// Missed, where sets of slips match and none is named because a match would be chance.
    withheld: usize,
}

impl Tally {
    fn add(&mut self, case: &Sheet, grade: SheetGrade, withheld: bool) {
        *self.grades.entry(grade).or_default() += 1;
        let unique = case.truth.rivals == 0;
        self.unique += usize::from(unique);
        self.first_of_unique += usize::from(unique && grade == SheetGrade::Exact);
        self.listed += usize::from(matches!(grade, SheetGrade::Exact | SheetGrade::Listed));
        self.withheld += usize::from(withheld && grade == SheetGrade::Missed);
    }

    fn row(&self, name: &str) -> String {
        let count: usize = self.grades.values().sum();
        let of = |grade| self.grades.get(&grade).copied().unwrap_or(0);
        let percent = |part: usize, whole: usize| match whole {
            0 => "-".to_string(),
            whole => format!("{:.1} %", 100.0 * part as f64 / whole as f64),
        };
        format!(
            "| {name} | {count} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
            percent(self.first_of_unique, self.unique),
            percent(self.listed, count),
            percent(self.listed, count - self.withheld),
            of(SheetGrade::Listed),
            of(SheetGrade::Wrong),
            of(SheetGrade::Missed),
            self.withheld,
            of(SheetGrade::FalseAlarm),
        )
    }
}

fn main() -> Result<(), String> {
    let options = options()?;
    let mut truths = String::new();
    let mut tallies: BTreeMap<(&str, String), Tally> = BTreeMap::new();
    for number in 1..=options.sheets {
        let case = budget::sheet(options.seed, number);
        let name = format!("{number}.{}", case.ending);
        let (answer, withheld) = answer(&name, &case.bytes);
        let grade = budget::grade(&case.truth, &answer);
        let kind = match case.truth.slips.len() {
            2 => "two slips".to_string(),
            1 => "one slip".to_string(),
            _ => case.truth.verdict.clone(),
        };
        for group in [
            ("concealed", kind),
            ("layout", case.truth.layout.clone()),
            ("file", case.ending.to_string()),
        ] {
            tallies
                .entry(group)
                .or_default()
                .add(&case, grade, withheld);
        }
        for slip in &case.truth.slips {
            let id = slip.split('@').next().unwrap_or(slip);
            let of_slip = tallies.entry(("slip", id.to_string())).or_default();
            of_slip.add(&case, grade, withheld);
        }
        if let Some(folder) = &options.keep {
            save(folder.join(&name), case.bytes.clone())?;
            truths += &truth_line(&name, &case);
        }
        if options.misses && grade != SheetGrade::Exact {
            println!(
                "{name} {}: {grade:?}{}, truth {} ({} rivals), answer {} {:?}",
                case.truth.layout,
                if withheld { " (withheld)" } else { "" },
                case.truth.slips.join(" + "),
                case.truth.rivals,
                answer.verdict,
                answer.candidates.first()
            );
        }
    }
    if let Some(folder) = &options.keep {
        save(folder.join("truth.jsonl"), truths.into_bytes())?;
    }
    let report = report(&tallies, &options);
    match options.out {
        Some(folder) => {
            save(folder.join("audit.md"), report.into_bytes())?;
            save(folder.join("audit-sources.md"), sources()?)
        }
        None => {
            print!("{report}");
            Ok(())
        }
    }
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        sheets: 600,
        seed: SEED,
        misses: false,
        keep: None,
        out: None,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value"));
        let number = |text: String| text.parse().map_err(|_| format!("{text} is no number"));
        match name.as_str() {
            "--sheets" => options.sheets = number(value()?)?,
            "--seed" => options.seed = number(value()?)?,
            "--misses" => options.misses = true,
            "--keep" => options.keep = Some(value()?.into()),
            "--out" => options.out = Some(value()?.into()),
            other => return Err(format!("there is no option {other}")),
        }
    }
    Ok(options)
}

fn truth_line(name: &str, case: &Sheet) -> String {
    let mut truth = serde_json::json!(case.truth);
    truth["name"] = name.into();
    format!("{truth}\n")
}

fn save(path: PathBuf, content: Vec<u8>) -> Result<(), String> {
    write(&[Output { path, content }], Replacing::Anything)
        .map_err(|why| why.said(None).to_string())
}

/// What the program answers, and whether it says that matches are not named because they are likely to be chance.
fn answer(name: &str, bytes: &[u8]) -> (SheetAnswer, bool) {
    let claims = claims(name, bytes, &Mapping::default()).unwrap_or_default();
    let audits: Vec<_> = claims.iter().map(audit).collect();
    let withheld = audits.iter().any(|audit| audit.found.withheld > 0);
    let machine = report::audit(name, &audits, Language::English)
        .machine
        .value();
    (
        serde_json::from_value(machine).unwrap_or_default(),
        withheld,
    )
}

/// Audits of two published tables: annex A of JJF 2003-2022 and the four-point tumble, which states another u_c than its
/// figures give.
fn sources() -> Result<Vec<u8>, String> {
    let format = gumption::render::with_ending("md").ok_or("no Markdown")?;
    let page = gumption::render::Page {
        width: 100,
        styled: false,
    };
    let mut text = Vec::new();
    for path in [
        "docs/examples/jjf-2003-annex-a.csv",
        "docs/examples/four-point-tumble.md",
    ] {
        let bytes = gumption::Files::Disk
            .read(path.as_ref())
            .map_err(|error| error.to_string())?;
        let claims = claims(path, &bytes, &Mapping::default()).map_err(|why| why.0.to_string())?;
        let audits: Vec<_> = claims.iter().map(audit).collect();
        let document = report::audit(path, &audits, Language::English);
        let rendered = (format.render)(&document, &page);
        text.extend(rendered.map_err(|unfit| unfit.0.in_language(Language::English))?);
        text.push(b'\n');
    }
    Ok(text)
}

fn report(tallies: &BTreeMap<(&str, String), Tally>, options: &Options) -> String {
    let mut text = String::from("# Audits on concealed slips\n\n");
    let _ = writeln!(
        text,
        "{} budgets of seed {}, made by `gumption challenge --audit`, which knows nothing of how the audit reads or searches: 15 % sound, 10 % with a figure\n\
         that no slip gives, 20 % with two slips, the others with one; every kind of slip that a budget allows is equally frequent.\n\n\
         First: the truth is the first answer, of budgets of which no other set of as many slips gives the same sheet to every digit. In the list: it is\n\
         one of the answers; the same of the budgets whose digits allow it: without those that are missed by chance. Wrong: something else is named. Missed: a slip is\n\
         there, and none is named; by chance, where the answer says that slips match the figures, and that figures so coarse would be matched by accident. False alarm:\n\
         a slip is named where there is none.\n",
        options.sheets, options.seed
    );
    for group in ["concealed", "layout", "file", "slip"] {
        let _ = writeln!(
            text,
            "| {group} | budgets | first | in the list | where digits allow | listed, not first | wrong | missed | by chance | false alarm |\n|{}",
            "---|".repeat(10)
        );
        for ((_, name), tally) in tallies.iter().filter(|((of, _), _)| *of == group) {
            text += &tally.row(name);
        }
        text.push('\n');
    }
    text
}
