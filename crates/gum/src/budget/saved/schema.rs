//! JSON Schema of a file of saved results.

use serde_json::{Value, json};

use super::RESULT_FORMAT;

/// JSON Schema of a file of saved results.
pub fn result_schema() -> Value {
    let mut schema = object(
        "Results that `gumption eval --save` writes and `from = { result = … }` of a budget reads. Numbers are written with the fewest digits that read back as the same double.",
        json!({
            "format": { "const": RESULT_FORMAT, "description": "Name and version of this format." },
            "generator": text("Program that wrote it, with its version."),
            "title": text("Title of the budget."),
            "files": list(file()),
            "results": list(result()),
            "components": list(component()),
            "correlated": list(correlated()),
            "remarks": list(remark()),
        }),
    );
    if let Value::Object(entries) = &mut schema {
        entries.insert(
            "$schema".into(),
            json!("http://json-schema.org/draft-07/schema#"),
        );
        entries.insert("title".into(), json!("gumption saved results"));
    }
    schema
}

fn file() -> Value {
    object(
        "A file that states components or results.",
        json!({
            "path": text("From the folder of this file, with `/` between its parts."),
            "units": { "type": "array", "items": { "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 }, "description": "Units that the file defines: name and definition." },
        }),
    )
}

fn result() -> Value {
    object(
        "A result in linear form: estimate + Σ sensitivity · component.",
        json!({
            "file": index("Index into files: the budget."),
            "row": optional("Row of its series."),
            "measurand": text("Name of the measurand."),
            "description": optional("What it is."),
            "unit": text("Unit of the estimate."),
            "estimate": number("Estimate y."),
            "standard_uncertainty": number("Combined standard uncertainty, first order; follows from the terms."),
            "effective_degrees_of_freedom": extended("Effective degrees of freedom; follow from the terms."),
            "linear": { "type": "boolean", "description": "Whether the model is linear in everything that is uncertain." },
            "validated": { "anyOf": [{ "type": "boolean" }, { "type": "null" }], "description": "Whether Monte Carlo validated the result (JCGM 101 clause 8, at the digits of the statement); null where it was not run." },
            "terms": list(object("How a component enters.", json!({
                "component": index("Index into components."),
                "sensitivity": number("Change of the result per unit of the component."),
            }))),
        }),
    )
}

fn component() -> Value {
    object(
        "An elementary component: a zero-mean deviation. File, row and name are its identity.",
        json!({
            "file": index("Index into files: the file that states it."),
            "row": optional("Row of that file's series."),
            "name": text("Its name in that file."),
            "label": text("Its name without that of its input."),
            "source": optional("The shared cause to which it belongs."),
            "unit": text("Unit of the deviation."),
            "standard_uncertainty": number("Standard uncertainty as GUM propagates it."),
            "degrees_of_freedom": extended("Degrees of freedom."),
            "distribution": { "type": "object", "description": "Distribution of the deviation: its name, as in budget files, and its parameters.", "required": ["name"], "properties": { "name": { "type": "string" } } },
            "evaluation": { "enum": ["A", "B"], "description": "Type of evaluation." },
            "how": text("How the standard uncertainty was found."),
            "certificate": { "anyOf": [{ "type": "null" }, object("The certificate behind it.", json!({
                "number": optional("Number."),
                "laboratory": optional("Laboratory."),
                "date": optional("Date."),
                "due": optional("Due date."),
                "k": { "type": ["number", "null"], "description": "Coverage factor of its U." },
            }))] },
            "reference": optional("Where the number comes from."),
        }),
    )
}

fn correlated() -> Value {
    object(
        "Correlated components.",
        json!({
            "members": { "type": "array", "items": { "type": "integer", "minimum": 0 }, "description": "Indices into components." },
            "correlation": matrix("Correlation matrix."),
            "law": { "type": "object", "description": "Joint distribution: normal, t (dof, scale) or gaussian-copula (latent).", "required": ["name"], "properties": { "name": { "enum": ["normal", "t", "gaussian-copula"] } } },
            "degrees_of_freedom": { "anyOf": [{ "type": "number" }, { "type": "null" }], "description": "Common degrees of freedom." },
        }),
    )
}

fn remark() -> Value {
    object(
        "What must be known of a file.",
        json!({
            "file": index("Index into files."),
            "row": optional("Row of its series."),
            "en": text("In English."),
            "zh": text("In Chinese."),
        }),
    )
}

fn text(about: &str) -> Value {
    json!({ "type": "string", "description": about })
}

fn optional(about: &str) -> Value {
    json!({ "anyOf": [{ "type": "string" }, { "type": "null" }], "description": about })
}

fn number(about: &str) -> Value {
    json!({ "type": "number", "description": about })
}

fn extended(about: &str) -> Value {
    json!({ "anyOf": [{ "type": "number" }, { "const": "inf" }], "description": about })
}

fn index(about: &str) -> Value {
    json!({ "type": "integer", "minimum": 0, "description": about })
}

fn matrix(about: &str) -> Value {
    json!({ "type": "array", "items": { "type": "array", "items": { "type": "number" } }, "description": about })
}

fn list(item: Value) -> Value {
    json!({ "type": "array", "items": item })
}

/// A table of these keys, all of them required, and no others.
fn object(about: &str, properties: Value) -> Value {
    let required: Vec<String> = properties
        .as_object()
        .map(|map| map.keys().cloned().collect())
        .unwrap_or_default();
    json!({ "type": "object", "description": about, "properties": properties, "required": required, "additionalProperties": false })
}
