//! Units and dimensions at run time, and the rounding and printing of decimal numbers.

mod advice;
mod builtin;
mod decimal;
mod dimension;
mod factor;
pub mod faults;
mod rounded;
mod symbol;
mod syntax;
mod table;
mod token;
mod unit;

pub use builtin::{BuiltinUnit, Definition, Prefixes, UnitKind};
pub use decimal::{Decimal, Grouping, PowerStyle, Rounding, Style};
pub use dimension::Dimension;
pub use factor::Factor;
pub use faults::UnitError;
pub use rounded::{Rounded, RoundingRule, space_before};
pub use table::{DefinitionError, UnitTable};
pub use unit::{Conversion, Unit, hint_for_clash};
