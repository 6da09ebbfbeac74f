//! Coverage intervals and the median from order statistics (JCGM 101 7.7), without a full sort.
//!
//! Only the two tails of (1 − p)·M values are sorted; one pass with cuts that a small part of the
//! values suggests separates them from the middle. Results are exactly those of a full sort.

use gumption_lanes::level;
use gumption_lanes::separate::keep_inside;

/// The ranks of JCGM 101 7.7.2: of M ordered values, an interval reaches from rank r to rank r + q.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::propagate) struct Ranks {
    /// q: pM, rounded to the nearest whole number.
    pub(super) covered: usize,
    /// r of the probabilistically symmetric interval.
    pub(super) symmetric: usize,
    /// M − q: r runs from 1 to this.
    pub(super) last: usize,
}

impl Ranks {
    /// For M ≥ 1 values and 0 < p < 1. With so few values that no rank is left outside, the
    /// interval is the whole range.
    pub(in crate::propagate) fn new(values: usize, p: f64) -> Self {
        let nearest = (p * values as f64 + 0.5).floor() as usize;
        let covered = nearest.min(values.saturating_sub(1));
        let last = values - covered;
        // (M − q)/2 when that is whole, else the integer part of (M − q + 1)/2.
        Ranks {
            covered,
            symmetric: last.div_ceil(2),
            last,
        }
    }
}

/// Values looked at to guess where the tails begin.
const PILOT: usize = 1 << 10;

/// The median and the two tails of a sample, in order.
#[derive(Debug)]
pub(in crate::propagate) struct Ordered {
    count: usize,
    /// The smallest values, ascending; all values where the tails would meet.
    low: Vec<f64>,
    /// The largest values, ascending.
    high: Vec<f64>,
    median: f64,
}

impl Ordered {
    /// Orders the tails of `depth` values of at least one finite value.
    pub(super) fn new(values: &[f64], depth: usize) -> Self {
        let depth = depth.max(1);
        Cuts::guess(values, depth)
            .and_then(|cuts| Ordered::selected(values, depth, &cuts))
            .unwrap_or_else(|| Ordered::sorted(values.to_vec()))
    }

    /// One pass collects what lies beyond or between the cuts; `None` where they do not hold what is
    /// looked for.
    fn selected(values: &[f64], depth: usize, cuts: &Cuts) -> Option<Self> {
        let [low_end, high_start] = cuts.tails;
        let [from, to] = cuts.middle;
        let stretches = [[f64::MIN, low_end], [from, to], [high_start, f64::MAX]];
        let mut held = Vec::new();
        // Part by part, so that what is left out takes no memory.
        for part in values.chunks(PILOT) {
            let begin = held.len();
            held.extend_from_slice(part);
            keep_inside(level(), &mut held, begin, &stretches);
        }
        // The three may overlap where many values are the same.
        let [mut low, mut middle, mut high] = stretches.map(|stretch| {
            let mut part = held.clone();
            keep_inside(level(), &mut part, 0, &[stretch]);
            part
        });
        if low.len() < depth || high.len() < depth {
            return None;
        }
        let below = values.iter().filter(|value| **value < from).count();
        let (lower, upper) = ((values.len() - 1) / 2, values.len() / 2);
        let (lower, upper) = (lower.checked_sub(below)?, upper.checked_sub(below)?);
        if upper >= middle.len() {
            return None;
        }
        let (before, upper_value, _) = middle.select_nth_unstable_by(upper, f64::total_cmp);
        let upper_value = *upper_value;
        let lower_value = if lower == upper {
            upper_value
        } else {
            before.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        };
        Side::Low.keep(&mut low, depth);
        Side::High.keep(&mut high, depth);
        low.sort_unstable_by(f64::total_cmp);
        high.sort_unstable_by(f64::total_cmp);
        Some(Ordered {
            count: values.len(),
            low,
            high,
            median: midpoint(lower_value, upper_value),
        })
    }

