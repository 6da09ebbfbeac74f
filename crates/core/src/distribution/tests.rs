//! Moments against quadrature of the quantile function, quantiles against distribution functions,
//! and the images of every kind.

use super::*;
use crate::special::gauss_legendre;

/// One or more of every kind.
fn zoo() -> Vec<Distribution> {
    use Distribution as D;
    vec![
        D::Normal {
            mean: 3.0,
            sd: 0.25,
        },
        D::StudentT {
            location: -1.0,
            scale: 0.5,
            dof: 5.5,
        },
        D::StudentT {
            location: -1.0,
            scale: 0.5,
            dof: 40.0,
        },
        D::StudentT {
            location: -1.0,
            scale: 0.5,
            dof: f64::INFINITY,
        },
        D::Uniform {
            lower: -1.0,
            upper: 5.0,
        },
        D::Triangular {
            lower: -3.0,
            mode: -1.0,
            upper: 1.0,
        },
        D::Triangular {
            lower: 0.0,
            mode: 0.3,
            upper: 2.0,
        },
        D::Triangular {
            lower: 0.0,
            mode: 0.0,
            upper: 2.0,
        },
        D::Triangular {
            lower: 0.0,
            mode: 2.0,
            upper: 2.0,
        },
        D::Trapezoidal {
            lower: -1.0,
            upper: 3.0,
            beta: 0.4,
        },
        D::Trapezoidal {
            lower: -1.0,
            upper: 3.0,
            beta: 0.0,
        },
        D::Trapezoidal {
            lower: -1.0,
            upper: 3.0,
            beta: 1.0,
        },
        D::CurvilinearTrapezoid {
            lower: 9.5,
            upper: 10.5,
            d: 0.05,
        },
        D::CurvilinearTrapezoid {
            lower: 9.5,
            upper: 10.5,
            d: 0.5,
        },
        D::CurvilinearTrapezoid {
            lower: 9.5,
            upper: 10.5,
            d: 0.0,
        },
        D::Arcsine {
            lower: -1.0,
            upper: 2.0,
        },
        D::Exponential {
            origin: 0.5,
            mean: 4.0,
        },
        D::Gamma {
            origin: 0.0,
            shape: 4.0,
            scale: 1.0,
        },
        D::Gamma {
            origin: 1.0,
            shape: 0.4,
            scale: 2.0,
        },
        D::LogNormal {
            origin: 0.2,
            mu: 0.1,
            sigma: 0.3,
        },
        D::Beta {
            alpha: 2.0,
            beta: 3.5,
            lower: 1.0,
            upper: 4.0,
        },
        D::Beta {
            alpha: 0.6,
            beta: 0.9,
            lower: 1.0,
            upper: 4.0,
        },
        D::Discrete {
            values: [1.0, 2.0, 5.0].into(),
            probabilities: [0.2, 0.5, 0.3].into(),
        },
        D::Empirical {
            sample: [1.0, 1.5, 1.5, 4.0, 9.0].into(),
        },
    ]
}

fn continuous() -> impl Iterator<Item = Distribution> {
    zoo().into_iter().filter(|d| !has_steps(d))
}

fn has_steps(d: &Distribution) -> bool {
    matches!(
        d,
        Distribution::Discrete { .. } | Distribution::Empirical { .. }
    )
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
            D::Uniform {
                lower: -1.0,
                upper: 5.0,
            },
            2.0,
            3.0,
        ),
        (
            D::Trapezoidal {
                lower: -1.0,
                upper: 3.0,
                beta: 0.4,
            },
            1.0,
            0.773_333_333_333_333_3,
        ),
        (
            D::Triangular {
                lower: -3.0,
                mode: -1.0,
                upper: 1.0,
            },
            -1.0,
            0.666_666_666_666_666_6,
        ),
        (
            D::Arcsine {
                lower: -1.0,
                upper: 2.0,
            },
            0.5,
            1.125,
        ),
        (
            D::CurvilinearTrapezoid {
                lower: 9.5,
                upper: 10.5,
                d: 0.05,
            },
            10.0,
            0.083_611_111_111_111_11,
        ),
        (
            D::StudentT {
                location: 5.0,
                scale: 2.0,
                dof: 6.0,
            },
            5.0,
            6.0,
        ),
        (
            D::Exponential {
                origin: 0.0,
                mean: 4.0,
            },
            4.0,
            16.0,
        ),
        (
            D::Gamma {
                origin: 0.0,
                shape: 4.0,
                scale: 1.0,
            },
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
    let d = Distribution::Discrete {
        values: [1.0, 2.0, 5.0].into(),
        probabilities: [0.2, 0.5, 0.3].into(),
    };
    close(d.mean().unwrap(), 2.7, 1e-15, &d);
    close(d.variance().unwrap(), 2.41, 1e-14, &d);
    // 0.2·(−1.7)³ + 0.5·(−0.7)³ + 0.3·2.3³
    close(d.third_central_moment().unwrap(), 2.496, 1e-14, &d);
    let d = Distribution::Empirical {
        sample: [1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0].into(),
    };
    close(d.mean().unwrap(), 1e9 + 2.0, 1e-16, &d);
    close(d.variance().unwrap(), 2.0 / 3.0, 1e-14, &d);
}

