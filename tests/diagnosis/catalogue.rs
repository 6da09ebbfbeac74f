//! Recordings with one known fault each: what a diagnosis has to name, and what it must not name.

use crate::common;
use std::fmt::Write;

use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::stand_ins;
use nalgebra::DVector;
use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{
    diagnosed_with as diagnosed, first_labelled, folder, named_apart as named,
};

#[test]
fn two_harmonics_of_one_angle_are_two_effects() {
    let mut noise = Noise(3);
    let mut rows = "angle [deg],error [µrad]\n".to_owned();
    for row in 0..48 {
        let angle = f64::from(row) * 15.0;
        let turn = angle.to_radians();
        let error = 12.0 * libm::sin(turn) + 4.0 * libm::cos(2.0 * turn) + 0.5 * noise.normal();
        let _ = writeln!(rows, "{angle},{error:.4}");
    }
    let case = "equations = \"error = e0\"\n[columns]\nerror = \"output\"\nangle = \"angle\"\n";
    let found = diagnosed("harmonics", &rows, case);
    for (effect, label) in [(0, "1 per turn"), (1, "2 per turn")] {
        assert_eq!(named(&found)[effect], ["periodic"], "{found}");
        let variant = &found["effects"][effect]["named"][0]["variants"][0];
        assert_eq!(variant["label"], label);
    }
}

#[test]
fn exchanged_rows_are_found_however_they_bend_the_fit() {
    // Six faces of an accelerometer: each of them holds a third of a scale factor.
    let faces = [
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [0, 0, 1],
        [0, 0, -1],
    ];
    for exchanged in [[2, 3], [1, 9]] {
        let mut noise = Noise(31);
        let mut readings: Vec<[f64; 2]> = (0..18)
            .map(|row: usize| {
                let [x, y, _] = faces[row % 6].map(f64::from);
                let of = |own: f64, other: f64| 0.02 + 9.8 * own + 0.05 * other;
                [of(x, y), of(y, x)].map(|value| value + 1e-3 * noise.normal())
            })
            .collect();
        readings.swap(exchanged[0], exchanged[1]);
        let mut rows = "gx [gn],gy [gn],gz [gn],ax [m/s^2],ay [m/s^2]\n".to_owned();
        for (row, [ax, ay]) in readings.iter().enumerate() {
            let [x, y, z] = faces[row % 6];
            let _ = writeln!(rows, "{x},{y},{z},{ax:.5},{ay:.5}");
        }
        let case = "equations = [\"ax = bx + Sxx*gx + Sxy*gy\", \"ay = by + Syx*gx + Syy*gy\"]\n[columns]\nax = \"output\"\nay = \"output\"\ngx = \"stimulus\"\ngy = \"stimulus\"\ngz = \"stimulus\"\n[noise]\nu = \"1 mm/s^2\"\n";
        let found = diagnosed("exchanged", &rows, case);
        let (names, label) = first_labelled(&found);
        assert_eq!(names, ["swapped"], "{}", found["statement"]);
        let [a, b] = exchanged.map(|row| row + 1);
        assert_eq!(label, format!("rows {a} and {b}"));
        let statement = found["statement"].as_str().unwrap_or_default();
        assert!(statement.contains(&label), "{statement}");
    }
}

#[test]
fn dwells_of_one_reading_after_settling_are_no_rows() {
    let mut noise = Noise(37);
    let mut rows = "position,head [deg],U [mV]\n".to_owned();
    for row in 0..24 {
        let head = f64::from(row) * 15.0;
        for _ in 0..2 {
            let value = 2.0 + 250.0 * libm::sin(head.to_radians()) + 0.01 * noise.normal();
            let _ = writeln!(rows, "p{row},{head},{value:.4}");
        }
    }
    let folder = folder("dwells");
    std::fs::write(folder.join("recording.csv"), rows).expect("written");
    let found = common::cases::diagnosed(
        &folder,
        "recording = { file = \"recording.csv\", dwells = [\"position\"], settle = 1 }\nequations = \"U = K0 + K1*sin(head)\"\n[columns]\nposition = \"position\"\nhead = \"angle\"\nU = \"output\"\n",
    );
    assert_eq!(found["verdict"], "none", "{}", found["statement"]);
}

