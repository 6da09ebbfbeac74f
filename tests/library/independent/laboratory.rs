//! Everyday budgets of laboratories: y and u by central differences of the formula, written once more here in plain
//! numbers of one system of units, with the standard uncertainties that the statements of the file mean.

use crate::common::evaluation::{evaluate, only};

/// A quantity in the units of the formula: estimate and standard uncertainty.
type Known = (f64, f64);

/// Half-width of a rectangle.
fn limits(a: f64) -> f64 {
    a / 3.0_f64.sqrt()
}

/// y and u(y) by central differences with Richardson's extrapolation, whose error is of fourth order.
fn propagated(f: impl Fn(&[f64]) -> f64, known: &[Known]) -> Known {
    let at: Vec<f64> = known.iter().map(|(value, _)| *value).collect();
    let slope = |i: usize, step: f64| {
        let moved = |by: f64| {
            let mut x = at.clone();
            x[i] += by;
            f(&x)
        };
        (moved(step) - moved(-step)) / 2.0
    };
    let variance: f64 = (0..known.len())
        .map(|i| {
            let u = known[i].1;
            ((8.0 * slope(i, u / 2.0) - slope(i, u)) / 3.0).powi(2)
        })
        .sum();
    (f(&at), variance.sqrt())
}

#[track_caller]
fn agrees(text: &str, (y, u): Known) {
    let evaluation = evaluate(text);
    let gum = &only(&evaluation).gum;
    let near =
        |found: f64, wanted: f64, relative: f64| (found - wanted).abs() <= relative * wanted.abs();
    assert!(near(gum.estimate, y, 1e-12), "y: {} for {y}", gum.estimate);
    assert!(near(gum.u, u, 1e-6), "u: {} for {u}", gum.u);
}

#[test]
fn a_pressure_balance() {
    let f = |x: &[f64]| {
        let [m, g, rho_a, rho_m, area, lambda, alpha, t, rho_f, h] = x[..] else {
            panic!("ten quantities")
        };
        let effective = area * (1.0 + lambda * 1e7) * (1.0 + alpha * (t - 20.0));
        (m * g * (1.0 - rho_a / rho_m) / effective + rho_f * g * h) / 1e5
    };
    let known = [
        (10.00012, 5e-6),
        (9.812345, 2e-6),
        (1.199, 0.005),
        (7920.0, limits(20.0)),
        (9.80521e-6, 12e-6 * 9.80521e-6),
        (1.2e-11, 1.2e-12),
        (15.5e-6, limits(1e-6)),
        (20.6, limits(0.2)),
        (914.0, 5.0),
        (0.012, limits(0.001)),
    ];
    let text = "
[measurand.p]
model = \"m * g * (1 - rho_a / rho_m) / (A_0 * (1 + lambda * p_n) * (1 + alpha * (t - 20 '°C'))) + rho_f * g * h\"
unit = 'bar'
[constant]
p_n = '100 bar'
[input]
m = { value = 10.00012, unit = 'kg', u = '5 mg' }
g = { value = 9.812345, unit = 'm/s²', u = 2e-6 }
rho_a = { value = 1.199, unit = 'kg/m³', u = 0.005 }
rho_m = { value = 7920, unit = 'kg/m³', half_width = 20 }
A_0 = { value = 9.80521, unit = 'mm²', u = '12 ppm' }
lambda = { value = 1.2e-6, unit = '1/bar', u = '10 %' }
alpha = { value = 15.5, unit = 'µm/(m·K)', half_width = 1 }
t = { value = 20.6, unit = '°C', half_width = 0.2 }
rho_f = { value = 914, unit = 'kg/m³', u = 5 }
h = { value = 12, unit = 'mm', half_width = 1 }
";
    agrees(text, propagated(f, &known));
}

#[test]
fn a_volume_by_weighing_water() {
    let f = |x: &[f64]| {
        let [full, empty, water, air, weights, gamma, t] = x[..] else {
            panic!("seven quantities")
        };
        (full - empty) / (water - air) * (1.0 - air / weights) * (1.0 - gamma * (t - 20.0))
    };
    let known = [
        (169.8123, 0.0005),
        (70.1024, 0.0005),
        (0.997992, 2e-5),
        (0.0012, 3e-6),
        (8.0, limits(0.05)),
        (9.9e-6, 0.5e-6),
        (21.1, 0.1),
    ];
    let text = "
[measurand.V]
model = \"(I_L - I_E) / (rho_W - rho_A) * (1 - rho_A / rho_B) * (1 - gamma * (t - 20 '℃'))\"
unit = 'mL'
[input]
I_L = { value = 169.8123, unit = 'g', u = '0.5 mg' }
I_E = { value = 70.1024, unit = 'g', u = '0.5 mg' }
rho_W = { value = 997.992, unit = 'kg/m³', certificate = { U = 0.04, k = 2 } }
rho_A = { value = 0.0012, unit = 'g/mL', u = '0.25 %' }
rho_B = { value = 8.0, unit = 'g/cm³', half_width = 0.05 }
gamma = { value = 9.9e-6, unit = '1/℃', u = 0.5e-6 }
t = { value = 21.1, unit = '℃', u = 0.1 }
";
    agrees(text, propagated(f, &known));
}

