//! An explanation among others for the same mismatch, in the recording and in longer ones.

use nalgebra::{DMatrix, DVector};

use super::catalogue::modifiers::known;
use super::catalogue::{Cell, FittedModel, Pattern, Variation};
use super::evidence::{self, Baseline, Standing};
use super::prolonged::{Prolonged, Recorded};
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

/// Columns of the variants of a cell, where they are finite.
fn finite<'c>(
    fitted: &'c FittedModel<'_>,
    cell: &'c Cell,
) -> impl Iterator<Item = DMatrix<f64>> + 'c {
    let columns = cell
        .variants
        .iter()
        .map(|variation| variation.columns(fitted));
    columns.filter(|columns| columns.ncols() > 0 && columns.iter().all(|x| x.is_finite()))
}

/// The sizes with which columns come nearest to effects.
fn fitted(columns: &DMatrix<f64>, effects: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    (columns.amax() > 0.0).then(|| evidence::inverse(columns) * effects)
}

/// Sizes that an estimate allows, itself first: quantiles of a normal distribution, by a Halton sequence.
pub(super) fn sizes(estimate: &DVector<f64>, covariance: &DMatrix<f64>) -> DMatrix<f64> {
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

/// A variation that does what an explanation does, as far as it can.
pub(super) fn likened<'c>(
    recorded: &Recorded<'_>,
    explanation: &Explanation<'_>,
    cell: &'c Cell,
    variation: &Variation,
) -> Option<Explanation<'c>> {
    let sizes = fitted(&recorded.seen(variation), explanation.likely.first()?)?;
    /// The most that an explanation has which is not listed: less than whatever is.
    const MOST: f64 = 0.01;
    Some(Explanation::new(recorded, cell, variation, &sizes, MOST))
}

/// Candidates that leave more do not come to stand beside an explanation by rule.
const FAR: f64 = 8.0;

/// What a candidate that is not in a list leaves of each explanation of it.
#[derive(Debug)]
pub(super) struct Unlisted<'c> {
    pub cell: &'c Cell,
    /// κ of each.
    pub kappas: Vec<f64>,
    /// Whether it comes to stand beside each whatever the odds say.
    pub stays: Vec<bool>,
}

/// All candidates that are not in a list: named ones whose size is free. Single rows and waves of any
/// period come near to anything a little, and seldom stand for it.
pub(super) fn unlisted<'c>(
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
