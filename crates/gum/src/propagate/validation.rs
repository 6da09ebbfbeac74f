//! Validation of the GUM result by Monte Carlo (JCGM 101:2008, clause 8), and the numerical
//! tolerance that it and the adaptive procedures use (7.9.2).

use super::result::{Clause8, Gum, MonteCarlo, Validation};

/// A difference is known to so many standard errors of the Monte Carlo ends.
const ERRORS: f64 = 2.0;

/// JCGM 101 8.2: a run for validation is stable to this part of δ.
const STABLE: f64 = 0.2;

/// δ = ½·10^l for u = c·10^l, c a whole number of `digits` digits (JCGM 101 7.9.2).
///
/// c is u rounded, so that 9.96 with two digits is 10·10⁰ and not 99·10⁻¹. Zero when u is zero
/// or not finite: then no difference can be called negligible.
pub(crate) fn numerical_tolerance(u: f64, digits: u8) -> f64 {
    if !(u.is_finite() && u > 0.0) {
        return 0.0;
    }
    tolerance_between_decades(u, digits).unwrap_or_else(|| tolerance_as_written(u, digits))
}

fn tolerance_as_written(u: f64, digits: u8) -> f64 {
    let decimals = usize::from(digits.max(1)) - 1;
    // The standard library rounds the exact binary value, which no logarithm does.
    let scientific = format!("{u:.decimals$e}");
    let exponent: i32 = scientific
        .split_once('e')
        .and_then(|(_, e)| e.parse().ok())
        .unwrap_or_default();
    format!("5e{}", exponent - digits.max(1) as i32)
        .parse()
        .unwrap_or_default()
}

/// The same where u is far from a power of ten, to which no rounding leads, and all powers are exact.
fn tolerance_between_decades(u: f64, digits: u8) -> Option<f64> {
    /// 10²² is the last power of ten that is a double.
    const EXACT: i32 = 22;
    let ten = |exponent: i32| (0..exponent).fold(1.0, |power, _| power * 10.0);
    let exponent = libm::log10(u).floor() as i32;
    let last = exponent - i32::from(digits.max(1));
    if exponent.abs() > EXACT || last.abs() > EXACT {
        return None;
    }
    let leading = match exponent < 0 {
        true => u * ten(-exponent),
        false => u / ten(exponent),
    };
    // One digit rounds 9.5 to 10.
    if !(1.001..9.4).contains(&leading) {
        return None;
    }
    Some(match last < 0 {
        true => 5.0 / ten(-last),
        false => 5.0 * ten(last),
    })
}

/// Compares the ends of y ± U_p with the probabilistically symmetric Monte Carlo interval, for two
/// and for one significant digit of u(y).
///
/// u(y) is that of the GUM; where it is zero, as with a vanishing sensitivity, that of Monte Carlo,
/// since nothing would be compared otherwise.
pub(crate) fn validate(gum: &Gum, mc: &MonteCarlo) -> [Validation; 2] {
    let half_width = gum.coverage.half_width_for_p;
    let d_low = (gum.estimate - half_width - mc.symmetric[0]).abs();
    let d_high = (gum.estimate + half_width - mc.symmetric[1]).abs();
    let u = if gum.u > 0.0 {
        gum.u
    } else {
        mc.u.unwrap_or(0.0)
    };
    // Where the errors are not known, the differences are taken as they are.
    let [error_low, error_high] = [2, 3].map(|end: usize| {
        Some(mc.standard_errors[end])
            .filter(|e| e.is_finite())
            .unwrap_or(0.0)
    });
    [2, 1].map(|digits| {
        let delta = numerical_tolerance(u, digits);
        let verdict = match [end(d_low, error_low, delta), end(d_high, error_high, delta)] {
            [Clause8::NotValidated, _] | [_, Clause8::NotValidated] => Clause8::NotValidated,
            [Clause8::Validated, Clause8::Validated] => Clause8::Validated,
            _ => Clause8::Undecided,
        };
        Validation {
            digits,
            delta,
            d_low,
            d_high,
            error: error_low.max(error_high),
            verdict,
        }
    })
}

