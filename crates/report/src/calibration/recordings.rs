//! Calibrations of many recordings: one line each, in the columns of a batch.

use gumption_core::quantity::{Conversion, Unit};
use gumption_lab::calibrate::{Calibration, Campaign, Contribution, Origin, Unusable};

use super::calibration_trouble;
use super::causes::origin_name;
use super::misfit::codes;
use crate::batch::{Figures, Lines, refused};
use crate::language::Language;
use crate::rows::{Head, in_unit};

/// The columns of lines of recordings.
#[derive(Debug)]
pub struct RecordingColumns {
    shares: bool,
    language: Language,
    /// The units of coefficients and responses: those of the first recording that gives coefficients.
    units: Option<Vec<Unit>>,
}

impl RecordingColumns {
    /// With the share of each cause in the variance of each coefficient, or without; errors are told in this language.
    pub fn new(shares: bool, language: Language) -> RecordingColumns {
        RecordingColumns {
            shares,
            language,
            units: None,
        }
    }

    /// The units of the columns below which the figures of a recording stand, each with the conversion into it. Where there is
    /// none, the unit is its own.
    fn units(&mut self, own: Vec<Unit>) -> Vec<(Unit, Conversions)> {
        let wanted = self.units.get_or_insert_with(|| own.clone());
        let column = |(at, own): (usize, Unit)| {
            let wanted = wanted.get(at).unwrap_or(&own);
            match Conversions::between(&own, wanted) {
                Some(conversions) => (wanted.clone(), conversions),
                None => (own, Conversions::default()),
            }
        };
        own.into_iter().enumerate().map(column).collect()
    }
}

/// How figures of a recording come into the units of the columns: values, and differences of them. Nothing is done where nothing
/// has to be, so that they stay as they are to the last bit.
#[derive(Debug, Default)]
struct Conversions {
    value: Option<Conversion>,
    difference: Option<Conversion>,
}

impl Conversions {
    fn between(own: &Unit, wanted: &Unit) -> Option<Conversions> {
        let value = own.conversion_to(wanted)?;
        let difference = own.difference().conversion_to(&wanted.difference())?;
        let needed = |one: Conversion| (!one.is_identity()).then_some(one);
        Some(Conversions {
            value: needed(value),
            difference: needed(difference),
        })
    }
}

fn converted(number: f64, conversion: Option<Conversion>) -> f64 {
    conversion.map_or(number, |conversion| conversion.apply(number))
}

/// Adds the line of a recording: its name, of each coefficient estimate, u, ν, k and U, of each response the standard deviation of
/// its residuals, the shares, what is doubtful in it, and the error of one that gives none. Figures are converted into the units of
/// the first.
pub fn recording(
    lines: &mut Lines,
    label: &str,
    found: Result<(&Campaign, &Calibration), &Unusable>,
    columns: &mut RecordingColumns,
) {
    let language = columns.language;
    let found = found.map(|(campaign, found)| {
        let shares = columns.shares.then(|| self::shares(campaign, found));
        let numbers = numbers(campaign, found, columns).chain(shares.into_iter().flatten());
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

fn numbers(
    campaign: &Campaign,
    found: &Calibration,
    columns: &mut RecordingColumns,
) -> impl Iterator<Item = (Head, Option<f64>)> {
    let coefficients = &found.figures.coefficients;
    let responses = campaign.experiment.equations.responses().iter();
    let own = coefficients.iter().map(|one| one.unit.clone());
    let own = own.chain(responses.map(|response| response.unit.clone()));
    let mut units = columns.units(own.collect()).into_iter();
    let of_coefficients: Vec<_> = units.by_ref().take(coefficients.len()).collect();
    let figures = coefficients.iter().zip(of_coefficients);
    let figures = figures.flat_map(|(one, (unit, Conversions { value, difference }))| {
        let (name, deviation) = (&one.name, unit.difference());
        let head = |letter: &str| format!("{letter}({name})");
        [
            (in_unit(name.clone(), &unit), converted(one.value, value)),
            (in_unit(head("u"), &deviation), converted(one.u, difference)),
            (head("nu"), one.dof),
            (head("k"), one.k),
            (
                in_unit(head("U"), &deviation),
                converted(one.k * one.u, difference),
            ),
        ]
    });
    let scatters = units.zip(&found.responses).map(|((unit, of), scatter)| {
        let head = in_unit(format!("s({})", scatter.response), &unit.difference());
        (head, converted(scatter.s, of.difference))
    });
    let all = figures.chain(scatters);
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
