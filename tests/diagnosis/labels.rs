//! Effects that differ from one label to another: runs, instruments, and what one of them does in one of the others.

use std::fmt::Write;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, first_names, named_apart as named};

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

#[test]
fn a_delay_of_one_run_is_told_with_the_run() {
    let mut noise = Noise(73);
    let mut rows = "t [s],x [V],y [V],run\n".to_owned();
    for row in 0..180 {
        let (t, run) = (0.1 * f64::from(row), row / 60);
        let course = |t: f64| 5.0 * libm::sin(0.8 * std::f64::consts::PI * t);
        let late = if run == 1 { 0.06 } else { 0.0 };
        let y = 0.2 + 1.5 * course(t - late) + 0.08 * noise.normal();
        let _ = writeln!(rows, "{t:.1},{:.6},{y:.5},r{}", course(t), run + 1);
    }
    let case = "equations = \"y = z + s*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nt = \"time\"\nrun = \"run\"\n[noise]\nu = \"0.08 V\"\n";
    let found = diagnosed("delay-of-a-run", &rows, case);
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
