//! The model of a budget: where it stands, and what its names say of the rows.

use crate::claim::{Claimed, Row, Understood};

use super::lines::Line;
use super::mapping::Mapping;
use super::{notes, table, words};

pub(super) fn find_model(all: &[&Line], claimed: &mut Claimed, mapping: &Mapping) {
    if let Some(model) = &mapping.model {
        let (left, right) = model.split_once('=').unwrap_or(("y", model));
        claimed.measurand = left.trim().into();
        claimed.model = Some(right.trim().into());
        return;
    }
    let found = all.iter().find_map(|line| {
        let parts = line
            .text
            .split(" ; ")
            .find_map(|part| notes::model(part, claimed));
        parts
            .or_else(|| notes::model(&line.text, claimed))
            .map(|model| (line.at, line.text.clone(), model))
    });
    if let Some((at, text, (left, right))) = found {
        claimed.understood.push(Understood {
            at,
            text,
            role: "model",
        });
        claimed.measurand = left;
        claimed.model = Some(right);
    }
}

/// Rows without a symbol take that word of their name which the model uses.
pub(super) fn symbols_of_model(raw: &mut [table::Raw], claimed: &mut Claimed) {
    for (raw, row) in raw.iter_mut().zip(&mut claimed.rows) {
        if !row.symbol.is_empty() {
            continue;
        }
        let model = claimed.model.clone().unwrap_or_default();
        let in_model = notes::names_of(row).find(|word| words::has_symbol(&model, word));
        // What a bracket says in Chinese words is a remark.
        let chinese = |c: char| ('\u{4e00}'..='\u{9fff}').contains(&c);
        let bracketed = || {
            row.name
                .rsplit_once('(')
                .and_then(|(_, tail)| tail.strip_suffix(')'))
                .filter(|s| s.chars().count() <= 12 && words::may_be_symbol(s))
                .filter(|s| !s.starts_with(chinese))
        };
        let first = || {
            row.name
                .split_once([':', ','])
                .map(|(first, _)| first.trim())
                .filter(|s| s.chars().count() <= 8 && words::may_be_symbol(s))
        };
        let symbol = in_model
            .or_else(bracketed)
            .or_else(first)
            .map(str::to_string);
        let short = || {
            (row.name.chars().count() <= 10 && !row.name.contains(' ')).then(|| row.name.clone())
        };
        row.symbol = symbol.or_else(short).unwrap_or_default();
        raw.row.symbol = row.symbol.clone();
    }
}

/// An input of the model that no row has and no line gives a value to, where everything else of the model has its row.
pub(super) fn missing_input(claimed: &Claimed, all: &[&Line]) -> Option<Row> {
    const FUNCTIONS: [&str; 12] = [
        "sin", "cos", "tan", "exp", "ln", "log", "lg", "sqrt", "abs", "pi", "arctan", "atan",
    ];
    let model = claimed.model.as_deref()?;
    let named = |row: &Row| words::has_symbol(model, &row.symbol);
    if claimed.rows.len() < 2 || !claimed.rows.iter().all(named) {
        return None;
    }
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    let is_name = |word: &&str| {
        word.starts_with(char::is_alphabetic)
            && !word.contains(|c: char| ('\u{4e00}'..='\u{9fff}').contains(&c))
            && !FUNCTIONS.contains(word)
    };
    let known = |word: &&str| {
        let of = |rows: &[Row]| rows.iter().any(|row| row.symbol == *word);
        of(&claimed.rows) || of(&claimed.absent) || *word == claimed.measurand
    };
    let mut open: Vec<&str> = model.split(|c: char| !part(c)).filter(is_name).collect();
    open.retain(|word| !known(word));
    open.sort_unstable();
    open.dedup();
    let [symbol] = open.as_slice() else {
        return None;
    };
    let given = |line: &&Line| notes::is_assigned(&line.text, symbol);
    (!all.iter().any(given)).then(|| Row {
        symbol: (*symbol).into(),
        is_absent: true,
        ..Row::default()
    })
}
