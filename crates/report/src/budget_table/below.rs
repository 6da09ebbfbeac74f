//! What stands below the table: elided rows, the combined u, subtotals.

use super::common::SMALL;
use crate::comparison;
use crate::language::{Language, Word};
use crate::number::{NONE, TABLE_DIGITS, aligned, freedom, percent, probability, significant};
use crate::{Report, difference_symbol, symbol};
use gumption_format::document::{Cell, ColumnKind, Table};
use gumption_gum::propagate::{CoverageBasis, Freedom, Gum};

pub(super) fn elision(language: Language, gum: &Gum, elided: &[usize]) -> String {
    let largest = elided
        .iter()
        .map(|i| gum.inputs[*i].share.abs())
        .fold(0.0, f64::max);
    let together: f64 = elided.iter().map(|i| gum.inputs[*i].share).sum();
    let count = elided.len();
    let together = percent(together);
    match (largest < SMALL, language) {
        (true, Language::English) => {
            format!("… {count} inputs below 0.1 % each, together {together} %")
        }
        (true, Language::Chinese) => {
            format!("…… 其余 {count} 个输入量各小于 0.1 %，合计 {together} %")
        }
        (false, Language::English) => format!(
            "… {count} inputs of at most {} % each, together {together} %",
            percent(largest)
        ),
        (false, Language::Chinese) => format!(
            "…… 其余 {count} 个输入量各不大于 {} %，合计 {together} %",
            percent(largest)
        ),
    }
}

/// y, u_c, ν_eff, k and U.
pub(super) fn footer(report: &Report<'_>, measurand: usize) -> Vec<(String, String)> {
    let gum = &report.evaluation.results[measurand].gum;
    let (name, unit) = report.measurand(measurand);
    let l = report.language;
    let with = |number: String, unit: &str| {
        if unit.is_empty() {
            number
        } else {
            format!("{number} {unit}")
        }
    };
    let difference = difference_symbol(unit);
    let dof = match &gum.freedom {
        Freedom::Refused { lower_bound, .. } => format!("≥ {}", freedom(*lower_bound)),
        Freedom::Ensembles(v) | Freedom::WelchSatterthwaite(v) => format!("= {}", freedom(*v)),
        Freedom::Infinite => "= ∞".to_string(),
    };
    let coverage = &gum.coverage;
    let k = significant(coverage.k, TABLE_DIGITS);
    let basis = comparison::basis_of_k(coverage, l);
    let fixed = coverage.basis == CoverageBasis::Fixed;
    // A fixed k has the profile's probability only where the distribution of the result grants it.
    let conventions = &report.budget.conventions;
    let granted = coverage.grants(conventions.coverage_probability);
    let p = if fixed && !(conventions.state_probability && granted) {
        l.pick("no probability stated", "不注明包含概率")
            .to_string()
    } else {
        format!("p = {}", probability(coverage.probability))
    };
    [
        (
            Word::Estimate,
            format!(
                "{name} = {}",
                with(aligned(gum.estimate, gum.u, 2), &symbol(unit))
            ),
        ),
        (
            Word::CombinedUncertainty,
            format!(
                "u_c = {}",
                with(significant(gum.u, TABLE_DIGITS), &difference)
            ),
        ),
        (Word::FreedomEffective, format!("ν_eff {dof}")),
        (
            Word::Factor,
            l.pick(
                format!("k = {k} ({basis}, {p})"),
                format!("k = {k}（{basis}，{p}）"),
            ),
        ),
        (
            Word::Expanded,
            format!(
                "U = {}",
                with(significant(coverage.expanded, TABLE_DIGITS), &difference)
            ),
        ),
    ]
    .map(|(word, text)| (word.of(l).to_string(), text))
    .to_vec()
}

pub(super) fn subtotals(report: &Report<'_>, measurand: usize) -> Option<Table> {
    let gum = &report.evaluation.results[measurand].gum;
    let l = report.language;
    let mut groups: Vec<(Option<&str>, f64)> = Vec::new();
    for (input, line) in report.budget.inputs.iter().zip(&gum.inputs) {
        let group = input.group.as_deref();
        match groups.iter_mut().find(|(g, _)| *g == group) {
            Some((_, share)) => *share += line.share,
            None => groups.push((group, line.share)),
        }
    }
    if groups.iter().all(|(g, _)| g.is_none()) {
        return None;
    }
    let mut table = Table::new([
        (Word::InputGroup.of(l), ColumnKind::Names),
        (Word::StandardUncertainty.of(l), ColumnKind::Numbers),
        (Word::Share.of(l), ColumnKind::Numbers),
        ("", ColumnKind::Bar),
    ]);
    for (group, share) in groups {
        // Under correlation a group may lower u(y): it then has no standard uncertainty of its own.
        let u = if share >= 0.0 {
            significant(share.sqrt() * gum.u, TABLE_DIGITS)
        } else {
            NONE.to_string()
        };
        let name = group.unwrap_or(l.pick("(without group)", "（未分组）"));
        table.push(vec![
            name.into(),
            u.into(),
            percent(share).into(),
            Cell::Share(share),
        ]);
    }
    Some(table)
}