#[test]
fn a_scale_of_its_own_is_no_reversed_polarity() {
    let mut noise = Noise(5);
    let mut rows = "operator,nominal [mm],reading [mm]\n".to_owned();
    for row in 0..60 {
        let (operator, nominal) = (["A", "B", "C"][row % 3], 10.0 * (1 + row / 3 % 5) as f64);
        let gain = if operator == "B" { 1.004 } else { 1.0 };
        let reading = gain * nominal + 0.01 * noise.normal();
        let _ = writeln!(rows, "{operator},{nominal},{reading:.5}");
    }
    let case = "equations = \"reading = a + b*nominal\"\n[columns]\nreading = \"output\"\nnominal = \"stimulus\"\noperator = \"operator\"\n";
    let (names, label) = first_labelled(&diagnosed("operators", &rows, case));
    assert_eq!(names, ["level-scale"]);
    assert_eq!(label, "operator B");
}

/// Readings of five weights of both signs, and the temperature.
fn weighings(seed: u64, reading: impl Fn(f64, f64) -> f64) -> String {
    let mut noise = Noise(seed);
    let mut rows = "weight,reading [mg],temperature [°C]\n".to_owned();
    for row in 0..60 {
        let weight = row * 7 % 5;
        let mass = [0.8, -0.5, 0.3, -0.9, 0.6][weight];
        let temperature = 23.0 + 1.5 * libm::sin(0.37 * row as f64);
        let value = reading(mass, temperature - 23.0) + 0.004 * noise.normal();
        let _ = writeln!(rows, "{weight},{value:.5},{temperature:.3}");
    }
    rows
}

const WEIGHINGS: &str = "equations = \"reading = mass\"\n[columns]\nreading = \"output\"\nweight = \"factor\"\ntemperature = \"covariate\"\n[parameter]\nmass = { per = \"weight\" }\n";

#[test]
fn a_scale_multiplies_the_values_of_specimens() {
    let rows = weighings(11, |mass, warm| mass * (1.0 + 0.03 * warm));
    let found = diagnosed("weights", &rows, WEIGHINGS);
    assert_eq!(named(&found)[0], ["tempco-scale"], "{found}");
    let size = found["effects"][0]["named"][0]["size"][0].as_f64();
    assert!(
        size.is_some_and(|size| (size - 0.03).abs() < 0.003),
        "{size:?}"
    );
}

#[test]
fn where_readings_hardly_vary_a_name_says_that_the_scale_gives_the_same() {
    let mut noise = Noise(12);
    let mut rows = "R [ohm],room [°C],t [h]\n".to_owned();
    for row in 0..60 {
        let room = 23.0 + 1.5 * libm::sin(0.37 * f64::from(row));
        let value = 100.0 + 2e-3 * (room - 23.0) + 2e-4 * noise.normal();
        let _ = writeln!(rows, "{value:.6},{room:.3},{row}");
    }
    let case =
        "equations = \"R = R0\"\n[columns]\nR = \"output\"\nroom = \"covariate\"\nt = \"time\"\n";
    let found = diagnosed("steady", &rows, case);
    let name = &found["effects"][0]["named"][0];
    assert_eq!(
        (&name["id"], &name["on_scale"]),
        (&"tempco-bias".into(), &"tempco-scale".into())
    );
    let statement = found["statement"].as_str().unwrap_or_default();
    assert!(statement.contains("or of the scale"), "{statement}");
    let rows = weighings(13, |mass, warm| mass + 0.03 * warm);
    let found = diagnosed("unsteady", &rows, WEIGHINGS);
    let name = &found["effects"][0]["named"][0];
    assert_eq!(
        (&name["id"], &name["on_scale"]),
        (&"tempco-bias".into(), &Value::Null)
    );
}

