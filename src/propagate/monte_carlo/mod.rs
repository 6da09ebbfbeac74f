//! Propagation of distributions by Monte Carlo (JCGM 101:2008 clause 7; JCGM 102:2011 clause 7).
//!
//! | chapter | holds |
//! |---|---|
//! | [`joint_draw`] | trials of the input quantities, correlated as the budget says |
//! | [`budget_source`] | trials of the model |
//! | [`engine`] | chunks of trials shared among threads, handed on in order |
//! | [`store`] | the trials, kept |
//! | [`moments`] | mean, standard deviation, skewness, kurtosis |
//! | [`interval`] | median, symmetric and shortest coverage interval |
//! | [`existence`] | whether the moments exist at all, judged from the trials |
//! | [`heavy`] | components that are known to leave the output without moments |
//! | [`fractions`] | fractions of the trials between given limits |
//! | [`adaptive`] | how many trials |
//! | [`region`] | covariance and coverage regions of several outputs |

mod adaptive;
mod budget_source;
mod engine;
mod existence;
mod factor;
mod fractions;
mod heavy;
mod histogram;
mod interval;
mod joint_draw;
mod moments;
mod region;
mod sampler;
#[cfg(test)]
mod samples;
mod store;

use nalgebra::DMatrix;

use super::{EvaluationError, MonteCarlo, Regions, Run};
use crate::budget::{Budget, MonteCarloSettings, Trials};
use adaptive::Target;
pub(crate) use adaptive::{batch_size, least_batch};
use engine::{Layout, Source, simulate};
pub use existence::{Consequence, MissingMoments, Side};
use existence::{Tail, Verdict};
pub(crate) use fractions::fractions;
use heavy::HeavyComponent;
use interval::{Ordered, Ranks};
use moments::{Moments, Pivot};
use store::Store;

/// Most model values that are kept, over all outputs (1.6 GB). A fixed number of trials that needs
/// more is refused; an adaptive run stops there and says so.
const MOST_VALUES: u64 = 200_000_000;

/// What the GUM found for one output; moments are formed about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GumForMc {
    pub estimate: f64,
    pub u: f64,
}

/// What Monte Carlo found for a budget.
#[derive(Debug, Clone)]
pub(crate) struct McOutcome {
    pub run: Run,
    /// One per output.
    pub outputs: Vec<MonteCarlo>,
    /// Of several outputs whose standard deviations exist.
    pub covariance: Option<DMatrix<f64>>,
    pub correlation: Option<DMatrix<f64>>,
    pub regions: Option<Regions>,
    /// For every output why mean or standard deviation are not given.
    pub moments_missing: Vec<Option<MissingMoments>>,
}

/// Runs the Monte Carlo method on `threads` threads; the result does not depend on their number.
///
/// # Errors
/// [`EvaluationError::AllTrialsFailed`] when an output has fewer than two finite values, and
/// [`EvaluationError::TooManyTrials`] when the values of so many trials cannot be kept.
pub(crate) fn run(
    budget: &Budget,
    settings: &MonteCarloSettings,
    gum: &[GumForMc],
    threads: usize,
) -> Result<McOutcome, EvaluationError> {
    let most = most_trials(budget.model.outputs().len());
    if let Trials::Fixed(asked) = settings.trials
        && asked > most
    {
        return Err(EvaluationError::TooManyTrials { asked, most });
    }
    let source = budget_source::BudgetSource::new(budget, settings.seed);
    let question = Question {
        settings,
        p: budget.conventions.coverage_probability,
        pivots: gum.iter().map(|g| Pivot::new(g.estimate, g.u)).collect(),
        heavy: heavy::heavy_components(budget),
        threads,
    };
    question
        .ask(&source)
        .map_err(|output| EvaluationError::AllTrialsFailed {
            measurand: budget.model.outputs()[output].name.clone(),
        })
}

/// Trials whose values can be kept.
fn most_trials(outputs: usize) -> u64 {
    (MOST_VALUES / outputs.max(1) as u64).max(1)
}

/// What is asked of a source of trials.
struct Question<'a> {
    settings: &'a MonteCarloSettings,
    /// p of the coverage intervals.
    p: f64,
    /// Per output.
    pivots: Vec<Pivot>,
    heavy: Vec<Option<HeavyComponent>>,
    threads: usize,
}

