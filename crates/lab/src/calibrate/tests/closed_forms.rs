//! Coefficients and uncertainties that can be written down.

use super::super::{Origin, calibrate, plan};
use super::{campaign, near, planned};
use crate::experiment::Scope;
use nalgebra::DMatrix;

/// A line through readings: `U = K*omega*(1 + e_rate) + b`.
const RATE: &str = r#"
title = "Rate"
equations = ["U = K*omega*(1 + e_rate) + b"]
[parameter]
K = {}
b = {}
[input.e_rate]
u = 1e-4
[recording]
file = "run.csv"
"#;

const RATES: &str = "omega [deg/s],U [mV]\n-100,-199.2\n-50,-99.3\n0,0.9\n50,100.8\n100,201.1\n";

#[test]
fn a_line_has_the_closed_form_and_a_common_error_does_not_average() {
    let campaign = campaign(RATE, RATES);
    let found = calibrate(&campaign).expect("coefficients");
    let [k, b] = found.figures.coefficients.as_slice() else {
        panic!("two coefficients");
    };
    let (x, y) = (
        [-100.0, -50.0, 0.0, 50.0, 100.0_f64],
        [-199.2, -99.3, 0.9, 100.8, 201.1],
    );
    let sxx: f64 = x.iter().map(|x| x * x).sum();
    let slope: f64 = x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / sxx;
    let mean = y.iter().sum::<f64>() / 5.0;
    let rest: f64 = x
        .iter()
        .zip(y)
        .map(|(x, y)| (y - mean - slope * x).powi(2))
        .sum();
    let s2 = rest / 3.0;
    near(k.value, slope, 1e-12);
    near(b.value, mean, 1e-12);
    assert_eq!(k.unit.symbol, "mV·s/deg");
    // ∂K/∂e = −K for an error that all points share.
    let type_a = s2 / sxx;
    let type_b = (slope * 1e-4).powi(2);
    near(k.u, (type_a + type_b).sqrt(), 1e-10);
    near(b.u, (s2 / 5.0).sqrt(), 1e-10);
    near(
        k.dof,
        (type_a + type_b).powi(2) / (type_a.powi(2) / 3.0),
        1e-10,
    );
    near(found.responses[0].s, s2.sqrt(), 1e-10);
    near(found.identifiability.condition, 1.0, 1e-9);
}

#[test]
fn an_error_of_each_point_averages() {
    let each = RATE.replace("u = 1e-4", "u = 1e-4\nscope = \"each\"") + "\n";
    let each = format!("noise.from = \"stated\"\n{each}");
    let campaign = campaign(&each, RATES);
    let found = calibrate(&campaign).expect("coefficients");
    let k = &found.figures.coefficients[0];
    // ∂K/∂e_i = −K x_i²/Sxx, up to terms of the size of the residuals.
    let fourth: f64 = [100.0_f64, 50.0, 0.0, 50.0, 100.0]
        .iter()
        .map(|x| x.powi(4))
        .sum();
    near(k.u, k.value * 1e-4 * fourth.sqrt() / 25_000.0, 1e-3);
}

#[test]
fn an_error_by_level_is_shared_within_the_level() {
    let csv = "omega [deg/s],day,U [mV]\n-100,1,-200\n100,1,200\n-100,2,-200\n100,2,200\n";
    let toml = RATE.replace("u = 1e-4", "u = 1e-4\nby = \"day\"");
    let toml = format!("noise.from = \"stated\"\n{toml}");
    let found = calibrate(&campaign(&toml, csv)).expect("coefficients");
    near(
        found.figures.coefficients[0].u,
        2.0 * 1e-4 / 2.0_f64.sqrt(),
        1e-10,
    );
}

