//! The operations of the file system that writing takes, one by one. Each may fail, and the program may be killed
//! between any two of them: tests do both, at every one.

use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Result, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::identity::node;
use super::mark;

/// An operation of the file system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    Create,
    Add,
    FirstHalf,
    SecondHalf,
    Sync,
    Place,
    Overwrite,
    Remove,
    SyncFolder,
}

/// The file system, with something that happens before each step.
pub(super) struct Disk<'a> {
    pub before: &'a dyn Fn(Step) -> Result<()>,
    /// Whether what is written is this program's, or a restored file of somebody.
    pub author: Author,
}

/// Who wrote the content of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Author {
    Ours,
    Somebody,
}

/// The file system as it is.
pub(super) const DISK: Disk<'static> = Disk {
    before: &|_| Ok(()),
    author: Author::Ours,
};

/// A file that is written beside the one whose place it is to take, and is locked as long as somebody writes it.
pub(super) struct Draft {
    pub path: PathBuf,
    pub file: File,
}

/// How the names of drafts begin and end.
const DRAFT: [&str; 2] = [".gumption-", ".tmp"];

impl Disk<'_> {
    /// A draft in a folder, with the permissions and, where that is allowed, the owner of the file that it will
    /// replace.
    pub fn create(&self, folder: &Path, like: Option<&Metadata>) -> Result<Draft> {
        /// Tells drafts of one process apart.
        static COUNT: AtomicU64 = AtomicU64::new(0);
        (self.before)(Step::Create)?;
        loop {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let [begin, end] = DRAFT;
            let path = folder.join(format!("{begin}{}-{count}{end}", std::process::id()));
            let file = match File::create_new(&path) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
                other => other?,
            };
            // Another process may take it for a leftover before it is locked. Where there are no locks, nothing is
            // taken for a leftover.
            let taken = matches!(file.try_lock(), Err(std::fs::TryLockError::WouldBlock));
            let there = std::fs::metadata(&path).ok();
            if taken
                || there
                    .is_none_or(|there| file.metadata().is_ok_and(|own| node(&own) != node(&there)))
            {
                continue;
            }
            let draft = Draft { path, file };
            if let Some(like) = like {
                draft.file.set_permissions(like.permissions())?;
                keep_owner(&draft.file, like);
            }
            return Ok(draft);
        }
    }

    /// Writes a draft and waits until it is safe.
    pub fn fill(&self, draft: &mut Draft, content: &[u8]) -> Result<()> {
        self.write(&mut draft.file, content)
    }

    /// Writes a file from its beginning and waits until it is safe.
    fn write(&self, file: &mut File, content: &[u8]) -> Result<()> {
        let (first, second) = content.split_at(content.len() / 2);
        (self.before)(Step::FirstHalf)?;
        file.write_all(first)?;
        (self.before)(Step::SecondHalf)?;
        file.write_all(second)?;
        file.set_len(content.len() as u64)?;
        match self.author {
            Author::Ours => mark::set(file, &mark::Digest::of(content)),
            Author::Somebody => mark::clear(file),
        }
        (self.before)(Step::Sync)?;
        file.sync_all()
    }

    /// Adds to a draft whose whole content nobody has in memory.
    pub fn add(&self, draft: &mut Draft, content: &[u8]) -> Result<()> {
        (self.before)(Step::Add)?;
        draft.file.write_all(content)
    }

    /// Marks a draft that is whole, and waits until it is safe.
    pub fn end(&self, draft: &Draft, digest: &mark::Digest) -> Result<()> {
        mark::set(&draft.file, digest);
        (self.before)(Step::Sync)?;
        draft.file.sync_all()
    }

    /// Gives a draft its name, which nobody has.
    pub fn place_new(&self, draft: &Draft, place: &Path) -> Result<()> {
        (self.before)(Step::Place)?;
        match std::fs::hard_link(&draft.path, place) {
            Ok(()) => {
                self.remove(&draft.path);
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(error),
            // A file system without hard links.
            Err(_) if std::fs::symlink_metadata(place).is_ok() => {
                Err(Error::from(ErrorKind::AlreadyExists))
            }
            Err(_) => std::fs::rename(&draft.path, place),
        }
    }

    /// Gives a file another name, whoever has it.
    pub fn rename(&self, from: &Path, to: &Path) -> Result<()> {
        (self.before)(Step::Place)?;
        std::fs::rename(from, to)
    }

    /// Overwrites a file within, so that all of its names keep it; one writer after the other.
    pub fn overwrite(&self, place: &Path, content: &[u8]) -> Result<()> {
        (self.before)(Step::Overwrite)?;
        let mut file = File::options().write(true).open(place)?;
        // Where there are no locks, two writers at once are not told apart.
        let _ = file.lock();
        file.seek(SeekFrom::Start(0))?;
        self.write(&mut file, content)
    }

    /// Removes what has served; if that fails, the next run does it.
    pub fn remove(&self, path: &Path) {
        let _ = (self.before)(Step::Remove).and_then(|()| std::fs::remove_file(path));
    }

    /// Waits until the names in a folder are safe; not every system can.
    pub fn sync_folder(&self, folder: &Path) -> Result<()> {
        (self.before)(Step::SyncFolder)?;
        if let Ok(folder) = File::open(folder) {
            let _ = folder.sync_all();
        }
        Ok(())
    }
}

/// Removes the drafts in a folder whose writers were killed: those that nobody has locked.
pub(super) fn sweep(folder: &Path) {
    let [begin, end] = DRAFT;
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !(is_file && name.starts_with(begin) && name.ends_with(end)) {
            continue;
        }
        let path = entry.path();
        if File::open(&path).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = std::fs::remove_file(path);
        }
    }
}

#[cfg(unix)]
fn keep_owner(file: &File, like: &Metadata) {
    use std::os::unix::fs::{MetadataExt, fchown};
    let _ = fchown(file, Some(like.uid()), Some(like.gid()));
}

#[cfg(not(unix))]
fn keep_owner(_: &File, _: &Metadata) {}
