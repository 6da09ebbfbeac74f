//! Data made in the shape of the other data sets.

use gumption::least_squares::{Response, solve};
use nalgebra::DMatrix;
use num_dual::DualNum;

use super::formulas::{Formula, formula, gauss, rational_cubic};
use super::{Certified, column, compare, ordinary};

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
    let response = formula.response();
    let mut ignored = (vec![0.0; truth.len()], vec![0.0; x.ncols()]);
    let y: Vec<f64> = noise(x.nrows())
        .iter()
        .enumerate()
        .map(|(point, noise)| {
            let x: Vec<f64> = x.row(point).iter().copied().collect();
            response.at(&x, truth, &mut ignored.0, &mut ignored.1) + sd * noise
        })
        .collect();
    let from_truth = solve(&ordinary(&response, x.clone(), &y, Some(truth.to_vec()))).expect(name);
    assert!(
        (from_truth.residual_sd / sd - 1.0).abs() < 0.4,
        "{name}: {}",
        from_truth.residual_sd
    );
    for (index, start) in starts.iter().enumerate() {
        let solution = match solve(&ordinary(&response, x.clone(), &y, Some(start.to_vec()))) {
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
fn like_bennett5() {
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
}

#[test]
fn like_hahn1() {
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
}

#[test]
fn like_nelson() {
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
}

#[test]
fn like_gauss2_and_gauss3() {
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