#[test]
fn noise_that_jumps_is_not_taken_for_noise_that_wanders() {
    let readings = |jumps: f64, name: &str| {
        let mut noise = Noise(15);
        let mut rows = "load [kN],U [mV],t [h]\n".to_owned();
        let (mut state, mut until) = (1.0, 0.0);
        let mut wandering = 0.0;
        for row in 0..80 {
            if f64::from(row) > until {
                state = -state;
                until += 4.0 + 9.0 * noise.uniform();
            }
            wandering = 0.6 * wandering + 0.8 * noise.normal();
            let load = f64::from(row * 37 % 80);
            let error = jumps * state + (1.0 - 0.7 * f64::from(jumps > 0.0)) * wandering;
            let _ = writeln!(
                rows,
                "{load},{:.5},{}",
                0.1 * load + 0.01 * error,
                0.02 * f64::from(row)
            );
        }
        let case = "equations = \"U = U0 + S*load\"\n[columns]\nU = \"output\"\nload = \"stimulus\"\nt = \"time\"\n";
        diagnosed(name, &rows, case)
    };
    let found = readings(2.0, "jumps");
    assert_eq!(found["verdict"], "unexplained", "{}", found["statement"]);
    let found = readings(0.0, "wanders");
    assert_eq!(found["verdict"], "none", "{}", found["statement"]);
}

/// A torque sensor in both senses of turning. Wandering of its scale changes sign with the torque and is an error of its slope;
/// wandering of its zero is neither.
#[test]
fn a_scale_that_wanders_is_not_taken_for_noise_that_wanders() {
    let found = |wandering: &dyn Fn(f64) -> f64, name: &str, seed: u64| {
        let mut noise = Noise(seed);
        let mut rows = "M [N m],U [mV],t [h]\n".to_owned();
        let mut slow = 0.0;
        for row in 0..80 {
            let torque = f64::from(row * 37 % 81 - 40);
            slow = 0.8 * slow + 0.6 * noise.normal();
            let output = 0.02 * torque + wandering(torque) * slow + 2e-4 * noise.normal();
            let _ = writeln!(rows, "{torque},{output:.6},{}", 0.02 * f64::from(row));
        }
        let case = "equations = \"U = U0 + S*M\"\n[columns]\nU = \"output\"\nM = \"stimulus\"\nt = \"time\"\n";
        diagnosed(name, &rows, case)
    };
    let of_slope = |found: &Value| {
        found["parameters"][1]["u"]
            .as_f64()
            .expect("u of the slope")
    };
    let of_seed = |seed: u64| found(&|torque| 4e-5 * torque, "scale-wanders", seed);
    let scale = of_seed(33);
    assert_eq!(scale["verdict"], "unexplained", "{}", scale["statement"]);
    assert_eq!(scale["effects"][0]["unnamed"][0]["id"], "wandering-scale");
    assert!(
        scale["noise"]["origin"]
            .as_str()
            .is_some_and(|origin| origin.contains("the scale, which wanders"))
    );
    let zero = found(&|_| 1e-3, "zero-wanders", 33);
    assert_eq!(zero["verdict"], "none", "{}", zero["statement"]);
    // The mean of 80 readings of a scale that keeps 0.8 from row to row, in closed form: the effective number of readings.
    let (n, kept) = (80.0, 0.8_f64);
    let weighed = |lag: i32| (1.0 - f64::from(lag) / n) * kept.powi(lag);
    let effective = n / (1.0 + 2.0 * (1..80).map(weighed).sum::<f64>());
    let expected = 4e-5 / effective.sqrt();
    // What is kept, as 80 rows tell it, scatters by √((1 − 0.8²)/80) = 0.067, and so the logarithm of u by 0.25. What they leave open
    // of how long the scale remembers makes u larger, up to that of one reading of it, as if nothing averaged.
    let ratios = (33..39).map(|seed| of_slope(&of_seed(seed)) / expected);
    let mean = ratios.map(f64::ln).sum::<f64>() / 6.0;
    let scatter = 3.0 * 0.25 / 6.0_f64.sqrt();
    assert!((-scatter..(4e-5 / expected).ln()).contains(&mean), "{mean}");
}

