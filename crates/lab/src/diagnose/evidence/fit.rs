//! Estimates of adopted effects, their strength and their distance to rivals.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use super::closed_form::Scale;
use super::directions::{all, inverse, without};
use super::findings::{Fitted, Rival};
use super::question::{Kind, Question};
use super::remainders::Remainders;
use super::space::{Frame, Space};
use gumption_core::special::normal_cdf;

/// Two explanations of which less than this share of λ distinguishes them are one.
const ALIAS: f64 = 0.01;
/// Logarithm of the odds 0.95 : 0.05.
const SURE: f64 = 2.94;

/// Coefficients of one effect beside a set.
pub(super) struct Estimate {
    pub(super) coefficients: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
    pub(super) dof: f64,
    pub(super) lambda: f64,
    /// The effect in z, beside the set.
    pub(super) visible: DVector<f64>,
    /// Standard deviation of the noise in whitened units.
    pub(super) sigma: f64,
}

/// The coefficients of a named block when it joins a set.
pub(super) fn estimate(space: &Space, rest: &Frame, block: usize) -> Estimate {
    let atom = &space.blocks[block];
    let columns = without(&atom.determined(), &rest.basis);
    let with = space.extended(rest, block);
    let (sigma, dof) = with
        .as_ref()
        .map_or((1.0, f64::INFINITY), |frame| noise(space, frame));
    let inverse = inverse(&columns);
    let (found, spread) = (&inverse * &space.z, &inverse * inverse.transpose());
    let visible = &columns * &found;
    let width = space.question.atoms[atom.atom].shape.width();
    let mut coefficients = DVector::from_element(width, f64::NAN);
    let mut covariance = DMatrix::from_element(width, width, f64::NAN);
    for (i, a) in atom.kept.iter().enumerate() {
        coefficients[*a] = found[i];
        for (j, b) in atom.kept.iter().enumerate() {
            covariance[(*a, *b)] = spread[(i, j)] * sigma * sigma;
        }
    }
    Estimate {
        coefficients,
        covariance,
        dof,
        lambda: visible.norm() / sigma,
        visible,
        sigma,
    }
}

/// What is left of an effect after its nearest rival is fitted in its place; rivals are named atoms of
/// causes other than its own, and not of the set. With enough coefficients anything does what one effect does: a rival has one more
/// at most.
pub(super) fn nearest(
    space: &Space,
    rest: &Frame,
    block: usize,
    estimate: &Estimate,
) -> Option<Rival> {
    let own = &space.blocks[block];
    let whole = estimate.visible.norm_squared();
    let beside = Remainders::new(space, rest);
    // Beside the set already, so that nothing has to be taken out.
    let components = space.directions.tr_mul(&estimate.visible);
    beside
        .rests
        .iter()
        .map(|rival| (rival, &space.blocks[rival.block]))
        .filter(|(rival, block)| {
            rival.kind == Kind::Named
                && block.basis.ncols() <= own.basis.ncols() + 1
                && !space.question.same_cause(block.candidate, own.candidate)
        })
        .map(|(rival, block)| {
            let explained = beside.components(rival, &components).norm_squared();
            let kappa = (whole - explained).max(0.0).sqrt() / estimate.sigma;
            Rival {
                atom: block.atom,
                candidate: block.candidate,
                kappa,
                alias: kappa < ALIAS * estimate.lambda,
                resolved: reached(0.0, kappa * kappa, SURE),
            }
        })
        .min_by(|a, b| a.kappa.total_cmp(&b.kappa))
}

/// Probability that log odds reach a level, if what they belong to is the truth and κ² gains so much: on average they gain half
/// of that, with a variance of the whole.
pub(super) fn reached(odds: f64, gain: f64, level: f64) -> f64 {
    /// Less decides nothing.
    const NOTHING: f64 = 1e-6;
    match gain > NOTHING {
        true => normal_cdf((odds + 0.5 * gain - level) / gain.sqrt()),
        false => f64::from(u8::from(odds >= level)),
    }
}

/// All effects of a set together.
pub(super) fn fitted(space: &Space, set: &Frame) -> Fitted {
    let atoms: Vec<usize> = set.blocks.iter().map(|b| space.blocks[*b].atom).collect();
    let columns = set.blocks.iter().map(|b| space.blocks[*b].determined());
    let found = inverse(&all(columns)) * &space.z;
    let mut found = found.iter();
    let mut coefficients = Vec::new();
    for block in set.blocks.iter().map(|b| &space.blocks[*b]) {
        let mut own = vec![f64::NAN; space.question.atoms[block.atom].shape.width()];
        for (at, size) in block.kept.iter().zip(&mut found) {
            own[*at] = *size;
        }
        coefficients.extend(own);
    }
    Fitted {
        atoms,
        coefficients: DVector::from_vec(coefficients),
        chi_squared: space.residual(set).chi_squared,
    }
}

/// Every candidate alone, in its likeliest variant, with the logarithm of its posterior odds against none; the likeliest
/// first.
pub fn singles(question: &Question) -> Vec<(f64, Fitted)> {
    let space = Space::new(question);
    let frames = (0..space.blocks.len()).filter(|block| space.blocks[*block].kind() == Kind::Named);
    let frames = frames.filter_map(|block| space.frame(&[block]));
    let mut scored: Vec<(f64, Frame)> = frames.map(|one| (space.score(&one), one)).collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut seen = BTreeSet::new();
    scored.retain(|(_, one)| seen.insert(space.blocks[one.blocks[0]].candidate));
    let sized = scored
        .iter()
        .map(|(score, one)| (*score, fitted(&space, one)));
    sized.collect()
}

/// Standard deviation of the noise in whitened units, with its degrees of freedom.
pub(super) fn noise(space: &Space, set: &Frame) -> (f64, f64) {
    let dof = match space.scale.less(set.basis.ncols()) {
        Scale::Known => f64::INFINITY,
        Scale::Estimated { total } => total,
    };
    (space.sigma(set), dof)
}
