//! Mean, standard deviation, skewness and kurtosis of trials (JCGM 101 7.6).
//!
//! Values are first shifted by the GUM estimate and scaled by a power of two near the GUM
//! uncertainty: differences of nearby numbers are exact, so that y = 5·10⁷ ± 25 loses nothing, and
//! fourth powers neither overflow nor vanish whatever the unit. Within a chunk the mean is found
//! before the central sums; chunks are merged by the pairwise formulas of Chan, Golub and LeVeque
//! (to fourth order by Pébay, 2008).

/// Accumulators that run side by side, so that the sums vectorise and stay accurate.
const WIDTH: usize = 8;

/// Origin and scale of the moments of one output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pivot {
    origin: f64,
    /// A power of two, so that scaling is exact.
    scale: f64,
    /// 1/scale.
    inverse: f64,
}

impl Pivot {
    /// From the estimate and standard uncertainty that first order gave; either may be useless
    /// (zero, infinite, NaN), which costs accuracy at most.
    pub(super) fn new(estimate: f64, u: f64) -> Self {
        let origin = if estimate.is_finite() { estimate } else { 0.0 };
        let usable = u.is_finite() && u > 0.0;
        let exponent = if usable {
            libm::ilogb(u).clamp(-1000, 1000)
        } else {
            0
        };
        Pivot {
            origin,
            scale: libm::scalbn(1.0, exponent),
            inverse: libm::scalbn(1.0, -exponent),
        }
    }

    /// The same scale about another origin.
    pub(super) fn moved(self, origin: f64) -> Self {
        Pivot { origin, ..self }
    }

    /// Origin and factor of the coordinates.
    pub(super) fn coordinates(self) -> [f64; 2] {
        [self.origin, self.inverse]
    }

    fn inward(self, value: f64) -> f64 {
        (value - self.origin) * self.inverse
    }
}

/// Count and central moments of finite values, in the pivot's coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moments {
    pivot: Pivot,
    count: u64,
    failed: u64,
    mean: f64,
    /// Σ (x − mean)², and likewise for the third and fourth powers.
    sum2: f64,
    sum3: f64,
    sum4: f64,
}

impl Moments {
    /// No values yet.
    pub(super) fn empty(pivot: Pivot) -> Self {
        Moments {
            pivot,
            count: 0,
            failed: 0,
            mean: 0.0,
            sum2: 0.0,
            sum3: 0.0,
            sum4: 0.0,
        }
    }

    /// Moments of the finite ones among `values`.
    pub(super) fn of(values: &[f64], pivot: Pivot) -> Self {
        let [finite, sum] = lane_sums(values, |value| {
            let finite = value.is_finite();
            let shifted = if finite { pivot.inward(value) } else { 0.0 };
            [f64::from(u8::from(finite)), shifted]
        });
        if finite == 0.0 {
            return Moments {
                failed: values.len() as u64,
                ..Moments::empty(pivot)
            };
        }
        let mean = sum / finite;
        let [rest, sum2, sum3, sum4] = lane_sums(values, |value| {
            let d = if value.is_finite() {
                pivot.inward(value) - mean
            } else {
                0.0
            };
            let d2 = d * d;
            [d, d2, d2 * d, d2 * d2]
        });
        let count = finite as u64;
        // The deviations from the rounded mean still sum to a little: corrected two-pass formula.
        Moments {
            pivot,
            count,
            failed: values.len() as u64 - count,
            mean: mean + rest / finite,
            sum2: sum2 - rest * rest / finite,
            sum3,
            sum4,
        }
    }

    /// From the sums of the first four powers of finite values' distances from the pivot, in its
    /// coordinates. The pivot has to be near the mean, or digits are lost.
    pub(super) fn from_sums(pivot: Pivot, count: u64, failed: u64, sums: [f64; 4]) -> Self {
        if count == 0 {
            return Moments {
                failed,
                ..Moments::empty(pivot)
            };
        }
        let n = count as f64;
        let [s1, s2, s3, s4] = sums;
        let mean = s1 / n;
        let square = mean * mean;
        Moments {
            pivot,
            count,
            failed,
            mean,
            sum2: s2 - s1 * mean,
            sum3: s3 - 3.0 * mean * s2 + 2.0 * square * s1,
            sum4: s4 - 4.0 * mean * s3 + 6.0 * square * s2 - 3.0 * square * mean * s1,
        }
    }

