//! Resolution beside repeatability: double counting, and readings that do not scatter at all.

use super::checker::Checker;
use super::draft::{Drafts, Kind, show};
use crate::budget::tables::ResolutionWord;
use gumption_fault::say;

impl Checker<'_> {
    /// With the convention "largest", the smaller of resolution and repeatability is left out, because
    /// the scatter of readings already contains their quantisation.
    pub(super) fn absorb(
        &mut self,
        owner: &str,
        drafts: Drafts,
        convention: ResolutionWord,
    ) -> Drafts {
        if convention == ResolutionWord::Add {
            return drafts;
        }
        let u = |kind: Kind| {
            drafts
                .iter()
                .filter(|draft| draft.kind == kind)
                .map(|draft| draft.u)
                .reduce(f64::max)
        };
        let (Some(scatter), Some(resolution)) = (u(Kind::Repeatability), u(Kind::Resolution))
        else {
            return drafts;
        };
        let (dropped, what) = if scatter >= resolution {
            (Kind::Resolution, say!("resolution"))
        } else {
            (Kind::Repeatability, say!("repeatability"))
        };
        let (smaller, larger) = (show(scatter.min(resolution)), show(scatter.max(resolution)));
        self.remark(say!("{owner}: the {what} (u = {smaller}) is left out beside the larger u = {larger}, by the convention resolution = \"largest\"."));
        drafts
            .into_iter()
            .filter(|draft| draft.kind != dropped)
            .collect()
    }
}
