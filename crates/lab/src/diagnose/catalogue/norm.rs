//! Models that are the length of a vector of readings, held against a magnitude that is recorded or known: a triad in a
//! field, or at rest. Each reading is an output of its own; what disturbs an offset or a scale disturbs that of one of them, or of all.

use gumption_core::least_squares::singular;
use nalgebra::{DMatrix, DVector};

use super::building::scoped_label;
use super::effect::{Kind, Pattern};
use super::fitted::{FittedModel, Node};
use super::modifiers::{map2, range, rounded};
use super::{Cell, Term, Variation};

/// The readings of a vector.
pub(in crate::diagnose) struct Norm {
    /// Columns, each with the value at which its component is nothing.
    readings: Vec<(usize, f64)>,
}

impl Norm {
    /// Where the response has the first degree in readings less a centre (Euler: Σ xᵢ·∂f/∂xᵢ = f) with slopes that turn.
    pub(in crate::diagnose) fn of(fitted: &FittedModel<'_>) -> Option<Norm> {
        /// What rounding leaves of the response.
        const ROUNDING: f64 = 1e-6;
        if fitted.case().responses.len() != 1 {
            return None;
        }
        let columns = fitted.numeric().into_iter();
        let columns: Vec<usize> = columns.filter(|c| fitted.in_model(*c)).collect();
        let slopes: Vec<Vec<f64>> = (columns.iter())
            .map(|column| fitted.slope(Node::Column(*column), 0))
            .collect();
        let turns = |slope: &Vec<f64>| {
            let (least, most) = range(slope);
            least < 0.0 && most > 0.0
        };
        if columns.len() < 2 || !slopes.iter().all(turns) {
            return None;
        }
        let response = DVector::from_column_slice(&fitted.fit.linear.values[0]);
        let mut sum = -&response;
        for (column, slope) in columns.iter().zip(&slopes) {
            sum += DVector::from_vec(map2(fitted.numbers(*column), slope, |x, s| x * s));
        }
        let slopes: Vec<DVector<f64>> = slopes.into_iter().map(DVector::from_vec).collect();
        let slopes = DMatrix::from_columns(&slopes);
        let centres = singular(slopes.clone())?.solve(&sum, ROUNDING).ok()?;
        let left = &slopes * &centres - sum;
        let is_norm = left.norm() <= ROUNDING * response.norm();
        let centre = |(column, centre): (usize, &f64)| {
            let (least, most) = range(fitted.numbers(column));
            (column, rounded(*centre, 1e-4 * (most - least)))
        };
        is_norm.then(|| Norm {
            readings: columns.into_iter().zip(&centres).map(centre).collect(),
        })
    }

    /// How far errors of the readings that stay the same from row to row are the same in the response: for each two rows the
    /// cosine of the angle between their slopes. A vector that is turned takes an error of a reading up in another way.
    pub(in crate::diagnose) fn in_common(&self, fitted: &FittedModel<'_>) -> DMatrix<f64> {
        let slope = |(column, _): &(usize, f64)| {
            let slope = fitted.slope(Node::Column(*column), 0);
            DVector::from_vec(fitted.design.reduced(&slope))
        };
        let slopes: Vec<DVector<f64>> = self.readings.iter().map(slope).collect();
        let mut slopes = DMatrix::from_columns(&slopes);
        for mut row in slopes.row_iter_mut() {
            let length = row.norm();
            if length > 0.0 {
                row /= length;
            }
        }
        &slopes * slopes.transpose()
    }

    /// Lets effects on the offset and the scale act on the readings as well. Where the length should be a constant, an offset of
    /// all of it is what its scale is.
    pub(super) fn spread(&self, fitted: &FittedModel<'_>, cells: &mut [Cell]) {
        // A wrong row is wrong whichever reading it was, and so is what only looks like a wave.
        let is_alike =
            |cell: &Cell| matches!(cell.effect.pattern, Some(Pattern::Row | Pattern::Wave));
        let physics = |cell: &&mut Cell| cell.effect.kind == Kind::Physics && !is_alike(cell);
        for cell in cells.iter_mut().filter(physics) {
            let variants = cell.variants.iter();
            let more: Vec<Variation> = variants.flat_map(|v| self.on_readings(fitted, v)).collect();
            let is_offset = |term: &Term| {
                term.node == Node::Output
                    && fitted.design.over_constant(&fitted.fit.linear, 0).is_some()
            };
            if !more.is_empty() {
                (cell.variants).retain(|variation| !variation.terms.iter().all(is_offset));
            }
            cell.variants.extend(more);
        }
    }

    /// A variation on each of the readings, and on all of them with a size for each.
    fn on_readings(&self, fitted: &FittedModel<'_>, variation: &Variation) -> Vec<Variation> {
        let is_plain = |term: &Term| matches!(term.node, Node::Output | Node::Gain) && !term.tied;
        if variation.spectrum.is_some() || !variation.terms.iter().all(is_plain) {
            return Vec::new();
        }
        let on = |(column, centre): &(usize, f64)| -> Vec<Term> {
            let reading = || fitted.by(*column, fitted.less(*column, *centre), |x| x - centre);
            let term = |term: &Term| {
                let own = term.written();
                let modifier = match term.node {
                    Node::Gain => own.times(&reading()),
                    _ => own.clone(),
                };
                Term::new(Node::Column(*column), modifier)
            };
            variation.terms.iter().map(term).collect()
        };
        let with = |name: &str, terms: Vec<Term>| Variation {
            label: scoped_label(name, variation),
            terms,
            ..variation.clone()
        };
        let each = self.readings.iter();
        let singles = each.clone().map(|one| with(fitted.label(one.0), on(one)));
        let all = with("all", each.clone().flat_map(on).collect());
        singles.chain([all]).collect()
    }
}
