//! Numbers and times in the fields of a recording.

use gumption_core::calendar::{Day, SECONDS_OF_A_DAY};
use gumption_core::letters::is_wide;
use gumption_fault::{Said, say};

use super::epoch::{Epoch, Form};
use super::sheet::Sheet;
use crate::spelled::spelled;

/// What a field of a column of numbers holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Field {
    /// A number without a decimal sign; NaN where one is missing.
    Whole(f64),
    /// A number with a decimal point.
    Point(f64),
    /// A number with a decimal comma.
    Comma(f64),
    /// A time of the calendar or of the day.
    Clock(Instant),
}

/// Seconds since midnight of 1 January 1970, or since midnight for a time of the day: whole ones and the
/// rest, so that a microsecond is not lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instant {
    whole: i64,
    rest: f64,
    /// How far the clock that it is written by is ahead of UTC.
    ahead: i64,
    form: Form,
}

impl Instant {
    /// Seconds from another instant to this one.
    pub fn since(self, other: Instant) -> f64 {
        (self.whole - other.whole) as f64 + (self.rest - other.rest)
    }

    /// The same as that from which others are counted.
    pub fn epoch(self) -> Epoch {
        Epoch {
            seconds: self.whole + self.ahead,
            form: self.form,
        }
    }
}

/// What instruments write for a range that was exceeded (SCPI), and for no number.
pub const OVERLOAD: f64 = 9.9e37;

const MISSING: &[&str] = &[
    "",
    "-",
    "--",
    "nan",
    "na",
    "n/a",
    "#n/a",
    "null",
    "none",
    "inf",
    "+inf",
    "-inf",
    "infinity",
    "-infinity",
];

impl Field {
    /// Reads a field; nothing where it holds neither number nor time. A comma is a decimal sign where it
    /// does not separate columns.
    pub fn read(text: &str, sheet: &Sheet) -> Option<Field> {
        if let Some(value) = plain(text) {
            return Some(match text.contains('.') && !value.is_nan() {
                true => Field::Point(value),
                false => Field::Whole(value),
            });
        }
        if says_missing(text) {
            return Some(Field::Whole(f64::NAN));
        }
        if sheet.has_decimal_commas()
            && text.matches(',').count() == 1
            && !text.contains('.')
            && let Some(value) = plain(&text.replace(',', "."))
        {
            return Some(Field::Comma(value));
        }
        instant(text).map(Field::Clock)
    }

    /// Whether it says that there is no number.
    pub fn is_missing(self) -> bool {
        matches!(self, Field::Whole(value) if value.is_nan())
    }

    /// The number; NaN for one that is missing, nothing for a time.
    pub fn number(self) -> Option<f64> {
        match self {
            Field::Whole(value) | Field::Point(value) | Field::Comma(value) => Some(value),
            Field::Clock(_) => None,
        }
    }
}

/// Whether a word says that there is no number.
pub(super) fn says_missing(text: &str) -> bool {
    MISSING.iter().any(|word| text.eq_ignore_ascii_case(word))
}

/// The number in a field of a table; NaN for one that is missing, nothing for what is no number.
pub fn number(text: &str, sheet: &Sheet<'_>) -> Option<f64> {
    Field::read(text, sheet)?.number()
}

/// Days from the beginning of 1970 to a date of the calendar, with or without a time behind it.
pub fn days(text: &str) -> Option<f64> {
    let date = text.split(['T', ' ']).next()?;
    days_of(date)?;
    Some(time(text)? / SECONDS_OF_A_DAY as f64)
}

/// Seconds of a time of the calendar, since the beginning of 1970, or of one of the day.
pub fn time(text: &str) -> Option<f64> {
    let instant = instant(text)?;
    Some(instant.whole as f64 + instant.rest)
}

/// Whether a field says that a range was exceeded.
pub(super) fn is_overload(text: &str) -> bool {
    text.replace(',', ".")
        .parse()
        .is_ok_and(|value: f64| value.is_finite() && value.abs() >= OVERLOAD)
}

