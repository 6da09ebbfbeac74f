//! A budget that was read with a row of a table in place, into which the numbers of other rows are written.
//!
//! Most columns replace a value or what one number states of a component. Another number there changes an estimate, or
//! u and the distribution of a component, and nothing else; the file need not be read again for it. A pattern knows the
//! columns of which this is so, and takes a row only where every cell is such a number: whatever else a row holds (an
//! empty cell, a zero that leaves something out, a text, a number that is refused) is for the reader of the file to
//! judge. It has to give the budgets of two rows as that reader does before it takes any.
//!
//! Rows are taken 256 at a time, as columns of numbers.

use std::ops::Range;

use super::Budget;
use super::check::Plain;
use super::components::{Component, Owner};
use super::plain_number::{next_number, plain_number};
use super::rows::Rows;
use super::series::Column;
use super::tables::{ComponentTable, FileTable, InputTable};
use gumption_core::distribution::Distribution;
use gumption_core::quantity::{Conversion, Unit, UnitTable};
use gumption_format::csv::{Cells, Columns, Row};
use gumption_format::toml::{Amount, Stated};
use gumption_lanes::{Block, LANES, level, linear};
use smol_str::SmolStr;

/// A budget, and the numbers in it that columns set.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    budget: Budget,
    /// Of each column, whether it sets numbers; others hold labels, or what is only kept.
    numeric: Vec<bool>,
    /// The inputs whose estimates columns set.
    estimates: Vec<(usize, Number)>,
    restated: Vec<Restated>,
}

/// A number of each row.
#[derive(Debug, Clone, Copy)]
enum Number {
    /// In this column, in its unit.
    In(usize, Option<Conversion>),
    /// The same in every row.
    Always(f64),
}

/// A component that columns state.
#[derive(Debug, Clone)]
struct Restated {
    /// Its index in the budget.
    component: usize,
    plain: Plain,
    amount: Number,
    dof: Number,
}

/// Rows of a table whose cells are numbers, up to 256, and what they make of the budget.
#[derive(Debug)]
pub(crate) struct Numbers {
    /// The cells of each column.
    cells: Vec<Block>,
    /// Marks the rows that are not taken.
    refused: Block,
    rows: Rows,
}

impl Numbers {
    /// What differs between the budgets of the rows that are taken.
    pub fn rows(&self) -> &Rows {
        &self.rows
    }

    /// Whether a row is taken.
    pub fn takes(&self, lane: usize) -> bool {
        self.refused.0[lane] == 0.0
    }

    /// Marks the rows that are not taken.
    pub fn refused(&self) -> &Block {
        &self.refused
    }
}

impl Number {
    fn of_row(self, cells: &[Block], lane: usize) -> f64 {
        match self {
            Number::In(column, None) => cells[column].0[lane],
            Number::In(column, Some(conversion)) => conversion.apply(cells[column].0[lane]),
            Number::Always(number) => number,
        }
    }

    /// Of the first `count` rows.
    fn of_rows(self, cells: &[Block], count: usize, numbers: &mut Block) {
        let numbers = &mut numbers.0[..count];
        match self {
            Number::In(column, None) => numbers.copy_from_slice(&cells[column].0[..count]),
            Number::In(column, Some(conversion)) => {
                for (number, cell) in numbers.iter_mut().zip(&cells[column].0) {
                    *number = conversion.apply(*cell);
                }
            }
            Number::Always(always) => numbers.fill(always),
        }
    }

    /// Marks the rows whose cell, if it is one, is not greater than zero.
    fn refuse_nothing(self, cells: &[Block], refused: &mut Block) {
        if let Number::In(column, _) = self {
            linear::exceed(level(), &cells[column], 0.0, refused);
        }
    }

    /// Whether the cell, if it is one, is greater than zero.
    fn is_positive(self, cells: &[Block], lane: usize) -> bool {
        match self {
            Number::In(column, _) => cells[column].0[lane] > 0.0,
            Number::Always(_) => true,
        }
    }
}

impl Pattern {
    /// Of the budget that a row has given, with the tables of that row; `None` where a column sets more than a number.
    pub(in crate::budget) fn of(
        budget: &Budget,
        file: &FileTable,
        targets: &[Option<Column>],
        row: &Row<'_>,
    ) -> Option<Pattern> {
        let entangled = file.fit.is_some() || file.joint.is_some() || file.claim.is_some();
        let inputs = &file.input.as_ref()?.value.entries;
        if entangled || inputs.iter().any(|(_, input)| input.value.from.is_some()) {
            return None;
        }
        let mut pattern = Pattern {
            budget: budget.clone(),
            numeric: Vec::new(),
            estimates: Vec::new(),
            restated: Vec::new(),
        };
        for target in targets {
            let target = target.as_ref()?;
            if let Column::Path(path) = target {
                pattern.set(path, inputs, file.unit.is_some())?;
            }
            pattern.numeric.push(matches!(target, Column::Path(_)));
        }
        pattern.forget();
        pattern.gives(budget, row).then_some(pattern)
    }

