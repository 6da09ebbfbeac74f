//! Effects that differ from one label to another: runs, instruments, and what one of them does in one of the others.

use std::fmt::Write;

use crate::common::Noise;
use crate::common::cases::{
    diagnosed as in_folder, diagnosed_with as diagnosed, first_names, folder, named_apart as named,
};

#[test]
fn instruments_that_were_exchanged_in_one_run_show_in_its_combinations() {
    const UNITS: [&str; 3] = ["A", "B", "C"];
    const SCALES: [f64; 3] = [1.0, 1.02, 0.985];
    let mut noise = Noise(71);
    let mut rows = "x [V],y [V],unit,run\n".to_owned();
    for row in 0..96 {
        let (unit, run) = (row % 3, row / 24);
        let x = 1.0 + f64::from((7 * row % 32) as u8) * 0.28;
        let own = match (run, unit) {
            (2, 0) => 1,
            (2, 1) => 0,
            _ => unit,
        };
        let y = SCALES[own] * x + 0.01 * noise.normal();
        let _ = writeln!(rows, "{x:.3},{y:.5},{},r{}", UNITS[unit], run + 1);
    }
    let case = "equations = \"y = s*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nunit = \"factor\"\nrun = \"run\"\n[parameter]\ns = { per = \"unit\" }\n";
    let found = diagnosed("exchanged-units", &rows, case);
    assert_eq!(first_names(&found), ["combination-scale"], "{found}");
    assert_eq!(found["effects"].as_array().unwrap().len(), 1, "{found}");
}

/// One who puts loads down beside the middle of the pan weighs them wrong on one side of it only; four rows of 120 show it.
#[test]
fn what_one_operator_does_at_one_place_is_a_combination() {
    let mut noise = Noise(73);
    let mut rows = "operator,place,load [g],shown [g]\n".to_owned();
    for row in 0..120 {
        let (operator, place, load) = (row % 3, row / 3 % 5, 100.0 * f64::from(1 + row / 15 % 2));
        let (operator, place) = (operator as usize, place as usize);
        let own = if (operator, place) == (1, 2) {
            2e-5
        } else {
            0.0
        };
        let shown = load * (1.0 + own) + 0.0004 * noise.normal();
        let operator = ["Anna", "Ben", "Chen"][operator];
        let place = ["middle", "front", "left", "back", "right"][place];
        let _ = writeln!(rows, "{operator},{place},{load},{shown:.5}");
    }
    let case = "equations = \"shown = zero + k*load\"\n[columns]\nshown = \"output\"\nload = \"stimulus\"\nplace = \"position\"\noperator = \"operator\"\n";
    let found = diagnosed("operator-at-a-place", &rows, case);
    assert_eq!(first_names(&found), ["combination-scale"], "{found}");
    let variant = &found["effects"][0]["named"][0]["variants"][0];
    let label = variant["label"].as_str().unwrap_or_default();
    assert!(label.contains("Ben") && label.contains("left"), "{label}");
}

#[test]
fn what_one_operator_makes_of_one_part_is_a_combination() {
    let mut noise = Noise(72);
    let mut rows = "part,operator,length [mm]\n".to_owned();
    for row in 0..60 {
        let (part, operator) = (row % 5, row / 5 % 3);
        let mut length = 20.0 + 0.3 * f64::from(part) + 0.02 * f64::from(operator);
        if (part, operator) == (3, 1) {
            length += 0.08;
        }
        let _ = writeln!(
            rows,
            "p{part},{},{:.4}",
            ["Chen", "Li", "Wu"][operator as usize],
            length + 0.01 * noise.normal()
        );
    }
    let case = "equations = \"length = L + d\"\n[columns]\nlength = \"output\"\npart = \"factor\"\noperator = \"operator\"\n[parameter]\nL = { per = \"part\" }\nd = { per = \"operator\", value = \"0 mm\", u = \"0.1 mm\" }\n";
    let found = diagnosed("operator-and-part", &rows, case);
    // Of parts that are nearly alike, an offset of one and its scale are one.
    let listed = named(&found);
    let [listed] = &listed[..] else {
        panic!("{found}")
    };
    assert!(listed.contains(&"combination-shift".to_owned()), "{found}");
    let variant = &found["effects"][0]["named"][0]["variants"][0];
    assert_eq!(variant["label"], "part p3, operator Li", "{found}");
}

/// Four flow meters of forty rows each, with errors by the meter, the flow and the deviation of the temperature from its mean.
fn flow_meters(seed: u64, error: impl Fn(u32, f64, f64) -> f64) -> String {
    let mut noise = Noise(seed);
    let mut rows = "q [l/min],f [Hz],water [°C],meter\n".to_owned();
    for row in 0..160 {
        let (meter, flow) = (row / 40, 5.0 + f64::from(7 * row % 40));
        let warm = 3.0 * libm::sin(std::f64::consts::TAU * f64::from(7 * row % 160) / 160.0);
        let shown = 20.0 * flow + error(meter, flow, warm) + 0.4 * noise.normal();
        let _ = writeln!(rows, "{flow},{shown:.3},{:.3},M{}", 20.0 + warm, meter + 1);
    }
    rows
}

