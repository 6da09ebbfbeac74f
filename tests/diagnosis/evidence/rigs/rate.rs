//! A triad of gyros on a rate table.

use gumption::diagnose::evidence::Covariance;
use nalgebra::DMatrix;

use super::{Catalogue, Rig, Timeline, normals, slow, times, unnamed, walking};

/// A triad of gyros in six mounts at eight rates: mean, cosine and sine over the turn, for each axis.
pub fn rate(seed: u64) -> Rig {
    // The table axis in the frame of the sensors, and a direction across it that is north at ψ = 0.
    let mounts: [([f64; 3], [f64; 3]); 6] = [
        ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ([-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
    ];
    let levels = [10.0, -10.0, 40.0, -40.0, 70.0, -70.0, 100.0, -100.0];
    let cells: Vec<(usize, f64)> = (0..6)
        .flat_map(|m| levels.iter().map(move |w| (m, *w)))
        .collect();
    let dwells = cells.len();
    let n = 9 * dwells;
    let time: Vec<f64> = (0..dwells)
        .map(|i| 5.0 + 4.0 * i as f64 + 10.0 * (i / 8) as f64)
        .collect();
    let third = |a: &[f64; 3], b: &[f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    // Rows: axis, then channel (mean, cos, sin), then dwell.
    let row = |f: &dyn Fn(usize, usize, usize) -> f64| -> Vec<f64> {
        (0..n)
            .map(|r| f(r / (3 * dwells), r / dwells % 3, r % dwells))
            .collect()
    };
    // A vector that is fixed in the laboratory turns in the frame of the table: its part along the
    // axis is in the means, its part across in the first harmonic, with the sense of the rotation.
    let fixed = |along: f64, across: f64, a: usize, channel: usize, d: usize| {
        let (mount, w) = cells[d];
        let (axis, north) = mounts[mount];
        match channel {
            0 => along * axis[a],
            1 => across * north[a],
            _ => -across * third(&axis, &north)[a] * w.signum(),
        }
    };
    let omega = |a: usize, d: usize| mounts[cells[d].0].0[a] * cells[d].1 / 100.0;
    let jacobian = DMatrix::from_fn(n, 12, |r, j| {
        let (axis, channel, d) = (r / (3 * dwells), r / dwells % 3, r % dwells);
        if j / 4 != axis || channel != 0 {
            0.0
        } else if j % 4 == 0 {
            1.0
        } else {
            omega(j % 4 - 1, d)
        }
    });
    let own = row(&|a, ch, d| if ch == 0 { omega(a, d) } else { 0.0 });
    let mean = row(&|_, ch, _| if ch == 0 { 1.0 } else { 0.0 });
    let masks: Vec<Vec<f64>> = (0..3)
        .map(|k| row(&|a, ch, _| if a == k && ch == 0 { 1.0 } else { 0.0 }))
        .collect();
    let mut scopes = masks.clone();
    scopes.push(mean.clone());
    let mut c = Catalogue::new(n);
    let scoped = |x: &[f64]| -> Vec<Vec<Vec<f64>>> {
        scopes.iter().map(|mask| vec![times(mask, x)]).collect()
    };
    let map = |f: &dyn Fn(f64) -> f64| own.iter().map(|x| f(*x)).collect::<Vec<f64>>();
    c.named("QUAD", "nonlinearity", scoped(&map(&|w| w * w)));
    c.named("CUBIC", "nonlinearity", scoped(&map(&|w| w * w * w)));
    c.named("ASYM", "nonlinearity", scoped(&map(&f64::abs)));
    c.named(
        "SIGN",
        "nonlinearity",
        scoped(&map(&|w| if w == 0.0 { 0.0 } else { w.signum() })),
    );
    let soft = |w: f64| w.signum() * (w.abs() - 0.6).max(0.0);
    c.named("SATUR", "nonlinearity", scoped(&map(&soft)));
    let gravity = |k: usize, ch: usize, d: usize| fixed(1.0, 0.0, k, ch, d);
    let g_columns: Vec<Vec<Vec<f64>>> = (0..3)
        .map(|s| {
            (0..3)
                .map(|k| row(&|a, ch, d| if a == s { gravity(k, ch, d) } else { 0.0 }))
                .collect()
        })
        .collect();
    c.named("GSENS", "acceleration", g_columns);
    let squared = row(&|a, ch, d| {
        if ch == 0 {
            gravity(a, 0, d).powi(2)
        } else {
            0.0
        }
    });
    c.named("G2", "acceleration", scoped(&squared));
    c.one(
        "EARTH",
        "field",
        row(&|a, ch, d| fixed(0.75, 0.66, a, ch, d)),
    );
    c.one("MAG", "field", row(&|a, ch, d| fixed(-0.9, 0.45, a, ch, d)));
    let centri: Vec<Vec<Vec<f64>>> = (0..3)
        .map(|s| {
            (0..3)
                .map(|k| {
                    row(&|a, ch, d| {
                        let (mount, w) = cells[d];
                        let across = mounts[mount].1[k];
                        if a == s && ch == 0 {
                            across * w * w / 1e4
                        } else {
                            0.0
                        }
                    })
                })
                .collect()
        })
        .collect();
    c.named("CENTRI", "acceleration", centri);
    let ripple = |channel: usize| row(&|a, ch, d| if ch == channel { omega(a, d) } else { 0.0 });
    c.named("RATE1REV", "table", vec![vec![ripple(1), ripple(2)]]);
    let wobble = |sense: f64| -> Vec<Vec<f64>> {
        [0, 1]
            .iter()
            .map(|phase| {
                row(&|a, ch, d| {
                    let (mount, w) = cells[d];
                    let (axis, north) = mounts[mount];
                    let east = third(&axis, &north);
                    let w = w / 100.0;
                    match (ch, phase) {
                        (1, 0) => w * north[a],
                        (2, 0) => w * sense * east[a],
                        (1, _) => w * east[a],
                        (2, _) => -w * sense * north[a],
                        _ => 0.0,
                    }
                })
            })
            .collect()
    };
    c.named("WOBBLE", "table", vec![wobble(1.0), wobble(-1.0)]);
    let relaxing = row(&|a, ch, d| {
        if ch != 0 || d == 0 {
            0.0
        } else {
            (omega(a, d) - omega(a, d - 1)).signum()
                * f64::from((omega(a, d) - omega(a, d - 1)).abs() > 1e-9)
        }
    });
    c.named("HYST", "history", scoped(&relaxing));
    let steps = scopes
        .iter()
        .flat_map(|mask| {
            (1..dwells).step_by(2).map(move |k| {
                vec![
                    (0..n)
                        .map(|r| if r % dwells >= k { mask[r] } else { 0.0 })
                        .collect(),
                ]
            })
        })
        .collect();
    c.named("STEP", "jump", steps);
    let spread = |x: Vec<f64>| -> Vec<f64> { row(&|_, _, d| x[d]) };
    let t = spread(time.clone());
    let timeline = Timeline {
        t: &t,
        temperature: &spread(slow(seed, 1, &time)),
        supply: &spread(normals(seed, 3, dwells)),
        humidity: &spread(slow(seed, 4, &time)),
        pressure: &spread(slow(seed, 5, &time)),
    };
    timeline.add(&mut c, &scopes, &own);
    timeline.generics(&mut c, &masks, &own);
    let mount: Vec<usize> = (0..n).map(|r| cells[r % dwells].0).collect();
    for (a, mask) in masks.iter().enumerate() {
        let along: Vec<f64> = row(&|axis, _, d| omega(axis, d));
        c.generic(&format!("bias {a}"), "rate", unnamed::curve(mask, &along));
        c.generic(&format!("bias {a}"), "mount", unnamed::levels(mask, &mount));
        let cosine = row(&|axis, ch, _| if axis == a && ch == 1 { 1.0 } else { 0.0 });
        let sine = row(&|axis, ch, _| if axis == a && ch == 2 { 1.0 } else { 0.0 });
        let across: Vec<f64> = cosine.iter().zip(&sine).map(|(c, s)| c + s).collect();
        let cell: Vec<usize> = (0..n)
            .map(|r| cells[r % dwells].0 + 6 * usize::from(r / dwells % 3 == 2))
            .collect();
        c.generic(
            &format!("turn {a}"),
            "mount",
            unnamed::levels(&across, &cell),
        );
        let proportional = times(&across, &row(&|_, _, d| cells[d].1 / 100.0));
        c.generic(
            &format!("turn rate {a}"),
            "mount",
            unnamed::levels(&proportional, &cell),
        );
    }
    c.rig(jacobian, by_axis_and_channel(&time), 60.0)
}

/// Means with white noise and a random walk, harmonics white; axes independent.
fn by_axis_and_channel(time: &[f64]) -> Covariance {
    let one = walking(time, 0.4).to_dense();
    let n = time.len();
    Covariance::Dense(DMatrix::from_fn(9 * n, 9 * n, |i, j| {
        if i / n != j / n {
            0.0
        } else if (i / n).is_multiple_of(3) {
            one[(i % n, j % n)]
        } else if i == j {
            1.0
        } else {
            0.0
        }
    }))
}
