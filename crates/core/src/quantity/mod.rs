//! Units and dimensions at run time, and the rounding and printing of decimal numbers.

mod advice;
mod builtin;
mod chinese;
mod clash;
mod decimal;
mod dimension;
#[cfg(test)]
mod docs;
mod dsi;
mod factor;
pub mod faults;
mod print;
mod revolutions;
mod rounded;
mod show;
mod square;
mod symbol;
mod syntax;
mod table;
mod token;
mod unit;

pub use advice::symbol_of_name;
pub use builtin::{BuiltinUnit, Definition, Prefixes, UnitKind, units};
pub use chinese::unit_of_chinese;
pub use clash::{bare_coulomb, hint_for_clash, per_coulomb};
pub use decimal::{Decimal, Rounding};
pub use dimension::Dimension;
pub use factor::Factor;
pub use faults::UnitError;
pub use print::PowerStyle;
pub use revolutions::revolutions_as_angle;
pub(crate) use revolutions::{counts, revolutions_in, unit_of_angle};
pub use rounded::{Rounded, RoundingRule, space_before};
pub use show::{show, show_apart, to_digits};
pub use table::{DefinitionError, UnitTable};
pub use unit::{Conversion, Unit, UnitParts};
