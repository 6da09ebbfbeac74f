//! The noise that replicates show: rows that agree in chosen columns differ by noise only.
//!
//! Their scatter within groups has one variance, or one that grows with the reading, u² = a² + (b·y)², where
//! that describes it better. Whether the scatter of the groups is then even is tested by Bartlett's statistic.

use std::collections::BTreeMap;

use gumption_lanes::sampler::gamma_block;
use gumption_lanes::{Block, Generator, LANES, level};

use super::case::Data;
use super::catalogue::modifiers::spacing;
use super::design::Design;
use super::noise_growth::{self, Growth, Quantity, Spread};
use gumption_core::special::chi_squared_quantile;

/// Gain in −2 ln L from which noise counts as growing: exceeded by chance in 5 % of recordings (one-sided,
/// χ² of one degree of freedom). Growth that is missed costs false alarms, growth in vain next to nothing.
const GAIN: f64 = 2.7;
/// Fewer degrees of freedom do not carry a second parameter.
const LEAST: usize = 6;
/// Level of the test for even scatter.
const UNEVEN: f64 = 0.01;
/// Chunks of simulated recordings for it.
const CHUNKS: u64 = 8;

/// What replicates tell of the noise of one response.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scatter {
    /// Variance of every row.
    pub variances: Vec<f64>,
    /// Its degrees of freedom.
    pub dof: f64,
    /// How it grows with the reading.
    pub growth: Option<Growth>,
    /// Variances of the rows as they may be too; empty where they are known up to a factor.
    pub draws: Vec<Vec<f64>>,
    /// Probability that groups scatter as unevenly by chance, where it is below the level of the test.
    pub uneven: Option<f64>,
}

/// Rows that agree.
struct Group {
    dof: f64,
    /// Mean reading.
    level: f64,
    /// Variance about it.
    variance: f64,
    /// The least variance that the steps of the readings can show.
    floor: f64,
}

/// The noise of each response; nothing where too few rows agree, or those that do show no scatter.
pub(super) fn scatter(design: &Design<'_>, columns: &[usize]) -> Option<Vec<Scatter>> {
    let rows = agreeing(design, columns);
    let dof: usize = rows.iter().map(|rows| rows.len() - 1).sum();
    if dof < 2 {
        return None;
    }
    (0..design.case.responses.len())
        .map(|response| of_response(design, response, &rows))
        .collect()
}

fn agreeing(design: &Design<'_>, columns: &[usize]) -> Vec<Vec<usize>> {
    let case = design.case;
    let key = |row: usize| -> Vec<u64> {
        let of = columns
            .iter()
            .map(|column| match &case.columns[*column].data {
                Data::Labels(labels) => u64::from(labels.of_row[row]),
                // Zero has one sign.
                Data::Numbers(numbers) => (numbers[row] + 0.0).to_bits(),
                Data::Absent => 0,
            });
        of.collect()
    };
    let mut groups: BTreeMap<Vec<u64>, Vec<usize>> = BTreeMap::new();
    for row in 0..case.rows {
        groups.entry(key(row)).or_default().push(row);
    }
    groups.into_values().collect()
}

