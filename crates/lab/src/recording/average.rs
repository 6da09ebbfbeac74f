//! The mean of a dwell with its standard uncertainty, and the drift in it (GUM 4.2).

use std::fmt;

use gumption_core::special::student_t_sf;
use gumption_core::statistics::{Dd, Serial, Series, effective_freedom, norm, range};

/// Longer series are taken in blocks of successive readings, so that their serial correlation takes
/// no time that grows with the square of their length.
const LONGEST: usize = 4096;

/// The mean of readings of one quantity, and what it is worth.
///
/// All values but counts and coefficients are in the unit of the readings.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Average {
    /// Arithmetic mean.
    pub mean: f64,
    /// Experimental standard deviation of a single reading, divisor n − 1 (GUM 4.2.2).
    pub s: f64,
    /// Number of readings, without the missing ones.
    pub n: usize,
    /// Number of missing readings (NaN), which are left out.
    pub missing: usize,
    /// Autocorrelation coefficient of successive readings; 0 where all are equal.
    pub autocorrelation: f64,
    /// The number of independent readings that are worth as much: n over
    /// 1 + 2 Σ (1 − k/n) ρ_k ([`Series::serial`]).
    pub effective: f64,
    /// Standard uncertainty of the mean (GUM 4.2.3, with serial correlation after 4.2.7): √(σ²/effective)
    /// with σ² = Σ(x − x̄)²/(n − n/effective). 0 where all readings are equal: their resolution is
    /// then another component.
    pub u: f64,
    /// Degrees of freedom of `u`: of so many independent readings, or fewer where their number is an estimate
    /// ([`Series::serial`]).
    pub dof: f64,
    /// The smallest reading.
    pub minimum: f64,
    /// The largest reading.
    pub maximum: f64,
}

/// A straight line through the readings of a dwell.
///
/// Serial correlation of the residuals is taken into account as for the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Drift {
    /// Change per unit of time.
    pub slope: f64,
    /// Its standard uncertainty.
    pub u_slope: f64,
    /// Change from the first to the last reading, as the line says.
    pub total: f64,
    /// The value of the line at the mean time, which is the mean of the readings; its standard
    /// uncertainty is this. Where there is a drift, it is smaller than [`Average::u`], which takes
    /// the drift for slow noise.
    pub u_middle: f64,
    /// Degrees of freedom: the effective number of readings − 2.
    pub dof: f64,
    /// Probability that readings without drift show one as large (two-sided t test).
    pub p_value: f64,
}

/// There are too few readings, of which missing ones do not count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooFew {
    /// How many there are.
    pub found: usize,
    /// How many are needed.
    pub needed: usize,
}

impl fmt::Display for TooFew {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let TooFew { found, needed } = self;
        write!(f, "{found} readings, at least {needed} are needed")
    }
}

impl std::error::Error for TooFew {}

impl Average {
    /// The mean of readings in the order in which they were taken, at equal intervals.
    ///
    /// # Errors
    /// Less than two readings have no scatter.
    pub fn of(readings: &[f64]) -> Result<Average, TooFew> {
        let present: Vec<f64> = readings.iter().copied().filter(|x| !x.is_nan()).collect();
        let n = present.len();
        if n < 2 {
            return Err(TooFew {
                found: n,
                needed: 2,
            });
        }
        let scatter = Scatter::new(&present);
        let effective = n as f64 / scatter.factor;
        let (minimum, maximum) = range(present.iter().copied());
        Ok(Average {
            mean: scatter.series.mean(),
            s: scatter.series.standard_deviation(),
            n,
            missing: readings.len() - n,
            autocorrelation: scatter.autocorrelation(),
            effective,
            u: (scatter.variance(1.0) / effective).sqrt(),
            dof: scatter.dof,
            minimum,
            maximum,
        })
    }
}

impl Average {
    /// The unweighted mean of independent averages; `None` of none.
    ///
    /// u² = Σ u_i²/N², with the degrees of freedom of Welch and Satterthwaite; `s` is pooled over the
    /// averages, counts are sums.
    pub(crate) fn of_averages(parts: &[Average]) -> Option<Average> {
        let (first, rest) = parts.split_first()?;
        if rest.is_empty() {
            return Some(*first);
        }
        let count = parts.len() as f64;
        let sum = |of: &dyn Fn(&Average) -> f64| parts.iter().map(of).sum::<f64>();
        let u = norm(parts.iter().map(|one| one.u));
        Some(Average {
            mean: sum(&|one| one.mean) / count,
            s: (sum(&|one| one.s * one.s) / count).sqrt(),
            n: parts.iter().map(|one| one.n).sum(),
            missing: parts.iter().map(|one| one.missing).sum(),
            autocorrelation: sum(&|one| one.autocorrelation) / count,
            effective: sum(&|one| one.effective),
            u: u / count,
            dof: match u > 0.0 {
                true => effective_freedom(parts.iter().map(|one| (one.u, one.dof))),
                // Readings that do not scatter at all: as of equal parts, however small.
                false => sum(&|one| one.dof),
            },
            minimum: range(parts.iter().map(|one| one.minimum)).0,
            maximum: range(parts.iter().map(|one| one.maximum)).1,
        })
    }
}

