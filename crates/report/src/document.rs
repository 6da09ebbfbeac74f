//! What a report consists of, before it is drawn for a terminal or written as Markdown.

use super::table::Table;

/// One block of a report.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Block {
    /// The name of the whole.
    Title(String),
    /// The head of a section.
    Section(String),
    /// Short labelled lines (`Method  In-house procedure 12`).
    Fields(Vec<(String, String)>),
    /// Running text.
    Paragraph(String),
    /// Lines to be kept as they are.
    Formula(Vec<String>),
    /// Rows and columns.
    Table(Table),
    /// Independent sentences.
    List(Vec<String>),
    /// Sentences for the certificate.
    Statement(Vec<String>),
    /// Small print.
    Footer(Vec<String>),
}
