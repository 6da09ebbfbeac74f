//! A diagnosis for machines.

use serde_json::{Value, json};

use crate::diagnose::case::Case;
use crate::diagnose::evidence::{Alternative, Slot, State, Verdict};
use crate::diagnose::{
    Diagnosis, Estimated, Measure, ModelVersion, Omitted, Prediction, Quality, Trouble, Unsettled,
};

use super::statement::verdict;
use super::words::{self, formula, measure, name, name_of_atom, noise, prose};
use crate::language::Language;

/// Name and version of the format.
pub const FORMAT: &str = "gumption-diagnosis-1";

/// Everything that was found.
pub fn json(case: &Case, diagnosis: &Diagnosis, language: Language) -> Value {
    let examination = &diagnosis.examination;
    json!({
        "format": FORMAT,
        "title": case.title,
        "verdict": verdict_word(examination.verdict),
        "statement": verdict(diagnosis, language),
        "model": case.model,
        "noise": { "origin": noise(&diagnosis.noise, language), "dof": finite(diagnosis.noise.dof) },
        "rows": case.rows,
        "observations": diagnosis.residuals.len(),
        "alpha": case.settings.alpha,
        "seed": case.settings.seed,
        "levels": examination.levels.iter().map(|level| json!({
            "adopted": level.adopted.iter().map(|atom| name_of_atom(diagnosis, *atom, language)).collect::<Vec<_>>(),
            "strongest": name_of_atom(diagnosis, level.strongest, language),
            "p": level.p,
            "draws": level.draws,
        })).collect::<Vec<_>>(),
        "located": diagnosis.located.iter().take(20).map(|(cell, located)| json!({
            "node": cell.node, "factor": cell.factor, "level": cell.level,
            "size": located.size, "u": located.u, "delta_chi_squared": located.chi_squared, "p": located.p,
        })).collect::<Vec<_>>(),
        "effects": examination.slots.iter().map(|slot| effect(case, diagnosis, slot, language)).collect::<Vec<_>>(),
        "unsettled_fits": diagnosis.unsettled.iter().map(|one| unsettled(case, one, language)).collect::<Vec<_>>(),
        "explained": finite(examination.explained),
        "generic_probability": finite(examination.generic_probability),
        "margin": finite(examination.margin),
        "before": quality(&diagnosis.before),
        "after": diagnosis.adopted.as_ref().map(|adopted| quality(&adopted.quality)),
        "parameters": estimates(&diagnosis.unknowns),
        "improved": diagnosis.adopted.as_ref().map(|adopted| json!({
            "model": adopted.extended.case.model,
            "effects": adopted.atoms.iter().map(|atom| name_of_atom(diagnosis, *atom, language)).collect::<Vec<_>>(),
            "additions": adopted.extended.additions.iter().map(|addition| json!({
                "parameter": addition.parameter, "column": addition.column, "modifier": addition.text,
                "unit_of_modifier": addition.unit.typeset(),
            })).collect::<Vec<_>>(),
            "coefficients": estimates(&adopted.coefficients),
            "parameters": estimates(&adopted.unknowns),
            "promised_chi_squared": finite(adopted.confirmation.promised),
            "parts": adopted.confirmation.parts.iter().map(|(part, value, u)| json!({ "part": part, "value": value, "u": u })).collect::<Vec<_>>(),
            "agreement": adopted.confirmation.agreement,
        })),
        "omitted": diagnosis.omitted.iter().map(|line| omitted(diagnosis, line, language)).collect::<Vec<_>>(),
        "held_out": diagnosis.held_out.as_ref().map(|held| {
            let prediction = |p: &Prediction| json!({ "rms": p.rms, "chi_squared": finite(p.chi_squared) });
            json!({
                "file": held.file,
                "observations": held.observations,
                "expected_noise": held.expected,
                "before": prediction(&held.before),
                "after": held.after.as_ref().map(prediction),
            })
        }),
        "choices": diagnosis.choices.iter().map(|u| by_unknown(diagnosis, u)).collect::<Vec<_>>(),
        "u_with_unseen": by_unknown(diagnosis, &diagnosis.u_with_unseen()),
        "separating": diagnosis.separating.iter().map(|of| json!({
            "effect": of.slot,
            "rivals": of.rivals.iter().map(|cell| name(&diagnosis.cells[*cell], language)).collect::<Vec<_>>(),
            "classes": of.classes,
            "kappa": finite(of.kappa),
            "measurements": of.extras.iter().map(|(extra, worth)| json!({
                "name": measure(&extra.measure, language),
                "measure": measure_json(&extra.measure),
                "cost": extra.cost,
                "kappa": finite(worth.kappa),
                "resolved": finite(worth.resolved),
                "repeats": finite(worth.repeats),
            })).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
    })
}

/// What is done, for machines.
pub(super) fn measure_json(measure: &Measure) -> Value {
    match measure {
        Measure::Own(name) => json!({ "kind": "own", "name": name }),
        Measure::Again => json!({ "kind": "again" }),
        Measure::Reversed => json!({ "kind": "reversed" }),
        Measure::Set {
            column,
            value,
            unit,
        } => json!({ "kind": "set", "column": column, "value": value, "unit": unit }),
        Measure::Between { column } => json!({ "kind": "between", "column": column }),
        Measure::Opposite { column } => json!({ "kind": "opposite", "column": column }),
        Measure::Exchanged { column } => json!({ "kind": "exchanged", "column": column }),
    }
}

fn unsettled(case: &Case, found: &Unsettled, language: Language) -> Value {
    json!({
        "model": match found.model {
            ModelVersion::Declared => "declared",
            ModelVersion::Improved => "improved",
        },
        "trouble": match found.trouble {
            Trouble::NoMinimum { .. } => "no_minimum",
            Trouble::NoFit(_) => "no_fit",
        },
        "steps": match found.trouble {
            Trouble::NoMinimum { steps } => Some(steps),
            Trouble::NoFit(_) => None,
        },
        "message": words::unsettled(case, found, language),
    })
}

fn omitted(diagnosis: &Diagnosis, line: &Omitted, language: Language) -> Value {
    let unknowns = diagnosis
        .unknowns
        .iter()
        .map(|unknown| unknown.name.clone());
    super::open::omitted_json(&diagnosis.cells, line, unknowns.collect(), language)
}

/// Numbers by the names of the unknowns.
fn by_unknown(diagnosis: &Diagnosis, values: &[f64]) -> Value {
    let pairs = diagnosis.unknowns.iter().zip(values);
    let pairs = pairs.map(|(unknown, value)| (unknown.name.clone(), finite(*value)));
    Value::Object(pairs.collect())
}

fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::None => "none",
        Verdict::Identified => "identified",
        Verdict::Ambiguous => "ambiguous",
        Verdict::Partly => "partly",
        Verdict::Contested => "contested",
        Verdict::Unexplained => "unexplained",
    }
}

fn effect(case: &Case, diagnosis: &Diagnosis, slot: &Slot, language: Language) -> Value {
    json!({
        "state": match slot.state {
            State::Identified => "identified",
            State::Ambiguous => "ambiguous",
            State::Unexplained => "unexplained",
        },
        "named": slot.named.iter().map(|a| alternative(case, diagnosis, a, language)).collect::<Vec<_>>(),
        "unnamed": slot.generic.iter().map(|a| alternative(case, diagnosis, a, language)).collect::<Vec<_>>(),
        "unnamed_share": finite(slot.generic_share),
        "family": slot.family.as_ref().map(|(family, p)| json!({ "name": family, "probability": p })),
    })
}

/// What each size of the best variant multiplies, and its unit.
fn terms(case: &Case, diagnosis: &Diagnosis, alternative: &Alternative) -> Vec<Value> {
    let best = alternative.variants.first().map(|variant| {
        let (cell, variation) = diagnosis.atoms[variant.atom];
        &diagnosis.cells[cell].variants[variation]
    });
    let terms = best.into_iter().flat_map(|variation| &variation.terms);
    terms
        .filter(|term| !term.tied)
        .map(|term| {
            let unit = term.unit_of_size(case);
            json!({ "multiplies": term.written().text, "unit": unit.typeset() })
        })
        .collect()
}

fn alternative(
    case: &Case,
    diagnosis: &Diagnosis,
    alternative: &Alternative,
    language: Language,
) -> Value {
    let cell = &diagnosis.cells[alternative.candidate];
    json!({
        "id": cell.effect.id.as_str(),
        "name": name(cell, language),
        "family": cell.effect.family,
        "prose": cell.description.clone().unwrap_or_else(|| prose(cell, language)),
        "formula": formula(diagnosis, alternative, Language::English),
        "node": cell.place.node,
        "along": cell.place.along,
        "probability": alternative.probability,
        "variants": alternative.variants.iter().take(5).map(|variant| {
            let (cell, variation) = diagnosis.atoms[variant.atom];
            let cell = &diagnosis.cells[cell];
            json!({ "id": cell.effect.id.as_str(), "label": cell.variants[variation].label, "share": variant.share })
        }).collect::<Vec<_>>(),
        "terms": terms(case, diagnosis, alternative),
        "size": alternative.estimate.iter().map(|x| finite(*x)).collect::<Vec<_>>(),
        "u": alternative.u().iter().map(|u| finite(*u)).collect::<Vec<_>>(),
        "coverage_factor": finite(alternative.coverage_factor()),
        "lambda": finite(alternative.lambda),
        "nearest": alternative.nearest.as_ref().map(|rival| json!({
            "name": name(&diagnosis.cells[rival.candidate], language),
            "kappa": finite(rival.kappa),
            "alias": rival.alias,
            "resolved": finite(rival.resolved),
        })),
    })
}

fn quality(quality: &Quality) -> Value {
    json!({
        "chi_squared": quality.chi_squared,
        "dof": quality.dof,
        "residual_rms": quality.residual,
        "expected_noise": quality.expected,
        "held_out_rms": quality.held_out,
    })
}

pub(super) fn estimates(list: &[Estimated]) -> Vec<Value> {
    list.iter()
        .map(|e| json!({ "name": e.name, "unit": e.unit, "value": e.value, "u": e.u }))
        .collect()
}

/// A number that JSON can hold.
pub(super) fn finite(x: f64) -> Value {
    if x.is_finite() { json!(x) } else { Value::Null }
}
