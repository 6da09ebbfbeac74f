//! What further measurements tell apart: the rows that they add, the effects of the contenders on them, and
//! how far these stay apart.

use nalgebra::{DMatrix, DVector};

use super::case::{Case, NoiseClaim};
use super::catalogue::{self, Cell, Ground, Variation, Words};
use super::evidence::{self, Apart, Baseline, Prospects, Standing, Worth};
use super::extra::Extra;
use super::fit::{self, Fit};
use super::frame::Frame;
use super::inquiry::baseline;
use super::noise::{self, Claimed};
use crate::special::normal_quantile;

/// An explanation among others for the same mismatch.
#[derive(Debug, Clone, PartialEq)]
pub struct Contender {
    /// Identifier of the effect.
    id: String,
    /// What its texts speak of.
    words: Words,
    /// Its posterior probability.
    probability: f64,
    /// What it may look like, the most probable first.
    likely: Vec<Likely>,
}

/// A variant that an explanation may have.
#[derive(Debug, Clone, PartialEq)]
struct Likely {
    /// Its label.
    label: String,
    /// The value of its continuous parameter.
    shape: Option<f64>,
    /// What is seen of it in the recording, a column for each of the sizes that it may have.
    seen: DMatrix<f64>,
}

/// Sizes and shapes for which a promise is formed.
const DRAWS: usize = 40;

impl Contender {
    /// A variation of a cell with coefficients; those that are not finite count as zero.
    pub(super) fn new(
        recorded: &Recorded<'_>,
        cell: &Cell,
        variation: &Variation,
        sizes: &DMatrix<f64>,
        probability: f64,
    ) -> Contender {
        let sizes = sizes.map(|x| if x.is_finite() { x } else { 0.0 });
        let columns = variation.columns(recorded.ground);
        Contender {
            id: cell.effect.id.clone(),
            words: cell.words.clone(),
            probability,
            likely: vec![Likely {
                label: variation.label.clone(),
                shape: value(variation),
                seen: recorded.baseline.project(&columns) * sizes,
            }],
        }
    }

    /// The same where it may have other variants too: some of the sizes are theirs, by their shares.
    fn with(mut self, recorded: &Recorded<'_>, variations: &[(&Variation, f64)]) -> Contender {
        let Some(first) = self.likely.first_mut() else {
            return self;
        };
        let whole: f64 = variations.iter().map(|(_, share)| share).sum();
        let seen = std::mem::take(&mut first.seen);
        let mut bound = 0.0;
        let mut begin = 0;
        let mut likely = Vec::new();
        for (variation, share) in variations {
            bound += share / whole;
            let end = (bound * seen.ncols() as f64).round() as usize;
            let end = end.clamp(begin, seen.ncols());
            if end == begin {
                continue;
            }
            let own = seen.columns(begin, end - begin).into_owned();
            let columns = recorded
                .baseline
                .project(&variation.columns(recorded.ground));
            likely.push(Likely {
                label: variation.label.clone(),
                shape: value(variation),
                seen: fitted(&columns, &own).map_or(own, |sizes| columns * sizes),
            });
            begin = end;
        }
        self.likely = likely;
        self
    }

    /// How it stands in the recording.
    fn before(&self, recorded: &Recorded<'_>, cells: &[Cell]) -> Standing {
        let variants = self.variants(recorded.ground, cells).into_iter();
        let seen = |columns: DMatrix<f64>| visible(recorded.baseline, columns);
        Standing {
            effects: side_by_side(self.likely.iter().map(|likely| likely.seen.clone())),
            variants: variants.filter_map(seen).collect(),
        }
    }

    /// How it stands in another design; nothing where the design has no such effect.
    fn standing(&self, recorded: &Recorded<'_>, longer: &Longer<'_>) -> Option<Standing> {
        let variants = self.variants(&longer.ground, &longer.cells);
        let before: Vec<DMatrix<f64>> = variants
            .iter()
            .map(|columns| {
                recorded
                    .baseline
                    .project(&longer.recorded(recorded, columns))
            })
            .collect();
        // The variant there that does the same to the rows of the recording.
        let effects = self.likely.iter().map(|likely| {
            let ranked = before.iter().zip(&variants).filter_map(|(before, whole)| {
                let sizes = fitted(before, &likely.seen)?;
                let left = (&likely.seen - before * &sizes).norm_squared();
                Some((left, whole, sizes))
            });
            let (_, whole, sizes) = ranked.min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(longer.baseline.project(&(whole * sizes)))
        });
        let effects: Option<Vec<DMatrix<f64>>> = effects.collect();
        let variants = variants.iter().cloned();
        Some(Standing {
            effects: side_by_side(effects?.into_iter()),
            variants: variants
                .filter_map(|columns| visible(&longer.baseline, columns))
                .collect(),
        })
    }

