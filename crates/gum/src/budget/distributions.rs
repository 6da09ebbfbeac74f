//! `distribution = …`: the name of a shape for another way, or a distribution with all of its parameters.
//!
//! What there is to name and to state comes from the registry of the distributions.

use std::ops::Range;

use serde_json::{Map, Value, json};
use toml::de::DeValue;

use gumption_core::distribution::stating::{
    Given, ParameterError, ParameterRule, Parametric, Takes, Word,
};
use gumption_core::distribution::{Distribution, Entry, REGISTRY, kind_named};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::faults::{UNKNOWN_KEY, UNKNOWN_WORD, WRONG_TYPE};
use gumption_format::toml::{
    Dof, FromToml, Key, KeyRow, Raw, Reader, Stated, described, in_order, inner, unknown_word,
};

use super::faults::{DISTRIBUTION, MISSING_KEY, TWO_WAYS};

/// What `distribution` is set to.
#[derive(Debug, Clone)]
pub enum DistributionEntry {
    /// A shape whose width another way states.
    Shape(&'static Entry),
    /// Distributions with parameters; exactly one of them, unless the file is mistaken.
    Full(Vec<StatedDistribution>),
}

/// A distribution that a file states with its parameters.
#[derive(Debug, Clone)]
pub struct StatedDistribution {
    entry: &'static Entry,
    key: Range<usize>,
    given: Given,
    /// The parameters, with the places of their keys and of their values.
    places: Vec<(&'static str, Range<usize>, Range<usize>)>,
}

/// The distribution that a table states.
///
/// # Errors
/// Parameters are missing or not allowed; not exactly one distribution.
pub fn parametric(
    stated: &[StatedDistribution],
    place: &Stated<()>,
) -> Result<Parametric<Distribution>, Box<Fault>> {
    match stated {
        [one] => one
            .entry
            .stated(&one.given)
            .map_err(|error| Box::new(one.fault(&error, place))),
        [] => Err(Box::new(
            Fault::new(
                MISSING_KEY,
                place.span.clone(),
                say!("no distribution is named"),
            )
            .help(say!(
                "write for example distribution = {{ uniform = {{ half_width = 0.5 }} }}"
            )),
        )),
        [first, second, ..] => Err(Box::new(
            Fault::new(
                TWO_WAYS,
                second.key.clone(),
                say!(
                    "two distributions, {} and {}",
                    first.entry.kind.key,
                    second.entry.kind.key
                ),
            )
            .label(say!("second distribution"))
            .related(first.key.clone(), say!("first distribution"))
            .help(say!(
                "keep one; two reasons for doubt are two entries of `components`"
            )),
        )),
    }
}

impl StatedDistribution {
    /// The place of a parameter's key and that of its value.
    fn places(&self, key: &str) -> Option<(Range<usize>, Range<usize>)> {
        let mut places = self.places.iter();
        let found = places.find(|(name, ..)| *name == key);
        found.map(|(_, key, value)| (key.clone(), value.clone()))
    }

    fn fault(&self, error: &ParameterError, place: &Stated<()>) -> Fault {
        let name = self.entry.kind.key;
        let here = || place.span.clone();
        match error {
            ParameterError::Missing { key } => {
                Fault::new(MISSING_KEY, here(), say!("{name} needs `{key}`"))
                    .label(say!("`{key}` is missing"))
            }
            ParameterError::NoLimits => {
                Fault::new(MISSING_KEY, here(), say!("{name} needs its limits"))
                    .label(say!("limits are missing"))
                    .help(say!("write `lower` and `upper`, or `half_width`"))
            }
            ParameterError::TwoWidths { key } => {
                let [half_width, limit] = ["half_width", key]
                    .map(|key| self.places(key).map_or_else(here, |(key, _)| key));
                Fault::new(TWO_WAYS, half_width, say!("{name} has two widths"))
                    .label(say!("half-width stated here"))
                    .related(limit, say!("limit stated here"))
                    .help(say!("leave out one"))
            }
            ParameterError::NotAllowed { key, value, must } => {
                let value_place = self.places(key).map_or_else(here, |(_, value)| value);
                let message = say!("`{key}` of {name} is {value}");
                Fault::new(DISTRIBUTION, value_place, message).label(say!("must be {must}"))
            }
            ParameterError::Descending { lower, upper } => {
                let message = say!("the limits of {name} are {lower} and {upper}");
                Fault::new(DISTRIBUTION, here(), message)
                    .help(say!("`lower` must be less than `upper`"))
            }
            ParameterError::Unusable { message, help } => {
                Fault::new(DISTRIBUTION, here(), message.clone()).help(help.clone())
            }
            other => Fault::new(DISTRIBUTION, here(), other.said()),
        }
    }

