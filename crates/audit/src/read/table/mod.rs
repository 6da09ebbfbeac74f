//! Tables on a sheet.
//!
//! | chapter | holds |
//! |---|---|
//! | `located` | a table that was found |
//! | `head` | its head: one line, or two |
//! | `content` | what stands in a column, where its head is doubtful |
//! | `locate` | where a table stands, and which rows are its rows |
//! | `pages` | tables that go on on the next page |
//! | `relative_columns` | budgets of a product in relative figures, with the absolute ones beside them |
//! | `relative` | figures of the whole that are relative to the result |
//! | `line` | one row, as it stands on the sheet |
//! | `raw` | a row with what is needed to interpret it |
//! | `rows` | all rows with their figures |
//! | `freedom` | degrees of freedom in words |
//! | `sources` | rows that are called as figures of the whole are, and rows below u_c |
//! | `closing` | the row of the result, which closes a table |
//! | `coefficient` | coefficients that a cell writes out as a product |
//! | `product` | tables of a product, by their relative uncertainties |
//! | `footers` | the claimed figures of the whole |
//! | `footer_row` | one row of them |
//! | `labels` | labels side by side, with their figures in the row below |
//! | `contained` | rows that are called contained in others |
//! | `interpret` | what is known of each row |

mod closing;
mod coefficient;
mod contained;
mod content;
mod footer_row;
mod footers;
mod freedom;
mod head;
mod interpret;
mod labels;
mod line;
mod locate;
mod located;
mod pages;
mod product;
mod raw;
mod relative;
mod relative_columns;
mod rows;
mod sources;

pub use closing::{closing, figures_of_result, is_like_source, symbol_of_result};
pub use footers::{footers, footers_beside, of_columns};
pub use freedom::of_cells as freedom_of_cells;
pub use interpret::interpret;
pub use locate::locate;
pub use located::Located;
pub use product::{absolute, coefficient, product, result};
pub use raw::Raw;
pub use rows::rows;
