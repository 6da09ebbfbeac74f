//! Which slips give every claimed figure.
//!
//! The figures of a row say what happened in that row; each is explained by itself. What then is left is between the
//! rows and the statement: no further slip, one, or two, at every place where the printed figures leave room for them.
//!
//! | chapter | holds |
//! |---|---|
//! | `row` | slips that the figures of a row show, and those that they leave room for |
//! | `check` | a calculation held against the claimed figures of the whole |
//! | `chance` | how many combinations would match by accident |

mod chance;
mod check;
mod row;

use crate::calculate::{Calculation, Case, Figures, Freedom, factors};
use crate::claim::Claimed;
use crate::slips::{self, Act, Change, Reporting, Weight};

use chance::Chance;
pub use check::{Broken, Checked, Gap};
use check::{is_printed, reported};
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

/// A set of slips that gives every claimed figure.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The slips.
    pub acts: Vec<Act>,
    /// The calculation with them.
    pub calculation: Calculation,
}

/// How often, one against the other, sheets are assumed to have one slip, two, and something that is no slip of the
/// grammar: of twenty, eleven, four and two.
const ODDS: [f64; 3] = [1.0, 11.0, 4.0];
const ODDS_OF_NO_NAME: f64 = 2.0;

/// In a report, no more names than one in twenty are expected to be wrong.
const WRONG: f64 = 0.05;

/// Whether slips may be named that are no accident with this probability: two that are one are two wrong names.
fn is_sure(slips: usize, no_accident: f64) -> bool {
    slips as f64 * (1.0 - no_accident) <= WRONG
}

/// The probability that a set of `slips` which matches is no accident, where a claim that has nothing to do with slips is
/// matched with the probability `accident`.
fn no_accident(slips: usize, accident: f64) -> f64 {
    let odds = ODDS[slips.min(2)];
    odds / (odds + ODDS_OF_NO_NAME * accident)
}

/// The same where u_c follows and U does not, of which this `share` of the kinds of slips is capable. Something without a
/// name sits there as often as one slip does; that both of two do is rarer by the share.
fn no_accident_behind(slips: usize, share: f64, accident: f64) -> f64 {
    let others = slips.saturating_sub(1) as f64;
    no_accident(slips, accident / libm::pow(share, others))
}

/// How many of the kinds of slips act behind u_c.
fn share_behind(acts: &[Act]) -> f64 {
    let kinds = |of: &dyn Fn(&Act) -> bool| {
        let mut ids: Vec<&str> = acts
            .iter()
            .filter(|act| of(act))
            .map(|act| act.slip.id)
            .collect();
        ids.sort_unstable();
        ids.dedup();
        ids.len() as f64
    };
    kinds(&Act::acts_behind_sum) / kinds(&|_| true).max(1.0)
}

