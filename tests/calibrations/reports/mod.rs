//! Reports of calibrations of published and recorded figures, in `reports/`: each is what the program makes
//! now. `GUMPTION_UPDATE=1 cargo test --test calibrations` renews them.

mod annex_a;
mod gimbals;
mod page;
mod recordings;
mod tumble;

use crate::common;
use std::path::{Path, PathBuf};

use gumption::calibrate::{
    Calibration, Cause, Coefficient, Figures, Origin, Plan, calibrate, load, plan, read,
};
use gumption::experiment::Purpose;

/// The file of `experiments/`, evaluated.
fn calibrated(file: &str) -> Calibration {
    let path = common::root().join("experiments").join(file);
    let campaign = load(&path, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    calibrate(&campaign).unwrap_or_else(|why| panic!("{file}: {why:?}"))
}

/// A calibration file whose recording is in `folder`.
fn calibrated_text(toml: &str, folder: &Path) -> Calibration {
    let campaign = read(toml, "calibration.toml", folder, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    calibrate(&campaign).unwrap_or_else(|why| panic!("{why:?}"))
}

fn planned(toml: &str) -> Plan {
    let campaign = read(toml, "plan.toml", Path::new(""), Purpose::Plan)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    plan(&campaign).unwrap_or_else(|why| panic!("{why:?}"))
}

fn named<'a>(coefficients: &'a [Coefficient], name: &str) -> &'a Coefficient {
    let found = coefficients.iter().find(|c| c.name == name);
    found.unwrap_or_else(|| panic!("no coefficient {name}"))
}

/// Real recordings, where they are at hand.
fn shared() -> Option<PathBuf> {
    let places = ["../shared/recordings", "../../shared/recordings"];
    let found = places
        .iter()
        .map(|place| common::root().join(place))
        .find(|place| place.is_dir());
    if found.is_none() {
        eprintln!("SKIPPED: no folder ../shared/recordings");
    }
    found
}

/// Holds a report against the committed one.
fn fresh(file: &str, text: &str) {
    let path = common::root().join("reports").join(file);
    let stale: Vec<String> = common::stale(&path, text).into_iter().collect();
    common::assert_fresh(&stale);
}

/// Name of a cause.
fn title(cause: &Cause) -> String {
    match &cause.origin {
        Origin::Stated { name, .. } => name.clone(),
        Origin::Residuals { response } => format!("scatter of {response}"),
        Origin::Samples { column } => format!("samples of {column}"),
        Origin::Prior { parameter } => format!("prior of {parameter}"),
    }
}

/// Contribution of the causes whose name contains a text to the standard uncertainty of a coefficient.
fn contribution(figures: &Figures, coefficient: &str, cause: &str) -> f64 {
    let place = figures
        .coefficients
        .iter()
        .position(|c| c.name == coefficient);
    let place = place.unwrap_or_else(|| panic!("no coefficient {coefficient}"));
    let causes = figures
        .causes
        .iter()
        .filter(|one| title(one).contains(cause));
    causes
        .map(|one| one.contribution(place).powi(2))
        .sum::<f64>()
        .sqrt()
}
