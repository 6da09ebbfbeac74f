//! What the readout and the protocol do: rounding to a step, outputs in the wrong line.

use super::building::{on_output, plain};
use super::fitted::{FittedModel, varies};
use super::{Cell, EffectId, Modifier, Variation, tied};

/// Cells of the readout.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells: Vec<Cell> = (0..fitted.case().responses.len())
        .filter_map(|response| quantisation(fitted, response))
        .collect();
    cells.extend(shifted(fitted));
    cells
}

/// Rounding of the model's output to the step in which readings come: an error of known size.
fn quantisation(fitted: &FittedModel<'_>, response: usize) -> Option<Cell> {
    let observed = fitted.design.observed(response);
    if fitted.is_implicit(response) || fitted.design.blocks.len() < fitted.rows() {
        return None;
    }
    let step = step(&observed)?;
    let model = &fitted.fit.linear.values[response];
    let modifier: Vec<f64> = model
        .iter()
        .map(|y| (y / step).round() * step - y)
        .collect();
    let name = &fitted.case().responses[response].name;
    let unit = fitted.case().responses[response].unit.typeset();
    let shown = super::modifiers::figure(step);
    let term = on_output(Modifier::new(
        modifier,
        format!("(round({name}/{shown})*{shown} - {name})"),
        fitted.case().responses[response].unit.difference(),
    ));
    let label = format!("step {shown} {unit}");
    let mut cell = plain(
        fitted,
        EffectId::Quantisation,
        name,
        vec![Variation::one(label, term.on(response))],
    );
    cell.words.y = name.clone();
    Some(cell)
}

/// The step of which all differences of readings are multiples, if it is coarse: several readings agree.
fn step(readings: &[f64]) -> Option<f64> {
    /// Share of the readings that are different from all others, at most.
    const ALIKE: f64 = 0.7;
    /// A multiple is whole to this part of the step.
    const WHOLE: f64 = 1e-3;
    let mut values = readings.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 3 || values.len() as f64 > ALIKE * readings.len() as f64 {
        return None;
    }
    let gaps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let whole = |gap: &f64| {
        let times = gap / step;
        (times - times.round()).abs() < WHOLE * times.max(1.0)
    };
    // Values that come again because the stimulus does have no common step.
    let range = values[values.len() - 1] - values[0];
    (gaps.iter().all(whole) && range < 1e4 * step).then_some(step)
}

/// Every output stands one row too late or too early.
fn shifted(fitted: &FittedModel<'_>) -> Option<Cell> {
    let single = fitted.design.blocks.iter().all(|rows| rows.len() == 1);
    if !single || !fitted.has_signal() || fitted.rows() < 8 {
        return None;
    }
    let last = fitted.rows() - 1;
    let variant = |label: &str, other: &dyn Fn(usize) -> usize| {
        let terms = (0..fitted.case().responses.len()).map(|response| {
            let model = &fitted.fit.linear.values[response];
            let modifier = (0..=last).map(|row| model[other(row)] - model[row]);
            let unit = fitted.case().responses[response].unit.difference();
            let text = format!("outputs {label}");
            on_output(Modifier::new(modifier.collect(), text, unit)).on(response)
        });
        let terms = terms.filter(|term| varies(&term.modifier.values));
        Variation::of(label, tied(terms.collect()))
    };
    let variants = vec![
        variant("one row late", &|row| row.saturating_sub(1)),
        variant("one row early", &|row| (row + 1).min(last)),
    ];
    Some(plain(fitted, EffectId::Shifted, "row", variants))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_display_has_a_step() {
        let readings: Vec<f64> = (0..60)
            .map(|k| (f64::from(k) * 0.013 / 0.05).round() * 0.05)
            .collect();
        let found = step(&readings).unwrap();
        assert!((found - 0.05).abs() < 1e-9);
        let fine: Vec<f64> = (0..60).map(|k| libm::sin(f64::from(k))).collect();
        assert_eq!(step(&fine), None);
    }
}
