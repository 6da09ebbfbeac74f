//! Figures of the whole that are relative to the result: `u(c)/c`, `combined relative standard uncertainty`.

use crate::claim::{Claimed, Understood};
use crate::printed::Printed;
use crate::read::footer::{self, Whole};
use crate::read::words;
use crate::units;

/// Such a figure, of which the result may stand further down.
pub(super) struct Relative {
    pub(super) whole: Whole,
    pub(super) figure: Printed,
}

impl Relative {
    /// Takes its place among the figures of the whole, unless the absolute one has it: as it is where the sheet computes in
    /// relative terms, else as what it comes to.
    pub(super) fn settle(self, claimed: &mut Claimed) {
        let (at, text) = (self.figure.at, self.figure.text.clone());
        let figure = match self.of_result(claimed) {
            Some((factor, y)) => {
                let result = match claimed.measurand.as_str() {
                    "" => "y",
                    name => name,
                };
                let called = format!("{}·{result}", self.figure.as_read());
                let unit = y.unit;
                let scaled = self.figure.scaled(factor).called(&called);
                Printed { unit, ..scaled }
            }
            None => self.figure,
        };
        let is_used = footer::set(&mut claimed.footer, self.whole, figure);
        claimed.understood.push(Understood {
            at,
            text,
            role: if is_used {
                self.whole.name()
            } else {
                "derived"
            },
        });
    }

    /// What makes the figure absolute, and the result of which it is a part, if the sheet computes in its unit.
    fn of_result(&self, claimed: &Claimed) -> Option<(f64, Printed)> {
        let fraction = match self.figure.unit.as_str() {
            "" => 1.0,
            unit => units::fraction(unit)?,
        };
        let y = claimed.footer.y.as_ref().filter(|y| y.value != 0.0)?;
        let is_ratio = |unit: &str| unit.is_empty() || units::fraction(unit).is_some();
        // What the rows come to is this figure where they are relative themselves.
        let parts = claimed
            .rows
            .iter()
            .filter_map(|row| row.contribution.as_ref().or(row.u.as_ref()));
        let sum = libm::sqrt(parts.map(|part| part.value * part.value).sum());
        let is_sum = (sum - self.figure.value).abs() <= 0.05 * self.figure.value;
        let is_relative = units::fraction(&claimed.unit).is_some() || is_ratio(&y.unit) || is_sum;
        (!is_relative).then(|| (fraction * y.value.abs(), y.clone()))
    }
}

/// U and u_c in the unit in which the sheet computes, where one is relative and the other is not: U in µV below rows in ppm is
/// a part of the result, else of the one amount that the title names, or the lines do.
pub(super) fn settle_by_amount(claimed: &mut Claimed) {
    let named = |text: &str| words::figures_with_units(text).collect::<Vec<_>>();
    let result = claimed.footer.y.iter().cloned().collect();
    let amounts = [result, named(&claimed.title), named(&claimed.words)];
    let unit = claimed.unit.clone();
    let of_the_one = |own: &Printed, amounts: &Vec<Printed>| {
        let others = amounts.iter().filter(|amount| amount.value != own.value);
        let mut all = others.filter_map(|amount| in_unit(own, amount, &unit));
        let first = all.next()?;
        all.all(|other| other.value == first.value).then_some(first)
    };
    for slot in [&mut claimed.footer.u_c, &mut claimed.footer.expanded] {
        let own = slot.as_ref();
        let settled =
            own.and_then(|own| amounts.iter().find_map(|amounts| of_the_one(own, amounts)));
        *slot = settled.or(slot.take());
    }
}

/// An absolute figure as the part that it is of an amount, or a relative one as what it is of the amount.
fn in_unit(own: &Printed, amount: &Printed, unit: &str) -> Option<Printed> {
    let whole = Some(amount.value.abs()).filter(|whole| *whole != 0.0)?;
    let is_bare = own.unit.is_empty() || amount.unit.is_empty();
    let (factor, sign) = match (units::fraction(&own.unit), units::fraction(unit)) {
        (None, Some(of_rows)) => {
            let factor = units::factor(&own.unit, &amount.unit).filter(|_| !is_bare)?;
            (factor / (of_rows * whole), '/')
        }
        (Some(fraction), None) => {
            let factor = units::factor(&amount.unit, unit).filter(|_| !is_bare)?;
            (fraction * whole * factor, '·')
        }
        _ => return None,
    };
    let called = format!("{}{sign}{}", own.with_unit(), amount.with_unit());
    let unit = unit.to_string();
    let scaled = own.clone().scaled(factor).called(&called);
    Some(Printed { unit, ..scaled })
}
