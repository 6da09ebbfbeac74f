//! `[fit.NAME.data]`: the observed values and their errors.

use std::ops::Range;

use super::super::checker::Checker;
use super::super::draft::{Context, Draft, Drafts, Location};
use super::super::entries::entries;
use super::super::inputs::{Entry, Piece, single};
use super::super::joints::dense;
use super::super::register::{Register, SourceEntry};
use super::super::vectors::of_element;
use super::super::ways::Way;
use crate::budget::Owner;
use crate::budget::faults::{
    FIT, FIT_COLUMNS, FIT_ERRORS, MISSING_KEY, NOT_POSITIVE, TWO_WAYS, VECTOR,
};
use crate::budget::tables::{FitColumnTable, FitTable};
use crate::budget::variants::Numbers;
use gumption_core::least_squares::Spread;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

/// Points of a fit. More of them would need more memory than is good for a budget.
const MOST_POINTS: usize = 10_000;

/// A column with its values.
pub(super) struct Column<'f> {
    pub name: &'f str,
    /// Place of its name.
    pub key: Range<usize>,
    pub unit: Unit,
    pub values: Vec<f64>,
    pub table: &'f FitColumnTable,
    /// Place of the column as a whole.
    pub place: Range<usize>,
}

impl Column<'_> {
    /// A component of one value, under the name that the column has in messages.
    fn context<'c>(&'c self, name: &'c str, entry: &Entry<'_>, element: usize) -> Context<'c> {
        Context::new(
            name,
            Some(self.values[element]),
            &self.unit,
            entry.place.clone(),
        )
    }
}

/// Why a column is in doubt.
pub(super) struct ColumnErrors {
    /// Errors of the single values.
    pub spread: Spread,
    /// Causes that act on all points together.
    pub common: Vec<Common>,
}

/// A component that acts on all points: how each of them follows it.
pub(super) struct Common {
    pub component: usize,
    pub coefficients: Vec<f64>,
}

impl ColumnErrors {
    /// Standard uncertainties of the single values.
    pub fn u(&self) -> Option<Vec<f64>> {
        match &self.spread {
            Spread::Exact => None,
            Spread::Each(u) => Some(u.clone()),
            Spread::Matrix(v) => Some(v.diagonal().iter().map(|v| v.sqrt()).collect()),
        }
    }
}

