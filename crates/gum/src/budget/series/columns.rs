//! Which place of a file the name of a column means.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::places::{COMPONENTS, resolved};
use crate::budget::check::states_estimate;
use crate::budget::faults::{SERIES, UNKNOWN_NAME};
use crate::budget::tables::FileTable;
use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::{Raw, Stated, Table};

/// What a column sets.
#[derive(Debug, PartialEq)]
pub(in crate::budget) enum Column {
    Label,
    /// Nothing: it goes through to the results.
    Kept,
    /// The keys that lead to a value.
    Path(Vec<String>),
}

/// The column that names the rows.
pub(in crate::budget) const LABEL: &str = "label";

/// The tables of named entries that a column may leave out: `X` is `input.X.value`.
pub(super) const OWNERS: [&str; 3] = ["input", "constant", "source"];

/// What columns of these names set.
pub(in crate::budget) fn targets(
    file: &DeTable<'_>,
    names: &[Stated<String>],
    faults: &mut Vec<Fault>,
) -> Vec<Option<Column>> {
    let targets = names.iter().map(|name| column(file, name, faults));
    let targets: Vec<Option<Column>> = targets.collect();
    faults.extend(set_twice(file, names, &targets));
    targets
}

/// Columns that set what another sets already: which of them counts would be a guess.
pub(in crate::budget) fn set_twice(
    file: &DeTable<'_>,
    names: &[Stated<String>],
    targets: &[Option<Column>],
) -> Vec<Fault> {
    // A component may be called by its name and by its number.
    let resolved = |target: &Option<Column>| match target {
        Some(Column::Path(path)) => Some(Column::Path(resolved(file, path))),
        Some(Column::Label) => Some(Column::Label),
        Some(Column::Kept) | None => None,
    };
    let targets: Vec<Option<Column>> = targets.iter().map(resolved).collect();
    let all = names.iter().zip(&targets).enumerate();
    let twice = all.filter_map(|(at, (name, target))| {
        let sets = |other: &Option<Column>| {
            target.is_some() && (other == target || is_list_of(other, target))
        };
        let first = targets[..at].iter().position(sets)?;
        let fault = Fault::new(
            SERIES,
            name.span.clone(),
            say!(
                "two columns set the same: {} and {}",
                names[first].value,
                name.value
            ),
        );
        // In a file that the budget names both have its place.
        let fault = match names[first].span == name.span {
            true => fault.label(say!("its columns")),
            false => fault
                .label(say!("the second"))
                .related(names[first].span.clone(), say!("the first")),
        };
        let are_readings = matches!(target, Some(Column::Path(path)) if path.last().is_some_and(|key| key == READINGS));
        Some(fault.help(match are_readings {
            true => say!(
                "readings in columns of their own are numbered: {name}.1, {name}.2, …",
                name = name.value
            ),
            false => say!("leave one of them out, or give it the name of what it holds"),
        }))
    });
    twice.collect()
}

/// The parts of a path beyond which it names nothing: no file has tables so deep, and each is a call inside another.
const DEEPEST: usize = 16;

/// The key of readings.
pub(super) const READINGS: &str = "readings";

/// The place of the list and the number of the reading, where a column sets one.
pub(super) fn numbered(path: &[String]) -> Option<(&[String], usize)> {
    let (number, list) = path.split_last()?;
    let number = number.parse().ok().filter(|number| *number > 0)?;
    (list.last()? == READINGS).then_some((list, number))
}

/// Whether one sets the readings of which the other sets one.
fn is_list_of(one: &Option<Column>, other: &Option<Column>) -> bool {
    let (Some(Column::Path(one)), Some(Column::Path(other))) = (one, other) else {
        return false;
    };
    let is_within =
        |list: &[String], path: &[String]| numbered(path).is_some_and(|(of, _)| of == list);
    is_within(one, other) || is_within(other, one)
}

