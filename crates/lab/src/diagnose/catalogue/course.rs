//! How what is recorded row by row moves between the rows, and what lags behind it.

use super::earlier::{is_smooth, steeper};
use super::modifiers::{creeps, in_each, levels_of};

/// How what is recorded row by row moves between the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    /// Along the straight line.
    Steady,
    /// Along the bends of a course without corners.
    Smooth,
    /// At once, to the next value, where it stays.
    Dwelling,
}

impl Course {
    /// What may be, the more likely first. Steps of a good part of the range are from set point to set point. So may small
    /// ones be where most rows have a value that others have too: a ramp in round numbers looks like a list of set points.
    pub fn possible(t: &[f64], x: &[f64]) -> Vec<Course> {
        if !creeps(x) {
            return vec![Course::Dwelling];
        }
        let moving = match is_smooth(t, x) {
            true => Course::Smooth,
            false => Course::Steady,
        };
        let may_dwell = 2 * levels_of(x).len() <= x.len();
        std::iter::once(moving)
            .chain(may_dwell.then_some(Course::Dwelling))
            .collect()
    }

    /// First-order lag behind it; `came` as in [`held_lag`].
    pub fn late(self, t: &[f64], x: &[f64], came: &[Option<(f64, f64)>], tau: f64) -> Vec<f64> {
        match self {
            Course::Steady => in_each(t, |rows| {
                moving_lag(&t[rows.clone()], &x[rows], tau, |_| [0.0; 2])
            }),
            Course::Smooth => in_each(t, |rows| {
                let (t, x) = (&t[rows.clone()], &x[rows]);
                let bends = steeper(t, x);
                moving_lag(t, x, tau, |row| bends.get(row).copied().unwrap_or_default())
            }),
            Course::Dwelling => held_lag(t, x, came, tau),
        }
    }
}

/// First-order lag behind the likelier course.
pub fn late(t: &[f64], x: &[f64], came: &[Option<(f64, f64)>], tau: f64) -> Vec<f64> {
    Course::possible(t, x)[0].late(t, x, came, tau)
}

/// What a body with time constant `tau` has of a course that moves between the rows of one recording: along straight lines and what
/// Hermite's cubic adds to them, by how much it is steeper than the line at both ends of the interval after a row. It begins in balance.
fn moving_lag(t: &[f64], x: &[f64], tau: f64, steeper: impl Fn(usize) -> [f64; 2]) -> Vec<f64> {
    let mut out: Vec<f64> = x.first().copied().into_iter().collect();
    for (before, pair) in t.windows(2).enumerate() {
        let intervals = (pair[1] - pair[0]) / tau;
        let [level, rise, square, cube] = taken_in(intervals);
        let [at_first, at_last] = steeper(before);
        let bend = at_first * (rise - 2.0 * square + cube) - at_last * (square - cube);
        let line = level * x[before] + rise * (x[before + 1] - x[before]);
        out.push((1.0 - level) * out[before] + line + bend);
    }
    out
}

/// First-order lag of a course that moves from dwell to dwell: each value is taken on at once, and held. It
/// begins in balance. Where `came` says from which value a row was reached, and how long before, the course
/// was there since the row before.
fn held_lag(t: &[f64], x: &[f64], came: &[Option<(f64, f64)>], tau: f64) -> Vec<f64> {
    let mut out: Vec<f64> = Vec::with_capacity(x.len());
    let towards = |value: f64, before: f64, time: f64| {
        value + (before - value) * libm::exp(-time.max(0.0) / tau)
    };
    for row in 0..x.len() {
        let before = out.last().copied();
        let gap = if row == 0 { 0.0 } else { t[row] - t[row - 1] };
        out.push(match (came.get(row).copied().flatten(), before) {
            (Some((from, since)), Some(before)) => {
                towards(x[row], towards(from, before, gap - since), since)
            }
            (Some((from, since)), None) => towards(x[row], from, since),
            (None, Some(before)) if gap >= 0.0 => towards(x[row], before, gap),
            (None, _) => x[row],
        });
    }
    out
}

/// What a first-order lag takes in of the powers 1, u, u², u³ of the part of an interval that has passed, the interval in units of its
/// time constant: z∫exp(−z(1 − u))uᵏdu over 0 … 1.
fn taken_in(z: f64) -> [f64; 4] {
    /// Below it the recursion upwards loses more digits than the series has terms.
    const SHORT: f64 = 3.0;
    let level = -libm::expm1(-z);
    // By parts: Jₖ = 1 − (k/z)·Jₖ₋₁.
    if z > SHORT {
        let rise = 1.0 - level / z;
        let square = 1.0 - 2.0 / z * rise;
        return [level, rise, square, 1.0 - 3.0 / z * square];
    }
    // J₃ = Σ −(−z)ʲ·3!/(3 + j)!, j = 1 …, and downwards.
    let mut term = -1.0;
    let mut cube = 0.0;
    for j in 1..40 {
        term *= -z / f64::from(3 + j);
        cube += term;
    }
    let square = z / 3.0 * (1.0 - cube);
    [level, z / 2.0 * (1.0 - square), square, cube]
}

