//! From columns and formula to the solver, and from its solution to the budget.

use nalgebra::{DMatrix, DVector};

use super::super::checker::Checker;
use super::super::register::Register;
use super::columns::{Column, ColumnErrors, Common};
use super::doubts;
use super::failures::Unsolved;
use super::formula::Formula;
use crate::budget::faults::{FIT_COLUMNS, FIT_ERRORS};
use crate::budget::fit::{Fit, FitColumn, FitDoubt, FitParameter, LackOfFit, LackOfFitTest};
use crate::budget::tables::{FitTable, ScaleWord};
use gumption_core::least_squares::{self, Errors, Problem, Scale, Solution, Spread};
use gumption_fault::{Fault, say};
use gumption_format::toml::{Slot, Stated};

/// Residuals of this share of the largest response are what the arithmetic leaves of none.
const NOISE: f64 = 5e-16;

/// A solution, and the common causes with their action on the parameters.
pub(super) struct Solved {
    solution: Solution,
    scale: Scale,
    weighted: bool,
    /// Standard uncertainties of the values of each column.
    u: Vec<Option<Vec<f64>>>,
    /// Components that act on all points of each column: names and components.
    common: Vec<Vec<usize>>,
    /// Component, and by how much each parameter follows it.
    causes: Vec<(usize, Vec<f64>)>,
    normalised: Option<Vec<f64>>,
    lack_of_fit: Option<LackOfFit>,
    doubts: Vec<FitDoubt>,
}

