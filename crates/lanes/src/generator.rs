//! Random bits: 16 interleaved xoshiro256++ generators.
//!
//! xoshiro256++ (Blackman and Vigna, *Scrambled linear pseudorandom number generators*, ACM
//! TOMS 47, 2021) has a period of 2²⁵⁶ − 1 and passes the usual batteries. Sixteen copies side
//! by side make its shifts and additions vector operations.
//!
//! A generator is addressed by (seed, chunk, stream): `chunk` numbers the pieces of a Monte Carlo
//! run, `stream` the quantity drawn in it. Any piece can be drawn alone, by any thread and in any
//! order, with the same result.

use fearless_simd::{Level, dispatch};

use crate::{Block, LANES, level};

/// Generators that run side by side.
pub(crate) const WIDTH: usize = 16;

/// Words that are drawn before something is made of them, where that takes long.
pub(crate) const PART: usize = 64;

/// Sixteen xoshiro256++ generators that step together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Generator {
    // state[word][lane], so that a step is four vector operations on whole rows.
    state: [[u64; WIDTH]; 4],
}

impl Generator {
    /// The generator of one `stream` in one `chunk` of the run with this `seed`.
    ///
    /// The 1024 bits of state are hashed from all three numbers through a 128-bit key, so that
    /// two of even 10⁹ addresses of a run share a key with probability 10⁻²¹.
    pub fn new(seed: u64, chunk: u64, stream: u64) -> Generator {
        let key = Key::new([seed, chunk, stream]);
        let mut state = [[0; WIDTH]; 4];
        dispatch!(level(), _ => {
            for (word, counter) in state.as_flattened_mut().iter_mut().zip(1..) {
                *word = key.word(counter);
            }
        });
        // A lane would have to draw four zero words in a row (2⁻²⁵⁶) to get stuck.
        Generator { state }
    }

    /// The next 256 words: word `i` comes from lane `i mod 16`.
    pub fn bits(&mut self, level: Level, out: &mut [u64; LANES]) {
        dispatch!(level, _ => self.fill_with(out, |word| word))
    }

    /// 256 uniform numbers in the open interval (0, 1): odd multiples of 2⁻⁵³, so neither 0 nor 1
    /// can occur and the distribution is symmetric about one half.
    pub fn uniforms(&mut self, level: Level, out: &mut Block) {
        dispatch!(level, _ => self.fill_with(&mut out.0, open_unit))
    }

    /// Puts a function of each word into `out`; `N` is a multiple of 16. For kernels that are inside a
    /// dispatch already, as the functions below.
    #[inline(always)]
    pub(crate) fn fill_with<const N: usize, T>(&mut self, out: &mut [T; N], f: impl Fn(u64) -> T) {
        const { assert!(N.is_multiple_of(WIDTH)) };
        // A copy, which the compiler keeps in registers through the loop.
        let mut state = self.state;
        for row in out.as_chunks_mut::<WIDTH>().0 {
            let words = step(&mut state);
            for lane in 0..WIDTH {
                row[lane] = f(words[lane]);
            }
        }
        self.state = state;
    }

    /// Puts a function of two words into `out`; `N` is a multiple of 16.
    #[inline(always)]
    pub(crate) fn fill_with_two<const N: usize>(
        &mut self,
        out: &mut [f64; N],
        f: impl Fn(u64, u64) -> f64,
    ) {
        const { assert!(N.is_multiple_of(WIDTH)) };
        let mut state = self.state;
        for row in out.as_chunks_mut::<WIDTH>().0 {
            let (first, second) = (step(&mut state), step(&mut state));
            for lane in 0..WIDTH {
                row[lane] = f(first[lane], second[lane]);
            }
        }
        self.state = state;
    }

