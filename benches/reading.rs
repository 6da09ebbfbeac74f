//! Large budgets, from their text to the checked budget, beside the bare parser of TOML on the same text: 10 000 inputs
//! in a sum, 1 000 inputs with a correlation of all pairs, a series of 20 000 rows, and 1 000 measurands of an input each
//! and one in common. CPU time, medians, in turns.
//!
//! The parser makes some 300 bytes of tokens, events and values of every number. A matrix of plain numbers is therefore
//! taken out of the text before it is parsed, and a ratio below one is reached; what is left of the time are the checks
//! of half a million pairs and the factor that shows the matrix to be possible. Of 10 000 inputs the parser takes two
//! fifths, the compilation of the formula a fifth, and the tables and checks of each input the rest.
//!
//! ```text
//! cargo bench --bench reading             # all of them
//! cargo bench --bench reading -- inputs   # those with a part in their name
//! ```

mod common;

use std::fmt::Write;
use std::path::Path;

use common::{cpu_time, words};
use gumption::budget;
use toml::de::DeTable;

const TURNS: usize = 9;

fn main() {
    let cases = [
        ("10 000 inputs", inputs(10_000)),
        (
            "1 000 × 1 000 correlation",
            inputs(1_000) + &correlation(1_000),
        ),
        ("20 000 rows", inputs(3) + &rows(20_000)),
        ("1 000 measurands", measurands(1_000)),
    ];
    println!(
        "{:28} {:>12} {:>12} {:>7}",
        "ms of CPU time", "gumption", "TOML alone", "ratio"
    );
    let parts: Vec<String> = words().collect();
    let wanted =
        |name: &str| parts.is_empty() || parts.iter().any(|part| name.contains(part.as_str()));
    for (name, text) in cases.into_iter().filter(|(name, _)| wanted(name)) {
        let whole = || drop(budget::read(&text, "large.toml", Path::new("")).expect("a budget"));
        let parser = || drop(DeTable::parse(&text).expect("TOML"));
        let ways: [&dyn Fn(); 2] = [&whole, &parser];
        let mut seconds = [Vec::new(), Vec::new()];
        for _ in 0..TURNS {
            for (seconds, way) in seconds.iter_mut().zip(ways) {
                let start = cpu_time();
                way();
                seconds.push(cpu_time() - start);
            }
        }
        let [whole, parser] = seconds.map(|mut seconds| {
            seconds.sort_by(f64::total_cmp);
            1e3 * seconds[TURNS / 2]
        });
        println!(
            "{name:28} {whole:12.1} {parser:12.1} {:7.1}",
            whole / parser
        );
    }
}

/// A budget that adds so many inputs.
fn inputs(count: usize) -> String {
    let names: Vec<String> = (0..count).map(|at| format!("x{at}")).collect();
    let mut text = format!("[measurand.y]\nmodel = \"{}\"\n", names.join(" + "));
    for (at, name) in names.iter().enumerate() {
        // Writing to memory does not fail.
        let _ = write!(
            text,
            "[input.{name}]\nvalue = {}\nu = 0.01\n",
            1.0 + 0.001 * at as f64
        );
    }
    text
}

/// A series of so many rows of the values of two inputs.
fn rows(count: usize) -> String {
    let mut text = String::from("[series]\ncolumns = [\"x0\", \"x1\"]\nrows = [\n");
    for at in 0..count {
        let value = 1.0 + 0.001 * at as f64;
        let _ = writeln!(text, "[{value}, {}],", 2.0 * value);
    }
    text + "]\n"
}

/// So many products of an input of their own with one in common.
fn measurands(count: usize) -> String {
    let mut text = String::from("[input.k]\nvalue = 1\nu = 0.001\n");
    for at in 0..count {
        let _ = write!(
            text,
            "[measurand.y{at}]\nmodel = \"k * x{at}\"\n[input.x{at}]\nvalue = 2\nu = 0.01\n"
        );
    }
    text
}

/// r = 0.9ⁿ of inputs that stand n apart, with four decimals.
fn correlation(count: usize) -> String {
    let names: Vec<String> = (0..count).map(|at| format!("\"x{at}\"")).collect();
    let mut text = format!(
        "[[joint]]\ninputs = [{}]\ncorrelation = [\n",
        names.join(", ")
    );
    for row in 0..count {
        let cells = (0..count).map(|column| {
            let apart = row.abs_diff(column) as i32;
            format!("{:.4}", 0.9f64.powi(apart))
        });
        let _ = writeln!(text, "[{}],", cells.collect::<Vec<_>>().join(", "));
    }
    text + "]\n"
}
