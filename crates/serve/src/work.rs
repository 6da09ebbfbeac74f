//! Evaluations, audits, calibrations, diagnoses: a document, or what is wrong.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;

use serde::Deserialize;
use serde_json::{Value, json};

use gumption_audit::read::Mapping;
use gumption_audit::sheet::Unreadable;
use gumption_audit::{audit, claims, nothing_understood};
use gumption_export::{Format, Page};
use gumption_fault::language::Language;
use gumption_fault::{Fault, Rejection, Said, of_system, say};
use gumption_format::document::{Attachment, Document};
use gumption_format::files::{Files, Folder};
use gumption_format::toml::Step;
use gumption_gum::budget::{self, Budget, Row};
use gumption_gum::propagate::{
    self, EvaluatedRow, Evaluation, EvaluationError, MonteCarloChoice, Options,
};
use gumption_gum::versions::versions;
use gumption_lab::calibrate::{self, Calibration, Campaign, PointNames, Reading, Residual};
use gumption_lab::diagnose::{self, case};
use gumption_lab::experiment::{Kind, Purpose, kind_of};
use gumption_report::{self as report, Report};

use super::exchange::Contents;
use super::exercises::{self, Practice, Shown};
use super::forms::{self, Edit};
use super::lessons;
use super::movable;
use super::pages::Job;
use super::shelf::Shelf;

/// Most trials of a budget that is evaluated while somebody waits: some seconds.
const MOST_TRIALS: u64 = 100_000_000;

/// Readings that a page may ask "what if" of: far beyond what anybody takes by hand, and quick.
const MOST_READINGS: usize = 10_000;

/// Residuals that the page draws; of more the largest.
const MOST_RESIDUALS: usize = 2000;

/// What is to be done with a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Task {
    /// A budget is evaluated, an experiment calibrated.
    See,
    /// What U would need.
    Require,
    /// What the edits since an earlier text have changed.
    Versions,
    /// A recording is held against its model.
    Diagnose,
    /// What an experiment would find, or tell apart.
    Plan,
    /// A claimed budget is recomputed.
    Audit,
    /// Samples are drawn for a class.
    Lesson,
    /// An exercise is handed out or graded.
    Exercise,
}

/// What a page asks for.
#[derive(Debug, Deserialize)]
pub(crate) struct Wish {
    pub task: Task,
    pub page: String,
    /// The file, from the top of the folder.
    pub path: String,
    pub language: Tongue,
    /// Name of the format in which the document is handed over; the page itself shows HTML.
    pub format: Option<String>,
    #[serde(default)]
    pub changes: Vec<Change>,
    /// Measurand and U that are wished for.
    pub target: Option<Target>,
    /// Earlier text of the file, against which it is compared.
    pub before: Option<String>,
    /// Lesson that is drawn.
    pub lesson: Option<Drawing>,
    /// File with the data of the certificate that the result is to be.
    pub certificate: Option<String>,
    /// Exercise that is handed out or graded.
    pub exercise: Option<Practice>,
}

/// A language by its code.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Tongue {
    En,
    Zh,
}

impl From<Tongue> for Language {
    fn from(tongue: Tongue) -> Language {
        match tongue {
            Tongue::En => Language::English,
            Tongue::Zh => Language::Chinese,
        }
    }
}

/// What would be otherwise.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(crate) enum Change {
    /// An input.
    Input {
        input: String,
        /// Its estimate.
        value: Option<f64>,
        /// What its uncertainty is multiplied by.
        factor: Option<f64>,
    },
    /// An entry of the text.
    Entry { path: Vec<Step>, typed: String },
    /// How many readings there are.
    Readings { readings: Vec<Step>, n: usize },
}

/// A wish for U.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Target {
    measurand: String,
    expanded: f64,
    /// What it costs to halve the uncertainty of inputs; null for one that stays as it is.
    #[serde(default)]
    costs: HashMap<String, Option<f64>>,
}

/// Cost of halving an uncertainty where none is said: all alike.
const COST: f64 = 1.0;

/// A lesson with how it is drawn.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Drawing {
    name: String,
    /// Readings, or terms.
    n: usize,
    seed: u64,
}

/// What came of it.
pub(crate) enum Found {
    /// A document, and what the page shows beside it.
    Document(Box<Document>, Value),
    /// A file has faults.
    Refused(Box<Rejection>),
    /// There is no result, and why.
    Nothing(String),
}

impl From<Rejection> for Found {
    fn from(rejection: Rejection) -> Found {
        Found::Refused(Box::new(rejection))
    }
}

