//! Uncertainty budgets: the file, and their evaluation by the GUM and by Monte Carlo.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod batch;
pub mod budget;
mod elimination;
pub mod propagate;
pub mod versions;
