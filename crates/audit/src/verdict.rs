//! What an audit comes to.

use crate::claim::Claimed;
use crate::search::{Found, search};

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
            Some(best) if found.has_effect(best) => Verdict::WithEffect,
            Some(_) => Verdict::WithoutEffect,
            None => Verdict::Unexplained,
        }
    };
    Audit { verdict, found }
}
