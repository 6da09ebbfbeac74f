//! Noise that differs from reading to reading: what is told of it, and that it raises no false alarm.

use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with, folder, gumption, named, planned};

/// A photodiode at twenty powers over three decades, three times each in an order of no meaning; noise by
/// the number of the power and the current.
fn photodiode(seed: u64, u: impl Fn(usize, f64) -> f64) -> String {
    let mut noise = Noise(seed);
    // Seeds close to each other begin alike.
    for _ in 0..20 {
        noise.uniform();
    }
    let mut text = "P [µW],I [µA],lamp [°C],pressure [kPa],t [s]\n".to_owned();
    let mut pressure = 101.2;
    for row in 0..60 {
        let level = (row * 37 + 11) % 60 / 3;
        let power = libm::pow(10.0, 3.0 * level as f64 / 19.0);
        let current = 0.15 + 0.4123 * power;
        let reading = current + u(level, current) * noise.normal();
        let lamp = 31.0 + 1.5 * libm::sin(row as f64 * 0.157) + 0.1 * noise.normal();
        pressure += 0.0125 * noise.normal();
        let _ = writeln!(
            text,
            "{power:.3},{reading:.3},{lamp:.2},{pressure:.3},{}",
            20 * row
        );
    }
    text
}

const COLUMNS: &str = r#"
equations = "I = dark + s * P"

[columns]
I = "output"
P = "stimulus"
lamp = "covariate"
pressure = "covariate"
t = "time"

[diagnosis]
draws = 1024
"#;

const REPLICATES: &str = "\n[noise]\nreplicates = [\"P\"]\n";

fn growing(_: usize, current: f64) -> f64 {
    libm::hypot(0.05, 0.002 * current)
}

fn origin(found: &Value) -> &str {
    found["noise"]["origin"].as_str().unwrap_or("")
}

/// Recordings of an adequate model in which something is found.
fn alarms(name: &str, case: &str) -> usize {
    let alarm = |seed: &u64| {
        let found = diagnosed_with(name, &photodiode(*seed, growing), case);
        assert!(
            origin(&found).contains("growing with the reading"),
            "{found}"
        );
        found["verdict"] != "none"
    };
    (1..=12).filter(alarm).count()
}

#[test]
fn noise_that_grows_over_decades_raises_no_alarm() {
    // One in a hundred is allowed for; two of twelve happen once in two hundred.
    let found = alarms("growing", COLUMNS);
    assert!(found < 2, "{found} alarms");
}

#[test]
fn replicates_whose_scatter_grows_raise_no_alarm() {
    let found = alarms("growing-replicates", &format!("{COLUMNS}{REPLICATES}"));
    assert!(found < 2, "{found} alarms");
}

#[test]
fn replicates_of_one_scatter_have_one_uncertainty() {
    let case = format!("{COLUMNS}{REPLICATES}");
    let found = diagnosed_with("even-replicates", &photodiode(1, |_, _| 0.3), &case);
    assert_eq!(found["verdict"], "none", "{found}");
    assert_eq!(origin(&found), "from replicates, ν = 40");
}

#[test]
fn replicates_that_scatter_unevenly_are_told() {
    let odd = |level: usize, _: f64| if level.is_multiple_of(2) { 0.03 } else { 0.3 };
    let folder = folder("uneven-replicates");
    std::fs::write(folder.join("recording.csv"), photodiode(1, odd)).expect("written");
    let case = format!("recording = \"recording.csv\"\n{COLUMNS}{REPLICATES}");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    for (language, words) in [("en", "scatter unevenly"), ("zh", "分散性不一致")] {
        let (good, text) = gumption(&folder, &["diagnose", "case.toml", "--lang", language]);
        assert!(good && text.contains(words), "{text}");
    }
}

/// What a simulation adds to the model, row by row.
fn errors(simulated: &str, output: &str) -> Vec<f64> {
    let mut lines = simulated.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |name: &str| header.iter().position(|one| *one == name);
    let model = place(&format!("{output}_model")).expect("the model");
    let of = header.iter().position(|one| one.starts_with(output));
    let of = of.expect("the output");
    let error = |line: &str| -> f64 {
        let fields: Vec<f64> = line
            .split(',')
            .map(|x| x.parse().unwrap_or(f64::NAN))
            .collect();
        fields[of] - fields[model]
    };
    lines.map(error).collect()
}

