//! A component on its way from the file into the budget.

use std::cell::Cell;
use std::ops::Range;

use super::checker::Checker;
use crate::budget::faults::{DOF, NOT_POSITIVE};
use crate::budget::tables::ComponentTable;
use crate::budget::{Certificate, Conventions, Evaluation, Finding, Follows, TScale};
use gumption_core::distribution::{Distribution, Normal, StudentT};
use gumption_core::quantity::Unit;
pub(super) use gumption_core::quantity::show;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;
use smallvec::SmallVec;
use smol_str::SmolStr;

/// What a component is drafted for.
#[derive(Debug, Clone)]
pub(super) struct Context<'a> {
    /// Name of the input or source, for messages.
    pub owner: &'a str,
    /// The estimate, when it is known.
    value: Option<f64>,
    /// Whether anybody asked for the estimate.
    asked: Cell<bool>,
    /// Unit of the estimate.
    pub unit: &'a Unit,
    /// Place of the component as a whole.
    pub place: Range<usize>,
}

impl<'a> Context<'a> {
    pub fn new(owner: &'a str, value: Option<f64>, unit: &'a Unit, place: Range<usize>) -> Self {
        Context {
            owner,
            value,
            asked: Cell::new(false),
            unit,
            place,
        }
    }

    /// The same for another estimate.
    pub fn at(&self, value: Option<f64>) -> Self {
        Context::new(self.owner, value, self.unit, self.place.clone())
    }

    /// The estimate, when it is known.
    pub fn value(&self) -> Option<f64> {
        self.asked.set(true);
        self.value
    }

    /// The estimate, where something drafted was made of it.
    pub fn used(&self) -> Option<f64> {
        self.value.filter(|_| self.asked.get())
    }
}

/// What kind of doubt it is; decides about defaults and about absorption.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Repeatability,
    Resolution,
    /// Scatter of the data about the fit of this number.
    Scatter(usize),
    Other,
}

/// A component before it has a place in the budget; numbers in the input's unit.
#[derive(Debug, Clone)]
pub(super) struct Draft {
    /// Its name, from the file or from the way it is stated.
    pub label: SmolStr,
    /// Place of the name, if the file states one.
    pub named: Option<Range<usize>>,
    /// Zero-mean.
    pub distribution: Distribution,
    pub u: f64,
    pub dof: f64,
    pub evaluation: Evaluation,
    pub how: SmolStr,
    /// Where the statement puts the quantity.
    pub location: Location,
    /// What its readings say.
    pub findings: Vec<Finding>,
    /// The readings behind it, where they are its own.
    pub readings: Option<Vec<f64>>,
    pub kind: Kind,
    /// How its uncertainty follows the estimate.
    pub follows: Option<Follows>,
    pub certificate: Option<Box<Certificate>>,
    pub reference: Option<String>,
    /// Place of the component as a whole.
    pub place: Range<usize>,
    /// Place of the statement of its uncertainty.
    pub stated: Range<usize>,
}

/// Drafts of one owner, mostly one; each stays where it was made.
pub(super) type Drafts = SmallVec<[Box<Draft>; 1]>;

/// What a component says about the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Location {
    /// Nothing.
    None,
    /// The estimate moves by this much (asymmetric limits, GUM 4.3.8).
    Shift(f64),
    /// The estimate is the mean of readings, unless a value is stated.
    Mean(f64),
    /// The estimate is this expectation; a stated value must lie between the limits.
    Between {
        expectation: f64,
        lower: f64,
        upper: f64,
    },
    /// The estimate is this expectation.
    Expectation(f64),
}

/// u, ν and distribution of a draft, before the words are added.
#[derive(Debug, Clone)]
pub(super) struct Core {
    pub distribution: Distribution,
    pub u: f64,
    pub dof: f64,
    pub how: SmolStr,
    pub location: Location,
    /// What its readings say.
    pub findings: Vec<Finding>,
}

impl Core {
    pub(super) fn new(distribution: Distribution, u: f64, how: impl Into<SmolStr>) -> Self {
        Core {
            distribution,
            u,
            dof: f64::INFINITY,
            how: how.into(),
            location: Location::None,
            findings: Vec::new(),
        }
    }
}

