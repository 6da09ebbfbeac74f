//! The results of a batch, row by row, as lines of a table or as columns.

mod shape;
mod values;

use super::rows::{Cell, Head};
use super::{Report, decisions, remarks, rows};
use gumption_fault::language::Language;
use gumption_fault::{Fault, Rejection};
use gumption_gum::batch::{BLOCK, Evaluated, Failed, Found, Lot, Several};
use gumption_gum::budget::{BatchFile, Budget};
use gumption_gum::propagate::{RowFigures, Verdict};
use shape::{Shapes, misfit, nothing};
use std::borrow::Cow;
use values::Given;

pub use shape::{Columns, Count};
pub use values::{ResultColumn, Results, Values};

/// Lines of some rows, made by whoever evaluated them.
#[derive(Debug, Default)]
pub struct Lines {
    /// The columns that rows have.
    shapes: Shapes,
    /// The heads of what is kept.
    kept: Option<Vec<String>>,
    /// The lines of those that have results, the labels of the others with what is kept of them.
    text: Vec<u8>,
    lines: Vec<Line>,
}

#[derive(Debug)]
struct Line {
    /// Where its label ends in the text with what is kept of it, and where the line does.
    label: usize,
    end: usize,
    /// Which columns it has; or why there are none.
    shape: Result<usize, String>,
    rejected: bool,
}

/// What a line has behind its label.
pub(super) struct Figures {
    /// Of all columns.
    pub heads: Vec<Head>,
    /// The numbers.
    pub numbers: Vec<Option<f64>>,
    /// Codes of what is doubtful in them.
    pub findings: String,
}

impl Lines {
    /// Adds the line of a row of numbers behind its label, and codes of what is doubtful in them behind those; or why there are none.
    pub(super) fn push(&mut self, label: &str, found: Result<Figures, String>) {
        push_field(&mut self.text, label);
        let label = self.text.len();
        let shape = found.map(
            |Figures {
                 heads,
                 numbers,
                 findings,
             }| {
                for number in &numbers {
                    self.text.push(b',');
                    Cell::Number(*number).push(&mut self.text);
                }
                self.text.push(b',');
                Cell::Text(&findings).push(&mut self.text);
                // There is no error.
                self.text.extend_from_slice(b",\n");
                self.shapes.of_heads(heads)
            },
        );
        self.lines.push(Line {
            label,
            end: self.text.len(),
            shape,
            rejected: false,
        });
    }
}

impl Columns {
    /// Adds the line of each row: label or number, what is kept of it, then as [`super::rows`], the shares, the contributions, the seed of the trials,
    /// the findings, and the error of a row that has no result.
    pub fn add(self, lines: &mut Lines, rows: &Lot<'_>) {
        match rows {
            Lot::One(row) => {
                let shape = row.found.as_ref().ok();
                let shape = shape.map(|(budget, _)| lines.shapes.of_budget(self, budget));
                self.add_line(lines, row, shape.unwrap_or_default());
            }
            Lot::Several(rows) => {
                let shape = lines.shapes.of_budget(self, rows.budget);
                rows.each(|row| self.add_line(lines, row, shape));
            }
        }
    }

    fn add_line(self, lines: &mut Lines, row: &Evaluated<'_>, shape: usize) {
        let text = &mut lines.text;
        match row.label {
            Some(label) => push_field(text, label),
            None => Cell::Seed(Some(row.number)).push(text),
        }
        let (heads, kept) = row.kept;
        lines.kept.get_or_insert_with(|| heads.to_vec());
        for field in kept {
            text.push(b',');
            push_field(text, field);
        }
        let label = text.len();
        let mut rejected = false;
        let shape = match &row.found {
            Ok((budget, found)) => {
                rejected = self.cells(budget, found, |cell| {
                    text.push(b',');
                    cell.push(text);
                });
                text.push(b'\n');
                Ok(shape)
            }
            Err(failed) => Err(why(failed, self.language)),
        };
        if lines.lines.is_empty() {
            // The others are about as long.
            text.reserve(BLOCK * text.len());
        }
        lines.lines.push(Line {
            label,
            end: text.len(),
            shape,
            rejected,
        });
    }

    /// Adds the values of rows: as [`Columns::add`], but for the label of a row that has none.
    pub fn add_values(self, values: &mut Values, rows: &Lot<'_>) {
        match rows {
            Lot::One(row) => self.add_row(values, row),
            Lot::Several(rows) => self.add_rows(values, rows),
        }
    }