fn of_response(design: &Design<'_>, response: usize, rows: &[Vec<usize>]) -> Option<Scatter> {
    let observed = design.observed(response);
    let step = Some(spacing(&observed)).filter(|step| step.is_finite());
    let floor = step.map_or(0.0, |step| step * step / 12.0);
    let mut levels = vec![0.0; design.case.rows];
    let mut groups = Vec::new();
    for rows in rows {
        let level = rows.iter().map(|row| observed[*row]).sum::<f64>() / rows.len() as f64;
        for row in rows {
            levels[*row] = level;
        }
        if rows.len() > 1 {
            let dof = (rows.len() - 1) as f64;
            let square = |row: &usize| (observed[*row] - level) * (observed[*row] - level);
            groups.push(Group {
                dof,
                level,
                variance: rows.iter().map(square).sum::<f64>() / dof,
                floor,
            });
        }
    }
    let dof: f64 = groups.iter().map(|group| group.dof).sum();
    let pooled = pooled(&groups, &Spread::CONSTANT);
    if !(pooled > 0.0 && pooled.is_finite()) {
        return None;
    }
    let at = |spread: &Spread, scale: f64| {
        let variance = |level: &f64| scale * spread.at(*level) * spread.at(*level);
        levels.iter().map(variance).collect::<Vec<f64>>()
    };
    let of_groups: Vec<f64> = groups.iter().map(|group| group.level).collect();
    let likely = (dof as usize >= LEAST)
        .then(|| noise_growth::likely(&of_groups, GAIN, |spread| misfit(&groups, spread)))
        .flatten();
    let (best, draws) = likely
        .as_ref()
        .map_or((Spread::CONSTANT, &[][..]), |likely| {
            (likely.best, likely.draws.as_slice())
        });
    // The shape costs one degree of freedom.
    let left = dof - f64::from(u8::from(likely.is_some()));
    let scale = |spread: &Spread| self::pooled(&groups, spread) * dof / left;
    let unit = design.case.responses[response].unit.typeset();
    let growth =
        (likely.as_ref()).map(|_| best.growth(Quantity::Reading, scale(&best).sqrt(), unit));
    let count = draws.len();
    let draw = |(index, spread): (usize, &Spread)| {
        // The two are open independently of each other: a step that meets every part of the distribution.
        let part = ((7 * index) % count) as f64 + 0.5;
        let factor = left / chi_squared_quantile(part / count as f64, left);
        at(spread, scale(spread) * factor)
    };
    Some(Scatter {
        variances: at(&best, scale(&best)),
        dof: left,
        growth,
        draws: draws.iter().enumerate().map(draw).collect(),
        uneven: uneven(&groups, &best, design.case.settings.seed),
    })
}

/// Variance of the group relative to the shape of the noise.
fn relative(group: &Group, spread: &Spread) -> f64 {
    group.variance.max(group.floor) / (spread.at(group.level) * spread.at(group.level))
}

fn pooled(groups: &[Group], spread: &Spread) -> f64 {
    let squares = groups.iter().map(|group| {
        let at = spread.at(group.level);
        group.dof * group.variance / (at * at)
    });
    squares.sum::<f64>() / groups.iter().map(|group| group.dof).sum::<f64>()
}

/// −2 ln L of the variances of the groups, with the scale that fits best.
fn misfit(groups: &[Group], spread: &Spread) -> f64 {
    let dof: f64 = groups.iter().map(|group| group.dof).sum();
    let each = groups.iter();
    let shape = (each.clone()).map(|group| 2.0 * group.dof * libm::log(spread.at(group.level)));
    let squares = each.map(|group| group.dof * relative(group, spread));
    dof * libm::log(squares.sum::<f64>() / dof) + shape.sum::<f64>()
}

/// Bartlett's statistic, ν·ln s² − Σ νᵢ·ln sᵢ², of variances with their degrees of freedom.
fn bartlett(variances: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let dof: f64 = variances.clone().map(|(_, dof)| dof).sum();
    let pooled = variances.clone().map(|(variance, dof)| variance * dof);
    let pooled = pooled.sum::<f64>() / dof;
    let own = variances.map(|(variance, dof)| dof * libm::log(variance));
    dof * libm::log(pooled) - own.sum::<f64>()
}

