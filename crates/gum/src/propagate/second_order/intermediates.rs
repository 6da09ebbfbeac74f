//! Second-order terms of a formula in which many inputs meet in few values, its intermediates ([`Cut`]).
//!
//! With x and the intermediates s as variables of their own, L(x, s) = f(x, s) + Σ_k λ_k (s_k(x, s) − s_k) has the
//! derivatives of f(x, s(x)) where λ_k = ∂f/∂s_k: the first ones with respect to s vanish then. Along a direction
//! d of the inputs, with w = (d, S d), S = ds/dx, and s″ the second derivatives of the intermediates, therefore
//!
//! - D²f[d, d] = D²L[w, w]
//! - D³f[d, e, g] = D³L[w_d, w_e, w_g] + D²L[w_d, s″_eg] + D²L[w_e, s″_dg] + D²L[w_g, s″_de],
//!
//! and D²L is a matrix A with few entries, bordered by a row B_k and column for each intermediate, with M where these
//! cross. The Hessian of f is A + B S + SᵀBᵀ + SᵀM S = A + U W Uᵀ with U = (B, Sᵀ): the traces of its products with
//! the covariance of the inputs need no sum over all pairs of them.
//!
//! Inputs are measured in their standard uncertainties, f in u(y), and intermediates in theirs, so that C is a correlation
//! matrix and all numbers are of one size.

use std::ops::Range;

use nalgebra::DMatrix;

use super::bordered::{Bordered, Lifted, add_scaled, dot};
use super::hessian::Hessian;
use super::sparse::sweeps;
use super::spread::Spread;
use super::sums::{SecondOrderOutcome, Sums, unit};
use crate::budget::Budget;
use crate::propagate::gum::Linear;
use gumption_core::model::{Cut, Neighbours};

/// Most numbers that the Hessians of all measurands are kept with.
const MOST_NUMBERS: usize = 1 << 24;

/// The outcomes of all measurands when some inputs change, where components are not shared between inputs and
/// intermediates are few.
pub(super) fn outcomes(
    budget: &Budget,
    linear: &Linear,
    changing: &[bool],
) -> Option<Vec<SecondOrderOutcome>> {
    let spread = Spread::new(budget, linear, changing)?;
    let outcome = |output: usize| {
        let measurand = linear.measurands.get(output)?;
        let unit = unit(measurand.u);
        let cut = budget.model.cut(output)?;
        let at_intermediates = AtIntermediates::new(&cut, &linear.x, &spread, unit)?;
        let mut sums = Sums::new(measurand, unit, linear.x.len(), 0);
        at_intermediates.add_to(&mut sums);
        let outcome = sums.outcome(unit);
        // One input at which a derivative does not exist spoils what the others do.
        let usable = outcome.shift.is_finite() && outcome.curvature.is_finite();
        let small = at_intermediates.hessian.numbers() <= MOST_NUMBERS / linear.measurands.len();
        Some(SecondOrderOutcome {
            hessian: (usable && small).then_some(at_intermediates.hessian),
            ..outcome
        })
    };
    (0..linear.measurands.len()).map(outcome).collect()
}

/// The derivatives of L and of the intermediates at a point.
struct AtIntermediates<'a> {
    cut: &'a Cut<'a>,
    spread: &'a Spread<'a>,
    point: Vec<f64>,
    /// Units of x and s.
    scales: Vec<f64>,
    /// What f and the intermediates, in the units of the file, are multiplied with in L.
    weights: Vec<f64>,
    /// ∂f/∂x of f(x, s(x)).
    gradient: Vec<f64>,
    /// ∂s_k/∂s_j of the intermediates before.
    before: DMatrix<f64>,
    /// For each of x and s those with which it may have mixed derivatives.
    neighbours: Neighbours,
    /// Variables that move together, and then D³L[d, d, ·].
    sweeps: Vec<(Vec<usize>, Vec<f64>)>,
    /// Of f, by D²L and the derivatives of the intermediates.
    hessian: Hessian,
    /// Per intermediate D²s_k.
    parts: Vec<Bordered>,
}

