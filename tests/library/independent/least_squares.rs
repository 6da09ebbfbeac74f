//! A scale factor by least squares over eleven rates (JJF 2003-2022, A.1), from its measurement model.
//!
//! The published evaluation adds three components to K: table 1.0e-4, acquisition 1.41e-4, repeatability 1.22e-4,
//! together 2.12e-4. From the model, the error of the table, common to all rates, passes to K in full; those of
//! the eleven readings average, and quantisation is one of them and no error of K. With the assumptions of the
//! budget u(K) = 1.43e-4.

use std::path::Path;

use crate::common::evaluation::close;
use gumption::budget;
use gumption::propagate::{self, Options};

const RATES: [f64; 11] = [
    -100.0, -80.0, -60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0, 80.0, 100.0,
];

/// (u(K), u(b)) in closed form for rates X, a relative error of all rates together and one of each reading.
fn closed_form(rates: &[f64], k: f64, u_table: f64, u_reading: f64) -> (f64, f64) {
    let n = rates.len() as f64;
    let mean = rates.iter().sum::<f64>() / n;
    let squares: f64 = rates.iter().map(|x| (x - mean).powi(2)).sum();
    let slope = ((k * u_table).powi(2) + u_reading.powi(2) / squares).sqrt();
    // X → X(1 + ε) turns K into K/(1 + ε) and leaves b = Ū − K X̄ as it is.
    let intercept = u_reading * (1.0 / n + mean * mean / squares).sqrt();
    (slope, intercept)
}

fn quantised(repeatability: f64, range: f64) -> f64 {
    repeatability.hypot(range / 4096.0 / 12f64.sqrt())
}

#[test]
fn scale_factor_and_bias_of_the_library() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("budgets/inertial/mimu-gyro-scale-factor-from-model.toml");
    let loaded =
        budget::load(&path).unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let found = propagate::evaluate(&loaded.rows[0].budget, &Options::default()).expect("a value");
    let (slope, intercept) = closed_form(&RATES, 1.0, 1e-4, quantised(0.012, 250.0));
    for (result, (estimate, u)) in found.results.iter().zip([(1.0, slope), (0.05, intercept)]) {
        close(result.gum.estimate, estimate, 1e-12);
        close(result.gum.u / u, 1.0, 1e-9);
        let mc = result.monte_carlo.as_ref().expect("Monte Carlo was run");
        close(mc.estimate.expect("moments"), estimate, 0.004 * u);
        close(mc.u.expect("moments") / u, 1.0, 0.004);
    }
    close(slope, 1.43e-4, 0.005e-4);
    // Rates about zero: slope and intercept are uncorrelated.
    close(
        found.joint.expect("two measurands").correlation[(0, 1)],
        0.0,
        1e-9,
    );
}

#[test]
fn rates_of_one_sign_correlate_slope_and_intercept() {
    let rates = [10.0, 20.0, 30.0, 50.0, 80.0];
    let outputs = rates.map(|x| 2.0 * x - 1.0);
    let text = format!(
        "
[measurand]
K = {{ model = 'slope(X, U)' }}
b = {{ model = 'intercept(X, U)' }}
[source.table]
u = 2e-4
[input.X]
values = {rates:?}
source = 'table'
relative = true
[input.U]
values = {outputs:?}
u = 0.01
"
    );
    let found = crate::common::evaluation::gum(&text);
    let (slope, intercept) = closed_form(&rates, 2.0, 2e-4, 0.01);
    close(found.results[0].gum.u / slope, 1.0, 1e-9);
    close(found.results[1].gum.u / intercept, 1.0, 1e-9);
    // cov(K, b) = −X̄ u²/Σ(X − X̄)²: the table's error has no part in it.
    let mean = 38.0;
    let squares: f64 = rates.iter().map(|x| (x - mean).powi(2)).sum();
    let r = -mean * 1e-4 / squares / (slope * intercept);
    close(
        found.joint.expect("two measurands").correlation[(0, 1)],
        r,
        1e-9,
    );
}

#[test]
fn a_line_through_the_origin() {
    // K = Σ X U / Σ X², u(K) = u/√ΣX² for readings of equal u.
    let found = crate::common::evaluation::gum(
        "[measurand.K]\nmodel = 'slope_through_origin(X, U)'\n[constant.X]\nvalues = [1, 2, 3, 4]\n[input.U]\nvalues = [2.1, 3.9, 6.2, 7.9]\nu = 0.1\n",
    );
    close(
        found.results[0].gum.estimate,
        (2.1 + 7.8 + 18.6 + 31.6) / 30.0,
        1e-12,
    );
    close(found.results[0].gum.u, 0.1 / 30f64.sqrt(), 1e-12);
}
