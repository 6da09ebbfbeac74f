//! Least squares against the Statistical Reference Datasets of NIST.
//!
//! Small data sets stand here; the others are read from a folder of reference cases beside the
//! repository, where there is one.

#![allow(clippy::disallowed_methods)]

use std::path::Path;

use gumption::least_squares::{Errors, Polynomial, Problem, Response, Solution, solve};
use nalgebra::{DMatrix, DVector};
use num_dual::{DualNum, DualSVec64};

/// Parameters first, then predictors.
type Number = DualSVec64<16>;

/// A response written as a formula, differentiated automatically.
struct Formula {
    parameters: usize,
    linear: bool,
    f: fn(&[Number], &[Number]) -> Number,
}

impl Response for Formula {
    fn parameters(&self) -> usize {
        self.parameters
    }

    fn is_linear(&self) -> bool {
        self.linear
    }

    fn at(
        &self,
        predictors: &[f64],
        parameters: &[f64],
        by_parameter: &mut [f64],
        by_predictor: &mut [f64],
    ) -> f64 {
        let p = parameters.len();
        let seed = |value: &f64, place: usize| Number::from_re(*value).derivative(place);
        let b: Vec<Number> = parameters
            .iter()
            .enumerate()
            .map(|(j, b)| seed(b, j))
            .collect();
        let x: Vec<Number> = predictors
            .iter()
            .enumerate()
            .map(|(k, x)| seed(x, p + k))
            .collect();
        let f = (self.f)(&b, &x);
        let slopes = f
            .eps
            .unwrap_generic(nalgebra::Const::<16>, nalgebra::Const::<1>);
        by_parameter.copy_from_slice(&slopes.as_slice()[..p]);
        by_predictor.copy_from_slice(&slopes.as_slice()[p..p + predictors.len()]);
        f.re
    }
}

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
    for (index, start) in starts.iter().enumerate() {
        let name = format!("{name}, start {}", index + 1);
        let solution = match solve(&ordinary(formula, x.clone(), y, Some(start.clone()))) {
            Ok(solution) => solution,
            Err(failure) => panic!("{name}: {failure:?}"),
        };
        let (estimates, others) = compare(&name, &solution, certified);
        assert!(estimates >= 8.0 && others >= 8.0, "{name}");
    }
}

const fn formula(parameters: usize, f: fn(&[Number], &[Number]) -> Number) -> Formula {
    Formula {
        parameters,
        linear: false,
        f,
    }
}

fn c(value: f64) -> Number {
    Number::from_re(value)
}

/// Peaks on an exponential baseline.
fn gauss(b: &[Number], x: &[Number]) -> Number {
    let peak = |height: Number, centre: Number, width: Number| {
        height * (-(((x[0] - centre) / width).powi(2))).exp()
    };
    b[0] * (-b[1] * x[0]).exp() + peak(b[2], b[3], b[4]) + peak(b[5], b[6], b[7])
}

fn lanczos(b: &[Number], x: &[Number]) -> Number {
    b[0] * (-b[1] * x[0]).exp() + b[2] * (-b[3] * x[0]).exp() + b[4] * (-b[5] * x[0]).exp()
}

fn enso(b: &[Number], x: &[Number]) -> Number {
    let turn = x[0] * (2.0 * std::f64::consts::PI);
    b[0] + b[1] * (turn / 12.0).cos()
        + b[2] * (turn / 12.0).sin()
        + b[4] * (turn / b[3]).cos()
        + b[5] * (turn / b[3]).sin()
        + b[7] * (turn / b[6]).cos()
        + b[8] * (turn / b[6]).sin()
}

