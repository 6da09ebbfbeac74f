//! Why the solver found nothing, in the user's words and at the user's lines.

use std::ops::Range;

use super::super::draft::show;
use super::columns::Column;
use super::formula::Formula;
use crate::budget::faults::{FIT_ERRORS, FIT_FAILED, FIT_INDISTINCT, FIT_POINTS, NOT_SEMIDEFINITE};
use crate::budget::fit::column_of;
use crate::budget::tables::FitTable;
use crate::budget::variants::Numbers;
use gumption_core::least_squares::{Elsewhere, Failure, Observed};
use gumption_core::quantity::{Decimal, Rounding};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Stated;

/// A fit that has no solution.
pub(super) struct Unsolved<'f> {
    /// Name of the fit.
    pub name: &'f str,
    pub stated: &'f Stated<FitTable>,
    pub formula: &'f Formula,
    /// In the order of the solver: response first.
    pub columns: &'f [&'f Column<'f>],
    /// Minima that other starts lead to, the best first.
    pub elsewhere: Vec<Elsewhere>,
}

impl Unsolved<'_> {
    /// The failure in words of the file.
    pub fn fault(&self, failure: &Failure) -> Fault {
        match failure {
            Failure::TooFewPoints { points, parameters } => {
                self.too_few_points(*points, *parameters)
            }
            Failure::NoFreedom { points } => self.no_freedom(*points),
            Failure::NoUncertainty => self.no_uncertainty(),
            Failure::Uncertainty { observed, point } => self.exact_value(*observed, *point),
            Failure::Correlation { point } => self.correlation(*point),
            Failure::Covariance { observed } => self.covariance(*observed),
            Failure::Indistinct { parameters } => self.indistinct(parameters),
            Failure::Undefined { point } => self.undefined(*point),
            Failure::NoConvergence {
                iterations,
                parameters,
            } => self.no_convergence(*iterations, parameters),
            Failure::NotFinite { .. } | Failure::Shape | Failure::NoStart => self.not_finite(),
        }
    }

    fn too_few_points(&self, points: usize, parameters: usize) -> Fault {
        let message = say!(
            "{} for {}",
            self::points(points),
            self::parameters(parameters)
        );
        Fault::new(FIT_POINTS, self.data(), message)
            .label(say!("at least {} are needed", self::points(parameters)))
            .related(
                self.place(),
                say!("{} to be found", self::parameters(parameters)),
            )
            .help(say!("take more points, or a formula with fewer parameters"))
    }

    fn no_freedom(&self, points: usize) -> Fault {
        let message = say!("{} for as many parameters", self::points(points));
        Fault::new(FIT_POINTS, self.data(), message)
            .label(say!(
                "no residuals are left to tell how far the points may be off"
            ))
            .help(say!(
                "take more points, or state the uncertainty of the response: {} = {{ …, u = … }}",
                self.columns[0].name
            ))
    }

    fn no_uncertainty(&self) -> Fault {
        let scale = self.stated.value.scale.as_ref();
        let place = scale.map_or_else(|| self.place(), |scale| scale.span.clone());
        let message = say!("no column of the fit {} states an uncertainty", self.name);
        Fault::new(FIT_ERRORS, place, message)
            .label(say!("nothing is stated"))
            .help(say!(
                "state the uncertainty of the response, {} = {{ …, u = … }}, or leave out `scale`: the residuals then tell it",
                self.columns[0].name
            ))
    }

    fn exact_value(&self, observed: Observed, point: usize) -> Fault {
        let column = self.columns[column_of(observed)];
        let help = if column_of(observed) == 0 {
            say!("an exact point would have to lie on the curve; state what it may be off")
        } else {
            say!("state what it may be off, or no uncertainty at all for the column")
        };
        let message = say!(
            "the uncertainty of value {} of {} is not greater than zero",
            point + 1,
            column.name
        );
        Fault::new(FIT_ERRORS, value_place(column, point), message)
            .label(say!("no uncertainty"))
            .help(help)
    }

    fn correlation(&self, point: usize) -> Fault {
        let list = self.stated.value.correlation.as_ref();
        let place = list
            .and_then(|list| list.value.get(point))
            .map_or_else(|| self.place(), |r| r.span.clone());
        let message = say!(
            "the correlation coefficient of point {} is not possible",
            point + 1
        );
        Fault::new(FIT_ERRORS, place, message)
            .label(say!("must be between -1 and 1"))
            .help(say!(
                "at 1 or -1 the errors may leave the point nowhere to go across the curve"
            ))
    }

    fn covariance(&self, observed: Observed) -> Fault {
        let column = self.columns[column_of(observed)];
        let covariance = column.table.covariance.as_ref();
        let place = covariance.map_or(column.key.clone(), |stated| stated.span.clone());
        let message = say!(
            "the values of {} cannot have this covariance matrix",
            column.name
        );
        Fault::new(NOT_SEMIDEFINITE, place, message)
            .label(say!("not positive definite"))
            .help(say!("check the signs, and that |covariance| does not exceed the product of the standard uncertainties; causes common to all points stand in `components`"))
    }

    fn indistinct(&self, parameters: &[usize]) -> Fault {
        let names: Vec<&str> = parameters
            .iter()
            .filter_map(|index| self.formula.parameters.get(*index))
            .map(|parameter| parameter.name.as_str())
            .collect();
        let message = say!("the data do not tell {} apart", names.join(", "));
        let fault = Fault::new(FIT_INDISTINCT, self.place(), message)
            .label(say!(
                "they can change together and leave the curve as it is"
            ))
            .related(self.data(), say!("at these points"));
        if let Some(start) = self.better_start() {
            return fault.help(start);
        }
        fault.help(match names.as_slice() {
                [one] => say!("{one} does not act at these points: leave it out of the formula, or add points where it does"),
                _ => say!("leave out one of {}, or add points where they act differently", names.join(", ")),
            })
    }

    fn undefined(&self, point: usize) -> Fault {
        let last = self.columns[self.columns.len() - 1];
        let message = say!(
            "the formula of the fit {} has no finite value at point {}",
            self.name,
            point + 1
        );
        Fault::new(FIT_FAILED, self.place(), message)
            .label(say!("at the start values of its parameters"))
            .related(value_place(last, point), say!("this point"))
            .help(
                self.better_start().unwrap_or_else(|| {
                    say!("choose start values for which every point has a value")
                }),
            )
    }

    fn no_convergence(&self, iterations: usize, parameters: &[f64]) -> Fault {
        let message = say!(
            "the fit {} was not found within {}",
            self.name,
            steps(iterations)
        );
        Fault::new(FIT_FAILED, self.place(), message)
            .label(say!("the search does not settle"))
            .help(self.better_start().unwrap_or_else(|| {
                let stopped = self.values(parameters, 6);
                say!("choose other start values; it stopped at {stopped}")
            }))
    }

    /// That the start is a bad one, where other starts lead to a minimum.
    fn better_start(&self) -> Option<Said> {
        let best = self.elsewhere.first()?;
        Some(say!(
            "these start values are bad ones; others lead to a minimum at {}: write such values as `start`, and see whether the curve is the one that is meant",
            self.values(&best.parameters, 3)
        ))
    }

    /// `a = 2.5, b = 0.31`.
    fn values(&self, parameters: &[f64], digits: u8) -> String {
        let pairs = self.formula.parameters.iter().zip(parameters);
        let values = pairs.map(|(parameter, value)| {
            let value = Decimal::from_f64(*value).round_to_significant(digits, Rounding::HalfEven);
            format!("{} = {}", parameter.name, show(value.to_f64()))
        });
        values.collect::<Vec<_>>().join(", ")
    }

    fn not_finite(&self) -> Fault {
        let message = say!(
            "the fit {} has no finite values at all its points",
            self.name
        );
        Fault::new(FIT_FAILED, self.place(), message)
            .label(say!("not defined everywhere"))
            .help(say!(
                "check the formula at the smallest and largest values of the columns"
            ))
    }

    /// The place of the formula.
    fn place(&self) -> Range<usize> {
        self.formula.place.clone()
    }

    /// The place of the header of the data.
    fn data(&self) -> Range<usize> {
        let data = self.stated.value.data.as_ref();
        data.map_or(self.stated.key.clone(), |data| data.key.clone())
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

/// `1 point`, `3 points`.
fn points(n: usize) -> Said {
    match n {
        1 => say!("1 point"),
        n => say!("{n} points"),
    }
}

fn parameters(n: usize) -> Said {
    match n {
        1 => say!("1 parameter"),
        n => say!("{n} parameters"),
    }
}

fn steps(n: usize) -> Said {
    match n {
        1 => say!("1 step"),
        n => say!("{n} steps"),
    }
}
