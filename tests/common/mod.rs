//! What the integration tests share: finding files, and keeping generated files fresh.

#![allow(dead_code, unused_imports, reason = "every test uses its own part")]

pub mod cases;
pub mod evaluation;
mod files;
mod folder;

use std::path::Path;
use std::process::Command;

pub use files::{assert_fresh, calibrations, files, relative, root, stale};
pub use folder::{Folder, folder};

/// The program, without colours and on a page of 100 columns.
pub fn program() -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_gumption"));
    program.env("NO_COLOR", "1").env("COLUMNS", "100");
    program.env("LC_ALL", "C.UTF-8");
    program
}

/// Numbers that look random and are the same everywhere: sums of twelve uniform ones, less six.
pub struct Noise(pub u64);

impl Noise {
    /// Uniform between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// A line with a bend, of which a fit, a diagnosis, a plan and an Allan deviation can be made: `case.toml` and its
/// `recording.csv`.
pub fn bent_line(folder: &Path) {
    let mut noise = Noise(7);
    let mut recording = String::from("t [s],x,y [V]\n");
    for k in 0..64 {
        let x = f64::from(k % 16) / 8.0 - 1.0;
        let y = 1.0 + 2.0 * x + 0.02 * x * x + 1e-3 * noise.normal();
        recording += &format!("{k},{x},{y}\n");
    }
    let case = "recording = \"recording.csv\"\nequations = \"y = a + b*x\"\n[columns]\nx = \"stimulus\"\ny = \"output\"\n[noise]\nu = \"1 mV\"\n";
    std::fs::write(folder.join("recording.csv"), recording).expect("written");
    std::fs::write(folder.join("case.toml"), case).expect("written");
}
