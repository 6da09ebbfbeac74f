//! A value beside the limits by which it is judged, with as many digits as the judgement needs: whoever compares what
//! is printed comes to the same verdict. Judged is the value itself, before it is rounded (GB/T 8170, 4.3.2 calls that
//! the comparison of full values).

use crate::language::Language;
use crate::number::TABLE_DIGITS;
use gumption_fault::say;
use gumption_gum::budget::Interval;

/// More digits than doubles have are no help.
const MOST: u8 = 15;

/// What is compared, and how it is printed with so many digits.
pub(super) struct Compared<'a> {
    pub value: f64,
    pub limits: &'a [Interval],
    pub print_value: &'a dyn Fn(u8) -> String,
    pub print_limit: &'a dyn Fn(f64, u8) -> String,
}

impl Compared<'_> {
    /// The least number of digits with which the printed numbers compare as the numbers do.
    pub(super) fn digits(&self) -> u8 {
        let tells = |digits: &u8| self.agrees(&(self.print_value)(*digits), *digits);
        (TABLE_DIGITS..MOST).find(tells).unwrap_or(MOST)
    }

    /// The value in full, where it does not compare with the limits as its rounded form does.
    pub(super) fn in_full(&self, rounded: &str) -> Option<String> {
        let digits = self.digits();
        (!self.agrees(rounded, digits)).then(|| (self.print_value)(digits))
    }

    fn agrees(&self, printed: &str, digits: u8) -> bool {
        let Some(value) = number(printed) else {
            return true;
        };
        let shown = |limit: f64| match limit.is_finite() {
            true => number(&(self.print_limit)(limit, digits)).unwrap_or(limit),
            false => limit,
        };
        self.limits.iter().all(|limits| {
            let [lower, upper] = [limits.lower, limits.upper].map(shown);
            Interval { lower, upper }.contains_decimal(value) == limits.contains_decimal(self.value)
        })
    }
}

/// A rounded value with what it was before.
pub fn with_unrounded(rounded: &str, in_full: Option<&str>, l: Language) -> String {
    match in_full {
        None => rounded.to_owned(),
        Some(full) => say!("{rounded} (unrounded {full})").in_language(l),
    }
}

/// A printed number.
fn number(printed: &str) -> Option<f64> {
    printed.replace('−', "-").replace("×10^", "e").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::aligned;

    fn in_full(value: f64, lower: f64, rounded: &str) -> Option<String> {
        let (u, upper) = (0.0062, f64::INFINITY);
        Compared {
            value,
            limits: &[Interval { lower, upper }],
            print_value: &|digits| aligned(value, u, digits),
            print_limit: &|limit, digits| aligned(limit, u, digits),
        }
        .in_full(rounded)
    }

    #[test]
    fn digits_that_a_verdict_needs() {
        assert_eq!(in_full(100.0124, 100.02, "100.012"), None);
        assert_eq!(
            in_full(99.9996, 100.0, "100.000").as_deref(),
            Some("99.99960")
        );
        assert_eq!(
            in_full(100.01244, 100.01236, "100.012").as_deref(),
            Some("100.01244")
        );
        // On the limit is within, and what rounds onto it from within as well.
        assert_eq!(in_full(100.0, 100.0, "100.000"), None);
        assert_eq!(in_full(100.0004, 100.0, "100.000"), None);
        let near = in_full(100.012_440_1, 100.012_440_2, "100.0125");
        assert_eq!(near.as_deref(), Some("100.0124401"));
    }
}