/// Whether y or u of the GUM differ from those of Monte Carlo by more than δ, beyond what trials scatter.
pub(crate) fn refutes_moments(gum: &Gum, mc: &MonteCarlo, delta: f64) -> bool {
    let [of_estimate, of_u, ..] = mc.standard_errors;
    let pairs = [
        (mc.estimate, gum.estimate, of_estimate),
        (mc.u, gum.u, of_u),
    ];
    pairs.into_iter().any(|(found, figure, error)| {
        let difference = found.map(|found| (found - figure).abs());
        // An error that is not known refutes nothing.
        let error = if error.is_finite() {
            error
        } else {
            f64::INFINITY
        };
        difference.is_some_and(|d| end(d, error, delta) == Clause8::NotValidated)
    })
}

/// The verdict about one figure, as an end of an interval.
fn end(difference: f64, error: f64, delta: f64) -> Clause8 {
    let doubt = ERRORS * error;
    if difference + doubt <= delta {
        Clause8::Validated
    } else if difference - doubt <= delta && doubt > 0.0 {
        Clause8::Undecided
    } else {
        Clause8::NotValidated
    }
}

/// About how many trials in place of `trials` would make the ends stable enough for the verdict.
pub(crate) fn trials_needed(of: &Validation, trials: u64) -> u64 {
    let times = (ERRORS * of.error / (STABLE * of.delta)).powi(2).max(2.0);
    let needed = trials as f64 * times;
    // Rounded up to one digit: an order of magnitude is all that is meant.
    let scale = libm::pow(10.0, libm::log10(needed).floor());
    ((needed / scale).ceil() * scale) as u64
}

/// The verdict at the digits that are reported.
pub(crate) fn at(both: &[Validation; 2], digits: u8) -> &Validation {
    let [two, one] = both;
    if digits < 2 { one } else { two }
}

#[cfg(test)]
mod tests {
    use super::super::Histogram;
    use super::super::draft::gum;
    use super::*;

    fn monte_carlo(u: Option<f64>, symmetric: [f64; 2]) -> MonteCarlo {
        MonteCarlo {
            estimate: Some(0.0),
            u,
            median: 0.0,
            symmetric,
            shortest: symmetric,
            skewness: None,
            excess_kurtosis: None,
            standard_errors: [0.0; 4],
            failed: 0,
            histogram: Histogram {
                start: 0.0,
                width: 0.0,
                counts: Vec::new(),
            },
        }
    }

    #[test]
    fn tolerances_of_jcgm_101_7_9_2() {
        assert_eq!(numerical_tolerance(0.35, 2), 0.005);
        for exponent in -30..30 {
            for leading in [
                1.0, 1.000_5, 1.5, 2.0, 7.3, 9.39, 9.45, 9.5, 9.94, 9.95, 9.96, 9.999,
            ] {
                let u: f64 = format!("{leading}e{exponent}").parse().expect("a number");
                for digits in [1, 2, 3] {
                    let written = tolerance_as_written(u, digits);
                    assert_eq!(numerical_tolerance(u, digits), written, "{u:e}, {digits}");
                }
            }
        }
        assert_eq!(numerical_tolerance(0.4, 1), 0.05);
        assert_eq!(numerical_tolerance(2.0, 1), 0.5);
        assert_eq!(numerical_tolerance(0.053_85, 1), 0.005);
        assert_eq!(numerical_tolerance(31.78, 2), 0.5);
    }

    #[test]
    fn rounding_may_carry_into_the_next_power() {
        assert_eq!(numerical_tolerance(9.94, 2), 0.05);
        assert_eq!(numerical_tolerance(9.96, 2), 0.5);
        assert_eq!(numerical_tolerance(0.094, 1), 0.005);
        assert_eq!(numerical_tolerance(0.096, 1), 0.05);
    }

