//! Units and dimensions at run time, and the rounding and printing of decimal numbers.

mod decimal;
mod dimension;
mod unit;

pub use decimal::{Decimal, Rounding};
pub use dimension::Dimension;
pub use unit::{Factor, Unit, UnitError, UnitTable};
