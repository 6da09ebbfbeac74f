use super::discrete::element;
use super::*;
use crate::testing::{same_on_all_levels, ulp};
use crate::{level, levels, moments};

mod cases;
mod promises;

use cases::cases;

/// Blocks of a test sample: about 2·10⁵ draws.
const BLOCKS: u64 = 800;

fn sample(sampler: &Sampler) -> Vec<f64> {
    let mut draws = Vec::new();
    let mut block = Block::ZERO;
    // Four streams, so that independence of streams is put to the test too.
    for stream in 0..4 {
        let mut generator = Generator::new(101, 0, stream);
        for _ in 0..BLOCKS / 4 {
            sampler.fill(level(), &mut generator, &mut block);
            draws.extend(block.0);
        }
    }
    draws
}

/// Kolmogorov and Smirnov: √n·D exceeds 2.23 once in 10⁴ samples.
#[test]
fn samples_follow_their_distribution_functions() {
    for case in cases() {
        let mut draws = sample(&case.sampler);
        draws.sort_by(f64::total_cmp);
        let n = draws.len() as f64;
        let distance = draws.iter().enumerate().fold(0.0_f64, |d, (i, &x)| {
            let f = (case.cdf)(x);
            d.max(f - i as f64 / n).max((i + 1) as f64 / n - f)
        });
        let (name, sampler) = (case.name, &case.sampler);
        assert!(distance * n.sqrt() < 2.23, "{name}: {distance} {sampler:?}");
    }
}

/// Mean and variance within 4.5 of their standard errors, as the sample itself shows them.
#[test]
fn samples_have_the_moments_of_their_distributions() {
    for case in cases() {
        if matches!(case.sampler, Sampler::StudentT { dof, .. } if dof < 5.0) {
            continue;
        }
        let draws = sample(&case.sampler);
        let n = draws.len() as f64;
        let mut sums = [0.0; 4];
        for block in draws.as_chunks::<LANES>().0 {
            let part = moments::accumulate(level(), &Block(*block), case.mean);
            sums = std::array::from_fn(|p| sums[p] + part[p]);
        }
        let [mean, variance, _, fourth] = sums.map(|s| s / n);
        let error_of_variance = ((fourth - variance * variance) / n).sqrt();
        let (name, sampler) = (case.name, &case.sampler);
        assert!(
            mean.abs() < 4.5 * case.sd / n.sqrt(),
            "{name}: mean off by {mean} {sampler:?}"
        );
        let off = variance - case.sd * case.sd;
        assert!(
            off.abs() < 4.5 * error_of_variance,
            "{name}: variance off by {off} {sampler:?}"
        );
    }
}

#[test]
fn draws_stay_within_their_limits() {
    for case in cases() {
        let (lower, upper) = match case.sampler {
            Sampler::Uniform { lower, upper }
            | Sampler::Triangular { lower, upper, .. }
            | Sampler::Trapezoidal { lower, upper, .. }
            | Sampler::Arcsine { lower, upper }
            | Sampler::Beta { lower, upper, .. } => (lower, upper),
            Sampler::CurvilinearTrapezoid { lower, upper, d } => (lower - d, upper + d),
            Sampler::Exponential { origin, .. }
            | Sampler::Gamma { origin, .. }
            | Sampler::LogNormal { origin, .. } => (origin, f64::MAX),
            _ => (-f64::MAX, f64::MAX),
        };
        let sampler = &case.sampler;
        assert!(
            sample(sampler).iter().all(|x| (lower..=upper).contains(x)),
            "{sampler:?}"
        );
    }
}

