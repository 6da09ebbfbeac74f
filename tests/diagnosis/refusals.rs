//! Cases and recordings that are wrong, empty or extreme: refused with the reason, or diagnosed, never a panic.

use std::path::Path;

use crate::common::cases::{folder, gumption};

const CASE: &str = r#"
recording = "run.csv"
equations = "y = a + b * x"

[columns]
y = "output"
x = "stimulus"
t = "time"
room = "covariate"
run = "run"

[diagnosis]
draws = 200
"#;

/// Twelve good rows, each field of which may be another.
fn recording(field: impl Fn(usize, &str) -> Option<&'static str>) -> String {
    let mut text = "x [kN],y [mV],t [h],room [°C],run\n".to_owned();
    for row in 0..12 {
        let i = row as f64;
        let good = [
            ("x", format!("{}", 10 * (row % 6))),
            (
                "y",
                format!(
                    "{}",
                    0.2 * f64::from(10 * (row as u32 % 6)) + 1e-3 * libm::sin(7.3 * i)
                ),
            ),
            ("t", format!("{}", 0.1 * i)),
            ("room", format!("{}", 20.0 + 0.1 * libm::cos(3.1 * i))),
            ("run", format!("{}", 1 + row / 6)),
        ];
        let fields = good
            .iter()
            .map(|(name, good)| field(row, name).map_or(good.clone(), str::to_owned));
        text += &(fields.collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

/// All that diagnose, plan and simulate say.
fn said(folder: &Path, case: &str, recording: &str) -> Vec<(bool, String)> {
    std::fs::write(folder.join("case.toml"), case).expect("written");
    std::fs::write(folder.join("run.csv"), recording).expect("written");
    ["diagnose", "plan", "simulate"]
        .map(|command| {
            let arguments: &[&str] = match command {
                "simulate" => &[command, "case.toml", "--seed", "1"],
                _ => &[command, "case.toml"],
            };
            let (good, text) = gumption(folder, arguments);
            assert!(
                !text.contains("panicked") && !text.is_empty(),
                "{command}\n{case}\n{recording}\n{text}"
            );
            (good, text)
        })
        .to_vec()
}

/// What `simulate` says beside its result.
fn remarks(folder: &Path, case: &str, recording: &str) -> String {
    std::fs::write(folder.join("run.csv"), recording).expect("written");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let output = crate::common::program()
        .current_dir(folder)
        .args(["simulate", "case.toml"])
        .output()
        .expect("the program runs");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn extreme_recordings_end_in_an_answer_or_a_reason() {
    let folder = folder("extreme");
    let constant = |name: &'static str, value: &'static str| {
        recording(move |_, field| (field == name).then_some(value))
    };
    let one = |name: &'static str, value: &'static str| {
        recording(move |row, field| (field == name && row == 5).then_some(value))
    };
    let good = recording(|_, _| None);
    let rows = |count: usize| good.lines().take(count + 1).collect::<Vec<_>>().join("\n");
    let mut recordings = vec![
        String::new(),
        rows(0),
        rows(1),
        rows(2),
        rows(3),
        good.clone(),
    ];
    for name in ["x", "y", "t", "room"] {
        for value in ["0", "5", "1e30", "-1e-300"] {
            recordings.push(constant(name, value));
        }
        for value in ["NaN", "", "1e30", "inf"] {
            recordings.push(one(name, value));
        }
    }
    recordings.push(constant("run", ""));
    for text in &recordings {
        said(&folder, CASE, text);
    }
}

/// A column without any number leaves no row, and is named.
#[test]
fn a_recording_without_complete_rows_is_refused() {
    let folder = folder("no-rows");
    let text = recording(|row, field| match field {
        "room" if row % 2 == 0 => Some(""),
        "t" if row % 2 == 1 => Some(""),
        "x" if row == 3 => Some(""),
        _ => None,
    });
    for (good, text) in said(&folder, CASE, &text) {
        assert!(
            !good && text.contains("D0108") && text.contains("in 6 of 12 rows"),
            "{text}"
        );
    }
}

#[test]
fn what_the_catalogue_does_not_have_is_refused() {
    let folder = folder("settings");
    let good = recording(|_, _| None);
    for (setting, complaint) in [
        ("exclude = [\"cubik\"]", "did you mean \"cubic\"?"),
        (
            "catalogue = [\"tempratur\"]",
            "did you mean \"temperature\"?",
        ),
        ("typical = { drifd = 1e-4 }", "did you mean \"drift\"?"),
        ("alpha = 0.7", "between 0 and 0.5"),
    ] {
        for (good, text) in said(&folder, &format!("{CASE}{setting}\n"), &good) {
            assert!(!good && text.contains(complaint), "{setting}\n{text}");
        }
    }
    for (good, text) in said(&folder, &CASE.replace("200", "20"), &good) {
        assert!(!good && text.contains("from 200 to 100000"), "{text}");
    }
}

/// The reasons that are told without a place in the file have the codes that `gumption explain` explains.
#[test]
fn reasons_have_codes() {
    let folder = folder("codes");
    let good = recording(|_, _| None);
    for (model, code) in [
        ("y = a + b*x + c*x", "D0107"),
        ("y = a*log10(b - value_in(x, 'kN'))", "D0106"),
    ] {
        let case = CASE.replace("y = a + b * x", model);
        let (good, text) = &said(&folder, &case, &good)[0];
        assert!(!good && text.contains(code), "{model}\n{text}");
        let (known, text) = gumption(&folder, &["explain", code]);
        assert!(known, "{text}");
    }
}

#[test]
fn a_wrong_role_does_not_hide_wrong_settings() {
    let folder = folder("role-and-settings");
    let case = CASE
        .replace("t = \"time\"", "t = \"tiem\"")
        .replace("draws = 200", "draws = 200\nexclude = [\"drfit\"]");
    let (good, text) = &said(&folder, &case, &recording(|_, _| None))[0];
    assert!(!good);
    for hint in ["did you mean \"time\"?", "did you mean \"drift\"?"] {
        assert!(text.contains(hint), "{hint} is missing in\n{text}");
    }
}

#[test]
fn a_name_that_the_recording_does_not_have_is_given_to_a_column() {
    let folder = folder("other-names");
    let case = CASE.replace("room = \"covariate\"", "\"槽温\" = \"covariate\"");
    let (good, text) = &said(&folder, &case, &recording(|_, _| None))[0];
    assert!(!good);
    for hint in [
        "its columns are: x, y, t, room, run",
        "\"槽温\" = { role = \"covariate\", column = \"…\" }",
    ] {
        assert!(text.contains(hint), "{hint} is missing in\n{text}");
    }
}

#[test]
fn noise_that_is_stated_twice_is_told_by_both() {
    let folder = folder("noise-twice");
    let case = format!("{CASE}\n[noise]\nu = \"1 mV\"\nreplicates = [\"x\"]\n");
    let (good, text) = &said(&folder, &case, &recording(|_, _| None))[0];
    assert!(
        !good && text.contains("stated by `u`, `replicates`"),
        "{text}"
    );
}

#[test]
fn what_only_a_calibration_uses_is_remarked_on() {
    let folder = folder("disused");
    let case = CASE.replace(
        "recording = \"run.csv\"",
        "recording = { file = \"run.csv\", together = [\"run\"] }\nseparately = \"run\"",
    );
    let said = remarks(&folder, &case, &recording(|_, _| None));
    for key in ["`together` of the recording", "`separately`"] {
        assert!(said.contains(key), "{said}");
    }
}

/// Beside two parameters three rows leave one degree of freedom, which any effect would take.
#[test]
fn rows_that_cannot_test_a_model_do_not_agree_with_it() {
    let folder = folder("untested");
    let good = recording(|_, _| None);
    let of = |rows: usize| {
        let text = good.lines().take(rows + 1).collect::<Vec<_>>().join("\n");
        said(&folder, CASE, &text).swap_remove(0)
    };
    let (is_done, text) = of(3);
    assert!(is_done && text.contains("cannot test the model"), "{text}");
    assert!(!text.contains("agree"), "{text}");
    let (_, text) = of(12);
    assert!(!text.contains("cannot test the model"), "{text}");
}

#[test]
fn a_clock_that_goes_back_is_remarked_on() {
    let folder = folder("backwards");
    let late = |row: usize, name: &str| (row == 5 && name == "t").then_some("0.05");
    let text = remarks(&folder, CASE, &recording(late));
    assert!(
        text.contains("goes back in 1 of the rows, first in line 7"),
        "{text}"
    );
    let text = remarks(&folder, CASE, &recording(|_, _| None));
    assert!(!text.contains("goes back"), "{text}");
}

/// A part that is wrong is told with its mend, by the command that uses it and by those that only read it.
#[test]
fn parts_that_are_wrong_are_told_with_their_mend() {
    let folder = folder("parts");
    let with = |part: &str| format!("{CASE}{part}\n");
    let listed = |name: &str| with(&format!("[parameter]\n{name} = {{}}\nb = {{}}"));
    for (case, hints) in [
        (
            CASE.replace("\"covariate\"", "\"output\""),
            [
                "no equation gives the output room",
                "\"covariate\" is a condition",
            ],
        ),
        (
            with("[omitted.k2]\nterm = \"k3*x^2\""),
            ["does not have k2", "[omitted.k3]"],
        ),
        (
            with("[omitted.k2]\nterm = \"k2*exp(x/20)\"\ntypical = \"1 µV\""),
            ["D0111", "expected a plain number"],
        ),
        (
            with("[omitted.k2]\nterm = \"k2*x^2\"\ntypical = \"1 µV\""),
            ["cannot be converted", "mV/kN^2"],
        ),
        (
            listed("c"),
            ["no equation uses the parameter c", "the equations have a"],
        ),
        (
            CASE.replace("\"output\"", "{ role = \"output\", range = [10, -10] }"),
            ["the least and the greatest value", "the smaller one first"],
        ),
        (
            CASE.replace(
                "equations = \"y = a + b * x\"",
                "procedure = \"gyro-scalefactor\"",
            ),
            ["there is no procedure", "did you mean"],
        ),
    ] {
        let (good, text) = &said(&folder, &case, &recording(|_, _| None))[0];
        assert!(!good, "{case}");
        for hint in hints {
            assert!(text.contains(hint), "{hint} is missing in\n{text}");
        }
        assert_eq!(text.matches("error[").count(), 1, "{text}");
    }
}
