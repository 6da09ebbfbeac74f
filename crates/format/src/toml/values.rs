//! What keys may be set to: numbers, texts, dates, amounts.

use std::ops::Range;

use serde_json::{Value, json};
use toml::de::{DeFloat, DeInteger, DeValue};

use super::faults::{AMOUNT, NOT_FINITE, NOT_WHOLE, QUOTED_NUMBER, WRONG_TYPE};
use super::numbers::{
    has_fractional_exponent, of_concise, of_fractional_exponent, of_plus_minus,
    of_prefix_for_point, of_range, parted_by_plus_minus, quotient, without_comma, without_sign,
};
use super::strings::StringMap;
use super::table::{FromToml, Raw, Reader};
use crate::spelled::{day_first, prefix_for_point, range, sexagesimal, spelled};
use gumption_core::calendar::Day;
use gumption_fault::{Fault, Said, say};

fn integer(number: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(number.as_str(), number.radix()).ok()
}

fn float(number: &DeFloat<'_>) -> Option<f64> {
    number.as_str().parse().ok()
}

/// The number that a TOML value is, of either TOML type.
pub fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(number) => integer(number).map(|n| n as f64),
        DeValue::Float(number) => float(number),
        _ => None,
    }
}

/// `"95 %"` where a number stands, such as a probability.
fn quoted_percent(value: &Raw<'_>, text: &str) -> Option<Fault> {
    let percent: f64 = text.trim().strip_suffix(['%', '％'])?.trim().parse().ok()?;
    // Digit by digit: 99.73 % is 0.9973.
    let fraction = format!("{percent}e-2").parse::<f64>().ok()?;
    let fault = Fault::new(
        WRONG_TYPE,
        value.span(),
        say!("expected a number, found the text {text:?}"),
    );
    Some(
        fault
            .label(say!("expected a number"))
            .help(say!("a fraction is written as {fraction}")),
    )
}

/// `"1,1"`: a number but for its comma.
fn has_comma(text: &str) -> bool {
    text.contains(',') && text.replace(',', "").trim().parse::<f64>().is_ok()
}

fn quoted_number(value: &Raw<'_>, text: &str) -> Option<Fault> {
    let number = text.trim();
    // TOML has one word for it.
    let number = match number.parse::<f64>() {
        Ok(f64::INFINITY) => "inf",
        Ok(_) => number,
        Err(_) if ["∞", "无穷", "无穷大"].contains(&number) => "inf",
        Err(_) => return None,
    };
    let fault = Fault::new(
        QUOTED_NUMBER,
        value.span(),
        say!("the number {number} stands in quotes"),
    );
    Some(
        fault
            .label(say!("a text, not a number"))
            .help(say!("remove the quotes: {number}")),
    )
}

