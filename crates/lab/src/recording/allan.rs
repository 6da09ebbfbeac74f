//! Allan deviation of a long recording at rest.

use std::fmt;

use super::power_law::{PowerLaw, equivalent_dof};
use gumption_core::special::{chi_squared_quantile, chi_squared_upper_quantile};
use gumption_core::statistics::median;

/// The fewest readings that have an Allan deviation at more than two averaging times.
const FEWEST: usize = 16;
/// The fewest averages that tell the kind of noise.
const TELLING: usize = 30;

/// The Allan deviation of readings, at averaging times of 1, 2, 4 … intervals up to a quarter of the
/// recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Allan {
    /// Time from one reading to the next.
    pub interval: f64,
    /// Number of readings.
    pub readings: usize,
    /// Coverage probability of the confidence intervals.
    pub probability: f64,
    /// The deviations, by averaging time.
    pub points: Vec<AllanPoint>,
}

/// The Allan deviation at one averaging time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AllanPoint {
    /// Averaging time in intervals.
    pub intervals: usize,
    /// Averaging time, in the unit of the interval.
    pub tau: f64,
    /// Overlapping Allan deviation, in the unit of the readings.
    pub deviation: f64,
    /// The noise that prevails here, told by the autocorrelation of the averages; where these are too few
    /// (less than 30), as at the averaging time before.
    pub noise: PowerLaw,
    /// Equivalent degrees of freedom for that noise.
    pub dof: f64,
    /// Standard uncertainty of the deviation: deviation/√(2ν).
    pub u: f64,
    /// Confidence interval of the deviation, from χ² with the equivalent degrees of freedom.
    pub interval: [f64; 2],
}

/// Why readings have no Allan deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unsuitable {
    /// Too few readings.
    TooFew {
        /// How many there are.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// A reading is missing; the readings must follow one another at equal intervals.
    Missing {
        /// The row, from 0.
        row: usize,
    },
    /// The interval is not a positive number, or so long that the recording has no length.
    Interval(f64),
    /// The probability is not between 0 and 1.
    Probability(f64),
    /// The intervals are not equal: one is less than half or more than one and a half times the median one.
    Irregular {
        /// The row after that interval, from 0.
        row: usize,
        /// The interval.
        interval: f64,
        /// The median interval.
        median: f64,
    },
}

impl fmt::Display for Unsuitable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unsuitable::TooFew { found, needed } => {
                write!(f, "{found} readings, at least {needed} are needed")
            }
            Unsuitable::Missing { row } => write!(
                f,
                "reading {} is missing; an Allan deviation needs all readings at equal intervals",
                row + 1
            ),
            Unsuitable::Interval(interval) => {
                write!(f, "an interval of {interval} between readings")
            }
            Unsuitable::Probability(p) => write!(f, "a probability of {p}, not between 0 and 1"),
            Unsuitable::Irregular {
                row,
                interval,
                median,
            } => write!(
                f,
                "reading {} comes {interval} after the one before, where {median} is the median interval",
                row + 1
            ),
        }
    }
}

impl std::error::Error for Unsuitable {}

/// The mean interval of times that are equally spaced but for some jitter.
///
/// # Errors
/// Missing times, less than two, or an interval that shows a lost or a repeated row.
pub fn regular_interval(times: &[f64]) -> Result<f64, Unsuitable> {
    if let Some(row) = times.iter().position(|time| time.is_nan()) {
        return Err(Unsuitable::Missing { row });
    }
    let (Some(first), Some(last), true) = (times.first(), times.last(), times.len() > 1) else {
        let found = times.len();
        return Err(Unsuitable::TooFew { found, needed: 2 });
    };
    let mean = (last - first) / (times.len() - 1) as f64;
    if !mean.is_finite() || mean <= 0.0 {
        return Err(Unsuitable::Interval(mean));
    }
    let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // A lost row raises the mean of few intervals, but not the median.
    let median = median(intervals.clone());
    let odd = intervals
        .iter()
        .position(|interval| interval.is_nan() || (interval - median).abs() > 0.5 * median);
    match odd {
        Some(before) => Err(Unsuitable::Irregular {
            row: before + 1,
            interval: intervals[before],
            median,
        }),
        None => Ok(mean),
    }
}

