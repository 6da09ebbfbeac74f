//! Arithmetic and functions on whole blocks.
//!
//! Every operation has the form `op(level, operands…, out)`. Operations that the compiler can
//! vectorise are dispatched on the level; the rarer functions run lane by lane through `libm`, and
//! take the level only so that all have one form.
//!
//! NaN in an operand gives NaN in the result, in [`min`], [`max`] and the condition of [`select`]
//! too: a trial that failed anywhere stays visible to the end. Only comparisons answer NaN with
//! 0 (1 for [`ne`]), as IEEE 754 does.

use fearless_simd::{Level, dispatch};

use crate::elementary;
use crate::{Block, LANES};

#[inline(always)]
fn map(a: &Block, out: &mut Block, f: impl Fn(f64) -> f64) {
    for (out, &a) in out.0.iter_mut().zip(&a.0) {
        *out = f(a);
    }
}

#[inline(always)]
fn map2(a: &Block, b: &Block, out: &mut Block, f: impl Fn(f64, f64) -> f64) {
    for ((out, &a), &b) in out.0.iter_mut().zip(&a.0).zip(&b.0) {
        *out = f(a, b);
    }
}

#[inline(always)]
fn map3(a: &Block, b: &Block, c: &Block, out: &mut Block, f: impl Fn(f64, f64, f64) -> f64) {
    for (((out, &a), &b), &c) in out.0.iter_mut().zip(&a.0).zip(&b.0).zip(&c.0) {
        *out = f(a, b, c);
    }
}