    /// Puts two functions of two words into lanes i and i + N/2 of `out`; `N` is a multiple of 32.
    #[inline(always)]
    pub(crate) fn fill_with_pairs<const N: usize>(
        &mut self,
        out: &mut [f64; N],
        f: impl Fn(u64, u64) -> (f64, f64),
    ) {
        const { assert!(N.is_multiple_of(2 * WIDTH)) };
        let (front, back) = out.split_at_mut(N / 2);
        let mut words = [[0; PART]; 2];
        for (x, y) in front.chunks_mut(PART).zip(back.chunks_mut(PART)) {
            let [first, second] = self.in_turns(&mut words, x.len());
            for (((x, y), &a), &b) in x.iter_mut().zip(y).zip(first).zip(second) {
                (*x, *y) = f(a, b);
            }
        }
    }

    /// Two rows of at most [`PART`] words, 16 of the first and 16 of the second in turns. For functions that are
    /// long: their loops have the registers for themselves, and the processor sees more than one round at a
    /// time.
    #[inline(always)]
    pub(crate) fn in_turns<'w>(
        &mut self,
        [first, second]: &'w mut [[u64; PART]; 2],
        count: usize,
    ) -> [&'w [u64]; 2] {
        let (first, second) = (&mut first[..count], &mut second[..count]);
        let mut state = self.state;
        let rows = first.as_chunks_mut::<WIDTH>().0.iter_mut();
        for (first, second) in rows.zip(second.as_chunks_mut::<WIDTH>().0) {
            *first = step(&mut state);
            *second = step(&mut state);
        }
        self.state = state;
        [first, second]
    }
}

/// One step of all lanes.
#[inline(always)]
fn step([s0, s1, s2, s3]: &mut [[u64; WIDTH]; 4]) -> [u64; WIDTH] {
    let mut words = [0; WIDTH];
    for lane in 0..WIDTH {
        words[lane] = s0[lane]
            .wrapping_add(s3[lane])
            .rotate_left(23)
            .wrapping_add(s0[lane]);
        let shifted = s1[lane] << 17;
        s2[lane] ^= s0[lane];
        s3[lane] ^= s1[lane];
        s1[lane] ^= s2[lane];
        s0[lane] ^= s3[lane];
        s2[lane] ^= shifted;
        s3[lane] = s3[lane].rotate_left(45);
    }
    words
}

// Fractional digits of √2 and √3: two unrelated starting points of the hash.
const FIRST_KEY: u64 = 0x6a09_e667_f3bc_c908;
const SECOND_KEY: u64 = 0xbb67_ae85_84ca_a73b;
/// The increment of SplitMix64, 2⁶⁴ over the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Takes one more number into a hash.
fn absorb(hash: u64, value: u64) -> u64 {
    mix(mix(hash.wrapping_add(GOLDEN)) ^ mix(value.wrapping_add(GOLDEN)))
}

/// Random words that an address names, in any order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Key([u64; 2]);

impl Key {
    /// The 128-bit hash of an address.
    pub(crate) fn new(address: [u64; 3]) -> Key {
        Key([FIRST_KEY, SECOND_KEY].map(|salt| address.into_iter().fold(salt, absorb)))
    }

    /// Word number `counter`.
    #[inline(always)]
    pub(crate) fn word(self, counter: u64) -> u64 {
        let step = GOLDEN.wrapping_mul(counter);
        mix(self.0[0].wrapping_add(step)) ^ mix(self.0[1].wrapping_sub(step)).rotate_left(32)
    }
}

/// The finaliser of SplitMix64: a bijection in which every bit of the input moves every bit of
/// the output with probability one half.
#[inline(always)]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

const ONE: u64 = 1.0_f64.to_bits();

