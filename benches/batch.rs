//! Rows of a batch on one thread of this process, in turns: from a file to a file, both in memory, and from columns of
//! doubles to columns of doubles. Ten inputs with value and u, as in `fleet.py`. CPU time, medians.
//!
//! ```text
//! cargo bench --bench batch                    # both ways
//! cargo bench --bench batch -- 'text to text'  # those with a part in their name
//! ```

mod common;

use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

use common::{cpu_time, words};
use gumption::Files;
use gumption::batch::{self, Plan};
use gumption::budget::BatchFile;
use gumption::csv::{self, Cells};
use gumption::propagate::Progress;
use gumption::report::Language;
use gumption::report::batch::{Columns, Results, Table};

const ROWS: usize = 100_000;
const TURNS: usize = 9;
const NAMES: [&str; 10] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"];
const MODEL: &str = "a * b / c + d * e - f / g + h * i * j";

fn main() {
    let mut budget = format!("[measurand.y]\nmodel = \"{MODEL}\"\n");
    for (at, name) in NAMES.iter().enumerate() {
        let dof = 5 + at;
        budget += &format!("[input.{name}]\nvalue = 1.5\nu = 0.01\ndof = {dof}\n");
    }
    let files = [("budget.toml", budget.as_bytes())];
    let file = BatchFile::open(Files::Library(&files), Path::new("budget.toml"), None);
    let file = file.expect("a budget");
    let (heads, numbers) = table();
    let text = written(&heads, &numbers);
    let plan = Plan {
        monte_carlo: None,
        threads: 1,
        keep: Vec::new(),
        progress: Progress::default(),
    };
    let columns = Columns {
        shares: false,
        contributions: false,
        seeds: false,
        language: Language::English,
    };
    let from_text = || {
        let mut table = Table::of(columns, &file);
        let mut out = Vec::new();
        batch::run(
            &file,
            (text.as_bytes(), "table"),
            &plan,
            |lines, row| columns.add(lines, row),
            |lines, _| {
                out.extend(table.add(lines));
                ControlFlow::Continue(())
            },
        )
        .expect("a batch");
        std::hint::black_box(out);
    };
    let from_columns = || {
        let cells = numbers.iter().map(|numbers| Cells::Numbers(numbers.into()));
        let rows = csv::Columns::new(heads.iter().cloned().zip(cells).collect());
        let mut results = Results::of(columns, &file);
        batch::run_columns(
            &file,
            ([Ok(rows.expect("equal lengths"))], "table"),
            &plan,
            |values, row| columns.add_values(values, row),
            |values, _| {
                results.add(values);
                ControlFlow::Continue(())
            },
        )
        .expect("a batch");
        std::hint::black_box(results.end());
    };
    let ways: [(&str, &dyn Fn()); 2] = [
        ("from text to text", &from_text),
        ("from columns to columns", &from_columns),
    ];
    let parts: Vec<String> = words().collect();
    let wanted = |name: &str| parts.is_empty() || parts.iter().any(|part| name.contains(part));
    let ways: Vec<_> = ways.into_iter().filter(|(name, _)| wanted(name)).collect();
    let mut seconds = vec![Vec::new(); ways.len()];
    for _ in 0..TURNS {
        for (seconds, (_, way)) in seconds.iter_mut().zip(&ways) {
            let start = cpu_time();
            way();
            seconds.push(cpu_time() - start);
        }
    }
    let rates = seconds.into_iter().map(|mut seconds| {
        seconds.sort_by(f64::total_cmp);
        ROWS as f64 / seconds[TURNS / 2]
    });
    let rates: Vec<f64> = rates.collect();
    println!("rows per second and core, of {ROWS}");
    for ((name, _), rate) in ways.iter().zip(&rates) {
        println!("{name:24} {:9.0}   × {:.2}", rate, rate / rates[0]);
    }
}

/// Columns with six decimals, from a generator by Lehmer.
fn table() -> (Vec<String>, Vec<Vec<f64>>) {
    let mut state = 1u64;
    let mut between = |low: f64, high: f64| {
        state = state * 48_271 % 0x7fff_ffff;
        let x = low + (high - low) * state as f64 / 2_147_483_647.0;
        (x * 1e6).round() / 1e6
    };
    let heads = NAMES
        .iter()
        .flat_map(|name| [(*name).into(), format!("{name}.u")]);
    let heads: Vec<String> = heads.collect();
    let column = |at: usize| match at % 2 {
        0 => (0..ROWS).map(|_| between(1.0, 10.0)).collect(),
        _ => (0..ROWS).map(|_| between(0.001, 0.01)).collect(),
    };
    let numbers = (0..heads.len()).map(column).collect();
    (heads, numbers)
}

fn written(heads: &[String], numbers: &[Vec<f64>]) -> String {
    let mut text = heads.join(",") + "\n";
    for row in 0..ROWS {
        for (at, column) in numbers.iter().enumerate() {
            let separator = if at > 0 { "," } else { "" };
            // Writing to memory does not fail.
            let _ = write!(text, "{separator}{:?}", column[row]);
        }
        text.push('\n');
    }
    text
}
