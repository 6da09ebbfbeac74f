//! Several measurands (JCGM 102): covariance, correlation and coverage regions of the GUM result.
//!
//! The elliptical region has k_p² from chi-square with m degrees of freedom (JCGM 102 6.5.2), or
//! from Hotelling's T² for finite ν. The rectangular region y_j ± k_q u(y_j) is the one that holds
//! all measurands *at once* with probability p, with the correlations found: 2.21 in the example of
//! JCGM 102 9.2, where r = 0.5. Each measurand has the t-distribution of its own ν_eff there, and the
//! estimates of two variances go together as far as they have terms in common: of measurands that have
//! none, the probabilities are multiplied. The simple form q = (1 + p^(1/m))/2 is the uncorrelated case
//! of one ν and never smaller (Šidák's inequality).

use nalgebra::{Cholesky, DMatrix, DVector};

use super::covariance::Form;
use super::freedom;
use super::gum::Linear;
use super::monte_carlo::Outcome;
use super::result::{EllipsoidBy, JointResult};
use crate::budget::Budget;
use crate::elimination::pivoted_cholesky;
use gumption_core::model::Output;
use gumption_core::special::roots::last;
use gumption_core::special::{
    chi_squared_cdf, chi_squared_quantile, f_quantile, normal_cdf, normal_quantile,
    student_t_two_sided, student_t_two_sided_quantile,
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
    let forms: Vec<&Form> = linear.measurands.iter().map(|m| &m.form).collect();
    let own: Vec<f64> = (0..count).map(|a| not_zero(u(a))).collect();
    let common = in_one_unit(budget.model.outputs());
    let dof = freedom::effective_joint(&linear.covariance, &forms, common.as_ref().unwrap_or(&own))
        .report(|component| budget.components[component].name.to_string());
    let of_each = forms
        .iter()
        .map(|form| freedom::effective(&linear.covariance, form).dof);
    let of_each: Vec<f64> = of_each.collect();
    let margins = (count <= MANY).then(|| Margins {
        correlation: &correlation,
        dof: &of_each,
        variances: freedom::of_variances(&linear.covariance, &forms, &own),
    });
    let p = budget.conventions.coverage_probability;
    let (k_ellipsoid, ellipsoid_by) = k_ellipsoid(count, p, dof.value(), margins.as_ref());
    let exact = (0..count).any(|a| u(a) == 0.0);
    Some(JointResult {
        covariance: DMatrix::from_fn(count, count, |a, b| correlation[(a, b)] * u(a) * u(b)),
        monte_carlo_covariance: monte_carlo.and_then(|mc| mc.covariance.clone()),
        monte_carlo_correlation: monte_carlo.and_then(|mc| mc.correlation.clone()),
        k_ellipsoid,
        ellipsoid_by,
        k_rectangle: k_rectangle(p, &of_each, margins.as_ref()),
        dof,
        regions: monte_carlo.and_then(|mc| mc.regions.clone()),
        degenerate: exact || is_degenerate(&correlation),
        correlation,
    })
}

/// What a standard uncertainty is divided by.
fn not_zero(u: f64) -> f64 {
    if u == 0.0 { 1.0 } else { u }
}

/// By what the measurands are divided to be in the unit of the first; `None` where they are not of one dimension.
fn in_one_unit(outputs: &[Output]) -> Option<Vec<f64>> {
    let first = &outputs.first()?.unit;
    let of_output = |output: &Output| Some(first.conversion_to(&output.unit)?.factor);
    outputs.iter().map(of_output).collect()
}

fn is_degenerate(correlation: &DMatrix<f64>) -> bool {
    // NaN correlations (no derivative) have no region either.
    correlation.iter().any(|r| r.is_nan())
        || pivoted_cholesky(correlation, DEPENDENT).nrows() < correlation.nrows()
}

