//! Predictors with errors: York's line (1966, 2004), ISO/TS 28037 clauses 7 to 10, and the same
//! for curves, several predictors, and covariance matrices of whole columns.
//!
//! For given parameters, the errors of each independent block of points (one point, unless a
//! column has a covariance matrix) are found first: with slopes F at the adjusted points and
//! A = (−F, 1), the linearised constraint gives
//!
//! ```text
//! C = A V Aᵀ,    λ = C⁻¹ (y − f + F (ξ − x)),    e = V Aᵀ λ,
//! ```
//!
//! and the new ξ = x − e_x; V need not be invertible. This ends in the point of the curve that is
//! nearest in the metric of V. There the residuals L⁻¹ (y − f + F (ξ − x)), L Lᵀ = C, have the
//! square χ² = eᵀ V⁻¹ e, and L⁻¹ J has its gradient: what remains is an ordinary problem in the
//! parameters alone.

use nalgebra::{DMatrix, DVector};

use super::derivatives::{Block, blocks_of};
use super::factor::{Cholesky, is_symmetric};
use super::nonlinear::{Linear, Residuals, minimise};
use super::problem::{Errors, Problem, Scale, Spread};
use super::solution::{Failure, Observed, Solution};

/// Iterations within a block for one set of parameters.
const MOST_INNER_STEPS: usize = 50;

/// Estimates, covariance and derivatives of a checked problem.
pub(super) fn solve(problem: &Problem) -> Result<Solution, Failure> {
    let blocks = blocks_of(problem);
    check(problem, &blocks)?;
    let residuals = UncertainPredictors::new(problem, &blocks);
    let mut failure = None;
    for start in starts(problem) {
        match minimise(&residuals, &start) {
            Ok(minimum) => return minimum.solution(problem, &blocks),
            Err(stuck) => {
                failure.get_or_insert(stuck.failure(problem, &start));
            }
        }
    }
    Err(failure.unwrap_or(Failure::NoStart))
}

/// Covariance matrices without negative variance, and an error in every point.
fn check(problem: &Problem, blocks: &[Block]) -> Result<(), Failure> {
    let columns = problem
        .errors
        .x
        .iter()
        .enumerate()
        .map(|(k, x)| (Observed::X(k), x));
    for (observed, spread) in columns.chain([(Observed::Y, &problem.errors.y)]) {
        if let Spread::Matrix(v) = spread
            && (!is_symmetric(v) || Factor::new(v).is_none())
        {
            return Err(Failure::Covariance { observed });
        }
    }
    for block in blocks {
        for (place, &point) in block.points.iter().enumerate() {
            let k = block.points.len();
            if (0..=problem.x.ncols())
                .all(|column| block.v[(column * k + place, column * k + place)] == 0.0)
            {
                return Err(Failure::Uncertainty {
                    observed: Observed::Y,
                    point,
                });
            }
        }
        if Factor::new(&block.v).is_none() {
            return Err(Failure::Correlation {
                point: block.points[0],
            });
        }
    }
    Ok(())
}

/// Where to begin: the fit without errors of the predictors, then what the user says.
fn starts(problem: &Problem) -> Vec<Vec<f64>> {
    let n = problem.points();
    let y = match &problem.errors.y {
        Spread::Each(u) if u.iter().all(|u| *u > 0.0) => Spread::Each(u.clone()),
        Spread::Matrix(v) => Spread::Each(v.diagonal().iter().map(|v| v.sqrt()).collect()),
        _ => Spread::Each(vec![1.0; n]),
    };
    let exact = Problem {
        response: problem.response,
        x: problem.x.clone(),
        y: problem.y.clone(),
        errors: Errors {
            y,
            scale: Scale::Stated,
            ..Errors::ordinary(n, problem.x.ncols())
        },
        start: problem.start.clone(),
    };
    let fit = super::solve(&exact)
        .ok()
        .map(|solution| solution.parameters);
    fit.into_iter().chain(problem.start.clone()).collect()
}

/// Residuals with the errors of the predictors eliminated.
pub(super) struct UncertainPredictors<'a> {
    problem: &'a Problem<'a>,
    blocks: Vec<Prepared<'a>>,
}

/// A block with the parts of its covariance matrix.
struct Prepared<'a> {
    block: &'a Block,
    v_xx: DMatrix<f64>,
    v_xy: DMatrix<f64>,
    v_yy: DMatrix<f64>,
    factor: Option<Factor>,
    /// Its responses as they were read.
    observed: DVector<f64>,
}

/// The response of a block at adjusted predictors.
struct Local {
    f: DVector<f64>,
    jacobian: DMatrix<f64>,
    /// F, one column for each error of a predictor.
    slopes: DMatrix<f64>,
}