#[test]
fn four_points_of_two_coefficients() {
    let toml = r#"
equations = ["E = R*K1*(K0 + g*sin(theta + theta0))"]
[parameter.K0]
unit = "gn"
[parameter.K1]
unit = "mA/gn"
[constant]
g = "1 gn"
[omitted.K2]
term = "R*K1*K2*(g*sin(theta))^2"
unit = "1/gn"
[omitted.K3]
term = "R*K1*K3*(g*sin(theta))^3"
unit = "1/gn^2"
[input.R]
unit = "ohm"
value = 500
half_width = 0.06
[input.theta0]
unit = "rad"
half_width = 5e-6
[recording]
file = "run.csv"
[reading.E]
half_width = 1.1e-5
unit = "V"
"#;
    let csv = "theta [deg],E [mV]\n0,0.0601\n90,99.9047\n180,-0.1018\n270,-99.9304\n";
    let campaign = campaign(toml, csv);
    let found = calibrate(&campaign).expect("coefficients");
    let k1 = &found.figures.coefficients[1];
    assert_eq!((k1.name.as_str(), k1.unit.symbol.as_str()), ("K1", "mA/gn"));
    near(k1.value, (99.9047 + 99.9304) / 2.0 / 500.0, 1e-6);
    // The voltmeter's error of 11 µV, stated in V for a column in mV.
    let voltmeter = found.figures.causes.iter().find(
        |cause| matches!(&cause.origin, Origin::Stated { name, .. } if name.starts_with("reading.E")),
    );
    let expected = 0.011 / 3.0_f64.sqrt() / 2.0_f64.sqrt() / 500.0;
    near(
        voltmeter.expect("a voltmeter").contribution(1),
        expected,
        1e-3,
    );
    let k0 = &found.figures.coefficients[0];
    let mean = (0.0601 + 99.9047 - 0.1018 - 99.9304) / 4.0;
    near(k0.value, mean / 500.0 / k1.value, 1e-6);
    // The third order hides in the scale factor with the factor 1: sin³ = sin at these angles.
    let k3 = found
        .aliases
        .iter()
        .find(|alias| alias.name == "K3")
        .expect("K3");
    assert_eq!(k3.visible, 0.0);
    near(k3.shifts[1], k1.value, 1e-6);
    // The second order shifts the bias by half its size, and the residuals show the other half.
    let k2 = found
        .aliases
        .iter()
        .find(|alias| alias.name == "K2")
        .expect("K2");
    near(k2.shifts[0], 0.5, 1e-3);
    assert!(k2.visible > 0.5);
}

#[test]
fn the_four_point_tumble() {
    let toml = r#"
procedure = "accelerometer-tumble-4"
noise.from = "stated"
[constant]
g = "1 gn"
[input.R]
value = 500
half_width = 0.06
[input.theta0]
half_width = 5e-6
[recording]
file = "run.csv"
[reading.E]
half_width = 1.1e-5
unit = "V"
"#;
    let csv = "theta [deg],E [mV]\n0,0.0601\n90,99.9047\n180,-0.1018\n270,-99.9304\n";
    let found = calibrate(&campaign(toml, csv)).expect("coefficients");
    let value = |name: &str| {
        let coefficients = &found.figures.coefficients;
        let found = coefficients.iter().find(|c| c.name == name).expect(name);
        found.value
    };
    // Four readings, four coefficients: E0 = R K1 (K0 − δ), E90 = R K1 (K0 + 1 + K2), …
    let [e0, e90, e180, e270] = [0.0601, 99.9047, -0.1018, -99.9304];
    let k1 = (e90 - e270) / 2.0 / 500.0;
    near(value("K1"), k1, 1e-9);
    near(value("K0"), (e0 + e180) / 2.0 / 500.0 / k1, 1e-6);
    near(
        value("K2"),
        (e90 + e270 - e0 - e180) / 2.0 / 500.0 / k1,
        1e-6,
    );
    near(value("delta_o"), (e180 - e0) / 2.0 / 500.0 / k1, 1e-6);
    let shifts = |name: &str| {
        let alias = found.aliases.iter().find(|alias| alias.name == name);
        let alias = alias.expect(name);
        assert_eq!(alias.visible, 0.0, "{name}");
        alias.shifts.clone()
    };
    // The third order hides in the scale factor with the factor 1: sin³ = sin at these angles.
    near(shifts("K3")[1], k1, 1e-6);
    // cos² = 1 − sin²: the pendulous axis shifts the bias and the second order against each other.
    near(shifts("Kpp")[0], 1.0, 1e-9);
    near(shifts("Kpp")[2], -1.0, 1e-9);
}

