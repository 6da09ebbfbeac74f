use super::*;
use crate::testing::{Double, same, ulp};

/// Points of the low-discrepancy sequence i·φ mod 1, 0 < t < 1.
fn spread(count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(|i| (f64::from(i) * 0.618_033_988_749_894_9).fract())
}

fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |worst, e| if e <= worst { worst } else { e })
}

/// |exp(x) − eˣ| in ulp, subnormal results included.
fn exp_error(x: f64) -> f64 {
    let (reference, k) = Double::exp(x);
    let result = exp(x);
    // Everything is scaled by 2⁻ᵏ in two exact steps, so that the reference need not be rounded.
    let scale = |v: f64| v * 2_f64.powi(-(k / 2)) * 2_f64.powi(-(k - k / 2));
    ((scale(result) - reference.0) - reference.1).abs() / scale(ulp(result))
}

#[test]
fn reference_arithmetic_agrees_with_sixty_digits() {
    // mpmath 1.3, mp.dps = 60, split into two doubles.
    let close = |d: Double, hi: f64, lo: f64| {
        assert_eq!(d.0, hi);
        assert!((d.1 - lo).abs() < 1e-30 * hi.abs(), "{d:?} {lo}");
    };
    let e = |x: f64| {
        let (value, k) = Double::exp(x);
        Double(value.0 * 2_f64.powi(k), value.1 * 2_f64.powi(k))
    };
    close(e(1.0), std::f64::consts::E, 1.4456468917292502e-16);
    close(e(-0.7), 0.4965853037914095, 9.827550225511106e-18);
    close(e(0.3), 1.3498588075760032, -9.447314673432387e-17);
    close(
        Double::ln(10.0),
        std::f64::consts::LN_10,
        -2.1707562233822494e-16,
    );
    close(
        Double::ln(1.0009765625),
        0.0009760859730554589,
        -2.8791156534096714e-20,
    );
    close(Double::ln(0.9), -0.10536051565782628, 4.81014917638444e-18);
    close(
        Double::sin_cos(1.0).0,
        0.8414709848078965,
        1.776845092935536e-18,
    );
    close(
        Double::sin_cos(355.0).0,
        -3.014435335948845e-05,
        1.3012643991046347e-21,
    );
    close(
        Double::sin_cos(67108863.0).0,
        0.9906964920672602,
        -2.6998513360153308e-17,
    );
    close(
        Double::sin_cos(1.0).1,
        0.5403023058681398,
        -4.760954612604417e-17,
    );
    close(
        Double::sin_cos(11.0).1,
        0.004425697988050785,
        3.2449142686784373e-19,
    );
    close(
        Double::sin_cos(60000000.5).1,
        -0.5085481491580788,
        4.570743034062972e-17,
    );
}

#[test]
fn exp_is_accurate() {
    let normal = worst(spread(100_000).map(|t| exp_error(-708.0 + 1417.5 * t)));
    let central = worst(spread(100_000).map(|t| exp_error(-1.0 + 2.0 * t)));
    let subnormal = worst(spread(20_000).map(|t| exp_error(-744.0 + 36.0 * t)));
    assert!(normal < 0.65, "normal {normal}");
    assert!(central < 0.65, "central {central}");
    assert!(subnormal < 0.75, "subnormal {subnormal}");
}

#[test]
fn exp_at_the_edges() {
    assert_eq!(exp(0.0), 1.0);
    assert_eq!(exp(-0.0), 1.0);
    assert_eq!(exp(f64::INFINITY), f64::INFINITY);
    assert_eq!(exp(f64::NEG_INFINITY), 0.0);
    assert!(exp(f64::NAN).is_nan());
    // ln(f64::MAX) = 709.7827128933840…; half of the least subnormal is e^−745.13321910194…
    assert!(exp(709.782_712_893_383_9).is_finite());
    assert_eq!(exp(709.782_712_893_384_1), f64::INFINITY);
    assert_eq!(exp(-745.133_219_101_941_1), 5e-324);
    assert_eq!(exp(-745.133_219_101_941_3), 0.0);
    assert_eq!(exp(1e300), f64::INFINITY);
    assert_eq!(exp(-1e300), 0.0);
}

#[test]
fn expm1_is_accurate() {
    let wide = worst(spread(50_000).map(|t| {
        let x = -38.0 + 738.0 * t;
        Double::expm1(x).ulps(expm1(x))
    }));
    let central = worst(spread(100_000).map(|t| {
        let x = -2.0 + 4.0 * t;
        Double::expm1(x).ulps(expm1(x))
    }));
    let small = worst(spread(50_000).map(|t| {
        let x = 10_f64.powf(-300.0 * t) * if t < 0.5 { 1.0 } else { -1.0 };
        Double::expm1(x).ulps(expm1(x))
    }));
    assert!(wide < 1.05, "wide {wide}");
    assert!(central < 1.05, "central {central}");
    assert!(small < 1.05, "small {small}");
}

