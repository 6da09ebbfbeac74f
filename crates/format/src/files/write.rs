//! Files replaced as a whole, all of them or none.
//!
//! A file is written beside the one whose place it takes and is safe on the disk before it does: readers, and a
//! computer that goes down, see the old content or the new one. What may be replaced is decided here, once:
//!
//! - nothing that the command has read ([`super::remember_reads`], [`unread`]), whatever it is called and whatever is asked
//!   for;
//! - otherwise a file that this program wrote and that nobody has changed since (its digest is kept as an attribute
//!   of the file), or what the caller allows.
//!
//! Permissions and links are kept: a link stays a link to the file with the new content. A file with several names
//! (hard links) is overwritten within, as a replacement would part them; only then a program that is killed leaves
//! half a file, and the whole new content beside it, as `.NAME.gumption-new`. The drafts of killed programs are removed
//! by the next one that writes into their folder.

use std::fs::Metadata;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use gumption_fault::{Said, of_system, say};

use super::ledger::{Ledger, was_read};
use super::mark;
use super::steps::{Author, DISK, Disk, Draft, sweep};

/// A file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// Where, as the user says it.
    pub path: PathBuf,
    /// What.
    pub content: Vec<u8>,
}

/// What may be replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Replacing {
    /// Nothing.
    Nothing,
    /// What this program wrote and nobody changed.
    Own,
    /// Every file that was not read.
    Anything,
}

/// A file that is not written, and why. Nothing else was written then.
#[derive(Debug)]
pub struct Unwritten {
    /// Where, as the user says it.
    pub path: PathBuf,
    /// Why.
    pub why: Why,
}

/// Why a file is not written.
#[derive(Debug)]
pub enum Why {
    /// The command reads it.
    Read,
    /// There is one, and nothing is to be replaced.
    Exists,
    /// There is one that somebody else wrote, or has changed.
    NotOurs,
    /// There is one that is protected against writing.
    Protected,
    /// It is a folder.
    Folder,
    /// It is a file, and should be a folder.
    NoFolder,
    /// Two outputs are to be this file.
    Twice,
    /// The system does not.
    System(io::Error),
}

/// Number of files written, and the right to write them.
pub(super) static WRITTEN: Mutex<usize> = Mutex::new(0);

/// Writes files, all of them or none; then to what is no file and cannot be replaced (a terminal, a pipe, `/dev/null`).
///
/// # Errors
/// The first that cannot be written.
pub fn write(outputs: &[Output], replacing: Replacing) -> Result<(), Unwritten> {
    write_by(&DISK, outputs, replacing)
}

/// Refuses a file that was read.
///
/// # Errors
/// It is in the ledger.
pub fn unread(path: &Path, read: &Ledger) -> Result<(), Unwritten> {
    let (path, why) = (path.to_path_buf(), Why::Read);
    match read.has(&path) {
        true => Err(Unwritten { path, why }),
        false => Ok(()),
    }
}

/// Whether files could be written as far as is known before there is anything to write: long work is not lost over it.
///
/// # Errors
/// The first that cannot be written.
pub fn allowed<'a>(
    paths: impl IntoIterator<Item = &'a Path>,
    replacing: Replacing,
) -> Result<(), Unwritten> {
    let planned = paths.into_iter().map(|path| plan(path, replacing));
    let planned = planned.collect::<Result<Vec<_>, _>>()?;
    distinct(&planned)?;
    let files = planned.iter().filter(|one| one.way != Way::Stream);
    for file in files {
        takes_files(file.folder()).map_err(|error| unwritten(&file.asked, error))?;
    }
    Ok(())
}

/// The same for files of these names in a folder, which is made if need be.
///
/// # Errors
/// The first that cannot be written, or the folder.
pub fn allowed_in(folder: &Path, names: &[&str], replacing: Replacing) -> Result<(), Unwritten> {
    let refused = |why| Unwritten {
        path: folder.to_path_buf(),
        why,
    };
    match std::fs::metadata(folder) {
        Ok(there) if !there.is_dir() => Err(refused(Why::NoFolder)),
        Ok(_) if names.is_empty() => {
            takes_files(folder).map_err(|error| refused(Why::System(error)))
        }
        Ok(_) => {
            let paths: Vec<PathBuf> = names.iter().map(|name| folder.join(name)).collect();
            allowed(paths.iter().map(PathBuf::as_path), replacing)
        }
        Err(error) if error.kind() == ErrorKind::NotFound => {
            match folder.parent().map(here).filter(|above| *above != folder) {
                Some(above) => allowed_in(above, &[], replacing),
                None => Err(refused(Why::System(error))),
            }
        }
        Err(error) => Err(refused(Why::System(error))),
    }
}

/// Whether a file can be made in a folder: what permissions, quotas and mounts say together, only the system knows.
fn takes_files(folder: &Path) -> io::Result<()> {
    // An interrupt waits until it is removed.
    let _undisturbed = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    let draft = DISK.create(folder, None)?;
    discard(&[draft]);
    Ok(())
}

/// Drafts of files that still grow.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

