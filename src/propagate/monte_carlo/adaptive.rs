//! How many trials: the adaptive procedure of JCGM 101 7.9.4 and the two-stage procedure of Stein.
//!
//! Both apply the Monte Carlo method in batches of M = max(⌈100/(1 − p)⌉, 10⁴) trials and look at how
//! four results scatter from batch to batch: estimate, standard uncertainty and the two ends of
//! the probabilistically symmetric interval, of every output. They differ in what they promise.
//!
//! **JCGM 101 7.9.4** adds batches one by one until twice the standard error of each of the four
//! is at most δ. It looks after every batch, the first time after two, and a scatter that is small by
//! chance ends it: with two batches a standard deviation has one degree of freedom. It therefore
//! stops too early often, and promises no probability.
//!
//! **Stein's procedure** (Stein 1945; for Monte Carlo Wübbeler, Harris, Cox and Elster, Metrologia 47
//! (2010) 317) takes the scatter s from a first stage of h₁ batches only, and then runs h batches in all,
//!
//! h = max(h₁, ⌊t² s²/δ²⌋ + 1),  t = t₍h₁−1₎(1 − α′/2).
//!
//! Because h depends on the first stage through s alone, which is independent of the mean of normal
//! batch results, √h·(z̄ − z)/s has exactly the t distribution of h₁ − 1 degrees of freedom, and
//! P(|z̄ − z| ≤ δ) ≥ 1 − α′. With N results (four per output) α′ = α/N, so that by Bonferroni's
//! inequality *all* of them are within δ with a probability of at least 1 − α = 0.95. This is why it is
//! the default. The batch results of 10⁴ trials are very nearly normal; the results printed are those of
//! all trials together, which differ from the mean over batches by less than their error.

use super::engine::{Layout, Source, simulate};
use super::interval::symmetric_ends;
use super::moments::{Moments, Pivot};
use super::store::Store;
use crate::budget::Adaptive;
use crate::propagate::AdaptiveRun;
use crate::propagate::validation::numerical_tolerance;
use crate::special::student_t_upper_quantile;

/// Batches of Stein's first stage.
const FIRST_STAGE: u64 = 10;

/// α: probability that any of the results is further than δ from its true value.
const RISK: f64 = 0.05;

/// What an adaptive run has to reach.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) procedure: Adaptive,
    /// Significant digits of u that are to be right.
    pub(super) digits: u8,
    /// Most trials.
    pub(super) max: u64,
    /// p of the interval.
    pub(super) p: f64,
}

/// J, the smallest whole number ≥ 100/(1 − p), JCGM 101 7.9.4 b).
pub(crate) fn least_batch(p: f64) -> u64 {
    // A quotient that should be whole may come out a little above: 100/(1 − 0.95) = 2000.0000000000018.
    (100.0 / (1.0 - p) * (1.0 - 1e-12)).ceil() as u64
}

/// Trials of a batch, JCGM 101 7.9.4 b): max(J, 10⁴).
pub(crate) fn batch_size(p: f64) -> u64 {
    least_batch(p).max(10_000)
}

/// Runs batches until the target is reached or the maximum is; the store then holds the trials to be
/// used.
pub(super) fn run<S: Source>(
    source: &S,
    pivots: &[Pivot],
    target: Target,
    threads: usize,
) -> (Store, AdaptiveRun) {
    let layout = Layout::new(batch_size(target.p).min(target.max));
    let mut experiment = Experiment {
        source,
        layout,
        pivots,
        threads,
        target,
        store: Store::new(source.outputs()),
        batches: 0,
        most: (target.max / layout.batch()).max(1),
    };
    let reached = match target.procedure {
        Adaptive::Jcgm101 => experiment.jcgm101(),
        Adaptive::Stein => experiment.stein(),
    };
    let delta = experiment.deltas(experiment.batches);
    let run = AdaptiveRun {
        procedure: target.procedure,
        digits: target.digits,
        delta,
        reached,
    };
    (experiment.store, run)
}

/// y, u, y_low and y_high of one output in one batch.
type Results = [f64; 4];

/// Batches that have been run, and how to run more.
struct Experiment<'s, S> {
    source: &'s S,
    layout: Layout,
    pivots: &'s [Pivot],
    threads: usize,
    target: Target,
    store: Store,
    batches: u64,
    /// Largest number of batches.
    most: u64,
}