#[test]
fn a_flow_through_an_orifice() {
    let f = |x: &[f64]| {
        let [c, epsilon, bore, pipe, pressure, density] = x[..] else {
            panic!("six quantities")
        };
        let beta = bore / pipe;
        c / (1.0 - beta.powi(4)).sqrt() * epsilon * std::f64::consts::PI / 4.0
            * bore.powi(2)
            * (2.0 * pressure * density).sqrt()
    };
    let known = [
        (0.6035, 0.005 * 0.6035),
        (0.9955, 0.001 * 0.9955),
        (0.060, 0.02e-3),
        (0.100, 0.2e-3),
        (25e3, 50.0),
        (4.5, 0.002 * 4.5),
    ];
    let text = "
[measurand.q]
model = 'beta = d / D; C / sqrt(1 - beta^4) * eps * pi / 4 * d^2 * sqrt(2 * dp * rho)'
unit = 'kg/s'
[input]
C = { value = 0.6035, u = 0.005, relative = true }
eps = { value = 0.9955, u = 0.001, relative = true }
d = { value = 60, unit = 'mm', u = 0.02 }
D = { value = 100, unit = 'mm', u = 0.2 }
dp = { value = 25.0, unit = 'kPa', u = 0.05 }
rho = { value = 4.5, unit = 'kg/m³', u = '0.2 %' }
";
    agrees(text, propagated(f, &known));
}

#[test]
fn a_relative_humidity_from_a_dew_point() {
    let vapour = |t: f64| 6.112 * (17.62 * t / (243.12 + t)).exp();
    let f = |x: &[f64]| 100.0 * vapour(x[1]) / vapour(x[0]);
    let known = [(23.0, 0.1), (12.0, 0.15)];
    let text = "
model = \"e(x) = 6.112 'hPa' * exp(17.62 * value_in(x, '°C') / (243.12 + value_in(x, '°C')))\"
[measurand.RH]
model = 'e(t_d) / e(t)'
unit = '%RH'
[input]
t = { value = 23.0, unit = '°C', u = 0.1 }
t_d = { value = 12.0, unit = '°C', u = 0.15 }
";
    agrees(text, propagated(f, &known));
}

#[test]
fn an_isotope_dilution() {
    let f = |x: &[f64]| {
        let [w, spike, sample, r_spike, r_blend, r_sample] = x[..] else {
            panic!("six quantities")
        };
        w * spike / sample * (r_spike - r_blend) / (r_blend - r_sample) * (8.012 / 1.0744)
    };
    let known = [
        (0.5012, 0.0008),
        (1.0234, 0.0002),
        (2.0511, 0.0002),
        (0.0421, 0.0003),
        (1.0312, 0.0021),
        (2.2461, 0.004),
    ];
    let text = "
[measurand.w_x]
model = 'w_y * m_y / m_x * (R_y - R_b) / (R_b - R_x) * S_x / S_y'
unit = 'µg/g'
[constant]
S_x = 8.012
S_y = 1.0744
[input]
w_y = { value = 501.2, unit = 'ng/g', u = 0.8 }
m_y = { value = 1.0234, unit = 'g', u = '0.2 mg' }
m_x = { value = 2.0511, unit = 'g', u = '0.2 mg' }
R_y = { value = 0.0421, u = 0.0003 }
R_b = { value = 1.0312, u = 0.0021 }
R_x = { value = 2.2461, u = 0.004 }
";
    agrees(text, propagated(f, &known));
}

#[test]
fn a_luminous_intensity_by_the_inverse_square() {
    // The illuminance from the current of a photometer; the distance from two readings of a scale.
    let f = |x: &[f64]| {
        let [current, responsivity, near, far, mismatch] = x[..] else {
            panic!("five quantities")
        };
        current / responsivity * (far - near).powi(2) * mismatch
    };
    let known = [
        (
            152.34e-9,
            (0.02e-9_f64.powi(2) + limits(0.0005 * 152.34e-9).powi(2)).sqrt(),
        ),
        (10.12e-9, 0.003 * 10.12e-9),
        (0.5021, limits(0.25e-3)),
        (3.0043, limits(0.25e-3)),
        (1.002, limits(0.004)),
    ];
    let text = "
[measurand.I_v]
model = 'i / s * (l_2 - l_1)^2 * F'
unit = 'cd'
[input]
s = { value = 10.12, unit = 'nA/lx', certificate = { U = '0.6 %', k = 2 } }
l_1 = { value = 502.1, unit = 'mm', step = 0.5 }
l_2 = { value = 3004.3, unit = 'mm', step = 0.5 }
F = { value = 1.002, half_width = 0.004 }
[input.i]
value = 152.34
unit = 'nA'
components = [
  { name = 'noise', u = 0.02 },
  { name = 'meter', specification = { reading = '0.05 %' } },
]
";
    agrees(text, propagated(f, &known));
}

#[test]
fn a_torque_wrench_with_the_resolution_of_two_readings() {
    let f = |x: &[f64]| 100.0 * (x[0] - x[1] - x[2]) / x[1];
    let known = [
        (101.2, 0.5 / 24.0_f64.sqrt()),
        (100.0, 0.0005 * 100.0),
        (0.0, 0.12),
    ];
    let text = "
[measurand.a]
model = '(X - X_ref - repeatability) / X_ref'
unit = '%'
[input]
X = { value = 101.2, unit = 'N·m', step = 0.5, distribution = 'triangular' }
X_ref = { value = 100, unit = 'N·m', certificate = { U = '0.1 %', k = 2 } }
repeatability = { value = 0, unit = 'N·m', u = 0.12 }
";
    agrees(text, propagated(f, &known));
}
