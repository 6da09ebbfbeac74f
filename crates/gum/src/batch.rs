//! One budget for many devices: every row of a table gives it values, and gets a result of its own.
//!
//! A row is evaluated as the budget would be with the row written into it by hand. Rows share nothing but the work of
//! reading: not their faults, not the random numbers, and no result depends on how the table is cut, on other rows or on the
//! number of threads.

mod lot;

use std::borrow::Borrow;
use std::io::Read;
use std::iter::once;
use std::ops::{ControlFlow, Range};
use std::sync::{Mutex, PoisonError};

use crate::budget::faults::UNKNOWN_NAME;
use crate::budget::{
    Batch, BatchFile, Budget, MonteCarloSettings, Numbers, Pattern, RowReader, Wanted,
};
use crate::propagate::{
    self, BlockFigures, Evaluation, EvaluationError, MonteCarloChoice, Options, Progress,
    RowEvaluation, parallel_map,
};
use gumption_fault::say;
use gumption_fault::{Fault, Rejection};
use gumption_format::csv::faults::NO_HEADER;
use gumption_format::csv::{self, Columns, Pieces, Sheet};
use gumption_format::toml::faults::UNKNOWN_KEY;
use gumption_lanes::LANES;
use lot::{Part, Place};

pub use lot::{Evaluated, Failed, Found, Lot, Several};

/// Rows that a thread takes at a time, and that are added to one another: as many as are evaluated together.
pub const BLOCK: usize = LANES;

/// Rows of columns after which what was found is taken: some blocks for each thread, and little memory.
pub const STRETCH: usize = 64 * BLOCK;

/// How the rows of a table are evaluated.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Monte Carlo with these settings in place of the budget's; nothing leaves it out.
    pub monte_carlo: Option<Wanted>,
    /// Threads that share the rows.
    pub threads: usize,
    /// Columns of the table that go through to the results, whether they set anything or not.
    pub keep: Vec<String>,
    /// Ends the work where it is stopped; counts trials.
    pub progress: Progress,
}

/// Evaluates the rows of a table, piece by piece. `add` makes of rows what is wanted of them, on any thread, and adds it to
/// that of the rows before them; `take` gets what some rows have given, in their order, with the number of bytes that were
/// read, and may end the work. Gives the heads of the columns that are kept.
///
/// # Errors
/// The table cannot be read, one of its columns is no place of the budget, or the budget has faults of its own that no row
/// mends. Rows have been taken before, where the table cannot be read further.
pub fn run<T: Default + Send>(
    file: &BatchFile<'_>,
    (source, table): (impl Read, &str),
    plan: &Plan,
    add: impl Fn(&mut T, &Lot<'_>) + Sync,
    mut take: impl FnMut(T, u64) -> ControlFlow<()>,
) -> Result<Vec<String>, Rejection> {
    let refused = |fault: Box<Fault>| Rejection::new(table, "", vec![*fault]);
    let mut pieces = Pieces::new(source);
    let first = pieces.next().unwrap_or_else(empty).map_err(refused)?;
    let head = Sheet::new(&first.text)
        .map_err(|fault| Rejection::new(table, &first.text, vec![*fault]))?
        .above_units(&file.units());
    let batch = file.batch(&head, table, &plan.keep)?;
    let mut run = Run::new(&batch, plan, (&head, table));
    let mut work = |sheet: &Sheet<'_>, read: u64| {
        let rows: Vec<_> = sheet.rows().collect();
        run.learn(sheet, &rows)?;
        let parts = rows.chunks(BLOCK).map(Part::Lines).collect();
        Ok::<bool, Rejection>(run.evaluate(sheet, parts, &add, |part| take(part, read)))
    };
    let mut more = work(&head, pieces.bytes_read())?;
    while more {
        let Some(piece) = pieces.next() else { break };
        let piece = piece.map_err(refused)?;
        let read = pieces.bytes_read();
        more = work(&head.below(&piece.text, piece.line), read)?;
    }
    Ok(run.kept)
}