fn plain(text: &str) -> Option<f64> {
    let is_plain =
        |byte: u8| byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.' | b'e' | b'E');
    if text.is_empty() || !text.bytes().all(is_plain) {
        return None;
    }
    let value: f64 = text.parse().ok()?;
    Some(if value.abs() < OVERLOAD {
        value
    } else {
        f64::NAN
    })
}

/// A time as ISO 8601 has it: `2026-03-01T09:00:01.25+08:00`, also with a blank for the T, with slashes, as
/// `01.03.2026 09:00:01` or without zone; a date alone, `2026-03-01`; or a time of the day alone, `09:00:01.25`.
fn instant(text: &str) -> Option<Instant> {
    let (date, clock, form) = match text.split_once(['T', ' ']) {
        Some((date, clock)) => (Some(date), clock.trim_start(), Form::DateAndClock),
        // A date alone is the beginning of its day.
        None if days_of(text).is_some() => (Some(text), "00:00", Form::Date),
        None => (None, text, Form::Clock),
    };
    let days = date.map_or(Some(0), days_of)?;
    let (clock, offset) = zone(clock)?;
    let mut parts = clock.split(':');
    let hours = digits(parts.next()?, 2, 23)?;
    let minutes = digits(parts.next()?, 2, 59)?;
    let (seconds, rest) = match parts.next() {
        None => (0, 0.0),
        Some(seconds) => {
            let (whole, fraction) = seconds.split_once(['.', ',']).unwrap_or((seconds, ""));
            if !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
                return None;
            }
            let rest: f64 = format!("0.{fraction}0").parse().ok()?;
            (digits(whole, 2, 60)?, rest)
        }
    };
    if parts.next().is_some() {
        return None;
    }
    let of_day = 3600 * hours + 60 * minutes + seconds;
    Some(Instant {
        whole: SECONDS_OF_A_DAY * days + of_day - offset,
        rest,
        ahead: offset,
        form,
    })
}

/// A number of so many digits (or, for 2, one), not larger than this.
fn digits(text: &str, count: usize, largest: i64) -> Option<i64> {
    let fits = text.len() == count || (count == 2 && text.len() == 1);
    let all = text.bytes().all(|byte| byte.is_ascii_digit());
    let value: i64 = if fits && all {
        text.parse().ok()?
    } else {
        return None;
    };
    (value <= largest).then_some(value)
}

/// Days from 1 January 1970 to a date of the Gregorian calendar.
fn days_of(date: &str) -> Option<i64> {
    let parts: Vec<&str> = match date.strip_suffix(['日', '号']) {
        // The signs say which is which.
        Some(chinese) => {
            let (year, rest) = chinese.split_once('年')?;
            let (month, day) = rest.split_once('月')?;
            vec![year, month, day]
        }
        None => date.split(['-', '/', '.']).collect(),
    };
    // The day goes first with points only: between solidi it may be the month.
    let (year, month, day) = match parts[..] {
        [day, month, year] if date.matches('.').count() == 2 && year.len() == 4 => {
            (year, month, day)
        }
        [year, month, day] => (year, month, day),
        _ => return None,
    };
    let number = |text, count, largest| digits(text, count, largest)?.try_into().ok();
    let day = Day::of(
        number(year, 4, 9999)?,
        number(month, 2, 12)?,
        number(day, 2, 31)?,
    )?;
    Some(day.since_1970())
}

/// The clock without its zone, and how many seconds the zone is ahead of UTC.
fn zone(clock: &str) -> Option<(&str, i64)> {
    if let Some(clock) = clock.strip_suffix(['Z', 'z']) {
        return Some((clock, 0));
    }
    let Some(at) = clock.rfind(['+', '-']) else {
        return Some((clock, 0));
    };
    let (sign, offset) = (&clock[at..=at], &clock[at + 1..]);
    let (hours, minutes) = match offset.split_once(':') {
        Some(parts) => parts,
        None if offset.len() == 4 && offset.is_ascii() => offset.split_at(2),
        None => (offset, "00"),
    };
    let ahead = 3600 * digits(hours, 2, 14)? + 60 * digits(minutes, 2, 59)?;
    Some((&clock[..at], if sign == "-" { -ahead } else { ahead }))
}

