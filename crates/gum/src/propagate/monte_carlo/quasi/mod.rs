//! Quasi-random points in place of random trials, where they need far fewer for the same accuracy.
//!
//! Several independently scrambled Sobol' sequences are run side by side. Each gives its own estimate,
//! standard uncertainty and coverage intervals, without bias; their scatter tells the error of what all of
//! them give together (randomised quasi-Monte Carlo; L'Ecuyer and Lemieux 2002, Owen 1997). Points are
//! added until all results are stable to the numerical tolerance δ of JCGM 101, 7.9.2.
//!
//! Nothing is believed on trust: where the scatter is not far below that of random trials of the same number,
//! where points have no value, and where a check beforehand finds what the method cannot have, random trials
//! are run, and the result says why.
//!
//! | chapter | holds |
//! |---|---|
//! | [`points`] | points of the input quantities |
//! | [`shapes`] | quantile functions on blocks |
//! | [`trial`] | the model at points |
//! | [`averaging`] | what can be averaged over in place of being drawn |
//! | [`laws`] | distribution functions of that |
//! | [`conditional`] | results from averages |
//! | [`pooled`] | results of single scrambles, and of all together |
//! | [`counted`] | results from the values at the points |
//! | [`tails`] | quantiles and the shortest interval of a distribution function known at some places |

mod averaging;
mod conditional;
mod counted;
mod laws;
mod points;
mod pooled;
mod shapes;
mod tails;
mod trial;

#[cfg(test)]
mod tests;

use std::ops::Range;

use gumption_lanes::LANES;

use super::moments::Pivot;
use super::outcome::{FirstOrder, Outcome};
use crate::budget::{Budget, MonteCarloSettings, Trials};
use crate::propagate::result::{Histogram, MonteCarlo, Quasi, QuasiRun, Run, WhyRandom};
use crate::propagate::validation::numerical_tolerance;
use conditional::Conditional;
use counted::Counted;
use gumption_core::distribution::Distribution;
use gumption_core::special::student_t_upper_quantile;
use points::Points;
use pooled::{Figures, Pooled, REPLICATES, Trouble};

/// Most points, which are kept in memory where values are counted.
const MOST_POINTS: u64 = 1 << 22;

/// Blocks of every scramble that a model with corners, steps or branches takes at least: what happens in few
/// places only must be met.
const ROUGH_BLOCKS: u64 = 16;

/// Random trials that a point must replace; a point takes the time of some.
const LEAST_GAIN: f64 = 8.0;

/// Probability that any result is further than δ from its true value.
const RISK: f64 = 0.05;

/// Standard uncertainties within which the model must have no pole.
const REACH: f64 = 8.0;

/// Runs quasi-random points for a budget, or tells why random trials should be run.
pub(super) fn run(
    budget: &Budget,
    settings: &MonteCarloSettings,
    gum: &[FirstOrder],
    threads: usize,
) -> Result<Outcome, WhyRandom> {
    suitable(budget)?;
    let pivot = gum
        .first()
        .map_or(Pivot::new(0.0, 1.0), |gum| Pivot::new(gum.estimate, gum.u));
    let least_blocks = if budget.model.is_smooth() {
        1
    } else {
        ROUGH_BLOCKS
    };
    let goal = Goal::new(&settings.trials, least_blocks);
    let points_without = |held: &[usize]| {
        Points::new(budget, settings.seed, held)
            .map_err(|component| WhyRandom::Discrete { component })
    };
    if let Some(averaged) = averaging::choose(budget, settings.seed) {
        let points = points_without(&averaged.held())?;
        let method = Conditional::new(budget, &points, &averaged, pivot);
        match goal.pursue(Method::Conditional(method), threads) {
            Err(Stop::Trouble(Trouble::Flat)) => (),
            found => {
                let names = averaged.names(budget);
                return Ok(found?.outcome(budget, settings, names));
            }
        }
    }
    let points = points_without(&[])?;
    let p = budget.conventions.coverage_probability;
    let method = Method::Counted(Counted::new(&points, pivot, p));
    let found = goal.pursue(method, threads)?;
    Ok(found.outcome(budget, settings, Vec::new()))
}

/// What can be known without drawing a point.
fn suitable(budget: &Budget) -> Result<(), WhyRandom> {
    if budget.model.outputs().len() != 1 {
        return Err(WhyRandom::SeveralMeasurands);
    }
    if !budget.conformity.is_empty() || !budget.detection.is_empty() {
        return Err(WhyRandom::TrialsAreCounted);
    }
    let heavy = budget
        .components
        .iter()
        .find(|component| component.distribution.variance().is_none());
    if let Some(component) = heavy {
        return Err(WhyRandom::HeavyTail {
            component: component.name.to_string(),
        });
    }
    let x: Vec<f64> = budget.inputs.iter().map(|input| input.estimate).collect();
    let mut u = vec![0.0; x.len()];
    for (u, input) in u.iter_mut().zip(&budget.inputs) {
        // Correlated terms may add up.
        *u = input
            .terms
            .iter()
            .map(|t| (t.coefficient * budget.components[t.component].u).abs())
            .sum();
    }
    if budget.model.near_singular(&x, &u, REACH).is_empty() {
        Ok(())
    } else {
        Err(WhyRandom::NearSingular)
    }
}

