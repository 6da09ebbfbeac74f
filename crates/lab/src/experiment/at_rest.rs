//! Reading a recording at rest.

use std::path::Path;

use super::checker::Checker;
use super::faults::NOISE;
use super::tables::StaticTable;
use crate::recording::{Average, Heading, Recording, Request};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::{Fault, Rejection, Said, say};
use gumption_format::files::Files;
use gumption_format::toml::Stated;

/// A column as the recording itself heads it, with its unit there.
#[derive(Debug, Clone)]
pub(crate) struct Headed {
    pub name: String,
    pub header: String,
    pub unit: Unit,
}

/// What an output showed at rest.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RestReadings {
    /// Times, h; `None` where the file has none.
    pub times: Option<Vec<f64>>,
    /// Readings in the unit of the output.
    pub readings: Vec<f64>,
    /// Their mean and scatter.
    pub average: Average,
}

impl Checker<'_> {
    /// Readings of every output: of the column that is named, or of the one that is called like the output, with
    /// the times of the column that is called like `time`, if it is there.
    pub fn at_rest(
        &mut self,
        stated: &Stated<StaticTable>,
        outputs: &[Headed],
        time: Option<&Headed>,
    ) -> Option<Vec<RestReadings>> {
        let Some(file) = &stated.value.file else {
            let message = say!("a recording at rest has a `file`");
            let fault = Fault::new(NOISE, stated.span.clone(), message);
            return self.refuse(fault.label(say!("expected `file`")));
        };
        let place = Rest {
            files: self.files,
            path: &self.folder.join(&file.value),
            units: &self.units,
        };
        let times = time.and_then(|time| place.times(time));
        let named = stated.value.column.as_ref();
        let one = |output: &Headed| {
            let name = named.map_or(&output.header, |column| &column.value);
            place.readings(name, output, times.as_deref())
        };
        match outputs.iter().map(one).collect() {
            Ok(readings) => Some(readings),
            Err(why) => self.refuse(Fault::new(
                NOISE,
                file.span.clone(),
                say!("the recording at rest: {why}"),
            )),
        }
    }
}

/// Hours in a unit of time.
pub(crate) fn hours(unit: &Unit, units: &UnitTable) -> Option<f64> {
    let hour = units.parse("h").ok()?;
    unit.conversion_to(&hour)
        .map(|conversion| conversion.factor)
}

/// The file.
struct Rest<'a> {
    files: Files<'a>,
    path: &'a Path,
    units: &'a UnitTable,
}

impl Rest<'_> {
    /// One column: as the recording itself heads it, or by its name alone, as the unit may be another.
    fn open(&self, role: &str, header: &str) -> Result<Recording, Rejection> {
        let named = |name: &str| {
            let requests = [Request::numbers(role, name)];
            Recording::open(self.files, self.path, &requests, self.units)
        };
        named(header).or_else(|_| named(&Heading::read(header, self.units).name))
    }

    fn times(&self, time: &Headed) -> Option<Vec<f64>> {
        let recording = self.open("time", &time.header).ok()?;
        let own = recording.column("time")?.unit.clone();
        let factor = hours(&own.unwrap_or_else(|| time.unit.clone()), self.units)?;
        let times = recording.numbers("time")?;
        Some(times.iter().map(|t| t * factor).collect())
    }

    fn readings(
        &self,
        name: &str,
        output: &Headed,
        times: Option<&[f64]>,
    ) -> Result<RestReadings, Said> {
        let recording = (self.open("rest", name)).map_err(|rejection| rejection.said())?;
        let column = recording.column("rest");
        let factor = match column.and_then(|column| column.unit.clone()) {
            None => 1.0,
            Some(unit) => unit
                .difference()
                .conversion_to(&output.unit.difference())
                .map(|conversion| conversion.factor)
                .ok_or_else(|| say!("the unit of `{name}` is not that of {}", output.name))?,
        };
        let all = recording.numbers("rest").unwrap_or(&[]);
        let kept: Vec<usize> = (0..all.len()).filter(|row| all[*row].is_finite()).collect();
        let readings: Vec<f64> = kept.iter().map(|row| all[*row] * factor).collect();
        let average = Average::of(&readings).ok();
        let average = average.filter(|average| average.n >= 3 && average.minimum < average.maximum);
        let few = || say!("`{name}` has too few readings, or no scatter");
        let average = average.ok_or_else(few)?;
        let times = times.filter(|times| times.len() == all.len());
        Ok(RestReadings {
            times: times.map(|times| kept.iter().map(|row| times[*row]).collect()),
            average,
            readings,
        })
    }
}
