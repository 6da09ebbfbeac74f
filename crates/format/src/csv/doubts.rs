//! Doubts about a table that no field shows by itself.

use std::ops::Range;

use super::faults::{NOT_A_NUMBER, SAME_NAME};
use super::field::{Field, OVERLOAD, is_overload};
use super::sheet::Sheet;
use gumption_fault::{Fault, Said, say};

/// How the decimals of a column are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    /// With a point.
    Point,
    /// With a comma.
    Comma,
}

impl Sign {
    /// The sign of a number that has one.
    pub(super) fn of(field: Field) -> Option<Sign> {
        match field {
            Field::Point(_) => Some(Sign::Point),
            Field::Comma(_) => Some(Sign::Comma),
            Field::Whole(_) | Field::Clock(_) => None,
        }
    }

    /// The first of these columns that has a number with this sign.
    pub(super) fn first_in(self, sheet: &Sheet<'_>, has: impl Fn(usize) -> bool) -> Option<usize> {
        // A table whose commas separate columns has no decimal commas, and most others have no commas at all.
        if !sheet.has_decimal_commas() || !sheet.text().contains(',') {
            return None;
        }
        let rows = sheet.rows().filter_map(Result::ok);
        rows.filter_map(|row| {
            let mut fields = row.fields().enumerate();
            let signed = |field: &str| Field::read(field, sheet).and_then(Sign::of);
            let found = fields.find(|(at, field)| has(*at) && signed(field) == Some(self));
            found.map(|(at, _)| at)
        })
        .next()
    }
}

/// Columns with decimal points beside columns with decimal commas: one of them is read wrongly, as both also mark
/// thousands. Each with its text in the first line, and its place.
pub(super) fn two_signs(
    (points, at_points): (&str, Range<usize>),
    (commas, at_commas): (&str, Range<usize>),
) -> Fault {
    let message =
        say!("column \"{points}\" is written with decimal points, column \"{commas}\" with commas");
    Fault::new(NOT_A_NUMBER, at_commas, message)
        .label(say!("decimal commas, or marks of thousands?"))
        .related(at_points, say!("decimal points"))
        .help(say!(
            "write all numbers of a table with one decimal sign, and without marks of thousands"
        ))
}

/// Columns of numbers that are written with two decimal signs.
pub fn two_decimal_signs(sheet: &Sheet<'_>, has_numbers: impl Fn(usize) -> bool) -> Option<Fault> {
    let column = |sign: Sign| {
        let at = sign.first_in(sheet, &has_numbers)?;
        Some((sheet.header().field(at).to_owned(), sheet.name_place(at)))
    };
    let ((points, at_points), (commas, at_commas)) = (column(Sign::Point)?, column(Sign::Comma)?);
    Some(two_signs((&points, at_points), (&commas, at_commas)))
}

/// Two columns of one name, with their places.
pub(super) fn same_name(name: &str, first: Range<usize>, second: Range<usize>) -> Fault {
    Fault::new(
        SAME_NAME,
        second,
        say!("\"{name}\" is the name of two columns"),
    )
    .label(say!("the second"))
    .related(first, say!("the first"))
}

/// What is to be done about a range that was exceeded.
pub(super) fn mend_of_overload() -> Said {
    say!(
        "instruments write {OVERLOAD:e} for a range that was exceeded: it is no reading; remove the row, or measure again in a higher range"
    )
}

/// A field of a column of values that says that a range was exceeded.
pub fn overload(column: &str, line: usize, field: &str, place: Range<usize>) -> Option<Fault> {
    is_overload(field).then(|| {
        let expected = say!("a number");
        Fault::new(NOT_A_NUMBER, place, not_a(column, line, field, &expected))
            .label(say!("expected {expected}"))
            .help(mend_of_overload())
    })
}

/// A field that does not hold what is expected.
pub(super) fn not_a(column: &str, line: usize, field: &str, expected: &Said) -> Said {
    say!("line {line}, column \"{column}\": \"{field}\" is not {expected}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_those_of_numbers() {
        let signs = |text: &str, but: usize| {
            let sheet = Sheet::new(text).expect("a header");
            two_decimal_signs(&sheet, |at| at != but).map(|fault| text[fault.span].to_owned())
        };
        assert_eq!(signs("a;b\n1.5;2\n3;2,5\n", 9).as_deref(), Some("b"));
        assert_eq!(signs("a;b\n1.5;2\n3;2,5\n", 0), None);
        assert_eq!(signs("a;b\n01.03.2026;2,5\n", 9), None);
        assert_eq!(signs("a,b\n1.5,2\n", 9), None);
    }
}