/// A number that the file states; refused unless it is finite.
fn finite(number: f64, value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<f64> {
    if number.is_finite() {
        return Some(number);
    }
    let message = say!("{number} is not a finite number");
    let fault = Fault::new(NOT_FINITE, value.span(), message);
    reader.refuse(fault.label(say!("expected a finite number")))
}

impl FromToml for f64 {
    fn expected() -> Said {
        say!("a number")
    }

    fn plural() -> Option<Said> {
        Some(say!("numbers"))
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match (number(value.get_ref()), value.get_ref()) {
            (Some(number), _) => finite(number, value, reader),
            (None, DeValue::String(text)) if quoted_number(value, text).is_some() => {
                reader.faults.extend(quoted_number(value, text));
                None
            }
            (None, DeValue::String(text)) if quoted_percent(value, text).is_some() => {
                reader.faults.extend(quoted_percent(value, text));
                None
            }
            (None, DeValue::String(text)) if has_comma(text) => {
                let help = without_comma(text.trim(), "");
                reader.wrong_type_with(value, say!("a number"), Some(help))
            }
            (None, DeValue::String(text)) if number_and_remark(text).is_some() => {
                let help = number_and_remark(text).map(|number| say!("write {number} alone"));
                reader.wrong_type_with(value, say!("a number"), help)
            }
            (None, DeValue::String(text)) if is_spelled_otherwise(text) => {
                let help = spelled(text).map(|(number, _)| say!("write {number}"));
                reader.wrong_type_with(value, say!("a number"), help)
            }
            (None, DeValue::String(text)) if is_spelled_amount(text) => {
                let help = spelled(text).map(|(number, unit)| {
                    say!("a number stands here, in the unit of its quantity: write {number} if that unit is `{unit}`, and else the number converted to it")
                });
                reader.wrong_type_with(value, say!("a number"), help)
            }
            (None, DeValue::String(text)) if split_amount(text).is_some() => {
                let help = split_amount(text).map(|(number, unit)| {
                    say!("a number stands here, in the unit of its quantity: write {number} if that unit is `{}`, and else the number converted to it", unit_of(text, &unit))
                });
                reader.wrong_type_with(value, say!("a number"), help)
            }
            _ => reader.wrong_type(WRONG_TYPE, value, say!("a number")),
        }
    }

    fn schema() -> Value {
        json!({ "type": "number" })
    }
}

/// Degrees of freedom: a number, or `inf`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dof(pub f64);

impl FromToml for Dof {
    fn expected() -> Said {
        say!("a number or inf")
    }

    fn plural() -> Option<Said> {
        Some(say!("numbers or inf"))
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match number(value.get_ref()) {
            Some(f64::INFINITY) => Some(Dof(f64::INFINITY)),
            _ => f64::read(value, reader).map(Dof),
        }
    }

    fn schema() -> Value {
        json!({ "type": "number", "exclusiveMinimum": 0 })
    }
}

impl FromToml for u64 {
    fn expected() -> Said {
        say!("a whole number")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        let number = f64::read(value, reader)?;
        let exact = match value.get_ref() {
            DeValue::Integer(number) => integer(number).and_then(|n| u64::try_from(n).ok()),
            _ if number >= 0.0 && number.fract() == 0.0 && number < 9e15 => Some(number as u64),
            _ => None,
        };
        exact.or_else(|| {
            reader.refuse(
                Fault::new(
                    NOT_WHOLE,
                    value.span(),
                    say!("{number} is not a whole number from 0 upwards"),
                )
                .label(say!("expected a whole number, 0 or more")),
            )
        })
    }

    fn schema() -> Value {
        json!({ "type": "integer", "minimum": 0 })
    }
}

impl FromToml for bool {
    fn expected() -> Said {
        say!("true or false")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Boolean(truth) => Some(*truth),
            _ => reader.wrong_type(WRONG_TYPE, value, say!("true or false")),
        }
    }

    fn schema() -> Value {
        json!({ "type": "boolean" })
    }
}

impl FromToml for String {
    fn expected() -> Said {
        say!("a text in quotes")
    }

    fn plural() -> Option<Said> {
        Some(say!("texts in quotes"))
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            DeValue::Integer(_) | DeValue::Float(_) => {
                let digits = reader
                    .file
                    .get(value.span())
                    .unwrap_or_default()
                    .to_string();
                reader.refuse(
                    Fault::new(
                        WRONG_TYPE,
                        value.span(),
                        say!("expected a text in quotes, found the number {digits}"),
                    )
                    .label(say!("expected a text in quotes"))
                    .help(say!("if the number is meant as a text, write \"{digits}\"")),
                )
            }
            _ => reader.wrong_type(WRONG_TYPE, value, say!("a text in quotes")),
        }
    }

    fn schema() -> Value {
        json!({ "type": "string" })
    }
}

/// A date: `2027-03-01`, in quotes or not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Date(pub String);

impl FromToml for Date {
    fn expected() -> Said {
        say!("a date such as 2027-03-01")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        let text = match value.get_ref() {
            DeValue::Datetime(date) if date.date.is_some() => date.to_string(),
            DeValue::String(text) => text.trim().to_string(),
            _ => return reader.wrong_type(WRONG_TYPE, value, Self::expected()),
        };
        if Day::read(&text).is_some() {
            Some(Date(text))
        } else {
            let help = no_such_day(&text)
                .or_else(|| day_first(&text).map(|day| say!("write {day}")))
                .or_else(|| Some(say!("write the year, the month and the day: 2027-03-01")));
            reader.wrong_type_with(value, Self::expected(), help)
        }
    }

