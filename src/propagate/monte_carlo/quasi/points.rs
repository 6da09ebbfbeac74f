//! Points of the input quantities: every component, and every χ² that a multivariate t shares, is one
//! dimension of a scrambled Sobol' sequence.
//!
//! The first dimensions are the most even, so the component that moves the measurand most gets the first
//! one. Beyond the dimensions that have direction numbers, random numbers take their place.

use gumption_lanes::quantile::{OfScore, Quantile, scores};
use gumption_lanes::sobol::DIMENSIONS;
use gumption_lanes::{Block, Generator, LANES, Level, Sobol, level, ops};
use nalgebra::DMatrix;

use super::super::factor::lower_factor;
use super::shapes;
use crate::budget::{Budget, Group, Law};
use crate::model::BlockRunner;

/// Random numbers beyond the last dimension of the sequence; no trial takes them.
const STREAMS: u64 = 1 << 49;

/// Points of one budget.
pub(super) struct Points<'b> {
    budget: &'b Budget,
    seed: u64,
    pub(super) level: Level,
    singles: Vec<Single>,
    groups: Vec<Joint<'b>>,
    dimensions: usize,
}

/// A component that is independent of all others.
struct Single {
    component: usize,
    dimension: usize,
    quantile: Quantile,
}

/// Components that are correlated.
struct Joint<'b> {
    members: &'b [usize],
    /// Of each member.
    dimensions: Vec<usize>,
    factor: DMatrix<f64>,
    law: JointLaw,
}

enum JointLaw {
    /// Factor of each member.
    Normal(Vec<f64>),
    /// Factor of each member, and what they share, in a dimension of its own.
    StudentT {
        scale: Vec<f64>,
        mixing: OfScore,
        dimension: usize,
    },
    /// Each member as a function of its normal score.
    Copula(Vec<OfScore>),
}

/// Scratch space of one thread.
pub(super) struct Scratch<'b> {
    replicate: u64,
    sequence: Vec<Sobol>,
    /// The current point's deviations, one block per component.
    errors: Vec<Block>,
    normals: Vec<Block>,
    inputs: Vec<Block>,
    output: [Block; 1],
    runner: BlockRunner<'b>,
}

