//! The inputs and components of a budget while it is put together.

use std::collections::HashMap;
use std::ops::Range;

use super::draft::{Draft, Kind};
use super::taken::{Formula, Taken};
use crate::budget::faults::UNKNOWN_NAME;
use crate::budget::tables::InputTable;
use crate::budget::{Analysis, Component, Following, Follows, Input, Owner, Term};
use gumption_core::distribution::{Distribution, StudentT};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Stated;
use smol_str::{SmolStr, format_smolstr};

/// One `[input.X]`.
#[derive(Debug, Clone)]
pub(super) struct InputEntry {
    pub name: SmolStr,
    /// Place of its header.
    pub place: Range<usize>,
    /// Its places in the input vector.
    pub places: Range<usize>,
    pub vector: bool,
    /// Nothing when the unit was refused.
    pub unit: Option<Unit>,
    /// What stands behind the result of another budget.
    pub formula: Option<Formula>,
}

/// One `[source.S]`.
#[derive(Debug, Clone)]
pub(super) struct SourceEntry {
    pub name: String,
    pub unit: Option<Unit>,
    pub components: Vec<usize>,
    pub used: bool,
}

/// What has been checked so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Register {
    pub inputs: Vec<Input>,
    /// Where the inputs stand by their names, from when all are there.
    pub places: HashMap<SmolStr, usize>,
    pub components: Vec<Component>,
    pub entries: Vec<InputEntry>,
    pub sources: Vec<SourceEntry>,
    /// Results of other files.
    pub taken: Vec<Taken>,
    /// Readings behind a Type A component.
    pub readings: HashMap<usize, Vec<f64>>,
    /// Analyses of readings.
    pub analyses: Vec<Analysis>,
    /// Elements of vectors that share one standard deviation of finite ν.
    pub families: Vec<Vec<usize>>,
    /// Components that are the scatter of data about a fit: the number of the fit, the component.
    pub scatter: Vec<(usize, usize)>,
    /// Inputs whose uncertainty a covariance matrix states.
    pub by_matrix: Vec<String>,
    /// Inputs of a joint statement that was refused, which may have been meant to state their uncertainty.
    pub by_refused: Vec<String>,
    /// Components whose effect follows the estimate of an input.
    pub following: Vec<Following>,
    /// Whether something was refused, so that correlations of it cannot be checked.
    pub incomplete: bool,
}

impl Register {
    /// Adds a component; `alone` when the owner has no other.
    pub fn add(
        &mut self,
        owner: Owner,
        owner_name: &SmolStr,
        unit: &Unit,
        draft: Box<Draft>,
        alone: bool,
    ) -> usize {
        let name = if alone {
            owner_name.clone()
        } else {
            format_smolstr!("{owner_name}.{}", draft.label)
        };
        let analysed = draft.findings.into_iter().map(|found| Analysis {
            name: name.to_string(),
            unit: unit.clone(),
            found,
        });
        self.analyses.extend(analysed);
        if let Kind::Scatter(fit) = draft.kind {
            self.scatter.push((fit, self.components.len()));
        }
        self.components.push(Component {
            name,
            label: draft.label,
            owner,
            unit: unit.difference(),
            distribution: draft.distribution,
            u: draft.u,
            dof: draft.dof,
            evaluation: draft.evaluation,
            how: draft.how,
            certificate: draft.certificate,
            reference: draft.reference,
        });
        self.components.len() - 1
    }

    /// Notes how a component that is about to act on an input follows its estimate. Of several actions of
    /// one cause, those in proportion are a share of the sum.
    pub fn follow(
        &mut self,
        place: usize,
        component: usize,
        coefficient: f64,
        follows: Option<Follows>,
    ) {
        let share_of = |rule: Option<Follows>| match rule {
            Some(Follows::Proportion { share }) => share,
            _ => 0.0,
        };
        let terms = self.inputs.get(place).map_or(&[][..], |input| &input.terms);
        let before = terms.iter().find(|term| term.component == component);
        let known = self
            .following
            .iter()
            .position(|f| f.input == place && f.component == component);
        let rule = match before {
            None => follows,
            Some(term) => {
                let earlier = known.map(|index| self.following[index].rule);
                let moving = term.coefficient * share_of(earlier) + coefficient * share_of(follows);
                let share = moving / (term.coefficient + coefficient);
                Some(Follows::Proportion { share }).filter(|_| share.is_finite() && share != 0.0)
            }
        };
        if let Some(index) = known {
            self.following.remove(index);
        }
        self.following.extend(rule.map(|rule| Following {
            input: place,
            component,
            rule,
        }));
    }

