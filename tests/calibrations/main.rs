//! Calibrations: the files of `experiments/`, studies against other algorithms, and reports of published ones.

#![allow(
    clippy::disallowed_methods,
    reason = "held against the platform's own functions"
)]

#[path = "../common/mod.rs"]
mod common;

mod gyros;
mod library;
mod positions;
mod proposals;
mod recordings;
mod refusals;
mod reports;
mod rest;
mod studies;
