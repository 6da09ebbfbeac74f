//! Stated uncertainties against the scatter of simulated calibrations.
//!
//! The columns of one experiment are replaced by simulated readings, with errors drawn where its file
//! states them; the scatter of the coefficients over many such calibrations is what their standard
//! uncertainty and covariance must tell. With n simulations an estimate of u has a relative standard error
//! of 1/√(2n), one of a correlation coefficient r of (1 − r²)/√n; four of these are allowed.

use nalgebra::DMatrix;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal, Uniform};

use super::super::{Campaign, calibrate, estimates};
use super::campaign;
use crate::experiment::{Act, Doubt, Scope, Target};

/// Simulated calibrations; fewer where the program is slow.
const TRIALS: usize = if cfg!(debug_assertions) {
    1_500
} else {
    10_000
};

/// Calibrations over which the predicted covariance is averaged.
const PREDICTIONS: usize = TRIALS / 15;

/// Scatter of the coefficients about their mean, and the predicted covariance of the first.
struct Scatter {
    covariance: DMatrix<f64>,
    predicted: DMatrix<f64>,
}

/// One calibration of simulated readings. The readings follow the equations with the true errors; the
/// evaluation knows none of them.
fn simulated(campaign: &Campaign, truth: &[f64], s: f64, random: &mut StdRng) -> Campaign {
    let mut trial = campaign.clone();
    let points = campaign.points.len();
    let mut true_inputs: Vec<Vec<f64>> = (0..points)
        .map(|_| {
            campaign
                .experiment
                .inputs
                .iter()
                .map(|input| input.value)
                .collect()
        })
        .collect();
    let mut true_columns: Vec<Vec<f64>> = (0..points)
        .map(|point| {
            let columns = campaign.experiment.columns.iter();
            columns
                .map(|column| campaign.points.column(&column.name).expect("there").values[point])
                .collect()
        })
        .collect();
    let mut errors_of_responses =
        vec![vec![0.0; points]; campaign.experiment.equations.responses().len()];
    for doubt in &campaign.experiment.doubts {
        let drawn = errors(doubt, campaign, random);
        for Act {
            on, coefficient, ..
        } in &doubt.acts
        {
            for point in 0..points {
                let error = coefficient * drawn[point];
                match on {
                    Target::Input(place) => true_inputs[point][*place] += error,
                    Target::Reading(name) => {
                        let responses = campaign.experiment.equations.responses();
                        if let Some(r) = responses.iter().position(|r| r.name == *name) {
                            errors_of_responses[r][point] += error;
                        } else if let Some(c) = campaign
                            .experiment
                            .columns
                            .iter()
                            .position(|c| c.name == *name)
                        {
                            true_columns[point][c] -= error;
                        }
                    }
                }
            }
        }
    }
    let noise = Normal::new(0.0, s).expect("a scatter");
    for (r, response) in campaign.experiment.equations.responses().iter().enumerate() {
        let values: Vec<f64> = (0..points)
            .map(|point| {
                let mut symbols = true_columns[point].clone();
                symbols.extend_from_slice(truth);
                symbols.extend_from_slice(&true_inputs[point]);
                campaign.experiment.equations.value(r, &symbols)
                    + errors_of_responses[r][point]
                    + noise.sample(random)
            })
            .collect();
        let columns = &mut trial.points.columns;
        let column = columns
            .iter_mut()
            .find(|column| column.name == response.name);
        column.expect("a response column").values = values;
    }
    trial
}

/// The error of a doubt in every point.
fn errors(doubt: &Doubt, campaign: &Campaign, random: &mut StdRng) -> Vec<f64> {
    let half = doubt.u * 3.0_f64.sqrt();
    let shape = Uniform::new_inclusive(-half, half).expect("a width");
    let points = campaign.points.len();
    match &doubt.scope {
        Scope::Common => vec![shape.sample(random); points],
        Scope::Each => (0..points).map(|_| shape.sample(random)).collect(),
        Scope::By(name) => {
            let labels = campaign.points.labels(name).expect("labels");
            let of_level: Vec<f64> = labels.levels.iter().map(|_| shape.sample(random)).collect();
            labels
                .of_row
                .iter()
                .map(|level| of_level[*level as usize])
                .collect()
        }
    }
}

