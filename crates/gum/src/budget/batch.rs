//! A budget for every row of a table beside it: what a series says within the budget. Rows are read one by one, so that a
//! faulty one is its own affair and the length of the table does not matter.

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml::de::DeTable;

use super::check::{Origin, Variant};
use super::faults::SERIES;
use super::open_files::OpenFiles;
use super::pattern::Pattern;
use super::points::{Columns, plain_number};
use super::reader::{checked, open_files, read_under, tables, text_of};
use super::rows::Rows;
use super::series::{self, Column};
use super::{Budget, Files, Profile, Row, hints::HINTS};
use gumption_fault::{Fault, Rejection, say};
use gumption_format::csv::{self, Sheet};
use gumption_format::toml::{Reader, leaves_the_rest, syntax_faults};

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

    fn directory(&self) -> &Path {
        self.path.parent().unwrap_or_else(|| Path::new(""))
    }

    /// The places that the columns of a table set; `table` is its name, for messages.
    ///
    /// # Errors
    /// The budget is no TOML, or has a series of its own; a column is none of its places.
    pub fn batch(&self, sheet: &Sheet<'_>, table: &str) -> Result<Batch<'_>, Rejection> {
        let (file, errors) = DeTable::parse_recoverable(&self.text);
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
        let place = |at| sheet.place(sheet.header(), at);
        let columns = Columns::of(sheet, place).map_err(in_table)?;
        let mut faults = Vec::new();
        let targets = series::targets(&file, &columns.names, &mut faults);
        // Their other places are in the budget.
        faults.iter_mut().for_each(|fault| fault.related.clear());
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
        })
    }
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
}

/// Makes budgets of rows; each thread has its own, which keeps what the rows have in common.
#[derive(Debug)]
pub struct RowReader<'a> {
    batch: &'a Batch<'a>,
    open: OpenFiles<'a>,
    rest: Rest,
}

/// What is known of the rows that follow.
#[derive(Debug)]
enum Rest {
    /// Nothing yet.
    Unknown,
    /// Whether this pattern gives the next row, too, is to be seen.
    Likely(Box<Pattern>),
    /// They are numbers in this pattern.
    Numbers(Box<Pattern>),
    /// The file has to be read with each of them.
    Read,
}

impl Batch<'_> {
    /// Nothing is read yet.
    pub fn reader(&self) -> RowReader<'_> {
        RowReader {
            batch: self,
            open: open_files(self.of.files),
            rest: Rest::Unknown,
        }
    }

    /// Whether all cells of a row but its label are numbers, and none is zero.
    fn numbers(&self, row: &csv::Row, sheet: &Sheet<'_>) -> bool {
        let is_number = |(target, field): (&Option<Column>, &str)| {
            let number = || plain_number(field, sheet);
            matches!(target, Some(Column::Label)) || number().is_some_and(|number| number != 0.0)
        };
        self.targets.iter().zip(row.fields()).all(is_number)
    }
}

impl RowReader<'_> {
    /// Whether the row gives a budget without the file being read with it: [`RowReader::numbers`].
    pub fn takes(&mut self, row: &csv::Row, sheet: &Sheet<'_>) -> bool {
        match &mut self.rest {
            Rest::Numbers(pattern) => pattern.take(row, sheet),
            Rest::Unknown | Rest::Likely(_) | Rest::Read => false,
        }
    }

    /// Whether it is settled that the numbers of rows are written into a budget.
    pub fn takes_numbers(&self) -> bool {
        matches!(self.rest, Rest::Numbers(_))
    }

    /// Writes the numbers of the row that was taken last into a row of a block.
    pub(crate) fn write(&self, lane: usize, rows: &mut Rows) {
        if let Rest::Numbers(pattern) = &self.rest {
            pattern.write(lane, rows);
        }
    }

    /// The budget of the row that was taken last; its words (how u was obtained, remarks) are those of another row.
    pub fn numbers(&self) -> Option<&Budget> {
        match &self.rest {
            Rest::Numbers(pattern) => Some(pattern.budget()),
            Rest::Unknown | Rest::Likely(_) | Rest::Read => None,
        }
    }

    /// The budget with the values of a row, read from the file.
    ///
    /// # Errors
    /// All faults; those of the row have no place in the budget.
    pub fn row(&mut self, row: &csv::Row, sheet: &Sheet<'_>) -> Result<Row, Rejection> {
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
        let mut faults = Vec::new();
        let names = &columns.names;
        let variant = series::variant(file, names, targets, &cells, &mut faults);
        let found = self.read(&variant.table, &text, variant.label, faults)?;
        self.rest = match std::mem::replace(&mut self.rest, Rest::Read) {
            // A row with more than numbers tells nothing of the others.
            rest @ (Rest::Unknown | Rest::Likely(_)) if !self.batch.numbers(row, sheet) => rest,
            Rest::Unknown => {
                let tables = tables(&variant.table, None, &mut Reader::new(&text, &HINTS));
                let pattern = Pattern::of(&found.budget, &tables, targets, (row, sheet));
                pattern.map_or(Rest::Read, |pattern| Rest::Likely(Box::new(pattern)))
            }
            Rest::Likely(mut pattern) => match pattern.gives(&found.budget, row, sheet) {
                true => Rest::Numbers(pattern),
                false => Rest::Read,
            },
            settled => settled,
        };
        Ok(found)
    }

    /// The label of a row as the table writes it, where it has such a column: 007 is no number.
    pub fn label<'r>(&self, row: &'r csv::Row) -> Option<&'r str> {
        let is_label = |target: &Option<Column>| matches!(target, Some(Column::Label));
        let at = self.batch.targets.iter().position(is_label)?;
        row.fields().nth(at).filter(|field| !field.is_empty())
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
            repetitions: false,
            file,
        };
        let origin = Origin {
            files: &self.open,
            directory: self.batch.of.directory(),
            file: &self.batch.identity,
        };
        let place = (self.batch.name.as_str(), text);
        let mut loaded = checked(vec![variant], [Vec::new(), faults], place, origin)?;
        Ok(loaded.rows.swap_remove(0))
    }
}
