//! How coefficients follow readings, columns and inputs: the derivatives of the estimator.

use nalgebra::DMatrix;

use super::campaign::Campaign;
use super::stack::{Row, Stack};
use crate::experiment::{Observed, Scope, Target};
use gumption_core::least_squares::{Solution, pseudo_inverse};

/// Derivatives of the coefficients (parameters, then results), one row for each, one column for each
/// observed value.
pub(super) struct Gain {
    /// ∂coefficient/∂observed value.
    pub by_observed: DMatrix<f64>,
    /// ∂coefficient/∂symbol in that row alone, for every [doubted](Stack::doubted) column and input.
    pub by_doubted: Vec<DMatrix<f64>>,
    /// ∂result/∂input in the formula of the result itself: coefficients × inputs.
    pub direct: DMatrix<f64>,
}

impl Gain {
    /// The derivatives of the estimator, as the solver found them for rows of these standard uncertainties. Those by the
    /// readings are taken where the equations hold (Gauss–Newton, (JᵀC⁻¹J)⁻¹JᵀC⁻¹): curvature comes in with the residuals, which are
    /// zero in the mean. So the covariance of the coefficients is that of `[fit]` in a budget and of certified fits.
    pub fn of_solution(stack: &Stack<'_>, solution: &Solution, u: &[f64]) -> Gain {
        let by_observed = match stack.is_linear() {
            true => solution.by_y.clone(),
            false => {
                let weighted = stack.jacobian(&solution.parameters, u).transpose();
                let mut gain = &solution.covariance * weighted;
                for (mut column, u) in gain.column_iter_mut().zip(u) {
                    column /= *u;
                }
                gain
            }
        };
        let parts = Gain {
            by_observed,
            by_doubted: solution.by_x[1..].to_vec(),
            direct: DMatrix::zeros(0, 0),
        };
        parts.with_results(stack.campaign, &solution.parameters)
    }

    /// ∂fitted value/∂observed value, row by row: the hat matrix, rows × rows, at these values of the parameters.
    pub fn projector(&self, stack: &Stack<'_>, parameters: &[f64]) -> DMatrix<f64> {
        let ones = vec![1.0; stack.rows.len()];
        stack.jacobian(parameters, &ones) * self.by_observed.rows(0, parameters.len())
    }

    /// The derivatives of the estimator of the equations linearised at `parameters`, for rows of these
    /// standard uncertainties.
    pub fn linear(stack: &Stack<'_>, parameters: &[f64], u: &[f64]) -> Option<Gain> {
        let campaign = stack.campaign;
        let jacobian = stack.jacobian(parameters, u);
        let mut by_observed = pseudo_inverse(jacobian, 1e-12)?;
        for (mut column, u) in by_observed.column_iter_mut().zip(u) {
            column /= *u;
        }
        let count = campaign.experiment.symbols();
        let mut by_doubted = vec![by_observed.clone(); stack.doubted().len()];
        let mut slopes = vec![0.0; count];
        for (index, row) in stack.rows.iter().enumerate() {
            match row {
                Row::Reading { response, .. } => {
                    let symbols = stack.symbols(index, parameters);
                    campaign
                        .experiment
                        .equations
                        .at(*response, &symbols, &mut slopes);
                }
                Row::Prior { .. } => slopes.fill(0.0),
            }
            for (gain, place) in by_doubted.iter_mut().zip(stack.doubted()) {
                let (mut column, slope) = (gain.column_mut(index), slopes[*place]);
                column *= if slope == 0.0 { 0.0 } else { -slope };
            }
        }
        let parts = Gain {
            by_observed,
            by_doubted,
            direct: DMatrix::zeros(0, 0),
        };
        Some(parts.with_results(campaign, parameters))
    }

    /// With a row for each result below those of the parameters.
    fn with_results(self, campaign: &Campaign, parameters: &[f64]) -> Gain {
        let (count, inputs) = (parameters.len(), campaign.experiment.inputs.len());
        let all = count + campaign.results.len();
        let mut map = DMatrix::zeros(all, count);
        let mut direct = DMatrix::zeros(all, inputs);
        map.view_mut((0, 0), (count, count)).fill_with_identity();
        let values: Vec<f64> = parameters
            .iter()
            .copied()
            .chain(campaign.experiment.inputs.iter().map(|input| input.value))
            .collect();
        let mut slopes = vec![0.0; values.len()];
        for (index, result) in campaign.results.iter().enumerate() {
            result.equation.at(0, &values, &mut slopes);
            for (place, slope) in slopes.iter().enumerate() {
                if place < count {
                    map[(count + index, place)] = *slope;
                } else {
                    direct[(count + index, place - count)] = *slope;
                }
            }
        }
        if campaign.results.is_empty() {
            return Gain { direct, ..self };
        }
        let mapped = |matrices: Vec<DMatrix<f64>>| matrices.iter().map(|m| &map * m).collect();
        Gain {
            by_observed: &map * &self.by_observed,
            by_doubted: mapped(self.by_doubted),
            direct,
        }
    }

