//! Parameters of a file that lists none: what the equations name and nothing else is.

use std::ops::Range;
use std::path::Path;

use gumption_format::toml::{Named, Stated};

use super::source::{Source, entries};
use super::tables::ParameterTable;
use crate::recording::{Heading, headings, text_of};
use gumption_core::model::{Outline, outline};
use gumption_core::quantity::UnitTable;
use gumption_fault::nearest;
use gumption_format::files::Files;
use smol_str::SmolStr;

/// Lists the parameters of a file that has no `[parameter]`.
pub(crate) fn add(source: &mut Source, units: &UnitTable, files: Files<'_>, folder: &Path) {
    if source.table.parameter.is_none() {
        complete(source, units, files, folder);
    }
}

/// Lists the parameters that a file does not list, beside those of which it says something.
pub(crate) fn complete(source: &mut Source, units: &UnitTable, files: Files<'_>, folder: &Path) {
    let Some(known) = known(source, units, files, folder) else {
        return;
    };
    let Some(outlines) = outlines(source, units) else {
        return;
    };
    let listed = entries(&source.table.parameter).iter();
    let listed: Vec<&str> = listed.map(|(name, _)| name.as_str()).collect();
    let mut found: Vec<(SmolStr, Stated<ParameterTable>)> = Vec::new();
    let mut place = 0..0;
    let is_taken_in = |outline: &Outline| {
        let mut needs = outline.needs.iter();
        needs.any(|(name, _)| known.contains(name) && !is_left(outline, name))
    };
    let takes_in = outlines.iter().any(|(_, outline)| is_taken_in(outline));
    for (equation, outline) in outlines {
        place = equation;
        let is_other_letter = |name: &str| {
            let mut others = known.iter().filter(|other| !is_left(&outline, other));
            others.any(|other| other.to_lowercase() == name.to_lowercase())
        };
        for (name, _) in &outline.needs {
            let is_listed =
                found.iter().any(|(other, _)| other == name) || listed.contains(&name.as_str());
            let is_known = is_left(&outline, name) || known.contains(name);
            // `T` is another than `t`, but not where the equations would take in nothing else.
            let is_slip = is_slip(name, &known) || (!takes_in && is_other_letter(name));
            if !is_listed && !is_known && !is_slip {
                let table = Stated {
                    value: ParameterTable::default(),
                    span: place.clone(),
                    key: place.clone(),
                };
                found.push((name.as_str().into(), table));
            }
        }
    }
    if found.is_empty() {
        return;
    }
    let named = Named {
        entries: Vec::new(),
        refused: false,
    };
    let none = Stated {
        value: named,
        span: place.clone(),
        key: place,
    };
    let table = source.table.parameter.get_or_insert_with(|| Box::new(none));
    table.value.entries.extend(found);
}

/// Whether a name is the left side of its equation.
fn is_left(outline: &Outline, name: &str) -> bool {
    (outline.gives.as_ref()).is_some_and(|(given, _)| given == name)
}

/// Where each equation stands, and its names; `None` where one of them cannot be read.
pub(crate) fn outlines(source: &Source, units: &UnitTable) -> Option<Vec<(Range<usize>, Outline)>> {
    let shared = source.table.model.as_ref().map_or("", |text| &text.value);
    let equations = source.table.equations.iter().flat_map(|list| &list.value.0);
    let read = equations.map(|text| {
        let outline = outline(&format!("{shared}\n{}", text.value), units).ok()?;
        Some((text.span.clone(), outline))
    });
    read.collect()
}

/// Whether a name of some length is nearly a known one, by a slip of the pen, or is it but for capitals: `temp0` beside `temp` is
/// none, nor are names that differ by their numbers, nor `t` beside `T`.
fn is_slip(name: &str, known: &[String]) -> bool {
    let small = name.to_lowercase();
    if name.chars().count() > 1 && known.iter().any(|known| known.to_lowercase() == small) {
        return true;
    }
    let letters = |name: &str| name.replace(|c: char| c.is_numeric(), "");
    let near = nearest(name, known.iter().map(String::as_str));
    near.is_some_and(|near| {
        name.chars().count() > 2 && !name.starts_with(near) && letters(name) != letters(near)
    })
}

/// Names of columns, constants, inputs and quantities of positions; `None` without a recording or a schedule.
fn known(
    source: &Source,
    units: &UnitTable,
    files: Files<'_>,
    folder: &Path,
) -> Option<Vec<String>> {
    let table = &source.table;
    let mut known: Vec<String> = Vec::new();
    let recording = table.recording.as_ref();
    if let Some(file) = recording.and_then(|stated| stated.value.0.file.as_ref()) {
        let path = folder.join(&file.value);
        let text = text_of(files, &path, &file.value).ok()?;
        let found = headings(&text, units).ok()?;
        known.extend(found.into_iter().map(|heading| heading.name));
    }
    let scheduled = entries(&table.schedule).iter();
    known.extend(scheduled.map(|(key, _)| Heading::read(key, units).name));
    if known.is_empty() {
        return None;
    }
    known.extend(
        entries(&table.columns)
            .iter()
            .map(|(name, _)| name.to_string()),
    );
    known.extend(
        entries(&table.constant)
            .iter()
            .map(|(name, _)| name.to_string()),
    );
    known.extend(
        entries(&table.input)
            .iter()
            .map(|(name, _)| name.to_string()),
    );
    let gives = table
        .positions
        .as_ref()
        .and_then(|stated| stated.value.gives.as_ref());
    known.extend(
        gives
            .iter()
            .flat_map(|list| &list.value)
            .map(|name| name.value.clone()),
    );
    Some(known)
}
