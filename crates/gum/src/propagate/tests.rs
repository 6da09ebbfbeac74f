//! Whole evaluations, against published figures and closed forms.

use super::draft::Draft;
use super::*;
use crate::budget::{Budget, CoverageRule, MonteCarloSettings, Trials};
use gumption_core::distribution::{Arcsine, Distribution};

const INF: f64 = f64::INFINITY;

fn run(budget: &Budget, monte_carlo: MonteCarloChoice) -> Evaluation {
    evaluate(
        budget,
        &Options {
            monte_carlo,
            threads: 2,
            ..Options::default()
        },
    )
    .unwrap()
}

fn gum(budget: &Budget) -> Evaluation {
    run(budget, MonteCarloChoice::Off)
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} ± {tolerance}"
    );
}

fn kinds(evaluation: &Evaluation) -> Vec<&FindingKind> {
    evaluation
        .findings
        .iter()
        .map(|finding| &finding.kind)
        .collect()
}

fn shares_sum_to_one(result: &Gum) {
    close(
        result.inputs.iter().map(|line| line.share).sum(),
        1.0,
        1e-12,
    );
    close(
        result.components.iter().map(|line| line.share).sum(),
        1.0,
        1e-12,
    );
}

#[test]
fn gum_h_1_with_nine_inputs() {
    let arcsine = Distribution::Arcsine(Arcsine {
        lower: -0.5,
        upper: 0.5,
    });
    let budget = Draft::new()
        .normal("Ls", 5e7, 25.0, 18.0)
        .normal("d1", 0.0, 5.8, 24.0)
        .normal("d2", 0.0, 3.9, 5.0)
        .normal("d3", 0.0, 6.7, 8.0)
        .rectangle("alphas", 1.15e-5, 2e-6, INF)
        .rectangle("dalpha", 0.0, 1e-6, 50.0)
        .normal("theta1", -0.1, 0.2, INF)
        .input("theta2", 0.0, arcsine, 0.5 / 2f64.sqrt(), INF)
        .rectangle("dtheta", 0.0, 0.05, 2.0)
        .budget(
            0.99,
            &[(
                "l",
                "Ls+d1+d2+d3-(Ls*dalpha*(theta1+theta2)+Ls*alphas*dtheta)",
            )],
        );
    let evaluation = gum(&budget);
    let result = &evaluation.results[0];
    close(result.gum.u, 31.6637674111, 2e-9);
    close(result.gum.freedom.value(), 16.7521475092, 2e-8);
    close(result.gum.inputs[8].contribution.abs(), 16.5988202392, 2e-9);
    assert_eq!(
        result.gum.coverage.basis,
        CoverageBasis::StudentT { dof: 16.0 }
    );
    close(result.gum.coverage.k, 2.92, 0.005);
    shares_sum_to_one(&result.gum);
    // u rises to 34 nm; two of three temperatures and αs have no sensitivity coefficient.
    let second = result.second_order.as_ref().unwrap();
    close(second.u, 34.0, 0.5);
    assert!(second.matters);
    // Every product of two inputs has one whose coefficient vanishes: they add all that is added.
    let (inputs, shift, u_effect) = vanishing(&evaluation);
    assert_eq!(inputs, ["alphas", "theta1", "theta2"]);
    assert!(shift == 0.0);
    let all = (second.u.powi(2) - result.gum.u.powi(2)).sqrt();
    close(u_effect, all, 1e-9);
    assert!(kinds(&evaluation).contains(&&FindingKind::NeedsMonteCarlo));
    assert_eq!(result.reported(&budget.conventions).basis, Basis::Gum);
}

/// A phase that turns by a hundred revolutions within u: first order gives two hundred times what the trials show, so that none of the
/// coefficients is one that vanishes.
#[test]
fn an_expansion_beyond_its_range_has_no_vanishing_coefficient() {
    let budget = Draft::new()
        .normal("a", 1.0, 0.01, INF)
        .normal("x", 0.3, 600.0, INF)
        .budget(0.95, &[("y", "a * (1 + 0.9 * cos(x))")]);
    let found = run(&budget, MonteCarloChoice::AsBudget);
    let vanishes = |kind: &&FindingKind| matches!(kind, FindingKind::VanishingSensitivity { .. });
    assert!(!kinds(&found).into_iter().any(|kind| vanishes(&kind)));
    let result = &found.results[0];
    assert!(result.gum.u > 100.0 * result.monte_carlo.as_ref().unwrap().u.unwrap());
}

