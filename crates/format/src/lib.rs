//! Files that people write, and documents that they read.
//!
//! | module | holds |
//! |---|---|
//! | [`csv`] | the one reader of tables |
//! | [`contained`] | libraries that give up by a panic |
//! | [`decimal`] | plain decimal numbers, read into doubles |
//! | [`files`] | where files are read from: a disk, or a library in memory |
//! | [`document`] | what every command composes: blocks for people, a typed form for machines |
//! | [`machine`] | structures of the machine form with their JSON Schema |
//! | [`toml`] | files of keys and values that keep their places, and tables of what a key may be |
//! | [`render`] | the formats in which a document is written |
//! | `spelled` | numbers as they are written elsewhere |

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod contained;
pub mod csv;
pub mod decimal;
pub mod document;
pub mod files;
pub mod machine;
pub mod render;
mod spelled;
pub mod toml;
