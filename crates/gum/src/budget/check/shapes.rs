//! Distributions of a known shape whose width is a half-width or a standard uncertainty.

use std::ops::Range;

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, Core, show};
use crate::budget::distributions::DistributionEntry;
use crate::budget::faults::{DISTRIBUTION, DOF, MISSING_KEY, MODIFIER, NO_COVERAGE_FACTOR};
use crate::budget::tables::ComponentTable;
use gumption_core::distribution::stating::{Bell, ParameterError, ParameterRule, Width, Word};
use gumption_core::distribution::{Distribution, Entry, Normal, REGISTRY, Uniform};
use gumption_core::special::student_t_two_sided_quantile;
use gumption_fault::{Fault, Said, say};
use smol_str::{SmolStr, format_smolstr};

/// A width from the file, whose shape is still to be found.
struct Unshaped<'a> {
    table: &'a ComponentTable,
    width: Width,
    /// How the width came about.
    how: &'a SmolStr,
    context: &'a Context<'a>,
}

impl Unshaped<'_> {
    /// Where the shape is stated.
    fn place(&self) -> Range<usize> {
        let stated = self.table.distribution.as_ref();
        stated.map_or(self.context.place.clone(), |stated| stated.span.clone())
    }

    /// A parameter of the shape is missing.
    fn lacks(&self, key: &str, meaning: &'static str) -> Fault {
        let meaning = Said::plain(meaning);
        let message = say!("the distribution of {} needs `{key}`", self.context.owner);
        Fault::new(MISSING_KEY, self.place(), message)
            .label(say!("`{key}` is missing"))
            .help(say!("add `{key}`: {meaning}"))
    }
}

