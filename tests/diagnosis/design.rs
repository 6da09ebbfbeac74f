//! What a design can see and tell apart, what may be there unseen and what it costs, and which further
//! measurement helps; claims about the noise; recordings that are held out.

use std::f64::consts::PI;
use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed, folder, gumption, json, named, planned};

/// Twelve positions forwards, backwards, forwards; `second` in mV adds β·sin², `third` β·sin³.
fn tumble(mounts: &[f64], second: f64, third: f64, seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "time [h],run,head [°],mount [°],U [mV]\n".to_owned();
    let mut time = 0.0;
    for (number, mount) in mounts.iter().enumerate() {
        for run in 0..3 {
            for step in 0..12 {
                let step = if run == 1 { 11 - step } else { step };
                let head = 30.0 * f64::from(step);
                let sine = libm::sin((head + mount) * PI / 180.0);
                let cosine = libm::cos((head + mount) * PI / 180.0);
                let mut output = 3.0 + 250.0 * sine + 0.5 * cosine;
                output += second * sine * sine + third * sine * sine * sine;
                output += 5e-4 * noise.normal();
                time += 0.1;
                let _ = writeln!(
                    text,
                    "{time:.1},{}-{run},{head},{mount},{output:.6}",
                    number + 1
                );
            }
        }
    }
    text
}

const TUMBLE: &str = r#"
recording = "tumble.csv"
equations = "U = K0 + K1*sin(head + mount) + Kd*cos(head + mount)"

[columns]
U = "output"
time = "time"
run = "run"
head = "angle"
mount = "angle"

[noise]
u = "0.0005 mV"
"#;

fn entry<'v>(list: &'v Value, id: &str) -> &'v Value {
    let found = list.as_array().into_iter().flatten();
    let found = found.filter(|one| one["id"] == id).collect::<Vec<_>>();
    assert!(!found.is_empty(), "{id} in {list:#}");
    found[0]
}

#[test]
fn a_plan_knows_visibilities_aliases_and_the_measurement_that_helps() {
    let folder = folder("plan");
    // Outputs are not needed.
    let design: String = tumble(&[0.0], 0.0, 0.0, 1)
        .lines()
        .map(|line| {
            line.rsplit_once(',')
                .map_or("", |(rest, _)| rest)
                .to_owned()
                + "\n"
        })
        .collect();
    std::fs::write(folder.join("tumble.csv"), design).expect("written");
    let unrecorded = TUMBLE.replace("\"output\"", "{ role = \"output\", unit = \"mV\" }");
    let values = "\n[parameter]\nK0 = { start = 0 }\nK1 = { start = 250 }\nKd = { start = 0 }\n";
    let plan = planned(&folder, &format!("{unrecorded}{values}"));
    let second = entry(&plan["effects"], "quadratic");
    let share = second["visibility"].as_f64().expect("a share");
    assert!((share - 1.0 / 3.0).abs() < 1e-9, "{share}");
    // ‖Ph‖² of sin² is 36/8; the largest shift is one.
    let least = second["detectable"].as_f64().expect("a size");
    assert!(
        (least - 6.0 * 5e-4 / 4.5_f64.sqrt()).abs() < 1e-9,
        "{least}"
    );
    assert!(second["separable"].is_null(), "Kpp is the same: {second}");
    let measurements = plan["measurements"].as_array().expect("a list");
    let helps = |name: &str, a: &str, b: &str| {
        let one = measurements.iter().find(|one| one["name"] == name);
        let one = one.unwrap_or_else(|| panic!("{name} in {measurements:#?}"));
        let pairs = one["tells_apart"].as_array().into_iter().flatten();
        pairs
            .filter_map(Value::as_str)
            .any(|pair| pair.contains(a) && pair.contains(b))
    };
    let (third, eccentric) = ("third-order", "eccentricity");
    assert!(helps(
        "the same once more with mount at 90 °",
        third,
        eccentric
    ));
    assert!(!helps(
        "the same once more with mount at 180 °",
        third,
        eccentric
    ));
    assert!(!helps("the same once more", third, eccentric));
}

