//! Rows that their own words call contained in others, or not counted.

use std::ops::Range;

use crate::claim::Row;
use crate::read::family::CONTAINED;
use crate::read::words::{find, has};

/// What words say, if they say that a row is not to be counted.
pub(super) fn not_counted(words: &str) -> Option<String> {
    const NOT_COUNTED: &[&str] = &[
        "already contained",
        "already included",
        "not counted",
        "left out",
        "for information only",
        "not added",
        "不再计",
        "不计入",
        "不重复计",
        "不另计",
        "略去",
        "不予计",
        "不单独",
        "舍去",
        "舍弃",
        "忽略不计",
    ];
    const COUNTED: &[&str] = &[
        "an indication of its own",
        "counted beside",
        "not contained",
        "not included",
        "独立示值",
        "单独计入",
        "另行计入",
        "另计",
    ];
    let lower = words.to_lowercase();
    let name = lower.split(PARTED).next().unwrap_or_default();
    let of_clause = |clause: &str| {
        let said = CONTAINED.iter().chain(NOT_COUNTED).any(|key| {
            let at = find(clause, key, 0);
            at.is_some_and(|at| !is_of_another(clause, at..at + key.len(), name))
        });
        said && (!has(clause, COUNTED) || has(clause, &["不另计"]))
    };
    // `r is left out; z is counted beside it`: each clause is about one thing.
    lower
        .split([';', '。'])
        .any(of_clause)
        .then(|| words.to_string())
}

/// Of a quantity in several rows, one of which says that the larger is taken, the smaller ones are not counted; nor is a row that
/// says so and has no contribution where others have one.
pub(super) fn smaller_are_not_counted(rows: &mut [Row]) {
    /// What calls the larger of several, without a word of which row that is.
    const LARGER: &[&str] = &[
        "取大者",
        "取较大",
        "取其大",
        "取大值",
        "whichever is larger",
        "whichever is greater",
        "larger is taken",
        "larger one",
        "larger of",
        "greater of",
    ];
    let u = |row: &Row| row.u.as_ref().map(|u| (u.value, u.unit.clone()));
    let is_larger = |other: &Row, row: &Row| match (u(other), u(row)) {
        (Some((other, unit)), Some((own, own_unit))) => other > own && unit == own_unit,
        _ => false,
    };
    let have_contributions = rows.iter().any(|row| row.contribution.is_some());
    let chosen = |row: &Row| has(&row.words.to_lowercase(), LARGER);
    let is_smaller = |row: &Row| {
        let is_of_it = |other: &&Row| !row.symbol.is_empty() && other.symbol == row.symbol;
        let mut others = rows.iter().filter(is_of_it);
        let is_left_out = have_contributions && row.contribution.is_none() && row.u.is_some();
        is_left_out || others.any(|other| is_larger(other, row))
    };
    let smaller: Vec<bool> = rows
        .iter()
        .map(|row| chosen(row) && is_smaller(row))
        .collect();
    for (row, _) in rows.iter_mut().zip(smaller).filter(|(_, smaller)| *smaller) {
        row.not_counted = row.not_counted.take().or_else(|| Some(row.words.clone()));
    }
}

/// What parts the name of a row from what is said of it, and a remark in a clause from the rest.
const PARTED: [char; 6] = ['(', '（', ',', '，', ';', '。'];

/// Whether it is something else that a clause, by the words at `said`, calls contained in the row itself: `repeatability (resolution
/// already included)`, `重复性（已包含分辨力）`.
fn is_of_another(clause: &str, said: Range<usize>, name: &str) -> bool {
    const OWN: [&str; 13] = [
        "its",
        "this",
        "the",
        "which",
        "that",
        "effect",
        "influence",
        "contribution",
        "has",
        "been",
        "was",
        "are",
        "already",
    ];
    /// 其, 该, 此, 影响, and why it is the smaller one: 小于重复性, 较小, 取大者, 两者取大, 与重复性取大.
    const OF_ITSELF: [char; 11] = [
        '其', '该', '此', '影', '已', '小', '较', '取', '两', '二', '与',
    ];
    // In Chinese what is contained stands behind, unless it is said in what.
    let behind = clause[said.end..].trim_start();
    let has_object = behind.starts_with(|c: char| c.is_alphabetic() && !"在于入进中内".contains(c));
    if ["已包含", "已含"].contains(&&clause[said.clone()]) && has_object {
        let ends = behind.find(|c: char| !c.is_alphanumeric());
        let object = &behind[..ends.unwrap_or(behind.len())];
        return !name.contains(object);
    }
    let mark = clause[..said.start].rfind(PARTED);
    let subject = mark.map_or("", |mark| &clause[mark..said.start]);
    let mut words = subject.split(|c: char| !c.is_alphanumeric());
    let is_own = |word: &str| OWN.contains(&word) || word.starts_with(OF_ITSELF);
    words.any(|word| word.len() >= 3 && !is_own(word) && !name.contains(word))
}
