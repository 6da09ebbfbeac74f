//! Moments against quadrature of the quantile function, quantiles against distribution functions,
//! and the images of every kind.

use super::*;
use crate::special::gauss_legendre;

/// One or more of every kind.
fn zoo() -> Vec<Distribution> {
    use Distribution as D;
    vec![
        D::Normal(Normal {
            mean: 3.0,
            sd: 0.25,
        }),
        D::StudentT(StudentT {
            location: -1.0,
            scale: 0.5,
            dof: 5.5,
        }),
        D::StudentT(StudentT {
            location: -1.0,
            scale: 0.5,
            dof: 40.0,
        }),
        D::StudentT(StudentT {
            location: -1.0,
            scale: 0.5,
            dof: f64::INFINITY,
        }),
        D::Uniform(Uniform {
            lower: -1.0,
            upper: 5.0,
        }),
        D::Triangular(Triangular {
            lower: -3.0,
            mode: -1.0,
            upper: 1.0,
        }),
        D::Triangular(Triangular {
            lower: 0.0,
            mode: 0.3,
            upper: 2.0,
        }),
        D::Triangular(Triangular {
            lower: 0.0,
            mode: 0.0,
            upper: 2.0,
        }),
        D::Triangular(Triangular {
            lower: 0.0,
            mode: 2.0,
            upper: 2.0,
        }),
        D::Trapezoidal(Trapezoidal {
            lower: -1.0,
            upper: 3.0,
            beta: 0.4,
        }),
        D::Trapezoidal(Trapezoidal {
            lower: -1.0,
            upper: 3.0,
            beta: 0.0,
        }),
        D::Trapezoidal(Trapezoidal {
            lower: -1.0,
            upper: 3.0,
            beta: 1.0,
        }),
        D::CurvilinearTrapezoid(CurvilinearTrapezoid {
            lower: 9.5,
            upper: 10.5,
            d: 0.05,
        }),
        D::CurvilinearTrapezoid(CurvilinearTrapezoid {
            lower: 9.5,
            upper: 10.5,
            d: 0.5,
        }),
        D::CurvilinearTrapezoid(CurvilinearTrapezoid {
            lower: 9.5,
            upper: 10.5,
            d: 0.0,
        }),
        D::Arcsine(Arcsine {
            lower: -1.0,
            upper: 2.0,
        }),
        D::Exponential(Exponential {
            origin: 0.5,
            mean: 4.0,
        }),
        D::Gamma(Gamma {
            origin: 0.0,
            shape: 4.0,
            scale: 1.0,
        }),
        D::Gamma(Gamma {
            origin: 1.0,
            shape: 0.4,
            scale: 2.0,
        }),
        D::LogNormal(LogNormal {
            origin: 0.2,
            mu: 0.1,
            sigma: 0.3,
        }),
        D::Beta(Beta {
            alpha: 2.0,
            beta: 3.5,
            lower: 1.0,
            upper: 4.0,
        }),
        D::Beta(Beta {
            alpha: 0.6,
            beta: 0.9,
            lower: 1.0,
            upper: 4.0,
        }),
        D::Discrete(Discrete {
            values: [1.0, 2.0, 5.0].into(),
            probabilities: [0.2, 0.5, 0.3].into(),
        }),
        D::Empirical(Empirical {
            sample: [1.0, 1.5, 1.5, 4.0, 9.0].into(),
        }),
    ]
}

fn continuous() -> impl Iterator<Item = Distribution> {
    zoo().into_iter().filter(|d| !has_steps(d))
}

fn has_steps(d: &Distribution) -> bool {
    matches!(d, Distribution::Discrete(_) | Distribution::Empirical(_))
}

fn close(found: f64, expected: f64, tolerance: f64, what: &dyn std::fmt::Debug) {
    let error = (found - expected).abs();
    assert!(
        error <= tolerance * expected.abs().max(1e-3),
        "{what:?}: {found}, not {expected}"
    );
}

