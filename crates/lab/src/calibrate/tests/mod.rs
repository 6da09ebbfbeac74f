//! Tests of calibrations against closed forms and simulations.

mod agreement;
mod averaged;
mod closed_forms;
mod pattern;
mod refusals;
mod shares;
mod simulations;
mod stated;

use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

use super::{Campaign, read};
use crate::experiment::Purpose;
use gumption_gum::budget::Rejection;

/// A folder with a recording, removed afterwards.
struct Folder(PathBuf);

impl Folder {
    fn with(csv: &str) -> Folder {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let name = format!("gumption-calibrate-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&folder).expect("a temporary folder");
        std::fs::write(folder.join("run.csv"), csv).expect("a temporary file");
        Folder(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn rejected(toml: &str, csv: &str, purpose: Purpose) -> Result<Campaign, Rejection> {
    let folder = Folder::with(csv);
    read(toml, "calibration.toml", &folder.0, purpose)
}

fn campaign(toml: &str, csv: &str) -> Campaign {
    rejected(toml, csv, Purpose::Calibrate).unwrap_or_else(|r| panic!("{}", r.render(false)))
}

fn planned(toml: &str) -> Campaign {
    rejected(toml, "", Purpose::Plan).unwrap_or_else(|r| panic!("{}", r.render(false)))
}

#[track_caller]
fn near(found: f64, expected: f64, relative: f64) {
    let difference = (found - expected).abs();
    assert!(
        difference <= relative * expected.abs(),
        "{found} is not {expected} within {relative}"
    );
}
