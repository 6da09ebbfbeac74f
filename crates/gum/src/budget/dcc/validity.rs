//! Until when a certificate is to be used, where one of its statements says so.

use gumption_core::calendar::days_of;
use roxmltree::Node;

use super::xml::{child, children, text};

/// What the statements of a certificate say of its use.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Validity {
    /// The last day, or the day of the next calibration.
    pub until: Option<String>,
    /// Whether it says of itself that it is not valid.
    pub refused: bool,
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
        found.refused |= matches!(valid, Some("false" | "0"));
        let kind = statement.attribute("refType").unwrap_or_default();
        let kind = kind.to_ascii_lowercase();
        let of_use = KINDS.iter().any(|word| kind.contains(word));
        let until = match (word("date"), word("period")) {
            (Some(date), None) if of_use => date.get(..10).map(str::to_owned),
            (begin, Some(period)) if of_use || valid.is_some() => {
                begin.or(issued).and_then(|begin| after(begin, period))
            }
            _ => None,
        };
        // Of several ends the first one counts.
        let ends = found.until.take().into_iter().chain(until);
        found.until = ends.min();
    }
    found
}

/// The day that is a duration of XML Schema (`P1Y6M`) after another; hours are less than a day.
fn after(begin: &str, period: &str) -> Option<String> {
    let number = |part: Option<&str>| part?.parse::<u64>().ok();
    let (mut year, mut month, mut day) = (
        number(begin.get(..4))?,
        number(begin.get(5..7))?,
        number(begin.get(8..10))?,
    );
    let lengths = period.strip_prefix('P')?;
    let lengths = lengths.split('T').next().unwrap_or_default();
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
    /// Nothing is calibrated for longer; what is asked for should not take long either.
    const MOST: u64 = 100;
    if years > MOST || months > 12 * MOST || days > 366 * MOST || !(1..=12).contains(&month) {
        return None;
    }
    let all = 12 * year + month - 1 + 12 * years + months;
    (year, month) = (all / 12, all % 12 + 1);
    // A month after the last of January is the last of February.
    day = day.min(days_of(year, month)) + days;
    while day > days_of(year, month) {
        day -= days_of(year, month);
        (year, month) = if month == 12 {
            (year + 1, 1)
        } else {
            (year, month + 1)
        };
    }
    Some(format!("{year:04}-{month:02}-{day:02}"))
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
            assert_eq!(
                after(begin, period).as_deref(),
                Some(end),
                "{begin} {period}"
            );
        }
        for period in ["1Y", "-P1Y", "P1W", "P9999999Y", "P", "PY"] {
            assert!(
                after("2025-01-01", period).is_none_or(|end| end == "2025-01-01"),
                "{period}"
            );
        }
    }
}
