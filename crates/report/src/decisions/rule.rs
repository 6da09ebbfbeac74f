//! The decision rule in words.

use super::conformity::Assessment;
use crate::figures::with_unit;
use crate::number::{exact, probability};
use gumption_gum::budget::{DecisionRule, Guard, ISO_14253_PROBABILITY};

impl Assessment<'_> {
    /// The rule, with its guard band or probability.
    pub(super) fn rule(&self) -> String {
        let l = self.l;
        match self.stated.rule {
            DecisionRule::Simple => l.pick("simple acceptance", "简单接受").to_string(),
            DecisionRule::Stated(_) => l
                .pick("stated acceptance limits", "给定的接受限")
                .to_string(),
            DecisionRule::GuardedAcceptance(guard @ Guard::Expanded(1.0)) => {
                let guard = self.guard(guard, "");
                l.pick(
                    format!("guarded acceptance, {guard} (ILAC-G8)"),
                    format!("保护带接受，{guard}（ILAC-G8）"),
                )
            }
            DecisionRule::GuardedAcceptance(guard) => {
                let guard = self.guard(guard, l.pick("conforms", "合格"));
                l.pick(
                    format!("guarded acceptance, {guard}"),
                    format!("保护带接受，{guard}"),
                )
            }
            DecisionRule::GuardedRejection(guard) => {
                let guard = self.guard(guard, l.pick("does not conform", "不合格"));
                l.pick(
                    format!("guarded rejection, {guard}"),
                    format!("保护带拒绝，{guard}"),
                )
            }
            DecisionRule::NonBinary {
                inner: Guard::Probability(inner),
                outer: Guard::Probability(outer),
            } if inner == outer => {
                let p = probability(inner);
                let (source, zh) = if inner == ISO_14253_PROBABILITY {
                    (", as ISO 14253-1", "，同 ISO 14253-1")
                } else {
                    ("", "")
                };
                l.pick(
                    format!("non-binary: decided where conformance, or non-conformance, has a probability of at least {p}{source}"),
                    format!("非二元判定：合格或不合格的概率不小于 {p} 时判定，否则待定{zh}"),
                )
            }
            DecisionRule::NonBinary { inner, outer } => {
                let accepted = self.guard(inner, l.pick("conforms", "合格"));
                let rejected = self.guard(outer, l.pick("does not conform", "不合格"));
                let both = if accepted == rejected {
                    accepted
                } else {
                    [accepted, rejected].join(l.pick(" or ", "或"))
                };
                l.pick(
                    format!("non-binary (undecided near the limits), {both}"),
                    format!("非二元判定（限附近待定），{both}"),
                )
            }
            DecisionRule::Jjf1094 => l
                .pick(
                    "JJF 1094 (simple where U ≤ MPEV/3, else undecided within U of the limits)",
                    "JJF 1094（U ≤ MPEV/3 时直接判定，否则限两侧 U 以内待定）",
                )
                .to_string(),
        }
    }

    fn guard(&self, guard: Guard, what: &str) -> String {
        match guard {
            Guard::Amount(w) => format!("w = {}", with_unit(&exact(w), &self.deviations())),
            Guard::Expanded(1.0) => "w = U".to_string(),
            Guard::Expanded(r) => format!("w = {}·U", exact(r)),
            Guard::Probability(p) => {
                let p = probability(p);
                self.l.pick(
                    format!("decided where the item {what} with a probability of at least {p}"),
                    format!("{what}的概率不小于 {p} 时判定"),
                )
            }
        }
    }
}
