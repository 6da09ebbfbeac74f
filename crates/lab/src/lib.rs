//! Recordings of instruments: calibrations and diagnoses.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod calibrate;
pub mod diagnose;
pub mod experiment;
pub mod recording;
