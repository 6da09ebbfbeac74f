//! Published straight lines, explicit formulas, brute force and simulation.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng, rngs::StdRng};

use super::*;

const LINE: Polynomial = Polynomial {
    degree: 1,
    intercept: true,
};

/// a (1 − exp(−b x)) + c z: bent in a predictor and in a parameter.
struct Saturating;

impl Response for Saturating {
    fn parameters(&self) -> usize {
        3
    }
    fn is_linear(&self) -> bool {
        false
    }
    fn at(&self, x: &[f64], b: &[f64], by_b: &mut [f64], by_x: &mut [f64]) -> f64 {
        let decay = (-b[1] * x[0]).exp();
        by_b.copy_from_slice(&[1.0 - decay, b[0] * x[0] * decay, x[1]]);
        by_x.copy_from_slice(&[b[0] * b[1] * decay, b[2]]);
        b[0] * (1.0 - decay) + b[2] * x[1]
    }
}

/// Affine in the parameters, two predictors, an offset: 1 + a x z + b z² .
struct Affine;

impl Response for Affine {
    fn parameters(&self) -> usize {
        2
    }
    fn is_linear(&self) -> bool {
        true
    }
    fn at(&self, x: &[f64], b: &[f64], by_b: &mut [f64], by_x: &mut [f64]) -> f64 {
        by_b.copy_from_slice(&[x[0] * x[1], x[1] * x[1]]);
        by_x.copy_from_slice(&[b[0] * x[1], b[0] * x[0] + 2.0 * b[1] * x[1]]);
        1.0 + b[0] * x[0] * x[1] + b[1] * x[1] * x[1]
    }
}

fn column(x: &[f64]) -> DMatrix<f64> {
    DMatrix::from_column_slice(x.len(), 1, x)
}

fn line(x: &[f64], y: &[f64], u_x: Spread, u_y: Spread) -> Problem<'static> {
    let errors = Errors {
        y: u_y,
        x: vec![u_x],
        correlation: None,
        scale: Scale::Stated,
    };
    Problem {
        response: &LINE,
        x: column(x),
        y: DVector::from_column_slice(y),
        errors,
        start: None,
    }
}

fn near(got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got - expected).abs() <= tolerance,
        "{got} instead of {expected}"
    );
}

fn u(solution: &Solution, j: usize) -> f64 {
    solution.covariance[(j, j)].sqrt()
}

#[test]
fn iso_28037_clause_6() {
    let y = [3.3, 5.6, 7.1, 9.3, 10.7, 12.1];
    let x = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let problem = line(&x, &y, Spread::Exact, Spread::Each(vec![0.5; 6]));
    let solution = solve(&problem).unwrap();
    near(solution.parameters[0], 1.866667, 5e-7);
    near(solution.parameters[1], 1.757143, 5e-7);
    near(u(&solution, 0), 0.4654747, 5e-8);
    near(u(&solution, 1), 0.1195229, 5e-8);
    near(solution.covariance[(0, 1)], -0.05, 1e-12);
    near(solution.chi_squared, 1.665, 5e-4);
    let test = lack_of_fit(&problem, &solution).unwrap();
    // ν = 4: (1 + χ²/2) exp(−χ²/2).
    let half = 0.5 * solution.chi_squared;
    near(test.probability, (1.0 + half) * (-half).exp(), 1e-14);
}

#[test]
fn iso_28037_clause_7() {
    let solution = solve(&line(
        &[1.2, 1.9, 2.9, 4.0, 4.7, 5.9],
        &[3.4, 4.4, 7.2, 8.5, 10.8, 13.5],
        Spread::Each(vec![0.2; 6]),
        Spread::Each(vec![0.2, 0.2, 0.2, 0.4, 0.4, 0.4]),
    ))
    .unwrap();
    near(solution.parameters[0], 0.5788, 5e-5);
    near(solution.parameters[1], 2.1597, 5e-5);
    near(u(&solution, 0), 0.4764, 5e-5);
    near(u(&solution, 1), 0.1355, 5e-5);
    near(solution.covariance[(0, 1)], -0.0577, 5e-5);
    near(solution.chi_squared, 2.743, 5e-4);
}

