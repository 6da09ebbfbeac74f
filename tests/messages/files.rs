//! What the program does to files and terminals: it overwrites nothing that it reads, replaces nothing that somebody
//! else wrote, and lets no file command a terminal.

use std::fmt::Write;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Output, Stdio};
use std::sync::LazyLock;

use gumption::Files;
use gumption::fault::is_obeyed;
use gumption::files::remember_reads;
use gumption::files::write::{self, Replacing};
use proptest::prelude::*;

use crate::common::{self, Folder};

/// A folder with a budget, a case and what they read.
struct Place(Folder);

impl Place {
    fn new(name: &str) -> Self {
        let folder = common::folder(name);
        std::fs::create_dir(folder.join("sub")).expect("a folder");
        folder.put("budget.toml", BUDGET);
        folder.put("readings.csv", "V [V]\n5.01\n5.02\n5.03\n5.01\n");
        folder.put("case.toml", CASE);
        folder.put("recording.csv", RECORDING.as_bytes());
        Place(folder)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut program = common::program();
        let program = program.current_dir(&self.0).args(arguments);
        program
            .stdin(Stdio::null())
            .output()
            .expect("the program runs")
    }

    fn contents(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let entries = std::fs::read_dir(&self.0).expect("a folder").flatten();
        let paths = entries
            .map(|entry| entry.path())
            .filter(|path| path.is_file());
        let mut contents: Vec<_> = paths
            .map(|path| (path.clone(), std::fs::read(path).expect("a file")))
            .collect();
        contents.sort();
        contents
    }
}

/// What a spreadsheet takes: one line for each row, units in the heads, and exact; the program reads it itself.
#[test]
fn results_are_written_as_a_table() {
    let place = Place::new("table");
    place.0.put(
        "series.toml",
        "[measurand.I]\nmodel = \"V / R\"\nunit = \"mA\"\n[input]\nV = { value = 1, unit = \"V\", u = 0.001 }\n\
         R = { value = 100, unit = \"ohm\", u = 0.1 }\n[conformity]\nupper = 11\nrule = \"simple\"\n\
         [series]\ncolumns = [\"label\", \"V\"]\nrows = [[\"low, first\", 1.0], [\"high\", 1.2]]\n",
    );
    let run = place.run(&["eval", "series.toml", "--no-mc", "--csv", "results.csv"]);
    assert_eq!(run.status.code(), Some(1), "one row does not conform");
    let text = place.0.text("results.csv");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "label,I [mA],u(I) [mA],nu(I),k(I),U(I) [mA],lower(I) [mA],upper(I) [mA],verdict(I),p_c(I)"
    );
    assert!(lines[1].starts_with("\"low, first\",10.0,0.0141"), "{text}");
    assert!(lines[1].contains(",conforming,"), "{text}");
    assert!(lines[2].starts_with("high,12.0,"), "{text}");
    assert!(lines[2].contains(",not_conforming,"), "{text}");
    let table = String::from_utf8_lossy(&run.stdout).into_owned();
    let row = table.lines().find(|line| line.trim().starts_with("high"));
    assert!(
        row.is_some_and(|row| row.ends_with("not conforming")),
        "{table}"
    );
    // Its own columns are readings for another budget.
    place.0.put(
        "mean.toml",
        "[measurand.m]\nmodel = \"x\"\nunit = \"mA\"\n[input]\n\
         x = { unit = \"mA\", readings = { file = \"results.csv\", column = \"I\" } }\n",
    );
    let run = place.run(&["eval", "mean.toml", "--no-mc"]);
    assert_eq!(run.status.code(), Some(0));
    // Never over what was read.
    let run = place.run(&["eval", "series.toml", "--no-mc", "--csv", "series.toml"]);
    assert_eq!(run.status.code(), Some(2));
}

const BUDGET: &str = "title = \"Resistance\"\n[measurand.R]\nmodel = \"V / I\"\nunit = \"ohm\"\n[input]\n\
    V = { unit = \"V\", readings = { file = \"readings.csv\", column = \"V\" } }\n\
    I = { value = 20, unit = \"mA\", u = 0.05 }\n";

const CASE: &str = "recording = \"recording.csv\"\nequations = \"y = a + b*x\"\n[columns]\nx = \"stimulus\"\n\
    y = \"output\"\n[noise]\nu = \"1 mV\"\n";

