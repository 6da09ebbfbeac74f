//! `[[joint]]`: simultaneous readings, covariance matrices, correlation matrices.

use std::collections::HashSet;
use std::rc::Rc;

use nalgebra::DMatrix;

use super::checker::Checker;
use super::draft::{Draft, Kind, Location, show};
use super::groups::negative_eigenvalue;
use super::nearest::within_rounding;
use super::register::{Register, no_such_input};
use super::statement::{Side, Statement};
use super::type_a::{mean_and_squares, student};
use crate::budget::faults::{CORRELATION_TWICE, JOINT, MODIFIER, NOT_SEMIDEFINITE, TWO_WAYS};
use crate::budget::tables::{FileTable, JointTable};
use crate::budget::{Evaluation, Group, Owner, TScale};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::{Matrix, Row, Stated};

impl Checker<'_> {
    /// Notes the inputs whose uncertainty a joint statement states, before they are read.
    pub(super) fn joint_estimates(&mut self, file: &FileTable, register: &mut Register) {
        for stated in joints(file) {
            let inputs = stated.value.inputs.iter().flat_map(|inputs| &inputs.value);
            let names = inputs.map(|name| name.value.clone());
            if stated.value.covariance.is_some() {
                register.by_matrix.extend(names);
            } else if stated.value.refused {
                register.by_refused.extend(names);
            }
        }
    }

    /// Reads `[[joint]]`; correlation matrices become statements about pairs.
    pub(super) fn joint_groups(
        &mut self,
        file: &FileTable,
        register: &mut Register,
        statements: &mut Vec<Statement>,
    ) -> Vec<Group> {
        let mut groups: Vec<Group> = Vec::new();
        for stated in joints(file) {
            let Some(inputs) = self.joint_inputs(stated, register) else {
                continue;
            };
            let table = &stated.value;
            let group = match (&table.covariance, &table.correlation) {
                (Some(first), Some(second)) => self.refuse(
                    Fault::new(
                        TWO_WAYS,
                        second.key.clone(),
                        say!("a covariance and a correlation matrix of the same inputs"),
                    )
                    .label(say!("second matrix"))
                    .related(first.key.clone(), say!("first matrix"))
                    .help(say!(
                        "keep one; the covariance matrix also states the uncertainties"
                    )),
                ),
                (Some(covariance), None) => {
                    self.by_covariance(stated, covariance, &inputs, register)
                }
                (None, Some(correlation))
                    if self.is_of_readings(correlation, &inputs, register) =>
                {
                    self.by_readings(stated, &inputs, register)
                }
                (None, Some(correlation)) => {
                    self.by_correlation(stated, correlation, &inputs, register, statements);
                    None
                }
                (None, None) => self.by_readings(stated, &inputs, register),
            };
            let Some(group) = group else { continue };
            if groups.iter().any(|other| {
                other
                    .members
                    .iter()
                    .any(|member| group.members.contains(member))
            }) {
                self.report(
                    Fault::new(
                        CORRELATION_TWICE,
                        stated.span.clone(),
                        say!("an input is in two [[joint]] statements"),
                    )
                    .label(say!("second statement")),
                );
                continue;
            }
            groups.push(group);
        }
        groups
    }

    /// The places of the named inputs, vectors element by element.
    fn joint_inputs(
        &mut self,
        stated: &Stated<JointTable>,
        register: &Register,
    ) -> Option<Vec<(usize, Stated<String>)>> {
        let Some(names) = &stated.value.inputs else {
            if stated.value.refused {
                return None;
            }
            return self.refuse(
                Fault::new(
                    JOINT,
                    stated.span.clone(),
                    say!("the joint statement names no inputs"),
                )
                .label(say!("`inputs` is missing")),
            );
        };
        let mut places: Vec<(usize, Stated<String>)> = Vec::new();
        let mut complete = true;
        for name in &names.value {
            if let Some(taken) = register.taken_as(&name.value) {
                return self.refuse(taken.not_to_be_correlated(name));
            }
            match places_of(name, register) {
                Some(found) => places.extend(found),
                None => {
                    complete = false;
                    let entries = register.entries.iter();
                    let known: Vec<&str> = entries.map(|entry| entry.name.as_str()).collect();
                    self.report(no_such_input(name, &known));
                }
            }
        }
        if !complete {
            return None;
        }
        let mut seen = HashSet::new();
        let twice = places.iter().find(|(place, _)| !seen.insert(*place));
        if places.len() >= 2 && twice.is_none() {
            return Some(places);
        }
        let span = twice.map_or(names.span.clone(), |(_, name)| name.span.clone());
        self.refuse(
            Fault::new(
                JOINT,
                span,
                say!("a joint statement needs at least two different inputs"),
            )
            .label(say!("expected two or more")),
        )
    }

    /// A square symmetric matrix with one row for each input.
    fn matrix<'m>(&mut self, stated: &'m Stated<Matrix>, size: usize) -> Option<&'m [Row]> {
        self.symmetric(stated, size, say!("inputs"))
    }

    /// A square symmetric matrix with one row for each of so many `what`.
    pub(super) fn symmetric<'m>(
        &mut self,
        stated: &'m Stated<Matrix>,
        size: usize,
        what: Said,
    ) -> Option<&'m [Row]> {
        let rows = stated.value.rows();
        if let Some(row) = rows.iter().find(|row| row.values().len() != size) {
            return self.refuse(
                Fault::new(
                    JOINT,
                    row.span.clone(),
                    say!("a row of {} numbers for {size} {what}", row.values().len()),
                )
                .label(say!("expected {size} numbers")),
            );
        }
        if rows.len() != size {
            return self.refuse(
                Fault::new(
                    JOINT,
                    stated.span.clone(),
                    say!("{} rows for {size} {what}", rows.len()),
                )
                .label(say!("expected {size} rows")),
            );
        }
        let Some((i, j)) = unequal(rows) else {
            return Some(rows);
        };
        let (below, above) = (rows[i].stated(j), rows[j].stated(i));
        let (lower, upper) = (below.value, above.value);
        self.refuse(
            Fault::new(
                JOINT,
                below.span,
                say!("the matrix is not symmetric: {lower} and {upper}"),
            )
            .label(say!("this element"))
            .related(above.span, say!("and this one must be equal")),
        )
    }

    /// How far the digits of a covariance matrix leave each correlation coefficient open.
    fn halves_of_covariance(&self, stated: &Stated<Matrix>, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let half = |i: usize, j: usize| {
            let row = stated.value.rows().get(i);
            let row = row.filter(|row| j < row.values().len());
            row.map_or(0.0, |row| self.half_of(row.values()[j], row.place(j)))
        };
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            let (v, w) = (matrix[(i, i)], matrix[(j, j)]);
            let r = matrix[(i, j)].abs() / (v * w).sqrt();
            half(i, j) / (v * w).sqrt() + r * (half(i, i) / v + half(j, j) / w) / 2.0 + 1e-9
        })
    }

    fn by_covariance(
        &mut self,
        stated: &Stated<JointTable>,
        covariance: &Stated<Matrix>,
        inputs: &[(usize, Stated<String>)],
        register: &mut Register,
    ) -> Option<Group> {
        let matrix = dense(self.matrix(covariance, inputs.len())?);
        if let Some(i) = (0..inputs.len()).find(|i| matrix[(*i, *i)] <= 0.0) {
            return self.refuse(
                Fault::new(
                    JOINT,
                    covariance.value.rows()[i].place(i),
                    say!(
                        "the variance of {} is {}",
                        inputs[i].1.value,
                        matrix[(i, i)]
                    ),
                )
                .label(say!("must be greater than zero")),
            );
        }
        let u: Vec<f64> = (0..inputs.len()).map(|i| matrix[(i, i)].sqrt()).collect();
        let correlation = DMatrix::from_fn(u.len(), u.len(), |i, j| {
            if i == j {
                1.0
            } else {
                matrix[(i, j)] / (u[i] * u[j])
            }
        });
        let correlation = match negative_eigenvalue(&correlation) {
            None => correlation,
            Some(smallest) => {
                let half = self.halves_of_covariance(covariance, &matrix);
                let Some(nearest) = within_rounding(&correlation, &half) else {
                    return self.refuse(
                        Fault::new(NOT_SEMIDEFINITE, covariance.span.clone(), say!("no quantities can have this covariance matrix"))
                            .label(say!("smallest eigenvalue of the correlation matrix {}", show(smallest)))
                            .help(say!("check the signs, and that |covariance| does not exceed the product of the standard uncertainties")),
                    );
                };
                self.remark_rounded(smallest, &correlation, &nearest);
                nearest
            }
        };
        let dof = match &stated.value.dof {
            Some(dof) => self.positive_dof(&dof.map(|dof| dof.0))?,
            None => f64::INFINITY,
        };
        let mut members = Vec::new();
        for ((place, _), u) in inputs.iter().zip(&u) {
            let input = register.inputs.get(*place)?;
            let alone = input.terms.is_empty();
            let (name, unit) = (input.name.clone(), input.unit.clone());
            let draft = Box::new(Draft {
                label: "covariance matrix".into(),
                named: None,
                distribution: self.t_or_normal(*u, dof, &stated.span)?,
                u: *u,
                dof,
                evaluation: Evaluation::TypeB,
                how: "√ of the variance in the covariance matrix".into(),
                location: Location::None,
                findings: Vec::new(),
                kind: Kind::Other,
                follows: None,
                certificate: None,
                reference: stated
                    .value
                    .reference
                    .as_ref()
                    .map(|text| text.value.clone()),
                place: stated.span.clone(),
                stated: stated.span.clone(),
                readings: None,
            });
            let component = register.add(Owner::Input(*place), &name, &unit, draft, alone);
            register.act(*place, component, 1.0);
            members.push(component);
        }
        self.join(members, correlation, register, &stated.span)
    }

    /// Whether a matrix is that of the readings of the inputs, rounded: then these are joint readings.
    fn is_of_readings(
        &self,
        correlation: &Stated<Matrix>,
        inputs: &[(usize, Stated<String>)],
        register: &Register,
    ) -> bool {
        /// Coefficients are stated to two decimals at least.
        const ROUNDED: f64 = 0.005;
        let plain = |place: &usize| {
            let index = register.own(*place).into_iter();
            let mut found = index.filter(|index| register.readings.contains_key(index));
            let (index, None) = (found.next()?, found.next()) else {
                return None;
            };
            let readings = register.readings.get(&index)?;
            let (mean, squares) = mean_and_squares(readings);
            let n = readings.len() as f64;
            let u = (squares / (n * (n - 1.0))).sqrt();
            let component = register.components.get(index)?;
            let is_mean = (component.u - u).abs() <= 1e-9 * u && u > 0.0;
            is_mean.then_some((readings, mean, squares))
        };
        let series: Option<Vec<_>> = inputs.iter().map(|(place, _)| plain(place)).collect();
        let Some(series) = series else { return false };
        let n = series[0].0.len();
        if series.iter().any(|one| one.0.len() != n) {
            return false;
        }
        let coefficient = |i: usize, j: usize| {
            let (a, b) = (&series[i], &series[j]);
            let products = a.0.iter().zip(b.0).map(|(x, y)| (x - a.1) * (y - b.1));
            products.sum::<f64>() / (a.2 * b.2).sqrt()
        };
        let rows = correlation.value.rows();
        let stated = |i: usize, j: usize| rows.get(i)?.values().get(j).copied();
        (0..series.len()).all(|i| {
            (0..i).all(|j| stated(i, j).is_some_and(|r| (r - coefficient(i, j)).abs() <= ROUNDED))
        })
    }

    fn by_correlation(
        &mut self,
        stated: &Stated<JointTable>,
        correlation: &Stated<Matrix>,
        inputs: &[(usize, Stated<String>)],
        register: &Register,
        statements: &mut Vec<Statement>,
    ) {
        if let Some(dof) = &stated.value.dof {
            self.report(
                Fault::new(MODIFIER, dof.key.clone(), say!("`dof` does not go with a correlation matrix"))
                    .label(say!("no meaning here"))
                    .help(say!("state the degrees of freedom with the uncertainties of the inputs, or give `covariance`")),
            );
        }
        let Some(rows) = self.matrix(correlation, inputs.len()) else {
            return;
        };
        let coefficient = |i: usize, j: usize| rows[i].values()[j];
        for (i, (_, name)) in inputs.iter().enumerate() {
            let itself = coefficient(i, i);
            if (itself - 1.0).abs() > 1e-9 {
                self.report(
                    Fault::new(
                        JOINT,
                        rows[i].place(i),
                        say!(
                            "the correlation of {} with itself is {}",
                            name.value,
                            itself
                        ),
                    )
                    .label(say!("must be 1"))
                    .help(say!("for variances and covariances write `covariance`")),
                );
                return;
            }
        }
        let correlated = |i: usize| (0..inputs.len()).any(|j| j != i && coefficient(i, j) != 0.0);
        let sides: Vec<Option<Rc<Side>>> = inputs
            .iter()
            .enumerate()
            .map(|(i, (place, name))| {
                let own = correlated(i).then(|| register.own(*place))?;
                self.side_of(name, &own, Some(*place), register)
                    .map(Rc::new)
            })
            .collect();
        let before = |i: usize| (0..i).filter(move |j| coefficient(i, *j) != 0.0);
        // Growing would copy all of them, time and again.
        statements.reserve((0..sides.len()).map(|i| before(i).count()).sum());
        for (i, second) in sides.iter().enumerate() {
            for j in before(i) {
                let r = rows[i].stated(j);
                if self.is_coefficient(&r)
                    && let (Some(first), Some(second)) = (&sides[j], second)
                {
                    statements.extend(self.pair(first, second, &r, register));
                }
            }
        }
    }

    /// Readings taken together: the covariance matrix of their means is S/n with ν = n − 1 (GUM 5.2.3);
    /// Monte Carlo draws the multivariate t distribution with ν = n − N (JCGM 102 5.3.2).
    fn by_readings(
        &mut self,
        stated: &Stated<JointTable>,
        inputs: &[(usize, Stated<String>)],
        register: &mut Register,
    ) -> Option<Group> {
        let mut members = Vec::new();
        let mut series: Vec<Vec<f64>> = Vec::new();
        for (place, name) in inputs {
            let found = register
                .own(*place)
                .into_iter()
                .find_map(|index| Some((index, register.readings.get(&index)?)));
            let Some((component, readings)) = found else {
                if register.incomplete || stated.value.refused {
                    return None;
                }
                return self.refuse(
                    Fault::new(
                        JOINT,
                        name.span.clone(),
                        say!("{} has no readings", name.value),
                    )
                    .label(say!("expected an input with `readings`"))
                    .help(say!(
                        "without readings state a matrix: `covariance` or `correlation`"
                    )),
                );
            };
            members.push(component);
            series.push(readings.clone());
        }
        let n = series.first().map_or(0, Vec::len);
        if let Some(other) = series.iter().position(|readings| readings.len() != n) {
            return self.refuse(
                Fault::new(
                    JOINT,
                    inputs[other].1.span.clone(),
                    say!(
                        "{} has {} readings, {} has {n}",
                        inputs[other].1.value,
                        series[other].len(),
                        inputs[0].1.value
                    ),
                )
                .label(say!("taken together means equally many")),
            );
        }
        if n <= series.len() {
            let many = series.len();
            self.remark(say!("{n} joint readings of {many} quantities do not determine a multivariate t-distribution of ν = n − N (JCGM 102, 5.3.2): the covariance matrix of the means has the rank {}. The GUM result with ν = n − 1 = {} holds (GUM 5.2.3); Monte Carlo takes that ν, too. Take at least {} readings for a check by JCGM 102.", n.saturating_sub(1).min(many), n.saturating_sub(1), many + 1));
        }
        self.simultaneous(stated, members, &series, inputs, register)
    }

    fn simultaneous(
        &mut self,
        stated: &Stated<JointTable>,
        members: Vec<usize>,
        series: &[Vec<f64>],
        inputs: &[(usize, Stated<String>)],
        register: &mut Register,
    ) -> Option<Group> {
        let n = series.first().map_or(0, Vec::len) as f64;
        let dof = match n - series.len() as f64 {
            dof if dof >= 1.0 => dof,
            _ => n - 1.0,
        };
        let sums: Vec<(f64, f64)> = series
            .iter()
            .map(|readings| mean_and_squares(readings))
            .collect();
        let product = |i: usize, j: usize| -> f64 {
            series[i]
                .iter()
                .zip(&series[j])
                .map(|(a, b)| (a - sums[i].0) * (b - sums[j].0))
                .sum()
        };
        let correlation = DMatrix::from_fn(series.len(), series.len(), |i, j| {
            if i == j {
                1.0
            } else {
                (product(i, j) / (sums[i].1 * sums[j].1).sqrt()).clamp(-1.0, 1.0)
            }
        });
        for ((index, (_, squares)), (_, name)) in members.iter().zip(&sums).zip(inputs) {
            let mean_u = (squares / (n * (n - 1.0))).sqrt();
            let scale = match self.t_scale() {
                TScale::Scale => (squares / (n * dof)).sqrt(),
                TScale::StandardDeviation => self.t_scale_of(mean_u, dof, &stated.span)?,
            };
            let component = register.components.get_mut(*index)?;
            if (component.u - mean_u).abs() > 1e-9 * mean_u {
                return self.refuse(
                    Fault::new(
                        JOINT,
                        name.span.clone(),
                        say!(
                            "the readings of {} are not evaluated as a plain mean",
                            name.value
                        ),
                    )
                    .label(say!("has `of`, `autocorrelated` or `gum_u`"))
                    .help(say!("joint readings state the uncertainty of their means")),
                );
            }
            component.distribution = student(scale, dof);
        }
        let mut group = self.join(members, correlation, register, &stated.span)?;
        group.dof = Some(n - 1.0);
        Some(group)
    }
}

