//! `[series]`: the same budget for a table of values.
//!
//! A column names a place of the file, and each row puts its own values there: the rows are files of their own
//! that are read as if somebody had written them, so that a column may be any number that a budget can state.

mod columns;
mod heads;
mod places;
mod readings;

use std::collections::BTreeSet;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::cell::Entry;
use super::check::states_estimate;
use super::faults::SERIES;
use super::tables::SeriesTable;
use columns::{OWNERS, numbered};
use gumption_fault::{Fault, say};
use gumption_format::toml::{Raw, Stated, amount_parts};
use places::{COMPONENTS, leave_out, set};

pub(super) use columns::{Column, LABEL, column, set_twice, targets};
pub(super) use heads::{Ground, HeadUnit};

/// Where a row stands, and its cells under the heads of their columns.
pub(super) type WrittenRow<'t> = (Range<usize>, Vec<(Stated<Entry>, Raw<'t>)>);

/// The rows of a series. The file with a row in place is made when it is asked for: those of all rows together are some
/// thousand times as large as the table.
pub(super) struct Series<'t> {
    /// Without the series: it would be copied for each of its rows.
    file: DeTable<'t>,
    columns: &'t [Stated<String>],
    targets: Vec<Option<Column>>,
    rows: Vec<WrittenRow<'t>>,
}

impl<'t> Series<'t> {
    /// The file with each row in place, and where the row stands.
    pub fn variants(&self) -> impl ExactSizeIterator<Item = (Range<usize>, Variant<'t>)> {
        let rows = self.rows.iter();
        let naming = self.naming();
        rows.map(move |(place, cells)| {
            // What can be wrong with them has been looked for.
            let mut faults = Vec::new();
            let mut row = variant(&self.file, self.columns, &self.targets, cells, &mut faults);
            if let Some((column, unit)) = &naming {
                row.label = Some(amount(&cells[*column].0.value, unit));
            }
            (place.clone(), row)
        })
    }

    /// Where no column is of labels, the first quantity that differs from row to row names them: its column and unit.
    fn naming(&self) -> Option<(usize, String)> {
        let of_labels = |target: &Option<Column>| matches!(target, Some(Column::Label));
        if self.targets.iter().any(of_labels) {
            return None;
        }
        let differs = |column: usize| {
            let cells = self.rows.iter().map(|(_, cells)| &cells[column].0.value);
            let texts: BTreeSet<String> = cells.map(label).collect();
            texts.len() == self.rows.len() && texts.len() > 1
        };
        let mut columns = self.targets.iter().enumerate();
        columns.find_map(|(column, target)| match target {
            Some(Column::Path(path)) if differs(column) => {
                unit_of_value(&self.file, path).map(|unit| (column, unit))
            }
            _ => None,
        })
    }
}

/// The unit that a file states for what a path is the value of; empty for none.
fn unit_of_value(file: &DeTable<'_>, path: &[String]) -> Option<String> {
    let [owner, name, key @ ..] = path else {
        return None;
    };
    let is_value = matches!(key, []) || matches!(key, [key] if key == "value");
    let is_owned = OWNERS.contains(&owner.as_str());
    let unit = || match columns::entry(file, owner, name)?.get_ref() {
        DeValue::Table(entry) => match entry.get("unit")?.get_ref() {
            DeValue::String(unit) => Some(unit.to_string()),
            _ => None,
        },
        _ => None,
    };
    (is_value && is_owned).then(|| unit().unwrap_or_default())
}

/// A cell as the name of its row: a text has its unit with it.
fn amount(cell: &Entry, unit: &str) -> String {
    match cell {
        Entry::Number(number) if !unit.is_empty() => format!("{number} {unit}"),
        cell => label(cell),
    }
}

/// One row: its label, and the file with its values in place.
pub(super) struct Variant<'t> {
    pub label: Option<String>,
    pub table: DeTable<'t>,
}

