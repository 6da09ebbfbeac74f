//! Conformity with a tolerance and characteristic limits: sections of the report, and sentences for the
//! certificate (ISO/IEC 17025 7.8.6: result, tolerance and decision rule).

use crate::budget::{Conformity, DecisionRule, Detection, Guard, ISO_14253_PROBABILITY, Interval};
use crate::propagate::{ConformityResult, DetectionLimit, DetectionResult, Verdict};
use crate::quantity::{Unit, space_before};

use super::document::Block;
use super::language::Language;
use super::number::{
    NONE, TABLE_DIGITS, aligned, at_place, exact, print, probability, significant,
};
use super::{Report, difference_symbol, symbol};

/// The sections of all decisions.
pub(super) fn blocks(report: &Report<'_>) -> Vec<Block> {
    let conformity = assessments(report).flat_map(|subject| subject.section());
    let detection = detections(report).flat_map(|subject| subject.section());
    conformity.chain(detection).collect()
}

/// The sentences of all decisions.
pub(super) fn sentences(report: &Report<'_>) -> Vec<String> {
    let conformity = assessments(report).filter_map(|subject| subject.sentence());
    let detection = detections(report).map(|subject| subject.sentence());
    conformity.chain(detection).collect()
}

/// Stable name of a verdict for machines.
pub(super) fn verdict_code(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Conforming => "conforming",
        Verdict::NotConforming => "not_conforming",
        Verdict::Undecided => "undecided",
    }
}

fn assessments<'a>(report: &'a Report<'a>) -> impl Iterator<Item = Assessment<'a>> {
    let pairs = report.budget.conformity.iter();
    let pairs = pairs.zip(&report.evaluation.conformity);
    pairs.map(|(stated, found)| Assessment {
        report,
        stated,
        found,
        l: report.language,
        unit: report.measurand(stated.measurand).1,
    })
}

fn detections<'a>(report: &'a Report<'a>) -> impl Iterator<Item = Limits<'a>> {
    let pairs = report.budget.detection.iter();
    let pairs = pairs.zip(&report.evaluation.detection);
    pairs.map(|(stated, found)| Limits {
        report,
        stated,
        found,
        l: report.language,
        name: report.measurand(stated.measurand).0,
        unit: report.measurand(stated.measurand).1,
    })
}

/// One conformity assessment.
struct Assessment<'a> {
    report: &'a Report<'a>,
    stated: &'a Conformity,
    found: &'a ConformityResult,
    l: Language,
    unit: &'a Unit,
}