fn joints(file: &FileTable) -> &[Stated<JointTable>] {
    file.joint.as_ref().map_or(&[], |list| &list.value.0)
}

/// The places of a named input: of all elements of a vector, or of one of them.
fn places_of(name: &Stated<String>, register: &Register) -> Option<Vec<(usize, Stated<String>)>> {
    if let Some(place) = register.places.get(name.value.as_str()) {
        return Some(vec![(*place, name.clone())]);
    }
    let mut entries = register.entries.iter();
    if let Some(entry) = entries.find(|entry| entry.name == name.value) {
        let own = |place: usize| {
            let input = register.inputs.get(place);
            input.map_or_else(String::new, |input| input.name.to_string())
        };
        let places = entry.places.clone();
        let named = places.map(|place| (place, name.map(|_| own(place))));
        return Some(named.collect());
    }
    None
}

/// The numbers of a square matrix.
pub(super) fn dense(rows: &[Row]) -> DMatrix<f64> {
    let numbers = rows.iter().flat_map(Row::values);
    DMatrix::from_row_iterator(rows.len(), rows.len(), numbers.copied())
}

/// Where a square matrix is not symmetric: the first row, and the first column left of the diagonal.
fn unequal(rows: &[Row]) -> Option<(usize, usize)> {
    /// Rows and columns that are looked at together, as both triangles of a large matrix are not near at once.
    const TILE: usize = 32;
    let differ = |(lower, upper): (&f64, f64)| {
        *lower != upper && (lower - upper).abs() > 1e-9 * lower.abs().max(upper.abs())
    };
    (0..rows.len()).step_by(TILE).find_map(|top| {
        let tiles = (0..=top).step_by(TILE);
        let firsts = tiles.filter_map(|left| {
            (top..rows.len().min(top + TILE)).find_map(|i| {
                let columns = left..i.min(left + TILE);
                let upper = rows[columns.clone()].iter().map(|row| row.values()[i]);
                let j = rows[i].values()[columns]
                    .iter()
                    .zip(upper)
                    .position(differ)?;
                Some((i, left + j))
            })
        });
        firsts.min()
    })
}