impl Checker<'_> {
    /// The columns of a fit, all of one length.
    pub(super) fn fit_columns<'f>(
        &mut self,
        name: &str,
        stated: &'f Stated<FitTable>,
    ) -> Option<Vec<Column<'f>>> {
        let table = &stated.value;
        let Some(data) = &table.data else {
            if table.refused {
                return None;
            }
            return self.refuse(
                Fault::new(FIT, stated.key.clone(), say!("the fit {name} has no data"))
                    .label(say!("`data` is missing"))
                    .help(say!(
                        "add for example:\n[fit.{name}.data]\nx = {{ values = [1.0, 2.0, 3.0] }}\ny = {{ values = [2.1, 3.9, 6.2], u = 0.1 }}"
                    )),
            );
        };
        let mut columns = Vec::new();
        let mut complete = !data.value.refused;
        for (column, stated) in entries(&table.data) {
            self.check_name(column, &stated.key, &say!("a column"));
            match self.fit_column(column, stated) {
                Some(column) => columns.push(column),
                None => complete = false,
            }
        }
        let first = columns.first()?;
        let (length, place, named) = (first.values.len(), first.key.clone(), first.name);
        for other in &columns[1..] {
            if other.values.len() != length {
                complete = false;
                self.report(
                    Fault::new(
                        FIT_COLUMNS,
                        other.key.clone(),
                        say!(
                            "{} has {} values, {named} has {length}",
                            other.name,
                            other.values.len()
                        ),
                    )
                    .label(say!("a point has one value in every column"))
                    .related(place.clone(), say!("{length} values")),
                );
            }
        }
        complete.then_some(columns)
    }

    fn fit_column<'f>(
        &mut self,
        name: &'f str,
        stated: &'f Stated<FitColumnTable>,
    ) -> Option<Column<'f>> {
        let table = &stated.value;
        let hidden = table.unknown || table.present.iter().any(|(key, _)| *key == "unit");
        let unit = match &table.unit {
            None if hidden => None,
            stated => self.unit(stated),
        };
        let Some(numbers) = &table.values else {
            if table.refused {
                return None;
            }
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    stated.span.clone(),
                    say!("the column {name} has no values"),
                )
                .label(say!("`values` is missing"))
                .help(say!("write values = [1.0, 2.0], or values = {{ file = \"data.csv\", column = \"x\" }}")),
            );
        };
        let values = self.numbers(numbers, unit.as_ref())?;
        if values.is_empty() || values.len() > MOST_POINTS {
            return self.refuse(
                Fault::new(
                    FIT_COLUMNS,
                    numbers.span.clone(),
                    say!("{name} has {} values", values.len()),
                )
                .label(say!("expected 1 to {MOST_POINTS}")),
            );
        }
        Some(Column {
            name,
            key: stated.key.clone(),
            unit: unit?,
            values,
            table,
            place: stated.span.clone(),
        })
    }

    /// Why the values of a column are in doubt. Independent reasons are summed in quadrature; what acts on
    /// all points is kept apart.
    pub(super) fn fit_errors(
        &mut self,
        owner: &str,
        column: &Column<'_>,
        register: &mut Register,
    ) -> Option<ColumnErrors> {
        let table = column.table;
        let mut errors = Independent {
            variance: vec![0.0; column.values.len()],
            known: false,
        };
        let common = self.causes_of(owner, column, &mut errors, register)?;
        if let Some(fault) = stated_twice(column) {
            return self.refuse(fault);
        }
        if let Some(weights) = &table.weights {
            errors.add(self.fit_weights(column, weights)?);
        }
        let Independent { variance, known } = errors;
        let spread = match &table.covariance {
            Some(covariance) => {
                let rows = self.symmetric(covariance, variance.len(), say!("values"))?;
                let mut matrix = dense(rows);
                for (i, v) in variance.iter().enumerate() {
                    matrix[(i, i)] += v;
                }
                Spread::Matrix(matrix)
            }
            None if known => Spread::Each(variance.into_iter().map(f64::sqrt).collect()),
            None => Spread::Exact,
        };
        Some(ColumnErrors { spread, common })
    }

    /// The components of a column: independent ones are added to `errors`, the others are entered.
    fn causes_of(
        &mut self,
        owner: &str,
        column: &Column<'_>,
        errors: &mut Independent,
        register: &mut Register,
    ) -> Option<Vec<Common>> {
        let table = column.table;
        if table.components.is_none() && table.component.present.is_empty() {
            return Some(Vec::new());
        }
        let name = format!("{owner}.{}", column.name);
        let before = self.messages.faults.len();
        let list = self.ways(
            &name,
            &table.components,
            &table.component,
            &column.place,
            &column.unit,
        )?;
        let mut common = Vec::new();
        let mut drafts: Vec<(Box<Draft>, Vec<f64>)> = Vec::new();
        for entry in &list {
            match self.fit_cause(&name, entry, column, register) {
                Some(Cause::Independent(u)) => errors.add(u.into_iter().map(|u| u * u).collect()),
                Some(Cause::Common(draft, coefficients)) => drafts.push((draft, coefficients)),
                Some(Cause::Shared(causes)) => common.extend(causes),
                None => {}
            }
        }
        if self.messages.faults.len() > before {
            return None;
        }
        common.extend(self.enter_common(&name, column, drafts, register));
        Some(common)
    }

    /// Variances 1/w, of weights that may stand in a column with a unit of its own.
    fn fit_weights(&mut self, column: &Column<'_>, stated: &Stated<Numbers>) -> Option<Vec<f64>> {
        let unit = column.unit.powr(-2, 1);
        let weights = self.numbers(stated, unit.as_ref())?;
        if weights.len() != column.values.len() {
            return self.refuse(
                Fault::new(
                    FIT_COLUMNS,
                    stated.span.clone(),
                    say!(
                        "{} weights for the {} values of {}",
                        weights.len(),
                        column.values.len(),
                        column.name
                    ),
                )
                .label(say!("expected {}", column.values.len())),
            );
        }
        if let Some(place) = weights.iter().position(|w| *w <= 0.0) {
            let span = match &stated.value {
                Numbers::List(list) => list[place].span.clone(),
                Numbers::Lists(_) | Numbers::Column(_) => stated.span.clone(),
            };
            return self.refuse(
                Fault::new(
                    NOT_POSITIVE,
                    span,
                    say!(
                        "weight {} of {} is {}",
                        place + 1,
                        column.name,
                        weights[place]
                    ),
                )
                .label(say!("must be greater than zero"))
                .help(say!(
                    "a weight is 1/u²; leave out points that are not to count"
                )),
            );
        }
        Some(weights.into_iter().map(|w| 1.0 / w).collect())
    }

    /// One reason for doubt of a column.
    fn fit_cause(
        &mut self,
        name: &str,
        entry: &Entry<'_>,
        column: &Column<'_>,
        register: &mut Register,
    ) -> Option<Cause> {
        if entry.way == Way::Source {
            return self.fit_source(name, entry, column, register);
        }
        if entry.way.locates() && !single(entry.table) && entry.way != Way::Distribution {
            let message = say!("this component would state one estimate for all values of {name}");
            return self.refuse(
                Fault::new(VECTOR, entry.place.clone(), message)
                    .label(say!("not for a column"))
                    .help(say!("state a deviation: `u`, `half_width`, `step` …")),
            );
        }
        let listed = self.with_columns(entry.table, &column.unit);
        let entry = &Entry {
            table: listed.as_ref().unwrap_or(entry.table),
            way: entry.way,
            place: entry.place.clone(),
        };
        self.one_for_each(name, entry.table, column.values.len())?;
        let (u, first) = self.value_errors(name, entry, column)?;
        let Some(first) = first else {
            return Some(Cause::Independent(u));
        };
        let common = entry.table.common.as_ref();
        if common.is_some_and(|stated| stated.value) {
            let coefficients = u.iter().map(|u| u / first.u).collect();
            return Some(Cause::Common(first, coefficients));
        }
        if first.dof.is_finite() {
            return self.refuse(
                Fault::new(
                    FIT_ERRORS,
                    first.stated.clone(),
                    say!("the uncertainties of {name} have {} degrees of freedom", first.dof),
                )
                .label(say!("the fit takes stated uncertainties as known"))
                .help(say!("leave out the degrees of freedom; if only the ratios of the uncertainties are known, write scale = \"residuals\" for the fit")),
            );
        }
        Some(Cause::Independent(u.into_iter().map(f64::abs).collect()))
    }

    /// Standard uncertainties of the values, with the sign of the value where they are fractions of it;
    /// and the first of the components.
    fn value_errors(
        &mut self,
        name: &str,
        entry: &Entry<'_>,
        column: &Column<'_>,
    ) -> Option<(Vec<f64>, Option<Box<Draft>>)> {
        let relative = self.acts_in_proportion(entry, &column.unit);
        let mut first: Option<Box<Draft>> = None;
        let mut u = Vec::new();
        for (element, value) in column.values.iter().enumerate() {
            // A fraction of zero is zero.
            if relative && *value == 0.0 {
                u.push(0.0);
                continue;
            }
            let context = column.context(name, entry, element);
            let draft = match of_element(entry.table, element) {
                Some(table) => self.draft(&table, entry.way, &context)?,
                None => self.draft(entry.table, entry.way, &context)?,
            };
            if !matches!(draft.location, Location::None | Location::Mean(_)) {
                let message = say!("this component would move the values of {name}");
                return self.refuse(
                    Fault::new(VECTOR, entry.place.clone(), message)
                        .label(say!("only symmetric deviations for a column")),
                );
            }
            u.push(draft.u * if relative { value.signum() } else { 1.0 });
            first.get_or_insert(draft);
        }
        Some((u, first))
    }

    /// A shared cause that acts on every value.
    fn fit_source(
        &mut self,
        name: &str,
        entry: &Entry<'_>,
        column: &Column<'_>,
        register: &mut Register,
    ) -> Option<Cause> {
        let mut causes: Vec<Common> = Vec::new();
        for element in 0..column.values.len() {
            let context = column.context(name, entry, element);
            for piece in self.shared_pieces(entry, &context, register)? {
                let Piece::Shared {
                    component,
                    coefficient,
                    ..
                } = piece
                else {
                    continue;
                };
                let known = causes.iter().position(|cause| cause.component == component);
                let place = known.unwrap_or_else(|| {
                    causes.push(Common {
                        component,
                        coefficients: vec![0.0; column.values.len()],
                    });
                    causes.len() - 1
                });
                causes[place].coefficients[element] += coefficient;
            }
        }
        Some(Cause::Shared(causes))
    }

    /// Enters the components that all values of a column have in common.
    fn enter_common(
        &mut self,
        name: &str,
        column: &Column<'_>,
        causes: Vec<(Box<Draft>, Vec<f64>)>,
        register: &mut Register,
    ) -> Vec<Common> {
        if causes.is_empty() {
            return Vec::new();
        }
        let (mut drafts, coefficients): (Drafts, Vec<Vec<f64>>) = causes.into_iter().unzip();
        self.label_uniquely(name, &mut drafts);
        let mut source = SourceEntry {
            name: name.to_string(),
            unit: Some(column.unit.clone()),
            components: Vec::new(),
            used: true,
        };
        let mut common = Vec::new();
        for (draft, coefficients) in drafts.into_iter().zip(coefficients) {
            let owner = Owner::Source(name.to_string());
            let component = register.add(owner, &name.into(), &column.unit, draft, false);
            source.components.push(component);
            common.push(Common {
                component,
                coefficients,
            });
        }
        register.sources.push(source);
        common
    }
}

