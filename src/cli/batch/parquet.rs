//! Tables of a batch as Apache Parquet.

use std::borrow::Cow;
use std::path::Path;

use gumption::batch::{Lot, STRETCH};
use gumption::csv::Cells;
use gumption::fault::{Rejection, Said};
use gumption::files::Files;
pub(super) use gumption::render::parquet::Rows;
use gumption::render::parquet::Writer;
use gumption::report::batch::{Count, ResultColumn, Results, Values};

use super::Work;
use crate::cli::Outcome;
use crate::cli::output::{self, Sink};

/// Rows of a row group: engines take over groups as wholes, and this many rows of a few dozen columns are some megabytes.
const GROUP: usize = 1 << 17;

/// Opens a table.
pub(super) fn open(path: &Path, name: &str) -> Result<Rows, Rejection> {
    // Says what is no file, as of any table.
    gumption::csv::open(Files::Disk, path, name)?;
    Rows::open(path, STRETCH).map_err(|fault| Rejection::new(name, "", vec![*fault]))
}

/// Writes the results as they come, a row group after another.
pub(super) fn written(work: Work<'_>, mut sink: Sink) -> Result<Count, Outcome> {
    let columns = work.columns();
    let mut results = Results::of(columns, work.file);
    let mut writer = Writer::default();
    let mut numbered = 0;
    let mut put = |results: Vec<(String, ResultColumn)>| -> Result<(), Said> {
        let cells = cells(results, &mut numbered);
        sink.add(&writer.add(&cells, &["seed"])?)
    };
    let add = |values: &mut Values, row: &Lot<'_>| columns.add_values(values, row);
    let kept = work.each(add, |values| {
        results.add(values);
        match results.rows() < GROUP {
            true => Ok(()),
            false => put(results.take()),
        }
    })?;
    results.keep(kept);
    let (left, count) = results.end();
    let done = put(left);
    let done = done.and_then(|()| sink.add(&writer.end()?));
    let done = done.and_then(|()| sink.finish());
    done.map(|()| count).map_err(output::complain)
}

/// Columns as they are written; a row without a label has its number.
fn cells(
    results: Vec<(String, ResultColumn)>,
    numbered: &mut u64,
) -> Vec<(String, Cells<'static>)> {
    let rows = results.iter().map(|(_, column)| column.cells()).max();
    let rows = rows.unwrap_or(0);
    let cells = |column| match column {
        ResultColumn::Numbers(numbers) => Cells::Numbers(Cow::Owned(numbers)),
        ResultColumn::Texts(Some(texts)) => Cells::Texts(texts),
        ResultColumn::Texts(None) => Cells::Texts(vec![String::new(); rows]),
    };
    let mut all: Vec<_> = results
        .into_iter()
        .map(|(name, column)| (name, cells(column)))
        .collect();
    if let Some((_, Cells::Texts(labels))) = all.first_mut() {
        for label in labels {
            *numbered += 1;
            if label.is_empty() {
                *label = numbered.to_string();
            }
        }
    }
    all
}
