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
//! little, as x₁x₂ + x₂x₃ + …, a few sweeps ([`sparse`]).

mod sparse;

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
    /// Standard deviation of each sensitivity coefficient c_i over the uncertainties of all inputs.
    pub slope_deviation: Vec<f64>,
    /// ½ Σ h_kk.
    pub shift: f64,
    /// Root of Σ_k ¼ h_kk² (μ4 − 1) + Σ_{k<l} h_kl²: what the second derivatives alone add to u(y),
    /// in quadrature.
    pub curvature: f64,
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
    let blocks = budget.model.interactions();
    let directions = directions(
        &linear.covariance,
        &budget.inputs,
        &budget.components,
        &blocks,
    );
    let plan = Plan::new(&directions, &blocks);
    if plan.sweeps.len() > MANY_SWEEPS
        && let Some(outcomes) = single_use(budget, linear, &directions)
            .or_else(|| sparse::outcomes(budget, linear, &directions))
    {
        return outcomes;
    }
    accumulate(linear, &directions, &plan, |direction| {
        budget.model.along(&linear.x, direction)
    })
}

/// So many sweeps take the time of one pass through a formula that uses every input once.
const MANY_SWEEPS: usize = 3;

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

/// Second-order terms when only the inputs marked in `changing` change, the others staying at their
/// estimates.
pub(super) fn evaluate_over(budget: &Budget, linear: &Linear, changing: &[bool]) -> Vec<Outcome> {
    let blocks = budget.model.interactions();
    let blocks: Vec<Option<usize>> = blocks
        .into_iter()
        .zip(changing)
        .map(|(block, changes)| block.filter(|_| *changes))
        .collect();
    over(budget, linear, &blocks)
}

/// Second-order terms over the inputs that are in a block of interacting inputs.
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
mod tests {
    use super::*;
    use crate::budget::{Group, Law, Term};
    use crate::quantity::Unit;
    use nalgebra::DMatrix;

    const INF: f64 = f64::INFINITY;

    fn input(component: usize) -> Input {
        Input {
            name: format!("x{component}"),
            description: None,
            group: None,
            unit: Unit::one(),
            estimate: 0.0,
            terms: vec![Term {
                component,
                coefficient: 1.0,
            }],
        }
    }

    /// One pass through a formula that uses every input once gives what sweeps give.
    #[test]
    fn a_formula_of_single_uses_by_both_ways() {
        for (model, nonlinear) in [
            ("a * b * c * d * e", true),
            ("a / (b + exp(c * d)) - e", true),
            ("sqrt(a^2 + b^2) * sin(c) + atan2(d, e)", true),
            ("(a - b)^3 * hypot(c, d)^1.5 / e", true),
            ("a + 2 * b - c + d - e", false),
        ] {
            let text = format!(
                "title = \"T\"\n[measurand.Y]\nmodel = \"{model}\"\n[input]\na = {{ value = 1.5, u = 0.1 }}\nb = {{ value = -0.7, half_width = 0.2 }}\nc = {{ value = 0.4, limits = [0, 1], distribution = \"triangular\" }}\nd = {{ value = 1.1, u = 0.05, dof = 5 }}\ne = {{ value = 2, u = 0.3 }}\n"
            );
            let loaded = crate::budget::read(&text, "t", std::path::Path::new("")).unwrap();
            let budget = &loaded.rows[0].budget;
            let linear = super::super::gum::linearise(budget).unwrap();
            let blocks = budget.model.interactions();
            let directions = directions(
                &linear.covariance,
                &budget.inputs,
                &budget.components,
                &blocks,
            );
            let swept = over(budget, &linear, &blocks).remove(0);
            let passed = single_use(budget, &linear, &directions).unwrap().remove(0);
            let near = |a: f64, b: f64| {
                assert!(
                    (a - b).abs() <= 1e-12 * (a.abs() + b.abs()),
                    "{model}: {a} {b}"
                )
            };
            near(swept.shift, passed.shift);
            near(swept.curvature, passed.curvature);
            for (a, b) in swept.slope_deviation.iter().zip(&passed.slope_deviation) {
                near(*a, *b);
            }
            match (swept.terms, passed.terms) {
                (Terms::Found(a), Terms::Found(b)) => near(a.u, b.u),
                (a, b) => assert_eq!((a, b, nonlinear), (Terms::Linear, Terms::Linear, false)),
            }
        }
    }

    /// y = g·d + ½ d'Hd + ⅙ Σ t_i d_i³ around the estimates.
    struct Cubic {
        g: Vec<f64>,
        h: DMatrix<f64>,
        t: Vec<f64>,
    }

    impl Cubic {
        fn outcome(&self, u: &[f64], groups: &[Group], of: impl Fn(usize) -> Moments) -> Outcome {
            self.outcome_in(u, groups, of, &vec![Some(0); self.g.len()])
                .0
        }

