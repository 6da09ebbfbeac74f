//! The files that are open while a budget is read: every other file is read once, and none twice inside
//! itself.

use std::cell::RefCell;
use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::checked::Loaded;
use super::saved::SavedResults;
use gumption_core::model::{Compiler, Model, ModelFault, Request};
use gumption_core::quantity::{Unit, UnitError, UnitTable};
use gumption_fault::{Fault, Rejection, Said, say};
use gumption_format::files::Files;
use gumption_format::toml::faults::UNREADABLE_FILE;

/// Reads and checks a budget of this content.
pub(super) type ReadBudget = fn(&OpenFiles<'_>, &Path, Vec<u8>) -> Result<Loaded, Rejection>;

/// Most budgets below one another: a chain of calibrations has a few, and each takes its part of the stack, of which a
/// thread has 2 MiB.
pub(super) const DEEPEST: usize = 32;

/// The rejection of another budget. Of a file that is none nothing is quoted, as it may be anything; a budget has a
/// table of measurands.
fn of_a_budget(rejection: Rejection) -> Rejection {
    if rejection.text.is_empty() || rejection.text.contains("[measurand") {
        return rejection;
    }
    let message = say!("{} is no budget: it has no [measurand]", rejection.name);
    let fault = Fault::new(UNREADABLE_FILE, 0..0, message);
    Rejection::new(
        &rejection.name,
        "",
        vec![fault.help(say!("name a budget file"))],
    )
}

/// Files that have been read, and those that are being read.
#[derive(Debug)]
pub(super) struct OpenFiles<'a> {
    pub files: Files<'a>,
    read_budget: ReadBudget,
    /// Budgets by identity; nothing for one that was refused.
    budgets: RefCell<HashMap<PathBuf, Option<Rc<Loaded>>>>,
    saved: RefCell<HashMap<PathBuf, Rc<SavedResults>>>,
    /// Identities of the budgets that are being read, the outermost first.
    open: RefCell<Vec<PathBuf>>,
    /// Why other budgets were refused, each before those that it uses itself.
    rejections: RefCell<Vec<Rejection>>,
    compiler: RefCell<Compiler>,
    /// Built-in units by their texts, of which a file has few.
    units: RefCell<HashMap<String, Unit>>,
}

/// Why another file cannot be used.
#[derive(Debug)]
pub(super) enum Missing {
    /// It cannot be read.
    Unreadable(io::Error),
    /// It is a folder.
    Folder,
    /// It has faults, which are kept.
    Refused,
    /// It is being read at this moment; all files of the circle.
    Circle(Vec<PathBuf>),
    /// It is not what it should be, in words.
    Unfit(Said),
    /// Too many budgets use one another, down to this one.
    Deep,
}

impl<'a> OpenFiles<'a> {
    /// Nothing is open yet.
    pub fn new(files: Files<'a>, read_budget: ReadBudget) -> Self {
        OpenFiles {
            files,
            read_budget,
            budgets: RefCell::default(),
            saved: RefCell::default(),
            open: RefCell::default(),
            rejections: RefCell::default(),
            compiler: RefCell::default(),
            units: RefCell::default(),
        }
    }

    /// The model of a file; rows of a table, which differ in numbers, have one.
    pub fn compiled(&self, request: &Request<'_>) -> Result<Model, Vec<ModelFault>> {
        self.compiler.borrow_mut().compile(request)
    }

    /// The unit of a text by this table, read once where it is built in.
    pub fn unit(&self, table: &UnitTable, text: &str) -> Result<Unit, UnitError> {
        if !table.is_builtin() {
            return table.parse(text);
        }
        if let Some(known) = self.units.borrow().get(text) {
            return Ok(known.clone());
        }
        let unit = table.parse(text)?;
        let known = (text.to_owned(), unit.clone());
        self.units.borrow_mut().extend([known]);
        Ok(unit)
    }

    /// Another budget.
    pub fn budget(&self, path: &Path) -> Result<Rc<Loaded>, Missing> {
        let identity = self.files.identity(path);
        let circle = {
            let open = self.open.borrow();
            let first = open.iter().position(|file| *file == identity);
            first.map(|first| open[first..].to_vec())
        };
        if let Some(circle) = circle {
            return Err(Missing::Circle(circle));
        }
        if let Some(known) = self.budgets.borrow().get(&identity) {
            return known.clone().ok_or(Missing::Refused);
        }
        if self.open.borrow().len() > DEEPEST {
            return Err(Missing::Deep);
        }
        let bytes = self.bytes(path)?;
        let before = self.rejections.borrow().len();
        let loaded = match (self.read_budget)(self, path, bytes) {
            Ok(loaded) => Some(Rc::new(loaded)),
            Err(rejection) => {
                let rejection = of_a_budget(rejection);
                self.rejections.borrow_mut().insert(before, rejection);
                None
            }
        };
        self.budgets.borrow_mut().insert(identity, loaded.clone());
        loaded.ok_or(Missing::Refused)
    }

    /// Saved results.
    pub fn saved(&self, path: &Path) -> Result<Rc<SavedResults>, Missing> {
        let identity = self.files.identity(path);
        if let Some(known) = self.saved.borrow().get(&identity) {
            return Ok(Rc::clone(known));
        }
        let bytes = self.bytes(path)?;
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        let place = |file: &str| self.files.identity(&folder.join(file));
        let saved = SavedResults::read(&bytes, &place).map_err(Missing::Unfit)?;
        let saved = Rc::new(saved);
        self.saved.borrow_mut().insert(identity, Rc::clone(&saved));
        Ok(saved)
    }

    fn bytes(&self, path: &Path) -> Result<Vec<u8>, Missing> {
        if self.files.is_folder(path) {
            return Err(Missing::Folder);
        }
        self.files.read(path).map_err(Missing::Unreadable)
    }

    /// Does something while a file is open.
    pub fn within<T>(&self, file: &Path, work: impl FnOnce() -> T) -> T {
        self.open.borrow_mut().push(file.to_path_buf());
        let result = work();
        self.open.borrow_mut().pop();
        result
    }

    /// Whether the outermost file alone is open.
    pub fn is_outermost(&self) -> bool {
        self.open.borrow().is_empty()
    }

    /// Another file was refused, which may be read more than once.
    pub fn refused(&self, rejection: Rejection) {
        let mut rejections = self.rejections.borrow_mut();
        if !rejections.contains(&rejection) {
            rejections.push(rejection);
        }
    }

    /// What was refused so far.
    pub fn take_rejections(&self) -> Vec<Rejection> {
        self.rejections.take()
    }
}
