//! `[series]`: the same budget for a table of values.
//!
//! A column names a place of the file, and each row puts its own values there: the rows are files of their own
//! that are read as if somebody had written them, so that a column may be any number that a budget can state.

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::cell::Entry;
use super::faults::{SERIES, UNKNOWN_NAME};
use super::points::Points;
use super::tables::{FileTable, SeriesTable};
use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::amount_parts;
use gumption_format::toml::{Raw, Stated, Table};

/// Where a row stands, and its cells under the heads of their columns.
type WrittenRow<'t> = (std::ops::Range<usize>, Vec<(Stated<Entry>, Raw<'t>)>);

/// The rows of a series. The file with a row in place is made when it is asked for: those of all rows together are some
/// thousand times as large as the table.
pub(super) struct Series<'a, 't> {
    /// Without the series: it would be copied for each of its rows.
    file: DeTable<'t>,
    columns: &'a [Stated<String>],
    targets: Vec<Option<Column>>,
    rows: Vec<WrittenRow<'t>>,
}

impl<'t> Series<'_, 't> {
    /// The file with each row in place.
    pub fn variants(&self) -> impl ExactSizeIterator<Item = Variant<'t>> {
        let rows = self.rows.iter();
        rows.map(|(_, cells)| {
            // What can be wrong with them has been looked for.
            let mut faults = Vec::new();
            variant(&self.file, self.columns, &self.targets, cells, &mut faults)
        })
    }
}

/// One row: its label, and the file with its values in place.
pub(super) struct Variant<'t> {
    pub label: Option<String>,
    pub table: DeTable<'t>,
}

/// What a column sets.
#[derive(Debug)]
pub(super) enum Column {
    Label,
    /// Nothing: it goes through to the results.
    Kept,
    /// The keys that lead to a value.
    Path(Vec<String>),
}

/// The tables of named entries that a column may leave out: `X` is `input.X.value`.
const OWNERS: [&str; 3] = ["input", "constant", "source"];

