//! What effects cost that are not in the model and may be there all the same: a budget line for each.

use nalgebra::{DMatrix, DVector};

use super::candidates::Candidates;
use super::case::Role;
use super::catalogue::modifiers::{known, levels_of, range};
use super::catalogue::{Cell, FittedModel, Kind, Variation};
use super::declared_form;
use super::evidence::{self, Baseline, TRACE};
use super::typical;

/// An effect of the catalogue that is not in the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Omitted {
    /// Index of the candidate.
    pub cell: usize,
    /// Index of its variant that costs most.
    pub variation: usize,
    /// Share of it that the parameters do not absorb, 0 … 1.
    pub visibility: f64,
    /// Largest shift of the output that would not surprise, in its unit; `None` where nothing is known.
    pub shift: Option<f64>,
    /// What it does to the unknowns of the declared model.
    pub before: Cost,
    /// What it does with the adopted physics in the model; the same where nothing is adopted.
    pub after: Cost,
}

/// What an effect that is not in the model does to the unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// Change of each unknown for a largest shift of one.
    pub gain: Vec<f64>,
    /// Standard uncertainty that it adds to each unknown; zeros where no size is known.
    pub u: Vec<f64>,
}

impl Omitted {
    /// Whether the recording cannot show it.
    pub fn is_invisible(&self) -> bool {
        self.visibility < TRACE
    }

