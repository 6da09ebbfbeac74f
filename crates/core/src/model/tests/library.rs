//! Complex quantities, vectors in space, curves, quantiles.

use super::*;
use crate::model::{Notice, Office};
use std::f64::consts::PI;

/// The elements of a vector-valued Y.
fn elements(inputs: &str, text: &str, wanted: &str, x: &[f64]) -> Vec<f64> {
    model(inputs, text, wanted).values(x)
}

fn near(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (f, e) in found.iter().zip(expected) {
        assert!(
            (f - e).abs() <= 1e-14 * e.abs().max(1.0),
            "{what}: {found:?}"
        );
    }
}

fn refused(inputs: &str, text: &str, wanted: &str) -> String {
    let faults = try_model(inputs, text, wanted).expect_err(text);
    faults
        .iter()
        .map(|f| format!("{}; {}", f.fault.message, f.fault.label))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn complex_arithmetic() {
    let of = |text: &str, wanted: &str| {
        elements(
            "a[2]:V b[2]:A r:ohm",
            text,
            wanted,
            &[3.0, 4.0, 1.0, -2.0, 5.0],
        )
    };
    near(&of("cmul(a, b)", "W"), &[11.0, -2.0], "(3+4i)(1-2i)");
    near(&of("cdiv(a, b)", "ohm"), &[-1.0, 2.0], "(3+4i)/(1-2i)");
    near(&of("cdiv(a, b) + [r, 0]", "ohm"), &[4.0, 2.0], "sum");
    near(&of("cdiv(1, b)", "1/A"), &[0.2, 0.4], "reciprocal");
    near(&of("conj(a)", "mV"), &[3000.0, -4000.0], "conjugate");
    near(&of("cabs(a)", "V"), &[5.0], "modulus");
    near(
        &of("carg(a)", "°"),
        &[(4f64).atan2(3.0).to_degrees()],
        "phase",
    );
    near(
        &of("csqrt(cmul(a, a))", "V"),
        &[3.0, 4.0],
        "root of the square",
    );
    near(
        &of("csqrt([-4, 0] + 0 * value_in(a, 'V'))", ""),
        &[0.0, 2.0],
        "root of -4",
    );
    near(&of("cexp([0, 90 '°'])", ""), &[0.0, 1.0], "quarter turn");
    near(
        &of("polar(2 * r, 180 '°')", "ohm"),
        &[-10.0, 0.0],
        "half turn",
    );
    near(
        &of("polar(cabs(a), carg(a)) - a", "V"),
        &[0.0, 0.0],
        "there and back",
    );
    assert!(refused("a[3]", "conj(a)", "").contains("`a` has 3 elements"));
    assert!(refused("a[2]:m", "cexp(a)", "").contains("`cexp` needs a number"));
}

#[test]
fn complex_derivatives_are_those_of_the_quotient() {
    // z = a/b: ∂z/∂a = 1/b, so that ∂Re/∂a_re = Re(1/b), ∂Im/∂a_re = Im(1/b).
    let m = model("a[2] b[2]", "cdiv(a, b)", "");
    let slopes = m.gradients(&[3.0, 4.0, 1.0, -2.0]);
    let expected = [
        [0.2, -0.4, 0.2 * -(-1.0) - 0.4 * -2.0, 0.0],
        [0.4, 0.2, 0.0, 0.0],
    ];
    // ∂z/∂b = -z/b = -(-1+2i)(0.2+0.4i) = 1 + 0i.
    for (i, row) in expected.iter().enumerate() {
        close(slopes[(i, 0)], row[0], 1e-14, "by a_re");
        close(slopes[(i, 1)], row[1], 1e-14, "by a_im");
    }
    for (place, expected) in [((0, 2), 1.0), ((1, 2), 0.0), ((0, 3), 0.0), ((1, 3), 1.0)] {
        close(slopes[place], expected, 1e-14, "by b");
    }
}

#[test]
fn a_vector_gives_one_result_per_element() {
    let m = model("a[2]:V b:A", "Z = a / b", "ohm");
    let names: Vec<&str> = m.outputs().iter().map(|o| o.name.as_str()).collect();
    assert_eq!(names, ["Y[1]", "Y[2]"]);
    assert!(m.outputs().iter().all(|o| o.source == 0));
    assert_eq!(m.values(&[4.0, 6.0, 2.0]), [2.0, 3.0]);
    // Blocks agree.
    let blocks = [4.0, 6.0, 2.0].map(|v| Block([v; LANES]));
    let mut out = [Block::ZERO, Block::ZERO];
    BlockRunner::new(&m).run(&blocks, &mut out);
    assert_eq!([out[0].0[7], out[1].0[7]], [2.0, 3.0]);
    assert!(refused("x", "x * linspace(0, 1, 101)", "").contains("vector of 101 elements"));
}

#[test]
fn rotations_and_products_in_space() {
    let of = |text: &str| elements("x y z w", text, "", &[1.0, 2.0, 3.0, 0.3]);
    near(
        &of("cross([x, y, z], [0, 0, 1])"),
        &[2.0, -1.0, 0.0],
        "cross",
    );
    near(
        &of("rotate_z([x, 0, 0], 90 '°')"),
        &[0.0, 1.0, 0.0],
        "x to y",
    );
    near(
        &of("rotate_x([0, x, 0], 90 '°')"),
        &[0.0, 0.0, 1.0],
        "y to z",
    );
    near(
        &of("rotate_y([0, 0, x], 90 '°')"),
        &[1.0, 0.0, 0.0],
        "z to x",
    );
    near(
        &of("norm(rotate_x(rotate_y([x, y, z], w), 2 * w)) / norm([x, y, z])"),
        &[1.0],
        "length",
    );
    near(
        &of("rotate_y(rotate_y([x, y, z], w), -w)"),
        &[1.0, 2.0, 3.0],
        "back",
    );
    let m = elements(
        "a[3]:mm",
        "rotate_z(a, 30 '°')[1]",
        "m",
        &[1000.0, 0.0, 0.0],
    );
    near(&m, &[(PI / 6.0).cos()], "units");
    assert!(refused("a[2]", "cross(a, a)", "").contains("`a` has 2 elements"));
    assert!(refused("a", "rotate_x(a, 1)", "").contains("`a` is a single value"));
    assert!(refused("a[3] l:m", "rotate_x(a, l)", "").contains("the angle of `rotate_x`"));
}

#[test]
fn curves() {
    near(
        &elements("a", "linspace(a, 3, 5)", "", &[1.0]),
        &[1.0, 1.5, 2.0, 2.5, 3.0],
        "linspace",
    );
    near(
        &elements("c[3] x", "polyval(c, x)", "", &[1.0, -2.0, 3.0, 4.0]),
        &[41.0],
        "polynomial",
    );
    // Coefficients with units of their own: 100 Ω (1 + 3.9083e-3 t - 5.775e-7 t²).
    let platinum = "R0 * polyval([1, A, B], t - 0 '°C')";
    near(
        &elements(
            "R0:ohm A:1/K B:1/K^2 t:°C",
            platinum,
            "ohm",
            &[100.0, 3.9083e-3, -5.775e-7, 100.0],
        ),
        &[138.5055],
        "platinum",
    );
    assert!(refused("A:1/K x:m", "polyval([1, A], x)", "").contains("do not go together"));
    assert!(refused("t:°C", "polyval([1, 2], t)", "").contains("°C"));
    near(
        &elements("x", "polyval([0, 0, 2], x)", "", &[3.0]),
        &[18.0],
        "zeros fit",
    );
    near(
        &elements("x p:%", "polyval([p, 1], x)", "%", &[0.5, 50.0]),
        &[100.0],
        "percent",
    );
}

#[test]
fn tables_are_broken_lines() {
    let table = "interpolate(t, [0 '°C', 20 '°C', 50 '°C'], c)";
    let of = |t: f64| elements("t:°C c[3]:mK", table, "K", &[t, 10.0, 30.0, 0.0])[0];
    for (t, mk) in [
        (0.0, 10.0),
        (5.0, 15.0),
        (20.0, 30.0),
        (35.0, 15.0),
        (50.0, 0.0),
        (53.0, -3.0),
    ] {
        close(of(t), mk * 1e-3, 1e-14, &format!("at {t}"));
    }
    close(
        value("t:°C c[3]:mK", table, "mK", &[35.0, 10.0, 30.0, 0.0]),
        15.0,
        1e-14,
        "block",
    );
    let m = model("t:°C c[3]:mK", table, "mK");
    let slopes = m.gradients(&[35.0, 10.0, 30.0, 0.0]);
    for (k, expected) in [-1.0, 0.0, 0.5, 0.5].into_iter().enumerate() {
        close(slopes[(0, k)], expected, 1e-14, "slopes");
    }
    let notices = |t: f64| m.irregularities(&[t, 10.0, 30.0, 0.0]);
    assert_eq!(notices(35.0), []);
    assert!(matches!(
        notices(20.0)[..],
        [Notice::Condition { .. }] | [Notice::Knot { .. }]
    ));
    assert!(matches!(
        notices(51.0)[..],
        [Notice::BeyondTable {
            at: 51.0,
            ends: [0.0, 50.0],
            ..
        }]
    ));
    assert!(refused("x y[2]", "interpolate(x, [2, 1], y)", "").contains("does not rise"));
    assert!(refused("x k[2] y[2]", "interpolate(x, k, y)", "").contains("`k` depends on inputs"));
    assert!(refused("x y[2]", "interpolate(x, [1, 2, 3], y)", "").contains("3"));
}

#[test]
fn quantiles_of_exact_numbers() {
    let of = |text: &str| value("x", &format!("{text} + 0 * x"), "", &[1.0]);
    // Tables of the t, χ² and F distributions.
    close(of("t_quantile(0.975, 9)"), 2.262_157_162_8, 1e-10, "t");
    close(
        of("chi_squared_quantile(95 '%', 10)"),
        18.307_038_053_3,
        1e-10,
        "χ²",
    );
    close(of("f_quantile(0.95, 3, 12)"), 3.490_294_819_5, 1e-10, "F");
    close(
        of("normal_quantile(0.975)"),
        1.959_963_984_54,
        1e-11,
        "normal",
    );
    close(of("gamma_function(5)"), 24.0, 1e-14, "Γ");
    close(of("ln_gamma(0.5)"), 0.5 * PI.ln(), 1e-14, "ln Γ");
    close(
        of("sum(t_quantile([0.9, 0.975], 9))"),
        1.383_028_738_4 + 2.262_157_162_8,
        1e-10,
        "vector",
    );
    assert!(refused("x", "t_quantile(0.975, x)", "").contains("`x` depends on inputs"));
    assert!(refused("x", "x * t_quantile(9, 0.975)", "").contains("expected 0 < p < 1"));
    close(
        value("x", "normal_cdf(x)", "", &[1.0]),
        0.841_344_746_068_5,
        1e-12,
        "Φ",
    );
    close(
        value("p", "normal_cdf(normal_quantile(p))", "", &[0.2]),
        0.2,
        1e-13,
        "Φ∘Φ⁻¹",
    );
}

#[test]
fn derivatives_of_the_normal_distribution() {
    // x = Φ⁻¹(p) has x' = 1/φ(x), and Φ its inverse: all derivatives of Φ⁻¹(Φ(x)) are those of x.
    let m = model("x", "normal_quantile(normal_cdf(x))", "");
    for x in [-1.7, 0.3, 2.1] {
        let along = &m.along(&[x], &[1.0])[0];
        close(along.gradient[0], 1.0, 1e-12, "first");
        close(along.second[0] + 1.0, 1.0, 1e-11, "second");
        close(along.third[0] + 1.0, 1.0, 1e-10, "third");
    }
    let m = model("x", "normal_cdf(x)", "");
    let along = &m.along(&[0.5], &[1.0])[0];
    let density = 0.352_065_326_764_3;
    close(along.gradient[0], density, 1e-12, "φ");
    close(along.second[0], -0.5 * density, 1e-12, "φ'");
    close(along.third[0], -0.75 * density, 1e-12, "φ''");
}

#[test]
fn phases_near_the_jump_and_coarse_steps_are_noticed() {
    let m = model("y x", "atan2(y, x)", "");
    let at = |y: f64, x: f64, u: f64| m.near_singular(&[y, x], &[u, u], 4.0);
    assert!(
        matches!(&at(0.1, -1.0, 0.05)[..], [Notice::Wrap { call, distance }]
        if call == "atan2(y, x)" && (distance - 2.0).abs() < 0.02)
    );
    assert_eq!(at(0.1, -1.0, 0.01), []);
    assert_eq!(at(0.1, 1.0, 0.05), []);
    let m = model("z[2]", "carg(z)", "°");
    assert!(matches!(
        m.near_singular(&[-1.0, 0.1], &[0.05; 2], 4.0)[..],
        [Notice::Wrap { .. }]
    ));
    let m = model("x", "quantize(x, 0.1)", "");
    assert_eq!(m.coarse_steps(&[1.0], &[0.2]), []);
    assert!(
        matches!(m.coarse_steps(&[1.0], &[0.04])[..], [Notice::CoarseStep { ratio, .. }] if (ratio - 2.5).abs() < 1e-12)
    );
    let m = model("x", "1 / x", "");
    assert!(matches!(
        m.near_singular(&[1.0], &[0.5], 4.0)[..],
        [Notice::Near {
            role: Office::Divisor,
            ..
        }]
    ));
}

#[test]
fn long_formulas_are_read_in_linear_time() {
    let names: Vec<String> = (0..20_000).map(|i| format!("x * {}", i % 7)).collect();
    let begin = std::time::Instant::now();
    let sum = value("x", &names.join(" + "), "", &[1.0]);
    close(
        sum,
        (0..20_000).map(|i| f64::from(i % 7)).sum(),
        1e-13,
        "sum",
    );
    let list: Vec<String> = (0..5_000).map(|i| format!("{i} * x")).collect();
    close(
        value("x", &format!("max({})", list.join(", ")), "", &[1.0]),
        4999.0,
        1e-13,
        "max",
    );
    assert!(begin.elapsed().as_secs() < 5, "{:?}", begin.elapsed());
}
