//! Why the solver found nothing, in the user's words and at the user's lines.

use std::ops::Range;

use super::super::Checker;
use super::super::draft::show;
use super::columns::Column;
use super::formula::Formula;
use crate::budget::faults::{FIT_ERRORS, FIT_FAILED, FIT_INDISTINCT, FIT_POINTS, NOT_SEMIDEFINITE};
use crate::budget::fit::column_of;
use crate::budget::table::Stated;
use crate::budget::tables::FitTable;
use crate::budget::variants::Numbers;
use crate::fault::Fault;
use crate::least_squares::Failure;

impl Checker<'_> {
    /// Reports why there is no solution. The columns are in the order of the solver: response first.
    pub(super) fn fit_failure<T>(
        &mut self,
        name: &str,
        stated: &Stated<FitTable>,
        formula: &Formula,
        columns: &[&Column<'_>],
        failure: &Failure,
    ) -> Option<T> {
        let at = formula.place.clone();
        let names = |indices: &[usize]| -> Vec<String> {
            indices
                .iter()
                .filter_map(|index| formula.parameters.get(*index))
                .map(|parameter| parameter.name.clone())
                .collect()
        };
        let fault = match failure {
            Failure::TooFewPoints { points, parameters } => Fault::new(
                FIT_POINTS,
                data_place(stated),
                format!("{} for {}", count(*points, "point"), count(*parameters, "parameter")),
            )
            .label(format!("at least {} are needed", count(*parameters, "point")))
            .related(at, format!("{} to be found", count(*parameters, "parameter")))
            .help("take more points, or a formula with fewer parameters"),
            Failure::NoFreedom { points } => Fault::new(
                FIT_POINTS,
                data_place(stated),
                format!("{} for as many parameters", count(*points, "point")),
            )
            .label("no residuals are left to tell how far the points may be off")
            .help(format!(
                "take more points, or state the uncertainty of the response: {} = {{ …, u = … }}",
                columns[0].name
            )),
            Failure::NoUncertainty => Fault::new(
                FIT_ERRORS,
                stated.value.scale.as_ref().map_or(at, |scale| scale.span.clone()),
                format!("no column of the fit {name} states an uncertainty"),
            )
            .label("nothing is stated")
            .help(format!(
                "state the uncertainty of the response, {} = {{ …, u = … }}, or leave out `scale`: the residuals then tell it",
                columns[0].name
            )),
            Failure::Uncertainty { observed, point } => {
                let column = columns[column_of(*observed)];
                let help = if column_of(*observed) == 0 {
                    "an exact point would have to lie on the curve; state what it may be off"
                } else {
                    "state what it may be off, or no uncertainty at all for the column"
                };
                Fault::new(
                    FIT_ERRORS,
                    value_place(column, *point),
                    format!("the uncertainty of value {} of {} is not greater than zero", point + 1, column.name),
                )
                .label("no uncertainty")
                .help(help)
            }
            Failure::Correlation { point } => {
                let list = stated.value.correlation.as_ref();
                let place = list
                    .and_then(|list| list.value.get(*point))
                    .map_or(at, |r| r.span.clone());
                Fault::new(
                    FIT_ERRORS,
                    place,
                    format!("the correlation coefficient of point {} is not possible", point + 1),
                )
                .label("must be between -1 and 1")
                .help("at 1 or -1 the errors may leave the point nowhere to go across the curve")
            }
            Failure::Covariance { observed } => {
                let column = columns[column_of(*observed)];
                let place = column
                    .table
                    .covariance
                    .as_ref()
                    .map_or(column.key.clone(), |stated| stated.span.clone());
                Fault::new(
                    NOT_SEMIDEFINITE,
                    place,
                    format!("the values of {} cannot have this covariance matrix", column.name),
                )
                .label("not positive definite")
                .help("check the signs, and that |covariance| does not exceed the product of the standard uncertainties; causes common to all points stand in `components`")
            }
            Failure::Indistinct { parameters } => {
                let names = names(parameters);
                Fault::new(
                    FIT_INDISTINCT,
                    at,
                    format!("the data do not tell {} apart", names.join(" and ")),
                )
                .label("they can change together and leave the curve as it is")
                .related(data_place(stated), "at these points")
                .help(match names.as_slice() {
                    [one] => format!("{one} does not act at these points: leave it out of the formula, or add points where it does"),
                    _ => format!("leave out one of {}, or add points where they act differently", names.join(", ")),
                })
            }
            Failure::Undefined { point } => Fault::new(
                FIT_FAILED,
                at,
                format!("the formula of the fit {name} has no finite value at point {}", point + 1),
            )
            .label("at the start values of its parameters")
            .related(value_place(columns[columns.len() - 1], *point), "this point")
            .help("choose start values for which every point has a value"),
            Failure::NoConvergence { iterations, parameters } => {
                let best: Vec<String> = formula
                    .parameters
                    .iter()
                    .zip(parameters)
                    .map(|(parameter, value)| format!("{} = {}", parameter.name, show(*value)))
                    .collect();
                Fault::new(
                    FIT_FAILED,
                    at,
                    format!("the fit {name} was not found within {}", count(*iterations, "step")),
                )
                .label("the search does not settle")
                .help(format!(
                    "choose other start values; it stopped at {}",
                    best.join(", ")
                ))
            }
            Failure::NotFinite { .. } | Failure::Shape | Failure::NoStart => Fault::new(
                FIT_FAILED,
                at,
                format!("the fit {name} has no finite values at all its points"),
            )
            .label("not defined everywhere")
            .help("check the formula at the smallest and largest values of the columns"),
        };
        self.refuse(fault)
    }
}

/// The place of a value of a column.
fn value_place(column: &Column<'_>, point: usize) -> Range<usize> {
    let listed = column
        .table
        .values
        .as_ref()
        .and_then(|stated| match &stated.value {
            Numbers::List(list) => list.get(point).map(|number| number.span.clone()),
            Numbers::Lists(_) | Numbers::Column(_) => Some(stated.span.clone()),
        });
    listed.unwrap_or_else(|| column.key.clone())
}

/// The place of the header of the data.
fn data_place(stated: &Stated<FitTable>) -> Range<usize> {
    stated
        .value
        .data
        .as_ref()
        .map_or(stated.key.clone(), |data| data.key.clone())
}

/// `1 point`, `3 points`.
fn count(n: usize, noun: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {noun}{plural}")
}
