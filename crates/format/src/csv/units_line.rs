//! A line of units below that of the names, as loggers write it.

use super::field::Field;
use super::heading::Heading;
use super::sheet::Sheet;
use gumption_core::quantity::{Unit, UnitTable};

impl<'a> Sheet<'a> {
    /// The same table, of which the first row is no data either where it holds the units: a unit or nothing in each column,
    /// and a number or nothing below each unit.
    #[must_use]
    pub fn above_units(self, known: &UnitTable) -> Sheet<'a> {
        match self.first_row_as_units(known) {
            Some(units) => self.with_units(units),
            None => self,
        }
    }

    fn first_row_as_units(&self, known: &UnitTable) -> Option<Vec<Option<Unit>>> {
        let mut rows = self.rows().map_while(Result::ok);
        let (line, next) = (rows.next()?, rows.next()?);
        let of_column = |(unit, below): (&str, &str)| match Field::read(unit, self) {
            None => {
                Field::read(below, self)?;
                Some(Some(Heading::unit_alone(unit, known)?))
            }
            Some(nothing) => nothing.is_missing().then_some(None),
        };
        let units: Option<Vec<_>> = line.fields().zip(next.fields()).map(of_column).collect();
        units.filter(|units| units.iter().any(Option::is_some))
    }

    /// What the line of units says of each column, and where it says nothing, what its name does.
    pub fn headings(&self, by_name: impl Fn(&str) -> Heading) -> impl Iterator<Item = Heading> {
        let names = self.header().fields().enumerate();
        names.map(move |(column, text)| match self.unit_below(column) {
            Some(unit) => Heading {
                unit: Ok(Some(unit.clone())),
                ..Heading::plain(text)
            },
            None => by_name(text),
        })
    }
}
