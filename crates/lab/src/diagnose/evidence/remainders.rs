//! All blocks beside a set that is adopted: what is left of each when everything along the set is taken
//! out.
//!
//! Everything is computed in coordinates along the directions of the blocks, which are there already, so
//! that it does not matter how many rows a recording has: with A = FᵀU, the components of a block of
//! directions U beside the orthonormal basis F of the set are T(Uᵀx − AᵀFᵀx), and T follows from the
//! small matrix UᵀU − AᵀA.

use gumption_core::least_squares::products;
use nalgebra::{DMatrix, DVector};

use super::closed_form::{Ladder, named, scatter};
use super::question::Kind;
use super::space::{Form, Frame, NEAR, Residual, Space, principal};

/// Every block that may join a set, beside it.
pub(super) struct Remainders<'s> {
    pub(super) space: &'s Space<'s>,
    pub(super) frame: &'s Frame,
    /// A = FᵀU for the directions of all blocks.
    along: DMatrix<f64>,
    /// What is left of z when the set is adopted.
    pub(super) residual: Residual,
    pub(super) rests: Vec<Remainder>,
}

/// A block beside a set.
pub(super) struct Remainder {
    /// Index of the block in the space.
    pub(super) block: usize,
    pub(super) kind: Kind,
    /// The share of it that lies along the set: 1 where it is, or holds, what the set is; nothing for scatter, which has no shape.
    pub(super) resemblance: Option<f64>,
    form: Form,
    /// T.
    turn: DMatrix<f64>,
}

impl<'s> Remainders<'s> {
    pub(super) fn new(space: &'s Space<'s>, frame: &'s Frame) -> Remainders<'s> {
        let along = products(&frame.basis, &space.directions);
        let rest = |index: usize| {
            let block = &space.blocks[index];
            if !space.may_join(frame, block) {
                return None;
            }
            let a = along.columns_range(space.places(index));
            let gram = DMatrix::identity(a.ncols(), a.ncols()) - a.tr_mul(&a);
            let (form, turn) = match &block.form {
                Form::Scatter => (Form::Scatter, DMatrix::zeros(0, 0)),
                Form::Named => (Form::Named, independent(gram)),
                Form::Smooth(_) if frame.basis.ncols() == 0 => {
                    (block.form.clone(), DMatrix::identity(a.ncols(), a.ncols()))
                }
                Form::Smooth(ladder) => {
                    // Only this is left of the matrix of products of its directions.
                    let (ladder, turn) = scaled(&ladder.roots(), gram)?;
                    (Form::Smooth(ladder), turn)
                }
            };
            let is_scatter = matches!(form, Form::Scatter);
            let resemblance = (!is_scatter).then(|| a.norm_squared().min(1.0));
            (is_scatter || turn.nrows() > 0).then_some(Remainder {
                block: index,
                kind: block.kind(),
                resemblance,
                form,
                turn,
            })
        };
        let rests = (0..space.blocks.len()).filter_map(rest).collect();
        Remainders {
            space,
            frame,
            residual: space.residual(frame),
            rests,
            along,
        }
    }

    /// Takes what lies along the set out of components along all directions: for recordings one per row,
    /// with their components along the basis of the set.
    pub(super) fn reduce(&self, components: &mut DMatrix<f64>, set: &DMatrix<f64>) {
        if self.along.nrows() > 0 {
            components.gemm(-1.0, set, &self.along, 1.0);
        }
    }

    /// Components of the residuals along all directions, beside the set.
    pub(super) fn observed(&self) -> DVector<f64> {
        let set = self.frame.basis.tr_mul(&self.space.z);
        &self.space.components - self.along.tr_mul(&set)
    }

    /// Components along the directions of a rest, of a vector with these components along all.
    pub(super) fn components(&self, rest: &Remainder, all: &DVector<f64>) -> DVector<f64> {
        let own = self.space.places(rest.block);
        &rest.turn * all.rows(own.start, own.len())
    }

    /// The same for recordings one per row: a column for each direction.
    pub(super) fn turned(&self, rest: &Remainder, recordings: &DMatrix<f64>) -> DMatrix<f64> {
        recordings.columns_range(self.space.places(rest.block)) * rest.turn.transpose()
    }

    /// Adds the squared components of recordings, one per row, along the directions of a rest.
    pub(super) fn add_squares(
        &self,
        rest: &Remainder,
        recordings: &DMatrix<f64>,
        sums: &mut [f64],
    ) {
        let first = self.space.places(rest.block).start;
        let lanes = recordings.nrows();
        let column =
            |k: usize| &recordings.as_slice()[(first + k) * lanes..(first + k + 1) * lanes];
        if rest.turn.len() == 1 {
            let factor = rest.turn[(0, 0)] * rest.turn[(0, 0)];
            for (sum, x) in sums.iter_mut().zip(column(0)) {
                *sum += factor * x * x;
            }
            return;
        }
        let mut component = vec![0.0; lanes];
        for row in rest.turn.row_iter() {
            component.fill(0.0);
            for (k, factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
                for (c, x) in component.iter_mut().zip(column(k)) {
                    *c += factor * x;
                }
            }
            for (sum, c) in sums.iter_mut().zip(&component) {
                *sum += c * c;
            }
        }
    }

    /// Score of the set with a block more; `None` where the residuals have no room for it.
    pub(super) fn score(&self, rest: &Remainder, observed: &DVector<f64>) -> Option<f64> {
        let space = self.space;
        let components = self.components(rest, observed);
        let own = space.blocks[rest.block].log_odds;
        match rest.kind {
            Kind::Named => {
                let d = self.frame.basis.ncols() + components.len();
                let fit = self.frame.fit + components.norm_squared();
                let prior = space.prior(self.frame);
                (d <= space.room()).then(|| named(d, fit, space.rss(), space.scale) + prior + own)
            }
            Kind::Generic => {
                let squares = components.iter().map(|c| c * c);
                Some(space.score(self.frame) + rest.evidence(squares, &self.residual) + own)
            }
        }
    }

    /// Scores of the set with each named block and a generic one more.
    pub(super) fn scores_with(&self, generic: usize) -> Vec<(usize, f64)> {
        let space = self.space;
        let block = &space.blocks[generic];
        let observed = self.observed();
        let named = self.rests.iter().filter(|rest| rest.kind == Kind::Named);
        let roots = match &block.form {
            Form::Smooth(ladder) => ladder.roots(),
            Form::Named | Form::Scatter => Vec::new(),
        };
        let own = self.space.places(generic);
        // UᵀU of the generic with all directions, without the set.
        let mut cross = products(&block.basis, &space.directions);
        let along = self.along.columns_range(own.clone());
        cross.gemm(-1.0, &along.transpose(), &self.along, 1.0);
        let gram = cross.columns_range(own.clone()).into_owned();
        let with = |rest: &Remainder| {
            let score = self.score(rest, &observed)?;
            let components = self.components(rest, &observed);
            let fit = components.norm_squared();
            let chi_squared = (self.residual.chi_squared - fit).max(0.0);
            let residual = Residual {
                chi_squared,
                rss: chi_squared + space.offset,
                dof: self.residual.dof.saturating_sub(components.len()),
                scale: self.residual.scale.less(components.len()),
            };
            let evidence = if let Form::Scatter = block.form {
                scatter(residual.dof, chi_squared, residual.rss, residual.scale)
            } else {
                let shared = cross.columns_range(space.places(rest.block)) * rest.turn.transpose();
                let gram = &gram - &shared * shared.transpose();
                let left = observed.rows(own.start, own.len()) - &shared * &components;
                let (ladder, turn) = scaled(&roots, gram)?;
                let found = turn * left;
                ladder.log_bayes_factor(found.iter().map(|c| c * c), residual.rss, residual.scale)
            };
            Some((rest.block, score + evidence + block.log_odds))
        };
        named.filter_map(with).collect()
    }
}

impl Remainder {
    /// Directions beside the set.
    pub(super) fn directions(&self) -> usize {
        self.turn.nrows()
    }

