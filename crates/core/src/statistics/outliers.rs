//! Tests for readings that do not belong to the others. They report and never remove: whether a reading
//! is dropped is decided by somebody who knows what happened when it was taken.

use super::{Dd, Series};
use crate::special::roots::last;
use crate::special::{
    gauss_legendre, ln_gamma, normal_cdf, normal_pdf, normal_sf, student_t_sf,
    student_t_upper_quantile,
};

/// Which test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutlierTest {
    /// Grubbs: largest deviation from the mean in units of s (ISO 5725-2, GB/T 4883).
    Grubbs,
    /// Dixon: gap beside the outermost reading over the range (r₁₀, r₁₁, r₂₁, r₂₂ by number of readings).
    Dixon,
    /// Dixon's Q: r₁₀, the gap over the whole range, for any number of readings.
    DixonQ,
    /// Four mean deviations of the other readings.
    FourMeanDeviations,
    /// Three standard deviations (Pauta, Raida).
    ThreeSigma,
}

/// What a test found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Suspect {
    /// Place of the most outlying reading, counted from 0.
    pub place: usize,
    /// The statistic of the test.
    pub statistic: f64,
    /// What it must exceed.
    pub critical: f64,
    /// Probability of such a statistic or a larger one in normal readings, where the test has one.
    pub p: Option<f64>,
}

impl Suspect {
    /// Whether the test takes the reading for an outlier.
    pub fn is_outlier(&self) -> bool {
        self.statistic > self.critical
    }
}

impl OutlierTest {
    /// The number of readings for which the test can say anything.
    pub fn counts(self) -> (usize, usize) {
        match self {
            OutlierTest::Grubbs => (3, usize::MAX),
            OutlierTest::Dixon | OutlierTest::DixonQ => (3, 30),
            OutlierTest::FourMeanDeviations => (4, usize::MAX),
            // The largest possible deviation is (n - 1)/√n standard deviations.
            OutlierTest::ThreeSigma => (11, usize::MAX),
        }
    }

    /// Tests the most outlying of readings that are not all equal, on either side.
    pub fn run(self, readings: &[Dd], significance: f64) -> Suspect {
        match self {
            OutlierTest::Grubbs => grubbs(readings, significance),
            OutlierTest::Dixon => dixon(Dixon::new(readings.len()), readings, significance),
            OutlierTest::DixonQ => dixon(Dixon::q(readings.len()), readings, significance),
            OutlierTest::FourMeanDeviations => four_mean_deviations(readings),
            OutlierTest::ThreeSigma => {
                let (place, statistic) = largest_deviation(readings);
                Suspect {
                    place,
                    statistic,
                    critical: 3.0,
                    p: None,
                }
            }
        }
    }
}

/// Place of the reading farthest from the mean, and its distance in units of s.
fn largest_deviation(readings: &[Dd]) -> (usize, f64) {
    let series = Series::new(readings);
    let s = series.standard_deviation();
    let far = series
        .deviations()
        .enumerate()
        .max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
    far.map_or((0, 0.0), |(place, deviation)| (place, deviation.abs() / s))
}

/// Two-sided: G = max|x - x̄|/s against the critical value that t at α/(2n) gives.
fn grubbs(readings: &[Dd], significance: f64) -> Suspect {
    let n = readings.len() as f64;
    let (place, statistic) = largest_deviation(readings);
    let t = student_t_upper_quantile(significance / (2.0 * n), n - 2.0);
    let critical = (n - 1.0) / n.sqrt() * (t * t / (n - 2.0 + t * t)).sqrt();
    // The same relation backwards.
    let ratio = (statistic * statistic * n / ((n - 1.0) * (n - 1.0))).min(1.0);
    let t = ((n - 2.0) * ratio / (1.0 - ratio)).sqrt();
    Suspect {
        place,
        statistic,
        critical,
        p: Some((2.0 * n * student_t_sf(t, n - 2.0)).min(1.0)),
    }
}

/// The reading farthest from the mean of the others, over four times their mean deviation.
fn four_mean_deviations(readings: &[Dd]) -> Suspect {
    let (place, _) = largest_deviation(readings);
    let mut others = readings.to_vec();
    let suspect = others.remove(place);
    let series = Series::new(&others);
    let mean_deviation = series.deviations().map(f64::abs).sum::<f64>() / others.len() as f64;
    let distance = (suspect - series.exact_mean()).value().abs();
    Suspect {
        place,
        statistic: distance / mean_deviation,
        critical: 4.0,
        p: None,
    }
}

