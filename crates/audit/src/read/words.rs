//! Words and figures inside texts.

use std::ops::Range;

use gumption_core::letters::is_chinese;

use crate::printed::{Printed, leading};

/// A text in small letters without blanks, underscores and signs of multiplication, so that `u_i (y)` is `ui(y)`.
pub fn compact(text: &str) -> String {
    let kept = |c: &char| !c.is_whitespace() && !"_{}$·*×⋅".contains(*c);
    text.chars()
        .filter(kept)
        .map(plain)
        .flat_map(char::to_lowercase)
        .collect()
}

/// Lowered letters as plain ones.
fn plain(c: char) -> char {
    match c {
        'ᵢ' => 'i',
        'ⱼ' => 'j',
        'ₖ' => 'k',
        'ₑ' => 'e',
        'ᵥ' => 'v',
        '₀'..='₉' => char::from_digit(c as u32 - '₀' as u32, 10).unwrap_or(c),
        c => c,
    }
}

/// Whether a text has one of these in it.
pub fn has(text: &str, keys: &[&str]) -> bool {
    keys.iter().any(|key| find(text, key, 0).is_some())
}

/// Where a key stands: one of letters stands as a word, or at the beginning of one from five letters on; of several words the
/// last one has three at least, and `from t` is not in `from their sum`.
pub fn find(text: &str, key: &str, from: usize) -> Option<usize> {
    let letters = key.starts_with(|c: char| c.is_ascii_alphanumeric());
    let ends = key.ends_with(|c: char| c.is_ascii_alphanumeric());
    let last = key.rsplit(|c: char| !is_letter(c)).next().unwrap_or(key);
    let begins = key.len() >= 5 && last.len() >= 3;
    let mut at = from;
    while let Some(found) = text.get(at..).and_then(|rest| rest.find(key)) {
        let (start, end) = (at + found, at + found + key.len());
        let before = text[..start].chars().next_back();
        let after = text[end..].chars().next();
        let free_before = !letters || before.is_none_or(|c| !is_letter(c));
        let free_after = !ends || begins || after.is_none_or(|c| !is_letter(c));
        if free_before && free_after {
            return Some(start);
        }
        at = end;
    }
    None
}

/// The text in small letters, each in the place of its capital: one whose small letter takes another number of bytes stays.
pub fn lowered(text: &str) -> String {
    let small = |c: char| {
        let mut small = c.to_lowercase();
        match (small.next(), small.next()) {
            (Some(one), None) if one.len_utf8() == c.len_utf8() => one,
            _ => c,
        }
    };
    text.chars().map(small).collect()
}

fn is_letter(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || ('α'..='ω').contains(&c)
}

/// A coverage probability in a text in small letters: 0.95 for `95 %` and for `p = 0.95`.
pub fn named_probability(lower: &str) -> Option<f64> {
    let mut at = 0;
    while let Some(found) = lower
        .get(at..)
        .and_then(|rest| rest.find(|c: char| c.is_ascii_digit()))
    {
        let start = at + found;
        let (figure, rest) = leading(&lower[start..])?;
        let percent = rest.trim_start().starts_with('%') && (50.0..100.0).contains(&figure.value);
        if percent {
            return Some(figure.value / 100.0);
        }
        let bare =
            (0.9..1.0).contains(&figure.value) && has(lower, &["p =", "p=", "probability", "概率"]);
        if bare {
            return Some(figure.value);
        }
        at = lower.len() - rest.len();
        at = at.max(start + 1);
    }
    None
}

/// The figure behind one of the keys, across words that only lead to it. A figure that counts readings, is a level of
/// confidence or a year is none.
pub fn figure_after(text: &str, keys: &[&str]) -> Option<Printed> {
    let lower = text.to_lowercase();
    for key in keys {
        let mut from = 0;
        while let Some(at) = find(&lower, key, from) {
            from = at + key.len();
            if let Some(figure) = lower.get(from..).and_then(|rest| led(rest, text)) {
                return Some(figure);
            }
        }
    }
    None
}

