//! The examples of docs/calibrate.md evaluate, and its plan says what the page says.

use crate::common;
use gumption::calibrate::{self};
use gumption::experiment::Purpose;

/// The blocks with this word behind the backquotes.
fn blocks(word: &str) -> Vec<String> {
    let path = common::root().join("docs/calibrate.md");
    let text = std::fs::read_to_string(path).expect("a readable page");
    let opening = format!("```toml {word}\n");
    let pieces = text.split(&opening).skip(1);
    pieces
        .map(|piece| piece.split("```").next().unwrap_or_default().to_owned())
        .collect()
}

#[test]
fn calibrations_have_coefficients() {
    let found = blocks("calibrate");
    assert!(found.len() >= 3);
    for block in found {
        let folder = common::root().join("docs");
        let experiment = calibrate::read(&block, "calibrate.md", &folder, Purpose::Calibrate)
            .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
        let found = calibrate::calibrate(&experiment).expect("coefficients");
        let k = &found.figures.coefficients[0];
        assert!((k.value - 2.003).abs() < 4.0 * k.u, "{} ± {}", k.value, k.u);
    }
}

#[test]
fn plans_say_what_hides() {
    for block in blocks("plan") {
        let folder = common::root().join("docs");
        let read = |text: &str| {
            calibrate::read(text, "calibrate.md", &folder, Purpose::Plan)
                .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)))
        };
        let plan = calibrate::plan(&read(&block)).expect("a plan");
        assert_eq!(plan.identifiability.rank, 3);
        let five = block.replace("[0, 1, 0, -1]", "[1, 0.5, 0, -0.5, -1]");
        let plan = calibrate::plan(&read(&five)).expect("a plan");
        assert!(plan.figures.is_some());
    }
}

/// The part of a calibration on shared causes, with readings.
#[test]
fn shared_causes_correlate_as_the_page_says() {
    let parts = blocks("calibrate-part");
    let part = parts.iter().find(|part| part.contains("[[correlation]]"));
    let part = part.expect("a part").clone() + "[recording]\nfile = \"run.csv\"\n";
    let folder = common::folder("shared");
    let csv = "omega [deg/s],U [mV],V [mV]\n-1,-2,-1\n0,0,0\n1,2,1\n";
    folder.put("run.csv", csv);
    let experiment = calibrate::read(&part, "calibrate.md", &folder, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let found = calibrate::calibrate(&experiment)
        .expect("coefficients")
        .figures;
    let place = |name: &str| {
        let mut all = found.coefficients.iter();
        all.position(|one| one.name == name).expect("a coefficient")
    };
    let (b, c) = (place("b"), place("c"));
    let common = 0.05_f64.powi(2) / 3.0;
    let noise = 0.02_f64.powi(2) / 3.0;
    let expected = 0.5 * common + 0.6 * noise;
    assert!((found.covariance[(b, c)] / expected - 1.0).abs() < 1e-9);
}
