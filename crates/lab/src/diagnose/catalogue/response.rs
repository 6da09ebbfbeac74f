//! How the response to the stimuli may differ from the declared one: powers, modulus, limits, cross terms,
//! lag.

use super::building::{on_node, on_output, on_outputs, time_constants, words};
use super::ground::{Ground, Node};
use super::modifiers::{
    creeps, delayed, figure, five_digits, grid, late, levels_of, map, map2, mean, range, rate,
};
use super::powers::Power;
use super::sharp::{best_pair, sharpened};
use super::{Cell, EffectId, Modifier, Term, Variation, Words};
use crate::diagnose::case::Role;
use crate::diagnose::evidence::Place;

/// Cells of the columns that the model uses.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let used: Vec<usize> = ground
        .numeric()
        .into_iter()
        .filter(|c| ground.in_model(*c))
        .collect();
    let implicit = (0..ground.case().responses.len()).all(|r| ground.is_implicit(r));
    if implicit {
        return super::implicit::cells(ground, &used);
    }
    // A factor of a product is not what an axis takes in; it may act on the offset all the same.
    let (direct, factors): (Vec<usize>, Vec<usize>) =
        used.iter().partition(|column| ground.is_direct(**column));
    let mut cells = aside(ground, &factors);
    cells.extend(factors.iter().flat_map(|c| bends(ground, *c)));
    for column in &direct {
        cells.extend(powers(ground, *column));
        cells.extend(exponent(ground, *column));
        cells.extend(super::limits::cells(ground, *column));
        cells.extend(dynamics(ground, *column));
        cells.extend(super::history::cells(ground, *column));
    }
    for (at, x) in direct.iter().enumerate() {
        for z in &direct[at + 1..] {
            cells.push(interaction(ground, *x, *z));
        }
    }
    cells
}

/// What factors of products do by themselves: those of one unit are components of one vector, such as
/// the direction of gravity in a gyroscope.
fn aside(ground: &Ground<'_>, factors: &[usize]) -> Vec<Cell> {
    let mut vectors: Vec<Vec<usize>> = Vec::new();
    let unit = |column: usize| &ground.case().columns[column].unit;
    // The angle of a mount turns other things; by itself it does nothing.
    for column in factors.iter().filter(|c| !ground.is_angle(**c)) {
        match vectors.iter_mut().find(|v| unit(v[0]) == unit(*column)) {
            Some(vector) => vector.push(*column),
            None => vectors.push(vec![*column]),
        }
    }
    let of_vector = |vector: &Vec<usize>| {
        let names: Vec<&str> = vector.iter().map(|c| name(ground, *c)).collect();
        let names = names.join(", ");
        let each = vector.iter().map(|column| ground.centred(*column));
        let id = match ground.case().columns[vector[0]].role {
            _ if ground.is_temperature(vector[0]) => EffectId::TempcoBias,
            Role::Stimulus => EffectId::CrossSensitivity,
            _ => EffectId::Sensitivity,
        };
        let variants = vec![(String::new(), each.collect())];
        on_outputs(ground, id, words(ground, &names), &names, variants)
    };
    vectors.iter().map(of_vector).collect()
}

/// Another exponent, where the model is a power of a quantity other than the first and has no zero besides:
/// the flow through an orifice, light at a distance, radiation of a hot body.
fn exponent(ground: &Ground<'_>, column: usize) -> Option<Cell> {
    /// Exponents so near to one another are the same.
    const SAME: f64 = 1e-3;
    /// Below it a quantity only corrects the output.
    const WEAK: f64 = 0.1;
    let x = ground.numbers(column);
    let one_output = ground.case().responses.len() == 1 && ground.constant_terms(0).is_empty();
    if !one_output || range(x).0 <= 0.0 {
        return None;
    }
    let slope = ground.slope(Node::Column(column), 0);
    let powers: Vec<f64> = (x.iter().zip(&slope).zip(ground.signal(0)))
        .map(|((x, slope), y)| x * slope / y)
        .collect();
    let (least, most) = range(&powers);
    let steady = (most - least).is_finite() && most - least <= SAME;
    if !steady || (least - 1.0).abs() < SAME || least.abs() < WEAK {
        return None;
    }
    let label = name(ground, column);
    let middle = five_digits(libm::exp(mean(&map(x, libm::log))));
    let modifier = map(x, |x| libm::log(x / middle));
    let text = format!("ln({label}/({}))", ground.figure(column, middle));
    let variants = vec![(String::new(), vec![Modifier::number(modifier, text)])];
    Some(on_node(
        ground,
        EffectId::Exponent,
        words(ground, label),
        label,
        Node::Gain,
        variants,
    ))
}

