//! Amounts that a text writes out: `0.5 %×10 V + 0.05 V`, `20 ppm of 10 V`, `0.0035 % of reading (10 V)`, `0.2/2 V`.

use crate::printed::{Printed, leading};
use crate::units;

use super::words::{alone, starts_quotient};

/// An amount, and how it was made.
struct Amount {
    figure: Printed,
    /// Of a share of another one.
    is_share: bool,
    /// Of several that were added.
    is_sum: bool,
}

/// What a cell of limits comes to that has more than a figure, and what its words say beside it: `a = 0.1 V`, `≤ 0.1 V`,
/// `[-0.1, 0.1] V`, `±(0.5 %×10 V + 0.05 V)`, `0.1 V, k = √3`.
pub(super) fn limit(text: &str) -> Option<(Printed, &str)> {
    let (bare, is_called) = without_lead(text);
    let (figure, behind) = symmetric(bare).or_else(|| bracketed(bare)).or_else(|| {
        let (amount, behind) = sum(bare)?;
        Some((amount.figure, behind))
    })?;
    let behind = behind.trim();
    let is_whole = behind.is_empty() || behind.starts_with([',', ';', '(']);
    let figure = Printed {
        text: text.into(),
        ..figure
    };
    is_whole.then_some((figure, if is_called { text } else { behind }))
}

/// A text with the shares of amounts that it adds, or that stand behind their amount, as what they come to; sums of such shares are
/// the limits of a specification.
pub(super) fn with_shares_made(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit()) {
        let (front, figure) = rest.split_at(at);
        out.push_str(front);
        let is_free = !out.ends_with(|c: char| c.is_ascii_alphanumeric() || "._".contains(c));
        let is_behind =
            || amount(figure).is_some_and(|(first, _)| units::fraction(&first.unit).is_none());
        let made = sum(figure)
            .filter(|(amount, _)| is_free && amount.is_share && (amount.is_sum || is_behind()));
        rest = match made {
            Some((amount, behind)) => {
                let is_said = out.trim_end().ends_with(['±', '=', '(']);
                if amount.is_sum && !is_said {
                    out.push('±');
                }
                out.push_str(&printed(&amount.figure));
                behind
            }
            None => {
                let end = figure.find(|c: char| !c.is_ascii_digit() && !".,".contains(c));
                let (digits, behind) = figure.split_at(end.unwrap_or(figure.len()));
                out.push_str(digits);
                behind
            }
        };
    }
    out + rest
}

/// A figure without what binary fractions add to it.
fn printed(figure: &Printed) -> String {
    let value: f64 = format!("{:.11e}", figure.value)
        .parse()
        .unwrap_or(figure.value);
    format!("{value} {}", figure.unit)
}

/// What is behind the signs and words in front of a limit, and whether a symbol calls it.
fn without_lead(text: &str) -> (&str, bool) {
    const LEADS: [&str; 20] = [
        "±",
        "+/-",
        "≤",
        "⩽",
        "<=",
        "<",
        "maximum",
        "max.",
        "max",
        "at most",
        "about",
        "approx.",
        "ca.",
        "~",
        "≈",
        "约",
        "不超过",
        "不大于",
        "最大",
        "小于",
    ];
    let (mut rest, mut is_called) = (text.trim_start(), false);
    loop {
        let lead = LEADS
            .iter()
            .filter_map(|lead| rest.strip_prefix(lead))
            .next();
        let called = || {
            let (symbol, behind) = rest.split_once('=')?;
            let is_symbol = symbol
                .trim()
                .chars()
                .all(|c| c.is_alphanumeric() || c == '_');
            let is_count = matches!(symbol.trim(), "k" | "n" | "p" | "");
            (is_symbol && !is_count && symbol.starts_with(char::is_alphabetic)).then_some(behind)
        };
        match lead
            .map(|lead| (lead, false))
            .or_else(|| Some((called()?, true)))
        {
            Some((behind, by_symbol)) => {
                (rest, is_called) = (behind.trim_start(), is_called | by_symbol)
            }
            None => return (rest, is_called),
        }
    }
}

/// `[-0.1, 0.1] V`: as far above as below.
fn symmetric(text: &str) -> Option<(Printed, &str)> {
    let (inside, behind) = inside(text)?;
    let (low, high) = inside.split_once([';', ',', '…', '~'])?;
    let (low, high) = (Printed::parse(low)?, Printed::parse(high)?);
    let (unit, behind) = unit(behind.trim_start());
    let unit = if unit.is_empty() { &high.unit } else { unit };
    let figure = Printed {
        unit: unit.into(),
        ..high
    };
    (low.value == -figure.value).then_some((figure, behind))
}