    /// The same for values that are too few for a pilot to pay, by selection.
    pub(super) fn by_selection(mut values: Vec<f64>, depth: usize) -> Self {
        let (count, depth) = (values.len(), depth.max(1));
        if 4 * depth >= count {
            return Ordered::sorted(values);
        }
        let (low, last, rest) = values.select_nth_unstable_by(depth - 1, f64::total_cmp);
        let mut low = low.to_vec();
        low.push(*last);
        let inner = rest.len() - depth;
        let (middle, first, high) = rest.select_nth_unstable_by(inner, f64::total_cmp);
        let mut high = high.to_vec();
        high.push(*first);
        low.sort_unstable_by(f64::total_cmp);
        high.sort_unstable_by(f64::total_cmp);
        let upper = count / 2 - depth;
        let (below, upper_value, _) = middle.select_nth_unstable_by(upper, f64::total_cmp);
        let lower_value = if count.is_multiple_of(2) {
            below.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        } else {
            *upper_value
        };
        Ordered {
            count,
            median: midpoint(lower_value, *upper_value),
            low,
            high,
        }
    }

    /// Orders all of them; at least one.
    pub(in crate::propagate) fn sorted(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        let count = values.len();
        Ordered {
            count,
            median: midpoint(values[(count - 1) / 2], values[count / 2]),
            low: values,
            high: Vec::new(),
        }
    }
}

/// Values whose order is known where it matters.
pub(in crate::propagate) trait Ranked {
    /// How many values.
    fn count(&self) -> usize;

    /// How many values at either end count as a tail, which standard errors do not leave.
    fn depth(&self) -> usize;

    /// y₍rank₎, counted from 1; the rank is one of those that were asked for.
    fn at(&self, rank: usize) -> f64;

    /// Shows the values from one rank to another, both of one tail that was asked for, ascending.
    fn visit(&self, first: usize, last: usize, see: impl FnMut(f64)) {
        (first..=last).map(|rank| self.at(rank)).for_each(see);
    }

    /// The middle value, or the mean of the two in the middle.
    fn median(&self) -> f64;

    /// The shortest interval (7.7.3). Among equally short ones, which rounded or discrete values
    /// give, the one nearest to the symmetric interval.
    fn shortest(&self, ranks: Ranks) -> [f64; 2];

    /// The smallest and the largest value.
    fn range(&self) -> [f64; 2] {
        [self.at(1), self.at(self.count())]
    }

    /// The probabilistically symmetric interval (7.7.2).
    fn symmetric(&self, ranks: Ranks) -> [f64; 2] {
        [
            self.at(ranks.symmetric),
            self.at(ranks.symmetric + ranks.covered),
        ]
    }

    /// Standard error of the order statistic of this rank.
    ///
    /// The number of values below the true quantile is binomial with standard deviation
    /// √(M a (1 − a)), a = rank/M; half the distance between the values so many ranks below and
    /// above is the standard error, whatever the distribution.
    fn standard_error(&self, rank: usize) -> f64 {
        let [below, above] = Around::both(rank, self.count(), self.depth()).map(|around| {
            let [low, high] = around.ranks.map(|rank| self.at(rank));
            low + around.fraction * (high - low)
        });
        (above - below) / 2.0
    }
}

/// A place between two neighbouring ranks.
pub(super) struct Around {
    pub(super) ranks: [usize; 2],
    fraction: f64,
}

impl Around {
    /// One standard error below and above a rank, kept inside the tail of that rank.
    pub(super) fn both(rank: usize, count: usize, depth: usize) -> [Around; 2] {
        let (first, last) = if rank <= depth {
            (1, depth)
        } else {
            (count - depth + 1, count)
        };
        let share = rank as f64 / count as f64;
        let reach = (count as f64 * share * (1.0 - share)).sqrt();
        [-reach, reach].map(|offset| {
            let place = (rank as f64 + offset).max(first as f64).min(last as f64);
            let below = place.floor() as usize;
            Around {
                ranks: [below, (below + 1).min(last)],
                fraction: place - place.floor(),
            }
        })
    }
}

impl Ranked for Ordered {
    fn count(&self) -> usize {
        self.count
    }

    fn depth(&self) -> usize {
        self.low.len()
    }

