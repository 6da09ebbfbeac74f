//! Documents of calibrations and of their plans, and why there is no result.

mod causes;
mod form;
mod hidden;
mod misfit;
mod plots;
mod recordings;
mod sections;
mod trouble;

use crate::language::Language;
use gumption_format::document::{Block, Document};
use gumption_lab::calibrate::{Calibration, Campaign, Plan, Trouble};

pub use form::{calibration_schema, plan_schema};
pub use recordings::{RecordingColumns, recording};

/// The document of a calibration.
pub fn calibration(campaign: &Campaign, found: &Calibration, language: Language) -> Document {
    let l = language;
    let blocks: Vec<Block> = [
        sections::heading(campaign, l),
        sections::equations(campaign, l),
        sections::coefficients(campaign, &found.figures, l),
        sections::parts(found, l),
        sections::correlations(&found.figures, l),
        causes::budgets(campaign, &found.figures, l),
        misfit::residuals(campaign, found, l),
        hidden::identifiability(&found.identifiability, l),
        hidden::aliases(campaign, &found.aliases, Some(&found.figures), l),
        misfit::remarks(campaign, Some(found), &[], l),
    ]
    .concat();
    Document::new(&form::CalibrationForm::of(campaign, found, l), l, blocks)
        .with_plots(plots::residuals(campaign, found, l))
        .with_plots(plots::contributions(&found.figures, l))
}

/// The document of a plan.
pub fn plan(campaign: &Campaign, plan: &Plan, language: Language) -> Document {
    let l = language;
    let figures = plan.figures.as_ref();
    let expected = figures.map(|figures| {
        [
            sections::predictions(figures, l),
            sections::correlations(figures, l),
            causes::budgets(campaign, figures, l),
        ]
        .concat()
    });
    let blocks: Vec<Block> = [
        sections::heading(campaign, l),
        sections::equations(campaign, l),
        hidden::schedule(plan, l),
        hidden::identifiability(&plan.identifiability, l),
        expected.unwrap_or_default(),
        hidden::aliases(campaign, &plan.aliases, figures, l),
        misfit::remarks(campaign, None, &plan.assumed, l),
    ]
    .concat();
    let document = Document::new(&form::PlanForm::of(campaign, plan, l), l, blocks);
    match figures {
        Some(figures) => document.with_plots(plots::contributions(figures, l)),
        None => document,
    }
}

/// Why there are no coefficients, in sentences.
pub fn calibration_trouble(trouble: &Trouble, language: Language) -> String {
    trouble::sentences(trouble, language)
}