    fn schema() -> Value {
        json!({ "type": "string", "pattern": "^\\d{4}-\\d{2}-\\d{2}" })
    }
}

/// That a date has the form of one, but is none: `2026-02-30`.
fn no_such_day(text: &str) -> Option<Said> {
    let mut parts = text.split('-');
    let parts = [parts.next()?, parts.next()?, parts.next()?];
    let [year, month, day] = parts.map(|part| part.parse::<u16>().ok());
    let (year, month, day) = (year?, month?, day?);
    if parts.map(str::len) != [4, 2, 2] || !(1..=12).contains(&month) {
        return None;
    }
    let first = |last: &u16| Day::read(&format!("{year:04}-{month:02}-{last:02}")).is_some();
    let last = (28..=31).rev().find(first).filter(|last| day > *last)?;
    Some(say!(
        "this month has {last} days: write the day that is meant"
    ))
}

/// A number in the unit of its surroundings, or with a unit of its own (`"25 µV"`).
#[derive(Debug, Clone, PartialEq)]
pub struct Amount {
    /// The number.
    pub number: f64,
    /// Its unit and the place of the unit in the file.
    pub unit: Option<(String, Range<usize>)>,
}

impl FromToml for Amount {
    fn expected() -> Said {
        say!("a number, or a text with number and unit such as \"25 µV\"")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        let DeValue::String(text) = value.get_ref() else {
            return match number(value.get_ref()) {
                Some(number) => {
                    finite(number, value, reader).map(|number| Amount { number, unit: None })
                }
                None => refuse_amount(value, reader),
            };
        };
        if let Some(fault) = quoted_number(value, text) {
            return reader.refuse(fault);
        }
        match split_amount(text) {
            Some((number, unit)) => {
                let place = StringMap::new(reader.file, value.span());
                let place = place.map_or(value.span(), |map| map.place(unit.clone()));
                Some(Amount {
                    number,
                    unit: Some((written_unit(text, &unit), place)),
                })
            }
            None => reader.refuse(unreadable_amount(value, text)),
        }
    }

    fn schema() -> Value {
        json!({ "type": ["number", "string"] })
    }
}

/// Number and unit of a text such as `25 µV`.
pub fn amount_parts(text: &str) -> Option<(f64, &str)> {
    split_amount(text).map(|(number, unit)| (number, unit_of(text, &unit)))
}

/// The unit of a text such as `25 µV`, as a key of its own would state it.
pub fn unit_of_amount(text: &str) -> Option<String> {
    split_amount(text).map(|(_, unit)| written_unit(text, &unit))
}

/// The unit that stands there, with the sign of a Chinese keyboard as that of others.
fn written_unit(text: &str, place: &Range<usize>) -> String {
    unit_of(text, place).replace('％', "%")
}

/// The unit that stands there: that of an angle in minutes and seconds is the degree, however it is written.
fn unit_of<'t>(text: &'t str, place: &Range<usize>) -> &'t str {
    match sexagesimal(text) {
        Some(_) => "°",
        None => &text[place.clone()],
    }
}

