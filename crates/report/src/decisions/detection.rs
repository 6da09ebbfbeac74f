//! Characteristic limits of one measurand: their section and their sentence.

use super::compared::{Compared, with_unrounded};
use super::words::Rows;
use crate::figures::{Figures, with_unit};
use crate::language::Language;
use crate::number::{TABLE_DIGITS, aligned, at_place, exact, print, probability, significant};
use crate::{Report, symbol};
use gumption_core::quantity::Unit;
use gumption_fault::say;
use gumption_format::document::Block;
use gumption_gum::budget::{Detection, Interval};
use gumption_gum::propagate::{DetectionLimit, DetectionResult};

/// Characteristic limits of one measurand.
pub(super) struct Limits<'a> {
    pub report: &'a Report<'a>,
    pub stated: &'a Detection,
    pub found: &'a DetectionResult,
    pub l: Language,
    pub name: &'a str,
    pub unit: &'a Unit,
}

impl Limits<'_> {
    /// The section of the report.
    pub fn section(&self) -> Vec<Block> {
        let l = self.l;
        let mut rows = Rows::default();
        self.limits(&mut rows);
        self.suitability(&mut rows);
        let in_full = self.in_full().map(|number| format!("y = {number}"));
        let verdict = with_unrounded(self.verdict(), in_full.as_deref(), l);
        rows.add(l.pick("Verdict", "结论"), verdict);
        self.best(&mut rows);
        rows.under(say!("Characteristic limits of {}", self.name).in_language(l))
    }

    /// Decision threshold and detection limit.
    fn limits(&self, rows: &mut Rows) {
        let (l, trials) = (self.l, self.found.from_trials);
        let label = l.pick("Decision threshold", "判断阈");
        let Some(limits) = self.found.limits else {
            return rows.add(label, self.no_threshold());
        };
        let [k_alpha, k_beta] = self.stated.quantiles;
        let (alpha, beta) = (
            error(self.stated.alpha, k_alpha),
            error(self.stated.beta, k_beta),
        );
        let comma = l.comma();
        let threshold = self.threshold(limits.decision_threshold);
        let by_trials = self.of_trials(trials.map(|t| t.decision_threshold));
        rows.add(
            label,
            format!("y* = {threshold}{comma}α = {alpha}{by_trials}"),
        );
        let by_trials = self.of_trials(trials.and_then(|t| t.detection_limit.value()));
        let limit = match limits.detection_limit {
            DetectionLimit::Found(y) => {
                format!("y# = {}{comma}β = {beta}{by_trials}", self.value(y))
            }
            DetectionLimit::Missing { relative } => self.no_limit(relative),
        };
        rows.add(l.pick("Detection limit", "探测限"), limit);
    }

    /// The same limit from the trials of the Monte Carlo method.
    fn of_trials(&self, limit: Option<f64>) -> String {
        limit.map_or_else(String::new, |limit| {
            let text = self.value(limit);
            say!(" (Monte Carlo {text})").in_language(self.l)
        })
    }

    /// Whether the procedure can see what it has to see.
    fn suitability(&self, rows: &mut Rows) {
        let (l, stated) = (self.l, self.stated);
        let (Some(suitable), Some(guideline)) = (self.found.suitable(stated), stated.guideline)
        else {
            return;
        };
        let guideline = with_unit(&exact(guideline), &symbol(self.unit));
        let word = match (suitable, l) {
            (true, Language::English) => "suitable",
            (false, Language::English) => "not suitable",
            (true, Language::Chinese) => "适用",
            (false, Language::Chinese) => "不适用",
        };
        rows.add(
            l.pick("Procedure", "测量程序"),
            say!("{word} for the guideline value {guideline}").in_language(l),
        );
    }

    /// What is known of the measurand beside the decision, given that it is not negative.
    fn best(&self, rows: &mut Rows) {
        let (l, best) = (self.l, self.found.best);
        let u = significant(best.u, TABLE_DIGITS);
        rows.add(
            l.pick("Best estimate", "最佳估计值"),
            format!(
                "ŷ = {}{}u(ŷ) = {}",
                self.beside(best.value, best.u),
                l.comma(),
                with_unit(&u, &symbol(self.unit))
            ),
        );
        let interval = |ends: [f64; 2]| {
            let [low, high] = ends.map(|end| aligned(end, best.u, TABLE_DIGITS));
            with_unit(&format!("[{low}, {high}]"), &symbol(self.unit))
        };
        let figures = self.figures();
        let reported = figures.interval().map_or_else(
            || interval(best.symmetric),
            |[low, high]| figures.of_value(&format!("[{low}, {high}]")),
        );
        let shortest = interval(best.shortest);
        let p = probability(best.coverage_probability);
        let trials = self
            .found
            .best_from_trials
            .map_or_else(String::new, |best| {
                let found = interval(best.symmetric);
                say!(" (Monte Carlo {found})").in_language(l)
            });
        rows.add(
            l.pick("Coverage interval", "包含区间"),
            say!("{reported}{trials}, shortest {shortest}, p = {p}").in_language(l),
        );
    }

    /// The reported result.
    fn figures(&self) -> Figures<'_> {
        Figures::new(self.report, self.stated.measurand)
    }

    fn no_threshold(&self) -> String {
        let gross = &self.report.budget.inputs[self.stated.gross].name;
        say!(
            "none: no value of {gross} gives {} = 0 with a u that is finite",
            self.name
        )
        .in_language(self.l)
    }

    fn no_limit(&self, relative: f64) -> String {
        let percent = print(&at_place(100.0 * relative, 0));
        say!("none: for large values u is {percent} % of the value, so that none is recognised with certainty enough").in_language(self.l)
    }

    fn verdict(&self) -> &'static str {
        let (english, chinese) = match self.found.recognised() {
            Some(true) => ("effect recognised: y > y*", "识别出效应：y > y*"),
            Some(false) => ("no effect recognised: y ≤ y*", "未识别出效应：y ≤ y*"),
            None => ("no decision threshold", "无判断阈"),
        };
        self.l.pick(english, chinese)
    }

    /// The sentence for the certificate.
    pub fn sentence(&self) -> String {
        let (l, best, figures) = (self.l, self.found.best, self.figures());
        let y = with_unrounded(&figures.value(), self.in_full().as_deref(), l);
        let name = self.name;
        let u_of_y = figures.amount(&figures.u().unwrap_or_default());
        let verdict = self.verdict();
        let limits = self.limits_in_brackets();
        let p = probability(best.coverage_probability);
        // The value has the last place of its u (JCGM 100, 7.2.6).
        let estimate = figures.of_value(&aligned(best.value, best.u, 2));
        let u = figures.amount(&significant(best.u, 2));
        let ends = figures.interval().unwrap_or_default();
        let [low, high] = ends.map(|end| figures.of_value(&end));
        say!("{name} = {y}, u = {u_of_y}; {verdict}{limits}. Best estimate of the non-negative measurand {estimate}, with the standard uncertainty {u}; {p} coverage interval from {low} to {high} (ISO 11929).").in_language(l)
    }

    /// The estimate beside the decision threshold.
    fn compared<T>(&self, threshold: f64, tell: impl FnOnce(&Compared<'_>) -> T) -> T {
        let reported = &self.figures().reported;
        let (y, u) = (reported.estimate, reported.u.unwrap_or(self.found.best.u));
        tell(&Compared {
            value: y,
            limits: &[Interval {
                lower: f64::NEG_INFINITY,
                upper: threshold,
            }],
            print_value: &|digits| aligned(y, u, digits),
            print_limit: &|limit, digits| significant(limit, digits),
        })
    }

    /// The estimate in full, where rounding would change the verdict.
    fn in_full(&self) -> Option<String> {
        let threshold = self.found.limits?.decision_threshold;
        let figures = self.figures();
        let full = self.compared(threshold, |compared| compared.in_full(&figures.estimate()))?;
        Some(figures.of_value(&full))
    }

    /// The decision threshold, with the digits that tell y from it.
    fn threshold(&self, threshold: f64) -> String {
        let digits = self.compared(threshold, |compared| compared.digits());
        with_unit(&significant(threshold, digits), &symbol(self.unit))
    }

    fn limits_in_brackets(&self) -> String {
        let l = self.l;
        self.found.limits.map_or_else(String::new, |limits| {
            let threshold = self.threshold(limits.decision_threshold);
            let limit = limits.detection_limit.value().map_or_else(
                || l.pick("no detection limit", "探测限不存在").to_string(),
                |y| {
                    let y = self.value(y);
                    say!("detection limit y# = {y}").in_language(l)
                },
            );
            say!(" (decision threshold y* = {threshold}, {limit})").in_language(l)
        })
    }

    /// A limit: a figure of its own, to three digits.
    fn value(&self, x: f64) -> String {
        with_unit(&significant(x, TABLE_DIGITS), &symbol(self.unit))
    }

    fn beside(&self, x: f64, u: f64) -> String {
        with_unit(&aligned(x, u, TABLE_DIGITS), &symbol(self.unit))
    }
}

/// A probability of error, with the quantile that the file states for it.
fn error(p: f64, quantile: Option<f64>) -> String {
    match quantile {
        None => probability(p),
        Some(k) => format!("{} (k = {})", probability(p), exact(k)),
    }
}
