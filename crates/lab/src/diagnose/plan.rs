//! A plan: what an experiment can see and tell apart, from its design alone, and which further measurement
//! helps most.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::candidates::{Candidates, baseline};
use super::case::{Case, Extra, Origin};
use super::catalogue::{Cell, FittedModel, Kind};
use super::coarse::Coarse;
use super::confirm::{Estimated, estimates};
use super::design::Design;
use super::evidence::{self, Refusal, SEPARATED, Shape, TRACE};
use super::explanation::Explanation;
use super::extra::extras;
use super::failure::Failure;
use super::fit::Fit;
use super::noise::Claimed;
use super::omitted::{self, Omitted};
use super::prolonged::{Known, Recorded, examined};
use super::settled;
use super::size;
use super::typical::{self, Unified};

/// What an experiment can see and tell apart. Sizes of effects are the largest shifts of the output.
#[derive(Debug)]
pub struct Outlook {
    /// All candidates, in the order of the catalogue.
    pub cells: Vec<Cell>,
    /// The noise that was assumed.
    pub noise: Claimed,
    /// Whether the noise is not known: then one row has the standard uncertainty one.
    pub relative: bool,
    /// Parameters on whose value slopes depend and of which nothing is known: they were taken as one.
    pub assumed: Vec<String>,
    /// Rows, and means of rows.
    pub observations: usize,
    /// The parameters with the standard uncertainties to expect.
    pub unknowns: Vec<Estimated>,
    /// What can be seen of each candidate that can be seen at all.
    pub effects: Vec<Prospect>,
    /// Candidates that are one in this experiment, two or more in each class.
    pub classes: Vec<Vec<usize>>,
    /// What effects cost that may be there and are not in the model, the dearest first.
    pub omitted: Vec<Omitted>,
    /// Further measurements, the most useful first.
    pub extras: Vec<Promise>,
    /// Pairs of candidates that this experiment hardly tells apart.
    pub pairs: Vec<(usize, usize)>,
}

/// What can be seen of a candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Prospect {
    /// Index of the candidate.
    pub cell: usize,
    /// Index of the variant that stands for it: that of average visibility.
    pub variation: usize,
    /// Share that the parameters do not absorb, 0 … 1.
    pub visibility: f64,
    /// Smallest size that is detected as good as always (λ = 6).
    pub detectable: f64,
    /// Candidate that resembles it most, with the cosine of the angle between the two.
    pub rival: Option<(usize, f64)>,
    /// Smallest size that is told from that rival as good as always (κ = 5); `None` where no size is.
    pub separable: Option<f64>,
    /// The largest size that would not surprise.
    pub typical: Option<f64>,
}

/// What a further measurement gives.
#[derive(Debug, Clone)]
pub struct Promise {
    /// The measurement.
    pub extra: Extra,
    /// Pairs, by their places in [`Outlook::pairs`], that are told apart with it.
    pub resolved: Vec<usize>,
    /// Invisible candidates, by their places in [`Outlook::cells`], that are visible with it.
    pub revealed: Vec<usize>,
}

/// Strength of the effects for which further measurements are judged.
const STRENGTH: f64 = 8.0;
/// Before anything is recorded, one of two is as probable as the other.
const EVEN: f64 = 0.5;
/// More than a trace of an effect shows.
const VISIBLE: f64 = 0.01;

