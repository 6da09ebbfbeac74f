//! What keys may be set to: lists, matrices, tables by name.

use serde_json::{Value, json};
use toml::de::DeValue;

use super::faults::{AMOUNT, QUOTED_NUMBER};
use super::matrix::{Matrix, Row};
use super::table::{
    FromToml, Hints, KeyRow, Raw, Reader, Stated, above_the_first_table, in_order, inner,
};
use gumption_fault::{Fault, Said, say};
use smol_str::SmolStr;

impl<T: FromToml> FromToml for Vec<Stated<T>> {
    fn expected() -> Said {
        match T::plural() {
            Some(plural) => say!("a list of {plural}"),
            None => say!("a list, each {}", T::expected()),
        }
    }

    fn plural() -> Option<Said> {
        T::plural().map(|plural| say!("lists of {plural}"))
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        let DeValue::Array(list) = value.get_ref() else {
            let help = match value.get_ref() {
                DeValue::Table(_) if !takes_tables::<T>() => Some(say!(
                    "a list has no keys: write its members between square brackets, [ … ]"
                )),
                _ => as_a_list(value, reader.file),
            };
            return reader.wrong_type_with(value, Self::expected(), help);
        };
        if let Some(fault) = decimal_commas(value, list, reader.file) {
            return reader.refuse(fault);
        }
        let before = reader.faults.len();
        let read: Vec<Option<Stated<T>>> =
            list.iter().map(|item| read_item(item, reader)).collect();
        tell_quotes_once(&mut reader.faults, before);
        read.into_iter().collect()
    }

    fn schema() -> Value {
        json!({ "type": "array", "items": T::schema() })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        T::tables(&format!("{path}[]"), rows);
    }
}

/// Whether a table may stand in a place.
fn takes_tables<T: FromToml>() -> bool {
    let mut rows = Vec::new();
    T::tables("", &mut rows);
    !rows.is_empty()
}

/// Of the numbers in quotes of one list, whose faults begin here, the first stands for all.
fn tell_quotes_once(faults: &mut Vec<Fault>, before: usize) {
    let of_list = faults.split_off(before);
    let (quoted, others): (Vec<Fault>, Vec<Fault>) = of_list
        .into_iter()
        .partition(|fault| fault.code == QUOTED_NUMBER);
    let more = quoted.len().saturating_sub(1);
    faults.extend(quoted.into_iter().take(1).map(|mut first| {
        if more > 0 {
            first.message = say!("{}; so do {more} more of the list", first.message);
        }
        first
    }));
    faults.extend(others);
}

type Lists = Vec<Stated<Vec<Stated<f64>>>>;

impl FromToml for Matrix {
    fn expected() -> Said {
        Lists::expected()
    }

    fn plural() -> Option<Said> {
        Lists::plural()
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        if let Some(matrix) = reader.matrices.at(value.span().start) {
            return Some(matrix);
        }
        let lists = Lists::read(value, reader)?;
        let rows = lists.into_iter().map(|list| {
            let mut row = Row::empty(list.span.start, list.value.len());
            for number in list.value {
                row.push(number.value, number.span);
            }
            row.span = list.span;
            row
        });
        Some(Matrix::new(rows.collect()))
    }

    fn schema() -> Value {
        Lists::schema()
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        Lists::tables(path, rows);
    }
}

impl Row {
    /// The number in this column with its place.
    ///
    /// # Panics
    /// The row has no such column.
    pub fn stated(&self, column: usize) -> Stated<f64> {
        let place = self.place(column);
        Stated {
            value: self.values()[column],
            span: place.clone(),
            key: place,
        }
    }
}

/// What stands where a list is expected, written as a list.
pub fn as_a_list(value: &Raw<'_>, file: &str) -> Option<Said> {
    match value.get_ref() {
        DeValue::Table(_) => Some(say!(
            "one is a list as well: [{{ … }}], or the header in double brackets"
        )),
        DeValue::String(text) => {
            // A list in a cell of a table that other commas part: `[1.0001; 1.0002]`.
            let inside = text.trim().trim_start_matches('[').trim_end_matches(']');
            let separated = inside.split([',', ';', '，', '、', ' ']);
            let members: Vec<&str> = separated.map(str::trim).filter(|m| !m.is_empty()).collect();
            let numbers = members.len() > 1 && members.iter().all(|m| m.parse::<f64>().is_ok());
            match numbers {
                true => Some(say!("write [{}]", excerpt(&members))),
                false => {
                    let texts: Vec<String> = members.iter().map(|m| format!("\"{m}\"")).collect();
                    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
                    Some(say!("write [{}]", excerpt(&texts)))
                }
            }
        }
        _ => file
            .get(value.span())
            .map(|one| say!("one is a list as well: [{one}]")),
    }
}

