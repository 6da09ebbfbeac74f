//! The noise that `[noise]` states: an error of each reading.

use std::collections::BTreeMap;
use std::ops::Range;

use super::data::of_role;
use super::points::{PointColumn, Points};
use crate::experiment::at_rest::Headed;
use crate::experiment::checker::Checker;
use crate::experiment::entries::RoleWord;
use crate::experiment::faults::NOISE;
use crate::experiment::noise::Way;
use crate::experiment::source::entries;
use crate::experiment::{Act, Doubt, Experiment, Observed, Purpose, Scope, Target};
use crate::recording::Average;
use gumption_core::distribution::{Distribution, Normal};
use gumption_core::quantity::Unit;
use gumption_core::statistics::{Dd, Series, pooled};
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Stated;
use gumption_gum::budget::Evaluation;

/// Standard uncertainty with its degrees of freedom.
type Scatter = (f64, f64);

/// Adds the stated noise to the errors of the readings; whether there is one, `None` after a fault.
///
/// It is that of one row. Where points are averages of rows, a column of the points says what is left of it there.
pub(super) fn add(
    checker: &mut Checker<'_>,
    points: &mut Points,
    experiment: &mut Experiment,
) -> Option<bool> {
    let before = checker.faults.len();
    let observed = experiment.observed.iter();
    let outputs: Vec<(String, Unit)> = observed
        .filter_map(|observed| match observed {
            Observed::Column(name) => Some((name.clone(), unit_of(checker, experiment, name)?)),
            _ => None,
        })
        .collect();
    let per_row = checker.column_of_u();
    let Some((way, _)) = checker.noise_way(per_row.is_some()) else {
        return match (checker.faults.len() == before, per_row) {
            (false, _) => None,
            (true, None) => Some(false),
            (true, Some(column)) => of_rows(checker, points, experiment, outputs, column),
        };
    };
    let found: Vec<OfRow> = match way {
        Way::From(_) => return Some(false),
        // Before there are readings, only what is stated tells their noise.
        Way::Replicates(_) if checker.purpose == Purpose::Plan => return Some(false),
        // Replicates are points as they are, averages or not.
        Way::Replicates(columns) => {
            let found = replicates(checker, points, columns, &outputs)?;
            for ((name, unit), scatter) in outputs.into_iter().zip(found) {
                experiment.doubts.push(noise(name, unit, scatter));
            }
            return Some(true);
        }
        Way::Stated(u, dof) => {
            let units: Vec<&Unit> = outputs.iter().map(|(_, unit)| unit).collect();
            let u = checker.noise_in(u, &units)?.into_iter();
            u.map(|u| OfRow::independent((u, dof))).collect()
        }
        Way::Budget(path) => {
            let (u, dof) = checker.noise_of_budget(path, &outputs)?;
            u.into_iter()
                .map(|u| OfRow::independent((u, dof)))
                .collect()
        }
        Way::AtRest(stated) => {
            let headed: Vec<Headed> = outputs.iter().map(|of| headed(checker, of)).collect();
            let rest = checker.at_rest(stated, &headed, None)?;
            rest.iter()
                .map(|rest| OfRow::at_rest(&rest.average))
                .collect()
        }
    };
    let counted = counted(checker, points);
    for ((name, unit), of_row) in outputs.into_iter().zip(found) {
        let averaged = points.column(&name).and_then(|read| of_row.left(read));
        let shares = [averaged, counted.clone()].into_iter().flatten();
        let left = shares.reduce(|a, b| a.iter().zip(&b).map(|(a, b)| a * b).collect());
        let mut doubt = noise(name, unit, of_row.scatter);
        if let Some(left) = left {
            points.columns.push(PointColumn {
                name: doubt.name.clone(),
                unit: Unit::one(),
                values: left,
                averages: Vec::new(),
            });
            doubt.by = Some(doubt.name.clone());
        }
        experiment.doubts.push(doubt);
    }
    Some(true)
}

/// The noise of a row, and by what its correlation multiplies the variance of the mean of many.
struct OfRow {
    scatter: Scatter,
    factor: f64,
}

impl OfRow {
    fn independent(scatter: Scatter) -> OfRow {
        OfRow {
            scatter,
            factor: 1.0,
        }
    }