/// Searches.
pub fn search(claimed: &Claimed) -> Found<'_> {
    let case = Case::of(claimed);
    let by_rule = factors(claimed).into_iter().map(|factor| {
        let mut case = case.clone();
        case.right.factor = factor;
        of_rule(case)
    });
    // Where the sheet states no rule for k, the one that needs the fewest slips is the laboratory's.
    let slips = |found: &Found<'_>| {
        found
            .explanations
            .first()
            .map_or(usize::MAX, |e| e.acts.len())
    };
    let best = by_rule.min_by_key(slips);
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
    let bases = bases(&case, &options, &read);
    let free: Vec<Act> = open
        .into_iter()
        .filter(|act| act.row.is_none_or(|row| options[row].leaves_room_for(act)))
        .collect();
    let right = reported(&case, &case.right, &printed);
    let open = check::check(&case, &case.right, &printed).open;
    let mut search = Search {
        case: &case,
        right: Right {
            figures: right,
            open,
        },
        printed: &printed,
        free: &free,
        chance: Chance::default(),
        tried: 0,
        found: Vec::new(),
    };
    let broken: Vec<Gap> = options
        .iter()
        .enumerate()
        .filter_map(|(i, o)| o.broken.map(|figure| Gap::Row(i, figure)))
        .collect();
    let most = if free.len() > MOST_FOR_PAIRS { 1 } else { 2 };
    let of_rounding = |act: &&Act| matches!(act.change, Change::Report(Reporting::Down));
    let of_rounding: Vec<Act> = free.iter().filter(of_rounding).copied().collect();
    for extra in 0..=most {
        if !search.found.is_empty() {
            search.free = &of_rounding;
        }
        for (set, start) in &bases {
            // Slips come alone and in pairs; what the rows show is beyond doubt, whatever its number.
            if extra < 2 || set.len() == read.len() {
                search.with(set, start, extra);
            }
        }
        // A claim that follows from rounded figures alone has one slip, as one that was rounded down.
        let fewest = bases.first().map_or(0, |(set, _)| set.len()) + extra;
        if search.found.iter().any(|one| one.acts.len() <= fewest) {
            break;
        }
    }
    let tried = search.tried;
    let is_sound = search.found.iter().any(|e| e.acts.is_empty());
    let untold = if is_sound {
        search.untold()
    } else {
        Vec::new()
    };
    let unmatched = options.iter().map(|o| 1.0 - o.accident).product::<f64>();
    let of_whole = search.chance.accident();
    let accident = 1.0 - unmatched * (1.0 - of_whole);
    let mut explanations = search.found;
    let slips = explanations.first().map_or(0, |e| e.acts.len());
    // Each row that departs is one question, what is left between the rows and the statement another.
    let shown = bases.first().map_or(0, |(set, _)| set.len().min(slips));
    let rows_are_sure = options
        .iter()
        .all(|o| is_sure(1, no_accident(1, o.accident)));
    let asked = match slips - shown {
        2 if is_of_another_unit(&explanations, slips) => 1,
        asked => asked,
    };
    let of_whole = if search.chance.is_behind() {
        no_accident_behind(asked, share_behind(&acts), of_whole)
    } else {
        no_accident(asked, of_whole)
    };
    let named = broken.is_empty() && rows_are_sure && is_sure(asked, of_whole);
    let withheld = if named { 0 } else { explanations.len() };
    if !named {
        explanations.clear();
    }
    rank(&case, &mut explanations);
    let mut gaps = broken;
    if explanations.is_empty() && gaps.is_empty() {
        gaps = bases
            .iter()
            .map(|(_, start)| check::check(&case, start, &printed).gaps())
            .min_by_key(Vec::len)
            .unwrap_or_default();
        if gaps.is_empty() && !is_printed(&case, &right, &right, open) {
            gaps.push(Gap::Expanded);
        }
    }
    let of_result = slips::of_result(&case);
    let of_result = of_result.filter(|(_, accident)| is_sure(1, no_accident(1, *accident)));
    let of_statement = [of_result.map(|(act, _)| act), slips::of_unit(&case)];
    for act in of_statement.into_iter().flatten() {
        explanations.iter_mut().for_each(|one| one.acts.push(act));
    }
    Found {
        right,
        open,
        untold,
        explanations,
        gaps,
        tried,
        accident,
        withheld,
        case,
    }
}

/// Whether no set of so few slips gives U without a unit that its figure does not belong to: a figure that has nothing to
/// do with slips is known to a factor of two, so that one which is off by a power of ten is no accident. What is left to
/// ask is the other slip.
fn is_of_another_unit(explanations: &[Explanation], slips: usize) -> bool {
    let is_far = |act: &Act| match act.change {
        Change::Report(Reporting::Scale(factor)) => libm::log(factor).abs() > 2.0 * chance::WIDEST,
        _ => false,
    };
    let mut fewest = explanations.iter().filter(|one| one.acts.len() == slips);
    fewest.all(|one| one.acts.iter().any(is_far))
}

/// More places than this are tried one at a time: pairs would take seconds, and match anything.
const MOST_FOR_PAIRS: usize = 700;

/// Choices of slips that explain the rows, at most this many.
const MOST_BASES: usize = 24;

/// Sets of slips that the rows show, each with those that are `read` off the statement, and the calculation with them.
fn bases(case: &Case<'_>, options: &[Options], read: &[Act]) -> Vec<(Vec<Act>, Calculation)> {
    let mut bases = vec![read.to_vec()];
    for one in options
        .iter()
        .filter(|o| !o.sets.is_empty() && !o.sets[0].is_empty())
    {
        let choices = one
            .sets
            .len()
            .min(MOST_BASES / bases.len().min(MOST_BASES))
            .max(1);
        bases = bases
            .iter()
            .flat_map(|base: &Vec<Act>| {
                one.sets[..choices]
                    .iter()
                    .map(move |set| [base.as_slice(), set].concat())
            })
            .collect();
    }
    bases
        .into_iter()
        .map(|set| {
            let mut start = case.right.clone();
            set.iter().for_each(|act| act.apply(&mut start));
            for (line, option) in start.lines.iter_mut().zip(options) {
                // What a broken row passes on is what it prints.
                if let (Some(_), Some(contribution)) = (option.broken, option.contribution) {
                    let sign = line.c.signum();
                    (line.u, line.c, line.to_y) = (contribution.abs(), sign, 1.0);
                }
            }
            (set, start)
        })
        .collect()
}