    /// Adds the values of rows that stand one after the other, column by column.
    fn add_rows(self, values: &mut Values, rows: &Several<'_>) {
        let Several {
            budget, figures, ..
        } = rows;
        let shape = values.shapes.of_budget(self, budget);
        values.keep_all(rows);
        let measurands = 0..budget.model.outputs().len();
        let numbers = measurands.clone().flat_map(|one| {
            let of = figures.columns(one);
            let [lower, upper] = of.ends.map(Some);
            let found = [of.estimate, of.u, of.dof, of.k, of.expanded].map(Some);
            found.into_iter().chain([lower, upper])
        });
        let mut columns: Vec<Given<'_>> = numbers.map(Given::Numbers).collect();
        if self.shares {
            let shares = measurands.clone().flat_map(|one| figures.shares(one));
            columns.extend(shares.map(Given::Made));
        }
        if self.contributions {
            let all = measurands.clone();
            let all = all.flat_map(|one| figures.contributions(one));
            columns.extend(all.map(|one| Given::Numbers(Some(one))));
        }
        columns.extend(self.seeds.then_some(Given::Numbers(None)));
        let few = measurands.clone().any(|one| figures.have_few_degrees(one))
            || !budget.remarks.is_empty();
        let findings = few.then(|| {
            let of_row = |row: RowFigures<'_>| few_degrees(budget, &row);
            figures.rows().map(of_row).collect()
        });
        columns.push(Given::Texts(findings));
        // There are no errors.
        columns.push(Given::Texts(None));
        let labels = rows.labels().map(|all| all.map(Cow::into_owned).collect());
        columns.insert(0, Given::Texts(labels));
        values.add_columns(shape, figures.count(), columns);
    }

    fn add_row(self, values: &mut Values, row: &Evaluated<'_>) {
        let label = Cell::Text(row.label.unwrap_or_default());
        values.keep(row.kept);
        match &row.found {
            Ok((budget, found)) => {
                let shape = values.shapes.of_budget(self, budget);
                values.add(Some(shape), |give| {
                    give(label);
                    self.cells(budget, found, give)
                });
            }
            Err(failed) => values.add_failed(label, &why(failed, self.language)),
        }
    }

    /// Gives the cells behind the label; tells whether an item does not conform.
    fn cells(self, budget: &Budget, found: &Found<'_>, mut give: impl FnMut(Cell<'_>)) -> bool {
        let number = |x: f64| Cell::Number(Some(x));
        match found {
            Found::Figures(row) => {
                let measurands = 0..budget.model.outputs().len();
                for measurand in measurands.clone() {
                    rows::figures(&row.figures(measurand), &mut give);
                }
                if self.shares {
                    let shares = measurands.clone().flat_map(|one| row.shares(one));
                    shares.for_each(|one| give(number(one)));
                }
                if self.contributions {
                    let all = measurands.clone().flat_map(|one| row.contributions(one));
                    all.for_each(|one| give(number(one)));
                }
                if self.seeds {
                    give(Cell::Seed(None));
                }
                give(Cell::Text(&few_degrees(budget, row)));
                give(Cell::Text(""));
                false
            }
            Found::Evaluation(evaluation) => {
                let report = Report {
                    budget,
                    evaluation,
                    label: None,
                    language: self.language,
                };
                rows::cells(&report, &mut give);
                if self.shares {
                    let lines = evaluation.results.iter();
                    let lines = lines.flat_map(|result| &result.gum.inputs);
                    lines.for_each(|line| give(number(line.share)));
                }
                if self.contributions {
                    let lines = evaluation.results.iter();
                    let lines = lines.flat_map(|result| &result.gum.components);
                    lines.for_each(|line| give(number(line.contribution)));
                }
                if self.seeds {
                    give(Cell::Seed(evaluation.run.as_ref().map(|run| run.seed)));
                }
                let findings = evaluation.findings.iter();
                let findings = findings.map(|one| (remarks::code(&one.kind), one.measurand));
                // Beside a result that looks like any other nobody asks for its threshold.
                let asked = budget.detection.iter().zip(&evaluation.detection);
                let unseen = asked.filter(|(_, found)| found.recognised() == Some(false));
                let unseen =
                    unseen.map(|(asked, _)| (decisions::NOT_RECOGNISED, Some(asked.measurand)));
                give(Cell::Text(&codes(budget, findings.chain(unseen))));
                give(Cell::Text(""));
                let refuses = |verdict| verdict == Some(Verdict::NotConforming);
                let mut conformity = evaluation.conformity.iter();
                conformity.any(|found| refuses(found.verdict))
            }
        }
    }
}

/// Adds a field, in quotes where it has to be.
fn push_field(text: &mut Vec<u8>, field: &str) {
    match field.contains([',', '"', '\n', '\r']) {
        true => {
            text.push(b'"');
            text.extend(field.replace('"', "\"\"").bytes());
            text.push(b'"');
        }
        false => text.extend(field.bytes()),
    }
}

/// Adds a line of fields.
fn push_line(text: &mut Vec<u8>, fields: impl IntoIterator<Item = String>) {
    for (at, field) in fields.into_iter().enumerate() {
        text.extend((at > 0).then_some(b','));
        push_field(text, &field);
    }
    text.push(b'\n');
}

/// The codes of findings and of remarks; behind each the measurand that it is about, where there are several.
fn codes<'c>(budget: &Budget, findings: impl Iterator<Item = (&'c str, Option<usize>)>) -> String {
    let outputs = budget.model.outputs();
    let mut codes = String::new();
    let remark = (!budget.remarks.is_empty()).then_some((remarks::REMARK, None));
    for (code, measurand) in findings.chain(remark) {
        let space = if codes.is_empty() { "" } else { " " };
        codes.extend([space, code]);
        if let Some(measurand) = measurand.filter(|_| outputs.len() > 1) {
            codes.extend(["(", &outputs[measurand].name, ")"]);
        }
    }
    codes
}

