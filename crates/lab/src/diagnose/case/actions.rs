//! Further measurements that the user could make.

use super::rows::{Rows, continued, joined};
use super::{Column, Data};
use crate::diagnose::faults::{MISSING, ROWS, SETTING};
use crate::experiment::checker::Checker;
use crate::experiment::entries::RowsEntry;
use crate::experiment::tables::{ActionTable, ExperimentTable, OrderWord};
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;
use gumption_format::toml::{Cell, Named, OneOrMany};

/// A measurement that may follow.
#[derive(Debug, Clone)]
pub struct Extra {
    /// What is done.
    pub measure: Measure,
    /// Effort: one is that of the recording.
    pub cost: f64,
    /// The rows that are recorded.
    pub rows: Rows,
}

/// What is done in a further measurement.
#[derive(Debug, Clone, PartialEq)]
pub enum Measure {
    /// What the case says.
    Own(String),
    /// The same again.
    Again,
    /// The same with the last row first.
    Reversed,
    /// The same with a column at another value.
    Set {
        /// The column.
        column: String,
        /// The value.
        value: f64,
        /// Its unit.
        unit: String,
    },
    /// The same at values half way between those of a column.
    Between(String),
    /// The same with a condition, a column, that varies twice as much, in the opposite sense.
    Opposite(String),
    /// The same with the labels of a column exchanged.
    Exchanged(String),
}

impl Checker<'_> {
    /// The actions of a case with a recording of so many rows.
    pub(super) fn actions(
        &mut self,
        file: &ExperimentTable,
        columns: &[Column],
        rows: usize,
    ) -> Vec<Extra> {
        let list = file.action.iter().flat_map(|list| &list.value.0);
        list.filter_map(|stated| self.action(stated, columns, rows))
            .collect()
    }

    fn action(
        &mut self,
        stated: &Stated<ActionTable>,
        columns: &[Column],
        rows: usize,
    ) -> Option<Extra> {
        let table = &stated.value;
        let cost = table.cost.as_ref();
        if let Some(cost) = cost.filter(|cost| cost.value.is_nan() || cost.value <= 0.0) {
            let expected = say!("expected a positive number");
            self.wrong(SETTING, &cost.span, say!("a cost is positive"), expected);
        }
        let again = table.again.is_some() || table.order.is_some();
        let (Some(name), true) = (&table.name, table.rows.is_some() != again) else {
            if !table.refused {
                let message =
                    say!("a further measurement has a `name` and one of `rows` and `again`");
                self.faults.push(
                    Fault::new(MISSING, stated.span.clone(), message)
                    .label(say!("expected both"))
                    .help(say!("rows = \"more.csv\", rows = {{ x = [1, 2, 3] }}, or again = {{ mount = 90 }} for the rows of the recording once more")),
                );
            }
            return None;
        };
        let rows = match &table.rows {
            Some(entry) => match &entry.value {
                RowsEntry::File(path) => {
                    let path = entry.map(|_| path.clone());
                    self.rows_of_file(&path, columns, continued)?
                }
                RowsEntry::Lists(lists) => self.listed(entry, lists, columns)?,
            },
            None => self.again(table, columns, rows)?,
        };
        Some(Extra {
            measure: Measure::Own(name.value.clone()),
            cost: cost.map_or(1.0, |cost| cost.value),
            rows,
        })
    }

    /// Rows whose columns are lists.
    fn listed(
        &mut self,
        entry: &Stated<RowsEntry>,
        lists: &Named<OneOrMany<Cell>>,
        columns: &[Column],
    ) -> Option<Rows> {
        let before = self.faults.len();
        let lengths = lists.entries.iter().map(|(_, list)| list.value.0.len());
        let count = lengths.max().unwrap_or(0);
        let mut stated: Vec<Option<Data>> = vec![None; columns.len()];
        for (name, list) in &lists.entries {
            let Some(at) = self.column_of(name, list, columns) else {
                continue;
            };
            let cells = &list.value.0;
            if cells.len() != 1 && cells.len() != count {
                let message = say!("{name} has {} values, others {count}", cells.len());
                let expected = say!("expected one value, or as many as the others");
                self.wrong(ROWS, &list.span, message, expected);
                continue;
            }
            let cells = (0..count).map(|row| &cells[row.min(cells.len() - 1)]);
            stated[at] = self.data(&columns[at], cells);
        }
        let mut data = Vec::new();
        for (column, own) in columns.iter().zip(stated) {
            match own.or_else(|| continued(column, count)) {
                Some(own) => data.push(own),
                None if self.faults.len() == before => {
                    let message = say!("the rows do not say what {} is", column.name);
                    let missing = say!("{} is missing", column.name);
                    self.wrong(ROWS, &entry.span, message, missing);
                }
                None => {}
            }
        }
        (self.faults.len() == before).then_some(Rows { count, data })
    }

    /// The rows of the recording once more.
    fn again(&mut self, table: &ActionTable, columns: &[Column], count: usize) -> Option<Rows> {
        let before = self.faults.len();
        let recorded = Rows::of(columns, count);
        let order = table.order.as_ref().map(|order| order.value);
        let reversed = order == Some(OrderWord::Reversed);
        let mut rows = repeated(&recorded, columns, reversed);
        let entries = table.again.as_ref().map_or(&[][..], |t| &t.value.entries);
        for (name, cell) in entries {
            let Some(at) = self.column_of(name, cell, columns) else {
                continue;
            };
            let cells = std::iter::repeat_n(cell, count);
            if let Some(data) = self.data(&columns[at], cells) {
                rows.data[at] = data;
            }
        }
        (self.faults.len() == before).then_some(rows)
    }

    fn column_of<T>(&mut self, name: &str, entry: &Stated<T>, columns: &[Column]) -> Option<usize> {
        let stated = Stated {
            value: name.to_owned(),
            span: entry.key.clone(),
            key: entry.key.clone(),
        };
        self.known(&stated, columns)
    }

    /// Values as a column holds them.
    fn data<'c>(
        &mut self,
        column: &Column,
        cells: impl Iterator<Item = &'c Stated<Cell>>,
    ) -> Option<Data> {
        if let Some(known) = column.labels() {
            let texts = cells.map(|cell| match &cell.value {
                Cell::Text(text) => text.clone(),
                Cell::Number(number) => number.to_string(),
            });
            let texts: Vec<String> = texts.collect();
            let texts = texts.iter().map(String::as_str);
            return Some(Data::Labels(joined(known, 0, texts)));
        }
        let mut numbers = Vec::new();
        for cell in cells {
            let Cell::Number(number) = cell.value else {
                let message = say!("{} holds numbers", column.name);
                let expected = say!("expected a number in {}", column.unit.symbol);
                self.wrong(ROWS, &cell.span, message, expected);
                return None;
            };
            numbers.push(number);
        }
        Some(Data::Numbers(numbers))
    }
}