impl Assessment<'_> {
    fn section(&self) -> Vec<Block> {
        let (l, name) = (self.l, &self.stated.name);
        let mut fields: Vec<(String, String)> = Vec::new();
        let mut row = |label: &str, text: String| fields.push((label.to_string(), text));
        row(l.pick("Tolerance", "容许区间"), self.tolerance());
        row(l.pick("Decision rule", "判定规则"), self.rule());
        row(l.pick("Accepted", "接受"), self.acceptance());
        if self
            .found
            .acceptance
            .is_some_and(|a| a != self.found.rejection)
        {
            row(l.pick("Rejected", "拒绝"), self.rejected());
        }
        if let Some(verdict) = self.found.verdict {
            row(l.pick("Measured", "测得值"), self.measured());
            row(l.pick("Verdict", "结论"), self.verdict(verdict).to_string());
        }
        self.specific(&mut row);
        self.capability(&mut row);
        self.global(&mut row);
        vec![
            Block::Section(l.pick(
                format!("Conformity of {name}"),
                format!("{name} 的符合性评定"),
            )),
            Block::Fields(fields),
        ]
    }

    /// What is known of the item that was measured.
    fn specific(&self, row: &mut dyn FnMut(&str, String)) {
        let (l, Some(known)) = (self.l, self.found.conformance) else {
            return;
        };
        let alone = l.pick("from the result alone", "仅由测量结果");
        let by_gum = chance(known.from_measurement);
        let trials = known.from_trials.map(chance);
        let trials = trials.map_or_else(String::new, |p| {
            l.pick(format!(", Monte Carlo {p}"), format!("，蒙特卡洛法 {p}"))
        });
        let label = l.pick("Conformance probability", "符合概率");
        if self.stated.process.is_some() {
            let both = known.probability.map_or_else(
                || {
                    l.pick(
                        "none: the measured value is impossible for this process",
                        "不存在：对该过程而言测得值不可能出现",
                    )
                    .to_string()
                },
                |p| {
                    let p = chance(p);
                    l.pick(
                        format!("p_c = {p}, with the knowledge of the process"),
                        format!("p_c = {p}（计入过程信息）"),
                    )
                },
            );
            row(
                label,
                [both, format!("{alone} {by_gum}{trials}")].join(l.pick("; ", "；")),
            );
        } else {
            row(label, format!("p_c = {by_gum}{trials}"));
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
            Some(Verdict::Undecided) | None => None,
        };
        if let Some((label, text)) = risk {
            row(label, text);
        }
    }

    fn capability(&self, row: &mut dyn FnMut(&str, String)) {
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
        row(
            l.pick("Capability", "测量能力"),
            l.pick(
                format!("C_m = T/(4u) = {c}, TUR = T/(2U) = {ratio_text}: {met}"),
                format!("C_m = T/(4u) = {c}，TUR = T/(2U) = {ratio_text}：{met}"),
            ),
        );
    }

    /// Risks over all items.
    fn global(&self, row: &mut dyn FnMut(&str, String)) {
        let (l, Some(risk), Some(process)) = (self.l, self.found.global, &self.stated.process)
        else {
            return;
        };
        let kind = process.kind();
        let inside = chance(risk.in_tolerance);
        row(
            l.pick("Process", "过程"),
            l.pick(
                format!(
                    "{} distribution; {inside} of the items conform",
                    kind.name_en
                ),
                format!("{}；{inside} 的产品合格", kind.name_zh),
            ),
        );
        row(l.pick("Items accepted", "接受率"), chance(risk.accepted));
        let given = |p: f64| {
            if p.is_finite() {
                chance(p)
            } else {
                NONE.to_string()
            }
        };
        let (consumer, producer) = (chance(risk.consumer), chance(risk.producer));
        let (wrong, lost) = (given(risk.false_acceptance), given(risk.false_rejection));
        row(
            l.pick("Global consumer's risk", "总体使用方风险"),
            l.pick(
                format!("R_C = {consumer}; of the accepted items {wrong} do not conform"),
                format!("R_C = {consumer}；被接受者中不合格的占 {wrong}"),
            ),
        );
        row(
            l.pick("Global producer's risk", "总体生产方风险"),
            l.pick(
                format!("R_P = {producer}; of the rejected items {lost} conform"),
                format!("R_P = {producer}；被拒绝者中合格的占 {lost}"),
            ),
        );
    }

    /// The sentence for the certificate; none in planning.
    fn sentence(&self) -> Option<String> {
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
            l.pick(
                format!(" The conformance probability is {p}."),
                format!("符合概率为 {p}。"),
            )
        });
        let acceptance = self.acceptance();
        Some(match l {
            Language::English => format!(
                "{name}, tolerance {tolerance}: {word}. Decision rule: {rule}; measured values accepted: {acceptance}; measured: {measured}.{probability}"
            ),
            Language::Chinese => format!(
                "{name}：{word}（容许区间 {tolerance}）。判定规则：{rule}，接受条件：{acceptance}；测得值 {measured}。{probability}"
            ),
        })
    }

    /// The verdict in words. That a guard band decided against the tolerance limit itself is said.
    fn verdict(&self, verdict: Verdict) -> &'static str {
        let inside = self.stated.tolerance.contains(self.found.estimate);
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
        };
        self.l.pick(english, chinese)
    }

    fn rule(&self) -> String {
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
            Guard::Amount(w) => format!("w = {}", with_unit(&exact(w), self.deviations())),
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

    fn tolerance(&self) -> String {
        self.interval(self.stated.tolerance, &exact)
    }

    fn acceptance(&self) -> String {
        let stated = matches!(
            self.stated.rule,
            DecisionRule::Simple | DecisionRule::Stated(_)
        );
        match self.found.acceptance {
            None => self
                .l
                .pick(
                    "no value: u is too large for this tolerance",
                    "无：对该容许区间而言 u 过大",
                )
                .to_string(),
            Some(acceptance) if stated => self.interval(acceptance, &exact),
            Some(acceptance) => self.interval(acceptance, &|x| self.limit(x)),
        }
    }

    /// What lies beyond the limits of rejection.
    fn rejected(&self) -> String {
        let Interval { lower, upper } = self.found.rejection;
        let beyond = |sign: &str, limit: f64| {
            let number = format!("{sign} {}", self.limit(limit));
            with_unit(&number, symbol(self.unit))
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
        let bound =
            |sign: &str, limit: f64| with_unit(&format!("{sign} {}", number(limit)), unit.clone());
        match (interval.lower.is_finite(), interval.upper.is_finite()) {
            (true, true) => with_unit(
                &format!("[{}, {}]", number(interval.lower), number(interval.upper)),
                unit,
            ),
            (true, false) => bound("≥", interval.lower),
            (false, true) => bound("≤", interval.upper),
            (false, false) => self.l.pick("any value", "任意值").to_string(),
        }
    }

    /// A limit that follows from u.
    fn limit(&self, x: f64) -> String {
        aligned(x, self.found.u, TABLE_DIGITS)
    }

    fn measured(&self) -> String {
        let rule = self.report.budget.conventions.rounding_rule();
        let (estimate, expanded) = (self.found.estimate, self.found.expanded);
        if expanded.is_nan() || expanded <= 0.0 || expanded.is_infinite() {
            return with_unit(&exact(estimate), symbol(self.unit));
        }
        let pair = rule.align(estimate, expanded);
        format!(
            "{}{}U = {}",
            with_unit(&print(&pair.estimate), symbol(self.unit)),
            self.l.pick(", ", "，"),
            with_unit(&print(&pair.uncertainty), self.deviations())
        )
    }

    fn deviations(&self) -> String {
        difference_symbol(self.unit)
    }
}

/// Characteristic limits of one measurand.
struct Limits<'a> {
    report: &'a Report<'a>,
    stated: &'a Detection,
    found: &'a DetectionResult,
    l: Language,
    name: &'a str,
    unit: &'a Unit,
}

