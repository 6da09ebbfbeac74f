//! Harmonics of angles: errors of the angle itself, and what repeats with each turn; second-order terms of
//! a sensor that is turned.

use std::f64::consts::PI;

use super::ground::{Ground, Node, varies};
use super::modifiers::{map, map2, range};
use super::response::{on_node, words};
use super::{Cell, Modifier, Term, Variants, Variation, effect};
use crate::diagnose::case::Role;
use crate::diagnose::evidence::Place;
use crate::quantity::UnitTable;

/// Highest harmonic.
const HIGHEST: u32 = 4;

/// Cells of the angles.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let angles = ground.case().with_role(Role::Angle);
    let angles: Vec<usize> = angles
        .filter(|c| ground.case().columns[*c].numbers().is_some_and(varies))
        .collect();
    angles
        .into_iter()
        .flat_map(|column| of_angle(ground, column))
        .collect()
}

fn of_angle(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let name = &ground.case().columns[column].name;
    let phi = radians(ground, column);
    let (least, most) = range(&phi);
    let harmonics: Vec<u32> = (1..=HIGHEST)
        .filter(|k| f64::from(*k) * (most - least) > PI)
        .collect();
    let variants: Variants = harmonics
        .iter()
        .map(|k| {
            let times = f64::from(*k);
            let pair = vec![
                (
                    map(&phi, |phi| libm::sin(times * phi)),
                    format!("sin({k}*{name})"),
                ),
                (
                    map(&phi, |phi| libm::cos(times * phi)),
                    format!("cos({k}*{name})"),
                ),
            ];
            (format!("{k} per turn"), pair)
        })
        .collect();
    // Harmonics are independent of one another: each is a candidate of its own.
    let each = |id: &str, node: Node| -> Vec<Cell> {
        let one = |variant: &(String, Vec<Modifier>)| {
            let words = words(ground, name);
            on_node(ground, id, words, name, node, vec![variant.clone()])
        };
        variants.iter().map(one).collect()
    };
    let mut cells = each("periodic", Node::Output);
    if !ground.in_model(column) {
        return cells;
    }
    cells.extend(each("eccentricity", Node::Column(column)));
    cells.extend(second_order(ground, column));
    cells
}

/// The angle in radians; a number without a unit is one.
fn radians(ground: &Ground<'_>, column: usize) -> Vec<f64> {
    let numbers = ground.numbers(column);
    let unit = &ground.case().columns[column].unit;
    let conversion = UnitTable::default()
        .parse("rad")
        .ok()
        .and_then(|rad| unit.conversion_to(&rad));
    match conversion {
        Some(conversion) => map(numbers, |x| conversion.apply(x)),
        None => numbers.to_vec(),
    }
}

/// Powers of the signal, and of its slope by the angle, which is the quantity along the other axis.
fn second_order(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let name = &ground.case().columns[column].name;
    type Law = fn(f64, f64) -> f64;
    let laws: [(&str, &str, Law); 6] = [
        ("quadratic", "signal^2", |s, _| s * s),
        ("cubic", "signal^3", |s, _| s * s * s),
        ("asymmetry", "abs(signal)", |s, _| s.abs()),
        ("zero-step", "sign(signal)", |s, _| {
            if s.abs() < 1e-9 { 0.0 } else { s.signum() }
        }),
        ("cross-product", "signal*across", |s, q| s * q),
        ("cross-square", "across^2", |_, q| q * q),
    ];
    let build = |(id, text, law): (&str, &str, Law)| {
        let terms: Vec<Term> = (0..ground.case().responses.len())
            .map(|response| {
                let signal = ground.signal(response);
                let across = ground.slope(Node::Column(column), response);
                let size = signal
                    .iter()
                    .fold(0.0_f64, |most, s| most.max(s.abs()))
                    .max(f64::MIN_POSITIVE);
                let tallest = across
                    .iter()
                    .fold(0.0_f64, |most, q| most.max(q.abs()))
                    .max(f64::MIN_POSITIVE);
                Term {
                    node: Node::Output,
                    response: Some(response),
                    // In units of the largest signal, so that the size is a part of the range.
                    modifier: map2(signal, &across, |s, q| law(s / size, q / tallest)),
                    text: text.to_owned(),
                }
            })
            .collect();
        let variants = vec![Variation::of("", terms)];
        let mut words = words(ground, name);
        if !matches!(id, "cross-product" | "cross-square") {
            words.x = format!("model({name})");
        }
        Cell {
            effect: effect(id),
            words,
            place: Place {
                node: ground.name(Node::Output),
                along: name.clone(),
            },
            variants,
            typical: None,
            description: None,
        }
    };
    laws.map(build).into()
}
