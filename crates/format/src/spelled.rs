//! Numbers and days as they are written elsewhere: with full-width digits, a power of ten, groups of digits, no digit before the point,
//! angles in minutes and seconds; the day first.

use std::ops::Range;

use gumption_core::calendar::Day;
use gumption_core::letters;

/// A number, as TOML writes it, and what stands behind it, of a text that writes the number in another way.
pub(crate) fn spelled(text: &str) -> Option<(String, String)> {
    let narrow: String = text
        .trim()
        .trim_end_matches([';', '；'])
        .chars()
        .map(narrow)
        .collect();
    let (mantissa, rest) = mantissa(narrow.trim());
    let (exponent, rest) = match power_of_ten(rest).or_else(|| exponent(rest)) {
        Some((exponent, rest)) => (format!("e{exponent}"), rest),
        None => (String::new(), rest),
    };
    let number = format!("{mantissa}{exponent}");
    let rest = rest.trim();
    let finite = number.parse::<f64>().is_ok_and(f64::is_finite);
    // What begins with a further number or sign of a calculation is no unit; `/K` behind a power of ten is 1/K.
    let inverse = rest.strip_prefix("1/").or_else(|| rest.strip_prefix('/'));
    let inverse =
        inverse.filter(|unit| !exponent.is_empty() && unit.starts_with(char::is_alphabetic));
    let is_unit = inverse.is_some()
        || !rest.starts_with(|c: char| c.is_ascii_digit() || ".,+-*/^±(=".contains(c));
    let head = narrow
        .trim_end()
        .strip_suffix(rest)
        .unwrap_or_default()
        .trim();
    let text = text.trim();
    let ended = text.ends_with([';', '；']);
    let as_it_is = head.parse::<f64>().is_ok() && text.starts_with(head) && !ended;
    let unit = inverse.map_or_else(|| rest.to_owned(), |unit| format!("1/{unit}"));
    (finite && is_unit && !as_it_is).then_some((number, unit))
}

/// A number whose decimal point is the prefix of its unit, as on components: `1.5` and `k` of `1k5`, with what stands behind it.
pub(crate) fn prefix_for_point(text: &str) -> Option<(String, char, &str)> {
    let text = text.trim();
    let (whole, rest) = digits(text);
    let prefix = rest.chars().next().filter(|c| "pnuµmkMGR".contains(*c))?;
    let (decimals, behind) = digits(&rest[prefix.len_utf8()..]);
    let is_number = !whole.is_empty() && !decimals.is_empty();
    let is_end = behind.is_empty() || behind.starts_with(' ');
    (is_number && is_end).then(|| (format!("{whole}.{decimals}"), prefix, behind.trim()))
}

/// The two numbers of a range, `4.9~5.1`, `4.9 to 5.1` or `1.0..1.2`, and the unit behind it.
pub(crate) fn range(text: &str) -> Option<(String, String, String)> {
    let narrow: String = text.trim().chars().map(narrow).collect();
    let signs = ["~", "～", "…", "...", "..", " to ", "至", "到", "-"];
    signs.iter().find_map(|sign| {
        // The minus of the lower one does not part them.
        let at = narrow.get(1..)?.find(sign)? + 1;
        let (lower, upper) = (narrow[..at].trim(), narrow[at + sign.len()..].trim());
        let of_number = |c: char| c.is_ascii_digit() || "+-.".contains(c);
        let end = upper.len() - upper.trim_start_matches(of_number).len();
        let (upper, unit) = (upper[..end].trim(), upper[end..].trim());
        let lower = lower.strip_suffix(unit).map_or(lower, str::trim_end);
        let in_order = lower.parse::<f64>().ok()? < upper.parse::<f64>().ok()?;
        let is_unit = !unit.contains(['±', '+', '*', ',', '(']);
        (in_order && is_unit).then(|| (lower.to_owned(), upper.to_owned(), unit.to_owned()))
    })
}

/// The digits and signs of another keyboard.
fn narrow(c: char) -> char {
    match c {
        '。' => '.',
        '−' | '–' => '-',
        '\u{a0}' | '\u{2009}' | '\u{202f}' | '\u{3000}' => ' ',
        c => letters::narrow(c),
    }
}

/// The number at the beginning, without spaces between groups of three digits and with digits on both sides of its point.
fn mantissa(text: &str) -> (String, &str) {
    let body = text.trim_start_matches(['+', '-']);
    let sign = &text[..text.len() - body.len()];
    let (mut whole, mut rest) = digits(body);
    let mut joined = whole.to_owned();
    while whole.len() <= 3 && !whole.is_empty() {
        let (group, behind) = digits(rest.strip_prefix([' ', '\'', '_']).unwrap_or(""));
        if group.len() != 3 {
            break;
        }
        joined.push_str(group);
        (whole, rest) = (group, behind);
    }
    let (fraction, rest) = match rest.strip_prefix('.') {
        Some(behind) => groups(behind),
        None => return (format!("{sign}{joined}"), rest),
    };
    let or_zero = |digits: String| {
        if digits.is_empty() {
            "0".into()
        } else {
            digits
        }
    };
    match joined.is_empty() && fraction.is_empty() {
        true => (String::new(), text),
        false => (
            format!("{sign}{}.{}", or_zero(joined), or_zero(fraction)),
            rest,
        ),
    }
}

