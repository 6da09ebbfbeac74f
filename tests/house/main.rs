//! The house keeps its shape: what may use what, which packages a library may ask for, and how many places an
//! addition touches. Everything is read from the sources.

mod chapters;
mod dependencies;
mod lexer;
mod matrix;
mod modules;
mod rings;
mod sources;
mod texts;
mod walks;

#[path = "../common/files.rs"]
mod common;
