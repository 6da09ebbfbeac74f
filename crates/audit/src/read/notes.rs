//! Lines beside the table: model, correlations, the rules for k and rounding, CMC.

use crate::claim::{Claimed, Correlation, Coverage, Footer, RoundingStated, Row, Stated};
use crate::printed::{Place, Printed, leading};

use super::footer;
use super::kind::{self, Evidence};
use super::words::{
    count_after, count_before, figure_after, has, has_symbol, named_probability, sole_figure,
    symbol_at,
};

/// What a line says of the whole; `None` for what it says nothing of.
pub fn note(text: &str, at: Place, claimed: &mut Claimed) -> Option<&'static str> {
    let lower = text.to_lowercase();
    if has(
        &lower,
        &[
            "cmc",
            "校准和测量能力",
            "校准测量能力",
            "best measurement capability",
            "最佳测量能力",
        ],
    ) {
        let keys = [
            "cmc",
            "校准和测量能力",
            "校准测量能力",
            "capability",
            "最佳测量能力",
            "not below",
            "±",
        ];
        let figure = figure_after(text, &keys)
            .or_else(|| sole_figure(text))
            .or_else(|| last_figure(text));
        if let Some(figure) = figure {
            claimed.cmc = Some(figure.at(at));
            return Some("CMC");
        }
    }
    if let Some(correlation) = correlation(text, claimed) {
        claimed.correlate(correlation);
        return Some("correlation");
    }
    let role = rule(&lower, claimed).then_some("rule for k");
    let rounds = rounding(&lower, claimed).then_some("rule for rounding");
    role.or(rounds)
}

/// Whether a text in small letters says how U is rounded, which is then the rule.
pub fn rounding(lower: &str, claimed: &mut Claimed) -> bool {
    const ABOUT: &[&str] = &["round", "修约", "只进不舍", "进位", "舍入", "四舍"];
    const UP: &[&str] = &[
        "rounded up",
        "round up",
        "rounding up",
        "upwards",
        "only up",
        "只进不舍",
        "进位",
        "always up",
        "向上",
        "up at",
        "not down",
    ];
    const NEAREST: &[&str] = &[
        "nearest",
        "usual",
        "half-even",
        "half even",
        "half up",
        "四舍",
        "8170",
        "80000",
        "就近",
    ];
    let is_about = has(lower, ABOUT);
    if is_about && has(lower, UP) {
        claimed.rounding = RoundingStated::Up;
    } else if is_about && has(lower, NEAREST) {
        claimed.rounding = RoundingStated::Nearest;
    }
    is_about
}

/// `the reported value is the mean of 5 readings`, without the name of a row.
pub fn mean_of(text: &str, claimed: &Claimed) -> Option<f64> {
    let lower = text.to_lowercase();
    let general = has(
        &lower,
        &[
            "report",
            "reported value",
            "报告值",
            "测量结果",
            "被测量",
            "结果取",
            "routine",
            "日常",
        ],
    );
    let named = claimed.rows.iter().any(|row| has_symbol(text, &row.symbol));
    let mean = count_after(&lower, &["mean of", "average of", "m =", "m="]);
    let mean = mean.or_else(|| {
        count_before(
            &lower,
            &[
                "次平均",
                "次测量的平均",
                "次测量平均",
                "次读数的平均",
                "次重复测量的平均",
                "次测量的算术平均",
            ],
        )
    });
    mean.filter(|_| general && !named)
}

fn last_figure(text: &str) -> Option<Printed> {
    let (at, _) = text.char_indices().rev().find(|(at, c)| {
        c.is_ascii_digit()
            && !text[..*at].ends_with(|b: char| b.is_ascii_digit() || ".,e-E+".contains(b))
    })?;
    let (figure, behind) = leading(&text[at..])?;
    let unit = behind
        .split_whitespace()
        .next()
        .unwrap_or_default()
        .trim_end_matches(['.', ',', ';', ')']);
    Some(Printed {
        unit: unit.into(),
        ..figure
    })
}

