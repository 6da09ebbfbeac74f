//! What the program writes for machines is what its published schemas say, for every command and the whole library.

use std::collections::BTreeSet;
use std::path::PathBuf;

use serde_json::Value;

use crate::common::{self, cases};

/// The names that `gumption schema` takes.
fn names() -> Vec<String> {
    let (_, help) = cases::gumption(&common::root(), &["schema", "--help"]);
    let words = help
        .lines()
        .filter_map(|line| line.trim().strip_prefix("- "));
    let names = words.filter_map(|line| Some(line.split_once(':')?.0.to_string()));
    names.collect()
}

fn published(name: &str) -> PathBuf {
    common::root().join(format!("docs/{name}.schema.json"))
}

#[test]
fn every_schema_is_published_as_the_program_prints_it() {
    let names = names();
    assert!(names.len() >= 12, "{names:?}");
    let stale = names.iter().filter_map(|name| {
        let (good, schema) = cases::gumption(&common::root(), &["schema", name]);
        assert!(good, "{schema}");
        common::stale(&published(name), &schema)
    });
    common::assert_fresh(&stale.collect::<Vec<_>>());
    let files = common::files("docs", "json");
    let published = files.iter().filter_map(|path| {
        let name = path.file_name()?.to_str()?;
        name.strip_suffix(".schema.json").map(str::to_string)
    });
    assert_eq!(
        published.collect::<BTreeSet<_>>(),
        names.into_iter().collect::<BTreeSet<_>>()
    );
}

/// A published schema.
struct Schema {
    name: String,
    root: Value,
}

impl Schema {
    fn of(name: &str) -> Schema {
        let text = std::fs::read_to_string(published(name)).expect(name);
        Schema {
            name: name.to_string(),
            root: serde_json::from_str(&text).expect("JSON"),
        }
    }

    /// Fails where a value is not what the schema says.
    #[track_caller]
    fn holds(&self, value: &Value, what: &str) {
        if let Err(fault) = check(&self.root, &self.root, value) {
            panic!("{what}: not by {}: {fault}", self.name);
        }
    }
}

/// The part of JSON Schema that the published ones use; another keyword would be passed over in silence, and fails.
fn check(root: &Value, schema: &Value, value: &Value) -> Result<(), String> {
    let short = || value.to_string().chars().take(200).collect::<String>();
    for (keyword, stated) in schema.as_object().ok_or("a schema is an object")? {
        let good = match keyword.as_str() {
            "$schema" | "$id" | "title" | "description" | "definitions" | "default" => true,
            "$ref" => {
                let place = stated.as_str().unwrap_or_default().trim_start_matches('#');
                check(root, root.pointer(place).ok_or("a $ref to nothing")?, value)?;
                true
            }
            "anyOf" | "oneOf" => {
                let mut faults = Vec::new();
                let all = stated.as_array().ok_or("a list of schemas")?;
                faults.extend(all.iter().filter_map(|one| check(root, one, value).err()));
                if faults.len() == all.len() {
                    return Err(faults.join("\nor "));
                }
                true
            }
            "enum" => stated.as_array().is_some_and(|all| all.contains(value)),
            "const" => stated == value,
            "type" => match stated {
                Value::Array(all) => all.iter().any(|one| is_of(one, value)),
                one => is_of(one, value),
            },
            "minimum" => value
                .as_f64()
                .is_none_or(|x| x >= stated.as_f64().unwrap_or(x)),
            "exclusiveMinimum" => value.as_f64().is_none_or(|x| Some(x) > stated.as_f64()),
            "minItems" => value
                .as_array()
                .is_none_or(|v| Some(v.len() as u64) >= stated.as_u64()),
            "maxItems" => value
                .as_array()
                .is_none_or(|v| Some(v.len() as u64) <= stated.as_u64()),
            "items" => {
                for (place, item) in value.as_array().into_iter().flatten().enumerate() {
                    check(root, stated, item).map_err(|fault| format!("[{place}] {fault}"))?;
                }
                true
            }
            "required" => value.as_object().is_none_or(|object| {
                let mut names = stated
                    .as_array()
                    .into_iter()
                    .flatten()
                    .filter_map(Value::as_str);
                names.all(|name| object.contains_key(name))
            }),
            "properties" | "additionalProperties" => {
                let declared = schema.get("properties").and_then(Value::as_object);
                for (name, member) in value.as_object().into_iter().flatten() {
                    let own = declared.and_then(|declared| declared.get(name));
                    let by = match (own, keyword.as_str()) {
                        (own, "properties") => own,
                        (Some(_), _) => None,
                        (None, _) => Some(stated),
                    };
                    match by {
                        None | Some(Value::Bool(true)) => {}
                        Some(Value::Bool(false)) => {
                            return Err(format!("`{name}` is not declared"));
                        }
                        Some(by) => {
                            check(root, by, member).map_err(|fault| format!("{name}: {fault}"))?;
                        }
                    }
                }
                true
            }
            other => return Err(format!("the keyword {other} is not checked")),
        };
        if !good {
            return Err(format!("{keyword} {stated}: {}", short()));
        }
    }
    Ok(())
}

