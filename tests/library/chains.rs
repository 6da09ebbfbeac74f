//! Results that are inputs of other budgets: whatever they have in common stays common, whether the other
//! budget is used directly or its results were saved.

use std::path::Path;

use crate::common::evaluation::close;
use gumption::budget::{self, Budget, Files};
use gumption::propagate::{self, Evaluation, MonteCarloChoice, Options};
use gumption::report::{self, Language, Report};

/// Five simultaneous readings, as in GUM H.2.
const READINGS: &str = r#"
    [measurand]
    V = { model = "E_V", unit = "V" }
    I = { model = "E_I", unit = "mA" }
    [input.E_V]
    unit = "V"
    readings = [5.007, 4.994, 5.005, 4.990, 4.999]
    [input.E_I]
    unit = "mA"
    readings = [19.663, 19.639, 19.640, 19.685, 19.678]
    [[joint]]
    inputs = ["E_V", "E_I"]
"#;

fn load(files: &[(&str, &str)], name: &str) -> Budget {
    let library: Vec<(&str, &[u8])> = files.iter().map(|(n, t)| (*n, t.as_bytes())).collect();
    match budget::load_from(Files::Library(&library), Path::new(name), None) {
        Ok(mut loaded) => loaded.rows.remove(0).budget,
        Err(rejection) => panic!("{}", rejection.render(false)),
    }
}

fn refusal(files: &[(&str, &str)], name: &str) -> String {
    let library: Vec<(&str, &[u8])> = files.iter().map(|(n, t)| (*n, t.as_bytes())).collect();
    match budget::load_from(Files::Library(&library), Path::new(name), None) {
        Ok(_) => panic!("accepted"),
        Err(rejection) => rejection.render(false),
    }
}

fn gum(budget: &Budget) -> Evaluation {
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    propagate::evaluate(budget, &options).expect("a value")
}

/// The results of a file as `gumption eval --save` writes them into the top of the library.
fn saved(files: &[(&str, &str)], name: &str) -> String {
    let library: Vec<(&str, &[u8])> = files.iter().map(|(n, t)| (*n, t.as_bytes())).collect();
    let loaded = budget::load_from(Files::Library(&library), Path::new(name), None)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let evaluations: Vec<Evaluation> = loaded.rows.iter().map(|row| gum(&row.budget)).collect();
    let reports: Vec<Report<'_>> = loaded
        .rows
        .iter()
        .zip(&evaluations)
        .map(|(row, evaluation)| Report {
            budget: &row.budget,
            evaluation,
            label: row.label.as_deref(),
            language: Language::English,
        })
        .collect();
    report::saved(&reports, Path::new("")).expect("a linear form")
}

/// R = V/I where V and I come from elsewhere.
fn quotient(v: &str, i: &str) -> String {
    format!(
        r#"
        [measurand.R]
        model = "V / I"
        unit = "ohm"
        [input.V]
        from = {{ {v}, measurand = "V" }}
        [input.I]
        from = {{ {i}, measurand = "I" }}
        "#
    )
}

#[track_caller]
fn same(found: &Evaluation, expected: &Evaluation) {
    let (found, expected) = (&found.results[0].gum, &expected.results[0].gum);
    close(found.estimate / expected.estimate, 1.0, 1e-15);
    close(found.u / expected.u, 1.0, 1e-14);
    close(found.freedom.value(), expected.freedom.value(), 1e-9);
    close(
        found.coverage.expanded / expected.coverage.expanded,
        1.0,
        1e-9,
    );
}

