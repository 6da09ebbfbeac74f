//! Real recordings, where they are at hand.

use std::path::{Path, PathBuf};

use crate::recording::{
    Average, Checks, Drift, Recording, Request, Severity, Steps, by_label, by_steps, check,
};
use gumption_core::quantity::UnitTable;

/// The folder, beside the project or one further up.
fn folder() -> Option<PathBuf> {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let places = ["../shared/recordings", "../../shared/recordings"];
    let found = places
        .iter()
        .map(|place| root.join(place))
        .find(|place| place.is_dir());
    if found.is_none() {
        eprintln!("SKIPPED: no folder ../shared/recordings");
    }
    found
}

fn open(folder: &Path, file: &str) -> Recording {
    let text = std::fs::read_to_string(folder.join(file)).expect("a file of the folder");
    match Recording::read_all(file, &text, &UnitTable::default()) {
        Ok(recording) => recording,
        Err(rejection) => panic!("{}", rejection.render(false)),
    }
}

/// File, rows, and units of some columns by role.
type Expected = (&'static str, usize, &'static [(&'static str, &'static str)]);
const FILES: &[Expected] = &[
    ("acoustic_microscope_hsu.csv", 750, &[]),
    (
        "dmm_tempco_1V.csv",
        1578,
        &[
            ("time", "h"),
            ("dut_temp", "°C"),
            ("ch1_error", "ppm"),
            ("ambient", "°C"),
        ],
    ),
    ("loadcell_pontius.csv", 40, &[]),
    (
        "mpu9150_tumble_units_0_1.csv",
        45,
        &[("acc_x", "m/s^2"), ("gyro_z", "rad/s"), ("t_mean", "s")],
    ),
    (
        "oil_drop_millikan.csv",
        58,
        &[("temp", "°C"), ("voltage", "V"), ("fall_time", "s")],
    ),
    (
        "resistor_tc_lag_vhd200.csv",
        2820,
        &[("resistance", "Ω"), ("oven", "°C")],
    ),
    (
        "resistor_tc_settling_ultrohm.csv",
        2040,
        &[("resistance", "Ω"), ("time", "h")],
    ),
    ("standard_resistor_dziuba.csv", 1000, &[]),
    (
        "wafer_resistivity_mpc61.csv",
        300,
        &[("resistivity", "Ω·cm"), ("temp", "°C")],
    ),
    (
        "xsens_tumble_accel.csv",
        37,
        &[("acc_x", "counts"), ("acc_z", "counts"), ("t_mean", "s")],
    ),
];

#[test]
fn every_file_is_read_and_sound() {
    let Some(folder) = folder() else { return };
    for (file, rows, units) in FILES {
        let recording = open(&folder, file);
        assert_eq!(recording.rows(), *rows, "{file}");
        for (role, unit) in *units {
            let column = recording
                .column(role)
                .unwrap_or_else(|| panic!("{file}: {role}"));
            assert_eq!(
                column.unit.as_ref().map(|unit| unit.symbol.as_str()),
                Some(*unit),
                "{file}: {role}"
            );
        }
        let outputs: Vec<&str> = recording
            .columns
            .iter()
            .map(|column| column.role.as_str())
            .collect();
        let checks = Checks {
            time: Some("time"),
            outputs: &[],
            ranges: &[],
            dwells: &[],
            expected: None,
            fewest: 4,
        };
        let findings = check(&recording, &checks);
        let grave: Vec<String> = findings
            .iter()
            .filter(|finding| finding.severity() == Severity::Error)
            .map(|finding| finding.said().to_string())
            .collect();
        assert!(grave.is_empty() && !outputs.is_empty(), "{file}: {grave:?}");
    }
}

