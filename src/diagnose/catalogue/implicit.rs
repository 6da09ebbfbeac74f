//! Models that hold a constant against several columns, such as |a| = g for a triad at rest.

use super::ground::{Ground, Node};
use super::modifiers::{centred, figure, map, range};
use super::response::words;
use super::{Cell, Term, Variation, Words};
use crate::diagnose::evidence::Place;

/// Disturbances of each column that the model uses.
pub(super) fn cells(ground: &Ground<'_>, used: &[usize]) -> Vec<Cell> {
    let term = |column: usize, modifier: Vec<f64>, text: String| {
        Term::new(Node::Column(column), modifier, text)
    };
    let cell = |id: &str, variants: Vec<Variation>| {
        let names: Vec<&str> = used.iter().map(|c| ground.label(*c)).collect();
        let joined = names.join(", ");
        Cell::new(
            id,
            Words {
                p: joined.clone(),
                ..words(ground, &joined)
            },
            Place {
                node: "axes".into(),
                along: joined,
            },
            variants,
        )
    };
    let mut cells = Vec::new();
    let mut pairs = Vec::new();
    for (at, x) in used.iter().enumerate() {
        for z in &used[at + 1..] {
            let other = centred(ground.numbers(*z));
            let text = format!("({} - mean)", ground.label(*z));
            pairs.push((
                format!("{} with {}", ground.label(*x), ground.label(*z)),
                term(*x, other, text),
            ));
        }
    }
    cells.push(cell("cross-axis", singles_and_all(pairs)));
    let own = used.iter().map(|column| {
        let label = ground.label(*column).to_owned();
        let x = ground.numbers(*column).to_vec();
        (label.clone(), term(*column, x, label))
    });
    let mut scales = cell("axis-scale", singles_and_all(own.collect()));
    let absorbed = super::zero::Absorbed::by_parameters(ground);
    scales.variants.retain(|variation| {
        let columns = variation.columns(ground);
        let mut columns = columns.column_iter();
        columns.all(|column| absorbed.leaves(&column.into_owned()))
    });
    cells.push(scales);
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
            let label = ground.label(*column);
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
