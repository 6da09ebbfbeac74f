//! Texts and names as TOML has them, for files that the program writes.

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
