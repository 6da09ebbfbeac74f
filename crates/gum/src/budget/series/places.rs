//! Puts a cell in the place of a file that its column means, or leaves out what stands there.

use std::collections::BTreeSet;

use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

use crate::budget::cell::Entry;
use crate::budget::check::states_uncertainty;
use crate::budget::faults::{SERIES, UNKNOWN_NAME};
use crate::budget::tables::InputTable;
use gumption_fault::{Fault, Said, say};
use gumption_format::csv;
use gumption_format::toml::{Raw, Stated, Table, amount_for_date, amount_parts};

/// The key of the reasons for doubt of an input.
pub(super) const COMPONENTS: &str = "components";

/// Puts the cell of a row in its place, and makes the tables that lead there.
pub(super) fn set<'t>(
    table: &mut DeTable<'t>,
    path: &[String],
    name: &Stated<String>,
    cell: &Stated<Entry>,
    raw: &Raw<'t>,
    faults: &mut Vec<Fault>,
) {
    let text = match &cell.value {
        Entry::Text(text) => Some(text.clone()),
        Entry::Number(number) => (!number.is_finite()).then(|| number.to_string()),
        Entry::List => None,
    };
    if let (Some(text), Some("value")) = (&text, path.last().map(String::as_str)) {
        let mend = csv::mend_of_number(text).or_else(|| csv::days(text).map(|_| amount_for_date()));
        if mend.is_some() || amount_parts(text).is_none() {
            let mend = mend.unwrap_or_else(|| say!("leave it empty if the value is missing"));
            let message = say!("the text {text:?} where a number is expected");
            faults.push(
                Fault::new(SERIES, cell.span.clone(), message)
                    .label(say!("expected a number in the unit of the input"))
                    .help(mend),
            );
            return;
        }
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

/// Takes out what the paths name; a component of a list as a whole where nothing states its uncertainty any more. All of them
/// together, as an entry that goes would change the numbers of those behind it.
pub(super) fn leave_out(table: &mut DeTable<'_>, paths: &[&[String]]) {
    let places: Vec<Vec<String>> = paths.iter().map(|path| resolved(table, path)).collect();
    for place in &places {
        if let Some((key, owner)) = place.split_last()
            && let Some(owner) = table_at(table, owner)
        {
            owner.remove(key.as_str());
        }
    }
    let components: BTreeSet<(&[String], usize)> =
        places.iter().filter_map(|place| component(place)).collect();
    for (list, number) in components.into_iter().rev() {
        let is_named = places.iter().any(|place| {
            let whole = place.split_last();
            whole.is_some_and(|(entry, of)| of == list && entry.parse() == Ok(number))
        });
        let entry = [list, &[number.to_string()]].concat();
        let is_stated = table_at(table, &entry).is_some_and(|entry| states_something(entry));
        if is_named || !is_stated {
            remove_entry(table, list, number);
        }
    }
}

/// The list of components that a path leads through, and the number of the one in it.
fn component(path: &[String]) -> Option<(&[String], usize)> {
    let at = path.iter().position(|key| key == COMPONENTS)? + 1;
    let number = path.get(at)?.parse().ok()?;
    Some((&path[..at], number))
}

/// Whether a component states an uncertainty in some way.
fn states_something(component: &DeTable<'_>) -> bool {
    component.iter().any(|(key, value)| {
        let table = match value.get_ref() {
            DeValue::Table(table) => Some(table),
            _ => None,
        };
        let has = |key: &str| table.is_some_and(|table| table.contains_key(key));
        match key.get_ref().as_ref() {
            // Behind another way it is where that comes from.
            "certificate" => has("U") || has("dcc"),
            // As a text it is the shape of limits that stand beside it.
            "distribution" => table.is_some(),
            key => states_uncertainty(key),
        }
    })
}

fn remove_entry(table: &mut DeTable<'_>, list: &[String], number: usize) {
    let Some((key, owner)) = list.split_last() else {
        return;
    };
    let owner = table_at(table, owner);
    if let Some(DeValue::Array(list)) =
        owner.and_then(|owner| owner.get_mut(key.as_str()).map(Spanned::get_mut))
    {
        let kept = list.iter().zip(1..).filter(|(_, other)| *other != number);
        *list = kept.map(|(entry, _)| entry.clone()).collect();
    }
}

/// The table to which a path without names leads.
fn table_at<'v, 't>(table: &'v mut DeTable<'t>, path: &[String]) -> Option<&'v mut DeTable<'t>> {
    let Some((key, rest)) = path.split_first() else {
        return Some(table);
    };
    match table.get_mut(key.as_str())?.get_mut() {
        DeValue::Table(inner) => table_at(inner, rest),
        DeValue::Array(list) => {
            let (number, rest) = rest.split_first()?;
            let index = number.parse::<usize>().ok()?.checked_sub(1)?;
            match list.get_mut(index)?.get_mut() {
                DeValue::Table(inner) => table_at(inner, rest),
                _ => None,
            }
        }
        _ => None,
    }
}

/// The path with the number in its list of every entry that it names, or that it means by naming none.
pub(super) fn resolved(table: &DeTable<'_>, path: &[String]) -> Vec<String> {
    let Some((first, rest)) = path.split_first() else {
        return Vec::new();
    };
    let mut keys = named_component(table, first);
    keys.extend_from_slice(rest);
    let mut found = vec![keys.remove(0)];
    found.extend(match table.get(found[0].as_str()).map(Spanned::get_ref) {
        Some(DeValue::Table(inner)) => resolved(inner, &keys),
        Some(DeValue::Array(list)) => match entry_of(list, &keys) {
            Some((index, rest)) => {
                let below = match list.get(index).map(Spanned::get_ref) {
                    Some(DeValue::Table(inner)) => resolved(inner, rest),
                    _ => rest.to_vec(),
                };
                [vec![(index + 1).to_string()], below].concat()
            }
            None => keys,
        },
        _ => keys,
    });
    found
}

/// The entry of a list that a path begins with, by its number or its name, and the rest of the path.
fn entry_of<'p>(list: &DeArray<'_>, path: &'p [String]) -> Option<(usize, &'p [String])> {
    let (first, rest) = path.split_first()?;
    match first.parse::<usize>() {
        Ok(number) => number.checked_sub(1).map(|index| (index, rest)),
        Err(_) => match list.iter().position(|entry| is_called(entry, first)) {
            Some(index) => Some((index, rest)),
            // Without a number the first of several claims is meant.
            None => Some((0, path)),
        },
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
        if !further.is_empty() {
            is_no_component(table, first, name)?;
        }
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
    let listed = match table.get(COMPONENTS).map(Spanned::get_ref) {
        Some(DeValue::Array(list)) if !table.contains_key(key) => {
            list.iter().any(|entry| is_called(entry, key))
        }
        _ => false,
    };
    let prefix = listed.then(|| COMPONENTS.to_string());
    prefix.into_iter().chain([key.to_string()]).collect()
}

/// What leads through the list of components, and is the name of none, nor a key that an input has without them.
fn is_no_component(table: &DeTable<'_>, key: &str, column: &Stated<String>) -> Result<(), Said> {
    let Some(DeValue::Array(list)) = table.get(COMPONENTS).map(Spanned::get_ref) else {
        return Ok(());
    };
    if InputTable::keys().contains(&key) {
        return Ok(());
    }
    let names = list.iter().filter_map(|entry| {
        let name = entry.get_ref().as_table()?.get("name")?.get_ref();
        name.as_str()
    });
    let names: Vec<&str> = names.collect();
    let column = &column.value;
    Err(match names.is_empty() {
        true => say!(
            "there is no component `{key}` for the column \"{column}\": the components have no names"
        ),
        false => say!(
            "there is no component `{key}` for the column \"{column}\": the components are called {}",
            names.join(", ")
        ),
    })
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
            let chosen = entry_of(list, path);
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

    use crate::budget::{Budget, read};

    const FILE: &str = r#"
[measurand.Y]
model = "X + V"
[input.X]
value = 1
components = [
  { u = 0.1 },
  { name = "cal", certificate = { U = 0.4, k = 2, dof = 8 }, reference = "C-1" },
  { half_width = 0.3, distribution = "triangular", dof = 12 },
]
[input.V]
components = [{ name = "scatter", readings = [1, 2, 3], pooled = { s = 0.5, dof = 30 } }]
"#;

    fn read_with(columns: &str, cells: &str) -> Result<Vec<Budget>, String> {
        let file = format!("{FILE}[series]\ncolumns = [{columns}]\nrows = [{cells}]\n");
        let loaded =
            read(&file, "budget.toml", Path::new("")).map_err(|refused| refused.render(false))?;
        Ok(loaded.rows.into_iter().map(|row| row.budget).collect())
    }

    /// u and ν of each component of the first row.
    fn components(columns: &str, cells: &str) -> Vec<(f64, f64)> {
        let found = read_with(columns, cells).expect("budgets");
        let components = found[0].components.iter();
        components.map(|one| (one.u, one.dof)).collect()
    }

    /// What is left of a component still states it: an empty cell for ν, for a shape or for a pooled s is no missing component.
    #[test]
    fn a_component_stays_as_long_as_something_states_it() {
        let columns = r#""X.cal.certificate.dof", "X.components.3.distribution", "X.components.3.dof", "V.scatter.pooled""#;
        let inf = f64::INFINITY;
        let expected = [
            (0.1, inf),
            (0.2, inf),
            (0.3 / 3f64.sqrt(), inf),
            (1.0 / 3f64.sqrt(), 2.0),
        ];
        let found = components(columns, r#"["", "", "", ""]"#);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found.0 - expected.0).abs() < 1e-12 && found.1 == expected.1,
                "{found:?}"
            );
        }
        assert_eq!(found.len(), 4);
        let without_k = read_with(r#""X.cal.certificate.k""#, r#"[""]"#).expect_err("no k");
        assert!(without_k.contains("k"), "{without_k}");
    }

    /// An entry that is left out takes its other columns with it, and none of those behind it.
    #[test]
    fn entries_keep_their_numbers() {
        let columns = r#""X.components.1.u", "X.components.1.dof", "X.cal.certificate.U", "X.components.3.half_width""#;
        let found = components(columns, r#"["", "", 0.8, 0.6]"#);
        let u: Vec<f64> = found.iter().map(|(u, _)| *u).collect();
        let expected = [0.4, 0.6 / 6f64.sqrt(), 0.5 / 3f64.sqrt()];
        assert_eq!(u.len(), 3);
        assert!(
            u.iter()
                .zip(expected)
                .all(|(u, expected)| (u - expected).abs() < 1e-12),
            "{u:?}"
        );
        assert_eq!(components(columns, r#"["", "", 0, 0.6]"#).len(), 2);
    }

    #[test]
    fn a_component_is_set_once_however_it_is_called() {
        let columns = r#""X.cal.certificate.U", "X.components.2.certificate.U""#;
        let twice = read_with(columns, "[0.4, 0.5]").expect_err("two columns");
        assert!(twice.contains("two columns set the same"), "{twice}");
    }

    #[test]
    fn a_misspelt_component_is_answered_with_those_there_are() {
        let of = |column| read_with(column, "[0.4]").expect_err("no such component");
        let refused = of(r#""X.call.certificate.U""#);
        assert!(
            refused.contains("the components are called cal"),
            "{refused}"
        );
        // A key that an input has, and a component that is there.
        let key = of(r#""X.certificate.U""#);
        assert!(!key.contains("no component"), "{key}");
        assert!(read_with(r#""X.cal.certificate.U""#, "[0.4]").is_ok());
    }

    /// Every part of a path is a call inside another.
    #[test]
    fn a_path_has_an_end() {
        let column = format!("\"X{}\"", ".a".repeat(100_000));
        let refused = read_with(&column, "[1]").expect_err("no such place");
        assert!(refused.contains("100001 tables deep"), "{refused}");
    }

    /// Readings of the budget tell the repeatability of each row, and the value of none.
    #[test]
    fn a_value_is_not_that_of_the_budget() {
        let missing = read_with(r#""V""#, r#"[2.5], [""]"#).expect_err("no value");
        assert!(missing.contains("the value of V is missing"), "{missing}");
        let of_row = read_with(r#""V", "V.scatter.readings""#, r#"["", [4, 5, 6]]"#);
        assert_eq!(of_row.expect("a budget")[0].inputs[1].estimate, 5.0);
        let columns = r#""V", "V.scatter.readings.1", "V.scatter.readings.2""#;
        let of_row = read_with(columns, r#"["", 4, 6]"#).expect("a budget");
        assert_eq!(of_row[0].inputs[1].estimate, 5.0);
        let missing = read_with(columns, r#"["", "", ""]"#).expect_err("nothing of V");
        assert!(missing.contains("V has no"), "{missing}");
    }
}
