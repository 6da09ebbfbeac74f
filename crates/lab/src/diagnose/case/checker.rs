//! Checks that only a diagnosis needs of an experiment's names.

use super::Column;
use crate::diagnose::faults::UNKNOWN_NAME;
use crate::experiment::checker::Checker;
use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::Stated;

impl Checker<'_> {
    /// A column that a key names.
    pub(super) fn known(&mut self, name: &Stated<String>, columns: &[Column]) -> Option<usize> {
        let found = columns.iter().position(|column| column.name == name.value);
        if found.is_none() {
            let names = columns.iter().map(|column| column.name.as_str());
            let message = say!("the experiment has no column {}", name.value);
            let fault = Fault::new(UNKNOWN_NAME, name.span.clone(), message)
                .label(say!("not a column of this experiment"));
            let declare = say!("declare it below [columns]");
            self.faults.push(nearly(fault, &name.value, names, declare));
        }
        found
    }
}

/// A name that is not known, with the one of the known names that it is nearly; with other help where there is none.
pub(super) fn nearly<'k>(
    fault: Fault,
    name: &str,
    known: impl Iterator<Item = &'k str>,
    otherwise: Said,
) -> Fault {
    match nearest(name, known) {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault.help(otherwise),
    }
}