static RECORDING: LazyLock<String> = LazyLock::new(|| {
    let mut text = String::from("x,y [V]\n");
    for k in 0..40 {
        let x = f64::from(k % 20) / 10.0 - 1.0;
        let noise = 1e-3 * f64::from((7 * k) % 11 - 5) / 3.0;
        let _ = writeln!(text, "{x},{}", 1.0 + 2.0 * x + 0.02 * x * x + noise);
    }
    text
});

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Every command with every option that names an output, on every name of what it reads.
#[test]
fn no_command_overwrites_what_it_reads() {
    let place = Place::new("inputs");
    for (name, of) in [
        ("hard.csv", "readings.csv"),
        ("hard.toml", "case.toml"),
        ("hard.json", "budget.toml"),
    ] {
        std::fs::hard_link(place.0.join(of), place.0.join(name)).expect("a link");
    }
    #[cfg(unix)]
    for (name, of) in [("soft.md", "budget.toml"), ("soft.csv", "recording.csv")] {
        std::os::unix::fs::symlink(of, place.0.join(name)).expect("a link");
    }
    let before = place.contents();
    let mut outputs = vec![
        vec!["eval", "budget.toml", "--json", "-o", "./budget.toml"],
        vec!["eval", "budget.toml", "--text", "-o", "sub/../readings.csv"],
        vec!["eval", "budget.toml", "-o", "hard.json"],
        vec!["eval", "budget.toml", "--save", "budget.toml"],
        vec![
            "eval",
            "budget.toml",
            "--save",
            "readings.csv",
            "-o",
            "report.md",
        ],
        vec!["diagnose", "case.toml", "--improved", "."],
        vec!["diagnose", "case.toml", "--text", "-o", "recording.csv"],
        vec!["simulate", "case.toml", "-o", "recording.csv"],
        vec![
            "allan",
            "recording.csv",
            "--column",
            "y",
            "--interval",
            "1",
            "--text",
            "-o",
            "recording.csv",
        ],
        vec!["verify", "budget.toml", "--text", "-o", "budget.toml"],
    ];
    #[cfg(unix)]
    outputs.extend([
        vec!["eval", "budget.toml", "-o", "soft.md"],
        vec!["simulate", "case.toml", "-o", "soft.csv"],
    ]);
    for arguments in outputs {
        let mut arguments = arguments;
        arguments.push("--force");
        let output = place.run(&arguments);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}\n{said}");
        assert!(
            said.contains("is read by this command"),
            "{arguments:?}\n{said}"
        );
        assert_eq!(place.contents(), before, "{arguments:?}");
    }
}

#[test]
fn a_table_beyond_the_memory_is_refused_before_it_is_read() {
    let place = Place::new("large");
    let table = std::fs::File::create(place.0.join("readings.csv")).expect("a file");
    // Sparse: no block of it is ever written.
    table.set_len(1 << 40).expect("a length");
    for (language, mend) in [("en", "average them in blocks"), ("zh", "gumption batch")] {
        let output = place.run(&["eval", "budget.toml", "--lang", language]);
        assert_eq!(output.status.code(), Some(2));
        let said = said(&output);
        assert!(said.contains("R0112"), "{said}");
        assert!(
            said.contains("1048576 MiB") && said.contains(mend),
            "{said}"
        );
    }
}

