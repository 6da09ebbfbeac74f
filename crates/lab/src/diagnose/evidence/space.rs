//! Atoms as directions in the space of z, and sets of them.

use gumption_core::least_squares::{axes, products};
use nalgebra::{DMatrix, DVector};

use super::closed_form::{Ladder, Scale, named, scatter};
use super::directions::{INVISIBLE, joined, orthonormal, own, side_by_side, without};
use super::question::{Atom, Kind, Question, Shape};

/// Prior odds of all generics together, over those of all named candidates.
const GENERIC_ODDS: f64 = 0.15;
/// An atom that lies this near (sine squared) to a set adds nothing that data can support.
pub(super) const NEAR: f64 = 0.01;

/// What a block of directions means.
#[derive(Debug, Clone)]
pub(super) enum Form {
    /// Named physics with free coefficients.
    Named,
    /// Smooth discrepancy with the eigenvalues of its covariance matrix.
    Smooth(Ladder),
    /// Excess scatter: all directions.
    Scatter,
}

impl Form {
    /// Logarithm of the Bayes factor against none, from the squared components of the residuals along so
    /// many directions.
    pub(super) fn evidence(
        &self,
        directions: usize,
        squares: impl Iterator<Item = f64> + Clone,
        residual: &Residual,
    ) -> f64 {
        match self {
            Form::Named => named(directions, squares.sum(), residual.rss, residual.scale),
            Form::Smooth(ladder) => ladder.log_bayes_factor(squares, residual.rss, residual.scale),
            Form::Scatter => scatter(
                residual.dof,
                residual.chi_squared,
                residual.rss,
                residual.scale,
            ),
        }
    }

    /// What the evidence of so large components is at most, without the sizes of the single ones.
    pub(super) fn at_most(&self, sum_of_squares: f64, residual: &Residual) -> f64 {
        match self {
            Form::Smooth(ladder) => ladder.at_most(sum_of_squares, residual.rss, residual.scale),
            Form::Named | Form::Scatter => f64::INFINITY,
        }
    }
}

/// An atom in the space of z, possibly beside a set of others.
#[derive(Debug, Clone)]
pub(super) struct Block {
    pub(super) atom: usize,
    pub(super) candidate: usize,
    /// Logarithm of the prior odds, share among variants included.
    pub(super) log_odds: f64,
    pub(super) form: Form,
    /// N × d orthonormal directions; none for scatter.
    pub(super) basis: DMatrix<f64>,
    /// PWH, N × all columns; none but for a named atom.
    pub(super) columns: DMatrix<f64>,
    /// Columns of a named atom that are determined.
    pub(super) kept: Vec<usize>,
    /// What carries it.
    pub(super) reach: Reach,
}

/// By how many rows an effect is carried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Reach {
    /// By fewer than the root of all: single wild readings look like it.
    Few,
    /// By more.
    Many,
}

impl Reach {
    /// Whether a block has at least this reach.
    pub(super) fn admits(self, block: &Block) -> bool {
        block.reach >= self
    }

    /// Of directions, by their rows. So many rows are d/Σh², with the leverages h of all: by the inverse of it errors with heavy
    /// tails make the variance of the sum of squares along the directions larger.
    fn of(basis: &DMatrix<f64>) -> Reach {
        let mut leverages = vec![0.0; basis.nrows()];
        for column in basis.column_iter() {
            for (leverage, x) in leverages.iter_mut().zip(column.iter()) {
                *leverage += x * x;
            }
        }
        let squares: f64 = leverages.iter().map(|leverage| leverage * leverage).sum();
        let rows = basis.ncols() as f64 / squares;
        match rows * rows >= basis.nrows() as f64 {
            true => Reach::Many,
            // What only makes all rows scatter has no directions.
            false => Reach::Few,
        }
    }
}

