//! Error codes of units, with their explanations.

use std::ops::Range;

use gumption_fault::{Code, Fault, Said};

/// Why a unit text was refused.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitError {
    /// Which kind of fault.
    pub code: Code,
    /// Bytes of the unit text.
    pub span: Range<usize>,
    /// One sentence without a final stop.
    pub message: Said,
    /// The mend, in the imperative; boxed, which keeps the error small enough to be returned by value.
    pub help: Option<Box<Said>>,
}

impl UnitError {
    pub(super) fn new(code: Code, span: Range<usize>, message: impl Into<Said>) -> Self {
        UnitError {
            code,
            span,
            message: message.into(),
            help: None,
        }
    }

    #[must_use]
    pub(super) fn help(mut self, help: impl Into<Said>) -> Self {
        self.help = Some(Box::new(help.into()));
        self
    }
}

impl From<UnitError> for Fault {
    fn from(error: UnitError) -> Fault {
        Fault {
            help: error.help.map(|help| *help),
            ..Fault::new(error.code, error.span, error.message).label(error.code.said())
        }
    }
}

/// All codes of this module, for `gumption explain`.
pub const CODES: &[Code] = &[
    UNKNOWN_UNIT,
    MALFORMED_UNIT,
    AMBIGUOUS_SOLIDUS,
    NUMBER_IN_UNIT,
    BAD_EXPONENT,
    EMPTY_UNIT,
    BAD_DEFINITION,
];

/// A name that is no unit.
pub(super) const UNKNOWN_UNIT: Code = Code {
    id: "U001",
    title: "unknown unit",
    title_zh: "未知的单位符号",
    explanation: "\
The name is neither a unit that gumption knows, nor a prefix followed by one, nor a unit of the \
file's own [unit] table. Upper and lower case matter: mV and MV, s and S, Pa and pA are different. \
A unit of your own is declared once per file:

    [unit]
    FS = \"10 V\"
    tick = \"1\"",
};

/// A unit text that does not follow the syntax.
pub(super) const MALFORMED_UNIT: Code = Code {
    id: "U002",
    title: "malformed unit",
    title_zh: "单位的写法有误",
    explanation: "\
A unit is written as a product of names with exponents: `m/s^2`, `m·s^-2`, `µV/(V·K)`, `°/√h`. \
Products are `·`, `*` or a space, quotients `/`, powers `^2`, `**2` or `²`; parentheses group.",
};

/// A product after a solidus.
pub(super) const AMBIGUOUS_SOLIDUS: Code = Code {
    id: "U003",
    title: "ambiguous solidus",
    title_zh: "单位中的斜线有歧义",
    explanation: "\
`W/m·K` is read by some as W/(m·K) and by others as (W/m)·K, a factor of K² apart. ISO 80000-1 and \
the SI Brochure therefore ask for parentheses or negative exponents: `W/(m·K)`, `W·m^-1·K^-1`.",
};

/// A number other than 1 in a unit.
pub(super) const NUMBER_IN_UNIT: Code = Code {
    id: "U004",
    title: "number in a unit",
    title_zh: "单位中含有数字",
    explanation: "\
A unit text holds names only; the number 1 alone stands for dimension one and may be a numerator \
(`1/K`). Numbers belong to values, or to a definition in the file's own table:

    [unit]
    rev = \"2 pi rad\"
    FS = \"10 V\"",
};

/// An exponent that is no small rational number.
pub(super) const BAD_EXPONENT: Code = Code {
    id: "U005",
    title: "unfit exponent",
    title_zh: "单位的指数不可用",
    explanation: "\
Exponents of units are whole numbers or simple fractions between -60 and 60: `m^2`, `s^-1`, \
`Hz^(1/2)`, `Hz^0.5`. The root may also be written `√Hz` or `sqrt(Hz)`. Fractions need parentheses, \
because `s^1/2` means (s^1)/2.",
};

/// An empty unit text.
pub(super) const EMPTY_UNIT: Code = Code {
    id: "U006",
    title: "empty unit",
    title_zh: "单位为空",
    explanation: "\
A quantity of dimension one has the unit \"1\" (or %, ppm, rad, ° …). An empty text leaves open \
whether the unit was forgotten.",
};

/// A definition in the `[unit]` table that cannot be used.
pub(super) const BAD_DEFINITION: Code = Code {
    id: "U007",
    title: "unfit definition of a unit",
    title_zh: "单位的定义不可用",
    explanation: "\
A file's own units are defined by other units, with a positive number if need be; the order does not \
matter, but no unit may depend on itself. The name must be a single name as it would stand in a unit \
text, without operators, and may replace a built-in one:

    [unit]
    g = \"9.80665 m/s^2\"
    count = \"1\"",
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_explained() {
        for (i, code) in CODES.iter().enumerate() {
            assert_eq!(code.id, format!("U{:03}", i + 1));
            assert!(code.explanation.len() > 80 && !code.title.ends_with('.'));
        }
    }

    #[test]
    fn an_error_becomes_a_fault_at_the_same_place() {
        let fault: Fault = UnitError::new(UNKNOWN_UNIT, 2..4, "no").help("mend").into();
        assert_eq!(
            (fault.span, fault.label.to_string()),
            (2..4, "unknown unit".into())
        );
        assert_eq!(
            fault.help.map(|help| help.to_string()).as_deref(),
            Some("mend")
        );
    }
}
