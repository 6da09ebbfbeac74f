//! What a diagnosis leaves open: effects that the recording does not exclude, and explanations that it
//! cannot tell apart.

use serde_json::{Value, json};

use crate::diagnose::catalogue::Cell;
use crate::diagnose::evidence::State;
use crate::diagnose::{Diagnosis, Estimated, Omitted, Separating};
use crate::document::Block;
use crate::document::{ColumnKind, Table};
use crate::language::Language;
use crate::number::{percent, significant};

use super::json::finite;
use super::statement::slot_names;
use super::words::{full_name, measure, unknown};

/// More are in the JSON.
const MOST: usize = 8;
/// A line that is smaller than this part of a parameter's u does not change it.
const MATTERS: f64 = 0.1;

/// What effects cost that are not in the model.
pub(super) fn lines(diagnosis: &Diagnosis, language: Language) -> Vec<Block> {
    let estimates = match &diagnosis.adopted {
        Some(adopted) => &adopted.unknowns,
        None => &diagnosis.unknowns,
    };
    let mut blocks = omitted(&diagnosis.cells, &diagnosis.omitted, estimates, language);
    blocks.extend(choices(diagnosis, estimates, language));
    blocks
}

/// What it costs not to know which explanation is right.
fn choices(diagnosis: &Diagnosis, estimates: &[Estimated], language: Language) -> Option<Block> {
    let slots = diagnosis.examination.slots.iter().zip(&diagnosis.choices);
    let sentences = slots.filter_map(|(slot, u)| {
        let parts = estimates
            .iter()
            .zip(u)
            .filter(|(own, u)| **u > MATTERS * own.u);
        let parts: Vec<String> = parts
            .map(|(own, u)| {
                let name = unknown(&own.name, language);
                format!("{name} {} {}", significant(*u, 2), own.unit)
            })
            .map(|text| text.trim().to_owned())
            .collect();
        let names = language.either(&slot_names(diagnosis, slot, language));
        (!parts.is_empty()).then(|| {
            language.pick(
                format!(
                    "Not to know whether it is {names} costs u: {}.",
                    parts.join(", ")
                ),
                format!("不能判定是 {names} 所带来的 u：{}。", parts.join("，")),
            )
        })
    });
    let sentences: Vec<String> = sentences.collect();
    (!sentences.is_empty()).then_some(Block::List(sentences))
}

/// The same for a diagnosis or a plan.
pub(super) fn omitted(
    cells: &[Cell],
    omitted: &[Omitted],
    estimates: &[Estimated],
    language: Language,
) -> Vec<Block> {
    let u: Vec<f64> = estimates.iter().map(|estimate| estimate.u).collect();
    let dear: Vec<(&Omitted, usize)> = omitted
        .iter()
        .filter_map(|line| line.worst(&u).map(|worst| (line, worst)))
        .filter(|(line, (_, ratio))| line.shift.is_some() && *ratio > MATTERS)
        .map(|(line, (at, _))| (line, at))
        .collect();
    let mut blocks = Vec::new();
    if !dear.is_empty() {
        let mut table = Table::new([
            (language.pick("effect", "影响"), ColumnKind::Wrapped),
            (language.pick("visible", "可见"), ColumnKind::Numbers),
            (
                language.pick("usual shift", "常见大小"),
                ColumnKind::Numbers,
            ),
            (language.pick("parameter", "参数"), ColumnKind::Names),
            ("u", ColumnKind::Numbers),
            (
                language.pick("u without it", "不计此项的 u"),
                ColumnKind::Numbers,
            ),
        ]);
        for (line, at) in dear.iter().take(MOST) {
            table.push(vec![
                full_name(&cells[line.cell], language).into(),
                format!("{} %", percent(line.visibility)).into(),
                line.shift
                    .map_or(String::new(), |s| significant(s, 2))
                    .into(),
                estimates
                    .get(*at)
                    .map_or(String::new(), |e| unknown(&e.name, language))
                    .into(),
                significant(line.after.u[*at], 2).into(),
                significant(u[*at], 2).into(),
            ]);
        }
        blocks.push(Block::Table(table));
        let rest = dear.len().saturating_sub(MOST);
        if rest > 0 {
            blocks.push(Block::Paragraph(language.pick(
                format!("{rest} more are in the JSON."),
                format!("其余 {rest} 项见 JSON。"),
            )));
        }
        blocks.push(Block::Paragraph(
            language
                .pick(
                    "Sizes are uniformly distributed between − and + the usual shift of the output, as far as the recording does not exclude them. State better ones below [diagnosis] typical.",
                    "大小按 ± 常见偏移内的均匀分布计，并扣除记录所排除的部分；可在 [diagnosis] typical 中给出更合适的值。",
                )
                .to_owned(),
        ));
    }
    let hidden: Vec<String> = omitted
        .iter()
        .filter(|line| line.is_invisible() && line.shift.is_none())
        .filter_map(|line| {
            let gains = line.after.gain.iter().zip(&u).map(|(gain, u)| gain.abs() / u);
            let worst = gains.enumerate().filter(|(_, g)| g.is_finite());
            let (at, _) = worst.max_by(|a, b| a.1.total_cmp(&b.1))?;
            let (what, parameter) = (full_name(&cells[line.cell], language), &estimates.get(at)?.name);
            Some(language.pick(
                format!("{what}: hides in {parameter}, {} per unit of the largest shift of the output; no size is usual", significant(line.after.gain[at], 2)),
                format!("{what}：隐藏在 {parameter} 中，输出最大偏移每单位引起 {}；无通常大小", significant(line.after.gain[at], 2)),
            ))
        })
        .take(MOST)
        .collect();
    if !hidden.is_empty() {
        blocks.push(Block::List(hidden));
    }
    if !blocks.is_empty() {
        let title = language.pick(
            "What may be there unseen, and its line in the budget",
            "可能存在而未被看见的影响及其不确定度分量",
        );
        blocks.insert(0, Block::Section(title.into()));
    }
    blocks
}

