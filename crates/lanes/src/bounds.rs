//! Bounds of what a model does within the uncertainties of its inputs: upward, operation by operation, without any
//! derivative of the whole.
//!
//! With u_k the standard uncertainty of input k, which are independent, and v a value with the derivatives v_k, v_kl,
//! v_klm, a block of [`Bounds`] holds numbers that are not less than
//!
//! | | |
//! |---|---|
//! | `first` | √Σ_k (v_k u_k)² |
//! | `diagonal` | Σ_k \|v_kk\| u_k² |
//! | `second` | √Σ_kl (v_kl u_k u_l)² |
//! | `third` | √Σ_k (Σ_l \|v_kll\| u_k u_l²)² |
//!
//! They follow from the chain and product rules with the triangle inequality and that of Cauchy and Schwarz. Values
//! *apart* from one another, which have no input in common, have vectors at right angles, and mixed terms are known exactly.
//! Products have the least normal number added, so that no bound is lost where they underflow.

use fearless_simd::{Level, dispatch};

use crate::{Block, LANES};

/// Bounds of 256 values.
#[derive(Debug, Clone)]
pub struct Bounds {
    /// Of the standard uncertainty.
    pub first: Block,
    /// Of the second derivatives, each input twice.
    pub diagonal: Block,
    /// Of all second derivatives.
    pub second: Block,
    /// Of third derivatives, one input twice.
    pub third: Block,
}

/// Those of one value.
#[derive(Clone, Copy)]
struct Bound {
    first: f64,
    diagonal: f64,
    second: f64,
    third: f64,
}

impl Bounds {
    /// Of values that do not move.
    pub const ZERO: Bounds = Bounds {
        first: Block::ZERO,
        diagonal: Block::ZERO,
        second: Block::ZERO,
        third: Block::ZERO,
    };

