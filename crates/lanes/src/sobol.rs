//! Scrambled Sobol' points: numbers in (0, 1) that fill a cube of up to [`DIMENSIONS`] dimensions far more
//! evenly than random ones.
//!
//! The first 2ᵐ points of a Sobol' sequence put one number of every dimension into each of the intervals
//! j/2ᵐ … (j + 1)/2ᵐ, and share out many boxes of several dimensions as evenly. Direction numbers are those of
//! Joe and Kuo, *Constructing Sobol sequences with better two-dimensional projections*, SIAM J. Sci. Comput.
//! 30 (2008).
//!
//! A scramble keeps all this and makes every single point uniformly distributed, so that means over points have
//! no bias and independent scrambles tell their error: the digits of every dimension are multiplied by a random
//! lower triangular matrix, and a random number is added, all modulo two (Matoušek, *On the L₂-discrepancy for
//! anchored boxes*, J. Complexity 14 (1998); the variance is of the same order as Owen's).

use fearless_simd::{Level, dispatch};

use crate::generator::Key;
use crate::generator::open_unit;
use crate::{Block, LANES};

/// Dimensions that have direction numbers.
pub const DIMENSIONS: usize = 64;

/// Most points of a sequence, as a power of two.
const MOST_BITS: u32 = 32;

/// Digits of a block's own points.
const LOW: usize = LANES.trailing_zeros() as usize;

/// One dimension of one scrambled sequence.
#[derive(Debug, Clone)]
pub struct Sobol {
    /// What every digit of a point's number adds, modulo two, beyond those of a block.
    columns: [u64; MOST_BITS as usize],
    /// The points of the first block.
    first: [u64; LANES],
}

impl Sobol {
    /// One `dimension` (below [`DIMENSIONS`]) of the scramble that `seed` and `replicate` name, for up to
    /// 2^`bits` points.
    pub fn new(dimension: usize, bits: u32, [seed, replicate]: [u64; 2]) -> Sobol {
        let key = Key::new([seed, replicate, SCRAMBLES + dimension as u64]);
        let directions = &DIRECTIONS[dimension % DIMENSIONS];
        let bits = bits.max(LOW as u32).min(MOST_BITS) as usize;
        let mut scrambled = [0; MOST_BITS as usize];
        for (column, direction) in scrambled.iter_mut().zip(&directions[..bits]) {
            *column = scramble(*direction, key);
        }
        let mut first = [key.word(64); LANES];
        for (digit, column) in scrambled[..LOW].iter().enumerate() {
            // Numbers with this digit follow those without.
            let (without, with) = first.split_at_mut(1 << digit);
            for (point, other) in with.iter_mut().zip(without) {
                *point = *other ^ column;
            }
        }
        Sobol {
            columns: scrambled,
            first,
        }
    }

    /// Points 256·`block` and following.
    pub fn block(&self, level: Level, block: u64, out: &mut Block) {
        let high = self.columns[LOW..].iter().enumerate();
        let base = high.fold(0, |base, (digit, column)| {
            base ^ (column * (block >> digit & 1))
        });
        dispatch!(level, _ => {
            for (out, point) in out.0.iter_mut().zip(&self.first) {
                *out = open_unit(point ^ base);
            }
        });
    }
}

/// Streams of random words that no generator of trials uses.
const SCRAMBLES: u64 = 1 << 48;

/// A column of the generator matrix, multiplied by the lower triangular matrix whose diagonal is one and
/// whose other digits the key tells.
fn scramble(direction: u32, key: Key) -> u64 {
    let mut column = 0;
    let mut rest = direction;
    while rest != 0 {
        let place = rest.leading_zeros();
        rest &= !(1 << (31 - place));
        let diagonal = 1_u64 << (63 - place);
        column ^= diagonal | key.word(u64::from(place)) & (diagonal - 1);
    }
    column
}

/// Direction numbers of all dimensions, the first digit leftmost.
static DIRECTIONS: [[u32; MOST_BITS as usize]; DIMENSIONS] = directions();

