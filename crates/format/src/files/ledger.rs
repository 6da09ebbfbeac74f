//! The files that a command has read, so that it writes none of them.

use std::collections::HashSet;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use super::identity::FileId;

/// Files of the disk that have been read, known under all of their names.
#[derive(Debug, Default)]
pub struct Ledger(Mutex<HashSet<FileId>>);

/// Nothing until a program asks for it: a library that reads files for years keeps none of their names.
static READ: OnceLock<Ledger> = OnceLock::new();

/// From now on this process knows which files of the disk it has read. A command asks for it when it begins; what runs many of
/// them in one process has a [`Ledger`] for each.
pub fn remember_reads() {
    READ.get_or_init(Ledger::default);
}

/// Notes a file that is being read.
pub(super) fn note(path: &Path) {
    if let Some(ledger) = READ.get() {
        ledger.note(path);
    }
}

impl Ledger {
    /// Notes a file that is read.
    pub fn note(&self, path: &Path) {
        if let Some(file) = FileId::of(path) {
            self.files().insert(file);
        }
    }

    /// Notes the files of another one, too.
    pub fn note_all(&self, other: &Ledger) {
        let files: Vec<FileId> = other.files().iter().cloned().collect();
        self.files().extend(files);
    }

    /// Whether a file has been read, under any of its names.
    pub fn has(&self, path: &Path) -> bool {
        FileId::of(path).is_some_and(|file| self.files().iter().any(|one| one.is(&file)))
    }

    fn files(&self) -> MutexGuard<'_, HashSet<FileId>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The files of the disk that have been read, by their paths without links.
pub fn reads() -> Vec<PathBuf> {
    let read = ledger();
    let read = read.iter().flat_map(|read| read.iter());
    let mut paths: Vec<PathBuf> = read.map(|file| file.path().to_path_buf()).collect();
    paths.sort();
    paths
}

/// Whether a file of the disk has been read, under any of its names.
pub fn was_read(path: &Path) -> bool {
    READ.get().is_some_and(|read| read.has(path))
}

/// Whether an open file, such as standard output, has been read.
pub fn was_read_as(open: &Metadata) -> bool {
    ledger().is_some_and(|read| read.iter().any(|one| one.is_open_as(open)))
}

fn ledger() -> Option<MutexGuard<'static, HashSet<FileId>>> {
    READ.get().map(Ledger::files)
}
