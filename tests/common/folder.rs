//! Folders for files that a test writes.

use std::ops::Deref;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// An empty folder of the test's own, removed with all that is in it when this goes.
pub struct Folder(TempDir);

/// Its name begins with this one.
pub fn folder(name: &str) -> Folder {
    let prefix = format!("gumption-{name}-");
    Folder(TempDir::with_prefix(prefix).expect("a temporary folder"))
}

impl Folder {
    /// Writes a file.
    pub fn put(&self, name: impl AsRef<Path>, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.join(name);
        std::fs::write(&path, content).expect("a temporary file");
        path
    }

    /// Reads a file.
    pub fn text(&self, name: impl AsRef<Path>) -> String {
        std::fs::read_to_string(self.join(name)).expect("a temporary file")
    }
}

impl Deref for Folder {
    type Target = Path;

    fn deref(&self) -> &Path {
        self.0.path()
    }
}

impl AsRef<Path> for Folder {
    fn as_ref(&self) -> &Path {
        self
    }
}
