//! What recorded conditions may do that the model leaves out: on the offset, on the scale, with a lag,
//! squared, as a rate, inversely, and together.

use super::building::{HIGHER, decay, form, on_node, on_output, pair, time_constants, timed};
use super::course::late;
use super::exponentials;
use super::fitted::{FittedModel, Node, varies};
use super::modifiers::{centred, correlation, figure, five_digits, levels_of, map, map2, range};
use super::powers::zero_near;
use super::sharp::sharpened;
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;
use gumption_core::quantity::Unit;

/// Odds beforehand that pressure or humidity acts on an instrument, over those of another condition: they are
/// recorded because laboratories record them.
const AIR: f64 = 0.2;

/// Cells of the columns that may act although, or besides how, the model uses them.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    let mut conditions = fitted.numeric();
    conditions.retain(|column| !fitted.in_model(*column));
    for column in &conditions {
        cells.extend(of_condition(fitted, *column));
        // What leaks or diffuses does so by the energy of heat; what a reading taken too soon or too near still has to lose dies away
        // with a time of waiting or a distance, which have a true zero.
        let dies_away = fitted.is_temperature(*column) || spreads(fitted, *column);
        let exponential = dies_away.then(|| exponentials::cell(fitted, *column));
        cells.extend(exponential.flatten());
    }
    for column in conditions.iter().filter(|c| spreads(fitted, **c)) {
        cells.push(reciprocal(fitted, *column, scale(fitted)));
    }
    for (at, x) in conditions.iter().enumerate() {
        for z in &conditions[at + 1..] {
            cells.extend(of_pair(fitted, *x, *z));
        }
    }
    cells
}

fn of_condition(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let label = fitted.label(column);
    let own = fitted.centred(column);
    let temperature = fitted.is_temperature(column);
    let stimulus = fitted.case().columns[column].role == Role::Stimulus;
    let [second, on_scale, by_rate] = match temperature {
        true => [
            EffectId::TempcoQuadratic,
            EffectId::TempcoScale,
            EffectId::TemperatureRate,
        ],
        false => [
            EffectId::SensitivityQuadratic,
            EffectId::SensitivityScale,
            EffectId::SensitivityRate,
        ],
    };
    let on = |node: Node| delayed(fitted, column, node, &own);
    let linear = |node: Node, delayed: &[Variation]| -> Vec<Variation> {
        let leading = leading(fitted, column, &own);
        let delayed = delayed.iter().cloned().chain(leading);
        delayed.chain(about_zero(fitted, column, node)).collect()
    };
    let (output, gain) = (Node::Output, Node::Gain);
    let delayed = on(output);
    let square = delayed.iter().map(|late| {
        let squares = late.terms.iter().map(|term| term.modifier.square());
        Variation {
            terms: squares.map(on_output).collect(),
            ..late.clone()
        }
    });
    let square = square.chain(squares(fitted, column)).collect();
    let cube = temperature.then(|| (EffectId::TempcoCubic, output, cubes(fitted, column)));
    let first = on_offset(fitted, column);
    let mut effects = vec![
        (first, output, linear(output, &delayed)),
        (second, output, square),
    ];
    effects.extend(cube);
    if fitted.has_signal() {
        let second_on_scale = EffectId::SensitivityScaleQuadratic;
        effects.push((on_scale, gain, linear(gain, &on(gain))));
        effects.push((second_on_scale, gain, squares(fitted, column)));
    }
    if fitted.is_timed() {
        let rate = form("", vec![fitted.rate(column)]);
        effects.push((by_rate, output, vec![rate]));
    }
    if !stimulus && stands_for_temperature(fitted, column) {
        let id = EffectId::UnrecordedTemperature;
        effects.push((id, output, linear(output, &delayed)));
    }
    let odds = match !stimulus && is_of_air(fitted, column) {
        true => AIR,
        false => 1.0,
    };
    let cell = |(id, node, forms): (EffectId, Node, Vec<Variation>)| Cell {
        odds: match id {
            EffectId::UnrecordedTemperature => 1.0,
            EffectId::TempcoCubic => odds * HIGHER * HIGHER,
            _ if id.entry().is_higher => odds * HIGHER,
            _ => odds,
        },
        ..on_node(fitted, id, label, node, forms)
    };
    effects.into_iter().map(cell).collect()
}