/// A load cell beside which the humidity rises and falls slowly: nobody claims the noise, and this much of its effect may be noise that
/// wanders as well.
#[test]
fn what_may_be_noise_that_wanders_has_its_name_if_rows_are_independent() {
    let found = |per_percent: f64, name: &str| {
        let mut noise = Noise(21);
        let mut rows = "load [kN],U [mV],humidity [%],t [h]\n".to_owned();
        let (mut humidity, mut slow) = (50.0, 0.0);
        for row in 0..80 {
            let load = f64::from(row * 37 % 80);
            slow = 0.9 * slow + 0.3 * noise.normal();
            humidity += 0.2 * slow;
            let output = 0.1 * load + per_percent * (humidity - 50.0) + 0.01 * noise.normal();
            let t = 0.02 * f64::from(row);
            let _ = writeln!(rows, "{load},{output:.5},{humidity:.2},{t}");
        }
        let case = "equations = \"U = U0 + S*load\"\n[columns]\nU = \"output\"\nload = \"stimulus\"\nhumidity = \"covariate\"\nt = \"time\"\n";
        diagnosed(name, &rows, case)
    };
    let open = found(0.006, "independent");
    assert_eq!(open["verdict"], "none", "{}", open["statement"]);
    let instead = &open["if_independent"];
    assert!(
        named(instead)[0].iter().any(|id| id == "sensitivity"),
        "{instead}"
    );
    let statement = open["statement"].as_str().unwrap_or_default();
    assert!(statement.contains("sensitivity of the output to humidity"));
    // What is seen beside noise that wanders needs no such condition.
    let seen = found(0.012, "remembering");
    assert!(
        named(&seen)[0].iter().any(|id| id == "sensitivity"),
        "{seen}"
    );
    assert_eq!(seen["if_independent"], Value::Null);
}

#[test]
fn a_pendulum_swings_slower_with_the_square_of_its_amplitude() {
    let mut noise = Noise(7);
    let mut rows = "L [m],amplitude [rad],period [s]\n".to_owned();
    for row in 0..30 {
        let length = 0.5 + 0.3 * f64::from(row % 6);
        let amplitude = 0.05 + 0.1 * f64::from(row / 6);
        let small = std::f64::consts::TAU * (length / 9.81).sqrt();
        let period = small * (1.0 + amplitude * amplitude / 16.0) + 2e-4 * noise.normal();
        let _ = writeln!(rows, "{length},{amplitude},{period:.7}");
    }
    let case = "equations = \"period = 2*pi*sqrt(L/g)\"\n[columns]\nperiod = \"output\"\nL = \"stimulus\"\namplitude = \"covariate\"\n[parameter.g]\nunit = \"m/s^2\"\nstart = 9.8\n";
    let found = diagnosed("pendulum", &rows, case);
    assert_eq!(named(&found)[0], ["sensitivity-scale-quadratic"], "{found}");
}

#[test]
fn a_loop_on_the_way_down_is_hysteresis() {
    let mut noise = Noise(9);
    let mut rows = "pressure [bar],signal [mV]\n".to_owned();
    for _ in 0..3 {
        for step in 0..21 {
            let (pressure, down) = if step <= 10 {
                (step, 0.0)
            } else {
                (20 - step, 1.0)
            };
            let part = f64::from(pressure) / 10.0;
            let bow = 0.004 * down * libm::sin(std::f64::consts::PI * part);
            let signal = 0.02 + 2.0 * f64::from(pressure) + bow + 4e-4 * noise.normal();
            let _ = writeln!(rows, "{pressure},{signal:.6}");
        }
    }
    let case = "equations = \"signal = a + b*pressure\"\n[columns]\nsignal = \"output\"\npressure = \"stimulus\"\n";
    let found = diagnosed("hysteresis", &rows, case);
    assert_eq!(named(&found)[0], ["hysteresis"], "{found}");
}

#[test]
fn a_plain_square_of_what_goes_both_ways_is_no_hysteresis() {
    let mut noise = Noise(13);
    let mut rows = "mass [g],x [mm]\n".to_owned();
    for _ in 0..3 {
        for step in 0..20 {
            let mass = f64::from(if step <= 10 { step } else { 20 - step }) * 10.0;
            let x = 3.0 + 0.2 * mass + 5e-6 * mass * mass + 1e-3 * noise.normal();
            let _ = writeln!(rows, "{mass},{x:.5}");
        }
    }
    let case = "equations = \"x = x0 + k*mass\"\n[columns]\nx = \"output\"\nmass = \"stimulus\"\n";
    let found = diagnosed("spring", &rows, case);
    assert_eq!(named(&found)[0], ["quadratic"], "{found}");
}

