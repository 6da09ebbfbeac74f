//! Tolerances by limits, and by the maximum permissible error.

use super::*;

/// The tolerance of a measurand in V.
fn tolerance(keys: &str) -> [f64; 2] {
    let found = budget(&decided(keys)).conformity[0].tolerance;
    [found.lower, found.upper]
}

fn decided(keys: &str) -> String {
    format!(
        "{}[conformity]\nrule = \"simple\"\n{keys}\n",
        one("value = 10.1\nu = 0.01")
    )
}

#[test]
fn a_permissible_error_is_two_limits() {
    assert_eq!(tolerance("mpe = 0.5"), [-0.5, 0.5]);
    assert_eq!(tolerance("mpe = \"500 mV\"\nnominal = 10"), [9.5, 10.5]);
    let [lower, upper] = tolerance("mpe = \"2 %\"\nnominal = \"10 V\"");
    close(lower, 9.8);
    close(upper, 10.2);
}

#[test]
fn a_permissible_error_is_stated_once_and_whole() {
    for (keys, code, marked) in [
        ("mpe = 0.5\nlower = 1", "B0501", "mpe"),
        ("nominal = 10", "B0501", "nominal"),
        ("mpe = 0", "B0501", "0"),
        ("mpe = \"2 %\"", "B0214", "\"2 %\""),
    ] {
        let found = faults(&decided(keys));
        assert_eq!(found[0], (code, marked.to_string()), "{keys}");
    }
    let celsius = "[measurand.T]\nmodel = \"t\"\nunit = \"°C\"\n[input.t]\nvalue = 20\nunit = \"°C\"\nu = 0.1\n[conformity]\nrule = \"simple\"\nmpe = \"0.5 °C\"\n";
    assert!(
        refused(celsius)
            .to_string()
            .contains("`nominal` is missing")
    );
    let found = budget(&format!("{celsius}nominal = 20\n")).conformity[0].tolerance;
    assert_eq!([found.lower, found.upper], [19.5, 20.5]);
}

#[test]
fn a_percentage_of_a_percentage_says_what_to_write() {
    for (unit, nominal, help) in [
        ("%", "", "write the plain number 2, which is in %, if"),
        (
            "%",
            "nominal = 50\n",
            "for 2 % of the nominal value write 1",
        ),
        ("%RH", "", "write the plain number 2, which is in %RH, if"),
        ("1", "", "write the plain number 0.02, if"),
        (
            "1",
            "nominal = 5\n",
            "for 2 % of the nominal value write 0.1",
        ),
    ] {
        let text = format!(
            "[measurand.h]\nmodel = \"x\"\nunit = \"{unit}\"\n[input.x]\nvalue = 50\nunit = \"{unit}\"\nu = 1\n[conformity]\nrule = \"simple\"\nmpe = \"2 %\"\n{nominal}"
        );
        let rejection = refused(&text);
        assert_eq!(rejection.faults[0].code.id, "B0113", "{text}");
        let found = rejection.faults[0].help.clone().unwrap_or_default();
        let found = found.to_string();
        assert!(
            found.contains(help) && !found.contains("relative ="),
            "{found}"
        );
    }
}

#[test]
fn a_slope_in_its_own_unit_is_plain() {
    let text = "[measurand.s]\nmodel = \"x\"\nunit = \"mm/m\"\n[input.x]\nvalue = 0.3\nunit = \"mm/m\"\nu = \"0.01 mm/m\"\n[conformity]\nrule = \"simple\"\nmpe = \"0.02 mm/m\"\nnominal = 0.3\n";
    let budget = budget(text);
    close(budget.components[0].u, 0.01);
    let found = budget.conformity[0].tolerance;
    close(found.lower, 0.28);
    close(found.upper, 0.32);
}

/// The limits of an error that is stated as a part already are parts of nothing else.
#[test]
fn a_relative_error_needs_no_value_of_which_it_is_a_part() {
    let of = |unit: &str, stated: &str| {
        format!(
            "[measurand.e]\nmodel = \"x\"\nunit = \"{unit}\"\n[input.x]\nvalue = 0.4\nunit = \"{unit}\"\nu = 0.1\n[conformity]\nrule = \"simple\"\n{stated}\n"
        )
    };
    let rejection = refused(&of("%", "mpe_of = \"100 N\"\nmpe = \"4 %\""));
    let help = rejection.faults[0]
        .help
        .clone()
        .unwrap_or_default()
        .to_string();
    assert!(
        help.contains("leave out `mpe_of`") && help.ends_with("in %"),
        "{help}"
    );
    budget(&of("%", "mpe = 4"));
    budget(&of("%RH", "mpe_of = \"50 %RH\"\nmpe = 2"));
}
