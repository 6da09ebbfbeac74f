//! How the estimates follow the observations: the implicit-function theorem at the minimum.
//!
//! With e = (e_x, e_y) and a multiplier λ for each point, a minimum of eᵀ V⁻¹ e under
//! y − e_y = f(ξ, β), ξ = x − e_x, satisfies
//!
//! ```text
//! Jᵀ λ = 0,    x − ξ = (V_xy − V_xx Fᵀ) λ,    y − f = (V_yy − V_yx Fᵀ) λ.
//! ```
//!
//! Differentiated, dξ and dλ of independent blocks of points are eliminated block by block. The
//! second derivatives of f take part, so that these are the derivatives of the estimator itself,
//! not of its linear model. Should the exact matrix not be positive definite (which at a proper
//! minimum it is), second derivatives are left out: the Gauss–Newton approximation.

use nalgebra::{DMatrix, DVector};

use super::problem::{Problem, Response, Spread};

/// Points whose errors may be correlated with one another, but not with those of other blocks.
pub(super) struct Block {
    /// Their rows.
    pub(super) points: Vec<usize>,
    /// Covariance matrix of (e_x of the first predictor, …, of the last, e_y), each for all
    /// points.
    pub(super) v: DMatrix<f64>,
}

impl Block {
    /// Covariances of the columns `a` and `b`; the last column is y.
    pub(super) fn part(
        &self,
        a: std::ops::Range<usize>,
        b: std::ops::Range<usize>,
    ) -> DMatrix<f64> {
        let k = self.points.len();
        self.v
            .view((a.start * k, b.start * k), (a.len() * k, b.len() * k))
            .into_owned()
    }
}

/// The blocks of a problem: single points where all errors are independent, else one for all.
pub(super) fn blocks_of(problem: &Problem) -> Vec<Block> {
    let errors = &problem.errors;
    let n = problem.points();
    let matrix = |spread: &Spread| matches!(spread, Spread::Matrix(_));
    let blocks: Vec<Vec<usize>> = if matrix(&errors.y) || errors.x.iter().any(matrix) {
        vec![(0..n).collect()]
    } else {
        (0..n).map(|point| vec![point]).collect()
    };
    let columns = errors.x.len() + 1;
    // Nothing stated at all: all errors of y alike.
    let alike = errors.predictors_are_exact() && errors.y == Spread::Exact;
    let of_column = |column: usize| {
        if column + 1 == columns {
            &errors.y
        } else {
            &errors.x[column]
        }
    };
    let mut built = Vec::with_capacity(blocks.len());
    for points in blocks {
        let k = points.len();
        let mut v = DMatrix::zeros(columns * k, columns * k);
        for column in 0..columns {
            for (i, &a) in points.iter().enumerate() {
                for (j, &b) in points.iter().enumerate() {
                    v[(column * k + i, column * k + j)] = match of_column(column) {
                        Spread::Exact if alike && column + 1 == columns && a == b => 1.0,
                        Spread::Each(u) if a == b => u[a] * u[a],
                        Spread::Matrix(matrix) => matrix[(a, b)],
                        _ => 0.0,
                    };
                }
            }
        }
        if let Some(correlation) = &errors.correlation {
            for (i, &point) in points.iter().enumerate() {
                let covariance = correlation[point] * (v[(i, i)] * v[(k + i, k + i)]).sqrt();
                v[(i, k + i)] = covariance;
                v[(k + i, i)] = covariance;
            }
        }
        built.push(Block { points, v });
    }
    built
}

/// ∂β/∂y, and ∂β/∂x for each predictor.
pub(super) struct Derivatives {
    pub(super) by_y: DMatrix<f64>,
    pub(super) by_x: Vec<DMatrix<f64>>,
}

