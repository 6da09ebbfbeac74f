//! Calibrations of many recordings: one line each, in the columns of a batch.

use gumption_lab::calibrate::{Calibration, Campaign, Contribution, Origin, Unusable};

use super::calibration_trouble;
use super::causes::origin_name;
use super::misfit::codes;
use crate::batch::{Figures, Lines, refused};
use crate::language::Language;
use crate::rows::{Head, in_unit};

/// Columns that lines of recordings have on request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordingColumns {
    /// The share of each cause in the variance of each coefficient.
    pub shares: bool,
    /// The language in which errors are told.
    pub language: Language,
}

/// Adds the line of a recording: its name, of each coefficient estimate, u, ν, k and U, of each response the standard deviation of
/// its residuals, the shares, what is doubtful in it, and the error of one that gives none.
pub fn recording(
    lines: &mut Lines,
    label: &str,
    found: Result<(&Campaign, &Calibration), &Unusable>,
    RecordingColumns { shares, language }: RecordingColumns,
) {
    let found = found.map(|(campaign, found)| {
        let shares = shares.then(|| self::shares(campaign, found));
        let numbers = numbers(campaign, found).chain(shares.into_iter().flatten());
        let (mut heads, numbers): (Vec<Head>, Vec<Option<f64>>) = numbers.unzip();
        heads.insert(0, Head::texts("label"));
        heads.extend(["findings", "error"].map(Head::texts));
        Figures {
            heads,
            numbers,
            findings: codes(campaign, found),
        }
    });
    let found = found.map_err(|unusable| match unusable {
        Unusable::Refused(rejection) => refused(rejection, language),
        Unusable::Trouble(trouble) => {
            let code = trouble
                .code()
                .map_or(String::new(), |code| format!("{}: ", code.id));
            let why = calibration_trouble(trouble, language);
            format!("{code}{}", why.replace('\n', " "))
        }
    });
    lines.push(label, found);
}

fn numbers(campaign: &Campaign, found: &Calibration) -> impl Iterator<Item = (Head, Option<f64>)> {
    let coefficients = found.figures.coefficients.iter().flat_map(|one| {
        let (name, unit) = (&one.name, one.unit.difference());
        let head = |letter: &str| format!("{letter}({name})");
        [
            (in_unit(name.clone(), &one.unit), one.value),
            (in_unit(head("u"), &unit), one.u),
            (head("nu"), one.dof),
            (head("k"), one.k),
            (in_unit(head("U"), &unit), one.k * one.u),
        ]
    });
    let responses = campaign.experiment.equations.responses().iter();
    let responses = responses.zip(&found.responses).map(|(response, scatter)| {
        let head = format!("s({})", scatter.response);
        (in_unit(head, &response.unit.difference()), scatter.s)
    });
    let all = coefficients.chain(responses);
    all.map(|(head, number)| (Head::numbers(head), known(number)))
}

/// Of each coefficient the share of every cause that the experiment has; of one that a recording does not show, none.
fn shares(campaign: &Campaign, found: &Calibration) -> Vec<(Head, Option<f64>)> {
    let origins = campaign.origins();
    let coefficients = found.figures.coefficients.iter().enumerate();
    let shares = coefficients.flat_map(|(at, one)| {
        let contributions: Vec<Contribution<'_>> = found.figures.contributions(at).collect();
        let share = move |origin: &Origin| {
            let own = contributions
                .iter()
                .find(|part| part.cause.origin == *origin);
            // Names of columns do not depend on the language.
            let cause = origin_name(origin, Language::English);
            let head = Head::numbers(format!("share({}, {cause})", one.name));
            (head, known(own.map_or(0.0, |part| part.share)))
        };
        origins.iter().map(share)
    });
    shares.collect()
}

fn known(number: f64) -> Option<f64> {
    Some(number).filter(|number| !number.is_nan())
}
