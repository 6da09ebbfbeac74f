//! Layouts and sentences, read as a user would read them; the machine form against its schema.

use serde_json::Value;
use unicode_width::UnicodeWidthStr;

use super::fixtures::{self, Case};
use super::{Language, Report, evaluation, evaluation_schema, evaluations, statement};
use gumption_format::render::{self, Page};
use gumption_gum::budget::{CoverageRule, StatementForm};
use gumption_gum::propagate::{Consequence, FindingKind, MissingMoments, Side};

fn text(report: &Report<'_>, page: Page) -> String {
    render::text::text(&evaluation(report), page)
}

fn markdown(report: &Report<'_>) -> String {
    render::markdown::markdown(&evaluation(report))
}

fn json(report: &Report<'_>) -> Value {
    evaluation(report).machine.value()
}

fn page(width: usize) -> Page {
    Page {
        width,
        styled: false,
    }
}

fn all() -> Vec<(&'static str, Case)> {
    vec![
        ("resistor", fixtures::resistor()),
        ("plain", fixtures::plain()),
        ("fixed_factor", fixtures::fixed_factor()),
        ("fixed_with_probability", fixtures::fixed_with_probability()),
        ("apart_with_probability", fixtures::apart_with_probability()),
        ("apart_rectangular", fixtures::apart_rectangular()),
        ("refused_freedom", fixtures::refused_freedom()),
        ("rectangular", fixtures::rectangular()),
        ("asymmetric", fixtures::asymmetric()),
        ("from_trials", fixtures::from_trials()),
        ("from_trials_apart", fixtures::from_trials_apart()),
        ("fixed_unconfirmed", fixtures::fixed_unconfirmed()),
        ("without_moments", fixtures::without_moments()),
        ("joint", fixtures::joint()),
        ("long", fixtures::long()),
    ]
}

#[test]
fn text_in_english() {
    for (name, case) in all() {
        // The others differ in their statements only.
        if !["apart", "fixed_", "from_"]
            .iter()
            .any(|start| name.starts_with(start))
            || name == "fixed_factor"
        {
            insta::assert_snapshot!(
                format!("text_{name}"),
                text(&case.report(Language::English), page(100))
            );
        }
    }
}

#[test]
fn text_in_chinese() {
    for (name, case) in [
        ("resistor", fixtures::resistor()),
        ("asymmetric", fixtures::asymmetric()),
        ("joint", fixtures::joint()),
        ("refused_freedom", fixtures::refused_freedom()),
    ] {
        insta::assert_snapshot!(
            format!("zh_{name}"),
            text(&case.report(Language::Chinese), page(100))
        );
    }
}

#[test]
fn text_on_eighty_columns() {
    insta::assert_snapshot!(
        "narrow_resistor",
        text(&fixtures::resistor().report(Language::English), page(80))
    );
}

#[test]
fn no_line_is_wider_than_the_page() {
    for (name, case) in all() {
        for language in [Language::English, Language::Chinese] {
            for width in [100, 90, 80] {
                for line in text(&case.report(language), page(width)).lines() {
                    assert!(line.width() <= width, "{name}, {width}: {line}");
                }
            }
        }
    }
}

#[test]
fn markdown_in_english() {
    insta::assert_snapshot!(
        "markdown_resistor",
        markdown(&fixtures::resistor().report(Language::English))
    );
}

#[test]
fn statements_of_every_branch() {
    let mut lines = Vec::new();
    for (name, case) in all() {
        for language in [Language::English, Language::Chinese] {
            lines.push(format!("{name}:"));
            lines.extend(statement(&case.report(language)));
        }
    }
    insta::assert_snapshot!("statements", lines.join("\n"));
}

