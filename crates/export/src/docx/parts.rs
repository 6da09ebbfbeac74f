//! The parts of the package beside the text: what there is, how it looks, page numbers.

use gumption_fault::language::Language;

use crate::xml::{Element, element, text};

const MAIN: &str = "http://schemas.openxmlformats.org/wordprocessingml/2006/main";
const RELATIONS: &str = "http://schemas.openxmlformats.org/package/2006/relationships";
const OFFICE: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
const MATHEMATICS: &str = "http://schemas.openxmlformats.org/officeDocument/2006/math";
/// Width of the text in twentieths of a point: a page of A4 less its margins.
pub(super) const WIDTH: f32 = 9638.0;
const TYPES: &str = "application/vnd.openxmlformats-officedocument.wordprocessingml";

/// A root of the main part or a part like it.
pub(super) fn root(name: &'static str) -> Element {
    element(name)
        .attribute("xmlns:w", MAIN)
        .attribute("xmlns:r", OFFICE)
        .attribute("xmlns:m", MATHEMATICS)
}

pub(super) fn content_types() -> Element {
    let default = |ending: &str, kind: &str| {
        element("Default")
            .attribute("Extension", ending)
            .attribute("ContentType", kind)
    };
    let part = |name: &str, kind: String| {
        element("Override")
            .attribute("PartName", name)
            .attribute("ContentType", kind)
    };
    element("Types")
        .attribute(
            "xmlns",
            "http://schemas.openxmlformats.org/package/2006/content-types",
        )
        .with(default(
            "rels",
            "application/vnd.openxmlformats-package.relationships+xml",
        ))
        .with(default("xml", "application/xml"))
        .with(default("emf", "image/x-emf"))
        .with(part(
            "/word/document.xml",
            format!("{TYPES}.document.main+xml"),
        ))
        .with(part("/word/styles.xml", format!("{TYPES}.styles+xml")))
        .with(part("/word/footer1.xml", format!("{TYPES}.footer+xml")))
        .with(part(
            "/docProps/core.xml",
            "application/vnd.openxmlformats-package.core-properties+xml".into(),
        ))
}

fn relation(id: &str, kind: &str, target: &str) -> Element {
    element("Relationship")
        .attribute("Id", id)
        .attribute("Type", kind)
        .attribute("Target", target)
}

pub(super) fn relations() -> Element {
    let properties =
        "http://schemas.openxmlformats.org/package/2006/relationships/metadata/core-properties";
    element("Relationships")
        .attribute("xmlns", RELATIONS)
        .with(relation(
            "rId1",
            &format!("{OFFICE}/officeDocument"),
            "word/document.xml",
        ))
        .with(relation("rId2", properties, "docProps/core.xml"))
}

/// What the text names: styles, footer, and these pictures.
pub(super) fn relations_of_document(pictures: impl Iterator<Item = [String; 2]>) -> Element {
    let image = format!("{OFFICE}/image");
    let images = pictures.map(|[name, file]| relation(&name, &image, &file));
    element("Relationships")
        .attribute("xmlns", RELATIONS)
        .with(relation("rId1", &format!("{OFFICE}/styles"), "styles.xml"))
        .with(relation("rId2", &format!("{OFFICE}/footer"), "footer1.xml"))
        .with_all(images)
}

pub(super) fn properties(title: &str, language: Language) -> Element {
    element("cp:coreProperties")
        .attribute(
            "xmlns:cp",
            "http://schemas.openxmlformats.org/package/2006/metadata/core-properties",
        )
        .attribute("xmlns:dc", "http://purl.org/dc/elements/1.1/")
        .with(text("dc:title", title))
        .with(text(
            "dc:creator",
            concat!("gumption ", env!("CARGO_PKG_VERSION")),
        ))
        .with(text("dc:language", language.pick("en-GB", "zh-CN")))
}

