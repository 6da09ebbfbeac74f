//! Claimed figures held against those obtained.

use crate::budget::{Budget, Claim, ClaimedFigure, ClaimedMethod, Confidence, Figure, Part};

use super::one_sided;
use super::reported::Reported;
use super::result::{Basis, Clause8, Evaluation, MeasurandResult};
use gumption_core::quantity::Rounding;

/// One claimed figure against one obtained figure.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// What is compared, with the claimed number and its tolerance.
    pub claimed: ClaimedFigure,
    /// Index of the claim in the budget.
    pub claim: usize,
    /// Which method gave the obtained figure.
    pub method: Method,
    /// The obtained figure; `None` where it does not exist (no Monte Carlo, no moments, several measurands only).
    pub obtained: Option<f64>,
    /// An expanded uncertainty rounded by the budget's own conventions, as a certificate would state
    /// it; `None` for other figures, which claims state to nearest.
    pub rounded: Option<f64>,
    /// Whether the figure is an expanded uncertainty that is always rounded up, claimed by its digits.
    pub always_up: bool,
    /// Whether the claim is about this method; otherwise the figure is shown beside for information.
    pub judged: bool,
    /// Whether a verdict depends on it: the claim is about this method and its source is known well enough.
    pub decides: bool,
}

impl Comparison {
    /// Obtained less claimed, where that is a number and not a verdict.
    pub fn difference(&self) -> Option<f64> {
        let is_verdict = matches!(self.claimed.what, Figure::Validated(_));
        let obtained = self.obtained.filter(|_| !is_verdict)?;
        Some(obtained - self.claimed.value)
    }
}

/// Which method gave a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Method {
    /// GUM, first order.
    Gum,
    /// GUM with second-order terms.
    SecondOrder,
    /// Monte Carlo.
    MonteCarlo,
    /// An analysis that is no propagation: a fit, an analysis of variance, a conformity assessment.
    Analysis,
}

impl Comparison {
    /// Whether the obtained figure is the claimed one within its tolerance, or an expanded uncertainty
    /// becomes it when rounded by the budget's conventions (which may always round up).
    pub fn agrees(&self) -> bool {
        if self.always_up {
            return self.is_rounded_up();
        }
        let nearly = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
        self.is_near() || self.rounded.is_some_and(|r| nearly(r, self.claimed.value))
    }

    /// Whether an uncertainty that is always rounded up becomes the claimed one: that is not smaller, and larger by
    /// less than a unit of its last digit.
    fn is_rounded_up(&self) -> bool {
        let unit = 2.0 * self.claimed.tolerance;
        let slack = 1e-9 * unit + 4.0 * f64::EPSILON * self.claimed.value.abs();
        self.obtained.is_some_and(|obtained| {
            let more = self.claimed.value - obtained;
            more >= -slack && more < unit
        })
    }

    /// Whether the obtained figure as it is lies within the tolerance.
    pub fn is_near(&self) -> bool {
        // A figure exactly half a unit away was rounded either way; rounding of doubles must not decide.
        let slack = 1e-9 * self.claimed.tolerance + 4.0 * f64::EPSILON * self.claimed.value.abs();
        self.obtained.is_some_and(|obtained| {
            (obtained - self.claimed.value).abs() <= self.claimed.tolerance + slack
        })
    }

    /// Correct significant digits: log relative error −log₁₀|obtained − claimed|/|claimed| (absolute where zero is
    /// claimed), at most 16; `None` where nothing was obtained.
    pub fn log_relative_error(&self) -> Option<f64> {
        let error = (self.obtained? - self.claimed.value).abs();
        let scale = if self.claimed.value == 0.0 {
            1.0
        } else {
            self.claimed.value.abs()
        };
        Some((-libm::log10(error / scale)).clamp(0.0, 16.0))
    }

    /// Obtained divided by claimed, where that says something.
    pub fn ratio(&self) -> Option<f64> {
        self.obtained
            .filter(|_| self.claimed.value != 0.0)
            .map(|obtained| obtained / self.claimed.value)
            .filter(|ratio| ratio.is_finite())
    }
}

