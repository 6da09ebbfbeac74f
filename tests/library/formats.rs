//! Formats that are no text: their words read by others are those of the statement, and what users wrote stays text.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::common::{folder, program, root};
use gumption::fault::is_obeyed;
use gumption::render::archive;

/// A budget whose words try to be more than words.
const HOSTILE: &str = "title = \"</w:t></w:p><script>&amp; ]]> %s \\\\input{x} \\u001b[31m\"\n\
object = \"<dcc:content>\"\nmethod = \"a & b < c\"\n\
[measurand.y]\nmodel = \"x\"\nunit = \"V\"\ndescription = \"</dcc:content><evil/>\"\n\
[input.x]\nvalue = 10.00012\nunit = \"V\"\nu = 0.00035\n";

/// Writes a document of a budget.
fn written(budget: &Path, file: &Path, language: &str) -> Vec<u8> {
    let data = file.with_file_name("laboratory.toml");
    if !data.exists() {
        let run = program().args(["new", "--certificate"]).arg(&data).status();
        assert!(run.expect("the program runs").success());
    }
    let run = program()
        .args([
            "eval",
            "--force",
            "--trials",
            "10000",
            "--lang",
            language,
            "--certificate",
        ])
        .args([data.as_path(), Path::new("-o"), file, budget])
        .output()
        .expect("the program runs");
    let said = String::from_utf8_lossy(&run.stderr);
    assert_ne!(run.status.code(), Some(2), "{said}");
    std::fs::read(file).expect("a document")
}

/// The statement as text has it, sentence by sentence.
fn statement(budget: &Path, language: &str) -> Vec<String> {
    let run = program()
        .args([
            "eval", "--trials", "10000", "--width", "200", "--lang", language,
        ])
        .arg(budget)
        .output()
        .expect("the program runs");
    let text = String::from_utf8(run.stdout).expect("UTF-8");
    let lines = text
        .lines()
        .filter_map(|line| line.trim_start().strip_prefix("┃"));
    let all = lines.collect::<Vec<_>>().join(" ");
    all.split_inclusive(['.', '。'])
        .filter(|sentence| sentence.contains('='))
        .map(squeezed)
        .collect()
}

/// Without what lines and marks add.
fn squeezed(text: &str) -> String {
    let kept = text.replace('−', "-");
    kept.chars()
        .filter(|c| !c.is_whitespace() && !"^`".contains(*c))
        .collect()
}

const BUDGETS: [&str; 4] = [
    "electrical/dmm-100v-ea402-s9",
    "mass/weight-10kg-ea402-s2",
    "conformity/suspended-particulate-gum5-10",
    "length/end-gauge-gum-h1",
];

/// The words of the main part of a document for word processors.
fn words(document: &[u8]) -> String {
    let members = archive::unpacked(document).expect("a package");
    let main = members.iter().find(|(name, _)| name == "word/document.xml");
    let main = String::from_utf8(main.expect("a main part").1.clone()).expect("UTF-8");
    let mut words = String::new();
    for part in main
        .split("<w:t ")
        .skip(1)
        .chain(main.split("<m:t ").skip(1))
    {
        let inside = part.split_once('>').expect("an element").1;
        words.push_str(inside.split('<').next().unwrap_or_default());
    }
    words
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&apos;", "'")
        .replace("&amp;", "&")
}

#[test]
fn word_processors_read_the_figures_of_the_statement() {
    let folder = folder("words");
    for budget in BUDGETS {
        let budget = root().join(format!("budgets/{budget}.toml"));
        for language in ["en", "zh"] {
            let document = written(&budget, &folder.join("report.docx"), language);
            let again = written(&budget, &folder.join("report.docx"), language);
            assert_eq!(document, again);
            let words = squeezed(&words(&document));
            for sentence in statement(&budget, language) {
                assert!(words.contains(&sentence), "{sentence}\nis not in\n{words}");
            }
        }
    }
}

/// Whether other programs read these files as XML.
fn are_well_formed(files: &[PathBuf]) {
    let parsed = Command::new("python3")
        .args([
            "-c",
            "import sys, xml.dom.minidom as m; [m.parse(f) for f in sys.argv[1:]]",
        ])
        .args(files)
        .output();
    match parsed {
        Ok(parsed) => assert!(
            parsed.status.success(),
            "{}",
            String::from_utf8_lossy(&parsed.stderr)
        ),
        Err(_) => eprintln!("skipped: needs Python"),
    }
}