/// `[10,13, 10,15]`: whole numbers whose commas stand close and apart in turns are numbers with decimal
/// commas, and would be read as twice as many.
fn decimal_commas(value: &Raw<'_>, list: &[Raw<'_>], file: &str) -> Option<Fault> {
    let texts: Vec<&str> = list
        .iter()
        .map(|item| file.get(item.span()))
        .collect::<Option<_>>()?;
    let whole = |item: &Raw<'_>| matches!(item.get_ref(), DeValue::Integer(_));
    let between = |pair: &[Raw<'_>]| file.get(pair[0].span().end..pair[1].span().start);
    let close = |pair: &[Raw<'_>]| between(pair) == Some(",");
    // Pairs on lines of their own are pairs.
    let lines = list
        .windows(2)
        .any(|pair| between(pair).is_none_or(|gap| gap.contains('\n')));
    let digits = |text: &&str| text.bytes().all(|byte| byte.is_ascii_digit());
    if lines || !texts.iter().skip(1).step_by(2).all(digits) {
        return None;
    }
    let in_turns = list
        .windows(2)
        .enumerate()
        .all(|(place, pair)| close(pair) == (place % 2 == 0));
    if list.len() < 4 || !list.len().is_multiple_of(2) || !list.iter().all(whole) || !in_turns {
        return None;
    }
    let joined = |sign: &str| -> Vec<String> {
        let pairs = texts.chunks(2);
        pairs.map(|pair| pair.join(sign)).collect()
    };
    let numbers = joined(".");
    // 1,000 may be a thousand.
    let thousands = match texts.iter().skip(1).step_by(2).all(|text| text.len() == 3) {
        true => format!("; or, for thousands, [{}]", excerpt(&joined(""))),
        false => String::new(),
    };
    Some(
        Fault::new(
            AMOUNT,
            value.span(),
            say!(
                "{} numbers with decimal commas, or {} whole numbers?",
                numbers.len(),
                list.len()
            ),
        )
        .label(say!("every second comma stands close"))
        .help(say!(
            "write decimal points: [{}]; or a space behind every comma: [{}]{thousands}",
            excerpt(&numbers),
            excerpt(&texts)
        )),
    )
}

/// The first entries of a list.
fn excerpt<T: AsRef<str>>(entries: &[T]) -> String {
    let shown: Vec<&str> = entries.iter().take(4).map(AsRef::as_ref).collect();
    let more = if entries.len() > shown.len() {
        ", …"
    } else {
        ""
    };
    format!("{}{more}", shown.join(", "))
}

fn read_item<T: FromToml>(item: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Stated<T>> {
    T::read(item, reader).map(|value| Stated {
        value,
        span: item.span(),
        key: item.span(),
    })
}

/// A table, or several as `[[name]]`.
#[derive(Debug, Clone)]
pub struct OneOrMany<T>(pub Vec<Stated<T>>);

impl<T: FromToml> FromToml for OneOrMany<T> {
    fn expected() -> Said {
        say!("{}, or several", T::expected())
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Array(_) => Vec::read(value, reader).map(OneOrMany),
            _ => read_item(value, reader).map(|one| OneOrMany(vec![one])),
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [T::schema(), { "type": "array", "items": T::schema() }] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        T::tables(path, rows);
    }
}

/// Entries under names that the user chooses, in the order of the file.
#[derive(Debug, Clone)]
pub struct Named<T> {
    /// The entries that could be read.
    pub entries: Vec<(SmolStr, Stated<T>)>,
    /// Whether an entry could not be read.
    pub refused: bool,
}

/// A text that is no amount is a key of the whole file where it has the name of one: `model = "V / R"` below [constant].
fn tell_place_of_key(key: &str, item: &Raw<'_>, faults: &mut [Fault], hints: &Hints) {
    let is_text = matches!(item.get_ref(), DeValue::String(_));
    if is_text && (hints.top)().contains(&key) {
        for fault in faults.iter_mut().filter(|fault| fault.code == AMOUNT) {
            fault.help = Some(above_the_first_table(key));
        }
    }
}

impl<T: FromToml> FromToml for Named<T> {
    fn expected() -> Said {
        say!("a table of named entries")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        let DeValue::Table(table) = value.get_ref() else {
            let help = say!(
                "each entry has a name: [….NAME] as its header, with its keys below, or NAME = {{ … }}"
            );
            return reader.wrong_type_with(value, Self::expected(), Some(help));
        };
        let mut named = Named {
            // Tables are large, and would be moved again and again as the list grows.
            entries: Vec::with_capacity(table.len()),
            refused: false,
        };
        for (key, item) in in_order(table) {
            let before = reader.faults.len();
            let (name, span, place) = (SmolStr::new(key.get_ref()), item.span(), key.span());
            match T::read(item, reader) {
                // Nothing is called in between, so that the table is moved once.
                Some(value) => named.entries.push((
                    name,
                    Stated {
                        value,
                        span,
                        key: place,
                    },
                )),
                None => {
                    named.refused = true;
                    let faults = &mut reader.faults[before..];
                    tell_place_of_key(key.get_ref(), item, faults, reader.hints);
                }
            }
        }
        Some(named)
    }

    fn schema() -> Value {
        json!({ "type": "object", "additionalProperties": T::schema() })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        T::tables(&inner(path, "NAME"), rows);
    }
}
