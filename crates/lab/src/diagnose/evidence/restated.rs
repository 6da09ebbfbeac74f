//! Competitors without a name that say again what named effects say.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::departure::{self, FORM};
use super::fit::estimate;
use super::question::{Kind, Question};
use super::remainders::Remainders;
use super::space::Space;

/// Share of an effect (squared) that a generic has to hold to be able to say it again.
const HELD: f64 = 0.9;
/// Logarithm of the Bayes factor from which on a generic says more than the named effects.
const MORE: f64 = 1.0;
/// Logarithm of the odds that a generic loses that says nothing more, for each effect that it says again.
const DISCOUNT: f64 = 3.0;

/// Generics that only say again what named effects say: a curve over the supply contains the straight
/// line, and where the line fits, the line is meant. What they gain where the form of an effect is not quite that of the
/// catalogue is no reason for them either.
///
/// For each of them, what is taken from the logarithm of its odds.
#[derive(Debug, Default)]
pub(super) struct Restated(BTreeMap<usize, f64>);

impl Restated {
    /// Beside a set that explains the recording.
    pub(super) fn of(space: &Space, question: &Question, named: &[usize]) -> Restated {
        let Some(frame) = space.frame(named) else {
            return Restated::default();
        };
        let effects: Vec<DVector<f64>> = named
            .iter()
            .map(|block| {
                let others: Vec<usize> = named.iter().copied().filter(|b| b != block).collect();
                let rest = space.frame_of(&others);
                estimate(space, question, &rest, *block).visible
            })
            .collect();
        let beside = Remainders::new(space, question, &frame);
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
            let only_again = held > 0 && !says_more(index);
            let of_effects = if only_again {
                DISCOUNT * held as f64
            } else {
                0.0
            };
            (index, of_form + of_effects)
        });
        Restated(again.collect())
    }

    /// What is taken from the logarithm of the odds of a block.
    pub(super) fn discount(&self, block: usize) -> f64 {
        self.0.get(&block).copied().unwrap_or(0.0)
    }
}
