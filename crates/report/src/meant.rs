//! Verdicts that may come from a comparison that was not meant, as sentences.

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
        true => l.pick(
            "give the measurand unit = \"K\" and leave out `nominal`".to_string(),
            "请将被测量的单位写为 unit = \"K\"，并去掉 nominal".to_string(),
        ),
        false => l.pick(
            format!("write mpe_of = \"{nominal}\" in place of `nominal`"),
            format!("请以 mpe_of = \"{nominal}\" 代替 nominal"),
        ),
    };
    l.pick(
        format!("{name}: {value} is compared with the nominal value {nominal} and not found to conform, but lies nearer to zero. If it is the error of indication at {nominal}, {mend}: its limits are then ±mpe."),
        format!("{name}：{value} 与标称值 {nominal} 比较，结论不是合格，但该值更接近零。若它是在 {nominal} 处的示值误差，{mend}，此时容许区间为 ±mpe。"),
    )
}

fn indication(
    report: &Report<'_>,
    figures: &Figures<'_>,
    (name, ratio, of): (&str, f64, Option<f64>),
) -> String {
    let (l, value, ratio) = (report.language, figures.value(), significant(ratio, 2));
    let mend = match of.map(|of| of_unit(figures, of)) {
        Some(of) => l.pick(
            format!("write nominal = \"{of}\" in place of `mpe_of`"),
            format!("请以 nominal = \"{of}\" 代替 mpe_of"),
        ),
        None => l.pick(
            "add its `nominal` value".to_string(),
            "请补充其标称值 nominal".to_string(),
        ),
    };
    l.pick(
        format!("{name}: {value} is compared with zero, as an error of indication is, and is {ratio} times the maximum permissible error. If it is the quantity itself, {mend}: its limits are then nominal ± mpe."),
        format!("{name}：{value} 按示值误差与零比较，为最大允许误差的 {ratio} 倍。若它是量本身的值，{mend}，此时容许区间为 nominal ± mpe。"),
    )
}

fn of_unit(figures: &Figures<'_>, number: f64) -> String {
    with_unit(&exact(number), &symbol(figures.unit))
}
