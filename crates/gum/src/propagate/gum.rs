//! The law of propagation of uncertainty, first order (GUM 5.1.2 and 5.2.2), for any number of
//! measurands.
//!
//! What is propagated are the elementary components, not the inputs: a component that several
//! inputs share enters once, with the sum of its effects. Covariances between inputs (GUM F.1.2.3)
//! need no formula of their own then.

use gumption_lanes::linear::settled;
use nalgebra::DMatrix;

use super::covariance::{Covariance, Form};
use super::error::EvaluationError;
use super::freedom;
use super::result::Contribution;
use crate::budget::{Budget, Input};
use gumption_core::model::{Model, Resolved};
use gumption_core::statistics::norm;

/// A budget made linear at its estimates.
#[derive(Debug, Clone)]
pub(super) struct Linear {
    /// x.
    pub x: Vec<f64>,
    /// f(x), one per measurand.
    pub values: Vec<f64>,
    /// How far the arithmetic knows them.
    pub resolved: Vec<Resolved>,
    /// c = ∂f/∂x, measurands × inputs.
    pub gradient: DMatrix<f64>,
    pub covariance: Covariance,
    /// Each input as a combination of components.
    pub inputs: Vec<InputForm>,
    /// Each measurand as a combination of components.
    pub measurands: Vec<MeasurandForm>,
}

/// An input in terms of components.
#[derive(Debug, Clone)]
pub(super) struct InputForm {
    pub form: Form,
    /// u(x).
    pub u: f64,
}

/// A measurand in terms of components.
#[derive(Debug, Clone)]
pub(super) struct MeasurandForm {
    pub form: Form,
    /// In standard coordinates; its length is u(y).
    pub standard: Vec<f64>,
    /// u(y).
    pub u: f64,
}

/// Values and derivatives at the estimates.
///
/// # Errors
/// When a measurand has no finite value there.
pub(super) fn linearise(budget: &Budget) -> Result<Linear, EvaluationError> {
    let x: Vec<f64> = budget.inputs.iter().map(|input| input.estimate).collect();
    let mut values = budget.model.values(&x);
    if let Some(bad) = values.iter().position(|value| !value.is_finite()) {
        return Err(EvaluationError::NoValue {
            measurand: name(&budget.model, bad),
        });
    }
    let resolved = budget.model.resolved(&x);
    for (value, resolved) in values.iter_mut().zip(&resolved) {
        *value = settled(*value, resolved.value, resolved.error);
    }
    let gradient = budget.model.gradients(&x);
    let covariance = Covariance::new(&budget.components, &budget.groups);
    let linear = Linear::new(x, values, gradient, covariance, &budget.inputs);
    Ok(Linear { resolved, ..linear })
}

fn name(model: &Model, output: usize) -> String {
    model
        .outputs()
        .get(output)
        .map(|o| o.name.clone())
        .unwrap_or_default()
}

impl Linear {
    /// Propagates through the derivatives.
    pub(super) fn new(
        x: Vec<f64>,
        values: Vec<f64>,
        gradient: DMatrix<f64>,
        covariance: Covariance,
        inputs: &[Input],
    ) -> Self {
        let measurands = (0..gradient.nrows())
            .map(|o| {
                let terms = inputs.iter().enumerate().flat_map(|(i, input)| {
                    let c = gradient[(o, i)];
                    input
                        .terms
                        .iter()
                        .map(move |term| (term.component, c * term.coefficient))
                });
                let form = covariance.form(terms);
                let standard = covariance.dense(&form);
                let u = norm(standard.iter().copied());
                MeasurandForm { form, standard, u }
            })
            .collect();
        let inputs = inputs
            .iter()
            .map(|input| {
                let terms = input
                    .terms
                    .iter()
                    .map(|term| (term.component, term.coefficient));
                let form = covariance.form(terms);
                let u = covariance.uncertainty(&form);
                InputForm { form, u }
            })
            .collect();
        Linear {
            x,
            values,
            resolved: Vec::new(),
            gradient,
            covariance,
            inputs,
            measurands,
        }
    }

