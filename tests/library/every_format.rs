//! Every format of what every command composes: each is written, and holds the figures of the others and no more.

use std::collections::BTreeSet;
use std::path::Path;

use gumption::audit::read::Mapping;
use gumption::audit::{audit, claims};
use gumption::budget::{self, Trials};
use gumption::document::{Block, Document, Math};
use gumption::experiment::Purpose;
use gumption::propagate::{self, MonteCarloChoice, Options};
use gumption::render::{FORMATS, Page, archive};
use gumption::report::{self, Language, Report};
use gumption::verify::{Environment, Example, Verification};
use gumption::{Files, calibrate, challenge, render};

use super::common::{self, Folder, cases, program, root};

/// Enough for pictures and for either verdict; the figures need not be good ones.
const TRIALS: u64 = 2000;

type Figures = BTreeSet<String>;

/// The numbers of a text, sign and exponent apart.
fn figures(text: &str) -> Figures {
    let digits = |c: char| c.is_ascii_digit() || c == '.';
    let words = text
        .split(|c| !digits(c))
        .map(|word| word.trim_matches('.'));
    let numbers = words.filter(|word| word.bytes().any(|b| b.is_ascii_digit()));
    numbers.map(str::to_owned).collect()
}

/// Without what stands between two marks.
fn without(text: &str, open: &str, close: &str) -> String {
    let mut pieces = text.split(open);
    let mut kept = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        kept += " ";
        kept += piece.split_once(close).map_or("", |(_, rest)| rest);
    }
    kept
}

/// Words of a part of a package: each element of this name.
fn words_of(xml: &str, element: &str) -> String {
    let open = format!("<{element}");
    let parts = xml.split(&open).skip(1);
    let words = parts.filter_map(|part| {
        let (head, rest) = part.split_once('>')?;
        // Another element, or one without content.
        let own = head.is_empty() || head.starts_with(' ');
        (own && !head.ends_with('/')).then(|| rest.split('<').next().unwrap_or_default())
    });
    words.collect::<Vec<_>>().join(" ")
}

fn part(package: &[u8], name: &str) -> String {
    let members = archive::unpacked(package).expect("a package");
    let member = members.into_iter().find(|(own, _)| own == name);
    String::from_utf8(member.expect(name).1).expect("UTF-8")
}

/// The figures that a reader of a format sees in its words, without pictures and numbers of pages.
fn seen(format: &str, bytes: &[u8]) -> Figures {
    let text = || String::from_utf8(bytes.to_vec()).expect("UTF-8");
    match format {
        "text" => figures(&text()),
        "markdown" => figures(&text().replace('\\', "")),
        "html" => {
            let mut text = text();
            for (open, close) in [("<style", "</style>"), ("<svg", "</svg>"), ("<", ">")] {
                text = without(&text, open, close);
            }
            figures(&text)
        }
        "docx" => {
            let main = part(bytes, "word/document.xml");
            // A number may change its looks where it is raised, and nowhere else.
            figures(&format!(
                "{} {}",
                words_of(&main, "w:t"),
                words_of(&main, "m:t")
            ))
        }
        "xlsx" => figures(&words_of(&part(bytes, "xl/sharedStrings.xml"), "t")),
        other => panic!("{other} has no words"),
    }
}

fn written(document: &Document, name: &str) -> Vec<u8> {
    let format = render::named(name).expect(name);
    (format.render)(document, &Page::default()).unwrap_or_else(|unfit| panic!("{name}: {unfit:?}"))
}

#[track_caller]
fn within(part: &Figures, whole: &Figures, what: &str) {
    let more: Vec<&String> = part.difference(whole).collect();
    assert!(more.is_empty(), "{what}: {more:?}");
}

fn folder(name: &str) -> Folder {
    cases::folder(&format!("every-format-{name}"))
}

