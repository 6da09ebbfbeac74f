//! Figures as they are printed: value and half a unit in the last place.

use gumption_core::letters;
use gumption_core::quantity::Decimal;
use gumption_format::document::column_letters;

/// Where a figure stands: sheet, row and column, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
pub struct Place {
    /// The sheet of the file.
    pub sheet: usize,
    /// The row of the sheet.
    pub row: usize,
    /// The column of the sheet.
    pub column: usize,
}

impl Place {
    /// As spreadsheets write it: `C7`.
    pub fn a1(&self) -> String {
        format!("{}{}", column_letters(self.column), self.row + 1)
    }
}

/// A figure with what its digits leave open.
#[derive(Debug, Clone, PartialEq)]
pub struct Printed {
    /// The value.
    pub value: f64,
    /// Half a unit in the last printed place; 0 for what is exact (√3, ∞).
    pub half: f64,
    /// Significant digits; trailing zeros of whole numbers are not counted.
    pub digits: usize,
    /// As it stands in the file.
    pub text: String,
    /// The unit that stands behind it, as written; empty for none.
    pub unit: String,
    /// What its cell shows, where that has fewer digits than the figure itself.
    pub shown: Option<String>,
    /// Where it stands.
    pub at: Place,
}

/// Beyond the digits that are printed, figures agree to this relative difference: sheets hold derivatives that were found
/// as quotients of differences, and constants written with seven digits.
const DOUBLE: f64 = 1e-6;

impl Printed {
    /// A figure that is known exactly.
    pub fn exact(value: f64, text: &str) -> Printed {
        let (half, digits, unit) = (0.0, 0, String::new());
        Printed {
            value,
            half,
            digits,
            text: text.trim().into(),
            unit,
            shown: None,
            at: Place::default(),
        }
    }

    /// A figure at the beginning of a text, with the text behind it taken for its unit.
    pub fn parse(text: &str) -> Option<Printed> {
        let clean = clean(text);
        let (mut figure, rest) = leading(&clean)?;
        figure.unit = match inverse_behind(rest) {
            Some(unit) => format!("1/{unit}"),
            None => unit_behind(rest)?.to_string(),
        };
        figure.text = text.trim().to_string();
        Some(figure)
    }

    /// The same, of a cell that shows it with fewer digits.
    #[must_use]
    pub fn called(mut self, shown: &str) -> Printed {
        self.shown = Some(shown.to_string());
        self
    }

    /// As a person reads it.
    pub fn as_read(&self) -> &str {
        self.shown.as_deref().unwrap_or(&self.text)
    }

    /// As a person reads it, with its unit where that stands in the head of its column: behind a bare number.
    pub fn with_unit(&self) -> String {
        let text = self.as_read();
        let is_bare = text.ends_with(char::is_numeric) && !text.ends_with(&self.unit);
        match is_bare {
            true => format!("{text} {}", self.unit),
            false => text.to_string(),
        }
    }

    /// The figure that a person reads, in the unit of this one: rules about digits are about those that are shown.
    pub fn read(&self) -> Printed {
        let read = self.shown.as_deref().and_then(Printed::parse);
        let read = read.filter(|read| read.value != 0.0);
        let own = Printed::parse(&self.text).map_or(0.0, |own| own.value);
        match read {
            Some(read) if own != 0.0 => Printed {
                unit: self.unit.clone(),
                at: self.at,
                ..read.scaled(self.value / own)
            },
            _ => self.clone(),
        }
    }

    /// The same at a place.
    #[must_use]
    pub fn at(mut self, place: Place) -> Printed {
        self.at = place;
        self
    }

