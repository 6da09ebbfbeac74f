//! The improved model: its terms, how much better it describes the recording, and what it changes in the
//! parameters.

use crate::diagnose::case::Case;
use crate::diagnose::{Adopted, Diagnosis, Estimated, HeldOutQuality, Quality};
use crate::document::Block;
use crate::document::{ColumnKind, Table};
use crate::language::Language;
use crate::number::{aligned, freedom, in_unit, significant};
use crate::special::chi_squared_sf;
use crate::symbol;

use super::labels::spoken;
use super::words::{self, p_is};

/// Before and after.
pub(super) fn blocks(case: &Case, diagnosis: &Diagnosis, language: Language) -> Vec<Block> {
    let before = &diagnosis.before;
    let after = diagnosis.adopted.as_ref().map(|adopted| &adopted.quality);
    let mut blocks = vec![Block::Section(
        match after {
            Some(_) => language.pick("Before and after", "改进前后"),
            None => language.pick("Agreement of the model", "模型的符合程度"),
        }
        .into(),
    )];
    if let Some(adopted) = &diagnosis.adopted {
        blocks.push(Block::Formula(improved_model(adopted)));
        blocks.push(Block::Table(coefficients(adopted, language)));
        blocks.extend(signal(adopted, language));
    }
    blocks.push(Block::Table(qualities(
        case, diagnosis, before, after, language,
    )));
    if let Some(adopted) = &diagnosis.adopted {
        blocks.extend(confirmation(adopted, language));
    }
    blocks.extend(badly_predicted(case, diagnosis, language));
    blocks
}

fn improved_model(adopted: &Adopted) -> Vec<String> {
    let mut lines: Vec<String> = adopted
        .extended
        .case
        .model
        .iter()
        .flat_map(|model| model.lines().map(str::to_owned).collect::<Vec<_>>())
        .collect();
    for addition in &adopted.extended.additions {
        lines.push(format!("{} = {}", addition.column, addition.text));
    }
    lines
}

fn coefficients(adopted: &Adopted, language: Language) -> Table {
    let mut table = Table::new([
        (language.pick("size", "大小"), ColumnKind::Names),
        (language.pick("multiplies", "乘以"), ColumnKind::Wrapped),
        (language.pick("estimate", "估计值"), ColumnKind::Numbers),
        ("u", ColumnKind::Numbers),
        (language.pick("unit", "单位"), ColumnKind::Names),
    ]);
    for (estimated, addition) in adopted.coefficients.iter().zip(&adopted.extended.additions) {
        table.push(vec![
            estimated.name.as_str().into(),
            addition.text.as_str().into(),
            aligned(estimated.value, estimated.u, 2).into(),
            significant(estimated.u, 2).into(),
            estimated.unit.as_str().into(),
        ]);
    }
    table
}

/// What the formulas call the signal, where they do.
fn signal(adopted: &Adopted, language: Language) -> Option<Block> {
    let mut additions = adopted.extended.additions.iter();
    let named = additions.any(|addition| addition.text.contains("signal"));
    named.then(|| {
        Block::Paragraph(
            language
                .pick(
                    "signal: what the fitted declared model gives besides constant terms.",
                    "signal：已拟合的声明模型中除常数项以外的部分。",
                )
                .to_owned(),
        )
    })
}