fn scatter(campaign: &Campaign, truth: &[f64], s: f64) -> Scatter {
    let mut random = StdRng::seed_from_u64(4);
    let found: Vec<Vec<f64>> = (0..TRIALS)
        .map(|_| estimates(&simulated(campaign, truth, s, &mut random)).expect("coefficients"))
        .collect();
    let count = found[0].len();
    let n = TRIALS as f64;
    let mean = |index: usize| found.iter().map(|one| one[index]).sum::<f64>() / n;
    let means: Vec<f64> = (0..count).map(mean).collect();
    let covariance = DMatrix::from_fn(count, count, |i, j| {
        let products = found
            .iter()
            .map(|one| (one[i] - means[i]) * (one[j] - means[j]));
        products.sum::<f64>() / (n - 1.0)
    });
    // Where residuals tell the scatter, u² is an estimate; its mean is what to compare.
    let mut predicted = DMatrix::zeros(count, count);
    for _ in 0..PREDICTIONS {
        let one = calibrate(&simulated(campaign, truth, s, &mut random)).expect("coefficients");
        predicted += one.figures.covariance / PREDICTIONS as f64;
    }
    Scatter {
        covariance,
        predicted,
    }
}

#[track_caller]
fn agrees(found: &Scatter) {
    let count = found.covariance.nrows();
    // The predictions are estimates themselves, of 10 degrees of freedom or more each.
    let n = 1.0 / (1.0 / TRIALS as f64 + 1.0 / (10.0 * PREDICTIONS as f64));
    for i in 0..count {
        let ratio = (found.covariance[(i, i)] / found.predicted[(i, i)]).sqrt();
        let allowed = 4.0 / (2.0 * n).sqrt();
        assert!(
            (ratio - 1.0).abs() < allowed,
            "coefficient {i}: ratio of u {ratio}"
        );
        for j in 0..i {
            let scale = (found.predicted[(i, i)] * found.predicted[(j, j)]).sqrt();
            let r = found.predicted[(i, j)] / scale;
            let simulated = found.covariance[(i, j)]
                / (found.covariance[(i, i)] * found.covariance[(j, j)]).sqrt();
            let allowed = 4.0 * (1.0 - r * r + 0.02) / n.sqrt();
            assert!(
                (simulated - r).abs() < allowed,
                "{i}, {j}: r {simulated}, predicted {r}"
            );
        }
    }
}

#[test]
fn a_rate_calibration_with_common_each_and_daily_errors() {
    let toml = r#"
equations = [
    "U = K*omega*(1 + e_rate + e_day + e_point) + b",
    "V = K*align*omega*(1 + e_rate + e_day + e_point) + 2*b",
]
[parameter]
K = {}
b = {}
align = {}
[input.e_rate]
half_width = 2e-3
[input.e_day]
half_width = 1e-3
by = "day"
[input.e_point]
half_width = 1e-3
scope = "each"
[reading.U]
half_width = 0.02
scope = "common"
[result.crosstalk]
model = "K*align"
unit = "mV·s/deg"
[recording]
file = "run.csv"
"#;
    let mut csv = String::from("omega [deg/s],day,U [mV],V [mV]\n");
    for day in 1..=3 {
        for omega in [-60, -30, 0, 30, 60] {
            csv += &format!("{omega},{day},0,0\n");
        }
    }
    let campaign = campaign(toml, &csv);
    let truth = [2.0, 0.3, 0.01];
    agrees(&scatter(&campaign, &truth, 0.05));
}

#[test]
fn a_tumble_with_a_nonlinear_model() {
    let toml = r#"
equations = ["E = R*K1*(K0 + g*sin(theta + e_theta) + K2*(g*sin(theta))^2 + delta*g*cos(theta))"]
[parameter.K0]
unit = "gn"
[parameter.K1]
unit = "mA/gn"
[parameter.K2]
unit = "1/gn"
[parameter.delta]
unit = "rad"
[constant]
g = "1 gn"
[input.R]
value = 500
unit = "ohm"
half_width = 0.05
[input.e_theta]
unit = "rad"
half_width = 1e-4
scope = "each"
[recording]
file = "run.csv"
"#;
    let mut csv = String::from("theta [deg],E [mV]\n");
    for theta in (0..360).step_by(45) {
        csv += &format!("{theta},{}\n", 100.0 * f64::from(theta).to_radians().sin());
    }
    let campaign = campaign(toml, &csv);
    let truth = [1e-3, 0.2, 1e-4, -5e-4];
    agrees(&scatter(&campaign, &truth, 0.01));
}