    /// Successive readings that go together show less of the variance, and know it worse, than as many independent ones.
    fn at_rest(rest: &Average) -> OfRow {
        let count = rest.n as f64;
        let scatter = match rest.effective < count {
            true => (rest.u * rest.effective.sqrt(), rest.dof),
            false => (rest.s, count - 1.0),
        };
        OfRow {
            scatter,
            factor: count / rest.effective,
        }
    }

    /// What is left of it where a point is the average of n rows: √(F/n), and no more than that of one row; `None` where no
    /// point is an average.
    fn left(&self, read: &PointColumn) -> Option<Vec<f64>> {
        let of_point = |average: &Option<Average>| {
            average.map_or(1.0, |average| {
                (self.factor / average.n as f64).min(1.0).sqrt()
            })
        };
        let left = read.averages.iter().map(of_point).collect();
        (!read.averages.is_empty()).then_some(left)
    }
}

/// What is left of the noise of one reading in each point where a column says of how many readings its rows are: 1/√count, of a point
/// that is an average of rows that of their mean.
fn counted(checker: &Checker<'_>, points: &Points) -> Option<Vec<f64>> {
    let name = of_role(&checker.source.table.columns, RoleWord::Count).next()?;
    let counts = points.column(name)?.values.iter();
    let left = |count: &f64| 1.0 / count.max(1.0).sqrt();
    Some(counts.map(left).collect())
}

/// Whether an error is the noise of an output that `[noise]` tells.
pub(super) fn is_of(doubt: &Doubt, output: &str) -> bool {
    doubt.name == name_of(output)
}

fn name_of(output: &str) -> String {
    format!("{output}.noise")
}

/// The noise of an output: an error of each reading.
fn noise(output: String, unit: Unit, (u, dof): Scatter) -> Doubt {
    Doubt {
        name: name_of(&output),
        acts: vec![Act {
            on: Target::Reading(output),
            coefficient: 1.0,
            growth: None,
        }],
        scope: Scope::Each,
        u,
        by: None,
        dof,
        unit,
        distribution: Distribution::Normal(Normal { mean: 0.0, sd: u }),
        evaluation: match dof.is_finite() {
            true => Evaluation::TypeA,
            false => Evaluation::TypeB,
        },
        how: "u".to_owned(),
        certificate: None,
    }
}

/// The noise of the rows of each output by a column: 1 in its unit, times its numbers.
fn of_rows(
    checker: &mut Checker<'_>,
    points: &Points,
    experiment: &mut Experiment,
    outputs: Vec<(String, Unit)>,
    (column, place): (&str, Range<usize>),
) -> Option<bool> {
    let Some(own) = points.column(column) else {
        return Some(false);
    };
    let factors = checker.factors_of_u(&own.unit, &outputs)?;
    for ((output, unit), factor) in outputs.into_iter().zip(factors) {
        let read = points.column(&output).map(|column| &column.values);
        let is_read = |point: usize| read.is_none_or(|read| read[point].is_finite());
        let is_missing = |point: &usize| is_read(*point) && !is_positive(own.values[*point]);
        if let Some(point) = (0..points.len()).find(is_missing) {
            let row = points.names.of(point).en;
            let row = row.trim_start_matches("line ");
            let message = say!("{column} states no standard uncertainty in line {row}");
            let fault = Fault::new(NOISE, place, message);
            return checker.refuse(
                fault
                    .label(say!("expected a positive number in each row"))
                    .help(say!(
                        "state it there, or leave the row out: below [[left_out]], lines = [{row}] and a reason"
                    )),
            );
        }
        let mut doubt = noise(output, unit, (factor, f64::INFINITY));
        doubt.by = Some(column.to_owned());
        experiment.doubts.push(doubt);
    }
    Some(true)
}

fn is_positive(u: f64) -> bool {
    u > 0.0 && u.is_finite()
}

/// The unit of differences of an output, of a plan that in which it will be read.
fn unit_of(checker: &Checker<'_>, experiment: &Experiment, name: &str) -> Option<Unit> {
    let mut recorded = experiment.columns.iter();
    let recorded = recorded.find(|column| column.name == name);
    let unit = recorded.map(|column| column.unit.clone());
    let unit = unit.or_else(|| match checker.purpose {
        Purpose::Plan => checker.planned_unit(name),
        _ => None,
    });
    unit.map(|unit| unit.difference())
}