/// The rows of the series of a file, below its columns; nothing where it is faulty.
pub(super) fn series<'t>(
    file: &DeTable<'t>,
    stated: &Stated<SeriesTable>,
    (columns, rows): (&'t [Stated<String>], Vec<WrittenRow<'t>>),
    faults: &mut Vec<Fault>,
) -> Option<Series<'t>> {
    let before = faults.len();
    let table = &stated.value;
    let targets = targets(file, columns, faults);
    if rows.is_empty() {
        faults.push(
            Fault::new(SERIES, stated.span.clone(), say!("the series has no rows"))
                .label(say!("nothing to evaluate")),
        );
    }
    let mut alone = file.clone();
    alone.remove("series");
    for (place, cells) in &rows {
        if cells.len() != targets.len() {
            let message = say!(
                "a row of {} entries for {} columns",
                cells.len(),
                targets.len()
            );
            let fault = Fault::new(SERIES, place.clone(), message)
                .label(say!("expected {} entries", targets.len()));
            faults.push(match &table.columns {
                Some(columns) => fault.related(columns.span.clone(), say!("the columns")),
                None => fault,
            });
            continue;
        }
        variant(&alone, columns, &targets, cells, faults);
    }
    (faults.len() == before).then_some(Series {
        file: alone,
        columns,
        targets,
        rows,
    })
}

/// The file, which has no series, with the cells of a row in the places that its columns set.
pub(super) fn variant<'t>(
    file: &DeTable<'t>,
    names: &[Stated<String>],
    targets: &[Option<Column>],
    cells: &[(Stated<Entry>, Raw<'t>)],
    faults: &mut Vec<Fault>,
) -> Variant<'t> {
    let mut variant = Variant {
        label: None,
        table: file.clone(),
    };
    let mut left_out: Vec<&[String]> = Vec::new();
    let mut estimates: Vec<&[String]> = Vec::new();
    let mut missing = Vec::new();
    for ((target, name), (cell, raw)) in targets.iter().zip(names).zip(cells) {
        match target {
            Some(Column::Label) => variant.label = Some(label(&cell.value)),
            // All of a list together, below.
            Some(Column::Path(path)) if numbered(path).is_some() => {}
            Some(Column::Path(path)) if is_left_out(&cell.value, path) && is_element(path) => {
                faults.push(missing_element(name, cell));
            }
            Some(Column::Path(path)) if is_left_out(&cell.value, path) => {
                left_out.push(path);
                if is_value(path) {
                    missing.push((path, name, cell));
                }
            }
            Some(Column::Path(path)) => {
                set(&mut variant.table, path, name, cell, raw, faults);
                estimates.extend(gives_estimate(path).then_some(path.as_slice()));
            }
            Some(Column::Kept) | None => {}
        }
    }
    for list in readings::readings(names, targets, cells) {
        let place = list.place();
        match list.write(&mut variant.table, faults) {
            true => estimates.push(place),
            false => left_out.push(place),
        }
    }
    leave_out(&mut variant.table, &left_out);
    // What the budget says of an input in general, such as readings that tell its repeatability, gives no value of the row.
    let is_of_budget = |path: &[String]| {
        let of_row = estimates.iter().any(|given| given[..2] == path[..2]);
        !of_row && columns::has_estimate(&variant.table, path)
    };
    let missing = missing.into_iter().filter(|(path, ..)| is_of_budget(path));
    faults.extend(missing.map(|(_, name, cell)| missing_value(name, cell)));
    variant
}

/// Whether a column sets the value of an input or a constant.
fn is_value(path: &[String]) -> bool {
    match path {
        [owner, _, key] => OWNERS.contains(&owner.as_str()) && key == "value",
        [owner, _] => OWNERS.contains(&owner.as_str()),
        _ => false,
    }
}

/// Whether a column gives its row an estimate, as readings do.
fn gives_estimate(path: &[String]) -> bool {
    // As a text it is the shape of limits that stand beside it.
    let (keys, shape) = (path.get(2..).unwrap_or_default(), "distribution");
    keys.iter().any(|key| key != shape && states_estimate(key))
}

