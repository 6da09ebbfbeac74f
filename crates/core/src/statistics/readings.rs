//! Statistics of one series of readings (GUM 4.2), with its serial correlation.

use super::Dd;
use crate::special::{ln_gamma, normal_cdf, normal_pdf};

/// Mean and scatter of readings of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The readings' deviations from their mean.
    deviations: Vec<Dd>,
    mean: Dd,
    squares: Dd,
}

impl Series {
    /// Readings in the order in which they were taken.
    pub fn new(readings: &[Dd]) -> Self {
        let n = Dd::from(readings.len() as f64);
        let mean = readings.iter().copied().sum::<Dd>() / n;
        let deviations: Vec<Dd> = readings.iter().map(|reading| *reading - mean).collect();
        let squares = deviations.iter().map(|deviation| deviation.squared()).sum();
        Series {
            deviations,
            mean,
            squares,
        }
    }

    /// Number of readings.
    pub fn count(&self) -> usize {
        self.deviations.len()
    }

    /// Arithmetic mean.
    pub fn mean(&self) -> f64 {
        self.mean.value()
    }

    /// The mean beyond the double.
    pub(super) fn exact_mean(&self) -> Dd {
        self.mean
    }

    /// The sum of squared deviations beyond the double.
    pub(super) fn exact_squares(&self) -> Dd {
        self.squares
    }

    /// Sum of squared deviations from the mean.
    pub fn squares(&self) -> f64 {
        self.squares.value()
    }

    /// Experimental standard deviation of a single reading, divisor n - 1 (GUM 4.2.2).
    pub fn standard_deviation(&self) -> f64 {
        let freedom = Dd::from(self.deviations.len() as f64 - 1.0);
        (self.squares / freedom).sqrt().value()
    }

    /// The readings' deviations from their mean.
    pub fn deviations(&self) -> impl Iterator<Item = f64> + '_ {
        self.deviations.iter().map(|deviation| deviation.value())
    }

    /// Autocorrelation coefficient at a lag: Σ (x_i - x̄)(x_{i+k} - x̄) / Σ (x_i - x̄)².
    pub fn autocorrelation(&self, lag: usize) -> f64 {
        let later = self.deviations.get(lag..).unwrap_or_default();
        let pairs = self.deviations.iter().zip(later);
        let products: Dd = pairs.map(|(a, b)| *a * *b).sum();
        (products / self.squares).value()
    }

    /// The same of deviations as doubles, to a digit or two less than all: there are thousands of lags.
    fn lagged(&self, deviations: &[f64], lag: usize) -> f64 {
        let later = deviations.get(lag..).unwrap_or_default();
        (sum_of_products(deviations, later) / self.squares).value()
    }

    /// What |ρ_1| of independent readings exceeds in one case of twenty only.
    pub fn serial_limit(&self) -> f64 {
        2.0 / (self.deviations.len() as f64).sqrt()
    }

    /// By what serial correlation multiplies the variance of the mean: var(x̄) = F·σ²/n with F = 1 + 2 Σ (1 − k/n) ρ_k.
    ///
    /// The mean takes up F·σ²/n of every product of deviations, so that with r_k, those of [`Series::autocorrelation`], in
    /// expectation ρ_k = (n − F) r_k/(n − k) + F/n. Put into F, this is linear in F and solved for it. The sum ends with the
    /// first lag that is four times the correlation time F/2 (Sokal 1997: of correlation that fades with it, e⁻⁴ is left
    /// out), or with a quarter of n. F is from 1, since alternating readings are not trusted more than independent ones, to n.
    pub fn serial(&self) -> Serial {
        const WINDOW: f64 = 4.0;
        let n = self.deviations.len() as f64;
        if self.squares() == 0.0 {
            return Serial {
                factor: 1.0,
                dof: n - 1.0,
            };
        }
        let deviations: Vec<f64> = self.deviations().collect();
        let (mut sum, mut weights, mut factor, mut window) = (0.0, 0.0, 1.0, 0.0);
        for lag in 1..=self.deviations.len() / 4 {
            let k = lag as f64;
            window = k;
            sum += self.lagged(&deviations, lag);
            weights += 1.0 - k / n;
            let left = 1.0 + 2.0 * (sum - weights) / n;
            factor = match left > 0.0 {
                true => ((1.0 + 2.0 * sum) / left).max(1.0).min(n),
                false => n,
            };
            if k >= WINDOW * factor / 2.0 {
                break;
            }
        }
        Serial::of(n, factor, window)
    }
}

