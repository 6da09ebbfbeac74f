//! What a column was a time before, between the rows of its recording.

use super::modifiers::{in_each, known};

/// The course a time `delay` earlier, along straight lines between the rows; where the recording had not
/// begun, or is over, along the line of its ends.
pub fn delayed(t: &[f64], x: &[f64], delay: f64) -> Vec<f64> {
    in_each(t, |rows| {
        let (t, x) = (&t[rows.clone()], &x[rows]);
        earlier(t, x, delay, |above, part| between(x, above, part))
    })
}

/// As [`delayed`], along the natural cubic spline through the rows: between those of a course without corners it is off by the fourth
/// power of the interval instead of its square.
pub fn smoothly_delayed(t: &[f64], x: &[f64], delay: f64) -> Vec<f64> {
    in_each(t, |rows| {
        let (t, x) = (&t[rows.clone()], &x[rows]);
        let bends = steeper(t, x);
        earlier(t, x, delay, |above, part| {
            let line = between(x, above, part);
            let Some([first, last]) = bends.get(above - 1).filter(|_| (0.0..=1.0).contains(&part))
            else {
                return line;
            };
            // Hermite's cubic, as what it adds to the line.
            line + part * (1.0 - part) * ((1.0 - part) * first - part * last)
        })
    })
}

/// By how much the natural cubic spline through rows is steeper than the straight line at both ends of each interval, times the
/// interval; nothing where rows have the same time.
pub fn steeper(t: &[f64], x: &[f64]) -> Vec<[f64; 2]> {
    let Some(slopes) = spline(t, x) else {
        return Vec::new();
    };
    let intervals = 0..x.len() - 1;
    let of = |row: usize| {
        let (step, rise) = (t[row + 1] - t[row], x[row + 1] - x[row]);
        [slopes[row], slopes[row + 1]].map(|slope| slope * step - rise)
    };
    intervals.map(of).collect()
}

/// Whether a course without corners is nearer to the rows than straight lines, each by its neighbours: a row is to the next but one as
/// what is between two rows is to them.
pub fn is_smooth(t: &[f64], x: &[f64]) -> bool {
    let (mut lines, mut cubics) = (0.0, 0.0);
    for (t, x) in t.windows(7).zip(x.windows(7)) {
        // Not squared: a corner is one row that lines miss by more.
        let off = |rows: &[usize]| known((x[3] - interpolated(t, x, rows, t[3])).abs());
        lines += off(&[2, 4]);
        cubics += off(&[0, 2, 4, 6]);
    }
    cubics < lines
}

/// Lagrange's polynomial through some rows at a moment.
fn interpolated(t: &[f64], x: &[f64], rows: &[usize], at: f64) -> f64 {
    let weight = |row: usize| -> f64 {
        let others = rows.iter().filter(|other| **other != row);
        others
            .map(|other| (at - t[*other]) / (t[row] - t[*other]))
            .product()
    };
    rows.iter().map(|row| weight(*row) * x[*row]).sum()
}

/// The course earlier by a time, from the row after each moment and the part of the interval before it.
fn earlier(t: &[f64], x: &[f64], delay: f64, value: impl Fn(usize, f64) -> f64) -> Vec<f64> {
    if t.len() < 2 {
        return x.to_vec();
    }
    let at = |then: f64| {
        let above = t.partition_point(|t| *t <= then).max(1).min(t.len() - 1);
        let step = t[above] - t[above - 1];
        if step <= 0.0 {
            return x[above];
        }
        value(above, (then - t[above - 1]) / step)
    };
    t.iter().map(|t| at(t - delay)).collect()
}

/// On the line from the row before one to it.
fn between(x: &[f64], above: usize, part: f64) -> f64 {
    x[above - 1] + (x[above] - x[above - 1]) * part
}

/// The slopes of the natural cubic spline in its rows, by the equations that its second derivative is the same on both sides of
/// each; `None` where rows have the same time.
fn spline(t: &[f64], x: &[f64]) -> Option<Vec<f64>> {
    let last = x.len().checked_sub(1)?;
    let steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if last == 0 || !steps.iter().all(|step| *step > 0.0) {
        return None;
    }
    let rise = |row: usize| (x[row + 1] - x[row]) / steps[row];
    // Each row as before·s₋ + 2·(before + after)·s + after·s₊ = right, with the intervals on the other sides.
    let equation = |row: usize| match row {
        0 => (0.0, 2.0, 1.0, 3.0 * rise(0)),
        _ if row == last => (1.0, 2.0, 0.0, 3.0 * rise(last - 1)),
        _ => {
            let (before, after) = (steps[row - 1], steps[row]);
            let right = 3.0 * (after * rise(row - 1) + before * rise(row));
            (after, 2.0 * (before + after), before, right)
        }
    };
    let mut slopes = vec![0.0; x.len()];
    let mut above = vec![0.0; x.len()];
    for row in 0..=last {
        let (lower, own, upper, right) = equation(row);
        let [factor, known] = match row.checked_sub(1) {
            Some(before) => [above[before], slopes[before]],
            None => [0.0; 2],
        };
        let pivot = own - lower * factor;
        above[row] = upper / pivot;
        slopes[row] = (right - lower * known) / pivot;
    }
    for row in (0..last).rev() {
        slopes[row] -= above[row] * slopes[row + 1];
    }
    Some(slopes)
}

#[cfg(test)]
mod tests {
    use super::super::modifiers::{largest, map, map2};
    use super::*;

    #[test]
    fn a_delayed_course_is_what_was() {
        let t = [0.0, 1.0, 2.0, 4.0];
        let x = [0.0, 1.0, 4.0, 0.0];
        assert_eq!(delayed(&t, &x, 1.0), [-1.0, 0.0, 1.0, 2.0]);
        assert_eq!(delayed(&t, &x, -1.0), [1.0, 4.0, 2.0, -2.0]);
    }

    #[test]
    fn a_smooth_course_is_delayed_along_its_bends() {
        // Of unequal intervals.
        let moment = |row: i32| f64::from(row) + 0.2 * libm::sin(f64::from(row));
        let t: Vec<f64> = (0..60).map(moment).collect();
        let line = map(&t, |t| 3.0 * t - 1.0);
        for (then, now) in smoothly_delayed(&t, &line, 0.6).iter().zip(&line) {
            assert!((now - then - 1.8).abs() < 1e-9);
        }
        let wave = map(&t, |t| libm::sin(0.5 * t));
        let furthest = |then: Vec<f64>| {
            let rest = map2(&t, &then, |t, then| then - libm::sin(0.5 * (t - 0.6)));
            // A natural spline bends too little at its ends.
            largest(&rest[6..54])
        };
        let [lines, cubics] = [delayed, smoothly_delayed].map(|by| furthest(by(&t, &wave, 0.6)));
        assert!(cubics < 0.05 * lines, "{cubics} {lines}");
        let corners = map(&t, |t| (t % 10.0 - 5.0).abs());
        assert!(is_smooth(&t, &wave) && !is_smooth(&t, &corners));
    }

    #[test]
    fn another_recording_has_a_history_of_its_own() {
        let t = [0.0, 1.0, 2.0, 0.5, 1.5, 2.5];
        let x = [0.0, 2.0, 0.0, 0.0, 2.0, 0.0];
        for law in [delayed, smoothly_delayed] {
            let late = law(&t, &x, 0.5);
            assert_eq!(late[..3], late[3..]);
        }
    }
}
