//! Validation of the GUM result by Monte Carlo (JCGM 101:2008, clause 8), and the numerical
//! tolerance that it and the adaptive procedures use (7.9.2).

use super::{Gum, MonteCarlo, Validation};

/// δ = ½·10^l for u = c·10^l, c a whole number of `digits` digits (JCGM 101 7.9.2).
///
/// c is u rounded, so that 9.96 with two digits is 10·10⁰ and not 99·10⁻¹. Zero when u is zero
/// or not finite: then no difference can be called negligible.
pub(crate) fn numerical_tolerance(u: f64, digits: u8) -> f64 {
    if !(u.is_finite() && u > 0.0) {
        return 0.0;
    }
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
    [2, 1].map(|digits| {
        let delta = numerical_tolerance(u, digits);
        Validation {
            digits,
            delta,
            d_low,
            d_high,
            validated: d_low <= delta && d_high <= delta,
        }
    })
}

/// The verdict at the digits that are reported.
pub(crate) fn at(both: &[Validation; 2], digits: u8) -> &Validation {
    let [two, one] = both;
    if digits < 2 { one } else { two }
}

#[cfg(test)]
mod tests {
    use super::super::{Coverage, CoverageBasis, Freedom, Histogram};
    use super::*;

    fn gum(estimate: f64, u: f64, half_width: f64) -> Gum {
        Gum {
            estimate,
            u,
            inputs: Vec::new(),
            components: Vec::new(),
            freedom: Freedom::Infinite,
            coverage: Coverage {
                k: 2.0,
                basis: CoverageBasis::Normal,
                probability: 0.95,
                expanded: 2.0 * u,
                half_width_for_p: half_width,
            },
        }
    }

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
        assert_eq!((one.digits, one.delta, one.validated), (1, 0.005, false));
        assert_eq!((two.digits, two.delta, two.validated), (2, 0.0005, false));
    }

    #[test]
    fn agreement_within_delta_validates() {
        // 9.2.3: four rectangles, 3.92 against 3.88.
        let [two, one] = validate(&gum(0.0, 2.0, 3.92), &monte_carlo(Some(2.0), [-3.88, 3.88]));
        assert!(two.validated && one.validated);
        assert_eq!((two.delta, one.delta), (0.05, 0.5));
        // 9.2.4: one dominates, 19.9 against 17.0.
        let [two, one] = validate(
            &gum(0.0, 10.1, 19.9),
            &monte_carlo(Some(10.1), [-17.0, 17.0]),
        );
        assert!(!two.validated && one.validated);
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
        assert!(!two.validated && one.validated);
    }

    #[test]
    fn a_vanishing_u_takes_its_tolerance_from_monte_carlo() {
        // 9.4 with x1 = 0.
        let [two, one] = validate(&gum(0.0, 0.0, 0.0), &monte_carlo(Some(50.0), [1.3, 184.4]));
        assert_eq!((two.delta, one.delta), (0.5, 5.0));
        assert!(!two.validated && !one.validated);
        // Nothing is uncertain: the two agree exactly.
        let [two, _] = validate(&gum(3.0, 0.0, 0.0), &monte_carlo(Some(0.0), [3.0, 3.0]));
        assert!(two.validated);
        // Neither method has a u, but the interval is wide.
        let [_, one] = validate(
            &gum(0.0, f64::NAN, f64::NAN),
            &monte_carlo(None, [-1.0, 1.0]),
        );
        assert!(!one.validated);
    }
}