#[test]
fn degenerate_shapes_give_numbers() {
    for sampler in [
        Sampler::Beta {
            alpha: 1e-4,
            beta: 1e-4,
            lower: 0.0,
            upper: 1.0,
        },
        Sampler::Gamma {
            origin: 0.0,
            shape: 1e-4,
            scale: 1.0,
        },
        Sampler::Gamma {
            origin: 0.0,
            shape: 1e12,
            scale: 1.0,
        },
        Sampler::Normal { mean: 5.0, sd: 0.0 },
        Sampler::Trapezoidal {
            lower: 0.0,
            upper: 1.0,
            beta: 0.0,
        },
        Sampler::Trapezoidal {
            lower: 0.0,
            upper: 1.0,
            beta: 1.0,
        },
        Sampler::CurvilinearTrapezoid {
            lower: 0.0,
            upper: 1.0,
            d: 0.0,
        },
    ] {
        assert!(
            sample(&sampler).iter().all(|x| x.is_finite()),
            "{sampler:?}"
        );
    }
    // A beta variable with tiny shapes is a coin: mean one half.
    let coin = Sampler::Beta {
        alpha: 1e-4,
        beta: 1e-4,
        lower: 0.0,
        upper: 1.0,
    };
    let draws = sample(&coin);
    let mean = draws.iter().sum::<f64>() / draws.len() as f64;
    assert!((mean - 0.5).abs() < 4.5 * 0.5 / (draws.len() as f64).sqrt());
}

/// χ² of the counts against the probabilities, as a standard normal variable (Wilson-Hilferty).
fn chi_square_z(draws: &[f64], values: &[f64], probabilities: &[f64]) -> f64 {
    let n = draws.len() as f64;
    let chi_square: f64 = values
        .iter()
        .zip(probabilities)
        .map(|(v, p)| {
            let count = draws.iter().filter(|x| *x == v).count() as f64;
            if *p == 0.0 {
                assert_eq!(count, 0.0);
                return 0.0;
            }
            (count - n * p).powi(2) / (n * p)
        })
        .sum();
    let dof = probabilities.iter().filter(|p| **p > 0.0).count() as f64 - 1.0;
    let spread = 2.0 / (9.0 * dof);
    ((chi_square / dof).cbrt() - (1.0 - spread)) / spread.sqrt()
}

#[test]
fn discrete_values_come_with_their_probabilities() {
    let values = [-1.0, 0.5, 2.0, 3.0, 10.0, 11.0, 12.0];
    let probabilities = [0.05, 0.0, 0.4, 0.25, 0.001, 0.199, 0.1];
    let draws = sample(&Sampler::discrete(&values, &probabilities));
    assert!(draws.iter().all(|x| values.contains(x)));
    assert!(chi_square_z(&draws, &values, &probabilities) < 3.7);
    // Probabilities in proportion, and a single value.
    let draws = sample(&Sampler::discrete(&[1.0, 2.0], &[6.0, 2.0]));
    assert!(chi_square_z(&draws, &[1.0, 2.0], &[0.75, 0.25]) < 3.7);
    assert!(
        sample(&Sampler::discrete(&[4.0], &[1.0]))
            .iter()
            .all(|x| *x == 4.0)
    );
}

#[test]
fn empirical_draws_are_uniform_over_the_sample() {
    let values: Vec<f64> = (0..37).map(f64::from).collect();
    let draws = sample(&Sampler::Empirical {
        sample: values.clone().into(),
    });
    assert!(chi_square_z(&draws, &values, &[1.0 / 37.0; 37]) < 3.7);
}

#[test]
fn empty_lists_give_nan_and_constants_themselves() {
    assert!(
        sample(&Sampler::Empirical {
            sample: Arc::new([])
        })
        .iter()
        .all(|x| x.is_nan())
    );
    assert!(
        sample(&Sampler::discrete(&[], &[]))
            .iter()
            .all(|x| x.is_nan())
    );
    assert!(sample(&Sampler::Constant(1.5)).iter().all(|x| *x == 1.5));
}

#[test]
fn element_never_runs_over_the_end() {
    let below_one = 1.0 - f64::EPSILON / 2.0;
    for n in [1, 2, 3, 7, 1000, 4097] {
        let list: Vec<usize> = (0..n).collect();
        assert_eq!(element(&list, below_one), Some(n - 1));
        assert_eq!(element(&list, f64::EPSILON / 2.0), Some(0));
    }
}