/// The rows of the series of a file; nothing where it is faulty.
pub(super) fn series<'a, 't>(
    file: &'a DeTable<'t>,
    stated: &'a Stated<SeriesTable>,
    points: Option<&'t Points>,
    faults: &mut Vec<Fault>,
) -> Option<Series<'a, 't>>
where
    't: 'a,
{
    let before = faults.len();
    let table = &stated.value;
    let (columns, rows) = match (points, &table.columns, &table.rows) {
        (Some(points), None, None) => {
            let names = points.columns.names.as_slice();
            let rows = points.rows().map(|cells| (names[0].span.clone(), cells));
            (names, rows.collect())
        }
        (None, Some(columns), Some(rows)) => {
            (columns.value.as_slice(), rows_of_file(file, &rows.value))
        }
        (Some(_), ..) => {
            faults.push(
                Fault::new(
                    SERIES,
                    stated.span.clone(),
                    say!("the rows of the series are stated twice"),
                )
                .label(say!("in a file and here"))
                .help(say!(
                    "the first line of `file` names the columns: leave out `columns` and `rows`"
                )),
            );
            return None;
        }
        _ => {
            if !table.refused {
                faults.push(incomplete(stated));
            }
            return None;
        }
    };
    let rows: Vec<WrittenRow<'t>> = rows;
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

/// What columns of these names set.
pub(super) fn targets(
    file: &DeTable<'_>,
    names: &[Stated<String>],
    faults: &mut Vec<Fault>,
) -> Vec<Option<Column>> {
    let names = names.iter();
    names.map(|name| column(file, name, faults)).collect()
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
    for ((target, name), (cell, raw)) in targets.iter().zip(names).zip(cells) {
        match target {
            Some(Column::Label) => variant.label = Some(label(&cell.value)),
            Some(Column::Path(path)) if is_left_out(&cell.value, path) => {
                leave_out(&mut variant.table, path);
            }
            Some(Column::Path(path)) => set(&mut variant.table, path, name, cell, raw, faults),
            Some(Column::Kept) | None => {}
        }
    }
    variant
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
    match cell {
        Entry::Text(text) => text.is_empty(),
        Entry::Number(number) => *number == 0.0 && deviation && owned,
        Entry::List => false,
    }
}

/// Takes out a key, or the component of a list to which it belongs.
fn leave_out(table: &mut DeTable<'_>, path: &[String]) {
    let Some((first, rest)) = path.split_first() else {
        return;
    };
    let key = named_component(table, first);
    let path: Vec<String> = key.into_iter().chain(rest.iter().cloned()).collect();
    let Some((first, rest)) = path.split_first() else {
        return;
    };
    let Some((next, below)) = rest.split_first() else {
        table.remove(first.as_str());
        return;
    };
    match table.get_mut(first.as_str()).map(Spanned::get_mut) {
        Some(DeValue::Table(inner)) => leave_out(inner, rest),
        Some(DeValue::Array(list)) => {
            let named = list.iter().position(|entry| is_called(entry, next));
            let numbered = next
                .parse::<usize>()
                .ok()
                .and_then(|number| number.checked_sub(1));
            let place = named.or(numbered).filter(|place| *place < list.len());
            match (place, first == "components") {
                (Some(place), true) => {
                    let kept = list.iter().enumerate().filter(|(other, _)| *other != place);
                    *list = kept.map(|(_, entry)| entry.clone()).collect();
                }
                // Without a number the first of several claims is meant.
                (place, _) => {
                    let below = if place.is_some() { below } else { rest };
                    if let Some(DeValue::Table(inner)) =
                        list.get_mut(place.unwrap_or(0)).map(Spanned::get_mut)
                    {
                        leave_out(inner, below);
                    }
                }
            }
        }
        _ => {}
    }
}

fn incomplete(stated: &Stated<SeriesTable>) -> Fault {
    let missing = if stated.value.columns.is_none() {
        "columns"
    } else {
        "rows"
    };
    Fault::new(
        SERIES,
        stated.span.clone(),
        say!("the series has no `{missing}`"),
    )
    .label(say!("`{missing}` is missing"))
}

/// The rows that the file states: their places, and their cells as read and as the file has them.
fn rows_of_file<'t>(
    file: &DeTable<'t>,
    rows: &[Stated<Vec<Stated<Entry>>>],
) -> Vec<WrittenRow<'t>> {
    let raw = match file.get("series").map(Spanned::get_ref) {
        Some(DeValue::Table(series)) => series.get("rows").map(Spanned::get_ref),
        _ => None,
    };
    let Some(DeValue::Array(raw)) = raw else {
        return Vec::new();
    };
    let raw = raw.iter().filter_map(|row| match row.get_ref() {
        DeValue::Array(cells) => Some(cells),
        _ => None,
    });
    rows.iter()
        .zip(raw)
        .map(|(row, raw)| {
            let cells = row.value.iter().cloned().zip(raw.iter().cloned());
            (row.span.clone(), cells.collect())
        })
        .collect()
}

fn label(cell: &Entry) -> String {
    match cell {
        Entry::Text(text) => text.clone(),
        Entry::Number(number) => number.to_string(),
        Entry::List => "[…]".into(),
    }
}

