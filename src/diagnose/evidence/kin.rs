//! Candidates that nature may have meant although one variant of another fits best.
//!
//! The variants of a candidate are points of a grid: one time constant, one lag. Bodies have several
//! time constants and none lies on the grid, so that what the best variant leaves is explained by some
//! other candidate better than by nothing. Three consequences are drawn: an effect that is next to
//! nothing beside all that the stronger ones may be mixed to is their shape, and its name tentative; a
//! rival of which two variants together are what was found belongs on the list; and so does every alias,
//! whatever the odds say.

use nalgebra::{DMatrix, DVector};

use super::beside::Beside;
use super::fit::Estimate;
use super::question::{Kind, Question};
use super::space::{Block, Form, Frame, Space, joined, orthonormal, without};

/// Explanations whose directions have a cosine of more than 0.995 are one: squared.
const ALIAS: f64 = 0.99;
/// A mixture of two variants is a rival if it leaves less than this many standard deviations …
const KIN: f64 = 2.0;
/// … and no more than this share of the effect (squared).
const KIN_SHARE: f64 = 0.04;
/// Variants that have less than this in common with an effect (cosine squared) are no part of it.
const PART: f64 = 0.25;
/// Variants of a candidate that are tried in pairs.
const PAIRED: usize = 10;
/// Directions that a mixture adds for each coefficient.
const DIRECTIONS: usize = 4;
/// A direction of a mixture of which less than this (squared) is left is not counted.
const FAINT: f64 = 1e-4;
/// λ beside the mixtures of the stronger effects from which on a weaker one is an effect.
const APART: f64 = 5.0;

/// Candidates that have to be on the list of a slot whose most probable block has this estimate.
pub(super) fn listed(
    space: &Space,
    question: &Question,
    rest: &Frame,
    winner: usize,
    estimate: &Estimate,
) -> Vec<usize> {
    let beside = Beside::new(space, question, rest);
    let along = space.directions.tr_mul(&estimate.visible);
    let whole = estimate.visible.norm_squared();
    let own = &space.blocks[winner];
    let place = &question.candidates[own.candidate].place;
    // The best share that each candidate's variants explain, with those variants.
    let mut shares: std::collections::BTreeMap<usize, Vec<(f64, usize)>> = Default::default();
    for rival in beside.rests.iter().filter(|rest| rest.kind == Kind::Named) {
        let candidate = space.blocks[rival.block].candidate;
        if candidate != own.candidate {
            let share = beside.components(rival, &along).norm_squared() / whole;
            if share > PART {
                shares
                    .entry(candidate)
                    .or_default()
                    .push((share, rival.block));
            }
        }
    }
    let mut found = Vec::new();
    for (candidate, mut variants) in shares {
        variants.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (best, block) = variants[0];
        // A candidate at the same place with more coefficients is the same, more general.
        let general = question.candidates[candidate].place == *place
            && space.blocks[block].basis.ncols() > own.basis.ncols();
        let alias = best > ALIAS && !general;
        let mixes = !question.candidates[candidate].repeats && variants.len() > 1;
        if alias || (mixes && kin(space, rest, &variants, estimate)) {
            found.push(candidate);
        }
    }
    found
}

/// Whether two variants together are what was found, neither with a negative share.
fn kin(space: &Space, rest: &Frame, variants: &[(f64, usize)], estimate: &Estimate) -> bool {
    let target = &estimate.visible;
    let whole = target.norm_squared();
    let least = (KIN * estimate.sigma).powi(2).min(KIN_SHARE * whole);
    let tried: Vec<DVector<f64>> = variants
        .iter()
        .filter(|(_, block)| space.blocks[*block].basis.ncols() == 1)
        .take(PAIRED)
        .map(|(_, block)| without(&space.blocks[*block].determined(), &rest.basis))
        .map(|column| column.column(0).into_owned())
        .collect();
    (0..tried.len()).any(|j| {
        (0..j).any(|i| {
            let (a, b) = (&tried[i], &tried[j]);
            let (aa, bb, ab) = (a.norm_squared(), b.norm_squared(), a.dot(b));
            let (at, bt) = (a.dot(target), b.dot(target));
            let determinant = aa * bb - ab * ab;
            if !(determinant > FAINT * aa * bb) {
                return false;
            }
            let (x, y) = (
                (at * bb - bt * ab) / determinant,
                (bt * aa - at * ab) / determinant,
            );
            x * y >= 0.0 && whole - x * at - y * bt < least
        })
    })
}

/// Blocks, the strongest first, that are next to nothing beside those before them and all that these may
/// be mixed to.
pub(super) fn shapes(space: &Space, question: &Question, strongest_first: &[usize]) -> Vec<usize> {
    let mut basis = DMatrix::zeros(space.z.len(), 0);
    let mut found = Vec::new();
    for (place, &index) in strongest_first.iter().enumerate() {
        let block = &space.blocks[index];
        if place > 0 && lambda(space, block, &basis) < APART {
            found.push(index);
            continue;
        }
        let own = orthonormal(
            without(&block.basis, &basis),
            &vec![1.0; block.basis.ncols()],
            FAINT,
        );
        basis = joined(&basis, &own.0);
        let mixture = mixture(space, question, block, &basis);
        basis = joined(&basis, &mixture);
    }
    found
}

/// Size of what a block explains beside a basis, over the noise.
fn lambda(space: &Space, block: &Block, basis: &DMatrix<f64>) -> f64 {
    let left = orthonormal(
        without(&block.basis, basis),
        &vec![1.0; block.basis.ncols()],
        FAINT,
    )
    .0;
    left.tr_mul(&space.z).norm() / space.sigma(basis.ncols() + left.ncols(), basis, &left)
}

/// What the variants of a candidate that resemble one of them span beside a basis.
fn mixture(
    space: &Space,
    question: &Question,
    block: &Block,
    basis: &DMatrix<f64>,
) -> DMatrix<f64> {
    let d = block.basis.ncols();
    if question.candidates[block.candidate].repeats {
        return DMatrix::zeros(basis.nrows(), 0);
    }
    let alike = |other: &&Block| {
        other.candidate == block.candidate
            && other.atom != block.atom
            && matches!(other.form, Form::Named)
            && other.basis.ncols() == d
            && block.basis.tr_mul(&other.basis).norm_squared() > PART * d as f64
    };
    let columns: Vec<_> = (space.blocks.iter().filter(alike))
        .flat_map(|other| other.basis.column_iter())
        .collect();
    if columns.is_empty() {
        return DMatrix::zeros(basis.nrows(), 0);
    }
    let columns = DMatrix::from_columns(&columns);
    let lengths = vec![1.0; columns.ncols()];
    let found = orthonormal(without(&columns, basis), &lengths, FAINT).0;
    let most = found.ncols().min(DIRECTIONS * d);
    found.columns(0, most).into_owned()
}
