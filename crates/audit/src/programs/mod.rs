//! Files of other programs for uncertainty budgets: what they state, in one form for all of them.
//!
//! | chapter | holds |
//! |---|---|
//! | `statement` | what such a file states: equations, inputs, reasons for doubt |
//! | `trouble` | where a file is not understood, and why |
//! | `formula` | formulas of other programs in the language of models |
//! | `numbers` | numbers as these files write them |
//! | `units` | units as these files write them |
//! | `yaml` | YAML with the place of every value |
//! | `suncal`, `uncertainty_machine`, `gum_workbench`, `uncertradio` | one program each |
//! | `dimension` | whether units hold in formulas |
//! | `claims` | a statement as claims to be audited |
//! | `budget` | a statement as a budget file |
//!
//! The readers are strict: what is not understood is refused at its place, because a figure that is guessed or passed over
//! would make another budget of it.

mod budget;
mod claims;
mod dimension;
mod formula;
mod gum_workbench;
mod numbers;
mod statement;
mod suncal;
#[cfg(test)]
mod tests;
mod trouble;
mod uncertainty_machine;
mod uncertradio;
mod units;
mod yaml;

pub(crate) use budget::budget_file;
pub use claims::claims;
pub use statement::Statement;

use gumption_fault::say;

use crate::sheet::Unreadable;
use trouble::Trouble;

/// A program whose files are read.
struct Program {
    /// As it calls itself.
    name: &'static str,
    /// Endings of its files.
    endings: &'static [&'static str],
    /// What every file of it has in it, by which one with another ending is known.
    signs: &'static [&'static str],
    /// Whether its files may be in the single-byte encoding of Western Europe.
    is_western: bool,
    /// Reads a file.
    read: fn(&str) -> Result<Vec<Statement>, Trouble>,
}

/// All of them.
const PROGRAMS: [Program; 4] = [
    suncal::PROGRAM,
    uncertainty_machine::PROGRAM,
    gum_workbench::PROGRAM,
    uncertradio::PROGRAM,
];

/// The budgets of a file of another program, or `None` for a file that is none.
///
/// # Errors
/// The first place that is not understood.
pub fn statements(name: &str, bytes: &[u8]) -> Option<Result<Vec<Statement>, Unreadable>> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_lowercase();
    let by_ending = PROGRAMS
        .iter()
        .find(|program| program.endings.contains(&ending.as_str()));
    let by_signs = || {
        let text = std::str::from_utf8(bytes).ok()?;
        let known = |program: &&Program| program.signs.iter().all(|sign| text.contains(sign));
        (ending == "txt").then(|| PROGRAMS.iter().find(known))?
    };
    let program = by_ending.or_else(by_signs)?;
    let statements = program.text(bytes).and_then(|text| {
        let read = (program.read)(&text).map(|statements| {
            let settled = statements.into_iter().map(Statement::with_units_that_hold);
            settled.collect()
        });
        read.map_err(|trouble| {
            let Trouble { line, column, why } = trouble;
            let name = program.name;
            Unreadable(say!(
                "line {line}, column {column} of this file of {name}: {why}"
            ))
        })
    });
    Some(statements)
}

impl Program {
    fn text(&self, bytes: &[u8]) -> Result<String, Unreadable> {
        if self.is_western
            && !bytes.starts_with(&[0xff, 0xfe])
            && std::str::from_utf8(bytes).is_err()
        {
            return Ok(bytes.iter().map(|byte| char::from(*byte)).collect());
        }
        crate::sheet::decoded(bytes)
    }
}
