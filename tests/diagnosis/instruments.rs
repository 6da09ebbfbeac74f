//! Instruments of other fields, with one thing left out of their models that textbooks know: what a diagnosis
//! has to name, and where the noise is not the same everywhere.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{
    diagnosed_with as diagnosed, first_names, first_size as size, named_apart,
};

/// The likeliest variant of an effect.
fn variant(diagnosis: &Value, effect: usize) -> &str {
    let named = &diagnosis["effects"][effect]["named"][0];
    named["variants"][0]["label"].as_str().unwrap_or_default()
}

#[test]
fn a_detector_lies_behind_its_window() {
    let mut noise = Noise(31);
    let mut rows = "distance [m],illuminance [lx]\n".to_owned();
    for row in 0..50 {
        let distance = 0.3 + 0.05 * f64::from(row / 2);
        let true_distance = distance + 0.004;
        let lux = 120.0 / (true_distance * true_distance) * (1.0 + 2e-4 * noise.normal());
        let _ = writeln!(rows, "{distance},{lux:.6}");
    }
    let case = "equations = \"illuminance = I / distance^2\"\n[columns]\ndistance = \"stimulus\"\nilluminance = \"output\"\n[parameter]\nI = { start = 120, unit = \"cd\" }\n";
    let found = diagnosed("photometer", &rows, case);
    assert_eq!(first_names(&found), ["zero-of"], "{found}");
    let (estimate, u) = size(&found);
    assert!(
        (estimate - 0.004).abs() < 4.0 * u && u < 1e-4,
        "{estimate} ± {u}"
    );
}

/// The magnitude is recorded, and one of three readings drifts.
#[test]
fn one_reading_of_a_triad_drifts() {
    let mut noise = Noise(57);
    let mut rows = "B [uT],mx [mV],my [mV],mz [mV],t [h]\n".to_owned();
    for row in 0..60 {
        let axis = [noise.normal(), noise.normal(), noise.normal()];
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let field = 30.0 + 30.0 * noise.uniform();
        let t = 0.02 * f64::from(row);
        let mut reads = |at: usize, offset: f64, scale: f64| {
            offset + scale * field * axis[at] / length + 0.2 * noise.normal()
        };
        let (x, y, z) = (
            reads(0, 3.0, 20.0),
            reads(1, -5.0, 20.6),
            reads(2, 2.0, 19.5),
        );
        let y = y + 3.0 * t;
        let _ = writeln!(rows, "{field:.4},{x:.3},{y:.3},{z:.3},{t:.2}");
    }
    let case = r#"
equations = "B = sqrt(((mx - bx)/sx)^2 + ((my - by)/sy)^2 + ((mz - bz)/sz)^2)"
[columns]
B = "output"
mx = "stimulus"
my = "stimulus"
mz = "stimulus"
t = "time"
[parameter]
bx = { start = "0 mV" }
by = { start = "0 mV" }
bz = { start = "0 mV" }
sx = { start = "20 mV/uT" }
sy = { start = "20 mV/uT" }
sz = { start = "20 mV/uT" }
"#;
    let found = diagnosed("magnetometer", &rows, case);
    assert_eq!(first_names(&found), ["drift"], "{found}");
    assert!(variant(&found, 0).starts_with("my"), "{found}");
    // What has to be added to the reading takes the drift away.
    let (estimate, u) = size(&found);
    assert!((estimate + 3.0).abs() < 4.0 * u, "{estimate} ± {u}");
}

#[test]
fn a_stopwatch_starts_late() {
    let mut noise = Noise(32);
    let mut rows = "h [m],t [s]\n".to_owned();
    for row in 0..50 {
        let height = 0.2 * f64::from(1 + row / 5);
        let time = (2.0 * height / 9.81).sqrt() + 0.003 + 4e-4 * noise.normal();
        let _ = writeln!(rows, "{height},{time:.6}");
    }
    let case = "equations = \"t = sqrt(2*h/g)\"\n[columns]\nh = \"stimulus\"\nt = \"output\"\n[parameter]\ng = { start = 9.8, unit = \"m/s^2\" }\n";
    let found = diagnosed("fall", &rows, case);
    // Rows sorted by height: nothing may be said of a drift.
    assert_eq!(first_names(&found), ["zero"], "{found}");
    let (estimate, u) = size(&found);
    assert!((estimate - 0.003).abs() < 4.0 * u, "{estimate} ± {u}");
}

