//! What theory says of Allan variances for noise whose spectral density is a power of the frequency:
//! expectations, and exact covariances through the generalised autocovariance of the phase.

/// A kind of noise of a reading.
///
/// Its coefficient is that of IEEE Std 952 (spectral densities are two-sided): angle random walk N for
/// the rate of a gyro, and so on for other quantities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PowerLaw {
    /// White noise, S = N²: σ² = N²/τ.
    White,
    /// Flicker, S = B²/(2π f): σ² = B² · 2 ln 2/π. B is the bias instability.
    Flicker,
    /// Random walk, S = K²/(2π f)²: σ² = K² τ/3.
    RandomWalk,
}

/// Steps of the sum over lags in the shorter averaging time.
const FINE: usize = 16;
/// The most steps of the sum in the longer averaging time. Where the two are so far apart that this
/// limits the sum, only random walk still correlates them, and its covariances have no finer structure.
const COARSE: usize = 512;
/// Lags that count, in averaging times; only those of flicker go on, and fade.
const REACH: i64 = 3;

impl PowerLaw {
    /// All kinds, from short to long averaging times.
    pub const ALL: [PowerLaw; 3] = [PowerLaw::White, PowerLaw::Flicker, PowerLaw::RandomWalk];

    /// The Allan variance for a coefficient of 1, at an averaging time.
    pub fn allan_variance(self, tau: f64) -> f64 {
        match self {
            PowerLaw::White => 1.0 / tau,
            PowerLaw::Flicker => std::f64::consts::LN_2 * std::f64::consts::FRAC_2_PI,
            PowerLaw::RandomWalk => tau / 3.0,
        }
    }

    /// Generalised autocovariance of the phase (the integral of the readings) for a coefficient of 1:
    /// differences of it are covariances of differences of the phase. Time is in intervals.
    fn autocovariance(self, lag: i64) -> f64 {
        let t = lag.unsigned_abs() as f64;
        match self {
            PowerLaw::White => -0.5 * t,
            PowerLaw::Flicker if lag == 0 => 0.0,
            PowerLaw::Flicker => t * t * libm::log(t) / std::f64::consts::TAU,
            PowerLaw::RandomWalk => t * t * t / 12.0,
        }
    }

    /// Covariance of two second differences of the phase, with steps a and b, the second one beginning
    /// `lag` later.
    fn covariance(self, [a, b]: [i64; 2], lag: i64) -> f64 {
        const WEIGHTS: [f64; 3] = [1.0, -2.0, 1.0];
        let mut sum = 0.0;
        for (i, p) in (0..).zip(WEIGHTS) {
            for (j, q) in (0..).zip(WEIGHTS) {
                sum += p * q * self.autocovariance(lag + j * b - i * a);
            }
        }
        sum
    }
}

/// Covariance of two overlapping Allan variances of the same n readings, at `a` and `b` intervals, for
/// Gaussian noise: a quadratic form in the squared coefficients.
///
/// The result holds the terms for pairs of [`PowerLaw::ALL`], for an interval of 1: the covariance is
/// Σ c_i c_j result[i][j], with squared coefficients c for that interval.
pub(super) fn covariances(n: usize, a: usize, b: usize) -> [[f64; 3]; 3] {
    let (a, b) = (a.min(b), a.max(b));
    let mut terms = [[0.0; 3]; 3];
    let counts = [n + 1 - 2 * a, n + 1 - 2 * b].map(|count| count as i64);
    let stride = (a / FINE).max(b / COARSE).max(1) as i64;
    let steps = [a as i64, b as i64];
    // Where both differences have the same middle.
    let middle = steps[0] - steps[1];
    let reach = REACH * (steps[0] + steps[1]) / stride;
    for step in -reach..=reach {
        let lag = middle + step * stride;
        // How many pairs of differences have this lag.
        let pairs = counts[0].min(counts[1] - lag) - 0.max(-lag);
        if pairs <= 0 {
            continue;
        }
        let r = PowerLaw::ALL.map(|law| law.covariance(steps, lag));
        for i in 0..3 {
            for j in 0..3 {
                terms[i][j] += (pairs * stride) as f64 * r[i] * r[j];
            }
        }
    }
    let scale = |step: i64| 2.0 * (step * step) as f64;
    let factor = 2.0 / (counts[0] as f64 * counts[1] as f64) / (scale(steps[0]) * scale(steps[1]));
    terms.map(|row| row.map(|term| term * factor))
}

/// Equivalent degrees of freedom of the overlapping Allan variance of n readings at `m` intervals, for
/// one kind of noise: 2 E²/V.
pub(super) fn equivalent_dof(n: usize, m: usize, law: PowerLaw) -> f64 {
    let place = law as usize;
    let variance = covariances(n, m, m)[place][place];
    let expected = law.allan_variance(m as f64);
    2.0 * expected * expected / variance
}
