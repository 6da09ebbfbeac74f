//! Silent mistakes that other programs for measurement uncertainty were seen to make. Each test is named after
//! the mistake and shows that it is refused here, or that the figures are right.

use std::process::Output;

use crate::common::evaluation::{close, evaluate, gum, only, refusal, sampled};
use gumption::propagate::Freedom;
use serde_json::Value;

/// Runs the program on a text, in a folder of its own.
fn program(name: &str, text: &str, arguments: &[&str]) -> (Output, std::path::PathBuf) {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a writable folder");
    let file = folder.join("budget.toml");
    std::fs::write(&file, text).expect("a writable file");
    let output = crate::common::program()
        .current_dir(&folder)
        .arg("eval")
        .arg("budget.toml")
        .args(arguments)
        .output()
        .expect("the program runs");
    (output, folder)
}

const SQUARE: &str = "
title = 'Square'
[measurand.y]
model = 'x1^2 + x2^2'
[input]
x1 = { value = 1, u = 0.1 }
x2 = { value = 2, u = 0.1 }
";

#[test]
fn a_misspelt_or_unknown_key_is_ignored() {
    let text = "
[measurand.y]
model = 'x'
[input.x]
value = 1
distribution = { normal = { mean = 1, sdt = 0.1 } }
";
    let shown = refusal(text);
    assert!(shown.contains("sdt") && shown.contains("`sd`"), "{shown}");
    let shown =
        refusal("[measurand.y]\nmodel = 'x'\n[input.x]\nvalue = 1\nu = 0.1\nuncertz = 0.2\n");
    assert!(shown.contains("uncertz"), "{shown}");
}

#[test]
fn an_undefined_input_counts_as_exactly_zero() {
    let shown = refusal("[measurand.y]\nmodel = 'x + offset'\n[input.x]\nvalue = 1\nu = 0.1\n");
    assert!(shown.contains("offset"), "{shown}");
}

