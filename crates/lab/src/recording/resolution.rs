//! The resolution of readings, as they show it themselves: the equal steps in which a display or a converter gives them.

use super::values::{largest, levels_of, rounded};

/// Equal steps in which readings come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// From one reading that is possible to the next.
    pub step: f64,
    /// One of the readings that are possible; zero where zero is.
    pub origin: f64,
}

/// The standard uncertainty of rounding to a step: that of a rectangular distribution of this width (GUM, F.2.2.1).
pub fn u_of_step(step: f64) -> f64 {
    step / 12f64.sqrt()
}

/// The coarsest steps in which readings come: those that they show, else the last decimal place of any. `None` where there are no
/// readings, or they have all digits of a double.
pub fn resolution(readings: &[f64]) -> Option<f64> {
    let known: Vec<f64> = readings.iter().copied().filter(|x| x.is_finite()).collect();
    let of_file = || digit(&levels_of(&known)).filter(|_| !known.is_empty());
    steps(&known).map(|steps| steps.step).or_else(of_file)
}

/// The equal steps in which readings come, if they are coarse. The file may round the readings once more, to its digits.
pub fn steps(readings: &[f64]) -> Option<Steps> {
    /// Probability that readings lie on equal steps by chance, at most.
    const CHANCE: f64 = 1e-3;
    /// Where the digits of the file are the steps: the share of the readings that are different from all others, at most.
    const ALIKE: f64 = 0.7;
    // Rows that are still to be recorded have none.
    let readings: Vec<f64> = (readings.iter().copied())
        .filter(|x| x.is_finite())
        .collect();
    let values = levels_of(&readings);
    if values.len() < 3 {
        return None;
    }
    let digit = digit(&values)?;
    let Largest { step, tried, held } = largest_step(&values, digit)?;
    let by_chance = tried as f64 * libm::pow(held, (values.len() - 2) as f64);
    let again = values.len() as f64 <= ALIKE * readings.len() as f64;
    (by_chance <= CHANCE || again).then(|| from_origin(step, &values, digit))
}

/// Steps that are stated, with one of the readings that are possible.
pub fn stated_steps(step: f64, readings: &[f64]) -> Steps {
    let readings: Vec<f64> = (readings.iter().copied())
        .filter(|x| x.is_finite())
        .collect();
    let values = levels_of(&readings);
    from_origin(step, &values, digit(&values).unwrap_or(0.0))
}

fn from_origin(step: f64, values: &[f64], digit: f64) -> Steps {
    let from_zero = |x: &f64| (x - (x / step).round() * step).abs() <= digit;
    let first = values.first().copied().unwrap_or(0.0);
    let origin = match values.iter().all(from_zero) {
        true => 0.0,
        false => first,
    };
    Steps { step, origin }
}

/// Steps that are followed up at most: of more than these, some fit anything.
const POSSIBLE: usize = 10_000;

/// The unit of the last decimal place of numbers.
fn digit(values: &[f64]) -> Option<f64> {
    /// A double has no more.
    const PLACES: i32 = 15;
    let size = largest(values);
    let is_whole = |place: &i32| {
        let times = libm::pow(10.0, f64::from(*place));
        // What is left of a number of 53 bits.
        let rounding = 4.0 * f64::EPSILON * size * times;
        let is_whole = |x: &f64| (x * times - (x * times).round()).abs() <= rounding;
        rounding < 0.01 && values.iter().all(is_whole)
    };
    let place = (-PLACES..=PLACES).find(is_whole)?;
    Some(libm::pow(10.0, f64::from(-place)))
}

/// The largest step of which all distances of values are multiples.
struct Largest {
    step: f64,
    /// How many were possible on the way to it.
    tried: usize,
    /// Of the readings that the file can hold, the share that lies on such steps.
    held: f64,
}

