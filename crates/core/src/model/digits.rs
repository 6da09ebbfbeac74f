//! How far the digits tell a number that is written in a formula.

/// Rounding of 0.01745 or 57.3 by the user.
pub const NEAR: f64 = 1e-3;

/// Fewer digits name a number of their own, 9.8 or 57, rather than the rounded value of another.
const FEWEST: usize = 3;

/// Half a unit of the last digit relative to the number, for one that may have been rounded: it has three significant digits
/// or more. Noughts at the end of a whole number tell nothing. A shorter number is exact.
pub fn tolerance(text: &str) -> f64 {
    let (mantissa, _) = text.split_once(['e', 'E']).unwrap_or((text, ""));
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let digits = digits.trim_start_matches('0');
    let digits = match mantissa.contains('.') {
        true => digits,
        false => digits.trim_end_matches('0'),
    };
    match digits.parse::<f64>() {
        Ok(number) if digits.len() >= FEWEST => 0.5 / number,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::tolerance;

    #[test]
    fn digits_tell_as_much_as_half_of_their_last_place() {
        for (text, expected) in [
            ("1000", 0.0),
            ("9.8", 0.0),
            ("0.017", 0.0),
            ("9.81", 0.5 / 981.0),
            ("0.4536", 0.5 / 4536.0),
            ("9550", 0.5 / 955.0),
            ("1.00", 0.5 / 100.0),
            ("6.895e-3", 0.5 / 6895.0),
        ] {
            assert_eq!(tolerance(text), expected, "{text}");
        }
    }
}