/// The format that a wish names.
pub(crate) fn format(wish: &Wish) -> Option<&'static Format> {
    gumption_export::named(wish.format.as_deref().unwrap_or("html"))
}

/// Does what a page asks for, with the contents that it sends in place of those on the disk.
pub(crate) fn done(
    wish: &Wish,
    contents: &Contents,
    (shelf, shown): (&Shelf, &Shown),
    job: &Job,
) -> Found {
    let otherwise = match otherwise(wish, contents) {
        Ok(otherwise) => otherwise,
        Err(why) => return Found::Nothing(why.in_language(wish.language.into())),
    };
    let contents = contents.iter();
    let mut instead: Vec<(&str, &[u8])> = contents
        .map(|(path, content)| (path.as_str(), content.as_slice()))
        .collect();
    if let Some(text) = &otherwise {
        instead.retain(|(path, _)| *path != wish.path);
        instead.push((&wish.path, text.as_bytes()));
    }
    let folder = shelf.folder(&instead);
    let files = Files::Folder(&folder);
    let asked = Asked {
        wish,
        files,
        folder: &folder,
        path: Path::new(&wish.path),
        language: wish.language.into(),
        job,
        shown,
    };
    let found = match wish.task {
        Task::Audit => asked.audit(),
        Task::Diagnose => asked.diagnose(),
        Task::Plan => asked.plan(),
        Task::See if asked.kind() == Kind::Certificate => asked.certificate(),
        Task::See if asked.is_experiment() => asked.calibrate(),
        Task::See => asked.evaluate(),
        Task::Require => asked.require(),
        Task::Versions => asked.versions(),
        Task::Lesson => asked.lesson(),
        Task::Exercise => asked.exercise(),
    };
    match found.unwrap_or_else(|found| found) {
        // Its places are not those of the text that is edited.
        Found::Refused(rejection) if otherwise.is_some() => {
            let why = rejection.faults.first().map(|fault| &fault.message);
            Found::Nothing(why.map_or(String::new(), |why| why.in_language(asked.language)))
        }
        found => found,
    }
}

/// The text as it would be; nothing where all its entries stay.
fn otherwise(wish: &Wish, contents: &Contents) -> Result<Option<String>, Said> {
    let own = contents.iter().find(|(path, _)| *path == wish.path);
    let text = own.map_or(Cow::Borrowed(""), |(_, content)| {
        String::from_utf8_lossy(content)
    });
    let edits = wish.changes.iter().filter_map(|change| match change {
        Change::Input { .. } => None,
        Change::Entry { path, typed } => Some((path, typed.clone())),
        Change::Readings { readings, n } => {
            let n = (*n).min(MOST_READINGS);
            movable::as_many(&text, readings, n).map(|typed| (readings, typed))
        }
    });
    let edits: Vec<Edit> = edits
        .map(|(path, typed)| Edit::Set {
            path: path.clone(),
            typed,
        })
        .collect();
    if edits.is_empty() {
        return Ok(None);
    }
    forms::edited(&text, &edits).map(Some)
}

/// A wish with what it takes.
struct Asked<'a> {
    wish: &'a Wish,
    files: Files<'a>,
    folder: &'a Folder<'a>,
    path: &'a Path,
    language: Language,
    job: &'a Job,
    shown: &'a Shown,
}