impl Allan {
    /// The overlapping Allan deviation of readings at equal intervals, each taken as the average over
    /// its interval.
    ///
    /// `interval` is the time between readings; `probability` is that of the confidence intervals.
    ///
    /// # Errors
    /// Too few or missing readings, or an interval or a probability that cannot be.
    pub fn of(readings: &[f64], interval: f64, probability: f64) -> Result<Allan, Unsuitable> {
        let n = readings.len();
        if n < FEWEST {
            return Err(Unsuitable::TooFew {
                found: n,
                needed: FEWEST,
            });
        }
        if let Some(row) = readings.iter().position(|reading| !reading.is_finite()) {
            return Err(Unsuitable::Missing { row });
        }
        if !(interval * n as f64).is_finite() || interval <= 0.0 {
            return Err(Unsuitable::Interval(interval));
        }
        if probability.is_nan() || probability <= 0.0 || probability >= 1.0 {
            return Err(Unsuitable::Probability(probability));
        }
        let phase = phase(readings);
        let mut points: Vec<AllanPoint> = Vec::new();
        let octaves = std::iter::successors(Some(1), |m| Some(2 * m));
        for m in octaves.take_while(|m| 4 * m <= n) {
            let before = points.last().map_or(PowerLaw::White, |point| point.noise);
            let noise = noise(&phase, m).unwrap_or(before);
            let dof = equivalent_dof(n, m, noise);
            let deviation = variance(&phase, m).sqrt();
            let tail = 0.5 * (1.0 - probability);
            points.push(AllanPoint {
                intervals: m,
                tau: m as f64 * interval,
                deviation,
                noise,
                dof,
                u: deviation / (2.0 * dof).sqrt(),
                interval: [
                    deviation * (dof / chi_squared_upper_quantile(tail, dof)).sqrt(),
                    deviation * (dof / chi_squared_quantile(tail, dof)).sqrt(),
                ],
            });
        }
        Ok(Allan {
            interval,
            readings: n,
            probability,
            points,
        })
    }
}

/// Sums of the readings' deviations from their mean: the phase, in units of the interval.
fn phase(readings: &[f64]) -> Vec<f64> {
    let n = readings.len() as f64;
    let rough = readings.iter().sum::<f64>() / n;
    let mean = rough + readings.iter().map(|reading| reading - rough).sum::<f64>() / n;
    let mut sum = 0.0;
    let sums = readings.iter().map(|reading| {
        sum += reading - mean;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}

/// The overlapping Allan variance: the mean square of second differences of the phase, over 2 m².
fn variance(phase: &[f64], m: usize) -> f64 {
    let squares: f64 = phase
        .windows(2 * m + 1)
        .map(|x| (x[2 * m] - 2.0 * x[m] + x[0]) * (x[2 * m] - 2.0 * x[m] + x[0]))
        .sum();
    let count = (phase.len() - 2 * m) as f64;
    squares / count / (2.0 * (m * m) as f64)
}

/// The kind of noise at an averaging time, from the autocorrelation of successive averages (after Riley and
/// Greenhall 2004): ρ/(1 + ρ) is −α/2 for a stationary spectral density f^α, so that ρ < ⅓ is nearest to
/// white. Others are differenced; theory then expects −½ for white noise (over slower noise), −0.22 for
/// flicker (9 ln 3 − 16 ln 2 over 8 ln 2), or −⅓ where readings are taken at instants, and ¼ for random walk.
fn noise(phase: &[f64], m: usize) -> Option<PowerLaw> {
    let sums: Vec<f64> = phase.iter().copied().step_by(m).collect();
    let averages = differences(&sums);
    let steps = differences(&averages);
    if steps.len() < TELLING {
        return None;
    }
    let (rho, rho_of_steps) = (successive(&averages)?, successive(&steps)?);
    Some(match () {
        () if rho < 1.0 / 3.0 || rho_of_steps < -0.4 => PowerLaw::White,
        () if rho_of_steps < 0.0 => PowerLaw::Flicker,
        () => PowerLaw::RandomWalk,
    })
}

fn differences(series: &[f64]) -> Vec<f64> {
    series.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Autocorrelation of successive values; nothing for equal ones.
fn successive(series: &[f64]) -> Option<f64> {
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    let squares: f64 = series.iter().map(|x| (x - mean) * (x - mean)).sum();
    let products: f64 = series
        .windows(2)
        .map(|x| (x[0] - mean) * (x[1] - mean))
        .sum();
    (squares > 0.0).then(|| products / squares)
}
