//! Which slips give every claimed figure.
//!
//! The figures of a row say what happened in that row; each is explained by itself. What then is left is between the
//! rows and the statement: no further slip, one, or two, at every place where the printed figures leave room for them.
//!
//! | chapter | holds |
//! |---|---|
//! | `row` | slips that the figures of a row show, and those that they leave room for |
//! | `met` | whether a printed figure is met |
//! | `check` | a calculation held against the claimed figures of the whole |
//! | `explanation` | sets of slips that give every claimed figure |
//! | `combinations` | sets of slips, tried one after the other |
//! | `chance` | how many combinations would match by accident |
//! | `odds` | from which probability of an accident on slips are not named |

mod chance;
mod check;
mod combinations;
mod explanation;
mod met;
mod odds;
mod row;

use crate::calculate::{Calculation, Case, Figures, Freedom, factors};
use crate::claim::Claimed;
use crate::slips::{self, Act};

use chance::Chance;
pub use check::{Broken, Checked, Gap};
use check::{check, is_printed, reported};
use combinations::{Right, Search, bases};
pub use explanation::Explanation;
use explanation::{is_of_another_unit, rank};
use odds::{is_sure, no_accident, no_accident_behind, share_behind};
use row::Options;

/// What was found about a claim.
#[derive(Debug, Clone)]
pub struct Found<'a> {
    /// The claim with its right calculation.
    pub case: Case<'a>,
    /// The figures of the right calculation, as they are reported.
    pub right: Figures,
    /// By how much u_c may differ from the right one because the sheet computed with more digits than it states.
    pub open: f64,
    /// What explains the claim, best first; an empty set for a claim that is right.
    pub explanations: Vec<Explanation>,
    /// Where the claim departs from what was stated, if nothing explains it.
    pub gaps: Vec<Gap>,
    /// Sets of slips that were tried.
    pub tried: usize,
    /// The probability that figures as coarse as these, which have nothing to do with slips, would be matched by one.
    pub accident: f64,
    /// Matches that were not named because they are likely to be chance.
    pub withheld: usize,
    /// Errors in rows that would give the same printed figures, where the claim is right: whether they were made cannot be
    /// told.
    pub untold: Vec<Act>,
}

/// Searches.
pub fn search(claimed: &Claimed) -> Found<'_> {
    let case = Case::of(claimed);
    let by_rule = factors(claimed).into_iter().map(|factor| {
        let mut case = case.clone();
        case.right.factor = factor;
        of_rule(case)
    });
    // Where the sheet states no rule for k, the one that needs the fewest slips is the laboratory's, or leaves the fewest gaps.
    let departs = |found: &Found<'_>| {
        let slips = found.explanations.first().map(|best| best.acts.len());
        (slips.unwrap_or(usize::MAX), found.gaps.len())
    };
    let best = by_rule.min_by_key(departs);
    best.unwrap_or_else(|| of_rule(case))
}

