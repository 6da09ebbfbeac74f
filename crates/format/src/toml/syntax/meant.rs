//! What was meant where the parser stopped.

use std::ops::Range;

use gumption_core::calendar::Day;
use gumption_fault::libraries::of_toml;
use gumption_fault::{Fault, Said, say};

use super::places::{bare, calculation_at, line_of, word_at};
use crate::spelled::{day_first, prefix_for_point, range, spelled};
use crate::toml::faults::TOML_SYNTAX;
use crate::toml::numbers::{
    amount, concise, has_fractional_exponent, is_calculation, of_concise, of_fractional_exponent,
    of_plus_minus, of_prefix_for_point, of_range, parted_by_plus_minus, quoted, quotient,
    several_numbers, without_comma, without_sign,
};

/// Words that people try, and the key that they mean.
pub type Synonyms = [(&'static str, &'static str)];

/// The fault that an error of the parser is to a person.
pub(super) fn fault(error: &toml::de::Error, text: &str, synonyms: &Synonyms) -> Fault {
    let end = text.len();
    let span = error.span().unwrap_or(end..end);
    let of_signs = decimal_comma(&span, text).or_else(|| foreign_sign(&span, text));
    of_signs.unwrap_or_else(|| Stop::at(span, error.message(), text).fault(synonyms))
}

/// How the parser says that a key needs quotes.
pub(super) const UNQUOTED: &str = "invalid unquoted key";

/// Where the parser stopped, and why.
struct Stop<'a> {
    text: &'a str,
    span: Range<usize>,
    /// What stands there.
    marked: &'a str,
    message: &'a str,
}

impl<'a> Stop<'a> {
    fn at(span: Range<usize>, message: &'a str, text: &'a str) -> Self {
        // Of `0.5/1.732` the parser takes the beginning for a number, and marks the rest.
        let span = match message.contains("invalid float") {
            true => calculation_at(&span, text),
            false => span,
        };
        Stop {
            text,
            marked: text.get(span.clone()).unwrap_or_default(),
            span,
            message,
        }
    }

    fn says(&self, words: &str) -> bool {
        self.message.contains(words)
    }

    fn refused(&self, message: Said, label: Said) -> Fault {
        Fault::new(TOML_SYNTAX, self.span.clone(), message).label(label)
    }

    fn fault(&self, synonyms: &Synonyms) -> Fault {
        self.repeated()
            .or_else(|| self.nothing())
            .or_else(|| self.placeholder())
            .or_else(|| self.grouped())
            .or_else(|| self.number())
            .or_else(|| self.key(synonyms))
            .or_else(|| self.text())
            .or_else(|| self.header())
            .or_else(|| self.open_list())
            .or_else(|| self.no_comma())
            .or_else(|| self.no_equals_sign())
            .or_else(|| self.decimal_point())
            .or_else(|| self.leading_zero())
            .or_else(|| self.several())
            .unwrap_or_else(|| {
                let message = of_toml(self.message);
                let message = say!("not well-formed TOML: {message}");
                self.refused(message, say!("not understood here"))
            })
    }

    fn repeated(&self) -> Option<Fault> {
        if !self.says("duplicate key") {
            return None;
        }
        let line = self.text[line_of(self.span.start, self.text)].trim();
        let help = match line.starts_with('[') {
            true => of_second_header(line, &self.text[..self.span.start]),
            false if self.marked == "model" => say!(
                "a key can be stated once in a table; the lines of a model stand in one text between three quotes"
            ),
            false => {
                say!("a key can be stated once in a table; several components stand in a list")
            }
        };
        let message = say!("`{marked}` is stated a second time", marked = self.marked);
        Some(self.refused(message, say!("stated before")).help(help))
    }

    /// No value behind an equals sign.
    fn nothing(&self) -> Option<Fault> {
        (self.says(NO_QUOTES) && self.marked.is_empty()).then(|| {
            let message = say!("there is nothing behind the `=`");
            self.refused(message, say!("expected a value")).help(say!(
                "write a number, or a text in quotes; remove the line if there is nothing to say"
            ))
        })
    }

