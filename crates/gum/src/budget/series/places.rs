//! Puts a cell in the place of a file that its column means, or leaves out what stands there.

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use crate::budget::cell::Entry;
use crate::budget::faults::{SERIES, UNKNOWN_NAME};
use gumption_fault::{Fault, Said, say};
use gumption_format::csv;
use gumption_format::toml::{Raw, Stated, amount_parts};

/// Puts the cell of a row in its place, and makes the tables that lead there.
pub(super) fn set<'t>(
    table: &mut DeTable<'t>,
    path: &[String],
    name: &Stated<String>,
    cell: &Stated<Entry>,
    raw: &Raw<'t>,
    faults: &mut Vec<Fault>,
) {
    if let (Entry::Text(text), Some("value")) = (&cell.value, path.last().map(String::as_str)) {
        let mend = csv::mend_of_number(text);
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

/// Takes out a key, or the component of a list to which it belongs.
pub(super) fn leave_out(table: &mut DeTable<'_>, path: &[String]) {
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