#[test]
fn a_condition_whose_order_is_open_is_one_name() {
    let mut noise = Noise(17);
    let mut rows = "x [V],vibration [m/s^2],y [mV]\n".to_owned();
    for row in 0..48 {
        let x = f64::from(row % 6);
        // Over this range a straight line is nearly the parabola.
        let vibration = 1.0 + 0.5 * libm::sin(2.4 * f64::from(row));
        let y = 1.0 + 2.0 * x + 0.02 * vibration * vibration + 6e-3 * noise.normal();
        let _ = writeln!(rows, "{x},{vibration:.4},{y:.5}");
    }
    let case = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nvibration = \"covariate\"\n";
    let found = diagnosed("orders", &rows, case);
    let first = &found["effects"][0];
    assert_eq!(
        (&first["state"], named(&found)[0].len()),
        (&"identified".into(), 1),
        "{found}"
    );
    let variants = first["named"][0]["variants"].as_array().unwrap();
    for id in ["sensitivity", "sensitivity-quadratic"] {
        assert!(
            variants.iter().any(|variant| variant["id"] == id),
            "{variants:?}"
        );
    }
    let statement = found["statement"].as_str().unwrap();
    assert!(statement.contains("its order is open"), "{statement}");
}

#[test]
fn a_known_trace_is_held_beside_every_candidate() {
    let mut noise = Noise(19);
    let mut rows = "t [h],x [V],y [mV]\n".to_owned();
    let course: Vec<(f64, f64)> = (0..40)
        .map(|row| (0.1 * f64::from(row), f64::from(row * 7 % 9)))
        .collect();
    for (t, x) in &course {
        let _ = writeln!(rows, "{t},{x},{:.5}", 1.0 + 2.0 * x + 1e-3 * noise.normal());
    }
    let folder = folder("likeness");
    std::fs::write(folder.join("recording.csv"), rows).unwrap();
    let file = folder.join("case.toml");
    std::fs::write(&file, "recording = \"recording.csv\"\nequations = \"y = a + b*x\"\n[columns]\nt = \"time\"\nx = \"stimulus\"\ny = \"output\"\n").unwrap();
    let case = Case::load(&file, Purpose::Diagnosis).unwrap();
    let trace =
        |f: fn(f64, f64) -> f64| DVector::from_iterator(40, course.iter().map(|(t, x)| f(*t, *x)));
    let (slope, square) = (trace(|t, _| 3.0 * t), trace(|_, x| 0.5 * x * x));
    let nearest = |trace: &DVector<f64>, others: &[DVector<f64>]| {
        let all = stand_ins(&case, trace, others).unwrap();
        all.into_iter().min_by(|a, b| {
            (a.coefficients, a.left)
                .partial_cmp(&(b.coefficients, b.left))
                .unwrap()
        })
    };
    let drift = nearest(&slope, &[]).unwrap();
    assert_eq!((drift.pick.id.as_str(), drift.coefficients), ("drift", 1));
    assert!(
        drift.left < 1e-6 && (drift.size.unwrap() - 3.0).abs() < 1e-6,
        "{drift:?}"
    );
    // Beside the drift the square is seen alone.
    let curve = nearest(&square, std::slice::from_ref(&slope)).unwrap();
    assert_eq!(curve.pick.id.as_str(), "quadratic");
    assert!(curve.left < 1e-6, "{curve:?}");
    // What the declared parameters or the others hold has no likeness.
    assert!(
        stand_ins(&case, &slope, std::slice::from_ref(&slope))
            .unwrap()
            .is_empty()
    );
    assert!(
        stand_ins(&case, &trace(|_, x| 4.0 * x), &[])
            .unwrap()
            .is_empty()
    );
}

