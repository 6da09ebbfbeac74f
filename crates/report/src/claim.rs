//! What a certificate claims beside what the evaluation gives.

use gumption_core::quantity::{Decimal, to_digits};
use gumption_fault::say;
use gumption_gum::budget::{Claim, Figure, Part};
use gumption_gum::propagate::{Comparison, Method, compare_claims};

use super::Report;
use super::language::{Language, Word};
use super::number::{NONE, at_place, exact, print, significant};
use gumption_format::document::Block;
use gumption_format::document::{Cell, ColumnKind, Row, Table};

/// Stable name of a figure for machines.
pub(super) fn code(what: &Figure) -> &'static str {
    match what {
        Figure::Estimate => "value",
        Figure::StandardUncertainty => "standard_uncertainty",
        Figure::ExpandedUncertainty => "expanded_uncertainty",
        Figure::RelativeUncertainty => "relative_standard_uncertainty",
        Figure::RelativeExpanded => "relative_expanded_uncertainty",
        Figure::Variance => "variance",
        Figure::Covariance(_) => "covariance",
        Figure::CoverageFactor => "coverage_factor",
        Figure::DegreesOfFreedom => "effective_degrees_of_freedom",
        Figure::CoverageProbability => "coverage_probability",
        Figure::Lower => "interval_low",
        Figure::Upper => "interval_high",
        Figure::ShortestLower => "shortest_low",
        Figure::ShortestUpper => "shortest_high",
        Figure::AtLeast => "at_least",
        Figure::AtMost => "at_most",
        Figure::Shift => "shift",
        Figure::Correlation(_) => "correlation",
        Figure::Ellipsoid => "region_ellipsoid",
        Figure::Rectangle => "region_rectangle",
        Figure::RegionFreedom => "region_degrees_of_freedom",
        Figure::Validated(1) => "validated_1",
        Figure::Validated(_) => "validated_2",
        Figure::Input(_, part) | Figure::Component(_, part) => match part {
            Part::Estimate => "input_value",
            Part::StandardUncertainty => "input_standard_uncertainty",
            Part::DegreesOfFreedom => "input_degrees_of_freedom",
            Part::Sensitivity => "input_sensitivity",
            Part::Contribution => "input_contribution",
        },
        Figure::Named(_) => "figure",
    }
}

/// The input, component or other measurand that a figure is about, if it is about one.
pub(super) fn subject<'a>(report: &Report<'a>, what: &Figure) -> Option<&'a str> {
    let budget = report.budget;
    match what {
        Figure::Input(index, _) => budget.inputs.get(*index).map(|input| input.name.as_str()),
        Figure::Component(index, _) => budget.components.get(*index).map(|c| c.name.as_str()),
        Figure::Correlation(with) | Figure::Covariance(with) => {
            budget.measurands.get(*with).map(|m| m.name.as_str())
        }
        Figure::Named(name) => (report.evaluation.figures.iter())
            .find(|figure| figure.name == *name)
            .map(|figure| figure.name.as_str()),
        _ => None,
    }
}

