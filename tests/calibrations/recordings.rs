//! Many recordings of one experiment: each line is what the recording gives by itself.

use gumption::csv::{Row, Sheet};
use serde_json::Value;

use crate::common::{Noise, cases};

fn recording(seed: u64, slope: f64) -> String {
    let mut noise = Noise(seed);
    let mut text = String::from("omega [deg/s],U [V]\n");
    for k in 0..24 {
        let omega = f64::from(k % 12) * 10.0 - 55.0;
        let volts = slope * omega + 0.002 + 1e-4 * noise.normal();
        text += &format!("{omega},{volts}\n");
    }
    text
}

const EXPERIMENT: &str = "recording = { file = \"b.csv\", average = \"none\" }\nequations = \"U = K*omega*(1 + e_rate) + b\"\n\
    [input.e_rate]\ncertificate = { U = 2e-4, k = 2 }\n[reading.U]\nstep = 1e-4\n";

#[test]
fn each_line_is_the_calibration_of_its_recording_alone() {
    let folder = cases::folder("recordings");
    let runs = folder.join("runs");
    std::fs::create_dir_all(&runs).expect("a folder");
    let put = |path: &std::path::Path, text: &str| std::fs::write(path, text).expect("written");
    let names = ["a", "b", "c"];
    for (at, name) in names.iter().enumerate() {
        let text = recording(at as u64 + 1, 0.01 + 1e-4 * at as f64);
        put(&runs.join(name).with_extension("csv"), &text);
    }
    put(&runs.join("bad.csv"), "omega [deg/s],V [V]\n1,2\n");
    put(&runs.join("few.csv"), "omega [deg/s],U [V]\n1,2\n");
    put(&runs.join("notes.txt"), "no recording");
    put(&folder.join("gyro.toml"), EXPERIMENT);
    let output = crate::common::program()
        .current_dir(&folder)
        .args([
            "calibrate",
            "gyro.toml",
            "--lang",
            "en",
            "--shares",
            "--recordings",
            "runs",
        ])
        .output()
        .expect("the program runs");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("2 of 5 recordings give no coefficients"),
        "{said}"
    );
    let table = String::from_utf8(output.stdout).expect("text");
    let sheet = Sheet::new(&table).expect("heads");
    let heads: Vec<&str> = sheet.header().fields().collect();
    let rows: Vec<Row> = sheet.rows().map(|row| row.expect("a row")).collect();
    let rows: Vec<Vec<&str>> = rows.iter().map(|row| row.fields().collect()).collect();
    let labels: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(labels, ["a", "b", "bad", "c", "few"]);
    let at = |head: &str| heads.iter().position(|one| one.starts_with(head));
    let at = |head: &str| at(head).unwrap_or_else(|| panic!("{head} in {heads:?}"));
    assert!(rows[2][at("error")].starts_with("C0104"), "{table}");
    assert!(rows[4][at("error")].contains("reading"), "{table}");
    for (row, name) in rows
        .iter()
        .filter(|row| row[at("error")].is_empty())
        .zip(names)
    {
        let alone = EXPERIMENT.replace("b.csv", &format!("runs/{name}.csv"));
        put(&folder.join("alone.toml"), &alone);
        let found = cases::json(&folder, &["calibrate", "alone.toml", "--json"]);
        let number = |value: &Value| value.as_f64().expect("a number").to_bits();
        let cell = |head: &str| row[at(head)].parse::<f64>().expect("a number").to_bits();
        for coefficient in found["coefficients"].as_array().expect("coefficients") {
            let one = coefficient["name"].as_str().expect("a name");
            assert_eq!(
                cell(&format!("{one} ")),
                number(&coefficient["value"]),
                "{one}"
            );
            for (head, key) in [("u", "u"), ("nu", "dof"), ("k", "k"), ("U", "U")] {
                assert_eq!(
                    cell(&format!("{head}({one})")),
                    number(&coefficient[key]),
                    "{head}({one})"
                );
            }
        }
        assert_eq!(cell("s(U)"), number(&found["responses"][0]["s"]));
        let mut shares = 0;
        for cause in found["causes"].as_array().expect("causes") {
            for one in cause["contributions"].as_array().expect("contributions") {
                let name = |value: &Value| value.as_str().expect("a name").to_owned();
                let head = format!(
                    "share({}, {})",
                    name(&one["coefficient"]),
                    name(&cause["name"])
                );
                assert_eq!(cell(&head), number(&one["share"]), "{head}");
                shares += 1;
            }
        }
        assert_eq!(shares, 2 * 3, "K and b by scatter, table and resolution");
    }
    std::fs::write(folder.join("results.csv"), &table).expect("written");
    let fleet = cases::json(&folder, &["fleet", "results.csv", "--json"]);
    assert_eq!(fleet["measurands"][0]["name"], "K");
    let dominating = &fleet["measurands"][0]["groups"][0]["components"];
    assert_eq!(dominating.as_array().map(Vec::len), Some(3), "{dominating}");
    assert_eq!(
        fleet["groups"][0]["faulty"].as_array().map(Vec::len),
        Some(2)
    );
}