/// Derivatives along a direction.
struct Sweep {
    /// D²L[d, ·]
    whole: Vec<f64>,
    /// Per intermediate D²s_k[d, ·].
    parts: Vec<Vec<f64>>,
    /// D³L[d, d, ·]
    third: Vec<f64>,
}

impl<'a> AtIntermediates<'a> {
    fn new(cut: &'a Cut<'a>, x: &[f64], spread: &'a Spread<'a>, unit: f64) -> Option<Self> {
        let (n, r) = (cut.inputs(), cut.intermediates());
        let neighbours = cut.neighbours()?;
        let near = neighbours.clone().among_first(n);
        let mut at_intermediates = AtIntermediates {
            cut,
            spread,
            point: cut.point(x),
            scales: spread.scales().to_vec(),
            weights: vec![1.0 / unit],
            gradient: Vec::new(),
            before: DMatrix::zeros(r, r),
            neighbours,
            sweeps: Vec::new(),
            parts: vec![Bordered::zero(&near, r); r],
            hessian: Hessian {
                whole: Bordered::zero(&near, r),
                intermediates: Vec::new(),
                near,
            },
        };
        at_intermediates.find_first_derivatives();
        at_intermediates.find_second_derivatives();
        Some(at_intermediates)
    }

    fn find_first_derivatives(&mut self) {
        let (n, r) = (self.cut.inputs(), self.cut.intermediates());
        let gradients = self.cut.gradients(&self.point);
        let moving = self.moving();
        let intermediates = || (0..r).filter(|k| moving[*k]);
        // ∂f/∂s_k, also through the intermediates behind.
        let mut lambda = vec![0.0; r];
        for k in intermediates().rev() {
            lambda[k] += gradients[0][n + k] * self.weights[0];
            for j in intermediates().filter(|j| *j < k) {
                lambda[j] += lambda[k] * gradients[k + 1][n + j];
            }
        }
        for k in 0..r {
            if !moving[k] {
                self.hessian.intermediates.push(vec![0.0; n]);
                self.scales.push(0.0);
                continue;
            }
            let mut slopes = self.in_units(gradients[k + 1][..n].to_vec());
            for j in intermediates().filter(|j| *j < k) {
                let slope = gradients[k + 1][n + j] * self.scales[n + j];
                self.before[(k, j)] = slope;
                add_scaled(&mut slopes, slope, &self.hessian.intermediates[j]);
            }
            // A intermediate that does not move to first order is measured by what it does to f.
            let sizes = [self.spread.deviation(&slopes), 1.0 / lambda[k].abs()];
            let scale = sizes
                .into_iter()
                .find(|size| size.is_normal())
                .unwrap_or(1.0);
            slopes.iter_mut().for_each(|slope| *slope /= scale);
            self.before
                .row_mut(k)
                .iter_mut()
                .for_each(|slope| *slope /= scale);
            self.hessian.intermediates.push(slopes);
            self.scales.push(scale);
        }
        self.gradient = self.in_units(gradients[0][..n].to_vec());
        for k in intermediates() {
            let slope = gradients[0][n + k] * self.scales[n + k];
            add_scaled(&mut self.gradient, slope, &self.hessian.intermediates[k]);
        }
        self.gradient.iter_mut().for_each(|g| *g *= self.weights[0]);
        self.weights.append(&mut lambda);
    }

    /// Which intermediates an input moves. One without a value is in a branch that is not taken.
    fn moving(&self) -> Vec<bool> {
        let mut moves: Vec<bool> = self.scales.iter().map(|scale| *scale > 0.0).collect();
        let n = moves.len();
        for k in 0..self.cut.intermediates() {
            let moved = self.cut.made_of(k).any(|place| moves[place]);
            moves.push(moved && self.point[n + k].is_finite());
        }
        moves.split_off(n)
    }

