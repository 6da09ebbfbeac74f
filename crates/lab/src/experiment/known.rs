//! An input or a reading before its check.

use super::tables::KnownTable;
use gumption_core::quantity::Unit;
use gumption_format::toml::Stated;
use gumption_gum::budget::tables::InputTable;

/// A quantity before its check.
pub(crate) struct Known<'t> {
    pub name: &'t str,
    pub entry: &'t Stated<KnownTable>,
    pub unit: Unit,
    /// Its unit in the unit of the readings; 1 for inputs.
    pub factor: f64,
    pub is_reading: bool,
}

impl Known<'_> {
    /// Readings and inputs may have the same name; among quantities they may not. A reading has that of its table in the file,
    /// which is the same in every language.
    pub fn own_name(&self) -> String {
        match self.is_reading {
            true => format!("reading.{}", self.name),
            false => self.name.to_owned(),
        }
    }

    pub fn table(&self) -> &InputTable {
        &self.entry.value.input
    }

    /// Whether nothing doubts it.
    pub fn is_exact(&self) -> bool {
        let table = self.table();
        table.components.is_none() && table.component.present.is_empty()
    }
}
