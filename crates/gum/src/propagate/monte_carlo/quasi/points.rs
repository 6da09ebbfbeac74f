//! Points of the input quantities: every component, and every χ² that a multivariate t shares, is one
//! dimension of a scrambled Sobol' sequence.
//!
//! The first dimensions are the most even, so the component that moves the measurand most gets the first
//! one. Beyond the dimensions that have direction numbers, random numbers take their place.

use super::super::joint_draw::weights;
use super::shapes;
use super::trial::{Trial, effects, inputs_of};
use crate::budget::{Budget, Group, Law};
use gumption_core::least_squares::lower_factor;
use gumption_lanes::quantile::{OfScore, Quantile, scores};
use gumption_lanes::sobol::DIMENSIONS;
use gumption_lanes::triangle::{Row, Triangle};
use gumption_lanes::{Block, Generator, LANES, Level, Sobol, level, ops};

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
    /// Makes the members of independent standard normals.
    factor: Triangle,
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
    normals: Vec<Block>,
    /// The current points; what is not drawn has deviations of zero.
    pub(super) trial: Trial<'b>,
}

impl<'b> Points<'b> {
    /// Points of all components that inputs use except those that are `held`; the error is the name of one
    /// whose values are single numbers.
    pub(super) fn new(budget: &'b Budget, seed: u64, held: &[usize]) -> Result<Points<'b>, String> {
        let grouped: Vec<bool> = {
            let mut grouped = vec![false; budget.components.len()];
            let members = budget.groups.iter().flat_map(|group| &group.members);
            members.for_each(|member| grouped[*member] = true);
            grouped
        };
        let mut used: Vec<bool> = inputs_of(budget).iter().map(|of| !of.is_empty()).collect();
        held.iter().for_each(|component| used[*component] = false);
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
                let quantile = of
                    .distribution
                    .block_quantile()
                    .ok_or_else(|| of.name.clone())?;
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
        let effects = effects(self.budget);
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

    /// Whether nothing is drawn, so that all points are the same.
    pub(super) fn are_one(&self) -> bool {
        self.dimensions == 0
    }

    /// Scratch space of one thread.
    pub(super) fn scratch(&self) -> Scratch<'b> {
        Scratch {
            replicate: 0,
            sequence: Vec::new(),
            normals: vec![
                Block::ZERO;
                self.groups
                    .iter()
                    .map(|group| group.members.len())
                    .max()
                    .unwrap_or(0)
            ],
            trial: Trial::new(self.budget),
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
            normals,
            trial,
        } = scratch;
        let errors = &mut trial.deviations;
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
                &*group.correlation,
            ),
            Law::StudentT { dof, scale } if dof.is_finite() => {
                let law = JointLaw::StudentT {
                    scale: scale.clone(),
                    mixing: shapes::mixing(*dof),
                    dimension: 0,
                };
                (law, &*group.correlation)
            }
            Law::StudentT { scale, .. } => (JointLaw::Normal(scale.clone()), &*group.correlation),
            Law::GaussianCopula { latent } => {
                let of_score = |member: &crate::budget::Component| {
                    member
                        .distribution
                        .of_score()
                        .ok_or_else(|| member.name.clone())
                };
                (
                    JointLaw::Copula(members().map(of_score).collect::<Result<_, _>>()?),
                    latent,
                )
            }
        };
        let weights = weights(&lower_factor(correlation)).into_iter();
        let rows = weights.zip(&group.members).map(|(weights, &place)| Row {
            weights,
            scale: [1.0, 1.0, 0.0],
            place,
        });
        Ok(Joint {
            members: &group.members,
            dimensions: Vec::new(),
            factor: Triangle::new(&rows.collect::<Vec<_>>()),
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
        self.factor.apply(level, normals, errors);
        for (i, &member) in self.members.iter().enumerate() {
            let error = &mut errors[member];
            match &self.law {
                JointLaw::Normal(scale) => ops::scale(level, scale[i], error),
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
