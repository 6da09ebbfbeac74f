//! What files that are written say of units.

use gumption_core::quantity::Unit;
use gumption_format::toml::writing::{key, quoted};

/// The line of a unit; nothing for a number.
pub(crate) fn unit_line(unit: &Unit) -> String {
    match unit.is_one() {
        true => String::new(),
        false => format!("unit = {}\n", quoted(&unit.symbol)),
    }
}

/// The table of a file's own units, by their names and definitions.
pub(crate) fn own_units(units: &[(String, String)]) -> String {
    let line =
        |(name, definition): &(String, String)| format!("{} = {}\n", key(name), quoted(definition));
    match units {
        [] => String::new(),
        units => "\n[unit]\n".to_owned() + &units.iter().map(line).collect::<String>(),
    }
}
