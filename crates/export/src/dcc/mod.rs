//! An evaluated budget as a digital calibration certificate: DCC 3.3.0 with quantities of the D-SI 2.2.1 (PTB), the figures
//! those of the statement.

mod administration;
mod results;

use gumption_fault::language::Language;
use gumption_fault::say;
use gumption_format::document::{Certificate, Document, Told};
use gumption_format::render::{Format, Page, Unfit};

use crate::xml::{Element, element, text};

/// The format.
pub const FORMAT: Format = Format {
    name: "dcc",
    about: "Write a digital calibration certificate (DCC 3.3.0), with the data of --certificate",
    ending: "xml",
    media_type: "application/xml",
    render,
};

/// The version of the schema.
const VERSION: &str = "3.3.0";

fn render(document: &Document, _: &Page) -> Result<Vec<u8>, Unfit> {
    let certificate = document.certificate.as_deref().ok_or_else(|| {
        Unfit(say!(
            "there is no digital certificate of this; `gumption eval` writes them"
        ))
    })?;
    let administration = certificate.administration.as_ref().ok_or_else(|| {
        Unfit(say!(
            "a digital certificate names the laboratory, the customer and the item: add --certificate FILE, in Python `certified(FILE)` (`gumption new --certificate FILE` writes one to fill in)"
        ))
    })?;
    if certificate.results.is_empty() {
        return Err(Unfit(say!(
            "a digital certificate states results with their U; what is stated with a decision threshold or a detection limit, what is only planned, and units that the D-SI does not have are not written as one: choose another form, such as html, docx or xlsx"
        )));
    }
    let administration = administration.clone().in_languages(&certificate.languages);
    let root = element("dcc:digitalCalibrationCertificate")
        .attribute("xmlns:dcc", "https://ptb.de/dcc")
        .attribute("xmlns:si", "https://ptb.de/si")
        .attribute("schemaVersion", VERSION)
        .with(administration::element(certificate, &administration))
        .with(results::element(certificate, &administration));
    root.document().map_err(|error| {
        let error = error.to_string();
        Unfit(say!("the certificate cannot be put together: {error}"))
    })
}

/// ISO 639-1.
fn code(language: Language) -> &'static str {
    language.pick("en", "zh")
}

/// A text in its languages.
fn told(name: &'static str, told: &Told) -> Element {
    let contents = told.0.iter().map(|(language, words)| {
        let content = text("dcc:content", words.as_str());
        match language {
            Some(language) => content.attribute("lang", code(*language)),
            None => content,
        }
    });
    element(name).with_all(contents)
}

/// Words of the program in the languages of the certificate.
fn words(certificate: &Certificate, name: &'static str, english: &str, chinese: &str) -> Element {
    let languages = certificate.languages.iter();
    let all = languages.map(|one| (Some(*one), one.pick(english, chinese).to_owned()));
    told(name, &Told(all.collect()))
}

/// A text without white space at its ends, and with single spaces inside, as the schema wants it.
fn tidy(name: &'static str, words: &str) -> Element {
    let words: Vec<&str> = words.split_whitespace().collect();
    text(name, words.join(" "))
}