    /// The first input with u(x) > 0 whose sensitivity coefficient is not finite.
    pub(super) fn missing_derivative(&self, measurand: usize) -> Option<usize> {
        (0..self.inputs.len())
            .find(|&i| self.inputs[i].u > 0.0 && !self.gradient[(measurand, i)].is_finite())
    }

    /// One line of the budget table per input.
    ///
    /// The share of an input is c_i Σ_j c_j u(x_i, x_j)/u²(y) (Kessel); it is negative for an input
    /// whose correlation with others diminishes u(y).
    pub(super) fn input_lines(&self, measurand: usize) -> Vec<Contribution> {
        let of = &self.measurands[measurand];
        let lines = self.inputs.iter().enumerate().map(|(i, input)| {
            let sensitivity = self.gradient[(measurand, i)];
            let share = input
                .form
                .iter()
                .map(|&(component, weight)| self.share_of(of, component, sensitivity * weight));
            Contribution {
                sensitivity,
                u: input.u,
                contribution: effect(sensitivity, input.u),
                share: if input.u > 0.0 { share.sum() } else { 0.0 },
                dof: freedom::effective(&self.covariance, &input.form).dof,
            }
        });
        lines.collect()
    }

    /// One line of the budget table per component.
    pub(super) fn component_lines(&self, measurand: usize, count: usize) -> Vec<Contribution> {
        let of = &self.measurands[measurand];
        let mut lines: Vec<Contribution> = (0..count)
            .map(|component| Contribution {
                sensitivity: 0.0,
                u: self.covariance.u(component),
                contribution: 0.0,
                share: 0.0,
                dof: self.covariance.dof(component),
            })
            .collect();
        for &(component, weight) in &of.form {
            let line = &mut lines[component];
            line.sensitivity = weight / line.u;
            line.contribution = weight;
            line.share = self.share_of(of, component, weight);
        }
        lines
    }

    /// Share of u²(y) of an effect `weight` that comes from `component`.
    fn share_of(&self, of: &MeasurandForm, component: usize, weight: f64) -> f64 {
        if of.u == 0.0 || weight == 0.0 {
            return 0.0;
        }
        (weight / of.u) * (self.covariance.with(component, &of.standard) / of.u)
    }

    /// Correlations of the measurands; zero where one of two is exact.
    pub(super) fn correlations(&self) -> DMatrix<f64> {
        let directions: Vec<Direction> = self.measurands.iter().map(Direction::of).collect();
        let mut correlations = DMatrix::identity(directions.len(), directions.len());
        for (a, one) in directions.iter().enumerate() {
            for (b, other) in directions[..a].iter().enumerate() {
                let r = one.along(other).clamp(-1.0, 1.0);
                correlations[(a, b)] = r;
                correlations[(b, a)] = r;
            }
        }
        correlations
    }
}

/// A measurand in standard coordinates, of length one; without those that do not enter it, which of thousands of measurands
/// are nearly all. Nothing for an exact one; where a derivative is missing, every coordinate is NaN.
struct Direction(Vec<(usize, f64)>);

impl Direction {
    fn of(measurand: &MeasurandForm) -> Direction {
        let coordinates = measurand.standard.iter().enumerate();
        let unit = coordinates.map(|(place, s)| (place, s / measurand.u));
        let enter = unit.filter(|(_, s)| *s != 0.0 && measurand.u != 0.0);
        Direction(enter.collect())
    }

    /// The product with another.
    fn along(&self, other: &Direction) -> f64 {
        let mut others = other.0.iter().peekable();
        let common = self.0.iter().filter_map(|(place, s)| {
            while others.next_if(|(other, _)| other < place).is_some() {}
            let (_, t) = others.next_if(|(other, _)| other == place)?;
            Some(s * t)
        });
        common.fold(0.0, |sum, product| sum + product)
    }
}

/// c·u, zero for an exact input whatever c.
fn effect(sensitivity: f64, u: f64) -> f64 {
    if u == 0.0 { 0.0 } else { sensitivity * u }
}
