//! Texts, names and numbers as TOML has them, for files that the program writes.

use std::fmt::Write;

/// A text in double quotes.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            '\n' => out += "\\n",
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out + "\""
}

/// A name as a key: quoted where it has other letters than a bare key.
pub fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if bare { name.to_owned() } else { quoted(name) }
}

/// A key with its text, as a line; nothing of an empty one.
pub fn line(key: &str, text: &str) -> String {
    match text {
        "" => String::new(),
        text => format!("{key} = {}\n", quoted(text)),
    }
}

/// A number with all its digits, as a power of ten where it has many zeros.
pub fn number(x: f64) -> String {
    match x == 0.0 || (1e-4..1e9).contains(&x.abs()) {
        true => format!("{x}"),
        false => format!("{x:e}"),
    }
}

/// The table of a correlation of two quantities.
pub fn correlation(between: [&str; 2], r: f64) -> String {
    let between = between.map(quoted).join(", ");
    format!("\n[[correlation]]\nbetween = [{between}]\nr = {r}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_read_as_they_were_written() {
        for text in ["plain", "a \"b\" \\ c", "two\nlines\t\u{1}", "20 °C"] {
            let file = format!("{} = {}", key(text), quoted(text));
            let table: toml::Table = toml::from_str(&file).unwrap();
            assert_eq!(table[text].as_str(), Some(text));
        }
    }
}
