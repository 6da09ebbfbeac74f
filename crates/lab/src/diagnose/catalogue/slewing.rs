//! Limits of speed: the output follows a step of the input no faster than at a certain rate.

use super::building::{HIGHER, cell};
use super::fitted::{FittedModel, Node, varies};
use super::modifiers::{creeps, figure, grid, in_unit};
use super::sharp::sharpened;
use super::{Cell, EffectId, Modifier, Term, Variation};

/// The cell of a column that goes in steps; what follows a slow course is not limited by its speed.
pub(super) fn slewing(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    /// From one rate that is tried to the next.
    const FINE: f64 = 1.25;
    const RATES: usize = 30;
    let steps = fitted.is_timed() && !fitted.is_temperature(column);
    let (t, x) = (&fitted.clock.values, fitted.numbers(column));
    if !steps || creeps(x) {
        return None;
    }
    let largest = x.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let largest = largest.fold(0.0, f64::max);
    // A step that is over at the next row shows no rate, one that lasts for a third of the recording is a drift.
    let rates = grid(
        3.0 * largest / fitted.clock.span(),
        largest / fitted.clock.interval,
        FINE,
        RATES,
    );
    let unit = match fitted.unit(column) {
        one if one.is_empty() => format!("1/{}", fitted.time_unit()),
        unit => format!("{unit}/{}", fitted.time_unit()),
    };
    let term = |rate: f64| {
        let (label, shown) = (fitted.label(column), in_unit(&figure(rate), &unit));
        let text = format!("(slew({label}, {shown}) - {label})");
        let modifier = Modifier::new(behind(t, x, rate), text, fitted.step_unit(column));
        Term::new(Node::Column(column), modifier)
    };
    let rates = sharpened(fitted, rates, &term);
    let variant = |rate: f64| {
        let label = format!("at most {}", in_unit(&figure(rate), &unit));
        Variation::one(label, term(rate)).shaped("r", rate, &unit)
    };
    let variants = fitted.finer.times(rates).into_iter().map(variant);
    let shows = |one: &Variation| varies(&one.terms[0].modifier.values);
    let variants: Vec<Variation> = variants.filter(shows).collect();
    let (node, label) = (Node::Column(column), fitted.label(column));
    let mut cell = cell(fitted, EffectId::Slewing, node, label, variants);
    "time".clone_into(&mut cell.place.along);
    cell.odds = HIGHER;
    Some(cell)
}

/// By how much what follows at this rate at most is beyond what each row moves it to, at once behind the row before. It begins at
/// rest, and anew where the time goes backwards.
fn behind(t: &[f64], x: &[f64], rate: f64) -> Vec<f64> {
    let mut distance = 0.0;
    let rows = (0..x.len()).map(|row| {
        let gap = if row == 0 { -1.0 } else { t[row] - t[row - 1] };
        if gap < 0.0 {
            distance = 0.0;
            return 0.0;
        }
        distance -= x[row] - x[row - 1];
        let reach = rate * gap;
        distance -= distance.max(-reach).min(reach);
        distance
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_a_ramp_that_ends() {
        let t = [0.0, 0.5, 1.0, 2.0, 2.5, 3.0];
        let x = [1.0, 5.0, 5.0, 5.0, 5.0, 4.5];
        // 2 in a unit of time: 1, 2 then 4 of the way; the last step is within reach.
        let left = behind(&t, &x, 2.0);
        assert_eq!(left, [0.0, -3.0, -2.0, 0.0, 0.0, 0.0]);
    }
}