fn led(rest: &str, whole: &str) -> Option<Printed> {
    const LEADS: [&str; 51] = [
        "indication",
        "display",
        "instrument",
        "示值",
        "is",
        "was",
        "of",
        "the",
        "for",
        "at",
        "=",
        ":",
        "≈",
        "~",
        "(",
        ")",
        "±",
        "+/-",
        ",",
        "about",
        "value",
        "stated",
        "in",
        "digital",
        "as",
        "single",
        "为",
        "是",
        "的",
        "约",
        "在",
        "取",
        "值",
        "u",
        "u95",
        "w",
        "a",
        "s",
        "q",
        "d",
        "e",
        "mpe",
        "r",
        "s_p",
        "interval",
        "band",
        "limits",
        "variation",
        "gave",
        "不",
        "±(",
    ];
    let mut rest = behind_condition(rest.trim_start());
    for _ in 0..8 {
        if let Some((figure, behind)) = leading(rest).filter(|_| !rest.starts_with("inf")) {
            let text = behind.trim_start();
            // `U = 2 × 17.4 kPa = 35 kPa`, `U = 0.5 + 5 L µm = 1.0 µm`: what it comes to.
            if (starts_product(text) || starts_sum(text))
                && let Some((_, result)) = text.split_once('=')
            {
                rest = result.trim_start();
                continue;
            }
            // `±(35 ppm of reading + 2.5 µV)`: a term of what is not said.
            if starts_sum(text) {
                return None;
            }
            // `1/5 of a division`: a part of what is not said.
            if figure.half == 0.5 && starts_quotient(text) && !text.contains('=') {
                return None;
            }
            // `U = 2·u_c`: a factor of what is not said.
            if starts_product(text) {
                return None;
            }
            // `the standard deviation is 1.22 times u`, `标准差为 u 的 1.22 倍`: a ratio.
            if text.starts_with('倍') || text.starts_with("times") {
                return None;
            }
            // `s of 10: 0.12 µm`: how many, and not how much.
            let counted = starts_counted(text) || figure.half == 0.5 && text.starts_with(':');
            let level = text.starts_with('%') && (figure.value - 95.0).abs() < 1.0
                || figure.value == 99.0 && text.starts_with('%');
            if counted || level {
                return None;
            }
            let mut unit = unit_in(text, whole);
            if crate::units::parse(&unit).is_none() {
                if figure.half == 0.5 && (starts_plural(text) || starts_period(text)) {
                    return None;
                }
                unit.clear();
            }
            return Some(Printed { unit, ..figure });
        }
        let lead = LEADS
            .iter()
            .filter(|lead| rest.starts_with(**lead))
            .max_by_key(|lead| lead.len())?;
        let next = rest[lead.len()..].chars().next();
        if lead.as_bytes()[0].is_ascii_alphabetic() && next.is_some_and(is_letter) {
            return None;
        }
        rest = rest[lead.len()..].trim_start();
    }
    None
}

/// Whether a text begins with a sign of multiplication; an `x` is one between blanks.
pub fn starts_product(text: &str) -> bool {
    let marked = text.starts_with(['×', '*', '·']);
    marked || text.starts_with("x ") || text.starts_with("X ")
}

/// Whether a text goes on to a further term of a sum, before its clause ends: `+ 5 L µm`, `读数 + 2.5 µV`.
fn starts_sum(text: &str) -> bool {
    let clause = text.split([',', ';', '，', '；', '。', '(', ')', '=', '/']);
    let clause = clause.into_iter().next().unwrap_or_default();
    clause.contains('+')
}

/// Whether a text begins with a sign of division by a number: `/√3`, and not `/m`.
pub fn starts_quotient(text: &str) -> bool {
    text.strip_prefix('/').is_some_and(|by| {
        by.trim_start()
            .starts_with(|c: char| c.is_ascii_digit() || "√(".contains(c))
    })
}

