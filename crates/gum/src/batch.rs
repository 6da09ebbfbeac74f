//! One budget for many devices: every row of a table gives it values, and gets a result of its own.
//!
//! A row is evaluated as the budget would be with the row written into it by hand. Rows share nothing but the work of
//! reading: not their faults, not the random numbers, and no result depends on how the table is cut, on other rows or on the
//! number of threads.

use std::io::Read;
use std::ops::ControlFlow;

use crate::budget::{Batch, BatchFile, Budget, MonteCarloSettings, RowReader, Rows, Wanted};
use crate::propagate::{
    self, Evaluation, EvaluationError, MonteCarloChoice, Options, Progress, RowEvaluation,
    RowFigures, parallel_map,
};
use gumption_fault::say;
use gumption_fault::{Fault, Rejection};
use gumption_format::csv::faults::NO_HEADER;
use gumption_format::csv::{self, Pieces, Sheet};
use gumption_lanes::LANES;

/// Rows that a thread takes at a time: as many as are evaluated together.
const BLOCK: usize = LANES;

/// How the rows of a table are evaluated.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Monte Carlo with these settings in place of the budget's; nothing leaves it out.
    pub monte_carlo: Option<Wanted>,
    /// Threads that share the rows.
    pub threads: usize,
    /// Ends the work where it is stopped; counts trials.
    pub progress: Progress,
}

/// A row of the table, evaluated.
#[derive(Debug)]
pub struct Evaluated<'a> {
    /// Its number, the first being 1.
    pub number: u64,
    /// Its line in the table.
    pub line: usize,
    /// Its label, where the table has such a column.
    pub label: Option<&'a str>,
    /// Its budget, of which the numbers hold and not the words, and what was found; or why nothing was.
    pub found: Result<(&'a Budget, Found<'a>), &'a Failed>,
}

/// What was found of a row.
#[derive(Debug, Clone, Copy)]
pub enum Found<'a> {
    /// Everything.
    Evaluation(&'a Evaluation),
    /// What is reported, where there is no more to be said.
    Figures(&'a RowFigures),
}

/// Why a row has no result.
#[derive(Debug)]
pub enum Failed {
    /// The row itself is faulty.
    Row(Box<Fault>),
    /// The budget with the row in place has faults.
    Refused(Box<Rejection>),
    /// It has no value.
    NoResult(EvaluationError),
}

/// Evaluates the rows of a table, piece by piece. `add` makes of each row what is wanted of it, on any thread, and adds it to
/// that of the rows before it; `take` gets what some rows have given, in their order, with the number of bytes that were
/// read, and may end the work.
///
/// # Errors
/// The table cannot be read, one of its columns is no place of the budget, or the budget has faults of its own that no row
/// mends. Rows have been taken before, where the table cannot be read further.
pub fn run<T: Default + Send>(
    file: &BatchFile<'_>,
    (source, table): (impl Read, &str),
    plan: &Plan,
    add: impl Fn(&mut T, &Evaluated<'_>) + Sync,
    mut take: impl FnMut(T, u64) -> ControlFlow<()>,
) -> Result<(), Rejection> {
    let refused = |fault: Box<Fault>| Rejection::new(table, "", vec![*fault]);
    let mut pieces = Pieces::new(source);
    let none = || {
        Err(Box::new(Fault::new(
            NO_HEADER,
            0..0,
            say!("the table is empty"),
        )))
    };
    let first = pieces.next().unwrap_or_else(none).map_err(refused)?;
    let head = Sheet::new(&first.text)
        .map_err(|fault| Rejection::new(table, &first.text, vec![*fault]))?;
    let batch = file.batch(&head, table)?;
    let mut number = 0;
    let mut work = |sheet: &Sheet<'_>, read: u64| {
        let rows: Vec<Result<csv::Row, Fault>> = sheet.rows().collect();
        if number == 0 {
            hopeless(&batch, sheet, &rows)?;
        }
        let mut rest = rows.into_iter().peekable();
        let mut blocks = Vec::new();
        while rest.peek().is_some() {
            let rows: Vec<_> = rest.by_ref().take(BLOCK).collect();
            let begin = number;
            number += rows.len() as u64;
            blocks.push((begin, rows));
        }
        let block = |worker: &mut Worker<'_>, (begin, rows): (u64, Vec<_>)| {
            let mut block = T::default();
            worker.evaluate(sheet, (begin, rows), plan, |row| add(&mut block, row));
            block
        };
        let worker = || Worker::new(&batch);
        let (done, _) = parallel_map(blocks, plan.threads, worker, block, drop);
        let mut done = done.into_iter().map(|block| take(block, read));
        let ended = plan.progress.is_stopped() || done.any(|flow| flow.is_break());
        Ok::<bool, Rejection>(!ended)
    };
    let mut more = work(&head, pieces.bytes_read())?;
    while more {
        let Some(piece) = pieces.next() else { break };
        let piece = piece.map_err(refused)?;
        let read = pieces.bytes_read();
        more = work(&head.below(&piece.text, piece.line), read)?;
    }
    Ok(())
}