#[cfg(test)]
mod tests {
    use super::super::modifiers::map;
    use super::*;

    fn seconds(rows: u32) -> Vec<f64> {
        (0..rows).map(f64::from).collect()
    }

    #[test]
    fn set_points_in_small_steps_may_be_a_ramp_and_a_ramp_of_measured_values_is_no_list_of_set_points()
     {
        let t = seconds(40);
        let list = map(&t, |row| row % 10.0);
        let [ramp, bends] = [0.0, 1.0].map(|bend| {
            let off = |row: f64| 1e-3 * libm::sin(row * row) + bend * libm::sin(0.2 * row);
            map(&t, |row| row + off(row))
        });
        let possible = |x: &[f64]| Course::possible(&t, x);
        assert_eq!(possible(&list), [Course::Steady, Course::Dwelling]);
        assert_eq!(possible(&ramp), [Course::Steady]);
        assert_eq!(possible(&bends), [Course::Smooth]);
        let steps = [0.0, 5.0, 10.0, 5.0, 0.0];
        assert_eq!(Course::possible(&t[..5], &steps), [Course::Dwelling]);
    }

    #[test]
    fn a_ramp_is_late_by_the_time_constant() {
        let t = map(&seconds(400), |i| 0.1 * i);
        for course in [Course::Steady, Course::Smooth] {
            for tau in [1e-6, 0.02, 0.05, 2.0] {
                let lagged = course.late(&t, &t, &[], tau);
                assert!((lagged[399] - (t[399] - tau)).abs() < 1e-6, "{tau}");
            }
        }
    }

    /// A sine wave of angular frequency ω is behind by the phase arctan ωτ and smaller by cos of it.
    #[test]
    fn a_wave_is_late_by_its_phase() {
        let rate = 0.7;
        let (t, wave) = (seconds(600), |t: f64| libm::sin(rate * t));
        let x = map(&t, wave);
        for tau in [0.2, 0.34, 3.0, 20.0] {
            let phase = libm::atan(rate * tau);
            let furthest = |course: Course| {
                let late = course.late(&t, &x, &[], tau);
                let rows = late.iter().zip(&t).skip(400).take(190);
                let off = rows.map(|(late, t)| late - libm::cos(phase) * wave(t - phase / rate));
                off.fold(0.0, |most: f64, off| most.max(off.abs()))
            };
            let [lines, cubics] = [Course::Steady, Course::Smooth].map(furthest);
            assert!(cubics < 1e-3 && cubics < 0.1 * lines, "{lines} {cubics}");
        }
    }

    /// ∫ by Simpson's rule.
    #[test]
    fn powers_are_taken_in_as_integrals_say() {
        for z in [1e-9, 0.3, 2.9, 3.1, 40.0] {
            for (power, found) in taken_in(z).into_iter().enumerate() {
                let height = |u: f64| z * libm::exp(z * (u - 1.0)) * u.powi(power as i32);
                let parts = 2000;
                let step = 1.0 / f64::from(parts);
                let sum: f64 = (0..=parts)
                    .map(|at| {
                        let weight = match at {
                            0 => 1.0,
                            _ if at == parts => 1.0,
                            _ => f64::from(2 + 2 * (at % 2)),
                        };
                        weight * height(f64::from(at) * step)
                    })
                    .sum();
                let whole = sum * step / 3.0;
                assert!((found / whole - 1.0).abs() < 1e-7, "{z} {power}");
            }
        }
    }

    #[test]
    fn a_step_that_is_held_decays() {
        let lagged = held_lag(&[0.0, 1.0, 3.0], &[0.0, 1.0, 1.0], &[], 2.0);
        assert!((lagged[1] - (1.0 - libm::exp(-0.5))).abs() < 1e-12);
        assert!((lagged[2] - (1.0 - libm::exp(-1.5))).abs() < 1e-12);
        // The first value was reached from 3, one unit of time before.
        let came = held_lag(&[0.0, 1.0], &[2.0, 2.0], &[Some((3.0, 1.0)), None], 2.0);
        assert!((came[0] - (2.0 + libm::exp(-0.5))).abs() < 1e-12);
        assert!((came[1] - (2.0 + libm::exp(-1.0))).abs() < 1e-12);
    }
}