#[test]
fn a_quotient_of_two_results_is_that_of_the_direct_budget() {
    let direct = READINGS.replace(
        "[measurand]",
        "[measurand]\nR = { model = \"E_V / E_I\", unit = \"ohm\" }",
    );
    let direct = gum(&load(&[("direct.toml", &direct)], "direct.toml"));
    // Without their correlation u would be another one.
    assert!(direct.results[0].gum.u > 0.0);
    close(direct.results[0].gum.freedom.value(), 4.0, 1e-9);

    let result = saved(&[("vi.toml", READINGS)], "vi.toml");
    let (budget, saved) = ("budget = \"vi.toml\"", "result = \"vi.json\"");
    for (v, i) in [
        (budget, budget),
        (saved, saved),
        (budget, saved),
        (saved, budget),
    ] {
        let quotient = quotient(v, i);
        let files = [
            ("vi.toml", READINGS),
            ("vi.json", result.as_str()),
            ("r.toml", quotient.as_str()),
        ];
        same(&gum(&load(&files, "r.toml")), &direct);
    }
}

#[test]
fn monte_carlo_sees_the_whole_chain() {
    let quotient = quotient("budget = \"vi.toml\"", "budget = \"vi.toml\"");
    let chain = load(&[("vi.toml", READINGS), ("r.toml", &quotient)], "r.toml");
    let direct = READINGS.replace(
        "V = { model = \"E_V\", unit = \"V\" }\n    I = { model = \"E_I\", unit = \"mA\" }",
        "R = { model = \"E_V / E_I\", unit = \"ohm\" }",
    );
    let direct = load(&[("direct.toml", &direct)], "direct.toml");
    let options = Options::default();
    let found = propagate::evaluate(&chain, &options).expect("a value");
    let expected = propagate::evaluate(&direct, &options).expect("a value");
    let pair = [&found, &expected].map(|e| e.results[0].monte_carlo.clone().expect("run"));
    // The same components, the same model, the same random numbers.
    assert_eq!(pair[0].symmetric, pair[1].symmetric);
}

/// A reference, two instruments calibrated with it, and their difference.
const REFERENCE: &str = r#"
    [measurand.r]
    model = "nominal + deviation"
    unit = "g"
    [constant]
    nominal = "100 g"
    [input.deviation]
    value = 0.12
    unit = "mg"
    components = [{ name = "calibration", u = 0.05, dof = 12 }, { name = "drift", half_width = 0.03 }]
"#;

fn transfer(name: &str, difference: f64) -> String {
    format!(
        r#"
        [measurand.{name}]
        model = "reference + d"
        unit = "g"
        [input.reference]
        from = {{ budget = "reference.toml" }}
        unit = "kg"
        [input.d]
        value = {difference}
        unit = "mg"
        u = 0.02
        dof = 9
        "#
    )
}

#[test]
fn what_two_budgets_take_from_a_third_cancels_in_their_difference() {
    let (a, b) = (transfer("a", 0.3), transfer("b", -0.1));
    let difference = |a: &str, b: &str| {
        format!(
            "[measurand.d]\nmodel = \"a - b\"\nunit = \"mg\"\n[input.a]\nfrom = {{ {a} }}\n[input.b]\nfrom = {{ {b} }}\n"
        )
    };
    let files = [
        ("reference.toml", REFERENCE),
        ("a.toml", &a),
        ("b.toml", &b),
    ];
    let (json_a, json_b) = (saved(&files, "a.toml"), saved(&files, "b.toml"));
    for (from_a, from_b) in [
        ("budget = \"a.toml\"", "budget = \"b.toml\""),
        ("result = \"a.json\"", "result = \"b.json\""),
        ("budget = \"a.toml\"", "result = \"b.json\""),
    ] {
        let top = difference(from_a, from_b);
        let files = [
            ("reference.toml", REFERENCE),
            ("a.toml", &a),
            ("b.toml", &b),
            ("a.json", &json_a),
            ("b.json", &json_b),
            ("top.toml", &top),
        ];
        let budget = load(&files, "top.toml");
        let found = &gum(&budget).results[0].gum;
        close(found.estimate, 0.4, 1e-10);
        close(found.u, 0.02 * 2f64.sqrt(), 1e-12);
        close(found.freedom.value(), 18.0, 1e-6);
        let names: Vec<&str> = budget.components.iter().map(|c| c.name.as_str()).collect();
        assert!(
            names.contains(&"reference.deviation.calibration"),
            "{names:?}"
        );
        assert!(
            names.contains(&"a.d") && names.contains(&"b.d"),
            "{names:?}"
        );
        assert_eq!(names.len(), 4, "{names:?}");
    }
}

