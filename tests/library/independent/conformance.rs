//! Probabilities of conformance, and verdicts by them, of results whose distribution is no normal one.

use super::{integrate, phi};
use crate::common::evaluation::{close, evaluate};
use gumption::propagate::{Evaluation, Verdict};

/// A result that is a sum of inputs, and the rule that 90 % must conform, for values up to 1.
fn measured(model: &str, inputs: &str) -> Evaluation {
    evaluate(&format!(
        "[measurand.y]\nmodel = '{model}'\n[input]\n{inputs}[conformity]\nupper = 1\nconformance_probability = 0.9\n"
    ))
}

/// p_c, and whether the verdict is that of p_c ≥ 0.9.
fn probability(found: &Evaluation) -> f64 {
    let conformity = &found.conformity[0];
    let conformance = conformity.conformance.as_ref().expect("of a measurement");
    let p = conformance.probability.expect("a probability");
    let conforms = conformity.verdict == Some(Verdict::Conforming);
    assert_eq!(conforms, p >= 0.9, "{p}");
    p
}

#[test]
fn a_rectangle_conforms_by_its_share_below_the_limit() {
    for (value, share) in [(0.924, 0.88), (0.95, 0.75), (0.915, 0.925), (0.89, 1.0)] {
        let inputs = format!("x = {{ value = {value}, half_width = 0.1 }}\n");
        let found = measured("x", &inputs);
        close(probability(&found), share, 1e-9);
    }
    // The limit itself leaves a tenth of the rectangle above.
    let found = measured("x", "x = { value = 0.5, half_width = 0.1 }\n");
    let acceptance = found.conformity[0].acceptance.expect("some are accepted");
    close(acceptance.upper, 0.92, 1e-9);
}

#[test]
fn an_arcsine_never_leaves_its_limits() {
    let input = "x = { value = 0.95, half_width = 0.1, distribution = 'arcsine' }\n";
    let share = 0.5 + (0.5f64).asin() / std::f64::consts::PI;
    close(probability(&measured("x", input)), share, 1e-6);
    let input = input.replace("0.95", "0.899");
    close(probability(&measured("x", &input)), 1.0, 1e-12);
}

#[test]
fn a_trapezoid_and_its_normal_remainder() {
    let inputs = "a = { value = 0.9, half_width = 0.1 }\nb = { value = 0, half_width = 0.04 }\nn = { value = 0, u = 0.004 }\n";
    // P(a + b + n ≤ 1) by integrals over a and b.
    let of_a = |a: f64| {
        let below = |b: f64| phi((0.1 - a - b) / 0.004);
        integrate(-0.04, 0.04, below) / 0.08
    };
    const STEPS: u32 = 400;
    let a = |n: u32| -0.1 + 0.2 * (f64::from(n) + 0.5) / f64::from(STEPS);
    let share = (0..STEPS).map(|n| of_a(a(n))).sum::<f64>() / f64::from(STEPS);
    close(probability(&measured("a + b + n", inputs)), share, 1e-4);
}

/// Where Monte Carlo refutes the GUM, limits and probability are of the trials.
#[test]
fn trials_decide_where_nothing_dominates() {
    for place in [0.93_f64, 0.94, 0.945, 0.95, 0.96] {
        let third = |name: &str| {
            format!(
                "{name} = {{ value = {}, half_width = 0.03 }}\n",
                place / 3.0
            )
        };
        let inputs: String = ["a", "b", "c"].map(third).concat();
        let found = measured("a + b + c", &inputs);
        // The sum of three rectangles on [-1, 1] has (3 − x)³/48 above an x from 1 on, and a cubic in the middle.
        let x: f64 = (1.0 - place) / 0.03;
        let above = match x >= 1.0 {
            true => (3.0 - x).max(0.0).powi(3) / 48.0,
            false => 0.5 - x * (9.0 - x * x) / 24.0,
        };
        close(probability(&found), 1.0 - above, 2e-3);
    }
}