/// All visible atoms, and the residuals that they are to explain.
#[derive(Debug, Clone)]
pub(super) struct Space<'q> {
    /// What is asked.
    pub(super) question: Question<'q>,
    pub(super) z: DVector<f64>,
    pub(super) blocks: Vec<Block>,
    pub(super) scale: Scale,
    /// Dimension of the space, m.
    pub(super) dof: usize,
    /// What is added to a sum of squares of residuals for knowledge of the scale from elsewhere: ν₀.
    pub(super) offset: f64,
    /// Directions of all blocks side by side.
    pub(super) directions: DMatrix<f64>,
    /// Place of the first direction of each block, and the end.
    starts: Vec<usize>,
    /// Components of z along the directions.
    pub(super) components: DVector<f64>,
}

/// A set of named blocks that are adopted together.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    /// Indices of blocks.
    pub(super) blocks: Vec<usize>,
    /// Orthonormal basis of what they span.
    pub(super) basis: DMatrix<f64>,
    /// By how much they reduce χ².
    pub(super) fit: f64,
}

impl<'q> Space<'q> {
    pub(super) fn new(question: &Question<'q>) -> Space<'q> {
        let baseline = question.baseline;
        let log_odds = log_odds(question);
        let mut space = Space {
            question: question.clone(),
            z: baseline.residuals().clone(),
            blocks: Vec::new(),
            scale: Scale::new(baseline.dof(), baseline.scale_dof()),
            dof: baseline.dof(),
            offset: Some(baseline.scale_dof())
                .filter(|nu| nu.is_finite())
                .unwrap_or(0.0),
            directions: DMatrix::zeros(0, 0),
            starts: vec![0],
            components: DVector::zeros(0),
        };
        // All columns at once: products with few columns spend their time on reading the whitener.
        let columns = (question.atoms.iter()).filter_map(|atom| atom.shape.columns());
        let (seen, lengths) = baseline.visible(&side_by_side(baseline.rows(), columns));
        let mut start = 0;
        for (index, atom) in question.atoms.iter().enumerate() {
            let own = start..start + atom.shape.width();
            start = own.end;
            let columns = seen.columns_range(own.clone()).into_owned();
            let block = block(index, atom, log_odds[index], columns, &lengths[own]);
            space.blocks.extend(block);
        }
        for block in &space.blocks {
            let last = space.starts[space.starts.len() - 1];
            space.starts.push(last + block.basis.ncols());
        }
        let bases = space.blocks.iter().map(|block| &block.basis);
        space.directions = side_by_side(space.z.len(), bases);
        space.components = space.directions.tr_mul(&space.z);
        space
    }

    /// Places of the directions of a block among all.
    pub(super) fn places(&self, block: usize) -> std::ops::Range<usize> {
        self.starts[block]..self.starts[block + 1]
    }

    /// No effect.
    pub(super) fn empty(&self) -> Frame {
        Frame {
            blocks: Vec::new(),
            basis: DMatrix::zeros(self.z.len(), 0),
            fit: 0.0,
        }
    }

    /// Blocks together that were independent when they were visited.
    pub(super) fn frame_of(&self, blocks: &[usize]) -> Frame {
        self.frame(blocks).unwrap_or_else(|| self.empty())
    }

    /// The blocks together; `None` if they are not independent.
    pub(super) fn frame(&self, blocks: &[usize]) -> Option<Frame> {
        blocks
            .iter()
            .try_fold(self.empty(), |frame, &block| self.extended(&frame, block))
    }

    /// A set with one block more; `None` if it adds no direction.
    pub(super) fn extended(&self, frame: &Frame, block: usize) -> Option<Frame> {
        let beside = self.blocks[block].directions_beside(&frame.basis);
        if beside.ncols() == 0 || frame.basis.ncols() + beside.ncols() > self.room() {
            return None;
        }
        let fit = frame.fit + beside.tr_mul(&self.z).norm_squared();
        let mut blocks = frame.blocks.clone();
        blocks.push(block);
        blocks.sort_unstable();
        Some(Frame {
            blocks,
            basis: joined(&frame.basis, &beside),
            fit,
        })
    }

    /// Directions that a set may span at most: where the scale is estimated, one has to be left.
    pub(super) fn room(&self) -> usize {
        match self.scale {
            Scale::Known => self.dof,
            Scale::Estimated { total } => self.dof.min((total - 1.0).max(0.0) as usize),
        }
    }

    /// Sum of squares of the residuals and of what is known of their scale.
    pub(super) fn rss(&self) -> f64 {
        self.z.norm_squared() + self.offset
    }

    /// Logarithm of the posterior odds of a set against none.
    pub(super) fn score(&self, frame: &Frame) -> f64 {
        if frame.blocks.is_empty() {
            return 0.0;
        }
        let directions = frame.basis.ncols();
        named(directions, frame.fit, self.rss(), self.scale) + self.prior(frame)
    }

    /// Logarithm of the prior odds of a set.
    pub(super) fn prior(&self, frame: &Frame) -> f64 {
        frame.blocks.iter().map(|b| self.blocks[*b].log_odds).sum()
    }

    /// λ of all that a set explains and that has a form.
    pub(super) fn strength(&self, frame: &Frame) -> f64 {
        let blocks = frame.blocks.iter().copied();
        let exact: Vec<usize> = blocks.filter(|block| self.is_of_readings(*block)).collect();
        let formless = match exact.as_slice() {
            [] => 0.0,
            exact => self.frame_of(exact).fit,
        };
        (frame.fit - formless).max(0.0).sqrt() / self.sigma(frame)
    }

    /// Whether a block says what happened to one reading, or to two that were exchanged: that has no form from which it could depart.
    fn is_of_readings(&self, block: usize) -> bool {
        match &self.question.atoms[self.blocks[block].atom].shape {
            Shape::Columns(columns) => {
                let touched = columns.row_iter().filter(|row| row.amax() > 0.0);
                touched.take(3).count() <= 2
            }
            Shape::Smooth { .. } | Shape::Scatter => false,
        }
    }

    /// Standard deviation of the noise in whitened units, where a set is all there is.
    pub(super) fn sigma(&self, frame: &Frame) -> f64 {
        match self.scale.less(frame.basis.ncols()) {
            Scale::Known => 1.0,
            Scale::Estimated { total } => {
                ((self.rss() - frame.fit).max(0.0) / total.max(1.0)).sqrt()
            }
        }
    }

    /// A candidate is in a set once, unless it is of a kind that repeats.
    pub(super) fn may_join(&self, frame: &Frame, block: &Block) -> bool {
        frame.blocks.iter().all(|other| {
            let other = &self.blocks[*other];
            other.atom != block.atom
                && (other.candidate != block.candidate
                    || self.question.candidates[block.candidate].repeats)
        })
    }

    /// What is left when a set is adopted.
    pub(super) fn residual(&self, frame: &Frame) -> Residual {
        let chi_squared = (self.z.norm_squared() - frame.fit).max(0.0);
        Residual {
            chi_squared,
            rss: chi_squared + self.offset,
            dof: self.dof - frame.basis.ncols(),
            scale: self.scale.less(frame.basis.ncols()),
        }
    }
}

/// Residuals that evidence is computed against.
#[derive(Debug, Clone, Copy)]
pub(super) struct Residual {
    pub(super) chi_squared: f64,
    /// χ² and what is known of the scale from elsewhere.
    pub(super) rss: f64,
    pub(super) dof: usize,
    pub(super) scale: Scale,
}

impl Residual {
    /// The same where the noise is known and so many times larger.
    pub(super) fn with_noise(self, noise: f64) -> Residual {
        let times = 1.0 / (noise * noise);
        Residual {
            chi_squared: times * self.chi_squared,
            rss: times * self.rss,
            ..self
        }
    }
}

impl Block {
    pub(super) fn kind(&self) -> Kind {
        match self.form {
            Form::Named => Kind::Named,
            Form::Smooth(_) | Form::Scatter => Kind::Generic,
        }
    }

