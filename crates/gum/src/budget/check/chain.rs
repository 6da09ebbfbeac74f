//! Puts together what a budget states itself and what it takes from other files.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use serde_json::Value;

use super::checker::Checker;
use super::register::Register;
use super::taken::{Formula, OtherResult, Taken};
use crate::budget::chain::{Chain, Ensemble, Identity, Member, Part, TakenResult, prefixes};
use crate::budget::faults::SAVED_STALE;
use crate::budget::saved::SavedResults;
use crate::budget::tables::FileTable;
use crate::budget::{Budget, Component, Group, Input, Loaded, Owner, TScale, Term};
use gumption_core::distribution::Distribution;
use gumption_fault::language::Language;
use gumption_fault::{Fault, Said, say};
use smol_str::{SmolStr, format_smolstr};

/// A budget while results of other files come into it.
struct Merge<'a> {
    register: &'a mut Register,
    chain: Chain,
    inputs: HashMap<Identity, usize>,
    components: HashMap<Identity, usize>,
    /// How many inputs and components are the file's own.
    own: (usize, usize),
}

impl Checker<'_> {
    /// Adds what the inputs with `from` bring along to the inputs, components and groups.
    pub(super) fn chain(
        &mut self,
        file: &FileTable,
        row: Option<&str>,
        register: &mut Register,
        groups: &mut Vec<Group>,
    ) -> Chain {
        let part = Part {
            file: self.source.origin.file.into(),
            row: row.map(Into::into),
        };
        let taken = std::mem::take(&mut register.taken);
        let before = groups.len();
        let mut merge = Merge::new(&part, file, register, groups);
        if !taken.is_empty() {
            merge.look_up();
        }
        for one in &taken {
            if let Err(stale) = merge.take(one) {
                self.report(*stale);
            }
        }
        let Merge {
            mut chain,
            own,
            components,
            ..
        } = merge;
        rename(&part, own, &mut chain, register);
        let brought = chain.ensembles.iter().skip(before);
        groups.extend(
            brought.filter_map(|ensemble| {
                ensemble.reduced(|identity| components.get(identity).copied())
            }),
        );
        self.remarks_of(&part, &taken, &mut chain, register);
        chain
    }

    /// The remarks of all files, and those about the results that are used.
    fn remarks_of(&mut self, part: &Part, taken: &[Taken], chain: &mut Chain, register: &Register) {
        for one in taken {
            let name = register.entries[one.entry].name.clone();
            let file = &one.file;
            match &one.result {
                OtherResult::Saved { saved, result } => {
                    let saved = &saved.results[*result];
                    let y = &saved.measurand;
                    if !saved.trusted && saved.judged {
                        self.remark(say!("{name}: the model of {y} in {file} is not linear, and Monte Carlo did not validate its GUM result; the saved result is that GUM result in linear form. `from = {{ budget = … }}` takes over the model itself."));
                    } else if !saved.trusted {
                        self.remark(say!("{name}: the model of {y} in {file} is not linear, and its GUM result was saved without validation by Monte Carlo."));
                    }
                }
                OtherResult::Budget { loaded, row, .. } => {
                    let budget = &loaded.rows[*row].budget;
                    self.other_t_scale(budget, file);
                }
            }
        }
        let others = std::mem::take(&mut chain.remarks);
        let parts: Vec<Part> = others.iter().map(|(part, _)| part.clone()).collect();
        let own = self.messages.remarks.iter().cloned();
        chain.remarks = own.map(|remark| (part.clone(), remark)).collect();
        for ((from, remark), prefix) in others.into_iter().zip(prefixes(&parts)) {
            self.remark(Said::pair(
                format!("{prefix}: {remark}"),
                format!("{prefix}：{}", remark.in_language(Language::Chinese)),
            ));
            chain.remarks.push((from, remark));
        }
    }

    /// Says so where another file takes u of a t distribution for something else.
    fn other_t_scale(&mut self, budget: &Budget, file: &str) {
        let student = |c: &Component| matches!(c.distribution, Distribution::StudentT(_));
        if budget.conventions.t_scale == self.conventions.t_scale
            || !budget.components.iter().any(student)
        {
            return;
        }
        self.remark(match budget.conventions.t_scale {
            TScale::Scale => say!("{file}: for its own components with a t distribution u is the scale of t, as that file says."),
            TScale::StandardDeviation => say!("{file}: for its own components with a t distribution u is the standard deviation of t, as that file says."),
        });
    }
}

