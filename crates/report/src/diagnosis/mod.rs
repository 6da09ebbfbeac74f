//! Documents of diagnoses and of plans of experiments, and why there is none.

mod accounts;
mod compose;
mod expected;
mod form;
mod improvement;
mod labels;
mod listed;
mod names;
mod noise;
mod open;
mod outlook;
mod parts;
mod plots;
mod statement;
mod words;

use crate::language::Language;
use gumption_format::document::Document;
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{Diagnosis, Outlook};

pub use expected::outlook_schema;
pub use form::diagnosis_schema;
pub use noise::assumed_noise;
pub use words::failure;

/// The document of a diagnosis, with plots of its residuals.
pub fn diagnosis(case: &Case, diagnosis: &Diagnosis, language: Language) -> Document {
    let names = names::Names::of_diagnosis(diagnosis, language);
    let form = form::DiagnosisForm::of(case, diagnosis, names);
    Document::new(&form, language, compose::blocks(case, diagnosis, language))
        .with_plots(plots::plots(case, diagnosis, language))
}

/// The document of a plan.
pub fn outlook(case: &Case, outlook: &Outlook, language: Language) -> Document {
    let names = names::Names::of_outlook(outlook, language);
    let form = expected::OutlookForm::of(case, outlook, names);
    Document::new(&form, language, outlook::blocks(case, outlook, language))
}