/// What a column does to the offset.
pub(super) fn on_offset(fitted: &FittedModel<'_>, column: usize) -> EffectId {
    match fitted.case().columns[column].role {
        _ if fitted.is_temperature(column) => EffectId::TempcoBias,
        Role::Stimulus => EffectId::CrossSensitivity,
        _ => EffectId::Sensitivity,
    }
}

/// Whether a column is the pressure or the humidity of the air.
fn is_of_air(fitted: &FittedModel<'_>, column: usize) -> bool {
    fitted.case().columns[column].unit.symbol == "%" || fitted.is_like(column, "Pa")
}

/// Whether a condition changes slowly while no temperature was recorded: whatever went up and down with the
/// room looks like it.
fn stands_for_temperature(fitted: &FittedModel<'_>, column: usize) -> bool {
    /// Mean square of successive differences over the variance, from which on a series is no slow one: for
    /// independent values it is 2 (von Neumann).
    const SLOW: f64 = 0.5;
    let recorded = (0..fitted.case().columns.len()).any(|c| fitted.is_temperature(c));
    let mut order: Vec<usize> = (0..fitted.rows()).collect();
    order.sort_by(|a, b| fitted.clock.values[*a].total_cmp(&fitted.clock.values[*b]));
    let x = centred(fitted.numbers(column));
    let squares: f64 = x.iter().map(|x| x * x).sum();
    let steps: f64 = (order.windows(2))
        .map(|pair| (x[pair[1]] - x[pair[0]]).powi(2))
        .sum();
    !recorded && fitted.is_timed() && steps < SLOW * squares
}

/// The square alone of what has a zero of its own, unless the numbers vary so little that it is a line, and the square about their
/// middle with a linear part; nothing where they are the same up to their sign.
fn squares(fitted: &FittedModel<'_>, column: usize) -> Vec<Variation> {
    /// Through so many values a square with a line goes anyhow.
    const FEW: usize = 3;
    let x = fitted.numbers(column);
    let square = map(x, |x| x * x);
    if !varies(&square) {
        return Vec::new();
    }
    let mut variants = Vec::new();
    if !fitted.is_temperature(column) && correlation(&square, x).abs() <= 0.995 {
        variants.push(form("square alone", vec![fitted.own(column).square()]));
    }
    if levels_of(x).len() > FEW {
        let own = fitted.centred(column);
        variants.push(form("with a linear part", vec![own.square(), own]));
    }
    variants
}

/// The cube about the middle, with a linear part, which moves its turning points, and with the square, which moves its middle.
fn cubes(fitted: &FittedModel<'_>, column: usize) -> Vec<Variation> {
    /// Through so many values these go anyhow.
    const FEW: usize = 4;
    if levels_of(fitted.numbers(column)).len() <= FEW {
        return Vec::new();
    }
    let own = fitted.centred(column);
    let (square, cube) = (own.square(), own.cube());
    vec![
        form("with a linear part", vec![cube.clone(), own.clone()]),
        form("with a square and a linear part", vec![cube, square, own]),
    ]
}