/// Both halves of a Box-Muller block, from the words behind them and by the system's own functions.
#[test]
fn normals_are_box_muller_of_the_words() {
    let mut generator = Generator::new(7, 8, 9);
    let mut words = [[0; LANES]; 2];
    let mut z = Block::ZERO;
    let mut again = generator.clone();
    words
        .iter_mut()
        .for_each(|words| again.bits(level(), words));
    normal_block(level(), &mut generator, &mut z);
    // Rows of 16 words give radii and angles in turn.
    let rows = words
        .as_flattened()
        .chunks_exact(32)
        .map(|rows| rows.split_at(16));
    let pairs = rows.flat_map(|(radii, angles)| radii.iter().zip(angles));
    for (lane, (a, b)) in pairs.take(LANES / 2).enumerate() {
        let unit = |word: u64| ((word >> 12) as f64 + 0.5) * 2_f64.powi(-52);
        let radius = (-2.0 * unit(*a).ln()).sqrt();
        let turn = ((b >> 13) as f64 + 0.5) * 2_f64.powi(-51) - 0.5;
        let (sin, cos) = (turn * std::f64::consts::FRAC_PI_2).sin_cos();
        let (x, y) = if b & 1 == 1 { (sin, cos) } else { (cos, sin) };
        let sign = |bit: u64| if b & bit == 0 { radius } else { -radius };
        for (found, exact) in [
            (z.0[lane], x * sign(2)),
            (z.0[lane + LANES / 2], y * sign(4)),
        ] {
            assert!((found - exact).abs() < 3.0 * ulp(radius), "{found} {exact}");
        }
    }
    // The two halves, and neighbouring blocks, are uncorrelated.
    let draws = sample(&Sampler::Normal { mean: 0.0, sd: 1.0 });
    for lag in [1, 16, LANES / 2, LANES] {
        let n = (draws.len() - lag) as f64;
        let r = draws
            .iter()
            .zip(&draws[lag..])
            .map(|(a, b)| a * b)
            .sum::<f64>()
            / n;
        assert!(r.abs() < 4.5 / n.sqrt(), "lag {lag}: {r}");
    }
}

#[test]
fn gamma_block_makes_chi_square() {
    let mut generator = Generator::new(3, 0, 0);
    let mut draws = Block::ZERO;
    let dof = 9.0;
    let mut sum = 0.0;
    for _ in 0..BLOCKS {
        gamma_block(level(), &mut generator, dof / 2.0, &mut draws);
        sum += 2.0 * draws.0.iter().sum::<f64>();
    }
    let n = (BLOCKS * LANES as u64) as f64;
    assert!((sum / n - dof).abs() < 4.5 * (2.0 * dof / n).sqrt());
}

#[test]
fn every_level_draws_the_same_bits() {
    let tables = [
        Sampler::discrete(&[1.0, 2.0, 3.0], &[0.2, 0.5, 0.3]),
        Sampler::Empirical {
            sample: Arc::new([1.0, 5.0, 7.0]),
        },
    ];
    for sampler in cases().into_iter().map(|case| case.sampler).chain(tables) {
        same_on_all_levels(&format!("{sampler:?}"), |level, out| {
            let mut generator = Generator::new(1, 2, 3);
            for _ in 0..5 {
                sampler.fill(level, &mut generator, out);
            }
        });
        // The generator stands at the same place too.
        let ends: Vec<Generator> = levels()
            .into_iter()
            .map(|level| {
                let mut generator = Generator::new(1, 2, 3);
                let mut block = Block::ZERO;
                sampler.fill(level, &mut generator, &mut block);
                generator
            })
            .collect();
        assert!(ends.iter().all(|g| *g == ends[0]));
    }
}

/// How fast the samplers are here: `cargo test -p gumption-lanes -- --ignored --nocapture speed`.
#[test]
#[ignore = "a measurement"]
fn speed() {
    for level in levels() {
        for case in cases() {
            let mut generator = Generator::new(1, 0, 0);
            let mut block = Block::ZERO;
            let rate = (0..5).fold(0.0_f64, |best, _| {
                let start = std::time::Instant::now();
                for _ in 0..4000 {
                    case.sampler
                        .fill(level, &mut generator, std::hint::black_box(&mut block));
                }
                best.max(4000.0 * LANES as f64 / start.elapsed().as_secs_f64() / 1e6)
            });
            println!("{level:?}: {rate:6.0} M/s {:?}", case.sampler);
        }
    }
}
