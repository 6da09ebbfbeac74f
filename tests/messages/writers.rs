//! Every command that writes, under faults from outside: the disk takes nothing, the folder takes nothing, the program
//! is killed while it writes, two of them write at once.
//!
//! The limit of the size of a file (`ulimit -f 0`) is a disk that is full: where the signal that comes with it is ignored,
//! writing fails; where it is not, the program is killed in the middle.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use crate::common::{self, Folder};

/// A command, what it writes, and the option that says where; `OUT` stands for the place.
struct Writer {
    arguments: &'static str,
    option: &'static str,
    /// Files that it writes, below `OUT` if that is a folder; empty where `OUT` is the file.
    files: &'static [&'static str],
    /// Whether it has `--force`; else it replaces nothing.
    is_forceful: bool,
}

const fn file(arguments: &'static str, option: &'static str) -> Writer {
    Writer {
        arguments,
        option,
        files: &[],
        is_forceful: true,
    }
}

const fn folder(
    arguments: &'static str,
    option: &'static str,
    files: &'static [&'static str],
) -> Writer {
    Writer {
        files,
        ..file(arguments, option)
    }
}

const fn careful(writer: Writer) -> Writer {
    Writer {
        is_forceful: false,
        ..writer
    }
}

/// All of them; [`every_option_that_names_an_output_is_a_writer`].
const WRITERS: &[Writer] = &[
    file("eval budget.toml --no-mc -o OUT.txt", "--output"),
    file("eval budget.toml --no-mc -o OUT.md", "--output"),
    file("eval budget.toml --no-mc -o OUT.html", "--output"),
    file("eval budget.toml --no-mc -o OUT.json", "--output"),
    file("eval budget.toml --no-mc -o OUT.xlsx", "--output"),
    file("eval budget.toml --no-mc -o OUT.docx", "--output"),
    file(
        "eval budget.toml --no-mc --certificate laboratory.toml -o OUT.xml",
        "--output",
    ),
    file("eval budget.toml --no-mc --save OUT.json", "--save"),
    file("eval budget.toml --no-mc --csv OUT.csv", "--csv"),
    file("eval budget.toml --no-mc --archive OUT.zip", "--archive"),
    file("batch budget.toml devices.csv -o OUT.csv", "--output"),
    file("fleet results.csv -o OUT.md", "--output"),
    file("audit claim.csv -o OUT.md", "--output"),
    careful(file("audit claim.csv --map OUT.toml", "--map")),
    file("import claim.csv -o OUT.toml", "--output"),
    file("diagnose case.toml -o OUT.md", "--output"),
    folder(
        "diagnose case.toml --improved OUT",
        "--improved",
        &["case.toml"],
    ),
    folder(
        "diagnose case.toml --plots OUT",
        "--plots",
        &["residuals_x.svg"],
    ),
    file("simulate case.toml -o OUT.csv", "--output"),
    folder(
        "verify budget.toml --report OUT",
        "--report",
        &["verification.md"],
    ),
    file("verify budget.toml -o OUT.md", "--output"),
    file(
        "allan recording.csv --column y --interval 1 -o OUT.md",
        "--output",
    ),
    file("calibrate case.toml -o OUT.md", "--output"),
    file("calibrate case.toml --budget OUT.toml", "--budget"),
    file(
        "calibrate case.toml -o OUT.csv --recordings recording.csv",
        "--output",
    ),
    file("plan case.toml -o OUT.md", "--output"),
    careful(file("new OUT.toml", "<PATH>")),
    careful(file("new -o OUT.toml", "--output")),
    careful(folder(
        "challenge --seed 3 --rig tumble --out OUT",
        "--out",
        &["truth.json"],
    )),
    file("grade sealed --diagnosis answer.json -o OUT.md", "--output"),
];

/// Options that name what is read.
const READERS: &[&str] = &[
    "import --map",
    "eval --certificate",
    "grade --diagnosis",
    "grade --audit",
];

