//! Published lines, and formulas that can be written down.

use super::*;

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
