//! What the equations leave of the readings, and what a reader must know.

use super::super::language::{Language, Word};
use super::super::number::{NONE, aligned, freedom, significant};
use super::super::symbol;
use super::sections::{DIGITS, said, shown_u};
use crate::calibrate::{
    Apart, Calibration, Experiment, Limit, Residual, ResponseScatter, Scatter, ScatterTest, Words,
};
use crate::document::Block;
use crate::document::{ColumnKind, Table};

/// More residuals than these are not listed.
const RESIDUALS: usize = 12;

pub(super) fn residuals(experiment: &Experiment, found: &Calibration, l: Language) -> Vec<Block> {
    let mut scatter = Table::new([
        (l.pick("response", "响应量"), ColumnKind::Names),
        (l.pick("readings", "读数"), ColumnKind::Numbers),
        (l.pick("RMS residual", "残差均方根"), ColumnKind::Numbers),
        ("s", ColumnKind::Numbers),
        ("ν", ColumnKind::Numbers),
        (l.pick("s to expect", "预期 s"), ColumnKind::Numbers),
        ("χ²/ν", ColumnKind::Numbers),
        ("p", ColumnKind::Numbers),
        (Word::Unit.of(l), ColumnKind::Names),
    ]);
    for (one, quantity) in found.responses.iter().zip(experiment.equations.responses()) {
        let test = one.test;
        let of_test = |value: &dyn Fn(ScatterTest) -> String| test.map(value).unwrap_or_default();
        scatter.push(vec![
            one.response.as_str().into(),
            one.readings.to_string().into(),
            shown_u(if one.dof > 0.0 { one.rms } else { 0.0 }).into(),
            shown_u(one.s).into(),
            freedom(one.dof).into(),
            of_test(&|test| significant(test.expected, DIGITS)).into(),
            of_test(&|test| significant(test.chi_squared / test.dof, DIGITS)).into(),
            of_test(&|test| significant(test.p_value, 2)).into(),
            symbol(&quantity.unit).into(),
        ]);
    }
    let mut worst: Vec<_> = found.residuals.iter().collect();
    worst.sort_by(|a, b| {
        let size = |r: &Residual| {
            if r.standardised.is_nan() {
                (r.observed - r.fitted).abs()
            } else {
                r.standardised.abs()
            }
        };
        size(b).total_cmp(&size(a))
    });
    let mut table = Table::new([
        (l.pick("point", "测量点"), ColumnKind::Names),
        (l.pick("response", "响应量"), ColumnKind::Names),
        (l.pick("observed", "观测值"), ColumnKind::Numbers),
        (l.pick("equation", "方程值"), ColumnKind::Numbers),
        (l.pick("residual", "残差"), ColumnKind::Numbers),
        (l.pick("residual/s", "标准化残差"), ColumnKind::Numbers),
    ]);
    for one in worst.iter().take(RESIDUALS) {
        let s = found
            .responses
            .iter()
            .find(|r| r.response == one.response)
            .map_or(f64::NAN, |r| if r.rms > 0.0 { r.rms } else { f64::NAN });
        let residual = one.observed - one.fitted;
        table.push(vec![
            said(&one.point, l).into(),
            one.response.as_str().into(),
            aligned(one.observed, s, DIGITS).into(),
            aligned(one.fitted, s, DIGITS).into(),
            significant(residual, DIGITS).into(),
            if one.standardised.is_nan() {
                NONE.to_owned()
            } else {
                significant(one.standardised, 3)
            }
            .into(),
        ]);
    }
    let way = match found.scatter {
        Scatter::Residuals => l.pick(
            "The scatter of the readings in the uncertainties above is the part of the residuals that the stated errors do not explain.",
            "上列不确定度中的读数分散性取残差中已给出误差不能解释的部分。",
        ),
        Scatter::Dwells => l.pick(
            "The scatter of the readings in the uncertainties above is that of the samples of each dwell; compare it with the residuals.",
            "上列不确定度中的读数分散性取自各驻留段的采样；请与残差比较。",
        ),
        Scatter::Stated => l.pick(
            "The uncertainties above contain the stated errors only; the residuals do not enter.",
            "上列不确定度仅含所给出的误差，未计入残差。",
        ),
    };
    let mut blocks = vec![
        Block::Section(l.pick("Residuals", "残差").to_owned()),
        Block::Table(scatter.without_empty_columns()),
        Block::Paragraph(way.to_owned()),
    ];
    if found.responses.iter().all(|one| one.dof == 0.0) {
        // What is left is rounding.
        return blocks;
    }
    blocks.push(Block::Table(table));
    if found.residuals.len() > RESIDUALS {
        blocks.push(Block::Paragraph(l.pick(
            format!(
                "The {RESIDUALS} largest of {}; --json has all.",
                found.residuals.len()
            ),
            format!(
                "共 {} 个残差，列出最大的 {RESIDUALS} 个；全部见 --json。",
                found.residuals.len()
            ),
        )));
    }
    blocks
}

