//! Where the files that a budget names come from: a disk, or a library of files in memory.

use std::io::{Error, ErrorKind, Result};
use std::path::{Component, Path, PathBuf};

/// Where budgets, and the files that they name, are read from.
///
/// Everything that a budget names (columns of CSV files, other budgets, saved results) is looked up
/// from the folder of the budget, here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Files<'a> {
    /// The files of the computer.
    #[default]
    Disk,
    /// Files in memory: path from the top of the library with `/` between its parts, and content.
    Library(&'a [(&'a str, &'a [u8])]),
}

impl Files<'_> {
    /// The content of a file.
    ///
    /// # Errors
    /// As the operating system says; `NotFound` for a file that the library lacks.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>> {
        match self {
            Files::Disk => std::fs::read(path),
            Files::Library(files) => {
                let wanted = plain(path);
                files
                    .iter()
                    .find(|(name, _)| Path::new(name) == wanted)
                    .map(|(_, content)| content.to_vec())
                    .ok_or_else(|| Error::from(ErrorKind::NotFound))
            }
        }
    }

    /// Whether the path is a folder.
    pub fn is_folder(&self, path: &Path) -> bool {
        match self {
            Files::Disk => path.is_dir(),
            Files::Library(files) => {
                let wanted = plain(path);
                files.iter().any(|(name, _)| {
                    Path::new(name) != wanted && Path::new(name).starts_with(&wanted)
                })
            }
        }
    }

    /// The same for every way to write the path of one file.
    pub fn identity(&self, path: &Path) -> PathBuf {
        match self {
            Files::Disk => std::fs::canonicalize(path)
                .or_else(|_| std::path::absolute(path).map(|path| plain(&path)))
                .unwrap_or_else(|_| plain(path)),
            Files::Library(_) => plain(path),
        }
    }
}

/// The path without `.` and `..`, as far as the text tells.
fn plain(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if out.file_name().is_some() => {
                out.pop();
            }
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_is_read_like_a_disk() {
        let files = Files::Library(&[("mass/a.toml", b"a"), ("length/b.csv", b"b")]);
        let read = |path: &str| files.read(Path::new(path));
        assert_eq!(read("mass/a.toml").unwrap(), b"a");
        assert_eq!(read("mass/../length/./b.csv").unwrap(), b"b");
        assert_eq!(read("mass/b.csv").unwrap_err().kind(), ErrorKind::NotFound);
        assert!(files.is_folder(Path::new("mass")) && !files.is_folder(Path::new("mass/a.toml")));
        assert_eq!(
            files.identity(Path::new("mass/../mass/a.toml")),
            Path::new("mass/a.toml")
        );
    }

    #[test]
    fn a_file_of_the_disk_has_one_identity() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
        let one = Files::Disk.identity(&root.join("Cargo.toml"));
        let other = Files::Disk.identity(&root.join("src/../Cargo.toml"));
        assert_eq!(one, other);
        assert!(Files::Disk.read(&one).is_ok());
        let missing = Files::Disk.identity(&root.join("src/../no-such-file.toml"));
        assert!(missing.ends_with("no-such-file.toml") && missing.is_absolute());
    }
}