fn rational_cubic(b: &[Number], x: &[Number]) -> Number {
    let x = x[0];
    (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (x * (b[4] + x * (b[5] + x * b[6])) + 1.0)
}

const FORMULAS: &[(&str, Formula)] = &[
    (
        "chwirut1",
        formula(3, |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ),
    (
        "chwirut2",
        formula(3, |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ),
    (
        "danwood",
        formula(2, |b, x| b[0] * (b[1] * x[0].ln()).exp()),
    ),
    ("enso", formula(9, enso)),
    ("gauss1", formula(8, gauss)),
    (
        "kirby2",
        formula(5, |b, x| {
            let x = x[0];
            (b[0] + x * (b[1] + x * b[2])) / (x * (b[3] + x * b[4]) + 1.0)
        }),
    ),
    ("lanczos3", formula(6, lanczos)),
    (
        "mgh09",
        formula(4, |b, x| {
            let x = x[0];
            b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3])
        }),
    ),
    (
        "mgh17",
        formula(5, |b, x| {
            b[0] + b[1] * (-x[0] * b[3]).exp() + b[2] * (-x[0] * b[4]).exp()
        }),
    ),
    (
        "misra1a",
        formula(2, |b, x| b[0] * (c(1.0) - (-b[1] * x[0]).exp())),
    ),
    (
        "misra1b",
        formula(2, |b, x| {
            b[0] * (c(1.0) - (b[1] * x[0] / 2.0 + 1.0).powi(-2))
        }),
    ),
    (
        "rat42",
        formula(3, |b, x| b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0)),
    ),
    (
        "roszman1",
        formula(4, |b, x| {
            b[0] - b[1] * x[0] - (b[2] / (x[0] - b[3])).atan() / std::f64::consts::PI
        }),
    ),
];

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

const MISRA: [(f64, f64); 14] = [
    (77.6, 10.07),
    (114.9, 14.73),
    (141.1, 17.94),
    (190.8, 23.93),
    (239.9, 29.61),
    (289.0, 35.18),
    (332.8, 40.02),
    (378.4, 44.82),
    (434.8, 50.76),
    (477.3, 55.05),
    (536.8, 61.01),
    (593.1, 66.40),
    (689.1, 75.47),
    (760.0, 81.78),
];

#[test]
fn misra1c_and_misra1d() {
    let x: Vec<f64> = MISRA.iter().map(|(x, _)| *x).collect();
    let y: Vec<f64> = MISRA.iter().map(|(_, y)| *y).collect();
    let c_formula = formula(2, |b, x| {
        b[0] * (c(1.0) - (b[1] * x[0] * 2.0 + 1.0).powf(-0.5))
    });
    let certified = Certified {
        parameters: vec![6.3642725809e2, 2.0813627256e-4],
        uncertainties: vec![4.6638326572, 1.7728423155e-6],
        chi_squared: Some(4.0966836971e-2),
        ..Certified::default()
    };
    let starts = [vec![500.0, 1e-4], vec![600.0, 2e-4]];
    nonlinear("misra1c", &c_formula, &column(&x), &y, &starts, &certified);
    let d_formula = formula(2, |b, x| b[0] * b[1] * x[0] / (b[1] * x[0] + 1.0));
    let certified = Certified {
        parameters: vec![4.3736970754e2, 3.0227324449e-4],
        uncertainties: vec![3.6489174345, 2.9334354479e-6],
        chi_squared: Some(5.6419295283e-2),
        ..Certified::default()
    };
    let starts = [vec![500.0, 1e-4], vec![450.0, 3e-4]];
    nonlinear("misra1d", &d_formula, &column(&x), &y, &starts, &certified);
}

#[test]
fn mgh10() {
    let x: Vec<f64> = (0..16).map(|i| 50.0 + 5.0 * f64::from(i)).collect();
    let y = [
        34780.0, 28610.0, 23650.0, 19630.0, 16370.0, 13720.0, 11540.0, 9744.0, 8261.0, 7030.0,
        6005.0, 5147.0, 4427.0, 3820.0, 3307.0, 2872.0,
    ];
    let certified = Certified {
        parameters: vec![5.6096364710e-3, 6.1813463463e3, 3.4522363462e2],
        uncertainties: vec![1.5687892471e-4, 2.3309021107e1, 7.8486103508e-1],
        chi_squared: Some(8.7945855171e1),
        ..Certified::default()
    };
    let formula = formula(3, |b, x| b[0] * (b[1] / (x[0] + b[2])).exp());
    let starts = [vec![2.0, 400_000.0, 25_000.0], vec![0.02, 4000.0, 250.0]];
    nonlinear("mgh10", &formula, &column(&x), &y, &starts, &certified);
}