/// Whether a text begins with several of something, which a number in front of it counts: `5 connections`.
fn starts_plural(text: &str) -> bool {
    let letters = text.bytes().take_while(u8::is_ascii_alphabetic).count();
    letters >= 5 && text[..letters].ends_with('s')
}

/// Whether a text begins with a period of time, for which something holds: `accuracy (1 year)`.
fn starts_period(text: &str) -> bool {
    const PERIODS: [&str; 7] = ["year", "month", "week", "day", "年", "个月", "天"];
    PERIODS.iter().any(|period| text.starts_with(period))
}

/// What stands behind a bracket that says under which condition a figure holds: `expanded (k = 2): 0.014 bar`.
fn behind_condition(rest: &str) -> &str {
    let Some((inner, behind)) = rest.strip_prefix('(').and_then(|rest| rest.split_once(')')) else {
        return rest;
    };
    let factor = inner.trim_start().starts_with(['k', 'p']) && inner.contains('=');
    if factor || inner.contains("95") {
        behind.trim_start()
    } else {
        rest
    }
}

/// The figure in front of one of the keys, with its unit: `0.38 K peak to peak`.
pub fn figure_before(text: &str, keys: &[&str]) -> Option<Printed> {
    let lower = lowered(text);
    let ends = keys.iter().filter_map(|key| find(&lower, key, 0));
    ends.filter_map(|end| {
        let clause = lower[..end].rfind([';', ',']).map_or(0, |at| at + 1);
        let front = text.get(clause..end)?.trim_end_matches(['(', ' ']);
        let figure = sole_figure(front)?;
        let unit = front.trim_end().ends_with(figure.unit.as_str());
        unit.then_some(figure)
    })
    .next()
}

/// The figure that the words give to one of the keys, behind it or in front.
pub fn named_figure(text: &str, keys: &[&str]) -> Option<Printed> {
    figure_after(text, keys).or_else(|| figure_before(text, keys))
}

/// The figure that may be meant where the words give none to the keys: the only one, or that of the clause.
pub fn only_figure(text: &str, keys: &[&str]) -> Option<Printed> {
    let of_clause = || {
        let clauses = text.split(';').rev();
        let said = clauses.filter(|clause| has(&clause.to_lowercase(), keys));
        said.filter_map(sole_figure).next()
    };
    sole_figure(text).or_else(of_clause)
}

/// A text in which the unit behind a bracket stands with both of its figures: `23 °C ± 1 °C` for `(23 ± 1) °C`.
pub fn with_units_inside(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((front, bracket)) = rest.split_once('(') {
        out.push_str(front);
        rest = match unit_inside(bracket) {
            Some((inside, behind)) => {
                out.push_str(&inside);
                behind
            }
            None => {
                out.push('(');
                bracket
            }
        };
    }
    out + rest
}

/// `23 °C ± 1 °C` of `23 ± 1) °C` and what is behind it.
fn unit_inside(bracket: &str) -> Option<(String, &str)> {
    let (inside, behind) = bracket.split_once(')')?;
    let (value, limit) = inside.split_once('±')?;
    let behind = behind.trim_start();
    let end = behind.find([' ', ',', ';', '(', ')', '。', '、']);
    let (unit, behind) = behind.split_at(end.unwrap_or(behind.len()));
    let is_bare = |text: &str| text.trim().parse::<f64>().is_ok();
    let whole = is_bare(value) && is_bare(limit) && crate::units::parse(unit).is_some();
    whole.then(|| (format!("{value} {unit} ± {limit} {unit}"), behind))
}

/// A text without the figures that cannot be of a quantity in this unit: the designation of an instrument (`5720A`), and
/// what is in the unit of something else, where the text has a figure that can.
pub fn of_unit(text: &str, unit: &str) -> String {
    let figures = figures(text);
    let fits = |figure: &Printed| {
        crate::units::factor(&figure.unit, unit).is_some()
            || crate::units::fraction(&figure.unit).is_some()
    };
    let possible = figures.iter().any(|(_, figure)| fits(figure));
    let designation = |range: &Range<usize>, figure: &Printed| {
        let attached = text[range.clone()].ends_with(|c: char| c.is_ascii_digit())
            && text[range.end..].starts_with(|c: char| c.is_ascii_uppercase());
        attached && range.len() >= 3 && !figure.text.contains('.')
    };
    let mut out = text.to_string();
    for (range, figure) in figures {
        if !fits(&figure) && (possible || designation(&range, &figure)) {
            out.replace_range(range.clone(), &"#".repeat(range.len()));
        }
    }
    out
}

