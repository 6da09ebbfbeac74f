//! `[conformity]`: tolerance, decision rule, knowledge of the process.

use super::register::Register;
use super::{Checker, entries};
use crate::budget::distributions::DistributionEntry;
use crate::budget::faults::{
    CLAIM, DECISION_RULE, LIMITS, MISSING_KEY, NAME_TWICE, NOT_POSITIVE, PROCESS, TOLERANCE,
    TWO_WAYS, UNKNOWN_NAME,
};
use crate::budget::table::Stated;
use crate::budget::tables::{ConformityTable, FileTable, ProcessTable, RuleWord};
use crate::budget::values::Amount;
use crate::budget::{Conformity, DecisionRule, Guard, ISO_14253_PROBABILITY, Interval};
use crate::distribution::Distribution;
use crate::fault::{Fault, nearest};
use crate::quantity::Unit;
use crate::special::normal_two_sided_quantile;

/// A name from the file and the unit in which amounts are understood.
struct Subject<'a> {
    name: &'a str,
    unit: &'a Unit,
}

const BAND_AND_PROBABILITY: &str = "a guard band beside a probability";

/// Probabilities and the guard band, as far as they are stated.
struct Guards {
    /// Probability of conformance.
    inner: Option<Guard>,
    /// Probability of non-conformance.
    outer: Option<Guard>,
    /// The guard band, and the place of its key.
    band: Option<(Guard, std::ops::Range<usize>)>,
}

impl Guards {
    fn are_probable(&self) -> bool {
        self.inner.is_some() || self.outer.is_some()
    }