/// The rows of a recording once more, in the same order or the last one first: what was applied is that
/// of the row, times go on in the same steps after a pause, runs are new ones, and conditions follow the same course as before.
pub(in crate::diagnose) fn repeated(recorded: &Rows, columns: &[Column], reversed: bool) -> Rows {
    use crate::experiment::entries::RoleWord::{
        Count, Covariate, Order, Run, Term, Time, Uncertainty,
    };
    let count = recorded.count;
    let mut places: Vec<usize> = (0..count).collect();
    if reversed {
        places.reverse();
    }
    let mut rows = recorded.taken(&places);
    for ((data, own), column) in rows.data.iter_mut().zip(&recorded.data).zip(columns) {
        match column.role {
            Time => *data = gone_on(own, reversed),
            Order => *data = continued(column, count).unwrap_or(Data::Absent),
            Covariate | Term | Count | Uncertainty => *data = own.clone(),
            Run => renewed(data),
            _ => {}
        }
    }
    rows
}

/// Times in the same steps as before, or in these from the last one on, after a pause as long as the longest.
fn gone_on(recorded: &Data, reversed: bool) -> Data {
    let Data::Numbers(times) = recorded else {
        return recorded.clone();
    };
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return recorded.clone();
    };
    let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
    let pause = steps.filter(|step| *step > 0.0).fold(0.0, f64::max);
    let begin = last + pause;
    let passed = |time: &f64| if reversed { last - time } else { time - first };
    let mut all: Vec<f64> = times.iter().map(|time| begin + passed(time)).collect();
    if reversed {
        all.reverse();
    }
    Data::Numbers(all)
}

/// Other names for runs: numbers go on, and what is no number is primed.
fn renewed(data: &mut Data) {
    let Data::Labels(labels) = data else { return };
    let numbers: Option<Vec<i64>> = labels.levels.iter().map(|l| l.parse().ok()).collect();
    let most = numbers.as_ref().and_then(|all| all.iter().max().copied());
    let next = |at: usize, level: &str| match most.and_then(|most| most.checked_add(1 + at as i64))
    {
        Some(number) => number.to_string(),
        None => format!("{level}′"),
    };
    let levels = labels.levels.iter().enumerate();
    labels.levels = levels.map(|(at, level)| next(at, level)).collect();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Labels;

    #[test]
    fn times_go_on_in_the_steps_that_they_had() {
        let times = Data::Numbers(vec![1.0, 2.0, 7.0, 8.5]);
        let numbers = |data: Data| match data {
            Data::Numbers(numbers) => numbers,
            _ => Vec::new(),
        };
        assert_eq!(numbers(gone_on(&times, false)), [13.5, 14.5, 19.5, 21.0]);
        assert_eq!(numbers(gone_on(&times, true)), [13.5, 15.0, 20.0, 21.0]);
    }

    #[test]
    fn runs_of_a_repetition_are_new_ones() {
        let renewed = |levels: &[&str]| {
            let mut data = Data::Labels(Labels {
                levels: levels.iter().map(|l| (*l).to_owned()).collect(),
                of_row: vec![0, 1],
            });
            renewed(&mut data);
            match data {
                Data::Labels(labels) => labels.levels,
                _ => Vec::new(),
            }
        };
        assert_eq!(renewed(&["1", "3"]), ["4", "5"]);
        assert_eq!(renewed(&["up", "down"]), ["up′", "down′"]);
    }
}
