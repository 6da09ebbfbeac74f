//! A calibration, and the plan of one, for the terminal, as Markdown and for machines.

mod causes;
mod hidden;
mod json;
mod misfit;
mod sections;
mod trouble;

use serde_json::Value;

use crate::calibrate::{Calibration, Experiment, Plan, Trouble};

use crate::document::{Block, Document};
use crate::language::Language;

/// The document of a calibration.
pub fn calibration(experiment: &Experiment, found: &Calibration, language: Language) -> Document {
    document(
        language,
        found_blocks(experiment, found, language),
        json::calibration_json(experiment, found, language),
    )
}

/// The document of a plan.
pub fn plan(experiment: &Experiment, plan: &Plan, language: Language) -> Document {
    document(
        language,
        planned(experiment, plan, language),
        json::plan_json(experiment, plan, language),
    )
}

fn document(language: Language, blocks: Vec<Block>, machine: Value) -> Document {
    Document {
        kind: "calibration",
        version: 1,
        language,
        blocks,
        machine,
    }
}

/// Why there are no coefficients, in sentences.
pub fn calibration_trouble(trouble: &Trouble, language: Language) -> String {
    trouble::sentences(trouble, language)
}

fn found_blocks(experiment: &Experiment, found: &Calibration, l: Language) -> Vec<Block> {
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