    #[inline(always)]
    fn at(&self, lane: usize) -> Bound {
        Bound {
            first: self.first.0[lane],
            diagonal: self.diagonal.0[lane],
            second: self.second.0[lane],
            third: self.third.0[lane],
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, bound: Bound) {
        self.first.0[lane] = bound.first;
        self.diagonal.0[lane] = bound.diagonal;
        self.second.0[lane] = bound.second;
        self.third.0[lane] = bound.third;
    }
}

/// A product that is not lost.
#[inline(always)]
fn times(a: f64, b: f64) -> f64 {
    a * b + f64::MIN_POSITIVE
}

/// The length of the sum of two vectors of these lengths. Whether they are at right angles is a constant of the loop:
/// with a branch in it, it is not vectorised.
#[inline(always)]
fn length<const APART: bool>(a: f64, b: f64) -> f64 {
    if !APART {
        return a + b;
    }
    // Of two that are both tiny the square is lost, the larger one is not.
    let larger = if a > b { a } else { b };
    let root = (a * a + b * b).sqrt();
    if root > larger { root } else { larger }
}

/// `out` ← bounds of a + b or a − b.
pub fn sum(level: Level, a: &Bounds, b: &Bounds, apart: bool, out: &mut Bounds) {
    match apart {
        true => sums::<true>(level, a, b, out),
        false => sums::<false>(level, a, b, out),
    }
}

fn sums<const APART: bool>(level: Level, a: &Bounds, b: &Bounds, out: &mut Bounds) {
    dispatch!(level, _ => for lane in 0..LANES {
        let (a, b) = (a.at(lane), b.at(lane));
        out.set(lane, Bound {
            first: length::<APART>(a.first, b.first),
            diagonal: a.diagonal + b.diagonal,
            second: length::<APART>(a.second, b.second),
            third: length::<APART>(a.third, b.third),
        });
    })
}

#[inline(always)]
fn product_of<const APART: bool>([x, y]: [f64; 2], a: Bound, b: Bound) -> Bound {
    let (x, y) = (x.abs(), y.abs());
    let mixed = times(a.first, b.first);
    let straight = length::<APART>(y * a.second, x * b.second);
    let more = times(a.first, b.diagonal) + times(b.first, a.diagonal);
    let third = length::<APART>(y * a.third, x * b.third) + more;
    let crossed = 2.0 * (times(a.second, b.first) + times(b.second, a.first));
    Bound {
        first: length::<APART>(y * a.first, x * b.first),
        diagonal: y * a.diagonal + x * b.diagonal + if APART { 0.0 } else { 2.0 * mixed },
        second: length::<APART>(
            straight,
            mixed * if APART { std::f64::consts::SQRT_2 } else { 2.0 },
        ),
        third: if APART { third } else { third + crossed },
    }
}

/// `out` ← bounds of the product of the values x.
pub fn product(
    level: Level,
    x: [&Block; 2],
    a: &Bounds,
    b: &Bounds,
    apart: bool,
    out: &mut Bounds,
) {
    match apart {
        true => products::<true>(level, x, a, b, out),
        false => products::<false>(level, x, a, b, out),
    }
}

fn products<const APART: bool>(
    level: Level,
    [x, y]: [&Block; 2],
    a: &Bounds,
    b: &Bounds,
    out: &mut Bounds,
) {
    dispatch!(level, _ => for lane in 0..LANES {
        let values = [x.0[lane], y.0[lane]];
        out.set(lane, product_of::<APART>(values, a.at(lane), b.at(lane)));
    })
}

#[inline(always)]
fn composed_of(slopes: [f64; 3], a: Bound) -> Bound {
    let [first, second, third] = slopes.map(f64::abs);
    let square = times(a.first, a.first);
    Bound {
        first: first * a.first,
        diagonal: first * a.diagonal + second * square,
        second: first * a.second + second * square,
        third: first * a.third
            + second * (2.0 * times(a.second, a.first) + times(a.first, a.diagonal))
            + third * times(square, a.first),
    }
}

/// `out` ← bounds of a function with these first three derivatives.
pub fn composed(level: Level, [f, g, h]: [&Block; 3], a: &Bounds, out: &mut Bounds) {
    dispatch!(level, _ => for lane in 0..LANES {
        let slopes = [f.0[lane], g.0[lane], h.0[lane]];
        out.set(lane, composed_of(slopes, a.at(lane)));
    })
}

/// `out` ← bounds of the quotient of the values x.
pub fn quotient(
    level: Level,
    x: [&Block; 2],
    a: &Bounds,
    b: &Bounds,
    apart: bool,
    out: &mut Bounds,
) {
    match apart {
        true => quotients::<true>(level, x, a, b, out),
        false => quotients::<false>(level, x, a, b, out),
    }
}

fn quotients<const APART: bool>(
    level: Level,
    [x, y]: [&Block; 2],
    a: &Bounds,
    b: &Bounds,
    out: &mut Bounds,
) {
    dispatch!(level, _ => for lane in 0..LANES {
        let r = 1.0 / y.0[lane];
        let r2 = r * r;
        let inverse = composed_of([r2, 2.0 * r2 * r, 6.0 * r2 * r2], b.at(lane));
        out.set(lane, product_of::<APART>([x.0[lane], r], a.at(lane), inverse));
    })
}

/// Marks in `doubt` by 1 the values that may be within `reach` standard uncertainties of an edge.
pub fn near(level: Level, x: &Block, edge: &Block, of: &Bounds, reach: f64, doubt: &mut Block) {
    // Beyond what rounding does to distance and bound.
    let reach = reach * (1.0 + 1e-9);
    dispatch!(level, _ => for lane in 0..LANES {
        let beyond = (x.0[lane] - edge.0[lane]).abs() > reach * of.first.0[lane];
        doubt.0[lane] = if beyond { doubt.0[lane] } else { 1.0 };
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::level;

    /// x·x/(1 + x) as if its parts were independent of one another, and as they are.
    #[test]
    fn bounds_are_not_less_than_the_derivatives() {
        let level = level();
        let block = |x: f64| Block([x; LANES]);
        let (x, u) = (0.7_f64, 0.1_f64);
        let input = Bounds {
            first: block(u),
            ..Bounds::ZERO
        };
        let [mut square, mut whole] = [Bounds::ZERO, Bounds::ZERO];
        product(level, [&block(x); 2], &input, &input, false, &mut square);
        let (top, bottom) = (block(x * x), block(1.0 + x));
        quotient(level, [&top, &bottom], &square, &input, false, &mut whole);
        // f = x − 1 + 1/(1 + x).
        let r = 1.0 / (1.0 + x);
        let exact = [1.0 - r * r, 2.0 * r.powi(3), 6.0 * r.powi(4)];
        let found = whole.at(0);
        assert!(found.first >= exact[0] * u && found.second >= exact[1] * u * u);
        assert!(found.diagonal >= exact[1] * u * u && found.third >= exact[2] * u.powi(3));
        assert!(found.first < 3.0 * exact[0] * u && found.second < 10.0 * exact[1] * u * u);
        // The square alone is met exactly.
        let found = square.at(0);
        assert!((found.first / (2.0 * x * u) - 1.0).abs() < 1e-15);
        assert!((found.second / (2.0 * u * u) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn values_apart_have_exact_products() {
        let level = level();
        let block = |x: f64| Block([x; LANES]);
        let input = |u: f64| Bounds {
            first: block(u),
            ..Bounds::ZERO
        };
        let mut out = Bounds::ZERO;
        let x = [&block(3.0), &block(-2.0)];
        product(level, x, &input(0.1), &input(0.2), true, &mut out);
        let found = out.at(5);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} is not {b}");
        close(found.first, (0.04_f64 + 0.36).sqrt());
        close(found.second, 2.0_f64.sqrt() * 0.02);
        assert!(found.diagonal < 1e-300 && found.third < 1e-300);
        let mut doubt = Block::ZERO;
        near(level, &block(6.0), &block(0.0), &out, 4.0, &mut doubt);
        assert_eq!(doubt.0[0], 0.0);
        near(level, &block(2.0), &block(0.0), &out, 4.0, &mut doubt);
        assert_eq!(doubt.0[0], 1.0);
    }
}