/// Σ a_i b_i over the shorter of both. Products are added in doubles, a few for each of eight sums side by side; what they give is
/// added beyond the double, so that the sum is as good as its terms at the pace of doubles.
fn sum_of_products(a: &[f64], b: &[f64]) -> Dd {
    const SUMS: usize = 8;
    const RUN: usize = 16 * SUMS;
    let count = a.len().min(b.len());
    let runs = a[..count].chunks(RUN).zip(b[..count].chunks(RUN));
    runs.map(|(a, b)| {
        let (whole, rest) = a.as_chunks::<SUMS>();
        let (beside, last) = b.as_chunks::<SUMS>();
        let mut sums = [0.0; SUMS];
        for (a, b) in whole.iter().zip(beside) {
            for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
                *sum += a * b;
            }
        }
        let rest: f64 = rest.iter().zip(last).map(|(a, b)| a * b).sum();
        Dd::from(sums.iter().sum::<f64>() + rest)
    })
    .sum()
}

/// What serial correlation does to the mean of n readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Serial {
    /// F: by what it multiplies the variance of the mean ([`Series::serial`]).
    pub factor: f64,
    /// Degrees of freedom of the standard uncertainty of the mean.
    pub dof: f64,
}

impl Serial {
    /// Of a factor that is summed over a window of W lags.
    ///
    /// With a known factor ν were n/F − 1. An estimated one scatters by √(2(2W + 1)/n) of itself (Madras and Sokal 1988, J. Stat.
    /// Phys. 50, 109), which ν = 2/(Δu²/u²)² makes n/(2W + 1). What of that lies below 1, the factor of independent readings, is cut
    /// off: the variance left is that of max(z, −a), z normal and a how far above 1 the factor is in its own scatter.
    fn of(n: f64, factor: f64, window: f64) -> Serial {
        let lags = 2.0 * window + 1.0;
        let a = (1.0 - 1.0 / factor) / (2.0 * lags / n).sqrt();
        let (above, density) = (normal_cdf(a), normal_pdf(a));
        let mean = a * above + density;
        let left = (1.0 + a * a) * above + a * density - mean * mean;
        Serial {
            factor,
            dof: (n / (lags * left)).min(n / factor - 1.0),
        }
    }
}

/// A standard deviation pooled over series of one precision (GUM 4.2.4): s and ν.
pub fn pooled(series: &[Series]) -> (f64, f64) {
    let squares: Dd = series.iter().map(|one| one.squares).sum();
    let freedom: f64 = series.iter().map(|one| one.count() as f64 - 1.0).sum();
    ((squares / Dd::from(freedom)).sqrt().value(), freedom)
}

