//! Which names of a formula are parameters.

use std::ops::Range;

use super::super::super::checker::Checker;
use super::super::super::entries::entries;
use super::super::columns::Column;
use super::parts::{Parameter, Scope};
use super::text::Written;
use crate::budget::faults::{FIT, NAME_TWICE, UNKNOWN_NAME, UNUSED};
use crate::budget::tables::FitParameterTable;
use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::Stated;
use smol_str::SmolStr;

/// What a name on the right side of a formula is.
enum Meaning<'f> {
    /// A column, a constant or a parameter of the list.
    Known,
    /// The column on the left.
    LeftSide,
    /// Perhaps this column, which the formula does not use.
    Column(&'f str),
    /// An input of the budget, which a fit cannot know.
    Input,
    /// Nothing in the list of the parameters.
    Unlisted,
    /// Perhaps a parameter of a list that could not be read.
    Unread,
    /// A parameter, because nothing else has the name.
    Parameter,
}

/// What was found about the names of a formula.
#[derive(Default)]
struct Found<'f> {
    parameters: Vec<Parameter>,
    /// Columns that a name of the formula probably means.
    misspelt: Vec<&'f str>,
}

impl Checker<'_> {
    /// The parameters of a formula: those that the file lists, or else all names that are nothing else.
    pub(super) fn fit_parameters(&mut self, formula: &Written<'_>) -> Option<Vec<Parameter>> {
        let before = self.messages.faults.len();
        let found = self.names_of_formula(formula);
        let idle = formula.idle_columns();
        let unused = idle
            .iter()
            .filter(|column| !found.misspelt.contains(&column.name));
        self.messages
            .faults
            .extend(unused.map(|column| unused_column(formula.fit, column)));
        let declared = formula.fit.declared();
        for (parameter, stated) in declared.unwrap_or_default() {
            self.messages
                .faults
                .extend(formula.fault_of(parameter, stated));
        }
        if formula.fit.list_is_unread() || self.messages.faults.len() > before {
            return None;
        }
        match declared {
            Some(list) => Some(list.iter().map(listed).collect()),
            None if found.parameters.is_empty() => self.refuse(no_parameters(formula)),
            None => Some(found.parameters),
        }
    }

    /// Looks up every name on the right side, and refuses those that mean nothing there.
    fn names_of_formula<'f>(&mut self, formula: &Written<'f>) -> Found<'f> {
        let idle = formula.idle_columns();
        let mut found = Found::default();
        for (name, part) in &formula.outline.needs {
            let place = self.part_of_formula(formula.text, part);
            let meaning = formula.meaning(name, &idle);
            match meaning {
                Meaning::Known | Meaning::Unread => {}
                Meaning::Parameter => found.parameters.push(unlisted(name, place)),
                Meaning::LeftSide => self.report(both_sides(name, place)),
                Meaning::Column(near) => {
                    found.misspelt.push(near);
                    let fault = unknown(formula.fit, name, place);
                    self.messages.faults
                        .push(fault.help(say!("did you mean the column `{near}`?")));
                }
                Meaning::Input => self.report(unknown(formula.fit, name, place).help(say!(
                    "make {name} a [constant], and let a component common to all points stand for its uncertainty; or correct the column for it beforehand"
                ))),
                Meaning::Unlisted => {
                    let help = not_in_the_list(formula.fit, name);
                    self.messages.faults
                        .push(unknown(formula.fit, name, place).help(help));
                }
            }
        }
        found
    }
}

impl Scope<'_> {
    /// Whether there is a list of parameters that could not be read in full.
    fn list_is_unread(&self) -> bool {
        let table = &self.stated.value;
        table.parameters.as_ref().map_or_else(
            || table.present.iter().any(|(key, _)| *key == "parameters"),
            |stated| stated.value.0.refused,
        )
    }

    fn lists(&self, parameter: &str) -> bool {
        let list = self.declared().unwrap_or_default();
        list.iter().any(|(name, _)| name == parameter)
    }

    fn is_input(&self, name: &str) -> bool {
        entries(&self.file.input)
            .iter()
            .any(|(input, _)| input == name)
    }
}

