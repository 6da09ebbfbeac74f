//! Texts as glyphs, and their lines.

use gumption_format::render::inline::{Run, runs};

use super::fonts::{Fonts, Style};

/// A glyph with its place in the text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Letter {
    pub character: char,
    pub face: usize,
    pub glyph: u32,
    /// Its advance as a part of the size.
    pub advance: f32,
    /// Size in points.
    pub size: f32,
    /// How far it stands above the line.
    pub rise: f32,
}

impl Letter {
    /// Width in points.
    pub fn width(&self) -> f32 {
        self.advance * self.size
    }
}

/// Characters that no font has.
#[derive(Debug, Default)]
pub(super) struct Missing(pub Vec<char>);

/// The glyphs of a text: between backquotes of equal widths, powers of ten raised.
pub(super) fn set(
    text: &str,
    style: Style,
    size: f32,
    fonts: &Fonts,
    missing: &mut Missing,
) -> Vec<Letter> {
    let mut letters = Vec::new();
    for run in runs(text) {
        letters.extend(match run {
            Run::Plain(text) => plain(text, style, size, fonts, missing),
            Run::Code(text) => plain(text, Style::Mono, 0.92 * size, fonts, missing),
            Run::Raised(text) => raised(text, style, size, fonts, missing),
        });
    }
    letters
}

/// The glyphs of an exponent.
fn raised(
    text: &str,
    style: Style,
    size: f32,
    fonts: &Fonts,
    missing: &mut Missing,
) -> Vec<Letter> {
    let mut letters = plain(&text.replace('-', "−"), style, 0.7 * size, fonts, missing);
    for letter in &mut letters {
        letter.rise = 0.35 * size;
    }
    letters
}

/// The glyphs of a text as it is.
pub(super) fn plain(
    text: &str,
    style: Style,
    size: f32,
    fonts: &Fonts,
    missing: &mut Missing,
) -> Vec<Letter> {
    let mut letters = Vec::new();
    for character in text.chars() {
        // Marks for lines, and spaces of other widths.
        let shown = match character {
            '\u{2060}' | '\u{200b}' | '\u{feff}' => continue,
            '\t' | '\n' | '\r' | '\u{a0}' | '\u{202f}' | '\u{2009}' => ' ',
            '\u{ad}' => '-',
            other => other,
        };
        let found = fonts.glyph(style, shown).or_else(|| {
            if !missing.0.contains(&character) {
                missing.0.push(character);
            }
            fonts.glyph(style, '?')
        });
        letters.extend(found.map(|found| Letter {
            character,
            face: found.face,
            glyph: found.glyph,
            advance: found.advance,
            size,
            rise: 0.0,
        }));
    }
    letters
}

/// Width of letters on one line; soft hyphens are not seen.
pub(super) fn width(letters: &[Letter]) -> f32 {
    letters
        .iter()
        .filter(|letter| letter.character != '\u{ad}')
        .map(Letter::width)
        .sum()
}

/// Width of the widest part that no line should break in.
pub(super) fn widest_part(letters: &[Letter]) -> f32 {
    let mut widest = 0.0f32;
    let mut start = 0;
    for end in 1..=letters.len() {
        if end == letters.len() || breaks(&letters[end - 1], &letters[end]) {
            let part = trimmed(&letters[start..end]);
            widest = widest.max(width(part));
            start = end;
        }
    }
    widest
}

/// The lines of letters in a width.
pub(super) fn lines(letters: &[Letter], room: f32) -> Vec<Vec<Letter>> {
    let mut lines = Vec::new();
    let mut rest = letters;
    while !rest.is_empty() {
        let end = line_end(rest, room);
        let mut line: Vec<Letter> = trimmed(&rest[..end]).to_vec();
        // Of the soft hyphens only one at the end of the line is seen.
        let last = line.len().saturating_sub(1);
        let mut at = 0;
        line.retain(|letter| {
            at += 1;
            letter.character != '\u{ad}' || (at - 1 == last && end < rest.len())
        });
        lines.push(line);
        rest = &rest[end..];
        let spaces = rest
            .iter()
            .take_while(|letter| letter.character == ' ')
            .count();
        rest = &rest[spaces..];
    }
    if lines.is_empty() {
        lines.push(Vec::new());
    }
    lines
}

/// Where the first line ends: at the last place to break that fits, else in the middle of a word.
fn line_end(letters: &[Letter], room: f32) -> usize {
    let (mut used, mut last) = (0.0, None);
    for (at, letter) in letters.iter().enumerate() {
        if letter.character == '\n' {
            return at + 1;
        }
        if at > 0 && breaks(&letters[at - 1], letter) {
            last = Some(at);
        }
        if letter.character != '\u{ad}' {
            used += letter.width();
        }
        // What rounding adds is no reason to break.
        if used > room + 0.01 && letter.character != ' ' {
            return last.unwrap_or(at.max(1));
        }
    }
    letters.len()
}

fn trimmed(letters: &[Letter]) -> &[Letter] {
    let end = letters
        .iter()
        .rposition(|letter| !matches!(letter.character, ' ' | '\n'))
        .map_or(0, |at| at + 1);
    &letters[..end]
}

/// Whether a line may end between two letters.
fn breaks(before: &Letter, after: &Letter) -> bool {
    const OPENING: &str = "（「『《〈【“‘([";
    const CLOSING: &str = "，。；：、！？）」』》〉】”’)],.;:!?%‰°";
    let (a, b) = (before.character, after.character);
    if matches!(a, ' ' | '\u{ad}' | '\u{200b}' | '\n') {
        return b != ' ';
    }
    let chinese = is_chinese(a) || is_chinese(b);
    chinese && b != ' ' && !OPENING.contains(a) && !CLOSING.contains(b)
}

/// Whether a character is Chinese, or Chinese punctuation.
pub(super) fn is_chinese(character: char) -> bool {
    matches!(character, '\u{2e80}'..='\u{9fff}' | '\u{f900}'..='\u{faff}' | '\u{ff00}'..='\u{ffef}' | '\u{20000}'..='\u{3ffff}')
}
