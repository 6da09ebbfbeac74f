//! The gallery of mistakes: every file of `tests/bad_budgets` is refused, and what the user then reads is
//! the text beside it. Read the texts as a new user would.

mod common;

use std::process::Command;

/// Runs the program on a bad file, as a user would, from the folder of the file.
fn message(path: &std::path::Path) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_gumption"))
        .current_dir(path.parent().expect("a file has a folder"))
        .arg("eval")
        .arg(path.file_name().expect("a file has a name"))
        .env("NO_COLOR", "1")
        .output()
        .expect("the program runs");
    let shown = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    (output.status.code().unwrap_or(-1), shown)
}

#[test]
fn every_mistake_is_refused_with_its_message() {
    let mut stale = Vec::new();
    let mut accepted = Vec::new();
    for path in common::files("tests/bad_budgets", "toml") {
        let (code, shown) = message(&path);
        if code != 2 || !shown.contains("error") {
            accepted.push(format!("{} (exit {code})", common::relative(&path)));
        }
        stale.extend(common::stale(&path.with_extension("txt"), &shown));
    }
    assert!(
        accepted.is_empty(),
        "not refused as bad input:\n  {}",
        accepted.join("\n  ")
    );
    common::assert_fresh(&stale);
}

#[test]
fn no_message_shows_the_inside_of_the_program() {
    for path in common::files("tests/bad_budgets", "txt") {
        let text = std::fs::read_to_string(&path).expect("a readable file");
        for inside in [
            "panicked", "unwrap", "Option<", "Some(", "None,", "src/", "f64", "serde",
        ] {
            assert!(
                !text.contains(inside),
                "{} shows `{inside}`",
                common::relative(&path)
            );
        }
    }
}