#[test]
fn a_scale_that_bends_with_temperature_far_from_zero_is_named() {
    let mut noise = Noise(14);
    let mut rows = "t [h],q [l/min],T [degC],f [Hz]\n".to_owned();
    for row in 0..80 {
        let t = 0.04 * f64::from(row);
        let q = 5.0 + 9.5 * f64::from(row * 7 % 11);
        let temperature = 22.5 + 2.4 * libm::sin(1.9 * t) + 0.3 * noise.normal();
        let warm = temperature - 22.5;
        let f = 2.0 + 11.9 * q * (1.0 - 2e-4 * warm - 8e-5 * warm * warm);
        let _ = writeln!(
            rows,
            "{t:.2},{q},{temperature:.2},{:.3}",
            f + 0.05 * noise.normal()
        );
    }
    let case = "equations = \"f = f0 + K*q\"\n[columns]\nt = \"time\"\nf = \"output\"\nq = \"stimulus\"\nT = \"covariate\"\n[noise]\nu = \"0.05 Hz\"\n";
    let found = diagnosed("bent-scale", &rows, case);
    let (names, label) = first_labelled(&found);
    assert_eq!(names, ["sensitivity-scale-quadratic"], "{found}");
    assert_eq!(label, "with a linear part");
}

#[test]
fn what_one_of_several_outputs_has_alone_is_not_taken_for_its_noise() {
    let mut noise = Noise(16);
    let mut rows = "t [min],x [gn],y [gn],z [gn],ax [gn],ay [gn],az [gn]\n".to_owned();
    for row in 0..36 {
        let (turn, tilt) = (0.7 * f64::from(row), 1.3 * libm::sin(2.1 * f64::from(row)));
        let (sin, cos) = (libm::sin(tilt), libm::cos(tilt));
        let g = [cos * libm::cos(turn), cos * libm::sin(turn), sin];
        let read = [g[0], g[1] + 3e-4 * g[1] * g[2], g[2]].map(|a| a + 2e-5 * noise.normal());
        let _ = writeln!(
            rows,
            "{},{:.6},{:.6},{:.6},{:.6},{:.6},{:.6}",
            2 * row,
            g[0],
            g[1],
            g[2],
            read[0],
            read[1],
            read[2]
        );
    }
    let case = "equations = [\"ax = bx + Sx*x\", \"ay = by + Sy*y\", \"az = bz + Sz*z\"]\n[columns]\nt = \"time\"\nx = \"stimulus\"\ny = \"stimulus\"\nz = \"stimulus\"\nax = \"output\"\nay = \"output\"\naz = \"output\"\n";
    let found = diagnosed("one-output", &rows, case);
    let (names, label) = first_labelled(&found);
    assert!(
        found["verdict"] != "none" && label.contains("ay"),
        "{names:?} {label} {found}"
    );
}

#[test]
fn a_coarse_display_rounds() {
    let mut noise = Noise(13);
    let mut rows = "x [mm],y [mm]\n".to_owned();
    for row in 0..80 {
        let x = 0.0137 * f64::from(row * 7 % 80);
        let y = 0.012 + 0.998 * x + 0.0005 * noise.normal();
        let _ = writeln!(rows, "{x:.4},{:.2}", (y / 0.02).round() * 0.02);
    }
    let case = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\n[noise]\nu = \"0.0005 mm\"\n";
    let found = diagnosed("display", &rows, case);
    assert_eq!(named(&found)[0], ["quantisation"], "{found}");
}

#[test]
fn a_line_with_two_reflections_ripples_along_the_frequency() {
    let mut noise = Noise(17);
    let mut rows = "f [GHz],loss [dB]\n".to_owned();
    for row in 0..71 {
        let f = 1.0 + 0.1 * f64::from(row);
        // Two reflections of 0.05, 30 cm apart: |1/(1 − Γ²e^{−2jβl})| in decibels.
        let turn = std::f64::consts::TAU * 2.0 * 0.3 * f / 0.299_792;
        let loss = 0.4 + 0.05 * f - 20.0 * libm::log10(1.0 + 0.0025 * libm::cos(turn));
        let _ = writeln!(rows, "{f:.2},{:.5}", loss + 0.004 * noise.normal());
    }
    let case = "equations = \"loss = a + b*f\"\n[columns]\nloss = \"output\"\nf = \"stimulus\"\n[noise]\nu = \"0.004 dB\"\n";
    let found = diagnosed("line", &rows, case);
    let (names, label) = first_labelled(&found);
    assert_eq!(names, ["wave"], "{found}");
    let period: f64 = label.split(' ').nth(1).unwrap().parse().unwrap();
    assert!((period - 0.4997).abs() < 0.03, "{label}");
}

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