/// How a run may end without results.
enum Stop {
    Trouble(Trouble),
    NoGain(f64),
}

impl From<Stop> for WhyRandom {
    fn from(stop: Stop) -> WhyRandom {
        match stop {
            Stop::Trouble(Trouble::HeavyTail) => WhyRandom::OutputTail,
            Stop::Trouble(Trouble::NotFinite | Trouble::Flat) => WhyRandom::NotFinite,
            Stop::NoGain(gain) => WhyRandom::NoGain { gain },
        }
    }
}

/// How results are found.
enum Method<'p, 'b> {
    Conditional(Conditional<'p, 'b>),
    Counted(Counted<'p, 'b>),
}

impl Method<'_, '_> {
    fn extend(&mut self, blocks: Range<u64>, bits: u32, threads: usize) -> Result<(), Trouble> {
        match self {
            Method::Conditional(of) => of.extend(blocks, bits, threads),
            Method::Counted(of) => of.extend(blocks, bits, threads),
        }
    }

    fn replicates(&self, threads: usize) -> Vec<Figures> {
        match self {
            Method::Conditional(of) => of.replicates(),
            Method::Counted(of) => of.replicates(threads),
        }
    }

    fn shortest(&self, pooled: [f64; 2], threads: usize) -> Vec<[f64; 2]> {
        match self {
            Method::Conditional(of) => of.shortest(pooled),
            Method::Counted(of) => of.shortest(threads),
        }
    }

    fn pooled(&self) -> Result<Pooled, Trouble> {
        match self {
            Method::Conditional(of) => Ok(of.pooled()),
            Method::Counted(of) => of.pooled(),
        }
    }

    fn picture(&self, interval: [f64; 2], points: u64, threads: usize) -> Histogram {
        match self {
            Method::Conditional(of) => of.picture(interval, points),
            Method::Counted(of) => of.picture(interval, threads),
        }
    }

    /// The power of the number of points with which errors fall at best, as a rule: further points cost
    /// less than too many.
    fn order(&self) -> f64 {
        match self {
            Method::Conditional(_) => 1.5,
            Method::Counted(_) => 1.0,
        }
    }

    /// Blocks of every scramble in the first attempt.
    fn first(&self) -> u64 {
        match self {
            Method::Conditional(_) => 1,
            // Counts of values need more to be worth anything.
            Method::Counted(_) => 4,
        }
    }
}

/// What a run is to reach.
struct Goal {
    digits: u8,
    /// Fewest blocks of every scramble.
    least_blocks: u64,
    /// Most points of all scrambles.
    most: u64,
    /// Random trials that would be run otherwise.
    otherwise: u64,
}

/// A run that ended with results.
struct Found {
    pooled: Pooled,
    scatter: Scatter,
    /// The shortest interval of every scramble.
    shortest: Vec<[f64; 2]>,
    picture: Histogram,
    points: u64,
    gain: f64,
    digits: u8,
    delta: f64,
    reached: bool,
}

impl Goal {
    fn new(trials: &Trials, least_blocks: u64) -> Goal {
        let (digits, most) = match *trials {
            Trials::Fixed(most) | Trials::Decisive { least: most, .. } => (2, most),
            Trials::Adaptive { digits, max, .. } => (digits, max),
        };
        Goal {
            digits,
            least_blocks,
            most: most.min(MOST_POINTS),
            otherwise: most,
        }
    }

    /// Adds points until the results are stable, or it is plain that random trials are no worse.
    ///
    /// At attempt k all four results are held to be within δ where t times their errors is, for a risk of
    /// 5 %/2ᵏ shared among them: over all attempts the risk stays below 5 %.
    ///
    /// Errors that fall in proportion to the points make the gain grow as much as the points do. Where it would not
    /// be enough even so when all results are within δ, no more are tried.
    fn pursue(&self, mut method: Method<'_, '_>, threads: usize) -> Result<Found, Stop> {
        let mut done = 0;
        let mut blocks = method.first().max(self.least_blocks);
        for attempt in 1.. {
            let points = blocks * LANES as u64;
            method
                .extend(done..blocks, points.ilog2(), threads)
                .map_err(Stop::Trouble)?;
            done = blocks;
            let all = points * REPLICATES as u64;
            let scatter = Scatter(method.replicates(threads));
            let delta = numerical_tolerance(scatter.mean_of(|f| f.u), self.digits);
            let risk = RISK * 0.5_f64.powi(attempt) / 8.0;
            let t = student_t_upper_quantile(risk, (REPLICATES - 1) as f64);
            let missing = t * largest(&scatter.errors()) / delta;
            let reached = missing <= 1.0;
            let last = 2 * all > self.most;
            let pooled = method.pooled().map_err(Stop::Trouble)?;
            let gain = gain(&scatter.errors(), &pooled.plain_errors);
            let enough = last && gain * all as f64 >= self.otherwise as f64;
            if reached || enough {
                return Ok(Found {
                    picture: method.picture(pooled.symmetric, all, threads),
                    shortest: method.shortest(pooled.shortest, threads),
                    pooled,
                    scatter,
                    points: all,
                    gain,
                    digits: self.digits,
                    delta,
                    reached,
                });
            }
            if last || gain * missing < LEAST_GAIN {
                return Err(Stop::NoGain(gain));
            }
            blocks *= factor(libm::pow(missing, 1.0 / method.order()), self.most / all);
        }
        // The loop has no end of its own.
        Err(Stop::NoGain(0.0))
    }
}

