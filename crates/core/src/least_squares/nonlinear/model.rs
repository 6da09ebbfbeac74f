//! The linear model of the residuals around a point, and steps of a given length.

use super::linear::Linear;
use crate::least_squares::factor::{Qr, dot, square};

/// The linear model of the residuals around a point: small enough to be solved many times.
pub(super) struct Model {
    /// R, in the order of the parameters: columns of length p.
    columns: Vec<Vec<f64>>,
    /// Qᵀ r.
    projected: Vec<f64>,
    scales: Vec<f64>,
}

/// What the linear model promises, as fractions of χ².
pub(super) struct Reduction {
    pub whole: f64,
    /// Half the slope of χ² along the step.
    pub slope: f64,
}

impl Model {
    pub fn new(linear: &Linear, scales: &[f64]) -> Model {
        let p = linear.jacobian.len();
        let qr = Qr::new(linear.jacobian.clone(), 0.0);
        let mut projected = linear.residuals.clone();
        qr.transposed_times(&mut projected);
        let columns = linear
            .jacobian
            .iter()
            .map(|column| {
                let mut rotated = column.clone();
                qr.transposed_times(&mut rotated);
                rotated.truncate(p);
                rotated
            })
            .collect();
        projected.truncate(p);
        Model {
            columns,
            projected,
            scales: scales.to_vec(),
        }
    }

    /// The step that minimises |r − J s|² + λ |D s|², and the factor of that problem.
    fn damped(&self, damping: f64) -> (Vec<f64>, Qr<f64>) {
        let p = self.columns.len();
        let root = damping.sqrt();
        let stacked = (0..p)
            .map(|k| {
                let mut column = self.columns[k].clone();
                column.resize(2 * p, 0.0);
                column[p + k] = root * self.scales[k];
                column
            })
            .collect();
        let qr = Qr::new(stacked, 1e-16);
        let mut right = self.projected.clone();
        right.resize(2 * p, 0.0);
        qr.transposed_times(&mut right);
        let step = qr.solve(&right[..p]);
        (step, qr)
    }

    /// The step of the scaled length `region` (within a tenth), or the full step if that is
    /// shorter, with its λ.
    pub fn within(&self, region: f64, guess: f64) -> (Vec<f64>, f64) {
        let (step, qr) = self.damped(0.0);
        let length = scaled_length(&self.scales, &step);
        if qr.is_full() && length <= 1.1 * region {
            return (step, 0.0);
        }
        // Bounds of λ: Newton's from below, the gradient's from above.
        let mut low = if qr.is_full() && length.is_finite() {
            self.newton(&step, &qr, length, region)
        } else {
            0.0
        };
        let gradient = self
            .columns
            .iter()
            .zip(&self.scales)
            .map(|(column, scale)| (dot(column, &self.projected) / scale).powi(2));
        let mut high = gradient.sum::<f64>().sqrt() / region;
        if !high.is_finite() {
            // Numbers near the end of the range: no step is known to be short enough.
            return (vec![f64::NAN; step.len()], 0.0);
        }
        if high == 0.0 {
            high = f64::MIN_POSITIVE / region.min(0.1);
        }
        let mut damping = guess.max(low.min(high)).min(high);
        if damping == 0.0 {
            damping = if length.is_finite() && length > 0.0 {
                high.min(high * region / length)
            } else {
                1e-3 * high
            };
        }
        let mut step = step;
        for _ in 0..20 {
            damping = damping
                .max(1e-3 * f64::EPSILON * high)
                .max(f64::MIN_POSITIVE);
            let (trial, qr) = self.damped(damping);
            step = trial;
            let length = scaled_length(&self.scales, &step);
            let excess = length - region;
            if excess.abs() <= 0.1 * region {
                break;
            }
            if excess > 0.0 {
                low = low.max(damping);
            } else {
                high = high.min(damping);
            }
            let correction = self.newton(&step, &qr, length, region);
            let next = damping + correction;
            damping = if next.is_finite() && next > low && next < high {
                next
            } else if low > 0.0 {
                (low * high).sqrt()
            } else {
                1e-2 * high
            };
        }
        (step, damping)
    }

    /// Newton's correction of λ towards |D s| = region, for 1/|D s|.
    fn newton(&self, step: &[f64], qr: &Qr<f64>, length: f64, region: f64) -> f64 {
        let direction: Vec<f64> = step
            .iter()
            .zip(&self.scales)
            .map(|(s, d)| d * d * s / length)
            .collect();
        let inner = qr.solve_transposed(&direction);
        (length - region) / region / square(&inner)
    }

    /// What a step with this λ promises.
    pub fn reduction(
        &self,
        step: &[f64],
        damping: f64,
        scales: &[f64],
        chi_squared: f64,
    ) -> Reduction {
        let mut change = vec![0.0; self.projected.len()];
        for (column, s) in self.columns.iter().zip(step) {
            for (cell, r) in change.iter_mut().zip(column) {
                *cell += r * s;
            }
        }
        let linear = square(&change) / chi_squared;
        let damped = damping * scaled_length(scales, step).powi(2) / chi_squared;
        Reduction {
            whole: linear + 2.0 * damped,
            slope: -(linear + damped),
        }
    }
}

/// Length of a step in units of the scales.
pub(super) fn scaled_length(scales: &[f64], step: &[f64]) -> f64 {
    scales
        .iter()
        .zip(step)
        .map(|(d, s)| (d * s).powi(2))
        .sum::<f64>()
        .sqrt()
}
