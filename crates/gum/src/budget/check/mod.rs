//! From the tables of a file to a budget without contradictions.
//!
//! Every check reports to the [`Checker`] and goes on, so that a user sees all faults of the file at
//! once. What depends on a refused part is left out silently: it would only repeat the first fault.

mod amounts;
mod anova;
mod certificates;
mod chain;
mod claims;
mod conformity;
mod constants;
mod conventions;
mod correlations;
mod csv;
mod detection;
mod draft;
mod fits;
mod formulas;
mod given;
mod groups;
mod inputs;
mod joints;
mod names;
mod register;
mod resolution;
mod results;
mod shapes;
mod sources;
mod specification;
#[cfg(test)]
mod tests;
mod type_a;
mod type_b;
mod vectors;
mod ways;

use std::path::Path;

use super::shelf::Shelf;
use super::tables::FileTable;
use super::{
    Budget, Component, Conventions, Heading, MonteCarloSettings, NamedFigure, Owner, Remark, Row,
    TScale, Trials,
};
use crate::fault::Fault;
use crate::quantity::{Unit, UnitTable};
use gumption_format::toml::Named;
use gumption_format::toml::Stated;

/// Where a budget comes from, and with it the files that it names.
#[derive(Debug, Clone, Copy)]
pub(super) struct Origin<'a> {
    /// What has been read already.
    pub shelf: &'a Shelf<'a>,
    /// Folder of the budget, from which paths in it start.
    pub directory: &'a Path,
    /// The budget's own file, as [`Files::identity`](crate::budget::Files::identity) gives it.
    pub file: &'a Path,
}

impl Origin<'_> {
    /// The folder in words.
    fn folder(&self) -> String {
        match self.directory.as_os_str().is_empty() {
            true => "the current folder".to_string(),
            false => format!("the folder {}", self.directory.display()),
        }
    }
}

/// What all checks share.
struct Checker<'a> {
    /// The whole file.
    text: &'a str,
    origin: Origin<'a>,
    units: UnitTable,
    conventions: Conventions,
    /// Date of the measurement.
    date: Option<String>,
    faults: Vec<Fault>,
    remarks: Vec<Remark>,
    /// What the fits of the file say about the scatter of their responses.
    scatters: Vec<fits::Scatter>,
    /// Parameters of fits with their units.
    parameters: Vec<(String, Option<Unit>)>,
    /// Names that the formulas of fits use.
    used_by_fits: Vec<String>,
    /// Figures of the analyses of the file's data.
    figures: Vec<NamedFigure>,
    /// Names of figures that only the evaluation will give.
    awaited_figures: Vec<String>,
    /// Every result by name, with the entry of the file it belongs to: a vector has one per element.
    results: Vec<(String, usize)>,
    /// Whether names that formulas use may be declared in a part of the file that was refused.
    hidden_names: bool,
}

impl Checker<'_> {
    /// Reports a fault; nothing can be returned.
    fn refuse<T>(&mut self, fault: Fault) -> Option<T> {
        self.faults.push(fault);
        None
    }

    fn remark(&mut self, en: String, zh: String) {
        let remark = Remark { en, zh };
        if !self.remarks.contains(&remark) {
            self.remarks.push(remark);
        }
    }

    fn t_scale(&self) -> TScale {
        self.conventions.t_scale
    }
}

/// One evaluation: the file itself, or with the values of a row of its series in place.
pub(super) struct Variant {
    pub label: Option<String>,
    pub file: FileTable,
}

/// The budgets of a file: one, or one for each row of its series.
///
/// # Errors
/// All faults, in no particular order.
pub(super) fn rows(
    variants: Vec<Variant>,
    text: &str,
    origin: Origin<'_>,
) -> Result<(Heading, Vec<Row>), Vec<Fault>> {
    let mut faults = Vec::new();
    let heading = variants
        .first()
        .map(|variant| heading(&variant.file))
        .unwrap_or_default();
    let several = variants.len() > 1;
    let mut rows = Vec::new();
    for (index, variant) in variants.into_iter().enumerate() {
        let number = || several.then(|| (index + 1).to_string());
        let row = variant.label.clone().or_else(number);
        match budget(&variant.file, text, origin, &heading, row.as_deref()) {
            Ok(budget) => rows.push(Row {
                label: variant.label,
                budget,
            }),
            // Every row repeats the faults that do not depend on it.
            Err(found) => faults.extend(found),
        }
    }
    if faults.is_empty() {
        share_sources(&mut rows, origin.file);
        Ok((heading, rows))
    } else {
        Err(faults)
    }
}

/// A `[source]` that is the same in every row of a series is one cause for all of them.
fn share_sources(rows: &mut [Row], file: &Path) {
    let Some((first, rest)) = rows.split_first_mut() else {
        return;
    };
    let own = |budget: &Budget, index: usize| &*budget.chain.components[index].part.file == file;
    let shared: Vec<Component> = (0..first.budget.components.len())
        .filter(|index| own(&first.budget, *index))
        .map(|index| &first.budget.components[index])
        .filter(|component| matches!(component.owner, Owner::Source(_)))
        .filter(|component| {
            let same = |row: &Row| row.budget.components.contains(component);
            rest.iter().all(same)
        })
        .cloned()
        .collect();
    let names: Vec<&str> = shared
        .iter()
        .map(|component| component.name.as_str())
        .collect();
    for row in std::iter::once(first).chain(rest) {
        row.budget.chain.share(file, &names);
    }
}