impl<S: Source> Experiment<'_, S> {
    /// Runs batches until there are `batches`.
    fn extend(&mut self, batches: u64) {
        if batches > self.batches {
            let new = self.batches..batches;
            simulate(
                self.source,
                self.layout,
                new,
                self.pivots,
                self.threads,
                &mut self.store,
            );
            self.batches = batches;
        }
    }

    /// Forgets all but the first `batches`.
    fn truncate(&mut self, batches: u64) {
        let chunks = self.layout.chunks(0..batches).end as usize;
        self.store
            .truncate(chunks, (batches * self.layout.batch()) as usize);
        self.batches = batches;
    }

    fn moments(&self, output: usize, batches: std::ops::Range<u64>) -> Moments {
        let chunks = self.layout.chunks(batches);
        self.store
            .moments_of_chunks(output, chunks.start as usize, chunks.end as usize)
            .unwrap_or(Moments::empty(self.pivots[output]))
    }

    /// The results of every output in one batch.
    fn results(&self, batch: u64) -> Vec<Results> {
        let trials = self.layout.batch() as usize;
        let start = batch as usize * trials;
        self.store
            .columns()
            .iter()
            .enumerate()
            .map(|(output, column)| {
                let moments = self.moments(output, batch..batch + 1);
                let mut values = column[start..start + trials].to_vec();
                values.retain(|v| v.is_finite());
                let [low, high] = symmetric_ends(&mut values, self.target.p);
                let mean = if moments.count() > 0 {
                    moments.mean()
                } else {
                    f64::NAN
                };
                [mean, moments.sd(), low, high]
            })
            .collect()
    }

    /// δ of every output from u(y) of the first `batches` together (7.9.4 i and j).
    fn deltas(&self, batches: u64) -> Vec<f64> {
        (0..self.source.outputs())
            .map(|o| numerical_tolerance(self.moments(o, 0..batches).sd(), self.target.digits))
            .collect()
    }

    /// JCGM 101 7.9.4. Batches are drawn several at a time to occupy all threads, but judged one by
    /// one; what was drawn beyond the stop is thrown away.
    fn jcgm101(&mut self) -> bool {
        let mut scatter = Scatter::new(self.source.outputs());
        let mut pooled: Vec<Moments> = self.pivots.iter().map(|p| Moments::empty(*p)).collect();
        for batch in 0..self.most {
            if batch == self.batches {
                self.extend((batch + (batch / 4).max(8)).min(self.most));
            }
            scatter.add(&self.results(batch));
            for (output, all) in pooled.iter_mut().enumerate() {
                *all = all.merge(&self.moments(output, batch..batch + 1));
            }
            let stable = |(output, all): (usize, &Moments)| {
                let delta = numerical_tolerance(all.sd(), self.target.digits);
                scatter
                    .output(output)
                    .iter()
                    .all(|s| 2.0 * s.error_of_mean() <= delta)
            };
            if batch > 0 && pooled.iter().enumerate().all(stable) {
                self.truncate(batch + 1);
                return true;
            }
        }
        false
    }

    /// The two-stage procedure. δ is found again after the second stage, since the rounded u may
    /// have come out with another power of ten; s stays that of the first stage, on which the
    /// guarantee rests.
    fn stein(&mut self) -> bool {
        self.extend(FIRST_STAGE.min(self.most));
        if self.batches < 2 {
            return false;
        }
        let mut scatter = Scatter::new(self.source.outputs());
        for batch in 0..self.batches {
            scatter.add(&self.results(batch));
        }
        let quantities = (4 * self.source.outputs()) as f64;
        let t = student_t_upper_quantile(RISK / (2.0 * quantities), (self.batches - 1) as f64);
        loop {
            let deltas = self.deltas(self.batches);
            let wanted = deltas
                .iter()
                .enumerate()
                .flat_map(|(o, delta)| scatter.output(o).iter().map(move |s| (s.sd(), *delta)))
                .map(|(sd, delta)| batches_wanted(t, sd, delta))
                .fold(0, u64::max);
            if wanted <= self.batches {
                return true;
            }
            if self.batches == self.most {
                return false;
            }
            self.extend(wanted.min(self.most));
        }
    }
}

/// ⌊t² s²/δ²⌋ + 1; without bound where a batch gave no result.
fn batches_wanted(t: f64, sd: f64, delta: f64) -> u64 {
    if sd == 0.0 {
        return 1;
    }
    let wanted = (t * sd / delta).powi(2).floor() + 1.0;
    // The conversion saturates, but takes NaN for zero.
    if wanted.is_nan() {
        u64::MAX
    } else {
        wanted as u64
    }
}

/// Running mean and squares of one result over batches (Welford).
#[derive(Debug, Clone, Copy, Default)]
struct Spread {
    count: f64,
    mean: f64,
    squares: f64,
}

impl Spread {
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        let delta = value - self.mean;
        self.mean += delta / self.count;
        self.squares += delta * (value - self.mean);
    }

    fn sd(&self) -> f64 {
        (self.squares / (self.count - 1.0)).sqrt()
    }

    /// s_z of 7.9.4 g).
    fn error_of_mean(&self) -> f64 {
        self.sd() / self.count.sqrt()
    }
}

/// The spreads of the four results of every output.
struct Scatter(Vec<[Spread; 4]>);

impl Scatter {
    fn new(outputs: usize) -> Self {
        Scatter(vec![[Spread::default(); 4]; outputs])
    }

    fn add(&mut self, results: &[Results]) {
        for (spreads, values) in self.0.iter_mut().zip(results) {
            for (spread, value) in spreads.iter_mut().zip(values) {
                spread.add(*value);
            }
        }
    }

    fn output(&self, output: usize) -> &[Spread; 4] {
        &self.0[output]
    }
}