const METERS: &str = "equations = \"f = f0 + K*q\"\n[columns]\nf = \"output\"\nq = \"stimulus\"\nwater = \"covariate\"\nmeter = \"factor\"\n";

/// What acts under one label, or differs from one to another, makes that label scatter more than others: noise that differs by label
/// is not taken for granted before effects are looked for under labels.
#[test]
fn a_coefficient_of_one_instrument_is_no_noise_of_it() {
    let of_one = |meter: u32, _: f64, warm: f64| if meter == 1 { 2.0 * warm } else { 0.0 };
    let of_each = |meter: u32, _: f64, warm: f64| [0.9, -1.4, 0.2, 0.5][meter as usize] * warm;
    for (name, rows, words) in [
        ("of-one-meter", flow_meters(81, of_one), "only in meter M2"),
        (
            "of-each-meter",
            flow_meters(82, of_each),
            "another size in each meter",
        ),
    ] {
        let found = diagnosed(name, &rows, METERS);
        assert_eq!(first_names(&found), ["tempco-bias"], "{found}");
        let variant = &found["effects"][0]["named"][0]["variants"][0];
        let label = variant["label"].as_str().unwrap_or_default();
        assert!(label.contains(words), "{label}");
    }
    // One that really scatters more than the others is left in peace.
    let mut noise = Noise(83);
    let mut rows = flow_meters(84, |_, _, _| 0.0);
    rows = rows
        .lines()
        .map(|line| match line.strip_suffix(",M2") {
            Some(rest) => {
                let mut fields: Vec<String> = rest.split(',').map(str::to_owned).collect();
                fields[1] = format!(
                    "{:.3}",
                    fields[1].parse::<f64>().unwrap() + 4.0 * noise.normal()
                );
                fields.join(",") + ",M2\n"
            }
            None => line.to_owned() + "\n",
        })
        .collect();
    let found = diagnosed("scatter-of-one-meter", &rows, METERS);
    assert_eq!(found["verdict"], "none", "{found}");
}

/// The bend of one meter is neither a change of its scale, beside which the others have heavy tails, nor, beside a coefficient of
/// that meter, a bend of all.
#[test]
fn what_one_instrument_does_is_told_beside_what_all_do() {
    let bend = |flow: f64| 0.03 * (flow - 24.5) * (flow - 24.5);
    let of_one = |meter: u32, flow: f64, _: f64| if meter == 1 { bend(flow) } else { 0.0 };
    let found = diagnosed("bend-of-one-meter", &flow_meters(86, of_one), METERS);
    // The mean of a bend may be a shift of that meter as well.
    let names = first_names(&found);
    assert!(names.contains(&"quadratic".to_owned()), "{found}");
    let beside =
        |meter: u32, flow: f64, warm: f64| bend(flow) + if meter == 1 { 2.0 * warm } else { 0.0 };
    let found = diagnosed("bend-and-one-meter", &flow_meters(87, beside), METERS);
    let mut names = first_names(&found);
    names.sort();
    assert_eq!(names, ["quadratic", "tempco-bias"], "{found}");
}

/// Up and down in five mountings, in one of which the cell bends: a scale that wanders would look alike.
#[test]
fn a_bend_of_one_mounting_is_no_scale_that_wanders() {
    let mut noise = Noise(85);
    let mut rows = "M [N*m],U [mV],t [min],mounting\n".to_owned();
    for row in 0..125 {
        let (mounting, step) = (row / 25, f64::from(row % 25));
        let torque = 100.0 * (1.0 - (step - 12.0).abs() / 12.0);
        let bend = if mounting == 3 {
            4e-6 * torque * torque
        } else {
            0.0
        };
        let shown = 0.01 + 0.02 * torque + bend + 0.0008 * noise.normal();
        let _ = writeln!(rows, "{torque:.2},{shown:.5},{row},p{mounting}");
    }
    let case = "equations = \"U = U0 + S*M\"\n[columns]\nU = \"output\"\nM = \"stimulus\"\nt = \"time\"\nmounting = \"factor\"\n";
    let found = diagnosed("bend-of-one-mounting", &rows, case);
    assert_eq!(first_names(&found), ["quadratic"], "{found}");
}

/// Rows of three runs over one course, the output of each following it in a way of its own.
fn three_runs(seed: u64, course: impl Fn(f64) -> f64, output: impl Fn(u32, f64) -> f64) -> String {
    let mut noise = Noise(seed);
    let mut rows = "t [s],x [V],y [V],run\n".to_owned();
    for row in 0..180 {
        let (t, run) = (0.1 * f64::from(row), row / 60 + 1);
        let y = 0.2 + 1.5 * output(run, t) + 0.08 * noise.normal();
        let _ = writeln!(rows, "{t:.1},{:.6},{y:.5},r{run}", course(t));
    }
    rows
}