    #[test]
    fn no_uncertainty_no_tolerance() {
        for u in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(numerical_tolerance(u, 2), 0.0);
        }
        assert_eq!(numerical_tolerance(5e-324, 2), 0.0);
        assert!(numerical_tolerance(1e300, 2) > 0.0);
    }

    #[test]
    fn mass_calibration_of_jcgm_101_9_3() {
        let gum = gum(1.2340, 0.0539, 1.2340 - 1.1285);
        let [two, one] = validate(&gum, &monte_carlo(Some(0.0754), [1.0834, 1.3825]));
        assert!((one.d_low - 0.0451).abs() < 1e-9 && (one.d_high - 0.0430).abs() < 1e-9);
        assert_eq!(
            (one.digits, one.delta, one.verdict),
            (1, 0.005, Clause8::NotValidated)
        );
        assert_eq!(
            (two.digits, two.delta, two.verdict),
            (2, 0.0005, Clause8::NotValidated)
        );
    }

    #[test]
    fn agreement_within_delta_validates() {
        // 9.2.3: four rectangles, 3.92 against 3.88.
        let [two, one] = validate(&gum(0.0, 2.0, 3.92), &monte_carlo(Some(2.0), [-3.88, 3.88]));
        assert!(two.is_validated() && one.is_validated());
        assert_eq!((two.delta, one.delta), (0.05, 0.5));
        // 9.2.4: one dominates, 19.9 against 17.0.
        let [two, one] = validate(
            &gum(0.0, 10.1, 19.9),
            &monte_carlo(Some(10.1), [-17.0, 17.0]),
        );
        assert!(!two.is_validated() && one.is_validated());
        assert!((two.d_low - 2.9).abs() < 1e-9);
    }

    #[test]
    fn gauge_block_of_jcgm_101_9_5() {
        // 99 %: [745, 931] against [745, 932]; u = 32 nm.
        let [two, one] = validate(
            &gum(838.0, 31.78, 93.0),
            &monte_carlo(Some(36.0), [745.0, 932.0]),
        );
        assert_eq!((two.delta, one.delta), (0.5, 5.0));
        assert!(!two.is_validated() && one.is_validated());
    }

    #[test]
    fn a_vanishing_u_takes_its_tolerance_from_monte_carlo() {
        // 9.4 with x1 = 0.
        let [two, one] = validate(&gum(0.0, 0.0, 0.0), &monte_carlo(Some(50.0), [1.3, 184.4]));
        assert_eq!((two.delta, one.delta), (0.5, 5.0));
        assert!(!two.is_validated() && !one.is_validated());
        // Nothing is uncertain: the two agree exactly.
        let [two, _] = validate(&gum(3.0, 0.0, 0.0), &monte_carlo(Some(0.0), [3.0, 3.0]));
        assert!(two.is_validated());
        // Neither method has a u, but the interval is wide.
        let [_, one] = validate(
            &gum(0.0, f64::NAN, f64::NAN),
            &monte_carlo(None, [-1.0, 1.0]),
        );
        assert!(!one.is_validated());
    }

    #[test]
    fn ends_that_scatter_leave_the_verdict_open() {
        let scattered = |error| MonteCarlo {
            standard_errors: [error; 4],
            ..monte_carlo(Some(2.0), [-3.88, 3.88])
        };
        // d = 0.04, δ = 0.05: an error of 0.004 decides, one of 0.006 does not.
        let verdict = |gum: &Gum, error| validate(gum, &scattered(error))[0].verdict;
        assert_eq!(verdict(&gum(0.0, 2.0, 3.92), 0.004), Clause8::Validated);
        assert_eq!(verdict(&gum(0.0, 2.0, 3.92), 0.006), Clause8::Undecided);
        assert_eq!(verdict(&gum(0.0, 2.0, 3.94), 0.006), Clause8::Undecided);
        assert_eq!(verdict(&gum(0.0, 2.0, 3.95), 0.006), Clause8::NotValidated);
        assert_eq!(verdict(&gum(0.0, 2.0, 3.92), f64::NAN), Clause8::Validated);
        // Twice the error is to be δ/5 = 0.01: 0.012 takes (1.2)² ~ 2 times as many trials.
        let [two, _] = validate(&gum(0.0, 2.0, 3.92), &scattered(0.006));
        assert_eq!(trials_needed(&two, 1_000_000), 2_000_000);
        let [two, _] = validate(&gum(0.0, 2.0, 3.92), &scattered(0.02));
        assert_eq!(trials_needed(&two, 1_000_000), 20_000_000);
    }
}