impl Asked<'_> {
    fn nothing(&self, why: &Said) -> Found {
        Found::Nothing(why.in_language(self.language))
    }

    fn kind(&self) -> Kind {
        let bytes = self.files.read(self.path).unwrap_or_default();
        kind_of(&String::from_utf8_lossy(&bytes))
    }

    fn is_experiment(&self) -> bool {
        matches!(self.kind(), Kind::Schedule | Kind::Experiment)
    }

    /// What is wrong with the data of a certificate, or where they are used.
    fn certificate(&self) -> Result<Found, Found> {
        report::administration(self.files, self.path)?;
        Err(self.nothing(&say!(
            "the data of the certificate are complete: choose this file under \"Certificate\" beside a budget"
        )))
    }

    /// The document as that of the certificate whose data are chosen, with the budget in it.
    fn certified(&self, document: Document) -> Result<Document, Found> {
        let Some(file) = &self.wish.certificate else {
            return Ok(document);
        };
        // Its places are not those of the text that is edited.
        let given = report::administration(self.files, Path::new(file)).map_err(|rejection| {
            let why = rejection.faults.into_iter().next();
            let why = why.map_or(Said::default(), |fault| fault.message);
            self.nothing(&say!("{file}: {why}"))
        })?;
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        let budget = Attachment {
            name: name.into_owned(),
            media_type: "application/toml",
            content: self.files.read(self.path).unwrap_or_default(),
        };
        Ok(report::certified(document, &given, vec![budget]))
    }

    fn evaluate(&self) -> Result<Found, Found> {
        let rows = self.rows(MonteCarloChoice::AsBudget)?;
        let reports: Vec<Report<'_>> = rows
            .iter()
            .map(|row| Report::of(row, self.language))
            .collect();
        let mut first = reports.first().map_or(Value::Null, beside);
        let text = self.files.read(self.path).unwrap_or_default();
        first["entries"] = json!(movable::movable(&String::from_utf8_lossy(&text)));
        let document = report::evaluations(&reports, 1);
        let document = document.ok_or_else(|| self.nothing(&say!("the file has no rows")))?;
        let document = self.certified(document)?;
        Ok(Found::Document(Box::new(document), first))
    }

    /// The rows of the file as the changes make them, evaluated.
    fn rows(&self, monte_carlo: MonteCarloChoice) -> Result<Vec<EvaluatedRow>, Found> {
        let loaded = budget::load_from(self.files, self.path, None)?;
        let rows = loaded.rows.into_iter();
        rows.map(|Row { label, budget }| {
            let budget = self.changed(budget);
            let evaluation = self.evaluated(&budget, monte_carlo.clone())?;
            Ok(EvaluatedRow {
                label,
                budget,
                evaluation,
            })
        })
        .collect()
    }

    fn changed(&self, budget: Budget) -> Budget {
        self.wish.changes.iter().fold(budget, |budget, change| {
            let Change::Input {
                input,
                value,
                factor,
            } = change
            else {
                return budget;
            };
            let mut inputs = budget.inputs.iter();
            let Some(input) = inputs.position(|one| one.name == *input) else {
                return budget;
            };
            let budget = match value.filter(|value| value.is_finite()) {
                Some(value) => budget.at(input, value),
                None => budget,
            };
            match factor.filter(|factor| factor.is_finite() && *factor >= 0.0) {
                Some(factor) => budget.with_uncertainty(input, factor),
                None => budget,
            }
        })
    }

    fn evaluated(
        &self,
        budget: &Budget,
        monte_carlo: MonteCarloChoice,
    ) -> Result<Evaluation, Found> {
        let most = budget.monte_carlo.trials.most();
        if monte_carlo != MonteCarloChoice::Off && most > MOST_TRIALS {
            let why = say!(
                "the file asks for {most} trials, and the page draws {MOST_TRIALS} at most; `gumption eval` draws them all"
            );
            return Err(self.nothing(&why));
        }
        let options = Options {
            monte_carlo,
            progress: self.job.trials.clone(),
            ..Options::default()
        };
        propagate::evaluate(budget, &options)
            .map_err(|error| Found::Nothing(error.said().in_language(self.language)))
    }

    fn require(&self) -> Result<Found, Found> {
        let rows = self.rows(MonteCarloChoice::Off)?;
        let asked = self.wish.target.as_ref().zip(rows.first());
        let asked = asked.and_then(|(target, row)| {
            let mut outputs = row.budget.model.outputs().iter();
            let measurand = outputs.position(|output| output.name == target.measurand)?;
            Some((target, row, measurand))
        });
        let (target, row, measurand) = asked.ok_or_else(|| self.no_target())?;
        let inputs = row.budget.inputs.iter();
        let costs: Vec<f64> = inputs
            .map(|input| match target.costs.get(input.name.as_str()) {
                Some(cost) => cost.unwrap_or(f64::INFINITY),
                None => COST,
            })
            .collect();
        let alone = propagate::requirements(&row.budget, measurand, target.expanded);
        let together = propagate::cheapest(&row.budget, measurand, target.expanded, &costs);
        let failed =
            |error: EvaluationError| Found::Nothing(error.said().in_language(self.language));
        let found = alone.map_err(failed)?.zip(together.map_err(failed)?);
        let (alone, together) = found.ok_or_else(|| self.no_target())?;
        let document = report::requirements(&Report::of(row, self.language), &alone, &together);
        Ok(Found::Document(Box::new(document), Value::Null))
    }

    fn versions(&self) -> Result<Found, Found> {
        let nothing = || self.nothing(&say!("there is no earlier text to compare with"));
        let before = self.wish.before.as_deref().ok_or_else(nothing)?;
        let bytes = self.files.read(self.path).unwrap_or_default();
        let after = String::from_utf8_lossy(&bytes);
        let load = |text: &str| {
            let own = self.wish.path.as_str();
            // Nobody waits any more: no further mixture is evaluated.
            if self.job.trials.is_stopped() {
                return Err(Rejection::new(own, text, Vec::new()));
            }
            let others = self.folder.instead.iter().filter(|(path, _)| *path != own);
            let instead: Vec<(&str, &[u8])> =
                others.copied().chain([(own, text.as_bytes())]).collect();
            let folder = Folder {
                root: self.folder.root,
                instead: &instead,
            };
            budget::load_from(Files::Folder(&folder), self.path, None)
        };
        let found = versions(before, &after, load)
            .map_err(|why| Found::Nothing(report::incomparable(&why, self.language)))?;
        let document = report::versions(&found, self.language);
        Ok(Found::Document(Box::new(document), Value::Null))
    }

    fn no_target(&self) -> Found {
        self.nothing(&say!("write the U that is wished for as a positive number"))
    }

    fn lesson(&self) -> Result<Found, Found> {
        let drawing = self.wish.lesson.as_ref();
        let document = drawing.and_then(|Drawing { name, n, seed }| {
            lessons::lesson(name, *n, *seed, self.language, &self.job.trials)
        });
        let document = document
            .ok_or_else(|| self.nothing(&Said::pair("there is no such lesson", "没有这一课")))?;
        let count = drawing.and_then(|drawing| lessons::counted(&drawing.name, drawing.n));
        Ok(Found::Document(
            Box::new(document),
            json!({ "count": count }),
        ))
    }

    fn exercise(&self) -> Result<Found, Found> {
        let nothing = || self.nothing(&say!("there is no such exercise"));
        let practice = self.wish.exercise.as_ref().ok_or_else(nothing)?;
        let found = exercises::practice(practice, self.language, self.shown);
        let (document, beside) = found.map_err(|why| self.nothing(&why))?;
        Ok(Found::Document(Box::new(document), beside))
    }

    fn calibrate(&self) -> Result<Found, Found> {
        let campaign = calibrate::load_from(self.files, self.path, Purpose::Calibrate)?;
        let found = calibrate::calibrate(&campaign).map_err(|trouble| {
            Found::Nothing(report::calibration_trouble(&trouble, self.language))
        })?;
        let document = report::calibration(&campaign, &found, self.language);
        Ok(Found::Document(
            Box::new(document),
            json!({
                "experiment": true,
                "residuals": by_line(&campaign, &found),
                "dwells": matches!(campaign.points.names, PointNames::Words(_)),
            }),
        ))
    }

    fn diagnose(&self) -> Result<Found, Found> {
        let case = case::Case::load_from(self.files, self.path, case::Purpose::Diagnosis)?;
        let found = diagnose::diagnose(&case, &|share| self.job.at(share)).map_err(|failure| {
            Found::Nothing(report::diagnosis_failure(&case, &failure, self.language))
        })?;
        let document = report::diagnosis(&case, &found, self.language);
        Ok(Found::Document(
            Box::new(document),
            json!({ "experiment": true }),
        ))
    }

    fn plan(&self) -> Result<Found, Found> {
        let document = match self.kind() {
            Kind::Schedule => {
                let campaign = calibrate::load_from(self.files, self.path, Purpose::Plan)?;
                let plan = calibrate::plan(&campaign).map_err(|trouble| {
                    Found::Nothing(report::calibration_trouble(&trouble, self.language))
                })?;
                report::plan(&campaign, &plan, self.language)
            }
            _ => {
                let case = case::Case::load_from(self.files, self.path, case::Purpose::Plan)?;
                let plan = diagnose::plan(&case, &|share| self.job.at(share));
                let plan = plan.map_err(|failure| {
                    Found::Nothing(report::diagnosis_failure(&case, &failure, self.language))
                })?;
                report::outlook(&case, &plan, self.language)
            }
        };
        let beside = json!({ "experiment": true });
        Ok(Found::Document(Box::new(document), beside))
    }

    fn audit(&self) -> Result<Found, Found> {
        let name = &self.wish.path;
        let unreadable = |why: Said| self.nothing(&say!("cannot read {name}: {why}"));
        let bytes = self.files.read(self.path);
        let bytes = bytes.map_err(|error| unreadable(of_system(&error)))?;
        let claims = claims(name, &bytes, &Mapping::default());
        let claims = claims.map_err(|Unreadable(why)| unreadable(why))?;
        let audits: Vec<_> = claims.iter().map(audit).collect();
        if audits.is_empty() {
            return Err(self.nothing(&nothing_understood(name, &bytes)));
        }
        let document = report::audit(name, &audits, self.language);
        Ok(Found::Document(Box::new(document), Value::Null))
    }
}

