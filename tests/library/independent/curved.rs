//! Nonlinear models with known output distributions: squares, products, exponentials, quotients.

use super::{density, integrate, invert, phi, shortest, z};
use crate::common::evaluation::{close, close_ends, evaluate, only, sampled};
use gumption::propagate::FindingKind;

/// Comparison loss of JCGM 101 9.4, in units of 10⁻⁶, with u(x1) = u(x2) = 0.005 and x2 = 0.
struct Loss {
    x1: f64,
    r: f64,
    u: f64,
    symmetric: [f64; 2],
    shortest: [f64; 2],
}

/// scipy 1.x: for r = 0, Y = 25·ncx2(2, (x1/0.005)²), `ppf` and `minimize_scalar` over the probability below;
/// for r = 0.9 the eigenvectors of the covariance give Y = T1² + T2² with T normal and independent, whose
/// distribution function is ∫ φ(t) [Φ(h) − Φ(−h)] dt, h = √(y − t²), by 4000-point Gauss–Legendre, inverted by
/// `brentq`.
const LOSSES: [Loss; 6] = [
    Loss {
        x1: 0.0,
        r: 0.0,
        u: 50.0,
        symmetric: [1.265890, 184.443973],
        shortest: [0.0, 149.786614],
    },
    Loss {
        x1: 0.0,
        r: 0.9,
        u: 67.268120,
        symmetric: [0.560978, 241.217187],
        shortest: [0.0, 185.056461],
    },
    Loss {
        x1: 0.01,
        r: 0.0,
        u: 111.803399,
        symmetric: [8.546845, 427.123282],
        shortest: [0.0, 366.005290],
    },
    Loss {
        x1: 0.01,
        r: 0.9,
        u: 120.519708,
        symmetric: [29.081467, 478.310679],
        shortest: [12.651560, 397.478782],
    },
    Loss {
        x1: 0.05,
        r: 0.0,
        u: 502.493781,
        symmetric: [1638.477070, 3603.358054],
        shortest: [1593.5697, 3548.5698],
    },
    Loss {
        x1: 0.05,
        r: 0.9,
        u: 504.504708,
        symmetric: [1696.857982, 3659.796280],
        shortest: [1624.4186, 3554.6825],
    },
];

#[test]
fn comparison_loss_of_jcgm_101_9_4() {
    for Loss {
        x1,
        r,
        u,
        symmetric,
        shortest,
    } in LOSSES
    {
        let correlation = if r == 0.0 {
            String::new()
        } else {
            format!("[[correlation]]\nbetween = ['x1', 'x2']\nr = {r}\n")
        };
        let found = evaluate(&format!(
            "[measurand.y]\nmodel = 'x1^2 + x2^2'\nunit = 'ppm'\n[input]\nx1 = {{ value = {x1}, u = 0.005 }}\nx2 = {{ value = 0, u = 0.005 }}\n{correlation}"
        ));
        let result = only(&found);
        close(result.gum.u, 1e4 * x1, 1e-9);
        let mean = 1e6 * x1 * x1 + 50.0;
        let second = result.second_order.as_ref().expect("a curved model");
        close(result.gum.estimate + second.shift, mean, 1e-9);
        close(second.u, u, 1e-5);
        let mc = sampled(&found);
        close(mc.estimate.expect("moments"), mean, 0.004 * u);
        close(mc.u.expect("moments"), u, 0.008 * u);
        close_ends(mc.symmetric, symmetric, 0.02 * u);
        close_ends(mc.shortest, shortest, 0.05 * u);
        close(
            mc.shortest[1] - mc.shortest[0],
            shortest[1] - shortest[0],
            0.02 * u,
        );
    }
}

#[test]
fn a_centred_square_has_a_one_sided_shortest_interval() {
    // Chi-square with two degrees of freedom: exponential, so that it begins at zero and ends at −2 ln 0.05.
    let found = evaluate(
        "[measurand.y]\nmodel = 'a^2 + b^2'\n[input]\na = { value = 0, u = 1 }\nb = { value = 0, u = 1 }\n",
    );
    let mc = sampled(&found);
    close(mc.shortest[0], 0.0, 1e-4);
    close(mc.shortest[1], -2.0 * 0.05f64.ln(), 0.05);
    close_ends(
        mc.symmetric,
        [-2.0 * 0.975f64.ln(), -2.0 * 0.025f64.ln()],
        0.05,
    );
    close(mc.skewness.expect("moments"), 2.0, 0.05);
    assert!(
        found
            .findings
            .iter()
            .any(|f| f.kind == FindingKind::Asymmetric)
    );
    let unseen = found.findings.iter().find_map(|f| match &f.kind {
        FindingKind::VanishingSensitivity { inputs, .. } => Some(inputs.clone()),
        _ => None,
    });
    assert_eq!(unseen.expect("a finding"), ["a", "b"]);
    assert!(!only(&found).validation.expect("both methods")[0].is_validated());
}