/// Dixon's ratio: the gap between an outermost reading and its `gap`-th neighbour, over the range without
/// the `skip` outermost readings at the other end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Dixon {
    gap: usize,
    skip: usize,
    count: usize,
}

impl Dixon {
    fn new(count: usize) -> Self {
        let (gap, skip) = match count {
            ..=7 => (1, 0),
            8..=10 => (1, 1),
            11..=13 => (2, 1),
            _ => (2, 2),
        };
        Dixon { gap, skip, count }
    }

    fn q(count: usize) -> Self {
        Dixon {
            gap: 1,
            skip: 0,
            count,
        }
    }

    /// The ratio for the last of readings in ascending (or descending) order.
    fn ratio(self, ordered: &[Dd]) -> f64 {
        let last = ordered[self.count - 1];
        let gap = last - ordered[self.count - 1 - self.gap];
        let range = last - ordered[self.skip];
        if range.value() == 0.0 {
            return 0.0;
        }
        (gap / range).value()
    }

    /// Probability that the ratio of the largest of normal readings exceeds r. Given the largest z and
    /// the x that ends the range, the readings between are independent and lie in (x, z), and the ratio
    /// exceeds r when fewer than `gap` of them lie above z - r(z - x).
    fn exceeds(self, r: f64) -> f64 {
        let n = self.count as f64;
        let skip = self.skip as f64;
        let between = self.count - self.skip - 2;
        let between_f = between as f64;
        let constant = ln_gamma(n + 1.0) - ln_gamma(skip + 1.0) - ln_gamma(between_f + 1.0);
        let mut total = 0.0;
        for (z, weight) in panels(-6.0, 8.5) {
            let mut inner = 0.0;
            for (x, w) in panels(-8.5, z) {
                let whole = probability_between(x, z);
                let above = probability_between(z - r * (z - x), z);
                if whole <= 0.0 {
                    continue;
                }
                let fewer = binomial_below(self.gap, between, (above / whole).min(1.0));
                let before = libm::pow(normal_cdf(x), skip) * libm::pow(whole, between_f);
                inner += w * normal_pdf(x) * before * fewer;
            }
            total += weight * normal_pdf(z) * inner;
        }
        (libm::exp(constant) * total).clamp(0.0, 1.0)
    }
}

/// Nodes and weights over an interval in eight panels.
fn panels(low: f64, high: f64) -> impl Iterator<Item = (f64, f64)> {
    const PANELS: u32 = 8;
    let width = (high - low) / f64::from(PANELS);
    (0..PANELS).flat_map(move |panel| {
        let start = low + f64::from(panel) * width;
        gauss_legendre(start, start + width)
    })
}

/// Probability of a normal reading between two values, without cancellation in the upper tail.
fn probability_between(low: f64, high: f64) -> f64 {
    if low > 0.0 {
        normal_sf(low) - normal_sf(high)
    } else {
        normal_cdf(high) - normal_cdf(low)
    }
}

/// Probability of fewer than `limit` (one or two) successes in `count` trials.
fn binomial_below(limit: usize, count: usize, p: f64) -> f64 {
    let n = count as f64;
    let none = libm::pow(1.0 - p, n);
    match limit {
        1 => none,
        _ if count == 0 => 1.0,
        _ => none + n * p * libm::pow(1.0 - p, n - 1.0),
    }
}

/// Two-sided, both ends: the larger of both ratios against the critical value for α/2.
fn dixon(test: Dixon, readings: &[Dd], significance: f64) -> Suspect {
    let mut order: Vec<usize> = (0..readings.len()).collect();
    order.sort_by(|a, b| (readings[*a] - readings[*b]).value().total_cmp(&0.0));
    let ascending: Vec<Dd> = order.iter().map(|place| readings[*place]).collect();
    let descending: Vec<Dd> = ascending.iter().rev().copied().collect();
    let (high, low) = (test.ratio(&ascending), test.ratio(&descending));
    let (place, statistic) = if high >= low {
        (order[order.len() - 1], high)
    } else {
        (order[0], low)
    };
    Suspect {
        place,
        statistic,
        critical: critical_ratio(test, 0.5 * significance),
        p: Some((2.0 * test.exceeds(statistic)).min(1.0)),
    }
}

