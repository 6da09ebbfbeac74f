//! E_n of each row (ISO/IEC 17043, ISO 13528), against a stated reference or the others of its group, and the rows that stand
//! apart.

use gumption_core::statistics::norm;

use crate::deviation::{Deviation, Devices, Others, SIGNIFICANCE, Weights};
use crate::group::{GroupResult, Members};
use crate::parallel::in_order;
use crate::results::{MeasurandValues, Values};

/// Rows with |E_n| > 1 that are listed by name.
pub const LISTED: usize = 100;

/// A row with |E_n| > 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Apart {
    /// Its number in the table, the first being 1.
    pub row: usize,
    /// The name of its device.
    pub device: String,
    /// Its group.
    pub group: usize,
    /// Its estimate.
    pub estimate: f64,
    /// What it is held against: the reference, or the weighted mean of the other devices of its group.
    pub other: f64,
    /// E_n, with sign.
    pub en: f64,
    /// Probability of such a difference by chance, times the number of all rows that were tested (Bonferroni), at most 1.
    pub probability: f64,
}

impl Apart {
    /// Whether chance does not explain it: only then is a device named.
    pub fn is_named(&self) -> bool {
        self.probability < SIGNIFICANCE
    }
}

/// The rows of a measurand with |E_n| > 1.
#[derive(Debug, Clone, Default)]
pub struct Agreement {
    /// Rows that were tested.
    pub tested: usize,
    /// Those with |E_n| > 1.
    pub beyond: usize,
    /// How many of them chance lets expect.
    pub expected: f64,
    /// Those that chance does not explain.
    pub named: usize,
    /// Those beyond 1, the least probable first; the first of them, where there are very many.
    pub apart: Vec<Apart>,
}

impl Agreement {
    /// Whether agreement is the rule, and lying apart the exception. Rows far from the median are left out of the mean that each is held
    /// against, which means something as long as most of them are near it.
    pub fn is_the_rule(&self) -> bool {
        2 * self.named <= self.tested
    }
}

/// Rows of a group that can be tested.
pub(crate) fn testable(
    measurand: &MeasurandValues,
    members: &Members,
    devices: Option<&Devices>,
) -> usize {
    let own = &measurand.values.expanded;
    let rows = &members.weighed;
    let has_others = match (devices, rows.first()) {
        (Some(devices), Some(first)) => rows.iter().any(|row| devices[*row] != devices[*first]),
        _ => rows.len() > 1,
    };
    let is_known = |row: &&usize| match &measurand.reference {
        Some((_, reference)) => own[**row].is_finite() && reference.expanded[**row].is_finite(),
        None => has_others && own[**row].is_finite(),
    };
    members.weighed.iter().filter(is_known).count()
}

/// Forms E_n of all rows; `tests` is the number of them over all measurands.
pub(crate) fn agreement(
    measurand: &MeasurandValues,
    members: &[Members],
    results: &mut [GroupResult],
    [tests, threads]: [usize; 2],
    (devices, name): (Option<&Devices>, impl Fn(usize) -> String),
) -> Agreement {
    let values = &measurand.values;
    let mut found = Agreement::default();
    let mut beyond = Vec::new();
    for (group, (members, result)) in members.iter().zip(results).enumerate() {
        let against = Against::of(measurand, members, [tests, threads], devices);
        let compare = |place: usize| against.compared(members, place);
        let places: Vec<usize> = (0..members.weighed.len()).collect();
        in_order(&places, threads, compare, |place, compared| {
            let Some(Compared {
                deviation,
                expanded,
                outside,
                probability,
            }) = compared
            else {
                return;
            };
            result.tested += 1;
            result.expected += outside;
            if let Some(probability) = probability {
                result.beyond += 1;
                let probability = (tests as f64 * probability).min(1.0);
                found.named += usize::from(probability < SIGNIFICANCE);
                let en = deviation.difference / expanded;
                beyond.push((
                    probability,
                    en,
                    members.weighed[place],
                    group,
                    deviation.other,
                ));
            }
        });
        found.tested += result.tested;
        found.beyond += result.beyond;
        found.expected += result.expected;
    }
    beyond.sort_by(|a, b| {
        let worse = a.0.total_cmp(&b.0).then(b.1.abs().total_cmp(&a.1.abs()));
        worse.then(a.2.cmp(&b.2))
    });
    let listed = beyond.into_iter().take(LISTED);
    let apart = listed.map(|(probability, en, row, group, other)| Apart {
        row: row + 1,
        device: name(row),
        group,
        estimate: values.estimate[row],
        other,
        en,
        probability,
    });
    found.apart = apart.collect();
    found
}

