//! Figures of the whole that are relative to the result: `u(c)/c`, `combined relative standard uncertainty`.

use crate::claim::{Claimed, Understood};
use crate::printed::Printed;
use crate::read::footer::{self, Whole};
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
