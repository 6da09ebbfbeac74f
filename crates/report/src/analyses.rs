//! What the readings say of themselves: statistics, analyses of variance, tests for outliers.

use gumption_core::quantity::Decimal;
use gumption_core::statistics::{Line, OutlierTest, Policy, Ratio, Verdict};
use gumption_fault::say;
use gumption_gum::budget::{Analysis, Anova, Finding, NestedAnova, Outlier, Statistics};
use gumption_gum::propagate::is_residue;

use super::language::{Language, Word};
use super::number::{
    NONE, TABLE_DIGITS, aligned, at_place, exact, freedom, in_unit, print, significant,
};
use super::{Report, symbol};
use gumption_format::document::Block;
use gumption_format::document::{Cell, ColumnKind, Row, Table};

/// Series of readings that are shown; more of them are in the JSON output.
const MOST: usize = 40;

/// One section for all series of readings, one for each analysis of variance.
pub(super) fn blocks(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let mut blocks = series(report);
    for analysis in &report.budget.analyses {
        match &analysis.found {
            Finding::Anova(found) => blocks.extend(one_way(analysis, found, l)),
            Finding::Nested(found) => blocks.extend(nested(analysis, found, l)),
            Finding::Readings(_) | Finding::Outlier(_) => {}
        }
    }
    blocks
}

fn series(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let found = || {
        let analyses = report.budget.analyses.iter();
        analyses.filter_map(|analysis| match &analysis.found {
            Finding::Readings(statistics) => Some((analysis, statistics)),
            _ => None,
        })
    };
    let count = found().count();
    if count == 0 {
        return Vec::new();
    }
    let mut table = Table::new([
        (Word::Component.of(l), ColumnKind::Names),
        ("n", ColumnKind::Numbers),
        (l.pick("mean", "平均值"), ColumnKind::Numbers),
        ("s", ColumnKind::Numbers),
        (Word::Unit.of(l), ColumnKind::Words),
        (l.pick("least", "最小值"), ColumnKind::Numbers),
        (l.pick("greatest", "最大值"), ColumnKind::Numbers),
        (l.pick("lag-1 r", "一阶自相关"), ColumnKind::Numbers),
        ("n_eff", ColumnKind::Numbers),
    ]);
    for (analysis, statistics) in found().take(MOST) {
        table.push(row(analysis, statistics));
    }
    if count > MOST {
        let more = count - MOST;
        table.rows.push(Row::Across(
            say!("… and {more} more; all are in the JSON output").in_language(l),
        ));
    }
    let mut blocks = vec![
        Block::Section(l.pick("Readings", "重复观测").to_string()),
        Block::Table(table.without_empty_columns()),
    ];
    let tests: Vec<String> = report
        .budget
        .analyses
        .iter()
        .filter_map(|analysis| match &analysis.found {
            Finding::Outlier(outlier) => Some(tested(analysis, outlier, l)),
            _ => None,
        })
        .collect();
    if !tests.is_empty() {
        blocks.push(Block::List(tests));
    }
    blocks
}

fn row(analysis: &Analysis, found: &Statistics) -> Vec<Cell> {
    let scale = found.s / (found.n as f64).sqrt();
    let mean = match is_residue(found.mean, scale) {
        true => 0.0,
        false => found.mean,
    };
    let [least, greatest] = alike([found.min, found.max]);
    vec![
        analysis.name.clone().into(),
        found.n.to_string().into(),
        aligned(mean, scale, 2).into(),
        significant(found.s, TABLE_DIGITS).into(),
        symbol(&analysis.unit).into(),
        least.into(),
        greatest.into(),
        coefficient(found.lag1).into(),
        found.effective.map_or(Cell::Empty, |n| freedom(n).into()),
    ]
}

/// Two readings, each with the decimals of both: 150.00 beside 150.02.
fn alike(readings: [f64; 2]) -> [String; 2] {
    let places = readings.map(|x| Decimal::from_f64(x).place());
    match places.into_iter().flatten().min() {
        Some(place) if place < 0 => readings.map(|x| print(&at_place(x, place))),
        _ => readings.map(exact),
    }
}

fn coefficient(r: f64) -> String {
    print(&at_place(r, -2))
}

fn probability(p: f64) -> String {
    if p < 5e-5 {
        return "<0.0001".into();
    }
    print(&at_place(p, -4))
}

