//! From which probability of an accident on slips are not named.

use crate::slips::Act;

/// How often, one against the other, sheets are assumed to have one slip, two, and something that is no slip of the
/// grammar: of twenty, eleven, four and two.
const ODDS: [f64; 3] = [1.0, 11.0, 4.0];
const ODDS_OF_NO_NAME: f64 = 2.0;

/// In a report, no more names than one in twenty are expected to be wrong.
const WRONG: f64 = 0.05;

/// Whether slips may be named that are no accident with this probability: two that are one are two wrong names.
pub(super) fn is_sure(slips: usize, no_accident: f64) -> bool {
    slips as f64 * (1.0 - no_accident) <= WRONG
}

/// The probability that a set of `slips` which matches is no accident, where a claim that has nothing to do with slips is
/// matched with the probability `accident`.
pub(super) fn no_accident(slips: usize, accident: f64) -> f64 {
    let odds = ODDS[slips.min(2)];
    odds / (odds + ODDS_OF_NO_NAME * accident)
}

/// The same where u_c follows and U does not, of which this `share` of the kinds of slips is capable. Something without a
/// name sits there as often as one slip does; that both of two do is rarer by the share.
pub(super) fn no_accident_behind(slips: usize, share: f64, accident: f64) -> f64 {
    let others = slips.saturating_sub(1) as f64;
    no_accident(slips, accident / libm::pow(share, others))
}

/// How many of the kinds of slips act behind u_c.
pub(super) fn share_behind(acts: &[Act]) -> f64 {
    let kinds = |of: &dyn Fn(&Act) -> bool| {
        let mut ids: Vec<&str> = acts
            .iter()
            .filter(|act| of(act))
            .map(|act| act.slip.id)
            .collect();
        ids.sort_unstable();
        ids.dedup();
        ids.len() as f64
    };
    kinds(&Act::acts_behind_sum) / kinds(&|_| true).max(1.0)
}