/// Pearson's points with York's weights.
fn pearson_york() -> Problem<'static> {
    let x = [0.0, 0.9, 1.8, 2.6, 3.3, 4.4, 5.2, 6.1, 6.5, 7.4];
    let y = [5.9, 5.4, 4.4, 4.6, 3.5, 3.7, 2.8, 2.8, 2.4, 1.5];
    let w_x: [f64; 10] = [
        1000.0, 1000.0, 500.0, 800.0, 200.0, 80.0, 60.0, 20.0, 1.8, 1.0,
    ];
    let w_y: [f64; 10] = [1.0, 1.8, 4.0, 8.0, 20.0, 20.0, 70.0, 70.0, 100.0, 500.0];
    let spread = |w: [f64; 10]| Spread::Each(w.iter().map(|w| 1.0 / w.sqrt()).collect());
    line(&x, &y, spread(w_x), spread(w_y))
}

#[test]
fn pearson_with_weights_of_york() {
    let problem = pearson_york();
    let solution = solve(&problem).unwrap();
    near(solution.parameters[0], 5.47991022, 5e-9);
    near(solution.parameters[1], -0.480533407, 5e-10);
    near(solution.chi_squared, 11.8663531941, 5e-10);
    near(u(&solution, 0), 0.2949707, 5e-7);
    near(u(&solution, 1), 0.057985, 5e-6);
    // The derivatives of the estimator itself give the uncertainties that Kalantar (1992) and the
    // GUM Tree Calculator find by implicit differentiation.
    let v = from_derivatives(&problem, &solution);
    near(v[(0, 0)].sqrt(), 0.29193, 5e-6);
    near(v[(1, 1)].sqrt(), 0.057617, 5e-7);
}

/// The covariance matrix that the derivatives by the observations give.
fn from_derivatives(problem: &Problem, solution: &Solution) -> DMatrix<f64> {
    let matrix = |spread: &Spread| match spread {
        Spread::Exact => DMatrix::zeros(problem.points(), problem.points()),
        Spread::Each(u) => DMatrix::from_diagonal(&DVector::from_fn(u.len(), |i, _| u[i] * u[i])),
        Spread::Matrix(v) => v.clone(),
    };
    let mut v = &solution.by_y * matrix(&problem.errors.y) * solution.by_y.transpose();
    for (by_x, spread) in solution.by_x.iter().zip(&problem.errors.x) {
        v += by_x * matrix(spread) * by_x.transpose();
    }
    v
}

#[test]
fn bevington_table_6_1() {
    let x = [4.0, 8.0, 12.5, 16.0, 20.0, 25.0, 31.0, 36.0, 40.0, 40.0];
    let y = [3.7, 7.8, 12.1, 15.6, 19.8, 24.5, 30.7, 35.5, 39.4, 39.5];
    let mut problem = line(&x, &y, Spread::Exact, Spread::Exact);
    problem.errors.scale = Scale::Residuals;
    let solution = solve(&problem).unwrap();
    near(solution.parameters[0], -0.222142, 5e-7);
    near(solution.parameters[1], 0.99278, 5e-6);
    near(u(&solution, 0), 0.06962967, 5e-9);
    near(u(&solution, 1), 0.002636608, 5e-10);
    near(solution.covariance[(0, 1)], -0.0001616271, 5e-11);
    assert_eq!(lack_of_fit(&problem, &solution), None);
    let replicated = replicates(&problem, &solution).unwrap();
    assert_eq!(
        (replicated.pure_error_dof, replicated.lack_of_fit_dof),
        (1, 7)
    );
    near(replicated.pure_error, 0.005, 1e-14);
}

#[test]
fn natrella_youngs_modulus() {
    let x: Vec<f64> = [30.0]
        .into_iter()
        .chain((1..=15).map(|i| 100.0 * f64::from(i)))
        .collect();
    let y = [
        4642.0, 4612.0, 4565.0, 4513.0, 4476.0, 4433.0, 4389.0, 4347.0, 4303.0, 4251.0, 4201.0,
        4140.0, 4100.0, 4073.0, 4024.0, 3999.0,
    ];
    let mut problem = line(&x, &y, Spread::Exact, Spread::Exact);
    problem.errors.scale = Scale::Residuals;
    let solution = solve(&problem).unwrap();
    near(solution.parameters[0], 4654.9846, 5e-5);
    near(solution.parameters[1], -0.44985482, 5e-9);
    near(u(&solution, 1), 0.0050644886, 5e-10);
    near(solution.residual_sd, 9.277617, 1e-6);
}

