//! Checks that only a diagnosis needs of an experiment's names.

use super::Column;
use crate::diagnose::faults::UNKNOWN_NAME;
use crate::experiment::checker::Checker;
use gumption_fault::{Fault, nearest, say};
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
                say!("the experiment has no column {}", name.value),
            )
            .label(say!("not a column of this experiment"));
            self.faults.push(match nearest(&name.value, names) {
                Some(near) => fault.help(say!("did you mean \"{near}\"?")),
                None => fault.help(say!("declare it below [columns]")),
            });
        }
        found
    }
}
