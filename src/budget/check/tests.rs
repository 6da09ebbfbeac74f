//! Checks of whole small files; published numbers where there are any.

mod type_a;

use std::path::Path;

use crate::budget::{Budget, Figure, Law, Rejection, TScale, read};
use crate::distribution::Distribution;

fn refused(text: &str) -> Rejection {
    read(text, "budget.toml", Path::new("")).expect_err("the file has a fault")
}

/// Codes of the faults, each with the text that it points at.
fn faults(text: &str) -> Vec<(&'static str, String)> {
    let rejection = refused(text);
    let shown =
        |fault: &crate::fault::Fault| text.get(fault.span.clone()).unwrap_or_default().to_string();
    rejection
        .faults
        .iter()
        .map(|fault| (fault.code.id, shown(fault)))
        .collect()
}

fn budget(text: &str) -> Budget {
    match read(text, "budget.toml", Path::new("")) {
        Ok(mut loaded) => loaded.rows.remove(0).budget,
        Err(rejection) => panic!("{rejection}"),
    }
}

/// A budget of one input with these keys.
fn one(keys: &str) -> String {
    format!("[measurand.Y]\nmodel = \"X\"\nunit = \"V\"\n[input.X]\nunit = \"V\"\n{keys}\n")
}

/// u, ν and the distribution of the only component.
fn component(keys: &str) -> (f64, f64, Distribution) {
    let component = budget(&one(keys)).components.remove(0);
    (component.u, component.dof, component.distribution)
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} is not {b}");
}

#[test]
fn the_template_loads() {
    let budget = budget(&crate::budget::template());
    assert_eq!(budget.inputs.len(), 4);
    assert_eq!(budget.components.len(), 6);
    // 50 ppm of 10.0021 mA, rectangular.
    close(budget.components[3].u, 10.0021 * 50e-6 / 3f64.sqrt());
}

#[test]
fn type_a_of_a_mean_a_single_reading_and_several() {
    // s² = 2.5 for 1 … 5.
    let (u, dof, distribution) = component("readings = [1, 2, 3, 4, 5]");
    close(u, 0.5f64.sqrt());
    assert_eq!(dof, 4.0);
    assert_eq!(
        distribution,
        Distribution::StudentT {
            location: 0.0,
            scale: u,
            dof: 4.0
        }
    );
    assert_eq!(
        budget(&one("readings = [1, 2, 3, 4, 5]")).inputs[0].estimate,
        3.0
    );
    close(
        component("value = 2.5\nreadings = [1, 2, 3, 4, 5]\nof = \"single\"").0,
        2.5f64.sqrt(),
    );
    close(
        component("value = 2.5\nreadings = [1, 2, 3, 4, 5]\nof = 2").0,
        1.25f64.sqrt(),
    );
    let single = budget(&one("readings = [1, 2, 6]\nof = \"single\""));
    assert_eq!(
        (single.inputs[0].estimate, single.components[0].u),
        (3.0, 7f64.sqrt())
    );
}

#[test]
fn pooled_standard_deviation() {
    let (u, dof, _) = component("readings = [1, 3]\npooled = { s = 0.2, dof = 20 }");
    close(u, 0.2 / 2f64.sqrt());
    assert_eq!(dof, 20.0);
    close(
        component("value = 1\npooled = { s = \"200 mV\", dof = 20 }\nof = \"single\"").0,
        0.2,
    );
    assert_eq!(
        faults(&one("value = 1\npooled = { s = 0.2, dof = 20 }"))[0].0,
        "B0207"
    );
}

#[test]
fn limits_of_every_shape() {
    let u = |shape: &str| {
        component(&format!(
            "value = 1\nhalf_width = 0.6\ndistribution = {shape}"
        ))
        .0
    };
    close(u("\"uniform\""), 0.6 / 3f64.sqrt());
    close(u("\"triangular\""), 0.6 / 6f64.sqrt());
    close(u("\"arcsine\""), 0.6 / 2f64.sqrt());
    close(
        u("\"trapezoidal\"\nbeta = 0.5"),
        0.6 * (1.25f64 / 6.0).sqrt(),
    );
    close(
        u("\"curvilinear-trapezoid\"\nd = 0.3"),
        (0.12f64 + 0.01).sqrt(),
    );
    // GUM 4.3.4: half-width at 95 % of a normal distribution.
    assert!((u("\"normal\"\np = 0.95") - 0.6 / 1.959963984540054).abs() < 1e-12);
}