#[test]
fn plans_and_simulations_have_the_noise_of_the_recording() {
    let folder = folder("planned-noise");
    std::fs::write(folder.join("recording.csv"), photodiode(1, growing)).expect("written");
    for claim in ["", REPLICATES] {
        let case = format!("recording = \"recording.csv\"\n{COLUMNS}{claim}");
        let plan = planned(&folder, &case);
        assert!(
            origin(&plan).contains("growing with the reading"),
            "{claim}"
        );
        assert_eq!(plan["noise"]["claimed"], true, "{claim}");
        let (good, simulated) = gumption(&folder, &["simulate", "case.toml"]);
        let errors = errors(&simulated, "I");
        let least = |row: &usize| (row * 37 + 11) % 60 / 3 < 5;
        let largest = errors.iter().enumerate();
        let largest = largest
            .filter(|(row, _)| least(row))
            .map(|(_, error)| error.abs());
        let largest = largest.fold(0.0, f64::max);
        assert!(good && largest < 0.5, "{claim} {largest}");
    }
}

/// The residuals of five readings on a line have three degrees of freedom: s and the leverages give the band by t, and an input that is
/// known well costs none.
#[test]
fn the_band_of_a_simulation_is_that_of_t() {
    let folder = folder("band");
    let readings = [1.02, 2.97, 5.05, 6.96, 9.01];
    let rows = readings.iter().enumerate();
    let rows = rows.map(|(x, y)| format!("{x},{y}\n")).collect::<String>();
    std::fs::write(
        folder.join("recording.csv"),
        format!("x [mm],U [V]\n{rows}"),
    )
    .expect("written");
    let mean = readings.iter().sum::<f64>() / 5.0;
    let x = |row: usize| row as f64 - 2.0;
    let slope = (0..5).map(|row| x(row) * readings[row]).sum::<f64>() / 10.0;
    let left = (0..5).map(|row| (readings[row] - mean - slope * x(row)).powi(2));
    let s = (left.sum::<f64>() / 3.0).sqrt();
    for known in ["", " * (1 + e)\"\n[input.e]\nu = 1e-9\n#"] {
        let case = format!(
            "recording = \"recording.csv\"\nequations = \"U = a + K * x{known}\"\n[columns]\nU = \"output\"\nx = \"stimulus\"\n"
        );
        std::fs::write(folder.join("case.toml"), case).expect("written");
        let (good, simulated) = gumption(&folder, &["simulate", "case.toml"]);
        assert!(good, "{simulated}");
        for (row, line) in simulated.lines().skip(1).enumerate() {
            let fields: Vec<f64> = line
                .split(',')
                .filter_map(|field| field.parse().ok())
                .collect();
            let [.., low, high] = fields.as_slice() else {
                panic!("{line}");
            };
            // t for 97.5 % and ν = 3.
            let expected = 3.182_446 * s * (1.2 + x(row).powi(2) / 10.0).sqrt();
            let found = (high - low) / 2.0;
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        }
    }
}

/// Before outputs are recorded, the errors that are stated of each of their readings tell the noise; the recording has its unit.
#[test]
fn what_is_stated_of_each_reading_is_the_noise_of_a_plan() {
    let folder = folder("stated-readings");
    std::fs::write(folder.join("recording.csv"), "x [mm]\n0\n1\n2\n3\n").expect("written");
    let case = "recording = \"recording.csv\"\nequations = \"U = a + K * x\"\n[columns]\nU = \"output\"\nx = \"stimulus\"\n[reading.U]\nunit = \"mV\"\nu = 0.05\n[parameter]\na = { start = \"1 mV\" }\nK = { start = \"2 mV/mm\" }\n";
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, simulated) = gumption(&folder, &["simulate", "case.toml"]);
    assert!(
        good && simulated.starts_with("x [mm],U [mV],"),
        "{simulated}"
    );
    let largest = errors(&simulated, "U")
        .into_iter()
        .fold(0.0, |most: f64, error| most.max(error.abs()));
    assert!((0.001..0.25).contains(&largest), "{simulated}");
}

