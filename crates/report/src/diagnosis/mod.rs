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

use crate::document::Document;
use crate::language::Language;

pub use plots::plots;

/// The document of a diagnosis.
pub fn diagnosis(case: &Case, diagnosis: &Diagnosis, language: Language) -> Document {
    Document {
        kind: "diagnosis",
        version: 1,
        language,
        blocks: compose::blocks(case, diagnosis, language),
        machine: json::json(case, diagnosis, language),
    }
}

/// The document of a plan.
pub fn outlook(case: &Case, outlook: &Outlook, language: Language) -> Document {
    Document {
        kind: "plan",
        version: 1,
        language,
        blocks: outlook::blocks(case, outlook, language),
        machine: outlook::json(case, outlook, language),
    }
}

pub use words::{assumed_noise, failure};
