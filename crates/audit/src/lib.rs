//! Claimed budgets: spreadsheets read by meaning, recomputed from the lowest level that they state, and the slips in
//! them named.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod calculate;
pub mod claim;
mod file;
pub mod import;
mod places;
pub mod printed;
pub mod programs;
pub mod read;
pub mod rules;
pub mod search;
pub mod sheet;
pub mod slips;
#[cfg(test)]
mod tests;
mod units;
mod verdict;

pub use file::{budget_files, claims, nothing_understood};
pub use verdict::{Audit, Verdict, audit};