/// Every claimed figure of a budget against what was obtained, in the order of the file. A claim that names no
/// method is judged by what is reported, with the other method beside.
pub fn compare_claims(budget: &Budget, evaluation: &Evaluation) -> Vec<Comparison> {
    let mut comparisons = Vec::new();
    for (index, claim) in budget.claims.iter().enumerate() {
        for figure in &claim.figures {
            let reported = evaluation
                .results
                .get(claim.measurand)
                .map(|result| result.reported(&budget.conventions));
            let basis = reported.map_or(Basis::Gum, |reported| reported.basis);
            for (method, judged) in methods(claim.method, &figure.what, basis) {
                let stated = reported
                    .filter(|_| judged && claim.method == ClaimedMethod::Unstated)
                    .and_then(|reported| as_reported(&reported, claim, &figure.what));
                let obtained =
                    stated.or_else(|| obtained(budget, evaluation, claim, &figure.what, method));
                if judged || obtained.is_some() {
                    let rounded = obtained
                        .filter(|_| figure.what == Figure::ExpandedUncertainty)
                        .map(|u| budget.conventions.rounding_rule().uncertainty(u).to_f64());
                    comparisons.push(Comparison {
                        claimed: figure.clone(),
                        claim: index,
                        method,
                        obtained,
                        rounded,
                        always_up: is_always_up(budget, figure),
                        judged,
                        decides: judged && claim.confidence != Confidence::Low,
                    });
                }
            }
        }
    }
    comparisons
}

/// Whether a figure is an expanded uncertainty that the conventions always round up, and whose tolerance is half a unit
/// of a digit, not an amount of its own.
fn is_always_up(budget: &Budget, figure: &ClaimedFigure) -> bool {
    let place = libm::log10(2.0 * figure.tolerance);
    budget.conventions.rounding == Rounding::Up
        && matches!(
            figure.what,
            Figure::ExpandedUncertainty | Figure::RelativeExpanded
        )
        && (place - place.round()).abs() < 1e-6
}

fn methods(claimed: ClaimedMethod, what: &Figure, basis: Basis) -> Vec<(Method, bool)> {
    if matches!(what, Figure::Named(_)) {
        return vec![(Method::Analysis, true)];
    }
    match claimed {
        ClaimedMethod::Unstated if basis == Basis::MonteCarlo && has_monte_carlo(what) => {
            vec![(Method::MonteCarlo, true), (Method::Gum, false)]
        }
        ClaimedMethod::Unstated => vec![(Method::Gum, true), (Method::MonteCarlo, false)],
        ClaimedMethod::Gum => vec![(Method::Gum, true)],
        ClaimedMethod::SecondOrder => vec![(Method::SecondOrder, true)],
        ClaimedMethod::MonteCarlo => vec![(Method::MonteCarlo, true)],
    }
}

/// Whether a figure is one that Monte Carlo gives.
fn has_monte_carlo(what: &Figure) -> bool {
    !matches!(
        what,
        Figure::DegreesOfFreedom
            | Figure::RegionFreedom
            | Figure::Shift
            | Figure::Input(..)
            | Figure::Component(..)
            | Figure::Named(_)
    )
}

/// The figure as the report states it, where it states one.
fn as_reported(reported: &Reported, claim: &Claim, what: &Figure) -> Option<f64> {
    let (u, y) = (reported.u, reported.estimate);
    let expanded = || match claim.figure(&Figure::CoverageFactor) {
        Some(k) => u.map(|u| k * u),
        None => reported.expanded(),
    };
    match what {
        Figure::Estimate => Some(y),
        Figure::StandardUncertainty => u,
        Figure::ExpandedUncertainty => expanded(),
        Figure::RelativeUncertainty => u.map(|u| u / y.abs()),
        Figure::RelativeExpanded => expanded().map(|expanded| expanded / y.abs()),
        Figure::Variance => u.map(|u| u * u),
        Figure::CoverageFactor => reported.coverage_factor(),
        _ => None,
    }
}

fn obtained(
    budget: &Budget,
    evaluation: &Evaluation,
    claim: &Claim,
    what: &Figure,
    method: Method,
) -> Option<f64> {
    let result = evaluation.results.get(claim.measurand)?;
    if matches!(what, Figure::AtLeast | Figure::AtMost) {
        return one_sided_limit(budget, evaluation, claim, what, method);
    }
    match method {
        Method::Gum => by_gum(budget, evaluation, result, claim, what),
        Method::SecondOrder => by_second_order(result, claim, what),
        Method::MonteCarlo => by_monte_carlo(evaluation, result, claim, what),
        Method::Analysis => named(evaluation, what),
    }
}

