//! The decision rule in words.

use super::conformity::Assessment;
use crate::figures::with_unit;
use crate::number::{exact, probability, significant};
use gumption_fault::say;
use gumption_gum::budget::{DecisionRule, GlobalRisks, Guard, ISO_14253_PROBABILITY};

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
                say!("guarded acceptance, {guard} (ILAC-G8)").in_language(l)
            }
            DecisionRule::GuardedAcceptance(guard) => {
                let guard = self.guard(guard, l.pick("conforms", "合格"));
                say!("guarded acceptance, {guard}").in_language(l)
            }
            DecisionRule::GuardedRejection(guard) => {
                let guard = self.guard(guard, l.pick("does not conform", "不合格"));
                say!("guarded rejection, {guard}").in_language(l)
            }
            DecisionRule::NonBinary {
                inner: Guard::Probability(inner),
                outer: Guard::Probability(outer),
            } if inner == outer => {
                let p = probability(inner);
                let source = match inner == ISO_14253_PROBABILITY {
                    true => l.pick(", as ISO 14253-1", "，同 ISO 14253-1"),
                    false => "",
                };
                say!("non-binary: decided where conformance, or non-conformance, has a probability of at least {p}{source}").in_language(l)
            }
            DecisionRule::NonBinary { inner, outer } => {
                let accepted = self.guard(inner, l.pick("conforms", "合格"));
                let rejected = self.guard(outer, l.pick("does not conform", "不合格"));
                let both = if accepted == rejected {
                    accepted
                } else {
                    [accepted, rejected].join(l.pick(" or ", "或"))
                };
                say!("non-binary (undecided near the limits), {both}").in_language(l)
            }
            DecisionRule::GlobalRisks(permitted) => self.permitted(permitted),
            DecisionRule::Jjf1094 => {
                say!("JJF 1094 (simple where U ≤ MPEV/3, else undecided within U of the limits)")
                    .in_language(l)
            }
        }
    }

    /// Permissible global risks, and the guard band that keeps them.
    fn permitted(&self, permitted: GlobalRisks) -> String {
        let l = self.l;
        let at_most = |symbol: &str, risk: Option<f64>| {
            risk.map(|p| format!("{symbol} ≤ {}", probability(p)))
        };
        let risks = [
            at_most("R_C", permitted.consumer),
            at_most("R_P", permitted.producer),
        ];
        let risks: Vec<String> = risks.into_iter().flatten().collect();
        let risks = risks.join(l.pick(" and ", " 且 "));
        let (found, tolerance) = (self.found, self.stated.tolerance);
        let band = match found.acceptance {
            None => String::new(),
            Some(accepted) if accepted != found.rejection => {
                say!(": undecided between two limits").in_language(l)
            }
            Some(accepted) if accepted == tolerance => {
                say!(": no guard band is needed").in_language(l)
            }
            Some(accepted) => {
                let inwards = match tolerance.lower.is_finite() {
                    true => accepted.lower - tolerance.lower,
                    false => tolerance.upper - accepted.upper,
                };
                let w = with_unit(&significant(inwards.abs(), 3), &self.deviations());
                match inwards > 0.0 {
                    true => say!(": guarded acceptance, w = {w}").in_language(l),
                    false => say!(": guarded rejection, w = {w}").in_language(l),
                }
            }
        };
        say!("global risk {risks} (JCGM 106, 9.5){band}").in_language(l)
    }

    fn guard(&self, guard: Guard, what: &str) -> String {
        match guard {
            Guard::Amount(w) => format!("w = {}", with_unit(&exact(w), &self.deviations())),
            Guard::Expanded(1.0) => "w = U".to_string(),
            Guard::Expanded(r) => format!("w = {}·U", exact(r)),
            Guard::Probability(p) => {
                let p = probability(p);
                say!("decided where the item {what} with a probability of at least {p}")
                    .in_language(self.l)
            }
        }
    }
}
