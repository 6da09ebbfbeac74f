//! What a format is.

use std::fmt;

use gumption_fault::Said;

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
    /// Writes a document; or says, in the document's language, why it has no such form.
    pub render: fn(&Document, &Page) -> Result<Vec<u8>, Unfit>,
}

impl Format {
    /// Whether it may be shown on a terminal.
    pub fn is_text(&self) -> bool {
        self.media_type.starts_with("text/") || self.media_type == "application/json"
    }
}

/// Why a document cannot be written in a format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unfit(pub Said);

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Unfit {}

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
