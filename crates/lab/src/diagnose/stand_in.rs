//! Which effects of the catalogue can stand in for something of which the whole trace is known: what a
//! simulation adds to a recording, say.

use nalgebra::{DMatrix, DVector};

use super::candidates::{Candidates, baseline};
use super::case::Case;
use super::catalogue::{EffectId, FittedModel};
use super::design::Design;
use super::evidence::{self, Atom, Shape};
use super::failure::Failure;
use super::settled;

/// A direction of which less than this (squared) is left adds nothing.
const DEPENDENT: f64 = 1e-6;

/// A name that may be given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pick {
    /// Identifier of the catalogue.
    pub id: EffectId,
    /// What it acts on.
    pub node: String,
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
    let (fit, claimed) = settled::settle(&design)?;
    let baseline = baseline(&design, &fit, &claimed)?;
    let candidates = Candidates::new(FittedModel::new(&design, &fit), &claimed, &baseline);
    let column = |of: &DVector<f64>| DMatrix::from_columns(std::slice::from_ref(of));
    let own = baseline.project(&column(trace));
    let mut adopted = DMatrix::zeros(own.nrows(), 0);
    for other in others {
        let more = beside(&baseline.project(&column(other)), &adopted);
        adopted = evidence::all([adopted, more].into_iter());
    }
    let rest = evidence::without(&own, &adopted);
    let whole = rest.norm();
    let absorbed = baseline.visibility(&column(trace)) <= DEPENDENT;
    if absorbed || whole.is_nan() || whole * whole <= DEPENDENT * own.norm_squared() {
        return Ok(Vec::new());
    }
    let of = |(at, atom): (usize, &Atom)| {
        let Shape::Columns(columns) = &atom.shape else {
            return None;
        };
        let (seen, shares) = (baseline.project(columns), baseline.visibilities(columns));
        let shows = (0..shares.len()).filter(|at| shares[*at] > DEPENDENT);
        let own = beside(&seen.select_columns(&shows.collect::<Vec<_>>()), &adopted);
        let cell = candidates.cell(at);
        let is_one = seen.ncols() == 1 && own.ncols() == 1;
        (own.ncols() > 0).then(|| StandIn {
            pick: Pick {
                id: cell.effect.id,
                node: cell.place.node.clone(),
                along: cell.place.along.clone(),
            },
            label: candidates.variation(at).label.clone(),
            coefficients: own.ncols(),
            size: is_one.then(|| own.dot(&rest) / own.dot(&seen)),
            left: evidence::without(&rest, &own).norm() / whole,
        })
    };
    let atoms = candidates.atoms.iter().enumerate();
    Ok(atoms.filter_map(of).collect())
}

/// Orthonormal directions of columns beside others.
fn beside(columns: &DMatrix<f64>, others: &DMatrix<f64>) -> DMatrix<f64> {
    let lengths: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
    evidence::orthonormal(evidence::without(columns, others), &lengths, DEPENDENT).0
}
