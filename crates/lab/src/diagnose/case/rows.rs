//! Rows of the columns of a case that are not those of its recording: a recording that is to be
//! predicted, or a measurement that may follow.

use std::collections::BTreeMap;

use super::{Case, Column, Data, HeldOut};
use crate::diagnose::faults::{MISSING, ROWS};
use crate::experiment::checker::Checker;
use crate::experiment::entries::RoleWord;
use crate::experiment::tables::ExperimentTable;
use crate::recording::{Content, Labels, Recording, Request, headings, text_of};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Stated;

/// Rows with a value for each column of a case, in their order.
#[derive(Debug, Clone)]
pub struct Rows {
    /// How many.
    pub count: usize,
    /// What each column holds.
    pub data: Vec<Data>,
}

impl Rows {
    /// The rows of the recording of a case.
    pub fn of(case: &Case) -> Rows {
        Rows {
            count: case.rows,
            data: case.columns.iter().map(|c| c.data.clone()).collect(),
        }
    }

    /// These rows alone in the order of `places`.
    #[must_use]
    pub fn taken(&self, places: &[usize]) -> Rows {
        let taken = |data: &Data| match data {
            Data::Numbers(numbers) => {
                Data::Numbers(places.iter().map(|row| numbers[*row]).collect())
            }
            Data::Labels(labels) => Data::Labels(Labels {
                levels: labels.levels.clone(),
                of_row: places.iter().map(|row| labels.of_row[*row]).collect(),
            }),
            Data::Absent => Data::Absent,
        };
        Rows {
            count: places.len(),
            data: self.data.iter().map(taken).collect(),
        }
    }
}

impl Case {
    /// The case with other rows instead of those of its recording.
    #[must_use]
    pub fn with(&self, rows: &Rows) -> Case {
        let mut case = self.clone();
        case.rows = rows.count;
        for (column, data) in case.columns.iter_mut().zip(&rows.data) {
            column.data = match (&column.data, data) {
                (Data::Labels(own), Data::Labels(other)) => Data::Labels(joined(own, other, 0)),
                _ => data.clone(),
            };
        }
        case
    }

    /// The case with further rows behind those of its recording; outputs are not recorded.
    #[must_use]
    pub fn followed_by(&self, rows: &Rows) -> Case {
        let mut case = self.clone();
        case.rows += rows.count;
        for (column, data) in case.columns.iter_mut().zip(&rows.data) {
            if column.role == RoleWord::Output {
                column.data = Data::Absent;
                continue;
            }
            column.data = match (&column.data, data) {
                (Data::Numbers(own), Data::Numbers(other)) => {
                    Data::Numbers(own.iter().chain(other).copied().collect())
                }
                (Data::Labels(own), Data::Labels(other)) => {
                    Data::Labels(joined(own, other, own.of_row.len()))
                }
                _ => Data::Absent,
            };
        }
        case
    }
}

/// The first rows of labels and then others, with one list of levels.
fn joined(own: &Labels, other: &Labels, kept: usize) -> Labels {
    let mut levels = own.levels.clone();
    let mut of_row = own.of_row[..kept].to_vec();
    let mut places: BTreeMap<u32, u32> = BTreeMap::new();
    for level in &other.of_row {
        let place = *places.entry(*level).or_insert_with(|| {
            let text = &other.levels[*level as usize];
            let known = levels.iter().position(|own| own == text);
            let at = known.unwrap_or(levels.len());
            if at == levels.len() {
                levels.push(text.clone());
            }
            at as u32
        });
        of_row.push(place);
    }
    Labels { levels, of_row }
}

/// Numbers of a column that a further measurement does not state: what was recorded goes on.
pub(super) fn continued(column: &Column, count: usize) -> Option<Data> {
    match &column.data {
        Data::Absent => Some(Data::Absent),
        Data::Labels(labels) => {
            let last = *labels.of_row.last()?;
            Some(Data::Labels(Labels {
                levels: labels.levels.clone(),
                of_row: vec![last; count],
            }))
        }
        Data::Numbers(numbers) => match column.role {
            RoleWord::Output => Some(Data::Absent),
            RoleWord::Stimulus => None,
            RoleWord::Time | RoleWord::Order => {
                let last = *numbers.last()?;
                let step = interval(numbers);
                let at = |row: usize| last + step * (row + 1) as f64;
                Some(Data::Numbers((0..count).map(at).collect()))
            }
            _ => {
                let mean = numbers.iter().sum::<f64>() / numbers.len().max(1) as f64;
                Some(Data::Numbers(vec![mean; count]))
            }
        },
    }
}