/// A figure in words.
pub(super) fn label(report: &Report<'_>, what: &Figure) -> String {
    let l = report.language;
    let plain = match what {
        Figure::Estimate => Word::Estimate.of(l),
        Figure::StandardUncertainty => Word::StandardUncertainty.of(l),
        Figure::ExpandedUncertainty => Word::ExpandedUncertainty.of(l),
        Figure::RelativeUncertainty => l.pick("u/|y|", "u/|y|"),
        Figure::RelativeExpanded => l.pick("U/|y|", "U/|y|"),
        Figure::Variance => l.pick("variance u²", "方差 u²"),
        Figure::Covariance(_) => l.pick("covariance with", "协方差，与"),
        Figure::CoverageFactor => Word::CoverageFactor.of(l),
        Figure::DegreesOfFreedom => Word::FreedomEffective.of(l),
        Figure::CoverageProbability => l.pick("coverage probability", "包含概率"),
        Figure::Lower => l.pick("interval, lower end", "包含区间下限"),
        Figure::Upper => l.pick("interval, upper end", "包含区间上限"),
        Figure::ShortestLower => l.pick("shortest interval, lower end", "最短包含区间下限"),
        Figure::ShortestUpper => l.pick("shortest interval, upper end", "最短包含区间上限"),
        Figure::AtLeast => l.pick("one-sided interval, at least", "单侧包含区间下限"),
        Figure::AtMost => l.pick("one-sided interval, at most", "单侧包含区间上限"),
        Figure::Shift => l.pick("shift of the estimate", "估计值的偏移"),
        Figure::Correlation(_) => l.pick("correlation with", "相关系数，与"),
        Figure::Ellipsoid => l.pick("factor of the ellipsoid", "椭球包含因子"),
        Figure::Rectangle => l.pick("factor of the rectangle", "矩形域包含因子"),
        Figure::RegionFreedom => l.pick("ν of the covariance", "协方差的自由度"),
        Figure::Validated(1) => l.pick("validated at 1 digit", "一位有效数字时验证通过"),
        Figure::Validated(_) => l.pick("validated at 2 digits", "两位有效数字时验证通过"),
        Figure::Input(_, part) | Figure::Component(_, part) => match part {
            Part::Estimate => Word::Estimate.of(l),
            Part::StandardUncertainty => "u",
            Part::DegreesOfFreedom => "ν",
            Part::Sensitivity => "c",
            Part::Contribution => "|c|·u",
        },
        Figure::Named(name) => return name.clone(),
    };
    match subject(report, what) {
        Some(name) if matches!(what, Figure::Correlation(_) | Figure::Covariance(_)) => {
            format!("{plain} {name}")
        }
        Some(name) => format!("{name}: {plain}"),
        None => plain.to_string(),
    }
}

pub(super) fn method(method: Method, language: Language) -> &'static str {
    match method {
        Method::Gum => Word::Gum.of(language),
        Method::SecondOrder => language.pick("GUM, second order", "GUM 二阶"),
        Method::MonteCarlo => Word::MonteCarlo.of(language),
        Method::Analysis => "",
    }
}

/// Power of ten of the last digit that the claim states.
pub(super) fn last_place(comparison: &Comparison) -> i32 {
    let tolerance: f64 = comparison.claimed.tolerance;
    if tolerance > 0.0 && tolerance.is_finite() {
        libm::log10(2.0 * tolerance).floor() as i32
    } else {
        Decimal::from_f64(comparison.claimed.value)
            .place()
            .unwrap_or(0)
    }
}

/// A claimed or obtained number in words.
pub(super) fn number(what: &Figure, value: f64, place: i32, language: Language) -> String {
    if matches!(what, Figure::Validated(_)) {
        return if value == 0.5 {
            language.pick("undecided", "未定").to_string()
        } else if value > 0.5 {
            language.pick("yes", "是").to_string()
        } else {
            language.pick("no", "否").to_string()
        };
    }
    let rounded = at_place(value, place);
    if rounded.is_zero() && value != 0.0 {
        significant(value, 3)
    } else {
        print(&rounded)
    }
}

/// The claimed number with the digits that its source has.
pub(super) fn published(comparison: &Comparison, l: Language) -> String {
    let figure = &comparison.claimed;
    if matches!(figure.what, Figure::Validated(_)) {
        return number(&figure.what, figure.value, 0, l);
    }
    let stated = Decimal::from_f64(figure.value).place();
    // A tolerance of half a unit tells of zeros at the end: 2.10 ± 0.005.
    let place = libm::log10(2.0 * figure.tolerance);
    let half_unit = (place - place.round()).abs() < 1e-6;
    match (stated, half_unit) {
        (Some(stated), true) => print(&at_place(figure.value, stated.min(place.round() as i32))),
        _ => exact(figure.value),
    }
}

