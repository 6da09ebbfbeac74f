//! The example of the page on fleet statistics is what the program makes of it.

use crate::common::{self, cases};

const FOLDER: &str = "docs/examples/fleet";

#[test]
fn the_results_of_the_example_are_those_of_its_devices() {
    let folder = common::root().join(FOLDER);
    let arguments = [
        "batch",
        "resistors.toml",
        "devices.csv",
        "--keep",
        "type,laboratory,date",
        "--shares",
        "--lang",
        "en",
    ];
    let output = common::program()
        .current_dir(&folder)
        .args(arguments)
        .output()
        .expect("the program runs");
    // One row of it is faulty.
    assert_eq!(output.status.code(), Some(1));
    let results = String::from_utf8(output.stdout).expect("text");
    assert_eq!(results.lines().count(), 38);
    let path = folder.join("results.csv");
    common::assert_fresh(&Vec::from_iter(common::stale(&path, &results)));
}

#[test]
fn the_example_is_in_chinese_and_in_every_text_format() {
    let folder = common::root().join(FOLDER);
    let common = ["fleet", "results.csv", "--by", "type", "--date", "date"];
    for (more, expected) in [
        (&["--lang", "zh"][..], ["器件", "标准不确定度", "漂移"]),
        (&["--html", "--lang", "en"], ["<svg", "Birge", "A4"]),
        (&["--markdown", "--lang", "both"], ["Drift", "漂移", "| A4"]),
    ] {
        let (good, text) = cases::gumption(&folder, &[&common[..], more].concat());
        assert!(good, "{text}");
        for part in expected {
            assert!(text.contains(part), "{more:?}: {part}");
        }
    }
    let (good, said) = cases::gumption(
        &folder,
        &["fleet", "results.csv", "--by", "typ", "--lang", "zh"],
    );
    assert!(!good && said.contains("表中没有列"), "{said}");
}