/// The digits behind a point, without spaces between groups of three; the last group may have fewer (SI Brochure 5.4.4).
fn groups(text: &str) -> (String, &str) {
    let (mut group, mut rest) = digits(text);
    let mut joined = group.to_owned();
    while group.len() == 3 {
        let (next, behind) = digits(rest.strip_prefix(' ').unwrap_or(""));
        if next.is_empty() || next.len() > 3 || behind.starts_with(['/', '^', '.', '(']) {
            break;
        }
        joined.push_str(next);
        (group, rest) = (next, behind);
    }
    (joined, rest)
}

/// The exponent of `x10^-4`, `×10⁻⁴`, `· 10**-4`, and what stands behind it.
fn power_of_ten(text: &str) -> Option<(String, &str)> {
    let behind = text
        .trim_start()
        .strip_prefix(['x', 'X', '×', '·', '⋅', '*'])?;
    let behind = behind.trim_start().strip_prefix("10")?;
    let raised: String = behind.chars().map_while(letters::lowered).collect();
    if !raised.is_empty() {
        let rest = behind.trim_start_matches(|c| letters::lowered(c).is_some());
        return Some((raised, rest));
    }
    // `x10-4` has lost its sign of a power.
    let behind = behind.trim_start();
    let behind = behind
        .strip_prefix("**")
        .or_else(|| behind.strip_prefix('^'))
        .or_else(|| Some(behind).filter(|behind| behind.starts_with(['+', '-'])))?;
    let behind = behind.trim_start_matches(['{', '(']);
    let body = behind.strip_prefix(['+', '-']).unwrap_or(behind);
    let (exponent, rest) = digits(body);
    let sign = if behind.starts_with('-') { "-" } else { "" };
    let closed = rest.trim_start_matches(['}', ')']);
    (!exponent.is_empty()).then(|| (format!("{sign}{exponent}"), closed))
}

/// The exponent of `e-4`, ` E-4` and `D-4`, and what stands behind it.
fn exponent(text: &str) -> Option<(String, &str)> {
    let text = text.trim_start();
    let behind = text.strip_prefix(['e', 'E']).or_else(|| {
        // The day is a unit, `3 d`, and has no sign behind it.
        let behind = text.strip_prefix(['d', 'D'])?;
        behind.starts_with(['+', '-']).then_some(behind)
    })?;
    let (exponent, rest) = digits(behind.strip_prefix(['+', '-']).unwrap_or(behind));
    let sign = if behind.starts_with('-') { "-" } else { "" };
    (!exponent.is_empty()).then(|| (format!("{sign}{exponent}"), rest))
}

/// The digits at the beginning, and what stands behind them.
fn digits(text: &str) -> (&str, &str) {
    let end = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    text.split_at(end)
}

/// An angle in degrees, minutes and seconds, `45°00′03.5″` or `45度00分03.5秒`, as a number of degrees, and where its degree
/// sign is.
pub(super) fn sexagesimal(text: &str) -> Option<(f64, Range<usize>)> {
    let start = text.find(['°', 'º', '˚', '度'])?;
    let sign = text[start..].chars().next()?;
    let behind = start + sign.len_utf8();
    let (minutes, seconds) = text[behind..].split_once(['′', '\'', '’', '分'])?;
    let (minus, degrees) = match text[..start].trim().strip_prefix(['-', '−']) {
        Some(degrees) => (-1.0, degrees),
        None => (1.0, &text[..start]),
    };
    let seconds = match seconds.trim() {
        "" => 0.0,
        written => {
            let number = written.strip_suffix(['″', '"', '”', '秒']);
            below_sixty(number.or_else(|| written.strip_suffix("''"))?)?
        }
    };
    let degrees = unsigned(degrees).filter(|degrees| degrees.fract() == 0.0)?;
    let total = degrees * 3600.0 + below_sixty(minutes)? * 60.0 + seconds;
    Some((minus * total / 3600.0, start..behind))
}

fn below_sixty(text: &str) -> Option<f64> {
    unsigned(text).filter(|number| *number < 60.0)
}

fn unsigned(text: &str) -> Option<f64> {
    let text = text.trim();
    let digits = text.starts_with(|c: char| c.is_ascii_digit());
    text.parse::<f64>().ok().filter(|_| digits)
}

