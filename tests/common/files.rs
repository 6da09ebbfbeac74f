//! Finding files of the repository, and keeping generated files fresh.

use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// All files with this extension below a folder of the repository, in order.
pub fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    collect(&root().join(folder), extension, &mut found);
    found.sort();
    assert!(!found.is_empty(), "no *.{extension} below {folder}");
    found
}

fn collect(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the repository") {
        let path = entry.expect("an entry of that folder").path();
        if path.is_dir() {
            collect(&path, extension, found);
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
}

/// A path as it is written in the repository, with `/` on every platform.
pub fn relative(path: &Path) -> String {
    path.strip_prefix(root())
        .unwrap_or(path)
        .components()
        .map(|c| c.as_os_str().to_string_lossy())
        .collect::<Vec<_>>()
        .join("/")
}

/// Compares a generated file with the committed one; with `GUMPTION_UPDATE=1` writes it instead.
/// Returns what is stale, for one message about all files.
pub fn stale(path: &Path, generated: impl AsRef<[u8]>) -> Option<String> {
    let generated = generated.as_ref();
    if std::fs::read(path).is_ok_and(|committed| committed == generated) {
        return None;
    }
    if std::env::var_os("GUMPTION_UPDATE").is_some() {
        std::fs::create_dir_all(path.parent().expect("a file has a folder"))
            .expect("a writable folder");
        std::fs::write(path, generated).expect("a writable file");
        return None;
    }
    Some(relative(path))
}

/// Fails with the list of stale files and the command that renews them.
pub fn assert_fresh(stale: &[String]) {
    assert!(
        stale.is_empty(),
        "{} generated file(s) differ from what the program makes now:\n  {}\nIf the change is meant: GUMPTION_UPDATE=1 cargo test, then read the difference",
        stale.len(),
        stale.join("\n  ")
    );
}

/// The experiments of the repository that build on a procedure.
#[allow(dead_code)]
pub fn calibrations() -> Vec<PathBuf> {
    let on_procedure = |path: &PathBuf| {
        let text = std::fs::read_to_string(path).expect("a readable file");
        text.contains("procedure = ")
    };
    let mut all = files("experiments", "toml");
    all.retain(on_procedure);
    all
}
