//! Sets of slips that give every claimed figure.

use crate::calculate::{Calculation, Case};
use crate::slips::{Act, Change, Reporting};

use super::{chance, row};

/// A set of slips that gives every claimed figure.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The slips.
    pub acts: Vec<Act>,
    /// The calculation with them.
    pub calculation: Calculation,
}

/// The most usual first, of equally usual ones those that leave the rows and u_c as they are printed; of several variants of one
/// set the first.
pub(super) fn rank(case: &Case<'_>, explanations: &mut Vec<Explanation>) {
    explanations.sort_by_key(|e| {
        let surprise = e.acts.iter().map(|act| row::surprise(case, act));
        let denies_rows = !e.acts.iter().all(Act::acts_behind_sum);
        (surprise.sum::<u32>(), denies_rows)
    });
    let mut seen: Vec<Vec<String>> = Vec::new();
    explanations.retain(|e| {
        let mut ids: Vec<String> = e.acts.iter().map(|act| act.id(case)).collect();
        ids.sort();
        let new = !seen.contains(&ids);
        seen.push(ids);
        new
    });
}

/// Whether no set of so few slips gives U without a unit that its figure does not belong to: a figure that has nothing to
/// do with slips is known to a factor of two, so that one which is off by a power of ten is no accident. What is left to
/// ask is the other slip.
pub(super) fn is_of_another_unit(explanations: &[Explanation], slips: usize) -> bool {
    let is_far = |act: &Act| match act.change {
        Change::Report(Reporting::Scale(factor)) => libm::log(factor).abs() > 2.0 * chance::WIDEST,
        _ => false,
    };
    let mut fewest = explanations.iter().filter(|one| one.acts.len() == slips);
    fewest.all(|one| one.acts.iter().any(is_far))
}
