//! Six positions without a name: what tells them apart is what is set along each axis.

use gumption::calibrate::{Campaign, read};
use gumption::experiment::Purpose;
use gumption::recording::Problem;

const SET: [[i32; 3]; 6] = [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
];

/// Twenty samples of one output in each position.
fn recording() -> String {
    let rows = (0..120).map(|row| {
        let [x, y, z] = SET[row / 20];
        let noise = f64::from((row as u32 * 7919) % 1009) / 1e6;
        let output = 2.0 * f64::from(x) + 0.1 * f64::from(y) - 0.2 * f64::from(z) + 0.5 + noise;
        format!("{x},{y},{z},{output}\n")
    });
    "ax,ay,az,U\n".to_owned() + &rows.collect::<String>()
}

fn campaign(steps: &str, equation: &str) -> Campaign {
    let folder = crate::common::folder("positions");
    folder.put("run.csv", recording());
    let toml = format!(
        "recording = {{ file = \"run.csv\", steps = {steps} }}\nequations = \"{equation}\"\n\
         [columns]\nax = \"stimulus\"\nay = \"stimulus\"\naz = \"stimulus\"\nU = \"output\"\n"
    );
    read(&toml, "run.toml", &folder, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)))
}

const ALL: &str = "U = a + b1*ax + b2*ay + b3*az";

#[test]
fn a_step_of_any_stimulus_begins_a_dwell() {
    let campaign = campaign("[\"ax\", \"ay\", \"az\"]", ALL);
    assert_eq!(campaign.points.len(), SET.len());
    assert!(campaign.points.findings.is_empty());
}

/// With the steps of one axis the positions of the other two are one dwell.
#[test]
fn stimuli_that_change_within_a_dwell_are_told() {
    let campaign = campaign("\"ax\"", ALL);
    assert_eq!(campaign.points.len(), 3);
    let merged = |name: &str| {
        let of = |finding: &&gumption::recording::Finding| finding.column.as_deref() == Some(name);
        let found = campaign.points.findings.iter().find(of);
        found.map(|finding| (&finding.problem, finding.line))
    };
    assert_eq!(merged("ay"), Some((&Problem::Merged { stretches: 3 }, 42)));
    assert_eq!(merged("ax"), None);
}

#[test]
fn a_stimulus_that_no_equation_has_is_remarked_on() {
    let told = |equation: &str| {
        let remarks = campaign("\"ax\"", equation).experiment.remarks;
        let of_ay = |en: &String| en.contains("the stimulus ay");
        remarks
            .into_iter()
            .map(|remark| remark.to_string())
            .any(|en| of_ay(&en))
    };
    assert!(told("U = a + b1*ax"));
    assert!(!told(ALL));
}