/// JJF 1059.1 5.3: U with k = 2, and no probability, also where Monte Carlo is the basis.
#[test]
fn a_fixed_factor_without_probability_stays_with_monte_carlo() {
    let is_half_interval = |case: &Case| {
        statement(&case.report(Language::English))[0].contains("half the width of the 95 %")
    };
    let (_, mut case) = all()
        .into_iter()
        .find(|(_, case)| is_half_interval(case))
        .expect("a fixture");
    case.budget.conventions.profile = "JJF".into();
    case.budget.conventions.statement = StatementForm::Apart;
    case.budget.conventions.coverage_factor = CoverageRule::Fixed(2.0);
    case.budget.conventions.state_probability = false;
    case.evaluation.results[0].gum.u = 0.0005;
    let sentence = &statement(&case.report(Language::Chinese))[0];
    assert!(sentence.contains("，k = 2。"), "{sentence}");
    assert!(!sentence.contains("k_95"), "{sentence}");
}

/// A t-distribution of 2.7 degrees of freedom has a standard deviation (JCGM 101, 6.4.9.4), which trials do not settle on.
#[test]
fn a_standard_deviation_that_exists_is_not_denied() {
    let mut case = fixtures::without_moments();
    assert!(statement(&case.report(Language::Chinese))[0].contains("标准差不存在"));
    for finding in &mut case.evaluation.findings {
        if let FindingKind::MomentsMissing { reason } = &mut finding.kind {
            *reason = MissingMoments::Tail {
                side: Side::Upper,
                index: 2.7,
                consequence: Consequence::SlowDeviation,
            };
        }
    }
    let english = &statement(&case.report(Language::English))[0];
    assert!(
        english.contains("does not converge") && !english.contains("no standard deviation"),
        "{english}"
    );
    let chinese = &statement(&case.report(Language::Chinese))[0];
    assert!(
        chinese.contains("不收敛") && !chinese.contains("不存在"),
        "{chinese}"
    );
}

/// U and y end at the same decimal place, whatever the profile.
#[test]
fn estimate_and_expanded_uncertainty_end_at_the_same_place() {
    let sentence = &statement(&fixtures::resistor().report(Language::English))[0];
    assert!(
        sentence.starts_with("I = (9.9995 ± 0.0020) mA."),
        "{sentence}"
    );
    let sentence = &statement(&fixtures::rectangular().report(Language::English))[0];
    assert!(
        sentence.starts_with("K1 = (0.002612340 ± 0.000000024) A/g."),
        "{sentence}"
    );
}

#[test]
fn a_one_sided_result_never_pretends_symmetry() {
    for case in [fixtures::asymmetric(), fixtures::without_moments()] {
        for language in [Language::English, Language::Chinese] {
            let sentence = statement(&case.report(language)).join(" ");
            assert!(!sentence.contains('±'), "{sentence}");
        }
    }
}

#[test]
fn a_rounded_down_uncertainty_is_raised_where_the_profile_asks() {
    let mut case = fixtures::plain();
    case.budget.conventions.digits = 1;
    case.evaluation.results[0].gum.coverage.expanded = 0.00144;
    let down = statement(&case.report(Language::English))[0].clone();
    assert!(down.starts_with("m = (1.235 ± 0.001) kg."), "{down}");
    case.budget.conventions.up_if_lowered_by_5_percent = true;
    let up = statement(&case.report(Language::English))[0].clone();
    assert!(up.starts_with("m = (1.235 ± 0.002) kg."), "{up}");
}

#[test]
fn a_series_is_one_table() {
    let cases = [
        fixtures::plain(),
        fixtures::plain(),
        fixtures::fixed_factor(),
    ];
    let rows: Vec<Report<'_>> = cases
        .iter()
        .zip(["run 1", "run 2", "run 3"])
        .map(|(case, label)| Report {
            label: Some(label),
            ..case.report(Language::English)
        })
        .collect();
    let series = evaluations(&rows, 0).expect("rows");
    insta::assert_snapshot!("series", render::text::text(&series, page(100)));
}

#[test]
fn styles_only_where_they_are_wanted() {
    let case = fixtures::plain();
    let report = case.report(Language::English);
    assert!(!text(&report, page(100)).contains('\x1b'));
    assert!(
        text(
            &report,
            Page {
                width: 100,
                styled: true
            }
        )
        .contains("\x1b[1m")
    );
}

