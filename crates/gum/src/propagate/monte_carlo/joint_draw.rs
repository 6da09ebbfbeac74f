//! Trials of the input quantities: draws of the components, joined where they are correlated.
//!
//! X_i = x_i + Σ a_ij E_j. Every component E_j has a stream of its own in every chunk, numbered by
//! its place in the budget, so that what one component draws does not depend on the others.
//! Components that are correlated are drawn together (JCGM 101 6.4.8, JCGM 102 5.3.2):
//!
//! | law | members |
//! |---|---|
//! | normal | u_i (L Z)_i, L Lᵀ = R, Z independent standard normals |
//! | t | as the normal, times √(ν/χ²_ν) that all members share |
//! | Gaussian copula | G_i⁻¹(Φ((L Z)_i)), L Lᵀ = latent correlation, G_i the member's own distribution |

use gumption_lanes::sampler::{gamma_block, normal_block};
use gumption_lanes::triangle::{Row, Triangle};
use gumption_lanes::{Block, Generator, Level, Sampler, level, ops};
use nalgebra::DMatrix;

use super::assembly::{self, Assembly, Straight};
use super::margin::Margin;
use crate::budget::{Component, Group, Input, Law};
use gumption_core::least_squares::lower_factor;

/// Draws trials of all inputs.
pub(super) struct JointDraw<'b> {
    inputs: &'b [Input],
    seed: u64,
    level: Level,
    /// How each component is drawn; `None` for members of groups and for what no input uses.
    alone: Vec<Option<Sampler>>,
    /// Per input.
    assemblies: Vec<Assembly>,
    /// Whether a component is drawn only where it becomes the value of an input.
    with_input: Vec<bool>,
    groups: Vec<JointSampler>,
    /// Streams of a chunk: one per component, then one per group.
    streams: u64,
    largest_group: usize,
}

impl<'b> JointDraw<'b> {
    /// Prepares the samplers.
    pub(super) fn new(
        inputs: &'b [Input],
        components: &[Component],
        groups: &[Group],
        seed: u64,
    ) -> Self {
        let mut used = vec![false; components.len()];
        for term in inputs.iter().flat_map(|input| &input.terms) {
            used[term.component] |= term.coefficient != 0.0;
        }
        let grouped = |index: usize| groups.iter().any(|group| group.members.contains(&index));
        let alone: Vec<Option<Sampler>> = components
            .iter()
            .enumerate()
            .map(|(i, component)| {
                (used[i] && !grouped(i)).then(|| component.distribution.sampler())
            })
            .collect();
        let drawn_alone: Vec<bool> = alone.iter().map(Option::is_some).collect();
        let straight = assembly::straight(inputs, components.len());
        let assemblies = assembly::assemblies(inputs, &drawn_alone, groups, &straight);
        let mut with_input = vec![false; components.len()];
        for assembly in &assemblies {
            if let Assembly::Alone(component) = assembly {
                with_input[*component] = true;
            }
        }
        let joint = groups
            .iter()
            .zip(components.len()..)
            .filter(|(group, _)| group.members.iter().any(|&member| used[member]))
            .map(|(group, stream)| JointSampler::new(components, group, stream, &straight))
            .collect();
        JointDraw {
            inputs,
            seed,
            level: level(),
            alone,
            assemblies,
            with_input,
            groups: joint,
            streams: (components.len() + groups.len()) as u64,
            largest_group: groups
                .iter()
                .map(|group| group.members.len())
                .max()
                .unwrap_or(0),
        }
    }

    /// Scratch space of one thread.
    pub(super) fn scratch(&self) -> Scratch {
        Scratch {
            generators: Vec::new(),
            errors: vec![Block::ZERO; self.alone.len()],
            normals: vec![Block::ZERO; self.largest_group],
            mixing: Block::ZERO,
        }
    }

    /// Begins a chunk.
    pub(super) fn start(&self, scratch: &mut Scratch, chunk: u64) {
        scratch.generators.clear();
        scratch
            .generators
            .extend((0..self.streams).map(|stream| Generator::new(self.seed, chunk, stream)));
    }

    /// The next 256 trials of the chunk, one block per input.
    pub(super) fn next(&self, scratch: &mut Scratch, inputs: &mut [Block]) {
        let Scratch {
            generators, errors, ..
        } = scratch;
        for (i, sampler) in self.drawn_apart() {
            sampler.fill(self.level, &mut generators[i], &mut errors[i]);
        }
        for group in &self.groups {
            group.draw(self.level, scratch, inputs);
        }
        for ((input, assembly), block) in self.inputs.iter().zip(&self.assemblies).zip(inputs) {
            match (assembly, input.terms.as_slice()) {
                (Assembly::WithGroup, _) => {}
                (Assembly::Alone(component), [term]) => {
                    let scale = [term.coefficient, input.estimate];
                    let generator = &mut scratch.generators[*component];
                    if let Some(sampler) = &self.alone[*component] {
                        sampler.fill_scaled(self.level, generator, scale, block);
                    }
                }
                _ => self.sum(input, &scratch.errors, block),
            }
        }
    }