/// The codes of the findings of a row of which there are no others.
fn few_degrees(budget: &Budget, row: &RowFigures<'_>) -> String {
    let few = |one| Some((remarks::code(&row.few_degrees(one)?), Some(one)));
    codes(budget, (0..budget.model.outputs().len()).filter_map(few))
}

fn why(failed: &Failed, language: Language) -> String {
    match failed {
        Failed::Row(fault) => described(fault, language),
        Failed::Refused(rejection) => refused(rejection, language),
        Failed::NoResult(error) => error.said().in_language(language),
    }
}

/// All faults of a file and of those that it uses, in one line.
pub(super) fn refused(rejection: &Rejection, language: Language) -> String {
    let Rejection { faults, others, .. } = rejection;
    let others = others.iter().flat_map(|other| &other.faults);
    let all = faults.iter().chain(others);
    let all: Vec<String> = all.map(|fault| described(fault, language)).collect();
    all.join("; ")
}

/// A fault in one line, with its code.
fn described(fault: &Fault, language: Language) -> String {
    let message = fault.message.in_language(language);
    let help = fault.help.as_ref().map(|help| help.in_language(language));
    let help = help.map_or(String::new(), |help| format!(" ({help})"));
    format!("{}: {message}{help}", fault.code.id).replace('\n', " ")
}

/// The table of a batch, which grows by lines; nothing of it is kept but what the first line needs.
#[derive(Debug, Default)]
pub struct Table {
    /// In which it is said why a row has no place.
    language: Language,
    heads: Option<Vec<Head>>,
    kept: Option<Vec<String>>,
    /// Whether they are written.
    headed: bool,
    /// Rows without a result, as long as no row has told what the columns are.
    waiting: Vec<Lines>,
    count: Count,
}

impl Table {
    /// Nothing is in it yet. Its columns are those of the budget where that is whole without a row, else those of the first row
    /// that has a result.
    pub fn of(columns: Columns, file: &BatchFile<'_>) -> Table {
        Table {
            heads: file.alone().map(|budget| columns.heads(&budget)),
            ..Table::new(columns.language)
        }
    }

    /// Nothing is in it yet. Its columns are those of the first row that has a result.
    pub fn new(language: Language) -> Table {
        Table {
            language,
            ..Table::default()
        }
    }

    /// The bytes that these lines add, as comma-separated values.
    pub fn add(&mut self, mut lines: Lines) -> Vec<u8> {
        self.heads = self.heads.take().or_else(|| lines.shapes.first());
        self.kept = self.kept.take().or(lines.kept.take());
        let Some(heads) = &self.heads else {
            self.waiting.push(lines);
            return Vec::new();
        };
        let fits = lines.shapes.fits(heads);
        let is_good = |line: &Line| line.shape.as_ref().is_ok_and(|shape| fits[*shape]);
        if self.headed && lines.lines.iter().all(is_good) {
            self.count.rows += lines.lines.len() as u64;
            let rejected = lines.lines.iter().filter(|line| line.rejected);
            self.count.rejected += rejected.count() as u64;
            return lines.text;
        }
        let mut text = Vec::with_capacity(lines.text.len());
        if !self.headed {
            let (label, others) = heads.split_at(1);
            let name = |head: &'_ Head| head.name.clone();
            let kept = self.kept.iter().flatten().cloned();
            let names = label.iter().map(name).chain(kept);
            push_line(&mut text, names.chain(others.iter().map(name)));
            self.headed = true;
        }
        let waiting = std::mem::take(&mut self.waiting);
        for lines in waiting.into_iter().chain([lines]) {
            let fits = lines.shapes.fits(heads);
            let mut start = 0;
            for line in lines.lines {
                let (label, whole) = (&lines.text[start..line.label], &lines.text[start..line.end]);
                start = line.end;
                self.count.rows += 1;
                self.count.rejected += u64::from(line.rejected);
                let why = match line.shape {
                    Ok(shape) if fits[shape] => {
                        text.extend_from_slice(whole);
                        continue;
                    }
                    Ok(shape) => misfit(lines.shapes.heads(shape), heads, self.language),
                    Err(why) => why,
                };
                self.count.failed += 1;
                text.extend_from_slice(label);
                text.extend(std::iter::repeat_n(b',', heads.len().saturating_sub(1)));
                push_field(&mut text, &why);
                text.push(b'\n');
            }
        }
        text
    }

    /// These columns are kept, also where no row says so.
    pub fn keep(&mut self, heads: Vec<String>) {
        self.kept.get_or_insert(heads);
    }

    /// What is left where no row has a result, and how the rows have ended.
    pub fn end(mut self) -> (Vec<u8>, Count) {
        if self.headed {
            return (Vec::new(), self.count);
        }
        let head = Lines {
            shapes: Shapes::from(nothing()),
            ..Lines::default()
        };
        (self.add(head), self.count)
    }
}
