//! Slips in the result itself: a correction that was not made, or with the wrong sign.

use crate::calculate::{Case, unit_of_y};
use crate::claim::Row;
use crate::printed::Printed;
use crate::units;

use super::slip::{Act, Change, Reporting, Slip, Weight::*};
use super::whole::UNIT_OF_U;

/// Of which it is looked for only once everything else is known: no uncertainty depends on it.
fn apart(_: &Case<'_>) -> Vec<super::slip::Place> {
    Vec::new()
}

#[rustfmt::skip]
pub(super) const SLIPS: &[Slip] = &[
    Slip { id: "correction-left-out", rule: "7", weight: Error,
        en: "the estimate of the row is not in the result",
        zh: "结果中没有计入该行的估计值",
        acts: apart },
    Slip { id: "correction-sign", rule: "7", weight: Error,
        en: "the estimate of the row is in the result with the wrong sign",
        zh: "该行的估计值以相反的符号计入结果",
        acts: apart },
];

/// How often an estimate is missing in the result: once where it was left out, twice where its sign is wrong.
const TIMES: [f64; 2] = [1.0, 2.0];

/// A result that a slip with one estimate has made, the only one that gives it, and the probability that it is met by
/// chance: with n places to look at and a result that departs by d, n·h/d, where h is half a unit of its last digit.
pub(crate) fn of_result(case: &Case<'_>) -> Option<(Act, f64)> {
    let y = case.claimed.footer.y.as_ref()?;
    let half = y.half_of_digits();
    let met = |x: f64| y.is_met_within(x, half);
    let sums = sums(case)?;
    if sums.iter().any(|sum| met(sum.total)) {
        return None;
    }
    let mut found: Vec<Act> = Vec::new();
    let (mut places, mut departs) = (0, f64::INFINITY);
    for sum in &sums {
        departs = (y.value - sum.total).abs().min(departs);
        for (row, part) in sum.terms() {
            for (slip, times) in SLIPS.iter().zip(TIMES).take(sum.ways) {
                places += 1;
                let is_new = found.iter().all(|act| act.row != Some(row));
                if is_new && met(sum.total - times * part) {
                    found.push(Act {
                        slip,
                        row: Some(row),
                        change: Change::Result((sums.len() == 1).then_some(sum.total)),
                    });
                }
            }
        }
    }
    let accident = f64::from(places) * half / departs;
    match found.as_slice() {
        [one] => Some((*one, accident)),
        _ => None,
    }
}

/// The right result, where it is known and the claimed one is another. Without a model, a result may be the deviation from
/// the largest estimate.
pub(crate) fn other_result(case: &Case<'_>) -> Option<f64> {
    let y = case.claimed.footer.y.as_ref()?;
    let sums = sums(case)?;
    let [sum] = sums.as_slice() else {
        return None;
    };
    let deviation = case.y.is_none().then(|| sum.parts.iter().sum());
    let mut right = [Some(sum.total), deviation].into_iter().flatten();
    let half = y.half_of_digits() + open_by_estimates(case);
    let is_met = right.any(|right: f64| y.is_met_within(right, half));
    (!is_met).then_some(sum.total)
}

/// By how much a result may differ from what the printed estimates give, because a model bends or magnifies what their digits
/// leave open. What is only added is printed with the digits that it has.
fn open_by_estimates(case: &Case<'_>) -> f64 {
    let slopes = case.derivatives.as_deref().unwrap_or_default();
    let open = |(row, slope): (&Row, &f64)| {
        let value = row.value.as_ref().filter(|_| slope.abs() != 1.0);
        value.map_or(0.0, |value| slope.abs() * value.half)
    };
    case.claimed.rows.iter().zip(slopes).map(open).sum()
}

/// Whether nothing says what the claimed result should be: no model gives it, nor do the estimates with any signs.
pub(crate) fn is_open(case: &Case<'_>) -> bool {
    let is_met = |y: &Printed| {
        let half = y.half_of_digits();
        let sums = sums(case).unwrap_or_default();
        // One sum alone is what the result is held against.
        sums.len() == 1 || sums.iter().any(|sum| y.is_met_within(sum.total, half))
    };
    let y = case.claimed.footer.y.as_ref();
    y.is_some_and(|y| !is_met(y)) && of_result(case).is_none()
}

/// What a result may be: a sum, and what rows add to it.
struct Sum {
    total: f64,
    parts: Vec<f64>,
    /// In how many ways an estimate may be missing: where its sign is not known, it cannot be wrong.
    ways: usize,
}