impl Limits<'_> {
    fn section(&self) -> Vec<Block> {
        let l = self.l;
        let mut fields: Vec<(String, String)> = Vec::new();
        let mut row = |label: &str, text: String| fields.push((label.to_string(), text));
        let gross = &self.report.budget.inputs[self.stated.gross].name;
        let error = |p: f64, quantile: Option<f64>| match quantile {
            None => probability(p),
            Some(k) => format!("{} (k = {})", probability(p), exact(k)),
        };
        let [k_alpha, k_beta] = self.stated.quantiles;
        let (alpha, beta) = (
            error(self.stated.alpha, k_alpha),
            error(self.stated.beta, k_beta),
        );
        let comma = l.pick(", ", "，");
        let of_trials = |text: Option<String>| match text {
            None => String::new(),
            Some(text) => l.pick(
                format!(" (Monte Carlo {text})"),
                format!("（蒙特卡洛法 {text}）"),
            ),
        };
        match self.found.limits {
            None => row(
                l.pick("Decision threshold", "判断限"),
                l.pick(
                    format!(
                        "none: no value of {gross} gives {} = 0 with a u that is finite",
                        self.name
                    ),
                    format!(
                        "不存在：{gross} 取任何值都不能使 {} = 0 且 u 有限",
                        self.name
                    ),
                ),
            ),
            Some(limits) => {
                let trials = self.found.from_trials;
                let threshold = self.value(limits.decision_threshold);
                let by_trials = of_trials(trials.map(|t| self.value(t.decision_threshold)));
                row(
                    l.pick("Decision threshold", "判断限"),
                    format!("y* = {threshold}{comma}α = {alpha}{by_trials}"),
                );
                let by_trials = trials.and_then(|t| t.detection_limit.value());
                let by_trials = of_trials(by_trials.map(|y| self.value(y)));
                row(
                    l.pick("Detection limit", "探测限"),
                    match limits.detection_limit {
                        DetectionLimit::Found(y) => {
                            format!("y# = {}{comma}β = {beta}{by_trials}", self.value(y))
                        }
                        DetectionLimit::Missing { relative } => self.no_limit(relative),
                    },
                );
            }
        }
        if let (Some(suitable), Some(guideline)) =
            (self.found.suitable(self.stated), self.stated.guideline)
        {
            let guideline = with_unit(&exact(guideline), symbol(self.unit));
            let word = match (suitable, l) {
                (true, Language::English) => "suitable",
                (false, Language::English) => "not suitable",
                (true, Language::Chinese) => "适用",
                (false, Language::Chinese) => "不适用",
            };
            row(
                l.pick("Procedure", "测量程序"),
                l.pick(
                    format!("{word} for the guideline value {guideline}"),
                    format!("对参考值 {guideline} {word}"),
                ),
            );
        }
        row(l.pick("Verdict", "结论"), self.verdict().to_string());
        let best = self.found.best;
        let p = probability(best.coverage_probability);
        row(
            l.pick("Best estimate", "最佳估计值"),
            format!(
                "ŷ = {}{comma}u(ŷ) = {}",
                self.beside(best.value, best.u),
                with_unit(
                    &significant(best.u, TABLE_DIGITS),
                    difference_symbol(self.unit)
                )
            ),
        );
        let interval = |ends: [f64; 2]| {
            let [low, high] = ends.map(|end| aligned(end, best.u, TABLE_DIGITS));
            with_unit(&format!("[{low}, {high}]"), symbol(self.unit))
        };
        let (symmetric, shortest) = (interval(best.symmetric), interval(best.shortest));
        row(
            l.pick("Coverage interval", "包含区间"),
            l.pick(
                format!("{symmetric}, shortest {shortest}, p = {p}"),
                format!("{symmetric}，最短 {shortest}，p = {p}"),
            ),
        );
        vec![
            Block::Section(l.pick(
                format!("Characteristic limits of {}", self.name),
                format!("{} 的特征限", self.name),
            )),
            Block::Fields(fields),
        ]
    }

    fn no_limit(&self, relative: f64) -> String {
        let percent = print(&at_place(100.0 * relative, 0));
        self.l.pick(
            format!("none: for large values u is {percent} % of the value, so that none is recognised with certainty enough"),
            format!("不存在：数值较大时 u 达到其 {percent} %，任何值都不能以足够的概率被识别"),
        )
    }

    fn verdict(&self) -> &'static str {
        let (english, chinese) = match self.found.recognised() {
            Some(true) => ("effect recognised: y > y*", "识别出效应：y > y*"),
            Some(false) => ("no effect recognised: y ≤ y*", "未识别出效应：y ≤ y*"),
            None => ("no decision threshold", "无判断限"),
        };
        self.l.pick(english, chinese)
    }

    fn sentence(&self) -> String {
        let (name, l, best) = (self.name, self.l, self.found.best);
        let verdict = self.verdict();
        let limits = self.found.limits.map_or_else(String::new, |limits| {
            let threshold = self.value(limits.decision_threshold);
            let limit = limits.detection_limit.value().map_or_else(
                || l.pick("no detection limit", "探测限不存在").to_string(),
                |y| {
                    let y = self.value(y);
                    l.pick(
                        format!("detection limit y# = {y}"),
                        format!("探测限 y# = {y}"),
                    )
                },
            );
            l.pick(
                format!(" (decision threshold y* = {threshold}, {limit})"),
                format!("（判断限 y* = {threshold}，{limit}）"),
            )
        });
        let p = probability(best.coverage_probability);
        let estimate = self.beside(best.value, best.u);
        let u = with_unit(&significant(best.u, 2), difference_symbol(self.unit));
        let [low, high] = best
            .symmetric
            .map(|end| with_unit(&aligned(end, best.u, 2), symbol(self.unit)));
        match l {
            Language::English => format!(
                "{name}: {verdict}{limits}. Best estimate of the non-negative measurand {estimate}, u = {u}, {p} coverage interval from {low} to {high} (ISO 11929)."
            ),
            Language::Chinese => format!(
                "{name}：{verdict}{limits}。非负被测量的最佳估计值 {estimate}，u = {u}，{p} 包含区间为 {low} 至 {high}（ISO 11929）。"
            ),
        }
    }

    /// A limit: a figure of its own, to three digits.
    fn value(&self, x: f64) -> String {
        with_unit(&significant(x, TABLE_DIGITS), symbol(self.unit))
    }

    fn beside(&self, x: f64, u: f64) -> String {
        with_unit(&aligned(x, u, TABLE_DIGITS), symbol(self.unit))
    }
}