/// What is found of inputs without a sensitivity coefficient.
fn vanishing(evaluation: &Evaluation) -> (Vec<&str>, f64, f64) {
    let found = evaluation.findings.iter().find_map(|f| match &f.kind {
        FindingKind::VanishingSensitivity {
            inputs,
            shift,
            u_effect,
        } => Some((
            inputs.iter().map(String::as_str).collect(),
            *shift,
            *u_effect,
        )),
        _ => None,
    });
    found.unwrap_or_else(|| panic!("{:?}", evaluation.findings))
}

#[test]
fn gum_h_2_impedance() {
    let volts = [5.007, 4.994, 5.005, 4.99, 4.999];
    let amperes = [0.019663, 0.019639, 0.01964, 0.019685, 0.019678];
    let phases = [1.0456, 1.0438, 1.0468, 1.0428, 1.0433];
    let rows = [volts, amperes, phases];
    let mean = rows.map(|row| row.iter().sum::<f64>() / 5.0);
    let covariance = |a: usize, b: usize| {
        let products = (0..5).map(|n| (rows[a][n] - mean[a]) * (rows[b][n] - mean[b]));
        products.sum::<f64>() / 20.0
    };
    let u = [0, 1, 2].map(|a| covariance(a, a).sqrt());
    let r: Vec<f64> = (0..9)
        .map(|n| covariance(n / 3, n % 3) / (u[n / 3] * u[n % 3]))
        .collect();
    let budget = Draft::new()
        .normal("V", mean[0], u[0], 4.0)
        .normal("I", mean[1], u[1], 4.0)
        .normal("phi", mean[2], u[2], 4.0)
        .correlate(&[0, 1, 2], &r, Some(4.0))
        .budget(
            0.95,
            &[("R", "V/I*cos(phi)"), ("X", "V/I*sin(phi)"), ("Z", "V/I")],
        );
    let evaluation = gum(&budget);
    let expected = [
        (127.732, 0.071, 0.0005),
        (219.847, 0.295, 0.001),
        (254.260, 0.236, 0.0005),
    ];
    for (result, (y, u, tolerance)) in evaluation.results.iter().zip(expected) {
        close(result.gum.estimate, y, 0.0005);
        close(result.gum.u, u, tolerance);
        match result.gum.freedom {
            Freedom::Ensembles(dof) => close(dof, 4.0, 1e-12),
            ref other => panic!("{other:?}"),
        }
        shares_sum_to_one(&result.gum);
    }
    let joint = evaluation.joint.unwrap();
    close(joint.correlation[(0, 1)], -0.588, 0.0005);
    close(joint.correlation[(0, 2)], -0.485, 0.0005);
    close(joint.correlation[(1, 2)], 0.993, 0.0005);
    close(joint.dof.value(), 4.0, 1e-12);
    // Z² = R² + X².
    assert!(joint.degenerate);
}

#[test]
fn s1_9_4_comparison_loss() {
    let budget = Draft::new()
        .normal("x1", 0.0, 0.005, INF)
        .normal("x2", 0.0, 0.005, INF)
        .budget(0.95, &[("y", "x1^2 + x2^2")]);
    let evaluation = run(&budget, MonteCarloChoice::AsBudget);
    let result = &evaluation.results[0];
    assert_eq!((result.gum.estimate, result.gum.u), (0.0, 0.0));
    let second = result.second_order.as_ref().unwrap();
    close(second.shift, 5e-5, 1e-18);
    close(second.u, 5e-5, 1e-18);
    assert_eq!(
        result.reported(&budget.conventions).basis,
        Basis::MonteCarlo
    );
    let mc = result.monte_carlo.as_ref().unwrap();
    close(mc.estimate.unwrap(), 5e-5, 1e-6);
    let (inputs, shift, u_effect) = vanishing(&evaluation);
    assert_eq!(inputs, ["x1", "x2"]);
    close(shift, 5e-5, 1e-18);
    close(u_effect, 5e-5, 1e-18);
    let kinds = kinds(&evaluation);
    for wanted in [FindingKind::NotValidated, FindingKind::Asymmetric] {
        assert!(kinds.contains(&&wanted), "{wanted:?}");
    }
    assert!(!kinds.contains(&&FindingKind::NeedsMonteCarlo));
}

