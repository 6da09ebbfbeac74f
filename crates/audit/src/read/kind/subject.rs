//! What the words of a row are about: which kind of knowledge they state.

use crate::read::counts::{count_before, trailing_count};
use crate::read::family::*;
use crate::read::words::{find, has};

use super::evidence::Evidence;
use super::limits::shape;
use super::readings::{are_limits, count};

/// What the words of a row are about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Subject {
    /// The range of readings.
    Range,
    /// A full width.
    FullWidth,
    /// Readings without scatter.
    Alike,
    /// The step of an indication.
    Step,
    /// A certificate.
    Certificate,
    /// Readings, by their standard deviation.
    Readings,
    /// An influence that cycles.
    Cycling,
    /// Limits.
    Limits,
    /// A standard uncertainty.
    Standard,
}

/// What the words are about, in small letters. Of several subjects the first in the words counts: `resolution contained
/// in the repeatability` is about a resolution.
pub(super) fn subject(e: &Evidence<'_>, text: &str) -> Option<Subject> {
    let first = |keys: &[&str]| keys.iter().filter_map(|key| find(text, key, 0)).min();
    let reading = has(text, DEVIATION)
        || has(text, POOLED)
        || count_before(text, &["reading", "observation"]).is_some();
    let limited = first(LIMITS).into_iter().chain(first(RECTANGULAR)).min();
    let certified = has(text, CERTIFICATE) && !has(text, &["specification", "允许误差", "limit"]);
    // Whatever else the words are about: they say what the figure is, where nothing was divided.
    if has(text, AS_STATED) && (e.used.is_none() || e.u_is_used()) {
        Some(Subject::Standard)
    } else if is_range(e, text) {
        Some(Subject::Range)
    } else if has(text, FULL_WIDTH) {
        Some(Subject::FullWidth)
    } else if are_alike(text) {
        Some(Subject::Alike)
    } else if is_step(text, &first) {
        Some(Subject::Step)
    } else if certified && (!reading || first(CERTIFICATE) < first(DEVIATION)) {
        Some(Subject::Certificate)
    } else if reading && has(text, FIT) {
        // s is that of the residuals, or within groups, of which u is no simple part.
        Some(Subject::Standard)
    } else if reading && (limited.is_none() || limited >= first(DEVIATION)) {
        Some(match are_limits(e, text) {
            true => Subject::Limits,
            false => Subject::Readings,
        })
    } else if has(text, CYCLING) && !counts_cycles(text) {
        Some(Subject::Cycling)
    } else if limited.is_some() || shape(text).is_some() {
        Some(Subject::Limits)
    } else {
        (has(text, STANDARD) || has(text, AS_STATED)).then_some(Subject::Standard)
    }
}

/// `all 5 readings equal`, `3 次示值全部相同`: a clause that says nothing else of readings.
fn are_alike(text: &str) -> bool {
    let readings = [
        "reading",
        "indication",
        "observation",
        "读数",
        "示值",
        "测得值",
    ];
    text.split([',', ';', '。', '、', '(', ':']).any(|clause| {
        has(clause, &["no scatter"])
            || readings.iter().any(|word| clause.contains(word))
                && has(clause, ALIKE)
                && !has(
                    clause,
                    &[
                        "equal to",
                        "same as",
                        "same condition",
                        "same operator",
                        "same day",
                    ],
                )
    })
}

fn is_range(e: &Evidence<'_>, text: &str) -> bool {
    has(text, RANGE)
        && (has(text, &["极差"]) || count(text, e).is_some())
        && !has(text, &["full range", "measuring range"])
}

/// A step that comes before readings and certificates, and of which not the half is stated.
fn is_step(text: &str, first: &dyn Fn(&[&str]) -> Option<usize>) -> bool {
    const HALF: &[&str] = &[
        "half the",
        "half of",
        "half a step =",
        "half step",
        "1/2",
        "½",
        "半宽",
        "半个",
    ];
    first(STEP).is_some_and(|at| {
        let ends = [';', '(', ','];
        let begin = text[..at].rfind(ends).map_or(0, |end| end + 1);
        let end = text[at..].find(ends).map_or(text.len(), |end| at + end);
        let clause = &text[begin..end];
        first(DEVIATION).is_none_or(|s| at < s)
            && first(CERTIFICATE).is_none_or(|c| at < c)
            && !has(clause, HALF)
    })
}

/// `3 cycles` are repetitions.
fn counts_cycles(text: &str) -> bool {
    let cycles = text.match_indices("cycle").map(|(at, _)| at);
    cycles
        .chain(text.find("次循环"))
        .any(|at| trailing_count(&text[..at]).is_some())
}
