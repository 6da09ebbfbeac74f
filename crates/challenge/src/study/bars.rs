//! The bars that a diagnosis has to clear, with what was obtained.

use super::further::{Decision, Sequel};
use super::rate::Rate;
use super::record::{Outcome, Record};
use super::report::{Study, detected, is_listed, table};
use super::trial::Ablation;
use crate::scenario::{Class, NoiseKnowledge};
use gumption_core::special::chi_squared_sf;

/// Probability that χ²/dof of noise alone is between 0.8 and 1.3.
fn by_noise(dof: f64) -> f64 {
    chi_squared_sf(0.8 * dof, dof) - chi_squared_sf(1.3 * dof, dof)
}

impl Study<'_> {
    /// Every bar with what was obtained.
    pub(super) fn bars(&self) -> String {
        let single = |least: f64| self.singles().filter(move |(_, o)| o.lambda >= least);
        let alarms = |noise| Rate::count(self.nulls(noise), |r| detected(r));
        let named_on_null = Rate::count(self.of_class(Class::Null), |r: &&Record| {
            !r.wrong_names.is_empty()
        });
        let detection = |least| Rate::count(single(least), |(r, _)| detected(r));
        let separable = single(8.0).filter(|(_, o)| o.kappa >= 6.0);
        let listed = |(_, o): &(&Record, &Outcome)| o.finding == "unique" || is_listed(o);
        let wrong = |r: &&Record| !r.wrong_names.is_empty();
        let aliased = self
            .whole()
            .flat_map(|r| &r.outcomes)
            .filter(|o| o.finding == "unique");
        let open = self
            .records
            .iter()
            .filter(|r| r.ablation == Ablation::WithoutTruth)
            .filter(|r| {
                r.outcomes
                    .iter()
                    .all(|o| o.lambda >= 10.0 && o.kappa >= 5.0)
            });
        let sure: Vec<bool> = self
            .claims()
            .filter(|(p, _)| *p >= 0.99)
            .map(|(_, ok)| ok)
            .collect();
        let fixed: Vec<&Record> = self
            .singles()
            .filter(|(_, o)| o.finding == "unique")
            .map(|(r, _)| r)
            .collect();
        // How far a label slipped is no size of an effect.
        let sizes = (self.whole().flat_map(|r| &r.outcomes))
            .filter(|o| o.physics != "swapped-label")
            .map(|o| o.deviation)
            .filter(|z| z.is_finite());
        let located = self.whole().flat_map(|r| &r.outcomes);
        let located = located.filter_map(|o| o.located);
        let in_range = |x: f64| (0.8..=1.3).contains(&x);
        let pooled = fixed.iter().map(|r| r.chi[1] * r.dof).sum::<f64>()
            / fixed.iter().map(|r| r.dof).sum::<f64>();
        let by_noise = fixed.iter().map(|r| by_noise(r.dof)).sum::<f64>() / fixed.len() as f64;
        let made: Vec<Decision> = self.sequels().filter_map(Sequel::decision).collect();
        let row = |what: &str, bar: &str, got: Rate, holds: fn(f64, f64) -> bool, limit: f64| {
            // Without a bar there is nothing to hold.
            let verdict = if got.of == 0 || bar == "–" {
                "–"
            } else if holds(got.share(), limit) {
                "yes"
            } else {
                "**no**"
            };
            vec![
                what.to_string(),
                bar.to_string(),
                got.to_string(),
                verdict.to_string(),
            ]
        };
        let most: fn(f64, f64) -> bool = |x, limit| x <= limit;
        let least: fn(f64, f64) -> bool = |x, limit| x >= limit;
        let rows = vec![
            row(
                "alarms on nothing, noise stated, α = 1 %",
                "≤ 1.5 %",
                alarms(NoiseKnowledge::Stated),
                most,
                0.015,
            ),
            row(
                "alarms on nothing, noise from a recording at rest",
                "≤ 2.5 %",
                alarms(NoiseKnowledge::AtRest),
                most,
                0.025,
            ),
            row(
                "unique wrong name on nothing",
                "≤ 0.2 %",
                named_on_null,
                most,
                0.002,
            ),
            row(
                "detected, one effect, λ ≥ 6",
                "≥ 95 %",
                detection(6.0),
                least,
                0.95,
            ),
            row(
                "detected, one effect, λ ≥ 8",
                "≥ 99.5 %",
                detection(8.0),
                least,
                0.995,
            ),
            row(
                "named uniquely and rightly, λ ≥ 8 and κ ≥ 6",
                "≥ 97 %",
                Rate::count(separable, |(_, o)| o.finding == "unique"),
                least,
                0.97,
            ),
            row(
                "named or listed, one effect, λ ≥ 8",
                "≥ 95 %",
                Rate::count(single(8.0), listed),
                least,
                0.95,
            ),
            row(
                "unique wrong name, one effect",
                "≤ 1 %",
                Rate::count(self.of_class(Class::Single), wrong),
                most,
                0.01,
            ),
            row(
                "unique wrong name, two or three effects",
                "≤ 2 %",
                Rate::count(self.several(), wrong),
                most,
                0.02,
            ),
            row(
                "unique name where another gives the same recording",
                "0",
                Rate::count(aliased, |o| o.overclaimed),
                most,
                0.0,
            ),
            row(
                "claims at posterior ≥ 0.99 right",
                "≥ 98 %",
                Rate::count(sure, |ok| *ok),
                least,
                0.98,
            ),
            row(
                "true name taken out, λ ≥ 10, κ ≥ 5: unique wrong name",
                "≤ 8 %",
                Rate::count(open, wrong),
                most,
                0.08,
            ),
            row(
                "no catalogue names it: unique wrong name",
                "≤ 8 %",
                Rate::count(self.of_class(Class::Outside), wrong),
                most,
                0.08,
            ),
            vec![
                "χ²/dof after the fix, all cases together (one effect, named)".to_string(),
                "0.8–1.3".to_string(),
                format!("{pooled:.3} ({} cases)", fixed.len()),
                if in_range(pooled) { "yes" } else { "**no**" }.to_string(),
            ],
            row(
                &format!(
                    "χ²/dof of a case between 0.8 and 1.3; noise alone: {:.1} %",
                    100.0 * by_noise
                ),
                "–",
                Rate::count(&fixed, |r| in_range(r.chi[1])),
                least,
                0.9,
            ),
            row(
                "error of prediction ≤ 1.2 × noise after the fix (one effect, named)",
                "–",
                Rate::count(&fixed, |r| r.held_out[1] <= 1.2),
                least,
                0.9,
            ),
            row(
                "size inside the stated 95 % interval (unique names with one coefficient)",
                "93–97 %",
                Rate::count(sizes, |deviation| deviation.abs() <= 1.0),
                |x, limit| (limit..=0.97).contains(&x),
                0.93,
            ),
            row(
                "recommended measurement decides as promised; names that say the same of every measurement count as one",
                "≥ 95 %",
                Rate::count(made.clone(), |d| {
                    matches!(d, Decision::Resolved | Decision::Class)
                }),
                least,
                0.95,
            ),
            row(
                "… and leaves a single name",
                "–",
                Rate::count(made, |d| *d == Decision::Resolved),
                least,
                0.95,
            ),
            row(
                "axis or moment stated wrongly with a right name",
                "≤ 2 %",
                Rate::count(located, |right| !right),
                most,
                0.02,
            ),
        ];
        table(
            "Bars",
            "Shares with the exact 95 % interval of Clopper and Pearson.",
            &["figure", "bar", "obtained", "holds"],
            &rows,
        )
    }
}
