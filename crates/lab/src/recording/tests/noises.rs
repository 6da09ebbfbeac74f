//! The Allan deviation against its definition, theory and simulated noise.

use super::normals;
use crate::recording::power_law::{covariances, equivalent_dof};
use crate::recording::{Allan, Coefficient, PowerLaw, Unsuitable, regular_interval};
use gumption_core::special::{chi_squared_quantile, chi_squared_upper_quantile};

/// The definition: half the mean square of the difference of adjacent averages, over all starts.
fn direct(readings: &[f64], m: usize) -> f64 {
    let average = |from: usize| readings[from..from + m].iter().sum::<f64>() / m as f64;
    let starts = readings.len() + 1 - 2 * m;
    let squares = (0..starts)
        .map(|k| (average(k + m) - average(k)).powi(2))
        .sum::<f64>();
    (0.5 * squares / starts as f64).sqrt()
}

#[test]
fn the_definition() {
    let readings: Vec<f64> = normals(1, 500).iter().map(|x| 1e6 + x).collect();
    let allan = Allan::of(&readings, 0.1, 0.95).expect("readings");
    assert_eq!(allan.points.len(), 7);
    for point in &allan.points {
        let expected = direct(&readings, point.intervals);
        assert!((point.deviation / expected - 1.0).abs() < 1e-8, "{point:?}");
        assert!((point.tau - 0.1 * point.intervals as f64).abs() < 1e-12);
        assert!(point.interval[0] < point.deviation && point.deviation < point.interval[1]);
    }
}

#[test]
fn the_thousand_point_series_of_nist() {
    // NIST SP 1065, 12.4: n_{i+1} = 16807 n_i mod (2³¹ − 1), n_0 = 1234567890, over the modulus;
    // overlapping Allan deviations at 1, 10 and 100.
    let mut n: u64 = 1_234_567_890;
    let readings: Vec<f64> = std::iter::repeat_with(|| {
        let x = n as f64 / 2_147_483_647.0;
        n = n * 16807 % 2_147_483_647;
        x
    })
    .take(1000)
    .collect();
    for (m, published) in [(1, 2.922319e-1), (10, 9.159953e-2), (100, 3.241343e-2)] {
        assert!((direct(&readings, m) / published - 1.0).abs() < 2e-7);
    }
    let allan = Allan::of(&readings, 1.0, 0.683).expect("readings");
    assert!((allan.points[0].deviation / 2.922319e-1 - 1.0).abs() < 2e-7);
}

#[test]
fn degrees_of_freedom() {
    // The direct sum over all pairs of differences, for white noise of the readings.
    let (n, m) = (60_usize, 5_usize);
    let row = |start: usize| -> Vec<f64> {
        (0..n)
            .map(|i| match i {
                _ if i >= start + m && i < start + 2 * m => 1.0,
                _ if i >= start && i < start + m => -1.0,
                _ => 0.0,
            })
            .collect()
    };
    let starts = n + 1 - 2 * m;
    let mut sum = 0.0;
    for k in 0..starts {
        for l in 0..starts {
            let product: f64 = row(k).iter().zip(row(l)).map(|(a, b)| a * b).sum();
            sum += product * product;
        }
    }
    let expected = (starts as f64 * 2.0 * m as f64).powi(2) / sum;
    assert!((equivalent_dof(n, m, PowerLaw::White) / expected - 1.0).abs() < 1e-12);
    // The approximations of NIST SP 1065, table 5, with N the number of phases.
    for (n, m) in [(1024, 4), (1024, 32), (20_000, 500)] {
        let (count, m_) = (n as f64 + 1.0, m as f64);
        let white = (3.0 * (count - 1.0) / (2.0 * m_) - 2.0 * (count - 2.0) / count)
            * (4.0 * m_ * m_ / (4.0 * m_ * m_ + 5.0));
        let flicker = 5.0 * count * count / (4.0 * m_ * (count + 3.0 * m_));
        let walk = (count - 2.0) / m_
            * ((count - 1.0).powi(2) - 3.0 * m_ * (count - 1.0) + 4.0 * m_ * m_)
            / (count - 3.0).powi(2);
        for (law, published) in PowerLaw::ALL.into_iter().zip([white, flicker, walk]) {
            let ratio = equivalent_dof(n, m, law) / published;
            assert!((ratio - 1.0).abs() < 0.12, "{law:?} {n} {m}: {ratio}");
        }
    }
}