fn of_rule(case: Case<'_>) -> Found<'_> {
    let acts = slips::acts(&case);
    let options: Vec<Options> = (0..case.claimed.rows.len())
        .map(|i| row::options(&case, i, &acts))
        .collect();
    let printed: Vec<Option<f64>> = options.iter().map(|o| o.contribution).collect();
    // The figure of U itself shows its length: nothing is left to ask.
    let (read, open): (Vec<Act>, Vec<Act>) = acts.iter().partition(|act| act.is_read());
    let has_room = |act: &Act| act.row.is_none_or(|row| options[row].leaves_room_for(act));
    let free: Vec<Act> = open.into_iter().filter(has_room).collect();
    let bases = bases(&case, &options, &read);
    let right = Right::of(&case, &printed);
    let mut search = Search::new(&case, right, &printed, free);
    search.search(&bases, read.len());
    let untold = search.untold();
    let Search {
        found: mut explanations,
        chance,
        tried,
        ..
    } = search;
    let broken: Vec<Gap> = (options.iter().enumerate())
        .filter_map(|(i, o)| o.broken.map(|figure| Gap::Row(i, figure)))
        .collect();
    let asked = asked(&explanations, &bases);
    let is_shown = |one: &Explanation| {
        let mut acts = one.acts.iter();
        !one.acts.is_empty() && acts.all(|act| slips::is_shown_by_formula(&case, act))
    };
    // What the workbook itself shows needs no other explanation.
    if explanations.iter().any(is_shown) {
        explanations.retain(is_shown);
    }
    let is_named = broken.is_empty()
        && (explanations.iter().any(is_shown) || is_no_accident(&options, &chance, &acts, asked));
    let withheld = if is_named { 0 } else { explanations.len() };
    if !is_named {
        explanations.clear();
    }
    rank(&case, &mut explanations);
    let gaps = match explanations.is_empty() && broken.is_empty() {
        true => gaps(&case, &bases, &printed, &right),
        false => broken,
    };
    let of_result = slips::of_result(&case);
    let of_result = of_result.filter(|(_, accident)| is_sure(1, no_accident(1, *accident)));
    let of_statement = [of_result.map(|(act, _)| act), slips::of_unit(&case)];
    for act in of_statement.into_iter().flatten() {
        explanations.iter_mut().for_each(|one| one.acts.push(act));
    }
    let unmatched = options.iter().map(|o| 1.0 - o.accident).product::<f64>();
    Found {
        right: right.figures,
        open: right.open,
        untold,
        explanations,
        gaps,
        tried,
        accident: 1.0 - unmatched * (1.0 - chance.accident()),
        withheld,
        case,
    }
}

/// How many slips were looked for between the rows and the statement: each row that departs is one question, what is left
/// another.
fn asked(explanations: &[Explanation], bases: &[(Vec<Act>, Calculation)]) -> usize {
    let slips = explanations.first().map_or(0, |e| e.acts.len());
    let shown = bases.first().map_or(0, |(set, _)| set.len().min(slips));
    match slips - shown {
        2 if is_of_another_unit(explanations, slips) => 1,
        asked => asked,
    }
}

/// Whether matches are no accident: of the figures of each row, and of so many slips between the rows and the statement.
fn is_no_accident(options: &[Options], chance: &Chance, acts: &[Act], asked: usize) -> bool {
    let mut rows = options.iter();
    let of_whole = match chance.is_behind() {
        true => no_accident_behind(asked, share_behind(acts), chance.accident()),
        false => no_accident(asked, chance.accident()),
    };
    rows.all(|o| is_sure(1, no_accident(1, o.accident))) && is_sure(asked, of_whole)
}

/// Where a claim departs that nothing explains.
fn gaps(
    case: &Case<'_>,
    bases: &[(Vec<Act>, Calculation)],
    printed: &[Option<f64>],
    right: &Right,
) -> Vec<Gap> {
    let of_base = |(_, start): &(Vec<Act>, Calculation)| check(case, start, printed).gaps();
    let fewest = bases.iter().map(of_base).min_by_key(Vec::len);
    let mut gaps = fewest.unwrap_or_default();
    // What follows from a wrong u_c is wrong there, and nowhere else.
    if gaps.contains(&Gap::Sum) && follows_from_sum(case) {
        gaps.retain(|gap| *gap != Gap::Expanded);
    }
    if gaps.is_empty() && !is_printed(case, &right.figures, &right.figures, right.open) {
        gaps.push(Gap::Expanded);
    }
    gaps
}

/// Whether U is the product of u_c and k as they are claimed, or of u_c and the k of the rule.
fn follows_from_sum(case: &Case<'_>) -> bool {
    let footer = &case.claimed.footer;
    let k = footer.k.as_ref().map(|k| k.value);
    let k = k.unwrap_or_else(|| case.right.figures(&[], None).k);
    let both = footer.u_c.as_ref().zip(footer.expanded.as_ref());
    both.is_some_and(|(u_c, expanded)| {
        let open = expanded.half_of_expanded() + k * u_c.half_of_digits();
        expanded.is_met_within(k * u_c.value, open)
    })
}

impl Found<'_> {
    /// The right result, where the claimed one is another.
    pub fn other_result(&self) -> Option<f64> {
        slips::other_result(&self.case)
    }

    /// Whether all that is to be said of the claim is that its U has many digits.
    pub fn is_long_alone(&self) -> bool {
        let best = self.explanations.first();
        best.is_some_and(|best| !best.acts.is_empty() && best.acts.iter().all(Act::is_read))
    }

    /// Whether a result is claimed that nothing on the sheet gives: it is taken as it stands.
    pub fn takes_result(&self) -> bool {
        slips::is_open(&self.case)
    }

    /// Whether a number of effective degrees of freedom is claimed that nothing on the sheet gives: it is taken as it stands.
    pub fn takes_freedom(&self) -> bool {
        matches!(self.case.right.freedom, Freedom::Given(nu) if nu.is_finite())
    }

    /// Whether the result would be printed differently if everything in an explanation were corrected.
    pub fn has_effect(&self, best: &Explanation) -> bool {
        let made = reported(&self.case, &best.calculation, &[]);
        let result = best.acts.iter().any(Act::changes_statement);
        result || !is_printed(&self.case, &self.right, &made, self.open)
    }
}