#[test]
fn moments_that_do_not_exist() {
    let t = |dof| Distribution::StudentT {
        location: 0.0,
        scale: 1.0,
        dof,
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
    let d = Distribution::Discrete {
        values: [1.0, 2.0, 5.0].into(),
        probabilities: [0.2, 0.5, 0.3].into(),
    };
    let found = [0.1, 0.2, 0.21, 0.7, 0.71].map(|p| d.quantile(p));
    assert_eq!(found, [1.0, 1.0, 2.0, 2.0, 5.0]);
    assert_eq!([0.3, 0.31].map(|q| d.upper_quantile(q)), [5.0, 2.0]);
    assert_eq!(d.cdf(2.0), 0.7);
    assert_eq!(d.cdf(1.99), 0.2);
    let d = Distribution::Empirical {
        sample: [1.0, 2.0, 3.0, 4.0].into(),
    };
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
fn symmetry_is_seen() {
    for d in zoo() {
        let middle = d.quantile(0.5);
        let mirrored = [0.1, 0.22, 0.4]
            .iter()
            .all(|p| (d.quantile(*p) + d.upper_quantile(*p) - 2.0 * middle).abs() < 1e-9);
        assert_eq!(d.is_symmetric(), mirrored, "{d:?}");
    }
    let d = Distribution::Empirical {
        sample: [1.0, 2.0, 4.0, 5.0].into(),
    };
    assert!(d.is_symmetric());
    assert!(Distribution::Normal { mean: 0.0, sd: 1.0 }.is_normal());
    assert!(!d.is_normal());
}

#[test]
fn validity() {
    use Distribution as D;
    for d in zoo() {
        assert_eq!(d.validate(), Ok(()), "{d:?}");
        assert!(d.describe().starts_with(d.name()));
        assert!(!d.name_zh().is_empty());
    }
    let faults = [
        (
            D::Normal {
                mean: 0.0,
                sd: -1.0,
            },
            "the standard deviation is -1",
        ),
        (
            D::Normal {
                mean: f64::NAN,
                sd: 1.0,
            },
            "the mean is NaN",
        ),
        (
            D::StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 0.0,
            },
            "the degrees of freedom are 0",
        ),
        (
            D::Uniform {
                lower: 2.0,
                upper: 2.0,
            },
            "the lower limit 2 must be below",
        ),
        (
            D::Triangular {
                lower: 0.0,
                mode: 3.0,
                upper: 2.0,
            },
            "the mode is 3, but must be from 0",
        ),
        (
            D::Trapezoidal {
                lower: 0.0,
                upper: 2.0,
                beta: 1.2,
            },
            "must be from 0 to 1",
        ),
        (
            D::CurvilinearTrapezoid {
                lower: 0.0,
                upper: 2.0,
                d: 1.2,
            },
            "must be from 0 to 1, half",
        ),
        (
            D::Exponential {
                origin: 0.0,
                mean: 0.0,
            },
            "the mean is 0",
        ),
        (
            D::Gamma {
                origin: 0.0,
                shape: 0.0,
                scale: 1.0,
            },
            "the shape is 0",
        ),
        (
            D::LogNormal {
                origin: 0.0,
                mu: 0.0,
                sigma: 0.0,
            },
            "the sigma is 0",
        ),
        (
            D::Beta {
                alpha: 1.0,
                beta: -2.0,
                lower: 0.0,
                upper: 1.0,
            },
            "the beta is -2",
        ),
        (D::Empirical { sample: [].into() }, "the sample is empty"),
        (
            D::Empirical {
                sample: [2.0, 1.0].into(),
            },
            "2 comes before 1",
        ),
        (
            D::Discrete {
                values: [1.0, 2.0].into(),
                probabilities: [0.5, 0.4].into(),
            },
            "the probabilities sum to 0.9",
        ),
        (
            D::Discrete {
                values: [1.0, 2.0].into(),
                probabilities: [1.0].into(),
            },
            "there are 2 values but 1 probabilities",
        ),
    ];
    for (d, expected) in faults {
        let found = d.validate().unwrap_err();
        assert!(found.contains(expected), "{found}");
    }
}
