//! A quartz accelerometer on a dividing head.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::{Catalogue, Rig, Timeline, normals, relaxation, slow, times, unnamed, walking};

/// Twelve positions clockwise, counter-clockwise (and clockwise), in one mount or in two.
pub fn tumble(seed: u64, mounts: &[f64]) -> Rig {
    let runs: &[bool] = if mounts.len() == 1 {
        &[true, false, true]
    } else {
        &[true, false]
    };
    let (mut t, mut phi, mut mu, mut way, mut run) = (vec![], vec![], vec![], vec![], vec![]);
    let mut now = 5.0;
    for (m, mount) in mounts.iter().enumerate() {
        for (r, clockwise) in runs.iter().enumerate() {
            for k in 0..12 {
                let place = if *clockwise { k } else { 11 - k };
                t.push(now);
                phi.push(f64::from(place) * PI / 6.0);
                mu.push(mount.to_radians());
                way.push(if *clockwise { 1.0 } else { -1.0 });
                run.push(m * runs.len() + r);
                now += 5.0;
            }
            now += 15.0;
        }
    }
    let n = t.len();
    let alpha: Vec<f64> = phi.iter().zip(&mu).map(|(a, b)| a + b).collect();
    let s: Vec<f64> = alpha.iter().map(|a| a.sin()).collect();
    let cosine: Vec<f64> = alpha.iter().map(|a| a.cos()).collect();
    let ones = vec![1.0; n];
    let mut parameters = vec![ones.clone(), s.clone(), cosine.clone()];
    if mounts.len() > 1 {
        let second: Vec<f64> = (0..n)
            .map(|i| if i >= n / 2 { cosine[i] } else { 0.0 })
            .collect();
        parameters.push(second);
    }
    let jacobian = DMatrix::from_fn(n, parameters.len(), |i, j| parameters[j][i]);

    let mut c = Catalogue::new(n);
    let pow = |x: &[f64], p: i32| x.iter().map(|x| x.powi(p)).collect::<Vec<f64>>();
    let absolute: Vec<f64> = s.iter().map(|s| s.abs()).collect();
    let harmonic = |k: f64| {
        vec![vec![
            (0..n).map(|i| cosine[i] * (k * phi[i]).sin()).collect(),
            (0..n).map(|i| cosine[i] * (k * phi[i]).cos()).collect(),
        ]]
    };
    c.one("K2", "nonlinearity", pow(&s, 2));
    c.one("K3", "nonlinearity", pow(&s, 3));
    c.one("Kip", "nonlinearity", times(&s, &cosine));
    c.one("Kpp", "nonlinearity", pow(&cosine, 2));
    c.one("ASYM", "nonlinearity", absolute);
    c.named("ECC1", "encoder", harmonic(1.0));
    c.named("ECC2", "encoder", harmonic(2.0));
    c.one("BACK", "history", times(&cosine, &way));
    let relaxed = [1.0, 3.0, 8.0]
        .iter()
        .map(|tau| vec![relaxation(&t, &s, *tau)])
        .collect();
    c.named("SETTLE", "history", relaxed);
    c.one("HYST", "history", way.clone());
    let last = run[n - 1];
    let shifts = |weight: &[f64]| -> Vec<Vec<Vec<f64>>> {
        (1..=last)
            .map(|k| {
                vec![
                    (0..n)
                        .map(|i| if run[i] >= k { weight[i] } else { 0.0 })
                        .collect(),
                ]
            })
            .collect()
    };
    c.named("RUNSHIFT", "jump", shifts(&ones));
    c.named("RUNSCALE", "jump", shifts(&s));
    let steps = (1..n)
        .map(|k| vec![(0..n).map(|i| if i >= k { 1.0 } else { 0.0 }).collect()])
        .collect();
    c.named("STEP", "jump", steps);
    let bad = (0..n)
        .map(|k| vec![(0..n).map(|i| if i == k { 1.0 } else { 0.0 }).collect()])
        .collect();
    c.named("BADDWELL", "jump", bad);
    let supply = normals(seed, 3, n);
    let timeline = Timeline {
        t: &t,
        temperature: &slow(seed, 1, &t),
        supply: &supply,
        humidity: &slow(seed, 4, &t),
        pressure: &slow(seed, 5, &t),
    };
    timeline.add(&mut c, std::slice::from_ref(&ones), &s);
    timeline.generics(&mut c, std::slice::from_ref(&ones), &s);
    let place: Vec<usize> = phi
        .iter()
        .map(|p| (p * 6.0 / PI).round() as usize)
        .collect();
    let sided: Vec<usize> = place
        .iter()
        .zip(&way)
        .map(|(p, w)| if *w > 0.0 { *p } else { p + 12 })
        .collect();
    for (node, slope) in [("bias", &ones), ("scale", &s), ("angle", &cosine)] {
        c.generic(node, "head angle", unnamed::periodic(slope, &phi, 5));
        c.generic(node, "run", unnamed::levels(slope, &run));
        c.generic(
            node,
            "direction",
            unnamed::levels(
                slope,
                &way.iter()
                    .map(|w| usize::from(*w > 0.0))
                    .collect::<Vec<_>>(),
            ),
        );
    }
    c.generic("bias", "position", unnamed::levels(&ones, &place));
    c.generic(
        "bias",
        "position and direction",
        unnamed::levels(&ones, &sided),
    );
    c.generic("angle", "time", unnamed::curve(&cosine, &t));
    c.rig(jacobian, walking(&t, 0.4), 30.0)
}