impl Sum {
    fn of(parts: Vec<f64>, ways: usize) -> Sum {
        Sum {
            total: parts.iter().sum(),
            parts,
            ways,
        }
    }

    fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        let parts = self.parts.iter().copied().enumerate();
        parts.filter(|(_, part)| *part != 0.0)
    }

    /// Without its largest terms: a result may be the deviation from them.
    fn of_corrections(mut self) -> Sum {
        let largest = self.parts.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        for part in &mut self.parts {
            if part.abs() == largest {
                *part = 0.0;
            }
        }
        self
    }
}

fn sums(case: &Case<'_>) -> Option<Vec<Sum>> {
    match (case.y, &case.claimed.model) {
        (Some(y), _) => Some(vec![of_model(case, y)]),
        (None, None) => of_estimates(case),
        (None, Some(_)) => None,
    }
}

/// The terms of a model: what is multiplied by something is none.
fn of_model(case: &Case<'_>, total: f64) -> Sum {
    let slopes = case.derivatives.as_deref().unwrap_or_default();
    let rows = case.claimed.rows.iter().zip(slopes);
    let part = |(row, slope): (&Row, &f64)| match &row.value {
        Some(value) if slope.abs() == 1.0 => slope * value.value,
        _ => 0.0,
    };
    let parts = rows.map(part).collect();
    let ways = TIMES.len();
    Sum { total, parts, ways }
}

/// Without a model, estimates in the unit of the result are added; where all coefficients are printed as positive, each with
/// either sign.
fn of_estimates(case: &Case<'_>) -> Option<Vec<Sum>> {
    /// A bound of the work: 2^6 sums.
    const MOST: usize = 6;
    let rows = &case.claimed.rows;
    let unit = unit_of_y(case.claimed);
    let part = |row: &Row| {
        let value = row.value.as_ref()?;
        let factor = units::factor(&value.unit, unit);
        let c = row.c.as_ref().map_or(1.0, |c| c.value);
        match factor.filter(|_| c.abs() == 1.0) {
            Some(factor) => Some(c * factor * value.value),
            None => (value.value == 0.0).then_some(0.0),
        }
    };
    let parts: Vec<f64> = rows.iter().map(part).collect::<Option<_>>()?;
    let added: Vec<usize> = (0..parts.len()).filter(|i| parts[*i] != 0.0).collect();
    if added.len() < 2 {
        return None;
    }
    let is_signed = |row: &Row| row.c.as_ref().is_some_and(|c| c.value < 0.0);
    if rows.iter().any(is_signed) {
        return Some(vec![Sum::of(parts, TIMES.len()).of_corrections()]);
    }
    let with = |signs: usize| {
        let mut parts = parts.clone();
        for (bit, i) in added.iter().enumerate() {
            parts[*i] *= if signs >> bit & 1 == 1 { -1.0 } else { 1.0 };
        }
        Sum::of(parts, 1).of_corrections()
    };
    (added.len() <= MOST).then(|| (0..1 << added.len()).map(with).collect())
}

/// U in a unit to which no contribution can be converted: rows whose coefficient is printed as 1 are in that of the
/// result, unless y, u_c or the contributions say that it has a unit.
pub(crate) fn of_unit(case: &Case<'_>) -> Option<Act> {
    let unit = &case.claimed.footer.expanded.as_ref()?.unit;
    if units::parse(unit).is_none() || units::fraction(unit).is_some() {
        return None;
    }
    let contributions = case.claimed.rows.iter().map(|row| &row.contribution);
    let footer = &case.claimed.footer;
    let mut made = contributions.chain([&footer.u_c, &footer.y]).flatten();
    if made.any(|figure| units::factor(&figure.unit, unit).is_some()) {
        return None;
    }
    let rows = case.claimed.rows.iter();
    let of_result = rows.filter(|row| {
        let plain = row
            .c
            .as_ref()
            .is_some_and(|c| c.value.abs() == 1.0 && c.unit.is_empty());
        plain && row.not_counted.is_none() && !row.unit.is_empty()
    });
    let units: Vec<&str> = of_result.map(|row| row.unit.as_str()).collect();
    let is_strange =
        |own: &&str| units::factor(own, unit).is_none() && units::fraction(own).is_none();
    let change = Change::Report(Reporting::Scale(1.0));
    let slip = super::slip(UNIT_OF_U)?;
    (units.len() >= 2 && units.iter().all(is_strange)).then_some(Act {
        slip,
        row: None,
        change,
    })
}