#[test]
fn a_lead_screw_repeats_with_its_pitch() {
    let mut noise = Noise(33);
    let mut rows = "gauge [mm],reading [mm]\n".to_owned();
    for row in 0..100 {
        let gauge = 0.13 * f64::from(row);
        let screw = 0.0012 * libm::sin(TAU * gauge / 0.5 + 0.7);
        let _ = writeln!(
            rows,
            "{gauge},{:.5}",
            gauge + 8e-4 + screw + 3e-4 * noise.normal()
        );
    }
    let case = "equations = \"reading = a + b*gauge\"\n[columns]\ngauge = \"stimulus\"\nreading = \"output\"\n";
    let found = diagnosed("screw", &rows, case);
    assert_eq!(first_names(&found), ["wave"], "{found}");
    let label = variant(&found, 0);
    let period: f64 = label
        .trim_start_matches("period ")
        .trim_end_matches(" mm")
        .parse()
        .expect("a period");
    assert!((period - 0.5).abs() < 0.001, "{label}");
}

#[test]
fn noise_that_grows_with_the_reading_is_no_physics() {
    let mut names = Vec::new();
    for seed in 0..8 {
        let mut noise = Noise(340 + seed);
        let mut rows = "truth,reading\n".to_owned();
        for row in 0..80 {
            let truth = 10.0 * f64::from(1 + row / 4);
            let reading = 1.5 + 0.98 * truth + 0.01 * truth * noise.normal();
            let _ = writeln!(rows, "{truth},{reading:.5}");
        }
        let case = "equations = \"reading = a + b*truth\"\n[columns]\ntruth = \"stimulus\"\nreading = \"output\"\n";
        let found = diagnosed(&format!("growing-{seed}"), &rows, case);
        names.extend(first_names(&found));
    }
    assert!(names.is_empty(), "{names:?}");
}

#[test]
fn light_that_does_not_go_out_is_one_with_its_second_harmonic() {
    let mut noise = Noise(35);
    let mut rows = "angle [deg],current [uA]\n".to_owned();
    for row in 0..36 {
        let angle = 10.0 * f64::from(row);
        let cos = libm::cos((angle - 12.3).to_radians());
        let _ = writeln!(
            rows,
            "{angle},{:.5}",
            5.0 * cos * cos + 0.06 + 0.01 * noise.normal()
        );
    }
    let case = "equations = \"current = I0 * cos(angle - theta0)^2\"\n[columns]\nangle = \"angle\"\ncurrent = \"output\"\n[parameter]\nI0 = { start = 5, unit = \"uA\" }\ntheta0 = { start = 10, unit = \"deg\" }\n";
    let found = diagnosed("malus", &rows, case);
    let listed = &named_apart(&found)[0];
    for id in ["zero", "periodic"] {
        assert!(listed.iter().any(|one| one == id), "{listed:?}");
    }
}

#[test]
fn a_time_constant_follows_the_temperature() {
    let mut noise = Noise(36);
    let mut rows = "t [s],oil [degC],level [mm]\n".to_owned();
    for row in 0..96 {
        let (t, oil) = (2.0 * f64::from(row % 16), 15.0 + 3.0 * f64::from(row / 16));
        let tau = 12.0 * libm::exp(-0.02 * (oil - 22.0));
        let level = 80.0 * libm::exp(-t / tau) + 0.05 * noise.normal();
        let _ = writeln!(rows, "{t},{oil},{level:.4}");
    }
    let case = "equations = \"level = h0*exp(-t/tau)\"\n[columns]\nt = \"stimulus\"\noil = \"covariate\"\nlevel = \"output\"\n[parameter]\nh0 = { start = 80, unit = \"mm\" }\ntau = { start = 10, unit = \"s\" }\n";
    let found = diagnosed("outflow", &rows, case);
    let first = &found["effects"][0]["named"][0];
    assert_eq!(first["id"], "parameter-sensitivity", "{found}");
    assert!(
        first["name"]
            .as_str()
            .is_some_and(|name| name.contains("tau")),
        "{first}"
    );
}

