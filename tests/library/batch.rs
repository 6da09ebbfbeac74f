//! A batch gives every row what the budget gives with the row written into it by hand.

use std::ops::ControlFlow;
use std::path::Path;

use gumption::Files;
use gumption::batch::{self, Plan};
use gumption::budget::{BatchFile, Budget, Trials, Wanted};
use gumption::csv::{Cells, Sheet};
use gumption::fault::Rejection;
use gumption::propagate::{self, MonteCarloChoice, Options, Progress};
use gumption::report::batch::{Columns, Count, ResultColumn, Results, Table};
use gumption::report::{self, Language, Report};

/// A budget with what a row replaces in place.
fn written([readings, big_u, resistance, u, r, upper]: [&str; 6]) -> String {
    format!(
        r#"
title = "Current through a shunt"

[measurand.I]
model = "V / R * (1 + drift)"
unit = "mA"

[input.V]
unit = "V"
components = [
  {{ name = "repeatability", readings = {readings} }},
  {{ name = "calibration", certificate = {{ U = {big_u}, k = 2 }} }},
]

[input.R]
value = {resistance}
unit = "ohm"
u = {u}

[input.drift]
value = 0
u = 0.001

[[correlation]]
between = ["R", "drift"]
r = {r}

[conformity]
measurand = "I"
rule = "simple"
upper = {upper}
"#
    )
}

const ANY: [&str; 6] = ["[1, 1.1, 1.2]", "0.1", "1", "0.1", "0", "100"];

/// As a table has them, and as a file has them.
const ROWS: [([&str; 7], [&str; 6]); 3] = [
    (
        [
            "a",
            "[1.0001, 1.0003, 1.0000, 1.0002]",
            "40",
            "0.10002",
            "0.004",
            "0.5",
            "10.2",
        ],
        [
            "[1.0001, 1.0003, 1.0000, 1.0002]",
            "\"40 µV\"",
            "\"0.10002 kohm\"",
            "0.004",
            "0.5",
            "10.2",
        ],
    ),
    (
        [
            "b",
            "[2.01, 2.03, 1.99]",
            "55.5",
            "0.2",
            "1e-2",
            "-0.25",
            "10",
        ],
        [
            "[2.01, 2.03, 1.99]",
            "\"55.5 µV\"",
            "\"0.2 kohm\"",
            "1e-2",
            "-0.25",
            "10",
        ],
    ),
    (
        ["c", "[1.5, 1.6]", "1", "0.1", ".5", "0", "16.5"],
        ["[1.5, 1.6]", "\"1 µV\"", "\"0.1 kohm\"", "0.5", "0", "16.5"],
    ),
];

const HEADER: &str = "label;V.repeatability.readings;V.calibration.certificate.U [µV];R [kohm];R.u;r(R, drift);conformity.upper";

fn plan(monte_carlo: Option<Wanted>, threads: usize) -> Plan {
    Plan {
        monte_carlo,
        threads,
        keep: Vec::new(),
        progress: Progress::default(),
    }
}

fn few_trials() -> Option<Wanted> {
    Some(Wanted {
        trials: Some(Trials::Fixed(2000)),
        ..Wanted::default()
    })
}

/// The table of results.
fn run(budget: &str, table: &str, plan: &Plan) -> Result<(String, Count), Rejection> {
    let files = [("budget.toml", budget.as_bytes())];
    let file = BatchFile::open(Files::Library(&files), Path::new("budget.toml"), None)?;
    let columns = Columns {
        shares: true,
        contributions: true,
        seeds: plan.monte_carlo.is_some(),
        language: Language::English,
    };
    let mut results = Table::of(columns, &file);
    let mut out = Vec::new();
    let kept = batch::run(
        &file,
        (table.as_bytes(), "table.csv"),
        plan,
        |lines, row| columns.add(lines, row),
        |lines, _| {
            out.extend(results.add(lines));
            ControlFlow::Continue(())
        },
    )?;
    results.keep(kept);
    let (left, count) = results.end();
    out.extend(left);
    Ok((String::from_utf8(out).expect("text"), count))
}

/// The results of a table in memory, as columns.
fn in_columns(
    file: &BatchFile<'_>,
    table: &gumption::csv::Columns<'_>,
    plan: &Plan,
    wanted: Columns,
) -> (Vec<(String, ResultColumn)>, Count) {
    let mut results = Results::of(wanted, file);
    let kept = batch::run_columns(
        file,
        ([Ok(table)], "table"),
        plan,
        |values, row| wanted.add_values(values, row),
        |values, _| {
            results.add(values);
            ControlFlow::Continue(())
        },
    )
    .expect("a batch");
    results.keep(kept);
    results.end()
}