#[test]
fn every_option_that_names_an_output_is_a_writer() {
    let reference = std::fs::read_to_string(common::root().join("docs/reference/cli.md"));
    let reference = reference.expect("the reference");
    let mut missing = Vec::new();
    for section in reference.split("\n## gumption ").skip(1) {
        let command = section.lines().next().unwrap_or_default();
        for line in section.lines().map(str::trim_start) {
            let names_a_file = ["<FILE", "<DIR", "<PATH", "=FILE"].iter().any(|sign| {
                line.split("  ")
                    .next()
                    .is_some_and(|head| head.contains(sign))
            });
            let option = line
                .split([' ', ',', '<'])
                .find(|word| word.starts_with("--"));
            let (true, true, Some(option)) = (line.starts_with('-'), names_a_file, option) else {
                continue;
            };
            let is_written = WRITERS
                .iter()
                .any(|one| one.arguments.starts_with(command) && one.option == option);
            if !is_written && !READERS.contains(&format!("{command} {option}").as_str()) {
                missing.push(format!("{command} {option}"));
            }
        }
    }
    assert_eq!(missing, [""; 0], "options that neither list has");
}

/// A folder with everything that the writers read.
struct Place(Folder);

impl Place {
    fn new(name: &str) -> Place {
        let place = Place(common::folder(name));
        common::bent_line(&place.0);
        let put = |name: &str, text: &str| place.0.put(name, text);
        put(
            "budget.toml",
            "title = \"Resistance\"\n[measurand.R]\nmodel = \"V / I\"\nunit = \"ohm\"\n[input]\n\
             V = { value = 5, unit = \"V\", u = 0.01 }\nI = { value = 20, unit = \"mA\", u = 0.05 }\n\
             [claim]\nU = 2\nk = 2\n",
        );
        put("devices.csv", "label,V\na,5.1\nb,5.2\nc,5.3\n");
        put("results.csv", "label,y,u(y),k(y)\na,1,1,2\nb,2,1,2\n");
        for (name, of) in [
            ("claim.csv", "docs/examples/claimed-budget.csv"),
            ("laboratory.toml", "reports/certificates/laboratory.toml"),
        ] {
            std::fs::copy(common::root().join(of), place.0.join(name)).expect("a copy");
        }
        let sealed = place.run("challenge --seed 3 --rig tumble --out sealed", "");
        assert!(sealed.status.success());
        put("answer.json", "{}");
        let diagnosed = place.run(
            "diagnose sealed/case/CASE.toml --json -o answer.json --force",
            "",
        );
        assert_ne!(diagnosed.status.code(), Some(2), "{}", said(&diagnosed));
        place
    }

    /// The program, behind commands of a shell.
    fn started(&self, arguments: &str, before: &str) -> Command {
        let program = common::program();
        let mut shell = Command::new("sh");
        for (name, value) in program.get_envs() {
            shell.env(name, value.unwrap_or_default());
        }
        let line = format!("ulimit -c 0; {before} exec \"$0\" {arguments}");
        shell.current_dir(&self.0).arg("-c").arg(line);
        shell.arg(program.get_program());
        shell
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        shell
    }

    fn run(&self, arguments: &str, before: &str) -> Output {
        self.started(arguments, before).output().expect("a shell")
    }

    /// What is there, with its content.
    fn all(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let mut folders = vec![self.0.to_path_buf()];
        let mut all = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
                match entry.path() {
                    path if path.is_dir() => folders.push(path),
                    path => {
                        let content = std::fs::read(&path).expect("a file");
                        all.push((path, content));
                    }
                }
            }
        }
        all.sort();
        all
    }
}

impl Writer {
    fn at(&self, name: &str) -> String {
        let force = if self.is_forceful { " --force" } else { "" };
        self.arguments.replace("OUT", name) + force
    }