#[test]
fn covariances_of_different_averaging_times() {
    // All pairs of differences at 2 and 6 intervals, for white noise.
    let (n, a, b) = (50_usize, 2_usize, 6_usize);
    let weight = |start: usize, m: usize, i: usize| -> f64 {
        match i.checked_sub(start).map(|offset| offset / m) {
            Some(0) => -1.0,
            Some(1) => 1.0,
            _ => 0.0,
        }
    };
    let (starts_a, starts_b) = (n + 1 - 2 * a, n + 1 - 2 * b);
    let mut sum = 0.0;
    for k in 0..starts_a {
        for l in 0..starts_b {
            let r: f64 = (0..n).map(|i| weight(k, a, i) * weight(l, b, i)).sum();
            sum += r * r;
        }
    }
    let scale = (2 * a * a * 2 * b * b * starts_a * starts_b) as f64;
    let expected = 2.0 * sum / scale;
    assert!((covariances(n, a, b)[0][0] / expected - 1.0).abs() < 1e-12);
    assert_eq!(covariances(n, a, b), covariances(n, b, a));
}

/// Readings each averaged over an interval of 1 s: a walk of 16 finer steps.
fn random_walk(k: f64, noise: &[f64]) -> Vec<f64> {
    let mut x = 0.0;
    noise
        .chunks_exact(16)
        .map(|steps| {
            let sum: f64 = steps
                .iter()
                .map(|e| {
                    x += 0.25 * k * e;
                    x
                })
                .sum();
            sum / 16.0
        })
        .collect()
}

/// Flicker by fractional integration of white noise (Kasdin 1995), after a warm-up of equal length;
/// B² is the variance of the noise.
fn flicker(b: f64, noise: &[f64]) -> Vec<f64> {
    let n = noise.len() / 2;
    let weights: Vec<f64> = std::iter::successors(Some((1.0, 1.0)), |(w, k)| {
        Some((w * (k - 0.5) / k, k + 1.0))
    })
    .map(|(w, _)| b * w)
    .take(n)
    .collect();
    (n..2 * n)
        .map(|i| {
            noise[i + 1 - n..=i]
                .iter()
                .rev()
                .zip(&weights)
                .map(|(e, w)| e * w)
                .sum()
        })
        .collect()
}

fn identified(coefficient: Coefficient) -> (f64, f64) {
    match coefficient {
        Coefficient::Identified { value, u } => (value, u),
        Coefficient::Hidden { limit } => panic!("hidden below {limit}"),
    }
}

