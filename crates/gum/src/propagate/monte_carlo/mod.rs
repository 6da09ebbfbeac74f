//! Propagation of distributions by Monte Carlo (JCGM 101:2008 clause 7; JCGM 102:2011 clause 7).
//!
//! | chapter | holds |
//! |---|---|
//! | [`joint_draw`] | trials of the input quantities, correlated as the budget says |
//! | [`assembly`] | how the values of an input come about |
//! | [`margin`] | margins of a Gaussian copula |
//! | [`budget_source`] | trials of the model |
//! | [`thread_pool`] | threads that share the work of a run |
//! | [`engine`] | chunks of trials shared among threads, handed on in order |
//! | [`collect`] | the first trials kept, the others counted and summed |
//! | [`order_counts`] | counts of all values, and the values that matter for their order |
//! | [`thread_counts`] | how one thread takes values into them |
//! | [`decisive_cells`] | which values matter |
//! | [`resolve`] | exact order statistics, where needed from trials drawn again |
//! | [`moments`] | mean, standard deviation, skewness, kurtosis |
//! | [`histogram`] | the picture of an output distribution |
//! | [`interval`] | median, symmetric and shortest coverage interval |
//! | [`existence`] | whether the moments exist at all, judged from the trials |
//! | [`heavy_components`] | components of few degrees of freedom that leave the output without moments |
//! | [`draws`] | the values of trials themselves |
//! | [`fractions`] | fractions of the trials between given limits |
//! | [`adaptive`] | how many trials |
//! | [`indices`] | Sobol' sensitivity indices |
//! | [`quasi`] | quasi-random points in place of trials |
//! | [`comoments`] | covariance of several outputs |
//! | [`region`] | coverage regions of several outputs |
//! | [`outcome`] | what the method is given and gives |

mod adaptive;
mod assembly;
mod budget_source;
mod collect;
mod comoments;
mod decisive_cells;
mod draws;
mod engine;
mod existence;
mod fractions;
mod heavy_components;
mod histogram;
mod indices;
mod interval;
mod joint_draw;
mod margin;
mod moments;
mod order_counts;
mod outcome;
mod quasi;
mod region;
mod resolve;
#[cfg(test)]
mod samples;
mod thread_counts;
mod thread_pool;

use std::borrow::Cow;

use super::error::EvaluationError;
use super::options::Workers;
use super::result::{AdaptiveRun, Histogram, MonteCarlo, Quasi, Run};
use crate::budget::{Budget, MonteCarloSettings, Points, Trials};
use adaptive::Target;
pub(super) use adaptive::{batch_size, least_batch};
use collect::{Collector, Held, Plan};
use decisive_cells::Wanted;
pub use draws::draws;
use engine::{Layout, Source};
use existence::{Tail, Verdict};
pub(super) use fractions::fractions;
use heavy_components::HeavyComponent;
pub(super) use indices::indices;
use interval::Around;
pub(super) use interval::{Ordered, Ranked, Ranks};
use moments::{Moments, Pivot};
pub(super) use outcome::{FirstOrder, Outcome};
use resolve::{Redraw, Resolved};
use thread_pool::ThreadPool;
pub(crate) use thread_pool::parallel_map;

