//! A diagnosis from end to end: fit, candidates, examination, location, adoption, confirmation.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::adopt;
use super::case::Case;
use super::catalogue::{self, Cell, Finer, Ground, Variation};
use super::confirm::{self, Confirmation, Quality};
use super::evidence::{
    self, Atom, Baseline, Candidate, Examination, Located, Prior, Question, Refusal, Shape, Verdict,
};
use super::faults::{NOT_FITTED, START, TOO_FEW};
use super::fit::{Fit, NoFit};
use super::frame::Frame;
use super::held_out::{self, HeldOutQuality};
use super::local;
use super::noise::{self, Claimed};
use super::omitted::{self, Omitted};
use super::place;
use super::separation::{self, Known, Separating};
use crate::fault::Code;

/// Why a case could not be diagnosed.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// The declared model could not be fitted.
    Fit(NoFit),
    /// The statistics refused.
    Refused(Refusal),
}

impl Failure {
    /// The code under which `gumption explain` says more, where it does.
    pub fn code(&self) -> Option<Code> {
        match self {
            Failure::Fit(NoFit::NoStart) => Some(START),
            Failure::Fit(NoFit::TooFew { .. }) | Failure::Refused(Refusal::NoFreedom { .. }) => {
                Some(TOO_FEW)
            }
            Failure::Fit(NoFit::NoMinimum | NoFit::Undetermined(_))
            | Failure::Refused(Refusal::Dependent { .. }) => Some(NOT_FITTED),
            Failure::Refused(_) => None,
        }
    }
}

impl From<NoFit> for Failure {
    fn from(why: NoFit) -> Failure {
        Failure::Fit(why)
    }
}

impl From<Refusal> for Failure {
    fn from(why: Refusal) -> Failure {
        Failure::Refused(why)
    }
}

/// Everything that a diagnosis found.
#[derive(Debug)]
pub struct Diagnosis {
    /// All candidates, in the order of the catalogue.
    pub cells: Vec<Cell>,
    /// Cell and variation of each atom.
    pub atoms: Vec<(usize, usize)>,
    /// What the statistics found.
    pub examination: Examination,
    /// Where the mismatch sits, the most conspicuous first.
    pub located: Vec<(evidence::Cell, Located)>,
    /// The noise that was used.
    pub noise: Claimed,
    /// Names and values of the unknowns of the declared model, with their standard uncertainties.
    pub unknowns: Vec<Estimated>,
    /// The declared model.
    pub before: Quality,
    /// What the declared model leaves, observation by observation.
    pub residuals: DVector<f64>,
    /// The model with the effects in it.
    pub adopted: Option<Adopted>,
    /// Number of means (blocks) and of rows in the recording.
    pub blocks: Vec<Vec<usize>>,
    /// What effects cost that were not adopted and may be there all the same, the dearest first.
    pub omitted: Vec<Omitted>,
    /// How well the held-out recording is predicted, if the case names one.
    pub held_out: Option<HeldOutQuality>,
    /// For each slot, where something is adopted, what it costs each unknown that the slot has several
    /// explanations.
    pub choices: Vec<Vec<f64>>,
    /// Explanations that the recording cannot tell apart, with the measurements that would.
    pub separating: Vec<Separating>,
}

/// A fitted quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimated {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Its standard uncertainty.
    pub u: f64,
}

/// The model with the effects in it.
#[derive(Debug)]
pub struct Adopted {
    /// Atoms that were adopted.
    pub atoms: Vec<usize>,
    /// Coefficients, in the order of the atoms and their terms.
    pub coefficients: Vec<Estimated>,
    /// The unknowns of the declared model, now.
    pub unknowns: Vec<Estimated>,
    /// The improved case.
    pub extended: adopt::Extended,
    /// How well it describes the recording.
    pub quality: Quality,
    /// What it leaves.
    pub residuals: DVector<f64>,
    /// Further checks.
    pub confirmation: Confirmation,
}

impl Diagnosis {
    /// The standard uncertainties of the unknowns with everything that may be there unseen, and with the
    /// choice between explanations: of the declared model, or of the one with the adopted physics in it.
    pub fn u_with_unseen(&self) -> Vec<f64> {
        let estimates = match &self.adopted {
            Some(adopted) => &adopted.unknowns,
            None => &self.unknowns,
        };
        let of = estimates.iter().enumerate().map(|(at, estimate)| {
            let lines = self.omitted.iter().map(|line| line.after.u.get(at));
            let choices = self.choices.iter().map(|choice| choice.get(at));
            let squares = lines.chain(choices).flatten().map(|u| u * u);
            (estimate.u * estimate.u + squares.sum::<f64>()).sqrt()
        });
        of.collect()
    }
}

