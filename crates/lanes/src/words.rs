//! The words of a generator one by one, for everything that draws through the traits of `rand`.

use rand_core::{SeedableRng, TryRng};

use crate::Generator;
use crate::generator::WIDTH;

/// A [`Generator`] as `rand` wants it: word after word, in the order of [`Generator::bits`].
///
/// ```
/// use gumption_lanes::Words;
/// use rand::{RngExt, SeedableRng};
///
/// let mut words = Words::seed_from_u64(7);
/// let die: u8 = words.random_range(1..=6);
/// assert!((1..=6).contains(&die));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Words {
    generator: Generator,
    drawn: [u64; WIDTH],
    used: usize,
}

impl From<Generator> for Words {
    fn from(generator: Generator) -> Words {
        Words {
            generator,
            drawn: [0; WIDTH],
            used: WIDTH,
        }
    }
}

impl Words {
    fn next(&mut self) -> u64 {
        if self.used == WIDTH {
            self.generator.fill_with(&mut self.drawn, |word| word);
            self.used = 0;
        }
        let word = self.drawn[self.used];
        self.used += 1;
        word
    }
}

impl TryRng for Words {
    type Error = std::convert::Infallible;

    /// The upper half of a word.
    fn try_next_u32(&mut self) -> Result<u32, Self::Error> {
        Ok((self.next() >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Self::Error> {
        Ok(self.next())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
        for part in bytes.chunks_mut(8) {
            part.copy_from_slice(&self.next().to_le_bytes()[..part.len()]);
        }
        Ok(())
    }
}

/// Seed, chunk and stream of [`Generator::new`], eight bytes each, the lowest first.
impl SeedableRng for Words {
    type Seed = [u8; 24];

    fn from_seed(seed: [u8; 24]) -> Words {
        let mut address = [0; 3];
        for (number, bytes) in address.iter_mut().zip(seed.as_chunks::<8>().0) {
            *number = u64::from_le_bytes(*bytes);
        }
        let [seed, chunk, stream] = address;
        Generator::new(seed, chunk, stream).into()
    }

    /// The first stream of the first chunk of the run with this seed.
    fn seed_from_u64(seed: u64) -> Words {
        Generator::new(seed, 0, 0).into()
    }
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;
    use crate::{LANES, level};

    #[test]
    fn words_are_those_of_blocks() {
        let mut block = [0; LANES];
        let mut generator = Generator::new(5, 0, 0);
        let mut words = Words::seed_from_u64(5);
        for _ in 0..3 {
            generator.bits(level(), &mut block);
            assert!(block.iter().all(|word| *word == words.next_u64()));
        }
        let mut seed = [0; 24];
        (seed[0], seed[8], seed[16]) = (5, 3, 9);
        let mut other = Words::from_seed(seed);
        Generator::new(5, 3, 9).bits(level(), &mut block);
        assert_eq!(other.next_u32(), (block[0] >> 32) as u32);
        let mut bytes = [0; 11];
        other.fill_bytes(&mut bytes);
        assert_eq!(bytes[..8], block[1].to_le_bytes());
        assert_eq!(bytes[8..], block[2].to_le_bytes()[..3]);
    }
}