    fn at(&self, rank: usize) -> f64 {
        match self.low.get(rank - 1) {
            Some(value) => *value,
            None => self.high[rank - 1 - (self.count - self.high.len())],
        }
    }

    fn median(&self) -> f64 {
        self.median
    }

    fn shortest(&self, ranks: Ranks) -> [f64; 2] {
        let width = |r: usize| self.at(r + ranks.covered) - self.at(r);
        let mut best = ranks.symmetric;
        let mut least = width(best);
        for r in 1..=ranks.last {
            let w = width(r);
            let nearer = r.abs_diff(ranks.symmetric) < best.abs_diff(ranks.symmetric);
            if w < least || (w == least && nearer) {
                (best, least) = (r, w);
            }
        }
        [self.at(best), self.at(best + ranks.covered)]
    }
}

/// An end of a sample.
#[derive(Debug, Clone, Copy)]
enum Side {
    Low,
    High,
}

impl Side {
    /// Leaves the `depth` most extreme of a tail's values.
    fn keep(self, tail: &mut Vec<f64>, depth: usize) {
        if depth < tail.len() {
            let extreme_first = |a: &f64, b: &f64| match self {
                Side::Low => a.total_cmp(b),
                Side::High => b.total_cmp(a),
            };
            tail.select_nth_unstable_by(depth - 1, extreme_first);
            tail.truncate(depth);
        }
    }
}

/// Values between which the tails and the median are expected.
struct Cuts {
    /// The lower tail ends below, the upper one begins above.
    tails: [f64; 2],
    middle: [f64; 2],
}

impl Cuts {
    /// From the order statistics of every n-th value, six of their standard errors further than
    /// expected; whether the guess holds is checked later. `None` where sorting everything is as
    /// quick.
    fn guess(values: &[f64], depth: usize) -> Option<Cuts> {
        if values.len() < 4 * PILOT || depth > values.len() / 4 {
            return None;
        }
        let mut pilot: Vec<f64> = values
            .iter()
            .step_by(values.len() / PILOT)
            .copied()
            .collect();
        let count = pilot.len() as f64;
        let mut place = |share: f64, errors: f64| {
            let error = (share * (1.0 - share) / count).sqrt() + 1.0 / count;
            let rank = ((share + errors * error) * count) as usize;
            *pilot.select_nth_unstable_by(rank, f64::total_cmp).1
        };
        let share = depth as f64 / values.len() as f64;
        Some(Cuts {
            tails: [place(share, 6.0), place(1.0 - share, -6.0)],
            middle: [place(0.5, -6.0), place(0.5, 6.0)],
        })
    }
}

fn midpoint(a: f64, b: f64) -> f64 {
    a + (b - a) / 2.0
}

/// The two ends of the symmetric interval alone, by selection: what each batch of an adaptive run
/// needs.
pub(super) fn symmetric_ends(values: &mut [f64], p: f64) -> [f64; 2] {
    if values.is_empty() {
        return [f64::NAN; 2];
    }
    let ranks = Ranks::new(values.len(), p);
    let low = ranks.symmetric - 1;
    let (_, low_value, above) = values.select_nth_unstable_by(low, f64::total_cmp);
    let low_value = *low_value;
    if ranks.covered == 0 {
        return [low_value; 2];
    }
    let (_, high_value, _) = above.select_nth_unstable_by(ranks.covered - 1, f64::total_cmp);
    [low_value, *high_value]
}

#[cfg(test)]
mod tests {
    use super::super::samples::Stream;
    use super::*;

    /// JCGM 101 7.7 word by word, on a full sort.
    fn by_full_sort(sample: &[f64], p: f64) -> ([f64; 2], f64, f64) {
        let mut y = sample.to_vec();
        y.sort_by(f64::total_cmp);
        let m = y.len();
        let pm = p * m as f64;
        let q = if pm.fract() == 0.0 {
            pm as usize
        } else {
            (pm + 0.5) as usize
        };
        let r = (m - q).div_ceil(2);
        let shortest = (1..=m - q)
            .map(|r| y[r + q - 1] - y[r - 1])
            .fold(f64::INFINITY, f64::min);
        let median = if m % 2 == 1 {
            y[m / 2]
        } else {
            (y[m / 2 - 1] + y[m / 2]) / 2.0
        };
        ([y[r - 1], y[r + q - 1]], shortest, median)
    }

