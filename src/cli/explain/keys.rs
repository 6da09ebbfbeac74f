//! The keys of the files that users write, table by table.

use gumption::budget::KeyRow;
use gumption::fault::catalogue::told;
use gumption::fault::{Between, Said, say};
use gumption::language::Language;

use super::topic::{Section, Topic};

/// Tables in the order in which a reader meets them, by the first part of their path.
const ORDER: [&str; 21] = [
    "",
    "recording",
    "columns",
    "positions",
    "parameter",
    "measurand",
    "input",
    "component",
    "source",
    "constant",
    "correlation",
    "joint",
    "series",
    "claim",
    "conventions",
    "monte_carlo",
    "laboratory",
    "customer",
    "item[]",
    "person[]",
    "condition[]",
];

/// A table of the file, or several that take the same keys.
pub(super) struct KeyTable {
    /// Paths: `component.certificate`.
    paths: Vec<String>,
    pub(super) rows: Vec<KeyRow>,
}

impl KeyTable {
    /// Where it stands, in words: `certificate` of a component.
    pub(super) fn place(&self) -> Said {
        let parent = self.paths.first().map_or("", |path| split(path).0);
        if parent.is_empty() || self.paths.len() == 1 {
            return Said::row(Between::Comma, self.paths.iter().map(|path| in_words(path)));
        }
        let inner = self.paths.iter().map(|path| quoted(split(path).1));
        say!(
            "{inner} of {}",
            in_words(parent),
            inner = Said::row(Between::Comma, inner)
        )
    }

    /// Whether its keys are those of a component.
    pub(super) fn is_component(&self) -> bool {
        self.paths[..] == ["component"]
    }

    /// Whether its keys are names of distributions, which are topics of their own.
    fn names_distributions(&self) -> bool {
        self.paths.iter().any(|path| path.ends_with("distribution"))
    }
}

fn in_words(path: &str) -> Said {
    match (path, split(path)) {
        ("", _) => say!("the top of the file"),
        ("component", _) => say!("a component"),
        ("correlation" | "joint" | "action" | "left_out", _) => say!("`[[{path}]]`"),
        (list, ("", _)) if list.ends_with("[]") => {
            say!("`[[{path}]]`", path = list.trim_end_matches("[]"))
        }
        (_, ("", _)) => say!("`[{path}]`"),
        (_, (parent, inner)) => say!("{inner} of {}", in_words(parent), inner = quoted(inner)),
    }
}

fn quoted(name: &str) -> String {
    format!("`{name}`")
}

/// The table around it, and its own name; a name that the user chooses belongs to the latter.
fn split(path: &str) -> (&str, &str) {
    let own = path.strip_suffix(".NAME").unwrap_or(path);
    match own.rfind('.') {
        Some(dot) => (&path[..dot], &path[dot + 1..]),
        None => ("", path),
    }
}

/// Every table of a file once. Components are described once, although their keys stand in
/// inputs and sources as well.
pub(super) fn tables(rows: Vec<KeyRow>) -> Vec<KeyTable> {
    let component: Vec<&str> = rows
        .iter()
        .filter(|row| row.table == "input.NAME.components[]")
        .map(|row| row.key)
        .collect();
    let mut tables: Vec<KeyTable> = Vec::new();
    for row in rows {
        let path = path(&row, &component);
        match tables.iter_mut().find(|table| table.paths[0] == path) {
            Some(table) if table.rows.iter().any(|known| known.key == row.key) => {}
            Some(table) => table.rows.push(row),
            None => tables.push(KeyTable {
                paths: vec![path],
                rows: vec![row],
            }),
        }
    }
    let order = |table: &KeyTable| {
        let first = table.paths[0].split('.').next();
        ORDER.iter().position(|known| Some(*known) == first)
    };
    tables.sort_by_key(|table| order(table).unwrap_or(ORDER.len()));
    alike_joined(tables)
}

/// Where a key is described.
fn path(row: &KeyRow, component: &[&str]) -> String {
    for owner in ["input.NAME", "source.NAME"] {
        let Some(rest) = row.table.strip_prefix(owner) else {
            continue;
        };
        return match rest.strip_prefix(".components[]").unwrap_or(rest) {
            "" if rest.is_empty() && !component.contains(&row.key) => owner.to_string(),
            inner => format!("component{inner}"),
        };
    }
    row.table.clone()
}

