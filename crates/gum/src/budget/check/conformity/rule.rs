//! The decision rule, from whichever keys state it.

use std::ops::Range;

use super::Subject;
use crate::budget::check::Checker;
use crate::budget::check::draft::show;
use crate::budget::faults::{DECISION_RULE, LIMITS, NOT_POSITIVE, TOLERANCE, TWO_WAYS};
use crate::budget::tables::{ConformityTable, RuleWord};
use crate::budget::{DecisionRule, GlobalRisks, Guard, ISO_14253_PROBABILITY, Interval};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Amount;
use gumption_format::toml::{Slot, Stated};

const BAND_AND_PROBABILITY: Said = say!("a guard band beside a probability");

/// A guard band, and the place of its key.
struct Band {
    guard: Guard,
    key: Range<usize>,
}

/// Probabilities and the guard band, as far as they are stated.
struct Guards {
    /// Probability of conformance.
    inner: Option<Guard>,
    /// Probability of non-conformance.
    outer: Option<Guard>,
    band: Option<Band>,
}

impl Guards {
    fn are_probable(&self) -> bool {
        self.inner.is_some() || self.outer.is_some()
    }

    /// The rule that a word names; none where it is complete without what else is stated.
    fn rule(&self, word: RuleWord) -> Option<DecisionRule> {
        let whole = Guard::Expanded(1.0);
        let band = self.band.as_ref().map(|band| band.guard);
        let guard = |stated: Option<Guard>| stated.or(band).unwrap_or(whole);
        let bare = !self.are_probable() && band.is_none();
        let (rule, fits) = match word {
            RuleWord::GuardedAcceptance => (
                DecisionRule::GuardedAcceptance(guard(self.inner)),
                self.outer.is_none(),
            ),
            RuleWord::GuardedRejection => (
                DecisionRule::GuardedRejection(guard(self.outer)),
                self.inner.is_none(),
            ),
            RuleWord::NonBinary => (
                DecisionRule::NonBinary {
                    inner: guard(self.inner),
                    outer: guard(self.outer),
                },
                self.inner.is_some() == self.outer.is_some(),
            ),
            RuleWord::Simple => (DecisionRule::Simple, bare),
            RuleWord::IlacG8 => (DecisionRule::GuardedAcceptance(whole), bare),
            RuleWord::Iso14253 => (
                DecisionRule::NonBinary {
                    inner: Guard::Probability(ISO_14253_PROBABILITY),
                    outer: Guard::Probability(ISO_14253_PROBABILITY),
                },
                bare,
            ),
            RuleWord::Jjf1094 => (DecisionRule::Jjf1094, bare),
        };
        fits.then_some(rule)
    }
}

/// Keys that state a decision rule.
const RULES: [&str; 10] = [
    "rule",
    "guard_band",
    "guard_band_factor",
    "conformance_probability",
    "nonconformance_probability",
    "specific_consumer_risk",
    "specific_producer_risk",
    "global_consumer_risk",
    "global_producer_risk",
    "acceptance",
];

fn states_rule(table: &ConformityTable) -> bool {
    let mut present = table.present.iter();
    present.any(|(key, _)| RULES.contains(key))
}

