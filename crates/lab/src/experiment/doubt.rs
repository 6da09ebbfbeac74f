//! What is known of quantities, and why it is doubted.

use gumption_core::distribution::Distribution;
use gumption_core::quantity::Unit;
use gumption_gum::budget::{Certificate, Evaluation, Follows};

use super::words::Words;

/// What is known of a parameter before the calibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Its value.
    pub value: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// Degrees of freedom of `u`.
    pub dof: f64,
}

/// An error of a reference, or a quantity of the set-up.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// As the equations call it.
    pub name: String,
    /// What it is.
    pub description: Option<Words>,
    /// Its unit.
    pub unit: Unit,
    /// Its value.
    pub value: f64,
}

/// On which points one error acts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Scope {
    /// One error acts on all.
    Common,
    /// Each point has its own.
    Each,
    /// Points with the same label in this column share one.
    By(String),
}

/// A reason for doubt: an error of expectation zero.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Doubt {
    /// As the file calls it: `e_rate`, `R.calibration`.
    pub name: String,
    /// What it acts on.
    pub acts: Vec<Act>,
    /// On which points one error acts.
    pub scope: Scope,
    /// Its standard uncertainty.
    pub u: f64,
    /// The column whose number at each point multiplies the error there.
    pub by: Option<String>,
    /// Degrees of freedom of `u`.
    pub dof: f64,
    /// Unit of the error.
    pub unit: Unit,
    /// Its distribution.
    pub distribution: Distribution,
    /// Type A or B.
    pub evaluation: Evaluation,
    /// How `u` follows from what the file states.
    pub how: String,
    /// The certificate behind it.
    pub certificate: Option<Box<Certificate>>,
}

/// What an error acts on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Act {
    /// The quantity.
    pub on: Target,
    /// Change of the quantity per unit of the error.
    pub coefficient: f64,
    /// How that grows with what is read, where the error is a part of it.
    pub growth: Option<Growth>,
}

impl Act {
    /// The root mean square of what multiplies it over readings: 1 unless it is a part of them.
    pub fn typical_growth(&self, readings: &[f64]) -> f64 {
        let Some(growth) = self.growth else {
            return 1.0;
        };
        let present = readings.iter().filter(|reading| reading.is_finite());
        let factors: Vec<f64> = present.map(|reading| growth.factor(*reading)).collect();
        let squares: f64 = factors.iter().map(|factor| factor * factor).sum();
        (squares / factors.len().max(1) as f64).sqrt()
    }

    /// The part that is in proportion to the readings.
    pub(super) fn of_gain(self) -> Act {
        let share = self.in_proportion();
        let growth = self.growth.map(|growth| Growth {
            rule: Follows::Proportion { share: 1.0 },
            ..growth
        });
        Act {
            coefficient: share * self.coefficient,
            growth,
            ..self
        }
    }

    /// The rest.
    pub(super) fn of_zero(self) -> Act {
        Act {
            coefficient: (1.0 - self.in_proportion()) * self.coefficient,
            growth: self.growth.filter(|growth| growth.rule == Follows::Root),
            ..self
        }
    }

    /// How much of it is in proportion to the readings.
    fn in_proportion(&self) -> f64 {
        match self.growth.map(|growth| growth.rule) {
            Some(Follows::Proportion { share }) => share,
            Some(Follows::Root) | None => 0.0,
        }
    }
}

/// An error that is a part of what is read, as of an accuracy specification.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Growth {
    /// The reading, in the unit of its column, for which the error is stated.
    pub at: f64,
    /// How it follows the reading.
    pub rule: Follows,
}

impl Growth {
    /// The factor of the error at a reading; none acts on one that is missing. A gain that is wrong for all readings is wrong with
    /// the sign of each; limits of one reading that have a constant part as well have none.
    pub fn factor(self, reading: f64) -> f64 {
        match self.rule {
            _ if !reading.is_finite() => 0.0,
            Follows::Proportion { share: 1.0 } => reading / self.at,
            rule => rule.factor(self.at, reading),
        }
    }
}

/// A quantity that errors act on.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// An input, by its place among the inputs.
    Input(usize),
    /// The readings of a column, by its name.
    Reading(String),
}