const fn directions() -> [[u32; MOST_BITS as usize]; DIMENSIONS] {
    let mut all = [[0; MOST_BITS as usize]; DIMENSIONS];
    let mut digit = 0;
    while digit < 32 {
        all[0][digit] = 1 << (31 - digit);
        digit += 1;
    }
    let mut dimension = 1;
    while dimension < DIMENSIONS {
        let (polynomial, starts) = JOE_KUO[dimension - 1];
        let degree = starts.len();
        let of = &mut all[dimension];
        let mut k = 0;
        while k < 32 {
            if k < degree {
                of[k] = starts[k] << (31 - k);
            } else {
                // The recurrence of the primitive polynomial, whose inner coefficients are the digits
                // of `polynomial`.
                let mut next = of[k - degree] ^ (of[k - degree] >> degree);
                let mut inner = 1;
                while inner < degree {
                    if polynomial >> (degree - 1 - inner) & 1 == 1 {
                        next ^= of[k - inner];
                    }
                    inner += 1;
                }
                of[k] = next;
            }
            k += 1;
        }
        dimension += 1;
    }
    all
}

/// Of dimensions 2, 3 …: inner coefficients of the primitive polynomial, and the first direction numbers
/// (Joe and Kuo's table new-joe-kuo-6).
const JOE_KUO: [(u32, &[u32]); DIMENSIONS - 1] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
    (7, &[1, 1, 3, 13, 7, 35, 63]),
    (8, &[1, 3, 5, 9, 1, 25, 53]),
    (14, &[1, 3, 1, 13, 9, 35, 107]),
    (19, &[1, 3, 1, 5, 27, 61, 31]),
    (21, &[1, 1, 5, 11, 19, 41, 61]),
    (28, &[1, 3, 5, 3, 3, 13, 69]),
    (31, &[1, 1, 7, 13, 1, 19, 1]),
    (32, &[1, 3, 7, 5, 13, 19, 59]),
    (37, &[1, 1, 3, 9, 25, 29, 41]),
    (41, &[1, 3, 5, 13, 23, 1, 55]),
    (42, &[1, 3, 7, 3, 13, 59, 17]),
    (50, &[1, 3, 1, 3, 5, 53, 69]),
    (55, &[1, 1, 5, 5, 23, 33, 13]),
    (56, &[1, 1, 7, 7, 1, 61, 123]),
    (59, &[1, 1, 7, 9, 13, 61, 49]),
    (62, &[1, 3, 3, 5, 3, 55, 33]),
    (14, &[1, 3, 1, 15, 31, 13, 49, 245]),
    (21, &[1, 3, 5, 15, 31, 59, 63, 97]),
    (22, &[1, 3, 1, 11, 11, 11, 77, 249]),
    (38, &[1, 3, 1, 11, 27, 43, 71, 9]),
    (47, &[1, 1, 7, 15, 21, 11, 81, 45]),
    (49, &[1, 3, 7, 3, 25, 31, 65, 79]),
    (50, &[1, 3, 1, 1, 19, 11, 3, 205]),
    (52, &[1, 1, 5, 9, 19, 21, 29, 157]),
    (56, &[1, 3, 7, 11, 1, 33, 89, 185]),
    (67, &[1, 3, 3, 3, 15, 9, 79, 71]),
    (70, &[1, 3, 7, 11, 15, 39, 119, 27]),
    (84, &[1, 1, 3, 1, 11, 31, 97, 225]),
    (97, &[1, 1, 1, 3, 23, 43, 57, 177]),
    (103, &[1, 3, 7, 7, 17, 17, 37, 71]),
    (115, &[1, 3, 1, 5, 27, 63, 123, 213]),
    (122, &[1, 1, 3, 5, 11, 43, 53, 133]),
    (8, &[1, 3, 5, 5, 29, 17, 47, 173, 479]),
    (13, &[1, 3, 3, 11, 3, 1, 109, 9, 69]),
    (16, &[1, 1, 1, 5, 17, 39, 23, 5, 343]),
    (22, &[1, 3, 1, 5, 25, 15, 31, 103, 499]),
    (25, &[1, 1, 1, 11, 11, 17, 63, 105, 183]),
    (44, &[1, 1, 5, 11, 9, 29, 97, 231, 363]),
    (47, &[1, 1, 5, 15, 19, 45, 41, 7, 383]),
    (52, &[1, 3, 7, 7, 31, 19, 83, 137, 221]),
    (55, &[1, 1, 1, 3, 23, 15, 111, 223, 83]),
    (59, &[1, 1, 5, 13, 31, 15, 55, 25, 161]),
    (62, &[1, 1, 3, 13, 25, 47, 39, 87, 257]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{level, levels};

    fn points(dimension: usize, blocks: u64, replicate: u64) -> Vec<f64> {
        let sobol = Sobol::new(dimension, 20, [7, replicate]);
        let mut block = Block::ZERO;
        let mut all = Vec::new();
        for number in 0..blocks {
            sobol.block(level(), number, &mut block);
            all.extend_from_slice(&block.0);
        }
        all
    }

    /// Every interval of 2⁻¹² holds one of 2¹² points, in every dimension and scramble.
    #[test]
    fn every_dimension_is_stratified() {
        for dimension in 0..DIMENSIONS {
            let mut cells = vec![0; 4096];
            for x in points(dimension, 16, dimension as u64 % 3) {
                assert!(x > 0.0 && x < 1.0);
                cells[(x * 4096.0) as usize] += 1;
            }
            assert!(
                cells.iter().all(|count| *count == 1),
                "dimension {dimension}"
            );
        }
    }

    /// The first two dimensions are a net with t = 0: every box of area 2⁻¹⁰ holds one of 2¹⁰ points.
    #[test]
    fn two_dimensions_fill_every_box() {
        let (x, y) = (points(0, 4, 1), points(1, 4, 1));
        for digits in 0..=10 {
            let (across, up) = (1 << digits, 1 << (10 - digits));
            let mut cells = vec![0; 1024];
            for (x, y) in x.iter().zip(&y) {
                let (i, j) = (
                    (x * f64::from(across)) as usize,
                    (y * f64::from(up)) as usize,
                );
                cells[i * up as usize + j] += 1;
            }
            assert!(cells.iter().all(|count| *count == 1), "2^{digits} columns");
        }
    }

    /// By hand: m = 1, 3, 5 from x + 1 in dimension 2; m = 1, 3, 3, 9 from x² + x + 1 in dimension 3.
    #[test]
    fn direction_numbers_follow_the_recurrence() {
        let fraction = |d: usize, k: usize| f64::from(DIRECTIONS[d][k]) / 4_294_967_296.0;
        let second: Vec<f64> = (0..3).map(|k| fraction(1, k)).collect();
        assert_eq!(second, [1.0 / 2.0, 3.0 / 4.0, 5.0 / 8.0]);
        let third: Vec<f64> = (0..4).map(|k| fraction(2, k)).collect();
        assert_eq!(third, [1.0 / 2.0, 3.0 / 4.0, 3.0 / 8.0, 9.0 / 16.0]);
    }

    /// Over scrambles every point is uniform: mean ½ and variance 1/12 within five standard errors.
    #[test]
    fn scrambled_points_are_uniform() {
        let of: Vec<f64> = (0..20_000)
            .map(|replicate| {
                let sobol = Sobol::new(5, 8, [3, replicate]);
                let mut block = Block::ZERO;
                sobol.block(level(), 0, &mut block);
                block.0[37]
            })
            .collect();
        let n = of.len() as f64;
        let mean = of.iter().sum::<f64>() / n;
        let variance = of.iter().map(|x| (x - 0.5).powi(2)).sum::<f64>() / n;
        assert!((mean - 0.5).abs() < 5.0 / (12.0 * n).sqrt());
        assert!((variance - 1.0 / 12.0).abs() < 5.0 * (1.0 / 180.0 / n).sqrt());
    }

    /// Means of a smooth function of six variables scatter by orders of magnitude less than random
    /// numbers would let them, about the exact value.
    #[test]
    fn a_smooth_mean_converges_fast() {
        let means: Vec<f64> = (0..16)
            .map(|replicate| {
                let columns: Vec<Vec<f64>> = (0..6).map(|d| points(d, 16, replicate)).collect();
                let value = |i: usize| -> f64 { columns.iter().map(|c| 0.5 + c[i]).product() };
                (0..4096).map(value).sum::<f64>() / 4096.0
            })
            .collect();
        let mean = means.iter().sum::<f64>() / 16.0;
        let sd = (means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / 15.0).sqrt();
        // One random mean of 4096: √((13/12)⁶ − 1)/64 = 0.0123.
        assert!(sd < 0.0123 / 30.0, "{sd}");
        assert!((mean - 1.0).abs() < 4.0 * sd / 4.0, "{mean} {sd}");
    }

    #[test]
    fn all_instruction_sets_agree() {
        let sobol = Sobol::new(9, 16, [1, 2]);
        let all: Vec<Block> = levels()
            .into_iter()
            .map(|level| {
                let mut block = Block::ZERO;
                sobol.block(level, 77, &mut block);
                block
            })
            .collect();
        assert!(all.iter().all(|block| *block == all[0]));
    }
}