/// The rule for k, where the line states one.
fn rule(lower: &str, claimed: &mut Claimed) -> bool {
    let about = has(
        lower,
        &[
            "coverage factor",
            "包含因子",
            "k from",
            "k is",
            "k =",
            "k=",
            "u = k",
            "取k",
            "k取",
            "k_p",
            "t-distribution",
            "t distribution",
            "t分布",
            "t 分布",
            "rule for k",
        ],
    );
    let certificate = has(lower, &["certificate", "cert.", "证书", "calibrat"]);
    // A line of nothing but `k = 2.13` is the claim.
    let bare = lower
        .strip_prefix('k')
        .and_then(|rest| rest.trim_start().strip_prefix('='))
        .is_some_and(|rest| rest.trim().parse::<f64>().is_ok());
    if bare || footer::divides_by_factor(lower) {
        return false;
    }
    if !about || certificate {
        return false;
    }
    if has(lower, &["1.65", "1,65"])
        && has(
            lower,
            &["rect", "rectang", "矩形", "均匀", "dominat", "dominant"],
        )
    {
        let conditions = ["where", "if", "when", "whenever", "若", "如果", "当", "时"];
        claimed.coverage = if has(lower, &conditions) {
            Coverage::Rectangle
        } else {
            Coverage::OfRectangle
        };
        return true;
    }
    if claimed.coverage != Coverage::Unstated {
        return false;
    }
    let by_freedom = has(
        lower,
        &["effective degrees", "ν_eff", "veff", "νeff", "有效自由度"],
    );
    // `ν_eff = 35, k = 2, U = 0.05` claims figures and states no rule.
    let statement = footer::states_figures(lower);
    let regardless = has(lower, &["regardless", "k = 2 is used", "不论"]);
    if (names_student(lower) || by_freedom && !statement) && !regardless {
        claimed.coverage = Coverage::StudentT(probability(lower).unwrap_or(0.95));
        return true;
    }
    if statement {
        return false;
    }
    match figure_after(lower, &["coverage factor", "包含因子", "k"]) {
        Some(k) if (1.0..5.0).contains(&k.value) => {
            claimed.coverage = Coverage::Fixed(k.value);
            // A sentence of the statement claims its factor, too.
            true
        }
        _ => false,
    }
}

/// The rule that the label of a coverage factor states: `k (t, 95 %)`. What it says of a probability is said of the whole.
pub fn rule_of_label(text: &str, claimed: &mut Claimed) {
    let lower = text.to_lowercase();
    if named_probability(&lower).is_some() {
        claimed.words.push_str(text);
        claimed.words.push('\n');
    }
    let by_t = has(&lower, &["t", "student", "t分布", "t95", "t_95"]);
    if by_t && claimed.coverage == Coverage::Unstated {
        claimed.coverage = Coverage::StudentT(probability(&lower).unwrap_or(0.95));
    }
}

/// The rule that a coverage factor states with its reason: `k = 1.65 (rectangular distribution, dominated by V)`, `k = 1.83
/// (trapezoidal distribution, dominated by V and R)`, `k = 2 (fixed)`, `k = 2.23 (t-distribution, ν = 10, p = 95 %)`.
pub fn rule_of_reason(text: &str, claimed: &mut Claimed) {
    let lower = text.to_lowercase();
    let is_reason = has(
        &lower,
        &["dominat", "fixed", "占优", "主导", "约定值", "固定"],
    );
    let k = figure_after(&lower, &["k"]).filter(|k| is_reason && (1.0..5.0).contains(&k.value));
    if let Some(k) = k.filter(|_| claimed.coverage == Coverage::Unstated) {
        claimed.coverage = match k.value {
            1.65 => Coverage::OfRectangle,
            k => Coverage::Fixed(k),
        };
    }
    if names_student(&lower) {
        rule_of_label(text, claimed);
    }
}

/// Whether a text says that k is a quantile of t.
fn names_student(lower: &str) -> bool {
    let by_words = has(
        lower,
        &[
            "student",
            "t-distribution",
            "t distribution",
            "t分布",
            "t 分布",
            "t(",
            "t_p",
            "t_95",
            "t95",
            "t-table",
            "t table",
            "t值",
            "t factor",
            "from t",
            "t-factor",
            "t 值",
        ],
    );
    by_words || bracket_behind(lower, "k").is_some_and(|why| has(why, &["t", "student"]))
}

