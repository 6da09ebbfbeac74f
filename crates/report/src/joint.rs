//! The joint result of several measurands (JCGM 102).

use gumption_fault::{Said, say};
use nalgebra::DMatrix;

use super::language::{Language, Word};
use super::number::{TABLE_DIGITS, freedom, in_unit, probability, significant};
use super::statement::{Coefficients, coefficient};
use super::{Report, symbol};
use gumption_format::document::Block;
use gumption_format::document::{Cell, Column, ColumnKind, Table};
use gumption_gum::propagate::{Basis, EllipsoidBy};

/// Correlation matrices and the factors of the coverage regions.
pub(super) fn blocks(report: &Report<'_>) -> Vec<Block> {
    let Some(joint) = &report.evaluation.joint else {
        return Vec::new();
    };
    let l = report.language;
    let mut blocks = vec![Block::Section(Word::Joint.of(l).to_string())];
    let names: Vec<&str> = (0..report.evaluation.results.len())
        .map(|m| report.measurand(m).0)
        .collect();
    let gum = matrix(l, &names, &joint.correlation, Word::Gum.of(l));
    blocks.push(Block::Table(gum));
    if let Some(correlation) = &joint.monte_carlo_correlation {
        let trials = matrix(l, &names, correlation, Word::MonteCarlo.of(l));
        blocks.push(Block::Table(trials));
    }
    if let Some(words) = methods(report) {
        blocks.push(Block::Paragraph(words));
    }
    if joint.degenerate {
        blocks.push(Block::Paragraph(
            say!("At least one measurand is a linear function of the others, so that no joint coverage region exists; use the single intervals.").in_language(l),
        ));
        return blocks;
    }
    blocks.push(Block::Table(regions(report)));
    let p = probability(report.coverage_probability());
    let by = match joint.ellipsoid_by {
        EllipsoidBy::Matrix => Said::quoted(format!("ν = {}", freedom(joint.dof.value()))),
        EllipsoidBy::Margins => say!("by the ν_eff of each measurand"),
    };
    blocks.push(Block::Paragraph(say!("k_q·u(y_j) are the half-widths of intervals that hold all measurands at once with probability {p}; k_p scales the ellipsoid given by the covariance matrix ({by}).").in_language(l)));
    blocks
}

/// Which method each result rests on, where that is not the same for all, and which coefficients go with them.
fn methods(report: &Report<'_>) -> Option<String> {
    let l = report.language;
    let by = |basis: Basis| -> Vec<String> {
        let results = report.evaluation.results.iter().enumerate();
        results
            .filter(|(_, r)| r.reported(&report.budget.conventions).basis == basis)
            .map(|(m, _)| report.measurand(m).0.to_string())
            .collect()
    };
    let (gum, trials) = (by(Basis::Gum), by(Basis::MonteCarlo));
    if gum.is_empty() || trials.is_empty() {
        return None;
    }
    let (gum, trials) = (l.first_of(&gum), l.first_of(&trials));
    let of = match Coefficients::of(report) {
        Coefficients::MonteCarlo => Word::MonteCarlo.of(l),
        Coefficients::Gum | Coefficients::GumForWantOfMoments => Word::Gum.of(l),
    };
    Some(say!("Reported is the GUM result of {gum} and the Monte Carlo result of {trials}. The statement gives the correlation coefficients of one method for all pairs, {of}; with the u of that method they are a covariance matrix.").in_language(l))
}

/// A correlation matrix; `of` says of what or by which method.
pub(super) fn matrix(l: Language, names: &[&str], correlation: &DMatrix<f64>, of: &str) -> Table {
    let label = [Word::Correlation.of(l), of].join(l.comma());
    let column = |head: &str, kind| Column {
        head: head.to_string(),
        kind,
    };
    let mut columns = vec![column(&label, ColumnKind::Names)];
    columns.extend(names.iter().map(|name| column(name, ColumnKind::Numbers)));
    let mut table = Table {
        columns,
        rows: Vec::new(),
    };
    for (i, name) in names.iter().enumerate() {
        let mut cells: Vec<Cell> = vec![(*name).into()];
        cells.extend((0..names.len()).map(|j| match correlation.get((i, j)) {
            Some(r) => coefficient(*r).into(),
            None => Cell::Empty,
        }));
        table.push(cells);
    }
    table
}

/// The product of the units of all measurands, in which the size of a region is.
fn size_unit(report: &Report<'_>) -> String {
    let all = (0..report.evaluation.results.len()).map(|m| report.measurand(m).1.difference());
    let product = all.reduce(|product, unit| product.product(&unit));
    product.map_or_else(String::new, |unit| symbol(&unit))
}

fn regions(report: &Report<'_>) -> Table {
    let l = report.language;
    let mut table = Table::new([
        (l.pick("coverage region", "包含区域"), ColumnKind::Words),
        (Word::Gum.of(l), ColumnKind::Numbers),
        (Word::MonteCarlo.of(l), ColumnKind::Numbers),
    ]);
    let Some(joint) = &report.evaluation.joint else {
        return table;
    };
    let regions = joint.regions.as_ref();
    let show = |x: Option<f64>| x.map_or(Cell::Empty, |x| significant(x, TABLE_DIGITS).into());
    let comma = l.comma();
    let mut row = |label: String, gum: Option<f64>, trials: Option<f64>| {
        table.push(vec![label.into(), show(gum), show(trials)])
    };
    row(
        format!("k_p{comma}{}", Word::Ellipsoid.of(l)),
        Some(joint.k_ellipsoid),
        regions.map(|r| r.k_ellipsoid),
    );
    row(
        format!("k_q{comma}{}", Word::Hyperrectangle.of(l)),
        Some(joint.k_rectangle),
        regions.map(|r| r.k_rectangle),
    );
    if let Some(regions) = regions {
        let size = match report.evaluation.results.len() {
            2 => l.pick("area", "面积"),
            _ => l.pick("volume", "体积"),
        };
        let size = in_unit(size, &size_unit(report));
        row(
            format!("{size}{comma}{}", Word::Ellipsoid.of(l)),
            None,
            Some(regions.ellipsoid_volume),
        );
        if let Some(smallest) = regions.smallest_volume {
            row(
                say!("{size}, smallest region").in_language(l),
                None,
                Some(smallest),
            );
        }
    }
    table
}
