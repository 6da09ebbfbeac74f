//! The files of the folder: listed, read, saved; and what was typed and is not saved yet.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde_json::{Value, json};

use gumption_format::files::write::{Output, Replacing, Unwritten, Why, write};
use gumption_format::files::{Files, Folder};
use gumption_lab::experiment::{Kind, kind_of};

/// Files that a reader finds in a list.
const MOST_FILES: usize = 2000;

/// Folders below one another that are looked into.
const DEEPEST: usize = 6;

/// Texts that are kept while they are not saved.
const MOST_DRAFTS: usize = 64;

/// Bytes of a file that is edited: more is data.
pub(crate) const MOST_TEXT: u64 = 4 << 20;

/// The folder.
#[derive(Debug)]
pub(crate) struct Shelf {
    root: PathBuf,
    drafts: Mutex<BTreeMap<String, String>>,
    /// One file is saved after the other, so that nothing comes between what is compared and what is written.
    saving: Mutex<()>,
}

/// Why a file is not saved.
#[derive(Debug)]
pub(crate) enum Unsaved {
    /// There is another content than the one that was edited, or a file where there was none.
    Conflict(Option<String>),
    /// It is no place for a file of the folder.
    Outside,
    /// It cannot be written.
    Unwritten(Unwritten),
}

impl Shelf {
    /// The files of a folder.
    pub fn new(root: PathBuf) -> Shelf {
        Shelf {
            root,
            drafts: Mutex::default(),
            saving: Mutex::default(),
        }
    }

    /// Where files are read from, with contents in place of those on the disk.
    pub fn folder<'a>(&'a self, instead: &'a [(&'a str, &'a [u8])]) -> Folder<'a> {
        Folder {
            root: &self.root,
            instead,
        }
    }

    /// The budgets and the experiments, and what may be one; the data of certificates among them.
    pub fn list(&self) -> Value {
        let mut files = Vec::new();
        self.collect(Path::new(""), 0, &mut files);
        files.sort();
        let inside = self.folder(&[]);
        let is_certificate = |file: &&String| {
            let text = Files::Folder(&inside)
                .read(Path::new(file))
                .unwrap_or_default();
            kind_of(&String::from_utf8_lossy(&text)) == Kind::Certificate
        };
        let certificates: Vec<&String> = files.iter().filter(is_certificate).collect();
        let folder = self.root.file_name().unwrap_or(self.root.as_os_str());
        json!({ "folder": folder.to_string_lossy(), "files": files, "certificates": certificates })
    }

    fn collect(&self, folder: &Path, depth: usize, files: &mut Vec<String>) {
        let Ok(entries) = std::fs::read_dir(self.root.join(folder)) else {
            return;
        };
        for entry in entries.flatten() {
            let (name, path) = (entry.file_name(), folder.join(entry.file_name()));
            let hidden = name.to_string_lossy().starts_with('.') || name == "target";
            let Ok(kind) = entry.file_type() else {
                continue;
            };
            if hidden || files.len() >= MOST_FILES {
                continue;
            }
            if kind.is_dir() && depth < DEEPEST {
                self.collect(&path, depth + 1, files);
            } else if path.extension().is_some_and(|ending| ending == "toml") {
                files.push(slashed(&path));
            }
        }
    }

    /// The text of a file, and what was typed in its place.
    ///
    /// # Errors
    /// It cannot be read, is no text, or is outside.
    pub fn open(&self, path: &str) -> Result<Value, Error> {
        let folder = self.folder(&[]);
        let bytes = Files::Folder(&folder).read(Path::new(path))?;
        if bytes.len() as u64 > MOST_TEXT {
            return Err(ErrorKind::FileTooLarge.into());
        }
        let text = String::from_utf8(bytes).map_err(|_| ErrorKind::InvalidData)?;
        let draft = self
            .drafts()
            .get(path)
            .filter(|draft| **draft != text)
            .cloned();
        Ok(json!({ "text": text, "draft": draft }))
    }

    /// Keeps what was typed, for a page that is opened again; of what is in the file, nothing.
    pub fn keep(&self, path: &str, text: &str) {
        let folder = self.folder(&[]);
        let there = Files::Folder(&folder).read(Path::new(path));
        if there.is_ok_and(|there| there == text.as_bytes()) {
            return self.forget(path);
        }
        let mut drafts = self.drafts();
        if drafts.contains_key(path) || drafts.len() < MOST_DRAFTS {
            drafts.insert(path.to_owned(), text.to_owned());
        }
    }

    /// Forgets what was typed.
    pub fn forget(&self, path: &str) {
        self.drafts().remove(path);
    }

