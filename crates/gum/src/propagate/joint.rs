//! Several measurands (JCGM 102): covariance, correlation and coverage regions of the GUM result.
//!
//! The elliptical region has k_p² from chi-square with m degrees of freedom (JCGM 102 6.5.2), or
//! from Hotelling's T² for finite ν. The rectangular region y_j ± k_q u(y_j) is the one that holds
//! all measurands *at once* with probability p, for the joint normal distribution (or multivariate
//! t) with the correlations found: 2.21 in the example of JCGM 102 9.2, where r = 0.5. The simple
//! form q = (1 + p^(1/m))/2 is the uncorrelated case and never smaller (Šidák's inequality).

use nalgebra::{Cholesky, DMatrix};

use super::covariance::Form;
use super::freedom;
use super::gum::Linear;
use super::monte_carlo::Outcome;
use super::result::{Freedom, JointResult};
use crate::budget::Budget;
use crate::elimination::pivoted_cholesky;
use gumption_core::model::Output;
use gumption_core::special::{
    chi_squared_quantile, f_quantile, normal_cdf, normal_quantile, student_t_two_sided_quantile,
};

/// A measurand whose variance given the others is below this part of its own depends on them.
const DEPENDENT: f64 = 1e-10;

/// Joint result of two or more measurands.
pub(super) fn evaluate(
    budget: &Budget,
    linear: &Linear,
    monte_carlo: Option<&Outcome>,
) -> Option<JointResult> {
    let count = linear.measurands.len();
    if count < 2 {
        return None;
    }
    let correlation = linear.correlations();
    let u = |a: usize| linear.measurands[a].u;
    let dof = freedom_of_all(budget, linear);
    let p = budget.conventions.coverage_probability;
    let exact = (0..count).any(|a| u(a) == 0.0);
    Some(JointResult {
        covariance: DMatrix::from_fn(count, count, |a, b| correlation[(a, b)] * u(a) * u(b)),
        monte_carlo_covariance: monte_carlo.and_then(|mc| mc.covariance.clone()),
        monte_carlo_correlation: monte_carlo.and_then(|mc| mc.correlation.clone()),
        k_ellipsoid: k_ellipsoid(count, p, dof.value()),
        k_rectangle: k_rectangle(&correlation, p, dof.value()),
        dof,
        regions: monte_carlo.and_then(|mc| mc.regions.clone()),
        degenerate: exact || is_degenerate(&correlation),
        correlation,
    })
}

fn freedom_of_all(budget: &Budget, linear: &Linear) -> Freedom {
    let forms: Vec<&Form> = linear.measurands.iter().map(|m| &m.form).collect();
    let one_unit = in_one_unit(budget.model.outputs());
    let scales: Vec<f64> = linear
        .measurands
        .iter()
        .map(|m| if one_unit || m.u == 0.0 { 1.0 } else { m.u })
        .collect();
    freedom::effective_joint(&linear.covariance, &forms, &scales)
        .report(|component| budget.components[component].name.to_string())
}

fn in_one_unit(outputs: &[Output]) -> bool {
    outputs.windows(2).all(|pair| {
        pair[0]
            .unit
            .conversion_to(&pair[1].unit)
            .is_some_and(|conversion| conversion.is_identity())
    })
}

fn is_degenerate(correlation: &DMatrix<f64>) -> bool {
    // NaN correlations (no derivative) have no region either.
    correlation.iter().any(|r| r.is_nan())
        || pivoted_cholesky(correlation, DEPENDENT).nrows() < correlation.nrows()
}

/// k_p of the elliptical region in `count` dimensions; infinite when ν is too small for Hotelling's
/// T² to exist.
fn k_ellipsoid(count: usize, p: f64, dof: f64) -> f64 {
    let m = count as f64;
    if dof.is_infinite() {
        return chi_squared_quantile(p, m).sqrt();
    }
    let rest = dof + 1.0 - m;
    if rest <= 0.0 {
        return f64::INFINITY;
    }
    (m * dof / rest * f_quantile(p, m, rest)).sqrt()
}

/// More measurands than this get the uncorrelated k_q, which is on the safe side.
const MANY: usize = 25;

