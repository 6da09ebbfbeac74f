//! What stands beside the table: origins of components, correlations, constants.

use super::common::{LONG, SMALL, kind};
use crate::how;
use crate::language::{Language, Word};
use crate::number::exact;
use crate::statement::coefficient;
use crate::{Report, symbol};
use gumption_fault::say;
use gumption_format::document::Block;
use gumption_format::document::{ColumnKind, Row, Table};
use gumption_gum::budget::{Component, Group};

/// How each u was found, and from which certificate.
pub(crate) fn origins(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let mut table = Table::new([
        (Word::Component.of(l), ColumnKind::Names),
        (Word::TypeShort.of(l), ColumnKind::Words),
        (Word::Where.of(l), ColumnKind::Wrapped),
        (Word::Sources.of(l), ColumnKind::Wrapped),
    ]);
    let components = &report.budget.components;
    let mut order: Vec<usize> = (0..components.len()).collect();
    let weight = |t: usize| -> f64 {
        let shares = report
            .evaluation
            .results
            .iter()
            .filter_map(|r| r.gum.components.get(t));
        shares.map(|c| c.share.abs()).fold(0.0, f64::max)
    };
    if order.len() > LONG {
        order.sort_by(|a, b| weight(*b).total_cmp(&weight(*a)));
        order.truncate(LONG);
        order.retain(|t| weight(*t) >= SMALL);
    }
    for t in &order {
        let component = &components[*t];
        let from = provenance(component, l);
        table.push(vec![
            component.name.clone().into(),
            kind(component.evaluation).into(),
            how::how(&component.how, l).into(),
            from.into(),
        ]);
    }
    let left_out = components.len() - order.len();
    if left_out > 0 {
        table.rows.push(Row::Across(
            say!("… and {left_out} smaller ones; all are in the JSON output").in_language(l),
        ));
    }
    vec![
        Block::Section(Word::Origin.of(l).to_string()),
        Block::Table(table.without_empty_columns()),
    ]
}

fn provenance(component: &Component, language: Language) -> String {
    let certificate = component.certificate.iter();
    let mut parts: Vec<String> = certificate
        .flat_map(|c| {
            let due = c
                .due
                .as_ref()
                .map(|due| say!("due {due}").in_language(language));
            [c.number.clone(), c.laboratory.clone(), c.date.clone(), due]
        })
        .flatten()
        .collect();
    parts.extend(component.reference.clone());
    parts.join(language.comma())
}

/// Correlated components, as pairs or in short.
pub(crate) fn correlated(report: &Report<'_>) -> Vec<Block> {
    /// More pairs are for the JSON output.
    const MOST: usize = 24;
    let l = report.language;
    let name = |t: &usize| report.budget.components[*t].name.as_str();
    let groups = report.budget.groups.iter();
    let mut correlated = groups.flat_map(|group| {
        let of_all = common(group).filter(|_| group.members.len() <= MOST);
        let pairs = pairs(group).filter(move |(_, r)| of_all.is_none() && *r != 0.0);
        let pairs = pairs.map(|(pair, r)| (pair.map(|place| group.members[place]).to_vec(), r));
        let together = of_all.map(|r| (group.members.clone(), r));
        together.into_iter().chain(pairs)
    });
    let said = |(members, r): (Vec<usize>, f64)| {
        let names: Vec<&str> = members.iter().map(name).collect();
        format!("r({}) = {}", names.join(", "), coefficient(r))
    };
    let mut told: Vec<String> = correlated.by_ref().take(MOST).map(said).collect();
    if told.is_empty() {
        return Vec::new();
    }
    let left_out = correlated.count();
    if left_out > 0 {
        told.push(say!("… and {left_out} more").in_language(l));
    }
    vec![
        Block::Section(Word::CorrelatedComponents.of(l).to_string()),
        Block::List(told),
    ]
}

/// Every pair of a group, by their places in it, with its coefficient.
fn pairs(group: &Group) -> impl Iterator<Item = ([usize; 2], f64)> {
    let places = 0..group.members.len();
    let above = places.flat_map(|i| (i + 1..group.members.len()).map(move |j| [i, j]));
    above.map(|[i, j]| ([i, j], group.correlation[(i, j)]))
}

/// The coefficient of every pair of a group, where all have the same: they are told together.
fn common(group: &Group) -> Option<f64> {
    let (_, first) = pairs(group).next()?;
    let is_first = |(_, r): ([usize; 2], f64)| r == first;
    (first != 0.0 && pairs(group).all(is_first)).then_some(first)
}

/// Exactly known quantities.
pub(crate) fn constants(report: &Report<'_>) -> Vec<Block> {
    /// Elements of a vector that are shown.
    const MOST: usize = 6;
    let lines: Vec<(String, String)> = report
        .budget
        .constants
        .iter()
        .map(|c| {
            let unit = symbol(&c.unit);
            let mut numbers: Vec<String> = c.values.iter().take(MOST).map(|v| exact(*v)).collect();
            if c.values.len() > MOST {
                numbers.push(format!("… ({})", c.values.len()));
            }
            let mut text = numbers.join(", ");
            for more in [Some(&unit), c.description.as_ref(), c.reference.as_ref()]
                .into_iter()
                .flatten()
                .filter(|t| !t.is_empty())
            {
                text.push_str(if more == &unit { " " } else { "; " });
                text.push_str(more);
            }
            (c.name.clone(), text)
        })
        .collect();
    if lines.is_empty() {
        return Vec::new();
    }
    vec![
        Block::Section(Word::Exact.of(report.language).to_string()),
        Block::Fields(lines),
    ]
}
