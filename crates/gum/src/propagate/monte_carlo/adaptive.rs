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

use super::collect::Collector;
use super::engine::{Layout, Source};
use super::interval::symmetric_ends;
use super::moments::{Moments, Pivot};
use crate::budget::Adaptive;
use crate::propagate::result::AdaptiveRun;
use crate::propagate::validation::numerical_tolerance;
use gumption_core::special::student_t_upper_quantile;

/// Batches of Stein's first stage.
const FIRST_STAGE: u64 = 10;

/// Most batches that are drawn before they are judged.
const AHEAD: u64 = 64;

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

/// Runs batches until the target is reached or the maximum is; the collector then holds the trials to
/// be used.
pub(super) fn run<S: Source>(
    collector: &mut Collector<S>,
    layout: Layout,
    pivots: &[Pivot],
    target: Target,
) -> AdaptiveRun {
    let mut experiment = Experiment {
        collector,
        layout,
        pivots,
        target,
        batches: 0,
        most: (target.max / layout.batch()).max(1),
    };
    let reached = match target.procedure {
        Adaptive::Jcgm101 => experiment.jcgm101(),
        Adaptive::Stein => experiment.stein(),
    };
    AdaptiveRun {
        procedure: target.procedure,
        digits: target.digits,
        delta: experiment.deltas(),
        reached,
    }
}

/// y, u, y_low and y_high of one output in one batch.
type Results = [f64; 4];

/// A batch whose trials are at hand, but not yet taken over.
struct Batch {
    number: u64,
    /// Per chunk and output.
    values: Vec<Vec<Vec<f64>>>,
}

/// Batches that have been run, and how to run more.
struct Experiment<'e, 's, 'env, S> {
    collector: &'e mut Collector<'s, 'env, S>,
    layout: Layout,
    pivots: &'e [Pivot],
    target: Target,
    batches: u64,
    /// Largest number of batches.
    most: u64,
}

