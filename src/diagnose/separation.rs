//! What further measurements tell apart: the rows that they add, the effects of the contenders on them, and
//! how far these stay apart.

use nalgebra::{DMatrix, DVector};

use super::case::{Case, NoiseClaim};
use super::catalogue::{self, Cell, Ground, Variation, Words};
use super::evidence::{self, Action, Baseline, Worth};
use super::extra::Extra;
use super::fit::{self, Fit};
use super::frame::Frame;
use super::inquiry::baseline;
use super::noise::{self, Claimed};

/// An explanation among others for the same mismatch.
#[derive(Debug, Clone, PartialEq)]
pub struct Contender {
    /// Identifier of the effect.
    id: String,
    /// What its texts speak of.
    words: Words,
    /// Its variant.
    label: String,
    /// The value of its continuous parameter.
    shape: Option<f64>,
    /// Its coefficients.
    size: DVector<f64>,
}

impl Contender {
    /// A variation of a cell with coefficients.
    pub(super) fn new(cell: &Cell, variation: &Variation, size: DVector<f64>) -> Contender {
        Contender {
            id: cell.effect.id.clone(),
            words: cell.words.clone(),
            label: variation.label.clone(),
            shape: value(variation),
            size,
        }
    }

    /// Its columns in another design; nothing where the design has no such effect.
    fn columns(&self, ground: &Ground<'_>, cells: &[Cell]) -> Option<DMatrix<f64>> {
        let variation = self.variation(cells)?;
        let columns = variation.columns(ground);
        let usable = columns.ncols() == self.size.len() && columns.iter().all(|x| x.is_finite());
        usable.then_some(columns)
    }

    /// The same variation in another design. A grid that follows the rows may have another step there: what
    /// is nearest to it, or else its middle, then stands for it.
    fn variation<'c>(&self, cells: &'c [Cell]) -> Option<&'c Variation> {
        // Each harmonic of an angle is a cell of its own.
        let alike = || {
            let of = cells.iter();
            of.filter(|cell| cell.effect.id == self.id && cell.words == self.words)
        };
        let mut all = alike().flat_map(|cell| &cell.variants);
        let nearest = || {
            let own = self.shape?;
            let usable = alike().flat_map(|cell| &cell.variants);
            let usable = usable.filter(|other| other.coefficients() == self.size.len());
            let far = |other: &Variation| value(other).map(|value| (value - own).abs());
            let ranked = usable.filter_map(|other| Some((far(other)?, other)));
            ranked
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .map(|(_, other)| other)
        };
        let middle = || {
            let cell = alike().next()?;
            cell.variants.get(cell.variants.len() / 2)
        };
        all.find(|variation| variation.label == self.label)
            .or_else(nearest)
            .or_else(middle)
    }
}

fn value(variation: &Variation) -> Option<f64> {
    Some(variation.shape.as_ref()?.value)
}

/// What is known of a case before a further measurement.
pub(super) struct Known<'k> {
    pub case: &'k Case,
    pub frame: &'k Frame<'k>,
    pub fit: &'k Fit,
    pub claimed: &'k Claimed,
}

/// What one further measurement gives.
pub(super) struct Design {
    /// For each set of contenders how far they then stay apart; nothing where this cannot be said.
    pub worths: Vec<Option<Worth>>,
    /// For each of the asked effects the share that the parameters do not absorb then.
    pub visibilities: Vec<Option<f64>>,
}

/// Examines the recording together with a further measurement.
pub(super) fn design(
    known: &Known<'_>,
    extra: &Extra,
    sets: &[Vec<Contender>],
    asked: &[Contender],
) -> Option<Design> {
    let case = known.case.followed_by(&extra.rows);
    let frame = Frame::new(&case);
    let fit = fit::at(&frame, unknowns(known, &frame));
    if !fit.jacobian.iter().all(|x| x.is_finite()) {
        return None;
    }
    let fit = Fit {
        residuals: DVector::zeros(frame.observations()),
        ..fit
    };
    let ground = Ground::new(&frame, &fit);
    let cells = catalogue::cells(&ground);
    let baseline = baseline(&frame, &fit, &noise_of(known, &frame, &fit)).ok()?;
    let worths = sets
        .iter()
        .map(|set| worth(&ground, &cells, &baseline, extra, set))
        .collect();
    let visibility = |one: &Contender| {
        let columns = one.columns(&ground, &cells)?;
        let of = columns
            .column_iter()
            .map(|column| baseline.visibility(&column.into_owned()));
        Some(of.fold(1.0, f64::min))
    };
    Some(Design {
        worths,
        visibilities: asked.iter().map(visibility).collect(),
    })
}

