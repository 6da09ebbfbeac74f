//! What a run with quasi-random points reached, or why there was none.

/// Whether quasi-random points gave the results.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum Quasi {
    /// They did.
    Used(QuasiRun),
    /// Random trials did.
    Refused(WhyRandom),
}

/// What a run with quasi-random points reached.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct QuasiRun {
    /// Independent scrambles; their points together are the run's trials.
    pub replicates: usize,
    /// Names of the components that were averaged over in place of being drawn.
    pub averaged: Vec<String>,
    /// Significant digits of u(y) that were to be stable.
    pub digits: u8,
    /// Numerical tolerance (JCGM 101 7.9.2).
    pub delta: f64,
    /// Whether all results are within δ with a probability of 95 %.
    pub reached: bool,
    /// Random trials that would have errors as small.
    pub equivalent_trials: f64,
    /// Standard errors of both ends of the shortest interval.
    pub shortest_errors: [f64; 2],
}

/// Why random trials were run although quasi-random points were asked for.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum WhyRandom {
    /// There is more than one measurand.
    SeveralMeasurands,
    /// Something else in the budget counts trials: conformity, characteristic limits.
    TrialsAreCounted,
    /// A component has single values, not an interval of them.
    Discrete {
        /// Its name.
        component: String,
    },
    /// A component has no standard deviation.
    HeavyTail {
        /// Its name.
        component: String,
    },
    /// The model may have a pole or the end of its domain within reach.
    NearSingular,
    /// Some points have no finite value.
    NotFinite,
    /// The output's tails are too heavy for a standard deviation.
    OutputTail,
    /// Errors are not far enough below those of random trials.
    NoGain {
        /// Random trials that a point replaces.
        gain: f64,
    },
}
