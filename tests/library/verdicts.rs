//! No verdict stands on an uncertainty that the first order does not see.

use crate::common::evaluation::{evaluate, gum};
use gumption::propagate::Verdict;

fn budget(model: &str, value: f64) -> String {
    format!(
        "[measurand.y]\nmodel = \"{model}\"\n[input]\nx = {{ value = {value}, u = 1 }}\n\
         [conformity]\nupper = 0.5\nrule = \"guarded-acceptance\"\n"
    )
}

/// x² of x = 0 ± 1 has no first order, x⁴ no second either. Of x = 0.01 ± 1 both say something else.
#[test]
fn without_trials_it_is_withheld() {
    for (model, value) in [("x^2", 0.0), ("x^4", 0.0), ("x^2", 0.01)] {
        let found = gum(&budget(model, value));
        let conformity = &found.conformity[0];
        assert_eq!(
            conformity.verdict,
            Some(Verdict::Withheld),
            "{model} at {value}"
        );
        assert_eq!(conformity.conformance, None);
    }
    // Linear, exact at this point, or decided alike by both orders.
    for (model, value) in [("x", -3.0), ("x - x", 0.0)] {
        let found = gum(&budget(model, value));
        assert_eq!(
            found.conformity[0].verdict,
            Some(Verdict::Conforming),
            "{model} at {value}"
        );
    }
    let found = gum(&budget("x^2", 3.0));
    assert_eq!(found.conformity[0].verdict, Some(Verdict::NotConforming));
}

/// P(x² ≤ ½) = 2Φ(√½) − 1.
#[test]
fn with_trials_it_is_given() {
    let found = evaluate(&budget("x^2", 0.0));
    let conformity = &found.conformity[0];
    assert_eq!(conformity.verdict, Some(Verdict::NotConforming));
    let by_trials = conformity.conformance.and_then(|known| known.from_trials);
    let expected = 0.520_499_877_813_046_5;
    assert!((by_trials.expect("trials") - expected).abs() < 0.002);
}