impl<'b> Points<'b> {
    /// Points of all components that inputs use; the error is the name of one whose values are single
    /// numbers.
    pub(super) fn new(budget: &'b Budget, seed: u64) -> Result<Points<'b>, String> {
        let grouped: Vec<bool> = {
            let mut grouped = vec![false; budget.components.len()];
            let members = budget.groups.iter().flat_map(|group| &group.members);
            members.for_each(|member| grouped[*member] = true);
            grouped
        };
        let used = used(budget);
        let mut points = Points {
            budget,
            seed,
            level: level(),
            singles: Vec::new(),
            groups: Vec::new(),
            dimensions: 0,
        };
        for (component, of) in budget.components.iter().enumerate() {
            if used[component] && !grouped[component] {
                let quantile = shapes::quantile(&of.distribution).ok_or_else(|| of.name.clone())?;
                points.singles.push(Single {
                    component,
                    dimension: 0,
                    quantile,
                });
            }
        }
        for group in budget
            .groups
            .iter()
            .filter(|group| group.members.iter().any(|member| used[*member]))
        {
            let joint = Joint::new(budget, group)?;
            points.groups.push(joint);
        }
        points.rank();
        Ok(points)
    }

    /// Numbers the dimensions: those of components by their effects, then the shared ones.
    fn rank(&mut self) {
        let effects = self.effects();
        let members = self
            .groups
            .iter()
            .flat_map(|group| group.members.iter().copied());
        let mut order: Vec<usize> = self
            .singles
            .iter()
            .map(|single| single.component)
            .chain(members)
            .collect();
        order.sort_by(|a, b| effects[*b].total_cmp(&effects[*a]));
        let mut place = vec![0; self.budget.components.len()];
        order
            .iter()
            .enumerate()
            .for_each(|(rank, component)| place[*component] = rank);
        self.dimensions = order.len();
        for single in &mut self.singles {
            single.dimension = place[single.component];
        }
        for group in &mut self.groups {
            group.dimensions = group.members.iter().map(|member| place[*member]).collect();
            if let JointLaw::StudentT { dimension, .. } = &mut group.law {
                *dimension = self.dimensions;
                self.dimensions += 1;
            }
        }
    }

    /// How far one standard uncertainty of each component moves the measurand up or down, linear or not;
    /// infinite where there is no value.
    pub(super) fn effects(&self) -> Vec<f64> {
        let components = &self.budget.components;
        let mut scratch = self.scratch();
        let mut effects = Vec::with_capacity(components.len());
        for start in (0..components.len()).step_by(LANES / 2 - 1) {
            let some = start..components.len().min(start + LANES / 2 - 1);
            for (component, error) in scratch.errors.iter_mut().enumerate() {
                *error = Block::ZERO;
                if some.contains(&component) {
                    let lane = 2 * (component - start);
                    (error.0[lane], error.0[lane + 1]) =
                        (components[component].u, -components[component].u);
                }
            }
            let moved = *self.value(&mut scratch);
            let centre = moved.0[LANES - 1];
            effects.extend(some.map(|component| {
                let lane = 2 * (component - start);
                let effect = (moved.0[lane] - centre).abs() + (moved.0[lane + 1] - centre).abs();
                if effect.is_nan() {
                    f64::INFINITY
                } else {
                    effect
                }
            }));
        }
        effects
    }

    /// Components that are independent of all others.
    pub(super) fn independent(&self) -> impl Iterator<Item = usize> {
        self.singles.iter().map(|single| single.component)
    }

    /// Scratch space of one thread.
    pub(super) fn scratch(&self) -> Scratch<'b> {
        Scratch {
            replicate: 0,
            sequence: Vec::new(),
            errors: vec![Block::ZERO; self.budget.components.len()],
            normals: vec![
                Block::ZERO;
                self.groups
                    .iter()
                    .map(|group| group.members.len())
                    .max()
                    .unwrap_or(0)
            ],
            inputs: vec![Block::ZERO; self.budget.model.inputs()],
            output: [Block::ZERO],
            runner: BlockRunner::new(&self.budget.model),
        }
    }

    /// Begins a scramble, for up to 2^`bits` points.
    pub(super) fn begin(&self, scratch: &mut Scratch<'b>, replicate: u64, bits: u32) {
        scratch.replicate = replicate;
        scratch.sequence.clear();
        let dimensions = 0..self.dimensions.min(DIMENSIONS);
        scratch.sequence.extend(
            dimensions.map(|dimension| Sobol::new(dimension, bits, [self.seed, replicate])),
        );
    }

    /// Points 256·`block` and following: deviations of all components.
    pub(super) fn draw(&self, scratch: &mut Scratch<'b>, block: u64) {
        let Scratch {
            replicate,
            sequence,
            errors,
            normals,
            ..
        } = scratch;
        let uniform = |dimension: usize, out: &mut Block| match sequence.get(dimension) {
            Some(sobol) => sobol.block(self.level, block, out),
            None => {
                let stream = STREAMS + dimension as u64;
                Generator::new(self.seed, *replicate << 32 | block, stream)
                    .uniforms(self.level, out);
            }
        };
        for Single {
            component,
            dimension,
            quantile,
        } in &self.singles
        {
            let error = &mut errors[*component];
            uniform(*dimension, error);
            quantile.apply(self.level, error);
        }
        for group in &self.groups {
            group.draw(self.level, &uniform, normals, errors);
        }
    }

