//! What a procedure asks of a recording and of the user.

use std::collections::BTreeMap;

use gumption_core::quantity::UnitTable;
use gumption_fault::language::Language;
use gumption_fault::say;
use gumption_format::csv::Data;
use gumption_format::toml::writing::{key, quoted};

use super::guess::Guess;
use crate::experiment::entries::RoleWord;
use crate::experiment::procedure::Procedure;

/// The columns that a procedure needs, with those of the recording that may be meant, and what it must be told.
pub(super) fn by_procedure(
    procedure: &Procedure,
    columns: &[Guess<'_>],
    language: Language,
) -> String {
    let description = language.pick("description", "description_zh");
    let base: toml::Table = procedure.text.parse().unwrap_or_default();
    let entries = |table: &str| {
        let entries = base
            .get(table)
            .and_then(toml::Value::as_table)
            .into_iter()
            .flatten();
        let entries =
            entries.filter_map(|(name, entry)| Some((name.clone(), entry.as_table()?.clone())));
        entries.collect::<BTreeMap<String, toml::Table>>()
    };
    let said = |entry: &toml::Table, key: &str| {
        entry
            .get(key)
            .and_then(toml::Value::as_str)
            .unwrap_or_default()
            .to_owned()
    };
    let mut text = format!("procedure = {}\n\n[columns]\n", quoted(procedure.name));
    for (name, entry) in entries("columns") {
        let what = said(&entry, description);
        let same = columns
            .iter()
            .find(|guess| guess.column.name.to_lowercase() == name.to_lowercase());
        let found = same.or_else(|| only(columns, &entry));
        text += &match found {
            Some(guess) if guess.column.name == name => format!("# {name}: {what}\n"),
            Some(guess) => {
                format!(
                    "{} = {{ column = {} }}   # {what}\n",
                    key(&name),
                    quoted(&guess.column.header)
                )
            }
            None => {
                let asked = say!("which column is it? {what}").in_language(language);
                format!("# {} = {{ column = \"…\" }}   # {asked}\n", key(&name))
            }
        };
    }
    for (name, entry) in entries("input") {
        if entry.get("required").and_then(toml::Value::as_bool) == Some(true) {
            let what = said(&entry, description);
            let asked = say!("has to be stated: {what}").in_language(language);
            let unit = quoted(&said(&entry, "unit"));
            text += &format!("\n# [input.{name}]   # {asked}\n# value = …\n# unit = {unit}\n");
        }
    }
    text
}

/// The only column of the dimension that an entry of a procedure must have, or the only one of labels.
fn only<'g, 'r>(columns: &'g [Guess<'r>], entry: &toml::Table) -> Option<&'g Guess<'r>> {
    let word = |key: &str| entry.get(key).and_then(toml::Value::as_str);
    let like = word("like").and_then(|unit| UnitTable::default().parse(unit).ok());
    let fits = |guess: &&Guess<'_>| match (&guess.column.data, &like) {
        (Data::Labels(_), _) => word("holds") == Some("labels"),
        (Data::Numbers(_), Some(like)) => {
            let unit = guess.column.unit.as_ref();
            unit.is_some_and(|unit| unit.conversion_to(like).is_some())
        }
        (Data::Numbers(_), None) => word("holds").is_none() && guess.role == RoleWord::Output,
    };
    let mut fitting = columns.iter().filter(fits);
    let first = fitting.next();
    first.filter(|_| fitting.next().is_none())
}