    /// What it costs most, as a multiple of the standard uncertainties without it: unknown and multiple.
    pub fn worst(&self, u: &[f64]) -> Option<(usize, f64)> {
        let of = self.after.u.iter().zip(u).enumerate();
        of.filter(|(_, (_, u))| **u > 0.0)
            .map(|(at, (line, u))| (at, line / u))
            .filter(|(_, ratio)| ratio.is_finite())
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Fewer variants of a candidate show what the rest would.
const VARIANTS: usize = 24;

/// The lines of all candidates but those in `adopted`, the dearest first. `u` holds the standard
/// uncertainties of the unknowns without them.
pub(super) fn lines(
    candidates: &Candidates<'_>,
    declared: &Baseline,
    improved: Option<&Baseline>,
    adopted: &[usize],
    u: &[f64],
) -> Vec<Omitted> {
    let (fitted, cells) = (&candidates.fitted, &candidates.cells);
    let scales = typical::full_scales(fitted);
    let line = |(index, number): (usize, usize), held: &[usize]| {
        let (cell, variation) = (&cells[index], &cells[index].variants[number]);
        let columns = variation.columns(fitted).remove_columns_at(held);
        let unified = typical::unified(columns)?;
        let shift = typical::shift(fitted, cell, variation, &unified, &scales);
        let unknowns = declared.parameters();
        let before = Cost::of(declared, &unified.columns, shift, unknowns);
        let after = improved.map(|one| Cost::of(one, &unified.columns, shift, unknowns));
        Some(Omitted {
            cell: index,
            variation: number,
            visibility: declared.visibility(&unified.columns),
            shift,
            after: after.unwrap_or_else(|| before.clone()),
            before,
        })
    };
    let others = cells.iter().enumerate();
    let mut every: Vec<Omitted> = others
        .filter(|(index, cell)| cell.effect.kind != Kind::Unnamed && !adopted.contains(index))
        .flat_map(|(index, cell)| {
            let step = cell.variants.len().div_ceil(VARIANTS).max(1);
            let variants = cell.variants.iter().enumerate().step_by(step);
            let variants = variants.filter(|(_, variation)| acts(fitted, cell, variation));
            variants.map(move |(number, _)| (index, number))
        })
        .filter_map(|place| line(place, &[]))
        .collect();
    // What the declared model has is not left out.
    let unseen = every.iter().filter(|line| line.is_invisible());
    let unseen: Vec<(usize, usize)> = unseen.map(|line| (line.cell, line.variation)).collect();
    let held = declared_form::declared(fitted, cells, &unseen);
    every = (every.into_iter())
        .filter_map(|own| match held.get(&(own.cell, own.variation)) {
            Some(held) => line((own.cell, own.variation), held),
            None => Some(own),
        })
        .collect();
    // Where no size is known, the variant that shows best.
    let dearest = |line: &Omitted| match line.shift {
        Some(_) => 1.0 + line.worst(u).map_or(0.0, |(_, ratio)| ratio),
        None => line.visibility,
    };
    let of_cell = every.chunk_by(|a, b| a.cell == b.cell);
    let most = |a: &&Omitted, b: &&Omitted| dearest(a).total_cmp(&dearest(b));
    let lines = of_cell.filter_map(|of| of.iter().max_by(most).cloned());
    let mut lines: Vec<Omitted> = lines.collect();
    lines.retain(|line| line.shift.is_some() || line.is_invisible());
    let dear = |line: &Omitted| line.worst(u).map_or(-1.0, |(_, ratio)| ratio);
    lines.sort_by(|a, b| dear(b).total_cmp(&dear(a)));
    lines
}

/// Whether a variation is an effect of something that varies: an offset is what parameters are for, and two
/// levels have no curvature.
fn acts(fitted: &FittedModel<'_>, cell: &Cell, variation: &Variation) -> bool {
    /// A modifier that varies by less than this part of its size is an offset.
    const VARIES: f64 = 0.2;
    let steady = |modifier: &[f64]| {
        let (least, most) = range(modifier);
        most - least < VARIES * most.abs().max(least.abs())
    };
    let case = fitted.case();
    let along = case.column(&cell.place.along);
    let stimulus = along.filter(|column| case.columns[*column].role == Role::Stimulus);
    let two = stimulus.is_some_and(|column| levels_of(fitted.numbers(column)).len() <= 2);
    let mut terms = variation.terms.iter();
    !two && !terms.all(|term| steady(&term.modifier.values))
}

impl Cost {
    /// Of columns that shift the output by one at most, and are known to shift it by no more than `shift`, on the first
    /// unknowns of a model.
    fn of(
        baseline: &Baseline,
        columns: &DMatrix<f64>,
        shift: Option<f64>,
        unknowns: usize,
    ) -> Cost {
        // Uniform between −shift and shift.
        let spread = shift.map(|shift| shift / 3.0_f64.sqrt());
        let u = spread.map(|spread| evidence::omitted(baseline, columns, spread));
        let u = u.unwrap_or_else(|| DVector::zeros(unknowns));
        // For each unknown that of the column that moves it most.
        let most = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
        let gain = baseline.gain(columns);
        let gain = (gain.row_iter().take(unknowns)).map(|row| row.iter().fold(0.0, most));
        Cost {
            gain: gain.collect(),
            u: u.iter().take(unknowns).copied().collect(),
        }
    }
}

/// What it costs that a slot has several explanations: for each unknown the root of Σ p·d², d being how
/// far the other explanations move it from where the adopted one leaves it.
pub(super) fn choice(
    candidates: &Candidates<'_>,
    declared: &Baseline,
    slot: &evidence::Slot,
) -> Vec<f64> {
    let moved = |alternative: &evidence::Alternative| -> Option<DVector<f64>> {
        let variation = candidates.variation(alternative.variants.first()?.atom);
        let columns = variation.columns(&candidates.fitted);
        let size = alternative.estimate.map(known);
        (columns.ncols() == size.len()).then(|| declared.gain(&columns) * size)
    };
    let mut squares = DVector::zeros(declared.parameters());
    let mut all = (slot.named.iter()).filter_map(|one| Some((one.probability, moved(one)?)));
    let Some((_, adopted)) = all.next() else {
        return squares.as_slice().to_vec();
    };
    for (probability, other) in all {
        squares += (other - &adopted).map(|d| probability * d * d);
    }
    squares.iter().map(|square: &f64| square.sqrt()).collect()
}
