//! Which effects of the catalogue can stand in for something of which the whole trace is known: what a
//! simulation adds to a recording, say.

use nalgebra::{DMatrix, DVector};

use super::candidates::{Candidates, baseline};
use super::case::Case;
use super::catalogue::{EffectId, FittedModel};
use super::design::Design;
use super::evidence::{Atom, Shape};
use super::failure::Failure;
use super::noise;

/// A direction of which less than this (squared) is left adds nothing.
const DEPENDENT: f64 = 1e-6;

/// A name that may be given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pick {
    /// Identifier of the catalogue.
    pub id: EffectId,
    /// What it follows.
    pub along: String,
}

/// A variant of a candidate, and how well it can stand in.
#[derive(Debug, Clone, PartialEq)]
pub struct StandIn {
    /// The candidate.
    pub pick: Pick,
    /// What distinguishes the variant.
    pub label: String,
    /// Number of its free coefficients that are visible.
    pub coefficients: usize,
    /// The coefficient with which it comes nearest to the trace, if it has one alone.
    pub size: Option<f64>,
    /// Length of what it leaves of the trace over the length of the trace, beside the others.
    pub left: f64,
}

/// Holds every visible named variant beside a trace in units of the outputs, all rows of the first output
/// first; the declared parameters and `others`, traces as well, may take what they can. Empty where the
/// recording is averaged in blocks, or where the trace is invisible.
///
/// # Errors
/// When the model cannot be fitted.
pub fn stand_ins(
    case: &Case,
    trace: &DVector<f64>,
    others: &[DVector<f64>],
) -> Result<Vec<StandIn>, Failure> {
    let design = Design::new(case);
    if design.observations() != trace.len() {
        return Ok(Vec::new());
    }
    let (fit, claimed) = noise::settle(&design)?;
    let baseline = baseline(&design, &fit, &claimed)?;
    let candidates = Candidates::new(FittedModel::new(&design, &fit), &claimed, &baseline);
    let column = |of: &DVector<f64>| DMatrix::from_columns(std::slice::from_ref(of));
    let seen = |of: &DVector<f64>| baseline.project(&column(of)).column(0).into_owned();
    let mut adopted = Vec::new();
    for other in others {
        add(&mut adopted, seen(other));
    }
    let own = seen(trace);
    let alone = own.norm();
    let rest = beside(own, &adopted);
    let whole = rest.norm();
    let absorbed = baseline.visibility(&column(trace)) <= DEPENDENT;
    if absorbed || whole.is_nan() || whole * whole <= DEPENDENT * alone * alone {
        return Ok(Vec::new());
    }
    let of = |(at, atom): (usize, &Atom)| {
        let Shape::Columns(columns) = &atom.shape else {
            return None;
        };
        let mut directions = adopted.clone();
        let seen = baseline.project(columns);
        let shares = baseline.visibilities(columns);
        for (column, share) in seen.column_iter().zip(shares) {
            if share > DEPENDENT {
                add(&mut directions, column.into_owned());
            }
        }
        let own = &directions[adopted.len()..];
        let cell = candidates.cell(at);
        let size = match (own, seen.column_iter().next()) {
            ([direction], Some(column)) if seen.ncols() == 1 => {
                Some(direction.dot(&rest) / direction.dot(&column))
            }
            _ => None,
        };
        (!own.is_empty()).then(|| StandIn {
            pick: Pick {
                id: cell.effect.id,
                along: cell.place.along.clone(),
            },
            label: candidates.variation(at).label.clone(),
            coefficients: own.len(),
            size,
            left: beside(rest.clone(), own).norm() / whole,
        })
    };
    let atoms = candidates.atoms.iter().enumerate();
    Ok(atoms.filter_map(of).collect())
}

/// Adds what is left of a column to orthonormal directions, if anything.
fn add(directions: &mut Vec<DVector<f64>>, column: DVector<f64>) {
    let length = column.norm();
    let left = beside(column, directions);
    if left.norm_squared() > DEPENDENT * length * length {
        directions.push(left.normalize());
    }
}

fn beside(mut column: DVector<f64>, directions: &[DVector<f64>]) -> DVector<f64> {
    // Twice, against cancellation.
    for direction in directions.iter().chain(directions) {
        column.axpy(-direction.dot(&column), direction, 1.0);
    }
    column
}