/// Year, month and day of `2027/3/1`, `2027年3月1日` and `1.3.2027`; with slashes the first of two small numbers may be
/// either, and nothing is said.
pub(crate) fn day_first(text: &str) -> Option<String> {
    let mut parts = text
        .split(['.', '/', '-', '年', '月', '日', ' '])
        .filter(|part| !part.is_empty());
    let parts = [parts.next()?, parts.next()?, parts.next()?];
    let [a, b, c] = [
        parts[0].parse::<u16>().ok()?,
        parts[1].parse().ok()?,
        parts[2].parse().ok()?,
    ];
    let (year, month, day) = match (a > 31, c > 31, text.contains('/')) {
        (true, false, _) => (a, b, c),
        (false, true, false) => (c, b, a),
        _ => return None,
    };
    let day = format!("{year:04}-{month:02}-{day:02}");
    Day::read(&day).map(|_| day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_spellings_are_understood() {
        for (text, number, unit) in [
            ("１.０００１", "1.0001", ""),
            ("０.５％", "0.5", "%"),
            ("−0.0003", "-0.0003", ""),
            ("3x10^-4", "3e-4", ""),
            ("3×10^-4 V", "3e-4", "V"),
            ("2.5·10⁻⁶ m", "2.5e-6", "m"),
            ("1.2 * 10**{3}", "1.2e3", ""),
            ("10 000.02", "10000.02", ""),
            ("10.000 000 123 MHz", "10.000000123", "MHz"),
            ("1 234.567 8 kg", "1234.5678", "kg"),
            ("1'000'000", "1000000", ""),
            ("0.0003;", "0.0003", ""),
            ("1e−3 V", "1e-3", "V"),
            ("1.0 E-3 V", "1.0e-3", "V"),
            ("3D-4", "3e-4", ""),
            ("3d+4 V", "3e4", "V"),
            ("3x10-4 V", "3e-4", "V"),
            ("1_000 V", "1000", "V"),
            ("11.5×10^-6/K", "11.5e-6", "1/K"),
            ("11.5x10^-6 1/K", "11.5e-6", "1/K"),
        ] {
            let found = spelled(text);
            assert_eq!(found, Some((number.to_owned(), unit.to_owned())), "{text}");
        }
    }

    #[test]
    fn ranges_and_prefixes_for_points_are_seen() {
        for (text, lower, upper, unit) in [
            ("4.9~5.1 V", "4.9", "5.1", "V"),
            ("4.9 V ～ 5.1 V", "4.9", "5.1", "V"),
            ("-4.9-5.1", "-4.9", "5.1", ""),
            ("-5.1 – -4.9 mA", "-5.1", "-4.9", "mA"),
            ("1.0..1.2", "1.0", "1.2", ""),
            ("4.9 to 5.1 V", "4.9", "5.1", "V"),
            ("4.9至5.1V", "4.9", "5.1", "V"),
        ] {
            let expected = [lower, upper, unit].map(str::to_owned).into();
            assert_eq!(range(text), Some(expected), "{text}");
        }
        for text in [
            "3 V",
            "10-3",
            "1e-3 V",
            "-5 V",
            "5 m^-1",
            "2026-03-01",
            "5 ± 1",
            "",
        ] {
            assert_eq!(range(text), None, "{text}");
        }
        assert_eq!(prefix_for_point("1k5"), Some(("1.5".into(), 'k', "")));
        assert_eq!(
            prefix_for_point("4R7 ohm"),
            Some(("4.7".into(), 'R', "ohm"))
        );
        for text in ["1 k", "1e5", "1k", "5 m3", "1m5x", "k5"] {
            assert_eq!(prefix_for_point(text), None, "{text}");
        }
    }

    #[test]
    fn angles_in_minutes_and_seconds() {
        for (text, degrees) in [
            ("45°30′", 45.5),
            ("45°00′36″", 45.01),
            ("-0° 0' 36.0\"", -0.01),
            ("−1º30’00”", -1.5),
            ("45度00分36秒", 45.01),
            ("45度30分", 45.5),
        ] {
            let (found, sign) = sexagesimal(text).expect(text);
            assert_eq!(found, degrees, "{text}");
            assert!(["°", "º", "度"].contains(&&text[sign]));
        }
        for text in [
            "45°",
            "20摄氏度",
            "3度30",
            "45.5°30′",
            "1°60′",
            "1°30′5",
            "1°-3′",
            "30′",
            "°C",
            "1 °/h",
        ] {
            assert_eq!(sexagesimal(text), None, "{text}");
        }
    }

    #[test]
    fn what_is_no_other_spelling_of_a_number_is_left() {
        for text in [
            "3.9e-3 1/K",
            "2e6V",
            "0.8%",
            ".5 V",
            "5.",
            "1.5 ％",
            "1.5",
            "1.5 V",
            "1.5V",
            "V",
            "",
            "1 2",
            "10 0000",
            "0.123 1/K",
            "1.5 10",
            "x10",
            "3*4",
            "1/3",
            "1,5",
            "5 ± 1",
            "3 d",
            "3 d^-1",
            "3 eV",
            "2 E",
            "1e2.5",
            "x10-4",
        ] {
            assert_eq!(spelled(text), None, "{text}");
        }
    }
}
