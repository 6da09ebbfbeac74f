//! Conventions on which guides differ, and settings of the Monte Carlo method.

use gumption_format::toml::words;
use gumption_lanes::linear::cut;

use gumption_core::quantity::{Rounding, RoundingRule};
use gumption_core::special::{normal_two_sided_quantile, student_t_two_sided_quantile};

/// The conventions on which guides differ, after profile and overrides.
#[derive(Debug, Clone, PartialEq)]
pub struct Conventions {
    /// Name of the profile that was chosen (`GUM`, `EA`, `JJF`, `NIST`, `UKAS`, …).
    pub profile: String,
    /// What the file changed in it, for the report (`coverage_probability = 0.99`).
    pub overrides: Vec<String>,
    /// p of the coverage interval, 0.95 or 0.9545 …
    pub coverage_probability: f64,
    /// Where k comes from.
    pub coverage_factor: CoverageRule,
    /// What Monte Carlo has to confirm for the GUM result to be stated.
    pub confirmation: Confirmation,
    /// p of a k that follows from the distribution of the output.
    pub output_probability: f64,
    /// What [`CoverageRule::Output`] takes for the output's distribution.
    pub output_shape: OutputShape,
    /// How ν_eff enters t.
    pub degrees_of_freedom: DofRule,
    /// How numbers are rounded.
    pub rounding: Rounding,
    /// Significant digits of U: 1 or 2.
    pub digits: u8,
    /// EA-4/02 6.3: use the rounded-up value when rounding lowers U by more than 5 %.
    pub up_if_lowered_by_5_percent: bool,
    /// What u is for a t distribution in the Monte Carlo method.
    pub t_scale: TScale,
    /// Print k and not p (JJF 1059.1 with k = 2).
    pub state_probability: bool,
    /// How the statement writes result and uncertainty.
    pub statement: StatementForm,
}

impl Conventions {
    /// How U and y are rounded.
    pub(crate) fn rounding_rule(&self) -> RoundingRule {
        RoundingRule {
            digits: self.digits,
            rounding: self.rounding,
            up_if_lowered_by_5_percent: self.up_if_lowered_by_5_percent,
        }
    }

    /// k for so many degrees of freedom: the one that is fixed, or that of the normal or t-distribution.
    pub fn factor(&self, dof: f64) -> f64 {
        let p = self.coverage_probability;
        match self.coverage_factor {
            CoverageRule::Fixed(k) => k,
            CoverageRule::Normal => normal_two_sided_quantile(p),
            CoverageRule::Output | CoverageRule::StudentT => {
                student_t_two_sided_quantile(p, self.degrees_of_freedom.entered(dof))
            }
        }
    }

    /// Whether the file itself states a convention, rather than its profile.
    pub fn states(&self, key: &str) -> bool {
        let stated = |text: &String| text.split_once(" = ").is_some_and(|(name, _)| name == key);
        self.overrides.iter().any(stated)
    }
}

/// Where k comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CoverageRule {
    /// t_p(ν_eff), but from the actual distribution of the (linearised) output when one or two
    /// rectangles or another non-normal component dominate.
    Output,
    /// t_p(ν_eff) always (normal when ν_eff is infinite).
    StudentT,
    /// The normal quantile always.
    Normal,
    /// This number.
    Fixed(f64),
}

/// How the Monte Carlo method is run.
#[derive(Debug, Clone, PartialEq)]
pub struct MonteCarloSettings {
    /// Seed of the random numbers.
    pub seed: u64,
    /// How many trials.
    pub trials: Trials,
    /// What trials are made of.
    pub points: Points,
    /// Whether Sobol' sensitivity indices are wanted, too.
    pub indices: bool,
}

/// What a caller wants instead of the settings of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wanted {
    /// Seed of the random numbers.
    pub seed: Option<u64>,
    /// How many trials.
    pub trials: Option<Trials>,
    /// What trials are made of.
    pub points: Option<Points>,
    /// Whether Sobol' sensitivity indices are wanted where the file does not ask for them.
    pub indices: bool,
}