#[test]
fn measurements_of_the_user_s_own_are_judged() {
    let folder = folder("actions");
    std::fs::write(folder.join("tumble.csv"), tumble(&[0.0], 0.0, 0.0, 1)).expect("written");
    let rows = tumble(&[90.0], 0.0, 0.0, 1).replace(",U [mV]", ",U2 [mV]");
    std::fs::write(folder.join("more.csv"), rows).expect("written");
    let actions = r#"
[[action]]
name = "from a file"
rows = "more.csv"

[[action]]
name = "lists"
cost = 0.5
rows = { head = [0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330], mount = 90, run = "9" }

[[action]]
name = "again"
again = { mount = 90 }
order = "reversed"
"#;
    let plan = planned(&folder, &format!("{TUMBLE}{actions}"));
    for name in ["from a file", "lists", "again"] {
        let measurements = plan["measurements"].as_array().into_iter().flatten();
        let found: Vec<&Value> = measurements.filter(|one| one["name"] == name).collect();
        let rows = if name == "lists" { 12 } else { 36 };
        assert_eq!(found[0]["rows"], rows, "{name}");
        let pairs = found[0]["tells_apart"].as_array().map_or(0, Vec::len);
        assert!(name == "lists" || pairs > 3, "{name}: {pairs}");
    }
    let wrong = format!("{TUMBLE}\n[[action]]\nname = \"x\"\nrows = {{ mount = 90, hed = [1] }}\n");
    std::fs::write(folder.join("case.toml"), wrong).expect("written");
    let (good, text) = gumption(&folder, &["plan", "case.toml"]);
    assert!(!good && text.contains("did you mean \"head\"?"), "{text}");
}

#[test]
fn a_diagnosis_names_the_measurement_that_tells_its_candidates_apart() {
    let folder = folder("separating");
    std::fs::write(folder.join("tumble.csv"), tumble(&[0.0], 0.0, 0.05, 2)).expect("written");
    let found = diagnosed(&folder, TUMBLE);
    assert!(named(&found).contains(&"cubic".to_owned()), "{found:#}");
    let measurements = found["separating"][0]["measurements"]
        .as_array()
        .expect("a list");
    let kappa = |name: &str| {
        let one = measurements.iter().find(|one| one["name"] == name);
        one.and_then(|one| one["kappa"].as_f64()).unwrap_or(0.0)
    };
    assert!(
        kappa("the same once more with mount at 90 °") > 5.0,
        "{found:#}"
    );
    assert!(kappa("the same once more") < 1.0);
    // What is recommended does decide.
    std::fs::write(
        folder.join("tumble.csv"),
        tumble(&[0.0, 90.0], 0.0, 0.05, 2),
    )
    .expect("written");
    let found = diagnosed(&folder, TUMBLE);
    assert_eq!(found["verdict"], "identified");
    assert_eq!(named(&found), ["cubic"]);
}

