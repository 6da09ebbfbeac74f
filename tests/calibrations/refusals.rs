//! Experiments with one mistake: a calibration says it, and never passes over what would change its result.

use std::path::Path;

use gumption::calibrate::{Purpose, read};

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
fn said(experiment: &str) -> String {
    let folder = std::env::temp_dir().join(format!("gumption-refusals-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("rate.csv"), RECORDING).expect("written");
    outcome(experiment, &folder)
}

fn outcome(experiment: &str, folder: &Path) -> String {
    match read(experiment, "rate.toml", folder, Purpose::Calibrate) {
        Ok(experiment) => {
            let remarks = experiment.remarks.iter();
            remarks.map(|remark| remark.en.as_str()).collect()
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
        (changed("T = ", "Tx = "), "the recording has no column Tx"),
        (
            changed("[parameter.b]\n", "[parameter.b]\nper = \"run\"\n"),
            "separately = \"run\"",
        ),
        (
            EXPERIMENT.to_owned() + "[noise]\nu = \"0.1 mV\"\nreplicates = [\"omega\"]\n",
            "stated by `u` and `replicates`",
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

#[test]
fn what_only_a_diagnosis_uses_is_remarked_on() {
    assert_eq!(said(EXPERIMENT), "");
    let column = changed("T = ", "uu = \"u\"\nT = ");
    assert!(
        said(&column).contains("`u` of the column uu"),
        "{}",
        said(&column)
    );
    let walk = EXPERIMENT.to_owned() + "[noise]\nu = \"0.1 mV\"\nwalk = \"0.1 mV\"\n";
    assert!(said(&walk).contains("`walk` of [noise]"), "{}", said(&walk));
}
