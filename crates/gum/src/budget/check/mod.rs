//! From the tables of a file to a budget without contradictions.
//!
//! Every check reports to the [`Checker`] and goes on, so that a user sees all faults of the file at
//! once. What depends on a refused part is left out silently: it would only repeat the first fault.

mod amounts;
mod anova;
mod certificates;
mod chain;
mod checker;
mod claims;
mod conformity;
mod constants;
mod conventions;
mod correlations;
mod csv;
mod detection;
mod draft;
mod entries;
mod factors;
mod fits;
mod formulas;
mod given;
mod groups;
mod inputs;
mod joints;
mod names;
mod nearest;
mod of_rows;
mod plain;
mod register;
mod resolution;
mod results;
mod shapes;
mod sources;
mod specification;
mod statement;
mod taken;
#[cfg(test)]
mod tests;
mod type_a;
mod type_b;
pub(super) mod units;
mod vectors;
mod ways;

use std::ops::Range;
use std::path::Path;

use super::checked::Quantities;
use super::dcc;
use super::tables::FileTable;
use super::{Budget, Component, Heading, MonteCarloSettings, NamedFigure, Owner, Row, Trials};
pub(super) use amounts::{is_bare_ratio, is_in_ratios};
pub(super) use checker::Origin;
use checker::{Checker, Source};
use entries::{entries, shared};
use gumption_core::quantity::UnitTable;
use gumption_fault::{Fault, Said};
use gumption_format::toml::Slot;
use of_rows::of_rows;
pub(super) use plain::Plain;
pub(super) use ways::{states_estimate, states_uncertainty};

/// One evaluation: the file itself, or with the values of a row of its series in place.
pub(super) struct Variant {
    pub label: Option<String>,
    /// Where the file has the row.
    pub place: Option<Range<usize>>,
    /// Whether its series says that rows repeat one another.
    pub repetitions: bool,
    pub file: FileTable,
    /// What was found wrong while its tables were read.
    pub faults: Vec<Fault>,
}

/// The budgets of a file: one, or one for each row of its series.
///
/// # Errors
/// All faults, in no particular order.
pub(super) fn rows(
    variants: impl ExactSizeIterator<Item = Variant>,
    text: &str,
    origin: Origin<'_>,
) -> Result<(Heading, Vec<Row>), Vec<Fault>> {
    let mut faults = Vec::with_capacity(variants.len());
    let mut first = None;
    let several = variants.len() > 1;
    let mut rows = Vec::with_capacity(variants.len());
    for (index, mut variant) in variants.enumerate() {
        let number = || several.then(|| (index + 1).to_string());
        let row = variant.label.clone().or_else(number);
        let place = variant.place.clone().zip(row.clone());
        let mut of_row = std::mem::take(&mut variant.faults);
        let heading: &Heading = first.get_or_insert_with(|| Heading {
            repetitions: variant.repetitions,
            ..heading(&variant.file)
        });
        let found = dcc::fill(&mut variant.file, origin.files, origin.directory);
        if !found.faults.is_empty() {
            of_row.extend(found.faults);
            faults.push((place, of_row));
            continue;
        }
        match budget(
            &variant.file,
            text,
            origin,
            heading,
            row.as_deref(),
            found.remarks,
        ) {
            Ok(budget) => rows.push(Row {
                label: variant.label,
                budget,
            }),
            Err(found) => of_row.extend(found),
        }
        faults.push((place, of_row));
    }
    let found = of_rows(faults);
    if found.is_empty() {
        share_sources(&mut rows, origin.file);
        Ok((first.unwrap_or_default(), rows))
    } else {
        Err(found)
    }
}

