//! The formula of a fit: its parameters, and the response that the solver sees.
//!
//! | chapter | holds |
//! |---|---|
//! | `parts` | what it consists of |
//! | `text` | a formula written out: its left side |
//! | `parameters` | which of its names are parameters |
//! | `compiled` | units, start values, and the function itself |
//! | `polynomial` | a formula given by its degree |

mod compiled;
mod parameters;
mod parts;
mod polynomial;
mod text;

use super::super::checker::Checker;
use crate::budget::faults::{FIT, TWO_WAYS};
use gumption_fault::{Fault, say};

pub(super) use parts::{Formula, Parameter, Scope};

impl Checker<'_> {
    /// The formula of a fit. On failure the parameters that are known nevertheless.
    pub(super) fn fit_formula(&mut self, fit: &Scope<'_>) -> Result<Formula, Vec<Parameter>> {
        let (name, table) = (fit.name, &fit.stated.value);
        let fault = match (&table.model, &table.polynomial) {
            (Some(model), None) => return self.fit_text(fit, model),
            (None, Some(degree)) => {
                return self.fit_polynomial(fit, degree).ok_or_else(Vec::new);
            }
            (Some(model), Some(polynomial)) => Fault::new(
                TWO_WAYS,
                polynomial.key.clone(),
                say!("the fit {name} has a `model` and a `polynomial`"),
            )
            .label(say!("second formula"))
            .related(model.key.clone(), say!("first formula"))
            .help(say!("keep one")),
            (None, None) if table.refused => return Err(Vec::new()),
            (None, None) => Fault::new(
                FIT,
                fit.stated.key.clone(),
                say!("the fit {name} has no formula"),
            )
            .label(say!("`model` is missing"))
            .help(say!("add for example model = \"y = a + b*x\", or polynomial = 2 with `response` and `predictor`")),
        };
        self.report(fault);
        Err(Vec::new())
    }
}