fn is_of(kind: &Value, value: &Value) -> bool {
    match kind.as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("number") => value.is_number(),
        Some("integer") => value.is_u64() || value.is_i64(),
        Some("boolean") => value.is_boolean(),
        Some("null") => value.is_null(),
        _ => false,
    }
}

/// One machine form, or several together.
fn each(value: Value) -> Vec<Value> {
    match value {
        Value::Array(all) => all,
        one => vec![one],
    }
}

fn relative(paths: &[PathBuf]) -> Vec<String> {
    paths.iter().map(|path| common::relative(path)).collect()
}

/// The JSON of a command on these files; `None` where it refuses them.
fn json(arguments: &[&str]) -> Option<Value> {
    let output = common::program()
        .current_dir(common::root())
        .args(arguments)
        .arg("--json")
        .output()
        .expect("the program runs");
    // 1 = what was asked for has a bad end, of which the JSON tells.
    let told = matches!(output.status.code(), Some(0 | 1));
    told.then(|| serde_json::from_slice(&output.stdout).expect("JSON"))
}

#[test]
fn what_differs_from_a_schema_is_found() {
    let schema = Schema::of("evaluation");
    let good = json(&["eval", "docs/examples/voltage-and-current.toml"]).expect("a result");
    schema.holds(&good, "an evaluation");
    let without = |name: &str| {
        let mut value = good.clone();
        value.as_object_mut().and_then(|object| object.remove(name));
        check(&schema.root, &schema.root, &value).is_err()
    };
    assert!(without("measurands") && without("format"));
    let mut more = good.clone();
    more["measurands"][0]["surplus"] = Value::from(1);
    assert!(check(&schema.root, &schema.root, &more).is_err());
}

#[test]
fn evaluations() {
    let schema = Schema::of("evaluation");
    let files = relative(&common::files("budgets", "toml"));
    let mut count = 0;
    for file in &files {
        let value = json(&["eval", "--trials", "2000", file]).expect(file);
        for one in each(value) {
            schema.holds(&one, file);
            count += 1;
        }
    }
    assert!(count >= files.len(), "{count}");
}

#[test]
fn saved_results() {
    let schema = Schema::of("result");
    let folder = cases::folder("schemas-saved");
    let file = common::root().join("docs/examples/voltage-and-current.toml");
    let (good, text) = cases::gumption(
        &folder,
        &["eval", &file.to_string_lossy(), "--save", "saved.json"],
    );
    assert!(good, "{text}");
    let saved = std::fs::read_to_string(folder.join("saved.json")).expect("written");
    schema.holds(&serde_json::from_str(&saved).expect("JSON"), "saved.json");
}