#[test]
fn the_budget_holds_what_may_be_there_unseen() {
    let folder = folder("budget");
    std::fs::write(folder.join("tumble.csv"), tumble(&[0.0], 0.01, 0.0, 3)).expect("written");
    let case = format!("{TUMBLE}\n[diagnosis]\ntypical = {{ cubic = 1e-6 }}\n");
    let found = diagnosed(&folder, &case);
    // A tenth of β·sin³ shows. β is uniform between ±a, a = 1e-6 of full scale, as far as that tenth does not
    // narrow it; its shift of K1 is ¾·β.
    let line = entry(&found["omitted"], "cubic");
    let shift = line["usual_shift"].as_f64().expect("a size");
    assert!((shift - 253e-6).abs() < 1e-6, "{shift}");
    let (s, seen) = (shift / 3.0_f64.sqrt(), (36.0 / 32.0_f64).sqrt() / 5e-4);
    let expected = 0.75 * s / (1.0 + s * s * seen * seen).sqrt();
    let u = line["u"]["K1"].as_f64().expect("a contribution");
    assert!((u / expected - 1.0).abs() < 1e-3, "{u} and not {expected}");
    // K2 or one of the others, which leave K0 by the whole size elsewhere: √(p·d²), p being the probability that
    // it is not the one that was adopted.
    let choice = found["choices"][0]["K0"].as_f64().expect("a contribution");
    let second = entry(&found["effects"][0]["named"], "quadratic");
    let p = second["probability"].as_f64().expect("a probability");
    let near = |p: f64| (choice - 0.01 * p.sqrt()).abs() < 5e-4;
    assert!(near(p) || near(1.0 - p), "{choice} with p = {p}");
    let arguments = ["diagnose", "case.toml", "--improved", "improved"];
    assert!(gumption(&folder, &arguments).0);
    let evaluated = json(&folder, &["eval", "improved/budget.toml", "--json"]);
    for name in ["K0", "K1", "Kd"] {
        let total = found["u_with_unseen"][name].as_f64().expect("a total");
        let measurands = evaluated["measurands"].as_array().into_iter().flatten();
        let own = measurands.filter(|one| one["name"] == name);
        let mut own = own.filter_map(|one| one["gum"]["standard_uncertainty"].as_f64());
        let u = own.next().expect("a standard uncertainty");
        // Lines below 1 % of u are left out.
        assert!((u / total - 1.0).abs() < 2e-3, "{name}: {u} and {total}");
    }
}

/// A load cell with a curvature in mV/kN², loads from `least` on.
fn load_cell(curvature: f64, least: f64, seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "load [kN],deflection [mV],humidity [%],hour [h]\n".to_owned();
    for step in 0..40 {
        let load = least + f64::from(step) * 2.5;
        let output = 0.01 + 0.02 * load + curvature * load * load + 5e-4 * noise.normal();
        let humidity = 50.0 + 0.2 * f64::from(step) + noise.normal();
        let hour = 0.1 * f64::from(step);
        let _ = writeln!(text, "{load},{output:.6},{humidity:.2},{hour:.1}");
    }
    text
}

const LOAD_CELL: &str = r#"
recording = "load-cell.csv"
equations = "deflection = a + b * load"
held_out = { file = "next.csv" }

[columns]
deflection = "output"
load = "stimulus"
humidity = "covariate"

[noise]
u = "0.5 µV"
"#;

#[test]
fn a_held_out_recording_is_predicted_better_with_the_physics() {
    let folder = folder("held-out");
    std::fs::write(folder.join("load-cell.csv"), load_cell(-2e-6, 0.0, 4)).expect("written");
    std::fs::write(folder.join("next.csv"), load_cell(-2e-6, 1.0, 5)).expect("written");
    let found = diagnosed(&folder, LOAD_CELL);
    assert_eq!(named(&found), ["quadratic"]);
    let held = &found["held_out"];
    let figure = |which: &str, key: &str| held[which][key].as_f64();
    let before = figure("before", "chi_squared").expect("a figure");
    let after = figure("after", "chi_squared").expect("a figure");
    assert!(before > 120.0 && after < 70.0, "{before} {after}");
    let rms = held["after"]["rms"][0].as_f64().expect("a figure");
    assert!(rms < 1.3 * 5e-4, "{rms}");
}

