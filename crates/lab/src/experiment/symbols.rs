//! Symbols and texts of equations from what a file states.

use gumption_core::equations::{EquationText, Quantity};
use gumption_core::model::{Role, Symbol};
use gumption_core::quantity::Unit;
use gumption_format::toml::Stated;

/// An equation and its place.
pub(crate) fn equation_text(stated: &Stated<String>) -> EquationText<'_> {
    EquationText {
        text: &stated.value,
        at: stated.span.clone(),
    }
}

/// A name with its unit.
pub(crate) fn quantity(name: &str, unit: &Unit) -> Quantity {
    Quantity {
        name: name.to_owned(),
        unit: unit.clone(),
    }
}

/// A symbol for the inference of units, where its place does not matter.
pub(crate) fn symbol(quantity: Quantity) -> Symbol {
    Symbol {
        name: quantity.name.into(),
        unit: quantity.unit,
        role: Role::Input(0),
    }
}
