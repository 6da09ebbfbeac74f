//! Numbers from lists or from columns of CSV files.

use std::ops::Range;

use super::amounts::Share;
use super::checker::Checker;
use crate::budget::faults::{CSV, MISSING_KEY, VECTOR};
use crate::budget::tables::{ColumnTable, ComponentTable};
use crate::budget::variants::{Amounts, Numbers};
use gumption_core::quantity::Unit;
use gumption_core::statistics::Dd;
use gumption_fault::{Fault, Rejection, say};
use gumption_format::csv::faults::{NO_COLUMN, NOT_UTF8, TOO_LARGE};
use gumption_format::csv::{Recording, Request, absent, no_column};
use gumption_format::toml::Amount;
use gumption_format::toml::faults::UNREADABLE_FILE;
use gumption_format::toml::{Slot, Stated};

impl Checker<'_> {
    /// The numbers themselves.
    pub(super) fn numbers(
        &mut self,
        numbers: &Stated<Numbers>,
        unit: Option<&Unit>,
    ) -> Option<Vec<f64>> {
        let exact = self.exact_numbers(numbers, unit)?;
        Some(exact.into_iter().map(Dd::value).collect())
    }

    /// The numbers as the decimals that are written; a column that states its unit is converted.
    pub(super) fn exact_numbers(
        &mut self,
        numbers: &Stated<Numbers>,
        unit: Option<&Unit>,
    ) -> Option<Vec<Dd>> {
        match &numbers.value {
            Numbers::List(list) => Some(self.exact(list)),
            Numbers::Lists(_) => self.refuse(
                Fault::new(VECTOR, numbers.span.clone(), say!("several lists of readings for a single quantity"))
                    .label(say!("lists in a list"))
                    .help(say!("readings in groups are `groups = [[…], […]]`; the elements of a vector have `values`, and a list of readings each")),
            ),
            Numbers::Column(table) if table.refused => None,
            Numbers::Column(table) => self.column(table, unit, &numbers.span),
        }
    }

    /// A component in which amounts from columns of CSV files stand as lists; `None` if it names no column.
    /// Deviations are in the unit of differences, fractions of the value in none.
    pub(super) fn with_columns(
        &mut self,
        table: &ComponentTable,
        unit: &Unit,
    ) -> Option<ComponentTable> {
        let named = |stated: &Slot<Amounts>| {
            matches!(stated.as_ref().map(|s| &s.value), Some(Amounts::Column(_)))
        };
        if !named(&table.u) && !named(&table.half_width) {
            return None;
        }
        let unit = match table.share() {
            Share::OfValue => Unit::one(),
            Share::Unsaid | Share::AsItStands => unit.difference(),
        };
        let mut listed = table.clone();
        for stated in [&mut listed.u, &mut listed.half_width]
            .into_iter()
            .flatten()
        {
            let Amounts::Column(column) = &mut stated.value else {
                continue;
            };
            if column.refused {
                continue;
            }
            let Some(numbers) = self.column(column, Some(&unit), &stated.span) else {
                column.refused = true;
                continue;
            };
            let amount = |number: Dd| Stated {
                value: Amount {
                    number: number.value(),
                    unit: None,
                },
                span: stated.span.clone(),
                key: stated.key.clone(),
            };
            stated.value = Amounts::Each(numbers.into_iter().map(amount).collect());
        }
        Some(listed)
    }

    /// Numbers of the file with all their decimals.
    pub(super) fn exact(&self, list: &[Stated<f64>]) -> Vec<Dd> {
        list.iter().map(|number| self.decimal(number)).collect()
    }

    fn decimal(&self, number: &Stated<f64>) -> Dd {
        let text = self
            .source
            .text
            .get(number.span.clone())
            .unwrap_or_default();
        Dd::parse(&text.replace('_', ""))
            .filter(|decimal| decimal.value() == number.value)
            .unwrap_or(Dd::from(number.value))
    }

    fn column(
        &mut self,
        table: &ColumnTable,
        unit: Option<&Unit>,
        place: &Range<usize>,
    ) -> Option<Vec<Dd>> {
        let (Some(file), Some(column)) = (&table.file, &table.column) else {
            let missing = if table.file.is_none() {
                "file"
            } else {
                "column"
            };
            let example = "{ file = \"readings.csv\", column = \"name\" }";
            return self.refuse(lacks(missing, place, example));
        };
        let table = self.csv(file, &[(column, decimals(column, unit))])?;
        table.columns.into_iter().next()?.decimals
    }

    /// Columns of a CSV file, each with the place of its name in the budget.
    pub(super) fn csv(
        &mut self,
        file: &Stated<String>,
        columns: &[(&Stated<String>, Request)],
    ) -> Option<Recording> {
        let path = self.source.origin.directory.join(&file.value);
        let requests: Vec<Request> = columns.iter().map(|(_, request)| request.clone()).collect();
        let files = self.source.origin.files;
        let units = &self.names.units;
        match Recording::open(files.files, &path, &requests, units) {
            Ok(table) => Some(table),
            Err(rejection) => self.csv_refused(file, columns, rejection),
        }
    }

    /// Faults of a table are shown in its own lines; a name that it lacks, and a file that is no text, in the
    /// budget.
    fn csv_refused<T>(
        &mut self,
        file: &Stated<String>,
        columns: &[(&Stated<String>, Request)],
        mut rejection: Rejection,
    ) -> Option<T> {
        let shown = rejection.name.clone();
        let (unknown, faults): (Vec<Fault>, Vec<Fault>) = rejection
            .faults
            .into_iter()
            .partition(|fault| fault.code == NO_COLUMN);
        for fault in unknown {
            let is_of = |name: &str| fault.message == no_column(name);
            let named = columns.iter().find(|(name, _)| is_of(name.value.trim()));
            let (place, name) = named.map_or((file, ""), |(name, _)| (*name, &name.value));
            let message = say!("{} has no column \"{name}\"", file.value);
            self.report(Fault {
                help: fault.help,
                ..Fault::new(CSV, place.span.clone(), message).label(say!("no such column"))
            });
        }
        rejection.faults = faults;
        if let (true, Some(fault)) = (rejection.text.is_empty(), rejection.faults.first()) {
            let folder = self.source.origin.folder();
            let message = fault.message.clone().renamed(&shown, &file.value);
            let message = match fault.message == absent(&shown) {
                true => say!("{message} in {folder}"),
                false => message,
            };
            return self.refuse(Fault {
                code: match [NOT_UTF8, TOO_LARGE].contains(&fault.code) {
                    true => fault.code,
                    false => UNREADABLE_FILE,
                },
                message,
                label: say!("expected a CSV file"),
                span: file.span.clone(),
                ..fault.clone()
            });
        }
        if !rejection.faults.is_empty() {
            self.report(
                Fault::new(
                    CSV,
                    file.span.clone(),
                    say!("{} cannot be used as it is", file.value),
                )
                .label(say!("has faults itself"))
                .help(say!("its faults are listed after those of this file")),
            );
            self.source.origin.files.refused(rejection);
        }
        None
    }
}

/// The decimals of a column, one in every row, in a unit where one is known.
pub(super) fn decimals(column: &Stated<String>, unit: Option<&Unit>) -> Request {
    let request = Request::decimals(&column.value, &column.value);
    match unit {
        Some(unit) => request.into_unit(unit.clone()),
        None => request,
    }
}

/// A table that names no file, or not all that is needed to find a column in it.
pub(super) fn lacks(missing: &str, place: &Range<usize>, example: &str) -> Fault {
    let message = say!("the CSV column lacks `{missing}`");
    Fault::new(MISSING_KEY, place.clone(), message)
        .label(say!("`{missing}` is missing"))
        .help(say!("write {example}"))
}