fn tested(analysis: &Analysis, outlier: &Outlier, l: Language) -> String {
    let test = match outlier.test {
        OutlierTest::Grubbs => l.pick("Grubbs' test", "格拉布斯检验"),
        OutlierTest::Dixon => l.pick("Dixon's test", "狄克逊检验"),
        OutlierTest::DixonQ => l.pick("Dixon's Q test", "狄克逊 Q 检验"),
        OutlierTest::FourMeanDeviations => l.pick("Test by four mean deviations", "4d 检验"),
        OutlierTest::ThreeSigma => l.pick("Test by three standard deviations", "3s 检验"),
    };
    let (name, value) = (&analysis.name, exact(outlier.value));
    let place = outlier.suspect.place + 1;
    let statistic = significant(outlier.suspect.statistic, 4);
    let critical = significant(outlier.suspect.critical, 4);
    let level = outlier
        .significance
        .map(|level| exact(100.0 * level))
        .map_or(String::new(), |level| say!(" at {level} %").in_language(l));
    match (outlier.suspect.is_outlier(), l) {
        (true, Language::English) => format!(
            "{test}: reading {place} of {name}, {value}, is an outlier (statistic {statistic}, critical value {critical}{level}). It is kept; find out what happened when it was taken."
        ),
        (true, Language::Chinese) => format!(
            "{test}：{name} 的第 {place} 个读数 {value} 为离群值（统计量 {statistic}，临界值 {critical}{level}）。读数未被剔除，请查明原因。"
        ),
        (false, Language::English) => format!(
            "{test}: no reading of {name} is an outlier; the most outlying is reading {place}, {value} (statistic {statistic}, critical value {critical}{level})."
        ),
        (false, Language::Chinese) => format!(
            "{test}：{name} 中未发现离群值；偏离最大的是第 {place} 个读数 {value}（统计量 {statistic}，临界值 {critical}{level}）。"
        ),
    }
}

fn head(analysis: &Analysis, l: Language) -> Block {
    let name = &analysis.name;
    Block::Section(say!("Analysis of variance of {name}").in_language(l))
}

fn empty(analysis: &Analysis, significance: f64, l: Language) -> Table {
    let squared = analysis.unit.difference().powr(2, 1);
    let unit = squared.map_or_else(String::new, |unit| symbol(&unit));
    let in_unit = |words: &str| in_unit(words, &unit);
    let level = exact(100.0 * significance);
    Table::new([
        (l.pick("source of variation", "变差来源"), ColumnKind::Words),
        (
            in_unit(l.pick("sum of squares", "平方和")).as_str(),
            ColumnKind::Numbers,
        ),
        ("ν", ColumnKind::Numbers),
        (
            in_unit(l.pick("mean square", "均方")).as_str(),
            ColumnKind::Numbers,
        ),
        ("F", ColumnKind::Numbers),
        ("p", ColumnKind::Numbers),
        (
            say!("critical F, {level} %").in_language(l).as_str(),
            ColumnKind::Numbers,
        ),
    ])
}

fn push(table: &mut Table, name: &str, line: &Line, ratio: Option<(&Ratio, f64)>) {
    let mut cells: Vec<Cell> = vec![
        name.into(),
        significant(line.ss, 4).into(),
        freedom(line.df).into(),
        significant(line.ms, 4).into(),
    ];
    if let Some((ratio, significance)) = ratio {
        cells.extend([
            significant(ratio.f, 4).into(),
            probability(ratio.p()).into(),
            significant(ratio.critical(1.0 - significance), 4).into(),
        ]);
    }
    table.push(cells);
}

fn one_way(analysis: &Analysis, found: &Anova, l: Language) -> Vec<Block> {
    let mut table = empty(analysis, found.significance, l);
    let tests = (&found.table.ratio(), found.significance);
    let (between, within) = (
        l.pick("between groups", "组间"),
        l.pick("within groups", "组内"),
    );
    push(&mut table, between, &found.table.between, Some(tests));
    push(&mut table, within, &found.table.within, None);
    let unit = symbol(&analysis.unit);
    let amount = |s: f64| amount(s, &unit);
    let fields = vec![
        (
            l.pick("readings, groups", "读数个数，组数").to_string(),
            format!("{}, {}", found.table.readings, found.table.groups),
        ),
        (
            l.pick("repeatability (within groups)", "重复性标准差（组内）")
                .to_string(),
            format!("s_r = {}", amount(found.table.within.ms.sqrt())),
        ),
        (
            l.pick("between groups", "组间标准差").to_string(),
            format!("s_B = {}", amount(found.s_between())),
        ),
        (
            l.pick("reproducibility of one reading", "单次读数的复现性标准差")
                .to_string(),
            format!("s_R = {}", amount(found.reproducibility())),
        ),
    ];
    let sentence = sentence(
        found.verdict,
        found.policy,
        l.pick("between groups", "组间"),
        l,
    );
    vec![
        head(analysis, l),
        Block::Table(table),
        Block::Fields(fields),
        Block::Paragraph(sentence),
    ]
}