/// Whether a field is meant as a time of the calendar or the day, written as it may be.
pub(super) fn is_like_a_time(field: &str) -> bool {
    let signs = field.matches([':', '-', '/', '年', '月']).count();
    (field.len() >= 8 && signs >= 2) || date_parts(field).is_some()
}

/// How a field that is meant as a number is written as one.
pub fn mend_of_number(field: &str) -> Option<Said> {
    let like = |replaced: &str| replaced.parse::<f64>().is_ok();
    let point = field.replace(',', ".");
    let minus = field.replace('−', "-");
    if field.contains(',') && like(&point) {
        let whole = field.replace(',', "");
        return Some(match may_mark_thousands(field) {
            true => say!(
                "write {whole} if the comma marks thousands, {point} if it is the decimal sign"
            ),
            false => say!("write {point}, with a decimal point"),
        });
    }
    if let Some((number, unit)) = spelled(field).filter(|_| field.contains(is_wide))
        && unit.is_empty()
    {
        return Some(say!("write {number}", number = number));
    }
    let without = field.replace([',', '.', ' ', '\'', '\u{a0}', '\u{202f}'], "");
    if field.contains([',', ' ', '\'', '.', '\u{a0}', '\u{202f}'])
        && like(&without)
        && !is_like_a_time(field)
    {
        return Some(say!(
            "write the number with one decimal sign and without marks of thousands"
        ));
    }
    (field.contains('−') && like(&minus)).then(|| say!("write {minus}, with the hyphen as minus"))
}

/// Whether the sign in a number may mark thousands: three digits behind it, one to three before it and not 0.
pub(super) fn may_mark_thousands(field: &str) -> bool {
    let unsigned = field.trim_start_matches(['+', '-']);
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    unsigned
        .split_once(['.', ','])
        .is_some_and(|(whole, behind)| {
            let lengths = (1..=3).contains(&whole.len()) && behind.len() == 3;
            lengths && digits(whole) && digits(behind) && !whole.starts_with('0')
        })
}

/// How a field becomes a number.
pub(super) fn mend(field: &str) -> Said {
    if let Some(mend) = mend_of_number(field) {
        return mend;
    }
    if is_like_a_time(field) {
        return mend_of_time(field);
    }
    if field.starts_with(|c: char| c.is_ascii_digit()) {
        return say!("write the number alone; its unit belongs into the first line");
    }
    say!(
        "leave the field empty if the value is missing; units belong into the first line: name [unit]"
    )
}

fn mend_of_time(field: &str) -> Said {
    let forms = say!(
        "times are read as 2026-03-01T09:00:01.25, as 01.03.2026 09:00:01 (the day first), as 2026-03-01, as 09:00:01.25, or as seconds since the start"
    );
    match date_meant(field) {
        Some(meant) => say!("{forms}; write {meant}"),
        None if field.ends_with(['M', 'm']) => {
            say!("{forms}; hours go from 00 to 23, without AM and PM")
        }
        None => forms.to_owned(),
    }
}

/// How a date is written that has its year at the end, where year or month are in doubt.
pub fn date_meant(field: &str) -> Option<Said> {
    let [first, second, year] = date_parts(field).filter(|[first, ..]| first.len() < 4)?;
    if days_of(&format!("{first}.{second}.{year}")).is_some() && field.contains('.') {
        return None;
    }
    if year.len() < 4 {
        return Some(say!("the year first, with its four digits"));
    }
    let date = |month: &str, day: &str| {
        let date = format!("{year}-{month:0>2}-{day:0>2}");
        days_of(&date).map(|_| date)
    };
    match (date(first, second), date(second, first)) {
        (Some(one), Some(other)) if one != other => {
            Some(say!("{one}, or {other} if the day goes first"))
        }
        (one, other) => one.or(other).map(Said::quoted),
    }
}