#[test]
fn noise_that_only_a_recording_shows_is_said_to_be_unknown() {
    let folder = folder("unknown-noise");
    std::fs::write(folder.join("recording.csv"), "P [µW]\n1\n1\n2\n2\n3\n3\n").expect("written");
    let model = "recording = \"recording.csv\"\nequations = \"I = dark + s * P\"\n[columns]\nI = { role = \"output\", unit = \"µA\" }\nP = \"stimulus\"\n[parameter]\ns = { start = 0.4 }\ndark = { start = 0 }\n";
    for (claim, why) in [
        ("", "not claimed, and no outputs are recorded"),
        (REPLICATES, "once their outputs are recorded"),
    ] {
        let plan = planned(&folder, &format!("{model}{claim}"));
        assert!(origin(&plan).contains(why), "{plan:#}");
        assert_eq!(plan["noise"]["claimed"], false, "{claim}");
    }
}

#[test]
fn simulated_noise_walks_where_it_is_claimed_to() {
    let folder = folder("simulated-walk");
    let rows: String = (0..200).map(|row| format!("{row},{}\n", row % 7)).collect();
    std::fs::write(folder.join("recording.csv"), format!("t [s],x\n{rows}")).expect("written");
    let case = "recording = \"recording.csv\"\nequations = \"y = a + b * x\"\n[columns]\ny = { role = \"output\", unit = \"V\" }\nx = \"stimulus\"\nt = \"time\"\n[parameter]\na = { start = 1 }\nb = { start = 2 }\n[noise]\nu = \"1 mV\"\nwalk = \"1 V\"\n";
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, simulated) = gumption(&folder, &["simulate", "case.toml"]);
    assert!(good, "{simulated}");
    // A step of the walk in one second has a standard deviation of 1/60 V; white noise of the same size would
    // jump by several times as much.
    let errors = errors(&simulated, "y");
    let steps = errors.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
    let step = (steps.sum::<f64>() / 199.0).sqrt();
    assert!((0.8..1.25).contains(&(step * 60.0)), "{step}");
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
    let found = diagnosed_with("bursts", &rows, case);
    let statement = found["statement"].as_str().unwrap_or_default();
    for row in ["row 18", "row 26", "row 46"] {
        assert!(statement.contains(row), "{statement}");
    }
    assert!(statement.contains("drift"), "{statement}");
    assert!(!statement.contains("smoothly"), "{statement}");
}

/// Four operators of whom the last scatters eight times as much as the first.
fn operators(seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut rows = "operator,load [N],reading [mV]\n".to_owned();
    for row in 0..100_usize {
        let (operator, load) = (row % 4, (row * 7 % 20) as f64);
        let u = 0.02 * [1.0, 2.0, 4.0, 8.0][operator];
        let reading = 0.3 + 1.7 * load + u * noise.normal();
        let _ = writeln!(
            rows,
            "{},{load},{reading:.4}",
            ["A", "B", "C", "D"][operator]
        );
    }
    rows
}

#[test]
fn operators_that_scatter_unlike_one_another_have_a_u_of_their_own() {
    let case = "equations = \"reading = a + b*load\"\n[columns]\noperator = \"factor\"\nload = \"stimulus\"\nreading = \"output\"\n";
    let mut alarms = 0;
    for seed in 90..100 {
        let found = diagnosed_with("operators", &operators(seed), case);
        alarms += usize::from(found["verdict"] != "none");
        let labels = &found["noise"]["by_label"][0]["labels"];
        let factor = |at: usize| labels[at]["factor"].as_f64().unwrap_or(f64::NAN);
        assert!((4.0..16.0).contains(&(factor(3) / factor(0))), "{labels}");
    }
    // One u for all of them would take the last one for wrong readings and effects.
    assert!(alarms < 2, "{alarms} alarms of 10");
    let folder = folder("operators-told");
    std::fs::write(folder.join("recording.csv"), operators(90)).unwrap();
    let case = format!("recording = \"recording.csv\"\n{case}");
    std::fs::write(folder.join("case.toml"), case).unwrap();
    let (_, text) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(
        text.contains("differing from operator to operator"),
        "{text}"
    );
}