/// What is right, and by how much u_c is open.
#[derive(Clone, Copy)]
struct Right {
    figures: Figures,
    open: f64,
}

struct Search<'s, 'a> {
    case: &'s Case<'a>,
    right: Right,
    printed: &'s [Option<f64>],
    free: &'s [Act],
    chance: Chance,
    tried: usize,
    found: Vec<Explanation>,
}

impl Search<'_, '_> {
    /// Tries a set with this many further slips.
    fn with(&mut self, set: &[Act], start: &Calculation, extra: usize) {
        match extra {
            0 => self.attempt(set, start, &[]),
            1 => {
                for act in self.free {
                    if set.iter().all(|other| act.goes_with(other)) {
                        self.attempt(set, start, &[*act]);
                    }
                }
            }
            _ => {
                for (i, a) in self.free.iter().enumerate() {
                    for b in &self.free[i + 1..] {
                        if a.goes_with(b)
                            && [a, b]
                                .iter()
                                .all(|act| set.iter().all(|other| act.goes_with(other)))
                        {
                            self.attempt(set, start, &[*a, *b]);
                        }
                    }
                }
            }
        }
    }

    fn attempt(&mut self, set: &[Act], start: &Calculation, extra: &[Act]) {
        self.tried += 1;
        let (mut calculation, checked) = self.checked(start, extra);
        self.chance
            .count(self.case, &calculation, &checked, !extra.is_empty());
        if !checked.meets_all() {
            return;
        }
        let mut acts = [set, extra].concat();
        if acts.is_empty() && !self.is_printed(&self.right.figures) {
            // What follows from rounded figures alone, and would be printed differently without, is no sound claim.
            let Some(act) = self.rounded(&checked) else {
                return;
            };
            act.apply(&mut calculation);
            acts.push(act);
        }
        self.found.push(Explanation { acts, calculation });
    }

    fn is_printed(&self, made: &Figures) -> bool {
        is_printed(self.case, made, made, self.right.open)
    }

    /// The slip of a claim that follows from figures as they are printed: contributions, or u_c itself.
    fn rounded(&self, checked: &Checked) -> Option<Act> {
        let printed = checked.of_printed.map(|figures| figures.u_c);
        let claimed = self.case.claimed.footer.u_c.as_ref().map(|u_c| u_c.value);
        let acts = [printed, claimed]
            .into_iter()
            .flatten()
            .filter_map(slips::rounded);
        let mut acts = acts.filter(|act| {
            let mut calculation = self.case.right.clone();
            act.apply(&mut calculation);
            self.is_printed(&reported(self.case, &calculation, &[]))
        });
        acts.next()
    }

    /// Errors in rows that give the same printed figures as the right calculation.
    fn untold(&self) -> Vec<Act> {
        let errors = self.free.iter().filter(|act| {
            let is_error = act.slip.weight == Weight::Error;
            // Nothing is lost of what is nothing.
            is_error
                && act
                    .row
                    .is_some_and(|row| self.case.right.lines[row].contribution() != 0.0)
        });
        let is_met = |act: &&Act| self.checked(&self.case.right, &[**act]).1.meets_all();
        errors.filter(is_met).copied().collect()
    }

    /// A calculation with further slips, held against the claim.
    fn checked(&self, start: &Calculation, extra: &[Act]) -> (Calculation, Checked) {
        let mut calculation = start.clone();
        extra.iter().for_each(|act| act.apply(&mut calculation));
        let mut printed = self.printed.to_vec();
        for act in extra.iter().filter(|act| act.changes_contribution()) {
            if let Some(row) = act.row {
                printed[row] = None;
            }
        }
        let checked = check::check(self.case, &calculation, &printed);
        (calculation, checked)
    }
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

/// The most usual first; of several variants of one set the first.
fn rank(case: &Case<'_>, explanations: &mut Vec<Explanation>) {
    explanations.sort_by_key(|e| {
        e.acts
            .iter()
            .map(|act| row::surprise(case, act))
            .sum::<u32>()
    });
    let mut seen: Vec<Vec<String>> = Vec::new();
    explanations.retain(|e| {
        let mut ids: Vec<String> = e.acts.iter().map(|act| act.id(case)).collect();
        ids.sort();
        let new = !seen.contains(&ids);
        seen.push(ids);
        new
    });
}