/// k_q of the rectangular region.
fn k_rectangle(correlation: &DMatrix<f64>, p: f64, dof: f64) -> f64 {
    let m = correlation.nrows();
    let alone = student_t_two_sided_quantile(p, dof);
    let uncorrelated = student_t_two_sided_quantile(libm::pow(p, 1.0 / m as f64), dof);
    if m > MANY || correlation.iter().any(|r| r.is_nan()) {
        return uncorrelated;
    }
    // Where measurands depend on one another, correlations that are smaller by a rounding error do
    // (k is then good to 0.3 % only, since the integrand has steps).
    let shrunk = || (correlation * (1.0 - 1e-10)) + DMatrix::identity(m, m) * 1e-10;
    let factor = Cholesky::new(correlation.clone()).or_else(|| Cholesky::new(shrunk()));
    let Some(factor) = factor.map(|cholesky| cholesky.l()) else {
        return uncorrelated;
    };
    let lattice = Lattice::new(m, dof);
    illinois(
        |k| lattice.box_probability(&factor, k) - p,
        alone,
        uncorrelated,
    )
}

/// Root of an increasing function between `low` and `high`, by regula falsi (Illinois variant); an
/// end of the range when the root is beyond it.
fn illinois(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let (mut at_low, mut at_high) = (f(low), f(high));
    if at_low >= 0.0 {
        return low;
    }
    if at_high <= 0.0 {
        return high;
    }
    let mut previous_below = None;
    for _ in 0..60 {
        let x = high - at_high * (high - low) / (at_high - at_low);
        let value = f(x);
        let below = value < 0.0;
        if value.abs() < 1e-8 || (high - low) < 1e-8 * high {
            return x;
        }
        let repeated = previous_below == Some(below);
        if below {
            (low, at_low) = (x, value);
            at_high *= if repeated { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (x, value);
            at_low *= if repeated { 0.5 } else { 1.0 };
        }
        previous_below = Some(below);
    }
    0.5 * (low + high)
}

/// A point of integration: the scale that χ gives all variables, and one coordinate in 0 … 1 for
/// each variable but the last.
struct Point {
    scale: f64,
    coordinates: Vec<f64>,
}

/// Points of a Korobov lattice, which the baker's transformation makes periodic.
struct Lattice(Vec<Point>);

impl Lattice {
    /// For `m` variables of a multivariate t; normal for infinite ν.
    fn new(m: usize, dof: f64) -> Self {
        let dimensions = m - 1 + usize::from(dof.is_finite());
        let (count, generator) = if dimensions <= 1 {
            (1021_u64, 76_u64)
        } else {
            (2039, 1487)
        };
        let point = |n: u64| {
            let mut place = n;
            let mut next = || {
                let x = (place as f64 + 0.5) / count as f64;
                place = place * generator % count;
                1.0 - (2.0 * x - 1.0).abs()
            };
            let scale = if dof.is_finite() {
                (chi_squared_quantile(next(), dof) / dof).sqrt()
            } else {
                1.0
            };
            Point {
                scale,
                coordinates: (1..m).map(|_| next()).collect(),
            }
        };
        Lattice((0..count).map(point).collect())
    }

    /// P(|T_j| ≤ k for all j) for the correlation L Lᵀ.
    ///
    /// Separation of variables (Genz 1992; Genz and Bretz 1999): conditional probabilities of one
    /// variable after another, averaged over the points.
    fn box_probability(&self, factor: &DMatrix<f64>, k: f64) -> f64 {
        let m = factor.nrows();
        let mut y = vec![0.0; m];
        let mut sum = 0.0;
        for point in &self.0 {
            let half_width = k * point.scale;
            let mut product = 1.0;
            for i in 0..m {
                let centre: f64 = (0..i).map(|j| factor[(i, j)] * y[j]).sum();
                let lower = normal_cdf((-half_width - centre) / factor[(i, i)]);
                let upper = normal_cdf((half_width - centre) / factor[(i, i)]);
                product *= upper - lower;
                if let Some(w) = point.coordinates.get(i) {
                    // Kept off 0 and 1, where a variable far out has no finite quantile.
                    let inside = (lower + w * (upper - lower)).clamp(1e-300, 1.0 - 1e-16);
                    y[i] = normal_quantile(inside);
                }
            }
            sum += product;
        }
        sum / self.0.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_core::special::{normal_pdf, normal_two_sided_quantile, student_t_two_sided};

    const INF: f64 = f64::INFINITY;

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} is not {b}");
    }

    fn equicorrelated(m: usize, r: f64) -> DMatrix<f64> {
        DMatrix::from_fn(m, m, |i, j| if i == j { 1.0 } else { r })
    }

    #[test]
    fn s2_elliptical_factors() {
        for (m, k) in [(1, 1.96), (2, 2.45), (3, 2.80), (4, 3.08), (5, 3.33)] {
            close(k_ellipsoid(m, 0.95, INF), k, 0.005);
        }
    }

    #[test]
    fn hotelling() {
        // One dimension: t. Two: T² = 2ν/(ν−1)·F with F_{2,n}(p) = n/2·((1−p)^(−2/n) − 1).
        close(
            k_ellipsoid(1, 0.95, 7.3),
            student_t_two_sided_quantile(0.95, 7.3),
            1e-9,
        );
        let n: f64 = 4.0;
        let f = 0.5 * n * (0.05_f64.powf(-2.0 / n) - 1.0);
        close(k_ellipsoid(2, 0.95, 5.0), (2.0 * 5.0 / n * f).sqrt(), 1e-9);
        assert_eq!(k_ellipsoid(4, 0.95, 3.0), INF);
        close(k_ellipsoid(3, 0.95, 1e9), k_ellipsoid(3, 0.95, INF), 1e-6);
    }

    #[test]
    fn s2_9_2_rectangle() {
        close(
            k_rectangle(&equicorrelated(2, 0.5), 0.95, INF),
            2.212127746578617,
            1e-5,
        );
        close(
            k_rectangle(&equicorrelated(2, -0.5), 0.95, INF),
            2.212127746578617,
            1e-5,
        );
    }

    #[test]
    fn rectangle_between_its_limits() {
        for m in [2, 3, 5] {
            let k = k_rectangle(&DMatrix::identity(m, m), 0.95, INF);
            close(
                k,
                normal_two_sided_quantile(0.95_f64.powf(1.0 / m as f64)),
                1e-5,
            );
            let k = k_rectangle(&equicorrelated(m, 1.0), 0.95, INF);
            close(k, normal_two_sided_quantile(0.95), 5e-3);
        }
    }

    #[test]
    fn equicorrelated_rectangle_by_a_single_integral() {
        // X_j = √r Z + √(1−r) E_j: P = ∫ φ(z) (Φ((k−√r z)/s) − Φ((−k−√r z)/s))^m dz.
        let (m, r, k) = (4, 0.7_f64, 2.3);
        let (a, s) = (r.sqrt(), (1.0 - r).sqrt());
        let step = 1e-3;
        let integral: f64 = (-8000..=8000)
            .map(|i| {
                let z = i as f64 * step;
                let inside = normal_cdf((k - a * z) / s) - normal_cdf((-k - a * z) / s);
                normal_pdf(z) * inside.powi(m as i32) * step
            })
            .sum();
        let factor = Cholesky::new(equicorrelated(m, r)).unwrap().l();
        close(
            Lattice::new(m, INF).box_probability(&factor, k),
            integral,
            2e-4,
        );
    }

    #[test]
    fn multivariate_t() {
        // Fully dependent: the t of one variable.
        let factor = Cholesky::new(equicorrelated(2, 1.0 - 1e-9)).unwrap().l();
        close(
            Lattice::new(2, 6.0).box_probability(&factor, 2.5),
            student_t_two_sided(2.5, 6.0),
            1e-3,
        );
        // Bivariate t, r = 0, ν = 10: two-sided 5 % point of the Studentised maximum modulus, 2.61.
        close(
            k_rectangle(&DMatrix::identity(2, 2), 0.95, 10.0),
            2.609,
            0.002,
        );
    }

    #[test]
    fn dependence_is_found() {
        assert!(is_degenerate(&equicorrelated(2, -1.0)));
        // Three fractions that sum to one.
        assert!(is_degenerate(&equicorrelated(3, -0.5)));
        assert!(!is_degenerate(&equicorrelated(3, 0.999)));
    }
}