/// The names of the columns, and each row.
fn cells(table: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let sheet = Sheet::new(table).expect("a table");
    let owned = |row: &gumption::csv::Row| row.fields().map(str::to_owned).collect();
    let rows = sheet.rows().map(|row| owned(&row.expect("a row")));
    (owned(sheet.header()), rows.collect())
}

fn cell<'r>(
    (heads, _): &(Vec<String>, Vec<Vec<String>>),
    row: &'r [String],
    head: &str,
) -> &'r str {
    let at = heads.iter().position(|one| one == head);
    &row[at.unwrap_or_else(|| panic!("no {head} in {heads:?}"))]
}

/// Readings in columns of their own, some of them missing and in another unit, are the list that they make; a column is no list
/// beside it, and has a unit like that of its input.
#[test]
fn readings_in_columns_of_their_own_are_a_list() {
    let budget = written(ANY);
    let evaluate = |table: &str| run(&budget, table, &plan(None, 1));
    let (listed, _) =
        evaluate("label;V.repeatability.readings\na;[1.5, 2.25, 1.75]\nb;[1.25, 1.5]\n")
            .expect("a batch");
    let (apart, _) = evaluate(
        "label;V.repeatability.readings.1;V.repeatability.readings.3 [mV];V.repeatability.readings.2\na;1.5;1750;2.25\nb;1.25;1500;\n",
    )
    .expect("a batch");
    assert_eq!(listed, apart);
    let (scaled, _) =
        evaluate("label;V.repeatability.readings [mV]\na;[1500, 2250, 1750]\nb;[1250, 1500]\n")
            .expect("a batch");
    assert_eq!(listed, scaled);
    for (table, message) in [
        (
            "label;V.repeatability.readings.1 [ohm]\na;1\n",
            "no unit like V",
        ),
        (
            "label;V.repeatability.readings;V.repeatability.readings.1\na;[1, 2];3\n",
            "two columns set the same",
        ),
        ("label;V_1;V_2\na;1;2\n", "V.readings.1, V.readings.2"),
    ] {
        let refused = evaluate(table).expect_err("no batch").render(false);
        assert!(refused.contains(message), "{refused}");
    }
}

/// Where readings of several inputs were taken together, none of them is left out by itself.
#[test]
fn a_missing_reading_does_not_shift_those_of_others() {
    let budget = "[measurand.P]\nmodel = \"V * I\"\n[input.V]\nreadings = [1, 2]\n[input.I]\nreadings = [1, 2]\n[[joint]]\ninputs = [\"V\", \"I\"]\n";
    let heads = "V.readings.1,V.readings.2,V.readings.3,I.readings.1,I.readings.2,I.readings.3";
    let table = format!("label,{heads}\na,1,2,3,4,5,7\nb,1,,3,4,5,\n");
    let (found, count) = run(budget, &table, &plan(None, 1)).expect("a batch");
    assert_eq!((count.rows, count.failed), (2, 1), "{found}");
    assert!(found.contains("a reading of V is missing"), "{found}");
}

#[test]
fn a_row_is_the_budget_with_the_row_written_into_it() {
    let rows: Vec<String> = ROWS.iter().map(|(row, _)| row.join(";")).collect();
    let table = format!("{HEADER}\n{}\n", rows.join("\n"));
    for monte_carlo in [None, few_trials()] {
        let plan = plan(monte_carlo.clone(), 2);
        let (found, count) = run(&written(ANY), &table, &plan).expect("a batch");
        assert_eq!((count.rows, count.failed), (3, 0), "{found}");
        let found = cells(&found);
        for (row, (given, by_hand)) in found.1.iter().zip(&ROWS) {
            let budget: Budget = gumption::budget(&written(*by_hand)).expect("a budget");
            let choice = match &monte_carlo {
                None => MonteCarloChoice::Off,
                Some(wanted) => MonteCarloChoice::With(budget.monte_carlo.with(&Wanted {
                    seed: Some(cell(&found, row, "seed").parse().expect("a seed")),
                    ..wanted.clone()
                })),
            };
            let options = Options {
                monte_carlo: choice,
                ..Options::default()
            };
            let evaluation = propagate::evaluate(&budget, &options).expect("a value");
            let report = Report {
                budget: &budget,
                evaluation: &evaluation,
                label: Some(given[0]),
                language: Language::English,
            };
            let expected = report::rows(&[report]).expect("a table");
            let expected = cells(std::str::from_utf8(&expected).expect("text"));
            let width = expected.0.len();
            assert_eq!(
                (&found.0[..width], &row[..width]),
                (&expected.0[..], &expected.1[0][..])
            );
            let shares: f64 = ["V", "R", "drift"]
                .map(|input| {
                    cell(&found, row, &format!("share(I, {input})"))
                        .parse::<f64>()
                        .expect("a share")
                })
                .iter()
                .sum();
            assert!(shares.is_finite() && cell(&found, row, "error").is_empty());
        }
    }
}

