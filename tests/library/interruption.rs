//! What is interrupted leaves nothing behind, or says what it leaves.
#![cfg(unix)]

use std::io::Read;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

use crate::common::{Folder, folder, program};

#[test]
fn an_interrupted_run_writes_no_file() {
    let folder = folder("run");
    let budget = folder.join("budget.toml");
    let text = "title = \"Long\"\n[measurand.Y]\nmodel = \"a * b\"\n[input]\na = { value = 1, u = 0.1 }\nb = { value = 2, u = 0.1 }\n";
    std::fs::write(&budget, text).expect("a file");
    let mut child = program()
        .arg("eval")
        .arg(&budget)
        .args(["--trials", "1e12", "--threads", "1", "--output"])
        .arg(folder.join("report.txt"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(Duration::from_millis(400));
    assert!(!interrupted(&mut child).success());
    let left: Vec<_> = std::fs::read_dir(&folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name())
        .collect();
    assert_eq!(left, ["budget.toml"]);
}

/// A folder with an experiment and its recording, and so many names of this that their calibrations last.
fn recordings(name: &str) -> (Folder, Vec<&'static str>) {
    let folder = folder(name);
    folder.put(
        "gyro.toml",
        "recording = \"a.csv\"\nequations = \"y = K*x + b\"\n",
    );
    folder.put("a.csv", "x,y\n0,0.1\n1,2.0\n2,4.1\n3,5.9\n");
    (folder, vec!["a.csv"; 100_000])
}

#[test]
fn what_is_printed_of_recordings_before_an_interrupt_is_said_to_be_a_part() {
    for (language, words) in [("en", "is not whole"), ("zh", "不完整")] {
        let (folder, many) = recordings(language);
        let mut child = program()
            .current_dir(&folder)
            .args(["calibrate", "gyro.toml", "--recordings"])
            .args(many)
            .env(
                "LC_ALL",
                if language == "zh" {
                    "zh_CN.UTF-8"
                } else {
                    "C.UTF-8"
                },
            )
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut out = child.stdout.take().expect("a pipe");
        let mut printed = vec![0; 1 << 16];
        // A line is there before the others.
        let mut length = 0;
        while printed[..length]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count()
            < 2
        {
            length += out.read(&mut printed[length..]).expect("a table");
        }
        let ended = interrupted(&mut child).code();
        let mut said = String::new();
        let mut err = child.stderr.take().expect("a pipe");
        err.read_to_string(&mut said).expect("words");
        assert_eq!(ended, Some(130), "{said}");
        let printed = String::from_utf8_lossy(&printed[..length]);
        assert!(printed.starts_with("label,K,u(K)"), "{printed}");
        assert!(printed.contains("\na,1.9"), "{printed}");
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_table_of_recordings_that_is_interrupted_takes_no_place() {
    let (folder, many) = recordings("file");
    let mut child = program()
        .current_dir(&folder)
        .args([
            "calibrate",
            "gyro.toml",
            "-o",
            "results.csv",
            "--recordings",
        ])
        .args(many)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(Duration::from_millis(400));
    let ended = interrupted(&mut child).code();
    let mut said = String::new();
    let mut err = child.stderr.take().expect("a pipe");
    err.read_to_string(&mut said).expect("words");
    assert_eq!(ended, Some(130), "{said}");
    assert!(said.contains("nothing is written"), "{said}");
    let names = std::fs::read_dir(&folder).expect("the folder");
    let mut names: Vec<_> = names
        .map(|one| one.expect("an entry").file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["a.csv", "gyro.toml"]);
}

/// How a program ends that is interrupted as by Ctrl-C.
fn interrupted(child: &mut Child) -> ExitStatus {
    let signal = if ignores_interrupts(child.id()) {
        "-TERM"
    } else {
        "-INT"
    };
    let sent = Command::new("kill")
        .args([signal, child.id().to_string().as_str()])
        .status();
    assert!(sent.expect("kill is at hand").success());
    let status = (0..100).find_map(|_| {
        std::thread::sleep(Duration::from_millis(50));
        child.try_wait().expect("the program can be asked")
    });
    status.expect("the program ends")
}

/// Whether a program was started to ignore Ctrl-C, as those are that a script starts in the background. Where
/// the system does not tell, it is taken to listen.
fn ignores_interrupts(process: u32) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let signals = ignored.and_then(|hex| u64::from_str_radix(hex.trim(), 16).ok());
    // Signal n is bit n - 1; SIGINT is 2.
    signals.is_some_and(|signals| signals & 0b10 != 0)
}
