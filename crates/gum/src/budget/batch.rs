//! A budget for every row of a table beside it: what a series says within the budget. Rows are read one by one, so that a
//! faulty one is its own affair and the length of the table does not matter.

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml::de::DeTable;

use super::check::{Origin, Variant};
use super::faults::{SERIES, UNKNOWN_NAME};
use super::open_files::OpenFiles;
use super::pattern::Pattern;
use super::plain_number::plain_number;
use super::points::Columns;
use super::reader::{checked, open_files, read_under, tables, text_of};
use super::series::{self, Column, Ground};
use super::{Budget, Files, Profile, Row, hints::HINTS};
use gumption_core::quantity::UnitTable;
use gumption_fault::{Fault, Rejection, nearest, say};
use gumption_format::csv::faults::{NO_COLUMN, SAME_NAME};
use gumption_format::csv::{self, Sheet};
use gumption_format::toml::{Reader, Stated, document, leaves_the_rest, syntax_faults};

/// The text of a budget, whose values a table is to replace.
#[derive(Debug)]
pub struct BatchFile<'f> {
    files: Files<'f>,
    path: PathBuf,
    text: String,
    profile: Option<&'static Profile>,
}

impl<'f> BatchFile<'f> {
    /// Reads it; checked it is with the rows of a table in place.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn open(
        files: Files<'f>,
        path: &Path,
        profile: Option<&'static Profile>,
    ) -> Result<BatchFile<'f>, Rejection> {
        let text = text_of(files, path)?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned();
        Ok(BatchFile {
            files,
            path: path.to_path_buf(),
            text,
            profile,
        })
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The budget as it stands, where it needs no table to be whole.
    pub fn alone(&self) -> Option<Budget> {
        let open = open_files(self.files);
        let origin = Origin {
            files: &open,
            directory: self.directory(),
            file: &self.files.identity(&self.path),
        };
        let mut loaded = read_under(&self.text, &self.name(), origin, self.profile).ok()?;
        (loaded.rows.len() == 1).then(|| loaded.rows.swap_remove(0).budget)
    }

    /// The units of the program and of the budget.
    pub fn units(&self) -> UnitTable {
        let (file, _) = document(&self.text, HINTS.synonyms);
        Ground::of(file.get_ref()).units().clone()
    }

    fn directory(&self) -> &Path {
        self.path.parent().unwrap_or_else(|| Path::new(""))
    }

    /// The places that the columns of a table set; `table` is its name, for messages. Columns that are to be kept may be none.
    ///
    /// # Errors
    /// The budget is no TOML, or has a series of its own; a column is none of its places, or one that is to be kept is not
    /// in the table.
    pub fn batch(
        &self,
        sheet: &Sheet<'_>,
        table: &str,
        keep: &[String],
    ) -> Result<Batch<'_>, Rejection> {
        let (file, errors) = document(&self.text, HINTS.synonyms);
        let refused = |faults| Err(Rejection::new(&self.name(), &self.text, faults));
        let syntax = syntax_faults(&errors, &self.text, HINTS.synonyms);
        if !errors.iter().all(leaves_the_rest) || !syntax.is_empty() {
            return refused(syntax);
        }
        let file = file.into_inner();
        if let Some((series, _)) = file.get_key_value("series") {
            let fault = Fault::new(
                SERIES,
                series.span(),
                say!("the budget has a series of its own"),
            );
            return refused(vec![
                fault
                    .label(say!("the table takes its place"))
                    .help(say!("delete it, or evaluate the budget without a table")),
            ]);
        }
        let in_table = |faults| Rejection::new(table, sheet.text(), faults);
        let place = |at| sheet.name_place(at);
        let columns = Columns::of(sheet, place, &Ground::of(&file)).map_err(in_table)?;
        let mut faults = Vec::new();
        let kept = kept(keep, sheet, &columns.names, &mut faults);
        let names = &columns.names;
        let taken = kept
            .iter()
            .filter(|at| names_a_result(&names[**at].value, &file));
        faults.extend(taken.map(|at| keeps_a_result(&names[*at])));
        let names = columns.names.iter().enumerate();
        let target = |(at, name): (usize, &Stated<String>)| {
            let before = faults.len();
            let target = series::column(&file, name, &mut faults);
            if kept.contains(&at) && faults.len() > before {
                faults.truncate(before);
                return Some(Column::Kept);
            }
            faults[before..].iter_mut().for_each(|fault| {
                // Their other places are in the budget.
                fault.related.clear();
                suggest_to_keep(fault, &name.value);
            });
            target
        };
        let targets: Vec<Option<Column>> = names.map(target).collect();
        faults.extend(series::set_twice(&file, &columns.names, &targets));
        let sets = |at: usize| matches!(targets[at], Some(Column::Path(_)));
        faults.extend(csv::two_decimal_signs(sheet, sets));
        faults.extend(csv::summary_of_rows(sheet, sets));
        if !faults.is_empty() {
            return Err(in_table(faults));
        }
        Ok(Batch {
            of: self,
            identity: self.files.identity(&self.path),
            name: self.name(),
            file,
            columns,
            targets,
            kept,
        })
    }
}