/// Two readings that were entered in exchanged order say nothing of another recording, which has its own.
#[test]
fn a_slip_in_one_recording_need_not_be_in_another() {
    let slipped = |row: usize, seed: u64| {
        let text = load_cell(0.0, 0.0, seed);
        let mut lines: Vec<Vec<&str>> =
            text.lines().map(|line| line.split(',').collect()).collect();
        let readings = [lines[row][1], lines[row + 3][1]];
        (lines[row][1], lines[row + 3][1]) = (readings[1], readings[0]);
        let lines: Vec<String> = lines.iter().map(|cells| cells.join(",")).collect();
        lines.join("\n")
    };
    let folder = folder("slips");
    std::fs::write(folder.join("load-cell.csv"), slipped(10, 6)).expect("written");
    std::fs::write(folder.join("next.csv"), slipped(25, 7)).expect("written");
    let found = diagnosed(&folder, LOAD_CELL);
    assert_eq!(named(&found), ["swapped"]);
    assert_eq!(found["effects"][0]["state"], "identified", "{found}");
}

/// A load cell up and down twice, whose noise wanders.
fn wandering_load_cell(curvature: f64, seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "load [kN],deflection [mV],humidity [%],hour [h]\n".to_owned();
    let mut error = 0.0;
    for step in 0..80 {
        let load = 5.0 * f64::from(20 - (step % 40 - 20i32).abs());
        error = 0.8 * error + 0.6 * noise.normal();
        let output = 0.01 + 0.02 * load + curvature * load * load + 5e-4 * error;
        let humidity = 50.0 + noise.normal();
        let _ = writeln!(
            text,
            "{load},{output:.6},{humidity:.2},{:.1}",
            0.1 * f64::from(step)
        );
    }
    text
}

/// Of correlated noise nobody knows how the errors of another recording scatter, and no p contradicts: what does not show there is
/// a likeness.
#[test]
fn what_does_not_show_in_another_recording_is_a_likeness() {
    let state = |name: &str, in_next: f64| {
        let folder = folder(name);
        let first = wandering_load_cell(-8e-6, 4);
        std::fs::write(folder.join("load-cell.csv"), first).expect("written");
        let next = wandering_load_cell(in_next, 5);
        std::fs::write(folder.join("next.csv"), next).expect("written");
        let timed = LOAD_CELL.replace("[noise]", "hour = \"time\"\n[noise]");
        let found = diagnosed(&folder, &timed);
        assert_eq!(named(&found), ["quadratic"]);
        assert!(found["held_out"]["after"]["p"].is_null());
        found["effects"][0]["state"].as_str().map(str::to_owned)
    };
    assert_eq!(state("shown", -8e-6).as_deref(), Some("identified"));
    assert_eq!(state("absent", 0.0).as_deref(), Some("acts-like"));
}

/// A load cell that a supply disturbs, in first and second order about 10 V; the supply is `offset` higher.
fn supplied_load_cell(offset: f64, seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "load [kN],deflection [mV],supply [V],hour [h]\n".to_owned();
    for step in 0..60 {
        let load = f64::from(step * 7 % 11) * 10.0;
        let supply = 10.0 + offset + 0.02 * noise.normal();
        let from = supply - 10.0;
        let disturbed = 0.2 * from + 3.0 * from * from;
        let output = 0.01 + 0.02 * load + disturbed + 5e-4 * noise.normal();
        let hour = 0.1 * f64::from(step);
        let _ = writeln!(text, "{load},{output:.6},{supply:.5},{hour:.1}");
    }
    text
}

#[test]
fn the_square_of_a_condition_goes_on_about_its_own_origin() {
    let folder = folder("origin");
    let written = |file: &str, text: String| std::fs::write(folder.join(file), text);
    written("load-cell.csv", supplied_load_cell(0.0, 4)).expect("written");
    written("next.csv", supplied_load_cell(0.01, 5)).expect("written");
    let case = LOAD_CELL.replace("humidity", "supply");
    let found = diagnosed(&folder, &case);
    assert_eq!(named(&found), ["sensitivity-quadratic"]);
    let rms = found["held_out"]["after"]["rms"][0].as_f64();
    assert!(rms.is_some_and(|rms| rms < 1.2 * 5e-4), "{rms:?}");
}