#[test]
fn boxbod() {
    let x = [1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
    let y = [109.0, 149.0, 149.0, 191.0, 213.0, 224.0];
    let certified = Certified {
        parameters: vec![2.1380940889e2, 5.4723748542e-1],
        uncertainties: vec![1.2354515176e1, 1.0455993237e-1],
        chi_squared: Some(1.1680088766e3),
        ..Certified::default()
    };
    let formula = formula(2, |b, x| b[0] * (c(1.0) - (-b[1] * x[0]).exp()));
    let starts = [vec![1.0, 1.0], vec![100.0, 0.75]];
    nonlinear("boxbod", &formula, &column(&x), &y, &starts, &certified);
}

#[test]
fn rat43() {
    let x: Vec<f64> = (1..=15).map(f64::from).collect();
    let y = [
        16.08, 33.83, 65.80, 97.20, 191.55, 326.20, 386.87, 520.53, 590.03, 651.92, 724.93, 699.56,
        689.96, 637.56, 717.41,
    ];
    let certified = Certified {
        parameters: vec![6.9964151270e2, 5.2771253025, 7.5962938329e-1, 1.2792483859],
        uncertainties: vec![
            1.6302297817e1,
            2.0828735829,
            1.9566123451e-1,
            6.8761936385e-1,
        ],
        chi_squared: Some(8.7864049080e3),
        ..Certified::default()
    };
    let formula = formula(4, |b, x| {
        b[0] * (-((b[1] - b[2] * x[0]).exp() + 1.0).ln() / b[3]).exp()
    });
    let starts = [vec![100.0, 10.0, 1.0, 1.0], vec![700.0, 5.0, 0.75, 1.3]];
    nonlinear("rat43", &formula, &column(&x), &y, &starts, &certified);
}

#[test]
fn eckerle4() {
    let x: Vec<f64> = (0..7)
        .map(|i| 400.0 + 5.0 * f64::from(i))
        .chain((0..21).map(|i| 435.0 + 1.5 * f64::from(i)))
        .chain((0..7).map(|i| 470.0 + 5.0 * f64::from(i)))
        .collect();
    let y = [
        0.0001575, 0.0001699, 0.0002350, 0.0003102, 0.0004917, 0.0008710, 0.0017418, 0.0046400,
        0.0065895, 0.0097302, 0.0149002, 0.0237310, 0.0401683, 0.0712559, 0.1264458, 0.2073413,
        0.2902366, 0.3445623, 0.3698049, 0.3668534, 0.3106727, 0.2078154, 0.1164354, 0.0616764,
        0.0337200, 0.0194023, 0.0117831, 0.0074357, 0.0022732, 0.0008800, 0.0004579, 0.0002345,
        0.0001586, 0.0001143, 0.0000710,
    ];
    let certified = Certified {
        parameters: vec![1.5543827178, 4.0888321754, 4.5154121844e2],
        uncertainties: vec![1.5408051163e-2, 4.6803020753e-2, 4.6800518816e-2],
        chi_squared: Some(1.4635887487e-3),
        ..Certified::default()
    };
    let formula = formula(3, |b, x| {
        b[0] / b[1] * (((x[0] - b[2]) / b[1]).powi(2) * -0.5).exp()
    });
    let starts = [vec![1.0, 10.0, 500.0], vec![1.5, 5.0, 450.0]];
    nonlinear("eckerle4", &formula, &column(&x), &y, &starts, &certified);
}

#[test]
fn thurber() {
    let x = [
        -3.067, -2.981, -2.921, -2.912, -2.840, -2.797, -2.702, -2.699, -2.633, -2.481, -2.363,
        -2.322, -1.501, -1.460, -1.274, -1.212, -1.100, -1.046, -0.915, -0.714, -0.566, -0.545,
        -0.400, -0.309, -0.109, -0.103, 0.010, 0.119, 0.377, 0.790, 0.963, 1.006, 1.115, 1.572,
        1.841, 2.047, 2.200,
    ];
    let y = [
        80.574, 84.248, 87.264, 87.195, 89.076, 89.608, 89.868, 90.101, 92.405, 95.854, 100.696,
        101.060, 401.672, 390.724, 567.534, 635.316, 733.054, 759.087, 894.206, 990.785, 1090.109,
        1080.914, 1122.643, 1178.351, 1260.531, 1273.514, 1288.339, 1327.543, 1353.863, 1414.509,
        1425.208, 1421.384, 1442.962, 1464.350, 1468.705, 1447.894, 1457.628,
    ];
    let certified = Certified {
        parameters: vec![
            1.2881396800e3,
            1.4910792535e3,
            5.8323836877e2,
            7.5416644291e1,
            9.6629502864e-1,
            3.9797285797e-1,
            4.9727297349e-2,
        ],
        chi_squared: Some(5.6427082397e3),
        ..Certified::default()
    };
    let starts = [
        vec![1000.0, 1000.0, 400.0, 40.0, 0.7, 0.3, 0.03],
        vec![1300.0, 1500.0, 500.0, 75.0, 1.0, 0.4, 0.05],
    ];
    nonlinear(
        "thurber",
        &formula(7, rational_cubic),
        &column(&x),
        &y,
        &starts,
        &certified,
    );
}

/// Lanczos1 and Lanczos2 are this sum of exponentials, rounded to 14 and to 6 digits.
#[test]
fn lanczos1_and_lanczos2() {
    let x: Vec<f64> = (0..24).map(|i| 0.05 * f64::from(i)).collect();
    let exact =
        |x: &f64| 0.0951 * (-x).exp() + 0.8607 * (-3.0 * x).exp() + 1.5576 * (-5.0 * x).exp();
    let starts = [
        vec![1.2, 0.3, 5.6, 5.5, 6.5, 7.6],
        vec![0.5, 0.7, 3.6, 4.2, 4.0, 6.3],
    ];
    let rounded = |x: &f64, digits: usize| -> f64 {
        format!("{:.*e}", digits - 1, exact(x))
            .parse()
            .expect("a number")
    };
    let y: Vec<f64> = x.iter().map(|x| rounded(x, 13)).collect();
    for start in &starts {
        let problem = ordinary(&FORMULAS[6].1, column(&x), &y, Some(start.clone()));
        let solution = solve(&problem).expect("lanczos1");
        let certified = Certified {
            parameters: vec![
                9.5100000027e-2,
                1.0000000001,
                8.6070000013e-1,
                3.0000000002,
                1.5575999998,
                5.0000000001,
            ],
            ..Certified::default()
        };
        let (estimates, _) = compare("lanczos1", &solution, &certified);
        assert!(estimates >= 8.0);
    }
    let y: Vec<f64> = x.iter().map(|x| rounded(x, 6)).collect();
    let certified = Certified {
        parameters: vec![
            9.6251029939e-2,
            1.0057332849,
            8.6424689056e-1,
            3.0078283915,
            1.5529016879,
            5.0028798100,
        ],
        chi_squared: Some(2.2299428125e-11),
        ..Certified::default()
    };
    nonlinear(
        "lanczos2",
        &FORMULAS[6].1,
        &column(&x),
        &y,
        &starts,
        &certified,
    );
}

#[test]
fn longley() {
    let y = [
        60323.0, 61122.0, 60171.0, 61187.0, 63221.0, 63639.0, 64989.0, 63761.0, 66019.0, 67857.0,
        68169.0, 66513.0, 68655.0, 69564.0, 69331.0, 70551.0,
    ];
    #[rustfmt::skip]
    let x = [
        [83.0, 234289.0, 2356.0, 1590.0, 107608.0, 1947.0],
        [88.5, 259426.0, 2325.0, 1456.0, 108632.0, 1948.0],
        [88.2, 258054.0, 3682.0, 1616.0, 109773.0, 1949.0],
        [89.5, 284599.0, 3351.0, 1650.0, 110929.0, 1950.0],
        [96.2, 328975.0, 2099.0, 3099.0, 112075.0, 1951.0],
        [98.1, 346999.0, 1932.0, 3594.0, 113270.0, 1952.0],
        [99.0, 365385.0, 1870.0, 3547.0, 115094.0, 1953.0],
        [100.0, 363112.0, 3578.0, 3350.0, 116219.0, 1954.0],
        [101.2, 397469.0, 2904.0, 3048.0, 117388.0, 1955.0],
        [104.6, 419180.0, 2822.0, 2857.0, 118734.0, 1956.0],
        [108.4, 442769.0, 2936.0, 2798.0, 120445.0, 1957.0],
        [110.8, 444546.0, 4681.0, 2637.0, 121950.0, 1958.0],
        [112.6, 482704.0, 3813.0, 2552.0, 123366.0, 1959.0],
        [114.2, 502601.0, 3931.0, 2514.0, 125368.0, 1960.0],
        [115.7, 518173.0, 4806.0, 2572.0, 127852.0, 1961.0],
        [116.9, 554894.0, 4007.0, 2827.0, 130081.0, 1962.0],
    ];
    let formula = Formula {
        parameters: 7,
        linear: true,
        f: |b, x| (0..6).fold(b[0], |sum, k| sum + b[k + 1] * x[k]),
    };
    let x = DMatrix::from_fn(16, 6, |point, k| x[point][k]);
    let certified = Certified {
        parameters: vec![
            -3482258.63459582,
            15.0618722713733,
            -0.358191792925910e-1,
            -2.02022980381683,
            -1.03322686717359,
            -0.511041056535807e-1,
            1829.15146461355,
        ],
        uncertainties: vec![
            890420.383607373,
            84.9149257747669,
            0.334910077722432e-1,
            0.488399681651699,
            0.214274163161675,
            0.226073200069370,
            455.478499142212,
        ],
        residual_sd: Some(304.854073561965),
        r_squared: Some(0.995479004577296),
        chi_squared: None,
    };
    let solution = solve(&ordinary(&formula, x, &y, None)).expect("longley");
    let (estimates, others) = compare("longley", &solution, &certified);
    assert!(estimates >= 12.0 && others >= 12.0);
}

/// Reproducible noise of standard deviation one, roughly normal.
fn noise(count: usize) -> Vec<f64> {
    let mut state: u64 = 1;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count)
        .map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0)
        .collect()
}

