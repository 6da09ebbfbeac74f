//! Rows of a table, and what was found of them.

use std::borrow::Cow;
use std::ops::Range;

use crate::budget::Budget;
use crate::propagate::{BlockFigures, Evaluation, EvaluationError, RowFigures};
use gumption_fault::{Fault, Rejection};
use gumption_format::csv::{self, Columns};

/// Rows of the table, evaluated.
#[derive(Debug)]
pub enum Lot<'a> {
    /// One of them.
    One(Evaluated<'a>),
    /// Some that stand one after the other.
    Several(Several<'a>),
}

/// A row of the table, evaluated.
#[derive(Debug)]
pub struct Evaluated<'a> {
    /// Its number, the first being 1.
    pub number: u64,
    /// Its label, where the table has such a column.
    pub label: Option<&'a str>,
    /// Heads of the columns that are kept, and what the row has there.
    pub kept: (&'a [String], &'a [Cow<'a, str>]),
    /// Its budget, of which the numbers hold and not the words, and what was found; or why nothing was.
    pub found: Result<(&'a Budget, Found<'a>), &'a Failed>,
}

/// Rows of which there is no more to be said than their figures.
#[derive(Debug)]
pub struct Several<'a> {
    pub(super) place: &'a Place<'a>,
    pub(super) lanes: Range<usize>,
    /// Their budget, of which the words hold and not the numbers.
    pub budget: &'a Budget,
    /// What was found.
    pub figures: BlockFigures<'a>,
}

/// Where rows stand in the table.
#[derive(Debug)]
pub(super) struct Place<'a> {
    pub part: &'a Part<'a>,
    /// Rows of the table before these.
    pub begin: u64,
    /// The column of labels.
    pub label: Option<usize>,
    /// Heads and places of the columns that are kept.
    pub heads: &'a [String],
    pub kept: &'a [usize],
}

impl Place<'_> {
    /// Hands on a row.
    pub fn row(
        &self,
        lane: usize,
        found: Result<(&Budget, Found<'_>), &Failed>,
        hand_on: impl FnOnce(Evaluated<'_>),
    ) {
        let label = self.part.label(lane, self.label);
        let kept = self.kept.iter();
        let kept: Vec<_> = kept.map(|column| self.part.field(lane, *column)).collect();
        hand_on(Evaluated {
            number: self.begin + lane as u64 + 1,
            label: label.as_deref(),
            kept: (self.heads, &kept),
            found,
        });
    }
}

impl Several<'_> {
    /// Hands on each row by itself.
    pub fn each(&self, mut hand_on: impl FnMut(&Evaluated<'_>)) {
        for (lane, figures) in self.lanes.clone().zip(self.figures.rows()) {
            let found = Ok((self.budget, Found::Figures(figures)));
            self.place.row(lane, found, |row| hand_on(&row));
        }
    }

    /// The labels of the rows, where the table has such a column: empty for a row without one.
    pub fn labels(&self) -> Option<impl Iterator<Item = Cow<'_, str>>> {
        let Place { part, label, .. } = *self.place;
        let column = label?;
        Some(self.lanes.clone().map(move |lane| part.field(lane, column)))
    }

    /// Heads of the columns that are kept, and what the rows have there.
    pub fn kept(&self) -> impl Iterator<Item = (&str, impl Iterator<Item = Cow<'_, str>>)> {
        let Place {
            part, heads, kept, ..
        } = *self.place;
        heads.iter().zip(kept).map(move |(head, column)| {
            let cells = self
                .lanes
                .clone()
                .map(move |lane| part.field(lane, *column));
            (head.as_str(), cells)
        })
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

/// Some rows of a table.
#[derive(Debug)]
pub(super) enum Part<'t> {
    Lines(&'t [Result<csv::Row<'t>, Box<csv::BadRow<'t>>>]),
    Columns(&'t Columns<'t>, Range<usize>),
}

impl Part<'_> {
    pub(super) fn len(&self) -> usize {
        match self {
            Part::Lines(rows) => rows.len(),
            Part::Columns(_, rows) => rows.len(),
        }
    }

    pub(super) fn row(&self, lane: usize) -> Result<Cow<'_, csv::Row<'_>>, &csv::BadRow<'_>> {
        match self {
            Part::Lines(rows) => match &rows[lane] {
                Ok(row) => Ok(Cow::Borrowed(row)),
                Err(bad) => Err(bad),
            },
            Part::Columns(columns, rows) => Ok(Cow::Owned(columns.row(rows.start + lane))),
        }
    }

    /// The label of a row as the table writes it, where it has such a column: 007 is no number.
    fn label(&self, lane: usize, column: Option<usize>) -> Option<Cow<'_, str>> {
        Some(self.field(lane, column?)).filter(|label| !label.is_empty())
    }

    /// A field of a row. Of one that has too few fields or too many, only the first is in its place for sure.
    fn field(&self, lane: usize, column: usize) -> Cow<'_, str> {
        match self {
            Part::Lines(rows) => {
                let row = rows[lane]
                    .as_ref()
                    .map_or_else(|bad| bad.row.as_ref().filter(|_| column == 0), Some);
                Cow::Borrowed(row.map_or("", |row| row.field(column)))
            }
            Part::Columns(columns, rows) => columns.cells(column).text(rows.start + lane),
        }
    }
}