/// The modifier without a lag, and with each of a series of time constants where it has to get through
/// something first.
fn delayed(fitted: &FittedModel<'_>, column: usize, node: Node, own: &Modifier) -> Vec<Variation> {
    let mut variants = vec![form("", vec![own.clone()])];
    if fitted.is_timed() && !fitted.is_immediate(column) {
        let course = |tau: f64| late(&fitted.clock.values, &own.values, &[], tau);
        let term = |tau: f64| Term::new(node, Modifier::unnamed(course(tau)));
        let inner = own.text.strip_prefix('(');
        let inner = inner.and_then(|text| text.strip_suffix(')'));
        let inner = inner.unwrap_or(&own.text);
        let scales = sharpened(fitted, time_constants(fitted), &term);
        variants.extend(fitted.finer.times(scales).into_iter().map(|tau| {
            let text = format!("lag({inner}, {})", fitted.duration(tau));
            let modifier = Modifier::new(course(tau), text, own.unit.clone());
            timed(fitted, &[five_digits(tau)], vec![on_output(modifier)])
        }));
    }
    variants
}

/// The modifier and its rate of change, each with a size of its own: the sensor follows before or behind
/// the instrument that shows the condition, by less than a lag can be told.
fn leading(fitted: &FittedModel<'_>, column: usize, own: &Modifier) -> Option<Variation> {
    let late = fitted.is_timed() && !fitted.is_immediate(column);
    late.then(|| {
        let both = vec![own.clone(), fitted.rate(column)];
        form("with its rate of change", both)
    })
}

/// Whether a quantity with a true zero varies by so much that its inverse is no line.
pub(super) fn spreads(fitted: &FittedModel<'_>, column: usize) -> bool {
    const FACTOR: f64 = 2.0;
    let (least, most) = range(fitted.numbers(column));
    let has_zero = fitted.case().columns[column].unit.origin.is_none();
    has_zero && least > 0.0 && most > FACTOR * least
}

/// In inverse proportion to a column, beside a model that is a line along it: what an end, a start or a friction adds weighs the
/// more the smaller it is.
pub(super) fn inverse(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    let shows = fitted.is_line(column) && spreads(fitted, column);
    shows.then(|| Cell {
        odds: HIGHER,
        ..reciprocal(fitted, column, Node::Output)
    })
}

fn reciprocal(fitted: &FittedModel<'_>, column: usize, node: Node) -> Cell {
    let label = fitted.label(column);
    let modifier = Modifier::new(
        map(fitted.numbers(column), |x| 1.0 / x),
        format!("1/{label}"),
        Unit::one().quotient(&fitted.step_unit(column)),
    );
    let form = form("", vec![modifier]);
    on_node(fitted, EffectId::Reciprocal, label, node, [form])
}

/// The scale, or the offset where that is one.
fn scale(fitted: &FittedModel<'_>) -> Node {
    match fitted.has_signal() {
        true => Node::Gain,
        false => Node::Output,
    }
}

fn of_pair(fitted: &FittedModel<'_>, x: usize, z: usize) -> Vec<Cell> {
    let mut cells = Vec::new();
    if meet(fitted, x, z) {
        let product = form("", vec![fitted.centred_product(x, z)]);
        let (id, node) = (EffectId::Interaction, Node::Output);
        cells.push(Cell {
            odds: HIGHER,
            ..pair(fitted, id, [x, z], node, [product])
        });
    }
    let (of_x, of_z) = (fitted.numbers(x), fitted.numbers(z));
    let gas = [x, z].iter().any(|c| fitted.is_like(*c, "Pa"));
    let size = [x, z].iter().any(|c| fitted.is_like(*c, "m"));
    let positive = range(of_x).0 > 0.0 && range(of_z).0 > 0.0;
    if positive && (gas && size || spreads(fitted, x) && spreads(fitted, z)) {
        let inverse = Modifier::new(
            map2(of_x, of_z, |x, z| 1.0 / (x * z)),
            format!("(1/({}*{}))", fitted.label(x), fitted.label(z)),
            Unit::one().quotient(&fitted.step_unit(x).product(&fitted.step_unit(z))),
        );
        let square = inverse.square();
        let id = match gas && size {
            true => EffectId::MeanFreePath,
            false => EffectId::ReciprocalProduct,
        };
        // Large corrections are curved.
        let curved = form("with its square", vec![inverse.clone(), square]);
        let forms = [form("", vec![inverse]), curved];
        cells.push(pair(fitted, id, [x, z], scale(fitted), forms));
    }
    cells
}