/// The usual distance of successive rows in time.
pub(in crate::diagnose) fn interval(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|step| *step > 0.0)
        .collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(1.0)
}

/// What a file of rows must hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Complete {
    /// Every column of the recording.
    Recorded,
    /// What was applied; the rest goes on as recorded.
    Planned,
}

impl Checker<'_> {
    /// The recording that is to be predicted.
    pub(super) fn held_out(
        &mut self,
        file: &ExperimentTable,
        columns: &[Column],
    ) -> Option<HeldOut> {
        let stated = file.held_out.as_ref()?;
        let Some(path) = &stated.value.file else {
            if !stated.value.refused {
                let fault = Fault::new(
                    MISSING,
                    stated.span.clone(),
                    say!("[held_out] has no `file`"),
                );
                self.faults.push(fault.label(say!("`file` is missing")));
            }
            return None;
        };
        let rows = self.rows_of_file(path, columns, Complete::Recorded)?;
        Some(HeldOut {
            file: path.value.clone(),
            rows,
        })
    }

    /// Reads rows of the columns of a case from another file.
    pub(super) fn rows_of_file(
        &mut self,
        path: &Stated<String>,
        columns: &[Column],
        complete: Complete,
    ) -> Option<Rows> {
        let full = self.folder.join(&path.value);
        let refused = |message: Said| Fault::new(ROWS, path.span.clone(), message);
        let first = |faults: &[Fault]| {
            faults
                .first()
                .map_or_else(Said::default, |f| f.message.clone())
        };
        let text = match text_of(self.files, &full, &path.value) {
            Ok(text) => text,
            Err(rejection) => {
                self.faults.push(refused(first(&rejection.faults)));
                return None;
            }
        };
        let known = match headings(&text, &self.units) {
            Ok(known) => known,
            Err(fault) => {
                let message = say!("{}: {}", path.value, fault.message);
                self.faults.push(refused(message));
                return None;
            }
        };
        let present = |column: &Column| {
            let here = |h: &crate::recording::Heading| {
                h.text == column.header || h.name == column.header || h.name == column.name
            };
            known.iter().find(|h| here(h)).map(|h| h.text.clone())
        };
        let requests: Vec<Request> = columns
            .iter()
            .filter_map(|column| {
                let content = match column.data {
                    Data::Labels(_) => Content::Labels,
                    _ => Content::Numbers,
                };
                Some(Request {
                    content,
                    ..Request::numbers(&column.name, &present(column)?)
                })
            })
            .collect();
        let recorded = match Recording::read(&path.value, &text, &requests, &self.units) {
            Ok(recorded) => recorded,
            Err(rejection) => {
                let message = say!("{}: {}", path.value, first(&rejection.faults));
                self.faults.push(refused(message));
                return None;
            }
        };
        let mut data = Vec::new();
        for column in columns {
            let own = recorded.column(&column.name);
            let found = match own {
                Some(own) => match (&own.data, &own.unit) {
                    (crate::recording::Data::Labels(labels), _) => {
                        Some(Data::Labels(labels.clone()))
                    }
                    (crate::recording::Data::Numbers(_), Some(_)) => {
                        own.values_in(&column.unit).map(Data::Numbers)
                    }
                    (crate::recording::Data::Numbers(numbers), None) => {
                        Some(Data::Numbers(numbers.clone()))
                    }
                },
                None if complete == Complete::Planned => continued(column, recorded.rows()),
                None => None,
            };
            match found {
                Some(found) => data.push(found),
                None if own.is_some() => {
                    let message = say!(
                        "{}: {} is not in a unit such as {}",
                        path.value,
                        column.name,
                        column.unit.symbol
                    );
                    self.faults.push(refused(message));
                }
                None => {
                    let message = say!("{} has no column \"{}\"", path.value, column.header);
                    self.faults.push(refused(message));
                }
            }
        }
        if data.len() < columns.len() {
            return None;
        }
        let rows = Rows {
            count: recorded.rows(),
            data,
        };
        let finite = |row: &usize| {
            rows.data.iter().all(|data| match data {
                Data::Numbers(numbers) => numbers[*row].is_finite(),
                _ => true,
            })
        };
        let whole: Vec<usize> = (0..rows.count).filter(finite).collect();
        Some(rows.taken(&whole))
    }
}
