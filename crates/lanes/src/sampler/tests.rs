use statrs::distribution::{Beta, ContinuousCDF, Gamma, StudentsT};

use super::discrete::element;
use super::*;
use crate::testing::{same_on_all_levels, ulp};
use crate::{level, levels, moments};

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

/// A sampler, its distribution function, its expectation and its standard deviation.
struct Case {
    name: &'static str,
    sampler: Sampler,
    cdf: Box<dyn Fn(f64) -> f64>,
    mean: f64,
    sd: f64,
}

fn phi(z: f64) -> f64 {
    0.5 * libm::erfc(-z / 2_f64.sqrt())
}

/// The distribution function of a density that is linear from (−1, 0) up, level over a share
/// `beta` of the width, and linear down to (1, 0).
fn trapezoid(x: f64, beta: f64) -> f64 {
    if x > 0.0 {
        return 1.0 - trapezoid(-x, beta);
    }
    if x < -beta {
        (1.0 + x).powi(2) / (2.0 * (1.0 - beta) * (1.0 + beta))
    } else {
        0.5 + x / (1.0 + beta)
    }
}

/// The distribution function of h·V, h uniform on w ± d, V uniform on ±1.
fn curvilinear(x: f64, w: f64, d: f64) -> f64 {
    let y = x.abs();
    let inside = if y <= w - d {
        y * ((w + d) / (w - d)).ln() / (2.0 * d)
    } else if y < w + d {
        (y - (w - d) + y * ((w + d) / y).ln()) / (2.0 * d)
    } else {
        1.0
    };
    0.5 + 0.5 * inside.copysign(x)
}

fn student(dof: f64) -> Case {
    let exact = StudentsT::new(2.0, 0.5, dof).unwrap();
    Case {
        name: "Student t",
        sampler: Sampler::StudentT {
            location: 2.0,
            scale: 0.5,
            dof,
        },
        cdf: Box::new(move |x| exact.cdf(x)),
        mean: 2.0,
        sd: 0.5 * (dof / (dof - 2.0)).sqrt(),
    }
}

fn gamma(shape: f64) -> Case {
    let exact = Gamma::new(shape, 1.0).unwrap();
    Case {
        name: "gamma",
        sampler: Sampler::Gamma {
            origin: 1.0,
            shape,
            scale: 3.0,
        },
        cdf: Box::new(move |x| exact.cdf((x - 1.0) / 3.0)),
        mean: 1.0 + 3.0 * shape,
        sd: 3.0 * shape.sqrt(),
    }
}

fn beta(a: f64, b: f64) -> Case {
    let exact = Beta::new(a, b).unwrap();
    Case {
        name: "beta",
        sampler: Sampler::Beta {
            alpha: a,
            beta: b,
            lower: -1.0,
            upper: 4.0,
        },
        cdf: Box::new(move |x| exact.cdf(((x + 1.0) / 5.0).clamp(0.0, 1.0))),
        mean: -1.0 + 5.0 * a / (a + b),
        sd: 5.0 * (a * b / (a + b + 1.0)).sqrt() / (a + b),
    }
}

fn triangle(lower: f64, mode: f64, upper: f64) -> Case {
    let width = upper - lower;
    Case {
        name: "triangular",
        sampler: Sampler::Triangular { lower, mode, upper },
        cdf: Box::new(move |x| {
            if x < mode {
                (x - lower).powi(2) / (width * (mode - lower))
            } else {
                1.0 - (upper - x).powi(2) / (width * (upper - mode))
            }
        }),
        mean: (lower + mode + upper) / 3.0,
        sd: ((lower * lower + mode * mode + upper * upper
            - lower * mode
            - lower * upper
            - mode * upper)
            / 18.0)
            .sqrt(),
    }
}

