//! What calibrations, diagnoses and their plans say to machines, against the published schemas.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::tests::{assert_published, check};
use super::{
    Language, calibration, calibration_schema, diagnosis, diagnosis_schema, outlook,
    outlook_schema, plan, plan_schema,
};
use gumption_format::document::Document;
use gumption_lab::calibrate::{self};
use gumption_lab::diagnose::{self, case};
use gumption_lab::experiment::Purpose;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    files.sort();
    files
}

fn holds(schema: &Value, document: &Document, file: &Path) {
    if let Err(fault) = check(schema, schema, &document.machine.value()) {
        panic!("{}: {fault}", file.display());
    }
}

#[test]
fn calibrations_and_their_plans_are_what_their_schemas_say() {
    let (of_calibration, of_plan) = (calibration_schema(), plan_schema());
    let (mut found, mut planned) = (0, 0);
    for file in files("experiments") {
        for language in [Language::English, Language::Chinese] {
            // Some are plans, some have nothing to plan with, and some leave coefficients open.
            if let Ok(experiment) = calibrate::load(&file, Purpose::Calibrate)
                && let Ok(result) = calibrate::calibrate(&experiment)
            {
                holds(
                    &of_calibration,
                    &calibration(&experiment, &result, language),
                    &file,
                );
                found += 1;
            }
            if let Ok(experiment) = calibrate::load(&file, Purpose::Plan)
                && let Ok(result) = calibrate::plan(&experiment)
            {
                holds(&of_plan, &plan(&experiment, &result, language), &file);
                planned += 1;
            }
        }
    }
    assert!(found > 10 && planned > 10);
}

#[test]
fn diagnoses_and_their_plans_are_what_their_schemas_say() {
    let go_on = |_| ControlFlow::Continue(());
    let (of_diagnosis, of_outlook) = (diagnosis_schema(), outlook_schema());
    let mut checked = 0;
    for name in ["tumble_table_1", "loadcell_pontius", "mpu9150_tumble"] {
        let file = root().join(format!("experiments/{name}.toml"));
        // Some recordings do not lie beside the program.
        let Ok(case) = case::Case::load(&file, case::Purpose::Diagnosis) else {
            continue;
        };
        checked += 1;
        let found = diagnose::diagnose(&case, &go_on).unwrap();
        let document = diagnosis(&case, &found, Language::English);
        holds(&of_diagnosis, &document, &file);
        assert!(document.plots().count() > 0);
        let planned = diagnose::plan(&case, &go_on).unwrap();
        holds(
            &of_outlook,
            &outlook(&case, &planned, Language::English),
            &file,
        );
    }
    assert!(checked > 0);
}

#[test]
fn the_published_schemas_are_up_to_date() {
    for (name, schema) in [
        ("calibration-result", calibration_schema()),
        ("calibration-plan", plan_schema()),
        ("diagnosis", diagnosis_schema()),
        ("outlook", outlook_schema()),
    ] {
        assert_published(name, &schema);
    }
}
