//! Documents in the formats that laboratories hand over, and the list of all formats; tables in a format of engines.
//!
//! What rests on large libraries stands here, above `gumption_format`, so that whatever composes documents is compiled
//! without them.

pub mod archive;

mod columns;
mod dcc;
mod docx;
#[cfg(feature = "parquet")]
pub mod parquet;
#[cfg(feature = "pdf")]
mod pdf;
mod xlsx;
mod xml;

pub use gumption_format::render::{Format, Page, Unfit, html, json, markdown, svg, text};

/// Every format; the first is the one that is printed where none is asked for.
pub const FORMATS: &[Format] = &[
    text::FORMAT,
    markdown::FORMAT,
    html::FORMAT,
    json::FORMAT,
    xlsx::FORMAT,
    docx::FORMAT,
    dcc::FORMAT,
    #[cfg(feature = "pdf")]
    pdf::FORMAT,
];

/// The format of a name.
pub fn named(name: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.name == name)
}

/// The format of a file's ending.
pub fn with_ending(ending: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.ending == ending)
}
