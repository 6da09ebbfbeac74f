//! Reading a recording at rest.

use std::path::Path;

use super::{Column, Observed, Response, RestReadings};
use crate::experiment::entries::RoleWord;
use crate::recording::{Heading, Recording, Request};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_gum::budget::{Files, Rejection};

/// Readings of every response: of the column that is named, or of the one that is called like the
/// output. Times are those of the column that is called like the time of the recording, if it is there.
pub(super) fn read(
    files: Files<'_>,
    path: &Path,
    named: Option<&str>,
    columns: &[Column],
    responses: &[Response],
    units: &UnitTable,
) -> Result<Vec<RestReadings>, String> {
    let time = columns.iter().find(|column| column.role == RoleWord::Time);
    let with_time = time.and_then(|time| {
        let recording = open(files, path, "time", &time.header, units).ok()?;
        let unit = recording
            .column("time")?
            .unit
            .clone()
            .unwrap_or_else(|| time.unit.clone());
        let factor = hours(&unit, units)?;
        Some(
            recording
                .numbers("time")?
                .iter()
                .map(|t| t * factor)
                .collect::<Vec<f64>>(),
        )
    });
    responses
        .iter()
        .map(|response| {
            one(
                files,
                path,
                named,
                columns,
                response,
                units,
                with_time.as_deref(),
            )
        })
        .collect()
}

/// The column of the recording that a response is, by its header.
fn header<'c>(columns: &'c [Column], response: &Response) -> Option<&'c str> {
    match response.observed {
        Observed::Column(column) => columns.get(column).map(|column| column.header.as_str()),
        Observed::Constant(_) => None,
    }
}

/// That of the only response.
pub(super) fn only_column<'c>(columns: &'c [Column], responses: &[Response]) -> Option<&'c str> {
    match responses {
        [only] => header(columns, only),
        _ => None,
    }
}

/// Hours in a unit of time.
pub(in crate::diagnose) fn hours(unit: &Unit, units: &UnitTable) -> Option<f64> {
    let hour = units.parse("h").ok()?;
    unit.conversion_to(&hour)
        .map(|conversion| conversion.factor)
}

/// A recording at rest with one column: as the recording itself heads it, or by its name alone, as the unit
/// may be another.
fn open(
    files: Files<'_>,
    path: &Path,
    role: &str,
    header: &str,
    units: &UnitTable,
) -> Result<Recording, Rejection> {
    let named = |name: &str| Recording::open(files, path, &[Request::numbers(role, name)], units);
    named(header).or_else(|_| named(&Heading::read(header, units).name))
}

fn one(
    files: Files<'_>,
    path: &Path,
    named: Option<&str>,
    columns: &[Column],
    response: &Response,
    units: &UnitTable,
    times: Option<&[f64]>,
) -> Result<RestReadings, String> {
    let Some(name) = named.or_else(|| header(columns, response)) else {
        return Err("name its `column`".into());
    };
    let first = |rejection: Rejection| {
        rejection
            .faults
            .first()
            .map_or_else(String::new, |fault| fault.message.clone())
    };
    let recording = open(files, path, "rest", name, units).map_err(first)?;
    let unit = recording
        .column("rest")
        .and_then(|column| column.unit.clone());
    let factor = match unit {
        None => 1.0,
        Some(unit) => match unit.difference().conversion_to(&response.unit.difference()) {
            Some(conversion) => conversion.factor,
            None => {
                return Err(format!(
                    "the unit of `{name}` is not that of {}",
                    response.name
                ));
            }
        },
    };
    let all = recording.numbers("rest").unwrap_or(&[]);
    let kept: Vec<usize> = (0..all.len()).filter(|row| all[*row].is_finite()).collect();
    let readings: Vec<f64> = kept.iter().map(|row| all[*row] * factor).collect();
    if readings.len() < 3 || readings.iter().all(|x| *x == readings[0]) {
        return Err(format!("`{name}` has too few readings, or no scatter"));
    }
    let times = times.filter(|times| times.len() == all.len());
    Ok(RestReadings {
        times: times.map(|times| kept.iter().map(|row| times[*row]).collect()),
        readings,
    })
}