/// The parts of a package, as files.
fn parts(document: &[u8], folder: &Path) -> Vec<PathBuf> {
    let members = archive::unpacked(document).expect("a package").into_iter();
    let parts = members.filter(|(name, _)| name.ends_with(".xml") || name.ends_with(".rels"));
    let files = parts.map(|(name, content)| {
        let file = folder.join(name.replace(['/', '[', ']'], "_"));
        std::fs::write(&file, content).expect("a part");
        file
    });
    files.collect()
}

#[test]
fn what_users_write_stays_text() {
    let folder = folder("hostile");
    let budget = folder.join("hostile.toml");
    std::fs::write(&budget, HOSTILE).expect("a budget");
    let made = |ending: &str| written(&budget, &folder.join(format!("report.{ending}")), "both");
    let text = |ending: &str| String::from_utf8(made(ending)).expect("UTF-8");

    let document = made("docx");
    assert!(words(&document).contains("</w:t></w:p><script>&amp; ]]>"));
    let mut files = parts(&document, &folder);
    let certificate = text("xml");
    assert!(!certificate.contains("<evil") && !certificate.contains("<script"));
    files.push(folder.join("report.xml"));
    let workbook = made("xlsx");
    files.extend(parts(&workbook, &folder));
    are_well_formed(&files);
    for (name, part) in archive::unpacked(&workbook).expect("a package") {
        let part = String::from_utf8_lossy(&part).into_owned();
        assert!(
            !part.contains("<script") && !part.contains("<evil"),
            "{name}"
        );
    }

    let page = text("html");
    assert!(!page.contains("<script") && !page.contains("<evil"));
    assert!(page.contains("&lt;script&gt;"));
    // Markdown lets HTML through where nothing stands before it.
    let page = text("md");
    for (at, _) in page
        .match_indices("<script")
        .chain(page.match_indices("<evil"))
    {
        assert!(page[..at].ends_with('\\'), "{page}");
    }
    for ending in ["txt", "md", "html", "json"] {
        assert!(!text(ending).contains('\u{1b}'), "{ending}");
    }
}

/// What begins as a formula does is a text in a workbook.
#[test]
fn words_are_no_formulas() {
    let folder = folder("formulas");
    let budget = folder.join("formulas.toml");
    let text = HOSTILE
        .replace("<dcc:content>", "=HYPERLINK(1)")
        .replace("a & b < c", "@SUM(1)");
    std::fs::write(&budget, text).expect("a budget");
    let workbook = written(&budget, &folder.join("report.xlsx"), "en");
    for (name, part) in archive::unpacked(&workbook).expect("a package") {
        let part = String::from_utf8_lossy(&part).into_owned();
        let mut formulas = part.split("<f>").skip(1);
        assert!(
            !formulas.any(|formula| formula.starts_with("HYPERLINK") || formula.starts_with('@')),
            "{name}"
        );
    }
}

#[cfg(feature = "pdf")]
#[test]
fn pages_hold_the_figures_of_the_statement() {
    let folder = folder("pages");
    for budget in BUDGETS {
        let budget = root().join(format!("budgets/{budget}.toml"));
        for language in ["en", "zh"] {
            let file = folder.join("report.pdf");
            let pages = written(&budget, &file, language);
            assert!(pages.starts_with(b"%PDF-1."));
            assert_eq!(pages, written(&budget, &file, language));
            let read = Command::new("pdftotext")
                .args(["-layout"])
                .arg(&file)
                .arg("-")
                .output();
            let Ok(read) = read else {
                eprintln!("skipped: needs pdftotext");
                return;
            };
            let words = squeezed(&String::from_utf8_lossy(&read.stdout));
            for sentence in statement(&budget, language) {
                assert!(words.contains(&sentence), "{sentence}\nis not in\n{words}");
            }
        }
    }
}

/// Of a single result, of a series with its labels, and under the head of a certificate.
#[test]
fn what_users_wrote_is_obeyed_nowhere() {
    let folder = folder("obeyed");
    let rows = "\n[series]\ncolumns = [\"label\", \"x\"]\nrows = [[\"\\u001b[2Ja\", 1], [\"\\u202Eb\", 2]]\n";
    let budgets = [
        ("one", HOSTILE.to_owned()),
        ("series", HOSTILE.to_owned() + rows),
    ];
    for (name, text) in budgets {
        let budget = folder.join(format!("{name}.toml"));
        std::fs::write(&budget, text).expect("a budget");
        for language in ["en", "zh", "both"] {
            for ending in ["txt", "md", "html"] {
                let file = folder.join(format!("{name}.{ending}"));
                let text = String::from_utf8(written(&budget, &file, language)).expect("UTF-8");
                let obeyed = text.chars().find(|c| *c != '\n' && is_obeyed(*c));
                assert_eq!(obeyed, None, "{name}, {language}:\n{text}");
            }
        }
    }
}
