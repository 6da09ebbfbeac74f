//! The machine form of an audit, with the neutral answer form in it.

use gumption_audit::calculate::Figures;
use gumption_audit::{Audit, Verdict};
use gumption_format::machine::{Machine, Number, record};

use super::words;
use crate::language::Language;

record! {
    /// The audit of a file.
    AuditJson {
        /// File.
        file: String,
        /// `sound`, `slips`, `unexplained`, or `not recomputed`: the worst of its budgets.
        verdict: &'static str,
        /// Sets of slips that give every claimed figure, best first; `@` and the row where a slip sits in a row.
        candidates: Vec<Vec<String>>,
        /// Combined standard uncertainty that the audit holds right, in the unit of the result.
        u_c: Number,
        /// Expanded uncertainty that the audit holds right, not rounded.
        #[serde(rename = "U")]
        expanded: Number,
        /// Every budget of the file.
        budgets: Vec<BudgetJson>,
    }

    /// One budget.
    BudgetJson {
        /// Title.
        title: String,
        /// `sound`, `slips`, `unexplained` or `not recomputed`.
        verdict: &'static str,
        /// Whether the result would be printed differently.
        has_effect: bool,
        /// Sets of slips, as above.
        candidates: Vec<Vec<String>>,
        /// What the verdict says in words.
        sentences: Vec<String>,
        /// Unit of the result, as written.
        unit: String,
        /// Combined standard uncertainty that is right.
        u_c: Number,
        /// Effective degrees of freedom that are right.
        nu_eff: Number,
        /// Coverage factor that is right.
        k: Number,
        /// Expanded uncertainty that is right.
        #[serde(rename = "U")]
        expanded: Number,
        /// Errors in rows of a sound claim that would give the same printed figures, as in `candidates`.
        untold: Vec<String>,
        /// Where the claim departs, if nothing explains it.
        gaps: Vec<String>,
        /// Combinations that were tried.
        tried: usize,
        /// The probability that figures as coarse as these, which have nothing to do with slips, would be matched.
        accident: Number,
        /// What is against a rule.
        findings: Vec<FindingJson>,
        /// Rows as they were understood.
        rows: Vec<RowJson>,
        /// Cells as they were understood.
        understood: Vec<CellJson>,
        /// Lines that were not used.
        unplaced: Vec<CellJson>,
    }

    /// Something that is against a rule.
    FindingJson {
        /// Number of the rule.
        rule: usize,
        /// Its name.
        name: &'static str,
        /// `error`, `warning` or `information` of what a slip explains; `question` or `note` of what is seen by looking.
        weight: &'static str,
        /// The row, where it is about one.
        row: Option<String>,
        /// The numbers.
        numbers: String,
        /// U if this alone were corrected, where that is known.
        corrected: Option<Number>,
    }

    /// One row.
    RowJson {
        /// Symbol.
        symbol: String,
        /// Name or source.
        name: String,
        /// What is known of it, in words.
        stated: String,
        /// Standard uncertainty that is right.
        u: Number,
        /// Sensitivity coefficient that is right.
        c: Number,
        /// Contribution that is right.
        contribution: Number,
        /// Degrees of freedom that are right.
        dof: Number,
        /// Whether it is to be counted.
        counted: bool,
    }

    /// One cell.
    CellJson {
        /// Name of the cell, as in a spreadsheet.
        cell: String,
        /// What stands there.
        text: String,
        /// As what it was taken; empty for nothing.
        role: &'static str,
    }
}

impl Machine for AuditJson {
    const KIND: &'static str = "audit";
    const VERSION: u32 = 1;
    const SEVERAL: bool = true;
}

impl AuditJson {
    pub(super) fn of(file: &str, audits: &[Audit<'_>]) -> AuditJson {
        // A claim that cannot be recomputed is no budget beside one that can.
        let judged = audits
            .iter()
            .filter(|audit| audit.verdict != Verdict::NotRecomputed);
        let worst = judged
            .max_by_key(|audit| audit.verdict)
            .or_else(|| audits.first());
        AuditJson {
            file: file.rsplit(['/', '\\']).next().unwrap_or(file).to_string(),
            verdict: worst.map_or("not recomputed", |audit| verdict(audit.verdict)),
            candidates: worst.map(candidates).unwrap_or_default(),
            u_c: right(worst, |right| right.u_c),
            expanded: right(worst, |right| right.expanded),
            budgets: audits.iter().map(budget).collect(),
        }
    }
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Sound => "sound",
        Verdict::WithEffect | Verdict::WithoutEffect => "slips",
        Verdict::Unexplained => "unexplained",
        Verdict::NotRecomputed => "not recomputed",
    }
}

/// A figure that is right, where it could be computed.
fn right(audit: Option<&Audit<'_>>, figure: fn(&Figures) -> f64) -> Number {
    let right = audit.and_then(Audit::recomputed);
    Number(right.as_ref().map_or(f64::NAN, figure))
}

fn candidates(audit: &Audit<'_>) -> Vec<Vec<String>> {
    let found = &audit.found;
    let sets = found.explanations.iter().filter(|e| !e.acts.is_empty());
    sets.map(|e| e.acts.iter().map(|act| act.id(&found.case)).collect())
        .collect()
}

fn budget(audit: &Audit<'_>) -> BudgetJson {
    let found = &audit.found;
    let claimed = found.case.claimed;
    let cell = |at: gumption_audit::printed::Place, text: &str, role| CellJson {
        cell: at.a1(),
        text: text.to_string(),
        role,
    };
    BudgetJson {
        title: claimed.title.clone(),
        verdict: verdict(audit.verdict),
        has_effect: audit.verdict == Verdict::WithEffect,
        candidates: candidates(audit),
        sentences: words::verdict(audit, Language::English),
        unit: claimed.unit.clone(),
        u_c: right(Some(audit), |right| right.u_c),
        nu_eff: right(Some(audit), |right| right.nu_eff),
        k: Number(found.right.k),
        expanded: right(Some(audit), |right| right.expanded),
        untold: found.untold.iter().map(|act| act.id(&found.case)).collect(),
        gaps: found
            .gaps
            .iter()
            .map(|gap| words::gap(audit, gap, Language::English))
            .collect(),
        tried: found.tried,
        accident: Number(found.accident),
        findings: gumption_audit::rules::findings(found)
            .iter()
            .map(|finding| FindingJson {
                rule: usize::from(finding.rule),
                name: finding.rule().id,
                weight: finding.weight(),
                row: finding.row.map(|row| claimed.rows[row].label().to_string()),
                numbers: finding.numbers.clone(),
                corrected: finding.corrected.map(Number),
            })
            .collect(),
        rows: claimed
            .rows
            .iter()
            .zip(&found.case.right.lines)
            .map(|(row, line)| RowJson {
                symbol: row.symbol.clone(),
                name: row.name.clone(),
                stated: words::stated(row, Language::English),
                u: Number(line.u),
                c: Number(line.c),
                contribution: Number(line.contribution()),
                dof: Number(line.dof),
                counted: line.counted,
            })
            .collect(),
        understood: claimed
            .understood
            .iter()
            .map(|u| cell(u.at, &u.text, u.role))
            .collect(),
        unplaced: claimed
            .unplaced
            .iter()
            .map(|u| cell(u.at, &u.text, ""))
            .collect(),
    }
}
