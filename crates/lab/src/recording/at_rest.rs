//! The noise of an instrument from a recording at rest: white noise, random walk and flicker, with the
//! doubt that is left about them.
//!
//! A state-space model: a random walk plus a ladder of relaxations of equal variance, whose sum is close
//! to a 1/f spectrum between the shortest and the longest of them, plus white noise. The Kalman filter
//! with a diffuse start gives the likelihood of what is left when the mean is removed (REML) in time
//! proportional to the number of readings. The two ratios of variances run over a grid; the scale is
//! integrated in closed form with Jeffreys' prior.

use gumption_lanes::{Block, Generator, LANES, level};
use nalgebra::DMatrix;

use gumption_core::special::chi_squared_quantile;

/// Readings of an instrument that nothing happens to; each is averaged like a row of the recording.
#[derive(Debug, Clone, Copy)]
pub struct AtRest<'a> {
    /// Times, h, not falling.
    pub times: &'a [f64],
    /// Readings.
    pub readings: &'a [f64],
}

/// What they tell of the noise of other rows.
#[derive(Debug, Clone, PartialEq)]
pub struct RestNoise {
    /// Standard deviation of the white part of one row.
    pub white: f64,
    /// Random walk per √h.
    pub walk: f64,
    /// Flicker: standard deviation of each rung of the ladder.
    pub flicker: f64,
    /// Posterior mean of the covariance matrix of the rows.
    pub covariance: DMatrix<f64>,
    /// Draws of it from the posterior distribution, the doubt about the scale included.
    pub draws: Vec<DMatrix<f64>>,
    /// Degrees of freedom of the scale.
    pub dof: f64,
}

/// Time constants of the ladder, h: from two minutes to two hours, four to a step.
const LADDER: [f64; 4] = [2.0 / 60.0, 8.0 / 60.0, 0.5, 2.0];
/// States of the filter: the walk and the ladder.
const STATES: usize = LADDER.len() + 1;
/// Readings below which nothing can be said of three parameters.
const FEWEST: usize = 20;

/// Variances relative to the white one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ratios {
    /// Of the walk, per hour.
    walk: f64,
    /// Of each rung.
    flicker: f64,
}

/// A point of the grid with what the readings say of it.
#[derive(Debug, Clone, Copy)]
struct Point {
    ratios: Ratios,
    /// Posterior probability.
    weight: f64,
    /// Sum of squares over the white variance.
    squares: f64,
}

/// Rows whose noise is asked for.
#[derive(Debug, Clone, Copy)]
pub struct Rows<'a> {
    /// Times, h.
    pub times: &'a [f64],
    /// How many averages of the length of a reading at rest each of them is the mean of.
    pub counts: &'a [f64],
}

/// Noise of rows from readings at rest. Nothing for too few readings, readings
/// that are all alike, or times that fall.
pub(crate) fn from_rest(
    rest: &AtRest<'_>,
    rows: &Rows<'_>,
    draws: usize,
    seed: u64,
) -> Option<RestNoise> {
    let count = rest.readings.len();
    let finite = rest
        .readings
        .iter()
        .chain(rest.times)
        .all(|x| x.is_finite());
    let ordered = rest.times.windows(2).all(|pair| pair[1] >= pair[0]);
    if count < FEWEST || rest.times.len() != count || !finite || !ordered {
        return None;
    }
    let points = posterior(rest)?;
    let dof = (count - 1) as f64;
    let mut random = Random::new(seed);
    let drawn = (0..draws)
        .map(|_| {
            let point = pick(&points, random.uniform());
            let white = point.squares / chi_squared_quantile(random.uniform(), dof);
            covariance(rows, white, point.ratios)
        })
        .collect();
    // The mean of an inverse-χ² variance.
    let scale = |point: &Point| point.squares / (dof - 2.0);
    let mean_of = |value: &dyn Fn(&Point) -> f64| -> f64 {
        points
            .iter()
            .map(|point| point.weight * scale(point) * value(point))
            .sum()
    };
    let white = mean_of(&|_| 1.0);
    let walk = mean_of(&|point| point.ratios.walk);
    let flicker = mean_of(&|point| point.ratios.flicker);
    let ratios = Ratios {
        walk: walk / white,
        flicker: flicker / white,
    };
    Some(RestNoise {
        white: white.sqrt(),
        walk: walk.sqrt(),
        flicker: flicker.sqrt(),
        // Linear in the three variances, so that their means give the mean matrix.
        covariance: covariance(rows, white, ratios),
        draws: drawn,
        dof,
    })
}

/// Covariance matrix of rows for a white variance and ratios to it.
fn covariance(rows: &Rows<'_>, white: f64, ratios: Ratios) -> DMatrix<f64> {
    let Rows {
        times: rows,
        counts,
    } = *rows;
    let start = rows.iter().copied().fold(f64::INFINITY, f64::min);
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
        let own = if i == j { 1.0 / counts[i] } else { 0.0 };
        let walked = ratios.walk * (rows[i].min(rows[j]) - start);
        let apart = (rows[i] - rows[j]).abs();
        let ladder: f64 = LADDER.iter().map(|memory| libm::exp(-apart / memory)).sum();
        white * (own + walked + ratios.flicker * ladder)
    })
}