#[test]
fn s1_9_2_2_is_validated() {
    let budget = (1..=4)
        .fold(Draft::new(), |draft, i| {
            draft.normal(&format!("x{i}"), 0.0, 1.0, INF)
        })
        .budget(0.95, &[("y", "x1 + x2 + x3 + x4")]);
    let evaluation = run(&budget, MonteCarloChoice::AsBudget);
    let result = &evaluation.results[0];
    close(result.gum.coverage.expanded, 3.92, 0.005);
    assert!(result.validation.unwrap()[0].is_validated());
    assert_eq!(result.reported(&budget.conventions).basis, Basis::Gum);
    assert!(result.second_order.is_none());
    assert!(evaluation.findings.is_empty(), "{:?}", evaluation.findings);
    assert_eq!(evaluation.run.unwrap().trials, 200_000);
}

#[test]
fn s1_9_2_4_is_not_validated() {
    let root = 3f64.sqrt();
    let budget = (1..=3)
        .fold(Draft::new(), |draft, i| {
            draft.rectangle(&format!("x{i}"), 0.0, root, INF)
        })
        .rectangle("x4", 0.0, 10.0 * root, INF)
        .budget(0.95, &[("y", "x1 + x2 + x3 + x4")]);
    let evaluation = run(&budget, MonteCarloChoice::AsBudget);
    let result = &evaluation.results[0];
    close(result.gum.coverage.expanded, 19.9, 0.05);
    let validation = result.validation.unwrap()[0];
    close(validation.d_high, 2.9, 0.15);
    assert_eq!(
        result.reported(&budget.conventions).basis,
        Basis::MonteCarlo
    );
    // With k from the output's distribution the same budget is.
    let mut output = budget;
    output.conventions.coverage_factor = CoverageRule::Output;
    let evaluation = run(&output, MonteCarloChoice::AsBudget);
    assert!(evaluation.results[0].validation.unwrap()[0].is_validated());
}

#[test]
fn s2_9_2_two_measurands_with_a_common_input() {
    let budget = (1..=3)
        .fold(Draft::new(), |draft, i| {
            draft.normal(&format!("x{i}"), 0.0, 1.0, INF)
        })
        .budget(0.95, &[("y1", "x1 + x3"), ("y2", "x2 + x3")]);
    let joint = run(&budget, MonteCarloChoice::AsBudget).joint.unwrap();
    close(joint.covariance[(0, 0)], 2.0, 1e-12);
    close(joint.correlation[(0, 1)], 0.5, 1e-12);
    close(joint.k_ellipsoid, 2.45, 0.005);
    close(joint.k_rectangle, 2.21, 0.005);
    assert!(!joint.degenerate);
    close(joint.monte_carlo_correlation.unwrap()[(0, 1)], 0.5, 0.01);
    assert!(joint.regions.is_some());
}

#[test]
fn kessel_lead_with_correlated_ratios() {
    let budget = Draft::new()
        .normal("M204", 203.9730436, 1.3e-6, INF)
        .normal("R1", 0.02564, 0.00012, INF)
        .normal("M206", 205.9744653, 1.3e-6, INF)
        .normal("R2", 0.47846, 0.00072, INF)
        .normal("M207", 206.9758969, 1.3e-6, INF)
        .normal("R3", 0.4109, 0.0011, INF)
        .normal("M208", 207.9766521, 1.3e-6, INF)
        .correlate(
            &[1, 3, 5],
            &[1.0, 0.41, 0.0, 0.41, 1.0, 0.01, 0.0, 0.01, 1.0],
            None,
        )
        .budget(
            0.95,
            &[(
                "M",
                "(M204*R1 + M206*R2 + M207*R3 + M208)/(R1 + R2 + R3 + 1)",
            )],
        );
    let result = &gum(&budget).results[0];
    close(result.gum.estimate, 207.2080729198705, 1e-9);
    close(result.gum.u, 0.00059357979, 5e-11);
    shares_sum_to_one(&result.gum);
}

