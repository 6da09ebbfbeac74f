//! Where a file is no well-formed TOML: what its writer meant, in place of what the parser expected.

use std::ops::Range;

use gumption_fault::libraries::of_toml;
use gumption_fault::{Code, Fault, Said, say};

use toml::Spanned;
use toml::de::DeTable;

use super::faults::TOML_SYNTAX;
use super::spelled::spelled;

/// After so many syntax errors the rest of the file is hardly what was meant.
const MAX_SYNTAX_FAULTS: usize = 8;

/// Words that people try, and the key that they mean.
pub type Synonyms = [(&'static str, &'static str)];

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

/// How the parser says that a key needs quotes.
const UNQUOTED: &str = "invalid unquoted key";

/// Syntax errors, the first of each line: what follows on the same line mostly follows from it.
pub fn syntax_faults(errors: &[toml::de::Error], text: &str, synonyms: &Synonyms) -> Vec<Fault> {
    if !errors.is_empty() && text.trim_start().starts_with('{') {
        return vec![json(text)];
    }
    let mut faults: Vec<Fault> = Vec::new();
    let mut seen = Vec::new();
    for error in errors {
        if in_repeated_table(error, errors, text) {
            continue;
        }
        let fault = syntax_fault(error, text, synonyms);
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
    let line = |at: usize| text[..text.floor_char_boundary(at)].matches('\n').count();
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
        false => say!("a table has one header: put these keys below the first {single}"),
    }
}

