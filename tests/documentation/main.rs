//! The documentation is true, complete and fresh.

#![allow(
    clippy::disallowed_methods,
    reason = "held against the platform's own functions"
)]

#[path = "../common/mod.rs"]
mod common;

mod calibrate;
mod experiment;
mod fleet;
mod pages;
mod schemas;