/// A line for machines.
pub(super) fn omitted_json(
    cells: &[Cell],
    line: &Omitted,
    unknowns: Vec<String>,
    language: Language,
) -> Value {
    let cell = &cells[line.cell];
    let by_unknown = |values: &[f64]| {
        let pairs = unknowns
            .iter()
            .cloned()
            .zip(values.iter().map(|x| finite(*x)));
        pairs.collect::<serde_json::Map<_, _>>()
    };
    json!({
        "effect": full_name(cell, language),
        "id": cell.effect.id.as_str(),
        "variant": cell.variants[line.variation].label,
        "invisible": line.is_invisible(),
        "visibility": finite(line.visibility),
        "usual_shift": line.shift,
        "gain": by_unknown(&line.after.gain),
        "u_declared": by_unknown(&line.before.u),
        "u": by_unknown(&line.after.u),
    })
}

/// What cannot be told apart, and what would help.
pub(super) fn rivals(diagnosis: &Diagnosis, language: Language) -> Vec<Block> {
    if diagnosis.separating.is_empty() {
        return Vec::new();
    }
    let title = match diagnosis
        .separating
        .iter()
        .all(|of| is_alone(diagnosis, of))
    {
        true => language.pick(
            "What would tell near rivals apart for certain",
            "可进一步排除相近解释的补充测量",
        ),
        false => language.pick(
            "What this recording cannot tell apart, and what would",
            "本记录无法区分的解释及所需的补充测量",
        ),
    };
    let mut blocks = vec![Block::Section(title.into())];
    for of in &diagnosis.separating {
        blocks.extend(separating(diagnosis, of, language));
    }
    blocks
}

/// Whether the first stands alone all the same: a rival that looks like it needs more sizes for that.
fn is_alone(diagnosis: &Diagnosis, of: &Separating) -> bool {
    diagnosis.examination.slots[of.slot].state == State::Identified
}

fn separating(diagnosis: &Diagnosis, of: &Separating, language: Language) -> Vec<Block> {
    /// Measurements that are shown.
    const SHOWN: usize = 4;
    /// What decides less often than this is no help.
    const DECIDES: f64 = 0.005;
    let names = of.rivals.iter();
    let names: Vec<String> = names
        .map(|cell| full_name(&diagnosis.cells[*cell], language))
        .collect();
    let same = inseparable(of, &names, language);
    let names = match names.as_slice() {
        [first, others @ ..] if is_alone(diagnosis, of) => {
            let others = others.join(language.pick(", ", "、"));
            language.pick(
                format!("{first}, named alone; {others} could look the same, but is less likely"),
                format!("{first}（唯一列出）；{others} 也可能表现相同，但可能性较小"),
            )
        }
        _ => language.either(&names),
    };
    let kappa = significant(of.kappa, 2);
    let useful: Vec<_> = of
        .extras
        .iter()
        .filter(|(_, worth)| worth.kappa > 1.0 && worth.resolved >= DECIDES)
        .collect();
    if useful.is_empty() {
        return vec![Block::Paragraph(language.pick(
            format!("{names}: κ = {kappa}, and no measurement that is known here is likely to decide. Name others as [[action]]."),
            format!("{names}：κ = {kappa}，已知的补充测量都难以判定；请用 [[action]] 给出其他测量。"),
        ))];
    }
    let mut table = Table::new([
        (
            language.pick("further measurement", "补充测量"),
            ColumnKind::Wrapped,
        ),
        ("κ", ColumnKind::Numbers),
        (language.pick("decides", "可判定"), ColumnKind::Numbers),
        (language.pick("times", "次数"), ColumnKind::Numbers),
        (language.pick("cost", "代价"), ColumnKind::Numbers),
    ]);
    for (extra, worth) in useful.into_iter().take(SHOWN) {
        table.push(vec![
            measure(&extra.measure, language).into(),
            significant(worth.kappa, 2).into(),
            format!("{} %", percent(worth.resolved)).into(),
            significant(worth.repeats.ceil(), 2).into(),
            significant(extra.cost, 2).into(),
        ]);
    }
    vec![
        Block::Paragraph(language.pick(
            format!("{names}: κ = {kappa} as it is.{same} With a further measurement:"),
            format!("{names}：目前 κ = {kappa}。{same}加上补充测量后："),
        )),
        Block::Table(table),
    ]
}

/// Explanations that no measurement of the table tells apart.
fn inseparable(of: &Separating, names: &[String], language: Language) -> String {
    let mut text = String::new();
    let mut classes = of.classes.clone();
    classes.sort_unstable();
    classes.dedup();
    for class in classes {
        let own = names.iter().zip(&of.classes).filter(|(_, c)| **c == class);
        let own: Vec<String> = own.map(|(name, _)| name.clone()).collect();
        if own.len() > 1 {
            let own = language.pick(own.join(" and "), language.list(&own));
            text += &language.pick(
                format!(" What says the same in all of these, and stays undecided: {own}."),
                format!("在所有这些测量中表现相同、仍无法区分的是：{own}。"),
            );
        }
    }
    text
}
