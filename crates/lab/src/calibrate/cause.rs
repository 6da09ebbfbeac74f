//! A cause of doubt.

use nalgebra::DMatrix;

use crate::experiment::Scope;
use gumption_core::distribution::Distribution;
use gumption_core::statistics::effective_freedom;
use gumption_gum::budget::Evaluation;

/// A cause of doubt and what it does to the coefficients.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
    pub(super) fn beside(self, other: Cause) -> Cause {
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
    pub(super) fn contribution_dof(&self, coefficient: usize) -> f64 {
        if let [dof] = self.dof.as_slice() {
            return *dof;
        }
        let effects = self.effects.row(coefficient);
        effective_freedom(effects.iter().copied().zip(self.dof.iter().copied()))
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
