//! From the components of the checked inputs to errors that act on the points.

use nalgebra::DMatrix;

use super::checker::Checker;
use super::doubt::{Act, Doubt, Growth, Scope, Target};
use super::faults::KEY;
use super::known::Known;
use super::source::entries;
use super::tables::ScopeWord;
use gumption_core::distribution::{Distribution, Normal};
use gumption_core::least_squares::lower_factor;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;
use gumption_gum::budget::quantities::Quantities;
use gumption_gum::budget::{Evaluation, Follows, Group, Owner};

/// Every component as an error, correlated ones as sums of independent errors; `inputs` are the names of
/// the inputs that the equations see.
pub(crate) fn of(
    checker: &mut Checker<'_>,
    stated: &Quantities,
    known: &[Known<'_>],
    inputs: &[String],
) -> Option<Vec<Doubt>> {
    let before = checker.faults.len();
    let found: Vec<Found> = (0..stated.components.len())
        .map(|index| Found::of(checker, stated, known, inputs, index))
        .collect();
    let is_correlated = |index: usize| {
        let mut groups = stated.groups.iter();
        groups.any(|group| group.members.contains(&index))
    };
    for (index, one) in found.iter().enumerate() {
        if let Some(prior) = &one.prior
            && (is_correlated(index) || !one.acts.is_empty())
        {
            checker.faults.push(shared_by_prior(prior));
        }
    }
    let mut doubts: Vec<Doubt> = found
        .iter()
        .enumerate()
        .filter(|(index, one)| !one.acts.is_empty() && !is_correlated(*index))
        .flat_map(|(index, one)| in_parts(one.doubt(stated, index)))
        .collect();
    for group in &stated.groups {
        match factored(stated, group, &found) {
            Some(parts) => doubts.extend(parts),
            None => checker.faults.push(scopes_differ(checker, stated, group)),
        }
    }
    (checker.faults.len() == before).then_some(doubts)
}

/// What a component acts on.
struct Found {
    acts: Vec<Act>,
    scope: Scope,
    /// The place and the name of a partly known parameter that it makes uncertain.
    prior: Option<Stated<String>>,
}

impl Found {
    fn of(
        checker: &Checker<'_>,
        stated: &Quantities,
        known: &[Known<'_>],
        inputs: &[String],
        index: usize,
    ) -> Found {
        let component = &stated.components[index];
        let mut found = Found {
            acts: Vec::new(),
            scope: match &component.owner {
                Owner::Source(name) => scope_of_source(checker, name),
                Owner::Input(_) => Scope::Common,
            },
            prior: None,
        };
        for one in known {
            let name = one.own_name();
            let input = stated.inputs.iter().find(|input| input.name == name);
            let terms = input.iter().flat_map(|input| &input.terms);
            for term in terms.filter(|term| term.component == index) {
                let on = if one.is_reading {
                    Target::Reading(one.name.to_owned())
                } else if let Some(place) = inputs.iter().position(|other| other == one.name) {
                    Target::Input(place)
                } else {
                    found.prior = Some(Stated {
                        value: one.name.to_owned(),
                        span: one.entry.key.clone(),
                        key: one.entry.key.clone(),
                    });
                    continue;
                };
                if !matches!(component.owner, Owner::Source(_)) {
                    found.scope = scope_of(one);
                }
                let following = stated.following.iter();
                let mut following = following
                    .filter(|one| one.component == index && stated.inputs[one.input].name == name);
                found.acts.push(Act {
                    on,
                    coefficient: term.coefficient * one.factor,
                    growth: following
                        .next()
                        .filter(|_| one.is_reading)
                        .map(|following| Growth {
                            at: one.factor,
                            rule: following.rule,
                        }),
                });
            }
        }
        found
    }

    fn doubt(&self, stated: &Quantities, index: usize) -> Doubt {
        let component = &stated.components[index];
        Doubt {
            name: component.name.to_string(),
            acts: self.acts.clone(),
            scope: self.scope.clone(),
            u: component.u,
            by: None,
            dof: component.dof,
            unit: component.unit.clone(),
            distribution: component.distribution.clone(),
            evaluation: component.evaluation,
            how: component.how.to_string(),
            certificate: component.certificate.clone(),
        }
    }
}

/// An error that readings share and of which one part is in proportion to them and the rest is not, as of limits of so much of the
/// reading and so much of the range, as two independent ones of one name: that of the gain has the sign of each reading, that of
/// the zero has not. An error that each reading has by itself has no sign, and is one.
fn in_parts(doubt: Doubt) -> Vec<Doubt> {
    let is_mixed = |act: &Act| {
        let rule = act.growth.map(|growth| growth.rule);
        matches!(rule, Some(Follows::Proportion { share }) if share > 0.0 && share < 1.0)
    };
    if doubt.scope == Scope::Each || !doubt.acts.iter().any(is_mixed) {
        return vec![doubt];
    }
    let with = |part: fn(Act) -> Act| Doubt {
        acts: doubt.acts.iter().cloned().map(part).collect(),
        ..doubt.clone()
    };
    vec![with(Act::of_gain), with(Act::of_zero)]
}

/// Correlated errors as sums of independent normal ones, by the Cholesky factor of their correlation
/// matrix. Together they are one cause, of one name. `None` where one error of one member acts on other
/// points than one of another.
fn factored(stated: &Quantities, group: &Group, found: &[Found]) -> Option<Vec<Doubt>> {
    let members: Vec<usize> = (0..group.members.len())
        .filter(|place| !found[group.members[*place]].acts.is_empty())
        .collect();
    let component = |place: usize| &stated.components[group.members[place]];
    let scope = &found[group.members[*members.first()?]].scope;
    let mut scopes = members.iter().map(|p| &found[group.members[*p]].scope);
    if !scopes.all(|other| other == scope) {
        return None;
    }
    let r = DMatrix::from_fn(members.len(), members.len(), |i, j| {
        group.correlation[(members[i], members[j])]
    });
    let factor = lower_factor(&r);
    let names: Vec<String> = members
        .iter()
        .map(|p| component(*p).name.to_string())
        .collect();
    let dofs = members.iter().map(|place| component(*place).dof);
    let part = |column: usize| Doubt {
        name: names.join(" & "),
        acts: members
            .iter()
            .enumerate()
            .filter(|(row, _)| factor[(*row, column)] != 0.0)
            .flat_map(|(row, place)| {
                let share = factor[(row, column)] * component(*place).u;
                let acts = &found[group.members[*place]].acts;
                acts.iter().map(move |act| Act {
                    on: act.on.clone(),
                    coefficient: act.coefficient * share,
                    growth: act.growth,
                })
            })
            .collect(),
        scope: scope.clone(),
        u: 1.0,
        by: None,
        dof: group
            .dof
            .unwrap_or_else(|| dofs.clone().fold(f64::INFINITY, f64::min)),
        unit: Unit::one(),
        distribution: Distribution::Normal(Normal { mean: 0.0, sd: 1.0 }),
        evaluation: match members
            .iter()
            .all(|place| component(*place).evaluation == Evaluation::TypeA)
        {
            true => Evaluation::TypeA,
            false => Evaluation::TypeB,
        },
        how: "r".to_owned(),
        certificate: None,
    };
    let parts = (0..members.len()).map(part);
    Some(parts.filter(|part| !part.acts.is_empty()).collect())
}

fn scope_of_source(checker: &Checker<'_>, name: &str) -> Scope {
    let mut sources = entries(&checker.source.table.source).iter();
    let Some((_, entry)) = sources.find(|(other, _)| other == name) else {
        return Scope::Common;
    };
    stated_scope(entry.value.by.as_deref(), entry.value.scope.as_deref()).unwrap_or(Scope::Common)
}

/// Readings have errors of their own unless the file says otherwise, inputs have one in common.
fn scope_of(one: &Known<'_>) -> Scope {
    let table = &one.entry.value;
    let unstated = match one.is_reading && !one.is_common() {
        true => Scope::Each,
        false => Scope::Common,
    };
    stated_scope(table.by.as_deref(), table.scope.as_deref()).unwrap_or(unstated)
}

fn stated_scope(by: Option<&Stated<String>>, scope: Option<&Stated<ScopeWord>>) -> Option<Scope> {
    by.map(|by| Scope::By(by.value.clone()))
        .or_else(|| match scope.map(|stated| stated.value)? {
            ScopeWord::Common => Some(Scope::Common),
            ScopeWord::Each => Some(Scope::Each),
        })
}

fn shared_by_prior(prior: &Stated<String>) -> Fault {
    let name = &prior.value;
    Fault::new(
        KEY,
        prior.span.clone(),
        say!("{name} is estimated, and what is known of it shares an error with other inputs or readings"),
    )
    .label(say!("listed as a parameter too"))
    .help(say!("state what is known of {name} by an uncertainty of its own, or do not list it as [parameter.{name}]"))
}

fn scopes_differ(checker: &Checker<'_>, stated: &Quantities, group: &Group) -> Fault {
    let correlations = checker.source.table.correlation.as_ref();
    let place = correlations.map_or(0..0, |list| {
        let first = list.value.0.first();
        first.map_or(list.key.clone(), |entry| entry.span.clone())
    });
    let names: Vec<String> = group
        .members
        .iter()
        .map(|index| stated.components[*index].name.to_string())
        .collect();
    Fault::new(
        KEY,
        place,
        say!(
            "{} are correlated, but one error of one acts on other points than one of another",
            names.join(", ")
        ),
    )
    .label(say!("their scopes differ"))
    .help(say!("give them the same `scope` or `by`; readings have an error for each point, inputs one in common, unless stated"))
}
