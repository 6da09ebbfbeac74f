//! Sums over pairs of directions, which the second-order terms are.

use super::direction::{Direction, Moments};
use super::hessian::Hessian;
use crate::propagate::gum::MeasurandForm;
use crate::propagate::result::SecondOrder;
use crate::propagate::validation::numerical_tolerance;
use gumption_core::model::{Along, Leaf};

/// What the second order says about one measurand.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::propagate) struct SecondOrderOutcome {
    pub terms: Terms,
    /// Standard deviation of the sensitivity coefficient c_i of each uncertain input over the uncertainties of all
    /// inputs.
    pub slope_deviation: Vec<f64>,
    /// ½ Σ h_kk.
    pub shift: f64,
    /// Root of Σ_k ¼ h_kk² (μ4 − 1) + Σ_{k<l} h_kl²: what the second derivatives alone add to u(y),
    /// in quadrature.
    pub curvature: f64,
    /// The second derivatives where they are at hand: what part of the inputs do follows from them.
    pub(super) hessian: Option<Hessian>,
}

impl SecondOrderOutcome {
    /// Of a measurand that is linear in all of so many inputs.
    pub(super) fn linear(inputs: usize) -> Self {
        SecondOrderOutcome {
            terms: Terms::Linear,
            slope_deviation: vec![0.0; inputs],
            shift: 0.0,
            curvature: 0.0,
            hessian: None,
        }
    }
}

/// The second-order terms of one measurand.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::propagate) enum Terms {
    /// The measurand is linear in all uncertain inputs.
    Linear,
    Found(SecondOrder),
    /// The terms leave no positive variance, or are not finite: the series does not converge within
    /// the uncertainties.
    Divergent,
}

/// Which directions share a sweep, and which meet in a block.
pub(super) struct Plan {
    /// Per block: (direction, input, change).
    steps: Vec<Vec<(usize, usize, f64)>>,
    /// Per direction: the blocks that it moves.
    moved: Vec<Vec<usize>>,
    /// Directions of each sweep, no two of which move the same block.
    pub(super) sweeps: Vec<Vec<usize>>,
}

impl Plan {
    /// Puts every direction into the first sweep after those of its neighbours so far.
    pub(super) fn new(directions: &[Direction], blocks: &[Option<usize>]) -> Self {
        let count = blocks.iter().flatten().max().map_or(0, |last| last + 1);
        let mut plan = Plan {
            steps: vec![Vec::new(); count],
            moved: Vec::with_capacity(directions.len()),
            sweeps: Vec::new(),
        };
        let mut next = vec![0; count];
        for (l, direction) in directions.iter().enumerate() {
            let mut moved = Vec::with_capacity(1);
            for &(input, change) in &direction.steps {
                if let Some(block) = blocks[input] {
                    plan.steps[block].push((l, input, change));
                    moved.push(block);
                }
            }
            moved.sort_unstable();
            moved.dedup();
            let sweep = moved.iter().map(|block| next[*block]).max().unwrap_or(0);
            for block in &moved {
                next[*block] = sweep + 1;
            }
            if sweep == plan.sweeps.len() {
                plan.sweeps.push(Vec::new());
            }
            plan.sweeps[sweep].push(l);
            plan.moved.push(moved);
        }
        plan
    }
}

/// Sums while they grow.
pub(super) struct Sums {
    g: Vec<f64>,
    pub(super) shift: f64,
    pub(super) added: f64,
    pub(super) curvature: f64,
    pub(super) nonlinear: bool,
    pub(super) slope: Vec<f64>,
    /// h_kl and t_kll of the directions k that meet the current one, else zero.
    met: Vec<[f64; 2]>,
}

impl Sums {
    /// Nothing added yet.
    pub(super) fn new(
        measurand: &MeasurandForm,
        unit: f64,
        inputs: usize,
        directions: usize,
    ) -> Self {
        Sums {
            g: measurand.standard.iter().map(|g| g / unit).collect(),
            shift: 0.0,
            added: 0.0,
            curvature: 0.0,
            nonlinear: false,
            slope: vec![0.0; inputs],
            met: vec![[0.0; 2]; directions],
        }
    }

