//! Standard output, files, colour.

use std::fmt::Display;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

use gumption::budget::Rejection;
use gumption::fault::Code;
use gumption::report::Language;

use super::Outcome;

/// Prints to standard output. A reader that has gone away (`gumption … | head`) is no error.
pub(super) fn print(text: impl AsRef<[u8]>) -> Outcome {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            complain(format!("cannot write to standard output: {error}"))
        }
        _ => Outcome::Done,
    }
}

/// What is wrong with an argument or a file, in words.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Complaint(String);

impl Display for Complaint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Complaint {}

impl<T: Into<String>> From<T> for Complaint {
    fn from(words: T) -> Self {
        Complaint(words.into())
    }
}

/// Says on standard error what is wrong.
pub(super) fn complain(message: impl Display) -> Outcome {
    warn(&format!("error: {message}\n"));
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
    warn(&rejection.render_in(language, may_style(&std::io::stderr())));
    Outcome::BadInput
}

/// Writes to standard error; there is nobody to tell when that fails.
pub(super) fn warn(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Replaces a file as a whole: readers see the old content or the new one, never half of it.
pub(super) fn replace(path: &Path, content: impl AsRef<[u8]>) -> Outcome {
    replace_all(&[(path.to_path_buf(), content)])
}

/// Replaces several files, all of them or, where one cannot be written, none. What is there and is no
/// file (a device, a pipe) cannot be replaced, and is written to after the files are safe.
pub(super) fn replace_all<T: AsRef<[u8]>>(files: &[(PathBuf, T)]) -> Outcome {
    let (streams, files): (Vec<_>, Vec<_>) = files.iter().partition(|(path, _)| is_stream(path));
    let places: Vec<PathBuf> = files.iter().map(|(path, _)| place(path)).collect();
    let beside: Vec<PathBuf> = places.iter().map(|path| beside(path)).collect();
    let write_all = || {
        for ((path, text), beside) in files.iter().zip(&beside) {
            std::fs::write(beside, text).map_err(|error| (path, error))?;
        }
        for (path, text) in &streams {
            std::fs::write(path, text).map_err(|error| (path, error))?;
        }
        for ((path, _), (beside, place)) in files.iter().zip(beside.iter().zip(&places)) {
            std::fs::rename(beside, place).map_err(|error| (path, error))?;
        }
        Ok(())
    };
    match write_all() {
        Ok(()) => Outcome::Done,
        Err((path, error)) => {
            for path in &beside {
                let _ = std::fs::remove_file(path);
            }
            complain(format!("cannot write {}: {error}", path.display()))
        }
    }
}

/// Whether a path leads to something that is written to and not replaced: `/dev/null`, `/dev/stdout`, a pipe.
fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Where a file is, if the path is a link to it: the file is replaced, not the link.
fn place(path: &Path) -> PathBuf {
    let is_link = std::fs::symlink_metadata(path).is_ok_and(|there| there.is_symlink());
    let target = is_link.then(|| std::fs::canonicalize(path).ok()).flatten();
    target.unwrap_or_else(|| path.to_path_buf())
}

/// Where a file is written before it takes its place.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.tmp", std::process::id()));
    path.with_file_name(name)
}

/// Writes a file that must not exist yet; one that cannot be completed is removed again.
pub(super) fn create(path: &Path, text: &str) -> Outcome {
    let mut file = match std::fs::File::create_new(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            return complain(format!(
                "{} exists already and is left as it is; give another name, or `-` to print the template",
                path.display()
            ));
        }
        Err(error) => return complain(format!("cannot create {}: {error}", path.display())),
    };
    match file.write_all(text.as_bytes()) {
        Ok(()) => Outcome::Done,
        Err(error) => {
            let _ = std::fs::remove_file(path);
            complain(format!("cannot write {}: {error}", path.display()))
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_existing_file_is_left_alone() {
        let path =
            std::env::temp_dir().join(format!("gumption-create-{}.toml", std::process::id()));
        let _ = std::fs::remove_file(&path);
        assert_eq!(create(&path, "first"), Outcome::Done);
        assert_eq!(create(&path, "second"), Outcome::BadInput);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "first");
        assert_eq!(replace(&path, "third"), Outcome::Done);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "third");
        std::fs::remove_file(&path).unwrap();
    }

    /// A link stays a link, to a file with the new content; a pipe stays a pipe, and gets the text.
    #[cfg(unix)]
    #[test]
    fn what_is_no_plain_file_is_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        let folder = std::env::temp_dir().join(format!("gumption-links-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let (file, link, pipe) = (
            folder.join("file"),
            folder.join("link"),
            folder.join("pipe"),
        );
        std::fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        assert_eq!(replace(&link, "new"), Outcome::Done);
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "new");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        if made.is_ok_and(|status| status.success()) {
            let reader = std::thread::spawn({
                let pipe = pipe.clone();
                move || std::fs::read_to_string(pipe).unwrap()
            });
            assert_eq!(replace(&pipe, "text"), Outcome::Done);
            assert_eq!(reader.join().unwrap(), "text");
            let there = std::fs::symlink_metadata(&pipe).unwrap();
            assert!(there.file_type().is_fifo());
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_directory_that_does_not_exist_is_named() {
        assert_eq!(
            replace(Path::new("/nowhere/at/all.txt"), ""),
            Outcome::BadInput
        );
    }
}
