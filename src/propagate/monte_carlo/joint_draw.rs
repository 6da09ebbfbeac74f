//! Trials of a budget: draws of its components, joined where they are correlated, put into the
//! inputs and through the model.
//!
//! X_i = x_i + Σ a_ij E_j. Every component E_j has a stream of its own in every chunk, numbered by its
//! place in the budget, so that what one component draws does not depend on the others. Components that
//! are correlated are drawn together (JCGM 101 6.4.8, JCGM 102 5.3.2):
//!
//! | law | members |
//! |---|---|
//! | normal | u_i (L Z)_i, L Lᵀ = R, Z independent standard normals |
//! | t | as the normal, times √(ν/χ²_ν) that all members share |
//! | Gaussian copula | G_i⁻¹(Φ((L Z)_i)), L Lᵀ = latent correlation, G_i the member's own distribution |

use gumption_lanes::sampler::{gamma_block, normal_block};
use gumption_lanes::{Block, Generator, LANES, Level, Sampler, level, ops};
use nalgebra::DMatrix;

use super::engine::Source;
use super::factor::lower_factor;
use crate::budget::{Budget, Group, Input, Law};
use crate::distribution::Distribution;
use crate::model::BlockRunner;
use crate::special::normal_cdf;

/// Draws trials of a budget.
pub(super) struct BudgetSource<'b> {
    budget: &'b Budget,
    seed: u64,
    level: Level,
    /// How each component that an input uses is drawn; `None` for members of groups and unused ones.
    alone: Vec<Option<Sampler>>,
    groups: Vec<JointSampler>,
}

/// How the members of a group are drawn.
struct JointSampler {
    members: Vec<usize>,
    factor: DMatrix<f64>,
    law: JointLaw,
}

enum JointLaw {
    /// Factor of each member.
    Normal(Vec<f64>),
    /// Factor of each member, degrees of freedom, stream of χ².
    StudentT {
        scale: Vec<f64>,
        dof: f64,
        stream: u64,
    },
    Copula(Vec<Margin>),
}

/// From the latent standard normal to a member of a copula.
enum Margin {
    Normal { mean: f64, sd: f64 },
    Other(Distribution),
}

impl<'b> BudgetSource<'b> {
    /// Prepares the samplers of a budget.
    pub(super) fn new(budget: &'b Budget, seed: u64) -> Self {
        let used = used_components(budget);
        let mut alone: Vec<Option<Sampler>> = budget
            .components
            .iter()
            .zip(&used)
            .map(|(component, used)| used.then(|| component.distribution.sampler()))
            .collect();
        let mut groups = Vec::new();
        for (index, group) in budget.groups.iter().enumerate() {
            for &member in &group.members {
                alone[member] = None;
            }
            if group.members.iter().any(|&member| used[member]) {
                // Streams beyond those of the components belong to the groups.
                let stream = (budget.components.len() + index) as u64;
                groups.push(JointSampler::new(budget, group, stream));
            }
        }
        BudgetSource {
            budget,
            seed,
            level: level(),
            alone,
            groups,
        }
    }
}

/// Which components some input depends on.
fn used_components(budget: &Budget) -> Vec<bool> {
    let mut used = vec![false; budget.components.len()];
    for term in budget.inputs.iter().flat_map(|input| &input.terms) {
        used[term.component] |= term.coefficient != 0.0;
    }
    used
}

impl JointSampler {
    fn new(budget: &Budget, group: &Group, stream: u64) -> Self {
        let members = || {
            group
                .members
                .iter()
                .map(|&member| &budget.components[member])
        };
        let (law, correlation) = match &group.law {
            Law::Normal => (
                JointLaw::Normal(members().map(|c| c.u).collect()),
                &group.correlation,
            ),
            Law::StudentT { dof, scale } => {
                let law = JointLaw::StudentT {
                    scale: scale.clone(),
                    dof: *dof,
                    stream,
                };
                (law, &group.correlation)
            }
            Law::GaussianCopula { latent } => {
                let margins = members().map(|c| Margin::new(&c.distribution)).collect();
                (JointLaw::Copula(margins), latent)
            }
        };
        JointSampler {
            members: group.members.clone(),
            factor: lower_factor(correlation),
            law,
        }
    }