/// What the page shows beside the document of an evaluation: inputs that can be moved, results to compare.
fn beside(report: &Report<'_>) -> Value {
    let (budget, evaluation) = (report.budget, report.evaluation);
    let first = evaluation.results.first();
    let inputs = budget.inputs.iter().enumerate().map(|(at, input)| {
        let line = first.and_then(|result| result.gum.inputs.get(at));
        json!({
            "name": input.name, "unit": input.unit.after_number(), "value": input.estimate,
            "u": line.map(|line| line.u), "share": line.map(|line| line.share),
        })
    });
    let outputs = budget.model.outputs().iter();
    let results = outputs.zip(&evaluation.results).map(|(output, result)| {
        let gum = &result.gum;
        json!({
            "name": output.name, "unit": output.unit.difference().after_number(),
            "y": gum.estimate, "U": gum.coverage.expanded,
        })
    });
    json!({
        "inputs": inputs.collect::<Vec<_>>(),
        "results": results.collect::<Vec<_>>(),
        "statement": report::statement(report),
    })
}

/// What the page brushes: line, response, standardised residual where each row of the recording is a point; else of the
/// readings that were averaged, how far they lie from their averages.
fn by_line(campaign: &Campaign, found: &Calibration) -> Vec<Value> {
    let responses = campaign.experiment.equations.responses();
    let mut rows: Vec<Value> = match &campaign.points.names {
        PointNames::Lines(lines) => {
            let row = |one: &Residual| {
                let line = lines.get(one.point)?;
                let response = responses.get(one.response);
                let response = response.map_or("", |response| &response.name);
                let size = one.standardised;
                size.is_finite().then(|| json!([line, response, size]))
            };
            found.residuals.iter().filter_map(row).collect()
        }
        PointNames::Words(_) => {
            let is_response = |one: &&Reading| responses.iter().any(|own| own.name == one.column);
            let own = campaign.points.readings.iter().filter(is_response);
            let row = |one: &Reading| json!([one.line, one.column, one.deviation]);
            own.map(row).collect()
        }
    };
    if rows.len() > MOST_RESIDUALS {
        let size = |row: &Value| row[2].as_f64().unwrap_or(0.0).abs();
        rows.sort_by(|a, b| size(b).total_cmp(&size(a)));
        rows.truncate(MOST_RESIDUALS);
    }
    rows
}

