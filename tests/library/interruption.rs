//! An evaluation that is interrupted leaves nothing behind.
#![cfg(unix)]

use std::process::{Command, Stdio};
use std::time::Duration;

#[test]
fn an_interrupted_run_writes_no_file() {
    let folder = std::env::temp_dir().join(format!("gumption-interruption-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for temporary files");
    let budget = folder.join("budget.toml");
    let text = "title = \"Long\"\n[measurand.Y]\nmodel = \"a * b\"\n[input]\na = { value = 1, u = 0.1 }\nb = { value = 2, u = 0.1 }\n";
    std::fs::write(&budget, text).expect("a file");
    let mut child = crate::common::program()
        .arg("eval")
        .arg(&budget)
        .args(["--trials", "1e12", "--threads", "1", "--output"])
        .arg(folder.join("report.txt"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(Duration::from_millis(400));
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
    assert!(!status.expect("the program ends").success());
    let left: Vec<_> = std::fs::read_dir(&folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name())
        .collect();
    assert_eq!(left, ["budget.toml"]);
    std::fs::remove_dir_all(&folder).expect("it can be removed again");
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