fn syntax_fault(error: &toml::de::Error, text: &str, synonyms: &Synonyms) -> Fault {
    let end = text.len();
    let span = error.span().unwrap_or(end..end);
    if let Some(fault) = decimal_comma(&span, text).or_else(|| foreign_sign(&span, text)) {
        return fault;
    }
    let message = error.message();
    let says = |words: &str| message.contains(words);
    // Of `0.5/1.732` the parser takes the beginning for a number, and marks the rest.
    let span = match says("invalid float") {
        true => calculation_at(&span, text),
        false => span,
    };
    let marked = text.get(span.clone()).unwrap_or_default();
    let unquoted = says("string values must be quoted") || says("invalid float");
    let fault = |message: Said| Fault::new(TOML_SYNTAX, span.clone(), message);
    if says("duplicate key") {
        let line = text[line_of(span.start, text)].trim();
        let help = match line.starts_with('[') {
            true => of_second_header(line, &text[..span.start]),
            false => {
                say!("a key can be stated once in a table; several components stand in a list")
            }
        };
        fault(say!("`{marked}` is stated a second time"))
            .label(say!("stated before"))
            .help(help)
    } else if says("string values must be quoted") && marked.is_empty() {
        fault(say!("there is nothing behind the `=`"))
            .label(say!("expected a value"))
            .help(say!(
                "write a number, or a text in quotes; remove the line if there is nothing to say"
            ))
    } else if let (true, Some((number, unit))) = (unquoted, spelled(marked)) {
        fault(say!("`{marked}` is not how a number is written in TOML"))
            .label(say!("expected a number"))
            .help(match unit.as_str() {
                "" => say!("write {number}"),
                unit => quoted(&number, unit),
            })
    } else if let (true, Some(number)) = (unquoted, concise(marked)) {
        fault(say!("`{marked}` is a value with its uncertainty"))
            .label(say!("expected a number"))
            .help(of_concise(number))
    } else if let (true, Some(("", amount))) = (unquoted, parted_by_plus_minus(marked)) {
        fault(say!("`{marked}` is not how a number is written in TOML"))
            .label(say!("expected a number"))
            .help(without_sign(amount))
    } else if let (true, Some((number, rest))) = (unquoted, parted_by_plus_minus(marked)) {
        fault(say!("`{marked}` is a value with its uncertainty"))
            .label(say!("expected a number"))
            .help(of_plus_minus(number, rest))
    } else if matches!(marked, "…" | "..." | "……") {
        fault(say!("`{marked}` stands for what only you know"))
            .label(say!("expected a number or a text in quotes"))
            .help(say!("write what it is in its place, or leave the key out"))
    } else if unquoted && is_calculation(marked) {
        let help = match quotient(marked) {
            Some(result) => say!("write {result}; formulas stand in a `model`"),
            None => say!("write the number that it gives; formulas stand in a `model`"),
        };
        fault(say!("`{marked}` is a calculation, and a value is a number"))
            .label(say!("expected a number"))
            .help(help)
    } else if let (true, Some((value, remark))) = (unquoted, marked.split_once("//")) {
        let (value, remark) = (value.trim(), remark.trim());
        let value = match value.starts_with('.') {
            true => format!("0{value}"),
            false => value.to_owned(),
        };
        fault(say!("`//` begins no remark in TOML"))
            .label(say!("expected `#`"))
            .help(say!("write {value}  # {remark}"))
    } else if let (true, Some((first, second))) = (unquoted, two_numbers(marked)) {
        fault(say!("`{marked}` is two numbers"))
            .label(say!("expected a comma between them"))
            .help(say!("write {first}, {second} in a list"))
    } else if unquoted && let Some((number, unit)) = amount(marked) {
        fault(say!("`{marked}` needs quotes"))
            .label(say!("an amount with a unit is a text"))
            .help(quoted(number, unit))
    } else if says(UNQUOTED) && !marked.is_empty() {
        let span = word_at(&span, text);
        let marked = text.get(span.clone()).unwrap_or_default();
        unquoted_key(span, marked, text, synonyms)
    } else if says("string values must be quoted") {
        fault(say!("`{marked}` is no number, and a text needs quotes"))
            .label(say!("expected a number or a text in quotes"))
            .help(say!("write \"{}\" for the text", marked.replace('"', "'")))
    } else if says("string, expected") {
        fault(say!("the text is not closed"))
            .label(say!("expected the closing quote"))
            .help(say!("add the quote at the end of the text"))
    } else if says("unclosed array")
        || says("unclosed inline table")
        || says("missing comma between array elements") && begins_entry(&text[span.start..])
    {
        let bracket = if says("array") { "]" } else { "}" };
        fault(say!("the list is not closed by `{bracket}`"))
            .label(say!("expected `,` or `{bracket}`"))
    } else if says("key with no value") {
        let line = line_of(span.start, text);
        let written = text[line.clone()].trim();
        let (key, help) = match written.split_once(':') {
            Some((key, value)) if !key.contains(['"', '\'', '=', '#']) => {
                let (key, value) = (key.trim(), in_quotes(value.trim()));
                (key, say!("write an equals sign: {key} = {value}"))
            }
            _ => (
                written,
                say!("write `key = value`; a remark stands behind `#`"),
            ),
        };
        fault(say!("`{key}` has no `=` and no value"))
            .label(say!("expected `=`"))
            .help(help)
    } else if says("invalid mantissa") || says("expected digits") {
        fault(say!(
            "a number needs digits before and behind its decimal point"
        ))
        .label(say!("a digit is missing"))
        .help(match text[calculation_at(&span, text)].trim() {
            number if number.starts_with('.') => say!("write 0{number}"),
            number if number.ends_with('.') => say!("write {number}0"),
            _ => say!("write for example 0.5 or 5.0"),
        })
    } else if says("escape") || says("unicode") {
        fault(say!("a backslash in a text between double quotes begins an escape"))
            .label(say!("no escape"))
            .help(say!(
                "put the text between single quotes, '…', which take a backslash as it is; paths may have `/` as well"
            ))
    } else if says("unexpected key or value") && says("newline") {
        let help = match bare_list(&text[line_of(span.start, text)]) {
            Some(list) => say!("a list stands between square brackets: [{list}]"),
            None => say!(
                "write each key on a line of its own; several on one line stand between braces: {{ value = 1, u = 0.1 }}"
            ),
        };
        fault(say!("something stands behind the value"))
            .label(say!("expected the end of the line"))
            .help(help)
    } else if says("missing comma between array elements") {
        fault(say!("a comma is missing between two members of the list"))
            .label(say!("expected a comma in front of it"))
            .help(say!("write a comma behind the member that stands before"))
    } else {
        let message = of_toml(message);
        fault(say!("not well-formed TOML: {message}")).label(say!("not understood here"))
    }
}