#[test]
fn a_shared_source_counts_once() {
    // a = A + S, b = B + 2S, y = a − b: u² = u_A² + u_B² + u_S².
    let draft = |models: &[(&str, &str)]| {
        Draft::new()
            .normal("s", 0.0, 0.5, 6.0)
            .normal("a", 1.0, 0.3, INF)
            .normal("b", 2.0, 0.4, INF)
            .share(1, 0, 1.0)
            .share(2, 0, 2.0)
            .budget(0.95, models)
    };
    let budget = draft(&[("y", "a - b + 0*s"), ("z", "2*a - b + 0*s")]);
    let evaluation = gum(&budget);
    let y = &evaluation.results[0].gum;
    close(y.u, (0.09_f64 + 0.16 + 0.25).sqrt(), 1e-14);
    close(y.inputs[1].u, (0.09_f64 + 0.25).sqrt(), 1e-14);
    close(y.components[0].sensitivity, -1.0, 1e-14);
    shares_sum_to_one(y);
    // In 2a − b the source cancels exactly.
    let z = &evaluation.results[1].gum;
    close(z.u, (0.36_f64 + 0.16).sqrt(), 1e-14);
    assert_eq!(z.components[0].contribution, 0.0);
    assert_eq!(z.freedom, Freedom::Infinite);
}

#[test]
fn merging_two_independent_normals_changes_nothing() {
    let split = Draft::new()
        .normal("a", 1.0, 0.3, INF)
        .normal("b", 0.0, 0.4, INF)
        .normal("c", 2.0, 0.7, 9.0)
        .budget(0.95, &[("y", "(a + b)*c")]);
    let merged = Draft::new()
        .normal("a", 1.0, 0.5, INF)
        .normal("c", 2.0, 0.7, 9.0)
        .budget(0.95, &[("y", "a*c")]);
    let (split, merged) = (gum(&split), gum(&merged));
    let (split, merged) = (&split.results[0], &merged.results[0]);
    close(split.gum.u, merged.gum.u, 1e-14);
    close(split.gum.freedom.value(), merged.gum.freedom.value(), 1e-10);
    close(
        split.gum.inputs[0].share + split.gum.inputs[1].share,
        merged.gum.inputs[0].share,
        1e-14,
    );
    close(
        split.second_order.as_ref().unwrap().u,
        merged.second_order.as_ref().unwrap().u,
        1e-14,
    );
}

#[test]
fn the_unit_of_the_measurand_changes_neither_k_nor_shares() {
    let draft = |model: &str| {
        Draft::new()
            .normal("a", 1.0, 0.3, 4.0)
            .normal("b", 2.0, 0.4, 7.0)
            .correlate(&[0, 1], &[1.0, 0.6, 0.6, 1.0], None)
            .normal("c", 3.0, 0.1, 5.0)
            .budget(0.95, &[("y", model)])
    };
    let plain = gum(&draft("a*b + exp(c)"));
    let plain = &plain.results[0];
    for scale in ["1e-27", "1e10"] {
        let scaled = gum(&draft(&format!("{scale} * (a*b + exp(c))")));
        let (scaled, factor) = (&scaled.results[0], scale.parse::<f64>().unwrap());
        close(scaled.gum.coverage.k, plain.gum.coverage.k, 1e-12);
        close(scaled.gum.u / factor / plain.gum.u, 1.0, 1e-13);
        for (a, b) in scaled.gum.inputs.iter().zip(&plain.gum.inputs) {
            close(a.share, b.share, 1e-13);
        }
        let u = |result: &MeasurandResult| result.second_order.as_ref().unwrap().u;
        close(u(scaled) / factor / u(plain), 1.0, 1e-12);
        assert!(
            matches!(&scaled.gum.freedom, Freedom::Refused { members, .. } if members == &["a", "b"])
        );
    }
}