impl Checker<'_> {
    /// Solves a fit. The columns are in the order of the solver: response first.
    pub(super) fn fit_solution(
        &mut self,
        name: &str,
        stated: &Stated<FitTable>,
        formula: &Formula,
        columns: &[&Column<'_>],
        errors: &[ColumnErrors],
    ) -> Option<Solved> {
        let n = columns[0].values.len();
        let weighted = errors.iter().any(|errors| errors.spread != Spread::Exact);
        let scale = match stated.value.scale.as_ref().map(|scale| scale.value) {
            Some(ScaleWord::Stated) => Scale::Stated,
            Some(ScaleWord::Residuals) => Scale::Residuals,
            None if weighted => Scale::Stated,
            None => Scale::Residuals,
        };
        let correlation = self.fit_correlation(stated, columns)?;
        let y = match &errors[0].spread {
            Spread::Exact if !weighted && scale == Scale::Residuals => Spread::Each(vec![1.0; n]),
            spread => spread.clone(),
        };
        let predictors = &columns[1..];
        let problem = Problem {
            response: formula.shape.response(),
            x: DMatrix::from_fn(n, predictors.len(), |i, k| predictors[k].values[i]),
            y: DVector::from_row_slice(&columns[0].values),
            errors: Errors {
                y,
                x: errors[1..]
                    .iter()
                    .map(|errors| errors.spread.clone())
                    .collect(),
                correlation,
                scale,
            },
            start: formula
                .parameters
                .iter()
                .map(|parameter| parameter.start)
                .collect(),
        };
        let mut solution = match least_squares::solve(&problem) {
            Ok(solution) => solution,
            Err(failure) => {
                let unsolved = Unsolved {
                    name,
                    stated,
                    formula,
                    columns,
                    elsewhere: least_squares::elsewhere(&problem),
                };
                return self.refuse(unsolved.fault(&failure));
            }
        };
        if !weighted && solution.residual_sd <= NOISE * problem.y.amax() {
            solution.covariance.fill(0.0);
            solution.correlation.fill_with_identity();
            solution.u.fill(0.0);
            solution.chi_squared = 0.0;
            solution.residual_sd = 0.0;
        }
        let u: Vec<Option<Vec<f64>>> = errors.iter().map(ColumnErrors::u).collect();
        let normalised = normalised(&problem, &solution, &u, scale, weighted);
        Some(Solved {
            scale,
            weighted,
            normalised,
            lack_of_fit: lack_of_fit(&problem, &solution),
            doubts: doubts::of(formula, columns, &problem, &solution),
            u,
            common: errors
                .iter()
                .map(|errors| {
                    errors
                        .common
                        .iter()
                        .map(|common| common.component)
                        .collect()
                })
                .collect(),
            causes: causes(errors, &solution),
            solution,
        })
    }

    /// Correlation coefficients of the errors of predictor and response.
    fn fit_correlation(
        &mut self,
        stated: &Stated<FitTable>,
        columns: &[&Column<'_>],
    ) -> Option<Option<Vec<f64>>> {
        let Some(list) = &stated.value.correlation else {
            return Some(None);
        };
        let n = columns[0].values.len();
        if columns.len() != 2 {
            return self.refuse(
                Fault::new(
                    FIT_ERRORS,
                    list.key.clone(),
                    say!("`correlation` with {} predictors", columns.len() - 1),
                )
                .label(say!("of one predictor and the response"))
                .help(say!(
                    "leave it out; a common cause of several columns is a [source.NAME]"
                )),
            );
        }
        if list.value.len() != n {
            return self.refuse(
                Fault::new(
                    FIT_COLUMNS,
                    list.span.clone(),
                    say!(
                        "{} correlation coefficients for {n} points",
                        list.value.len()
                    ),
                )
                .label(say!("expected {n}"))
                .help(say!("state one for each point")),
            );
        }
        Some(Some(list.value.iter().map(|r| r.value).collect()))
    }
}

/// How every parameter follows the causes that act on all points.
fn causes(errors: &[ColumnErrors], solution: &Solution) -> Vec<(usize, Vec<f64>)> {
    let mut causes: Vec<(usize, Vec<f64>)> = Vec::new();
    for (column, errors) in errors.iter().enumerate() {
        let slopes = match column {
            0 => &solution.by_y,
            k => &solution.by_x[k - 1],
        };
        for Common {
            component,
            coefficients,
        } in &errors.common
        {
            let action = slopes * DVector::from_row_slice(coefficients);
            match causes.iter_mut().find(|(known, _)| known == component) {
                Some((_, sum)) => {
                    for (sum, action) in sum.iter_mut().zip(action.iter()) {
                        *sum += action;
                    }
                }
                None => causes.push((*component, action.iter().copied().collect())),
            }
        }
    }
    causes
}

/// Distances of the points from the curve, in their standard uncertainties.
fn normalised(
    problem: &Problem<'_>,
    solution: &Solution,
    u: &[Option<Vec<f64>>],
    scale: Scale,
    weighted: bool,
) -> Option<Vec<f64>> {
    let factor = match scale {
        Scale::Stated => 1.0,
        Scale::Residuals => solution.residual_sd,
    };
    let mut by_parameter = vec![0.0; solution.parameters.len()];
    let mut by_predictor = vec![0.0; problem.x.ncols()];
    let of = |column: usize, point: usize| u[column].as_ref().map_or(0.0, |u| u[point]);
    let distances: Vec<f64> = (0..problem.y.len())
        .map(|i| {
            if !weighted {
                return solution.residuals[i] / factor;
            }
            let x: Vec<f64> = problem.x.row(i).iter().copied().collect();
            let f = problem.response.at(
                &x,
                &solution.parameters,
                &mut by_parameter,
                &mut by_predictor,
            );
            let own = of(0, i);
            let slopes = by_predictor.iter().enumerate();
            let moved: Vec<f64> = slopes.map(|(k, slope)| slope * of(k + 1, i)).collect();
            // In units of the largest part: squares of 10¹⁶⁰ are infinite.
            let size = moved.iter().fold(own, |most, part| part.abs().max(most));
            let mut variance = (own / size).powi(2);
            variance += moved.iter().map(|part| (part / size).powi(2)).sum::<f64>();
            if let Some(r) = &problem.errors.correlation {
                variance -= 2.0 * r[i] * (moved[0] / size) * (own / size);
            }
            (problem.y[i] - f) / (factor * size * variance.sqrt())
        })
        .collect();
    distances.iter().all(|d| d.is_finite()).then_some(distances)
}

/// Whether the data could have come from the curve: χ² against stated uncertainties, otherwise the scatter of
/// repeated points.
fn lack_of_fit(problem: &Problem<'_>, solution: &Solution) -> Option<LackOfFit> {
    if let Some(test) = least_squares::lack_of_fit(problem, solution) {
        return Some(LackOfFit {
            test: LackOfFitTest::ChiSquared,
            statistic: test.chi_squared,
            dof: test.dof as f64,
            denominator: None,
            p: test.probability,
        });
    }
    let test = least_squares::replicates(problem, solution)?;
    // Repetitions that are equal to the last digit tell nothing of the scatter.
    let tells = test.pure_error > 0.0 && test.f.is_finite();
    (problem.errors.scale == Scale::Residuals && tells).then_some(LackOfFit {
        test: LackOfFitTest::Replicates,
        statistic: test.f,
        dof: test.lack_of_fit_dof as f64,
        denominator: Some(test.pure_error_dof as f64),
        p: test.probability,
    })
}

impl Solved {
    /// The fit for the report; its parameters get their estimates and the common causes.
    pub(super) fn into_fit(
        self,
        name: &str,
        stated: &Stated<FitTable>,
        formula: &Formula,
        columns: &[&Column<'_>],
        first: usize,
        register: &mut Register,
    ) -> Fit {
        self.enter_estimates(first, register);
        let u = &self.solution.u;
        let parameters: Vec<FitParameter> = formula
            .parameters
            .iter()
            .enumerate()
            .map(|(place, parameter)| FitParameter {
                name: parameter.name.clone(),
                description: parameter.description.clone(),
                unit: register.inputs[first + place].unit.clone(),
                estimate: self.solution.parameters[place],
                u: u[place],
                combined_u: self.combined(place, u[place], register),
                input: first + place,
            })
            .collect();
        let columns = columns.iter().zip(&self.u).zip(&self.common);
        let columns: Vec<_> = columns
            .map(|((column, u), common)| fit_column(column, u.clone(), common, register))
            .collect();
        let solution = self.solution;
        let text = |stated: &Slot<String>| stated.as_ref().map(|text| text.value.clone());
        // A constant alone has nothing to determine the response by.
        let has_predictors = columns.len() > 1;
        Fit {
            name: name.to_string(),
            description: text(&stated.value.description),
            reference: text(&stated.value.reference),
            equation: formula.equation.clone(),
            columns,
            parameters,
            correlation: solution.correlation,
            stated: self.scale == Scale::Stated,
            weighted: self.weighted,
            dof: solution.dof,
            chi_squared: solution.chi_squared,
            residual_sd: (solution.dof > 0).then_some(solution.residual_sd),
            r_squared: match has_predictors {
                true => solution.r_squared,
                false => f64::NAN,
            },
            normalised: self.normalised,
            lack_of_fit: self.lack_of_fit,
            doubts: self.doubts,
            linear: formula.shape.response().is_linear(),
            iterations: solution.iterations,
            condition: solution.condition,
            fitted: solution.fitted,
            residuals: solution.residuals,
            adjusted: solution.adjusted_x,
            covariance: solution.covariance,
        }
    }

    /// Gives the parameters their estimates and the action of common causes.
    fn enter_estimates(&self, first: usize, register: &mut Register) {
        for (place, estimate) in self.solution.parameters.iter().enumerate() {
            if let Some(input) = register.inputs.get_mut(first + place) {
                input.estimate = *estimate;
            }
        }
        for (component, actions) in &self.causes {
            let size = actions.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
            for (place, action) in actions.iter().enumerate() {
                // What the arithmetic leaves of zero is no action.
                if action.abs() > 1e-14 * size {
                    register.act(first + place, *component, *action);
                }
            }
        }
    }

    /// Standard uncertainty of a parameter with the common causes.
    fn combined(&self, place: usize, u: f64, register: &Register) -> f64 {
        let causes = self.causes.iter().map(|(component, actions)| {
            let u = register.components.get(*component).map_or(0.0, |c| c.u);
            u * actions[place]
        });
        causes.fold(u, libm::hypot)
    }
}

/// A column for the report, with the names of its common causes.
fn fit_column(
    column: &Column<'_>,
    u: Option<Vec<f64>>,
    common: &[usize],
    register: &Register,
) -> FitColumn {
    let description = column.table.description.as_ref();
    FitColumn {
        name: column.name.to_string(),
        description: description.map(|text| text.value.clone()),
        unit: column.unit.clone(),
        values: column.values.clone(),
        u,
        common: common
            .iter()
            .filter_map(|component| Some(register.components.get(*component)?.name.to_string()))
            .collect(),
    }
}
