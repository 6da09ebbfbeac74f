//! What a disturbance may follow, computed row by row along the recorded order.

use std::ops::Range;

use gumption_core::quantity::to_digits;

pub use crate::recording::values::{correlation, largest, levels_of, rounded};

/// Less the middle.
pub fn centred(x: &[f64]) -> Vec<f64> {
    let middle = middle(x);
    x.iter().map(|x| x - middle).collect()
}

/// The mean, rounded to a ten-thousandth of the range: formulas show the very number that is taken away.
pub fn middle(x: &[f64]) -> f64 {
    let (least, most) = range(x);
    rounded(mean(x), 1e-4 * (most - least))
}

/// Five digits of a number: formulas show the very number by which something is divided.
pub fn five_digits(x: f64) -> f64 {
    to_digits(x, 5)
}

/// Arithmetic mean.
pub fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len().max(1) as f64
}

/// Rows in succession that belong together, each to the one before it; no more than so many.
pub fn successive(
    rows: usize,
    most: usize,
    together: impl Fn(usize, usize) -> bool,
) -> Vec<Range<usize>> {
    in_succession(rows, |_| most, together)
}

/// The same with a limit that depends on the first of them.
pub fn in_succession(
    rows: usize,
    most: impl Fn(usize) -> usize,
    together: impl Fn(usize, usize) -> bool,
) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut room = 0;
    for row in 0..rows {
        match found.last_mut() {
            Some(own) if own.len() < room && together(row - 1, row) => own.end = row + 1,
            _ => {
                room = most(row);
                found.push(row..row + 1);
            }
        }
    }
    found
}

/// A course that is formed in each part of the rows between which the time does not go backwards: another recording begins where
/// it does, with a history of its own.
pub fn in_each(t: &[f64], of: impl Fn(Range<usize>) -> Vec<f64>) -> Vec<f64> {
    let recordings = successive(t.len(), t.len(), |before, row| t[before] <= t[row]);
    recordings.into_iter().flat_map(of).collect()
}

/// Rate of change, by differences over the neighbouring rows of the same recording.
pub fn rate(t: &[f64], x: &[f64]) -> Vec<f64> {
    in_each(t, |rows| rate_in_one(&t[rows.clone()], &x[rows]))
}

fn rate_in_one(t: &[f64], x: &[f64]) -> Vec<f64> {
    let last = x.len().saturating_sub(1);
    (0..x.len())
        .map(|row| {
            let (from, to) = (row.saturating_sub(1), (row + 1).min(last));
            known((x[to] - x[from]) / (t[to] - t[from]).max(0.0))
        })
        .collect()
}

/// The direction in which `x` moved last: +1 or −1; the first rows take that of the first movement, and so do those after the
/// time went backwards.
pub fn direction(t: &[f64], x: &[f64]) -> Vec<f64> {
    in_each(t, |rows| direction_in_one(&x[rows]))
}

fn direction_in_one(x: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    let mut now = 0.0;
    for row in 1..x.len() {
        let step = x[row] - x[row - 1];
        if step != 0.0 {
            if now == 0.0 {
                out[..row].fill(step.signum());
            }
            now = step.signum();
        }
        out[row] = now;
    }
    out
}

/// The same, where rows at rest take the direction of the movement that follows, if there is one.
pub fn onward(t: &[f64], x: &[f64]) -> Vec<f64> {
    in_each(t, |rows| {
        let x = &x[rows];
        let mut out = direction_in_one(x);
        for row in (1..x.len().saturating_sub(1)).rev() {
            if x[row] == x[row - 1] {
                out[row] = out[row + 1];
            }
        }
        out
    })
}

/// Where in its gap a play is in the first row, which no row before it tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// In the middle: at rest before.
    Middle,
    /// At the end: the first value was reached in the direction in which the values go on.
    Engaged,
    /// At the other end: it was reached in the other direction.
    Reversed,
}

impl Start {
    /// All of them.
    pub const ALL: [Start; 3] = [Start::Middle, Start::Engaged, Start::Reversed];

    /// What a label says of it.
    pub fn label(self) -> &'static str {
        match self {
            Start::Middle => "",
            Start::Engaged => "engaged at the start",
            Start::Reversed => "reversed at the start",
        }
    }
}

