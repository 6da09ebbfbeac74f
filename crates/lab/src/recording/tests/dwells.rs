//! Dwells and their averages.

use super::normals;
use crate::recording::{
    Average, Cut, Drift, Dwell, Recording, Settling, Steps, Stillness, TooFew, by_label, by_steps,
    by_stillness,
};
use gumption_core::quantity::UnitTable;

fn ranges(dwells: &[Dwell]) -> Vec<(usize, usize)> {
    dwells
        .iter()
        .map(|dwell| (dwell.rows.start, dwell.rows.end))
        .collect()
}

#[test]
fn dwells_by_label() {
    let text = "run,p\n1,a\n1,a\n1,\n1,b\n2,b\n2,a\n";
    let recording = Recording::read(
        "t",
        text,
        &[
            crate::recording::Request::labels("run", "run"),
            crate::recording::Request::labels("p", "p"),
        ],
        &UnitTable::default(),
    )
    .expect("no fault");
    let columns = [
        recording.labels("run").expect("run"),
        recording.labels("p").expect("p"),
    ];
    let dwells = by_label(&columns);
    assert_eq!(ranges(&dwells), [(0, 2), (3, 4), (4, 5), (5, 6)]);
    assert_eq!(dwells[2].label.as_deref(), Some("2, b"));
    assert_eq!(by_label(&[]), []);
}

/// Levels of 100 rows, with ramps of 20 rows between them.
fn staircase(levels: &[f64]) -> Vec<f64> {
    let mut values = vec![levels[0]; 100];
    for pair in levels.windows(2) {
        let ramp = (1..=20).map(|i| pair[0] + (pair[1] - pair[0]) * f64::from(i) / 21.0);
        values.extend(ramp);
        values.extend([pair[1]; 100]);
    }
    values
}

#[test]
fn dwells_by_a_commanded_stimulus() {
    let stimulus = staircase(&[0.0, 10.0, -10.0, 20.0]);
    let steps = Steps {
        fewest: 30,
        tolerance: None,
    };
    let expected = [(0, 100), (120, 220), (240, 340), (360, 460)];
    assert_eq!(ranges(&by_steps(&stimulus, &steps)), expected);
    let mut gap = stimulus;
    gap[50] = f64::NAN;
    assert_eq!(ranges(&by_steps(&gap, &steps)), expected);
    assert_eq!(by_steps(&[], &steps), []);
}

#[test]
fn dwells_by_a_measured_stimulus() {
    let noise = normals(3, 460);
    let levels = staircase(&[0.0, 10.0, -10.0, 20.0]);
    let stimulus: Vec<f64> = levels.iter().zip(noise).map(|(x, e)| x + 0.1 * e).collect();
    let dwells = by_steps(
        &stimulus,
        &Steps {
            fewest: 30,
            tolerance: None,
        },
    );
    assert_eq!(dwells.len(), 4);
    for (dwell, start) in dwells.iter().zip([0, 120, 240, 360]) {
        assert!(dwell.rows.start.abs_diff(start) <= 3, "{dwell:?}");
        assert!(dwell.rows.end.abs_diff(start + 100) <= 3, "{dwell:?}");
    }
}

/// More rows are wanted than the steps have: no dwell may reach over several of them.
#[test]
fn dwells_never_hold_several_steps() {
    let levels = (0..60).map(|level| f64::from((level * 7) % 13));
    let commanded: Vec<f64> = levels.flat_map(|level| [level; 4]).collect();
    let noise = normals(11, commanded.len());
    let measured: Vec<f64> = commanded
        .iter()
        .zip(noise)
        .map(|(x, e)| x + 1e-3 * e)
        .collect();
    for stimulus in [commanded, measured] {
        let dwells = |fewest: usize| {
            let steps = Steps {
                fewest,
                tolerance: None,
            };
            by_steps(&stimulus, &steps)
        };
        assert_eq!(dwells(3).len(), 60);
        assert_eq!(dwells(6), []);
    }
}

#[test]
fn a_slow_ramp_is_no_dwell() {
    let ramp: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.01).collect();
    let steps = Steps {
        fewest: 20,
        tolerance: Some(1.0),
    };
    assert_eq!(by_steps(&ramp, &steps), []);
    // A long one takes no time that grows with its square.
    let long: Vec<f64> = (0..300_000).map(|i| f64::from(i) * 0.01).collect();
    assert_eq!(
        by_steps(
            &long,
            &Steps {
                fewest: 5,
                tolerance: Some(0.1)
            }
        ),
        []
    );
}

