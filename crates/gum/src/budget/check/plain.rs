//! Components that one number states, so that another number there changes nothing but u and the distribution.

use super::draft::{least_dof, t_or_normal};
use super::shapes::{default_shape, stated_shape};
use super::ways::{Way, stated_ways};
use crate::budget::Conventions;
use crate::budget::tables::ComponentTable;
use crate::budget::variants::Amounts;
use gumption_core::distribution::stating::{Bell, Width, Word};
use gumption_core::distribution::{Distribution, Entry, Normal, Uniform};
use gumption_format::toml::Amount;
use gumption_lanes::Block;

/// A component that one number states.
#[derive(Debug, Clone)]
pub(in crate::budget) struct Plain {
    measure: Measure,
    shape: &'static Entry,
    /// Whether the file names the shape.
    named: bool,
    /// The number.
    pub amount: Amount,
}

/// What the number is.
#[derive(Debug, Clone, Copy)]
enum Measure {
    U,
    HalfWidth,
    Step,
    /// U, of which u is this part.
    Expanded {
        k: f64,
    },
}

impl Plain {
    /// A component of the file and the keys below it that lead to its number; `None` where more than that number
    /// decides.
    pub(in crate::budget) fn of(
        table: &ComponentTable,
    ) -> Option<(Plain, &'static [&'static str])> {
        let mut ways = stated_ways(table).map(|(way, ..)| way);
        let (way, None) = (ways.next()?, ways.next()) else {
            return None;
        };
        let more = table.gum_u.is_some() || table.p.is_some() || table.common.is_some();
        let bare = table.certificate.is_none() || way == Way::Certificate;
        if more || !bare || table.refused || table.modifiers().next().is_some() {
            return None;
        }
        let one = |stated: &Amounts| match stated {
            Amounts::One(amount) => Some(amount.clone()),
            Amounts::Each(_) | Amounts::Column(_) => None,
        };
        let (measure, shape, amount, keys): (_, _, _, &[&str]) = match way {
            Way::U => {
                let amount = one(&table.u.as_ref()?.value)?;
                (Measure::U, Entry::of::<Normal>(), amount, &["u"])
            }
            Way::HalfWidth => {
                let amount = one(&table.half_width.as_ref()?.value)?;
                (
                    Measure::HalfWidth,
                    default_shape(table),
                    amount,
                    &["half_width"],
                )
            }
            Way::Step => {
                let amount = table.step.as_ref()?.value.clone();
                (Measure::Step, Entry::of::<Uniform>(), amount, &["step"])
            }
            Way::Certificate => {
                let stated = &table.certificate.as_ref()?.value;
                let more = stated.refused
                    || stated.p.is_some()
                    || stated.dof.is_some()
                    || stated.reading.is_some();
                let k = stated
                    .k
                    .as_ref()
                    .filter(|_| !more && stated.dcc.is_none())?;
                let amount = stated.U.as_ref()?.value.clone();
                let expanded = Measure::Expanded { k: k.value };
                (
                    expanded,
                    Entry::of::<Normal>(),
                    amount,
                    &["certificate", "U"],
                )
            }
            _ => return None,
        };
        let stated = stated_shape(table);
        let plain = Plain {
            measure,
            shape: stated.unwrap_or(shape),
            named: stated.is_some(),
            amount,
        };
        (table.distribution.is_some() == plain.named).then_some((plain, keys))
    }

    /// The numbers of rows become u of what [`Plain::with`] gives; marks those of which it gives nothing.
    pub(in crate::budget) fn of_rows(
        &self,
        count: usize,
        (numbers, dof): (&mut Block, &Block),
        conventions: &Conventions,
        refused: &mut Block,
    ) {
        let rows = numbers.0[..count].iter_mut().zip(&dof.0);
        let rows = rows.zip(&mut refused.0);
        let (bell, k) = match (self.shape.word, self.measure) {
            (Word::Bell(bell), Measure::U) => (bell, 1.0),
            (Word::Bell(bell), Measure::Expanded { k }) => (bell, k),
            _ => {
                for ((number, dof), refused) in rows {
                    match self.with(*number, *dof, conventions) {
                        Some((u, _)) => *number = u,
                        None => *refused = 1.0,
                    }
                }
                return;
            }
        };
        // Without columns for more, u alone is found: the same for all shapes of a bell, where they have one.
        let normal = bell == Bell::Normal;
        let least = match normal && self.named {
            true => 0.0,
            false => least_dof(conventions),
        };
        for ((number, dof), refused) in rows {
            *number /= k;
            let fine = (*dof > least) & (normal | dof.is_finite());
            *refused = if fine { *refused } else { 1.0 };
        }
    }

    fn width(&self, number: f64) -> Width {
        match self.measure {
            Measure::U => Width::U(number),
            Measure::HalfWidth => Width::Half(number),
            Measure::Step => Width::Half(number / 2.0),
            Measure::Expanded { k } => Width::U(number / k),
        }
    }

    /// u and the distribution with another number, greater than zero, in the unit of the component; `None` where the
    /// statement is to be looked at.
    pub(in crate::budget) fn with(
        &self,
        number: f64,
        dof: f64,
        conventions: &Conventions,
    ) -> Option<(f64, Distribution)> {
        match (self.shape.word, self.width(number)) {
            (Word::Bell(Bell::Normal), Width::U(u)) if self.named => {
                Some((u, Distribution::Normal(Normal { mean: 0.0, sd: u })))
            }
            (Word::Bell(bell), Width::U(u)) if bell == Bell::Normal || dof.is_finite() => {
                Some((u, t_or_normal(u, dof, conventions)?))
            }
            (Word::Limits, width) => {
                let spread = self.shape.of_width(width, 0.0, "").ok()?;
                Some((spread.u, spread.distribution))
            }
            _ => None,
        }
    }
}
