//! Second-order terms: the shift of the estimate (JCGM 100:2008/Amd.1:2026) and the higher-order
//! terms of u²(y) (note to GUM 5.1.2).
//!
//! In standard coordinates z (uncorrelated, unit variance), y − f(x) is, to third order,
//! Σ g_k z_k + ½ Σ h_kl z_k z_l + ⅙ Σ t_klm z_k z_l z_m. With μ3, μ4 the third and fourth moments of
//! z_k, its expectation to second order is ½ Σ h_kk, and its variance, to fourth order in u,
//!
//! Σ g_k² + Σ_k \[g_k h_kk μ3 + ¼ h_kk² (μ4 − 1) + ⅓ g_k t_kkk μ4\] + Σ_{k<l} h_kl² + Σ_{k≠l} g_k t_kll.
//!
//! For normal components (μ3 = 0, μ4 = 3) that is the expression of the GUM,
//! Σ_ij \[½ f_ij² + f_i f_ijj\] u_i² u_j²; other components enter with their own moments. Members of a
//! correlated group are taken as jointly normal, and so is t, of which the GUM propagates u = s/√n
//! and not the standard deviation.
//!
//! The derivatives along one direction cost one sweep through the model. Directions that move
//! different blocks of inputs ([`crate::model::Model::interactions`]) share a sweep, and the sums
//! run only over directions that have a block in common: Σ xᵢ² takes one sweep for any number of
//! inputs. A formula that uses every input once, as x₁x₂…x_n, takes one pass, and one whose terms overlap
//! little, as x₁x₂ + x₂x₃ + …, a few sweeps ([`sparse`]); so does one in which many inputs meet in few values,
//! as in a standard deviation or a weighted mean, also where inputs correlate ([`hubs`]).

mod bordered;
mod hessian;
mod hubs;
mod sparse;
mod spread;

use hessian::Hessian;
use spread::Spread;

use super::SecondOrder;
use super::covariance::Covariance;
use super::gum::{Linear, MeasurandForm};
use super::validation::numerical_tolerance;
use crate::budget::{Budget, Component, Input};
use crate::distribution::Distribution;
use crate::model::{Along, Leaf};

/// Third and fourth standardised moment of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moments {
    pub third: f64,
    pub fourth: f64,
}

/// Those of the normal distribution.
pub(super) const NORMAL: Moments = Moments {
    third: 0.0,
    fourth: 3.0,
};

/// A unit step of one standard coordinate, in the space of the inputs.
#[derive(Debug, Clone)]
pub(super) struct Direction {
    pub coordinate: usize,
    /// (input, change).
    pub steps: Vec<(usize, f64)>,
    pub moments: Moments,
}

/// What the second order says about one measurand.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outcome {
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
    hessian: Option<Hessian>,
}

/// The second-order terms of one measurand.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Terms {
    /// The measurand is linear in all uncertain inputs.
    Linear,
    Found(SecondOrder),
    /// The terms leave no positive variance, or are not finite: the series does not converge within
    /// the uncertainties.
    Divergent,
}

/// Second-order terms of every measurand.
pub(super) fn evaluate(budget: &Budget, linear: &Linear) -> Vec<Outcome> {
    evaluate_over(budget, linear, &vec![true; linear.x.len()])
}

/// `shift` and `curvature` of one measurand when only the inputs marked in `changing` change, the others staying at
/// their estimates; `all` is its outcome when all change.
pub(super) fn among(
    budget: &Budget,
    linear: &Linear,
    measurand: usize,
    all: &Outcome,
    changing: &[bool],
) -> (f64, f64) {
    let known = all.hessian.as_ref().and_then(|hessian| {
        let spread = Spread::new(budget, linear, changing)?;
        let unit = unit(linear.measurands[measurand].u);
        let over = hessian.over(&spread);
        Some((over.shift() * unit, over.curvature().sqrt() * unit))
    });
    known.unwrap_or_else(|| {
        let outcome = &evaluate_over(budget, linear, changing)[measurand];
        (outcome.shift, outcome.curvature)
    })
}