#[test]
fn part_of_a_correlated_group_stays_correlated_with_the_rest() {
    let third = r#"
        [measurand]
        x = { model = "p", unit = "V" }
        y = { model = "q", unit = "V" }
        [input]
        p = { value = 1, unit = "V", u = 0.1 }
        q = { value = 2, unit = "V", half_width = 0.2 }
        [[correlation]]
        between = ["p", "q"]
        r = 0.5
    "#;
    let through = |measurand: &str| {
        format!(
            "[measurand.z]\nmodel = \"i\"\nunit = \"V\"\n[input.i]\nfrom = {{ budget = \"third.toml\", measurand = \"{measurand}\" }}\n"
        )
    };
    let (a, b) = (through("x"), through("y"));
    let files = [("third.toml", third), ("a.toml", &a), ("b.toml", &b)];
    let (json_a, json_b) = (saved(&files, "a.toml"), saved(&files, "b.toml"));
    let expected = (0.01 + 0.04 / 3.0 + 2.0 * 0.5 * 0.1 * 0.2 / 3f64.sqrt()).sqrt();
    for (from_a, from_b) in [
        ("budget = \"a.toml\"", "budget = \"b.toml\""),
        ("result = \"a.json\"", "result = \"b.json\""),
        ("result = \"a.json\"", "budget = \"b.toml\""),
    ] {
        let top = format!(
            "[measurand.s]\nmodel = \"a + b\"\nunit = \"V\"\n[input.a]\nfrom = {{ {from_a} }}\n[input.b]\nfrom = {{ {from_b} }}\n"
        );
        let files = [
            ("third.toml", third),
            ("a.toml", &a),
            ("b.toml", &b),
            ("a.json", &json_a),
            ("b.json", &json_b),
            ("top.toml", &top),
        ];
        let found = gum(&load(&files, "top.toml"));
        close(found.results[0].gum.u, expected, 1e-14);
    }
}

#[test]
fn saved_results_may_be_passed_on() {
    // V and I saved, their quotient saved, its square from that, all beside V itself.
    let vi = saved(&[("vi.toml", READINGS)], "vi.toml");
    let quotient = quotient("result = \"vi.json\"", "result = \"vi.json\"");
    let files = [
        ("vi.toml", READINGS),
        ("vi.json", vi.as_str()),
        ("r.toml", &quotient),
    ];
    let r = saved(&files, "r.toml");
    let power = r#"
        [measurand.P]
        model = "V^2 / R"
        unit = "mW"
        [input.V]
        from = { budget = "vi.toml", measurand = "V" }
        [input.R]
        from = { result = "r.json" }
    "#;
    let files = [
        files[0],
        files[1],
        files[2],
        ("r.json", &r),
        ("p.toml", power),
    ];
    let found = gum(&load(&files, "p.toml"));
    // P = V·I, whatever the way.
    let direct = READINGS.replace(
        "[measurand]",
        "[measurand]\nP = { model = \"E_V * E_I\", unit = \"mW\" }",
    );
    let direct = gum(&load(&[("direct.toml", &direct)], "direct.toml"));
    close(found.results[0].gum.u / direct.results[0].gum.u, 1.0, 1e-12);
}

const SERIES: &str = r#"
    [measurand.m]
    model = "x + e"
    unit = "g"
    [source.air]
    unit = "mg"
    u = 0.3
    [input.x]
    value = 0
    unit = "g"
    u = "0.1 mg"
    [input.e]
    value = 0
    unit = "mg"
    components = [{ source = "air" }]
    [series]
    columns = ["label", "x"]
    rows = [["one", 1.0], ["two", 2.0]]
"#;

