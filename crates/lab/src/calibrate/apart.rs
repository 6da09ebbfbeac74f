//! Points that stand apart from all others.

use super::points::PointNames;
use super::residual::Residual;
use super::scatter::ResponseScatter;
use super::uneven::Uneven;
use crate::experiment::Words;
use gumption_core::special::student_t_sf;

/// A point whose residual the scatter of the others does not explain.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Apart {
    /// The response.
    pub response: String,
    /// The point.
    pub point: Words,
    /// Its residual over the standard deviation that the residuals of the others give it.
    pub t: f64,
    /// The probability that the largest of all these residuals is as far out.
    pub p_value: f64,
}

/// How improbable it must be that noise alone makes a point stand out: by its residual, at the end of a range, or in exchange for
/// another. Of all points of a response together.
pub(super) const RARE: f64 = 1e-3;

/// Fewer degrees of freedom tell nothing.
const LEAST_DOF: f64 = 3.0;

/// Less than this part of a reading is rounding.
const ROUNDING: f64 = 1e-10;

/// For each response the largest residual, by the t test of deleted residuals for the largest of n (Bonferroni). Readings that are known
/// to scatter differently are held each against its own standard deviation, of a fit in which they have these weights.
pub(super) fn apart(
    residuals: &[Residual],
    responses: (&[ResponseScatter], &[Option<Uneven>]),
    names: &PointNames,
) -> Vec<Apart> {
    let of_response =
        |(response, (scatter, uneven)): (usize, (&ResponseScatter, &Option<Uneven>))| {
            let own = residuals.iter().filter(|one| one.response == response);
            let (sizes, dof): (Vec<f64>, f64) = match uneven {
                Some(uneven) => (uneven.among_all.clone(), uneven.dof),
                None => (
                    own.clone().map(|one| one.standardised).collect(),
                    scatter.dof,
                ),
            };
            let sized = own.zip(sizes).filter(|(_, size)| !size.is_nan());
            let count = sized.clone().count() as f64;
            let (largest, size) = sized.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()))?;
            let square = size.powi(2);
            let rounding = ROUNDING * largest.observed.abs().max(largest.fitted.abs());
            if dof < LEAST_DOF || (largest.observed - largest.fitted).abs() < rounding {
                return None;
            }
            // Where the others fit perfectly the quotient is infinite.
            let t = ((dof - 1.0) * square / (dof - square).max(0.0)).sqrt();
            let p_value = (2.0 * count * student_t_sf(t, dof - 1.0)).min(1.0);
            (p_value < RARE).then(|| Apart {
                response: scatter.response.clone(),
                point: names.of(largest.point),
                t,
                p_value,
            })
        };
    let (scatters, uneven) = responses;
    scatters
        .iter()
        .zip(uneven)
        .enumerate()
        .filter_map(of_response)
        .collect()
}