    fn find_second_derivatives(&mut self) {
        for places in self.moving_together() {
            let sweep = self.sweep(&self.ones(&places));
            let near = &self.hessian.near;
            let whole = std::iter::once((&mut self.hessian.whole, &sweep.whole));
            for (matrix, column) in whole.chain(self.parts.iter_mut().zip(&sweep.parts)) {
                matrix.set(near, &self.neighbours, &places, column);
            }
            self.sweeps.push((places, sweep.third));
        }
    }

    /// Variables whose columns of D²L are found together, as [`Bordered::set`] takes them. A intermediate may be a neighbour of
    /// two inputs that move together: its entries are taken from its own column.
    fn moving_together(&self) -> Vec<Vec<usize>> {
        let n = self.cut.inputs();
        let moved = |places: Range<usize>| places.filter(|place| self.scales[*place] > 0.0);
        let mut together = sweeps(moved(0..n), &self.hessian.near);
        let mut met = vec![false; self.scales.len()];
        for intermediate in moved(n..self.scales.len()) {
            let near = self.neighbours.of(intermediate);
            near.iter().for_each(|place| met[*place] = true);
            let meets = |place: &usize| self.neighbours.of(*place).iter().any(|near| met[*near]);
            match together.iter_mut().find(|sweep| !sweep.iter().any(meets)) {
                Some(sweep) => sweep.push(intermediate),
                None => together.push(vec![intermediate]),
            }
            near.iter().for_each(|place| met[*place] = false);
        }
        together
    }

    fn sweep(&self, direction: &[f64]) -> Sweep {
        let mut all = self.cut.along(&self.point, &self.moved(direction));
        let mut whole = vec![0.0; self.scales.len()];
        let mut third = whole.clone();
        // Where a weight is zero, derivatives need not exist.
        let weighted = self.weights.iter().zip(&all);
        for (weight, along) in weighted.filter(|(weight, _)| **weight != 0.0) {
            add_scaled(&mut whole, *weight, &along.second);
            add_scaled(&mut third, *weight, &along.third);
        }
        let intermediates = all.drain(1..).zip(&self.scales[self.cut.inputs()..]);
        let part = |second: Vec<f64>, scale: f64| {
            if scale == 0.0 {
                return vec![0.0; second.len()];
            }
            let mut part = self.in_units(second);
            part.iter_mut().for_each(|entry| *entry /= scale);
            part
        };
        Sweep {
            parts: intermediates
                .map(|(along, scale)| part(along.second, *scale))
                .collect(),
            whole: self.in_units(whole),
            third: self.in_units(third),
        }
    }

    /// D³L[d, d, ·].
    fn third(&self, direction: &[f64]) -> Vec<f64> {
        let moved = self.moved(direction);
        self.in_units(self.cut.third_along(&self.point, &moved, &self.weights))
    }

    /// A direction in the units of the file.
    fn moved(&self, direction: &[f64]) -> Vec<f64> {
        let pairs = direction.iter().zip(&self.scales);
        pairs.map(|(d, scale)| d * scale).collect()
    }

    /// Derivatives with respect to variables in units of the file; none, also of infinite ones, where nothing moves.
    fn in_units(&self, mut derivatives: Vec<f64>) -> Vec<f64> {
        for (derivative, scale) in derivatives.iter_mut().zip(&self.scales) {
            *derivative = if *scale > 0.0 {
                *derivative * scale
            } else {
                0.0
            };
        }
        derivatives
    }

    /// One for these variables, zero for the others.
    fn ones(&self, places: &[usize]) -> Vec<f64> {
        let mut direction = vec![0.0; self.scales.len()];
        places.iter().for_each(|place| direction[*place] = 1.0);
        direction
    }

    /// Whether two variables may have mixed derivatives.
    fn are_near(&self, a: usize, b: usize) -> bool {
        self.neighbours.place(a, b).is_some()
    }