fn missing_value(name: &Stated<String>, cell: &Stated<Entry>) -> Fault {
    let message = say!("the value of {} is missing", name.value);
    Fault::new(SERIES, cell.span.clone(), message)
        .label(say!("an empty cell"))
        .help(say!(
            "state it in every row: what the budget states, such as readings, gives no value of this row"
        ))
}

/// Whether a cell leaves out what its column names: an empty one, and an uncertainty of zero.
fn is_left_out(cell: &Entry, path: &[String]) -> bool {
    const DEVIATIONS: [&str; 4] = ["u", "U", "half_width", "step"];
    let owned = path
        .first()
        .is_some_and(|owner| OWNERS.contains(&owner.as_str()));
    let deviation = path
        .last()
        .is_some_and(|key| DEVIATIONS.contains(&key.as_str()));
    let is_none = |number: f64| number == 0.0 && deviation && owned;
    match cell {
        Entry::Text(text) => {
            text.is_empty() || amount_parts(text).is_some_and(|(number, _)| is_none(number))
        }
        Entry::Number(number) => is_none(*number),
        Entry::List => false,
    }
}

/// Whether a path leads to an element of a list: an end of limits, a value of a vector.
fn is_element(path: &[String]) -> bool {
    let [.., list, element] = path else {
        return false;
    };
    element.parse::<usize>().is_ok() && list != COMPONENTS
}

fn missing_element(name: &Stated<String>, cell: &Stated<Entry>) -> Fault {
    let message = say!(
        "{} is missing, and no element of a list is left out",
        name.value
    );
    Fault::new(SERIES, cell.span.clone(), message)
        .label(say!("an empty cell"))
        .help(say!("state it in every row"))
}

