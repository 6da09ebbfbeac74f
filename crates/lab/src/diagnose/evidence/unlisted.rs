//! The open-set guard: an effect that is not in the catalogue, but looks like what is.
//!
//! With the true effect missing from the catalogue, its next of kin explains most of it, or two others
//! together do. What an unlisted effect may look like is told by the catalogue itself: a discrepancy
//! whose covariance matrix is the average of AAᵀ over all named atoms (each of unit length, candidates
//! alike). A named set has to be better by far than this competitor, alone or with a part of the set.

use gumption_core::least_squares::axes;
use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::closed_form::{Ladder, Scale};
use super::departure::{self, FORM};
use super::detection::combined;
use super::directions::{joined, without};
use super::fit::estimate;
use super::null::Simulated;
use super::question::Kind;
use super::remainders::Remainders;
use super::space::{Frame, Residual, Space, smooth};
use crate::diagnose::parallel::side_by_side;

/// Simulated recordings behind a probability.
const DRAWS: usize = 2048;
/// Share of an effect (squared) that a generic has to hold to be able to say it again.
const HELD: f64 = 0.9;
/// Logarithm of the Bayes factor from which on a generic says more than the named effects.
const MORE: f64 = 1.0;
/// Logarithm of the odds that a generic loses that says nothing more, for each effect that it says again.
const DISCOUNT: f64 = 3.0;
/// Directions of the competitor.
const DIRECTIONS: usize = 40;
/// Directions with less than this share of the variance are left out.
const FAINT: f64 = 1e-4;

/// Directions of features beside a set, with their evidence; `None` if nothing is left of them.
fn beside(features: &DMatrix<f64>, frame: &Frame) -> Option<(Ladder, DMatrix<f64>)> {
    smooth(without(features, &frame.basis))
}

/// The competitor that resembles the named atoms: features, of which the covariance matrix is the sum of squares; `None` if
/// there are none.
pub(super) fn unlisted(space: &Space) -> Option<DMatrix<f64>> {
    let most = (space.blocks.iter())
        .filter(|block| block.kind() == Kind::Named)
        .map(|block| block.log_odds)
        .fold(f64::NEG_INFINITY, f64::max);
    let mut weights = DVector::zeros(space.directions.ncols());
    for (index, block) in space.blocks.iter().enumerate() {
        if block.kind() == Kind::Named {
            let share = libm::exp(block.log_odds - most) / block.basis.ncols() as f64;
            let places = space.places(index);
            weights.rows_mut(places.start, places.len()).fill(share);
        }
    }
    let whole = weights.sum();
    if !(whole > 0.0) {
        return None;
    }
    let features = condensed(&space.directions, &(weights / whole));
    (features.ncols() > 0).then_some(features)
}

/// Few columns M with nearly MMᵀ = Σ w uuᵀ for unit directions u with weights: coordinates along the
/// directions in which most of them lie.
fn condensed(directions: &DMatrix<f64>, weights: &DVector<f64>) -> DMatrix<f64> {
    // What is left of the squared length of each column.
    let mut left = weights.clone();
    let mut basis = DMatrix::zeros(directions.nrows(), 0);
    // Components of all columns along the basis, one row each.
    let mut coordinates: Vec<DVector<f64>> = Vec::new();
    while coordinates.len() < DIRECTIONS.min(directions.nrows()) {
        let (best, size) = left.argmax();
        if !(size > FAINT / DIRECTIONS as f64) {
            break;
        }
        let column = directions.columns_range(best..best + 1).into_owned();
        let mut direction = without(&without(&column, &basis), &basis);
        let length = direction.norm();
        if !(length > 0.0) {
            break;
        }
        direction /= length;
        let along = directions.tr_mul(&direction).column(0).into_owned();
        left.zip_zip_apply(weights, &along, |left, w, a| *left -= w * a * a);
        left[best] = 0.0;
        basis = joined(&basis, &direction);
        coordinates.push(along.zip_map(weights, |a, w| a * w.sqrt()));
    }
    // M Mᵀ ≈ B C Cᵀ Bᵀ: its root has as many columns as directions.
    let products = DMatrix::from_fn(coordinates.len(), coordinates.len(), |i, j| {
        coordinates[i].dot(&coordinates[j])
    });
    let Some(root) = axes(products) else {
        return DMatrix::zeros(basis.nrows(), 0);
    };
    let mut half = root.eigenvectors.clone();
    for (mut column, e) in half.column_iter_mut().zip(root.eigenvalues.iter()) {
        column *= e.max(0.0).sqrt();
    }
    basis * half
}

