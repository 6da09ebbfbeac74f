//! What writers of budgets mistake, beyond misspelt words.

use gumption_fault::{Said, say};
use gumption_format::toml::{Hints, Table};

use super::tables::FileTable;

/// The mistakes of writers of budgets.
pub static HINTS: Hints = Hints {
    synonyms: &SYNONYMS,
    top: FileTable::keys,
    unknown_key,
    list_of_amounts: say!(
        "readings of one quantity are `readings = […]`, the elements of a vector `values = […]`"
    ),
};

/// Words that people try for the keys of an uncertainty, and those keys.
pub const SYNONYMS: [(&str, &str); 22] = [
    ("a", "half_width"),
    ("halfwidth", "half_width"),
    ("tolerance", "half_width"),
    ("std", "u"),
    ("stdev", "u"),
    ("sd", "u"),
    ("sigma", "u"),
    ("uncertainty", "u"),
    ("standard_uncertainty", "u"),
    ("resolution", "step"),
    ("q", "step"),
    ("data", "readings"),
    ("observations", "readings"),
    ("measurements", "readings"),
    ("dist", "distribution"),
    ("pdf", "distribution"),
    ("nu", "dof"),
    ("degrees_of_freedom", "dof"),
    ("degf", "dof"),
    ("estimate", "value"),
    ("mean", "value"),
    ("formula", "model"),
];

/// Keys of an uncertainty that stand in the wrong place.
pub fn unknown_key(key: &str, table: &str, known: &[&'static str]) -> Option<Said> {
    // `U` must not be taken for a misspelt `u`: they differ by the coverage factor.
    if matches!(key, "U" | "k" | "expanded") && known.contains(&"certificate") {
        return Some(say!(
            "an expanded uncertainty stands with its k: certificate = {{ U = …, k = 2 }}"
        ));
    }
    let beside = ["specification", "certificate"].contains(&table)
        && ["p", "k", "dof", "distribution", "name"].contains(&key);
    beside.then(|| say!("`{key}` stands beside `{table}`, not in it"))
}