#[test]
fn a_plan_says_what_hides() {
    let toml = r#"
equations = ["E = K0 + K1*a + K2*a^2 + K3*a^3"]
[parameter]
K0 = {}
K1 = {}
K2 = {}
K3 = {}
[schedule]
a = [0, 1, 0, -1]
"#;
    let plan = plan(&planned(toml)).expect("a plan");
    assert_eq!(plan.identifiability.rank, 3);
    assert!(plan.figures.is_none());
    let [only] = plan.identifiability.undetermined.as_slice() else {
        panic!("one combination: {:?}", plan.identifiability.undetermined);
    };
    let names: Vec<(&str, f64)> = only.changes.iter().map(|c| (c.0.as_str(), c.1)).collect();
    assert_eq!(names[0].0, "K3");
    assert_eq!(names[1].0, "K1");
    near(names[1].1, -1.0, 1e-9);
    assert_eq!(names.len(), 2);
}

#[test]
fn a_plan_predicts_the_uncertainty_of_the_calibration() {
    let toml = RATE
        .replace("K = {}", "K = { start = 2 }")
        .replace("b = {}", "b = { start = 1 }")
        + "[reading.U]\nu = 0.1\n[schedule]\n\"omega [deg/s]\" = [-100, -50, 0, 50, 100]\n";
    let toml = toml.replace("[parameter]", "[columns.U]\nunit = \"mV\"\n[parameter]");
    let plan = plan(&planned(&toml)).expect("a plan");
    let figures = plan.figures.expect("figures");
    let k = &figures.coefficients[0];
    near(k.u, (0.01 / 25_000.0 + 4e-8_f64).sqrt(), 1e-9);
    near(figures.coefficients[1].u, 0.1 / 5.0_f64.sqrt(), 1e-9);
}

#[test]
fn a_plan_takes_the_noise_and_the_units_of_columns() {
    let toml = r#"
equations = ["U = K*omega + b"]
columns = { omega = { unit = "deg/s" }, U = { unit = "V" } }
[parameter]
K = { start = 0.02 }
b = { start = 0 }
[noise]
u = "1 mV"
[schedule]
omega = [-100, -50, 0, 50, 100]
"#;
    let campaign = planned(toml);
    assert!(campaign.experiment.remarks.is_empty());
    let figures = plan(&campaign).expect("a plan").figures.expect("figures");
    let [k, b] = figures.coefficients.as_slice() else {
        panic!("two");
    };
    near(k.u, 1e-3 / 25_000.0_f64.sqrt(), 1e-9);
    assert_eq!(k.unit.symbol, "V·s/deg");
    near(b.u, 1e-3 / 5.0_f64.sqrt(), 1e-9);

    let silent = planned(&toml.replace("[noise]\nu = \"1 mV\"\n", ""));
    assert!(
        silent.experiment.remarks[0]
            .to_string()
            .contains("readings of U")
    );
    assert!(plan(&silent).expect("a plan").figures.is_none());
}

#[test]
fn a_partly_known_parameter_is_between_known_and_unknown() {
    // b is known to be 1 ± 0.2, the readings scatter by 0.1.
    let toml = "noise.from = \"stated\"\nweights = \"readings\"\n".to_owned()
        + RATE
        + "[input.b]\nvalue = 1\nunit = \"mV\"\nu = 0.2\n[reading.U]\nu = 0.1\n";
    let (own, prior) = (5.0 / 0.01, 1.0 / 0.04);
    let mean = (-199.2 - 99.3 + 0.9 + 100.8 + 201.1) / 5.0;
    // Readings of one u have equal weights, which is what holds where nothing is said of weights.
    for toml in [&toml, &toml.replace("weights = \"readings\"\n", "")] {
        let found = calibrate(&campaign(toml, RATES)).expect("coefficients");
        let b = &found.figures.coefficients[1];
        near(b.value, (own * mean + prior) / (own + prior), 1e-9);
        near(b.u, (1.0_f64 / (own + prior)).sqrt(), 1e-9);
    }
}

#[test]
fn results_are_functions_of_parameters() {
    let toml = RATE.to_owned() + "[result.offset]\nmodel = \"b/K\"\nunit = \"deg/s\"\n";
    let found = calibrate(&campaign(&toml, RATES)).expect("coefficients");
    let [k, b, offset] = found.figures.coefficients.as_slice() else {
        panic!("three");
    };
    near(offset.value, b.value / k.value, 1e-12);
    let slopes = [-offset.value / k.value, 1.0 / k.value];
    let v = &found.figures.covariance;
    let variance = slopes[0].powi(2) * v[(0, 0)]
        + slopes[1].powi(2) * v[(1, 1)]
        + 2.0 * slopes[0] * slopes[1] * v[(0, 1)];
    near(offset.u, variance.sqrt(), 1e-9);
}

