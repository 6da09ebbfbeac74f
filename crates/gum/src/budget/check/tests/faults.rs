//! What is refused, and where the faults point.

use super::*;

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
fn an_expanded_uncertainty_is_not_taken_for_a_standard_one() {
    let rejection = refused(&one("value = 1\nU = 0.4"));
    assert!(
        rejection.faults[0]
            .help
            .as_ref()
            .unwrap()
            .to_string()
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
