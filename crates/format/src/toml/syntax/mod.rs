//! Where a file is no well-formed TOML: what its writer meant, in place of what the parser expected.

mod brackets;
mod meant;
mod places;

use std::ops::Range;

use gumption_fault::{Code, Fault, say};

use toml::Spanned;
use toml::de::DeTable;

use super::faults::TOML_SYNTAX;
pub use meant::Synonyms;
use meant::UNQUOTED;
use places::{line_of, word_at};

/// After so many syntax errors the rest of the file is hardly what was meant.
const MAX_SYNTAX_FAULTS: usize = 8;

/// What the parser reads of a text, with its errors.
///
/// TOML itself wants quotes around keys with other letters than A to Z. Names of quantities have them, ρ or 电压, and nothing
/// else can be meant: they are read without.
pub fn document<'t>(
    text: &'t str,
    synonyms: &Synonyms,
) -> (Spanned<DeTable<'t>>, Vec<toml::de::Error>) {
    let (table, mut errors) = DeTable::parse_recoverable(text);
    errors.retain(|error| !is_name(error, text, synonyms));
    (table, errors)
}

/// Whether an error is about a key that is a name of letters without quotes, and no word for a key of the program.
fn is_name(error: &toml::de::Error, text: &str, synonyms: &Synonyms) -> bool {
    let Some(span) = error.span().filter(|_| error.message().contains(UNQUOTED)) else {
        return false;
    };
    let letter = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let at = word_at(&span, text);
    // Behind a dot stands a name, whatever it is: `[measurand.值]`.
    let of_quantity = text[..at.start].ends_with('.');
    let word = text.get(at).unwrap_or_default();
    let is_key = synonyms.iter().any(|(synonym, _)| *synonym == word);
    word.chars().all(letter) && (of_quantity || !is_key)
}

/// Syntax errors, the first of each line: what follows on the same line mostly follows from it.
pub fn syntax_faults(errors: &[toml::de::Error], text: &str, synonyms: &Synonyms) -> Vec<Fault> {
    if errors.is_empty() {
        return Vec::new();
    }
    if text.trim_start().starts_with('{') {
        return vec![json(text)];
    }
    let mut faults: Vec<Fault> = Vec::new();
    let mut seen = Vec::new();
    let is_deep = errors
        .iter()
        .any(|error| error.message().contains("recursion"));
    let mut unclosed = brackets::unclosed(text).filter(|_| !is_deep);
    for error in errors {
        let place = error.span().map_or(text.len(), |span| span.start);
        if let Some((fault, _)) = unclosed.take_if(|(_, inside)| inside.start <= place) {
            faults.push(fault);
            break;
        }
        if in_repeated_table(error, errors, text) {
            continue;
        }
        let fault = meant::fault(error, text, synonyms);
        let line = text[..text.floor_char_boundary(fault.span.start)]
            .matches('\n')
            .count();
        if !seen.contains(&line) {
            seen.push(line);
            faults.push(fault);
        }
        if faults.len() == MAX_SYNTAX_FAULTS {
            break;
        }
    }
    faults
}

/// A file that is written in another language.
fn json(text: &str) -> Fault {
    let at = text.len() - text.trim_start().len();
    Fault::new(
        TOML_SYNTAX,
        at..at + 1,
        say!("the file is JSON, and TOML is read"),
    )
    .label(say!("no line of TOML begins like this"))
    .help(say!(
        "write title = \"…\", then a header for each table, [measurand.Y], and its keys below it: model = \"…\""
    ))
}

/// Whether a key is repeated only because the header above it is.
fn in_repeated_table(error: &toml::de::Error, errors: &[toml::de::Error], text: &str) -> bool {
    let repeated = |error: &toml::de::Error| error.message().contains("duplicate key");
    let line = |error: &toml::de::Error| line_of(error.span().map_or(0, |span| span.start), text);
    let header = |line: &Range<usize>| text[line.clone()].trim_start().starts_with('[');
    let own = line(error);
    repeated(error)
        && !header(&own)
        && errors.iter().filter(|other| repeated(other)).any(|other| {
            let above = line(other);
            above.end < own.start
                && header(&above)
                && !text[above.end..own.start]
                    .lines()
                    .any(|line| line.trim_start().starts_with('['))
        })
}

/// Whether what stands on the other lines can be judged all the same.
pub fn leaves_the_rest(error: &toml::de::Error) -> bool {
    let message = error.message();
    [
        "string values must be quoted",
        UNQUOTED,
        "invalid boolean",
        "invalid float",
        "string, expected",
        "duplicate key",
    ]
    .iter()
    .any(|words| message.contains(words))
}