/// The place that a column names: `label`, an input or a constant, or a path such as `X.dof`,
/// `conventions.coverage_probability` or `claim.figures."line.slope"`.
pub(in crate::budget) fn column(
    file: &DeTable<'_>,
    name: &Stated<String>,
    faults: &mut Vec<Fault>,
) -> Option<Column> {
    let wanted = name.value.as_str();
    if wanted == LABEL {
        return Some(Column::Label);
    }
    if wanted.is_empty() {
        faults.push(
            Fault::new(SERIES, name.span.clone(), say!("a column has no name"))
                .label(say!("no name"))
                .help(say!(
                    "name it, `label` if it names the rows, or delete the column"
                )),
        );
        return None;
    }
    if let Some(pair) = correlated(wanted) {
        return correlation(file, pair, name, faults).map(Column::Path);
    }
    let mut path = segments(wanted);
    if path.len() > DEEPEST {
        let message = say!("the column names a place {} tables deep", path.len());
        faults.push(
            Fault::new(UNKNOWN_NAME, name.span.clone(), message)
                .label(say!("unknown column"))
                .help(beyond_inputs()),
        );
        return None;
    }
    for owner in OWNERS {
        let Some(entry) = entry(file, owner, &path[0]) else {
            continue;
        };
        path.insert(0, owner.to_string());
        let table = entry.get_ref().as_table();
        let is_vector = table.is_some_and(|table| table.contains_key("values"));
        let is_element = |key: &String| key.parse::<usize>().is_ok();
        match path.get(2) {
            None if is_vector => path.push("values".into()),
            Some(key) if is_vector && is_element(key) => path.insert(2, "values".into()),
            // A constant may be a bare number or list.
            None if table.is_some() => path.push("value".into()),
            _ => {}
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
    let separators = |c: char| "，；、|".contains(c) || c.is_whitespace();
    let parts = name.value.split(separators);
    let parts = parts.filter(|part| *part == LABEL || is_owned(file, part));
    if parts.count() > 1 {
        return fault.help(say!(
            "columns are separated by a comma, a semicolon or a tab, and their names have no blanks"
        ));
    }
    match uncertainty(file, &name.value) {
        Some(("u", input)) => {
            return fault.help(say!(
                "the standard uncertainty of {input} is the column `{input}.u`"
            ));
        }
        Some((_, input)) => {
            return fault.help(say!(
                "the U of a certificate is the column `{input}.certificate.U`, with `{input}.certificate.k` where k differs from row to row"
            ));
        }
        None => {}
    }
    if let [alone] = path
        && let Some(input) = numbered_input(file, alone)
    {
        return fault.help(say!(
            "readings of {input} in columns of their own are {input}.readings.1, {input}.readings.2, …"
        ));
    }
    let known = known_names(file, path.len());
    match nearest(&path[0], known.iter().map(String::as_str)) {
        Some(near) => {
            let whole: Vec<&str> = std::iter::once(near)
                .chain(path[1..].iter().map(String::as_str))
                .collect();
            fault.help(say!("did you mean \"{}\"?", whole.join(".")))
        }
        None => fault.help(match path {
            [name] => say!(
                "state it as [input.{name}] with its unit and uncertainty, or as [constant.{name}] with its unit: the rows give its value; `label` names the rows"
            ),
            _ => beyond_inputs(),
        }),
    }
}

fn beyond_inputs() -> Said {
    say!(
        "columns are inputs, constants, `label`, or other numbers of the file by their path, such as `claim.value`"
    )
}

/// The input of which a column is the next in a number of them: `V1`, `V_2`, `V 3`.
fn numbered_input<'c>(file: &DeTable<'_>, column: &'c str) -> Option<&'c str> {
    let name = column.trim_end_matches(|c: char| c.is_ascii_digit());
    let input = name.trim_end_matches(['_', ' ', '-', '#']);
    let is_numbered = name.len() < column.len();
    (is_numbered && entry(file, "input", input).is_some()).then_some(input)
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
pub(super) fn is_owned(file: &DeTable<'_>, name: &str) -> bool {
    let mut owners = OWNERS.iter();
    owners.any(|owner| entry(file, owner, name).is_some())
}

/// The letter and the input of `u(V)`, `U(V)` or `u_V`.
pub(super) fn uncertainty<'c>(file: &DeTable<'_>, column: &'c str) -> Option<(&'c str, &'c str)> {
    let (letter, rest) = column.split_at_checked(1)?;
    let inside = rest
        .strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'))
        .or_else(|| rest.strip_prefix('_'))?;
    (["u", "U"].contains(&letter) && is_owned(file, inside)).then_some((letter, inside))
}

pub(super) fn entry<'a, 't>(file: &'a DeTable<'t>, owner: &str, name: &str) -> Option<&'a Raw<'t>> {
    match file.get(owner)?.get_ref() {
        DeValue::Table(table) => table.get(name),
        _ => None,
    }
}

/// Whether the file states an estimate of the input that a path begins with by something else than its value.
pub(super) fn has_estimate(file: &DeTable<'_>, path: &[String]) -> bool {
    let locates = |table: &DeTable<'_>| {
        let mut entries = table.iter();
        entries.any(|(key, value)| match key.get_ref().as_ref() {
            "distribution" => matches!(value.get_ref(), DeValue::Table(_)),
            key => states_estimate(key),
        })
    };
    let input = path.split_first().and_then(|(owner, rest)| {
        let input = entry(file, owner, rest.first()?)?;
        input.get_ref().as_table()
    });
    let listed = input.and_then(|input| input.get(COMPONENTS)?.get_ref().as_array());
    let mut components = listed.into_iter().flat_map(|list| list.iter());
    input.is_some_and(locates)
        || components.any(|entry| entry.get_ref().as_table().is_some_and(locates))
}

#[cfg(test)]
mod tests {
    use super::segments;

    #[test]
    fn a_part_in_quotes_may_contain_points() {
        assert_eq!(segments("a.b"), ["a", "b"]);
        assert_eq!(
            segments("claim.figures.\"line.slope\""),
            ["claim", "figures", "line.slope"]
        );
    }
}