    /// The components that are drawn before the inputs that they belong to.
    fn drawn_apart(&self) -> impl Iterator<Item = (usize, &Sampler)> {
        let samplers = self.alone.iter().zip(&self.with_input).enumerate();
        samplers.filter_map(|(i, (sampler, with_input))| {
            sampler.as_ref().filter(|_| !with_input).map(|s| (i, s))
        })
    }

    /// The deviations are summed first, so that the estimate is added with one rounding.
    fn sum(&self, input: &Input, errors: &[Block], block: &mut Block) {
        if let [term] = input.terms.as_slice()
            && term.coefficient != 0.0
        {
            let error = &errors[term.component];
            ops::affine(self.level, error, term.coefficient, input.estimate, block);
            return;
        }
        ops::fill(self.level, 0.0, block);
        for term in input.terms.iter().filter(|term| term.coefficient != 0.0) {
            ops::axpy(self.level, term.coefficient, &errors[term.component], block);
        }
        block.0.iter_mut().for_each(|x| *x += input.estimate);
    }
}

/// What a thread needs to draw.
pub(super) struct Scratch {
    generators: Vec<Generator>,
    /// The current deviations, one block per component.
    errors: Vec<Block>,
    normals: Vec<Block>,
    mixing: Block,
}

/// How the members of a group are drawn.
struct JointSampler {
    members: Vec<usize>,
    /// Makes the members, or their inputs, of independent standard normals.
    factor: Triangle,
    law: JointLaw,
    /// Whether what is made are the inputs.
    makes_inputs: bool,
}

enum JointLaw {
    Normal,
    /// Factor of each member, degrees of freedom, stream of χ².
    StudentT {
        scale: Vec<f64>,
        dof: f64,
        stream: usize,
    },
    Copula(Vec<Margin>),
}

impl JointSampler {
    fn new(
        components: &[Component],
        group: &Group,
        stream: usize,
        straight: &[Option<Straight>],
    ) -> Self {
        let members = || group.members.iter().map(|&member| &components[member]);
        let (law, correlation) = match &group.law {
            Law::Normal => (JointLaw::Normal, &*group.correlation),
            Law::StudentT { dof, scale } => {
                let law = JointLaw::StudentT {
                    scale: scale.clone(),
                    dof: *dof,
                    stream,
                };
                (law, &*group.correlation)
            }
            Law::GaussianCopula { latent } => (
                JointLaw::Copula(members().map(|c| Margin::of(&c.distribution)).collect()),
                latent,
            ),
        };
        let inputs = assembly::inputs_of(group, straight);
        let row = |(i, weights): (usize, Vec<f64>)| {
            let member = group.members[i];
            let u = match law {
                JointLaw::Normal => components[member].u,
                _ => 1.0,
            };
            let (place, [coefficient, estimate]) = match &inputs {
                Some(inputs) => (inputs[i].place, inputs[i].scale),
                None => (member, [1.0, 0.0]),
            };
            Row {
                weights,
                scale: [u, coefficient, estimate],
                place,
            }
        };
        let weights = weights(&lower_factor(correlation)).into_iter();
        JointSampler {
            members: group.members.clone(),
            factor: Triangle::new(&weights.enumerate().map(row).collect::<Vec<_>>()),
            law,
            makes_inputs: inputs.is_some(),
        }
    }

    /// Draws the members' next block, or that of the inputs that they make up.
    fn draw(&self, level: Level, scratch: &mut Scratch, inputs: &mut [Block]) {
        let Scratch {
            generators,
            errors,
            normals,
            mixing,
        } = scratch;
        for (normal, &member) in normals.iter_mut().zip(&self.members) {
            normal_block(level, &mut generators[member], normal);
        }
        if let JointLaw::StudentT { dof, stream, .. } = self.law {
            mix(level, &mut generators[stream], dof, mixing);
        }
        let made = match self.makes_inputs {
            true => inputs,
            false => errors.as_mut_slice(),
        };
        self.factor.apply(level, normals, made);
        for (i, &member) in self.members.iter().enumerate() {
            let error = &mut errors[member];
            match &self.law {
                JointLaw::Normal => {}
                JointLaw::StudentT { scale, .. } => {
                    let factors = mixing.0.iter().map(|w| w * scale[i]);
                    error.0.iter_mut().zip(factors).for_each(|(z, w)| *z *= w);
                }
                JointLaw::Copula(margins) => margins[i].apply(level, error),
            }
        }
    }
}