/// The figures of a text that stand before a known unit.
pub fn figures_with_units(text: &str) -> impl Iterator<Item = Printed> {
    figures(text).into_iter().map(|(_, figure)| figure)
}

/// The figures of a text that stand before a known unit, each with where its digits are.
fn figures(text: &str) -> Vec<(Range<usize>, Printed)> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = text
        .get(at..)
        .and_then(|rest| rest.find(|c: char| c.is_ascii_digit()))
        .map(|i| at + i)
    {
        let Some((figure, behind)) = leading(&text[start..]) else {
            break;
        };
        let end = (text.len() - behind.len()).max(start + 1);
        at = end;
        let joined = text[..start].ends_with(|c: char| is_letter(c) || "-/.".contains(c));
        let unit = unit_in(behind.trim_start(), text);
        if !joined && crate::units::parse(&unit).is_some() {
            let digits = text[start..end].trim_end().len();
            let figure = Printed { unit, ..figure };
            found.push((start..start + digits, figure));
        }
    }
    found
}

/// The only figure with a unit in a text, where there is one and no more.
pub fn sole_figure(text: &str) -> Option<Printed> {
    let lower = text.to_lowercase();
    let mut found: Option<Printed> = None;
    let mut at = 0;
    while let Some(start) = lower
        .get(at..)
        .and_then(|rest| rest.find(|c: char| c.is_ascii_digit()))
        .map(|i| at + i)
    {
        let Some((figure, behind)) = leading(&lower[start..]) else {
            break;
        };
        let end = lower.len() - behind.len();
        at = end.max(start + 1);
        // Digits of a name, a date or a number of a certificate.
        let joined = lower[..start].ends_with(|c: char| is_letter(c) || "-/.".contains(c));
        let text_behind = behind.trim_start();
        if joined || starts_counted(text_behind) || behind.starts_with(['-', '/']) {
            continue;
        }
        let unit = unit_in(text_behind, text);
        let level = unit == "%" && (90.0..100.0).contains(&figure.value);
        if level || crate::units::parse(&unit).is_none() {
            continue;
        }
        // `u itself is uncertain by about 24 %` (JCGM 100, E.4.3)
        if has(&lower[..start], &["uncertain by", "不确定度本身", "u 本身"]) {
            continue;
        }
        let front = lower[..start].trim_end().strip_suffix('+');
        if found.is_some() || front.is_some_and(ends_term) {
            return None;
        }
        found = Some(Printed { unit, ..figure });
    }
    found
}

/// Whether a text ends with a term, to which what follows is added.
fn ends_term(front: &str) -> bool {
    let last = front.trim_end().chars().next_back();
    last.is_some_and(|c| c.is_alphanumeric() || matches!(c, '%' | '‰' | '℃' | '°'))
}