    /// The dots of an example, copied.
    fn placeholder(&self) -> Option<Fault> {
        matches!(self.marked, "…" | "..." | "……").then(|| {
            let message = say!(
                "`{marked}` stands for what only you know",
                marked = self.marked
            );
            self.refused(message, say!("expected a number or a text in quotes"))
                .help(say!("write what it is in its place, or leave the key out"))
        })
    }

    /// A number in groups of three, `1.234.567,8` and `1,234,567.8`, or a day with points, `01.03.2026`: the parser stops within it.
    fn grouped(&self) -> Option<Fault> {
        let line = &self.text[line_of(self.span.start, self.text)];
        let (_, value) = line.split_once('=')?;
        let value = value.split('#').next().unwrap_or(value).trim();
        if let Some(day) = day_first(value) {
            let message = say!(
                "`{marked}` is not how a date is written in TOML",
                marked = value
            );
            let fault = self.refused(message, say!("expected a date"));
            return Some(fault.help(say!("write {day}")));
        }
        let number = without_groups(value)?;
        let message = say!(
            "`{marked}` is not how a number is written in TOML",
            marked = value
        );
        let fault = self.refused(message, say!("expected a number"));
        Some(fault.help(say!("write {number}", number = number)))
    }

    /// A value without quotes that is a number to people.
    fn number(&self) -> Option<Fault> {
        if !self.says(NO_QUOTES) && !self.says("invalid float") || self.is_word() {
            return None;
        }
        let marked = self.marked;
        let number = |message: Said, help: Said| {
            let fault = self.refused(message, say!("expected a number"));
            Some(fault.help(help))
        };
        let spelling = || say!("`{marked}` is not how a number is written in TOML");
        if marked.trim_start_matches(['+', '-']) == "∞" {
            let infinite = marked.replace('∞', "inf");
            return number(spelling(), say!("write {number}", number = infinite));
        }
        let of_two = || say!("`{marked}` is a value with its uncertainty");
        if let Some((value, unit)) = spelled(marked) {
            let help = match unit.as_str() {
                "" => say!("write {number}", number = value),
                unit => quoted(&value, unit),
            };
            return number(spelling(), help);
        }
        if let Some(value) = concise(marked) {
            return number(of_two(), of_concise(value));
        }
        match parted_by_plus_minus(marked) {
            Some(("", amount)) => return number(spelling(), without_sign(amount)),
            Some((value, rest)) => return number(of_two(), of_plus_minus(value, rest)),
            None => {}
        }
        if let Some(day) = slashed_day(marked) {
            let message = say!("`{marked}` is not how a date is written in TOML");
            let fault = self.refused(message, say!("expected a date"));
            return Some(fault.help(say!("write {day}")));
        }
        if let Some(ends) = range(marked) {
            return number(spelling(), of_range(ends));
        }
        if has_fractional_exponent(marked) {
            return number(spelling(), of_fractional_exponent());
        }
        if let Some(parts) = prefix_for_point(marked) {
            return number(spelling(), of_prefix_for_point(parts));
        }
        if let Some(value) = with_letters(marked) {
            return number(spelling(), say!("write {number}", number = value));
        }
        if let Some(value) = of_groups(marked) {
            return number(spelling(), say!("write {number}", number = value));
        }
        if is_calculation(marked) {
            let help = match quotient(marked) {
                Some(result) => say!("write {result}; formulas stand in a `model`"),
                None => say!("write the number that it gives; formulas stand in a `model`"),
            };
            let message = say!("`{marked}` is a calculation, and a value is a number");
            return number(message, help);
        }
        self.before_something()
    }