#[test]
fn doubtful_models_are_named() {
    let budget = Draft::new()
        .normal("a", 0.0, 0.1, INF)
        .normal("b", 0.3, 0.1, INF)
        .budget(0.95, &[("y", "abs(a) + 1/b")]);
    let evaluation = gum(&budget);
    let kinds = kinds(&evaluation);
    assert!(
        kinds
            .iter()
            .any(|kind| matches!(kind, FindingKind::Irregular { .. })),
        "{kinds:?}"
    );
    assert!(
        kinds
            .iter()
            .any(|kind| matches!(kind, FindingKind::NearSingular { .. })),
        "{kinds:?}"
    );
    assert_eq!(
        kinds
            .iter()
            .filter(|kind| ***kind == FindingKind::NeedsMonteCarlo)
            .count(),
        1
    );
}

/// cos(π/2) is 6·10⁻¹⁷ and not zero: what it multiplies is no contribution beside which another one is large.
#[test]
fn what_rounding_leaves_of_zero_makes_no_input_large() {
    let told = |phase: f64| {
        let budget = Draft::new()
            .normal("phi", phase, 1.8, INF)
            .normal("g", 0.1, 1e-9, INF)
            .budget(0.95, &[("y", "g * cos(phi)")]);
        let large = |kind: &&FindingKind| matches!(kind, FindingKind::LargeUncertainty { .. });
        kinds(&gum(&budget)).iter().any(large)
    };
    assert!(!told(std::f64::consts::FRAC_PI_2));
    assert!(told(1.0));
}

#[test]
fn no_value_and_no_derivative() {
    let draft = |model: &str| {
        Draft::new()
            .normal("a", 0.0, 0.1, INF)
            .budget(0.95, &[("y", model)])
    };
    let off = Options {
        monte_carlo: MonteCarloChoice::Off,
        threads: 1,
        ..Options::default()
    };
    let error = evaluate(&draft("1/a"), &off).unwrap_err();
    assert_eq!(
        error,
        EvaluationError::NoValue {
            measurand: "y".to_string()
        }
    );
    let error = evaluate(&draft("sqrt(a)"), &off).unwrap_err();
    let expected = EvaluationError::NoDerivative {
        measurand: "y".to_string(),
        input: "a".to_string(),
    };
    assert_eq!(error, expected);
    // Monte Carlo can still say something, of the half of the trials that have a root.
    let evaluation = run(&draft("sqrt(a)"), MonteCarloChoice::AsBudget);
    assert_eq!(
        evaluation.results[0]
            .reported(&draft("a").conventions)
            .basis,
        Basis::MonteCarlo
    );
    assert!(
        kinds(&evaluation)
            .iter()
            .any(|kind| matches!(kind, FindingKind::FailedTrials { .. }))
    );
}

#[test]
fn a_thousand_inputs() {
    let mut draft = Draft::new();
    let mut terms = Vec::new();
    for i in 0..1000 {
        draft = draft.normal(&format!("x{i}"), 1.0, 0.01, 5.0);
        terms.push(format!("x{i}"));
    }
    let budget = draft.budget(0.95, &[("y", &terms.join(" + "))]);
    let evaluation = gum(&budget);
    let result = &evaluation.results[0].gum;
    close(result.u, 0.01 * 1000f64.sqrt(), 1e-12);
    close(result.freedom.value(), 5000.0, 1e-6);
    shares_sum_to_one(result);
}