    fn read(
        entry: &'static Entry,
        key: Range<usize>,
        value: &Raw<'_>,
        reader: &mut Reader<'_>,
    ) -> Option<Self> {
        let DeValue::Table(table) = value.get_ref() else {
            return reader.wrong_type(WRONG_TYPE, value, say!("a table"));
        };
        let mut stated = StatedDistribution {
            entry,
            key,
            given: Given::default(),
            places: Vec::new(),
        };
        for (key, value) in in_order(table) {
            let name = key.get_ref();
            match entry
                .parameters
                .iter()
                .find(|rule| rule.key == name.as_ref())
            {
                Some(rule) => stated.take(rule, key, value, reader),
                None => {
                    let known: Vec<&'static str> =
                        entry.parameters.iter().map(|rule| rule.key).collect();
                    reader.unknown_key(key, entry.kind.key, &known);
                }
            }
        }
        Some(stated)
    }

    fn take(
        &mut self,
        rule: &'static ParameterRule,
        key: &Key<'_>,
        value: &Raw<'_>,
        reader: &mut Reader<'_>,
    ) {
        self.places.push((rule.key, key.span(), value.span()));
        match rule.takes {
            Takes::Number | Takes::Freedom => {
                let number = match rule.takes {
                    Takes::Freedom => Dof::read(value, reader).map(|dof| dof.0),
                    _ => f64::read(value, reader),
                };
                self.given.numbers.extend(number.map(|x| (rule.key, x)));
            }
            Takes::Numbers => {
                let list = Vec::<Stated<f64>>::read(value, reader);
                let list = list.map(|list| list.into_iter().map(|x| x.value).collect());
                self.given.lists.extend(list.map(|list| (rule.key, list)));
            }
        }
    }
}

/// Schema of a parameter, and what it may be set to in words.
fn expected(takes: Takes) -> (Value, Said) {
    match takes {
        Takes::Number => (f64::schema(), f64::expected()),
        Takes::Freedom => (Dof::schema(), Dof::expected()),
        Takes::Numbers => (Vec::<Stated<f64>>::schema(), Vec::<Stated<f64>>::expected()),
    }
}

/// A shape by any of its names, in any case.
fn shape(text: &str, value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<&'static Entry> {
    let Some(kind) = kind_named(text) else {
        let known: Vec<&'static str> = shape_names().collect();
        if let Some(help) = none_of_them(text) {
            let fault = Fault::new(
                UNKNOWN_WORD,
                value.span(),
                say!("`{text}` is not known here"),
            );
            return reader.refuse(fault.label(say!("no distribution of the list")).help(help));
        }
        let words = shapes().map(|shape| format!("\"{}\"", shape.kind.key));
        let expected = say!("one of {}", words.collect::<Vec<_>>().join(", "));
        return reader.refuse(unknown_word(value, text, &known, expected, reader.hints));
    };
    shapes().find(|entry| entry.kind.key == kind.key).or_else(|| {
        reader.refuse(
            Fault::new(
                UNKNOWN_WORD,
                value.span(),
                say!("the {} distribution needs its parameters", kind.name_en),
            )
            .label(say!("a name alone does not fix it"))
            .help(say!(
                "state it with its parameters, without `u` or `half_width`; `gumption explain {}` shows them",
                kind.key
            )),
        )
    })
}

/// What to state for a distribution between limits that handbooks have and this list has not; u follows from its variance.
fn none_of_them(text: &str) -> Option<Said> {
    match text.to_lowercase().trim_end_matches(" distribution") {
        "cosine" | "raised cosine" | "raised-cosine" | "raised_cosine" | "余弦" | "余弦分布" => {
            Some(say!(
                "a cosine distribution between ±a has the standard deviation 0.362 a: state it as `u`; what swings between its limits as a sine is `arcsine`"
            ))
        }
        "quadratic" | "parabolic" | "二次" | "抛物线" => Some(say!(
            "a quadratic distribution between ±a has the standard deviation a/√5: state it as `u`"
        )),
        _ => None,
    }
}

/// The distributions whose name goes beside a width.
fn shapes() -> impl Iterator<Item = &'static Entry> {
    REGISTRY.iter().filter(|entry| entry.word != Word::None)
}

/// Their names as a file spells them.
fn shape_names() -> impl Iterator<Item = &'static str> {
    shapes()
        .flat_map(|entry| std::iter::once(entry.kind.key).chain(entry.kind.aliases.iter().copied()))
}

