//! Which columns results have, and how many rows end in which way.

use crate::rows::{self, Head};
use gumption_core::model::Output;
use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_gum::budget::faults::SERIES;
use gumption_gum::budget::{BatchFile, Budget};

/// What the lines hold beside what is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    /// The share of each input in u²(y).
    pub shares: bool,
    /// c·u of each component: products of those that rows share are their covariance.
    pub contributions: bool,
    /// The seeds of the trials.
    pub seeds: bool,
    /// The language in which errors are told.
    pub language: Language,
}

/// How the rows of a batch have ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Count {
    /// All of them.
    pub rows: u64,
    /// Those without a result.
    pub failed: u64,
    /// Those whose item does not conform.
    pub rejected: u64,
}

/// The heads of a table in which no row has a result.
pub(super) fn nothing() -> Vec<Head> {
    ["label", "error"].map(Head::texts).to_vec()
}

/// Why a row with these columns has no place below the heads of a table, with the code of the fault.
pub(super) fn misfit(found: &[Head], heads: &[Head], language: Language) -> String {
    let why = other_columns(found, heads).in_language(language);
    format!("{}: {why}", SERIES.id)
}

fn other_columns(found: &[Head], heads: &[Head]) -> Said {
    let without = |one: &[Head], other: &[Head]| {
        let mut missing = one.iter().filter(|head| !other.contains(head));
        missing.next().map(|head| head.name.clone())
    };
    match (without(heads, found), without(found, heads)) {
        (Some(column), Some(figure)) => say!(
            "the row has nothing for the column {column}, and a figure for which there is no column, {figure}: all rows of a table have the columns of the first"
        ),
        (Some(column), None) => say!(
            "the row has nothing for the column {column}: all rows of a table have the columns of the first"
        ),
        (None, Some(figure)) => say!(
            "the row has a figure for which there is no column, {figure}: all rows of a table have the columns of the first"
        ),
        (None, None) => say!(
            "the row has its columns in another order: all rows of a table have the columns of the first"
        ),
    }
}

/// The columns that rows have: a row that leaves out a component has another column of contributions than one that leaves out
/// another.
#[derive(Debug, Default)]
pub(super) struct Shapes(Vec<Shape>);

#[derive(Debug)]
struct Shape {
    /// What a budget has, by which its heads are known without being made.
    names: Vec<String>,
    heads: Vec<Head>,
}

impl From<Vec<Head>> for Shapes {
    fn from(heads: Vec<Head>) -> Shapes {
        let names = Vec::new();
        Shapes(vec![Shape { names, heads }])
    }
}

impl Shapes {
    /// The number of the columns of rows of this budget.
    pub fn of_budget(&mut self, columns: Columns, budget: &Budget) -> usize {
        let names = || {
            let inputs = budget.inputs.iter().map(|one| one.name.as_str());
            let components = budget.components.iter().map(|one| one.name.as_str());
            let assessments = budget.conformity.iter().map(|one| one.name.as_str());
            inputs.chain(components).chain(assessments)
        };
        let is_known = |shape: &Shape| shape.names.iter().map(String::as_str).eq(names());
        self.0.iter().position(is_known).unwrap_or_else(|| {
            self.0.push(Shape {
                names: names().map(str::to_owned).collect(),
                heads: columns.heads(budget),
            });
            self.0.len() - 1
        })
    }

    /// The number of columns with these heads.
    pub fn of_heads(&mut self, heads: Vec<Head>) -> usize {
        let known = self.0.iter().position(|shape| shape.heads == heads);
        known.unwrap_or_else(|| {
            let names = Vec::new();
            self.0.push(Shape { names, heads });
            self.0.len() - 1
        })
    }

    /// The heads of the first row that has a result.
    pub fn first(&self) -> Option<Vec<Head>> {
        self.0.first().map(|shape| shape.heads.clone())
    }

    /// Those of a number.
    pub fn heads(&self, shape: usize) -> &[Head] {
        self.0.get(shape).map_or(&[], |shape| &shape.heads)
    }

    /// Which of them are the columns with these heads.
    pub fn fits(&self, heads: &[Head]) -> Vec<bool> {
        self.0.iter().map(|shape| shape.heads == heads).collect()
    }
}

impl Columns {
    /// What is to be known of the contributions before covariances are made of them, as far as the budget tells it without rows.
    pub fn caveat(self, file: &BatchFile<'_>) -> Option<Said> {
        let budget = self.contributions.then(|| file.alone()).flatten()?;
        let correlated = budget.groups.iter().flat_map(|group| &group.members);
        let names = correlated.map(|at| budget.components[*at].name.as_str());
        let names = names.collect::<Vec<_>>().join(", ");
        (!names.is_empty()).then(|| {
            say!(
                "the contributions of {names} correlate: sums of products of contributions leave this out, and are no covariances of the results"
            )
        })
    }

    /// The heads of the columns that rows of this budget have.
    pub(super) fn heads(self, budget: &Budget) -> Vec<Head> {
        let mut heads = rows::heads(budget);
        if self.shares {
            let share = |output: &Output| {
                let name = output.name.clone();
                let inputs = budget.inputs.iter();
                inputs.map(move |input| Head::numbers(format!("share({name}, {})", input.name)))
            };
            heads.extend(budget.model.outputs().iter().flat_map(share));
        }
        if self.contributions {
            let contribution = |output: &Output| {
                let (name, unit) = (output.name.clone(), output.unit.difference());
                let components = budget.components.iter();
                components.map(move |one| {
                    let head = format!("contribution({name}, {})", one.name);
                    Head::numbers(rows::in_unit(head, &unit))
                })
            };
            heads.extend(budget.model.outputs().iter().flat_map(contribution));
        }
        heads.extend(self.seeds.then(|| Head::numbers("seed".into())));
        heads.extend(["findings", "error"].map(Head::texts));
        heads
    }
}
