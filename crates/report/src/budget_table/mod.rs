//! The budget table: one row per input, its components below it, shared sources, the result; then
//! where each standard uncertainty comes from.

use gumption_fault::say;
mod below;
mod beside;
mod common;

use crate::language::{Language, Word};
use crate::number::{
    NONE, TABLE_DIGITS, aligned, effective, freedom_of_part, percent, significant,
};
use crate::{Report, symbol};
use gumption_format::document::Block;
use gumption_format::document::{Cell, ColumnKind, Row, Table};
use gumption_gum::budget::{Component, Input, Owner, Term};
use gumption_gum::propagate::{Contribution, FindingKind, Gum, is_residue};

use common::{LONG, SMALL, kind};

use below::{elision, footer, subtotals};

pub(super) use beside::{constants, correlated, origins};

/// The inputs of one measurand in the order of display.
struct Selection {
    shown: Vec<usize>,
    /// Inputs left out of a long table.
    elided: Vec<usize>,
    /// Inputs whose contribution to this measurand is zero.
    without_contribution: Vec<usize>,
}

/// The table of one measurand with what belongs below it.
pub(super) fn blocks(report: &Report<'_>, measurand: usize) -> Vec<Block> {
    let selection = select(report, measurand);
    let mut blocks = vec![Block::Table(table(report, measurand, &selection))];
    if !selection.without_contribution.is_empty() {
        let names: Vec<String> = selection
            .without_contribution
            .iter()
            .map(|i| report.budget.inputs[*i].name.to_string())
            .collect();
        let shown = shortened(&names, report.language);
        blocks.push(Block::Paragraph(
            say!(
                "Without a contribution to {}: {shown}.",
                report.measurand(measurand).0
            )
            .in_language(report.language),
        ));
    }
    blocks.push(Block::Fields(footer(report, measurand)));
    if let Some(groups) = subtotals(report, measurand) {
        blocks.push(Block::Section(Word::Groups.of(report.language).to_string()));
        blocks.push(Block::Table(groups));
    }
    blocks
}

/// At most a dozen names, and how many more there are.
fn shortened(names: &[String], language: Language) -> String {
    const MOST: usize = 12;
    if names.len() <= MOST {
        return language.list(names);
    }
    let (first, more) = (
        names[..MOST].join(language.list_comma()),
        names.len() - MOST,
    );
    say!("{first} and {more} more").in_language(language)
}

fn select(report: &Report<'_>, measurand: usize) -> Selection {
    let contributions = &report.evaluation.results[measurand].gum.inputs;
    let several = report.evaluation.results.len() > 1;
    let hidden = |i: &usize| {
        let name = &report.budget.inputs[*i].name;
        let flagged = |k: &FindingKind| matches!(k, FindingKind::VanishingSensitivity { inputs, .. } if inputs.iter().any(|input| name == input));
        several && contributions[*i].sensitivity == 0.0 && !report.finds(measurand, flagged)
    };
    let (without_contribution, mut shown): (Vec<usize>, Vec<usize>) =
        (0..contributions.len()).partition(hidden);
    let mut elided = Vec::new();
    if shown.len() > LONG {
        shown.sort_by(|a, b| {
            contributions[*b]
                .share
                .abs()
                .total_cmp(&contributions[*a].share.abs())
        });
        let keep = shown
            .iter()
            .take(LONG)
            .take_while(|i| contributions[**i].share.abs() >= SMALL)
            .count();
        elided = shown.split_off(keep);
    }
    Selection {
        shown,
        elided,
        without_contribution,
    }
}

fn table(report: &Report<'_>, measurand: usize, selection: &Selection) -> Table {
    let l = report.language;
    let gum = &report.evaluation.results[measurand].gum;
    let (name, unit) = report.measurand(measurand);
    let mut table = Table::new([
        (Word::Quantity.of(l), ColumnKind::Names),
        (Word::Estimate.of(l), ColumnKind::Numbers),
        (Word::Unit.of(l), ColumnKind::Words),
        ("u", ColumnKind::Numbers),
        (Word::Distribution.of(l), ColumnKind::Words),
        (Word::FreedomShort.of(l), ColumnKind::Numbers),
        (Word::Sensitivity.of(l), ColumnKind::Numbers),
        (Word::Contribution.of(l), ColumnKind::Numbers),
        (Word::Share.of(l), ColumnKind::Numbers),
        ("", ColumnKind::Bar),
    ]);
    for i in &selection.shown {
        input_rows(report, gum, *i, &mut table);
    }
    if !selection.elided.is_empty() {
        table
            .rows
            .push(Row::Across(elision(l, gum, &selection.elided)));
    }
    source_rows(report, gum, &mut table);
    table.rows.push(Row::Rule);
    table.push(vec![
        name.into(),
        estimate(gum.estimate, gum.u).into(),
        symbol(unit).into(),
        significant(gum.u, TABLE_DIGITS).into(),
        Cell::Empty,
        effective(gum.freedom.value()).into(),
        Cell::Empty,
        significant(gum.u, TABLE_DIGITS).into(),
        percent(gum.inputs.iter().map(|c| c.share).sum()).into(),
    ]);
    table
}

