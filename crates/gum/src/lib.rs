//! Uncertainty budgets: the file, and their evaluation by the GUM and by Monte Carlo.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

use gumption_core::{distribution, least_squares, model, quantity, special, statistics};
use gumption_fault as fault;
use gumption_format::files;

pub mod budget;
pub mod propagate;
