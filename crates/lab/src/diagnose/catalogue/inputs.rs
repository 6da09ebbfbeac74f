//! What an axis does to what it takes in, where the model forms that from several columns or from angles:
//! a gyroscope in some mount on a rate table, an accelerometer that is turned.
//!
//! The signal of a response, what its model gives besides constant terms, is the input of its axis in units
//! of the output. Here it is a part of the largest signal, so that all sizes are parts of the range.

use std::collections::BTreeSet;

use super::building::{form, on_output, plain, scoped, time_constants, timed};
use super::course::late;
use super::fitted::{FittedModel, Node, varies};
use super::generics::over_signals;
use super::history::comes_back;
use super::modifiers::{
    amount, correlation, creeps, crosses_zero, five_digits, in_each, largest, map, map2, mean_of,
    play_from, range, rate,
};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;
use gumption_core::quantity::Unit;

/// Cells of the inputs of all axes; none where a column is the input.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let inputs = inputs(fitted);
    if inputs.is_empty() {
        return Vec::new();
    }
    let mut cells = powers(fitted, &inputs);
    cells.extend(limits(fitted, &inputs));
    cells.extend(products(fitted, &inputs));
    cells.extend(memory(fitted, &inputs));
    cells
}

/// What follows the inputs smoothly and has no name.
pub(super) fn unnamed(fitted: &FittedModel<'_>) -> Option<Cell> {
    let inputs = inputs(fitted);
    let signals: Vec<(usize, &[f64])> = inputs.iter().map(|i| (i.response, &i.own[..])).collect();
    let variants = over_signals(fitted, &signals);
    (!variants.is_empty()).then(|| of_inputs(fitted, &inputs, EffectId::Smooth, variants))
}

/// What a response takes in.
struct Input {
    response: usize,
    /// `signal/2.5 V`, the formula of its own input.
    text: String,
    /// Along its axis, from −1 to 1.
    own: Vec<f64>,
    /// Along the other axes, likewise.
    others: Vec<Modifier>,
    /// Where a run begins: from which input, and how long before.
    came: Vec<Option<(f64, f64)>>,
}

fn inputs(fitted: &FittedModel<'_>) -> Vec<Input> {
    let case = fitted.case();
    // What goes on with the time is a drift of the source, not an input of an axis.
    let times = (case.with_role(Role::Time)).chain(case.with_role(Role::Order));
    let columns: Vec<usize> = fitted.numeric().into_iter().chain(times).collect();
    let of_response = |response: usize| {
        let signal = fitted.signal(response);
        let is_column = columns.iter().any(|c| fitted.takes_in(response, *c));
        let formed = !fitted.is_implicit(response) && varies(signal) && !is_column;
        let Modifier { values, text, .. } = self::signal(fitted, response);
        formed.then(|| Input {
            response,
            text,
            own: values.to_vec(),
            others: others(fitted, response),
            came: came(fitted, response),
        })
    };
    (0..case.responses.len()).filter_map(of_response).collect()
}

/// Where a head turns in one direction through each run, it goes back behind the first angle before the run,
/// so that this one too is reached like the others; no row shows that.
fn came(fitted: &FittedModel<'_>, response: usize) -> Vec<Option<(f64, f64)>> {
    let Some((angle, runs)) = super::angles::runs_of_turns(fitted) else {
        return Vec::new();
    };
    let (x, t) = (fitted.numbers(angle), &fitted.clock.values);
    let size = size(fitted.signal(response));
    let mut came = vec![None; fitted.rows()];
    for first in runs.into_iter().map(|run| run.start) {
        let behind = 2.0 * x[first] - x[first + 1];
        let signal = fitted.signal_at(response, first, angle, behind);
        came[first] = Some((signal / size, t[first + 1] - t[first]));
    }
    came
}

/// The signal of a response as a part of its largest value, which the formula shows: `(signal/(2.5 V))`.
pub(super) fn signal(fitted: &FittedModel<'_>, response: usize) -> Modifier {
    let unit = fitted.case().responses[response].unit.difference();
    part(fitted.signal(response), "signal", &unit)
}

