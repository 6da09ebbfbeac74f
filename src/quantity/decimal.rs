//! Decimal numbers: rounding from the decimal string, alignment of an estimate with its uncertainty.

/// A decimal number: sign, digits and exponent, as printed.
#[derive(Debug, Clone, PartialEq)]
pub struct Decimal;

/// How digits beyond the last kept one are rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rounding {
    /// To nearest, ties to even (GB/T 8170, ISO 80000-1 rule A).
    HalfEven,
    /// To nearest, ties away from zero (ISO 80000-1 rule B).
    HalfUp,
    /// Always away from zero.
    Up,
}
