//! A design as the catalogue sees it: a few means of rows in every block of a long recording.
//!
//! What effects follow is computed row by row before it is averaged over the blocks, for thousands of variants:
//! with every row of a long recording that takes more memory and time than a computer has. Blocks are compared, so
//! rows that lie much closer than blocks need not be told apart: a course that is straight over a piece has the
//! lag of all its rows, a delay shorter than a piece is its rate times the delay, and the quickest time constant
//! that is looked for is half a block, or half a piece behind an input. Of rows between blocks, which nobody looks at but what
//! remembers, the less has to be known the longer ago they are. What is found is fitted to all rows of the blocks again.

use std::ops::Range;

use nalgebra::DMatrix;

use super::case::{Case, Rows};
use super::catalogue::modifiers::in_succession;
use super::design::{Design, Linear, Whole};
use super::fit::Fit;
use crate::recording::Labels;

/// Means in a block, at least: a tenth of a block is a fifth of the quickest time constant that is looked for, over which
/// the curvature of its decay changes a mean by (1/5)²/24 of it, less than anything that is told.
const PIECES: usize = 10;

/// Means of rows in front of a block are as long as this part of what is then between them and the block, at most: what
/// remembers for a time τ has forgotten all but e^(−d/τ) of them there, and their curvature changes that by (d/τ)²/25/24 of it,
/// which is most for d = 2τ and then half of what [`PIECES`] leaves.
const BEFORE: usize = 5;

/// They are no longer than half a block, so that they keep all but a fortieth of the variance that a block keeps nine tenths of: what
/// remembers where a course turned round, as a play does, does not forget it with time.
const TURNS: usize = PIECES / 2;

/// A recording with means of rows in place of its rows.
#[derive(Debug)]
pub(super) struct Coarse<'c> {
    whole: &'c Case,
    case: Case,
    pieces: Vec<Range<usize>>,
    blocks: Vec<Vec<usize>>,
    /// The fitted model there.
    pub fit: Fit,
}

impl<'c> Coarse<'c> {
    /// The means of a design, and the model as it is fitted to all rows.
    pub(super) fn of(design: &Design<'c>, fit: &Fit) -> Coarse<'c> {
        let block_of = block_of(design);
        let pieces = pieces(design, &block_of);
        let mut blocks = vec![Vec::new(); design.blocks.len()];
        for (at, piece) in pieces.iter().enumerate() {
            if let Some(block) = block_of[piece.start] {
                blocks[block].push(at);
            }
        }
        let data = design.case.columns.iter().map(|column| {
            let first = |labels: &Labels| pieces.iter().map(|p| labels.of_row[p.start]).collect();
            column.data.map(|numbers| means(&pieces, numbers), first)
        });
        let rows = Rows {
            count: pieces.len(),
            data: data.collect(),
        };
        Coarse {
            whole: design.case,
            case: design.case.with(&rows),
            fit: at_means(&pieces, fit),
            pieces,
            blocks,
        }
    }

    /// The model at other values of its parameters, at the means.
    pub(super) fn at(&self, fit: &Fit) -> Fit {
        at_means(&self.pieces, fit)
    }

    /// The design of the means.
    pub(super) fn design(&self) -> Design<'_> {
        let whole = Whole {
            case: self.whole,
            rows: self.pieces.clone(),
        };
        Design::of_means(&self.case, self.blocks.clone(), whole)
    }
}

/// The block in which each row is; those before a dwell has settled are in none.
fn block_of(design: &Design<'_>) -> Vec<Option<usize>> {
    let mut of = vec![None; design.case.rows];
    for (block, rows) in design.blocks.iter().enumerate() {
        for row in rows {
            of[*row] = Some(block);
        }
    }
    of
}

/// How many means there are of a design.
pub(super) fn pieces_of(design: &Design<'_>) -> usize {
    pieces(design, &block_of(design)).len()
}

/// Rows in a mean, at most.
fn longest(design: &Design<'_>) -> usize {
    let block = design.blocks.iter().map(Vec::len).max().unwrap_or(1);
    (block / PIECES).max(1)
}

/// Successive rows of one block, with the same labels.
fn pieces(design: &Design<'_>, block_of: &[Option<usize>]) -> Vec<Range<usize>> {
    let labels: Vec<&Labels> = design.case.labels().collect();
    let alike = |a: usize, b: usize| {
        block_of[a] == block_of[b] && labels.iter().all(|l| l.of_row[a] == l.of_row[b])
    };
    let own = longest(design);
    let next = next_blocks(block_of);
    let most = |row: usize| own.max(((next[row] - row) / (BEFORE + 1)).min(TURNS * own));
    in_succession(design.case.rows, most, alike)
}

/// The next row of a block, from each row on; behind all blocks as if it never came.
fn next_blocks(block_of: &[Option<usize>]) -> Vec<usize> {
    let mut next = vec![0; block_of.len()];
    let mut nearest = usize::MAX;
    for row in (0..block_of.len()).rev() {
        if block_of[row].is_some() {
            nearest = row;
        }
        next[row] = nearest;
    }
    next
}

fn at_means(pieces: &[Range<usize>], fit: &Fit) -> Fit {
    let (values, slopes) = (fit.linear.values.iter(), fit.linear.slopes.iter());
    let of_columns = |columns: &DMatrix<f64>| {
        let each = columns.as_slice().chunks(columns.nrows().max(1));
        let means = each.flat_map(|column| means(pieces, column));
        DMatrix::from_iterator(pieces.len(), columns.ncols(), means)
    };
    Fit {
        linear: Linear {
            values: values.map(|values| means(pieces, values)).collect(),
            slopes: slopes.map(of_columns).collect(),
        },
        ..fit.clone()
    }
}