fn verdict(comparison: &Comparison, claim: Option<&Claim>, language: Language) -> String {
    if comparison.obtained.is_none() {
        return NONE.to_string();
    }
    let wants_digits = claim.is_some_and(|claim| claim.digits.is_some());
    if let (true, Some(digits)) = (wants_digits, comparison.log_relative_error()) {
        let verdict = match comparison.agrees() {
            true => language.pick("agrees", "一致"),
            false => language.pick("differs", "不一致"),
        };
        return say!("{verdict}, {digits:.1} digits").in_language(language);
    }
    if comparison.agrees() {
        let tolerance = comparison.claimed.tolerance;
        let counts = matches!(comparison.claimed.what, Figure::Validated(_));
        return if comparison.is_near() && tolerance > 0.0 && !counts {
            // Three digits: what the subtraction of decimals leaves behind them is not the file's.
            let within = exact(to_digits(tolerance, 3));
            say!("agrees within {within}").in_language(language)
        } else if comparison.is_near() {
            language.pick("agrees", "一致").to_string()
        } else {
            language
                .pick("agrees when rounded", "修约后一致")
                .to_string()
        };
    }
    match comparison.ratio() {
        Some(ratio) if (0.5..2.0).contains(&ratio) => {
            let percent = significant(100.0 * (ratio - 1.0), 2);
            say!("differs by {percent} % of the claim").in_language(language)
        }
        Some(ratio) => {
            let times = significant(ratio, 3);
            say!("is {times} times the claim").in_language(language)
        }
        None => language.pick("differs", "不一致").to_string(),
    }
}

/// The claimed figures of a measurand that are judged.
pub(super) fn judged(report: &Report<'_>, measurand: usize) -> Vec<Comparison> {
    compare_claims(report.budget, report.evaluation)
        .into_iter()
        .filter(|c| c.judged && of(report, c).is_some_and(|claim| claim.measurand == measurand))
        .collect()
}

fn of<'a>(report: &Report<'a>, comparison: &Comparison) -> Option<&'a Claim> {
    report.budget.claims.get(comparison.claim)
}

/// The table of all claims.
pub(super) fn blocks(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let several = report.evaluation.results.len() > 1 || report.budget.claims.len() > 1;
    let mut table = Table::new([
        ("", ColumnKind::Names),
        (Word::Claimed.of(l), ColumnKind::Numbers),
        ("", ColumnKind::Words),
        (Word::Obtained.of(l), ColumnKind::Numbers),
        ("", ColumnKind::Wrapped),
    ]);
    let comparisons = compare_claims(report.budget, report.evaluation);
    for (n, claim) in report.budget.claims.iter().enumerate() {
        if several {
            if n > 0 {
                table.rows.push(Row::Rule);
            }
            let title = title(report, claim);
            if !title.is_empty() {
                table.rows.push(Row::Across(title));
            }
        }
        let mut before: Option<&Figure> = None;
        for comparison in comparisons.iter().filter(|c| c.claim == n) {
            push(report, &mut table, comparison, before);
            before = Some(&comparison.claimed.what);
        }
    }
    if table.rows.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![Block::Section(Word::Claim.of(l).to_string())];
    if let ([claim], false) = (report.budget.claims.as_slice(), several) {
        let words: Vec<&str> = words(claim).collect();
        if !words.is_empty() {
            blocks.push(Block::Paragraph(words.join(l.semicolon())));
        }
    }
    blocks.push(Block::Table(table));
    blocks
}

/// Who says so, and what else is to be known.
fn words(claim: &Claim) -> impl Iterator<Item = &str> {
    claim
        .reference
        .iter()
        .chain(&claim.note)
        .map(String::as_str)
}

fn title(report: &Report<'_>, claim: &Claim) -> String {
    let last = report.evaluation.results.len().saturating_sub(1);
    let name = report.measurand(claim.measurand.min(last)).0;
    // Figures of an analysis bear their owner's name.
    let analysis = |what: &Figure| matches!(what, Figure::Named(_));
    let own = !(claim.figures.iter()).all(|figure| analysis(&figure.what));
    let name = own.then_some(name);
    let all: Vec<&str> = name.into_iter().chain(words(claim)).collect();
    all.join(report.language.semicolon())
}

fn push(report: &Report<'_>, table: &mut Table, comparison: &Comparison, before: Option<&Figure>) {
    let l = report.language;
    let what = &comparison.claimed.what;
    let repeated = before == Some(what);
    let place = last_place(comparison);
    let claimed: Cell = if repeated {
        Cell::Empty
    } else {
        published(comparison, l).into()
    };
    let name: Cell = if repeated {
        Cell::Empty
    } else {
        label(report, what).into()
    };
    // Two digits beyond the claim's last show what rounding hides.
    let obtained = comparison.obtained.map_or_else(
        || NONE.to_string(),
        |value| number(what, value, place - 2, l),
    );
    table.push(vec![
        name,
        claimed,
        method(comparison.method, l).into(),
        obtained.into(),
        verdict(comparison, of(report, comparison), l).into(),
    ]);
}