fn qualities(
    case: &Case,
    diagnosis: &Diagnosis,
    before: &Quality,
    after: Option<&Quality>,
    language: Language,
) -> Table {
    let mut table = Table::new([
        ("", ColumnKind::Names),
        (
            language.pick("declared model", "声明的模型"),
            ColumnKind::Numbers,
        ),
        (
            if after.is_some() {
                language.pick("with the physics", "加入遗漏效应后")
            } else {
                ""
            },
            ColumnKind::Numbers,
        ),
    ]);
    let cell = |value: Option<f64>| value.map_or(String::new(), |value| significant(value, 3));
    for (index, response) in case.responses.iter().enumerate() {
        let unit = symbol(&response.unit);
        let label = |what: &str| {
            in_unit(
                &format!("{what}{}{}", language.pick(", ", "，"), response.name),
                &unit,
            )
        };
        table.push(vec![
            label(language.pick("residual RMS", "残差均方根")).into(),
            cell(before.residual.get(index).copied()).into(),
            cell(after.and_then(|after| after.residual.get(index).copied())).into(),
        ]);
        if !diagnosis.noise.is_estimated() {
            table.push(vec![
                label(language.pick("expected noise", "预期噪声")).into(),
                cell(before.expected.get(index).copied()).into(),
                cell(after.and_then(|after| after.expected.get(index).copied())).into(),
            ]);
        }
        table.push(vec![
            label(language.pick("error predicting held-out rows", "留出数据的预测误差")).into(),
            cell(before.held_out.get(index).copied()).into(),
            cell(after.and_then(|after| after.held_out.get(index).copied())).into(),
        ]);
    }
    if let Some(held) = &diagnosis.held_out {
        held_out(&mut table, case, held, language);
    }
    if !diagnosis.noise.is_estimated() {
        table.push(vec![
            "χ²/ν".into(),
            significant(before.chi_squared / before.dof, 3).into(),
            cell(after.map(|after| after.chi_squared / after.dof)).into(),
        ]);
    }
    table.push(vec![
        language.pick("degrees of freedom", "自由度").into(),
        freedom(before.dof).into(),
        after
            .map_or(String::new(), |after| freedom(after.dof))
            .into(),
    ]);
    table.without_empty_columns()
}

/// Prediction of the recording that was held out.
fn held_out(table: &mut Table, case: &Case, held: &HeldOutQuality, language: Language) {
    let after = held.after.as_ref();
    for (index, response) in case.responses.iter().enumerate() {
        let unit = symbol(&response.unit);
        let expected = significant(held.expected[index], 3);
        let label = language.pick(
            format!(
                "error predicting {} (noise {expected}), {}",
                held.file, response.name
            ),
            format!(
                "对 {} 的预测误差（噪声 {expected}），{}",
                held.file, response.name
            ),
        );
        table.push(vec![
            in_unit(&label, &unit).into(),
            significant(held.before.rms[index], 3).into(),
            after
                .map_or(String::new(), |p| significant(p.rms[index], 3))
                .into(),
        ]);
    }
    let count = held.observations as f64;
    table.push(vec![
        language
            .pick(
                format!("χ²/n of that prediction, n = {}", held.observations),
                format!("该预测的 χ²/n，n = {}", held.observations),
            )
            .into(),
        significant(held.before.chi_squared / count, 3).into(),
        after
            .map_or(String::new(), |p| significant(p.chi_squared / count, 3))
            .into(),
    ]);
}

/// A remark where the recording that was held out is predicted worse than the noise allows.
fn badly_predicted(case: &Case, diagnosis: &Diagnosis, language: Language) -> Option<Block> {
    let held = diagnosis.held_out.as_ref()?;
    let best = held.after.as_ref().unwrap_or(&held.before);
    let p = chi_squared_sf(best.chi_squared, held.observations as f64);
    let known = !diagnosis.noise.is_estimated();
    (known && p < case.settings.alpha).then(|| {
        Block::Paragraph(language.pick(
            format!("{} is predicted worse than the noise allows ({}): its conditions show something that those of the recording do not. Diagnose it too.", held.file, p_is(p)),
            format!("对 {} 的预测误差超出噪声（{}）：其条件显示出本记录未显示的影响，请对其也进行诊断。", held.file, p_is(p)),
        ))
    })
}