#[test]
fn the_number_of_trials_on_the_command_line_has_no_effect() {
    let run = |trials: &str| -> Value {
        let (output, _) = program("trials", SQUARE, &["--json", "--trials", trials]);
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let (few, many) = (run("1000"), run("1e6"));
    assert_eq!(few["monte_carlo_run"]["trials"], 1000);
    assert_eq!(many["monte_carlo_run"]["trials"], 1_000_000);
    let u = |report: &Value| report["measurands"][0]["monte_carlo"]["standard_uncertainty"].clone();
    assert!(u(&few).is_number() && u(&few) != u(&many));
    // An option that does not exist is refused.
    let (output, _) = program("trials", SQUARE, &["--samples", "1000"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn welch_satterthwaite_is_applied_to_correlated_inputs() {
    // a + b, r = 0.5, ν = 5 each: the formula would give 22.5, more than both together have.
    let text = "
[measurand.y]
model = 'a + b'
[input]
a = { value = 1, u = 1, dof = 5 }
b = { value = 1, u = 1, dof = 5 }
[[correlation]]
between = ['a', 'b']
r = 0.5
";
    let found = gum(text);
    match only(&found).gum.freedom {
        Freedom::Ensembles(dof) => close(dof, 5.0, 1e-12),
        ref other => panic!("{other:?}"),
    }
    // Different ν have no formula at all.
    let found = gum(&text.replace(
        "b = { value = 1, u = 1, dof = 5 }",
        "b = { value = 1, u = 1, dof = 9 }",
    ));
    assert!(matches!(only(&found).gum.freedom, Freedom::Refused { .. }));
}

#[test]
fn the_report_prints_another_model_than_the_one_evaluated() {
    let (output, _) = program("model", SQUARE, &["--no-mc"]);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let equation = text
        .lines()
        .find(|line| line.trim_start().starts_with("y = "))
        .unwrap_or_else(|| panic!("{text}"));
    let printed = equation.trim().replace(' ', "").replace('²', "^2");
    assert!(printed.contains("x1^2+x2^2"), "{printed}");
    assert!(!printed.contains("-x1") && !printed.contains("2*y") && !printed.contains("2y"));
}

#[test]
fn a_budget_file_can_execute_code() {
    let hostile = "title: !!python/object/apply:os.system ['echo > executed']\n";
    let (output, folder) = program("hostile", hostile, &[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(!folder.join("executed").exists());
    // Nothing in a text is more than text.
    let quoted = format!(
        "title = \"$(echo > executed) {}\"\n{}",
        "{{1+1}}",
        SQUARE.replace("title = 'Square'", "")
    );
    let (output, folder) = program("hostile", &quoted, &["--no-mc"]);
    assert!(output.status.success());
    let shown = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(shown.contains("$(echo > executed) {{1+1}}"), "{shown}");
    assert!(!folder.join("executed").exists());
}

#[test]
fn correlation_is_honoured_by_the_gum_and_ignored_by_monte_carlo() {
    for uncertainty in ["u = 1", "half_width = 1", "u = 1, dof = 6"] {
        let text = format!(
            "
[measurand]
y = {{ model = 'a' }}
z = {{ model = 'b' }}
[input]
a = {{ value = 0, {uncertainty} }}
b = {{ value = 0, {uncertainty} }}
[[correlation]]
between = ['a', 'b']
r = 0.9
"
        );
        let found = evaluate(&text);
        let joint = found.joint.as_ref().expect("two measurands");
        close(joint.correlation[(0, 1)], 0.9, 1e-12);
        let sampled = joint.monte_carlo_correlation.as_ref().expect("moments");
        // The standard error is (1 − r²)/√M = 0.0002 for normal inputs.
        close(sampled[(0, 1)], 0.9, 0.003);
    }
}

#[test]
fn the_lower_limit_of_a_curvilinear_trapezoid_becomes_the_upper() {
    let text = "
[measurand.y]
model = 'x'
[input.x]
limits = [-1, 1]
distribution = 'curvilinear-trapezoid'
d = 0.1
";
    let found = evaluate(text);
    let u = (1.0f64 / 3.0 + 0.01 / 9.0).sqrt();
    close(only(&found).gum.u, u, 1e-12);
    close(sampled(&found).u.expect("moments"), u, 0.002);
    close(sampled(&found).estimate.expect("moments"), 0.0, 0.002);
}

#[test]
fn the_square_of_a_centred_normal_has_half_its_mean_and_a_quarter_of_its_variance() {
    for model in ["x^2", "x * x", "x**2.0"] {
        let text = format!("[measurand.y]\nmodel = '{model}'\n[input.x]\nvalue = 0\nu = 1\n");
        let found = evaluate(&text);
        let second = only(&found).second_order.as_ref().expect("a curved model");
        close(second.shift, 1.0, 1e-12);
        close(second.u, 2f64.sqrt(), 1e-12);
        close(sampled(&found).estimate.expect("moments"), 1.0, 0.006);
        close(sampled(&found).u.expect("moments"), 2f64.sqrt(), 0.012);
    }
}

#[test]
fn limits_mean_one_thing_to_the_gum_and_another_to_monte_carlo() {
    let found = evaluate("[measurand.y]\nmodel = 'x'\n[input.x]\nvalue = 5\nhalf_width = 2\n");
    close(only(&found).gum.u, 2.0 / 3f64.sqrt(), 1e-12);
    close(
        sampled(&found).u.expect("moments"),
        2.0 / 3f64.sqrt(),
        0.003,
    );
    let stated = evaluate(
        "[measurand.y]\nmodel = 'x'\n[input.x]\nvalue = 5\nu = 2\ndistribution = 'uniform'\n",
    );
    close(only(&stated).gum.u, 2.0, 1e-12);
    close(sampled(&stated).u.expect("moments"), 2.0, 0.005);
}

/// Three inputs whose correlation coefficients no three quantities can have together.
fn impossible_correlation() -> String {
    "
[measurand.y]
model = 'a + b + c'
[input]
a = { value = 1, u = 0.1 }
b = { value = 1, u = 0.1 }
c = { value = 1, u = 0.1 }
[[correlation]]
between = ['a', 'b']
r = 0.9
[[correlation]]
between = ['b', 'c']
r = 0.9
[[correlation]]
between = ['a', 'c']
r = -0.9
"
    .to_string()
}

#[test]
fn an_impossible_correlation_is_mended_in_silence_and_changes_u() {
    let shown = refusal(&impossible_correlation());
    assert!(shown.starts_with("error"), "{shown}");
    // A possible one leaves every u as stated.
    let found = gum(&impossible_correlation().replace("-0.9", "0.8"));
    for line in &only(&found).gum.inputs {
        close(line.u, 0.1, 1e-15);
    }
}

#[test]
fn an_impossible_correlation_is_refused_with_a_bare_math_domain_error() {
    let shown = refusal(&impossible_correlation());
    for told in [
        "cannot occur together",
        "r(b, c) = 0.9",
        "r(a, c) = -0.9",
        "help",
    ] {
        assert!(shown.contains(told), "no {told} in\n{shown}");
    }
}

#[test]
fn monte_carlo_runs_two_hundred_trials_unless_told_otherwise() {
    let found = evaluate(SQUARE);
    assert_eq!(found.run.expect("Monte Carlo was run").trials, 1_000_000);
}