/// The rows of a triangular factor, up to the diagonal.
pub(super) fn weights(factor: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let row = |i: usize| (0..=i).map(|k| factor[(i, k)]).collect();
    (0..factor.nrows()).map(row).collect()
}

/// √(ν/χ²) with χ² = 2 G(ν/2, 1); 1 for infinitely many degrees of freedom.
fn mix(level: Level, generator: &mut Generator, dof: f64, out: &mut Block) {
    if dof.is_finite() {
        gamma_block(level, generator, dof / 2.0, out);
        out.0
            .iter_mut()
            .for_each(|g| *g = (dof / (2.0 * *g)).sqrt());
    } else {
        ops::fill(level, 1.0, out);
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{component, input};
    use super::*;
    use gumption_core::distribution::{Distribution, Exponential, Normal, StudentT, Uniform};
    use gumption_core::special::normal_sf;

    fn normal(name: &str, sd: f64) -> Component {
        component(name, Distribution::Normal(Normal { mean: 0.0, sd }), sd)
    }

    fn uniform(name: &str, half_width: f64) -> Component {
        let limits = Distribution::Uniform(Uniform {
            lower: -half_width,
            upper: half_width,
        });
        component(name, limits, half_width / 3.0_f64.sqrt())
    }

    fn pair(r: f64) -> DMatrix<f64> {
        DMatrix::from_row_slice(2, 2, &[1.0, r, r, 1.0])
    }

    fn group(law: Law, r: f64) -> Group {
        Group {
            members: vec![0, 1],
            correlation: pair(r).into(),
            law,
            dof: None,
        }
    }

    /// One column per input.
    fn sample(
        inputs: &[Input],
        components: &[Component],
        groups: &[Group],
        chunks: u64,
    ) -> Vec<Vec<f64>> {
        let draw = JointDraw::new(inputs, components, groups, 5);
        let mut scratch = draw.scratch();
        let mut blocks = vec![Block::ZERO; inputs.len()];
        let mut columns = vec![Vec::new(); inputs.len()];
        for chunk in 0..chunks {
            draw.start(&mut scratch, chunk);
            for _ in 0..64 {
                draw.next(&mut scratch, &mut blocks);
                for (column, block) in columns.iter_mut().zip(&blocks) {
                    column.extend_from_slice(&block.0);
                }
            }
        }
        columns
    }

    fn mean(x: &[f64]) -> f64 {
        x.iter().sum::<f64>() / x.len() as f64
    }

    fn covariance(x: &[f64], y: &[f64]) -> f64 {
        let (mx, my) = (mean(x), mean(y));
        x.iter()
            .zip(y)
            .map(|(x, y)| (x - mx) * (y - my))
            .sum::<f64>()
            / (x.len() - 1) as f64
    }

    fn correlation(x: &[f64], y: &[f64]) -> f64 {
        covariance(x, y) / (covariance(x, x) * covariance(y, y)).sqrt()
    }

    #[test]
    fn a_shared_component_correlates_its_inputs() {
        let components = [normal("common", 2.0), uniform("a", 3.0), normal("b", 1.0)];
        let inputs = [
            input(10.0, &[(0, 1.0), (1, 1.0)]),
            input(-5.0, &[(0, -0.5), (2, 1.0)]),
        ];
        let x = sample(&inputs, &components, &[], 16);
        assert!((mean(&x[0]) - 10.0).abs() < 0.03 && (mean(&x[1]) + 5.0).abs() < 0.02);
        // 4 + 3, 1 + 1, −2.
        assert!((covariance(&x[0], &x[0]) - 7.0).abs() < 0.1);
        assert!((covariance(&x[1], &x[1]) - 2.0).abs() < 0.03);
        assert!((covariance(&x[0], &x[1]) + 2.0).abs() < 0.05);
    }

    #[test]
    fn a_component_draws_the_same_whatever_the_others_are() {
        let inputs = [input(0.0, &[(0, 1.0)])];
        let alone = sample(&inputs, &[normal("a", 1.0)], &[], 2);
        let more = [normal("a", 1.0), uniform("b", 1.0), normal("unused", 1.0)];
        let both = [input(0.0, &[(0, 1.0)]), input(0.0, &[(1, 1.0)])];
        assert_eq!(sample(&both, &more, &[], 2)[0], alone[0]);
    }

    #[test]
    fn joint_normals_have_their_correlation() {
        let components = [normal("a", 2.0), normal("b", 0.1)];
        let inputs = [input(1.0, &[(0, 1.0)]), input(2.0, &[(1, 1.0)])];
        for r in [-0.7, 0.95, 1.0] {
            let x = sample(&inputs, &components, &[group(Law::Normal, r)], 16);
            assert!((correlation(&x[0], &x[1]) - r).abs() < 0.006, "{r}");
            assert!((covariance(&x[1], &x[1]).sqrt() - 0.1).abs() < 0.001);
        }
    }

    #[test]
    fn members_that_make_up_an_input_alone_are_drawn_the_same() {
        let components = [normal("a", 2.0), normal("b", 0.1), normal("unused", 1.0)];
        let group = || [group(Law::Normal, 0.4)];
        let straight = [input(1.0, &[(0, 1.0)]), input(2.0, &[(1, 1.0)])];
        let nothing = (2, 0.0);
        let summed = [
            input(1.0, &[(0, 1.0), nothing]),
            input(2.0, &[(1, 1.0), nothing]),
        ];
        let expected = sample(&summed, &components, &group(), 1);
        assert_eq!(sample(&straight, &components, &group(), 1), expected);
        // One of them belongs to two inputs.
        let both = [straight[0].clone(), input(0.0, &[(0, 1.0), (1, 1.0)])];
        let found = sample(&both, &components, &group(), 1);
        assert_eq!(found[0], expected[0]);
    }

    #[test]
    fn a_multivariate_t_shares_its_chi_square() {
        let t = |scale| {
            Distribution::StudentT(StudentT {
                location: 0.0,
                scale,
                dof: 8.0,
            })
        };
        let components = [component("a", t(3.0), 3.0), component("b", t(1.0), 1.0)];
        let inputs = [input(0.0, &[(0, 1.0)]), input(0.0, &[(1, 1.0)])];
        let law = Law::StudentT {
            dof: 8.0,
            scale: vec![3.0, 1.0],
        };
        let x = sample(&inputs, &components, &[group(law, 0.5)], 32);
        assert!((correlation(&x[0], &x[1]) - 0.5).abs() < 0.01);
        // ν/(ν − 2) = 4/3.
        assert!((covariance(&x[0], &x[0]) - 12.0).abs() < 0.3);
        // One margin: P(|T| > t₀.₉₅(8) = 2.306) = 5 %.
        let out = x[1].iter().filter(|t| t.abs() > 2.306_004).count() as f64 / x[1].len() as f64;
        assert!((out - 0.05).abs() < 0.0015, "{out}");
        // Even uncorrelated members are dependent: cov(T1², T2²) > 0.
        let law = Law::StudentT {
            dof: 8.0,
            scale: vec![1.0, 1.0],
        };
        let x = sample(&inputs, &components, &[group(law, 0.0)], 16);
        let squares: Vec<Vec<f64>> = x
            .iter()
            .map(|c| c.iter().map(|v| v * v).collect())
            .collect();
        assert!(correlation(&squares[0], &squares[1]) > 0.05);
    }

    #[test]
    fn a_copula_keeps_the_margins() {
        // Two uniforms: product-moment r = (6/π) asin(ρ/2) for latent ρ.
        let components = [uniform("a", 1.0), uniform("b", 2.0)];
        let inputs = [input(0.0, &[(0, 1.0)]), input(0.0, &[(1, 1.0)])];
        let rho = 0.8;
        let law = Law::GaussianCopula { latent: pair(rho) };
        let x = sample(&inputs, &components, &[group(law, rho)], 8);
        let r = 6.0 / std::f64::consts::PI * (rho / 2.0_f64).asin();
        assert!((correlation(&x[0], &x[1]) - r).abs() < 0.01);
        assert!(x[1].iter().all(|v| v.abs() <= 2.0));
        assert!((covariance(&x[1], &x[1]) - 4.0 / 3.0).abs() < 0.02);
    }

    #[test]
    fn a_copula_of_normal_and_other_margins_skips_the_normal_one() {
        let shifted = Distribution::Exponential(Exponential {
            origin: -1.0,
            mean: 1.0,
        });
        let components = [normal("a", 2.0), component("b", shifted, 1.0)];
        let inputs = [input(0.0, &[(0, 1.0)]), input(0.0, &[(1, 1.0)])];
        let law = Law::GaussianCopula { latent: pair(1.0) };
        let x = sample(&inputs, &components, &[group(law, 1.0)], 2);
        // Full latent correlation: one is a rising function of the other, in closed form.
        for (a, b) in x[0].iter().zip(&x[1]).take(2000) {
            let expected = -1.0 - normal_sf(a / 2.0).ln();
            assert!(
                (b - expected).abs() < 1e-9 * expected.abs().max(1.0),
                "{a} {b} {expected}"
            );
        }
    }
}