/// What stands in round brackets behind the figure of a key: `t, 95 %` in `k = 2.31 (t, 95 %)`.
fn bracket_behind<'t>(lower: &'t str, key: &str) -> Option<&'t str> {
    lower.match_indices(key).find_map(|(at, _)| {
        let is_name = !lower[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let figure = lower[at + key.len()..].trim_start().strip_prefix('=')?;
        let (_, behind) = leading(figure.trim_start()).filter(|_| is_name)?;
        let inside = behind.trim_start().strip_prefix(['(', '（'])?;
        Some(inside.split([')', '）']).next().unwrap_or(inside))
    })
}

/// The coverage probability that a sheet states behind its k: `k = 2.92 (99 %)`.
pub(crate) fn probability_of_factor(words: &str) -> Option<f64> {
    let mut lines = words.lines().map(str::to_lowercase);
    lines.find_map(|line| named_probability(bracket_behind(&line, "k")?))
}

/// The probabilities that k may have where no rule is stated. Who says 95.45 % of the coverage, and nowhere 95 %, does not mean
/// that; 95 % may be rounded from the other one (EA-4/02, E).
pub(crate) fn usual_levels(words: &str) -> impl Iterator<Item = f64> {
    let lines = words.lines().map(str::to_lowercase);
    let is_of_coverage = |line: &String| {
        has(line, &["coverage", "confidence", "包含", "置信", "k", "u"])
            && !has(line, &["certificate", "cert.", "证书"])
    };
    let levels = lines
        .filter(is_of_coverage)
        .filter_map(|line| named_probability(&line));
    let levels: Vec<f64> = levels.collect();
    let is_exact = levels.contains(&0.9545) && !levels.contains(&0.95);
    [0.95, 0.9545]
        .into_iter()
        .filter(move |p| !is_exact || *p == 0.9545)
}

/// The coverage probability of a line: 0.9545 for `95.45 %`, for `t_95.45(ν_eff)` and for `p = 0.9545`.
fn probability(lower: &str) -> Option<f64> {
    index_of_t(lower).or_else(|| named_probability(lower))
}

/// The probability that a factor has as its index.
fn index_of_t(lower: &str) -> Option<f64> {
    let factors = lower.match_indices(['t', 'k']).filter(|(at, _)| {
        let before = lower[..*at].chars().next_back();
        !before.is_some_and(char::is_alphanumeric)
    });
    let of = |(at, _): (usize, &str)| {
        let index = lower[at + 1..].trim_start_matches(['_', '{', '(']);
        let (figure, _) =
            leading(index).filter(|_| index.starts_with(|c: char| c.is_ascii_digit()))?;
        [figure.value / 100.0, figure.value]
            .into_iter()
            .find(|p| (0.5..1.0).contains(p))
    };
    factors.filter_map(of).next()
}

/// Correlations of a line; none in it where it says that there is none.
pub fn correlation(text: &str, claimed: &Claimed) -> Option<Vec<Correlation>> {
    let lower = text.to_lowercase();
    let is_of_it =
        has(&lower, &["correlat", "相关"]) || lower.starts_with("r(") || lower.contains(" r(");
    if !is_of_it {
        return None;
    }
    let none = [
        "uncorrelated",
        "not correlated",
        "no correlation",
        "independent",
        "不相关",
        "互不相关",
        "独立",
        "无相关",
    ];
    // `r(a, b) = 0.5; all others are independent`: each clause is about others.
    let clauses: Vec<&str> = if text.contains("r(") || text.contains("ρ(") {
        text.split(';').collect()
    } else {
        text.split([';', ',', '。']).collect()
    };
    let said: Vec<&str> = clauses
        .into_iter()
        .filter(|clause| !has(&clause.to_lowercase(), &none))
        .collect();
    let pairs: Vec<Correlation> = said
        .iter()
        .filter_map(|clause| pairs(clause, claimed))
        .flatten()
        .collect();
    if !pairs.is_empty() {
        return Some(pairs);
    }
    // What is parted by commas may belong together: `a, b: r = 0.5`.
    let whole = said.join(",");
    self::pairs(&whole, claimed).or_else(|| has(&lower, &none).then(Vec::new))
}

