//! Resolution beside repeatability: double counting, and readings that do not scatter at all.

use super::checker::Checker;
use super::draft::{Drafts, Kind};
use crate::budget::tables::ResolutionWord;
use gumption_core::quantity::{Decimal, Rounding, Unit, space_before};
use gumption_fault::say;

impl Checker<'_> {
    /// With the convention "largest", the smaller of resolution and repeatability is left out, because
    /// the scatter of readings already contains their quantisation.
    pub(super) fn absorb(
        &mut self,
        owner: &str,
        unit: &Unit,
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
        let told = |u: f64| {
            let u = Decimal::from_f64(u).round_to_significant(3, Rounding::HalfEven);
            match unit.is_one() {
                true => u.to_string(),
                false => format!("{u}{}{}", space_before(&unit.symbol), unit.symbol),
            }
        };
        let (smaller, larger) = (told(scatter.min(resolution)), told(scatter.max(resolution)));
        self.remark(say!("{owner}: the {what} (u = {smaller}) is left out beside the larger u = {larger}, by the convention resolution = \"largest\"."));
        drafts
            .into_iter()
            .filter(|draft| draft.kind != dropped)
            .collect()
    }
}
