//! What of a diagnosis or a plan is worth a reader's attention: lines that change a result, measurements that decide.

use super::case::Case;
use super::case::Extra;
use super::confirm::Estimated;
use super::evidence::{Cell, Located, Worth};
use super::explanation::Separating;
use super::omitted::Omitted;
use super::parts::Confirmation;
use super::plan::{Outlook, Promise};
use super::run::Diagnosis;

/// What is smaller than this part of a parameter's u does not change it.
const MATTERS: f64 = 0.1;

impl Estimated {
    /// Its value; what its rounding leaves of zero is zero.
    pub fn rounded(&self) -> f64 {
        /// Part of the standard uncertainty.
        const NOTHING: f64 = 1e-9;
        match self.value.abs() < NOTHING * self.u {
            true => 0.0,
            false => self.value,
        }
    }
}

/// Effects that are not in the model and may be there unseen.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen<'d> {
    /// Those that change a result, each with the unknown that it changes most.
    pub dear: Vec<(&'d Omitted, usize)>,
    /// Those that the recording cannot show and of which no size is usual, each with the unknown in which it hides.
    pub hidden: Vec<(&'d Omitted, usize)>,
}

impl<'d> Unseen<'d> {
    fn of(omitted: &'d [Omitted], estimates: &[Estimated]) -> Unseen<'d> {
        let u: Vec<f64> = estimates.iter().map(|estimate| estimate.u).collect();
        let dear = |line: &'d Omitted| {
            let (at, ratio) = line.worst(&u)?;
            (line.shift.is_some() && ratio > MATTERS).then_some((line, at))
        };
        let hidden = |line: &'d Omitted| {
            let gains = line.after.gain.iter().zip(&u);
            let gains = gains.map(|(gain, u)| gain.abs() / u).enumerate();
            let worst = gains.filter(|(_, gain)| gain.is_finite());
            let (at, _) = worst.max_by(|a, b| a.1.total_cmp(&b.1))?;
            (line.is_invisible() && line.shift.is_none()).then_some((line, at))
        };
        Unseen {
            dear: omitted.iter().filter_map(dear).collect(),
            hidden: omitted.iter().filter_map(hidden).collect(),
        }
    }
}

impl Diagnosis {
    /// The unknowns as they are to be used: with the adopted physics in the model, where any was adopted.
    pub fn estimates(&self) -> &[Estimated] {
        let adopted = self.adopted.as_ref();
        adopted.map_or(&self.unknowns, |adopted| &adopted.unknowns)
    }

    /// Places where the mismatch is conspicuous.
    pub fn conspicuous(&self) -> impl Iterator<Item = &(Cell, Located)> {
        /// Probability of as much by chance.
        const RARE: f64 = 0.05;
        self.located.iter().filter(|(_, located)| located.p < RARE)
    }

    /// What may be there unseen.
    pub fn unseen(&self) -> Unseen<'_> {
        Unseen::of(&self.omitted, self.estimates())
    }

    /// For each slot whose choice between explanations matters: its index, and the unknowns that it costs, with the
    /// standard uncertainties.
    pub fn dear_choices(&self) -> Vec<(usize, Vec<(&Estimated, f64)>)> {
        let dear = |costs: &Vec<f64>| {
            let pairs = self.estimates().iter().zip(costs.iter().copied());
            pairs.filter(|(own, u)| *u > MATTERS * own.u).collect()
        };
        let choices = self.choices.iter().map(dear).enumerate();
        choices
            .filter(|(_, costs): &(_, Vec<_>)| !costs.is_empty())
            .collect()
    }

    /// The probability of so bad a prediction of the held-out recording, where it is worse than the noise allows.
    pub fn badly_predicted(&self, case: &Case) -> Option<f64> {
        let p = self.held_out.as_ref()?.best().p?;
        (p < case.settings.alpha).then_some(p)
    }

    /// Whether the first of rivals stands alone all the same: one that looks like it needs more sizes for that.
    pub fn stands_alone(&self, of: &Separating) -> bool {
        self.examination.slots[of.slot].is_alone()
    }
}

/// Whether parts of a recording agree on an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Agreement {
    /// They do.
    Agree,
    /// It is doubtful.
    Doubtful,
    /// They do not.
    Differ,
}

impl Confirmation {
    /// Whether the parts agree, with the probability that they differ as much by chance.
    pub fn agreed(&self) -> Option<(Agreement, f64)> {
        self.agreement.map(|p| (Agreement::of(p), p))
    }

    /// Whether they do not.
    pub(super) fn differs(&self) -> bool {
        matches!(self.agreed(), Some((Agreement::Differ, _)))
    }
}

impl Agreement {
    fn of(p: f64) -> Agreement {
        /// From here on they agree …
        const AGREE: f64 = 0.05;
        /// … and below it they do not.
        const DIFFER: f64 = 0.01;
        match p {
            p if p >= AGREE => Agreement::Agree,
            p if p >= DIFFER => Agreement::Doubtful,
            _ => Agreement::Differ,
        }
    }
}

impl Separating {
    /// Measurements that help to decide, the most useful first.
    pub fn useful(&self) -> impl Iterator<Item = &(Extra, Worth)> {
        /// What decides less often than this is no help.
        const DECIDES: f64 = 0.005;
        let extras = self.extras.iter();
        extras.filter(|(_, worth)| worth.kappa > 1.0 && worth.resolved >= DECIDES)
    }

    /// Rivals, by their places in the list, that no measurement tells apart, two or more in each class.
    pub fn inseparable(&self) -> Vec<Vec<usize>> {
        let mut classes = self.classes.clone();
        classes.sort_unstable();
        classes.dedup();
        let of = |class: usize| {
            let all = 0..self.classes.len();
            all.filter(|at| self.classes[*at] == class).collect()
        };
        let classes = classes.into_iter().map(of);
        classes.filter(|own: &Vec<usize>| own.len() > 1).collect()
    }
}

impl Outlook {
    /// What may be there unseen.
    pub fn unseen(&self) -> Unseen<'_> {
        Unseen::of(&self.omitted, &self.unknowns)
    }

    /// Number of effects that the experiment cannot show.
    pub fn invisible(&self) -> usize {
        let lines = self.omitted.iter();
        lines.filter(|line| line.is_invisible()).count()
    }

    /// The further measurement that helps most, if any helps.
    pub fn best(&self) -> Option<&Promise> {
        let helps = |one: &&Promise| !one.resolved.is_empty() || !one.revealed.is_empty();
        self.extras.first().filter(helps)
    }

    /// The pairs that a measurement tells apart, first those that the fewest measurements do.
    pub fn rarest_first(&self, promise: &Promise) -> Vec<usize> {
        let helpers = |at: &usize| {
            let with = self.extras.iter().filter(|p| p.resolved.contains(at));
            with.count()
        };
        let mut pairs = promise.resolved.clone();
        pairs.sort_by_key(helpers);
        pairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_agree_as_their_probability_says() {
        let said = [0.44, 0.03, 0.0085].map(Agreement::of);
        assert_eq!(
            said,
            [Agreement::Agree, Agreement::Doubtful, Agreement::Differ]
        );
    }
}
