//! The grammar of slips: one entry for each kind, with where it can act and what it does to a calculation.
//!
//! | chapter | holds |
//! |---|---|
//! | `slip` | what a slip is, and what it does |
//! | `rows` | slips in a row |
//! | `whole` | slips between the rows and the statement |
//! | `result` | slips in the result itself |

mod result;
mod rows;
mod slip;
mod whole;

pub(crate) use result::{is_open, of_result, of_unit, other_result};
pub(crate) use rows::is_shown_by_formula;
pub(crate) use whole::{exchanged_digits, rounded};

pub use slip::{Act, Change, Group, Reporting, Slip, Weight};

use crate::calculate::Case;

/// All kinds, those of rows first.
pub fn slips() -> impl Iterator<Item = &'static Slip> {
    rows::SLIPS.iter().chain(whole::SLIPS).chain(result::SLIPS)
}

/// Whether a kind of this name sits in a row, and not between the rows and the statement.
pub fn is_of_a_row(id: &str) -> bool {
    [rows::SLIPS, result::SLIPS]
        .iter()
        .any(|slips| slips.iter().any(|slip| slip.id == id))
}

/// The kind of this name.
pub fn slip(id: &str) -> Option<&'static Slip> {
    slips().find(|slip| slip.id == id)
}

/// Every slip at every place where it can act and changes something.
pub fn acts(case: &Case<'_>) -> Vec<Act> {
    let mut acts = Vec::new();
    for slip in slips() {
        for (row, change) in (slip.acts)(case) {
            let act = Act { slip, row, change };
            let mut changed = case.right.clone();
            act.apply(&mut changed);
            if changed != case.right {
                acts.push(act);
            }
        }
    }
    acts
}