/// Values x = F⁻¹(p) with weights, so that E g(X) = ∫ g(F⁻¹(p)) dp = Σ w g(x).
///
/// Near both ends in panels that halve, because F⁻¹ may be singular there.
fn quadrature(d: &Distribution) -> Vec<(f64, f64)> {
    let mut nodes = Vec::new();
    let mut high = 0.5;
    for _ in 0..60 {
        let low = 0.5 * high;
        // Four parts each, for the kinks.
        for part in 0..4 {
            let edge = |n: i32| low + (high - low) * 0.25 * f64::from(n);
            for (p, weight) in gauss_legendre(edge(part), edge(part + 1)) {
                nodes.push((d.quantile(p), weight));
                nodes.push((d.upper_quantile(p), weight));
            }
        }
        high = low;
    }
    nodes
}

#[test]
fn moments_agree_with_quadrature() {
    for d in continuous() {
        let nodes = quadrature(&d);
        let expectation = |g: &dyn Fn(f64) -> f64| nodes.iter().map(|(x, w)| w * g(*x)).sum();
        let mean = d.mean().unwrap();
        close(expectation(&|x| x), mean, 1e-6, &d);
        let moment = |order| expectation(&|x| (x - mean).powi(order));
        let variance = d.variance().unwrap();
        close(moment(2), variance, 1e-5, &d);
        close(d.standard_deviation().unwrap().powi(2), variance, 1e-14, &d);
        close(moment(3), d.third_central_moment().unwrap(), 1e-4, &d);
        close(moment(4), d.fourth_central_moment().unwrap(), 1e-4, &d);
    }
}

/// The figures of JCGM 101:2008, 6.4, for these parameters.
#[test]
fn moments_of_jcgm_101_6_4() {
    use Distribution as D;
    let figures = [
        (
            D::Uniform(Uniform {
                lower: -1.0,
                upper: 5.0,
            }),
            2.0,
            3.0,
        ),
        (
            D::Trapezoidal(Trapezoidal {
                lower: -1.0,
                upper: 3.0,
                beta: 0.4,
            }),
            1.0,
            0.773_333_333_333_333_3,
        ),
        (
            D::Triangular(Triangular {
                lower: -3.0,
                mode: -1.0,
                upper: 1.0,
            }),
            -1.0,
            0.666_666_666_666_666_6,
        ),
        (
            D::Arcsine(Arcsine {
                lower: -1.0,
                upper: 2.0,
            }),
            0.5,
            1.125,
        ),
        (
            D::CurvilinearTrapezoid(CurvilinearTrapezoid {
                lower: 9.5,
                upper: 10.5,
                d: 0.05,
            }),
            10.0,
            0.083_611_111_111_111_11,
        ),
        (
            D::StudentT(StudentT {
                location: 5.0,
                scale: 2.0,
                dof: 6.0,
            }),
            5.0,
            6.0,
        ),
        (
            D::Exponential(Exponential {
                origin: 0.0,
                mean: 4.0,
            }),
            4.0,
            16.0,
        ),
        (
            D::Gamma(Gamma {
                origin: 0.0,
                shape: 4.0,
                scale: 1.0,
            }),
            4.0,
            4.0,
        ),
    ];
    for (d, mean, variance) in figures {
        close(d.mean().unwrap(), mean, 1e-15, &d);
        close(d.variance().unwrap(), variance, 1e-14, &d);
    }
}

#[test]
fn moments_of_finitely_many_values() {
    let d = Distribution::Discrete(Discrete {
        values: [1.0, 2.0, 5.0].into(),
        probabilities: [0.2, 0.5, 0.3].into(),
    });
    close(d.mean().unwrap(), 2.7, 1e-15, &d);
    close(d.variance().unwrap(), 2.41, 1e-14, &d);
    // 0.2·(−1.7)³ + 0.5·(−0.7)³ + 0.3·2.3³
    close(d.third_central_moment().unwrap(), 2.496, 1e-14, &d);
    let d = Distribution::Empirical(Empirical {
        sample: [1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0].into(),
    });
    close(d.mean().unwrap(), 1e9 + 2.0, 1e-16, &d);
    close(d.variance().unwrap(), 2.0 / 3.0, 1e-14, &d);
}