    /// Columns of all variants that it has among some cells.
    fn variants(&self, ground: &Ground<'_>, cells: &[Cell]) -> Vec<DMatrix<f64>> {
        let alike = cells.iter().filter(|cell| self.is(cell));
        alike
            .flat_map(|cell| &cell.variants)
            .map(|variation| variation.columns(ground))
            .filter(|columns| columns.ncols() > 0 && columns.iter().all(|x| x.is_finite()))
            .collect()
    }

    fn is(&self, cell: &Cell) -> bool {
        // Each harmonic of an angle is a cell of its own.
        cell.effect.id == self.id && cell.words == self.words
    }

    /// The columns of its variation in another design. A grid that follows the rows may have another step
    /// there: what is nearest to it, or else its middle, then stands for it.
    fn columns(&self, longer: &Longer<'_>) -> Option<DMatrix<f64>> {
        let own = self.likely.first()?;
        let cell = longer.cells.iter().find(|cell| self.is(cell))?;
        let same = cell.variants.iter().find(|v| v.label == own.label);
        let nearest = || {
            let own = own.shape?;
            let far = |other: &Variation| value(other).map(|value| (value - own).abs());
            let ranked = cell.variants.iter();
            let ranked = ranked.filter_map(|other| Some((far(other)?, other)));
            let nearest = ranked.min_by(|a, b| a.0.total_cmp(&b.0));
            nearest.map(|(_, other)| other)
        };
        let middle = || cell.variants.get(cell.variants.len() / 2);
        let columns = same
            .or_else(nearest)
            .or_else(middle)?
            .columns(&longer.ground);
        columns.iter().all(|x| x.is_finite()).then_some(columns)
    }
}

fn value(variation: &Variation) -> Option<f64> {
    Some(variation.shape.as_ref()?.value)
}

/// The sizes with which columns come nearest to effects.
fn fitted(columns: &DMatrix<f64>, effects: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    // Columns of unit length: their units may be very different.
    let lengths: Vec<f64> = columns.column_iter().map(|c| c.norm()).collect();
    let most = lengths.iter().copied().fold(0.0, f64::max);
    if most == 0.0 {
        return None;
    }
    let scale = |length: &f64| if *length > 0.0 { 1.0 / length } else { 0.0 };
    let scales: Vec<f64> = lengths.iter().map(scale).collect();
    let mut unit = columns.clone();
    for (mut column, scale) in unit.column_iter_mut().zip(&scales) {
        column *= *scale;
    }
    let mut sizes = unit.svd(true, true).solve(effects, 1e-9).ok()?;
    for (mut row, scale) in sizes.row_iter_mut().zip(&scales) {
        row *= *scale;
    }
    Some(sizes)
}

/// Sizes that an estimate allows, itself first: quantiles of a normal distribution, by a Halton sequence.
fn sizes(estimate: &DVector<f64>, covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
    let estimate = estimate.map(finite);
    let spread = covariance.map(finite).symmetric_eigen();
    let widths = spread.eigenvalues.map(|variance| variance.max(0.0).sqrt());
    let root = &spread.eigenvectors * DMatrix::from_diagonal(&widths);
    let normals = DMatrix::from_fn(estimate.len(), DRAWS, |k, draw| {
        if draw == 0 {
            0.0
        } else {
            normal_quantile(halton(draw, PRIMES[k % PRIMES.len()]))
        }
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

/// What is known of a case before a further measurement.
pub(super) struct Known<'k> {
    pub case: &'k Case,
    pub frame: &'k Frame<'k>,
    pub fit: &'k Fit,
    pub claimed: &'k Claimed,
}

/// A recording with what its residuals are examined by.
pub(super) struct Recorded<'r> {
    pub known: &'r Known<'r>,
    pub ground: &'r Ground<'r>,
    pub baseline: &'r Baseline,
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

fn side_by_side(parts: impl Iterator<Item = DMatrix<f64>>) -> DMatrix<f64> {
    let parts: Vec<DMatrix<f64>> = parts.collect();
    let columns: Vec<_> = parts.iter().flat_map(|part| part.column_iter()).collect();
    if columns.is_empty() {
        return DMatrix::zeros(0, 0);
    }
    DMatrix::from_columns(&columns)
}

/// The recording together with a further measurement.
struct Longer<'l> {
    ground: Ground<'l>,
    cells: Vec<Cell>,
    baseline: Baseline,
}

impl Longer<'_> {
    /// The observations of the recording alone.
    fn recorded(&self, recorded: &Recorded<'_>, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let frame = self.ground.frame;
        let (own, all) = (recorded.known.frame.blocks.len(), frame.blocks.len());
        let places: Vec<usize> = (0..frame.case.responses.len())
            .flat_map(|response| (0..own).map(move |block| response * all + block))
            .collect();
        columns.select_rows(&places)
    }
}