    /// (d, S d).
    fn lifted(&self, d: Vec<f64>) -> Vec<f64> {
        let along: Vec<f64> = self
            .hessian
            .intermediates
            .iter()
            .map(|intermediate| dot(intermediate, &d))
            .collect();
        d.into_iter().chain(along).collect()
    }

    /// Adds all terms of the second order to sums that are empty.
    fn add_to(&self, sums: &mut Sums) {
        let drift = self.drift();
        let mut thirds = self.sweeps.iter().flat_map(|(_, third)| third);
        let bends = |hessian: &Bordered| !hessian.is_zero();
        sums.nonlinear = bends(&self.hessian.whole)
            || self.parts.iter().any(bends)
            || thirds.any(|third| *third != 0.0)
            || drift != 0.0;
        let over = self.hessian.over(self.spread);
        sums.shift = over.shift();
        sums.curvature = over.curvature();
        let squares = over.slopes().into_iter().zip(self.spread.scales());
        let slope = |(square, scale): (f64, &f64)| {
            if *scale > 0.0 {
                square / (scale * scale)
            } else {
                0.0
            }
        };
        sums.slope = squares.map(slope).collect();
        sums.added = sums.curvature + drift + self.beyond_normal();
    }

    /// What third and fourth moments of components that stand alone add beside the curvature.
    fn beyond_normal(&self) -> f64 {
        let own = self.spread.own_moments();
        if own.is_empty() {
            return 0.0;
        }
        let thirds = Thirds::new(self);
        let terms = own.iter().map(|&(input, share, moments)| {
            let h = share * share * self.hessian.along(input);
            let g = share * self.gradient[input];
            let t = share.powi(3) * thirds.along(input);
            g * h * moments.third + g * t * (moments.fourth / 3.0 - 1.0)
        });
        terms.sum()
    }

    /// Σ_l D³f[v, d_l, d_l] over the coordinates l, with v = Σ_l g_l d_l = C ∂f/∂x.
    fn drift(&self) -> f64 {
        let (n, r) = (self.cut.inputs(), self.cut.intermediates());
        let lifted = Lifted::new(self.spread, &self.hessian.intermediates);
        let v = self.lifted(self.spread.times(&self.gradient));
        let resting = self.third(&v);
        // 2 D³L[v, d, ·] where D³L[d, d, ·] is known.
        let mixed = |d: &[f64], alone: &[f64]| -> Vec<f64> {
            let both: Vec<f64> = v.iter().zip(d).map(|(v, d)| v + d).collect();
            let others = resting.iter().zip(alone);
            let both = self.third(&both).into_iter().zip(others);
            both.map(|(both, (v, d))| both - v - d).collect()
        };
        let mut twice = Bordered::zero(&self.hessian.near, r);
        for (places, alone) in &self.sweeps {
            let column = mixed(&self.ones(places), alone);
            twice.set(&self.hessian.near, &self.neighbours, places, &column);
        }
        let moved = self.hessian.whole.times(&self.hessian.near, &v);
        let bent = self.through_intermediates(|part| lifted.trace(&self.hessian.near, part));
        let mut sum = 0.5 * lifted.trace(&self.hessian.near, &twice) + dot(&moved[n..], &bent);
        // s″_vl = q·w_l.
        let mut q: Vec<Vec<f64>> = Vec::with_capacity(r);
        for (k, part) in self.parts.iter().enumerate() {
            let mut own = part.times(&self.hessian.near, &v);
            for (j, earlier) in q.iter().enumerate() {
                add_scaled(&mut own, self.before[(k, j)], earlier);
            }
            let column = self
                .hessian
                .whole
                .times(&self.hessian.near, &self.ones(&[n + k]));
            sum += 2.0 * dot(&own, &lifted.times(&column));
            q.push(own);
        }
        sum
    }

