//! Calibrations of many recordings: one line each, in the columns of a batch.

use gumption_fault::Rejection;
use gumption_lab::calibrate::{Calibration, Campaign, Trouble};

use super::calibration_trouble;
use crate::batch::{Lines, refused};
use crate::language::Language;
use crate::rows::{Head, in_unit};

/// Why a recording gives no coefficients.
#[derive(Debug)]
pub enum Unusable {
    /// It, or the experiment with it, has faults.
    Refused(Box<Rejection>),
    /// It does not tell them.
    Trouble(Trouble),
}

/// Adds the line of a recording: its name, of each coefficient estimate, u, ν, k and U, of each response the standard deviation of
/// its residuals, and the error of one that gives none.
pub fn recording(
    lines: &mut Lines,
    label: &str,
    found: Result<(&Campaign, &Calibration), &Unusable>,
    language: Language,
) {
    let found = found.map(|(campaign, found)| {
        let numbers = numbers(campaign, found);
        let (mut heads, cells): (Vec<Head>, Vec<Option<f64>>) = numbers.unzip();
        heads.insert(0, Head::texts("label"));
        heads.push(Head::texts("error"));
        (heads, cells)
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
    all.map(|(head, number)| {
        (
            Head::numbers(head),
            Some(number).filter(|number| !number.is_nan()),
        )
    })
}