#[test]
fn replicates_by_hand() {
    // Means 2, 3, 10 at x = 1, 2, 3; the line 4 x − 3.
    let mut problem = line(
        &[1.0, 2.0, 3.0, 1.0, 2.0, 3.0],
        &[1.0, 2.0, 9.0, 3.0, 4.0, 11.0],
        Spread::Exact,
        Spread::Exact,
    );
    problem.errors.scale = Scale::Residuals;
    let test = replicates(&problem, &solve(&problem).unwrap()).unwrap();
    near(test.pure_error, 6.0, 1e-12);
    near(test.lack_of_fit, 12.0, 1e-12);
    near(test.f, 6.0, 1e-12);
    // F with one degree of freedom is t², and t with three has a closed form.
    let root = 2.0_f64.sqrt();
    let expected = 1.0 - std::f64::consts::FRAC_2_PI * (root.atan() + root / 3.0);
    near(test.probability, expected, 1e-12);
}

/// A covariance matrix with common and independent parts, neither diagonal nor Toeplitz.
fn correlated(u: &[f64], common: f64) -> DMatrix<f64> {
    DMatrix::from_fn(u.len(), u.len(), |i, j| {
        let own = if i == j { u[i] * u[i] } else { 0.0 };
        own + common * common * (1.0 + 0.1 * (i * j) as f64)
    })
}

#[test]
fn generalised_least_squares_by_the_formula() {
    let x = [1.0, 2.0, 3.5, 4.0, 6.0, 7.0];
    let y = [2.1, 2.9, 5.2, 5.8, 8.1, 10.0];
    let v = correlated(&[0.1, 0.2, 0.1, 0.3, 0.2, 0.1], 0.15);
    let solution = solve(&line(&x, &y, Spread::Exact, Spread::Matrix(v.clone()))).unwrap();
    let design = DMatrix::from_fn(6, 2, |i, j| if j == 0 { 1.0 } else { x[i] });
    let inverse = v.try_inverse().unwrap();
    let covariance = (design.transpose() * &inverse * &design)
        .try_inverse()
        .unwrap();
    let by_y = &covariance * design.transpose() * &inverse;
    let y = DVector::from_column_slice(&y);
    let parameters = &by_y * &y;
    let residuals = &y - &design * &parameters;
    assert!((solution.covariance - covariance).amax() < 1e-13);
    assert!((solution.by_y - by_y).amax() < 1e-12);
    near(solution.parameters[0], parameters[0], 1e-12);
    near(solution.parameters[1], parameters[1], 1e-12);
    near(
        solution.chi_squared,
        (residuals.transpose() * inverse * residuals)[0],
        1e-11,
    );
}

/// Points near a saturating curve, for every kind of errors.
fn curve(errors: Errors) -> Problem<'static> {
    let x: [f64; 8] = [0.2, 0.5, 0.9, 1.4, 2.0, 2.7, 3.5, 4.4];
    let z = [1.0, -0.5, 0.3, 0.8, -1.0, 0.1, 0.6, -0.2];
    let off = [0.03, -0.04, 0.02, 0.05, -0.03, -0.02, 0.04, -0.05];
    let y = (0..8).map(|i| 5.0 * (1.0 - (-0.7 * x[i]).exp()) + 0.4 * z[i] + off[i]);
    Problem {
        response: &Saturating,
        y: DVector::from_iterator(8, y),
        x: DMatrix::from_fn(8, 2, |i, k| if k == 0 { x[i] } else { z[i] }),
        errors,
        start: Some(vec![3.0, 1.0, 0.0]),
    }
}

/// The same points near an affine response.
fn affine(errors: Errors) -> Problem<'static> {
    let mut problem = curve(errors);
    for i in 0..8 {
        let (x, z) = (problem.x[(i, 0)], problem.x[(i, 1)]);
        let off = problem.y[i] - 5.0 * (1.0 - (-0.7 * x).exp()) - 0.4 * z;
        problem.y[i] = 1.0 + 0.8 * x * z + 0.5 * z * z + off;
    }
    Problem {
        response: &Affine,
        start: None,
        ..problem
    }
}

fn some_errors() -> Vec<Errors> {
    let u = vec![0.05, 0.04, 0.06, 0.05, 0.03, 0.05, 0.08, 0.05];
    let each = || Spread::Each(u.clone());
    let matrix = || Spread::Matrix(correlated(&u, 0.03));
    let stated = |y: Spread, x: [Spread; 2]| Errors {
        y,
        x: x.into(),
        correlation: None,
        scale: Scale::Stated,
    };
    vec![
        stated(each(), [Spread::Exact, Spread::Exact]),
        stated(matrix(), [Spread::Exact, Spread::Exact]),
        stated(each(), [each(), Spread::Exact]),
        stated(each(), [each(), each()]),
        stated(Spread::Exact, [Spread::Exact, each()]),
        stated(matrix(), [each(), matrix()]),
        stated(each(), [matrix(), Spread::Exact]),
    ]
}

