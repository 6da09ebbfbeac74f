//! A file that is written piece by piece, of results that no memory holds.

use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::Path;
use std::sync::PoisonError;

use super::mark::{self, Digest};
use super::steps::{DISK, Draft};
use super::write::{
    Output, Planned, Replacing, Unwritten, WRITTEN, Way, discard, place, plan, unwritten,
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
    /// It has its place.
    Done,
}

impl Growing {
    /// Begins a file, if it may be written.
    ///
    /// # Errors
    /// As [`super::write::write`].
    pub fn begin(path: &Path, replacing: Replacing) -> Result<Growing, Unwritten> {
        let planned = plan(path, replacing)?;
        let goal = match planned.way {
            Way::Stream => File::options().write(true).open(path).map(Goal::Stream),
            _ => DISK
                .create(planned.folder(), planned.there.as_ref())
                .map(Goal::Draft),
        };
        Ok(Growing {
            goal: goal.map_err(|error| unwritten(path, error))?,
            planned,
            digest: Digest::default(),
        })
    }

    /// Adds to it.
    ///
    /// # Errors
    /// The system does not write.
    pub fn add(&mut self, content: &[u8]) -> Result<(), Unwritten> {
        self.digest.add(content);
        let added = match &mut self.goal {
            Goal::Draft(draft) => draft.file.write_all(content),
            Goal::Stream(stream) => match stream.write_all(content) {
                // A reader that has gone away is no error.
                Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
                other => other,
            },
            Goal::Done => Ok(()),
        };
        added.map_err(|error| unwritten(&self.planned.asked, error))
    }

    /// Puts it into its place, safe on the disk.
    ///
    /// # Errors
    /// The system does not; then the place is as it was.
    pub fn finish(mut self) -> Result<(), Unwritten> {
        let Goal::Draft(draft) = &self.goal else {
            return Ok(());
        };
        let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
        mark::set(&draft.file, &self.digest);
        let placed = draft.file.sync_all().and_then(|()| {
            // A file with several names is overwritten within, by what is in memory.
            let content = match self.planned.way {
                Way::Within => super::content_of(&draft.path)?,
                _ => Vec::new(),
            };
            let path = self.planned.asked.clone();
            place(&DISK, &self.planned, &Output { path, content }, draft)?;
            DISK.sync_folder(self.planned.folder())
        });
        placed.map_err(|error| unwritten(&self.planned.asked, error))?;
        *written += 1;
        self.goal = Goal::Done;
        Ok(())
    }
}

impl Drop for Growing {
    fn drop(&mut self) {
        if let Goal::Draft(draft) = &self.goal {
            discard(std::slice::from_ref(draft));
        }
    }
}