const THREE_RUNS: &str = "equations = \"y = z + s*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nt = \"time\"\nrun = \"run\"\n[noise]\nu = \"0.08 V\"\n";

/// A course without corners, of two frequencies.
fn two_waves(t: f64) -> f64 {
    4.0 * libm::sin(2.2 * t) + 2.0 * libm::sin(5.3 * t + 1.0)
}

/// What follows it behind one time constant, in balance with it since long ago.
fn two_waves_behind(tau: f64, t: f64) -> f64 {
    let late = |size: f64, w: f64, phase: f64| {
        let lags = libm::atan(w * tau);
        size * libm::cos(lags) * libm::sin(w * t + phase - lags)
    };
    late(4.0, 2.2, 0.0) + late(2.0, 5.3, 1.0)
}

/// The only effect that a diagnosis names, under which label, its shape, and its size.
fn only_effect(found: &serde_json::Value) -> (String, String, f64, f64) {
    let effects = found["effects"].as_array().unwrap();
    let [effect] = &effects[..] else {
        panic!("{found}")
    };
    let first = &effect["named"][0];
    let label = first["variants"][0]["label"].as_str().unwrap().to_owned();
    let mut words = label.split([' ', ',']).rev();
    let shape = words.find_map(|word| word.parse().ok()).unwrap();
    let size = first["size"][0].as_f64().unwrap();
    (first["id"].as_str().unwrap().to_owned(), label, shape, size)
}

#[test]
fn a_delay_of_one_run_is_as_long_as_its_size_says() {
    // Over all runs it looks like another one, and is longer than an interval of the rows.
    let output = |run, t| two_waves(if run == 2 { t - 0.33 } else { t });
    let rows = three_runs(74, two_waves, output);
    let found = diagnosed("long-delay-of-a-run", &rows, THREE_RUNS);
    let (id, label, shape, size) = only_effect(&found);
    assert_eq!(id, "timing-skew", "{found}");
    assert!(label.ends_with("only in run r2"), "{label}");
    assert!((shape - 0.33).abs() < 0.02, "{label}");
    assert!((size - 0.33).abs() < 0.02, "{size}");
}

#[test]
fn a_lag_of_one_run_has_its_time_constant() {
    for tau in [0.3, 1.4] {
        let output = |run, t| match run {
            3 => two_waves_behind(tau, t),
            _ => two_waves(t),
        };
        let rows = three_runs(75, two_waves, output);
        let found = diagnosed("lag-of-a-run", &rows, THREE_RUNS);
        let (id, label, shape, _) = only_effect(&found);
        assert_eq!(id, "lag", "{found}");
        assert!(label.ends_with("only in run r3"), "{label}");
        assert!((shape / tau - 1.0).abs() < 0.1, "{label}");
    }
}

#[test]
fn what_a_held_out_recording_has_no_labels_for_is_no_matter_of_labels() {
    let output = |run, t| two_waves(if run == 2 { t - 0.33 } else { t });
    let folder = folder("labels-held-out");
    let rows = three_runs(76, two_waves, output);
    std::fs::write(folder.join("recording.csv"), &rows).unwrap();
    let later = three_runs(77, two_waves, |_, t| two_waves(t));
    let case = format!(
        "recording = \"recording.csv\"\nheld_out = {{ file = \"later.csv\" }}\n{THREE_RUNS}"
    );
    let by_label = |later: &str| {
        std::fs::write(folder.join("later.csv"), later).unwrap();
        in_folder(&folder, &case)
            .to_string()
            .contains("only in run")
    };
    assert!(by_label(&later));
    assert!(!by_label(&later.replace(",r1\n", ",s\n")));
}

#[test]
fn a_delay_of_one_run_is_told_with_the_run() {
    let course = |t: f64| 5.0 * libm::sin(0.8 * std::f64::consts::PI * t);
    let output = |run, t| course(if run == 2 { t - 0.06 } else { t });
    let rows = three_runs(73, course, output);
    let found = diagnosed("delay-of-a-run", &rows, THREE_RUNS);
    // A lag of one time constant does nearly the same to one frequency.
    let listed = named(&found);
    let [listed] = &listed[..] else {
        panic!("{found}")
    };
    assert!(listed.contains(&"timing-skew".to_owned()), "{found}");
    for name in found["effects"][0]["named"].as_array().unwrap() {
        let label = name["variants"][0]["label"].as_str().unwrap();
        assert!(label.ends_with("only in run r2"), "{name}");
    }
    let statement = found["statement"].as_str().unwrap();
    let told = "timing skew between x and y (only in run r2)";
    assert!(statement.contains(told), "{statement}");
}