/// The evaluation of a file as the document of a certificate in both languages.
fn certificate(path: &Path, laboratory: &gumption::document::Administration) -> Document {
    let loaded =
        budget::load(path).unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let rows = loaded.rows.into_iter().map(|mut row| {
        row.budget.monte_carlo.trials = Trials::Fixed(TRIALS);
        let found = propagate::evaluate(&row.budget, &Options::default());
        (row, found.expect("a value"))
    });
    let rows: Vec<_> = rows.collect();
    let composed = |language: Language| {
        let reports = rows.iter().map(|(row, evaluation)| Report {
            budget: &row.budget,
            evaluation,
            label: row.label.as_deref(),
            language,
        });
        let reports: Vec<_> = reports.collect();
        report::evaluations(&reports, 2).expect("a row")
    };
    let both = composed(Language::English).beside_the_words_of(composed(Language::Chinese));
    report::certified(both, laboratory, Vec::new())
}

/// The data of a certificate, as they are to be filled in.
fn laboratory(folder: &Path) -> gumption::document::Administration {
    let data = folder.join("laboratory.toml");
    std::fs::write(&data, report::certificate_template(Language::English)).expect("written");
    report::administration(Files::Disk, &data).expect("the template is good")
}

#[test]
fn no_figure_of_the_library_differs_between_formats() {
    let laboratory = laboratory(&folder("library"));
    let (mut count, mut certified) = (0, 0);
    for path in common::files("budgets", "toml") {
        let document = certificate(&path, &laboratory);
        let what = |format: &str| format!("{}, {format}", common::relative(&path));
        let html = same_in_every_format(&document, &what);
        assert!(html.len() > 5, "{html:?}");
        let stated = statement(&document);
        // A digital certificate is refused with a reason where it cannot say what is stated.
        let dcc = render::with_ending("xml").expect("the format");
        match (dcc.render)(&document, &Page::default()) {
            Ok(bytes) => {
                let xml = String::from_utf8(bytes).expect("UTF-8");
                within(
                    &stated,
                    &figures(&without(&xml, "<", ">")),
                    &what("statement, not in the digital certificate"),
                );
                certified += 1;
            }
            Err(unfit) => assert!(!unfit.0.to_string().is_empty()),
        }
        count += 1;
    }
    assert!(
        count > 100 && certified * 4 > count * 3,
        "{certified} of {count}"
    );
}

/// Another program reads on the pages of every budget what is stated.
#[cfg(feature = "pdf")]
#[test]
fn pages_of_the_library_hold_the_figures_of_its_statements() {
    let folder = folder("pages");
    let laboratory = laboratory(&folder);
    let file = folder.join("report.pdf");
    for path in common::files("budgets", "toml") {
        let document = certificate(&path, &laboratory);
        let pages = render::named("pdf").expect("the format");
        let pages = match (pages.render)(&document, &Page::default()) {
            Ok(pages) => pages,
            Err(unfit) => {
                assert!(unfit.0.to_string().contains("no font"), "{}", unfit.0);
                eprintln!("skipped: PDF in both languages needs a font with Chinese letters");
                return;
            }
        };
        std::fs::write(&file, pages).expect("written");
        let read = std::process::Command::new("pdftotext")
            .arg("-layout")
            .arg(&file)
            .arg("-")
            .output();
        let Ok(read) = read else {
            eprintln!("skipped: needs pdftotext");
            return;
        };
        let words = figures(&String::from_utf8_lossy(&read.stdout));
        let what = format!("{}: statement, not on pages", common::relative(&path));
        within(&statement(&document), &words, &what);
    }
}

/// Holds the words of every format against those of HTML, which it gives.
#[track_caller]
fn same_in_every_format(document: &Document, what: &dyn Fn(&str) -> String) -> Figures {
    let seen = |name: &str| seen(name, &written(document, name));
    let html = seen("html");
    let docx = seen("docx");
    within(&html, &docx, &what("HTML, not in Word"));
    within(&docx, &html, &what("Word, not in HTML"));
    let markdown = seen("markdown");
    within(&html, &markdown, &what("HTML, not in Markdown"));
    within(&markdown, &html, &what("Markdown, not in HTML"));
    within(&seen("text"), &html, &what("text, not in HTML"));
    let stated = statement(document);
    within(&stated, &seen("xlsx"), &what("statement, not in Excel"));
    within(&stated, &html, &what("statement, not in HTML"));
    let json: serde_json::Value = serde_json::from_slice(&written(document, "json")).expect("JSON");
    assert!(json.is_object() || json.is_array());
    formulas_are_set(document);
    html
}

