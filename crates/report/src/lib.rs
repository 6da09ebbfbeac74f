//! Documents about everything that is computed, and the sentence for the certificate.
//!
//! A [`Report`] joins a budget with its evaluation. Each function composes one [`Document`](gumption_format::document::Document); the formats in
//! which it is written are those of [`gumption_format::render`].

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod allan;
mod analyses;
mod audit;
pub mod batch;
mod budget_table;
mod calibration;
mod certificate;
mod claim;
mod comparison;
mod decisions;
mod diagnosis;
mod evaluation;
mod figures;
mod fits;
mod fleet;
mod how;
mod indices;
mod joint;
mod language;
mod meant;
mod moments;
mod number;
mod phrase;
mod quasi;
mod remarks;
mod requirements;
mod rows;
mod save;
mod statement;
mod verification;
mod versions;
mod worksheet;

#[cfg(test)]
mod fixtures;
#[cfg(test)]
mod laboratory;
#[cfg(test)]
mod tests;

pub use allan::{AllanReport, allan, allan_schema};
pub use audit::{audit, audit_schema};
pub use calibration::{
    RecordingColumns, calibration, calibration_schema, calibration_trouble, plan, plan_schema,
    recording,
};
pub use certificate::{
    administration, certificate_keys, certificate_schema, certificate_template, certified,
    template_names,
};
pub use diagnosis::{
    assumed_noise, diagnosis, diagnosis_schema, failure as diagnosis_failure, outlook,
    outlook_schema,
};
pub use evaluation::{evaluation, evaluation_schema, evaluations};
pub use fleet::{fleet, fleet_schema};
pub use language::Language;
pub use number::{grouped, significant};
pub use requirements::requirements;
pub use rows::rows;
pub use save::{Unsaved, saved};
pub use statement::statement;
pub use verification::{Detail, dossier, verification, verification_schema};
pub use versions::{incomparable, versions};

use gumption_core::quantity::Unit;
use gumption_gum::budget::Budget;
use gumption_gum::propagate::{EvaluatedRow, Evaluation, FindingKind};

/// One evaluated budget, ready to be shown.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// What was evaluated.
    pub budget: &'a Budget,
    /// What was found.
    pub evaluation: &'a Evaluation,
    /// The row of a series; `None` for a budget that stands alone.
    pub label: Option<&'a str>,
    /// Language of the sentences and headings.
    pub language: Language,
}

impl<'a> Report<'a> {
    /// That of a row of a file.
    pub fn of(row: &'a EvaluatedRow, language: Language) -> Report<'a> {
        Report {
            budget: &row.budget,
            evaluation: &row.evaluation,
            label: row.label.as_deref(),
            language,
        }
    }

    /// The title of the budget; where it has none, what is measured.
    fn title(&self) -> String {
        match self.budget.heading.titled(self.language) {
            "" => {
                let outputs = self.budget.model.outputs().iter();
                let names: Vec<&str> = outputs.map(|output| output.name.as_str()).collect();
                names.join(", ")
            }
            title => title.to_string(),
        }
    }

    /// Name and unit of a measurand.
    fn measurand(&self, measurand: usize) -> (&'a str, &'a Unit) {
        let output = &self.budget.model.outputs()[measurand];
        (&output.name, &output.unit)
    }

    /// Whether a finding of this kind concerns the measurand.
    fn finds(&self, measurand: usize, is_it: impl Fn(&FindingKind) -> bool) -> bool {
        let concerned = |m: Option<usize>| m.is_none() || m == Some(measurand);
        self.evaluation
            .findings
            .iter()
            .any(|f| concerned(f.measurand) && is_it(&f.kind))
    }

    /// p of the coverage intervals.
    fn coverage_probability(&self) -> f64 {
        let of_run = self
            .evaluation
            .run
            .as_ref()
            .map(|run| run.coverage_probability);
        of_run.unwrap_or(self.budget.conventions.coverage_probability)
    }
}

/// The unit as printed after a number (`Ω` for `ohm`); nothing for the unit one. Uncertainties and other differences of a
/// Celsius temperature are in °C as well, as certificates have it: the number in kelvin is the same (SI Brochure, 2.3.1).
fn symbol(unit: &Unit) -> String {
    unit.after_number()
}
