//! The Allan deviation of a recording at rest, and the noises that it shows.

use serde_json::{Value, json};

use super::document::Block;
use super::language::Language;
use super::number::{TABLE_DIGITS, aligned, freedom, grouped, in_unit, probability, significant};
use super::symbol;
use super::table::{ColumnKind, Table};
use super::text::{Page, draw};
use crate::quantity::Unit;
use crate::recording::{Allan, Coefficient, Noises, PowerLaw};

/// Below this probability of χ² the three noises do not explain the deviations.
const DOUBTFUL: f64 = 0.01;

/// An Allan deviation, ready to be shown.
#[derive(Debug, Clone, Copy)]
pub struct AllanReport<'a> {
    /// The recording and the column.
    pub title: &'a str,
    /// Unit of the readings.
    pub unit: &'a Unit,
    /// Unit of the time.
    pub time: &'a Unit,
    /// The deviations.
    pub allan: &'a Allan,
    /// The noises that they show; `None` where there are too few averaging times, or nothing varies.
    pub noises: Option<&'a Noises>,
    /// Language of the sentences and headings.
    pub language: Language,
}

/// The report as lines for a terminal.
pub fn allan_text(report: &AllanReport<'_>, page: Page) -> String {
    draw(&blocks(report), page) + "\n"
}

/// The report as Markdown.
pub fn allan_markdown(report: &AllanReport<'_>) -> String {
    super::markdown::draw(&blocks(report))
}

/// The report for machines: numbers in the units that stand beside them.
pub fn allan_json(report: &AllanReport<'_>) -> Value {
    let points: Vec<Value> = report
        .allan
        .points
        .iter()
        .map(|point| {
            json!({
                "tau": point.tau,
                "deviation": point.deviation,
                "u": point.u,
                "dof": point.dof,
                "interval": point.interval,
                "noise": name(point.noise, Language::English),
            })
        })
        .collect();
    json!({
        "title": report.title,
        "unit": report.unit.symbol,
        "time_unit": report.time.symbol,
        "readings": report.allan.readings,
        "reading_interval": report.allan.interval,
        "coverage_probability": report.allan.probability,
        "points": points,
        "noises": report.noises.map(|noises| json!({
            "white": coefficient_json(noises.white, report, PowerLaw::White),
            "bias_instability": coefficient_json(noises.bias_instability, report, PowerLaw::Flicker),
            "rate_random_walk": coefficient_json(noises.rate_random_walk, report, PowerLaw::RandomWalk),
            "chi_squared": noises.chi_squared,
            "dof": noises.dof,
            "p_value": noises.p_value,
        })),
    })
}

fn coefficient_json(found: Coefficient, report: &AllanReport<'_>, law: PowerLaw) -> Value {
    let unit = unit_of(report, law);
    match found {
        Coefficient::Identified { value, u } => json!({ "value": value, "u": u, "unit": unit }),
        Coefficient::Hidden { limit } => json!({ "limit_95": limit, "unit": unit }),
    }
}

fn blocks(report: &AllanReport<'_>) -> Vec<Block> {
    let l = report.language;
    let mut blocks = vec![
        Block::Title(l.pick(
            format!("Allan deviation of {}", report.title),
            format!("{} 的 阿伦偏差", report.title),
        )),
        Block::Paragraph(data(report)),
        Block::Section(l.pick("Noises", "噪声").into()),
    ];
    match report.noises {
        Some(noises) => {
            blocks.push(Block::Formula(vec![
                "σ²(τ) = N²/τ + B²·2 ln 2/π + K²·τ/3".into(),
            ]));
            blocks.push(Block::Table(coefficients(report, noises)));
            blocks.push(Block::Paragraph(quality(l, noises)));
        }
        None => blocks.push(Block::Paragraph(
            l.pick(
                "The deviations are too few to tell the noises apart, or the readings do not vary.",
                "偏差点数太少，或读数无变化，无法分离噪声。",
            )
            .into(),
        )),
    }
    blocks.push(Block::Section(
        l.pick("Deviations", "各平均时间的偏差").into(),
    ));
    blocks.push(Block::Table(points(report)));
    blocks
}

fn data(report: &AllanReport<'_>) -> String {
    let allan = report.allan;
    let n = grouped(allan.readings as u64);
    let interval = format!("{} {}", significant(allan.interval, 6), symbol(report.time));
    report.language.pick(
        format!("{n} readings, one every {interval}; overlapping estimates at averaging times of 1, 2, 4 … intervals."),
        format!("{n} 个读数，间隔 {interval}；重叠估计，平均时间为 1、2、4……个间隔。"),
    )
}