#[cfg(test)]
mod tests {
    use super::super::interval::{Ordered, Ranks};
    use super::super::samples::Sampled;
    use super::*;

    fn target(procedure: Adaptive, digits: u8, max: u64) -> Target {
        Target {
            procedure,
            digits,
            max,
            p: 0.95,
        }
    }

    fn adapt(source: &Sampled, target: Target, threads: usize) -> (Store, AdaptiveRun) {
        let pivots = vec![Pivot::new(0.0, 1.0); source.outputs()];
        run(source, &pivots, target, threads)
    }

    #[test]
    fn batch_sizes_of_7_9_4() {
        assert_eq!(batch_size(0.95), 10_000);
        assert_eq!(batch_size(0.99), 10_000);
        assert_eq!(batch_size(0.999), 100_000);
        assert_eq!(batch_size(0.9999), 1_000_000);
    }

    /// Fraction of runs in which all four results of N(0, 1.9²) are within δ = 0.05.
    fn fraction_within_delta(procedure: Adaptive, runs: u64) -> f64 {
        let u = 1.9;
        let truth = [0.0, u, -1.959_963_985 * u, 1.959_963_985 * u];
        let good = (0..runs).filter(|&seed| {
            let source = Sampled::new(1000 + seed, 1, move |s, y| y[0] = u * s.normal());
            let (store, adaptive) = adapt(&source, target(procedure, 2, 2_000_000), 2);
            assert!(adaptive.reached && adaptive.delta == [0.05], "{adaptive:?}");
            let moments = store.moments(0).unwrap();
            let values = store.into_columns().remove(0);
            let ranks = Ranks::new(values.len(), 0.95);
            let [low, high] = Ordered::new(&values, ranks.last, 1).symmetric(ranks);
            let found = [moments.mean(), moments.sd(), low, high];
            found.iter().zip(truth).all(|(a, b)| (a - b).abs() <= 0.05)
        });
        good.count() as f64 / runs as f64
    }

    #[test]
    fn stein_keeps_its_promise_and_the_standard_procedure_stops_too_early() {
        let stein = fraction_within_delta(Adaptive::Stein, 200);
        let jcgm = fraction_within_delta(Adaptive::Jcgm101, 200);
        assert!(stein >= 0.95, "Stein {stein}");
        assert!(jcgm < 0.93, "JCGM 101 {jcgm}");
    }

    #[test]
    fn the_number_of_trials_does_not_depend_on_threads() {
        let source = Sampled::normal(4, 2);
        for procedure in [Adaptive::Stein, Adaptive::Jcgm101] {
            let one = adapt(&source, target(procedure, 2, 3_000_000), 1);
            for threads in [2, 3, 8] {
                let many = adapt(&source, target(procedure, 2, 3_000_000), threads);
                assert_eq!(one.1, many.1);
                assert_eq!(one.0.columns(), many.0.columns());
                assert_eq!(one.0.moments(1), many.0.moments(1));
            }
        }
    }

    #[test]
    fn the_maximum_is_respected() {
        let source = Sampled::normal(4, 1);
        for procedure in [Adaptive::Stein, Adaptive::Jcgm101] {
            for (max, trials) in [(55_000, 50_000), (10_000, 10_000), (3000, 3000)] {
                let (store, adaptive) = adapt(&source, target(procedure, 3, max), 2);
                assert!(!adaptive.reached, "{procedure:?} {max}");
                assert_eq!(store.trials(), trials);
            }
        }
    }

    #[test]
    fn nothing_uncertain_is_reached_at_once() {
        let source = Sampled::new(1, 1, |_, y| y[0] = 2.5);
        for (procedure, trials) in [(Adaptive::Stein, 100_000), (Adaptive::Jcgm101, 20_000)] {
            let (store, adaptive) = adapt(&source, target(procedure, 2, 1_000_000), 2);
            assert!(adaptive.reached);
            assert_eq!((adaptive.delta[0], store.trials()), (0.0, trials));
        }
    }

    #[test]
    fn failing_trials_never_count_as_stable() {
        let source = Sampled::new(1, 1, |_, y| y[0] = f64::NAN);
        for procedure in [Adaptive::Stein, Adaptive::Jcgm101] {
            let (_, adaptive) = adapt(&source, target(procedure, 2, 200_000), 2);
            assert!(!adaptive.reached);
        }
    }

    #[test]
    fn one_output_of_many_digits_drives_the_run() {
        // The second output needs δ/u = 0.5/9.5 only, the first 0.5/1.05.
        let source = Sampled::new(3, 2, |s, y| {
            y[0] = 1.05 * s.normal();
            y[1] = 9.3 * s.normal();
        });
        let (store, adaptive) = adapt(&source, target(Adaptive::Stein, 2, 5_000_000), 2);
        assert_eq!(adaptive.delta, [0.05, 0.05]);
        // t_9(1 − 0.05/16) = 3.5; end of interval 2.67·9.3/100 per batch: (3.5·0.248/0.05)² ≈ 300.
        let batches = store.trials() / 10_000;
        assert!((80..900).contains(&batches), "{batches}");
    }
}
