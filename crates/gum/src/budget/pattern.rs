//! A budget that was read with a row of a table in place, into which the numbers of other rows are written.
//!
//! Most columns replace a value or what one number states of a component. Another number there changes an estimate, or
//! u and the distribution of a component, and nothing else; the file need not be read again for it. A pattern knows the
//! columns of which this is so, and takes a row only where every cell is such a number: whatever else a row holds (an
//! empty cell, a zero that leaves something out, a text, a number that is refused) is for the reader of the file to
//! judge. It has to give the budgets of two rows as that reader does before it takes any.

use super::Budget;
use super::check::Plain;
use super::components::{Component, Owner};
use super::points::plain_number;
use super::rows::Rows;
use super::series::Column;
use super::tables::{ComponentTable, FileTable, InputTable};
use gumption_core::quantity::{Conversion, Unit, UnitTable};
use gumption_format::csv::{Row, Sheet};
use gumption_format::toml::{Amount, Stated};

/// A budget, and the numbers in it that columns set.
#[derive(Debug)]
pub(super) struct Pattern {
    budget: Budget,
    cells: Vec<Cell>,
    restated: Vec<Restated>,
}

/// What a column sets.
#[derive(Debug)]
enum Cell {
    Label,
    /// The estimate of this input.
    Estimate(usize, Option<Conversion>),
    /// The number that states this one of the restated components.
    Amount(usize, Option<Conversion>),
    /// Its degrees of freedom.
    Freedom(usize),
}

/// A component that columns state.
#[derive(Debug)]
struct Restated {
    /// Its index in the budget.
    component: usize,
    plain: Plain,
    amount: f64,
    dof: f64,
}

