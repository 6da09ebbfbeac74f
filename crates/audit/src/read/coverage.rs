//! What a sheet says of its coverage: how k is found, and for which probability.

use std::ops::RangeInclusive;

use crate::claim::{Claimed, Coverage, K_OF_RECTANGLE};
use crate::printed::{Printed, leading};
use crate::units;

use super::conditions;
use super::factor::is_factor;
use super::family::NU_EFF;
use super::footer::{self, Whole};
use super::words::{figure_after, has, named_probability};

/// The rule for k, where the line states one.
pub fn rule(lower: &str, claimed: &mut Claimed) -> bool {
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
    let by_freedom = has(lower, &["effective degrees", "有效自由度"]) || has(lower, NU_EFF);
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
        Some(k) if is_factor(k.value) && may_be_rule(&k, claimed) => {
            claimed.coverage = Coverage::Fixed(k.value);
            // A sentence of the statement claims its factor, too.
            true
        }
        _ => false,
    }
}

/// Whether a factor in a line may be that of the sheet: beside U that states its own, another one is of another time or case.
fn may_be_rule(k: &Printed, claimed: &Claimed) -> bool {
    let stated = claimed.footer.k.as_ref();
    let is_of_statement = |own: &&Printed| {
        let expanded = claimed.footer.expanded.as_ref();
        expanded.is_some_and(|expanded| expanded.at.row == own.at.row)
    };
    stated
        .filter(is_of_statement)
        .is_none_or(|own| own.value == k.value)
}

/// Takes the probability that the label of U or k names: it is said of the whole.
pub fn level_of_label(text: &str, claimed: &mut Claimed) {
    if probability(&text.to_lowercase()).is_some() {
        claimed.words.push_str(text);
        claimed.words.push('\n');
    }
}

/// The rule that the label of a coverage factor states: `k (t, 95 %)`.
pub fn rule_of_label(text: &str, claimed: &mut Claimed) {
    let lower = text.to_lowercase();
    level_of_label(text, claimed);
    let by_t = has(&lower, &["t", "student", "t分布"]) || index_of(&lower, &['t']).is_some();
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
        &[
            "dominat",
            "fixed",
            "占优",
            "主导",
            "约定值",
            "固定",
            "梯形",
            "trapez",
        ],
    );
    let k = figure_after(&lower, &["k"]).filter(|k| is_reason && is_factor(k.value));
    if let Some(k) = k.filter(|_| claimed.coverage == Coverage::Unstated) {
        claimed.coverage = match k.value {
            K_OF_RECTANGLE => Coverage::OfRectangle,
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
    let is_exact = names_level(words, 0.9545) && !names_level(words, 0.95);
    [0.95, 0.9545]
        .into_iter()
        .filter(move |p| !is_exact || *p == 0.9545)
}

/// Whether a line about coverage names a probability.
pub(crate) fn names_level(words: &str, p: f64) -> bool {
    let mut levels = of_coverage(words).filter_map(|line| named_probability(&line));
    levels.any(|level| level == p)
}

/// Whether a line about coverage states one of the usual probabilities, by a name or by an index: `U95`.
pub(crate) fn states_usual_level(words: &str) -> bool {
    let lines = words.lines().map(str::to_lowercase);
    let lines = lines.filter(|line| !is_of_certificate(line));
    let indexed = lines.filter_map(|line| index_of(&line, &['k', 'u']));
    let named = of_coverage(words).filter_map(|line| named_probability(&line));
    indexed.chain(named).any(|level| USUAL.contains(&level))
}

/// The lines about coverage, in small letters.
fn of_coverage(words: &str) -> impl Iterator<Item = String> {
    let is_of_coverage = |line: &String| {
        has(line, &["coverage", "confidence", "包含", "置信", "k", "u"]) && !is_of_certificate(line)
    };
    words.lines().map(str::to_lowercase).filter(is_of_coverage)
}

/// Both usual probabilities, and those between them that are rounded.
const USUAL: RangeInclusive<f64> = 0.945..=0.956;

/// The probability that the sheet states of its U or k, where it is none of the usual ones: `U99`, `U (99 %)`, `k_99`,
/// `coverage probability 99.73 %`.
pub(crate) fn unusual_level(claimed: &Claimed) -> Option<f64> {
    const OF_WHOLE: [&str; 6] = [
        "coverage probability",
        "level of confidence",
        "confidence level",
        "包含概率",
        "置信概率",
        "置信水平",
    ];
    let is_of_whole = |line: &&str| {
        let label = footer::label(line, "");
        let is_figure = matches!(label, Some(Whole::Expanded | Whole::Factor));
        let lower = line.to_lowercase();
        (is_figure || has(&lower, &OF_WHOLE)) && !is_of_certificate(&lower)
    };
    let is_of_other_k = |line: &&str| {
        let own = claimed.footer.k.as_ref();
        let other = footer::assigned(line, "k").zip(own);
        other.is_some_and(|(other, own)| other.value != own.value)
    };
    let lines = claimed.words.lines().filter(is_of_whole);
    let lines = lines.filter(|line| !is_of_other_k(line));
    // `U = 63 %`: the uncertainty itself.
    let expanded = claimed.footer.expanded.as_ref();
    let relative = expanded.filter(|own| units::fraction(&own.unit).is_some());
    let without_own = |line: &str| relative.map_or(line.to_owned(), |own| without(line, own));
    // `U at 50 % load`: a point, and no probability.
    let mut levels = lines.filter_map(|line| {
        let own = without_own(line);
        let at_point = conditions::without_point(&own);
        probability(&at_point.to_lowercase())
    });
    levels.next().filter(|level| !USUAL.contains(level))
}

/// A line without a figure in percent, the last one that reads so: the 99 of `U99 = 9 %` is not its 9.
fn without(line: &str, figure: &Printed) -> String {
    let is_it = |at: &usize| {
        let is_begun = line[..*at].ends_with(|c: char| c.is_ascii_digit() || ".,".contains(c));
        let behind = line[at + figure.text.len()..].trim_start();
        !is_begun && behind.starts_with(&figure.unit)
    };
    let places = line.match_indices(&figure.text).map(|(at, _)| at);
    let mut line_without = line.to_owned();
    if let Some(at) = places.filter(is_it).last() {
        line_without.replace_range(at..at + figure.text.len(), "");
    }
    line_without
}

fn is_of_certificate(lower: &str) -> bool {
    has(lower, &["certificate", "cert.", "证书"])
}

/// The coverage probability of a line: 0.9545 for `95.45 %`, for `t_95.45(ν_eff)` and for `p = 0.9545`.
fn probability(lower: &str) -> Option<f64> {
    index_of(lower, &['t', 'k', 'u']).or_else(|| named_probability(lower))
}

/// The probability that one of these letters has as its index: 0.99 of `U_99` and `t0.99`.
fn index_of(lower: &str, letters: &[char]) -> Option<f64> {
    let factors = lower.match_indices(letters).filter(|(at, _)| {
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
