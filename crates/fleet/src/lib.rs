//! What the results of many devices say together: whether they scatter as their uncertainties claim, which of them stand
//! apart, how they drift between calibrations, what makes their uncertainty large.
//!
//! | chapter | holds |
//! |---|---|
//! | [`faults`] | codes of what is refused |
//! | `wanted` | what is asked of a table |
//! | `layout` | what the columns of a table of results hold, by their names |
//! | `results` | the table as columns of numbers |
//! | `parallel` | rows on several threads |
//! | `deviation` | a value beside the weighted mean of others |
//! | `group` | one measurand in one group |
//! | `agreement` | E_n, and the rows that stand apart |
//! | `drift` | the same device at several dates |
//!
//! A table is what `gumption batch` writes, with columns of the user's own beside it.
//!
//! ```
//! use gumption_fleet::{Wanted, fleet};
//!
//! let table = "label,y,u(y),k(y),U(y)\na,10.0,0.1,2,0.2\nb,10.1,0.1,2,0.2\nc,9.9,0.1,2,0.2\nd,11.0,0.1,2,0.2\n";
//! let found = fleet((table.as_bytes(), "results.csv"), &Wanted::default())
//!     .map_err(|rejection| rejection.render(false))?;
//! let y = &found.measurands[0];
//! assert_eq!((y.agreement.beyond, y.agreement.apart[0].device.as_str()), (1, "d"));
//! # Ok::<(), String>(())
//! ```

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod agreement;
mod deviation;
mod drift;
pub mod faults;
mod group;
mod layout;
mod parallel;
mod results;
#[cfg(test)]
mod tests;
mod wanted;

pub use agreement::{Agreement, Apart};
pub use deviation::SIGNIFICANCE;
pub use drift::{Course, DAYS_OF_A_YEAR, Drift, Drifting, GroupDrift};
pub use group::{Component, Consistency, GroupResult, Scatter};
pub use wanted::Wanted;

use std::io::Read;

use gumption_core::quantity::Unit;
use gumption_fault::Rejection;
use gumption_format::csv::Columns;

use crate::deviation::Devices;
use crate::group::Members;
use crate::results::{BETWEEN, Levels, Results};

/// Rows that are drawn one by one.
const DRAWN: usize = 200;

/// What was found.
#[derive(Debug, Clone)]
pub struct Fleet {
    /// Rows of the table.
    pub rows: usize,
    /// The columns by which they are grouped.
    pub by: Vec<String>,
    /// Their values, in order, with what is counted; one without a value where nothing groups them.
    pub groups: Vec<Group>,
    /// The measurands.
    pub measurands: Vec<Measurand>,
    /// The number of E_n over all measurands.
    pub tests: usize,
}

/// Rows that belong together.
#[derive(Debug, Clone)]
pub struct Group {
    /// Their values in the columns by which rows are grouped.
    pub key: Vec<String>,
    /// How many rows.
    pub rows: usize,
    /// Those without a result: codes of their faults, and how many.
    pub faulty: Vec<(String, usize)>,
    /// Codes of findings, and how many rows have them.
    pub findings: Vec<(String, usize)>,
    /// Of each assessment of conformity its verdicts, and how many.
    pub verdicts: Vec<(String, Vec<(String, usize)>)>,
}

/// What was found of a measurand.
#[derive(Debug, Clone)]
pub struct Measurand {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
    /// The column of its reference, where one is stated.
    pub reference: Option<String>,
    /// Of each group; without values where it has none.
    pub groups: Vec<GroupResult>,
    /// E_n.
    pub agreement: Agreement,
    /// The deviations of all rows from the others of their groups.
    pub deviations: Deviations,
    /// The drift, where dates are given.
    pub drift: Option<Drift>,
    /// Group, estimate and U of each row, group by group; empty where there are too many to be drawn.
    pub points: Vec<(usize, f64, f64)>,
}

/// How often deviations from the weighted mean of the others lie where, in standard deviations; where u is right and items do
/// not differ, they are a sample of the standard normal distribution.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Deviations {
    /// Counts from −5 to 5; what lies beyond is in the first and the last.
    pub counts: [usize; Deviations::BINS],
}

impl Deviations {
    /// Where they begin.
    pub const START: f64 = -5.0;
    /// Width of each: a quarter of a standard deviation.
    pub const WIDTH: f64 = 0.25;
    /// Their number.
    pub const BINS: usize = 40;

    fn add(&mut self, score: f64) {
        let place = (score - Self::START) / Self::WIDTH;
        // Negative and very large numbers become the ends of their type.
        self.counts[(place as usize).min(Self::BINS - 1)] += 1;
    }
}

/// Reads a table of results, and says what they say together.
///
/// # Errors
/// It cannot be read, has no measurand, or lacks a column that is asked for.
pub fn fleet((source, name): (impl Read, &str), wanted: &Wanted) -> Result<Fleet, Rejection> {
    results::read(source, name, wanted).map(|results| found(&results, wanted))
}