/// The number at the beginning of a text, and where its unit is.
fn split_amount(text: &str) -> Option<(f64, Range<usize>)> {
    if let Some(angle) = sexagesimal(text) {
        return Some(angle);
    }
    let lead = text.len() - text.trim_start().len();
    let body = text.trim();
    // The longest prefix that is a number: `5e-3 V`, but also `5 eV`.
    let (end, number) = (1..=body.len())
        .rev()
        .filter(|end| body.is_char_boundary(*end))
        .filter(|end| body[..*end].ends_with(|c: char| c.is_ascii_digit() || c == '.'))
        .find_map(|end| body[..end].parse::<f64>().ok().map(|number| (end, number)))?;
    let gap = body[end..].len() - body[end..].trim_start().len();
    let unit = lead + end + gap..lead + body.len();
    // Of `0,1 °C` the number is not 0, and neither `10 ± 1 V` nor `1/3` is a number with a unit.
    let rest = body[end..].trim_start();
    let divided = rest.strip_prefix('/').map(str::trim_start);
    let goes_on = rest.starts_with([',', '，', '('])
        || with_factor(body).is_some()
        || parted_by_plus_minus(rest).is_some()
        || is_arithmetic(rest)
        || goes_on_in_a_smaller_unit(rest)
        || spelled(body).is_some()
        || range(body).is_some()
        || prefix_for_point(body).is_some()
        || rest.starts_with('.')
        || divided.is_some_and(|rest| {
            rest.starts_with(|c: char| c.is_ascii_digit() || c == '√') || rest.starts_with("sqrt")
        });
    (number.is_finite() && !unit.is_empty() && !goes_on).then_some((number, unit))
}

/// Whether a formula goes on behind a number: `*0.02`, ` µm + 2.5 ppm`. No unit has a sum, or begins with a sign of
/// multiplication.
fn is_arithmetic(rest: &str) -> bool {
    rest.starts_with(['*', '×', '·', '⋅']) || rest.contains(['+', '＋'])
}

/// A number of another keyboard and nothing else: `1.0３`, of which `1.0` is no number of `３`.
fn is_spelled_otherwise(text: &str) -> bool {
    spelled(text).is_some_and(|(_, unit)| unit.is_empty())
}

/// An amount whose number is written in another way: `1e−3 V`.
fn is_spelled_amount(text: &str) -> bool {
    spelled(text).is_some_and(|(_, unit)| !unit.is_empty())
}

/// An amount behind which stands the coverage factor of another key: `0.05 %` and `2` of `0.05 % (k=2)`.
fn with_factor(text: &str) -> Option<(&str, &str)> {
    let (amount, rest) = text.split_once(['(', '（', ',', '，', ';', '；'])?;
    let factor = rest.trim_end_matches([')', '）', ' ']).trim();
    let factor = factor.strip_prefix(['k', 'K'])?.trim_start();
    let factor = factor.strip_prefix(['=', '＝'])?.trim();
    factor.parse::<f64>().ok()?;
    Some((amount.trim(), factor))
}

/// `min 0.5 s` behind the 2 of `2 min 0.5 s`.
fn goes_on_in_a_smaller_unit(rest: &str) -> bool {
    let words: Vec<&str> = rest.split_whitespace().collect();
    let is_name = |word: &str| word.chars().all(char::is_alphabetic);
    match words.as_slice() {
        [unit, number, smaller] => {
            is_name(unit) && number.parse::<f64>().is_ok() && is_name(smaller)
        }
        _ => false,
    }
}

/// The number of `2 (95 %)` or `2, p = 95 %`.
fn number_and_remark(text: &str) -> Option<&str> {
    let (number, remark) = text.split_once(['(', '（', ',', '，', ';'])?;
    let number = number.trim();
    let is_remark = remark.contains(|c: char| !c.is_ascii_digit() && c != '.');
    // 12.50(3) is a value with its uncertainty.
    let is_concise = remark.trim_end_matches(')').parse::<f64>().is_ok();
    (is_remark && !is_concise && number.parse::<f64>().is_ok()).then_some(number)
}

/// What stands for a date where an amount is expected.
pub fn amount_for_date() -> Said {
    say!("a date is counted from a day that you choose: write the days between them, \"31 d\"")
}

