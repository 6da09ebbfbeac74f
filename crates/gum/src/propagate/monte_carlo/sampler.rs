//! From a distribution to its block sampler.

use std::sync::Arc;

use gumption_lanes::Sampler;

use crate::distribution::Distribution;

/// The sampler that draws a distribution.
pub(super) fn sampler(distribution: &Distribution) -> Sampler {
    use Distribution as D;
    match *distribution {
        D::Normal { mean, sd } => Sampler::Normal { mean, sd },
        D::StudentT {
            location,
            scale,
            dof,
        } => Sampler::StudentT {
            location,
            scale,
            dof,
        },
        D::Uniform { lower, upper } => Sampler::Uniform { lower, upper },
        D::Triangular { lower, mode, upper } => Sampler::Triangular { lower, mode, upper },
        D::Trapezoidal { lower, upper, beta } => Sampler::Trapezoidal { lower, upper, beta },
        D::CurvilinearTrapezoid { lower, upper, d } => {
            Sampler::CurvilinearTrapezoid { lower, upper, d }
        }
        D::Arcsine { lower, upper } => Sampler::Arcsine { lower, upper },
        D::Exponential { origin, mean } => Sampler::Exponential { origin, mean },
        D::Gamma {
            origin,
            shape,
            scale,
        } => Sampler::Gamma {
            origin,
            shape,
            scale,
        },
        D::LogNormal { origin, mu, sigma } => Sampler::LogNormal { origin, mu, sigma },
        D::Beta {
            alpha,
            beta,
            lower,
            upper,
        } => Sampler::Beta {
            alpha,
            beta,
            lower,
            upper,
        },
        D::Discrete {
            ref values,
            ref probabilities,
        } => Sampler::discrete(values, probabilities),
        D::Empirical { ref sample } => Sampler::Empirical {
            sample: Arc::clone(sample),
        },
    }
}

#[cfg(test)]
mod tests {
    use gumption_lanes::{Block, Generator, LANES, level};

    use super::*;

    fn draw(distribution: &Distribution, blocks: usize) -> Vec<f64> {
        let sampler = sampler(distribution);
        let mut generator = Generator::new(3, 0, 0);
        let mut block = Block::ZERO;
        let mut values = Vec::with_capacity(blocks * LANES);
        for _ in 0..blocks {
            sampler.fill(level(), &mut generator, &mut block);
            values.extend_from_slice(&block.0);
        }
        values
    }

    /// Kolmogorov's distance between the draws and the distribution function, which is computed
    /// without any random number.
    #[test]
    fn draws_follow_the_distribution_function() {
        let cases = [
            Distribution::Normal { mean: 1.0, sd: 2.0 },
            Distribution::StudentT {
                location: -1.0,
                scale: 0.5,
                dof: 3.5,
            },
            Distribution::Uniform {
                lower: -1.0,
                upper: 4.0,
            },
            Distribution::Triangular {
                lower: 0.0,
                mode: 0.2,
                upper: 1.0,
            },
            Distribution::Trapezoidal {
                lower: -1.0,
                upper: 1.0,
                beta: 0.3,
            },
            Distribution::CurvilinearTrapezoid {
                lower: -1.0,
                upper: 1.0,
                d: 0.4,
            },
            Distribution::Arcsine {
                lower: 2.0,
                upper: 3.0,
            },
            Distribution::Exponential {
                origin: -1.0,
                mean: 2.0,
            },
            Distribution::Gamma {
                origin: 1.0,
                shape: 0.7,
                scale: 3.0,
            },
            Distribution::LogNormal {
                origin: 0.0,
                mu: 0.5,
                sigma: 0.8,
            },
            Distribution::Beta {
                alpha: 2.0,
                beta: 5.0,
                lower: -1.0,
                upper: 1.0,
            },
        ];
        for distribution in cases {
            let mut values = draw(&distribution, 200);
            values.sort_by(f64::total_cmp);
            let count = values.len() as f64;
            let distance = values
                .iter()
                .enumerate()
                .map(|(i, x)| ((i as f64 + 0.5) / count - distribution.cdf(*x)).abs())
                .fold(0.0, f64::max);
            // Exceeded by chance once in 30 000 cases.
            assert!(
                distance * count.sqrt() < 2.35,
                "{distribution:?}: {distance}"
            );
        }
    }

    #[test]
    fn tables_keep_their_probabilities() {
        let discrete = Distribution::Discrete {
            values: [1.0, 2.0, 5.0].into(),
            probabilities: [0.2, 0.5, 0.3].into(),
        };
        let values = draw(&discrete, 400);
        let share =
            |v: f64| values.iter().filter(|x| **x == v).count() as f64 / values.len() as f64;
        assert!((share(1.0) - 0.2).abs() < 0.005 && (share(5.0) - 0.3).abs() < 0.006);
        let sample = Distribution::Empirical {
            sample: [1.0, 2.0, 5.0, 9.0].into(),
        };
        let values = draw(&sample, 400);
        assert!((values.iter().sum::<f64>() / values.len() as f64 - 4.25).abs() < 0.05);
    }
}
