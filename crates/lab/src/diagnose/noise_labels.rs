//! Noise that differs from label to label: instruments, laboratories and operators that scatter more than others. A run that does
//! is none: it was another day of the same instrument, and something happened.
//!
//! Read from neighbours, as noise that grows is, but under each label by itself: what neighbours do not explain has one scale
//! for all labels of a column, or each label its own.

use gumption_core::special::chi_squared_sf;
use gumption_lanes::{level, sampler::gamma_block};
use nalgebra::DVector;

use super::case::Role;
use super::catalogue::modifiers::range;
use super::chance::numbers;
use super::design::Design;
use super::noise_growth::{DRAWS, INFORMATION, SHARED, differences, misfit, scale};

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
    /// The unit of the response.
    pub unit: String,
    /// Standard uncertainty of one row, as the mean over the rows; where it grows too, at the root mean square of the modelled values.
    pub mean: f64,
    /// The labels that occur, each with its standard uncertainty over that mean.
    pub factors: Vec<(String, f64)>,
}

impl ByLabel {
    /// The least and the largest factor.
    pub fn range(&self) -> [f64; 2] {
        let factors: Vec<f64> = self.factors.iter().map(|(_, factor)| *factor).collect();
        range(&factors).into()
    }
}

/// Standard uncertainties of the blocks by label, up to a factor.
pub(super) struct Scales {
    pub column: usize,
    /// Of each label that occurs.
    pub labels: Vec<(String, f64)>,
    pub best: DVector<f64>,
    pub draws: Vec<DVector<f64>>,
}

/// The column whose labels scatter most unlike one another, where they do; neighbours are those along a course.
pub(super) fn estimate(
    design: &Design<'_>,
    course: &[f64],
    residuals: &DVector<f64>,
) -> Option<Scales> {
    let columns = design.case.columns.iter().enumerate();
    let labelled = columns.filter(|(_, column)| column.role == Role::Factor);
    let labelled: Vec<usize> = labelled.map(|(at, _)| at).collect();
    let tried = labelled.iter().filter_map(|column| {
        let groups = groups(design, *column)?;
        let blocks: Vec<&[usize]> = groups.iter().map(|(_, blocks)| &blocks[..]).collect();
        let apart = Apart::of(&blocks, course, residuals, design.case.settings.seed)?;
        Some((*column, groups, apart))
    });
    let (column, groups, apart) = tried.min_by(|a, b| a.2.p.total_cmp(&b.2.p))?;
    let spread = |of: &[f64]| {
        let mut out = DVector::zeros(course.len());
        for ((_, blocks), u) in groups.iter().zip(of) {
            blocks.iter().for_each(|block| out[*block] = *u);
        }
        out
    };
    (apart.p * labelled.len() as f64 <= LEVEL).then(|| Scales {
        column,
        best: spread(&apart.u),
        draws: apart.draws.iter().map(|draw| spread(draw)).collect(),
        labels: (groups.iter().zip(&apart.u))
            .map(|((label, _), u)| (label.clone(), *u))
            .collect(),
    })
}

/// The labels of a column that occur, each with its blocks.
fn groups(design: &Design<'_>, column: usize) -> Option<Vec<(String, Vec<usize>)>> {
    let labels = design.case.columns[column].labels()?;
    let named = labels
        .levels
        .iter()
        .map(|label| (label.to_string(), Vec::new()));
    let mut groups: Vec<(String, Vec<usize>)> = named.collect();
    for (block, rows) in design.blocks.iter().enumerate() {
        groups[labels.of_row[rows[0]] as usize].1.push(block);
    }
    groups.retain(|(_, blocks)| !blocks.is_empty());
    Some(groups)
}

/// What groups of blocks scatter, each by itself.
struct Apart {
    /// The probability that groups of one scale are as unlike one another.
    p: f64,
    /// The standard uncertainty of each, up to a factor.
    u: Vec<f64>,
    /// What it may be as well.
    draws: Vec<Vec<f64>>,
}

