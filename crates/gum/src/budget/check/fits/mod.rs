//! `[fit.NAME]`: least squares as an input of the budget.
//!
//! The parameters become inputs under their own names. What the fit finds of their covariance is one
//! component for each of them, all in one group: normal for stated uncertainties of the data, multivariate t
//! with ν = n − p where the residuals tell the scatter. Causes common to all points reach the parameters
//! through ∂parameter/∂datum, as components of their own.

mod columns;
mod doubts;
mod failures;
mod fitted;
mod formula;
mod residual;
mod solution;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use nalgebra::DMatrix;

use super::checker::Checker;
use super::draft::{Draft, Kind, Location, show};
use super::entries::{entries, shared};
use super::register::{InputEntry, Register};
use crate::budget::faults::{NAME_TWICE, UNUSED};
use crate::budget::fit::Fit;
use crate::budget::tables::{FileTable, FitTable, MeasurandTable};
use crate::budget::{Constant, Evaluation, Group, Input, Owner};
use gumption_core::model::Model;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::Named;
use gumption_format::toml::{Slot, Stated};
use smol_str::format_smolstr;

use columns::ColumnErrors;
use formula::{Parameter, Scope};

pub(super) use fitted::{Fitted, Scatter};

impl Checker<'_> {
    /// Reads `[fit.NAME]` and enters the parameters as inputs.
    pub(super) fn fits(
        &mut self,
        file: &FileTable,
        constants: &[Constant],
        register: &mut Register,
    ) -> Vec<Fitted> {
        let mut fitted = Vec::new();
        let fits = entries(&file.fit);
        if fits.is_empty() {
            return fitted;
        }
        let mut taken = names(file);
        for (name, stated) in fits {
            self.check_name(name, &stated.key, &say!("a fit"));
            // Claims may name figures of a fit that was refused.
            let found = self.fit(name, stated, constants, file, register, &mut taken);
            self.scatters.push(Scatter::of(name, found.as_ref()));
            register.incomplete |= found.is_none();
            fitted.extend(found);
        }
        fitted
    }

    fn fit(
        &mut self,
        name: &str,
        stated: &Stated<FitTable>,
        constants: &[Constant],
        file: &FileTable,
        register: &mut Register,
        taken: &mut HashMap<String, Range<usize>>,
    ) -> Option<Fitted> {
        let Some(columns) = self.fit_columns(name, stated) else {
            // The names of its parameters are not known.
            self.names.hidden = true;
            return None;
        };
        let scope = Scope {
            name,
            stated,
            columns: &columns,
            constants,
            file,
        };
        let formula = match self.fit_formula(&scope) {
            Ok(formula) => formula,
            Err(parameters) => {
                self.names.hidden |= parameters.is_empty();
                self.parameters(name, &parameters, register, taken);
                return None;
            }
        };
        let start = self.parameters(name, &formula.parameters, register, taken);
        let order: Vec<usize> = std::iter::once(formula.response)
            .chain(formula.predictors.iter().copied())
            .collect();
        let errors: Option<Vec<ColumnErrors>> = order
            .iter()
            .map(|index| self.fit_errors(name, &columns[*index], register))
            .collect();
        let columns: Vec<_> = order.iter().map(|index| &columns[*index]).collect();
        let solved = self.fit_solution(name, stated, &formula, &columns, &errors?)?;
        let fit = solved.into_fit(name, stated, &formula, &columns, start, register);
        self.figures.found.extend(fit.figures());
        Some(self.enter_fit(fit, stated, register))
    }

    /// Enters the parameters as inputs, without estimates as yet; gives the place of the first.
    fn parameters(
        &mut self,
        fit: &str,
        parameters: &[Parameter],
        register: &mut Register,
        taken: &mut HashMap<String, Range<usize>>,
    ) -> usize {
        let first = register.inputs.len();
        for parameter in parameters {
            let name = &parameter.name;
            self.check_name(name, &parameter.place, &say!("a parameter"));
            if let Some(other) = taken.insert(name.clone(), parameter.place.clone()) {
                self.report(
                    Fault::new(
                        NAME_TWICE,
                        parameter.place.clone(),
                        say!("the name {name} is used twice"),
                    )
                    .label(say!("a parameter of the fit {fit}"))
                    .related(other, say!("first used here"))
                    .help(say!(
                        "parameters of fits, inputs, constants and sources need different names"
                    )),
                );
            }
            let place = register.inputs.len();
            register.inputs.push(Input {
                name: name.as_str().into(),
                description: parameter.description.clone(),
                group: None,
                unit: parameter.unit.clone().unwrap_or_else(Unit::one),
                estimate: f64::NAN,
                terms: Vec::new(),
            });
            register.entries.push(InputEntry {
                name: name.as_str().into(),
                place: parameter.place.clone(),
                places: place..place + 1,
                vector: false,
                unit: parameter.unit.clone(),
                formula: None,
            });
            self.names
                .parameters
                .push((name.clone(), parameter.unit.clone()));
        }
        first
    }

    /// Enters what the fit found of the parameters' covariance.
    fn enter_fit(
        &mut self,
        fit: Fit,
        stated: &Stated<FitTable>,
        register: &mut Register,
    ) -> Fitted {
        let dof = if fit.stated {
            f64::INFINITY
        } else {
            fit.dof as f64
        };
        let how = match (fit.stated, fit.weighted) {
            (true, _) => format_smolstr!(
                "least squares, n = {}, u of the data as stated",
                fit.points()
            ),
            (false, false) => format_smolstr!(
                "least squares, n = {}, s = {}",
                fit.points(),
                show(fit.residual_sd.unwrap_or_default())
            ),
            (false, true) => format_smolstr!(
                "least squares, n = {}, u of the data times {}",
                fit.points(),
                show(fit.residual_sd.unwrap_or_default())
            ),
        };
        let exact = fit.parameters.iter().any(|parameter| parameter.u == 0.0);
        let mut members = Vec::new();
        for parameter in fit.parameters.iter().filter(|_| !exact) {
            let Some(distribution) = self.t_or_normal(parameter.u, dof, &stated.key) else {
                break;
            };
            let alone = register.inputs[parameter.input].terms.is_empty();
            let draft = Box::new(Draft {
                label: "fit".into(),
                named: None,
                distribution,
                u: parameter.u,
                dof,
                evaluation: if fit.stated {
                    Evaluation::TypeB
                } else {
                    Evaluation::TypeA
                },
                how: how.clone(),
                location: Location::None,
                findings: Vec::new(),
                kind: Kind::Other,
                follows: None,
                certificate: None,
                reference: fit.reference.clone(),
                place: stated.span.clone(),
                stated: stated.key.clone(),
                readings: None,
            });
            let owner = Owner::Input(parameter.input);
            let name = parameter.name.as_str().into();
            let component = register.add(owner, &name, &parameter.unit, draft, alone);
            register.act(parameter.input, component, 1.0);
            members.push(component);
        }
        Fitted {
            correlation: fit.correlation.clone(),
            fit,
            members,
            place: stated.key.clone(),
        }
    }

    /// The groups of correlated components that fits make: their parameters, and the scatter of further
    /// readings, which has the same residual standard deviation and so the same ν.
    pub(super) fn fit_groups(&mut self, fitted: &[Fitted], register: &Register) -> Vec<Group> {
        let mut groups = Vec::new();
        for found in fitted {
            let scatter = register
                .scatter
                .iter()
                .filter(|(fit, _)| self.scatters[*fit].is(&found.fit.name))
                .map(|(_, component)| *component);
            let members: Vec<usize> = found.members.iter().copied().chain(scatter).collect();
            if members.len() < 2 {
                continue;
            }
            let own = found.members.len();
            let correlation = DMatrix::from_fn(members.len(), members.len(), |i, j| {
                if i < own && j < own {
                    found.correlation[(i, j)]
                } else {
                    f64::from(u8::from(i == j))
                }
            });
            groups.extend(self.join(members, correlation, register, &found.place));
        }
        groups
    }

    /// Reports fits that no measurand depends on.
    pub(super) fn unused_fits(
        &mut self,
        file: &FileTable,
        model: &Model,
        constants: usize,
        register: &Register,
    ) {
        let unused = model.unused_symbols();
        let parameters = self.names.parameters.len();
        let idle = |name: &str| {
            let place = register.entries[..parameters]
                .iter()
                .position(|entry| entry.name == name);
            place.is_none_or(|place| unused.contains(&(constants + place)))
        };
        let scatters = self.scatters.clone();
        for (index, ((name, stated), scatter)) in
            entries(&file.fit).iter().zip(&scatters).enumerate()
        {
            let used = scatter.parameters.iter().any(|parameter| !idle(parameter))
                || register.scatter.iter().any(|(fit, _)| *fit == index);
            if scatter.parameters.is_empty() || used {
                continue;
            }
            self.report(
                Fault::new(
                    UNUSED,
                    stated.key.clone(),
                    say!("no measurand depends on the fit {name}"),
                )
                .label(say!("not used in any model"))
                .help(say!(
                    "use {} in a model, or remove the fit; without any [measurand] its parameters are reported",
                    scatter.parameters.join(" or ")
                )),
            );
        }
    }

    /// The file with the parameters of its fits as measurands where it states none.
    pub(super) fn reporting_fits<'f>(&self, file: &'f FileTable) -> Cow<'f, FileTable> {
        let none = entries(&file.measurand).is_empty()
            && !file.present.iter().any(|(key, _)| *key == "measurand");
        if !none || self.names.parameters.is_empty() {
            return Cow::Borrowed(file);
        }
        let Some(first) = entries(&file.fit).first().map(|(_, stated)| stated.clone()) else {
            return Cow::Borrowed(file);
        };
        let described: HashMap<String, Box<Stated<String>>> = entries(&file.fit)
            .iter()
            .filter_map(|(_, fit)| fit.value.parameters.as_ref())
            .flat_map(|stated| &stated.value.0.entries)
            .filter_map(|(name, entry)| Some((name.to_string(), entry.value.description.clone()?)))
            .collect();
        let measurands = self.names.parameters.iter().map(|(name, _)| {
            let table = MeasurandTable {
                description: described.get(name).cloned(),
                ..MeasurandTable::default()
            };
            (name.as_str().into(), first.map(|_| table))
        });
        let mut file = file.clone();
        let measurands = Named {
            entries: measurands.collect(),
            refused: false,
        };
        file.measurand = Some(Box::new(first.map(|_| measurands)));
        Cow::Owned(file)
    }

    /// The unit of a measurand: as stated, or that of the parameter which it reports.
    pub(super) fn measurand_unit(&mut self, name: &str, stated: &Slot<String>) -> Option<Unit> {
        match (stated, self.parameter_unit(name)) {
            (None, Some(unit)) => Some(unit.clone()),
            _ => self.unit(stated),
        }
    }

    /// The unit of a parameter of a fit that is reported as it is.
    pub(super) fn parameter_unit(&self, name: &str) -> Option<&Unit> {
        let (_, unit) = self.names.parameters.iter().find(|(own, _)| own == name)?;
        unit.as_ref()
    }
}

/// Names that formulas may use already. A measurand may be called like the parameter that it reports.
fn names(file: &FileTable) -> HashMap<String, Range<usize>> {
    let mut names = HashMap::new();
    let constants = entries(&file.constant).iter().map(|(n, s)| (n, &s.key));
    let inputs = entries(&file.input).iter().map(|(n, s)| (n, &s.key));
    let sources = shared(file).iter().map(|(n, s)| (n, &s.key));
    for (name, place) in constants.chain(inputs).chain(sources) {
        names.insert(name.to_string(), place.clone());
    }
    names
}