#[test]
fn moments_that_do_not_exist() {
    let t = |dof| {
        Distribution::StudentT(StudentT {
            location: 0.0,
            scale: 1.0,
            dof,
        })
    };
    assert_eq!(t(1.0).mean(), None);
    assert_eq!(t(2.0).variance(), None);
    assert_eq!(t(2.0).standard_deviation(), None);
    assert_eq!(t(3.0).third_central_moment(), None);
    assert_eq!(t(4.0).fourth_central_moment(), None);
}

#[test]
fn quantile_inverts_the_distribution_function() {
    for d in continuous() {
        for p in [1e-12, 1e-5, 0.01, 0.1, 0.3, 0.5, 0.7, 0.95, 0.999] {
            let (lower, upper) = d.support();
            // Near an end of the support x has no digits left to carry p.
            let (low, high) = (d.quantile(p), d.upper_quantile(p));
            if low - lower > 1e-7 {
                assert!((d.cdf(low) / p - 1.0).abs() < 1e-6, "{d:?} {p}");
            }
            if upper - high > 1e-7 {
                assert!((d.sf(high) / p - 1.0).abs() < 1e-6, "{d:?} {p}");
            }
            close(d.sf(d.quantile(p)), 1.0 - p, 1e-9, &(&d, p));
            close(d.quantile(p), d.upper_quantile(1.0 - p), 1e-4, &(&d, p));
        }
    }
}

#[test]
fn ends_of_the_support() {
    for d in zoo() {
        let (lower, upper) = d.support();
        assert_eq!(d.quantile(0.0), lower, "{d:?}");
        assert_eq!(d.quantile(1.0), upper, "{d:?}");
        assert_eq!(d.upper_quantile(0.0), upper, "{d:?}");
        assert_eq!(d.upper_quantile(1.0), lower, "{d:?}");
        assert_eq!(d.cdf(upper + 1.0), 1.0, "{d:?}");
        assert_eq!(d.cdf(lower - 1.0), 0.0, "{d:?}");
        assert_eq!(d.sf(lower - 1.0), 1.0, "{d:?}");
        assert!(d.quantile(1.1).is_nan());
        assert!(d.upper_quantile(-0.1).is_nan());
    }
}

#[test]
fn quantile_of_finitely_many_values() {
    let d = Distribution::Discrete(Discrete {
        values: [1.0, 2.0, 5.0].into(),
        probabilities: [0.2, 0.5, 0.3].into(),
    });
    let found = [0.1, 0.2, 0.21, 0.7, 0.71].map(|p| d.quantile(p));
    assert_eq!(found, [1.0, 1.0, 2.0, 2.0, 5.0]);
    assert_eq!([0.3, 0.31].map(|q| d.upper_quantile(q)), [5.0, 2.0]);
    assert_eq!(d.cdf(2.0), 0.7);
    assert_eq!(d.cdf(1.99), 0.2);
    let d = Distribution::Empirical(Empirical {
        sample: [1.0, 2.0, 3.0, 4.0].into(),
    });
    assert_eq!(
        [0.25, 0.26, 0.75, 0.76].map(|p| d.quantile(p)),
        [1.0, 2.0, 3.0, 4.0]
    );
    assert_eq!([0.25, 0.26].map(|q| d.upper_quantile(q)), [4.0, 3.0]);
    assert_eq!(d.cdf(2.5), 0.5);
}

