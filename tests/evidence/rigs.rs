//! Four rigs as matrices: a quartz accelerometer on a dividing head with one mount and with two, a
//! triad of accelerometers in eighteen orientations, a triad of gyros on a rate table.

use std::f64::consts::PI;

use gumption::diagnose::evidence::{Atom, Candidate, Covariance, Place, Shape};
use gumption_lanes::sampler::normal_block;
use gumption_lanes::{Block, Generator, LANES, level};
use nalgebra::{DMatrix, DVector};

/// A design with its noise and its hypotheses.
pub struct Rig {
    pub name: &'static str,
    pub jacobian: DMatrix<f64>,
    pub covariance: Covariance,
    /// Degrees of freedom with which the scale of the noise is known.
    pub scale_dof: f64,
    pub candidates: Vec<Candidate>,
    pub atoms: Vec<Atom>,
}

/// Normal numbers of one address.
pub fn normals(seed: u64, stream: u64, count: usize) -> Vec<f64> {
    let mut generator = Generator::new(seed, 77, stream);
    let mut block = Block::ZERO;
    let mut out = Vec::new();
    while out.len() < count {
        normal_block(level(), &mut generator, &mut block);
        out.extend_from_slice(&block.0[..LANES.min(count - out.len())]);
    }
    out
}

/// Builds up candidates over the rows of one rig.
struct Catalogue {
    rows: usize,
    candidates: Vec<Candidate>,
    atoms: Vec<Atom>,
}

impl Catalogue {
    fn new(rows: usize) -> Catalogue {
        Catalogue {
            rows,
            candidates: Vec::new(),
            atoms: Vec::new(),
        }
    }

    fn candidate(&mut self, name: &str, family: &str, node: &str, along: &str) -> usize {
        self.candidates.push(Candidate {
            name: name.into(),
            family: family.into(),
            place: Place {
                node: node.into(),
                along: along.into(),
            },
            typical: None,
            repeats: false,
        });
        self.candidates.len() - 1
    }

    fn atom(&mut self, candidate: usize, variant: String, shape: Shape) {
        self.atoms.push(Atom {
            candidate,
            variant,
            shape,
            share: 1.0,
        });
    }

    /// A candidate of several variants, each of several columns.
    fn named(&mut self, name: &str, family: &str, variants: Vec<Vec<Vec<f64>>>) -> usize {
        let candidate = self.candidate(name, family, "", "");
        for (i, columns) in variants.into_iter().enumerate() {
            let matrix = DMatrix::from_fn(self.rows, columns.len(), |r, c| {
                if columns[c][r].abs() < 1e-9 { 0.0 } else { columns[c][r] }
            });
            self.atom(candidate, i.to_string(), Shape::Columns(matrix));
        }
        candidate
    }

    /// A candidate of one column.
    fn one(&mut self, name: &str, family: &str, column: Vec<f64>) {
        self.named(name, family, vec![vec![column]]);
    }

    fn generic(&mut self, node: &str, along: &str, shape: Shape) {
        let candidate = self.candidate(&format!("?{node}({along})"), "?", node, along);
        self.atom(candidate, String::new(), shape);
    }

    fn rig(
        self,
        name: &'static str,
        jacobian: DMatrix<f64>,
        covariance: Covariance,
        scale_dof: f64,
    ) -> Rig {
        Rig {
            name,
            jacobian,
            covariance,
            scale_dof,
            candidates: self.candidates,
            atoms: self.atoms,
        }
    }
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn centred(x: &[f64]) -> Vec<f64> {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    x.iter().map(|x| x - mean).collect()
}

/// A slow covariate: a few waves of random phase and a trend.
fn slow(seed: u64, stream: u64, t: &[f64]) -> Vec<f64> {
    let n = normals(seed, stream, 12);
    let end = t[t.len() - 1].max(1.0);
    let wave = |t: f64| {
        (0..4)
            .map(|k| {
                let phase = (k as f64 * 0.8 + 0.6) * 2.0 * PI * t / end;
                (n[2 * k] * phase.sin() + n[2 * k + 1] * phase.cos()) / (1.0 + k as f64)
            })
            .sum::<f64>()
            + n[8] * t / end
    };
    centred(&t.iter().map(|t| wave(*t)).collect::<Vec<f64>>())
}

/// First-order lag of a covariate sampled at the rows, computed on a fine grid.
fn lagged(t: &[f64], x: &[f64], tau: f64) -> Vec<f64> {
    if tau == 0.0 {
        return x.to_vec();
    }
    let mut state = x[0];
    let mut out = vec![x[0]];
    for i in 1..t.len() {
        if t[i] <= t[i - 1] {
            // The rows of the next axis begin.
            state = x[i];
            out.push(state);
            continue;
        }
        let steps = 20;
        let dt = (t[i] - t[i - 1]) / f64::from(steps);
        for k in 0..steps {
            let now = x[i - 1] + (x[i] - x[i - 1]) * f64::from(k) / f64::from(steps);
            state += (now - state) * (1.0 - (-dt / tau).exp());
        }
        out.push(state);
    }
    centred(&out)
}

fn rate_of(t: &[f64], x: &[f64]) -> Vec<f64> {
    let slope = |i: usize| (x[i] - x[i - 1]) / (t[i] - t[i - 1]);
    let starts = |i: usize| i == 0 || t[i] <= t[i - 1];
    let out: Vec<f64> = (0..t.len())
        .map(|i| if starts(i) { slope(i + 1) } else { slope(i) })
        .collect();
    centred(&out)
}

/// White noise of unit variance and a random walk of `walk` per root hour; times in minutes.
fn walking(t: &[f64], walk: f64) -> Covariance {
    let start = t[0] - 5.0;
    Covariance::Dense(DMatrix::from_fn(t.len(), t.len(), |i, j| {
        let common = walk * walk * (t[i].min(t[j]) - start) / 60.0;
        if i == j { 1.0 + common } else { common }
    }))
}

/// What anelastic relaxation leaves of earlier steps of the input.
fn relaxation(t: &[f64], input: &[f64], tau: f64) -> Vec<f64> {
    (0..t.len())
        .map(|i| {
            (1..=i)
                .map(|j| (input[j - 1] - input[j]) * (-(t[i] - t[j] + 2.0) / tau).exp())
                .sum()
        })
        .collect()
}

/// Which effects of time and covariates are common to all rigs. `scale` is the derivative of the
/// output by a scale error.
struct Timeline<'a> {
    t: &'a [f64],
    temperature: &'a [f64],
    supply: &'a [f64],
    humidity: &'a [f64],
    pressure: &'a [f64],
}