pub(super) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for files that are being written, removes what there is of those that still grow, and lets none be written
/// from now on; how many there were.
pub fn stop() -> usize {
    let written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    let count = *written;
    let mut unfinished = unfinished();
    for path in unfinished.drain(..) {
        let _ = std::fs::remove_file(path);
    }
    // Kept until the process ends.
    std::mem::forget((written, unfinished));
    count
}

pub(super) fn write_by(
    disk: &Disk<'_>,
    outputs: &[Output],
    replacing: Replacing,
) -> Result<(), Unwritten> {
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    outputs.iter().for_each(|output| cleared(&output.path));
    let mut planned = Vec::new();
    for output in outputs {
        planned.push(plan(&output.path, replacing)?);
    }
    distinct(&planned)?;
    let all: Vec<(&Planned, &Output)> = planned.iter().zip(outputs).collect();
    let (streams, files): (Vec<_>, Vec<_>) = all
        .into_iter()
        .partition(|(planned, _)| planned.way == Way::Stream);
    let drafts = drafts(disk, &files)?;
    placed(disk, &files, &drafts)?;
    *written += files.len();
    drop(written);
    for (_, output) in streams {
        write_to(&output.path, &output.content).map_err(|error| unwritten(&output.path, error))?;
    }
    Ok(())
}

/// Removes what killed programs have left where an output goes.
pub(super) fn cleared(path: &Path) {
    if let Some(folder) = followed(path).ok().as_deref().and_then(Path::parent) {
        sweep(here(folder));
    }
}

/// Where an output goes, and how.
pub(super) struct Planned {
    pub asked: PathBuf,
    place: PathBuf,
    pub way: Way,
    /// What is there.
    pub there: Option<Metadata>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// There is none yet.
    New,
    /// The name goes from one file to another.
    Replaced,
    /// The file has other names, which it keeps.
    Within,
    /// It is no file.
    Stream,
}

impl Planned {
    pub fn folder(&self) -> &Path {
        here(self.place.parent().unwrap_or_else(|| Path::new("")))
    }

    /// Where the new content of a file with several names waits until it is whole.
    fn waiting(&self) -> PathBuf {
        let name = self.place.file_name().unwrap_or_default().to_string_lossy();
        self.folder().join(format!(".{name}.gumption-new"))
    }
}

pub(super) fn plan(path: &Path, replacing: Replacing) -> Result<Planned, Unwritten> {
    let refused = |why| Unwritten {
        path: path.to_path_buf(),
        why,
    };
    let place = followed(path).map_err(|error| refused(Why::System(error)))?;
    let there = match std::fs::metadata(&place) {
        Ok(there) => Some(there),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(refused(Why::System(error))),
    };
    let way = match &there {
        None => Way::New,
        Some(there) if there.is_dir() => return Err(refused(Why::Folder)),
        Some(there) if !there.is_file() => Way::Stream,
        Some(_) if was_read(&place) => return Err(refused(Why::Read)),
        Some(_) if replacing == Replacing::Nothing => return Err(refused(Why::Exists)),
        Some(there) if replacing == Replacing::Own && there.permissions().readonly() => {
            return Err(refused(Why::Protected));
        }
        Some(_) if replacing == Replacing::Own && !mark::is_ours(&place) => {
            return Err(refused(Why::NotOurs));
        }
        Some(there) if names(there) > 1 => Way::Within,
        Some(_) => Way::Replaced,
    };
    let planned = Planned {
        asked: path.to_path_buf(),
        place,
        way,
        there,
    };
    match std::fs::metadata(planned.folder()) {
        Err(error) => Err(refused(Why::System(error))),
        Ok(_) => Ok(planned),
    }
}

/// Whether no two outputs are one file.
fn distinct(planned: &[Planned]) -> Result<(), Unwritten> {
    let full = |planned: &Planned| {
        let folder = std::fs::canonicalize(planned.folder()).ok();
        (folder, planned.place.file_name().map(ToOwned::to_owned))
    };
    let same = |a: &Planned, b: &Planned| {
        let node = |planned: &Planned| planned.there.as_ref().and_then(super::identity::node);
        full(a) == full(b) || (node(a).is_some() && node(a) == node(b))
    };
    for (index, one) in planned.iter().enumerate() {
        let is_file = one.way != Way::Stream;
        if is_file && planned[..index].iter().any(|other| same(one, other)) {
            let path = one.asked.clone();
            return Err(Unwritten {
                path,
                why: Why::Twice,
            });
        }
    }
    Ok(())
}

/// Writes every file beside its place; removes all of them if one cannot be written.
fn drafts(disk: &Disk<'_>, files: &[(&Planned, &Output)]) -> Result<Vec<Draft>, Unwritten> {
    let mut drafts: Vec<Draft> = Vec::new();
    for (planned, output) in files {
        let draft = disk.create(planned.folder(), planned.there.as_ref());
        let filled = draft.and_then(|mut draft| {
            let filled = disk.fill(&mut draft, &output.content);
            drafts.push(draft);
            filled
        });
        if let Err(error) = filled {
            discard(&drafts);
            return Err(unwritten(&output.path, error));
        }
    }
    Ok(drafts)
}