/// The distributions that have parameters to state.
fn with_parameters() -> impl Iterator<Item = &'static Entry> {
    REGISTRY.iter().filter(|entry| !entry.parameters.is_empty())
}

/// `Normal (Gaussian): mean, sd.`
fn summary(entry: &Entry) -> String {
    let name = entry.kind.name_en;
    let (first, rest) = name.split_at(name.chars().next().map_or(0, char::len_utf8));
    format!(
        "{}{rest}: {}.",
        first.to_uppercase(),
        entry.parameters_in_words()
    )
}

/// The fault of a key that names no distribution of the file format.
fn other_name(key: &Key<'_>, reader: &mut Reader<'_>) {
    let name = key.get_ref();
    match Entry::named(name).filter(|entry| !entry.parameters.is_empty()) {
        Some(entry) => reader.faults.push(
            Fault::new(
                UNKNOWN_KEY,
                key.span(),
                say!("a distribution with parameters has no key `{name}`"),
            )
            .label(say!("unknown key"))
            .help(say!("write `{}`", entry.kind.key)),
        ),
        None => {
            let known: Vec<&'static str> = with_parameters().map(|entry| entry.kind.key).collect();
            reader.unknown_key(key, "distribution", &known);
        }
    }
}

impl FromToml for DistributionEntry {
    fn expected() -> Said {
        say!("the name of a shape, or {{ NAME = {{ parameters }} }}")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(text) => shape(text, value, reader).map(DistributionEntry::Shape),
            DeValue::Table(table) => {
                let before = reader.faults.len();
                let mut stated = Vec::new();
                for (key, value) in in_order(table) {
                    let mut entries = with_parameters();
                    match entries.find(|entry| entry.kind.key == key.get_ref().as_ref()) {
                        Some(entry) => {
                            stated.extend(StatedDistribution::read(
                                entry,
                                key.span(),
                                value,
                                reader,
                            ));
                        }
                        None => other_name(key, reader),
                    }
                }
                let refused = reader.faults.len() > before;
                (!refused).then_some(DistributionEntry::Full(stated))
            }
            _ => reader.wrong_type(WRONG_TYPE, value, Self::expected()),
        }
    }

    fn schema() -> Value {
        let names: Vec<&str> = shape_names().collect();
        let mut distributions = Map::new();
        for entry in with_parameters() {
            let mut parameters = Map::new();
            for rule in entry.parameters {
                let schema = described(expected(rule.takes).0, rule.meaning.to_string());
                parameters.insert(rule.key.into(), schema);
            }
            let table = json!({
                "type": "object",
                "description": summary(entry),
                "properties": parameters,
                "additionalProperties": false,
            });
            distributions.insert(entry.kind.key.into(), table);
        }
        let table = json!({
            "type": "object",
            "description": "A distribution by name, with its parameters in the unit of the input.",
            "properties": distributions,
            "additionalProperties": false,
        });
        json!({ "oneOf": [{ "enum": names }, table] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        let row = |table: &str, key, kind: Said, doc: String| KeyRow {
            table: table.to_string(),
            key,
            kind,
            doc,
        };
        for entry in with_parameters() {
            rows.push(row(path, entry.kind.key, say!("a table"), summary(entry)));
        }
        for entry in with_parameters() {
            let path = inner(path, entry.kind.key);
            for rule in entry.parameters {
                let kind = expected(rule.takes).1;
                rows.push(row(&path, rule.key, kind, rule.meaning.to_string()));
            }
        }
    }
}
