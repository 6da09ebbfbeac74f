//! Ringing: the output follows a step of the input as a body on a spring does, and swings about the new value.

use std::f64::consts::TAU;

use super::building::{HIGHER, cell};
use super::fitted::{FittedModel, Node};
use super::modifiers::{creeps, figure, grid, in_unit};
use super::sharp::{best, sharpened, sharpest};
use super::{Cell, EffectId, Modifier, Term, Variation};

/// Damping ratios that are tried first. Above the largest the second swing is less than a fifth of the first, so that it is hardly
/// told from a lag.
const DAMPING: [f64; 3] = [0.03, 0.1, 0.25];

/// The cell of a column that goes in steps; along a slow course ringing is a delay.
pub(super) fn ringing(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    /// Rows in a period, at least: fewer do not show what happens between them.
    const ROWS: f64 = 4.0;
    /// From one period that is tried to the next, and how far a damping ratio may be from the one that was tried.
    const FINE: f64 = 1.25;
    const COARSE: f64 = 1.8;
    /// Each by itself, in turn: they hardly depend on one another.
    const ROUNDS: usize = 3;
    let steps = fitted.is_timed() && !fitted.is_temperature(column);
    if !steps || creeps(fitted.numbers(column)) {
        return None;
    }
    let clock = &fitted.clock;
    let periods = grid(ROWS * clock.interval, clock.span() / 3.0, FINE, 30);
    let rung = |period: f64, damping: f64| rung(fitted, column, Swing { period, damping });
    let all = DAMPING.iter().flat_map(|damping| {
        let swings = periods.iter();
        swings.map(move |period| (*period, *damping))
    });
    let all: Vec<(f64, f64)> = all.collect();
    let mut terms = all.iter().map(|(period, damping)| rung(*period, *damping));
    // What does not show has one damping ratio for all.
    let mut damping = DAMPING[1];
    if let Some(at) = best(fitted, &mut terms) {
        let mut period = all[at].0;
        damping = all[at].1;
        for _ in 0..ROUNDS {
            period = sharpest(fitted, (period, FINE), &|period| rung(period, damping));
            damping = sharpest(fitted, (damping, COARSE), &|damping| rung(period, damping));
            damping = damping.min(DAMPING[2]);
        }
    }
    let periods = sharpened(fitted, periods, &|period| rung(period, damping));
    let unit = fitted.time_unit();
    let variant = |period: f64| {
        let shown = in_unit(&figure(period), &unit);
        let label = format!("period {shown}, damping ratio {:.2}", damping);
        Variation::one(label, rung(period, damping)).shaped("T", period, &unit)
    };
    let variants = fitted.finer.times(periods).into_iter().map(variant);
    let node = Node::Column(column);
    let label = fitted.label(column);
    let mut cell = cell(fitted, EffectId::Ringing, node, label, variants.collect());
    "time".clone_into(&mut cell.place.along);
    cell.odds = HIGHER;
    Some(cell)
}

/// A damped oscillation.
#[derive(Clone, Copy)]
struct Swing {
    /// From one swing to the next.
    period: f64,
    /// Of the critical damping.
    damping: f64,
}

/// What the output has of a column beyond what it is given.
fn rung(fitted: &FittedModel<'_>, column: usize, swing: Swing) -> Term {
    let label = fitted.label(column);
    let Swing { period, damping } = swing;
    let (shown, ratio) = (fitted.duration(period), figure(damping));
    let text = format!("(ring({label}, {shown}, {ratio}) - {label})");
    let values = swing.beyond(&fitted.clock.values, fitted.numbers(column));
    let modifier = Modifier::new(values, text, fitted.step_unit(column));
    Term::new(Node::Column(column), modifier)
}

impl Swing {
    /// By how much a body on a spring is beyond where each row moves it to, at once behind the row before. It begins at rest,
    /// and anew where the time goes backwards.
    fn beyond(self, t: &[f64], x: &[f64]) -> Vec<f64> {
        let angular = TAU / self.period;
        let natural = angular / libm::sqrt(1.0 - self.damping * self.damping);
        let decay = self.damping * natural;
        let (mut distance, mut speed) = (0.0, 0.0);
        let rows = (0..x.len()).map(|row| {
            let gap = if row == 0 { -1.0 } else { t[row] - t[row - 1] };
            if gap < 0.0 {
                (distance, speed) = (0.0, 0.0);
                return 0.0;
            }
            distance -= x[row] - x[row - 1];
            let (sine, cosine) = (libm::sin(angular * gap), libm::cos(angular * gap));
            let (left, own) = (libm::exp(-decay * gap), decay / angular * sine);
            (distance, speed) = (
                left * (distance * (cosine + own) + speed * sine / angular),
                left * (speed * (cosine - own) - distance * sine * natural * natural / angular),
            );
            distance
        });
        rows.collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// The step response of the second order: 1 − e^(−ζωt)·(cos ω_d t + ζω/ω_d sin ω_d t), of which the overshoot is e^(−πζ/√(1−ζ²)).
    #[test]
    fn a_step_is_overshot_after_half_a_period() {
        let swing = Swing {
            period: 2.0,
            damping: 0.2,
        };
        let t: Vec<f64> = (0..9).map(|row| f64::from(row) * 0.25).collect();
        let x = [vec![0.0], vec![3.0; 8]].concat();
        let beyond = swing.beyond(&t, &x);
        let overshoot = libm::exp(-PI * 0.2 / libm::sqrt(1.0 - 0.04));
        assert!((beyond[4] - 3.0 * overshoot).abs() < 1e-12, "{beyond:?}");
        assert!((beyond[8] + 3.0 * overshoot * overshoot).abs() < 1e-12);
    }
}
