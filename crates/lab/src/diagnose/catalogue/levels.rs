//! Levels of factors: runs, instruments, operators, mounts, directions.

use super::building::{form, on_node};
use super::fitted::{FittedModel, Node};
use super::modifiers::map;
use super::{Cell, EffectId, Modifier, Variation};
use crate::diagnose::case::Role;
use crate::recording::Labels;

/// Cells of the columns of labels.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    for column in &fitted.case().columns {
        let Some(labels) = column.labels() else {
            continue;
        };
        let levels = present(labels);
        if levels.len() < 2 || levels.len() * 3 > 2 * fitted.design.blocks.len() {
            continue;
        }
        match column.role {
            Role::Direction => cells.extend(directions(fitted, &column.name, labels, &levels)),
            Role::Position if is_place(fitted) => {
                let all = shifts(fitted, &column.name, labels, &levels, column.role);
                let scales = all
                    .into_iter()
                    .filter(|c| c.effect.id == EffectId::LevelScale);
                cells.extend(scales);
            }
            role @ (Role::Run | Role::Factor | Role::Axis) => {
                cells.extend(shifts(fitted, &column.name, labels, &levels, role));
            }
            _ => {}
        }
    }
    cells
}

/// Whether positions are places where one and the same stimulus acts, as on the pan of a balance or over an
/// aperture, rather than attitudes of an inertial sensor.
pub(super) fn is_place(fitted: &FittedModel<'_>) -> bool {
    let case = fitted.case();
    let stimuli = case.with_role(Role::Stimulus).count();
    let turned = case.with_role(Role::Angle).next().is_some();
    stimuli == 1 && !turned && fitted.has_signal()
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

fn text(labels: &Labels, level: u32) -> &str {
    labels.levels.get(level as usize).map_or("", String::as_str)
}

/// Every level has a value of its own; or only one has; or all from one on, in the order of the recording.
fn shifts(
    fitted: &FittedModel<'_>,
    name: &str,
    labels: &Labels,
    levels: &[u32],
    role: Role,
) -> Vec<Cell> {
    let column = |level: u32| {
        Modifier::number(
            indicator(labels, level),
            format!("[{name} = {}]", text(labels, level)),
        )
    };
    // Differences to the first level: the mean is the model's own.
    let all = form("", levels[1..].iter().map(|level| column(*level)).collect());
    let one = |level: &u32| {
        let label = format!("{name} {}", text(labels, *level));
        form(label, vec![column(*level)])
    };
    // With two levels a shift of one is a shift between both.
    let alone: Vec<Variation> = match levels.len() {
        2 => Vec::new(),
        _ => levels.iter().map(one).collect(),
    };
    let onwards = if role == Role::Run && levels.len() > 3 {
        changes(name, labels, levels)
    } else {
        Vec::new()
    };
    // Each kind is as likely as the others, however many variants it has.
    let weighted = |kind: Vec<Variation>| {
        let weight = 1.0 / kind.len() as f64;
        let own = kind.into_iter();
        own.map(move |variation| Variation {
            weight,
            ..variation
        })
    };
    let kinds = [vec![all], alone, onwards].into_iter();
    let forms: Vec<Variation> = kinds.flat_map(weighted).collect();
    let mut cells = vec![on_node(
        fitted,
        EffectId::LevelShift,
        name,
        Node::Output,
        forms.clone(),
    )];
    if fitted.has_signal() {
        let id = EffectId::LevelScale;
        cells.push(on_node(fitted, id, name, Node::Gain, forms));
    }
    cells
}

/// From one level on, with more than one level on both sides.
fn changes(name: &str, labels: &Labels, levels: &[u32]) -> Vec<Variation> {
    levels[2..levels.len() - 1]
        .iter()
        .map(|first| {
            let modifier = labels
                .of_row
                .iter()
                .map(|of| f64::from(u8::from(of >= first)));
            let label = text(labels, *first);
            let since = Modifier::number(modifier.collect(), format!("[{name} >= {label}]"));
            form(format!("from {name} {label} on"), vec![since])
        })
        .collect()
}

fn directions(fitted: &FittedModel<'_>, name: &str, labels: &Labels, levels: &[u32]) -> Vec<Cell> {
    let last = indicator(labels, levels[levels.len() - 1]);
    let modifier = map(&last, |x| 2.0 * x - 1.0);
    let way = Modifier::number(modifier, format!("direction({name})"));
    let form = form("", vec![way]);
    let id = EffectId::Hysteresis;
    vec![on_node(fitted, id, name, Node::Output, [form])]
}