/// Residuals that are larger or smaller than the known errors of the readings let expect. Where the
/// residuals tell the scatter themselves, they may be larger.
fn misfit(one: &ResponseScatter, way: Scatter, sampled: bool, l: Language) -> Option<String> {
    /// Probability of a χ² as far out.
    const RARE: f64 = 0.005;
    let test = one.test?;
    let ratio = significant(test.chi_squared / test.dof, 3);
    let response = &one.response;
    if test.p_value < RARE && way == Scatter::Residuals && sampled {
        let times = significant((test.chi_squared / test.dof).sqrt(), 2);
        Some(l.pick(
            format!("The residuals of {response} are {times} times as large as the samples of the dwells let expect: something changes from dwell to dwell that is still within each, labels or reference values are wrong, or the equations leave something out."),
            format!("{response} 的残差为驻留段采样预期的 {times} 倍：可能有在驻留段内稳定、段间变化的因素，标签或参考值有误，或方程有遗漏。"),
        ))
    } else if test.p_value < RARE && way != Scatter::Residuals {
        let p = significant(test.p_value, 2);
        Some(l.pick(
            format!("The residuals of {response} are larger than the errors of its readings let expect (χ²/ν = {ratio}, p = {p}): the equations leave something out, or the errors are larger than stated. The uncertainties above do not contain this."),
            format!("{response} 的残差大于其读数误差的预期（χ²/ν = {ratio}，p = {p}）：方程有遗漏，或误差大于所给出的值。上列不确定度未包含这一差异。"),
        ))
    } else if test.p_value > 1.0 - RARE {
        Some(l.pick(
            format!("The residuals of {response} are smaller than the errors of its readings let expect (χ²/ν = {ratio}): these errors may be stated too large, or be common to the readings."),
            format!("{response} 的残差小于其读数误差的预期（χ²/ν = {ratio}）：误差可能给得过大，或为各读数共有。"),
        ))
    } else {
        None
    }
}

fn in_list(points: &[Words], l: Language) -> String {
    let points: Vec<String> = points.iter().map(|point| said(point, l)).collect();
    points.join(l.pick(", ", "、"))
}

fn at_limit(limit: &Limit, l: Language) -> String {
    let (response, points) = (&limit.response, in_list(&limit.points, l));
    let value = significant(limit.value, 6);
    l.pick(
        format!("{response} is {value} in {points}, although its equation differs there: the instrument looks saturated, and these points bend the coefficients. Leave them out, or measure in a larger range."),
        format!("{response} 在 {points} 均为 {value}，而方程值不同：仪器疑似饱和，这些点会使系数失真。请剔除这些点或换大量程测量。"),
    )
}

/// Readings that look exchanged, and which others instead.
fn exchanged(pairs: &[[Words; 2]], l: Language) -> Option<String> {
    let both = |pair: &[Words; 2]| {
        let [first, second] = pair.each_ref().map(|point| said(point, l));
        l.pick(
            format!("{first} and {second}"),
            format!("{first} 与 {second}"),
        )
    };
    let (first, others) = pairs.split_first()?;
    let mut which = both(first);
    if !others.is_empty() {
        let others: Vec<String> = others.iter().map(both).collect();
        which += &l.pick(
            format!(" (or those of {})", others.join(", or of ")),
            format!("（或 {}）", others.join("、或 ")),
        );
    }
    Some(l.pick(
        format!("The readings of {which} look exchanged: with each in the other's place the residuals would be less than a tenth of what they are. Check the labels before using these figures."),
        format!("{which} 的读数疑似互换：交换后残差不到现在的十分之一。使用结果前请核对标签。"),
    ))
}

