//! One conformity assessment: its section and its sentence.

use super::compared::{Compared, with_unrounded};
use super::words::{Rows, chance};
use crate::figures::{Figures, with_unit};
use crate::language::Language;
use crate::number::{NONE, aligned, exact, significant};
use crate::{Report, symbol};
use gumption_core::quantity::Unit;
use gumption_fault::say;
use gumption_format::document::Block;
use gumption_gum::budget::{Conformity, DecisionRule, Interval};
use gumption_gum::propagate::{ConformityResult, Verdict};

/// One conformity assessment.
pub(super) struct Assessment<'a> {
    pub report: &'a Report<'a>,
    pub stated: &'a Conformity,
    pub found: &'a ConformityResult,
    pub l: Language,
    pub unit: &'a Unit,
}

impl Assessment<'_> {
    /// The section of the report.
    pub fn section(&self) -> Vec<Block> {
        let (l, name) = (self.l, &self.stated.name);
        let mut rows = Rows::default();
        rows.add(l.pick("Tolerance", "容许区间"), self.tolerance());
        rows.add(l.pick("Decision rule", "判定规则"), self.rule());
        rows.add(l.pick("Accepted", "接受"), self.acceptance());
        if self
            .found
            .acceptance
            .is_some_and(|a| a != self.found.rejection)
        {
            rows.add(l.pick("Rejected", "拒绝"), self.rejected());
        }
        if let Some(verdict) = self.found.verdict {
            rows.add(l.pick("Measured", "测得值"), self.measured());
            rows.add(l.pick("Verdict", "结论"), self.verdict(verdict).to_string());
        }
        self.specific(&mut rows);
        self.capability(&mut rows);
        self.global(&mut rows);
        rows.under(say!("Conformity of {name}").in_language(l))
    }

    /// The sentence for the certificate; none in planning.
    pub fn sentence(&self) -> Option<String> {
        let (name, l) = (&self.stated.name, self.l);
        let verdict = self.found.verdict?;
        let word = self.verdict(verdict);
        let (measured, tolerance, rule) = (self.measured(), self.tolerance(), self.rule());
        let probability = self
            .found
            .conformance
            .and_then(|known| known.probability)
            .map(chance);
        let probability = probability.map_or_else(String::new, |p| {
            let told = match p.split_once(' ') {
                Some((">", p)) => say!(" The conformance probability is above {p}."),
                Some(("<", p)) => say!(" The conformance probability is below {p}."),
                _ => say!(" The conformance probability is {p}."),
            };
            told.in_language(l)
        });
        let acceptance = self.acceptance();
        Some(say!("{name}, tolerance {tolerance}: {word}. Decision rule: {rule}; measured values accepted: {acceptance}; measured: {measured}.{probability}").in_language(l))
    }

    /// The verdict in words. That a guard band decided against the tolerance limit itself is said.
    fn verdict(&self, verdict: Verdict) -> &'static str {
        let inside = self.stated.tolerance.contains_decimal(self.found.estimate);
        let (english, chinese) = match (verdict, inside) {
            (Verdict::Conforming, true) => ("conforming", "合格"),
            (Verdict::Conforming, false) => (
                "conforming under the rule (outside the tolerance, but non-conformance is not shown)",
                "按规则判为合格（超出容许区间，但不足以证明不合格）",
            ),
            (Verdict::NotConforming, false) => ("not conforming", "不合格"),
            (Verdict::NotConforming, true) => (
                "not conforming under the rule (inside the tolerance, but conformance is not shown)",
                "按规则判为不合格（在容许区间内，但不足以证明合格）",
            ),
            (Verdict::Undecided, _) => ("cannot be decided under the rule", "待定"),
            (Verdict::Withheld, _) => (
                "no verdict (first order does not give the uncertainty of this value; evaluate with Monte Carlo)",
                "不作判定（一阶近似给不出该值的不确定度；请用蒙特卡洛法评定）",
            ),
        };
        self.l.pick(english, chinese)
    }

    pub(super) fn tolerance(&self) -> String {
        self.interval(self.stated.tolerance, &exact)
    }

    fn acceptance(&self) -> String {
        let stated = matches!(
            self.stated.rule,
            DecisionRule::Simple | DecisionRule::Stated(_)
        );
        match self.found.acceptance {
            None => say!("no value: the uncertainty is too large for this tolerance")
                .in_language(self.l),
            Some(acceptance) if stated => self.interval(acceptance, &exact),
            Some(acceptance) => self.interval(acceptance, &|x| self.limit(x)),
        }
    }

    /// The measured values that are accepted, where a guard band makes them others than those inside the tolerance.
    pub(super) fn guarded(&self) -> Option<String> {
        let is_guarded = self.found.acceptance != Some(self.stated.tolerance);
        is_guarded.then(|| self.acceptance())
    }

    /// The value in full, where its rounded form would be judged otherwise.
    pub(super) fn value_in_full(&self) -> Option<String> {
        let figures = Figures::new(self.report, self.stated.measurand);
        self.compared(|compared| compared.in_full(&figures.estimate()))
    }

    /// What lies beyond the limits of rejection.
    fn rejected(&self) -> String {
        let Interval { lower, upper } = self.found.rejection;
        let beyond = |sign: &str, limit: f64| {
            let number = format!("{sign} {}", self.limit(limit));
            with_unit(&number, &symbol(self.unit))
        };
        match (lower.is_finite(), upper.is_finite()) {
            (true, true) => {
                [beyond("<", lower), beyond(">", upper)].join(self.l.pick(" or ", " 或 "))
            }
            (true, false) => beyond("<", lower),
            (false, true) => beyond(">", upper),
            (false, false) => NONE.to_string(),
        }
    }

    fn interval(&self, interval: Interval, number: &dyn Fn(f64) -> String) -> String {
        let unit = symbol(self.unit);
        let bound = |sign: &str, limit: f64| with_unit(&format!("{sign} {}", number(limit)), &unit);
        match (interval.lower.is_finite(), interval.upper.is_finite()) {
            (true, true) => with_unit(
                &format!("[{}, {}]", number(interval.lower), number(interval.upper)),
                &unit,
            ),
            (true, false) => bound("≥", interval.lower),
            (false, true) => bound("≤", interval.upper),
            (false, false) => self.l.pick("any value", "任意值").to_string(),
        }
    }

    /// A limit that follows from u.
    fn limit(&self, x: f64) -> String {
        aligned(x, self.found.u, self.compared(|compared| compared.digits()))
    }

    /// The measured value beside all limits of the assessment.
    fn compared<T>(&self, tell: impl FnOnce(&Compared<'_>) -> T) -> T {
        let (stated, found) = (self.stated.tolerance, self.found);
        let acceptance = found.acceptance.unwrap_or(stated);
        tell(&Compared {
            value: found.estimate,
            limits: &[stated, acceptance, found.rejection],
            print_value: &|digits| aligned(found.estimate, found.u, digits),
            print_limit: &|limit, digits| match [stated.lower, stated.upper].contains(&limit) {
                true => exact(limit),
                false => aligned(limit, found.u, digits),
            },
        })
    }

    /// U in full, where a rule asks whether it is a part of the permissible error, and its rounded form answers otherwise.
    fn expanded_in_full(&self, rounded: &str) -> Option<String> {
        let most = self.stated.rule.largest_expanded(self.stated.tolerance)?;
        let upper = Interval {
            lower: f64::NEG_INFINITY,
            upper: most,
        };
        let found = self.found.expanded;
        let compared = Compared {
            value: found,
            limits: &[upper],
            print_value: &|digits| significant(found, digits),
            print_limit: &|limit, digits| significant(limit, digits),
        };
        compared.in_full(rounded)
    }

    /// The result as it is reported, in full beside it where rounding would change the verdict.
    fn measured(&self) -> String {
        let figures = Figures::new(self.report, self.stated.measurand);
        let l = self.l;
        let comma = l.comma();
        let in_full = self.value_in_full();
        let in_full = in_full.map(|number| figures.of_value(&number));
        let mut parts = vec![with_unrounded(&figures.value(), in_full.as_deref(), l)];
        if let Some(expanded) = figures.expanded() {
            let in_full = self.expanded_in_full(&expanded);
            let in_full = in_full.map(|number| figures.amount(&number));
            let expanded = with_unrounded(&figures.amount(&expanded), in_full.as_deref(), l);
            parts.push(format!("U = {expanded}"));
        }
        if let Some(ends) = figures.interval() {
            if let Some(u) = figures.u() {
                parts.push(format!("u = {}", figures.amount(&u)));
            }
            let ends = figures.of_value(&format!("[{}, {}]", ends[0], ends[1]));
            parts.push(say!("coverage interval {ends}").in_language(l));
            if self.stated.rule.takes_expanded() {
                let half = figures.amount(&significant(self.found.expanded, 2));
                parts.push(say!("half of its width {half} taken for U").in_language(l));
            }
        }
        parts.join(comma)
    }

    /// Unit of a difference.
    pub fn deviations(&self) -> String {
        symbol(self.unit)
    }
}
