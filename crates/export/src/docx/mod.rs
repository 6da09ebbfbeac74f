//! A document for word processors: headings, tables of three lines, formulas and statement in styles that a laboratory's
//! template takes over. Office Open XML (ISO/IEC 29500) in the little that documents need, so that the same document
//! gives the same bytes.

mod blocks;
mod emf;
mod parts;
mod pictures;
mod tables;
mod words;

use gumption_fault::say;
use gumption_format::document::{Block, Document};
use gumption_format::render::{Format, Page, Unfit};

use crate::archive;

/// The format.
pub const FORMAT: Format = Format {
    name: "docx",
    about: "Write a document for word processors, with tables, formulas, pictures and the statement",
    ending: "docx",
    media_type: "application/vnd.openxmlformats-officedocument.wordprocessingml.document",
    render,
};

fn render(document: &Document, _: &Page) -> Result<Vec<u8>, Unfit> {
    let unfit = |error: String| Unfit(say!("the document cannot be put together: {error}"));
    let title = document.blocks().iter().find_map(|block| match block {
        Block::Title(title) => Some(title.as_str()),
        _ => None,
    });
    let (text, pictures) = blocks::document(document);
    let parts = [
        ("[Content_Types].xml", parts::content_types()),
        ("_rels/.rels", parts::relations()),
        (
            "docProps/core.xml",
            parts::properties(title.unwrap_or("gumption"), document.language),
        ),
        (
            "word/_rels/document.xml.rels",
            parts::relations_of_document(pictures.relations()),
        ),
        ("word/document.xml", text),
        ("word/footer1.xml", parts::footer()),
        ("word/styles.xml", parts::styles()),
    ];
    let mut members = Vec::new();
    for (name, root) in parts {
        let content = root.document().map_err(|error| unfit(error.to_string()))?;
        members.push((name.to_owned(), content));
    }
    members.extend(pictures.members());
    archive::packed(&members).map_err(unfit)
}
