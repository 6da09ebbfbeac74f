//! Where the files that a budget names come from, a disk or a library of files in memory; and the one way in which
//! files are written.
//!
//! | chapter | holds |
//! |---|---|
//! | `growing` | a file that is written piece by piece |
//! | `identity` | what makes a file the same under every name |
//! | `ledger` | the files that a command has read, which it does not write |
//! | `mark` | how a file is known to be as this program wrote it |
//! | `steps` | the operations of the file system that writing takes, each of which may fail |
//! | [`write`](mod@write) | files replaced as a whole, all of them or none |

mod growing;
mod identity;
mod ledger;
mod mark;
mod steps;
pub mod write;
#[cfg(test)]
mod written;

pub use growing::Growing;
pub use identity::FileId;
pub use ledger::{Ledger, reads, remember_reads, was_read_as};

use std::io::{Error, ErrorKind, Read, Result};
use std::path::{Component, Path, PathBuf};

use gumption_fault::{Said, nearest, say};

/// Most bytes of a file that are read: ten million rows of eight columns. What is read is in memory as a whole,
/// and its numbers beside it.
pub(crate) const MOST_BYTES: u64 = 1 << 30;

/// Where budgets, and the files that they name, are read from.
///
/// Everything that a budget names (columns of CSV files, other budgets, saved results) is looked up
/// from the folder of the budget, here.
#[derive(Debug, Clone, Copy, Default)]
pub enum Files<'a> {
    /// The files of the computer.
    #[default]
    Disk,
    /// The files of the computer, of which it is noted which ones are read.
    Noted(&'a Ledger),
    /// Files in memory: path from the top of the library with `/` between its parts, and content.
    Library(&'a [(&'a str, &'a [u8])]),
    /// A folder of the computer, outside of which nothing is read.
    Folder(&'a Folder<'a>),
}

/// A folder from which alone files are read, whatever their names and links say. Paths are those from the folder on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Folder<'a> {
    /// Where it is, without links ([`std::fs::canonicalize`]).
    pub root: &'a Path,
    /// Contents that are read in place of those on the disk, as those that are being edited.
    pub instead: &'a [(&'a str, &'a [u8])],
}

impl Folder<'_> {
    /// Where a file or a folder is; `NotFound` outside.
    fn place(&self, path: &Path) -> Result<PathBuf> {
        let place = std::fs::canonicalize(self.root.join(path))?;
        match place.starts_with(self.root) {
            true => Ok(place),
            false => Err(Error::from(ErrorKind::NotFound)),
        }
    }
}

/// How a file that is named by another in memory is found.
pub fn given_in_memory(name: &str) -> Said {
    say!(
        "what is in memory finds nothing on the disk: give the file, too (in Python, `files={{\"{name}\": its content}}`), or name the path of the file that names it, beside which it is looked for"
    )
}

/// The names of the files in a folder of the computer.
fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries
        .map(|entry| entry.path())
        .filter(|path| path.is_file());
    paths.filter_map(|path| name_of(&path)).collect()
}

fn name_of(path: &Path) -> Option<String> {
    Some(path.file_name()?.to_str()?.to_owned())
}

/// The content among some that are in memory.
fn held<'a>(contents: &[(&str, &'a [u8])], path: &Path) -> Option<&'a [u8]> {
    let wanted = plain(path);
    let mut contents = contents.iter();
    let found = contents.find(|(name, _)| Path::new(name) == wanted);
    found.map(|(_, content)| *content)
}

impl<'a> Files<'a> {
    /// Notes a file of the disk that is read.
    fn note(&self, path: &Path) {
        match self {
            Files::Noted(ledger) => ledger.note(path),
            _ => ledger::note(path),
        }
    }

