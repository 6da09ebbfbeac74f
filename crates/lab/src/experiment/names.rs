//! What the names in the equations are.

use std::collections::BTreeMap;
use std::ops::Range;

use super::checker::Checker;
use super::entries::RoleWord;
use super::faults::{NAME_TWICE, UNKNOWN_SYMBOL};
use super::purpose::Purpose;
use super::source::entries;
use gumption_core::model::outline;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;
use gumption_format::toml::StringMap;

/// What a name is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A column of the points, or a quantity that positions give.
    Column,
    Parameter,
    Input,
    Constant,
}

/// The names of the equations.
pub(crate) struct Names {
    /// In their order, so that of suggestions as good as each other the same comes first.
    kinds: BTreeMap<String, Kind>,
    /// Columns of numbers that the points must have, each where it stands first.
    pub columns: Vec<(String, Range<usize>)>,
    /// Names on left sides, in the order of the equations.
    pub responses: Vec<String>,
    /// Where they stand.
    lefts: Vec<Range<usize>>,
    /// Those of them that no right side needs: a plan does without them.
    pub only_left: Vec<String>,
    /// Columns that only omitted terms need.
    pub optional: Vec<String>,
    /// Quantities that positions give.
    pub given: Vec<String>,
    /// Names that right sides need.
    needed: Vec<String>,
}

impl Names {
    /// Reads the equations; `None` if one is not well formed, or names are in doubt.
    pub fn of(checker: &mut Checker<'_>) -> Option<Names> {
        let before = checker.faults.len();
        let mut names = Names {
            kinds: declared(checker),
            columns: Vec::new(),
            responses: Vec::new(),
            lefts: Vec::new(),
            only_left: Vec::new(),
            optional: Vec::new(),
            given: checker.given(),
            needed: Vec::new(),
        };
        let table = &checker.source.table;
        let mut needs: Vec<(String, Range<usize>)> = Vec::new();
        let mut own: Vec<String> = Vec::new();
        if let Some(model) = &table.model {
            let outlined = checker.outlined(model)?;
            own.extend(outlined.defines);
            own.extend(outlined.gives.map(|(name, _)| name));
            needs.extend(outlined.needs);
        }
        for text in table.equations.iter().flat_map(|list| &list.value.0) {
            let Some(outlined) = checker.outlined(text) else {
                continue;
            };
            let (gives, needed) = (outlined.gives, outlined.needs);
            if let Some((given, place)) = &gives {
                let mut again = needed.iter().filter(|(name, _)| name == given);
                if let Some((_, place)) = again.next() {
                    checker.faults.push(both_sides(given, place));
                }
                names.responses.push(given.clone());
                names.lefts.push(place.clone());
            }
            needs.extend(needed.into_iter().filter(|(name, _)| !own.contains(name)));
            needs.extend(gives);
        }
        if checker.faults.len() > before {
            return None;
        }
        let right: Vec<String> = needs.iter().map(|(name, _)| name.clone()).collect();
        names.needed.clone_from(&right);
        for (name, place) in needs {
            if names.kinds.contains_key(&name) && names.kind(&name) != Some(Kind::Column) {
                continue;
            }
            names.kinds.insert(name.clone(), Kind::Column);
            let known = names.columns.iter().any(|(other, _)| *other == name);
            if !known && !names.given.contains(&name) {
                names.columns.push((name, place));
            }
        }
        names.only_left = names
            .responses
            .iter()
            .filter(|name| right.iter().filter(|other| other == name).count() == 1)
            .cloned()
            .collect();
        names.optional = checker.optional(&names, &own);
        for name in &names.optional {
            names.kinds.insert(name.clone(), Kind::Column);
        }
        if checker.purpose == Purpose::Plan {
            let left = names.only_left.clone();
            names.columns.retain(|(name, _)| !left.contains(name));
        }
        Some(names)
    }

    /// What a name is.
    pub fn kind(&self, name: &str) -> Option<Kind> {
        self.kinds.get(name).copied()
    }

