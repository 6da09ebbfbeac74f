//! A diagnosis for the terminal, as Markdown, and for machines.

mod compose;
mod improvement;
mod json;
mod labels;
mod open;
mod outlook;
mod plots;
mod statement;
mod words;

use crate::diagnose::case::Case;
use crate::diagnose::{Diagnosis, Outlook};

use super::language::Language;
use super::text::{Page, draw};

pub use json::{FORMAT, json};
pub use outlook::{FORMAT as OUTLOOK_FORMAT, json as outlook_json};
pub use plots::plots;

/// The report for a terminal.
pub fn text(case: &Case, diagnosis: &Diagnosis, language: Language, page: Page) -> String {
    draw(&compose::blocks(case, diagnosis, language), page)
}

/// The report as Markdown.
pub fn markdown(case: &Case, diagnosis: &Diagnosis, language: Language) -> String {
    super::markdown::draw(&compose::blocks(case, diagnosis, language))
}

/// A plan for a terminal.
pub fn outlook_text(case: &Case, outlook: &Outlook, language: Language, page: Page) -> String {
    draw(&outlook::blocks(case, outlook, language), page)
}

/// A plan as Markdown.
pub fn outlook_markdown(case: &Case, outlook: &Outlook, language: Language) -> String {
    super::markdown::draw(&outlook::blocks(case, outlook, language))
}

pub use words::{assumed_noise, failure};