/// A cycle up to `top` and down again, in steps.
fn up_and_down(top: u32, step: f64) -> Vec<f64> {
    let way = (0..=top).chain((0..top).rev());
    way.map(|k| step * f64::from(k)).collect()
}

#[test]
fn inner_friction_needs_no_column_of_directions() {
    let mut noise = Noise(37);
    let mut rows = "t [min],p [kPa],U [mV]\n".to_owned();
    let cycle = up_and_down(10, 10.0);
    let mut behind = [0.0_f64; 3];
    for (row, p) in cycle.iter().cycle().take(3 * cycle.len()).enumerate() {
        let mut loops = 0.0;
        for (place, gap) in behind.iter_mut().zip([8.0, 20.0, 40.0]) {
            *place = place.clamp(p - gap, p + gap);
            loops += 0.5 * *place;
        }
        let reading = 13.0 + 50.0 * p + loops + 0.6 * noise.normal();
        let _ = writeln!(rows, "{},{p},{reading:.2}", 2 * row);
    }
    let case =
        "equations = \"U = a + b*p\"\n[columns]\nt = \"time\"\np = \"stimulus\"\nU = \"output\"\n";
    let found = diagnosed("friction", &rows, case);
    assert_eq!(first_names(&found)[0], "hysteresis", "{found}");
}

/// Two cycles of a sensor whose element sticks: one play, as wide as no step of the grid.
#[test]
fn the_width_of_a_play_lies_between_those_of_the_grid() {
    let mut noise = Noise(39);
    let mut rows = "t [min],RH [%],U [%]\n".to_owned();
    let cycle = up_and_down(8, 10.0);
    let mut behind = 10.0_f64;
    for (row, x) in cycle.iter().cycle().take(2 * cycle.len()).enumerate() {
        let x = 10.0 + x;
        behind = behind.clamp(x - 14.0, x + 14.0);
        let reading = 1.2 + 0.985 * x - 0.09 * (x - behind) + 0.12 * noise.normal();
        let _ = writeln!(rows, "{},{x},{reading:.2}", 30 * row);
    }
    let case = "equations = \"U = a + b*RH\"\n[columns]\nt = \"time\"\nRH = \"stimulus\"\nU = \"output\"\n[noise]\nu = \"0.12 %\"\n";
    let found = diagnosed("humidity", &rows, case);
    assert_eq!(first_names(&found), ["hysteresis"], "{found}");
    let label = variant(&found, 0);
    let share = label.trim_start_matches("width ").split(' ').next();
    let share: f64 = share.and_then(|share| share.parse().ok()).expect(label);
    // 28 % RH of a range of 80 % RH.
    assert!((share - 35.0).abs() < 4.0, "{label}");
}

/// Series of a limiting amplifier without a time: what repeats from series to series is no wave along the rows.
#[test]
fn rows_of_series_have_no_order() {
    let mut noise = Noise(40);
    let mut rows = "run,P [mW],V [V]\n".to_owned();
    for run in 1..=3 {
        for power in [
            0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0_f64,
        ] {
            let volts = libm::pow(
                libm::pow(0.52 * power, -8.0) + libm::pow(2.35, -8.0),
                -0.125,
            );
            let _ = writeln!(rows, "{run},{power},{:.3}", volts + 0.004 * noise.normal());
        }
    }
    let case = "equations = \"V = V0 + S*P\"\n[columns]\nrun = \"run\"\nP = \"stimulus\"\nV = \"output\"\n[noise]\nu = \"4 mV\"\n";
    let found = diagnosed("amplifier", &rows, case);
    let along = found["effects"].as_array().into_iter().flatten();
    let named = along.flat_map(|effect| effect["named"].as_array().cloned().unwrap_or_default());
    let along: Vec<String> = named.map(|one| one["along"].to_string()).collect();
    assert!(!along.is_empty(), "{found}");
    assert!(
        along.iter().all(|along| !along.contains("row")),
        "{along:?}"
    );
}

