//! Writing under every fault: at each step the disk is full or the program is killed.

use std::cell::Cell;
use std::io::{Error, ErrorKind};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::Growing;
use super::mark;
use super::steps::{Author, DISK, Disk, Step};
use super::write::{Output, Replacing, Unwritten, Why, write, write_by};

/// A folder of its own, removed afterwards.
struct Folder(TempDir);

impl Folder {
    fn new(name: &str) -> Folder {
        let prefix = format!("gumption-{name}-");
        Folder(TempDir::with_prefix(prefix).expect("a folder"))
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn put(&self, name: &str, text: &str) -> PathBuf {
        std::fs::write(self.at(name), text).expect("a file");
        self.at(name)
    }

    fn text(&self, name: &str) -> Option<String> {
        std::fs::read_to_string(self.at(name)).ok()
    }

    /// What this module puts beside files.
    fn leftovers(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("a folder").flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.filter(|name| name.contains(".gumption-")).collect()
    }
}

fn output(path: impl AsRef<Path>, text: &str) -> Output {
    Output {
        path: path.as_ref().to_path_buf(),
        content: text.as_bytes().to_vec(),
    }
}

fn why(result: Result<(), Unwritten>) -> Why {
    result.expect_err("a refusal").why
}

/// Marks need attributes of files, which not every file system has.
fn are_marks_kept(folder: &Folder) -> bool {
    write(&[output(folder.at("probe"), "x")], Replacing::Nothing).expect("written");
    let kept = mark::is_ours(&folder.at("probe"));
    if !kept {
        eprintln!("skipped: this file system keeps no attributes");
    }
    kept
}

const OLD: &str = "the old content, which is somewhat longer than the new one\n";
const NEW: &str = "the new content\n";

/// A new file, one that is replaced, and one that has two names.
fn three(folder: &Folder) -> [Output; 3] {
    for name in ["new", "replaced", "linked", "linked-too"] {
        let _ = std::fs::remove_file(folder.at(name));
    }
    folder.put("replaced", OLD);
    folder.put("linked", OLD);
    std::fs::hard_link(folder.at("linked"), folder.at("linked-too")).expect("a link");
    ["new", "replaced", "linked"].map(|name| output(folder.at(name), NEW))
}

/// Steps that writing these takes.
fn steps(outputs: &[Output]) -> usize {
    let count = Cell::new(0);
    let disk = Disk {
        before: &|_| {
            count.set(count.get() + 1);
            Ok(())
        },
        ..DISK
    };
    write_by(&disk, outputs, Replacing::Anything).expect("written");
    count.get()
}

#[test]
fn a_fault_at_any_step_leaves_everything_as_it_was() {
    let folder = Folder::new("faults");
    let steps = steps(&three(&folder));
    assert!(steps > 15, "{steps}");
    for kind in [ErrorKind::StorageFull, ErrorKind::PermissionDenied] {
        for faulty in 0..steps {
            let outputs = three(&folder);
            let count = Cell::new(0);
            let disk = Disk {
                before: &|_| {
                    count.set(count.get() + 1);
                    match count.get() == faulty + 1 {
                        true => Err(Error::from(kind)),
                        false => Ok(()),
                    }
                },
                ..DISK
            };
            match write_by(&disk, &outputs, Replacing::Anything) {
                Ok(()) => {
                    // What has served could not be removed.
                    assert_eq!(folder.text("linked-too").as_deref(), Some(NEW));
                    write(&outputs, Replacing::Anything).expect("written");
                }
                Err(unwritten) => {
                    assert!(matches!(unwritten.why, Why::System(_)));
                    assert_eq!(folder.text("new"), None, "step {faulty}");
                    for name in ["replaced", "linked", "linked-too"] {
                        assert_eq!(folder.text(name).as_deref(), Some(OLD), "step {faulty}");
                        assert!(!mark::is_ours(&folder.at(name)), "restored, not written");
                    }
                }
            }
            assert_eq!(folder.leftovers(), [""; 0], "step {faulty}");
        }
    }
}

#[test]
fn a_program_killed_at_any_step_leaves_whole_files_and_the_next_one_clears_up() {
    let folder = Folder::new("kills");
    for last in 0..steps(&three(&folder)) {
        let outputs = three(&folder);
        let count = Cell::new(0);
        let disk = Disk {
            before: &|_| {
                count.set(count.get() + 1);
                assert!(count.get() <= last, "killed");
                Ok(())
            },
            ..DISK
        };
        let killed = catch_unwind(AssertUnwindSafe(|| {
            write_by(&disk, &outputs, Replacing::Anything)
        }));
        assert!(killed.is_err());
        assert!([None, Some(NEW)].contains(&folder.text("new").as_deref()));
        assert!([OLD, NEW].contains(&folder.text("replaced").expect("a file").as_str()));
        let linked = folder.text("linked").expect("a file");
        let waiting = folder.text(".linked.gumption-new");
        assert!(
            linked == OLD || linked == NEW || waiting.as_deref() == Some(NEW),
            "step {last}: {linked:?}"
        );
        write(&outputs, Replacing::Anything).expect("written");
        for name in ["new", "replaced", "linked", "linked-too"] {
            assert_eq!(folder.text(name).as_deref(), Some(NEW));
        }
        // A process that another test has just begun holds the locks of this one until it runs its own program.
        let is_cleared = (0..100).any(|_| {
            let cleared = folder.leftovers().is_empty();
            if !cleared {
                std::thread::sleep(std::time::Duration::from_millis(10));
                write(&outputs, Replacing::Anything).expect("written");
            }
            cleared
        });
        assert!(is_cleared, "step {last}: {:?}", folder.leftovers());
    }
}

#[test]
fn drafts_of_living_writers_stay() {
    let folder = Folder::new("living");
    let draft = DISK.create(folder.0.path(), None).expect("a draft");
    folder.put(".gumption-1-1.tmp", "of a killed program");
    folder.put(".gumption-notes", "of somebody");
    write(&[output(folder.at("a"), NEW)], Replacing::Nothing).expect("written");
    let mut left = folder.leftovers();
    left.sort();
    let name = draft.path.file_name().expect("a name").to_string_lossy();
    let mut expected = vec![name.into_owned(), ".gumption-notes".to_owned()];
    expected.sort();
    assert_eq!(left, expected);
}

#[test]
fn two_writers_leave_one_of_both_contents() {
    let folder = Folder::new("writers");
    let contents = ["a".repeat(40_000), "b".repeat(90_000)];
    let whole = |text: &str| contents.iter().any(|content| content == text);
    for linked in [false, true] {
        let path = folder.put("file", &contents[0]);
        if linked {
            std::fs::hard_link(&path, folder.at("other")).expect("a link");
        }
        std::thread::scope(|scope| {
            for content in &contents {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..20 {
                        write(&[output(path, content)], Replacing::Anything).expect("written");
                    }
                });
            }
            for _ in 0..20 {
                let text = std::fs::read_to_string(&path).expect("a file");
                assert!(linked || whole(&text));
            }
        });
        let text = std::fs::read_to_string(&path).expect("a file");
        assert!(whole(&text));
        assert_eq!(linked, folder.text("other").as_deref() == Some(&text));
        assert_eq!(folder.leftovers(), [""; 0]);
        let _ = std::fs::remove_file(folder.at("other"));
    }
}

