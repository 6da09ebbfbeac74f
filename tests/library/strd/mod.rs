//! Least squares against the Statistical Reference Datasets of NIST.
//!
//! Small data sets stand here; the others are read from a folder of reference cases beside the
//! repository, where there is one.

mod formulas;
mod shapes;
mod small;

use std::path::Path;

use gumption::least_squares::{
    Elsewhere, Errors, Polynomial, Problem, Response, Solution, elsewhere, solve,
};
use nalgebra::{DMatrix, DVector};

use formulas::{FORMULAS, Formula};

/// Correct digits: −lg of the relative error, of the absolute one where nothing is to come out.
fn digits(got: f64, expected: f64) -> f64 {
    if got == expected {
        return 16.0;
    }
    let error = if expected == 0.0 {
        got.abs()
    } else {
        ((got - expected) / expected).abs()
    };
    (-error.log10()).clamp(0.0, 16.0)
}

/// Figures that NIST certifies.
#[derive(Default)]
struct Certified {
    parameters: Vec<f64>,
    uncertainties: Vec<f64>,
    residual_sd: Option<f64>,
    chi_squared: Option<f64>,
    r_squared: Option<f64>,
}

/// Prints one line; returns the worst digits of estimates and of the rest.
fn compare(name: &str, solution: &Solution, certified: &Certified) -> (f64, f64) {
    let worst = |pairs: Vec<(f64, f64)>| {
        pairs
            .iter()
            .map(|(got, expected)| digits(*got, *expected))
            .fold(16.0, f64::min)
    };
    let estimates = worst(
        solution
            .parameters
            .iter()
            .copied()
            .zip(certified.parameters.clone())
            .collect(),
    );
    let u = (0..solution.parameters.len()).map(|j| solution.covariance[(j, j)].sqrt());
    let mut others: Vec<(f64, f64)> = u.zip(certified.uncertainties.clone()).collect();
    let figures = [
        (solution.residual_sd, certified.residual_sd),
        (solution.chi_squared, certified.chi_squared),
        (solution.r_squared, certified.r_squared),
    ];
    others.extend(
        figures
            .iter()
            .filter_map(|(got, expected)| expected.map(|e| (*got, e))),
    );
    let others = worst(others);
    println!(
        "{name:24} estimates {estimates:5.1}  u, s, R² {others:5.1}  {:5} steps  condition {:.1e}",
        solution.iterations, solution.condition
    );
    (estimates, others)
}

fn ordinary<'a>(
    response: &'a dyn Response,
    x: DMatrix<f64>,
    y: &[f64],
    start: Option<Vec<f64>>,
) -> Problem<'a> {
    let errors = Errors::ordinary(y.len(), x.ncols());
    Problem {
        response,
        x,
        y: DVector::from_column_slice(y),
        errors,
        start,
    }
}

/// Certified to eleven digits; from both starts.
fn nonlinear(
    name: &str,
    formula: &Formula,
    x: &DMatrix<f64>,
    y: &[f64],
    starts: &[Vec<f64>],
    certified: &Certified,
) {
    let response = formula.response();
    for (index, start) in starts.iter().enumerate() {
        let name = format!("{name}, start {}", index + 1);
        let solution = match solve(&ordinary(&response, x.clone(), y, Some(start.clone()))) {
            Ok(solution) => solution,
            Err(failure) => panic!("{name}: {failure:?}"),
        };
        let (estimates, others) = compare(&name, &solution, certified);
        assert!(estimates >= 8.0 && others >= 8.0, "{name}");
        // Nothing better is found from other starts.
        let others = elsewhere(&ordinary(&response, x.clone(), y, Some(start.clone())));
        let best = others
            .first()
            .map_or(f64::INFINITY, |other| other.chi_squared);
        let worse = solution.chi_squared * (1.0 - Elsewhere::DIFFERENT);
        assert!(best >= worse, "{name}: {best} below {worse}");
    }
}

/// A case file: predictors, responses, certified figures, starts.
fn read_case(name: &str) -> Option<toml::Table> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/reference/cases");
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference/cases");
    let text = [folder, beside]
        .iter()
        .find_map(|folder| std::fs::read_to_string(folder.join(format!("{name}.toml"))).ok());
    if text.is_none() {
        println!("SKIPPED {name}: no folder of reference cases");
    }
    Some(text?.parse().expect("a case file is TOML"))
}

fn data(case: &toml::Table) -> (DMatrix<f64>, Vec<f64>) {
    let rows = case["table"][0]["rows"].as_array().expect("rows");
    let cell = |row: &toml::Value, column: usize| row[column].as_float().expect("a number");
    let x = DMatrix::from_fn(rows.len(), 1, |point, _| cell(&rows[point], 1));
    (x, rows.iter().map(|row| cell(row, 0)).collect())
}

fn certified(case: &toml::Table) -> Certified {
    let mut certified = Certified::default();
    for figure in case["expected"].as_array().expect("expected") {
        let published = figure["published"].as_float().expect("a number");
        match figure["item"].as_str().expect("item") {
            "estimate" => certified.parameters.push(published),
            "sd" => certified.uncertainties.push(published),
            "residual_sd" => certified.residual_sd = Some(published),
            "RSS" => certified.chi_squared = Some(published),
            "R2" => certified.r_squared = Some(published),
            other => panic!("unknown item {other}"),
        }
    }
    certified
}

#[test]
fn linear_data_sets() {
    for name in [
        "noint1", "noint2", "norris", "pontius", "wampler1", "wampler2", "wampler3", "wampler4",
        "filip",
    ] {
        let Some(case) = read_case(&format!("strd_lin_{name}")) else {
            continue;
        };
        let (x, y) = data(&case);
        let model = case["model"].as_table().expect("model");
        let polynomial = Polynomial {
            degree: usize::try_from(model["degree"].as_integer().expect("degree")).expect("degree"),
            intercept: model["intercept"].as_bool().expect("intercept"),
        };
        let solution = solve(&ordinary(&polynomial, x, &y, None)).expect(name);
        let (estimates, others) = compare(name, &solution, &certified(&case));
        assert!(estimates >= 12.0 && others >= 12.0, "{name}");
    }
}

#[test]
fn nonlinear_data_sets() {
    for (name, formula) in FORMULAS {
        let Some(case) = read_case(&format!("strd_nls_{name}")) else {
            continue;
        };
        let (x, y) = data(&case);
        let start = |key: &str| -> Vec<f64> {
            let start = case["start"].as_array().expect("start");
            start
                .iter()
                .map(|start| start[key].as_float().expect("a number"))
                .collect()
        };
        let starts = [start("start1"), start("start2")];
        nonlinear(name, formula, &x, &y, &starts, &certified(&case));
    }
}

fn column(x: &[f64]) -> DMatrix<f64> {
    DMatrix::from_column_slice(x.len(), 1, x)
}
