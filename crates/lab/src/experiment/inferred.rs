//! Parameters of a file that lists none: what the equations name and nothing else is.

use std::path::Path;

use gumption_format::toml::{Named, Stated};

use super::source::{Source, entries};
use super::tables::ParameterTable;
use crate::recording::{Heading, headings, text_of};
use gumption_core::model::outline;
use gumption_core::quantity::UnitTable;
use gumption_fault::nearest;
use gumption_format::files::Files;

/// Lists the parameters of a file that has no `[parameter]`.
pub(crate) fn add(source: &mut Source, units: &UnitTable, files: Files<'_>, folder: &Path) {
    if source.table.parameter.is_some() {
        return;
    }
    let Some(known) = known(source, units, files, folder) else {
        return;
    };
    let shared = source.table.model.as_ref().map_or("", |text| &text.value);
    let mut found: Vec<(String, Stated<ParameterTable>)> = Vec::new();
    let mut place = 0..0;
    for text in source.table.equations.iter().flat_map(|list| &list.value.0) {
        let Ok(outline) = outline(&format!("{shared}\n{}", text.value), units) else {
            return;
        };
        place = text.span.clone();
        let given = outline.gives.as_ref().map(|(name, _)| name);
        for (name, _) in &outline.needs {
            let listed = found.iter().any(|(other, _)| other == name);
            // A name of some length that is nearly that of a column is a slip of the pen.
            let slip = name.chars().count() > 2
                && nearest(name, known.iter().map(String::as_str)).is_some();
            if !listed && !slip && given != Some(name) && !known.contains(name) {
                let table = Stated {
                    value: ParameterTable::default(),
                    span: place.clone(),
                    key: place.clone(),
                };
                found.push((name.clone(), table));
            }
        }
    }
    if !found.is_empty() {
        source.table.parameter = Some(Stated {
            value: Named {
                entries: found,
                refused: false,
            },
            span: place.clone(),
            key: place,
        });
    }
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
    known.extend(entries(&table.columns).iter().map(|(name, _)| name.clone()));
    known.extend(
        entries(&table.constant)
            .iter()
            .map(|(name, _)| name.clone()),
    );
    known.extend(entries(&table.input).iter().map(|(name, _)| name.clone()));
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
