//! An adopted effect in parts of the recording, and whether the parts agree.
//!
//! The effect has a size of its own in each part; everything else is common to all of them. So a part that
//! cannot tell the effect from the parameters by itself learns the parameters from the others.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::candidates::baseline;
use super::case::Role;
use super::confirm::degrees;
use super::design::Design;
use super::evidence::{Baseline, Fitted, over_noise};
use super::fit::Fit;
use super::noise::Claimed;
use crate::recording::Labels;
use gumption_core::special::{chi_squared_sf, f_sf};

/// Checks of an adopted effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Confirmation {
    /// χ² that the linear prediction promised.
    pub promised: f64,
    /// The first coefficient in each part of the recording, all else being common: name of the part, value,
    /// u. Empty where fewer than two parts show it.
    pub parts: Vec<(String, f64, f64)>,
    /// Probability that the parts differ as much by chance.
    pub agreement: Option<f64>,
}

/// The first of the `added` coefficients, estimated from parts of the recording.
pub(super) fn confirmation(
    design: &Design<'_>,
    fit: &Fit,
    claimed: &Claimed,
    added: usize,
    fitted: &Fitted,
) -> Confirmation {
    let first = design.case.parameters.len() - added;
    let (names, members): (Vec<String>, Vec<Vec<usize>>) = divided(design).into_iter().unzip();
    let at = design.unknown_of(first, 0);
    let mut confirmation = Confirmation {
        promised: fitted.chi_squared,
        parts: Vec::new(),
        agreement: None,
    };
    let parts = apart(design, fit, claimed, at, &members);
    let Some(parts) = parts.filter(|parts| parts.seen.len() > 1) else {
        return confirmation;
    };
    let further = parts.seen.len() as f64 - 1.0;
    let dof = degrees(design) - further;
    let own = claimed.is_estimated().then(|| parts.left / dof);
    if own.is_some_and(|variance| !(dof > 0.0 && variance > 0.0)) {
        return confirmation;
    }
    let scale = own.unwrap_or(1.0).sqrt();
    let of = |(i, part): (usize, &usize)| {
        let u = scale * parts.covariance[(i, i)].max(0.0).sqrt();
        (names[*part].clone(), parts.values[i], u)
    };
    confirmation.parts = parts.seen.iter().enumerate().map(of).collect();
    let q = spread(&parts.values, &parts.covariance);
    confirmation.agreement = q.map(|q| match own {
        Some(variance) => f_sf(q / further / variance, further, dof),
        None => chi_squared_sf(q, further),
    });
    confirmation
}

/// An effect in parts of the recording.
struct Parts {
    /// Those that show it.
    seen: Vec<usize>,
    /// Its size in them.
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    /// χ² that is left beside all of them.
    left: f64,
}

/// The unknown `at` with a value of its own for each list of observations, beside everything that is common, as well as the noise
/// with its correlation lets them be known.
fn apart(
    design: &Design<'_>,
    fit: &Fit,
    claimed: &Claimed,
    at: usize,
    members: &[Vec<usize>],
) -> Option<Parts> {
    let mut columns = DMatrix::zeros(design.observations(), members.len());
    for (part, members) in members.iter().enumerate() {
        for observation in members {
            columns[(*observation, part)] = fit.jacobian[(*observation, at)];
        }
    }
    let mut common = Design::new(design.case);
    let own = common.unknowns.remove(at);
    let known = own.prior.map_or((0.0, 0.0), |(value, u)| {
        (1.0 / (u * u), (value - fit.unknowns[at]) / (u * u))
    });
    let rest = Fit {
        unknowns: fit.unknowns.clone().remove_row(at),
        jacobian: fit.jacobian.clone().remove_column(at),
        ..fit.clone()
    };
    let beside = baseline(&common, &rest, claimed).ok()?;
    let alone = over_noise(&columns, &claimed.u);
    let mut parts = estimates(&beside, &columns, &alone, known);
    parts.values.add_scalar_mut(fit.unknowns[at]);
    Some(parts)
}

