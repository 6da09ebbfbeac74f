//! Where the mismatch sits: a scan of quantities of the model against levels of factors.
//!
//! Maps of raw residuals mislead, because the fit of the parameters smears a local disturbance over
//! all rows. Here each cell, such as "angle, at head angle 210°", is a disturbance with an effect of its
//! own, projected like any other.

use gumption_fault::Said;
use nalgebra::{DMatrix, DVector};

use super::baseline::Baseline;
use super::closed_form::Scale;
use super::directions::INVISIBLE;
use super::null::{Laws, Null};
use super::question::Settings;
use crate::diagnose::parallel::side_by_side;

/// Stage of the random numbers, apart from those of the gate.
const STAGE: u64 = 0x1_0000_0001;

/// A disturbance of one quantity of the model at one level of one factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Quantity of the model: "bias", "scale", "angle" …
    pub node: String,
    /// What the level is a level of: "position", "run", "direction", "axis", "time span" …
    pub factor: Said,
    /// The level: "210°", "2", "CW" …
    pub level: Said,
    /// n derivatives of the output by the disturbance; zero in the rows of other levels.
    pub column: DVector<f64>,
}

/// How a cell stands out.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// Index of the cell.
    pub cell: usize,
    /// Estimate of the disturbance.
    pub size: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// By how much χ² falls when the disturbance is adopted.
    pub chi_squared: f64,
    /// Probability that the strongest of all cells would stand out as much if there were no disturbance.
    pub p: f64,
}

/// An effect of less than this share of the greatest of its kind is rounding.
const ROUNDING: f64 = 1e-9;

/// The cells that the recording can show, the one that stands out most first.
pub fn locate(baseline: &Baseline, cells: &[Cell], settings: &Settings) -> Vec<Located> {
    let mut columns = DMatrix::zeros(baseline.rows(), cells.len());
    for (mut column, cell) in columns.column_iter_mut().zip(cells) {
        column.copy_from(&cell.column);
    }
    let (mut seen, whole) = baseline.visible(&columns);
    let lengths: Vec<f64> = seen.column_iter().map(|c| c.norm_squared()).collect();
    let most: Vec<f64> = cells.iter().map(|cell| cell.column.amax()).collect();
    let visible: Vec<usize> = (0..cells.len())
        .filter(|c| lengths[*c] > INVISIBLE * whole[*c] * whole[*c] && excited(cells, &most, *c))
        .collect();
    for cell in &visible {
        seen.column_mut(*cell)
            .scale_mut(1.0 / lengths[*cell].sqrt());
    }
    let seen = seen.select_columns(&visible);
    let components = seen.tr_mul(baseline.residuals());
    // With a known scale nothing is added.
    let scale = scale(baseline, baseline.chi_squared(), baseline.scale_dof());
    let null = simulated(baseline, &seen, settings);
    let of = |(cell, component): (&usize, &f64)| {
        let chi_squared = component * component;
        let above = null
            .iter()
            .filter(|top| **top >= chi_squared / scale)
            .count();
        Located {
            cell: *cell,
            size: component / lengths[*cell].sqrt(),
            u: (scale / lengths[*cell]).sqrt(),
            chi_squared,
            p: (1 + above) as f64 / (1 + null.len()) as f64,
        }
    };
    let mut located: Vec<Located> = visible.iter().zip(&components).map(of).collect();
    located.sort_by(|a, b| b.chi_squared.total_cmp(&a.chi_squared));
    located
}

/// Whether a cell has an effect beside those of the same quantity at other levels: cos 90° is not quite
/// zero in a computer.
fn excited(cells: &[Cell], most: &[f64], cell: usize) -> bool {
    let all = cells.iter().zip(most);
    let same = all.filter(|(other, _)| other.node == cells[cell].node);
    let greatest = same.map(|(_, most)| *most).fold(0.0, f64::max);
    most[cell] > ROUNDING * greatest
}

/// The greatest statistic of all cells in simulated recordings without a disturbance.
fn simulated(baseline: &Baseline, seen: &DMatrix<f64>, settings: &Settings) -> Vec<f64> {
    let null = Null::new(baseline, Laws::of(baseline), settings.seed, STAGE);
    let chunks = settings.draws.div_ceil(gumption_lanes::LANES).max(1);
    let each = side_by_side(chunks, |index| {
        let recordings = null.along(index, seen);
        let each = recordings.components.row_iter().enumerate();
        let most = each.map(|(lane, components)| {
            let chi_squared = recordings.chi_squared()[lane];
            components.amax().powi(2) / scale(baseline, chi_squared, recordings.offsets[lane])
        });
        most.collect::<Vec<f64>>()
    });
    each.concat()
}

/// The variance that components are compared with: 1 if the noise is known.
fn scale(baseline: &Baseline, chi_squared: f64, offset: f64) -> f64 {
    match Scale::new(baseline.dof(), baseline.scale_dof()) {
        Scale::Known => 1.0,
        Scale::Estimated { total } => (chi_squared + offset) / total,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::fixture::Tumble;
    use super::*;

    /// Twelve positions, bias and scale fitted: an angle error at one position is found there, although
    /// the fit smears it.
    #[test]
    fn a_local_disturbance_is_found_in_its_cell() {
        let tumble = Tumble::new(12, &[0.0; 3]);
        // With the rounding of cos 90°.
        let at = |row: usize, slope: fn(f64) -> f64| slope((row % 12) as f64 * PI / 6.0);
        let node = |name: &str, level: usize, slope: fn(f64) -> f64| Cell {
            node: name.into(),
            factor: Said::quoted("position"),
            level: Said::quoted((level * 30).to_string()),
            column: DVector::from_fn(36, |row, _| match row % 12 == level {
                true => at(row, slope),
                false => 0.0,
            }),
        };
        let cells = (0..12).flat_map(|k| [node("bias", k, |_| 1.0), node("angle", k, f64::cos)]);
        let cells: Vec<Cell> = cells.collect();
        let cell = |node: &str, level: &str| {
            let is_it = |cell: &Cell| cell.node == node && cell.level == Said::quoted(level);
            cells.iter().position(is_it).unwrap()
        };
        let truth = cell("bias", "210");
        let residuals = DVector::from_fn(36, |row, _| match row % 12 == 7 {
            true => 5.0,
            false => 0.1 * (row as f64 * 1.7).sin(),
        });
        let baseline = tumble.baseline_of(&residuals);
        let settings = Settings {
            draws: 512,
            ..Settings::default()
        };
        let located = locate(&baseline, &cells, &settings);
        // The angle cell of the same position is the same column but for its unit.
        let same = |cell: usize| cells[cell].level == Said::quoted("210");
        assert!(same(located[0].cell) && same(located[1].cell));
        let found = located.iter().find(|l| l.cell == truth).unwrap();
        assert!((found.size - 5.0).abs() < 0.1 && (found.u - (1.0_f64 / 3.0).sqrt()).abs() < 0.2);
        assert!(found.p < 0.003);
        let idle = cell("angle", "90");
        assert!(located.iter().all(|l| l.cell != idle));
    }
}
