//! What the rows of one output show by themselves.
//!
//! Where the size of the noise is estimated, all outputs are examined with one open scale and with the ratios that their residuals
//! have. An effect in one of them alone raises its residuals, and is weighed by what it raised: of three outputs it takes away a
//! third of the sum of squares at most, however clear it is. Each output alone has no such ratio, and a test of its own.

use std::ops::Range;

use gumption_core::least_squares::span;
use gumption_core::special::f_sf;
use nalgebra::DMatrix;

use super::question::{Kind, Question};

/// Directions of an effect that reach no further, in units of its length, are rounding.
const FLAT: f64 = 1e-9;

/// For each output, given by its observations: by what the standard uncertainty of its noise is multiplied where the effect is not
/// noise that explains most of its rows. One where none does beyond chance: F tests, one for each effect and output, of the level
/// `alpha` together (Bonferroni).
pub fn shrunk(question: &Question<'_>, outputs: &[Range<usize>], alpha: f64) -> Vec<f64> {
    let baseline = question.baseline;
    let left = baseline.residuals();
    let free: Vec<f64> = outputs
        .iter()
        .map(|rows| {
            let taken = baseline.absorbed().rows(rows.start, rows.len());
            rows.len() as f64 - taken.norm_squared()
        })
        .collect();
    let mut tests = 0.0;
    let mut best = vec![(1.0, 1.0); outputs.len()];
    for atom in question
        .atoms
        .iter()
        .filter(|atom| atom.shape.kind() == Kind::Named)
    {
        let Some(columns) = atom.shape.columns() else {
            continue;
        };
        let seen = baseline.project(columns);
        let whole = seen.norm();
        for (output, rows) in outputs.iter().enumerate() {
            let part: DMatrix<f64> = seen.rows(rows.start, rows.len()).into_owned();
            let basis = match part.norm() > FLAT * whole {
                true => span(part, FLAT),
                false => continue,
            };
            let (taken, dof) = (basis.ncols() as f64, free[output]);
            if taken == 0.0 || dof - taken < 1.0 {
                continue;
            }
            tests += 1.0;
            let own = left.rows(rows.start, rows.len());
            let (all, gain) = (own.norm_squared(), basis.tr_mul(&own).norm_squared());
            let rest = ((all - gain) / (dof - taken)).max(f64::MIN_POSITIVE);
            let p = f_sf(gain / taken / rest, taken, dof - taken);
            if p < best[output].0 {
                best[output] = (p, (rest / (all / dof)).sqrt());
            }
        }
    }
    let shows = |(p, factor): (f64, f64)| match p * tests <= alpha {
        true => factor.min(1.0),
        false => 1.0,
    };
    best.into_iter().map(shows).collect()
}
