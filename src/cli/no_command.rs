//! A file where the command should stand: which commands take such a file.

use std::path::Path;

use gumption::Files;
use gumption::experiment::{Kind, kind_of};
use gumption::fault::{Said, say};

/// What to write in place of `gumption FILE`; nothing where the word is no name of a file.
pub(super) fn to_write(word: &str) -> Option<Said> {
    let path = Path::new(word);
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    if path.is_dir() {
        return Some(say!(
            "before the folder {word} a command is missing: `gumption serve {word}` opens its budgets in the browser, `gumption verify {word}` holds them against their claims"
        ));
    }
    match ending.as_deref() {
        Some("csv" | "tsv") => Some(say!(
            "before the table {word} a command is missing: `gumption audit {word}` for somebody's budget, `gumption new experiment.toml --recording {word}` for a recording, `gumption fleet {word}` for results of many devices"
        )),
        Some("xlsx" | "xls" | "ods" | "md") => Some(say!(
            "before the sheet {word} a command is missing: `gumption audit {word}` recomputes the budget in it, `gumption import {word}` writes it as a file for `gumption eval`"
        )),
        Some(_) => Some(of_toml(path, word)),
        None => path.is_file().then(|| of_toml(path, word)),
    }
}

fn of_toml(path: &Path, word: &str) -> Said {
    let bytes = Files::Disk.read(path).unwrap_or_default();
    match kind_of(&String::from_utf8_lossy(&bytes)) {
        Kind::Budget => say!(
            "before the budget {word} a command is missing: `gumption eval {word}`; `batch` evaluates it for every row of a table, `verify` holds it against its claims"
        ),
        Kind::Experiment | Kind::Schedule => say!(
            "before the experiment {word} a command is missing: `gumption calibrate {word}` finds its coefficients; `diagnose`, `plan` and `simulate` read it as well"
        ),
        Kind::Certificate => say!(
            "before {word}, the data of a certificate, the command and a budget are missing: `gumption eval budget.toml --certificate {word}`"
        ),
        Kind::Unknown => say!(
            "before {word} a command is missing: `gumption eval {word}` for a budget, `gumption calibrate {word}` for an experiment"
        ),
    }
}
