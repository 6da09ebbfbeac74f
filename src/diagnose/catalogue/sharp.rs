//! Grids of a shape parameter with one value moved to where it explains the residuals best: a time constant
//! between two values of the grid would leave a part of itself to further explanations.

use nalgebra::DVector;

use super::Term;
use super::ground::Ground;
use super::zero::Absorbed;

/// Moves the value next to the best one onto it, where an effect of this kind shows at all; outputs of
/// several axes have laws of their own and are left alone.
pub(super) fn sharpened(
    ground: &Ground<'_>,
    mut grid: Vec<f64>,
    term: &dyn Fn(f64) -> Term,
) -> Vec<f64> {
    /// Ratio of variances from which on an effect shows.
    const SHOWS: f64 = 16.0;
    let unclear = ground.case().responses.len() != 1 || grid.len() < 2;
    if unclear || grid.iter().any(|value| *value <= 0.0) {
        return grid;
    }
    let absorbed = Absorbed::by_parameters(ground);
    let residuals = absorbed.rest(&ground.fit.residuals);
    let power = |value: f64| power(&absorbed, &residuals, &ground.column(&term(value)));
    let powers: Vec<f64> = grid.iter().map(|value| power(*value)).collect();
    let Some(best) = (0..grid.len()).max_by(|a, b| powers[*a].total_cmp(&powers[*b])) else {
        return grid;
    };
    let left = residuals.norm_squared() - powers[best];
    let degrees = residuals.len().saturating_sub(absorbed.directions() + 1);
    if powers[best] * degrees as f64 <= SHOWS * left {
        return grid;
    }
    let low = grid[best.saturating_sub(1)];
    let high = grid[(best + 1).min(grid.len() - 1)];
    grid[best] = highest(&power, low, grid[best], high);
    grid
}

/// Sum of squares that a regressor takes away from the residuals.
fn power(absorbed: &Absorbed, residuals: &DVector<f64>, column: &DVector<f64>) -> f64 {
    /// A regressor of which the parameters leave less than this (squared) is invisible.
    const LEAST: f64 = 1e-10;
    let rest = absorbed.rest(column);
    let size = rest.norm_squared();
    let along = rest.dot(residuals);
    if size > LEAST * column.norm_squared() && along.is_finite() {
        along * along / size
    } else {
        0.0
    }
}

/// The highest point between two values, on a logarithmic scale, by ever narrower scans around a start.
fn highest(power: &dyn Fn(f64) -> f64, low: f64, start: f64, high: f64) -> f64 {
    const SCANS: usize = 5;
    let (mut best, mut height) = (start, power(start));
    let mut reach = libm::log(high / low) / 2.0;
    for _ in 0..SCANS {
        let centre = best;
        for side in [-0.75, -0.5, -0.25, 0.25, 0.5, 0.75] {
            let at = (centre * libm::exp(side * reach)).clamp(low, high);
            let here = power(at);
            if here > height {
                (best, height) = (at, here);
            }
        }
        reach /= 3.0;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summit_is_found() {
        let hill = |x: f64| -libm::pow(libm::log(x / 2.345), 2.0);
        let found = highest(&hill, 1.5, 2.0, 4.0);
        assert!((found / 2.345 - 1.0).abs() < 0.01, "{found}");
    }
}