#[test]
fn the_norm_of_readings_is_a_known_constant() {
    // |K (U − b)| = g for readings in all directions.
    let (k, b) = (0.0025, [12.0, -7.0, 3.0]);
    let directions = [
        (0.1, 0.2),
        (0.8, 1.0),
        (1.5, 2.1),
        (2.2, 3.0),
        (2.9, 4.2),
        (0.5, 5.1),
        (1.2, 0.4),
        (1.9, 5.9),
    ]
    .map(|(theta, phi): (f64, f64)| {
        [
            theta.sin() * phi.cos(),
            theta.sin() * phi.sin(),
            theta.cos(),
        ]
    });
    let mut csv = String::from("x,y,z\n");
    for n in directions {
        let u: Vec<String> = (0..3)
            .map(|i| (b[i] + 9.8 * n[i] / k).to_string())
            .collect();
        csv += &(u.join(",") + "\n");
    }
    let toml = r#"
equations = ["g = K*sqrt((x - bx)^2 + (y - by)^2 + (z - bz)^2)"]
[constant]
g = "9.8 m/s^2"
[parameter.K]
unit = "m/s^2"
start = 0.0024
[parameter]
bx = { start = 0 }
by = { start = 0 }
bz = { start = 0 }
[reading]
x = { u = 0.1 }
y = { u = 0.1 }
z = { u = 0.1 }
[recording]
file = "run.csv"
"#;
    let found = calibrate(&campaign(toml, &csv)).expect("coefficients");
    let c = &found.figures.coefficients;
    near(c[0].value, k, 1e-9);
    near(c[1].value, b[0], 1e-7);
    near(c[2].value, b[1], 1e-7);
    near(c[3].value, b[2], 1e-6);
    // Along n the equation is ρ = g/K = n·(r − b): rows [1 n] determine (ρ, b), each with u = 0.1, and u(K) = K²/g·u(ρ).
    let rows = DMatrix::from_fn(directions.len(), 4, |row, column| match column {
        0 => 1.0,
        axis => directions[row][axis - 1],
    });
    let inverse = rows.tr_mul(&rows).try_inverse().expect("full rank");
    let u = |place: usize| 0.1 * inverse[(place, place)].sqrt();
    near(c[0].u, k * k / 9.8 * u(0), 1e-6);
    for (axis, found) in c.iter().enumerate().skip(1) {
        near(found.u, u(axis), 1e-6);
    }
}

/// Budgets of one coefficient, of the other and of both are evaluated to what the calibration found.
fn written_budgets_agree(toml: &str, csv: &str) {
    use gumption_gum::propagate::{Options, evaluate};
    let campaign = campaign(toml, csv);
    let found = calibrate(&campaign).expect("coefficients");
    for places in [vec![0], vec![1], vec![0, 1]] {
        let text = super::super::budget(
            &campaign,
            &found,
            &places,
            gumption_fault::language::Language::English,
        );
        let loaded = gumption_gum::budget::read(&text, "budget.toml", "".as_ref())
            .unwrap_or_else(|rejection| panic!("{}\n{text}", rejection.render(false)));
        let budget = &loaded.rows[0].budget;
        let evaluation = evaluate(budget, &Options::default()).expect("a result");
        assert_eq!(evaluation.results.len(), places.len());
        for (result, place) in evaluation.results.iter().zip(&places) {
            let one = &found.figures.coefficients[*place];
            near(result.gum.estimate, one.value, 1e-12);
            near(result.gum.u, one.u, 1e-9);
            near(result.gum.freedom.value(), one.dof, 1e-9);
            let expanded = one.k * one.u;
            near(result.gum.coverage.expanded, expanded, 1e-9);
            // Trials of t distributions say as much or more.
            let reported = result.reported(&budget.conventions);
            assert!(reported.expanded().expect("U") > 0.98 * expanded);
        }
        assert_eq!(evaluation.joint.is_some(), places.len() > 1);
        if let Some(joint) = &evaluation.joint {
            let v = &found.figures.covariance;
            let r = v[(0, 1)] / (v[(0, 0)] * v[(1, 1)]).sqrt();
            assert!((joint.correlation[(0, 1)] - r).abs() < 1e-9);
        }
    }
}

