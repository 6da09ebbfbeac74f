//! The gallery of mistakes: every file of `tests/bad_budgets` is refused, and what the user then reads is
//! the text beside it. Read the texts as a new user would.

use crate::common;
use std::path::Path;

/// Runs the program on a bad file, as a user would, from the folder of the file; on `zh_….toml` as a Chinese user.
fn message(path: &Path) -> (i32, String) {
    let folder = path.parent().expect("a file has a folder");
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.expect("a file has a name");
    let language = if name.starts_with("zh_") { "zh" } else { "en" };
    run(folder, &["eval", name, "--lang", language])
}

/// Exit code, and all that the program says.
fn run(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let output = common::program()
        .current_dir(folder)
        .args(arguments)
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
        if code != 2 || !["error", "错误"].iter().any(|word| shown.contains(word)) {
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

/// Every command that reports in Chinese refuses a file in Chinese, too.
#[test]
fn every_command_refuses_in_chinese() {
    let folder = common::folder("chinese");
    folder.put(
        "budget.toml",
        "[measurand.Y]\nmodel = 'X'\n[input.X]\nvalue = 1\nuu = 1\n",
    );
    folder.put("calibration.toml", "equations = 1\n");
    folder.put("case.toml", "recording = 1\nmodel = 1\n");
    for (arguments, wanted) in [
        (&["eval", "budget.toml"][..], "错误[B0104]: "),
        (&["verify", "budget.toml"], "错误[B0104]: "),
        (&["calibrate", "calibration.toml"], "错误["),
        (&["plan", "calibration.toml"], "错误["),
        (&["plan", "case.toml"], "错误["),
        (&["diagnose", "case.toml"], "错误["),
        (
            &["allan", "none.csv", "--column", "x", "--interval", "1"],
            "错误[R0101]: 没有文件",
        ),
    ] {
        let (code, shown) = run(&folder, &[arguments, &["--lang", "zh"]].concat());
        assert_eq!(code, 2, "{arguments:?}\n{shown}");
        for part in [wanted, "处错误\n"] {
            assert!(shown.contains(part), "{arguments:?}: no {part} in\n{shown}");
        }
        assert!(english(&shown).is_none(), "{arguments:?}\n{shown}");
    }
}

/// What a Chinese message says in English are names, quotations and the lines of the file.
#[test]
fn no_mistake_is_explained_in_english() {
    let mut found = Vec::new();
    for path in common::files("tests/bad_budgets", "toml") {
        let folder = path.parent().expect("a file has a folder");
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.expect("a file has a name");
        let (_, shown) = run(folder, &["eval", name, "--lang", "zh"]);
        found.extend(english(&shown).map(|words| format!("{name}: {words}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The first three English words in a row outside of quotations, of lists of names and of lines of the file.
fn english(shown: &str) -> Option<String> {
    let numbered = |line: &&str| {
        let (number, rest) = line.trim_start().split_once(' ').unwrap_or((line, ""));
        let number = number.trim_start_matches('…');
        rest.trim_start().starts_with('|') && number.bytes().all(|byte| byte.is_ascii_digit())
    };
    shown
        .lines()
        .filter(|line| !numbered(line))
        .find_map(|line| {
            let mut rest = line.replace(['“', '”'], "\"");
            for mark in ['`', '"'] {
                let parts: Vec<&str> = rest.split(mark).collect();
                rest = parts
                    .iter()
                    .step_by(2)
                    .copied()
                    .collect::<Vec<_>>()
                    .join("·");
            }
            let words: Vec<&str> = rest.split(' ').collect();
            let word = |text: &&str| {
                let letters = text.trim_end_matches([':', ';', '.']);
                letters.len() > 1 && letters.bytes().all(|byte| byte.is_ascii_alphabetic())
            };
            let run = words.windows(3).find(|run| run.iter().all(word))?;
            Some(run.join(" "))
        })
}
