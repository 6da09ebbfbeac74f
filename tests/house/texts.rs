//! Every text that a user reads has its Chinese: the templates of `say!` in the sources, and the catalogues of
//! `crates/fault/zh`.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::PathBuf;

use gumption_fault::catalogue::entries;
use gumption_fault::said::{Piece, numbered, pieces};

use super::common::{assert_fresh, root, stale};
use super::lexer::Token;
use super::matrix::CRATES;
use super::walks::token_lists;

/// The templates of each crate, in the order of its sources; one that several crates use is the lowest one's.
fn templates() -> BTreeMap<&'static str, Vec<String>> {
    let mut seen = BTreeSet::new();
    let mut found: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    let lists = token_lists();
    for krate in CRATES {
        let folder = match krate {
            "gumption" => "src/".to_owned(),
            member => format!("crates/{member}/src/"),
        };
        let own = lists.iter().filter(|(file, _)| file.starts_with(&folder));
        for template in own.flat_map(|(_, tokens)| said(tokens)) {
            if has_words(&template) && seen.insert(template.clone()) {
                found.entry(krate).or_default().push(template);
            }
        }
    }
    found
}

fn said(tokens: &[Token]) -> Vec<String> {
    let calls = tokens
        .windows(4)
        .filter(|w| w[0].is("say") && w[1].is("!") && ["(", "["].iter().any(|open| w[2].is(open)));
    calls.filter_map(|w| unquoted(&w[3].0)).collect()
}

/// Whether a template says something beside its values.
fn has_words(template: &str) -> bool {
    let word = |piece: &Piece<'_>| matches!(piece, Piece::Text(text) if text.contains(char::is_alphabetic));
    pieces(template).iter().any(word)
}

/// The value of a literal.
fn unquoted(literal: &str) -> Option<String> {
    let inside = literal.strip_prefix('"')?.strip_suffix('"')?;
    let mut text = String::new();
    let mut rest = inside;
    while let Some((before, after)) = rest.split_once('\\') {
        text += before;
        rest = match after.as_bytes().first() {
            Some(b'\n') => after.trim_start(),
            Some(b'u') => {
                let (code, rest) = after[2..].split_once('}')?;
                text.push(char::from_u32(u32::from_str_radix(code, 16).ok()?)?);
                rest
            }
            Some(b'n') => {
                text.push('\n');
                &after[1..]
            }
            _ => {
                text += after.get(..1)?;
                &after[1..]
            }
        };
    }
    Some(text + rest)
}

fn path(krate: &str) -> PathBuf {
    root().join(format!("crates/fault/zh/{krate}.po"))
}

fn catalogue(krate: &str) -> Vec<(String, String)> {
    entries(&std::fs::read_to_string(path(krate)).unwrap_or_default())
}

fn quoted(text: &str) -> String {
    let text = text.replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{}\"", text.replace('\n', "\\n"))
}

/// A new template has an entry without Chinese, and an entry that nothing uses goes; both with `GUMPTION_UPDATE=1`.
#[test]
fn the_catalogues_have_the_templates_of_the_sources() {
    let known: BTreeMap<String, String> = CRATES.into_iter().flat_map(catalogue).collect();
    let mut old = Vec::new();
    for (krate, templates) in templates() {
        let mut fresh = format!(
            "# Chinese of the texts of `{krate}`: msgid as in the source, msgstr with the same values in braces.\nmsgid \"\"\nmsgstr \"Content-Type: text/plain; charset=UTF-8\\n\"\n"
        );
        for template in templates {
            let chinese = known.get(&template).map_or("", String::as_str);
            let (id, chinese) = (quoted(&template), quoted(chinese));
            let _ = write!(fresh, "\nmsgid {id}\nmsgstr {chinese}\n");
        }
        old.extend(stale(&path(krate), &fresh));
    }
    assert_fresh(&old);
}

#[test]
fn every_template_has_its_chinese() {
    let all = CRATES.into_iter().flat_map(catalogue);
    let missing: Vec<String> = all
        .filter(|(_, chinese)| chinese.is_empty())
        .map(|(id, _)| id)
        .collect();
    assert!(
        missing.is_empty(),
        "write their msgstr in crates/fault/zh:\n{}",
        missing.join("\n")
    );
}

#[test]
fn chinese_has_no_other_values() {
    for (english, chinese) in CRATES.into_iter().flat_map(catalogue) {
        let own = places(&english);
        let strange: Vec<String> = places(&chinese).difference(&own).cloned().collect();
        assert!(strange.is_empty(), "{english}\n{chinese}\n{strange:?}");
    }
}

fn places(template: &str) -> BTreeSet<String> {
    let mut next = 0;
    let inside = pieces(template)
        .into_iter()
        .filter_map(|piece| match piece {
            Piece::Place(inside) => Some(numbered(inside, &mut next).into_owned()),
            Piece::Text(_) => None,
        });
    inside.collect()
}

#[test]
fn literals_are_read() {
    assert_eq!(
        unquoted(r#""a \"b\" \\ \u{b7}\n""#).as_deref(),
        Some("a \"b\" \\ ·\n")
    );
    assert_eq!(unquoted("\"a \\\n   b\"").as_deref(), Some("a b"));
}
