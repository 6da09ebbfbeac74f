//! What somebody's certificate says.

use super::list::List;
use crate::budget::claim::Confidence;
use gumption_format::toml::{Amount, Named, OneOrMany};
use gumption_format::toml::{table, words};

table! {
    /// What somebody's certificate says; compared, never used.
    ClaimTable "[claim]" {
        /// Measurand, where there are several.
        measurand: String,
        /// Which result the figures are about; without it GUM is judged and Monte Carlo shown beside.
        method: MethodWord,
        /// Stated value.
        value: Amount,
        /// Stated standard uncertainty; `"0.1 %"` is of the value.
        u: Amount,
        /// Stated expanded uncertainty; `"0.1 %"` is of the value.
        U: Amount,
        /// Stated variance u², in the square of the unit.
        variance: f64,
        /// Stated coverage factor.
        k: f64,
        /// Stated degrees of freedom.
        dof: f64,
        /// Stated coverage probability.
        p: f64,
        /// Stated coverage interval: lower and upper limit.
        interval: List<Amount>,
        /// Stated shortest coverage interval: lower and upper limit.
        shortest: List<Amount>,
        /// Stated limit that the quantity is not below with the coverage probability of the budget: a one-sided interval.
        at_least: Amount,
        /// Stated limit that it is not above with that probability.
        at_most: Amount,
        /// Stated second-order shift of the estimate.
        shift: Amount,
        /// Stated correlation coefficients with other measurands, by name.
        correlation: Named<f64>,
        /// Stated covariances with other measurands, by name, in the product of the units.
        covariance: Named<f64>,
        /// Stated joint coverage region of the measurands.
        region: RegionClaimTable,
        /// Stated verdict of the validation of JCGM 101 clause 8.
        validated: VerdictTable,
        /// Stated figures of inputs (`V`) and components (`V.calibration`), by name.
        inputs: Named<InputClaimTable>,
        /// Stated figures of analyses, by name: `"line.residual_sd" = 0.0035`.
        figures: Named<f64>,
        /// Correct significant digits that every figure of the claim must have, in place of tolerances.
        digits: u64,
        /// How well the stated figures are known; with "low" they are shown and decide nothing.
        confidence: Confidence,
        /// Largest differences that still agree, where half a unit of the last stated digit is too little.
        tolerance: ToleranceTable,
        /// Who says so.
        reference: String,
        /// Anything to know about it.
        note: String,
    }
}

words! {
    /// The result that a claim is about.
    MethodWord {
        /// Law of propagation of uncertainty, first order.
        Gum "GUM",
        /// The same with second-order terms.
        SecondOrder "second-order",
        /// Propagation of distributions.
        MonteCarlo "Monte Carlo",
    }
}

table! {
    /// A stated joint coverage region.
    RegionClaimTable "`region`" {
        /// Coverage factor of the ellipsoid.
        ellipsoid: f64,
        /// Coverage factor of the hyper-rectangle.
        rectangle: f64,
        /// Effective degrees of freedom of the covariance matrix.
        dof: f64,
    }
}

table! {
    /// A stated verdict of the validation.
    VerdictTable "`validated`" {
        /// Significant digits of u(y): 1 or 2.
        digits: u64,
        /// Whether the GUM result is validated.
        verdict: bool,
    }
}

table! {
    /// Stated figures of an input or component.
    InputClaimTable "a claim about an input" {
        /// Its estimate.
        value: Amount,
        /// Its standard uncertainty.
        u: Amount,
        /// Its degrees of freedom.
        dof: f64,
        /// Its sensitivity coefficient.
        sensitivity: f64,
        /// Its contribution |c|·u, in the unit of the measurand.
        contribution: f64,
    }
}

table! {
    /// Largest differences that still agree, in the unit of the figure.
    ToleranceTable "`tolerance`" {
        /// Of the value.
        value: f64,
        /// Of the standard uncertainty.
        u: f64,
        /// Of the expanded uncertainty.
        U: f64,
        /// Of the coverage factor.
        k: f64,
        /// Of the degrees of freedom.
        dof: f64,
        /// Of the coverage probability.
        p: f64,
        /// Of the limits of the interval: one for both, or one for each end.
        interval: OneOrMany<f64>,
        /// Of the limits of the shortest interval: one for both, or one for each end.
        shortest: OneOrMany<f64>,
        /// Of the variance.
        variance: f64,
        /// Of covariances.
        covariance: f64,
        /// Of the limits of one-sided intervals.
        one_sided: f64,
        /// Of the shift.
        shift: f64,
        /// Of correlation coefficients.
        correlation: f64,
        /// Of the factors of the joint region.
        region: f64,
        /// Of contributions of inputs.
        contribution: f64,
        /// Of sensitivity coefficients of inputs.
        sensitivity: f64,
        /// Of figures of analyses.
        figures: f64,
    }
}
