//! What an experiment tells apart, and what hides in its coefficients.

use super::super::language::Language;
use super::super::number::{percent, significant};
use super::super::symbol;
use super::sections::said;
use super::trouble::{changes, in_words};
use crate::calibrate::{Alias, Combination, Experiment, Figures, Identifiability, Omitted, Plan};
use crate::document::Block;
use crate::quantity::Unit;

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
    let parameters = experiment.parameters.iter().map(|p| (&p.name, &p.unit));
    let results = experiment.results.iter().map(|r| (&r.name, &r.unit));
    let coefficients: Vec<Reported> = parameters
        .chain(results)
        .enumerate()
        .map(|(index, (name, unit))| Reported {
            name,
            unit: in_unit(unit),
            u: figures.map_or(f64::NAN, |figures| figures.coefficients[index].u),
        })
        .collect();
    let items = aliases.iter().filter_map(|alias| {
        let omitted = experiment
            .omitted
            .iter()
            .find(|one| one.name == alias.name)?;
        Some(sentence(omitted, alias, &coefficients, l))
    });
    vec![
        Block::Section(
            l.pick(
                "What effects outside the equations would shift",
                "方程未计入的效应会引起的偏移",
            )
            .to_owned(),
        ),
        Block::List(items.collect()),
    ]
}

/// A coefficient with its standard uncertainty, if it is known.
struct Reported<'a> {
    name: &'a str,
    /// Its unit behind a number.
    unit: String,
    u: f64,
}

/// A unit behind a number.
fn in_unit(unit: &Unit) -> String {
    match symbol(unit) {
        none if none.is_empty() => none,
        unit => format!(" {unit}"),
    }
}

/// An omitted effect and what it would do: at its usual size, or per unit where none is stated.
fn sentence(
    omitted: &Omitted,
    alias: &Alias,
    coefficients: &[Reported<'_>],
    l: Language,
) -> String {
    let name = &alias.name;
    let physics = omitted.description.as_ref().map(|words| said(words, l));
    let physics = match physics.filter(|physics| !physics.is_empty()) {
        None => format!(" [{}]", omitted.term),
        Some(physics) => l.pick(
            format!(" ({physics}) [{}]", omitted.term),
            format!("（{physics}）[{}]", omitted.term),
        ),
    };
    if !alias.acts {
        return l.pick(
            format!("{name}{physics}: acts on no reading of this schedule."),
            format!("{name}{physics}：在本安排中不影响任何读数。"),
        );
    }
    let visible = match alias.visible {
        0.0 => l.pick(
            "the residuals show nothing of it".to_owned(),
            "残差完全不显示".to_owned(),
        ),
        share => l.pick(
            format!("the residuals show {} % of it", percent(share)),
            format!("残差显示其 {} %", percent(share)),
        ),
    };
    let unit = in_unit(&omitted.unit);
    match omitted.typical {
        Some(size) => {
            let amount = format!("{name} = {}{unit}", significant(size, 3));
            let shifts = shifts(alias, size, coefficients, l);
            l.pick(
                format!("{amount}{physics} {shifts}; {visible}."),
                format!("{amount}{physics} {shifts}；{visible}。"),
            )
        }
        None => {
            let unknown: Vec<Reported<'_>> = coefficients
                .iter()
                .map(|one| Reported {
                    name: one.name,
                    unit: one.unit.clone(),
                    u: f64::NAN,
                })
                .collect();
            let shifts = shifts(alias, 1.0, &unknown, l);
            l.pick(
                format!("{name}{physics}: each 1{unit} {shifts}; {visible}. Its usual size is not stated; [omitted.{name}] typical = … tells the shifts in multiples of u."),
                format!("{name}{physics}：每 1{unit} {shifts}；{visible}。未给出其典型值；写 [omitted.{name}] typical = … 可得以 u 为单位的偏移。"),
            )
        }
    }
}

/// Shifts of less than this part of the largest, both in multiples of u, are not listed one by one.
const SLIGHT: f64 = 0.01;

/// What an effect of this size does to each coefficient.
fn shifts(alias: &Alias, size: f64, coefficients: &[Reported<'_>], l: Language) -> String {
    let shifted: Vec<(&Reported<'_>, f64, f64)> = coefficients
        .iter()
        .zip(&alias.shifts)
        .enumerate()
        .filter(|(index, _)| is_felt(alias, *index))
        .map(|(_, (one, shift))| {
            let times = (shift * size / one.u).abs();
            (
                one,
                shift * size,
                if one.u > 0.0 { times } else { f64::NAN },
            )
        })
        .collect();
    if shifted.is_empty() {
        return l.pick("shifts no coefficient", "不使系数偏移").to_owned();
    }
    let largest = shifted.iter().map(|one| one.2).fold(0.0, f64::max);
    let is_slight = |times: f64| times < SLIGHT * largest;
    let listed: Vec<String> = shifted
        .iter()
        .filter(|(.., times)| !is_slight(*times))
        .map(|(one, shift, times)| {
            let sign = if *shift < 0.0 { '−' } else { '+' };
            let times = match times.is_nan() {
                true => String::new(),
                false => {
                    let times = significant(*times, 2);
                    l.pick(format!(" ({times} u)"), format!("（{times} u）"))
                }
            };
            let size = significant(shift.abs(), 3);
            format!("{} {sign} {size}{}{times}", one.name, one.unit)
        })
        .collect();
    let rest = match listed.len() < shifted.len() {
        true => {
            let bound = significant(SLIGHT * largest, 1);
            l.pick(
                format!(", and the others by less than {bound} u"),
                format!("，其余系数偏移小于 {bound} u"),
            )
        }
        false => String::new(),
    };
    l.pick(
        format!("shifts {}{rest}", listed.join(", ")),
        format!("使 {}{rest}", listed.join("，")),
    )
}

/// Shifts that are no rounding noise of the largest one.
fn is_felt(alias: &Alias, index: usize) -> bool {
    let largest = alias
        .shifts
        .iter()
        .fold(0.0_f64, |most, s| most.max(s.abs()));
    alias.shifts[index].abs() > 1e-9 * largest
}