/// What one further measurement gives.
pub(super) struct Design {
    /// For each set of contenders how far they then are apart; nothing where this cannot be said.
    pub aparts: Vec<Option<Apart>>,
    /// For each of the asked effects the share that the parameters do not absorb then.
    pub visibilities: Vec<Option<f64>>,
}

/// Examines the recording together with a further measurement.
pub(super) fn design(
    recorded: &Recorded<'_>,
    extra: &Extra,
    sets: &[Vec<Contender>],
    asked: &[Contender],
) -> Option<Design> {
    let known = recorded.known;
    let case = known.case.followed_by(&extra.rows);
    let mut frame = Frame::new(&case);
    frame.blocks = blocks(known, extra);
    let fit = fit::at(&frame, unknowns(known, &frame));
    if !fit.jacobian.iter().all(|x| x.is_finite()) {
        return None;
    }
    let fit = Fit {
        residuals: DVector::zeros(frame.observations()),
        ..fit
    };
    let ground = Ground::new(&frame, &fit).refined(recorded.ground.finer.clone());
    let cells = catalogue::cells(&ground);
    let baseline = baseline(&frame, &fit, &noise_of(known, &frame, &fit)).ok()?;
    let longer = Longer {
        ground,
        cells,
        baseline,
    };
    let aparts = sets.iter().map(|set| {
        let contenders = set.iter().map(|one| one.standing(recorded, &longer));
        let contenders: Option<Vec<Standing>> = contenders.collect();
        evidence::apart(&contenders?).ok()
    });
    let aparts = aparts.collect();
    let visibility = |one: &Contender| {
        let columns = one.columns(&longer)?;
        let of = columns
            .column_iter()
            .map(|column| longer.baseline.visibility(&column.into_owned()));
        Some(of.fold(1.0, f64::min))
    };
    Some(Design {
        aparts,
        visibilities: asked.iter().map(visibility).collect(),
    })
}

/// The blocks of the recording, and after them those that the further rows have by themselves.
fn blocks(known: &Known<'_>, extra: &Extra) -> Vec<Vec<usize>> {
    let alone = known.case.with(&extra.rows);
    let further = Frame::new(&alone).blocks.into_iter();
    let further = further.map(|rows| rows.into_iter().map(|row| row + known.case.rows).collect());
    known.frame.blocks.iter().cloned().chain(further).collect()
}

/// Values of the unknowns in another design; a label that is new there begins with the value of the first.
pub(super) fn unknowns(known: &Known<'_>, frame: &Frame<'_>) -> DVector<f64> {
    let own = &known.frame.unknowns;
    let value = |name: &str| {
        let stem = name.split('[').next().unwrap_or(name);
        let same = own.iter().position(|unknown| unknown.name == name);
        let alike = || {
            own.iter()
                .position(|u| u.name.split('[').next() == Some(stem))
        };
        same.or_else(alike).map_or(0.0, |at| known.fit.unknowns[at])
    };
    let values = frame.unknowns.iter().map(|unknown| value(&unknown.name));
    DVector::from_iterator(frame.unknowns.len(), values)
}