/// The largest value, to five digits.
fn size(x: &[f64]) -> f64 {
    five_digits(largest(x).max(f64::MIN_POSITIVE))
}

/// As a part of the largest.
fn part(x: &[f64], name: &str, unit: &Unit) -> Modifier {
    let size = size(x);
    let text = format!("({name}/({}))", amount(size, &unit.after_number()));
    Modifier::number(map(x, |x| x / size), text)
}

/// Inputs of the other axes: where one angle turns the sensor, the slope of the signal by it; else what
/// the other coefficients of the model multiply.
fn others(fitted: &FittedModel<'_>, response: usize) -> Vec<Modifier> {
    let case = fitted.case();
    let by = |node: Node, unit: &Unit| {
        let slope = fitted.slope(node, response);
        let name = format!("dsignal/d{}", fitted.name(node));
        part(&slope, &name, &case.responses[response].unit.quotient(unit))
    };
    let angles: Vec<usize> = fitted.used(Role::Angle).collect();
    if let [angle] = angles[..] {
        return vec![by(Node::Column(angle), &fitted.step_unit(angle))];
    }
    // Along one column there is no other axis: the slopes by the parameters are the course of the model itself.
    if formed_from(fitted).len() < 2 {
        return Vec::new();
    }
    let signal = fitted.signal(response);
    let is_other = |parameter: &usize| {
        is_of_other_axis(&fitted.slope(Node::Parameter(*parameter), response), signal)
    };
    let others = (0..case.parameters.len()).filter(is_other);
    others
        .map(|parameter| by(Node::Parameter(parameter), &case.parameters[parameter].unit))
        .collect()
}

/// Whether a course may be the input of another axis than the one with a signal.
pub(super) fn is_of_other_axis(course: &[f64], signal: &[f64]) -> bool {
    /// What correlates so far with the signal is the input of the own axis.
    const OWN: f64 = 0.9;
    varies(course) && correlation(course, signal).abs() < OWN
}

/// A form without terms, which each input has in terms of its own by a law, with a modifier for each coefficient: on one axis,
/// and on all of them, on each with a size of its own.
fn by_law(
    fitted: &FittedModel<'_>,
    inputs: &[Input],
    form: &Variation,
    law: impl Fn(&Input) -> Vec<Modifier>,
) -> Vec<Variation> {
    let part = |input: &Input| -> (usize, Vec<Term>) {
        let modifiers = law(input).into_iter();
        let moving = modifiers.filter(|modifier| varies(&modifier.values));
        let terms = moving.map(|modifier| on_output(modifier).on(input.response));
        (input.response, terms.collect())
    };
    scoped(fitted, form, inputs.iter().map(part).collect())
}

/// A cell on the outputs, along the columns that inputs are formed from.
fn of_inputs(
    fitted: &FittedModel<'_>,
    inputs: &[Input],
    id: EffectId,
    variants: Vec<Variation>,
) -> Cell {
    let along = fitted.names(&formed_from(fitted));
    let mut cell = plain(fitted, id, &along, variants);
    let name = |input: &Input| fitted.case().responses[input.response].name.as_str();
    let names: Vec<&str> = inputs.iter().map(name).collect();
    cell.words.x = format!("signal({})", names.join(", "));
    cell
}

/// The columns that inputs are formed from.
fn formed_from(fitted: &FittedModel<'_>) -> Vec<usize> {
    let columns = &fitted.case().columns;
    let forms =
        |c: &usize| matches!(columns[*c].role, Role::Stimulus | Role::Angle) && fitted.in_model(*c);
    (0..columns.len()).filter(forms).collect()
}