        /// The outcome, and how many sweeps it took.
        fn outcome_in(
            &self,
            u: &[f64],
            groups: &[Group],
            of: impl Fn(usize) -> Moments,
            blocks: &[Option<usize>],
        ) -> (Outcome, usize) {
            let n = self.g.len();
            let covariance = Covariance::from_parts(u.to_vec(), vec![INF; n], groups);
            let inputs: Vec<Input> = (0..n).map(input).collect();
            let gradient = DMatrix::from_row_slice(1, n, &self.g);
            let linear = Linear::new(vec![0.0; n], vec![0.0], gradient, covariance, &inputs);
            let mut steps = vec![Vec::new(); linear.covariance.coordinates()];
            for (i, input) in linear.inputs.iter().enumerate() {
                for (k, change) in linear.covariance.standard(&input.form) {
                    steps[k].push((i, change));
                }
            }
            let directions: Vec<Direction> = steps
                .into_iter()
                .enumerate()
                .map(|(coordinate, steps)| Direction {
                    coordinate,
                    steps,
                    moments: of(coordinate),
                })
                .collect();
            let along = |d: &[f64]| {
                let second = (0..n)
                    .map(|i| (0..n).map(|j| self.h[(i, j)] * d[j]).sum())
                    .collect();
                let third = (0..n).map(|i| self.t[i] * d[i] * d[i]).collect();
                vec![Along {
                    gradient: self.g.clone(),
                    second,
                    third,
                }]
            };
            let plan = Plan::new(&directions, blocks);
            let outcome = accumulate(&linear, &directions, &plan, along).remove(0);
            (outcome, plan.sweeps.len())
        }

        fn found(&self, u: &[f64], groups: &[Group], of: Moments) -> SecondOrder {
            match self.outcome(u, groups, |_| of).terms {
                Terms::Found(found) => found,
                other => panic!("{other:?}"),
            }
        }
    }

    fn close(a: f64, b: f64) {
        assert!((a / b - 1.0).abs() < 1e-12, "{a} is not {b}");
    }

    fn correlated(r: f64) -> [Group; 1] {
        let correlation = DMatrix::from_row_slice(2, 2, &[1.0, r, r, 1.0]);
        [Group {
            members: vec![0, 1],
            correlation,
            law: Law::Normal,
            dof: None,
        }]
    }

    #[test]
    fn s1_9_4_comparison_loss() {
        // x1² + x2² at 0 with u = 0.005: twice u² times chi-square of 2 degrees of freedom.
        let model = Cubic {
            g: vec![0.0, 0.0],
            h: DMatrix::identity(2, 2) * 2.0,
            t: vec![0.0, 0.0],
        };
        let found = model.found(&[0.005, 0.005], &[], NORMAL);
        close(found.shift, 5e-5);
        close(found.u, 5e-5);
        assert!(found.matters);
        // At x1 = 0.010, r = 0.9: mean 1.5e-4, variance 4x1²u² + 2(1 + r²)·2·u⁴.
        let model = Cubic {
            g: vec![0.02, 0.0],
            ..model
        };
        let found = model.found(&[0.005, 0.005], &correlated(0.9), NORMAL);
        close(found.shift, 5e-5);
        close(found.u, (1e-8 + 4.0 * 1.81 * 6.25e-10_f64).sqrt());
    }

