//! `[constant.NAME]`.

use gumption_fault::{Said, say};
use serde_json::{Value, json};
use toml::de::DeValue;

use super::list::List;
use gumption_format::toml::{Amount, FromToml, KeyRow, Raw, Reader, Stated, table};

table! {
    /// An exactly known quantity.
    ConstantTable "[constant]" {
        /// Its value, in its unit.
        value: Amount,
        /// Several values: a vector.
        values: List<f64>,
        /// Its unit; when left out that of `value`, and dimension one where that has none either.
        unit: String,
        /// What it is.
        description: String,
        /// Where it comes from.
        reference: String,
    }
}

/// A constant: `c = 9.8`, `c = "299792458 m/s"`, `c = [1, 2, 3]`, or a table.
#[derive(Debug, Clone)]
pub struct ConstantEntry(pub ConstantTable);

impl FromToml for ConstantEntry {
    fn expected() -> Said {
        say!("a number, an amount, a list of numbers or a table")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        if matches!(value.get_ref(), DeValue::Table(_)) {
            return ConstantTable::read(value, reader).map(ConstantEntry);
        }
        if matches!(value.get_ref(), DeValue::Array(_)) {
            let values = List::<f64>::read(value, reader)?;
            return Some(ConstantEntry(ConstantTable {
                values: Some(Box::new(Stated {
                    value: values,
                    span: value.span(),
                    key: value.span(),
                })),
                ..ConstantTable::default()
            }));
        }
        let amount = Amount::read(value, reader)?;
        let unit = amount.unit.clone().map(|(text, span)| Stated {
            value: text,
            key: span.clone(),
            span,
        });
        let value = Some(Stated {
            value: amount,
            span: value.span(),
            key: value.span(),
        });
        Some(ConstantEntry(ConstantTable {
            value: value.map(Box::new),
            unit: unit.map(Box::new),
            ..ConstantTable::default()
        }))
    }

    fn schema() -> Value {
        json!({ "oneOf": [Amount::schema(), List::<f64>::schema(), ConstantTable::schema()] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        ConstantTable::tables(path, rows);
    }
}