#[test]
fn written_budgets_give_the_same_uncertainties() {
    let toml = RATE.to_owned()
        + "[reading.U]\nhalf_width = 0.1\n[input.e_scale]\nu = 3e-4\ndof = 7\nscope = \"each\"\n";
    written_budgets_agree(
        &toml.replace("(1 + e_rate)", "(1 + e_rate + e_scale)"),
        RATES,
    );
}

/// Dwells of different lengths: each average has degrees of freedom of its own, and each coefficient those that follow.
#[test]
fn written_budgets_keep_the_freedom_of_dwells() {
    let toml = "equations = \"U = K*x + b\"\nnoise.from = \"dwells\"\n[parameter]\nK = {}\nb = {}\n[recording]\nfile = \"run.csv\"\nsteps = \"x\"\n";
    let mut csv = String::from("x,U\n");
    for (x, count) in [(0, 6), (1, 9), (2, 6), (3, 14)] {
        for i in 0..count {
            csv += &format!(
                "{x},{}\n",
                2.0 * f64::from(x) + 0.01 * f64::from(i * i * 7 % 11)
            );
        }
    }
    written_budgets_agree(toml, &csv);
}

/// Two inputs with one shared source, of sensitivities 1 and 2, are one error that acts with both.
#[test]
fn a_shared_source_is_one_error() {
    let shared = RATE.replace("b\"]", "b*(1 + e_off)\"]").replace(
        "u = 1e-4\n",
        "source = \"dvm\"\n[input.e_off]\nsource = \"dvm\"\nsensitivity = 2\n[source.dvm]\nu = 1e-4\n",
    );
    let one = RATE.replace("b\"]", "b*(1 + 2*e_rate)\"]");
    let figures = |toml: &str| {
        calibrate(&campaign(toml, RATES))
            .expect("coefficients")
            .figures
    };
    let (shared, one) = (figures(&shared), figures(&one));
    for (a, b) in shared.covariance.iter().zip(one.covariance.iter()) {
        near(*a, *b, 1e-12);
    }
    let dvm = Origin::Stated {
        name: "dvm".to_owned(),
        scope: Scope::Common,
    };
    assert!(shared.causes.iter().any(|cause| cause.origin == dvm));
}

/// Readings of two responses whose errors correlate in every point: cov(K, L) = r·u(U)·u(V)/Σω².
#[test]
fn correlated_readings_correlate_the_coefficients() {
    let toml = r#"
equations = ["U = K*omega + b", "V = L*omega + c"]
noise.from = "stated"
[parameter]
K = {}
b = {}
L = {}
c = {}
[reading.U]
u = 0.02
[reading.V]
half_width = 0.03
[[correlation]]
between = ["U", "V"]
r = 0.6
[recording]
file = "run.csv"
"#;
    let csv = "omega [deg/s],U [mV],V [mV]\n-2,1,2\n-1,1,2\n0,1,2\n1,1,2\n2,1,2\n";
    let found = calibrate(&campaign(toml, csv))
        .expect("coefficients")
        .figures;
    let (u, v) = (0.02, 0.03 / 3.0_f64.sqrt());
    near(found.covariance[(0, 0)], u * u / 10.0, 1e-12);
    near(found.covariance[(2, 2)], v * v / 10.0, 1e-12);
    near(found.covariance[(0, 2)], 0.6 * u * v / 10.0, 1e-12);
    near(found.covariance[(1, 3)], 0.6 * u * v / 5.0, 1e-12);
    assert_eq!(found.causes.len(), 1);
}

/// One error common to all rates and one that differs from day to day, correlated by −1 or +1.
#[test]
fn correlated_inputs_add_or_cancel() {
    let toml = |r: f64| {
        RATE.replace("(1 + e_rate)", "(1 + e_rate + e_more)").replace(
            "u = 1e-4\n",
            &format!("u = 1e-4\n[input.e_more]\nu = 3e-4\n[[correlation]]\nbetween = [\"e_rate\", \"e_more\"]\nr = {r}\n"),
        )
    };
    let of_errors = |r: f64| {
        let found = calibrate(&campaign(&toml(r), RATES)).expect("coefficients");
        let stated = found
            .figures
            .causes
            .iter()
            .find(|cause| matches!(cause.origin, Origin::Stated { .. }));
        stated.expect("a cause").contribution(0) / found.figures.coefficients[0].value
    };
    near(of_errors(1.0), 4e-4, 1e-9);
    near(of_errors(-0.999_999_999), 2e-4, 1e-6);
    near(of_errors(0.5), (1e-8_f64 + 9e-8 + 3e-8).sqrt(), 1e-12);
}

