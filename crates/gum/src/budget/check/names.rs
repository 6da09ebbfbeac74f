//! Names of inputs, constants, measurands and sources.

use std::collections::HashMap;
use std::ops::Range;

use super::checker::Checker;
use super::entries::{entries, shared};
use crate::budget::faults::{BAD_NAME, NAME_TWICE};
use crate::budget::tables::FileTable;
use foldhash::fast::RandomState;
use gumption_fault::{Fault, Said, say};

/// Names, each with the place where it is stated first.
type Used<'f> = HashMap<&'f str, Range<usize>, RandomState>;

/// Whether the model language reads the text as one name.
fn is_identifier(name: &str) -> bool {
    let mut letters = name.chars();
    letters
        .next()
        .is_some_and(|first| first.is_alphabetic() || first == '_')
        && letters.all(|c| c.is_alphanumeric() || c == '_' || ('₀'..='ₜ').contains(&c))
}

/// The nearest name that a formula could use.
fn mended(name: &str) -> String {
    let body: String = name
        .chars()
        .map(|c| {
            if c.is_alphanumeric() || c == '_' {
                c
            } else {
                '_'
            }
        })
        .collect();
    let body = body.trim_matches('_');
    if body.chars().next().is_some_and(char::is_alphabetic) {
        body.to_string()
    } else {
        format!("x{body}")
    }
}

impl Checker<'_> {
    /// Checks every name that formulas may use (`unnamed` are not among them), and that none is used twice.
    pub(super) fn check_names(&mut self, file: &FileTable, unnamed: &[String]) {
        let mut used = Used::default();
        used.reserve(entries(&file.input).len());
        let constants = entries(&file.constant)
            .iter()
            .map(|(name, stated)| (name, stated.key.clone(), say!("a constant")));
        let inputs = entries(&file.input)
            .iter()
            .map(|(name, stated)| (name, stated.key.clone(), say!("an input")));
        for (name, place, kind) in constants.chain(inputs) {
            if !unnamed.iter().any(|unnamed| name == unnamed) {
                self.check_name(name, &place, &kind);
            }
            self.check_use(&mut used, name, place);
        }
        for (name, stated) in entries(&file.measurand) {
            self.check_name(name, &stated.key, &say!("a measurand"));
            self.check_use(&mut used, name, stated.key.clone());
        }
        for (name, stated) in shared(file) {
            self.check_use(&mut used, name, stated.key.clone());
        }
    }

    fn check_use<'f>(&mut self, used: &mut Used<'f>, name: &'f str, place: Range<usize>) {
        if let Some(first) = used.get(name) {
            self.report(
                Fault::new(NAME_TWICE, place, say!("the name {name} is used twice"))
                    .label(say!("used again here"))
                    .related(first.clone(), say!("first used here"))
                    .help(say!(
                        "inputs, constants, measurands and sources need different names"
                    )),
            );
        } else {
            used.insert(name, place);
        }
    }

    pub(super) fn check_name(&mut self, name: &str, place: &Range<usize>, kind: &Said) {
        if !is_identifier(name) {
            self.names.hidden = true;
            self.report(
                Fault::new(
                    BAD_NAME,
                    place.clone(),
                    say!("\"{name}\" cannot be the name of {kind}"),
                )
                .label(say!("a formula cannot name it"))
                .help(say!(
                    "write {}; the full words belong into `description`",
                    mended(name)
                )),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{is_identifier, mended};

    #[test]
    fn identifiers_of_every_script() {
        for name in ["V", "V_0", "alpha2", "α", "温度", "x₁", "_t"] {
            assert!(is_identifier(name), "{name}");
        }
        for name in ["", "2x", "a-b", "a b", "V.x", "U[1]"] {
            assert!(!is_identifier(name), "{name}");
        }
        assert_eq!(mended("a-b c"), "a_b_c");
        assert_eq!(mended("2x"), "x2x");
    }
}