/// Every line of a formula is set as mathematics, none as it is typed.
#[track_caller]
fn formulas_are_set(document: &Document) {
    for block in document.blocks() {
        if let Block::Formula(lines) = block {
            let typed: Vec<&String> = lines.iter().filter(|l| Math::of(l).is_none()).collect();
            assert!(typed.is_empty(), "{typed:?}");
        }
    }
}

/// The words of two languages beside each other.
fn both(composed: impl Fn(Language) -> Document) -> Document {
    composed(Language::English).beside_the_words_of(composed(Language::Chinese))
}

/// Calibrations of every experiment, audits of sheets of every layout, and the verification of the library.
#[test]
fn no_figure_of_other_commands_differs_between_formats() {
    let mut calibrations = 0;
    for path in common::files("experiments", "toml") {
        let name = common::relative(&path);
        // Of some the recording is not here, and plans have none.
        let Ok(campaign) = calibrate::load(&path, Purpose::Calibrate) else {
            continue;
        };
        let Ok(found) = calibrate::calibrate(&campaign) else {
            continue;
        };
        let document = both(|language| report::calibration(&campaign, &found, language));
        assert!(document.plots().next().is_some(), "{name}");
        same_in_every_format(&document, &|format| format!("{name}, {format}"));
        calibrations += 1;
    }
    assert!(calibrations >= 10, "{calibrations}");
    let mut marked = 0;
    for number in 1..=40 {
        let sealed = challenge::budget::sheet(20_261_124, number);
        let name = format!("{number}.{}", sealed.ending);
        let claimed = claims(&name, &sealed.bytes, &Mapping::default()).expect("a sheet");
        let audits: Vec<_> = claimed.iter().map(audit).collect();
        let document = both(|language| report::audit(&name, &audits, language));
        same_in_every_format(&document, &|format| format!("audit of {name}, {format}"));
        // Where a row is marked in the table, it is in the picture.
        let html = String::from_utf8(written(&document, "html")).expect("UTF-8");
        let (words, pictures) = html.split_once("<svg").unwrap_or((&html, ""));
        if words.contains('◀') {
            assert!(pictures.contains(" ◀</text>"), "{name}");
            marked += 1;
        }
    }
    assert!(marked >= 10, "{marked}");
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let files = common::files("budgets", "toml");
    let examples = files
        .iter()
        .filter_map(|path| Example::evaluate(Files::Disk, path, &common::relative(path), &options));
    let verification = Verification {
        environment: Environment {
            version: "0",
            os: "any",
            architecture: "any",
            instruction_set: "any",
            date: "2026-01-31".into(),
        },
        examples: examples.collect(),
        without_claims: Vec::new(),
    };
    let document = both(|language| report::dossier(&verification, language));
    assert_eq!(document.plots().count(), 1);
    same_in_every_format(&document, &|format| format!("verification, {format}"));
}

/// The figures of the sentences of a certificate.
fn statement(document: &Document) -> Figures {
    use gumption::document::Block;
    let sentences = document.blocks().iter().filter_map(|block| match block {
        Block::Statement(sentences) => Some(sentences.join(" ")),
        _ => None,
    });
    figures(&sentences.take(1).collect::<String>())
}