/// Limits above and below, each with its sign: `+0.03 / −0.01 mm`, `between −0.01 mm and +0.03 mm`.
pub fn signed_pair(text: &str) -> Option<(Printed, Printed)> {
    let mut signed: Vec<(usize, bool, Printed)> = Vec::new();
    for (at, sign) in text.char_indices().filter(|(_, c)| matches!(c, '+' | '-')) {
        let before = text[..at].chars().next_back();
        let free = before.is_none_or(|c| " (/,;[:".contains(c) || !c.is_ascii());
        let digit = text[at + 1..]
            .trim_start()
            .starts_with(|c: char| c.is_ascii_digit());
        // `+ 2.51/(Re·x)` is a term of a formula.
        let is_alone = |(_, behind): &(Printed, &str)| {
            let behind = behind.trim_start();
            !starts_product(behind) && !starts_quotient(behind)
        };
        let found = leading(&text[at + 1..]).filter(|_| free && digit);
        if let Some((figure, behind)) = found.filter(is_alone) {
            let unit = unit_in(behind.trim_start(), text);
            let unit = if crate::units::parse(&unit).is_some() {
                unit
            } else {
                String::new()
            };
            signed.push((at, sign == '+', Printed { unit, ..figure }));
        }
    }
    /// The two stand together, with a unit, an `and` or a slash between them.
    const APART: usize = 24;
    let pairs = signed.windows(2).filter(|two| two[1].0 - two[0].0 <= APART);
    let (mut plus, mut minus) = pairs
        .filter(|two| two[0].1 != two[1].1)
        .map(|two| {
            let (first, second) = (two[0].2.clone(), two[1].2.clone());
            if two[0].1 {
                (first, second)
            } else {
                (second, first)
            }
        })
        .next()?;
    if plus.unit.is_empty() {
        plus.unit.clone_from(&minus.unit);
    }
    if minus.unit.is_empty() {
        minus.unit.clone_from(&plus.unit);
    }
    Some((plus, minus))
}

/// Whether what follows a number says that it counts readings.
fn starts_counted(text: &str) -> bool {
    const COUNTED: [&str; 23] = [
        "bit",
        "reading",
        "measurement",
        "observation",
        "series",
        "repeat",
        "single",
        "independent",
        "times",
        "次",
        "个",
        "组",
        "天",
        "day",
        "degrees of",
        "determination",
        "sample",
        "operator",
        "run",
        "consecutive",
        "successive",
        "values",
        "indications",
    ];
    COUNTED.iter().any(|word| text.starts_with(word))
}

/// The unit behind a figure, with the case in which the text has it.
fn unit_in(lower: &str, whole: &str) -> String {
    if let Some(name) = crate::units::chinese_name(lower) {
        return name.to_owned();
    }
    let end = lower.find(|c: char| {
        c.is_whitespace()
            || ",;:)(=。、".contains(c)
            || (c.is_alphabetic() && !c.is_ascii() && !"µΩω°".contains(c))
    });
    let unit = lower[..end.unwrap_or(lower.len())].trim_end_matches('.');
    let unit = alone(before_amount(unit));
    // What is left of the whole text has the same length at the end.
    let start = whole.len().checked_sub(lower.len());
    let original = start.and_then(|s| whole.get(s..s + unit.len()));
    let original = original.filter(|original| original.to_lowercase() == unit);
    original.unwrap_or(unit).to_string()
}

/// A unit in front of an amount that the figure is a part of: `mg` of `0.1 mg/5 g`.
fn before_amount(unit: &str) -> &str {
    let parted = unit.split_once('/');
    let of_amount = parted.filter(|(_, by)| by.starts_with(|c: char| c.is_ascii_digit()));
    of_amount.map_or(unit, |(unit, _)| unit)
}

/// A unit of ratios without what it is a ratio of: `%FS`, `ppm×`, `% of reading`.
pub fn alone(unit: &str) -> &str {
    const RATIOS: [&str; 5] = ["%", "％", "‰", "ppm", "ppb"];
    const OF_WHAT: [&str; 13] = [
        "×",
        "*",
        "·",
        "fs",
        "f.s",
        "rdg",
        "of",
        "reading",
        "range",
        "读数",
        "示值",
        "量程",
        "满量程",
    ];
    let is_of = |rest: &str| {
        let rest = rest.trim_start().to_lowercase();
        OF_WHAT.iter().any(|what| rest.starts_with(what))
    };
    let ratio = RATIOS
        .iter()
        .find(|ratio| unit.strip_prefix(**ratio).is_some_and(is_of));
    ratio.map_or(unit, |ratio| &unit[..ratio.len()])
}

