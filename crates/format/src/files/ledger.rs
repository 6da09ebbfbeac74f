//! The files that a command has read, so that it writes none of them.

use std::collections::HashSet;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use super::identity::FileId;

/// Nothing until a program asks for it: a library that reads files for years keeps none of their names.
static READ: OnceLock<Mutex<HashSet<FileId>>> = OnceLock::new();

/// From now on this process knows which files of the disk it has read. A command asks for it when it begins.
pub fn remember_reads() {
    READ.get_or_init(Mutex::default);
}

/// Notes a file that is being read.
pub(super) fn note(path: &Path) {
    if let (Some(mut read), Some(file)) = (ledger(), FileId::of(path)) {
        read.insert(file);
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
    let file = FileId::of(path);
    file.is_some_and(|file| ledger().is_some_and(|read| read.iter().any(|one| one.is(&file))))
}

/// Whether an open file, such as standard output, has been read.
pub fn was_read_as(open: &Metadata) -> bool {
    ledger().is_some_and(|read| read.iter().any(|one| one.is_open_as(open)))
}

fn ledger() -> Option<MutexGuard<'static, HashSet<FileId>>> {
    let read = READ.get()?;
    Some(read.lock().unwrap_or_else(PoisonError::into_inner))
}
