//! The Gregorian calendar.

/// Seconds of a day without leap second.
pub const SECONDS_OF_A_DAY: i64 = 86_400;

const DAYS_OF_400_YEARS: i64 = 146_097;
/// From the first of March of the year 0.
const DAYS_TO_1970: i64 = 719_468;

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

/// A day of that calendar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Day {
    /// From 0 to 9999.
    pub year: u64,
    /// From 1 to 12.
    pub month: u64,
    /// From 1 on.
    pub day: u64,
}

impl Day {
    /// The day with which a date of ISO 8601 begins, `2027-03-01` and any time behind it; nothing where there is no
    /// such day.
    pub fn read(text: &str) -> Option<Day> {
        let (date, _) = text.split_at_checked(10)?;
        let mut parts = date.split('-');
        let mut number = |digits: usize| {
            let part = parts.next().filter(|part| part.len() == digits)?;
            let plain = part.bytes().all(|byte| byte.is_ascii_digit());
            plain.then(|| part.parse::<u64>().ok()).flatten()
        };
        Day::of(number(4)?, number(2)?, number(2)?)
    }

    /// The day of these numbers; nothing where there is no such day.
    pub fn of(year: u64, month: u64, day: u64) -> Option<Day> {
        let exists =
            year <= 9999 && (1..=12).contains(&month) && (1..=days_of(year, month)).contains(&day);
        exists.then_some(Day { year, month, day })
    }

    /// Days since 1970-01-01, fewer than none before.
    pub fn since_1970(self) -> i64 {
        let (year, month, day) = (self.year as i64, self.month as i64, self.day as i64);
        // Years that begin in March have their leap day at the end.
        let year = if month <= 2 { year - 1 } else { year };
        let months = (month + 9) % 12;
        let of_year = (153 * months + 2) / 5 + day - 1;
        let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
        365 * year + leap_days + of_year - DAYS_TO_1970
    }

    /// The day that is so many days after 1970-01-01, or before it; nothing where its year has no four digits.
    pub fn at(days: i64) -> Option<Day> {
        // Periods of 400 years that begin in March are alike, and have their leap days at the end of four years, which have none
        // at the end of a century, but for the last one.
        let since_march_of_0 = days.checked_add(DAYS_TO_1970)?;
        let periods = since_march_of_0.div_euclid(DAYS_OF_400_YEARS);
        let of_period = since_march_of_0.rem_euclid(DAYS_OF_400_YEARS);
        let leap_days = of_period / 1460 - of_period / 36_524 + of_period / 146_096;
        let year = (of_period - leap_days) / 365;
        let of_year = of_period - (365 * year + year / 4 - year / 100);
        let months = (5 * of_year + 2) / 153;
        let day = of_year - (153 * months + 2) / 5 + 1;
        let month = (months + 2) % 12 + 1;
        let year = 400 * periods + year + i64::from(month <= 2);
        let number = |of: i64| u64::try_from(of).ok();
        Day::of(number(year)?, number(month)?, number(day)?)
    }
}

impl std::fmt::Display for Day {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

#[cfg(test)]
mod tests {
    use super::{Day, days_of};

    #[test]
    fn only_days_of_the_calendar_are_read() {
        for (text, day) in [
            ("2027-03-01", Some("2027-03-01")),
            ("2024-02-29T08:00:00Z", Some("2024-02-29")),
            ("2025-02-29", None),
            ("2025-13-01", None),
            ("2025-00-10", None),
            ("0000000000", None),
            ("not a date", None),
            ("2025-+1-01", None),
            ("2025-1-1", None),
            ("２０25-01", None),
        ] {
            assert_eq!(
                Day::read(text).map(|day| day.to_string()).as_deref(),
                day,
                "{text}"
            );
        }
    }

    #[test]
    fn days_are_counted_from_1970() {
        let day = |days| Day::at(days).map(|day| day.to_string()).unwrap_or_default();
        assert_eq!(day(0), "1970-01-01");
        assert_eq!(day(-1), "1969-12-31");
        assert_eq!(day(59), "1970-03-01");
        // 2000 was a leap year, 2100 is none.
        assert_eq!(day(11_016), "2000-02-29");
        assert_eq!(day(20_454), "2026-01-01");
        assert_eq!(day(47_540), "2100-02-28");
        assert_eq!(day(47_541), "2100-03-01");
        assert_eq!(day(146_097), "2370-01-01");
        // The first day of the Gregorian calendar, and that of Julian day 2 451 545 (J2000) less its 10 957 days since 1970.
        let since = |text| Day::read(text).map(Day::since_1970);
        assert_eq!(since("1582-10-15"), Some(2_299_161 - 2_440_588));
        assert_eq!(since("1969-12-31"), Some(-1));
        assert_eq!(since("2000-01-01"), Some(10_957));
    }

    /// Each day is the one after the last, from the first with four digits to the last.
    #[test]
    fn every_day_follows_the_one_before() {
        let first = Day::of(0, 1, 1).expect("a day").since_1970();
        let last = Day::of(9999, 12, 31).expect("a day").since_1970();
        let (mut year, mut month, mut day) = (0, 1, 1);
        for days in first..=last {
            let found = Day::at(days);
            assert_eq!(found, Some(Day { year, month, day }));
            assert_eq!(found.map(Day::since_1970), Some(days));
            day += 1;
            if day > days_of(year, month) {
                (month, day) = (month + 1, 1);
            }
            if month > 12 {
                (year, month) = (year + 1, 1);
            }
        }
        for beyond in [first - 1, last + 1, i64::MIN, i64::MAX] {
            assert_eq!(Day::at(beyond), None, "{beyond}");
        }
    }

    #[test]
    fn leap_years_are_those_of_the_calendar() {
        let february = [1900, 2000, 2024, 2026, 2100].map(|year| days_of(year, 2));
        assert_eq!(february, [28, 29, 29, 28, 28]);
        let year: u64 = (1..=12).map(|month| days_of(2025, month)).sum();
        assert_eq!(year, 365);
    }
}