#[test]
fn affine_images() {
    for d in zoo() {
        let shifted = d.shifted(2.5);
        let stretched = d.scaled(3.0).unwrap();
        shifted.validate().unwrap();
        stretched.validate().unwrap();
        for p in [0.03, 0.33, 0.5, 0.91] {
            close(shifted.quantile(p), d.quantile(p) + 2.5, 1e-12, &d);
            close(stretched.quantile(p), 3.0 * d.quantile(p), 1e-12, &d);
        }
        assert_eq!(d.scaled(0.0), None);
        let Some(mirrored) = d.scaled(-2.0) else {
            assert!(d.support().1.is_infinite());
            continue;
        };
        mirrored.validate().unwrap();
        for p in [0.03, 0.33, 0.52, 0.91] {
            close(mirrored.quantile(p), -2.0 * d.upper_quantile(p), 1e-12, &d);
        }
        close(
            mirrored.variance().unwrap(),
            4.0 * d.variance().unwrap(),
            1e-12,
            &d,
        );
        close(
            mirrored.third_central_moment().unwrap(),
            -8.0 * d.third_central_moment().unwrap(),
            1e-12,
            &d,
        );
    }
}

#[test]
fn what_is_normal_is_seen() {
    assert!(Distribution::Normal(Normal { mean: 0.0, sd: 1.0 }).is_normal());
    let empirical = Empirical {
        sample: [1.0, 2.0, 4.0, 5.0].into(),
    };
    assert!(!Distribution::Empirical(empirical).is_normal());
}

#[test]
fn validity() {
    use Distribution as D;
    for d in zoo() {
        assert_eq!(d.validate(), Ok(()), "{d:?}");
        let kind = d.kind();
        assert!(kind.describe().starts_with(kind.name_en));
        assert!(!kind.name_zh.is_empty());
    }
    let faults = [
        (
            D::Normal(Normal {
                mean: 0.0,
                sd: -1.0,
            }),
            "`sd` is -1",
        ),
        (
            D::Normal(Normal {
                mean: f64::NAN,
                sd: 1.0,
            }),
            "`mean` is NaN",
        ),
        (
            D::StudentT(StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 0.0,
            }),
            "`dof` is 0",
        ),
        (
            D::Uniform(Uniform {
                lower: 2.0,
                upper: 2.0,
            }),
            "the lower limit 2 must be below",
        ),
        (
            D::Triangular(Triangular {
                lower: 0.0,
                mode: 3.0,
                upper: 2.0,
            }),
            "`mode` is 3, but must be from 0",
        ),
        (
            D::Trapezoidal(Trapezoidal {
                lower: 0.0,
                upper: 2.0,
                beta: 1.2,
            }),
            "must be from 0 to 1",
        ),
        (
            D::CurvilinearTrapezoid(CurvilinearTrapezoid {
                lower: 0.0,
                upper: 2.0,
                d: 1.2,
            }),
            "must be from 0 to 1",
        ),
        (
            D::Exponential(Exponential {
                origin: 0.0,
                mean: 0.0,
            }),
            "`mean` is 0",
        ),
        (
            D::Gamma(Gamma {
                origin: 0.0,
                shape: 0.0,
                scale: 1.0,
            }),
            "`shape` is 0",
        ),
        (
            D::LogNormal(LogNormal {
                origin: 0.0,
                mu: 0.0,
                sigma: 0.0,
            }),
            "`sigma` is 0",
        ),
        (
            D::Beta(Beta {
                alpha: 1.0,
                beta: -2.0,
                lower: 0.0,
                upper: 1.0,
            }),
            "`beta` is -2",
        ),
        (
            D::Empirical(Empirical { sample: [].into() }),
            "the sample is empty",
        ),
        (
            D::Empirical(Empirical {
                sample: [2.0, 1.0].into(),
            }),
            "2 comes before 1",
        ),
        (
            D::Discrete(Discrete {
                values: [1.0, 2.0].into(),
                probabilities: [0.5, 0.4].into(),
            }),
            "is 0.9, but must be numbers that sum to 1",
        ),
        (
            D::Discrete(Discrete {
                values: [1.0, 2.0].into(),
                probabilities: [1.0].into(),
            }),
            "there are 2 values but 1 probabilities",
        ),
    ];
    for (d, expected) in faults {
        let found = d.validate().unwrap_err().to_string();
        assert!(found.contains(expected), "{found}");
    }
}

