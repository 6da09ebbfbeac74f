//! Heat of the measurement itself: what it does between the rows, and to a temperature that the model knows.

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

/// A thermistor is warmer than its bath by the power of the current, 2 mW/K here; the model knows the bath.
#[test]
fn the_power_of_a_current_warms_the_thermistor_that_it_reads() {
    let mut noise = Noise(73);
    let mut rows = "I [mA],T [°C],R [ohm]\n".to_owned();
    let resistance =
        |celsius: f64| 1e4 * libm::exp(3900.0 * (1.0 / (celsius + 273.15) - 1.0 / 298.15));
    for current in [0.05, 0.1, 0.2, 0.4] {
        for bath in [0.0, 10.0, 20.0, 30.0, 40.0, 50.0] {
            for _ in 0..2 {
                let cold = resistance(bath);
                // mA² times ohm are µW.
                let warmed = bath + current * current * cold * 1e-6 / 2e-3;
                let shown = resistance(warmed) * (1.0 + 1e-4 * noise.normal());
                let _ = writeln!(rows, "{current},{bath},{shown:.1}");
            }
        }
    }
    let case = "equations = \"R = R25*exp(B*(1/kelvin(T) - 1/kelvin(25 '°C')))\"\n[columns]\nI = \"stimulus\"\nT = \"stimulus\"\nR = \"output\"\n[parameter]\nR25 = { start = 10000 }\nB = { start = \"3900 K\" }\n";
    let found = diagnosed("thermistor", &rows, case);
    assert_eq!(named(&found), [["self-heating"]], "{}", found["statement"]);
    let variant = &found["effects"][0]["named"][0]["variants"][0];
    assert_eq!(variant["label"], "in proportion to the signal");
}

/// Along the stem of a thermometer it loses a part of how far it is from its surroundings, and not of how far it is from 0 °C.
#[test]
fn a_stem_conducts_from_the_bath_to_the_room() {
    let mut noise = Noise(93);
    let mut rows = "bath [°C],R [Ohm],room [°C],depth [mm]\n".to_owned();
    for row in 0..120 {
        let bath = [5.0, 30.0, 60.0, 90.0][row % 4];
        let depth = [40.0, 80.0, 120.0, 160.0, 200.0][row / 4 % 5];
        let room = 22.0 + 3.0 * libm::sin(0.21 * row as f64) + 0.3 * noise.normal();
        let shown = bath - (bath - room) * libm::exp(-depth / 45.0);
        let resistance = 100.0 * (1.0 + 3.9e-3 * shown) + 0.05 * noise.normal();
        let _ = writeln!(rows, "{bath},{resistance:.4},{room:.3},{depth}");
    }
    let case = "equations = \"R = R0*(1 + A*bath)\"\n[columns]\nR = \"output\"\nbath = \"stimulus\"\nroom = \"covariate\"\ndepth = \"covariate\"\n";
    let found = diagnosed("stem", &rows, case);
    assert_eq!(named(&found)[0][0], "immersion", "{found}");
    assert_eq!(found["effects"].as_array().unwrap().len(), 1, "{found}");
    let label = found["effects"][0]["named"][0]["variants"][0]["label"].as_str();
    assert!(
        label.is_some_and(|label| label.contains("towards room")),
        "{label:?}"
    );
}
