//! Numbers in messages.

/// A number for the eye: `0.5`, `4e-5`, `1.23457e-8`.
pub fn show(number: f64) -> String {
    with_digits(number, AT_A_GLANCE)
}

/// Two numbers that differ, with the digits in which they do: 49.99955 and 49.999552.
pub fn show_apart(one: f64, other: f64) -> [String; 2] {
    /// So many of any decimal a double keeps.
    const KEPT: i32 = 15;
    let both = |digits| [one, other].map(|number| with_digits(number, digits));
    let differing = (AT_A_GLANCE..=KEPT)
        .map(both)
        .find(|[one, other]| one != other);
    differing.unwrap_or_else(|| [one, other].map(|number| number.to_string()))
}

/// A number with so many significant digits: what differences and products leave behind them is nobody's.
pub fn to_digits(number: f64, digits: usize) -> f64 {
    let behind_point = digits.saturating_sub(1);
    let rounded = format!("{number:.behind_point$e}").parse();
    rounded.unwrap_or(number)
}

/// Significant digits that are read at a glance.
const AT_A_GLANCE: i32 = 7;

fn with_digits(number: f64, count: i32) -> String {
    let behind_point = usize::try_from(count - 1).unwrap_or(0);
    let digits = format!("{number:.behind_point$e}");
    let (mantissa, exponent) = digits.split_once('e').unwrap_or((&digits, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..7).contains(&exponent) {
        let places = usize::try_from(count - 1 - exponent).unwrap_or(0);
        let plain = format!("{number:.places$}");
        return if plain.contains('.') {
            trim(&plain)
        } else {
            plain
        };
    }
    format!("{}e{exponent}", trim(mantissa))
}

fn trim(digits: &str) -> String {
    digits
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::{show, show_apart, to_digits};

    #[test]
    fn digits_are_significant() {
        assert_eq!(to_digits(0.1 + 0.2, 12), 0.3);
        assert_eq!(to_digits(-1234.5, 2), -1200.0);
        assert_eq!(to_digits(0.0, 3), 0.0);
        assert_eq!(to_digits(f64::INFINITY, 3), f64::INFINITY);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(show(0.5), "0.5");
        assert_eq!(show(4e-5), "4e-5");
        assert_eq!(show(1234567.0), "1234567");
        assert_eq!(show(-0.001), "-0.001");
        assert_eq!(show(0.0), "0");
        assert_eq!(show(2.0 / 3.0), "0.6666667");
        assert_eq!(show(1.5e12), "1.5e12");
    }

    #[test]
    fn numbers_that_differ_look_different() {
        assert_eq!(show_apart(49.99955, 49.999552), ["49.99955", "49.999552"]);
        assert_eq!(show_apart(1.0, 2.0), ["1", "2"]);
        assert_eq!(show_apart(0.3, 0.1 + 0.2), ["0.3", "0.30000000000000004"]);
    }
}