fn label(cell: &Entry) -> String {
    match cell {
        Entry::Text(text) => text.clone(),
        Entry::Number(number) => number.to_string(),
        Entry::List => "[…]".into(),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::budget::{Budget, Figure, read};

    const FILE: &str = r#"
[measurand.Y]
model = "c * X + V"
unit = "V"
[constant]
c = "2 V"
[input.X]
value = 1
u = 0.1
[input.V]
value = 1
unit = "V"
components = [
  { name = "scatter", readings = [1, 2, 3] },
  { name = "calibration", certificate = { U = 0.2, k = 2 } },
]
[[claim]]
k = 2
[[claim]]
method = "second-order"
inputs."V.scatter" = { u = 0.5 }
"#;

    fn with(columns: &str, rows: &str) -> String {
        format!("{FILE}[series]\ncolumns = [{columns}]\nrows = [{rows}]\n")
    }

    #[track_caller]
    fn rows(columns: &str, cells: &str) -> Vec<Budget> {
        match read(&with(columns, cells), "budget.toml", Path::new("")) {
            Ok(loaded) => loaded.rows.into_iter().map(|row| row.budget).collect(),
            Err(rejection) => panic!("{}", rejection.render(false)),
        }
    }

    fn message(columns: &str, cells: &str) -> String {
        match read(&with(columns, cells), "budget.toml", Path::new("")) {
            Ok(_) => panic!("accepted"),
            Err(rejection) => rejection.render(false),
        }
    }

    #[test]
    fn a_column_may_be_any_number_of_the_file() {
        let found = rows(
            r#""X.dof", "conventions.coverage_probability", "V.calibration.certificate.U""#,
            "[4, 0.9, 0.4], [9, 0.99, 0.6]",
        );
        assert_eq!(found[0].components[0].dof, 4.0);
        assert_eq!(found[1].components[0].dof, 9.0);
        assert_eq!(found[1].conventions.coverage_probability, 0.99);
        let calibration = |budget: &Budget| {
            let component = budget.components.iter().find(|c| c.name == "V.calibration");
            component.expect("a component of that name").u
        };
        assert_eq!([calibration(&found[0]), calibration(&found[1])], [0.2, 0.3]);
    }

    #[test]
    fn an_element_of_a_list_is_named_by_its_place() {
        let found = rows(
            r#""V.components.2.certificate.U", "claim.k", "claim.2.inputs.\"V.scatter\".u""#,
            "[0.3, 2, 0.58], [0.5, 3, 1.53]",
        );
        assert_eq!(found[1].components[2].u, 0.25);
        let factor = found[1].claims[0].figure(&Figure::CoverageFactor);
        assert_eq!(factor, Some(3.0));
        assert_eq!(found[1].claims[1].figures[0].value, 1.53);
        assert!(message(r#""V.components.3.u""#, "[1]").contains("the list has 2"));
    }

    /// The readings of a row are those of its columns, in the order of their numbers: none of the file, and none for an empty cell.
    #[test]
    fn readings_stand_in_columns_of_their_own() {
        let columns = r#""V.scatter.readings.2", "V.scatter.readings.1", "V.scatter.readings.4""#;
        let found = rows(columns, r#"[1, 2, 6], [5, 3, ""], [4, 4, 1]"#);
        let u = |row: usize| found[row].components[1].u;
        let s_over_root_n = |readings: &[f64]| {
            let n = readings.len() as f64;
            let mean = readings.iter().sum::<f64>() / n;
            let squares: f64 = readings.iter().map(|x| (x - mean) * (x - mean)).sum();
            (squares / (n - 1.0) / n).sqrt()
        };
        for (row, readings) in [&[2.0, 1.0, 6.0][..], &[3.0, 5.0], &[4.0, 4.0, 1.0]]
            .into_iter()
            .enumerate()
        {
            assert!((u(row) - s_over_root_n(readings)).abs() < 1e-12, "{row}");
        }
    }

    #[test]
    fn a_constant_keeps_its_unit() {
        let found = rows(r#""c", "input.X.value""#, "[3, 5]");
        assert_eq!(found[0].constants[0].values, [3.0]);
        assert_eq!(found[0].constants[0].unit.symbol, "V");
        assert_eq!(found[0].inputs[0].estimate, 5.0);
    }

    #[test]
    fn an_amount_keeps_its_unit() {
        let file = r#"
[measurand.Y]
model = "t - t0"
unit = "K"
[constant]
t0 = "20 °C"
[input.t]
value = "20.5 °C"
half_width = "300 mK"
[conformity]
mpe = "500 mK"
rule = "simple"
[series]
columns = ["t0", "t", "t.half_width", "conformity.mpe"]
rows = [[21, 22.5, 600, 4e2], ["294.15 K", "296 K", "0.9 K", "1 K"]]
"#;
        let loaded = read(file, "budget.toml", Path::new("")).expect("a budget");
        let [own, others] = [0, 1].map(|row| &loaded.rows[row].budget);
        let close = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-12, "{found}");
        close(own.constants[0].values[0], 21.0);
        close(own.inputs[0].estimate, 22.5);
        close(own.components[0].u, 0.6 / 3f64.sqrt());
        close(own.conformity[0].tolerance.upper, 0.4);
        close(others.components[0].u, 0.9 / 3f64.sqrt());
        close(others.conformity[0].tolerance.upper, 1.0);
    }

    #[test]
    fn a_head_may_state_the_unit_of_its_numbers() {
        let file = r#"
[measurand.Y]
model = "t - t0"
unit = "K"
[constant]
t0 = "20 °C"
[input.t]
unit = "°C"
value = 20.5
half_width = "300 mK"
[series]
columns = ["label", "t [K]", "t.half_width [mK]"]
rows = [["a", 295.65, 600], ["b", "296 K", "0.9 K"]]
"#;
        let loaded = read(file, "budget.toml", Path::new("")).expect("a budget");
        let [one, other] = [0, 1].map(|row| &loaded.rows[row].budget);
        let close = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-9, "{found}");
        close(one.inputs[0].estimate, 22.5);
        close(one.components[0].u, 0.6 / 3f64.sqrt());
        close(other.components[0].u, 0.9 / 3f64.sqrt());
        let unknown = file.replace("t [K]", "t [parsec]");
        let refused = read(&unknown, "budget.toml", Path::new("")).expect_err("no unit");
        let place = refused.faults[0].span.clone();
        assert_eq!((&unknown[place], refused.faults.len()), ("parsec", 1));
    }

    #[test]
    fn an_uncertainty_of_zero_is_left_out_in_any_unit() {
        let file = |column: &str, cell: &str| {
            format!(
                "[measurand.Y]\nmodel = \"V\"\nunit = \"V\"\n[input.V]\nvalue = 1\nunit = \"V\"\ncomponents = [{{ name = \"a\", u = 1 }}, {{ name = \"b\", u = 2 }}]\n[series]\ncolumns = [\"label\", \"{column}\"]\nrows = [[\"one\", 3], [\"other\", {cell}]]\n"
            )
        };
        for (column, cell) in [
            ("V.b.u", "0"),
            ("V.b.u [mV]", "0"),
            ("V.b.u", "\"0 mV\""),
            ("V.b.u [mV]", "\"\""),
        ] {
            let loaded = read(&file(column, cell), "budget.toml", Path::new(""));
            let loaded = loaded.expect("a budget");
            let counts = [0, 1].map(|row| loaded.rows[row].budget.components.len());
            assert_eq!(counts, [2, 1], "{column}, {cell}");
        }
    }

    /// Lists of numbers have no units of their own: those under a head with a unit are converted to that of their quantity.
    #[test]
    fn a_head_may_state_the_unit_of_lists() {
        let file = r#"
[unit]
lsb = "0.5 mV"
[measurand.Y]
model = "sum(X) + V + W"
unit = "mV"
[input.X]
unit = "mV"
values = [1, 2]
[input.V]
unit = "V"
[input.W]
unit = "V"
[series]
columns = ["X [V]", "X.u [µV]", "V.readings [lsb]", "W.groups [mV]"]
rows = [[[0.003, 0.004], 5, [1_000, 1002, 1e3], [[1, 2], [3, 4]]]]
"#;
        let loaded = read(file, "budget.toml", Path::new("")).expect("a budget");
        let budget = &loaded.rows[0].budget;
        let close = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-12, "{found}");
        let estimates: Vec<f64> = budget.inputs.iter().map(|input| input.estimate).collect();
        let thirds = (1000.0 + 1002.0 + 1000.0) / 3.0;
        for (found, wanted) in estimates.into_iter().zip([3.0, 4.0, thirds * 5e-4, 2.5e-3]) {
            close(found, wanted);
        }
        close(budget.components[0].u, 5e-3);
        // s = 2/√3 of the readings, over √3.
        close(budget.components[2].u, 2.0 / 3.0 * 5e-4);
        let refused = file.replace("V.readings [lsb]", "V.readings [kg]");
        let refused = read(&refused, "budget.toml", Path::new("")).expect_err("no unit");
        assert!(
            refused
                .render(false)
                .contains("V.readings is in kg, which is no unit like V")
        );
    }

    #[test]
    fn an_unknown_path_is_answered_with_the_nearest() {
        assert!(message(r#""X.dfo""#, "[1]").contains("did you mean `dof`?"));
        assert!(message(r#""u(X)""#, "[1]").contains("is the column `X.u`"));
        assert!(message(r#""U_X""#, "[1]").contains("is the column `X.certificate.U`"));
        assert!(message(r#""X，V""#, "[1]").contains("separated by a comma"));
        assert!(message(r#""x.dof""#, "[1]").contains("did you mean \"X.dof\"?"));
        assert!(
            message(r#""conventoins.digits""#, "[1]")
                .contains("did you mean \"conventions.digits\"?")
        );
        assert!(message(r#""X.value.deeper""#, "[1]").contains("goes beyond a number"));
        assert!(message(r#""X""#, "[\"much\"]").contains("where a number is expected"));
        assert!(message(r#""X.limits.1""#, "[\"\"]").contains("no element of a list is left out"));
        assert!(
            message(
                r#""V.scatter.readings", "V.scatter.readings.1""#,
                "[[1, 2], 3]"
            )
            .contains("two columns set the same")
        );
    }
}
