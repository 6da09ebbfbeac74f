//! What an experiment tells, and what it cannot: rank, condition, aliases.

use gumption_core::least_squares::{axes, singular};
use nalgebra::{DMatrix, DVector};

use crate::experiment::Parameter;

/// Changes of parameters that leave every reading as it is, each relative to the first.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Combination {
    /// Names, changes and units; the change of the first is 1.
    pub changes: Vec<(String, f64, String)>,
}

/// How well the parameters are told apart.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Identifiability {
    /// Number of independent combinations of parameters that the readings determine.
    pub rank: usize,
    /// Number of parameters.
    pub parameters: usize,
    /// Largest over smallest singular value of the Jacobian, its columns scaled to length one.
    pub condition: f64,
    /// What the readings do not determine at all.
    pub undetermined: Vec<Combination>,
    /// Parameters that others imitate nearly.
    pub near: Vec<NearAlias>,
}

/// A parameter whose effect others imitate nearly.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NearAlias {
    /// The parameter.
    pub parameter: String,
    /// By how much larger its standard uncertainty is than if all others were known.
    pub inflation: f64,
    /// The imitation: change of the parameter by 1, and the changes of others that bring the readings
    /// nearly back.
    pub combination: Combination,
}

/// What an omitted effect would do.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Alias {
    /// Name of the coefficient of the effect.
    pub name: String,
    /// Share of the effect that the residuals would show: 0 hides completely, 1 shifts nothing.
    pub visible: f64,
    /// Whether it acts on any reading of this experiment.
    pub acts: bool,
    /// Change of each coefficient per unit of the effect, parameters first, then results.
    pub shifts: Vec<f64>,
}

/// What an omitted effect of some size does to the coefficients.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Shifts {
    /// Coefficients that it shifts, without those that it shifts slightly beside others.
    pub listed: Vec<Shift>,
    /// The others are shifted by less than so many standard uncertainties, if there are others.
    pub bound: Option<f64>,
}

/// A coefficient shifted by an omitted effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Its index.
    pub coefficient: usize,
    /// By how much, in its unit.
    pub by: f64,
    /// The size of that in standard uncertainties, where these are known.
    pub times: Option<f64>,
}

impl Alias {
    /// What an effect of a size does to coefficients of these standard uncertainties; without any, they are not known.
    pub fn shifts_at(&self, size: f64, u: &[f64]) -> Shifts {
        /// What is less than this part of the largest shift, both in multiples of u, is slight.
        const SLIGHT: f64 = 0.01;
        /// What is less than this part of the largest shift is its rounding.
        const ROUNDING: f64 = 1e-9;
        let most = self
            .shifts
            .iter()
            .fold(0.0_f64, |most, s| most.max(s.abs()));
        let felt = self.shifts.iter().enumerate();
        let felt = felt.filter(|(_, shift)| shift.abs() > ROUNDING * most);
        let mut listed: Vec<Shift> = felt
            .map(|(coefficient, shift)| {
                let u = u.get(coefficient).filter(|u| **u > 0.0);
                let by = shift * size;
                let times = u.map(|u| (by / u).abs());
                Shift {
                    coefficient,
                    by,
                    times,
                }
            })
            .collect();
        let largest = listed
            .iter()
            .filter_map(|one| one.times)
            .fold(0.0, f64::max);
        let all = listed.len();
        listed.retain(|one| one.times.is_none_or(|times| times >= SLIGHT * largest));
        let bound = (listed.len() < all).then_some(SLIGHT * largest);
        Shifts { listed, bound }
    }
}

/// Columns whose remainder after projection on the others is smaller than this share of their length are
/// combinations of them, for all that double precision tells.
const SINGULAR: f64 = 1e-9;

/// Standard uncertainties that grow by more than this are worth a word.
const INFLATION: f64 = 10.0;

/// Changes smaller than this share of the largest, in scaled columns, are left out of words.
const NEGLIGIBLE: f64 = 1e-3;

impl Identifiability {
    /// From the Jacobian, its rows weighted.
    pub(super) fn of(jacobian: &DMatrix<f64>, parameters: &[Parameter]) -> Identifiability {
        let (scaled, lengths) = scaled(jacobian);
        let (rank, condition) = determined(&scaled);
        let mut near = Vec::new();
        if rank == parameters.len() {
            for place in 0..parameters.len() {
                near.extend(near_alias(&scaled, &lengths, place, parameters));
            }
        }
        Identifiability {
            rank,
            parameters: parameters.len(),
            condition,
            undetermined: combinations(&scaled, &lengths, parameters, parameters.len() - rank),
            near,
        }
    }
}

/// How many parameters columns of length one determine, and their condition.
fn determined(scaled: &DMatrix<f64>) -> (usize, f64) {
    let Some(found) = singular(scaled.clone()) else {
        return (0, f64::INFINITY);
    };
    let singular = found.singular_values;
    let largest = singular.max();
    let rank = singular.iter().filter(|s| **s > SINGULAR * largest).count();
    let condition = match rank < scaled.ncols() {
        true => f64::INFINITY,
        false => largest / singular.min(),
    };
    (rank, condition)
}

