//! The gallery of mistakes on the command line, and of files that are no budgets at all: each is refused
//! with exit code 2 and the text in `tests/bad_arguments`. Read the texts as a new user would.

use crate::common::{self, Folder};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Nothing that is refused may keep the user waiting.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder of its own with files that are too large or too odd for the repository.
struct Place(Folder);

impl Place {
    fn new(name: &str) -> Self {
        let folder = common::folder(name);
        std::fs::create_dir(folder.join("folder")).expect("a folder");
        folder.put("good.toml", GOOD);
        folder.put("readings.csv", "V,I\n5.01,20.1\n5.02,20.2\n");
        folder.put("latin1.toml", b"title = \"Widerst\xe4nde\"\n");
        folder.put(
            "certificate.toml",
            "number = \"17\"\n[laboratory]\nname = \"L\"\n[customer]\nname = \"C\"\n",
        );
        folder.put(
            "experiment.toml",
            "recording = \"readings.csv\"\nequations = \"V = a + b*I\"\n[columns]\nV = \"output\"\nI = \"stimulus\"\n",
        );
        folder.put("garbage.toml", garbage());
        folder.put("nested.toml", GOOD.replace("V / I", &"(".repeat(100_000)));
        folder.put(
            "nested_signs.toml",
            GOOD.replace("V / I", &"-".repeat(100_000)),
        );
        folder.put("nested_lists.toml", format!("a = {}", "[".repeat(100_000)));
        folder.put(
            "nested_tables.toml",
            format!("a = {}", "{a = ".repeat(100_000)),
        );
        let million = vec!["1"; 1_000_000].join(", ");
        folder.put(
            "million_elements.toml",
            GOOD.replace("value = 5.0", &format!("values = [{million}]"))
                .replace("V / I", "mean(V) / I"),
        );
        folder.put(
            "million_arguments.toml",
            GOOD.replace("V / I", &format!("sum([{million}]) * V / I * X")),
        );
        folder.put(
            "million_terms.toml",
            GOOD.replace(
                "V / I",
                &format!("V / I + {} 1 'ohm'", "1 'ohm' + ".repeat(1_000_000)),
            ),
        );
        folder.put("binary.toml", [0; 4096]);
        Place(folder)
    }

