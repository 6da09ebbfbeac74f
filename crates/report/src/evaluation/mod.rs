//! The document of an evaluation: its blocks in the order in which they are read, and its machine form.
//!
//! Every field of the machine form is always present; `null` means that there is no such figure.

mod certificate;
mod claims;
mod compose;
mod decisions;
mod fits;
mod joint;
mod matrix;
mod plots;
mod regions;
mod result;
mod series;
mod understood;
mod whole;

use serde_json::Value;

use self::whole::EvaluationJson;
use crate::{Report, statement, worksheet};
use gumption_format::document::Document;

/// One evaluated budget.
pub fn evaluation(report: &Report<'_>) -> Document {
    of(report, true)
}

/// The rows of one file: a series as a table, then its first `in_full` rows in full. Machines get every row.
pub fn evaluations(rows: &[Report<'_>], in_full: usize) -> Option<Document> {
    let documents = rows.iter().enumerate().map(|(i, row)| of(row, i < in_full));
    let mut whole = Document::together(documents.collect())?;
    if rows.len() > 1 {
        let mut series = series::blocks(rows);
        series.extend(certificate::blocks(rows));
        whole.edit(|blocks| drop(blocks.splice(0..0, series)));
        whole = whole.with_plots(plots::series(rows));
    }
    let sentences = match rows {
        [one] => statement::statement(one),
        rows => certificate::sentences(rows),
    };
    Some(match crate::certificate::of(rows, sentences) {
        Some(certificate) => whole.with_certificate(certificate),
        None => whole,
    })
}

fn of(report: &Report<'_>, in_full: bool) -> Document {
    let blocks = match in_full {
        true => compose::compose(report),
        false => Vec::new(),
    };
    let document = Document::new(&EvaluationJson::new(report), report.language, blocks);
    match in_full {
        true => document
            .with_sheets(worksheet::sheets(report))
            .with_plots(plots::plots(report))
            .with_plots(regions::plots(report)),
        false => document,
    }
}

/// JSON Schema of the output of `gumption eval --json`: one evaluation, or an array of them.
pub fn evaluation_schema() -> Value {
    gumption_format::machine::schema::<EvaluationJson<'_>>("gumption eval --json")
}
