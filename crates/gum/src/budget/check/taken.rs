//! What inputs take over from other files.

use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

use gumption_format::toml::Stated;

use crate::budget::Loaded;
use crate::budget::faults::FROM;
use crate::budget::saved::SavedResults;
use gumption_core::model::Model;
use gumption_fault::{Fault, say};

/// What an input takes over.
#[derive(Debug, Clone)]
pub(super) struct Taken {
    /// Index into the entries of the register.
    pub entry: usize,
    pub result: OtherResult,
    /// The file as the user names it.
    pub file: String,
    /// Heading that the user wants for what comes with it.
    pub group: Option<String>,
    pub place: Range<usize>,
}

impl Taken {
    /// The fault of a correlation that is stated for such an input.
    pub(super) fn not_to_be_correlated(&self, name: &Stated<String>) -> Fault {
        Fault::new(
            FROM,
            name.span.clone(),
            say!("{} is a result of {}, and no correlation of it can be stated", name.value, self.file),
        )
        .label(say!("what it has in common with others follows from its components"))
        .related(self.place.clone(), say!("the other file"))
        .help(say!("use a common budget or a common [source] in the other files; for a bare coefficient state the result as an input with `value` and `u`"))
    }
}

/// A result of another file.
#[derive(Debug, Clone)]
pub(super) enum OtherResult {
    Budget {
        loaded: Rc<Loaded>,
        row: usize,
        output: usize,
    },
    Saved {
        saved: Rc<SavedResults>,
        result: usize,
    },
}

/// The formula behind an input, with the places of its own inputs.
#[derive(Debug, Clone)]
pub(super) struct Formula {
    pub model: Arc<Model>,
    pub output: usize,
    pub places: Vec<usize>,
}