#[test]
fn noises_of_one_kind() {
    let n = 4096;
    let white: Vec<f64> = normals(21, n).iter().map(|x| 0.3 * x).collect();
    let noises = Allan::of(&white, 0.01, 0.95)
        .map(|a| a.noises())
        .expect("readings")
        .expect("noises");
    let (value, u) = identified(noises.white);
    // N = σ √interval.
    assert!(
        (value - 0.03).abs() < 3.0 * u && u < 0.03 * value,
        "{noises:?}"
    );
    assert!(noises.bias_instability.value().is_none() && noises.rate_random_walk.value().is_none());
    assert!(noises.p_value > 0.001, "{noises:?}");
    // K in readings per √s: seen with an interval of 1 s, and with another name of the interval.
    let walk = random_walk(0.2, &normals(22, 16 * n));
    for (interval, expected) in [(1.0, 0.2), (0.01, 2.0)] {
        let noises = Allan::of(&walk, interval, 0.95)
            .expect("readings")
            .noises()
            .expect("noises");
        let (value, u) = identified(noises.rate_random_walk);
        assert!(
            (value - expected).abs() < 3.0 * u && u < 0.05 * value,
            "{noises:?}"
        );
        assert!(noises.bias_instability.value().is_none(), "{noises:?}");
    }
    let flicker = flicker(0.5, &normals(23, 2 * n));
    let allan = Allan::of(&flicker, 0.1, 0.95).expect("readings");
    let noises = allan.noises().expect("noises");
    let (value, u) = identified(noises.bias_instability);
    assert!(
        (value - 0.5).abs() < 3.5 * u && u < 0.1 * value,
        "{noises:?}"
    );
    assert!(
        allan.points[2..6]
            .iter()
            .all(|point| point.noise == PowerLaw::Flicker),
        "{allan:?}"
    );
}

#[test]
fn mixed_noises_scatter_as_they_say() {
    let (n, runs) = (4096, 60);
    let (mut whites, mut walks, mut found) = (Vec::new(), Vec::new(), 0);
    let mut too_low = 0;
    for run in 0..runs {
        let white = normals(1000 + run, n);
        let walk = random_walk(0.02, &normals(2000 + run, 16 * n));
        let readings: Vec<f64> = white.iter().zip(walk).map(|(a, b)| a + b).collect();
        let noises = Allan::of(&readings, 1.0, 0.95)
            .expect("readings")
            .noises()
            .expect("noises");
        let (value, u) = identified(noises.white);
        whites.push((value - 1.0) / u);
        match noises.rate_random_walk {
            Coefficient::Identified { value, u } => walks.push((value - 0.02) / u),
            Coefficient::Hidden { limit } => too_low += usize::from(limit < 0.02),
        }
        found += usize::from(noises.bias_instability.value().is_some());
    }
    assert!(walks.len() > 50, "{}", walks.len());
    // A limit of 95 % that is below the walk in more than 8 of 60 runs would be so by chance only in 0.3 %.
    assert!(too_low <= 8, "{too_low} limits are below the walk");
    assert!(
        found <= 12,
        "{found} of {runs} show flicker that is not there"
    );
    for z in [whites, walks] {
        let n = z.len() as f64;
        let sum: f64 = z.iter().sum();
        assert!((sum / n.sqrt()).abs() < 3.5, "a bias of {}", sum / n);
        // Between the quantiles of 0.1 % of χ² with n degrees of freedom.
        let squares: f64 = z.iter().map(|z| z * z).sum();
        let ends = [
            chi_squared_quantile(1e-3, n),
            chi_squared_upper_quantile(1e-3, n),
        ];
        assert!((ends[0]..ends[1]).contains(&squares), "{} of {n}", squares);
    }
}

#[test]
fn all_three_noises() {
    let n = 8192;
    let white = normals(31, n);
    let flicker = flicker(0.6, &normals(32, 2 * n));
    let walk = random_walk(0.06, &normals(33, 16 * n));
    let readings: Vec<f64> = (0..n).map(|i| white[i] + flicker[i] + walk[i]).collect();
    let noises = Allan::of(&readings, 1.0, 0.95)
        .expect("readings")
        .noises()
        .expect("noises");
    for (coefficient, expected) in [
        (noises.white, 1.0),
        (noises.bias_instability, 0.6),
        (noises.rate_random_walk, 0.06),
    ] {
        let (value, u) = identified(coefficient);
        assert!(
            (value - expected).abs() < 3.0 * u,
            "{value} ± {u} for {expected}: {noises:?}"
        );
    }
}