fn means(pieces: &[Range<usize>], values: &[f64]) -> Vec<f64> {
    let mean = |piece: &Range<usize>| {
        let own = &values[piece.clone()];
        // A set point is itself, not even rounded.
        match own.iter().all(|value| *value == own[0]) {
            true => own[0],
            false => own.iter().sum::<f64>() / own.len() as f64,
        }
    };
    pieces.iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use gumption_gum::budget::Files;

    use super::super::case::Purpose;
    use super::super::catalogue::{FittedModel, Modifier, Node, Term, course::late};
    use super::super::settled;
    use super::*;

    const CASE: &str = "recording = 'r.csv'\nequations = 'U = U0 + s*x'\n\
        [columns]\nU = 'output'\nx = 'stimulus'\nt = 'time'\nrun = 'run'\n[noise]\nu = 0.01\n";

    /// A wave that goes through so many radians, and set points of one decimal digit, in two runs.
    fn recording(rows: usize, radians: f64) -> String {
        let row = |row: usize| {
            let x = libm::sin(radians * row as f64 / rows as f64);
            let run = 1 + 2 * row / rows;
            format!("{row},{x:.6},{},{run}\n", x + 0.01 * (row % 7) as f64)
        };
        "t [s],x,U,run\n".to_owned() + &(0..rows).map(row).collect::<String>()
    }

    fn case(rows: usize, radians: f64) -> Case {
        let text = recording(rows, radians);
        let files = [("c.toml", CASE.as_bytes()), ("r.csv", text.as_bytes())];
        let library = Files::Library(&files);
        Case::load_from(library, Path::new("c.toml"), Purpose::Diagnosis).unwrap()
    }

    fn fitted(case: &Case) -> (Design<'_>, Fit) {
        let design = Design::new(case);
        let (fit, _) = settled::settle(&design).unwrap();
        (design, fit)
    }

    /// What a lag with this time constant in rows takes from the stimulus, in the means less in all rows, over that in all rows.
    fn lag_is_off([all, means]: [&FittedModel<'_>; 2], tau: f64) -> f64 {
        let column = |fitted: &FittedModel<'_>| {
            let x = fitted.numbers(1);
            let late = late(&fitted.clock.values, x, &[], tau);
            let lacks = late.iter().zip(x).map(|(late, x)| late - x).collect();
            fitted.column(&Term::new(Node::Column(1), Modifier::unnamed(lacks)))
        };
        let (all, means) = (column(all), column(means));
        (&all - &means).norm() / all.norm()
    }

    #[test]
    fn a_lag_in_means_is_that_of_all_rows() {
        const ROWS: usize = 30_000;
        let case = case(ROWS, 30.0);
        let (design, fit) = fitted(&case);
        let coarse = Coarse::of(&design, &fit);
        let seen = coarse.design();
        assert!(seen.case.rows <= 2 * PIECES * design.blocks.len());
        assert_eq!(seen.blocks.len(), design.blocks.len());
        assert_eq!(seen.spread(&vec![1.0; seen.case.rows]).len(), ROWS);
        // The quickest that is looked for: half a block.
        let tau = 0.5 * design.blocks[0].len() as f64;
        let models = [
            FittedModel::new(&design, &fit),
            FittedModel::new(&seen, &coarse.fit),
        ];
        assert!(lag_is_off(models.each_ref(), tau) < 0.01);
    }

    #[test]
    fn a_lag_over_rows_between_blocks_is_that_of_all_rows() {
        const ROWS: usize = 60_000;
        let case = case(ROWS, 2000.0);
        let (design, fit) = fitted(&case);
        let coarse = Coarse::of(&design, &fit);
        let seen = coarse.design();
        let (block, within) = (
            design.blocks[0].len(),
            design.blocks.iter().flatten().count(),
        );
        assert!(2 * within < ROWS, "{within}");
        // Fewer means than of equal length all over.
        let pieces_within = seen.blocks.iter().flatten().count();
        assert!(seen.case.rows * within < pieces_within * ROWS * 3 / 4);
        let models = [
            FittedModel::new(&design, &fit),
            FittedModel::new(&seen, &coarse.fit),
        ];
        let interval = models[1].clock.interval / models[0].clock.interval;
        assert!(
            (interval - (block / PIECES) as f64).abs() < 1e-9,
            "{interval}"
        );
        for blocks in [0.5, 2.0, 10.0, 100.0] {
            let off = lag_is_off(models.each_ref(), blocks * block as f64);
            assert!(off < 0.01, "{blocks}: {off}");
        }
    }

    #[test]
    fn a_short_recording_is_as_it_is() {
        let case = case(500, 30.0);
        let (design, fit) = fitted(&case);
        let coarse = Coarse::of(&design, &fit);
        let seen = coarse.design();
        assert_eq!(seen.blocks, design.blocks);
        assert_eq!(coarse.fit.linear.slopes, fit.linear.slopes);
        assert_eq!(seen.recorded(7), 7..8);
    }

    #[test]
    fn memory_is_told_from_rows_and_blocks() {
        let gib = |case: &Case| case.bytes() as f64 / (1_u64 << 30) as f64;
        assert!(gib(&case(20_000, 30.0)) < 1.0);
        let mut each = case(20_000, 30.0);
        each.averaging.blocks = super::super::case::Blocks::Rows;
        assert!(gib(&each) > 8.0);
        let refused = super::super::diagnose(&each, &|_| std::ops::ControlFlow::Continue(()));
        let why = refused.unwrap_err();
        assert_eq!(why.code().unwrap().id, "D0114");
    }
}
