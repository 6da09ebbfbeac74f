//! Student's t distribution with real degrees of freedom ν, also below one and infinite.
//!
//! With t = √ν·sinh s its density becomes K·cosh(s)^−ν, which is log-concave for every ν.

use std::cell::RefCell;

use super::gamma::stirling_error;
use super::log_concave::{LogConcave, Side, solve, tail};
use super::normal::{
    normal_pdf, normal_quantile, normal_sf, normal_two_sided, normal_two_sided_quantile,
    normal_upper_quantile,
};
use super::quadrature::gauss_legendre;

/// The density at t.
pub fn student_t_pdf(t: f64, dof: f64) -> f64 {
    if !in_domain(dof) || t.is_nan() {
        return f64::NAN;
    }
    if dof.is_infinite() {
        return normal_pdf(t);
    }
    let point = Point::at(t.abs(), dof);
    // ds/dt = 1/(√ν·cosh s)
    libm::exp(point.ln_density() - point.ln_cosh) / dof.sqrt()
}

/// Probability of a value below t.
pub fn student_t_cdf(t: f64, dof: f64) -> f64 {
    if t < 0.0 {
        student_t_sf(-t, dof)
    } else {
        1.0 - student_t_sf(t, dof)
    }
}

/// Probability of a value above t.
pub fn student_t_sf(t: f64, dof: f64) -> f64 {
    if !in_domain(dof) || t.is_nan() {
        return f64::NAN;
    }
    if dof.is_infinite() {
        return normal_sf(t);
    }
    let upper = match t.abs() {
        f64::INFINITY => 0.0,
        size => tail(&Point::at(size, dof), Side::Upper).value().min(0.5),
    };
    if t < 0.0 { 1.0 - upper } else { upper }
}

/// The normal deviation beyond which lies the same probability as beyond t.
pub fn student_t_score(t: f64, dof: f64) -> f64 {
    let size = t.abs();
    let score = match dof.is_finite() {
        true => normal_upper_quantile(student_t_sf(size, dof)),
        false => size,
    };
    // So far out no probability is left.
    let score = if score.is_finite() { score } else { size };
    score.copysign(t)
}

/// Probability of a value in ±t, exact also for small t.
pub fn student_t_two_sided(t: f64, dof: f64) -> f64 {
    if !in_domain(dof) || t.is_nan() {
        return f64::NAN;
    }
    if dof.is_infinite() {
        return normal_two_sided(t);
    }
    let outside = 2.0 * student_t_sf(t, dof);
    if outside > 0.9 {
        central(Point::at(t, dof).s, dof)
    } else {
        1.0 - outside
    }
}

/// The t below which a fraction p of the distribution lies.
pub fn student_t_quantile(p: f64, dof: f64) -> f64 {
    if !in_domain(dof) || !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    if dof.is_infinite() {
        return normal_quantile(p);
    }
    if p < 0.5 {
        -upper(p, dof)
    } else {
        upper(1.0 - p, dof)
    }
}

/// The t above which a fraction q of the distribution lies.
pub fn student_t_upper_quantile(q: f64, dof: f64) -> f64 {
    -student_t_quantile(q, dof)
}

/// t_p(ν), the t for which a fraction p of the distribution lies in ±t: the coverage factor of
/// GUM G.3.2 and Table G.2.
pub fn student_t_two_sided_quantile(p: f64, dof: f64) -> f64 {
    if !in_domain(dof) || !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    if dof.is_infinite() {
        normal_two_sided_quantile(p)
    } else {
        known(p, dof, || match p < 0.1 {
            true => from_centre(p, dof),
            false => from_tail(0.5 * (1.0 - p), dof),
        })
    }
}

/// The quantile of this p and ν, computed where it is not among the last. ν is a whole number mostly, and tables of
/// results ask for the same few again and again.
fn known(p: f64, dof: f64, compute: impl FnOnce() -> f64) -> f64 {
    const PLACES: usize = 64;
    thread_local! {
        static LAST: RefCell<[(f64, f64, f64); PLACES]> = const { RefCell::new([(0.0, 0.0, 0.0); PLACES]) };
    }
    // Whole numbers below 64 have places of their own; ν = 0 is none, so that an empty place is nobody's.
    let place = dof as usize % PLACES;
    LAST.with_borrow_mut(|last| {
        let (known_p, known_dof, quantile) = last[place];
        if known_p == p && known_dof == dof {
            return quantile;
        }
        let quantile = compute();
        last[place] = (p, dof, quantile);
        quantile
    })
}

