//! What is asked of a recording: candidates as columns, the recording as residuals, and the effects that were
//! found in the model.

use std::collections::BTreeSet;
use std::ops::Range;

use nalgebra::DMatrix;

use super::adopt::{self, Free};
use super::case::Case;
use super::catalogue::deviations::Deviations;
use super::catalogue::{self, Cell, Finer, FittedModel, Variation, readout};
use super::design::Design;
use super::evidence::{
    self, Atom, Baseline, Candidate, Chance, Examination, Fitted, Question, Refusal, Shape, TRACE,
};
use super::fit::{self, Fit, NoFit};
use super::noise::Claimed;
use super::noise_correlation::Courses;
use super::reduced::reduced;

/// λ from which on it matters that the parameter of an effect lies between the steps of its grid.
const CLEAR: f64 = 15.0;

/// Noise alone, held against effects.
pub(super) struct NoiseAlone {
    /// How likely it is that effects gain as much by noise alone.
    pub(super) chance: Chance,
    /// The noise as it is then: without effects where these do not gain more, else with the best one.
    pub(super) likeliest: Claimed,
    /// Logarithm of the probability of all that noise alone may be, but for a constant.
    pub(super) log_posterior: f64,
}

/// Candidates, asked of a recording.
pub(super) struct Candidates<'f> {
    pub(super) fitted: FittedModel<'f>,
    pub(super) cells: Vec<Cell>,
    pub(super) candidates: Vec<Candidate>,
    pub(super) atoms: Vec<Atom>,
    /// What the noise holds, and is told by itself.
    pub(super) of_noise: Vec<Cell>,
    /// Candidates that would have a size which they cannot have.
    pub(super) impossible: BTreeSet<usize>,
}

