//! The form beside the text: what the text states, as a tree with places, and edits of one entry.
//!
//! Both are views of one file. What may stand where is for the schema to say; what is wrong is for the reader of the file.

use std::ops::Range;

use serde::Deserialize;
use serde_json::{Value, json};

use gumption_core::model;
use gumption_fault::{Said, say};
use gumption_format::toml::writing::{self, quoted};
use gumption_format::toml::{Content, Form, Places, Step, StringMap, Unedited, Written, spliced};
use gumption_gum::budget;
use gumption_lab::experiment::{self, Kind, kind_of};

/// An edit of one entry.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Edit {
    /// Gives a key what was typed.
    Set { path: Vec<Step>, typed: String },
    /// Adds an empty table.
    Add { path: Vec<Step> },
    /// Removes an entry.
    Remove { path: Vec<Step> },
    /// Gives a quantity another name, wherever the file names it.
    Rename { path: Vec<Step>, name: String },
    /// Puts a value elsewhere.
    Move { path: Vec<Step>, to: Vec<Step> },
    /// Puts two rows in each other's place.
    Exchange { path: Vec<Step>, with: Vec<Step> },
}

/// A text after edits, one after the other.
///
/// # Errors
/// One of them cannot be made.
pub(crate) fn edited(text: &str, edits: &[Edit]) -> Result<String, Said> {
    let mut text = text.to_owned();
    for edit in edits {
        text = one_edited(&text, edit)?;
    }
    Ok(text)
}

fn one_edited(text: &str, edit: &Edit) -> Result<String, Said> {
    let places = Places::of(text).ok_or_else(|| {
        say!("the text has a fault; the form can be used when it is mended there")
    })?;
    let found = match edit {
        Edit::Set { path, typed } => {
            let schema = schema_of(text);
            places.set(path, typed_content(&forms_at(&schema, path), typed))
        }
        Edit::Add { path } => places.set(path, Content::Table(Vec::new())),
        Edit::Remove { path } => places.remove(path),
        Edit::Rename { path, name } => return renamed(&places, path, name),
        Edit::Move { path, to } => places.moved(path, to),
        Edit::Exchange { path, with } => places.exchanged(path, with),
    };
    found.map_err(|Unedited| say!("this cannot be changed in the form; change it in the text"))
}

/// Whether a text is an experiment.
pub(crate) fn is_experiment(text: &str) -> bool {
    matches!(kind_of(text), Kind::Schedule | Kind::Experiment)
}

/// The schema of a text.
fn schema_of(text: &str) -> Value {
    match is_experiment(text) {
        true => experiment::schema(),
        false => budget::schema(),
    }
}

// ---- what is typed ---------------------------------------------------------------------------------------------

/// What the schema allows at a path, one of each form.
fn forms_at<'s>(schema: &'s Value, path: &[Step]) -> Vec<&'s Value> {
    path.iter().fold(forms(schema), |there, step| {
        let inner = there.into_iter().filter_map(|form| match step {
            Step::Key(key) => {
                let named = form["properties"].get(key);
                named.or(Some(&form["additionalProperties"]).filter(|any| any.is_object()))
            }
            Step::Index(_) => form.get("items"),
        });
        inner.flat_map(forms).collect()
    })
}

fn forms(schema: &Value) -> Vec<&Value> {
    let choices = ["oneOf", "anyOf"].iter();
    let choices = choices.filter_map(|key| schema[*key].as_array()).flatten();
    let found: Vec<&Value> = choices.flat_map(forms).collect();
    if found.is_empty() {
        vec![schema]
    } else {
        found
    }
}

fn has_type(form: &Value, name: &str) -> bool {
    match &form["type"] {
        Value::String(one) => one == name,
        Value::Array(several) => several.iter().any(|one| one == name),
        _ => name == "string" && form.get("enum").is_some(),
    }
}

/// A typed text as the file has it: a number stays as it was typed, a list is between commas, everything else is a text.
fn typed_content(forms: &[&Value], typed: &str) -> Content {
    let allows = |name: &str| forms.iter().any(|form| has_type(form, name));
    let line = typed.trim();
    let token = |text: &str| Content::Token(text.to_owned());
    let is_number = |text: &str| {
        let found = format!("x = {text}").parse::<toml::Table>();
        found.is_ok_and(|table| table["x"].is_integer() || table["x"].is_float())
    };
    if allows("boolean") && ["true", "false"].contains(&line) {
        return token(line);
    }
    if (allows("number") || allows("integer")) && is_number(line) {
        return token(line);
    }
    let is_single = allows("string") || allows("number");
    if allows("array") && (!is_single || line.starts_with('[') || line.contains(", ")) {
        let list = format!("x = {line}").parse::<toml::Table>();
        if list.is_ok_and(|table| table["x"].is_array()) {
            return token(line);
        }
        let elements = forms.iter().filter_map(|form| form.get("items"));
        let elements: Vec<&Value> = elements.flat_map(self::forms).collect();
        let parts = parted(line).into_iter();
        return Content::List(parts.map(|part| typed_content(&elements, part)).collect());
    }
    match typed.trim_end().contains('\n') {
        true => Content::Token(lines(typed)),
        false => Content::Token(quoted(line)),
    }
}