fn in_domain(dof: f64) -> bool {
    dof > 0.0
}

/// A point s ≥ 0 of the density K·cosh(s)^−ν.
struct Point {
    dof: f64,
    s: f64,
    tanh: f64,
    ln_cosh: f64,
}

impl Point {
    /// The point that belongs to t; ln cosh s = ½ ln(1 + t²/ν) without the detour.
    fn at(t: f64, dof: f64) -> Point {
        let s = libm::asinh(t / dof.sqrt());
        let square = t / dof * t;
        let ln_cosh = if square < 1e300 {
            0.5 * libm::log1p(square)
        } else {
            ln_cosh(s)
        };
        Point {
            dof,
            s,
            tanh: libm::tanh(s),
            ln_cosh,
        }
    }

    fn new(s: f64, dof: f64) -> Point {
        Point {
            dof,
            s,
            tanh: libm::tanh(s),
            ln_cosh: ln_cosh(s),
        }
    }
}

impl LogConcave for Point {
    fn ln_density(&self) -> f64 {
        ln_constant(self.dof) - self.dof * self.ln_cosh
    }

    fn rise(&self, delta: f64) -> f64 {
        // cosh(s + δ)/cosh(s) = cosh δ + tanh s·sinh δ
        let ln_ratio = if delta < 20.0 {
            let half = libm::sinh(0.5 * delta);
            libm::log1p(2.0 * half * half + self.tanh * libm::sinh(delta))
        } else {
            delta + libm::log(0.5 * (1.0 + self.tanh))
        };
        -self.dof * ln_ratio
    }

    fn slope(&self) -> f64 {
        -self.dof * self.tanh
    }

    fn curvature(&self) -> f64 {
        let cosh = libm::cosh(self.s);
        self.dof / (cosh * cosh)
    }
}

/// ln K = ln Γ((ν+1)/2) − ln Γ(ν/2) − ½ ln π.
fn ln_constant(dof: f64) -> f64 {
    const HALF_LN_PI: f64 = 0.572_364_942_924_700_1;
    let z = 0.5 * dof;
    z * libm::log1p(0.5 / z) - 0.5 + 0.5 * libm::log(z) + stirling_error(z + 0.5)
        - stirling_error(z)
        - HALF_LN_PI
}

/// ln cosh s for s ≥ 0, exact near zero and without overflow.
fn ln_cosh(s: f64) -> f64 {
    if s < 20.0 {
        let sinh = libm::sinh(s);
        0.5 * libm::log1p(sinh * sinh)
    } else {
        s - std::f64::consts::LN_2
    }
}

/// Upper quantile for q ≤ ½.
fn upper(q: f64, dof: f64) -> f64 {
    let inside = 1.0 - 2.0 * q;
    if inside < 0.1 {
        from_centre(inside, dof)
    } else {
        from_tail(q, dof)
    }
}

/// The t with tail probability q < 0.45.
fn from_tail(q: f64, dof: f64) -> f64 {
    if q == 0.0 {
        return f64::INFINITY;
    }
    // Wallace (1959): √(ν ln(1 + t²/ν)) is nearly normal.
    let z = normal_quantile(q) * (8.0 * dof + 3.0) / (8.0 * dof + 1.0);
    let ln_cosh_squared = z * z / dof;
    let s = if ln_cosh_squared < 600.0 {
        libm::asinh(libm::expm1(ln_cosh_squared).sqrt())
    } else {
        0.5 * ln_cosh_squared + std::f64::consts::LN_2
    };
    let moved = |point: &Point, delta: f64| Point::new((point.s + delta).max(0.0), dof);
    dof.sqrt() * libm::sinh(solve(Point::new(s, dof), Side::Upper, libm::log(q), moved).s)
}

/// The t for which a small probability p lies in ±t.
///
/// Newton's method: the probability is concave in s, so that it converges from below.
fn from_centre(p: f64, dof: f64) -> f64 {
    let ln_twice_k = ln_constant(dof) + std::f64::consts::LN_2;
    let mut s = p * libm::exp(-ln_twice_k);
    for _ in 0..50 {
        let density = libm::exp(ln_twice_k - dof * ln_cosh(s));
        let missing = p - central(s, dof);
        s += missing / density;
        if missing.abs() <= 1e-8 * p {
            break;
        }
    }
    dof.sqrt() * libm::sinh(s)
}

