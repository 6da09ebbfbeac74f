//! What the uncertainty of each coefficient comes from.

use super::super::language::{Language, Word};
use super::super::number::{freedom, in_unit, percent, significant};
use super::super::symbol;
use super::sections::{DIGITS, column, head_of, shown_u};
use crate::calibrate::{Cause, Coefficient, Figures, Origin, Scope};
use crate::document::Block;
use crate::document::{Cell, ColumnKind, Row, Table};

/// More coefficients than these share one table of causes.
const SINGLE_BUDGETS: usize = 6;

/// Contributions smaller than this share of u are rounding errors, or might as well be.
const NOTHING: f64 = 1e-6;

/// What a cause is, and on which points one error acts.
pub(super) fn cause_words(cause: &Cause, l: Language) -> (String, String) {
    match &cause.origin {
        Origin::Stated { name, scope } => (
            name.clone(),
            match scope {
                Scope::Common => l.pick("all points", "各点共有").to_owned(),
                Scope::Each => l.pick("each point", "各点独立").to_owned(),
                Scope::By(column) => l.pick(format!("by {column}"), format!("按 {column}")),
            },
        ),
        Origin::Residuals { response } => (
            l.pick(
                format!("scatter of {response}"),
                format!("{response} 的分散性"),
            ),
            l.pick("each point", "各点独立").to_owned(),
        ),
        Origin::Samples { column } => (
            l.pick(format!("samples of {column}"), format!("{column} 的采样")),
            l.pick("each point", "各点独立").to_owned(),
        ),
        Origin::Prior { parameter } => (
            l.pick(
                format!("what was known of {parameter}"),
                format!("{parameter} 的已知信息"),
            ),
            String::new(),
        ),
    }
}

/// Budget of every coefficient by cause.
pub(super) fn budgets(figures: &Figures, l: Language) -> Vec<Block> {
    if figures.causes.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![Block::Section(
        l.pick("Uncertainty by cause", "不确定度来源").to_owned(),
    )];
    if figures.coefficients.len() > SINGLE_BUDGETS {
        blocks.push(Block::Table(all_budgets(figures, l)));
        return blocks;
    }
    for (index, one) in figures.coefficients.iter().enumerate() {
        blocks.push(Block::Table(budget(figures, index, one, l)));
    }
    blocks
}

fn budget(figures: &Figures, index: usize, one: &Coefficient, l: Language) -> Table {
    let head = in_unit(&format!("u({})", one.name), &symbol(&one.unit));
    let mut table = Table::new([
        (l.pick("cause", "来源"), ColumnKind::Names),
        (l.pick("one error acts on", "作用范围"), ColumnKind::Words),
        (&head, ColumnKind::Numbers),
        ("ν", ColumnKind::Numbers),
        ("%", ColumnKind::Numbers),
        ("", ColumnKind::Bar),
    ]);
    let mut causes: Vec<&Cause> = figures.causes.iter().collect();
    causes.sort_by(|a, b| b.contribution(index).total_cmp(&a.contribution(index)));
    for cause in causes {
        let contribution = cause.contribution(index);
        if contribution <= NOTHING * one.u {
            continue;
        }
        let share = (contribution / one.u).powi(2);
        let (name, scope) = cause_words(cause, l);
        table.push(vec![
            name.into(),
            scope.into(),
            significant(cause.effect(index).unwrap_or(contribution), DIGITS).into(),
            freedom(cause.contribution_dof(index)).into(),
            percent(share).into(),
            Cell::Share(share),
        ]);
    }
    table.rows.push(Row::Rule);
    table.push(vec![
        Word::CombinedUncertainty.of(l).into(),
        "".into(),
        shown_u(one.u).into(),
        freedom(one.dof).into(),
    ]);
    table
}

fn all_budgets(figures: &Figures, l: Language) -> Table {
    let mut table = Table {
        columns: vec![column(l.pick("cause", "来源"), ColumnKind::Names)],
        rows: Vec::new(),
    };
    let heads = figures.coefficients.iter().map(head_of);
    table
        .columns
        .extend(heads.map(|head| column(&head, ColumnKind::Numbers)));
    for cause in &figures.causes {
        let (name, scope) = cause_words(cause, l);
        let head = if scope.is_empty() {
            name
        } else {
            format!("{name} ({scope})")
        };
        let mut cells: Vec<Cell> = vec![head.into()];
        cells.extend(figures.coefficients.iter().enumerate().map(|(index, one)| {
            match cause.contribution(index) {
                small if small <= NOTHING * one.u => Cell::Text("0".to_owned()),
                contribution => Cell::Text(significant(
                    cause.effect(index).unwrap_or(contribution),
                    DIGITS,
                )),
            }
        }));
        table.push(cells);
    }
    table.rows.push(Row::Rule);
    let mut cells: Vec<Cell> = vec![Word::CombinedUncertainty.of(l).into()];
    cells.extend(
        figures
            .coefficients
            .iter()
            .map(|one| Cell::Text(shown_u(one.u))),
    );
    table.push(cells);
    table
}
