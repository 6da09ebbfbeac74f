//! What is wrong with a problem is said.

use super::*;

const X: [f64; 3] = [1.0, 2.0, 3.0];

fn failure(problem: &Problem) -> Failure {
    solve(problem).unwrap_err()
}

fn one() -> Spread {
    Spread::Each(vec![1.0; 3])
}

#[test]
fn too_few_points_or_points_without_a_value() {
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
        failure(&line(&X, &[1.0, f64::NAN, 3.0], Spread::Exact, one())),
        Failure::NotFinite {
            observed: Observed::Y,
            point: 1
        }
    );
    assert_eq!(
        failure(&line(&[2.0; 3], &X, Spread::Exact, one())),
        Failure::Indistinct {
            parameters: vec![0, 1]
        }
    );
}

#[test]
fn uncertainties_that_cannot_be() {
    assert_eq!(
        failure(&line(
            &X,
            &X,
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
            &X,
            &X,
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
        failure(&line(&X, &X, Spread::Exact, singular())),
        Failure::Covariance {
            observed: Observed::Y
        }
    );
    assert!(solve(&line(&X, &[1.0, 2.1, 2.9], singular(), one())).is_ok());
    let indefinite = DMatrix::from_row_slice(3, 3, &[1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(
        failure(&line(&X, &X, Spread::Matrix(indefinite), one())),
        Failure::Covariance {
            observed: Observed::X(0)
        }
    );
    let mut york = pearson_york();
    york.errors.correlation = Some(vec![1.5; 10]);
    assert_eq!(failure(&york), Failure::Correlation { point: 0 });
}

#[test]
fn starts_that_lead_nowhere() {
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
