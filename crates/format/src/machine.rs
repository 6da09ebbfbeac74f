//! The machine form: structures that know their JSON and its schema.
//!
//! A number is written as the shortest decimal that reads back as the same double. Infinity (degrees of freedom) is
//! the string `"inf"`; `null` means that there is no such figure.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

/// A type that describes its JSON form.
pub trait Describe {
    /// Its schema.
    fn describe() -> Value;
}

/// The whole of a document for machines. Its name and version, and the program that wrote it, are put in front of
/// its fields: `"format": "gumption-evaluation/1"`, `"generator": "gumption 0.1.0"`.
pub trait Machine: Serialize + Describe {
    /// What it documents.
    const KIND: &'static str;
    /// Changes when a field changes its meaning or goes.
    const VERSION: u32;
    /// Whether a command may print several of them, as an array.
    const SEVERAL: bool = false;

    /// Name and version of the form.
    fn format() -> String {
        format!("gumption-{}/{}", Self::KIND, Self::VERSION)
    }
}

/// Declares structures of a machine form: serialisation and schema from one text, the description of each field being
/// its documentation. A field is always present, unless `#[serde(skip_serializing_if = …)]` stands over it.
#[macro_export]
macro_rules! record {
    ($($(#[doc = $about:literal])* $name:ident $(<$life:lifetime>)? {
        $($(#[doc = $doc:literal])* $(#[serde($($serde:tt)*)])? $field:ident: $type:ty,)*
    })*) => {$(
        $(#[doc = $about])*
        #[derive(Debug, Clone, serde::Serialize)]
        pub(super) struct $name $(<$life>)? {
            $($(#[doc = $doc])* $(#[serde($($serde)*)])? pub(super) $field: $type,)*
        }

        impl $(<$life>)? $crate::machine::Describe for $name $(<$life>)? {
            fn describe() -> serde_json::Value {
                $crate::machine::object(
                    concat!($($about),*),
                    vec![$($crate::machine::Field {
                        name: stringify!($field),
                        about: concat!($($doc),*),
                        serde: concat!($(stringify!($($serde)*))?),
                        schema: <$type as $crate::machine::Describe>::describe(),
                    }),*],
                )
            }
        }
    )*};
}
pub use record;

/// Declares [`record!`]s together with what fills them: `Name of (one: &One) { field: Type = expression, }` is a
/// structure, its schema, and `Name::of`.
#[macro_export]
macro_rules! form {
    ($($(#[doc = $about:literal])* $name:ident $(<$life:lifetime>)? of ($($arg:ident: $given:ty),*) {
        $($(#[doc = $doc:literal])* $(#[serde($($serde:tt)*)])? $field:ident: $type:ty = $value:expr,)*
    })*) => {
        $crate::record! {$(
            $(#[doc = $about])*
            $name $(<$life>)? {
                $($(#[doc = $doc])* $(#[serde($($serde)*)])? $field: $type,)*
            }
        )*}

        $(impl $(<$life>)? $name $(<$life>)? {
            pub(super) fn of($($arg: $given),*) -> Self {
                $name { $($field: $value,)* }
            }
        })*
    };
}
pub use form;

/// A field of a [`record!`].
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Its documentation.
    pub about: &'static str,
    /// What `serde` is told about it: `skip_serializing_if`, `rename`, `flatten`.
    pub serde: &'static str,
    /// Schema of its value.
    pub schema: Value,
}

impl Field {
    /// Its name in the JSON.
    fn key(&self) -> &'static str {
        let renamed = self.serde.split_once("rename = \"");
        let renamed = renamed.and_then(|(_, rest)| rest.split('"').next());
        renamed.unwrap_or_else(|| self.name.trim_start_matches("r#"))
    }
}

/// The schema of an object.
pub fn object(about: &str, fields: Vec<Field>) -> Value {
    let (mut properties, mut required) = (Map::new(), Vec::new());
    for mut field in fields {
        if field.serde.contains("flatten") {
            if let Some(Value::Object(inner)) = field.schema.get_mut("properties") {
                properties.append(inner);
            }
            if let Some(Value::Array(inner)) = field.schema.get_mut("required") {
                required.append(inner);
            }
            continue;
        }
        if let Value::Object(map) = &mut field.schema {
            map.insert("description".to_string(), Value::from(field.about.trim()));
        }
        if !field.serde.contains("skip_serializing_if") {
            required.push(Value::from(field.key()));
        }
        properties.insert(field.key().to_string(), field.schema);
    }
    json!({
        "type": "object",
        "description": about.trim(),
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// A form with its name, its version and its program in front.
#[derive(Serialize)]
struct Whole<'m, M> {
    format: String,
    generator: &'static str,
    #[serde(flatten)]
    fields: &'m M,
}

/// The machine form of a document as compact JSON. It is kept as text: as a tree of values it would take ten times the
/// memory, whether anyone asks for it or not.
#[derive(Debug, Clone, PartialEq)]
pub struct Json(String);

impl Json {
    pub(crate) fn of<M: Machine>(machine: &M) -> Json {
        let whole = Whole {
            format: M::format(),
            generator: concat!("gumption ", env!("CARGO_PKG_VERSION")),
            fields: machine,
        };
        // A record has string keys and no number that JSON cannot write: this does not fail.
        Json(serde_json::to_string(&whole).unwrap_or_default())
    }

    /// Several together as an array, into which arrays are taken up; one alone as it is.
    pub(crate) fn together(all: Vec<Json>) -> Json {
        let mut texts: Vec<String> = all.into_iter().map(|json| json.0).collect();
        if texts.len() == 1 {
            return Json(texts.remove(0));
        }
        let items = texts.iter().map(|text| {
            let inner = text.strip_prefix('[');
            inner
                .and_then(|text| text.strip_suffix(']'))
                .unwrap_or(text)
        });
        Json(format!("[{}]", items.collect::<Vec<_>>().join(",")))
    }

    /// The text, in one line.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// As a tree of values.
    pub fn value(&self) -> Value {
        // It was written by the same library.
        serde_json::from_str(&self.0).unwrap_or_default()
    }

    /// The text with a line for each element, indented by two spaces for each level.
    pub fn indented(&self) -> String {
        let mut out = String::with_capacity(2 * self.0.len());
        let (mut depth, mut last) = (0, ' ');
        // Whether it is inside a string, and behind a backslash in one.
        let (mut quoted, mut escaped) = (false, false);
        for c in self.0.chars() {
            let (opened, closes) = (matches!(last, '{' | '['), matches!(c, '}' | ']'));
            depth -= usize::from(closes && !quoted);
            // An empty list stays in its line.
            if !quoted && (opened != closes || last == ',') {
                out.push('\n');
                out.extend(std::iter::repeat_n("  ", depth));
            }
            out.push(c);
            match c {
                '"' if !escaped => quoted = !quoted,
                '{' | '[' if !quoted => depth += 1,
                ':' if !quoted => out.push(' '),
                _ => {}
            }
            escaped = quoted && c == '\\' && !escaped;
            // What stands in a string has no part in this.
            last = if quoted { '"' } else { c };
        }
        out.push('\n');
        out
    }
}

/// JSON Schema of the machine form of a document, for `command`'s output.
pub fn schema<M: Machine>(command: &str) -> Value {
    let mut form = M::describe();
    if let Some(Value::Array(required)) = form.get_mut("required") {
        required.splice(0..0, [Value::from("format"), Value::from("generator")]);
    }
    if let Some(Value::Object(properties)) = form.get_mut("properties") {
        let fields = std::mem::take(properties);
        properties.insert(
            "format".into(),
            json!({ "const": M::format(), "description": "Name and version of this format." }),
        );
        properties.insert(
            "generator".into(),
            json!({ "type": "string", "description": "Program that wrote it, with its version." }),
        );
        properties.extend(fields);
    }
    let mut whole = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": format!("gumption {}", M::KIND),
        "description": format!("Output of `{command}`. A number is written with the fewest digits that read back as the same double; infinity is the string \"inf\" or \"-inf\"; null means that there is no such figure."),
    });
    let (Value::Object(entries), Value::Object(fields)) = (&mut whole, form) else {
        return whole;
    };
    if M::SEVERAL {
        let reference = json!({ "$ref": format!("#/definitions/{}", M::KIND) });
        entries.insert("definitions".into(), json!({ M::KIND: fields }));
        let array = json!({ "type": "array", "items": reference });
        entries.insert("anyOf".into(), json!([reference, array]));
    } else {
        entries.extend(fields.into_iter().filter(|(key, _)| key != "description"));
    }
    whole
}

/// A double; infinities as `"inf"` and `"-inf"`, not-a-number as null.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number(pub f64);

impl From<f64> for Number {
    fn from(x: f64) -> Self {
        Number(x)
    }
}

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

/// A list in another form.
pub fn all<'a, T, F>(list: &'a [T], form: impl FnMut(&'a T) -> F) -> Vec<F> {
    list.iter().map(form).collect()
}

/// Numbers of a list.
pub fn numbers(xs: &[f64]) -> Vec<Number> {
    xs.iter().copied().map(Number).collect()
}

macro_rules! describe {
    ($($type:ty: $schema:tt)*) => {$(
        impl Describe for $type {
            fn describe() -> Value {
                json!($schema)
            }
        }
    )*};
}

describe! {
    &str: { "type": "string" }
    String: { "type": "string" }
    bool: { "type": "boolean" }
    u32: { "type": "integer", "minimum": 0 }
    u64: { "type": "integer", "minimum": 0 }
    usize: { "type": "integer", "minimum": 0 }
    Number: { "anyOf": [{ "type": "number" }, { "enum": ["inf", "-inf", null] }] }
    Value: {}
}

impl<T: Describe> Describe for Option<T> {
    fn describe() -> Value {
        json!({ "anyOf": [T::describe(), { "type": "null" }] })
    }
}

impl<T: Describe> Describe for &[T] {
    fn describe() -> Value {
        Vec::<T>::describe()
    }
}

impl<T: Describe> Describe for Vec<T> {
    fn describe() -> Value {
        json!({ "type": "array", "items": T::describe() })
    }
}

impl<T: Describe, const N: usize> Describe for [T; N] {
    fn describe() -> Value {
        json!({ "type": "array", "items": T::describe(), "minItems": N, "maxItems": N })
    }
}

impl<T: Describe> Describe for Box<T> {
    fn describe() -> Value {
        T::describe()
    }
}

impl<K, T: Describe> Describe for BTreeMap<K, T> {
    fn describe() -> Value {
        json!({ "type": "object", "additionalProperties": T::describe() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_those_of_the_library() {
        let texts = ["a,b", "{[:]}", "\\", "\"", "\\\"{", "", "电,[ "];
        let value = json!({
            "texts": texts,
            "empty": [[], {}, [[]]],
            "x,{": { "a": 1.5, "b": [null, true, { "c": -1e-300 }] },
        });
        let json = Json(value.to_string());
        let expected = serde_json::to_string_pretty(&value).expect("JSON");
        assert_eq!(json.indented(), expected + "\n");
        assert_eq!(json.value(), value);
    }

    #[test]
    fn several_are_one_array() {
        let of = |text: &str| Json(text.to_owned());
        let alone = Json::together(vec![of("{\"a\":[1]}")]);
        assert_eq!(alone.text(), "{\"a\":[1]}");
        let all = Json::together(vec![of("[1,[2]]"), of("3"), of("[4]")]);
        assert_eq!(all.value(), json!([1, [2], 3, 4]));
    }
}