    /// The budget, of which the words hold and not the numbers.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Room for rows.
    pub fn numbers(&self) -> Numbers {
        Numbers {
            cells: vec![Block::ZERO; self.numeric.len()],
            refused: Block([1.0; LANES]),
            rows: Rows::of(&self.budget),
        }
    }

    /// Whether a row gives this budget.
    pub fn gives(&self, budget: &Budget, row: &Row<'_>) -> bool {
        let same = |(one, other): (&Component, &Component)| {
            let Component { name, owner, .. } = one;
            (name, owner) == (&other.name, &other.owner)
                && (one.u, one.dof) == (other.u, other.dof)
                && one.distribution == other.distribution
                && one.unit == other.unit
        };
        let mut numbers = self.numbers();
        self.take(std::iter::once(Some(row)), &mut numbers);
        let mut found = self.budget.clone();
        numbers.takes(0)
            && self.write(0, &numbers, &mut found)
            && found.inputs == budget.inputs
            && found.components.len() == budget.components.len()
            && found.components.iter().zip(&budget.components).all(same)
            && found.groups == budget.groups
            && found.remarks.is_empty() == budget.remarks.is_empty()
            && found.constants == budget.constants
            && found.following == budget.following
            && found.conformity == budget.conformity
            && found.detection == budget.detection
    }

    /// Takes rows, those of which every cell is a number for which the reader of the file is not needed.
    pub fn take<'r>(&self, rows: impl Iterator<Item = Option<&'r Row<'r>>>, numbers: &mut Numbers) {
        let mut count = 0;
        for row in rows {
            let taken = row.is_some_and(|row| {
                let mut fields = row.fields();
                let mut cells = numbers.cells.iter_mut().zip(&self.numeric);
                cells.all(|(cells, numeric)| {
                    let number = match numeric {
                        true => next_number(&mut fields),
                        false => fields.next().map(|_| 0.0),
                    };
                    number.is_some_and(|number| {
                        cells.0[count] = number;
                        true
                    })
                })
            });
            numbers.refused.0[count] = if taken { 0.0 } else { 1.0 };
            count += 1;
        }
        self.restate(count, numbers);
    }

    /// Takes rows of a table in memory, from this one on.
    pub fn take_columns(&self, table: &Columns<'_>, rows: Range<usize>, numbers: &mut Numbers) {
        let Numbers { cells, refused, .. } = numbers;
        refused.0[..rows.len()].fill(0.0);
        let columns = cells.iter_mut().zip(&self.numeric).enumerate();
        for (at, (cells, _)) in columns.filter(|(_, (_, numeric))| **numeric) {
            match table.cells(at) {
                Cells::Numbers(all) => linear::take(level(), &all[rows.clone()], cells, refused),
                Cells::Texts(all) => {
                    for (lane, text) in all[rows.clone()].iter().enumerate() {
                        let number = plain_number(text.trim());
                        cells.0[lane] = number.unwrap_or(f64::NAN);
                        if number.is_none() {
                            refused.0[lane] = 1.0;
                        }
                    }
                }
            }
        }
        self.restate(rows.len(), numbers);
    }

    /// What the cells make of the budget.
    fn restate(&self, count: usize, numbers: &mut Numbers) {
        let Numbers {
            cells,
            refused,
            rows,
        } = numbers;
        for (input, number) in &self.estimates {
            number.of_rows(cells, count, &mut rows.estimates[*input]);
        }
        for one in &self.restated {
            let (u, dof) = (&mut rows.u[one.component], &mut rows.dof[one.component]);
            one.amount.of_rows(cells, count, u);
            one.dof.of_rows(cells, count, dof);
            for number in [one.amount, one.dof] {
                number.refuse_nothing(cells, refused);
            }
            one.plain
                .of_rows(count, (u, dof), &self.budget.conventions, refused);
        }
    }

    /// Writes the numbers of a row that is taken into the budget, or a copy of it; false where there is none.
    pub fn write(&self, lane: usize, numbers: &Numbers, budget: &mut Budget) -> bool {
        for (input, _) in &self.estimates {
            budget.inputs[*input].estimate = numbers.rows.estimates[*input].0[lane];
        }
        self.restated.iter().all(|one| {
            let found = one.of_row(&numbers.cells, lane, &self.budget);
            found.is_some_and(|(u, distribution)| {
                let component = &mut budget.components[one.component];
                component.u = u;
                component.dof = one.dof.of_row(&numbers.cells, lane);
                component.distribution = distribution;
                true
            })
        })
    }

    /// Makes sure that nothing is left of the row from which the pattern was made.
    fn forget(&mut self) {
        for (input, _) in &self.estimates {
            self.budget.inputs[*input].estimate = f64::NAN;
        }
        for one in &self.restated {
            self.budget.components[one.component].u = f64::NAN;
        }
    }

    /// Notes what the column of a path sets; `own_units` where the file has units of its own, by which that of a header may be
    /// meant.
    fn set(
        &mut self,
        path: &[String],
        inputs: &[(SmolStr, Stated<InputTable>)],
        own_units: bool,
    ) -> Option<()> {
        let (name, keys) = match path {
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
            [key] if key == "value" => self.set_estimate(input, &table.value, own_units),
            _ => self.set_statement(input, &table.value, keys, own_units),
        }
    }

    /// A column that sets the value of an input, all of whose components stay as they are.
    fn set_estimate(&mut self, input: usize, table: &InputTable, own_units: bool) -> Option<()> {
        let stays = |one: &ComponentTable| Plain::of(one).is_some();
        let all = match &table.components {
            None => stays(&table.component),
            Some(list) => list.value.iter().all(|one| stays(&one.value)),
        };
        let amount = &table.value.as_ref().filter(|_| all)?.value;
        let conversion = conversion(amount, &self.budget.inputs[input].unit, own_units)?;
        let column = self.numeric.len();
        self.estimates.push((input, Number::In(column, conversion)));
        Some(())
    }

    /// A column that sets a number of a component of an input, to which these keys lead.
    fn set_statement(
        &mut self,
        input: usize,
        table: &InputTable,
        keys: &[String],
        own_units: bool,
    ) -> Option<()> {
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
        let column = self.numeric.len();
        let restated = self.restated(component, plain, conversion);
        match keys {
            keys if keys == number => restated.amount = Number::In(column, conversion),
            [key] if key == "dof" => restated.dof = Number::In(column, None),
            _ => return None,
        }
        Some(())
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

    /// A component among the restated ones.
    fn restated(
        &mut self,
        component: usize,
        plain: Plain,
        conversion: Option<Conversion>,
    ) -> &mut Restated {
        let mut known = self.restated.iter();
        let at = known.position(|one| one.component == component);
        let at = at.unwrap_or_else(|| {
            let number = plain.amount.number;
            let amount = conversion.map_or(number, |conversion| conversion.apply(number));
            self.restated.push(Restated {
                component,
                plain,
                amount: Number::Always(amount),
                dof: Number::Always(self.budget.components[component].dof),
            });
            self.restated.len() - 1
        });
        &mut self.restated[at]
    }
}