#[test]
fn limits_of_hidden_noises_hold() {
    let (n, runs, k) = (1024, 100, 0.01);
    let (mut hidden, mut wrong) = (0, 0);
    for run in 0..runs {
        let white = normals(7000 + run, n);
        let walk = random_walk(k, &normals(8000 + run, 16 * n));
        let readings: Vec<f64> = white.iter().zip(walk).map(|(a, b)| a + b).collect();
        let noises = Allan::of(&readings, 1.0, 0.95)
            .expect("readings")
            .noises()
            .expect("noises");
        if let Coefficient::Hidden { limit } = noises.rate_random_walk {
            hidden += 1;
            wrong += usize::from(limit < k);
        }
    }
    // A limit of 95 % that is wrong more often than in 12 of 100 runs would be so by chance only in 0.4 %.
    assert!(
        hidden > 20 && wrong <= 12,
        "{wrong} of {hidden} limits are too low"
    );
}

#[test]
fn confidence_intervals_cover() {
    let (n, runs) = (512, 400);
    let mut inside = vec![0; 8];
    for run in 0..runs {
        let allan = Allan::of(&normals(5000 + run, n), 1.0, 0.9).expect("readings");
        for (count, point) in inside.iter_mut().zip(&allan.points) {
            let truth = (1.0 / point.tau).sqrt();
            *count += u32::from(point.interval[0] < truth && truth < point.interval[1]);
        }
    }
    for count in inside {
        let share = f64::from(count) / f64::from(runs as u32);
        assert!((0.84..0.95).contains(&share), "{share}");
    }
}

#[test]
fn what_has_no_allan_deviation() {
    let readings = normals(1, 64);
    let refused = |readings: &[f64], interval: f64, p: f64| Allan::of(readings, interval, p).err();
    assert_eq!(
        refused(&readings[..9], 1.0, 0.9),
        Some(Unsuitable::TooFew {
            found: 9,
            needed: 16
        })
    );
    assert_eq!(
        refused(&readings, 0.0, 0.9),
        Some(Unsuitable::Interval(0.0))
    );
    // 64 of them are longer than any number.
    assert_eq!(
        refused(&readings, 1e307, 0.9),
        Some(Unsuitable::Interval(1e307))
    );
    assert_eq!(
        refused(&readings, 1.0, 1.0),
        Some(Unsuitable::Probability(1.0))
    );
    let mut gap = readings;
    gap[3] = f64::NAN;
    assert_eq!(
        refused(&gap, 1.0, 0.9),
        Some(Unsuitable::Missing { row: 3 })
    );
    let constant = Allan::of(&[1.0; 64], 1.0, 0.9).expect("readings");
    assert!(constant.noises().is_none() && constant.points[0].deviation == 0.0);
    assert_eq!(
        regular_interval(&[0.0, 0.1, 0.21, 0.3]).map(|t| (t * 1e9).round()),
        Ok(1e8)
    );
    assert!(matches!(
        regular_interval(&[0.0, 1.0, 3.0, 4.0]),
        Err(Unsuitable::Irregular { row: 1..=3, .. })
    ));
    assert!(matches!(
        regular_interval(&[2.0, 1.0, 0.0]),
        Err(Unsuitable::Interval(_))
    ));
}

/// A random walk that is just above the white noise: it is in the recording, and is not called something else.
#[test]
fn a_weak_random_walk_is_no_riddle() {
    let (count, recordings) = (20_000, 12);
    let mut shown = 0;
    for seed in 0..recordings {
        let (white, steps) = (normals(100 + seed, count), normals(500 + seed, count));
        let mut walk = 0.0;
        let readings = white.iter().zip(&steps).map(|(white, step)| {
            walk += 3e-5 * step;
            0.02 * white + walk
        });
        let readings: Vec<f64> = readings.collect();
        let allan = Allan::of(&readings, 0.01, 0.95).expect("readings");
        let noises = allan.noises().expect("noises");
        assert!(noises.p_value > 1e-4, "{noises:?}");
        shown += usize::from(noises.rate_random_walk.value().is_some());
    }
    assert!(2 * shown > recordings as usize, "{shown} of {recordings}");
}
