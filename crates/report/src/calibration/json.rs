//! A calibration for machines: exact numbers, stable names.

use nalgebra::DMatrix;
use serde_json::{Value, json};

use super::super::language::Language;
use super::causes::cause_words;
use super::sections::{correlation, said};
use super::trouble::in_words;
use crate::calibrate::{
    Alias, Calibration, Cause, Experiment, Figures, Identifiability, Origin, Plan, Scatter, Scope,
    Words,
};

/// Name of the form of [`calibration_json`] and [`plan_json`].
const FORMAT: &str = "gumption-calibration/1";

/// A calibration as JSON.
pub fn calibration_json(experiment: &Experiment, found: &Calibration, l: Language) -> Value {
    let mut value = common(
        experiment,
        &found.figures,
        &found.identifiability,
        &found.aliases,
        l,
    );
    value["kind"] = json!("calibration");
    value["readings"] = json!(found.readings);
    value["left_out"] = json!(found.left_out);
    let pair = |pair: &[Words; 2]| pair.each_ref().map(|point| said(point, l));
    value["swapped"] = json!(found.swapped.iter().map(pair).collect::<Vec<_>>());
    value["reversed"] = json!(found.reversed);
    value["apart"] = found
        .apart
        .iter()
        .map(|one| json!({ "response": one.response, "point": said(&one.point, l), "t": number(one.t), "p_value": one.p_value }))
        .collect();
    value["limits"] = found
        .limits
        .iter()
        .map(|limit| json!({ "response": limit.response, "value": limit.value, "points": limit.points.iter().map(|point| said(point, l)).collect::<Vec<_>>() }))
        .collect();
    value["linear"] = json!(found.linear);
    value["iterations"] = json!(found.iterations);
    value["scatter"] = json!(match found.scatter {
        Scatter::Residuals => "residuals",
        Scatter::Dwells => "dwells",
        Scatter::Stated => "stated",
    });
    let responses = found.responses.iter().zip(experiment.equations.responses());
    value["responses"] = responses
        .map(|(one, quantity)| {
            json!({
                "name": one.response,
                "unit": quantity.unit.symbol,
                "readings": one.readings,
                "rms": number(one.rms),
                "s": number(one.s),
                "dof": number(one.dof),
                "test": one.test.map(|test| json!({
                    "expected": test.expected,
                    "chi_squared": test.chi_squared,
                    "dof": test.dof,
                    "p_value": test.p_value,
                })),
            })
        })
        .collect();
    value["residuals"] = found
        .residuals
        .iter()
        .map(|one| {
            json!({
                "point": said(&one.point, l),
                "response": one.response,
                "observed": one.observed,
                "fitted": one.fitted,
                "residual": one.observed - one.fitted,
                "standardised": number(one.standardised),
            })
        })
        .collect();
    value["parts"] = found
        .parts
        .iter()
        .map(|(label, part)| json!({ "label": label, "coefficients": coefficients(&part.figures, l) }))
        .collect();
    value["findings"] = experiment
        .points
        .findings
        .iter()
        .map(|finding| json!({ "message": l.pick(finding.message(), finding.message_zh()), "advice": l.pick(finding.advice(), finding.advice_zh()), "line": finding.line, "count": finding.count }))
        .collect();
    value
}

/// A plan as JSON.
pub fn plan_json(experiment: &Experiment, plan: &Plan, l: Language) -> Value {
    let empty = Figures {
        coefficients: Vec::new(),
        covariance: DMatrix::zeros(0, 0),
        causes: Vec::new(),
    };
    let figures = plan.figures.as_ref().unwrap_or(&empty);
    let mut value = common(experiment, figures, &plan.identifiability, &plan.aliases, l);
    value["kind"] = json!("plan");
    value["readings"] = json!(plan.readings);
    value["assumed_zero"] = json!(plan.assumed);
    value
}

