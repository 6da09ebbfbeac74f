//! Separating the few values that matter from the many that are only counted.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};

use crate::{Block, LANES};

/// Lanes that are looked at together.
const ROW: usize = 8;

/// Numbers from the first to the second, both included; none at all where the first is the larger.
pub type Stretch = [f64; 2];

/// A stretch without numbers.
pub const EMPTY: Stretch = [f64::INFINITY, f64::NEG_INFINITY];

/// Values that may wait in a [`Sifted`] before another block is sifted.
pub const WAITING: usize = 1024;

/// What is left of some blocks when the values of two stretches are taken out.
#[derive(Debug, Clone)]
pub struct Sifted {
    rest: Box<[f64; WAITING + LANES + ROW]>,
    left: usize,
    taken: [u64; 2],
}

impl Default for Sifted {
    fn default() -> Self {
        Sifted {
            rest: Box::new([0.0; WAITING + LANES + ROW]),
            left: 0,
            taken: [0; 2],
        }
    }
}

impl Sifted {
    /// The values outside of both stretches, in the order of their lanes.
    pub fn rest(&self) -> &[f64] {
        &self.rest[..self.left]
    }

    /// How many values lay in the first stretch and in the second.
    pub fn taken(&self) -> [u64; 2] {
        self.taken
    }

    /// Whether [`Sifted::rest`] has to be forgotten before another block can be sifted.
    pub fn is_full(&self) -> bool {
        self.left > WAITING
    }

    /// Forgets the rest.
    pub fn clear(&mut self) {
        self.left = 0;
    }

    /// Counts one number as taken out by a stretch, of which there are two.
    pub fn take_one(&mut self, stretch: usize) {
        if let Some(taken) = self.taken.get_mut(stretch) {
            *taken += 1;
        }
    }

    /// Sifts a block; if not all of it is finite, or there is no room, nothing of it, and returns false. The
    /// stretches have no number in common and no infinite end; the second may be [`EMPTY`], or both.
    pub fn sift(&mut self, level: Level, x: &Block, stretches: &[Stretch; 2]) -> bool {
        dispatch!(level, simd => self.sift_with(simd, x, stretches))
    }

    #[inline(always)]
    fn sift_with<S: Simd>(&mut self, simd: S, x: &Block, [first, second]: &[Stretch; 2]) -> bool {
        let Some(rest) = self.rest.get_mut(self.left..self.left + LANES + ROW) else {
            return false;
        };
        let (left, in_first) = if *first == EMPTY {
            rest[..LANES].copy_from_slice(&x.0);
            (LANES, 0)
        } else {
            let second = if *second == EMPTY { first } else { second };
            outside(simd, x, [first, second], rest)
        };
        // What is not finite lies in no stretch.
        let infinity = f64x8::splat(simd, f64::INFINITY);
        let mut finite = infinity.simd_eq(infinity);
        let (rows, last) = rest[..left].as_chunks::<ROW>();
        for row in rows {
            finite &= f64x8::from_slice(simd, row).abs().simd_lt(infinity);
        }
        if !finite.all_true() || !last.iter().all(|x| x.is_finite()) {
            return false;
        }
        self.left += left;
        self.taken[0] += in_first;
        self.taken[1] += LANES as u64 - left as u64 - in_first;
        true
    }
}

/// Writes what lies outside of two stretches to `rest`; how much that was, and how much lay in the first.
#[inline(always)]
fn outside<S: Simd>(
    simd: S,
    x: &Block,
    stretches: [&Stretch; 2],
    rest: &mut [f64],
) -> (usize, u64) {
    let [first, second] = stretches.map(|ends| ends.map(|end| f64x8::splat(simd, end)));
    let (mut left, mut in_first) = (0, 0);
    for row in x.0.as_chunks::<ROW>().0 {
        let row = f64x8::from_slice(simd, row);
        // What is not changed by being moved between the ends lies there; that takes fewer steps than two
        // comparisons.
        let inside = row.max(first[0]).min(first[1]).simd_eq(row);
        let outside = !(inside | row.max(second[0]).min(second[1]).simd_eq(row));
        row.compress(outside)
            .store_slice(&mut rest[left..left + ROW]);
        left += outside.to_bitmask().count_ones() as usize;
        in_first += u64::from(inside.to_bitmask().count_ones());
    }
    (left, in_first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels;
    use crate::testing::awkward;

    /// [`awkward`] without what is not finite.
    fn finite() -> Block {
        let mut x = awkward();
        x.0.iter_mut()
            .filter(|x| !x.is_finite())
            .for_each(|x| *x = 0.5);
        x
    }

    #[test]
    fn what_lies_outside_stays_in_order_and_the_rest_is_counted() {
        let x = finite();
        for stretches in [
            [EMPTY, EMPTY],
            [[-1.0, 2.0], EMPTY],
            [[-f64::MAX, 0.0], [5e-324, f64::MAX]],
            [[-f64::MAX, -1.0], [0.5, 0.5]],
        ] {
            let inside = |x: f64, s: &Stretch| s[0] <= x && x <= s[1];
            let outside: Vec<u64> =
                x.0.iter()
                    .filter(|x| !stretches.iter().any(|s| inside(**x, s)))
                    .map(|x| x.to_bits())
                    .collect();
            let taken = stretches.map(|s| x.0.iter().filter(|x| inside(**x, &s)).count() as u64);
            for level in levels() {
                let mut sifted = Sifted::default();
                for times in 1..3 {
                    assert!(sifted.sift(level, &x, &stretches));
                    let rest: Vec<u64> = sifted.rest().iter().map(|x| x.to_bits()).collect();
                    assert_eq!(rest, outside.repeat(times), "{level:?}");
                    assert_eq!(sifted.taken(), taken.map(|n| n * times as u64), "{level:?}");
                }
            }
        }
    }

    #[test]
    fn blocks_that_are_not_finite_and_blocks_for_which_there_is_no_room_are_left_out() {
        for level in levels() {
            let mut sifted = Sifted::default();
            assert!(!sifted.sift(level, &awkward(), &[EMPTY, EMPTY]));
            assert_eq!((sifted.rest().len(), sifted.taken()), (0, [0, 0]));
            while !sifted.is_full() {
                assert!(sifted.sift(level, &finite(), &[EMPTY, EMPTY]));
            }
            assert_eq!(sifted.rest().len(), WAITING + LANES);
            assert!(!sifted.sift(level, &finite(), &[EMPTY, EMPTY]));
            sifted.clear();
            assert!(sifted.sift(level, &finite(), &[EMPTY, EMPTY]));
        }
    }
}
