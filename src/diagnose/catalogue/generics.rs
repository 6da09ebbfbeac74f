//! Competitors without a name: smooth curves and levels that no physics explains. When one of them wins,
//! the answer is "unexplained", and where.

use std::f64::consts::PI;

use super::ground::{Ground, Node};
use super::modifiers::{map, range};
use super::response::words;
use super::{Cell, Term, Variation, effect};
use crate::diagnose::case::{NoiseClaim, Role};
use crate::diagnose::evidence::Place;

/// Correlation length of smooth curves, as a part of the range.
const LENGTH: f64 = 0.2;

/// Cosines of a smooth curve.
const COSINES: usize = 8;

/// One smooth curve for each column and for the time, levels of each factor that has no name, and scatter.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    let mut nodes = vec![Node::Output];
    if ground.has_signal() {
        nodes.push(Node::Gain);
    }
    let mut courses: Vec<(String, Vec<f64>)> = ground
        .numeric()
        .into_iter()
        .map(|column| {
            (
                ground.case().columns[column].name.clone(),
                ground.numbers(column).to_vec(),
            )
        })
        .collect();
    for column in ground.case().with_role(Role::Angle) {
        courses.push((
            ground.case().columns[column].name.clone(),
            ground.numbers(column).to_vec(),
        ));
    }
    let time = ground.clock.column.map_or_else(
        || "row".to_owned(),
        |column| ground.case().columns[column].name.clone(),
    );
    courses.push((time, ground.clock.values.clone()));
    for (name, course) in &courses {
        let distinct = distinct(course);
        if distinct < 4 {
            continue;
        }
        for node in &nodes {
            cells.push(smooth(ground, *node, name, course, distinct));
        }
    }
    for column in &ground.case().columns {
        let Some(labels) = column.labels() else {
            continue;
        };
        let levels = super::levels::present(labels);
        let named = matches!(
            column.role,
            Role::Run | Role::Factor | Role::Axis | Role::Direction
        );
        if named || levels.len() < 2 || levels.len() * 2 > ground.frame.blocks.len() {
            continue;
        }
        for node in &nodes {
            let terms = levels
                .iter()
                .map(|level| term(*node, super::levels::indicator(labels, *level)));
            cells.push(generic(
                ground,
                "levels",
                *node,
                &column.name,
                terms.collect(),
                vec![1.0; levels.len()],
            ));
        }
    }
    if !matches!(ground.case().noise, NoiseClaim::Estimated) {
        let mut scatter = generic(
            ground,
            "scatter",
            Node::Output,
            "row",
            Vec::new(),
            Vec::new(),
        );
        scatter.place.along = String::new();
        cells.push(scatter);
    }
    cells
}

fn distinct(x: &[f64]) -> usize {
    let mut values = x.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values.len()
}

fn term(node: Node, modifier: Vec<f64>) -> Term {
    Term {
        node,
        response: None,
        modifier,
        text: String::new(),
    }
}

fn smooth(ground: &Ground<'_>, node: Node, name: &str, course: &[f64], distinct: usize) -> Cell {
    let (least, most) = range(course);
    let count = COSINES.min(distinct - 1);
    let terms = (1..=count).map(|k| {
        let wave = |x: f64| libm::cos(PI * k as f64 * (x - least) / (most - least));
        term(node, map(course, wave))
    });
    // Spectrum of a Gaussian process with a squared exponential kernel on the unit interval.
    let spectrum = (1..=count).map(|k| {
        let frequency = PI * k as f64 * LENGTH;
        libm::exp(-frequency * frequency / 2.0).max(1e-3)
    });
    generic(
        ground,
        "smooth",
        node,
        name,
        terms.collect(),
        spectrum.collect(),
    )
}

fn generic(
    ground: &Ground<'_>,
    id: &str,
    node: Node,
    along: &str,
    terms: Vec<Term>,
    spectrum: Vec<f64>,
) -> Cell {
    let mut words = words(ground, along);
    words.p = ground.name(node);
    Cell {
        effect: effect(id),
        words,
        place: Place {
            node: ground.name(node),
            along: along.to_owned(),
        },
        variants: vec![Variation {
            spectrum: Some(spectrum),
            ..Variation::of("", terms)
        }],
        typical: None,
        description: None,
    }
}