/// What came of a wish, for the page.
pub(crate) fn shown(found: &Found, language: Language) -> Value {
    match found {
        Found::Document(document, beside) => {
            let html = gumption_export::named("html");
            let html = html.map(|html| (html.render)(document, &Page::default()));
            match html {
                Some(Ok(page)) => {
                    json!({ "html": String::from_utf8_lossy(&page), "beside": beside })
                }
                Some(Err(unfit)) => json!({ "message": unfit.0.in_language(language) }),
                None => Value::Null,
            }
        }
        Found::Refused(rejection) => {
            let faults = rejection.shown().iter();
            let faults: Vec<Value> = faults
                .map(|fault| placed(fault, &rejection.text, language))
                .collect();
            let others = rejection.others.iter();
            let others: Vec<String> = others
                .map(|other| other.render_in(language, false))
                .collect();
            json!({ "faults": faults, "others": others.join("\n") })
        }
        Found::Nothing(why) => json!({ "message": why }),
    }
}

/// A fault with its place as an editor of the browser counts: in units of UTF-16, lines from 1.
fn placed(fault: &Fault, text: &str, language: Language) -> Value {
    let until = |byte: usize| &text[..text.floor_char_boundary(byte.min(text.len()))];
    let units = |byte: usize| until(byte).encode_utf16().count();
    json!({
        "code": fault.code.id,
        "message": fault.message.in_language(language),
        "label": fault.label.in_language(language),
        "help": fault.help.as_ref().map(|help| help.in_language(language)),
        "line": until(fault.span.start).matches('\n').count() + 1,
        "from": units(fault.span.start),
        "to": units(fault.span.end),
    })
}