/// The grid with posterior probabilities. Every ratio is equally probable on its logarithmic grid; none
/// at all weighs as much as a third of the grid.
fn posterior(rest: &AtRest<'_>) -> Option<Vec<Point>> {
    let grid = |low: f64, high: f64, steps: usize| -> Vec<(f64, f64)> {
        let step = libm::pow(high / low, 1.0 / (steps - 1) as f64);
        let share = 1.0 / steps as f64;
        let rising = (0..steps).map(|k| (low * libm::pow(step, k as f64), share));
        std::iter::once((0.0, 1.0 / 3.0)).chain(rising).collect()
    };
    let mut points = Vec::new();
    let mut logs = Vec::new();
    for (walk, walk_prior) in grid(1e-4, 1e2, 22) {
        for (flicker, flicker_prior) in grid(1e-4, 1.0, 12) {
            let ratios = Ratios { walk, flicker };
            let (squares, log_determinant) = filter(rest, ratios);
            if squares.is_nan() || squares <= 0.0 {
                return None;
            }
            let dof = (rest.readings.len() - 1) as f64;
            let log = -0.5 * dof * libm::log(squares) - 0.5 * log_determinant;
            logs.push(log + libm::log(walk_prior * flicker_prior));
            points.push(Point {
                ratios,
                weight: 0.0,
                squares,
            });
        }
    }
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = logs.iter().map(|log| libm::exp(log - most)).sum();
    for (point, log) in points.iter_mut().zip(&logs) {
        point.weight = libm::exp(log - most) / total;
    }
    Some(points)
}

/// The Kalman filter: sum of squared innovations over their variances, and the sum of the logarithms of
/// these, in units of the white variance. The first reading fixes the level and tells nothing else.
fn filter(rest: &AtRest<'_>, ratios: Ratios) -> (f64, f64) {
    let (origin, first) = (rest.readings[0], rest.times[0]);
    let mut state = [0.0; STATES];
    // After a diffuse start and one reading: level = reading − rungs − white, so that the level is
    // correlated with the rungs.
    let mut covariance = [[0.0; STATES]; STATES];
    for (k, row) in covariance.iter_mut().enumerate().skip(1) {
        row[k] = ratios.flicker;
        row[0] = -ratios.flicker;
    }
    covariance[0] = [-ratios.flicker; STATES];
    covariance[0][0] = 1.0 + LADDER.len() as f64 * ratios.flicker;
    let (mut squares, mut logs) = (0.0, 0.0);
    let mut last = first;
    for (time, reading) in rest.times.iter().zip(rest.readings).skip(1) {
        let elapsed = time - last;
        last = *time;
        predict(&mut state, &mut covariance, ratios, elapsed);
        let gain: [f64; STATES] = covariance.map(|row| row.iter().sum());
        let variance = gain.iter().sum::<f64>() + 1.0;
        let innovation = reading - origin - state.iter().sum::<f64>();
        squares += innovation * innovation / variance;
        logs += libm::log(variance);
        for (value, g) in state.iter_mut().zip(gain) {
            *value += g * innovation / variance;
        }
        for (row, g) in covariance.iter_mut().zip(gain) {
            for (element, h) in row.iter_mut().zip(gain) {
                *element -= g * h / variance;
            }
        }
    }
    (squares, logs)
}

fn predict(
    state: &mut [f64; STATES],
    covariance: &mut [[f64; STATES]; STATES],
    ratios: Ratios,
    elapsed: f64,
) {
    let mut kept = [1.0; STATES];
    for (keep, memory) in kept[1..].iter_mut().zip(LADDER) {
        *keep = libm::exp(-elapsed / memory);
    }
    for (value, keep) in state.iter_mut().zip(kept) {
        *value *= keep;
    }
    for (row, a) in covariance.iter_mut().zip(kept) {
        for (element, b) in row.iter_mut().zip(kept) {
            *element *= a * b;
        }
    }
    covariance[0][0] += ratios.walk * elapsed;
    for (k, row) in covariance.iter_mut().enumerate().skip(1) {
        row[k] += ratios.flicker * (1.0 - kept[k] * kept[k]);
    }
}

/// The point at which the probabilities add up to `u`.
fn pick(points: &[Point], u: f64) -> Point {
    let mut left = u;
    let found = points.iter().find(|point| {
        left -= point.weight;
        left <= 0.0
    });
    *found.unwrap_or(&points[points.len() - 1])
}

/// Uniform random numbers.
struct Random {
    generator: Generator,
    block: Block,
    next: usize,
}

impl Random {
    fn new(seed: u64) -> Random {
        Random {
            generator: Generator::new(seed, 0, 0x7265_7374),
            block: Block::ZERO,
            next: LANES,
        }
    }