    /// The first file that it writes.
    fn output(&self, place: &Place, name: &str) -> PathBuf {
        let out = self.arguments.split(' ').find(|word| word.contains("OUT"));
        let out = place.0.join(out.unwrap_or_default().replace("OUT", name));
        match self.files.first() {
            Some(file) if self.option == "--out" => out.join(file),
            Some(file) => out.join(file),
            None => out,
        }
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn leftovers(all: &[(PathBuf, Vec<u8>)]) -> Vec<&PathBuf> {
    let paths = all.iter().map(|(path, _)| path);
    let is_ours = |path: &&PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(".gumption-")
    };
    paths.filter(is_ours).collect()
}

#[test]
fn a_disk_that_takes_nothing_leaves_everything_as_it_was() {
    let place = Place::new("full");
    for (number, writer) in WRITERS.iter().enumerate() {
        let name = format!("full{number}");
        let output = writer.output(&place, &name);
        if writer.is_forceful {
            std::fs::create_dir_all(output.parent().expect("a folder")).expect("a folder");
            std::fs::write(&output, "mine").expect("a file");
        }
        let before = place.all();
        let run = place.run(&writer.at(&name), "ulimit -f 0; trap '' XFSZ;");
        let said = said(&run);
        assert_eq!(run.status.code(), Some(2), "{}\n{said}", writer.arguments);
        assert!(
            said.contains("cannot write"),
            "{}\n{said}",
            writer.arguments
        );
        assert_eq!(place.all(), before, "{}", writer.arguments);
    }
}

#[test]
fn a_folder_that_is_read_only_stays_as_it_was() {
    let place = Place::new("closed");
    let closed = place.0.join("closed");
    std::fs::create_dir(&closed).expect("a folder");
    let mode = |mode| {
        let permissions = std::fs::Permissions::from_mode(mode);
        std::fs::set_permissions(&closed, permissions).expect("a mode");
    };
    mode(0o555);
    // Modes bind nobody who may do everything, unless he gives that up.
    let probe = closed.join("probe");
    let may_do_everything = std::fs::write(&probe, "").is_ok();
    let _ = std::fs::remove_file(&probe);
    let gives_up = "setpriv --bounding-set=-dac_override";
    if may_do_everything
        && !place
            .run("--version", &format!("{gives_up} true &&"))
            .status
            .success()
    {
        eprintln!("skipped: this user may write everywhere, and cannot give that up");
        return;
    }
    let before = place.all();
    for writer in WRITERS {
        let arguments = writer.at("closed/new");
        let without_privileges = match may_do_everything {
            true => format!("exec {gives_up} \"$0\" {arguments};"),
            false => String::new(),
        };
        let run = place.run(&arguments, &without_privileges);
        let said = said(&run);
        assert_eq!(run.status.code(), Some(2), "{arguments}\n{said}");
        assert!(
            said.contains("cannot write") || said.contains("cannot create"),
            "{arguments}\n{said}"
        );
        assert_eq!(place.all(), before, "{arguments}");
    }
    mode(0o755);
}

#[test]
fn a_program_killed_while_it_writes_leaves_the_old_file_and_the_next_one_clears_up() {
    let place = Place::new("killed");
    for (number, writer) in WRITERS.iter().enumerate() {
        let name = format!("killed{number}");
        let output = writer.output(&place, &name);
        if writer.is_forceful {
            std::fs::create_dir_all(output.parent().expect("a folder")).expect("a folder");
            std::fs::write(&output, "mine").expect("a file");
        }
        let old = std::fs::read(&output).ok();
        let run = place.run(&writer.at(&name), "ulimit -f 0;");
        assert_eq!(
            run.status.code(),
            None,
            "{} is killed\n{}",
            writer.arguments,
            said(&run)
        );
        assert_eq!(std::fs::read(&output).ok(), old, "{}", writer.arguments);
        let again = place.run(&writer.at(&name), "");
        assert!(
            matches!(again.status.code(), Some(0 | 1)),
            "{}\n{}",
            writer.arguments,
            said(&again)
        );
        assert!(
            std::fs::read(&output).is_ok_and(|new| Some(new) != old),
            "{}",
            writer.arguments
        );
        assert_eq!(
            leftovers(&place.all()),
            Vec::<&PathBuf>::new(),
            "{}",
            writer.arguments
        );
    }
}

#[test]
fn two_writers_at_once_leave_one_whole_file() {
    let place = Place::new("two");
    for writer in WRITERS.iter().filter(|writer| writer.is_forceful) {
        let alone = place.run(&writer.at("alone"), "");
        assert!(
            matches!(alone.status.code(), Some(0 | 1)),
            "{}\n{}",
            writer.arguments,
            said(&alone)
        );
        let both = [(); 2].map(|()| {
            place
                .started(&writer.at("both"), "")
                .spawn()
                .expect("a shell")
        });
        for one in both {
            let ended = one.wait_with_output().expect("it ends");
            assert!(
                matches!(ended.status.code(), Some(0..=2)),
                "{}\n{}",
                writer.arguments,
                said(&ended)
            );
        }
        let content = |name: &str| std::fs::read(writer.output(&place, name)).expect("a file");
        assert!(!content("both").is_empty());
        // A dossier and an archive say what they are called or when; all others are the same to the byte.
        let same = content("alone").len() == content("both").len() || writer.option == "--report";
        assert!(same, "{}", writer.arguments);
        assert_eq!(
            leftovers(&place.all()),
            Vec::<&PathBuf>::new(),
            "{}",
            writer.arguments
        );
    }
}