#[test]
fn names_are_unique() {
    let mut names: Vec<&str> = KINDS
        .iter()
        .flat_map(|kind| kind.aliases.iter().copied().chain([kind.key]))
        .collect();
    let all = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all);
    let key = |name| kind_named(name).map(|kind| kind.key);
    assert_eq!(key("Rectangular"), Some("uniform"));
    assert_eq!(key("u shaped"), Some("arcsine"));
    assert_eq!(key("cauchy"), None);
}

/// Kolmogorov's distance between draws and the distribution function times √n; it exceeds 2.35 once in 30 000 cases.
fn kolmogorov(d: &Distribution, mut draws: Vec<f64>) -> f64 {
    draws.sort_by(f64::total_cmp);
    let n = draws.len() as f64;
    let distance = draws.iter().enumerate().fold(0.0_f64, |most, (i, x)| {
        most.max(((i as f64 + 0.5) / n - d.cdf(*x)).abs())
    });
    distance * n.sqrt()
}

/// Draws in blocks, through the quantile in blocks, and one by one through the traits of `rand`.
#[test]
fn draws_follow_the_distribution_function() {
    use gumption_lanes::{Block, Generator, LANES, Words, level};
    use rand::SeedableRng;
    use rand_distr::Distribution as _;

    for (index, d) in zoo().into_iter().enumerate() {
        let own = d.clone();
        let inverse = Sampler::inverse(move |u| own.quantile(u));
        for sampler in [d.sampler(), inverse] {
            let mut generator = Generator::new(3, 0, index as u64);
            let mut block = Block::ZERO;
            let mut draws = Vec::new();
            for _ in 0..60 {
                sampler.fill(level(), &mut generator, &mut block);
                draws.extend_from_slice(&block.0);
            }
            if has_steps(&d) {
                let mean = draws.iter().sum::<f64>() / draws.len() as f64;
                let error = d.standard_deviation().unwrap() / (draws.len() as f64).sqrt();
                assert!(
                    (mean - d.mean().unwrap()).abs() < 4.5 * error,
                    "{d:?}: {mean}"
                );
            } else {
                assert!(kolmogorov(&d, draws) < 2.35, "{d:?} {sampler:?}");
            }
        }
        let words = Words::seed_from_u64(index as u64);
        let draws: Vec<f64> = (&d).sample_iter(words).take(40 * LANES).collect();
        if !has_steps(&d) {
            assert!(kolmogorov(&d, draws) < 2.35, "{d:?}");
        }
    }
}

/// Quantiles against those of another library.
#[test]
fn quantiles_agree_with_statrs() {
    use statrs::distribution as peer;
    use statrs::distribution::ContinuousCDF;

    type Cdf = Box<dyn Fn(f64) -> f64>;
    let pairs: [(Distribution, Cdf); 6] = [
        (Normal { mean: 1.0, sd: 2.0 }.into(), {
            let peer = peer::Normal::new(1.0, 2.0).unwrap();
            Box::new(move |x| peer.cdf(x))
        }),
        (
            StudentT {
                location: -1.0,
                scale: 0.5,
                dof: 5.5,
            }
            .into(),
            {
                let peer = peer::StudentsT::new(-1.0, 0.5, 5.5).unwrap();
                Box::new(move |x| peer.cdf(x))
            },
        ),
        (
            Triangular {
                lower: 0.0,
                mode: 0.3,
                upper: 2.0,
            }
            .into(),
            {
                let peer = peer::Triangular::new(0.0, 2.0, 0.3).unwrap();
                Box::new(move |x| peer.cdf(x))
            },
        ),
        (
            Exponential {
                origin: 0.0,
                mean: 4.0,
            }
            .into(),
            {
                let peer = peer::Exp::new(0.25).unwrap();
                Box::new(move |x| peer.cdf(x))
            },
        ),
        (
            Gamma {
                origin: 0.0,
                shape: 2.5,
                scale: 2.0,
            }
            .into(),
            {
                let peer = peer::Gamma::new(2.5, 0.5).unwrap();
                Box::new(move |x| peer.cdf(x))
            },
        ),
        (
            Beta {
                alpha: 2.0,
                beta: 3.5,
                lower: 0.0,
                upper: 1.0,
            }
            .into(),
            {
                let peer = peer::Beta::new(2.0, 3.5).unwrap();
                Box::new(move |x| peer.cdf(x))
            },
        ),
    ];
    for (d, peer) in pairs {
        for p in [0.001, 0.05, 0.3, 0.5, 0.8, 0.99] {
            close(peer(d.quantile(p)), p, 1e-8, &d);
        }
    }
}