/// An estimate beside its u: to the place of two digits of u, and where that is above the units, to the last place that u
/// has, so that no nought stands for a digit that is known.
fn estimate(x: f64, u: f64) -> String {
    let digits = if u >= 100.0 { TABLE_DIGITS } else { 2 };
    aligned(x, u, digits)
}

fn input_rows(report: &Report<'_>, gum: &Gum, i: usize, table: &mut Table) {
    let budget = report.budget;
    let (input, line) = (&budget.inputs[i], &gum.inputs[i]);
    let only: Option<&Component> = match input.terms.as_slice() {
        [term] => budget.components.get(term.component),
        _ => None,
    };
    table.push(vec![
        input.name.clone().into(),
        estimate(input.estimate, line.u).into(),
        symbol(&input.unit).into(),
        significant(line.u, TABLE_DIGITS).into(),
        only.map_or(Cell::Empty, |c| distribution(c, report.language).into()),
        freedom_of_part(line.dof).into(),
        sensitivity(line, gum, input.estimate).into(),
        contribution(line.contribution, gum).into(),
        share(line, gum).into(),
        Cell::Share(line.share),
    ]);
    if input.terms.len() > 1 {
        for term in &input.terms {
            component_row(report, gum, (input, line), term, table);
        }
    }
}

fn component_row(
    report: &Report<'_>,
    gum: &Gum,
    (input, line): (&Input, &Contribution),
    term: &Term,
    table: &mut Table,
) {
    let component = &report.budget.components[term.component];
    let u = term.coefficient.abs() * component.u;
    // The share of a shared component is in its own row: it acts through several inputs at once.
    let share: Cell = if shared_components(report).contains(&term.component) {
        NONE.into()
    } else {
        share(&gum.components[term.component], gum).into()
    };
    let part = match &component.owner {
        Owner::Source(source) if component.name == *source => source.as_str(),
        _ => component.label.as_str(),
    };
    table.push(vec![
        Cell::Part(part.to_string()),
        Cell::Empty,
        symbol(&input.unit).into(),
        significant(u, TABLE_DIGITS).into(),
        distribution(component, report.language).into(),
        freedom_of_part(component.dof).into(),
        Cell::Empty,
        contribution(line.sensitivity * term.coefficient * component.u, gum).into(),
        share,
    ]);
}

fn source_rows(report: &Report<'_>, gum: &Gum, table: &mut Table) {
    let sources: Vec<usize> = shared_components(report);
    if sources.is_empty() {
        return;
    }
    table.rows.push(Row::Rule);
    table
        .rows
        .push(Row::Across(Word::Shared.of(report.language).to_string()));
    for t in sources {
        let (component, line) = (&report.budget.components[t], &gum.components[t]);
        table.push(vec![
            component.name.clone().into(),
            Cell::Empty,
            symbol(&component.unit).into(),
            significant(line.u, TABLE_DIGITS).into(),
            distribution(component, report.language).into(),
            freedom_of_part(line.dof).into(),
            sensitivity(line, gum, 0.0).into(),
            contribution(line.contribution, gum).into(),
            share(line, gum).into(),
            Cell::Share(line.share),
        ]);
    }
}

/// A sensitivity coefficient; zero where only rounding kept it from being zero. An input whose u is
/// negligible has a small contribution too, but its c still carries its estimate into y.
fn sensitivity(line: &Contribution, gum: &Gum, estimate: f64) -> String {
    let whole = gum.estimate.abs().max(gum.u);
    let residue =
        is_residue(line.contribution, gum.u) && is_residue(line.sensitivity * estimate, whole);
    significant(if residue { 0.0 } else { line.sensitivity }, 4)
}

fn contribution(product: f64, gum: &Gum) -> String {
    let residue = is_residue(product, gum.u);
    significant(if residue { 0.0 } else { product }, TABLE_DIGITS)
}

fn share(line: &Contribution, gum: &Gum) -> String {
    let residue = is_residue(line.contribution, gum.u);
    percent(if residue { 0.0 } else { line.share })
}

/// Sources, and components that several elements of a vector have in common; ascending.
fn shared_components(report: &Report<'_>) -> Vec<usize> {
    let mut inputs = vec![0_usize; report.budget.components.len()];
    for term in report.budget.inputs.iter().flat_map(|input| &input.terms) {
        inputs[term.component] += 1;
    }
    let components = report.budget.components.iter().zip(inputs).enumerate();
    components
        .filter(|(_, (c, inputs))| *inputs > 1 || matches!(c.owner, Owner::Source(_)))
        .map(|(t, _)| t)
        .collect()
}

/// `normal (B)`.
fn distribution(component: &Component, language: Language) -> String {
    format!(
        "{} ({})",
        component.distribution.kind().short(language),
        kind(component.evaluation)
    )
}

#[cfg(test)]
mod tests {
    use super::estimate;

    #[test]
    fn an_estimate_ends_where_its_u_does_above_the_units() {
        assert_eq!(estimate(1.0, 0.000122), "1.00000");
        assert_eq!(estimate(12045.0, 109.75), "12045");
        assert_eq!(estimate(12045.0, 1234.0), "12040");
    }
}
