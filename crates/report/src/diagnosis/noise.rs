//! Where the noise of a recording comes from, in words.

use crate::figures::with_unit;
use crate::language::Language;
use crate::number::{exact, freedom, significant};
use gumption_fault::say;
use gumption_lab::diagnose::case::{Case, NoiseClaim};
use gumption_lab::diagnose::{Claimed, Diagnosis, Growth, Memory, Origin, Quantity, u_of_step};

use super::labels::spoken;
use super::words::p_is;

/// The noise that was assumed, and why, where it needs outputs that are not recorded.
pub fn assumed_noise(case: &Case, claimed: &Claimed, l: Language) -> String {
    if claimed.origin != Origin::Unknown {
        return noise(case, claimed, l);
    }
    let why = match case.noise {
        NoiseClaim::Replicates(_) => {
            say!("replicates show it once their outputs are recorded").in_language(l)
        }
        _ => say!("not claimed, and no outputs are recorded").in_language(l),
    };
    say!("not known ({why}): taken as 1 for one row, in the unit of the output; `[noise] u` states it").in_language(l)
}

/// Where the noise comes from.
pub(super) fn noise(case: &Case, claimed: &Claimed, l: Language) -> String {
    let dof = if claimed.dof.is_finite() && claimed.dof > 0.0 {
        format!(", ν = {}", freedom(claimed.dof))
    } else {
        String::new()
    };
    let text = match &claimed.origin {
        Origin::Unknown => l.pick("not known", "未知").to_owned(),
        Origin::Estimated => {
            l.pick("estimated from the residuals", "由残差估计")
                .to_owned()
                + &growth(claimed, l)
                + &by_label(claimed, l)
        }
        Origin::Arithmetic => {
            say!("none: the model meets every reading to the rounding of numbers").in_language(l)
        }
        Origin::Case => say!("as stated in the case").in_language(l),
        Origin::Column(name) => say!("from the column {name}").in_language(l),
        Origin::Replicates => {
            l.pick("from replicates", "由重复测量得到").to_owned() + &growth(claimed, l)
        }
        Origin::AtRest(file) => {
            say!("from the recording at rest {file}{}", white(claimed, l)).in_language(l)
        }
        Origin::Budget(file) => say!("from the budget {file}").in_language(l),
    };
    text + &rounding(case, claimed, l)
        + &dof
        + &memory(case, claimed, l)
        + &tails(claimed, l)
        + &uneven(claimed, l)
        + &together(case, claimed, l)
}

/// That the residuals are smaller than the claim lets expect.
pub(super) fn quieter(diagnosis: &Diagnosis, l: Language) -> String {
    let adopted = diagnosis.adopted.as_ref();
    let quality = adopted.map_or(&diagnosis.before, |adopted| &adopted.quality);
    let Some(p) = quality.quieter(&diagnosis.noise) else {
        return String::new();
    };
    let (reduced, p) = (significant(quality.reduced(), 2), p_is(p));
    say!("; the residuals are smaller than it lets expect (χ²/ν = {reduced}, {p} of as small a one): it is claimed too large, or the readings do not scatter as readings do (rounded alike, averaged, computed)").in_language(l)
}

/// That errors of two outputs are not independent.
fn together(case: &Case, claimed: &Claimed, l: Language) -> String {
    let Some(together) = &claimed.together else {
        return String::new();
    };
    let [one, other] = together
        .outputs
        .map(|output| case.responses[output].name.as_str());
    let (r, p) = (significant(together.correlation, 2), p_is(together.p));
    say!("; what is left of {one} and {other} in a row goes together (r = {r}, {p}): their errors count as independent, so that what is named may be noise that they share").in_language(l)
}

/// The rounding of readings, where a claim does not hold it or it is a part of what is estimated.
fn rounding(case: &Case, claimed: &Claimed, l: Language) -> String {
    let steps = case.responses.iter().zip(unclaimed_steps(claimed));
    let said = steps.filter_map(|(response, step)| {
        let (output, unit) = (&response.name, response.unit.typeset());
        let u = with_unit(&significant(u_of_step((*step)?), 2), &unit);
        let step = with_unit(&exact((*step)?), &unit);
        let said = match claimed.is_estimated() {
            true => say!("; in it the rounding of {output} to steps of {step}: u = {u}"),
            false => say!("; beside it the rounding of {output} to steps of {step}: u = {u}"),
        };
        Some(said.in_language(l))
    });
    said.collect()
}

/// For each output the step of its readings, where their rounding is beside what is claimed, or a part of what is estimated.
pub(super) fn unclaimed_steps(claimed: &Claimed) -> &[Option<f64>] {
    let unclaimed = claimed
        .rounding
        .as_ref()
        .filter(|rounding| !rounding.is_stated);
    unclaimed.map_or(&[], |rounding| &rounding.steps)
}

/// That errors have heavier tails than normal ones, where that is beyond doubt.
fn tails(claimed: &Claimed, l: Language) -> String {
    let said = claimed.tails.heavy.map(|dof| {
        let dof = significant(dof, 1);
        let farthest = spoken(claimed.farthest.as_deref().unwrap_or_default(), l);
        say!("; its tails are heavier than those of normal errors (Student's distribution with about {dof} degrees of freedom): single readings far off are part of it, the farthest {farthest}")
    });
    said.map_or_else(String::new, |said| said.in_language(l))
}