/// The places of the columns that are to be kept: by the text in the first line, or by the name without its unit.
fn kept(
    keep: &[String],
    sheet: &Sheet<'_>,
    names: &[Stated<String>],
    faults: &mut Vec<Fault>,
) -> Vec<usize> {
    let heads: Vec<&str> = sheet.header().fields().collect();
    let mut kept = Vec::new();
    for wanted in keep {
        let whole = heads.iter().position(|head| head == wanted);
        let found = whole.or_else(|| names.iter().position(|name| name.value == *wanted));
        match found {
            Some(at) if kept.contains(&at) => {}
            Some(at) => kept.push(at),
            None => {
                let message = say!("the table has no column \"{wanted}\" that could be kept");
                let fault =
                    Fault::new(NO_COLUMN, sheet.header_place(), message).label(say!("the columns"));
                faults.push(match nearest(wanted, heads.iter().copied()) {
                    Some(near) => fault.help(say!("did you mean \"{near}\"?")),
                    None => fault.help(say!("write its name as the first line has it")),
                });
            }
        }
    }
    kept
}

/// Whether a column of results is called so, with or without its unit, under any settings: it would take the place of what is
/// kept.
fn names_a_result(name: &str, file: &DeTable<'_>) -> bool {
    /// What is said of a measurand, or of it and another name.
    const OF_ONE: [&str; 7] = ["u", "nu", "k", "U", "expanded", "lower", "upper"];
    const OF_MORE: [&str; 4] = ["share", "contribution", "verdict", "p_c"];
    let measurands = file
        .get("measurand")
        .and_then(|table| table.get_ref().as_table());
    let is_measurand = |name: &str| measurands.is_some_and(|table| table.contains_key(name));
    let called = name
        .split_once('(')
        .map(|(word, rest)| (word, rest.strip_suffix(')')));
    let is_called = |(word, inside): (&str, Option<&str>)| {
        let is_of_one = OF_ONE.contains(&word) && inside.is_some_and(is_measurand);
        is_of_one || OF_MORE.contains(&word)
    };
    ["label", "seed", "findings", "error"].contains(&name)
        || is_measurand(name)
        || called.is_some_and(is_called)
}

fn keeps_a_result(column: &Stated<String>) -> Fault {
    let name = &column.value;
    let message = say!("the results have a column \"{name}\" of their own");
    let fault = Fault::new(SAME_NAME, column.span.clone(), message).label(say!("to be kept"));
    fault.help(match name.as_str() {
        "label" => say!("the label is in the results without being kept"),
        _ => say!("give this column another name in the table, such as \"own {name}\""),
    })
}

/// A column of the user's own may go through to the results.
fn suggest_to_keep(fault: &mut Fault, column: &str) {
    if fault.code != UNKNOWN_NAME {
        return;
    }
    let bare = |c: char| c.is_alphanumeric() || "_.-".contains(c);
    let quote = if column.chars().all(bare) { "" } else { "\"" };
    let keep = say!(
        "a column that names the rows is called `label`; if it is a column of your own, `--keep {quote}{column}{quote}` carries it through to the results (in Python, `keep=[\"{column}\"]`)"
    );
    fault.help = Some(match fault.help.take() {
        Some(help) => say!("{help}\n{keep}"),
        None => keep,
    });
}

/// A budget and the columns that replace its values.
#[derive(Debug)]
pub struct Batch<'a> {
    of: &'a BatchFile<'a>,
    identity: PathBuf,
    name: String,
    file: DeTable<'a>,
    columns: Columns,
    targets: Vec<Option<Column>>,
    /// The columns that go through to the results, in the order in which they are asked for.
    kept: Vec<usize>,
}

/// Makes budgets of rows; each thread has its own, which keeps what the rows have in common.
#[derive(Debug)]
pub struct RowReader<'a> {
    batch: &'a Batch<'a>,
    open: OpenFiles<'a>,
}

