//! Recordings with one known fault each: what a diagnosis has to name, and what it must not name.

mod common;

use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

/// Numbers that look random and are the same everywhere: sums of twelve uniform ones, less six.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

fn diagnosed(name: &str, recording: &str, case: &str) -> Value {
    let folder: PathBuf =
        std::env::temp_dir().join(format!("gumption-catalogue-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("recording.csv"), recording).expect("written");
    let case = format!("recording = \"recording.csv\"\n{case}");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_gumption"))
        .current_dir(&folder)
        .args(["diagnose", "case.toml", "--json"])
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text)
        .unwrap_or_else(|_| panic!("{text}{}", String::from_utf8_lossy(&output.stderr)))
}

/// Identifiers of everything that a diagnosis names, effect by effect.
fn named(diagnosis: &Value) -> Vec<Vec<String>> {
    let of = |effect: &Value| {
        let list = effect["named"].as_array().into_iter().flatten();
        list.filter_map(|one| one["id"].as_str().map(str::to_owned))
            .collect()
    };
    diagnosis["effects"]
        .as_array()
        .into_iter()
        .flatten()
        .map(of)
        .collect()
}

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
    let case = "model = \"error = e0\"\n[columns]\nerror = \"output\"\nangle = \"angle\"\n";
    let found = diagnosed("harmonics", &rows, case);
    for (effect, label) in [(0, "1 per turn"), (1, "2 per turn")] {
        assert_eq!(named(&found)[effect], ["periodic"], "{found}");
        let variant = &found["effects"][effect]["named"][0]["variants"][0];
        assert_eq!(variant["label"], label);
    }
}
