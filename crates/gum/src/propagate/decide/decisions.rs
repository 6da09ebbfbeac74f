//! All decisions, also as figures with names, for claims and machines ([`Conformity::FIGURES`], [`Detection::FIGURES`]).

use crate::budget::{Budget, Conformity, Detection, NamedFigure};
use crate::propagate::result::{ConformityResult, DetectionResult};
use gumption_core::quantity::Unit;

/// What was decided.
pub(in crate::propagate) struct Decisions {
    pub conformity: Vec<ConformityResult>,
    pub detection: Vec<DetectionResult>,
}

impl Decisions {
    /// The figures that were found.
    pub(in crate::propagate) fn figures(&self, budget: &Budget) -> Vec<NamedFigure> {
        let outputs = budget.model.outputs();
        let conformity = budget.conformity.iter().zip(&self.conformity);
        let conformity = conformity.flat_map(|(stated, found)| {
            let unit = &outputs[stated.measurand].unit;
            let values = of_conformity(found, unit);
            named(&stated.name, Conformity::FIGURES, values)
        });
        let detection = budget.detection.iter().zip(&self.detection);
        let detection = detection.flat_map(|(stated, found)| {
            let output = &outputs[stated.measurand];
            let values = of_detection(stated, found, &output.unit);
            named(&output.name, Detection::FIGURES, values)
        });
        conformity.chain(detection).collect()
    }
}

type Value = (Option<f64>, Unit);

fn named<const N: usize>(owner: &str, names: [&str; N], values: [Value; N]) -> Vec<NamedFigure> {
    let figures = names.into_iter().zip(values);
    figures
        .filter_map(|(name, (value, unit))| {
            Some(NamedFigure {
                name: format!("{owner}.{name}"),
                value: value?,
                unit,
            })
        })
        .collect()
}

fn of_conformity(found: &ConformityResult, unit: &Unit) -> [Value; Conformity::FIGURES.len()] {
    let pure = |value: Option<f64>| (value, Unit::one());
    let limit = |value: Option<f64>| (value.filter(|v| v.is_finite()), unit.clone());
    let conformance = found.conformance;
    let global = found.global;
    [
        pure(conformance.and_then(|c| c.probability)),
        pure(conformance.map(|c| c.from_measurement)),
        pure(conformance.and_then(|c| c.from_trials)),
        limit(found.acceptance.map(|a| a.lower)),
        limit(found.acceptance.map(|a| a.upper)),
        pure(found.capability),
        pure(found.test_uncertainty_ratio),
        pure(global.map(|g| g.in_tolerance)),
        pure(global.map(|g| g.accepted)),
        pure(global.map(|g| g.consumer)),
        pure(global.map(|g| g.producer)),
        pure(global.and_then(|g| g.false_acceptance)),
        pure(global.and_then(|g| g.false_rejection)),
    ]
}

fn of_detection(
    stated: &Detection,
    found: &DetectionResult,
    unit: &Unit,
) -> [Value; Detection::FIGURES.len()] {
    let value = |value: Option<f64>| (value, unit.clone());
    let deviation = |value: Option<f64>| (value, unit.difference());
    let truth = |truth: Option<bool>| (truth.map(|t| f64::from(u8::from(t))), Unit::one());
    let (limits, trials, best) = (found.limits, found.from_trials, found.best);
    [
        deviation(limits.map(|l| l.u_of_zero)),
        value(limits.map(|l| l.decision_threshold)),
        value(limits.and_then(|l| l.detection_limit.value())),
        value(trials.map(|l| l.decision_threshold)),
        value(trials.and_then(|l| l.detection_limit.value())),
        value(Some(best.value)),
        deviation(Some(best.u)),
        value(Some(best.symmetric[0])),
        value(Some(best.symmetric[1])),
        value(Some(best.shortest[0])),
        value(Some(best.shortest[1])),
        truth(found.recognised()),
        truth(found.suitable(stated)),
    ]
}
