use super::*;
use crate::{level, levels};

fn lines() -> (Block, Block) {
    let (mut start, mut slope) = (Block::ZERO, Block::ZERO);
    for i in 0..LANES {
        start.0[i] = (i as f64 * 0.37).sin();
        slope.0[i] = if i % 3 == 0 {
            -0.5
        } else {
            1.0 + (i % 5) as f64
        };
    }
    (start, slope)
}

#[test]
fn a_rectangle_moved_and_stretched_keeps_its_share() {
    let (start, slope) = lines();
    let kernel = Kernel::Uniform {
        lower: -1.0,
        upper: 1.0,
    };
    let mut sums = [[0.0; 2]; 2];
    kernel.add(
        level(),
        Paths {
            start: &start,
            slope: &slope,
            bend: None,
        },
        &[0.3, 9.0],
        &mut sums,
    );
    let share = |i: usize| {
        let half = slope.0[i].abs();
        ((0.3 - start.0[i] + half) / (2.0 * half)).clamp(0.0, 1.0)
    };
    let exact: f64 = (0..LANES).map(share).sum();
    assert!((sums[0][0] - exact).abs() < 1e-11, "{} {exact}", sums[0][0]);
    assert_eq!(sums[1], [256.0, 0.0]);
}

#[test]
fn moments_are_those_of_the_mixture() {
    let (start, slope) = lines();
    // E = ±1 with probability one half each: moments 1, 0, 1.
    let found = power_sums(
        level(),
        Paths {
            start: &start,
            slope: &slope,
            bend: None,
        },
        &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0],
        [0.25, 2.0],
    );
    for (k, found) in found.into_iter().enumerate() {
        let power = |y: f64| ((y - 0.25) * 2.0).powi(k as i32 + 1);
        let exact: f64 = (0..LANES)
            .map(|i| 0.5 * (power(start.0[i] + slope.0[i]) + power(start.0[i] - slope.0[i])))
            .sum();
        assert!(
            (found - exact).abs() < 1e-9 * exact.abs().max(1.0),
            "{k}: {found} {exact}"
        );
    }
}

/// Points a + bE + cE², E uniform on ±1, with vertices on either side of its reach; against E at many places.
#[test]
fn parabolas_are_mixtures_of_both_branches() {
    const STEPS: usize = 4000;
    let kernel = Kernel::Uniform {
        lower: -1.0,
        upper: 1.0,
    };
    let thirds = [
        1.0,
        0.0,
        1.0 / 3.0,
        0.0,
        0.2,
        0.0,
        1.0 / 7.0,
        0.0,
        1.0 / 9.0,
    ];
    let (start, slope) = lines();
    for part in [0.01, 0.7] {
        let mut bend = Block::ZERO;
        for (i, c) in bend.0.iter_mut().enumerate() {
            *c = part * [1.0, -1.0, 0.0, 0.4][i % 4];
        }
        let paths = Paths {
            start: &start,
            slope: &slope,
            bend: Some(&bend),
        };
        let mut values = Vec::new();
        for i in 0..LANES {
            values.extend((0..STEPS).map(|k| {
                let e = (2 * k + 1) as f64 / STEPS as f64 - 1.0;
                start.0[i] + e * (slope.0[i] + e * bend.0[i])
            }));
        }
        let mean = |f: &dyn Fn(f64) -> f64| values.iter().map(|y| f(*y)).sum::<f64>();
        let at = [-1.2, 0.3, 2.0];
        let mut sums = [[0.0; 2]; 3];
        kernel.add(level(), paths, &at, &mut sums);
        for (y, [below, density]) in at.into_iter().zip(sums) {
            let exact = mean(&|value| f64::from(value <= y)) / STEPS as f64;
            assert!((below - exact).abs() < 0.02, "{part} {y}: {below} {exact}");
            // The densities of single points have poles.
            let around = mean(&|value| f64::from((value - y).abs() <= 0.02)) / 0.04;
            let exact = around / STEPS as f64;
            assert!(
                (density - exact).abs() < 0.2 * exact,
                "{part} {y}: {density} {exact}"
            );
        }
        let powers = power_sums(level(), paths, &thirds, [0.25, 2.0]);
        for (k, power) in powers.into_iter().enumerate() {
            let exact = mean(&|y| ((y - 0.25) * 2.0).powi(k as i32 + 1)) / STEPS as f64;
            assert!(
                (power - exact).abs() < 1e-4 * exact.abs().max(1.0),
                "{k}: {power} {exact}"
            );
        }
    }
}

#[test]
fn convolution_adds_quantities() {
    // Two dice; the sum of the middle and the most is lost at the end.
    let (a, taps) = ([0.0, 0.5, 0.5, 0.0], [0.25, 0.25, 0.5]);
    for level in levels() {
        let mut out = [9.0; 4];
        convolve(level, &a, &taps, &mut out);
        assert_eq!(out, [0.125, 0.25, 0.375, 0.25]);
    }
}

#[test]
fn convolutions_follow_their_definition() {
    let a: Vec<f64> = (0..75).map(|i| f64::from(i).sqrt()).collect();
    let taps: Vec<f64> = (0..9).map(|k| 1.0 / f64::from(k + 3)).collect();
    let term = |n: usize, k: usize| Some(a.get((n + 4).checked_sub(k)?)? * taps[k]);
    for level in levels() {
        let mut out = vec![9.0; a.len()];
        convolve(level, &a, &taps, &mut out);
        for (n, out) in out.iter().enumerate() {
            let sum: f64 = (0..9).filter_map(|k| term(n, k)).sum();
            assert!((out - sum).abs() < 1e-14 * sum, "{n}: {out} {sum}");
        }
    }
}

#[test]
fn all_instruction_sets_agree() {
    let (start, slope) = lines();
    let kernel = Kernel::Unbounded {
        steps: Steps::new([-1.0, 1.0], |block| {
            block.0 = block.0.map(|s| 0.5 + 0.5 * s)
        }),
        width: 2.0,
    };
    let all: Vec<[[f64; 2]; 1]> = levels()
        .into_iter()
        .map(|level| {
            let mut sums = [[0.0; 2]];
            kernel.add(
                level,
                Paths {
                    start: &start,
                    slope: &slope,
                    bend: None,
                },
                &[0.3],
                &mut sums,
            );
            sums
        })
        .collect();
    assert!(all.iter().all(|sums| *sums == all[0]));
}
