//! Levels of factors: runs, instruments, operators, mounts, directions.

use super::building::{form, on_node};
use super::fitted::{FittedModel, Node};
use super::modifiers::{flag, map};
use super::{Cell, EffectId, Modifier, Variation};
use crate::diagnose::case::{Column, Role};
use crate::recording::Labels;

/// A column of labels, with those that occur in its rows.
pub(super) struct Factor<'f> {
    pub(super) column: &'f Column,
    labels: &'f Labels,
    pub(super) levels: Vec<u32>,
}

/// Columns of labels of which two or more occur, and of so many blocks (a part, of a whole) no more than one each.
pub(super) fn factors<'f>(
    fitted: &FittedModel<'f>,
    (part, whole): (usize, usize),
) -> impl Iterator<Item = Factor<'f>> {
    let most = part * fitted.design.blocks.len() / whole;
    let columns = fitted.case().columns.iter();
    columns.filter_map(move |column| {
        let labels = column.labels()?;
        let levels = present(labels);
        let several = (2..=most).contains(&levels.len());
        several.then_some(Factor {
            column,
            labels,
            levels,
        })
    })
}

impl Factor<'_> {
    pub(super) fn text(&self, level: u32) -> &str {
        (self.labels.levels.get(level as usize)).map_or("", String::as_str)
    }

    /// 1 in the rows of a level.
    pub(super) fn indicator(&self, level: u32) -> Vec<f64> {
        indicator(self.labels, level)
    }

    fn modifier(&self, level: u32) -> Modifier {
        let text = format!("[{} = {}]", self.column.name, self.text(level));
        Modifier::number(self.indicator(level), text)
    }

    /// Differences to the first level: the mean is the model's own.
    pub(super) fn differences(&self) -> Vec<Modifier> {
        let others = self.levels[1..].iter();
        others.map(|level| self.modifier(*level)).collect()
    }
}

/// Cells of the columns of labels.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    for factor in factors(fitted, (2, 3)) {
        match factor.column.role {
            Role::Direction => cells.push(directions(fitted, &factor)),
            Role::Position if is_place(fitted) => {
                let all = shifts(fitted, &factor).into_iter();
                cells.extend(all.filter(|c| c.effect.id == EffectId::LevelScale));
            }
            Role::Run | Role::Factor | Role::Axis => cells.extend(shifts(fitted, &factor)),
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
    let rows = labels.of_row.iter();
    rows.map(|of| flag(*of == level)).collect()
}

/// Every level has a value of its own; or only one has; or all from one on, in the order of the recording.
fn shifts(fitted: &FittedModel<'_>, factor: &Factor<'_>) -> Vec<Cell> {
    let (name, levels) = (&factor.column.name, &factor.levels);
    let all = form("", factor.differences());
    let one = |level: &u32| {
        let label = format!("{name} {}", factor.text(*level));
        form(label, vec![factor.modifier(*level)])
    };
    // With two levels a shift of one is a shift between both.
    let alone: Vec<Variation> = match levels.len() {
        2 => Vec::new(),
        _ => levels.iter().map(one).collect(),
    };
    let onwards = match factor.column.role {
        Role::Run if levels.len() > 3 => changes(factor),
        _ => Vec::new(),
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
    let mut cells = Vec::new();
    let mut add = |id: EffectId, node: Node| {
        cells.push(on_node(fitted, id, name, node, forms.clone()));
    };
    add(EffectId::LevelShift, Node::Output);
    if fitted.has_signal() {
        add(EffectId::LevelScale, Node::Gain);
    }
    cells
}

/// From one level on, with more than one level on both sides.
fn changes(factor: &Factor<'_>) -> Vec<Variation> {
    let name = &factor.column.name;
    let firsts = &factor.levels[2..factor.levels.len() - 1];
    let since = |first: &u32| {
        let rows = factor.labels.of_row.iter();
        let modifier = rows.map(|of| flag(of >= first)).collect();
        let label = factor.text(*first);
        let since = Modifier::number(modifier, format!("[{name} >= {label}]"));
        form(format!("from {name} {label} on"), vec![since])
    };
    firsts.iter().map(since).collect()
}

fn directions(fitted: &FittedModel<'_>, factor: &Factor<'_>) -> Cell {
    let (name, last) = (&factor.column.name, factor.levels[factor.levels.len() - 1]);
    let modifier = map(&factor.indicator(last), |x| 2.0 * x - 1.0);
    let way = Modifier::number(modifier, format!("direction({name})"));
    let id = EffectId::Hysteresis;
    on_node(fitted, id, name, Node::Output, [form("", vec![way])])
}
