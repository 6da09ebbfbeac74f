//! Files in TOML that people write: their tables, each defined once, and every fault at its place.

mod edit;
pub mod faults;
mod file;
mod lists;
mod matrix;
mod numbers;
mod places;
mod strings;
mod syntax;
mod table;
mod values;
pub mod writing;

pub use edit::{Content, Unedited, spliced};
pub use file::{decoded, tables_of};
pub use lists::{Named, OneOrMany, as_a_list};
pub use matrix::{Matrices, Matrix, Row};
pub use places::{Form, Places, Statement, Step, Written};
pub use strings::StringMap;
pub use syntax::{document, elsewhere, leaves_the_rest, syntax_faults};
pub use table::{
    FromToml, Hints, Key, KeyRow, Present, Raw, Reader, Slot, Stated, Table, described, doc_text,
    in_order, inner, read_table, schema_of, table, unknown_word, words,
};
pub use values::{Amount, Cell, Date, Dof, amount_for_date, amount_parts, number, unit_of_amount};

// What the macros name.
#[doc(hidden)]
pub use gumption_fault::{Said, say};
#[doc(hidden)]
pub use serde_json::{Map, Value, json};
pub use toml::de::DeValue;
