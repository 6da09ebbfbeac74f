//! From where times of the calendar or of the day are counted, so that a moment is told as the file tells it.

use gumption_core::calendar::{Day, SECONDS_OF_A_DAY};

/// The first time of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Epoch {
    /// Whole seconds since midnight of 1 January 1970, or since midnight of the day, by the clock that the file is written by.
    pub(super) seconds: i64,
    /// What the fields have.
    pub(super) form: Form,
}

/// How times are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// `2026-03-01`
    Date,
    /// `2026-03-01 09:00:01`
    DateAndClock,
    /// `09:00:01`
    Clock,
}

impl Epoch {
    /// The moment so many seconds after the first one, to the day or the second.
    pub fn moment(self, after: f64) -> String {
        let whole = self.seconds.saturating_add(after.round() as i64);
        let (days, of_day) = (
            whole.div_euclid(SECONDS_OF_A_DAY),
            whole.rem_euclid(SECONDS_OF_A_DAY),
        );
        // Of a year that four digits do not have, the days are counted.
        let day =
            Day::at(days).map_or_else(|| format!("1970-01-01 {days:+} d"), |day| day.to_string());
        let (hours, minutes, seconds) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
        let clock = format!("{hours:02}:{minutes:02}:{seconds:02}");
        match self.form {
            Form::Date => day,
            Form::DateAndClock => format!("{day} {clock}"),
            Form::Clock => clock,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_told_as_the_file_tells_them() {
        let of = |seconds, form| Epoch { seconds, form };
        let noon = 20_513 * SECONDS_OF_A_DAY + SECONDS_OF_A_DAY / 2;
        let both = of(noon, Form::DateAndClock);
        assert_eq!(both.moment(0.0), "2026-03-01 12:00:00");
        assert_eq!(both.moment(43_200.4), "2026-03-02 00:00:00");
        assert_eq!(of(noon, Form::Date).moment(365.0 * 86_400.0), "2027-03-01");
        assert_eq!(of(3_661, Form::Clock).moment(86_399.0), "01:01:00");
        assert_eq!(of(-SECONDS_OF_A_DAY, Form::Date).moment(0.0), "1969-12-31");
        assert_eq!(of(0, Form::Date).moment(f64::NAN), "1970-01-01");
        assert_eq!(of(0, Form::Date).moment(1e15), "1970-01-01 +11574074074 d");
    }
}
