//! What effects cost that are not in the model and may be there all the same: a budget line for each.

use nalgebra::{DMatrix, DVector};

use super::case::Case;
use super::catalogue::{Cell, Ground, Variation};
use super::evidence::{self, Baseline};
use super::fit;
use super::frame::Frame;
use super::noise::Claimed;
use super::run::{Adopted, baseline};
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
    /// Change of each unknown for a largest shift of one.
    pub gain: Vec<f64>,
    /// Standard uncertainty that it adds to each unknown of the declared model; zeros where no size is known.
    pub before: Vec<f64>,
    /// The same with the adopted physics in the model; that of the declared model where nothing is adopted.
    pub after: Vec<f64>,
}

impl Omitted {
    /// Whether the recording cannot show it.
    pub fn is_invisible(&self) -> bool {
        /// The curvature of the model makes as much of what it absorbs.
        const TRACE: f64 = 1e-4;
        self.visibility < TRACE
    }

    /// What it costs most, as a multiple of the standard uncertainties without it: unknown and multiple.
    pub fn worst(&self, u: &[f64]) -> Option<(usize, f64)> {
        let of = self.after.iter().zip(u).enumerate();
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
    ground: &Ground<'_>,
    cells: &[Cell],
    declared: &Baseline,
    improved: Option<&Baseline>,
    adopted: &[usize],
    u: &[f64],
) -> Vec<Omitted> {
    let scales = typical::full_scales(ground);
    let mut lines: Vec<Omitted> = cells
        .iter()
        .enumerate()
        .filter(|(index, cell)| cell.effect.family != "unnamed" && !adopted.contains(index))
        .filter_map(|(index, cell)| {
            let step = cell.variants.len().div_ceil(VARIANTS).max(1);
            let variants = cell.variants.iter().enumerate().step_by(step);
            let of = variants.filter_map(|(number, variation)| {
                let mut line = line(ground, cell, variation, (declared, improved), &scales)?;
                (line.cell, line.variation) = (index, number);
                Some(line)
            });
            let dear = |line: &Omitted| line.worst(u).map_or(-1.0, |(_, ratio)| ratio);
            of.max_by(|a, b| dear(a).total_cmp(&dear(b)))
        })
        .collect();
    lines.retain(|line| line.shift.is_some() || line.is_invisible());
    let dear = |line: &Omitted| line.worst(u).map_or(-1.0, |(_, ratio)| ratio);
    lines.sort_by(|a, b| dear(b).total_cmp(&dear(a)));
    lines
}

fn line(
    ground: &Ground<'_>,
    cell: &Cell,
    variation: &Variation,
    (declared, improved): (&Baseline, Option<&Baseline>),
    scales: &DVector<f64>,
) -> Option<Omitted> {
    let unified = typical::unified(variation.columns(ground))?;
    let columns = &unified.columns;
    let each = |j: usize| declared.visibility(&columns.column(j).into_owned());
    let visibility = (0..columns.ncols()).map(each).fold(1.0, f64::min);
    let shift = typical::shift(ground, cell, variation, &unified, scales);
    let unknowns = declared.parameters();
    let cost = |baseline: &Baseline| -> Vec<f64> {
        // Uniform between −shift and shift.
        let spread = shift.map(|shift| shift / 3.0_f64.sqrt());
        let u = spread.map(|spread| evidence::omitted(baseline, columns, spread));
        u.map_or(vec![0.0; unknowns], |u| {
            u.iter().take(unknowns).copied().collect()
        })
    };
    let before = cost(declared);
    Some(Omitted {
        cell: 0,
        variation: 0,
        visibility,
        shift,
        gain: largest(&declared.gain(columns)),
        after: improved.map_or_else(|| before.clone(), cost),
        before,
    })
}

/// For each unknown the gain of the column that moves it most.
fn largest(gain: &DMatrix<f64>) -> Vec<f64> {
    let most = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
    gain.row_iter()
        .map(|row| row.iter().fold(0.0, most))
        .collect()
}

/// The recording reduced to what the improved model leaves, its unknowns in the order of the declared
/// ones and then the adopted coefficients.
pub(super) fn improved_baseline(
    case: &Case,
    adopted: &Adopted,
    claimed: &Claimed,
) -> Option<Baseline> {
    let extended = &adopted.extended.case;
    let frame = Frame::new(extended);
    let estimates = adopted.unknowns.iter().chain(&adopted.coefficients);
    let value = |name: &str| {
        let found = estimates.clone().find(|estimate| estimate.name == name);
        found.map(|estimate| estimate.value)
    };
    let values: Option<Vec<f64>> = frame.unknowns.iter().map(|u| value(&u.name)).collect();
    let mut fit = fit::at(&frame, DVector::from_vec(values?));
    let declared = Frame::new(case);
    let known = declared.unknowns.iter().map(|u| u.name.as_str());
    let added = adopted.coefficients.iter().map(|c| c.name.as_str());
    let order: Option<Vec<usize>> = known
        .chain(added)
        .map(|name| frame.unknowns.iter().position(|u| u.name == name))
        .collect();
    let order = order?;
    let mut frame = frame;
    frame.unknowns = order.iter().map(|at| frame.unknowns[*at].clone()).collect();
    fit.jacobian = fit.jacobian.select_columns(&order);
    fit.unknowns = fit.unknowns.select_rows(&order);
    baseline(&frame, &fit, claimed).ok()
}
