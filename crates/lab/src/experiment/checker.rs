//! What all checks of an experiment share: the file with its places, the files that it names, its units.

use std::ops::Range;
use std::path::Path;

use super::faults::{KEY, UNIT};
use super::purpose::Purpose;
use super::source::{self, Source, entries};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::{Code, Fault, Rejection, Said, say};
use gumption_format::files::Files;
use gumption_format::toml::{Amount, Stated};
use gumption_gum::budget::faults::RELATIVE_UNCLEAR;
use gumption_gum::budget::quantities::{self, is_unclear_share};

/// What all checks share.
pub(crate) struct Checker<'s> {
    pub source: &'s Source,
    pub purpose: Purpose,
    /// Where the files are that the experiment names.
    pub files: Files<'s>,
    /// The folder from which their paths start.
    pub folder: &'s Path,
    pub units: UnitTable,
    pub faults: Vec<Fault>,
}

/// The tables of an experiment; `name` is that of its file in messages.
///
/// # Errors
/// The text is no TOML.
pub(crate) fn opened(text: &str, name: &str) -> Result<Source, Rejection> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    source::read(text).map_err(|faults| Rejection::new(name, text, faults))
}

/// What is made of a file, after `list` has listed parameters that the file does not list.
///
/// # Errors
/// All faults of the file, and after them those of its recording.
pub(crate) fn made<T>(
    mut source: Source,
    name: &str,
    purpose: Purpose,
    files: Files<'_>,
    folder: &Path,
    list: impl FnOnce(&mut Source, &UnitTable, Files<'_>, &Path),
    make: impl FnOnce(&mut Checker<'_>) -> Result<Option<T>, Box<Rejection>>,
) -> Result<T, Rejection> {
    let units = Checker::new(&source, purpose, files, folder).units;
    list(&mut source, &units, files, folder);
    let mut checker = Checker::new(&source, purpose, files, folder);
    let made = make(&mut checker);
    let is_whole = checker.faults.is_empty();
    match made {
        Ok(Some(made)) if is_whole => Ok(made),
        Ok(_) => Err(checker.rejection(name)),
        Err(recording) if is_whole => Err(*recording),
        Err(recording) => {
            let mut rejection = checker.rejection(name);
            rejection.others.push(*recording);
            Err(rejection)
        }
    }
}

impl<'s> Checker<'s> {
    /// Nothing is checked yet but the units of the file's own.
    pub fn new(
        source: &'s Source,
        purpose: Purpose,
        files: Files<'s>,
        folder: &'s Path,
    ) -> Checker<'s> {
        let (units, wrong) = quantities::units(entries(&source.table.unit), &source.text);
        let mut faults = source.faults.clone();
        faults.extend(wrong);
        Checker {
            source,
            purpose,
            files,
            folder,
            units,
            faults,
        }
    }

    /// Reports a fault, with what was expected at its place.
    pub fn wrong(&mut self, code: Code, place: &Range<usize>, message: Said, expected: Said) {
        let fault = Fault::new(code, place.clone(), message);
        self.faults.push(fault.label(expected));
    }

    /// Reports a fault; nothing can be returned.
    pub fn refuse<T>(&mut self, fault: Fault) -> Option<T> {
        self.faults.push(fault);
        None
    }

    /// All faults, at their places in the file itself.
    pub fn rejection(self, name: &str) -> Rejection {
        let source = self.source;
        let faults = self.faults.into_iter();
        let faults = faults.map(|fault| source.in_own_text(fault)).collect();
        Rejection::new(name, &source.text[..source.own], faults)
    }

    /// A stated unit.
    pub fn unit(&mut self, stated: &Stated<String>) -> Option<Unit> {
        match self.units.parse(&stated.value) {
            Ok(unit) => Some(unit),
            Err(error) => {
                let fault = quantities::placed(Fault::from(error), stated, &self.source.text);
                self.refuse(fault)
            }
        }
    }

    /// A stated amount in a unit; its own unit is read as `kind` says.
    fn converted(
        &mut self,
        stated: &Stated<Amount>,
        unit: &Unit,
        kind: impl Fn(&Unit) -> Unit,
    ) -> Option<f64> {
        let Some((text, place)) = &stated.value.unit else {
            return Some(stated.value.number);
        };
        let own = kind(&self.unit(&Stated {
            value: text.clone(),
            span: place.clone(),
            key: place.clone(),
        })?);
        match own.conversion_to(unit) {
            Some(conversion) => Some(conversion.apply(stated.value.number)),
            None => self.refuse(
                Fault::new(
                    UNIT,
                    place.clone(),
                    say!("{} cannot be converted to {}", own.symbol, unit.symbol),
                )
                .label(say!("expected {} or a unit like it", unit.symbol)),
            ),
        }
    }

    /// A stated amount in a unit.
    pub fn amount(&mut self, stated: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        // A size of 1 °C where the quantity is in K is a difference.
        let kind = |own: &Unit| match unit.is_point() {
            true => own.clone(),
            false => own.difference(),
        };
        self.converted(stated, unit, kind)
    }

    /// A positive amount in the unit of differences: 0.05 °C is no point on the scale here.
    pub fn spread(&mut self, stated: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        let unit = unit.difference();
        let value = self.converted(stated, &unit, Unit::difference)?;
        let own = stated.value.unit.as_ref();
        let own = own.and_then(|(text, _)| self.units.parse(text).ok());
        // In the unit of the quantity itself there is nothing to ask of what is the same for all rows.
        let unclear = |own: &Unit| own.symbol != unit.symbol && is_unclear_share(own, &unit);
        if let Some(own) = own.filter(unclear) {
            let number = stated.value.number;
            let within = match unit.is_one() {
                true => Said::default(),
                false => say!(" (in {})", unit.symbol),
            };
            let message = say!(
                "{number} {} may be meant of a value or as it stands",
                own.symbol
            );
            return self.refuse(
                Fault::new(RELATIVE_UNCLEAR, stated.span.clone(), message)
                    .label(say!("relative or absolute?"))
                    .help(say!(
                        "as it stands, write the plain number {value}{within}; of a value, write what {number} {} of it is",
                        own.symbol
                    )),
            );
        }
        if value > 0.0 {
            return Some(value);
        }
        self.refuse(
            Fault::new(
                KEY,
                stated.span.clone(),
                say!("a standard uncertainty is positive"),
            )
            .label(say!("expected a positive number")),
        )
    }

    /// The unit of a response that is not recorded yet.
    pub fn planned_unit(&self, name: &str) -> Option<Unit> {
        let table = &self.source.table;
        let column = entries(&table.columns)
            .iter()
            .find(|(other, _)| other == name);
        let reading = entries(&table.reading)
            .iter()
            .find(|(other, _)| other == name);
        let stated = column
            .and_then(|(_, entry)| entry.value.0.unit.as_ref())
            .or_else(|| reading.and_then(|(_, entry)| entry.value.input.unit.as_ref()))
            .or_else(|| column.and_then(|(_, entry)| entry.value.0.like.as_ref()));
        stated.map_or_else(
            || Some(Unit::one()),
            |stated| self.units.parse(&stated.value).ok(),
        )
    }
}