/// Every derivative against the change of the estimates when an observation changes.
fn check_derivatives(problem: &mut Problem) {
    let solution = solve(problem).unwrap();
    let step = 1e-4;
    for point in 0..problem.points() {
        for column in 0..=problem.x.ncols() {
            let mut shifted = |by: f64| {
                let m = problem.x.ncols();
                let cell = if column < m {
                    &mut problem.x[(point, column)]
                } else {
                    &mut problem.y[point]
                };
                let before = *cell;
                *cell += by;
                let parameters = solve(problem).unwrap().parameters;
                let cell = if column < m {
                    &mut problem.x[(point, column)]
                } else {
                    &mut problem.y[point]
                };
                *cell = before;
                parameters
            };
            let (above, below) = (shifted(step), shifted(-step));
            let derivative = solution.by_x.get(column).unwrap_or(&solution.by_y);
            for j in 0..above.len() {
                let expected = (above[j] - below[j]) / (2.0 * step);
                let size = derivative.row(j).amax().max(0.01);
                near(derivative[(j, point)], expected, 3e-6 * size);
            }
        }
    }
}

#[test]
fn derivatives_by_observations() {
    for errors in some_errors() {
        check_derivatives(&mut curve(errors));
    }
    // Without errors of y, some of these points are out of reach of the response.
    for errors in some_errors()
        .into_iter()
        .filter(|errors| errors.y != Spread::Exact)
    {
        check_derivatives(&mut affine(errors));
    }
    let mut york = pearson_york();
    york.errors.correlation = Some(vec![0.5, -0.3, 0.2, 0.0, 0.7, 0.1, -0.6, 0.3, 0.2, 0.4]);
    check_derivatives(&mut york);
}

/// The least eᵀ V⁻¹ e of one point for given parameters, by golden section over the true x.
fn nearest(x: f64, y: f64, u_x: f64, u_y: f64, r: f64, f: impl Fn(f64) -> f64) -> f64 {
    let distance = |true_x: f64| {
        let (a, b) = ((x - true_x) / u_x, (y - f(true_x)) / u_y);
        (a * a - 2.0 * r * a * b + b * b) / (1.0 - r * r)
    };
    let (mut low, mut high) = (x - 5.0 * u_x, x + 5.0 * u_x);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..100 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if distance(a) < distance(b) {
            high = b
        } else {
            low = a
        }
    }
    distance(0.5 * (low + high))
}

#[test]
fn errors_in_variables_against_brute_force() {
    /// b₀ exp(b₁ x).
    struct Growth;
    impl Response for Growth {
        fn parameters(&self) -> usize {
            2
        }
        fn is_linear(&self) -> bool {
            false
        }
        fn at(&self, x: &[f64], b: &[f64], by_b: &mut [f64], by_x: &mut [f64]) -> f64 {
            let growth = (b[1] * x[0]).exp();
            by_b.copy_from_slice(&[growth, b[0] * x[0] * growth]);
            by_x[0] = b[0] * b[1] * growth;
            b[0] * growth
        }
    }
    let x = [0.1, 0.9, 2.2, 2.8, 4.1, 5.0];
    let y = [1.1, 1.5, 3.2, 4.1, 7.5, 12.4];
    let (u_x, u_y) = (
        vec![0.1, 0.2, 0.1, 0.2, 0.15, 0.1],
        vec![0.1, 0.1, 0.2, 0.2, 0.3, 0.5],
    );
    let r = vec![0.0, 0.5, -0.5, 0.3, 0.8, -0.2];
    let solution = solve(&Problem {
        response: &Growth,
        x: column(&x),
        y: DVector::from_column_slice(&y),
        errors: Errors {
            y: Spread::Each(u_y.clone()),
            x: vec![Spread::Each(u_x.clone())],
            correlation: Some(r.clone()),
            scale: Scale::Stated,
        },
        start: Some(vec![1.0, 0.5]),
    })
    .unwrap();
    let total = |b0: f64, b1: f64| -> f64 {
        (0..6)
            .map(|i| nearest(x[i], y[i], u_x[i], u_y[i], r[i], |x| b0 * (b1 * x).exp()))
            .sum()
    };
    let (b0, b1) = (solution.parameters[0], solution.parameters[1]);
    near(solution.chi_squared, total(b0, b1), 1e-9);
    for (s, t) in [(1e-3, 0.0), (0.0, 1e-3), (1e-3, 1e-3), (1e-3, -1e-3)] {
        let (above, below) = (total(b0 + s, b1 + t), total(b0 - s, b1 - t));
        assert!(above > solution.chi_squared && below > solution.chi_squared);
        // No slope: the difference is of third order.
        near(
            above,
            below,
            1e-2 * (above + below - 2.0 * solution.chi_squared),
        );
    }
}

