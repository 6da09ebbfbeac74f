//! Noise that grows with the reading: u² = a² + (b·y)².
//!
//! Whether it does is read from neighbours: each residual against the straight line between the residuals
//! with the next smaller and the next larger modelled value, under the same labels. What a model leaves out
//! varies little between neighbours, noise does not. The logarithms of these differences are compared with
//! those of u, so that single wrong readings have little weight.

use nalgebra::DVector;

use super::case::{Observed, Role};
use super::fit::Fit;
use super::frame::Frame;

/// Variance of ln|x| of a normal variable, π²/8.
const LOG_VARIANCE: f64 = 1.2337;
/// Gain in the sum of squares from which noise counts as growing. For independent differences 6.6 is reached
/// in 1 % of recordings with constant noise; neighbouring ones share residuals.
const GAIN: f64 = 12.0;
/// Fewer differences say too little.
const LEAST: usize = 15;
/// Parts of the mean square that may be proportional to the reading.
const SHARES: [f64; 15] = [
    0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.995, 0.9999,
];

/// Noise of one response that grows with the reading: u² = a² + (b·y)².
#[derive(Debug, Clone, PartialEq)]
pub struct Growth {
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
    /// Standard uncertainty at a modelled value, relative to that at the root mean square of all.
    pub fn at(&self, value: f64) -> f64 {
        let part = value / self.level;
        (1.0 - self.share + self.share * part * part).sqrt()
    }

    /// With the standard uncertainty where [`Spread::at`] is one, in the unit of the response.
    pub fn growth(&self, scale: f64, unit: String) -> Growth {
        Growth {
            unit,
            constant: scale * (1.0 - self.share).sqrt(),
            proportional: scale * self.share.sqrt() / self.level,
        }
    }
}

/// How the noise of each response grows; `None` where it does not, as far as can be seen.
pub(super) fn estimate(frame: &Frame<'_>, fit: &Fit) -> Vec<Option<Spread>> {
    (0..frame.case.responses.len())
        .map(|response| of_response(frame, fit, response))
        .collect()
}

/// A residual that its neighbours do not explain, at a modelled value.
struct Difference {
    value: f64,
    logarithm: f64,
}

fn of_response(frame: &Frame<'_>, fit: &Fit, response: usize) -> Option<Spread> {
    if matches!(
        frame.case.responses[response].observed,
        Observed::Constant(_)
    ) {
        return None;
    }
    let values = frame.reduced(&fit.linear.values[response]);
    let first = response * frame.blocks.len();
    let residuals = fit.residuals.rows(first, frame.blocks.len()).into_owned();
    let differences = differences(frame, &values, &residuals);
    if differences.len() < LEAST {
        return None;
    }
    let level = (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt();
    let sum = |share: f64| {
        let spread = Spread { share, level };
        let left = differences
            .iter()
            .map(|difference| difference.logarithm - libm::log(spread.at(difference.value)));
        let left: Vec<f64> = left.collect();
        let mean = left.iter().sum::<f64>() / left.len() as f64;
        left.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / LOG_VARIANCE
    };
    let best = SHARES
        .into_iter()
        .map(|share| (share, sum(share)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    (sum(0.0) - best.1 > GAIN).then_some(Spread {
        share: best.0,
        level,
    })
}

fn differences(frame: &Frame<'_>, values: &[f64], residuals: &DVector<f64>) -> Vec<Difference> {
    let mut all = Vec::new();
    for mut group in groups(frame) {
        group.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        for three in group.windows(3) {
            let [low, middle, high] = [three[0], three[1], three[2]];
            let gap = values[high] - values[low];
            let part = if gap > 0.0 {
                (values[middle] - values[low]) / gap
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
            logarithm: libm::log(size.max(floor)),
        })
        .collect()
}

/// Blocks with the same labels.
fn groups(frame: &Frame<'_>) -> Vec<Vec<usize>> {
    let labelled = frame.case.columns.iter().filter_map(|column| {
        let kind = matches!(column.role, Role::Run | Role::Factor | Role::Axis);
        column.labels().filter(|_| kind)
    });
    let labelled: Vec<_> = labelled.collect();
    let mut groups = std::collections::BTreeMap::<Vec<u32>, Vec<usize>>::new();
    for (block, rows) in frame.blocks.iter().enumerate() {
        let key = labelled.iter().map(|labels| labels.of_row[rows[0]]);
        groups.entry(key.collect()).or_default().push(block);
    }
    groups.into_values().collect()
}
