//! Verdicts: conformity with a tolerance, decision threshold and detection limit.

use crate::{Report, decisions};
use gumption_format::machine::record;
use gumption_format::machine::{Number, numbers};
use gumption_gum::budget::{Conformity, Detection, Interval};
use gumption_gum::propagate::{ConformityResult, DetectionResult};

record! {
    /// A conformity assessment (JCGM 106).
    ConformityJson<'a> {
        /// Its name; its figures begin with it.
        name: &'a str,
        /// Measurand.
        measurand: &'a str,
        /// Tolerance limits, lower and upper; infinite where there is none.
        tolerance: Vec<Number>,
        /// Acceptance limits; null where no value is accepted.
        acceptance: Option<Vec<Number>>,
        /// Values outside of these limits are rejected.
        rejection: Vec<Number>,
        /// Decision: conforming, not_conforming, undecided, withheld (first order is doubtful and Monte Carlo was not run); null in planning.
        verdict: Option<&'static str>,
        /// Conformance probability, with the knowledge of the process where there is some.
        conformance_probability: Option<Number>,
        /// Its complement.
        nonconformance_probability: Option<Number>,
        /// Conformance probability from the GUM result alone.
        from_measurement: Option<Number>,
        /// Conformance probability as the fraction of the Monte Carlo trials.
        from_trials: Option<Number>,
        /// Measurement capability index C_m.
        capability: Option<Number>,
        /// Test uncertainty ratio.
        test_uncertainty_ratio: Option<Number>,
        /// Risks over all items of the process.
        global: Option<GlobalJson>,
    }

    /// Risks over all items of a process.
    GlobalJson {
        /// Probability that an item conforms.
        in_tolerance: Number,
        /// Probability that an item is accepted.
        accepted: Number,
        /// Global consumer's risk.
        consumer: Number,
        /// Global producer's risk.
        producer: Number,
        /// Probability that an accepted item does not conform; null where none is accepted.
        false_acceptance: Option<Number>,
        /// Probability that a rejected item conforms; null where none is rejected.
        false_rejection: Option<Number>,
    }

    /// Characteristic limits (ISO 11929).
    DetectionJson<'a> {
        /// Measurand.
        measurand: &'a str,
        /// Probability of recognising an effect that is not there.
        alpha: Number,
        /// Probability of missing an effect at the detection limit.
        beta: Number,
        /// Decision threshold.
        decision_threshold: Option<Number>,
        /// Detection limit; null where there is none.
        detection_limit: Option<Number>,
        /// Decision threshold, Monte Carlo.
        monte_carlo_decision_threshold: Option<Number>,
        /// Detection limit, Monte Carlo.
        monte_carlo_detection_limit: Option<Number>,
        /// Whether the effect is recognised.
        recognised: Option<bool>,
        /// Whether the detection limit is at most the guideline value.
        suitable: Option<bool>,
        /// Best estimate of the non-negative measurand.
        best_estimate: Number,
        /// Its standard uncertainty.
        best_standard_uncertainty: Number,
        /// Limits of the symmetric coverage interval.
        symmetric_interval: Vec<Number>,
        /// Limits of the shortest coverage interval.
        shortest_interval: Vec<Number>,
        /// Coverage probability of both.
        coverage_probability: Number,
    }
}

pub(super) fn conformity<'a>(report: &Report<'a>) -> Vec<ConformityJson<'a>> {
    let ends = |interval: Interval| numbers(&[interval.lower, interval.upper]);
    let pairs = report.budget.conformity.iter();
    let pairs = pairs.zip(&report.evaluation.conformity);
    let one = |(stated, found): (&'a Conformity, &ConformityResult)| ConformityJson {
        name: &stated.name,
        measurand: report.measurand(stated.measurand).0,
        tolerance: ends(stated.tolerance),
        acceptance: found.acceptance.map(ends),
        rejection: ends(found.rejection),
        verdict: found.verdict.map(decisions::verdict_code),
        conformance_probability: found.conformance.and_then(|c| c.probability).map(Number),
        nonconformance_probability: found.conformance.and_then(|c| c.complement).map(Number),
        from_measurement: found.conformance.map(|c| Number(c.from_measurement)),
        from_trials: found.conformance.and_then(|c| c.from_trials).map(Number),
        capability: found.capability.map(Number),
        test_uncertainty_ratio: found.test_uncertainty_ratio.map(Number),
        global: found.global.map(|risk| GlobalJson {
            in_tolerance: Number(risk.in_tolerance),
            accepted: Number(risk.accepted),
            consumer: Number(risk.consumer),
            producer: Number(risk.producer),
            false_acceptance: risk.false_acceptance.map(Number),
            false_rejection: risk.false_rejection.map(Number),
        }),
    };
    pairs.map(one).collect()
}

pub(super) fn detection<'a>(report: &Report<'a>) -> Vec<DetectionJson<'a>> {
    let pairs = report.budget.detection.iter();
    let pairs = pairs.zip(&report.evaluation.detection);
    let one = |(stated, found): (&Detection, &DetectionResult)| DetectionJson {
        measurand: report.measurand(stated.measurand).0,
        alpha: Number(stated.alpha),
        beta: Number(stated.beta),
        decision_threshold: found.limits.map(|l| Number(l.decision_threshold)),
        detection_limit: found
            .limits
            .and_then(|l| l.detection_limit.value())
            .map(Number),
        monte_carlo_decision_threshold: found.from_trials.map(|l| Number(l.decision_threshold)),
        monte_carlo_detection_limit: found
            .from_trials
            .and_then(|l| l.detection_limit.value())
            .map(Number),
        recognised: found.recognised(),
        suitable: found.suitable(stated),
        best_estimate: Number(found.best.value),
        best_standard_uncertainty: Number(found.best.u),
        symmetric_interval: numbers(&found.best.symmetric),
        shortest_interval: numbers(&found.best.shortest),
        coverage_probability: Number(found.best.coverage_probability),
    };
    pairs.map(one).collect()
}
