//! Documents of diagnoses and of plans of experiments, and why there is none.

mod compose;
mod form;
mod improvement;
mod labels;
mod names;
mod noise;
mod open;
mod outlook;
mod plots;
mod statement;
mod words;

use crate::diagnose::case::Case;
use crate::diagnose::{Diagnosis, Outlook};
use crate::document::Document;
use crate::language::Language;

pub use form::{diagnosis_schema, outlook_schema};
pub use noise::assumed_noise;
pub use words::failure;

/// The document of a diagnosis, with plots of its residuals.
pub fn diagnosis(case: &Case, diagnosis: &Diagnosis, language: Language) -> Document {
    let blocks = compose::blocks(case, diagnosis, language);
    let form = form::diagnosis(case, diagnosis, language);
    Document::new(&form, language, blocks).with_plots(plots::plots(case, diagnosis, language))
}

/// The document of a plan.
pub fn outlook(case: &Case, outlook: &Outlook, language: Language) -> Document {
    let blocks = outlook::blocks(case, outlook, language);
    Document::new(&form::outlook(case, outlook, language), language, blocks)
}
