//! What every fuzz target does with some bytes: nothing may panic, hang or command a terminal.
//!
//! One function for each kind of file that a user hands in or is sent. The fuzzer calls them (`fuzz_targets/`), and so
//! does `cargo test` with every file of `corpus/`. Where a kind has several endings, the first byte says which one.

// Each fuzz target uses one of the functions.
#![allow(dead_code)]

use std::path::{Path, PathBuf};

use gumption::audit::read::Mapping;
use gumption::audit::sheet::Unreadable;
use gumption::audit::{self, Audit};
use gumption::budget::Budget;
use gumption::calibrate;
use gumption::experiment::Purpose;
use gumption::model::{self, MeasurandSource, Role, Symbol};
use gumption::propagate::{self, MonteCarloChoice, Options};
use gumption::quantity::UnitTable;
use gumption::recording::Recording;
use gumption::render::{FORMATS, Page, archive};
use gumption::report::{self, Language, Report};
use gumption::{Files, Rejection};

/// A name, and what is done with bytes.
pub type Target = (&'static str, fn(&[u8]));

/// The targets by name, as in `fuzz_targets/` and `corpus/`.
pub const TARGETS: &[Target] = &[
    ("budget", budget),
    ("language", language),
    ("units", units),
    ("csv", csv),
    ("experiment", experiment),
    ("saved", saved),
    ("statement", statement),
    ("workbook", workbook),
    ("claim", claim),
    ("program", program),
    ("dcc", dcc),
    ("packed", packed),
    ("administration", administration),
];

thread_local! {
    /// The units that are built in: they do not change, and a table for every text would take longer than the text.
    static UNITS: UnitTable = UnitTable::default();
}

/// A budget file, read and checked, beside a table of values and another budget that it may name.
pub fn budget(bytes: &[u8]) {
    let _ = budgets(bytes);
}

/// A budget file, evaluated, and everything that is said of it in every form.
pub fn statement(bytes: &[u8]) {
    let Some(budgets) = budgets(bytes) else {
        return;
    };
    evaluated(&budgets);
}

/// Formulas over inputs of several units.
pub fn language(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        UNITS.with(|units| formula(text, units));
    }
}

fn formula(text: &str, units: &UnitTable) {
    let symbol = |(name, unit, role): (&str, &str, Role)| Symbol {
        name: name.into(),
        unit: units
            .parse(unit)
            .unwrap_or_else(|_| gumption::quantity::Unit::one()),
        role,
    };
    let symbols: Vec<Symbol> = [
        ("a", "1", Role::Input(0)),
        ("b", "1", Role::Input(1)),
        ("U", "V", Role::Input(2)),
        ("t", "°C", Role::Input(3)),
        ("v", "1", Role::InputVector(4..8)),
        ("w", "mm", Role::ConstantVector(vec![1.0, 2.0, 4.0, 8.0])),
        ("g", "m/s^2", Role::Constant(9.8)),
    ]
    .into_iter()
    .map(symbol)
    .collect();
    let measurand = |unit: &str| MeasurandSource {
        name: "Y",
        model: Some(text),
        unit: units.parse(unit).ok(),
    };
    for unit in ["1", "V"] {
        let compiled = model::compile(&model::Request {
            symbols: &symbols,
            shared: None,
            measurands: &[measurand(unit)],
            units,
        });
        match compiled {
            Ok(model) => {
                let x = [0.5, 2.0, 10.0, 20.0, 1.0, 2.0, 3.0, 4.0];
                assert_eq!(model.values(&x).len(), model.outputs().len());
                let _ = (model.gradients(&x), model.along(&x, &[1.0; 8]));
                let _ = (model.undefined(&x), model.irregularities(&x));
                let _ = model.near_singular(&x, &[0.1; 8], 2.0);
            }
            Err(faults) => {
                let faults = faults.into_iter().map(|found| found.fault).collect();
                said(&Rejection::new("model", text, faults));
            }
        }
    }
}

/// A unit, and a definition by it; what is read once is read again from its own symbol.
pub fn units(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let mut units = UnitTable::default();
    if let Ok(unit) = units.parse(text) {
        assert_eq!(units.parse(&unit.symbol).as_ref(), Ok(&unit));
    }
    let (name, definition) = text.split_once('=').unwrap_or(("own", text));
    if units.define(name, definition).is_ok() {
        let _ = units.parse(&format!("m{name}/s"));
    }
    let _ = units.define_all([(name, definition), ("other", name), (definition, "other")]);
}

