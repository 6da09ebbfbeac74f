//! A file that is written piece by piece, of results that no memory holds.

use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::Path;
use std::sync::PoisonError;

use super::mark::Digest;
use super::steps::{DISK, Disk, Draft};
use super::write::{
    Output, Planned, Replacing, Unwritten, WRITTEN, Way, cleared, discard, placed, plan,
    unfinished, unwritten,
};

/// A file that grows beside its place, and takes it when it is [finished](Growing::finish); whatever ends before leaves the
/// place as it was.
pub struct Growing {
    planned: Planned,
    goal: Goal,
    digest: Digest,
}

enum Goal {
    /// A draft that is to take the place.
    Draft(Draft),
    /// What is no file: a terminal, a pipe.
    Stream(File),
}

impl Growing {
    /// Begins a file, if it may be written.
    ///
    /// # Errors
    /// As [`super::write::write`].
    pub fn begin(path: &Path, replacing: Replacing) -> Result<Growing, Unwritten> {
        Growing::begin_by(&DISK, path, replacing)
    }

    pub(super) fn begin_by(
        disk: &Disk<'_>,
        path: &Path,
        replacing: Replacing,
    ) -> Result<Growing, Unwritten> {
        cleared(path);
        let planned = plan(path, replacing)?;
        // No interrupt comes between a draft and its place in the list.
        let mut unfinished = unfinished();
        let goal = match planned.way {
            Way::Stream => File::options().write(true).open(path).map(Goal::Stream),
            _ => disk
                .create(planned.folder(), planned.there.as_ref())
                .map(Goal::Draft),
        };
        let goal = goal.map_err(|error| unwritten(path, error))?;
        if let Goal::Draft(draft) = &goal {
            unfinished.push(draft.path.clone());
        }
        Ok(Growing {
            goal,
            planned,
            digest: Digest::default(),
        })
    }

    /// Adds to it.
    ///
    /// # Errors
    /// The system does not write.
    pub fn add(&mut self, content: &[u8]) -> Result<(), Unwritten> {
        self.add_by(&DISK, content)
    }

    pub(super) fn add_by(&mut self, disk: &Disk<'_>, content: &[u8]) -> Result<(), Unwritten> {
        self.digest.add(content);
        let added = match &mut self.goal {
            Goal::Draft(draft) => disk.add(draft, content),
            Goal::Stream(stream) => match stream.write_all(content) {
                // A reader that has gone away is no error.
                Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
                other => other,
            },
        };
        added.map_err(|error| unwritten(&self.planned.asked, error))
    }

    /// Puts it into its place, safe on the disk.
    ///
    /// # Errors
    /// The system does not; then the place is as it was.
    pub fn finish(self) -> Result<(), Unwritten> {
        self.finish_by(&DISK)
    }

    pub(super) fn finish_by(self, disk: &Disk<'_>) -> Result<(), Unwritten> {
        let Goal::Draft(draft) = &self.goal else {
            return Ok(());
        };
        let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
        let path = self.planned.asked.clone();
        let safe = disk.end(draft, &self.digest).and_then(|()| {
            // A file with several names is overwritten within, by what is in memory.
            match self.planned.way {
                Way::Within => super::content_of(&draft.path),
                _ => Ok(Vec::new()),
            }
        });
        let content = safe.map_err(|error| unwritten(&path, error))?;
        let output = Output { path, content };
        placed(
            disk,
            &[(&self.planned, &output)],
            std::slice::from_ref(draft),
        )?;
        *written += 1;
        Ok(())
    }
}

impl Drop for Growing {
    fn drop(&mut self) {
        if let Goal::Draft(draft) = &self.goal {
            discard(std::slice::from_ref(draft));
            unfinished().retain(|path| *path != draft.path);
        }
    }
}
