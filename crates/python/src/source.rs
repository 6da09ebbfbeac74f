//! Where the files of a call are.

use std::path::{Path, PathBuf};

use gumption_format::files::Files;
use pyo3::prelude::*;

/// A file and those that it names: on the disk, or all of them in memory.
#[derive(FromPyObject)]
pub(crate) struct Source {
    #[pyo3(item)]
    path: PathBuf,
    #[pyo3(item)]
    files: Option<Vec<(String, Vec<u8>)>>,
}

impl Source {
    /// Its name, as messages call it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Hands the files to a reader.
    pub fn with<T>(&self, read: impl FnOnce(Files<'_>, &Path) -> T) -> T {
        match &self.files {
            None => read(Files::Disk, &self.path),
            Some(files) => {
                let library: Vec<(&str, &[u8])> = files
                    .iter()
                    .map(|(name, content)| (name.as_str(), content.as_slice()))
                    .collect();
                read(Files::Library(&library), &self.path)
            }
        }
    }
}