impl Drift {
    /// The straight line through readings against their times. Rows where either is missing do not count.
    ///
    /// `None` where readings are worth no more than two independent ones, or all times are equal: then
    /// nothing can be said.
    pub fn of(times: &[f64], readings: &[f64]) -> Option<Drift> {
        let points: Vec<(f64, f64)> = times
            .iter()
            .copied()
            .zip(readings.iter().copied())
            .filter(|(t, x)| !t.is_nan() && !x.is_nan())
            .collect();
        let n = points.len() as f64;
        let exact = |pick: fn(&(f64, f64)) -> f64| -> Series {
            Series::new(&points.iter().map(|p| Dd::from(pick(p))).collect::<Vec<_>>())
        };
        let (t, x) = (exact(|p| p.0), exact(|p| p.1));
        let products: f64 = t.deviations().zip(x.deviations()).map(|(t, x)| t * x).sum();
        let slope = products / t.squares();
        let residuals: Vec<f64> = t
            .deviations()
            .zip(x.deviations())
            .map(|(t, x)| x - slope * t)
            .collect();
        if points.len() < 3 || t.squares() <= 0.0 {
            return None;
        }
        let scatter = Scatter::new(&residuals);
        // The slope takes up one more.
        let dof = scatter.dof.min(scatter.effective_blocks - 2.0);
        if dof <= 0.0 {
            return None;
        }
        let variance = scatter.variance(2.0) * scatter.factor;
        let u_slope = (variance / t.squares()).sqrt();
        let duration = points.last()?.0 - points.first()?.0;
        let p_value = match u_slope > 0.0 {
            true => 2.0 * student_t_sf((slope / u_slope).abs(), dof),
            false if slope == 0.0 => 1.0,
            false => 0.0,
        };
        Some(Drift {
            slope,
            u_slope,
            total: slope * duration,
            u_middle: (variance / n).sqrt(),
            dof,
            p_value,
        })
    }
}

/// Scatter of a series about its mean.
struct Scatter {
    series: Series,
    /// By what serial correlation multiplies the variance of the mean.
    factor: f64,
    /// The number of independent blocks.
    effective_blocks: f64,
    /// Degrees of freedom of the variance of the mean.
    dof: f64,
}

impl Scatter {
    fn new(readings: &[f64]) -> Scatter {
        let exact = |readings: &[f64]| {
            Series::new(&readings.iter().copied().map(Dd::from).collect::<Vec<_>>())
        };
        let series = exact(readings);
        let n = readings.len() as f64;
        // Two readings at least, or there would be no scatter.
        let independent = |count: f64, series: &Series| {
            let Serial { factor, dof } = series.serial();
            ((count / factor).max(2.0_f64.min(count)), dof.max(1.0))
        };
        if readings.len() <= LONGEST {
            let (effective_blocks, dof) = independent(n, &series);
            return Scatter {
                series,
                factor: n / effective_blocks,
                effective_blocks,
                dof,
            };
        }
        let size = readings.len().div_ceil(LONGEST);
        let means: Vec<f64> = readings
            .chunks_exact(size)
            .map(|block| block.iter().sum::<f64>() / size as f64)
            .collect();
        let blocks = exact(&means);
        let count = means.len() as f64;
        let (effective_blocks, dof) = independent(count, &blocks);
        // The variance of the mean from the blocks, and from readings if they were independent.
        let of_mean = blocks.squares() / (count - count / effective_blocks) / effective_blocks;
        let of_independent = series.squares() / (n - 1.0) / n;
        let factor = match of_independent > 0.0 {
            true => (of_mean / of_independent).max(1.0).min(n / 2.0),
            false => 1.0,
        };
        Scatter {
            series,
            factor,
            effective_blocks,
            dof,
        }
    }

    /// The variance of a reading, where the mean, and perhaps a slope, were estimated from the readings:
    /// each takes up `factor`/n of it.
    fn variance(&self, estimated: f64) -> f64 {
        let left = self.series.count() as f64 - estimated * self.factor;
        self.series.squares() / left
    }

    fn autocorrelation(&self) -> f64 {
        match self.series.squares() > 0.0 {
            true => self.series.autocorrelation(1),
            false => 0.0,
        }
    }
}