#[test]
fn covariance_against_simulation() {
    let u = 0.01;
    let each = || Spread::Each(vec![u; 8]);
    let errors = || Errors {
        y: each(),
        x: vec![each(), Spread::Exact],
        correlation: None,
        scale: Scale::Stated,
    };
    let mut truth = curve(errors());
    for i in 0..8 {
        let (x, z) = (truth.x[(i, 0)], truth.x[(i, 1)]);
        truth.y[i] = 5.0 * (1.0 - (-0.7 * x).exp()) + 0.4 * z;
    }
    let expected = solve(&truth).unwrap();
    let mut random = StdRng::seed_from_u64(7);
    let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let trials = 1000;
    let mut sum: DMatrix<f64> = DMatrix::zeros(3, 3);
    let mut chi_squared = 0.0;
    for _ in 0..trials {
        let mut problem = curve(errors());
        for i in 0..8 {
            problem.x[(i, 0)] = truth.x[(i, 0)] + u * normal();
            problem.y[i] = truth.y[i] + u * normal();
        }
        let solution = solve(&problem).unwrap();
        let off = DVector::from_fn(3, |j, _| solution.parameters[j] - expected.parameters[j]);
        sum += &off * off.transpose();
        chi_squared += solution.chi_squared;
    }
    let scattered = sum / f64::from(trials);
    for j in 0..3 {
        near(scattered[(j, j)] / expected.covariance[(j, j)], 1.0, 0.15);
        for k in 0..j {
            let size = (scattered[(j, j)] * scattered[(k, k)]).sqrt();
            near(
                scattered[(j, k)] / size,
                expected.covariance[(j, k)] / size,
                0.1,
            );
        }
    }
    near(chi_squared / f64::from(trials), 5.0, 0.3);
}

#[test]
fn one_block_and_many_agree() {
    let mut york = pearson_york();
    york.errors.correlation = Some(vec![0.3; 10]);
    let separate = solve(&york).unwrap();
    let Spread::Each(u) = &york.errors.x[0] else {
        unreachable!()
    };
    let diagonal = DVector::from_fn(10, |i, _| u[i] * u[i]);
    york.errors.x[0] = Spread::Matrix(DMatrix::from_diagonal(&diagonal));
    let joint = solve(&york).unwrap();
    near(joint.parameters[0], separate.parameters[0], 1e-12);
    near(joint.parameters[1], separate.parameters[1], 1e-12);
    assert!((joint.covariance - separate.covariance).amax() < 1e-12);
    assert!((&joint.by_x[0] - &separate.by_x[0]).amax() < 1e-9);
}

#[test]
fn a_line_without_errors_of_y_is_the_inverse_line() {
    let (x, y) = ([1.1, 1.9, 3.2, 3.9, 5.1], [2.0, 4.0, 6.0, 8.0, 10.0]);
    let u = || Spread::Each(vec![0.1; 5]);
    let along = solve(&line(&x, &y, u(), Spread::Exact)).unwrap();
    let across = solve(&line(&y, &x, Spread::Exact, u())).unwrap();
    near(along.parameters[1], 1.0 / across.parameters[1], 1e-12);
    near(
        along.parameters[0],
        -across.parameters[0] / across.parameters[1],
        1e-12,
    );
    near(along.chi_squared, across.chi_squared, 1e-11);
    near(along.adjusted_x[0], across.fitted[0], 1e-12);
}