/// As [`run`], of a table whose rows come as columns, piece by piece, all with the same heads; `take` gets the number of rows
/// that were evaluated.
///
/// # Errors
/// As of [`run`].
pub fn run_columns<'c, T: Default + Send>(
    file: &BatchFile<'_>,
    (pieces, table): (
        impl IntoIterator<Item = Result<impl Borrow<Columns<'c>>, Box<Fault>>>,
        &str,
    ),
    plan: &Plan,
    add: impl Fn(&mut T, &Lot<'_>) + Sync,
    mut take: impl FnMut(T, u64) -> ControlFlow<()>,
) -> Result<Vec<String>, Rejection> {
    let refused = |fault: Box<Fault>| Rejection::new(table, "", vec![*fault]);
    let mut pieces = pieces.into_iter();
    let first = pieces.next().unwrap_or_else(empty).map_err(refused)?;
    let head = first.borrow().head();
    let sheet = Sheet::new(&head).map_err(|fault| Rejection::new(table, &head, vec![*fault]))?;
    let batch = file.batch(&sheet, table, &plan.keep)?;
    if let Some(fault) = batch.mean_of(first.borrow(), &sheet) {
        return Err(Rejection::new(table, &head, vec![fault]));
    }
    let mut run = Run::new(&batch, plan, (&sheet, table));
    for piece in once(Ok(first)).chain(pieces) {
        let piece = piece.map_err(refused)?;
        let columns = piece.borrow();
        for begin in (0..columns.rows()).step_by(STRETCH) {
            let rows = begin..columns.rows().min(begin + STRETCH);
            if run.is_to_learn() {
                let few = rows.clone().take(BLOCK);
                let few: Vec<_> = few.map(|row| columns.row(row)).map(Ok).collect();
                run.learn(&sheet, &few)?;
            }
            let parts = rows.clone().step_by(BLOCK);
            let part = |begin| Part::Columns(columns, begin..rows.end.min(begin + BLOCK));
            let done = run.number + rows.len() as u64;
            let parts = parts.map(part).collect();
            if !run.evaluate(&sheet, parts, &add, |part| take(part, done)) {
                return Ok(run.kept);
            }
        }
    }
    Ok(run.kept)
}

/// The fault of a table without a line of names.
fn empty<T>() -> Result<T, Box<Fault>> {
    let message = say!("the table is empty");
    Err(Box::new(Fault::new(NO_HEADER, 0..0, message)))
}

/// Rows of a table that are evaluated one stretch after another.
struct Run<'b> {
    batch: &'b Batch<'b>,
    plan: &'b Plan,
    /// The name of the table.
    table: &'b str,
    /// Heads of the columns that are kept.
    kept: Vec<String>,
    /// The pattern of rows that are numbers, as soon as it is known whether there is one.
    known: Option<Option<Pattern>>,
    /// What threads leave to those of the next stretch.
    spare: Vec<Room>,
    /// Rows that were evaluated.
    number: u64,
}