/// What each of a few measurands has for itself.
struct Margins<'a> {
    correlation: &'a DMatrix<f64>,
    /// Effective degrees of freedom of each.
    dof: &'a [f64],
    /// Correlation coefficients of the estimates of their variances.
    variances: DMatrix<f64>,
}

/// k_p of the elliptical region of `count` measurands: that of Hotelling's T², whose one ν knows that correlations are
/// estimated, or that with which measurands of their own ν lie in the region, whichever is larger.
fn k_ellipsoid(
    count: usize,
    p: f64,
    dof: f64,
    margins: Option<&Margins<'_>>,
) -> (f64, EllipsoidBy) {
    /// End of the search: t of one degree of freedom is less than ten times that of a normal distribution at 95 %, and 32 times
    /// at 99 %.
    const WIDEST: f64 = 1024.0;
    let common = hotelling(count, p, dof);
    let is_needed = |margins: &&Margins<'_>| margins.dof.iter().any(|own| *own < dof);
    let own = margins.filter(is_needed).and_then(|margins| {
        let factor = Cholesky::new(margins.correlation.clone())?.l();
        Some((Lattice::new(margins, count), factor))
    });
    let own = own.filter(|_| common.is_finite());
    let own = own.map(|(lattice, factor)| {
        let probability = |k: f64| lattice.ellipsoid_probability(&factor, k) - p;
        illinois(probability, common, WIDEST * common)
    });
    match own.filter(|own| *own > common) {
        Some(own) => (own, EllipsoidBy::Margins),
        None => (common, EllipsoidBy::Matrix),
    }
}