/// A reason for doubt of a column.
enum Cause {
    /// Of each value by itself: standard uncertainties.
    Independent(Vec<f64>),
    /// Of all values together.
    Common(Box<Draft>, Vec<f64>),
    /// `[source.NAME]`s, entered already.
    Shared(Vec<Common>),
}

/// Errors of the single values, summed in quadrature.
struct Independent {
    variance: Vec<f64>,
    /// Whether any were stated.
    known: bool,
}

impl Independent {
    fn add(&mut self, variance: Vec<f64>) {
        self.known = true;
        for (sum, v) in self.variance.iter_mut().zip(variance) {
            *sum += v;
        }
    }
}

/// A covariance matrix or weights beside another statement of the uncertainty.
fn stated_twice(column: &Column<'_>) -> Option<Fault> {
    let table = column.table;
    let (own, first) = table.component.present.first()?;
    let covariance = table.covariance.as_ref();
    let weights = table.weights.as_ref();
    let (key, again) = covariance
        .map(|stated| ("covariance", &stated.key))
        .or(weights.map(|stated| ("weights", &stated.key)))?;
    let message = say!(
        "the uncertainty of {} is stated twice, by `{own}` and by `{key}`",
        column.name
    );
    Some(
        Fault::new(TWO_WAYS, again.clone(), message)
            .label(say!("stated again here"))
            .related(first.clone(), say!("first stated here"))
            .help(say!(
                "keep one; another reason for doubt stands in components = [{{ name = \"…\", {own} = … }}]"
            )),
    )
}
