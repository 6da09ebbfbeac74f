//! What stands below the table: elided rows, the combined u, subtotals.

use super::common::SMALL;
use crate::Report;
use crate::comparison;
use crate::figures::Figures;
use crate::language::{Language, Word};
use crate::number::{NONE, TABLE_DIGITS, before_cut, effective, percent, probability, significant};
use gumption_fault::say;
use gumption_format::document::{Cell, ColumnKind, Table};
use gumption_gum::propagate::{
    Basis, Coverage, Freedom, Gum, ReportedUncertainty, StatedProbability,
};

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

/// y, u, ν_eff, k and U as they are reported.
pub(super) fn footer(report: &Report<'_>, measurand: usize) -> Vec<(String, String)> {
    let figures = Figures::new(report, measurand);
    let gum = &report.evaluation.results[measurand].gum;
    let l = report.language;
    let mut rows = vec![(
        Word::Estimate,
        format!("{} = {}", figures.name, figures.value()),
    )];
    let of_gum = figures.reported.basis == Basis::Gum;
    if let Some(u) = figures.u() {
        let (word, symbol) = match of_gum {
            true => (Word::CombinedUncertainty, "u_c"),
            false => (Word::StandardUncertainty, "u"),
        };
        rows.push((word, format!("{symbol} = {}", figures.amount(&u))));
    }
    if of_gum {
        rows.push((Word::FreedomEffective, freedom(gum, &figures, l)));
    }
    if let Some(k) = figures.k() {
        let why = match of_gum {
            true => basis(&figures, &gum.coverage, l),
            false => match figures.reported.uncertainty {
                ReportedUncertainty::HalfWidth { .. } => "U/u".to_string(),
                _ => comparison::basis_of_k(&gum.coverage, l),
            },
        };
        rows.push((Word::Factor, say!("k = {k} ({why})").in_language(l)));
    }
    if let Some(expanded) = figures.expanded() {
        rows.push((Word::Expanded, format!("U = {}", figures.amount(&expanded))));
    }
    if let Some([low, high]) = figures.interval() {
        rows.push((
            Word::Interval,
            figures.of_value(&format!("[{low}, {high}]")),
        ));
    }
    rows.into_iter()
        .map(|(word, text)| (word.of(l).to_string(), text))
        .collect()
}

/// ν_eff: the one that gave k, and what it was cut from.
fn freedom(gum: &Gum, figures: &Figures<'_>, l: Language) -> String {
    let found = effective(gum.freedom.value());
    let relation = match gum.freedom {
        Freedom::Refused { .. } if found != effective(f64::INFINITY) => "≥",
        _ => "=",
    };
    match figures
        .reported
        .dof
        .filter(|used| used.is_finite())
        .map(effective)
    {
        Some(used) if used != found => {
            let found = before_cut(gum.freedom.value());
            say!("ν_eff {relation} {used} (cut from {found})").in_language(l)
        }
        _ => format!("ν_eff {relation} {found}"),
    }
}

/// Where k came from, and its probability; none where the statement names none.
fn basis(figures: &Figures<'_>, coverage: &Coverage, l: Language) -> String {
    let p = match figures.reported.probability {
        StatedProbability::Of(_) => format!("p = {}", probability(coverage.probability)),
        StatedProbability::Unnamed | StatedProbability::Refuted => l
            .pick("no probability stated", "不注明包含概率")
            .to_string(),
    };
    [comparison::basis_of_k(coverage, l), p].join(l.comma())
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
