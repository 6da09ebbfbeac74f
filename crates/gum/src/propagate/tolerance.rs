//! Figures of JCGM 101:2008, 7.9, by name: the numerical tolerance of every measurand, and the batches of an
//! adaptive run.

use super::monte_carlo::{batch_size, least_batch};
use super::result::{MeasurandResult, Run};
use super::validation;
use crate::budget::{Budget, NamedFigure};
use gumption_core::quantity::Unit;

/// The figures of a finished evaluation.
pub(super) fn figures(
    budget: &Budget,
    results: &[MeasurandResult],
    run: Option<&Run>,
) -> Vec<NamedFigure> {
    let mut figures = Vec::new();
    for (output, result) in budget.model.outputs().iter().zip(results) {
        for digits in [1, 2] {
            figures.push(NamedFigure {
                name: NamedFigure::tolerance(&output.name, digits),
                value: validation::numerical_tolerance(result.gum.u, digits),
                unit: output.unit.difference(),
            });
        }
    }
    if let Some(run) = run.filter(|run| run.adaptive.is_some()) {
        let p = run.coverage_probability;
        for (name, trials) in [
            (NamedFigure::LEAST_BATCH, least_batch(p)),
            (NamedFigure::BATCH, batch_size(p)),
        ] {
            figures.push(NamedFigure {
                name: name.to_string(),
                value: trials as f64,
                unit: Unit::one(),
            });
        }
    }
    figures
}