    /// The measurand's values at the current deviations.
    pub(super) fn value<'s>(&self, scratch: &'s mut Scratch<'b>) -> &'s Block {
        for (input, block) in self.budget.inputs.iter().zip(&mut scratch.inputs) {
            ops::fill(self.level, 0.0, block);
            for term in input.terms.iter().filter(|term| term.coefficient != 0.0) {
                ops::axpy(
                    self.level,
                    term.coefficient,
                    &scratch.errors[term.component],
                    block,
                );
            }
            block.0.iter_mut().for_each(|x| *x += input.estimate);
        }
        scratch.runner.run(&scratch.inputs, &mut scratch.output);
        &scratch.output[0]
    }

    /// The measurand's values where one component's deviation is set to a number.
    pub(super) fn value_at(
        &self,
        scratch: &mut Scratch<'b>,
        component: usize,
        deviation: f64,
    ) -> Block {
        scratch.errors[component].0 = [deviation; LANES];
        *self.value(scratch)
    }
}

impl Scratch<'_> {
    /// The current deviations of one component.
    pub(super) fn deviations(&self, component: usize) -> Block {
        self.errors[component]
    }
}

/// Which components inputs use.
fn used(budget: &Budget) -> Vec<bool> {
    let mut used = vec![false; budget.components.len()];
    for term in budget.inputs.iter().flat_map(|input| &input.terms) {
        used[term.component] |= term.coefficient != 0.0;
    }
    used
}

impl<'b> Joint<'b> {
    fn new(budget: &Budget, group: &'b Group) -> Result<Joint<'b>, String> {
        let members = || {
            group
                .members
                .iter()
                .map(|member| &budget.components[*member])
        };
        let (law, correlation) = match &group.law {
            Law::Normal => (
                JointLaw::Normal(members().map(|member| member.u).collect()),
                &group.correlation,
            ),
            Law::StudentT { dof, scale } if dof.is_finite() => {
                let law = JointLaw::StudentT {
                    scale: scale.clone(),
                    mixing: shapes::mixing(*dof),
                    dimension: 0,
                };
                (law, &group.correlation)
            }
            Law::StudentT { scale, .. } => (JointLaw::Normal(scale.clone()), &group.correlation),
            Law::GaussianCopula { latent } => {
                let of_score = |member: &crate::budget::Component| {
                    shapes::of_score(&member.distribution).ok_or_else(|| member.name.clone())
                };
                (
                    JointLaw::Copula(members().map(of_score).collect::<Result<_, _>>()?),
                    latent,
                )
            }
        };
        Ok(Joint {
            members: &group.members,
            dimensions: Vec::new(),
            factor: lower_factor(correlation),
            law,
        })
    }

    fn draw(
        &self,
        level: Level,
        uniform: &impl Fn(usize, &mut Block),
        normals: &mut [Block],
        errors: &mut [Block],
    ) {
        for (normal, dimension) in normals.iter_mut().zip(&self.dimensions) {
            uniform(*dimension, normal);
            scores(level, normal);
        }
        let mut shared = Block([1.0; LANES]);
        if let JointLaw::StudentT {
            mixing, dimension, ..
        } = &self.law
        {
            uniform(*dimension, &mut shared);
            scores(level, &mut shared);
            mixing.apply(level, &mut shared);
        }
        for (i, member) in self.members.iter().enumerate() {
            let error = &mut errors[*member];
            ops::fill(level, 0.0, error);
            for (k, normal) in normals.iter().enumerate().take(i + 1) {
                ops::axpy(level, self.factor[(i, k)], normal, error);
            }
            match &self.law {
                JointLaw::Normal(scale) => error.0.iter_mut().for_each(|z| *z *= scale[i]),
                JointLaw::StudentT { scale, .. } => {
                    error
                        .0
                        .iter_mut()
                        .zip(&shared.0)
                        .for_each(|(z, w)| *z *= w * scale[i]);
                }
                JointLaw::Copula(margins) => margins[i].apply(level, error),
            }
        }
    }
}