/// Curvature of the response to a factor of a product of quantities of different kinds, such as current times
/// field: each of them may bend by itself. Direction cosines and switches do not.
fn bends(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    /// Through fewer values a cube goes anyhow.
    const VALUES: usize = 5;
    let columns = &ground.case().columns;
    let used = |c: &usize| ground.in_model(*c) && columns[*c].role == Role::Stimulus;
    let has_cosines = (0..columns.len())
        .filter(used)
        .any(|c| columns[c].unit.is_one());
    let x = ground.numbers(column);
    let one_output = ground.case().responses.len() == 1;
    if has_cosines || !one_output || ground.is_angle(column) || levels_of(x).len() < VALUES {
        return Vec::new();
    }
    let size = five_digits(super::modifiers::largest(x));
    let label = name(ground, column);
    let power = |id: EffectId, exponent: i32| {
        let modifier = map(x, |x| x * (x / size).powi(exponent - 1));
        let shown = ground.figure(column, size);
        let text = match exponent {
            2 => format!("{label}*({label}/({shown}))"),
            _ => format!("{label}*({label}/({shown}))^{}", exponent - 1),
        };
        let modifier = Modifier::new(modifier, text, ground.step_unit(column));
        let variants = vec![(String::new(), vec![modifier])];
        let node = Node::Column(column);
        on_node(ground, id, words(ground, label), label, node, variants)
    };
    vec![power(EffectId::Quadratic, 2), power(EffectId::Cubic, 3)]
}

fn name<'g>(ground: &'g Ground<'_>, column: usize) -> &'g str {
    ground.label(column)
}

fn powers(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let second = if ground.is_temperature(column) {
        EffectId::TempcoQuadratic
    } else {
        EffectId::Quadratic
    };
    let [square, cube] = super::powers::of(ground, column);
    let mut cells = vec![
        power(ground, column, second, square),
        power(ground, column, EffectId::Cubic, cube),
    ];
    let (x, label) = (ground.numbers(column), name(ground, column));
    if ground.passes_zero(column) {
        let text = format!("abs({label})");
        let modulus = Modifier::new(map(x, f64::abs), text, ground.step_unit(column));
        let variants = vec![(String::new(), vec![modulus])];
        let words = words(ground, label);
        cells.push(on_outputs(
            ground,
            EffectId::Asymmetry,
            words,
            label,
            variants,
        ));
    } else if !ground.is_temperature(column) {
        cells[0].variants.extend(levelling(ground, column));
    }
    cells
}

fn power(ground: &Ground<'_>, column: usize, id: EffectId, power: Power) -> Cell {
    let label = name(ground, column);
    let variants = vec![(String::new(), vec![power.searched])];
    let mut cell = on_outputs(ground, id, words(ground, label), label, variants);
    for variation in &mut cell.variants {
        let terms = std::mem::take(&mut variation.terms).into_iter();
        variation.terms = terms
            .map(|term| term.written_as(power.written.clone()))
            .collect();
    }
    cell
}

/// A square that levels off, as counting losses of a dead time do, and detectors near their limit.
fn levelling(ground: &Ground<'_>, column: usize) -> Vec<Variation> {
    /// Where the loss is a half, in units of the largest value.
    const HALF: [f64; 3] = [0.5, 1.0, 3.0];
    let (x, label) = (ground.numbers(column), name(ground, column));
    let most = super::modifiers::largest(x);
    let of = |part: f64| {
        let half = five_digits(part * most);
        let modifier = map(x, |x| x * x / (1.0 + x.abs() / half));
        let shown = ground.figure(column, half);
        let text = format!("{label}^2/(1 + abs({label})/({shown}))");
        let unit = ground.step_unit(column);
        let modifier = Modifier::new(modifier, text, unit.product(&unit));
        Variation::one(
            format!("levelling off, half at {shown}"),
            on_output(modifier),
        )
    };
    if x.iter().all(|x| *x >= 0.0) && least_share(x) < 0.3 {
        HALF.map(of).into()
    } else {
        Vec::new()
    }
}

/// The smallest value as a share of the largest.
fn least_share(x: &[f64]) -> f64 {
    let (least, most) = range(x);
    least / most
}