    /// Runs the program in the folder; gives exit code and everything that it says.
    fn run(&self, arguments: &[&str]) -> (i32, String) {
        let start = Instant::now();
        let output = common::program()
            .current_dir(&self.0)
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .expect("the program runs");
        assert!(
            start.elapsed() < PATIENCE,
            "{arguments:?} took {:?}",
            start.elapsed()
        );
        let shown = format!(
            "{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        // The name of the program is that of its file.
        (
            output.status.code().unwrap_or(-1),
            shown.replace("gumption.exe", "gumption"),
        )
    }
}

const GOOD: &str = r#"title = "Resistance"

[measurand.R]
model = "V / I"
unit = "ohm"

[input.V]
value = 5.0
unit = "V"
u = 0.01

[input.I]
value = 20
unit = "mA"
u = 0.05
"#;

/// Ten megabytes of printable noise, the same every time.
fn garbage() -> Vec<u8> {
    let mut state = 1_u64;
    let mut noise = vec![0; 10_000_000];
    for byte in &mut noise {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        let printable = 32 + ((state >> 33) % 95) as u8;
        *byte = if state >> 33 & 63 == 0 {
            b'\n'
        } else {
            printable
        };
    }
    noise
}

/// Name of the mistake, and the arguments.
const MISTAKES: &[(&str, &[&str])] = &[
    ("no_command", &[]),
    ("unknown_command", &["evaluate", "good.toml"]),
    ("no_file", &["eval"]),
    ("missing_file", &["eval", "god.toml"]),
    ("empty_path", &["eval", ""]),
    ("folder", &["eval", "folder"]),
    ("csv", &["eval", "readings.csv"]),
    ("certificate_for_budget", &["eval", "certificate.toml"]),
    ("experiment_for_budget", &["eval", "experiment.toml"]),
    ("budget_for_experiment", &["diagnose", "good.toml"]),
    ("unknown_flag", &["eval", "good.toml", "--sed", "3"]),
    ("trials_zero", &["eval", "good.toml", "--trials", "0"]),
    ("trials_word", &["eval", "good.toml", "--trials", "abc"]),
    (
        "trials_fraction",
        &["eval", "good.toml", "--trials", "1000.5"],
    ),
    (
        "trials_without_monte_carlo",
        &["eval", "good.toml", "--no-mc", "--trials", "10000"],
    ),
    ("seed_negative", &["eval", "good.toml", "--seed", "-1"]),
    ("threads_zero", &["eval", "good.toml", "--threads", "0"]),
    ("width_word", &["eval", "good.toml", "--width", "wide"]),
    ("language", &["eval", "good.toml", "--lang", "fr"]),
    (
        "two_formats",
        &["eval", "good.toml", "--json", "--markdown"],
    ),
    (
        "output_into_missing_folder",
        &["eval", "good.toml", "--no-mc", "-o", "nowhere/report.txt"],
    ),
    (
        "output_is_a_folder",
        &["eval", "good.toml", "--no-mc", "-o", "."],
    ),
    ("explain_unknown", &["explain", "trianglar"]),
    ("explain_unknown_code", &["explain", "B9999"]),
    ("explain_empty", &["explain", ""]),
    ("new_on_an_existing_file", &["new", "good.toml"]),
    ("new_named_as_a_table", &["new", "run.csv"]),
    ("new_in_a_missing_folder", &["new", "nowhere/budget.toml"]),
    ("schema_unknown", &["schema", "budgets"]),
    ("not_utf8", &["eval", "latin1.toml"]),
    ("binary", &["eval", "binary.toml"]),
    ("garbage", &["eval", "garbage.toml"]),
    ("nested", &["eval", "nested.toml"]),
    ("nested_signs", &["eval", "nested_signs.toml"]),
    ("nested_lists", &["eval", "nested_lists.toml"]),
    ("nested_tables", &["eval", "nested_tables.toml"]),
    ("million_elements", &["eval", "million_elements.toml"]),
    ("million_arguments", &["eval", "million_arguments.toml"]),
    ("million_terms", &["eval", "million_terms.toml"]),
    (
        "one_good_one_bad",
        &[
            "eval",
            "--no-mc",
            "--json",
            "-o",
            "out.json",
            "good.toml",
            "god.toml",
        ],
    ),
];

#[test]
fn every_mistake_on_the_command_line_is_refused_with_its_message() {
    let files = Place::new("mistakes");
    let mut stale = Vec::new();
    let mut wrong = Vec::new();
    for (name, arguments) in MISTAKES {
        let (code, shown) = files.run(arguments);
        if code != 2 || shown.contains("panicked") || shown.len() > 20_000 {
            wrong.push(format!("{name}: exit {code}, {} bytes", shown.len()));
        }
        let shown = format!("$ gumption {}\n{shown}", arguments.join(" "));
        stale.extend(common::stale(&place(name), &shown));
    }
    assert!(
        wrong.is_empty(),
        "not refused as it should be:\n  {}",
        wrong.join("\n  ")
    );
    common::assert_fresh(&stale);
}

fn place(name: &str) -> PathBuf {
    common::root()
        .join(Path::new("tests/bad_arguments"))
        .join(format!("{name}.txt"))
}

#[test]
fn a_good_budget_is_evaluated_beside_a_bad_one() {
    let files = Place::new("beside");
    let (code, shown) = files.run(&["eval", "--no-mc", "god.toml", "good.toml"]);
    assert_eq!(code, 2);
    assert!(shown.contains("Resistance") && shown.contains("god.toml"));
}
