//! Sums of several terms in one pass, where one pass for each would mostly move numbers about.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};

use crate::Block;

/// Lanes of a vector.
const ROW: usize = 8;

/// Vectors that are summed at a time.
const HELD: usize = 4;

/// What is added in each lane.
#[derive(Debug, Clone, Copy)]
pub enum Term<'a> {
    /// a.
    Plus(&'a Block),
    /// −a.
    Minus(&'a Block),
    /// a·b, rounded before it is added.
    PlusProduct(&'a Block, &'a Block),
    /// −a·b, rounded before it is added.
    MinusProduct(&'a Block, &'a Block),
}

/// The terms added one after the other, each with its own rounding.
pub fn sum(level: Level, terms: &[Term], out: &mut Block) {
    dispatch!(level, simd => sum_with(simd, terms, out))
}

/// Some lanes of a block.
#[inline(always)]
fn part<S: Simd>(simd: S, block: &Block, part: usize) -> [f64x8<S>; HELD] {
    let lanes = &block.0.as_chunks::<{ HELD * ROW }>().0[part];
    let (rows, _) = lanes.as_chunks::<ROW>();
    let row = |k: usize| f64x8::from_slice(simd, &rows[k]);
    [row(0), row(1), row(2), row(3)]
}

#[inline(always)]
fn sum_with<S: Simd>(simd: S, terms: &[Term], out: &mut Block) {
    for (at, out) in out
        .0
        .as_chunks_mut::<{ HELD * ROW }>()
        .0
        .iter_mut()
        .enumerate()
    {
        // −0 + x is x, of −0 too.
        let mut sums = [f64x8::splat(simd, -0.0); HELD];
        for term in terms {
            match term {
                Term::Plus(a) => {
                    let a = part(simd, a, at);
                    for k in 0..HELD {
                        sums[k] += a[k];
                    }
                }
                Term::Minus(a) => {
                    let a = part(simd, a, at);
                    for k in 0..HELD {
                        sums[k] -= a[k];
                    }
                }
                Term::PlusProduct(a, b) => {
                    let (a, b) = (part(simd, a, at), part(simd, b, at));
                    for k in 0..HELD {
                        sums[k] += a[k] * b[k];
                    }
                }
                Term::MinusProduct(a, b) => {
                    let (a, b) = (part(simd, a, at), part(simd, b, at));
                    for k in 0..HELD {
                        sums[k] -= a[k] * b[k];
                    }
                }
            }
        }
        for (sum, out) in sums.iter().zip(out.as_chunks_mut::<ROW>().0) {
            sum.store_slice(out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels;
    use crate::ops;
    use crate::testing::{awkward, same};

    #[test]
    fn sums_are_those_of_single_operations() {
        let a = awkward();
        let (mut b, mut c) = (a, a);
        b.0.rotate_left(7);
        c.0.rotate_left(100);
        for level in levels() {
            let (mut expected, mut product, mut next) = (Block::ZERO, Block::ZERO, Block::ZERO);
            // ((−a + b·c) − c) − a·b.
            ops::neg(level, &a, &mut expected);
            ops::mul(level, &b, &c, &mut product);
            ops::add(level, &expected, &product, &mut next);
            ops::sub(level, &next, &c, &mut expected);
            ops::mul(level, &a, &b, &mut product);
            ops::sub(level, &expected, &product, &mut next);
            let terms = [
                Term::Minus(&a),
                Term::PlusProduct(&b, &c),
                Term::Minus(&c),
                Term::MinusProduct(&a, &b),
            ];
            let mut found = Block::ZERO;
            sum(level, &terms, &mut found);
            for (found, expected) in found.0.iter().zip(next.0) {
                assert!(same(*found, expected), "{found} {expected}");
            }
            sum(level, &terms[..0], &mut found);
            assert!(found.0.iter().all(|x| *x == 0.0));
            let zeros = Block([-0.0; crate::LANES]);
            sum(level, &[Term::Plus(&zeros)], &mut found);
            assert!(found.0.iter().all(|x| x.is_sign_negative()));
        }
    }
}
