//! The machine form as JSON.

use super::format::{Format, Page};
use crate::document::Document;

pub(super) const FORMAT: Format = Format {
    name: "json",
    about: "Print JSON: exact numbers, stable names (`gumption schema` lists the schemas)",
    ending: "json",
    media_type: "application/json",
    render,
};

fn render(document: &Document, _: &Page) -> Vec<u8> {
    format!("{:#}\n", document.machine).into_bytes()
}