impl<'a> Merge<'a> {
    /// The budget as the file alone states it.
    fn new(part: &Part, file: &FileTable, register: &'a mut Register, groups: &[Group]) -> Self {
        let identity = |name: &SmolStr| Identity {
            part: part.clone(),
            name: name.clone(),
        };
        let inputs: Vec<Identity> = register.inputs.iter().map(|x| identity(&x.name)).collect();
        let components: Vec<Identity> = register
            .components
            .iter()
            .map(|c| identity(&c.name))
            .collect();
        let member = |index: &usize| Member {
            identity: components[*index].clone(),
            component: register.components[*index].clone(),
        };
        let ensembles = groups.iter().map(|group| {
            Arc::new(Ensemble {
                members: group.members.iter().map(member).collect(),
                correlation: Arc::clone(&group.correlation),
                law: group.law.clone(),
                dof: group.dof,
            })
        });
        let mut chain = Chain {
            own: Some(part.clone()),
            ensembles: ensembles.collect(),
            ..Chain::default()
        };
        let units: Vec<(String, String)> = super::entries::entries(&file.unit)
            .iter()
            .map(|(name, definition)| (name.to_string(), definition.value.clone()))
            .collect();
        if !units.is_empty() {
            chain.units.insert(Arc::clone(&part.file), units);
        }
        let own = (inputs.len(), components.len());
        Merge {
            inputs: HashMap::new(),
            components: HashMap::new(),
            chain: Chain {
                inputs,
                components,
                ..chain
            },
            register,
            own,
        }
    }

    /// Prepares for looking up what the file has of its own.
    fn look_up(&mut self) {
        let places = |list: &[Identity]| list.iter().cloned().zip(0..).collect();
        self.inputs = places(&self.chain.inputs);
        self.components = places(&self.chain.components);
    }

    fn take(&mut self, taken: &Taken) -> std::result::Result<(), Box<Fault>> {
        match &taken.result {
            OtherResult::Budget {
                loaded,
                row,
                output,
            } => self.take_budget(taken, loaded, *row, *output),
            OtherResult::Saved { saved, result } => self.take_saved(taken, saved, *result),
        }
    }

    fn take_budget(
        &mut self,
        taken: &Taken,
        loaded: &Loaded,
        row: usize,
        output: usize,
    ) -> std::result::Result<(), Box<Fault>> {
        let budget = &loaded.rows[row].budget;
        let needed = budget.model.inputs_of(output);
        let mut places = vec![0; budget.model.inputs()];
        for (index, place) in places.iter_mut().enumerate() {
            if needed[index] {
                *place = self.input(taken, budget, index)?;
            }
        }
        let found = &budget.model.outputs()[output];
        let entry = &mut self.register.entries[taken.entry];
        entry.formula = Some(Formula {
            model: Arc::new(budget.model.clone()),
            output,
            places,
        });
        self.chain.taken.push(TakenResult {
            input: entry.name.to_string(),
            file: taken.file.clone(),
            row: loaded.rows[row].label.clone(),
            measurand: found.name.clone(),
            title: loaded.heading.title.clone(),
            equation: Some(found.equation.clone()),
        });
        self.rest(
            taken,
            &budget.chain.ensembles,
            &budget.chain.remarks,
            budget.chain.units.iter(),
        )
    }

