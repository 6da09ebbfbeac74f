//! What an editor completes: keys by their places, words that a key takes, functions, units.

use serde_json::{Map, Value, json};

use gumption_core::{model, quantity};
use gumption_fault::catalogue::told;
use gumption_fault::language::Language;
use gumption_gum::budget;
use gumption_lab::experiment;

/// All words: of budgets and experiments those of their schemas, in which an editor follows the path of the caret.
pub(crate) fn vocabulary(language: Language) -> Value {
    let functions = model::functions().iter();
    let functions = functions.map(|one| (one.name, one.signature, told(one.doc, language)));
    let units = quantity::units().iter();
    let units = units.map(|unit| (unit.symbol, language.pick(unit.name_en, unit.name_zh)));
    json!({
        "budget": place(&budget::schema(), language),
        "experiment": place(&experiment::schema(), language),
        "functions": functions.collect::<Vec<_>>(),
        "units": units.collect::<Vec<_>>(),
    })
}

/// A place of a file as its schema describes it: what it says, its keys (`keys`), what stands under any name (`any`), and the words that
/// it takes (`words`), whether it takes numbers or texts of one's own (`free`), whether it is true or false (`flag`), or tables one below the other (`rows`). Lists are as their elements; of several forms the keys and words of all.
fn place(schema: &Value, language: Language) -> Value {
    let mut place = Map::new();
    if let Some(says) = schema["description"].as_str() {
        place.insert("says".into(), json!(told(says, language)));
        office(&mut place, says);
    }
    let types = schema["type"].to_string();
    if schema.get("enum").is_none()
        && ["string", "number", "integer"]
            .iter()
            .any(|kind| types.contains(kind))
    {
        place.insert("free".into(), json!(true));
    }
    if schema["type"] == "boolean" {
        place.insert("flag".into(), json!(true));
    }
    if schema["items"]["properties"].is_object() {
        place.insert("rows".into(), json!(true));
    }
    let forms = ["oneOf", "anyOf"].iter();
    let forms = forms.filter_map(|key| schema[*key].as_array()).flatten();
    let inner = forms.chain(schema.get("items"));
    for form in inner.map(|form| self::place(form, language)) {
        joined(&mut place, form);
    }
    if let Some(keys) = schema["properties"].as_object() {
        let keys = keys.iter();
        let keys = keys.map(|(key, inner)| (key.clone(), self::place(inner, language)));
        place.insert("keys".into(), keys.collect::<Map<_, _>>().into());
    }
    let any = &schema["additionalProperties"];
    if any.is_object() {
        place.insert("any".into(), self::place(any, language));
    }
    if let Some(words) = schema["enum"].as_array() {
        place.insert("words".into(), json!(words));
    }
    place.into()
}

/// What a key is for, by its first words: a way to state an uncertainty, with the keys that belong to it (`way`), or one of those that
/// go with such a way (`with`).
fn office(place: &mut Map<String, Value>, says: &str) {
    let Some((office, _)) = says.split_once(':') else {
        return;
    };
    let named: Vec<&str> = office.split('`').skip(1).step_by(2).collect();
    if office == "Way" || office.starts_with("Way, with") {
        place.insert("way".into(), json!(named));
    } else if office.starts_with("With `") {
        place.insert("with".into(), json!(named));
    }
}

/// Adds what another form of a place has; what both have stays as the first says it.
fn joined(place: &mut Map<String, Value>, form: Value) {
    let Value::Object(form) = form else {
        return;
    };
    for (name, more) in form {
        match (place.get_mut(&name), more) {
            (Some(Value::Object(there)), Value::Object(more)) => {
                for (key, one) in more {
                    there.entry(key).or_insert(one);
                }
            }
            (Some(Value::Array(there)), Value::Array(more)) => there.extend(more),
            (Some(_), _) => {}
            (None, more) => {
                place.insert(name, more);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_has_its_words() {
        let all = vocabulary(Language::Chinese);
        let input = &all["budget"]["keys"]["input"]["any"]["keys"];
        assert!(input["half_width"].is_object() && input["components"]["keys"]["u"].is_object());
        assert_eq!(input["certificate"]["way"], json!([]));
        assert_eq!(input["plus"]["way"], json!(["minus"]));
        assert_eq!(input["outlier_test"]["with"], json!(["readings"]));
        assert!(input["dof"].get("way").is_none() && input["components"]["rows"] == true);
        let says = input["unit"]["says"].as_str().expect("words");
        assert!(!says.is_ascii(), "{says}");
        let kinds = input["distribution"]["words"].as_array().expect("words");
        assert!(kinds.contains(&json!("normal")) && kinds.contains(&json!("uniform")));
        assert!(
            all["budget"]["keys"]["profile"]["words"]
                .as_array()
                .is_some_and(|all| all.contains(&json!("JJF")))
        );
        let column = &all["experiment"]["keys"]["columns"]["any"];
        assert!(column["keys"]["role"]["words"].is_array());
        let functions = all["functions"].as_array().expect("functions");
        assert!(functions.iter().any(|one| one[0] == "sqrt"));
    }
}