#[test]
fn a_stated_u_keeps_its_value_for_every_shape() {
    for shape in ["uniform", "triangular", "arcsine", "normal"] {
        let (u, _, distribution) =
            component(&format!("value = 1\nu = 0.3\ndistribution = \"{shape}\""));
        assert_eq!(u, 0.3);
        close(distribution.standard_deviation().unwrap(), 0.3);
    }
}

#[test]
fn certificates_with_k_or_p() {
    close(
        component("value = 1\ncertificate = { U = 0.4, k = 2 }").0,
        0.2,
    );
    // GUM table G.2: t_0.95(10) = 2.23.
    let (u, dof, _) = component("value = 1\ncertificate = { U = 2.228, p = 0.95, dof = 10 }");
    assert!((u - 1.0).abs() < 1e-4 && dof == 10.0);
    close(
        component("value = 1\ncertificate = { U = 0.4, k = 2, p = 0.95 }").0,
        0.2,
    );
    assert_eq!(
        faults(&one("value = 1\ncertificate = { U = 0.4 }")),
        [("B0205", "0.4".into())]
    );
    assert_eq!(
        faults(&one(
            "value = 1\ncertificate = { U = 0.4, k = 3, p = 0.95 }"
        ))[0]
            .0,
        "B0206"
    );
    assert_eq!(
        faults(&one("value = 1\ncertificate = { U = 0.4, p = 95 }"))[0].0,
        "B0204"
    );
}

#[test]
fn specification_resolution_and_bits() {
    let text = "value = -5\nspecification = { reading = \"0.002 %\", range = \"6 ppm\", span = 10, counts = 3, step = 1e-5 }";
    close(
        component(text).0,
        (5.0 * 2e-5 + 10.0 * 6e-6 + 3e-5) / 3f64.sqrt(),
    );
    close(
        component("value = 1\nstep = \"10 mV\"").0,
        0.005 / 3f64.sqrt(),
    );
    close(
        component("value = 1\nbits = 3\nrange = [-4, 4]").0,
        0.5 / 3f64.sqrt(),
    );
}

#[test]
fn asymmetric_limits_move_the_estimate() {
    let budget = budget(&one("value = 10\nplus = 0.4\nminus = 0.2"));
    close(budget.inputs[0].estimate, 10.1);
    close(budget.components[0].u, 0.3 / 3f64.sqrt());
    assert_eq!(budget.remarks.len(), 1);
    assert_eq!(faults(&one("value = 10\nlimits = [1, 2]"))[0].0, "B0211");
}

#[test]
fn counts_and_proportions() {
    let dimensionless = |keys: &str| {
        let text = format!("[measurand.Y]\nmodel = \"X\"\n[input.X]\n{keys}\n");
        let budget = budget(&text);
        (budget.inputs[0].estimate, budget.components[0].u)
    };
    assert_eq!(dimensionless("count = 8"), (9.0, 3.0));
    assert_eq!(
        dimensionless("count = 16\nprior = \"reciprocal\""),
        (16.0, 4.0)
    );
    // Beta(2, 4): mean 1/3, variance 8/252.
    let (mean, u) = dimensionless("successes = 1\ntrials = 4");
    close(mean, 1.0 / 3.0);
    close(u, (8.0f64 / 252.0).sqrt());
}

#[test]
fn gum_u_and_dof_beside_a_shape() {
    // JCGM 101 9.5, δα: the GUM column uses the rectangle, Monte Carlo the curvilinear trapezoid.
    let keys = "value = 0\nhalf_width = 1\ndistribution = \"curvilinear-trapezoid\"\nd = 0.1\ndof = 50\ngum_u = 0.58";
    let (u, dof, distribution) = component(keys);
    assert_eq!((u, dof), (0.58, 50.0));
    assert_eq!(
        distribution,
        Distribution::CurvilinearTrapezoid {
            lower: -1.0,
            upper: 1.0,
            d: 0.1
        }
    );
}

#[test]
fn the_t_scale_is_a_convention() {
    let text = format!(
        "[conventions]\nt_scale = \"standard-deviation\"\n{}",
        one("value = 1\nu = 0.3\ndof = 8")
    );
    let budget = budget(&text);
    assert_eq!(budget.conventions.t_scale, TScale::StandardDeviation);
    close(
        budget.components[0]
            .distribution
            .standard_deviation()
            .unwrap(),
        0.3,
    );
    assert_eq!(
        budget.conventions.overrides,
        ["t_scale = \"standard-deviation\""]
    );
}