#[test]
fn dwells_by_stillness() {
    // Two outputs, turned between three poses; while turning they swing.
    let noise = normals(7, 2 * 1500);
    let pose = |row: usize| [0, 1, 2][row / 500];
    let moving = |row: usize| row % 500 >= 400;
    let output = |axis: usize| -> Vec<f64> {
        (0..1500)
            .map(|row| {
                let level = 32768.0 + 1000.0 * f64::from(pose(row) * (axis as i32 + 1));
                let swing = if moving(row) {
                    50.0 * (row as f64 * 0.3).sin()
                } else {
                    0.0
                };
                (level + swing + 2.0 * noise[2 * row + axis]).round()
            })
            .collect()
    };
    let (x, y) = (output(0), output(1));
    let dwells = by_stillness(
        &[&x, &y],
        &Stillness {
            window: 25,
            factor: 3.0,
        },
    );
    assert_eq!(dwells.len(), 3, "{dwells:?}");
    for (dwell, start) in dwells.iter().zip([0, 500, 1000]) {
        assert!(
            dwell.rows.start.abs_diff(start) <= 3 && dwell.rows.end.abs_diff(start + 400) <= 3,
            "{dwell:?}"
        );
    }
    assert_eq!(
        by_stillness(
            &[],
            &Stillness {
                window: 25,
                factor: 3.0
            }
        ),
        []
    );
    assert_eq!(
        by_stillness(
            &[&x[..10]],
            &Stillness {
                window: 25,
                factor: 3.0
            }
        ),
        []
    );
}

#[test]
fn settling_is_cut() {
    let dwells: Vec<Dwell> = [0..10, 10..13]
        .into_iter()
        .map(|rows| Dwell { label: None, rows })
        .collect();
    let settling = Settling {
        settle: 4.0,
        dwell: Some(3.0),
        fewest: 2,
    };
    let cut = Cut::new(&dwells, None, &settling);
    assert_eq!(
        (ranges(&cut.kept), ranges(&cut.lost)),
        (vec![(4, 7)], vec![(10, 13)])
    );
    let times: Vec<f64> = (0..13).map(|row| 100.0 + f64::from(row) * 2.0).collect();
    let cut = Cut::new(&dwells, Some(&times), &settling);
    assert_eq!(ranges(&cut.kept), [(2, 4)]);
    let all = Settling {
        settle: 0.0,
        dwell: None,
        fewest: 1,
    };
    assert_eq!(Cut::new(&dwells, Some(&times), &all).kept, dwells);
}

#[test]
fn averages_of_few_readings() {
    let average = Average::of(&[1.0, f64::NAN, 2.0, 3.0]).expect("three readings");
    assert_eq!(
        (average.mean, average.s, average.n, average.missing),
        (2.0, 1.0, 3, 1)
    );
    assert!((average.u - 1.0 / 3.0_f64.sqrt()).abs() < 1e-15);
    assert_eq!(
        (average.dof, average.minimum, average.maximum),
        (2.0, 1.0, 3.0)
    );
    assert_eq!(
        Average::of(&[1.0, f64::NAN]),
        Err(TooFew {
            found: 1,
            needed: 2
        })
    );
    let constant = Average::of(&[5.0; 20]).expect("readings");
    assert_eq!(
        (constant.u, constant.dof, constant.autocorrelation),
        (0.0, 19.0, 0.0)
    );
    let constant = Average::of(&[0.1; 20_000]).expect("readings");
    assert!(
        constant.u < 1e-15 && constant.effective > 0.0,
        "{constant:?}"
    );
}

/// x_i = φ x_{i−1} + e_i in the steady state, of variance 1/(1 − φ²).
fn autoregressive(phi: f64, noise: &[f64]) -> Vec<f64> {
    let mut x = noise[0] / (1.0 - phi * phi).sqrt();
    noise[1..]
        .iter()
        .map(|e| {
            x = phi * x + e;
            x
        })
        .collect()
}