/// A table of values: as a recording, as readings of an input, and as a series.
pub fn csv(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes)
        && let Err(rejection) = UNITS.with(|units| Recording::read_all("data.csv", text, units))
    {
        said(&rejection);
    }
    let main = "title = \"t\"\n[measurand.Y]\nmodel = \"V\"\nunit = \"mV\"\n\
        [input.V]\nunit = \"mV\"\nreadings = { file = \"data.csv\", column = \"V\" }\n";
    let _ = read(&[("budget.toml", main.as_bytes()), ("data.csv", bytes)]);
}

/// An experiment, with the recordings of the library beside it.
pub fn experiment(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let folder = root().join("experiments");
    for purpose in [Purpose::Calibrate, Purpose::Plan] {
        match (
            calibrate::read(text, "experiment.toml", &folder, purpose),
            purpose,
        ) {
            (Err(rejection), _) => said(&rejection),
            (Ok(read), Purpose::Calibrate) => {
                if let Ok(found) = calibrate::calibrate(&read) {
                    for language in [Language::English, Language::Chinese] {
                        shown(&report::calibration(&read, &found, language));
                    }
                }
            }
            (Ok(read), _) => {
                if let Ok(plan) = calibrate::plan(&read) {
                    shown(&report::plan(&read, &plan, Language::English));
                }
            }
        }
    }
}

/// Saved results, and a budget that goes on from them.
pub fn saved(bytes: &[u8]) {
    let main = b"title = \"t\"\n[measurand.Y]\nmodel = \"2*V\"\nunit = \"V\"\n\
        [input]\nV = { unit = \"V\", from = { result = \"saved.json\", measurand = \"V\" } }\n";
    if let Some(budgets) = read(&[("budget.toml", main.as_slice()), ("saved.json", bytes)]) {
        evaluated(&budgets);
    }
}

/// A workbook: as it comes, or its one sheet in a workbook that is whole.
pub fn workbook(bytes: &[u8]) {
    let Some((first, rest)) = bytes.split_first() else {
        return;
    };
    let framed = |frame: &[(&str, &[u8])], sheet: &str| {
        let members = frame.iter().copied().chain([(sheet, rest)]);
        let members = members.map(|(name, content)| (name.to_owned(), content.to_vec()));
        archive::packed(&members.collect::<Vec<_>>()).expect("an archive")
    };
    let (ending, bytes) = match first % 5 {
        0 => ("xlsx", rest.to_vec()),
        1 => ("xls", rest.to_vec()),
        2 => ("ods", rest.to_vec()),
        3 => ("xlsx", framed(XLSX, "xl/worksheets/sheet1.xml")),
        _ => ("ods", framed(ODS, "content.xml")),
    };
    read_and_imported(&format!("claim.{ending}"), &bytes);
}

/// What surrounds the sheet of a workbook of Microsoft.
const XLSX: &[(&str, &[u8])] = &[
    (
        "[Content_Types].xml",
        br#"<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"/>"#,
    ),
    (
        "xl/workbook.xml",
        br#"<workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets><sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>"#,
    ),
    (
        "xl/_rels/workbook.xml.rels",
        br#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet1.xml"/></Relationships>"#,
    ),
    (
        "xl/sharedStrings.xml",
        br#"<sst xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><si><t>Quantity</t></si><si><t>u</t></si></sst>"#,
    ),
];

/// The same of OpenDocument.
const ODS: &[(&str, &[u8])] = &[(
    "mimetype",
    b"application/vnd.oasis.opendocument.spreadsheet",
)];

/// A claimed budget as text.
pub fn claim(bytes: &[u8]) {
    let Some((first, rest)) = bytes.split_first() else {
        return;
    };
    let ending = ["csv", "md", "txt", "tsv"][usize::from(*first) % 4];
    read_and_imported(&format!("claim.{ending}"), rest);
    /// The search for slips takes longer than the reading by far.
    const MOST: usize = 400;
    if let Ok(claims) = audit::claims(&format!("claim.{ending}"), rest, &Mapping::default())
        && rest.len() <= MOST
    {
        let audits: Vec<Audit<'_>> = claims.iter().map(audit::audit).collect();
        for language in [Language::English, Language::Chinese] {
            shown(&report::audit("claim", &audits, language));
        }
    }
}

/// A file of another program.
pub fn program(bytes: &[u8]) {
    if let Some((first, rest)) = bytes.split_first() {
        let ending = ["yaml", "um", "smu", "txp"][usize::from(*first) % 4];
        read_and_imported(&format!("claim.{ending}"), rest);
    }
}