/// Confronts the declared model of a case with its recording.
///
/// `progress` is told the share of the work that is done, and may stop it.
///
/// # Errors
/// When the model cannot be fitted, or the work was stopped.
pub fn diagnose(
    case: &Case,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Diagnosis, Failure> {
    let frame = Frame::new(case);
    let (fit, mut claimed) = noise::settle(&frame)?;
    let white = baseline(&frame, &fit, &claimed)?;
    let settings = settings(case);
    let mut inquiry = Inquiry::new(Ground::new(&frame, &fit), &claimed, &white);
    let part = |from: f64, to: f64| move |share: f64| progress(from + (to - from) * share);
    let first = if claimed.is_estimated() { 0.4 } else { 0.6 };
    let (mut baseline, mut examination) = inquiry.ask(&claimed, &settings, &part(0.0, first))?;
    if claimed.is_estimated() && examination.verdict == Verdict::None {
        let spread = noise::spread_out(&frame, &fit);
        if spread.growth.iter().any(Option::is_some) {
            claimed = spread;
            (baseline, examination) = inquiry.ask(&claimed, &settings, &part(0.4, 0.6))?;
        }
    }
    if claimed.is_estimated() && examination.verdict != Verdict::None {
        // Noise and effects are estimated in turn: what an effect explains is no noise.
        for round in 0..ROUNDS {
            let adopted = adopted_atoms(&examination);
            claimed = inquiry.noise(&examination, &claimed);
            let from = 0.4 + 0.1 * f64::from(round);
            let part = part(from, from + 0.1);
            (baseline, examination) = inquiry.ask(&claimed, &settings, &part)?;
            if adopted_atoms(&examination) == adopted {
                break;
            }
        }
    }
    // Shapes that lie between the steps of a grid: closer and closer.
    let mut finer = Finer::default();
    for round in 0..REFINEMENTS {
        if !inquiry.refine(&mut finer, &examination) {
            break;
        }
        inquiry = Inquiry::new(
            Ground::new(&frame, &fit).refined(finer.clone()),
            &claimed,
            &white,
        );
        let from = 0.7 + 0.1 * f64::from(round);
        (baseline, examination) = inquiry.ask(&claimed, &settings, &part(from, from + 0.05))?;
        if claimed.is_estimated() {
            claimed = inquiry.noise(&examination, &claimed);
            let part = part(from + 0.05, from + 0.1);
            (baseline, examination) = inquiry.ask(&claimed, &settings, &part)?;
        }
    }
    let Inquiry {
        ground,
        cells,
        places,
        ..
    } = inquiry;
    let nameless = local::nameless(&ground, &cells, &places, &examination);
    examination.demote(&nameless);
    let located = if examination.verdict == Verdict::None {
        Vec::new()
    } else {
        let mut levels = place::cells(&ground);
        let columns: Vec<DVector<f64>> = levels.iter().map(|cell| cell.column.clone()).collect();
        if !columns.is_empty() {
            let shares = white.visibilities(&DMatrix::from_columns(&columns));
            let mut shares = shares.into_iter();
            levels.retain(|_| shares.next().is_some_and(|share| share > TRACE));
        }
        let found = evidence::locate(&baseline, &levels, &settings)?;
        found
            .into_iter()
            .map(|located| (levels[located.cell].clone(), located))
            .collect()
    };
    let before = confirm::quality(&frame, &fit, &claimed, &claimed);
    let adopted = adopt_named(&ground, &cells, &places, &examination, &claimed);
    let unknowns = estimates(&frame, &fit, &claimed, before.scale);
    let improved = adopted
        .as_ref()
        .and_then(|adopted| omitted::improved_baseline(case, adopted, &claimed));
    let listed = examination.slots.iter().filter(|_| adopted.is_some());
    let known: Vec<usize> = listed
        .clone()
        .flat_map(|slot| slot.named.iter().map(|named| named.candidate))
        .collect();
    let choices = listed
        .map(|slot| omitted::choice(&ground, &cells, &places, &baseline, slot))
        .collect();
    let u: Vec<f64> = unknowns.iter().map(|unknown| unknown.u).collect();
    let omitted = omitted::lines(&ground, &cells, &baseline, improved.as_ref(), &known, &u);
    let known = Known {
        case,
        frame: &frame,
        fit: &fit,
        claimed: &claimed,
    };
    let held_out = held_out::held_out(
        &known,
        &ground,
        &cells,
        &places,
        &unknowns,
        adopted.as_ref(),
    );
    let slots = &examination.slots;
    let separating = separation::separating(&known, &ground, &cells, &places, &baseline, slots);
    Ok(Diagnosis {
        examination,
        located,
        unknowns,
        before,
        residuals: fit.residuals.clone(),
        adopted,
        blocks: frame.blocks.clone(),
        omitted,
        separating,
        held_out,
        choices,
        cells,
        atoms: places,
        noise: claimed,
    })
}

/// Candidates, asked of a recording.
struct Inquiry<'f> {
    ground: Ground<'f>,
    cells: Vec<Cell>,
    candidates: Vec<Candidate>,
    atoms: Vec<Atom>,
    /// Cell and variation of each atom.
    places: Vec<(usize, usize)>,
}

