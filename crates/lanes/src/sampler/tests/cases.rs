//! Samplers with their distribution functions, from closed forms or another crate.

use statrs::distribution::{Beta, ContinuousCDF, Gamma, StudentsT};

use crate::Sampler;

/// A sampler, its distribution function, its expectation and its standard deviation.
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) sampler: Sampler,
    pub(super) cdf: Box<dyn Fn(f64) -> f64>,
    pub(super) mean: f64,
    pub(super) sd: f64,
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
pub(super) fn cases() -> Vec<Case> {
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