    /// A number with something behind it: a remark, another number, a unit.
    fn before_something(&self) -> Option<Fault> {
        let marked = self.marked;
        if let Some((value, remark)) = marked.split_once("//") {
            let (value, remark) = (value.trim(), remark.trim());
            let value = match value.starts_with('.') {
                true => format!("0{value}"),
                false => value.to_owned(),
            };
            let message = say!("`//` begins no remark in TOML");
            let fault = self.refused(message, say!("expected `#`"));
            return Some(fault.help(say!("write {value}  # {remark}")));
        }
        if let Some(numbers) = several_numbers(marked) {
            let message = say!("`{marked}` is several numbers");
            let fault = self.refused(message, say!("expected a comma between them"));
            let list = numbers.join(", ");
            return Some(fault.help(say!("write {list} in a list", list = list)));
        }
        let (number, unit) = amount(marked)?;
        let message = say!("`{marked}` needs quotes");
        let fault = self.refused(message, say!("an amount with a unit is a text"));
        Some(fault.help(quoted(number, unit)))
    }

    fn key(&self, synonyms: &Synonyms) -> Option<Fault> {
        (self.says(UNQUOTED) && !self.marked.is_empty()).then(|| {
            let span = word_at(&self.span, self.text);
            let marked = self.text.get(span.clone()).unwrap_or_default();
            unquoted_key(span, marked, self.text, synonyms)
        })
    }

    /// A word that begins as `true`, `false`, `nan` or `inf` do, of which the parser takes it to be one.
    fn is_word(&self) -> bool {
        let taken = self.says("invalid boolean") || self.says("invalid float");
        taken && self.marked.starts_with(char::is_alphabetic)
    }

    /// A text without its quotes, or with a backslash between them.
    fn text(&self) -> Option<Fault> {
        let marked = self.marked;
        let lower = marked.to_ascii_lowercase();
        if self.is_word() && ["true", "false", "nan", "inf"].contains(&lower.as_str()) {
            let message = say!("`{marked}` is not how it is written in TOML");
            let fault = self.refused(message, say!("expected small letters"));
            return Some(fault.help(say!("write {word}", word = lower)));
        }
        let bare = lower.trim_start_matches(['+', '-']);
        if ["infinity", "infinite", "∞"].contains(&bare) {
            let message = say!("`{marked}` is not how it is written in TOML");
            let infinite = if lower.starts_with('-') {
                "-inf"
            } else {
                "inf"
            };
            let fault = self.refused(message, say!("expected a number"));
            return Some(fault.help(say!("write {number}", number = infinite)));
        }
        if self.says(NO_QUOTES) || self.is_word() {
            let message = say!("`{marked}` is no number, and a text needs quotes");
            let fault = self.refused(message, say!("expected a number or a text in quotes"));
            let marked = marked.replace('"', "'");
            return Some(fault.help(say!("write \"{}\" for the text", marked)));
        }
        if self.says("string, expected") {
            let message = say!("the text is not closed");
            let fault = self.refused(message, say!("expected the closing quote"));
            return Some(fault.help(say!(
                "add the quote at the end of the text; one of several lines stands between \"\"\" and \"\"\""
            )));
        }
        (self.says("escape") || self.says("unicode")).then(|| {
            let message = say!("a backslash in a text between double quotes begins an escape");
            self.refused(message, say!("no escape")).help(say!(
                "put the text between single quotes, '…', which take a backslash as it is; paths may have `/` as well"
            ))
        })
    }

