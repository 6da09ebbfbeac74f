//! What a format is.

use crate::document::Document;

/// A format in which every document can be written.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// Its name, and the flag that asks for it.
    pub name: &'static str,
    /// What the flag gives.
    pub about: &'static str,
    /// Ending of its files.
    pub ending: &'static str,
    /// Its media type (RFC 6838).
    pub media_type: &'static str,
    /// Writes a document.
    pub render: fn(&Document, &Page) -> Vec<u8>,
}

/// What a document is drawn on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Page {
    /// Columns; lines are at most this wide wherever words allow it.
    pub width: usize,
    /// Whether headings may be bold and small print dim (ANSI escapes).
    pub styled: bool,
}

impl Default for Page {
    fn default() -> Self {
        Page {
            width: 100,
            styled: false,
        }
    }
}
