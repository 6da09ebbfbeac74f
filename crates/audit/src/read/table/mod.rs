//! Tables on a sheet.
//!
//! | chapter | holds |
//! |---|---|
//! | `located` | a table that was found |
//! | `head` | its head: one line, or two |
//! | `content` | what stands in a column, where its head is doubtful |
//! | `locate` | where a table stands, and which rows are its rows |
//! | `pages` | tables that go on on the next page |
//! | `relative` | figures of the whole that are relative to the result |
//! | `rows` | its rows with their figures |
//! | `product` | tables of a product, by their relative uncertainties |
//! | `footers` | the claimed figures of the whole |
//! | `interpret` | what is known of each row |

mod content;
mod footers;
mod head;
mod interpret;
mod locate;
mod located;
mod pages;
mod product;
mod relative;
mod rows;

pub use footers::{footers, of_columns};
pub use interpret::interpret;
pub use locate::locate;
pub use located::Located;
pub use product::{absolute, coefficient, is_product, product};
pub use rows::{Raw, closing, figures_of_result, rows};
