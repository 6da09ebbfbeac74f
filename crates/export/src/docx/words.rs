//! Words with their looks.

use gumption_format::render::inline::{Run, runs};

use super::parts::value;
use crate::xml::{Element, element, text};

/// The style of a paragraph.
pub(super) fn of_style(style: &str) -> Element {
    element("w:pPr").with(value("w:pStyle", style))
}

/// A text between backquotes of equal widths, powers of ten raised.
pub(super) fn runs_of(words: &str, bold: bool) -> Vec<Element> {
    let runs = runs(words).into_iter().map(|one| match one {
        Run::Plain(words) => run(words, bold.then(|| element("w:b"))),
        Run::Code(words) => {
            let fonts = element("w:rFonts")
                .attribute("w:ascii", "Courier New")
                .attribute("w:hAnsi", "Courier New");
            run(words, Some(fonts))
        }
        Run::Raised(words) => {
            let words = words.replace('-', "−");
            run(&words, Some(value("w:vertAlign", "superscript")))
        }
    });
    runs.collect()
}

/// Words that all look alike.
pub(super) fn run(words: &str, looks: Option<Element>) -> Element {
    // Word processors part words where they like.
    let words = words.replace(['\u{ad}', '\u{200b}', '\u{2060}'], "");
    element("w:r")
        .with_all(looks.map(|looks| element("w:rPr").with(looks)))
        .with(text("w:t", words).attribute("xml:space", "preserve"))
}