/// Probability in ±s, by Gauss–Legendre quadrature from the middle; meant for less than 0.1.
fn central(s: f64, dof: f64) -> f64 {
    let density = |s: f64| libm::exp(-dof * ln_cosh(s));
    let panels = s.ceil().clamp(1.0, 1000.0);
    let integral: f64 = (0..panels as u32)
        .flat_map(|panel| {
            let edge = |n: u32| s * f64::from(n) / panels;
            gauss_legendre(edge(panel), edge(panel + 1))
        })
        .map(|(node, weight)| weight * density(node))
        .sum();
    2.0 * libm::exp(ln_constant(dof)) * integral
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::table::check;

    const TABLE: &str = include_str!("../../../../tests/data/special/student_t.csv");

    #[test]
    fn agree_with_the_table() {
        check(TABLE, "student_t_pdf", 1e-13, |a| student_t_pdf(a[0], a[1]));
        check(TABLE, "student_t_sf", 1e-13, |a| student_t_sf(a[0], a[1]));
        check(TABLE, "student_t_two_sided", 1e-13, |a| {
            student_t_two_sided(a[0], a[1])
        });
        check(TABLE, "student_t_quantile", 1e-12, |a| {
            student_t_quantile(a[0], a[1])
        });
        check(TABLE, "student_t_two_sided_quantile", 1e-12, |a| {
            student_t_two_sided_quantile(a[0], a[1])
        });
    }

    /// JCGM 100:2008, Table G.2: the printed two decimals (one for 235.8).
    #[test]
    fn agree_with_table_g2_of_the_gum() {
        const P: [f64; 6] = [0.6827, 0.90, 0.95, 0.9545, 0.99, 0.9973];
        const ROWS: [(f64, [f64; 6]); 6] = [
            (1.0, [1.84, 6.31, 12.71, 13.97, 63.66, 235.80]),
            (2.0, [1.32, 2.92, 4.30, 4.53, 9.92, 19.21]),
            (5.0, [1.11, 2.02, 2.57, 2.65, 4.03, 5.51]),
            (10.0, [1.05, 1.81, 2.23, 2.28, 3.17, 3.96]),
            (16.0, [1.03, 1.75, 2.12, 2.17, 2.92, 3.54]),
            (50.0, [1.01, 1.68, 2.01, 2.05, 2.68, 3.16]),
        ];
        for (dof, row) in ROWS {
            for (p, printed) in P.into_iter().zip(row) {
                let t = student_t_two_sided_quantile(p, dof);
                let half_digit = if printed > 100.0 { 0.05 } else { 0.005_000_5 };
                assert!(
                    (t - printed).abs() <= half_digit,
                    "t_{p}({dof}) = {t}, not {printed}"
                );
            }
        }
    }

    #[test]
    fn one_and_two_degrees_of_freedom_have_closed_forms() {
        for p in [1e-300, 1e-10, 0.3, 0.499_999, 0.500_000_1, 0.975] {
            let one = -1.0 / (std::f64::consts::PI * p).tan();
            assert!(p > 0.49 && p < 0.51 || (student_t_quantile(p, 1.0) / one - 1.0).abs() < 1e-13);
            let two = (2.0 * p - 1.0) / (2.0 * p * (1.0 - p)).sqrt();
            assert!((student_t_quantile(p, 2.0) / two - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn infinite_degrees_of_freedom_are_normal() {
        assert_eq!(
            student_t_quantile(0.975, f64::INFINITY),
            normal_quantile(0.975)
        );
        assert_eq!(student_t_sf(1.5, f64::INFINITY), normal_sf(1.5));
        assert!((student_t_quantile(0.975, 1e15) / normal_quantile(0.975) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn ends_and_domain() {
        assert_eq!(student_t_quantile(0.0, 3.0), f64::NEG_INFINITY);
        assert_eq!(student_t_quantile(1.0, 3.0), f64::INFINITY);
        assert_eq!(student_t_quantile(0.5, 3.0), 0.0);
        assert_eq!(student_t_two_sided_quantile(0.0, 3.0), 0.0);
        assert_eq!(student_t_two_sided_quantile(1.0, 3.0), f64::INFINITY);
        // Beyond the largest number.
        assert_eq!(student_t_quantile(1e-300, 0.1), f64::NEG_INFINITY);
        assert!(student_t_quantile(0.3, 0.0).is_nan());
        assert!(student_t_quantile(1.1, 3.0).is_nan());
        assert!(student_t_cdf(f64::NAN, 3.0).is_nan());
        assert_eq!(student_t_cdf(f64::NEG_INFINITY, 3.0), 0.0);
        assert_eq!(student_t_sf(0.0, 3.0), 0.5);
    }
}
