//! What an experiment tells apart, and what hides in its coefficients.

use super::super::document::Block;
use super::super::language::Language;
use super::super::number::{percent, significant};
use super::super::symbol;
use super::sections::said;
use super::trouble::{changes, in_words};
use crate::calibrate::{Alias, Combination, Experiment, Figures, Identifiability, Plan};

pub(super) fn schedule(plan: &Plan, l: Language) -> Vec<Block> {
    vec![Block::Paragraph(l.pick(
        format!(
            "The schedule gives {} readings for {} parameters.",
            plan.readings, plan.identifiability.parameters
        ),
        format!(
            "该测量安排给出 {} 个读数，待求参数 {} 个。",
            plan.readings, plan.identifiability.parameters
        ),
    ))]
}

/// What the experiment tells apart.
pub(super) fn identifiability(found: &Identifiability, l: Language) -> Vec<Block> {
    let mut items = Vec::new();
    let (rank, count) = (found.rank, found.parameters);
    if rank == count {
        let condition = significant(found.condition, 3);
        items.push(l.pick(
            format!("The readings determine all {count} parameters (rank {rank}; condition number of the scaled equations {condition})."),
            format!("读数确定全部 {count} 个参数（秩 {rank}；归一化方程条件数 {condition}）。"),
        ));
    } else {
        items.push(l.pick(
            format!("The readings determine {rank} combinations of {count} parameters: not all can be found."),
            format!("读数只确定 {count} 个参数的 {rank} 个组合，不能求出全部参数。"),
        ));
    }
    let undetermined = |combination: &Combination| {
        l.pick(
            format!("Not determined: {}.", in_words(combination, l)),
            format!("不可确定：{}。", in_words(combination, l)),
        )
    };
    items.extend(found.undetermined.iter().map(undetermined));
    for near in &found.near {
        let times = significant(near.inflation, 3);
        let together = changes(&near.combination);
        items.push(l.pick(
            format!("{} is nearly hidden: {together} together change the readings by little, and its standard uncertainty is {times} times what it would be if the others were known.", near.parameter),
            format!("{} 几乎被掩盖：{together} 同时变化时读数变化很小，其标准不确定度为其余参数已知时的 {times} 倍。", near.parameter),
        ));
    }
    vec![
        Block::Section(
            l.pick("What the experiment tells apart", "可辨识性")
                .to_owned(),
        ),
        Block::List(items),
    ]
}

/// What omitted effects would shift.
pub(super) fn aliases(
    experiment: &Experiment,
    aliases: &[Alias],
    figures: Option<&Figures>,
    l: Language,
) -> Vec<Block> {
    if aliases.is_empty() {
        return Vec::new();
    }
    let names: Vec<String> = experiment
        .parameters
        .iter()
        .map(|one| (one.name.clone(), symbol(&one.unit)))
        .chain(
            experiment
                .results
                .iter()
                .map(|one| (one.name.clone(), symbol(&one.unit))),
        )
        .map(|(name, unit)| {
            if unit.is_empty() {
                name
            } else {
                format!("{name} / {unit}")
            }
        })
        .collect();
    let mut items = Vec::new();
    for alias in aliases {
        let Some(omitted) = experiment.omitted.iter().find(|one| one.name == alias.name) else {
            continue;
        };
        let size = omitted.typical.unwrap_or(1.0);
        let unit = symbol(&omitted.unit);
        let unit = if unit.is_empty() {
            unit
        } else {
            format!(" {unit}")
        };
        let amount = format!("{} = {}{unit}", alias.name, significant(size, 3));
        let physics = omitted
            .description
            .as_ref()
            .map(|words| said(words, l))
            .unwrap_or_default();
        let physics = if physics.is_empty() {
            format!(" [{}]", omitted.term)
        } else {
            l.pick(
                format!(" ({physics}) [{}]", omitted.term),
                format!("（{physics}）[{}]", omitted.term),
            )
        };
        if !alias.acts {
            items.push(l.pick(
                format!(
                    "{}{physics}: acts on no reading of this schedule.",
                    alias.name
                ),
                format!("{}{physics}：在本安排中不影响任何读数。", alias.name),
            ));
            continue;
        }
        let largest = alias.shifts.iter().enumerate().map(|(index, shift)| {
            let u = figures.map_or(0.0, |figures| figures.coefficients[index].u);
            (
                index,
                shift * size,
                if u > 0.0 {
                    (shift * size / u).abs()
                } else {
                    f64::NAN
                },
            )
        });
        let shifts: Vec<String> = largest
            .filter(|(index, ..)| is_felt(alias, *index))
            .map(|(index, shift, ratio)| {
                let (name, unit) = names[index]
                    .split_once(" / ")
                    .unwrap_or((&names[index], ""));
                let unit = if unit.is_empty() {
                    String::new()
                } else {
                    format!(" {unit}")
                };
                let sign = if shift < 0.0 { '−' } else { '+' };
                let times = if ratio.is_nan() {
                    String::new()
                } else {
                    l.pick(
                        format!(" ({} u)", significant(ratio, 2)),
                        format!("（{} u）", significant(ratio, 2)),
                    )
                };
                format!("{name} {sign} {}{unit}{times}", significant(shift.abs(), 3))
            })
            .collect();
        let hidden = match alias.visible {
            0.0 => l.pick(
                "the residuals show nothing of it".to_owned(),
                "残差完全不显示".to_owned(),
            ),
            share => l.pick(
                format!("the residuals show {} % of it", percent(share)),
                format!("残差显示其 {} %", percent(share)),
            ),
        };
        let shifts = if shifts.is_empty() {
            l.pick(
                "shifts no coefficient".to_owned(),
                "不使系数偏移".to_owned(),
            )
        } else {
            l.pick(
                format!("shifts {}", shifts.join(", ")),
                format!("使 {}", shifts.join("，")),
            )
        };
        items.push(l.pick(
            format!("{amount}{physics} {shifts}; {hidden}."),
            format!("{amount}{physics} {shifts}；{hidden}。"),
        ));
    }
    vec![
        Block::Section(
            l.pick(
                "What effects outside the equations would shift",
                "方程未计入的效应会引起的偏移",
            )
            .to_owned(),
        ),
        Block::List(items),
    ]
}

/// Shifts that are no rounding noise of the largest one.
fn is_felt(alias: &Alias, index: usize) -> bool {
    let largest = alias
        .shifts
        .iter()
        .fold(0.0_f64, |most, s| most.max(s.abs()));
    alias.shifts[index].abs() > 1e-9 * largest
}