#[test]
fn failures_say_what_is_wrong() {
    let failure = |problem: &Problem| solve(problem).unwrap_err();
    let one = || Spread::Each(vec![1.0; 3]);
    let x = [1.0, 2.0, 3.0];
    assert_eq!(
        failure(&line(
            &[1.0],
            &[1.0],
            Spread::Exact,
            Spread::Each(vec![1.0])
        )),
        Failure::TooFewPoints {
            points: 1,
            parameters: 2
        }
    );
    let mut two = line(&[1.0, 2.0], &[1.0, 2.0], Spread::Exact, Spread::Exact);
    assert_eq!(failure(&two), Failure::NoUncertainty);
    two.errors.scale = Scale::Residuals;
    assert_eq!(failure(&two), Failure::NoFreedom { points: 2 });
    assert_eq!(
        failure(&line(&x, &[1.0, f64::NAN, 3.0], Spread::Exact, one())),
        Failure::NotFinite {
            observed: Observed::Y,
            point: 1
        }
    );
    assert_eq!(
        failure(&line(&[2.0; 3], &x, Spread::Exact, one())),
        Failure::Indistinct {
            parameters: vec![0, 1]
        }
    );
    assert_eq!(
        failure(&line(
            &x,
            &x,
            Spread::Exact,
            Spread::Each(vec![1.0, 1.0, 0.0])
        )),
        Failure::Uncertainty {
            observed: Observed::Y,
            point: 2
        }
    );
    assert_eq!(
        failure(&line(
            &x,
            &x,
            Spread::Each(vec![1.0, 0.0, 1.0]),
            Spread::Each(vec![1.0, 0.0, 1.0])
        )),
        Failure::Uncertainty {
            observed: Observed::Y,
            point: 1
        }
    );
    // A common offset without anything of one's own.
    let singular = || Spread::Matrix(DMatrix::from_element(3, 3, 0.04));
    assert_eq!(
        failure(&line(&x, &x, Spread::Exact, singular())),
        Failure::Covariance {
            observed: Observed::Y
        }
    );
    assert!(solve(&line(&x, &[1.0, 2.1, 2.9], singular(), one())).is_ok());
    let indefinite = DMatrix::from_row_slice(3, 3, &[1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(
        failure(&line(&x, &x, Spread::Matrix(indefinite), one())),
        Failure::Covariance {
            observed: Observed::X(0)
        }
    );
    let mut york = pearson_york();
    york.errors.correlation = Some(vec![1.5; 10]);
    assert_eq!(failure(&york), Failure::Correlation { point: 0 });
    let mut lost = curve(Errors::ordinary(8, 2));
    lost.start = None;
    assert_eq!(failure(&lost), Failure::NoStart);
    lost.start = Some(vec![f64::MAX, -1000.0, 1.0]);
    assert_eq!(failure(&lost), Failure::Undefined { point: 0 });
}

#[test]
fn collinear_predictors_are_named() {
    /// β₀ + β₁ x + β₂ z + β₃ w.
    struct Plane;
    impl Response for Plane {
        fn parameters(&self) -> usize {
            4
        }
        fn is_linear(&self) -> bool {
            true
        }
        fn at(&self, x: &[f64], b: &[f64], by_b: &mut [f64], by_x: &mut [f64]) -> f64 {
            by_b.copy_from_slice(&[1.0, x[0], x[1], x[2]]);
            by_x.copy_from_slice(&b[1..]);
            b[0] + b[1] * x[0] + b[2] * x[1] + b[3] * x[2]
        }
    }
    // w = x + 0.1 up to rounding; z has nothing to do with it.
    let x = DMatrix::from_fn(7, 3, |i, k| match k {
        0 => 0.1 * i as f64,
        1 => (i * i) as f64,
        _ => 0.1 * i as f64 + 0.1,
    });
    let problem = Problem {
        response: &Plane,
        x,
        y: DVector::from_fn(7, |i, _| i as f64),
        errors: Errors::ordinary(7, 3),
        start: None,
    };
    assert_eq!(
        solve(&problem).unwrap_err(),
        Failure::Indistinct {
            parameters: vec![0, 1, 3]
        }
    );
}

/// In f64, as very large problems are solved, digits of the estimates suffice.
#[test]
fn f64_and_double_double_agree() {
    let n = 3000;
    let x: Vec<f64> = (0..n).map(|i| f64::from(i) * 1e-3).collect();
    let y: Vec<f64> = x
        .iter()
        .enumerate()
        .map(|(i, x)| x * x - 1.0 + 0.01 * (i % 7) as f64)
        .collect();
    let response = Polynomial {
        degree: 4,
        intercept: true,
    };
    let problem = Problem {
        response: &response,
        x: column(&x),
        y: DVector::from_vec(y),
        errors: Errors::ordinary(x.len(), 1),
        start: None,
    };
    let (long, short) = linear::in_both_precisions(&problem).unwrap();
    for j in 0..5 {
        near(short.parameters[j] / long.parameters[j], 1.0, 1e-9);
        near(
            short.covariance[(j, j)] / long.covariance[(j, j)],
            1.0,
            1e-9,
        );
    }
}
