//! Claims: what somebody's certificate says.

use super::{Checker, entries};
use crate::budget::Claim;
use crate::budget::faults::{CLAIM, LIMITS, UNKNOWN_NAME};
use crate::budget::table::Stated;
use crate::budget::tables::{ClaimTable, FileTable};
use crate::budget::values::Amount;
use crate::fault::{Fault, nearest};
use crate::quantity::Unit;

/// The keys of a claim that state a number.
const NUMBERS: [&str; 7] = ["value", "u", "U", "k", "dof", "p", "interval"];

impl Checker<'_> {
    /// Reads `[claim]`.
    pub(super) fn claims(&mut self, file: &FileTable) -> Vec<Claim> {
        let stated = file
            .claim
            .as_ref()
            .map_or(&[][..], |claims| &claims.value.0);
        stated
            .iter()
            .filter_map(|claim| self.claim(claim, file))
            .collect()
    }

    fn claim(&mut self, stated: &Stated<ClaimTable>, file: &FileTable) -> Option<Claim> {
        let table = &stated.value;
        if !table.present.iter().any(|(key, _)| NUMBERS.contains(key)) {
            return self.refuse(
                Fault::new(CLAIM, stated.span.clone(), "the claim states no number")
                    .label("nothing to compare")
                    .help(format!("add at least one of {}", NUMBERS.join(", "))),
            );
        }
        let measurand = self.claimed(stated, file)?;
        let (name, entry) = entries(&file.measurand).get(measurand)?;
        let unit = self.unit(&entry.value.unit)?;
        let interval = match &table.interval {
            Some(interval) => Some(self.claimed_interval(interval, &unit, name)?),
            None => None,
        };
        let deviation = |checker: &mut Self, stated: &Option<Stated<Amount>>| -> Option<f64> {
            let stated = stated.as_ref()?;
            checker.claimed_deviation(stated, &unit, name, table)
        };
        Some(Claim {
            measurand,
            value: table
                .value
                .as_ref()
                .and_then(|value| self.quantity(value, &unit, name)),
            u: deviation(self, &table.u),
            expanded: deviation(self, &table.U),
            k: table.k.as_ref().and_then(|k| self.positive(k, "k")),
            dof: table
                .dof
                .as_ref()
                .and_then(|dof| self.positive_dof(&dof.map(|dof| dof.0))),
            coverage_probability: table.p.as_ref().and_then(|p| self.probability(p)),
            interval,
            source: table.source.as_ref().map(|text| text.value.clone()),
            note: table.note.as_ref().map(|text| text.value.clone()),
        })
    }

    /// Which measurand a claim is about.
    fn claimed(&mut self, stated: &Stated<ClaimTable>, file: &FileTable) -> Option<usize> {
        let names: Vec<&str> = entries(&file.measurand)
            .iter()
            .map(|(name, _)| name.as_str())
            .collect();
        match &stated.value.measurand {
            None if names.len() == 1 => Some(0),
            // Without measurands there is a fault about that already.
            None if names.is_empty() => None,
            None => self.refuse(
                Fault::new(
                    CLAIM,
                    stated.span.clone(),
                    "the claim does not say which measurand it is about",
                )
                .label("`measurand` is missing")
                .help(format!(
                    "add measurand = \"{}\" (or another of {})",
                    names[0],
                    names.join(", ")
                )),
            ),
            Some(wanted) => match names.iter().position(|name| *name == wanted.value) {
                Some(index) => Some(index),
                None => {
                    let help = match nearest(&wanted.value, names.iter().copied()) {
                        Some(near) => format!("did you mean \"{near}\"?"),
                        None => format!("measurands: {}", names.join(", ")),
                    };
                    self.refuse(
                        Fault::new(
                            UNKNOWN_NAME,
                            wanted.span.clone(),
                            format!("there is no measurand \"{}\"", wanted.value),
                        )
                        .label("not declared")
                        .help(help),
                    )
                }
            },
        }
    }

    /// u or U of a claim; a claimed value makes `"0.1 %"` meaningful.
    fn claimed_deviation(
        &mut self,
        stated: &Stated<Amount>,
        unit: &Unit,
        name: &str,
        table: &ClaimTable,
    ) -> Option<f64> {
        let value = match &table.value {
            Some(value) => self.quantity(value, unit, name),
            None => None,
        };
        let context = super::draft::Context {
            owner: name,
            value,
            unit,
            place: stated.span.clone(),
        };
        self.positive_deviation(stated, "the claimed uncertainty", &context, false)
    }

    fn claimed_interval(
        &mut self,
        stated: &Stated<Vec<Stated<Amount>>>,
        unit: &Unit,
        name: &str,
    ) -> Option<[f64; 2]> {
        let limits: Vec<Option<f64>> = stated
            .value
            .iter()
            .map(|limit| self.quantity(limit, unit, name))
            .collect();
        match limits.as_slice() {
            [Some(lower), Some(upper)] if lower < upper => Some([*lower, *upper]),
            _ => self.refuse(
                Fault::new(
                    LIMITS,
                    stated.span.clone(),
                    "the claimed interval is not a lower and an upper limit",
                )
                .label("expected [lower, upper]"),
            ),
        }
    }
}