/// The power of two by which to multiply the points where so many times as many are wanted.
fn factor(wanted: f64, most: u64) -> u64 {
    let wanted = wanted.clamp(1.0, 16.0).ceil() as u64;
    let allowed = 1 << most.max(2).ilog2();
    wanted.next_power_of_two().max(2).min(allowed)
}

/// The largest of the errors that are known.
fn largest(errors: &[f64; 4]) -> f64 {
    let known = errors.iter().copied().filter(|error| error.is_finite());
    known.fold(0.0, f64::max)
}

/// Random trials that a point replaces, for the result that needs most of them.
fn gain(errors: &[f64; 4], plain: &[f64; 4]) -> f64 {
    let (ours, plain) = (largest(errors), largest(plain));
    if ours > 0.0 {
        (plain / ours) * (plain / ours)
    } else {
        f64::INFINITY
    }
}

/// The results of all scrambles.
struct Scatter(Vec<Figures>);

impl Scatter {
    /// Standard errors of estimate, u and both ends of the symmetric interval.
    fn errors(&self) -> [f64; 4] {
        [
            self.error_of(|f| f.mean),
            self.error_of(|f| f.u),
            self.error_of(|f| f.symmetric[0]),
            self.error_of(|f| f.symmetric[1]),
        ]
    }

    fn mean_of(&self, figure: impl Fn(&Figures) -> f64) -> f64 {
        self.0.iter().map(figure).sum::<f64>() / self.0.len() as f64
    }

    fn error_of(&self, figure: impl Fn(&Figures) -> f64) -> f64 {
        error_of(&self.0, figure)
    }
}

/// The standard deviation of the scrambles' results over the root of their number; exactly zero where they agree.
fn error_of<T>(scrambles: &[T], figure: impl Fn(&T) -> f64) -> f64 {
    let n = scrambles.len() as f64;
    let first = scrambles.first().map_or(f64::NAN, &figure);
    let mean = scrambles.iter().map(|of| figure(of) - first).sum::<f64>() / n;
    let square = |of: &T| (figure(of) - first - mean).powi(2);
    (scrambles.iter().map(square).sum::<f64>() / ((n - 1.0) * n)).sqrt()
}

impl Found {
    fn outcome(
        self,
        budget: &Budget,
        settings: &MonteCarloSettings,
        averaged: Vec<String>,
    ) -> Outcome {
        let Pooled {
            moments,
            median,
            symmetric,
            shortest,
            ..
        } = self.pooled;
        let shortest_errors = [0, 1].map(|end: usize| error_of(&self.shortest, |ends| ends[end]));
        // A t of few degrees of freedom has no third or fourth moment (JCGM 101, 6.4.9.4): nor has the output.
        let exists = |moment: fn(&Distribution) -> Option<f64>| {
            let mut components = budget.components.iter();
            components.all(|component| moment(&component.distribution).is_some())
        };
        let third = exists(Distribution::third_central_moment);
        let fourth = exists(Distribution::fourth_central_moment);
        let output = MonteCarlo {
            estimate: Some(moments.mean()),
            u: Some(moments.sd()),
            median,
            symmetric,
            shortest,
            skewness: moments.skewness().filter(|_| third),
            excess_kurtosis: moments.excess_kurtosis().filter(|_| fourth),
            standard_errors: self.scatter.errors(),
            failed: 0,
            histogram: self.picture,
        };
        Outcome {
            run: Run {
                trials: self.points,
                seed: settings.seed,
                coverage_probability: budget.conventions.coverage_probability,
                adaptive: None,
                quasi: Some(Quasi::Used(QuasiRun {
                    replicates: REPLICATES,
                    averaged,
                    digits: self.digits,
                    delta: self.delta,
                    reached: self.reached,
                    equivalent_trials: self.gain * self.points as f64,
                    shortest_errors,
                })),
            },
            outputs: vec![output],
            covariance: None,
            correlation: None,
            regions: None,
            moments_missing: vec![None],
        }
    }
}