#[test]
fn relative_amounts() {
    close(component("value = -4\nu = \"50 ppm\"").0, 2e-4);
    close(component("value = -4\nu = 0.01\nrelative = true").0, 0.04);
    assert_eq!(faults(&one("value = 0\nu = \"50 ppm\""))[0].0, "B0214");
    let ratio = "[measurand.Y]\nmodel = \"X\"\n[input.X]\nvalue = 2\nu = \"1 %\"\n";
    assert_eq!(faults(ratio), [("B0113", "\"1 %\"".into())]);
    let angle = "[measurand.Y]\nmodel = \"X\"\nunit = \"°\"\n[input.X]\nvalue = 2\nunit = \"°\"\nu = \"6 '\"\n";
    close(budget(angle).components[0].u, 0.1);
    let temperature = "[measurand.Y]\nmodel = \"X\"\nunit = \"°C\"\n[input.X]\nvalue = \"293.15 K\"\nunit = \"°C\"\nu = \"0.1 °C\"\n";
    let budget = budget(temperature);
    assert!(
        (budget.inputs[0].estimate - 20.0).abs() < 1e-9 && budget.components[0].unit.symbol == "K"
    );
    close(budget.components[0].u, 0.1);
}

#[test]
fn contradictions_point_at_both_places() {
    let rejection = refused(&one("value = 1\nu = 0.1\nhalf_width = 0.2"));
    assert_eq!(rejection.faults[0].code.id, "B0202");
    assert_eq!(rejection.faults[0].related.len(), 1);
    assert_eq!(faults(&one("value = 1")), [("B0201", "[input.X]".into())]);
    assert_eq!(faults(&one("u = 1")), [("B0212", "[input.X]".into())]);
    assert_eq!(faults(&one("value = 1\nu = 0")), [("B0203", "0".into())]);
    assert_eq!(
        faults(&one("value = 1\nu = \"0.5\"")),
        [("B0106", "\"0.5\"".into())]
    );
    assert_eq!(
        faults(&one("value = 1\nu = 1\nbeta = 0.5")),
        [("B0207", "beta".into())]
    );
    assert_eq!(
        faults(&one("value = 1\nu = 1\nof = 2")),
        [("B0207", "of".into())]
    );
    assert_eq!(faults(&one("readings = [1]")), [("B0208", "[1]".into())]);
    assert_eq!(
        faults(&one("readings = [1, 1, 1]")),
        [("B0209", "[1, 1, 1]".into())]
    );
}

#[test]
fn all_faults_come_in_one_pass_and_in_order() {
    let text = "titel = \"x\"\n[measurand.Y]\nmodel = \"X + Z\"\n[input.X]\nvalue = \"1\"\nu = -1\n[input.W]\nvalue = 1\nu = 1\n";
    let codes: Vec<&str> = faults(text).iter().map(|(code, _)| *code).collect();
    assert!(
        codes.contains(&"B0104") && codes.contains(&"B0106"),
        "{codes:?}"
    );
    let rejection = refused(text);
    assert!(
        rejection
            .faults
            .windows(2)
            .all(|pair| pair[0].span.start <= pair[1].span.start)
    );
    assert!(
        rejection
            .render(false)
            .trim_end()
            .ends_with("in budget.toml")
    );
}

#[test]
fn readings_without_scatter_are_left_to_the_resolution() {
    let text = one("components = [{ readings = [1.5, 1.5, 1.5] }, { step = 0.1 }]");
    let budget = budget(&text);
    assert_eq!(
        (budget.inputs[0].estimate, budget.components.len()),
        (1.5, 1)
    );
    assert_eq!(budget.remarks.len(), 1);
}

#[test]
fn the_larger_of_resolution_and_repeatability() {
    let parts = one("components = [{ readings = [1, 2, 3] }, { step = 0.1 }]");
    assert_eq!(budget(&parts).components.len(), 2);
    let largest = budget(&format!("[conventions]\nresolution = \"largest\"\n{parts}"));
    assert_eq!(largest.components.len(), 1);
    assert_eq!(largest.components[0].label, "repeatability");
}

