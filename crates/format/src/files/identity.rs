//! What makes a file the same file under every name.

use std::fs::Metadata;
use std::path::{Path, PathBuf};

/// A file of the disk, whatever it is called: through links, hard links, `./` and, where the system does not tell
/// them apart, upper and lower case.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct FileId {
    /// Its path without links; the way in which systems without numbers for files know it.
    path: PathBuf,
    /// Device and number of the file there.
    node: Option<(u64, u64)>,
}

impl FileId {
    /// The identity of a file that is there.
    pub fn of(path: &Path) -> Option<FileId> {
        let path = std::fs::canonicalize(path).ok()?;
        let node = std::fs::metadata(&path).ok().and_then(|there| node(&there));
        Some(FileId { path, node })
    }

    /// Its path without links.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether both are one file: the same place, or the same content under two names.
    pub fn is(&self, other: &FileId) -> bool {
        self.path == other.path || (self.node.is_some() && self.node == other.node)
    }

    /// Whether an open file is this one.
    pub fn is_open_as(&self, file: &Metadata) -> bool {
        self.node.is_some() && self.node == node(file)
    }
}

/// Device and number of a file.
#[cfg(unix)]
pub(super) fn node(file: &Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((file.dev(), file.ino()))
}

#[cfg(not(unix))]
pub(super) fn node(_: &Metadata) -> Option<(u64, u64)> {
    None
}