#[test]
fn three_readings_beside_a_product_of_zeros_do_not_keep_the_first_order() {
    // First order does not see da·dt; three readings leave Monte Carlo without a standard deviation, and
    // the medians agree: nothing of that supports the u of first order.
    let evaluation = |model: &str, input: &str| {
        let text = format!(
            "profile = \"JJF\"\n[measurand.y]\nmodel = \"{model}\"\nunit = \"mm\"\n{input}[input.dt]\nvalue = 0\nunit = \"mm·K\"\nhalf_width = 2\n[input.b]\nunit = \"mm\"\nreadings = [10.0000, 10.0002, 10.0004]\n[conformity]\nupper = 10.002\nrule = \"guarded-acceptance\"\n"
        );
        let loaded = crate::budget::read(&text, "b.toml", std::path::Path::new(""));
        let budget = loaded.unwrap().rows.remove(0).budget;
        let evaluation = run(&budget, MonteCarloChoice::AsBudget);
        let reported = evaluation.results[0].reported(&budget.conventions);
        (evaluation, reported)
    };
    let da = "[input.da]\nvalue = 0\nunit = \"1/K\"\nhalf_width = 0.001\n";
    let (product, reported) = evaluation("da * dt + b", da);
    let result = &product.results[0];
    assert_eq!(reported.reason, Reason::NotValidatedFewReadings);
    // u of the product is 0.001·2/3, that of the readings 0.0002/√3.
    let u = libm::hypot(0.002 / 3.0, 0.0002 / 3f64.sqrt());
    close(reported.u.unwrap(), u, 0.005 * u);
    assert!(u > 2.0 * result.gum.u);
    // The decision takes the U that the statement gives.
    let decided = &product.conformity[0];
    let stated = (reported.estimate, reported.half_width());
    assert_eq!((decided.estimate, decided.expanded), stated);
    let (linear, reported) = evaluation("b + 0.01 '1/K' * dt", "");
    let result = &linear.results[0];
    // The readings are a hundredth of the whole: the intervals agree, though Monte Carlo has no u.
    assert_eq!(result.monte_carlo.as_ref().unwrap().u, None);
    assert_eq!(reported.reason, Reason::Validated);
    assert_eq!(linear.conformity[0].expanded, result.gum.coverage.expanded);
}

/// Whenever it is stopped: at once, among the first draws, among those that find the order statistics, or too late.
#[test]
fn an_evaluation_can_be_stopped() {
    const TRIALS: u64 = 1 << 22;
    let budget = Draft::new()
        .normal("x", 1.0, 1.0, INF)
        .budget(0.95, &[("y", "x^2")]);
    for after in [0, 1, TRIALS / 3, TRIALS - 1, TRIALS + 1, 3 * TRIALS / 2] {
        let options = Options {
            monte_carlo: MonteCarloChoice::With(MonteCarloSettings {
                trials: Trials::Fixed(TRIALS),
                ..budget.monte_carlo.clone()
            }),
            threads: 2,
            ..Options::default()
        };
        let ended = std::sync::atomic::AtomicBool::new(false);
        let found = std::thread::scope(|scope| {
            scope.spawn(|| {
                let over = || ended.load(std::sync::atomic::Ordering::Relaxed);
                while options.progress.trials_drawn() < after && !over() {
                    std::thread::yield_now();
                }
                options.progress.stop();
            });
            let found = evaluate(&budget, &options);
            ended.store(true, std::sync::atomic::Ordering::Relaxed);
            found
        });
        if after < TRIALS {
            assert_eq!(found.err(), Some(EvaluationError::Stopped), "{after}");
        }
        assert!(samples(&budget, 1000, &options).is_empty());
    }
}

#[test]
fn few_readings_are_told_once() {
    let findings = |profile: &str, readings: &str| {
        let text = format!(
            "profile = \"{profile}\"\n[measurand.y]\nmodel = \"b + d\"\n[input.b]\nreadings = {readings}\n[input.d]\nvalue = 0\nhalf_width = 0.0005\n"
        );
        let loaded = crate::budget::read(&text, "b.toml", std::path::Path::new(""));
        let evaluation = run(&loaded.unwrap().rows[0].budget, MonteCarloChoice::AsBudget);
        let kinds = evaluation.findings.into_iter().map(|found| found.kind);
        Vec::from_iter(kinds)
    };
    let told = |found: &[FindingKind]| {
        let [FindingKind::FewReadings { components, dof }] = found else {
            panic!("{found:?}")
        };
        (components[0].dof, *dof)
    };
    let (drawn, dof) = told(&findings("JJF", "[10.001, 10.003, 10.002]"));
    assert_eq!(drawn, 2.0);
    close(dof.unwrap(), 3.125, 1e-9);
    // Where ν_eff is not small there is nothing to tell of it.
    let eight = "[10.001, 10.003, 10.002, 10.001, 10.003, 10.002, 10.002, 10.001]";
    assert_eq!(told(&findings("JJF", eight)), (7.0, None));
}