/// What the rows of a group are held against.
enum Against<'v> {
    /// Stated references.
    References(&'v Values, &'v Values),
    /// The others of the group, of which some agree.
    Others(&'v Values, Box<Others<'v>>, Vec<bool>),
}

/// A row beside what it is held against.
struct Compared {
    deviation: Deviation,
    /// The expanded uncertainty of the difference.
    expanded: f64,
    /// Probability of a difference beyond that.
    outside: f64,
    /// That of this difference, where it is beyond.
    probability: Option<f64>,
}

impl<'v> Against<'v> {
    fn of(
        measurand: &'v MeasurandValues,
        members: &Members,
        [tests, threads]: [usize; 2],
        devices: Option<&'v Devices>,
    ) -> Against<'v> {
        let values = &measurand.values;
        if let Some((_, reference)) = &measurand.reference {
            return Against::References(values, reference);
        }
        let agrees = agreeing(values, members, [tests, threads]);
        let agreeing = members.weighed.iter().zip(&agrees);
        let agreeing = agreeing.filter(|(_, agrees)| **agrees);
        let agreeing: Vec<usize> = agreeing.map(|(row, _)| *row).collect();
        let others = Others::of(values, &agreeing, members.median, devices);
        Against::Others(values, Box::new(others), agrees)
    }

    /// A row, by its place among those of the group that weigh; nothing of one that cannot be tested.
    fn compared(&self, members: &Members, place: usize) -> Option<Compared> {
        let row = members.weighed[place];
        let (deviation, expanded) = match self {
            Against::References(values, reference) => {
                let u = reference.u[row];
                // Of an exact value 0/k is 0; where neither u nor k is stated, k is that of the row.
                let other = (reference.estimate[row], u, reference.dof[row]);
                let expanded = of_difference(values.expanded[row], reference.expanded[row]);
                if !u.is_finite() {
                    return None;
                }
                (Deviation::of(values, row, other), expanded)
            }
            Against::Others(values, others, agrees) => {
                let deviation = others.deviation(row, agrees[place])?;
                // The expanded uncertainty of both sides with the k of the row.
                (deviation, values.k(row) * deviation.u)
            }
        };
        if !expanded.is_finite() {
            return None;
        }
        let is_beyond = deviation.difference.abs() > expanded;
        Some(Compared {
            expanded,
            outside: deviation.beyond(expanded),
            probability: is_beyond.then(|| deviation.probability()),
            deviation,
        })
    }
}

/// Which rows belong into the mean against which the others are held: one that lies far apart would shift it for all of them.
///
/// Far apart is what lies so from the median, which half of the rows could not move, with the probability at which a device is
/// named. The median of values of different u has u² = π/2 · n/(Σ 1/u)², from the density of the normal distribution in its
/// middle. Of two rows neither is more apart than the other.
fn agreeing(values: &Values, members: &Members, [tests, threads]: [usize; 2]) -> Vec<bool> {
    let rows = &members.weighed;
    if rows.len() < 3 {
        return vec![true; rows.len()];
    }
    let weights = Weights::of(values, rows.iter().copied());
    let inverse: f64 = rows.iter().map(|row| 1.0 / weights.u(*row)).sum();
    let u = weights.unit * ((std::f64::consts::FRAC_PI_2 * rows.len() as f64).sqrt() / inverse);
    let is_probable = |probability: f64| tests as f64 * probability >= SIGNIFICANCE;
    let agrees = |row: usize| {
        let from_median = Deviation::of(values, row, (members.median, u, f64::INFINITY));
        // Tails of t are longer than those of the normal distribution, which are quickly known.
        is_probable(from_median.least_probability()) || is_probable(from_median.probability())
    };
    let mut all = Vec::with_capacity(rows.len());
    in_order(rows, threads, agrees, |_, agrees| all.push(agrees));
    all
}

/// The expanded uncertainty of a difference.
pub(crate) fn of_difference(one: f64, other: f64) -> f64 {
    norm([one, other].into_iter())
}