/// Two bridges in one housing: both shift with the temperature, one is not linear.
fn two_bridges(seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "load [kN],U [mV],V [mV],room [°C]\n".to_owned();
    for row in 0..60 {
        let (load, room) = (f64::from(row * 7 % 11) * 10.0, 23.0 + noise.normal());
        let mut output = |slope: f64, square: f64, shift: f64| {
            let shifted = shift * (room - 23.0);
            slope * load + square * load * load + shifted + 5e-4 * noise.normal()
        };
        let (first, second) = (output(0.02, 0.0, 3e-3), output(0.03, 2e-6, -5e-3));
        let _ = writeln!(text, "{load},{first:.6},{second:.6},{room:.3}");
    }
    text
}

#[test]
fn what_two_outputs_follow_stands_once_in_the_model() {
    let folder = folder("bridges");
    let written = |file: &str, text: String| std::fs::write(folder.join(file), text);
    written("bridges.csv", two_bridges(4)).expect("written");
    written("next.csv", two_bridges(5)).expect("written");
    let case = "recording = \"bridges.csv\"\nequations = [\"U = a + b*load\", \"V = c + d*load\"]\nheld_out = { file = \"next.csv\" }\n[columns]\nU = \"output\"\nV = \"output\"\nload = \"stimulus\"\nroom = \"covariate\"\n[noise]\nu = \"0.5 µV\"\n";
    let found = diagnosed(&folder, case);
    let additions = found["improved"]["additions"]
        .as_array()
        .expect("additions");
    let columns: Vec<&str> = additions
        .iter()
        .filter_map(|one| one["column"].as_str())
        .collect();
    assert_eq!(columns.len(), 3, "{additions:#?}");
    let mut distinct = columns.clone();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), 2, "{additions:#?}");
    for output in 0..2 {
        let rms = found["held_out"]["after"]["rms"][output].as_f64();
        assert!(rms.is_some_and(|rms| rms < 1.2 * 5e-4), "{found:#}");
    }
}

/// A load cell that follows the temperature of the room; its humidity follows that by `share`, and else its own ways.
fn warm_load_cell(share: f64, seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "load [kN],deflection [mV],room [°C],humidity [%]\n".to_owned();
    for row in 0..60 {
        let load = f64::from(row * 7 % 11) * 10.0;
        let (room, own) = (noise.normal(), noise.normal());
        let damp = share * room + libm::sqrt(1.0 - share * share) * own;
        let output = 0.01 + 0.02 * load + 2e-3 * room + 5e-4 * noise.normal();
        let (room, humidity) = (23.0 + room, 50.0 - 4.0 * damp);
        let _ = writeln!(text, "{load},{output:.6},{room:.3},{humidity:.3}");
    }
    text
}

#[test]
fn a_held_out_recording_says_which_explanation_of_a_list_predicts_it() {
    let folder = folder("listed");
    let written = |file: &str, text: String| std::fs::write(folder.join(file), text);
    written("load-cell.csv", warm_load_cell(0.9995, 4)).expect("written");
    written("next.csv", warm_load_cell(0.0, 5)).expect("written");
    let case = LOAD_CELL.replace("humidity =", "room = \"covariate\"\nhumidity =");
    let found = diagnosed(&folder, &case);
    assert_eq!(found["verdict"], "ambiguous", "{found:#}");
    let listed = found["held_out"]["listed"].as_array().expect("a list");
    assert!(listed.len() > 1, "{found:#}");
    for one in listed {
        let right = one["name"]
            .as_str()
            .is_some_and(|name| name.contains("room"));
        let p = one["prediction"]["p"].as_f64().expect("a probability");
        assert_eq!(p >= 0.01, right, "{listed:#?}");
    }
    let (_, told) = gumption(&folder, &["diagnose", "case.toml", "--lang", "en"]);
    let right = "predicted within the noise only by: temperature coefficient of the output (room)";
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(told.contains(right), "{told}");
}