/// A `[source]` that is the same in every row of a series is one cause for all of them.
fn share_sources(rows: &mut [Row], file: &Path) {
    let Some((first, rest)) = rows.split_first_mut().filter(|(_, rest)| !rest.is_empty()) else {
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
    let text = |stated: &Slot<String>| stated.as_ref().map(|stated| stated.value.clone());
    Heading {
        title: text(&file.title).unwrap_or_default(),
        title_zh: text(&file.title_zh),
        method: text(&file.method),
        object: text(&file.object),
        author: text(&file.author),
        date: file.date.as_ref().map(|date| date.value.0.clone()),
        reference: text(&file.reference),
        note: text(&file.note),
        repetitions: false,
    }
}

/// The quantities of tables without formulas.
///
/// # Errors
/// All faults, in no particular order.
pub(super) fn quantities(
    file: &FileTable,
    unnamed: &[String],
    units: &UnitTable,
    text: &str,
    origin: Origin<'_>,
) -> Result<Quantities, Vec<Fault>> {
    let mut filled = file.clone();
    let found = dcc::fill(&mut filled, origin.files, origin.directory);
    if !found.faults.is_empty() {
        return Err(found.faults);
    }
    let file = &filled;
    let (conventions, resolution, faults) = conventions::conventions(file);
    let source = Source {
        text,
        origin,
        date: heading(file).date,
    };
    let mut checker = Checker::new(source, file, conventions);
    checker.messages.faults = faults;
    checker.messages.remarks = found.remarks;
    checker.names.units = units.clone();
    checker.check_names(file, unnamed);
    checker.monte_carlo(file);
    let constants = checker.constants(file);
    let mut register = register::Register::default();
    checker.sources(shared(file), &mut register);
    checker.inputs(file, resolution, &mut register);
    checker.unused_sources(shared(file), &register);
    let groups = checker.groups(file, &[], &mut register);
    if !checker.messages.faults.is_empty() {
        return Err(checker.messages.faults);
    }
    Ok(Quantities {
        conventions: checker.conventions,
        constants,
        inputs: register.inputs,
        components: register.components,
        groups,
        following: register.following,
        remarks: checker.messages.remarks,
    })
}

fn budget(
    file: &FileTable,
    text: &str,
    origin: Origin<'_>,
    heading: &Heading,
    row: Option<&str>,
    remarks: Vec<Said>,
) -> Result<Budget, Vec<Fault>> {
    let (conventions, resolution, faults) = conventions::conventions(file);
    let source = Source {
        text,
        origin,
        date: heading.date.clone(),
    };
    let mut checker = Checker::new(source, file, conventions);
    checker.messages.faults = faults;
    checker.messages.remarks = remarks;
    let budget = checker.budget(file, resolution, heading, row);
    match budget {
        Some(budget) if checker.messages.faults.is_empty() => Ok(budget),
        _ => Err(checker.messages.faults),
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
        self.check_names(file, &[]);
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
        self.remark_on_shared_certificates(&register, &groups);
        let chain = self.chain(file, row, &mut register, &mut groups);
        let model = self.model(file, &constants, &register);
        self.names.results = formulas::results(file, model.as_ref());
        let conformity = self.conformity(file, &register);
        let detection = self.detection(file, &register);
        self.await_tolerances(file, &monte_carlo);
        let found = register.analyses.iter().flat_map(|one| one.figures());
        self.figures.found.extend(found);
        let claims = self.claims(file, &register);
        Some(Budget {
            heading: heading.clone(),
            conventions: self.conventions.clone(),
            monte_carlo,
            model: model?,
            inputs: register.inputs,
            constants,
            measurands: formulas::measurands(file, &self.names.results),
            components: register.components,
            groups,
            following: register.following,
            conformity,
            detection,
            fits: fitted.into_iter().map(|found| found.fit).collect(),
            claims,
            analyses: register.analyses,
            figures: std::mem::take(&mut self.figures.found),
            remarks: std::mem::take(&mut self.messages.remarks),
            chain,
        })
    }
}

impl Checker<'_> {
    /// Names the figures of JCGM 101, 7.9 that an evaluation will give.
    fn await_tolerances(&mut self, file: &FileTable, monte_carlo: &MonteCarloSettings) {
        for (name, _) in entries(&file.measurand) {
            let tolerances = [1, 2].map(|digits| NamedFigure::tolerance(name, digits));
            self.figures.awaited.extend(tolerances);
        }
        if matches!(monte_carlo.trials, Trials::Adaptive { .. }) {
            let batches = [NamedFigure::LEAST_BATCH, NamedFigure::BATCH];
            self.figures.awaited.extend(batches.map(String::from));
        }
    }
}