/// Whether a text may be the symbol of a quantity: no sign, no unit, and no word.
pub fn may_be_symbol(text: &str) -> bool {
    let letters = text.chars().count() >= 4 && text.chars().all(|c| c.is_ascii_alphabetic());
    let word = letters && text.chars().skip(1).all(|c| c.is_ascii_lowercase());
    text.starts_with(char::is_alphabetic)
        && !text.contains([' ', '=', '/'])
        && !word
        && crate::units::parse(text).is_none_or(|_| text.chars().count() == 1)
}

/// Whether a symbol stands in a text as a word of its own, in its own case.
pub fn has_symbol(text: &str, symbol: &str) -> bool {
    symbol_at(text, symbol, 0).is_some()
}

/// Where a symbol stands in a text as a word of its own.
pub fn symbol_at(text: &str, symbol: &str, from: usize) -> Option<usize> {
    if symbol.is_empty() {
        return None;
    }
    let part = |c: char| c.is_alphanumeric() && !is_chinese(c) || c == '_' || c == '\'';
    let mut at = from;
    while let Some(found) = text.get(at..).and_then(|rest| rest.find(symbol)) {
        let (start, end) = (at + found, at + found + symbol.len());
        let free = !text[..start].chars().next_back().is_some_and(part)
            && !text[end..].chars().next().is_some_and(part);
        // `V.calibration` is a component of V, and has u of its own.
        let mut behind = text[end..].chars();
        let is_owner = behind.next() == Some('.') && behind.next().is_some_and(char::is_alphabetic);
        if free && !is_owner && !(symbol == "a" && is_article(&text[end..])) {
            return Some(start);
        }
        at = start + text[start..].chars().next().map_or(1, char::len_utf8);
    }
    None
}

/// Whether what follows an `a` makes it the article: another word, that joins no names.
fn is_article(behind: &str) -> bool {
    let word: String = behind
        .strip_prefix(' ')
        .unwrap_or_default()
        .chars()
        .take_while(char::is_ascii_alphabetic)
        .collect();
    !word.is_empty() && !matches!(word.as_str(), "and" | "is" | "are" | "was")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_behind_brackets_are_of_both_figures() {
        for (text, whole) in [
            (
                "(23 ± 1) °C and (50 ± 5) %, both",
                "23 °C ± 1  °C and 50 % ± 5  %, both",
            ),
            ("(see note) (2 ± x) V", "(see note) (2 ± x) V"),
        ] {
            let blanks = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert_eq!(blanks(&with_units_inside(text)), blanks(whole));
        }
        // Every bracket is looked at once, and none is a call inside another.
        let many = "(".repeat(100_000);
        assert_eq!(with_units_inside(&many), many);
    }

    /// İ has two letters in small ones, and the signs of ohm and kelvin have shorter ones.
    #[test]
    fn small_letters_keep_their_places() {
        for text in ["İ 16-bit ADC", "U in \u{2126} at 300 \u{212a}", "ΔU ÄÖ"] {
            assert_eq!(lowered(text).len(), text.len(), "{text}");
        }
        assert_eq!(lowered("ΔU ÄÖ"), "δu äö");
    }

    #[test]
    fn figures_are_found_behind_their_words() {
        let after = |text: &str, keys: &[&str]| figure_after(text, keys).map(|p| (p.value, p.unit));
        assert_eq!(
            after("Certificate M-12: U = 0.05 mm, k = 2", &["u"]),
            Some((0.05, "mm".into()))
        );
        assert_eq!(
            after(
                "standard deviation of 10 readings s = 0.012 V",
                &["standard deviation", "s"]
            ),
            Some((0.012, "V".into()))
        );
        assert_eq!(
            after("数字步进 0.01 mm", &["步进"]),
            Some((0.01, "mm".into()))
        );
        assert_eq!(
            after("limits ±0.3 °C, nothing else known", &["limits"]),
            Some((0.3, "°C".into()))
        );
        assert_eq!(after("coverage probability 95 %", &["probability"]), None);
    }

    #[test]
    fn symbols_are_words_of_their_own() {
        assert!(has_symbol("r(dm, m_S) = 0.5", "dm") && !has_symbol("dm_1 is", "dm"));
    }
}