    /// A header whose name has other signs than TOML takes without quotes.
    fn header(&self) -> Option<Fault> {
        let line = line_of(self.span.start, self.text);
        let name = self.text[line.clone()]
            .split('#')
            .next()
            .unwrap_or_default()
            .trim();
        let inside = name.strip_prefix('[')?;
        if self.says("unclosed table") && !inside.contains(']') {
            let start = line.start + self.text[line.clone()].find('[')?;
            let message = say!("the header is not closed by `]`");
            let fault = Fault::new(TOML_SYNTAX, start..start + name.len(), message);
            let closing = if inside.starts_with('[') { "]]" } else { "]" };
            let fault = fault.label(say!("expected `{closing}` at its end"));
            return Some(fault.help(say!("write {name}{closing}", name = name)));
        }
        let name = inside.strip_suffix(']')?;
        if !self.says("unclosed table") || name.contains(['"', '\'', '[', ']']) {
            return None;
        }
        let kept = name.chars().filter(|c| !"{}()".contains(*c));
        let letter = |c: char| if c.is_whitespace() { '_' } else { c };
        let plain: String = kept.map(letter).collect();
        let message = say!("`[{name}]` is no header of a table");
        let start = line.start + self.text[line.clone()].find('[')?;
        let fault = Fault::new(TOML_SYNTAX, start..start + name.len() + 2, message);
        let fault = fault.label(say!("a name has no blanks and no brackets"));
        Some(fault.help(say!(
            "write [{plain}], and call it so in the model",
            plain = plain
        )))
    }

    fn open_list(&self) -> Option<Fault> {
        let is_open = self.says("unclosed array")
            || self.says("unclosed inline table")
            || self.says(NO_COMMA) && begins_entry(&self.text[self.span.start..]);
        is_open.then(|| {
            let bracket = if self.says("array") { "]" } else { "}" };
            let message = say!("the list is not closed by `{bracket}`");
            self.refused(message, say!("expected `,` or `{bracket}`"))
        })
    }

    /// Two keys of a table in braces with nothing between them: the parser stops at the second `=`.
    fn no_comma(&self) -> Option<Fault> {
        if !self.says("extra assignment between key-value pairs") {
            return None;
        }
        let before = self.text.get(..self.span.start)?.trim_end();
        let part_of_key = |c: char| c.is_alphanumeric() || "_-.".contains(c);
        let key = &before[before.trim_end_matches(part_of_key).len()..];
        let message = say!("there is no comma in front of `{key}`");
        let place = before.len() - key.len()..before.len();
        Some(
            Fault::new(TOML_SYNTAX, place, message)
                .label(say!("expected `,` before this"))
                .help(say!(
                    "keys in braces stand with commas between them: {{ value = 1.5, u = 0.02 }}"
                )),
        )
    }

    fn no_equals_sign(&self) -> Option<Fault> {
        if !self.says("key with no value") {
            return None;
        }
        let written = self.text[line_of(self.span.start, self.text)].trim();
        let (key, help) = match written.split_once(':') {
            // Blocks by indentation, as YAML has them.
            Some((key, "")) if !key.contains(['"', '\'', '=', '#']) => (
                key.trim(),
                say!(
                    "tables have headers in brackets, as in [input.x], and their keys stand below, as in value = 1: indentation makes none"
                ),
            ),
            Some((key, value)) if !key.contains(['"', '\'', '=', '#']) => {
                let (key, value) = (key.trim(), in_quotes(value.trim()));
                (key, say!("write an equals sign: {key} = {value}"))
            }
            _ => (
                written,
                say!("write `key = value`; a remark stands behind `#`"),
            ),
        };
        let message = say!("`{key}` has no `=` and no value");
        Some(self.refused(message, say!("expected `=`")).help(help))
    }

    fn decimal_point(&self) -> Option<Fault> {
        (self.says("invalid mantissa") || self.says("expected digits")).then(|| {
            let help = match self.text[calculation_at(&self.span, self.text)].trim() {
                number if number.starts_with('.') => say!("write 0{number}"),
                number if number.ends_with('.') => say!("write {number}0"),
                _ => say!("write for example 0.5 or 5.0"),
            };
            let message = say!("a number needs digits before and behind its decimal point");
            self.refused(message, say!("a digit is missing")).help(help)
        })
    }