/// Play of width `w`: what follows `x` only when `x` reaches the end of the gap. It begins as `start` says, and anew
/// where the time goes backwards.
pub fn play(t: &[f64], x: &[f64], w: f64, start: Start) -> Vec<f64> {
    in_each(t, |rows| {
        let x = &x[rows];
        let way = direction_in_one(x)[0];
        let behind = match start {
            Start::Middle => 0.0,
            Start::Engaged => 0.5 * w * way,
            Start::Reversed => -0.5 * w * way,
        };
        play_from(x[0] - behind, x, &[], w)
    })
}

/// Play of width `w` that begins in the middle of its gap at a value; some rows were reached by way of
/// another value: `came` as in [`held_lag`].
pub fn play_from(start: f64, x: &[f64], came: &[Option<(f64, f64)>], w: f64) -> Vec<f64> {
    let by_way_of = |row: usize| came.get(row).copied().flatten().map(|(from, _)| from);
    let mut out = Vec::with_capacity(x.len());
    let mut now = start;
    for (row, value) in x.iter().enumerate() {
        for push in by_way_of(row).into_iter().chain([*value]) {
            now = now.max(push - w / 2.0).min(push + w / 2.0);
        }
        out.push(now);
    }
    out
}

/// A geometric series from `low` to `high`, by a factor of at least `ratio`, of at most `most` values.
pub fn grid(low: f64, high: f64, ratio: f64, most: usize) -> Vec<f64> {
    if !(low > 0.0 && high > low) {
        return Vec::from_iter((low > 0.0 && high == low).then_some(low));
    }
    let steps = (libm::log(high / low) / libm::log(ratio)).floor() as usize;
    let steps = steps.max(1).min(most.max(2) - 1);
    let factor = libm::pow(high / low, 1.0 / steps as f64);
    (0..=steps)
        .map(|step| low * libm::pow(factor, step as f64))
        .collect()
}

/// A number with its unit, which may be none.
pub fn amount(x: f64, unit: &str) -> String {
    in_unit(&written(x), unit)
}

/// What is written of a number, with its unit, which may be none.
pub fn in_unit(text: &str, unit: &str) -> String {
    format!("{text} {unit}").trim_end().to_owned()
}

/// A number with all its digits, by a power of ten where there would be many zeros.
fn written(x: f64) -> String {
    let size = x.abs();
    match size == 0.0 || (1e-4..1e9).contains(&size) {
        true => format!("{x}"),
        false => format!("{x:e}"),
    }
}

/// A number as formulas and labels show it: five digits.
pub fn figure(x: f64) -> String {
    written(five_digits(x))
}

/// A number as labels show it where steps count: five digits, or more where these do not tell steps apart.
pub fn figure_to(x: f64, step: f64) -> String {
    if (five_digits(x) - x).abs() <= 0.5 * step {
        return figure(x);
    }
    written(rounded(x, step))
}

/// The least and the largest number.
pub fn range(x: &[f64]) -> (f64, f64) {
    let least = x.iter().copied().fold(f64::INFINITY, f64::min);
    let most = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (least, most)
}

/// The median of those steps that go on; nothing where none does.
pub fn usual(steps: impl Iterator<Item = f64>) -> Option<f64> {
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied()
}

/// The usual difference of successive values; 0 where nothing moves.
pub fn typical_step(x: &[f64]) -> f64 {
    usual(x.windows(2).map(|pair| (pair[1] - pair[0]).abs())).unwrap_or(0.0)
}

/// The least distance of different values; infinite where all are the same.
pub fn spacing(x: &[f64]) -> f64 {
    let values = levels_of(x);
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    gaps.fold(f64::INFINITY, f64::min)
}

/// Whether a course moves by small steps, so that it has a rate of change; from dwell to dwell it has none.
pub fn creeps(x: &[f64]) -> bool {
    const SMALL: f64 = 0.15;
    let (least, most) = range(x);
    typical_step(x) < SMALL * (most - least)
}

/// The straight line from `x` to `y`, by its slope and its value at zero, and what it leaves of the variance of `y`; a `y`
/// without variance is followed by its own value.
pub fn line_through(x: &[f64], y: &[f64]) -> (f64, f64, f64) {
    let (mean_x, mean_y) = (mean(x), mean(y));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        xx += (x - mean_x) * (x - mean_x);
        xy += (x - mean_x) * (y - mean_y);
        yy += (y - mean_y) * (y - mean_y);
    }
    if !(yy > 0.0 && xx > 0.0) {
        return (0.0, mean_y, if yy > 0.0 { 1.0 } else { 0.0 });
    }
    let factor = xy / xx;
    (factor, mean_y - factor * mean_x, 1.0 - xy * xy / (xx * yy))
}

