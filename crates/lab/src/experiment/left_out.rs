//! Rows of a recording that the experiment leaves out, each with the reason: nothing is dropped in silence.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::path::Path;

use super::checker::Checker;
use super::faults::LEFT_OUT;
use super::tables::{ExperimentTable, LeftOutTable};
use crate::recording::{Recording, Request};
use gumption_fault::{Fault, Rejection, Said, say};
use gumption_format::toml::{Cell, Stated};

impl Checker<'_> {
    /// The recording without the rows that the file leaves out.
    ///
    /// # Errors
    /// The recording cannot be read.
    pub fn recording(&mut self, path: &Path, requests: &[Request]) -> Result<Recording, Rejection> {
        let whole = Recording::open(self.files, path, requests, &self.units)?;
        let there: BTreeSet<usize> = (0..whole.rows()).map(|row| whole.line(row)).collect();
        let mut lines = BTreeSet::new();
        for entry in entries(&self.source.table) {
            let table = &entry.value;
            let reason = table.reason.as_ref();
            if reason.is_none_or(|reason| reason.value.trim().is_empty()) {
                let message = say!("rows are left out without a reason");
                let fault = Fault::new(LEFT_OUT, entry.key.clone(), message);
                self.faults.push(
                    fault
                        .label(say!("`reason` is missing"))
                        .help(say!("reason = \"the door was opened\"")),
                );
            }
            for stated in stated_lines(table) {
                match range(&stated.value)
                    .filter(|range| there.contains(range.start()) && there.contains(range.end()))
                {
                    Some(range) => lines.extend(range),
                    None => self.faults.push(no_rows(stated, &there, &whole.name)),
                }
            }
        }
        if !lines.is_empty() && there.is_subset(&lines) {
            let place = entries(&self.source.table)
                .first()
                .map_or(0..0, |entry| entry.key.clone());
            let message = say!("all rows of {} are left out", whole.name);
            self.faults
                .push(Fault::new(LEFT_OUT, place, message).label(say!("no row is left")));
        }
        Ok(whole.without(&lines))
    }
}

fn entries(table: &ExperimentTable) -> &[Stated<LeftOutTable>] {
    table.left_out.as_ref().map_or(&[], |list| &list.value.0)
}

fn stated_lines(table: &LeftOutTable) -> &[Stated<Cell>] {
    table.lines.as_ref().map_or(&[], |list| &list.value)
}

/// One line, or all from one to another.
fn range(cell: &Cell) -> Option<RangeInclusive<usize>> {
    let line = |text: &str| text.trim().parse::<usize>().ok();
    match cell {
        Cell::Number(number) if *number >= 1.0 && number.fract() == 0.0 => {
            Some(*number as usize..=*number as usize)
        }
        Cell::Number(_) => None,
        Cell::Text(text) => {
            let (first, last) = text.split_once(['-', '–']).unwrap_or((text, text));
            Some(line(first)?..=line(last)?).filter(|range| range.start() <= range.end())
        }
    }
}

fn no_rows(stated: &Stated<Cell>, there: &BTreeSet<usize>, name: &str) -> Fault {
    let (first, last) = (there.first().unwrap_or(&0), there.last().unwrap_or(&0));
    let message = say!("{name} has no such rows");
    Fault::new(LEFT_OUT, stated.span.clone(), message)
        .label(say!("no line of the recording"))
        .help(say!(
            "its rows stand in the lines {first} to {last} of the file: lines = [12, \"20-25\"]"
        ))
}

/// What is left out, and why, for the reader of a report.
pub(super) fn remarks(table: &ExperimentTable) -> Vec<Said> {
    let remark = |entry: &Stated<LeftOutTable>| {
        let lines = stated_lines(&entry.value).iter();
        let lines: Vec<String> = lines
            .map(|line| match &line.value {
                Cell::Number(number) => number.to_string(),
                Cell::Text(text) => text.clone(),
            })
            .collect();
        let (lines, reason) = (lines.join(", "), entry.value.reason.as_ref());
        let reason = reason.map_or("", |reason| reason.value.as_str());
        say!("Left out of the recording, by line: {lines}. Reason: {reason}")
    };
    entries(table).iter().map(remark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_stand_alone_or_in_ranges() {
        let text = |text: &str| range(&Cell::Text(text.into()));
        assert_eq!(range(&Cell::Number(12.0)), Some(12..=12));
        assert_eq!(text("20-25"), Some(20..=25));
        assert_eq!(text("20 – 25"), Some(20..=25));
        assert_eq!(text("7"), Some(7..=7));
        for wrong in ["25-20", "x", "", "3-", "-3"] {
            assert_eq!(text(wrong), None, "{wrong}");
        }
        assert_eq!(range(&Cell::Number(1.5)), None);
        assert_eq!(range(&Cell::Number(-3.0)), None);
    }
}
