//! Experiments with one mistake: a calibration says it, and never passes over what would change its result.

use std::path::Path;

use gumption::Files;
use gumption::calibrate::{calibrate, load_from, read};
use gumption::diagnose::case::{self, Case};
use gumption::experiment::Purpose;

const EXPERIMENT: &str = r#"
recording = { file = "rate.csv", average = "none" }
equations = "U = K*omega + b"

[columns]
U = "output"
omega = "stimulus"
T = "covariate"
run = "run"

[parameter.K]

[parameter.b]
"#;

const RECORDING: &str = "omega [deg/s],run,T [°C],uu [mV],U [mV]\n-10,1,20,0.1,-19\n0,1,21,0.1,1.1\n10,1,22,0.1,21\n-10,2,20,0.1,-19.1\n0,2,21,0.1,1\n10,2,22,0.1,20.9\n";

/// What is said of the experiment: the refusal, or the remarks.
fn said(campaign: &str) -> String {
    let folder = crate::common::folder("refusals");
    folder.put("rate.csv", RECORDING);
    match read(campaign, "rate.toml", &folder, Purpose::Calibrate) {
        Ok(campaign) => {
            let remarks = campaign.experiment.remarks.iter();
            remarks.map(ToString::to_string).collect()
        }
        Err(rejection) => rejection.to_string(),
    }
}

fn changed(from: &str, to: &str) -> String {
    assert!(EXPERIMENT.contains(from), "{from}");
    EXPERIMENT.replace(from, to)
}

#[test]
fn what_cannot_be_used_is_refused_with_what_to_write_instead() {
    let cases = [
        (
            changed("T = ", "Tx = "),
            "the recording has no column \"Tx\"",
        ),
        (
            changed("[parameter.b]\n", "[parameter.b]\nper = \"run\"\n"),
            "separately = \"run\"",
        ),
        (
            EXPERIMENT.to_owned() + "[noise]\nu = \"0.1 mV\"\nreplicates = [\"omega\"]\n",
            "stated by `u`, `replicates`",
        ),
        (
            changed("equations = ", "model = "),
            "`model` holds statements",
        ),
        (
            "recording = \"absent.csv\"\nequations = \"U = K*omega + b\"\n".to_owned(),
            "absent.csv",
        ),
    ];
    for (experiment, expected) in cases {
        let said = said(&experiment);
        assert!(said.contains(expected), "{experiment}\n{said}");
        assert!(!said.contains("no parameters"), "{said}");
    }
}

/// Where it is named, by every command, with the file that may be meant.
#[test]
fn a_recording_that_is_not_there_is_a_fault_of_the_experiment() {
    for said in both(&changed("rate.csv", "rte.csv")) {
        let Err(said) = said else {
            panic!("there is no such file");
        };
        assert!(said.contains("there is no file"), "{said}");
        assert!(said.contains("recording = { file = \"rte.csv\""), "{said}");
        assert!(said.contains("did you mean \"rate.csv\"?"), "{said}");
    }
}

#[test]
fn what_only_a_diagnosis_uses_is_remarked_on() {
    assert_eq!(said(EXPERIMENT), "");
    // A column of standard uncertainties is used, but not where rows are averaged.
    let column = changed("T = ", "uu = \"u\"\nT = ");
    assert_eq!(said(&column), "");
    let averaged = column.replace("average = \"none\"", "steps = \"omega\", fewest = 1");
    assert!(
        said(&averaged).contains("`u` of the column uu"),
        "{}",
        said(&averaged)
    );
    let walk = EXPERIMENT.to_owned() + "[noise]\nu = \"0.1 mV\"\nwalk = \"0.1 mV\"\n";
    assert!(said(&walk).contains("`walk` of [noise]"), "{}", said(&walk));
}

/// What `calibrate` and what `diagnose` say of the experiment, from files in memory.
fn both(experiment: &str) -> [Result<(), String>; 2] {
    let files = [
        ("rate.csv", RECORDING.as_bytes()),
        ("rest.csv", b"U [mV]\n0.1\n-0.1\n0.1\n-0.1\n0\n".as_slice()),
        ("rate.toml", experiment.as_bytes()),
    ];
    let (files, path) = (Files::Library(&files), Path::new("rate.toml"));
    let calibration = load_from(files, path, Purpose::Calibrate);
    let diagnosis = Case::load_from(files, path, case::Purpose::Diagnosis);
    [calibration.err(), diagnosis.err()].map(|rejection| match rejection {
        None => Ok(()),
        Some(rejection) => Err(rejection.to_string()),
    })
}

