//! Recordings with something left out of their model: what a diagnosis finds, names, and refuses.

#![allow(
    clippy::disallowed_methods,
    reason = "held against the platform's own functions"
)]

#[path = "../common/mod.rs"]
mod common;

mod accounts;
mod allan;
mod bench;
mod catalogue;
mod concealed;
mod design;
mod deviations;
mod evidence;
mod examples;
mod forms;
mod instruments;
mod labels;
mod laws;
mod limits;
mod memory;
mod noise;
mod norms;
mod outputs;
mod published;
mod reading;
mod recordings;
mod refusals;
mod rounding;
mod shapes;
mod sizes;
mod tables;
mod warmth;