/// Whether a text begins with a header of a table, or with a key and its equals sign: no member of a list.
fn begins_entry(text: &str) -> bool {
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

/// How an amount is written that stands without quotes.
fn quoted(number: &str, unit: &str) -> Said {
    let share: Option<f64> = number.parse().ok().filter(|_| unit == "%");
    match share {
        Some(share) => say!(
            "write \"{number} {unit}\" for a relative amount, and {} where a fraction is wanted",
            share / 100.0
        ),
        None => say!("write \"{number} {unit}\""),
    }
}

/// Whether a value without quotes is numbers with operators between them.
fn is_calculation(text: &str) -> bool {
    let text = text.trim();
    let sign = |c: char| c.is_ascii_digit() || "+-*/^(). eE".contains(c);
    let operator = text
        .trim_start_matches(['+', '-'])
        .contains(['*', '/', '^', '+', '-', '(']);
    text.chars().all(sign) && operator && text.ends_with(|c: char| c.is_ascii_digit() || c == ')')
}

/// The value of the concise notation 12.50(3) of a value with its standard uncertainty (GUM 7.2.2).
fn concise(text: &str) -> Option<&str> {
    let (number, digits) = text.trim().strip_suffix(')')?.split_once('(')?;
    let all_digits = !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit() || c == '.');
    (all_digits && number.parse::<f64>().is_ok()).then_some(number)
}

/// What is written in place of the concise notation.
pub(super) fn of_concise(number: &str) -> Said {
    say!(
        "the value and its uncertainty have keys of their own: value = \"{number} …\" and u = …; the digits in brackets are in units of the last digit"
    )
}

/// What stands in front of ± and behind it, also where keyboards have none: `1.00 +/- 0.05`.
pub(super) fn parted_by_plus_minus(text: &str) -> Option<(&str, &str)> {
    let parts = ["±", "+/-", "+-"]
        .iter()
        .find_map(|sign| text.split_once(sign))?;
    Some((parts.0.trim(), parts.1.trim()))
}

/// How to mend limits that are written with their sign.
pub(super) fn without_sign(amount: &str) -> Said {
    let quotes = match amount.parse::<f64>() {
        Ok(_) => "",
        Err(_) => "\"",
    };
    say!("leave out the ±, which the key says: {quotes}{amount}{quotes}")
}

/// What is written in place of a value with ± and its uncertainty, which may stand in a bracket in front of their unit.
pub(super) fn of_plus_minus(number: &str, rest: &str) -> Said {
    let (number, rest) = match number.strip_prefix(['(', '（']) {
        Some(number) => (number.trim(), rest.replacen([')', '）'], "", 1)),
        None => (number, rest.to_owned()),
    };
    let (value, uncertainty) = (as_stated(number, &rest), as_stated(&rest, number));
    say!(
        "the value and its uncertainty have keys of their own: value = {value}, and u = {uncertainty}, half_width = {uncertainty} or certificate = {{ U = {uncertainty}, k = 2 }}, whichever it is"
    )
}

/// An amount as a file states it: a bare number with the unit of the other one, if that has any.
fn as_stated(text: &str, other: &str) -> String {
    match (text.parse::<f64>(), amount(other)) {
        (Ok(_), Some((_, unit))) => format!("\"{text} {unit}\""),
        (Ok(_), None) => text.to_owned(),
        (Err(_), _) => format!("\"{text}\""),
    }
}