impl Pattern {
    /// Of the budget that a row has given, with the tables of that row; `None` where a column sets more than a number.
    pub fn of(
        budget: &Budget,
        file: &FileTable,
        targets: &[Option<Column>],
        (row, sheet): (&Row, &Sheet<'_>),
    ) -> Option<Pattern> {
        let entangled = file.fit.is_some() || file.joint.is_some() || file.claim.is_some();
        let inputs = &file.input.as_ref()?.value.entries;
        if entangled || inputs.iter().any(|(_, input)| input.value.from.is_some()) {
            return None;
        }
        let mut pattern = Pattern {
            budget: budget.clone(),
            cells: Vec::new(),
            restated: Vec::new(),
        };
        for target in targets {
            let cell = pattern.cell(target.as_ref()?, inputs, file.unit.is_some())?;
            pattern.cells.push(cell);
        }
        pattern.forget();
        pattern.gives(budget, row, sheet).then_some(pattern)
    }

    /// The budget as the last row that was taken has it.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Whether a row gives this budget.
    pub fn gives(&mut self, budget: &Budget, row: &Row, sheet: &Sheet<'_>) -> bool {
        let same = |(one, other): (&Component, &Component)| {
            let Component { name, owner, .. } = one;
            (name, owner) == (&other.name, &other.owner)
                && (one.u, one.dof) == (other.u, other.dof)
                && one.distribution == other.distribution
                && one.unit == other.unit
        };
        self.take(row, sheet)
            && self.budget.inputs == budget.inputs
            && self.budget.components.len() == budget.components.len()
            && self
                .budget
                .components
                .iter()
                .zip(&budget.components)
                .all(same)
            && self.budget.groups == budget.groups
            && self.budget.constants == budget.constants
            && self.budget.following == budget.following
            && self.budget.conformity == budget.conformity
            && self.budget.detection == budget.detection
    }

    /// Writes the numbers of a row into the budget; false where a cell is for the reader of the file.
    pub fn take(&mut self, row: &Row, sheet: &Sheet<'_>) -> bool {
        for (cell, field) in self.cells.iter().zip(row.fields()) {
            if matches!(cell, Cell::Label) {
                continue;
            }
            let Some(number) = plain_number(field, sheet) else {
                return false;
            };
            let converted = |conversion: &Option<Conversion>| match conversion {
                Some(conversion) => conversion.apply(number),
                None => number,
            };
            match cell {
                Cell::Label => {}
                Cell::Estimate(input, conversion) => {
                    self.budget.inputs[*input].estimate = converted(conversion);
                }
                Cell::Amount(at, conversion) if number > 0.0 => {
                    self.restated[*at].amount = converted(conversion);
                }
                Cell::Freedom(at) if number > 0.0 => self.restated[*at].dof = number,
                Cell::Amount(..) | Cell::Freedom(_) => return false,
            }
        }
        for one in &self.restated {
            let found = one
                .plain
                .with(one.amount, one.dof, &self.budget.conventions);
            let Some((u, distribution)) = found else {
                return false;
            };
            let component = &mut self.budget.components[one.component];
            component.u = u;
            component.dof = one.dof;
            component.distribution = distribution;
        }
        true
    }

    /// Writes the numbers of the row that was taken last into a row of a block.
    pub fn write(&self, lane: usize, rows: &mut Rows) {
        for cell in &self.cells {
            if let Cell::Estimate(input, _) = cell {
                rows.estimates[*input].0[lane] = self.budget.inputs[*input].estimate;
            }
        }
        for one in &self.restated {
            let component = &self.budget.components[one.component];
            rows.u[one.component].0[lane] = component.u;
            rows.dof[one.component].0[lane] = component.dof;
        }
    }

    /// Makes sure that nothing is left of the row from which the pattern was made.
    fn forget(&mut self) {
        for cell in &self.cells {
            match cell {
                Cell::Label => {}
                Cell::Estimate(input, _) => self.budget.inputs[*input].estimate = f64::NAN,
                Cell::Amount(at, _) => self.restated[*at].amount = f64::NAN,
                Cell::Freedom(at) => self.restated[*at].dof = f64::NAN,
            }
        }
        for one in &self.restated {
            self.budget.components[one.component].u = f64::NAN;
        }
    }

    /// What a column sets; `own_units` where the file has units of its own, by which that of a header may be meant.
    fn cell(
        &mut self,
        target: &Column,
        inputs: &[(String, Stated<InputTable>)],
        own_units: bool,
    ) -> Option<Cell> {
        let path = match target {
            Column::Label => return Some(Cell::Label),
            Column::Path(path) => path,
        };
        let (name, keys) = match path.as_slice() {
            [owner, name, keys @ ..] if owner == "input" => (name, keys),
            _ => return None,
        };
        let (_, table) = inputs.iter().find(|(one, _)| one == name)?;
        let input = self
            .budget
            .inputs
            .iter()
            .position(|input| input.name == *name)?;
        // What is relative to the estimate follows it; of an estimate of zero this is not seen.
        let follows = self.budget.following.iter().any(|one| one.input == input);
        if table.value.refused || follows || self.budget.inputs[input].estimate == 0.0 {
            return None;
        }
        match keys {
            [key] if key == "value" => self.estimate(input, &table.value, own_units),
            _ => self.statement(input, &table.value, keys, own_units),
        }
    }

    /// A column that sets the value of an input, all of whose components stay as they are.
    fn estimate(&self, input: usize, table: &InputTable, own_units: bool) -> Option<Cell> {
        let stays = |one: &ComponentTable| Plain::of(one).is_some();
        let all = match &table.components {
            None => stays(&table.component),
            Some(list) => list.value.iter().all(|one| stays(&one.value)),
        };
        let amount = &table.value.as_ref().filter(|_| all)?.value;
        let conversion = conversion(amount, &self.budget.inputs[input].unit, own_units)?;
        Some(Cell::Estimate(input, conversion))
    }

    /// A column that sets a number of a component of an input, to which these keys lead.
    fn statement(
        &mut self,
        input: usize,
        table: &InputTable,
        keys: &[String],
        own_units: bool,
    ) -> Option<Cell> {
        let (stated, label, keys) = match &table.components {
            None => (&table.component, None, keys),
            Some(list) => {
                let (label, keys) = keys.split_first()?;
                (called(&list.value, label)?, Some(label), keys)
            }
        };
        let (plain, number) = Plain::of(stated)?;
        let component = self.component(input, label)?;
        let unit = self.budget.inputs[input].unit.difference();
        let conversion = conversion(&plain.amount, &unit, own_units)?;
        let at = self.restated(component, plain, conversion);
        match keys {
            keys if keys == number => Some(Cell::Amount(at, conversion)),
            [key] if key == "dof" => Some(Cell::Freedom(at)),
            _ => None,
        }
    }

    /// The only component of an input, or the only one of this label, where it is correlated with no other.
    fn component(&self, input: usize, label: Option<&String>) -> Option<usize> {
        let components = self.budget.components.iter().enumerate();
        let mut own = components.filter(|(_, component)| {
            component.owner == Owner::Input(input)
                && label.is_none_or(|label| component.label == *label)
        });
        let (only, None) = (own.next()?.0, own.next()) else {
            return None;
        };
        let mut groups = self.budget.groups.iter();
        (!groups.any(|group| group.members.contains(&only))).then_some(only)
    }

    /// The place of a component among the restated ones.
    fn restated(
        &mut self,
        component: usize,
        plain: Plain,
        conversion: Option<Conversion>,
    ) -> usize {
        let known = self
            .restated
            .iter()
            .position(|one| one.component == component);
        known.unwrap_or_else(|| {
            let number = plain.amount.number;
            self.restated.push(Restated {
                component,
                plain,
                amount: conversion.map_or(number, |conversion| conversion.apply(number)),
                dof: self.budget.components[component].dof,
            });
            self.restated.len() - 1
        })
    }
}

/// The only component of a list that is called so; none where a resolution, as it may be part of the scatter of readings
/// beside it.
fn called<'f>(list: &'f [Stated<ComponentTable>], label: &str) -> Option<&'f ComponentTable> {
    let is_called = |one: &&Stated<ComponentTable>| {
        let name = one.value.name.as_ref();
        name.is_some_and(|name| name.value == label)
    };
    let mut called = list.iter().filter(is_called);
    let (only, None) = (called.next()?, called.next()) else {
        return None;
    };
    Some(&only.value).filter(|one| one.step.is_none())
}