/// That a recording at rest tells nothing of the course of the noise.
fn white(claimed: &Claimed, l: Language) -> String {
    match &claimed.correlated {
        Some(correlated) if matches!(correlated.memory, Memory::Claimed | Memory::Rounded) => String::new(),
        _ => say!(", as white noise (its course needs the time, by one name in both recordings, and 20 readings)").in_language(l),
    }
}

/// How the errors of successive rows are correlated, where the recording shows it.
fn memory(case: &Case, claimed: &Claimed, l: Language) -> String {
    let Some(correlated) = &claimed.correlated else {
        return String::new();
    };
    // What is left beside nearly all has a digit as well.
    let digits = |share: f64| if share > 0.99 { 3 } else { 2 };
    let part = |share: f64| match share >= 0.9995 {
        true => "100".to_owned(),
        false => significant(100.0 * share, digits(share)),
    };
    match correlated.memory {
        Memory::White | Memory::Claimed | Memory::Rounded => String::new(),
        Memory::Fading {
            share,
            time_constant,
        } => {
            let (share, time) = (part(share), significant(time_constant, 2));
            let unit = &correlated.unit;
            say!("; successive rows are correlated: about {share} % of the variance fades with τ ≈ {time} {unit}").in_language(l)
        }
        Memory::Flicker { share } => {
            let share = part(share);
            say!("; successive rows are correlated: about {share} % of the variance flickers (1/f)")
                .in_language(l)
        }
        Memory::OfScale {
            time_constant: Some(time_constant),
            ..
        } => {
            let (time, unit) = (significant(time_constant, 2), &correlated.unit);
            say!("; what grows is the scale, which wanders: it fades with τ ≈ {time} {unit}")
                .in_language(l)
        }
        Memory::OfScale {
            time_constant: None,
            ..
        } => say!("; what grows is the scale, which wanders: it flickers (1/f)").in_language(l),
        Memory::InCommon { share } => {
            let outputs = correlated.outputs_in_common(case.responses.len());
            let names = outputs.iter().map(|at| case.responses[*at].name.as_str());
            let (share, names) = (part(share), names.collect::<Vec<_>>().join(l.list_comma()));
            say!("; errors of {names} in the same row go together: about {share} % of the variance is in common").in_language(l)
        }
    }
}

/// That replicates scatter otherwise than the claim says.
fn uneven(claimed: &Claimed, l: Language) -> String {
    let Some(p) = claimed.uneven else {
        return String::new();
    };
    let p = p_is(p);
    say!("; replicates scatter unevenly from group to group (Bartlett's test, {p}): this noise does not describe them, state u for each row").in_language(l)
}

/// How noise that was estimated, or that replicates show, grows with the reading, if it does for any response.
fn growth(claimed: &Claimed, l: Language) -> String {
    let grows: Vec<String> = claimed
        .growth
        .iter()
        .flatten()
        .map(|growth| {
            let constant = significant(growth.constant, 2);
            let proportional = significant(100.0 * growth.proportional, 2);
            let y = match growth.with {
                Quantity::Reading => "y",
                Quantity::Signal | Quantity::Applied => "(y − y₀)",
            };
            match growth.unit.as_str() {
                "" | "1" => format!("u² = {constant}² + ({proportional} % · {y})²"),
                unit => format!("u² = ({constant} {unit})² + ({proportional} % · {y})²"),
            }
        })
        .collect();
    if grows.is_empty() {
        return String::new();
    }
    let grows = grows.join("; ");
    let of = |with: Quantity| {
        let mut all = claimed.growth.iter().flatten();
        all.any(|growth: &Growth| growth.with == with)
    };
    match (of(Quantity::Signal), of(Quantity::Applied)) {
        (true, _) => {
            say!(", growing with the reading: {grows}, with the constant terms y₀ of the model")
        }
        (false, true) => {
            say!(", growing with the reading: {grows}, with y₀ as it is where nothing is applied")
        }
        (false, false) => say!(", growing with the reading: {grows}"),
    }
    .in_language(l)
}

/// How noise that was estimated differs from label to label, if it does for any response: by its u, or where that grows too, by what
/// it is of the one that is said to grow.
fn by_label(claimed: &Claimed, l: Language) -> String {
    let each = claimed.by_label.iter().zip(&claimed.growth);
    let each = each.filter_map(|(by, growth)| {
        let by = by.as_ref()?;
        let name = &by.column;
        let shown = |shown: &dyn Fn(f64) -> String| by.range().map(shown);
        Some(match growth {
            None => {
                let [least, most] =
                    shown(&|factor| with_unit(&significant(factor * by.mean, 2), &by.unit));
                say!(", differing from {name} to {name}: u from {least} to {most}")
            }
            Some(_) => {
                let [least, most] = shown(&|factor| significant(factor, 2));
                say!(", from {least} to {most} times as large from {name} to {name}")
            }
        })
    });
    each.map(|said| said.in_language(l)).collect()
}