/// The place that a column names: `label`, an input or a constant, or a path such as `X.dof`,
/// `conventions.coverage_probability` or `claim.figures."line.slope"`.
pub(super) fn column(
    file: &DeTable<'_>,
    name: &Stated<String>,
    faults: &mut Vec<Fault>,
) -> Option<Column> {
    let wanted = name.value.as_str();
    if wanted == "label" {
        return Some(Column::Label);
    }
    if let Some(pair) = correlated(wanted) {
        return correlation(file, pair, name, faults).map(Column::Path);
    }
    let mut path = segments(wanted);
    for owner in OWNERS {
        let Some(entry) = entry(file, owner, &path[0]) else {
            continue;
        };
        path.insert(0, owner.to_string());
        if path.len() > 2 {
            return Some(Column::Path(path));
        }
        if let Some(values) = values(entry) {
            faults.push(
                Fault::new(SERIES, name.span.clone(), say!("{wanted} is a vector"))
                    .label(say!("a column sets one number"))
                    .related(values, say!("its values"))
                    .help(say!("name an element: \"{wanted}.values.1\"")),
            );
            return None;
        }
        // A constant may be a bare number.
        if matches!(entry.get_ref(), DeValue::Table(_)) {
            path.push("value".into());
        }
        return Some(Column::Path(path));
    }
    if matches!(&path[..], [owner, _, key] if owner == "measurand" && key == "unit") {
        let message = say!("{wanted} would give the rows results in several units");
        faults.push(
            Fault::new(SERIES, name.span.clone(), message)
                .label(say!("the column of a result has one unit"))
                .help(say!(
                    "leave the column out: results are in the unit that the budget states"
                )),
        );
        return None;
    }
    if path.len() > 1 && FileTable::keys().contains(&path[0].as_str()) && path[0] != "series" {
        return Some(Column::Path(path));
    }
    faults.push(unknown_column(file, name, &path));
    None
}

/// The two names of `r(X, Y)`.
fn correlated(column: &str) -> Option<[&str; 2]> {
    let inside = column.strip_prefix("r(")?.strip_suffix(')')?;
    let (one, other) = inside.split_once(',')?;
    Some([one.trim(), other.trim()])
}

/// The place of a stated correlation coefficient.
fn correlation(
    file: &DeTable<'_>,
    pair: [&str; 2],
    name: &Stated<String>,
    faults: &mut Vec<Fault>,
) -> Option<Vec<String>> {
    let is_between = |entry: &Raw<'_>| {
        let DeValue::Table(table) = entry.get_ref() else {
            return false;
        };
        let Some(DeValue::Array(between)) = table.get("between").map(Spanned::get_ref) else {
            return false;
        };
        let stated = |wanted: &str| {
            let mut names = between.iter().map(Spanned::get_ref);
            names.any(|name| matches!(name, DeValue::String(name) if name == wanted))
        };
        between.len() == 2 && pair.into_iter().all(stated)
    };
    let path = |parts: &[&str]| Some(parts.iter().map(|part| (*part).to_owned()).collect());
    match file.get("correlation").map(Spanned::get_ref) {
        Some(DeValue::Array(list)) if let Some(at) = list.iter().position(is_between) => {
            return path(&["correlation", &(at + 1).to_string(), "r"]);
        }
        Some(DeValue::Table(_)) if file.get("correlation").is_some_and(is_between) => {
            return path(&["correlation", "r"]);
        }
        _ => {}
    }
    let [one, other] = pair;
    let message = say!("the file states no correlation between {one} and {other}");
    faults.push(
        Fault::new(UNKNOWN_NAME, name.span.clone(), message)
            .label(say!("unknown column"))
            .help(say!("state one, which the column replaces:\n[[correlation]]\nbetween = [\"{one}\", \"{other}\"]\nr = 0")),
    );
    None
}

fn unknown_column(file: &DeTable<'_>, name: &Stated<String>, path: &[String]) -> Fault {
    let fault = Fault::new(
        UNKNOWN_NAME,
        name.span.clone(),
        say!("no input or constant is called {}", path[0]),
    )
    .label(say!("unknown column"));
    let known = known_names(file, path.len());
    match nearest(&path[0], known.iter().map(String::as_str)) {
        Some(near) => {
            let whole: Vec<&str> = std::iter::once(near)
                .chain(path[1..].iter().map(String::as_str))
                .collect();
            fault.help(say!("did you mean \"{}\"?", whole.join(".")))
        }
        None => fault.help(
            say!("columns are inputs, constants, `label`, or other numbers of the file by their path, such as `claim.value`"),
        ),
    }
}

/// What a path of so many parts may begin with.
fn known_names(file: &DeTable<'_>, parts: usize) -> Vec<String> {
    let mut names: Vec<String> = OWNERS
        .iter()
        .filter_map(|owner| match file.get(*owner)?.get_ref() {
            DeValue::Table(table) => Some(table.keys().map(|key| key.get_ref().to_string())),
            _ => None,
        })
        .flatten()
        .collect();
    if parts == 1 {
        names.push("label".into());
    } else {
        names.extend(FileTable::keys().into_iter().map(String::from));
    }
    names
}

