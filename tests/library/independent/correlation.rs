//! Correlated inputs: their sum and difference, in both methods, and shared sources.

use super::{t, z};
use crate::common::evaluation::{budget, close, close_ends, evaluate, gum, only};
use gumption::budget::Law;

/// Sum and difference of two inputs with r = 0.8.
fn sum_and_difference(uncertainty: &str) -> String {
    format!(
        "
[measurand]
total = {{ model = 'a + b' }}
difference = {{ model = 'a - b' }}
[input]
a = {{ value = 0, {uncertainty} }}
b = {{ value = 0, {uncertainty} }}
[[correlation]]
between = ['a', 'b']
r = 0.8
"
    )
}

const SUM: f64 = 1.897_366_596_101_027_6; // √(2 + 2·0.8)
const DIFFERENCE: f64 = 0.632_455_532_033_675_9; // √(2 − 2·0.8)

#[test]
fn normal_inputs() {
    let found = evaluate(&sum_and_difference("u = 1"));
    for (result, u) in found.results.iter().zip([SUM, DIFFERENCE]) {
        close(result.gum.u, u, 1e-12);
        let mc = result.monte_carlo.as_ref().expect("Monte Carlo was run");
        close(mc.u.expect("moments"), u, 0.004 * u);
        close_ends(mc.symmetric, [-z(0.975) * u, z(0.975) * u], 0.012 * u);
        close(mc.excess_kurtosis.expect("moments"), 0.0, 0.02);
    }
    let joint = found.joint.expect("two measurands");
    close(joint.correlation[(0, 1)], 0.0, 1e-12);
    close(
        joint.monte_carlo_correlation.expect("moments")[(0, 1)],
        0.0,
        0.004,
    );
}

#[test]
fn t_inputs_of_one_experiment_are_jointly_t() {
    // A linear combination of a multivariate t is t with the same ν (JCGM 102 5.3.2).
    let found = evaluate(&sum_and_difference("u = 1, dof = 9"));
    for (result, u) in found.results.iter().zip([SUM, DIFFERENCE]) {
        close(result.gum.u, u, 1e-12);
        close(result.gum.freedom.value(), 9.0, 1e-12);
        close(result.gum.coverage.k, t(0.975, 9.0), 1e-6);
        let mc = result.monte_carlo.as_ref().expect("Monte Carlo was run");
        close(mc.u.expect("moments"), u * (9.0f64 / 7.0).sqrt(), 0.008 * u);
        let end = t(0.975, 9.0) * u;
        close_ends(mc.symmetric, [-end, end], 0.02 * u);
    }
}

#[test]
fn rectangular_inputs_are_joined_by_a_copula_of_that_r() {
    let text = sum_and_difference("half_width = 1.7320508075688772");
    // r = (6/π) asin(ρ/2) for a Gaussian copula of rectangles (Pearson 1907).
    match &budget(&text).groups[0].law {
        Law::GaussianCopula { latent } => {
            let rho = 2.0 * (std::f64::consts::PI * 0.8 / 6.0).sin();
            close(latent[(0, 1)], rho, 1e-9);
        }
        other => panic!("{other:?}"),
    }
    let found = evaluate(&text);
    for (result, u) in found.results.iter().zip([SUM, DIFFERENCE]) {
        close(result.gum.u, u, 1e-9);
        let mc = result.monte_carlo.as_ref().expect("Monte Carlo was run");
        close(mc.u.expect("moments"), u, 0.004 * u);
    }
    // The margins stay what they were stated to be.
    let sampled = found.results[0]
        .monte_carlo
        .as_ref()
        .expect("Monte Carlo was run");
    assert!(sampled.symmetric[1] < 2.0 * 3f64.sqrt());
}

#[test]
fn margins_of_different_shapes_have_the_stated_correlation() {
    let found = evaluate(
        "
[measurand]
y = { model = 'a' }
z = { model = 'b' }
[input]
a = { value = 0, half_width = 1 }
b = { distribution = { exponential = { mean = 2 } } }
[[correlation]]
between = ['a', 'b']
r = -0.6
",
    );
    let joint = found.joint.expect("two measurands");
    close(joint.correlation[(0, 1)], -0.6, 1e-12);
    close(
        joint.monte_carlo_correlation.expect("moments")[(0, 1)],
        -0.6,
        0.004,
    );
    let margin = found.results[1]
        .monte_carlo
        .as_ref()
        .expect("Monte Carlo was run");
    close_ends(
        margin.symmetric,
        [-2.0 * 0.975f64.ln(), -2.0 * 0.025f64.ln()],
        0.05,
    );
}

#[test]
fn a_shared_source_is_a_correlation_of_one() {
    let inputs = |way: &str| {
        format!(
            "[measurand.y]\nmodel = '3 * a - b'\n[input]\na = {{ value = 5, {way} }}\nb = {{ value = 2, {way} }}\n"
        )
    };
    let shared = format!("{}[source.s]\nu = 0.1\n", inputs("source = 's'"));
    let stated = format!(
        "{}[[correlation]]\nbetween = ['a', 'b']\nr = 1\n",
        inputs("u = 0.1")
    );
    let (shared, stated) = (evaluate(&shared), evaluate(&stated));
    for found in [&shared, &stated] {
        let result = only(found);
        close(result.gum.u, 0.2, 1e-12);
        close(
            result
                .monte_carlo
                .as_ref()
                .and_then(|mc| mc.u)
                .expect("moments"),
            0.2,
            0.001,
        );
        // Contributions with sign, shares by Kessel: (0.3 − 0.1)·0.3/0.04 and −(0.3 − 0.1)·0.1/0.04.
        close(result.gum.inputs[0].share, 1.5, 1e-9);
        close(result.gum.inputs[1].share, -0.5, 1e-9);
    }
    close(
        only(&shared).gum.coverage.k,
        only(&stated).gum.coverage.k,
        1e-12,
    );
}

#[test]
fn a_shared_relative_error_cancels_in_a_ratio() {
    let text = "
[measurand]
ratio = { model = 'a / b' }
product = { model = 'a * b' }
[source.s]
u = 0.001
[input]
a = { value = 5, source = 's', relative = true }
b = { value = 2, source = 's', relative = true }
";
    let found = gum(text);
    close(found.results[0].gum.u, 0.0, 1e-15);
    close(found.results[1].gum.u, 10.0 * 0.002, 1e-14);
}