#[test]
fn the_order_of_rows_alone_says_nothing_of_delays() {
    let mut noise = Noise(38);
    let mut rows = "no,travel [mm],reading [mm]\n".to_owned();
    let cycle = up_and_down(50, 0.1);
    for (row, travel) in cycle.iter().enumerate() {
        let side = if row > 50 { -0.001 } else { 0.001 };
        let reading = travel - side + 3e-4 * noise.normal();
        let _ = writeln!(rows, "{},{travel:.1},{reading:.4}", row + 1);
    }
    let case = "equations = \"reading = a + b*travel\"\n[columns]\nno = \"order\"\ntravel = \"stimulus\"\nreading = \"output\"\n";
    let found = diagnosed("gauge", &rows, case);
    let listed = named_apart(&found).concat();
    assert!(listed.iter().any(|id| id == "hysteresis"), "{listed:?}");
    for id in ["lag", "timing-skew", "self-heating"] {
        assert!(listed.iter().all(|one| one != id), "{listed:?}");
    }
}

#[test]
fn a_channel_lags_by_more_than_an_interval() {
    let mut noise = Noise(39);
    let course = |t: f64| 50.0 + 20.0 * libm::sin(TAU * t / 7.0) + 5.0 * libm::sin(TAU * t / 1.7);
    let mut rows = "t [s],ref [kPa],dut [kPa]\n".to_owned();
    for row in 0..300 {
        let t = 0.1 * f64::from(row);
        let dut = 0.3 + course(t - 0.23) + 0.2 * noise.normal();
        let _ = writeln!(rows, "{t:.1},{:.4},{dut:.3}", course(t));
    }
    let case = "equations = \"dut = a + b*ref\"\n[columns]\nt = \"time\"\nref = \"stimulus\"\ndut = \"output\"\n";
    let found = diagnosed("skew", &rows, case);
    let first = &named_apart(&found)[0];
    assert_eq!(first[0], "timing-skew", "{found}");
    assert!(variant(&found, 0).starts_with("by about 0."), "{found}");
    // One number, the delay.
    let (delay, u) = size(&found);
    assert_eq!(found["improved"]["coefficients"][0]["unit"], "s");
    assert!((delay - 0.23).abs() < 4.0 * u && u < 0.01, "{delay} ± {u}");
}

#[test]
fn a_fast_stimulus_is_not_averaged_away() {
    let mut noise = Noise(391);
    let course = |t: f64| libm::sin(TAU * 50.0 * t) + 0.5 * libm::sin(TAU * 31.0 * t);
    let mut rows = "t [s],ref [V],dut [V]\n".to_owned();
    for row in 0..12_000 {
        let t = 1e-3 * f64::from(row);
        let x = course(t);
        let dut = 0.01 + 2.0 * x + 0.02 * x * x * x + 0.01 * noise.normal();
        let _ = writeln!(rows, "{t:.3},{x:.5},{dut:.5}");
    }
    let case = "equations = \"dut = a + b*ref\"\n[columns]\nt = \"time\"\nref = \"stimulus\"\ndut = \"output\"\n";
    let found = diagnosed("hum", &rows, case);
    assert_eq!(first_names(&found)[0], "cubic", "{found}");
    let (cube, u) = size(&found);
    assert!((cube - 0.02).abs() < 4.0 * u && u < 0.002, "{cube} ± {u}");
}

#[test]
fn the_offset_of_one_reading_of_a_known_field_follows_the_temperature() {
    let mut noise = Noise(392);
    let mut rows = "mx [µT],my [µT],mz [µT],temp [°C]\n".to_owned();
    for row in 0..120 {
        // Directions all over the sphere (a spiral by the golden angle).
        let z = 1.0 - 2.0 * (f64::from(row) + 0.5) / 120.0;
        let (r, turn) = ((1.0 - z * z).sqrt(), 2.399_963 * f64::from(row));
        let temp = 20.0 + 5.0 * libm::sin(0.9 * f64::from(row));
        let field = [r * libm::cos(turn), r * libm::sin(turn), z].map(|part| 48.0 * part);
        let read = [
            1.01 * field[0] + 1.2 + 0.02 * (temp - 20.0),
            0.99 * field[1] - 0.8,
            field[2] + 0.4,
        ]
        .map(|value| value + 0.02 * noise.normal());
        let _ = writeln!(
            rows,
            "{:.4},{:.4},{:.4},{temp:.2}",
            read[0], read[1], read[2]
        );
    }
    let case = "equations = \"F = sqrt(((mx - bx)/sx)^2 + ((my - by)/sy)^2 + ((mz - bz)/sz)^2)\"\n\
        [columns]\nmx = \"stimulus\"\nmy = \"stimulus\"\nmz = \"stimulus\"\ntemp = \"covariate\"\n\
        [constant]\nF = { value = 48, unit = \"µT\" }\n[noise]\nu = \"0.02 µT\"\n\
        [parameter]\nbx = { start = 0, unit = \"µT\" }\nby = { start = 0, unit = \"µT\" }\nbz = { start = 0, unit = \"µT\" }\n\
        sx = { start = 1 }\nsy = { start = 1 }\nsz = { start = 1 }\n";
    let found = diagnosed("known-field", &rows, case);
    assert_eq!(first_names(&found), ["tempco-bias"], "{found}");
    assert!(variant(&found, 0).contains("mx"), "{found}");
    // The correction to the reading.
    let (size, u) = size(&found);
    assert!((size + 0.02).abs() < 4.0 * u, "{size} ± {u}");
}