    #[test]
    fn amendment_2026_bias() {
        // u = 0.1, 0.2, r = 0.5: a² moves by u², ab by the covariance.
        let square = Cubic {
            g: vec![4.0, 0.0],
            h: DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 0.0, 0.0]),
            t: vec![0.0; 2],
        };
        close(
            square.found(&[0.1, 0.2], &correlated(0.5), NORMAL).shift,
            0.01,
        );
        let product = Cubic {
            g: vec![3.0, 2.0],
            h: DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 1.0, 0.0]),
            t: vec![0.0; 2],
        };
        let found = product.found(&[0.1, 0.2], &correlated(0.5), NORMAL);
        close(found.shift, 0.01);
        // Exact: var(ab) = first order + u_a²u_b² (1 + r²).
        let first = 9.0 * 0.01 + 4.0 * 0.04 + 2.0 * 3.0 * 2.0 * 0.01;
        close(found.u, (first + 0.01 * 0.04 * 1.25_f64).sqrt());
    }

    #[test]
    fn gum_h_1_7() {
        // l = ls + d − ls(δα·θ + αs·δθ) with the u of Table H.1: 32 nm becomes 34 nm.
        let (ls, theta, alpha) = (50_000_623.0, -0.1, 1.15e-5);
        let u = [25.0, 9.7, 5.8e-7, 0.41, 1.2e-6, 0.029];
        let mut h = DMatrix::zeros(6, 6);
        let pairs = [(0, 2, -theta), (0, 5, -alpha), (2, 3, -ls), (4, 5, -ls)];
        for (i, j, value) in pairs {
            h[(i, j)] = value;
            h[(j, i)] = value;
        }
        let g = vec![1.0, 1.0, -ls * theta, 0.0, 0.0, -ls * alpha];
        let model = Cubic {
            g,
            h,
            t: vec![0.0; 6],
        };
        let outcome = model.outcome(&u, &[], |_| NORMAL);
        let Terms::Found(found) = outcome.terms else {
            panic!()
        };
        assert!((found.u - 33.9111).abs() < 1e-3, "{}", found.u);
        assert!(found.matters);
        assert_eq!(found.shift, 0.0);
        // The two coefficients that vanish vary by ls·u of their partners.
        close(outcome.slope_deviation[3], ls * 5.8e-7);
        close(outcome.slope_deviation[4], ls * 0.029);
    }

    #[test]
    fn moments_of_other_distributions_are_used() {
        // (x + ½x²) with rectangular x of unit variance: var = 1 + ¼(9/5 − 1).
        let model = Cubic {
            g: vec![1.0],
            h: DMatrix::from_element(1, 1, 1.0),
            t: vec![0.0],
        };
        let rectangular = Moments {
            third: 0.0,
            fourth: 1.8,
        };
        close(model.found(&[1.0], &[], rectangular).u, 1.2_f64.sqrt());
        // Exponential (μ3 = 2, μ4 = 9): 1 + 2 + ¼·8.
        let exponential = Moments {
            third: 2.0,
            fourth: 9.0,
        };
        close(model.found(&[1.0], &[], exponential).u, 5.0_f64.sqrt());
        let uniform = Distribution::Uniform {
            lower: -2.0,
            upper: 2.0,
        };
        assert!((moments(&uniform).fourth - 1.8).abs() < 1e-14);
        let t = Distribution::StudentT {
            location: 0.0,
            scale: 1.0,
            dof: 5.0,
        };
        assert_eq!(moments(&t), NORMAL);
    }

    #[test]
    fn third_derivatives_can_make_the_series_fail() {
        // x − 0.1·x³: variance 1 − 0.6 to this order; with −x³ it would be negative.
        let cubic = |t: f64| Cubic {
            g: vec![1.0],
            h: DMatrix::zeros(1, 1),
            t: vec![t],
        };
        close(cubic(-0.6).found(&[1.0], &[], NORMAL).u, 0.4_f64.sqrt());
        assert_eq!(
            cubic(-6.0).outcome(&[1.0], &[], |_| NORMAL).terms,
            Terms::Divergent
        );
    }

    #[test]
    fn rotation_of_a_group_changes_nothing() {
        // A group of correlation zero is the same as independent components.
        let h = DMatrix::from_row_slice(2, 2, &[1.0, 0.3, 0.3, -2.0]);
        let model = Cubic {
            g: vec![0.5, 1.5],
            h,
            t: vec![0.2, 0.1],
        };
        let alone = model.found(&[0.3, 0.2], &[], NORMAL);
        let grouped = model.found(&[0.3, 0.2], &correlated(0.0), NORMAL);
        close(alone.u, grouped.u);
        close(alone.shift, grouped.shift);
    }

    #[test]
    fn blocks_that_do_not_interact_share_sweeps() {
        // Blocks {0, 1}, {2}, {3, 4}; the correlation of 1 and 2 lies across two of them.
        let mut h = DMatrix::from_diagonal_element(5, 5, 0.7);
        for (i, j) in [(0, 1), (3, 4)] {
            h[(i, j)] = -0.4;
            h[(j, i)] = -0.4;
        }
        let model = Cubic {
            g: vec![1.0, -0.5, 2.0, 0.3, 0.0],
            h,
            t: vec![0.1, 0.2, -0.3, 0.4, 0.5],
        };
        let u = [0.5, 0.6, 0.7, 0.8, 0.9];
        let groups = [Group {
            members: vec![1, 2],
            ..correlated(0.6)[0].clone()
        }];
        let blocks = [Some(7), Some(7), Some(2), Some(4), Some(4)];
        let (whole, all) = model.outcome_in(&u, &groups, |_| NORMAL, &[Some(0); 5]);
        let (parts, shared) = model.outcome_in(&u, &groups, |_| NORMAL, &blocks);
        assert_eq!((all, shared), (5, 3));
        let (Terms::Found(whole_terms), Terms::Found(terms)) = (&whole.terms, &parts.terms) else {
            panic!()
        };
        close(terms.u, whole_terms.u);
        close(terms.shift, whole_terms.shift);
        for (a, b) in parts.slope_deviation.iter().zip(&whole.slope_deviation) {
            close(*a, *b);
        }
    }

    #[test]
    fn a_linear_model_has_no_second_order() {
        let model = Cubic {
            g: vec![1.0],
            h: DMatrix::zeros(1, 1),
            t: vec![0.0],
        };
        assert_eq!(model.outcome(&[1.0], &[], |_| NORMAL).terms, Terms::Linear);
    }

    #[test]
    fn two_digits_decide_whether_it_matters() {
        assert!(matters(31.7, 33.9, 0.0));
        assert!(!matters(31.7, 32.1, 0.0));
        assert!(matters(31.7, 31.7, 0.6));
        assert!(!matters(31.7, 31.7, 0.4));
        assert!(matters(0.0, 5e-5, 5e-5));
    }
}
