//! The unit of a result, where its own figures or those of its rows have one.

use crate::claim::{Claimed, Row};
use crate::printed::Printed;
use crate::units;

use super::words;

pub(super) fn unit_of_result(claimed: &Claimed) -> String {
    let footer = &claimed.footer;
    let contributions = claimed.rows.iter().map(|row| &row.contribution);
    let figures = [&footer.u_c].into_iter().chain(contributions);
    let unit_of = |figure: &Printed| Some(figure.unit.clone()).filter(|unit| !unit.is_empty());
    let mut stated = figures.chain([&footer.y]).flatten();
    let unit = stated
        .find_map(unit_of)
        .or_else(|| unit_of_plain_rows(claimed))
        .or_else(|| unit_of_shares(claimed))
        .or_else(|| unit_of_sum(claimed));
    unit.or_else(|| unit_of(footer.expanded.as_ref()?))
        .unwrap_or_default()
}

/// The unit of rows that are all in one relative unit, and have no coefficients: what they come to is in it, too.
fn unit_of_shares(claimed: &Claimed) -> Option<String> {
    let unit = &claimed.rows.first()?.unit;
    let is_of_it = |row: &Row| &row.unit == unit && row.c.is_none() && row.value.is_none();
    let are_shares = units::fraction(unit).is_some() && claimed.rows.iter().all(is_of_it);
    are_shares.then(|| unit.clone())
}

/// The unit of rows that are all in it, where u_c is the root of the sum of their squares as they stand: U may be in another one.
fn unit_of_sum(claimed: &Claimed) -> Option<String> {
    let u_c = claimed.footer.u_c.as_ref()?;
    let unit_of = |row: &Row| {
        let own = row.u.as_ref().map(|u| &u.unit);
        let mut units = own.into_iter().chain([&row.unit]);
        units.find(|unit| !unit.is_empty()).cloned()
    };
    let unit = unit_of(claimed.rows.first()?)?;
    let is_plain = |row: &Row| {
        let is_of_it = unit_of(row).as_ref() == Some(&unit);
        is_of_it && row.c.is_none() && row.contribution.is_none()
    };
    let parts = claimed.rows.iter().filter(|row| row.not_counted.is_none());
    let squares = parts.map(|row| row.u.as_ref().map(|u| u.value * u.value));
    let root = libm::sqrt(squares.sum::<Option<f64>>()?);
    let is_sum = u_c.is_met_within(root, 2.0 * u_c.half_of_digits());
    (is_sum && claimed.rows.iter().all(is_plain)).then_some(unit)
}

/// The unit of rows whose contribution is printed with the figure of u, by a coefficient of 1: U may be in another one.
fn unit_of_plain_rows(claimed: &Claimed) -> Option<String> {
    let plain = |row: &Row| {
        let c = row.c.as_ref()?;
        let worked = row.used.as_ref().zip(row.divisor.as_ref());
        let worked = worked.map(|(used, divisor)| (used.value / divisor.value, &used.unit));
        let (u, unit) = row.u.as_ref().map(|u| (u.value, &u.unit)).or(worked)?;
        let made = row.contribution.as_ref()?.value.abs();
        let same = c.value.abs() == 1.0 && c.unit.is_empty() && (made - u).abs() <= 0.01 * u;
        let known = [unit, &row.unit].into_iter().find(|unit| !unit.is_empty());
        let unit = known.cloned().or_else(|| unit_in_words(row));
        unit.filter(|_| same)
    };
    let units: Vec<String> = claimed.rows.iter().filter_map(plain).collect();
    let first = units.first()?;
    // A single row is enough to tell a unit from a multiple of it.
    let expanded = claimed.footer.expanded.as_ref();
    let is_multiple = expanded.is_some_and(|u| units::factor(&u.unit, first).is_some());
    let enough = units.len() >= 2 || is_multiple;
    (enough && units.iter().all(|unit| unit == first)).then(|| first.clone())
}

/// The unit in which the words of a row state the figure of its ± column, or twice that: `resolution 0.01 mm` beside 0.005.
fn unit_in_words(row: &Row) -> Option<String> {
    let used = row.used.as_ref()?.value;
    let is_it = |figure: &Printed| {
        let ratio = figure.value / used;
        [1.0, 2.0].iter().any(|times| (ratio - times).abs() < 1e-9)
    };
    let mut figures = words::figures_with_units(&row.words);
    figures.find(is_it).map(|figure| figure.unit)
}
