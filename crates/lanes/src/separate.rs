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

/// Values that may wait in a [`Separated`] before another block is separated.
const WAITING: usize = 1024;

/// What is left of some blocks when the values of two stretches are taken out.
#[derive(Debug, Clone)]
pub struct Separated {
    rest: Box<[f64; WAITING + LANES + ROW]>,
    left: usize,
    taken: [u64; 2],
}

impl Default for Separated {
    fn default() -> Self {
        Separated {
            rest: Box::new([0.0; WAITING + LANES + ROW]),
            left: 0,
            taken: [0; 2],
        }
    }
}

impl Separated {
    /// The values outside of both stretches, in the order of their lanes.
    pub fn rest(&self) -> &[f64] {
        &self.rest[..self.left]
    }

    /// How many values lay in the first stretch and in the second.
    pub fn taken(&self) -> [u64; 2] {
        self.taken
    }

    /// Whether [`Separated::rest`] has to be forgotten before another block can be separated.
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
    pub fn separate(&mut self, level: Level, x: &Block, stretches: &[Stretch; 2]) -> bool {
        dispatch!(level, simd => self.separate_with(simd, x, stretches))
    }

    #[inline(always)]
    fn separate_with<S: Simd>(
        &mut self,
        simd: S,
        x: &Block,
        [first, second]: &[Stretch; 2],
    ) -> bool {
        let Some(rest) = self.rest.get_mut(self.left..self.left + LANES + ROW) else {
            return false;
        };
        let (left, in_first, finite) = if *first == EMPTY {
            rest[..LANES].copy_from_slice(&x.0);
            (LANES, 0, all_finite(simd, x))
        } else {
            let second = if *second == EMPTY { first } else { second };
            outside(simd, x, [first, second], rest)
        };
        if !finite {
            return false;
        }
        self.left += left;
        self.taken[0] += in_first;
        self.taken[1] += LANES as u64 - left as u64 - in_first;
        true
    }
}

/// Writes what lies outside of two stretches to `rest`; how much that was, how much lay in the first, and whether all
/// is finite.
#[inline(always)]
fn outside<S: Simd>(
    simd: S,
    x: &Block,
    stretches: [&Stretch; 2],
    rest: &mut [f64],
) -> (usize, u64, bool) {
    let [first, second] = stretches.map(|ends| ends.map(|end| f64x8::splat(simd, end)));
    let (mut left, mut in_first) = (0, 0);
    let mut check = Finite::new(simd);
    for row in x.0.as_chunks::<ROW>().0 {
        let row = f64x8::from_slice(simd, row);
        check.take(row);
        // What is not changed by being moved between the ends lies there; that takes fewer steps than two
        // comparisons.
        let inside = row.max(first[0]).min(first[1]).simd_eq(row);
        let outside = !(inside | row.max(second[0]).min(second[1]).simd_eq(row));
        row.compress(outside)
            .store_slice(&mut rest[left..left + ROW]);
        left += outside.to_bitmask().count_ones() as usize;
        in_first += u64::from(inside.to_bitmask().count_ones());
    }
    (left, in_first, check.all())
}

/// Whether everything is finite: zero times a finite number is zero, times any other NaN.
struct Finite<S: Simd> {
    zero: f64x8<S>,
    sum: f64x8<S>,
}

impl<S: Simd> Finite<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        Finite { zero, sum: zero }
    }

    #[inline(always)]
    fn take(&mut self, row: f64x8<S>) {
        self.sum += row * self.zero;
    }

    #[inline(always)]
    fn all(self) -> bool {
        self.sum.simd_eq(self.zero).all_true()
    }
}

#[inline(always)]
fn all_finite<S: Simd>(simd: S, x: &Block) -> bool {
    let mut check = Finite::new(simd);
    for row in x.0.as_chunks::<ROW>().0 {
        check.take(f64x8::from_slice(simd, row));
    }
    check.all()
}

/// Stretches that are all looked at for every value; of more, the right one is looked for.
pub(crate) const FEW: usize = 16;

