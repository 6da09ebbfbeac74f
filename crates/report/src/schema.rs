//! JSON Schema of the machine form, from the same declarations that write it.

use serde_json::{Map, Value, json};

/// A type that describes its JSON form.
pub(super) trait Describe {
    /// Its schema.
    fn describe() -> Value;
}

/// Declares a structure of the machine form: serialisation and schema from one text, the
/// description of each field being its documentation.
macro_rules! record {
    ($(#[doc = $about:literal])* $name:ident $(<$life:lifetime>)? { $($(#[doc = $doc:literal])* $field:ident: $type:ty,)* }) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, serde::Serialize)]
        pub(super) struct $name $(<$life>)? {
            $($(#[doc = $doc])* pub(super) $field: $type,)*
        }

        impl $(<$life>)? $crate::schema::Describe for $name $(<$life>)? {
            fn describe() -> serde_json::Value {
                $crate::schema::object(
                    concat!($($about),*),
                    vec![$((
                        stringify!($field),
                        concat!($($doc),*),
                        <$type as $crate::schema::Describe>::describe(),
                    )),*],
                )
            }
        }
    };
}
pub(super) use record;

/// The schema of an object all of whose fields are always present.
pub(super) fn object(about: &str, fields: Vec<(&str, &str, Value)>) -> Value {
    let required: Vec<&str> = fields.iter().map(|(name, _, _)| *name).collect();
    let mut properties = Map::new();
    for (name, doc, mut schema) in fields {
        if let Value::Object(map) = &mut schema {
            map.insert("description".to_string(), Value::from(doc.trim()));
        }
        properties.insert(name.to_string(), schema);
    }
    json!({
        "type": "object",
        "description": about.trim(),
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

impl Describe for &str {
    fn describe() -> Value {
        json!({ "type": "string" })
    }
}

impl Describe for String {
    fn describe() -> Value {
        json!({ "type": "string" })
    }
}

impl Describe for bool {
    fn describe() -> Value {
        json!({ "type": "boolean" })
    }
}

impl Describe for u64 {
    fn describe() -> Value {
        json!({ "type": "integer", "minimum": 0 })
    }
}

impl Describe for Value {
    fn describe() -> Value {
        json!({})
    }
}

impl<T: Describe> Describe for Option<T> {
    fn describe() -> Value {
        json!({ "anyOf": [T::describe(), { "type": "null" }] })
    }
}

impl<T: Describe> Describe for Vec<T> {
    fn describe() -> Value {
        json!({ "type": "array", "items": T::describe() })
    }
}

/// JSON Schema of the output of `gumption eval --json`: one evaluation, or an array of them.
pub fn schema() -> Value {
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "gumption evaluation",
        "description": "Output of `gumption eval --json`. A number is written with the fewest digits that read back as the same double; infinity is the string \"inf\" or \"-inf\"; null means that there is no such figure.",
        "definitions": { "evaluation": super::json::describe() },
        "anyOf": [
            { "$ref": "#/definitions/evaluation" },
            { "type": "array", "items": { "$ref": "#/definitions/evaluation" } },
        ],
    })
}
