//! Conventions of the evaluation, and how the Monte Carlo method is run.

use crate::budget::conventions::{Adaptive, DofRule, OutputShape, Points, TScale};
use crate::budget::variants::TrialsEntry;
use gumption_format::toml::{table, words};

table! {
    /// Changes to single conventions of the profile.
    ConventionsTable "[conventions]" {
        /// Coverage probability p of the coverage interval: 0.95, 0.9545, 0.99.
        coverage_probability: f64,
        /// A fixed coverage factor k.
        coverage_factor: f64,
        /// The rule from which the coverage factor follows.
        coverage_factor_from: FactorWord,
        /// What is taken for the output's distribution where one or two components dominate it.
        output_distribution: OutputShape,
        /// How effective degrees of freedom that are no whole number enter t.
        degrees_of_freedom: DofRule,
        /// Significant digits of the expanded uncertainty: 1 or 2.
        digits: u64,
        /// How numbers are rounded.
        rounding: RoundingWord,
        /// What the stated u of a t-distributed input is in the Monte Carlo method.
        t_scale: TScale,
        /// Resolution and repeatability of the same input: both, or only the larger.
        resolution: ResolutionWord,
    }
}

words! {
    /// Where the coverage factor comes from.
    FactorWord {
        /// t, or the output distribution when a non-normal component dominates.
        Output "output",
        /// t at the effective degrees of freedom.
        StudentT "t",
        /// The normal quantile.
        Normal "normal",
    }
}

words! {
    /// How digits are dropped.
    RoundingWord {
        /// To nearest, ties to even.
        HalfEven "half-even",
        /// To nearest, ties away from zero.
        HalfUp "half-up",
        /// Always away from zero.
        Up "up",
    }
}

words! {
    /// Treatment of resolution beside repeatability.
    ResolutionWord {
        /// Both count.
        Add "add",
        /// Only the larger counts.
        Largest "largest",
    }
}

table! {
    /// How the Monte Carlo method is run.
    MonteCarloTable "[monte_carlo]" {
        /// Number of trials, or "adaptive". When left out 1000000, or 10000000 where these leave the verdict of JCGM 101 clause 8 open.
        trials: TrialsEntry,
        /// Adaptive procedure.
        procedure: Adaptive,
        /// Adaptive: significant digits of u to be stable (1 or 2).
        digits: u64,
        /// Adaptive: give up after so many trials.
        max_trials: u64,
        /// Seed of the random numbers; the same seed gives the same result everywhere.
        seed: u64,
        /// What trials are made of. Quasi-random points are run until the results are stable, as adaptive trials are, and give way to random ones where they are not far more accurate.
        points: Points,
        /// Give Sobol' sensitivity indices, too: the part of the variance that each input makes alone, and takes part in.
        indices: bool,
    }
}