/// The pairs of rows that a clause names, with its coefficient.
fn pairs(text: &str, claimed: &Claimed) -> Option<Vec<Correlation>> {
    let lower = text.to_lowercase();
    let inner = ["r(", "ρ(", "R("]
        .iter()
        .find_map(|lead| text.split_once(lead)?.1.split_once(')'))
        .map(|(inner, _)| inner);
    let names = inner.unwrap_or(text);
    let rows = claimed.rows.iter().enumerate();
    let mut places: Vec<(usize, usize)> = rows
        .clone()
        // The coefficient itself is called r.
        .filter(|(_, row)| {
            inner.is_some()
                || !matches!(row.symbol.as_str(), "r" | "ρ")
                || symbols(text, &row.symbol) > 1
                || !is_assigned(text, &row.symbol)
        })
        .filter_map(|(i, row)| Some((symbol_at(names, &row.symbol, 0)?, i)))
        .collect();
    if places.len() < 2 {
        let names = names.to_lowercase();
        places = rows
            .filter(|(_, row)| row.name.chars().count() >= 2)
            .filter_map(|(i, row)| Some((names.find(&row.name.to_lowercase())?, i)))
            .collect();
    }
    places.sort_unstable();
    let full = || {
        let words = [
            "fully",
            "full correlation",
            "完全正相关",
            "完全相关",
            "强相关",
        ];
        has(&lower, &words).then(|| Printed::exact(1.0, "1"))
    };
    let stated = || {
        // The bracket is that of `r(a, b) is 0.5`.
        let keys = ["coefficient", "相关系数", "correlation", "r", ")"];
        figure_after(&lower, &keys)
    };
    let said = equals_figure(text)
        .or_else(stated)
        .or_else(full)
        .filter(|r| r.value.abs() <= 1.0)?;
    // One digit is a guess, which is what was computed with; more are a coefficient that was rounded.
    let open = if said.digits < 2 { 0.0 } else { said.half };
    let r = said.value;
    let rows: Vec<usize> = places.into_iter().map(|(_, row)| row).collect();
    let pairs: Vec<Correlation> = rows
        .iter()
        .enumerate()
        .flat_map(|(i, &a)| {
            rows[i + 1..]
                .iter()
                .map(move |&b| Correlation { a, b, r, open })
        })
        .collect();
    (!pairs.is_empty()).then_some(pairs)
}

/// How often a symbol stands in a text.
fn symbols(text: &str, symbol: &str) -> usize {
    let mut from = 0;
    let mut count = 0;
    while let Some(at) = symbol_at(text, symbol, from) {
        count += 1;
        from = at + symbol.len();
    }
    count
}

/// Whether a symbol is what the text gives a value to, behind a sign or in the next cell.
pub fn is_assigned(text: &str, symbol: &str) -> bool {
    let beside = text
        .split_once(" ; ")
        .filter(|(first, _)| first.trim() == symbol);
    // `nominal: 1 kg`
    let named = text.strip_prefix(symbol).map(str::trim_start);
    let named = named.and_then(|rest| rest.strip_prefix([':', '：']));
    beside.is_some_and(|(_, rest)| leading(rest).is_some())
        || named.is_some_and(|rest| leading(rest).is_some())
        || symbol_at(text, symbol, 0).is_some_and(|at| {
            text[at + symbol.len()..]
                .trim_start()
                .starts_with(['=', '为'])
        })
}

/// The last figure behind an equals sign.
fn equals_figure(text: &str) -> Option<Printed> {
    let at = text.rfind('=')?;
    leading(&text[at + 1..]).map(|(figure, _)| figure)
}

/// A certificate of an input of the model that no row has.
pub fn absent(text: &str, at: Place, claimed: &Claimed) -> Option<Row> {
    let mut row = super::prose::row(text.strip_prefix("Note to ").unwrap_or(text), at)?;
    if row.symbol.is_empty() {
        row.symbol = without_row(text, claimed)?;
    }
    // With a combined uncertainty it is the statement of a result.
    let mut whole = Footer::default();
    footer::sentence(text, &row.symbol, at, &mut whole);
    if whole.u_c.is_some() {
        return None;
    }
    // `Known: t_ref, certificate …` is about a row; where a model has the symbol, the model decides.
    let about_row = claimed.model.is_none()
        && claimed
            .rows
            .iter()
            .any(|other| !other.symbol.is_empty() && has_symbol(text, &other.symbol));
    let is_missing = !about_row
        && !row.symbol.is_empty()
        && claimed
            .model
            .as_deref()
            .is_none_or(|model| has_symbol(model, &row.symbol))
        && claimed.rows.iter().all(|other| other.symbol != row.symbol);
    let evidence = Evidence {
        words: &row.words,
        ..Evidence::default()
    };
    let (stated, relative) = kind::stated(&evidence);
    let certificate = matches!(stated, Stated::Certificate { .. });
    (is_missing && certificate).then_some(Row {
        stated,
        relative,
        ..row
    })
}