    /// The decimals of a number with a comma in a list, `[10,01, 10,02]`, or a zero too much.
    fn leading_zero(&self) -> Option<Fault> {
        if !self.says("leading zero") {
            return None;
        }
        let digits = |c: char| c.is_ascii_digit();
        let before = self.text[..self.span.start].strip_suffix([',', '，']);
        let whole = before.map_or("", |before| {
            &before[before.trim_end_matches(digits).len()..]
        });
        let behind = &self.text[self.span.start..];
        let decimals = &behind[..behind.len() - behind.trim_start_matches(digits).len()];
        let help = match whole {
            "" => say!("leave out the zero in front"),
            whole => say!("write a decimal point: {whole}.{decimals}"),
        };
        let message = say!("a number does not begin with a zero and another digit");
        Some(self.refused(message, say!("expected a number")).help(help))
    }

    /// Values side by side with nothing between them.
    fn several(&self) -> Option<Fault> {
        if self.says("unexpected key or value") && self.says("newline") {
            let line = line_of(self.span.start, self.text);
            let help = match (
                bare_list(&self.text[line.clone()]),
                self.text[self.span.start..line.end].trim(),
            ) {
                (Some(list), _) => say!("a list stands between square brackets: [{list}]"),
                (None, sign @ ("," | ";" | "，" | "；")) => {
                    say!("remove the `{sign}`: each key ends with its line")
                }
                (None, rest) if rest.starts_with("//") => {
                    let remark = rest.trim_start_matches('/').trim();
                    say!("a remark stands behind `#`: # {remark}")
                }
                (None, _) => say!(
                    "write each key on a line of its own; several on one line stand between braces: {{ value = 1, u = 0.1 }}"
                ),
            };
            let message = say!("something stands behind the value");
            let fault = self.refused(message, say!("expected the end of the line"));
            return Some(fault.help(help));
        }
        self.says(NO_COMMA).then(|| {
            let message = say!("a comma is missing between two members of the list");
            let fault = self.refused(message, say!("expected a comma in front of it"));
            fault.help(say!("write a comma behind the member that stands before"))
        })
    }
}

/// A number without the signs between its groups of three digits, where they are no decimal sign: of `1,234` nobody can tell.
fn without_groups(text: &str) -> Option<String> {
    let (sign, digits) = match text.strip_prefix(['+', '-']) {
        Some(digits) => (&text[..1], digits),
        None => ("", text),
    };
    let is_grouped = |whole: &str, sign: char| {
        let mut groups = whole.split(sign);
        let first = groups.next().unwrap_or_default();
        let all = |group: &str, lengths: std::ops::RangeInclusive<usize>| {
            lengths.contains(&group.len()) && group.bytes().all(|b| b.is_ascii_digit())
        };
        all(first, 1..=3) && groups.clone().count() > 0 && groups.all(|group| all(group, 3..=3))
    };
    [('.', ','), (',', '.')]
        .into_iter()
        .find_map(|(group, decimal)| {
            let (whole, decimals) = match digits.split_once(decimal) {
                Some((whole, decimals)) => (whole, Some(decimals)),
                None => (digits, None),
            };
            let is_one = is_grouped(whole, group)
                && decimals.is_none_or(|d| !d.is_empty() && d.bytes().all(|b| b.is_ascii_digit()))
                && (decimals.is_some() || whole.matches(group).count() > 1);
            let whole = whole.replace(group, "");
            is_one.then(|| match decimals {
                Some(decimals) => format!("{sign}{whole}.{decimals}"),
                None => format!("{sign}{whole}"),
            })
        })
}

/// Year, month and day with slashes between them, `2026/03/01`, as TOML writes a day.
fn slashed_day(text: &str) -> Option<String> {
    let day = text.trim().replace('/', "-");
    let is_one = text.contains('/') && Day::read(&day).is_some() && day.len() == 10;
    is_one.then_some(day)
}

/// How the parser says that a value is none that it knows, and that a member of a list follows another.
const NO_QUOTES: &str = "string values must be quoted";
const NO_COMMA: &str = "missing comma between array elements";