impl Timeline<'_> {
    /// Columns in `bias` directions: one variant per mask.
    fn add(&self, c: &mut Catalogue, masks: &[Vec<f64>], scale: &[f64]) {
        let t = self.t;
        let end = t[t.len() - 1];
        let hours: Vec<f64> = t.iter().map(|t| t / 60.0).collect();
        let over = |shapes: &[Vec<f64>]| -> Vec<Vec<Vec<f64>>> {
            masks
                .iter()
                .flat_map(|mask| shapes.iter().map(move |x| vec![times(mask, x)]))
                .collect()
        };
        let lags: Vec<Vec<f64>> = [0.0, 6.0, 13.0, 27.0]
            .iter()
            .map(|tau| lagged(t, self.temperature, *tau))
            .collect();
        let warm: Vec<Vec<f64>> = [0.05, 0.12, 0.3]
            .iter()
            .map(|share| t.iter().map(|t| (-t / (share * end)).exp()).collect())
            .collect();
        let log: Vec<f64> = t.iter().map(|t| (1.0 + t / 10.0).ln()).collect();
        let squared = centred(&times(self.temperature, self.temperature));
        c.named("TBIAS", "temperature", over(&lags));
        let scaled: Vec<Vec<f64>> = lags.iter().map(|x| times(scale, x)).collect();
        c.named("TSF", "temperature", over(&scaled));
        c.named("TBIAS2", "temperature", over(&[squared]));
        c.named("DTDT", "temperature", over(&[rate_of(t, self.temperature)]));
        c.named("WARMUP", "time", over(&warm));
        c.named("DRIFT", "time", over(&[hours.clone(), log]));
        c.named("SFDRIFT", "time", over(&[times(scale, &hours)]));
        c.named("SUPPLY", "supply", over(&[self.supply.to_vec()]));
        c.named("HUMIDITY", "decoy", over(&[self.humidity.to_vec()]));
        c.named("PRESSURE", "decoy", over(&[self.pressure.to_vec()]));
    }

    fn generics(&self, c: &mut Catalogue, masks: &[Vec<f64>], scale: &[f64]) {
        for (i, mask) in masks.iter().enumerate() {
            let scaled = times(mask, scale);
            let of = |name: &str| {
                if masks.len() > 1 {
                    format!("{name} {i}")
                } else {
                    name.to_string()
                }
            };
            for (name, x) in [
                ("time", self.t),
                ("temperature", self.temperature),
                ("supply", self.supply),
                ("humidity", self.humidity),
                ("pressure", self.pressure),
            ] {
                c.generic(&of("bias"), name, Shape::curve(mask, x));
                if name == "time" || name == "temperature" {
                    c.generic(&of("scale"), name, Shape::curve(&scaled, x));
                }
            }
        }
        let scatter = c.candidate("?scatter", "?", "output", "");
        c.atom(scatter, String::new(), Shape::Scatter);
    }
}

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
    let place: Vec<usize> = phi.iter().map(|p| (p * 6.0 / PI).round() as usize).collect();
    let sided: Vec<usize> = place
        .iter()
        .zip(&way)
        .map(|(p, w)| if *w > 0.0 { *p } else { p + 12 })
        .collect();
    for (node, slope) in [("bias", &ones), ("scale", &s), ("angle", &cosine)] {
        c.generic(node, "head angle", Shape::periodic(slope, &phi, 5));
        c.generic(node, "run", Shape::levels(slope, &run));
        c.generic(node, "direction", Shape::levels(slope, &way.iter().map(|w| usize::from(*w > 0.0)).collect::<Vec<_>>()));
    }
    c.generic("bias", "position", Shape::levels(&ones, &place));
    c.generic("bias", "position and direction", Shape::levels(&ones, &sided));
    c.generic("angle", "time", Shape::curve(&cosine, &t));
    let name = if mounts.len() == 1 { "tumble" } else { "tumble2" };
    c.rig(name, jacobian, walking(&t, 0.4), 30.0)
}

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
    c.named("ASYM", "nonlinearity", scoped(own.iter().map(|x| x.abs()).collect()));
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
    let el: Vec<f64> = g.iter().map(|g| libm::asin(g[2].clamp(-1.0, 1.0))).collect();
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
            c.generic(&format!("bias {a}"), &format!("g {name}"), Shape::curve(mask, &along));
        }
        let orientation: Vec<usize> = (0..n).map(|r| orientation(&g, r % poses)).collect();
        c.generic(&format!("bias {a}"), "orientation", Shape::levels(mask, &orientation));
    }
    c.generic("azimuth", "azimuth", Shape::periodic(&row(&by_az), &spread(az.clone()), 3));
    c.generic("elevation", "elevation", Shape::periodic(&row(&by_el), &spread(el.clone()), 3));
    c.rig("triad", jacobian, by_axis(&time, 3, 0.4), 60.0)
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
        if i / n == j / n { one[(i % n, j % n)] } else { 0.0 }
    }))
}

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
    c.named("SIGN", "nonlinearity", scoped(&map(&|w| if w == 0.0 { 0.0 } else { w.signum() })));
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
    let squared = row(&|a, ch, d| if ch == 0 { gravity(a, 0, d).powi(2) } else { 0.0 });
    c.named("G2", "acceleration", scoped(&squared));
    c.one("EARTH", "field", row(&|a, ch, d| fixed(0.75, 0.66, a, ch, d)));
    c.one("MAG", "field", row(&|a, ch, d| fixed(-0.9, 0.45, a, ch, d)));
    let centri: Vec<Vec<Vec<f64>>> = (0..3)
        .map(|s| {
            (0..3)
                .map(|k| {
                    row(&|a, ch, d| {
                        let (mount, w) = cells[d];
                        let across = mounts[mount].1[k];
                        if a == s && ch == 0 { across * w * w / 1e4 } else { 0.0 }
                    })
                })
                .collect()
        })
        .collect();
    c.named("CENTRI", "acceleration", centri);
    let ripple = |channel: usize| {
        row(&|a, ch, d| if ch == channel { omega(a, d) } else { 0.0 })
    };
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
        c.generic(&format!("bias {a}"), "rate", Shape::curve(mask, &along));
        c.generic(&format!("bias {a}"), "mount", Shape::levels(mask, &mount));
        let cosine = row(&|axis, ch, _| if axis == a && ch == 1 { 1.0 } else { 0.0 });
        let sine = row(&|axis, ch, _| if axis == a && ch == 2 { 1.0 } else { 0.0 });
        let across: Vec<f64> = cosine.iter().zip(&sine).map(|(c, s)| c + s).collect();
        let cell: Vec<usize> = (0..n)
            .map(|r| cells[r % dwells].0 + 6 * usize::from(r / dwells % 3 == 2))
            .collect();
        c.generic(&format!("turn {a}"), "mount", Shape::levels(&across, &cell));
        let proportional = times(&across, &row(&|_, _, d| cells[d].1 / 100.0));
        c.generic(&format!("turn rate {a}"), "mount", Shape::levels(&proportional, &cell));
    }
    c.rig("rate", jacobian, by_axis_and_channel(&time), 60.0)
}

/// Means with white noise and a random walk, harmonics white; axes independent.
fn by_axis_and_channel(time: &[f64]) -> Covariance {
    let one = walking(time, 0.4).to_dense();
    let n = time.len();
    Covariance::Dense(DMatrix::from_fn(9 * n, 9 * n, |i, j| {
        if i / n != j / n {
            0.0
        } else if (i / n) % 3 == 0 {
            one[(i % n, j % n)]
        } else if i == j {
            1.0
        } else {
            0.0
        }
    }))
}

/// A recording of a rig: unit-variance noise of its covariance, plus columns times coefficients.
pub fn recording(rig: &Rig, lower: &DMatrix<f64>, effect: &DVector<f64>, seed: u64, stream: u64) -> DVector<f64> {
    let noise = DVector::from_vec(normals(seed, stream, rig.jacobian.nrows()));
    lower * noise + effect
}
