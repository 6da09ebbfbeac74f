//! The Chinese of every template: the catalogues of `zh/`, in the format of GNU gettext.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::language::Language;

/// The catalogues: one for each crate that speaks, and one of the explanations, which have no values.
const CATALOGUES: [&str; 13] = [
    include_str!("../zh/fault.po"),
    include_str!("../zh/core.po"),
    include_str!("../zh/format.po"),
    include_str!("../zh/export.po"),
    include_str!("../zh/fleet.po"),
    include_str!("../zh/gum.po"),
    include_str!("../zh/lab.po"),
    include_str!("../zh/audit.po"),
    include_str!("../zh/report.po"),
    include_str!("../zh/challenge.po"),
    include_str!("../zh/serve.po"),
    include_str!("../zh/gumption.po"),
    include_str!("../zh/explain.po"),
];

static CHINESE: LazyLock<HashMap<String, String>> = LazyLock::new(|| {
    let entries = CATALOGUES.iter().flat_map(|text| entries(text));
    entries.filter(|(_, chinese)| !chinese.is_empty()).collect()
});

/// The Chinese of a template, if it has one.
pub fn chinese(template: &str) -> Option<&'static str> {
    CHINESE.get(template).map(String::as_str)
}

/// A text without values in a language; in English where it has no Chinese.
pub fn told(text: &str, language: Language) -> &str {
    match language {
        Language::English => text,
        Language::Chinese => chinese(text).unwrap_or(text),
    }
}

/// The pairs of a catalogue: `msgid`, `msgstr`, each with any lines of text that follow. Comments begin with `#`.
pub fn entries(catalogue: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    let mut chinese = false;
    for line in catalogue.lines() {
        let quoted = if let Some(id) = line.strip_prefix("msgid ") {
            found.push(Default::default());
            chinese = false;
            id
        } else if let Some(text) = line.strip_prefix("msgstr ") {
            chinese = true;
            text
        } else {
            line
        };
        if let (Some(text), Some((english, translated))) = (unquoted(quoted), found.last_mut()) {
            *(if chinese { translated } else { english }) += &text;
        }
    }
    found.retain(|(english, _)| !english.is_empty());
    found
}

/// The text between quotation marks.
fn unquoted(line: &str) -> Option<String> {
    let inside = line.trim().strip_prefix('"')?.strip_suffix('"')?;
    let mut text = String::new();
    let mut chars = inside.chars();
    while let Some(c) = chars.next() {
        text.push(match c {
            '\\' => match chars.next() {
                Some('n') => '\n',
                Some(other) => other,
                None => '\\',
            },
            c => c,
        });
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::entries;

    #[test]
    fn lines_of_an_entry_are_joined() {
        let found = entries(
            "# note\nmsgid \"\"\nmsgstr \"Content-Type: text/plain\\n\"\n\nmsgid \"a \"\n\"\\\"b\\\"\\n\"\nmsgstr \"甲\"\n\nmsgid \"c\"\nmsgstr \"\"\n",
        );
        let pair = |english: &str, chinese: &str| (english.to_owned(), chinese.to_owned());
        assert_eq!(found, [pair("a \"b\"\n", "甲"), pair("c", "")]);
    }
}
