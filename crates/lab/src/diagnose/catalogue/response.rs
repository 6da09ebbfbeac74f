//! How the response to the stimuli may differ from the declared one: powers, modulus, limits, cross terms,
//! lag.

use super::building::{
    cell, course, decay, form, on_node, on_output, pair, time_constants_of_input, timed,
};
use super::conditions::{inverse, on_offset, spreads};
use super::course::Course;
use super::delays;
use super::fitted::{FittedModel, Node};
use super::modifiers::{creeps, figure, five_digits, largest, levels_of, map, map2, mean, range};
use super::norm::Norm;
use super::sharp::{beats, best_pair, sharpened, sharpened_together, size_of};
use super::{
    Cell, EffectId, Modifier, Term, Variation, excursions, exponentials, history, limits, ringing,
    slewing,
};
use crate::diagnose::case::Role;
use crate::diagnose::parallel::side_by_side;
use gumption_core::quantity::to_digits;

/// What makes the cells of a column that the model uses, of one kind each.
const ALONG: [fn(&FittedModel<'_>, usize) -> Vec<Cell>; 11] = [
    powers,
    |fitted, column| Vec::from_iter(background(fitted, column)),
    |fitted, column| Vec::from_iter(exponent(fitted, column)),
    |fitted, column| Vec::from_iter(exponentials::cell(fitted, column)),
    |fitted, column| Vec::from_iter(excursions::cell(fitted, column)),
    |fitted, column| Vec::from_iter(inverse(fitted, column)),
    limits::cells,
    dynamics,
    |fitted, column| Vec::from_iter(ringing::ringing(fitted, column)),
    |fitted, column| Vec::from_iter(slewing::slewing(fitted, column)),
    history::cells,
];

/// Cells of the columns that the model uses.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut used = fitted.numeric();
    used.retain(|column| fitted.in_model(*column));
    let implicit = (0..fitted.case().responses.len()).all(|r| fitted.is_implicit(r));
    if implicit || Norm::of(fitted).is_some() {
        return super::axes::cells(fitted, &used);
    }
    // A factor of a product is not what an axis takes in; it may act on the offset all the same.
    let (direct, factors): (Vec<usize>, Vec<usize>) =
        used.iter().partition(|column| fitted.is_direct(**column));
    let mut cells = aside(fitted, &factors);
    cells.extend(factors.iter().flat_map(|c| bends(fitted, *c)));
    let kinds = ALONG.len();
    let along = side_by_side(kinds * direct.len(), |at| {
        ALONG[at % kinds](fitted, direct[at / kinds])
    });
    cells.extend(along.into_iter().flatten());
    cells.extend(limits::of_outputs(fitted, &direct));
    for (at, x) in direct.iter().enumerate() {
        for z in &direct[at + 1..] {
            cells.push(interaction(fitted, *x, *z));
        }
    }
    cells
}

/// What factors of products do by themselves: those of one unit are components of one vector, such as
/// the direction of gravity in a gyroscope.
fn aside(fitted: &FittedModel<'_>, factors: &[usize]) -> Vec<Cell> {
    let mut vectors: Vec<Vec<usize>> = Vec::new();
    let unit = |column: usize| &fitted.case().columns[column].unit;
    // The angle of a mount turns other things; by itself it does nothing.
    for column in factors.iter().filter(|c| !fitted.is_angle(**c)) {
        match vectors.iter_mut().find(|v| unit(v[0]) == unit(*column)) {
            Some(vector) => vector.push(*column),
            None => vectors.push(vec![*column]),
        }
    }
    let of_vector = |vector: &Vec<usize>| {
        let each = vector.iter().map(|column| fitted.centred(*column));
        let id = on_offset(fitted, vector[0]);
        let form = form("", each.collect());
        on_node(fitted, id, &fitted.names(vector), Node::Output, [form])
    };
    vectors.iter().map(of_vector).collect()
}