#[test]
fn the_uncertainty_of_a_mean_is_its_scatter() {
    // The variance of the mean of an autoregressive series is that of theory,
    // σ²/n² (n (1+φ)/(1−φ) − 2φ(1−φⁿ)/(1−φ)²); the estimates are so on the average.
    for (phi, n, runs, tolerance) in [
        (0.0, 400, 200, 0.1),
        (0.6, 400, 200, 0.12),
        (0.9, 2000, 60, 0.15),
        (0.6, 20_000, 10, 0.1),
    ] {
        let noise = normals(11, runs * (n + 1));
        let mean_square: f64 = noise
            .chunks(n + 1)
            .map(|chunk| {
                Average::of(&autoregressive(phi, chunk))
                    .expect("readings")
                    .u
                    .powi(2)
            })
            .sum::<f64>()
            / runs as f64;
        let count = n as f64;
        let sum = count * (1.0 + phi) / (1.0 - phi)
            - 2.0 * phi * (1.0 - phi.powi(n as i32)) / ((1.0 - phi) * (1.0 - phi));
        let theory = sum / (1.0 - phi * phi) / (count * count);
        let ratio = mean_square / theory;
        assert!(
            (ratio - 1.0).abs() < tolerance,
            "φ = {phi}, n = {n}: {ratio}"
        );
    }
}

#[test]
fn drifts() {
    // The textbook line through (0, 1), (1, 3), (2, 2), (3, 5): slope 1.1, s² = 1.35, Sxx = 5.
    let drift = Drift::of(&[0.0, 1.0, 2.0, 3.0], &[1.0, 3.0, 2.0, 5.0]).expect("a line");
    assert!((drift.slope - 1.1).abs() < 1e-14 && (drift.total - 3.3).abs() < 1e-14);
    assert!((drift.u_slope - (1.35_f64 / 5.0).sqrt()).abs() < 1e-14);
    assert!((drift.u_middle - (1.35_f64 / 4.0).sqrt()).abs() < 1e-14);
    assert_eq!(drift.dof, 2.0);
    assert!(Drift::of(&[0.0, 1.0], &[1.0, 2.0]).is_none());
    assert!(Drift::of(&[1.0; 9], &[1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 1.0, 2.0, 3.0]).is_none());
    let exact = Drift::of(&[0.0, 1.0, 2.0, 3.0], &[0.0; 4]).expect("a line");
    assert_eq!(exact.p_value, 1.0);
}

#[test]
fn drifts_scatter_as_they_say() {
    for phi in [0.0, 0.6] {
        let (n, runs) = (500, 300);
        let times: Vec<f64> = (0..n).map(|i| i as f64 * 0.1).collect();
        let noise = normals(13, runs * (n + 1));
        let drifts: Vec<Drift> = noise
            .chunks(n + 1)
            .map(|chunk| {
                let readings: Vec<f64> = autoregressive(phi, chunk)
                    .iter()
                    .zip(&times)
                    .map(|(x, t)| x + 0.05 * t)
                    .collect();
                Drift::of(&times, &readings).expect("a line")
            })
            .collect();
        let runs = runs as f64;
        let scatter = drifts.iter().map(|d| (d.slope - 0.05).powi(2)).sum::<f64>() / runs;
        let stated = drifts.iter().map(|d| d.u_slope.powi(2)).sum::<f64>() / runs;
        assert!(
            (scatter / stated - 1.0).abs() < 0.25,
            "φ = {phi}: {}",
            scatter / stated
        );
        // Where there is a drift the mean seems to scatter more than the line through it.
        let readings: Vec<f64> = noise[..n].iter().zip(&times).map(|(x, t)| x + t).collect();
        let average = Average::of(&readings).expect("readings");
        let drift = Drift::of(&times, &readings).expect("a line");
        assert!(drift.u_middle < 0.2 * average.u && drift.p_value < 1e-9);
        // Without drift the p-values are spread evenly over 0 to 1.
        let below = noise
            .chunks(n + 1)
            .filter_map(|chunk| Drift::of(&times, &autoregressive(phi, chunk)))
            .filter(|drift| drift.p_value < 0.3)
            .count() as f64;
        assert!((below / runs - 0.3).abs() < 0.1, "{}", below / runs);
    }
}

#[test]
fn dwells_of_any_length_by_a_measured_stimulus() {
    // Steps of 60 rows with few rows between them, and noise that a short window does not show in full.
    let noise = normals(17, 420);
    let stimulus: Vec<f64> = noise
        .iter()
        .enumerate()
        .map(|(row, e)| {
            let (level, place) = (row / 60, row % 60);
            let ramp = if place < 6 {
                5.0 * (place as f64 - 6.0)
            } else {
                0.0
            };
            100.0 * level as f64 + ramp + 0.002 * e
        })
        .collect();
    for fewest in [2, 12, 40] {
        let steps = Steps {
            fewest,
            tolerance: None,
        };
        let dwells = by_steps(&stimulus, &steps);
        assert_eq!(dwells.len(), 7, "{fewest}: {dwells:?}");
        assert!(
            dwells.iter().all(|dwell| dwell.rows.len() == 54),
            "{dwells:?}"
        );
    }
}
