//! Headings, counts and verdicts in words.

use crate::language::Language;
use gumption_verify::{Example, Verdict, Verification};

/// The heading of an example, which the table of contents refers to.
pub(super) fn heading(number: usize, l: Language) -> String {
    l.pick(format!("Example {number}"), format!("示例 {number}"))
}

/// The verdict of an example.
pub(super) fn verdict(verdict: Verdict, l: Language) -> &'static str {
    match verdict {
        Verdict::Passed => l.pick("passed", "通过"),
        Verdict::Failed => l.pick("FAILED", "未通过"),
        Verdict::NotGating => l.pick("shown, not gating", "仅列出，不作判据"),
    }
}

/// The verdict with the number of figures behind it.
pub(super) fn verdict_with_counts(example: &Example, l: Language) -> String {
    let word = verdict(example.verdict(), l);
    if example.rows.is_err() {
        return l.pick(
            format!("{word}: no figures"),
            format!("{word}：没有计算结果"),
        );
    }
    let all = example.figures().count();
    let gating = example.figures().filter(|(row, c)| row.gates(c)).count();
    let differing = example
        .figures()
        .filter(|(row, c)| row.gates(c) && !c.agrees())
        .count();
    let mut parts = vec![l.pick(
        format!("{gating} figure{}", plural(gating)),
        format!("{gating} 个数值"),
    )];
    if differing > 0 {
        parts.push(l.pick(
            format!("{differing} of them differ{}", third_person(differing)),
            format!("其中 {differing} 个不一致"),
        ));
    }
    if all > gating {
        parts.push(l.pick(
            format!("{} more not gating", all - gating),
            format!("另有 {} 个不作判据", all - gating),
        ));
    }
    match l {
        Language::English => format!("{word}: {}", parts.join(", ")),
        Language::Chinese => format!("{word}：{}", parts.join("，")),
    }
}

/// How many figures, then exactly `N passed, M failed` in English.
pub(super) fn closing(verification: &Verification, l: Language) -> Vec<String> {
    let counts = verification.counts();
    let mut lines = Vec::new();
    if counts.not_gating > 0 {
        let n = counts.not_gating;
        lines.push(l.pick(
            format!("{n} example{} shown only: not gating", plural(n)),
            format!("另有 {n} 个示例仅列出，不作判据"),
        ));
    }
    let n = counts.figures;
    let mut figures = l.pick(
        format!("{n} figure{} compared", plural(n)),
        format!("比较了 {n} 个数值"),
    );
    if counts.differing > 0 {
        let n = counts.differing;
        figures += &l.pick(
            format!(", {n} of them differ{}", third_person(n)),
            format!("，其中 {n} 个不一致"),
        );
    }
    if counts.figures_not_gating > 0 {
        let n = counts.figures_not_gating;
        figures += &l.pick(
            format!(", {n} more shown and not gating"),
            format!("，另有 {n} 个仅列出、不作判据"),
        );
    }
    lines.push(figures);
    lines.push(tally(verification, l));
    lines
}

/// `N passed, M failed`.
pub(super) fn tally(verification: &Verification, l: Language) -> String {
    let counts = verification.counts();
    let (passed, failed) = (counts.passed, counts.failed);
    l.pick(
        format!("{passed} passed, {failed} failed"),
        format!("{passed} 个通过，{failed} 个未通过"),
    )
}

fn plural(n: usize) -> &'static str {
    if n == 1 { "" } else { "s" }
}

fn third_person(n: usize) -> &'static str {
    if n == 1 { "s" } else { "" }
}