/// Puts the drafts into their places; if one cannot be put there, everything is as it was.
pub(super) fn placed(
    disk: &Disk<'_>,
    files: &[(&Planned, &Output)],
    drafts: &[Draft],
) -> Result<(), Unwritten> {
    let mut done: Vec<(&Planned, Option<Vec<u8>>)> = Vec::new();
    let mut place_all = || {
        for ((planned, output), draft) in files.iter().zip(drafts) {
            let fail = |error| unwritten(&output.path, error);
            // What it was, for the case that another one cannot be placed.
            let alone = files.len() == 1 && planned.way != Way::Within;
            let old = match planned.way {
                Way::Replaced | Way::Within if !alone => {
                    Some(super::content_of(&planned.place).map_err(fail)?)
                }
                _ => None,
            };
            if planned.way == Way::Within {
                done.push((planned, old));
                place(disk, planned, output, draft).map_err(fail)?;
            } else {
                place(disk, planned, output, draft).map_err(fail)?;
                done.push((planned, old));
            }
        }
        let folders = files.iter().map(|(planned, _)| planned);
        for planned in folders {
            disk.sync_folder(planned.folder())
                .map_err(|error| unwritten(&planned.asked, error))?;
        }
        Ok(())
    };
    let result = place_all();
    if result.is_err() {
        discard(drafts);
        done.iter()
            .rev()
            .for_each(|(planned, old)| undo(planned, old.as_deref()));
    }
    result
}

fn place(disk: &Disk<'_>, planned: &Planned, output: &Output, draft: &Draft) -> io::Result<()> {
    match planned.way {
        Way::New => disk.place_new(draft, &planned.place),
        Way::Replaced => disk.rename(&draft.path, &planned.place),
        Way::Within => {
            let waiting = planned.waiting();
            disk.rename(&draft.path, &waiting)?;
            disk.overwrite(&planned.place, &output.content)?;
            disk.remove(&waiting);
            Ok(())
        }
        Way::Stream => Ok(()),
    }
}

/// Gives a place its old content, as far as the system still lets it.
fn undo(planned: &Planned, old: Option<&[u8]>) {
    let disk = Disk {
        author: Author::Somebody,
        ..DISK
    };
    let restored = match (planned.way, old) {
        (Way::New, _) => std::fs::remove_file(&planned.place),
        (Way::Within, Some(old)) => {
            let restored = disk.overwrite(&planned.place, old);
            restored.and_then(|()| std::fs::remove_file(planned.waiting()))
        }
        (Way::Replaced, Some(old)) => {
            let draft = disk.create(planned.folder(), planned.there.as_ref());
            draft.and_then(|mut draft| {
                disk.fill(&mut draft, old)?;
                disk.rename(&draft.path, &planned.place)
            })
        }
        _ => Ok(()),
    };
    // The failure that led here is the one that is told.
    drop(restored);
}

pub(super) fn discard(drafts: &[Draft]) {
    for draft in drafts {
        let _ = std::fs::remove_file(&draft.path);
    }
}

/// Writes to something that is no file. A reader that has gone away is no error.
fn write_to(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut stream = std::fs::File::options().write(true).open(path)?;
    match stream.write_all(content) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Where a path leads if it is a link, also to nothing yet: the file is replaced, not the link.
fn followed(path: &Path) -> io::Result<PathBuf> {
    /// As many as Linux follows.
    const MOST: usize = 40;
    let mut place = path.to_path_buf();
    for _ in 0..MOST {
        match std::fs::read_link(&place) {
            Ok(target) => {
                let folder = place.parent().unwrap_or_else(|| Path::new(""));
                place = folder.join(target);
            }
            Err(_) => return Ok(place),
        }
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "too many links"))
}

fn here(folder: &Path) -> &Path {
    match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    }
}

pub(super) fn unwritten(path: &Path, error: io::Error) -> Unwritten {
    let why = match error.kind() {
        ErrorKind::AlreadyExists => Why::Exists,
        _ => Why::System(error),
    };
    Unwritten {
        path: path.to_path_buf(),
        why,
    }
}

#[cfg(unix)]
fn names(file: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(file)
}

#[cfg(not(unix))]
fn names(_: &Metadata) -> u64 {
    1
}

impl Unwritten {
    /// What the user is told; `force` is how files are replaced all the same where this is said, if they can be.
    pub fn said(&self, force: Option<&str>) -> Said {
        let path = self.path.display();
        let or = force.map_or_else(Said::default, |force| say!(", or {force} to replace it"));
        match &self.why {
            Why::Read => say!(
                "{path} is read by this command and is never overwritten; give another name for what is written"
            ),
            Why::Exists => say!("{path} exists already and is left as it is; give another name"),
            Why::NotOurs => {
                say!("{path} exists, and is not as gumption wrote it; give another name{or}")
            }
            Why::Protected => say!("{path} is protected against writing; give another name{or}"),
            Why::Folder => say!("{path} is a folder; name a file in it"),
            Why::NoFolder => say!("{path} is a file; name a folder"),
            Why::Twice => say!("{path} is to be written twice; give two names"),
            Why::System(error) => say!("cannot write {path}: {}", of_system(error)),
        }
    }
}