#[test]
fn rows_of_a_series_share_their_sources_only() {
    let result = saved(&[("set.toml", SERIES)], "set.toml");
    for from in ["budget = \"set.toml\"", "result = \"set.json\""] {
        let top = format!(
            "[measurand.d]\nmodel = \"b - a\"\nunit = \"mg\"\n[input.a]\nfrom = {{ {from}, row = \"one\" }}\n[input.b]\nfrom = {{ {from}, row = \"two\" }}\n"
        );
        let files = [
            ("set.toml", SERIES),
            ("set.json", &result),
            ("top.toml", &top),
        ];
        let found = gum(&load(&files, "top.toml"));
        close(found.results[0].gum.estimate, 1000.0, 1e-9);
        close(found.results[0].gum.u, 0.1 * 2f64.sqrt(), 1e-12);
    }
    let top =
        "[measurand.d]\nmodel = \"a\"\nunit = \"g\"\n[input.a]\nfrom = { budget = \"set.toml\" }\n";
    let shown = refusal(&[("set.toml", SERIES), ("top.toml", top)], "top.toml");
    assert!(
        shown.contains("which row?") && shown.contains("one, two"),
        "{shown}"
    );
}

#[test]
fn a_budget_that_changed_since_its_result_was_saved_is_noticed() {
    let result = saved(&[("vi.toml", READINGS)], "vi.toml");
    let changed = READINGS.replace("4.999", "4.998");
    let quotient = quotient("budget = \"vi.toml\"", "result = \"vi.json\"");
    let files = [
        ("vi.toml", changed.as_str()),
        ("vi.json", &result),
        ("r.toml", &quotient),
    ];
    let shown = refusal(&files, "r.toml");
    assert!(
        shown.contains("B0706") && shown.contains("vi.toml has changed"),
        "{shown}"
    );
}

/// The parameters of a fit carry their covariance and their common ν along.
#[test]
fn parameters_of_a_fit_stay_correlated() {
    let fit = r#"
        [fit.line]
        model = "b = y1 + y2*t"
        [fit.line.data]
        t = { values = [1, 2, 3, 4, 5, 6], unit = "K" }
        b = { values = [2.1, 3.9, 6.2, 7.8, 10.1, 12.2], unit = "mV" }
        [fit.line.parameters]
        y1 = { unit = "mV" }
        y2 = { unit = "mV/K" }
    "#;
    let value = "[measurand.v]\nmodel = \"y1 + y2 * 7.5 'K'\"\nunit = \"mV\"\n";
    let direct = format!("{value}{fit}");
    let direct = gum(&load(&[("direct.toml", &direct)], "direct.toml"));
    let result = saved(&[("fit.toml", fit)], "fit.toml");
    for from in ["budget = \"fit.toml\"", "result = \"fit.json\""] {
        let top = format!(
            "{value}[input.y1]\nfrom = {{ {from}, measurand = \"y1\" }}\n[input.y2]\nfrom = {{ {from}, measurand = \"y2\" }}\n"
        );
        let files = [("fit.toml", fit), ("fit.json", &result), ("top.toml", &top)];
        let found = gum(&load(&files, "top.toml"));
        same(&found, &direct);
        close(found.results[0].gum.freedom.value(), 4.0, 1e-9);
    }
}

/// Another version of the program may round otherwise; that is no change of the file.
#[test]
fn another_rounding_is_no_change() {
    let result = saved(&[("vi.toml", READINGS)], "vi.toml");
    let mut document: serde_json::Value = serde_json::from_str(&result).expect("JSON");
    for component in document["components"].as_array_mut().expect("a list") {
        let u = component["standard_uncertainty"]
            .as_f64()
            .expect("a number");
        component["standard_uncertainty"] = (u * (1.0 + 3e-14)).into();
    }
    let rounded = document.to_string();
    let quotient = quotient("budget = \"vi.toml\"", "result = \"vi.json\"");
    let files = [
        ("vi.toml", READINGS),
        ("vi.json", rounded.as_str()),
        ("r.toml", &quotient),
    ];
    let found = gum(&load(&files, "r.toml"));
    close(found.results[0].gum.freedom.value(), 4.0, 1e-9);
}