impl<'f> Candidates<'f> {
    pub(super) fn new(
        fitted: FittedModel<'f>,
        claimed: &Claimed,
        white: &Baseline,
    ) -> Candidates<'f> {
        let cells = catalogue::cells(&fitted);
        // Rounding that the noise holds is told by itself.
        let is_noise = |cell: &Cell| {
            readout::is_rounding(cell) && claimed.rounds(fitted.case(), &cell.words.y)
        };
        let (of_noise, cells): (Vec<Cell>, Vec<Cell>) = cells.into_iter().partition(is_noise);
        let (candidates, atoms) = question(&fitted, &cells, claimed, white);
        Candidates {
            fitted,
            cells,
            candidates,
            atoms,
            of_noise,
            impossible: BTreeSet::new(),
        }
    }

    /// Leaves out what would have a size that it cannot have.
    pub(super) fn leave_out(&mut self, impossible: &[usize]) {
        self.retain(|atom, _| !impossible.contains(&atom.candidate));
        self.impossible.extend(impossible);
    }

    /// Leaves out atoms.
    pub(super) fn leave_out_atoms(&mut self, atoms: &[usize]) {
        let mut numbers = 0..;
        self.atoms.retain(|_| {
            numbers
                .next()
                .is_some_and(|number| !atoms.contains(&number))
        });
    }

    /// Lets effects act where nothing bounds their sizes, if the model is one of deviations; whether any acted elsewhere before.
    pub(super) fn free(&mut self) -> bool {
        let fitted = &self.fitted;
        let Some(deviations) = Deviations::of(fitted) else {
            return false;
        };
        let variations = self.cells.iter_mut().flat_map(|cell| &mut cell.variants);
        let freed = variations.filter_map(|one| deviations.free(fitted, one).then_some(()));
        if freed.count() == 0 {
            return false;
        }
        for atom in &mut self.atoms {
            if let Shape::Columns(columns) = &mut atom.shape {
                let variation = &self.cells[atom.candidate].variants[atom.variant];
                *columns = variation.columns(fitted);
            }
        }
        true
    }

    /// Keeps some of the atoms.
    pub(super) fn retain(&mut self, mut keeps: impl FnMut(&mut Atom, &Cell) -> bool) {
        let cells = &self.cells;
        (self.atoms).retain_mut(|atom| keeps(atom, &cells[atom.candidate]));
    }

    /// Something of the model with the named effects in it, as it is fitted.
    pub(super) fn of_adopted<T>(
        &self,
        examination: &Examination,
        claimed: &Claimed,
        of: impl FnOnce(&Design<'_>, &Fit) -> T,
    ) -> T {
        match self.adopted_fit(examination, claimed) {
            Ok(Some((extended, fit))) => of(&Design::new(&extended.case), &fit),
            Ok(None) | Err(_) => of(self.fitted.design, self.fitted.fit),
        }
    }

    /// Adds what is known to be there, and not by its columns: its candidate and its atom.
    pub(super) fn add(&mut self, cell: Cell) -> (usize, usize) {
        let (number, atom) = (self.cells.len(), self.atoms.len());
        self.cells.push(cell);
        self.candidates.push(candidate(&self.cells, number));
        self.atoms.push(Atom {
            candidate: number,
            variant: 0,
            shape: Shape::Scatter,
            share: 1.0,
        });
        (number, atom)
    }

    /// Whether effects beat noise that is correlated, or that grows with the reading. `spreads` are the standard uncertainties that
    /// it may have, `found` the logarithm of the evidence for all effects that were found.
    ///
    /// # Errors
    /// When the recording does not determine the parameters.
    pub(super) fn against(
        &self,
        courses: &Courses,
        spreads: &[Claimed],
        settings: &evidence::Settings,
        found: f64,
    ) -> Result<NoiseAlone, Refusal> {
        let (design, fit) = (self.fitted.design, self.fitted.fit);
        let (mut seen, mut laws) = (Vec::new(), Vec::new());
        // Of the noise that is the same everywhere the scale wanders.
        let shifts = courses.of_kind(|memory| !memory.is_of_scale());
        for spread in spreads {
            let courses = if spread.is_spread_out() {
                &shifts
            } else {
                courses
            };
            let own = spread.laws(design, fit, courses);
            let first = seen.len();
            seen.extend(spread.seen_with(design, fit, &own)?);
            laws.push((spread, own, first..seen.len()));
        }
        let contest = evidence::contest(&seen, &self.candidates, &self.atoms, settings, found);
        let log_posterior = match contest.chance.p <= settings.alpha {
            true => &contest.with,
            false => &contest.alone,
        };
        let of = |range: &Range<usize>| &log_posterior[range.clone()];
        let most = |(_, _, range): &&_| evidence::maximum(of(range));
        let likeliest = (laws.iter()).max_by(|a, b| most(a).total_cmp(&most(b)));
        let claimed =
            likeliest.map(|(spread, laws, range)| spread.likeliest(design, fit, laws, of(range)));
        let claimed = claimed.unwrap_or_else(|| spreads[0].clone());
        Ok(NoiseAlone {
            chance: contest.chance,
            likeliest: match contest.chance.p <= settings.alpha {
                true => claimed,
                false => claimed.with_tails(design, fit),
            },
            log_posterior: evidence::log_sum(contest.alone.iter().copied()),
        })
    }

    /// Adds values about the parameters of strong effects; whether there are any that were not tried.
    pub(super) fn refine(&self, finer: &mut Finer, examination: &Examination) -> bool {
        let slots = examination.slots.iter();
        let firsts = slots.filter_map(|slot| slot.named.first());
        let mut new = false;
        for named in firsts.filter(|named| named.lambda >= CLEAR) {
            // The variant with two time constants has none between: one alone may do when it is the right one.
            let found = named.variants.iter().find_map(|variant| {
                let (cell, variation) = (self.cell(variant.atom), self.variation(variant.atom));
                variation.shape.is_some().then_some((cell, variation))
            });
            if let Some((cell, variation)) = found {
                new |= finer.add(cell, variation);
            }
        }
        new
    }

    /// What is asked of residuals.
    pub(super) fn question<'q>(
        &'q self,
        baseline: &'q Baseline,
        settings: &evidence::Settings,
    ) -> Question<'q> {
        Question {
            baseline,
            candidates: &self.candidates,
            atoms: &self.atoms,
            settings: settings.clone(),
        }
    }

    /// The cell of an atom.
    pub(super) fn cell(&self, atom: usize) -> &Cell {
        &self.cells[self.atoms[atom].candidate]
    }

    /// The variation of its cell that an atom is.
    pub(super) fn variation(&self, atom: usize) -> &Variation {
        &self.cell(atom).variants[self.atoms[atom].variant]
    }

    /// The refit with the named effects in the model; nothing where there are none, or where the equations cannot be written.
    pub(super) fn adopted_fit(
        &self,
        examination: &Examination,
        claimed: &Claimed,
    ) -> Result<Option<(adopt::Extended, Fit)>, NoFit> {
        let found = examination.fitted.as_ref();
        let found = found.filter(|found| !found.atoms.is_empty());
        found.map_or(Ok(None), |found| self.refitted(found, claimed))
    }

    /// The refit with effects in the model; nothing where the equations cannot be written.
    pub(super) fn refitted(
        &self,
        found: &Fitted,
        claimed: &Claimed,
    ) -> Result<Option<(adopt::Extended, Fit)>, NoFit> {
        let Some((mut extended, open)) = self.with_effects(found, claimed) else {
            return Ok(None);
        };
        // Levels within those of a parameter, such as runs of one specimen: what they have in common is the
        // parameter's.
        adopt::scattered(&mut extended, |effect| open.contains(&effect));
        let mut fit = refit(&self.fitted, &extended, claimed);
        if fit.is_err() {
            adopt::scattered(&mut extended, |_| true);
            fit = refit(&self.fitted, &extended, claimed);
        }
        Ok(Some((extended, fit?)))
    }

    /// The model with the named effects in it, and those of them that the recording does not determine.
    fn with_effects(
        &self,
        found: &Fitted,
        claimed: &Claimed,
    ) -> Option<(adopt::Extended, Vec<usize>)> {
        let fitted = &self.fitted;
        let baseline = baseline(fitted.design, fitted.fit, claimed).ok()?;
        let mut sizes = found.coefficients.as_slice();
        let mut effects = Vec::new();
        for atom in &found.atoms {
            let variation = self.variation(*atom);
            let (own, rest) = sizes.split_at_checked(variation.coefficients())?;
            effects.push(Free::of(fitted, &baseline, variation, own));
            sizes = rest;
        }
        let open = undetermined(fitted, &baseline, &effects);
        Some((adopt::extended(fitted, effects)?, open))
    }
}

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
    design: &Design<'_>,
    fit: &Fit,
    claimed: &Claimed,
) -> Result<Baseline, Refusal> {
    reduced(design, fit, &claimed.noise(design, fit))
}