/// Examines the design of a case. Recorded outputs serve only for the size of parameters and noise where
/// the case states neither.
///
/// # Errors
/// When the model has no finite value or its parameters are not determined, or the work was stopped.
pub fn plan(case: &Case, progress: &dyn Fn(f64) -> ControlFlow<()>) -> Result<Outlook, Failure> {
    size::fits_into_memory(case)?;
    let design = Design::new(case);
    let (fit, claimed, assumed) = assumed(&design)?;
    let fit = Fit {
        residuals: DVector::zeros(design.observations()),
        ..fit
    };
    let coarse = Coarse::of(&design, &fit);
    let seen = coarse.design();
    let fitted = FittedModel::new(&seen, &coarse.fit);
    let baseline = baseline(&design, &fit, &claimed)?;
    let mut candidates = Candidates::new(fitted, &claimed, &baseline);
    let unified = named(&mut candidates);
    step(progress, 0.1)?;
    let found = evidence::visibility(&baseline, &candidates.candidates, &candidates.atoms);
    let effects = prospects(&candidates, &unified, &found);
    let unknowns = estimates(&design, &fit, &claimed);
    let u: Vec<f64> = unknowns.iter().map(|unknown| unknown.u).collect();
    let omitted = omitted::lines(&candidates, &baseline, None, &[], &u);
    step(progress, 0.4)?;
    let pairs = pairs(&effects);
    let known = Known {
        design: &design,
        fit: &fit,
        claimed: &claimed,
    };
    let recorded = Recorded {
        known: &known,
        candidates: &candidates,
        baseline: &baseline,
    };
    let sets = pairs
        .iter()
        .map(|pair| explanations(&recorded, &effects, *pair));
    let sets: Vec<Vec<Explanation<'_>>> = sets.collect();
    let hidden: Vec<&Omitted> = omitted.iter().filter(|line| line.is_invisible()).collect();
    let mut promises = Vec::new();
    let all = extras(case);
    for (at, extra) in all.iter().enumerate() {
        promises.extend(promise(&recorded, &sets, &hidden, extra));
        step(progress, 0.4 + 0.6 * (at + 1) as f64 / all.len() as f64)?;
    }
    let worth = |promise: &Promise| {
        (promise.resolved.len() + promise.revealed.len()) as f64 / promise.extra.cost
    };
    promises.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
    Ok(Outlook {
        relative: claimed.origin == Origin::Unknown,
        noise: claimed,
        assumed,
        observations: design.observations(),
        unknowns,
        effects,
        classes: classes(&candidates, &found.classes),
        omitted,
        extras: promises,
        pairs,
        cells: candidates.cells,
    })
}

fn step(progress: &dyn Fn(f64) -> ControlFlow<()>, share: f64) -> Result<(), Failure> {
    let stopped = progress(share).break_value();
    stopped.map_or(Ok(()), |()| Err(Failure::Refused(Refusal::Cancelled)))
}

/// The model at the values that the case states; where it does not state all, at those that fit the
/// outputs; where these are not recorded, at one.
fn assumed(design: &Design<'_>) -> Result<(Fit, Claimed, Vec<String>), Failure> {
    if design.case.is_recorded()
        && let Ok((fit, claimed)) = settled::settle_spread_out(design)
    {
        let known = Claimed {
            dof: f64::INFINITY,
            ..claimed
        };
        return Ok((fit, known, Vec::new()));
    }
    let (fit, claimed) = settled::stated(design)?;
    let open = (design.unknowns.iter()).filter(|unknown| unknown.stated().is_none());
    let open = open.map(|unknown| unknown.name.clone()).collect();
    Ok((fit, claimed, open))
}

/// Keeps the named atoms of free size, in units of their largest shift.
fn named(candidates: &mut Candidates<'_>) -> Vec<Unified> {
    let mut all = Vec::new();
    candidates.retain(|atom, cell| {
        let Shape::Columns(columns) = &atom.shape else {
            return false;
        };
        let unified = typical::unified(columns.clone()).filter(|_| cell.effect.exact.is_none());
        let Some(unified) = unified else {
            return false;
        };
        atom.shape = Shape::Columns(unified.columns.clone());
        all.push(unified);
        true
    });
    all
}

/// One prospect for each candidate that has a visible variant.
fn prospects(
    candidates: &Candidates<'_>,
    unified: &[Unified],
    found: &evidence::Plan,
) -> Vec<Prospect> {
    let (fitted, atoms) = (&candidates.fitted, &candidates.atoms);
    let scales = typical::full_scales(fitted);
    let mut prospects = Vec::new();
    for (cell, of) in candidates.cells.iter().enumerate() {
        let own = (found.seen.iter())
            .filter(|seen| atoms[seen.atom].candidate == cell && seen.visibility > TRACE);
        let own = own.filter_map(|seen| Some((seen, seen.detectable?)));
        let mut own: Vec<(&evidence::Seen, f64)> = own.collect();
        own.sort_by(|a, b| a.1.total_cmp(&b.1));
        let Some((seen, detectable)) = own.get(own.len().saturating_sub(1) / 2) else {
            continue;
        };
        let pair = seen.rival.as_ref();
        let variation = atoms[seen.atom].variant;
        let (form, unified) = (&of.variants[variation], &unified[seen.atom]);
        prospects.push(Prospect {
            cell,
            variation,
            visibility: seen.visibility,
            detectable: *detectable,
            rival: pair.map(|pair| (atoms[pair.rival].candidate, pair.cosine)),
            separable: pair.and_then(|pair| pair.separable),
            typical: typical::shift(fitted, of, form, unified, &scales),
        });
    }
    prospects
}

