//! Tests of calibrations against closed forms and simulations.

mod agreement;
mod averaged;
mod closed_forms;
mod pattern;
mod refusals;
mod shares;
mod simulations;
mod stated;

use super::{Campaign, read};
use crate::experiment::Purpose;
use gumption_gum::budget::Rejection;

fn rejected(toml: &str, csv: &str, purpose: Purpose) -> Result<Campaign, Rejection> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("run.csv"), csv).expect("a temporary file");
    read(toml, "calibration.toml", folder.path(), purpose)
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