/// Second-order terms when only the inputs marked in `changing` change.
fn evaluate_over(budget: &Budget, linear: &Linear, changing: &[bool]) -> Vec<Outcome> {
    let blocks = budget.model.interactions().into_iter().zip(changing);
    let blocks: Vec<Option<usize>> = blocks
        .map(|(block, changes)| block.filter(|_| *changes))
        .collect();
    let hubs = || hubs::outcomes(budget, linear, changing);
    // The coordinates of many correlated inputs move all of them: not even the directions are cheap.
    let bent = blocks.iter().any(Option::is_some);
    let correlated = bent && linear.covariance.largest_group() > MOST_SWEEPS;
    if correlated && let Some(outcomes) = hubs() {
        return outcomes;
    }
    let directions = directions(
        &linear.covariance,
        &budget.inputs,
        &budget.components,
        &blocks,
    );
    let plan = Plan::new(&directions, &blocks);
    let sweeps = plan.sweeps.len();
    let mut found = None;
    if sweeps > MANY_SWEEPS {
        found = single_use(budget, linear, &directions)
            .or_else(|| sparse::outcomes(budget, linear, &directions));
    }
    if found.is_none() && !correlated && sweeps > MOST_SWEEPS {
        found = hubs();
    }
    found.unwrap_or_else(|| {
        accumulate(linear, &directions, &plan, |direction| {
            budget.model.along(&linear.x, direction)
        })
    })
}

/// So many sweeps take the time of one pass through a formula that uses every input once.
const MANY_SWEEPS: usize = 3;

/// More sweeps take longer than a look for hubs, and what follows when there are few.
const MOST_SWEEPS: usize = 48;

/// Per input the direction that moves it, where each moves one input only.
fn movers(directions: &[Direction], inputs: usize) -> Option<Vec<Option<&Direction>>> {
    let mut movers: Vec<Option<&Direction>> = vec![None; inputs];
    for direction in directions {
        let [(input, _)] = direction.steps[..] else {
            return None;
        };
        if movers[input].replace(direction).is_some() {
            return None;
        }
    }
    Some(movers)
}

/// The same where inputs are independent and every measurand uses each of them once.
fn single_use(budget: &Budget, linear: &Linear, directions: &[Direction]) -> Option<Vec<Outcome>> {
    let mover = movers(directions, linear.x.len())?;
    let mut variances = vec![0.0; linear.x.len()];
    for &(input, change) in directions.iter().flat_map(|direction| &direction.steps) {
        variances[input] = change * change;
    }
    let outcome = |(output, measurand): (usize, &MeasurandForm)| {
        let unit = unit(measurand.u);
        let leaves = budget.model.leaves(&linear.x, output, &variances, unit)?;
        let mut sums = Sums::new(measurand, unit, linear.x.len(), 0);
        for leaf in leaves {
            if let Some(direction) = mover[leaf.input] {
                sums.add_leaf(&leaf, direction);
            }
        }
        Some(sums.outcome(unit))
    };
    linear.measurands.iter().enumerate().map(outcome).collect()
}

/// Second-order terms over the inputs that are in a block of interacting inputs, by sweeps for all of them.
#[cfg(test)]
fn over(budget: &Budget, linear: &Linear, blocks: &[Option<usize>]) -> Vec<Outcome> {
    let directions = directions(
        &linear.covariance,
        &budget.inputs,
        &budget.components,
        blocks,
    );
    let plan = Plan::new(&directions, blocks);
    accumulate(linear, &directions, &plan, |direction| {
        budget.model.along(&linear.x, direction)
    })
}

/// The directions in which one of the marked inputs changes.
fn directions(
    covariance: &Covariance,
    inputs: &[Input],
    components: &[Component],
    blocks: &[Option<usize>],
) -> Vec<Direction> {
    let mut steps: Vec<Vec<(usize, f64)>> = vec![Vec::new(); covariance.coordinates()];
    for (place, input) in inputs.iter().enumerate() {
        if blocks[place].is_none() {
            continue;
        }
        let form = covariance.form(input.terms.iter().map(|t| (t.component, t.coefficient)));
        for (coordinate, change) in covariance.standard(&form) {
            if change != 0.0 {
                steps[coordinate].push((place, change));
            }
        }
    }
    let alone = covariance.alone();
    steps
        .into_iter()
        .enumerate()
        .filter(|(_, steps)| !steps.is_empty())
        .map(|(coordinate, steps)| {
            let moments =
                alone[coordinate].map_or(NORMAL, |c| moments(&components[c].distribution));
            Direction {
                coordinate,
                steps,
                moments,
            }
        })
        .collect()
}