/// In proportion to the condition, not to what it differs from its middle: where the model holds exactly without it, a height above
/// the scale or a time of waiting.
fn about_zero(fitted: &FittedModel<'_>, column: usize, node: Node) -> Option<Variation> {
    let constant = Term::new(node, Modifier::number(vec![1.0; fitted.rows()], "1"));
    let is_exact = fitted.leaves(&constant);
    let own = || form("about zero", vec![fitted.own(column)]);
    (is_exact && zero_near(fitted, column)).then(own)
}

/// Whether the product of two conditions is likely to mean something: one of them is applied, or both are
/// of the air.
fn meet(fitted: &FittedModel<'_>, x: usize, z: usize) -> bool {
    let applied = |c: usize| fitted.case().columns[c].role == Role::Stimulus;
    let of_air = |c: usize| fitted.is_temperature(c) || is_of_air(fitted, c);
    applied(x) || applied(z) || of_air(x) && of_air(z)
}

/// Loss along the stem of a probe, for each column that may be the depth of immersion.
pub(super) fn stems(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let depths = fitted.numeric().into_iter();
    depths.flat_map(|column| stem(fitted, column)).collect()
}

/// Loss along the stem of a probe, which dies away with the depth of immersion: in proportion to the signal, or of a thermometer to
/// how far it is from a temperature of its surroundings.
fn stem(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let x = fitted.numbers(column);
    let (least, most) = range(x);
    let length = fitted.is_like(column, "m") && least >= 0.0 && levels_of(x).len() >= 3;
    if fitted.in_model(column) || !length || !fitted.has_signal() {
        return Vec::new();
    }
    let (id, name, unit) = (
        EffectId::Immersion,
        fitted.label(column),
        fitted.unit(column),
    );
    let (along, began) = (map(x, |x| x - least), fitted.less(column, least));
    let loss = |depth: f64| decay(&along, &began, depth, &fitted.figure(column, depth));
    let label = |depth: f64| format!("over {} {unit}", figure(depth));
    let depths = [0.1, 0.2, 0.4, 0.8].map(|part| five_digits(part * (most - least)));
    let of_signal = |depth: f64| Term::new(Node::Gain, loss(depth));
    let sharp = sharpened(fitted, depths.to_vec(), &of_signal).into_iter();
    let of_signal = sharp.map(five_digits);
    let of_signal = of_signal.map(|depth| form(label(depth), vec![loss(depth)]));
    let mut cells = vec![on_node(fitted, id, name, Node::Gain, of_signal)];
    let temperatures = || (fitted.numeric().into_iter()).filter(|c| fitted.is_temperature(*c));
    let surroundings: Vec<usize> = temperatures().filter(|c| !fitted.in_model(*c)).collect();
    for probe in temperatures().filter(|c| fitted.in_model(*c)) {
        let forms = surroundings.iter().flat_map(|around| {
            let apart = fitted.apart(probe, *around);
            let lost = |depth: f64| apart.times(&loss(depth));
            let of_probe = |depth: f64| Term::new(Node::Column(probe), lost(depth));
            let sharp = sharpened(fitted, depths.to_vec(), &of_probe).into_iter();
            let with = fitted.label(*around);
            let own = |depth: f64| {
                form(
                    format!("{}, towards {with}", label(depth)),
                    vec![lost(depth)],
                )
            };
            sharp.map(five_digits).map(own).collect::<Vec<Variation>>()
        });
        let forms: Vec<Variation> = forms.collect();
        if !forms.is_empty() {
            cells.push(on_node(fitted, id, name, Node::Column(probe), forms));
        }
    }
    cells
}