/// Candidates that share a class, each class once.
fn classes(candidates: &Candidates<'_>, atoms: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut classes: Vec<Vec<usize>> = Vec::new();
    for class in atoms {
        let of = class.iter().map(|atom| candidates.atoms[*atom].candidate);
        // A single row or a jump is an alias of much in few rows.
        let is_alias = |cell: &usize| candidates.cells[*cell].effect.kind == Kind::Record;
        let mut of: Vec<usize> = of.filter(|cell| !is_alias(cell)).collect();
        of.sort_unstable();
        of.dedup();
        if of.len() > 1 && !classes.contains(&of) {
            classes.push(of);
        }
    }
    let whole = classes.clone();
    let is_part = |class: &Vec<usize>, other: &Vec<usize>| {
        other.len() > class.len() && class.iter().all(|cell| other.contains(cell))
    };
    classes.retain(|class| !whole.iter().any(|other| is_part(class, other)));
    classes
}

/// Pairs that effects of a usual strength are not told apart in, even by twice as many rows.
fn pairs(effects: &[Prospect]) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    for effect in effects {
        let Some((rival, cosine)) = effect.rival else {
            continue;
        };
        let kappa = STRENGTH * (1.0 - cosine * cosine).max(0.0).sqrt();
        let pair = (effect.cell.min(rival), effect.cell.max(rival));
        let known = effects.iter().any(|other| other.cell == rival);
        if kappa < SEPARATED / std::f64::consts::SQRT_2 && known && !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    pairs
}

/// Both of a pair, with sizes that have the same strength in the experiment as it is.
fn explanations<'r>(
    recorded: &'r Recorded<'_>,
    effects: &[Prospect],
    (a, b): (usize, usize),
) -> Vec<Explanation<'r>> {
    let of = |cell: usize| {
        let effect = effects.iter().find(|effect| effect.cell == cell)?;
        let cell = &recorded.candidates.cells[cell];
        let variation = &cell.variants[effect.variation];
        let seen = recorded.seen(variation);
        let sum = seen.column_sum().norm();
        let size = if sum > 0.0 { STRENGTH / sum } else { 0.0 };
        let sizes = DMatrix::from_element(seen.ncols(), 1, size);
        Some(Explanation::new(recorded, cell, variation, &sizes, EVEN))
    };
    [a, b].into_iter().filter_map(of).collect()
}

/// Which of some sets of explanations a further measurement tells apart, and what it shows of that which is hidden.
fn promise(
    recorded: &Recorded<'_>,
    sets: &[Vec<Explanation<'_>>],
    hidden: &[&Omitted],
    extra: &Extra,
) -> Option<Promise> {
    let (resolved, revealed) = examined(recorded, extra, |prolonged| {
        let is_told = |at: &usize| {
            let standing = (sets[*at].iter()).map(|one| one.standing(recorded, prolonged));
            let standing = standing.collect::<Option<Vec<_>>>();
            let apart = standing.and_then(|standing| evidence::apart(&standing));
            apart.is_some_and(|apart| apart.least() >= SEPARATED)
        };
        let shows = |line: &&&Omitted| {
            let cell = &recorded.candidates.cells[line.cell];
            let share = prolonged.visibility(cell, &cell.variants[line.variation]);
            share.is_some_and(|share| share > VISIBLE)
        };
        let resolved: Vec<usize> = (0..sets.len()).filter(is_told).collect();
        let revealed = hidden.iter().filter(shows).map(|line| line.cell);
        (resolved, revealed.collect())
    })?;
    Some(Promise {
        extra: extra.clone(),
        resolved,
        revealed,
    })
}