    #[test]
    fn selection_gives_what_a_sort_does() {
        let mut stream = Stream::new(11);
        for count in [41, 400, 4096, 5001] {
            let values: Vec<f64> = (0..count).map(|_| stream.uniform()).collect();
            let ranks = Ranks::new(count, 0.95);
            let selected = Ordered::by_selection(values.clone(), ranks.last);
            let (symmetric, width, median) = by_full_sort(&values, 0.95);
            assert_eq!(selected.symmetric(ranks), symmetric);
            assert_eq!(selected.median(), median);
            let [low, high] = selected.shortest(ranks);
            assert_eq!(high - low, width);
        }
    }

    #[test]
    fn equals_a_full_sort() {
        let mut stream = Stream::new(11);
        for count in [7, 40, 41, 100, 999, 1000, 4096, 20_001] {
            for p in [0.5, 0.6827, 0.9, 0.95, 0.9545, 0.99] {
                let sample: Vec<f64> = (0..count).map(|_| -stream.uniform().ln()).collect();
                let ranks = Ranks::new(count, p);
                if ranks.last < 1 || (1.0 - p) * (count as f64) < 1.0 {
                    continue;
                }
                let (symmetric, width, median) = by_full_sort(&sample, p);
                let values = sample.clone();
                let ordered = Ordered::new(&values, ranks.last);
                assert_eq!(ordered.symmetric(ranks), symmetric, "{count} {p}");
                let [low, high] = ordered.shortest(ranks);
                assert_eq!(high - low, width, "{count} {p}");
                assert!((ordered.median() - median).abs() < 1e-15, "{count} {p}");
                assert_eq!(symmetric_ends(&mut sample.clone(), p), symmetric);
            }
        }
    }

    #[test]
    fn many_values_equal_a_full_sort() {
        type Draw = fn(&mut Stream) -> f64;
        let draws: [(&str, Draw); 5] = [
            ("normal", |s| s.normal()),
            ("heavy", |s| s.student_t(0.5)),
            ("constant", |_| 2.0),
            ("two values", |s| if s.uniform() < 0.5 { -0.0 } else { 0.0 }),
            ("whole numbers", |s| (3.0 * s.normal()).round()),
        ];
        for (name, draw) in draws {
            let mut stream = Stream::new(23);
            for (count, p) in [(100_000, 0.95), (262_143, 0.6827), (262_144, 0.999)] {
                let sample: Vec<f64> = (0..count).map(|_| draw(&mut stream)).collect();
                let ranks = Ranks::new(count, p);
                let (symmetric, width, median) = by_full_sort(&sample, p);
                let ordered = Ordered::new(&sample, ranks.last);
                assert_eq!(ordered.symmetric(ranks), symmetric, "{name} {count}");
                let [low, high] = ordered.shortest(ranks);
                assert_eq!(high - low, width, "{name} {count}");
                assert_eq!(ordered.median(), median, "{name} {count}");
            }
        }
    }

    #[test]
    fn a_wrong_guess_is_noticed() {
        // Every seventh value is far above the rest: only those are looked at beforehand.
        let sample: Vec<f64> = (0..7 * PILOT)
            .map(|i| {
                if i % 7 == 0 {
                    1e6 + i as f64
                } else {
                    (i % 1009) as f64
                }
            })
            .collect();
        let ranks = Ranks::new(sample.len(), 0.95);
        let (symmetric, _, median) = by_full_sort(&sample, 0.95);
        let ordered = Ordered::new(&sample, ranks.last);
        assert_eq!(ordered.symmetric(ranks), symmetric);
        assert_eq!(ordered.median(), median);
    }