/// Coefficients with another sign than those like them.
fn reversed(names: &[String], l: Language) -> Option<String> {
    let listed = names.join(l.pick(", ", "、"));
    (!names.is_empty()).then(|| l.pick(
        format!("The sign of {listed} is another than that of the other axes: the two ways of this axis may be exchanged in the labels, or the sensor is mounted or read reversed. Check the labels before using these figures."),
        format!("{listed} 的符号与其他轴相反：该轴正、反两个方向的标签可能互换，或传感器安装、读出极性相反。使用结果前请核对标签。"),
    ))
}

fn stands_apart(one: &Apart, l: Language) -> String {
    let (response, point) = (&one.response, said(&one.point, l));
    let times = if one.t.is_finite() {
        significant(one.t, 2)
    } else {
        "∞".to_owned()
    };
    l.pick(
        format!("{response} in {point} stands apart: its residual is {times} times the standard deviation that the others give it. Find out why before using these figures: a wrong reading, a wrong label, or something that the equations leave out."),
        format!("{point} 的 {response} 明显离群：其残差为其余各点所给标准偏差的 {times} 倍。使用结果前请查明原因：读数或标签有误，或方程有遗漏。"),
    )
}

/// What a reader must know.
pub(super) fn remarks(
    experiment: &Experiment,
    found: Option<&Calibration>,
    assumed: &[String],
    l: Language,
) -> Vec<Block> {
    let mut items: Vec<String> = Vec::new();
    for finding in &experiment.points.findings {
        items.push(l.pick(
            format!("{}; {}.", finding.message(), finding.advice()),
            format!("{}；{}。", finding.message_zh(), finding.advice_zh()),
        ));
    }
    if let Some(found) = found {
        if found.left_out > 0 {
            items.push(l.pick(
                match found.left_out {
                    1 => "1 reading was left out, because a value is missing.".to_owned(),
                    count => {
                        format!("{count} readings were left out, because a value is missing.")
                    }
                },
                format!("有 {} 个读数因缺值而未使用。", found.left_out),
            ));
        }
        items.extend(exchanged(&found.swapped, l));
        items.extend(reversed(&found.reversed, l));
        items.extend(found.apart.iter().map(|one| stands_apart(one, l)));
        items.extend(found.limits.iter().map(|limit| at_limit(limit, l)));
        if !found.linear {
            items.push(l.pick(
                "The equations are not linear in the parameters: uncertainties and written budgets are of first order in the errors.",
                "方程对参数非线性：不确定度以及写出的预算取误差的一阶近似。",
            ).to_owned());
        }
        let columns = &experiment.points.columns;
        let sampled = columns.iter().any(|column| !column.averages.is_empty());
        let misfit = |one: &ResponseScatter| misfit(one, found.scatter, sampled, l);
        items.extend(found.responses.iter().filter_map(misfit));
    }
    if !assumed.is_empty() {
        let names = assumed.join(", ");
        items.push(l.pick(
            format!("No values of {names} are stated, and zero was assumed: effects that are proportional to them are not seen. State roughly what is expected: [parameter.{}] start = ….", assumed[0]),
            format!("{names} 未给出数值，按零计算：与之成比例的效应未体现。请给出预期值：[parameter.{}] start = …。", assumed[0]),
        ));
    }
    let said = experiment
        .remarks
        .iter()
        .map(|remark| l.pick(remark.en.clone(), remark.zh.clone()));
    items.extend(said);
    if items.is_empty() {
        return Vec::new();
    }
    vec![
        Block::Section(Word::Remarks.of(l).to_owned()),
        Block::List(items),
    ]
}
