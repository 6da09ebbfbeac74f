//! What the uncertainty of each coefficient comes from.

use crate::language::{Language, Word};
use crate::number::{freedom, in_unit, percent, significant};
use crate::phrase::{named_row, numbers_beside, section, table};
use crate::symbol;
use gumption_fault::say;
use gumption_format::document::{
    Block, Cell,
    ColumnKind::{Bar, Names, Numbers, Words},
    Row, Table,
};
use gumption_lab::calibrate::{Campaign, Cause, Contribution, Figures, Origin};
use gumption_lab::experiment::Scope;

use super::sections::{DIGITS, entered, head_of, shown_u};

/// More coefficients than these share one table of causes.
const SINGLE_BUDGETS: usize = 6;

/// What a cause is.
pub(super) fn cause_name(cause: &Cause, l: Language) -> String {
    origin_name(&cause.origin, l)
}

pub(super) fn origin_name(origin: &Origin, l: Language) -> String {
    match origin {
        Origin::Stated { name, .. } => name.clone(),
        Origin::Residuals { response: of } => say!("scatter of {of}").in_language(l),
        Origin::Samples { column: of } => say!("samples of {of}").in_language(l),
        Origin::Prior { parameter: of } => say!("what was known of {of}").in_language(l),
    }
}

/// On which points one of its errors acts.
fn cause_scope(cause: &Cause, l: Language) -> String {
    match &cause.origin {
        Origin::Prior { .. } => String::new(),
        Origin::Stated {
            scope: Scope::Common,
            ..
        } => l.pick("all points", "各点共有").into(),
        Origin::Stated {
            scope: Scope::By(column),
            ..
        } => say!("by {column}").in_language(l),
        _ => l.pick("each point", "各点独立").into(),
    }
}

/// Budget of every coefficient by cause.
pub(super) fn budgets(campaign: &Campaign, figures: &Figures, l: Language) -> Vec<Block> {
    if figures.causes.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![section(l, "Uncertainty by cause", "不确定度来源")];
    let count = figures.coefficients.len();
    if count > SINGLE_BUDGETS {
        blocks.push(Block::Table(all_budgets(figures, l)));
    } else {
        blocks.extend((0..count).map(|index| Block::Table(budget(campaign, figures, index, l))));
    }
    blocks
}

/// A contribution c·u with the sign of c, where one error has one: opposite signs tell what a shared error correlates.
fn shown(one: &Contribution<'_>) -> String {
    significant(one.effect.unwrap_or(one.u), DIGITS)
}

fn budget(campaign: &Campaign, figures: &Figures, index: usize, l: Language) -> Table {
    let one = &figures.coefficients[index];
    let head = in_unit(&format!("c·u of {}", one.name), &symbol(&one.unit));
    let head_zh = in_unit(&format!("{} 的 c·u", one.name), &symbol(&one.unit));
    let mut table = table(
        l,
        [
            ("cause", "来源", Names),
            ("one error acts on", "作用范围", Words),
            (&head, &head_zh, Numbers),
            ("ν", "ν", Numbers),
            ("%", "%", Numbers),
            ("", "", Bar),
        ],
    );
    for part in figures.budget(index) {
        table.push(vec![
            cause_name(part.cause, l).into(),
            cause_scope(part.cause, l).into(),
            shown(&part).into(),
            freedom(part.dof).into(),
            percent(part.share).into(),
            Cell::Share(part.share),
        ]);
    }
    table.rows.push(Row::Rule);
    let sum = ["".to_owned(), shown_u(one.u), entered(campaign, one)];
    table
        .rows
        .push(named_row(Word::CombinedUncertainty.of(l), sum));
    table
}

fn all_budgets(figures: &Figures, l: Language) -> Table {
    let coefficients = &figures.coefficients;
    let mut table = numbers_beside(l.pick("cause", "来源"), coefficients.iter().map(head_of));
    for cause in &figures.causes {
        let name = match cause_scope(cause, l) {
            scope if scope.is_empty() => cause_name(cause, l),
            scope => format!("{} ({scope})", cause_name(cause, l)),
        };
        let of = |(index, one): (usize, &gumption_lab::calibrate::Coefficient)| match cause
            .contributes(index, one.u)
        {
            part if part.is_nothing => "0".to_owned(),
            part => shown(&part),
        };
        table
            .rows
            .push(named_row(name, coefficients.iter().enumerate().map(of)));
    }
    table.rows.push(Row::Rule);
    let sums = coefficients.iter().map(|one| shown_u(one.u));
    table
        .rows
        .push(named_row(Word::CombinedUncertainty.of(l), sums));
    table
}