/// A line along a column along which the model is none, through zero or not. Of a product it would be the zero of the other factor.
fn background(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    let is_timed = fitted.clock.column == Some(column);
    if is_timed || fitted.is_angle(column) || fitted.is_line(column) {
        return None;
    }
    let line = || fitted.own(column);
    let level = Modifier::number(vec![1.0; fitted.rows()], "1");
    let forms = [
        form("", vec![line()]),
        form("with a constant", vec![line(), level]),
    ];
    let (label, node) = (fitted.label(column), Node::Output);
    let shows = fitted.leaves(&on_output(line()));
    shows.then(|| on_node(fitted, EffectId::Background, label, node, forms))
}

/// Another exponent, where the model has the quantity under one power alone: the flow through an orifice, light at a distance, the
/// heat that a flow takes from a wire; the first power where the model is in proportion to a quantity that spreads, as the rate of
/// a viscometer does.
fn exponent(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    /// Below it a quantity only corrects the output.
    const WEAK: f64 = 0.1;
    let x = fitted.numbers(column);
    let case = fitted.case();
    let one_output = case.responses.len() == 1;
    if !one_output || range(x).0 < 0.0 || case.columns[column].unit.is_point() {
        return None;
    }
    let symbol = case.parameters.len() + column;
    let (exponent, whole) = case.equations.exponent_of(symbol, 0)?;
    let is_line = exponent == 1.0 && !(whole && spreads(fitted, column));
    if is_line || exponent.abs() < WEAK {
        return None;
    }
    let above = x.iter().filter(|x| **x > 0.0).map(|x| libm::log(*x));
    let middle = five_digits(libm::exp(mean(&above.collect::<Vec<f64>>())));
    let node = Node::Column(column);
    let by = |change: f64| raised(fitted, column, middle, [exponent, change]);
    // Large changes are no multiples of a small one: that which is found, to two digits.
    let two_digits = |x: f64| to_digits(x, 2);
    let found = |change: f64| size_of(fitted, &Term::new(node, by(change))).map(two_digits);
    let change = found(0.0).map_or(0.0, |first| found(first).unwrap_or(first));
    let (id, form) = (EffectId::Exponent, form("", vec![by(change)]));
    let mut cell = on_node(fitted, id, fitted.label(column), node, [form]);
    // Zero has no logarithm, by which small changes go.
    if range(x).0 > 0.0 {
        let exactly = with_exponent(fitted, column, middle, exponent);
        let terms = cell.variants.iter_mut().flat_map(|form| &mut form.terms);
        terms.for_each(|term| *term = term.clone().exactly(exactly.clone()));
    }
    Some(cell)
}

/// What [`raised`] takes in proportion to the change of the exponent, as a formula of it.
fn with_exponent(fitted: &FittedModel<'_>, column: usize, middle: f64, exponent: f64) -> String {
    let label = fitted.label(column);
    let unit = &fitted.case().columns[column].unit;
    let part = match unit.is_one() {
        true => format!("{label}/({middle})"),
        false => format!("{label}/({middle} '{}')", unit.symbol),
    };
    let over = match exponent < 0.0 {
        true => format!("({exponent})"),
        false => exponent.to_string(),
    };
    format!("{label}*(({part})^({{}}/{over}) - 1)")
}

/// What a quantity would be for a power of it to have an exponent that is changed by so much, less what it is, for each unit of the
/// change; for no change the limit.
fn raised(
    fitted: &FittedModel<'_>,
    column: usize,
    middle: f64,
    [exponent, change]: [f64; 2],
) -> Modifier {
    let label = fitted.label(column);
    let part = format!("({label}/({}))", fitted.figure(column, middle));
    let power = five_digits(change / exponent);
    let text = match change == 0.0 {
        true => format!("{label}*ln{part}/{exponent}"),
        false => format!("{label}*({part}^({}) - 1)/({change})", figure(power)),
    };
    let by_logarithm = |logarithm: f64| match change == 0.0 {
        true => logarithm / exponent,
        false => libm::expm1(power * logarithm) / change,
    };
    fitted.by(column, text, |x| match x > 0.0 {
        true => x * by_logarithm(libm::log(x / middle)),
        false => 0.0,
    })
}

