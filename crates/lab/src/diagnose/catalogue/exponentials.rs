//! What changes exponentially with a column, faster and faster towards one end of what was recorded.

use super::building::{HIGHER, on_node, on_output};
use super::fitted::{FittedModel, Node};
use super::modifiers::{amount, five_digits, levels_of, map, range};
use super::sharp::{beats, sharpened};
use super::{Cell, EffectId, Modifier, Term, Variation};

/// A part of the output that dies away from the least value on, or grows towards the largest one.
pub(super) fn cell(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    /// Through fewer values a constant, a size and a width go anyhow.
    const VALUES: usize = 4;
    let levels = levels_of(fitted.numbers(column));
    let is_clock = fitted.clock.column == Some(column);
    if is_clock || fitted.is_angle(column) || levels.len() < VALUES {
        return None;
    }
    // Within one step of the values it would be the first or the last of them alone.
    let dying = course(fitted, column, -1.0, levels[0], levels[1] - levels[0]);
    let [before, last] = [levels[levels.len() - 2], levels[levels.len() - 1]];
    let growing = course(fitted, column, 1.0, last, last - before);
    let variants = dying.into_iter().chain(growing);
    let (id, name) = (EffectId::Exponential, fitted.label(column));
    Some(Cell {
        odds: HIGHER,
        ..on_node(fitted, id, name, Node::Output, variants)
    })
}

/// exp(±(x − x₀)/w), which is one at the end x₀, for several w.
fn course(
    fitted: &FittedModel<'_>,
    column: usize,
    sign: f64,
    end: f64,
    step: f64,
) -> Vec<Variation> {
    /// Of the range, which is covered evenly: up to 0.13 of it a parabola beside a line leaves more than half of the course, of a
    /// quarter 0.31. What is nearer to it is a parabola until something speaks for more.
    const WIDTHS: [f64; 3] = [0.03, 0.06, 0.12];
    /// Heat does: what it sets free over a gap of E grows over k·T²/E, which is 7 to 26 K for 1.1 to 0.3 eV about 300 K.
    const WIDE: f64 = 0.25;
    /// So does a recording in which the parabola does not do. It leaves 0.17 and 0.08 of these, a cubic beside it 0.02 and 0.005.
    const WIDER: [f64; 2] = [0.5, 1.0];
    let x = fitted.numbers(column);
    let (least, most) = range(x);
    let unit = fitted.step_unit(column).after_number();
    let word = if sign < 0.0 { "dying away" } else { "growing" };
    let term = |width: f64| -> Term {
        let values = map(x, |x| libm::exp(sign * (x - end) / width));
        let sign = if sign < 0.0 { "-" } else { "" };
        let (along, width) = (fitted.less(column, end), amount(width, &unit));
        on_output(Modifier::number(
            values,
            format!("exp({sign}{along}/({width}))"),
        ))
    };
    let width = |part: f64| five_digits(part * (most - least));
    let parabola = [
        on_output(fitted.centred(column)),
        on_output(fitted.by(column, "", |x| (x - end) * (x - end))),
    ];
    let widest = if fitted.is_temperature(column) {
        WIDE
    } else if fitted.is_like(column, "s") {
        // What settles has not always done so in the longest time of waiting.
        WIDER[1]
    } else {
        WIDTHS[2]
    };
    let widths = WIDTHS.into_iter().chain([WIDE]).chain(WIDER).map(width);
    let (own, wider): (Vec<f64>, Vec<f64>) = widths
        .filter(|width| *width >= step)
        .partition(|one| *one <= width(widest));
    let all = sharpened(fitted, [own.clone(), wider].concat(), &term);
    let shows = |one: &f64| *one > width(widest) && beats(fitted, &term(*one), &parabola);
    let wider = all.into_iter().filter(shows);
    let widths = sharpened(fitted, own, &term).into_iter().chain(wider);
    let each = fitted
        .finer
        .times(widths.collect())
        .into_iter()
        .map(five_digits)
        .map(|width| {
            let label = format!("{word} over {}", amount(width, &unit));
            Variation::one(label, term(width)).shaped("w", width, &unit)
        });
    each.collect()
}