#[test]
fn expm1_at_the_edges() {
    for x in [0.0, -0.0, 5e-324, -5e-324, 1e-310] {
        assert!(same(expm1(x), x));
    }
    assert_eq!(expm1(f64::INFINITY), f64::INFINITY);
    assert_eq!(expm1(1000.0), f64::INFINITY);
    assert!(expm1(709.7).is_finite());
    assert_eq!(expm1(f64::NEG_INFINITY), -1.0);
    assert_eq!(expm1(-50.0), -1.0);
    assert!(expm1(f64::NAN).is_nan());
}

#[test]
fn ln_is_accurate() {
    let error = |x: f64| Double::ln(x).ulps(ln(x));
    let all = worst(spread(100_000).map(|t| {
        // Every exponent, subnormal numbers included: t runs over the bit patterns.
        error(f64::from_bits(
            1 + (t * f64::INFINITY.to_bits() as f64) as u64,
        ))
    }));
    let central = worst(spread(100_000).map(|t| error(0.4 + 2.6 * t)));
    let near_one = worst(spread(100_000).map(|t| {
        let distance = 10_f64.powf(-15.0 * t);
        error(1.0 + distance).max(error(1.0 - 0.6 * distance))
    }));
    assert!(all < 0.8, "all {all}");
    assert!(central < 0.8, "central {central}");
    assert!(near_one < 0.8, "near one {near_one}");
}

#[test]
fn ln_at_the_edges() {
    assert!(same(ln(1.0), 0.0));
    assert_eq!(ln(0.0), f64::NEG_INFINITY);
    assert_eq!(ln(-0.0), f64::NEG_INFINITY);
    assert_eq!(ln(f64::INFINITY), f64::INFINITY);
    for x in [f64::NAN, -1.0, -5e-324, f64::NEG_INFINITY] {
        assert!(ln(x).is_nan());
    }
    assert!(Double::ln(5e-324).ulps(ln(5e-324)) < 0.8);
    assert!(Double::ln(f64::MAX).ulps(ln(f64::MAX)) < 0.8);
}

fn sin_cos_error(x: f64) -> f64 {
    let (sin_x, cos_x) = Double::sin_cos(x);
    sin_x.ulps(sin(x)).max(cos_x.ulps(cos(x)))
}

#[test]
fn sin_and_cos_are_accurate() {
    let circle = worst(spread(100_000).map(|t| sin_cos_error(-7.0 + 14.0 * t)));
    let range = worst(spread(100_000).map(|t| sin_cos_error((2.0 * t - 1.0) * REDUCIBLE)));
    let small = worst(spread(20_000).map(|t| {
        let x = 10_f64.powf(-300.0 * t);
        sin_cos_error(x)
    }));
    // The doubles nearest to multiples of π/2, where the reduction cancels most.
    let zeros = worst((1..100_000_u32).flat_map(|k| {
        let nearest = f64::from(k * 427) * std::f64::consts::FRAC_PI_2;
        [nearest.next_down(), nearest, nearest.next_up()].map(sin_cos_error)
    }));
    assert!(circle < 0.76, "circle {circle}");
    assert!(range < 0.76, "range {range}");
    assert!(small < 0.76, "small {small}");
    assert!(zeros < 0.76, "zeros {zeros}");
}

#[test]
fn sin_and_cos_at_the_edges() {
    assert!(same(sin(0.0), 0.0) && same(sin(-0.0), -0.0));
    assert!(same(cos(0.0), 1.0) && same(cos(-0.0), 1.0));
    for x in [5e-324, -5e-324, 1e-310] {
        assert!(same(sin(x), x));
    }
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(sin(x).is_nan() && cos(x).is_nan());
    }
    // sin 10²² is a classic of bad range reductions: −0.8522008497671888…
    assert_eq!(sin(1e22), -0.852_200_849_767_188_8);
}

#[test]
fn libm_agrees_to_one_place() {
    for t in spread(50_000) {
        let x = 40.0 * t - 20.0;
        for (ours, theirs) in [
            (exp(x), libm::exp(x)),
            (ln(t), libm::log(t)),
            (sin(x), libm::sin(x)),
            (cos(x), libm::cos(x)),
        ] {
            assert!((ours - theirs).abs() <= ulp(theirs), "{x}: {ours} {theirs}");
        }
        let huge = x * 1e20;
        assert_eq!(sin(huge), libm::sin(huge));
        assert_eq!(cos(huge), libm::cos(huge));
    }
}
