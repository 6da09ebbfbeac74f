//! Numbers that may be infinite, in JSON: degrees of freedom without end are `"inf"`.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

/// For `#[serde(with)]`.
pub fn serialize<S: Serializer>(x: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if *x == f64::INFINITY {
        serializer.serialize_str("inf")
    } else {
        serializer.serialize_f64(*x)
    }
}

/// For `#[serde(with)]`.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Either {
        Number(f64),
        Word(String),
    }
    match Either::deserialize(deserializer)? {
        Either::Number(x) => Ok(x),
        Either::Word(word) if word == "inf" => Ok(f64::INFINITY),
        Either::Word(word) => Err(D::Error::custom(format!("`{word}` is no number"))),
    }
}