/// `(0.5 %×10 V + 0.05 V)`, `(0.1) V`: the unit may stand behind the bracket.
fn bracketed(text: &str) -> Option<(Printed, &str)> {
    let (inside, behind) = inside(text)?;
    let (amount, rest) = sum(inside)?;
    let (unit, behind) = unit(behind.trim_start());
    let mut figure = amount.figure;
    if figure.unit.is_empty() {
        figure.unit = unit.into();
    }
    (rest.trim().is_empty() && (unit.is_empty() || unit == figure.unit)).then_some((figure, behind))
}

fn inside(text: &str) -> Option<(&str, &str)> {
    let round = || text.strip_prefix('(')?.split_once(')');
    round().or_else(|| text.strip_prefix('[')?.split_once(']'))
}

/// Amounts in front of a text that are added, and what is behind them.
fn sum(text: &str) -> Option<(Amount, &str)> {
    let (mut total, mut rest) = product(text)?;
    while let Some(behind) = rest.trim_start().strip_prefix('+') {
        let (next, behind) = product(behind.trim_start())?;
        let to_total = units::factor(&next.figure.unit, &total.figure.unit)?;
        total.figure.value += to_total * next.figure.value;
        total.figure.half = total.figure.half.max(to_total * next.figure.half);
        (total.is_share, total.is_sum) = (total.is_share | next.is_share, true);
        rest = behind;
    }
    Some((total, rest))
}

/// A figure in front of a text, multiplied by others or divided by numbers, and what is behind it.
fn product(text: &str) -> Option<(Amount, &str)> {
    let (mut figure, mut rest) = amount(text)?;
    let mut is_share = false;
    loop {
        if starts_quotient(rest.trim_start()) {
            let (by, behind) =
                leading(&rest.trim_start()[1..]).filter(|(by, _)| by.value != 0.0)?;
            let (unit, behind) = match figure.unit.as_str() {
                "" => unit(behind.trim_start()),
                _ => ("", behind),
            };
            figure = figure.scaled(1.0 / by.value);
            figure.unit.push_str(unit);
            rest = behind;
        } else if let Some((next, behind)) = times(rest).or_else(|| whole_behind(rest, &figure)) {
            is_share |=
                units::fraction(&figure.unit).is_some() || units::fraction(&next.unit).is_some();
            figure = multiplied(figure, next)?;
            rest = behind;
        } else {
            let is_sum = false;
            return Some((
                Amount {
                    figure,
                    is_share,
                    is_sum,
                },
                rest,
            ));
        }
    }
}

/// Two figures of which one at most has a unit, or one is a share of the other.
fn multiplied(a: Printed, b: Printed) -> Option<Printed> {
    let share = |unit: &str| {
        if unit.is_empty() {
            Some(1.0)
        } else {
            units::fraction(unit)
        }
    };
    let (share, whole, part) = match (share(&a.unit), share(&b.unit)) {
        (Some(share), _) if !b.unit.is_empty() || share == 1.0 => (share, b, a),
        (_, Some(share)) => (share, a, b),
        _ => return None,
    };
    let half = part.half * share * whole.value.abs();
    let made = whole.scaled(share * part.value);
    Some(Printed {
        half: half.max(made.half),
        ..made
    })
}

/// The figure behind a sign of multiplication.
fn times(rest: &str) -> Option<(Printed, &str)> {
    let behind = rest.trim_start().strip_prefix(['×', '*', '·', '⋅'])?;
    amount(behind.trim_start())
}

/// The figure behind the words that say of what a share is one: `of 10 V`, `of reading (10 V)`.
fn whole_behind<'t>(rest: &'t str, share: &Printed) -> Option<(Printed, &'t str)> {
    const WHOLES: [&str; 11] = [
        "the",
        "reading",
        "rdg",
        "value",
        "range",
        "full scale",
        "fs",
        "span",
        "读数",
        "示值",
        "量程",
    ];
    units::fraction(&share.unit)?;
    let rest = rest.trim_start();
    let mut behind = ["of ", "von ", "de "]
        .iter()
        .find_map(|of| rest.strip_prefix(of))?;
    while let Some(rest) = WHOLES
        .iter()
        .find_map(|whole| behind.trim_start().strip_prefix(whole))
    {
        behind = rest;
    }
    match behind.trim_start().strip_prefix('(') {
        Some(inside) => {
            let (figure, behind) = amount(inside.trim_start())?;
            Some((figure, behind.trim_start().strip_prefix(')')?))
        }
        None => amount(behind.trim_start()),
    }
}