    /// The content of a file.
    ///
    /// # Errors
    /// As the operating system says; `NotFound` for a file that the library lacks; `InvalidInput` for a pipe, a
    /// device, and for more than a gibibyte.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>> {
        match self {
            Files::Disk | Files::Noted(_) => {
                self.note(path);
                content_of(path)
            }
            Files::Library(files) => held(files, path)
                .map(<[u8]>::to_vec)
                .ok_or_else(|| Error::from(ErrorKind::NotFound)),
            Files::Folder(folder) => match held(folder.instead, path) {
                Some(content) => Ok(content.to_vec()),
                None => content_of(&folder.place(path)?),
            },
        }
    }

    /// The content of a file, to be read piece by piece: of any length.
    ///
    /// # Errors
    /// As [`Files::read`].
    pub fn open(self, path: &Path) -> Result<Box<dyn Read + 'a>> {
        match self {
            Files::Disk | Files::Noted(_) => {
                self.note(path);
                let (file, _) = opened(path)?;
                Ok(Box::new(file))
            }
            Files::Library(files) => match held(files, path) {
                Some(content) => Ok(Box::new(content)),
                None => Err(Error::from(ErrorKind::NotFound)),
            },
            Files::Folder(folder) => match held(folder.instead, path) {
                Some(content) => Ok(Box::new(content)),
                None => Ok(Box::new(opened(&folder.place(path)?)?.0)),
            },
        }
    }

    /// A file of the computer, for those who read it back and forth.
    ///
    /// # Errors
    /// As [`Files::read`]; `Unsupported` for what is in memory.
    pub fn handle(self, path: &Path) -> Result<std::fs::File> {
        match self {
            Files::Disk | Files::Noted(_) => {
                self.note(path);
                opened(path).map(|(file, _)| file)
            }
            Files::Folder(folder) if held(folder.instead, path).is_none() => {
                opened(&folder.place(path)?).map(|(file, _)| file)
            }
            _ => Err(Error::from(ErrorKind::Unsupported)),
        }
    }

    /// How many bytes a file has, as far as is known.
    pub fn length(&self, path: &Path) -> Option<u64> {
        match self {
            Files::Disk | Files::Noted(_) => std::fs::metadata(path).ok().map(|there| there.len()),
            Files::Library(files) => held(files, path).map(|content| content.len() as u64),
            Files::Folder(folder) => match held(folder.instead, path) {
                Some(content) => Some(content.len() as u64),
                None => Files::Disk.length(&folder.place(path).ok()?),
            },
        }
    }

    /// Whether the path is a folder.
    pub fn is_folder(&self, path: &Path) -> bool {
        match self {
            Files::Disk | Files::Noted(_) => path.is_dir(),
            Files::Library(files) => {
                let wanted = plain(path);
                files.iter().any(|(name, _)| {
                    Path::new(name) != wanted && Path::new(name).starts_with(&wanted)
                })
            }
            Files::Folder(folder) => folder.place(path).is_ok_and(|place| place.is_dir()),
        }
    }

    /// The file beside a missing one that may be meant: of the same ending, and of nearly the same name.
    pub fn near(&self, missing: &Path) -> Option<String> {
        let folder = missing.parent().filter(|folder| *folder != Path::new(""));
        let folder = folder.unwrap_or(Path::new("."));
        let mut names: Vec<String> = match self {
            Files::Disk | Files::Noted(_) => names_in(folder),
            Files::Library(files) => {
                let beside = plain(missing);
                let paths = files.iter().map(|(name, _)| Path::new(name));
                let paths = paths.filter(|path| path.parent() == beside.parent());
                paths.filter_map(name_of).collect()
            }
            Files::Folder(of) => of
                .place(folder)
                .map_or_else(|_| Vec::new(), |place| names_in(&place)),
        };
        names.retain(|name| Path::new(name).extension() == missing.extension());
        names.sort_unstable();
        // Endings are the same: they make no two names alike.
        let stem = |name: &str| Path::new(name).file_stem()?.to_str().map(str::to_owned);
        let stems: Vec<String> = names.iter().filter_map(|name| stem(name)).collect();
        let near = nearest(&stem(&name_of(missing)?)?, stems.iter().map(String::as_str))?;
        let mut names = names.into_iter();
        names.find(|name| stem(name).as_deref() == Some(near))
    }

    /// The same for every way to write the path of one file.
    pub fn identity(&self, path: &Path) -> PathBuf {
        match self {
            Files::Disk | Files::Noted(_) => std::fs::canonicalize(path)
                .or_else(|_| std::path::absolute(path).map(|path| plain(&path)))
                .unwrap_or_else(|_| plain(path)),
            Files::Library(_) => plain(path),
            Files::Folder(folder) => {
                let place = folder.place(path);
                place.unwrap_or_else(|_| folder.root.join(plain(path)))
            }
        }
    }
}

fn refused<T>(why: String) -> Result<T> {
    Err(Error::new(ErrorKind::InvalidInput, why))
}

/// A file of the disk. Whatever else has a path (a pipe, a device, a socket) may block, never end or do something when
/// it is read, and two readings of it differ.
fn opened(path: &Path) -> Result<(std::fs::File, std::fs::Metadata)> {
    // Asked before it is opened: a pipe without a writer would wait for one.
    let there = std::fs::metadata(path)?;
    if !there.is_file() && !there.is_dir() {
        return refused("it is a pipe or a device; only files are read".into());
    }
    Ok((std::fs::File::open(path)?, there))
}

/// The whole content of a file of the disk.
fn content_of(path: &Path) -> Result<Vec<u8>> {
    let (mut file, there) = opened(path)?;
    let mut content = Vec::new();
    // Some files of the system say that they are empty and are not.
    let mut bounded = (&mut file).take(MOST_BYTES + 1);
    if there.len() <= MOST_BYTES {
        content.reserve_exact(there.len() as usize);
        bounded.read_to_end(&mut content)?;
    }
    if there.len() > MOST_BYTES || content.len() as u64 > MOST_BYTES {
        let most = MOST_BYTES >> 20;
        return refused(format!(
            "it is larger than {most} MiB, the most that is read"
        ));
    }
    Ok(content)
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
    fn nothing_is_read_outside_a_folder() {
        let root = std::fs::canonicalize(concat!(env!("CARGO_MANIFEST_DIR"), "/src"));
        let root = root.expect("the sources");
        let instead: &[(&str, &[u8])] = &[("lib.rs", b"edited")];
        let folder = Folder {
            root: &root,
            instead,
        };
        let files = Files::Folder(&folder);
        let read = |path: &str| files.read(Path::new(path));
        assert_eq!(read("toml/../lib.rs").expect("edited"), b"edited");
        assert!(read("machine.rs").is_ok() && files.is_folder(Path::new("files")));
        let absolute = root.join("machine.rs");
        assert!(files.read(&absolute).is_ok());
        for outside in ["../Cargo.toml", "/etc/hostname", "files/../../Cargo.toml"] {
            let refused = read(outside).expect_err("outside");
            assert_eq!(refused.kind(), ErrorKind::NotFound, "{outside}");
        }
        assert!(!files.is_folder(Path::new("..")));
        let identity = |path: &str| files.identity(Path::new(path));
        assert_eq!(identity("toml/../machine.rs"), absolute);
        assert_eq!(identity("new.toml"), root.join("new.toml"));
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