    /// Its directions beside an orthonormal basis.
    fn directions_beside(&self, basis: &DMatrix<f64>) -> DMatrix<f64> {
        if basis.ncols() == 0 {
            return self.basis.clone();
        }
        let lengths = vec![1.0; self.basis.ncols()];
        orthonormal(without(&self.basis, basis), &lengths, NEAR).0
    }

    /// The determined columns, as they are.
    pub(super) fn determined(&self) -> DMatrix<f64> {
        self.columns.select_columns(&self.kept)
    }
}

/// An atom with its columns as they are seen, and the lengths that these had with what the parameters absorb.
fn block(
    index: usize,
    atom: &Atom,
    log_odds: f64,
    mut columns: DMatrix<f64>,
    lengths: &[f64],
) -> Option<Block> {
    let rows = columns.nrows();
    let nothing = || DMatrix::zeros(rows, 0);
    let (form, basis, columns, kept) = match &atom.shape {
        Shape::Scatter => (Form::Scatter, nothing(), nothing(), Vec::new()),
        Shape::Columns(_) => {
            let (basis, kept) = own(columns.clone(), lengths.to_vec());
            if kept.is_empty() {
                return None;
            }
            (Form::Named, basis, columns, kept)
        }
        Shape::Smooth { spectrum, .. } => {
            let whole: f64 = lengths.iter().zip(spectrum).map(|(l, e)| l * l * e).sum();
            for (mut column, e) in columns.column_iter_mut().zip(spectrum) {
                column *= e.sqrt();
            }
            if !(columns.norm_squared() > INVISIBLE * whole) {
                return None;
            }
            // In units in which the whole discrepancy has the size s.
            columns /= columns.norm();
            let (ladder, basis) = smooth(columns)?;
            (Form::Smooth(ladder), basis, nothing(), Vec::new())
        }
    };
    Some(Block {
        atom: index,
        candidate: atom.candidate,
        log_odds,
        form,
        reach: Reach::of(&basis),
        basis,
        columns,
        kept,
    })
}

/// Principal directions and eigenvalues of MMᵀ.
pub(super) fn smooth(columns: DMatrix<f64>) -> Option<(Ladder, DMatrix<f64>)> {
    let (ladder, turn) = principal(products(&columns, &columns))?;
    Some((ladder, columns * turn.transpose()))
}

/// Eigenvalues of MMᵀ from MᵀM, and the matrix that takes Mᵀx to the components of x along the
/// directions.
pub(super) fn principal(gram: DMatrix<f64>) -> Option<(Ladder, DMatrix<f64>)> {
    let eigen = axes(gram)?;
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|k| eigen.eigenvalues[*k] > 1e-6)
        .collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    if order.is_empty() {
        return None;
    }
    let eigenvalues: Vec<f64> = order.iter().map(|k| eigen.eigenvalues[*k]).collect();
    let mut turn = eigen.eigenvectors.select_columns(&order).transpose();
    for (mut row, e) in turn.row_iter_mut().zip(&eigenvalues) {
        row /= e.sqrt();
    }
    Some((Ladder::new(&eigenvalues), turn))
}

