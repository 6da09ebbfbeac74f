//! The results of a batch as lines of a table, row by row.

use super::{Report, failure, remarks, rows};
use gumption_core::model::Output;
use gumption_fault::language::Language;
use gumption_fault::{Fault, Rejection};
use gumption_gum::batch::{Evaluated, Failed};
use gumption_gum::budget::{BatchFile, Budget};
use gumption_gum::propagate::Verdict;

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
#[derive(Debug)]
pub struct Lines {
    /// The names of the columns, where a row has told them.
    heads: Option<Vec<String>>,
    lines: Vec<Line>,
}

#[derive(Debug)]
struct Line {
    label: String,
    /// What follows the label; or why there is nothing.
    cells: Result<Vec<String>, String>,
    rejected: bool,
}

impl Columns {
    /// The lines of some rows: label or number, then as [`rows::rows`], the shares, the seed of the trials, the findings, and the
    /// error of a row that has no result.
    pub fn lines(self, rows: &[Evaluated]) -> Lines {
        let mut heads = None;
        let lines = rows.iter().map(|row| {
            let label = row.label.clone().unwrap_or_else(|| row.number.to_string());
            let mut rejected = false;
            let cells = match &row.found {
                Ok((budget, evaluation)) => {
                    let report = Report {
                        budget,
                        evaluation,
                        label: None,
                        language: self.language,
                    };
                    heads.get_or_insert_with(|| self.heads(budget));
                    let verdicts = evaluation.conformity.iter().map(|found| found.verdict);
                    rejected = verdicts
                        .into_iter()
                        .any(|v| v == Some(Verdict::NotConforming));
                    Ok(self.cells(&report))
                }
                Err(failed) => Err(why(failed, self.language)),
            };
            Line {
                label,
                cells,
                rejected,
            }
        });
        let lines = lines.collect();
        Lines { heads, lines }
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

    fn cells(self, report: &Report<'_>) -> Vec<String> {
        let mut cells = rows::cells(report);
        if self.shares {
            let lines = report.evaluation.results.iter();
            let lines = lines.flat_map(|result| &result.gum.inputs);
            cells.extend(lines.map(|line| rows::number(Some(line.share))));
        }
        if self.seeds {
            let run = report.evaluation.run.as_ref();
            cells.push(run.map_or_else(String::new, |run| run.seed.to_string()));
        }
        cells.extend([findings(report), String::new()]);
        cells
    }
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
    ///
    /// # Errors
    /// Only where the text cannot be put together, which memory alone could prevent.
    pub fn add(&mut self, lines: Lines) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        self.heads = self.heads.take().or(lines.heads);
        let Some(heads) = &self.heads else {
            self.waiting.extend(lines.lines);
            return Ok(Vec::new());
        };
        if !self.headed {
            writer.write_record(heads)?;
            self.headed = true;
        }
        for line in std::mem::take(&mut self.waiting)
            .into_iter()
            .chain(lines.lines)
        {
            self.count.rows += 1;
            self.count.rejected += u64::from(line.rejected);
            let cells = line
                .cells
                .and_then(|cells| match cells.len() == heads.len() {
                    true => Ok(cells),
                    // A vector of another length, or an assessment more.
                    false => Err(format!(
                        "{} figures where the first row has {}",
                        cells.len(),
                        heads.len()
                    )),
                });
            self.count.failed += u64::from(cells.is_err());
            let cells = cells.unwrap_or_else(|why| {
                let mut cells = vec![String::new(); heads.len()];
                if let Some(last) = cells.last_mut() {
                    *last = why;
                }
                cells
            });
            let cells = cells.iter().enumerate().map(|(at, cell)| match at {
                0 => &line.label,
                _ => cell,
            });
            writer.write_record(cells)?;
        }
        writer
            .into_inner()
            .map_err(|error| error.into_error().into())
    }

    /// What is left where no row has a result, and how the rows have ended.
    ///
    /// # Errors
    /// As of [`Table::add`].
    pub fn end(mut self) -> Result<(Vec<u8>, Count), csv::Error> {
        if self.headed {
            return Ok((Vec::new(), self.count));
        }
        let nothing = Lines {
            heads: Some(vec!["label".into(), "error".into()]),
            lines: Vec::new(),
        };
        Ok((self.add(nothing)?, self.count))
    }
}