#[test]
fn only_own_files_are_replaced_without_being_told() {
    let folder = Folder::new("own");
    let outputs = [output(folder.at("report"), NEW)];
    folder.put("report", OLD);
    assert!(matches!(why(write(&outputs, Replacing::Own)), Why::NotOurs));
    assert!(matches!(
        why(write(&outputs, Replacing::Nothing)),
        Why::Exists
    ));
    assert_eq!(folder.text("report").as_deref(), Some(OLD));
    write(&outputs, Replacing::Anything).expect("told so");
    if !are_marks_kept(&folder) {
        return;
    }
    write(&outputs, Replacing::Own).expect("it is ours");
    folder.put("report", "the new content, with a remark\n");
    assert!(matches!(why(write(&outputs, Replacing::Own)), Why::NotOurs));
    std::fs::copy(folder.at("report"), folder.at("copy")).expect("a copy");
    assert!(!mark::is_ours(&folder.at("copy")));
}

#[test]
fn what_is_written_is_written_once() {
    let folder = Folder::new("once");
    let twice = |a: &str, b: &str| {
        let outputs = [output(folder.at(a), NEW), output(folder.at(b), NEW)];
        matches!(why(write(&outputs, Replacing::Anything)), Why::Twice)
    };
    assert!(twice("a", "./a"));
    folder.put("b", OLD);
    std::fs::hard_link(folder.at("b"), folder.at("c")).expect("a link");
    assert!(twice("b", "c"));
    assert!(matches!(
        why(write(&[output(&folder.0, NEW)], Replacing::Anything)),
        Why::Folder
    ));
    let nowhere = write(&[output(folder.at("no/a"), NEW)], Replacing::Anything);
    assert!(matches!(why(nowhere), Why::System(error) if error.kind() == ErrorKind::NotFound));
}