/// The combinations of parameters that the readings do not determine, of which there is one at least: the solution failed.
pub(super) fn undetermined(jacobian: &DMatrix<f64>, parameters: &[Parameter]) -> Vec<Combination> {
    let (scaled, lengths) = scaled(jacobian);
    let (rank, _) = determined(&scaled);
    combinations(
        &scaled,
        &lengths,
        parameters,
        (parameters.len() - rank).max(1),
    )
}

/// Columns of length one, and the lengths that they had.
fn scaled(jacobian: &DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    let mut scaled = jacobian.clone();
    let mut lengths = Vec::with_capacity(jacobian.ncols());
    for mut column in scaled.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
        lengths.push(length);
    }
    (scaled, lengths)
}

/// The combinations of parameters that change no reading, of which there are so many: the null space in reduced row echelon form,
/// so that each combination is led by a parameter of its own.
fn combinations(
    scaled: &DMatrix<f64>,
    lengths: &[f64],
    parameters: &[Parameter],
    missing: usize,
) -> Vec<Combination> {
    let count = parameters.len();
    // A square matrix has all right singular vectors, also where rows are fewer than columns.
    let Some(eigen) = axes(scaled.transpose() * scaled) else {
        return Vec::new();
    };
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    order.truncate(missing);
    // In the order in which they are found, so that the echelon form is the same however small they are.
    order.sort_unstable();
    let mut null: Vec<DVector<f64>> = order
        .into_iter()
        .map(|k| eigen.eigenvectors.column(k).into_owned())
        .collect();
    let mut leads = Vec::new();
    for k in 0..null.len() {
        // Later parameters lead: terms of higher order are usually listed behind.
        let lead = (0..count)
            .filter(|place| !leads.contains(place))
            .filter(|place| null[k][*place].abs() > 1e-6)
            .max_by(|a, b| {
                let size = |place: usize| null[k][place].abs() > 0.05;
                size(*a).cmp(&size(*b)).then(a.cmp(b))
            });
        let Some(lead) = lead else { continue };
        leads.push(lead);
        let pivot = null[k][lead];
        null[k] /= pivot;
        let own = null[k].clone();
        for (other, vector) in null.iter_mut().enumerate() {
            if other != k {
                let factor = vector[lead];
                *vector -= factor * &own;
            }
        }
    }
    null.iter()
        .zip(&leads)
        .map(|(vector, lead)| combination(vector, *lead, lengths, parameters))
        .collect()
}

/// A direction of scaled parameters as changes in their units, led by one of them.
fn combination(
    direction: &DVector<f64>,
    lead: usize,
    lengths: &[f64],
    parameters: &[Parameter],
) -> Combination {
    // A column that is zero has no length: its parameter changes freely.
    let in_units = |place: usize| {
        let length = lengths[place];
        direction[place] / if length > 0.0 { length } else { 1.0 }
    };
    let one = in_units(lead);
    let largest = direction.amax();
    let mut order: Vec<usize> = vec![lead];
    let others = (0..parameters.len())
        .filter(|place| *place != lead && direction[*place].abs() > NEGLIGIBLE * largest);
    order.extend(others);
    Combination {
        changes: order
            .into_iter()
            .map(|place| {
                let parameter = &parameters[place];
                (
                    parameter.name.clone(),
                    in_units(place) / one,
                    parameter.unit.symbol.clone(),
                )
            })
            .collect(),
    }
}

fn near_alias(
    scaled: &DMatrix<f64>,
    lengths: &[f64],
    place: usize,
    parameters: &[Parameter],
) -> Option<NearAlias> {
    let others: Vec<usize> = (0..parameters.len())
        .filter(|other| *other != place)
        .collect();
    if others.is_empty() {
        return None;
    }
    let target = scaled.column(place).into_owned();
    let basis = scaled.select_columns(&others);
    let fit = singular(basis.clone())?.solve(&target, 1e-14).ok()?;
    let remainder = (&target - &basis * &fit).norm();
    let inflation = 1.0 / remainder;
    if inflation.is_nan() || inflation <= INFLATION {
        return None;
    }
    let mut direction = DVector::zeros(parameters.len());
    direction[place] = 1.0;
    for (other, value) in others.iter().zip(fit.iter()) {
        direction[*other] = -value;
    }
    Some(NearAlias {
        parameter: parameters[place].name.clone(),
        inflation,
        combination: combination(&direction, place, lengths, parameters),
    })
}

/// The alias of an effect that adds `column` to the readings, by the gain of the estimator.
pub(super) fn alias(
    name: &str,
    column: &DVector<f64>,
    jacobian: &DMatrix<f64>,
    gain: &DMatrix<f64>,
    parameters: usize,
) -> Alias {
    let length = column.norm();
    let acts = length > 0.0;
    let shifts = gain * column;
    let absorbed = jacobian * shifts.rows(0, parameters);
    let share = (column - absorbed).norm() / length;
    Alias {
        name: name.to_owned(),
        visible: if !acts {
            1.0
        } else if share < SINGULAR {
            0.0
        } else {
            share
        },
        acts,
        shifts: shifts.iter().copied().collect(),
    }
}