impl Question<'_> {
    /// Draws the trials and summarises them; the error is the output that has no values.
    fn ask<S: Source>(&self, source: &S) -> Result<McOutcome, usize> {
        let (store, run) = self.draw(source);
        let moments: Vec<Moments> = self
            .pivots
            .iter()
            .enumerate()
            .map(|(output, pivot)| store.moments(output).unwrap_or(Moments::empty(*pivot)))
            .collect();
        if let Some(output) = moments.iter().position(|m| m.count() < 2) {
            return Err(output);
        }
        let joint = region::joint(store.columns(), self.p);
        let columns = store.into_columns().into_iter();
        let (outputs, verdicts): (Vec<_>, Vec<_>) = columns
            .zip(&moments)
            .zip(&self.heavy)
            .map(|((column, moments), heavy)| self.summary(column, moments, heavy.as_ref()))
            .unzip();
        let joint = joint.filter(|_| verdicts.iter().all(Verdict::has_deviation));
        let (covariance, correlation, regions) = joint
            .map(|j| (Some(j.covariance), Some(j.correlation), j.regions))
            .unwrap_or_default();
        let moments_missing = verdicts.into_iter().map(Verdict::reason).collect();
        Ok(McOutcome {
            run,
            outputs,
            covariance,
            correlation,
            regions,
            moments_missing,
        })
    }

    fn draw<S: Source>(&self, source: &S) -> (Store, Run) {
        let most = most_trials(source.outputs());
        let (store, adaptive) = match self.settings.trials {
            Trials::Fixed(trials) => {
                let trials = trials.clamp(1, most);
                let mut store = Store::new(source.outputs());
                let layout = Layout::new(trials);
                simulate(source, layout, 0..1, &self.pivots, self.threads, &mut store);
                (store, None)
            }
            Trials::Adaptive {
                procedure,
                digits,
                max,
            } => {
                let target = Target {
                    procedure,
                    digits,
                    max: max.clamp(1, most),
                    p: self.p,
                };
                let (store, run) = adaptive::run(source, &self.pivots, target, self.threads);
                (store, Some(run))
            }
        };
        let run = Run {
            trials: store.trials() as u64,
            seed: self.settings.seed,
            coverage_probability: self.p,
            adaptive,
        };
        (store, run)
    }

    /// Everything about one output.
    fn summary(
        &self,
        mut values: Vec<f64>,
        moments: &Moments,
        heavy: Option<&HeavyComponent>,
    ) -> (MonteCarlo, Verdict) {
        if moments.failed() > 0 {
            values.retain(|value| value.is_finite());
        }
        let ranks = Ranks::new(values.len(), self.p);
        let depth = ranks.last.max(Tail::reach(values.len()) + 2);
        let ordered = Ordered::new(&values, depth, self.threads);
        let tail = Tail::heavier(&ordered);
        let verdict = Verdict::new(heavy, &tail).with_error_of_u(moments.sd_error() / moments.sd());
        let (has_mean, has_deviation) = (verdict.has_mean(), verdict.has_deviation());
        let symmetric = ordered.symmetric(ranks);
        let given = |given: bool, value: f64| given.then_some(value);
        let result = MonteCarlo {
            estimate: given(has_mean, moments.mean()),
            u: given(has_deviation, moments.sd()),
            median: ordered.median(),
            symmetric,
            shortest: ordered.shortest(ranks),
            skewness: moments
                .skewness()
                .filter(|_| has_deviation && tail.exists(3.0)),
            excess_kurtosis: moments
                .excess_kurtosis()
                .filter(|_| has_deviation && tail.exists(4.0)),
            standard_errors: [
                given(has_deviation, moments.mean_error()).unwrap_or(f64::NAN),
                given(has_deviation, moments.sd_error()).unwrap_or(f64::NAN),
                ordered.standard_error(ranks.symmetric),
                ordered.standard_error(ranks.symmetric + ranks.covered),
            ],
            failed: moments.failed(),
            histogram: histogram::histogram(&values, ordered.range(), symmetric, self.threads),
        };
        (result, verdict)
    }
}

#[cfg(test)]
mod tests;
