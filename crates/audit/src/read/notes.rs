//! Lines beside the table: model, correlations, the rules for k and rounding, CMC.

use gumption_core::letters::is_chinese;

use crate::claim::{Claimed, Correlation, Footer, RoundingStated, Row, Stated};
use crate::printed::{Place, Printed, leading};

use super::counts::{count_after, count_before};
use super::coverage;
use super::family::CMC;
use super::footer;
use super::kind::{self, Evidence};
use super::words::{figure_after, has, has_symbol, sole_figure, symbol_at};

/// What a line says of the whole; `None` for what it says nothing of.
pub fn note(text: &str, at: Place, claimed: &mut Claimed) -> Option<&'static str> {
    let lower = text.to_lowercase();
    if has(&lower, CMC) {
        let keys = [CMC, &["capability", "not below", "±"]].concat();
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
    let role = coverage::rule(&lower, claimed).then_some("rule for k");
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

/// Correlations of a line; none in it where it says that there is none.
pub fn correlation(text: &str, claimed: &Claimed) -> Option<Vec<Correlation>> {
    let lower = text.to_lowercase();
    let is_begun = ["r(", "ρ("]
        .iter()
        .any(|lead| lower.starts_with(lead) || lower.contains(&format!(" {lead}")));
    let is_of_it = has(&lower, &["correlat", "相关"]) || is_begun;
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
    let clauses: Vec<String> = if text.contains("r(") || text.contains("ρ(") {
        outside_brackets(text)
            .into_iter()
            .flat_map(each_coefficient)
            .collect()
    } else {
        with_figures(with_lists(text.split([';', ',', '。']), claimed), claimed)
    };
    let said: Vec<String> = clauses
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

/// The parts of a text between its semicolons; those in brackets part the cells that a comma has made: `r(a ; b)`.
fn outside_brackets(text: &str) -> Vec<&str> {
    let (mut parts, mut from, mut depth) = (Vec::new(), 0, 0_usize);
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            ';' if depth == 0 => {
                parts.push(&text[from..at]);
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[from..]);
    parts
}

/// A clause for each `r(a, b)` of a text, with the figure that stands behind it, or behind others that follow: `r(a, b) = r(a, c)
/// = 1`.
fn each_coefficient(text: &str) -> Vec<String> {
    let is_name = |at: usize| text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
    let leads = ["r(", "ρ("].into_iter();
    let starts = leads.flat_map(|lead| text.match_indices(lead).map(|(at, _)| at));
    let mut starts: Vec<usize> = starts.filter(|at| !is_name(*at)).collect();
    starts.sort_unstable();
    starts.drain(..starts.len().min(1));
    let ends = starts.iter().copied().chain([text.len()]);
    let begins = [0].into_iter().chain(starts.iter().copied());
    let parts: Vec<&str> = begins.zip(ends).map(|(from, to)| &text[from..to]).collect();
    let mut clauses: Vec<String> = Vec::new();
    let mut figure = "";
    for part in parts.into_iter().rev() {
        let (bracket, behind) = part.split_once(')').unwrap_or((part, ""));
        if behind.contains(|c: char| c.is_ascii_digit()) {
            figure = behind;
        }
        clauses.push(format!("{bracket}){figure}"));
    }
    clauses.reverse();
    clauses
}

/// The clauses of a text, of which those that are no more than the symbol of a row begin a list: `m1, m2 and m3`.
fn with_lists<'t>(parts: impl Iterator<Item = &'t str>, claimed: &Claimed) -> Vec<String> {
    let mut clauses: Vec<String> = Vec::new();
    let mut list = String::new();
    for part in parts {
        let mut rows = claimed.rows.iter();
        let is_symbol = rows.any(|row| !row.symbol.is_empty() && row.symbol == part.trim());
        list.push_str(part);
        match is_symbol {
            true => list.push(','),
            false => clauses.push(std::mem::take(&mut list)),
        }
    }
    clauses.push(list);
    clauses
}

/// The clauses, of which those that name two rows and no coefficient have that of the next one: `a and b, a and c: +1`.
fn with_figures(clauses: Vec<String>, claimed: &Claimed) -> Vec<String> {
    let names_two = |clause: &str| {
        let rows = claimed.rows.iter();
        rows.filter(|row| symbol_at(clause, &row.symbol, 0).is_some())
            .count()
            > 1
    };
    let mut figure = String::new();
    let mut clauses: Vec<String> = clauses.into_iter().rev().collect();
    for clause in &mut clauses {
        let stated = clause.rsplit_once([':', '=', '：']);
        let stated = stated.filter(|(_, value)| leading(value.trim()).is_some());
        match stated {
            Some((front, value)) => {
                value.trim().clone_into(&mut figure);
                *clause = format!("{front} = {figure}");
            }
            None if figure.is_empty() || has(&clause.to_lowercase(), &FULL) => {}
            None if names_two(clause) => *clause = format!("{clause} = {figure}"),
            None => {}
        }
    }
    clauses.reverse();
    clauses
}

/// Words for the coefficient 1.
const FULL: [&str; 5] = [
    "fully",
    "full correlation",
    "完全正相关",
    "完全相关",
    "强相关",
];

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
    let full = || has(&lower, &FULL).then(|| Printed::exact(1.0, "1"));
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
    // Under which conditions it was calibrated is said of the whole.
    let is_condition = has(&row.symbol.to_lowercase(), &["condition", "环境条件"]);
    let is_missing = !about_row
        && !is_condition
        && !is_computed(&row.symbol, claimed)
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

/// Whether a line gives a formula for a symbol, `Δ = V_x - V_s`: then it is a result, whether the rows are called so or not.
fn is_computed(symbol: &str, claimed: &Claimed) -> bool {
    let understood = claimed.understood.iter().map(|line| &line.text);
    let unplaced = claimed.unplaced.iter().map(|line| &line.text);
    understood.chain(unplaced).any(|line| {
        let behind = line.strip_prefix(symbol).map(str::trim_start);
        let right = behind.and_then(|behind| behind.strip_prefix('='));
        right.is_some_and(|right| leading(right).is_none() && !right.trim().starts_with('('))
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
    let split = |c: char| c.is_whitespace() || "(),;:。".contains(c) || is_chinese(c);
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
    use crate::claim::Coverage;

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
    fn pairs_of_a_line_share_the_coefficient_behind_them() {
        let claimed = with_rows(&["m1", "m2", "m3"]);
        for (text, pairs) in [
            (
                "Correlation coefficient between m1 and m2, m1 and m3, m2 and m3: +1",
                vec![(0, 1, 1.0), (0, 2, 1.0), (1, 2, 1.0)],
            ),
            (
                "Correlation: m1 and m2 fully; m1 and m3 = 0.5",
                vec![(0, 1, 1.0), (0, 2, 0.5)],
            ),
            (
                "m1, m2 and m3 are correlated: r = 0.25",
                vec![(0, 1, 0.25), (0, 2, 0.25), (1, 2, 0.25)],
            ),
        ] {
            let found = correlation(text, &claimed).unwrap_or_default();
            let found: Vec<_> = found.iter().map(|pair| (pair.a, pair.b, pair.r)).collect();
            assert_eq!(found, pairs, "{text}");
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
        for name in ["v_eff", "nu_eff", "ν_eff"] {
            let mut claimed = with_rows(&["m_S", "dm"]);
            let rule = format!("k is looked up at {name}, p = 95.45 %");
            assert_eq!(
                note(&rule, Place::default(), &mut claimed),
                Some("rule for k")
            );
            assert_eq!(claimed.coverage, Coverage::StudentT(0.9545));
        }
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