fn worth(
    ground: &Ground<'_>,
    cells: &[Cell],
    baseline: &Baseline,
    extra: &Extra,
    set: &[Contender],
) -> Option<Worth> {
    let columns: Option<Vec<DMatrix<f64>>> =
        set.iter().map(|one| one.columns(ground, cells)).collect();
    let action = Action {
        name: String::new(),
        cost: extra.cost,
        baseline,
        columns: columns?,
    };
    let sizes: Vec<DVector<f64>> = set.iter().map(|one| one.size.clone()).collect();
    evidence::separate(&sizes, &[action]).ok()?.pop()
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
    /// Separability of the two that are most alike, as it is.
    pub kappa: f64,
    /// Further measurements with what they are worth, the most useful for its cost first.
    pub extras: Vec<(Extra, Worth)>,
}

/// More contenders take long and help nobody.
const CONTENDERS: usize = 4;
/// Rivals of which more is left are told apart as it is.
const CLOSE: f64 = 4.0;

/// For each slot with several explanations, or with one that has a close rival, the further measurements
/// that tell them apart.
pub(super) fn separating(
    known: &Known<'_>,
    ground: &Ground<'_>,
    cells: &[Cell],
    places: &[(usize, usize)],
    baseline: &Baseline,
    slots: &[evidence::Slot],
) -> Vec<Separating> {
    let mut found = Vec::new();
    for (slot, of) in slots.iter().enumerate() {
        let mut rivals = Vec::new();
        let mut set: Vec<Contender> = Vec::new();
        for alternative in of.named.iter().take(CONTENDERS) {
            let Some(variant) = alternative.variants.first() else {
                continue;
            };
            let (cell, variation) = places[variant.atom];
            let variation = &cells[cell].variants[variation];
            set.push(Contender::new(
                &cells[cell],
                variation,
                alternative.estimate.clone(),
            ));
            rivals.push(cell);
        }
        let nearest = of.named.first().and_then(|first| first.nearest.as_ref());
        if let (1, Some(rival)) = (set.len(), nearest.filter(|r| r.alias || r.kappa < CLOSE)) {
            let (cell, variation) = places[rival.atom];
            let variation = &cells[cell].variants[variation];
            if let Some(size) = likened(ground, cells, baseline, &set[0], variation) {
                set.push(Contender::new(&cells[cell], variation, size));
                rivals.push(cell);
            }
        }
        if set.len() < 2 {
            continue;
        }
        let kappa = nearest.map_or(0.0, |rival| rival.kappa);
        found.push((slot, rivals, kappa, set));
    }
    if found.is_empty() {
        return Vec::new();
    }
    let all = super::extra::extras(known.case);
    let sets: Vec<Vec<Contender>> = found.iter().map(|(.., set)| set.clone()).collect();
    let designs: Vec<Option<Design>> = all
        .iter()
        .map(|extra| design(known, extra, &sets, &[]))
        .collect();
    found
        .into_iter()
        .enumerate()
        .map(|(at, (slot, rivals, kappa, _))| {
            let of = all.iter().zip(&designs).filter_map(|(extra, design)| {
                let worth = design.as_ref()?.worths.get(at)?.clone()?;
                Some((extra.clone(), worth))
            });
            let mut extras: Vec<(Extra, Worth)> = of.collect();
            let value = |(extra, worth): &(Extra, Worth)| worth.kappa.min(5.0) / extra.cost;
            extras.sort_by(|a, b| value(b).total_cmp(&value(a)));
            Separating {
                slot,
                rivals,
                kappa,
                extras,
            }
        })
        .collect()
}

/// The size with which a variation does what a contender does, as far as it can.
fn likened(
    ground: &Ground<'_>,
    cells: &[Cell],
    baseline: &Baseline,
    contender: &Contender,
    variation: &Variation,
) -> Option<DVector<f64>> {
    let size = contender.size.map(|x| if x.is_finite() { x } else { 0.0 });
    let effect = baseline.project(&contender.columns(ground, cells)?) * size;
    let rival = baseline.project(&variation.columns(ground));
    rival.svd(true, true).solve(&effect, 1e-9).ok()
}