impl<'b> Run<'b> {
    fn new(batch: &'b Batch<'b>, plan: &'b Plan, (head, table): (&Sheet<'_>, &'b str)) -> Run<'b> {
        let kept = batch.kept().iter();
        Run {
            batch,
            plan,
            table,
            kept: kept.map(|at| head.header().field(*at).to_owned()).collect(),
            known: None,
            spare: Vec::new(),
            number: 0,
        }
    }

    fn is_to_learn(&self) -> bool {
        self.known.is_none()
    }

    /// Looks what the rows that follow have in common.
    fn learn(
        &mut self,
        sheet: &Sheet<'_>,
        rows: &[Result<csv::Row<'_>, Box<csv::BadRow<'_>>>],
    ) -> Result<(), Rejection> {
        if self.number == 0 {
            hopeless(self.batch, (sheet, self.table), rows)?;
        }
        if self.is_to_learn() {
            self.known = self.batch.pattern(rows.iter().flatten(), sheet);
        }
        Ok(())
    }

    /// Evaluates the parts of a stretch on all threads; tells whether the work goes on.
    fn evaluate<T: Default + Send>(
        &mut self,
        sheet: &Sheet<'_>,
        parts: Vec<Part<'_>>,
        add: &(impl Fn(&mut T, &Lot<'_>) + Sync),
        take: impl FnMut(T) -> ControlFlow<()>,
    ) -> bool {
        let Run { batch, plan, .. } = *self;
        let heads = self.kept.as_slice();
        let pattern = self.known.as_ref().and_then(Option::as_ref);
        let first = self.number;
        self.number += parts.iter().map(|part| part.len() as u64).sum::<u64>();
        let parts = parts.into_iter().zip((first..).step_by(BLOCK));
        let part = |worker: &mut Worker<'_>, (part, begin): (Part<'_>, u64)| {
            let mut found = T::default();
            worker.evaluate(sheet, &part, begin, plan, |row| add(&mut found, row));
            found
        };
        // Whose room is left from the stretch before takes it again.
        let rooms = Mutex::new(std::mem::take(&mut self.spare));
        let worker = || {
            let room = rooms.lock().unwrap_or_else(PoisonError::into_inner).pop();
            Worker {
                reader: batch.reader(),
                label: batch.label(),
                kept: (heads, batch.kept()),
                room: room.or_else(|| Some(Room::of(pattern?, plan))),
            }
        };
        let room = |worker: Worker<'_>| worker.room;
        let (done, rooms) = parallel_map(parts.collect(), plan.threads, worker, part, room);
        self.spare = rooms.into_iter().flatten().collect();
        let ended = plan.progress.is_stopped();
        !ended && done.into_iter().map(take).all(|flow| flow.is_continue())
    }
}

/// Whether the budget has faults that are there without any row and with each of the first, or a column of the table names a key
/// or a component that there is not.
fn hopeless(
    batch: &Batch<'_>,
    (sheet, table): (&Sheet<'_>, &str),
    rows: &[Result<csv::Row<'_>, Box<csv::BadRow<'_>>>],
) -> Result<(), Rejection> {
    /// Rows that are tried.
    const FEW: usize = 16;
    let reader = batch.reader();
    let own = reader.alone();
    let mut left = own.as_ref().err().map(|own| own.faults.clone());
    let mut tried = rows.iter().flatten().take(FEW).peekable();
    let is_tried = tried.peek().is_some();
    for row in tried {
        let Err(with_row) = reader.row(row, sheet) else {
            return Ok(());
        };
        match &mut left {
            Some(left) => left.retain(|fault| with_row.faults.contains(fault)),
            None => left = Some(with_row.faults),
        }
    }
    let faults = left.unwrap_or_default();
    match own {
        Err(own) if is_tried && !faults.is_empty() => Err(Rejection { faults, ..own }),
        Ok(_) => {
            let columns = 0..sheet.header().len();
            let heads: Vec<Range<usize>> = columns.map(|at| sheet.name_place(at)).collect();
            let is_unknown = |fault: &Fault| [UNKNOWN_KEY, UNKNOWN_NAME].contains(&fault.code);
            let of_head = |fault: &Fault| is_unknown(fault) && heads.contains(&fault.span);
            let faults: Vec<Fault> = faults.into_iter().filter(of_head).collect();
            match faults.is_empty() {
                true => Ok(()),
                false => Err(Rejection::new(table, sheet.text(), faults)),
            }
        }
        Err(_) => Ok(()),
    }
}

/// Evaluates rows on one thread.
struct Worker<'b> {
    reader: RowReader<'b>,
    /// The column of labels.
    label: Option<usize>,
    /// Heads and places of the columns that are kept.
    kept: (&'b [String], &'b [usize]),
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

    /// Takes rows, and finds what is reported of those that need no more than their figures.
    fn take(&mut self, part: &Part<'_>) {
        let numbers = &mut self.numbers;
        match part {
            Part::Lines(rows) => {
                let good = rows.iter().map(|row| row.as_ref().ok());
                self.pattern.take(good, numbers);
            }
            Part::Columns(columns, rows) => {
                self.pattern.take_columns(columns, rows.clone(), numbers);
            }
        }
        if let Some(block) = &mut self.block {
            block.evaluate(self.numbers.rows(), part.len());
        }
    }

    /// How many rows from this lane on need no more than their figures.
    fn sure(&self, lanes: Range<usize>) -> usize {
        let Some(block) = &self.block else { return 0 };
        let doubts = [block.doubt(), self.numbers.refused()];
        let is_sure = |lane: &usize| doubts.iter().all(|doubt| doubt.0[*lane] == 0.0);
        lanes.take_while(is_sure).count()
    }

    /// The figures of rows that need no more.
    fn figures(&self, lanes: Range<usize>) -> Option<BlockFigures<'_>> {
        let block = self.block.as_ref()?;
        Some(block.figures(self.numbers.rows(), lanes))
    }

    /// Evaluates a row by itself; why it has no value is told by the reader of the file.
    fn evaluation(&mut self, lane: usize, plan: &Plan) -> Option<(&Budget, Evaluation)> {
        let taken =
            self.numbers.takes(lane) && self.pattern.write(lane, &self.numbers, &mut self.budget);
        let found = taken.then(|| result(&self.budget, plan).ok()).flatten()?;
        Some((&self.budget, found))
    }
}

impl Worker<'_> {
    /// Evaluates rows of a table, which begin behind so many others, and hands each on, in their order.
    fn evaluate(
        &mut self,
        sheet: &Sheet<'_>,
        part: &Part<'_>,
        begin: u64,
        plan: &Plan,
        mut hand_on: impl FnMut(&Lot<'_>),
    ) {
        if let Some(room) = &mut self.room {
            room.take(part);
        }
        let place = Place {
            part,
            begin,
            label: self.label,
            heads: self.kept.0,
            kept: self.kept.1,
        };
        let mut lane = 0;
        while lane < part.len() {
            let sure = self.sure(lane..part.len());
            if sure > 0 {
                self.hand_on_several(&place, lane..lane + sure, &mut hand_on);
                lane += sure;
                continue;
            }
            self.hand_on_one(&place, lane, sheet, plan, &mut hand_on);
            lane += 1;
        }
    }

    fn sure(&self, lanes: Range<usize>) -> usize {
        self.room.as_ref().map_or(0, |room| room.sure(lanes))
    }

    fn hand_on_several(
        &self,
        place: &Place<'_>,
        lanes: Range<usize>,
        hand_on: &mut impl FnMut(&Lot<'_>),
    ) {
        let Some(room) = &self.room else { return };
        if let Some(figures) = room.figures(lanes.clone()) {
            hand_on(&Lot::Several(Several {
                place,
                lanes,
                budget: room.pattern.budget(),
                figures,
            }));
        }
    }

    fn hand_on_one(
        &mut self,
        place: &Place<'_>,
        lane: usize,
        sheet: &Sheet<'_>,
        plan: &Plan,
        hand_on: &mut impl FnMut(&Lot<'_>),
    ) {
        let room = self.room.as_mut();
        if let Some((budget, evaluation)) = room.and_then(|room| room.evaluation(lane, plan)) {
            let found = (budget, Found::Evaluation(&evaluation));
            place.row(lane, Ok(found), |row| hand_on(&Lot::One(row)));
            return;
        }
        let read = match place.part.row(lane) {
            Ok(row) => self.read(&row, sheet, plan),
            Err(bad) => Err(Failed::Row(Box::new(bad.fault.clone()))),
        };
        let found = read.as_ref();
        let found = found.map(|(budget, found)| (budget, Found::Evaluation(found)));
        place.row(lane, found, |row| hand_on(&Lot::One(row)));
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