/// Points of the curve for a block.
struct Place {
    /// Errors of the predictors by which they are reached, point by point of each predictor.
    shifts: DVector<f64>,
    local: Local,
    /// eᵀ V⁻¹ e; None where errors without variance would be needed.
    distance: Option<f64>,
}

/// A block with its errors eliminated.
struct Projected {
    place: Place,
    misfit: DVector<f64>,
    factor: Cholesky<f64>,
}

impl<'a> UncertainPredictors<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, blocks: &'a [Block]) -> Self {
        let m = problem.x.ncols();
        let prepare = |block: &'a Block| Prepared {
            block,
            v_xx: block.part(0..m, 0..m),
            v_xy: block.part(0..m, m..m + 1),
            v_yy: block.part(m..m + 1, m..m + 1),
            factor: Factor::new(&block.v),
            observed: DVector::from_iterator(
                block.points.len(),
                block.points.iter().map(|point| problem.y[*point]),
            ),
        };
        UncertainPredictors {
            problem,
            blocks: blocks.iter().map(prepare).collect(),
        }
    }

    fn local(&self, block: &Block, parameters: &[f64], shifts: &DVector<f64>) -> Option<Local> {
        let (p, m, k) = (parameters.len(), self.problem.x.ncols(), block.points.len());
        let mut local = Local {
            f: DVector::zeros(k),
            jacobian: DMatrix::zeros(k, p),
            slopes: DMatrix::zeros(k, m * k),
        };
        let (mut by_parameter, mut by_predictor) = (vec![0.0; p], vec![0.0; m]);
        let mut x = vec![0.0; m];
        for (row, &point) in block.points.iter().enumerate() {
            for (l, x) in x.iter_mut().enumerate() {
                *x = self.problem.x[(point, l)] - shifts[l * k + row];
            }
            let response = self.problem.response;
            local.f[row] = response.at(&x, parameters, &mut by_parameter, &mut by_predictor);
            for (j, slope) in by_parameter.iter().enumerate() {
                local.jacobian[(row, j)] = *slope;
            }
            for (l, slope) in by_predictor.iter().enumerate() {
                local.slopes[(row, l * k + row)] = *slope;
            }
        }
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let whole = finite(local.f.as_slice())
            && finite(local.jacobian.as_slice())
            && finite(local.slopes.as_slice());
        whole.then_some(local)
    }

    /// The points of the curve that these errors of the predictors reach.
    fn place(
        &self,
        prepared: &Prepared,
        parameters: &[f64],
        shifts: DVector<f64>,
    ) -> Option<Place> {
        let local = self.local(prepared.block, parameters, &shifts)?;
        let distance = prepared.distance(&shifts, &(&prepared.observed - &local.f));
        Some(Place {
            shifts,
            local,
            distance,
        })
    }

    /// The nearest points of the curve, from a first guess.
    fn project(
        &self,
        prepared: &Prepared,
        parameters: &[f64],
        guess: DVector<f64>,
    ) -> Option<Projected> {
        let mut place = self.place(prepared, parameters, guess)?;
        for step in 0.. {
            let Place { shifts, local, .. } = &place;
            let misfit = &prepared.observed - &local.f - &local.slopes * shifts;
            let across = &prepared.v_xy - &prepared.v_xx * local.slopes.transpose();
            let c = &prepared.v_yy
                - prepared.v_xy.transpose() * local.slopes.transpose()
                - &local.slopes * &across;
            let factor = Cholesky::new(&((&c + c.transpose()) * 0.5))?;
            let mut multipliers = misfit.clone();
            factor.lower(multipliers.as_mut_slice());
            factor.upper(multipliers.as_mut_slice());
            let change = across * multipliers - shifts;
            let moved = (step < MOST_INNER_STEPS && !self.is_rounding(prepared, shifts, &change))
                .then(|| self.move_towards(prepared, parameters, &place, &change))
                .flatten();
            let Some(moved) = moved else {
                return Some(Projected {
                    place,
                    misfit,
                    factor,
                });
            };
            place = moved;
        }
        None
    }

    /// Whether a change of the errors of predictors is below what they are known to, or what the predictors are
    /// rounded to.
    fn is_rounding(
        &self,
        prepared: &Prepared,
        shifts: &DVector<f64>,
        change: &DVector<f64>,
    ) -> bool {
        let points = &prepared.block.points;
        let mut pairs = change.iter().zip(shifts).enumerate();
        pairs.all(|(index, (change, shift))| {
            let u = prepared.v_xx[(index, index)].sqrt();
            let x = self.problem.x[(points[index % points.len()], index / points.len())];
            change.abs() <= 1e-13 * (shift.abs() + u) + 4.0 * f64::EPSILON * x.abs()
        })
    }

    /// The whole change, or as much of it as brings the points nearer. None where nothing does:
    /// that is rounding.
    fn move_towards(
        &self,
        prepared: &Prepared,
        parameters: &[f64],
        from: &Place,
        change: &DVector<f64>,
    ) -> Option<Place> {
        let mut part = 1.0;
        for _ in 0..30 {
            let moved = self.place(prepared, parameters, &from.shifts + change * part);
            let nearer = moved.filter(|moved| match (moved.distance, from.distance) {
                (Some(there), Some(here)) => there <= here * (1.0 + 1e-12),
                _ => true,
            });
            if nearer.is_some() {
                return nearer;
            }
            part *= 0.5;
        }
        None
    }
}