/// Ten resistors calibrated against one standard (GUM 5.2.2, example): fully correlated.
#[test]
fn a_shared_source_acts_on_several_inputs() {
    let text = "[measurand.Y]\nmodel = \"a + b\"\nunit = \"V\"\n[source.s]\nu = 0.1\nunit = \"V\"\n\
        [input.a]\nvalue = 1\nunit = \"V\"\nsource = \"s\"\n[input.b]\nvalue = 2\nunit = \"mV\"\ncomponents = [{ source = \"s\", sensitivity = 3 }, { u = 1 }]\n";
    let shared = budget(text);
    assert_eq!(shared.components.len(), 2);
    assert_eq!(shared.components[0].name, "s");
    assert_eq!(shared.inputs[0].terms[0].coefficient, 1.0);
    assert_eq!(shared.inputs[1].terms[0].coefficient, 3.0);
    let converted = budget(&text.replace(", sensitivity = 3", ""));
    close(converted.inputs[1].terms[0].coefficient, 1000.0);
    assert_eq!(
        faults(
            &text
                .replace("source = \"s\"\n", "u = 1\n")
                .replace("{ source = \"s\", sensitivity = 3 }, ", "")
        )[0]
        .0,
        "B0401"
    );
    assert_eq!(
        faults(&text.replace("source = \"s\"\n", "source = \"t\"\n"))[0].0,
        "B0301"
    );
}

#[test]
fn vectors_have_independent_or_common_errors() {
    let vector = |keys: &str| {
        budget(&format!(
            "[measurand.Y]\nmodel = \"sum(X)\"\nunit = \"V\"\n[input.X]\nunit = \"V\"\nvalues = [1, -2, 4]\n{keys}\n"
        ))
    };
    let independent = vector("u = 0.1");
    assert_eq!(independent.components.len(), 3);
    assert_eq!(independent.components[1].name, "X[2]");
    let common = vector("u = \"10 %\"\ncommon = true");
    assert_eq!(common.components.len(), 1);
    let effects: Vec<f64> = common
        .inputs
        .iter()
        .map(|input| input.terms[0].coefficient * common.components[0].u)
        .collect();
    assert!(
        effects
            .iter()
            .zip([0.1, -0.2, 0.4])
            .all(|(a, b)| (a - b).abs() < 1e-15),
        "{effects:?}"
    );
}

fn three(correlations: &str) -> String {
    let input = |name: &str| format!("[input.{name}]\nvalue = 1\nu = 0.1\n");
    format!(
        "[measurand.Y]\nmodel = \"a + b + c\"\n{}{}{}{correlations}",
        input("a"),
        input("b"),
        input("c")
    )
}

fn correlation(a: &str, b: &str, r: f64) -> String {
    format!("[[correlation]]\nbetween = [\"{a}\", \"{b}\"]\nr = {r}\n")
}

#[test]
fn correlated_inputs_form_a_group() {
    let budget = budget(&three(&correlation("a", "c", 0.3)));
    assert_eq!(budget.groups.len(), 1);
    assert_eq!(budget.groups[0].members, [0, 2]);
    assert_eq!(budget.groups[0].correlation[(0, 1)], 0.3);
    assert_eq!(budget.groups[0].law, Law::Normal);
}

#[test]
fn impossible_correlations_are_refused_with_the_nearest_possible_one() {
    let all = [
        correlation("a", "b", 0.9),
        correlation("b", "c", 0.9),
        correlation("a", "c", -0.9),
    ]
    .concat();
    let rejection = refused(&three(&all));
    assert_eq!(rejection.faults[0].code.id, "B0305");
    // With r = 0.9 twice the third is at least 2·0.81 − 1 = 0.62.
    let help = rejection.faults[0].help.clone().unwrap();
    assert!(help.contains("0.62") || help.contains("-0.62"), "{help}");
    assert_eq!(
        faults(&three(&correlation("a", "b", 1.5)))[0],
        ("B0302", "1.5".into())
    );
    assert_eq!(faults(&three(&correlation("a", "a", 0.5)))[0].0, "B0304");
    assert_eq!(
        faults(&three(&correlation("a", "d", 0.5)))[0],
        ("B0301", "\"d\"".into())
    );
    let twice = [correlation("a", "b", 0.9), correlation("b", "a", 0.9)].concat();
    assert_eq!(faults(&three(&twice))[0].0, "B0303");
}

