//! Sets of slips, tried one after the other.

use crate::calculate::{Calculation, Case, Figures};
use crate::slips::{self, Act, Change, Reporting, Weight};

use super::chance::Chance;
use super::check::{Checked, check, is_printed, reported};
use super::explanation::Explanation;
use super::row::{Options, is_copy};

/// More places than this are tried one at a time: pairs would take seconds, and match anything.
const MOST_FOR_PAIRS: usize = 700;

/// Rows that are computed for pairs of slips, at most this many: a second or two. Of a budget of so many rows that this is not
/// enough, each slip is tried alone.
const MOST_ROWS_FOR_PAIRS: usize = 1 << 24;

/// Choices of slips that explain the rows, at most this many.
const MOST_BASES: usize = 24;

/// Sets of slips that the rows show, each with those that are `read` off the statement, and the calculation with them.
pub(super) fn bases(
    case: &Case<'_>,
    options: &[Options],
    read: &[Act],
) -> Vec<(Vec<Act>, Calculation)> {
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
pub(super) struct Right {
    pub(super) figures: Figures,
    pub(super) open: f64,
}

impl Right {
    pub(super) fn of(case: &Case<'_>, printed: &[Option<f64>]) -> Right {
        Right {
            figures: reported(case, &case.right, printed),
            open: check(case, &case.right, printed).open,
        }
    }
}

/// A search among the slips for which the rows leave room.
pub(super) struct Search<'s, 'a> {
    pub(super) case: &'s Case<'a>,
    pub(super) right: Right,
    /// The contributions that the rows print.
    pub(super) printed: &'s [Option<f64>],
    pub(super) free: Vec<Act>,
    pub(super) chance: Chance,
    pub(super) tried: usize,
    pub(super) found: Vec<Explanation>,
}

impl<'s, 'a> Search<'s, 'a> {
    pub(super) fn new(
        case: &'s Case<'a>,
        right: Right,
        printed: &'s [Option<f64>],
        free: Vec<Act>,
    ) -> Self {
        Search {
            case,
            right,
            printed,
            free,
            chance: Chance::default(),
            tried: 0,
            found: Vec::new(),
        }
    }

    /// Tries every set that the rows show by itself, then with one further slip, then with two: as many as the first match
    /// needs. `read` slips are in every set.
    pub(super) fn search(&mut self, bases: &[(Vec<Act>, Calculation)], read: usize) {
        let most = if self.allows_pairs() { 2 } else { 1 };
        let of_rounding = |act: &Act| matches!(act.change, Change::Report(Reporting::Down));
        let fewest = bases.first().map_or(0, |(set, _)| set.len());
        for extra in 0..=most {
            let is_found = !self.found.is_empty();
            let free = self.free.iter().copied();
            // What a row shows is asked beside a rounding that gives the same.
            let is_asked = |act: &Act| of_rounding(act) || is_copy(self.case, act);
            let free: Vec<Act> = free.filter(|act| !is_found || is_asked(act)).collect();
            for (set, start) in bases {
                // Slips come alone and in pairs; what the rows show is beyond doubt, whatever its number.
                if extra < 2 || set.len() == read {
                    self.with(set, start, &free, extra);
                }
            }
            // A claim that follows from rounded figures alone has one slip, as one that was rounded down.
            let is_fewest = |one: &Explanation| one.acts.len() <= fewest + extra;
            if self.found.iter().any(is_fewest) {
                break;
            }
        }
    }

    /// Whether pairs of slips take no more than a second or two.
    fn allows_pairs(&self) -> bool {
        let places = self.free.len();
        let rows = places * places / 2 * self.case.claimed.rows.len();
        places <= MOST_FOR_PAIRS && rows <= MOST_ROWS_FOR_PAIRS
    }

    /// Tries a set with this many further slips of those that are free.
    fn with(&mut self, set: &[Act], start: &Calculation, free: &[Act], extra: usize) {
        let goes = |act: &&Act| set.iter().all(|other| act.goes_with(other));
        let free: Vec<Act> = free.iter().filter(goes).copied().collect();
        match extra {
            0 => self.attempt(set, start, &[]),
            1 => free
                .iter()
                .for_each(|act| self.attempt(set, start, &[*act])),
            _ => {
                for (i, a) in free.iter().enumerate() {
                    for b in free[i + 1..].iter().filter(|b| a.goes_with(b)) {
                        self.attempt(set, start, &[*a, *b]);
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
        let made = match acts.is_empty() {
            true => self.right.figures,
            false => reported(self.case, &calculation, &[]),
        };
        // Another k gives no U that the sum without rounding is far from.
        let is_of_factor = acts.iter().all(Act::changes_factor);
        if is_of_factor && !self.is_printed(&made) {
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

    /// Errors in rows that give the same printed figures as the right calculation, where the claim is right.
    pub(super) fn untold(&self) -> Vec<Act> {
        if !self.found.iter().any(|one| one.acts.is_empty()) {
            return Vec::new();
        }
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
        let checked = check(self.case, &calculation, &printed);
        (calculation, checked)
    }
}
