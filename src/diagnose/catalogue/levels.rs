//! Levels of factors: runs, instruments, operators, mounts, directions.

use super::Cell;
use super::ground::{Ground, Node};
use super::modifiers::map;
use super::response::{on_node, words};
use crate::diagnose::case::Role;
use crate::recording::Labels;

type Variants = Vec<(String, Vec<(Vec<f64>, String)>)>;

/// Cells of the columns of labels.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    for column in &ground.case().columns {
        let Some(labels) = column.labels() else {
            continue;
        };
        let levels = present(labels);
        if levels.len() < 2 || levels.len() * 3 > 2 * ground.frame.blocks.len() {
            continue;
        }
        match column.role {
            Role::Direction => cells.extend(directions(ground, &column.name, labels, &levels)),
            Role::Run => {
                cells.extend(shifts(ground, &column.name, labels, &levels));
                cells.extend(changes(ground, &column.name, labels, &levels));
            }
            Role::Factor | Role::Axis => {
                cells.extend(shifts(ground, &column.name, labels, &levels))
            }
            _ => {}
        }
    }
    cells
}

/// Levels that occur in the rows that are left.
pub(super) fn present(labels: &Labels) -> Vec<u32> {
    let mut levels = labels.of_row.clone();
    levels.sort_unstable();
    levels.dedup();
    levels
}

/// 1 in the rows of a level.
pub(super) fn indicator(labels: &Labels, level: u32) -> Vec<f64> {
    labels
        .of_row
        .iter()
        .map(|of| f64::from(u8::from(*of == level)))
        .collect()
}

fn text<'l>(labels: &'l Labels, level: u32) -> &'l str {
    labels.levels.get(level as usize).map_or("", String::as_str)
}

/// Every level has a value of its own; or only one has.
fn shifts(ground: &Ground<'_>, name: &str, labels: &Labels, levels: &[u32]) -> Vec<Cell> {
    let column = |level: u32| {
        (
            indicator(labels, level),
            format!("[{name} = {}]", text(labels, level)),
        )
    };
    // Differences to the first level: the mean is the model's own.
    let all: Variants = vec![(
        String::new(),
        levels[1..].iter().map(|level| column(*level)).collect(),
    )];
    let each: Variants = levels
        .iter()
        .map(|level| {
            (
                format!("{name} {}", text(labels, *level)),
                vec![column(*level)],
            )
        })
        .collect();
    let mut cells = Vec::new();
    for (node, shift, odd) in [
        (Node::Output, "level-shift", "odd-level"),
        (Node::Gain, "level-scale", "odd-level-scale"),
    ] {
        if node == Node::Gain && !ground.has_signal() {
            continue;
        }
        cells.push(on_node(
            ground,
            shift,
            words(ground, name),
            name,
            node,
            all.clone(),
        ));
        // With two levels a shift of one is a shift between both.
        if levels.len() > 2 {
            cells.push(on_node(
                ground,
                odd,
                words(ground, name),
                name,
                node,
                each.clone(),
            ));
        }
    }
    cells
}

/// From one level on, in the order of the recording.
fn changes(ground: &Ground<'_>, name: &str, labels: &Labels, levels: &[u32]) -> Vec<Cell> {
    if levels.len() < 4 {
        return Vec::new();
    }
    let variants: Variants = levels[2..levels.len() - 1]
        .iter()
        .map(|first| {
            let modifier = labels
                .of_row
                .iter()
                .map(|of| f64::from(u8::from(of >= first)));
            let label = text(labels, *first);
            (
                format!("from {name} {label} on"),
                vec![(modifier.collect(), format!("[{name} >= {label}]"))],
            )
        })
        .collect();
    vec![on_node(
        ground,
        "level-change",
        words(ground, name),
        name,
        Node::Output,
        variants,
    )]
}

fn directions(ground: &Ground<'_>, name: &str, labels: &Labels, levels: &[u32]) -> Vec<Cell> {
    let last = indicator(labels, levels[levels.len() - 1]);
    let modifier = map(&last, |x| 2.0 * x - 1.0);
    let variants: Variants = vec![(
        String::new(),
        vec![(modifier, format!("direction({name})"))],
    )];
    vec![on_node(
        ground,
        "hysteresis",
        words(ground, name),
        name,
        Node::Output,
        variants,
    )]
}