#[test]
fn outputs_of_the_recordings_are_not_saturated() {
    let Some(folder) = folder() else { return };
    for (file, outputs) in [
        ("xsens_tumble_accel.csv", &["acc_x", "acc_y", "acc_z"][..]),
        (
            "mpu9150_tumble_units_0_1.csv",
            &["acc_x", "acc_y", "acc_z", "gyro_x"],
        ),
        ("resistor_tc_lag_vhd200.csv", &["resistance"]),
        ("resistor_tc_settling_ultrohm.csv", &["resistance"]),
        ("dmm_tempco_1V.csv", &["ch1_error", "ch2_error"]),
        ("loadcell_pontius.csv", &["deflection"]),
        ("acoustic_microscope_hsu.csv", &["time_as_source"]),
        ("standard_resistor_dziuba.csv", &["resistance_as_source"]),
        ("wafer_resistivity_mpc61.csv", &["resistivity"]),
    ] {
        let checks = Checks {
            time: None,
            outputs,
            ranges: &[],
            dwells: &[],
            expected: None,
            fewest: 0,
        };
        let findings = check(&open(&folder, file), &checks);
        let of_outputs: Vec<String> = findings
            .iter()
            .filter(|finding| finding.severity() > Severity::Note)
            .map(|finding| finding.said().to_string())
            .collect();
        assert!(of_outputs.is_empty(), "{file}: {of_outputs:?}");
    }
}

#[test]
fn poses_of_the_xsens_triad_have_the_length_of_gravity() {
    let Some(folder) = folder() else { return };
    let recording = open(&folder, "xsens_tumble_accel.csv");
    let axes = ["acc_x", "acc_y", "acc_z"].map(|role| recording.numbers(role).expect("numbers"));
    let length = |row: usize| {
        axes.iter()
            .map(|axis| ((axis[row] - 32768.0) / 4048.0).powi(2))
            .sum::<f64>()
    };
    let lengths: Vec<f64> = (0..recording.rows())
        .map(|row| length(row).sqrt() * 9.80665)
        .collect();
    let average = Average::of(&lengths).expect("poses");
    assert!(
        (average.mean - 9.817).abs() < 0.3 && average.missing == 0,
        "{average:?}"
    );
}

#[test]
fn runs_and_plateaus() {
    let Some(folder) = folder() else { return };
    let text = std::fs::read_to_string(folder.join("loadcell_pontius.csv")).expect("the file");
    let requests = [
        Request::labels("run", "run"),
        Request::numbers("load", "load_units"),
    ];
    let load = Recording::read("load", &text, &requests, &UnitTable::default()).expect("no fault");
    let runs = by_label(&[load.labels("run").expect("labels")]);
    assert_eq!(
        runs.iter().map(|run| run.rows.len()).collect::<Vec<_>>(),
        [20, 20]
    );
    // The chamber goes 25 °C, 35 °C, 25 °C three times, with plateaus of nearly half an hour (at least
    // 170 rows of 10 s), but for the first, within 0.1 K.
    let resistor = open(&folder, "resistor_tc_lag_vhd200.csv");
    let (oven, time, resistance) = (
        resistor.numbers("oven").expect("numbers"),
        resistor.numbers("time").expect("numbers"),
        resistor.numbers("resistance").expect("numbers"),
    );
    let dwells = by_steps(
        oven,
        &Steps {
            fewest: 120,
            tolerance: Some(0.1),
        },
    );
    let levels: Vec<f64> = dwells
        .iter()
        .filter_map(|dwell| Average::of(&oven[dwell.rows.clone()]).ok())
        .map(|average| average.mean.round())
        .collect();
    assert_eq!(levels, [25.0, 35.0, 25.0, 35.0, 25.0, 35.0, 25.0]);
    for dwell in &dwells {
        let rows = dwell.rows.clone();
        let average = Average::of(&resistance[rows.clone()]).expect("readings");
        assert!(average.effective <= average.n as f64 && average.u > 0.0);
        assert!(average.u >= average.s / (average.n as f64).sqrt() * 0.999);
        let (time, resistance) = (&time[rows.clone()], &resistance[rows]);
        if let Some(drift) = Drift::of(time, resistance) {
            // Of n_eff independent residuals at equal intervals over T: s·√12/(T·√n_eff).
            let pairs = time.iter().zip(resistance);
            let residuals: Vec<f64> = pairs.map(|(t, x)| x - drift.slope * t).collect();
            let left = Average::of(&residuals).expect("readings");
            let duration = time[time.len() - 1] - time[0];
            let of_residuals = left.s * 12.0_f64.sqrt() / (duration * left.effective.sqrt());
            let ratio = drift.u_slope / of_residuals;
            assert!((ratio - 1.0).abs() < 0.2, "{ratio}: {drift:?}");
        }
    }
}