/// Adding a distribution takes its own file and its line of the registry: no other file names one, except where a
/// rule of the guides does.
#[test]
fn a_distribution_is_named_in_its_own_file_only() {
    /// Rules that name a distribution themselves, and where.
    const RULES: [(&str, &str); 5] = [
        (
            "Normal",
            "gum, lab: what a standard uncertainty alone says (JCGM 101 6.4.7)",
        ),
        (
            "StudentT",
            "gum: what readings say (6.4.9), and the multivariate t",
        ),
        (
            "Uniform",
            "gum, lab: the shape of limits where none is stated (GUM 4.3.7)",
        ),
        (
            "Gamma",
            "gum: the χ² of the multivariate t (JCGM 102 5.3.2.4)",
        ),
        ("Empirical", "gum: `sample = […]`"),
    ];
    let variant = |d: &Distribution| {
        let shown = format!("{d:?}");
        let end = shown.find('(').unwrap_or(shown.len());
        shown[..end].to_string()
    };
    let mut types: Vec<String> = zoo().iter().map(variant).collect();
    types.dedup();
    assert_eq!(types.len(), REGISTRY.len(), "one of every kind: {types:?}");
    let crates = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut sources = Vec::new();
    for crate_folder in std::fs::read_dir(crates).unwrap() {
        collect(&crate_folder.unwrap().path().join("src"), &mut sources);
    }
    assert!(sources.len() > 200, "{}", sources.len());
    for name in types
        .iter()
        .filter(|name| RULES.iter().all(|(rule, _)| rule != name))
    {
        for (path, text) in &sources {
            let own = path.contains("core/src/distribution/") || path.contains("lanes/src/");
            let named = uses(text).any(|word| word == *name);
            assert!(own || !named, "{path} names {name}");
        }
    }
    for entry in REGISTRY.iter().filter(|entry| entry.kind.key.len() > 7) {
        let quoted = format!("\"{}\"", entry.kind.key);
        for (path, text) in &sources {
            // The sheets of others, which the challenge makes, and the files of other programs have words of their own.
            let own = [
                "core/src/distribution/",
                "challenge/src/budget/",
                "audit/src/programs/",
            ];
            let own = own.iter().any(|folder| path.contains(folder));
            assert!(own || !text.contains(&quoted), "{path} names {quoted}");
        }
    }
}

/// Every source file below a folder, without its tests and comments.
fn collect(folder: &std::path::Path, into: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        let name = path.to_string_lossy().replace('\\', "/");
        if path.is_dir() {
            collect(&path, into);
        } else if name.ends_with(".rs") && !name.contains("tests") && !name.contains("/samples.rs")
        {
            let text = std::fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            let lines = text
                .lines()
                .map(|line| line.split("//").next().unwrap_or_default());
            into.push((name, lines.collect::<Vec<_>>().join("\n")));
        }
    }
}

/// The words behind `distribution::` and `Distribution::`, also in braces.
fn uses(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split("istribution::").skip(1).flat_map(|rest| {
        let list = match rest.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap_or_default(),
            None => {
                let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
                &rest[..end.unwrap_or(rest.len())]
            }
        };
        list.split(',')
            .map(|word| word.trim().to_string())
            .collect::<Vec<_>>()
    })
}
