//! What further measurements tell apart.

use super::catalogue::Variation;
use super::evidence::{self, Examination, Separability, Standing, Worth};
use super::explanation::{Explanation, Unlisted, likened, sizes, unlisted};
use super::extra::Extra;
use super::prolonged::{Prolonged, Recorded, examined};

/// Explanations of one effect that a recording cannot tell apart, and what would.
#[derive(Debug, Clone)]
pub struct Separating {
    /// Index of the slot in the examination.
    pub slot: usize,
    /// Candidates that stand against each other.
    pub rivals: Vec<usize>,
    /// A number for each of them; those that share one say the same of every measurement that is known here.
    pub classes: Vec<usize>,
    /// Separability of the two that are most alike, as it is.
    pub kappa: f64,
    /// Further measurements with what they are worth, the most useful for its cost first.
    pub extras: Vec<(Extra, Worth)>,
}

/// More explanations take long and help nobody.
const CONTENDERS: usize = 6;
/// Rivals of which more is left are told apart as it is.
const CLOSE: f64 = 4.0;

/// For each slot with several explanations, or with one that has a close rival, the further measurements
/// that tell them apart.
pub(super) fn separating(recorded: &Recorded<'_>, examination: &Examination) -> Vec<Separating> {
    let candidates = recorded.candidates;
    let (fitted, cells) = (&candidates.fitted, &candidates.cells);
    let mut lists = Vec::new();
    for (slot, of) in examination.slots.iter().enumerate() {
        let mut rivals = Vec::new();
        let mut set: Vec<Explanation<'_>> = Vec::new();
        for alternative in of.named.iter().take(CONTENDERS) {
            let variants: Vec<(&Variation, f64)> = (alternative.variants.iter())
                .map(|variant| (candidates.variation(variant.atom), variant.share))
                .collect();
            let Some((variation, _)) = variants.first() else {
                continue;
            };
            let cell = alternative.candidate;
            let sizes = sizes(&alternative.estimate, &alternative.covariance);
            let p = alternative.probability;
            let one = Explanation::new(recorded, &cells[cell], variation, &sizes, p);
            set.push(one.with(recorded, &variants));
            rivals.push(cell);
        }
        let nearest = of.named.first().and_then(|first| first.nearest.as_ref());
        if let (1, Some(rival)) = (set.len(), nearest.filter(|r| r.alias || r.kappa < CLOSE)) {
            let variation = candidates.variation(rival.atom);
            let cell = candidates.cell(rival.atom);
            set.extend(likened(recorded, &set[0], cell, variation));
            rivals.push(rival.candidate);
        }
        if set.len() < 2 {
            continue;
        }
        let listed: f64 = of.named.iter().map(|named| named.probability).sum();
        // Of what a list holds beside these nothing is promised.
        let examined: f64 = set.iter().map(|one| one.probability).sum();
        let standing: Vec<Standing> = set.iter().map(|one| one.before(recorded)).collect();
        let Some(before) = evidence::apart(&standing) else {
            continue;
        };
        lists.push(List {
            slot,
            rivals,
            kappa: nearest.map_or(0.0, |rival| rival.kappa),
            share: (examined / listed).min(1.0),
            before,
            outside: unlisted(fitted, cells, recorded.baseline, &set, &standing),
            set,
        });
    }
    if lists.is_empty() {
        return Vec::new();
    }
    let all = super::extra::extras(recorded.known.design.case);
    let after = all.iter().map(|extra| {
        examined(recorded, extra, |prolonged| {
            let after = lists.iter().map(|list| list.after(recorded, prolonged));
            after.collect::<Vec<_>>()
        })
    });
    let after: Vec<Option<Vec<Option<After>>>> = after.collect();
    let of = |at: usize| -> Vec<(&Extra, &After)> {
        let pairs = all.iter().zip(&after);
        let own = pairs.filter_map(|(extra, after)| Some((extra, after.as_ref()?[at].as_ref()?)));
        own.collect()
    };
    let lists = lists.into_iter().enumerate();
    lists.map(|(at, list)| list.judged(&of(at))).collect()
}

/// Explanations that stand against each other for one effect.
struct List<'c> {
    slot: usize,
    rivals: Vec<usize>,
    kappa: f64,
    set: Vec<Explanation<'c>>,
    /// Probability that one of the set is right, if any name of the list is.
    share: f64,
    before: Separability,
    outside: Vec<Unlisted<'c>>,
}

/// How the explanations of a list are apart with a further measurement, and for each the probability that
/// another candidate comes to stand beside it.
struct After {
    apart: Separability,
    doubts: Vec<f64>,
}

impl List<'_> {
    fn after(&self, recorded: &Recorded<'_>, prolonged: &Prolonged<'_>) -> Option<After> {
        let standing = (self.set.iter()).map(|one| one.standing(recorded, prolonged));
        let standing = standing.collect::<Option<Vec<Standing>>>()?;
        let apart = evidence::apart(&standing)?;
        let (fitted, baseline) = (&prolonged.fitted, &prolonged.baseline);
        let outside = unlisted(fitted, &prolonged.cells, baseline, &self.set, &standing);
        let mut doubts = vec![0.0_f64; self.set.len()];
        for one in &outside {
            let before = (self.outside.iter()).find(|other| other.cell.is(one.cell));
            for (at, doubt) in doubts.iter_mut().enumerate() {
                // What the recording had no such candidate for may come now.
                let before = before.map_or(f64::INFINITY, |before| before.kappas[at]);
                let own = match one.stays[at] {
                    true => 1.0,
                    false => evidence::doubt(before, one.kappas[at]),
                };
                *doubt = doubt.max(own);
            }
        }
        Some(After { apart, doubts })
    }

    fn judged(self, after: &[(&Extra, &After)]) -> Separating {
        let aparts: Vec<&Separability> = after.iter().map(|(_, after)| &after.apart).collect();
        let classes = classes(self.set.len(), &self.before, &aparts);
        let probabilities: Vec<f64> = self.set.iter().map(|one| one.probability).collect();
        let worth = |after: &After| {
            let (before, doubts) = (&self.before, &after.doubts);
            let mut worth = after.apart.worth(before, &probabilities, &classes, doubts);
            worth.resolved *= self.share;
            worth
        };
        let is_apart = classes.iter().any(|class| *class > 0);
        let worths = after.iter().filter(|_| is_apart);
        let worths = worths.map(|(extra, after)| ((*extra).clone(), worth(after)));
        let mut extras: Vec<(Extra, Worth)> = worths.collect();
        // The cheapest that separates; of those alike what decides more surely.
        let value = |(extra, worth): &(Extra, Worth)| worth.kappa.min(5.0) / extra.cost;
        extras.sort_by(|a, b| {
            let by_value = value(b).total_cmp(&value(a));
            by_value.then(b.1.resolved.total_cmp(&a.1.resolved))
        });
        Separating {
            slot: self.slot,
            rivals: self.rivals,
            classes,
            kappa: self.kappa,
            extras,
        }
    }
}

/// A number for each of so many explanations; the same for those that neither the recording nor any further
/// measurement tells apart.
fn classes(count: usize, before: &Separability, after: &[&Separability]) -> Vec<usize> {
    let alike =
        |a: usize, b: usize| before.alike(a, b) && after.iter().all(|apart| apart.alike(a, b));
    let mut classes = Vec::new();
    for one in 0..count {
        let same = (0..one).find(|other| alike(one, *other));
        let next = classes.iter().max().map_or(0, |most: &usize| most + 1);
        classes.push(same.map_or(next, |other| classes[other]));
    }
    classes
}
