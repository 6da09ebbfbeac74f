//! Budgets written in a test, evaluated by the whole program.

use std::path::Path;

use gumption::budget::{self, Budget};
use gumption::propagate::{
    self, Evaluation, MeasurandResult, MonteCarlo, MonteCarloChoice, Options,
};

/// The budget of a text, which must be accepted.
#[track_caller]
pub fn budget(text: &str) -> Budget {
    match budget::read(text, "test.toml", Path::new("")) {
        Ok(mut loaded) => loaded.rows.remove(0).budget,
        Err(rejection) => panic!("{}", rejection.render(false)),
    }
}

/// Both methods, as the text says.
#[track_caller]
pub fn evaluate(text: &str) -> Evaluation {
    evaluation_of(&budget(text), MonteCarloChoice::AsBudget)
}

/// First and second order alone.
#[track_caller]
pub fn gum(text: &str) -> Evaluation {
    evaluation_of(&budget(text), MonteCarloChoice::Off)
}

#[track_caller]
fn evaluation_of(budget: &Budget, monte_carlo: MonteCarloChoice) -> Evaluation {
    let options = Options {
        monte_carlo,
        ..Options::default()
    };
    propagate::evaluate(budget, &options).expect("the model has values at the estimates")
}

/// What the reader of a refused text is told.
#[track_caller]
pub fn refusal(text: &str) -> String {
    match budget::read(text, "test.toml", Path::new("")) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(rejection) => rejection.render(false),
    }
}

/// The result of a budget with one measurand.
pub fn only(evaluation: &Evaluation) -> &MeasurandResult {
    assert_eq!(evaluation.results.len(), 1);
    &evaluation.results[0]
}

/// The Monte Carlo result of a budget with one measurand.
pub fn sampled(evaluation: &Evaluation) -> &MonteCarlo {
    only(evaluation)
        .monte_carlo
        .as_ref()
        .expect("Monte Carlo was run")
}

/// Fails unless the two differ by no more than the tolerance.
#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} ± {tolerance}"
    );
}

/// The same for both ends of an interval.
#[track_caller]
pub fn close_ends(found: [f64; 2], expected: [f64; 2], tolerance: f64) {
    close(found[0], expected[0], tolerance);
    close(found[1], expected[1], tolerance);
}