    /// The rule that a word names; none where it is complete without what else is stated.
    fn rule(&self, word: RuleWord) -> Option<DecisionRule> {
        let whole = Guard::Expanded(1.0);
        let band = self.band.as_ref().map(|(guard, _)| *guard);
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

impl Checker<'_> {
    /// Reads `[conformity]`.
    pub(super) fn conformity(&mut self, file: &FileTable, register: &Register) -> Vec<Conformity> {
        let stated = file.conformity.as_ref().map_or(&[][..], |all| &all.value.0);
        let mut found: Vec<Conformity> = Vec::new();
        for one in stated {
            let Some(conformity) = self.assessment(one, file, register) else {
                continue;
            };
            if found.iter().any(|other| other.name == conformity.name) {
                self.faults.push(
                    Fault::new(
                        NAME_TWICE,
                        one.span.clone(),
                        format!("two conformity assessments are called {}", conformity.name),
                    )
                    .label("second one")
                    .help("give each a name of its own: name = \"…\""),
                );
            }
            let names = Conformity::FIGURES.map(|figure| format!("{}.{figure}", conformity.name));
            self.awaited_figures.extend(names);
            found.push(conformity);
        }
        found
    }

    fn assessment(
        &mut self,
        stated: &Stated<ConformityTable>,
        file: &FileTable,
        register: &Register,
    ) -> Option<Conformity> {
        let table = &stated.value;
        let measurand = self.decided(&table.measurand, &stated.span, file, "conformity");
        let carrier = match &table.carrier {
            Some(carrier) => self.carrier(carrier, register).map(Some),
            None => Some(lone(register)),
        };
        let measurand = measurand?;
        let (name, entry) = entries(&file.measurand).get(measurand)?;
        let unit = self.unit(&entry.value.unit)?;
        let subject = Subject { name, unit: &unit };
        let tolerance = self.tolerance(stated, &subject);
        let rule = self.rule(stated, &subject, tolerance);
        let process = match (&table.process, tolerance) {
            (Some(process), Some(tolerance)) => self.process(process, tolerance).map(Some),
            (Some(_), None) => None,
            (None, _) => Some(None),
        };
        Some(Conformity {
            name: table
                .name
                .as_ref()
                .map_or_else(|| name.clone(), |text| text.value.clone()),
            measurand,
            tolerance: tolerance?,
            rule: rule?,
            process: process?,
            carrier: carrier?,
            planning: table.planning.as_ref().is_some_and(|word| word.value),
        })
    }

    fn tolerance(
        &mut self,
        stated: &Stated<ConformityTable>,
        subject: &Subject<'_>,
    ) -> Option<Interval> {
        let table = &stated.value;
        let mut limit = |amount: &Option<Stated<Amount>>, missing: f64| match amount {
            Some(amount) => self.quantity(amount, subject.unit, subject.name),
            None => Some(missing),
        };
        let lower = limit(&table.lower, f64::NEG_INFINITY);
        let upper = limit(&table.upper, f64::INFINITY);
        let (lower, upper) = (lower?, upper?);
        match (&table.lower, &table.upper) {
            (None, None) if table.refused => None,
            (None, None) => self.refuse(
                Fault::new(
                    TOLERANCE,
                    stated.span.clone(),
                    format!("{} has no tolerance limit", subject.name),
                )
                .label("`lower` and `upper` are missing")
                .help("state the permissible values: `lower`, `upper`, or both"),
            ),
            (Some(first), Some(second)) if lower >= upper => self.refuse(
                Fault::new(
                    TOLERANCE,
                    second.span.clone(),
                    format!(
                        "the tolerance limits of {} are {lower} and {upper}",
                        subject.name
                    ),
                )
                .label("must be above the lower limit")
                .related(first.span.clone(), "lower limit"),
            ),
            _ => Some(Interval { lower, upper }),
        }
    }

    /// The decision rule, from whichever keys state it.
    fn rule(
        &mut self,
        stated: &Stated<ConformityTable>,
        subject: &Subject<'_>,
        tolerance: Option<Interval>,
    ) -> Option<DecisionRule> {
        let table = &stated.value;
        if let Some(limits) = &table.acceptance {
            self.alone(table, "acceptance")?;
            return self.stated_acceptance(limits, subject, tolerance?);
        }
        let inner = self.stated_probability(&table.conformance_probability);
        let outer = self.stated_probability(&table.nonconformance_probability);
        let band = self.band(table, subject);
        let guards = Guards {
            inner: inner?,
            outer: outer?,
            band: band?,
        };
        let Some(word) = &table.rule else {
            return self.rule_of_guards(stated, &guards);
        };
        if let (true, Some((_, key))) = (guards.are_probable(), &guards.band) {
            return self.clash(key, BAND_AND_PROBABILITY);
        }
        let extra = table
            .conformance_probability
            .as_ref()
            .or(table.nonconformance_probability.as_ref())
            .map(|stated| stated.key.clone())
            .or(guards.band.as_ref().map(|(_, key)| key.clone()));
        let Some(rule) = guards.rule(word.value) else {
            let key = extra.unwrap_or(word.key.clone());
            let what = format!("rule = \"{}\" is complete without it", word.value.word());
            return self.clash(&key, &what);
        };
        if rule == DecisionRule::Jjf1094 && tolerance.is_some_and(|t| t.width().is_none()) {
            return self.refuse(
                Fault::new(
                    DECISION_RULE,
                    word.span.clone(),
                    format!(
                        "{} has one tolerance limit, JJF 1094 a maximum permissible error",
                        subject.name
                    ),
                )
                .label("needs `lower` and `upper`")
                .help("with one limit write for example rule = \"non-binary\""),
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
            (None, None, None) if stated.value.refused => None,
            (None, None, _) => self.refuse(no_rule(stated)),
            (_, _, Some((_, key))) => self.clash(key, BAND_AND_PROBABILITY),
        }
    }

    fn clash<T>(&mut self, key: &std::ops::Range<usize>, what: &str) -> Option<T> {
        self.refuse(
            Fault::new(DECISION_RULE, key.clone(), format!("the decision rule is stated twice: {what}"))
                .label("leave this out, or the other one")
                .help("a guard band goes with \"guarded-acceptance\", \"guarded-rejection\" and \"non-binary\"; probabilities stand in its place"),
        )
    }

    /// Nothing else may state the rule beside the acceptance limits.
    fn alone(&mut self, table: &ConformityTable, key: &str) -> Option<()> {
        const RULES: [&str; 5] = [
            "rule",
            "guard_band",
            "guard_band_factor",
            "conformance_probability",
            "nonconformance_probability",
        ];
        let other = table
            .present
            .iter()
            .find(|(present, _)| RULES.contains(present));
        match other {
            None => Some(()),
            Some((name, span)) => {
                let what = format!("`{name}` beside `{key}`");
                let span = span.clone();
                self.clash(&span, &what)
            }
        }
    }

    /// A probability that decides: better than tossing a coin.
    fn stated_probability(&mut self, stated: &Option<Stated<f64>>) -> Option<Option<Guard>> {
        let Some(stated) = stated else {
            return Some(None);
        };
        let p = self.probability(stated)?;
        if p >= 0.5 {
            return Some(Some(Guard::Probability(p)));
        }
        self.refuse(
            Fault::new(
                DECISION_RULE,
                stated.span.clone(),
                format!("a decision that is right with probability {p}"),
            )
            .label("expected at least 0.5")
            .help("state the probability of a right decision, such as 0.95"),
        )
    }

    /// A guard band and the place of its key.
    #[allow(clippy::type_complexity)]
    fn band(
        &mut self,
        table: &ConformityTable,
        subject: &Subject<'_>,
    ) -> Option<Option<(Guard, std::ops::Range<usize>)>> {
        if let (Some(amount), Some(factor)) = (&table.guard_band, &table.guard_band_factor) {
            return self.refuse(
                Fault::new(
                    TWO_WAYS,
                    factor.key.clone(),
                    "the guard band is stated in two ways",
                )
                .label("as a multiple of U here")
                .related(amount.key.clone(), "as an amount here")
                .help("leave out one"),
            );
        }
        if let Some(factor) = &table.guard_band_factor {
            let r = self.positive(factor, "guard_band_factor")?;
            return Some(Some((Guard::Expanded(r), factor.key.clone())));
        }
        let Some(amount) = &table.guard_band else {
            return Some(None);
        };
        if amount.value.number <= 0.0 {
            return self.refuse(
                Fault::new(NOT_POSITIVE, amount.span.clone(), "the guard band is not positive")
                    .label("must be greater than zero")
                    .help("the rule says on which side of the tolerance limits it lies; without a guard band write rule = \"simple\""),
            );
        }
        let w = self.quantity(amount, &subject.unit.difference(), subject.name)?;
        Some(Some((Guard::Amount(w), amount.key.clone())))
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
                        format!("{} acceptance limits", limits.len()),
                    )
                    .label("expected one for every tolerance limit"),
                );
            }
        };
        if interval.lower >= interval.upper {
            return self.refuse(
                Fault::new(
                    LIMITS,
                    stated.span.clone(),
                    "the acceptance interval is empty",
                )
                .label("expected [lower, upper]"),
            );
        }
        Some(DecisionRule::Stated(interval))
    }

    fn process(
        &mut self,
        stated: &Stated<ProcessTable>,
        tolerance: Interval,
    ) -> Option<Distribution> {
        let table = &stated.value;
        match (&table.distribution, &table.in_tolerance_probability) {
            (Some(first), Some(second)) => self.refuse(
                Fault::new(
                    TWO_WAYS,
                    second.key.clone(),
                    "the process is described twice",
                )
                .label("by the fraction in tolerance here")
                .related(first.key.clone(), "by its distribution here")
                .help("leave out one"),
            ),
            (Some(entry), None) => {
                let DistributionEntry::Full(full) = &entry.value else {
                    return self.refuse(
                        Fault::new(PROCESS, entry.span.clone(), "the distribution of the process has no parameters")
                            .label("only its shape is stated")
                            .help("write for example distribution = { normal = { mean = 1500, sd = 0.12 } }"),
                    );
                };
                match full.parametric(&entry.map(|_| ())) {
                    Err(fault) => self.refuse(*fault),
                    Ok(found) if !found.located => self.refuse(
                        Fault::new(
                            PROCESS,
                            entry.span.clone(),
                            "the distribution of the process has no location",
                        )
                        .label("where are the items?")
                        .help("add its `mean` (or `location`, or `lower` and `upper`)"),
                    ),
                    Ok(found) => match found.distribution.validate() {
                        Ok(()) => Some(found.distribution),
                        Err(reason) => self.refuse(
                            Fault::new(PROCESS, entry.span.clone(), reason)
                                .label("parameters do not fit"),
                        ),
                    },
                }
            }
            (None, Some(p)) => {
                let value = self.probability(p)?;
                let Some(width) = tolerance.width() else {
                    return self.refuse(
                        Fault::new(PROCESS, p.span.clone(), "a fraction in tolerance and one tolerance limit do not say how the items scatter")
                            .label("needs `lower` and `upper`")
                            .help("state the distribution: process = { distribution = { normal = { mean = …, sd = … } } }"),
                    );
                };
                Some(Distribution::Normal {
                    mean: tolerance.lower + width / 2.0,
                    sd: width / 2.0 / normal_two_sided_quantile(value),
                })
            }
            (None, None) if table.refused => None,
            (None, None) => self.refuse(
                Fault::new(MISSING_KEY, stated.span.clone(), "`process` says nothing")
                    .label("expected `distribution` or `in_tolerance_probability`"),
            ),
        }
    }

    /// An input by name that moves with the measurand.
    pub(super) fn carrier(
        &mut self,
        stated: &Stated<String>,
        register: &Register,
    ) -> Option<usize> {
        let names = || register.inputs.iter().map(|input| input.name.as_str());
        if let Some(index) = names().position(|name| name == stated.value) {
            return Some(index);
        }
        let fault = Fault::new(
            UNKNOWN_NAME,
            stated.span.clone(),
            format!("there is no input \"{}\"", stated.value),
        )
        .label("not declared");
        let help = match nearest(&stated.value, names()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("inputs: {}", names().collect::<Vec<_>>().join(", ")),
        };
        self.refuse(fault.help(help))
    }

    /// The measurand that a decision is about.
    pub(super) fn decided(
        &mut self,
        stated: &Option<Stated<String>>,
        place: &std::ops::Range<usize>,
        file: &FileTable,
        table: &str,
    ) -> Option<usize> {
        if stated.is_none() && entries(&file.measurand).len() > 1 {
            let names: Vec<&str> = entries(&file.measurand)
                .iter()
                .map(|(name, _)| name.as_str())
                .collect();
            return self.refuse(
                Fault::new(
                    CLAIM,
                    place.clone(),
                    format!("[{table}] does not say which measurand it is about"),
                )
                .label("`measurand` is missing")
                .help(format!(
                    "add measurand = \"{}\" (of {})",
                    names[0],
                    names.join(", ")
                )),
            );
        }
        self.claimed(stated, place)
    }
}

/// The only input, which then carries the measurand.
fn lone(register: &Register) -> Option<usize> {
    (register.inputs.len() == 1).then_some(0)
}

fn no_rule(stated: &Stated<ConformityTable>) -> Fault {
    let (place, message) = match stated
        .value
        .guard_band
        .as_ref()
        .map(|amount| &amount.key)
        .or(stated.value.guard_band_factor.as_ref().map(|r| &r.key))
    {
        Some(key) => (key.clone(), "a guard band without a decision rule"),
        None => (stated.span.clone(), "the decision rule is missing"),
    };
    Fault::new(DECISION_RULE, place, message)
        .label("`rule` is missing")
        .help("add `rule`: \"simple\", \"guarded-acceptance\", \"guarded-rejection\", \"non-binary\", \"ILAC-G8\", \"ISO 14253-1\" or \"JJF 1094\"; or `conformance_probability`")
}
