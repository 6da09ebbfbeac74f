//! Archives: what is in them gives the same bits again, and what was changed in them is noticed.

use std::path::{Path, PathBuf};

use super::common::{folder, program, root};
use gumption::render::archive;

fn archived(folder: &Path, budget: &str, more: &[&str]) -> PathBuf {
    let file = folder.join("archive.zip");
    let run = program()
        .args(["eval", "--force", "-o", "-"])
        .args(more)
        .arg(root().join(budget))
        .arg("--archive")
        .arg(&file)
        .output()
        .expect("the program runs");
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{said}");
    file
}

fn verified(file: &Path) -> (i32, String) {
    let run = program()
        .args(["verify", "--lang", "en"])
        .arg(file)
        .output()
        .expect("it runs");
    let said = [run.stdout, run.stderr].concat();
    (
        run.status.code().unwrap_or(-1),
        String::from_utf8_lossy(&said).into_owned(),
    )
}

#[test]
fn archives_give_the_same_bits_again() {
    let folder = folder("archives");
    for (budget, more) in [
        (
            "budgets/mass/weight-10kg-ea402-s2.toml",
            vec!["--seed", "7", "--trials", "20000"],
        ),
        (
            "budgets/mass/working-standards.toml",
            vec!["--no-mc", "--profile", "JJF"],
        ),
        (
            "budgets/inertial/four-point-tumble-runs.toml",
            vec!["--no-mc"],
        ),
    ] {
        let file = archived(&folder, budget, &more);
        let bytes = std::fs::read(&file).expect("an archive");
        archived(&folder, budget, &more);
        assert_eq!(bytes, std::fs::read(&file).expect("an archive"), "{budget}");
        let (code, said) = verified(&file);
        assert_eq!(code, 0, "{budget}: {said}");
        assert!(said.contains("the same bits"), "{said}");
    }
}

/// The archive with one of its files changed, and its hash with it where it is to look whole.
fn changed(file: &Path, name: &str, change: impl Fn(String) -> String) -> PathBuf {
    let bytes = std::fs::read(file).expect("an archive");
    let mut members = archive::unpacked(&bytes).expect("an archive");
    for (member, content) in &mut members {
        if member.ends_with(name) {
            *content = change(String::from_utf8(content.clone()).expect("text")).into_bytes();
        }
    }
    let other = file.with_extension("changed.zip");
    std::fs::write(&other, archive::packed(&members).expect("an archive")).expect("a file");
    other
}

#[test]
fn changes_are_noticed() {
    let folder = folder("changes");
    let budget = "budgets/mass/weight-10kg-ea402-s2.toml";
    let file = archived(&folder, budget, &["--no-mc"]);
    let other = changed(&file, "weight-10kg-ea402-s2.toml", |text| {
        text + "\n# changed\n"
    });
    let (code, said) = verified(&other);
    assert_eq!(code, 1, "{said}");
    assert!(
        said.contains("was changed") && said.contains("weight-10kg"),
        "{said}"
    );
    let other = changed(&file, "manifest.json", |text| {
        text.replace("--no-mc", "--profile=JJF-up")
    });
    let (code, said) = verified(&other);
    assert_eq!(code, 1, "{said}");
    assert!(
        said.contains("not the same") && said.contains("before"),
        "{said}"
    );
    let other = changed(&file, "manifest.json", |text| {
        text.replace("gumption-archive/1", "x")
    });
    assert_eq!(verified(&other).0, 2);
    let broken = file.with_extension("broken.zip");
    std::fs::write(&broken, "PK").expect("a file");
    assert_eq!(verified(&broken).0, 2);
}
