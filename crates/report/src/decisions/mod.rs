//! Conformity with a tolerance and characteristic limits: sections of the report, and sentences for the
//! certificate (ISO/IEC 17025 7.8.6: result, tolerance and decision rule).

mod compared;
mod conformity;
mod detection;
mod risks;
mod rule;
mod words;

use crate::Report;
use crate::language::Language;
use gumption_format::document::Block;
use gumption_gum::propagate::Verdict;

pub(super) use compared::with_unrounded;
use conformity::Assessment;
use detection::Limits;

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

/// Tolerance, rule and verdict of one decision, as a line of a table of results has them.
pub(super) struct Decided<'a> {
    /// Name of the item.
    pub name: &'a str,
    /// The tolerance.
    pub tolerance: String,
    /// The measured values that the rule accepts, where they are others than those inside the tolerance.
    pub accepted: Option<String>,
    /// The value in full, where its rounded form would be judged otherwise.
    pub in_full: Option<String>,
    /// The rule.
    pub rule: String,
    /// The verdict.
    pub verdict: Option<Verdict>,
    /// Whether the value lies inside the tolerance.
    pub inside: bool,
}

/// The decisions about a measurand.
pub(super) fn decided<'a>(report: &'a Report<'a>, measurand: usize) -> Vec<Decided<'a>> {
    let about = assessments(report).filter(|subject| subject.stated.measurand == measurand);
    let decided = about.map(|subject| Decided {
        name: &subject.stated.name,
        tolerance: subject.tolerance(),
        accepted: subject.guarded(),
        in_full: subject.value_in_full(),
        rule: subject.rule(),
        verdict: subject.found.verdict,
        inside: subject
            .stated
            .tolerance
            .contains_decimal(subject.found.estimate),
    });
    decided.collect()
}

/// An effect whose result is above the decision threshold, and one whose result is not, for machines.
pub(super) const RECOGNISED: &str = "recognised";
pub(super) const NOT_RECOGNISED: &str = "not_recognised";

/// Stable name of a verdict for machines.
pub(super) fn verdict_code(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Conforming => "conforming",
        Verdict::NotConforming => "not_conforming",
        Verdict::Undecided => "undecided",
        Verdict::Withheld => "withheld",
    }
}

/// A verdict in a word.
pub(super) fn verdict_word(l: Language, verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Conforming => l.pick("conforming", "合格"),
        Verdict::NotConforming => l.pick("not conforming", "不合格"),
        Verdict::Undecided => l.pick("undecided", "待定"),
        Verdict::Withheld => l.pick("no verdict", "不作判定"),
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