/// A key with other letters than TOML takes without quotes: a name, or a key of the program in other words.
fn unquoted_key(span: Range<usize>, marked: &str, text: &str, synonyms: &Synonyms) -> Fault {
    let in_header = text[line_of(span.start, text)]
        .trim_start()
        .starts_with('[');
    let meant = synonyms.iter().find(|(word, _)| *word == marked);
    let first = in_header && text[..span.start].ends_with('[');
    let help = match meant {
        Some((_, key)) if first => Some(say!("the table is [{key}]")),
        Some((_, key)) if !in_header => Some(say!("the key is `{key}`")),
        _ => None,
    };
    if let Some(help) = help {
        return Fault::new(TOML_SYNTAX, span, say!("`{marked}` is no key of the file"))
            .label(say!("another word for a key"))
            .help(help);
    }
    Fault::new(
        TOML_SYNTAX,
        span,
        say!("`{marked}` needs quotes where it is a key"),
    )
    .label(say!("only A-Z a-z 0-9 _ - may stand without quotes here"))
    .help(say!(
        "write \"{marked}\", also behind a dot: [input.\"{marked}\"]; formulas use the name without quotes"
    ))
}

/// What to write for a header that stands a second time: tables of one name are a list, or one of them is another.
fn of_second_header(line: &str, before: &str) -> Said {
    let name = line
        .trim_start_matches('[')
        .split(']')
        .next()
        .unwrap_or(line);
    let (single, listed) = (format!("[{name}]"), format!("[[{name}]]"));
    let stood = |header: &str| before.lines().any(|line| line.trim().starts_with(header));
    match line.starts_with(&listed) {
        true => say!(
            "of several tables each has the header {listed}: write so for the first {single}, too"
        ),
        false if stood(&listed) => {
            say!("of several tables each has the header {listed}: write so here, too")
        }
        false if name.contains('.') => say!(
            "a table has one header: put these keys below the first {single}, or give this one another name"
        ),
        false if ["correlation", "conformity"].contains(&name) => {
            say!(
                "of several tables each has the header {listed}: write so for the first {single}, too"
            )
        }
        false => say!("a table has one header: put these keys below the first {single}"),
    }
}

/// Whether a text begins with a header of a table, or with a key and its equals sign: no member of a list.
pub(super) fn begins_entry(text: &str) -> bool {
    let of_name = |c: char| c.is_alphanumeric() || "_-.".contains(c);
    let inside = text.trim_start_matches('[');
    let behind = inside.trim_start_matches(of_name).trim_start();
    let is_named = inside.starts_with(char::is_alphabetic);
    let is_header = inside.len() < text.len() && behind.starts_with(']');
    is_named && (is_header || inside.len() == text.len() && behind.starts_with('='))
}

/// The members of a list that stands behind its key without brackets: numbers, or texts in quotes.
fn bare_list(line: &str) -> Option<&str> {
    let (_, list) = line.split_once('=')?;
    let list = list.split('#').next().unwrap_or_default().trim();
    let is_member = |member: &str| {
        let member = member.trim();
        let is_text = member.len() >= 2 && member.starts_with('"') && member.ends_with('"');
        is_text || member.parse::<f64>().is_ok()
    };
    let is_list = list.contains(',') && list.split(',').all(is_member);
    is_list.then_some(list)
}

/// A value with the quotes that a text needs.
fn in_quotes(value: &str) -> String {
    let is_other = value.parse::<f64>().is_ok()
        || value.starts_with(['"', '\'', '[', '{'])
        || matches!(value, "true" | "false" | "");
    match is_other {
        true => value.to_owned(),
        false => format!("\"{}\"", value.replace('"', "'")),
    }
}

