//! Rules of a checker of budgets: what is against them, with its numbers, its effect on U, its clause, and why it may be
//! right after all. A finding is no verdict: slips explain claimed figures, findings tell what a reviewer would ask.
//!
//! | chapter | holds |
//! |---|---|
//! | `registry` | the rules, one entry each |
//! | `rows` | what a row shows |
//! | `whole` | what the figures of the whole show |
//! | `words` | what the words of a sheet show |

mod registry;
mod rows;
mod whole;
mod words;

#[cfg(test)]
mod tests;

use crate::calculate::{Calculation, Case};
use crate::claim::Claimed;
use crate::search::Found;
use crate::slips::Weight;

pub use registry::RULES;

/// A rule.
#[derive(Debug, Clone, Copy)]
pub struct Rule {
    /// Its number.
    pub number: u8,
    /// Its name.
    pub id: &'static str,
    /// How much it weighs.
    pub weight: Weight,
    /// What is against it, in English.
    pub en: &'static str,
    /// What is against it, in Chinese.
    pub zh: &'static str,
    /// Where it stands.
    pub clause: &'static str,
    /// Why it may be right after all, in English.
    pub fine_en: &'static str,
    /// Why it may be right after all, in Chinese.
    pub fine_zh: &'static str,
    /// How it is seen.
    how: How,
}

/// How a sheet shows that something is against a rule.
#[derive(Clone, Copy)]
enum How {
    /// By its figures: a slip of this rule explains them.
    Slip,
    /// By looking.
    Look(fn(&Seen<'_>) -> Vec<Hit>),
    /// Not at all: it needs readings, dates or results that no budget holds.
    Unseen,
}

impl std::fmt::Debug for How {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            How::Slip => "Slip",
            How::Look(_) => "Look",
            How::Unseen => "Unseen",
        })
    }
}

impl Rule {
    /// Whether a sheet can show it.
    pub fn is_seen(&self) -> bool {
        !matches!(self.how, How::Unseen)
    }
}

/// Something that is against a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Number of the rule.
    pub rule: u8,
    /// The row, where it is about one.
    pub row: Option<usize>,
    /// The numbers.
    pub numbers: String,
    /// U if this alone were corrected, where that can be computed.
    pub corrected: Option<f64>,
}

impl Finding {
    /// Its rule.
    pub fn rule(&self) -> &'static Rule {
        // Findings are made of rules that exist.
        rule(self.rule).unwrap_or(&RULES[0])
    }
}

/// The rule of a number.
pub fn rule(number: u8) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.number == number)
}

/// What is looked at.
struct Seen<'a> {
    claimed: &'a Claimed,
    case: &'a Case<'a>,
    /// The calculation of the laboratory: with its slips, where they are known.
    laboratory: &'a Calculation,
}

/// What a check returns.
struct Hit {
    row: Option<usize>,
    numbers: String,
    corrected: Option<f64>,
}

impl Hit {
    fn of(row: Option<usize>, numbers: String) -> Hit {
        Hit {
            row,
            numbers,
            corrected: None,
        }
    }
}

/// Everything that is against a rule, by number and row.
pub fn findings(found: &Found<'_>) -> Vec<Finding> {
    let best = found.explanations.first();
    let seen = Seen {
        claimed: found.case.claimed,
        case: &found.case,
        laboratory: best.map_or(&found.case.right, |best| &best.calculation),
    };
    let mut all = of_slips(found);
    for rule in RULES {
        let How::Look(look) = rule.how else { continue };
        let hits = look(&seen).into_iter().map(|hit| Finding {
            rule: rule.number,
            row: hit.row,
            numbers: hit.numbers,
            corrected: hit.corrected,
        });
        let known = |finding: &Finding| {
            all.iter()
                .any(|one| (one.rule, one.row) == (finding.rule, finding.row))
        };
        let new: Vec<Finding> = hits.filter(|finding| !known(finding)).collect();
        all.extend(new);
    }
    all.sort_by_key(|finding| (finding.rule, finding.row));
    all
}

/// Slips of the first explanation, as findings: corrected alone, U is that of the others.
fn of_slips(found: &Found<'_>) -> Vec<Finding> {
    let Some(best) = found.explanations.first() else {
        return Vec::new();
    };
    let cmc = found.case.claimed.cmc.as_ref().map(|cmc| cmc.value);
    let without = |skipped: usize| {
        let mut calculation = found.case.right.clone();
        let others = best.acts.iter().enumerate().filter(|(i, _)| *i != skipped);
        others.for_each(|(_, act)| act.apply(&mut calculation));
        calculation.figures(&[], cmc).expanded
    };
    let of_act = |(i, act): (usize, &crate::slips::Act)| -> Vec<Finding> {
        let numbers = act
            .slip
            .rule
            .split('/')
            .filter_map(|number| number.parse().ok());
        let finding = |rule: u8| Finding {
            rule,
            row: act.row,
            numbers: act.slip.id.to_string(),
            corrected: Some(without(i)),
        };
        numbers.map(finding).collect()
    };
    best.acts.iter().enumerate().flat_map(of_act).collect()
}
