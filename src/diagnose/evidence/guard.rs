//! The open-set guard: an effect that is not in the catalogue, but looks like what is.
//!
//! With the true effect missing from the catalogue, its next of kin explains most of it, or two others
//! together do. What an unlisted effect may look like is told by the catalogue itself: a discrepancy
//! whose covariance matrix is the average of AAᵀ over all named atoms (each of unit length, candidates
//! alike). A named set has to be better by far than this competitor, alone or with a part of the set.

use nalgebra::DMatrix;

use super::closed_form::Scale;
use super::gate::combined;
use super::null::{Null, side_by_side};
use super::question::{Kind, Question};
use super::space::{Block, Form, Frame, Residual, Space, smooth};

/// Stage of the random numbers, apart from those of other tests.
const STAGE: u64 = 0x1_0000_0002;
/// Simulated recordings behind a probability.
const DRAWS: usize = 2048;
/// Directions of the competitor.
const DIRECTIONS: usize = 40;
/// Directions with less than this share of the variance are left out.
const FAINT: f64 = 1e-4;

/// The competitor that resembles the named atoms; `None` if there are none.
pub(super) fn unlisted(space: &Space) -> Option<Block> {
    let named: Vec<&Block> = space
        .blocks
        .iter()
        .filter(|block| block.kind() == Kind::Named)
        .collect();
    let count = named.iter().map(|block| block.basis.ncols()).sum();
    if count == 0 {
        return None;
    }
    let mut columns = DMatrix::zeros(space.z.len(), count);
    let mut place = 0;
    let most = named
        .iter()
        .map(|b| b.log_odds)
        .fold(f64::NEG_INFINITY, f64::max);
    for block in named {
        let weight = libm::exp(block.log_odds - most) / block.basis.ncols() as f64;
        for column in block.basis.column_iter() {
            columns.set_column(place, &(column * weight.sqrt()));
            place += 1;
        }
    }
    columns /= columns.norm();
    let columns = condensed(columns);
    let (ladder, basis) = smooth(columns.clone())?;
    Some(Block {
        atom: usize::MAX,
        candidate: usize::MAX,
        log_odds: 0.0,
        form: Form::Smooth(ladder),
        basis,
        columns,
        kept: Vec::new(),
    })
}

/// Few columns with nearly the same MMᵀ: coordinates of all along the directions in which most of
/// them lie.
fn condensed(columns: DMatrix<f64>) -> DMatrix<f64> {
    let mut left = columns.clone();
    let mut directions: Vec<usize> = Vec::new();
    let mut basis = DMatrix::zeros(columns.nrows(), 0);
    while directions.len() < DIRECTIONS.min(columns.nrows()) {
        let Some((best, size)) = left
            .column_iter()
            .map(|c| c.norm_squared())
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1))
        else {
            break;
        };
        if !(size > FAINT / DIRECTIONS as f64) {
            break;
        }
        let direction = left.column(best) / size.sqrt();
        let along = left.tr_mul(&direction);
        left -= &direction * along.transpose();
        directions.push(best);
        let last = basis.ncols();
        basis = basis.insert_column(last, 0.0);
        basis.set_column(last, &direction);
    }
    // M Mᵀ ≈ B (BᵀM)(BᵀM)ᵀ Bᵀ: its root has as many columns as directions.
    let coordinates = basis.tr_mul(&columns);
    let root = nalgebra::SymmetricEigen::new(&coordinates * coordinates.transpose());
    let mut half = root.eigenvectors.clone();
    for (mut column, e) in half.column_iter_mut().zip(root.eigenvalues.iter()) {
        column *= e.max(0.0).sqrt();
    }
    basis * half
}

/// By how much (logarithm of the odds, without prior odds of the competitor) a named set is better than
/// the competitor with the best part of the set.
pub(super) fn margin(space: &Space, named: &[usize]) -> f64 {
    let Some(competitor) = unlisted(space) else {
        return f64::INFINITY;
    };
    let Some(whole) = space.frame(named) else {
        return f64::INFINITY;
    };
    let own = space.score(&whole);
    let count = named.len();
    let rival = (0..(1_usize << count) - 1)
        .filter_map(|subset| {
            let part: Vec<usize> = (0..count)
                .filter(|i| subset & (1 << i) != 0)
                .map(|i| named[i])
                .collect();
            let frame = space.frame(&part)?;
            Some(space.score(&frame) + beside(space, &frame, &competitor)?)
        })
        .fold(f64::NEG_INFINITY, f64::max);
    own - rival
}

/// Probability that as much is left beside a set as there is, if the set is all there is: of the
/// competitor's evidence and of χ² as a whole, the less probable of the two.
///
/// The gate looks everywhere and pays for it. These two look at one thing each: directions that the
/// catalogue cares for, and everything.
pub(super) fn leftover(space: &Space, question: &Question, named: &[usize]) -> f64 {
    let (Some(frame), Some(competitor)) = (space.frame(named), unlisted(space)) else {
        return 1.0;
    };
    let Some(block) = competitor.beside(&frame.basis) else {
        return 1.0;
    };
    let residual = space.residual(&frame);
    let components = block.basis.tr_mul(&space.z);
    let observed = [
        block.evidence(components.iter().copied(), &residual),
        excess(&residual),
    ];
    let null = Null::new(question.baseline, question.settings.seed, STAGE);
    let absorbed = [question.baseline.absorbed(), &frame.basis];
    let draws: Vec<[f64; 2]> = side_by_side(DRAWS / gumption_lanes::LANES, |index| {
        let chunk = null.chunk(index);
        let components = &chunk.errors * &block.basis;
        let residuals = chunk.residuals(&absorbed, residual);
        let one = |(lane, residual): (usize, &Residual)| {
            let own = components.row(lane);
            [
                block.evidence(own.iter().copied(), residual),
                excess(residual),
            ]
        };
        residuals.iter().enumerate().map(one).collect::<Vec<_>>()
    })
    .into_iter()
    .flatten()
    .collect();
    combined(observed, &draws)
}

/// χ² over what is known of its scale; the same for all if nothing is.
fn excess(residual: &Residual) -> f64 {
    match residual.scale {
        Scale::Known => residual.chi_squared,
        Scale::Estimated { .. } => {
            let known = residual.rss - residual.chi_squared;
            if known > 0.0 {
                residual.chi_squared / known
            } else {
                0.0
            }
        }
    }
}

/// Whether a named set stands against an unlisted effect. Several effects have to be better than one
/// that is not listed; a single one that is worse would not have passed the gate as complete, and where
/// it is one of a list, the list and not the set would have to be compared.
pub(super) fn stands(margin: f64, effects: usize) -> bool {
    effects < 2 || margin >= 0.0
}

fn beside(space: &Space, frame: &Frame, competitor: &Block) -> Option<f64> {
    let block = competitor.beside(&frame.basis)?;
    let residual = space.residual(frame);
    let components = block.basis.tr_mul(&space.z);
    Some(block.evidence(components.iter().copied(), &residual))
}
