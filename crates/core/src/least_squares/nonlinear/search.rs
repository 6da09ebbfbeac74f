//! One search: from a start, within a trust region that follows its success.

use super::linear::{FLAT, Linear, Minimum, Residuals, Stuck};
use super::model::{Model, Reduction, scaled_length};
use crate::least_squares::factor::{Qr, square};

/// Steps after which a search counts as lost.
pub(super) const MOST_STEPS: usize = 5000;

/// Relative offset below which the residuals cannot be improved noticeably.
const OFFSET: f64 = 1e-6;

/// The state of a search.
pub(super) struct Search<'a> {
    residuals: &'a dyn Residuals,
    at: Vec<f64>,
    linear: Linear,
    chi_squared: f64,
    /// Lengths of the columns of the Jacobian, the largest so far: makes steps comparable.
    scales: Vec<f64>,
    region: f64,
    damping: f64,
    iterations: usize,
}

/// Whether to go on.
#[derive(PartialEq)]
enum Progress {
    Moving,
    Settled,
}

impl<'a> Search<'a> {
    pub fn new(residuals: &'a dyn Residuals, start: &[f64], first: &Linear, factor: f64) -> Self {
        let scales: Vec<f64> = column_lengths(first)
            .map(|length| if length > 0.0 { length } else { 1.0 })
            .collect();
        let length = scaled_length(&scales, start);
        Search {
            residuals,
            at: start.to_vec(),
            linear: first.clone(),
            chi_squared: square(&first.residuals),
            scales,
            region: if length > 0.0 {
                factor * length
            } else {
                factor
            },
            damping: 0.0,
            iterations: 0,
        }
    }

    /// Searches to the end, or for so many steps.
    pub fn run(mut self, most: usize) -> Result<Minimum, Stuck> {
        while self.iterations < most && self.step() == Progress::Moving {}
        self.polish();
        let qr = Qr::new(self.linear.jacobian.clone(), FLAT);
        if !qr.is_full() {
            return Err(Stuck::Flat {
                parameters: qr.dependent(),
            });
        }
        if self.is_minimum(&qr) {
            let Search {
                at,
                linear,
                iterations,
                ..
            } = self;
            return Ok(Minimum {
                parameters: at,
                linear,
                iterations,
            });
        }
        Err(Stuck::Lost {
            iterations: self.iterations,
            parameters: self.at,
        })
    }

    /// One improvement of χ², however many attempts that takes.
    fn step(&mut self) -> Progress {
        self.iterations += 1;
        for (scale, length) in self.scales.iter_mut().zip(column_lengths(&self.linear)) {
            *scale = scale.max(length);
        }
        let model = Model::new(&self.linear, &self.scales);
        // Sixty attempts shrink the region by at least 2⁶⁰.
        for _ in 0..60 {
            let (step, damping) = model.within(self.region, self.damping);
            self.damping = damping;
            let length = scaled_length(&self.scales, &step);
            if !length.is_finite() {
                return Progress::Settled;
            }
            if self.iterations == 1 {
                self.region = self.region.min(length);
            }
            let trial: Vec<f64> = self.at.iter().zip(&step).map(|(b, d)| b + d).collect();
            let predicted = model.reduction(&step, self.damping, &self.scales, self.chi_squared);
            let there = self.residuals.at(&trial, Some(&self.linear));
            let chi_squared = there
                .as_ref()
                .map_or(f64::INFINITY, |l| square(&l.residuals));
            let actual = if chi_squared.is_finite() && 0.01 * chi_squared < self.chi_squared {
                1.0 - chi_squared / self.chi_squared
            } else {
                -1.0
            };
            let ratio = if predicted.whole > 0.0 {
                actual / predicted.whole
            } else {
                0.0
            };
            let small = length <= f64::EPSILON * scaled_length(&self.scales, &self.at);
            // χ² is too coarse for so little; but a short step may promise little far away.
            let flat = predicted.whole <= f64::EPSILON
                && (self.damping == 0.0 || actual.abs() <= f64::EPSILON);
            self.resize(ratio, actual, length, &predicted);
            if let Some(there) = there.filter(|_| ratio >= 1e-4 && chi_squared.is_finite()) {
                self.at = trial;
                self.linear = there;
                self.chi_squared = chi_squared;
                let done = small || flat || chi_squared == 0.0;
                return if done {
                    Progress::Settled
                } else {
                    Progress::Moving
                };
            }
            if small || flat || self.region <= f64::MIN_POSITIVE {
                return Progress::Settled;
            }
        }
        Progress::Settled
    }

    /// The trust region after an attempt, as MINPACK has it.
    fn resize(&mut self, ratio: f64, actual: f64, length: f64, predicted: &Reduction) {
        if ratio <= 0.25 {
            let slope = -predicted.slope;
            let shrink = if actual >= 0.0 {
                0.5
            } else {
                0.5 * slope / (slope + 0.5 * actual)
            };
            let shrink = if shrink.is_finite() {
                shrink.clamp(0.1, 0.5)
            } else {
                0.1
            };
            self.region = shrink * self.region.min(length / 0.1);
            self.damping /= shrink;
        } else if self.damping == 0.0 || ratio >= 0.75 {
            self.region = length / 0.5;
            self.damping *= 0.5;
        }
    }

    /// Gauss–Newton steps as long as they become shorter.
    fn polish(&mut self) {
        let mut shortest = f64::INFINITY;
        for _ in 0..100 {
            let qr = Qr::new(self.linear.jacobian.clone(), FLAT);
            if !qr.is_full() {
                return;
            }
            let step = full_step(&qr, &self.linear);
            let length = scaled_length(&self.scales, &step);
            // Far from the minimum it is not a matter of rounding yet.
            let magnitude = square(&self.linear.observed).sqrt();
            let near = length <= 0.1 * self.chi_squared.sqrt() + 1e-6 * magnitude;
            if !near || !(length < shortest) {
                return;
            }
            let trial: Vec<f64> = self.at.iter().zip(&step).map(|(b, d)| b + d).collect();
            let Some(there) = self.residuals.at(&trial, Some(&self.linear)) else {
                return;
            };
            let chi_squared = square(&there.residuals);
            if !(chi_squared <= self.chi_squared * (1.0 + 1e-6) + rounding(&there)) {
                return;
            }
            shortest = length;
            (self.at, self.linear, self.chi_squared) = (trial, there, chi_squared);
            self.iterations += 1;
            if length <= f64::EPSILON * scaled_length(&self.scales, &self.at) {
                return;
            }
        }
    }

    fn is_minimum(&self, qr: &Qr<f64>) -> bool {
        let p = self.at.len();
        let mut rotated = self.linear.residuals.clone();
        qr.transposed_times(&mut rotated);
        let taken = square(&rotated[..p]);
        let left = square(&rotated[p..]);
        let offset = OFFSET * OFFSET * left * p as f64 / (rotated.len() - p).max(1) as f64;
        taken <= offset.max(rounding(&self.linear))
    }
}

/// χ² that rounding of the response alone may bring about.
fn rounding(linear: &Linear) -> f64 {
    1e-24 * square(&linear.observed)
}

fn column_lengths(linear: &Linear) -> impl Iterator<Item = f64> {
    linear.jacobian.iter().map(|column| square(column).sqrt())
}

/// The step to the minimum of the linear model.
fn full_step(qr: &Qr<f64>, linear: &Linear) -> Vec<f64> {
    let mut rotated = linear.residuals.clone();
    qr.transposed_times(&mut rotated);
    qr.solve(&rotated[..linear.jacobian.len()])
}
