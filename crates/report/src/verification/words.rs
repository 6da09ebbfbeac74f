//! Headings, counts and verdicts in words.

use crate::language::Language;
use crate::phrase::{plural, third_person};
use gumption_fault::say;
use gumption_verify::{Example, Verdict, Verification};

/// The heading of an example, which the table of contents refers to.
pub(super) fn heading(number: usize, l: Language) -> String {
    say!("Example {number}").in_language(l)
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
        return say!("{word}: no figures").in_language(l);
    }
    let all = example.figures().count();
    let gating = example.figures().filter(|(row, c)| row.gates(c)).count();
    let differing = example
        .figures()
        .filter(|(row, c)| row.gates(c) && !c.agrees())
        .count();
    let mut parts = vec![say!("{gating} figure{}", plural(gating)).in_language(l)];
    if differing > 0 {
        parts.push(say!("{differing} of them differ{}", third_person(differing)).in_language(l));
    }
    if all > gating {
        parts.push(say!("{} more not gating", all - gating).in_language(l));
    }
    l.with_head(word, &parts.join(l.comma()))
}

/// How many figures, then exactly `N passed, M failed` in English.
pub(super) fn closing(verification: &Verification, l: Language) -> Vec<String> {
    let counts = verification.counts();
    let mut lines = Vec::new();
    if counts.not_gating > 0 {
        let n = counts.not_gating;
        lines.push(say!("{n} example{} shown only: not gating", plural(n)).in_language(l));
    }
    let n = counts.figures;
    let mut figures = say!("{n} figure{} compared", plural(n)).in_language(l);
    if counts.differing > 0 {
        let n = counts.differing;
        figures += &say!(", {n} of them differ{}", third_person(n)).in_language(l);
    }
    if counts.figures_not_gating > 0 {
        let n = counts.figures_not_gating;
        figures += &say!(", {n} more shown and not gating").in_language(l);
    }
    lines.push(figures);
    lines.push(tally(verification, l));
    lines
}

/// `N passed, M failed`.
pub(super) fn tally(verification: &Verification, l: Language) -> String {
    let counts = verification.counts();
    let (passed, failed) = (counts.passed, counts.failed);
    say!("{passed} passed, {failed} failed").in_language(l)
}