impl Apart {
    /// `None` where one of them is too small.
    fn of(
        groups: &[&[usize]],
        course: &[f64],
        residuals: &DVector<f64>,
        seed: u64,
    ) -> Option<Apart> {
        let squares = |groups: &[&[usize]]| -> Vec<f64> {
            let groups = groups.iter().map(|group| group.to_vec()).collect();
            let found = differences(groups, (course, course), residuals).into_iter();
            found.map(|one| one.size * one.size).collect()
        };
        let each = groups.iter().map(|group| squares(&[*group]));
        let each = each.map(|own| (own.len() >= LEAST).then_some(own));
        let each: Vec<Vec<f64>> = each.collect::<Option<_>>()?;
        let scales: Vec<f64> = each.iter().map(|own| scale(own)).collect();
        let apart = each
            .iter()
            .zip(&scales)
            .map(|(own, scale)| misfit(own, *scale));
        let all = squares(groups);
        let gain = misfit(&all, scale(&all)) - apart.sum::<f64>();
        // With ν degrees of freedom a scale may be ν/χ² times as large.
        let doubt = |at: usize| {
            let half = 0.5 * INFORMATION * each[at].len() as f64 / SHARED;
            let fill =
                |generator: &mut _, block: &mut _| gamma_block(level(), generator, half, block);
            let drawn = numbers(seed, STREAM + at as u64, DRAWS, fill).into_iter();
            drawn.map(|gamma| half / gamma).collect()
        };
        let doubts: Vec<Vec<f64>> = (0..each.len()).map(doubt).collect();
        let draw = |draw: usize| {
            let scales = scales.iter().zip(&doubts);
            scales
                .map(|(scale, doubt)| (scale * doubt[draw]).sqrt())
                .collect()
        };
        Some(Apart {
            p: chi_squared_sf(gain.max(0.0) / SHARED, (groups.len() as f64 - 1.0).max(1.0)),
            u: scales.iter().map(|scale| scale.sqrt()).collect(),
            draws: (0..DRAWS).map(draw).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use gumption_core::special::normal_quantile;
    use gumption_lanes::Generator;

    use super::*;

    /// Three groups of twenty, the last of which scatters so many times as much.
    fn apart(times: f64) -> Apart {
        let groups: Vec<Vec<usize>> = (0..3).map(|g| (20 * g..20 * (g + 1)).collect()).collect();
        let groups: Vec<&[usize]> = groups.iter().map(|group| &group[..]).collect();
        let error = |k: usize| normal_quantile((0.5 + ((k * 37) % 60) as f64) / 60.0);
        let of = |k: usize| error(k) * if k < 40 { 1.0 } else { times };
        let residuals = DVector::from_fn(60, |k, _| of(k));
        let values: Vec<f64> = (0..60).map(|k| (k % 20) as f64).collect();
        Apart::of(&groups, &values, &residuals, 1).unwrap()
    }

    #[test]
    fn an_instrument_that_scatters_more_is_seen() {
        assert!(apart(1.0).p > 0.05);
        let found = apart(5.0);
        assert!(found.p < 1e-4);
        let ratio = |u: &[f64]| u[2] / u[0];
        let own = ratio(&found.u);
        assert!((3.0..8.0).contains(&own), "{own}");
        assert!(found.draws.iter().any(|draw| ratio(draw) > own));
        assert!(found.draws.iter().any(|draw| ratio(draw) < own));
    }

    #[test]
    fn what_all_scatter_alike_is_seldom_told_apart() {
        let groups: Vec<Vec<usize>> = (0..3).map(|g| (20 * g..20 * (g + 1)).collect()).collect();
        let groups: Vec<&[usize]> = groups.iter().map(|group| &group[..]).collect();
        let values: Vec<f64> = (0..60).map(|k| (k % 20) as f64).collect();
        let told = (0..200_u64).filter(|seed| {
            let fill =
                |generator: &mut Generator, block: &mut _| generator.uniforms(level(), block);
            let uniform = numbers(*seed, 1, 60, fill);
            let residuals = DVector::from_fn(60, |k, _| normal_quantile(uniform[k]));
            Apart::of(&groups, &values, &residuals, 1).unwrap().p < 0.05
        });
        let told = told.count();
        // 10 of 200 are expected; 20 and more come about with a probability of 0.2 %.
        assert!(told < 20, "{told}");
    }
}