/// A probability in percent with two digits of whichever is smaller, it or its complement.
fn chance(p: f64) -> String {
    /// Nearer to one than anybody can vouch for.
    const CERTAIN: f64 = 1e-6;
    let complement = 1.0 - p;
    if p > 0.5 && complement < CERTAIN {
        return "> 99.9999 %".to_string();
    }
    if p <= 0.5 {
        return format!("{} %", significant(100.0 * p, 2));
    }
    let place = libm::log10(100.0 * complement).floor() as i32 - 1;
    format!("{} %", print(&at_place(100.0 * p, place.min(0))))
}

fn with_unit(number: &str, unit: String) -> String {
    match unit.as_str() {
        "" => number.to_string(),
        _ => format!("{number}{}{unit}", space_before(&unit)),
    }
}

#[cfg(test)]
mod tests {
    use super::chance;

    #[test]
    fn probabilities_show_what_is_rare() {
        assert_eq!(chance(0.009_878), "0.99 %");
        assert_eq!(chance(0.113_340), "11 %");
        assert_eq!(chance(0.919_243), "91.9 %");
        assert_eq!(chance(0.989_01), "98.9 %");
        assert_eq!(chance(0.662_63), "66 %");
        assert_eq!(chance(1.0 - 1e-9), "> 99.9999 %");
        assert_eq!(chance(0.0), "0 %");
    }
}
