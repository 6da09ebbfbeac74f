//! What must not matter: units, threads; and what a seed and a tolerance promise.

use std::path::Path;

use crate::common::evaluation::{close, close_ends, evaluate, only, sampled};
use gumption::budget::Adaptive;

/// The same bar, with lengths in one unit or the other.
fn bar(unit: &str, factor: f64) -> String {
    format!(
        "
[measurand.l]
model = \"l_s * (1 + alpha * (t - 20 '°C')) + d^2 / l_s\"
unit = '{unit}'
[input.l_s]
value = {}
unit = '{unit}'
components = [
  {{ name = 'certificate', certificate = {{ U = {}, k = 2 }} }},
  {{ name = 'drift', half_width = {} }},
]
[input.alpha]
value = 11.5
unit = 'µm/m/K'
half_width = 1
[input.t]
value = 22
unit = '°C'
u = 0.4
dof = 9
[input.d]
value = {}
unit = '{unit}'
u = {}
",
        50.0 * factor,
        0.0002 * factor,
        0.0001 * factor,
        0.2 * factor,
        0.1 * factor,
    )
}

#[test]
fn units_do_not_matter() {
    let (mm, um) = (evaluate(&bar("mm", 1.0)), evaluate(&bar("µm", 1000.0)));
    let (a, b) = (only(&mm), only(&um));
    close(1000.0 * a.gum.estimate / b.gum.estimate, 1.0, 1e-14);
    close(1000.0 * a.gum.u / b.gum.u, 1.0, 1e-12);
    close(a.gum.coverage.k, b.gum.coverage.k, 1e-12);
    close(a.gum.freedom.value() / b.gum.freedom.value(), 1.0, 1e-12);
    for (a, b) in a.gum.components.iter().zip(&b.gum.components) {
        close(a.share, b.share, 1e-12);
    }
    let second =
        |r: &gumption::propagate::MeasurandResult| r.second_order.clone().expect("a curved model");
    close(1000.0 * second(a).shift / second(b).shift, 1.0, 1e-9);
    close(1000.0 * second(a).u / second(b).u, 1.0, 1e-12);
    let (a, b) = (sampled(&mm), sampled(&um));
    close(
        1000.0 * a.u.expect("moments") / b.u.expect("moments"),
        1.0,
        1e-9,
    );
    close_ends(
        a.symmetric.map(|end| 1000.0 * end / 5e4),
        b.symmetric.map(|end| end / 5e4),
        1e-13,
    );
}

#[test]
fn an_input_may_be_in_another_unit_than_the_result() {
    let found = evaluate(
        "[measurand.l]\nmodel = 'a + b'\nunit = 'mm'\n[input]\na = { value = 1, unit = 'in', u = '2 µm' }\nb = { value = 300, unit = 'µm', u = 1 }\n",
    );
    close(only(&found).gum.estimate, 25.7, 1e-12);
    close(only(&found).gum.u, 5f64.sqrt() / 1000.0, 1e-15);
    close(only(&found).gum.inputs[0].sensitivity, 25.4, 1e-12);
}

#[test]
fn threads_do_not_matter() {
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("budgets/length/gauge-block-gum-s1-9-5.toml");
    let run = |threads: &str, seed: &str| {
        let output = crate::common::program()
            .args([
                "eval",
                "--json",
                "--threads",
                threads,
                "--seed",
                seed,
                "--trials",
                "300_001",
            ])
            .arg(&file)
            .output()
            .expect("the program runs");
        assert!(output.status.success());
        output.stdout
    };
    let one = run("1", "5");
    for threads in ["2", "3", "8"] {
        assert!(run(threads, "5") == one, "{threads} threads");
    }
    assert!(run("1", "6") != one, "another seed");
}

#[test]
fn an_adaptive_run_is_right_within_its_tolerance() {
    // Four rectangles of JCGM 101 9.2.3, whose results are known exactly; δ = 0.05 for u = 2.0, 0.005 for a
    // third digit is not offered.
    let end = 2.0 * 3f64.sqrt() * (2.0 - 0.6f64.powf(0.25));
    for (word, procedure) in [("stein", Adaptive::Stein), ("jcgm101", Adaptive::Jcgm101)] {
        for (digits, delta) in [(1, 0.5), (2, 0.05)] {
            let text = format!(
                "[monte_carlo]\ntrials = 'adaptive'\nprocedure = '{word}'\ndigits = {digits}\n[measurand.y]\nmodel = 'sum(x)'\n[input.x]\nvalues = [0, 0, 0, 0]\nhalf_width = 1.7320508075688772\n"
            );
            let found = evaluate(&text);
            let run = found.run.as_ref().expect("Monte Carlo was run");
            let adaptive = run.adaptive.as_ref().expect("an adaptive run");
            assert!(adaptive.reached && adaptive.procedure == procedure);
            assert_eq!(adaptive.delta, [delta]);
            let mc = sampled(&found);
            close(mc.estimate.expect("moments"), 0.0, delta);
            close(mc.u.expect("moments"), 2.0, delta);
            close_ends(mc.symmetric, [-end, end], delta);
        }
    }
}

#[test]
fn an_adaptive_run_that_may_not_go_on_says_so() {
    // 1 of 10⁴ trials in the tail makes the limits of a cubed normal scatter far more than δ allows.
    let found = evaluate(
        "[monte_carlo]\ntrials = 'adaptive'\nmax_trials = 50_000\n[measurand.y]\nmodel = 'x^3'\n[input.x]\nvalue = 0\nu = 1\n",
    );
    let run = found.run.as_ref().expect("Monte Carlo was run");
    assert!(!run.adaptive.as_ref().expect("an adaptive run").reached);
    assert!(found.findings.iter().any(|f| matches!(
        f.kind,
        gumption::propagate::FindingKind::NotConverged { .. }
    )));
}