fn common(
    experiment: &Experiment,
    figures: &Figures,
    identifiability: &Identifiability,
    aliases: &[Alias],
    l: Language,
) -> Value {
    let heading = &experiment.heading;
    let equations: Vec<&str> = (0..experiment.equations.responses().len())
        .map(|response| experiment.equations.text(response))
        .collect();
    json!({
        "format": FORMAT,
        "title": said(&heading.title, l),
        "procedure": heading.procedure,
        "reference": heading.reference,
        "object": heading.object,
        "author": heading.author,
        "date": heading.date,
        "equations": equations,
        "coverage_probability": experiment.coverage_probability,
        "coefficients": coefficients(figures, l),
        "covariance": rows(&figures.covariance),
        "correlation": rows(&correlation(figures)),
        "causes": figures.causes.iter().map(|cause| json_cause(cause, figures, l)).collect::<Vec<_>>(),
        "identifiability": {
            "rank": identifiability.rank,
            "parameters": identifiability.parameters,
            "condition": number(identifiability.condition),
            "undetermined": identifiability.undetermined.iter().map(|c| json!({
                "words": in_words(c, l),
                "changes": c.changes.iter().map(|(name, change, unit)| json!({ "parameter": name, "change": change, "unit": unit })).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
            "near": identifiability.near.iter().map(|near| json!({
                "parameter": near.parameter,
                "inflation": near.inflation,
                "changes": near.combination.changes.iter().map(|(name, change, unit)| json!({ "parameter": name, "change": change, "unit": unit })).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
        },
        "omitted": aliases.iter().map(|alias| json_alias(alias, experiment, l)).collect::<Vec<_>>(),
    })
}

fn coefficients(figures: &Figures, l: Language) -> Value {
    figures
        .coefficients
        .iter()
        .map(|one| {
            json!({
                "name": one.name,
                "description": one.description.as_ref().map(|words: &Words| said(words, l)),
                "unit": one.unit.symbol,
                "value": one.value,
                "u": one.u,
                "dof": number(one.dof),
                "k": number(one.k),
                "U": number(one.k * one.u),
                "p_value": number(one.p_value),
            })
        })
        .collect()
}

fn json_cause(cause: &Cause, figures: &Figures, l: Language) -> Value {
    let (words, _) = cause_words(cause, l);
    let (kind, scope) = match &cause.origin {
        Origin::Stated { scope, .. } => (
            "stated",
            match scope {
                Scope::Common => "common".to_owned(),
                Scope::Each => "each".to_owned(),
                Scope::By(column) => format!("by {column}"),
            },
        ),
        Origin::Residuals { .. } => ("residuals", "each".to_owned()),
        Origin::Samples { .. } => ("samples", "each".to_owned()),
        Origin::Prior { .. } => ("prior", "common".to_owned()),
    };
    let contributions = figures.coefficients.iter().enumerate().map(|(index, one)| {
        let contribution = cause.contribution(index);
        json!({
            "coefficient": one.name,
            "u": contribution,
            "effect": cause.effect(index),
            "share": number((contribution / one.u).powi(2)),
            "dof": number(cause.contribution_dof(index)),
        })
    });
    json!({
        "name": words,
        "kind": kind,
        "scope": scope,
        "how": cause.how,
        "contributions": contributions.collect::<Vec<_>>(),
    })
}

fn json_alias(alias: &Alias, experiment: &Experiment, l: Language) -> Value {
    let omitted = experiment.omitted.iter().find(|one| one.name == alias.name);
    let names = experiment
        .parameters
        .iter()
        .map(|one| (&one.name, &one.unit))
        .chain(experiment.results.iter().map(|one| (&one.name, &one.unit)));
    let shifts = names.zip(&alias.shifts).map(|((name, unit), shift)| {
        json!({ "coefficient": name, "per_unit": number(*shift), "unit": unit.symbol })
    });
    json!({
        "name": alias.name,
        "term": omitted.map(|one| one.term.as_str()),
        "unit": omitted.map(|one| one.unit.symbol.as_str()),
        "description": omitted.and_then(|one| one.description.as_ref()).map(|words| said(words, l)),
        "typical": omitted.and_then(|one| one.typical),
        "acts": alias.acts,
        "visible": number(alias.visible),
        "shifts": shifts.collect::<Vec<_>>(),
    })
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

/// A number, or null where there is none (JSON knows no infinity: it is null, too).
fn number(x: f64) -> Value {
    if x.is_finite() { json!(x) } else { Value::Null }
}
