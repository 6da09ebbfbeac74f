//! What is asked of a recording: candidates as columns, the recording as residuals, and the effects that were
//! found in the model.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use gumption_core::special::f_sf;
use nalgebra::{DMatrix, DVector};

use super::adopt::{self, Free};
use super::case::{Case, Observed};
use super::catalogue::{self, Cell, Finer, FittedModel, Node, Term, Variation};
use super::design::Design;
use super::evidence::{
    self, Atom, Baseline, Candidate, Examination, Fitted, Question, Refusal, Shape, TRACE,
};
use super::failure::Failure;
use super::fit::{self, Fit, NoFit};
use super::noise::{self, Claimed};
use super::noise_correlation::Courses;
use super::reduced::reduced;

/// λ from which on it matters that the parameter of an effect lies between the steps of its grid.
const CLEAR: f64 = 15.0;

/// Candidates, asked of a recording.
pub(super) struct Candidates<'f> {
    pub(super) fitted: FittedModel<'f>,
    pub(super) cells: Vec<Cell>,
    pub(super) candidates: Vec<Candidate>,
    pub(super) atoms: Vec<Atom>,
    /// Cell and variation of each atom.
    pub(super) places: Vec<(usize, usize)>,
}

/// The refit with the named effects in the model; nothing where there are none, or where the equations cannot be written.
pub(super) type Refit = Result<Option<(adopt::Extended, Fit)>, NoFit>;

