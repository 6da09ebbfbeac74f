//! Probabilities and risks: of the item that was measured, and of all items.

use super::conformity::Assessment;
use super::words::{Rows, chance, related};
use crate::language::Language;
use crate::number::significant;
use gumption_fault::say;
use gumption_gum::propagate::Verdict;

impl Assessment<'_> {
    /// What is known of the item that was measured.
    pub(super) fn specific(&self, rows: &mut Rows) {
        let (l, Some(known)) = (self.l, self.found.conformance) else {
            return;
        };
        let alone = l.pick("from the result alone", "仅由测量结果");
        let by_gum = chance(known.from_measurement);
        let trials = known.from_trials.map(chance);
        let trials = trials.map_or_else(String::new, |p| say!(", Monte Carlo {p}").in_language(l));
        let label = l.pick("Conformance probability", "符合概率");
        if self.stated.process.is_some() {
            let both = known.probability.map_or_else(
                || say!("none: the measured value is impossible for this process").in_language(l),
                |p| {
                    let p = related("p_c", &chance(p));
                    say!("{p}, with the knowledge of the process").in_language(l)
                },
            );
            rows.add(
                label,
                [both, format!("{alone} {by_gum}{trials}")].join(l.semicolon()),
            );
        } else {
            // The probability of the statement, with the other beside it.
            let decided = known.probability.map_or_else(|| by_gum.clone(), chance);
            let beside = match known.probability == known.from_trials {
                true if by_gum == decided => String::new(),
                true => say!(", from y and u {by_gum}").in_language(l),
                false => trials,
            };
            rows.add(label, format!("{}{beside}", related("p_c", &decided)));
        }
        let risk = match self.found.verdict {
            Some(Verdict::Conforming) => known.complement.map(|p| {
                (
                    l.pick("Specific consumer's risk", "特定使用方风险"),
                    chance(p),
                )
            }),
            Some(Verdict::NotConforming) => known.probability.map(|p| {
                (
                    l.pick("Specific producer's risk", "特定生产方风险"),
                    chance(p),
                )
            }),
            Some(Verdict::Undecided | Verdict::Withheld) | None => None,
        };
        if let Some((label, text)) = risk {
            rows.add(label, text);
        }
    }

    pub(super) fn capability(&self, rows: &mut Rows) {
        let l = self.l;
        let (Some(capability), Some(ratio)) =
            (self.found.capability, self.found.test_uncertainty_ratio)
        else {
            return;
        };
        let (c, ratio_text) = (significant(capability, 3), significant(ratio, 3));
        let met = match (ratio >= 3.0, l) {
            (true, Language::English) => "U ≤ MPEV/3 (JJF 1094) is met",
            (false, Language::English) => "U ≤ MPEV/3 (JJF 1094) is not met",
            (true, Language::Chinese) => "满足 U ≤ MPEV/3（JJF 1094）",
            (false, Language::Chinese) => "不满足 U ≤ MPEV/3（JJF 1094）",
        };
        rows.add(
            l.pick("Capability", "测量能力"),
            say!("C_m = T/(4u) = {c}, TUR = T/(2U) = {ratio_text}: {met}").in_language(l),
        );
    }

    /// Risks over all items.
    pub(super) fn global(&self, rows: &mut Rows) {
        let (l, Some(risk), Some(process)) = (self.l, self.found.global, &self.stated.process)
        else {
            return;
        };
        let kind = process.kind();
        let inside = chance(risk.in_tolerance);
        rows.add(
            l.pick("Process", "过程"),
            l.pick(
                format!(
                    "{} distribution; {inside} of the items conform",
                    kind.name_en
                ),
                format!("{}；{inside} 的产品合格", kind.name_zh),
            ),
        );
        rows.add(l.pick("Items accepted", "接受率"), chance(risk.accepted));
        let (consumer, producer) = (chance(risk.consumer), chance(risk.producer));
        let of_accepted = match risk.false_acceptance.map(chance) {
            Some(wrong) => say!("R_C = {consumer}; of the accepted items {wrong} do not conform"),
            None => say!("R_C = {consumer}; no item is accepted"),
        };
        let of_rejected = match risk.false_rejection.map(chance) {
            Some(lost) => say!("R_P = {producer}; of the rejected items {lost} conform"),
            None => say!("R_P = {producer}; no item is rejected"),
        };
        rows.add(
            l.pick("Global consumer's risk", "总体使用方风险"),
            of_accepted.in_language(l),
        );
        rows.add(
            l.pick("Global producer's risk", "总体生产方风险"),
            of_rejected.in_language(l),
        );
    }
}