/// The parameters of a fit have their scatter in common: all of them are told, and their parts are no more than the whole.
#[test]
fn parameters_of_a_fit_are_few_readings_together() {
    let text = "profile = \"JJF\"\n[fit.line]\nmodel = \"y = a + b*x\"\n[fit.line.data]\nx = { values = [0.1, 0.3, 0.5, 0.7, 0.9] }\n\
                y = { values = [0.029, 0.083, 0.133, 0.181, 0.219] }\n[input.y0]\nvalue = 0.0712\nresidual_of = \"line\"\nof = 2\n\
                [measurand.x0]\nmodel = \"(y0 - a)/b\"\n";
    let loaded = crate::budget::read(text, "b.toml", std::path::Path::new(""));
    let evaluation = run(&loaded.unwrap().rows[0].budget, MonteCarloChoice::AsBudget);
    let told = evaluation
        .findings
        .iter()
        .find_map(|found| match &found.kind {
            FindingKind::FewReadings { components, .. } => Some(components),
            _ => None,
        });
    let told = told.expect("few readings");
    assert_eq!(told.len(), 3, "{told:?}");
    close(told.iter().map(|one| one.share).sum(), 1.0, 1e-9);
}

/// What a table of results says of ν is that of u: a k that a profile fixes makes no u of four readings known for certain.
#[test]
fn the_freedom_of_u_does_not_follow_from_what_gives_k() {
    let rules = [
        "_from = \"output\"",
        "_from = \"t\"",
        "_from = \"normal\"",
        " = 2",
    ];
    for rule in rules {
        let text = format!(
            "[conventions]\ncoverage_factor{rule}\n[measurand.y]\nmodel = \"b\"\n[input.b]\nreadings = [1.01, 1.03, 1.02, 1.04]\n"
        );
        let loaded = crate::budget::read(&text, "b.toml", std::path::Path::new(""));
        let budget = &loaded.unwrap().rows[0].budget;
        let reported = gum(budget).results[0].reported(&budget.conventions);
        assert_eq!(reported.figures().dof, Some(3.0), "{rule}");
        // As the rows of a batch have it, which are evaluated together.
        let mut rows_of = RowEvaluation::new(budget).expect("a budget for rows");
        let rows = crate::budget::Rows::of(budget);
        rows_of.evaluate(&rows, 1);
        let block = rows_of.figures(&rows, 0..1);
        let row = block.rows().next().expect("a row");
        assert_eq!(row.figures(0), reported.figures(), "{rule}");
    }
}

/// The background of a decision threshold is no gross reading: the result falls where it rises.
#[test]
fn a_background_is_no_gross_reading() {
    let findings = |gross: &str| {
        let text = format!(
            "[measurand.a]\nmodel = \"n_g/t - n_0/t\"\nunit = \"1/s\"\n[constant]\nt = \"600 s\"\n[input]\n\
             n_g = {{ count = 350, prior = \"reciprocal\" }}\nn_0 = {{ count = 270, prior = \"reciprocal\" }}\n\
             [detection]\ngross = \"{gross}\"\n"
        );
        let loaded = crate::budget::read(&text, "test", "".as_ref());
        let loaded = loaded.unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
        let evaluation = gum(&loaded.rows[0].budget);
        let kinds = kinds(&evaluation).into_iter().cloned();
        let falling = kinds.filter(|kind| matches!(kind, FindingKind::FallingCarrier { .. }));
        falling.collect::<Vec<_>>()
    };
    assert!(findings("n_g").is_empty());
    let input = "n_0".to_string();
    assert_eq!(findings("n_0"), [FindingKind::FallingCarrier { input }]);
}