#[test]
fn the_machine_form_is_what_its_schema_says() {
    let schema = evaluation_schema();
    for (name, case) in all() {
        let value = json(&case.report(Language::English));
        if let Err(fault) = check(&schema, &schema, &value) {
            panic!("{name}: {fault}");
        }
        if let Err(fault) = check(&schema, &schema, &Value::Array(vec![value.clone()])) {
            panic!("{name}: {fault}");
        }
        let mut wrong = value;
        wrong["measurands"][0]["gum"]["estimate"] = Value::from("much");
        assert!(check(&schema, &schema, &wrong).is_err());
    }
}

#[test]
fn numbers_survive_the_machine_form() {
    let case = fixtures::resistor();
    let printed = json(&case.report(Language::English)).to_string();
    let read: Value = serde_json::from_str(&printed).unwrap();
    let gum = &case.evaluation.results[0].gum;
    assert_eq!(
        read["measurands"][0]["gum"]["standard_uncertainty"].as_f64(),
        Some(gum.u)
    );
    assert_eq!(
        read["measurands"][0]["gum"]["inputs"][1]["degrees_of_freedom"],
        "inf"
    );
    assert_eq!(read["format"], "gumption-evaluation/1");
    assert_eq!(read["claims"][0]["comparison"][0]["agrees"], true);
}

#[test]
fn the_published_schema_is_up_to_date() {
    assert_published("evaluation", &evaluation_schema());
}

/// `docs/NAME.schema.json` is generated: set GUMPTION_UPDATE=1 to write it anew.
pub(super) fn assert_published(name: &str, schema: &Value) {
    let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");
    let path = format!("{docs}/{name}.schema.json");
    let generated = format!("{schema:#}\n");
    if std::env::var_os("GUMPTION_UPDATE").is_some() {
        std::fs::write(&path, &generated).unwrap();
    }
    let published = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        published == generated,
        "run the tests once with GUMPTION_UPDATE=1 to write {path}"
    );
}

/// The part of JSON Schema that machine forms use.
pub(super) fn check(root: &Value, schema: &Value, value: &Value) -> Result<(), String> {
    let fault = |what: &str| Err(format!("{what}: {value} against {schema}"));
    if let Some(reference) = schema.get("$ref").and_then(Value::as_str) {
        return check(
            root,
            root.pointer(reference.trim_start_matches('#'))
                .ok_or("dangling $ref")?,
            value,
        );
    }
    if let Some(options) = schema.get("anyOf").and_then(Value::as_array) {
        let faults: Vec<String> = options
            .iter()
            .filter_map(|o| check(root, o, value).err())
            .collect();
        return if faults.len() < options.len() {
            Ok(())
        } else {
            Err(faults.join("\nor "))
        };
    }
    if let Some(values) = schema.get("enum").and_then(Value::as_array) {
        return if values.contains(value) {
            Ok(())
        } else {
            fault("not one of the values")
        };
    }
    match schema.get("type").and_then(Value::as_str) {
        Some("string") if !value.is_string() => fault("no string"),
        Some("boolean") if !value.is_boolean() => fault("no boolean"),
        Some("number") if !value.is_number() => fault("no number"),
        Some("integer") if !value.is_u64() => fault("no count"),
        Some("null") if !value.is_null() => fault("not null"),
        Some("array") => {
            let Some(items) = value.as_array() else {
                return fault("no array");
            };
            items
                .iter()
                .try_for_each(|item| check(root, &schema["items"], item))
        }
        Some("object") => {
            let Some(map) = value.as_object() else {
                return fault("no object");
            };
            let Some(properties) = schema["properties"].as_object() else {
                let own = &schema["additionalProperties"];
                return map.values().try_for_each(|item| check(root, own, item));
            };
            for required in schema["required"].as_array().into_iter().flatten() {
                if !map.contains_key(required.as_str().unwrap_or_default()) {
                    return Err(format!("{required} is missing"));
                }
            }
            map.iter()
                .try_for_each(|(key, item)| match properties.get(key) {
                    Some(schema) => check(root, schema, item).map_err(|e| format!("{key}: {e}")),
                    None => Err(format!("{key} is not in the schema")),
                })
        }
        _ => Ok(()),
    }
}
