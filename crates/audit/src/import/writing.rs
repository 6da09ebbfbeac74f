//! What the tables of an imported file are made of.

use gumption_core::quantity::to_digits;
use gumption_fault::Said;
use gumption_fault::language::Language;
use gumption_format::toml::writing;

use crate::claim::Claimed;
use crate::units;

/// The rows of the quantity of a row: in a model several rows of one symbol are reasons to doubt one input.
pub(super) fn of_symbol(claimed: &Claimed, i: usize) -> Vec<usize> {
    let symbol = &claimed.rows[i].symbol;
    let is_of_it = |j: &usize| *j == i || !symbol.is_empty() && claimed.rows[*j].symbol == *symbol;
    (0..claimed.rows.len()).filter(is_of_it).collect()
}

/// What a reader should know, as a comment in a line of its own.
pub(super) fn remark(said: Said, language: Language) -> String {
    format!("# {}\n", comment(&said.in_language(language)))
}

/// The line of a unit that is known, in symbols.
pub(super) fn line_of_unit(unit: &str) -> String {
    match units::parse(unit) {
        Some(_) => writing::line("unit", &units::in_symbols(unit)),
        None => String::new(),
    }
}

pub(crate) fn comment(text: &str) -> String {
    let plain: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    plain.trim_matches([' ', ';']).to_string()
}

/// A number as it was typed: no digits that a product of doubles adds.
pub(crate) fn number(x: f64) -> String {
    writing::number(to_digits(x, 13))
}