/// Both published starts must lead to one minimum, near the truth, for data made in the shape of
/// a data set.
fn simulated(
    name: &str,
    formula: &Formula,
    x: &DMatrix<f64>,
    truth: &[f64],
    sd: f64,
    starts: &[&[f64]],
) {
    let mut ignored = (vec![0.0; truth.len()], vec![0.0; x.ncols()]);
    let y: Vec<f64> = noise(x.nrows())
        .iter()
        .enumerate()
        .map(|(point, noise)| {
            let x: Vec<f64> = x.row(point).iter().copied().collect();
            formula.at(&x, truth, &mut ignored.0, &mut ignored.1) + sd * noise
        })
        .collect();
    let from_truth = solve(&ordinary(formula, x.clone(), &y, Some(truth.to_vec()))).expect(name);
    assert!(
        (from_truth.residual_sd / sd - 1.0).abs() < 0.4,
        "{name}: {}",
        from_truth.residual_sd
    );
    for (index, start) in starts.iter().enumerate() {
        let solution = match solve(&ordinary(formula, x.clone(), &y, Some(start.to_vec()))) {
            Ok(solution) => solution,
            Err(failure) => panic!("{name} {}: {failure:?}", index + 1),
        };
        let certified = Certified {
            parameters: from_truth.parameters.clone(),
            ..Certified::default()
        };
        let (estimates, _) = compare(
            &format!("{name}, start {}", index + 1),
            &solution,
            &certified,
        );
        assert!(estimates >= 8.0, "{name}");
    }
}