#[test]
fn rows_have_seeds_of_their_own_wherever_they_stand() {
    let rows: Vec<String> = ROWS.iter().map(|(row, _)| row.join(";")).collect();
    let seeds = |rows: &[&String], seed: Option<u64>| {
        let lines: Vec<&str> = rows.iter().map(|row| row.as_str()).collect();
        let table = format!("{HEADER}\n{}\n", lines.join("\n"));
        let wanted = few_trials().map(|wanted| Wanted { seed, ..wanted });
        let (found, _) = run(&written(ANY), &table, &plan(wanted, 1)).expect("a batch");
        let found = cells(&found);
        found
            .1
            .iter()
            .map(|row| cell(&found, row, "seed").to_owned())
            .collect::<Vec<_>>()
    };
    let all = seeds(&[&rows[0], &rows[1], &rows[2]], None);
    assert!(all[0] != all[1] && all[1] != all[2] && all[0] != all[2]);
    assert_eq!(
        seeds(&[&rows[2], &rows[0]], None),
        [all[2].clone(), all[0].clone()]
    );
    assert!(!all.contains(&seeds(&[&rows[0]], Some(2))[0]));
}

#[test]
fn a_faulty_row_stops_nothing() {
    let budget = "[measurand.y]\nmodel = \"x\"\n[input.x]\nvalue = 1\nu = 0.1\n";
    let table = "x,x.u\n1,0.1\n2,-0.1\n3\nfour,0.1\n5,0.5\ninf,0.1\n";
    let (found, count) = run(budget, table, &plan(None, 2)).expect("a batch");
    assert_eq!((count.rows, count.failed), (6, 4));
    let found = cells(&found);
    let values: Vec<&str> = found.1.iter().map(|row| cell(&found, row, "y")).collect();
    assert_eq!(values, ["1.0", "", "", "", "5.0", ""]);
    let errors: Vec<&str> = found
        .1
        .iter()
        .map(|row| cell(&found, row, "error"))
        .collect();
    assert!(errors[0].is_empty() && errors[4].is_empty());
    assert!(
        errors[1].contains("negative") || errors[1].contains('-'),
        "{errors:?}"
    );
    assert!(
        errors[2].starts_with("R0107: line 4 has 1 field"),
        "{errors:?}"
    );
    for error in [errors[3], errors[5]] {
        let said = error.contains("where a number is expected (leave it empty if");
        assert!(said, "{errors:?}");
    }
    let written = "x;x.u\n1.234,5;0,1\n1 000,5;0,1\n−1;0,1\n";
    let (written, _) = run(budget, written, &plan(None, 1)).expect("a batch");
    let errors = cells(&written).1;
    for (row, (text, mend)) in errors.iter().zip([
        ("1.234,5", "without marks of thousands"),
        ("1 000,5", "without marks of thousands"),
        ("−1", "write -1, with the hyphen"),
    ]) {
        let said = row.last().expect("an error");
        assert!(said.contains(text) && said.contains(mend), "{said}");
    }
    // A faulty row keeps its name, also where fields are missing behind it.
    let named = "label,x,x.u\nfirst,1,0.1\nsecond,2,-0.1\nthird,3\n007,four,0.1\n";
    let (named, _) = run(budget, named, &plan(None, 1)).expect("a batch");
    let labels: Vec<String> = cells(&named).1.iter().map(|row| row[0].clone()).collect();
    assert_eq!(labels, ["first", "second", "third", "007"]);
    // Rows without a result at the beginning wait until one tells what the columns are.
    let (late, _) = run(budget, "x,x.u\nfour,0.1\n5,0.5\n", &plan(None, 1)).expect("a batch");
    assert_eq!(cells(&late).0, found.0);
    let (none, count) = run(budget, "x,x.u\nfour,0.1\n", &plan(None, 1)).expect("a batch");
    assert_eq!((cells(&none).0, count.failed), (found.0, 1));
    // Nothing tells the columns where the budget is not whole and no row has a result.
    let open = budget.replace("value = 1\n", "");
    let (none, count) = run(&open, "x,x.u\n4,-0.1\n", &plan(None, 1)).expect("a batch");
    assert_eq!(
        (cells(&none).0, count.failed),
        (vec!["label".into(), "error".into()], 1)
    );
}

