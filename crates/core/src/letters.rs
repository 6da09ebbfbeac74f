//! Letters, digits and signs in other forms than those of a plain keyboard: of full width, as a Chinese one writes them, raised,
//! and of other alphabets.

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

/// Letters of other alphabets, and the Latin ones from which no eye tells them; of what stands twice in Unicode, the usual one.
const ALIKE: [(&str, &str); 3] = [
    ("аеорсухіјѕһАВЕКМНОРСТУХІЈЅ", "aeopcyxijshABEKMHOPCTYXIJS"),
    ("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧο", "ABEZHIKMNOPTYXo"),
    ("\u{3bc}\u{2126}\u{212a}", "µ\u{3a9}K"),
];

/// A name in Latin letters wherever another one looks the same.
pub fn in_latin(name: &str) -> String {
    let latin = |c: char| {
        ALIKE.iter().find_map(|(other, latin)| {
            let place = other.chars().position(|other| other == c)?;
            latin.chars().nth(place)
        })
    };
    name.chars().map(|c| latin(c).unwrap_or(c)).collect()
}

/// The first letters in which two names differ that look the same, each with its number in Unicode.
pub fn told_apart(written: &str, meant: &str) -> Option<[String; 2]> {
    let alike = written != meant && in_latin(written) == in_latin(meant);
    let mut pairs = written.chars().zip(meant.chars());
    let (one, other) = pairs.find(|(one, other)| one != other).filter(|_| alike)?;
    Some([one, other].map(|c| format!("U+{:04X}", u32::from(c))))
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
    fn letters_that_look_alike_are_told_apart() {
        for (other, latin) in ALIKE {
            assert_eq!(other.chars().count(), latin.chars().count());
            assert!(other.chars().zip(latin.chars()).all(|(a, b)| a != b));
        }
        let codes = |a: &str, b: &str| told_apart(a, b).map(|codes| codes.join(" "));
        assert_eq!(codes("t_а", "t_a").as_deref(), Some("U+0430 U+0061"));
        assert_eq!(codes("Α", "А").as_deref(), Some("U+0391 U+0410"));
        assert_eq!(codes("a", "a"), None);
        assert_eq!(codes("a", "o"), None);
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
