//! Checks of whole small files; published numbers where there are any.

mod correlations;
mod faults;
mod temperatures;
mod tolerances;
mod type_a;
mod ways;

use std::path::Path;

use crate::budget::{Budget, Figure, Law, Rejection, TScale, read};
use gumption_core::distribution::Distribution;
use gumption_fault::language::Language;

fn refused(text: &str) -> Rejection {
    read(text, "budget.toml", Path::new("")).expect_err("the file has a fault")
}

/// Codes of the faults, each with the text that it points at.
fn faults(text: &str) -> Vec<(&'static str, String)> {
    let rejection = refused(text);
    let shown = |fault: &gumption_fault::Fault| {
        text.get(fault.span.clone()).unwrap_or_default().to_string()
    };
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

/// A [[correlation]] of two quantities.
fn correlation(a: &str, b: &str, r: f64) -> String {
    format!("[[correlation]]\nbetween = [\"{a}\", \"{b}\"]\nr = {r}\n")
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} is not {b}");
}

#[test]
fn the_template_loads() {
    let [english, chinese] = [Language::English, Language::Chinese].map(crate::budget::template);
    let (english, chinese) = (budget(&english), budget(&chinese));
    assert_eq!(english.inputs.len(), 4);
    assert_eq!(english.components.len(), 6);
    // 50 ppm of 10.0021 mA, rectangular.
    close(english.components[3].u, 10.0021 * 50e-6 / 3f64.sqrt());
    // The same measurement, in the profile of JJF 1059.1.
    let u = |budget: &Budget| -> Vec<f64> { budget.components.iter().map(|c| c.u).collect() };
    assert_eq!(u(&english), u(&chinese));
    assert_eq!(chinese.conventions.profile, "JJF");
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
fn rows_without_labels_are_named_by_what_differs() {
    let labels = |columns: &str, rows: &str| -> Vec<Option<String>> {
        let text = format!(
            "[measurand.Y]\nmodel = \"X + c\"\nunit = \"V\"\n[input.X]\nunit = \"V\"\nu = 0.1\n[constant]\nc = \"1 V\"\n\
             [series]\ncolumns = {columns}\nrows = {rows}\n"
        );
        let rows = read(&text, "budget.toml", Path::new("")).unwrap().rows;
        rows.into_iter().map(|row| row.label).collect()
    };
    let named = |names: [&str; 2]| names.map(|name| Some(name.to_owned())).to_vec();
    assert_eq!(
        labels("[\"X\", \"X.dof\"]", "[[400, 3], [600.5, 4]]"),
        named(["400 V", "600.5 V"])
    );
    assert_eq!(
        labels("[\"X.u\", \"c\", \"X\"]", "[[0.1, 1, 3], [0.2, 1, 4]]"),
        named(["3 V", "4 V"])
    );
    assert_eq!(labels("[\"X\"]", "[[3], [3]]"), [None, None]);
    assert_eq!(
        labels("[\"X\", \"label\"]", "[[3, \"a\"], [4, \"b\"]]"),
        named(["a", "b"])
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

/// mL to L is converted without the 1000 that the formula holds for it.
#[test]
fn a_conversion_that_is_made_twice_is_refused() {
    let text = |model: &str| {
        format!(
            "[measurand.c]\nmodel = \"{model}\"\nunit = \"mg/L\"\n[input.m]\nvalue = 100\nu = 0.1\nunit = \"mg\"\n\
             [input.V]\nvalue = 100\nu = 0.1\nunit = \"mL\"\n"
        )
    };
    let dilution = "[constant]\ndilution = 1000\n";
    for twice in [
        "1000 * m / V",
        "m / (V / 1000)",
        "m / (V * 0.001)",
        "abs(1000 * m / V)",
    ] {
        let found = faults(&text(twice));
        let codes: Vec<&str> = found.iter().map(|(code, _)| *code).collect();
        assert_eq!(codes, ["M0410"], "{twice}");
    }
    for meant in [
        "m / V",
        "1000 '1' * m / V",
        "m / V * ln(1000)",
        "m / V * 1000^0.5",
    ] {
        assert!(budget(&text(meant)).remarks.is_empty(), "{meant}");
    }
    let named = format!("{}{dilution}", text("dilution * m / V"));
    assert!(budget(&named).remarks.is_empty());
}

/// 30 without a unit is hardly an angle in radians; 0.5 may be, and what has a unit is.
#[test]
fn degrees_without_a_unit_are_remarked_on() {
    let remarks = |angle: &str, model: &str| {
        let text = format!(
            "[measurand.h]\nmodel = \"{model}\"\nunit = \"m\"\n[input.L]\nvalue = 2\nu = 0.1\nunit = \"m\"\n[input.a]\n{angle}\nu = 0.1\n"
        );
        budget(&text).remarks
    };
    let degrees = remarks("value = 30", "L * sin(a) + L * cos(a)");
    assert_eq!(degrees.len(), 1);
    assert!(degrees[0].to_string().contains("30 rad"), "{degrees:?}");
    assert!(remarks("value = 0.5", "L * sin(a)").is_empty());
    let converted = "s(a) = sin(a)\\ny = L * s(a * pi / 180)\\ny";
    assert!(remarks("value = 30", converted).is_empty());
    assert!(remarks("value = 30\nunit = \"°\"", "L * sin(a)").is_empty());
    assert!(remarks("value = 30\nunit = \"rad\"", "L * sin(a)").is_empty());
}