impl Restated {
    /// u and the distribution in a row.
    fn of_row(&self, cells: &[Block], lane: usize, budget: &Budget) -> Option<(f64, Distribution)> {
        if !self.is_stated(cells, lane) {
            return None;
        }
        let (amount, dof) = (
            self.amount.of_row(cells, lane),
            self.dof.of_row(cells, lane),
        );
        self.plain.with(amount, dof, &budget.conventions)
    }

    /// Whether a row states more than zero.
    fn is_stated(&self, cells: &[Block], lane: usize) -> bool {
        self.amount.is_positive(cells, lane) && self.dof.is_positive(cells, lane)
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
        let batch = file.batch(&sheet, "table.csv", &[]).expect("columns");
        let rows: Vec<Row> = sheet.rows().map(|row| row.expect("a row")).collect();
        let pattern = batch.pattern(rows.iter(), &sheet).flatten();
        let Some(pattern) = pattern else {
            return vec![false; rows.len().saturating_sub(2)];
        };
        let mut numbers = pattern.numbers();
        pattern.take(rows.iter().map(Some), &mut numbers);
        let reader = batch.reader();
        let taken = |(lane, row): (usize, &Row)| {
            let taken = numbers.takes(lane);
            if taken {
                let mut written = pattern.budget().clone();
                assert!(pattern.write(lane, &numbers, &mut written));
                let read = reader.row(row, &sheet).expect("a budget").budget;
                let numbers_of = |budget: &super::Budget| {
                    let of = |one: &super::Component| (one.u, one.dof, one.distribution.clone());
                    budget.components.iter().map(of).collect::<Vec<_>>()
                };
                assert_eq!(
                    format!("{:?}", written.inputs),
                    format!("{:?}", read.inputs)
                );
                assert_eq!(numbers_of(&written), numbers_of(&read));
                let rows = numbers.rows();
                for (at, one) in read.components.iter().enumerate() {
                    assert_eq!((rows.u[at].0[lane], rows.dof[at].0[lane]), (one.u, one.dof));
                }
                for (at, input) in read.inputs.iter().enumerate() {
                    assert_eq!(rows.estimates[at].0[lane], input.estimate);
                }
            }
            taken
        };
        rows.iter().enumerate().skip(2).map(taken).collect()
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
    fn a_header_that_names_an_input_has_no_unit() {
        let budget = "[measurand.d]\nmodel = \"pH_x - pH_s\"\n[input]\npH_x = { value = 7, u = 0.01 }\npH_s = { value = 7, u = 0.005 }\n";
        let table = "pH_x,pH_s,pH_s.u\n4.02,4.003,0.005\n6.88,6.864,0.004\n9.2,9.182,0.005\n";
        assert_eq!(taken(budget, table), [true]);
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
        // Such rows at the beginning do not matter; the numbers among them are taken with what later ones show.
        let late = "b,b.u\n1,\n0,0.1\n3,0.1\n,0.1\n5,0.2\n6,0.1\n";
        assert_eq!(taken(BUDGET, late), [true, false, true, true]);
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