    fn drafts(&self) -> MutexGuard<'_, BTreeMap<String, String>> {
        self.drafts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Saves a text in place of the one that was edited; `None` is a file that did not exist.
    ///
    /// # Errors
    /// Somebody has changed the file, it is outside, or the system does not write it.
    pub fn save(&self, path: &str, text: &str, base: Option<&str>) -> Result<(), Unsaved> {
        let _saving = self.saving.lock().unwrap_or_else(PoisonError::into_inner);
        let place = self.place(path).ok_or(Unsaved::Outside)?;
        let folder = self.folder(&[]);
        let there = match Files::Folder(&folder).read(Path::new(path)) {
            Ok(bytes) => Some(bytes),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => {
                return Err(Unsaved::Unwritten(Unwritten {
                    path: path.into(),
                    why: Why::System(error),
                }));
            }
        };
        if there.as_deref() != base.map(str::as_bytes) {
            let there = there.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
            return Err(Unsaved::Conflict(there));
        }
        let replacing = match base {
            Some(_) => Replacing::Anything,
            None => Replacing::Nothing,
        };
        let output = Output {
            path: place,
            content: text.as_bytes().to_vec(),
        };
        write(&[output], replacing).map_err(|unwritten| match unwritten.why {
            Why::Exists => Unsaved::Conflict(None),
            _ => Unsaved::Unwritten(unwritten),
        })?;
        self.forget(path);
        Ok(())
    }

    /// Where a file of this name is, or would be: names without `..`, and no link that leads outside.
    fn place(&self, path: &str) -> Option<PathBuf> {
        let path = Path::new(path);
        let named = |part: Component<'_>| matches!(part, Component::Normal(_));
        let text = path.extension().is_some_and(|ending| ending == "toml");
        if !text || !path.components().all(named) {
            return None;
        }
        let place = self.root.join(path);
        let folder = std::fs::canonicalize(place.parent()?).ok()?;
        // A link may lead to what is there or to what is not.
        let is_link = std::fs::symlink_metadata(&place).is_ok_and(|there| there.is_symlink());
        let place = match is_link {
            true => std::fs::canonicalize(&place).ok()?,
            false => folder.join(place.file_name()?),
        };
        place.starts_with(&self.root).then_some(place)
    }
}

fn slashed(path: &Path) -> String {
    let parts = path
        .components()
        .map(|part| part.as_os_str().to_string_lossy());
    parts.collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    /// A shelf of the test's own, with its folder.
    fn shelf() -> (TempDir, Shelf) {
        let folder = tempfile::tempdir().expect("a folder");
        let root = std::fs::canonicalize(&folder).expect("a folder");
        (folder, Shelf::new(root))
    }

    #[test]
    fn only_what_was_seen_is_replaced() {
        let (_folder, shelf) = shelf();
        assert!(shelf.save("a.toml", "one", None).is_ok());
        assert!(matches!(
            shelf.save("a.toml", "two", None),
            Err(Unsaved::Conflict(Some(_)))
        ));
        assert!(matches!(
            shelf.save("a.toml", "two", Some("zero")),
            Err(Unsaved::Conflict(_))
        ));
        assert!(shelf.save("a.toml", "two", Some("one")).is_ok());
        assert_eq!(shelf.open("a.toml").expect("a text")["text"], "two");
        assert!(matches!(
            shelf.save("gone.toml", "x", Some("y")),
            Err(Unsaved::Conflict(None))
        ));
        assert_eq!(shelf.list()["files"], json!(["a.toml"]));
    }

    #[test]
    fn nothing_is_saved_outside() {
        let (_folder, shelf) = shelf();
        for path in [
            "../a.toml",
            "/tmp/a.toml",
            "x/../../a.toml",
            "a.sh",
            "none/a.toml",
            "",
        ] {
            assert!(
                matches!(shelf.save(path, "", None), Err(Unsaved::Outside)),
                "{path}"
            );
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("/tmp/elsewhere.toml", shelf.root.join("l.toml"))
                .expect("a link");
            assert!(matches!(
                shelf.save("l.toml", "", None),
                Err(Unsaved::Outside)
            ));
        }
    }

    #[test]
    fn what_was_typed_is_kept() {
        let (_folder, shelf) = shelf();
        shelf.save("a.toml", "one", None).expect("saved");
        shelf.keep("a.toml", "on");
        assert_eq!(shelf.open("a.toml").expect("a text")["draft"], "on");
        shelf.keep("a.toml", "one");
        assert!(shelf.open("a.toml").expect("a text")["draft"].is_null());
    }
}