    /// Logarithm of the Bayes factor against none, from the squared components of the residuals along
    /// the directions of the rest.
    pub(super) fn evidence(
        &self,
        squares: impl Iterator<Item = f64> + Clone,
        residual: &Residual,
    ) -> f64 {
        self.form.evidence(self.directions(), squares, residual)
    }

    /// What [`Remainder::evidence`] is at most for components with this sum of squares.
    pub(super) fn at_most(&self, sum_of_squares: f64, residual: &Residual) -> f64 {
        self.form.at_most(sum_of_squares, residual)
    }
}

/// Eigenvalues and components for features that are directions times the roots of their variances.
fn scaled(roots: &[f64], gram: DMatrix<f64>) -> Option<(Ladder, DMatrix<f64>)> {
    let features = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| {
        roots[i] * gram[(i, j)] * roots[j]
    });
    let (ladder, mut turn) = principal(features)?;
    for (mut column, root) in turn.column_iter_mut().zip(roots) {
        column *= *root;
    }
    Some((ladder, turn))
}

/// T with T G Tᵀ = I for the matrix G of products of unit directions of which some part is taken out,
/// the greatest remainder first; directions of which hardly anything is left are dropped.
fn independent(mut gram: DMatrix<f64>) -> DMatrix<f64> {
    let size = gram.nrows();
    // Rows of T, and of G, which is symmetric, stand as columns, which are contiguous.
    let mut turn: DMatrix<f64> = DMatrix::identity(size, size);
    let mut rows: Vec<DVector<f64>> = Vec::new();
    let mut left: Vec<usize> = (0..size).collect();
    while let Some(place) = (0..left.len()).max_by(|a, b| {
        let share = |place: &usize| gram[(left[*place], left[*place])];
        share(a).total_cmp(&share(b))
    }) {
        let best = left.swap_remove(place);
        let share = gram[(best, best)];
        if !(share > NEAR) {
            break;
        }
        rows.push(turn.column(best) / share.sqrt());
        for other in &left {
            let ratio = gram[(best, *other)] / share;
            for matrix in [&mut turn, &mut gram] {
                let (mut from, taken) = matrix.columns_range_pair_mut(*other, best);
                from.axpy(-ratio, &taken, 1.0);
            }
        }
    }
    DMatrix::from_fn(rows.len(), size, |i, j| rows[i][j])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_that_are_left_are_orthonormal() {
        // Two unit directions, one of which is taken out by nearly all of its length.
        let along = DMatrix::from_row_slice(1, 3, &[0.6, 0.0, 0.999]);
        let gram = DMatrix::identity(3, 3) - along.transpose() * &along;
        let turn = independent(gram.clone());
        assert_eq!(turn.nrows(), 2);
        let products = &turn * gram * turn.transpose();
        assert!((products - DMatrix::identity(2, 2)).norm() < 1e-12);
    }
}
