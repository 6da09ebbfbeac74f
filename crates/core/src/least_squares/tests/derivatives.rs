//! Derivatives by the observations against differences of estimates.

use super::*;

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