impl Checker<'_> {
    /// The decision rule, from whichever keys state it.
    pub(super) fn rule(
        &mut self,
        stated: &Stated<ConformityTable>,
        subject: &Subject<'_>,
        tolerance: Option<Interval>,
    ) -> Option<DecisionRule> {
        let table = &stated.value;
        if let Some(limits) = &table.acceptance {
            self.alone(table, &["acceptance"])?;
            return self.stated_acceptance(limits, subject, tolerance?);
        }
        if table.global_consumer_risk.is_some() || table.global_producer_risk.is_some() {
            self.alone(table, &["global_consumer_risk", "global_producer_risk"])?;
            return self.permitted_risks(table);
        }
        let inner = self.right_decision(
            &table.conformance_probability,
            &table.specific_consumer_risk,
        );
        let outer = self.right_decision(
            &table.nonconformance_probability,
            &table.specific_producer_risk,
        );
        let band = self.band(table, subject);
        let guards = Guards {
            inner: inner?,
            outer: outer?,
            band: band?,
        };
        let Some(word) = &table.rule else {
            return self.rule_of_guards(stated, &guards);
        };
        if let (true, Some(band)) = (guards.are_probable(), &guards.band) {
            return self.clash(&band.key, BAND_AND_PROBABILITY);
        }
        let extra = table
            .conformance_probability
            .as_ref()
            .or(table.nonconformance_probability.as_ref())
            .or(table.specific_consumer_risk.as_ref())
            .or(table.specific_producer_risk.as_ref())
            .map(|stated| stated.key.clone())
            .or(guards.band.as_ref().map(|band| band.key.clone()));
        let Some(rule) = guards.rule(word.value) else {
            let key = extra.unwrap_or(word.key.clone());
            let what = say!("rule = \"{}\" is complete without it", word.value.word());
            return self.clash(&key, what);
        };
        if rule == DecisionRule::Jjf1094 && tolerance.is_some_and(|t| t.width().is_none()) {
            return self.refuse(
                Fault::new(
                    DECISION_RULE,
                    word.span.clone(),
                    say!(
                        "{} has one tolerance limit, JJF 1094 a maximum permissible error",
                        subject.name
                    ),
                )
                .label(say!("needs `lower` and `upper`"))
                .help(say!(
                    "with one limit write for example rule = \"non-binary\""
                )),
            );
        }
        Some(rule)
    }

    /// The rule where no word names one.
    fn rule_of_guards(
        &mut self,
        stated: &Stated<ConformityTable>,
        guards: &Guards,
    ) -> Option<DecisionRule> {
        match (guards.inner, guards.outer, &guards.band) {
            (Some(inner), Some(outer), None) => Some(DecisionRule::NonBinary { inner, outer }),
            (Some(inner), None, None) => Some(DecisionRule::GuardedAcceptance(inner)),
            (None, Some(outer), None) => Some(DecisionRule::GuardedRejection(outer)),
            // The key that says it may be the one that was refused.
            (None, None, None) if stated.value.unknown || states_rule(&stated.value) => None,
            (None, None, _) => self.refuse(no_rule(stated)),
            (_, _, Some(band)) => self.clash(&band.key, BAND_AND_PROBABILITY),
        }
    }

    fn clash<T>(&mut self, key: &Range<usize>, what: Said) -> Option<T> {
        self.refuse(
            Fault::new(DECISION_RULE, key.clone(), say!("the decision rule is stated twice: {what}"))
                .label(say!("leave this out, or the other one"))
                .help(say!("a guard band goes with \"guarded-acceptance\", \"guarded-rejection\" and \"non-binary\"; probabilities stand in its place")),
        )
    }

    /// Nothing else may state the rule beside keys that are complete by themselves.
    fn alone(&mut self, table: &ConformityTable, keys: &[&str]) -> Option<()> {
        let mut present = table.present.iter();
        let other = present.find(|(key, _)| RULES.contains(key) && !keys.contains(key));
        match other {
            None => Some(()),
            Some((name, span)) => {
                let mut stated = table.present.iter().map(|(key, _)| *key);
                let complete = stated.find(|key| keys.contains(key)).unwrap_or(keys[0]);
                let what = say!("`{name}` beside `{complete}`");
                let span = span.clone();
                self.clash(&span, what)
            }
        }
    }

    /// A probability that decides, or the risk that is its complement: better than tossing a coin.
    fn right_decision(
        &mut self,
        probability: &Slot<f64>,
        risk: &Slot<f64>,
    ) -> Option<Option<Guard>> {
        let (stated, right, expected, such) = match (probability, risk) {
            (None, None) => return Some(None),
            (Some(first), Some(second)) => {
                return self.refuse(
                    Fault::new(
                        TWO_WAYS,
                        second.key.clone(),
                        say!("a risk and its complement are both stated"),
                    )
                    .label(say!("the risk here"))
                    .related(first.key.clone(), say!("the probability here"))
                    .help(say!("leave out one")),
                );
            }
            (Some(p), None) => (
                p,
                self.probability(p)?,
                say!("expected at least 0.5"),
                say!("state the probability of a right decision, such as 0.95"),
            ),
            (None, Some(p)) => (
                p,
                1.0 - self.probability(p)?,
                say!("expected at most 0.5"),
                say!("state the permissible risk of a wrong decision, such as 0.05"),
            ),
        };
        if right >= 0.5 {
            return Some(Some(Guard::Probability(right)));
        }
        self.refuse(
            Fault::new(
                DECISION_RULE,
                stated.span.clone(),
                say!("a decision that is right with probability {}", show(right)),
            )
            .label(expected)
            .help(such),
        )
    }

    /// Permissible risks over all items, of which something must be known.
    fn permitted_risks(&mut self, table: &ConformityTable) -> Option<DecisionRule> {
        let mut risk = |stated: &Slot<f64>| match stated {
            Some(stated) => self.probability(stated).map(Some),
            None => Some(None),
        };
        let consumer = risk(&table.global_consumer_risk);
        let producer = risk(&table.global_producer_risk);
        let (consumer, producer) = (consumer?, producer?);
        let stated = table
            .global_consumer_risk
            .as_ref()
            .or(table.global_producer_risk.as_ref())?;
        if table.process.is_none() {
            return self.refuse(
                Fault::new(
                    DECISION_RULE,
                    stated.key.clone(),
                    say!("a global risk, and nothing is known of the items"),
                )
                .label(say!("is an average over all items: `process` is missing"))
                .help(say!("add process = {{ in_tolerance_probability = 0.95 }} or its distribution; for the risk of the one item that was measured write `specific_consumer_risk` or `specific_producer_risk`")),
            );
        }
        Some(DecisionRule::GlobalRisks(GlobalRisks {
            consumer,
            producer,
        }))
    }

    /// The guard band, if there is one.
    fn band(&mut self, table: &ConformityTable, subject: &Subject<'_>) -> Option<Option<Band>> {
        if let (Some(amount), Some(factor)) = (&table.guard_band, &table.guard_band_factor) {
            return self.refuse(
                Fault::new(
                    TWO_WAYS,
                    factor.key.clone(),
                    say!("the guard band is stated in two ways"),
                )
                .label(say!("as a multiple of U here"))
                .related(amount.key.clone(), say!("as an amount here"))
                .help(say!("leave out one")),
            );
        }
        if let Some(factor) = &table.guard_band_factor {
            let r = self.positive(factor, "guard_band_factor")?;
            return Some(Some(Band {
                guard: Guard::Expanded(r),
                key: factor.key.clone(),
            }));
        }
        let Some(amount) = &table.guard_band else {
            return Some(None);
        };
        if amount.value.number <= 0.0 {
            return self.refuse(
                Fault::new(NOT_POSITIVE, amount.span.clone(), say!("the guard band is not positive"))
                    .label(say!("must be greater than zero"))
                    .help(say!("the rule says on which side of the tolerance limits it lies; without a guard band write rule = \"simple\"")),
            );
        }
        if let Some((unit, span)) = &amount.value.unit
            && matches!(unit.as_str(), "u" | "U")
        {
            let number = amount.value.number;
            let multiple = say!("a guard band in {unit}");
            return self.refuse(
                Fault::new(DECISION_RULE, span.clone(), multiple)
                    .label(say!("no amount of {}", subject.name))
                    .help(say!("a multiple of U is guard_band_factor = {number}; one of u follows from the probability that it stands for, such as conformance_probability = 0.95 for 1.645 u")),
            );
        }
        let w = self.difference(amount, subject.unit, subject.name)?;
        Some(Some(Band {
            guard: Guard::Amount(w),
            key: amount.key.clone(),
        }))
    }

    fn stated_acceptance(
        &mut self,
        stated: &Stated<Vec<Stated<Amount>>>,
        subject: &Subject<'_>,
        tolerance: Interval,
    ) -> Option<DecisionRule> {
        let limits: Vec<Option<f64>> = stated
            .value
            .iter()
            .map(|limit| self.quantity(limit, subject.unit, subject.name))
            .collect();
        let limits: Vec<f64> = limits.into_iter().collect::<Option<_>>()?;
        let interval = match (
            limits.as_slice(),
            tolerance.lower.is_finite(),
            tolerance.upper.is_finite(),
        ) {
            ([lower, upper], true, true) => Interval {
                lower: *lower,
                upper: *upper,
            },
            ([lower], true, false) => Interval {
                lower: *lower,
                upper: f64::INFINITY,
            },
            ([upper], false, true) => Interval {
                lower: f64::NEG_INFINITY,
                upper: *upper,
            },
            _ => {
                return self.refuse(
                    Fault::new(
                        TOLERANCE,
                        stated.span.clone(),
                        say!("{} acceptance limits", limits.len()),
                    )
                    .label(say!("expected one for every tolerance limit")),
                );
            }
        };
        if interval.lower >= interval.upper {
            return self.refuse(
                Fault::new(
                    LIMITS,
                    stated.span.clone(),
                    say!("the acceptance interval is empty"),
                )
                .label(say!("expected [lower, upper]")),
            );
        }
        Some(DecisionRule::Stated(interval))
    }
}

fn no_rule(stated: &Stated<ConformityTable>) -> Fault {
    let (place, message) = match stated
        .value
        .guard_band
        .as_ref()
        .map(|amount| &amount.key)
        .or(stated.value.guard_band_factor.as_ref().map(|r| &r.key))
    {
        Some(key) => (key.clone(), say!("a guard band without a decision rule")),
        None => (stated.span.clone(), say!("the decision rule is missing")),
    };
    Fault::new(DECISION_RULE, place, message)
        .label(say!("`rule` is missing"))
        .help(say!("add `rule`: \"simple\", \"guarded-acceptance\", \"guarded-rejection\", \"non-binary\", \"ILAC-G8\", \"ISO 14253-1\" or \"JJF 1094\"; or a permissible risk: `specific_consumer_risk`, or `global_consumer_risk` where `process` is known"))
}