    /// Whether an equation gives it.
    pub fn is_left(&self, name: &str) -> bool {
        self.responses.iter().any(|response| response == name)
    }

    /// What a column is by its place in the equations.
    pub fn role(&self, name: &str) -> RoleWord {
        if self.is_left(name) {
            RoleWord::Output
        } else if self.needed.iter().any(|needed| needed == name) {
            RoleWord::Stimulus
        } else {
            RoleWord::Covariate
        }
    }

    /// Whether a right side needs it.
    pub fn is_needed(&self, name: &str) -> bool {
        self.needed.iter().any(|needed| needed == name)
    }

    /// Its place in the order in which the equations name things.
    pub fn place(&self, name: &str) -> usize {
        let place = self.needed.iter().position(|needed| needed == name);
        place.unwrap_or(self.needed.len())
    }

    /// Where it stands on the left of an equation.
    pub fn place_of_left(&self, name: &str) -> Range<usize> {
        let lefts = self.responses.iter().zip(&self.lefts);
        let mut own = lefts.filter(|(response, _)| *response == name);
        own.next().map_or(0..0, |(_, place)| place.clone())
    }

    /// All names that stand for something, for suggestions.
    pub fn known(&self) -> impl Iterator<Item = &str> {
        self.kinds.keys().map(String::as_str)
    }
}

fn both_sides(name: &str, place: &Range<usize>) -> Fault {
    let message = say!("{name} is on both sides of an equation");
    Fault::new(UNKNOWN_SYMBOL, place.clone(), message)
        .label(say!("expected columns, parameters, inputs and constants"))
}

/// An error of what a column holds, stated as if the column were an input.
fn column_as_input(name: &str, place: &Range<usize>, column: &Range<usize>) -> Fault {
    Fault::new(
        NAME_TWICE,
        place.clone(),
        say!("{name} is a column, and no input"),
    )
    .label(say!("used again here"))
    .related(column.clone(), say!("first used here"))
    .help(say!(
        "an error that all points share is an input of its own, e_{name}, with {name}*(1 + e_{name}) or {name} + e_{name} in the equation; one of each reading is [reading.{name}]"
    ))
}

/// What the file declares.
fn declared(checker: &mut Checker<'_>) -> BTreeMap<String, Kind> {
    let table = &checker.source.table;
    let mut kinds: BTreeMap<String, (Kind, Range<usize>)> = BTreeMap::new();
    let mut faults = Vec::new();
    let mut declare = |name: &str, kind: Kind, place: &Range<usize>| {
        let before = kinds.get(name).map(|(kind, place)| (*kind, place.clone()));
        let allowed = matches!(
            (before.as_ref().map(|b| b.0), kind),
            (None, _) | (Some(Kind::Parameter), Kind::Input)
        );
        if let Some((_, first)) = before.filter(|_| !allowed) {
            faults.push(
                Fault::new(
                    NAME_TWICE,
                    place.clone(),
                    say!("the name {name} is used twice"),
                )
                .label(say!("used again here"))
                .related(first, say!("first used here"))
                .help(say!("choose another name for one of them")),
            );
        } else {
            kinds
                .entry(name.to_owned())
                .or_insert_with(|| (kind, place.clone()));
        }
    };
    for (name, entry) in entries(&table.parameter) {
        declare(name, Kind::Parameter, &entry.key);
    }
    for (name, entry) in entries(&table.input) {
        let replaced = entries(&table.constant)
            .iter()
            .any(|(other, _)| other == name);
        if !(replaced && checker.source.is_base(&entry.key)) {
            declare(name, Kind::Input, &entry.key);
        }
    }
    for (name, entry) in entries(&table.constant) {
        declare(name, Kind::Constant, &entry.key);
    }
    for (name, place) in checker.given_places() {
        declare(&name, Kind::Column, &place);
    }
    checker.faults.extend(faults);
    let columns = entries(&table.columns);
    let inputs = entries(&table.input).iter();
    let of_columns = inputs.filter_map(|(name, entry)| {
        let (_, column) = columns.iter().find(|(column, _)| column == name)?;
        Some(column_as_input(name, &entry.key, &column.key))
    });
    checker.faults.extend(of_columns.collect::<Vec<Fault>>());
    kinds
        .into_iter()
        .map(|(name, (kind, _))| (name, kind))
        .collect()
}

