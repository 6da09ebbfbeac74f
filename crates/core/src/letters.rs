//! Letters, digits and signs in other forms than those of a plain keyboard: of full width, as a Chinese one writes them, and raised.

/// The letter or sign for which one of full width stands, `Ｖ` or `％`; any other as it is.
pub fn narrow(c: char) -> char {
    /// From those of full width to the same of ASCII.
    const APART: u32 = 0xfee0;
    match c {
        '\u{ff01}'..='\u{ff5e}' => char::from_u32(u32::from(c) - APART).unwrap_or(c),
        c => c,
    }
}

/// Whether it is a letter or sign of full width.
pub fn is_wide(c: char) -> bool {
    narrow(c) != c
}

/// Whether it is a Chinese character.
pub fn is_chinese(c: char) -> bool {
    ('\u{4e00}'..='\u{9fff}').contains(&c)
}

const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// The plain form of a raised digit or sign; nothing of another character.
pub fn lowered(c: char) -> Option<char> {
    match c {
        '⁻' => Some('-'),
        '⁺' => Some('+'),
        _ => char::from_digit(RAISED.iter().position(|raised| *raised == c)? as u32, 10),
    }
}

/// The raised form of a digit or a minus; any other character as it is.
pub fn raised(c: char) -> char {
    match c {
        '-' | '−' => '⁻',
        _ => c.to_digit(10).map_or(c, |digit| RAISED[digit as usize]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_wide_letter_has_a_plain_one() {
        let wide: String = ('\u{ff01}'..='\u{ff5e}').map(narrow).collect();
        let plain: String = ('!'..='~').collect();
        assert_eq!(wide, plain);
        assert!(is_wide('％') && !is_wide('%') && !is_wide('、') && !is_wide('。'));
    }

    #[test]
    fn what_is_raised_is_lowered_again() {
        for c in "0123456789-".chars() {
            assert_ne!(raised(c), c);
            assert_eq!(lowered(raised(c)), Some(c));
            assert_eq!(lowered(c), None);
        }
        assert_eq!(
            (raised('−'), lowered('⁺'), raised('/')),
            ('⁻', Some('+'), '/')
        );
    }
}
