//! Propagation of large budgets: how the time of an evaluation without Monte Carlo, and that of
//! reading and checking the file, grow with the number of inputs.

mod common;

use std::fmt::Write;

use common::{best_of, budget, words};
use gumption::propagate::{MonteCarloChoice, Options, evaluate};

const RUNS: usize = 5;

fn main() {
    println!("Milliseconds, one thread, both orders, k and U, without Monte Carlo\n");
    println!(
        "{:<34}{:>8}{:>14}{:>14}",
        "model", "inputs", "evaluation", "reading"
    );
    let wanted = words().next();
    for (name, inputs, text) in cases() {
        if wanted.as_ref().is_none_or(|wanted| name.contains(wanted)) {
            line(name, inputs, &text);
        }
    }
}

type Case = (&'static str, usize, String);

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for inputs in [1000, 10_000] {
        let joined = |each: &dyn Fn(usize) -> String, between: &str| {
            let parts: Vec<String> = (0..inputs).map(each).collect();
            scalars(&parts.join(between), inputs)
        };
        let x = |i: usize| format!("x{i}");
        cases.extend([
            ("sum", inputs, joined(&x, " + ")),
            (
                "sum of squares",
                inputs,
                joined(&|i| format!("x{i}^2"), " + "),
            ),
            ("product", inputs, joined(&x, " * ")),
            (
                "neighbours",
                inputs,
                joined(&|i| format!("x{i}*exp(x{}/7)", (i + 1) % inputs), "+"),
            ),
        ]);
        for (name, model) in [
            ("vector, norm", "norm(x)"),
            ("vector, exp of mean", "exp(mean(x))"),
            ("vector, standard deviation", "sd(x)"),
            ("vector, weighted mean", "sum(x * x^3) / sum(x^3)"),
        ] {
            cases.push((name, inputs, vector(model, inputs)));
        }
    }
    for (name, model) in [
        ("dense correlation, sum", "sum(x)"),
        ("dense correlation, sum of squares", "sum(x^2)"),
        ("dense correlation, norm", "norm(x)"),
    ] {
        cases.push((name, 1000, correlated(model, 1000)));
    }
    cases
}

fn line(name: &str, inputs: usize, text: &str) {
    let read = best_of(RUNS.min(3), || budget(text));
    let budget = budget(text);
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        threads: 1,
        ..Options::default()
    };
    let evaluated = best_of(RUNS, || evaluate(&budget, &options));
    println!(
        "{name:<34}{inputs:>8}{:>14.3}{:>14.3}",
        evaluated.as_secs_f64() * 1e3,
        read.as_secs_f64() * 1e3
    );
}

fn heading(model: &str) -> String {
    format!("title = \"Benchmark\"\n[measurand.Y]\nmodel = \"{model}\"\n")
}

/// Near 1, so that a product of thousands stays a number, and not all alike.
fn estimate(i: usize) -> f64 {
    1.0 + 1e-4 * (i % 7) as f64
}

/// Inputs x0, x1 …, every third of them rectangular.
fn scalars(model: &str, inputs: usize) -> String {
    let mut text = heading(model);
    for i in 0..inputs {
        let u = if i % 3 == 0 {
            "half_width = 0.001"
        } else {
            "u = 0.001"
        };
        writeln!(text, "[input.x{i}]\nvalue = {}\n{u}", estimate(i)).expect("a string takes all");
    }
    text
}

/// One vector input x.
fn vector(model: &str, inputs: usize) -> String {
    let values: Vec<String> = (0..inputs).map(|i| estimate(i).to_string()).collect();
    format!(
        "{}[input.x]\nvalues = [{}]\nhalf_width = 0.001\n",
        heading(model),
        values.join(", ")
    )
}

/// One vector input x, whose elements correlate the more the nearer they are.
fn correlated(model: &str, inputs: usize) -> String {
    let mut text = heading(model);
    let values: Vec<String> = (0..inputs).map(|i| estimate(i).to_string()).collect();
    let row = |i: usize| {
        let row: Vec<String> = (0..inputs)
            .map(|j| format!("{}", correlation(i.abs_diff(j))))
            .collect();
        format!("[{}]", row.join(", "))
    };
    let rows: Vec<String> = (0..inputs).map(row).collect();
    write!(
        text,
        "[input.x]\nvalues = [{}]\nu = 0.001\n[[joint]]\ninputs = [\"x\"]\ncorrelation = [{}]\n",
        values.join(", "),
        rows.join(",\n")
    )
    .expect("a string takes all");
    text
}

fn correlation(distance: usize) -> f64 {
    (libm::exp(-0.02 * distance as f64) * 1e9).round() / 1e9
}