#[test]
fn a_curve_has_the_certified_uncertainties() {
    // NIST Statistical Reference Datasets, BoxBOD: residuals of a tenth of the readings, of which the curvature would make
    // a fifth more of u(b1).
    let campaign = campaign(
        r#"
title = "BoxBOD"
equations = ["y = b1*(1 - exp(-b2*x))"]
[parameter]
b1 = { start = 1 }
b2 = { start = 1 }
[recording]
file = "run.csv"
average = "none"
"#,
        "x,y\n1,109\n2,149\n3,149\n5,191\n7,213\n10,224\n",
    );
    let found = calibrate(&campaign).expect("coefficients");
    let certified = [(213.80940889, 12.354515176), (0.54723748542, 0.10455993237)];
    for (coefficient, (value, u)) in found.figures.coefficients.iter().zip(certified) {
        near(coefficient.value, value, 1e-9);
        near(coefficient.u, u, 1e-9);
    }
    near(found.responses[0].s, 17.088072423, 1e-9);
    near(found.responses[0].dof, 4.0, 1e-9);
}

#[test]
fn rows_have_uncertainties_of_their_own() {
    // ISO/TS 28037, clause 6, second example.
    let found = |column: &str, factor: f64| {
        let rows = [
            (3.2, 0.5),
            (4.3, 0.5),
            (7.6, 0.5),
            (8.6, 1.0),
            (11.7, 1.0),
            (12.8, 1.0),
        ];
        let rows = rows.iter().zip(1..);
        let rows: String = rows
            .map(|((y, u), x)| format!("{x},{y},{}\n", u * factor))
            .collect();
        let campaign = campaign(
            r#"
title = "Weighted line"
equations = ["y = a + b*x"]
weights = "readings"
[parameter]
a = {}
b = {}
[columns]
u_y = "u"
[recording]
file = "run.csv"
average = "none"
"#,
            &format!("x,y [V],{column}\n{rows}"),
        );
        let found = calibrate(&campaign).expect("coefficients");
        let figures = found.figures.coefficients.iter();
        figures.map(|one| (one.value, one.u)).collect::<Vec<_>>()
    };
    // Sums of the weighted line: Σw = 15, x̄ = 2.6, Σw(x − x̄)² = 31.6.
    let u_b = 31.6_f64.powf(-0.5);
    for found in [found("u_y", 1.0), found("u_y [mV]", 1000.0)] {
        let [(a, u_a), (b, u)] = found[..] else {
            panic!("two coefficients");
        };
        near(u, u_b, 1e-9);
        near(u_a, (1.0 / 15.0 + 2.6 * 2.6 / 31.6_f64).sqrt(), 1e-9);
        assert!(
            (a - 0.885).abs() < 5e-4 && (b - 2.057).abs() < 5e-4,
            "{a} {b}"
        );
    }
}

/// A dwell of which one sample is left has no average; the samples of the others tell the scatter all the same.
#[test]
fn a_missing_average_leaves_the_scatter_of_the_others() {
    let toml = r#"
equations = ["U = K*n + b"]
noise.from = "dwells"
[parameter]
K = {}
b = {}
[positions]
column = "position"
gives = ["n"]
at = { "up" = [1], "down" = [-1] }
[recording]
file = "run.csv"
dwells = ["position"]
[columns]
time = "time"
"#;
    let readings = "up,1.1 up,1.3 down,-1.0 down,-1.2 up, up,1.5 down,-1.3 down,-1.1";
    let rows = readings.split(' ').enumerate();
    let rows: String = rows.map(|(at, row)| format!("{at},{row}\n")).collect();
    let campaign = campaign(toml, &format!("time [s],position,U [mV]\n{rows}"));
    let found = calibrate(&campaign).expect("coefficients");
    let k = &found.figures.coefficients[0];
    // Half the difference of one mean and of the mean of two, each of two samples with u = 0.1.
    near(k.value, (1.2 + 1.15) / 2.0, 1e-9);
    near(k.u, 0.05 * (1.0 + 0.5_f64).sqrt(), 1e-9);
}