/// A value that is neither a number nor a text.
fn refuse_amount(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Amount> {
    let help = match value.get_ref() {
        DeValue::Array(_) => Some(reader.hints.list_of_amounts.clone()),
        DeValue::Datetime(_) => Some(amount_for_date()),
        _ => None,
    };
    reader.wrong_type_with(value, Amount::expected(), help)
}

fn unreadable_amount(value: &Raw<'_>, text: &str) -> Fault {
    let fault = Fault::new(
        AMOUNT,
        value.span(),
        say!("{text:?} is not a number with a unit"),
    )
    .label(say!("expected a number, then a unit"));
    let bare = text.replace(',', "");
    if let Some((amount, k)) = with_factor(text) {
        fault.help(say!(
            "k has a key of its own: certificate = {{ U = \"{amount}\", k = {k} }}, and in a claim U = … and k = {k}"
        ))
    } else if let Some((number, unit)) = spelled(text) {
        fault.help(match unit.as_str() {
            "" => say!("write {number}"),
            unit => say!("write \"{number} {unit}\""),
        })
    } else if let Some(ends) = range(text) {
        fault.help(of_range(ends))
    } else if let Some(parts) = prefix_for_point(text) {
        fault.help(of_prefix_for_point(parts))
    } else if has_fractional_exponent(text) {
        fault.help(of_fractional_exponent())
    } else if text.contains(',') && split_amount(&bare).is_some() {
        fault.help(without_comma(text.trim(), "\""))
    } else if has_comma(text) {
        fault.help(without_comma(text.trim(), ""))
    } else if let Some(("", amount)) = parted_by_plus_minus(text) {
        fault.help(without_sign(amount))
    } else if let Some((number, rest)) = parted_by_plus_minus(text) {
        fault.help(of_plus_minus(number, rest))
    } else if let Some((number, _)) = text
        .split_once('(')
        .filter(|(number, _)| number.trim().parse::<f64>().is_ok())
    {
        fault.help(of_concise(number.trim()))
    } else if text
        .trim()
        .split_once(' ')
        .is_some_and(|(_, rest)| goes_on_in_a_smaller_unit(rest))
    {
        fault.help(say!("write it in one unit, as \"90 s\" for \"1 min 30 s\""))
    } else if text.trim_start_matches(['+', '＋']).contains(['+', '＋']) {
        fault.help(say!(
            "write the one amount that the sum gives here; U = a + b·L of a certificate is certificate = {{ U = \"a\", reading = \"b\", k = 2 }}, parts of an accuracy specification are specification = {{ reading = \"…\", fixed = \"…\" }}, other reasons for doubt entries of `components`"
        ))
    } else if text.contains(['/', '*', '×', '·', '⋅', '^', '(']) {
        fault.help(match quotient(text) {
            Some(result) => say!("write {result}; formulas stand in a `model`"),
            None => say!("write the number that it gives; formulas stand in a `model`"),
        })
    } else {
        fault.help(say!(
            "write for example \"25 µV\", or a plain number in the unit of the input"
        ))
    }
}

/// A cell of a table of values: a label or a number.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// A label.
    Text(String),
    /// A value.
    Number(f64),
}

impl FromToml for Cell {
    fn expected() -> Said {
        say!("a number or a label")
    }

    fn plural() -> Option<Said> {
        Some(say!("numbers or a label"))
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(text) => Some(Cell::Text(text.to_string())),
            _ => f64::read(value, reader).map(Cell::Number),
        }
    }

    fn schema() -> Value {
        json!({ "type": ["number", "string"] })
    }
}

#[cfg(test)]
mod tests {
    use super::{amount_parts, unit_of_amount};

    #[test]
    fn an_angle_in_minutes_and_seconds_is_in_degrees() {
        for text in ["45°00′36″", "45º00’36”", "45度00分36秒"] {
            assert_eq!(amount_parts(text), Some((45.01, "°")), "{text}");
        }
        assert_eq!(amount_parts("36 ″"), Some((36.0, "″")));
    }

    #[test]
    fn a_text_says_its_unit_with_or_without_a_space() {
        for (text, unit) in [
            ("45°", "°"),
            ("5\u{202f}ppm", "ppm"),
            (" 5％ ", "%"),
            ("5eV", "eV"),
            ("45°00′36″", "°"),
        ] {
            assert_eq!(unit_of_amount(text).as_deref(), Some(unit), "{text}");
        }
        assert_eq!(unit_of_amount("5"), None);
    }
}