/// Curvature of the response to a factor of a product of quantities of different kinds, such as current times
/// field: each of them may bend by itself. Direction cosines and switches do not.
fn bends(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    /// Through fewer values a cube goes anyhow.
    const VALUES: usize = 5;
    let has_cosines =
        (fitted.used(Role::Stimulus)).any(|column| fitted.case().columns[column].unit.is_one());
    let x = fitted.numbers(column);
    let one_output = fitted.case().responses.len() == 1;
    if has_cosines || !one_output || fitted.is_angle(column) || levels_of(x).len() < VALUES {
        return Vec::new();
    }
    let size = five_digits(largest(x));
    let label = fitted.label(column);
    let power = |id: EffectId, exponent: i32| {
        let shown = fitted.figure(column, size);
        let text = match exponent {
            2 => format!("{label}*({label}/({shown}))"),
            _ => format!("{label}*({label}/({shown}))^{}", exponent - 1),
        };
        let bent = fitted.by(column, text, |x| x * (x / size).powi(exponent - 1));
        on_node(
            fitted,
            id,
            label,
            Node::Column(column),
            [form("", vec![bent])],
        )
    };
    vec![power(EffectId::Quadratic, 2), power(EffectId::Cubic, 3)]
}

fn powers(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let second = match fitted.is_temperature(column) {
        true => EffectId::TempcoQuadratic,
        false => EffectId::Quadratic,
    };
    let label = fitted.label(column);
    let both = [second, EffectId::Cubic].into_iter();
    let powers = both
        .zip(super::powers::of(fitted, column))
        .map(|(id, forms)| on_node(fitted, id, label, Node::Output, forms));
    let mut cells: Vec<Cell> = powers.collect();
    let bends_by = |cell: &Cell| {
        let mut terms = cell.variants.iter().flat_map(|variant| &variant.terms);
        terms.any(|term| fitted.leaves(term))
    };
    if fitted.passes_zero(column) {
        let form = form(
            "",
            vec![fitted.by(column, format!("abs({label})"), f64::abs)],
        );
        let id = EffectId::Asymmetry;
        cells.push(on_node(fitted, id, label, Node::Output, [form]));
    } else if !fitted.is_temperature(column) && bends_by(&cells[0]) {
        cells[0].variants.extend(levelling(fitted, column));
    }
    cells
}

/// A square that levels off, as counting losses of a dead time do, and detectors near their limit.
fn levelling(fitted: &FittedModel<'_>, column: usize) -> Vec<Variation> {
    /// Where the loss is a half, in units of the largest value.
    const HALF: [f64; 3] = [0.5, 1.0, 3.0];
    /// From there on it is a square, unless the recording says that it is none.
    const FAR: f64 = 10.0;
    /// Values that never come down to this share of the largest show no more than a square.
    const LOW: f64 = 0.3;
    let (x, label) = (fitted.numbers(column), fitted.label(column));
    let most = largest(x);
    let term = |half: f64| {
        let modifier = map(x, |x| x * x / (1.0 + x.abs() / half));
        let shown = fitted.figure(column, half);
        let text = format!("{label}^2/(1 + abs({label})/({shown}))");
        let unit = fitted.step_unit(column);
        on_output(Modifier::new(modifier, text, unit.product(&unit)))
    };
    let (least, greatest) = range(x);
    if least < 0.0 || least / greatest >= LOW {
        return Vec::new();
    }
    let square = on_output(fitted.by(column, "", |x| x * x));
    let far = beats(fitted, &term(FAR * most), &[square]).then_some(FAR);
    let halves = HALF.into_iter().chain(far).map(|part| part * most);
    let halves = sharpened(fitted, halves.collect(), &term);
    let unit = fitted.unit(column);
    let halves = fitted.finer.times(halves).into_iter().map(five_digits);
    let variant = |half: f64| {
        let label = format!("levelling off, half at {} {unit}", figure(half));
        Variation::one(label, term(half)).shaped("x½", half, &unit)
    };
    halves.map(variant).collect()
}