/// `name(level, a, out)`, vectorised.
macro_rules! unary {
    ($($(#[$doc:meta])+ $name:ident = |$a:ident| $body:expr;)+) => {$(
        $(#[$doc])+
        pub fn $name(level: Level, a: &Block, out: &mut Block) {
            dispatch!(level, _ => map(a, out, #[inline(always)] |$a: f64| $body))
        }
    )+};
}

/// `name(level, a, b, out)`, vectorised.
macro_rules! binary {
    ($($(#[$doc:meta])+ $name:ident = |$a:ident, $b:ident| $body:expr;)+) => {$(
        $(#[$doc])+
        pub fn $name(level: Level, a: &Block, b: &Block, out: &mut Block) {
            dispatch!(level, _ => map2(a, b, out, #[inline(always)] |$a: f64, $b: f64| $body))
        }
    )+};
}

/// `name(level, a, s, out)` with a number s, vectorised.
macro_rules! scalar {
    ($($(#[$doc:meta])+ $name:ident = |$a:ident, $s:ident| $body:expr;)+) => {$(
        $(#[$doc])+
        pub fn $name(level: Level, a: &Block, $s: f64, out: &mut Block) {
            dispatch!(level, _ => map(a, out, #[inline(always)] |$a: f64| $body))
        }
    )+};
}

/// `name(level, a, out)` through a function of `libm`, lane by lane.
macro_rules! unary_libm {
    ($($(#[$doc:meta])+ $name:ident = $function:path;)+) => {$(
        $(#[$doc])+
        pub fn $name(_: Level, a: &Block, out: &mut Block) {
            map(a, out, $function)
        }
    )+};
}

/// `name(level, a, b, out)` through a function of `libm`, lane by lane.
macro_rules! binary_libm {
    ($($(#[$doc:meta])+ $name:ident = $function:path;)+) => {$(
        $(#[$doc])+
        pub fn $name(_: Level, a: &Block, b: &Block, out: &mut Block) {
            map2(a, b, out, $function)
        }
    )+};
}

/// 1 for true, 0 for false.
#[inline(always)]
fn truth(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

binary! {
    /// a + b.
    add = |a, b| a + b;
    /// a − b.
    sub = |a, b| a - b;
    /// a·b.
    mul = |a, b| a * b;
    /// a/b.
    div = |a, b| a / b;
    /// The smaller; NaN if either is NaN.
    min = |a, b| if a < b || a.is_nan() { a } else { b };
    /// The larger; NaN if either is NaN.
    max = |a, b| if a > b || a.is_nan() { a } else { b };
    /// 1 where a < b, otherwise 0.
    lt = |a, b| truth(a < b);
    /// 1 where a ≤ b, otherwise 0.
    le = |a, b| truth(a <= b);
    /// 1 where a > b, otherwise 0.
    gt = |a, b| truth(a > b);
    /// 1 where a ≥ b, otherwise 0.
    ge = |a, b| truth(a >= b);
    /// 1 where a = b, otherwise 0.
    eq = |a, b| truth(a == b);
    /// 1 where a ≠ b, otherwise 0.
    ne = |a, b| truth(a != b);
    /// 1 where both are true (not 0), otherwise 0.
    and = |a, b| truth(a != 0.0 && b != 0.0);
    /// 1 where one at least is true (not 0), otherwise 0.
    or = |a, b| truth(a != 0.0 || b != 0.0);
}

scalar! {
    /// a + s.
    add_scalar = |a, s| a + s;
    /// a·s.
    mul_scalar = |a, s| a * s;
    /// s − a.
    rsub_scalar = |a, s| s - a;
    /// s/a.
    rdiv_scalar = |a, s| s / a;
}

unary! {
    /// −a.
    neg = |a| -a;
    /// |a|.
    abs = |a| a.abs();
    /// √a; NaN below zero.
    sqrt = |a| a.sqrt();
    /// a².
    sq = |a| a * a;
    /// a³.
    cube = |a| a * (a * a);
    /// a⁴.
    fourth_power = |a| { let square = a * a; square * square };
    /// −1, 0 or 1 as a is negative, zero or positive.
    sign = |a| if a > 0.0 { 1.0 } else if a < 0.0 { -1.0 } else { a };
    /// 1 where a is 0, otherwise 0.
    not = |a| truth(a == 0.0);
    /// The largest integer that is not above a.
    floor = |a| a.floor();
    /// The smallest integer that is not below a.
    ceil = |a| a.ceil();
    /// The nearest integer; halves go away from zero.
    round = |a| a.round();
    /// eᵃ; see [`elementary::exp`].
    exp = |a| elementary::exp(a);
    /// eᵃ − 1, accurate for small a; see [`elementary::expm1`].
    expm1 = |a| elementary::expm1(a);
    /// The natural logarithm; see [`elementary::ln`].
    ln = |a| elementary::ln(a);
}

unary_libm! {
    /// The real cube root.
    cbrt = libm::cbrt;
    /// The logarithm to base 10.
    log10 = libm::log10;
    /// The logarithm to base 2.
    log2 = libm::log2;
    /// The tangent.
    tan = libm::tan;
    /// The inverse sine; NaN outside −1 … 1.
    asin = libm::asin;
    /// The inverse cosine; NaN outside −1 … 1.
    acos = libm::acos;
    /// The inverse tangent.
    atan = libm::atan;
    /// The hyperbolic sine.
    sinh = libm::sinh;
    /// The hyperbolic cosine.
    cosh = libm::cosh;
    /// The hyperbolic tangent.
    tanh = libm::tanh;
    /// The inverse hyperbolic sine.
    asinh = libm::asinh;
    /// The inverse hyperbolic cosine; NaN below 1.
    acosh = libm::acosh;
    /// The inverse hyperbolic tangent; NaN outside −1 … 1.
    atanh = libm::atanh;
}

binary_libm! {
    /// The angle of the point (b, a), −π … π: the inverse tangent of a/b in the right quadrant.
    atan2 = libm::atan2;
    /// √(a² + b²) without overflow on the way.
    hypot = libm::hypot;
    /// a to the power b.
    pow = libm::pow;
}

/// a·b + c with one rounding.
pub fn mul_add(level: Level, a: &Block, b: &Block, c: &Block, out: &mut Block) {
    dispatch!(level, _ => {
        map3(a, b, c, out, #[inline(always)] |a: f64, b: f64, c: f64| a.mul_add(b, c))
    })
}

/// s·a + c with one rounding.
pub fn affine(level: Level, a: &Block, s: f64, c: f64, out: &mut Block) {
    dispatch!(level, _ => map(a, out, #[inline(always)] |a: f64| a.mul_add(s, c)))
}

/// `out` ← `out` + s·a, each lane with one rounding.
pub fn axpy(level: Level, s: f64, a: &Block, out: &mut Block) {
    dispatch!(level, _ => {
        for (out, &a) in out.0.iter_mut().zip(&a.0) {
            *out = a.mul_add(s, *out);
        }
    })
}

/// `out` ← s·`out`.
pub fn scale(level: Level, s: f64, out: &mut Block) {
    dispatch!(level, _ => out.0.iter_mut().for_each(#[inline(always)] |out| *out *= s))
}

/// `a` where the condition is true (not 0), `b` where it is 0, NaN where it is NaN.
pub fn select(level: Level, condition: &Block, a: &Block, b: &Block, out: &mut Block) {
    #[inline(always)]
    fn pick(condition: f64, a: f64, b: f64) -> f64 {
        let picked = if condition == 0.0 { b } else { a };
        if condition.is_nan() {
            condition
        } else {
            picked
        }
    }
    dispatch!(level, _ => map3(condition, a, b, out, pick))
}

/// sin a; see [`elementary::sin`].
pub fn sin(level: Level, a: &Block, out: &mut Block) {
    dispatch!(level, _ => map(a, out, elementary::sin_reducible));
    mend_large(a, out, libm::sin);
}

/// cos a; see [`elementary::cos`].
pub fn cos(level: Level, a: &Block, out: &mut Block) {
    dispatch!(level, _ => map(a, out, elementary::cos_reducible));
    mend_large(a, out, libm::cos);
}

/// Replaces the lanes that the vector range reduction cannot take.
fn mend_large(a: &Block, out: &mut Block, function: fn(f64) -> f64) {
    for (out, &a) in out.0.iter_mut().zip(&a.0) {
        if a.abs() > elementary::REDUCIBLE {
            *out = function(a);
        }
    }
}

/// Largest |n| that [`powi`] multiplies out.
const MULTIPLIED: u32 = 16;

/// a to a whole power.
///
/// Repeated squaring up to |n| = 16, whose error is below |n|/2 ulp; `libm` beyond.
pub fn powi(level: Level, a: &Block, n: i32, out: &mut Block) {
    if n.unsigned_abs() > MULTIPLIED {
        map(a, out, |a| libm::pow(a, f64::from(n)));
        return;
    }
    match n {
        // As below, in one pass.
        1 => return copy(level, a, out),
        2 => return sq(level, a, out),
        3 => return cube(level, a, out),
        4 => return fourth_power(level, a, out),
        _ => fill(level, 1.0, out),
    }
    let mut square = *a;
    let mut rest = n.unsigned_abs();
    dispatch!(level, _ => while rest != 0 {
        for (out, square) in out.0.iter_mut().zip(&mut square.0) {
            *out *= if rest & 1 == 1 { *square } else { 1.0 };
            *square *= *square;
        }
        rest >>= 1;
    });
    if n < 0 {
        let power = *out;
        rdiv_scalar(level, &power, 1.0, out);
    }
}

/// `out` ← a.
pub fn copy(_: Level, a: &Block, out: &mut Block) {
    *out = *a;
}

/// `out` ← s in every lane.
pub fn fill(_: Level, s: f64, out: &mut Block) {
    out.0 = [s; LANES];
}

#[cfg(test)]
mod tests;