/// As [`fleet`], of a table in memory.
///
/// # Errors
/// As of [`fleet`].
pub fn fleet_of_columns(
    (columns, name): (&Columns<'_>, &str),
    wanted: &Wanted,
) -> Result<Fleet, Rejection> {
    let results = results::read_columns(columns, name, wanted)?;
    Ok(found(&results, wanted))
}

fn found(results: &Results, wanted: &Wanted) -> Fleet {
    let groups = rows_of_groups(&results.groups);
    let has_result = |row: usize| results.errors.get(row).is_empty();
    let members: Vec<Vec<Members>> = results
        .measurands
        .iter()
        .map(|one| {
            let rows = groups
                .iter()
                .map(|(_, rows)| Members::of(&one.values, rows, has_result));
            rows.collect()
        })
        .collect();
    let devices = results.numbered_devices();
    let all = results.measurands.iter().zip(&members);
    let testable = |(one, members): (&_, &Vec<Members>)| -> usize {
        members
            .iter()
            .map(|members| agreement::testable(one, members, devices.as_deref()))
            .sum()
    };
    let tests = all.clone().map(testable).sum();
    let threads = wanted.threads();
    let measurands = (0..results.measurands.len()).map(|at| {
        measurand(
            (results, devices.as_deref()),
            at,
            &members[at],
            tests,
            threads,
        )
    });
    Fleet {
        rows: results.rows,
        by: wanted.by.clone(),
        measurands: measurands.collect(),
        groups: groups
            .iter()
            .map(|(key, rows)| Group::of(results, key, rows))
            .collect(),
        tests,
    }
}

/// The rows of each group, with its key; the groups in the order of their keys.
fn rows_of_groups(levels: &Levels) -> Vec<(&str, Vec<usize>)> {
    let mut groups: Vec<(&str, Vec<usize>)> = levels
        .names
        .iter()
        .map(|name| (name.as_str(), Vec::new()))
        .collect();
    for (row, level) in levels.of_row.iter().enumerate() {
        groups[*level as usize].1.push(row);
    }
    groups.sort_by_key(|(key, _)| *key);
    groups
}

fn measurand(
    (results, devices): (&Results, Option<&Devices>),
    at: usize,
    members: &[Members],
    tests: usize,
    threads: usize,
) -> Measurand {
    let one = &results.measurands[at];
    let mut deviations = Deviations {
        counts: [0; Deviations::BINS],
    };
    let groups = members.iter();
    let groups =
        groups.map(|members| GroupResult::of(one, members, threads, |score| deviations.add(score)));
    let mut groups: Vec<GroupResult> = groups.collect();
    let device = (devices, |row| results.devices.name(row));
    let agreement = agreement::agreement(one, members, &mut groups, [tests, threads], device);
    let drift = results.dates.as_ref().map(|dates| {
        let rows = members.iter().map(|members| members.weighed.as_slice());
        drift::drift(&one.values, dates, rows, threads, |row| {
            results.devices.get(row)
        })
    });
    let mut points = Vec::new();
    if results.rows <= DRAWN {
        for (group, members) in members.iter().enumerate() {
            let rows = members.valued.iter();
            points.extend(
                rows.map(|row| (group, one.values.estimate[*row], one.values.expanded[*row])),
            );
        }
    }
    Measurand {
        name: one.name.clone(),
        unit: one.unit.clone(),
        reference: one.reference.as_ref().map(|(name, _)| name.clone()),
        groups,
        agreement,
        deviations,
        drift,
        points,
    }
}

impl Group {
    fn of(results: &Results, key: &str, rows: &[usize]) -> Group {
        let verdicts = results.verdicts.iter();
        let whole = |levels| counted(levels, rows, |text| Some(text).into_iter());
        Group {
            key: match key {
                "" => Vec::new(),
                key => key.split(BETWEEN).map(str::to_owned).collect(),
            },
            rows: rows.len(),
            faulty: whole(&results.errors),
            findings: counted(&results.findings, rows, str::split_whitespace),
            verdicts: verdicts
                .map(|(name, levels)| (name.clone(), whole(levels)))
                .collect(),
        }
    }
}

/// How many rows have which texts, the most frequent first; a level may hold several.
fn counted<'l, I: Iterator<Item = &'l str>>(
    levels: &'l Levels,
    rows: &[usize],
    parts: impl Fn(&'l str) -> I,
) -> Vec<(String, usize)> {
    let mut of_level = vec![0; levels.names.len()];
    for row in rows {
        of_level[levels.of_row[*row] as usize] += 1;
    }
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for (name, count) in levels
        .names
        .iter()
        .zip(of_level)
        .filter(|(_, count)| *count > 0)
    {
        for part in parts(name).filter(|part| !part.is_empty()) {
            match counts.iter_mut().find(|(known, _)| *known == part) {
                Some((_, known)) => *known += count,
                None => counts.push((part, count)),
            }
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
    counts
        .into_iter()
        .map(|(text, count)| (text.to_owned(), count))
        .collect()
}