impl Checker<'_> {
    /// Degrees of freedom from `dof` or `reliability`; infinite when neither is stated.
    pub(super) fn dof(&mut self, table: &ComponentTable) -> Option<f64> {
        if let (Some(dof), Some(reliability)) = (&table.dof, &table.reliability) {
            return self.refuse(
                Fault::new(
                    DOF,
                    reliability.key.clone(),
                    say!("degrees of freedom are stated in two ways"),
                )
                .label(say!("as reliability here"))
                .related(dof.key.clone(), say!("as dof here"))
                .help(say!("leave out one of `dof` and `reliability`")),
            );
        }
        if let Some(dof) = &table.dof {
            return self.positive_dof(&dof.map(|dof| dof.0));
        }
        let Some(reliability) = &table.reliability else {
            return Some(f64::INFINITY);
        };
        // More than u itself is no doubt about u, but a number of percent.
        if reliability.value > 1.0 {
            let fault = Fault::new(
                DOF,
                reliability.span.clone(),
                say!("a reliability of {}", reliability.value),
            );
            let fault = fault.label(say!("expected a number between 0 and 1"));
            return self.refuse(match reliability.value < 100.0 {
                true => fault.help(say!(
                    "for {} % write {}",
                    reliability.value,
                    show(reliability.value / 100.0)
                )),
                false => fault,
            });
        }
        // GUM G.4.2, equation (G.3).
        self.positive(reliability, "reliability")
            .map(|ratio| 0.5 / (ratio * ratio))
    }

    /// A stated number of degrees of freedom.
    pub(super) fn positive_dof(&mut self, dof: &Stated<f64>) -> Option<f64> {
        if dof.value > 0.0 {
            return Some(dof.value);
        }
        self.refuse(
            Fault::new(
                DOF,
                dof.span.clone(),
                say!("degrees of freedom of {}", dof.value),
            )
            .label(say!("must be greater than zero"))
            .help(say!(
                "for a perfectly known uncertainty leave out `dof`, or write `dof = inf`"
            )),
        )
    }

    /// A number that must be greater than zero.
    pub(super) fn positive(&mut self, number: &Stated<f64>, key: &str) -> Option<f64> {
        if number.value > 0.0 {
            return Some(number.value);
        }
        let fault = Fault::new(
            NOT_POSITIVE,
            number.span.clone(),
            say!("`{key}` is {}", number.value),
        )
        .label(say!("must be greater than zero"));
        self.refuse(if number.value < 0.0 {
            fault.help(say!("write it without sign"))
        } else {
            fault
        })
    }

    /// The distribution of a standard uncertainty with these degrees of freedom, as [`t_or_normal`] has it.
    pub(super) fn t_or_normal(
        &mut self,
        u: f64,
        dof: f64,
        place: &Range<usize>,
    ) -> Option<Distribution> {
        t_or_normal(u, dof, &self.conventions).or_else(|| self.no_standard_deviation(dof, place))
    }

    /// Scale of the t distribution that stands for u.
    pub(super) fn t_scale_of(&mut self, u: f64, dof: f64, place: &Range<usize>) -> Option<f64> {
        t_scale_of(u, dof, &self.conventions).or_else(|| self.no_standard_deviation(dof, place))
    }

    fn no_standard_deviation<T>(&mut self, dof: f64, place: &Range<usize>) -> Option<T> {
        self.refuse(
            Fault::new(
                DOF,
                place.clone(),
                say!("a t distribution with ν = {dof} has no standard deviation"),
            )
            .label(say!("ν = {dof}"))
            .help(say!(
                "take more readings, or write `t_scale = \"scale\"` in [conventions]"
            )),
        )
    }
}

/// The distribution of a standard uncertainty with finite degrees of freedom: a t distribution
/// (JCGM 101 6.4.9), whose scale the conventions choose; else normal.
pub(super) fn t_or_normal(u: f64, dof: f64, conventions: &Conventions) -> Option<Distribution> {
    if dof.is_infinite() {
        return Some(Distribution::Normal(Normal { mean: 0.0, sd: u }));
    }
    let scale = t_scale_of(u, dof, conventions)?;
    Some(Distribution::StudentT(StudentT {
        location: 0.0,
        scale,
        dof,
    }))
}

/// The degrees of freedom beyond which there is a t distribution of any u.
pub(super) fn least_dof(conventions: &Conventions) -> f64 {
    match conventions.t_scale {
        TScale::StandardDeviation if conventions.states("t_scale") => 2.0,
        TScale::StandardDeviation | TScale::Scale => 0.0,
    }
}

/// Scale of the t distribution that stands for u; nothing where the conventions ask for one that does not exist.
pub(super) fn t_scale_of(u: f64, dof: f64, conventions: &Conventions) -> Option<f64> {
    match conventions.t_scale {
        TScale::Scale => Some(u),
        TScale::StandardDeviation if dof > 2.0 => Some(u * ((dof - 2.0) / dof).sqrt()),
        // Nobody asked for it: three readings are evaluated as JCGM 101, 6.4.9.4 says, and the report
        // tells that Monte Carlo has no standard deviation then.
        TScale::StandardDeviation => (dof > least_dof(conventions)).then_some(u),
    }
}