/// Probability that the groups scatter as unevenly by chance, where it is below the level of the test.
///
/// By simulation: groups of two or three are too small for the χ² distribution of Bartlett's statistic, and
/// readings have steps.
fn uneven(groups: &[Group], spread: &Spread, seed: u64) -> Option<f64> {
    if groups.len() < 2 {
        return None;
    }
    let scale = pooled(groups, spread);
    let floor = |group: &Group| {
        let at = spread.at(group.level);
        // No variance is known better than to a millionth.
        (group.floor / (at * at * scale)).max(1e-6)
    };
    let found = bartlett(groups.iter().map(|group| {
        let variance = relative(group, spread) / scale;
        (variance.max(floor(group)), group.dof)
    }));
    let mut as_far = 0;
    for chunk in 0..CHUNKS {
        let drawn = |(index, group): (usize, &Group)| {
            let mut block = Block::ZERO;
            let mut generator = Generator::new(seed, chunk, index as u64);
            gamma_block(level(), &mut generator, 0.5 * group.dof, &mut block);
            block
                .0
                .map(|half| (2.0 * half / group.dof).max(floor(group)))
        };
        let drawn: Vec<[f64; LANES]> = groups.iter().enumerate().map(drawn).collect();
        as_far += (0..LANES)
            .filter(|lane| {
                let variances = drawn.iter().map(|variances| variances[*lane]);
                bartlett(variances.zip(groups.iter().map(|group| group.dof))) >= found
            })
            .count();
    }
    let p = (as_far + 1) as f64 / (CHUNKS * LANES as u64 + 1) as f64;
    (p < UNEVEN).then_some(p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_lanes::sampler::normal_block;

    /// Twenty groups of three over three decades, with a standard deviation at each level.
    fn groups(deviation: impl Fn(usize, f64) -> f64, seed: u64) -> Vec<Group> {
        let mut block = Block::ZERO;
        normal_block(level(), &mut Generator::new(seed, 0, 0), &mut block);
        let of = |index: usize| {
            let level = libm::pow(10.0, 3.0 * index as f64 / 19.0);
            let own = &block.0[3 * index..3 * index + 3];
            let mean = own.iter().sum::<f64>() / 3.0;
            let variance = own.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 2.0;
            let deviation = deviation(index, level);
            Group {
                dof: 2.0,
                level,
                variance: variance * deviation * deviation,
                floor: 0.0,
            }
        };
        (0..20).map(of).collect()
    }

    fn found(groups: &[Group]) -> Option<noise_growth::Likely> {
        let levels: Vec<f64> = groups.iter().map(|group| group.level).collect();
        noise_growth::likely(&levels, GAIN, |spread| misfit(groups, spread))
    }

    #[test]
    fn scatter_that_grows_over_decades_is_described() {
        let mut squares = 0.0;
        for seed in 0..50 {
            let groups = groups(|_, level| libm::hypot(0.05, 0.002 * level), seed);
            let likely = found(&groups).expect("growth");
            let scale = pooled(&groups, &likely.best).sqrt();
            for (level, u) in [(1.0, 0.05), (1000.0, 2.0)] {
                let off = libm::log(scale * likely.best.at(level) / u);
                squares += off * off / 100.0;
            }
        }
        assert!(squares.sqrt() < 0.25, "{}", squares.sqrt());
    }

    #[test]
    fn even_scatter_seldom_counts_as_growing_or_uneven() {
        let constant = |seed| groups(|_, _| 0.3, seed);
        let growing = (0..200).filter(|seed| found(&constant(*seed)).is_some());
        assert!(growing.count() <= 20);
        let uneven = (0..200).filter(|s| uneven(&constant(*s), &Spread::CONSTANT, 1).is_some());
        assert!(uneven.count() <= 6);
    }

    #[test]
    fn scatter_that_follows_something_else_is_uneven() {
        let odd = |index: usize, _: f64| if index.is_multiple_of(2) { 0.1 } else { 1.0 };
        let uneven = (0..50).filter(|seed| {
            let groups = groups(odd, *seed);
            let best = found(&groups).map_or(Spread::CONSTANT, |likely| likely.best);
            uneven(&groups, &best, 1).is_some()
        });
        assert!(uneven.count() >= 45);
    }
}
