//! A triad of accelerometers on a gimbal.

use gumption::diagnose::evidence::Covariance;
use nalgebra::DMatrix;

use super::{Catalogue, Rig, Timeline, normals, relaxation, slow, times, unnamed, walking};

/// Eighteen orientations of a triad, twice: faces and edges of a cube.
pub fn triad(seed: u64) -> Rig {
    let mut g: Vec<[f64; 3]> = Vec::new();
    for pass in 0..2 {
        let mut directions: Vec<[f64; 3]> = Vec::new();
        for a in 0..3 {
            for sign in [1.0, -1.0] {
                let mut v = [0.0; 3];
                v[a] = sign;
                directions.push(v);
            }
        }
        for a in 0..3 {
            for b in 0..a {
                for (p, q) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                    let mut v = [0.0; 3];
                    v[a] = p * 0.5_f64.sqrt();
                    v[b] = q * 0.5_f64.sqrt();
                    directions.push(v);
                }
            }
        }
        // A fixed order without pattern, another in the second pass.
        let count = directions.len();
        let stride = if pass == 0 { 5 } else { 7 };
        g.extend((0..count).map(|i| directions[(i * stride + pass) % count]));
    }
    let poses = g.len();
    let n = 3 * poses;
    let time: Vec<f64> = (0..poses).map(|i| 5.0 + 4.0 * i as f64).collect();
    let row = |f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..n).map(|r| f(r / poses, r % poses)).collect()
    };
    let jacobian = DMatrix::from_fn(n, 12, |r, j| {
        let (axis, pose) = (r / poses, r % poses);
        match (j / 4 == axis, j % 4) {
            (false, _) => 0.0,
            (true, 0) => 1.0,
            (true, k) => g[pose][k - 1],
        }
    });
    let t: Vec<f64> = row(&|_, p| time[p]);
    let masks: Vec<Vec<f64>> = (0..3)
        .map(|a| row(&|axis, _| if axis == a { 1.0 } else { 0.0 }))
        .collect();
    let mut scopes = masks.clone();
    scopes.push(vec![1.0; n]);
    let own: Vec<f64> = row(&|a, p| g[p][a]);
    let mut c = Catalogue::new(n);
    let scoped = |x: Vec<f64>| -> Vec<Vec<Vec<f64>>> {
        scopes.iter().map(|mask| vec![times(mask, &x)]).collect()
    };
    let pow = |p: i32| own.iter().map(|x| x.powi(p)).collect::<Vec<f64>>();
    c.named("K2", "nonlinearity", scoped(pow(2)));
    c.named("K3", "nonlinearity", scoped(pow(3)));
    c.named(
        "ASYM",
        "nonlinearity",
        scoped(own.iter().map(|x| x.abs()).collect()),
    );
    let cross = (0..3)
        .map(|a| {
            let pair = |b: usize| row(&|axis, p| if axis == a { g[p][a] * g[p][b] } else { 0.0 });
            vec![pair((a + 1) % 3), pair((a + 2) % 3)]
        })
        .collect();
    c.named("XPROD", "nonlinearity", cross);
    let other = row(&|a, p| g[p][(a + 1) % 3] * g[p][(a + 2) % 3]);
    c.named("XPP", "nonlinearity", scoped(other));
    let settle: Vec<Vec<f64>> = [2.0, 6.0]
        .iter()
        .map(|tau| {
            (0..3)
                .flat_map(|a| {
                    let input: Vec<f64> = g.iter().map(|g| g[a]).collect();
                    relaxation(&time, &input, *tau)
                })
                .collect()
        })
        .collect();
    c.named(
        "SETTLE",
        "history",
        scopes
            .iter()
            .flat_map(|mask| settle.iter().map(move |x| vec![times(mask, x)]))
            .collect(),
    );
    let turned = row(&|a, p| match p {
        0 => 0.0,
        p => (g[p][a] - g[p - 1][a]).signum() * f64::from((g[p][a] - g[p - 1][a]).abs() > 1e-9),
    });
    c.named("HYST", "history", scoped(turned));
    // Azimuth and elevation of the gimbals that set the orientation.
    let az: Vec<f64> = g.iter().map(|g| libm::atan2(g[1], g[0])).collect();
    let el: Vec<f64> = g
        .iter()
        .map(|g| libm::asin(g[2].clamp(-1.0, 1.0)))
        .collect();
    let by_az = |a: usize, p: usize| [-g[p][1], g[p][0], 0.0][a];
    let by_el = |a: usize, p: usize| {
        [
            -el[p].sin() * az[p].cos(),
            -el[p].sin() * az[p].sin(),
            el[p].cos(),
        ][a]
    };
    for (name, angle, k, azimuth) in [
        ("AZECC", &az, 1.0, true),
        ("AZ2", &az, 2.0, true),
        ("ELECC", &el, 1.0, false),
    ] {
        let wave = |f: fn(f64) -> f64| {
            row(&|a, p| {
                let slope = if azimuth { by_az(a, p) } else { by_el(a, p) };
                slope * f(k * angle[p])
            })
        };
        c.named(name, "encoder", vec![vec![wave(f64::sin), wave(f64::cos)]]);
    }
    let bad = (0..poses)
        .map(|k| {
            (0..3)
                .map(|b| row(&|a, p| if a == b && p == k { 1.0 } else { 0.0 }))
                .collect()
        })
        .collect();
    c.named("BADDWELL", "jump", bad);
    let steps = scopes
        .iter()
        .flat_map(|mask| {
            (1..poses).step_by(2).map(move |k| {
                vec![
                    (0..n)
                        .map(|r| if r % poses >= k { mask[r] } else { 0.0 })
                        .collect(),
                ]
            })
        })
        .collect();
    c.named("STEP", "jump", steps);
    let spread = |x: Vec<f64>| -> Vec<f64> { row(&|_, p| x[p]) };
    let timeline = Timeline {
        t: &t,
        temperature: &spread(slow(seed, 1, &time)),
        supply: &spread(normals(seed, 3, poses)),
        humidity: &spread(slow(seed, 4, &time)),
        pressure: &spread(slow(seed, 5, &time)),
    };
    // Covariates of rows repeat for every axis; lags are computed pose by pose.
    timeline.add(&mut c, &scopes, &own);
    timeline.generics(&mut c, &masks, &own);
    for (a, mask) in masks.iter().enumerate() {
        for (b, name) in ["x", "y", "z"].iter().enumerate() {
            let along: Vec<f64> = row(&|_, p| g[p][b]);
            c.generic(
                &format!("bias {a}"),
                &format!("g {name}"),
                unnamed::curve(mask, &along),
            );
        }
        let orientation: Vec<usize> = (0..n).map(|r| orientation(&g, r % poses)).collect();
        c.generic(
            &format!("bias {a}"),
            "orientation",
            unnamed::levels(mask, &orientation),
        );
    }
    c.generic(
        "azimuth",
        "azimuth",
        unnamed::periodic(&row(&by_az), &spread(az.clone()), 3),
    );
    c.generic(
        "elevation",
        "elevation",
        unnamed::periodic(&row(&by_el), &spread(el.clone()), 3),
    );
    c.rig(jacobian, by_axis(&time, 3, 0.4), 60.0)
}

fn orientation(g: &[[f64; 3]], pose: usize) -> usize {
    g.iter()
        .position(|other| (0..3).all(|k| (other[k] - g[pose][k]).abs() < 1e-9))
        .unwrap_or(0)
}

/// Independent axes, each with white noise and a random walk.
fn by_axis(time: &[f64], axes: usize, walk: f64) -> Covariance {
    let one = walking(time, walk).to_dense();
    let n = time.len();
    Covariance::Dense(DMatrix::from_fn(axes * n, axes * n, |i, j| {
        if i / n == j / n {
            one[(i % n, j % n)]
        } else {
            0.0
        }
    }))
}
