//! Superscript digits.

const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// The plain form of a superscript digit or sign.
pub(super) fn lowered(c: char) -> Option<char> {
    match c {
        '⁻' => Some('-'),
        _ => char::from_digit(SUPERSCRIPTS.iter().position(|s| *s == c)? as u32, 10),
    }
}

/// The superscript form of a digit or sign.
pub(super) fn raised(c: char) -> char {
    match c.to_digit(10) {
        Some(digit) => SUPERSCRIPTS[digit as usize],
        None => '⁻',
    }
}