/// Whether a named set is as good as the competitor with the best part of the set, without prior odds of the competitor. Several
/// effects have to be; a single one that is worse would not have passed the gate as complete, and where it is one of a list,
/// the list and not the set would have to be compared.
pub(super) fn stands(space: &Space, named: &[usize], competitor: &DMatrix<f64>) -> bool {
    let Some(whole) = space.frame(named).filter(|_| named.len() > 1) else {
        return true;
    };
    let is_as_good = |subset: usize| {
        let part = (0..named.len()).filter(|at| subset & (1 << at) != 0);
        let frame = space.frame(&part.map(|at| named[at]).collect::<Vec<_>>())?;
        let (ladder, basis) = beside(competitor, &frame)?;
        let components = basis.tr_mul(&space.z);
        let more = evidence(&ladder, components.iter(), &space.residual(&frame));
        Some(space.score(&whole) >= space.score(&frame) + more)
    };
    let mut parts = 0..(1_usize << named.len()) - 1;
    parts.all(|subset| is_as_good(subset).unwrap_or(true))
}

/// Probability that as much is left beside a set as there is, if the set is all there is: of the
/// competitor's evidence and of χ² as a whole, the less probable of the two.
///
/// The gate looks everywhere and pays for it. These two look at one thing each: directions that the
/// catalogue cares for, and everything.
pub(super) fn leftover(
    space: &Space,
    named: &[usize],
    competitor: &DMatrix<f64>,
    simulated: &Simulated,
) -> f64 {
    let frame = space.frame(named);
    let left = frame.and_then(|frame| Some((beside(competitor, &frame)?, frame)));
    let Some(((ladder, basis), frame)) = left else {
        return 1.0;
    };
    let residual = space.residual(&frame);
    let components = basis.tr_mul(&space.z);
    let in_form = Residual {
        chi_squared: residual.chi_squared - FORM * FORM * frame.fit,
        rss: residual.rss - FORM * FORM * frame.fit,
        ..residual
    };
    let observed = [
        evidence(&ladder, components.iter(), &residual)
            - departure::left(FORM, space.strength(&frame)),
        excess(&in_form),
    ];
    let chunks = simulated.chunks().clamp(1, DRAWS / gumption_lanes::LANES);
    let draws: Vec<[f64; 2]> = side_by_side(chunks, |index| {
        let recordings = simulated.chunk(index);
        let components = &recordings.errors * &basis;
        let set = &recordings.errors * &frame.basis;
        let residuals = recordings.residuals(&set, residual);
        let one = |(lane, residual): (usize, &Residual)| {
            let own = components.row(lane);
            [evidence(&ladder, own.iter(), residual), excess(residual)]
        };
        residuals.iter().enumerate().map(one).collect::<Vec<_>>()
    })
    .concat();
    combined(observed, &draws)
}

/// Generics that only say again what named effects say: a curve over the supply contains the straight
/// line, and where the line fits, the line is meant. What they gain where the form of an effect is not quite that of the
/// catalogue is no reason for them either.
///
/// For each of them, what is taken from the logarithm of its odds.
#[derive(Debug, Default)]
pub(super) struct Restated(BTreeMap<usize, f64>);

impl Restated {
    /// Beside a set that explains the recording.
    pub(super) fn of(space: &Space, named: &[usize]) -> Restated {
        let Some(frame) = space.frame(named) else {
            return Restated::default();
        };
        let effects: Vec<DVector<f64>> = named
            .iter()
            .map(|block| {
                let others: Vec<usize> = named.iter().copied().filter(|b| b != block).collect();
                let rest = space.frame_of(&others);
                estimate(space, &rest, *block).visible
            })
            .collect();
        let beside = Remainders::new(space, &frame);
        let observed = beside.observed();
        let says_more = |generic: usize| {
            let rest = beside.rests.iter().find(|rest| rest.block == generic);
            rest.is_some_and(|rest| {
                let components = beside.components(rest, &observed);
                let squares = components.iter().map(|c| c * c);
                rest.evidence(squares, &beside.residual) > MORE
            })
        };
        let generics =
            (space.blocks.iter().enumerate()).filter(|(_, block)| block.kind() == Kind::Generic);
        let of_form = departure::left(FORM, space.strength(&frame));
        let again = generics.map(|(index, block)| {
            let holds = |effect: &&DVector<f64>| {
                let held = block.basis.tr_mul(*effect).norm_squared();
                held > HELD * effect.norm_squared()
            };
            let held = effects.iter().filter(holds).count();
            let again = if says_more(index) { 0 } else { held };
            (index, of_form + DISCOUNT * again as f64)
        });
        Restated(again.collect())
    }

    /// What is taken from the logarithm of the odds of a block.
    pub(super) fn discount(&self, block: usize) -> f64 {
        self.0.get(&block).copied().unwrap_or(0.0)
    }
}

/// χ² over what is known of its scale; the same for all if nothing is.
fn excess(residual: &Residual) -> f64 {
    match residual.scale {
        Scale::Known => residual.chi_squared,
        Scale::Estimated { .. } => {
            let known = residual.rss - residual.chi_squared;
            match known > 0.0 {
                true => residual.chi_squared / known,
                false => 0.0,
            }
        }
    }
}

/// Logarithm of the Bayes factor of the competitor against none, from the components of the residuals.
fn evidence<'c>(
    ladder: &Ladder,
    components: impl Iterator<Item = &'c f64> + Clone,
    residual: &Residual,
) -> f64 {
    let squares = components.map(|c| c * c);
    ladder.log_bayes_factor(squares, residual.rss, residual.scale)
}
