//! The functions of spreadsheets that budgets are computed with.

use gumption_core::special::{normal_quantile, student_t_quantile, student_t_two_sided_quantile};
use gumption_core::statistics::{mean_and_deviation, mean_and_squares, median};

/// The value of a function; nothing for one that is not known, or of other arguments than it takes.
pub(super) fn value(name: &str, x: &[f64]) -> Option<f64> {
    let sum = |of: fn(f64) -> f64| x.iter().copied().map(of).sum::<f64>();
    let count = x.len() as f64;
    let squares = || mean_and_squares(x).1;
    match (name, x) {
        ("PI", []) => Some(std::f64::consts::PI),
        ("SQRT", [x]) => Some(libm::sqrt(*x)),
        ("ABS", [x]) => Some(x.abs()),
        ("POWER", [x, exponent]) => Some(libm::pow(*x, *exponent)),
        ("ROUND", [x, places]) => Some(rounded(*x, *places, libm::round)),
        ("ROUNDUP", [x, places]) => Some(rounded(*x, *places, |x| libm::ceil(x.abs()).copysign(x))),
        ("ROUNDDOWN", [x, places]) => Some(rounded(*x, *places, libm::trunc)),
        // Of both sides, with whole degrees of freedom.
        ("TINV" | "T.INV.2T", [outside, nu]) => {
            let is_known = *outside > 0.0 && *outside < 1.0 && *nu >= 1.0;
            is_known.then(|| student_t_two_sided_quantile(1.0 - outside, libm::floor(*nu)))
        }
        // Below, with whole degrees of freedom.
        ("T.INV", [below, nu]) => {
            let is_known = *below > 0.0 && *below < 1.0 && *nu >= 1.0;
            is_known.then(|| student_t_quantile(*below, libm::floor(*nu)))
        }
        ("NORMSINV" | "NORM.S.INV", [below]) => standard_normal(*below),
        ("NORMINV" | "NORM.INV", [below, mean, deviation]) => {
            Some(mean + deviation * standard_normal(*below)?)
        }
        ("INT", [x]) => Some(libm::floor(*x)),
        ("TRUNC", [x]) => Some(libm::trunc(*x)),
        ("TRUNC", [x, places]) => Some(rounded(*x, *places, libm::trunc)),
        ("LN", [x]) => Some(libm::log(*x)),
        ("LOG10", [x]) => Some(libm::log10(*x)),
        ("EXP", [x]) => Some(libm::exp(*x)),
        ("SUM", _) => Some(sum(|x| x)),
        ("SUMSQ", _) => Some(sum(|x| x * x)),
        ("COUNT", _) => Some(count),
        ("AVERAGE", [_, ..]) => Some(sum(|x| x) / count),
        ("MAX", [first, rest @ ..]) => Some(rest.iter().copied().fold(*first, f64::max)),
        ("MIN", [first, rest @ ..]) => Some(rest.iter().copied().fold(*first, f64::min)),
        ("STDEV" | "STDEV.S", [_, _, ..]) => Some(mean_and_deviation(x).1),
        ("STDEVP" | "STDEV.P", [_, ..]) => Some(libm::sqrt(squares() / count)),
        ("VAR" | "VAR.S", [_, _, ..]) => Some(squares() / (count - 1.0)),
        ("VARP" | "VAR.P", [_, ..]) => Some(squares() / count),
        ("DEVSQ", [_, ..]) => Some(squares()),
        ("MEDIAN", [_, ..]) => Some(median(x.to_vec())),
        _ => None,
    }
}

fn standard_normal(below: f64) -> Option<f64> {
    let is_known = below > 0.0 && below < 1.0;
    is_known.then(|| normal_quantile(below))
}

/// To so many places, halves by what `to_whole` does with the figure that is shown: 2.675 is 2.68.
fn rounded(x: f64, places: f64, to_whole: impl Fn(f64) -> f64) -> f64 {
    /// A double has this part of a figure beyond its fifteen digits.
    const BEYOND: f64 = 1e-14;
    let scale = libm::exp10(libm::trunc(places));
    let shown = x * scale;
    let nearest = libm::round(2.0 * shown) / 2.0;
    let is_whole = (shown - nearest).abs() <= BEYOND * shown.abs();
    to_whole(if is_whole { nearest } else { shown }) / scale
}

#[cfg(test)]
mod tests {
    use super::value;

    #[test]
    fn functions_are_those_of_spreadsheets() {
        let of = |name: &str, x: &[f64]| value(name, x).unwrap_or(f64::NAN);
        assert_eq!(of("ROUND", &[0.012_345, 4.0]), 0.0123);
        assert_eq!(of("ROUND", &[2.675, 2.0]), 2.68);
        assert_eq!(of("ROUND", &[-2.5, 0.0]), -3.0);
        assert_eq!(of("ROUND", &[1234.0, -2.0]), 1200.0);
        assert_eq!(of("ROUNDUP", &[0.0121, 3.0]), 0.013);
        assert_eq!(of("ROUNDUP", &[-1.1, 0.0]), -2.0);
        assert_eq!(of("ROUNDUP", &[1.1, 1.0]), 1.1);
        assert_eq!(of("ROUNDDOWN", &[0.0129, 3.0]), 0.012);
        assert_eq!(of("AVERAGE", &[1.0, 2.0, 6.0]), 3.0);
        assert_eq!(of("MAX", &[1.0, 3.0]) - of("MIN", &[1.0, 3.0]), 2.0);
        // JCGM 100, table G.2: t₉₅(10) = 2.23.
        assert!((of("T.INV.2T", &[0.05, 10.9]) - 2.228_139).abs() < 1e-6);
        assert!((of("STDEV.S", &[1.0, 2.0, 3.0]) - 1.0).abs() < 1e-15);
        assert!((of("T.INV", &[0.975, 10.0]) - 2.228_139).abs() < 1e-6);
        assert!((of("T.INV", &[0.025, 10.0]) + 2.228_139).abs() < 1e-6);
        assert!((of("NORMSINV", &[0.975]) - 1.959_964).abs() < 1e-6);
        assert!((of("NORM.INV", &[0.025, 1.0, 2.0]) + 2.919_928).abs() < 1e-6);
        assert_eq!([of("INT", &[40.1]), of("INT", &[-0.5])], [40.0, -1.0]);
        assert!((of("STDEVP", &[1.0, 2.0, 3.0]) - 0.816_496_6).abs() < 1e-6);
        assert_eq!(of("MEDIAN", &[5.0, 1.0, 2.0, 4.0]), 3.0);
        for strange in [[0.05, 0.5], [2.0, 10.0], [f64::NAN, f64::NAN]] {
            assert!(value("TINV", &strange).is_none());
        }
        assert!(value("STDEV", &[1.0]).is_none() && value("LOOKUP", &[1.0]).is_none());
    }
}
