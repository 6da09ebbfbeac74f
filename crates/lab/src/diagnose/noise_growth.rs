//! Noise that grows with the reading: u² = a² + (b·y)²; or with what the reading is above its zero, where the model has one: an
//! output of 2.5 V at rest need not scatter more than one of 0 V.
//!
//! Whether it does is read from neighbours: each residual against the straight line between the residuals
//! with the next smaller and the next larger stimulus, or modelled value where there are several stimuli, under the same labels. What a model leaves out
//! varies little between neighbours, noise does not. The differences count by the likelihood of Student's
//! distribution with few degrees of freedom, so that single wrong readings have little weight.

use nalgebra::DVector;

use super::case::{Observed, Role};
use super::chance::in_proportion;
use super::design::Design;

/// Degrees of freedom of the distribution of the differences.
const TAILS: f64 = 4.0;
/// What one difference tells of their scale, over what a normal one does: 2ν/(ν + 3) of 2.
pub(super) const INFORMATION: f64 = TAILS / (TAILS + 3.0);
/// Differences for each that is independent. Neighbours share residuals: with the weights ½, 1, ½ squares correlate by 4/9, and with
/// those of the next but one by 1/36.
pub(super) const SHARED: f64 = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);
/// Gain in −2 ln L from which noise counts as growing. For independent differences 5.4 is reached in 1 % of
/// recordings with constant noise; neighbouring ones share residuals.
const GAIN: f64 = 8.0;
/// Fewer differences say too little.
const LEAST: usize = 15;
/// Ratios a/b that are tried.
const RATIOS: usize = 32;
/// Least and largest a/b relative to the root mean square of the readings: below the least reading nothing
/// tells a from zero, above the largest nothing tells b from zero.
const LEAST_RATIO: f64 = 1e-4;
const LARGEST_RATIO: f64 = 5.0;
/// Draws of a/b from what the recording leaves open.
pub(super) const DRAWS: usize = 24;

/// What noise may grow with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// The reading, y.
    Reading,
    /// The reading without the constant terms of the model, y − y₀.
    Signal,
    /// The reading without what the model gives where nothing is applied, y − y(0), of a model whose constant is a factor.
    Applied,
}

/// Noise of one response that grows: u² = a² + (b·y)².
#[derive(Debug, Clone, PartialEq)]
pub struct Growth {
    /// y.
    pub with: Quantity,
    /// a.
    pub constant: f64,
    /// Its unit, that of the response.
    pub unit: String,
    /// b.
    pub proportional: f64,
}

/// The shape of noise that grows with the reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    /// Part of the mean square that is proportional to the square of the reading.
    share: f64,
    /// Root mean square of the modelled values.
    level: f64,
}

impl Spread {
    /// Noise that does not grow.
    pub const CONSTANT: Spread = Spread {
        share: 0.0,
        level: 1.0,
    };

    /// With this part of the mean square in proportion to the square of these values.
    pub fn of(share: f64, values: &[f64]) -> Spread {
        let squares: f64 = values.iter().map(|x| x * x).sum();
        let level = (squares / values.len() as f64).sqrt();
        Spread { share, level }
    }

    /// Standard uncertainty at a modelled value, relative to that at the root mean square of all.
    pub fn at(&self, value: f64) -> f64 {
        self.variance(value).sqrt()
    }

    /// Its square.
    fn variance(&self, value: f64) -> f64 {
        let part = value / self.level;
        1.0 - self.share + self.share * part * part
    }

    /// With the standard uncertainty where [`Spread::at`] is one, in the unit of the response.
    pub fn growth(&self, with: Quantity, scale: f64, unit: String) -> Growth {
        Growth {
            with,
            unit,
            constant: scale * (1.0 - self.share).sqrt(),
            proportional: scale * self.share.sqrt() / self.level,
        }
    }
}

/// A shape of the noise, and those that are likely beside it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Likely {
    /// The mean variance of those that are likely. The likeliest one may have no noise at all where few readings tell it, and
    /// would give those all weight.
    pub best: Spread,
    /// In proportion to their likelihood.
    pub draws: Vec<Spread>,
    /// By how much the likeliest has a smaller −2 ln L than constant noise.
    pub gain: f64,
}

