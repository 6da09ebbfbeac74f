//! Levenberg–Marquardt in the manner of MINPACK (Moré 1978), finished by Gauss–Newton steps.
//!
//! A minimum is recognised by the relative offset (Bates & Watts 1981): the part of the residuals
//! that a change of the parameters could take up, against the part that it could not. Near a
//! minimum the plain Gauss–Newton step is a better judge than χ², which is flat there and only
//! tells half the digits; so the last steps are made without asking χ².

use nalgebra::DMatrix;

use super::derivatives::{Block, Derivatives, blocks_of, derivatives};
use super::factor::{Qr, dot, square};
use super::problem::{Problem, Scale};
use super::solution::{Failure, Solution};
use super::whiten::Whitener;

/// Residuals of unit variance, as a function of the parameters.
pub(super) trait Residuals {
    /// At these parameters; None where the response is not finite. `near` is an earlier result
    /// from which to continue where something is iterated inside.
    fn at(&self, parameters: &[f64], near: Option<&Linear>) -> Option<Linear>;
}

/// Residuals, and how they follow the parameters.
#[derive(Clone)]
pub(super) struct Linear {
    /// Observed minus response, of unit variance.
    pub(super) residuals: Vec<f64>,
    /// Columns of the Jacobian of the response, of the same weight.
    pub(super) jacobian: Vec<Vec<f64>>,
    /// Errors of the predictors; empty where these are exact.
    pub(super) shifts: Vec<f64>,
    /// The observations, of the same weight.
    pub(super) observed: Vec<f64>,
    /// A constant response of one, of the same weight.
    pub(super) ones: Vec<f64>,
}

impl Linear {
    /// Puts together what independent blocks of points give.
    pub(super) fn join(parameters: usize) -> Linear {
        Linear {
            residuals: Vec::new(),
            jacobian: vec![Vec::new(); parameters],
            shifts: Vec::new(),
            observed: Vec::new(),
            ones: Vec::new(),
        }
    }

    /// 1 − χ²/χ²₀ with χ²₀ of the best constant.
    pub(super) fn r_squared(&self) -> f64 {
        let mean = dot(&self.ones, &self.observed) / square(&self.ones);
        let deviations: Vec<f64> = self
            .observed
            .iter()
            .zip(&self.ones)
            .map(|(y, one)| y - mean * one)
            .collect();
        1.0 - square(&self.residuals) / square(&deviations)
    }
}

/// Where the search ended.
pub(super) struct Minimum {
    pub(super) parameters: Vec<f64>,
    pub(super) linear: Linear,
    pub(super) iterations: usize,
}

/// Why it did not end in a minimum.
pub(super) enum Stuck {
    /// The response is not finite at the start.
    Start,
    /// The parameters there cannot be told apart.
    Flat { parameters: Vec<usize> },
    /// No progress, or no end.
    Lost {
        iterations: usize,
        parameters: Vec<f64>,
    },
}

/// Steps after which a search counts as lost.
const MOST_STEPS: usize = 5000;

/// Trust regions to begin with, in units of the scaled start: MINPACK's own, then shy ones for
/// starts from which a long step leads onto a plain.
const FIRST_REGIONS: [f64; 4] = [100.0, 1.0, 0.1, 0.01];

/// Relative offset below which the residuals cannot be improved noticeably.
const OFFSET: f64 = 1e-6;

/// Columns of the Jacobian that agree to this fraction make the problem flat.
const FLAT: f64 = 1e-14;

/// The minimum that the start leads to.
pub(super) fn minimise(residuals: &dyn Residuals, start: &[f64]) -> Result<Minimum, Stuck> {
    let first = residuals.at(start, None).ok_or(Stuck::Start)?;
    let mut reason = None;
    for region in FIRST_REGIONS {
        match Search::new(residuals, start, &first, region).run() {
            Ok(minimum) => return Ok(minimum),
            Err(stuck) => {
                reason.get_or_insert(stuck);
            }
        }
    }
    Err(reason.unwrap_or(Stuck::Start))
}

/// Estimates, covariance and derivatives of a checked problem with exact predictors.
pub(super) fn solve(problem: &Problem) -> Result<Solution, Failure> {
    let residuals = ExactPredictors {
        problem,
        whitener: Whitener::new(&problem.errors.y)?,
    };
    let start = problem.start.as_deref().ok_or(Failure::NoStart)?;
    let minimum = minimise(&residuals, start).map_err(|stuck| stuck.failure(problem, start))?;
    minimum.solution(problem, &blocks_of(problem))
}

impl Stuck {
    /// In terms of the problem.
    pub(super) fn failure(self, problem: &Problem, start: &[f64]) -> Failure {
        match self {
            Stuck::Start => Failure::Undefined {
                point: first_undefined(problem, start),
            },
            Stuck::Flat { parameters } => Failure::Indistinct { parameters },
            Stuck::Lost {
                iterations,
                parameters,
            } => Failure::NoConvergence {
                iterations,
                parameters,
            },
        }
    }
}

/// The first point at which the response is not finite.
fn first_undefined(problem: &Problem, parameters: &[f64]) -> usize {
    let (mut by_parameter, mut by_predictor) =
        (vec![0.0; parameters.len()], vec![0.0; problem.x.ncols()]);
    let undefined = |point: &usize| {
        let x: Vec<f64> = problem.x.row(*point).iter().copied().collect();
        let f = problem
            .response
            .at(&x, parameters, &mut by_parameter, &mut by_predictor);
        !f.is_finite() || by_parameter.iter().any(|slope| !slope.is_finite())
    };
    (0..problem.points()).find(undefined).unwrap_or(0)
}