fn powers(fitted: &FittedModel<'_>, inputs: &[Input]) -> Vec<Cell> {
    type Power = (EffectId, [&'static str; 2], fn(f64) -> f64);
    let laws: [Power; 3] = [
        (EffectId::Quadratic, ["", "^2"], |s| s * s),
        (EffectId::Cubic, ["", "^3"], |s| s * s * s),
        (EffectId::Asymmetry, ["abs", ""], f64::abs),
    ];
    let one = |(id, [before, after], law): Power| {
        let variants = by_law(fitted, inputs, &form("", Vec::new()), |input| {
            let text = format!("{before}{}{after}", input.text);
            vec![Modifier::number(map(&input.own, law), text)]
        });
        of_inputs(fitted, inputs, id, variants)
    };
    // What has one sign is no more than a scale.
    let two_signs = inputs.iter().any(|input| crosses_zero(&input.own));
    let laws = laws.into_iter();
    let laws = laws.filter(|(id, ..)| two_signs || *id != EffectId::Asymmetry);
    let mut cells: Vec<Cell> = laws.map(one).collect();
    // Small inputs are other axes' inputs that leak in: they have no sign of their own.
    let steps = [0.02, 0.1].map(|width: f64| {
        let form = form(format!("within {} %", 100.0 * width), Vec::new());
        by_law(fitted, inputs, &form, |input| {
            let modifier = map(&input.own, |s| (s / width).clamp(-1.0, 1.0));
            let text = format!("clamp({}/{width}, -1, 1)", input.text);
            vec![Modifier::number(modifier, text)]
        })
    });
    cells.push(of_inputs(
        fitted,
        inputs,
        EffectId::ZeroStep,
        steps.concat(),
    ));
    cells
}

/// The end of the range on both sides, and on one.
fn limits(fitted: &FittedModel<'_>, inputs: &[Input]) -> Option<Cell> {
    /// Sizes of the input below which its end cannot be seen to bend.
    const LEVELS: usize = 6;
    // Different ones, to a hundredth of the largest.
    let sizes = |input: &Input| -> BTreeSet<i64> {
        let sizes = input.own.iter().map(|x| (100.0 * x.abs()).round() as i64);
        sizes.collect()
    };
    if inputs.iter().map(|input| sizes(input).len()).max()? < LEVELS {
        return None;
    }
    let knees = [0.5, 0.6, 0.7, 0.8, 0.9].map(|knee: f64| {
        let form = form(format!("above {knee} of the largest"), Vec::new());
        by_law(fitted, inputs, &form.shaped("x₀", knee, ""), |input| {
            let modifier = map(&input.own, |s| -(s.abs() - knee).max(0.0) * s.signum());
            let text = format!("-sign(signal)*max(abs{} - {knee}, 0)", input.text);
            vec![Modifier::number(modifier, text)]
        })
    });
    Some(of_inputs(
        fitted,
        inputs,
        EffectId::Saturation,
        knees.concat(),
    ))
}

/// Products with the inputs of other axes, and their squares.
fn products(fitted: &FittedModel<'_>, inputs: &[Input]) -> Vec<Cell> {
    /// A product that is never larger than this is a leak of one axis into the other.
    const LEAK: f64 = 0.05;
    let product = |input: &Input, other: &Modifier| {
        let product = Modifier::number(input.own.clone(), &input.text).times(other);
        (largest(&product.values) > LEAK).then_some(product)
    };
    let most = inputs.iter().map(|input| input.others.len()).max();
    let each = 0..most.unwrap_or(0);
    let name = |other: usize| match each.len() {
        1 => String::new(),
        _ => format!("other axis {}", other + 1),
    };
    let crossed = each.clone().flat_map(|at| {
        by_law(fitted, inputs, &form(name(at), Vec::new()), |input| {
            let other = input.others.get(at).into_iter();
            other.filter_map(|other| product(input, other)).collect()
        })
    });
    let mut crossed: Vec<Variation> = crossed.collect();
    if each.len() > 1 {
        crossed.extend(by_law(fitted, inputs, &form("", Vec::new()), |input| {
            let others = input.others.iter();
            others.filter_map(|other| product(input, other)).collect()
        }));
    }
    // All squares together are the square of the own input: the field has a length.
    let squared = each.clone().flat_map(|at| {
        by_law(fitted, inputs, &form(name(at), Vec::new()), |input| {
            let other = input.others.get(at).into_iter();
            other.map(Modifier::square).collect()
        })
    });
    vec![
        of_inputs(fitted, inputs, EffectId::CrossProduct, crossed),
        of_inputs(fitted, inputs, EffectId::CrossSquare, squared.collect()),
    ]
}

/// What depends on the inputs before: relaxation, late reading, hysteresis.
fn memory(fitted: &FittedModel<'_>, inputs: &[Input]) -> Vec<Cell> {
    let mut cells = Vec::new();
    let t = &fitted.clock.values;
    if inputs.iter().any(|input| comes_back(t, &input.own)) {
        let loops = loops(fitted, inputs);
        cells.push(of_inputs(fitted, inputs, EffectId::Hysteresis, loops));
    }
    if !fitted.is_timed() {
        return cells;
    }
    let scales = time_constants(fitted);
    let lacks = |input: &Input, tau: f64| {
        let own = &input.own;
        let modifier = map2(&late(t, own, &input.came, tau), own, |late, now| late - now);
        let (own, shown) = (&input.text, fitted.duration(tau));
        Modifier::number(modifier, format!("(lag({own}, {shown}) - {own})"))
    };
    let singles = fitted.finer.times(scales.clone());
    let of = |scales: &[f64]| {
        by_law(
            fitted,
            inputs,
            &timed(fitted, scales, Vec::new()),
            |input| scales.iter().map(|tau| lacks(input, *tau)).collect(),
        )
    };
    let single = singles.iter().flat_map(|tau| of(&[*tau]));
    // Real bodies relax more than once: a quick part and a slow one.
    let double = (scales.iter().step_by(2)).flat_map(|tau| of(&[*tau, 4.0 * tau]));
    let lags = single.chain(double).collect();
    cells.push(of_inputs(fitted, inputs, EffectId::Lag, lags));
    let skew = by_law(fitted, inputs, &form("", Vec::new()), |input| {
        let per_time = Unit::one().quotient(&fitted.clock_unit());
        let text = format!("d{}/dt", input.text);
        let modifier = Modifier::new(rate(t, &input.own), text, per_time).negated();
        let moving = creeps(&input.own);
        moving.then_some(modifier).into_iter().collect()
    });
    cells.push(of_inputs(fitted, inputs, EffectId::TimingSkew, skew));
    cells
}

/// Loops of a body with inner friction: one play, or several of growing width in parallel.
fn loops(fitted: &FittedModel<'_>, inputs: &[Input]) -> Vec<Variation> {
    const WIDTHS: [f64; 5] = [0.1, 0.3, 0.6, 1.0, 1.5];
    let behind = |input: &Input, width: f64| {
        // At rest there was no input.
        let played = in_each(&fitted.clock.values, |rows| {
            let came = input.came.get(rows.clone()).unwrap_or_default();
            play_from(0.0, &input.own[rows], came, width)
        });
        map2(&input.own, &played, |s, behind| s - behind)
    };
    let one = WIDTHS.map(|width| {
        let form = form(format!("width {width}"), Vec::new());
        by_law(fitted, inputs, &form, |input| {
            let (least, most) = range(&input.own);
            if most - least <= width {
                return Vec::new();
            }
            let text = format!("({own} - play({own}, {width}))", own = input.text);
            vec![Modifier::number(behind(input, width), text)]
        })
    });
    let many = by_law(
        fitted,
        inputs,
        &form("several widths", Vec::new()),
        |input| {
            let mean = mean_of(&WIDTHS.map(|width| behind(input, width)));
            let (own, widths) = (&input.text, WIDTHS.map(|width| width.to_string()));
            let widths = widths.join(", ");
            let text = format!("mean of ({own} - play({own}, w)) over w = {widths}");
            vec![Modifier::number(mean, text)]
        },
    );
    [one.concat(), many].concat()
}