    /// Adds all terms in which an input that is used once is the second index.
    pub(super) fn add_leaf(&mut self, leaf: &Leaf, direction: &Direction) {
        let Moments { third, fourth } = direction.moments;
        let change = direction.steps.first().map_or(0.0, |(_, change)| *change);
        let variance = change * change;
        let (g, h, t) = (
            leaf.slope * change,
            leaf.second * variance,
            leaf.third * variance * change,
        );
        let curvature = 0.25 * h * h * (fourth - 1.0);
        // Σ h_kl² and Σ g_k t_kll over the other inputs.
        let mixed = variance * leaf.mixed;
        let drift = variance * leaf.drift - g * t;
        self.nonlinear |= h != 0.0 || t != 0.0 || mixed != 0.0 || drift != 0.0;
        self.shift += 0.5 * h;
        self.curvature += curvature + 0.5 * mixed;
        self.added += g * h * third + curvature + g * t * fourth / 3.0 + 0.5 * mixed + drift;
        self.slope[leaf.input] = leaf.second * leaf.second * variance + leaf.mixed;
    }

    /// Adds the terms in which direction `l` is the second index.
    pub(super) fn add(&mut self, l: usize, along: &Along, directions: &[Direction], plan: &Plan) {
        let meeting = || plan.moved[l].iter().flat_map(|block| &plan.steps[*block]);
        for &(k, input, change) in meeting() {
            let [h, t] = &mut self.met[k];
            *h += along.second[input] * change;
            *t += along.third[input] * change;
        }
        for &(k, ..) in meeting() {
            // A direction with several steps here is counted at the first.
            let terms = std::mem::take(&mut self.met[k]);
            self.add_terms(&directions[k], &directions[l], terms);
        }
    }

    /// Adds the terms of h_kl and t_kll.
    pub(super) fn add_terms(&mut self, k: &Direction, l: &Direction, [h, t]: [f64; 2]) {
        let g = self.g[k.coordinate];
        self.nonlinear |= h != 0.0 || t != 0.0;
        if k.coordinate == l.coordinate {
            let Moments { third, fourth } = l.moments;
            self.shift += 0.5 * h;
            let curvature = 0.25 * h * h * (fourth - 1.0);
            self.curvature += curvature;
            self.added += g * h * third + curvature + g * t * fourth / 3.0;
        } else {
            self.curvature += 0.5 * h * h;
            self.added += 0.5 * h * h + g * t;
        }
    }

    /// Adds one sweep to Σ_l (Σ_j f_ij d_j)²; each input moves with one direction of it at most.
    pub(super) fn add_slopes(&mut self, along: &Along) {
        for (sum, second) in self.slope.iter_mut().zip(&along.second) {
            *sum += second * second;
        }
    }

    /// Scaled so that squares neither overflow nor vanish: all sums are those of y/`unit`.
    pub(super) fn outcome(self, unit: f64) -> SecondOrderOutcome {
        let first: f64 = self.g.iter().map(|g| g * g).sum();
        let variance = first + self.added;
        let slope_deviation = self.slope.into_iter().map(|s| s.sqrt() * unit).collect();
        let terms = if !self.nonlinear {
            Terms::Linear
        } else if variance > 0.0 && variance.is_finite() && self.shift.is_finite() {
            let (u_first, u, shift) = (
                first.sqrt() * unit,
                variance.sqrt() * unit,
                self.shift * unit,
            );
            Terms::Found(SecondOrder {
                shift,
                u,
                matters: matters(u_first, u, shift),
            })
        } else {
            Terms::Divergent
        };
        SecondOrderOutcome {
            terms,
            slope_deviation,
            shift: self.shift * unit,
            curvature: self.curvature.sqrt() * unit,
            hessian: None,
        }
    }
}

/// What lengths are measured in: u(y) where it is usable.
pub(super) fn unit(u: f64) -> f64 {
    if u.is_normal() { u } else { 1.0 }
}

/// Whether the second order is seen in two significant digits of u(y).
pub(in crate::propagate) fn matters(u_first: f64, u_second: f64, shift: f64) -> bool {
    let delta = numerical_tolerance(u_second.max(u_first), 2);
    (u_second - u_first).abs() > delta || shift.abs() > delta
}