/// The noise of another design: what is claimed, or for each response what the rows at hand have.
pub(super) fn noise_of(known: &Known<'_>, frame: &Frame<'_>, fit: &Fit) -> Claimed {
    match &known.case.noise {
        NoiseClaim::Stated { .. } | NoiseClaim::AtRest { .. } | NoiseClaim::PerRow(_) => {
            noise::planned(frame, fit)
        }
        NoiseClaim::Estimated | NoiseClaim::Replicates(_) => {
            let (own, blocks) = (known.frame.blocks.len(), frame.blocks.len());
            let rms = |response: usize| {
                let part = known.claimed.u.rows(response * own, own);
                (part.norm_squared() / own as f64).sqrt()
            };
            let u = DVector::from_fn(frame.observations(), |at, _| rms(at / blocks));
            Claimed {
                u,
                correlated: None,
                ..known.claimed.clone()
            }
        }
    }
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

/// More contenders take long and help nobody.
const CONTENDERS: usize = 6;
/// Rivals of which more is left are told apart as it is.
const CLOSE: f64 = 4.0;

/// For each slot with several explanations, or with one that has a close rival, the further measurements
/// that tell them apart.
pub(super) fn separating(
    recorded: &Recorded<'_>,
    cells: &[Cell],
    places: &[(usize, usize)],
    slots: &[evidence::Slot],
) -> Vec<Separating> {
    let of_atom = |atom: usize| {
        let (cell, variation) = places[atom];
        (cell, &cells[cell].variants[variation])
    };
    let mut found = Vec::new();
    for (slot, of) in slots.iter().enumerate() {
        let mut rivals = Vec::new();
        let mut set: Vec<Contender> = Vec::new();
        for alternative in of.named.iter().take(CONTENDERS) {
            let variants: Vec<(&Variation, f64)> = (alternative.variants.iter())
                .map(|variant| (of_atom(variant.atom).1, variant.share))
                .collect();
            let Some((variation, _)) = variants.first() else {
                continue;
            };
            let cell = alternative.candidate;
            let sizes = sizes(&alternative.estimate, &alternative.covariance);
            let p = alternative.probability;
            let one = Contender::new(recorded, &cells[cell], variation, &sizes, p);
            set.push(one.with(recorded, &variants));
            rivals.push(cell);
        }
        let nearest = of.named.first().and_then(|first| first.nearest.as_ref());
        if let (1, Some(rival)) = (set.len(), nearest.filter(|r| r.alias || r.kappa < CLOSE)) {
            let (cell, variation) = of_atom(rival.atom);
            set.extend(likened(recorded, &set[0], &cells[cell], variation));
            rivals.push(cell);
        }
        if set.len() < 2 {
            continue;
        }
        let kappa = nearest.map_or(0.0, |rival| rival.kappa);
        let all: f64 = of
            .named
            .iter()
            .map(|alternative| alternative.probability)
            .sum();
        found.push((slot, rivals, kappa, set, all));
    }
    if found.is_empty() {
        return Vec::new();
    }
    let all = super::extra::extras(recorded.known.case);
    let sets: Vec<Vec<Contender>> = found.iter().map(|(.., set, _)| set.clone()).collect();
    let designs: Vec<Option<Design>> = all
        .iter()
        .map(|extra| design(recorded, extra, &sets, &[]))
        .collect();
    let mut separating = Vec::new();
    for (at, (slot, rivals, kappa, set, all_listed)) in found.into_iter().enumerate() {
        let standing: Vec<Standing> = (set.iter())
            .map(|one| one.before(recorded, cells))
            .collect();
        let Ok(before) = evidence::apart(&standing) else {
            continue;
        };
        let after: Vec<(&Extra, &Apart)> = (all.iter().zip(&designs))
            .filter_map(|(extra, design)| Some((extra, design.as_ref()?.aparts[at].as_ref()?)))
            .collect();
        let classes = classes(set.len(), &before, &after);
        let probabilities: Vec<f64> = set.iter().map(|one| one.probability).collect();
        let prospects = Prospects {
            before: &before,
            probabilities: &probabilities,
            classes: &classes,
        };
        // Of what a list holds beside these nothing is promised.
        let examined = (probabilities.iter().sum::<f64>() / all_listed).min(1.0);
        let mut extras: Vec<(Extra, Worth)> = if classes.iter().all(|class| *class == 0) {
            Vec::new()
        } else {
            let worths = after.iter();
            let worths = worths.map(|(extra, apart)| {
                let mut worth = apart.worth(&prospects);
                worth.resolved *= examined;
                ((*extra).clone(), worth)
            });
            worths.collect()
        };
        let value = |(extra, worth): &(Extra, Worth)| worth.kappa.min(5.0) / extra.cost;
        extras.sort_by(|a, b| value(b).total_cmp(&value(a)));
        separating.push(Separating {
            slot,
            rivals,
            classes,
            kappa,
            extras,
        });
    }
    separating
}

/// A number for each of so many explanations; the same for those that neither the recording nor any further
/// measurement tells apart.
fn classes(count: usize, before: &Apart, after: &[(&Extra, &Apart)]) -> Vec<usize> {
    let alike =
        |a: usize, b: usize| before.alike(a, b) && after.iter().all(|(_, apart)| apart.alike(a, b));
    let mut classes = Vec::new();
    for one in 0..count {
        let same = (0..one).find(|other| alike(one, *other));
        let next = classes.iter().max().map_or(0, |most: &usize| most + 1);
        classes.push(same.map_or(next, |other| classes[other]));
    }
    classes
}

/// A variation that does what a contender does, as far as it can.
fn likened(
    recorded: &Recorded<'_>,
    contender: &Contender,
    cell: &Cell,
    variation: &Variation,
) -> Option<Contender> {
    let seen = &contender.likely.first()?.seen;
    let columns = recorded
        .baseline
        .project(&variation.columns(recorded.ground));
    let sizes = fitted(&columns, seen)?;
    // It is not in the list: less probable than whatever is.
    Some(Contender::new(recorded, cell, variation, &sizes, UNLISTED))
}

/// The most that an explanation has which is not listed.
const UNLISTED: f64 = 0.01;
