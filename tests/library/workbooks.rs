//! Workbooks: the same bytes every time, and formulas that give the evaluation's figures when another spreadsheet engine
//! calculates them.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::common::{folder, program, root};

/// Budgets with t, a fixed k, correlations, corners, several measurands, shared sources.
const BUDGETS: [&str; 6] = [
    "electrical/dmm-100v-ea402-s9",
    "electrical/impedance-gum-h2",
    "length/end-gauge-gum-h1",
    "mass/weight-10kg-ea402-s2",
    "calibration-lines/voltage-bevington-6-1",
    "chemistry/sodium-hydroxide-quam-a2",
];

fn written(budget: &str, file: &PathBuf) -> Vec<u8> {
    let path = root().join(format!("budgets/{budget}.toml"));
    let run = program()
        .args(["eval", "--force"])
        .arg(path)
        .arg("-o")
        .arg(file)
        .output()
        .expect("the program runs");
    assert_ne!(run.status.code(), Some(2), "{budget}");
    std::fs::read(file).expect("a workbook")
}

#[test]
fn workbooks_are_the_same_every_time() {
    let folder = folder("workbooks");
    let file = folder.join("again.xlsx");
    let first = written(BUDGETS[0], &file);
    assert!(first.starts_with(b"PK"));
    assert_eq!(first, written(BUDGETS[0], &file));
}

/// Workbooks of all budgets in a folder, calculated by a script of Python; `None` where it lacks what it needs.
fn calculated(folder: &Path, script: &str, first: &[&Path]) -> Option<()> {
    let files = BUDGETS.map(|budget| {
        let file = folder.join(format!("{}.xlsx", budget.replace('/', "_")));
        written(budget, &file);
        file
    });
    let run = Command::new("python3")
        .arg(root().join("tests/library").join(script))
        .args(first)
        .args(&files)
        .output();
    let run = run.ok().filter(|run| run.status.code() != Some(77))?;
    let said = String::from_utf8_lossy(&run.stdout);
    let errors = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{said}{errors}");
    Some(())
}

#[test]
fn another_engine_calculates_the_same_figures() {
    if calculated(&folder("engine"), "recalculated.py", &[]).is_none() {
        eprintln!("skipped: needs Python with the packages formulas and openpyxl");
    }
}

#[test]
fn libreoffice_calculates_the_same_figures() {
    let folder = folder("office");
    if calculated(&folder, "office.py", &[&folder]).is_none() {
        eprintln!("skipped: needs LibreOffice, and Python with the package openpyxl");
    }
}