/// The elements of a typed list. A comma without a space beside spaces is a decimal one, of which the reader of the file says what to write.
fn parted(line: &str) -> Vec<&str> {
    let has_spaces = line.contains(char::is_whitespace);
    let parts: Vec<&str> = match line {
        _ if line.contains([';', '；']) => line.split([';', '；']).collect(),
        _ if line.contains(", ") || line.contains('，') || !has_spaces => {
            line.split([',', '，']).collect()
        }
        _ => line.split_whitespace().collect(),
    };
    let parts = parts.into_iter().map(str::trim);
    parts.filter(|part| !part.is_empty()).collect()
}

/// A text of several lines, each on its own.
fn lines(text: &str) -> String {
    let inner: Vec<String> = text
        .trim_end()
        .lines()
        .map(|line| {
            let quoted = quoted(line.trim_end());
            quoted[1..quoted.len() - 1].to_owned()
        })
        .collect();
    format!("\"\"\"\n{}\n\"\"\"", inner.join("\n"))
}

// ---- names -----------------------------------------------------------------------------------------------------

/// Tables whose names stand in formulas, and where else they are named.
const NAMED: [(&str, bool, &[&str]); 5] = [
    (
        "input",
        true,
        &["between", "inputs", "carrier", "gross", "columns"],
    ),
    ("constant", true, &["columns"]),
    ("measurand", true, &["measurand"]),
    ("source", false, &["source", "between"]),
    ("fit", false, &["residual_of"]),
];

/// The text with another name for a quantity: its key, the formulas, and what refers to it.
fn renamed(places: &Places<'_>, path: &[Step], name: &str) -> Result<String, Said> {
    let unedited = |_| say!("this cannot be changed in the form; change it in the text");
    let [Step::Key(table), Step::Key(old)] = path else {
        return places.rename(path, name).map_err(unedited);
    };
    let Some((_, in_formulas, keys)) = NAMED.iter().find(|(known, ..)| known == table) else {
        return places.rename(path, name).map_err(unedited);
    };
    let whole = |text: &str| matches!(model::names(text).as_slice(), [(_, span)] if span.len() == text.len());
    if *in_formulas && !whole(name) {
        return Err(say!(
            "`{name}` is no name: letters, digits and _, a letter first"
        ));
    }
    let mut splices: Vec<(Range<usize>, String)> = Vec::new();
    for (at, span) in places.scalars() {
        let Some(map) = StringMap::new(places.text, span) else {
            continue;
        };
        let last = at.iter().rev().find_map(|step| match step {
            Step::Key(key) => Some(key.as_str()),
            Step::Index(_) => None,
        });
        // `from` names the measurand of another file.
        let is_elsewhere = at.contains(&Step::Key("from".into()));
        if last == Some("model") && *in_formulas && !is_local(places, &at, old) {
            let found = model::names(map.text()).into_iter();
            for (found, range) in found {
                if found == name {
                    return Err(say!("the name `{name}` is taken"));
                }
                if found == *old {
                    splices.push((map.place(range), name.to_owned()));
                }
            }
        } else if last.is_some_and(|last| keys.contains(&last)) && !is_elsewhere {
            let text = map.text();
            let is_named = text.strip_prefix(old.as_str());
            if is_named.is_some_and(|rest| rest.is_empty() || rest.starts_with('.')) {
                splices.push((map.place(0..old.len()), name.to_owned()));
            }
        }
    }
    let schema = schema_of(places.text);
    for (named, place) in places.keys() {
        // Claims name inputs, their components and their figures as keys.
        let Some((Step::Key(key), parent)) = named.split_last() else {
            continue;
        };
        let is_key = |form: &&Value| form["properties"].get(key).is_some();
        let is_name = parent.first() == Some(&Step::Key("claim".into()))
            && !forms_at(&schema, parent).iter().any(is_key);
        if let Some(rest) = key.strip_prefix(old.as_str())
            && (is_name && (rest.is_empty() || rest.starts_with(['.', '('])))
        {
            splices.push((place, writing::key(&format!("{name}{rest}"))));
        }
    }
    let taken = NAMED.iter().any(|(table, ..)| {
        let other = [Step::Key((*table).into()), Step::Key(name.into())];
        places.value(&other).is_some() || places.below(&other).next().is_some()
    });
    if taken {
        return Err(say!("the name `{name}` is taken"));
    }
    let text = spliced(places.text, splices);
    let places = Places::of(&text).ok_or(Unedited).map_err(unedited)?;
    places.rename(path, name).map_err(unedited)
}