/// The parts of a path; a part in quotes may contain points.
fn segments(path: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut quoted = false;
    for c in path.chars() {
        match c {
            '"' => quoted = !quoted,
            '.' if !quoted => parts.push(String::new()),
            _ => parts.last_mut().expect("never empty").push(c),
        }
    }
    parts
}

/// Whether a file has an input, a constant or a source of this name.
pub(super) fn names_one(file: &DeTable<'_>, name: &str) -> bool {
    let mut owners = OWNERS.iter();
    owners.any(|owner| entry(file, owner, name).is_some())
}

fn entry<'a, 't>(file: &'a DeTable<'t>, owner: &str, name: &str) -> Option<&'a Raw<'t>> {
    match file.get(owner)?.get_ref() {
        DeValue::Table(table) => table.get(name),
        _ => None,
    }
}

/// Where an entry states the values of a vector.
fn values(entry: &Raw<'_>) -> Option<std::ops::Range<usize>> {
    match entry.get_ref() {
        DeValue::Table(table) => table
            .get_key_value("values")
            .map(|(key, _)| key.span().clone()),
        _ => None,
    }
}

/// Puts the cell of a row in its place, and makes the tables that lead there.
fn set<'t>(
    table: &mut DeTable<'t>,
    path: &[String],
    name: &Stated<String>,
    cell: &Stated<Entry>,
    raw: &Raw<'t>,
    faults: &mut Vec<Fault>,
) {
    let amount = |text: &str| amount_parts(text).is_some();
    if let (Entry::Text(text), Some("value")) = (&cell.value, path.last().map(String::as_str))
        && !amount(text)
    {
        faults.push(
            Fault::new(
                SERIES,
                cell.span.clone(),
                say!("the text {text:?} where a number is expected"),
            )
            .label(say!("expected a number in the unit of the input")),
        );
        return;
    }
    let Some((first, rest)) = path.split_first() else {
        return;
    };
    if let Err(message) = set_in_table(table, first, rest, name, raw) {
        let fault =
            Fault::new(UNKNOWN_NAME, name.span.clone(), message).label(say!("unknown column"));
        if !faults.contains(&fault) {
            faults.push(fault);
        }
    }
}

fn set_in_table<'t>(
    table: &mut DeTable<'t>,
    key: &str,
    rest: &[String],
    name: &Stated<String>,
    cell: &Raw<'t>,
) -> Result<(), Said> {
    let key = named_component(table, key);
    let key = key.as_slice();
    let (first, further) = key.split_first().expect("a path is never empty");
    let further: Vec<String> = further.iter().chain(rest).cloned().collect();
    if !table.contains_key(first.as_str()) {
        let place = name.span.clone();
        let key: Spanned<DeString<'t>> = Spanned::new(place.clone(), first.clone().into());
        table.insert(key, Spanned::new(place, DeValue::Table(DeTable::new())));
        if further.is_empty() {
            return replace(table.get_mut(first.as_str()), cell);
        }
    }
    match table.get_mut(first.as_str()) {
        slot if further.is_empty() => replace(slot, cell),
        Some(value) => set_in_value(value, &further, name, cell),
        None => Ok(()),
    }
}

/// `V.calibration` is the component of that name in the list of V's components.
fn named_component(table: &DeTable<'_>, key: &str) -> Vec<String> {
    let listed = match table.get("components").map(Spanned::get_ref) {
        Some(DeValue::Array(list)) if !table.contains_key(key) => {
            list.iter().any(|entry| is_called(entry, key))
        }
        _ => false,
    };
    let prefix = listed.then(|| "components".to_string());
    prefix.into_iter().chain([key.to_string()]).collect()
}

fn is_called(entry: &Raw<'_>, name: &str) -> bool {
    let DeValue::Table(table) = entry.get_ref() else {
        return false;
    };
    matches!(table.get("name").map(Spanned::get_ref), Some(DeValue::String(text)) if text == name)
}