/// Candidates, one for each cell, and atoms.
fn question(
    fitted: &FittedModel<'_>,
    cells: &[Cell],
    claimed: &Claimed,
    baseline: &Baseline,
) -> (Vec<Candidate>, Vec<Atom>) {
    let (mut candidates, mut atoms) = (Vec::new(), Vec::new());
    for (index, cell) in cells.iter().enumerate() {
        candidates.push(candidate(cells, index));
        let before = atoms.len();
        let (numbers, shapes): (Vec<usize>, Vec<Shape>) = (cell.variants.iter().enumerate())
            .filter_map(|(number, variation)| {
                let columns = variation.columns(fitted);
                Some((number, shape(columns, variation, claimed)?))
            })
            .unzip();
        let shown = showing(baseline, &shapes);
        let shapes = numbers.into_iter().zip(shapes).zip(shown);
        for ((number, shape), _) in shapes.filter(|(_, shown)| *shown) {
            atoms.push(Atom {
                candidate: index,
                variant: number,
                shape,
                share: cell.variants[number].weight,
            });
        }
        let whole: f64 = atoms[before..].iter().map(|atom| atom.share).sum();
        for atom in &mut atoms[before..] {
            atom.share /= whole;
        }
    }
    (candidates, atoms)
}

/// What the statistics know of a cell.
fn candidate(cells: &[Cell], index: usize) -> Candidate {
    let cell = &cells[index];
    Candidate {
        name: format!("{} {}", cell.effect.id, cell.words.x),
        family: cell.effect.family.clone(),
        place: cell.place.clone(),
        cause: cause(cells, index),
        repeats: cell.effect.repeats,
        describes: cell.effect.pattern.is_some(),
        happens: (cell.effect.pattern).is_some_and(|pattern| !pattern.recurs()),
        odds: cell.odds,
    }
}

/// The cell that stands for the cause of one: that of which it is another order, or itself.
fn cause(cells: &[Cell], index: usize) -> usize {
    let cell = &cells[index];
    let stands =
        |other: &Cell| cell.effect.order_of.contains(&other.effect.id) && other.place == cell.place;
    cells.iter().position(stands).unwrap_or(index)
}

/// Of which effects more than a trace is left beside the parameters. Less is what the curvature of the
/// model makes of an exact alias; it would take sizes that are out of the question. What has no visible
/// part at all is kept: it is listed as invisible.
fn showing<'s>(baseline: &Baseline, shapes: &'s [Shape]) -> Vec<bool> {
    const NOTHING: f64 = 1e-6;
    let named = |shape: &'s Shape| match shape {
        Shape::Columns(columns) => Some(columns),
        Shape::Smooth { .. } | Shape::Scatter => None,
    };
    let columns = shapes.iter().filter_map(named);
    let shares = baseline.visibilities(&evidence::side_by_side(baseline.rows(), columns));
    let mut shares = shares.into_iter();
    let shown = |shape: &'s Shape| {
        let width = named(shape).map_or(0, DMatrix::ncols);
        let most = shares.by_ref().take(width).fold(0.0, f64::max);
        !(NOTHING..TRACE).contains(&most)
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
        None => (columns.amax() > 0.0).then_some(Shape::Columns(columns)),
    }
}

/// Effects with coefficients that the recording does not determine beside the parameters and one another.
fn undetermined(fitted: &FittedModel<'_>, baseline: &Baseline, effects: &[Free]) -> Vec<usize> {
    let all = evidence::all(effects.iter().map(|free| free.variation.columns(fitted)));
    let kept = match all.is_empty() {
        true => Vec::new(),
        false => evidence::determined(baseline, &all),
    };
    let of = effects.iter().enumerate();
    let of = of.flat_map(|(at, own)| std::iter::repeat_n(at, own.variation.coefficients()));
    let open = of.enumerate().filter(|(at, _)| !kept.contains(at));
    open.map(|(_, effect)| effect).collect()
}

fn refit(
    fitted: &FittedModel<'_>,
    extended: &adopt::Extended,
    claimed: &Claimed,
) -> Result<Fit, NoFit> {
    let design = Design::new(&extended.case);
    let start = adopt::start(fitted, &design, &extended.effects);
    fit::near(&design, claimed.weights(), start)
}
