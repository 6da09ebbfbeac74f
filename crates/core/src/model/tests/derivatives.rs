//! Derivatives against closed forms and against num-dual.

use super::super::jet::Jet;
use super::super::operation::{power, power_derivatives};
use super::super::points;
use super::*;
use num_dual::{Dual3, Dual64, DualNum};

type Third = Dual3<f64>;

/// Compares value and derivatives along (1, 0.7) with third-order dual numbers.
fn against(text: &str, x: [f64; 2], oracle: impl Fn([Third; 2]) -> Third) {
    let d = [1.0, 0.7];
    let model = model("x y", text, "");
    let truth = oracle([
        Dual3::new(x[0], d[0], 0.0, 0.0),
        Dual3::new(x[1], d[1], 0.0, 0.0),
    ]);
    let along = &model.along(&x, &d)[0];
    let dot = |v: &[f64]| v[0] * d[0] + v[1] * d[1];
    close(model.values(&x)[0], truth.re, 1e-13, text);
    close(
        dot(&along.gradient),
        truth.v1,
        1e-12,
        &format!("{text}, first"),
    );
    close(
        dot(&along.second),
        truth.v2,
        1e-11,
        &format!("{text}, second"),
    );
    close(
        dot(&along.third),
        truth.v3,
        1e-10,
        &format!("{text}, third"),
    );
    let gradient = model.gradients(&x);
    assert_eq!([gradient[(0, 0)], gradient[(0, 1)]], along.gradient[..]);
}

#[test]
fn every_smooth_function_against_num_dual() {
    let p = [0.37, 1.23];
    against("sqrt(x)", p, |[x, _]| x.sqrt());
    against("cbrt(x)", p, |[x, _]| x.cbrt());
    against("exp(x)", p, |[x, _]| x.exp());
    against("ln(x)", p, |[x, _]| x.ln());
    against("log10(x)", p, |[x, _]| x.log10());
    against("log2(x)", p, |[x, _]| x.log2());
    against("sin(x)", p, |[x, _]| x.sin());
    against("cos(x)", p, |[x, _]| x.cos());
    against("tan(x)", p, |[x, _]| x.tan());
    against("asin(x)", p, |[x, _]| x.asin());
    against("acos(x)", p, |[x, _]| x.acos());
    against("atan(x)", p, |[x, _]| x.atan());
    against("sinh(x)", p, |[x, _]| x.sinh());
    against("cosh(x)", p, |[x, _]| x.cosh());
    against("tanh(x)", p, |[x, _]| x.tanh());
    against("asinh(x)", p, |[x, _]| x.asinh());
    against("acosh(y)", p, |[_, y]| y.acosh());
    against("atanh(x)", p, |[x, _]| x.atanh());
    against("abs(-x)", p, |[x, _]| x);
    against("x^2 + x^3 - x^-2 + x^0.3", p, |[x, _]| {
        x.powi(2) + x.powi(3) - x.powi(-2) + x.powf(0.3)
    });
    against("x^y", p, |[x, y]| (x.ln() * y).exp());
    against("2^y", p, |[_, y]| (y * 2f64.ln()).exp());
    against("x * y / (x - y)", p, |[x, y]| x * y / (x - y));
    against("atan2(x, y)", p, |[x, y]| (x / y).atan());
    against("hypot(x, y)", p, |[x, y]| (x * x + y * y).sqrt());
    against("max(x, y^2) * min(x, y)", p, |[x, y]| y * y * x);
    against("if(x < y, x * y^3, x)", p, |[x, y]| x * y * y * y);
    against("f(a) = sin(a) / a; f(x * y) + exp(-x^2)", p, |[x, y]| {
        (x * y).sin() / (x * y) + (-x * x).exp()
    });
}

#[test]
fn error_function() {
    // erf' = 2/√π exp(-x²); Hermite polynomials give the higher derivatives.
    let x: f64 = 0.4;
    let g = std::f64::consts::FRAC_2_SQRT_PI * (-x * x).exp();
    let along = &model("x", "erf(x)", "").along(&[x], &[1.0])[0];
    close(along.gradient[0], g, 1e-14, "first");
    close(along.second[0], -2.0 * x * g, 1e-14, "second");
    close(along.third[0], (4.0 * x * x - 2.0) * g, 1e-14, "third");
}

#[test]
fn mixed_derivatives_of_every_input() {
    // f = x² y³: gradient, H d and D³[d, d] written out.
    let (x, y, p, q) = (1.5, -0.5, 0.3, 2.0);
    let along = &model("x y", "x^2 * y^3", "").along(&[x, y], &[p, q])[0];
    let expected = [
        [2.0 * x * y * y * y, 3.0 * x * x * y * y],
        [
            2.0 * y * y * y * p + 6.0 * x * y * y * q,
            6.0 * x * y * y * p + 6.0 * x * x * y * q,
        ],
        [
            12.0 * y * y * p * q + 12.0 * x * y * q * q,
            6.0 * y * y * p * p + 24.0 * x * y * p * q + 6.0 * x * x * q * q,
        ],
    ];
    for (found, expected) in [&along.gradient, &along.second, &along.third]
        .into_iter()
        .zip(expected)
    {
        for (f, e) in found.iter().zip(expected) {
            close(*f, e, 1e-14, "mixed");
        }
    }
}

