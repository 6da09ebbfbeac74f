//! Models of deviations: a straight line through the errors of an instrument has a slope near zero, of either sign, so that no change
//! of it is too large. What disturbs the scale is there a disturbance of the slope itself, and a part of a column one of the output.

use super::fitted::{FittedModel, Node, varies};
use super::modifiers::{centred, known, largest, map2};
use super::{Term, Variation};

/// A model that leaves more than it gives.
#[derive(Debug, Clone, Copy)]
pub(in crate::diagnose) struct Deviations {
    /// The parameter that the signal is in proportion to.
    slope: usize,
}

impl Deviations {
    /// Where less than half of the variance of the readings is what the model gives, by one parameter.
    pub(in crate::diagnose) fn of(fitted: &FittedModel<'_>) -> Option<Deviations> {
        let case = fitted.case();
        if case.responses.len() != 1 || fitted.is_implicit(0) {
            return None;
        }
        let squares = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
        let given = squares(&centred(&fitted.design.reduced(fitted.signal(0))));
        let left = squares(fitted.fit.residuals.map(known).as_slice());
        let slope = (0..case.parameters.len()).find(|parameter| is_factor(fitted, *parameter))?;
        (given < left).then_some(Deviations { slope })
    }

    /// Whether an effect can act where nothing bounds it, and acts elsewhere.
    pub(in crate::diagnose) fn frees(
        self,
        fitted: &FittedModel<'_>,
        variation: &Variation,
    ) -> bool {
        self.free(fitted, &mut variation.clone())
    }

    /// Lets an effect act where nothing bounds it; whether it acted elsewhere.
    pub(in crate::diagnose) fn free(
        self,
        fitted: &FittedModel<'_>,
        variation: &mut Variation,
    ) -> bool {
        let mut any = false;
        let named = variation.spectrum.is_none();
        for term in variation.terms.iter_mut().filter(|_| named) {
            if let Some(node) = self.freed(fitted, term) {
                (term.node, any) = (node, true);
            }
        }
        any
    }

    fn freed(self, fitted: &FittedModel<'_>, term: &Term) -> Option<Node> {
        match term.node {
            Node::Gain => Some(Node::Parameter(self.slope)),
            Node::Column(column) => {
                let (own, unit) = (&term.written().unit, fitted.step_unit(column));
                let is_part = own.dimension == unit.dimension && own.factor == unit.factor;
                let is_even = !varies(&fitted.slope(term.node, 0));
                (is_part && is_even).then_some(Node::Output)
            }
            Node::Output | Node::Reading | Node::Parameter(_) => None,
        }
    }
}

/// Whether the signal is a parameter, with one value in all rows, times its slope.
fn is_factor(fitted: &FittedModel<'_>, parameter: usize) -> bool {
    /// Rounding, as a share of the largest signal.
    const NOTHING: f64 = 1e-9;
    if fitted.case().parameters[parameter].per.is_some() {
        return false;
    }
    let value = fitted.fit.unknowns[fitted.design.unknown_of(parameter, 0)];
    let (signal, slope) = (
        fitted.signal(0),
        fitted.slope(Node::Parameter(parameter), 0),
    );
    let left = map2(signal, &slope, |signal, slope| signal - value * slope);
    largest(&left) <= NOTHING * largest(signal)
}
