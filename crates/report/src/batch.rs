//! The results of a batch as lines of a table, row by row.

use std::io::Write;

use super::rows::Cell;
use super::{Report, failure, remarks, rows};
use gumption_core::model::Output;
use gumption_fault::language::Language;
use gumption_fault::{Fault, Rejection};
use gumption_gum::batch::{Evaluated, Failed, Found};
use gumption_gum::budget::{BatchFile, Budget};
use gumption_gum::propagate::{Figures, FindingKind, RowFigures, Verdict};

/// What the lines hold beside what is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    /// The share of each input in u²(y).
    pub shares: bool,
    /// The seeds of the trials.
    pub seeds: bool,
    /// The language in which errors are told.
    pub language: Language,
}

/// Lines of some rows, made by whoever evaluated them.
#[derive(Debug, Default)]
pub struct Lines {
    /// The names of the columns, where a row has told them.
    heads: Option<Vec<String>>,
    /// The text of those that have results.
    text: Vec<u8>,
    lines: Vec<Line>,
}

#[derive(Debug)]
struct Line {
    label: String,
    /// Where the text of its results ends, and how many cells they are; or why there are none.
    cells: Result<(usize, usize), String>,
    rejected: bool,
}

impl Columns {
    /// Adds the line of a row: label or number, then as [`super::rows`], the shares, the seed of the trials, the findings,
    /// and the error of a row that has no result.
    pub fn add(self, lines: &mut Lines, row: &Evaluated<'_>) {
        let label = row
            .label
            .map_or_else(|| row.number.to_string(), str::to_owned);
        let (cells, rejected) = match &row.found {
            Ok((budget, found)) => {
                lines.heads.get_or_insert_with(|| self.heads(budget));
                push_field(&mut lines.text, &label);
                let (cells, rejected) = match found {
                    Found::Figures(figures) => {
                        let cells = self.figures(budget, figures, &mut lines.text);
                        (cells, false)
                    }
                    Found::Evaluation(evaluation) => {
                        let report = Report {
                            budget,
                            evaluation,
                            label: None,
                            language: self.language,
                        };
                        let refuses = |verdict| verdict == Some(Verdict::NotConforming);
                        let mut conformity = evaluation.conformity.iter();
                        let rejected = conformity.any(|found| refuses(found.verdict));
                        (self.cells(&report, &mut lines.text), rejected)
                    }
                };
                lines.text.push(b'\n');
                (Ok((lines.text.len(), cells)), rejected)
            }
            Err(failed) => (Err(why(failed, self.language)), false),
        };
        lines.lines.push(Line {
            label,
            cells,
            rejected,
        });
    }

    /// The names of the columns that rows of this budget have.
    fn heads(self, budget: &Budget) -> Vec<String> {
        let mut heads = rows::heads(budget);
        if self.shares {
            let share = |output: &Output| {
                let name = output.name.clone();
                let inputs = budget.inputs.iter();
                inputs.map(move |input| format!("share({name}, {})", input.name))
            };
            heads.extend(budget.model.outputs().iter().flat_map(share));
        }
        heads.extend(self.seeds.then(|| "seed".into()));
        heads.extend(["findings".into(), "error".into()]);
        heads
    }

    /// As [`Columns::cells`], of a row with nothing but figures.
    fn figures(self, budget: &Budget, row: &RowFigures, text: &mut Vec<u8>) -> usize {
        let mut count = 1;
        let mut add = |cell: &dyn std::fmt::Display| {
            count += 1;
            // Writing to memory does not fail.
            let _ = write!(text, ",{cell}");
        };
        let measurands = &row.measurands;
        for (figures, _) in measurands {
            rows::figures(figures, |cell| add(&cell));
        }
        if self.shares {
            let shares = row.shares.iter().flatten();
            shares.for_each(|share| add(&Cell::Number(Some(*share))));
        }
        if self.seeds {
            add(&"");
        }
        let few = |(measurand, (_, few)): (usize, &(Figures, Option<FindingKind>))| {
            let code = remarks::code(few.as_ref()?);
            Some(match measurands.len() {
                1 => code.to_string(),
                _ => format!("{code}({})", budget.model.outputs()[measurand].name),
            })
        };
        let codes: Vec<String> = measurands.iter().enumerate().filter_map(few).collect();
        add(&codes.join(" "));
        add(&"");
        count
    }