#[test]
fn the_table_is_no_document() {
    let folder = cases::folder("recordings-form");
    std::fs::write(folder.join("gyro.toml"), EXPERIMENT).expect("written");
    let said = |more: &[&str]| {
        let all = [&["calibrate", "gyro.toml", "--lang", "en"], more].concat();
        let (good, said) = cases::gumption(&folder, &all);
        assert!(!good, "{said}");
        said
    };
    assert!(said(&["--html", "--recordings", "x.csv"]).contains("leave out --html"));
    std::fs::create_dir_all(folder.join("empty")).expect("a folder");
    let (good, why) = cases::gumption(&folder, &["calibrate", "no.toml", "--recordings", "x.csv"]);
    assert!(!good && why.contains("no file no.toml"), "{why}");
    assert!(said(&["--recordings", "empty"]).contains("no CSV file in the folder empty"));
}

/// Figures stand below the units of the first recording: those of one in other units are converted, and one of another quantity
/// has no place there.
#[test]
fn recordings_in_other_units_are_converted() {
    let folder = cases::folder("recordings-units");
    let put = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("written");
    let rates = [-100.0_f64, -50.0, 0.0, 50.0, 100.0];
    let volts = [-0.2, -0.1, 0.0001, 0.1002, 0.2];
    let recording = |heads: &str, rate: f64, output: f64| {
        let rows = rates.iter().zip(volts);
        let rows = rows.map(|(x, y)| format!("{},{}\n", x * rate, y * output));
        format!("{heads}\n{}", rows.collect::<String>())
    };
    put("a.csv", &recording("omega [deg/s],U [mV]", 1.0, 1e3));
    put("b.csv", &recording("omega [°/s],U [V]", 1.0, 1.0));
    put(
        "c.csv",
        &recording("omega [rad/s],U [mV]", std::f64::consts::PI / 180.0, 1e3),
    );
    put("d.csv", &recording("omega [m/s],U [mV]", 1.0, 1e3));
    put(
        "gyro.toml",
        "recording = { file = \"a.csv\", average = \"none\" }\nequations = \"U = K*omega + b\"\n",
    );
    let output = crate::common::program()
        .current_dir(&folder)
        .args(["calibrate", "gyro.toml", "--lang", "en", "--recordings"])
        .args(["a.csv", "b.csv", "c.csv", "d.csv"])
        .output()
        .expect("the program runs");
    assert_eq!(output.status.code(), Some(1));
    let table = String::from_utf8(output.stdout).expect("text");
    let sheet = Sheet::new(&table).expect("heads");
    let rows: Vec<Row> = sheet.rows().map(|row| row.expect("a row")).collect();
    let rows: Vec<Vec<&str>> = rows.iter().map(|row| row.fields().collect()).collect();
    let last = rows[0].len() - 1;
    for other in &rows[1..3] {
        assert_eq!(other[last], "", "{table}");
        for at in 1..last - 1 {
            let [one, other]: [f64; 2] =
                [rows[0][at], other[at]].map(|x| x.parse().expect("a number"));
            assert!((one - other).abs() <= 1e-9 * one.abs(), "{at}: {table}");
        }
    }
    assert!(
        rows[3][last].contains("nothing for the column K [mV·s/deg]"),
        "{table}"
    );
}