/// A limit of a one-sided interval, which the evaluation lists by its name.
fn one_sided_limit(
    budget: &Budget,
    evaluation: &Evaluation,
    claim: &Claim,
    what: &Figure,
    method: Method,
) -> Option<f64> {
    let by_trials = match method {
        Method::Gum => false,
        Method::MonteCarlo => true,
        Method::SecondOrder | Method::Analysis => return None,
    };
    let output = budget.model.outputs().get(claim.measurand)?;
    let name = one_sided::name(&output.name, what, by_trials)?;
    named(evaluation, &Figure::Named(name))
}

fn by_gum(
    budget: &Budget,
    evaluation: &Evaluation,
    result: &MeasurandResult,
    claim: &Claim,
    what: &Figure,
) -> Option<f64> {
    let gum = &result.gum;
    match what {
        Figure::Estimate => Some(gum.estimate),
        Figure::StandardUncertainty => Some(gum.u),
        // U claimed with its own k is compared for that k: what differs is then u, not the convention.
        Figure::ExpandedUncertainty => Some(
            claim
                .figure(&Figure::CoverageFactor)
                .map_or(gum.coverage.expanded, |k| k * gum.u),
        ),
        Figure::RelativeUncertainty => Some(gum.u / gum.estimate.abs()),
        Figure::RelativeExpanded => {
            let k = claim.figure(&Figure::CoverageFactor);
            let expanded = k.map_or(gum.coverage.expanded, |k| k * gum.u);
            Some(expanded / gum.estimate.abs())
        }
        Figure::Variance => Some(gum.u * gum.u),
        Figure::Covariance(with) => {
            let other = evaluation.results.get(*with)?;
            let joint = evaluation.joint.as_ref()?;
            let r = joint.correlation.get((claim.measurand, *with))?;
            Some(r * gum.u * other.gum.u)
        }
        Figure::CoverageFactor => Some(gum.coverage.k),
        Figure::DegreesOfFreedom => Some(gum.freedom.value()),
        Figure::CoverageProbability => Some(gum.coverage.probability),
        Figure::Lower => Some(gum.estimate - gum.coverage.half_width_for_p),
        Figure::Upper => Some(gum.estimate + gum.coverage.half_width_for_p),
        Figure::ShortestLower
        | Figure::ShortestUpper
        | Figure::Shift
        | Figure::AtLeast
        | Figure::AtMost => None,
        Figure::Correlation(with) => evaluation
            .joint
            .as_ref()
            .and_then(|joint| joint.correlation.get((claim.measurand, *with)).copied()),
        Figure::Ellipsoid => evaluation.joint.as_ref().map(|joint| joint.k_ellipsoid),
        Figure::Rectangle => evaluation.joint.as_ref().map(|joint| joint.k_rectangle),
        Figure::RegionFreedom => evaluation.joint.as_ref().map(|joint| joint.dof.value()),
        Figure::Validated(digits) => verdict(result, *digits),
        Figure::Input(index, Part::Estimate) => {
            budget.inputs.get(*index).map(|input| input.estimate)
        }
        Figure::Input(index, part) => gum.inputs.get(*index).and_then(|line| part_of(line, *part)),
        Figure::Component(index, part) => gum
            .components
            .get(*index)
            .and_then(|line| part_of(line, *part)),
        Figure::Named(_) => None,
    }
}

fn named(evaluation: &Evaluation, what: &Figure) -> Option<f64> {
    let Figure::Named(name) = what else {
        return None;
    };
    let figure = evaluation
        .figures
        .iter()
        .find(|figure| figure.name == *name);
    figure.map(|figure| figure.value)
}

fn part_of(line: &super::Contribution, part: Part) -> Option<f64> {
    match part {
        Part::Estimate => None,
        Part::StandardUncertainty => Some(line.u),
        Part::DegreesOfFreedom => Some(line.dof),
        Part::Sensitivity => Some(line.sensitivity),
        // Published tables print |c|·u.
        Part::Contribution => Some(line.contribution.abs()),
    }
}

fn by_second_order(result: &MeasurandResult, claim: &Claim, what: &Figure) -> Option<f64> {
    let second = result.second_order.as_ref()?;
    let k = claim
        .figure(&Figure::CoverageFactor)
        .unwrap_or(result.gum.coverage.k);
    let estimate = result.gum.estimate + second.shift;
    match what {
        Figure::Estimate => Some(estimate),
        Figure::StandardUncertainty => Some(second.u),
        Figure::ExpandedUncertainty => Some(k * second.u),
        Figure::Lower => Some(estimate - k * second.u),
        Figure::Upper => Some(estimate + k * second.u),
        Figure::Shift => Some(second.shift),
        _ => None,
    }
}