    /// Multiplied by an exact factor, as by a conversion of units.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Printed {
        self.value *= factor;
        self.half *= factor.abs();
        self
    }

    /// By what it divides: itself, or the reciprocal of what is below one and multiplies, `0.577` for √3.
    pub(crate) fn into_divisor(self) -> Printed {
        match self.value > 0.0 && self.value < 1.0 {
            true => Printed {
                value: 1.0 / self.value,
                half: self.half / (self.value * self.value),
                ..self
            },
            false => self,
        }
    }

    /// Whether `x`, rounded to nearest, may be printed like this.
    pub fn is_met_by(&self, x: f64) -> bool {
        self.is_met_within(x, self.half)
    }

    /// Whether `x` differs by no more than `half`, or than a computation in doubles leaves open.
    pub fn is_met_within(&self, x: f64, half: f64) -> bool {
        if self.value.is_infinite() || x.is_infinite() {
            return self.value == x;
        }
        // A tie may be rounded either way: a millionth of the half unit decides nothing.
        (x - self.value).abs() <= half * (1.0 + 1e-6) + DOUBLE * self.value.abs().max(x.abs())
    }

    /// Half a unit in the last digit that says something: the zeros of `2800` may be no digits.
    pub fn half_of_digits(&self) -> f64 {
        let zeros = self.half == 0.5 && self.digits > 0;
        let place = libm::floor(libm::log10(self.value.abs())) + 1.0 - self.digits as f64;
        if zeros && place > 0.0 {
            0.5 * libm::exp10(place)
        } else {
            self.half
        }
    }

    /// The same of an expanded uncertainty, of which two digits are printed: the zeros behind them may be none, `2300`, the second digit
    /// is one, `10` and `4000`.
    pub(crate) fn half_of_expanded(&self) -> f64 {
        let places = libm::floor(libm::log10(self.value.abs().max(1.0))) - 1.0;
        match self.half >= 0.5 && places > 0.0 {
            true => self.half_of_digits().min(0.5 * libm::exp10(places)),
            false => self.half,
        }
    }

    /// Whether it is printed with more than two digits, and not with all that a cell holds. What a cell computes, it cannot show
    /// with fewer than its whole number has.
    pub fn is_long(&self) -> bool {
        let read = self.read();
        let is_whole = self.shown.is_some() && read.half >= 0.5;
        !is_whole && (3..=8).contains(&read.digits)
    }

    /// Half a unit in the last digit of an expanded uncertainty that decides: who prints more digits than two shows what a
    /// certificate never states, and the third decides nothing.
    pub(crate) fn half_that_decides(&self) -> f64 {
        let third = 0.5 * libm::exp10(libm::floor(libm::log10(self.value.abs())) - 2.0);
        match self.is_long() || self.digits > 8 {
            true => self.half_of_expanded().max(third),
            false => self.half_of_expanded(),
        }
    }

    /// What the digits of a coefficient leave open, as a ratio: sheets compute with more than they show. Whole numbers are
    /// exact, and less than three digits are no rounded coefficient.
    pub(crate) fn coarseness(&self) -> f64 {
        if self.half >= 0.5 || self.digits < 3 {
            0.0
        } else {
            self.relative_half().min(5e-3)
        }
    }

    /// What the digits of a standard uncertainty leave open, as a ratio, where nothing else is stated of it.
    pub(crate) fn openness(&self) -> f64 {
        /// Of two digits or more: half a unit in the second one is 5 % at most.
        const TWO_DIGITS: f64 = 0.05;
        if self.digits < 2 {
            0.0
        } else {
            self.relative_half().min(TWO_DIGITS)
        }
    }

    /// Whether it may stand for no uncertainty about it: relative width of its rounding.
    pub(crate) fn relative_half(&self) -> f64 {
        if self.value == 0.0 {
            f64::INFINITY
        } else {
            (self.half / self.value).abs()
        }
    }
}

/// A figure in front of a clean text, and what stands behind it.
pub(crate) fn leading(text: &str) -> Option<(Printed, &str)> {
    let text = text.trim_start();
    let text = text
        .strip_prefix("+/-")
        .or_else(|| text.strip_prefix('±'))
        .unwrap_or(text)
        .trim_start();
    infinite(text)
        .or_else(|| root(text))
        .or_else(|| decimal(text))
}

fn infinite(text: &str) -> Option<(Printed, &str)> {
    const WORDS: [&str; 11] = [
        "∞",
        "infinity",
        "infinite",
        "inf.",
        "inf",
        "unendlich",
        "无穷大",
        "无穷",
        "无限大",
        "+∞",
        "oo",
    ];
    let word = WORDS.iter().find(|word| begins(text, word))?;
    let rest = text.get(word.len()..)?;
    let ends = rest.chars().next().is_none_or(|c| !c.is_ascii_alphabetic());
    ends.then(|| (Printed::exact(f64::INFINITY, "∞"), rest))
}

/// Whether a text begins with a word of small letters, in whatever letters; all of a text in small letters, for each of its figures,
/// would be a matter of minutes for a workbook that holds what its charts draw.
fn begins(text: &str, word: &str) -> bool {
    let letters = text.chars().flat_map(char::to_lowercase);
    letters.take(word.chars().count()).eq(word.chars())
}

