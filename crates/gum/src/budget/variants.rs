//! Keys that may be set to values of more than one type.

use gumption_fault::{Said, say};
use serde_json::{Value, json};
use toml::de::DeValue;

use super::tables::{ColumnTable, GroupColumnTable};
use gumption_format::toml::Amount;
use gumption_format::toml::faults::WRONG_TYPE;
use gumption_format::toml::{FromToml, KeyRow, Raw, Reader, Stated, as_a_list, unknown_word};

/// A row of a series, by its label or its number.
#[derive(Debug, Clone)]
pub struct RowLabel(pub String);

impl FromToml for RowLabel {
    fn expected() -> Said {
        say!("a text or a number")
    }

    fn plural() -> Option<Said> {
        Some(say!("texts or a number"))
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Integer(_) => {
                u64::read(value, reader).map(|number| RowLabel(number.to_string()))
            }
            DeValue::Float(_) => {
                f64::read(value, reader).map(|number| RowLabel(number.to_string()))
            }
            _ => String::read(value, reader).map(RowLabel),
        }
    }

    fn schema() -> Value {
        json!({ "type": ["string", "number"] })
    }
}

/// One amount, or one for each element of a vector.
#[derive(Debug, Clone)]
pub enum Amounts {
    /// For the quantity, or for every element alike.
    One(Amount),
    /// For the elements, in their order.
    Each(Vec<Stated<Amount>>),
    /// For the elements, in a column of a CSV file; only beside values of which there are several.
    Column(Box<ColumnTable>),
}

impl Amounts {
    /// The amount that holds for an element; nothing when the list is too short.
    pub(super) fn of_element(stated: &Stated<Self>, element: usize) -> Option<Stated<Amount>> {
        match &stated.value {
            Amounts::One(amount) => Some(stated.map(|_| amount.clone())),
            Amounts::Each(list) => list.get(element).cloned(),
            Amounts::Column(_) => None,
        }
    }
}

impl FromToml for Amounts {
    fn expected() -> Said {
        Amount::expected()
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Array(_) => Vec::read(value, reader).map(Amounts::Each),
            DeValue::Table(_) => {
                ColumnTable::read(value, reader).map(|table| Amounts::Column(Box::new(table)))
            }
            _ => Amount::read(value, reader).map(Amounts::One),
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [
            Amount::schema(),
            Vec::<Stated<Amount>>::schema(),
            ColumnTable::schema(),
        ] })
    }
}

/// Numbers in the file itself or in a column of a CSV file.
#[derive(Debug, Clone)]
pub enum Numbers {
    /// As a list.
    List(Vec<Stated<f64>>),
    /// As a list for each element of a vector.
    Lists(Vec<Stated<Vec<Stated<f64>>>>),
    /// In a column.
    Column(Box<ColumnTable>),
}

impl FromToml for Numbers {
    fn expected() -> Said {
        say!("a list of numbers, or {{ file = \"…\", column = \"…\" }}")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Array(list) if depth(list) > 1 => Vec::read(value, reader).map(Numbers::Lists),
            DeValue::Array(_) => Vec::read(value, reader).map(Numbers::List),
            DeValue::Table(_) => {
                ColumnTable::read(value, reader).map(|table| Numbers::Column(Box::new(table)))
            }
            _ => {
                let help = as_a_list(value, reader.file);
                reader.wrong_type_with(value, Self::expected(), help)
            }
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [
            Vec::<Stated<f64>>::schema(),
            Vec::<Stated<Vec<Stated<f64>>>>::schema(),
            ColumnTable::schema(),
        ] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        ColumnTable::tables(path, rows);
    }
}

/// How deep lists stand in lists, judged by the first of each.
fn depth(list: &toml::de::DeArray<'_>) -> usize {
    match list.iter().next().map(|first| first.get_ref()) {
        Some(DeValue::Array(inner)) => 1 + depth(inner),
        _ => 1,
    }
}

type Lists<T> = Vec<Stated<Vec<T>>>;

/// Readings in groups, in the file itself or in a CSV file.
#[derive(Debug, Clone)]
pub enum Groups {
    /// One list for each group.
    OneWay(Lists<Stated<f64>>),
    /// For each group a list of its subgroups.
    Nested(Lists<Stated<Vec<Stated<f64>>>>),
    /// In a column, beside one or two that name the groups.
    Column(Box<GroupColumnTable>),
}

impl FromToml for Groups {
    fn expected() -> Said {
        say!("a list of lists of numbers, or {{ file = \"…\", column = \"…\", group = \"…\" }}")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Array(list) => match depth(list) {
                1 => reader.wrong_type(WRONG_TYPE, value, Self::expected()),
                2 => Vec::read(value, reader).map(Groups::OneWay),
                _ => Vec::read(value, reader).map(Groups::Nested),
            },
            DeValue::Table(_) => {
                GroupColumnTable::read(value, reader).map(|table| Groups::Column(Box::new(table)))
            }
            _ => reader.wrong_type(WRONG_TYPE, value, Self::expected()),
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [
            Lists::<Stated<f64>>::schema(),
            Lists::<Stated<Vec<Stated<f64>>>>::schema(),
            GroupColumnTable::schema(),
        ] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        GroupColumnTable::tables(path, rows);
    }
}

/// What the reported value is, seen from the readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadingsOf {
    /// Their mean: u = s/√n.
    Mean,
    /// A single reading: u = s.
    Single,
    /// The mean of this many readings: u = s/√m.
    Several(u64),
}

impl FromToml for ReadingsOf {
    fn expected() -> Said {
        say!("\"mean\", \"single\" or a number of readings")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(word) if word == "mean" => Some(ReadingsOf::Mean),
            DeValue::String(word) if word == "single" => Some(ReadingsOf::Single),
            DeValue::String(word) => reader.refuse(unknown_word(
                value,
                word,
                &["mean", "single"],
                Self::expected(),
                reader.hints,
            )),
            _ => match u64::read(value, reader)? {
                0 => reader.wrong_type(WRONG_TYPE, value, Self::expected()),
                count => Some(ReadingsOf::Several(count)),
            },
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [{ "enum": ["mean", "single"] }, { "type": "integer", "minimum": 1 }] })
    }
}

/// A number of trials, or `"adaptive"`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrialsEntry {
    /// Exactly this many.
    Fixed(u64),
    /// As many as needed.
    Adaptive,
}

impl FromToml for TrialsEntry {
    fn expected() -> Said {
        say!("a number of trials or \"adaptive\"")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(word) if word == "adaptive" => Some(TrialsEntry::Adaptive),
            DeValue::String(word) if word.parse::<f64>().is_err() => reader.refuse(unknown_word(
                value,
                word,
                &["adaptive"],
                Self::expected(),
                reader.hints,
            )),
            _ => u64::read(value, reader).map(TrialsEntry::Fixed),
        }
    }

    fn schema() -> Value {
        json!({ "oneOf": [{ "enum": ["adaptive"] }, { "type": "integer", "minimum": 1000 }] })
    }
}
