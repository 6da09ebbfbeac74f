//! Checks that only a diagnosis needs of an experiment's names.

use super::Column;
use crate::diagnose::faults::UNKNOWN_NAME;
use crate::experiment::checker::Checker;
use gumption_fault::{Fault, nearest};
use gumption_format::toml::Stated;

impl Checker<'_> {
    /// A column that a key names.
    pub(super) fn known(&mut self, name: &Stated<String>, columns: &[Column]) -> Option<usize> {
        let found = columns.iter().position(|column| column.name == name.value);
        if found.is_none() {
            let names = columns.iter().map(|column| column.name.as_str());
            let fault = Fault::new(
                UNKNOWN_NAME,
                name.span.clone(),
                format!("the experiment has no column {}", name.value),
            )
            .label("not a column of this experiment");
            self.faults.push(match nearest(&name.value, names) {
                Some(near) => fault.help(format!("did you mean \"{near}\"?")),
                None => fault.help("declare it below [columns]"),
            });
        }
        found
    }
}
