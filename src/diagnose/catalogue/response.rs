//! How the response to the stimuli may differ from the declared one: powers, modulus, limits, cross terms,
//! lag, history.

use super::ground::{Ground, Node, varies};
use super::modifiers::{centred, direction, figure, grid, lag, map, map2, mean, play, range, rate};
use super::{Cell, Term, Variants, Variation, Words, effect};
use crate::diagnose::case::Role;
use crate::diagnose::evidence::Place;

/// Cells of the columns that the model uses.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    let used: Vec<usize> = ground
        .numeric()
        .into_iter()
        .filter(|c| ground.in_model(*c))
        .collect();
    let implicit = (0..ground.case().responses.len()).all(|r| ground.is_implicit(r));
    if implicit {
        cells.extend(axes(ground, &used));
        return cells;
    }
    for column in &used {
        cells.extend(powers(ground, *column));
        cells.extend(limits(ground, *column));
        cells.extend(dynamics(ground, *column));
        cells.extend(history(ground, *column));
    }
    for (at, x) in used.iter().enumerate() {
        for z in &used[at + 1..] {
            cells.push(interaction(ground, *x, *z));
        }
    }
    cells
}

/// A cell on the offset of the outputs: alike on all responses, and on each of them alone.
pub(super) fn on_outputs(
    ground: &Ground<'_>,
    id: &str,
    words: Words,
    along: &str,
    variants: Variants,
) -> Cell {
    on_node(ground, id, words, along, Node::Output, variants)
}

/// A cell on a node, with scopes over the responses.
pub(super) fn on_node(
    ground: &Ground<'_>,
    id: &str,
    words: Words,
    along: &str,
    node: Node,
    variants: Variants,
) -> Cell {
    let responses = &ground.case().responses;
    let mut all = Vec::new();
    for (label, modifiers) in variants {
        let term = |response: Option<usize>| {
            let terms = modifiers.iter().map(move |(modifier, text)| Term {
                node,
                response,
                modifier: modifier.clone(),
                text: text.clone(),
            });
            terms.collect::<Vec<Term>>()
        };
        if responses.len() == 1 {
            all.push(Variation::of(label, term(None)));
            continue;
        }
        for (index, response) in responses.iter().enumerate() {
            let joined = if label.is_empty() {
                response.name.clone()
            } else {
                format!("{}, {label}", response.name)
            };
            all.push(Variation::of(joined, term(Some(index))));
        }
        let each = (0..responses.len())
            .flat_map(|index| term(Some(index)))
            .collect();
        all.push(Variation::of(label, each));
    }
    Cell {
        effect: effect(id),
        place: Place {
            node: ground.name(node),
            along: along.to_owned(),
        },
        words,
        variants: all,
        typical: None,
        description: None,
    }
}

/// Words for one column.
pub(super) fn words(ground: &Ground<'_>, x: &str) -> Words {
    Words {
        x: x.to_owned(),
        y: ground.output(),
        ..Words::default()
    }
}

fn name<'g>(ground: &'g Ground<'_>, column: usize) -> &'g str {
    &ground.case().columns[column].name
}

fn powers(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let (x, label) = (ground.numbers(column), name(ground, column));
    let zero = if crosses_zero(x) { 0.0 } else { mean(x) };
    let shift = if zero == 0.0 {
        label.to_owned()
    } else {
        format!("({label} - {zero})", zero = figure(zero))
    };
    let mut cells = Vec::new();
    let mut add = |id: &str, modifier: Vec<f64>, text: String| {
        let variants = vec![(String::new(), vec![(modifier, text)])];
        cells.push(on_outputs(
            ground,
            id,
            words(ground, label),
            label,
            variants,
        ));
    };
    let second = if ground.is_temperature(column) {
        "tempco-quadratic"
    } else {
        "quadratic"
    };
    add(
        second,
        map(x, |x| (x - zero) * (x - zero)),
        format!("{shift}^2"),
    );
    add(
        "cubic",
        map(x, |x| (x - zero) * (x - zero) * (x - zero)),
        format!("{shift}^3"),
    );
    if crosses_zero(x) {
        add("asymmetry", map(x, f64::abs), format!("abs({label})"));
        add("zero-step", map(x, sign), format!("sign({label})"));
    }
    cells
}