/// Tables of one parent that take the same keys become one.
fn alike_joined(tables: Vec<KeyTable>) -> Vec<KeyTable> {
    let mut joined: Vec<KeyTable> = Vec::new();
    for table in tables {
        let says = |t: &KeyTable| -> Vec<(&str, String)> {
            t.rows.iter().map(|r| (r.key, r.doc.clone())).collect()
        };
        let like = joined.iter_mut().find(|other| {
            split(&other.paths[0]).0 == split(&table.paths[0]).0 && says(other) == says(&table)
        });
        match like {
            Some(other) if other.paths[0].contains('.') => other.paths.extend(table.paths),
            _ => joined.push(table),
        }
    }
    joined
}

/// What a key says, without the mark of a way to state an uncertainty.
pub(super) fn meaning(doc: &str, lang: Language) -> &str {
    let doc = told(doc, lang);
    doc.strip_prefix(lang.pick("Way: ", "方式："))
        .unwrap_or(doc)
}

/// One topic for each key of a file, with all tables in which it may stand.
pub(super) fn topics(section: Section, rows: Vec<KeyRow>, lang: Language) -> Vec<Topic> {
    let mut topics: Vec<Topic> = Vec::new();
    let tables = tables(rows);
    for table in tables.iter().filter(|t| !t.names_distributions()) {
        let place = table.place();
        for row in &table.rows {
            let way = if row.doc.starts_with("Way") {
                say!(
                    "\n\nIt is one of the ways to state an uncertainty, of which a component has exactly one."
                )
            } else {
                Said::default()
            };
            let at = match (section, table.paths[..] == [""]) {
                (Section::CertificateKeys, true) => {
                    say!("At {place} with the data of a certificate")
                }
                (Section::CertificateKeys, false) => {
                    say!("In {place} of the data of a certificate")
                }
                (Section::ExperimentKeys, true) => say!("At {place} of an experiment"),
                (Section::ExperimentKeys, false) => say!("In {place} of an experiment"),
                (_, true) => say!("At {place}"),
                (_, false) => say!("In {place}"),
            };
            let text = say!(
                "{at}: {} It is set to {}.{way}",
                meaning(&row.doc, lang),
                row.kind
            )
            .in_language(lang);
            match topics.iter_mut().find(|topic| topic.name == row.key) {
                Some(topic) => topic.text = format!("{}\n\n{text}", topic.text),
                None => topics.push(Topic {
                    section,
                    name: row.key.to_string(),
                    aliases: Vec::new(),
                    title: meaning(&row.doc, lang)
                        .trim_end_matches(['.', '。'])
                        .to_string(),
                    text,
                }),
            }
        }
    }
    topics
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption::{budget, experiment, report};

    #[test]
    fn places_are_told_in_words() {
        let keys = [
            budget::keys(),
            experiment::keys(),
            report::certificate_keys(),
        ];
        let tables = keys.map(tables);
        let places: Vec<String> = tables
            .iter()
            .flatten()
            .map(|t| t.place().to_string())
            .collect();
        for place in [
            "the top of the file",
            "`[input.NAME]`",
            "a component",
            "`certificate` of a component",
            "`readings`, `sample` of a component",
            "`[[joint]]`",
            "`[[condition]]`",
            "`[input.NAME]`, `[reading.NAME]`",
            "`[[action]]`",
            "`inputs.NAME` of `[claim]`",
            "`beta` of `distribution` of a component",
        ] {
            assert!(places.iter().any(|p| p == place), "{place} in {places:#?}");
        }
    }

    #[test]
    fn no_key_is_lost() {
        for keys in [budget::keys, experiment::keys, report::certificate_keys] {
            let tables = tables(keys());
            for row in keys() {
                let known = tables
                    .iter()
                    .any(|t| t.rows.iter().any(|r| r.key == row.key && r.doc == row.doc));
                assert!(known, "{} of {}", row.key, row.table);
            }
        }
    }
}
