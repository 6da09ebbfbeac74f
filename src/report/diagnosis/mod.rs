//! A diagnosis for the terminal, as Markdown, and for machines.

mod compose;
mod json;
mod plots;
mod words;

use crate::diagnose::Diagnosis;
use crate::diagnose::case::Case;

use super::language::Language;
use super::text::{Page, draw};

pub use json::{FORMAT, json};
pub use plots::plots;

/// The report for a terminal.
pub fn text(case: &Case, diagnosis: &Diagnosis, language: Language, page: Page) -> String {
    draw(&compose::blocks(case, diagnosis, language), page)
}

/// The report as Markdown.
pub fn markdown(case: &Case, diagnosis: &Diagnosis, language: Language) -> String {
    super::markdown::draw(&compose::blocks(case, diagnosis, language))
}

pub use words::failure;