    /// Moments of both sets together.
    pub(super) fn merge(&self, other: &Moments) -> Moments {
        let failed = self.failed + other.failed;
        if self.count == 0 {
            return Moments { failed, ..*other };
        }
        if other.count == 0 {
            return Moments { failed, ..*self };
        }
        let (na, nb) = (self.count as f64, other.count as f64);
        let n = na + nb;
        let delta = other.mean - self.mean;
        let step = delta / n;
        let cross = delta * step * na * nb;
        Moments {
            pivot: self.pivot,
            count: self.count + other.count,
            failed,
            mean: self.mean + step * nb,
            sum2: self.sum2 + other.sum2 + cross,
            sum3: self.sum3
                + other.sum3
                + cross * step * (na - nb)
                + 3.0 * step * (na * other.sum2 - nb * self.sum2),
            sum4: self.sum4
                + other.sum4
                + cross * step * step * (na * na - na * nb + nb * nb)
                + 6.0 * step * step * (na * na * other.sum2 + nb * nb * self.sum2)
                + 4.0 * step * (na * other.sum3 - nb * self.sum3),
        }
    }

    /// Finite values.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Values that were not finite.
    pub(super) fn failed(&self) -> u64 {
        self.failed
    }

    /// Arithmetic mean (7.6, estimate y).
    pub(super) fn mean(&self) -> f64 {
        self.pivot.origin + self.pivot.scale * self.mean
    }

    /// Standard deviation with divisor M − 1 (7.6, u(y)); NaN for fewer than two values.
    pub(super) fn sd(&self) -> f64 {
        if self.count < 2 {
            return f64::NAN;
        }
        self.pivot.scale * (self.sum2.max(0.0) / (self.count - 1) as f64).sqrt()
    }

    /// Third standardised moment; `None` for a constant.
    pub(super) fn skewness(&self) -> Option<f64> {
        let variance = self.sum2 / self.count as f64;
        (variance > 0.0).then(|| self.sum3 / self.count as f64 / (variance * variance.sqrt()))
    }

    /// Fourth standardised moment less 3; `None` for a constant.
    pub(super) fn excess_kurtosis(&self) -> Option<f64> {
        let variance = self.sum2 / self.count as f64;
        (variance > 0.0).then(|| self.sum4 / self.count as f64 / (variance * variance) - 3.0)
    }

    /// Standard error of the mean: s/√M.
    pub(super) fn mean_error(&self) -> f64 {
        self.sd() / (self.count as f64).sqrt()
    }

    /// Standard error of the standard deviation: s √((β₂ − 1)/(4M)), β₂ the sample's kurtosis.
    pub(super) fn sd_error(&self) -> f64 {
        let excess = self.excess_kurtosis().unwrap_or(-2.0);
        self.sd() * ((excess + 2.0).max(0.0) / (4.0 * self.count as f64)).sqrt()
    }
}

