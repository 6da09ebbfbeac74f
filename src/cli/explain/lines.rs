//! Lines of a width that can be read.

use gumption_core::letters::is_chinese;

/// A paragraph on lines of at most 90 characters; lines of an example, which are indented, stay as
/// they are.
pub(super) fn wrapped(paragraph: &str) -> String {
    if paragraph.lines().any(|l| l.starts_with("  ")) {
        return paragraph.to_string();
    }
    if paragraph.contains(is_chinese) {
        return broken(paragraph);
    }
    filled(paragraph.split_whitespace(), " ")
}

/// Chinese has no spaces to break at, and each of its signs takes two columns.
fn broken(paragraph: &str) -> String {
    let wide = |c: char| c >= '\u{2e80}';
    let width = |c: char| if wide(c) { 2 } else { 1 };
    let closes = |c: char| "，。；：、！？）”》…".contains(c);
    let (mut text, mut column) = (String::new(), 0);
    let mut chars = paragraph.chars().peekable();
    let mut word = String::new();
    while let Some(c) = chars.next() {
        word.push(c);
        let next = chars.peek();
        let inside = next.is_some_and(|next| {
            closes(*next) || c != ' ' && !wide(c) && !wide(*next) && *next != ' '
        });
        if inside || "（“《".contains(c) {
            continue;
        }
        let length: usize = word.chars().map(width).sum();
        if column > 0 && column + length > 90 {
            text.truncate(text.trim_end().len());
            text.push('\n');
            column = 0;
        }
        text += &word;
        column += length;
        word.clear();
    }
    text + &word
}

/// Words on such lines.
pub(super) fn filled<'a>(words: impl Iterator<Item = &'a str>, separator: &str) -> String {
    let mut lines: Vec<String> = vec![String::new()];
    for word in words {
        let line = lines.last_mut().expect("there is always a line");
        let width = line.chars().count() + separator.len() + word.chars().count();
        if !line.is_empty() && width > 90 {
            lines.push(word.to_string());
        } else {
            if !line.is_empty() {
                line.push_str(separator);
            }
            line.push_str(word);
        }
    }
    lines.join("\n")
}