#[test]
fn roots_have_the_derivatives_of_their_closed_forms() {
    // y = x W(…): with w = W(x), w' = w/(x(1+w)), and so on by hand.
    let x: f64 = 2.0;
    let m = model("x", "solve(w * exp(w) == x, w, 1)", "");
    let w = m.values(&[x])[0];
    let along = &m.along(&[x], &[1.0])[0];
    close(along.gradient[0], w / (x * (1.0 + w)), 1e-14, "W'");
    let second = -(w * w) * (w + 2.0) / (x * x * (1.0 + w).powi(3));
    close(along.second[0], second, 1e-13, "W''");
    let third = w.powi(3) * (2.0 * w * w + 8.0 * w + 9.0) / (x.powi(3) * (1.0 + w).powi(5));
    close(along.third[0], third, 1e-12, "W'''");
    // Cardano: z³ + x z = y, one real root for x > 0.
    against("solve(z^3 + x * z == y, z, 1)", [0.9, 1.3], |[x, y]| {
        let root = ((y * 0.5).powi(2) + (x / 3.0).powi(3)).sqrt();
        (y * 0.5 + root).cbrt() - (root - y * 0.5).cbrt()
    });
    // The unknown beside the inputs further on, and a parameter that is computed outside.
    against(
        "z = solve(z * z == x + y, z, 1); z * x",
        [0.9, 1.3],
        |[x, y]| (x + y).sqrt() * x,
    );
    against(
        "solve(solve(v^3 == u, v, 1) == x * y, u, 2)",
        [0.9, 1.3],
        |[x, y]| (x * y).powi(3),
    );
}

#[test]
fn derivatives_keep_away_from_what_is_not_chosen() {
    let m = model("x", "if(x > 0, sqrt(x), 0) + if(x > 0, 1 / x, 2 * x)", "");
    assert_eq!(m.gradients(&[0.0])[(0, 0)], 2.0);
    let m = model("x s", "quantize(x, 0.1) + round(s)", "");
    assert_eq!(m.gradients(&[0.33, 2.2]).as_slice(), [1.0, 0.0]);
}

#[test]
fn gradient_of_a_square_at_a_dual_point() {
    let gradient = model("x", "x^2 / (1 + x)", "").gradients(&[0.7])[(0, 0)];
    let x = Dual64::new(0.7, 1.0);
    close(gradient, (x * x / (x + 1.0)).eps, 1e-15, "quotient");
}

/// Every derivative by a power of its own, also where quotients of powers would have no digits left.
#[test]
fn powers_of_small_large_and_negative_numbers() {
    let exponents = [
        -3.5, -2.0, -0.5, 0.3, 1.0, 1.5, 2.5, 3.0, 4.0, 5.0, 7.25, 100.0,
    ];
    for c in exponents {
        for x in [1e-310_f64, 3e-105, 1e-3, 0.7, 1.9, 44.0, 2e104, 1e307] {
            for x in [x, -x] {
                let found = power_derivatives(x, c);
                let factors = [1.0, c, c * (c - 1.0), c * (c - 1.0) * (c - 2.0)];
                for (k, (found, factor)) in found.into_iter().zip(factors).enumerate() {
                    let expected = match factor {
                        0.0 => 0.0,
                        _ => factor * libm::pow(x, c - k as f64),
                    };
                    let same = found == expected || found.is_nan() && expected.is_nan();
                    // The exponent c - k is rounded, too.
                    let rounding = 4e-16 * (5.0 + x.abs().ln().abs());
                    let near = (found - expected).abs() <= rounding * expected.abs();
                    // Numbers below the normal ones have few digits.
                    let small = found.abs().max(expected.abs()) < 1e-300;
                    assert!(same || near || small, "{x}^{c}, {k}: {found} {expected}");
                }
            }
        }
    }
    assert_eq!(power_derivatives(0.0, 1.5)[..2], [0.0, 0.0]);
    assert_eq!(power_derivatives(0.0, 3.0), [0.0, 0.0, 0.0, 6.0]);
    // Whole numbers stay whole.
    for x in (2..200).map(f64::from) {
        let expected = [x * x * x * x, 4.0 * x * x * x, 12.0 * x * x, 24.0 * x];
        assert_eq!(power_derivatives(x, 4.0), expected);
        assert_eq!(power_derivatives(x, 5.0)[1], 5.0 * x * x * x * x);
    }
    // The value is the same with derivatives and without.
    for x in (0..3000).map(|i| f64::from(i) / 10.0) {
        assert_eq!(power_derivatives(x, 3.0)[0], power(x, 3.0));
    }
}

#[test]
fn nothing_to_some_power_stays_nothing_whatever_the_power() {
    // Without a dose the response does not depend on the slope of its curve, nor on where it is half.
    let model = model("x y", "7.5 / (1 + (0*y / y)^x)", "");
    let point = [2.4, 3.1];
    assert_eq!(model.values(&point), [7.5]);
    assert_eq!(model.gradients(&point).as_slice(), [0.0, 0.0]);
    let along = &model.along(&point, &[1.0, 0.7])[0];
    for derivatives in [&along.gradient, &along.second, &along.third] {
        assert_eq!(derivatives[..], [0.0, 0.0]);
    }
}

#[test]
fn parts_of_a_formula_have_the_derivatives_of_the_whole() {
    // Of the operations some are made of little, some of nearly everything.
    let graph = model("x[100]", "exp(mean(x)) / x[3] + sd(x)", "").graph;
    let x: Vec<f64> = (0..100).map(|i| 1.0 + 0.01 * f64::from(i)).collect();
    let values = graph.evaluate(&points(&x));
    for of in 0..graph.ops.len() as u32 {
        let whole = graph.gradient(&values, of, x.len());
        let mut part = vec![Jet::constant(0.0); x.len()];
        for (place, slope) in graph.gradient_of_part(&values, of) {
            part[place] = slope;
        }
        assert_eq!(part, whole);
    }
}
