//! Codes of the faults in measurement equations.

use crate::fault::Code;

/// The left side of an equation is not observed.
pub const NO_RESPONSE: Code = Code {
    id: "Q0101",
    title: "the left side of an equation is not observed",
    explanation: "An equation says what an observed quantity should be: its left side is the name of a column (or of the known quantity that a combination of readings must give), its right side the formula.\n\n    U = K * omega + b      U is read from the recording",
};

/// A response has two equations.
pub const TWO_EQUATIONS: Code = Code {
    id: "Q0102",
    title: "a response has two equations",
    explanation: "Each observed quantity has one equation. What holds for some rows only is said within it, with `if`, or by quantities that differ from row to row.",
};

/// All codes of this module.
pub const CODES: &[Code] = &[NO_RESPONSE, TWO_EQUATIONS];