impl Prepared<'_> {
    /// eᵀ V⁻¹ e; None where errors without variance would be needed.
    fn distance(&self, shifts: &DVector<f64>, rest: &DVector<f64>) -> Option<f64> {
        let errors: Vec<f64> = shifts.iter().chain(rest.iter()).copied().collect();
        self.factor.as_ref()?.distance(&errors)
    }
}

impl Residuals for UncertainPredictors<'_> {
    fn at(&self, parameters: &[f64], near: Option<&Linear>) -> Option<Linear> {
        let (n, m) = self.problem.x.shape();
        let mut linear = Linear::join(parameters.len());
        linear.shifts = vec![0.0; n * m];
        for prepared in &self.blocks {
            let points = &prepared.block.points;
            let places = (0..m).flat_map(|l| points.iter().map(move |point| l * n + point));
            let places: Vec<usize> = places.collect();
            let guess = DVector::from_iterator(
                places.len(),
                places
                    .iter()
                    .map(|place| near.map_or(0.0, |near| near.shifts[*place])),
            );
            let mut projected = self.project(prepared, parameters, guess)?;
            for (place, shift) in places.iter().zip(&projected.place.shifts) {
                linear.shifts[*place] = *shift;
            }
            let factor = &projected.factor;
            factor.lower(projected.misfit.as_mut_slice());
            linear.residuals.extend(projected.misfit.iter());
            for (joined, mut column) in linear
                .jacobian
                .iter_mut()
                .zip(projected.place.local.jacobian.column_iter_mut())
            {
                factor.lower(column.as_mut_slice());
                joined.extend(column.iter());
            }
            let mut ones = vec![1.0; points.len()];
            factor.lower(&mut ones);
            linear.ones.extend(ones);
            let mut observed = prepared.observed.clone();
            factor.lower(observed.as_mut_slice());
            linear.observed.extend(observed.iter());
        }
        Some(linear)
    }
}

/// Cholesky's factor of a covariance matrix that may be singular: errors without variance, or
/// that follow from others, have a zero on the diagonal.
struct Factor {
    lower: DMatrix<f64>,
}

impl Factor {
    /// None if there is a negative variance.
    fn new(v: &DMatrix<f64>) -> Option<Factor> {
        let n = v.nrows();
        let tolerance = 1e-12 * n as f64;
        let mut lower: DMatrix<f64> = DMatrix::zeros(n, n);
        for j in 0..n {
            let left = v[(j, j)] - lower.row(j).columns(0, j).norm_squared();
            if left < -tolerance * v[(j, j)] {
                return None;
            }
            let singular = left <= tolerance * v[(j, j)];
            let root = if singular { 0.0 } else { left.sqrt() };
            lower[(j, j)] = root;
            for i in j + 1..n {
                let rest = v[(i, j)] - lower.row(i).columns(0, j).dot(&lower.row(j).columns(0, j));
                if !singular {
                    lower[(i, j)] = rest / root;
                } else if rest.abs() > tolerance.sqrt() * (v[(i, i)] * v[(j, j)]).sqrt() {
                    return None;
                }
            }
        }
        Some(Factor { lower })
    }

    /// |t|² of the t with L t = e; None if there is none.
    fn distance(&self, errors: &[f64]) -> Option<f64> {
        let mut t: DVector<f64> = DVector::zeros(errors.len());
        for (i, error) in errors.iter().enumerate() {
            let rest = error
                - self
                    .lower
                    .row(i)
                    .columns(0, i)
                    .transpose()
                    .dot(&t.rows(0, i));
            let diagonal = self.lower[(i, i)];
            if diagonal > 0.0 {
                t[i] = rest / diagonal;
            } else if rest.abs() > 1e-9 * error.abs() {
                return None;
            }
        }
        Some(t.norm_squared())
    }
}
