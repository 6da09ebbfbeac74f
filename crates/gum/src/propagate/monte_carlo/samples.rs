//! Known samples and parts of budgets for the tests of this chapter; the samples are independent of the
//! engine's own generators.

use gumption_lanes::{Block, LANES};

use super::engine::Source;
use crate::budget::{Component, Evaluation, Input, Owner, Term};
use gumption_core::distribution::{
    Arcsine, Beta, CurvilinearTrapezoid, Distribution, Exponential, Gamma, LogNormal, Normal,
    StudentT, Trapezoidal, Triangular, Uniform,
};
use gumption_core::quantity::Unit;

/// SplitMix64 with the usual transforms.
pub(super) struct Stream(u64);

impl Stream {
    pub(super) fn new(seed: u64) -> Self {
        Stream(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5851_F42D_4C95_7F2D)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform on the open interval (0, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        ((self.next() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Standard normal (Box–Muller, one of the pair).
    pub(super) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// Student's t with ν degrees of freedom (Bailey's polar form).
    pub(super) fn student_t(&mut self, dof: f64) -> f64 {
        let u = self.uniform();
        let radius = (dof * (u.powf(-2.0 / dof) - 1.0)).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

type Draw = dyn Fn(&mut Stream, &mut [f64]) + Sync;

/// A source of trials from a closure that fills one trial of all outputs.
pub(super) struct Sampled {
    seed: u64,
    outputs: usize,
    draw: Box<Draw>,
}

impl Sampled {
    pub(super) fn new(
        seed: u64,
        outputs: usize,
        draw: impl Fn(&mut Stream, &mut [f64]) + Sync + 'static,
    ) -> Self {
        Sampled {
            seed,
            outputs,
            draw: Box::new(draw),
        }
    }

    /// Independent standard normal outputs.
    pub(super) fn normal(seed: u64, outputs: usize) -> Self {
        Sampled::new(seed, outputs, |stream, values| {
            for value in values {
                *value = stream.normal();
            }
        })
    }
}

impl Source for Sampled {
    type Worker = (Stream, Vec<f64>);

    fn outputs(&self) -> usize {
        self.outputs
    }

    fn worker(&self) -> Self::Worker {
        (Stream::new(0), vec![0.0; self.outputs])
    }

    fn start(&self, (stream, _): &mut Self::Worker, chunk: u64) {
        *stream = Stream::new(self.seed.wrapping_mul(1_000_003).wrapping_add(chunk));
    }

    fn next(&self, (stream, trial): &mut Self::Worker, outputs: &mut [Block]) {
        for lane in 0..LANES {
            (self.draw)(stream, trial);
            for (block, value) in outputs.iter_mut().zip(trial.iter()) {
                block.0[lane] = *value;
            }
        }
    }
}

/// A component of a source of its own.
pub(super) fn component(name: &str, distribution: Distribution, u: f64) -> Component {
    Component {
        name: name.into(),
        label: name.into(),
        owner: Owner::Source(name.into()),
        unit: Unit::one(),
        distribution,
        u,
        dof: f64::INFINITY,
        evaluation: Evaluation::TypeB,
        how: String::new().into(),
        certificate: None,
        reference: None,
    }
}

/// An input with its (component, coefficient) pairs.
pub(super) fn input(estimate: f64, terms: &[(usize, f64)]) -> Input {
    Input {
        name: "X".into(),
        description: None,
        group: None,
        unit: Unit::one(),
        estimate,
        terms: terms
            .iter()
            .map(|&(component, coefficient)| Term {
                component,
                coefficient,
            })
            .collect(),
    }
}

/// A distribution of every kind that has a quantile function.
pub(super) fn kinds() -> Vec<Distribution> {
    vec![
        Distribution::Normal(Normal { mean: 0.0, sd: 2.0 }),
        Distribution::StudentT(StudentT {
            location: 0.0,
            scale: 0.5,
            dof: 3.0,
        }),
        Distribution::StudentT(StudentT {
            location: 0.0,
            scale: 0.5,
            dof: 50.0,
        }),
        Distribution::Uniform(Uniform {
            lower: -1.0,
            upper: 1.0,
        }),
        Distribution::Triangular(Triangular {
            lower: -1.0,
            mode: 0.5,
            upper: 2.0,
        }),
        Distribution::Trapezoidal(Trapezoidal {
            lower: -1.0,
            upper: 1.0,
            beta: 0.3,
        }),
        Distribution::CurvilinearTrapezoid(CurvilinearTrapezoid {
            lower: -1.0,
            upper: 1.0,
            d: 0.4,
        }),
        Distribution::Arcsine(Arcsine {
            lower: -1.0,
            upper: 1.0,
        }),
        Distribution::Exponential(Exponential {
            origin: -2.0,
            mean: 2.0,
        }),
        Distribution::Gamma(Gamma {
            origin: 0.0,
            shape: 2.5,
            scale: 0.4,
        }),
        Distribution::LogNormal(LogNormal {
            origin: 0.0,
            mu: 0.0,
            sigma: 0.3,
        }),
        Distribution::Beta(Beta {
            alpha: 2.0,
            beta: 3.0,
            lower: 0.0,
            upper: 1.0,
        }),
    ]
}
