//! One budget for many devices: every row of a table gives it values, and gets a result of its own.
//!
//! A row is evaluated as the budget would be with the row written into it by hand. Rows share nothing but the work of
//! reading: not their faults, not the random numbers, and no result depends on how the table is cut, on other rows or on the
//! number of threads.

use std::io::Read;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

use crate::budget::{
    Batch, BatchFile, Budget, MonteCarloSettings, Numbers, Pattern, RowReader, Wanted,
};
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

impl<'a> Evaluated<'a> {
    fn at(
        (number, line, label): (u64, usize, Option<&'a str>),
        found: Result<(&'a Budget, Found<'a>), &'a Failed>,
    ) -> Self {
        Evaluated {
            number,
            line,
            label,
            found,
        }
    }
}

/// What was found of a row.
#[derive(Debug, Clone, Copy)]
pub enum Found<'a> {
    /// Everything.
    Evaluation(&'a Evaluation),
    /// What is reported, where there is no more to be said.
    Figures(RowFigures<'a>),
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
    let mut known = None;
    let mut spare = Vec::new();
    let mut number = 0;
    let mut work = |sheet: &Sheet<'_>, read: u64| {
        let rows: Vec<Result<csv::Row<'_>, Fault>> = sheet.rows().collect();
        if number == 0 {
            hopeless(&batch, sheet, &rows)?;
        }
        known = (known.take()).or_else(|| batch.pattern(rows.iter().flatten(), sheet));
        let pattern = known.as_ref().and_then(Option::as_ref);
        let parts = rows.chunks(BLOCK).zip((number..).step_by(BLOCK));
        let part = |worker: &mut Worker<'_>, (rows, begin): (&[_], u64)| {
            let mut part = T::default();
            worker.evaluate(sheet, (begin, rows), plan, |row| add(&mut part, row));
            part
        };
        // Whose room is left from the piece before takes it again.
        let rooms = Mutex::new(std::mem::take(&mut spare));
        let worker = || {
            let room = rooms.lock().unwrap_or_else(PoisonError::into_inner).pop();
            Worker {
                reader: batch.reader(),
                room: room.or_else(|| Some(Room::of(pattern?, plan))),
            }
        };
        let rest = |worker: Worker<'_>| worker.room;
        let (done, rooms) = parallel_map(parts.collect(), plan.threads, worker, part, rest);
        spare = rooms.into_iter().flatten().collect();
        number += rows.len() as u64;
        let mut done = done.into_iter().map(|part| take(part, read));
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
    rows: &[Result<csv::Row<'_>, Fault>],
) -> Result<(), Rejection> {
    /// Rows that are tried.
    const FEW: usize = 16;
    let reader = batch.reader();
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
    /// Where rows are numbers.
    room: Option<Room>,
}

/// Rows that are numbers, and what evaluates them.
struct Room {
    pattern: Pattern,
    numbers: Numbers,
    /// All of them at once, where they can be evaluated so.
    block: Option<RowEvaluation>,
    /// The budget of one of them.
    budget: Budget,
}

impl Room {
    fn of(pattern: &Pattern, plan: &Plan) -> Room {
        let alone = plan.monte_carlo.is_some();
        let block = (!alone).then(|| RowEvaluation::new(pattern.budget()));
        Room {
            numbers: pattern.numbers(),
            block: block.flatten(),
            budget: pattern.budget().clone(),
            pattern: pattern.clone(),
        }
    }

    /// Takes rows, and finds what is reported of those that need no more.
    fn take(&mut self, rows: &[Result<csv::Row<'_>, Fault>]) {
        let good = rows.iter().map(|row| row.as_ref().ok());
        self.pattern.take(good, &mut self.numbers);
        if let Some(block) = &mut self.block {
            block.evaluate(self.numbers.rows(), rows.len());
        }
    }

    fn figures(&self, lane: usize) -> Option<RowFigures<'_>> {
        let block = self.block.as_ref().filter(|_| self.numbers.takes(lane))?;
        block.row(self.numbers.rows(), lane)
    }

    /// Evaluates a row by itself; why it has no value is told by the reader of the file.
    fn evaluation(&mut self, lane: usize, plan: &Plan) -> Option<(&Budget, Evaluation)> {
        let taken = self.numbers.takes(lane)
            && self.pattern.write(lane, &self.numbers, &mut self.budget);
        let found = taken.then(|| result(&self.budget, plan).ok()).flatten()?;
        Some((&self.budget, found))
    }
}

impl Worker<'_> {
    /// Evaluates rows of a table, which begin behind so many others, and hands each on, in their order.
    fn evaluate(
        &mut self,
        sheet: &Sheet<'_>,
        (begin, rows): (u64, &[Result<csv::Row<'_>, Fault>]),
        plan: &Plan,
        mut hand_on: impl FnMut(&Evaluated<'_>),
    ) {
        if let Some(room) = &mut self.room {
            room.take(rows);
        }
        for ((lane, row), number) in rows.iter().enumerate().zip(begin + 1..) {
            let row = match row {
                Ok(row) => row,
                Err(fault) => {
                    let failed = Failed::Row(Box::new(fault.clone()));
                    hand_on(&Evaluated::at((number, 0, None), Err(&failed)));
                    continue;
                }
            };
            let place = (number, row.line, self.reader.label(row));
            if let Some(room) = &mut self.room {
                if let Some(figures) = room.figures(lane) {
                    let found = (room.pattern.budget(), Found::Figures(figures));
                    hand_on(&Evaluated::at(place, Ok(found)));
                    continue;
                }
                if let Some((budget, evaluation)) = room.evaluation(lane, plan) {
                    let found = (budget, Found::Evaluation(&evaluation));
                    hand_on(&Evaluated::at(place, Ok(found)));
                    continue;
                }
            }
            let read = self.read(row, sheet, plan);
            let found = read.as_ref();
            let found = found.map(|(budget, found)| (budget, Found::Evaluation(found)));
            hand_on(&Evaluated::at(place, found));
        }
    }

    /// Evaluates a row with which the file is read.
    fn read(
        &self,
        row: &csv::Row<'_>,
        sheet: &Sheet<'_>,
        plan: &Plan,
    ) -> Result<(Budget, Evaluation), Failed> {
        let read = self.reader.row(row, sheet);
        let read = read.map_err(|rejection| Failed::Refused(Box::new(rejection)))?;
        let evaluation = result(&read.budget, plan).map_err(Failed::NoResult)?;
        Ok((read.budget, evaluation))
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
