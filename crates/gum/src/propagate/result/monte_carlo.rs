//! What the Monte Carlo method finds, and how it was run.

use super::quasi::Quasi;
use crate::budget::Adaptive;

/// Monte Carlo results for one measurand.
#[derive(Debug, Clone, serde::Serialize)]
pub struct MonteCarlo {
    /// Mean; `None` when the moment does not exist or does not converge.
    pub estimate: Option<f64>,
    /// Standard deviation; likewise.
    pub u: Option<f64>,
    /// Median; exists always.
    pub median: f64,
    /// Probabilistically symmetric p-interval (JCGM 101 7.7.2, 5.3.3).
    pub symmetric: [f64; 2],
    /// Shortest p-interval (5.3.4).
    pub shortest: [f64; 2],
    /// γ₁; `None` when the moments do not exist.
    pub skewness: Option<f64>,
    /// γ₂, zero for a normal distribution; likewise.
    pub excess_kurtosis: Option<f64>,
    /// Standard error of estimate, u and the two symmetric endpoints (batch method).
    pub standard_errors: [f64; 4],
    /// Trials whose model value was not a finite number (division by zero, root of a negative …).
    pub failed: u64,
    /// 64 bins over the central range, for plots: left edge of the first, bin width, counts.
    pub histogram: Histogram,
}

/// Mean and standard deviation of trials.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct TrialMoments {
    /// Mean.
    pub estimate: f64,
    /// Standard deviation.
    pub u: f64,
}

/// Counts in equal bins.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Histogram {
    /// Left edge of the first bin.
    pub start: f64,
    /// Width of a bin.
    pub width: f64,
    /// Trials in each bin.
    pub counts: Vec<u64>,
}

/// How the Monte Carlo method was run.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Run {
    /// Trials that were run.
    pub trials: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// p of the intervals.
    pub coverage_probability: f64,
    /// For an adaptive run: procedure, δ of each measurand, whether it was reached.
    pub adaptive: Option<AdaptiveRun>,
    /// Where quasi-random points were asked for: whether they were used; `trials` is their number then.
    pub quasi: Option<Quasi>,
}

/// What an adaptive run reached.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AdaptiveRun {
    /// Which procedure.
    pub procedure: Adaptive,
    /// Significant digits of u(y) that were to be stable.
    pub digits: u8,
    /// Numerical tolerance of each measurand (JCGM 101 7.9.2).
    pub delta: Vec<f64>,
    /// Whether all results were stable before the maximum of trials.
    pub reached: bool,
}

/// Why the mean or the standard deviation of an output is not given.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum MissingMoments {
    /// As far as the trials reach, the output grows like a power of a component whose t distribution has moments of
    /// order below ν only: no standard deviation for ν ≤ 2·power, no mean for ν ≤ power.
    HeavyComponent {
        /// Its name.
        name: String,
        /// Its ν.
        dof: f64,
        /// Like which power of the component the output grows; one in sums, products and quotients.
        power: f64,
    },
    /// Simultaneous readings: the means are multivariate t with ν = n − N ≤ 2 (JCGM 102 5.3.2).
    JointReadings {
        /// Names of the N inputs.
        inputs: Vec<String>,
        /// n, how often all of them were read.
        readings: usize,
    },
    /// The extreme trials fall off like a power of the distance from the median.
    Tail {
        /// Which end.
        side: Side,
        /// Exponent of that power.
        index: f64,
        /// What follows for the moments.
        consequence: Consequence,
    },
    /// A handful of far trials decides the standard deviation.
    FewTrials {
        /// Standard error of u by the fourth moment of the trials, as a fraction of u.
        relative_error: f64,
    },
}

impl MissingMoments {
    /// Whether a standard deviation exists, which the trials do not settle on.
    pub fn leave_a_deviation(&self) -> bool {
        match self {
            MissingMoments::HeavyComponent { .. } | MissingMoments::JointReadings { .. } => false,
            MissingMoments::Tail { consequence, .. } => *consequence == Consequence::SlowDeviation,
            MissingMoments::FewTrials { .. } => true,
        }
    }

    /// Whether the standard deviation alone is missing, and a mean is given.
    pub fn leave_a_mean(&self) -> bool {
        match self {
            MissingMoments::HeavyComponent { dof, power, .. } => dof > power,
            MissingMoments::JointReadings { inputs, readings } => *readings > inputs.len() + 1,
            MissingMoments::Tail { consequence, .. } => {
                !matches!(consequence, Consequence::NoMean | Consequence::SlowMean)
            }
            MissingMoments::FewTrials { .. } => true,
        }
    }
}

/// Which end of the distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Side {
    /// The one with the smallest values.
    Lower,
    /// The one with the largest values.
    Upper,
}

/// What a heavy tail does to the first two moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Consequence {
    /// Neither mean nor standard deviation exists.
    NoMean,
    /// The mean exists but does not settle; the standard deviation does not exist.
    SlowMean,
    /// The standard deviation does not exist.
    NoDeviation,
    /// The standard deviation exists but does not settle: ten times the trials would not halve its
    /// error.
    SlowDeviation,
}