    /// Number of coefficients.
    pub fn coefficients(&self) -> usize {
        self.by_observed.nrows()
    }

    /// Change of the coefficients by an error of one of a target's values, row by row.
    fn by_row(&self, stack: &Stack<'_>, target: &Target) -> DMatrix<f64> {
        let mut gain = DMatrix::zeros(self.coefficients(), stack.rows.len());
        let observes =
            |response: usize| match (&stack.campaign.experiment.observed[response], target) {
                (Observed::Column(name), Target::Reading(column)) => name == column,
                (Observed::Input(own), Target::Input(place)) => own == place,
                _ => false,
            };
        for (index, row) in stack.rows.iter().enumerate() {
            let Row::Reading { response, .. } = row else {
                continue;
            };
            if observes(*response) {
                let mut column = gain.column_mut(index);
                column += self.by_observed.column(index);
            }
        }
        let experiment = &stack.campaign.experiment;
        let symbol = match target {
            Target::Input(place) => Some(experiment.input_places().start + place),
            Target::Reading(name) => experiment.columns.iter().position(|c| c.name == *name),
        };
        let doubted = symbol.and_then(|symbol| stack.doubted().iter().position(|d| *d == symbol));
        if let Some(by_symbol) = doubted.and_then(|place| self.by_doubted.get(place)) {
            gain += by_symbol;
        }
        gain
    }

    /// Change of the coefficients by each of the errors of a target, which acts within a scope, at each point with its share:
    /// one column for each error.
    pub fn by_errors(
        &self,
        stack: &Stack<'_>,
        target: &Target,
        scope: &Scope,
        share: impl Fn(usize) -> f64,
    ) -> DMatrix<f64> {
        let by_row = self.by_row(stack, target);
        let levels = levels(stack, scope);
        let count = levels.iter().max().map_or(0, |last| last + 1);
        let mut by_level = DMatrix::zeros(by_row.nrows(), count);
        let mut sizes = by_level.clone();
        for (index, level) in levels.iter().enumerate() {
            let mut column = by_level.column_mut(*level);
            let share = match &stack.rows[index] {
                Row::Reading { point, .. } => share(*point),
                Row::Prior { .. } => 1.0,
            };
            column += by_row.column(index) * share;
            let mut size = sizes.column_mut(*level);
            size += by_row.column(index).abs() * share.abs();
        }
        // What cancels leaves the rounding of the sum, which is no effect (Higham, Accuracy and Stability of Numerical Algorithms, 4.2).
        let rounding = levels.len() as f64 * f64::EPSILON;
        by_level.zip_apply(&sizes, |effect, size| {
            if effect.abs() <= rounding * size {
                *effect = 0.0;
            }
        });
        if let (Target::Input(place), Scope::Common, true) = (target, scope, count > 0) {
            let mut column = by_level.column_mut(0);
            column += self.direct.column(*place);
        }
        by_level
    }
}

/// Which error of a scope acts on each row.
pub(super) fn levels(stack: &Stack<'_>, scope: &Scope) -> Vec<usize> {
    let labels = match scope {
        Scope::By(name) => stack.campaign.points.labels(name),
        _ => None,
    };
    let level = |row: &Row| match (row, scope) {
        (Row::Reading { point, .. }, Scope::Each) => *point,
        (Row::Reading { point, .. }, Scope::By(_)) => {
            let of_row = labels.and_then(|labels| labels.of_row.get(*point).map(|of| (labels, of)));
            match of_row {
                None => 0,
                // A point without a label shares its error with none.
                Some((labels, _)) if labels.text(*point).is_empty() => labels.levels.len() + point,
                Some((_, level)) => *level as usize,
            }
        }
        _ => 0,
    };
    stack.rows.iter().map(level).collect()
}
