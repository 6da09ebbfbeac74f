//! Against other algorithms: the normal equations, brute force, simulation, other paths through the solver.

use super::*;

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
