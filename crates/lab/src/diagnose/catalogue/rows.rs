//! Single rows: wrong readings, rows in exchanged order, rows with the wrong sign.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use super::building::{added, cell, on_output, plain, slip};
use super::fitted::{FittedModel, Node};
use super::levels::{Factor, factors};
use super::modifiers::{known, map};
use super::{Cell, EffectId, Modifier, Term, Variation, tied};

/// Longer recordings are not searched row by row.
const MOST: usize = 800;
/// Rows that are told by less than this share of themselves hold a parameter alone.
const UNDETERMINED: f64 = 1e-6;
/// A reading that is shown one step off lies no further from what it should be, in steps: half of one is rounded.
const ONE_OFF: f64 = 1.5;
/// Rows among which any two may be exchanged.
const WORST: usize = 6;

/// Cells of single rows; where rows are averaged, of single means.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let blocks = &fitted.design.blocks;
    if blocks.len() > MOST || blocks.len() < 5 {
        return Vec::new();
    }
    let named = |rows: &[usize]| fitted.design.called(rows[0], rows[rows.len() - 1]);
    let responses = 0..fitted.case().responses.len();
    let steps: Vec<Option<f64>> = responses.map(|of| fitted.design.resolution(of)).collect();
    // One step of a display more or less is rounding.
    let is_far = |(block, _): &(usize, &Vec<usize>)| {
        steps.iter().enumerate().any(|(response, step)| {
            let left = fitted.fit.residuals[response * blocks.len() + block];
            step.is_none_or(|step| left.abs() > ONE_OFF * step)
        })
    };
    let outliers = (blocks.iter().enumerate()).filter(is_far).map(|(_, rows)| {
        let terms = (0..fitted.case().responses.len()).map(|response| {
            let mut modifier = vec![0.0; fitted.rows()];
            for row in rows {
                modifier[*row] = 1.0;
            }
            let text = format!("[{}]", named(rows));
            on_output(Modifier::number(modifier, text)).on(response)
        });
        Variation::of(named(rows), terms.collect())
    });
    let outliers: Vec<Variation> = outliers.collect();
    let mut cells = Vec::new();
    if !outliers.is_empty() {
        cells.push(plain(fitted, EffectId::Outlier, "row", outliers));
    }
    if blocks.len() == fitted.rows() && fitted.has_signal() && blocks.len() <= MOST / 2 {
        cells.extend(swapped(fitted));
        cells.push(reversed(fitted));
    }
    cells
}

/// Rows with each other's output: successive ones, and among those that agree worst with the others any two.
fn swapped(fitted: &FittedModel<'_>) -> Option<Cell> {
    let deleted = Deleted::new(fitted);
    let rows = fitted.rows();
    let mut pairs: BTreeSet<[usize; 2]> = (1..rows).map(|row| [row - 1, row]).collect();
    let worst = deleted.worst();
    let of_worst = worst.iter().flat_map(|a| worst.iter().map(|b| [*a, *b]));
    pairs.extend(of_worst.filter(|[a, b]| a < b));
    let variants = pairs.into_iter().map(|pair| {
        let [first, second] = pair;
        let label = format!("rows {} and {}", first + 1, second + 1);
        let model = deleted.model(&pair);
        let terms = model.iter().enumerate().map(|(response, model)| {
            let step = model[1] - model[0];
            let mut modifier = vec![0.0; rows];
            modifier[first] = step;
            modifier[second] = -step;
            added(fitted, response, modifier, format!("exchange of {label}"))
        });
        // All responses of a row are exchanged together: one coefficient.
        Variation::of(label.clone(), tied(terms.collect()))
    });
    slip(fitted, EffectId::Swapped, variants.collect())
}

/// The model fitted without single rows, which may have bent the fit; all rows alike.
struct Deleted<'g, 'f> {
    fitted: &'g FittedModel<'f>,
    /// What the parameters take up of the residuals, where rows had weights.
    taken: DVector<f64>,
}

impl<'g, 'f> Deleted<'g, 'f> {
    fn new(fitted: &'g FittedModel<'f>) -> Self {
        let taken = fitted.fit.residuals.map(known) - &fitted.absorbed().left;
        Deleted { fitted, taken }
    }

    fn places(&self, rows: &[usize]) -> Vec<usize> {
        let responses = self.fitted.case().responses.len();
        let of = |response| (rows.iter()).map(move |row| response * self.fitted.rows() + row);
        (0..responses).flat_map(of).collect()
    }

    /// How far some observations bend the fit where they stand: H(1 − H)⁻¹r with their residuals r and their block
    /// H of the hat matrix.
    fn bent(&self, places: &[usize]) -> DVector<f64> {
        let absorbed = self.fitted.absorbed();
        let hat = absorbed.hat(places);
        let left = DMatrix::identity(places.len(), places.len()) - &hat;
        // Rows without which a parameter is not determined say nothing of themselves.
        let determined = left.symmetric_eigenvalues().min() > UNDETERMINED;
        let residuals = absorbed.left.select_rows(places);
        let solved = determined.then(|| left.lu().solve(&residuals)).flatten();
        solved.map_or_else(|| DVector::zeros(places.len()), |solved| hat * solved)
    }

    /// What the model gives for some rows if it is fitted without them, by response.
    fn model(&self, rows: &[usize]) -> Vec<Vec<f64>> {
        let places = self.places(rows);
        let bent = self.bent(&places);
        let values = places.iter().zip(&bent).map(|(place, bent)| {
            let (response, row) = (place / self.fitted.rows(), place % self.fitted.rows());
            self.fitted.fit.linear.values[response][row] + self.taken[*place] - bent
        });
        let values: Vec<f64> = values.collect();
        values.chunks(rows.len()).map(<[f64]>::to_vec).collect()
    }

    /// The rows that are farthest from what the others say, ascending.
    fn worst(&self) -> Vec<usize> {
        let rows = self.fitted.rows();
        let mut squares = vec![0.0; rows];
        let distances = (0..rows).map(|row| {
            let places = self.places(&[row]);
            self.fitted.absorbed().left.select_rows(&places) + self.bent(&places)
        });
        let distances: Vec<DVector<f64>> = distances.collect();
        for response in 0..self.fitted.case().responses.len() {
            let own = || distances.iter().map(|of| of[response] * of[response]);
            let whole: f64 = own().sum();
            for (square, d) in squares.iter_mut().zip(own()).filter(|_| whole > 0.0) {
                *square += d / whole;
            }
        }
        let mut order: Vec<usize> = (0..rows).filter(|row| squares[*row] > 0.0).collect();
        order.sort_by(|a, b| squares[*b].total_cmp(&squares[*a]));
        order.truncate(WORST);
        order.sort_unstable();
        order
    }
}

/// Labels for which the whole signal may have the wrong sign.
fn reversed(fitted: &FittedModel<'_>) -> Cell {
    let of = |factor: Factor<'_>| -> Vec<Variation> {
        let turned = |level: &u32| {
            let label = format!("{} {}", factor.column.name, factor.text(*level));
            let turned = map(&factor.indicator(*level), |x| -2.0 * x);
            let modifier = Modifier::number(turned, format!("-2*[{label}]"));
            Variation::one(label, Term::new(Node::Gain, modifier))
        };
        factor.levels.iter().map(turned).collect()
    };
    let variants = factors(fitted, (2, 3)).flat_map(of).collect();
    cell(fitted, EffectId::Polarity, Node::Gain, "level", variants)
}