/// One column of standard uncertainties serves outputs in V and in mV: by Σu²/n of ten rows at places about zero, u(a) = 2 mV/√10.
#[test]
fn standard_uncertainties_of_rows_are_in_the_unit_of_each_output() {
    let mut noise = Noise(83);
    let mut rows = "x [mm],U [V],W [mV],s [µV]\n".to_owned();
    for row in 0..10 {
        let x = f64::from(row) - 4.5;
        let [one, other] = [0, 1].map(|_| 0.002 * noise.normal());
        let (first, second) = (0.1 + 0.2 * x + one, 1e3 * (0.3 - 0.1 * x + other));
        let _ = writeln!(rows, "{x},{first:.5},{second:.2},2000");
    }
    let case = "equations = [\"U = a + b*x\", \"W = c + d*x\"]\n[columns]\nx = \"stimulus\"\nU = \"output\"\nW = \"output\"\ns = \"u\"\n";
    let found = diagnosed_with("units-of-u", &rows, case);
    for (name, expected) in [("a", 0.002 / 10.0_f64.sqrt()), ("c", 2.0 / 10.0_f64.sqrt())] {
        let parameters = found["parameters"].as_array().into_iter().flatten();
        let u = parameters.filter(|one| one["name"] == name);
        let u: Vec<f64> = u.filter_map(|one| one["u"].as_f64()).collect();
        assert_eq!(u.len(), 1, "{:#}", found["parameters"]);
        assert!((u[0] / expected - 1.0).abs() < 1e-9, "{name}: {u:?}");
    }
}

/// Errors of Student's distribution with four degrees of freedom, made of five normal ones each.
fn wild(noise: &mut Noise) -> f64 {
    let squares: f64 = (0..4).map(|_| noise.normal().powi(2)).sum();
    noise.normal() / (squares / 4.0).sqrt()
}

/// A load cell up and down at eleven loads, three times, with an error for each reading.
fn load_cell(seed: u64, error: impl Fn(&mut Noise, usize) -> f64) -> String {
    let mut noise = Noise(seed);
    for _ in 0..20 {
        noise.uniform();
    }
    let mut text = "load [kN],U [mV],t [min]\n".to_owned();
    for row in 0..66_usize {
        let load = 10.0 * (row % 22).min(21 - row % 22) as f64;
        let reading = 0.013 + 0.02 * load + 2e-4 * error(&mut noise, row);
        let _ = writeln!(text, "{load},{reading:.6},{}", 2 * row);
    }
    text
}

const LOAD_CELL: &str = "equations = \"U = a + b*load\"\n[columns]\nload = \"stimulus\"\nU = \"output\"\nt = \"time\"\n";

#[test]
fn heavy_tails_of_estimated_noise_raise_no_alarm() {
    let found = |seed| diagnosed_with("tails", &load_cell(seed, |noise, _| wild(noise)), LOAD_CELL);
    let all: Vec<Value> = (1..=16).map(found).collect();
    let alarms = all.iter().filter(|found| found["verdict"] != "none");
    // Of normal errors alone every third would be called wrong readings, or bursts.
    assert!(alarms.count() < 2);
    let heavy = |found: &&Value| origin(found).contains("tails are heavier");
    assert!(all.iter().filter(heavy).count() >= 4);
}

#[test]
fn one_wrong_reading_among_normal_ones_is_no_heavy_tail() {
    let error = |noise: &mut Noise, row| noise.normal() + if row == 40 { 12.0 } else { 0.0 };
    for seed in 1..=4 {
        let found = diagnosed_with("one-wrong", &load_cell(seed, error), LOAD_CELL);
        assert_eq!(named(&found), ["outlier"], "{found}");
    }
}