/// The number of the page and of all, as fields that word processors fill in.
pub(super) fn footer() -> Element {
    let field = |code: &str| {
        element("w:fldSimple")
            .attribute("w:instr", code)
            .with(element("w:r").with(text("w:t", "1")))
    };
    let slash = element("w:r").with(text("w:t", " / ").attribute("xml:space", "preserve"));
    let centred = element("w:pPr").with(value("w:jc", "center"));
    let line = element("w:p")
        .with(centred)
        .with(field("PAGE"))
        .with(slash)
        .with(field("NUMPAGES"));
    root("w:ftr").with(line)
}

/// `<name w:val="…"/>`.
pub(super) fn value(name: &'static str, value: impl Into<String>) -> Element {
    element(name).attribute("w:val", value)
}

/// The styles, by names that templates know.
pub(super) fn styles() -> Element {
    let fonts = element("w:rFonts")
        .attribute("w:ascii", "Times New Roman")
        .attribute("w:hAnsi", "Times New Roman")
        .attribute("w:cs", "Times New Roman")
        .attribute("w:eastAsia", "SimSun");
    let tongue = element("w:lang")
        .attribute("w:val", "en-GB")
        .attribute("w:eastAsia", "zh-CN");
    let usual = element("w:docDefaults").with(
        element("w:rPrDefault").with(
            element("w:rPr")
                .with(fonts)
                .with(value("w:sz", "21"))
                .with(tongue),
        ),
    );
    root("w:styles")
        .with(usual)
        .with(style("Normal", "Normal", spacing(60, 60), None))
        .with(style(
            "Title",
            "Title",
            kept(0, 200).with(value("w:jc", "center")),
            Some(("32", true)),
        ))
        .with(style(
            "Heading1",
            "heading 1",
            kept(240, 80).with(value("w:outlineLvl", "0")),
            Some(("24", true)),
        ))
        .with(style(
            "Statement",
            "Statement",
            bordered(),
            Some(("21", false)),
        ))
        .with(style("Cell", "Cell", spacing(10, 10), Some(("18", false))))
        .with(style(
            "SmallCell",
            "Small cell",
            spacing(10, 10),
            Some(("15", false)),
        ))
        .with(style(
            "Small",
            "Small print",
            spacing(40, 0),
            Some(("16", false)),
        ))
        .with(style(
            "ListBullet",
            "List Bullet",
            element("w:pPr").with(
                element("w:ind")
                    .attribute("w:left", "360")
                    .attribute("w:hanging", "240"),
            ),
            None,
        ))
}

fn spacing(before: u32, after: u32) -> Element {
    element("w:pPr").with(space(before, after))
}

/// Stays with what follows it.
fn kept(before: u32, after: u32) -> Element {
    element("w:pPr")
        .with(element("w:keepNext"))
        .with(space(before, after))
}

fn space(before: u32, after: u32) -> Element {
    element("w:spacing")
        .attribute("w:before", before.to_string())
        .attribute("w:after", after.to_string())
}

fn bordered() -> Element {
    let line = element("w:left")
        .attribute("w:val", "single")
        .attribute("w:sz", "18")
        .attribute("w:space", "8")
        .attribute("w:color", "A0A0A0");
    element("w:pPr")
        .with(element("w:pBdr").with(line))
        .with(space(60, 60))
        .with(element("w:ind").attribute("w:left", "200"))
}

fn style(id: &str, name: &str, paragraph: Element, run: Option<(&str, bool)>) -> Element {
    let mut style = element("w:style")
        .attribute("w:type", "paragraph")
        .attribute("w:styleId", id);
    if id == "Normal" {
        style = style.attribute("w:default", "1");
    }
    style = style.with(value("w:name", name));
    if id != "Normal" {
        style = style.with(value("w:basedOn", "Normal"));
    }
    let run = run.map(|(size, bold)| {
        element("w:rPr")
            .with_all(bold.then(|| element("w:b")))
            .with(value("w:sz", size))
    });
    style.with(paragraph).with_all(run)
}