#[test]
fn faults_of_the_other_file_are_shown_after_those_of_this_one() {
    let top = "[measurand.d]\nmodel = \"a\"\nunit = \"g\"\n[input.a]\nfrom = { budget = \"sub/bad.toml\" }\n";
    let bad = READINGS.replace("readings", "redings");
    let shown = refusal(&[("sub/bad.toml", &bad), ("top.toml", top)], "top.toml");
    let (first, second) = (
        shown.find("1 error in top.toml"),
        shown.find("in sub/bad.toml"),
    );
    assert!(first.is_some() && first < second, "{shown}");
    assert!(shown.contains("did you mean `readings`"), "{shown}");
}

#[test]
fn a_saved_result_that_is_not_validated_says_so() {
    let square = "[measurand.y]\nmodel = \"x^2\"\n[input.x]\nvalue = 0.1\nu = 1\n";
    let result = saved(&[("square.toml", square)], "square.toml");
    let top = "[measurand.z]\nmodel = \"y\"\n[input.y]\nfrom = { result = \"square.json\" }\n";
    let files = [
        ("square.toml", square),
        ("square.json", &result),
        ("top.toml", top),
    ];
    let budget = load(&files, "top.toml");
    assert!(
        budget
            .remarks
            .iter()
            .any(|r| r.to_string().contains("without validation by Monte Carlo")),
        "{:?}",
        budget.remarks
    );
}

/// Saved files have the fields of the schema, all of them and no others.
#[test]
fn saved_files_follow_their_schema() {
    let mut text: serde_json::Value =
        serde_json::from_str(&saved(&[("vi.toml", READINGS)], "vi.toml")).expect("JSON");
    let schema = budget::result_schema();
    follows(&text, &schema, "result");
    // What is not understood is refused rather than ignored.
    text["further"] = 1.into();
    let text = text.to_string();
    let top = quotient("result = \"vi.json\"", "result = \"vi.json\"");
    let shown = refusal(&[("vi.json", &text), ("top.toml", &top)], "top.toml");
    assert!(
        shown.contains("B0705") && shown.contains("further"),
        "{shown}"
    );
}

fn follows(value: &serde_json::Value, schema: &serde_json::Value, path: &str) {
    let Some(properties) = schema.get("properties").and_then(|p| p.as_object()) else {
        if let (Some(items), Some(schema)) = (value.as_array(), schema.get("items")) {
            items.iter().for_each(|item| follows(item, schema, path));
        }
        return;
    };
    let object = value
        .as_object()
        .unwrap_or_else(|| panic!("{path} is no object"));
    let closed = schema["additionalProperties"] == false;
    for (key, value) in object {
        match properties.get(key) {
            Some(schema) => follows(value, schema, &format!("{path}.{key}")),
            None => assert!(!closed, "{path}.{key} is not in the schema"),
        }
    }
    for key in schema["required"].as_array().into_iter().flatten() {
        let key = key.as_str().expect("a name");
        assert!(object.contains_key(key), "{path}.{key} is missing");
    }
}

/// A thread of a test has the smallest stack that is usual; a chain that is too long for it is refused.
#[test]
fn a_chain_has_an_end() {
    let budgets = |count: usize| -> Vec<(String, String)> {
        let input = |index: usize| match index + 1 < count {
            true => format!("from = {{ budget = \"{}.toml\" }}", index + 1),
            false => "value = 1, u = 0.1".to_owned(),
        };
        let text = |index| {
            format!(
                "title = \"c\"\n[measurand.Y]\nmodel = \"x\"\nunit = \"1\"\n[input]\nx = {{ {} }}\n",
                input(index)
            )
        };
        (0..count)
            .map(|index| (format!("{index}.toml"), text(index)))
            .collect()
    };
    let read = |count: usize| {
        let texts = budgets(count);
        let files: Vec<(&str, &[u8])> = texts
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_bytes()))
            .collect();
        gumption::read(gumption::Files::Library(&files), "0.toml").map(|read| read.len())
    };
    assert_eq!(read(33), Ok(1));
    let refused = read(3000).expect_err("too long").to_string();
    assert!(
        refused.contains("error[B0707]: more than 32 budgets"),
        "{refused}"
    );
}