#[test]
fn calibrations_and_plans() {
    let [calibration, plan] = ["calibration-result", "calibration-plan"].map(Schema::of);
    let mut found = 0;
    for file in relative(&common::files("experiments", "toml")) {
        if let Some(value) = json(&["calibrate", &file]) {
            calibration.holds(&value, &file);
            found += 1;
        }
    }
    // Of a plan the work grows with what is left open: small ones.
    for file in [
        "experiments/tumble-plan.toml",
        "experiments/accelerometer-norm.toml",
        "experiments/gimbals-65-plan.toml",
        "experiments/gyro-scale-factor.toml",
    ] {
        plan.holds(&json(&["plan", file]).expect(file), file);
    }
    assert!(found > 10, "{found} calibrations");
}

#[test]
fn diagnoses_outlooks_and_grades() {
    let folder = cases::folder("schemas-diagnosis");
    common::bent_line(&folder);
    let diagnosis = cases::json(&folder, &["diagnose", "case.toml", "--json"]);
    Schema::of("diagnosis").holds(&diagnosis, "a diagnosis");
    let outlook = cases::json(&folder, &["plan", "case.toml", "--json"]);
    assert_eq!(outlook["format"], "gumption-outlook/1");
    Schema::of("outlook").holds(&outlook, "an outlook");
    let allan = cases::json(
        &folder,
        &[
            "allan",
            "recording.csv",
            "--column",
            "y",
            "--time",
            "t",
            "--json",
        ],
    );
    Schema::of("allan").holds(&allan, "a recording at rest");
}

#[test]
fn fleets() {
    let results = "docs/examples/fleet/results.csv";
    let schema = Schema::of("fleet");
    for more in [&[][..], &["--by", "type,laboratory", "--date", "date"]] {
        let arguments = [&["fleet", results, "--json"], more].concat();
        let found = cases::json(&common::root(), &arguments);
        schema.holds(&found, "a fleet");
    }
}

#[test]
fn audits() {
    let schema = Schema::of("audit");
    let value = json(&["audit", "docs/examples/claimed-budget.csv"]).expect("an audit");
    for one in each(value) {
        schema.holds(&one, "claimed-budget.csv");
    }
}

/// Sealed budgets are audited and graded, by the program and against its own seal.
#[test]
fn grades_of_budgets() {
    let folder = cases::folder("schemas-budgets");
    let made = [
        "challenge",
        "--audit",
        "--seed",
        "11",
        "--count",
        "12",
        "--out",
        "sealed",
    ];
    let (good, said) = cases::gumption(&folder, &made);
    assert!(good, "{said}");
    let case = folder.join("sealed/case");
    let mut arguments = vec!["audit".to_string()];
    for entry in std::fs::read_dir(&case).expect("a folder") {
        let name = entry.expect("a file").file_name();
        let name = name.to_string_lossy();
        if name.starts_with("budget-") {
            arguments.push(format!("sealed/case/{name}"));
        }
    }
    assert_eq!(arguments.len(), 13);
    let output = common::program()
        .current_dir(&folder)
        .args(&arguments)
        .arg("--json")
        .output()
        .expect("the program runs");
    std::fs::write(folder.join("answers.json"), &output.stdout).expect("written");
    let grades = cases::json(
        &folder,
        &["grade", "sealed", "--audit", "answers.json", "--json"],
    );
    Schema::of("sheet-grades").holds(&grades, "graded budgets");
    let exact = grades["exact"].as_u64().expect("a number");
    assert!(exact >= 9, "{grades}");
    // A sheet that was changed is not graded.
    let first = std::fs::read_dir(&case)
        .expect("a folder")
        .filter_map(Result::ok);
    let first = first
        .map(|entry| entry.path())
        .find(|path| path.to_string_lossy().contains("budget-"));
    std::fs::write(first.expect("a budget"), "changed").expect("written");
    let (good, said) = cases::gumption(&folder, &["grade", "sealed", "--audit", "answers.json"]);
    assert!(!good && said.contains("seal"), "{said}");
}

#[test]
fn verifications() {
    let schema = Schema::of("verification");
    let file = "budgets/electrical/resistor-10k-ea402-s3.toml";
    schema.holds(&json(&["verify", file]).expect("a verification"), file);
}
