//! Explanations of the same mismatch, in the recording and in longer ones, and what further measurements tell apart.

use nalgebra::{DMatrix, DVector};

use super::case::Extra;
use super::catalogue::modifiers::known;
use super::catalogue::{Cell, FittedModel, Pattern, Variation};
use super::evidence::{self, Baseline, Examination, Separability, Standing, Worth};
use super::extra::extras;
use super::prolonged::{Prolonged, Recorded, examined};
use gumption_core::special::normal_quantile;

/// An explanation among others for the same mismatch.
#[derive(Debug)]
pub(super) struct Explanation<'c> {
    cell: &'c Cell,
    /// Its posterior probability.
    pub(super) probability: f64,
    /// What is seen of the variants that it may be in the recording, the most probable first, with a column for each of the
    /// sizes that they may have.
    likely: Vec<DMatrix<f64>>,
}

/// Sizes and shapes for which a promise is formed.
const DRAWS: usize = 40;

impl<'c> Explanation<'c> {
    /// A variation of a cell with coefficients; those that are not finite count as zero.
    pub(super) fn new(
        recorded: &Recorded<'_>,
        cell: &'c Cell,
        variation: &Variation,
        sizes: &DMatrix<f64>,
        probability: f64,
    ) -> Explanation<'c> {
        Explanation {
            cell,
            probability,
            likely: vec![recorded.seen(variation) * sizes.map(known)],
        }
    }

    /// The same where it may have other variants too: some of the sizes are theirs, by their shares.
    pub(super) fn with(
        self,
        recorded: &Recorded<'_>,
        variations: &[(&Variation, f64)],
    ) -> Explanation<'c> {
        let whole: f64 = variations.iter().map(|(_, share)| share).sum();
        let seen = evidence::all(self.likely.into_iter());
        let mut bound = 0.0;
        let mut begin = 0;
        let mut likely = Vec::new();
        for (variation, share) in variations {
            bound += share / whole;
            let end = (bound * seen.ncols() as f64).round() as usize;
            let end = end.max(begin).min(seen.ncols());
            if end == begin {
                continue;
            }
            let own = seen.columns(begin, end - begin).into_owned();
            let columns = recorded.seen(variation);
            likely.push(fitted(&columns, &own).map_or(own, |sizes| columns * sizes));
            begin = end;
        }
        Explanation { likely, ..self }
    }

    /// How it stands in the recording.
    pub(super) fn before(&self, recorded: &Recorded<'_>) -> Standing {
        let own = recorded.candidates;
        let variants = self.variants(&own.fitted, &own.cells).into_iter();
        let seen = |columns: DMatrix<f64>| visible(recorded.baseline, columns);
        Standing {
            effects: evidence::all(self.likely.iter().cloned()),
            variants: variants.filter_map(seen).collect(),
            repeats: self.cell.effect.repeats,
        }
    }

    /// How it stands in another design; nothing where the design has no such effect.
    pub(super) fn standing(
        &self,
        recorded: &Recorded<'_>,
        prolonged: &Prolonged<'_>,
    ) -> Option<Standing> {
        let variants = self.variants(&prolonged.fitted, &prolonged.cells);
        let in_recording = |columns| prolonged.recorded(recorded, columns);
        let before = (variants.iter().map(in_recording)).map(|own| recorded.baseline.project(&own));
        let before: Vec<DMatrix<f64>> = before.collect();
        /// A variant that leaves more of the effect (squared) is another one.
        const MOST_LEFT: f64 = 0.5;
        // The variant there that does the same to the rows of the recording.
        let effects = self.likely.iter().map(|seen| {
            let ranked = before.iter().zip(&variants).filter_map(|(before, whole)| {
                let sizes = fitted(before, seen)?;
                let left = (seen - before * &sizes).norm_squared();
                Some((left, whole, sizes))
            });
            let (left, whole, sizes) = ranked.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let same = left <= MOST_LEFT * seen.norm_squared();
            same.then(|| prolonged.baseline.project(&(whole * sizes)))
        });
        let effects: Option<Vec<DMatrix<f64>>> = effects.collect();
        let effects = evidence::all(effects?.into_iter());
        let seen = |columns| visible(&prolonged.baseline, columns);
        Some(Standing {
            effects,
            variants: variants.into_iter().filter_map(seen).collect(),
            repeats: self.cell.effect.repeats,
        })
    }

    /// Columns of all variants that it has among some cells.
    fn variants(&self, fitted: &FittedModel<'_>, cells: &[Cell]) -> Vec<DMatrix<f64>> {
        let alike = cells.iter().filter(|cell| self.cell.is(cell));
        alike.flat_map(|cell| finite(fitted, cell)).collect()
    }
}

/// Columns of the variants of a cell, where they are finite; without those that may have another size under the labels of further
/// rows, of which these would tell nothing.
fn finite<'c>(
    fitted: &'c FittedModel<'_>,
    cell: &'c Cell,
) -> impl Iterator<Item = DMatrix<f64>> + 'c {
    let forms = cell.variants.iter();
    let everywhere = forms.filter(|form| form.of_labels.is_none());
    let columns = everywhere.map(|form| form.columns(fitted));
    columns.filter(|columns| columns.ncols() > 0 && columns.iter().all(|x| x.is_finite()))
}

/// The sizes with which columns come nearest to effects.
fn fitted(columns: &DMatrix<f64>, effects: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    (columns.amax() > 0.0).then(|| evidence::inverse(columns) * effects)
}

