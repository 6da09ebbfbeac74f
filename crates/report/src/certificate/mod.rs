//! The data of a digital certificate, from an evaluation and from the file of the laboratory.

mod file;
mod head;
mod number;
mod tables;

pub use file::{
    administration, certificate_keys, certificate_schema, certificate_template, template_names,
};
pub use head::certified;

use gumption_core::quantity::{Decimal, Unit};
use gumption_fault::say;
use gumption_format::document::{
    Certificate, Certified, CertifiedConformity, CertifiedPoint, CertifiedUncertainty,
    CertifiedVerdict, Reference, Region, Told,
};
use gumption_gum::budget::profile_named;
use gumption_gum::propagate::{CoverageBasis, ReportedUncertainty, StatedProbability, Verdict};

use crate::Report;
use crate::decisions::{self, Decided};
use crate::figures::Figures;
use crate::number::{at_place, print};
use crate::statement::{Coefficients, states_result};
use number::Notation;

/// The certificate of the rows of one file, with the sentences that it states; nothing of none.
pub(crate) fn of(rows: &[Report<'_>], statement: Vec<String>) -> Option<Certificate> {
    let first = rows.first()?;
    let l = first.language;
    let heading = &first.budget.heading;
    let measurands = 0..first.evaluation.results.len();
    let stated: Vec<usize> = measurands.filter(|m| states_result(first, *m)).collect();
    let results = stated.iter().filter_map(|m| of_measurand(rows, *m));
    let profile = profile_named(&first.budget.conventions.profile);
    Some(Certificate {
        languages: vec![l],
        administration: None,
        title: match (heading.titled(l), &heading.title_zh) {
            ("", _) => Told::default(),
            (title, Some(_)) => Told::in_language(l, title),
            (title, None) => Told::everywhere(title),
        },
        method: heading.method.as_ref().map(Told::everywhere),
        guide: profile.map_or_else(String::new, |profile| profile.source.to_owned()),
        statement: statement
            .into_iter()
            .map(|sentence| Told::in_language(l, sentence))
            .collect(),
        results: results.collect(),
        region: match (rows, stated.len() == first.evaluation.results.len()) {
            ([one], true) => region(one),
            _ => None,
        },
        measured: heading.date.clone(),
        references: references(first),
        attachments: Vec::new(),
    })
}

/// Certificates of what was used that are valid up to a day.
fn references(report: &Report<'_>) -> Vec<Reference> {
    let components = report.budget.components.iter();
    let valid = components.filter_map(|component| {
        let certificate = component.certificate.as_ref()?;
        Some(Reference {
            of: component.name.to_string(),
            number: certificate.number.clone(),
            due: certificate.due.clone()?,
        })
    });
    valid.collect()
}

fn of_measurand(rows: &[Report<'_>], measurand: usize) -> Option<Certified> {
    let first = &rows[0];
    let (name, unit) = first.measurand(measurand);
    let notation = Notation::of(unit)?;
    let points = rows.iter().map(|row| point(row, measurand, &notation));
    let about = &first.budget.measurands[measurand].description;
    Some(Certified {
        name: name.to_owned(),
        description: about.as_ref().map(Told::everywhere),
        unit: notation.unit.clone(),
        deviation_unit: notation.deviation_unit.clone(),
        conformity: conformity(rows, measurand),
        points: points.collect(),
    })
}

/// Once for all points where they have one tolerance, one rule and a verdict each; else for each point by itself.
fn conformity(rows: &[Report<'_>], measurand: usize) -> Vec<CertifiedConformity> {
    let l = rows[0].language;
    let decided: Vec<Vec<Decided<'_>>> = rows
        .iter()
        .map(|row| decisions::decided(row, measurand))
        .collect();
    let rule = |one: &Decided<'_>| {
        say!("Tolerance {}. Decision rule: {}.", one.tolerance, one.rule).in_language(l)
    };
    let said = |point: Option<&str>, one: &Decided<'_>, verdicts: Vec<CertifiedVerdict>| {
        let withheld = l.pick(" No verdict.", "不作判定。");
        let withheld = if verdicts.is_empty() { withheld } else { "" };
        CertifiedConformity {
            name: one.name.to_owned(),
            point: point.map(str::to_owned),
            rule: Told::in_language(l, format!("{}{withheld}", rule(one))),
            verdicts,
        }
    };
    let items = decided.iter().map(Vec::len).max().unwrap_or(0);
    let of_item = |at: usize| {
        let each: Vec<(&Report<'_>, &Decided<'_>)> = (rows.iter().zip(&decided))
            .filter_map(|(row, decided)| Some((row, decided.get(at)?)))
            .collect();
        let verdicts: Option<Vec<CertifiedVerdict>> =
            each.iter().map(|(_, one)| verdict(one)).collect();
        let is_of_all = each.len() == rows.len();
        let is_alike = |(_, one): &(_, &Decided<'_>)| {
            let first = each[0].1;
            (one.name, &one.tolerance, &one.rule) == (first.name, &first.tolerance, &first.rule)
        };
        match verdicts.filter(|_| is_of_all && each.iter().all(is_alike)) {
            Some(verdicts) => vec![said(None, each[0].1, verdicts)],
            None => (each.iter())
                .map(|(row, one)| {
                    let verdicts = verdict(one).into_iter().collect();
                    said(row.label, one, verdicts)
                })
                .collect(),
        }
    };
    (0..items).flat_map(of_item).collect()
}

fn verdict(decided: &Decided<'_>) -> Option<CertifiedVerdict> {
    Some(match (decided.verdict?, decided.inside) {
        (Verdict::Conforming, _) => CertifiedVerdict::Pass,
        (Verdict::NotConforming, _) => CertifiedVerdict::Fail,
        (Verdict::Undecided, true) => CertifiedVerdict::ConditionalPass,
        (Verdict::Undecided, false) => CertifiedVerdict::ConditionalFail,
        (Verdict::Withheld, _) => return None,
    })
}

fn point(row: &Report<'_>, measurand: usize, notation: &Notation) -> CertifiedPoint {
    let figures = Figures::new(row, measurand);
    let reported = &figures.reported;
    let p = match reported.probability {
        StatedProbability::Of(p) => Some(notation.plain(p)),
        _ => None,
    };
    let ends = |ends: [String; 2]| ends.map(|end| notation.printed_value(&end));
    // The D-SI has no factors below one.
    let k = figures
        .k()
        .filter(|_| reported.coverage_factor().is_some_and(|k| k >= 1.0));
    let mut value = notation.printed_value(&figures.estimate());
    let result = notation.result(&figures).filter(|_| k.is_some());
    let uncertainty = match (
        figures.expanded(),
        result.zip(k.clone()),
        figures.interval(),
    ) {
        (Some(_), Some(([estimate, expanded], k)), _) => {
            value = estimate;
            CertifiedUncertainty::Expanded {
                expanded,
                k,
                p,
                distribution: distribution(row, measurand, reported.uncertainty),
            }
        }
        (Some(expanded), None, _) => {
            // Half an interval, of a distribution without a standard deviation.
            let number = |text: &str| Decimal::from_text(text).filter(Decimal::is_finite);
            let ends =
                number(&expanded)
                    .zip(number(&figures.estimate()))
                    .and_then(|(half, value)| {
                        let place = half.place()?;
                        let end = |end: f64| notation.printed_value(&print(&at_place(end, place)));
                        let (half, value) = (half.to_f64(), value.to_f64());
                        Some([end(value - half), end(value + half)])
                    });
            match ends {
                Some(ends) => CertifiedUncertainty::Interval {
                    standard: None,
                    ends,
                    p,
                },
                None => CertifiedUncertainty::None,
            }
        }
        (None, _, Some(interval)) => CertifiedUncertainty::Interval {
            standard: figures.u().map(|u| notation.printed_deviation(&u)),
            ends: ends(interval),
            p,
        },
        (None, _, None) => CertifiedUncertainty::None,
    };
    let freedom = figures.freedom().filter(|freedom| freedom != "∞");
    CertifiedPoint {
        label: row.label.unwrap_or_default().to_owned(),
        value,
        uncertainty,
        freedom: freedom.filter(|_| k.is_some()),
    }
}

/// What k was taken from, where it was.
fn distribution(
    row: &Report<'_>,
    measurand: usize,
    uncertainty: ReportedUncertainty,
) -> Option<String> {
    let basis = row.evaluation.results[measurand].gum.coverage.named_basis();
    match (uncertainty, basis) {
        (ReportedUncertainty::Multiple { .. }, CoverageBasis::Normal) => Some("normal".into()),
        (ReportedUncertainty::Multiple { .. }, CoverageBasis::StudentT { .. }) => {
            Some("Student-t".into())
        }
        _ => None,
    }
}

/// The covariance of all measurands with the ellipsoid that covers them.
fn region(report: &Report<'_>) -> Option<Region> {
    let joint = report.evaluation.joint.as_ref()?;
    if joint.degenerate {
        return None;
    }
    let trials = joint
        .monte_carlo_covariance
        .as_ref()
        .zip(joint.regions.as_ref());
    let (matrix, k) = match (Coefficients::of(report), trials) {
        (Coefficients::MonteCarlo, Some((matrix, regions))) => (matrix, regions.k_ellipsoid),
        (Coefficients::Gum, _) => (&joint.covariance, joint.k_ellipsoid),
        _ => return None,
    };
    if !(k.is_finite() && k >= 1.0 && matrix.iter().all(|x| x.is_finite())) {
        return None;
    }
    let unit = |at: usize| report.measurand(at).1.difference();
    let entry = |row: usize, column: usize| {
        let unit: Unit = unit(row).product(&unit(column));
        let notation = Notation::of(&unit)?;
        Some((
            notation.deviation(matrix[(row, column)]),
            notation.unit.clone(),
        ))
    };
    let n = matrix.nrows();
    let columns = (0..n).map(|column| (0..n).map(|row| entry(row, column)).collect());
    let one = Notation::of(&Unit::one())?;
    Some(Region {
        columns: columns.collect::<Option<_>>()?,
        k: at_place(k, -3).print_plain(),
        p: one.plain(report.coverage_probability()),
    })
}