fn replace<'t>(slot: Option<&mut Raw<'t>>, cell: &Raw<'t>) -> Result<(), Said> {
    let Some(slot) = slot else { return Ok(()) };
    *slot = match slot.get_ref() {
        DeValue::String(text) => in_unit_of(text, cell).unwrap_or_else(|| cell.clone()),
        _ => cell.clone(),
    };
    Ok(())
}

/// A number in the unit of the text with a unit whose place it takes: `0.2` in that of `"0.1 %"`.
fn in_unit_of<'t>(text: &str, cell: &Raw<'t>) -> Option<Raw<'t>> {
    let number = match cell.get_ref() {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        _ => return None,
    };
    let (_, unit) = amount_parts(text)?;
    let amount = format!("{} {unit}", number.replace('_', ""));
    // Not so of an angle in degrees, minutes and seconds.
    (amount_parts(&amount)?.1 == unit)
        .then(|| Spanned::new(cell.span(), DeValue::String(amount.into())))
}

fn set_in_value<'t>(
    value: &mut Raw<'t>,
    path: &[String],
    name: &Stated<String>,
    cell: &Raw<'t>,
) -> Result<(), Said> {
    let Some((first, rest)) = path.split_first() else {
        return Ok(());
    };
    match value.get_mut() {
        DeValue::Table(table) => set_in_table(table, first, rest, name, cell),
        DeValue::Array(list) => {
            let count = list.len();
            let chosen = match first.parse::<usize>() {
                Ok(number) => number.checked_sub(1).map(|index| (index, rest)),
                Err(_) => match list.iter().position(|entry| is_called(entry, first)) {
                    Some(index) => Some((index, rest)),
                    // Without a number the first of several claims is meant.
                    None => Some((0, path)),
                },
            };
            let Some((entry, rest)) =
                chosen.and_then(|(index, rest)| Some((list.get_mut(index)?, rest)))
            else {
                return Err(say!(
                    "there is no entry {first} for the column \"{}\": the list has {count}",
                    name.value
                ));
            };
            if rest.is_empty() {
                replace(Some(entry), cell)
            } else if matches!(entry.get_ref(), DeValue::Table(_)) {
                set_in_value(entry, rest, name, cell)
            } else {
                Err(say!(
                    "the column \"{}\" leads to a list of numbers; name one by its place, counted from 1",
                    name.value
                ))
            }
        }
        _ => Err(say!(
            "the column \"{}\" goes beyond a number or text of the file, at `{first}`",
            name.value
        )),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::segments;
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
            r#""V.components.1.readings.3", "claim.k", "claim.2.inputs.\"V.scatter\".u""#,
            "[3, 2, 0.58], [6, 3, 1.53]",
        );
        assert!((found[1].components[1].u - (7.0f64 / 3.0).sqrt()).abs() < 1e-12);
        let factor = found[1].claims[0].figure(&Figure::CoverageFactor);
        assert_eq!(factor, Some(3.0));
        assert_eq!(found[1].claims[1].figures[0].value, 1.53);
        assert!(message(r#""V.components.1.readings.4""#, "[1]").contains("the list has 3"));
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
    fn an_unknown_path_is_answered_with_the_nearest() {
        assert!(message(r#""X.dfo""#, "[1]").contains("did you mean `dof`?"));
        assert!(message(r#""x.dof""#, "[1]").contains("did you mean \"X.dof\"?"));
        assert!(
            message(r#""conventoins.digits""#, "[1]")
                .contains("did you mean \"conventions.digits\"?")
        );
        assert!(message(r#""X.value.deeper""#, "[1]").contains("goes beyond a number"));
        assert!(message(r#""X""#, "[\"much\"]").contains("where a number is expected"));
    }

    #[test]
    fn a_part_in_quotes_may_contain_points() {
        assert_eq!(segments("a.b"), ["a", "b"]);
        assert_eq!(
            segments("claim.figures.\"line.slope\""),
            ["claim", "figures", "line.slope"]
        );
    }
}