#[test]
fn a_long_table_is_the_same_on_any_number_of_threads() {
    let budget = "[measurand.y]\nmodel = \"x^2\"\n[input.x]\nvalue = 1\nu = 0.1\n";
    // More than one piece, and rows of many lengths.
    let rows = 3000;
    let pad = "0".repeat(100);
    let table: String = (0..rows).map(|x| format!("{x}.{pad},0.1\n")).collect();
    let table = format!("x,x.u\n{table}");
    let (one, count) = run(budget, &table, &plan(None, 1)).expect("a batch");
    let (three, _) = run(budget, &table, &plan(None, 3)).expect("a batch");
    assert_eq!(count.rows, rows);
    assert!(one == three, "the threads change the table");
    let found = cells(&one);
    for (x, row) in found.1.iter().enumerate() {
        assert_eq!(row[0], (x + 1).to_string());
        assert_eq!(cell(&found, row, "y"), format!("{:?}", (x * x) as f64));
    }
}

/// Two devices measured with one reference are two measurands of one budget: products of the contributions of what they
/// share are their covariance.
#[test]
fn contributions_are_a_factor_of_the_covariance_of_rows() {
    let inputs = "[input.R]\nvalue = 100\nunit = \"ohm\"\ncomponents = [{ name = \"cal\", certificate = { U = 0.4, k = 2 } }, { name = \"drift\", half_width = 0.3 }]\n";
    let device = |name: &str, x: f64, u: f64| {
        format!("[input.{name}]\nvalue = {x:?}\nunit = \"V\"\nu = {u:?}\n")
    };
    let budget = format!(
        "[measurand.I]\nmodel = \"V / R\"\nunit = \"mA\"\n{inputs}{}",
        device("V", 1.0, 0.1)
    );
    let rows = [(1.5, 0.002), (2.25, 0.003), (0.75, 0.001)];
    let lines: String = rows.iter().map(|(x, u)| format!("{x},{u}\n")).collect();
    let (found, _) = run(&budget, &format!("V,V.u\n{lines}"), &plan(None, 1)).expect("a batch");
    let found = cells(&found);
    let factor = |row: usize, component: &str| -> f64 {
        let head = format!("contribution(I, {component}) [mA]");
        cell(&found, &found.1[row], &head)
            .parse()
            .expect("a number")
    };
    let together = rows
        .iter()
        .enumerate()
        .fold(inputs.to_owned(), |text, (at, (x, u))| {
            let measurand = format!("[measurand.I{at}]\nmodel = \"V{at} / R\"\nunit = \"mA\"\n");
            text + &measurand + &device(&format!("V{at}"), *x, *u)
        });
    let budget: Budget = gumption::budget(&together).expect("a budget");
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let joint = propagate::evaluate(&budget, &options)
        .expect("a value")
        .joint
        .expect("three measurands");
    for a in 0..rows.len() {
        for b in 0..rows.len() {
            let shared = ["R.cal", "R.drift"].map(|one| factor(a, one) * factor(b, one));
            let own = if a == b { factor(a, "V").powi(2) } else { 0.0 };
            let covariance = shared.iter().sum::<f64>() + own;
            assert!(
                (covariance / joint.covariance[(a, b)] - 1.0).abs() < 1e-12,
                "{a}, {b}"
            );
        }
    }
}