/// A figure with its unit, if it has one, and what is behind both.
fn amount(text: &str) -> Option<(Printed, &str)> {
    let is_figure = text.starts_with(|c: char| c.is_ascii_digit());
    let (figure, behind) = leading(text).filter(|_| is_figure)?;
    let (unit, behind) = unit(behind.trim_start());
    let unit = unit.to_owned();
    Some((Printed { unit, ..figure }, behind))
}

/// The unit in front of a text, and what is behind it.
fn unit(text: &str) -> (&str, &str) {
    let ends = |c: char| c.is_whitespace() || ",;:()=。、×*+[]".contains(c);
    let word = &text[..text.find(ends).unwrap_or(text.len())];
    let before_number = word
        .char_indices()
        .filter(|(at, c)| *c == '/' && starts_quotient(&word[*at..]));
    let word = before_number
        .map(|(at, _)| &word[..at])
        .next()
        .unwrap_or(word);
    let own = units::chinese_name(word).unwrap_or(alone(word));
    let is_unit = units::fraction(own).is_some() || units::parse(own).is_some();
    text.split_at(if is_unit { own.len() } else { 0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::printed::clean;

    #[test]
    fn limits_that_cells_write_out() {
        for (text, value, unit) in [
            ("1 % of 10 V", 0.1, "V"),
            ("10000 ppm of 10 V", 0.1, "V"),
            ("1 % × 10 V", 0.1, "V"),
            ("±1 %×10 V", 0.1, "V"),
            ("10 V×1 %", 0.1, "V"),
            ("a = 0.1 V", 0.1, "V"),
            ("≤ 0.1 V", 0.1, "V"),
            ("<0.1 V", 0.1, "V"),
            ("max. 0.1 V", 0.1, "V"),
            ("(0.1) V", 0.1, "V"),
            ("[-0.1, 0.1] V", 0.1, "V"),
            ("(-0.1~0.1) V", 0.1, "V"),
            ("0.2/2 V", 0.1, "V"),
            ("0.2 V/2", 0.1, "V"),
            ("0.2 V÷2", 0.1, "V"),
            ("maximum 0.1 V", 0.1, "V"),
            ("2×0.05 V", 0.1, "V"),
            ("0.1 V, k=√3", 0.1, "V"),
            ("U95=0.1 V", 0.1, "V"),
            ("±(0.5%×10 V+0.05 V)", 0.1, "V"),
            ("0.02 % von 200 N", 0.04, "N"),
            ("±0.05%×2.5 MPa", 0.00125, "MPa"),
            ("0.1", 0.1, ""),
        ] {
            let clean = clean(text);
            let (figure, _) = limit(&clean).unwrap_or_else(|| panic!("{text}"));
            assert!(
                (figure.value - value).abs() < 1e-12,
                "{text}: {}",
                figure.value
            );
            assert_eq!(figure.unit, unit, "{text}");
        }
        for none in [
            "see certificate",
            "5 readings",
            "0.1 of 10",
            "1 V of 10 V",
            "0.1 V/0",
            "k = 2",
            "[-0.1, 0.2] V",
        ] {
            assert!(limit(none).is_none(), "{none}");
        }
    }

    #[test]
    fn shares_in_words_are_made() {
        for (text, made) in [
            (
                "0.0035 % of reading (10 V) + 0.0006 % of range (100 V)",
                "±0.00095 V",
            ),
            ("允许误差2.5 MPa×0.05%", "允许误差0.00125 MPa"),
            ("U = 20 ppm of 10 V, k = 2", "U = 20 ppm of 10 V, k = 2"),
            (
                "0.1/√3 of 5 readings at 20 °C",
                "0.1/√3 of 5 readings at 20 °C",
            ),
            (
                "±(35 ppm of reading + 2.5 µV)",
                "±(35 ppm of reading + 2.5 µV)",
            ),
        ] {
            assert_eq!(with_shares_made(text), made);
        }
    }
}
