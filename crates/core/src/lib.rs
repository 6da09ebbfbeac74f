//! Quantities, special functions, statistics, distributions, least squares, the model language and measurement equations.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

use gumption_fault as fault;

pub mod dd;
pub mod distribution;
pub mod equations;
pub mod least_squares;
pub mod model;
pub mod quantity;
pub mod special;
pub mod statistics;