impl<S: Source> Experiment<'_, '_, '_, S> {
    /// Draws the next batches.
    fn draw(&self, batches: u64) -> Vec<Batch> {
        let numbers = self.batches..self.batches + batches;
        let chunks = self.layout.chunks(numbers.clone());
        let mut values = self.collector.draw(chunks).into_iter();
        let each = self.layout.chunks(0..1).end as usize;
        numbers
            .map(|number| Batch {
                number,
                values: values.by_ref().take(each).collect(),
            })
            .collect()
    }

    /// Takes over the trials of the next batch.
    fn accept(&mut self, batch: Batch) {
        let chunks = self.layout.chunks(batch.number..batch.number + 1);
        self.collector.commit(chunks, batch.values);
        self.batches = batch.number + 1;
    }

    /// The results of every output in one batch, and its moments.
    fn results(&self, batch: &Batch) -> (Vec<Results>, Vec<Moments>) {
        let pairs = self.pivots.iter().enumerate();
        pairs
            .map(|(output, pivot)| {
                let chunks = batch.values.iter().map(|chunk| chunk[output].as_slice());
                let mut values = chunks.collect::<Vec<_>>().concat();
                let moments = Moments::of(&values, *pivot);
                values.retain(|v| v.is_finite());
                let [low, high] = symmetric_ends(&mut values, self.target.p);
                let mean = if moments.count() > 0 {
                    moments.mean()
                } else {
                    f64::NAN
                };
                ([mean, moments.sd(), low, high], moments)
            })
            .unzip()
    }

    /// δ of every output from u(y) of all trials together (7.9.4 i and j).
    fn deltas(&self) -> Vec<f64> {
        let moments = self.collector.moments();
        let tolerance = |m: &Moments| numerical_tolerance(m.sd(), self.target.digits);
        moments.iter().map(tolerance).collect()
    }

    /// JCGM 101 7.9.4. Batches are drawn several at a time to occupy all threads, but judged one by
    /// one; what was drawn beyond the stop is thrown away.
    fn jcgm101(&mut self) -> bool {
        let mut scatter = Scatter::new(self.pivots.len());
        let mut pooled: Vec<Moments> = self.pivots.iter().map(|p| Moments::empty(*p)).collect();
        while self.batches < self.most {
            let ahead = (self.batches / 8)
                .clamp(2, AHEAD)
                .min(self.most - self.batches);
            for batch in self.draw(ahead) {
                let (results, moments) = self.results(&batch);
                self.accept(batch);
                scatter.add(&results);
                for (all, moments) in pooled.iter_mut().zip(&moments) {
                    *all = all.merge(moments);
                }
                let stable = |(output, all): (usize, &Moments)| {
                    let delta = numerical_tolerance(all.sd(), self.target.digits);
                    scatter
                        .output(output)
                        .iter()
                        .all(|s| 2.0 * s.error_of_mean() <= delta)
                };
                if self.batches > 1 && pooled.iter().enumerate().all(stable) {
                    return true;
                }
            }
        }
        false
    }

    /// The two-stage procedure. δ is found again after the second stage, since the rounded u may
    /// have come out with another power of ten; s stays that of the first stage, on which the
    /// guarantee rests.
    fn stein(&mut self) -> bool {
        let mut scatter = Scatter::new(self.pivots.len());
        for batch in self.draw(FIRST_STAGE.min(self.most)) {
            scatter.add(&self.results(&batch).0);
            self.accept(batch);
        }
        if self.batches < 2 {
            return false;
        }
        let quantities = (4 * self.pivots.len()) as f64;
        let t = student_t_upper_quantile(RISK / (2.0 * quantities), (self.batches - 1) as f64);
        loop {
            let deltas = self.deltas();
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
            self.batches = wanted.min(self.most);
            self.collector
                .extend(self.layout.chunks(0..self.batches).end);
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
    use super::super::samples::Sampled;
    use super::super::{Outcome, Question};
    use super::*;
    use crate::budget::{MonteCarloSettings, Points, Trials};
    use crate::propagate::result::MonteCarlo;
    use gumption_lanes::{Block, LANES};

    fn adapt(
        source: &Sampled,
        (procedure, digits, max): (Adaptive, u8, u64),
        threads: usize,
    ) -> (Outcome, AdaptiveRun) {
        let settings = MonteCarloSettings {
            points: Points::Random,
            indices: false,
            seed: 1,
            trials: Trials::Adaptive {
                procedure,
                digits,
                max,
            },
        };
        let question = Question {
            settings: &settings,
            p: 0.95,
            pivots: vec![Pivot::new(0.0, 1.0); source.outputs()],
            heavy: vec![None; source.outputs()],
            threads,
        };
        let outcome = question.ask(source).unwrap();
        let adaptive = outcome.run.adaptive.clone().unwrap();
        (outcome, adaptive)
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
            let (mut outcome, adaptive) = adapt(&source, (procedure, 2, 2_000_000), 2);
            assert!(adaptive.reached && adaptive.delta == [0.05], "{adaptive:?}");
            let y = outcome.outputs.remove(0);
            let [low, high] = y.symmetric;
            let found = [y.estimate.unwrap(), y.u.unwrap(), low, high];
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
            let results = |outcome: &Outcome| -> Vec<_> {
                let figures = |y: &MonteCarlo| (y.estimate, y.u, y.symmetric, y.shortest);
                outcome.outputs.iter().map(figures).collect()
            };
            let one = adapt(&source, (procedure, 2, 3_000_000), 1);
            for threads in [2, 3, 8] {
                let many = adapt(&source, (procedure, 2, 3_000_000), threads);
                assert_eq!(one.1, many.1);
                assert_eq!(results(&one.0), results(&many.0));
                assert_eq!(one.0.covariance, many.0.covariance);
            }
        }
    }

    #[test]
    fn the_maximum_is_respected() {
        let source = Sampled::normal(4, 1);
        for procedure in [Adaptive::Stein, Adaptive::Jcgm101] {
            for (max, trials) in [(55_000, 50_000), (10_000, 10_000), (3000, 3000)] {
                let (outcome, adaptive) = adapt(&source, (procedure, 3, max), 2);
                assert!(!adaptive.reached, "{procedure:?} {max}");
                assert_eq!(outcome.run.trials, trials);
            }
        }
    }

    #[test]
    fn nothing_uncertain_is_reached_at_once() {
        let source = Sampled::new(1, 1, |_, y| y[0] = 2.5);
        for (procedure, trials) in [(Adaptive::Stein, 100_000), (Adaptive::Jcgm101, 20_000)] {
            let (outcome, adaptive) = adapt(&source, (procedure, 2, 1_000_000), 2);
            assert!(adaptive.reached);
            assert_eq!((adaptive.delta[0], outcome.run.trials), (0.0, trials));
        }
    }

    #[test]
    fn failing_batches_never_count_as_stable() {
        // Values in the very first trials only.
        let source = Sampled::new(1, 1, |s, y| {
            y[0] = if s.uniform() < 1e-5 { 1.0 } else { f64::NAN }
        });
        for procedure in [Adaptive::Stein, Adaptive::Jcgm101] {
            let (outcome, adaptive) = adapt(&source, (procedure, 2, 1_000_000), 2);
            assert!(!adaptive.reached);
            assert_eq!(
                outcome.run.trials, 1_000_000,
                "{procedure:?} went on to the end"
            );
        }
    }

    #[test]
    fn one_output_of_many_digits_drives_the_run() {
        // The second output needs δ/u = 0.5/9.5 only, the first 0.5/1.05.
        let source = Sampled::new(3, 2, |s, y| {
            y[0] = 1.05 * s.normal();
            y[1] = 9.3 * s.normal();
        });
        let (outcome, adaptive) = adapt(&source, (Adaptive::Stein, 2, 5_000_000), 2);
        assert_eq!(adaptive.delta, [0.05, 0.05]);
        let batches = outcome.run.trials / 10_000;
        assert_eq!(batches, wanted_of(&source, 0.05));
        // t_9(1 − 0.05/16) = 3.5465, and an end of the interval of 10⁴ trials has a standard deviation of
        // 9.3·√(0.025·0.975/10⁴)/φ(1.96) = 0.2484. So h = (t s/δ)² = 310.4·s²/σ², of which nine degrees of freedom leave 0.108 to
        // 3.30 in 99.9 %; of two ends the larger one counts.
        let ratio = batches as f64 / 310.4;
        assert!((0.108..3.30).contains(&ratio), "{batches}");
    }

    /// Stein's number of batches by the second of two outputs, from the trials of the first ten, each sorted (JCGM 101, 7.7).
    fn wanted_of(source: &Sampled, delta: f64) -> u64 {
        const BATCH: usize = 10_000;
        let mut worker = source.worker();
        let mut batch = |number| {
            source.start(&mut worker, number);
            let mut blocks = [Block([0.0; LANES]); 2];
            let mut values = Vec::new();
            while values.len() < BATCH {
                source.next(&mut worker, &mut blocks);
                values.extend(blocks[1].0);
            }
            values.truncate(BATCH);
            values.sort_by(f64::total_cmp);
            let [mean, u] = mean_and_sd(&values);
            [mean, u, values[249], values[9749]]
        };
        let batches: Vec<Results> = (0..10).map(&mut batch).collect();
        let sd = |of: usize| mean_and_sd(&batches.iter().map(|one| one[of]).collect::<Vec<_>>())[1];
        let largest = (0..4).map(sd).fold(0.0, f64::max);
        let t = student_t_upper_quantile(0.05 / 16.0, 9.0);
        (t * largest / delta).powi(2) as u64 + 1
    }

    fn mean_and_sd(values: &[f64]) -> [f64; 2] {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        [mean, (squares / (n - 1.0)).sqrt()]
    }
}
