//! The unit that the header of a column and its asker agree on.

use std::ops::Range;

use super::faults::{NO_UNIT, UNIT, UNIT_CLASH};
use super::heading::Heading;
use super::request::Request;
use gumption_core::quantity::{Unit, UnitError, hint_for_clash};
use gumption_fault::{Fault, Said, say};

/// The unit of a column of numbers, of which the header and the asker must not say different things.
///
/// # Errors
/// They do, or the unit is not known, missing, or of another dimension than the one that is needed.
pub(super) fn unit_of(
    heading: &Heading,
    request: &Request,
    span: &Range<usize>,
) -> Result<Option<Unit>, Box<Fault>> {
    let fault = |code, message: Said| Fault::new(code, span.clone(), message);
    let text = &heading.text;
    let unit = match (&heading.unit, &request.unit) {
        (Ok(None), stated) => stated.clone(),
        (Ok(Some(unit)), None) => Some(unit.clone()),
        (Ok(Some(unit)), Some(stated)) if same(unit, stated) => Some(stated.clone()),
        (Ok(Some(unit)), Some(stated)) if is_free_fall(unit, stated) => Some(stated.clone()),
        (Ok(Some(unit)), Some(stated)) => {
            let (unit, stated) = (&unit.symbol, &stated.symbol);
            let message =
                say!("column \"{text}\" is said to be in {stated}, its header says {unit}");
            return Err(Box::new(
                fault(UNIT_CLASH, message)
                    .label(say!("in {unit}"))
                    .help(say!(
                        "state the unit once; leave it out where the header has it"
                    )),
            ));
        }
        (Err(_), Some(stated)) => Some(stated.clone()),
        (Err(error), None) => return Err(Box::new(heading.unknown_unit(error, span))),
    };
    if let Some(into) = &request.into {
        return match &unit {
            Some(found) if found.conversion_to(into).is_none() => {
                Err(Box::new(clash(heading, request, found, into, span)))
            }
            _ => Ok(unit),
        };
    }
    let Some(like) = &request.like else {
        return Ok(unit);
    };
    match &unit {
        None if like.is_one() => Ok(unit),
        None => {
            let (role, symbol) = (&request.role, &like.symbol);
            let message = say!("column \"{text}\" ({role}) has no unit");
            Err(Box::new(
                fault(NO_UNIT, message)
                    .label(say!("a unit such as {symbol} is missing"))
                    .help(say!(
                        "write `{text} [{symbol}]`, or state the unit where the column is named"
                    )),
            ))
        }
        Some(found) if found.dimension == like.dimension => Ok(unit),
        Some(found) => Err(Box::new(clash(heading, request, found, like, span))),
    }
}

impl Heading {
    /// The fault of a header, which stands here, whose unit is not known.
    pub fn unknown_unit(&self, error: &UnitError, span: &Range<usize>) -> Fault {
        let at = span.start + error.span.start..span.start + error.span.end;
        let text = &self.text;
        let message = say!("column \"{text}\": {}", error.message);
        let mut fault = Fault::new(UNIT, at, message).label(say!("no unit"));
        fault.help = error.help.clone().map(|help| *help);
        fault
    }
}

/// A column in a unit of another dimension than the one that is needed.
fn clash(
    heading: &Heading,
    request: &Request,
    found: &Unit,
    needed: &Unit,
    span: &Range<usize>,
) -> Fault {
    let (text, role, symbol) = (&heading.text, &request.role, &found.symbol);
    let label = say!("in {symbol}");
    let (message, help) = if needed.is_one() {
        (
            say!("column \"{text}\" is in {symbol}, and {role} is a number without unit"),
            say!("state the unit where the column is asked for: unit = \"{symbol}\""),
        )
    } else {
        let message = say!(
            "column \"{text}\" ({role}) is in {symbol}, which is no unit like {}",
            needed.symbol
        );
        let hint = hint_for_clash(needed, found);
        let otherwise = || say!("check which column has this role, and its unit");
        (message, hint.unwrap_or_else(otherwise))
    };
    Fault::new(UNIT_CLASH, span.clone(), message)
        .label(label)
        .help(help)
}

/// Whether a header writes g for the acceleration of free fall that the asker states as gn.
fn is_free_fall(header: &Unit, stated: &Unit) -> bool {
    matches!(
        (header.symbol.as_str(), stated.symbol.as_str()),
        ("g", "gn") | ("mg", "mgn") | ("µg", "µgn")
    )
}

fn same(a: &Unit, b: &Unit) -> bool {
    a.conversion_to(b)
        .is_some_and(|conversion| conversion.is_identity())
}
