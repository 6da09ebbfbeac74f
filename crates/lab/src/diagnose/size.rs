//! What a diagnosis takes of the machine, before it takes it.

use super::case::{Case, NoiseClaim};
use super::coarse;
use super::design::Design;
use super::failure::Failure;
use super::noise_claims::REST_DRAWS;
use super::noise_correlation;

/// No diagnosis takes more memory than this: half of what a machine of a laboratory has.
const MOST_BYTES: u64 = 8 << 30;

impl Case {
    /// About how many bytes a diagnosis takes, from the numbers of its rows, columns and blocks: the model in every row,
    /// what every effect does to the rows of a block, and what it does to the observations, each beside each.
    pub fn bytes(&self) -> u64 {
        /// Of the rows: the case, the model and its slopes, each as declared, with effects, and held out.
        const COPIES: usize = 6;
        /// Of what an effect does to the rows of blocks: as it is, and refined.
        const COURSES: usize = 2;
        /// Of what an effect does to the observations: as columns, whitened, as directions, in the search.
        const DIRECTIONS: usize = 6;
        /// For each law of noise: its correlation, root and whitener.
        const MATRICES: usize = 3;
        let design = Design::new(self);
        let responses = self.responses.len().max(1);
        let columns = self.columns.len();
        let row = columns + responses * (2 + self.symbols());
        let blocks = design.blocks.len();
        let observations = responses * blocks;
        let effects = effects(blocks, columns);
        let laws = noise_correlation::laws(observations);
        let values = COPIES * self.rows * row
            + COURSES * effects * coarse::pieces_of(&design)
            + DIRECTIONS * effects * responses * observations
            + MATRICES * laws * observations * observations;
        (values * size_of::<f64>()) as u64
    }
}

/// About how many courses effects have: a wave over every column and the time has two for each pair of blocks, a wrong
/// reading one for each block, and everything else some hundred for each column.
fn effects(blocks: usize, columns: usize) -> usize {
    const OTHERS: usize = 200;
    blocks + columns * (blocks + OTHERS)
}

/// # Errors
/// It takes more memory than a diagnosis may.
pub(super) fn fits_into_memory(case: &Case) -> Result<(), Failure> {
    let bytes = case.bytes();
    match bytes <= MOST_BYTES {
        true => Ok(()),
        false => Err(Failure::TooLarge {
            rows: case.rows,
            bytes,
            most: MOST_BYTES,
        }),
    }
}

/// # Errors
/// The errors of all rows are drawn together, and take more memory than a diagnosis may.
pub(super) fn draws_fit_into_memory(case: &Case) -> Result<(), Failure> {
    /// The covariance, the correlation and its root.
    const MATRICES: usize = 3;
    let matrices = match &case.noise {
        NoiseClaim::Stated { walk, .. } if walk.iter().any(|walk| *walk > 0.0) => MATRICES,
        // What a rest leaves open are so many more, as covariances and as correlations.
        NoiseClaim::AtRest { readings, .. } if readings.iter().all(|rest| rest.times.is_some()) => {
            MATRICES + 2 * REST_DRAWS
        }
        _ => 0,
    };
    let observations = (case.responses.len() * case.rows) as u64;
    let values = (matrices as u64).saturating_mul(observations.saturating_mul(observations));
    let bytes = values.saturating_mul(size_of::<f64>() as u64);
    match bytes > MOST_BYTES {
        true => Err(Failure::TooCorrelated {
            rows: case.rows,
            bytes,
            most: MOST_BYTES,
        }),
        false => Ok(()),
    }
}
