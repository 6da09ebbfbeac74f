//! Resolution beside repeatability: double counting, and readings that do not scatter at all.

use super::checker::Checker;
use super::draft::{Drafts, Kind, show};
use crate::budget::tables::ResolutionWord;

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
        let (dropped, en, zh) = if scatter >= resolution {
            (Kind::Resolution, "resolution", "分辨力")
        } else {
            (Kind::Repeatability, "repeatability", "重复性")
        };
        let (smaller, larger) = (show(scatter.min(resolution)), show(scatter.max(resolution)));
        self.remark(
            format!("{owner}: the {en} (u = {smaller}) is left out beside the larger u = {larger}, by the convention resolution = \"largest\"."),
            format!("{owner}：按约定取较大者（u = {larger}），{zh}引入的分量（u = {smaller}）不再计入。"),
        );
        drafts
            .into_iter()
            .filter(|draft| draft.kind != dropped)
            .collect()
    }
}