fn heading(file: &FileTable) -> Heading {
    let text = |stated: &Option<Stated<String>>| stated.as_ref().map(|stated| stated.value.clone());
    Heading {
        title: text(&file.title).unwrap_or_default(),
        method: text(&file.method),
        object: text(&file.object),
        author: text(&file.author),
        date: file.date.as_ref().map(|date| date.value.0.clone()),
        reference: text(&file.reference),
        note: text(&file.note),
    }
}

fn budget(
    file: &FileTable,
    text: &str,
    origin: Origin<'_>,
    heading: &Heading,
    row: Option<&str>,
) -> Result<Budget, Vec<Fault>> {
    let (conventions, resolution, faults) = conventions::conventions(file);
    let mut checker = Checker {
        text,
        origin,
        units: UnitTable::default(),
        conventions,
        date: heading.date.clone(),
        faults,
        remarks: Vec::new(),
        scatters: Vec::new(),
        parameters: Vec::new(),
        used_by_fits: Vec::new(),
        figures: Vec::new(),
        awaited_figures: Vec::new(),
        results: Vec::new(),
        hidden_names: names_hidden(file),
    };
    let budget = checker.budget(file, resolution, heading, row);
    match budget {
        Some(budget) if checker.faults.is_empty() => Ok(budget),
        _ => Err(checker.faults),
    }
}

impl Checker<'_> {
    fn budget(
        &mut self,
        file: &FileTable,
        resolution: super::tables::ResolutionWord,
        heading: &Heading,
        row: Option<&str>,
    ) -> Option<Budget> {
        self.define_units(file);
        self.check_names(file);
        let monte_carlo = self.monte_carlo(file);
        let constants = self.constants(file);
        let mut register = register::Register::default();
        self.joint_estimates(file, &mut register);
        self.sources(shared(file), &mut register);
        let fitted = self.fits(file, &constants, &mut register);
        let file = &self.reporting_fits(file);
        self.inputs(file, resolution, &mut register);
        self.unused_sources(shared(file), &register);
        let mut groups = self.groups(file, &fitted, &mut register);
        let chain = self.chain(file, row, &mut register, &mut groups);
        let model = self.model(file, &constants, &register);
        self.results = formulas::results(file, model.as_ref());
        let conformity = self.conformity(file, &register);
        let detection = self.detection(file, &register);
        self.await_tolerances(file, &monte_carlo);
        let found = register.analyses.iter().flat_map(|one| one.figures());
        self.figures.extend(found);
        let claims = self.claims(file, &register);
        Some(Budget {
            heading: heading.clone(),
            conventions: self.conventions.clone(),
            monte_carlo,
            model: model?,
            inputs: register.inputs,
            constants,
            measurands: formulas::measurands(file, &self.results),
            components: register.components,
            groups,
            following: register.following,
            conformity,
            detection,
            fits: fitted.into_iter().map(|found| found.fit).collect(),
            claims,
            analyses: register.analyses,
            figures: std::mem::take(&mut self.figures),
            remarks: std::mem::take(&mut self.remarks),
            chain,
        })
    }
}

impl Checker<'_> {
    /// Names the figures of JCGM 101, 7.9 that an evaluation will give.
    fn await_tolerances(&mut self, file: &FileTable, monte_carlo: &MonteCarloSettings) {
        for (name, _) in entries(&file.measurand) {
            let tolerances = [1, 2].map(|digits| NamedFigure::tolerance(name, digits));
            self.awaited_figures.extend(tolerances);
        }
        if matches!(monte_carlo.trials, Trials::Adaptive { .. }) {
            let batches = [NamedFigure::LEAST_BATCH, NamedFigure::BATCH];
            self.awaited_figures.extend(batches.map(String::from));
        }
    }
}

/// Whether the file has an unknown table or key at its top, or an entry that could not be read: what a
/// formula names may be declared there.
fn names_hidden(file: &FileTable) -> bool {
    let refused = |key: &str, entry: Option<bool>| {
        entry.unwrap_or_else(|| file.present.iter().any(|(present, _)| *present == key))
    };
    file.unknown
        || refused(
            "input",
            file.input.as_ref().map(|named| named.value.refused),
        )
        || refused(
            "constant",
            file.constant.as_ref().map(|named| named.value.refused),
        )
        || refused("fit", file.fit.as_ref().map(|named| named.value.refused))
        || refused("model", file.model.as_ref().map(|_| false))
}

/// The shared causes of a file.
fn shared(file: &FileTable) -> &[(String, Stated<super::tables::SourceTable>)] {
    file.source
        .as_ref()
        .map_or(&[], |stated| &stated.value.0.entries)
}

/// The named entries of an optional table.
fn entries<T>(named: &Option<Stated<Named<T>>>) -> &[(String, Stated<T>)] {
    named.as_ref().map_or(&[], |stated| &stated.value.entries)
}