/// The upper 52 bits as a number in (0, 1): (2j + 1)·2⁻⁵³.
#[inline(always)]
pub(crate) fn open_unit(word: u64) -> f64 {
    // 1 + j·2⁻⁵² has the mantissa bits j; one subtraction, exact, moves it down to (0, 1).
    f64::from_bits(word >> 12 | ONE) - (1.0 - 0.5 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use rand::rngs::Xoshiro256PlusPlus;
    use rand::{Rng, SeedableRng};

    use super::*;
    use crate::levels;

    #[test]
    fn each_lane_is_the_xoshiro256plusplus_of_rand() {
        for level in levels() {
            let mut generator = Generator::new(20_080_101, 3, 7);
            let mut lanes: Vec<Xoshiro256PlusPlus> = (0..WIDTH)
                .map(|lane| {
                    let mut seed = [0; 32];
                    for (word, place) in generator.state.iter().zip(seed.chunks_exact_mut(8)) {
                        place.copy_from_slice(&word[lane].to_le_bytes());
                    }
                    Xoshiro256PlusPlus::from_seed(seed)
                })
                .collect();
            let mut bits = [0; LANES];
            for _ in 0..10 {
                generator.bits(level, &mut bits);
                for (i, &word) in bits.iter().enumerate() {
                    assert_eq!(word, lanes[i % WIDTH].next_u64());
                }
            }
        }
    }

    #[test]
    fn mix_is_splitmix64() {
        // rand seeds xoshiro256++ from a u64 through SplitMix64; its first word is thus mix(γ).
        let mut state = [0; 32];
        for (i, place) in state.chunks_exact_mut(8).enumerate() {
            let word = mix(GOLDEN.wrapping_mul(i as u64 + 1));
            place.copy_from_slice(&word.to_le_bytes());
        }
        assert_eq!(
            Xoshiro256PlusPlus::from_seed(state),
            Xoshiro256PlusPlus::seed_from_u64(0)
        );
    }

    #[test]
    fn neighbouring_addresses_share_no_word() {
        let mut seen = std::collections::HashSet::new();
        for seed in 0..4 {
            for chunk in 0..16 {
                for stream in 0..16 {
                    for word in Generator::new(seed, chunk, stream).state.as_flattened() {
                        assert!(seen.insert(*word));
                    }
                }
            }
        }
    }

    #[test]
    fn order_of_the_address_matters() {
        assert_ne!(Generator::new(1, 2, 3), Generator::new(1, 3, 2));
        assert_ne!(Generator::new(1, 2, 3), Generator::new(2, 1, 3));
    }

    /// Sample correlations of 16 lanes, of streams and of chunks stay within 5 standard errors.
    #[test]
    fn lanes_streams_and_chunks_are_uncorrelated() {
        let mut columns: Vec<Vec<f64>> = Vec::new();
        for (chunk, stream) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let mut generator = Generator::new(0, chunk, stream);
            let mut lanes = vec![Vec::new(); WIDTH];
            let mut block = Block::ZERO;
            for _ in 0..256 {
                generator.uniforms(level(), &mut block);
                for (i, u) in block.0.iter().enumerate() {
                    lanes[i % WIDTH].push((u - 0.5) * 12_f64.sqrt());
                }
            }
            columns.extend(lanes);
        }
        let n = columns[0].len() as f64;
        for (i, a) in columns.iter().enumerate() {
            for b in &columns[..i] {
                let r = a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / n;
                assert!(r.abs() < 5.0 / n.sqrt(), "r = {r}");
            }
        }
    }

    /// Computed by an independent program from the definition (SplitMix64 finaliser, 128-bit
    /// key, xoshiro256++).
    #[test]
    fn first_words_never_change() {
        let mut bits = [0; LANES];
        Generator::new(0, 0, 0).bits(level(), &mut bits);
        assert_eq!(bits[..2], [0x658d_39b3_deac_4ff0, 0xa32b_6cad_b1cf_7445]);
        assert_eq!(bits[15], 0x6925_afd5_2103_289f);
        Generator::new(u64::MAX, 12, 3).bits(level(), &mut bits);
        assert_eq!(bits[..2], [0xcd07_0d00_db99_722b, 0xe410_e304_3bf0_264b]);
        assert_eq!(bits[15], 0xa494_90d6_17c1_59aa);
    }
}