impl<'f> Inquiry<'f> {
    fn new(ground: Ground<'f>, claimed: &Claimed, white: &Baseline) -> Inquiry<'f> {
        let cells = catalogue::cells(&ground);
        let (candidates, atoms, places) = question(&ground, &cells, claimed, white);
        Inquiry {
            ground,
            cells,
            candidates,
            atoms,
            places,
        }
    }

    /// Effects of a known size that are seen with another one are something else: without them, again.
    fn ask(
        &mut self,
        claimed: &Claimed,
        settings: &evidence::Settings,
        progress: &dyn Fn(f64) -> ControlFlow<()>,
    ) -> Result<(Baseline, Examination), Failure> {
        let baseline = baseline(self.ground.frame, self.ground.fit, claimed)?;
        loop {
            let question = Question {
                baseline: &baseline,
                candidates: &self.candidates,
                atoms: &self.atoms,
                settings: settings.clone(),
            };
            let examination = evidence::examine(&question, progress)?;
            let missized = missized(&self.cells, &examination);
            if missized.is_empty() {
                return Ok((baseline, examination));
            }
            self.atoms
                .retain(|atom| !missized.contains(&atom.candidate));
            self.places.retain(|(cell, _)| !missized.contains(cell));
        }
    }

    /// The noise that is left when the named effects are in the model.
    fn noise(&self, examination: &Examination, claimed: &Claimed) -> Claimed {
        let adopted = adopted_fit(
            &self.ground,
            &self.cells,
            &self.places,
            examination,
            claimed,
        );
        match adopted {
            Some((extended, fit)) => noise::refined(&Frame::new(&extended.case), &fit),
            None => noise::refined(self.ground.frame, self.ground.fit),
        }
    }

    /// Adds values about the parameters of strong effects; whether there are any that were not tried.
    fn refine(&self, finer: &mut Finer, examination: &Examination) -> bool {
        let strong = (examination.slots.iter())
            .filter_map(|slot| slot.named.first())
            .filter(|named| named.lambda >= CLEAR);
        let mut new = false;
        for named in strong {
            // The variant with two time constants has none between: one alone may do when it is the right one.
            let found = named.variants.iter().find_map(|variant| {
                let (cell, variation) = self.places[variant.atom];
                let variation = &self.cells[cell].variants[variation];
                variation.shape.is_some().then_some((cell, variation))
            });
            if let Some((cell, variation)) = found {
                new |= finer.add(&self.cells[cell], variation);
            }
        }
        new
    }
}

fn adopted_atoms(examination: &Examination) -> Option<Vec<usize>> {
    let fitted = examination.fitted.as_ref();
    fitted.map(|fitted| fitted.atoms.clone())
}

/// Candidates of a known size (a reversal, an exchange) that would have to have another size here.
fn missized(cells: &[Cell], examination: &Examination) -> Vec<usize> {
    let named = examination.slots.iter().flat_map(|slot| &slot.named);
    let wrong = named.filter(|named| {
        let effect = cells[named.candidate].effect;
        let sizes = named.estimate.iter().enumerate();
        sizes
            .map(|(at, size)| (*size, named.covariance[(at, at)].max(0.0).sqrt()))
            .any(|(size, u)| !effect.admits(size, u))
    });
    wrong.map(|named| named.candidate).collect()
}

/// Visible share of an effect below which it is the curvature of the model that shows.
const TRACE: f64 = 1e-4;
/// So often noise and effects are estimated in turn.
const ROUNDS: u8 = 3;
/// So often the values about the parameter of an effect are brought closer together.
const REFINEMENTS: u8 = 3;
/// λ from which on it matters by how much the parameter of an effect is off: by 10 % of a time constant, some
/// 5 % of the effect are left.
const CLEAR: f64 = 15.0;

pub(super) fn settings(case: &Case) -> evidence::Settings {
    evidence::Settings {
        alpha: case.settings.alpha,
        seed: case.settings.seed,
        draws: case.settings.draws,
        ..evidence::Settings::default()
    }
}

/// The recording reduced to its residuals.
pub(super) fn baseline(
    frame: &Frame<'_>,
    fit: &Fit,
    claimed: &Claimed,
) -> Result<Baseline, Refusal> {
    let known: Vec<(usize, (f64, f64))> = frame
        .unknowns
        .iter()
        .enumerate()
        .filter_map(|(at, unknown)| Some((at, unknown.prior?)))
        .collect();
    let mut prior = Prior {
        jacobian: DMatrix::zeros(known.len(), frame.unknowns.len()),
        residuals: DVector::zeros(known.len()),
    };
    for (row, (at, (value, u))) in known.iter().enumerate() {
        prior.jacobian[(row, *at)] = 1.0 / u;
        prior.residuals[row] = (value - fit.unknowns[*at]) / u;
    }
    Baseline::new(&fit.jacobian, &fit.residuals, &claimed.noise(), &prior)
}

/// Candidates and atoms, and the cell and variation of each atom.
pub(super) fn question(
    ground: &Ground<'_>,
    cells: &[Cell],
    claimed: &Claimed,
    baseline: &Baseline,
) -> (Vec<Candidate>, Vec<Atom>, Vec<(usize, usize)>) {
    let mut candidates = Vec::new();
    let (mut atoms, mut places) = (Vec::new(), Vec::new());
    for (index, cell) in cells.iter().enumerate() {
        candidates.push(Candidate {
            name: format!("{} {}", cell.effect.id, cell.words.x),
            family: cell.effect.family.clone(),
            place: cell.place.clone(),
            typical: cell.typical,
            repeats: matches!(cell.effect.id.as_str(), "outlier" | "step"),
            describes: matches!(
                cell.effect.id.as_str(),
                "outlier" | "step" | "step-scale" | "wave" | "level-shift" | "level-scale"
            ),
            odds: cell.odds,
        });
        let before = atoms.len();
        let shapes: Vec<(usize, Shape)> = (cell.variants.iter().enumerate())
            .filter_map(|(number, variation)| {
                let columns = variation.columns(ground);
                Some((number, shape(columns, variation, claimed)?))
            })
            .collect();
        let shown = showing(baseline, shapes.iter().map(|(_, shape)| shape));
        for ((number, shape), _) in shapes.into_iter().zip(shown).filter(|(_, shown)| *shown) {
            atoms.push(Atom {
                candidate: index,
                variant: cell.variants[number].label.clone(),
                shape,
                share: cell.variants[number].weight,
            });
            places.push((index, number));
        }
        let whole: f64 = atoms[before..].iter().map(|atom| atom.share).sum();
        for atom in &mut atoms[before..] {
            atom.share /= whole;
        }
    }
    (candidates, atoms, places)
}

/// Of which effects more than a trace is left beside the parameters. Less is what the curvature of the
/// model makes of an exact alias; it would take sizes that are out of the question. What has no visible
/// part at all is kept: it is listed as invisible.
fn showing<'s>(baseline: &Baseline, shapes: impl Iterator<Item = &'s Shape>) -> Vec<bool> {
    const NOTHING: f64 = 1e-6;
    let shapes: Vec<&Shape> = shapes.collect();
    let columns: Vec<_> = (shapes.iter())
        .filter_map(|shape| match shape {
            Shape::Columns(columns) => Some(columns),
            Shape::Smooth { .. } | Shape::Scatter => None,
        })
        .flat_map(|columns| columns.column_iter())
        .collect();
    if columns.is_empty() {
        return vec![true; shapes.len()];
    }
    let mut shares = baseline
        .visibilities(&DMatrix::from_columns(&columns))
        .into_iter();
    let shown = |shape: &&Shape| match shape {
        Shape::Columns(columns) => {
            let most = (shares.by_ref().take(columns.ncols())).fold(0.0, f64::max);
            !(NOTHING..TRACE).contains(&most)
        }
        Shape::Smooth { .. } | Shape::Scatter => true,
    };
    shapes.iter().map(shown).collect()
}

