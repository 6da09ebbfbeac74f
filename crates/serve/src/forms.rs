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
mod tests {
    use std::path::{Path, PathBuf};

    use gumption_format::files::{Files, Folder};
    use gumption_gum::propagate::{MonteCarloChoice, Options, evaluate};

    use super::*;

    /// Every budget of the repository: its folder, its name and its text.
    fn budgets() -> Vec<(PathBuf, String, String)> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../budgets");
        let root = root.canonicalize().expect("a folder");
        let folders = std::fs::read_dir(root).expect("budgets").flatten();
        let files = folders.filter_map(|folder| std::fs::read_dir(folder.path()).ok());
        let files = files.flatten().flatten().map(|file| file.path());
        let texts = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
        let read = texts.map(|path| {
            let name = path
                .file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            let text = std::fs::read_to_string(&path).expect("a text");
            (path.parent().expect("a folder").to_owned(), name, text)
        });
        read.collect()
    }

    fn key(text: &str) -> Step {
        Step::Key(text.into())
    }

    fn path(text: &str) -> Vec<Step> {
        let step = |part: &str| part.parse().map_or_else(|_| key(part), Step::Index);
        text.split('.').map(step).collect()
    }

    fn typed(text: &str, at: &str, typed: &str) -> String {
        let edit = Edit::Set {
            path: path(at),
            typed: typed.into(),
        };
        edited(text, &[edit]).expect(at)
    }

    fn at<'v>(tree: &'v mut toml::Value, path: &[Step]) -> &'v mut toml::Value {
        path.iter().fold(tree, |there, step| match step {
            Step::Key(key) => &mut there[key.as_str()],
            Step::Index(at) => &mut there[*at],
        })
    }

    fn tree(text: &str) -> toml::Value {
        toml::Value::Table(text.parse().expect("TOML"))
    }

    /// Of every entry of every budget: what is there already changes no byte; another value changes that entry, and no line beside it.
    #[test]
    fn an_edit_changes_its_entry_alone() {
        let budgets = budgets();
        assert!(budgets.len() > 50);
        let mut count = 0;
        for (_, name, text) in &budgets {
            assert_eq!(edited(text, &[]).as_ref(), Ok(text));
            let places = Places::of(text).expect("TOML");
            let scalars = places.scalars();
            // Long lists hold the same again and again.
            for (entry, span) in scalars.iter().step_by(scalars.len().div_ceil(60)) {
                let token = |token: &str| Content::Token(token.into());
                assert_eq!(
                    places.set(entry, token(&text[span.clone()])).as_ref(),
                    Ok(text)
                );
                let new = places.set(entry, token("-7.250e3")).expect(name);
                let mut wanted = tree(text);
                *at(&mut wanted, entry) = toml::Value::Float(-7250.0);
                assert_eq!(tree(&new), wanted, "{name} {entry:?}");
                assert!(text.starts_with(&new[..span.start]) && new.ends_with(&text[span.end..]));
                count += 1;
            }
        }
        assert!(count > 1000, "{count}");
    }

    /// An entry that is removed takes no other with it, and every line that stays is as it was.
    #[test]
    fn what_is_removed_is_alone() {
        for (_, name, text) in budgets() {
            let places = Places::of(&text).expect("TOML");
            let mut entries: Vec<Vec<Step>> = places
                .scalars()
                .into_iter()
                .map(|(path, _)| path[..path.len().min(2)].to_vec())
                .collect();
            entries.dedup();
            for entry in entries.iter().take(40) {
                let new = places.remove(entry).expect(&name);
                let lines: Vec<&str> = text.lines().collect();
                let mut left = lines.iter();
                let is_elsewhere = entry.len() > 1 && places.value(&entry[..1]).is_some()
                    || entry.iter().any(|step| matches!(step, Step::Index(_)));
                assert!(
                    is_elsewhere || new.lines().all(|line| left.any(|one| *one == line)),
                    "{name} {entry:?}"
                );
                let parent = &entry[..entry.len() - 1];
                let mut wanted = tree(&text);
                match (at(&mut wanted, parent), entry.last()) {
                    (toml::Value::Table(table), Some(Step::Key(key))) => drop(table.remove(key)),
                    (toml::Value::Array(list), Some(Step::Index(at))) => drop(list.remove(*at)),
                    _ => panic!("{entry:?}"),
                }
                // Without a header of its own, a table goes with the last that it held.
                let mut without = wanted.clone();
                if let (toml::Value::Table(top), [Step::Key(parent)]) = (&mut without, parent) {
                    let text = top.get(parent).map(ToString::to_string);
                    if text.is_some_and(|text| ["", "[]", "{}"].contains(&text.trim())) {
                        top.remove(parent);
                    }
                }
                let found = tree(&new);
                assert!(found == wanted || found == without, "{name} {entry:?}");
            }
        }
    }

    /// Rows of every budget in each other's place: the order of the inputs changes, and no figure; back again it is the same text.
    #[test]
    fn rows_are_moved_and_moved_back() {
        let mut count = 0;
        for (root, name, text) in budgets() {
            let entries = &view(&text)["entries"]["keys"];
            let rows = entries.as_array().into_iter().flatten();
            let inputs = rows.filter(|entry| entry[0] == "input");
            let inputs: Vec<&str> = inputs
                .flat_map(|entry| entry[1]["keys"].as_array().into_iter().flatten())
                .filter_map(|row| row[0].as_str())
                .collect();
            for pair in inputs.windows(2) {
                let [one, other] = [pair[0], pair[1]].map(|row| vec![key("input"), key(row)]);
                let edit = |path: &[Step], with: &[Step]| {
                    let (path, with) = (path.to_vec(), with.to_vec());
                    [Edit::Exchange { path, with }]
                };
                let moved = edited(&text, &edit(&one, &other));
                let moved = moved.unwrap_or_else(|why| panic!("{name} {pair:?}: {why}"));
                assert_ne!(moved, text);
                assert_eq!(
                    edited(&moved, &edit(&one, &other)),
                    Ok(text.clone()),
                    "{name}"
                );
                if count % 40 == 0 {
                    let [moved, own] = [&moved, &text].map(|text| figures(&root, &name, text));
                    let number = |bits: u64| f64::from_bits(bits);
                    let alike = |a: u64, b: u64| {
                        let (a, b) = (number(a), number(b));
                        // Sums in another order.
                        a.to_bits() == b.to_bits() || (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
                    };
                    let both = moved.iter().zip(&own);
                    let same = |((y, u), (own_y, own_u)): (&(u64, u64), &(u64, u64))| {
                        alike(*y, *own_y) && alike(*u, *own_u)
                    };
                    assert!(
                        moved.len() == own.len() && both.into_iter().all(same),
                        "{name}"
                    );
                }
                count += 1;
            }
        }
        assert!(count > 100, "{count}");
    }

    /// A value that is added and removed again leaves the text as it was.
    #[test]
    fn what_was_added_can_be_removed() {
        for (_, name, text) in budgets() {
            let places = Places::of(&text).expect("TOML");
            let inputs = tree(&text)
                .get("input")
                .and_then(toml::Value::as_table)
                .cloned();
            let added: Vec<Vec<Step>> = inputs
                .iter()
                .flat_map(|table| table.keys())
                .map(|input| [path("input"), vec![key(input), key("added")]].concat())
                .chain([path("added"), path("input.added")])
                .collect();
            for entry in added {
                let content = if entry == path("input.added") {
                    Content::Table(Vec::new())
                } else {
                    Content::Token("'x'".into())
                };
                // An input may be a number by itself.
                let Ok(new) = places.set(&entry, content) else {
                    continue;
                };
                let back = Places::of(&new).expect("TOML").remove(&entry).expect(&name);
                let solid = |text: &str| {
                    text.lines()
                        .filter(|line| !line.is_empty())
                        .map(str::to_owned)
                        .collect::<Vec<_>>()
                };
                assert_eq!(solid(&back), solid(&text), "{name} {entry:?}");
            }
        }
    }

    fn figures(root: &Path, name: &str, text: &str) -> Vec<(u64, u64)> {
        let instead = [(name, text.as_bytes())];
        let folder = Folder {
            root,
            instead: &instead,
        };
        let loaded = budget::load_from(Files::Folder(&folder), Path::new(name), None);
        let loaded = loaded.unwrap_or_else(|faults| {
            panic!(
                "{}",
                faults.render_in(gumption_fault::language::Language::English, false)
            )
        });
        let options = Options {
            monte_carlo: MonteCarloChoice::Off,
            ..Options::default()
        };
        let row = loaded.rows.first().expect("a row");
        let found = evaluate(&row.budget, &options).expect("a result");
        let bits = found.results.iter().map(|one| {
            (
                one.gum.estimate.to_bits(),
                one.gum.coverage.expanded.to_bits(),
            )
        });
        bits.collect()
    }

    /// Names mean nothing: with every input of every budget renamed, every result is the same to the last bit.
    #[test]
    fn a_quantity_is_renamed_wherever_it_is_named() {
        let mut count = 0;
        for (root, name, text) in budgets() {
            let Some(inputs) = tree(&text)
                .get("input")
                .and_then(toml::Value::as_table)
                .cloned()
            else {
                continue;
            };
            let edits: Vec<Edit> = inputs
                .keys()
                .enumerate()
                .map(|(at, input)| Edit::Rename {
                    path: vec![key("input"), key(input)],
                    name: format!("renamed_{at}"),
                })
                .collect();
            let new = edited(&text, &edits).unwrap_or_else(|why| panic!("{name}: {why}"));
            assert_eq!(new.lines().count(), text.lines().count());
            assert_eq!(
                figures(&root, &name, &new),
                figures(&root, &name, &text),
                "{name}"
            );
            count += edits.len();
        }
        assert!(count > 100, "{count}");
    }

    #[test]
    fn a_name_that_is_taken_or_none_is_refused() {
        let text =
            "[measurand.Y]\nmodel = \"a * z(1)\"\n[input]\na = { value = 1 }\nb = { value = 2 }\n";
        for name in ["b", "Y", "z", "2a", "a b", ""] {
            let edit = Edit::Rename {
                path: path("input.a"),
                name: name.into(),
            };
            assert!(edited(text, &[edit]).is_err(), "{name}");
        }
    }

    /// Numbers stay as they were typed; the schema says what is a list, a text or a word.
    #[test]
    fn what_is_typed_is_written_by_the_schema() {
        let text = "[input.x]\n";
        for (at, said, written) in [
            ("input.x.value", "1.00010", "value = 1.00010"),
            ("input.x.value", "23 °C", "value = \"23 °C\""),
            ("input.x.unit", "1", "unit = \"1\""),
            ("input.x.readings", "1.0, 2.50", "readings = [1.0, 2.50]"),
            (
                "input.x.readings",
                "1.0 2.50\n3",
                "readings = [1.0, 2.50, 3]",
            ),
            ("input.x.relative", "true", "relative = true"),
            ("input.x.u", "0,5", "u = \"0,5\""),
            ("input.x.u", "1, 2.0", "u = [1, 2.0]"),
            (
                "input.x.readings",
                "1,5 2,5",
                "readings = [\"1,5\", \"2,5\"]",
            ),
            ("input.x.dof", "inf", "dof = inf"),
            ("input.x.dof", "many", "dof = \"many\""),
            (
                "input.x.limits",
                "1 mm, 2 mm",
                "limits = [\"1 mm\", \"2 mm\"]",
            ),
            ("input.x.certificate.U", "0.5", "certificate = { U = 0.5 }"),
        ] {
            assert_eq!(
                typed(text, at, said),
                format!("[input.x]\n{written}\n"),
                "{at}"
            );
        }
        assert_eq!(
            typed("", "correlation.0.between", "a, b"),
            "[[correlation]]\nbetween = [\"a\", \"b\"]\n"
        );
        assert_eq!(
            typed("", "measurand.Y.model", "a = 1\na \"x\"\n"),
            "[measurand.Y]\nmodel = \"\"\"\na = 1\na \\\"x\\\"\n\"\"\"\n"
        );
        assert_eq!(
            typed("recording = 'r.csv'\n", "columns.x.unit", "V"),
            "recording = 'r.csv'\n\n[columns.x]\nunit = \"V\"\n"
        );
    }

    #[test]
    fn entries_are_shown_with_their_places() {
        let text =
            "title = 'µ'\n[input]\nx = { u = 1.0, readings = [1] }\n[[correlation]]\nr = 1\n";
        let view = view(text);
        let entries = &view["entries"]["keys"];
        assert_eq!(
            entries[0],
            json!(["title", { "text": "µ", "place": [0, 11] }])
        );
        let x = &entries[1][1]["keys"][0][1];
        assert_eq!(
            x["keys"][0],
            json!(["u", { "text": "1.0", "place": [26, 33] }])
        );
        assert_eq!(entries[2][1]["items"][0]["keys"][0][0], "r");
        assert_eq!(self::view("a = "), Value::Null);
    }
}
