//! The machine form of an evaluation: stable field names, exact numbers, a version tag.
//!
//! Numbers are the shortest decimal strings that read back as the same double. Infinity (degrees of
//! freedom) is the string `"inf"`; `null` means that there is no such figure. Every field is always
//! present.

mod claims;
mod decisions;
mod document;
mod fits;
mod joint;
mod result;
mod understood;

use nalgebra::DMatrix;
use serde::{Serialize, Serializer};
use serde_json::Value;

use self::document::Document;
use super::Report;
use super::schema::Describe;

/// Name and version of the format; the number changes when a field changes its meaning or goes.
pub const FORMAT: &str = "gumption-evaluation/1";

/// The evaluation as a JSON value.
pub fn json(report: &Report<'_>) -> Value {
    serde_json::to_value(Document::new(report)).expect("the records hold nothing that JSON cannot")
}

/// Schema of [`json`]'s value.
pub(super) fn describe() -> Value {
    Document::describe()
}

/// A double; infinities as `"inf"` and `"-inf"`, not-a-number as null.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            f64::INFINITY => serializer.serialize_str("inf"),
            f64::NEG_INFINITY => serializer.serialize_str("-inf"),
            x if x.is_nan() => serializer.serialize_none(),
            x => serializer.serialize_f64(x),
        }
    }
}

impl Describe for Number {
    fn describe() -> Value {
        serde_json::json!({ "anyOf": [{ "type": "number" }, { "enum": ["inf", "-inf", null] }] })
    }
}

pub(super) fn number(x: f64) -> Number {
    Number(x)
}

pub(super) fn numbers(xs: &[f64]) -> Vec<Number> {
    xs.iter().copied().map(Number).collect()
}

pub(super) fn matrix(m: &DMatrix<f64>) -> Vec<Vec<Number>> {
    m.row_iter()
        .map(|row| row.iter().copied().map(Number).collect())
        .collect()
}
