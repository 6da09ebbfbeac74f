//! What an audit comes to.

use crate::calculate::{Figures, are_possible};
use crate::claim::{Claimed, Row};
use crate::read::has;
use crate::search::{Explanation, Found, Gap, search};

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
    /// Nothing to compute from, nothing claimed, or nothing that leads from a row to the result.
    NotRecomputed,
}

/// An audited claim.
#[derive(Debug, Clone)]
pub struct Audit<'a> {
    /// The verdict.
    pub verdict: Verdict,
    /// What was found.
    pub found: Found<'a>,
    /// Rows from which nothing leads to the result, or whose limits are not understood, where the claim cannot be recomputed
    /// for that.
    pub missing: Vec<usize>,
}

impl Audit<'_> {
    /// The right figures, as far as the sheet states what they need.
    pub fn recomputed(&self) -> Option<Figures> {
        // A u_c of 0 is that of rows of which nothing is stated.
        let is_known = self.missing.is_empty() && self.found.right.u_c > 0.0;
        is_known.then_some(self.found.right)
    }
}

/// Audits a claim.
pub fn audit(claimed: &Claimed) -> Audit<'_> {
    let mut found = search(claimed);
    let mut missing = missing(&found);
    let best = found.explanations.first();
    if missing.is_empty() && best.is_some_and(|best| best.acts.is_empty()) {
        missing = unread(claimed);
    }
    let nothing = claimed.rows.is_empty() || found.right.u_c <= 0.0;
    if !missing.is_empty() || nothing {
        // What sums of several quantities come to explains nothing, and departs from nothing.
        found.explanations.clear();
        found.gaps.clear();
    }
    if !are_possible(&claimed.correlations) || shares_sources(claimed) {
        // What correlates the rows is not known, and a slip that makes up for it would be none.
        found.explanations.retain(|found| found.acts.is_empty());
        if found.explanations.is_empty() && found.gaps.is_empty() {
            found.gaps.push(Gap::Sum);
        }
    }
    let footer = &claimed.footer;
    let unclaimed = footer.u_c.is_none() && footer.expanded.is_none();
    let silent = found.gaps.is_empty() && found.explanations.is_empty();
    let is_open = nothing || unclaimed && (silent || claimed.computes_nothing());
    let verdict = if is_open || !missing.is_empty() {
        Verdict::NotRecomputed
    } else {
        match found.explanations.first() {
            Some(best) if best.acts.is_empty() => Verdict::Sound,
            Some(best) if found.has_effect(best) => Verdict::WithEffect,
            Some(_) => Verdict::WithoutEffect,
            None => Verdict::Unexplained,
        }
    };
    Audit {
        verdict,
        found,
        missing,
    }
}

/// Rows from which nothing leads to the result, where that leaves the claim open: no figure of a row departs, and nothing
/// explains the claim but slips that leave some of them in the sum.
fn missing(found: &Found<'_>) -> Vec<usize> {
    let is_of_row = |gap: &Gap| matches!(gap, Gap::Row(..));
    if found.gaps.iter().any(is_of_row) {
        return Vec::new();
    }
    let rows = found.case.without_way();
    let is_about =
        |best: &Explanation, row: &usize| best.acts.iter().any(|act| act.row == Some(*row));
    let explains =
        |best: &Explanation| best.acts.is_empty() || rows.iter().all(|row| is_about(best, row));
    match found.explanations.first().is_some_and(explains) {
        true => Vec::new(),
        false => rows,
    }
}

/// Rows whose limits are not understood: that u follows from them, nothing shows.
fn unread(claimed: &Claimed) -> Vec<usize> {
    let rows = claimed.rows.iter().enumerate();
    let unread = rows.filter(|(_, row)| row.not_counted.is_none() && row.unread_used.is_some());
    unread.map(|(i, _)| i).collect()
}

/// Whether rows that are not counted are sources that others share: by how much these are correlated, the sheet does not say.
fn shares_sources(claimed: &Claimed) -> bool {
    const SHARED: [&str; 4] = ["shared", "common", "共同", "公共"];
    let is_shared = |row: &Row| {
        let why = row.not_counted.as_ref().map(|why| why.to_lowercase());
        let part = row.contribution.as_ref();
        let contributes = part.is_some_and(|part| part.value != 0.0);
        contributes && why.is_some_and(|why| has(&why, &SHARED))
    };
    claimed.rows.iter().any(is_shared)
}