impl MonteCarloSettings {
    /// The settings with what a caller wants instead.
    pub fn with(&self, wanted: &Wanted) -> MonteCarloSettings {
        let trials = match (&wanted.trials, wanted.points, &self.trials) {
            (Some(trials), _, _) => trials.clone(),
            // Such points are run until the results are stable, if the file does not say how many.
            (None, Some(Points::QuasiRandom), Trials::Decisive { .. }) => Trials::ADAPTIVE,
            (None, _, trials) => trials.clone(),
        };
        MonteCarloSettings {
            seed: wanted.seed.unwrap_or(self.seed),
            trials,
            points: wanted.points.unwrap_or(self.points),
            indices: wanted.indices || self.indices,
        }
    }
}

/// How many trials.
#[derive(Debug, Clone, PartialEq)]
pub enum Trials {
    /// Exactly this many.
    Fixed(u64),
    /// `least`, and once more `most` where these leave a verdict of JCGM 101 clause 8 open at the digits that
    /// are reported.
    Decisive {
        /// Enough for most budgets.
        least: u64,
        /// Enough for nearly all others.
        most: u64,
    },
    /// Until the results are stable to a numerical tolerance, JCGM 101 7.9: δ from `digits`
    /// significant digits of u.
    Adaptive {
        /// Which procedure.
        procedure: Adaptive,
        /// Significant digits of u to be stable.
        digits: u8,
        /// Give up after so many trials.
        max: u64,
    },
}

impl Trials {
    /// Until two digits are stable.
    pub const ADAPTIVE: Trials = Trials::Adaptive {
        procedure: Adaptive::Stein,
        digits: 2,
        max: 100_000_000,
    };

    /// As many as may be drawn.
    pub fn most(&self) -> u64 {
        match *self {
            Trials::Fixed(trials) => trials,
            Trials::Decisive { most, .. } => most,
            Trials::Adaptive { max, .. } => max,
        }
    }
}

/// What Monte Carlo has to confirm for the GUM result to be stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Confirmation {
    /// The ends of the interval (JCGM 101 clause 8): a probability is claimed.
    Interval,
    /// y and u, as with any k that is fixed: the guide multiplies u by its k and leaves it at that, also for a few
    /// readings.
    Moments,
}

/// How a statement writes result and uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StatementForm {
    /// `y = (… ± …) unit`.
    PlusMinus,
    /// `y = … unit, U = … unit, k = …` (JJF 1059.1 5.3; a lone uncertainty carries no sign).
    Apart,
}

words! {
    /// The distribution of an output in which one or two contributions dominate.
    OutputShape {
        /// The convolution of the dominant contributions with a normal remainder: k has the stated
        /// probability.
        Convolution "convolution",
        /// The dominant contributions alone, applied to the whole of u(y): the published figures of
        /// EA-4/02 S9 and S10.
        DominantAlone "dominant",
    }
}

words! {
    /// How effective degrees of freedom that are no integer enter t_p(ν_eff).
    DofRule {
        /// Cut to the next lower integer (GUM G.4.1 and H.1.6, EA-4/02 appendix E, JJF 1059.1, M3003).
        Truncated "truncated",
        /// As they are, which is the exact form of the interpolation that GUM G.4.1 also allows.
        Real "real",
    }
}

impl DofRule {
    /// ν by which t is entered; rounded to two decimals before it is cut, since u and ν are never known to more.
    pub fn entered(self, dof: f64) -> f64 {
        match self {
            DofRule::Truncated => cut(dof),
            DofRule::Real => dof,
        }
    }
}

words! {
    /// What a t-distributed input's stated u is in the Monte Carlo method.
    TScale {
        /// u is the scale parameter (JCGM 101 6.4.9).
        Scale "scale",
        /// u is the standard deviation (NIST Uncertainty Machine, TN 1900).
        StandardDeviation "standard-deviation",
    }
}

words! {
    /// What the trials of the Monte Carlo method are made of.
    Points {
        /// Random numbers, as JCGM 101 has it.
        Random "random",
        /// Scrambled Sobol' points wherever they are far more accurate, else random numbers.
        QuasiRandom "quasi-random",
    }
}

words! {
    /// The two adaptive procedures.
    #[derive(serde::Serialize)]
    Adaptive {
        /// Two-stage (Stein) procedure of Wübbeler, Harris, Cox and Elster (2010).
        Stein "stein",
        /// JCGM 101 7.9.4.
        Jcgm101 "jcgm101",
    }
}
