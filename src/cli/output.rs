//! Standard output, files, colour.

use std::fmt::Display;
use std::fs::Metadata;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::Outcome;
use super::language::spoken;
use gumption::budget::Rejection;
use gumption::fault::{Code, Said, harmless, say};
use gumption::files::write::{self, Output, Replacing};
use gumption::files::{self, FileId, Growing};
use gumption::report::Language;

/// The option by which files are replaced that others wrote.
const FORCE: &str = "--force";

/// Where the output of a command goes, and what it may replace: the same for all of them.
#[derive(Debug, clap::Args)]
pub(super) struct Target {
    /// Write to this file instead of standard output (`-`)
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace files that gumption did not write, or that were changed since; never those that the command reads
    #[arg(long)]
    force: bool,
}

/// What a command writes beside its output.
#[derive(Debug)]
pub(super) enum Beside {
    /// A file.
    File(PathBuf),
    /// A folder, and the names of its files where they are known before.
    Folder(PathBuf, &'static [&'static str]),
}

impl Target {
    /// The file; nothing for standard output, whatever it is called.
    pub fn file(&self) -> Option<&Path> {
        let path = self.output.as_deref()?;
        (path.as_os_str() != "-" && !is_standard_output(path)).then_some(path)
    }

    /// The ending of the file; nothing for standard output, a device or a pipe.
    pub fn ending(&self) -> Option<String> {
        let path = self.file()?;
        let stream = std::fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir());
        let ending = || {
            path.extension()
                .unwrap_or_default()
                .to_string_lossy()
                .to_lowercase()
        };
        (!stream).then(ending)
    }

    /// Makes sure, before any work is done, that the output and what is written beside it may be written as far as is
    /// known.
    pub fn is_allowed(&self, beside: &[Beside]) -> Result<(), Outcome> {
        let replacing = self.replacing();
        let files = beside.iter().filter_map(|one| match one {
            Beside::File(path) => Some(path.as_path()),
            Beside::Folder(..) => None,
        });
        let folders = beside.iter().map(|one| match one {
            Beside::File(_) => Ok(()),
            Beside::Folder(folder, names) => write::allowed_in(folder, names, replacing),
        });
        write::allowed(files.chain(self.file()), replacing)
            .and_then(|()| folders.collect())
            .map_err(|why| complain(why.said(Some(FORCE))))
    }

    /// Writes files, and the output among them if it is one, all of them or none; prints the output otherwise.
    pub fn write(&self, content: Vec<u8>, mut beside: Vec<Output>) -> Outcome {
        let printed = match self.file() {
            Some(path) => {
                let path = path.to_path_buf();
                beside.push(Output { path, content });
                Outcome::Done
            }
            None => print(content),
        };
        printed.max(written(&beside, self.replacing()))
    }

    /// What may be replaced.
    pub fn replacing(&self) -> Replacing {
        match self.force {
            true => Replacing::Anything,
            false => Replacing::Own,
        }
    }
}

/// Where a table goes whose lines come one after another: a file takes its place when it is whole, what is printed is printed.
pub(super) enum Sink {
    File(Box<Growing>),
    Printed,
}

/// Whether a table is being printed, of which lines are still to come.
static PRINTING: AtomicBool = AtomicBool::new(false);

/// Whether standard output holds a part of a table.
pub(super) fn is_printing() -> bool {
    PRINTING.load(Ordering::Relaxed)
}

impl Sink {
    /// Begins a table where a command is to write.
    pub fn begin(target: &Target) -> Result<Sink, Outcome> {
        let Some(path) = target.file() else {
            PRINTING.store(true, Ordering::Relaxed);
            return Ok(Sink::Printed);
        };
        match Growing::begin(path, target.replacing()) {
            Ok(file) => Ok(Sink::File(Box::new(file))),
            Err(why) => Err(complain(why.said(Some(FORCE)))),
        }
    }

    pub fn add(&mut self, bytes: &[u8]) -> Result<(), Said> {
        match self {
            Sink::File(file) => file.add(bytes).map_err(|why| why.said(Some(FORCE))),
            Sink::Printed => match print(bytes) {
                Outcome::Done => Ok(()),
                _ => Err(say!("the table is not whole")),
            },
        }
    }

    pub fn finish(self) -> Result<(), Said> {
        match self {
            Sink::File(file) => file.finish().map_err(|why| why.said(Some(FORCE))),
            Sink::Printed => {
                PRINTING.store(false, Ordering::Relaxed);
                Ok(())
            }
        }
    }
}

/// Writes files, all of them or none.
pub(super) fn written(files: &[Output], replacing: Replacing) -> Outcome {
    match write::write(files, replacing) {
        Ok(()) => Outcome::Done,
        Err(why) => complain(why.said(Some(FORCE))),
    }
}