/// Whether the budget has faults that are there without any row and with each of the first.
fn hopeless(
    batch: &Batch<'_>,
    sheet: &Sheet<'_>,
    rows: &[Result<csv::Row, Fault>],
) -> Result<(), Rejection> {
    /// Rows that are tried.
    const FEW: usize = 16;
    let mut reader = batch.reader();
    let Err(mut own) = reader.alone() else {
        return Ok(());
    };
    let mut tried = 0;
    for row in rows.iter().flatten().take(FEW) {
        match reader.row(row, sheet) {
            Ok(_) => return Ok(()),
            Err(with_row) => own.faults.retain(|fault| with_row.faults.contains(fault)),
        }
        tried += 1;
    }
    match tried == 0 || own.faults.is_empty() {
        true => Ok(()),
        false => Err(own),
    }
}

/// Evaluates rows on one thread.
struct Worker<'b> {
    reader: RowReader<'b>,
    /// As soon as rows are numbers: blocks of them, where they can be evaluated so.
    blocks: Option<Option<(RowEvaluation, Rows)>>,
}

impl<'b> Worker<'b> {
    fn new(batch: &'b Batch<'b>) -> Self {
        Worker {
            reader: batch.reader(),
            blocks: None,
        }
    }

    /// Evaluates rows of a table, which begin behind so many others, and hands each on, in their order.
    fn evaluate(
        &mut self,
        sheet: &Sheet<'_>,
        (begin, rows): (u64, Vec<Result<csv::Row, Fault>>),
        plan: &Plan,
        mut hand_on: impl FnMut(&Evaluated<'_>),
    ) {
        let mut rest = rows.into_iter().zip(begin + 1..);
        while !self.is_ready(plan) {
            let Some((row, number)) = rest.next() else {
                return;
            };
            self.one(sheet, row, number, plan, &mut hand_on);
        }
        let rest: Vec<_> = rest.collect();
        let figures = self.figures(sheet, &rest);
        for ((row, number), figures) in rest.into_iter().zip(figures) {
            let known = self.blocks.as_ref().and_then(Option::as_ref);
            let (Ok(row), Some(((evaluation, _), figures))) = (&row, known.zip(figures.as_ref()))
            else {
                self.one(sheet, row, number, plan, &mut hand_on);
                continue;
            };
            hand_on(&Evaluated {
                number,
                line: row.line,
                label: self.reader.label(row),
                found: Ok((evaluation.budget(), Found::Figures(figures))),
            });
        }
    }

    /// Whether it is known how rows are to be evaluated.
    fn is_ready(&mut self, plan: &Plan) -> bool {
        if self.blocks.is_none() && self.reader.takes_numbers() {
            let budget = self.reader.numbers().filter(|_| plan.monte_carlo.is_none());
            let evaluation = |budget| Some((RowEvaluation::new(budget)?, Rows::of(budget)));
            self.blocks = Some(budget.and_then(evaluation));
        }
        self.blocks.is_some()
    }

    /// What is reported of those rows of a block that are numbers and need no more.
    fn figures(
        &mut self,
        sheet: &Sheet<'_>,
        rows: &[(Result<csv::Row, Fault>, u64)],
    ) -> Vec<Option<RowFigures>> {
        let Some(Some((evaluation, columns))) = &mut self.blocks else {
            return vec![None; rows.len()];
        };
        let mut taken = Vec::with_capacity(rows.len());
        for (lane, (row, _)) in rows.iter().enumerate() {
            let numbers = row.as_ref().is_ok_and(|row| self.reader.takes(row, sheet));
            if numbers {
                self.reader.write(lane, columns);
            }
            taken.push(numbers);
        }
        let mut found = evaluation.evaluate(columns, rows.len());
        for (found, taken) in found.iter_mut().zip(taken) {
            *found = found.take().filter(|_| taken);
        }
        found
    }

    /// Evaluates a row by itself and hands it on.
    fn one(
        &mut self,
        sheet: &Sheet<'_>,
        row: Result<csv::Row, Fault>,
        number: u64,
        plan: &Plan,
        hand_on: impl FnOnce(&Evaluated<'_>),
    ) {
        let row = match row {
            Ok(row) => row,
            Err(fault) => {
                return hand_on(&Evaluated {
                    number,
                    line: 0,
                    label: None,
                    found: Err(&Failed::Row(Box::new(fault))),
                });
            }
        };
        let reader = &mut self.reader;
        let (line, label) = (row.line, reader.label(&row));
        // Why a row has no value is told by the reader of the file.
        let taken = reader
            .takes(&row, sheet)
            .then(|| reader.numbers())
            .flatten();
        let taken = taken.and_then(|budget| Some((budget, result(budget, plan).ok()?)));
        if let Some((budget, evaluation)) = &taken {
            return hand_on(&Evaluated {
                number,
                line,
                label,
                found: Ok((budget, Found::Evaluation(evaluation))),
            });
        }
        let read = reader.row(&row, sheet);
        let read = read.map_err(|rejection| Failed::Refused(Box::new(rejection)));
        let found = read.and_then(|row| {
            let evaluation = result(&row.budget, plan).map_err(Failed::NoResult)?;
            Ok((row.budget, evaluation))
        });
        let found = match &found {
            Ok((budget, evaluation)) => Ok((budget, Found::Evaluation(evaluation))),
            Err(failed) => Err(failed),
        };
        hand_on(&Evaluated {
            number,
            line,
            label,
            found,
        });
    }
}

fn result(budget: &Budget, plan: &Plan) -> Result<Evaluation, EvaluationError> {
    propagate::evaluate(budget, &plan.options(budget))
}

impl Plan {
    /// A row is the work of one thread.
    fn options(&self, budget: &Budget) -> Options {
        let monte_carlo = match &self.monte_carlo {
            None => MonteCarloChoice::Off,
            Some(wanted) => {
                let settings = budget.monte_carlo.with(wanted);
                MonteCarloChoice::With(MonteCarloSettings {
                    seed: seed_of(budget, settings.seed),
                    ..settings
                })
            }
        };
        Options {
            monte_carlo,
            threads: 1,
            progress: self.progress.clone(),
        }
    }
}

/// The seed of a row: from the seed that was asked for and from the numbers of the row's budget, so that rows are independent
/// of one another, and each has the same wherever it stands. At most 2^53, which every spreadsheet keeps.
fn seed_of(budget: &Budget, seed: u64) -> u64 {
    let inputs = budget.inputs.iter().map(|input| input.estimate);
    let components = budget.components.iter().flat_map(|one| [one.u, one.dof]);
    let constants = budget
        .constants
        .iter()
        .flat_map(|one| one.values.iter().copied());
    let numbers = inputs.chain(components).chain(constants);
    let mixed = numbers.fold(mixed(seed), |sum, number| mixed(sum ^ number.to_bits()));
    mixed >> 11
}

/// The finalizer of SplitMix64 (Steele, Lea and Flood 2014): every bit of the result depends on all of them.
fn mixed(sum: u64) -> u64 {
    let sum = sum.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let sum = (sum ^ (sum >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let sum = (sum ^ (sum >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    sum ^ (sum >> 31)
}
