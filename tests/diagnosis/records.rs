//! Slips of the record: lists that moved by a line, a section in another unit.

use std::fmt::Write;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, named_apart as named};

#[test]
fn a_list_that_slipped_by_a_line_is_no_physics() {
    let mut noise = Noise(19);
    let mut rows = "load [N],U [mV]\n".to_owned();
    let load = |row: i32| {
        50.0 + 40.0 * libm::sin(0.35 * f64::from(row)) + 8.0 * libm::sin(1.3 * f64::from(row))
    };
    for row in 0..50 {
        let _ = writeln!(
            rows,
            "{},{:.5}",
            load(row),
            0.1 + 0.02 * load(row - 1) + 1e-4 * noise.normal()
        );
    }
    let case = "equations = \"U = a + b*load\"\n[columns]\nU = \"output\"\nload = \"stimulus\"\n";
    let found = diagnosed("slip", &rows, case);
    assert_eq!(named(&found)[0], ["shifted"], "{found}");
}

/// A logger lost a reading: from then on every one stands beside the stimulus after its own.
#[test]
fn a_list_that_lost_a_reading_slips_from_there_on() {
    let mut noise = Noise(23);
    let mut rows = "t [s],x [mm],U [V]\n".to_owned();
    let place = |row: i32| 20.0 + 2.0 * f64::from(row.rem_euclid(10));
    for row in 0..80 {
        let seen = place(if row < 47 { row } else { row - 1 });
        let reading = 0.2 * seen + 0.003 * noise.normal();
        let _ = writeln!(
            rows,
            "{:.1},{},{reading:.3}",
            0.5 * f64::from(row),
            place(row)
        );
    }
    let case =
        "equations = \"U = a + b*x\"\n[columns]\nt = \"time\"\nx = \"stimulus\"\nU = \"output\"\n";
    let found = diagnosed("lost", &rows, case);
    assert_eq!(named(&found), [["shifted"]], "{}", found["statement"]);
    let variants = found["effects"][0]["named"][0]["variants"]
        .as_array()
        .unwrap();
    assert!(
        variants[0]["label"]
            .as_str()
            .unwrap()
            .contains("one row late"),
        "{variants:?}"
    );
}

/// Ten of forty rows were written in psi under a head that says kPa, and nothing is claimed of the noise.
#[test]
fn a_section_in_another_unit_is_no_noise() {
    let mut noise = Noise(29);
    let mut rows = "k,p_ref [kPa],p_dut [kPa]\n".to_owned();
    for row in 0..40 {
        let p = 50.0 * f64::from(row % 5);
        let shown = 0.2 + p + 0.08 * noise.normal();
        let written = if (20..30).contains(&row) {
            shown / 6.895
        } else {
            shown
        };
        let _ = writeln!(rows, "{row},{p},{written:.2}");
    }
    let case = "equations = \"p_dut = a + b*p_ref\"\n[columns]\nk = \"order\"\np_ref = \"stimulus\"\np_dut = \"output\"\n";
    let found = diagnosed("units", &rows, case);
    let names = named(&found);
    assert_eq!(names.len(), 2, "{}", found["statement"]);
    assert!(names.iter().all(|of| of == &["step-scale"]), "{names:?}");
}
