//! Cells of a series.

use gumption_fault::{Said, say};
use serde_json::{Value, json};
use toml::de::DeValue;

use gumption_format::toml::{FromToml, Raw, Reader};

/// An entry of a row of a series; an empty text leaves out what its column names.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// A label, or a number with its unit.
    Text(String),
    /// A value.
    Number(f64),
    /// A list, such as the readings of a row; what may stand in it is for the key to say into which it goes.
    List,
}

impl FromToml for Entry {
    fn expected() -> Said {
        say!("a number, a list or a label")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(text) => Some(Entry::Text(text.to_string())),
            DeValue::Array(_) => Some(Entry::List),
            _ => f64::read(value, reader).map(Entry::Number),
        }
    }

    fn schema() -> Value {
        json!({ "type": ["number", "string", "array"] })
    }
}
