//! Recordings row by row, at set points: what happens between the rows, and what happens in single ones.

use std::fmt::Write;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, named_apart as named};

/// Eight pressures up and down, three times, a reading at each every 90 s: the warmth of the readings before is half gone.
#[test]
fn warmth_of_earlier_set_points_is_self_heating() {
    let up = (0..8).chain((0..7).rev());
    let pressures: Vec<f64> = up.map(|step| 1.43 * f64::from(step)).collect();
    let mut noise = Noise(71);
    let mut rows = "time [h],run,p [MPa],U [mV]\n".to_owned();
    let (mut hours, mut warmth) = (0.0, 0.0);
    for run in 1..=3 {
        for p in &pressures {
            hours += 0.025;
            warmth += (p * p - warmth) * -libm::expm1(-0.025 / 0.03);
            let signal = 0.4 + 9.68 * p * (1.0 - 3e-6 * warmth);
            let _ = writeln!(
                rows,
                "{hours:.3},{run},{p:.2},{:.4}",
                signal + 2e-4 * noise.normal()
            );
        }
        (hours, warmth) = (hours + 0.5, 0.0);
    }
    let case = "equations = \"U = U0 + S*p\"\n[columns]\ntime = \"time\"\nrun = \"run\"\np = \"stimulus\"\nU = \"output\"\n[noise]\nu = \"0.2 uV\"\n";
    let found = diagnosed("warmth", &rows, case);
    assert_eq!(named(&found), [["self-heating"]], "{}", found["statement"]);
}

/// The noise in which a wrong reading is seen is not made of the other wrong readings, and what is listed is what is said.
#[test]
fn three_wrong_readings_beside_a_drift_are_all_told() {
    let mut noise = Noise(72);
    let mut rows = "time [s],mass [g],display [mg]\n".to_owned();
    for row in 0..60 {
        let (time, mass) = (
            f64::from(row) * 30.0,
            [10.0, 50.0, 100.0, 200.0][row as usize % 4],
        );
        let wrong = match row {
            17 => 5.0,
            25 => -4.5,
            45 => 6.5,
            _ => 0.0,
        };
        let display = 0.5 + 1000.0 * mass + 6e-4 * time + wrong + 0.25 * noise.normal();
        let _ = writeln!(rows, "{time},{mass},{display:.2}");
    }
    let case = "equations = \"display = z + k*mass\"\n[columns]\ntime = \"time\"\nmass = \"stimulus\"\ndisplay = \"output\"\n";
    let found = diagnosed("bursts", &rows, case);
    let statement = found["statement"].as_str().unwrap_or_default();
    for row in ["row 18", "row 26", "row 46"] {
        assert!(statement.contains(row), "{statement}");
    }
    assert!(statement.contains("drift"), "{statement}");
    assert!(!statement.contains("smoothly"), "{statement}");
}