#[test]
fn in_the_shape_of_other_data_sets() {
    let bennett5 = formula(3, |b, x| b[0] * (-(b[1] + x[0]).ln() / b[2]).exp());
    let x: Vec<f64> = (0..154)
        .map(|i| 7.447168 + (i as f64 / 153.0) * 5.2)
        .collect();
    simulated(
        "like bennett5",
        &bennett5,
        &column(&x),
        &[-2.5235058043e3, 4.6736564644e1, 9.3218483193e-1],
        1.9e-3,
        &[&[-2000.0, 50.0, 0.8], &[-1500.0, 45.0, 0.85]],
    );
    let x: Vec<f64> = (0..236).map(|i| 14.0 + 3.55 * f64::from(i)).collect();
    simulated(
        "like hahn1",
        &formula(7, rational_cubic),
        &column(&x),
        &[
            1.0776351733,
            -1.2269296921e-1,
            4.0863750610e-3,
            -1.4262662514e-6,
            -5.7609940901e-3,
            2.4053735503e-4,
            -1.2314450199e-7,
        ],
        8.2e-2,
        &[
            &[10.0, -1.0, 0.05, -1e-5, -0.05, 0.001, -1e-6],
            &[1.0, -0.1, 0.005, -1e-6, -0.005, 1e-4, -1e-7],
        ],
    );
    let (weeks, temperatures) = (
        [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 48.0, 64.0],
        [180.0, 225.0, 250.0, 275.0],
    );
    let x = DMatrix::from_fn(128, 2, |point, k| {
        if k == 0 {
            weeks[point / 16]
        } else {
            temperatures[point / 4 % 4]
        }
    });
    simulated(
        "like nelson",
        &formula(3, |b, x| b[0] - b[1] * x[0] * (-b[2] * x[1]).exp()),
        &x,
        &[2.5906836021, 5.6177717026e-9, -5.7701013174e-2],
        0.174,
        &[&[2.0, 1e-4, -0.01], &[2.5, 5e-9, -0.05]],
    );
    let x: Vec<f64> = (1..=250).map(f64::from).collect();
    simulated(
        "like gauss2",
        &formula(8, gauss),
        &column(&x),
        &[
            9.9018328406e1,
            1.0994945399e-2,
            1.0188022528e2,
            1.0703095519e2,
            2.3578584029e1,
            7.2045589471e1,
            1.5327010194e2,
            1.9525972636e1,
        ],
        2.2,
        &[
            &[96.0, 0.009, 103.0, 106.0, 18.0, 72.0, 151.0, 18.0],
            &[98.0, 0.0105, 103.0, 105.0, 20.0, 73.0, 150.0, 20.0],
        ],
    );
    simulated(
        "like gauss3",
        &formula(8, gauss),
        &column(&x),
        &[
            9.8940368970e1,
            1.0945879335e-2,
            1.0069553078e2,
            1.1163619459e2,
            2.3300500029e1,
            7.3705031418e1,
            1.4776164251e2,
            1.9668221230e1,
        ],
        2.2,
        &[
            &[94.9, 0.009, 90.1, 113.0, 20.0, 73.8, 140.0, 20.0],
            &[96.0, 0.0096, 80.0, 110.0, 25.0, 74.0, 139.0, 25.0],
        ],
    );
}
