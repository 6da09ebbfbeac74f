//! Until when a certificate is to be used, where one of its statements says so.

use gumption_core::calendar::{Day, days_of};
use roxmltree::Node;

use super::xml::{child, children, text};

/// What the statements of a certificate say of its use.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Validity {
    /// The last day, or the day of the next calibration.
    pub until: Option<Day>,
    /// The statements that are marked as not valid, each by its standard, its kind or its identifier.
    pub refused: Vec<String>,
}

/// Words in the kind of a statement (`refType`) that speak of the end of its use, in lower case.
const KINDS: [&str; 5] = [
    "recalibration",
    "nextcalibration",
    "validity",
    "validuntil",
    "expir",
];

/// Reads the statements of a certificate of this date.
pub(super) fn validity(administration: Node<'_, '_>, issued: Option<&str>) -> Validity {
    let mut found = Validity::default();
    let statements = child(administration, "statements").into_iter();
    for statement in statements.flat_map(|all| children(all, "statement")) {
        let word = |name| child(statement, name).map(text);
        let valid = word("valid");
        let norm = word("norm");
        let kind = statement.attribute("refType").unwrap_or_default();
        if matches!(valid, Some("false" | "0")) {
            let identifier = statement.attribute("id").unwrap_or_default();
            let named = [norm.unwrap_or_default(), kind, identifier].into_iter();
            found.refused.extend(
                named
                    .filter(|name| !name.is_empty())
                    .map(str::to_owned)
                    .chain(["statement".to_owned()])
                    .take(1),
            );
        }
        let kind = kind.to_ascii_lowercase();
        // A statement about a standard ends by itself, and not with it the use of the certificate.
        let of_use = KINDS.iter().any(|word| kind.contains(word));
        let of_all = of_use || valid.is_some() && norm.is_none();
        let until = match (word("date"), word("period")) {
            (Some(date), None) if of_use => Day::read(date),
            (begin, Some(period)) if of_all => begin
                .or(issued)
                .and_then(Day::read)
                .and_then(|begin| after(begin, period)),
            _ => None,
        };
        // Of several ends the first one counts.
        let ends = found.until.take().into_iter().chain(until);
        found.until = ends.min();
    }
    found
}

/// The day that is a duration of XML Schema (`P1Y6M`) after another; hours are less than a day.
fn after(begin: Day, period: &str) -> Option<Day> {
    let lengths = period.strip_prefix('P')?;
    let (lengths, hours) = lengths.split_once('T').unwrap_or((lengths, ""));
    let mut digits = String::new();
    let [mut years, mut months, mut days] = [0u64; 3];
    for c in lengths.chars() {
        match c {
            '0'..='9' => digits.push(c),
            'Y' => years = std::mem::take(&mut digits).parse().ok()?,
            'M' => months = std::mem::take(&mut digits).parse().ok()?,
            'D' => days = std::mem::take(&mut digits).parse().ok()?,
            _ => return None,
        }
    }
    let says_nothing = lengths.is_empty() && hours.is_empty();
    /// Nothing is calibrated for longer; what is asked for should not take long either.
    const MOST: u64 = 100;
    if says_nothing || !digits.is_empty() || years > MOST || months > 12 * MOST || days > 366 * MOST
    {
        return None;
    }
    let all = 12 * begin.year + begin.month - 1 + 12 * years + months;
    let (year, month) = (all / 12, all % 12 + 1);
    // A month after the last of January is the last of February.
    let day = begin.day.min(days_of(year, month));
    let without_days = Day { year, month, day };
    Day::at(without_days.since_1970() + days.cast_signed())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_end_on_days_of_the_calendar() {
        for (begin, period, end) in [
            ("2025-03-02", "P1Y", "2026-03-02"),
            ("2024-02-29", "P1Y", "2025-02-28"),
            ("2025-11-30", "P3M", "2026-02-28"),
            ("2025-12-31", "P1D", "2026-01-01"),
            ("2025-01-01", "P1Y6M10DT12H", "2026-07-11"),
            ("2025-01-01", "P730D", "2027-01-01"),
        ] {
            let day = Day::read(begin).and_then(|begin| after(begin, period));
            assert_eq!(day, Day::read(end), "{begin} {period}");
        }
        let begin = Day::read("2025-01-01").expect("a day");
        for period in ["1Y", "-P1Y", "P1W", "P9999999Y", "P", "PY", "P12", "P1Y6"] {
            assert_eq!(after(begin, period), None, "{period}");
        }
    }
}
