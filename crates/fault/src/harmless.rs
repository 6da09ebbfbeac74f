//! Text that is shown and not obeyed: what a file says must not command a terminal, nor turn the order of what is read.

use std::borrow::Cow;

/// The text with a visible sign in the place of every character that a terminal or a page would obey.
///
/// Control characters (Unicode's Cc) become their pictures (`␛`), a tab becomes a space; marks of direction and
/// invisible ones (Trojan Source, CVE-2021-42574) become `�`. Line feeds stay: whoever draws lines decides on them.
pub fn harmless(text: &str) -> Cow<'_, str> {
    if !text.chars().any(is_obeyed) {
        return Cow::Borrowed(text);
    }
    text.chars().map(sign).collect::<String>().into()
}

/// Whether a terminal or a page obeys a character in place of showing it. Line feeds and soft hyphens are the
/// program's own.
pub fn is_obeyed(c: char) -> bool {
    match c {
        '\n' | '\u{AD}' => false,
        // Direction.
        '\u{61C}' | '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{206F}' => {
            true
        }
        // Ends of lines and paragraphs; nothing at all; annotations; tags.
        '\u{2028}' | '\u{2029}' | '\u{200B}' | '\u{2060}'..='\u{2065}' | '\u{FEFF}' => true,
        '\u{FFF9}'..='\u{FFFB}' | '\u{E0000}'..='\u{E0FFF}' => true,
        _ => c.is_control(),
    }
}

/// What is shown instead of a character.
fn sign(c: char) -> char {
    match c {
        '\t' => ' ',
        '\u{7F}' => '␡',
        c if c.is_ascii_control() && c != '\n' => {
            char::from_u32('␀' as u32 + c as u32).unwrap_or(char::REPLACEMENT_CHARACTER)
        }
        c if is_obeyed(c) => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}

/// The lines of a file to be drawn with marks under them: every sign takes as many bytes as the character that it
/// stands for. Those of one byte are left to the renderer, which shows them as pictures.
pub(crate) fn harmless_in_place(text: &str) -> Cow<'_, str> {
    if !text.chars().any(|c| is_obeyed(c) && !c.is_ascii()) {
        return Cow::Borrowed(text);
    }
    let sign = |c: char| match c.len_utf8() {
        _ if !is_obeyed(c) => c,
        2 => '¿',
        3 => char::REPLACEMENT_CHARACTER,
        4 => '\u{1FBC4}',
        _ => c,
    };
    text.chars().map(sign).collect::<String>().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_harmless_is_not_touched() {
        let text = "U = 0.12 µV, 电压 ± 2\nنص עברית e\u{301} 👩\u{200d}🔬";
        assert!(matches!(harmless(text), Cow::Borrowed(_)));
    }

    #[test]
    fn commands_become_signs() {
        assert_eq!(harmless("a\x1b[31mb\x07\x7f\tc"), "a␛[31mb␇␡ c");
        assert_eq!(harmless("\u{9b}2J\u{202e}x\u{2069}\u{85}"), "�2J�x��");
    }

    #[test]
    fn no_character_remains_and_places_are_kept() {
        for c in '\0'..=char::MAX {
            let text = c.to_string();
            assert!(!harmless(&text).chars().any(is_obeyed), "{c:?}");
            let line = harmless_in_place(&text);
            assert_eq!(line.len(), text.len());
            assert!(
                !line.chars().any(|c| is_obeyed(c) && !c.is_ascii()),
                "{c:?}"
            );
        }
    }
}
