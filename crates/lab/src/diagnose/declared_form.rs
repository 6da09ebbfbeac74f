//! Whether the declared model has an effect already: by its form, and not by the design of the recording.
//!
//! What the declared parameters absorb at the recorded inputs they may absorb because these are few or follow
//! one another; it is left out all the same. At arbitrary inputs they reproduce an effect only where the model
//! has a term of its form: the square of a temperature beside a declared one.

use std::collections::BTreeMap;

use gumption_lanes::level;
use nalgebra::DMatrix;

use super::case::{Blocks, Case, Role, Rows};
use super::catalogue::modifiers::{map, range};
use super::catalogue::{self, Cell, FittedModel};
use super::design::Design;
use super::fit;
use super::{chance, evidence};

/// Part of the recorded range by which inputs go beyond it.
const BEYOND: f64 = 0.2;
/// Share of an effect that numbers of sixteen digits leave where the model has it.
const ROUNDING: f64 = 1e-12;

/// Columns of variations, given as cell and variation, that the declared model has already.
pub(super) fn declared(
    fitted: &FittedModel<'_>,
    cells: &[Cell],
    wanted: &[(usize, usize)],
) -> BTreeMap<(usize, usize), Vec<usize>> {
    if wanted.is_empty() {
        return BTreeMap::new();
    }
    let case = elsewhere(fitted);
    let design = Design::new(&case);
    let fit = fit::at(&design, fitted.fit.unknowns.clone());
    let there = FittedModel::new(&design, &fit).refined(fitted.finer.clone());
    let others = catalogue::cells(&there);
    let of = wanted.iter().filter_map(|(cell, variation)| {
        let own = &cells[*cell];
        let same = |other: &&Cell| other.is(own) && other.place == own.place;
        let label = &own.variants[*variation].label;
        let variants = &others.iter().find(same)?.variants;
        let form = variants.iter().find(|variant| variant.label == *label)?;
        let held = held(&fit.jacobian, &form.columns(&there));
        (!held.is_empty()).then_some(((*cell, *variation), held))
    });
    of.collect()
}

/// Columns that others reproduce, as far as both are finite.
fn held(others: &DMatrix<f64>, columns: &DMatrix<f64>) -> Vec<usize> {
    let finite = |matrix: &DMatrix<f64>, row: usize| matrix.row(row).iter().all(|x| x.is_finite());
    let rows: Vec<usize> = (0..columns.nrows())
        .filter(|row| finite(others, *row) && finite(columns, *row))
        .collect();
    if rows.len() <= others.ncols() {
        return Vec::new();
    }
    let left = evidence::left_beside(&columns.select_rows(&rows), &others.select_rows(&rows));
    (0..left.len())
        .filter(|column| left[*column] < ROUNDING)
        .collect()
}

/// The case with inputs that nothing ties to one another, within its range and somewhat beyond.
fn elsewhere(fitted: &FittedModel<'_>) -> Case {
    /// Rows for each unknown, and at least.
    const EACH: usize = 8;
    const LEAST: usize = 200;
    /// The same inputs for every case.
    const SEED: u64 = 1;
    let case = fitted.case();
    let count = (EACH * fitted.design.unknowns.len()).max(LEAST);
    let data = case.columns.iter().enumerate().map(|(at, column)| {
        let shares = chance::numbers(SEED, at as u64, count, |generator, block| {
            generator.uniforms(level(), block);
        });
        let numbers = |numbers: &[f64]| match column.role {
            Role::Stimulus | Role::Covariate | Role::Angle => spread(numbers, &shares),
            Role::Time | Role::Order => {
                let mut times = spread(numbers, &shares);
                times.sort_by(f64::total_cmp);
                times
            }
            _ => numbers.iter().copied().cycle().take(count).collect(),
        };
        (column.data).map(numbers, |labels| scattered(labels.levels.len(), &shares))
    });
    let rows = Rows {
        count,
        data: data.collect(),
    };
    let mut case = case.with(&rows);
    case.averaging.blocks = Blocks::Rows;
    case.averaging.settle = 0;
    case
}

/// Numbers over the range of others; what is nowhere negative stays so.
fn spread(numbers: &[f64], shares: &[f64]) -> Vec<f64> {
    let (least, most) = range(numbers);
    let beyond = BEYOND * (most - least);
    let floor = if least >= 0.0 {
        0.5 * least
    } else {
        f64::NEG_INFINITY
    };
    let (low, high) = ((least - beyond).max(floor), most + beyond);
    map(shares, |share| low + share * (high - low))
}

/// Every level once, and then as it comes.
fn scattered(levels: usize, shares: &[f64]) -> Vec<u32> {
    let level = |(row, share): (usize, &f64)| {
        let drawn = (share * levels as f64) as usize;
        (if row < levels { row } else { drawn }) as u32
    };
    shares.iter().enumerate().map(level).collect()
}