/// Sums of several terms over all values, by interleaved accumulators that are added in a fixed order.
fn lane_sums<const N: usize>(values: &[f64], terms: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let mut sums = [[0.0; WIDTH]; N];
    let (groups, rest) = values.as_chunks::<WIDTH>();
    for group in groups {
        for (lane, &value) in group.iter().enumerate() {
            for (sum, term) in sums.iter_mut().zip(terms(value)) {
                sum[lane] += term;
            }
        }
    }
    for (lane, &value) in rest.iter().enumerate() {
        for (sum, term) in sums.iter_mut().zip(terms(value)) {
            sum[lane] += term;
        }
    }
    sums.map(|lanes| lanes.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Textbook definitions on small whole numbers, where every sum is exact.
    #[test]
    fn small_sample_by_definition() {
        // Mean 5, deviations −3 −1 −1 −1 0 0 2 4: Σd² = 32, Σd³ = 42, Σd⁴ = 356.
        let values = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0];
        for pivot in [
            Pivot::new(0.0, 1.0),
            Pivot::new(4.5, 2.0),
            Pivot::new(f64::NAN, 0.0),
        ] {
            let m = Moments::of(&values, pivot);
            assert_eq!(m.count(), 8);
            assert!((m.mean() - 5.0).abs() < 1e-15);
            assert!((m.sd() - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
            assert!((m.skewness().unwrap() - 42.0 / 8.0 / 8.0).abs() < 1e-14);
            assert!((m.excess_kurtosis().unwrap() - (356.0 / 8.0 / 16.0 - 3.0)).abs() < 1e-14);
        }
    }

    #[test]
    fn merging_equals_the_whole() {
        let values: Vec<f64> = (0..10_000)
            .map(|i| ((i * 7919) % 1009) as f64 * if i < 3000 { 0.5 } else { 1.0 })
            .collect();
        let pivot = Pivot::new(300.0, 250.0);
        let whole = Moments::of(&values, pivot);
        let merged = values
            .chunks(977)
            .map(|c| Moments::of(c, pivot))
            .fold(Moments::empty(pivot), |a, b| a.merge(&b));
        assert_eq!(merged.count(), whole.count());
        for (a, b) in [
            (merged.mean(), whole.mean()),
            (merged.sd(), whole.sd()),
            (merged.skewness().unwrap(), whole.skewness().unwrap()),
            (
                merged.excess_kurtosis().unwrap(),
                whole.excess_kurtosis().unwrap(),
            ),
        ] {
            assert!((a - b).abs() < 1e-12 * b.abs().max(1.0), "{a} {b}");
        }
    }

    #[test]
    fn a_large_offset_loses_nothing() {
        let small: Vec<f64> = (0..5000).map(|i| ((i * 37) % 101) as f64 - 50.0).collect();
        let large: Vec<f64> = small.iter().map(|v| 5e7 + v).collect();
        let a = Moments::of(&small, Pivot::new(0.0, 30.0));
        let b = Moments::of(&large, Pivot::new(5e7, 30.0));
        assert_eq!(a.sd(), b.sd());
        assert_eq!(a.skewness(), b.skewness());
        // Without a useful pivot the corrected two-pass sums still hold.
        let c = Moments::of(&large, Pivot::new(f64::INFINITY, 0.0));
        assert!((c.sd() / a.sd() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn tiny_and_huge_units_do_not_overflow() {
        for unit in [1e-150, 1e150] {
            let values: Vec<f64> = (0..1000).map(|i| ((i % 10) as f64 - 4.5) * unit).collect();
            let m = Moments::of(&values, Pivot::new(0.0, 3.0 * unit));
            // Discrete uniform on ten points: excess kurtosis −6(n²+1)/(5(n²−1)).
            let exact = -6.0 * 101.0 / (5.0 * 99.0);
            assert!(
                (m.excess_kurtosis().unwrap() - exact).abs() < 1e-12,
                "{unit}"
            );
        }
    }

    #[test]
    fn failed_trials_are_counted_and_left_out() {
        let m = Moments::of(&[1.0, f64::NAN, 3.0, f64::INFINITY], Pivot::new(0.0, 1.0));
        assert_eq!((m.count(), m.failed(), m.mean()), (2, 2, 2.0));
        let none = Moments::of(&[f64::NAN; 3], Pivot::new(0.0, 1.0));
        assert_eq!((none.count(), none.failed()), (0, 3));
        assert_eq!(none.merge(&m).failed(), 5);
        assert_eq!(m.merge(&none).mean(), 2.0);
    }

    #[test]
    fn a_constant_has_no_shape() {
        let m = Moments::of(&[4.25; 100], Pivot::new(4.0, 0.0));
        assert_eq!((m.mean(), m.sd()), (4.25, 0.0));
        assert_eq!((m.skewness(), m.excess_kurtosis()), (None, None));
        assert_eq!((m.mean_error(), m.sd_error()), (0.0, 0.0));
    }
}