    /// Second derivatives of the intermediates: what each has of its own, and what it has from those before.
    fn through_intermediates(&self, own: impl Fn(&Bordered) -> f64) -> Vec<f64> {
        let mut bent: Vec<f64> = Vec::with_capacity(self.parts.len());
        for (k, part) in self.parts.iter().enumerate() {
            let earlier = bent.iter().enumerate();
            let earlier: f64 = earlier.map(|(j, b)| self.before[(k, j)] * b).sum();
            bent.push(own(part) + earlier);
        }
        bent
    }
}

/// Third derivatives of L that decide D³f[d, d, d] for a direction of one input.
struct Thirds<'b, 'a> {
    of: &'b AtIntermediates<'a>,
    /// L_iii
    own: Vec<f64>,
    /// Per intermediate 3 L_iik.
    once: Vec<Vec<f64>>,
    /// L_·kk per intermediate, and 2 L_·kl per pair of intermediates that may have mixed derivatives.
    twice: Vec<(usize, usize, Vec<f64>)>,
}

impl<'b, 'a> Thirds<'b, 'a> {
    fn new(of: &'b AtIntermediates<'a>) -> Self {
        let (n, r) = (of.cut.inputs(), of.cut.intermediates());
        let mut own = vec![0.0; n];
        let mut alone = vec![vec![0.0; n + r]; r];
        for (places, third) in &of.sweeps {
            for &place in places {
                match place.checked_sub(n) {
                    None => own[place] = third[place],
                    Some(k) => {
                        let near = of.neighbours.of(place).iter();
                        near.for_each(|i| alone[k][*i] = third[*i]);
                    }
                }
            }
        }
        let mut once = vec![vec![0.0; n]; r];
        for (places, _) in &of.sweeps {
            for (k, intermediate) in alone.iter().enumerate() {
                let inputs = places.iter().copied().filter(|place| *place < n);
                let mut both: Vec<usize> = inputs.filter(|i| of.are_near(*i, n + k)).collect();
                if both.is_empty() {
                    continue;
                }
                both.push(n + k);
                let third = of.third(&of.ones(&both));
                for &i in both.iter().filter(|i| **i < n) {
                    once[k][i] = 1.5 * (third[i] - own[i] - intermediate[i]);
                }
            }
        }
        let mut twice = Vec::new();
        for k in 0..r {
            for l in (k + 1..r).filter(|l| of.are_near(n + k, n + l)) {
                let mut both = of.third(&of.ones(&[n + k, n + l]));
                add_scaled(&mut both, -1.0, &alone[k]);
                add_scaled(&mut both, -1.0, &alone[l]);
                twice.push((k, l, both));
            }
        }
        twice.extend(
            alone
                .into_iter()
                .enumerate()
                .map(|(k, intermediate)| (k, k, intermediate)),
        );
        Thirds {
            of,
            own,
            once,
            twice,
        }
    }

    /// D³f[d, d, d] for a step d of one unit of an input.
    fn along(&self, input: usize) -> f64 {
        let (n, intermediates) = (self.of.cut.inputs(), &self.of.hessian.intermediates);
        let step: Vec<f64> = intermediates
            .iter()
            .map(|intermediate| intermediate[input])
            .collect();
        let mut sum = self.own[input];
        for (once, step) in self.once.iter().zip(&step) {
            sum += once[input] * step;
        }
        for (k, l, pair) in &self.twice {
            sum += (3.0 * pair[input] + dot(&pair[n..], &step)) * step[*k] * step[*l];
        }
        let whole = &self.of.hessian.whole;
        let near = &self.of.hessian.near;
        let bent = self
            .of
            .through_intermediates(|part| part.along(near, input, intermediates));
        for (k, bent) in bent.iter().enumerate() {
            let corner: f64 = step
                .iter()
                .enumerate()
                .map(|(l, step)| whole.corner[(k, l)] * step)
                .sum();
            sum += 3.0 * bent * (whole.border[k][input] + corner);
        }
        sum
    }
}

#[cfg(test)]
mod tests;