/// A sign of a Chinese keyboard or of a word processor where TOML has its own: `｛`, `“`, `，`.
fn foreign_sign(span: &Range<usize>, text: &str) -> Option<Fault> {
    let line = line_of(span.start, text);
    // At the end of a line a semicolon closes a statement of other languages, and is too much here.
    let in_list = |at: usize| text[line.start..at].contains(['{', '[']);
    let (at, sign, meant) = bare(line.clone(), text).find_map(|(at, sign)| {
        let (_, meant) = FOREIGN.iter().find(|(foreign, _)| *foreign == sign)?;
        (in_list(at) || !matches!(sign, ';' | '；')).then_some((at, sign, meant))
    })?;
    Some(
        Fault::new(
            TOML_SYNTAX,
            at..at + sign.len_utf8(),
            say!("`{sign}` is not the sign that the file needs"),
        )
        .label(say!("expected `{meant}`"))
        .help(say!(
            "write `{meant}`, and the like for other such signs on the line; only texts in straight quotes may hold them"
        )),
    )
}

/// Signs that look like those of TOML, and those.
const FOREIGN: [(char, &str); 18] = [
    ('“', "\""),
    ('”', "\""),
    ('„', "\""),
    ('＂', "\""),
    ('‘', "'"),
    ('’', "'"),
    ('｛', "{"),
    ('｝', "}"),
    ('［', "["),
    ('］', "]"),
    ('【', "["),
    ('】', "]"),
    ('＝', "="),
    ('，', ","),
    (';', ","),
    ('；', ","),
    ('。', "."),
    ('　', " "),
];

/// `value = 0,3888`, where the parser stops at the comma or behind it.
fn decimal_comma(span: &Range<usize>, text: &str) -> Option<Fault> {
    let line = line_of(span.start, text);
    let digits = |c: char| c.is_ascii_digit();
    let of_number = |c: char| c.is_ascii_digit() || ".eE+-".contains(c);
    let commas = bare(line.clone(), text).filter(|(_, c)| matches!(c, ',' | '，'));
    let number = commas
        .map(|(at, comma)| {
            let before = text[line.start..at].trim_end_matches(digits).len() + line.start;
            let from = at + comma.len_utf8();
            let behind = text[from..line.end].trim_start_matches(of_number).len();
            (before, at, from, line.end - behind)
        })
        .find(|(start, at, from, end)| {
            let alone = text[line.start..*start]
                .trim_end_matches(['+', '-', ' ', '\t'])
                .ends_with('=');
            let followed = text[*from..*end].starts_with(digits);
            let spaces = text[*end..line.end].len() - text[*end..line.end].trim_start().len();
            alone && start < at && followed && (*start..=end + spaces).contains(&span.start)
        });
    let (start, _, _, end) = number?;
    let number = &text[start..end];
    Some(
        Fault::new(TOML_SYNTAX, start..end, say!("`{number}` has a comma"))
            .label(say!("expected a decimal point"))
            .help(without_comma(number, "")),
    )
}

/// A number with the letters O, o, l or I in the place of the digits that look like them: 10.3 of `1O.3`.
fn with_letters(marked: &str) -> Option<String> {
    let digits: String = marked
        .chars()
        .map(|c| match c {
            'O' | 'o' => '0',
            'l' | 'I' => '1',
            c => c,
        })
        .collect();
    let is_number = |text: &str| {
        let begins = text.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c));
        begins && text.contains('.') && text.parse::<f64>().is_ok()
    };
    // Without a point it may be a unit: `5 l`, `10I`.
    let has_digit = marked.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c));
    (has_digit && digits != marked && is_number(&digits)).then_some(digits)
}

/// A number with a point between groups of three digits and another one: 1000.5 of `1.000.5`.
fn of_groups(marked: &str) -> Option<String> {
    let mut parts: Vec<&str> = marked.split('.').collect();
    let decimals = parts.pop()?;
    let (first, groups) = parts.split_first()?;
    let are_digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let front = first.trim_start_matches(['+', '-']);
    let is_grouped = !groups.is_empty() && groups.iter().all(|group| group.len() == 3);
    let is_number = [front, decimals]
        .into_iter()
        .chain(groups.iter().copied())
        .all(are_digits);
    (is_grouped && is_number && front.len() <= 3)
        .then(|| format!("{first}{}.{decimals}", groups.concat()))
}
