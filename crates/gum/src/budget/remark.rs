//! Remarks.

/// A remark for the reader of the report, in both languages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// In English.
    pub en: String,
    /// In Chinese.
    pub zh: String,
}