    fn take_saved(
        &mut self,
        taken: &Taken,
        saved: &SavedResults,
        result: usize,
    ) -> std::result::Result<(), Box<Fault>> {
        let found = &saved.results[result];
        let entry = &self.register.entries[taken.entry];
        let (name, place) = (entry.name.clone(), entry.places.start);
        let unit = self.register.inputs[place].unit.clone();
        let factor = found.unit.conversion_to(&unit).map_or(1.0, |c| c.factor);
        for (member, sensitivity) in &found.terms {
            let Member {
                identity,
                component,
            } = &saved.members[*member];
            let index = self.component(taken, identity, component, place)?;
            self.register.act(place, index, factor * sensitivity);
        }
        self.chain.taken.push(TakenResult {
            input: name.to_string(),
            file: taken.file.clone(),
            row: found.row.clone(),
            measurand: found.measurand.clone(),
            title: saved.title.clone(),
            equation: None,
        });
        let units = saved.units.iter().map(|(file, units)| (file, units));
        self.rest(taken, &saved.ensembles, &saved.remarks, units)
    }

    /// Groups, remarks and units of the other file.
    fn rest<'u>(
        &mut self,
        taken: &Taken,
        ensembles: &[Arc<Ensemble>],
        remarks: &[(Part, Said)],
        units: impl Iterator<Item = (&'u Arc<Path>, &'u Vec<(String, String)>)>,
    ) -> std::result::Result<(), Box<Fault>> {
        for ensemble in ensembles {
            match self.chain.ensembles.iter().find(|own| own.meets(ensemble)) {
                None => self.chain.ensembles.push(Arc::clone(ensemble)),
                Some(own) if same_group(own, ensemble) => {}
                Some(_) => {
                    let names: Vec<&str> = ensemble
                        .members
                        .iter()
                        .map(|member| &*member.identity.name)
                        .collect();
                    let file = &ensemble.members[0].identity.part.file;
                    return Err(stale(
                        file,
                        say!("the correlations of {}", names.join(", ")),
                        &taken.place,
                    ));
                }
            }
        }
        for remark in remarks {
            if !self.chain.remarks.contains(remark) {
                self.chain.remarks.push(remark.clone());
            }
        }
        for (file, units) in units {
            self.chain
                .units
                .entry(Arc::clone(file))
                .or_insert_with(|| units.clone());
        }
        Ok(())
    }

    /// The place of an input of another budget, which is added if it is not there yet.
    fn input(
        &mut self,
        taken: &Taken,
        budget: &Budget,
        index: usize,
    ) -> std::result::Result<usize, Box<Fault>> {
        let identity = &budget.chain.inputs[index];
        if let Some(place) = self.inputs.get(identity) {
            return Ok(*place);
        }
        let theirs = &budget.inputs[index];
        let place = self.register.inputs.len();
        self.register.inputs.push(Input {
            group: taken.group.clone(),
            terms: Vec::new(),
            ..theirs.clone()
        });
        self.inputs.insert(identity.clone(), place);
        self.chain.inputs.push(identity.clone());
        for Term {
            component,
            coefficient,
        } in &theirs.terms
        {
            let identity = &budget.chain.components[*component];
            let own = self.component(taken, identity, &budget.components[*component], place)?;
            let follows = budget.follows(index, *component);
            self.register.follow(place, own, *coefficient, follows);
            self.register.act(place, own, *coefficient);
        }
        Ok(place)
    }

    /// The index of a component of another file that acts on an input.
    fn component(
        &mut self,
        taken: &Taken,
        identity: &Identity,
        theirs: &Component,
        place: usize,
    ) -> std::result::Result<usize, Box<Fault>> {
        if let Some(index) = self.components.get(identity) {
            let own = &self.register.components[*index];
            return if same_component(own, theirs) {
                Ok(*index)
            } else {
                let file = &identity.part.file;
                Err(stale(file, identity.name.to_string(), &taken.place))
            };
        }
        let owner = match &theirs.owner {
            Owner::Source(name) if !name.is_empty() => Owner::Source(name.clone()),
            _ => Owner::Input(place),
        };
        self.register.components.push(Component {
            owner,
            ..theirs.clone()
        });
        let index = self.register.components.len() - 1;
        self.components.insert(identity.clone(), index);
        self.chain.components.push(identity.clone());
        Ok(index)
    }
}

