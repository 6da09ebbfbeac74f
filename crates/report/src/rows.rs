//! Results as rows of numbers, for spreadsheets and scripts.

use std::fmt;

use super::{Report, decisions};
use gumption_core::model::Output;
use gumption_core::quantity::Unit;
use gumption_gum::budget::Budget;
use gumption_gum::propagate::Figures;

/// One line for every row, exact, as comma-separated values: label, and for every measurand what is reported of it, with its
/// unit in the head; for every assessment its verdict and conformance probability. What a row has not is empty.
///
/// # Errors
/// Only where the text cannot be put together, which memory alone could prevent.
pub fn rows(rows: &[Report<'_>]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    if let Some(first) = rows.first() {
        writer.write_record(heads(first.budget))?;
    }
    for row in rows {
        let mut fields = vec![row.label.unwrap_or_default().to_string()];
        cells(row, |cell| fields.push(cell.to_string()));
        writer.write_record(fields)?;
    }
    writer
        .into_inner()
        .map_err(|error| error.into_error().into())
}

pub(super) fn heads(budget: &Budget) -> Vec<String> {
    let in_unit = |head: String, unit: &Unit| match unit.is_one() {
        true => head,
        false => format!("{head} [{}]", unit.symbol),
    };
    let mut heads = vec!["label".to_string()];
    for Output { name, unit, .. } in budget.model.outputs() {
        let deviation = unit.difference();
        heads.push(in_unit(name.clone(), unit));
        heads.push(in_unit(format!("u({name})"), &deviation));
        heads.push(format!("nu({name})"));
        heads.push(format!("k({name})"));
        heads.push(in_unit(format!("U({name})"), &deviation));
        heads.push(in_unit(format!("lower({name})"), unit));
        heads.push(in_unit(format!("upper({name})"), unit));
    }
    for assessment in &budget.conformity {
        heads.push(format!("verdict({})", assessment.name));
        heads.push(format!("p_c({})", assessment.name));
    }
    heads
}

/// What stands in a column behind the label.
pub(super) enum Cell {
    /// Exact; nothing for what there is not.
    Number(Option<f64>),
    Code(&'static str),
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cell::Number(Some(x)) => write!(f, "{x:?}"),
            Cell::Number(None) => Ok(()),
            Cell::Code(code) => f.write_str(code),
        }
    }
}

/// Gives the cells of the columns behind the label, in their order.
pub(super) fn cells(report: &Report<'_>, mut give: impl FnMut(Cell)) {
    for result in &report.evaluation.results {
        let found = result.reported(&report.budget.conventions);
        figures(&found.figures(), &mut give);
    }
    for found in &report.evaluation.conformity {
        give(Cell::Code(
            found.verdict.map_or("", decisions::verdict_code),
        ));
        let known = found.conformance.as_ref();
        give(Cell::Number(known.and_then(|known| known.probability)));
    }
}

/// Gives the cells of what is reported of a measurand.
pub(super) fn figures(found: &Figures, mut give: impl FnMut(Cell)) {
    let numbers = [
        Some(found.estimate),
        found.u,
        found.dof,
        found.k,
        found.expanded,
        found.ends.map(|ends| ends[0]),
        found.ends.map(|ends| ends[1]),
    ];
    numbers.into_iter().for_each(|x| give(Cell::Number(x)));
}
