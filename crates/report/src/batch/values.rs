//! Results as columns.

use super::shape::{Columns, Count, Shapes, misfit, nothing};
use crate::rows::{Cell, Head};
use gumption_fault::language::Language;
use gumption_gum::batch::{BLOCK, Several};
use gumption_gum::budget::BatchFile;
use std::borrow::Cow;

/// Values of some rows, made by whoever evaluated them.
#[derive(Debug, Default)]
pub struct Values {
    /// As of `Lines`.
    pub(super) shapes: Shapes,
    /// What is kept of them, below its heads.
    kept: Vec<(String, Vec<String>)>,
    stretches: Vec<Stretch>,
}

/// Rows of one shape, as columns: the first are their labels, the last the errors of those among them that have no result.
#[derive(Debug, Default)]
struct Stretch {
    /// Nothing where no row has a result.
    shape: Option<usize>,
    columns: Vec<ResultColumn>,
    count: Count,
}

/// Cells of some rows, as a column.
pub(super) enum Given<'a> {
    /// Numbers; or none at all.
    Numbers(Option<&'a [f64]>),
    /// Numbers that were made of others.
    Made(Vec<f64>),
    /// Texts; nothing where all of them are empty.
    Texts(Option<Vec<String>>),
}

impl Values {
    /// Keeps the fields of a row below their heads.
    pub(super) fn keep(&mut self, (heads, fields): (&[String], &[Cow<'_, str>])) {
        if self.kept.is_empty() {
            let heads = heads.iter().cloned();
            self.kept = heads.map(|head| (head, Vec::new())).collect();
        }
        for ((_, texts), field) in self.kept.iter_mut().zip(fields) {
            texts.push(field.to_string());
        }
    }

    /// Keeps the fields of rows below their heads.
    pub(super) fn keep_all(&mut self, rows: &Several<'_>) {
        if self.kept.is_empty() {
            let heads = rows.kept().map(|(head, _)| (head.to_owned(), Vec::new()));
            self.kept = heads.collect();
        }
        for ((_, texts), (_, fields)) in self.kept.iter_mut().zip(rows.kept()) {
            texts.extend(fields.map(Cow::into_owned));
        }
    }

    /// Adds so many rows, with a column for each of their cells.
    pub(super) fn add_columns(&mut self, shape: usize, count: usize, columns: Vec<Given<'_>>) {
        let fits = |last: &Stretch| last.shape == Some(shape);
        if !self.stretches.last().is_some_and(fits) {
            let empty = columns.iter().map(|_| ResultColumn::Texts(None));
            self.stretches.push(Stretch {
                shape: Some(shape),
                columns: empty.collect(),
                count: Count::default(),
            });
        }
        if let Some(last) = self.stretches.last_mut() {
            let row = last.count.rows as usize;
            for (column, given) in last.columns.iter_mut().zip(columns) {
                column.add(row, count, given);
            }
            last.count.rows += count as u64;
        }
    }

    /// Adds a row, of which `cells` gives the cells and tells whether an item does not conform.
    pub(super) fn add(
        &mut self,
        shape: Option<usize>,
        cells: impl Fn(&mut dyn FnMut(Cell<'_>)) -> bool,
    ) {
        match self.stretches.last_mut().filter(|last| last.shape == shape) {
            Some(last) => last.add(cells),
            None => {
                let mut stretch = Stretch {
                    shape,
                    ..Stretch::default()
                };
                stretch.add(cells);
                self.stretches.push(stretch);
            }
        }
    }

    pub(super) fn add_failed(&mut self, label: Cell<'_>, why: &str) {
        let why = Cell::Text(why);
        match self.stretches.last_mut() {
            Some(last) => last.add_failed(label, why),
            None => self.add(None, |give| {
                give(label);
                give(why);
                false
            }),
        }
    }
}

impl Stretch {
    /// Adds a row.
    fn add(&mut self, cells: impl Fn(&mut dyn FnMut(Cell<'_>)) -> bool) {
        let Stretch { columns, count, .. } = self;
        let row = count.rows as usize;
        let mut at = 0;
        let rejected = cells(&mut |cell| {
            if row == 0 {
                columns.push(ResultColumn::Texts(None));
            }
            if let Some(column) = columns.get_mut(at) {
                column.set(row, cell);
            }
            at += 1;
        });
        count.rows += 1;
        count.rejected += u64::from(rejected);
    }

    fn add_failed(&mut self, label: Cell<'_>, why: Cell<'_>) {
        let row = self.count.rows as usize;
        if let [labels, .., errors] = self.columns.as_mut_slice() {
            labels.set(row, label);
            errors.set(row, why);
        }
        self.count.rows += 1;
    }

    /// The columns with these heads: where it has others, its rows have labels and errors alone.
    fn below(self, heads: &[Head], shapes: &Shapes, language: Language) -> Vec<ResultColumn> {
        let Stretch {
            shape,
            mut columns,
            count,
        } = self;
        let own = shape.map_or(&[][..], |shape| shapes.heads(shape));
        if own == heads {
            return columns;
        }
        let mut errors = columns.pop().map_or(Vec::new(), ResultColumn::texts);
        errors.resize(count.rows as usize, String::new());
        for error in errors.iter_mut().filter(|error| error.is_empty()) {
            // A component less, a vector of another length, an assessment more.
            *error = misfit(own, heads, language);
        }
        columns.truncate(1);
        columns.extend(heads[2..].iter().map(ResultColumn::below));
        columns.push(ResultColumn::Texts(Some(errors)));
        columns
    }
}

/// A column of results.
#[derive(Debug, Clone, PartialEq)]
pub enum ResultColumn {
    /// Numbers; none where one is not a number.
    Numbers(Vec<f64>),
    /// Texts; nothing where all of them are empty.
    Texts(Option<Vec<String>>),
}

/// The results of a batch as columns, which grow by rows.
#[derive(Debug, Default)]
pub struct Results {
    /// In which it is said why a row has no place.
    language: Language,
    heads: Option<Vec<Head>>,
    columns: Vec<ResultColumn>,
    /// What is kept of the rows.
    kept: Vec<(String, Vec<String>)>,
    waiting: Vec<Values>,
    count: Count,
    /// Rows that were taken away.
    taken: u64,
}

impl Results {
    /// Nothing is in them yet. Columns are as of `Table::of`.
    pub fn of(columns: Columns, file: &BatchFile<'_>) -> Results {
        Results {
            language: columns.language,
            heads: file.alone().map(|budget| columns.heads(&budget)),
            ..Results::default()
        }
    }

    /// Adds rows.
    pub fn add(&mut self, values: Values) {
        self.heads = self.heads.take().or_else(|| values.shapes.first());
        self.keep(values.kept.iter().map(|(head, _)| head.clone()));
        self.waiting.push(values);
        let Some(heads) = &self.heads else { return };
        if self.columns.is_empty() {
            self.columns = heads.iter().map(ResultColumn::below).collect();
        }
        for values in std::mem::take(&mut self.waiting) {
            for ((_, texts), (_, added)) in self.kept.iter_mut().zip(values.kept) {
                texts.extend(added);
            }
            for stretch in values.stretches {
                self.add_below(stretch, &values.shapes);
            }
        }
    }

    /// These columns are kept, also where no row says so.
    pub fn keep(&mut self, heads: impl IntoIterator<Item = String>) {
        if self.kept.is_empty() {
            self.kept = heads.into_iter().map(|head| (head, Vec::new())).collect();
        }
    }

    /// Adds rows below the heads that are there.
    fn add_below(&mut self, stretch: Stretch, shapes: &Shapes) {
        let at = self.rows();
        self.count.rows += stretch.count.rows;
        self.count.rejected += stretch.count.rejected;
        let heads = self.heads.as_deref().unwrap_or_default();
        let added = stretch.below(heads, shapes, self.language);
        if let Some(ResultColumn::Texts(Some(errors))) = added.last() {
            let failed = errors.iter().filter(|error| !error.is_empty());
            self.count.failed += failed.count() as u64;
        }
        let columns = self.columns.iter_mut().zip(added);
        columns.for_each(|(column, added)| column.append(at, added));
    }

    /// How many rows are in them.
    pub fn rows(&self) -> usize {
        (self.count.rows - self.taken) as usize
    }

    /// The columns of the rows that are in them, with their heads; the next ones follow those.
    pub fn take(&mut self) -> Vec<(String, ResultColumn)> {
        let rows = self.rows();
        self.taken = self.count.rows;
        self.columns.iter_mut().for_each(|column| column.fill(rows));
        let columns = self.columns.iter_mut();
        let columns = columns.map(|column| std::mem::replace(column, column.emptied()));
        let names = self.heads.iter().flatten().map(|head| head.name.clone());
        let mut found: Vec<_> = names.zip(columns).collect();
        let kept = self.kept.iter_mut();
        let kept = kept.map(|(head, texts)| {
            let texts = ResultColumn::Texts(Some(std::mem::take(texts)));
            (head.clone(), texts)
        });
        found.splice(1..1, kept);
        found
    }

    /// The columns with their heads, and how the rows have ended.
    pub fn end(mut self) -> (Vec<(String, ResultColumn)>, Count) {
        // A table without rows has columns, too.
        self.add(Values {
            shapes: Shapes::from(nothing()),
            ..Values::default()
        });
        (self.take(), self.count)
    }
}

impl ResultColumn {
    /// The empty one below a head.
    fn below(head: &Head) -> ResultColumn {
        match head.numbers {
            true => ResultColumn::Numbers(Vec::new()),
            false => ResultColumn::Texts(None),
        }
    }

    /// How many cells it has; of texts that are all empty nobody knows.
    pub fn cells(&self) -> usize {
        match self {
            ResultColumn::Numbers(numbers) => numbers.len(),
            ResultColumn::Texts(texts) => texts.as_ref().map_or(0, Vec::len),
        }
    }

    /// One of the same kind, with nothing in it.
    fn emptied(&self) -> ResultColumn {
        match self {
            ResultColumn::Numbers(_) => ResultColumn::Numbers(Vec::new()),
            ResultColumn::Texts(_) => ResultColumn::Texts(None),
        }
    }

    fn texts(self) -> Vec<String> {
        match self {
            ResultColumn::Texts(texts) => texts.unwrap_or_default(),
            ResultColumn::Numbers(_) => Vec::new(),
        }
    }

    /// Makes it so long.
    fn fill(&mut self, rows: usize) {
        match self {
            ResultColumn::Numbers(numbers) => numbers.resize(rows, f64::NAN),
            ResultColumn::Texts(Some(texts)) => texts.resize(rows, String::new()),
            ResultColumn::Texts(None) => {}
        }
    }

    /// Sets the cell of a row behind those that are there; a column of which nothing is there becomes one of numbers by one.
    fn set(&mut self, row: usize, cell: Cell<'_>) {
        match cell {
            Cell::Number(x) => self.set_number(row, x.unwrap_or(f64::NAN)),
            // A seed is at most 2^53.
            Cell::Seed(seed) => self.set_number(row, seed.map_or(f64::NAN, |x| x as f64)),
            Cell::Text("") => {}
            Cell::Text(text) => self.append(row, ResultColumn::Texts(Some(vec![text.to_owned()]))),
        }
    }

    /// Adds so many cells behind those that are there, from this row on.
    fn add(&mut self, row: usize, count: usize, given: Given<'_>) {
        match given {
            Given::Numbers(Some(numbers)) => {
                let added = self.numbers_before(row);
                added
                    .into_iter()
                    .for_each(|all| all.extend_from_slice(numbers));
            }
            Given::Made(numbers) => {
                let added = self.numbers_before(row);
                added.into_iter().for_each(|all| all.extend(&numbers));
            }
            Given::Numbers(None) => {
                let added = self.numbers_before(row);
                added
                    .into_iter()
                    .for_each(|all| all.resize(row + count, f64::NAN));
            }
            Given::Texts(Some(texts)) => self.append(row, ResultColumn::Texts(Some(texts))),
            Given::Texts(None) => {}
        }
    }

    fn set_number(&mut self, row: usize, x: f64) {
        if let Some(numbers) = self.numbers_before(row) {
            numbers.push(x);
        }
    }

    /// Its numbers up to this row, where it has none of texts.
    fn numbers_before(&mut self, row: usize) -> Option<&mut Vec<f64>> {
        if let ResultColumn::Texts(None) = self {
            *self = ResultColumn::Numbers(Vec::with_capacity(BLOCK));
        }
        match self {
            ResultColumn::Numbers(numbers) => {
                numbers.resize(row, f64::NAN);
                Some(numbers)
            }
            ResultColumn::Texts(_) => None,
        }
    }

    /// Adds a column from this row on, behind what is there.
    fn append(&mut self, row: usize, added: ResultColumn) {
        match (self, added) {
            (ResultColumn::Numbers(numbers), ResultColumn::Numbers(added)) => {
                numbers.resize(row, f64::NAN);
                numbers.extend_from_slice(&added);
            }
            (ResultColumn::Texts(texts), ResultColumn::Texts(Some(added))) => {
                let texts = texts.get_or_insert_default();
                texts.resize(row, String::new());
                texts.extend(added);
            }
            _ => {}
        }
    }
}