#[test]
fn every_command_refuses_the_same_mistakes() {
    assert_eq!(both(EXPERIMENT), [Ok(()), Ok(())]);
    let without = |table: &str| EXPERIMENT.replace("[parameter.K]\n\n[parameter.b]\n", table);
    assert_eq!(both(&without("")), [Ok(()), Ok(())]);
    let cases = [
        // A misspelt name is no parameter.
        (
            without("").replace("K*omega", "K*omgea"),
            "did you mean `omega`?",
        ),
        (
            changed(
                "omega = \"stimulus\"",
                "omega = { role = \"stimulus\", like = \"kg\" }",
            ),
            "deg/s",
        ),
        (
            changed("T = \"covariate\"", "T = \"covariate\"\nmass = \"ignore\"")
                .replace("+ b", "+ b*mass"),
            "to be ignored",
        ),
        (
            changed("average = \"none\"", "dwells = [\"omega\"]"),
            "steps = \"omega\"",
        ),
        (
            changed(
                "[parameter.b]\n",
                "[parameter.b]\nvalue = \"1.5 mV\"\nu = 0.1\n",
            ),
            "in which unit?",
        ),
        (
            changed("[parameter.b]\n", "[parameter.b]\nvalue = \"1.5 mV\"\n"),
            "without `u`",
        ),
        (
            EXPERIMENT.to_owned() + "[noise]\nu = 0.1\nat_rest = { file = \"rest.csv\" }\n",
            "stated by `u`, `at_rest`",
        ),
        (
            EXPERIMENT.to_owned() + "[noise]\nfrom = \"residuals\"\nwalk = 0.1\n",
            "`walk` goes with `u`",
        ),
        (
            EXPERIMENT
                .replace(
                    "\"U = K*omega + b\"",
                    "[\"U = K*omega + b\", \"T = a*omega + d\"]",
                )
                .replace("T = \"covariate\"", "T = \"output\"")
                + "[parameter.a]\n[parameter.d]\n[noise]\nu = 0.1\n",
            "the noise has no unit",
        ),
        (
            EXPERIMENT.to_owned() + "[noise]\nu = \"0.05 %\"\n",
            "is a share of each reading",
        ),
        (
            changed("U = K*omega + b", "U = K*omega + b*U"),
            "on both sides",
        ),
        (
            changed("U = K*omega + b", "ln(U) = K*omega + b"),
            "the left side of an equation is no formula",
        ),
        (
            changed("U = K*omega + b", "V = K*omega + b"),
            "did you mean `U`?",
        ),
        (
            changed("U = K*omega + b", "the output = K*omega + b"),
            "write the_output, and below [columns]",
        ),
        (
            EXPERIMENT.to_owned() + "[noise]\nresolution = \"0.1 mV\"\n",
            "the step of a display stands with its column",
        ),
    ];
    // What a diagnosis is told of some of its parameters it need not be told of all; a calibration lists all or none.
    let [calibrated, diagnosed] = both(&changed("K*omega + b", "K*omega + b + c"));
    assert!(calibrated.is_err_and(|said| said.contains("c is neither a parameter")));
    assert_eq!(diagnosed, Ok(()));
    for (experiment, expected) in cases {
        for said in both(&experiment) {
            let said = said.expect_err(&experiment);
            assert!(said.contains(expected), "{experiment}\n{said}");
        }
    }
}

#[test]
fn a_measured_noise_is_an_error_of_the_readings() {
    let noise = |noise: &str| {
        let experiment = format!("{EXPERIMENT}[noise]\n{noise}\n");
        assert_eq!(both(&experiment), [Ok(()), Ok(())], "{noise}");
        let files = [
            ("rate.csv", RECORDING.as_bytes()),
            ("rest.csv", b"U [mV]\n0.1\n-0.1\n0.1\n-0.1\n0\n".as_slice()),
            ("rate.toml", experiment.as_bytes()),
        ];
        let path = Path::new("rate.toml");
        let campaign = load_from(Files::Library(&files), path, Purpose::Calibrate)
            .unwrap_or_else(|rejection| panic!("{rejection}"));
        let found = calibrate(&campaign).expect("coefficients");
        assert!(found.figures.coefficients.iter().all(|one| one.u > 0.0));
        let doubt = &campaign.experiment.doubts[0];
        (doubt.u, doubt.dof)
    };
    // Pairs of readings that differ by 0.1 mV: s² = 3 · 0.1²/2 / 3.
    let (u, dof) = noise("replicates = [\"omega\"]");
    assert!(
        (u - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12 && dof == 3.0,
        "{u} {dof}"
    );
    // Rows without a temperature agree with none; those at 20 °C, 21 °C and 22 °C are the same pairs.
    let without = RECORDING.to_owned() + "5,1,,0.1,11\n-5,2,,0.1,-9\n";
    let experiment = format!("{EXPERIMENT}[noise]\nreplicates = [\"T\"]\n");
    let files = [
        ("rate.csv", without.as_bytes()),
        ("rate.toml", experiment.as_bytes()),
    ];
    let campaign = load_from(
        Files::Library(&files),
        Path::new("rate.toml"),
        Purpose::Calibrate,
    )
    .unwrap_or_else(|rejection| panic!("{rejection}"));
    let doubt = &campaign.experiment.doubts[0];
    assert!((doubt.u - u).abs() < 1e-12 && doubt.dof == 3.0, "{doubt:?}");
    // Four readings of ±0.1 mV about 0 and one of 0.
    let (u, dof) = noise("at_rest = { file = \"rest.csv\" }");
    assert!((u - 0.1).abs() < 1e-12 && dof == 4.0, "{u} {dof}");
}

#[test]
fn an_equation_that_cannot_be_read_is_told_before_its_parameters_are_asked_for() {
    let unlisted = EXPERIMENT
        .replace("[parameter.K]", "")
        .replace("[parameter.b]", "");
    assert_eq!(said(&unlisted), "");
    let said = said(&unlisted.replace("K*omega", "K*ln(omega/(1 deg/s))"));
    assert!(said.contains("M0104"), "{said}");
    assert!(!said.contains("[parameter]"), "{said}");
}