    /// The cuts of tails and middle fall on the same values, or leave none between.
    #[test]
    fn few_different_values() {
        for different in [1, 2, 3, 7, 100] {
            let sample: Vec<f64> = (0..5 * PILOT)
                .map(|i| (i * 7919 % 10_007 % different) as f64)
                .collect();
            let ranks = Ranks::new(sample.len(), 0.95);
            let (symmetric, _, median) = by_full_sort(&sample, 0.95);
            let ordered = Ordered::new(&sample, ranks.last);
            assert_eq!(ordered.symmetric(ranks), symmetric, "{different}");
            assert_eq!(ordered.median(), median, "{different}");
        }
    }

    #[test]
    fn ranks_of_the_standard() {
        // 7.7.2: pM whole: q = 9500, (M − q)/2 = 250.
        assert_eq!(
            Ranks::new(10_000, 0.95),
            Ranks {
                covered: 9500,
                symmetric: 250,
                last: 500
            }
        );
        // pM = 10 001·0.95 = 9500.95: q = 9501, M − q = 500.
        assert_eq!(
            Ranks::new(10_001, 0.95),
            Ranks {
                covered: 9501,
                symmetric: 250,
                last: 500
            }
        );
        // M − q = 5: integer part of 6/2.
        assert_eq!(Ranks::new(100, 0.95).symmetric, 3);
        assert_eq!(Ranks::new(1_000_000, 0.9545).covered, 954_500);
    }

    #[test]
    fn few_values_give_the_whole_range() {
        for count in 1..6 {
            let values: Vec<f64> = (0..count).map(|i| i as f64).collect();
            let ranks = Ranks::new(count, 0.99);
            let ordered = Ordered::new(&values, ranks.last);
            assert_eq!(ordered.symmetric(ranks), [0.0, (count - 1) as f64]);
            assert_eq!(ordered.shortest(ranks), [0.0, (count - 1) as f64]);
        }
    }

    #[test]
    fn equal_widths_prefer_the_symmetric_interval() {
        let values: Vec<f64> = (0..1000).map(f64::from).collect();
        let ranks = Ranks::new(1000, 0.9);
        let ordered = Ordered::new(&values, ranks.last);
        assert_eq!(ordered.shortest(ranks), ordered.symmetric(ranks));
    }

    #[test]
    fn shortest_interval_of_a_one_sided_distribution_starts_at_its_end() {
        // χ² with 2 degrees of freedom is exponential with mean 2: [0, −2 ln 0.05].
        let mut stream = Stream::new(3);
        let values: Vec<f64> = (0..400_000).map(|_| -2.0 * stream.uniform().ln()).collect();
        let ranks = Ranks::new(values.len(), 0.95);
        let ordered = Ordered::new(&values, ranks.last);
        let [low, high] = ordered.shortest(ranks);
        assert!(low < 0.01, "{low}");
        assert!((high + 2.0 * 0.05_f64.ln()).abs() < 0.05, "{high}");
        let [low, high] = ordered.symmetric(ranks);
        assert!((low + 2.0 * 0.975_f64.ln()).abs() < 0.002, "{low}");
        assert!((high + 2.0 * 0.025_f64.ln()).abs() < 0.05, "{high}");
        assert!((ordered.median() - 2.0 * 2.0_f64.ln()).abs() < 0.01);
    }

    #[test]
    fn standard_errors_are_the_scatter_of_repeated_runs() {
        let count = 20_000;
        let ranks = Ranks::new(count, 0.95);
        let mut stream = Stream::new(5);
        let mut ends = Vec::new();
        let mut stated = 0.0;
        for _ in 0..200 {
            let values: Vec<f64> = (0..count).map(|_| stream.normal()).collect();
            let ordered = Ordered::new(&values, ranks.last);
            ends.push(ordered.symmetric(ranks)[1]);
            stated += ordered.standard_error(ranks.symmetric + ranks.covered) / 200.0;
        }
        let mean = ends.iter().sum::<f64>() / 200.0;
        let scatter = (ends.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / 199.0).sqrt();
        // √(a(1−a)/M)/φ(z) for the 97.5 % point.
        let exact = (0.025_f64 * 0.975 / count as f64).sqrt() / 0.058_445_1;
        assert!((stated / exact - 1.0).abs() < 0.03, "{stated} {exact}");
        assert!((scatter / exact - 1.0).abs() < 0.2, "{scatter} {exact}");
    }
}
