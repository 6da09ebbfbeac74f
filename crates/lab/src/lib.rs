//! Recordings of instruments: calibrations and diagnoses.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

use gumption_core::{distribution, equations, least_squares, model, quantity, special, statistics};
use gumption_fault::{self as fault, language};
use gumption_format::files;
use gumption_gum::{budget, propagate};

pub mod calibrate;
pub mod diagnose;
pub mod experiment;
pub mod recording;