/// How the numbers of a column become those of a unit; nothing is to be done where they are written without one.
fn conversion(amount: &Amount, into: &Unit, own_units: bool) -> Option<Option<Conversion>> {
    match &amount.unit {
        None => Some(None),
        Some(_) if own_units => None,
        Some((own, _)) => plain_conversion(own, into).map(Some),
    }
}

/// How numbers in a unit become numbers in another, where nothing is to be asked: not of ratios, nor of scales with an
/// origin.
fn plain_conversion(own: &str, into: &Unit) -> Option<Conversion> {
    let own = UnitTable::default().parse(own).ok()?;
    let plain = !own.dimension.is_none() && !own.is_point() && !into.is_point();
    own.conversion_to(into).filter(|_| plain)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::budget::{BatchFile, Files};
    use gumption_format::csv::{Row, Sheet};

    const BUDGET: &str = r#"
[measurand.y]
model = "a * b + c"
unit = "V"
[input.a]
value = 1
unit = "V"
components = [
  { name = "cal", certificate = { U = 0.02, k = 2 } },
  { name = "drift", half_width = 0.01, distribution = "triangular", dof = 12 },
]
[input.b]
value = 2
u = 0.1
dof = 9
[input.c]
value = 3
unit = "V"
step = 0.1
"#;

    /// Whether the rows after the second are taken as numbers.
    fn taken(budget: &str, table: &str) -> Vec<bool> {
        let files = [("budget.toml", budget.as_bytes())];
        let file = BatchFile::open(Files::Library(&files), Path::new("budget.toml"), None);
        let file = file.expect("a text");
        let sheet = Sheet::new(table).expect("a table");
        let batch = file.batch(&sheet, "table.csv").expect("columns");
        let mut reader = batch.reader();
        let mut take = |(at, row): (usize, Result<Row, gumption_fault::Fault>)| {
            let row = row.expect("a row");
            let taken = reader.takes(&row, &sheet);
            if taken {
                let numbers = format!("{:?}", reader.numbers().expect("a budget").inputs);
                let read = reader.row(&row, &sheet).expect("a budget").budget;
                let numbers_of = |budget: &super::Budget| {
                    let of = |one: &super::Component| (one.u, one.dof, one.distribution.clone());
                    budget.components.iter().map(of).collect::<Vec<_>>()
                };
                assert_eq!(numbers, format!("{:?}", read.inputs));
                let taken = reader.numbers().expect("a budget");
                assert_eq!(numbers_of(taken), numbers_of(&read));
            } else {
                // What is wrong with it is told elsewhere.
                let _ = reader.row(&row, &sheet);
            }
            (at, taken)
        };
        let found: Vec<(usize, bool)> = sheet.rows().enumerate().map(&mut take).collect();
        found.into_iter().skip(2).map(|(_, taken)| taken).collect()
    }

    #[test]
    fn numbers_are_taken() {
        let head = "label,a [mV],a.cal.certificate.U [mV],a.drift.half_width,a.drift.dof,b,b.u,b.dof,c,c.step";
        let rows = "A,1500,20,0.01,5,2,0.1,9,3,0.1\nB,1400,10.5,0.02,5.5,-2,1e-2,8,0.5,0.01\n";
        let more = "C,1e3,3,1.5e-2,100,1,0.5,3.5,-4.25,1\nD,0.001,0.3,1,1,1,1,1,0,1\n";
        let table = format!("{head}\n{rows}{more}");
        assert_eq!(taken(BUDGET, &table), [true, true]);
    }

    #[test]
    fn what_is_more_than_a_number_is_read() {
        let table =
            |cells: &[&str]| format!("b,b.u,c\n1,0.1,3\n2,0.2,4\n{}\n3,0.1,5\n", cells.join("\n"));
        let cells = [
            "1,0,3",
            "1,,3",
            "-0,0.1,3",
            "1,-0.1,3",
            "1,1 V,3",
            "1,1e999,3",
            "01,1,3",
            "1_0,1,3",
        ];
        let found = taken(BUDGET, &table(&cells));
        assert_eq!(found[..cells.len()], [false; 8]);
        assert!(found[cells.len()], "a number again");
        // Such rows at the beginning do not matter.
        let late = "b,b.u\n1,\n0,0.1\n3,0.1\n,0.1\n5,0.2\n6,0.1\n";
        assert_eq!(taken(BUDGET, late), [false, false, false, true]);
        let never = |budget: &str, columns: &str| {
            let row = vec!["1.5"; columns.split(',').count()].join(",");
            let table = format!("{columns}\n{row}\n{row}\n{row}\n");
            assert_eq!(taken(budget, &table), [false], "{columns}");
        };
        // u follows the value; the columns of others are plain, but not all.
        let relative = format!(
            "{}[input.d]\nvalue = 1\nrelative = true\nu = 0.001\n",
            BUDGET
        );
        let relative = relative.replace("+ c", "+ c * d");
        never(&relative, "d");
        never(&relative, "b,d");
        assert_eq!(taken(&relative, "b\n1\n2\n3\n"), [true]);
        never(BUDGET, "conventions.coverage_probability");
        // A resolution beside readings may be absorbed by them.
        let readings = "components = [{ readings = [1, 2, 4] }, { name = \"q\", step = 0.1 }]";
        let readings = BUDGET
            .replace("value = 3", "")
            .replace("step = 0.1", readings);
        never(&readings, "c.q.step");
        let correlated = format!(
            "{}[[correlation]]\nbetween = [\"b\", \"c\"]\nr = 0.5\n",
            BUDGET
        );
        never(&correlated, "b.u");
        assert_eq!(taken(&correlated, "b\n1\n2\n3\n"), [true]);
    }
}