fn by_monte_carlo(
    evaluation: &Evaluation,
    result: &MeasurandResult,
    claim: &Claim,
    what: &Figure,
) -> Option<f64> {
    let monte_carlo = result.monte_carlo.as_ref()?;
    let half = (monte_carlo.symmetric[1] - monte_carlo.symmetric[0]) / 2.0;
    match what {
        Figure::Estimate => monte_carlo.estimate,
        Figure::StandardUncertainty => monte_carlo.u,
        Figure::ExpandedUncertainty => match claim.figure(&Figure::CoverageFactor) {
            Some(k) => monte_carlo.u.map(|u| k * u),
            None => Some(half),
        },
        Figure::RelativeUncertainty => Some(monte_carlo.u? / monte_carlo.estimate?.abs()),
        Figure::RelativeExpanded => {
            let k = claim.figure(&Figure::CoverageFactor);
            let expanded = k.map_or(Some(half), |k| monte_carlo.u.map(|u| k * u));
            Some(expanded? / monte_carlo.estimate?.abs())
        }
        Figure::Variance => monte_carlo.u.map(|u| u * u),
        Figure::Covariance(with) => {
            let other = evaluation.results.get(*with)?.monte_carlo.as_ref()?;
            let joint = evaluation.joint.as_ref()?;
            let all = joint.monte_carlo_correlation.as_ref()?;
            Some(all.get((claim.measurand, *with))? * monte_carlo.u? * other.u?)
        }
        Figure::Lower => Some(monte_carlo.symmetric[0]),
        Figure::Upper => Some(monte_carlo.symmetric[1]),
        Figure::ShortestLower => Some(monte_carlo.shortest[0]),
        Figure::ShortestUpper => Some(monte_carlo.shortest[1]),
        Figure::Correlation(with) => evaluation
            .joint
            .as_ref()
            .and_then(|joint| joint.monte_carlo_correlation.as_ref())
            .and_then(|correlation| correlation.get((claim.measurand, *with)).copied()),
        Figure::Ellipsoid => regions(evaluation).map(|regions| regions.k_ellipsoid),
        Figure::Rectangle => regions(evaluation).map(|regions| regions.k_rectangle),
        Figure::Validated(digits) => verdict(result, *digits),
        _ => None,
    }
}

fn regions(evaluation: &Evaluation) -> Option<&super::Regions> {
    evaluation
        .joint
        .as_ref()
        .and_then(|joint| joint.regions.as_ref())
}

fn verdict(result: &MeasurandResult, digits: u8) -> Option<f64> {
    result
        .validation
        .as_ref()?
        .iter()
        .find(|validation| validation.digits == digits)
        .map(|validation| match validation.verdict {
            Clause8::Validated => 1.0,
            Clause8::NotValidated => 0.0,
            Clause8::Undecided => 0.5,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim_of(claimed: f64, obtained: f64, rounded: Option<f64>) -> Comparison {
        Comparison {
            claimed: ClaimedFigure {
                what: Figure::ExpandedUncertainty,
                value: claimed,
                tolerance: 0.5e-5,
            },
            claim: 0,
            method: Method::Gum,
            obtained: Some(obtained),
            rounded,
            always_up: false,
            judged: true,
            decides: true,
        }
    }

    #[test]
    fn a_figure_agrees_within_half_a_unit() {
        assert!(claim_of(4.3e-4, 4.25e-4, None).agrees());
        assert!(!claim_of(4.3e-4, 4.23e-4, None).agrees());
    }

    #[test]
    fn always_up_is_never_down() {
        let up = |claimed, obtained| Comparison {
            claimed: ClaimedFigure {
                tolerance: 0.005,
                ..claim_of(claimed, obtained, None).claimed
            },
            always_up: true,
            ..claim_of(claimed, obtained, None)
        };
        assert!(!up(0.05, 0.0541).agrees());
        assert!(up(0.06, 0.0541).agrees() && up(0.05, 0.05).agrees());
        assert!(!up(0.07, 0.0541).agrees());
    }

    #[test]
    fn an_expanded_uncertainty_that_rounds_up_to_the_claim_agrees() {
        let up = claim_of(4.3e-4, 4.231e-4, Some(4.3e-4));
        assert!(up.agrees() && !up.is_near());
        assert!(!claim_of(4.4e-4, 4.231e-4, Some(4.3e-4)).agrees());
    }
}
