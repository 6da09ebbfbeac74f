//! The law of propagation of uncertainty with exact derivatives, beside what central differences
//! would cost: 2N evaluations of the model for the first order, 2N² for all second derivatives.

mod common;

use std::fmt::Write;

use common::{best_of, budget};
use gumption::propagate::{MonteCarloChoice, Options, evaluate};

const RUNS: usize = 9;

fn main() {
    println!("Milliseconds (central differences over gumption)\n");
    println!(
        "{:<24}{:>8}{:>20}{:>26}",
        "model", "inputs", "first derivatives", "both orders, k and U"
    );
    for inputs in [10, 100, 1000] {
        let squares: Vec<String> = (0..inputs).map(|i| format!("x{i}^2")).collect();
        line("sum of squares", &squares.join(" + "), inputs);
    }
    for inputs in [10, 100, 1000] {
        let factors: Vec<String> = (0..inputs).map(|i| format!("x{i}")).collect();
        line("product", &factors.join(" * "), inputs);
    }
}

fn line(name: &str, model: &str, inputs: usize) {
    let budget = budget(&text(model, inputs));
    let x: Vec<f64> = budget.inputs.iter().map(|input| input.estimate).collect();
    let value = milliseconds(|| budget.model.values(&x));
    let first = milliseconds(|| budget.model.gradients(&x));
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        threads: 1,
        ..Options::default()
    };
    let both = milliseconds(|| evaluate(&budget, &options));
    let n = inputs as f64;
    println!(
        "{name:<24}{inputs:>8}{:>20}{:>26}",
        format!("{first:.3} ({:.0} x)", 2.0 * n * value / first),
        format!("{both:.3} ({:.0} x)", 2.0 * n * n * value / both)
    );
}

fn milliseconds<T>(run: impl FnMut() -> T) -> f64 {
    best_of(RUNS, run).as_secs_f64() * 1e3
}

/// Inputs near 1, so that a product of a thousand stays a number.
fn text(model: &str, inputs: usize) -> String {
    let mut text = format!("title = \"Benchmark\"\n[measurand.Y]\nmodel = \"{model}\"\n");
    for i in 0..inputs {
        let value = 1.0 + 1e-4 * (i % 7) as f64;
        writeln!(text, "[input.x{i}]\nvalue = {value}\nu = 0.001").expect("a string takes all");
    }
    text
}