/// An output as the recording heads it.
fn headed(checker: &Checker<'_>, (name, unit): &(String, Unit)) -> Headed {
    let mut declared = entries(&checker.source.table.columns).iter();
    let table = declared.find(|(other, _)| other == name);
    let header = table.and_then(|(_, entry)| entry.value.0.column.as_ref());
    Headed {
        name: name.clone(),
        header: header.map_or(name, |header| &header.value).clone(),
        unit: unit.clone(),
    }
}

fn series(readings: &[f64]) -> Series {
    let readings: Vec<Dd> = readings.iter().copied().map(Dd::from).collect();
    Series::new(&readings)
}

/// The scatter of points that agree in all of these columns.
fn replicates(
    checker: &mut Checker<'_>,
    points: &Points,
    columns: &[Stated<String>],
    outputs: &[(String, Unit)],
) -> Option<Vec<Scatter>> {
    // Rows without a value agree with none.
    let mut keys: Vec<Option<Vec<String>>> = vec![Some(Vec::new()); points.len()];
    for column in columns {
        let number = |row: usize| {
            let number = points.column(&column.value)?.values.get(row)?;
            // Zero has one sign.
            Some(match number.is_nan() {
                true => String::new(),
                false => (number + 0.0).to_string(),
            })
        };
        let label = |row: usize| Some(points.labels(&column.value)?.text(row).to_owned());
        for (row, key) in keys.iter_mut().enumerate() {
            let Some(own) = label(row).or_else(|| number(row)) else {
                let message = say!("the experiment has no column {}", column.value);
                let fault = Fault::new(NOISE, column.span.clone(), message);
                let fault = fault.label(say!("expected a column of the recording"));
                let labels = points.labels.iter().map(|(name, _)| name.as_str());
                let numbers = points.columns.iter().map(|column| column.name.as_str());
                let near = nearest(&column.value, labels.chain(numbers));
                return checker.refuse(match near {
                    Some(near) => fault.help(say!("did you mean \"{near}\"?")),
                    None => fault.help(say!("declare it below [columns]")),
                });
            };
            match own.is_empty() {
                true => *key = None,
                false => key.iter_mut().for_each(|key| key.push(own.clone())),
            }
        }
    }
    let mut rows: BTreeMap<&[String], Vec<usize>> = BTreeMap::new();
    for (row, key) in keys.iter().enumerate() {
        if let Some(key) = key {
            rows.entry(key).or_default().push(row);
        }
    }
    let scatter = |(name, _): &(String, Unit)| {
        let values = &points.column(name)?.values;
        let finite = |row: &usize| values.get(*row).copied().filter(|value| value.is_finite());
        let groups: Vec<Series> = rows
            .values()
            .map(|rows| rows.iter().filter_map(finite).collect::<Vec<_>>())
            .filter(|group| group.len() > 1)
            .map(|group| series(&group))
            .collect();
        let (u, dof) = pooled(&groups);
        (u > 0.0).then_some((u, dof))
    };
    let found: Option<Vec<Scatter>> = outputs.iter().map(scatter).collect();
    if found.is_none() {
        let place = columns.first().map_or(0..0, |column| column.span.clone());
        let fault = Fault::new(
            NOISE,
            place,
            say!("no rows agree in these columns, or they do not scatter"),
        );
        checker
            .faults
            .push(fault.label(say!("rows that agree are replicates")));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of readings that go together in fours, a quarter as many are independent.
    #[test]
    fn noise_at_rest_that_is_correlated_is_known_worse() {
        let alternating = (0..40).map(|at| if at % 2 == 0 { 1.0 } else { -1.0 });
        let together = (0..40).map(|at| libm::sin((at / 4 * (at / 4)) as f64));
        let of = |readings: Vec<f64>| {
            let average = Average::of(&readings).expect("an average");
            (OfRow::at_rest(&average).scatter, average)
        };
        let ((s, dof), average) = of(alternating.collect());
        assert_eq!((s, dof), (average.s, 39.0));
        let ((s, dof), average) = of(together.collect());
        assert!(s > average.s && dof < 20.0, "{s} {dof}");
    }
}