#[cfg(unix)]
mod on_unix {
    use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};

    use super::super::Files;
    use super::*;

    #[test]
    fn modes_and_links_are_kept() {
        let folder = Folder::new("links");
        let file = folder.put("file", OLD);
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o640)).expect("a mode");
        symlink("file", folder.at("link")).expect("a link");
        symlink("later", folder.at("dangling")).expect("a link");
        for name in ["link", "dangling"] {
            write(&[output(folder.at(name), NEW)], Replacing::Anything).expect("written");
            let there = std::fs::symlink_metadata(folder.at(name)).expect("a link");
            assert!(there.is_symlink());
        }
        assert_eq!(folder.text("file").as_deref(), Some(NEW));
        assert_eq!(folder.text("later").as_deref(), Some(NEW));
        let there = std::fs::metadata(&file).expect("a file");
        assert_eq!(there.mode() & 0o777, 0o640);
        symlink("circle", folder.at("circle")).expect("a link");
        assert!(write(&[output(folder.at("circle"), NEW)], Replacing::Anything).is_err());
    }

    #[test]
    fn what_is_protected_needs_to_be_told() {
        let folder = Folder::new("protected");
        let outputs = [output(folder.at("file"), NEW)];
        write(&outputs, Replacing::Nothing).expect("written");
        let protected = std::fs::Permissions::from_mode(0o444);
        std::fs::set_permissions(folder.at("file"), protected).expect("a mode");
        assert!(matches!(
            why(write(&outputs, Replacing::Own)),
            Why::Protected
        ));
        write(&outputs, Replacing::Anything).expect("told so");
        let there = std::fs::metadata(folder.at("file")).expect("a file");
        assert_eq!(there.mode() & 0o777, 0o444);
    }

    #[test]
    fn a_pipe_is_written_to_and_never_read() {
        let folder = Folder::new("pipe");
        let pipe = folder.at("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        if !made.is_ok_and(|made| made.success()) {
            eprintln!("skipped: there is no mkfifo");
            return;
        }
        let refused = Files::Disk.read(&pipe).expect_err("a pipe");
        assert_eq!(refused.kind(), ErrorKind::InvalidInput);
        assert!(Files::Disk.read(Path::new("/dev/zero")).is_err());
        std::thread::scope(|scope| {
            let reader = scope.spawn(|| std::fs::read_to_string(&pipe).expect("a text"));
            write(&[output(&pipe, NEW)], Replacing::Nothing).expect("written");
            assert_eq!(reader.join().expect("a reader"), NEW);
        });
        let there = std::fs::symlink_metadata(&pipe).expect("a pipe");
        assert!(there.file_type().is_fifo());
    }
}

#[test]
fn a_restored_file_is_somebodys() {
    let folder = Folder::new("author");
    let disk = Disk {
        author: Author::Somebody,
        ..DISK
    };
    let mut draft = disk.create(folder.0.path(), None).expect("a draft");
    disk.fill(&mut draft, OLD.as_bytes()).expect("filled");
    assert!(!mark::is_ours(&draft.path));
}

