//! Correlation coefficients, and the joint distributions of correlated components.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::checker::Checker;
use super::draft::show;
use super::fits::Fitted;
use super::groups::connected;
use super::register::Register;
use super::statement::{Pair, ROUNDING, Side, Statement};
use crate::budget::faults::{
    CORRELATION_TWICE, MISSING_KEY, NOT_A_CORRELATION, PAIR_TWICE, SELF_PAIR, UNKNOWN_NAME,
};
use crate::budget::tables::{CorrelationTable, FileTable};
use crate::budget::{Component, Group, Owner};
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Stated;
use gumption_format::toml::faults::WRONG_TYPE;

/// Pairs of quantities that one statement correlates: with their places, matrices and factor they take some 160 bytes each,
/// two thirds of a gibibyte together.
const MOST_PAIRS: usize = 1 << 22;

impl Checker<'_> {
    /// The groups of correlated components.
    pub(super) fn groups(
        &mut self,
        file: &FileTable,
        fitted: &[Fitted],
        register: &mut Register,
    ) -> Vec<Group> {
        let mut statements = Vec::new();
        if file.joint.is_some() || file.correlation.is_some() {
            register.index();
        }
        let mut groups = self.joint_groups(file, register, &mut statements);
        groups.extend(self.fit_groups(fitted, register));
        let before = self.messages.faults.len();
        for stated in file
            .correlation
            .as_ref()
            .map_or(&[][..], |list| &list.value.0)
        {
            let found = self.statement(stated, register);
            statements.extend(found.unwrap_or_default());
        }
        self.twice(&statements);
        self.outside_groups(&statements, &groups, register);
        if self.messages.faults.len() > before {
            return groups;
        }
        for members in connected(&statements, &register.families, register.components.len()) {
            groups.extend(self.group(members, &statements, register));
        }
        groups
    }

    /// One statement for two names, one for each pair of several.
    fn statement(
        &mut self,
        stated: &Stated<CorrelationTable>,
        register: &Register,
    ) -> Option<Vec<Statement>> {
        let table = &stated.value;
        let (Some(between), Some(r)) = (&table.between, &table.r) else {
            if table.refused {
                return None;
            }
            let missing = if table.between.is_none() {
                "between"
            } else {
                "r"
            };
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    stated.span.clone(),
                    say!("the correlation lacks `{missing}`"),
                )
                .label(say!("`{missing}` is missing"))
                .help(say!("write between = [\"a\", \"b\"] and r = 0.3")),
            );
        };
        if between.value.len() < 2 {
            return self.refuse(
                Fault::new(
                    WRONG_TYPE,
                    between.span.clone(),
                    say!("a correlation between fewer than two quantities"),
                )
                .label(say!("expected two names or more"))
                .help(say!(
                    "write between = [\"a\", \"b\"]; with more names r holds for each pair of them"
                )),
            );
        }
        let names = between.value.len();
        let pairs = names * (names - 1) / 2;
        if pairs > MOST_PAIRS {
            return self.refuse(
                Fault::new(
                    WRONG_TYPE,
                    between.span.clone(),
                    say!("a correlation of {names} quantities, which are {pairs} pairs"),
                )
                .label(say!("expected {MOST_PAIRS} pairs at most"))
                .help(say!(
                    "state what they have in common as a [source.NAME] that feeds all of them: of a share u_s of u it makes r = u_s²/u², and takes no pairs"
                )),
            );
        }
        let sides: Vec<Option<Rc<Side>>> = between
            .value
            .iter()
            .map(|name| self.side(name, register).map(Rc::new))
            .collect();
        if !self.is_coefficient(r) {
            return None;
        }
        let sides: Vec<Rc<Side>> = sides.into_iter().collect::<Option<_>>()?;
        let mut statements = Vec::with_capacity(pairs);
        for (index, second) in sides.iter().enumerate() {
            for first in &sides[..index] {
                // The other pairs have the same fault.
                let statement = self.pair(first, second, r, register)?;
                statements.push(Statement {
                    whole: sides.len(),
                    ..statement
                });
            }
        }
        Some(statements)
    }

    /// Whether a number can be a correlation coefficient; reports it where not.
    pub(super) fn is_coefficient(&mut self, r: &Stated<f64>) -> bool {
        if (-1.0..=1.0).contains(&r.value) {
            return true;
        }
        self.report(
            Fault::new(
                NOT_A_CORRELATION,
                r.span.clone(),
                say!("a correlation coefficient of {}", r.value),
            )
            .label(say!("expected a number from -1 to 1"))
            .help(say!("r is the covariance divided by both standard uncertainties; a covariance itself is stated in [[joint]]")),
        );
        false
    }

    /// A statement about two quantities.
    pub(super) fn pair(
        &mut self,
        a: &Rc<Side>,
        b: &Rc<Side>,
        r: &Stated<f64>,
        register: &Register,
    ) -> Option<Statement> {
        // Of one name both sides have the same members.
        let common_member = || {
            a.members
                .iter()
                .any(|(m, _)| b.members.iter().any(|(n, _)| m == n))
        };
        if common_member() {
            return self.refuse(
                Fault::new(
                    SELF_PAIR,
                    b.span.clone(),
                    say!("{} is correlated with itself", a.name),
                )
                .label(say!("the same quantity"))
                .related(a.span.clone(), say!("as this one"))
                .help(say!("name two different quantities; for successive readings of one quantity write autocorrelated = true")),
            );
        }
        let common = match a.shares || b.shares {
            true => register.covariance(a.place, b.place),
            false => 0.0,
        };
        let statement = Statement {
            sides: [Rc::clone(a), Rc::clone(b)],
            r: r.value,
            coefficient: r.span.clone(),
            offset: -common / (a.own * b.own),
            whole: 2,
        };
        let own = statement.scale() * r.value + statement.offset;
        if !own.is_finite() {
            return self.refuse(
                Fault::new(
                    NOT_A_CORRELATION,
                    r.span.clone(),
                    say!(
                        "the standard uncertainties of {} and {} are too small to be correlated",
                        a.name,
                        b.name
                    ),
                )
                .label(say!("cannot be computed"))
                .help(say!(
                    "choose smaller units, so that the uncertainties are not below 1e-150"
                )),
            );
        }
        if own.abs() > 1.0 + ROUNDING {
            return self.refuse(
                Fault::new(
                    NOT_A_CORRELATION,
                    r.span.clone(),
                    say!(
                        "r = {} cannot be reached beside the shared sources of {} and {}",
                        r.value,
                        a.name,
                        b.name
                    ),
                )
                .label(say!(
                    "the shared sources alone give r = {}",
                    show(common / (a.total * b.total))
                ))
                .help(say!(
                    "leave the correlation out if it comes from those sources"
                )),
            );
        }
        Some(statement)
    }

    /// What is behind a name of a correlation statement.
    fn side(&mut self, name: &Stated<String>, register: &Register) -> Option<Side> {
        if let Some(taken) = register.taken_as(&name.value) {
            return self.refuse(taken.not_to_be_correlated(name));
        }
        let Some(members) = register.lookup(&name.value) else {
            if register.incomplete && name.value.contains(['.', '[']) {
                return None;
            }
            return self.refuse(unknown(name, register));
        };
        let place = register.places.get(name.value.as_str()).copied();
        self.side_of(name, &members, place, register)
    }

    /// What is behind a name that stands for these components, of the input at this place if it is one.
    pub(super) fn side_of(
        &mut self,
        name: &Stated<String>,
        members: &[usize],
        place: Option<usize>,
        register: &Register,
    ) -> Option<Side> {
        let u = |index: &usize| {
            register
                .components
                .get(*index)
                .map_or(0.0, |component| component.u)
        };
        let own = members
            .iter()
            .map(|index| u(index) * u(index))
            .sum::<f64>()
            .sqrt();
        if own <= 0.0 {
            if register.incomplete {
                return None;
            }
            return self.refuse(
                Fault::new(
                    UNKNOWN_NAME,
                    name.span.clone(),
                    say!(
                        "{} has no uncertainty of its own to be correlated",
                        name.value
                    ),
                )
                .label(say!(
                    "its uncertainty comes from shared sources, whose correlation is known"
                )),
            );
        }
        let total = match place {
            Some(place) => (register.covariance(Some(place), Some(place)) + own * own).sqrt(),
            None => own,
        };
        let input = place.and_then(|place| register.inputs.get(place));
        Some(Side {
            name: name.value.clone(),
            span: name.span.clone(),
            shares: input.is_some_and(|input| input.terms.len() > members.len()),
            members: members
                .iter()
                .map(|index| (*index, u(index) / own))
                .collect(),
            own,
            total,
            place,
        })
    }

    /// Reports pairs that are stated more than once.
    fn twice(&mut self, statements: &[Statement]) {
        let pairs = || statements.iter().flat_map(Statement::pairs).map(ordered);
        // A matrix states them in their order.
        if pairs().is_sorted_by(|one, next| one < next) {
            return;
        }
        // Of millions of pairs a sorted list takes a fraction of the memory of a map.
        let mut pairs: Vec<(usize, usize)> = pairs().collect();
        pairs.sort_unstable();
        if pairs.windows(2).all(|two| two[0] != two[1]) {
            return;
        }
        let mut first: HashMap<(usize, usize), &Statement> = HashMap::new();
        for later in statements {
            let earlier = later
                .pairs()
                .find_map(|pair| first.get(&ordered(pair)).copied());
            for pair in later.pairs() {
                first.entry(ordered(pair)).or_insert(later);
            }
            if let Some(earlier) = earlier {
                let [a, b] = later.names();
                self.report(
                    Fault::new(
                        PAIR_TWICE,
                        later.place(),
                        say!("the correlation of {a} and {b} is stated twice"),
                    )
                    .label(say!("second statement"))
                    .related(earlier.place(), say!("first statement"))
                    .help(say!("leave out one")),
                );
            }
        }
    }

    /// Reports correlations of components that a joint statement already correlates.
    fn outside_groups(&mut self, statements: &[Statement], groups: &[Group], register: &Register) {
        let joint: HashSet<usize> = groups
            .iter()
            .flat_map(|group| group.members.iter().copied())
            .collect();
        // Mostly; there may be millions of statements.
        if joint.is_empty() {
            return;
        }
        for statement in statements {
            let taken = statement
                .pairs()
                .flat_map(|(a, b, _)| [a, b])
                .find(|index| joint.contains(index));
            if let Some(component) = taken.and_then(|index| register.components.get(index)) {
                self.report(
                    Fault::new(
                        CORRELATION_TWICE,
                        statement.place(),
                        say!("{} is already in a [[joint]] statement", component.name),
                    )
                    .label(say!("correlated again here"))
                    .help(say!(
                        "put all its correlations into one matrix, or leave out this one"
                    )),
                );
            }
        }
    }
}

