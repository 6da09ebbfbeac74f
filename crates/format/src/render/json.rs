//! The machine form as JSON.

use std::fmt::Write;

use gumption_fault::is_obeyed;

use super::format::{Format, Page, Unfit};
use crate::document::Document;

/// The format.
pub const FORMAT: Format = Format {
    name: "json",
    about: "Print JSON: exact numbers, stable names (`gumption schema` lists the schemas)",
    ending: "json",
    media_type: "application/json",
    render,
};

fn render(document: &Document, _: &Page) -> Result<Vec<u8>, Unfit> {
    Ok(escaped(document.machine.indented()).into_bytes())
}

/// JSON in which characters that a terminal would obey are escaped. They stand inside strings alone, where `\u`
/// says the same.
fn escaped(json: String) -> String {
    if !json.chars().any(is_obeyed) {
        return json;
    }
    let mut out = String::with_capacity(json.len());
    for c in json.chars() {
        if is_obeyed(c) {
            for unit in c.encode_utf16(&mut [0; 2]) {
                let _ = write!(out, "\\u{unit:04x}");
            }
        } else {
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_string_means_the_same_and_is_not_obeyed() {
        let text = "\x1b[0m \u{9b} \u{202e} \u{e0041} \n\t\"\\ µ 电";
        let json = escaped(serde_json::json!({ text: [text] }).to_string());
        assert!(!json.chars().any(is_obeyed), "{json:?}");
        let back: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(back[text][0], text);
    }
}