/// Nothing for a variation that is not finite or does nothing.
fn shape(columns: DMatrix<f64>, variation: &Variation, claimed: &Claimed) -> Option<Shape> {
    if columns.iter().any(|x| !x.is_finite()) {
        return None;
    }
    match &variation.spectrum {
        Some(spectrum) if spectrum.is_empty() => {
            (!claimed.is_estimated()).then_some(Shape::Scatter)
        }
        Some(spectrum) => Some(Shape::Smooth {
            features: columns,
            spectrum: spectrum.clone(),
        }),
        None => columns
            .iter()
            .any(|x| *x != 0.0)
            .then_some(Shape::Columns(columns)),
    }
}

/// The refit with the named effects in the model.
fn adopted_fit(
    ground: &Ground<'_>,
    cells: &[Cell],
    places: &[(usize, usize)],
    examination: &Examination,
    claimed: &Claimed,
) -> Option<(adopt::Extended, Fit)> {
    let fitted = examination.fitted.as_ref()?;
    let variations: Vec<&Variation> = fitted
        .atoms
        .iter()
        .map(|atom| &cells[places[*atom].0].variants[places[*atom].1])
        .collect();
    if variations.is_empty() {
        return None;
    }
    let mut extended = adopt::extended(ground, &variations)?;
    if let Some(fit) = refit(ground, &extended, fitted, claimed) {
        return Some((extended, fit));
    }
    // Levels within those of a parameter, such as runs of one specimen: what they have in common is the
    // parameter's.
    let counts: Vec<usize> = variations.iter().map(|v| v.coefficients()).collect();
    adopt::scattered(&mut extended, &counts, &fitted.coefficients);
    let fit = refit(ground, &extended, fitted, claimed)?;
    Some((extended, fit))
}

