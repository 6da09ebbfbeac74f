//! Budgets whose right answer is known from independent arithmetic: each file of `known` says how its claimed figures
//! were computed, with 60 decimal digits or with whole numbers.

use crate::common;
use gumption::budget;
use gumption::propagate::{FindingKind, MonteCarloChoice, Options, compare_claims, evaluate};

fn options() -> Options {
    Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    }
}

#[test]
fn every_figure_has_its_digits() {
    let files = common::files("tests/library/known", "toml");
    assert!(files.len() >= 30, "{}", files.len());
    for path in files {
        let loaded = budget::load(&path).unwrap_or_else(|r| panic!("{}", r.render(false)));
        let budget = &loaded.rows[0].budget;
        let evaluation = evaluate(budget, &options()).expect("a value");
        for comparison in compare_claims(budget, &evaluation) {
            let what = &comparison.claimed;
            assert!(
                comparison.agrees(),
                "{}: {what:?}, obtained {:?}",
                common::relative(&path),
                comparison.obtained
            );
        }
    }
}

/// A budget of a difference of two decimals with this u, and a tolerance with this upper limit.
fn difference(a: &str, b: &str, u: f64, upper: &str) -> String {
    format!(
        "[measurand.E]\nmodel = \"a - b\"\n[input.a]\nvalue = {a}\nu = {u}\n[input.b]\nvalue = {b}\nu = {u}\n\
         [conformity]\nlower = -1e9\nupper = {upper}\nrule = \"simple\"\n"
    )
}

/// The verdict about a difference is that of the decimals themselves, as whole numbers of the last place.
#[test]
fn verdicts_are_those_of_the_decimals() {
    let mut noise = common::Noise(7);
    for _ in 0..300 {
        let whole = |x: f64| (x * 1e9) as i64;
        let (a, step) = (whole(noise.uniform()), whole(noise.uniform()) % 20_000);
        let b = a - step;
        for limit in [step - 1, step, step + 1] {
            let decimal = |n: i64| {
                let sign = if n < 0 { "-" } else { "" };
                format!("{sign}{}.{:06}", n.abs() / 1_000_000, n.abs() % 1_000_000)
            };
            let text = difference(&decimal(a), &decimal(b), 1e-3, &decimal(limit));
            let loaded = budget::read(&text, "verdict.toml", "".as_ref())
                .unwrap_or_else(|r| panic!("{}", r.render(false)));
            let evaluation = evaluate(&loaded.rows[0].budget, &options()).expect("a value");
            let conforms = format!("{:?}", evaluation.conformity[0].verdict) == "Some(Conforming)";
            assert_eq!(conforms, step <= limit, "{text}");
        }
    }
}

/// Whatever is taken from whatever: the estimate is off by less than the resolution that stands behind it, and the trials
/// of Monte Carlo are left out where doubles are coarser than the tolerance of clause 8.
#[test]
fn statements_are_within_the_resolution() {
    let mut noise = common::Noise(11);
    for exponent in 0..16 {
        let large = 10f64.powi(exponent);
        let small = (noise.uniform() * 1e3).round() / 1e3;
        let text = format!(
            "[measurand.Y]\nmodel = \"(a + {large:e}) - {large:e}\"\n[input.a]\nvalue = {small}\nu = 1e-6\n\
             [monte_carlo]\ntrials = 10000\n"
        );
        let loaded = budget::read(&text, "sum.toml", "".as_ref())
            .unwrap_or_else(|r| panic!("{}", r.render(false)));
        let evaluation = evaluate(&loaded.rows[0].budget, &Options::default()).expect("a value");
        assert_eq!(evaluation.results[0].gum.estimate, small, "{text}");
        let unresolved = |kind: &FindingKind| matches!(kind, FindingKind::TrialsUnresolved { .. });
        let told = evaluation.findings.iter().any(|f| unresolved(&f.kind));
        // u = 1.0e-6: δ = 5e-8, and a double of this size is coarser than that from 10⁹ on.
        assert_eq!(told, evaluation.results[0].monte_carlo.is_none(), "{text}");
        assert!(told || exponent < 9, "{text}");
        assert!(!told || exponent > 7, "{text}");
    }
}

/// What inputs have in common altogether leaves no uncertainty: the rounding of the computer is none, in either method.
#[test]
fn contributions_that_cancel_leave_no_uncertainty() {
    let correlated = "[input]\na = { value = 1, u = 0.1 }\nb = { value = 2, u = 0.3 }\n\
         [[correlation]]\nbetween = [\"a\", \"b\"]\nr = 1\n";
    let shared = "[source.s]\nu = 0.1\n[input]\na = { value = 1.1, source = \"s\", relative = true }\n\
         b = { value = 2.3, source = \"s\", relative = true }\n";
    let rounded = "[input]\na = { value = 1 }\nb = { value = 2 }\n[[joint]]\ninputs = [\"a\", \"b\"]\n\
         covariance = [[1.00e-4, 3.001e-4], [3.001e-4, 9.00e-4]]\n";
    for (model, inputs) in [
        ("3*a - b", correlated),
        ("a/b", shared),
        ("3*a - b", rounded),
    ] {
        let text =
            format!("[measurand.Y]\nmodel = \"{model}\"\n{inputs}[monte_carlo]\ntrials = 10000\n");
        let loaded = budget::read(&text, "none.toml", "".as_ref())
            .unwrap_or_else(|r| panic!("{}", r.render(false)));
        let evaluation = evaluate(&loaded.rows[0].budget, &Options::default()).expect("a value");
        let (result, findings) = (&evaluation.results[0], &evaluation.findings);
        assert_eq!(
            (result.gum.u, result.monte_carlo.is_none()),
            (0.0, true),
            "{text}"
        );
        let told = findings.iter().map(|f| &f.kind).collect::<Vec<_>>();
        assert!(told.contains(&&FindingKind::Cancelled), "{text}{told:?}");
        let reported = result.reported(&loaded.rows[0].budget.conventions);
        assert_eq!(reported.expanded(), None, "{text}");
    }
}

/// One-sided limits by trials: of the square of a standard normal variable, which is a χ² with one degree of freedom.
#[test]
fn one_sided_limits_of_trials_are_quantiles() {
    let text = "[measurand.Y]\nmodel = \"x^2\"\n[input.x]\nvalue = 0\nu = 1\n\
        [claim]\nmethod = \"Monte Carlo\"\nat_most = 3.8415\nat_least = 0.003932\n\
        tolerance = { one_sided = 0.03 }\n";
    let budget = &budget::read(text, "chi.toml", "".as_ref())
        .unwrap_or_else(|r| panic!("{}", r.render(false)))
        .rows[0]
        .budget;
    let evaluation = evaluate(budget, &Options::default()).expect("a value");
    let compared = compare_claims(budget, &evaluation);
    assert_eq!(compared.len(), 2);
    for one in compared {
        let obtained = one.obtained.expect("a limit");
        // The 0.05-quantile is 0.06271² and known to much better than the common tolerance.
        assert!(one.agrees(), "{:?} {obtained}", one.claimed.what);
        assert!(one.claimed.value > 1.0 || (obtained / 0.003932 - 1.0).abs() < 0.05);
    }
}