fn dynamics(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    /// How many times slower the slower of two bodies is.
    const APART: [f64; 2] = [4.0, 12.0];
    if !fitted.is_timed() {
        return Vec::new();
    }
    let slowest = fitted.clock.span();
    let (x, label) = (fitted.numbers(column), fitted.label(column));
    let t = &fitted.clock.values;
    let node = Node::Column(column);
    let id = match fitted.is_temperature(column) {
        true => EffectId::TemperatureLag,
        false => EffectId::Lag,
    };
    let lacking = |course: Course, tau: f64| {
        let modifier = map2(&course.late(t, x, &[], tau), x, |late, x| late - x);
        let text = format!("(lag({label}, {}) - {label})", fitted.duration(tau));
        let modifier = Modifier::new(modifier, text, fitted.step_unit(column));
        Term::new(node, modifier)
    };
    let course = course(fitted, x, &lacking);
    let lacks = |tau: f64| lacking(course, tau);
    let scales = sharpened(fitted, time_constants_of_input(fitted), &lacks);
    let singles = fitted.finer.times(scales.clone());
    let single = singles
        .iter()
        .map(|tau| timed(fitted, &[*tau], vec![lacks(*tau)]));
    let both =
        |quick: f64, slow: f64| timed(fitted, &[quick, slow], vec![lacks(quick), lacks(slow)]);
    // Two bodies, one in the other.
    let double = scales.iter().step_by(2).flat_map(|tau| {
        let slower = APART.map(|times| times * tau);
        let slower = slower.into_iter().filter(|slow| *slow <= slowest);
        slower.map(|slow| both(*tau, slow))
    });
    let free = best_pair(fitted, &scales, &lacks).map(|(quick, slow)| both(quick, slow));
    // What the recording begins with was on its way already.
    let began = t.first().copied().unwrap_or(0.0);
    let since = map(t, |t| t - began);
    let with_start = |tau: f64| {
        let shown = fitted.duration(tau);
        let start = decay(&since, &fitted.time_less(began), tau, &shown);
        vec![lacks(tau), Term::new(node, start)]
    };
    let starting = sharpened_together(fitted, time_constants_of_input(fitted), &with_start);
    let starting = fitted.finer.times(starting).into_iter();
    let unbalanced = starting.map(|tau| {
        let mut form = timed(fitted, &[tau], with_start(tau));
        form.label += ", not in balance at the start";
        form
    });
    let variants = single.chain(double).chain(free).chain(unbalanced);
    let in_time = |id: EffectId, variants: Vec<Variation>| {
        let mut cell = cell(fitted, id, node, label, variants);
        "time".clone_into(&mut cell.place.along);
        cell
    };
    let mut cells = vec![in_time(id, variants.collect())];
    if !creeps(x) {
        return cells;
    }
    let (id, variants) = if fitted.is_temperature(column) {
        let rate = Variation::one("", Term::new(node, fitted.rate(column)));
        (EffectId::TemperatureRate, vec![rate])
    } else {
        (EffectId::TimingSkew, delays::of(fitted, column))
    };
    cells.push(in_time(id, variants));
    cells
}

fn interaction(fitted: &FittedModel<'_>, x: usize, z: usize) -> Cell {
    let product = form("", vec![fitted.centred_product(x, z)]);
    let (id, node) = (EffectId::Interaction, Node::Output);
    pair(fitted, id, [x, z], node, [product])
}
