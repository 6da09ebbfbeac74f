//! A calibration, and the plan of one, for the terminal, as Markdown and for machines.

mod causes;
mod hidden;
mod json;
mod misfit;
mod sections;
mod trouble;

use crate::calibrate::{Calibration, Experiment, Plan, Trouble};

use super::document::Block;
use super::language::Language;
use super::text::{Page, draw};

pub use json::{calibration_json, plan_json};

/// A calibration as lines for a terminal.
pub fn calibration_text(
    experiment: &Experiment,
    found: &Calibration,
    language: Language,
    page: Page,
) -> String {
    draw(&calibration(experiment, found, language), page)
}

/// A calibration as Markdown.
pub fn calibration_markdown(
    experiment: &Experiment,
    found: &Calibration,
    language: Language,
) -> String {
    super::markdown::draw(&calibration(experiment, found, language))
}

/// A plan as lines for a terminal.
pub fn plan_text(experiment: &Experiment, plan: &Plan, language: Language, page: Page) -> String {
    draw(&planned(experiment, plan, language), page)
}

/// A plan as Markdown.
pub fn plan_markdown(experiment: &Experiment, plan: &Plan, language: Language) -> String {
    super::markdown::draw(&planned(experiment, plan, language))
}

/// Why there are no coefficients, in sentences.
pub fn calibration_trouble(trouble: &Trouble, language: Language) -> String {
    trouble::sentences(trouble, language)
}

fn calibration(experiment: &Experiment, found: &Calibration, l: Language) -> Vec<Block> {
    let mut blocks = sections::heading(experiment, l);
    blocks.extend(sections::equations(experiment, l));
    blocks.extend(sections::coefficients(experiment, &found.figures, l));
    blocks.extend(sections::parts(found, l));
    blocks.extend(sections::correlations(&found.figures, l));
    blocks.extend(causes::budgets(&found.figures, l));
    blocks.extend(misfit::residuals(experiment, found, l));
    blocks.extend(hidden::identifiability(&found.identifiability, l));
    blocks.extend(hidden::aliases(
        experiment,
        &found.aliases,
        Some(&found.figures),
        l,
    ));
    blocks.extend(misfit::remarks(experiment, Some(found), &[], l));
    blocks
}

fn planned(experiment: &Experiment, plan: &Plan, l: Language) -> Vec<Block> {
    let mut blocks = sections::heading(experiment, l);
    blocks.extend(sections::equations(experiment, l));
    blocks.extend(hidden::schedule(plan, l));
    blocks.extend(hidden::identifiability(&plan.identifiability, l));
    if let Some(figures) = &plan.figures {
        blocks.extend(sections::predictions(figures, l));
        blocks.extend(sections::correlations(figures, l));
        blocks.extend(causes::budgets(figures, l));
    }
    blocks.extend(hidden::aliases(
        experiment,
        &plan.aliases,
        plan.figures.as_ref(),
        l,
    ));
    blocks.extend(misfit::remarks(experiment, None, &plan.assumed, l));
    blocks
}