/// Tables in memory give the results of files, wherever they are cut: rows that are numbers, rows that the file is read with,
/// faulty ones.
#[test]
fn columns_in_memory_give_what_a_file_gives() {
    let budget = "[measurand.y]\nmodel = \"x / z\"\n[input.x]\nvalue = 1\nu = 0.1\ndof = 7\n[input.z]\nvalue = 2\nhalf_width = 0.1\n";
    let rows = 40_000;
    let number = |at: usize, k: usize| ((at * 7919 + k * 104_729) % 9973) as f64 / 1e3 + 0.5;
    let mut x: Vec<f64> = (0..rows).map(|at| number(at, 0)).collect();
    let mut u: Vec<f64> = (0..rows).map(|at| number(at, 1) / 97.0).collect();
    for at in (100..rows).step_by(997) {
        x[at] = [f64::NAN, f64::INFINITY, 0.0, -0.0][at % 4];
        u[at + 1] = [-1.0, 0.0, 1e-300, f64::NAN][at % 4];
    }
    let widths: Vec<String> = (0..rows)
        .map(|at| format!("{:?}", number(at, 2) / 100.0))
        .collect();
    let labels: Vec<String> = (0..rows).map(|at| format!("No {at}, \"x\"")).collect();
    let written = |x: f64| {
        if x.is_nan() {
            String::new()
        } else {
            format!("{x:?}")
        }
    };
    let mut table = String::from("label,x,x.u,z.half_width\n");
    for at in 0..rows {
        let label = labels[at].replace('"', "\"\"");
        table += &format!(
            "\"{label}\",{},{},{}\n",
            written(x[at]),
            written(u[at]),
            widths[at]
        );
    }
    let (text, count) = run(budget, &table, &plan(None, 2)).expect("a batch");
    let expected = cells(&text);

    let files = [("budget.toml", budget.as_bytes())];
    let file = BatchFile::open(Files::Library(&files), Path::new("budget.toml"), None);
    let file = file.expect("a budget");
    let columns = gumption::csv::Columns::new(vec![
        ("label".into(), Cells::Texts(labels)),
        ("x".into(), Cells::Numbers(x.as_slice().into())),
        ("x.u".into(), Cells::Numbers(u.as_slice().into())),
        ("z.half_width".into(), Cells::Texts(widths)),
    ]);
    let wanted = Columns {
        shares: true,
        contributions: true,
        seeds: false,
        language: Language::English,
    };
    let columns = columns.expect("equal lengths");
    let (found, counted) = in_columns(&file, &columns, &plan(None, 3), wanted);
    assert_eq!(counted, count);
    assert!(count.failed > 30 && count.rows == rows as u64, "{count:?}");
    let heads: Vec<&str> = found.iter().map(|(head, _)| head.as_str()).collect();
    assert_eq!(heads, expected.0);
    for (at, (head, column)) in found.iter().enumerate() {
        for (row, line) in expected.1.iter().enumerate() {
            let cell = match column {
                ResultColumn::Numbers(numbers) => written(numbers[row]),
                ResultColumn::Texts(texts) => texts.as_ref().map_or("", |all| &all[row]).to_owned(),
            };
            assert_eq!(cell, line[at], "{head}, row {row}");
        }
    }
}

#[test]
fn what_no_row_can_mend_is_refused() {
    let budget = "[measurand.y]\nmodel = \"x\"\n[input.x]\nvalue = 1\nu = 0.1\n";
    let refused = |budget: &str, table: &str| {
        let rejection = run(budget, table, &plan(None, 1)).expect_err("refused");
        rejection.render(false)
    };
    assert!(refused(budget, "z\n1\n").contains("no input or constant is called z"));
    assert!(refused(budget, "\"r(x, z)\"\n1\n").contains("no correlation between x and z"));
    assert!(refused(budget, "x [mV/]\n1\n").contains("table.csv:1"));
    assert!(refused(budget, "").contains("empty"));
    // A misspelt key is one in every row.
    let misspelt = refused(budget, "label,x,x.hlf_width\na,1,0.1\nb,2,0.1\n");
    assert!(misspelt.contains("table.csv:1:9"), "{misspelt}");
    assert!(
        misspelt.contains("did you mean `half_width`?"),
        "{misspelt}"
    );
    // What spreadsheets write behind the last column, and the index of a frame.
    for nameless in ["x,\n1,\n", ",x\n0,1\n"] {
        assert!(refused(budget, nameless).contains("a column has no name"));
    }
    let summed = refused(budget, "label,x\n1,1.1\n2,1.3\n3,1.4\nmean,1.26667\n");
    assert!(
        summed.contains("means of those of all rows above"),
        "{summed}"
    );
    assert!(refused(&budget.replace("0.1", "0.1\nhalf = 1"), "x\n1\n").contains("half"));
    let series = format!("{budget}[series]\ncolumns = [\"x\"]\nrows = [[1]]\n");
    assert!(refused(&series, "x\n1\n").contains("a series of its own"));
    // A value that only the table has is no fault.
    let open = budget.replace("value = 1\n", "");
    let (found, count) = run(&open, "x\n1\n\n\"\"\n", &plan(None, 1)).expect("a batch");
    assert_eq!((count.rows, count.failed), (2, 1), "{found}");
}