/// The moments with which a component enters.
fn moments(distribution: &Distribution) -> Moments {
    if matches!(distribution, Distribution::StudentT { .. }) {
        return NORMAL;
    }
    let of = |d: &Distribution| {
        let (sd, third, fourth) = (
            d.standard_deviation()?,
            d.third_central_moment()?,
            d.fourth_central_moment()?,
        );
        (sd > 0.0).then(|| Moments {
            third: third / sd.powi(3),
            fourth: fourth / sd.powi(4),
        })
    };
    of(distribution)
        .filter(|m| m.third.is_finite() && m.fourth.is_finite())
        .unwrap_or(NORMAL)
}

/// Which directions share a sweep, and which meet in a block.
struct Plan {
    /// Per block: (direction, input, change).
    steps: Vec<Vec<(usize, usize, f64)>>,
    /// Per direction: the blocks that it moves.
    moved: Vec<Vec<usize>>,
    /// Directions of each sweep, no two of which move the same block.
    sweeps: Vec<Vec<usize>>,
}

impl Plan {
    /// Puts every direction into the first sweep after those of its neighbours so far.
    fn new(directions: &[Direction], blocks: &[Option<usize>]) -> Self {
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
struct Sums {
    g: Vec<f64>,
    shift: f64,
    added: f64,
    curvature: f64,
    nonlinear: bool,
    slope: Vec<f64>,
    /// h_kl and t_kll of the directions k that meet the current one, else zero.
    met: Vec<[f64; 2]>,
}

impl Sums {
    /// Nothing added yet.
    fn new(measurand: &MeasurandForm, unit: f64, inputs: usize, directions: usize) -> Self {
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
    fn add_leaf(&mut self, leaf: &Leaf, direction: &Direction) {
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
    fn add(&mut self, l: usize, along: &Along, directions: &[Direction], plan: &Plan) {
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
    fn add_terms(&mut self, k: &Direction, l: &Direction, [h, t]: [f64; 2]) {
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
    fn add_slopes(&mut self, along: &Along) {
        for (sum, second) in self.slope.iter_mut().zip(&along.second) {
            *sum += second * second;
        }
    }

    /// Scaled so that squares neither overflow nor vanish: all sums are those of y/`unit`.
    fn outcome(self, unit: f64) -> Outcome {
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
        Outcome {
            terms,
            slope_deviation,
            shift: self.shift * unit,
            curvature: self.curvature.sqrt() * unit,
            hessian: None,
        }
    }
}

/// Runs through the sweeps; `along` gives the derivatives of all measurands along a direction.
fn accumulate(
    linear: &Linear,
    directions: &[Direction],
    plan: &Plan,
    mut along: impl FnMut(&[f64]) -> Vec<Along>,
) -> Vec<Outcome> {
    let units: Vec<f64> = linear.measurands.iter().map(|m| unit(m.u)).collect();
    let mut sums: Vec<Sums> = linear
        .measurands
        .iter()
        .zip(&units)
        .map(|(measurand, unit)| Sums::new(measurand, *unit, linear.x.len(), directions.len()))
        .collect();
    let mut whole = vec![0.0; linear.x.len()];
    for sweep in &plan.sweeps {
        let steps = || sweep.iter().flat_map(|l| &directions[*l].steps);
        steps().for_each(|&(input, change)| whole[input] = change);
        let all = along(&whole);
        steps().for_each(|&(input, _)| whole[input] = 0.0);
        for ((sums, mut along), unit) in sums.iter_mut().zip(all).zip(&units) {
            along.second.iter_mut().for_each(|s| *s /= unit);
            along.third.iter_mut().for_each(|t| *t /= unit);
            sums.add_slopes(&along);
            for &l in sweep {
                sums.add(l, &along, directions, plan);
            }
        }
    }
    sums.into_iter()
        .zip(units)
        .map(|(sums, unit)| sums.outcome(unit))
        .collect()
}

/// What lengths are measured in: u(y) where it is usable.
fn unit(u: f64) -> f64 {
    if u.is_normal() { u } else { 1.0 }
}

/// Whether the second order is seen in two significant digits of u(y).
pub(super) fn matters(u_first: f64, u_second: f64, shift: f64) -> bool {
    let delta = numerical_tolerance(u_second.max(u_first), 2);
    (u_second - u_first).abs() > delta || shift.abs() > delta
}

#[cfg(test)]
mod tests;
