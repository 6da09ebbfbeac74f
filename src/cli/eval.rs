//! `gumption eval`: budget files in, reports out.

use std::path::{Path, PathBuf};

use super::evaluated::{Settings, of_rows, options};
use super::form::Form;
use super::other_kind::{self, Reads};
use super::output::{Beside, Complaint};
use super::progress::Progress;
use super::{Outcome, archive, output};
use gumption::Files;
use gumption::budget;
use gumption::document::{Attachment, Document};
use gumption::fault::say;
use gumption::files::write::Output;
use gumption::propagate::{self, ConformityResult, EvaluatedRow, Verdict};
use gumption::report::{self, Language, Report};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Budget files
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    settings: Settings,
    /// Worker threads; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print every row of a series in full, not only the first
    #[arg(long)]
    full: bool,
    /// Save the results for other budgets, which name this file in `from = { result = … }`
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Write the results as a table of comma-separated values, too: one line for each row of a series, exact, with units in
    /// the heads
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Put everything that the results are computed from into an archive, too: budget, data, results, version, seed, hashes.
    /// `gumption verify FILE.zip` evaluates it again
    #[arg(long, value_name = "FILE.zip")]
    archive: Option<PathBuf>,
    /// Data of a certificate: number, dates, laboratory, customer, item (`gumption new --certificate FILE` writes them to
    /// fill in). They head the document, and a digital certificate (-o FILE.xml) is made with them
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    let of_one_file = [
        ("--save", &args.save),
        ("--csv", &args.csv),
        ("--archive", &args.archive),
        ("--certificate", &args.certificate),
    ];
    let asked = of_one_file.iter().find(|(_, path)| path.is_some());
    if let (Some((flag, _)), 2..) = (asked, args.files.len()) {
        return output::complain(say!(
            "{flag} takes the results of one budget file; evaluate the files one after the other"
        ));
    }
    let files = args.save.iter().chain(&args.csv).chain(&args.archive);
    let beside: Vec<Beside> = files.cloned().map(Beside::File).collect();
    if let Err(outcome) = args.form.is_possible(&beside) {
        return outcome;
    }
    let administration = args.certificate.as_deref();
    let administration = administration.map(|path| report::administration(Files::Disk, path));
    let administration = match administration.transpose() {
        Ok(administration) => administration,
        Err(rejection) => return output::refused(&rejection, args.form.language()),
    };
    if let Some(kept) = administration.as_ref().and_then(report::template_names) {
        let lang = args.form.language();
        output::note(&kept.in_language(lang), lang);
    }
    let mut worst = Outcome::Done;
    let mut documents = Vec::new();
    let mut saved = Vec::new();
    for file in &args.files {
        let rows = evaluate_file(args, file, &mut worst);
        if let (Some(path), false) = (&args.save, rows.is_empty()) {
            match save(&rows, path, args.form.language()) {
                Ok(output) => saved.push(output),
                Err(complaint) => worst = worst.max(output::complain(complaint)),
            }
        }
        if let (Some(path), false) = (&args.csv, rows.is_empty()) {
            match table(&rows, path) {
                Ok(output) => saved.push(output),
                Err(complaint) => worst = worst.max(output::complain(complaint)),
            }
        }
        if let (Some(path), false) = (&args.archive, rows.is_empty()) {
            match archived(args, file, &rows, path) {
                Ok(output) => saved.push(output),
                Err(complaint) => worst = worst.max(output::complain(complaint)),
            }
        }
        let document = document(args, &rows);
        documents.extend(match &administration {
            Some(given) => document.map(|whole| report::certified(whole, given, attached(file))),
            None => document,
        });
    }
    match Document::together(documents) {
        Some(document) => worst.max(args.form.write_with(&document, saved)),
        None => worst,
    }
}

/// The budget file, to be handed over with a certificate.
fn attached(file: &Path) -> Vec<Attachment> {
    let content = Files::Disk.read(file).ok();
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let attachment = content.map(|content| Attachment {
        name: name.into_owned(),
        media_type: "application/toml",
        content,
    });
    attachment.into_iter().collect()
}

/// The document of a file's rows; none of none.
fn document(args: &Args, rows: &[EvaluatedRow]) -> Option<Document> {
    let in_full = if args.full { rows.len() } else { 1 };
    args.form
        .compose_some(|language| of_rows(rows, language, in_full))
}

/// The results for other budgets.
fn save(rows: &[EvaluatedRow], path: &Path, language: Language) -> Result<Output, Complaint> {
    let reports: Vec<Report<'_>> = rows.iter().map(|row| Report::of(row, language)).collect();
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let folder = budget::Files::Disk.identity(folder);
    let text = report::saved(&reports, &folder).map_err(|why| say!("nothing is saved: {why}"))?;
    Ok(Output {
        path: path.to_path_buf(),
        content: text.into_bytes(),
    })
}

/// Everything that the results are computed from.
fn archived(
    args: &Args,
    file: &Path,
    rows: &[EvaluatedRow],
    path: &Path,
) -> Result<Output, Complaint> {
    let result = of_rows(rows, Language::English, 1).ok_or_else(|| say!("there are no results"))?;
    Ok(Output {
        path: path.to_path_buf(),
        content: archive::packed(file, &args.settings, &result)?,
    })
}

/// The results as rows of numbers.
fn table(rows: &[EvaluatedRow], path: &Path) -> Result<Output, Complaint> {
    let reports: Vec<Report<'_>> = rows
        .iter()
        .map(|row| Report::of(row, Language::English))
        .collect();
    let content = report::rows(&reports).map_err(|why| say!("no table is written: {why}"))?;
    Ok(Output {
        path: path.to_path_buf(),
        content,
    })
}

/// Reads and evaluates one file; says on standard error what fails, and goes on.
fn evaluate_file(args: &Args, file: &Path, worst: &mut Outcome) -> Vec<EvaluatedRow> {
    let loaded = match budget::load_under(file, args.settings.profile) {
        Ok(loaded) => loaded,
        Err(rejection) => {
            *worst = other_kind::refused(&rejection, Reads::Budget, args.form.language());
            return Vec::new();
        }
    };
    let mut rows = Vec::with_capacity(loaded.rows.len());
    let trials = propagate::Progress::default();
    let progress = Progress::shown(&trials);
    for budget::Row { label, budget } in loaded.rows {
        match propagate::evaluate(
            &budget,
            &options(&args.settings, args.threads, &budget, &trials),
        ) {
            Ok(evaluation) => {
                let rejected =
                    |found: &ConformityResult| found.verdict == Some(Verdict::NotConforming);
                if evaluation.conformity.iter().any(rejected) {
                    *worst = (*worst).max(Outcome::Negative);
                }
                rows.push(EvaluatedRow {
                    label,
                    budget,
                    evaluation,
                });
            }
            Err(error) => {
                let row = label.map(|l| format!(", {l}")).unwrap_or_default();
                let place = format!("{}{row}", file.display());
                let why = error.said().in_language(args.form.language());
                output::no_result(place, None, &why, args.form.language());
                *worst = (*worst).max(Outcome::Negative);
            }
        }
    }
    drop(progress);
    rows
}