/// Of the minimum with these adjusted predictors; `covariance` is (Jᵀ C⁻¹ J)⁻¹. None if a matrix
/// cannot be inverted.
pub(super) fn derivatives(
    problem: &Problem,
    blocks: &[Block],
    parameters: &[f64],
    adjusted: &DMatrix<f64>,
    covariance: &DMatrix<f64>,
) -> Option<Derivatives> {
    let steps: Vec<f64> = (0..parameters.len())
        .map(|j| {
            difference_step(
                parameters[j],
                covariance[(j, j)].sqrt(),
                problem.response.is_linear(),
            )
        })
        .collect();
    solve(problem, blocks, parameters, adjusted, Some(&steps))
        .or_else(|| solve(problem, blocks, parameters, adjusted, None))
}

/// Third root of the rounding unit: where truncation and rounding of a central difference meet.
const CENTRAL: f64 = 6e-6;

/// Half the distance of the points of a central difference.
fn difference_step(value: f64, u: f64, linear: bool) -> f64 {
    if linear {
        // Exact whatever the step.
        return value.abs().max(1.0);
    }
    let size = if value != 0.0 {
        value.abs()
    } else if u > 0.0 && u.is_finite() {
        u
    } else {
        1.0
    };
    CENTRAL * size
}

/// One block after elimination.
struct Eliminated {
    /// J* ᵀ K⁻¹: p×k.
    by_y: DMatrix<f64>,
    /// P M⁻¹ − J*ᵀ K⁻¹ G M⁻¹: p×mk.
    by_x: DMatrix<f64>,
}

fn solve(
    problem: &Problem,
    blocks: &[Block],
    parameters: &[f64],
    adjusted: &DMatrix<f64>,
    steps: Option<&[f64]>,
) -> Option<Derivatives> {
    let (n, p, m) = (problem.points(), parameters.len(), problem.x.ncols());
    let mut normal = DMatrix::zeros(p, p);
    let mut eliminated = Vec::with_capacity(blocks.len());
    for block in blocks {
        eliminated.push(eliminate(
            problem,
            block,
            parameters,
            adjusted,
            steps,
            &mut normal,
        )?);
    }
    let scale = DVector::from_fn(p, |j, _| 1.0 / f64::sqrt(normal[(j, j)]));
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    let scale = DMatrix::from_diagonal(&scale);
    let symmetric = &scale * (&normal + normal.transpose()) * 0.5 * &scale;
    let inverse = &scale * symmetric.cholesky()?.inverse() * &scale;
    let mut by_y = DMatrix::zeros(p, n);
    let mut by_x = vec![DMatrix::zeros(p, n); m];
    for (block, eliminated) in blocks.iter().zip(&eliminated) {
        let k = block.points.len();
        let y = &inverse * &eliminated.by_y;
        let x = &inverse * &eliminated.by_x;
        for (place, &point) in block.points.iter().enumerate() {
            by_y.set_column(point, &y.column(place));
            for (predictor, by_x) in by_x.iter_mut().enumerate() {
                by_x.set_column(point, &x.column(predictor * k + place));
            }
        }
    }
    Some(Derivatives { by_y, by_x })
}