/// The ratio that is exceeded with a probability.
fn critical_ratio(test: Dixon, probability: f64) -> f64 {
    last(0.0, 1.0, |ratio| test.exceeds(ratio) > probability)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(values: &[f64]) -> Vec<Dd> {
        values.iter().map(|value| Dd::from(*value)).collect()
    }

    fn close(obtained: f64, expected: f64, tolerance: f64) {
        assert!(
            (obtained - expected).abs() <= tolerance,
            "{obtained} is not {expected}"
        );
    }

    #[test]
    fn critical_ratios_of_dixon() {
        // Two-sided 95 % (Rorabacher 1991, whose table is interpolated), r10; one-sided 95 % of 3 and 5.
        for (n, critical) in [(3, 0.970), (4, 0.829), (5, 0.710), (6, 0.625), (7, 0.568)] {
            close(critical_ratio(Dixon::new(n), 0.025), critical, 0.003);
        }
        // The Q test of chemists at 90, 95 and 99 % (Rorabacher 1991).
        for (n, critical) in [
            (8, [0.468, 0.526, 0.634]),
            (10, [0.412, 0.466, 0.568]),
            (20, [0.300, 0.342, 0.425]),
        ] {
            for (probability, critical) in [0.05, 0.025, 0.005].into_iter().zip(critical) {
                close(critical_ratio(Dixon::q(n), probability), critical, 0.002);
            }
        }
        close(critical_ratio(Dixon::new(3), 0.05), 0.941, 0.0006);
        close(critical_ratio(Dixon::new(5), 0.05), 0.642, 0.0006);
        // One-sided 95 %: r11 of 8, r21 of 11, r22 of 14 (Dixon 1953).
        close(critical_ratio(Dixon::new(8), 0.05), 0.554, 0.002);
        close(critical_ratio(Dixon::new(11), 0.05), 0.576, 0.004);
        close(critical_ratio(Dixon::new(14), 0.05), 0.546, 0.004);
    }

    #[test]
    fn either_gap_of_three_readings_is_as_likely_the_larger() {
        // The middle one of three readings is as likely nearer to the largest as to the smallest.
        close(Dixon::new(3).exceeds(0.5), 0.5, 1e-9);
        close(Dixon::new(3).exceeds(0.0), 1.0, 1e-9);
    }

    #[test]
    fn critical_values_of_grubbs() {
        // Two-sided 5 % (ISO 5725-2 table of 2.5 % upper tails): 1.155 for 3, 2.290 for 10, 2.709 for 20.
        for (n, critical) in [(3, 1.155), (5, 1.715), (10, 2.290), (20, 2.709)] {
            let mut values: Vec<f64> = (0..n).map(f64::from).collect();
            values[0] = -1.0;
            close(grubbs(&readings(&values), 0.05).critical, critical, 0.001);
        }
    }

    #[test]
    fn an_outlier_is_found_by_every_test() {
        let values: Vec<f64> = vec![
            10.1, 10.2, 9.9, 10.0, 10.05, 9.95, 10.1, 9.9, 10.0, 10.15, 9.85, 10.0, 13.0, 10.0,
        ];
        for test in [
            OutlierTest::Grubbs,
            OutlierTest::Dixon,
            OutlierTest::DixonQ,
            OutlierTest::FourMeanDeviations,
            OutlierTest::ThreeSigma,
        ] {
            let found = test.run(&readings(&values), 0.05);
            assert!(found.is_outlier(), "{test:?}: {found:?}");
            assert_eq!(found.place, 12, "{test:?}");
            let mirrored: Vec<f64> = values.iter().map(|x| -x).collect();
            assert_eq!(test.run(&readings(&mirrored), 0.05).place, 12, "{test:?}");
            assert!(
                !test.run(&readings(&values[..12]), 0.05).is_outlier(),
                "{test:?}"
            );
        }
    }

    #[test]
    fn probability_and_critical_value_agree() {
        let values = readings(&[1.0, 2.0, 2.5, 3.0, 9.0]);
        for test in [OutlierTest::Grubbs, OutlierTest::Dixon, OutlierTest::DixonQ] {
            let p = test.run(&values, 0.05).p.expect("a probability");
            let at = test.run(&values, p);
            close(at.critical, at.statistic, 1e-6);
        }
    }
}