#[test]
fn a_correlation_of_inputs_is_spread_over_their_components() {
    let text = "[measurand.Y]\nmodel = \"a + b\"\n\
        [input.a]\nvalue = 1\ncomponents = [{ u = 3 }, { name = \"z\", u = 4 }]\n[input.b]\nvalue = 1\nu = 2\n";
    let group = budget(&format!("{text}{}", correlation("a", "b", 0.5)))
        .groups
        .remove(0);
    // Covariance Σ r_ij u_i u_j = 0.5·5·2.
    close(
        group.correlation[(0, 2)] * 3.0 * 2.0 + group.correlation[(1, 2)] * 4.0 * 2.0,
        5.0,
    );
    assert_eq!(group.correlation[(0, 1)], 0.0);
    let named = budget(&format!("{text}{}", correlation("a.z", "b", 0.5)))
        .groups
        .remove(0);
    assert_eq!(named.members, [1, 2]);
}

/// GUM H.2, simultaneous readings: the published correlation coefficients.
#[test]
fn joint_readings() {
    let text = "[measurand.R]\nmodel = \"V / I * cos(phi)\"\nunit = \"ohm\"\n\
        [input.V]\nunit = \"V\"\nreadings = [5.007, 4.994, 5.005, 4.990, 4.999]\n\
        [input.I]\nunit = \"A\"\nreadings = [19.663e-3, 19.639e-3, 19.640e-3, 19.685e-3, 19.678e-3]\n\
        [input.phi]\nunit = \"rad\"\nreadings = [1.0456, 1.0438, 1.0468, 1.0428, 1.0433]\n\
        [[joint]]\ninputs = [\"V\", \"I\", \"phi\"]\n";
    let group = budget(text).groups.remove(0);
    for ((i, j), r) in [((0, 1), -0.36), ((0, 2), 0.86), ((1, 2), -0.65)] {
        assert!((group.correlation[(i, j)] - r).abs() < 0.005);
    }
    assert_eq!(group.dof, Some(4.0));
    assert!(matches!(group.law, Law::StudentT { dof: 2.0, .. }));
}

#[test]
fn a_joint_covariance_states_the_uncertainties() {
    let text = "[measurand.Y]\nmodel = \"a + b\"\n[input.a]\nvalue = 1\n[input.b]\nvalue = 2\n\
        [[joint]]\ninputs = [\"a\", \"b\"]\ncovariance = [[4, -3], [-3, 9]]\ndof = 7\n";
    let budget = budget(text);
    assert_eq!((budget.components[0].u, budget.components[1].u), (2.0, 3.0));
    assert_eq!(budget.groups[0].correlation[(0, 1)], -0.5);
    assert_eq!(budget.groups[0].dof, Some(7.0));
    assert_eq!(faults(&text.replace("[-3, 9]", "[3, 9]"))[0].0, "B0306");
    assert_eq!(faults(&text.replace("-3", "-7"))[0].0, "B0305");
}

#[test]
fn different_distributions_are_joined_by_a_copula() {
    let text = "[measurand.Y]\nmodel = \"a + b\"\n[input.a]\nvalue = 1\nhalf_width = 1\n[input.b]\nvalue = 2\nhalf_width = 1\n";
    let group = budget(&format!("{text}{}", correlation("a", "b", 0.5)))
        .groups
        .remove(0);
    let Law::GaussianCopula { latent } = group.law else {
        panic!("expected a copula")
    };
    // Closed form for two rectangles: ρ = 2 sin(π r/6).
    assert!((latent[(0, 1)] - 2.0 * (std::f64::consts::PI / 12.0).sin()).abs() < 1e-9);
}

#[test]
fn series_replace_values_row_by_row() {
    let text = "[measurand.Y]\nmodel = \"X\"\n[input.X]\nu = 0.1\n[series]\ncolumns = [\"label\", \"X\", \"claim.value\"]\nrows = [[\"one\", 1, 1.1], [\"two\", 2, 2.2]]\n";
    let rows = read(text, "budget.toml", Path::new("")).unwrap().rows;
    assert_eq!(rows.len(), 2);
    assert_eq!(rows[1].label.as_deref(), Some("two"));
    assert_eq!(rows[1].budget.inputs[0].estimate, 2.0);
    assert_eq!(
        rows[1].budget.claims[0].figure(&Figure::Estimate),
        Some(2.2)
    );
    assert_eq!(
        faults(&text.replace("[\"two\", 2, 2.2]", "[\"two\", 2]"))
            .iter()
            .filter(|f| f.0 == "B0404")
            .count(),
        1
    );
    assert!(
        faults(&text.replace("\"X\", \"claim", "\"x\", \"claim"))
            .iter()
            .any(|f| f.0 == "B0301")
    );
}