/// The numbers of a budget that columns can replace: names of columns, and the numbers.
fn numbers(budget: &str) -> Vec<(String, f64)> {
    const KEYS: [&str; 5] = ["value", "u", "half_width", "step", "dof"];
    fn of(table: &toml::Table, name: &str, found: &mut Vec<(String, f64)>) {
        let number =
            |value: &toml::Value| value.as_float().or(value.as_integer().map(|x| x as f64));
        for key in KEYS {
            let column = match key {
                "value" => name.to_owned(),
                _ => format!("{name}.{key}"),
            };
            found.extend(table.get(key).and_then(number).map(|x| (column, x)));
        }
        let certified = table.get("certificate").and_then(toml::Value::as_table);
        let expanded = certified.and_then(|stated| stated.get("U").and_then(number));
        found.extend(expanded.map(|x| (format!("{name}.certificate.U"), x)));
        let listed = table.get("components").and_then(toml::Value::as_array);
        for one in listed
            .into_iter()
            .flatten()
            .filter_map(toml::Value::as_table)
        {
            if let Some(label) = one.get("name").and_then(toml::Value::as_str) {
                of(one, &format!("{name}.{label}"), found);
            }
        }
    }
    let file: toml::Table = budget.parse().expect("TOML");
    let inputs = file.get("input").and_then(toml::Value::as_table);
    let mut found = Vec::new();
    for (name, input) in inputs.into_iter().flatten() {
        if let Some(input) = input.as_table() {
            of(input, name, &mut found);
        }
    }
    found.retain(|(name, x)| *x != 0.0 && !name.contains('"'));
    found
}

/// A table of one row is read with the file; of a longer one, rows are written into the numbers of the first.
#[test]
fn rows_of_a_table_are_as_if_each_were_alone_over_the_library() {
    let (mut tables, mut lines) = (0, 0);
    for (path, bytes) in gumption::verify::LIBRARY {
        let Ok(budget) = std::str::from_utf8(bytes) else {
            continue;
        };
        if !path.ends_with(".toml") || budget.contains("[series]") || budget.contains("[fit.") {
            continue;
        }
        let numbers = numbers(budget);
        let files = Files::Library(gumption::verify::LIBRARY);
        let Ok(file) = BatchFile::open(files, Path::new(path), None) else {
            continue;
        };
        if numbers.is_empty() {
            continue;
        }
        let heads: Vec<String> = numbers
            .iter()
            .map(|(name, _)| format!("\"{name}\""))
            .collect();
        let heads = heads.join(",");
        let row = |k: usize| {
            let cell = |(at, (_, x)): (usize, &(String, f64))| {
                // Short decimals and long ones.
                let x = x * (1.0 + 1e-3 * (k * (at % 3)) as f64);
                match (k + at) % 4 {
                    0 => format!("{x:?}"),
                    _ => format!("{:e}", format!("{x:.6e}").parse::<f64>().expect("a number")),
                }
            };
            numbers
                .iter()
                .enumerate()
                .map(cell)
                .collect::<Vec<_>>()
                .join(",")
        };
        let columns = Columns {
            shares: true,
            contributions: true,
            seeds: false,
            language: Language::English,
        };
        let table = |rows: &[String]| {
            let text = format!("{heads}\n{}\n", rows.join("\n"));
            let mut results = Table::of(columns, &file);
            let mut out = Vec::new();
            batch::run(
                &file,
                (text.as_bytes(), "table.csv"),
                &plan(None, 1),
                |lines, row| columns.add(lines, row),
                |lines, _| {
                    out.extend(results.add(lines));
                    ControlFlow::Continue(())
                },
            )
            .map(|_| String::from_utf8(out).expect("text"))
        };
        let rows: Vec<String> = (0..6).map(row).collect();
        let Ok(together) = table(&rows) else {
            continue;
        };
        tables += 1;
        let body = |text: &str, at: usize| {
            let line = text.lines().nth(at + 1).expect("a line");
            line.split_once(',').expect("a label").1.to_owned()
        };
        for (at, row) in rows.iter().enumerate() {
            let alone = table(std::slice::from_ref(row)).expect("a table");
            assert_eq!(body(&together, at), body(&alone, 0), "{path}, {row}");
            lines += 1;
        }
    }
    assert!(tables > 50 && lines > 300, "{tables} tables, {lines} lines");
}

