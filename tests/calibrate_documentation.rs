//! The examples of docs/calibrate.md evaluate, and its plan says what the page says.

mod common;

use gumption::calibrate::{self, Purpose};

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