/// The faults that no line with a syntax error has part in. What a broken line would have used seems
/// `unused`; such faults are left out.
pub fn elsewhere(faults: Vec<Fault>, syntax: &[Fault], text: &str, unused: Code) -> Vec<Fault> {
    let ends: Vec<usize> = text.match_indices('\n').map(|(end, _)| end).collect();
    let line = |at: usize| ends.partition_point(|end| *end < at);
    let broken: Vec<usize> = syntax.iter().map(|fault| line(fault.span.start)).collect();
    let touches = |fault: &Fault| {
        let lines = line(fault.span.start)..=line(fault.span.end);
        broken.iter().any(|broken| lines.contains(broken))
    };
    faults
        .into_iter()
        .filter(|fault| fault.code != unused && !touches(fault))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marked text and help of the first fault.
    fn first(text: &str) -> (String, String) {
        let (_, errors) = document(text, &[]);
        let fault = syntax_faults(&errors, text, &[])
            .into_iter()
            .next()
            .expect(text);
        let marked = text[fault.span.clone()].to_owned();
        (marked, fault.help.unwrap_or_default().to_string())
    }

    #[test]
    fn what_was_meant_is_said() {
        for (text, marked, help) in [
            ("value = 0,3888", "0,3888", ": 0.3888"),
            ("x = { value = 1,25, u = 2 }", "1,25", ": 1.25"),
            ("value = -1,5e-3", "1,5e-3", ": 1.5e-3"),
            ("value =\t1,5", "1,5", ": 1.5"),
            ("value = 100，2", "100，2", ": 100.2"),
            ("readings = 10.1, 10.2, 10.3", "", ": [10.1, 10.2, 10.3]"),
            ("title: Current", "", "title = \"Current\""),
            ("x = [{ a = 1 }\n{ a = 2 }]", "", "write a comma"),
            ("x = { unit = \"#\", value = 1,25 }", "1,25", ": 1.25"),
            ("value = 10,000", "10,000", "write 10000, or 10.000"),
            ("value = 10,000.5", "10,000.5", ": 10000.5"),
            ("unit = “mm”", "“", "write `\"`"),
            ("title = “10 kg 砝码”", "“", "write `\"`"),
            ("c = ｛ U = 1, k = 2 }", "｛", "write `{`"),
            ("limits = [1，2]", "，", "write `,`"),
            ("x = { value = 10; u = 0.1 }", ";", "write `,`"),
            ("model = \"a\" unit = \"mm\"", "", "a line of its own"),
            ("value ＝ 3", "＝", "write `=`"),
            ("value = .5", "", "0.5"),
            ("readings = [1.0, 1.1 1.2]", "1.1 1.2", "1.1, 1.2"),
            ("value = 1 200.5", "1 200.5", "write 1200.5"),
            ("readings = [2.0 2.1 2.2]", "2.0 2.1 2.2", "2.0, 2.1, 2.2"),
            ("readings = [10,01, 10,02]", "0", "10.01"),
            ("distribution = triangular", "triangular", "\"triangular\""),
            ("title = Torque", "Torque", "\"Torque\""),
            ("relative = True", "True", "write true"),
            ("u = 1e-2V", "1e-2V", "\"1e-2 V\""),
            ("u = 0.06/√4", "0.06/√4", "write 0.03;"),
            (
                "[input.标准 电压]",
                "[input.标准 电压]",
                "[input.标准_电压]",
            ),
            ("dof = infinity", "infinity", "write inf"),
            ("date = 2026/03/01", "2026/03/01", "write 2026-03-01"),
            ("u = 1e2.5", "1e2.5", "whole number"),
            ("u = 3D-4", "3D-4", "write 3e-4"),
            ("value = 4.9~5.1", "4.9~5.1", "limits = [4.9, 5.1]"),
            ("value = 1k5", "1k5", "\"1.5 kohm\""),
            ("value = ±5 V", "±5 V", "half_width = \"5 V\""),
            ("[input.R\nvalue = 1", "[input.R", "write [input.R]"),
            ("c = { U = 1, k = 2\n[input.R]\nx = 1", "{", "write `}`"),
            ("[input.V_{s}]", "[input.V_{s}]", "[input.V_s]"),
        ] {
            let (found, mend) = first(text);
            assert_eq!(found, marked, "{text}");
            assert!(mend.contains(help), "{text}: {mend}");
        }
    }

    #[test]
    fn names_of_letters_need_no_quotes() {
        let synonyms = [("单位", "unit")];
        let errors = |text| document(text, &synonyms).1.len();
        for text in [
            "[input.Δp]\nvalue = 1",
            "[input]\nρ_w = { value = 1 }\n电压 = 3",
            "[measurand.R₀]",
            "α-1 = 2",
            "a = { φ = 1, Δ2Δ = 3 }",
            "a.δ.b = 1",
            "[measurand.单位]",
        ] {
            assert_eq!(errors(text), 0, "{text}");
            let (table, _) = document(text, &synonyms);
            let quoted = format!("{table:?}");
            assert!(!quoted.contains("\"\""), "{quoted}");
        }
        for text in ["单位 = \"V\"", "a（1） = 2", "°x = 1", "ρ w = 1"] {
            assert_ne!(errors(text), 0, "{text}");
        }
    }

    #[test]
    fn a_list_that_is_not_closed_is_not_a_comma() {
        for text in ["readings = [1,2", "readings = [1.5,2", "readings = [1,2}"] {
            let (_, help) = first(text);
            assert!(!help.contains("decimal"), "{text}: {help}");
        }
    }

    #[test]
    fn a_repeated_table_is_one_fault() {
        let text =
            "[input.R]\nvalue = 1\nu = 2\n[input.S]\nvalue = 1\n[input.R]\nvalue = 1\nu = 3\n";
        let (_, errors) = document(text, &[]);
        let faults = syntax_faults(&errors, text, &[]);
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert!(faults[0].message.to_string().contains("`R`"));
    }

    #[test]
    fn texts_and_remarks_hold_any_sign() {
        let (marked, _) = first("note = \"，“” 1,5\" # ｛ 2,5\nvalue = x y");
        assert_eq!(marked, "x y");
    }
}