/// Six mounts of a triad of gyroscopes on a rate table, at rates of both signs and three angles of the
/// table: what each axis shows for a rate vector and a force in the sensor.
fn rate_table(shown: impl Fn(usize, [f64; 3], [f64; 3]) -> f64, seed: u64) -> String {
    // Columns: laboratory axes in the sensor, for the table at zero; the last is the table's axis.
    let mounts: [[[f64; 3]; 3]; 6] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
        [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
    ];
    let mut noise = Noise(seed);
    let mut rows =
        "mount,rate [deg/s],table [deg],cx,cy,cz,wx [deg/s],wy [deg/s],wz [deg/s]\n".to_owned();
    for (number, [east, north, up]) in mounts.iter().enumerate() {
        for rate in [-100.0, -40.0, 40.0, 100.0] {
            for table in [0.0_f64, 120.0, 240.0] {
                let (s, c) = (libm::sin(table.to_radians()), libm::cos(table.to_radians()));
                // The rotation of the Earth at 48° north, seen from the turned table.
                let earth = [0.0028 * s, 0.0028 * c, 0.0031];
                let turning = [0, 1, 2].map(|a| {
                    up[a] * rate + east[a] * earth[0] + north[a] * earth[1] + up[a] * earth[2]
                });
                let _ = write!(
                    rows,
                    "m{number},{rate},{table},{},{},{}",
                    up[0], up[1], up[2]
                );
                for axis in 0..3 {
                    let _ = write!(
                        rows,
                        ",{:.6}",
                        shown(axis, turning, *up) + 0.0004 * noise.normal()
                    );
                }
                rows.push('\n');
            }
        }
    }
    rows
}

const RATE_TABLE: &str = r#"
equations = [
    "wx = bx + Sxx*rate*cx + Sxy*rate*cy + Sxz*rate*cz",
    "wy = by + Syx*rate*cx + Syy*rate*cy + Syz*rate*cz",
    "wz = bz + Szx*rate*cx + Szy*rate*cy + Szz*rate*cz",
]
[columns]
wx = "output"
wy = "output"
wz = "output"
mount = "position"
rate = "stimulus"
table = "angle"
cx = "stimulus"
cy = "stimulus"
cz = "stimulus"
[noise]
u = "0.0004 deg/s"
"#;

#[test]
fn gyroscopes_feel_the_earth_turn() {
    let rows = rate_table(|axis, turning, _| turning[axis] * 1.01 + 0.02, 23);
    let found = diagnosed("earth", &rows, RATE_TABLE);
    assert_eq!(named(&found), [["laboratory-field"]], "{found}");
}

#[test]
fn a_gyroscope_feels_gravity() {
    let shown = |axis: usize, turning: [f64; 3], up: [f64; 3]| {
        // The Earth's rotation is corrected already; its tilted proof mass feels gravity along two axes.
        let rate = turning.iter().zip(up).map(|(w, u)| w * u).sum::<f64>() - 0.0031;
        let gravity = if axis == 1 {
            0.003 * up[1] - 0.002 * up[2]
        } else {
            0.0
        };
        1.005 * up[axis] * rate - 0.01 + gravity
    };
    let found = diagnosed("gravity", &rate_table(shown, 29), RATE_TABLE);
    assert_eq!(named(&found), [["cross-sensitivity"]], "{found}");
    assert_eq!(found["effects"][0]["named"][0]["along"], "cx, cy, cz");
}