/// A shift that every row of a series has is held against such effects, not against what single wild readings look like.
#[test]
fn a_shift_is_seen_beside_heavy_tails() {
    let mut heavy = 0;
    for seed in 1..=4 {
        let mut noise = Noise(100 + seed);
        let mut text = "probe,R [mΩ]\n".to_owned();
        for row in 0..240_usize {
            let shift = if row % 4 == 2 { 1.0 } else { 0.0 };
            let reading = 97.0 + 0.3 * (shift + wild(&mut noise));
            let _ = writeln!(text, "P{},{reading:.4}", row % 4 + 1);
        }
        let case = "equations = \"R = R_0\"\n[columns]\nR = \"output\"\nprobe = \"factor\"\n[parameter]\nR_0 = { start = \"97 mΩ\" }\n";
        let found = diagnosed_with("shift-beside-tails", &text, case);
        heavy += usize::from(origin(&found).contains("tails are heavier"));
        let names = named(&found);
        assert!(names.contains(&"level-shift".to_owned()), "{names:?}");
        assert!(!names.contains(&"outlier".to_owned()), "{names:?}");
    }
    assert!(heavy >= 2);
}

/// A gyroscope whose output is 2.5 V at rest, and whose noise grows with the rate.
#[test]
fn noise_may_grow_about_the_zero_of_the_output() {
    for seed in 1..=6 {
        let mut noise = Noise(200 + seed);
        let mut text = "rate [deg/s],U [V],t [s]\n".to_owned();
        for row in 0..126_i32 {
            let rate = f64::from(10 * (row % 21) - 100);
            let u = libm::hypot(0.0005, 6e-5 * rate);
            let reading = 2.5 + 0.02 * rate + u * noise.normal();
            let _ = writeln!(text, "{rate},{reading:.5},{row}");
        }
        let case = "equations = \"U = a + b*rate\"\n[columns]\nrate = \"stimulus\"\nU = \"output\"\nt = \"time\"\n";
        let found = diagnosed_with("grows-about-zero", &text, case);
        assert_eq!(found["verdict"], "none", "{}", found["statement"]);
        let growth = &found["noise"]["growth"][0];
        assert_eq!(growth["with"], "signal", "{growth}");
        let slope = growth["proportional"].as_f64().unwrap_or(0.0);
        assert!((slope / 3e-3 - 1.0).abs() < 0.3, "{slope}");
        assert!(origin(&found).contains("(y − y₀)"), "{}", origin(&found));
    }
}

/// A pressure transducer with a bend at 4.5 MPa, whose scale follows the ambient pressure, which walks.
fn transducer(seed: u64) -> String {
    let mut noise = Noise(seed);
    for _ in 0..20 {
        noise.uniform();
    }
    let mut text = "t [h],p [MPa],ambient [hPa],U [mV]\n".to_owned();
    let mut ambient = 0.0;
    for row in 0..63_i32 {
        ambient += 0.35 * noise.normal();
        let p = f64::from((row % 14).min(14 - row % 14));
        let true_reading = 0.4 + 10.0 * p + 0.008 * (p - 4.5).max(0.0) + 7e-4 * p * ambient;
        let reading = true_reading + 0.0045 * noise.normal();
        let _ = writeln!(
            text,
            "{:.2},{p},{:.3},{reading:.5}",
            0.03 * f64::from(row),
            1013.0 + ambient
        );
    }
    text
}

/// Two effects look like a scale that wanders as long as each is looked for alone; what both explain is no noise.
#[test]
fn a_second_effect_is_held_against_noise_beside_the_first() {
    let case = "equations = \"U = a + b*p\"\n[columns]\nt = \"time\"\np = \"stimulus\"\nambient = \"covariate\"\nU = \"output\"\n";
    for (seed, effects) in [(3, 1), (5, 1), (9, 2), (15, 2)] {
        let found = diagnosed_with("two-beside-noise", &transducer(seed), case);
        let names = named(&found);
        assert!(names.contains(&"kink".to_owned()), "{seed}: {names:?}");
        let scale = names.contains(&"sensitivity-scale".to_owned());
        assert!(scale || effects == 1, "{seed}: {names:?}");
        assert!(found["effects"].as_array().map_or(0, Vec::len) >= effects);
        // Each p counts the recordings of the test that gave it, with the one observed.
        for level in found["levels"].as_array().expect("levels") {
            let figure = |key: &str| level[key].as_f64().unwrap_or(f64::NAN);
            let counted = figure("p") * (figure("draws") + 1.0);
            assert!((counted - counted.round()).abs() < 1e-6, "{level}");
        }
    }
}