/// The mean of some courses, row by row.
pub fn mean_of(courses: &[Vec<f64>]) -> Vec<f64> {
    let sum = (courses.iter().cloned()).reduce(|sum, one| map2(&sum, &one, |sum, one| sum + one));
    map(&sum.unwrap_or_default(), |sum| sum / courses.len() as f64)
}

/// Element by element.
pub fn map2(x: &[f64], z: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    x.iter().zip(z).map(|(x, z)| f(*x, *z)).collect()
}

/// Element by element.
pub fn map(x: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    x.iter().map(|x| f(*x)).collect()
}

/// Nothing for what is not finite.
pub fn known(x: f64) -> f64 {
    if x.is_finite() { x } else { 0.0 }
}

/// 1 where something is so.
pub fn flag(is_so: bool) -> f64 {
    f64::from(u8::from(is_so))
}

/// Whether numbers go well to both sides of zero.
pub fn crosses_zero(x: &[f64]) -> bool {
    let (least, most) = range(x);
    least < 0.0 && most > 0.0 && (-least).min(most) > 0.1 * (-least).max(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn play_follows_behind_the_gap() {
        let x = [0.0, 1.0, 2.0, 1.5, 1.0, 0.0];
        let t = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let begun = |start: Start| play(&t, &x, 1.0, start);
        assert_eq!(begun(Start::Middle), [0.0, 0.5, 1.5, 1.5, 1.5, 0.5]);
        assert_eq!(begun(Start::Engaged), [-0.5, 0.5, 1.5, 1.5, 1.5, 0.5]);
        assert_eq!(begun(Start::Reversed), [0.5, 0.5, 1.5, 1.5, 1.5, 0.5]);
        assert_eq!(direction(&t, &x), [1.0, 1.0, 1.0, -1.0, -1.0, -1.0]);
        let again = [0.0, 1.0, 1.0, 0.0, 0.0];
        assert_eq!(direction(&t[..5], &again), [1.0, 1.0, 1.0, -1.0, -1.0]);
        assert_eq!(onward(&t[..5], &again), [1.0, 1.0, -1.0, -1.0, -1.0]);
    }

    #[test]
    fn another_recording_has_a_history_of_its_own() {
        let t = [0.0, 1.0, 2.0, 0.5, 1.5, 2.5];
        let x = [0.0, 2.0, 0.0, 0.0, 2.0, 0.0];
        let played = play(&t, &x, 1.0, Start::Engaged);
        for course in [played, direction(&t, &x), rate(&t, &x)] {
            assert_eq!(course[..3], course[3..]);
        }
    }

    #[test]
    fn numbers_of_formulas_are_short() {
        assert_eq!(middle(&[20.0, 21.0, 23.0]), 21.3333);
        assert_eq!(five_digits(2.500_001), 2.5);
        assert_eq!(figure_to(2.500_001, 1e-4), "2.5");
        assert_eq!(figure(6.000_1e-12), "6.0001e-12");
        assert_eq!(amount(-2e9, "Hz"), "-2e9 Hz");
        assert_eq!(amount(0.0, ""), "0");
        assert_eq!(figure_to(101_326.283_7, 1e-3), "101326.284");
    }

    #[test]
    fn grids_are_geometric() {
        let grid = grid(1.0, 16.0, 2.0, 12);
        assert_eq!(grid.len(), 5);
        assert!((grid[2] - 4.0).abs() < 1e-12);
        assert!(super::grid(1.0, 0.5, 2.0, 3).is_empty());
    }

    #[test]
    fn origin_and_unit_of_a_modifier_are_found() {
        let (factor, offset, left) = line_through(&[0.0, 1.0, 2.0], &[3.0, 5.0, 7.0]);
        assert!((factor - 2.0).abs() < 1e-12 && (offset - 3.0).abs() < 1e-12);
        assert!(left.abs() < 1e-12);
        assert!(line_through(&[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0]).2 > 0.5);
    }
}
