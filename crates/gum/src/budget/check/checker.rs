//! What all checks share: the file, what is known of its names, what was found in its data, and what the user
//! will be told.

use std::path::Path;

use super::entries::names_hidden;
use super::fits::Scatter;
use crate::budget::open_files::OpenFiles;
use crate::budget::tables::FileTable;
use crate::budget::{Conventions, NamedFigure, TScale};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::{Fault, Said, say};
use gumption_format::files::{Files, given_in_memory};

/// Where a budget comes from, and with it the files that it names.
#[derive(Debug, Clone, Copy)]
pub(in crate::budget) struct Origin<'a> {
    /// What has been read already.
    pub files: &'a OpenFiles<'a>,
    /// Folder of the budget, from which paths in it start.
    pub directory: &'a Path,
    /// The budget's own file, as [`Files::identity`](crate::budget::Files::identity) gives it.
    pub file: &'a Path,
}

impl Origin<'_> {
    /// The folder in words.
    pub(super) fn folder(&self) -> Said {
        match (self.files.files, self.directory.as_os_str().is_empty()) {
            (Files::Library(_), true) => say!("what was given in memory"),
            (_, true) => say!("the current folder"),
            (_, false) => say!("the folder {}", self.directory.display()),
        }
    }

    /// How to name a file so that it is found.
    pub(super) fn mend(&self, name: &str) -> Said {
        match self.files.files {
            Files::Library(_) => given_in_memory(name),
            _ => say!("the path starts from the folder of the budget"),
        }
    }
}

/// What all checks share.
pub(super) struct Checker<'a> {
    pub source: Source<'a>,
    pub conventions: Conventions,
    pub names: Names,
    pub figures: Figures,
    /// What the fits of the file say about the scatter of their responses.
    pub scatters: Vec<Scatter>,
    pub messages: Messages,
}

/// The file that is checked.
#[derive(Debug, Clone)]
pub(super) struct Source<'a> {
    /// The whole file.
    pub text: &'a str,
    pub origin: Origin<'a>,
    /// Date of the measurement.
    pub date: Option<String>,
}

/// What is known of names before the model is compiled.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub units: UnitTable,
    /// Parameters of fits with their units.
    pub parameters: Vec<(String, Option<Unit>)>,
    /// Names that the formulas of fits use.
    pub used_by_fits: Vec<String>,
    /// Every result by name, with the entry of the file it belongs to: a vector has one per element.
    pub results: Vec<(String, usize)>,
    /// Whether names that formulas use may be declared in a part of the file that was refused.
    pub hidden: bool,
}

/// Figures that claims may name.
#[derive(Debug, Default)]
pub(super) struct Figures {
    /// Figures of the analyses of the file's data.
    pub found: Vec<NamedFigure>,
    /// Names of figures that only the evaluation will give.
    pub awaited: Vec<String>,
    /// Whether an analysis was refused, whose figures are therefore not known.
    pub incomplete: bool,
}

/// What the user will be told.
#[derive(Debug, Default)]
pub(super) struct Messages {
    pub faults: Vec<Fault>,
    pub remarks: Vec<Said>,
}

impl<'a> Checker<'a> {
    /// Nothing is checked yet but the conventions.
    pub(super) fn new(source: Source<'a>, file: &FileTable, conventions: Conventions) -> Self {
        Checker {
            source,
            conventions,
            names: Names {
                hidden: names_hidden(file),
                ..Names::default()
            },
            figures: Figures::default(),
            scatters: Vec::new(),
            messages: Messages::default(),
        }
    }

    /// Reports a fault; nothing can be returned.
    pub(super) fn refuse<T>(&mut self, fault: Fault) -> Option<T> {
        self.report(fault);
        None
    }

    /// Reports a fault.
    pub(super) fn report(&mut self, fault: Fault) {
        self.messages.faults.push(fault);
    }

    /// Tells the reader of the report, once.
    pub(super) fn remark(&mut self, remark: Said) {
        if !self.messages.remarks.contains(&remark) {
            self.messages.remarks.push(remark);
        }
    }

    pub(super) fn t_scale(&self) -> TScale {
        self.conventions.t_scale
    }
}