/// A triad of accelerometers in eighteen orientations, twice: what the axes show for a force in the sensor,
/// with an error of the elevation that the stand really has.
fn stand(error: impl Fn(f64) -> f64, shown: impl Fn([f64; 3]) -> [f64; 3], seed: u64) -> String {
    let mut poses: Vec<(f64, f64)> = (0..8).map(|k| (45.0 * f64::from(k), 0.0)).collect();
    for k in 0..4 {
        poses.extend([(90.0 * f64::from(k), 45.0), (90.0 * f64::from(k), -45.0)]);
    }
    poses.extend([(0.0, 90.0), (0.0, -90.0)]);
    let mut noise = Noise(seed);
    let mut rows = "azimuth [deg],elevation [deg],ax [gn],ay [gn],az [gn]\n".to_owned();
    for (azimuth, elevation) in poses.iter().chain(poses.iter().rev()) {
        let a = azimuth.to_radians();
        let e = elevation.to_radians() + error(elevation.to_radians());
        let force = [
            libm::cos(e) * libm::cos(a),
            libm::cos(e) * libm::sin(a),
            libm::sin(e),
        ];
        let _ = write!(rows, "{azimuth},{elevation}");
        for reading in shown(force) {
            let _ = write!(rows, ",{:.7}", reading + 2e-5 * noise.normal());
        }
        rows.push('\n');
    }
    rows
}

fn stand_case() -> String {
    let row = |a: char| {
        format!(
            "    \"a{a} = b{a} + M{a}x*cos(elevation)*cos(azimuth) + M{a}y*cos(elevation)*sin(azimuth) + M{a}z*sin(elevation)\",\n"
        )
    };
    format!(
        "equations = [\n{}]\n[columns]\nazimuth = \"angle\"\nelevation = \"angle\"\nax = \"output\"\nay = \"output\"\naz = \"output\"\n[noise]\nu = \"2e-5 gn\"\n",
        ['x', 'y', 'z'].map(row).concat()
    )
}

#[test]
fn an_eccentric_elevation_reaches_all_axes_with_one_size() {
    let rows = stand(
        |e| 1.5e-4 * libm::sin(e + 0.6),
        |force| force.map(|f| 1.002 * f - 0.003),
        31,
    );
    let found = diagnosed("elevation", &rows, &stand_case());
    let effect = &found["effects"][0]["named"][0];
    assert_eq!(named(&found)[0], ["eccentricity"], "{found}");
    assert_eq!(effect["along"], "elevation");
    assert_eq!(effect["size"].as_array().map(Vec::len), Some(2));
}

#[test]
fn a_pendulum_that_swings_out_multiplies_two_inputs() {
    let shown = |[x, y, z]: [f64; 3]| [x + 0.001, 0.999 * y + 2e-4 * y * x, z];
    let found = diagnosed("product", &stand(|_| 0.0, shown, 37), &stand_case());
    assert_eq!(named(&found)[0], ["cross-product"], "{found}");
    let label = &found["effects"][0]["named"][0]["variants"][0]["label"];
    assert!(
        label.as_str().unwrap_or_default().starts_with("ay"),
        "{label}"
    );
}

/// A converter at 60 voltages in an order of no meaning, with an error by the voltage.
fn converter(seed: u64, error: impl Fn(f64) -> f64) -> String {
    let mut noise = Noise(seed);
    let mut rows = "V [V],code [V],t [s]\n".to_owned();
    for row in 0..60_usize {
        let volts = 0.1 + 0.08 * ((row * 37) % 60) as f64;
        let code = 0.001 + 1.0003 * volts + error(volts) + 3e-4 * noise.normal();
        let _ = writeln!(rows, "{volts:.2},{code:.5},{}", 5 * row);
    }
    rows
}

#[test]
fn a_step_at_one_value_of_a_stimulus_has_a_name_and_a_place() {
    let case = "equations = \"code = o + k*V\"\n[columns]\nV = \"stimulus\"\ncode = \"output\"\nt = \"time\"\n";
    let transition = converter(5, |volts| if volts > 2.5 { 1.5e-3 } else { 0.0 });
    let range = converter(6, |volts| if volts > 3.2 { 6e-4 * volts } else { 0.0 });
    for (rows, name, place) in [
        (transition, "transition", "V between 2.5 and 2.58"),
        (range, "transition-scale", "V between 3.14 and 3.22"),
    ] {
        let found = diagnosed("transition", &rows, case);
        assert_eq!(named(&found)[0][0], name, "{found}");
        let variant = &found["effects"][0]["named"][0]["variants"][0];
        assert_eq!(variant["label"], place);
    }
}
