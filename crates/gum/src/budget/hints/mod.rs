//! What writers of budgets mistake, beyond misspelt words.

mod keys;
mod values;
mod words;

pub use keys::unknown_key;
pub use values::{no_table, wrong_type};
pub use words::SYNONYMS;

use gumption_fault::say;
use gumption_format::toml::{Hints, Table};

use super::tables::FileTable;

/// The mistakes of writers of budgets.
pub static HINTS: Hints = Hints {
    whole: say!("a budget"),
    synonyms: &SYNONYMS,
    top: FileTable::keys,
    unknown_key,
    no_table,
    wrong_type,
    list_of_amounts: say!(
        "readings of one quantity are `readings = […]`, the elements of a vector `values = […]`, with u = […] for one u of each"
    ),
};