    /// Writes the cells behind the label; tells how many the line has with it.
    fn cells(self, report: &Report<'_>, text: &mut Vec<u8>) -> usize {
        let mut count = 1;
        let mut add = |cell: &dyn std::fmt::Display| {
            count += 1;
            // Writing to memory does not fail.
            let _ = write!(text, ",{cell}");
        };
        rows::cells(report, |cell| add(&cell));
        if self.shares {
            let lines = report.evaluation.results.iter();
            let lines = lines.flat_map(|result| &result.gum.inputs);
            lines.for_each(|line| add(&Cell::Number(Some(line.share))));
        }
        if self.seeds {
            match &report.evaluation.run {
                Some(run) => add(&run.seed),
                None => add(&""),
            }
        }
        add(&findings(report));
        add(&"");
        count
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
fn push_line<'f>(text: &mut Vec<u8>, fields: impl IntoIterator<Item = &'f str>) {
    for (at, field) in fields.into_iter().enumerate() {
        text.extend((at > 0).then_some(b','));
        push_field(text, field);
    }
    text.push(b'\n');
}

/// The codes of the findings; behind each the measurand that it is about, where there are several.
fn findings(report: &Report<'_>) -> String {
    let several = report.evaluation.results.len() > 1;
    let code = |found: &gumption_gum::propagate::Finding| {
        let code = remarks::code(&found.kind);
        match found.measurand.filter(|_| several) {
            Some(measurand) => format!("{code}({})", report.measurand(measurand).0),
            None => code.to_string(),
        }
    };
    let codes: Vec<String> = report.evaluation.findings.iter().map(code).collect();
    codes.join(" ")
}

fn why(failed: &Failed, language: Language) -> String {
    match failed {
        Failed::Row(fault) => described(fault, language),
        Failed::Refused(rejection) => {
            let Rejection { faults, others, .. } = &**rejection;
            let all = faults
                .iter()
                .chain(others.iter().flat_map(|other| &other.faults));
            let all: Vec<String> = all.map(|fault| described(fault, language)).collect();
            all.join("; ")
        }
        Failed::NoResult(error) => failure(error, language),
    }
}

fn described(fault: &Fault, language: Language) -> String {
    let message = fault.message.in_language(language);
    let help = fault.help.as_ref().map(|help| help.in_language(language));
    let help = help.map_or(String::new(), |help| format!(" ({help})"));
    format!("{}: {message}{help}", fault.code.id).replace('\n', " ")
}

/// The table of a batch, which grows by lines; nothing of it is kept but what the first line needs.
#[derive(Debug, Default)]
pub struct Table {
    heads: Option<Vec<String>>,
    /// Whether they are written.
    headed: bool,
    /// Rows without a result, as long as no row has told what the columns are.
    waiting: Vec<Line>,
    count: Count,
}

/// How the rows of a batch have ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Count {
    /// All of them.
    pub rows: u64,
    /// Those without a result.
    pub failed: u64,
    /// Those whose item does not conform.
    pub rejected: u64,
}

impl Table {
    /// Nothing is in it yet. Its columns are those of the budget where that is whole without a row, else those of the first row
    /// that has a result.
    pub fn of(columns: Columns, file: &BatchFile<'_>) -> Table {
        Table {
            heads: file.alone().map(|budget| columns.heads(&budget)),
            ..Table::default()
        }
    }

    /// The bytes that these lines add, as comma-separated values.
    pub fn add(&mut self, lines: Lines) -> Vec<u8> {
        self.heads = self.heads.take().or(lines.heads);
        let Some(heads) = &self.heads else {
            self.waiting.extend(lines.lines);
            return Vec::new();
        };
        let mut text = Vec::with_capacity(lines.text.len());
        if !self.headed {
            push_line(&mut text, heads.iter().map(String::as_str));
            self.headed = true;
        }
        let mut start = 0;
        let waiting = std::mem::take(&mut self.waiting).into_iter();
        for line in waiting.chain(lines.lines) {
            self.count.rows += 1;
            self.count.rejected += u64::from(line.rejected);
            let why = match line.cells {
                Ok((end, cells)) => {
                    let found = lines.text.get(start..end).unwrap_or_default();
                    start = end;
                    if cells == heads.len() {
                        text.extend(found);
                        continue;
                    }
                    // A vector of another length, or an assessment more.
                    format!("{cells} figures where the first row has {}", heads.len())
                }
                Err(why) => why,
            };
            self.count.failed += 1;
            let empty = std::iter::repeat_n("", heads.len().saturating_sub(2));
            let fields = std::iter::once(line.label.as_str()).chain(empty);
            push_line(&mut text, fields.chain([why.as_str()]));
        }
        text
    }

    /// What is left where no row has a result, and how the rows have ended.
    pub fn end(mut self) -> (Vec<u8>, Count) {
        if self.headed {
            return (Vec::new(), self.count);
        }
        let nothing = Lines {
            heads: Some(vec!["label".into(), "error".into()]),
            ..Lines::default()
        };
        (self.add(nothing), self.count)
    }
}
