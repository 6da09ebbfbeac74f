//! What each cause of doubt does to the coefficients.

use nalgebra::DMatrix;

use super::experiment::{Doubt, Scope, Target};
use super::gain::Gain;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::budget::Evaluation;
use crate::distribution::Distribution;

/// A cause of doubt and what it does to the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// What it is.
    pub origin: Origin,
    /// Change of each coefficient (parameters, then results) by one standard uncertainty of each of its
    /// independent errors: coefficients × errors.
    pub effects: DMatrix<f64>,
    /// Degrees of freedom of its standard uncertainty: one for all errors, or one for each.
    pub dof: Vec<f64>,
    /// Distribution of each error, of any scale.
    pub distribution: Option<Distribution>,
    /// Type A or B.
    pub evaluation: Evaluation,
    /// How its standard uncertainty was found.
    pub how: String,
}

/// What a cause is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// A component that the file states.
    Stated {
        /// Its name.
        name: String,
        /// On which points one error acts.
        scope: Scope,
    },
    /// The scatter of a response, as the residuals tell it.
    Residuals {
        /// The response.
        response: String,
    },
    /// The scatter of a column, as the samples of each dwell tell it.
    Samples {
        /// The column.
        column: String,
    },
    /// What was known of a parameter beforehand.
    Prior {
        /// The parameter.
        parameter: String,
    },
}

impl Cause {
    /// Its standard-uncertainty contribution to a coefficient.
    pub fn contribution(&self, coefficient: usize) -> f64 {
        self.effects.row(coefficient).norm()
    }

    /// The change of a coefficient by one standard uncertainty, with its sign, where the cause is one
    /// error.
    pub fn effect(&self, coefficient: usize) -> Option<f64> {
        (self.effects.ncols() == 1).then(|| self.effects[(coefficient, 0)])
    }

    /// What it contributes to the standard uncertainty `u` of a coefficient.
    pub fn contributes(&self, coefficient: usize, u: f64) -> Contribution<'_> {
        /// Part of the standard uncertainty.
        const NOTHING: f64 = 1e-6;
        let own = self.contribution(coefficient);
        Contribution {
            is_nothing: own <= NOTHING * u,
            cause: self,
            u: own,
            effect: self.effect(coefficient),
            share: (own / u).powi(2),
            dof: self.contribution_dof(coefficient),
        }
    }

    /// Both as one cause.
    fn beside(self, other: Cause) -> Cause {
        let columns: Vec<_> = self
            .effects
            .column_iter()
            .chain(other.effects.column_iter())
            .collect();
        let effects = match columns.as_slice() {
            [] => self.effects.clone(),
            columns => DMatrix::from_columns(columns),
        };
        Cause { effects, ..self }
    }

    /// Degrees of freedom of its contribution to a coefficient (Welch–Satterthwaite).
    pub fn contribution_dof(&self, coefficient: usize) -> f64 {
        if let [dof] = self.dof.as_slice() {
            return *dof;
        }
        let squares = self.effects.row(coefficient).map(|effect| effect * effect);
        let welch: f64 = squares
            .iter()
            .zip(&self.dof)
            .map(|(s, dof)| s * s / dof)
            .sum();
        squares.sum().powi(2) / welch
    }
}

/// What a cause contributes to the standard uncertainty of a coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contribution<'c> {
    /// The cause.
    pub cause: &'c Cause,
    /// Its part of the standard uncertainty.
    pub u: f64,
    /// The change of the coefficient by one standard uncertainty, with its sign, where the cause is one error.
    pub effect: Option<f64>,
    /// Its share of the variance, 0 … 1.
    pub share: f64,
    /// Its degrees of freedom.
    pub dof: f64,
    /// Whether it is a rounding error, or might as well be.
    pub is_nothing: bool,
}

/// All causes that act on any coefficient.
pub(super) fn causes(stack: &Stack<'_>, gain: &Gain, scatters: &Scatters, u: &[f64]) -> Vec<Cause> {
    let mut all = scatters.causes(stack, gain, u);
    for (index, row) in stack.rows.iter().enumerate() {
        if let Row::Prior { parameter } = row {
            all.extend(prior(stack, gain, index, *parameter));
        }
    }
    // The independent parts of correlated errors bear one name, and are one cause.
    let doubts = &stack.experiment.doubts;
    all.extend(
        doubts
            .chunk_by(|a, b| a.name == b.name)
            .filter_map(|parts| {
                let causes = parts.iter().map(|doubt| stated(stack, gain, doubt));
                causes.reduce(Cause::beside)
            }),
    );
    all.retain(|cause| cause.effects.iter().any(|effect| *effect != 0.0));
    all
}

fn prior(stack: &Stack<'_>, gain: &Gain, row: usize, parameter: usize) -> Option<Cause> {
    let one = &stack.experiment.parameters[parameter];
    let prior = one.known?;
    let effects = gain.by_observed.column(row) * prior.u;
    Some(Cause {
        origin: Origin::Prior {
            parameter: one.name.clone(),
        },
        effects: DMatrix::from_columns(&[effects]),
        dof: vec![prior.dof],
        distribution: None,
        evaluation: Evaluation::TypeB,
        how: String::new(),
    })
}

fn stated(stack: &Stack<'_>, gain: &Gain, doubt: &Doubt) -> Cause {
    let mut effects: Option<DMatrix<f64>> = None;
    for act in &doubt.acts {
        let own = gain.by_errors(stack, &act.on, &doubt.scope) * (act.coefficient * doubt.u);
        effects = Some(match effects {
            Some(sum) => sum + own,
            None => own,
        });
    }
    let effects = effects.unwrap_or_else(|| DMatrix::zeros(gain.coefficients(), 0));
    Cause {
        origin: Origin::Stated {
            name: doubt.name.clone(),
            scope: doubt.scope.clone(),
        },
        effects,
        dof: vec![doubt.dof],
        distribution: Some(doubt.distribution.clone()),
        evaluation: doubt.evaluation,
        how: doubt.how.clone(),
    }
}

impl Doubt {
    /// Standard uncertainty of a reading of a column by errors that each reading has for itself.
    pub(super) fn of_each_reading(&self, column: &str) -> f64 {
        if self.scope != Scope::Each {
            return 0.0;
        }
        let acts = self.acts.iter();
        let own = acts.filter(|act| act.on == Target::Reading(column.to_owned()));
        own.map(|act| act.coefficient * self.u).sum::<f64>().abs()
    }
}
