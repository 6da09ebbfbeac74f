//! What an audit comes to.

use crate::claim::Claimed;
use crate::search::{Explanation, Found, search};

/// Verdict on a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Every claimed figure follows from what is stated.
    Sound,
    /// Slips that do not change the result as it is printed.
    WithoutEffect,
    /// Slips that do.
    WithEffect,
    /// Figures that do not follow, and no slip that gives them.
    Unexplained,
    /// Nothing to compute from, or nothing claimed.
    NotRecomputed,
}

/// An audited claim.
#[derive(Debug, Clone)]
pub struct Audit<'a> {
    /// The verdict.
    pub verdict: Verdict,
    /// What was found.
    pub found: Found<'a>,
}

/// Audits a claim.
pub fn audit(claimed: &Claimed) -> Audit<'_> {
    let found = search(claimed);
    let footer = &claimed.footer;
    let nothing = claimed.rows.is_empty() || found.right.u_c <= 0.0;
    let unclaimed = footer.u_c.is_none() && footer.expanded.is_none();
    let silent = found.gaps.is_empty() && found.explanations.is_empty();
    let verdict = if nothing || unclaimed && (silent || claimed.computes_nothing()) {
        Verdict::NotRecomputed
    } else {
        match found.explanations.first() {
            Some(best) if best.acts.is_empty() => Verdict::Sound,
            Some(best) if has_effect(&found, best) => Verdict::WithEffect,
            Some(_) => Verdict::WithoutEffect,
            None => Verdict::Unexplained,
        }
    };
    Audit { verdict, found }
}

/// Whether U, or u_c where no U is claimed, would be printed differently: rounded as the laboratory rounded, to nearest
/// or up, whichever of them its own figure shows.
fn has_effect(found: &Found<'_>, best: &Explanation) -> bool {
    let claimed = found.case.claimed;
    let Some(expanded) = &claimed.footer.expanded else {
        let u_c = claimed.footer.u_c.as_ref();
        return u_c.is_none_or(|u_c| !u_c.is_met_by(found.right.u_c));
    };
    let nearest = |x: f64| expanded.is_met_by(x);
    let up = |x: f64| expanded.value >= x && expanded.value - x < 2.0 * expanded.half;
    let cmc = claimed.cmc.as_ref().map(|cmc| cmc.value);
    let (made, right) = (
        best.calculation.figures(&[], cmc).expanded,
        found.right.expanded,
    );
    match (nearest(made), up(made)) {
        (true, false) => !nearest(right),
        (false, true) => !up(right),
        _ => !nearest(right) && !up(right),
    }
}
