//! Noise that differs from label to label: instruments, laboratories and operators that scatter more than others. A run that does
//! is none: it was another day of the same instrument, and something happened.
//!
//! Read from neighbours, as noise that grows is, but under each label by itself: what neighbours do not explain has one scale
//! for all labels of a column, or each label its own.

use gumption_core::special::chi_squared_sf;
use gumption_lanes::{level, sampler::gamma_block};
use nalgebra::DVector;

use super::case::{Data, Role};
use super::chance::numbers;
use super::design::Design;
use super::noise_growth::{DRAWS, Difference, INFORMATION, SHARED, differences, misfit, scale};

/// Level of the test of all columns together. Scatter that is missed costs false alarms, scatter in vain next to nothing.
const LEVEL: f64 = 0.01;
/// Fewer differences under one label tell nothing of its scale.
const LEAST: usize = 6;
/// Stream of the random numbers; those of labels follow it.
const STREAM: u64 = 0x1abe1;

/// How the noise of one response differs from label to label of a column.
#[derive(Debug, Clone, PartialEq)]
pub struct ByLabel {
    /// The column.
    pub column: String,
    /// Its unit, that of the response.
    pub unit: String,
    /// The least and the largest standard uncertainty of one row.
    pub range: [f64; 2],
}

/// Standard uncertainties of the blocks by label, up to a factor.
pub(super) struct Scales {
    pub column: usize,
    pub best: DVector<f64>,
    pub draws: Vec<DVector<f64>>,
}

/// The column whose labels scatter most unlike one another, where they do.
pub(super) fn estimate(
    design: &Design<'_>,
    values: &[f64],
    residuals: &DVector<f64>,
) -> Option<Scales> {
    let columns = design.case.columns.iter().enumerate();
    let labelled = columns.filter(|(_, column)| column.role == Role::Factor);
    let labelled: Vec<usize> = labelled.map(|(at, _)| at).collect();
    let tried = labelled.iter().filter_map(|column| {
        let column = *column;
        let Data::Labels(labels) = &design.case.columns[column].data else {
            return None;
        };
        let of_block = |block: usize| labels.of_row[design.blocks[block][0]] as usize;
        let mut groups = vec![Vec::new(); labels.levels.len()];
        (0..values.len()).for_each(|block| groups[of_block(block)].push(block));
        groups.retain(|group| !group.is_empty());
        let (p, scales) = of_groups(&groups, values, residuals, design.case.settings.seed)?;
        Some((p, Scales { column, ..scales }))
    });
    let (p, scales) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (p * labelled.len() as f64 <= LEVEL).then_some(scales)
}

/// The probability that groups with one scale are as unlike one another, and the scale of each.
fn of_groups(
    groups: &[Vec<usize>],
    values: &[f64],
    residuals: &DVector<f64>,
    seed: u64,
) -> Option<(f64, Scales)> {
    let squares = |differences: &[Difference]| -> Vec<f64> {
        differences.iter().map(|one| one.size * one.size).collect()
    };
    let all = squares(&differences(groups.to_vec(), values, residuals));
    let each = groups.iter().map(|group| {
        let own = squares(&differences(vec![group.clone()], values, residuals));
        (own.len() >= LEAST).then_some(own)
    });
    let each: Vec<Vec<f64>> = each.collect::<Option<_>>()?;
    let scales: Vec<f64> = each.iter().map(|own| scale(own)).collect();
    let apart = each
        .iter()
        .zip(&scales)
        .map(|(own, scale)| misfit(own, *scale));
    let gain = misfit(&all, scale(&all)) - apart.sum::<f64>();
    let p = chi_squared_sf(gain.max(0.0) / SHARED, (groups.len() as f64 - 1.0).max(1.0));
    let spread = |of: &dyn Fn(usize) -> f64| {
        let mut out = DVector::from_element(values.len(), 1.0);
        for (at, group) in groups.iter().enumerate() {
            group.iter().for_each(|block| out[*block] = of(at).sqrt());
        }
        out
    };
    // With ν degrees of freedom a scale may be ν/χ² times as large.
    let doubt = |at: usize| {
        let half = 0.5 * INFORMATION * each[at].len() as f64 / SHARED;
        let fill = |generator: &mut _, block: &mut _| gamma_block(level(), generator, half, block);
        let drawn = numbers(seed, STREAM + at as u64, DRAWS, fill);
        drawn
            .into_iter()
            .map(|gamma| half / gamma)
            .collect::<Vec<f64>>()
    };
    let doubts: Vec<Vec<f64>> = (0..each.len()).map(doubt).collect();
    let draw = |draw: usize| spread(&|at| scales[at] * doubts[at][draw]);
    let scales = Scales {
        column: 0,
        best: spread(&|at| scales[at]),
        draws: (0..DRAWS).map(draw).collect(),
    };
    Some((p, scales))
}

#[cfg(test)]
mod tests {
    use gumption_core::special::normal_quantile;

    use super::*;

    /// Three groups of twenty, the last of which scatters so many times as much.
    fn p(times: f64) -> (f64, Scales) {
        let groups: Vec<Vec<usize>> = (0..3).map(|g| (20 * g..20 * (g + 1)).collect()).collect();
        let error = |k: usize| normal_quantile((0.5 + ((k * 37) % 60) as f64) / 60.0);
        let of = |k: usize| error(k) * if k < 40 { 1.0 } else { times };
        let residuals = DVector::from_fn(60, |k, _| of(k));
        let values: Vec<f64> = (0..60).map(|k| (k % 20) as f64).collect();
        of_groups(&groups, &values, &residuals, 1).unwrap()
    }

    #[test]
    fn an_instrument_that_scatters_more_is_seen() {
        assert!(p(1.0).0 > 0.05);
        let (p, scales) = p(5.0);
        assert!(p < 1e-4);
        let ratio = scales.best[40] / scales.best[0];
        assert!((3.0..8.0).contains(&ratio), "{ratio}");
        let of = |draw: &DVector<f64>| draw[40] / draw[0];
        assert!(scales.draws.iter().any(|draw| of(draw) > ratio));
        assert!(scales.draws.iter().any(|draw| of(draw) < ratio));
    }
}
