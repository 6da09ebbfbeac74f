//! One example: where its figures come from, each published figure beside the one obtained, the verdict.

use gumption_core::quantity::{Decimal, Rounding, Unit};
use gumption_fault::say;
use gumption_gum::budget::{Figure, Part};
use gumption_gum::propagate::Comparison;
use gumption_verify::{Example, Problem, Row};

use super::words;
use crate::claim::{self, last_place};
use crate::language::{Language, Word};
use crate::number::{NONE, at_place, exact, grouped, print, significant};
use crate::{Report, symbol};
use gumption_format::document::Block;
use gumption_format::document::{Cell, ColumnKind, Table};

/// Heading, origin, figures and verdict of an example.
pub(super) fn blocks(number: usize, example: &Example, l: Language) -> Vec<Block> {
    let mut blocks = vec![
        Block::Section(words::heading(number, l)),
        Block::Fields(fields(example, l)),
    ];
    match &example.rows {
        Ok(rows) => {
            blocks.push(Block::Table(table(rows, l)));
            let notes = notes(rows);
            if !notes.is_empty() {
                blocks.push(Block::List(notes));
            }
        }
        Err(problem) => {
            let lines = words_of(problem, l);
            blocks.push(Block::Formula(lines.lines().map(String::from).collect()));
        }
    }
    blocks
}

/// Why an example has no figures.
pub(super) fn words_of(problem: &Problem, l: Language) -> String {
    match problem {
        Problem::Refused(rejection) => rejection.render_in(l, false).trim_end().to_string(),
        Problem::NoResult { label, error } => {
            let row = label
                .as_ref()
                .map(|label| format!("{label}: "))
                .unwrap_or_default();
            format!("{row}{}", error.said().in_language(l))
        }
    }
}

fn fields(example: &Example, l: Language) -> Vec<(String, String)> {
    let mut fields = Vec::new();
    let mut field = |name: &str, text: &str| {
        if !text.is_empty() {
            fields.push((name.to_string(), text.to_string()));
        }
    };
    field(l.pick("Example", "名称"), example.heading.titled(l));
    field(l.pick("File", "文件"), &example.file);
    let reference = example.heading.reference.as_deref();
    field(l.pick("Source", "来源"), reference.unwrap_or_default());
    field(Word::MonteCarlo.of(l), &runs(example, l));
    field(
        l.pick("Verdict", "结论"),
        &words::verdict_with_counts(example, l),
    );
    fields
}

/// Trials and seed of the first row; those of a series have the same, unless they are adaptive.
fn runs(example: &Example, l: Language) -> String {
    let run = example
        .rows
        .iter()
        .flatten()
        .find_map(|row| row.evaluation.run.as_ref());
    run.map_or(String::new(), |run| {
        let trials = grouped(run.trials);
        say!("{trials} trials, seed {}", run.seed).in_language(l)
    })
}

/// What the claims say besides figures, each once.
fn notes(rows: &[Row]) -> Vec<String> {
    let mut notes: Vec<String> = Vec::new();
    for claim in rows.iter().flat_map(|row| &row.budget.claims) {
        let words: Vec<&str> = [&claim.reference, &claim.note]
            .into_iter()
            .flatten()
            .map(String::as_str)
            .collect();
        let note = words.join("; ");
        if !note.is_empty() && !notes.contains(&note) {
            notes.push(note);
        }
    }
    notes
}

/// A row of a series as a report, for the words that reports have.
pub(super) fn report(row: &Row, language: Language) -> Report<'_> {
    Report {
        budget: &row.budget,
        evaluation: &row.evaluation,
        label: row.label.as_deref(),
        language,
    }
}

fn table(rows: &[Row], l: Language) -> Table {
    let mut table = Table::new([
        (Word::Row.of(l), ColumnKind::Names),
        (l.pick("figure", "量"), ColumnKind::Wrapped),
        (l.pick("method", "方法"), ColumnKind::Wrapped),
        (Word::Unit.of(l), ColumnKind::Names),
        (l.pick("published", "发表值"), ColumnKind::Numbers),
        (Word::Obtained.of(l), ColumnKind::Numbers),
        (l.pick("difference", "差值"), ColumnKind::Numbers),
        (l.pick("tolerance", "允差"), ColumnKind::Numbers),
        (l.pick("digits", "正确位数"), ColumnKind::Numbers),
        (l.pick("verdict", "结论"), ColumnKind::Wrapped),
    ]);
    for row in rows {
        for (n, comparison) in row.comparisons.iter().enumerate() {
            let label = row.label.as_deref().filter(|_| n == 0);
            let mut cells: Vec<Cell> = vec![label.unwrap_or_default().into()];
            cells.extend(line(row, comparison, l));
            table.push(cells);
        }
    }
    table.without_empty_columns()
}