/// Whether numbers go well to both sides of zero.
pub(super) fn crosses_zero(x: &[f64]) -> bool {
    let (least, most) = range(x);
    least < 0.0 && most > 0.0 && (-least).min(most) > 0.1 * (-least).max(most)
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn limits(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let (x, label) = (ground.numbers(column), name(ground, column));
    let levels = levels_of(x);
    if levels.len() < 6 {
        return Vec::new();
    }
    let unit = ground.case().columns[column].unit.typeset();
    let mut cells = Vec::new();
    if crosses_zero(x) {
        let most = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let variants = [0.5, 0.6, 0.7, 0.8, 0.9].map(|share| {
            let limit = share * most;
            let modifier = map(x, |x| -(x.abs() - limit).max(0.0) * sign(x));
            let text = format!(
                "-sign({label})*max(abs({label}) - {limit}, 0)",
                limit = figure(limit)
            );
            let mut variation = Variation::one(
                format!("above {limit} {unit}", limit = figure(limit)),
                on_output(modifier, text),
            );
            variation = variation.shaped("x₀", limit, &unit);
            variation
        });
        cells.push(plain(ground, "saturation", label, variants.into()));
    }
    let (least, most) = range(x);
    let shares: Vec<f64> = (1..12).map(|step| f64::from(step) / 12.0).collect();
    let variants = shares.iter().map(|share| {
        let at = least + share * (most - least);
        let modifier = map(x, |x| (x - at).max(0.0));
        let text = format!("max({label} - {at}, 0)", at = figure(at));
        Variation::one(
            format!("at {at} {unit}", at = figure(at)),
            on_output(modifier, text),
        )
        .shaped("x₀", at, &unit)
    });
    cells.push(plain(ground, "kink", label, variants.collect()));
    cells
}

pub(super) fn on_output(modifier: Vec<f64>, text: String) -> Term {
    Term {
        node: Node::Output,
        response: None,
        modifier,
        text,
    }
}

/// A cell on the offset, alike on all responses.
pub(super) fn plain(ground: &Ground<'_>, id: &str, x: &str, variants: Vec<Variation>) -> Cell {
    Cell {
        effect: effect(id),
        words: words(ground, x),
        place: Place {
            node: ground.name(Node::Output),
            along: x.to_owned(),
        },
        variants,
        typical: None,
        description: None,
    }
}

/// Different values, ascending.
fn levels_of(x: &[f64]) -> Vec<f64> {
    let mut levels = x.to_vec();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

/// Time constants from a fraction of the interval of the blocks to a fraction of the recording.
pub(super) fn time_constants(ground: &Ground<'_>) -> Vec<f64> {
    let span = ground.clock.span();
    let blocks = ground.frame.blocks.len().max(2) as f64;
    let least = (span / blocks * 0.5).max(ground.clock.interval() * 0.5);
    grid(least, span / 3.0, 1.7, 12)
}

fn dynamics(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    if !ground.is_timed() {
        return Vec::new();
    }
    let (x, label) = (ground.numbers(column), name(ground, column));
    let t = &ground.clock.values;
    let unit = ground.time_unit();
    let node = Node::Column(column);
    let id = if ground.is_temperature(column) {
        "temperature-lag"
    } else {
        "lag"
    };
    let variants = time_constants(ground).into_iter().map(|tau| {
        let modifier = map2(&lag(t, x, tau), x, |lagged, x| lagged - x);
        let term = Term {
            node,
            response: None,
            modifier,
            text: format!("(lag({label}, {tau} {unit}) - {label})", tau = figure(tau)),
        };
        Variation::one(format!("τ = {tau} {unit}", tau = figure(tau)), term).shaped("τ", tau, &unit)
    });
    let lagged = Cell {
        effect: effect(id),
        words: words(ground, label),
        place: Place {
            node: label.to_owned(),
            along: "time".into(),
        },
        variants: variants.collect(),
        typical: None,
        description: None,
    };
    let skew = Cell {
        effect: effect(if ground.is_temperature(column) {
            "temperature-rate"
        } else {
            "timing-skew"
        }),
        variants: vec![Variation::one(
            "",
            Term {
                node,
                response: None,
                modifier: rate(t, x),
                text: format!("d{label}/dt"),
            },
        )],
        ..lagged.clone()
    };
    vec![lagged, skew]
}

fn history(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let (x, label) = (ground.numbers(column), name(ground, column));
    let way = direction(x);
    let rising = way.iter().filter(|way| **way > 0.0).count();
    let both = rising.min(way.len() - rising) * 10 >= way.len();
    if !both || !repeats(x) {
        return Vec::new();
    }
    let mut cells = vec![plain(ground, "hysteresis", label, loops(x, &way, label))];
    let (least, most) = range(x);
    let unit = ground.case().columns[column].unit.typeset();
    let step = typical_step(x);
    let widths = grid((most - least) * 1e-3, (most - least) * 0.3, 3.0, 6);
    let widths = widths
        .into_iter()
        .filter(|width| *width < 2.0 * step || step == 0.0);
    let variants = widths.map(|width| {
        let modifier = map2(&play(x, width), x, |played, x| (played - x) / width);
        let term = Term {
            node: Node::Column(column),
            response: None,
            modifier,
            text: format!(
                "(play({label}, {width}) - {label})/{width}",
                width = figure(width)
            ),
        };
        Variation::one(format!("gap {width} {unit}", width = figure(width)), term)
    });
    // A gap far below the steps is the direction alone.
    let wide: Vec<Variation> = variants.filter(|v| varies(&v.terms[0].modifier)).collect();
    if step < 0.3 * (most - least)
        && ground.case().columns[column].role == Role::Stimulus
        && !wide.is_empty()
    {
        cells.push(plain(ground, "play", label, wide));
    }
    cells
}

/// Shapes of a loop: a constant offset between both ways, a loop that is closed at both ends of the range
/// and widest between them, and the same on one of the ways only.
fn loops(x: &[f64], way: &[f64], label: &str) -> Vec<Variation> {
    let (least, most) = range(x);
    let half = (most - least) / 2.0;
    let wide = map(x, |x| (x - least) * (most - x) / (half * half));
    let shape = format!(
        "({label} - {least})*({most} - {label})/{square}",
        least = figure(least),
        most = figure(most),
        square = figure(half * half)
    );
    let direction = format!("direction({label})");
    let on_one = |sign: f64| map2(&wide, way, |wide, way| wide * (1.0 + sign * way) / 2.0);
    [
        ("", way.to_vec(), direction.clone()),
        (
            "widest in the middle",
            map2(&wide, way, |wide, way| wide * way),
            format!("{direction}*{shape}"),
        ),
        (
            "on rising values only, widest in the middle",
            on_one(1.0),
            format!("[rising]*{shape}"),
        ),
        (
            "on falling values only, widest in the middle",
            on_one(-1.0),
            format!("[falling]*{shape}"),
        ),
    ]
    .into_iter()
    .map(|(variant, modifier, text)| Variation::one(variant, on_output(modifier, text)))
    .collect()
}

/// Whether values come again on the way back, roughly.
fn repeats(x: &[f64]) -> bool {
    direction(x)
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .count()
        > 0
}

fn typical_step(x: &[f64]) -> f64 {
    let mut steps: Vec<f64> = x
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .filter(|step| *step > 0.0)
        .collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}

fn interaction(ground: &Ground<'_>, x: usize, z: usize) -> Cell {
    let modifier = map2(
        &centred(ground.numbers(x)),
        &centred(ground.numbers(z)),
        |x, z| x * z,
    );
    let (x, z) = (name(ground, x).to_owned(), name(ground, z).to_owned());
    let text = format!("({x} - mean)*({z} - mean)");
    let variants = vec![(String::new(), vec![(modifier, text)])];
    let words = Words {
        z: z.clone(),
        ..words(ground, &x)
    };
    on_outputs(ground, "interaction", words, &format!("{x}, {z}"), variants)
}

/// Models that hold a constant against several columns, such as |a| = g: disturbances of each column.
fn axes(ground: &Ground<'_>, used: &[usize]) -> Vec<Cell> {
    let term = |column: usize, modifier: Vec<f64>, text: String| Term {
        node: Node::Column(column),
        response: None,
        modifier,
        text,
    };
    let cell = |id: &str, variants: Vec<Variation>| {
        let names: Vec<&str> = used.iter().map(|c| name(ground, *c)).collect();
        let joined = names.join(", ");
        Cell {
            effect: effect(id),
            words: Words {
                p: joined.clone(),
                ..words(ground, &joined)
            },
            place: Place {
                node: "axes".into(),
                along: joined,
            },
            variants,
            typical: None,
            description: None,
        }
    };
    let mut cells = Vec::new();
    let mut pairs = Vec::new();
    for (at, x) in used.iter().enumerate() {
        for z in &used[at + 1..] {
            let other = centred(ground.numbers(*z));
            let text = format!("({} - mean)", name(ground, *z));
            pairs.push((
                format!("{} with {}", name(ground, *x), name(ground, *z)),
                term(*x, other, text),
            ));
        }
    }
    cells.push(cell("cross-axis", singles_and_all(pairs)));
    type Law = fn(f64) -> f64;
    let laws: [(&str, &str, Law); 3] = [
        ("axis-quadratic", "^2", |x| x * x),
        ("axis-cubic", "^3", |x| x * x * x),
        ("axis-asymmetry", " as modulus", f64::abs),
    ];
    for (id, sign, law) in laws {
        let own = used.iter().map(|column| {
            let centre = mean_of_range(ground.numbers(*column));
            let modifier = map(ground.numbers(*column), |x| law(x - centre));
            let label = name(ground, *column);
            (
                label.to_owned(),
                term(
                    *column,
                    modifier,
                    format!("({label} - {centre}){sign}", centre = figure(centre)),
                ),
            )
        });
        cells.push(cell(id, singles_and_all(own.collect())));
    }
    cells
}

/// The middle of the range, where a sensor that turned through all positions has its zero.
fn mean_of_range(x: &[f64]) -> f64 {
    let (least, most) = range(x);
    (least + most) / 2.0
}

fn singles_and_all(terms: Vec<(String, Term)>) -> Vec<Variation> {
    let all: Vec<Term> = terms.iter().map(|(_, term)| term.clone()).collect();
    let mut variants: Vec<Variation> = terms
        .into_iter()
        .map(|(label, term)| Variation::one(label, term))
        .collect();
    if all.len() > 1 {
        variants.push(Variation::of("all", all));
    }
    variants
}