fn refit(
    ground: &Ground<'_>,
    extended: &adopt::Extended,
    fitted: &evidence::Fitted,
    claimed: &Claimed,
) -> Option<Fit> {
    let frame = Frame::new(&extended.case);
    let start = adopt::start(ground, &frame, &fitted.coefficients);
    let fit = super::fit::from(&frame, &claimed.u, start);
    fit.or_else(|_| super::fit::fit(&frame, &claimed.u)).ok()
}

/// The model with the named effects, and how well it does.
fn adopt_named(
    ground: &Ground<'_>,
    cells: &[Cell],
    places: &[(usize, usize)],
    examination: &Examination,
    claimed: &Claimed,
) -> Option<Adopted> {
    let fitted = examination.fitted.as_ref()?;
    let (extended, fit) = adopted_fit(ground, cells, places, examination, claimed)?;
    let frame = Frame::new(&extended.case);
    let quality = confirm::quality(&frame, &fit, claimed, claimed);
    let all = estimates(&frame, &fit, claimed, quality.scale);
    let added = extended.additions.len();
    let confirmation = confirm::confirmation(&frame, &fit, claimed, added, fitted);
    let is_added = |estimated: &Estimated| {
        extended
            .additions
            .iter()
            .any(|addition| addition.parameter == estimated.name)
    };
    let (coefficients, unknowns): (Vec<Estimated>, Vec<Estimated>) =
        all.into_iter().partition(is_added);
    let residuals = fit.residuals.clone();
    drop(frame);
    Some(Adopted {
        atoms: fitted.atoms.clone(),
        coefficients,
        unknowns,
        quality,
        residuals,
        confirmation,
        extended,
    })
}

/// Unknowns with their standard uncertainties; `scale` is the factor on the claimed noise.
pub(super) fn estimates(
    frame: &Frame<'_>,
    fit: &Fit,
    claimed: &Claimed,
    scale: f64,
) -> Vec<Estimated> {
    let covariance = confirm::covariance(frame, fit, claimed);
    frame
        .unknowns
        .iter()
        .enumerate()
        .map(|(at, unknown)| Estimated {
            name: unknown.name.clone(),
            unit: frame.unit(at),
            value: fit.unknowns[at],
            u: scale * covariance[(at, at)].max(0.0).sqrt(),
        })
        .collect()
}
