//! What was found of a fit, and what it says about further readings.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::budget::fit::Fit;
use gumption_core::quantity::Unit;

/// A fit that was found, and where its parameters went.
pub(crate) struct Fitted {
    pub fit: Fit,
    /// Components of the parameters, in their order; none where they are exact.
    pub members: Vec<usize>,
    /// Their correlation coefficients.
    pub correlation: DMatrix<f64>,
    /// Place of the name of the fit.
    pub place: Range<usize>,
}

/// What a fit says about the scatter of its response.
#[derive(Debug, Clone)]
pub(crate) struct Scatter {
    pub fit: String,
    /// Names of the parameters; none where the fit was refused.
    pub parameters: Vec<String>,
    /// The residual standard deviation, its ν and the unit of the response; `None` where uncertainties of
    /// the data are stated, or the fit was refused.
    pub known: Option<(f64, f64, Unit)>,
    pub refused: bool,
}

impl Scatter {
    pub(super) fn of(name: &str, fitted: Option<&Fitted>) -> Self {
        let known = fitted.and_then(|found| {
            let fit = &found.fit;
            let s = fit.residual_sd.filter(|_| !fit.weighted && !fit.stated)?;
            Some((s, fit.dof as f64, fit.response().unit.difference()))
        });
        Scatter {
            fit: name.to_string(),
            parameters: fitted.map_or_else(Vec::new, |found| {
                found
                    .fit
                    .parameters
                    .iter()
                    .map(|p| p.name.clone())
                    .collect()
            }),
            known,
            refused: fitted.is_none(),
        }
    }

    /// Whether a figure of this name is missing because the fit was refused.
    pub(crate) fn withholds(&self, figure: &str) -> bool {
        self.refused
            && figure
                .strip_prefix(&self.fit)
                .is_some_and(|rest| rest.starts_with('.'))
    }

    pub(super) fn is(&self, name: &str) -> bool {
        self.fit == name
    }
}