    /// Draws the members' next block into `errors`, which is indexed by component.
    fn draw(
        &self,
        level: Level,
        generators: &mut [Generator],
        scratch: &mut Scratch,
        errors: &mut [Block],
    ) {
        let Scratch { normals, mixing } = scratch;
        for (normal, &member) in normals.iter_mut().zip(&self.members) {
            normal_block(level, &mut generators[member], normal);
        }
        if let JointLaw::StudentT { dof, stream, .. } = self.law {
            // √(ν/χ²) with χ² = 2 G(ν/2, 1); 1 in the limit of infinitely many degrees of freedom.
            if dof.is_finite() {
                gamma_block(level, &mut generators[stream as usize], dof / 2.0, mixing);
                mixing
                    .0
                    .iter_mut()
                    .for_each(|g| *g = (dof / (2.0 * *g)).sqrt());
            } else {
                ops::fill(level, 1.0, mixing);
            }
        }
        for (i, &member) in self.members.iter().enumerate() {
            let error = &mut errors[member];
            ops::fill(level, 0.0, error);
            for (k, normal) in normals.iter().enumerate().take(i + 1) {
                let weight = self.factor[(i, k)];
                if weight != 0.0 {
                    ops::axpy(level, weight, normal, error);
                }
            }
            match &self.law {
                JointLaw::Normal(u) => error.0.iter_mut().for_each(|z| *z *= u[i]),
                JointLaw::StudentT { scale, .. } => {
                    error
                        .0
                        .iter_mut()
                        .zip(&mixing.0)
                        .for_each(|(z, w)| *z *= w * scale[i]);
                }
                JointLaw::Copula(margins) => margins[i].apply(error),
            }
        }
    }
}

impl Margin {
    fn new(distribution: &Distribution) -> Self {
        match *distribution {
            Distribution::Normal { mean, sd } => Margin::Normal { mean, sd },
            ref other => Margin::Other(other.clone()),
        }
    }

    fn apply(&self, block: &mut Block) {
        match self {
            Margin::Normal { mean, sd } => {
                block.0.iter_mut().for_each(|z| *z = sd.mul_add(*z, *mean));
            }
            Margin::Other(distribution) => {
                // Φ rounds to 1 beyond 8.3; the largest number below 1 keeps the quantile finite.
                let most = 1.0 - f64::EPSILON / 2.0;
                block.0.iter_mut().for_each(|z| {
                    *z = distribution.quantile(normal_cdf(*z).clamp(f64::MIN_POSITIVE, most));
                });
            }
        }
    }
}

/// Blocks that groups use while they are drawn.
struct Scratch {
    normals: Vec<Block>,
    mixing: Block,
}

/// What a thread needs to draw trials.
pub(super) struct Worker<'b> {
    runner: BlockRunner<'b>,
    generators: Vec<Generator>,
    errors: Vec<Block>,
    inputs: Vec<Block>,
    outputs: Vec<Block>,
    scratch: Scratch,
}

impl<'b> Source for BudgetSource<'b> {
    type Worker = Worker<'b>;

    fn outputs(&self) -> usize {
        self.budget.model.outputs().len()
    }

    fn worker(&self) -> Worker<'b> {
        let largest = self
            .groups
            .iter()
            .map(|group| group.members.len())
            .max()
            .unwrap_or(0);
        Worker {
            runner: BlockRunner::new(&self.budget.model),
            generators: Vec::new(),
            errors: vec![Block::ZERO; self.budget.components.len()],
            inputs: vec![Block::ZERO; self.budget.inputs.len()],
            outputs: vec![Block::ZERO; self.outputs()],
            scratch: Scratch {
                normals: vec![Block::ZERO; largest],
                mixing: Block::ZERO,
            },
        }
    }

    fn draw(&self, worker: &mut Worker<'b>, chunk: u64, trials: usize, columns: &mut [Vec<f64>]) {
        let streams = self.budget.components.len() + self.budget.groups.len();
        worker.generators.clear();
        worker
            .generators
            .extend((0..streams as u64).map(|stream| Generator::new(self.seed, chunk, stream)));
        columns.iter_mut().for_each(Vec::clear);
        let mut left = trials;
        while left > 0 {
            self.block(worker);
            let count = left.min(LANES);
            for (column, block) in columns.iter_mut().zip(&worker.outputs) {
                column.extend_from_slice(&block.0[..count]);
            }
            left -= count;
        }
    }
}

impl BudgetSource<'_> {
    /// The next 256 trials of the worker's chunk.
    fn block(&self, worker: &mut Worker<'_>) {
        let Worker {
            runner,
            generators,
            errors,
            inputs,
            outputs,
            scratch,
        } = worker;
        for (i, sampler) in self.alone.iter().enumerate() {
            if let Some(sampler) = sampler {
                sampler.fill(self.level, &mut generators[i], &mut errors[i]);
            }
        }
        for group in &self.groups {
            group.draw(self.level, generators, scratch, errors);
        }
        for (input, block) in self.budget.inputs.iter().zip(inputs.iter_mut()) {
            self.sum(input, errors, block);
        }
        runner.run(inputs, outputs);
    }

    /// X_i = x_i + Σ a_ij E_j. The deviations are summed first, so that the estimate is added with
    /// one rounding.
    fn sum(&self, input: &Input, errors: &[Block], block: &mut Block) {
        ops::fill(self.level, 0.0, block);
        for term in input.terms.iter().filter(|term| term.coefficient != 0.0) {
            ops::axpy(self.level, term.coefficient, &errors[term.component], block);
        }
        block.0.iter_mut().for_each(|x| *x += input.estimate);
    }
}