fn nested(analysis: &Analysis, found: &NestedAnova, l: Language) -> Vec<Block> {
    let mut table = empty(analysis, found.significance, l);
    let groups = l.pick("between groups", "组间");
    let subgroups = l.pick("between subgroups", "子组间");
    let level = found.significance;
    let (top, middle) = (found.table.top_ratio(), found.table.middle_ratio());
    push(&mut table, groups, &found.table.top, Some((&top, level)));
    push(
        &mut table,
        subgroups,
        &found.table.middle,
        Some((&middle, level)),
    );
    let within = l.pick("within subgroups", "子组内");
    push(&mut table, within, &found.table.within, None);
    let unit = symbol(&analysis.unit);
    let [s_top, s_middle, s_within] = found.standard_deviations();
    let fields = [(groups, s_top), (subgroups, s_middle), (within, s_within)]
        .map(|(name, s)| {
            let label = say!("standard deviation {name}").in_language(l);
            (label, amount(s, &unit))
        })
        .to_vec();
    vec![
        head(analysis, l),
        Block::Table(table),
        Block::Fields(fields),
        Block::List(vec![
            sentence(found.verdicts.middle, found.policy, subgroups, l),
            sentence(found.verdicts.top, found.policy, groups, l),
        ]),
    ]
}

fn amount(s: f64, unit: &str) -> String {
    let number = if s.is_finite() {
        significant(s, TABLE_DIGITS)
    } else {
        NONE.to_string()
    };
    format!("{number} {unit}").trim_end().to_string()
}

/// What was done with a difference, and why.
fn sentence(verdict: Verdict, policy: Policy, between: &str, l: Language) -> String {
    match (verdict, l) {
        (Verdict::Included, Language::English) => {
            let why = match policy {
                Policy::Test => ", as the F test finds it",
                Policy::Include | Policy::Ignore => "",
            };
            format!("The variance {between} is part of u{why}.")
        }
        (Verdict::Included, Language::Chinese) => format!("u 包含{between}方差。"),
        (Verdict::Negative, Language::English) => format!(
            "The variance {between} comes out negative and is taken as zero; the readings are pooled."
        ),
        (Verdict::Negative, Language::Chinese) => {
            format!("{between}方差的估计为负，取为零；读数合并评定。")
        }
        (Verdict::NotSignificant, Language::English) => {
            format!("The F test finds no difference {between}; the readings are pooled.")
        }
        (Verdict::NotSignificant, Language::Chinese) => {
            format!("F 检验未发现{between}差异显著；读数合并评定。")
        }
        (Verdict::Ignored, Language::English) => {
            format!("A difference {between} is excluded by the file; the readings are pooled.")
        }
        (Verdict::Ignored, Language::Chinese) => {
            format!("文件规定不计{between}差异；读数合并评定。")
        }
    }
}

/// Stable names for machines: what was analysed, and what was done with the differences.
pub(super) fn codes(found: &Finding) -> (&'static str, Vec<&'static str>) {
    let done = |verdict: &Verdict| match verdict {
        Verdict::Included => "included",
        Verdict::Negative => "negative",
        Verdict::NotSignificant => "not-significant",
        Verdict::Ignored => "ignored",
    };
    match found {
        Finding::Readings(_) => ("readings", Vec::new()),
        Finding::Anova(found) => ("anova", vec![done(&found.verdict)]),
        Finding::Nested(found) => (
            "nested-anova",
            vec![done(&found.verdicts.top), done(&found.verdicts.middle)],
        ),
        Finding::Outlier(found) => (
            match found.test {
                OutlierTest::Grubbs => "outlier-grubbs",
                OutlierTest::Dixon => "outlier-dixon",
                OutlierTest::DixonQ => "outlier-dixon-q",
                OutlierTest::FourMeanDeviations => "outlier-4d",
                OutlierTest::ThreeSigma => "outlier-3s",
            },
            vec![if found.suspect.is_outlier() {
                "outlier"
            } else {
                "none"
            }],
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_and_greatest_have_the_same_decimals() {
        assert_eq!(alike([150.0, 150.02]), ["150.00", "150.02"]);
        assert_eq!(alike([1.0, 1.0003]), ["1.0000", "1.0003"]);
        assert_eq!(alike([358.0, 365.0]), ["358", "365"]);
    }
}