impl<'f> Written<'f> {
    /// Columns beside the left one that the formula does not use.
    fn idle_columns(&self) -> Vec<&'f Column<'f>> {
        let columns = self.fit.columns.iter().enumerate();
        columns
            .filter(|(index, column)| *index != self.response && !self.uses(column.name))
            .map(|(_, column)| column)
            .collect()
    }

    fn meaning(&self, name: &str, idle: &[&'f Column<'f>]) -> Meaning<'f> {
        let column = self.fit.column(name);
        let constant = || self.fit.constants.iter().any(|own| own.name == name);
        if column == Some(self.response) {
            return Meaning::LeftSide;
        }
        if column.is_some() || constant() || self.fit.lists(name) {
            return Meaning::Known;
        }
        match nearest(name, idle.iter().map(|column| column.name)) {
            Some(near) => Meaning::Column(near),
            None if self.fit.is_input(name) => Meaning::Input,
            None if self.fit.list_is_unread() => Meaning::Unread,
            None if self.fit.declared().is_some() => Meaning::Unlisted,
            None => Meaning::Parameter,
        }
    }

    /// What is wrong with a parameter of the list.
    fn fault_of(&self, parameter: &str, stated: &Stated<FitParameterTable>) -> Option<Fault> {
        let (fit, place) = (self.fit.name, stated.key.clone());
        if self.fit.column(parameter).is_some() {
            let message = say!("{parameter} is a column and a parameter of the fit {fit}");
            return Some(
                Fault::new(NAME_TWICE, place, message)
                    .label(say!("used again here"))
                    .help(say!("choose another name for one of them")),
            );
        }
        if self.uses(parameter) {
            return None;
        }
        let message = say!("the formula of the fit {fit} does not use the parameter {parameter}");
        Some(
            Fault::new(UNUSED, place, message)
                .label(say!("not used"))
                .help(say!("use it in the formula, or remove it")),
        )
    }
}

/// A parameter of the list.
fn listed((name, stated): &(SmolStr, Stated<FitParameterTable>)) -> Parameter {
    let description = stated.value.description.as_ref();
    Parameter {
        name: name.to_string(),
        place: stated.key.clone(),
        unit: None,
        start: None,
        description: description.map(|text| text.value.clone()),
        stated: Some(stated.clone()),
    }
}

/// A parameter that only the formula names.
fn unlisted(name: &str, place: Range<usize>) -> Parameter {
    Parameter {
        name: name.to_string(),
        place,
        unit: None,
        start: None,
        description: None,
        stated: None,
    }
}

fn both_sides(name: &str, place: Range<usize>) -> Fault {
    let message = say!("{name} is on both sides of the formula");
    Fault::new(FIT, place, message).label(say!(
        "expected columns, parameters and constants other than the left side"
    ))
}

fn unknown(fit: &Scope<'_>, name: &str, place: Range<usize>) -> Fault {
    let message = if fit.is_input(name) {
        say!("{name} is an input; a fit knows its columns, its parameters and constants")
    } else {
        say!(
            "{name} is neither a column nor a parameter of the fit {}, nor a constant",
            fit.name
        )
    };
    Fault::new(UNKNOWN_NAME, place, message).label(say!("not known here"))
}

/// The mend for a name that is missing in the list of the parameters.
fn not_in_the_list(fit: &Scope<'_>, name: &str) -> Said {
    let list = fit.declared().unwrap_or_default();
    match nearest(name, list.iter().map(|(name, _)| name.as_str())) {
        Some(near) => say!("did you mean the parameter `{near}`?"),
        None => say!(
            "add it to the others: [fit.{}.parameters], {name} = {{ unit = \"…\" }}",
            fit.name
        ),
    }
}

fn unused_column(fit: &Scope<'_>, column: &Column<'_>) -> Fault {
    let message = say!(
        "the formula of the fit {} does not use the column {}",
        fit.name,
        column.name
    );
    Fault::new(UNUSED, column.key.clone(), message)
        .label(say!("not used"))
        .help(say!("use it in the formula, or remove it"))
}

fn no_parameters(formula: &Written<'_>) -> Fault {
    let message = say!(
        "the formula of the fit {} has no parameters",
        formula.fit.name
    );
    Fault::new(FIT, formula.text.span.clone(), message)
        .label(say!("nothing is to be found"))
        .help(say!(
            "every name that is neither a column nor a constant is a parameter: \"y = a + b*x\""
        ))
}