/// Numbers that were computed, or a good gauge at round values: what is left is the rounding of doubles, which has a form as well.
#[test]
fn a_recording_that_the_model_meets_exactly_shows_nothing() {
    let of = |read: fn(f64) -> String| {
        let row = |row: u32| {
            let x = f64::from(5 * (row * 7 % 33));
            format!("{row},{x},{}\n", read(x))
        };
        "n,x [mm],y [mm]\n".to_owned() + &(0..33).map(row).collect::<String>()
    };
    let case =
        "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nn = \"order\"\n";
    for (name, rows) in [
        ("exact-line", of(|x| format!("{}", 2.0 * x + 1.0))),
        ("exact-gauge", of(|x| format!("{x:.3}"))),
        (
            "exact-decimals",
            of(|x| format!("{:.4}", 0.004 + 0.004 * x)),
        ),
    ] {
        let found = diagnosed_with(name, &rows, case);
        assert_eq!(found["verdict"], "none", "{found}");
        let statement = found["statement"].as_str().unwrap_or_default();
        assert!(statement.contains("exactly"), "{statement}");
    }
}

/// A frequency sensor has its constant as a factor: 40 kHz at rest, and 1 kHz of span with which its noise grows.
#[test]
fn noise_may_grow_about_what_the_model_gives_at_rest() {
    let alarm = |seed: &u64| {
        let mut noise = Noise(*seed);
        let mut rows = "p [MPa],f [Hz],t [min]\n".to_owned();
        for row in 0..96 {
            let p = 5.0 * f64::from(row * 7 % 12);
            let f = 40_000.0 * (1.0 + 4.2e-4 * p);
            let shown = f + 2e-4 * (f - 40_000.0) * noise.normal() + 0.003 * noise.normal();
            let _ = writeln!(rows, "{p},{shown:.5},{}", 2 * row);
        }
        let case = "equations = \"f = f0*(1 + b*p)\"\n[columns]\nf = \"output\"\np = \"stimulus\"\nt = \"time\"\n[parameter]\nf0 = { start = 40000 }\nb = { start = 4e-4 }\n";
        let found = diagnosed_with("noise-of-a-span", &rows, case);
        assert!(
            origin(&found).contains("where nothing is applied"),
            "{}",
            origin(&found)
        );
        found["verdict"] != "none"
    };
    assert_eq!((91..97).filter(alarm).count(), 0);
}

/// A line whose zero follows the temperature, or not, with noise of 10 µV that is claimed to be 5.5 µV.
fn short_of_noise(shift: f64) -> Value {
    let mut noise = Noise(77);
    let mut rows = "t [min],x [mm],T [°C],y [mV]\n".to_owned();
    for row in 0..60 {
        let (x, t) = (f64::from(row % 6), 5.0 * f64::from(row));
        let warmth = 23.0 + 2.0 * libm::sin(t / 47.0) + 0.01 * noise.normal();
        let y = 1.0 + 2.0 * x + shift * (warmth - 23.0) + 0.01 * noise.normal();
        let _ = writeln!(rows, "{t},{x},{warmth:.2},{y:.4}");
    }
    let case = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nT = \"covariate\"\nt = \"time\"\n[noise]\nu = \"5.5 µV\"\n";
    diagnosed_with(&format!("short-{shift}"), &rows, case)
}

/// Scatter has no course that could be a departure of an effect from its form, and it has a part of none.
#[test]
fn a_claim_that_is_too_small_is_told_beside_an_effect() {
    let found = short_of_noise(0.02);
    let statement = found["statement"].as_str().unwrap_or_default();
    assert!(
        statement.contains("scatter beyond the claimed noise"),
        "{statement}"
    );
    assert_eq!(found["effects"][0]["state"], "identified", "{found}");
    // Alone it is nothing that a model takes in.
    let found = short_of_noise(0.0);
    let statement = found["statement"].as_str().unwrap_or_default();
    assert!(
        statement.contains("scatter beyond the claimed noise"),
        "{statement}"
    );
    assert!(found["after"].is_null(), "{found}");
}