/// Whether a formula belongs to a fit that has a column or a parameter of that name.
fn is_local(places: &Places<'_>, formula: &[Step], name: &str) -> bool {
    let [fit, of, ..] = formula else {
        return false;
    };
    *fit == Step::Key("fit".into())
        && ["data", "parameters"].iter().any(|part| {
            let own = [
                fit.clone(),
                of.clone(),
                Step::Key((*part).into()),
                Step::Key(name.into()),
            ];
            places.value(&own).is_some() || places.below(&own).next().is_some()
        })
}

// ---- what is shown ---------------------------------------------------------------------------------------------

/// What a text states.
enum Node {
    Scalar(Range<usize>),
    List(Vec<Shown>),
    Table(Vec<(String, Shown)>),
}

/// An entry with its place: of the key with its value, or of the header.
struct Shown {
    node: Node,
    place: Option<Range<usize>>,
}

/// The entries of a text with their places; nothing where the text has a fault.
pub(crate) fn view(text: &str) -> Value {
    let Some(places) = Places::of(text) else {
        return Value::Null;
    };
    let mut top = Shown {
        node: Node::Table(Vec::new()),
        place: None,
    };
    for statement in &places.statements {
        state(&mut top, statement, 0);
    }
    let mut units = Vec::with_capacity(text.len() + 1);
    let mut count = 0;
    for c in text.chars() {
        units.extend(std::iter::repeat_n(count, c.len_utf8()));
        count += c.len_utf16();
    }
    units.push(count);
    let kind = if is_experiment(text) {
        "experiment"
    } else {
        "budget"
    };
    json!({ "kind": kind, "entries": shown(&top, text, &units) })
}

fn state(there: &mut Shown, statement: &gumption_format::toml::Statement, depth: usize) {
    let Some(step) = statement.path.get(depth) else {
        there.place = Some(statement.span.clone());
        if let Some(value) = &statement.value {
            there.node = node(value, statement.path.len());
        }
        return;
    };
    if let Some(next) = entry(&mut there.node, step) {
        state(next, statement, depth + 1);
    }
}

/// The entry at a step, a new one where there is none.
fn entry<'n>(node: &'n mut Node, step: &Step) -> Option<&'n mut Shown> {
    let empty = || Shown {
        node: Node::Table(Vec::new()),
        place: None,
    };
    if let (Node::Table(entries), Step::Index(_)) = (&*node, step)
        && entries.is_empty()
    {
        *node = Node::List(Vec::new());
    }
    match (node, step) {
        (Node::Table(entries), Step::Key(key)) => {
            let at = entries.iter().position(|(name, _)| name == key);
            let at = at.unwrap_or_else(|| {
                entries.push((key.clone(), empty()));
                entries.len() - 1
            });
            entries.get_mut(at).map(|(_, entry)| entry)
        }
        (Node::List(elements), Step::Index(at)) => {
            if *at == elements.len() {
                elements.push(empty());
            }
            elements.get_mut(*at)
        }
        _ => None,
    }
}

fn node(value: &Written, depth: usize) -> Node {
    match &value.form {
        Form::Scalar => Node::Scalar(value.span.clone()),
        Form::List(elements) => {
            let elements = elements.iter();
            let elements = elements.map(|one| Shown {
                node: node(one, depth + 1),
                place: Some(one.span.clone()),
            });
            Node::List(elements.collect())
        }
        Form::Table(inner) => {
            let mut table = Shown {
                node: Node::Table(Vec::new()),
                place: None,
            };
            for statement in inner {
                state(&mut table, statement, depth);
            }
            table.node
        }
    }
}

/// For the page; places in units of UTF-16, as an editor of the browser counts.
fn shown(one: &Shown, text: &str, units: &[usize]) -> Value {
    let place = one.place.as_ref();
    let place = place.map(|place| [units[place.start], units[place.end]]);
    match &one.node {
        Node::Scalar(span) => {
            let written = &text[span.clone()];
            let said = StringMap::new(text, span.clone());
            let said = said.as_ref().map_or(written, StringMap::text);
            json!({ "text": said, "place": place })
        }
        Node::List(elements) => {
            let elements: Vec<Value> = elements.iter().map(|one| shown(one, text, units)).collect();
            json!({ "items": elements, "place": place })
        }
        Node::Table(entries) => {
            // Pairs: the page is to keep their order, whatever their names.
            let entries = entries.iter();
            let entries: Vec<Value> = entries
                .map(|(key, one)| json!([key, shown(one, text, units)]))
                .collect();
            json!({ "keys": entries, "place": place })
        }
    }
}

#[cfg(test)]
mod tests;