/// What a text says, names with their places.
struct Outlined {
    /// Names of statements before the last.
    defines: Vec<String>,
    /// What the last gives.
    gives: Option<(String, Range<usize>)>,
    needs: Vec<(String, Range<usize>)>,
}

impl Checker<'_> {
    fn outlined(&mut self, text: &Stated<String>) -> Option<Outlined> {
        let map = StringMap::new(&self.source.text, text.span.clone())
            .filter(|map| map.text() == text.value);
        let place = |range: Range<usize>| match &map {
            Some(map) => map.place(range),
            None => text.span.clone(),
        };
        match outline(&text.value, &self.units) {
            Ok(outline) => {
                let defined = outline.printed.lines().filter_map(|line| {
                    let (left, _) = line.split_once(" = ")?;
                    Some(left.split('(').next().unwrap_or(left).to_owned())
                });
                let mut defines: Vec<String> = defined.collect();
                let placed = |(name, span)| (name, place(span));
                let given = outline.gives.map(placed);
                // A function on the left is told as what was given.
                let given = given.or_else(|| Some((defines.last()?.clone(), text.span.clone())));
                defines.retain(|name| given.as_ref().is_none_or(|(given, _)| given != name));
                Some(Outlined {
                    defines,
                    gives: given,
                    needs: outline.needs.into_iter().map(placed).collect(),
                })
            }
            Err(faults) => {
                let faults = match self.name_with_blank(&text.value) {
                    Some(fault) => vec![fault],
                    None => faults,
                };
                let faults: Vec<Fault> = faults.into_iter().map(|f| f.moved(place)).collect();
                self.faults.extend(faults);
                None
            }
        }
    }

    /// What is wrong with an equation that uses the name of a column as it stands in a table, with a blank; at its place in the equation.
    fn name_with_blank(&self, equation: &str) -> Option<Fault> {
        let columns = entries(&self.source.table.columns).iter();
        let declared = columns.map(|(name, _)| name.as_str());
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == ' ';
        let left = equation.split_once('=').map(|(left, _)| left.trim());
        let left = left.filter(|left| left.chars().all(is_word));
        let mut names = declared.chain(left).filter(|name| name.contains(' '));
        let (name, at) = names.find_map(|name| Some((name, equation.find(name)?)))?;
        let joined = name.replace(' ', "_");
        let message = say!("a name in an equation has no blank: `{name}`");
        Some(
            Fault::new(UNKNOWN_SYMBOL, at..at + name.len(), message)
                .label(say!("two words"))
                .help(say!(
                    "write {joined}, and below [columns] which column it is: {joined} = {{ column = \"{name}\" }}"
                )),
        )
    }

    /// Names that only omitted terms need.
    fn optional(&self, names: &Names, own: &[String]) -> Vec<String> {
        let mut optional = Vec::new();
        for (name, entry) in entries(&self.source.table.omitted) {
            let term = entry.value.term.as_ref();
            let Some(outline) = term.and_then(|term| outline(&term.value, &self.units).ok()) else {
                continue;
            };
            let needs = outline.needs.into_iter().map(|(need, _)| need);
            let new = needs.filter(|need| need != name && !own.contains(need));
            optional.extend(new.filter(|need| names.kind(need).is_none()));
        }
        optional.dedup();
        optional
    }

    /// Quantities that positions give.
    pub(crate) fn given(&self) -> Vec<String> {
        self.given_places()
            .into_iter()
            .map(|(name, _)| name)
            .collect()
    }

    fn given_places(&self) -> Vec<(String, Range<usize>)> {
        let positions = self.source.table.positions.as_ref();
        let gives = positions.and_then(|stated| stated.value.gives.as_ref());
        let list = gives.iter().flat_map(|gives| &gives.value);
        list.map(|name| (name.value.clone(), name.span.clone()))
            .collect()
    }
}
