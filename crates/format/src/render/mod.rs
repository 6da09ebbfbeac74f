//! The formats of text in which a document is written, and what all formats have in common. The list of all of them is in
//! the crate `export`, with those that rest on large libraries.

pub mod drawing;
mod format;
pub mod html;
pub mod inline;
pub mod json;
pub mod markdown;
pub mod parts;
mod svg;
pub mod text;

pub use format::{Format, Page, Unfit};
pub use svg::svg;
