//! Rules of a checker of budgets: what is against them, with its numbers, its effect on U, its clause, and why it may be
//! right after all. A finding is no verdict: slips explain claimed figures, findings tell what a reviewer would ask.
//!
//! | chapter | holds |
//! |---|---|
//! | `registry` | the rules, one entry each |
//! | `records` | what records on the sheet show |
//! | `rows` | what a row shows |
//! | `whole` | what the figures of the whole show |
//! | `words` | what the words of a sheet show |

mod records;
mod registry;
mod rows;
mod whole;
mod words;

#[cfg(test)]
mod tests;

use gumption_core::quantity::{Decimal, Rounding};
use gumption_fault::{Said, say};

use crate::calculate::{Calculation, Case, Line};
use crate::claim::Claimed;
use crate::search::Found;
use crate::slips::{Change, Weight};

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
}

impl std::fmt::Debug for How {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            How::Slip => "Slip",
            How::Look(_) => "Look",
        })
    }
}

impl Rule {
    /// The word for how much it weighs: that of its slips, where any has figures; else it asks.
    pub fn said(&self) -> Said {
        let number = self.number.to_string();
        let mut slips = crate::slips::slips();
        match slips.any(|slip| slip.rule.split('/').any(|rule| rule == number)) {
            true => self.weight.said(),
            false => question(self.weight),
        }
    }
}

/// What a finding bears on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bearing {
    /// The claimed figures: a slip that gives them.
    Figures,
    /// What a reviewer asks, while the claimed figures may follow from what is stated all the same.
    Question,
}

/// Something that is against a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Number of the rule.
    pub rule: u8,
    /// What it bears on.
    pub bearing: Bearing,
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

    /// The word for how much it weighs. A question is no error: the sheet may be sound, and still owe an answer.
    pub fn said(&self) -> Said {
        match self.bearing {
            Bearing::Figures => self.rule().weight.said(),
            Bearing::Question => question(self.rule().weight),
        }
    }

    /// The same as a name for machines.
    pub fn weight(&self) -> &'static str {
        match (self.bearing, self.rule().weight) {
            (Bearing::Figures, weight) => weight.name(),
            (Bearing::Question, Weight::Information) => "note",
            (Bearing::Question, _) => "question",
        }
    }
}

fn question(weight: Weight) -> Said {
    match weight {
        Weight::Information => say!("note"),
        Weight::Error | Weight::Warning => say!("question"),
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
            bearing: Bearing::Question,
            row: hit.row,
            numbers: hit.numbers,
            corrected: hit.corrected,
        });
        // What is known of a row needs not be said of the whole again.
        let known = |finding: &Finding| {
            all.iter().any(|one| {
                one.rule == finding.rule && (one.row == finding.row || finding.row.is_none())
            })
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
        calculation
    };
    let of_act = |(i, act): (usize, &crate::slips::Act)| -> Vec<Finding> {
        let numbers = act
            .slip
            .rule
            .split('/')
            .filter_map(|number| number.parse().ok());
        let other = without(i);
        let claimed = found.case.claimed;
        let y = claimed.footer.y.as_ref();
        let numbers_of_act = || match (act.change, y) {
            (Change::Result(Some(right)), Some(y)) => format!("y = {} ≠ {right:.9}", y.as_read()),
            (Change::Result(None), Some(y)) => format!("y = {}", y.as_read()),
            _ => differing(&best.calculation, &other, act.row, claimed),
        };
        let finding = |rule: u8| Finding {
            rule,
            bearing: Bearing::Figures,
            row: act.row,
            numbers: numbers_of_act(),
            corrected: Some(other.figures(&[], cmc).expanded),
        };
        numbers.map(finding).collect()
    };
    best.acts.iter().enumerate().flat_map(of_act).collect()
}

/// The first figure that a slip changes, as the laboratory has it and as it would be without the slip.
fn differing(
    with: &Calculation,
    without: &Calculation,
    row: Option<usize>,
    claimed: &Claimed,
) -> String {
    let counted = |line: &Line| {
        if line.counted {
            line.contribution().abs()
        } else {
            0.0
        }
    };
    let line = row.and_then(|row| with.lines.get(row).zip(without.lines.get(row)));
    let of_row = line.map(|(a, b)| {
        [
            ("u", a.u, b.u),
            ("c", a.c, b.c),
            ("u_i(y)", counted(a), counted(b)),
            ("ν", a.dof, b.dof),
        ]
    });
    let (a, b) = (with.figures(&[], None), without.figures(&[], None));
    let of_whole = [
        ("u_c", a.u_c, b.u_c),
        ("ν_eff", a.nu_eff, b.nu_eff),
        ("k", a.k, b.k),
        ("U", a.expanded, b.expanded),
    ];
    let mut all = of_row.into_iter().flatten().chain(of_whole);
    let differs = |a: f64, b: f64| a != b && (a - b).abs() > 1e-9 * b.abs();
    match all.find(|(_, a, b)| differs(*a, *b)) {
        Some((name, a, b)) => format!("{name} = {} ≠ {}", shown(a), shown(b)),
        // Only the printing differs.
        None => match &claimed.footer.expanded {
            Some(expanded) => format!("U = {}, k·u_c = {}", expanded.as_read(), shown(b.expanded)),
            None => String::new(),
        },
    }
}

/// A figure with four digits at most.
fn shown(x: f64) -> String {
    if x.is_infinite() {
        return "∞".into();
    }
    let rounded = Decimal::from_f64(x).round_to_significant(4, Rounding::HalfEven);
    // Without the zeros that only fill four digits.
    Decimal::from_f64(rounded.to_f64()).print_plain()
}