/// The components of a pair, whichever is named first. A matrix states them in this order.
fn ordered((a, b, _): Pair) -> (usize, usize) {
    (a.max(b), a.min(b))
}

fn unknown(name: &Stated<String>, register: &Register) -> Fault {
    let fault = Fault::new(
        UNKNOWN_NAME,
        name.span.clone(),
        say!("nothing is called \"{}\"", name.value),
    )
    .label(say!("not an input, a source or a component"));
    if let Some(entry) = register
        .entries
        .iter()
        .find(|entry| entry.vector && entry.name == name.value)
    {
        return fault.help(say!(
            "{0} is a vector: name its elements, \"{0}[1]\" and so on",
            entry.name
        ));
    }
    let names = register.names();
    match nearest(&name.value, names.iter().map(String::as_str)) {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault.help(say!("known names: {}", names.join(", "))),
    }
}

impl Register {
    /// Covariance of two inputs that their shared causes make; of one input, the part of its variance
    /// that comes from them.
    fn covariance(&self, a: Option<usize>, b: Option<usize>) -> f64 {
        let (Some(a), Some(b)) = (a, b) else {
            return 0.0;
        };
        let (Some(first), Some(second)) = (self.inputs.get(a), self.inputs.get(b)) else {
            return 0.0;
        };
        let of_itself = a == b;
        let shared = first.terms.iter().filter(|term| {
            let own = |owner: &Component| owner.owner == Owner::Input(a);
            !(of_itself && self.components.get(term.component).is_some_and(own))
        });
        shared
            .filter_map(|term| {
                let other = second
                    .terms
                    .iter()
                    .find(|other| other.component == term.component)?;
                let u = self.components.get(term.component)?.u;
                Some(term.coefficient * other.coefficient * u * u)
            })
            .sum()
    }
}
