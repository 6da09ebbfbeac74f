//! What is reported of a measurand: the statement, tables and the machine form are views of it.

use super::result::{Basis, Coverage, CoverageBasis, Evaluation, FindingKind, MonteCarlo};
use crate::budget::{Conventions, CoverageRule};

/// Value and uncertainty as they are reported, with the method that they rest on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reported {
    /// The method.
    pub basis: Basis,
    /// y; the median where the distribution has no mean.
    pub estimate: f64,
    /// u(y); `None` where the distribution has no standard deviation.
    pub u: Option<f64>,
    /// How far y may be off.
    pub uncertainty: ReportedUncertainty,
    /// The probability that goes with it.
    pub probability: StatedProbability,
}

/// How the uncertainty is reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReportedUncertainty {
    /// U = k·u.
    Multiple {
        /// k.
        k: f64,
        /// U.
        expanded: f64,
    },
    /// U is half the width of a coverage interval that is symmetric about y.
    HalfWidth {
        /// U.
        expanded: f64,
    },
    /// The interval itself, which is not symmetric about y.
    Interval {
        /// Its ends.
        ends: [f64; 2],
        /// Which of those with the same probability.
        kind: IntervalKind,
    },
    /// None: the evaluation gives no uncertainty.
    None,
}

/// One of the intervals of a probability.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntervalKind {
    /// As much probability below as above.
    Symmetric,
    /// The shortest one.
    Shortest,
}

/// The coverage probability beside k or an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatedProbability {
    /// This one.
    Of(f64),
    /// The profile names none for its fixed k (JJF 1059.1, 5.3).
    Unnamed,
    /// Monte Carlo has refuted the one that the fixed k would have.
    Refuted,
}

impl Reported {
    /// k, where U is a multiple of u.
    pub fn coverage_factor(&self) -> Option<f64> {
        match (self.uncertainty, self.u) {
            (ReportedUncertainty::Multiple { k, .. }, _) => Some(k),
            (ReportedUncertainty::HalfWidth { expanded }, Some(u)) => Some(expanded / u),
            _ => None,
        }
    }
}

impl Evaluation {
    /// What is reported of a measurand under the conventions of its budget.
    pub fn reported(&self, measurand: usize, conventions: &Conventions) -> Option<Reported> {
        let result = self.results.get(measurand)?;
        Some(match (result.basis, &result.monte_carlo) {
            (Basis::MonteCarlo, Some(monte_carlo)) => {
                self.by_monte_carlo(measurand, monte_carlo, conventions)
            }
            _ => {
                let (gum, coverage) = (&result.gum, &result.gum.coverage);
                let refuted = self.finds(measurand, &FindingKind::NotValidated);
                Reported {
                    basis: Basis::Gum,
                    estimate: gum.estimate,
                    u: Some(gum.u),
                    uncertainty: match coverage.expanded {
                        expanded if expanded == 0.0 || !expanded.is_finite() => {
                            ReportedUncertainty::None
                        }
                        expanded => ReportedUncertainty::Multiple {
                            k: coverage.k,
                            expanded,
                        },
                    },
                    probability: stated_probability(coverage, conventions, refuted),
                }
            }
        })
    }

    fn by_monte_carlo(
        &self,
        measurand: usize,
        found: &MonteCarlo,
        conventions: &Conventions,
    ) -> Reported {
        let half = found
            .half_width(conventions.digits)
            .filter(|half| *half > 0.0);
        let fixed = match conventions.coverage_factor {
            CoverageRule::Fixed(k) if !conventions.state_probability => Some(k),
            _ => None,
        };
        let uncertainty = match (half, found.estimate, found.u) {
            (Some(expanded), Some(_), Some(u)) if u > 0.0 => match fixed {
                Some(k) => ReportedUncertainty::Multiple { k, expanded: k * u },
                None => ReportedUncertainty::HalfWidth { expanded },
            },
            (Some(expanded), _, None) => ReportedUncertainty::HalfWidth { expanded },
            _ => self.interval(measurand, found),
        };
        let run = self.run.as_ref().map(|run| run.coverage_probability);
        Reported {
            basis: Basis::MonteCarlo,
            estimate: found.centre(),
            u: found.u,
            uncertainty,
            probability: match uncertainty {
                ReportedUncertainty::Multiple { .. } => StatedProbability::Unnamed,
                _ => StatedProbability::Of(run.unwrap_or(conventions.coverage_probability)),
            },
        }
    }

    /// The shortest interval where the distribution is asymmetric.
    fn interval(&self, measurand: usize, found: &MonteCarlo) -> ReportedUncertainty {
        let (ends, kind) = match self.finds(measurand, &FindingKind::Asymmetric) {
            true => (found.shortest, IntervalKind::Shortest),
            false => (found.symmetric, IntervalKind::Symmetric),
        };
        let scale = found.u.unwrap_or(ends[1] - ends[0]);
        match scale > 0.0 && scale.is_finite() {
            true => ReportedUncertainty::Interval { ends, kind },
            false => ReportedUncertainty::None,
        }
    }

    fn finds(&self, measurand: usize, kind: &FindingKind) -> bool {
        let concerned = |m: Option<usize>| m.is_none() || m == Some(measurand);
        let mut findings = self.findings.iter();
        findings.any(|finding| concerned(finding.measurand) && finding.kind == *kind)
    }
}

impl Coverage {
    /// Whether k has about the probability of the profile: always, unless it is fixed and the distribution of the
    /// result is another than it was fixed for.
    pub fn grants(&self, probability: f64) -> bool {
        /// Probabilities are stated to the whole percent.
        const PERCENT: f64 = 0.01;
        (self.probability - probability).abs() < PERCENT
    }
}

fn stated_probability(
    coverage: &Coverage,
    conventions: &Conventions,
    refuted: bool,
) -> StatedProbability {
    match coverage.basis {
        CoverageBasis::Fixed if !conventions.state_probability => StatedProbability::Unnamed,
        CoverageBasis::Fixed if refuted => StatedProbability::Refuted,
        // What the fixed k happens to have, to the whole percent.
        CoverageBasis::Fixed => {
            StatedProbability::Of((coverage.probability * 100.0).round() / 100.0)
        }
        // EA-4/02: 95.45 % is what k = 2 has for a normal distribution; "about" goes with 95 %.
        _ if (coverage.probability - 0.9545).abs() < 1e-4 => StatedProbability::Of(0.95),
        _ => StatedProbability::Of(coverage.probability),
    }
}