/// Logarithms of the prior odds of atoms: as likely as not nothing was left out, all usual named candidates alike, a share for
/// those without a name.
fn log_odds(question: &Question) -> Vec<f64> {
    let count = question.candidates.len();
    // Of the atoms of each candidate, over its own odds.
    let mut shares = vec![0.0; count];
    let mut kinds: Vec<Option<Kind>> = vec![None; count];
    for atom in question.atoms {
        kinds[atom.candidate] = Some(atom.shape.kind());
        shares[atom.candidate] += atom.share;
    }
    let of = |kind| kinds.iter().filter(|k| **k == Some(kind)).count().max(1) as f64;
    let (named, generic) = (of(Kind::Named), of(Kind::Generic));
    for (share, candidate) in shares.iter_mut().zip(question.candidates) {
        *share /= candidate.odds;
    }
    let none = libm::exp2(-1.0 / named);
    let odds = (1.0 - none) / none;
    let of_atom = |atom: &Atom| {
        let of_kind = match atom.shape.kind() {
            Kind::Named => libm::log(odds),
            Kind::Generic => libm::log(odds * GENERIC_ODDS * named / generic),
        };
        of_kind + libm::log(atom.share / shares[atom.candidate])
    };
    question.atoms.iter().map(of_atom).collect()
}
