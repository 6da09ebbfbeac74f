//! What a user reads who has made a mistake: in a file, and on the command line.

#![allow(
    clippy::disallowed_methods,
    reason = "held against the platform's own functions"
)]

#[path = "../common/mod.rs"]
mod common;

mod arguments;
mod budgets;
mod files;
mod writers;