fn confirmation(adopted: &Adopted, language: Language) -> Vec<Block> {
    let parts: Vec<String> = adopted
        .confirmation
        .parts
        .iter()
        .map(|(part, value, u)| {
            let part = spoken(part, language);
            let size = format!("{} ± {}", aligned(*value, *u, 2), significant(*u, 2));
            language.pick(format!("{part}: {size}"), format!("{part}：{size}"))
        })
        .collect();
    let (Some(first), false) = (adopted.coefficients.first(), parts.is_empty()) else {
        return Vec::new();
    };
    let agreement = (adopted.confirmation.agreement).map_or(String::new(), |p| agree(p, language));
    vec![Block::Paragraph(language.pick(
        format!(
            "{} from parts of the recording: {}{agreement}.",
            first.name,
            parts.join(", ")
        ),
        format!(
            "由记录各部分得到的 {}：{}{agreement}。",
            first.name,
            parts.join("，")
        ),
    ))]
}

/// Whether parts agree that differ as much by chance with probability `p`.
fn agree(p: f64, language: Language) -> String {
    /// From here on they agree …
    const AGREE: f64 = 0.05;
    /// … and below it they do not.
    const DIFFER: f64 = 0.01;
    let is = p_is(p);
    if p >= AGREE {
        language.pick(
            format!("; they agree ({is})"),
            format!("；各部分一致（{is}）"),
        )
    } else if p >= DIFFER {
        language.pick(
            format!("; it is doubtful whether they agree ({is})"),
            format!("；各部分是否一致存疑（{is}）"),
        )
    } else {
        language.pick(
            format!("; they do not agree ({is})"),
            format!("；各部分不一致（{is}）"),
        )
    }
}

/// The parameters before and after, and with what may be there unseen.
pub(super) fn parameters(diagnosis: &Diagnosis, language: Language) -> Vec<Block> {
    /// Longer lists, one for each label, are in the JSON.
    const MOST: usize = 30;
    let mut table = Table::new([
        (language.pick("parameter", "参数"), ColumnKind::Names),
        (
            language.pick("declared model", "声明的模型"),
            ColumnKind::Numbers,
        ),
        ("u", ColumnKind::Numbers),
        (
            if diagnosis.adopted.is_some() {
                language.pick("with the physics", "加入遗漏效应后")
            } else {
                ""
            },
            ColumnKind::Numbers,
        ),
        (
            if diagnosis.adopted.is_some() { "u" } else { "" },
            ColumnKind::Numbers,
        ),
        (
            language.pick("u with unseen", "计入未见影响的 u"),
            ColumnKind::Numbers,
        ),
        (language.pick("unit", "单位"), ColumnKind::Names),
    ]);
    let unseen = diagnosis.u_with_unseen();
    for (index, unknown) in diagnosis.unknowns.iter().take(MOST).enumerate() {
        let after: Option<&Estimated> = diagnosis
            .adopted
            .as_ref()
            .and_then(|adopted| adopted.unknowns.get(index));
        table.push(vec![
            words::unknown(&unknown.name, language).into(),
            words::estimate(unknown).into(),
            significant(unknown.u, 2).into(),
            after.map_or(String::new(), words::estimate).into(),
            after
                .map_or(String::new(), |after| significant(after.u, 2))
                .into(),
            unseen
                .get(index)
                .map_or(String::new(), |u| significant(*u, 2))
                .into(),
            unknown.unit.as_str().into(),
        ]);
    }
    vec![
        Block::Section(
            language
                .pick(
                    "What it changes in the result and its uncertainty",
                    "对结果及其不确定度的影响",
                )
                .into(),
        ),
        Block::Table(table.without_empty_columns()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_agree_as_their_probability_says() {
        let said = [0.44, 0.03, 0.0085].map(|p| agree(p, Language::English));
        assert_eq!(said[0], "; they agree (p = 0.44)");
        assert!(said[1].starts_with("; it is doubtful"), "{}", said[1]);
        assert_eq!(said[2], "; they do not agree (p = 0.0085)");
        let said = [0.44, 0.0085].map(|p| agree(p, Language::Chinese));
        assert!(said[0].contains("一致") && said[1].contains("不一致"));
    }
}