/// Files of these names and texts in a folder, which is made if need be.
pub(super) fn in_folder(
    folder: &Path,
    files: impl IntoIterator<Item = (String, Vec<u8>)>,
) -> Result<Vec<Output>, Complaint> {
    std::fs::create_dir_all(folder)
        .map_err(|error| say!("cannot create the folder {}: {error}", folder.display()))?;
    let files = files.into_iter().map(|(name, content)| Output {
        path: folder.join(name),
        content,
    });
    Ok(files.collect())
}

/// Prints to standard output. A reader that has gone away (`gumption … | head`) is no error.
pub(super) fn print(text: impl AsRef<[u8]>) -> Outcome {
    if standard_output().is_some_and(|open| files::was_read_as(&open)) {
        return complain(say!(
            "standard output goes to a file that this command reads; nothing is printed"
        ));
    }
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            complain(say!("cannot write to standard output: {error}"))
        }
        _ => Outcome::Done,
    }
}

/// The file that standard output goes to, if the system tells.
#[cfg(unix)]
fn standard_output() -> Option<Metadata> {
    use std::os::fd::AsFd;
    let open = std::io::stdout().as_fd().try_clone_to_owned().ok()?;
    std::fs::File::from(open).metadata().ok()
}

#[cfg(not(unix))]
fn standard_output() -> Option<Metadata> {
    None
}

/// Whether a path is another name of standard output (`/dev/stdout`).
fn is_standard_output(path: &Path) -> bool {
    let file = FileId::of(path);
    file.is_some_and(|file| standard_output().is_some_and(|open| file.is_open_as(&open)))
}

/// What is wrong with an argument or a file, in words.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Complaint(Said);

impl Display for Complaint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.in_language(spoken()))
    }
}

impl std::error::Error for Complaint {}

impl<T: Into<Said>> From<T> for Complaint {
    fn from(words: T) -> Self {
        Complaint(words.into())
    }
}

/// Says on standard error what is wrong.
pub(super) fn complain(message: impl Into<Complaint>) -> Outcome {
    let error = spoken().pick("error", "错误");
    warn(&format!("{error}: {}\n", message.into()));
    Outcome::BadInput
}

/// Says why a file that is right gives no result, with the code under which `gumption explain` says more.
pub(super) fn no_result(file: impl Display, code: Option<Code>, why: &str, language: Language) {
    let error = language.pick("error", "错误");
    let code = code.map_or(String::new(), |code| format!("[{}]", code.id));
    warn(&format!("{error}{code}: {file}: {why}\n"));
}

/// Shows the faults of a file.
pub(super) fn refused(rejection: &Rejection, language: Language) -> Outcome {
    // Made harmless where it is drawn, and coloured.
    to_standard_error(&rejection.render_in(language, may_style(&std::io::stderr())));
    Outcome::BadInput
}

/// Writes to standard error what may quote names and files.
pub(super) fn warn(text: &str) {
    to_standard_error(&harmless(text));
}

/// Says on standard error what is to be known beside the output.
pub(super) fn note(text: &str, lang: Language) {
    warn(&say!("note: {text}\n").in_language(lang));
}

/// What long work will take, before it does.
pub(super) fn tell_size(readings: u64, bytes: u64, lang: Language) {
    const GIB: u64 = 1 << 30;
    /// As much as nobody notices.
    const LITTLE: u64 = GIB;
    if bytes > LITTLE {
        let size = bytes as f64 / GIB as f64;
        let told = say!("{readings} readings take about {size:.1} GiB of memory");
        warn(&format!("{}\n", told.in_language(lang)));
    }
}

/// Shows a line in the place of the last one; nothing removes it.
pub(super) fn passing(line: &str) {
    to_standard_error(&format!("\r\x1b[K{}", harmless(line)));
}

/// There is nobody to tell when this fails.
fn to_standard_error(text: &str) {
    let mut err = std::io::stderr().lock();
    let _ = err.write_all(text.as_bytes()).and_then(|()| err.flush());
}

/// Columns of a page that nobody has stated.
pub(super) const USUAL_WIDTH: usize = 100;

/// Narrower pages cannot hold a budget table.
pub(super) const NARROWEST: usize = 60;

/// Columns of the terminal that standard output goes to, if it goes to one.
pub(super) fn page_width() -> usize {
    /// Longer lines are hard to read.
    const WIDEST: usize = 120;
    let stated = std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok());
    let terminal =
        || terminal_size::terminal_size_of(std::io::stdout()).map(|(w, _)| usize::from(w.0));
    stated
        .or_else(terminal)
        .map_or(USUAL_WIDTH, |columns: usize| {
            columns.clamp(NARROWEST, WIDEST)
        })
}

/// Whether a stream may be coloured: a terminal, and the user has not said no (no-color.org).
pub(super) fn may_style(stream: &impl IsTerminal) -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|v| v == "dumb");
    stream.is_terminal() && !refused && !dumb
}
