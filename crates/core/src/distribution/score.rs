//! Quantiles as functions of the normal score z = Φ⁻¹(u), tabulated for blocks of points.

use gumption_lanes::quantile::Curve;

use crate::special::{normal_cdf, normal_sf};

/// Normal scores of tables. Beyond them lies a probability of Φ(−8.5) ≈ 10⁻¹⁷ on either side, less than half the last digit of a
/// number next to 1 (2⁻⁵⁴ ≈ 6·10⁻¹⁷).
pub(super) const SCORES: [f64; 2] = [-8.5, 8.5];

/// A function of probabilities as a function of normal scores. It is given from either end: `lower` of the probability
/// below, `upper` of the one above, so that both tails have their digits.
pub fn of_score(lower: impl Fn(f64) -> f64, upper: impl Fn(f64) -> f64) -> Curve {
    with_differences(SCORES, |z| {
        if z <= 0.0 {
            lower(normal_cdf(z))
        } else {
            upper(normal_sf(z))
        }
    })
}

/// A curve whose slopes are differences of fourth order.
pub fn with_differences(range: [f64; 2], value: impl Fn(f64) -> f64) -> Curve {
    let values: Vec<f64> = Curve::arguments(range).map(value).collect();
    let step = (range[1] - range[0]) / (values.len() - 1) as f64;
    let last = values.len() - 1;
    let slope = |i: usize| {
        if (2..last - 1).contains(&i) {
            (8.0 * (values[i + 1] - values[i - 1]) - (values[i + 2] - values[i - 2]))
                / (12.0 * step)
        } else {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
            (values[after] - values[before]) / ((after - before) as f64 * step)
        }
    };
    let nodes: Vec<[f64; 2]> = (0..=last).map(|i| [values[i], slope(i)]).collect();
    Curve::new(range, &nodes)
}
