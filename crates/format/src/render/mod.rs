//! The formats in which a document is written. A new format is one file here and one line in [`FORMATS`]; every
//! command has it at once.

mod format;
mod html;
mod json;
pub mod markdown;
mod svg;
pub mod text;

pub use format::{Format, Page};
pub use svg::svg;

/// Every format; the first is the one that is printed where none is asked for.
pub const FORMATS: &[Format] = &[text::FORMAT, markdown::FORMAT, html::FORMAT, json::FORMAT];

/// The format of a name.
pub fn named(name: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.name == name)
}

/// The format of a file's ending.
pub fn with_ending(ending: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.ending == ending)
}