impl<'f> Candidates<'f> {
    pub(super) fn new(
        fitted: FittedModel<'f>,
        claimed: &Claimed,
        white: &Baseline,
    ) -> Candidates<'f> {
        let cells = catalogue::cells(&fitted);
        let (candidates, atoms, places) = question(&fitted, &cells, claimed, white);
        Candidates {
            fitted,
            cells,
            candidates,
            atoms,
            places,
        }
    }

    /// Effects that are seen with a size which they cannot have are something else: without them, again.
    pub(super) fn ask(
        &mut self,
        claimed: &Claimed,
        settings: &evidence::Settings,
        progress: &dyn Fn(f64) -> ControlFlow<()>,
    ) -> Result<(Baseline, Examination), Failure> {
        let baseline = baseline(self.fitted.design, self.fitted.fit, claimed)?;
        loop {
            let question = Question {
                baseline: &baseline,
                candidates: &self.candidates,
                atoms: &self.atoms,
                settings: settings.clone(),
            };
            let examination = evidence::examine(&question, progress)?;
            let mut missized = self.missized(&examination);
            if missized.is_empty() {
                missized = self.shrinking(&examination, claimed, settings.alpha);
            }
            if missized.is_empty() {
                return Ok((baseline, examination));
            }
            self.retain(|atom, _| !missized.contains(&atom.candidate));
        }
    }

    /// Keeps some of the atoms.
    pub(super) fn retain(&mut self, mut keeps: impl FnMut(&mut Atom, &Cell) -> bool) {
        let places = std::mem::take(&mut self.places).into_iter();
        let mut places = places.map(|place| (place, &self.cells[place.0]));
        let mut kept = Vec::new();
        self.atoms.retain_mut(|atom| {
            let place = places.next().filter(|(_, cell)| keeps(atom, cell));
            kept.extend(place.map(|(place, _)| place));
            place.is_some()
        });
        self.places = kept;
    }

    /// Candidates that make the residuals of a constant smaller by making the constant smaller. Residuals of a constant that the model
    /// should give, such as a norm, are in units of what is left of it: in these they have to become smaller, or nothing is explained.
    fn shrinking(&self, examination: &Examination, claimed: &Claimed, alpha: f64) -> Vec<usize> {
        let fitted = &self.fitted;
        let [response] = fitted.case().responses.as_slice() else {
            return Vec::new();
        };
        let Observed::Constant(constant) = response.observed else {
            return Vec::new();
        };
        let acts = |term: &Term| matches!(term.node, Node::Output | Node::Gain);
        let named = examination.slots.iter().filter_map(|slot| {
            let named = slot.named.first()?;
            let variation = self.variation(named.variants.first()?.atom);
            let acts = variation.terms.iter().all(acts);
            acts.then(|| (named.candidate, variation.columns(fitted)))
        });
        let (named, columns): (Vec<usize>, Vec<DMatrix<f64>>) = named.unzip();
        let columns = evidence::all(columns.into_iter());
        if columns.is_empty() {
            return Vec::new();
        }
        let rows = columns.nrows();
        let model = fitted.fit.jacobian.rows(0, rows).into_owned();
        let (residuals, u) = (fitted.fit.residuals.rows(0, rows), claimed.u.rows(0, rows));
        let explains = is_explained(
            &residuals.into_owned(),
            &u.into_owned(),
            [&model, &columns],
            constant,
            alpha,
        );
        if explains { Vec::new() } else { named }
    }

    /// The noise that is left when the named effects are in the model.
    pub(super) fn noise(
        &self,
        examination: &Examination,
        claimed: &Claimed,
        courses: Option<&Courses>,
    ) -> Claimed {
        let left = |design: &Design<'_>, fit: &Fit| noise::refined(design, fit, claimed, courses);
        match self.adopted_fit(examination, claimed) {
            Ok(Some((extended, fit))) => left(&Design::new(&extended.case), &fit),
            Ok(None) | Err(_) => left(self.fitted.design, self.fitted.fit),
        }
    }

    /// Whether effects beat noise that is correlated, or that grows with the reading: the probability that they gain as much
    /// by noise alone, and the noise as it is then, without effects where these do not, else with the best one. `spreads` are
    /// the standard uncertainties that it may have.
    ///
    /// # Errors
    /// When the recording does not determine the parameters.
    pub(super) fn against(
        &self,
        courses: &Courses,
        spreads: &[Claimed],
        settings: &evidence::Settings,
    ) -> Result<(f64, Claimed), Refusal> {
        let (design, fit) = (self.fitted.design, self.fitted.fit);
        let seen = spreads
            .iter()
            .map(|spread| courses.seen(design, fit, &|correlated| spread.noise_with(correlated)));
        let seen = seen.collect::<Result<Vec<_>, _>>()?.concat();
        let contest = evidence::contest(&seen, &self.candidates, &self.atoms, settings)?;
        let log_posterior = match contest.p <= settings.alpha {
            true => &contest.with,
            false => &contest.alone,
        };
        let each = log_posterior.chunks(seen.len() / spreads.len());
        let most = |of: &[f64]| of.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let likeliest = (spreads.iter().zip(each)).max_by(|a, b| most(a.1).total_cmp(&most(b.1)));
        let claimed = likeliest.map(|(spread, own)| Claimed {
            correlated: courses.likely(own),
            ..spread.clone()
        });
        Ok((contest.p, claimed.unwrap_or_else(|| spreads[0].clone())))
    }

    /// What is found when noise and effects are estimated in turn, from this noise on and what is found with it, and the noise
    /// in the end.
    ///
    /// # Errors
    /// When the work was stopped.
    pub(super) fn in_turn(
        &mut self,
        mut claimed: Claimed,
        (mut baseline, mut examination): (Baseline, Examination),
        settings: &evidence::Settings,
        courses: Option<&Courses>,
        progress: &dyn Fn(f64) -> ControlFlow<()>,
    ) -> Result<(Baseline, Examination, Claimed), Failure> {
        /// So often.
        const ROUNDS: u8 = 3;
        for _ in 0..ROUNDS {
            let atoms = |of: &Examination| of.fitted.as_ref().map(|fitted| fitted.atoms.clone());
            let before = atoms(&examination);
            let then = self.noise(&examination, &claimed, courses);
            if then == claimed {
                break;
            }
            claimed = then;
            (baseline, examination) = self.ask(&claimed, settings, progress)?;
            if atoms(&examination) == before {
                break;
            }
        }
        Ok((baseline, examination, claimed))
    }

    /// Adds values about the parameters of strong effects; whether there are any that were not tried.
    pub(super) fn refine(&self, finer: &mut Finer, examination: &Examination) -> bool {
        let strong = (examination.slots.iter())
            .filter_map(|slot| slot.named.first())
            .filter(|named| named.lambda >= CLEAR);
        let mut new = false;
        for named in strong {
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

    /// The cell of an atom.
    pub(super) fn cell(&self, atom: usize) -> &Cell {
        &self.cells[self.places[atom].0]
    }

    /// The variation of its cell that an atom is.
    pub(super) fn variation(&self, atom: usize) -> &Variation {
        &self.cell(atom).variants[self.places[atom].1]
    }

    /// The refit with the named effects in the model.
    pub(super) fn adopted_fit(&self, examination: &Examination, claimed: &Claimed) -> Refit {
        let found = examination.fitted.as_ref();
        let Some(found) = found.filter(|found| !found.atoms.is_empty()) else {
            return Ok(None);
        };
        let Some((mut extended, open)) = self.with_effects(found, claimed) else {
            return Ok(None);
        };
        // Levels within those of a parameter, such as runs of one specimen: what they have in common is the
        // parameter's.
        adopt::scattered(&mut extended, |effect| open.contains(&effect));
        if let Ok(fit) = refit(&self.fitted, &extended, claimed) {
            return Ok(Some((extended, fit)));
        }
        adopt::scattered(&mut extended, |_| true);
        let fit = refit(&self.fitted, &extended, claimed)?;
        Ok(Some((extended, fit)))
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

    /// Candidates that would have to have a size here which they cannot have: a reversal that is not complete, a change of
    /// the scale that leaves nothing of the response.
    fn missized(&self, examination: &Examination) -> Vec<usize> {
        let named = examination.slots.iter().flat_map(|slot| &slot.named);
        let wrong = named.filter(|named| {
            let effect = self.cells[named.candidate].effect;
            let sizes = named.estimate.iter().enumerate();
            let is_other = sizes
                .map(|(at, size)| (*size, named.covariance[(at, at)].max(0.0).sqrt()))
                .any(|(size, u)| !effect.admits(size, u));
            let takes_all = || {
                let first = named.variants.first();
                first.is_some_and(|first| {
                    let variation = self.variation(first.atom);
                    let (sizes, rows) = (named.estimate.as_slice(), self.fitted.rows());
                    takes_all(variation, sizes, rows) && !is_left(&self.fitted, variation, sizes)
                })
            };
            is_other || (effect.exact.is_none() && takes_all())
        });
        wrong.map(|named| named.candidate).collect()
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
    reduced(design, fit, &claimed.noise())
}

/// Candidates and atoms, and the cell and variation of each atom.
fn question(
    fitted: &FittedModel<'_>,
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
            cause: cause(cells, index),
            typical: cell.typical,
            repeats: cell.effect.repeats,
            describes: cell.effect.pattern.is_some(),
            odds: cell.odds,
        });
        let before = atoms.len();
        let shapes: Vec<(usize, Shape)> = (cell.variants.iter().enumerate())
            .filter_map(|(number, variation)| {
                let columns = variation.columns(fitted);
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

/// Effects with coefficients that the recording does not determine beside the parameters and one another.
fn undetermined(fitted: &FittedModel<'_>, baseline: &Baseline, effects: &[Free]) -> Vec<usize> {
    let columns: Vec<DMatrix<f64>> = (effects.iter())
        .map(|free| free.variation.columns(fitted))
        .collect();
    let all: Vec<_> = columns.iter().flat_map(|own| own.column_iter()).collect();
    if all.is_empty() {
        return Vec::new();
    }
    let kept = evidence::determined(baseline, &DMatrix::from_columns(&all));
    let of = columns.iter().enumerate();
    let of = of.flat_map(|(effect, own)| std::iter::repeat_n(effect, own.ncols()));
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
    fit::near(&design, &claimed.u, start)
}

/// Whether effects on a constant explain residuals: whether these, in units of what the effects leave of the constant, become smaller than by
/// chance. `model` and `effects` are derivatives.
fn is_explained(
    residuals: &DVector<f64>,
    u: &DVector<f64>,
    [model, effects]: [&DMatrix<f64>; 2],
    constant: f64,
    alpha: f64,
) -> bool {
    let before = residuals.component_div(u).norm_squared();
    let (parameters, sizes) = (model.ncols(), effects.ncols());
    let all = evidence::all([model, effects].into_iter().cloned());
    let over_noise = DMatrix::from_fn(all.nrows(), all.ncols(), |row, at| all[(row, at)] / u[row]);
    let found = evidence::inverse(&over_noise) * residuals.component_div(u);
    let left = effects * found.rows(parameters, sizes);
    let rest = residuals - &all * &found;
    let in_units = |row: usize| rest[row] / u[row] * constant / (constant - left[row]);
    let after: f64 = (0..rest.len()).map(|row| in_units(row).powi(2)).sum();
    let free = rest.len().saturating_sub(all.ncols()).max(1) as f64;
    let gain = (before - after) / sizes as f64 / (after / free);
    f_sf(gain.max(0.0), sizes as f64, free) < alpha
}

/// Whether sizes leave nothing of a response in some row: a relative change of its scale of −1 or beyond.
fn takes_all(variation: &Variation, sizes: &[f64], rows: usize) -> bool {
    let changes = changes_of_scale(variation, sizes, rows);
    changes.values().flatten().any(|change| *change <= -1.0)
}

/// The relative change of the scale of each response, or of all, row by row.
fn changes_of_scale(
    variation: &Variation,
    sizes: &[f64],
    rows: usize,
) -> BTreeMap<Option<usize>, Vec<f64>> {
    let mut changes = BTreeMap::new();
    let mut coefficient = 0;
    for (number, term) in variation.terms.iter().enumerate() {
        coefficient += usize::from(number > 0 && !term.tied);
        let size = sizes
            .get(coefficient)
            .copied()
            .filter(|size| size.is_finite());
        if let (Node::Gain, Some(size)) = (term.node, size) {
            let change = changes
                .entry(term.response)
                .or_insert_with(|| vec![0.0; rows]);
            for (change, x) in change.iter_mut().zip(term.modifier.values.iter()) {
                *change += size * x;
            }
        }
    }
    changes
}

/// Whether something is left of every response after all: sizes are parts of the signal of the declared model, which rows in another
/// unit have bent; what it is beside them decides.
fn is_left(fitted: &FittedModel<'_>, variation: &Variation, sizes: &[f64]) -> bool {
    if variation.coefficients() != sizes.len() {
        return false;
    }
    let known = |r: f64| if r.is_finite() { r } else { 0.0 };
    let rest =
        &fitted.fit.residuals - variation.columns(fitted) * DVector::from_column_slice(sizes);
    let moved = evidence::inverse(&fitted.fit.jacobian) * rest.map(known);
    let changes = changes_of_scale(variation, sizes, fitted.rows());
    let of = |only: &Option<usize>| match only {
        Some(response) => *response..response + 1,
        None => 0..fitted.case().responses.len(),
    };
    changes.iter().all(|(only, changes)| {
        of(only).all(|response| {
            let signal = fitted.signal(response);
            let beside = fitted.signal_moved(response, &moved);
            let mut rows = changes.iter().zip(signal).zip(&beside);
            rows.all(|((change, signal), beside)| {
                *change * signal == 0.0 || change * signal / beside > -1.0
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::super::catalogue::Modifier;
    use super::*;

    /// The norm of a magnetometer with a scale that is free: a step from row 4 on goes with the scale, and both take the residuals with them. A
    /// step in the middle is seen.
    #[test]
    fn what_only_makes_a_constant_smaller_explains_nothing() {
        let noise = |row: usize| 0.1 * libm::sin(7.3 * row as f64);
        let judged = |from: usize, size: f64| {
            let step = DMatrix::from_fn(60, 1, |row, _| if row >= from { 1.0 } else { 0.0 });
            let signal = DVector::from_fn(60, |row, _| 1.0 + noise(row) + size * step[row]);
            let scale = signal.dot(&DVector::from_element(60, 1.0)) / signal.norm_squared();
            let residuals = signal.map(|x| 1.0 - scale * x);
            let model = DMatrix::from_columns(&[signal]);
            let u = DVector::from_element(60, 0.1);
            is_explained(&residuals, &u, [&model, &step], 1.0, 0.01)
        };
        assert!(!judged(3, 0.0));
        assert!(!judged(30, 0.0));
        assert!(judged(30, 0.3));
    }

    #[test]
    fn a_scale_that_is_taken_away_is_no_effect() {
        let step = |node: Node| {
            let modifier = Modifier::number(vec![0.0, 0.0, 1.0], "from row 3 on");
            Variation::one("", Term::new(node, modifier))
        };
        assert!(takes_all(&step(Node::Gain), &[-1.0], 3));
        assert!(!takes_all(&step(Node::Gain), &[-0.5], 3));
        assert!(!takes_all(&step(Node::Output), &[-3.0], 3));
        // Each response has a scale of its own.
        let half = |response: usize| step(Node::Gain).terms[0].clone().on(response);
        let both = Variation::of("", vec![half(0), half(1)]);
        assert!(!takes_all(&both, &[-0.6, -0.6], 3));
    }
}
