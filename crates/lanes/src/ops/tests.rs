use super::*;
use crate::testing::{awkward, same, same_on_all_levels};
use crate::{Generator, level};

/// Name, operation on blocks, function on numbers.
type Unary = (&'static str, fn(Level, &Block, &mut Block), fn(f64) -> f64);
type Binary = (
    &'static str,
    fn(Level, &Block, &Block, &mut Block),
    fn(f64, f64) -> f64,
);

const UNARY: [Unary; 30] = [
    ("neg", neg, |a| -a),
    ("abs", abs, f64::abs),
    ("sqrt", sqrt, f64::sqrt),
    ("sq", sq, |a| a * a),
    ("sign", sign, |a| {
        if a == 0.0 || a.is_nan() {
            a
        } else {
            a.signum()
        }
    }),
    ("not", not, |a| f64::from(a == 0.0)),
    ("floor", floor, libm::floor),
    ("ceil", ceil, libm::ceil),
    ("round", round, libm::round),
    ("exp", exp, elementary::exp),
    ("expm1", expm1, elementary::expm1),
    ("ln", ln, elementary::ln),
    ("sin", sin, elementary::sin),
    ("cos", cos, elementary::cos),
    ("cbrt", cbrt, libm::cbrt),
    ("log10", log10, libm::log10),
    ("log2", log2, libm::log2),
    ("tan", tan, libm::tan),
    ("asin", asin, libm::asin),
    ("acos", acos, libm::acos),
    ("atan", atan, libm::atan),
    ("sinh", sinh, libm::sinh),
    ("cosh", cosh, libm::cosh),
    ("tanh", tanh, libm::tanh),
    ("asinh", asinh, libm::asinh),
    ("acosh", acosh, libm::acosh),
    ("atanh", atanh, libm::atanh),
    ("copy", copy, |a| a),
    ("cube", |l, a, out| powi(l, a, 3, out), |a| a * (a * a)),
    (
        "inverse square",
        |l, a, out| powi(l, a, -2, out),
        |a| 1.0 / (a * a),
    ),
];

const BINARY: [Binary; 19] = [
    ("add", add, |a, b| a + b),
    ("sub", sub, |a, b| a - b),
    ("mul", mul, |a, b| a * b),
    ("div", div, |a, b| a / b),
    ("min", min, |a, b| {
        if a.is_nan() || b.is_nan() {
            f64::NAN
        } else if a < b {
            a
        } else {
            b
        }
    }),
    ("max", max, |a, b| {
        if a.is_nan() || b.is_nan() {
            f64::NAN
        } else if a > b {
            a
        } else {
            b
        }
    }),
    ("lt", lt, |a, b| f64::from(a < b)),
    ("le", le, |a, b| f64::from(a <= b)),
    ("gt", gt, |a, b| f64::from(a > b)),
    ("ge", ge, |a, b| f64::from(a >= b)),
    ("eq", eq, |a, b| f64::from(a == b)),
    ("ne", ne, |a, b| f64::from(a != b)),
    ("and", and, |a, b| f64::from(a != 0.0 && b != 0.0)),
    ("or", or, |a, b| f64::from(a != 0.0 || b != 0.0)),
    ("atan2", atan2, libm::atan2),
    ("hypot", hypot, libm::hypot),
    ("pow", pow, libm::pow),
    (
        "axpy",
        |l, a, b, out| {
            *out = *b;
            axpy(l, 0.3, a, out)
        },
        |a, b| a.mul_add(0.3, b),
    ),
    (
        "scale",
        |l, a, _, out| {
            *out = *a;
            scale(l, 0.3, out)
        },
        |a, _| 0.3 * a,
    ),
];

/// Blocks of ordinary numbers, of both signs.
fn ordinary(stream: u64) -> Block {
    let mut block = Block::ZERO;
    Generator::new(5, 0, stream).uniforms(level(), &mut block);
    block.0 = block.0.map(|u| 40.0 * u - 20.0);
    block
}

/// The block with its lanes moved on, so that each meets another partner.
fn moved(a: &Block, by: usize) -> Block {
    let mut b = *a;
    b.0.rotate_left(by);
    b
}

#[test]
fn unary_operations_do_in_every_lane_what_the_function_does() {
    for a in [awkward(), ordinary(0)] {
        for (name, operation, function) in UNARY {
            same_on_all_levels(name, |level, out| operation(level, &a, out));
            let mut out = Block::ZERO;
            operation(level(), &a, &mut out);
            for (a, out) in a.0.iter().zip(out.0) {
                assert!(same(out, function(*a)), "{name}({a:e}) = {out:e}");
            }
        }
    }
}

#[test]
fn binary_operations_do_in_every_lane_what_the_function_does() {
    for (a, shifts) in [(awkward(), 64), (ordinary(1), 2)] {
        for b in (0..shifts).map(|by| moved(&a, by)) {
            for (name, operation, function) in BINARY {
                same_on_all_levels(name, |level, out| operation(level, &a, &b, out));
                let mut out = Block::ZERO;
                operation(level(), &a, &b, &mut out);
                for ((a, b), out) in a.0.iter().zip(b.0).zip(out.0) {
                    assert!(same(out, function(*a, b)), "{name}({a:e}, {b:e}) = {out:e}");
                }
            }
        }
    }
}

#[test]
fn scalar_operands() {
    let a = ordinary(2);
    let mut out = Block::ZERO;
    for level in crate::levels() {
        add_scalar(level, &a, 3.0, &mut out);
        assert_eq!(out.0, a.0.map(|a| a + 3.0));
        mul_scalar(level, &a, 3.0, &mut out);
        assert_eq!(out.0, a.0.map(|a| a * 3.0));
        rsub_scalar(level, &a, 3.0, &mut out);
        assert_eq!(out.0, a.0.map(|a| 3.0 - a));
        rdiv_scalar(level, &a, 3.0, &mut out);
        assert_eq!(out.0, a.0.map(|a| 3.0 / a));
        affine(level, &a, 0.3, 0.7, &mut out);
        assert_eq!(out.0, a.0.map(|a| a.mul_add(0.3, 0.7)));
        fill(level, 3.0, &mut out);
        assert_eq!(out.0, [3.0; LANES]);
    }
}

#[test]
fn mul_add_rounds_once() {
    let (a, b) = (ordinary(3), ordinary(4));
    let mut product = Block::ZERO;
    mul(level(), &a, &b, &mut product);
    let mut minus = Block::ZERO;
    neg(level(), &product, &mut minus);
    same_on_all_levels("mul_add", |level, out| mul_add(level, &a, &b, &minus, out));
    let mut rest = Block::ZERO;
    mul_add(level(), &a, &b, &minus, &mut rest);
    // What a·b loses in rounding is below half a place of it, and seldom zero.
    assert!(
        rest.0
            .iter()
            .zip(product.0)
            .all(|(r, p)| r.abs() <= p.abs() * f64::EPSILON / 2.0)
    );
    assert!(rest.0.iter().filter(|r| **r != 0.0).count() > 200);
}

#[test]
fn select_follows_the_condition() {
    let mut condition = Block::ZERO;
    for (lane, c) in condition.0.iter_mut().enumerate() {
        *c = [0.0, 1.0, f64::NAN, -0.0][lane % 4];
    }
    let (a, b) = (Block([1.0; LANES]), Block([2.0; LANES]));
    same_on_all_levels("select", |level, out| {
        select(level, &condition, &a, &b, out)
    });
    let mut out = Block::ZERO;
    select(level(), &condition, &a, &b, &mut out);
    assert_eq!(out.0[..2], [2.0, 1.0]);
    assert!(out.0[2].is_nan());
    assert_eq!(out.0[3], 2.0);
}

#[test]
fn whole_powers() {
    let a = ordinary(6);
    let mut out = Block::ZERO;
    for n in -40..=40 {
        powi(level(), &a, n, &mut out);
        for (a, out) in a.0.iter().zip(out.0) {
            let expected = libm::pow(*a, f64::from(n));
            assert!(
                (out - expected).abs() <= 9.0 * f64::EPSILON * expected.abs(),
                "{a}^{n}"
            );
        }
    }
    for n in [i32::MIN, i32::MAX] {
        powi(level(), &Block([1.0; LANES]), n, &mut out);
        assert_eq!(out.0, [1.0; LANES]);
    }
    powi(level(), &Block([-0.0; LANES]), -1, &mut out);
    assert_eq!(out.0, [f64::NEG_INFINITY; LANES]);
}