fn dynamics(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    /// How many times slower the slower of two bodies is.
    const APART: [f64; 2] = [4.0, 12.0];
    if !ground.is_timed() {
        return Vec::new();
    }
    let slowest = ground.clock.span();
    let (x, label) = (ground.numbers(column), name(ground, column));
    let t = &ground.clock.values;
    let unit = ground.time_unit();
    let node = Node::Column(column);
    let id = if ground.is_temperature(column) {
        EffectId::TemperatureLag
    } else {
        EffectId::Lag
    };
    let lacks = |tau: f64| {
        let modifier = map2(&late(t, x, tau), x, |late, x| late - x);
        let text = format!("(lag({label}, {tau} {unit}) - {label})", tau = figure(tau));
        Term::new(
            node,
            Modifier::new(modifier, text, ground.step_unit(column)),
        )
    };
    let scales = sharpened(ground, time_constants(ground), &lacks);
    let singles = ground.finer.times(scales.clone());
    let single = singles.iter().map(|tau| {
        let label = format!("τ = {} {unit}", figure(*tau));
        Variation::one(label, lacks(*tau)).shaped("τ", *tau, &unit)
    });
    // Two bodies, one in the other.
    let double = scales.iter().step_by(2).flat_map(|tau| {
        let slower = APART.map(|times| times * tau);
        let slower = slower.into_iter().filter(|slow| *slow <= slowest);
        slower.map(|slow| {
            let label = format!("τ = {} and {} {unit}", figure(*tau), figure(slow));
            Variation::of(label, vec![lacks(*tau), lacks(slow)])
        })
    });
    let free = best_pair(ground, &scales, &lacks).map(|(quick, slow)| {
        let label = format!("τ = {} and {} {unit}", figure(quick), figure(slow));
        Variation::of(label, vec![lacks(quick), lacks(slow)])
    });
    // What the recording begins with was on its way already.
    let began = t.first().copied().unwrap_or(0.0);
    let unbalanced = scales.iter().filter(|_| creeps(x)).map(|tau| {
        let shown = figure(*tau);
        let start = map(t, |t| libm::exp(-(t - began) / tau));
        let since = ground.time_less(began);
        let text = format!("exp(-{since}/({shown} {unit}))");
        let start = Term::new(node, Modifier::number(start, text));
        let label = format!("τ = {shown} {unit}, not in balance at the start");
        Variation::of(label, vec![lacks(*tau), start]).shaped("τ", *tau, &unit)
    });
    let variants = single.chain(double).chain(free).chain(unbalanced);
    let lagged = Cell::new(
        id,
        words(ground, label),
        Place {
            node: label.to_owned(),
            along: "time".into(),
        },
        variants.collect(),
    );
    let instant = Variation::one("", Term::new(node, ground.rate(column)));
    let (id, delays) = if ground.is_temperature(column) {
        (EffectId::TemperatureRate, Vec::new())
    } else {
        (EffectId::TimingSkew, delays(ground, column))
    };
    let skew = Cell {
        effect: id.entry(),
        variants: [instant].into_iter().chain(delays).collect(),
        ..lagged.clone()
    };
    if creeps(x) {
        vec![lagged, skew]
    } else {
        vec![lagged]
    }
}

/// Delays of more than a part of the interval, in which a course bends: the course as it was then, and its
/// rate for what the delay differs from that.
fn delays(ground: &Ground<'_>, column: usize) -> Vec<Variation> {
    let (x, label) = (ground.numbers(column), name(ground, column));
    let t = &ground.clock.values;
    let unit = ground.time_unit();
    let longest = (20.0 * ground.clock.interval()).min(ground.clock.span() / 20.0);
    let sizes = grid(ground.clock.interval(), longest, 1.6, 8);
    let both = sizes.iter().flat_map(|size| [*size, -size]);
    let variants = both.map(|delay| {
        let then = delayed(t, x, delay);
        let shown = format!("{label}(t - {} {unit})", figure(delay));
        let moved = map2(&then, x, |then, now| then - now);
        let (own, per_time) = (ground.step_unit(column), ground.rate(column).unit);
        let moved = Modifier::new(moved, format!("({shown} - {label})"), own);
        let rate = Modifier::new(rate(t, &then), format!("d{shown}/dt"), per_time);
        let terms = [moved, rate].map(|m| Term::new(Node::Column(column), m));
        let terms = terms.into();
        Variation::of(format!("by about {} {unit}", figure(delay)), terms)
    });
    variants.collect()
}

fn interaction(ground: &Ground<'_>, x: usize, z: usize) -> Cell {
    let variants = vec![(String::new(), vec![ground.centred_product(x, z)])];
    let (x, z) = (name(ground, x).to_owned(), name(ground, z).to_owned());
    let words = Words {
        z: z.clone(),
        ..words(ground, &x)
    };
    on_outputs(
        ground,
        EffectId::Interaction,
        words,
        &format!("{x}, {z}"),
        variants,
    )
}