    /// Lets a component act on an input; several actions of one cause add up.
    pub fn act(&mut self, place: usize, component: usize, coefficient: f64) {
        let Some(input) = self.inputs.get_mut(place) else {
            return;
        };
        match input
            .terms
            .iter_mut()
            .find(|term| term.component == component)
        {
            Some(term) => term.coefficient += coefficient,
            None => input.terms.push(Term {
                component,
                coefficient,
            }),
        }
    }

    /// What an input of this name takes over from another file.
    pub fn taken_as(&self, name: &str) -> Option<&Taken> {
        let named = |taken: &&Taken| self.entries[taken.entry].name == name;
        self.taken.iter().find(named)
    }

    /// Prepares for looking up inputs, of which there will be no more.
    pub fn index(&mut self) {
        let named = self.inputs.iter().enumerate();
        let named = named.map(|(place, input)| (input.name.clone(), place));
        // Of a name that is stated twice, the first.
        self.places = named.rev().collect();
    }

    /// The components behind a name: an input, an element, a source, or a component.
    pub fn lookup(&self, name: &str) -> Option<Vec<usize>> {
        if let Some(place) = self.places.get(name) {
            return Some(self.own(*place));
        }
        if let Some(source) = self.sources.iter().find(|source| source.name == name) {
            return Some(source.components.clone());
        }
        let named =
            |component: &Component| component.name == name || self.long_name(component) == name;
        self.components
            .iter()
            .position(named)
            .map(|index| vec![index])
    }

    /// A component's name with its label, also where it is the only one of its owner.
    fn long_name(&self, component: &Component) -> String {
        let owner = match &component.owner {
            Owner::Source(name) => name.as_str(),
            Owner::Input(place) => self
                .inputs
                .get(*place)
                .map_or("", |input| input.name.as_str()),
        };
        format!("{owner}.{}", component.label)
    }

    /// Components of an input that are its own (not shared causes).
    pub fn own(&self, place: usize) -> Vec<usize> {
        let terms = self.inputs.get(place).map_or(&[][..], |input| &input.terms);
        terms
            .iter()
            .map(|term| term.component)
            .filter(|index| self.is_own(*index, place))
            .collect()
    }

    fn is_own(&self, component: usize, place: usize) -> bool {
        self.components
            .get(component)
            .is_some_and(|component| component.owner == Owner::Input(place))
    }

    /// Every name that a correlation may use.
    pub fn names(&self) -> Vec<String> {
        let inputs = self.inputs.iter().map(|input| input.name.to_string());
        let sources = self.sources.iter().map(|source| source.name.clone());
        inputs
            .chain(sources)
            .chain(
                self.components
                    .iter()
                    .map(|component| self.long_name(component)),
            )
            .collect()
    }
}

/// Whether two components have the same kind of distribution for a common joint one.
pub(super) fn t_dof(distribution: &Distribution) -> Option<f64> {
    match distribution {
        Distribution::StudentT(StudentT { dof, .. }) => Some(*dof),
        _ => None,
    }
}

/// A name that is none of the inputs.
pub(super) fn no_such_input(name: &Stated<String>, known: &[&str]) -> Fault {
    let help = match nearest(&name.value, known.iter().copied()) {
        Some(near) => say!("did you mean \"{near}\"?"),
        None => say!("inputs: {}", known.join(", ")),
    };
    let message = say!("there is no input \"{}\"", name.value);
    Fault::new(UNKNOWN_NAME, name.span.clone(), message)
        .label(say!("not declared"))
        .help(help)
}

/// `U[3]`, counted from 1.
pub(super) fn element_name(name: &str, element: usize) -> String {
    format!("{name}[{}]", element + 1)
}

/// An input of which nothing is known yet but its words.
pub(super) fn blank(
    name: &SmolStr,
    table: &InputTable,
    unit: Option<&Unit>,
    element: Option<usize>,
) -> Input {
    Input {
        name: element.map_or_else(
            || name.clone(),
            |element| element_name(name, element).into(),
        ),
        description: table.description.as_ref().map(|text| text.value.clone()),
        group: table.group.as_ref().map(|text| text.value.clone()),
        unit: unit.cloned().unwrap_or_else(Unit::one),
        estimate: f64::NAN,
        terms: Vec::new(),
    }
}