/// Columns of the user's own go through, whatever is in them, and change no figure; without a word they are refused.
#[test]
fn columns_that_are_kept_go_through() {
    let budget = written(ANY);
    let heads = "label,R [kohm],type,Date [d]";
    let rows = ["a,0.1,\"A, new\",2026-01-02", "b,-,B,", "c,0.2,A,x"];
    let table = format!("{heads}\n{}\n", rows.join("\n"));
    let mut keeping = plan(None, 2);
    keeping.keep = vec!["Date".into(), "type".into()];
    let (found, count) = run(&budget, &table, &keeping).expect("a batch");
    assert_eq!((count.rows, count.failed), (3, 1), "{found}");
    assert!(found.starts_with("label,Date [d],type,I [mA],"), "{found}");
    // So they are where there are no rows.
    let (none, _) = run(&budget, &format!("{heads}\n"), &keeping).expect("a batch");
    assert_eq!(none.lines().next(), found.lines().next());
    let plain = "label,R [kohm]\na,0.1\nb,-\nc,0.2\n";
    let (alone, _) = run(&budget, plain, &plan(None, 1)).expect("a batch");
    let kept = ["2026-01-02,\"A, new\"", ",B", "x,A"];
    let lines = found.lines().skip(1).zip(alone.lines().skip(1));
    for ((found, alone), kept) in lines.zip(kept) {
        let (label, others) = alone.split_once(',').expect("a label");
        assert_eq!(found, format!("{label},{kept},{others}"));
    }
    let files = [("budget.toml", budget.as_bytes())];
    let file = BatchFile::open(Files::Library(&files), Path::new("budget.toml"), None);
    let file = file.expect("a budget");
    let columns = Columns {
        shares: false,
        contributions: false,
        seeds: false,
        language: Language::English,
    };
    let numbers = [0.1, 0.2];
    let types = ["A", "B"].map(String::from).to_vec();
    let columns_of = vec![
        (
            "R [kohm]".to_owned(),
            Cells::Numbers(numbers.as_slice().into()),
        ),
        ("type".to_owned(), Cells::Texts(types.clone())),
    ];
    let in_memory = gumption::csv::Columns::new(columns_of).expect("a table");
    keeping.keep.remove(0);
    let (found, _) = in_columns(&file, &in_memory, &keeping, columns);
    assert_eq!(found[1], ("type".into(), ResultColumn::Texts(Some(types))));
    let empty = ["R [kohm]", "type"].map(|name| (name.to_owned(), Cells::Texts(Vec::new())));
    let empty = gumption::csv::Columns::new(empty.into()).expect("a table");
    let (none, _) = in_columns(&file, &empty, &keeping, columns);
    let heads = |all: &[(String, ResultColumn)]| all.iter().map(|(head, _)| head.clone()).collect();
    let [found, none]: [Vec<String>; 2] = [heads(&found), heads(&none)];
    assert_eq!(found, none);

    let refusal = |keep: &str| {
        let mut plan = plan(None, 1);
        plan.keep.push(keep.into());
        run(&budget, &table, &plan)
            .expect_err("refused")
            .render(false)
    };
    let said = refusal("typ");
    assert!(
        said.contains("no column \"typ\" that could be kept"),
        "{said}"
    );
    assert!(said.contains("did you mean \"type\"?"), "{said}");
    assert!(refusal("type").contains("`--keep Date`"));
}

#[cfg(not(feature = "parquet"))]
#[test]
fn without_parquet_it_is_said_how_to_have_it() {
    let asked: [&[&str]; 2] = [
        &["batch", "budget.toml", "devices.parquet"],
        &[
            "batch",
            "budget.toml",
            "devices.csv",
            "-o",
            "results.parquet",
        ],
    ];
    for arguments in asked {
        for (language, words) in [("en", "built without Parquet"), ("zh", "未包含 Parquet")] {
            let mut program = crate::common::program();
            let program = program.args(arguments).args(["--lang", language]);
            let locale = ["C.UTF-8", "zh_CN.UTF-8"][usize::from(language == "zh")];
            let run = program
                .env("LC_ALL", locale)
                .output()
                .expect("the program runs");
            let said = String::from_utf8_lossy(&run.stderr);
            assert_eq!(run.status.code(), Some(2));
            assert!(
                said.contains(words) && said.contains("--features parquet"),
                "{said}"
            );
        }
    }
}

/// Contributions stand below the components that they are of: a row that leaves out another component than the first one has no
/// column for what it has in its place.
#[test]
fn contributions_stand_below_their_components() {
    let component = |name: &str, u: u8| format!("{{ name = \"{name}\", u = {u} }}");
    let components = [component("p", 1), component("q", 2), component("r", 3)].join(", ");
    let budget = format!("[measurand.y]\nmodel = \"a\"\n[input.a]\ncomponents = [{components}]\n");
    let table = "label,a,a.p.u,a.q.u\nw,10,-1,2\nx,10,,2\ny,10,1,\nz,10,,4\n";
    let (text, count) = run(&budget, table, &plan(None, 1)).expect("a batch");
    assert_eq!((count.rows, count.failed), (4, 2), "{text}");
    let found = cells(&text);
    let figure = |row: usize, head: &str| cell(&found, &found.1[row], head).parse::<f64>();
    for (row, q) in [(1, 2.0), (3, 4.0)] {
        assert_eq!(figure(row, "contribution(y, a.q)"), Ok(q));
        assert_eq!(figure(row, "contribution(y, a.r)"), Ok(3.0));
    }
    let why = cell(&found, &found.1[2], "error");
    assert!(
        why.starts_with("B0404: ") && why.contains("nothing for the column contribution(y, a.q)"),
        "{why}"
    );

    let files = [("budget.toml", budget.as_bytes())];
    let file = BatchFile::open(Files::Library(&files), Path::new("budget.toml"), None);
    let file = file.expect("a budget");
    let wanted = Columns {
        shares: true,
        contributions: true,
        seeds: false,
        language: Language::English,
    };
    let (heads, rows) = cells(table);
    let column = |at: usize| rows.iter().map(|row| row[at].clone()).collect();
    let heads = heads.into_iter().enumerate();
    let columns = heads.map(|(at, head)| (head, Cells::Texts(column(at))));
    let in_memory = gumption::csv::Columns::new(columns.collect()).expect("a table");
    let (columns, counted) = in_columns(&file, &in_memory, &plan(None, 1), wanted);
    assert_eq!(counted, count);
    for (at, (head, column)) in columns.iter().enumerate() {
        let ResultColumn::Numbers(numbers) = column else {
            continue;
        };
        for (row, number) in numbers.iter().enumerate() {
            let written = found.1[row][at].parse().unwrap_or(f64::NAN);
            assert_eq!(number.to_bits(), f64::to_bits(written), "{head}, row {row}");
        }
    }
}