/// A load cell whose output is higher by 5 µV from a row on.
fn knocked_load_cell(from: u32, seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "load [kN],deflection [mV],humidity [%],hour [h]\n".to_owned();
    for row in 0..60 {
        let load = f64::from(row * 7 % 11) * 10.0;
        let step = if row < from { 0.0 } else { 5e-3 };
        let output = 0.01 + 0.02 * load + step + 5e-4 * noise.normal();
        let humidity = 50.0 + noise.normal();
        let hour = 0.1 * f64::from(row);
        let _ = writeln!(text, "{load},{output:.6},{humidity:.2},{hour:.1}");
    }
    text
}

#[test]
fn nobody_predicts_whether_a_jump_had_happened() {
    let folder = folder("knocked");
    let written = |file: &str, text: String| std::fs::write(folder.join(file), text);
    written("load-cell.csv", knocked_load_cell(30, 6)).expect("written");
    written("next.csv", knocked_load_cell(0, 7)).expect("written");
    let case = LOAD_CELL.replace("[noise]", "hour = \"time\"\n\n[noise]");
    let found = diagnosed(&folder, &case);
    assert_eq!(named(&found), ["step"]);
    assert!(
        found["held_out"]["after"].is_null(),
        "{}",
        found["held_out"]
    );
    let (_, text) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(text.contains("next.csv is not predicted"), "{text}");
}

#[test]
fn decoys_are_not_blamed() {
    let folder = folder("decoys");
    std::fs::write(folder.join("next.csv"), load_cell(0.0, 1.0, 5)).expect("written");
    let mut alarms = 0;
    for seed in 20..40 {
        // Humidity rises with the load and does not matter.
        std::fs::write(folder.join("load-cell.csv"), load_cell(0.0, 0.0, seed)).expect("written");
        alarms += usize::from(diagnosed(&folder, LOAD_CELL)["verdict"] != "none");
    }
    assert!(alarms < 3, "{alarms} alarms of 20");
}

#[test]
fn a_random_walk_is_noise_where_it_is_claimed() {
    let folder = folder("walk");
    let mut noise = Noise(8);
    let mut text = "time [h],x,y [mV]\n".to_owned();
    let mut walk = 0.0;
    for row in 0..80 {
        // 4 mV per √h, white 0.1 mV.
        walk += 4.0 * (0.05_f64).sqrt() * noise.normal();
        let x = f64::from(row * 7 % 11);
        let y = 1.0 + 2.0 * x + walk + 0.1 * noise.normal();
        let _ = writeln!(text, "{:.2},{x},{y:.4}", 0.05 * f64::from(row));
    }
    std::fs::write(folder.join("r.csv"), text).expect("written");
    let case = "recording = \"r.csv\"\nequations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\ntime = \"time\"\n[noise]\nu = \"0.1 mV\"\n";
    assert_ne!(diagnosed(&folder, case)["verdict"], "none");
    let claimed = format!("{case}walk = \"4 mV\"\n");
    assert_eq!(diagnosed(&folder, &claimed)["verdict"], "none");
    let untimed = claimed.replace("time = \"time\"\n", "");
    std::fs::write(folder.join("case.toml"), untimed).expect("written");
    let (good, text) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(
        !good && text.contains("a random walk needs a time"),
        "{text}"
    );
}

#[test]
fn the_noise_is_that_of_the_budget_for_the_certificate() {
    let folder = folder("claimed");
    std::fs::write(folder.join("load-cell.csv"), load_cell(0.0, 0.0, 6)).expect("written");
    std::fs::write(folder.join("next.csv"), load_cell(0.0, 1.0, 7)).expect("written");
    let budget = "[measurand.deflection]\nmodel = \"V + r\"\nunit = \"mV\"\n[input.V]\nvalue = 1\nunit = \"mV\"\nu = 0.0004\n[input.r]\nvalue = 0\nunit = \"µV\"\nu = 0.3\n";
    std::fs::write(folder.join("certificate.toml"), budget).expect("written");
    let case = LOAD_CELL.replace("u = \"0.5 µV\"", "budget = \"certificate.toml\"");
    let found = diagnosed(&folder, &case);
    assert_eq!(found["verdict"], "none");
    // √(0.4² + 0.3²) µV
    let u = found["before"]["expected_noise"][0].as_f64().expect("u");
    assert!((u - 5e-4).abs() < 1e-9, "{u}");
}