fn coefficients(report: &AllanReport<'_>, noises: &Noises) -> Table {
    let l = report.language;
    let mut table = Table::new([
        (l.pick("noise", "噪声"), ColumnKind::Names),
        (l.pick("symbol", "符号"), ColumnKind::Words),
        (l.pick("value", "值"), ColumnKind::Numbers),
        ("u", ColumnKind::Numbers),
        (l.pick("unit", "单位"), ColumnKind::Words),
    ]);
    let rows = [
        (
            l.pick(
                "white noise, random walk of the integral",
                "白噪声（积分量的随机游走）",
            ),
            "N",
            noises.white,
            PowerLaw::White,
        ),
        (
            l.pick("bias instability (flicker)", "零偏不稳定性（闪烁噪声）"),
            "B",
            noises.bias_instability,
            PowerLaw::Flicker,
        ),
        (
            l.pick(
                "random walk of the readings",
                "读数的随机游走（速率随机游走）",
            ),
            "K",
            noises.rate_random_walk,
            PowerLaw::RandomWalk,
        ),
    ];
    for (name, letter, found, law) in rows {
        let (value, u) = match found {
            Coefficient::Identified { value, u } => (
                aligned(value, u, TABLE_DIGITS),
                significant(u, TABLE_DIGITS),
            ),
            Coefficient::Hidden { limit } => {
                (format!("< {}", significant(limit, 2)), String::new())
            }
        };
        table.push(vec![
            name.to_string().into(),
            letter.to_string().into(),
            value.into(),
            u.into(),
            unit_of(report, law).into(),
        ]);
    }
    table
}

/// Units of N, B and K.
fn unit_of(report: &AllanReport<'_>, law: PowerLaw) -> String {
    let (unit, time) = (report.unit.typeset(), report.time.typeset());
    let bracketed = match unit.contains(['/', '·', ' ']) {
        true => format!("({unit})"),
        false => unit.clone(),
    };
    match law {
        PowerLaw::White => format!("{bracketed}·√{time}"),
        PowerLaw::Flicker => symbol(report.unit),
        PowerLaw::RandomWalk => format!("{bracketed}/√{time}"),
    }
}

fn quality(l: Language, noises: &Noises) -> String {
    let limits = l.pick(
        "Where the recording does not show a noise, “<” says below what it is with about 95 % probability: the limit is approximate, since Allan variances of few degrees of freedom are not normal.",
        "记录中不显示的噪声以“<”给出约 95 % 概率的上限；自由度小的阿伦方差不服从正态分布，该上限为近似值。",
    );
    let p = significant(noises.p_value, 2);
    match noises.p_value < DOUBTFUL {
        true => l.pick(
            format!("{limits} These noises do not explain the deviations (p = {p}): something else is in the recording, such as a drift, a period or quantisation."),
            format!("{limits} 上述噪声不足以解释各偏差（p = {p}）：记录中可能还有漂移、周期成分或量化。"),
        ),
        false => l.pick(
            format!("{limits} They explain the deviations (p = {p})."),
            format!("{limits} 上述噪声可以解释各偏差（p = {p}）。"),
        ),
    }
}

fn points(report: &AllanReport<'_>) -> Table {
    let l = report.language;
    let p = probability(report.allan.probability);
    let (unit, time) = (symbol(report.unit), symbol(report.time));
    let mut table = Table::new([
        (&*in_unit("τ", &time), ColumnKind::Numbers),
        (&*in_unit("σ(τ)", &unit), ColumnKind::Numbers),
        ("u", ColumnKind::Numbers),
        (
            &*format!("{} {p}", l.pick("from", "下限")),
            ColumnKind::Numbers,
        ),
        (
            &*format!("{} {p}", l.pick("to", "上限")),
            ColumnKind::Numbers,
        ),
        ("ν", ColumnKind::Numbers),
        (l.pick("noise", "噪声"), ColumnKind::Words),
    ]);
    for point in &report.allan.points {
        let number = |x: f64| significant(x, TABLE_DIGITS);
        table.push(vec![
            significant(point.tau, 4).into(),
            aligned(point.deviation, point.u, 2).into(),
            significant(point.u, 2).into(),
            number(point.interval[0]).into(),
            number(point.interval[1]).into(),
            freedom(point.dof).into(),
            name(point.noise, l).to_string().into(),
        ]);
    }
    table
}

fn name(law: PowerLaw, l: Language) -> &'static str {
    match law {
        PowerLaw::White => l.pick("white", "白噪声"),
        PowerLaw::Flicker => l.pick("flicker", "闪烁"),
        PowerLaw::RandomWalk => l.pick("random walk", "随机游走"),
    }
}