/// Drops the values from `first` on that lie in no stretch. The stretches have no infinite end; where they are more
/// than a few, they ascend and have no number in common.
pub fn keep_inside(level: Level, values: &mut Vec<f64>, first: usize, stretches: &[Stretch]) {
    let later = &mut values[first..];
    let kept = if stretches.len() > FEW {
        to_front(later, |value| {
            let found = stretches.get(stretches.partition_point(|[_, high]| *high < value));
            found.is_some_and(|[low, _]| *low <= value)
        })
    } else {
        dispatch!(level, simd => move_inside(simd, later, stretches))
    };
    values.truncate(first + kept);
}

/// Moves the values for which something holds to the front, in their order; how many there are. For conditions
/// that cannot be foreseen: every value is moved, no branch taken.
pub fn to_front(values: &mut [f64], holds: impl Fn(f64) -> bool) -> usize {
    let mut kept = 0;
    for index in 0..values.len() {
        let value = values[index];
        values[kept] = value;
        kept += usize::from(holds(value));
    }
    kept
}

/// Moves the values that lie in some stretch to the front, in their order; how many there are.
#[inline(always)]
fn move_inside<S: Simd>(simd: S, values: &mut [f64], stretches: &[Stretch]) -> usize {
    let mut kept = 0;
    let rows = values.len() / ROW * ROW;
    for start in (0..rows).step_by(ROW) {
        let row = f64x8::from_slice(simd, &values[start..start + ROW]);
        let mut inside = row.simd_eq(f64x8::splat(simd, f64::NAN));
        for [low, high] in stretches {
            let (low, high) = (f64x8::splat(simd, *low), f64x8::splat(simd, *high));
            inside |= row.max(low).min(high).simd_eq(row);
        }
        // Up to the end of this row at most, which has been read.
        row.compress(inside)
            .store_slice(&mut values[kept..kept + ROW]);
        kept += inside.to_bitmask().count_ones() as usize;
    }
    for index in rows..values.len() {
        let value = values[index];
        if stretches
            .iter()
            .any(|[low, high]| *low <= value && value <= *high)
        {
            values[kept] = value;
            kept += 1;
        }
    }
    kept
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
                let mut separated = Separated::default();
                for times in 1..3 {
                    assert!(separated.separate(level, &x, &stretches));
                    let rest: Vec<u64> = separated.rest().iter().map(|x| x.to_bits()).collect();
                    assert_eq!(rest, outside.repeat(times), "{level:?}");
                    assert_eq!(
                        separated.taken(),
                        taken.map(|n| n * times as u64),
                        "{level:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn blocks_that_are_not_finite_and_blocks_for_which_there_is_no_room_are_left_out() {
        for level in levels() {
            let mut separated = Separated::default();
            assert!(!separated.separate(level, &awkward(), &[EMPTY, EMPTY]));
            assert_eq!((separated.rest().len(), separated.taken()), (0, [0, 0]));
            while !separated.is_full() {
                assert!(separated.separate(level, &finite(), &[EMPTY, EMPTY]));
            }
            assert_eq!(separated.rest().len(), WAITING + LANES);
            assert!(!separated.separate(level, &finite(), &[EMPTY, EMPTY]));
            separated.clear();
            assert!(separated.separate(level, &finite(), &[EMPTY, EMPTY]));
        }
    }

    #[test]
    fn what_lies_inside_is_kept_in_order() {
        let mut values = awkward().0.to_vec();
        values.extend((0..77).map(|i| f64::from(i) * 0.1 - 3.0));
        for stretches in [
            vec![],
            vec![[-1.0, 2.0]],
            vec![[-f64::MAX, -2.0], [0.0, 0.0], [1.0, 3.0]],
            vec![[-f64::MAX, 0.5], [-1.0, 2.0], [2.0, f64::MAX]],
            (0..=FEW as i32)
                .map(|i| f64::from(i) * 0.2)
                .map(|x| [x, x + 0.1])
                .collect(),
        ] {
            let inside = |x: f64| stretches.iter().any(|s: &Stretch| s[0] <= x && x <= s[1]);
            for first in [0, 5] {
                let mut expected = values.clone();
                let mut index = 0;
                expected.retain(|x| {
                    index += 1;
                    index <= first || inside(*x)
                });
                for level in levels() {
                    let mut found = values.clone();
                    keep_inside(level, &mut found, first, &stretches);
                    assert!(
                        found
                            .iter()
                            .map(|x| x.to_bits())
                            .eq(expected.iter().map(|x| x.to_bits())),
                        "{level:?} {stretches:?}"
                    );
                }
            }
        }
    }
}
