//! Shared sources, vectors, correlations and groups.

use super::*;

/// Ten resistors calibrated against one standard (GUM 5.2.2, example): fully correlated.
#[test]
fn a_shared_source_acts_on_several_inputs() {
    let text = "[measurand.Y]\nmodel = \"a + b\"\nunit = \"V\"\n[source.s]\nu = 0.1\nunit = \"V\"\n\
        [input.a]\nvalue = 1\nunit = \"V\"\nsource = \"s\"\n[input.b]\nvalue = 2\nunit = \"mV\"\ncomponents = [{ source = \"s\", sensitivity = 3 }, { u = 1 }]\n";
    let shared = budget(text);
    assert_eq!(shared.components.len(), 2);
    assert_eq!(shared.components[0].name, "s");
    assert_eq!(shared.inputs[0].terms[0].coefficient, 1.0);
    // Three times the change of the source, in the unit of the input.
    close(shared.inputs[1].terms[0].coefficient, 3000.0);
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
    let help = rejection.faults[0].help.clone().unwrap().to_string();
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

/// Before any of its pairs is looked at: the names need not even be known.
#[test]
fn a_correlation_of_more_pairs_than_memory_holds_is_refused() {
    let names: Vec<String> = (0..3000).map(|i| format!("\"x{i}\"")).collect();
    let list = format!("[{}]", names.join(", "));
    let text = format!(
        "{}[[correlation]]\nbetween = {list}\nr = 0.3\n",
        one("value = 1\nu = 0.1")
    );
    assert_eq!(faults(&text), [("B0105", list)]);
}
