//! Quotients that words write out.

use crate::printed::{Printed, leading};

use super::words::starts_quotient;

/// What figures come to that a text divides by two numbers or more: `0.2 % / 2.8 / √2`.
pub(super) fn quotients(text: &str) -> impl Iterator<Item = Printed> {
    let begins = |at: usize| {
        let before = text[..at].chars().next_back();
        text[at..].starts_with(|c: char| c.is_ascii_digit())
            && !before.is_some_and(|c| c.is_alphanumeric() || ".,_/√".contains(c))
    };
    let places = text.char_indices().map(|(at, _)| at);
    places.filter(move |at| begins(*at)).filter_map(|at| {
        let (mut figure, behind) = leading(&text[at..])?;
        let (unit, mut rest) = behind.split_at(behind.find('/')?);
        figure.unit = unit.trim().into();
        let mut divisors = 0;
        while starts_quotient(rest.trim_start()) {
            let (divisor, behind) = leading(&rest.trim_start()[1..])?;
            figure = figure.scaled(1.0 / divisor.value);
            divisors += 1;
            rest = behind;
        }
        (divisors >= 2).then_some(figure)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_divisors_make_a_quotient() {
        let found = |text: &str| -> Vec<String> {
            let figures =
                quotients(text).map(|figure| format!("{:.6} {}", figure.value, figure.unit));
            figures.collect()
        };
        assert_eq!(found("mean of two: 0.2 % / 2.8 / √2"), ["0.050508 %"]);
        assert_eq!(found("0.6 mm/2/√3, k = 2"), ["0.173205 mm"]);
        assert!(found("limits 0.5 / √3").is_empty());
        assert!(found("3 g/L, 5 mm/2").is_empty());
    }
}