#[test]
fn what_somebody_wrote_is_replaced_when_the_program_is_told() {
    let place = Place::new("force");
    for (name, option) in [("report.md", "-o"), ("saved.json", "--save")] {
        place.0.put(name, "mine");
        let refused = place.run(&["eval", "budget.toml", "--no-mc", option, name]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(said(&refused).contains("--force"), "{}", said(&refused));
        assert_eq!(place.0.text(name), "mine");
        let told = place.run(&["eval", "budget.toml", "--no-mc", option, name, "--force"]);
        assert_eq!(told.status.code(), Some(0), "{}", said(&told));
        assert_ne!(place.0.text(name), "mine");
    }
    place.0.put("case.md", "mine");
    let chinese = place.run(&["eval", "budget.toml", "-o", "case.md", "--lang", "zh"]);
    assert!(said(&chinese).contains("已存在"), "{}", said(&chinese));
}

#[test]
fn an_unknown_ending_is_refused_before_the_work() {
    let place = Place::new("endings");
    for name in ["report.docm", "report", "report.toml"] {
        let refused = place.run(&["eval", "budget.toml", "-o", name]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(
            said(&refused).contains("the endings are .txt, .md, .html, .json"),
            "{}",
            said(&refused)
        );
        assert!(!place.0.join(name).exists());
    }
    for arguments in [["--json", "-o", "report"], ["--no-mc", "-o", "REPORT.MD"]] {
        let output = place.run(&[["eval", "budget.toml"].as_slice(), &arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    }
    assert!(place.0.text("REPORT.MD").starts_with("# Resistance"));
    let refused = place.run(&["simulate", "case.toml", "-o", "recording.md"]);
    assert!(said(&refused).contains(".csv"));
    let refused = place.run(&["batch", "budget.toml", "devices.csv", "-o", "results.xlsx"]);
    assert!(said(&refused).contains("no .xlsx"), "{}", said(&refused));
}

/// Of several outputs all are written, or none.
#[test]
fn nothing_is_written_where_one_output_cannot_be() {
    let place = Place::new("none");
    place.0.put("report.md", "mine");
    let before = place.contents();
    let output = place.run(&[
        "eval",
        "budget.toml",
        "--no-mc",
        "--save",
        "new.json",
        "-o",
        "report.md",
    ]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(place.contents(), before);
    let twice = place.run(&[
        "eval",
        "budget.toml",
        "--no-mc",
        "--save",
        "a.json",
        "-o",
        "./a.json",
    ]);
    assert!(said(&twice).contains("twice"), "{}", said(&twice));
    assert_eq!(place.contents(), before);
}

#[cfg(unix)]
mod on_unix {
    use super::*;

    #[test]
    fn pipes_and_devices_are_not_read() {
        let place = Place::new("special");
        for arguments in [
            ["eval", "/dev/zero"],
            ["plan", "/dev/zero"],
            ["calibrate", "/dev/null"],
            ["diagnose", "/dev/tty"],
            ["verify", "/dev/zero"],
        ] {
            let output = place.run(&arguments);
            assert_eq!(
                output.status.code(),
                Some(2),
                "{arguments:?} {}",
                said(&output)
            );
            let said = said(&output) + &String::from_utf8_lossy(&output.stdout);
            assert!(said.contains("only files are read"), "{arguments:?} {said}");
        }
        let budget = BUDGET.replace("readings.csv", "/dev/zero");
        place.0.put("other.toml", &budget);
        let output = place.run(&["eval", "other.toml"]);
        assert!(
            said(&output).contains("only files are read"),
            "{}",
            said(&output)
        );
    }

    /// Standard output under its other names, and as a file that is read.
    #[test]
    fn standard_output_is_known() {
        let place = Place::new("stdout");
        let to = |file: &str, arguments: &[&str]| {
            let file = std::fs::File::options()
                .append(true)
                .create(true)
                .open(place.0.join(file));
            let mut program = common::program();
            let program = program.current_dir(&place.0).args(arguments);
            program
                .stdout(file.expect("a file"))
                .output()
                .expect("the program runs")
        };
        place.0.put("log.txt", "before\n");
        for name in ["-", "/dev/stdout"] {
            let output = to("log.txt", &["eval", "budget.toml", "--no-mc", "-o", name]);
            assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        }
        let log = place.0.text("log.txt");
        assert!(
            log.starts_with("before\n") && log.matches("━━━").count() >= 2,
            "{log}"
        );
        let output = to("budget.toml", &["eval", "budget.toml", "--no-mc"]);
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(place.0.text("budget.toml"), BUDGET);
    }

    /// The pages are longer than what a pipe holds.
    #[test]
    fn a_reader_that_has_gone_away_is_no_error() {
        let place = Place::new("pipe");
        for arguments in [
            ["explain", "keys"].as_slice(),
            &["--help"],
            &["schema"],
            &["verify", "--json"],
        ] {
            let mut program = common::program();
            let program = program.current_dir(&place.0).args(arguments);
            let running = program
                .stdout(Stdio::piped())
                .stderr(Stdio::piped())
                .spawn();
            let mut running = running.expect("the program runs");
            let mut first = [0; 16];
            let mut pipe = running.stdout.take().expect("a pipe");
            let _ = pipe.read(&mut first);
            drop(pipe);
            let output = running.wait_with_output().expect("the program ends");
            assert_eq!(
                output.status.code(),
                Some(0),
                "{arguments:?} {}",
                said(&output)
            );
            assert_eq!(said(&output), "", "{arguments:?}");
        }
    }

    #[test]
    fn an_interrupt_ends_with_a_message_and_nothing_is_written() {
        let place = Place::new("interrupt");
        let mut program = common::program();
        let program = program.current_dir(&place.0);
        let arguments = ["eval", "budget.toml", "--trials", "1e12", "-o", "report.md"];
        let running = program.args(arguments).stderr(Stdio::piped()).spawn();
        let running = running.expect("the program runs");
        std::thread::sleep(std::time::Duration::from_secs(2));
        let id = running.id().to_string();
        let killed = std::process::Command::new("kill")
            .args(["-INT", &id])
            .status();
        assert!(killed.expect("kill").success());
        let output = running.wait_with_output().expect("the program ends");
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert_eq!(said(&output), "interrupted: nothing is written\n");
        assert!(!place.0.join("report.md").exists());
    }
}

/// Words that are found in texts come back without what a terminal would obey.
#[test]
fn words_to_explain_command_no_terminal() {
    let output = Place::new("explain-hostile").run(&["explain", "creep\r"]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(
        text.contains("no topic of its own") && text.contains("lag"),
        "{text}"
    );
    assert_eq!(text.chars().find(|c| is_obeyed(*c)), None, "{text:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Titles, labels and names of files reach no form of a report, and no message, raw.
    #[test]
    fn no_output_commands_a_terminal(
        title in hostile(), label in hostile(), name in hostile(), head in hostile(),
    ) {
        let place = Place::new("hostile");
        let toml = |text: &str| serde_json::to_string(text).expect("a string");
        let name: String = name.chars().filter(|c| !"/\0".contains(*c)).collect();
        let path = format!("{name}.toml");
        let budget = format!(
            "title = {}\nmethod = {}\n[measurand.R]\nmodel = \"V / I\"\nunit = \"ohm\"\ndescription = {}\n[input]\n\
             V = {{ value = 5, unit = \"V\", u = 0.1, description = {} }}\nI = {{ value = 20, unit = \"mA\", u = 0.05 }}\n",
            toml(&title), toml(&label), toml(&label), toml(&title),
        );
        place.0.put(&path, &budget);
        place.0.put("faulty.toml", budget.replace("u = 0.05", &format!("{} = 3", toml(&head))));
        place.0.put("case.toml", CASE.replace("recording.csv", "evil.csv"));
        place.0.put("evil.csv", RECORDING.replace("x,y", &format!("x,{},y", head.replace([',', '\n', '"'], ""))));
        for arguments in [
            ["eval", "--no-mc", path.as_str()].as_slice(),
            &["eval", "--no-mc", "--markdown", "--lang", "zh", &path],
            &["eval", "--no-mc", "--json", &path],
            &["eval", &name],
            &["eval", "faulty.toml", "--lang", "zh"],
            &["eval", &path, "-o", &name],
            &["verify", &path],
            &["diagnose", "case.toml"],
            &["allan", "evil.csv", "--column", &head.replace('\0', ""), "--interval", "1"],
            &["explain", &head.replace('\0', "")],
        ] {
            if arguments.iter().any(|argument| argument.starts_with('-') && argument.len() > 10 || argument.is_empty()) {
                continue;
            }
            let output = place.run(arguments);
            for bytes in [&output.stdout, &output.stderr] {
                let text = String::from_utf8_lossy(bytes);
                let obeyed = text.chars().find(|c| is_obeyed(*c));
                prop_assert_eq!(obeyed, None, "{:?}\n{:?}", arguments, text);
            }
        }
    }
}

/// Words with what a terminal obeys among them.
fn hostile() -> impl Strategy<Value = String> {
    let evil = [
        "\u{1b}[31m",
        "\u{1b}]0;x\u{7}",
        "\u{9b}2J",
        "\u{202e}",
        "\u{2066}",
        "\u{200f}",
        "\r",
        "\u{8}",
        "\u{7f}",
        "\u{2028}",
        "\u{e0041}",
        "\t",
        "電",
        "|",
        "<b>",
        "`",
        "ordinary",
    ];
    prop::collection::vec(prop::sample::select(evil.to_vec()), 1..6)
        .prop_map(|words| format!("a{}", words.concat()))
}

proptest! {
    /// Whatever a file is called, it is not written if it was read.
    #[test]
    fn outputs_are_never_inputs(
        links in prop::collection::vec((0..4_usize, 0..3_usize), 0..4),
        read in prop::collection::vec(0..8_usize, 1..4),
        written in prop::collection::vec(0..8_usize, 1..4),
        around in prop::collection::vec(0..3_usize, 4),
    ) {
        remember_reads();
        let place = Place::new("links");
        for file in 0..4 {
            place.0.put(format!("f{file}"), format!("content {file}"));
        }
        for (link, (to, kind)) in links.iter().enumerate() {
            let (from, to) = (place.0.join(format!("l{link}")), place.0.join(format!("f{to}")));
            let _ = match kind {
                #[cfg(unix)]
                0 => std::os::unix::fs::symlink(to, from),
                1 => std::fs::hard_link(to, from),
                _ => std::fs::copy(to, from).map(drop),
            };
        }
        let name = |index: usize| match index {
            0..4 => format!("f{index}"),
            _ => format!("l{}", index - 4),
        };
        let mut inputs = Vec::new();
        for index in read {
            let path = place.0.join(name(index));
            if let Ok(content) = Files::Disk.read(&path) {
                inputs.push((path, content));
            }
        }
        let written = written.iter().zip(&around).map(|(index, around)| {
            let way = ["", "./", "sub/../"][*around];
            write::Output { path: place.0.join(format!("{way}{}", name(*index))), content: b"new".to_vec() }
        });
        let result = write::write(&written.collect::<Vec<_>>(), Replacing::Anything);
        for (path, content) in inputs {
            prop_assert_eq!(std::fs::read(&path).expect("a file"), content, "{:?}", result);
        }
    }
}