#[test]
fn a_frozen_channel_is_no_physics_of_the_sensor() {
    let mut noise = Noise(40);
    let mut rows = "t [s],ref [degC],dut [degC]\n".to_owned();
    let mut held = 0.0;
    for row in 0..160 {
        let t = 10.0 * f64::from(row);
        let truth = 50.0 + 20.0 * libm::sin(t / 130.0);
        let reading = 2.0 + 0.99 * truth + 0.05 * noise.normal();
        held = if (61..80).contains(&row) {
            held
        } else {
            reading
        };
        let _ = writeln!(rows, "{t},{truth:.3},{held:.2}");
    }
    let case = "equations = \"dut = a + b*ref\"\n[columns]\nt = \"time\"\nref = \"stimulus\"\ndut = \"output\"\n";
    let found = diagnosed("frozen", &rows, case);
    assert_eq!(first_names(&found), ["stuck"], "{found}");
    assert_eq!(variant(&found, 0), "rows 61 to 80");
}

#[test]
fn soft_iron_stretches_and_turns_the_field() {
    let mut noise = Noise(41);
    let mut rows = "mx [uT],my [uT],mz [uT]\n".to_owned();
    for _ in 0..80 {
        let mut v = [noise.normal(), noise.normal(), noise.normal()];
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v = v.map(|x| 48.9 * x / length);
        let field = [
            1.02 * v[0] + 0.015 * v[1] + 5.2,
            0.015 * v[0] + 0.985 * v[1] - 11.3,
            1.004 * v[2] + 3.3,
        ];
        let [x, y, z] = field.map(|b| b + 0.06 * noise.normal());
        let _ = writeln!(rows, "{x:.3},{y:.3},{z:.3}");
    }
    let case = "equations = \"F = sqrt((mx - hx)^2 + (my - hy)^2 + (mz - hz)^2)\"\n[columns]\nmx = \"stimulus\"\nmy = \"stimulus\"\nmz = \"stimulus\"\n[constant]\nF = { value = 48.9, unit = \"uT\" }\n[parameter]\nhx = { start = 0, unit = \"uT\" }\nhy = { start = 0, unit = \"uT\" }\nhz = { start = 0, unit = \"uT\" }\n";
    let mut names = first_names(&diagnosed("magnetometer", &rows, case));
    names.sort();
    assert_eq!(names, ["axis-scale", "cross-axis"]);
}

#[test]
fn a_graduation_interpolates_wrongly_between_its_lines() {
    let mut noise = Noise(42);
    let mut rows = "angle [deg],error [arcsec]\n".to_owned();
    for row in 0..240 {
        let angle = 1.47 * f64::from(row);
        let phi = angle.to_radians();
        let error =
            2.5 + 6.2 * libm::sin(phi + 0.6) + 1.1 * libm::sin(90.0 * phi) + 0.35 * noise.normal();
        let _ = writeln!(rows, "{angle:.2},{error:.2}");
    }
    let case = "equations = \"error = e0\"\n[columns]\nangle = \"angle\"\nerror = \"output\"\n";
    let found = diagnosed("graduation", &rows, case);
    assert_eq!(first_names(&found), ["periodic", "wave"], "{found}");
    assert_eq!(variant(&found, 1), "90 per turn");
}

