//! The Gregorian calendar.

/// How many days a month (1 to 12) of a year has.
pub fn days_of(year: u64, month: u64) -> u64 {
    let leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 if leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

#[cfg(test)]
mod tests {
    use super::days_of;

    #[test]
    fn leap_years_are_those_of_the_calendar() {
        let february = [1900, 2000, 2024, 2026, 2100].map(|year| days_of(year, 2));
        assert_eq!(february, [28, 29, 29, 28, 28]);
        let year: u64 = (1..=12).map(|month| days_of(2025, month)).sum();
        assert_eq!(year, 365);
    }
}
