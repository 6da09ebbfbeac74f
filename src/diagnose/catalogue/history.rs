//! What depends on the way by which a value was reached: hysteresis and backlash.

use super::ground::{Ground, Node, varies};
use super::modifiers::{direction, figure, grid, map, map2, play, range, typical_step};
use super::response::{on_output, plain};
use super::{Cell, Term, Variation};
use crate::diagnose::case::Role;

/// Cells of one column that is an input.
pub(super) fn cells(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let (x, label) = (ground.numbers(column), ground.label(column));
    if !comes_back(x) {
        return Vec::new();
    }
    let way = direction(x);
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
        let term = Term::new(
            Node::Column(column),
            modifier,
            format!(
                "(play({label}, {width}) - {label})/{width}",
                width = figure(width)
            ),
        );
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
    // Falling values with the opposite sign: no mixture of the two with sizes of one sign is a parabola
    // without a loop.
    let on_one = |sign: f64| map2(&wide, way, |wide, way| wide * (sign + way) / 2.0);
    let simple = [
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
            format!("-[falling]*{shape}"),
        ),
    ];
    let simple = simple
        .into_iter()
        .map(|(variant, modifier, text)| Variation::one(variant, on_output(modifier, text)));
    simple.chain(plays(x, label)).collect()
}

/// Inner friction (Prandtl, Ishlinskii): the output stays behind by a play, or by several of growing width
/// together. The first way from rest has no loop yet, which a direction alone cannot say.
fn plays(x: &[f64], label: &str) -> Vec<Variation> {
    /// Widths as parts of the range.
    const WIDTHS: [f64; 5] = [0.05, 0.15, 0.3, 0.5, 0.75];
    let (least, most) = range(x);
    let behind = |part: f64| {
        let width = part * (most - least);
        let modifier = map2(x, &play(x, width), |x, played| x - played);
        let text = format!("({label} - play({label}, {}))", figure(width));
        (modifier, text)
    };
    let single = WIDTHS.map(|part| {
        let (modifier, text) = behind(part);
        let width = format!("width {} % of the range", 100.0 * part);
        Variation::one(width, on_output(modifier, text))
    });
    let mut sum = vec![0.0; x.len()];
    for part in WIDTHS {
        sum = map2(&sum, &behind(part).0, |sum, one| sum + one);
    }
    let mean = map(&sum, |sum| sum / WIDTHS.len() as f64);
    let text = format!("mean of ({label} - play({label}, w)) over widths w");
    let even = Variation::one("several widths", on_output(mean, text));
    let apart = WIDTHS.iter().skip(1).step_by(2).map(|part| {
        let (modifier, text) = behind(*part);
        on_output(modifier, text)
    });
    let uneven = Variation::of("two widths", apart.collect());
    single.into_iter().chain([even, uneven]).collect()
}

/// Whether a course goes both ways, more than by returning to where a series begins.
pub(super) fn comes_back(x: &[f64]) -> bool {
    /// Rows of the rarer way, one in so many.
    const ONE_IN: usize = 8;
    let way = direction(x);
    let rising = way.iter().filter(|way| **way > 0.0).count();
    let turns = way.windows(2).any(|pair| pair[0] != pair[1]);
    turns && rising.min(way.len() - rising) * ONE_IN >= way.len()
}
