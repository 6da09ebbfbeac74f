//! What the size of an effect owes to the choice between explanations of the other effects.
//!
//! The size is estimated beside the most probable explanation of every other slot. Where such a slot has
//! several, the size is known as well as all of them together allow: by the law of total variance
//! Σ p·((b − b₀)² + u² − u₀²) comes on top of u₀², with b₀ and u₀ beside the most probable explanation and b
//! and u beside another one of probability p.

use nalgebra::DVector;

use super::findings::Slot;
use super::fit::{Estimate, estimate};
use super::space::{Frame, Space};

/// Explanations less probable than this make no difference.
const NEGLIGIBLE: f64 = 1e-3;

/// Completes the first alternative of every slot; each comes with the block of the set that it stands for.
pub(super) fn complete(space: &Space, named: &[usize], slots: &mut [(Option<usize>, Slot)]) {
    for at in 0..slots.len() {
        let variances = variances(space, named, slots, at);
        let (Some(variances), Some(first)) = (variances, slots[at].1.named.first_mut()) else {
            continue;
        };
        first.choice = variances.map(|variance| variance.max(0.0).sqrt());
    }
}

/// What comes on top of the variances of the coefficients of a slot's first alternative.
fn variances(
    space: &Space,
    named: &[usize],
    slots: &[(Option<usize>, Slot)],
    at: usize,
) -> Option<DVector<f64>> {
    let (member, slot) = &slots[at];
    let (member, first) = ((*member)?, slot.named.first()?);
    let own = block_of(space, first.variants.first()?.atom)?;
    let others: Vec<usize> = named.iter().copied().filter(|b| *b != member).collect();
    let beside = |rest: &[usize]| {
        let frame: Frame = space.frame(rest)?;
        // Beside an explanation that does the same it has no size.
        space.extended(&frame, own)?;
        Some(estimate(space, &frame, own))
    };
    let usual = beside(&others)?;
    let mut sum = DVector::zeros(usual.coefficients.len());
    for (other, slot) in slots {
        let Some(other) = other.filter(|other| others.contains(other)) else {
            continue;
        };
        for (block, probability) in explanations(space, slot) {
            let kept = others.iter().copied().filter(|b| *b != other);
            let rest: Vec<usize> = kept.chain([block]).collect();
            if let Some(then) = beside(&rest) {
                sum += second_moment(&then, &usual) * probability;
            }
        }
    }
    Some(sum)
}

/// (b − b₀)² + u² − u₀² of each coefficient.
fn second_moment(then: &Estimate, usual: &Estimate) -> DVector<f64> {
    let moved = &then.coefficients - &usual.coefficients;
    moved.component_mul(&moved) + then.covariance.diagonal() - usual.covariance.diagonal()
}

/// Blocks that may stand in a slot, with their probabilities.
fn explanations(space: &Space, slot: &Slot) -> Vec<(usize, f64)> {
    let all = slot.named.iter().flat_map(|alternative| {
        let probability = alternative.probability;
        let variants = alternative.variants.iter();
        variants.map(move |variant| (variant.atom, probability * variant.share))
    });
    all.filter(|(_, probability)| *probability > NEGLIGIBLE)
        .filter_map(|(atom, probability)| Some((block_of(space, atom)?, probability)))
        .collect()
}

/// The block of an atom.
pub(super) fn block_of(space: &Space, atom: usize) -> Option<usize> {
    space.blocks.iter().position(|block| block.atom == atom)
}

#[cfg(test)]
mod tests {
    use super::super::findings::Examination;
    use super::super::fixture::{Asked, course, white};
    use super::*;

    const ROWS: usize = 60;

    fn wave() -> DVector<f64> {
        course(ROWS, |t| libm::sin(14.0 * t))
    }

    /// Two courses that are hard to tell apart, the second of which has a part of the wave in it.
    fn twins() -> [DVector<f64>; 2] {
        let one = course(ROWS, |t| t);
        let other = &one + wave() * 0.08 + course(ROWS, |t| t * t) * 0.2;
        [one, other]
    }

    fn examined(residuals: &DVector<f64>) -> Examination {
        let [one, other] = twins();
        let asked = Asked::of(residuals, &white(ROWS));
        asked.with_each([wave(), one, other]).examined()
    }

    /// First of two coefficients with its variance, by the normal equations.
    fn by_hand(a: &DVector<f64>, b: &DVector<f64>, y: &DVector<f64>) -> (f64, f64) {
        let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
        let det = aa * bb - ab * ab;
        ((bb * a.dot(y) - ab * b.dot(y)) / det, bb / det)
    }

    #[test]
    fn two_explanations_of_one_effect_widen_the_size_of_the_other() {
        let [one, other] = twins();
        let y = wave() * 3.0 + &one * 25.0;
        let found = examined(&y);
        let slot = |candidate: usize| {
            let first = |slot: &&Slot| slot.named[0].candidate == candidate;
            found.slots.iter().find(first).unwrap()
        };
        let list = &slot(1).named;
        assert_eq!(list.len(), 2, "the twins are told apart");
        let (usual, variance) = by_hand(&wave(), &one, &y);
        let (then, its_variance) = by_hand(&wave(), &other, &y);
        let moved = then - usual;
        let expected = list[1].probability * (moved * moved + its_variance - variance);
        let of_wave = &slot(0).named[0];
        assert!((of_wave.estimate[0] - usual).abs() < 1e-9);
        assert!((of_wave.choice[0].powi(2) - expected).abs() < 1e-9 * expected);
        assert!(of_wave.u()[0] > 1.1 * variance.sqrt(), "it matters here");
    }

    #[test]
    fn beside_nothing_there_is_no_choice() {
        let found = examined(&(wave() * 3.0));
        assert_eq!(found.slots.len(), 1);
        let only = &found.slots[0].named[0];
        assert_eq!(only.choice[0], 0.0);
        assert_eq!(only.u()[0], only.covariance[(0, 0)].sqrt());
    }
}
