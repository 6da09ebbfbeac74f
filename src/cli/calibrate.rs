//! `gumption calibrate` and `gumption plan`: calibration files in, coefficients or predictions out.

use std::io::{stderr, stdout};
use std::path::PathBuf;

use gumption::calibrate::{self, Calibration, Experiment, Purpose, Trouble};
use gumption::report::{self, Language, Page};

use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Calibration file (docs/calibrate.md)
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    form: Form,
    /// Write a budget that `gumption eval` takes: of one coefficient, K1=k1.toml, or of all of them in
    /// one file, all.toml
    #[arg(long, value_name = "COEFFICIENT=FILE|FILE")]
    budget: Vec<String>,
}

#[derive(Debug, clap::Args)]
pub(super) struct PlanArgs {
    /// Calibration file with a schedule (docs/calibrate.md)
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    form: Form,
}

/// The form of the report.
#[derive(Debug, clap::Args)]
struct Form {
    /// Print JSON: exact numbers, stable names
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print Markdown
    #[arg(long)]
    markdown: bool,
    /// Language of the report: en or zh
    #[arg(long, value_name = "LANG", default_value = "en")]
    lang: Language,
    /// Write to this file instead of standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Form {
    fn page(&self) -> Page {
        Page {
            width: match &self.output {
                Some(_) => output::USUAL_WIDTH,
                None => output::page_width(),
            },
            styled: self.output.is_none() && output::may_style(&stdout()),
        }
    }

    fn write(&self, text: &str) -> Outcome {
        match &self.output {
            Some(path) => output::replace(path, text),
            None => output::print(text),
        }
    }

    fn fail(&self, file: &std::path::Path, trouble: &Trouble) -> Outcome {
        let why = report::calibration_trouble(trouble, self.lang);
        output::warn(&format!("error: {}: {why}\n", file.display()));
        Outcome::Negative
    }
}

pub(super) fn run(args: &Args) -> Outcome {
    let experiment = match read(&args.file, Purpose::Calibrate) {
        Ok(experiment) => experiment,
        Err(outcome) => return outcome,
    };
    let found = match calibrate::calibrate(&experiment) {
        Ok(found) => found,
        Err(trouble) => return args.form.fail(&args.file, &trouble),
    };
    let lang = args.form.lang;
    let text = if args.form.json {
        format!(
            "{:#}\n",
            report::calibration_json(&experiment, &found, lang)
        )
    } else if args.form.markdown {
        report::calibration_markdown(&experiment, &found, lang)
    } else {
        report::calibration_text(&experiment, &found, lang, args.form.page())
    };
    let written = budgets(args, &experiment, &found);
    args.form.write(&text).max(written)
}

pub(super) fn run_plan(args: &PlanArgs) -> Outcome {
    let experiment = match read(&args.file, Purpose::Plan) {
        Ok(experiment) => experiment,
        Err(outcome) => return outcome,
    };
    let plan = match calibrate::plan(&experiment) {
        Ok(plan) => plan,
        Err(trouble) => return args.form.fail(&args.file, &trouble),
    };
    let lang = args.form.lang;
    let text = if args.form.json {
        format!("{:#}\n", report::plan_json(&experiment, &plan, lang))
    } else if args.form.markdown {
        report::plan_markdown(&experiment, &plan, lang)
    } else {
        report::plan_text(&experiment, &plan, lang, args.form.page())
    };
    args.form.write(&text)
}

fn read(file: &std::path::Path, purpose: Purpose) -> Result<Experiment, Outcome> {
    calibrate::load(file, purpose).map_err(|rejection| {
        output::warn(&rejection.render(output::may_style(&stderr())));
        Outcome::BadInput
    })
}

/// Writes the budgets that were asked for, all of them or none.
fn budgets(args: &Args, experiment: &Experiment, found: &Calibration) -> Outcome {
    let names: Vec<&str> = found
        .figures
        .coefficients
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let mut files: Vec<(PathBuf, String)> = Vec::new();
    for wanted in &args.budget {
        let (places, path): (Vec<usize>, &str) = match wanted.split_once('=') {
            None => ((0..names.len()).collect(), wanted),
            Some((name, path)) => match names.iter().position(|other| *other == name) {
                Some(place) => (vec![place], path),
                None => {
                    return output::complain(&format!(
                        "there is no coefficient {name}; there are {}",
                        names.join(", ")
                    ));
                }
            },
        };
        files.push((path.into(), calibrate::budget(experiment, found, &places)));
    }
    output::replace_all(&files)
}