impl Checker<'_> {
    /// A distribution of the shape that the table states, or of the default one.
    pub(super) fn shaped(
        &mut self,
        table: &ComponentTable,
        width: Width,
        default: &'static Entry,
        how: impl Into<SmolStr>,
        context: &Context<'_>,
    ) -> Option<Core> {
        let stated = stated_shape(table);
        let shape = stated.unwrap_or(default);
        self.shape_keys(table, shape);
        let dof = self.dof(table)?;
        let how = how.into();
        let unshaped = Unshaped {
            table,
            width,
            how: &how,
            context,
        };
        let mut core = match shape.word {
            // t for finite ν where nothing is said, else normal whatever ν is.
            Word::Bell(Bell::Normal) if stated.is_some() => {
                self.bell(&unshaped, Some(Bell::Normal), dof)
            }
            Word::Bell(Bell::Normal) => self.bell(&unshaped, None, dof),
            Word::Bell(Bell::StudentT) => self.bell(&unshaped, Some(Bell::StudentT), dof),
            Word::Limits => self.limited(&unshaped, shape, 0.0),
            Word::LimitsAnd(rule) => {
                let modifier = self.modifier(&unshaped, rule)?;
                self.limited(&unshaped, shape, modifier)
            }
            Word::None => None,
        }?;
        core.dof = dof;
        Some(core)
    }

    /// A distribution whose half-width is that of its limits.
    fn limited(&mut self, unshaped: &Unshaped<'_>, shape: &Entry, modifier: f64) -> Option<Core> {
        match shape.of_width(unshaped.width, modifier, unshaped.how) {
            Ok(spread) => Some(Core::new(spread.distribution, spread.u, spread.how)),
            Err(ParameterError::NotAllowed { key, value, must }) => {
                let stated = unshaped.table.modifiers().find(|(name, _)| *name == key);
                let place = stated.map_or(unshaped.place(), |(_, place)| place.span);
                let message = say!("`{key}` of {} is {}", unshaped.context.owner, show(value));
                let fault = Fault::new(DISTRIBUTION, place, message).label(say!("must be {must}"));
                self.refuse(match shape.word {
                    Word::LimitsAnd(rule) => {
                        fault.help(say!("`{key}`: {}", Said::plain(rule.meaning)))
                    }
                    _ => fault,
                })
            }
            Err(error) => self.refuse(Fault::new(DISTRIBUTION, unshaped.place(), error.said())),
        }
    }

    /// The parameter that the name of a shape needs beside it.
    fn modifier(&mut self, unshaped: &Unshaped<'_>, rule: ParameterRule) -> Option<f64> {
        let table = unshaped.table;
        match rule.key {
            "d" if table.d.is_some() => {
                self.positive_deviation(table.d.as_ref()?, "d", unshaped.context, Share::Unsaid)
            }
            "beta" if table.beta.is_some() => table.beta.as_ref().map(|beta| beta.value),
            key => self.refuse(unshaped.lacks(key, rule.meaning)),
        }
    }

    /// Reports parameters that belong to another shape.
    pub(super) fn shape_keys(&mut self, table: &ComponentTable, shape: &Entry) {
        let word = shape.kind.key;
        let own = match shape.word {
            Word::LimitsAnd(rule) => rule.key,
            _ => "",
        };
        for (name, place) in table.modifiers().filter(|(name, _)| *name != own) {
            let distribution = table
                .distribution
                .as_ref()
                .map_or(place.key.clone(), |stated| stated.span.clone());
            let owner = REGISTRY
                .iter()
                .find(|entry| matches!(entry.word, Word::LimitsAnd(rule) if rule.key == name));
            let owner = owner.map_or("", |owner| owner.kind.key);
            self.report(
                Fault::new(
                    MODIFIER,
                    place.key.clone(),
                    say!("`{name}` is no parameter of a {word} distribution"),
                )
                .label(say!("goes with distribution = \"{owner}\""))
                .related(distribution, say!("{word} here")),
            );
        }
        if let Some(p) = table
            .p
            .as_ref()
            .filter(|_| !matches!(shape.word, Word::Bell(_)))
        {
            self.report(
                Fault::new(
                    MODIFIER,
                    p.key.clone(),
                    say!("`p` does not go with a {word} distribution"),
                )
                .label(say!("its limits hold everything"))
                .help(say!(
                    "write distribution = \"normal\" if the half-width is a coverage interval"
                )),
            );
        }
    }

    /// Normal or t: from u, or from a half-width with its coverage probability.
    fn bell(&mut self, unshaped: &Unshaped<'_>, bell: Option<Bell>, dof: f64) -> Option<Core> {
        let owner = unshaped.context.owner;
        if bell == Some(Bell::StudentT) && dof.is_infinite() {
            let message = say!("the t distribution of {owner} has no degrees of freedom");
            return self.refuse(
                Fault::new(DOF, unshaped.place(), message)
                    .label(say!("`dof` is missing"))
                    .help(say!("add `dof`, or write distribution = \"normal\"")),
            );
        }
        let (u, how) = match unshaped.width {
            Width::U(u) => (u, unshaped.how.clone()),
            Width::Half(a) => {
                let Some(p) = &unshaped.table.p else {
                    let message =
                        say!("the normal half-width of {owner} has no coverage probability");
                    return self.refuse(
                        Fault::new(NO_COVERAGE_FACTOR, unshaped.place(), message)
                            .label(say!("`p` is missing"))
                            .help(say!(
                                "add `p`, for example p = 0.95; a normal distribution has no limits"
                            )),
                    );
                };
                let p = self.probability(p)?;
                let k = student_t_two_sided_quantile(p, dof);
                (
                    a / k,
                    format_smolstr!("a/k = {}/{} (p = {p})", show(a), show(k)),
                )
            }
        };
        let distribution = match bell {
            Some(Bell::Normal) => Distribution::from(Normal { mean: 0.0, sd: u }),
            Some(Bell::StudentT) | None => self.t_or_normal(u, dof, &unshaped.context.place)?,
        };
        Some(Core {
            dof,
            ..Core::new(distribution, u, how)
        })
    }
}

/// The shape that a table names.
pub(super) fn stated_shape(table: &ComponentTable) -> Option<&'static Entry> {
    match &table.distribution.as_ref()?.value {
        DistributionEntry::Shape(shape) => Some(*shape),
        DistributionEntry::Full(_) => None,
    }
}

/// Normal when a coverage probability is stated, else rectangular (GUM 4.3.7).
pub(super) fn default_shape(table: &ComponentTable) -> &'static Entry {
    if table.p.is_some() {
        Entry::of::<Normal>()
    } else {
        Entry::of::<Uniform>()
    }
}
