//! Candidates that nature may have meant although one variant of another fits best.
//!
//! The variants of a candidate are points of a grid: one time constant, one lag. Bodies have several
//! time constants and none lies on the grid, so that what the best variant leaves is explained by some
//! other candidate better than by nothing. Three consequences are drawn: an effect that is next to
//! nothing beside all that the stronger ones may be mixed to is their shape, and its name tentative; a
//! rival of which two variants together are what was found belongs on the list; and so does every alias,
//! whatever the odds say.

use nalgebra::{DMatrix, DVector};

use super::directions::{joined, left, orthonormal, without};
use super::fit::Estimate;
use super::question::Kind;
use super::remainders::Remainders;
use super::space::{Block, Form, Frame, Space};

/// Explanations whose directions have a cosine of more than 0.995 are one: squared …
const ALIAS: f64 = 0.99;
/// … unless the effect is so strong that what a rival leaves of it has this many standard deviations.
const TOLD_APART: f64 = 8.0;
/// A mixture of two variants is a rival if it leaves less than this many standard deviations …
const KIN: f64 = 2.0;
/// … and no more than this share of the effect (squared).
const KIN_SHARE: f64 = 0.04;
/// What is left (squared) of an effect by an explanation that has it as a part: rounding.
const HELD: f64 = 1e-8;
/// Variants that have less than this in common with an effect (cosine squared) are no part of it.
const PART: f64 = 0.25;
/// Variants of a candidate that are tried in pairs.
const PAIRED: usize = 10;
/// Directions that a mixture adds for each coefficient.
const DIRECTIONS: usize = 4;
/// A direction of a mixture of which less than this (squared) is left is not counted.
const FAINT: f64 = 1e-4;
/// λ beside the mixtures of the stronger effects from which on a weaker one is an effect …
const APART: f64 = 5.0;
/// … and from which on one that only describes (a bad row, a jump) is: any misfit has a worst row.
const DESCRIBED_APART: f64 = 8.0;