/// A fixed k makes no u of four readings known for certain: ν stands in the table for whoever weighs u or forms another k.
#[test]
fn degrees_of_freedom_are_told_under_every_profile() {
    let table =
        "label,x.readings\na,\"[9.96, 9.93, 9.99, 10.02]\"\nb,\"[10.06, 10.01, 9.97, 9.96]\"\n";
    for profile in ["GUM", "JJF", "JJF-up", "NIST"] {
        let budget = format!(
            "profile = \"{profile}\"\n[measurand.y]\nmodel = \"x\"\n[input.x]\nreadings = [1, 2, 3, 4]\n"
        );
        let (text, count) = run(&budget, table, &plan(None, 1)).expect("a batch");
        assert_eq!((count.rows, count.failed), (2, 0), "{text}");
        let found = cells(&text);
        for row in &found.1 {
            let nu: f64 = cell(&found, row, "nu(y)").parse().expect("a number");
            assert_eq!(nu, 3.0, "{profile}: {text}");
        }
    }
}

/// An effect that is not recognised does not look like any other result.
#[test]
fn a_result_below_its_decision_threshold_is_told() {
    let budget = "[measurand.a]\nmodel = \"(n_g / t_g - n_0 / t_0) * w\"\nunit = \"Bq\"\n[constant]\nt_g = \"600 s\"\nt_0 = \"3600 s\"\n\
                  [input]\nn_g = { count = 350, prior = \"reciprocal\" }\nn_0 = { count = 1620, prior = \"reciprocal\" }\n\
                  w = { value = 4.1, u = 0.3 }\n[detection]\ngross = \"n_g\"\n";
    let table = "label,n_g.count,n_0.count\nseen,350,1620\nnot,280,1620\n";
    let (text, count) = run(budget, table, &plan(None, 1)).expect("a batch");
    assert_eq!((count.rows, count.failed), (2, 0), "{text}");
    let found = cells(&text);
    let [seen, not] = [&found.1[0], &found.1[1]];
    let number = |row: &[String], head: &str| -> f64 {
        let text = cell(&found, row, head);
        text.parse().unwrap_or_else(|_| panic!("{head}: {text}"))
    };
    for (row, verdict, finding) in [(seen, "recognised", false), (not, "not_recognised", true)] {
        assert_eq!(cell(&found, row, "verdict(detection of a)"), verdict);
        let findings = cell(&found, row, "findings");
        let told = findings.split(' ').any(|one| one == "not_recognised");
        assert_eq!(told, finding, "{findings}");
        let is_above = number(row, "a [Bq]") > number(row, "decision_threshold(a) [Bq]");
        assert_eq!(is_above, verdict == "recognised");
        assert!(number(row, "detection_limit(a) [Bq]") > number(row, "decision_threshold(a) [Bq]"));
        assert!(number(row, "best(a) [Bq]") > 0.0 && number(row, "u_best(a) [Bq]") > 0.0);
    }
    // ũ(0) of ISO 11929-1 by hand: as many gross counts as the background lets expect, k of 95 %.
    let of_zero = 4.1 * ((270.0 / 600.0_f64.powi(2)) + 1620.0 / 3600.0_f64.powi(2)).sqrt();
    let threshold = number(not, "decision_threshold(a) [Bq]");
    assert!(
        (threshold - 1.644_854 * of_zero).abs() < 1e-6,
        "{threshold}"
    );
}