/// The three numbers of what may be a date: one or two digits, but for a year of four at an end.
fn date_parts(field: &str) -> Option<[&str; 3]> {
    let date = field.split(['T', ' ']).next()?;
    let parts: Vec<&str> = date.split(['-', '/', '.']).collect();
    let [first, second, third] = parts[..] else {
        return None;
    };
    let all_digits = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
    let lengths = [first, second, third].map(str::len);
    let is_date = matches!(lengths, [1 | 2, 1 | 2, 2 | 4] | [4, 1 | 2, 1 | 2]);
    (is_date && parts.iter().all(all_digits)).then_some([first, second, third])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(text: &str) -> Option<f64> {
        let zero = Instant {
            whole: 0,
            rest: 0.0,
            ahead: 0,
            form: Form::Clock,
        };
        instant(text).map(|instant| instant.since(zero))
    }

    #[test]
    fn what_may_mark_thousands() {
        for text in ["1.234", "-12,500", "+999.000"] {
            assert!(may_mark_thousands(text), "{text}");
        }
        for text in ["0.123", "1.5", "1234.567", "1.2345", "1.5e3", "12", "1.23e"] {
            assert!(!may_mark_thousands(text), "{text}");
        }
    }

    #[test]
    fn instants_count_from_1970() {
        assert_eq!(seconds("1970-01-01T00:00:00Z"), Some(0.0));
        assert_eq!(seconds("2000-03-01 00:00"), Some(951_868_800.0));
        assert_eq!(seconds("2026/03/01 09:00:01.25"), Some(1_772_355_601.25));
        assert_eq!(
            seconds("2026-03-01T09:00:01.25+08:00"),
            Some(1_772_326_801.25)
        );
        assert_eq!(seconds("2026-03-01T09:00:01-0330"), Some(1_772_368_201.0));
        assert_eq!(seconds("9:00:01.5"), Some(32_401.5));
        assert_eq!(seconds("2000-03-01"), Some(951_868_800.0));
        assert_eq!(seconds("2000/3/1"), Some(951_868_800.0));
        assert_eq!(seconds("01.03.2000"), Some(951_868_800.0));
        assert_eq!(seconds("2000.03.01"), Some(951_868_800.0));
        assert_eq!(seconds("1.3.2026 09:00:01.25"), Some(1_772_355_601.25));
        assert_eq!(seconds("2000年3月1日"), Some(951_868_800.0));
        assert_eq!(
            seconds("2026年03月01日 09:00:01.25"),
            Some(1_772_355_601.25)
        );
        for wrong in [
            "2026年13月1日",
            "26年3月1日",
            "3月1日",
            "2026年3月",
            "2026-13-01T00:00",
            "13/03/2026 08:46:58",
            "03/13/2026 08:46:58 AM",
            "03.13.2026 08:46:58",
            "03.03.26",
            "2026-02-30",
            "31.04.2026",
            "09-00",
            "2026-02",
            "9",
            "25:00",
            "10:00:61",
            "1:2:3:4",
            "a:b",
        ] {
            assert_eq!(seconds(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn dates_in_doubt_are_told_apart() {
        for (field, meant) in [
            ("01.03.26", "write the year first, with its four digits"),
            ("03.13.2026 08:46:58", "write 2026-03-13"),
            ("3/4/2026 8:46:58 AM", "write 2026-03-04, or 2026-04-03 if"),
            ("4/4/2026", "write 2026-04-04"),
            ("4/4/26", "write the year first"),
            ("1.3.2026 8:46:58 PM", "without AM and PM"),
            ("2026年3月1日", "times are read as 2026-03-01T"),
        ] {
            assert!(is_like_a_time(field), "{field}");
            let mend = mend(field).to_string();
            assert!(
                mend.contains(meant) && mend.contains("the day first"),
                "{mend}"
            );
        }
        for number in ["1.234.567", "1.2.3", "12.5", "10.1.0.7", "5 V/m"] {
            assert!(!is_like_a_time(number), "{number}");
        }
    }

    #[test]
    fn a_microsecond_is_not_lost() {
        let at = |text: &str| instant(text).expect("a time");
        let difference = at("2026-03-01T09:00:01.000001").since(at("2026-03-01T08:59:59.999999"));
        assert!((difference - 1.000_002).abs() < 1e-12, "{difference}");
    }
}