/// The shape of least −2 ln L, where it is less by more than `gain` than that of constant noise.
///
/// The ratio a/b runs over the range of the readings in equal steps of its logarithm: readings over several
/// decades have a noise that grows over several decades, however small a is in the mean square.
pub(super) fn likely(values: &[f64], gain: f64, misfit: impl Fn(&Spread) -> f64) -> Option<Likely> {
    let level = (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt();
    let sizes = values.iter().map(|x| x.abs()).filter(|x| *x > 0.0);
    let smallest = sizes.fold(f64::INFINITY, f64::min);
    if !(level > 0.0 && level.is_finite() && smallest > 0.0) {
        return None;
    }
    let least = libm::log((0.3 * smallest / level).max(LEAST_RATIO));
    let step = (libm::log(LARGEST_RATIO) - least) / (RATIOS - 1) as f64;
    let ratios = (0..RATIOS).map(|at| libm::exp(least + step * at as f64));
    let shares = ratios.map(|ratio| 1.0 / (1.0 + ratio * ratio));
    let constant = misfit(&Spread::CONSTANT);
    let tried: Vec<(Spread, f64)> = shares
        .map(|share| Spread { share, level })
        .map(|spread| (spread, misfit(&spread)))
        .filter(|(_, misfit)| misfit.is_finite())
        .collect();
    let best = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let weights = tried
        .iter()
        .map(|(_, misfit)| libm::exp(0.5 * (best.1 - misfit)));
    let drawn = in_proportion(&tried, &weights.collect::<Vec<f64>>(), DRAWS);
    let draws: Vec<Spread> = drawn.into_iter().map(|(spread, _)| *spread).collect();
    let share = draws.iter().map(|spread| spread.share).sum::<f64>() / draws.len() as f64;
    (constant - best.1 > gain).then_some(Likely {
        best: Spread { share, level },
        draws,
        gain: constant - best.1,
    })
}

/// A residual that its neighbours do not explain, at a modelled value.
pub(super) struct Difference {
    value: f64,
    pub(super) size: f64,
}

/// How the noise of a response grows with its modelled values, or with these without constant terms; `None` where it does not, as
/// far as can be seen.
pub(super) fn estimate(
    design: &Design<'_>,
    response: usize,
    values: &[f64],
    residuals: &DVector<f64>,
) -> Option<Likely> {
    if matches!(
        design.case.responses[response].observed,
        Observed::Constant(_)
    ) {
        return None;
    }
    let course = course(design, response);
    let course = course.as_deref().unwrap_or(values);
    let differences = differences(groups(design), (course, values), residuals);
    if differences.len() < LEAST {
        return None;
    }
    likely(values, GAIN, |spread| grown(&differences, spread))
}

/// −2 ln L of the differences, with the scale that fits best.
fn grown(differences: &[Difference], spread: &Spread) -> f64 {
    let variances = differences.iter().map(|one| spread.variance(one.value));
    let variances: Vec<f64> = variances.collect();
    let squares = differences.iter().zip(&variances);
    let squares: Vec<f64> = squares
        .map(|(one, variance)| one.size * one.size / variance)
        .collect();
    let widths = variances.iter().map(|variance| libm::log(*variance));
    widths.sum::<f64>() + misfit(&squares, scale(&squares))
}

/// −2 ln L of differences with these squares, for such a squared scale.
pub(super) fn misfit(squares: &[f64], scale: f64) -> f64 {
    let beyond = |square: &f64| libm::log1p(square / (TAILS * scale));
    let tails = squares.iter().map(beyond).sum::<f64>();
    squares.len() as f64 * libm::log(scale) + (TAILS + 1.0) * tails
}

/// Squared scale of Student's distribution by maximum likelihood: a mean with weights (ν + 1)/(ν + z²), which are those at the scale
/// before. Each step adds to the likelihood (Kent, Tyler and Vardi 1994).
pub(super) fn scale(squares: &[f64]) -> f64 {
    const STEPS: u8 = 30;
    /// Rounding of sums.
    const SAME: f64 = 1e-12;
    let mut scale = squares.iter().sum::<f64>() / squares.len() as f64;
    for _ in 0..STEPS {
        let before = scale;
        let [mut weighted, mut weights] = [0.0; 2];
        for square in squares {
            let weight = 1.0 / (TAILS * before + square);
            weighted += weight * square;
            weights += weight;
        }
        scale = weighted / weights;
        // None at all where all differences are zero.
        if (scale - before).abs() <= SAME * before || scale.is_nan() {
            break;
        }
    }
    scale
}

/// Along what residuals have neighbours: the only column that the model takes in, since on both sides of a peak it gives the same with
/// what it leaves out on either; nothing where there are several.
pub(super) fn course(design: &Design<'_>, response: usize) -> Option<Vec<f64>> {
    let (case, first) = (design.case, design.case.parameters.len());
    let used = case.equations.uses(response);
    let mut columns = (0..case.columns.len()).filter(|c| used.contains(&(first + c)));
    let only = columns.next().filter(|_| columns.next().is_none())?;
    Some(design.reduced(case.columns[only].numbers()?))
}

/// What neighbours along a course, within groups of blocks, leave of each other, at modelled values.
pub(super) fn differences(
    groups: Vec<Vec<usize>>,
    (course, values): (&[f64], &[f64]),
    residuals: &DVector<f64>,
) -> Vec<Difference> {
    let mut all = Vec::new();
    for mut group in groups {
        group.sort_by(|a, b| course[*a].total_cmp(&course[*b]));
        for three in group.windows(3) {
            let [low, middle, high] = [three[0], three[1], three[2]];
            let gap = course[high] - course[low];
            let part = if gap > 0.0 {
                (course[middle] - course[low]) / gap
            } else {
                0.5
            };
            let line = (1.0 - part) * residuals[low] + part * residuals[high];
            let size = (1.0 + (1.0 - part) * (1.0 - part) + part * part).sqrt();
            all.push((values[middle], ((residuals[middle] - line) / size).abs()));
        }
    }
    // Readings of few digits agree to the last one: such differences tell only that they are small.
    let mut sizes: Vec<f64> = all.iter().map(|(_, size)| *size).collect();
    sizes.sort_by(f64::total_cmp);
    let floor = 0.03 * sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    all.into_iter()
        .filter(|_| floor > 0.0)
        .map(|(value, size)| Difference {
            value,
            size: size.max(floor),
        })
        .collect()
}

/// Blocks with the same labels.
fn groups(design: &Design<'_>) -> Vec<Vec<usize>> {
    let labelled = design.case.columns.iter().filter_map(|column| {
        let kind = matches!(column.role, Role::Run | Role::Factor | Role::Axis);
        column.labels().filter(|_| kind)
    });
    let labelled: Vec<_> = labelled.collect();
    let mut groups = std::collections::BTreeMap::<Vec<u32>, Vec<usize>>::new();
    for (block, rows) in design.blocks.iter().enumerate() {
        let key = labelled.iter().map(|labels| labels.of_row[rows[0]]);
        groups.entry(key.collect()).or_default().push(block);
    }
    groups.into_values().collect()
}