impl Batch<'_> {
    /// Nothing is read yet.
    pub fn reader(&self) -> RowReader<'_> {
        RowReader {
            batch: self,
            open: open_files(self.of.files),
        }
    }

    /// The pattern into which rows that are numbers are written, as the first of them show it; `Some(None)` where the file has to
    /// be read with every row, nothing where too few rows tell.
    pub(crate) fn pattern<'r>(
        &self,
        rows: impl Iterator<Item = &'r csv::Row<'r>>,
        sheet: &Sheet<'_>,
    ) -> Option<Option<Pattern>> {
        /// Rows that are tried: some of them may be refused.
        const FEW: usize = 16;
        let reader = self.reader();
        // A row with more than numbers tells nothing of the others.
        let numbers = rows.filter(|row| self.numbers(row));
        let mut numbers = numbers.take(FEW);
        let first = numbers
            .by_ref()
            .find_map(|row| reader.pattern(row, sheet))?;
        let Some(pattern) = first else {
            return Some(None);
        };
        let second = numbers.find_map(|row| Some((row, reader.row(row, sheet).ok()?)));
        let (row, read) = second?;
        Some(Some(pattern).filter(|pattern| pattern.gives(&read.budget, row)))
    }

    /// A line at the end of columns whose numbers are the means of those above.
    pub(crate) fn mean_of(&self, columns: &csv::Columns<'_>, head: &Sheet<'_>) -> Option<Fault> {
        let sets = |at: usize| matches!(self.targets[at], Some(Column::Path(_)));
        csv::summary_of_columns(columns, head, sets)
    }

    /// The column of labels, where there is one.
    pub(crate) fn label(&self) -> Option<usize> {
        let is_label = |target: &Option<Column>| matches!(target, Some(Column::Label));
        self.targets.iter().position(is_label)
    }

    /// The columns that go through to the results.
    pub(crate) fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Whether all cells of a row but its label, and those that are only kept, are numbers, and none is zero.
    fn numbers(&self, row: &csv::Row<'_>) -> bool {
        let is_number = |(target, field): (&Option<Column>, &str)| {
            let number = || plain_number(field);
            matches!(target, Some(Column::Label | Column::Kept))
                || number().is_some_and(|number| number != 0.0)
        };
        self.targets.iter().zip(row.fields()).all(is_number)
    }
}

impl RowReader<'_> {
    /// The budget with the values of a row, read from the file.
    ///
    /// # Errors
    /// All faults; those of the row have no place in the budget.
    pub fn row(&self, row: &csv::Row<'_>, sheet: &Sheet<'_>) -> Result<Row, Rejection> {
        self.with(row, sheet, |table, text, label, faults| {
            self.read(table, text, label, faults)
        })
    }

    /// The pattern of a row, if it has one; nothing of a row that is refused.
    fn pattern(&self, row: &csv::Row<'_>, sheet: &Sheet<'_>) -> Option<Option<Pattern>> {
        self.with(row, sheet, |table, text, label, faults| {
            let found = self.read(table, text, label, faults).ok()?;
            let tables = tables(table, None, &mut Reader::new(text, &HINTS));
            let targets = &self.batch.targets;
            Some(Pattern::of(&found.budget, &tables, targets, row))
        })
    }

    /// What is made of the file with the values of a row: its table, its text, the label of the row, and faults.
    fn with<R>(
        &self,
        row: &csv::Row<'_>,
        sheet: &Sheet<'_>,
        make: impl FnOnce(&DeTable<'_>, &str, Option<String>, Vec<Fault>) -> R,
    ) -> R {
        let Batch {
            file,
            columns,
            targets,
            ..
        } = self.batch;
        let written = columns.written(row, sheet);
        // The cells stand behind the budget, where all of their decimals are found.
        let mut text = self.batch.of.text.clone();
        let mut cells = Vec::with_capacity(written.len());
        for field in &written {
            text.push('\n');
            let start = text.len();
            text.push_str(field.text());
            cells.push(field.cell(&|part: Range<usize>| start + part.start..start + part.end));
        }
        let names = &columns.names;
        let fields = targets.iter().zip(names).zip(&cells).zip(row.fields());
        let overloads = fields.filter_map(|(((target, name), (cell, _)), field)| {
            let sets = matches!(target, Some(Column::Path(_)));
            sets.then(|| csv::overload(&name.value, row.line, field, cell.span.clone()))?
        });
        let mut faults: Vec<Fault> = overloads.collect();
        let variant = series::variant(file, names, targets, &cells, &mut faults);
        make(&variant.table, &text, variant.label, faults)
    }

    /// The budget as it stands, without a row.
    ///
    /// # Errors
    /// All its faults.
    pub fn alone(&self) -> Result<Row, Rejection> {
        self.read(&self.batch.file, &self.batch.of.text, None, Vec::new())
    }

    fn read(
        &self,
        table: &DeTable<'_>,
        text: &str,
        label: Option<String>,
        mut faults: Vec<Fault>,
    ) -> Result<Row, Rejection> {
        let BatchFile { profile, .. } = self.batch.of;
        let mut reader = Reader::new(text, &HINTS);
        let file = tables(table, *profile, &mut reader);
        faults.append(&mut reader.faults);
        let variant = Variant {
            label,
            place: None,
            repetitions: false,
            file,
            faults,
        };
        let origin = Origin {
            files: &self.open,
            directory: self.batch.of.directory(),
            file: &self.batch.identity,
        };
        let place = (self.batch.name.as_str(), text);
        let mut loaded = checked(std::iter::once(variant), Vec::new(), place, origin)?;
        Ok(loaded.rows.swap_remove(0))
    }
}
