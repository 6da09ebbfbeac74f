//! Dates as the command line states and dossiers show them: ISO 8601, UTC.

use std::time::{SystemTime, UNIX_EPOCH};

use super::output::Complaint;
use gumption::fault::say;
use gumption_core::calendar::{Day, SECONDS_OF_A_DAY};

/// Today, or the day that SOURCE_DATE_EPOCH fixes (reproducible-builds.org).
pub(super) fn today() -> Result<String, Complaint> {
    let day = |seconds: u64| Day::at(i64::try_from(seconds).ok()? / SECONDS_OF_A_DAY);
    let today = match std::env::var("SOURCE_DATE_EPOCH") {
        Ok(text) => text.trim().parse().ok().and_then(day).ok_or_else(|| {
            say!("SOURCE_DATE_EPOCH is `{text}`: it must be a whole number of seconds since 1970-01-01")
        })?,
        Err(_) => {
            let since = SystemTime::now().duration_since(UNIX_EPOCH).ok();
            let clock = since.and_then(|since| day(since.as_secs()));
            clock.ok_or_else(|| say!("the clock of this machine shows no day of the calendar"))?
        }
    };
    Ok(today.to_string())
}

/// Accepts a day that exists, written as `2026-01-31`.
pub(super) fn parse(text: &str) -> Result<String, Complaint> {
    match Day::read(text) {
        Some(_) if text.len() == 10 => Ok(text.to_string()),
        _ => Err(say!("`{text}` is no date such as 2026-01-31").into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