/// Moments of JCGM 101, 6.4.
fn cases() -> Vec<Case> {
    let third = 1.0 / 3_f64.sqrt();
    let mut cases = vec![
        Case {
            name: "normal",
            sampler: Sampler::Normal {
                mean: -3.0,
                sd: 2.0,
            },
            cdf: Box::new(|x| phi((x + 3.0) / 2.0)),
            mean: -3.0,
            sd: 2.0,
        },
        Case {
            name: "uniform",
            sampler: Sampler::Uniform {
                lower: 2.0,
                upper: 5.0,
            },
            cdf: Box::new(|x| (x - 2.0) / 3.0),
            mean: 3.5,
            sd: 1.5 * third,
        },
        Case {
            name: "trapezoidal",
            sampler: Sampler::Trapezoidal {
                lower: -1.0,
                upper: 1.0,
                beta: 0.4,
            },
            cdf: Box::new(|x| trapezoid(x, 0.4)),
            mean: 0.0,
            sd: (1.16_f64 / 6.0).sqrt(),
        },
        Case {
            name: "curvilinear trapezoid",
            sampler: Sampler::CurvilinearTrapezoid {
                lower: 9.0,
                upper: 11.0,
                d: 0.5,
            },
            cdf: Box::new(|x| curvilinear(x - 10.0, 1.0, 0.5)),
            mean: 10.0,
            sd: (1.0_f64 / 3.0 + 0.25 / 9.0).sqrt(),
        },
        Case {
            name: "arcsine",
            sampler: Sampler::Arcsine {
                lower: 1.0,
                upper: 3.0,
            },
            cdf: Box::new(|x| 0.5 + (x - 2.0).asin() / std::f64::consts::PI),
            mean: 2.0,
            sd: 0.5_f64.sqrt(),
        },
        Case {
            name: "exponential",
            sampler: Sampler::Exponential {
                origin: 1.0,
                mean: 4.0,
            },
            cdf: Box::new(|x| -(-(x - 1.0) / 4.0).exp_m1()),
            mean: 5.0,
            sd: 4.0,
        },
        Case {
            name: "log-normal",
            sampler: Sampler::LogNormal {
                origin: -1.0,
                mu: 0.3,
                sigma: 0.4,
            },
            cdf: Box::new(|x| phi(((x + 1.0).ln() - 0.3) / 0.4)),
            mean: -1.0 + (0.3 + 0.08_f64).exp(),
            sd: (0.3 + 0.08_f64).exp() * 0.16_f64.exp_m1().sqrt(),
        },
        Case {
            name: "normal as the limit of t",
            sampler: Sampler::StudentT {
                location: 0.0,
                scale: 1.0,
                dof: f64::INFINITY,
            },
            cdf: Box::new(phi),
            mean: 0.0,
            sd: 1.0,
        },
        Case {
            name: "t with 10¹² degrees of freedom",
            sampler: Sampler::StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 1e12,
            },
            cdf: Box::new(phi),
            mean: 0.0,
            sd: 1.0,
        },
    ];
    cases.extend([1.0, 2.5, 5.0, 18.0, 400.0].map(student));
    cases.extend([0.5, 0.9, 1.0, 2.0, 7.5, 300.0].map(gamma));
    cases.extend([(0.5, 0.5), (0.5, 20.5), (2.0, 3.0), (40.0, 7.0)].map(|(a, b)| beta(a, b)));
    cases.extend(
        [
            (0.0, 1.0, 2.0),
            (0.0, 0.5, 3.0),
            (0.0, 0.0, 1.0),
            (-1.0, 2.0, 2.0),
        ]
        .map(|(lower, mode, upper)| triangle(lower, mode, upper)),
    );
    cases
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

/// A seed promises its numbers: whoever changes these lines changes every published result. That
/// the numbers are right is for the other tests to say.
#[test]
fn first_draws_never_change() {
    let promised = [
        (
            Sampler::Normal { mean: 0.0, sd: 1.0 },
            -1.8343497730272897,
            -1.7960520041924075,
        ),
        (
            Sampler::StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 4.0,
            },
            -2.9371290404509893,
            1.7640046403169067,
        ),
        (
            Sampler::Uniform {
                lower: 0.0,
                upper: 1.0,
            },
            0.08328046212704465,
            0.839615476204657,
        ),
        (
            Sampler::Triangular {
                lower: 0.0,
                mode: 0.25,
                upper: 1.0,
            },
            0.14429177222475692,
            0.6531738290634524,
        ),
        (
            Sampler::Trapezoidal {
                lower: 0.0,
                upper: 1.0,
                beta: 0.5,
            },
            0.09123504044257524,
            0.3113851269911634,
        ),
        (
            Sampler::CurvilinearTrapezoid {
                lower: 0.0,
                upper: 1.0,
                d: 0.125,
            },
            0.03490084516588652,
            0.8016242005807402,
        ),
        (
            Sampler::Arcsine {
                lower: -1.0,
                upper: 1.0,
            },
            -0.9659688027542226,
            0.8757240740949213,
        ),
        (
            Sampler::Exponential {
                origin: 0.0,
                mean: 1.0,
            },
            2.4855413056148765,
            0.17481125837484024,
        ),
        (
            Sampler::Gamma {
                origin: 0.0,
                shape: 0.5,
                scale: 1.0,
            },
            0.014493026346368667,
            0.1486530194512111,
        ),
        (
            Sampler::Gamma {
                origin: 0.0,
                shape: 2.5,
                scale: 1.0,
            },
            0.43288451147025475,
            0.813852881408486,
        ),
        (
            Sampler::LogNormal {
                origin: 0.0,
                mu: 0.0,
                sigma: 0.5,
            },
            0.39964649444402156,
            0.40737302005159015,
        ),
        (
            Sampler::Beta {
                alpha: 0.5,
                beta: 2.0,
                lower: 0.0,
                upper: 1.0,
            },
            0.014066309189337472,
            0.0515891223517291,
        ),
        (
            Sampler::discrete(&[1.0, 2.0, 3.0], &[0.2, 0.5, 0.3]),
            1.0,
            3.0,
        ),
        (
            Sampler::Empirical {
                sample: Arc::new([1.0, 5.0, 7.0, 8.0]),
            },
            1.0,
            8.0,
        ),
    ];
    for (sampler, first, last) in promised {
        let mut block = Block::ZERO;
        sampler.fill(level(), &mut Generator::new(1, 0, 0), &mut block);
        let found = [block.0[0], block.0[LANES - 1]];
        assert_eq!(found, [first, last], "{sampler:?}");
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