#[test]
fn a_file_that_grows_takes_its_place_when_it_is_whole() {
    let folder = Folder::new("growing");
    let path = folder.at("results.csv");
    let whole = b"a,b\n1,2\n";
    let mut growing = Growing::begin(&path, Replacing::Own).expect("it may be written");
    growing.add(b"a,b\n").expect("it is written");
    assert!(!path.exists());
    growing.add(b"1,2\n").expect("it is written");
    growing.finish().expect("it has its place");
    assert_eq!(std::fs::read(&path).expect("it is there"), whole);
    // It is this program's own, and stays as it is where the next one is not finished.
    let mut unfinished = Growing::begin(&path, Replacing::Own).expect("it may be replaced");
    unfinished.add(b"c\n").expect("it is written");
    drop(unfinished);
    assert_eq!(std::fs::read(&path).expect("it is there"), whole);
    let files = std::fs::read_dir(&folder.0).expect("a folder");
    assert_eq!(files.count(), 1);
    std::fs::write(&path, "mine").expect("it is written");
    assert!(Growing::begin(&path, Replacing::Own).is_err());
}

#[test]
fn a_file_that_grows_keeps_its_other_names() {
    let folder = Folder::new("growing-names");
    let [path, other] = ["results.csv", "other.csv"].map(|name| folder.at(name));
    std::fs::write(&path, "old").expect("it is written");
    std::fs::hard_link(&path, &other).expect("another name");
    let mut growing = Growing::begin(&path, Replacing::Anything).expect("it may be written");
    growing.add(b"new").expect("it is written");
    growing.finish().expect("it has its place");
    assert_eq!(std::fs::read(&other).expect("it is there"), b"new");
}

/// What a file that grows goes through, and its place: a new one, one that is replaced, and one that has two names.
fn grown(disk: &Disk<'_>, path: &Path) -> Result<(), Unwritten> {
    let mut growing = Growing::begin_by(disk, path, Replacing::Anything)?;
    let (first, second) = NEW.split_at(4);
    growing.add_by(disk, first.as_bytes())?;
    growing.add_by(disk, second.as_bytes())?;
    growing.finish_by(disk)
}

#[test]
fn a_fault_at_any_step_of_a_file_that_grows_leaves_everything_as_it_was() {
    let folder = Folder::new("growing-faults");
    for (name, other) in [
        ("new", None),
        ("replaced", Some("replaced")),
        ("linked", Some("linked-too")),
    ] {
        for faulty in 1.. {
            three(&folder);
            let count = Cell::new(0);
            let disk = Disk {
                before: &|step| {
                    // Names that a system does not make safe are no fault: everything else is done.
                    let counts = usize::from(step != Step::SyncFolder);
                    count.set(count.get() + counts);
                    match counts == 1 && count.get() == faulty {
                        true => Err(Error::from(ErrorKind::StorageFull)),
                        false => Ok(()),
                    }
                },
                ..DISK
            };
            let result = grown(&disk, &folder.at(name));
            let is_past_the_last = count.get() < faulty;
            let now = folder.text(name);
            match result {
                // What has served could not be removed, or there was no fault.
                Ok(()) => assert_eq!(now.as_deref(), Some(NEW), "{name}, step {faulty}"),
                Err(_) => {
                    let old = other.map(|_| OLD);
                    assert_eq!(now.as_deref(), old, "{name}, step {faulty}");
                    if let Some(other) = other {
                        assert_eq!(
                            folder.text(other).as_deref(),
                            Some(OLD),
                            "{name}, step {faulty}"
                        );
                    }
                }
            }
            if !is_past_the_last {
                write(&[output(folder.at("another"), NEW)], Replacing::Anything).expect("written");
            }
            let waiting = folder.leftovers();
            let left: Vec<&String> = waiting
                .iter()
                .filter(|name| !name.ends_with("-new"))
                .collect();
            assert!(left.is_empty(), "{name}, step {faulty}: {left:?}");
            let _ = std::fs::remove_file(folder.at(".linked.gumption-new"));
            if is_past_the_last {
                assert!(faulty > 5, "{name}: {faulty} steps");
                break;
            }
        }
    }
}

/// Of killed programs and of living ones that end here.
#[test]
fn what_was_left_of_a_file_that_grows_is_removed_by_the_next_one() {
    let folder = Folder::new("growing-killed");
    folder.put(".gumption-1-1.tmp", "of a killed program");
    let path = folder.at("results.csv");
    let growing = Growing::begin(&path, Replacing::Nothing).expect("it may be written");
    assert_eq!(folder.leftovers().len(), 1, "its own");
    drop(growing);
    assert_eq!(folder.leftovers(), [""; 0]);
}