/// Candidates that have to be on the list of a slot whose most probable block has this estimate.
pub(super) fn listed(
    space: &Space,
    rest: &Frame,
    winner: usize,
    estimate: &Estimate,
) -> Vec<usize> {
    let beside = Remainders::new(space, rest);
    let along = space.directions.tr_mul(&estimate.visible);
    let whole = estimate.visible.norm_squared();
    let own = &space.blocks[winner];
    let place = &space.question.candidates[own.candidate].place;
    // The best share that each candidate's variants explain, with those variants.
    let mut shares: std::collections::BTreeMap<usize, Vec<(f64, usize)>> = Default::default();
    for rival in beside.rests.iter().filter(|rest| rest.kind == Kind::Named) {
        let candidate = space.blocks[rival.block].candidate;
        if !space.question.same_cause(candidate, own.candidate) {
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
        // A candidate at the same place with more coefficients that has a variant as a part is the same, more general;
        // one with many more, such as a value of its own for each level, holds anything.
        let (more, few) = (space.blocks[block].basis.ncols(), own.basis.ncols());
        let left = (1.0 - best).max(0.0) * whole;
        let near = left < (TOLD_APART * estimate.sigma).powi(2);
        let general = || {
            let same = more > few && space.question.candidates[candidate].place == *place;
            more > few + 1 || (same && has_as_part(space, &beside, rest, block, own.candidate))
        };
        let rival = &space.question.candidates[candidate];
        let alias = best > ALIAS && near && !rival.happens && !general();
        let mixes = !rival.repeats && variants.len() > 1;
        if alias || (mixes && kin(space, rest, &variants, estimate)) {
            found.push(candidate);
        }
    }
    found
}

/// Whether a block explains all of some variant of a candidate: a square with a line has the line as a part.
fn has_as_part(
    space: &Space,
    beside: &Remainders<'_>,
    rest: &Frame,
    block: usize,
    candidate: usize,
) -> bool {
    let Some(general) = beside.rests.iter().find(|rest| rest.block == block) else {
        return false;
    };
    let variants = space.blocks.iter().filter(|own| own.candidate == candidate);
    let single = variants.filter(|own| own.basis.ncols() == 1);
    single
        .map(|own| without(&own.determined(), &rest.basis))
        .any(|column| {
            let column = column.column(0).into_owned();
            let whole = column.norm_squared();
            let along = space.directions.tr_mul(&column);
            let held = beside.components(general, &along).norm_squared();
            whole > 0.0 && whole - held < HELD * whole
        })
}

/// Whether a rival, given by the columns of its variants, stays on the list of an effect of `own` coefficients
/// whatever the odds say; all is seen beside the parameters, over the noise.
pub(super) fn stays(effect: &DVector<f64>, own: usize, variants: &[DMatrix<f64>]) -> bool {
    let whole = effect.norm_squared();
    let as_one = DMatrix::from_columns(std::slice::from_ref(effect));
    let few = variants.iter().filter(|columns| columns.ncols() <= own + 1);
    let shares = few.map(|columns| {
        let left = left(&as_one, [columns.clone()])[0].powi(2);
        (1.0 - left / whole, columns)
    });
    let mut near: Vec<(f64, &DMatrix<f64>)> = shares.filter(|(share, _)| *share > PART).collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let alias = |(share, _): &(f64, _)| {
        *share > ALIAS && (1.0 - share).max(0.0) * whole < TOLD_APART * TOLD_APART
    };
    let single = near.iter().filter(|(_, columns)| columns.ncols() == 1);
    let tried: Vec<DVector<f64>> = single
        .take(PAIRED)
        .map(|(_, columns)| columns.column(0).into_owned())
        .collect();
    near.first().is_some_and(alias) || mixed(&tried, effect, 1.0)
}

/// Whether two variants together are what was found, neither with a negative share.
fn kin(space: &Space, rest: &Frame, variants: &[(f64, usize)], estimate: &Estimate) -> bool {
    let tried: Vec<DVector<f64>> = variants
        .iter()
        .filter(|(_, block)| space.blocks[*block].basis.ncols() == 1)
        .take(PAIRED)
        .map(|(_, block)| without(&space.blocks[*block].determined(), &rest.basis))
        .map(|column| column.column(0).into_owned())
        .collect();
    mixed(&tried, &estimate.visible, estimate.sigma)
}

/// Whether two columns together are as good as an effect, neither with a negative share.
fn mixed(tried: &[DVector<f64>], target: &DVector<f64>, sigma: f64) -> bool {
    let whole = target.norm_squared();
    let least = (KIN * sigma).powi(2).min(KIN_SHARE * whole);
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
pub(super) fn shapes(space: &Space, strongest_first: &[usize]) -> Vec<usize> {
    // The noise is what all of them leave: the strongest alone would leave the others in it.
    let sigma = space.sigma(&space.frame_of(strongest_first));
    let mut basis = DMatrix::zeros(space.z.len(), 0);
    let mut found = Vec::new();
    for (place, &index) in strongest_first.iter().enumerate() {
        let block = &space.blocks[index];
        let apart = match space.question.candidates[block.candidate].describes {
            true => DESCRIBED_APART,
            false => APART,
        };
        if place > 0 && explained(space, block, &basis) < apart * sigma {
            found.push(index);
            continue;
        }
        let own = orthonormal(
            without(&block.basis, &basis),
            &vec![1.0; block.basis.ncols()],
            FAINT,
        );
        basis = joined(&basis, &own.0);
        let mixture = mixture(space, block, &basis);
        basis = joined(&basis, &mixture);
    }
    found
}

/// Size of what a block explains beside a basis.
fn explained(space: &Space, block: &Block, basis: &DMatrix<f64>) -> f64 {
    let left = orthonormal(
        without(&block.basis, basis),
        &vec![1.0; block.basis.ncols()],
        FAINT,
    )
    .0;
    left.tr_mul(&space.z).norm()
}

/// What the variants of a candidate that resemble one of them span beside a basis.
fn mixture(space: &Space, block: &Block, basis: &DMatrix<f64>) -> DMatrix<f64> {
    let d = block.basis.ncols();
    if space.question.candidates[block.candidate].repeats {
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use gumption_lanes::{Block as Lanes, Generator, level};

    use super::super::findings::{Examination, Slot, State};
    use super::super::fixture::{Asked, shape, white};
    use super::super::question::Candidate;
    use super::*;
    use gumption_core::special::normal_quantile;

    const ROWS: usize = 80;

    fn column(f: impl Fn(f64) -> f64) -> DVector<f64> {
        DVector::from_fn(ROWS, |row, _| f(row as f64 * 0.5))
    }

    fn relaxation(tau: f64) -> DVector<f64> {
        column(|t| libm::exp(-t / tau))
    }

    fn wave() -> DVector<f64> {
        column(|t| libm::sin(1.9 * t))
    }

    fn errors(stream: u64) -> DVector<f64> {
        let mut generator = Generator::new(20, 3, stream);
        let mut block = Lanes::ZERO;
        let mut out = Vec::new();
        while out.len() < ROWS {
            generator.uniforms(level(), &mut block);
            out.extend(block.0.iter().map(|u| normal_quantile(*u)));
        }
        out.truncate(ROWS);
        DVector::from_vec(out)
    }

    /// A constant is fitted; relaxations of one time constant and other courses are on offer.
    fn asked_of(effect: &DVector<f64>, stream: u64) -> Asked {
        let named = [
            (
                "relaxation",
                [1.0, 2.5, 6.0, 15.0, 40.0].map(relaxation).to_vec(),
            ),
            ("slope", vec![column(|t| t)]),
            ("square", vec![column(|t| (t - 20.0) * (t - 20.0))]),
            ("inverse", vec![column(|t| 1.0 / (1.0 + t))]),
            ("root", vec![column(f64::sqrt)]),
            ("sine", vec![wave()]),
            ("slow wave", vec![column(|t| libm::sin(0.4 * t))]),
            (
                "power",
                vec![column(|t| libm::exp(-t / 6.0) + libm::exp(-t / 2.5))],
            ),
        ];
        let asked = Asked::of(&(effect + errors(stream)), &white(ROWS));
        let each = named.into_iter().enumerate();
        each.fold(asked, |asked, (at, (name, variants))| {
            let shapes = variants.into_iter().map(shape).collect();
            asked.with(Candidate::plain(name, at), shapes)
        })
    }

    /// What is found, and the unique names.
    fn asked(effect: &DVector<f64>, stream: u64) -> (Examination, Vec<String>) {
        let asked = asked_of(effect, stream);
        let found = asked.examined();
        let unique = found.slots.iter().filter(|s| s.state == State::Identified);
        let candidates = asked.question().candidates;
        let name = |slot: &Slot| candidates[slot.named[0].candidate].name.clone();
        let names = unique.map(name).collect();
        (found, names)
    }

    #[test]
    fn what_mends_the_shape_of_another_effect_has_no_name_of_its_own() {
        for stream in 0..6 {
            let effect = relaxation(1.7) * 40.0 + relaxation(20.0) * 40.0;
            let (found, names) = asked(&effect, stream);
            assert!(found.levels.len() > 2, "one variant does not suffice");
            assert!(names.is_empty() || names == ["relaxation"], "{names:?}");
        }
    }

    #[test]
    fn a_second_effect_is_no_shape_of_the_first() {
        let effect = relaxation(15.0) * 20.0 + wave() * 4.0;
        let asked = asked_of(&effect, 1);
        let question = asked.question();
        let space = Space::new(&question);
        let block = |name: &str| {
            let named = |b: &Block| question.candidates[b.candidate].name == name;
            let fit = |b: &Block| b.basis.tr_mul(&space.z).norm();
            (0..space.blocks.len())
                .filter(|b| named(&space.blocks[*b]))
                .max_by(|a, b| fit(&space.blocks[*a]).total_cmp(&fit(&space.blocks[*b])))
                .unwrap()
        };
        let (first, wave, other) = (block("relaxation"), block("sine"), block("inverse"));
        assert!(shapes(&space, &[first, wave]).is_empty());
        assert_eq!(shapes(&space, &[first, wave, other]), [other]);
    }

    /// What is fitted is the first name of every slot, in the variant that is stated with it.
    #[test]
    fn the_model_is_that_of_the_names() {
        let wide = (relaxation(6.0) + relaxation(2.5)) * 20.0;
        for effect in [relaxation(3.9) * 30.0, wave() * 6.0, wide] {
            for stream in 0..4 {
                let (found, _) = asked(&(&effect + wave() * 2.0), stream);
                let firsts = found.slots.iter().filter_map(|slot| slot.named.first());
                let firsts = firsts.filter_map(|first| Some(first.variants.first()?.atom));
                let firsts: BTreeSet<usize> = firsts.collect();
                let atoms = found.fitted.map_or_else(Vec::new, |fitted| fitted.atoms);
                assert_eq!(firsts, BTreeSet::from_iter(atoms), "{stream}");
            }
        }
    }

    #[test]
    fn a_sum_of_two_variants_is_listed_with_their_candidate() {
        let effect = (relaxation(6.0) + relaxation(2.5)) * 20.0;
        let (found, _) = asked(&effect, 1);
        let listed: Vec<usize> = found.slots[0].named.iter().map(|n| n.candidate).collect();
        // The sum is a candidate of its own (7) that fits exactly.
        assert!(listed.contains(&7) && listed.contains(&0), "{listed:?}");
    }
}