#[test]
fn product_of_two_normal_inputs() {
    for [(m, s), (n, t)] in [
        [(0.0, 1.0), (0.0, 1.0)],
        [(2.0, 0.5), (3.0, 0.9)],
        [(0.0, 2.0), (5.0, 1.0)],
    ] {
        let found = evaluate(&format!(
            "[measurand.y]\nmodel = 'a * b'\n[input]\na = {{ value = {m}, u = {s} }}\nb = {{ value = {n}, u = {t} }}\n"
        ));
        let u = f64::hypot(m * t, n * s).hypot(s * t);
        let second = only(&found).second_order.as_ref().expect("a curved model");
        close(second.u, u, 1e-12 * u);
        close(second.shift, 0.0, 1e-12);
        let mc = sampled(&found);
        close(mc.estimate.expect("moments"), m * n, 0.004 * u);
        close(mc.u.expect("moments"), u, 0.008 * u);
        // Central moments of X·Y from those of each factor: E(XY)^k = E X^k E Y^k.
        let raw = |m: f64, s: f64| {
            let v = s * s;
            [
                m,
                m * m + v,
                m.powi(3) + 3.0 * m * v,
                m.powi(4) + 6.0 * m * m * v + 3.0 * v * v,
            ]
        };
        let (a, b) = (raw(m, s), raw(n, t));
        let e: Vec<f64> = (0..4).map(|k| a[k] * b[k]).collect();
        let third = e[2] - 3.0 * e[1] * e[0] + 2.0 * e[0].powi(3);
        let fourth = e[3] - 4.0 * e[2] * e[0] + 6.0 * e[1] * e[0] * e[0] - 3.0 * e[0].powi(4);
        close(mc.skewness.expect("moments"), third / u.powi(3), 0.06);
        close(
            mc.excess_kurtosis.expect("moments"),
            fourth / u.powi(4) - 3.0,
            0.45,
        );
        // P(XY ≤ y) by integration over X.
        let cdf = |y: f64| {
            integrate(m - 9.0 * s, m + 9.0 * s, |x| {
                let below = phi((y / x - n) / t);
                density((x - m) / s) / s * if x > 0.0 { below } else { 1.0 - below }
            })
        };
        for (end, p) in mc.symmetric.into_iter().zip([0.025, 0.975]) {
            let density = (cdf(end + 0.01 * u) - cdf(end - 0.01 * u)) / (0.02 * u);
            let error = (0.025f64 * 0.975 / 1e6).sqrt() / density;
            close(cdf(end), p, 4.0 * error * density + 1e-6);
        }
    }
}

#[test]
fn exponential_of_a_normal_input() {
    let (mu, sigma) = (1.0, 0.5);
    let found = evaluate(&format!(
        "[measurand.y]\nmodel = 'exp(x)'\n[input.x]\nvalue = {mu}\nu = {sigma}\n"
    ));
    let variance: f64 = sigma * sigma;
    let mean = (mu + variance / 2.0).exp();
    let u = mean * variance.exp_m1().sqrt();
    let quantile = |p: f64| (mu + sigma * z(p)).exp();
    let mc = sampled(&found);
    close(mc.estimate.expect("moments"), mean, 0.004 * u);
    close(mc.u.expect("moments"), u, 0.01 * u);
    close(mc.median, mu.exp(), 0.006 * u);
    close_ends(mc.symmetric, [quantile(0.025), quantile(0.975)], 0.025 * u);
    let exact = shortest(0.95, quantile);
    close_ends(mc.shortest, exact, 0.05 * u);
    close(
        mc.shortest[1] - mc.shortest[0],
        exact[1] - exact[0],
        0.02 * u,
    );
    // The same distribution, stated for an input.
    let stated = evaluate(&format!(
        "[measurand.y]\nmodel = 'x'\n[input.x]\ndistribution = {{ lognormal = {{ mu = {mu}, sigma = {sigma} }} }}\n"
    ));
    close(only(&stated).gum.estimate, mean, 1e-12);
    close(only(&stated).gum.u, u, 1e-12);
    close_ends(
        sampled(&stated).symmetric,
        [quantile(0.025), quantile(0.975)],
        0.025 * u,
    );
}

#[test]
fn a_divisor_near_zero_leaves_quantiles_and_no_moments() {
    let (m, s, n, t) = (1.0, 0.1, 1.0, 0.4);
    let found = evaluate(&format!(
        "[measurand.y]\nmodel = 'a / b'\n[input]\na = {{ value = {m}, u = {s} }}\nb = {{ value = {n}, u = {t} }}\n"
    ));
    let mc = sampled(&found);
    assert_eq!((mc.estimate, mc.u, mc.skewness), (None, None, None));
    let told = |wanted: fn(&FindingKind) -> bool| found.findings.iter().any(|f| wanted(&f.kind));
    assert!(told(|kind| matches!(
        kind,
        FindingKind::MomentsMissing { .. }
    )));
    assert!(told(|kind| matches!(
        kind,
        FindingKind::NearSingular { .. }
    )));
    assert!(!only(&found).validation.expect("both methods")[0].is_validated());
    // P(A/B ≤ y) = ∫ φ_B(b) P(A ≤ y b, or ≥ for b < 0) db.
    let cdf = |y: f64| {
        integrate(n - 9.0 * t, n + 9.0 * t, |b| {
            let below = phi((y * b - m) / s);
            density((b - n) / t) / t * if b > 0.0 { below } else { 1.0 - below }
        })
    };
    close(mc.median, invert(0.5, 0.0, 5.0, cdf), 0.003);
    for (end, p) in mc.symmetric.into_iter().zip([0.025, 0.975]) {
        close(cdf(end), p, 7e-4);
    }
    close(cdf(mc.shortest[1]) - cdf(mc.shortest[0]), 0.95, 1.5e-3);
}

#[test]
fn a_divisor_far_from_zero_has_moments() {
    let found = evaluate(
        "[measurand.y]\nmodel = 'a / b'\n[input]\na = { value = 1, u = 0.1 }\nb = { value = 1, u = 0.05 }\n",
    );
    // E(1/B) ≈ 1 + u² + 3u⁴ + 15 u⁶.
    let mean = 1.0 + 0.05f64.powi(2) + 3.0 * 0.05f64.powi(4);
    close(sampled(&found).estimate.expect("moments"), mean, 5e-4);
    assert!(
        !found
            .findings
            .iter()
            .any(|f| matches!(f.kind, FindingKind::MomentsMissing { .. }))
    );
}
