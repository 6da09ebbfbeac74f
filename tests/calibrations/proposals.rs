//! What `gumption new --recording` proposes of recordings that were made for something else.

use std::path::Path;

use gumption::experiment::procedure::procedure_named;
use gumption::experiment::{Purpose, proposal};
use gumption::language::Language;
use gumption::{Files, calibrate};

use crate::common::{program, root};

/// The recordings of `experiments/`, and the data of published fits.
fn recordings() -> Vec<(String, String)> {
    let folders = ["experiments", "budgets/fits", "docs/examples/calibration"];
    let mut found = Vec::new();
    for folder in folders {
        for entry in std::fs::read_dir(root().join(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|ending| ending == "csv") {
                let name = path
                    .file_name()
                    .expect("a name")
                    .to_string_lossy()
                    .into_owned();
                found.push((name, std::fs::read_to_string(&path).expect("a text")));
            }
        }
    }
    found.sort();
    found
}

/// Each is an experiment without a fault, and its lines are fitted.
#[test]
fn every_proposal_is_calibrated_as_it_is() {
    let recordings = recordings();
    assert!(recordings.len() > 10);
    for (name, recording) in &recordings {
        let text = proposal(name, recording, None, Language::English)
            .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
        let files: &[(&str, &[u8])] =
            &[(name, recording.as_bytes()), ("run.toml", text.as_bytes())];
        let campaign = calibrate::load_from(
            Files::Library(files),
            Path::new("run.toml"),
            Purpose::Calibrate,
        )
        .unwrap_or_else(|rejection| panic!("{name}\n{text}\n{}", rejection.render(false)));
        let found = calibrate::calibrate(&campaign);
        assert!(found.is_ok(), "{name}\n{text}\n{:?}", found.err());
    }
}

/// The recording of a procedure's own example, whose columns have the names of the procedure.
#[test]
fn a_procedure_finds_its_columns() {
    let recording = std::fs::read_to_string(root().join("experiments/gyro-scale-factor.csv"));
    let recording = recording.expect("a text");
    let procedure = procedure_named("gyro-scale-factor");
    let text = proposal("run.csv", &recording, procedure, Language::English).expect("a table");
    let files: &[(&str, &[u8])] = &[
        ("run.csv", recording.as_bytes()),
        ("run.toml", text.as_bytes()),
    ];
    let path = Path::new("run.toml");
    let campaign = calibrate::load_from(Files::Library(files), path, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{text}\n{}", rejection.render(false)));
    assert!(calibrate::calibrate(&campaign).is_ok());
}

/// The file is written beside other files, names the recording from its own folder, and replaces nothing.
#[test]
fn the_command_writes_what_calibrate_reads() {
    let folder = crate::common::cases::folder("proposal");
    let below = folder.join("below");
    std::fs::create_dir(&below).expect("a folder");
    let line = "load [N],deflection [mm]\n0,0.01\n10,1.02\n0,0.00\n10,1.01\n20,2.02\n20,2.01\n";
    std::fs::write(folder.join("run.csv"), line).expect("written");
    let run = |arguments: &[&str]| {
        let output = program().args(arguments).current_dir(&folder).output();
        output.expect("the program runs")
    };
    for file in ["experiment.toml", "below/other.toml"] {
        let written = run(&["new", "--recording", "run.csv", file]);
        assert!(written.status.success(), "{written:?}");
        let calibrated = run(&["calibrate", file]);
        let said = String::from_utf8_lossy(&calibrated.stdout).into_owned();
        assert!(
            calibrated.status.success() && said.contains("0.10"),
            "{calibrated:?}"
        );
    }
    assert!(!run(&["new", "--recording", "run.csv"]).status.success());
    let unknown = run(&[
        "new",
        "--recording",
        "run.csv",
        "--procedure",
        "gyro-scale",
        "-",
    ]);
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("gyro-scale-factor"));
}

/// Humidity and pressure that were recorded as they were are nobody's stimulus, whatever few values their digits leave.
#[test]
fn the_air_of_the_laboratory_is_a_condition() {
    use std::fmt::Write;
    let mut recording = "t [h],T_lab [°C],rh [%],p [hPa],m [mg]\n".to_owned();
    for row in 0..40 {
        let (hour, wave) = (f64::from(row), libm::sin(0.31 * f64::from(row)));
        let (bath, moisture, air) = (
            20.0 + 0.3 * wave,
            (48.0 + 6.0 * wave).round(),
            1008.3 + 4.1 * wave + 0.13 * hour,
        );
        let mass = 1.2034 + 1e-4 * libm::sin(2.7 * hour);
        let _ = writeln!(recording, "{hour},{bath:.1},{moisture},{air:.1},{mass:.4}");
    }
    let text = proposal("check.csv", &recording, None, Language::English).expect("a table");
    for line in ["rh = \"covariate\"", "p = \"covariate\"", "m = \"output\""] {
        assert!(text.contains(line), "{text}");
    }
}