/// `√3`, `2√3`, `sqrt(3)`, `2*sqrt(3)`, `√(3)`, `1/√3`.
fn root(text: &str) -> Option<(Printed, &str)> {
    let (inverse, rest) = match text.strip_prefix("1/") {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let (front, behind) = rest.split_at(digits);
    let behind = behind
        .trim_start()
        .trim_start_matches(['*', '·', '×'])
        .trim_start();
    let mark = ["√", "sqrt", "根号"]
        .iter()
        .find(|mark| begins(behind, mark))?;
    let inner = behind.get(mark.len()..)?.trim_start();
    let (inner, bracket) = match inner.strip_prefix('(') {
        Some(inner) => (inner, true),
        None => (inner, false),
    };
    let (radicand, rest) = decimal(inner.trim_start())?;
    let rest = if bracket {
        rest.trim_start().strip_prefix(')')?
    } else {
        rest
    };
    let factor = if front.is_empty() {
        1.0
    } else {
        front.parse().ok()?
    };
    let value: f64 = factor * libm::sqrt(radicand.value);
    let value = if inverse { 1.0 / value } else { value };
    Some((Printed::exact(value, text), rest))
}

/// A decimal number with point or comma, blanks between groups, and a power of ten.
fn decimal(text: &str) -> Option<(Printed, &str)> {
    let bytes = text.as_bytes();
    let mut end = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let (mut digits, mut marker) = (false, None);
    let mut plain = text[..end].trim_start_matches('+').to_string();
    while let Some(&byte) = bytes.get(end) {
        let next_is_digit = bytes.get(end + 1).is_some_and(u8::is_ascii_digit);
        match byte {
            b'0'..=b'9' => {
                digits = true;
                plain.push(char::from(byte));
            }
            b'.' | b',' if marker.is_none() && (next_is_digit || (digits && byte == b'.')) => {
                if byte == b',' && is_group(text, end) {
                    end += 1;
                    continue;
                }
                marker = Some(byte);
                plain.push('.');
            }
            // 10 057.62, 0.000 35: groups of three.
            b' ' if digits && groups_follow(bytes, end + 1) => {}
            _ => break,
        }
        end += 1;
    }
    if !digits {
        return None;
    }
    let (ten, behind) = power_of_ten(&text[end..]);
    let number = Decimal::from_text(plain.trim_end_matches('.'))?.shifted(ten);
    let place = number.place()?;
    let significant = number
        .leading_place()
        .map_or(0, |leading| leading - place + 1);
    let digits = match (marker, place >= 0) {
        (None, true) => plain
            .trim_start_matches('-')
            .trim_start_matches('0')
            .trim_end_matches('0')
            .len(),
        _ => usize::try_from(significant).unwrap_or(0),
    };
    let half = 0.5 * libm::exp10(f64::from(place));
    let unit = String::new();
    let text = text[..text.len() - behind.len()].trim().to_string();
    Some((
        Printed {
            value: number.to_f64(),
            half,
            digits,
            text,
            unit,
            shown: None,
            at: Place::default(),
        },
        behind,
    ))
}

/// `1,000` and `12,345.6`: a comma that separates thousands, which a point or another comma behind shows.
fn is_group(text: &str, at: usize) -> bool {
    let behind = &text[at + 1..];
    let three = behind.len() >= 3 && behind.as_bytes()[..3].iter().all(u8::is_ascii_digit);
    let next = behind.as_bytes().get(3);
    let front = text[..at].trim_start_matches(['+', '-']);
    three
        && !front.starts_with('0')
        && front.len() <= 3
        && matches!(next, Some(b'.' | b','))
        && behind.as_bytes().get(4).is_some_and(u8::is_ascii_digit)
}

fn groups_follow(bytes: &[u8], from: usize) -> bool {
    let group = bytes
        .get(from..from + 3)
        .is_some_and(|g| g.iter().all(u8::is_ascii_digit));
    let before = bytes[..from - 1]
        .iter()
        .rev()
        .take_while(|b| b.is_ascii_digit())
        .count();
    // The last group of decimals may be shorter; a space before one or two digits is none inside a number.
    group && before <= 3 && !bytes.get(from + 3).is_some_and(u8::is_ascii_digit)
}

/// `e-5`, `×10^-5`, `x 10-5`, `*10^(-5)`; 0 where there is none.
fn power_of_ten(text: &str) -> (i32, &str) {
    let none = (0, text);
    let signed = |text: &str| -> Option<(i32, usize)> {
        let sign = usize::from(text.starts_with(['+', '-']));
        let digits = text[sign..].bytes().take_while(u8::is_ascii_digit).count();
        let end = sign + digits;
        (digits > 0).then(|| {
            text[..end]
                .trim_start_matches('+')
                .parse()
                .ok()
                .map(|n| (n, end))
        })?
    };
    if let Some(rest) = text.strip_prefix(['e', 'E'])
        && let Some((ten, end)) = signed(rest)
    {
        return (ten, &rest[end..]);
    }
    let trimmed = text.trim_start();
    let Some(times) = trimmed.strip_prefix(['×', 'x', '*', '·', '⋅', 'X']) else {
        return none;
    };
    let Some(rest) = times.trim_start().strip_prefix("10") else {
        return none;
    };
    let rest = rest.trim_start_matches('^').trim_start_matches('{');
    let (rest, bracket) = match rest.strip_prefix('(') {
        Some(rest) => (rest, true),
        None => (rest, false),
    };
    match signed(rest) {
        Some((ten, end)) => {
            let rest = &rest[end..];
            (
                ten,
                if bracket {
                    rest.strip_prefix(')').unwrap_or(rest)
                } else {
                    rest.trim_start_matches('}')
                },
            )
        }
        None => none,
    }
}

/// The unit of which a figure has the inverse: `°C` of `0.58×10^-6 /°C`.
fn inverse_behind(rest: &str) -> Option<&str> {
    let unit = rest.trim().strip_prefix('/')?.trim_start();
    let is_name = unit.starts_with(|c: char| c.is_alphabetic() || c == '°');
    let is_short = unit.chars().count() <= 4 && !unit.contains([' ', '/', '=', ',', ';', ':']);
    (is_name && is_short).then_some(unit)
}

/// The text behind a figure as a unit; `None` where it is none, so that `3 readings of …` is no figure.
fn unit_behind(rest: &str) -> Option<&str> {
    let rest = rest.trim();
    let rest = rest
        .strip_prefix('(')
        .and_then(|r| r.strip_suffix(')'))
        .unwrap_or(rest)
        .trim();
    let words = rest.split_whitespace().count();
    let is_unit = rest.chars().count() <= 14
        && words <= 2
        && !rest.contains(['=', ';', ',', ':'])
        && (rest.starts_with("1/")
            || !rest.starts_with(|c: char| c.is_ascii_digit() || "+-)/".contains(c)));
    is_unit.then_some(rest)
}

/// A text with one form for what is written in many: minus signs, blanks, full-width characters, raised digits.
pub(crate) fn clean(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut raised = false;
    for c in text.chars() {
        if let Some(lowered) = letters::lowered(c) {
            if !raised {
                out.push('^');
            }
            raised = true;
            out.push(lowered);
            continue;
        }
        raised = false;
        if c == '℃' {
            out.push_str("°C");
            continue;
        }
        out.push(match c {
            '−' | '﹣' | '‒' | '–' | '—' => '-',
            '\u{a0}' | '\u{2009}' | '\u{202f}' | '\u{2007}' | '\u{3000}' | '\t' => ' ',
            'μ' => 'µ',
            '÷' => '/',
            '≅' | '≃' | '≒' | '≌' => '≈',
            c => letters::narrow(c),
        });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Option<(f64, f64, String)> {
        Printed::parse(text).map(|p| (p.value, p.half, p.unit))
    }

    #[test]
    fn figures_in_all_spellings() {
        for (text, x, half, unit) in [
            ("0.025", 0.025, 0.0005, ""),
            ("0,025 mm", 0.025, 0.0005, "mm"),
            ("±0.5 %", 0.5, 0.05, "%"),
            ("1.20E-05", 1.2e-5, 5e-8, ""),
            ("2.6×10⁻⁸ A/g", 2.6e-8, 5e-10, "A/g"),
            ("-1.5", -1.5, 0.05, ""),
            ("10 057.62", 10057.62, 0.005, ""),
            ("1,234.5", 1234.5, 0.05, ""),
            ("２．５", 2.5, 0.05, ""),
        ] {
            let (v, h, u) = value(text).unwrap();
            assert!(
                (v - x).abs() < 1e-12 * x.abs().max(1.0) && (h / half - 1.0).abs() < 1e-9,
                "{text}: {v} {h}"
            );
            assert_eq!(u, unit, "{text}");
        }
        assert_eq!(value("∞").unwrap().0, f64::INFINITY);
        assert_eq!(value("Infinity").unwrap().0, f64::INFINITY);
        assert!((value("√3").unwrap().0 - 1.7320508).abs() < 1e-6);
        assert!((value("2√3").unwrap().0 - 3.4641016).abs() < 1e-6);
        assert!((value("SQRT(3)").unwrap().0 - 1.7320508).abs() < 1e-6);
        assert!(
            value("normal").is_none() && value("").is_none() && value("s of 3 readings").is_none()
        );
    }

    #[test]
    fn significant_digits_are_those_printed() {
        let digits = |text| Printed::parse(text).unwrap().digits;
        assert_eq!(
            [
                digits("0.054"),
                digits("0.120"),
                digits("120"),
                digits("1.0"),
                digits("54")
            ],
            [2, 3, 2, 2, 2]
        );
    }

    #[test]
    fn cells_are_named_as_in_spreadsheets() {
        let name = |row, column| {
            Place {
                sheet: 0,
                row,
                column,
            }
            .a1()
        };
        assert_eq!(
            [name(0, 0), name(6, 25), name(9, 26), name(1, 701)],
            ["A1", "Z7", "AA10", "ZZ2"]
        );
    }
}