#[test]
fn a_load_off_the_centre_of_the_pan() {
    let mut noise = Noise(43);
    let mut rows = "place,load [g],indication [g]\n".to_owned();
    let places = [
        ("centre", 0.0),
        ("front", 2.1e-6),
        ("back", 0.0),
        ("left", 0.0),
        ("right", 0.0),
    ];
    for (place, error) in places.iter().cycle().take(10) {
        for load in [20.0, 50.0, 100.0, 150.0, 200.0] {
            let shown = load * (1.0 + error) + 3e-5 * noise.normal();
            let _ = writeln!(rows, "{place},{load},{shown:.5}");
        }
    }
    let case = "equations = \"indication = a + b*load\"\n[columns]\nplace = \"position\"\nload = \"stimulus\"\nindication = \"output\"\n";
    let found = diagnosed("pan", &rows, case);
    assert_eq!(first_names(&found), ["level-scale"], "{found}");
    assert_eq!(variant(&found, 0), "place front");
}

#[test]
fn a_thermometer_is_warmed_by_its_current() {
    let mut noise = Noise(44);
    let mut rows = "date,bath [degC],I [mA],R [ohm]\n".to_owned();
    for row in 0..40 {
        let bath = -40.0 + 20.0 * f64::from(row / 4);
        let current = [1.0, 1.5, 2.0, 3.0][row as usize % 4];
        let alone = 100.0 * (1.0 + 3.9083e-3 * bath - 5.775e-7 * bath * bath);
        let warmth = alone * current * current * 1e-6 / 4e-3;
        let _ = writeln!(
            rows,
            "2026-03-{:02},{bath},{current},{:.5}",
            1 + row / 4,
            alone + 0.39 * warmth + 1e-3 * noise.normal()
        );
    }
    let case = "equations = \"R = R0*(1 + A*bath + B*bath^2)\"\n[columns]\ndate = \"time\"\nbath = \"stimulus\"\nI = \"covariate\"\nR = \"output\"\n";
    let found = diagnosed("platinum", &rows, case);
    assert_eq!(first_names(&found), ["self-heating"], "{found}");
}

#[test]
fn what_should_be_so_needs_no_parameter() {
    let mut noise = Noise(45);
    let mut rows = "truth [m],reading [m]\n".to_owned();
    for row in 0..40 {
        let truth = 0.5 + 0.5 * f64::from(row % 8);
        let _ = writeln!(rows, "{truth},{:.4}", truth + 0.004 + 8e-4 * noise.normal());
    }
    let case =
        "equations = \"reading = truth\"\n[columns]\ntruth = \"stimulus\"\nreading = \"output\"\n";
    let found = diagnosed("nominal", &rows, case);
    assert!(
        named_apart(&found)[0].contains(&"zero".to_owned()),
        "{found}"
    );
}

#[test]
fn a_time_constant_lies_between_those_of_the_grid() {
    let mut noise = Noise(46);
    let (mut rows, mut inside) = ("t [s],T [degC],E [mV]\n".to_owned(), 22.0);
    let room = |t: f64| 22.0 + 2.5 * libm::sin(TAU * t / 5400.0) + libm::sin(TAU * t / 1800.0);
    for second in 0..9600 {
        let t = f64::from(second);
        inside += (room(t + 0.5) - inside) / 240.0;
        if second % 30 == 29 {
            let emf = 16.0 - 0.0409 * inside + 0.003 * noise.normal();
            let _ = writeln!(rows, "{},{:.3},{emf:.4}", t + 1.0, room(t + 1.0));
        }
    }
    let case =
        "equations = \"E = E0 - S*T\"\n[columns]\nt = \"time\"\nT = \"stimulus\"\nE = \"output\"\n";
    let found = diagnosed("junction", &rows, case);
    assert_eq!(first_names(&found), ["temperature-lag"], "{found}");
    let label = variant(&found, 0);
    let tau = label.trim_start_matches("τ = ").split(' ').next();
    let tau: f64 = tau.and_then(|tau| tau.parse().ok()).expect(label);
    assert!((tau - 240.0).abs() < 24.0, "{label}");
}