/// Runs the Monte Carlo method; the result does not depend on the number of threads.
///
/// # Errors
/// [`EvaluationError::AllTrialsFailed`] when an output has fewer than two finite values.
pub(super) fn run(
    budget: &Budget,
    settings: &MonteCarloSettings,
    gum: &[FirstOrder],
    workers: Workers<'_>,
) -> Result<Outcome, EvaluationError> {
    let refused = match settings.points {
        Points::Random => None,
        Points::QuasiRandom => match quasi::run(budget, settings, gum, workers.threads) {
            Ok(outcome) => return Ok(outcome),
            Err(why) => Some(Quasi::Refused(why)),
        },
    };
    let source = budget_source::BudgetSource::new(budget, settings.seed, workers.progress);
    let question = Question {
        settings,
        p: budget.conventions.coverage_probability,
        pivots: gum.iter().map(|g| Pivot::new(g.estimate, g.u)).collect(),
        heavy: heavy_components::heavy_components(budget, settings.trials.most()),
        threads: workers.threads,
    };
    let mut outcome = question
        .ask(&source)
        .map_err(|output| EvaluationError::AllTrialsFailed {
            measurand: budget.model.outputs()[output].name.clone(),
        })?;
    outcome.run.quasi = refused;
    Ok(outcome)
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
    /// Draws the trials and summarises them; the error is the output that has no values, the first of a run that was
    /// stopped.
    fn ask<S: Source>(&self, source: &S) -> Result<Outcome, usize> {
        let layout = self.layout();
        let batches = match self.settings.trials {
            Trials::Fixed(_) | Trials::Decisive { .. } => 1,
            Trials::Adaptive { max, .. } => max.div_ceil(layout.batch()),
        };
        let chunks = layout.chunks(0..batches).end;
        ThreadPool::with(self.threads, chunks, |pool| self.ask_with(pool, source))
    }

    fn ask_with<'env, S: Source>(
        &self,
        pool: &ThreadPool<'env>,
        source: &'env S,
    ) -> Result<Outcome, usize> {
        let layout = self.layout();
        let ask = |count| self.wanted(count);
        let mut collector = Collector::new(Plan {
            pool,
            source,
            layout,
            pivots: &self.pivots,
            p: self.p,
            ask: &ask,
        });
        let adaptive = self.draw(layout, &mut collector);
        if source.settle() {
            return Err(0);
        }
        let run = Run {
            trials: collector.trials(),
            seed: self.settings.seed,
            coverage_probability: self.p,
            adaptive,
            quasi: None,
        };
        let redraw = Redraw {
            pool,
            source,
            layout,
            chunks: collector.chunks(),
        };
        let moments = collector.moments();
        if let Some(output) = moments.iter().position(|m| m.count() < 2) {
            return Err(output);
        }
        let mut held = collector.into_held();
        let (outputs, verdicts): (Vec<_>, Vec<_>) = (0..moments.len())
            .map(|output| self.summary(output, &mut held, &moments[output], &redraw))
            .unzip();
        let joint = held
            .joint_moments()
            .filter(|_| verdicts.iter().all(Verdict::has_deviation))
            .and_then(|joint| region::joint(&redraw, &joint, self.p));
        let (covariance, correlation, regions) = joint
            .map(|j| (Some(j.covariance), Some(j.correlation), j.regions))
            .unwrap_or_default();
        let moments_missing = verdicts.into_iter().map(Verdict::reason).collect();
        Ok(Outcome {
            run,
            outputs,
            covariance,
            correlation,
            regions,
            moments_missing,
        })
    }

    /// How trials are cut.
    fn layout(&self) -> Layout {
        match self.settings.trials {
            Trials::Fixed(trials) | Trials::Decisive { least: trials, .. } => Layout::new(trials),
            Trials::Adaptive { max, .. } => Layout::new(adaptive::batch_size(self.p).min(max)),
        }
    }

    fn draw<S: Source>(&self, layout: Layout, collector: &mut Collector<S>) -> Option<AdaptiveRun> {
        match self.settings.trials {
            Trials::Fixed(_) | Trials::Decisive { .. } => {
                collector.extend(layout.chunks(0..1).end);
                None
            }
            Trials::Adaptive {
                procedure,
                digits,
                max,
            } => {
                let target = Target {
                    procedure,
                    digits,
                    max,
                    p: self.p,
                };
                Some(adaptive::run(collector, layout, &self.pivots, target))
            }
        }
    }

    /// What must be known of the order of so many values.
    fn wanted(&self, count: u64) -> Wanted {
        let values = count as usize;
        let ranks = Ranks::new(values, self.p);
        let extreme = Tail::reach(values) as u64 + 2;
        let ends = [ranks.symmetric, ranks.symmetric + ranks.covered];
        let depth = self.depth(values);
        let around = ends.into_iter().flat_map(|end| {
            let [below, above] = Around::both(end, values, depth);
            [below.ranks, [end; 2], above.ranks]
        });
        let mut wanted = vec![
            [1, extreme.min(count)],
            [count.div_ceil(2), count / 2 + 1],
            [(count + 1).saturating_sub(extreme).max(1), count],
        ];
        wanted.extend(around.map(|[first, last]| [first as u64, last as u64]));
        Wanted {
            ranks: wanted,
            shortest: Some(ranks),
            count,
        }
    }

    /// How many values at either end count as its tail.
    fn depth(&self, values: usize) -> usize {
        let depth = Ranks::new(values, self.p).last.max(Tail::reach(values) + 2);
        depth.min(values)
    }

    /// Everything about one output.
    fn summary<S: Source>(
        &self,
        output: usize,
        held: &mut Held,
        moments: &Moments,
        redraw: &Redraw<'_, '_, S>,
    ) -> (MonteCarlo, Verdict) {
        match held {
            Held::Columns(columns) => {
                let column = columns[output].as_slice();
                let is_finite = |value: &f64| value.is_finite();
                let values = match column.iter().all(is_finite) {
                    true => Cow::Borrowed(column),
                    false => column.iter().copied().filter(is_finite).collect(),
                };
                let ordered = Ordered::new(&values, self.depth(values.len()));
                let picture = |interval| {
                    histogram::histogram(&values, ordered.range(), interval, self.threads)
                };
                self.results(moments, &ordered, picture, self.heavy[output].as_ref())
            }
            Held::Summed(summed) => {
                let order_counts = &mut summed.order_counts[output];
                let count = order_counts.count();
                let depth = self.depth(count as usize);
                let resolved =
                    Resolved::new(order_counts, &self.wanted(count), depth, output, redraw);
                if self.pivots.len() == 1 {
                    // Nothing is left to share; other outputs, and coverage regions, would need helpers again.
                    redraw.pool.dismiss();
                }
                let picture = |interval| order_counts.histogram(interval);
                self.results(moments, &resolved, picture, self.heavy[output].as_ref())
            }
        }
    }

    fn results(
        &self,
        moments: &Moments,
        order: &impl Ranked,
        picture: impl Fn([f64; 2]) -> Histogram,
        heavy: Option<&HeavyComponent>,
    ) -> (MonteCarlo, Verdict) {
        let ranks = Ranks::new(order.count(), self.p);
        let tail = Tail::heavier(order);
        let verdict = Verdict::new(heavy, &tail).with_error_of_u(moments.sd_error() / moments.sd());
        let (has_mean, has_deviation) = (verdict.has_mean(), verdict.has_deviation());
        let symmetric = order.symmetric(ranks);
        let given = |given: bool, value: f64| given.then_some(value);
        let exists = |order: f64| {
            has_deviation && tail.exists(order) && heavy.is_none_or(|heavy| heavy.leaves(order))
        };
        let result = MonteCarlo {
            estimate: given(has_mean, moments.mean()),
            u: given(has_deviation, moments.sd()),
            median: order.median(),
            symmetric,
            shortest: order.shortest(ranks),
            skewness: moments.skewness().filter(|_| exists(3.0)),
            excess_kurtosis: moments.excess_kurtosis().filter(|_| exists(4.0)),
            standard_errors: [
                given(has_deviation, moments.mean_error()).unwrap_or(f64::NAN),
                given(has_deviation, moments.sd_error()).unwrap_or(f64::NAN),
                order.standard_error(ranks.symmetric),
                order.standard_error(ranks.symmetric + ranks.covered),
            ],
            failed: moments.failed(),
            histogram: picture(symmetric),
        };
        (result, verdict)
    }
}

#[cfg(test)]
mod tests;