#[test]
fn claims_are_read_in_the_unit_of_the_measurand() {
    let claim = budget(&one("value = 1\nu = 0.1\n[claim]\nU = \"200 mV\"\nk = 2"))
        .claims
        .remove(0);
    close(claim.figure(&Figure::ExpandedUncertainty).unwrap(), 0.2);
    assert_eq!(
        faults(&one("value = 1\nu = 0.1\n[claim]\nnote = \"x\""))[0].0,
        "B0403"
    );
}

#[test]
fn profiles_and_overrides() {
    let refused = faults(&format!("profile = \"Gum\"\n{}", one("value = 1\nu = 1")));
    assert_eq!(refused[0], ("B0108", "\"Gum\"".into()));
    let budget = budget(&format!("profile = \"EA\"\n{}", one("value = 1\nu = 1")));
    assert_eq!(budget.conventions.coverage_probability, 0.9545);
}

#[test]
fn certificates_past_due_are_remarked() {
    let text = one("value = 1\ncertificate = { U = 1, k = 2, number = \"A1\", due = 2025-12-31 }");
    assert_eq!(
        budget(&format!("date = 2026-01-15\n{text}")).remarks.len(),
        1
    );
    assert!(
        budget(&format!("date = 2025-01-15\n{text}"))
            .remarks
            .is_empty()
    );
}

#[test]
fn unused_inputs_and_faults_inside_formulas() {
    let text = "[measurand.Y]\nmodel = '''\nX +\n  Zz'''\n[input.X]\nvalue = 1\nu = 1\n";
    assert!(
        faults(text).iter().any(|(_, shown)| shown == "Zz"),
        "{:?}",
        faults(text)
    );
    let unused =
        "[measurand.Y]\nmodel = \"X\"\n[input.X]\nvalue = 1\nu = 1\n[input.W]\nvalue = 1\nu = 1\n";
    assert_eq!(faults(unused), [("B0401", "W".into())]);
    assert_eq!(faults("title = \"x\"\n")[0].0, "B0402");
}

#[test]
fn syntax_errors_are_all_reported() {
    let codes: Vec<&str> = faults("a = \nb = 1\nb = 2\n")
        .iter()
        .map(|(code, _)| *code)
        .collect();
    let syntax = codes.iter().filter(|code| **code == "B0103").count();
    assert_eq!(syntax, 2, "{codes:?}");
    // What stands on other lines is judged all the same.
    let text = "[measurand.Y]\nmodel = \"X\"\n[input.X]\nvalue = 1\nu = 1%\n[input.W]\nvalu = 2\n";
    let codes: Vec<&str> = faults(text).iter().map(|(code, _)| *code).collect();
    assert_eq!(codes, ["B0103", "B0104"]);
}

#[test]
fn the_schema_knows_every_key() {
    let schema = crate::budget::schema();
    assert_eq!(schema["additionalProperties"], false);
    assert!(
        schema["properties"]["input"]["additionalProperties"]["properties"]["half_width"]
            .is_object()
    );
    let rows = crate::budget::keys();
    assert!(
        rows.iter()
            .any(|row| row.table == "input.NAME.certificate" && row.key == "U"),
        "{rows:#?}"
    );
}

#[test]
fn an_expanded_uncertainty_is_not_taken_for_a_standard_one() {
    let rejection = refused(&one("value = 1\nU = 0.4"));
    assert!(
        rejection.faults[0]
            .help
            .as_ref()
            .unwrap()
            .contains("certificate = {")
    );
}

#[test]
fn components_have_different_names() {
    let text = one("value = 1\ncomponents = [{ name = \"a\", u = 1 }, { name = \"a\", u = 2 }]");
    assert_eq!(faults(&text), [("B0115", "\"a\"".into())]);
    let text = one("value = 1\ncomponents = [{ u = 1 }, { u = 2 }]");
    assert_eq!(budget(&text).components[1].label, "standard uncertainty 2");
}

#[test]
fn a_misspelt_unit_is_reported_once() {
    let text = one("value = 1\nu = 1").replace("[input.X]\nunit", "[input.X]\nunti");
    assert_eq!(faults(&text), [("B0104", "unti".into())]);
}