/// The largest step of which all distances of ascending values are multiples, each value rounded to a digit.
fn largest_step(values: &[f64], digit: f64) -> Option<Largest> {
    let digits = |x: f64| (x / digit).round() as i64;
    let steps = values
        .windows(2)
        .map(|pair| digits(pair[1]) - digits(pair[0]));
    let exact = steps.fold(0, common);
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let least = gaps.clone().fold(f64::INFINITY, f64::min);
    // A step of few digits is meant where it is possible; steps of less than two digits show as those of the file.
    if exact > 1 || digits(least) <= 2 {
        // A quotient of whole numbers is a decimal number as it is written.
        let step = match digit < 1.0 {
            true => exact as f64 / (1.0 / digit).round(),
            false => exact as f64 * digit,
        };
        let held = digit / step;
        return Some(Largest {
            step,
            tried: 1,
            held,
        });
    }
    // A bound is met by rounding as well.
    let slack = digit * (1.0 + 1e-6);
    let mut distances: Vec<f64> = gaps.chain(values.iter().map(|x| x - values[0])).collect();
    distances.retain(|far| *far > 0.0);
    distances.sort_by(f64::total_cmp);
    // A distance of many steps may be one more or less, so long as the step is not known better: each number of them leaves
    // an interval for the step.
    let (mut possible, mut tried) = (vec![(least - slack, least + slack)], 1);
    for far in distances {
        let held = |(low, high): &(f64, f64)| {
            let (low, high) = (*low, *high);
            let first = ((far - slack) / high).ceil().max(1.0);
            let last = ((far + slack) / low).floor();
            let numbers = (0..).map(move |more| first + f64::from(more));
            let numbers = numbers.take_while(move |times| *times <= last);
            numbers.map(move |times| {
                let (from, to) = ((far - slack) / times, (far + slack) / times);
                (low.max(from), high.min(to))
            })
        };
        possible = possible.iter().flat_map(held).take(POSSIBLE + 1).collect();
        tried = tried.max(possible.len());
        if possible.len() > POSSIBLE {
            return None;
        }
    }
    let (low, high) = possible.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let step = rounded(0.5 * (low + high), high - low);
    // Next to a step, on either side.
    let held = (2.0 * digit / step).min(1.0);
    Some(Largest { step, tried, held })
}

/// The largest whole number that divides both; zero is divided by all.
fn common(a: i64, b: i64) -> i64 {
    match b {
        0 => a.abs(),
        _ => common(b, a % b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_display_has_a_step() {
        let course: Vec<f64> = (0..60).map(|k| f64::from(k) * 0.013).collect();
        let shown = |step: f64, digit: f64, x: f64| {
            let shown = (x / step).round() * step;
            (shown / digit).round() * digit
        };
        let of =
            |step, digit| -> Vec<f64> { course.iter().map(|x| shown(step, digit, *x)).collect() };
        let found = steps(&of(0.05, 0.01)).unwrap();
        assert!((found.step - 0.05).abs() < 1e-9 && found.origin == 0.0);
        // A step of many digits, in a file of few.
        let found = steps(&of(0.023_47, 1e-3)).unwrap();
        assert!((found.step - 0.023_47).abs() < 1e-4, "{found:?}");
        // Few set points, hundreds of steps from one to the next, and an origin of its own.
        let noise = |k: usize| 0.0125 * libm::sin(7.3 * k as f64);
        let reading = |k: usize| 0.4047 + 14.237 * (k % 8) as f64 + noise(k);
        let far: Vec<f64> = (0..45)
            .map(|k| (((reading(k) / 0.012_692).round() * 0.012_692 + 0.005) / 1e-4).round() * 1e-4)
            .collect();
        let found = steps(&far).unwrap();
        assert!((found.step - 0.012_692).abs() < 1e-7, "{found:?}");
        let fine: Vec<f64> = course.iter().map(|x| libm::sin(37.0 * x)).collect();
        assert_eq!(steps(&fine), None);
        let digits: Vec<f64> = fine.iter().map(|x| (x * 1e5).round() / 1e5).collect();
        assert_eq!(steps(&digits), None);
    }
}
