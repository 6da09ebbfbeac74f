//! Files that people write, and documents that they read.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod files;
pub mod toml;