/// Sizes that an estimate allows, itself first: quantiles of a normal distribution, by a Halton sequence.
fn sizes(estimate: &DVector<f64>, covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let estimate = estimate.map(known);
    let spread = covariance.map(known).symmetric_eigen();
    let widths = spread.eigenvalues.map(|variance| variance.max(0.0).sqrt());
    let root = &spread.eigenvectors * DMatrix::from_diagonal(&widths);
    let normals = DMatrix::from_fn(estimate.len(), DRAWS, |k, draw| match draw {
        0 => 0.0,
        _ => normal_quantile(halton(draw, PRIMES[k % PRIMES.len()])),
    });
    let mut sizes = root * normals;
    for mut column in sizes.column_iter_mut() {
        column += &estimate;
    }
    sizes
}

const PRIMES: [usize; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

/// The digits of a number in a base, mirrored at the point.
fn halton(mut number: usize, base: usize) -> f64 {
    let (mut value, mut part) = (0.0, 1.0);
    while number > 0 {
        part /= base as f64;
        value += part * (number % base) as f64;
        number /= base;
    }
    value
}

/// Columns as they are seen, without those that the parameters absorb.
fn visible(baseline: &Baseline, columns: DMatrix<f64>) -> Option<DMatrix<f64>> {
    /// What is left of less is rounding.
    const ABSORBED: f64 = 1e-12;
    let shares = baseline.visibilities(&columns);
    let kept: Vec<usize> = (0..columns.ncols())
        .filter(|column| shares[*column] > ABSORBED)
        .collect();
    (!kept.is_empty()).then(|| baseline.project(&columns.select_columns(&kept)))
}

/// Candidates that leave more do not come to stand beside an explanation by rule.
const FAR: f64 = 8.0;

/// What a candidate that is not in a list leaves of each explanation of it.
#[derive(Debug)]
struct Unlisted<'c> {
    pub cell: &'c Cell,
    /// κ of each.
    pub kappas: Vec<f64>,
    /// Whether it comes to stand beside each whatever the odds say.
    pub stays: Vec<bool>,
}

/// All candidates that are not in a list: named ones whose size is free. Single rows and waves of any
/// period come near to anything a little, and seldom stand for it.
fn unlisted<'c>(
    fitted: &FittedModel<'_>,
    cells: &'c [Cell],
    baseline: &Baseline,
    set: &[Explanation<'_>],
    standing: &[Standing],
) -> Vec<Unlisted<'c>> {
    let effects = standing.iter().map(|one| one.effects.column(0));
    let effects = DMatrix::from_columns(&effects.collect::<Vec<_>>());
    let counts = |cell: &&Cell| {
        let named =
            cell.variants.iter().all(|v| v.spectrum.is_none()) && cell.effect.exact.is_none();
        let rows = matches!(cell.effect.pattern, Some(Pattern::Row | Pattern::Wave));
        named && !rows && !set.iter().any(|one| one.cell.is(cell))
    };
    let of = |cell: &'c Cell| {
        let seen = finite(fitted, cell).filter_map(|columns| visible(baseline, columns));
        let seen: Vec<DMatrix<f64>> = seen.collect();
        let kappas = evidence::left(&effects, seen.iter().cloned());
        let near = (kappas.iter().zip(standing))
            .map(|(kappa, one)| *kappa < FAR && !cell.effect.repeats && one.keeps(&seen));
        Unlisted {
            cell,
            stays: near.collect(),
            kappas,
        }
    };
    cells.iter().filter(counts).map(of).collect()
}

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

/// The most that an explanation has which is not listed: less than whatever is.
const UNLISTED: f64 = 0.01;
/// More explanations take long and help nobody.
pub(super) const CONTENDERS: usize = 6;
/// Rivals of which more is left are told apart as it is.
const CLOSE: f64 = 4.0;

/// For each slot with several explanations, or with one that has a close rival, the further measurements
/// that tell them apart.
pub(super) fn separating(recorded: &Recorded<'_>, examination: &Examination) -> Vec<Separating> {
    let candidates = recorded.candidates;
    let (model, cells) = (&candidates.fitted, &candidates.cells);
    let mut lists = Vec::new();
    for (slot, of) in examination.slots.iter().enumerate() {
        let mut rivals = Vec::new();
        let mut set: Vec<Explanation<'_>> = Vec::new();
        for alternative in of.named.iter().take(CONTENDERS) {
            let variants: Vec<(&Variation, f64)> = (alternative.variants.iter())
                .map(|variant| (candidates.variation(variant.atom), variant.share))
                .collect();
            // What has no size is told by no measurement of it.
            let Some((variation, _)) = variants.first().filter(|(one, _)| !one.terms.is_empty())
            else {
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
            // What does as the first does, as far as it can.
            let sizes = set[0].likely.first();
            let sizes = sizes.and_then(|seen| fitted(&recorded.seen(variation), seen));
            let one = |sizes| Explanation::new(recorded, cell, variation, &sizes, UNLISTED);
            set.extend(sizes.map(one));
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
            outside: unlisted(model, cells, recorded.baseline, &set, &standing),
            set,
        });
    }
    if lists.is_empty() {
        return Vec::new();
    }
    let all = extras(recorded.known.design.case);
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
        let value =
            |(extra, worth): &(Extra, Worth)| worth.kappa.min(evidence::SEPARATED) / extra.cost;
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