/// The one input of the model in a line that no row has: `Reference used: m_S, certificate …`.
fn without_row(text: &str, claimed: &Claimed) -> Option<String> {
    let model = claimed.model.as_deref()?;
    let is_row = |name: &str| {
        claimed
            .rows
            .iter()
            .any(|row| names_of(row).any(|own| own == name))
    };
    let mut names: Vec<&str> = text
        .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .filter(|name| {
            name.starts_with(|c: char| c.is_ascii_alphabetic()) && has_symbol(model, name)
        })
        .filter(|name| !is_row(name) && !matches!(*name, "U" | "u" | "k"))
        .collect();
    names.dedup();
    match names.as_slice() {
        [name] => Some((*name).to_string()),
        _ => None,
    }
}

/// The words by which a model may call a row: its symbol, or what looks like one in its name.
pub fn names_of(row: &crate::claim::Row) -> impl Iterator<Item = &str> {
    let split = |c: char| {
        c.is_whitespace() || "(),;:。".contains(c) || ('\u{4e00}'..='\u{9fff}').contains(&c)
    };
    // `[m_S]` is a name, and in `standards[W1].d` the brackets hold an index.
    let unwrapped = |word| <str>::trim_matches(word, ['[', ']']);
    let looks = |word: &&str| {
        !word.is_empty()
            && word.chars().count() <= 8
            && word.chars().any(char::is_alphabetic)
            && !word.starts_with(|c: char| c.is_ascii_digit())
    };
    let symbol = Some(row.symbol.as_str()).filter(|symbol| !symbol.is_empty());
    let of_name = row
        .name
        .split(split)
        .map(unwrapped)
        .filter(|word| !word.contains(['[', ']']))
        .filter(looks)
        .filter(|word| word.len() != 1 || *word != "a");
    symbol
        .into_iter()
        .chain(of_name.filter(move |_| symbol.is_none()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_rows(symbols: &[&str]) -> Claimed {
        let row = |symbol: &&str| Row {
            symbol: (*symbol).into(),
            ..Row::default()
        };
        Claimed {
            rows: symbols.iter().map(row).collect(),
            ..Claimed::default()
        }
    }

    #[test]
    fn notes_of_the_whole() {
        let mut claimed = with_rows(&["m_S", "dm"]);
        let mut said = |text: &str| note(text, Place::default(), &mut claimed);
        assert_eq!(said("Correlation: r(m_S, dm) = 0.35"), Some("correlation"));
        assert_eq!(said("CMC of the laboratory: 0.05 g"), Some("CMC"));
        assert_eq!(
            said("k from the t distribution at ν_eff, p = 95.45 %"),
            Some("rule for k")
        );
        assert_eq!(
            said("U is rounded up to two digits."),
            Some("rule for rounding")
        );
        assert_eq!(
            claimed.correlations,
            [Correlation {
                a: 0,
                b: 1,
                r: 0.35,
                open: 0.005
            }]
        );
        assert_eq!(claimed.cmc.as_ref().unwrap().value, 0.05);
        assert_eq!(claimed.coverage, Coverage::StudentT(0.9545));
        assert_eq!(claimed.rounding, RoundingStated::Up);
        let mut claimed = with_rows(&["m_S", "dm"]);
        note("包含因子取 k=2", Place::default(), &mut claimed);
        assert_eq!(claimed.coverage, Coverage::Fixed(2.0));
        note("m_S 与 dm 的相关系数 r=0.5", Place::default(), &mut claimed);
        assert_eq!(claimed.correlations[0].r, 0.5);
    }
}
