//! Verdicts that may come from a comparison that was not meant, as sentences.

use gumption_fault::say;
use gumption_gum::propagate::FindingKind;

use super::figures::{Figures, with_unit};
use super::number::{exact, significant};
use super::{Report, symbol};

/// What the value is compared with, and how the file says the other; nothing for other findings.
pub(super) fn sentence(
    report: &Report<'_>,
    measurand: Option<usize>,
    kind: &FindingKind,
) -> String {
    let Some(figures) = measurand.map(|measurand| Figures::new(report, measurand)) else {
        return String::new();
    };
    match kind {
        FindingKind::ErrorMeant {
            assessment,
            nominal,
        } => error(report, &figures, (assessment, *nominal)),
        FindingKind::IndicationMeant {
            assessment,
            ratio,
            of,
        } => indication(report, &figures, (assessment, *ratio, *of)),
        _ => String::new(),
    }
}

fn error(report: &Report<'_>, figures: &Figures<'_>, found: (&str, f64)) -> String {
    let (l, value) = (report.language, figures.value());
    let (name, nominal) = (found.0, of_unit(figures, found.1));
    // An error is a difference; of a temperature in °C it is in K, and a part of that temperature means nothing.
    let mend = match figures.unit.is_point() {
        true => say!("give the measurand unit = \"K\" and leave out `nominal`").in_language(l),
        false => say!("write mpe_of = \"{nominal}\" in place of `nominal`").in_language(l),
    };
    say!("{name}: {value} is compared with the nominal value {nominal} and not found to conform, but lies nearer to zero. If it is the error of indication at {nominal}, {mend}: its limits are then ±mpe.").in_language(l)
}

fn indication(
    report: &Report<'_>,
    figures: &Figures<'_>,
    (name, ratio, of): (&str, f64, Option<f64>),
) -> String {
    let (l, value, ratio) = (report.language, figures.value(), significant(ratio, 2));
    let mend = match of.map(|of| of_unit(figures, of)) {
        Some(of) => say!("write nominal = \"{of}\" in place of `mpe_of`").in_language(l),
        None => say!("state its `nominal` value with `mpe`").in_language(l),
    };
    say!("{name}: {value} is compared with zero, as an error of indication is, and is {ratio} times the maximum permissible error. If it is the quantity itself, {mend}: its limits are then nominal ± mpe.").in_language(l)
}

fn of_unit(figures: &Figures<'_>, number: f64) -> String {
    with_unit(&exact(number), &symbol(figures.unit))
}