/// How much the values of parts differ from the common one. `alone` is what the parts would show if the other unknowns were known, in
/// units of the noise; `known` what is known beforehand of each value: information, and how strongly it pulls.
fn estimates(
    beside: &Baseline,
    columns: &DMatrix<f64>,
    alone: &DMatrix<f64>,
    known: (f64, f64),
) -> Parts {
    /// Information below this part of what a part would show alone is rounding.
    const NOTHING: f64 = 1e-9;
    /// A direction that nothing determines takes part in a value from this share on.
    const TAKES_PART: f64 = 1e-6;
    /// A value with so many times the standard uncertainty of the common one says nothing.
    const FAR: f64 = 20.0;
    let parts = alone.ncols();
    let unit = |part: usize| match alone.column(part).norm_squared() {
        whole if whole > 0.0 => 1.0 / whole.sqrt(),
        _ => 0.0,
    };
    let units = DMatrix::from_diagonal(&DVector::from_fn(parts, |part, _| unit(part)));
    let shown = beside.project(columns);
    let mut information = shown.tr_mul(&shown);
    let mut pull = shown.tr_mul(beside.residuals());
    for part in 0..parts {
        information[(part, part)] += known.0;
        pull[part] += known.1;
    }
    let eigen = SymmetricEigen::new(&units * &information * &units);
    let (mut inverse, mut open) = (DMatrix::zeros(parts, parts), DVector::zeros(parts));
    let axes = eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter());
    for (value, direction) in axes {
        if *value > NOTHING {
            inverse += direction * direction.transpose() / *value;
        } else {
            open += direction.component_mul(&direction);
        }
    }
    let covariance = &units * inverse * &units;
    let values = &covariance * &pull;
    let most = FAR * FAR / information.sum();
    let shows = |part: &usize| open[*part] < TAKES_PART && covariance[(*part, *part)] < most;
    let seen: Vec<usize> = (0..parts).filter(shows).collect();
    Parts {
        left: beside.chi_squared() - pull.dot(&values),
        values: values.select_rows(&seen),
        covariance: covariance.select_columns(&seen).select_rows(&seen),
        seen,
    }
}

/// Sum of squares of the deviations of correlated values from their mean, in units of their covariance matrix:
/// Cochran's Q where they are independent.
fn spread(values: &DVector<f64>, covariance: &DMatrix<f64>) -> Option<f64> {
    let factor = covariance.clone().cholesky()?;
    let ones = DVector::from_element(values.len(), 1.0);
    let weights = factor.solve(&ones);
    let deviations = values.add_scalar(-weights.dot(values) / weights.sum());
    Some(deviations.dot(&factor.solve(&deviations)))
}

/// Parts of the observations: runs where there are a few, else halves.
fn divided(design: &Design<'_>) -> Vec<(String, Vec<usize>)> {
    let members = |is_inside: &dyn Fn(usize) -> bool| -> Vec<usize> {
        let all = 0..design.observations();
        all.filter(|at| is_inside(design.place(*at).1)).collect()
    };
    for column in design.case.with_role(Role::Run) {
        let column = &design.case.columns[column];
        let few = |labels: &&Labels| (2..=12).contains(&labels.levels.len());
        let Some(labels) = column.labels().filter(few) else {
            continue;
        };
        let run = |(level, text): (usize, &String)| {
            let inside = |block: usize| labels.of_row[design.blocks[block][0]] as usize == level;
            (format!("{} {text}", column.name), members(&inside))
        };
        return labels.levels.iter().enumerate().map(run).collect();
    }
    let half = design.blocks.len() / 2;
    vec![
        ("first half".to_owned(), members(&|block| block < half)),
        ("second half".to_owned(), members(&|block| block >= half)),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::evidence::fixture::{beside_constant, white};
    use super::*;

    #[test]
    fn a_part_learns_the_parameters_from_the_others() {
        // An offset, seen in four rows before a step; the step in two parts of two rows and of one row.
        let rows = DVector::from_row_slice(&[0.0, 0.0, 0.0, 0.0, 3.0, 3.0, 5.0]);
        let baseline = beside_constant(&rows, &white(7));
        let members = |row: usize, part: usize| match (row, part) {
            (4 | 5, 1) | (6, 2) => 1.0,
            _ => 0.0,
        };
        let columns = DMatrix::from_fn(7, 3, members);
        let Parts {
            seen,
            values,
            covariance,
            left,
        } = estimates(&baseline, &columns, &columns, (0.0, 0.0));
        assert_eq!(seen, [1, 2]);
        assert!(left.abs() < 1e-12);
        assert!((values[0] - 3.0).abs() < 1e-12 && (values[1] - 5.0).abs() < 1e-12);
        // u² of the mean of the part and of the offset.
        assert!((covariance[(0, 0)] - 0.75).abs() < 1e-12);
        assert!((covariance[(1, 1)] - 1.25).abs() < 1e-12);
        assert!((covariance[(0, 1)] - 0.25).abs() < 1e-12);
        // 5 − 3, with u² = 1/2 + 1.
        let q = spread(&values, &covariance).unwrap();
        assert!((q - 4.0 / 1.5).abs() < 1e-12);
    }

    #[test]
    fn what_no_part_determines_is_not_shown() {
        // An effect that is constant in each part, beside an offset: only their differences are determined.
        let baseline = beside_constant(&DVector::zeros(6), &white(6));
        let level = [1.0, 2.0, 4.0];
        let columns = DMatrix::from_fn(6, 3, |row, part| match row / 2 == part {
            true => level[part],
            false => 0.0,
        });
        let parts = estimates(&baseline, &columns, &columns, (0.0, 0.0));
        assert!(parts.seen.is_empty());
    }
}