    fn uniform(&mut self) -> f64 {
        if self.next == LANES {
            self.generator.uniforms(level(), &mut self.block);
            self.next = 0;
        }
        self.next += 1;
        self.block.0[self.next - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_core::special::normal_quantile;
    use nalgebra::DVector;

    fn readings(count: usize, white: f64, walk: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
        let mut random = Random::new(seed);
        let mut level = 5.0;
        let step = 1.0 / 60.0;
        let mut normal = move || normal_quantile(random.uniform());
        let times: Vec<f64> = (0..count).map(|k| k as f64 * step).collect();
        let readings = times
            .iter()
            .map(|_| {
                level += walk * f64::sqrt(step) * normal();
                level + white * normal()
            })
            .collect();
        (times, readings)
    }

    #[test]
    fn the_filter_is_the_restricted_likelihood() {
        let (times, readings) = readings(25, 1.0, 2.0, 3);
        let ratios = Ratios {
            walk: 3.0,
            flicker: 0.2,
        };
        let rest = AtRest {
            times: &times,
            readings: &readings,
        };
        let (squares, logs) = filter(&rest, ratios);
        // Contrasts to the first reading, with their dense covariance.
        let counts = vec![1.0; times.len()];
        let all = Rows {
            times: &times,
            counts: &counts,
        };
        let sigma = covariance(&all, 1.0, ratios);
        let n = times.len();
        let contrast = DMatrix::from_fn(n - 1, n, |i, j| {
            f64::from(u8::from(j == i + 1)) - f64::from(u8::from(j == 0))
        });
        let d = &contrast * DVector::from_column_slice(&readings);
        let factor = (&contrast * sigma * contrast.transpose())
            .cholesky()
            .unwrap();
        assert!((d.dot(&factor.solve(&d)) - squares).abs() < 1e-9 * squares);
        let log_determinant: f64 = factor.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum();
        assert!((log_determinant - logs).abs() < 1e-9);
    }

    #[test]
    fn white_noise_and_a_walk_are_told_apart() {
        let mut mean = 0.0;
        for seed in 8..16 {
            let noise = walking(seed);
            assert!((noise.white - 1.0).abs() < 0.1, "{noise:?}");
            mean += noise.walk * noise.walk / 8.0;
        }
        // Of a level that walks by q = 1.5²/60 from reading to reading of σ² = 1 the Fisher information is, in a long recording,
        // n/2·(q + 2σ²)/(q² + 4qσ²)^(3/2) = 1.04e4: u(q)/q = 0.26 of one.
        let off = mean / 2.25 - 1.0;
        assert!(off.abs() < 4.0 * 0.26 / 8.0_f64.sqrt(), "{off}");
    }

    /// What is drawn scatters about its mean as the degrees of freedom let it.
    #[test]
    fn draws_are_about_their_mean() {
        let noise = walking(8);
        let of_first = noise.draws.iter().map(|draw| draw[(0, 0)]);
        let first: Vec<f64> = of_first.collect();
        assert_eq!(first.len(), 40);
        let mean = first.iter().sum::<f64>() / 40.0;
        let expected = noise.covariance[(0, 0)];
        let relative = (2.0_f64 / 599.0).sqrt();
        assert!(
            (mean / expected - 1.0).abs() < 4.0 * relative,
            "{mean} for {expected}"
        );
        let below = first.iter().filter(|x| **x < expected).count();
        // Of 40 that are as often below as above fewer than 8 are on one side in 0.01 %.
        assert!((8..=32).contains(&below), "{below}");
    }

    #[test]
    fn the_same_seed_draws_the_same() {
        assert_eq!(walking(8), walking(8));
    }

    /// What 600 readings of unit scatter, with a walk of 1.5, say.
    fn walking(seed: u64) -> RestNoise {
        let (times, readings) = readings(600, 1.0, 1.5, seed);
        let rest = AtRest {
            times: &times,
            readings: &readings,
        };
        let rows = Rows {
            times: &[0.5, 1.0, 2.0],
            counts: &[1.0; 3],
        };
        from_rest(&rest, &rows, 40, 1).expect("enough readings")
    }

    #[test]
    fn a_recording_without_a_walk_has_next_to_none() {
        let (times, readings) = readings(400, 2.0, 0.0, 8);
        let rest = AtRest {
            times: &times,
            readings: &readings,
        };
        let noise = from_rest(
            &rest,
            &Rows {
                times: &[0.0, 1.0],
                counts: &[1.0; 2],
            },
            10,
            1,
        )
        .unwrap();
        assert!((noise.white - 2.0).abs() < 0.2, "{noise:?}");
        // A walk of 0.5 per √h would already show over seven hours.
        assert!(noise.walk < 0.4, "{noise:?}");
    }

    #[test]
    fn readings_that_say_nothing_are_refused() {
        let times: Vec<f64> = (0..30).map(f64::from).collect();
        let same = vec![1.0; 30];
        assert!(
            from_rest(
                &AtRest {
                    times: &times,
                    readings: &same
                },
                &Rows {
                    times: &[0.0],
                    counts: &[1.0]
                },
                5,
                1
            )
            .is_none()
        );
        assert!(
            from_rest(
                &AtRest {
                    times: &times[..5],
                    readings: &same[..5]
                },
                &Rows {
                    times: &[0.0],
                    counts: &[1.0]
                },
                5,
                1
            )
            .is_none()
        );
    }
}