/// The whole calculation of which the parser marks a part.
fn calculation_at(span: &Range<usize>, text: &str) -> Range<usize> {
    let of_it = |c: char| c.is_ascii_digit() || "+-*/^().eE".contains(c);
    let before = text[..span.start].trim_end_matches(of_it).len();
    let behind = text[span.end..].trim_start_matches(of_it).len();
    before..text.len() - behind
}

/// What a quotient of two numbers is.
fn quotient(text: &str) -> Option<f64> {
    let (dividend, divisor) = text.split_once('/')?;
    let number = |text: &str| text.trim().parse::<f64>().ok();
    Some(number(dividend)? / number(divisor)?).filter(|result| result.is_finite())
}

/// The whole word of which the parser marks a letter.
fn word_at(span: &Range<usize>, text: &str) -> Range<usize> {
    let of_word = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let before = text[..span.start].trim_end_matches(of_word).len();
    let behind = text[span.end..].trim_start_matches(of_word).len();
    before..text.len() - behind
}

/// The line around a place.
fn line_of(at: usize, text: &str) -> Range<usize> {
    let at = text.floor_char_boundary(at);
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
    start..end
}

/// The characters of a line that stand in no text in quotes and in no remark, with their places.
fn bare(line: Range<usize>, text: &str) -> impl Iterator<Item = (usize, char)> {
    /// Where a character of the line stands.
    enum At {
        Bare,
        Quoted(char),
        Remark,
    }
    let mut place = At::Bare;
    let characters = text[line.clone()].char_indices();
    characters
        .filter(move |(_, c)| {
            let (here, bare) = match (&place, *c) {
                (At::Remark, _) | (At::Bare, '#') => (At::Remark, false),
                (At::Bare, '"' | '\'') => (At::Quoted(*c), false),
                (At::Bare, _) => (At::Bare, true),
                (At::Quoted(open), c) if *open == c => (At::Bare, false),
                (At::Quoted(open), _) => (At::Quoted(*open), false),
            };
            place = here;
            bare
        })
        .map(move |(at, c)| (line.start + at, c))
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

/// What to write for a number with a comma, between `quotes`: a decimal point, or nothing where the comma
/// may part thousands.
pub(super) fn without_comma(number: &str, quotes: &str) -> Said {
    let number = &number.replace('，', ",");
    let point = number.replacen(',', ".", 1);
    let behind = number.split_once(',').map_or("", |(_, behind)| behind);
    let places = behind.bytes().take_while(u8::is_ascii_digit).count();
    let joined = number.replace(',', "");
    // No thousand begins with a nought.
    let is_decimal = places != 3 || number.trim_start_matches(['-', '+']).starts_with('0');
    if is_decimal {
        say!("write a decimal point: {quotes}{point}{quotes}")
    } else if behind[places..].starts_with(['.', ',']) {
        say!("write it without commas: {quotes}{joined}{quotes}")
    } else {
        say!(
            "write {quotes}{joined}{quotes}, or {quotes}{point}{quotes} if the comma is a decimal one"
        )
    }
}

/// Two numbers with nothing but blanks between them.
fn two_numbers(text: &str) -> Option<(&str, &str)> {
    let (first, second) = text.split_once([' ', '\t'])?;
    let second = second.trim_start();
    let is_number = |text: &str| {
        text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
            && text.parse::<f64>().is_ok()
    };
    (is_number(first) && is_number(second)).then_some((first, second))
}

/// Number and unit of an amount that was written without quotes.
fn amount(text: &str) -> Option<(&str, &str)> {
    let end = text
        .char_indices()
        .take_while(|(_, c)| c.is_ascii_digit() || "+-._".contains(*c))
        .map(|(at, c)| at + c.len_utf8())
        .last()?;
    let (number, unit) = text.split_at(end);
    let unit = unit.trim();
    let plausible = number.parse::<f64>().is_ok() && !unit.is_empty() && !unit.contains(' ');
    plausible.then_some((number, unit))
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