/// Gives everything from other files the names that it has in this budget.
fn rename(
    own: &Part,
    (inputs, components): (usize, usize),
    chain: &mut Chain,
    register: &mut Register,
) {
    let mut parts: Vec<Part> = Vec::new();
    for identity in chain.inputs.iter().chain(&chain.components) {
        if identity.part != *own && !parts.contains(&identity.part) {
            parts.push(identity.part.clone());
        }
    }
    let prefixes = prefixes(&parts);
    let prefix = |identity: &Identity| {
        let at = parts.iter().position(|part| *part == identity.part);
        at.and_then(|at| prefixes.get(at))
            .map_or("", String::as_str)
    };
    let added = register.inputs.iter_mut().zip(&chain.inputs).skip(inputs);
    for (input, identity) in added {
        let prefix = prefix(identity);
        input.name = format_smolstr!("{prefix}.{}", identity.name);
        input.group.get_or_insert_with(|| prefix.to_string());
    }
    let added = register.components.iter_mut().zip(&chain.components);
    for (component, identity) in added.skip(components) {
        let prefix = prefix(identity);
        component.name = format_smolstr!("{prefix}.{}", identity.name);
        if let Owner::Source(name) = &mut component.owner {
            let bare = name.rsplit('.').next().unwrap_or_default().to_string();
            *name = format!("{prefix}.{bare}");
        }
    }
}

/// Figures that differ by no more are the same: another version of the program may sum in another order,
/// while a change of the file is larger.
const ROUNDING: f64 = 1e-9;

/// Whether two numbers are the same but for rounding; `scale` is the size that matters where both are small.
fn near(a: f64, b: f64, scale: f64) -> bool {
    a == b || (a - b).abs() <= ROUNDING * a.abs().max(b.abs()).max(scale)
}

/// Whether two files mean the same thing by a component.
fn same_component(a: &Component, b: &Component) -> bool {
    near(a.u, b.u, 0.0)
        && near(a.dof, b.dof, 0.0)
        && same_distribution(&a.distribution, &b.distribution, a.u)
        && a.unit.dimension == b.unit.dimension
        && near(a.unit.factor.ratio(b.unit.factor), 1.0, 0.0)
}

/// Whether two distributions are of one kind and have the same parameters.
fn same_distribution(a: &Distribution, b: &Distribution, u: f64) -> bool {
    match (serde_json::to_value(a), serde_json::to_value(b)) {
        (Ok(a), Ok(b)) => same_value(&a, &b, u),
        _ => a == b,
    }
}

fn same_value(a: &Value, b: &Value, scale: f64) -> bool {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => match (x.as_f64(), y.as_f64()) {
            (Some(x), Some(y)) => near(x, y, scale),
            _ => x == y,
        },
        (Value::Array(x), Value::Array(y)) => {
            x.len() == y.len() && x.iter().zip(y).all(|(x, y)| same_value(x, y, scale))
        }
        (Value::Object(x), Value::Object(y)) => {
            let same =
                |(key, x): (&String, &Value)| y.get(key).is_some_and(|y| same_value(x, y, scale));
            x.len() == y.len() && x.iter().all(same)
        }
        _ => a == b,
    }
}

/// Whether two files correlate the same components alike.
fn same_group(a: &Ensemble, b: &Ensemble) -> bool {
    let names = |e: &Ensemble| -> Vec<Identity> {
        let members = e.members.iter();
        members.map(|member| member.identity.clone()).collect()
    };
    let matrices = a.correlation.iter().zip(&*b.correlation);
    let dof = match (a.dof, b.dof) {
        (Some(a), Some(b)) => near(a, b, 0.0),
        (a, b) => a == b,
    };
    // Scales and latent correlations follow from the components and these.
    names(a) == names(b)
        && a.correlation.shape() == b.correlation.shape()
        && matrices.into_iter().all(|(a, b)| near(*a, *b, 1.0))
        && std::mem::discriminant(&a.law) == std::mem::discriminant(&b.law)
        && dof
}

fn stale(file: &Path, what: impl Into<Said>, place: &Range<usize>) -> Box<Fault> {
    let (file, what) = (file.file_name().unwrap_or_default().display(), what.into());
    let fault = Fault::new(
        SAVED_STALE,
        place.clone(),
        say!("{file} has changed since the result was saved, in {what}"),
    )
    .label(say!("does not fit the rest of this budget"))
    .help(say!("evaluate {file} again and save its results anew"));
    Box::new(fault)
}
