//! Rows of the columns of a case that are not those of its recording: a recording that is to be
//! predicted, or a measurement that may follow.

use std::collections::BTreeMap;

use super::{Case, Column, Data, HeldOut};
use crate::diagnose::catalogue::modifiers::{mean, usual};
use crate::diagnose::faults::{MISSING, ROWS};
use crate::experiment::checker::Checker;
use crate::experiment::entries::RoleWord;
use crate::experiment::tables::ExperimentTable;
use crate::recording::{self, Heading, Labels, Recording, Request, headings, text_of};
use gumption_core::quantity::Unit;
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
    /// So many rows of columns.
    pub fn of(columns: &[Column], count: usize) -> Rows {
        Rows {
            count,
            data: columns.iter().map(|column| column.data.clone()).collect(),
        }
    }

    /// These rows alone in the order of `places`.
    #[must_use]
    pub fn taken(&self, places: &[usize]) -> Rows {
        Rows {
            count: places.len(),
            data: self.data.iter().map(|data| data.taken(places)).collect(),
        }
    }
}

impl Data {
    /// These rows alone in the order of `places`.
    pub(super) fn taken(&self, places: &[usize]) -> Data {
        let rows = places.iter();
        self.map(
            |numbers| rows.clone().map(|row| numbers[*row]).collect(),
            |labels| rows.clone().map(|row| labels.of_row[*row]).collect(),
        )
    }

    /// Rows with levels of other labels.
    pub(in crate::diagnose) fn labels(like: &Labels, of_row: Vec<u32>) -> Data {
        let levels = like.levels.clone();
        Data::Labels(Labels { levels, of_row })
    }

    /// Other rows, made of its numbers or of its labels.
    pub(in crate::diagnose) fn map(
        &self,
        numbers: impl FnOnce(&[f64]) -> Vec<f64>,
        labels: impl FnOnce(&Labels) -> Vec<u32>,
    ) -> Data {
        match self {
            Data::Numbers(own) => Data::Numbers(numbers(own)),
            Data::Labels(own) => Data::labels(own, labels(own)),
            Data::Absent => Data::Absent,
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
                (Data::Labels(own), Data::Labels(other)) => {
                    Data::Labels(joined(own, 0, other.texts()))
                }
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
                    Data::Labels(joined(own, own.of_row.len(), other.texts()))
                }
                _ => Data::Absent,
            };
        }
        case
    }
}

/// The first rows of labels and then others, with one list of levels.
pub(super) fn joined<'t>(
    own: &'t Labels,
    kept: usize,
    others: impl Iterator<Item = &'t str>,
) -> Labels {
    let mut levels = own.levels.clone();
    let mut of_row = own.of_row[..kept].to_vec();
    let mut places: BTreeMap<&str, u32> = own.levels.iter().map(String::as_str).zip(0..).collect();
    for text in others {
        of_row.push(*places.entry(text).or_insert_with(|| {
            levels.push(text.to_owned());
            levels.len() as u32 - 1
        }));
    }
    Labels { levels, of_row }
}

/// Numbers of a column that a further measurement does not state: what was recorded goes on.
pub(super) fn continued(column: &Column, count: usize) -> Option<Data> {
    match &column.data {
        Data::Absent => Some(Data::Absent),
        Data::Labels(labels) => {
            let last = *labels.of_row.last()?;
            Some(Data::labels(labels, vec![last; count]))
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
            _ => Some(Data::Numbers(vec![mean(numbers); count])),
        },
    }
}

/// The usual distance of successive rows in time.
pub(in crate::diagnose) fn interval(times: &[f64]) -> f64 {
    let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
    usual(steps).unwrap_or(1.0)
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
                let message = say!("[held_out] has no `file`");
                self.wrong(MISSING, &stated.span, message, say!("`file` is missing"));
            }
            return None;
        };
        let rows = self.rows_of_file(path, columns, |_, _| None)?;
        Some(HeldOut {
            file: path.value.clone(),
            rows,
        })
    }

    /// Reads rows of the columns of a case from another file; `otherwise` gives those of columns that it does not have.
    pub(super) fn rows_of_file(
        &mut self,
        path: &Stated<String>,
        columns: &[Column],
        otherwise: fn(&Column, usize) -> Option<Data>,
    ) -> Option<Rows> {
        let refused = |message: Said| Fault::new(ROWS, path.span.clone(), message);
        match self.read_rows(&path.value, columns, otherwise) {
            Ok(rows) => Some(rows),
            Err(messages) => {
                self.faults.extend(messages.into_iter().map(refused));
                None
            }
        }
    }

    /// Rows of another file, or what is wrong with it.
    fn read_rows(
        &self,
        path: &str,
        columns: &[Column],
        otherwise: fn(&Column, usize) -> Option<Data>,
    ) -> Result<Rows, Vec<Said>> {
        let text = text_of(self.files, &self.folder.join(path), path);
        let text = text.map_err(|rejection| vec![rejection.said()])?;
        let known = headings(&text, &self.units)
            .map_err(|fault| vec![say!("{}: {}", path, fault.message)])?;
        let request = |column: &Column| {
            let is_it = |heading: &&Heading| {
                let names = [&column.header, &column.name];
                heading.text == column.header || names.contains(&&heading.name)
            };
            let heading = known.iter().find(is_it)?;
            Some(match column.data {
                Data::Labels(_) => Request::labels(&column.name, &heading.text),
                _ => Request::numbers(&column.name, &heading.text),
            })
        };
        let requests: Vec<Request> = columns.iter().filter_map(request).collect();
        let recorded = Recording::read(path, &text, &requests, &self.units)
            .map_err(|rejection| vec![say!("{}: {}", path, rejection.said())])?;
        let (mut data, mut wrong) = (Vec::new(), Vec::new());
        for column in columns {
            let (name, unit) = (&column.name, &column.unit.symbol);
            let own = recorded.column(name);
            let found = match own {
                Some(own) => in_unit(own, &column.unit)
                    .ok_or_else(|| say!("{}: {} is not in a unit such as {}", path, name, unit)),
                None => otherwise(column, recorded.rows())
                    .ok_or_else(|| say!("{} has no column \"{}\"", path, column.header)),
            };
            match found {
                Ok(found) => data.push(found),
                Err(message) => wrong.push(message),
            }
        }
        if !wrong.is_empty() {
            return Err(wrong);
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
        Ok(rows.taken(&whole))
    }
}

/// A column of a file in the unit of the case; without a unit it has that one.
fn in_unit(own: &recording::Column, unit: &Unit) -> Option<Data> {
    match (&own.data, &own.unit) {
        (recording::Data::Labels(labels), _) => Some(Data::Labels(labels.clone())),
        (recording::Data::Numbers(_), Some(_)) => own.values_in(unit).map(Data::Numbers),
        (recording::Data::Numbers(numbers), None) => Some(Data::Numbers(numbers.clone())),
    }
}