/// The standard deviation of an experimental standard deviation s divided by its expectation, for normal readings and ν
/// degrees of freedom (GUM E.4.3, table E.1): √(1/c₄² − 1) with c₄ = √(2/ν) Γ((ν + 1)/2)/Γ(ν/2).
pub fn relative_scatter_of_s(dof: f64) -> f64 {
    let ratio = ln_gamma(0.5 * (dof + 1.0)) - ln_gamma(0.5 * dof);
    let squared = 2.0 / dof * libm::exp(2.0 * ratio);
    (1.0 / squared - 1.0).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::student_t_quantile;

    fn series(texts: impl IntoIterator<Item = &'static str>) -> Series {
        let readings: Vec<Dd> = texts.into_iter().filter_map(Dd::parse).collect();
        Series::new(&readings)
    }

    /// NIST StRD NumAcc: one reading in the middle, then as many below as above.
    fn accuracy(middle: &'static str, low: &'static str, high: &'static str) -> Series {
        let pairs = (0..500).flat_map(|_| [low, high]);
        series(std::iter::once(middle).chain(pairs))
    }

    fn digits(obtained: f64, certified: f64) -> f64 {
        let error = ((obtained - certified) / certified).abs();
        (-libm::log10(error)).min(16.0)
    }

    /// GUM table E.1, for n = ν + 1 readings.
    #[test]
    fn scatter_of_s_as_published() {
        for (readings, percent) in [
            (2, 76.0),
            (3, 52.0),
            (4, 42.0),
            (5, 36.0),
            (10, 24.0),
            (20, 16.0),
            (30, 13.0),
            (50, 10.0),
        ] {
            let found = 100.0 * relative_scatter_of_s(f64::from(readings - 1));
            assert!((found - percent).abs() < 0.5, "{readings}: {found}");
        }
    }

    #[test]
    fn strd_numerical_accuracy() {
        for (data, mean) in [
            (accuracy("1.2", "1.1", "1.3"), 1.2),
            (accuracy("1000000.2", "1000000.1", "1000000.3"), 1_000_000.2),
            (
                accuracy("10000000.2", "10000000.1", "10000000.3"),
                10_000_000.2,
            ),
        ] {
            assert_eq!(data.mean(), mean);
            assert!(
                digits(data.standard_deviation(), 0.1) >= 15.0,
                "s at {mean}"
            );
            assert!(
                digits(data.autocorrelation(1), -0.999) >= 15.0,
                "r at {mean}"
            );
        }
        let first = series(["10000001", "10000003", "10000002"]);
        assert_eq!(
            (first.mean(), first.standard_deviation()),
            (10_000_002.0, 1.0)
        );
        assert_eq!(first.autocorrelation(1), -0.5);
    }

    #[test]
    fn alternating_readings_are_not_deflated() {
        let data = series((0..40).map(|i| if i % 2 == 0 { "0" } else { "1" }));
        assert_eq!(data.serial().factor, 1.0);
    }

    fn noise() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(u32::MAX) * 2.0 - 0.5
        }
    }

    #[test]
    fn doubled_readings_are_worth_about_half() {
        // Every reading twice: ρ_1 is about ½, higher lags about 0, so the factor is about 2.
        let mut noise = noise();
        let readings: Vec<Dd> = (0..2000)
            .flat_map(|_| {
                let reading = Dd::from(noise());
                [reading, reading]
            })
            .collect();
        let factor = Series::new(&readings).serial().factor;
        assert!((factor - 2.0).abs() < 0.1, "{factor}");
    }

    #[test]
    fn an_autoregressive_series_has_the_factor_of_theory() {
        // x_i = φ x_{i-1} + e_i: ρ_k = φ^k, and the factor is (1 + φ)/(1 - φ) for long series.
        for (phi, tolerance) in [(0.5, 0.3), (0.8, 1.5)] {
            let mut noise = noise();
            let mut x = 0.0;
            let readings: Vec<Dd> = (0..20_000)
                .map(|_| {
                    x = phi * x + noise() - 0.5;
                    Dd::from(x)
                })
                .collect();
            let factor = Series::new(&readings).serial().factor;
            let theory = (1.0 + phi) / (1.0 - phi);
            assert!((factor - theory).abs() < tolerance, "{factor} for {theory}");
        }
    }

    /// Intervals of t hold the mean of a short autoregressive series nearly as often as they say. With ρ_k as they are
    /// estimated, summed only while they are evident, it was eight of ten; with the ν of n/F readings, as if F were
    /// known, seven of eight.
    #[test]
    fn intervals_of_few_correlated_readings_hold_the_mean() {
        for (phi, count, least, most) in [
            (0.0, 30, 0.94, 0.98),
            (0.3, 30, 0.91, 0.96),
            (0.5, 30, 0.88, 0.95),
            (0.5, 100, 0.94, 0.97),
            (0.7, 60, 0.91, 0.96),
            (0.7, 100, 0.94, 0.97),
            (0.9, 200, 0.93, 0.97),
        ] {
            let mut noise = noise();
            let mut x = 0.0;
            let trials = 1000;
            let held = (0..trials).filter(|_| {
                let readings: Vec<Dd> = (0..count + 50)
                    .map(|_| {
                        x = phi * x + noise();
                        Dd::from(x)
                    })
                    .skip(50)
                    .collect();
                let series = Series::new(&readings);
                let n = f64::from(count);
                let Serial { factor, dof } = series.serial();
                let u = (series.squares() / (n - factor) * factor / n).sqrt();
                series.mean().abs() <= student_t_quantile(0.975, dof) * u
            });
            let share = held.count() as f64 / f64::from(trials);
            assert!(
                (least..most).contains(&share),
                "{share} for φ = {phi}, n = {count}"
            );
        }
    }

    #[test]
    fn pooling_adds_squares_and_degrees_of_freedom() {
        let (s, freedom) = pooled(&[series(["1", "2", "3"]), series(["10", "14"])]);
        assert_eq!(freedom, 3.0);
        assert!((s - (10.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    }
}
