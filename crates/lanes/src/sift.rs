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

/// What is left of a block when the values of two stretches are taken out.
#[derive(Debug, Clone)]
pub struct Sifted {
    rest: [f64; LANES + ROW],
    left: usize,
    /// How many values lay in the first stretch and in the second.
    pub taken: [u64; 2],
}

impl Default for Sifted {
    fn default() -> Self {
        Sifted {
            rest: [0.0; LANES + ROW],
            left: 0,
            taken: [0; 2],
        }
    }
}

impl Sifted {
    /// The values outside of both stretches, in the order of their lanes; NaN is always among them.
    pub fn rest(&self) -> &[f64] {
        &self.rest[..self.left]
    }

    /// Sifts a block; the stretches have no number in common.
    pub fn sift(&mut self, level: Level, x: &Block, stretches: &[Stretch; 2]) {
        dispatch!(level, simd => self.sift_with(simd, x, stretches))
    }

    #[inline(always)]
    fn sift_with<S: Simd>(&mut self, simd: S, x: &Block, [first, second]: &[Stretch; 2]) {
        let [first, second] = [first, second].map(|ends| ends.map(|end| f64x8::splat(simd, end)));
        let (mut left, mut in_first) = (0, 0);
        for row in x.0.as_chunks::<ROW>().0 {
            let row = f64x8::from_slice(simd, row);
            let inside = row.simd_ge(first[0]) & row.simd_le(first[1]);
            let outside = !(inside | (row.simd_ge(second[0]) & row.simd_le(second[1])));
            row.compress(outside)
                .store_slice(&mut self.rest[left..left + ROW]);
            left += outside.to_bitmask().count_ones() as usize;
            in_first += u64::from(inside.to_bitmask().count_ones());
        }
        self.left = left;
        self.taken = [in_first, LANES as u64 - left as u64 - in_first];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels;
    use crate::testing::awkward;

    #[test]
    fn what_lies_outside_stays_in_order_and_the_rest_is_counted() {
        let x = awkward();
        for stretches in [
            [EMPTY, EMPTY],
            [[-1.0, 2.0], EMPTY],
            [[-f64::MAX, 0.0], [5e-324, f64::MAX]],
            [[f64::NEG_INFINITY, -1.0], [0.5, 0.5]],
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
                sifted.sift(level, &x, &stretches);
                let rest: Vec<u64> = sifted.rest().iter().map(|x| x.to_bits()).collect();
                assert_eq!((&rest, sifted.taken), (&outside, taken), "{level:?}");
            }
        }
    }
}