#[test]
fn a_venturi_has_an_exponent_of_its_own() {
    let mut noise = Noise(47);
    let mut rows = "Q [m^3/h],dp [kPa]\n".to_owned();
    for row in 0..40 {
        let flow = 2.0 + 2.0 * f64::from(row / 4);
        let dp = 0.043 * libm::pow(flow, 1.99) + 3e-3 * noise.normal();
        let _ = writeln!(rows, "{flow},{dp:.4}");
    }
    let case = "equations = \"dp = k*Q^2\"\n[columns]\nQ = \"stimulus\"\ndp = \"output\"\n";
    let found = diagnosed("venturi", &rows, case);
    assert_eq!(first_names(&found), ["exponent"], "{found}");
    let (estimate, u) = size(&found);
    assert!(
        (estimate + 0.01).abs() < 4.0 * u.max(1e-3),
        "{estimate} ± {u}"
    );
}

#[test]
fn a_step_within_a_mean_leaves_no_wrong_reading() {
    let mut noise = Noise(48);
    let mut rows = "t [h],ref [hPa],dut [hPa]\n".to_owned();
    for row in 0..960 {
        let t = 0.5 * f64::from(row);
        let truth = 1000.0 + 9.0 * libm::sin(t / 31.0) + 4.0 * libm::sin(t / 7.3);
        let moved = if row > 445 { 0.22 } else { 0.0 };
        let _ = writeln!(
            rows,
            "{t},{truth:.3},{:.3}",
            truth + moved + 0.03 * noise.normal()
        );
    }
    let case = "equations = \"dut = a + b*ref\"\n[columns]\nt = \"time\"\nref = \"stimulus\"\ndut = \"output\"\n";
    let listed = named_apart(&diagnosed("moved", &rows, case));
    assert_eq!(listed.len(), 1, "{listed:?}");
    assert!(listed[0].contains(&"step".to_owned()), "{listed:?}");
}

#[test]
fn an_axis_takes_part_in_the_other_one() {
    let mut noise = Noise(43);
    let mut rows = "gx [gn],gy [gn],ax [V],ay [V]\n".to_owned();
    for row in 0..36 {
        let phi = f64::from(row % 12) * TAU / 12.0;
        let (gx, gy) = (libm::sin(phi), libm::cos(phi));
        let ax = 0.01 + 2.0 * gx + 0.003 * gy + 2e-4 * noise.normal();
        let ay = -0.02 + 1.98 * gy + 2e-4 * noise.normal();
        let _ = writeln!(rows, "{gx:.6},{gy:.6},{ax:.5},{ay:.5}");
    }
    let case = "equations = [\"ax = bx + Sx*gx\", \"ay = by + Sy*gy\"]\n[columns]\nax = \"output\"\nay = \"output\"\ngx = \"stimulus\"\ngy = \"stimulus\"\n[noise]\nu = \"0.2 mV\"\n";
    let found = diagnosed("two-axes", &rows, case);
    assert_eq!(first_names(&found), ["cross-axis"], "{found:#}");
    assert_eq!(variant(&found, 0), "ax with gy");
    assert!((size(&found).0 - 0.003).abs() < 3e-4, "{found:#}");
}

/// The bath scatters about its set points by more than is claimed: a wave whose period is their distance would
/// follow that scatter on its steep flanks.
#[test]
fn scatter_about_set_points_is_no_wave() {
    let mut noise = Noise(44);
    let mut rows = "t [min],bath [°C],R [Ω]\n".to_owned();
    for row in 0..66 {
        let bath = 10.0 * f64::from((row * 7) % 11);
        let ohms = 100.0 * (1.0 + 3.9083e-3 * bath) + 1e-3 * noise.normal();
        let read = bath + 0.01 * noise.normal();
        let _ = writeln!(rows, "{},{read:.3},{ohms:.4}", 5 * row);
    }
    let case = "equations = \"R = R0*(1 + A*bath)\"\n[columns]\nR = \"output\"\nbath = \"stimulus\"\nt = \"time\"\n[noise]\nu = \"1 mΩ\"\n";
    let found = diagnosed("set-points", &rows, case);
    assert!(
        named_apart(&found)
            .concat()
            .iter()
            .all(|name| name != "wave"),
        "{found:#}"
    );
}
