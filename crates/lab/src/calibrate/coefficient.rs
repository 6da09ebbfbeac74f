//! A coefficient with its uncertainty.

use crate::experiment::Words;
use gumption_core::quantity::Unit;

/// A coefficient.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficient {
    /// As the equations call it.
    pub name: String,
    /// What it is.
    pub description: Option<Words>,
    /// Its unit.
    pub unit: Unit,
    /// Estimate; for a plan, the value that was assumed.
    pub value: f64,
    /// Standard uncertainty.
    pub u: f64,
    /// Effective degrees of freedom (GUM G.4.1).
    pub dof: f64,
    /// Coverage factor.
    pub k: f64,
    /// The probability that a coefficient that is zero comes out as far from it (two-sided t test).
    pub p_value: f64,
}

impl Coefficient {
    /// Whether it differs from zero beyond chance; `None` where no test says so.
    pub fn is_significant(&self) -> Option<bool> {
        /// Usual level of a test.
        const RARE: f64 = 0.05;
        (!self.p_value.is_nan()).then_some(self.p_value < RARE)
    }
}