fn line(row: &Row, comparison: &Comparison, l: Language) -> Vec<Cell> {
    let report = report(row, l);
    let what = &comparison.claimed.what;
    let asked = row
        .digits_wanted(comparison)
        .filter(|digits| is_by_digits(comparison, *digits));
    // Digits beyond the tolerance show what rounding hides.
    let stated = Decimal::from_f64(comparison.claimed.value).place();
    let place = match (asked, stated) {
        (Some(_), Some(stated)) => stated - 1,
        _ => last_place(comparison) - 2,
    };
    let obtained = comparison.obtained.map_or_else(
        || NONE.to_string(),
        |value| claim::number(what, value, place, l),
    );
    vec![
        name(&report, comparison).into(),
        claim::method(comparison.method, l).into(),
        unit(&report, comparison).into(),
        claim::published(comparison, l).into(),
        obtained.into(),
        comparison
            .difference()
            .map_or(Cell::Empty, |d| significant(d, 2).into()),
        tolerance(comparison, asked, l).into(),
        asked
            .and_then(|_| comparison.log_relative_error())
            .map_or(Cell::Empty, |digits| print(&at_place(digits, -1)).into()),
        verdict(row, comparison, l).into(),
    ]
}

/// The figure in words, with the measurand where there are several.
pub(super) fn name(report: &Report<'_>, comparison: &Comparison) -> String {
    let what = &comparison.claimed.what;
    let label = claim::label(report, what);
    let own = !matches!(
        what,
        Figure::Named(_)
            | Figure::Input(
                _,
                Part::Estimate | Part::StandardUncertainty | Part::DegreesOfFreedom
            )
    );
    match measurand(report, comparison) {
        Some(name) if own && report.evaluation.results.len() > 1 => format!("{name}, {label}"),
        _ => label,
    }
}

/// The measurand that the claim is about.
pub(super) fn measurand<'a>(report: &Report<'a>, comparison: &Comparison) -> Option<&'a str> {
    let claim = report.budget.claims.get(comparison.claim)?;
    let output = report.budget.model.outputs().get(claim.measurand)?;
    Some(&output.name)
}

/// Unit of a figure; nothing for the unit one.
pub(super) fn unit(report: &Report<'_>, comparison: &Comparison) -> String {
    let claim = report.budget.claims.get(comparison.claim);
    let Some(output) = claim.and_then(|c| report.budget.model.outputs().get(c.measurand)) else {
        return String::new();
    };
    let of_input = |unit: Option<&Unit>, part: Part| match (unit, part) {
        (_, Part::DegreesOfFreedom) | (None, _) => String::new(),
        (Some(unit), Part::Estimate) => symbol(unit),
        (Some(unit), Part::StandardUncertainty) => symbol(unit),
        (Some(_), Part::Contribution) => symbol(&output.unit),
        (Some(unit), Part::Sensitivity) => match (symbol(&output.unit), symbol(unit)) {
            (above, below) if below.is_empty() => above,
            (above, below) if above.is_empty() => format!("1/{below}"),
            (above, below) if above == below => String::new(),
            (above, below) => format!("{above}/{below}"),
        },
    };
    match &comparison.claimed.what {
        Figure::Estimate
        | Figure::Lower
        | Figure::Upper
        | Figure::ShortestLower
        | Figure::ShortestUpper
        | Figure::AtLeast
        | Figure::AtMost => symbol(&output.unit),
        Figure::StandardUncertainty | Figure::ExpandedUncertainty | Figure::Shift => {
            symbol(&output.unit)
        }
        Figure::Input(index, part) => {
            of_input(report.budget.inputs.get(*index).map(|i| &i.unit), *part)
        }
        Figure::Component(index, part) => {
            of_input(report.budget.components.get(*index).map(|c| &c.unit), *part)
        }
        Figure::Named(name) => {
            let mut figures = report.evaluation.figures.iter();
            let figure = figures.find(|figure| figure.name == *name);
            figure.map_or(String::new(), |figure| symbol(&figure.unit))
        }
        Figure::Variance => match symbol(&output.unit) {
            unit if unit.is_empty() => unit,
            unit => format!("({unit})²"),
        },
        Figure::Covariance(_)
        | Figure::RelativeUncertainty
        | Figure::RelativeExpanded
        | Figure::CoverageFactor
        | Figure::DegreesOfFreedom
        | Figure::CoverageProbability
        | Figure::Correlation(_)
        | Figure::Ellipsoid
        | Figure::Rectangle
        | Figure::RegionFreedom
        | Figure::Validated(_) => String::new(),
    }
}

/// Whether the tolerance comes from the digits that the claim asks for, and not from the file's own words.
pub(super) fn is_by_digits(comparison: &Comparison, digits: u8) -> bool {
    let scale = match comparison.claimed.value {
        0.0 => 1.0,
        value => value.abs(),
    };
    let expected = scale * 10f64.powi(-i32::from(digits));
    (comparison.claimed.tolerance - expected).abs() <= 1e-6 * expected
}

fn tolerance(comparison: &Comparison, asked: Option<u8>, l: Language) -> String {
    if let Some(digits) = asked {
        return say!("{digits} digits").in_language(l);
    }
    if matches!(comparison.claimed.what, Figure::Validated(_)) {
        return String::new();
    }
    let rounded =
        Decimal::from_f64(comparison.claimed.tolerance).round_to_significant(2, Rounding::HalfEven);
    exact(rounded.to_f64())
}

fn verdict(row: &Row, comparison: &Comparison, l: Language) -> String {
    let verdict = if comparison.obtained.is_none() {
        l.pick("no such figure", "无此数值")
    } else if comparison.is_near() {
        l.pick("agrees", "一致")
    } else if comparison.agrees() {
        l.pick("agrees when rounded", "修约后一致")
    } else {
        l.pick("DIFFERS", "不一致")
    };
    if row.gates(comparison) {
        verdict.to_string()
    } else {
        say!("{verdict} (not gating)").in_language(l)
    }
}