#[test]
fn sheets_are_named_in_the_language_and_titles_stay_with_the_text() {
    let file = root().join("budgets/mass/weight-10kg-ea402-s2.toml");
    let loaded = budget::load(&file).unwrap_or_else(|why| panic!("{}", why.render(false)));
    let of = &loaded.rows[0].budget;
    let evaluation = propagate::evaluate(of, &Options::default()).expect("a value");
    let report = Report {
        budget: of,
        evaluation: &evaluation,
        label: None,
        language: Language::Chinese,
    };
    let document = report::evaluations(&[report], 1).expect("a row");
    let workbook = part(&written(&document, "xlsx"), "xl/workbook.xml");
    let sheets = workbook.split("<sheet name=\"").skip(1);
    let names = sheets.filter_map(|sheet| sheet.split('"').next());
    let foreign: Vec<&str> = names.filter(|name| name.is_ascii()).collect();
    // The sheet that calculates has the name of its measurand.
    assert_eq!(foreign, ["m_X"]);
    let styles = part(&written(&document, "docx"), "word/styles.xml");
    let title = styles.split("w:styleId=\"Title\"").nth(1);
    let title = title.and_then(|title| title.split("</w:style>").next());
    assert!(title.is_some_and(|title| title.contains("<w:keepNext/>")));
}

#[test]
fn every_command_writes_every_format() {
    let folder = folder("commands");
    common::bent_line(&folder);
    let here = |path: &str| root().join(path).display().to_string();
    let commands: [(&str, Vec<String>); 9] = [
        ("diagnose", vec!["case.toml".into()]),
        ("plan", vec!["case.toml".into()]),
        (
            "calibrate",
            vec![here("experiments/gyro-scale-factor.toml")],
        ),
        ("plan", vec![here("experiments/tumble-plan.toml")]),
        (
            "allan",
            ["recording.csv", "--column", "y", "--time", "t"]
                .map(String::from)
                .to_vec(),
        ),
        ("audit", vec![here("docs/examples/claimed-budget.csv")]),
        (
            "fleet",
            vec![
                here("docs/examples/fleet/results.csv"),
                "--by".into(),
                "type".into(),
            ],
        ),
        (
            "verify",
            vec![here("budgets/electrical/resistor-10k-ea402-s3.toml")],
        ),
        ("eval", vec![here("docs/examples/voltage-and-current.toml")]),
    ];
    // A plan in which everything has one cause has none.
    let mut pictured = BTreeSet::new();
    for (command, arguments) in commands {
        let mut all = Vec::new();
        for format in FORMATS {
            let file = folder.join(format!("{command}.{}", format.ending));
            let run = program()
                .current_dir(&folder)
                .args([command, "--lang", "both", "--force", "-o"])
                .arg(&file)
                .args(&arguments)
                .output()
                .expect("the program runs");
            let said = String::from_utf8_lossy(&run.stderr);
            if format.ending == "pdf" && run.status.code() == Some(2) && said.contains("no font") {
                eprintln!("skipped: PDF in both languages needs a font with Chinese letters");
                continue;
            }
            if format.ending == "xml" {
                // Only an evaluation is certified, and only with the data of a certificate.
                assert_eq!(run.status.code(), Some(2), "{command}: {said}");
                assert!(
                    said.contains("certificate") || said.contains("证书"),
                    "{said}"
                );
                continue;
            }
            assert_ne!(
                run.status.code(),
                Some(2),
                "{command} {}: {said}",
                format.name
            );
            all.push((format.name, std::fs::read(&file).expect("written")));
        }
        let of = |name: &str| {
            let (_, bytes) = all.iter().find(|(own, _)| *own == name).expect(name);
            seen(name, bytes)
        };
        let html = of("html");
        let (_, page) = all.iter().find(|(own, _)| *own == "html").expect("a page");
        if String::from_utf8_lossy(page).contains("<svg") {
            pictured.insert(command);
        }
        let what = |format: &str| format!("{command} {arguments:?}, {format}");
        within(&html, &of("docx"), &what("HTML, not in Word"));
        within(&of("docx"), &html, &what("Word, not in HTML"));
        within(&html, &of("markdown"), &what("HTML, not in Markdown"));
    }
    let all = [
        "allan",
        "audit",
        "calibrate",
        "diagnose",
        "eval",
        "fleet",
        "plan",
        "verify",
    ];
    assert_eq!(pictured, BTreeSet::from(all));
}