/// Adds the block's part to the matrix of the parameters, and returns its right-hand sides.
fn eliminate(
    problem: &Problem,
    block: &Block,
    parameters: &[f64],
    adjusted: &DMatrix<f64>,
    steps: Option<&[f64]>,
    normal: &mut DMatrix<f64>,
) -> Option<Eliminated> {
    let (p, m, k) = (parameters.len(), problem.x.ncols(), block.points.len());
    let mut jacobian = DMatrix::zeros(k, p);
    let mut slopes = DMatrix::zeros(k, m * k);
    let mut misfit = DVector::zeros(k);
    let (mut by_parameter, mut by_predictor) = (vec![0.0; p], vec![0.0; m]);
    for (row, &point) in block.points.iter().enumerate() {
        let x: Vec<f64> = adjusted.row(point).iter().copied().collect();
        let f = problem
            .response
            .at(&x, parameters, &mut by_parameter, &mut by_predictor);
        for (j, slope) in by_parameter.iter().enumerate() {
            jacobian[(row, j)] = *slope;
        }
        for (l, slope) in by_predictor.iter().enumerate() {
            slopes[(row, l * k + row)] = *slope;
            // y − f + F (ξ − x) = C λ, whatever the iteration left of the constraint.
            misfit[row] += slope * (adjusted[(point, l)] - problem.x[(point, l)]);
        }
        misfit[row] += problem.y[point] - f;
    }
    let v_xx = block.part(0..m, 0..m);
    let v_xy = block.part(0..m, m..m + 1);
    let v_yy = block.part(m..m + 1, m..m + 1);
    let v_yx = v_xy.transpose();
    let b = &v_xy - &v_xx * slopes.transpose();
    let d = &v_yy - &v_yx * slopes.transpose();
    let c = &d - &slopes * &b;
    let multipliers = c.lu().solve(&misfit)?;

    let mut bend_xx = DMatrix::zeros(m * k, m * k);
    let mut bend_bx = DMatrix::zeros(p, m * k);
    if let Some(steps) = steps {
        for (row, &point) in block.points.iter().enumerate() {
            let x: Vec<f64> = adjusted.row(point).iter().copied().collect();
            let u: Vec<f64> = (0..m)
                .map(|l| v_xx[(l * k + row, l * k + row)].sqrt())
                .collect();
            let bend = second_derivatives(problem.response, &x, &u, parameters, steps);
            if bend.iter().any(|b| !b.is_finite()) {
                return None;
            }
            let bend = bend * multipliers[row];
            for i in 0..m {
                for j in 0..m {
                    bend_xx[(i * k + row, j * k + row)] = bend[(p + i, p + j)];
                }
                for j in 0..p {
                    bend_bx[(j, i * k + row)] = bend[(j, p + i)];
                }
            }
            *normal -= bend.view((0, 0), (p, p));
        }
    }
    let unit = DMatrix::identity(m * k, m * k);
    let inverse = (unit - &v_xx * &bend_xx).try_inverse()?;
    let g = &slopes - &v_yx * &bend_xx;
    let g_inverse = &g * &inverse;
    let stiff = &d - &g_inverse * &b;
    let outer = jacobian - (&v_yx - &g_inverse * &v_xx) * bend_bx.transpose();
    let by_y = stiff.lu().solve(&outer)?.transpose();
    *normal += &by_y * &outer - &bend_bx * &inverse * &v_xx * bend_bx.transpose();
    let by_x = bend_bx * inverse - &by_y * g_inverse;
    Some(Eliminated { by_y, by_x })
}

/// Second derivatives by (parameters, predictors), by central differences of the exact first ones.
fn second_derivatives(
    response: &dyn Response,
    x: &[f64],
    u: &[f64],
    parameters: &[f64],
    steps: &[f64],
) -> DMatrix<f64> {
    let (p, m) = (parameters.len(), x.len());
    let mut bend = DMatrix::zeros(p + m, p + m);
    let gradient = |x: &[f64], parameters: &[f64]| {
        let mut gradient = vec![0.0; p + m];
        let (by_parameter, by_predictor) = gradient.split_at_mut(p);
        response.at(x, parameters, by_parameter, by_predictor);
        gradient
    };
    for j in 0..p + m {
        let shifted = |sign: f64| {
            let (mut x, mut parameters) = (x.to_vec(), parameters.to_vec());
            let cell = if j < p {
                &mut parameters[j]
            } else {
                &mut x[j - p]
            };
            let step = if j < p {
                steps[j]
            } else {
                difference_step(*cell, u[j - p], false)
            };
            let before = *cell;
            *cell += sign * step;
            (gradient(&x, &parameters), before + sign * step)
        };
        let ((above, high), (below, low)) = (shifted(1.0), shifted(-1.0));
        for i in 0..p + m {
            bend[(i, j)] = (above[i] - below[i]) / (high - low);
        }
    }
    (&bend + bend.transpose()) * 0.5
}
