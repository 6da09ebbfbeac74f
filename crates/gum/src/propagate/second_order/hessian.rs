//! The second derivatives H of a measurand whose inputs meet in intermediates, and what follows from them and the covariance C
//! of the inputs: ½ tr(HC), ½ tr(HCHC) and (HCH)_ii. No sum runs over all pairs of inputs.

use nalgebra::DMatrix;

use super::bordered::{Bordered, dot};
use super::spread::Spread;
use gumption_core::model::Neighbours;

/// The Hessian of f: A + B S + SᵀBᵀ + SᵀM S = A + U W Uᵀ with U = (B, Sᵀ).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hessian {
    /// Per input those inputs that A joins it with.
    pub near: Neighbours,
    /// A, B and M.
    pub whole: Bordered,
    /// S: per intermediate its derivatives.
    pub intermediates: Vec<Vec<f64>>,
}

impl Hessian {
    /// How many numbers it consists of, about.
    pub(super) fn numbers(&self) -> usize {
        2 * self.near.pairs() + (2 * self.intermediates.len() + 1) * self.near.inputs()
    }

    /// The second derivative along one unit of an input.
    pub(super) fn along(&self, input: usize) -> f64 {
        self.whole.along(&self.near, input, &self.intermediates)
    }

    /// The Hessian among inputs with a covariance C.
    pub(super) fn over<'a>(&'a self, spread: &'a Spread<'a>) -> Over<'a> {
        let r = self.intermediates.len();
        let Bordered { border, corner, .. } = &self.whole;
        let u: Vec<&Vec<f64>> = border.iter().chain(&self.intermediates).collect();
        let mut w = DMatrix::zeros(2 * r, 2 * r);
        w.view_mut((0, r), (r, r)).fill_with_identity();
        w.view_mut((r, 0), (r, r)).fill_with_identity();
        w.view_mut((r, r), (r, r)).copy_from(corner);
        let cu: Vec<Vec<f64>> = u.iter().map(|u| spread.times(u)).collect();
        let acu: Vec<Vec<f64>> = cu
            .iter()
            .map(|cu| self.whole.times_few(&self.near, cu))
            .collect();
        let ucu = DMatrix::from_fn(2 * r, 2 * r, |a, b| dot(u[a], &cu[b]));
        let ucacu = DMatrix::from_fn(2 * r, 2 * r, |a, b| dot(&cu[a], &acu[b]));
        Over {
            wucu: &w * ucu,
            mixed: (&w * ucacu).trace(),
            hessian: self,
            spread,
            u,
            w,
            acu,
        }
    }
}

/// H = A + U W Uᵀ among inputs with the covariance C.
pub(super) struct Over<'a> {
    hessian: &'a Hessian,
    spread: &'a Spread<'a>,
    u: Vec<&'a Vec<f64>>,
    w: DMatrix<f64>,
    /// A C U, per column.
    acu: Vec<Vec<f64>>,
    /// W UᵀC U.
    wucu: DMatrix<f64>,
    /// tr(W UᵀC A C U).
    mixed: f64,
}

impl Over<'_> {
    /// ½ tr(HC).
    pub(super) fn shift(&self) -> f64 {
        let Hessian { near, whole, .. } = self.hessian;
        0.5 * (self.spread.trace(near, &whole.few) + self.wucu.trace())
    }

    /// ½ tr(HCHC), and what the fourth moments of components that stand alone add to it.
    pub(super) fn curvature(&self) -> f64 {
        let Hessian { near, whole, .. } = self.hessian;
        let few = self.spread.trace_of_square(near, &whole.few);
        let square = few + 2.0 * self.mixed + (&self.wucu * &self.wucu).trace();
        let own = self.spread.own_moments().iter();
        let fourth = own.map(|&(input, share, moments)| {
            let h = share * share * self.hessian.along(input);
            0.25 * h * h * (moments.fourth - 3.0)
        });
        not_below_zero(0.5 * square + fourth.sum::<f64>())
    }

    /// Per input (HCH)_ii.
    pub(super) fn slopes(&self) -> Vec<f64> {
        let Hessian { near, whole, .. } = self.hessian;
        let around = &self.wucu * &self.w;
        let columns = || 0..self.u.len();
        let slope = |i: usize| {
            let mut square = self.spread.around(near.of(i), &whole.few[near.places(i)]);
            for a in columns() {
                for b in columns() {
                    let (acu, u) = (self.acu[a][i], self.u[a][i]);
                    square += (2.0 * acu * self.w[(a, b)] + u * around[(a, b)]) * self.u[b][i];
                }
            }
            not_below_zero(square)
        };
        (0..near.inputs()).map(slope).collect()
    }
}

/// A sum of squares, which rounding may have taken below zero; what is not a number stays so.
fn not_below_zero(sum: f64) -> f64 {
    sum.clamp(0.0, f64::INFINITY)
}
