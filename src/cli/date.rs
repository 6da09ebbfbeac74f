//! Dates as the command line states and dossiers show them: ISO 8601, UTC.

use std::time::{SystemTime, UNIX_EPOCH};

use super::output::Complaint;
use gumption::fault::say;
use gumption_core::calendar::days_of;

const SECONDS_OF_A_DAY: u64 = 86_400;

/// Today, or the day that SOURCE_DATE_EPOCH fixes (reproducible-builds.org).
pub(super) fn today() -> Result<String, Complaint> {
    let seconds = match std::env::var("SOURCE_DATE_EPOCH") {
        Ok(text) => text.trim().parse().map_err(|_| {
            say!("SOURCE_DATE_EPOCH is `{text}`: it must be a whole number of seconds since 1970-01-01")
        })?,
        Err(_) => SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |since| since.as_secs()),
    };
    Ok(day(seconds / SECONDS_OF_A_DAY))
}

/// A day of the Gregorian calendar from the number of days since 1970-01-01.
fn day(since_1970: u64) -> String {
    // Periods of 400 years are alike; the count of years and months in the last one is short.
    const DAYS_OF_400_YEARS: u64 = 146_097;
    let mut year = 1970 + 400 * (since_1970 / DAYS_OF_400_YEARS);
    let mut left = since_1970 % DAYS_OF_400_YEARS;
    let length = |year| 337 + days_of(year, 2);
    while left >= length(year) {
        left -= length(year);
        year += 1;
    }
    let mut month = 1;
    while left >= days_of(year, month) {
        left -= days_of(year, month);
        month += 1;
    }
    format!("{year:04}-{month:02}-{:02}", left + 1)
}

/// Accepts a day that exists, written as `2026-01-31`.
pub(super) fn parse(text: &str) -> Result<String, Complaint> {
    let fault = || Complaint::from(say!("`{text}` is no date such as 2026-01-31"));
    let parts: Vec<&str> = text.split('-').collect();
    let [year, month, day] = parts.as_slice() else {
        return Err(fault());
    };
    let widths = [year.len(), month.len(), day.len()];
    let digits = parts
        .iter()
        .all(|part| part.bytes().all(|b| b.is_ascii_digit()));
    if widths != [4, 2, 2] || !digits {
        return Err(fault());
    }
    let number = |part: &str| part.parse::<u64>().map_err(|_| fault());
    let (year, month, day) = (number(year)?, number(month)?, number(day)?);
    if (1..=12).contains(&month) && (1..=days_of(year, month)).contains(&day) {
        Ok(text.to_string())
    } else {
        Err(fault())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_of_the_calendar() {
        assert_eq!(day(0), "1970-01-01");
        assert_eq!(day(59), "1970-03-01");
        // 2000 was a leap year, 2100 is none.
        assert_eq!(day(11_016), "2000-02-29");
        assert_eq!(day(20_454), "2026-01-01");
        assert_eq!(day(47_540), "2100-02-28");
        assert_eq!(day(47_541), "2100-03-01");
        assert_eq!(day(146_097), "2370-01-01");
    }

    #[test]
    fn a_stated_day_must_exist() {
        assert!(parse("2026-01-31").is_ok() && parse("2024-02-29").is_ok());
        for wrong in [
            "2026-02-29",
            "2026-13-01",
            "26-01-01",
            "2026-1-1",
            "today",
            "2026-01-00",
        ] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
