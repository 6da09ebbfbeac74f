//! Numbers in messages.

/// A number for the eye: `0.5`, `4e-5`, `1.23457e-8`.
pub fn show(number: f64) -> String {
    let digits = format!("{number:.6e}");
    let (mantissa, exponent) = digits.split_once('e').unwrap_or((&digits, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..7).contains(&exponent) {
        let places = usize::try_from(6 - exponent).unwrap_or(0);
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
    use super::show;

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
}