impl Minimum {
    /// All that follows from a minimum.
    pub(super) fn solution(self, problem: &Problem, blocks: &[Block]) -> Result<Solution, Failure> {
        let Minimum {
            parameters,
            linear,
            iterations,
        } = self;
        let qr = Qr::new(linear.jacobian.clone(), FLAT);
        let chi_squared = square(&linear.residuals);
        let dof = problem.points() - parameters.len();
        let variance = if dof == 0 {
            f64::NAN
        } else {
            chi_squared / dof as f64
        };
        let normal = qr.inverse_normal();
        let adjusted_x = adjusted(problem, &linear.shifts);
        let Some(Derivatives { by_y, by_x }) =
            derivatives(problem, blocks, &parameters, &adjusted_x, &normal)
        else {
            return Err(Failure::NoConvergence {
                iterations,
                parameters,
            });
        };
        let (mut by_parameter, mut by_predictor) =
            (vec![0.0; parameters.len()], vec![0.0; problem.x.ncols()]);
        let fitted: Vec<f64> = (0..problem.points())
            .map(|point| {
                let x: Vec<f64> = adjusted_x.row(point).iter().copied().collect();
                problem
                    .response
                    .at(&x, &parameters, &mut by_parameter, &mut by_predictor)
            })
            .collect();
        Ok(Solution {
            covariance: match problem.errors.scale {
                Scale::Stated => normal,
                Scale::Residuals => normal * variance,
            },
            dof,
            chi_squared,
            residual_sd: variance.sqrt(),
            r_squared: linear.r_squared(),
            residuals: problem.y.iter().zip(&fitted).map(|(y, f)| y - f).collect(),
            fitted,
            adjusted_x,
            by_y,
            by_x,
            condition: qr.condition(),
            iterations,
            parameters,
        })
    }
}

/// Observed predictors without their errors.
fn adjusted(problem: &Problem, shifts: &[f64]) -> DMatrix<f64> {
    if shifts.is_empty() {
        return problem.x.clone();
    }
    let (n, m) = problem.x.shape();
    DMatrix::from_fn(n, m, |point, predictor| {
        problem.x[(point, predictor)] - shifts[predictor * n + point]
    })
}

/// Residuals of a problem with exact predictors.
pub(super) struct ExactPredictors<'a> {
    pub(super) problem: &'a Problem<'a>,
    pub(super) whitener: Whitener<f64>,
}

impl Residuals for ExactPredictors<'_> {
    fn at(&self, parameters: &[f64], _near: Option<&Linear>) -> Option<Linear> {
        let problem = self.problem;
        let (n, m) = (problem.points(), problem.x.ncols());
        let mut linear = Linear::join(parameters.len());
        let mut by_parameter = vec![0.0; parameters.len()];
        let mut by_predictor = vec![0.0; m];
        let mut x = vec![0.0; m];
        for point in 0..n {
            for (cell, observed) in x.iter_mut().zip(problem.x.row(point).iter()) {
                *cell = *observed;
            }
            let f = problem
                .response
                .at(&x, parameters, &mut by_parameter, &mut by_predictor);
            if !f.is_finite() || by_parameter.iter().any(|slope| !slope.is_finite()) {
                return None;
            }
            linear.residuals.push(problem.y[point] - f);
            for (column, slope) in linear.jacobian.iter_mut().zip(&by_parameter) {
                column.push(*slope);
            }
        }
        linear.observed = problem.y.iter().copied().collect();
        linear.ones = vec![1.0; n];
        let Linear {
            residuals,
            jacobian,
            observed,
            ones,
            ..
        } = &mut linear;
        for column in jacobian.iter_mut().chain([residuals, observed, ones]) {
            self.whitener.whiten(column);
        }
        Some(linear)
    }
}

struct Search<'a> {
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
    fn new(residuals: &'a dyn Residuals, start: &[f64], first: &Linear, factor: f64) -> Self {
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

    fn run(mut self) -> Result<Minimum, Stuck> {
        while self.iterations < MOST_STEPS && self.step() == Progress::Moving {}
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

fn scaled_length(scales: &[f64], step: &[f64]) -> f64 {
    scales
        .iter()
        .zip(step)
        .map(|(d, s)| (d * s).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// The step to the minimum of the linear model.
fn full_step(qr: &Qr<f64>, linear: &Linear) -> Vec<f64> {
    let mut rotated = linear.residuals.clone();
    qr.transposed_times(&mut rotated);
    qr.solve(&rotated[..linear.jacobian.len()])
}

/// The linear model of the residuals around a point: small enough to be solved many times.
struct Model {
    /// R, in the order of the parameters: columns of length p.
    columns: Vec<Vec<f64>>,
    /// Qᵀ r.
    projected: Vec<f64>,
    scales: Vec<f64>,
}

/// What the linear model promises, as fractions of χ².
struct Reduction {
    whole: f64,
    /// Half the slope of χ² along the step.
    slope: f64,
}

impl Model {
    fn new(linear: &Linear, scales: &[f64]) -> Model {
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
    fn within(&self, region: f64, guess: f64) -> (Vec<f64>, f64) {
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
        if high == 0.0 {
            high = f64::MIN_POSITIVE / region.min(0.1);
        }
        let mut damping = guess.clamp(low.min(high), high);
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

    fn reduction(&self, step: &[f64], damping: f64, scales: &[f64], chi_squared: f64) -> Reduction {
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