/// Claims, and the budget files that are made of them: whatever was read, they are files that are read again without
/// trouble for the reader.
fn read_and_imported(name: &str, bytes: &[u8]) {
    let mapping = Mapping::default();
    let claims = audit::claims(name, bytes, &mapping);
    let files = audit::budget_files(name, bytes, &mapping, Language::English);
    assert_eq!(claims.is_ok(), files.is_ok());
    match files {
        Ok(files) => {
            for file in files {
                let _ = read(&[("budget.toml", file.as_bytes())]);
            }
        }
        Err(Unreadable(why)) => {
            for language in [Language::English, Language::Chinese] {
                harmless(&gumption::fault::harmless(&why.in_language(language)));
            }
        }
    }
}

/// A digital certificate that a budget names.
pub fn dcc(bytes: &[u8]) {
    let main = b"[measurand.R]\nmodel = \"r * R_ref\"\nunit = \"ohm\"\n[input.R_ref]\n\
        certificate = { dcc = \"dcc.xml\" }\n[input]\nr = { value = 1, u = 3e-6 }\n";
    if let Some(budgets) = read(&[("budget.toml", main.as_slice()), ("dcc.xml", bytes)]) {
        evaluated(&budgets);
    }
}

/// An archive: what comes out goes in again and comes out the same.
pub fn packed(bytes: &[u8]) {
    if let Ok(members) = archive::unpacked(bytes)
        && let Ok(again) = archive::packed(&members)
    {
        assert_eq!(archive::unpacked(&again), Ok(members));
    }
}

/// The laboratory's data of a certificate.
pub fn administration(bytes: &[u8]) {
    let files = [("laboratory.toml", bytes)];
    if let Err(rejection) =
        report::administration(Files::Library(&files), Path::new("laboratory.toml"))
    {
        said(&rejection);
    }
}

fn budgets(bytes: &[u8]) -> Option<Vec<Budget>> {
    const OTHER: &str = "title = \"o\"\n[measurand.V]\nmodel = \"x\"\nunit = \"V\"\n\
        [input]\nx = { value = 5, unit = \"V\", u = 0.01 }\n";
    const DATA: &str = "U,V [mV]\n1.0001,3\n1.0003,4\n1.0000,5\n1.0002,6\n";
    read(&[
        ("budget.toml", bytes),
        ("readings.csv", DATA.as_bytes()),
        ("voltage.toml", OTHER.as_bytes()),
    ])
}

fn read(files: &[(&str, &[u8])]) -> Option<Vec<Budget>> {
    match gumption::read(Files::Library(files), "budget.toml") {
        Ok(budgets) => Some(budgets),
        Err(gumption::Error::Rejected(rejection)) => {
            said(&rejection);
            None
        }
        Err(_) => None,
    }
}

/// Evaluates without trials, and says everything.
fn evaluated(budgets: &[Budget]) {
    /// Of a long series a few rows.
    const MOST: usize = 3;
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        threads: 1,
        ..Options::default()
    };
    for budget in budgets.iter().take(MOST) {
        let Ok(evaluation) = propagate::evaluate(budget, &options) else {
            continue;
        };
        for language in [Language::English, Language::Chinese] {
            let report = Report {
                budget,
                evaluation: &evaluation,
                label: None,
                language,
            };
            shown(&report::evaluation(&report));
            let _ = report::saved(&[report], Path::new("."));
        }
    }
}

/// A refusal in both languages.
fn said(rejection: &Rejection) {
    assert!(!rejection.faults.is_empty() || !rejection.others.is_empty());
    for language in [Language::English, Language::Chinese] {
        harmless(&rejection.render_in(language, false));
    }
}

/// A document in every form.
fn shown(document: &gumption::document::Document) {
    for format in FORMATS.iter().filter(|format| format.is_text()) {
        let bytes = (format.render)(document, &Page::default()).unwrap_or_default();
        harmless(&String::from_utf8_lossy(&bytes));
    }
}

/// Nothing that a terminal obeys.
fn harmless(text: &str) {
    let obeyed = text.chars().find(|c| gumption::fault::is_obeyed(*c));
    assert_eq!(obeyed, None, "{text:?}");
}

/// The folder of the repository, from the crate that is compiled.
fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut above = here.ancestors();
    let root = above.find(|folder| folder.join("experiments").is_dir());
    root.unwrap_or(here).to_path_buf()
}