/// The same for one ν of all; infinite when it is too small for T² to exist.
fn hotelling(count: usize, p: f64, dof: f64) -> f64 {
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

/// k_q of the rectangular region, from the effective degrees of freedom of each measurand, and what few have for themselves.
fn k_rectangle(p: f64, dof: &[f64], margins: Option<&Margins<'_>>) -> f64 {
    let m = dof.len();
    let widest = |p: f64| {
        let of_each = dof.iter();
        let of_each = of_each.map(|dof| student_t_two_sided_quantile(p, *dof));
        of_each.fold(0.0, f64::max)
    };
    let alone = widest(p);
    let uncorrelated = last(alone, widest(libm::pow(p, 1.0 / m as f64)), |k| {
        let inside = dof.iter().map(|dof| student_t_two_sided(k, *dof));
        inside.product::<f64>() < p
    });
    let known = |margins: &&Margins<'_>| margins.correlation.iter().all(|r| !r.is_nan());
    let Some(margins) = margins.filter(known) else {
        return uncorrelated;
    };
    let correlation = margins.correlation;
    // Where measurands depend on one another, correlations that are smaller by a rounding error do
    // (k is then good to 0.3 % only, since the integrand has steps).
    let shrunk = || (correlation * (1.0 - 1e-10)) + DMatrix::identity(m, m) * 1e-10;
    let factor = Cholesky::new(correlation.clone()).or_else(|| Cholesky::new(shrunk()));
    let Some(factor) = factor.map(|cholesky| cholesky.l()) else {
        return uncorrelated;
    };
    let lattice = Lattice::new(margins, m - 1);
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

/// A point of integration: the factor between the estimate of each variable's standard deviation and the true one, and
/// coordinates in 0 … 1.
struct Point {
    scales: Vec<f64>,
    coordinates: Vec<f64>,
}

/// Points of a Korobov lattice, which the baker's transformation makes periodic.
struct Lattice(Vec<Point>);

impl Lattice {
    /// For variables of a t-distribution each, whose scales have a normal copula; of a normal distribution for infinite ν.
    fn new(margins: &Margins<'_>, coordinates: usize) -> Self {
        let common = pivoted_cholesky(&margins.variances, DEPENDENT);
        let dimensions = coordinates + common.nrows();
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
            let normal = DVector::from_fn(common.nrows(), |_, _| {
                // Kept off 0 and 1, which the middle of the range never is but a point of few may be.
                normal_quantile(next().clamp(1e-16, 1.0 - 1e-16))
            });
            let together = common.tr_mul(&normal);
            let scale = |(dof, z): (&f64, &f64)| match dof.is_finite() {
                true => (chi_squared_quantile(normal_cdf(*z), *dof) / dof).sqrt(),
                false => 1.0,
            };
            Point {
                scales: margins.dof.iter().zip(&together).map(scale).collect(),
                coordinates: (0..coordinates).map(|_| next()).collect(),
            }
        };
        Lattice((0..count).map(point).collect())
    }

    /// P(TᵀR⁻¹T ≤ k²) for the correlation R = L Lᵀ, from one coordinate for each variable: along each direction by itself, in which the
    /// true errors are Z = L·r·d with a χ-distributed r.
    fn ellipsoid_probability(&self, factor: &DMatrix<f64>, k: f64) -> f64 {
        let m = factor.nrows();
        let of_point = |point: &Point| {
            let coordinates = point.coordinates.iter();
            let normal = coordinates.map(|x| normal_quantile(x.clamp(1e-16, 1.0 - 1e-16)));
            let direction = DVector::from_iterator(m, normal).normalize();
            let mut t = factor * direction;
            for (t, scale) in t.iter_mut().zip(&point.scales) {
                *t /= scale;
            }
            let whitened = factor.solve_lower_triangular(&t);
            let size = whitened.map_or(f64::INFINITY, |whitened| whitened.norm_squared());
            chi_squared_cdf(k * k / size, m as f64)
        };
        self.0.iter().map(of_point).sum::<f64>() / self.0.len() as f64
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
            let mut product = 1.0;
            for i in 0..m {
                let half_width = k * point.scales[i];
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
    use gumption_core::special::{normal_pdf, normal_two_sided_quantile, student_t_pdf};

    const INF: f64 = f64::INFINITY;

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} is not {b}");
    }

    fn equicorrelated(m: usize, r: f64) -> DMatrix<f64> {
        DMatrix::from_fn(m, m, |i, j| if i == j { 1.0 } else { r })
    }

    /// Measurands whose variances are estimated together, or exactly known.
    fn together<'a>(correlation: &'a DMatrix<f64>, dof: &'a [f64]) -> Margins<'a> {
        let m = dof.len();
        Margins {
            correlation,
            dof,
            variances: DMatrix::from_element(m, m, f64::from(u8::from(dof[0].is_finite()))),
        }
    }

    /// Measurands that have no term in common.
    fn apart<'a>(correlation: &'a DMatrix<f64>, dof: &'a [f64]) -> Margins<'a> {
        let m = dof.len();
        let own = |a: usize, b: usize| f64::from(u8::from(a == b && dof[a].is_finite()));
        Margins {
            correlation,
            dof,
            variances: DMatrix::from_fn(m, m, own),
        }
    }

    fn of_one(correlation: &DMatrix<f64>, dof: f64) -> f64 {
        let dof = vec![dof; correlation.nrows()];
        k_rectangle(0.95, &dof, Some(&together(correlation, &dof)))
    }

    #[test]
    fn s2_elliptical_factors() {
        for (m, k) in [(1, 1.96), (2, 2.45), (3, 2.80), (4, 3.08), (5, 3.33)] {
            close(hotelling(m, 0.95, INF), k, 0.005);
        }
    }

    #[test]
    fn one_freedom_of_all() {
        // One dimension: t. Two: T² = 2ν/(ν−1)·F with F_{2,n}(p) = n/2·((1−p)^(−2/n) − 1).
        close(
            hotelling(1, 0.95, 7.3),
            student_t_two_sided_quantile(0.95, 7.3),
            1e-9,
        );
        let n: f64 = 4.0;
        let f = 0.5 * n * (0.05_f64.powf(-2.0 / n) - 1.0);
        close(hotelling(2, 0.95, 5.0), (2.0 * 5.0 / n * f).sqrt(), 1e-9);
        assert_eq!(hotelling(4, 0.95, 3.0), INF);
        close(hotelling(3, 0.95, 1e9), hotelling(3, 0.95, INF), 1e-6);
    }

    #[test]
    fn s2_9_2_rectangle() {
        close(
            of_one(&equicorrelated(2, 0.5), INF),
            2.212127746578617,
            1e-5,
        );
        close(
            of_one(&equicorrelated(2, -0.5), INF),
            2.212127746578617,
            1e-5,
        );
    }

    #[test]
    fn rectangle_between_its_limits() {
        for m in [2, 3, 5] {
            let k = of_one(&DMatrix::identity(m, m), INF);
            close(
                k,
                normal_two_sided_quantile(0.95_f64.powf(1.0 / m as f64)),
                1e-5,
            );
            let k = of_one(&equicorrelated(m, 1.0), INF);
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
        let correlation = equicorrelated(m, r);
        let factor = Cholesky::new(correlation.clone()).unwrap().l();
        close(
            Lattice::new(&together(&correlation, &[INF; 4]), m - 1).box_probability(&factor, k),
            integral,
            2e-4,
        );
    }

    #[test]
    fn multivariate_t() {
        // Fully dependent: the t of one variable.
        let correlation = equicorrelated(2, 1.0 - 1e-9);
        let factor = Cholesky::new(correlation.clone()).unwrap().l();
        close(
            Lattice::new(&together(&correlation, &[6.0; 2]), 1).box_probability(&factor, 2.5),
            student_t_two_sided(2.5, 6.0),
            1e-3,
        );
        // Bivariate t, r = 0, ν = 10: two-sided 5 % point of the Studentised maximum modulus, 2.61.
        close(of_one(&DMatrix::identity(2, 2), 10.0), 2.609, 0.002);
    }

    #[test]
    fn measurands_without_a_common_term_have_probabilities_that_multiply() {
        let identity = DMatrix::identity(2, 2);
        for dof in [[4.0, INF], [2.0, 2.0], [3.0, 60.0]] {
            let k = k_rectangle(0.95, &dof, Some(&apart(&identity, &dof)));
            let inside = dof.map(|dof| student_t_two_sided(k, dof));
            // As well as so few points integrate in three dimensions.
            close(inside[0] * inside[1], 0.95, 5e-4);
        }
    }

    /// P(T² + Z² ≤ k²) = ∫ f_ν(t) (2Φ(√(k² − t²)) − 1) dt, where one ν of both would be too large.
    #[test]
    fn an_ellipsoid_holds_measurands_of_their_own_freedom() {
        let identity = DMatrix::identity(2, 2);
        let dof = [4.0, INF];
        let (k, by) = k_ellipsoid(2, 0.95, 222.0, Some(&apart(&identity, &dof)));
        assert_eq!(by, EllipsoidBy::Margins);
        let step = 1e-4;
        let inside = |t: f64| 2.0 * normal_cdf((k * k - t * t).max(0.0).sqrt()) - 1.0;
        let integral: f64 = (0..40_000)
            .map(|i| 2.0 * student_t_pdf(step * (f64::from(i) + 0.5), 4.0) * step)
            .enumerate()
            .map(|(i, density)| density * inside(step * (i as f64 + 0.5)))
            .sum();
        close(integral, 0.95, 1e-3);
        // Where one ν says as much, it stands.
        let dof = [9.0, 9.0];
        let same = k_ellipsoid(2, 0.95, 9.0, Some(&together(&identity, &dof)));
        assert_eq!(same, (hotelling(2, 0.95, 9.0), EllipsoidBy::Matrix));
    }

    #[test]
    fn dependence_is_found() {
        assert!(is_degenerate(&equicorrelated(2, -1.0)));
        // Three fractions that sum to one.
        assert!(is_degenerate(&equicorrelated(3, -0.5)));
        assert!(!is_degenerate(&equicorrelated(3, 0.999)));
    }
}
