//! Data sets small enough to stand here.

use gumption::least_squares::solve;
use nalgebra::DMatrix;
use num_dual::DualNum;

use super::formulas::{Formula, c, formula, lanczos, rational_cubic};
use super::{Certified, column, compare, nonlinear, ordinary};

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
    let response = formula(6, lanczos).response();
    for start in &starts {
        let problem = ordinary(&response, column(&x), &y, Some(start.clone()));
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
        &formula(6, lanczos),
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
    let solution = solve(&ordinary(&formula.response(), x, &y, None)).expect("longley");
    let (estimates, others) = compare("longley", &solution, &certified);
    assert!(estimates >= 12.0 && others >= 12.0);
}