#[test]
fn the_step_of_the_numbers_is_part_of_the_noise() {
    let folder = folder("resolution");
    std::fs::write(folder.join("load-cell.csv"), load_cell(0.0, 0.0, 6)).expect("written");
    std::fs::write(folder.join("next.csv"), load_cell(0.0, 1.0, 7)).expect("written");
    let case = format!("{LOAD_CELL}resolution = \"1.2 µV\"\n");
    let found = diagnosed(&folder, &case);
    let u = found["before"]["expected_noise"][0].as_f64().expect("u");
    let expected = libm::hypot(5e-4, 1.2e-3 / 12.0_f64.sqrt());
    assert!((u - expected).abs() < 1e-9, "{u} {expected}");
}

#[test]
fn thermometers_are_compared_in_degrees_celsius() {
    let folder = folder("celsius");
    let mut noise = Noise(9);
    let mut text = "ref [degC],sensor [degC]\n".to_owned();
    for row in 0..40 {
        let reference = 10.0 + f64::from(row);
        let sensor = 0.2 + 1.01 * reference - 2e-4 * reference * reference;
        let _ = writeln!(text, "{reference},{:.4}", sensor + 2e-3 * noise.normal());
    }
    std::fs::write(folder.join("r.csv"), text).expect("written");
    let case = "recording = \"r.csv\"\nequations = \"sensor = a + b*ref\"\n[columns]\nsensor = \"output\"\nref = \"stimulus\"\n";
    let found = diagnosed(&folder, case);
    // For a temperature the square is a second-order temperature coefficient.
    assert!(named(&found)[0].ends_with("quadratic"), "{found:#}");
    let (good, page) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(
        good && page.contains("sensor, ref as differences from 0"),
        "{page}"
    );
    assert!(
        gumption(
            &folder,
            &["diagnose", "case.toml", "--improved", "improved"]
        )
        .0
    );
    let again = json(&folder, &["diagnose", "improved/case.toml", "--json"]);
    assert_eq!(again["verdict"], "none");
}

#[test]
fn plan_knows_what_a_file_is() {
    let folder = folder("kinds");
    for (text, part) in [
        ("[measurand.y]\nmodel = \"a\"\n", "is a budget"),
        ("title = \"x\"\n", "is no experiment"),
    ] {
        std::fs::write(folder.join("file.toml"), text).expect("written");
        let (good, told) = gumption(&folder, &["plan", "file.toml"]);
        assert!(!good && told.contains(part), "{told}");
    }
    let (good, told) = gumption(&folder, &["plan", "nowhere.toml"]);
    assert!(!good && told.contains("cannot read nowhere.toml"), "{told}");
}

#[test]
fn variants_are_told_with_their_units() {
    let folder = folder("units-of-variants");
    let rows: String = (0..66).map(|row| format!("{}\n", (row * 7) % 11)).collect();
    std::fs::write(folder.join("design.csv"), format!("p [bar]\n{rows}")).expect("written");
    let plan = planned(
        &folder,
        "recording = \"design.csv\"\nequations = \"y = a + b*p\"\n[columns]\ny = { role = \"output\", unit = \"bar\" }\np = \"stimulus\"\n[noise]\nu = \"2 mbar\"\n",
    );
    let square = entry(&plan["effects"], "quadratic");
    assert_eq!(
        square["variant"], "levelling off, half at 30 bar",
        "{square:#}"
    );
}
