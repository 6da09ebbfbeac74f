//! Covariance and coverage regions of several outputs (JCGM 102:2011, 7.6 and 7.7).

use nalgebra::DMatrix;

use gumption_lanes::Block;

use super::collect::{Collector, Held, Plan};
use super::comoments::CoMoments;
use super::decisive_cells::Wanted;
use super::engine::{Sink, Source, simulate};
use super::interval::{Ordered, Ranked, Ranks};
use super::moments::Pivot;
use super::resolve::{Redraw, Resolved};
use super::thread_pool::ThreadPool;
use crate::propagate::result::Regions;
use gumption_core::least_squares::lower_factor;

/// Joint results of several outputs.
#[derive(Debug, Clone)]
pub(super) struct Joint {
    pub(super) covariance: DMatrix<f64>,
    pub(super) correlation: DMatrix<f64>,
    /// `None` when an output is, numerically, a linear function of the others.
    pub(super) regions: Option<Regions>,
}

/// Correlation matrices with a pivot below this are called degenerate: one output is then known
/// from the others to better than 10⁻⁵ of its own standard uncertainty.
const DEGENERATE: f64 = 1e-10;

/// Joint results of outputs whose means and covariances are known, from their trials drawn again;
/// trials in which any output failed are left out. `None` with fewer than two complete trials.
pub(super) fn joint<S: Source>(redraw: &Redraw<S>, moments: &CoMoments, p: f64) -> Option<Joint> {
    if moments.count() < 2 {
        return None;
    }
    let covariance = moments.covariance();
    let m = covariance.nrows();
    let sd: Vec<f64> = (0..m).map(|j| covariance[(j, j)].sqrt()).collect();
    let correlation = DMatrix::from_fn(m, m, |i, j| {
        let product = sd[i] * sd[j];
        if i == j {
            1.0
        } else if product > 0.0 {
            covariance[(i, j)] / product
        } else {
            0.0
        }
    });
    let factor = lower_factor(&correlation);
    let usable = |j: usize| factor[(j, j)].powi(2) > DEGENERATE && sd[j] > 0.0 && sd[j].is_finite();
    let regions = (0..m).all(usable).then(|| {
        let whitening = Whitening {
            mean: moments.means(),
            sd,
            factor,
        };
        regions(redraw, &whitening, moments.count(), p)
    });
    Some(Joint {
        covariance,
        correlation,
        regions,
    })
}

/// 7.7.2 a) and b): L z = y − ȳ, here in units of u(y_j).
struct Whitening {
    mean: Vec<f64>,
    sd: Vec<f64>,
    factor: DMatrix<f64>,
}

impl Whitening {
    /// The standardised deviations of a trial, and these decorrelated.
    fn apply(&self, outputs: &[Block], lane: usize, deviation: &mut [f64], white: &mut [f64]) {
        for i in 0..self.mean.len() {
            deviation[i] = (outputs[i].0[lane] - self.mean[i]) / self.sd[i];
            let known: f64 = (0..i).map(|k| self.factor[(i, k)] * white[k]).sum();
            white[i] = (deviation[i] - known) / self.factor[(i, i)];
        }
    }
}

/// The trials of a source as distances from the mean: z'z, and the largest |y_j − ȳ_j|/u(y_j).
struct Distances<'a, S> {
    source: &'a S,
    whitening: &'a Whitening,
}

impl<S: Source> Source for Distances<'_, S> {
    type Worker = (S::Worker, Vec<Block>, Vec<f64>, Vec<f64>);

    fn outputs(&self) -> usize {
        2
    }

    fn worker(&self) -> Self::Worker {
        let m = self.source.outputs();
        let worker = self.source.worker();
        (worker, vec![Block::ZERO; m], vec![0.0; m], vec![0.0; m])
    }

    fn start(&self, (worker, ..): &mut Self::Worker, chunk: u64) {
        self.source.start(worker, chunk);
    }

    fn next(&self, (worker, blocks, deviation, white): &mut Self::Worker, out: &mut [Block]) {
        self.source.next(worker, blocks);
        let [squares, largest] = out else { return };
        for (lane, (square, large)) in squares.0.iter_mut().zip(&mut largest.0).enumerate() {
            self.whitening.apply(blocks, lane, deviation, white);
            // NaN where any output failed.
            *square = white.iter().map(|z| z * z).sum::<f64>();
            *large = if square.is_finite() {
                deviation.iter().fold(0.0, |most, d| d.abs().max(most))
            } else {
                f64::NAN
            };
        }
    }

    fn drawn(&self, trials: u64) {
        self.source.drawn(trials);
    }
}

fn regions<S: Source>(redraw: &Redraw<S>, whitening: &Whitening, count: u64, p: f64) -> Regions {
    let m = whitening.mean.len();
    let distances = Distances {
        source: redraw.source,
        whitening,
    };
    let cells = Cells::new(m, count);
    let threads = redraw.pool.threads();
    let ([square, largest], smallest) = ThreadPool::with(threads, redraw.chunks, |pool| {
        let distances = Redraw {
            pool,
            source: &distances,
            layout: redraw.layout,
            chunks: redraw.chunks,
        };
        let fullest = cells.as_ref().and_then(|cells| {
            let count = || Count::new(whitening, cells);
            let chunks = 0..redraw.chunks;
            let (_, parts) = simulate(pool, redraw.source, redraw.layout, chunks, count);
            cells.smallest(parts, p)
        });
        (values_of_rank(&distances, p), fullest)
    });
    let k_ellipsoid = square.sqrt();
    // √det V = Π u_j · Π l_jj.
    let unit: f64 = (0..m)
        .map(|j| whitening.sd[j] * whitening.factor[(j, j)])
        .product();
    Regions {
        k_ellipsoid,
        k_rectangle: largest,
        ellipsoid_volume: unit_ball(m) * k_ellipsoid.powi(m as i32) * unit,
        smallest_volume: smallest.map(|(_, volume)| volume * unit),
        smallest_cells: smallest.map(|(cells, _)| cells),
    }
}

/// 7.7.2 d), 7.7.3 d): the q-th smallest of both distances, q = pM.
fn values_of_rank<S: Source>(redraw: &Redraw<S>, p: f64) -> [f64; 2] {
    let rank = |count: u64| Ranks::new(count as usize, p).covered.max(1);
    let ask = |count: u64| Wanted {
        ranks: vec![[rank(count) as u64; 2]],
        shortest: None,
        count,
    };
    let pivots = [Pivot::new(0.0, 1.0); 2];
    let mut collector = Collector::new(Plan {
        pool: redraw.pool,
        source: redraw.source,
        layout: redraw.layout,
        pivots: &pivots,
        p,
        ask: &ask,
    });
    collector.extend(redraw.chunks);
    match collector.into_held() {
        Held::Columns(columns) => [0, 1].map(|output| {
            let mut values = columns[output].clone();
            values.retain(|value| value.is_finite());
            let q = rank(values.len() as u64);
            Ordered::new(&values, values.len()).at(q)
        }),
        Held::Summed(mut summed) => [0, 1].map(|output| {
            let order_counts = &mut summed.order_counts[output];
            let wanted = ask(order_counts.count());
            let q = rank(order_counts.count());
            Resolved::new(order_counts, &wanted, 1, output, redraw).at(q)
        }),
    }
}

/// Volume of the ball of radius 1 in m dimensions: V_m = V_(m−2)·2π/m.
fn unit_ball(m: usize) -> f64 {
    match m {
        0 => 1.0,
        1 => 2.0,
        _ => unit_ball(m - 2) * std::f64::consts::TAU / m as f64,
    }
}

/// Equal cells in the space of the standardised, decorrelated outputs (7.7.4).
///
/// The standard divides a box along the outputs' own axes. Cells aligned with the ellipsoid have equal
/// volume too, and follow a strongly correlated pair, where a box would be nearly empty.
struct Cells {
    outputs: usize,
    width: f64,
    /// Cells along an axis.
    side: usize,
}

impl Cells {
    /// Standard deviations on either side; a trial further out is in no cell.
    const REACH: f64 = 6.0;

    /// For two and three outputs. The width 3.5·M^(−1/(m+2)) standard deviations balances resolution
    /// against counts in a cell (Scott's rule).
    fn new(outputs: usize, trials: u64) -> Option<Self> {
        let width = 3.5 * libm::pow(trials as f64, -1.0 / (outputs as f64 + 2.0));
        let side = (2.0 * Self::REACH / width).ceil() as usize;
        (2..=3).contains(&outputs).then_some(Cells {
            outputs,
            width,
            side,
        })
    }

    /// The number of the cell of a trial.
    fn of(&self, white: &[f64]) -> Option<usize> {
        let half = (self.side / 2) as f64;
        white.iter().try_fold(0, |cell, z| {
            let place = (z / self.width).floor() + half;
            let inside = (0.0..self.side as f64).contains(&place);
            inside.then(|| cell * self.side + place as usize)
        })
    }

    /// Number and volume of the fullest cells that together hold a fraction p of the trials; `None`
    /// where too many trials are in no cell.
    fn smallest(&self, parts: Vec<Count>, p: f64) -> Option<(usize, f64)> {
        let total: u64 = parts.iter().map(|part| part.trials).sum();
        let sum = |mut a: Vec<u32>, b: Vec<u32>| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            a
        };
        let mut counts = parts.into_iter().map(|part| part.counts).reduce(sum)?;
        counts.retain(|count| *count > 0);
        counts.sort_unstable_by(|a, b| b.cmp(a));
        let wanted = p * total as f64;
        let mut held = 0;
        let cells = counts.iter().position(|count| {
            held += u64::from(*count);
            held as f64 >= wanted
        })? + 1;
        Some((cells, cells as f64 * self.width.powi(self.outputs as i32)))
    }
}

/// Counts the trials in each cell.
struct Count<'a> {
    whitening: &'a Whitening,
    cells: &'a Cells,
    counts: Vec<u32>,
    trials: u64,
    deviation: Vec<f64>,
    white: Vec<f64>,
}

impl<'a> Count<'a> {
    fn new(whitening: &'a Whitening, cells: &'a Cells) -> Self {
        Count {
            whitening,
            cells,
            counts: vec![0; cells.side.pow(cells.outputs as u32)],
            trials: 0,
            deviation: vec![0.0; cells.outputs],
            white: vec![0.0; cells.outputs],
        }
    }
}

impl Sink for Count<'_> {
    type Chunk = ();

    fn take(&mut self, outputs: &[Block], lanes: usize) {
        for lane in 0..lanes {
            let (deviation, white) = (&mut self.deviation, &mut self.white);
            self.whitening.apply(outputs, lane, deviation, white);
            if !white.iter().all(|z| z.is_finite()) {
                continue;
            }
            self.trials += 1;
            if let Some(cell) = self.cells.of(white) {
                self.counts[cell] += 1;
            }
        }
    }

    fn close(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::super::engine::Layout;
    use super::super::samples::Sampled;
    use super::*;

    fn joint(trials: u64, source: &Sampled) -> Joint {
        let layout = Layout::new(trials);
        let pivots = vec![Pivot::new(0.0, 1.0); source.outputs()];
        let chunks = layout.chunks(0..1).end;
        ThreadPool::with(2, chunks, |pool| {
            let mut collector = Collector::new(Plan {
                pool,
                source,
                layout,
                pivots: &pivots,
                p: 0.95,
                ask: &|count| Wanted {
                    ranks: vec![],
                    shortest: None,
                    count,
                },
            });
            collector.extend(chunks);
            let redraw = Redraw {
                pool,
                source,
                layout,
                chunks,
            };
            let moments = collector.into_held().joint_moments().unwrap();
            super::joint(&redraw, &moments, 0.95).unwrap()
        })
    }

    #[test]
    fn two_normal_outputs_of_jcgm_102_9_2() {
        // Y1 = X1 + X3, Y2 = X2 + X3: r = 0.5, k_p = 2.448, k_q = 2.212.
        let columns = Sampled::new(17, 2, |s, y| {
            let common = s.normal();
            y[0] = s.normal() + common + 1e7;
            y[1] = s.normal() + common;
        });
        let joint = joint(400_000, &columns);
        assert!((joint.covariance[(0, 0)] - 2.0).abs() < 0.02);
        assert!((joint.covariance[(1, 0)] - 1.0).abs() < 0.02);
        assert!((joint.correlation[(0, 1)] - 0.5).abs() < 0.005);
        let regions = joint.regions.unwrap();
        assert!((regions.k_ellipsoid - 2.4477).abs() < 0.01, "{regions:?}");
        assert!((regions.k_rectangle - 2.2121).abs() < 0.01, "{regions:?}");
        // π k² √det V with det V = 3; for a normal pair the ellipse is the smallest region.
        let area = std::f64::consts::PI * 5.9915 * 3.0_f64.sqrt();
        assert!(
            (regions.ellipsoid_volume / area - 1.0).abs() < 0.01,
            "{regions:?}"
        );
        assert!(
            (regions.smallest_volume.unwrap() / area - 1.0).abs() < 0.03,
            "{regions:?}"
        );
    }

    #[test]
    fn three_uniform_outputs() {
        // Cube of side 1: k_q = √3·p^(1/3), smallest region 0.95 of the cube.
        let columns = Sampled::new(17, 3, |s, y| y.iter_mut().for_each(|v| *v = s.uniform()));
        let regions = joint(400_000, &columns).regions.unwrap();
        assert!((regions.k_rectangle - 3.0_f64.sqrt() * 0.95_f64.cbrt()).abs() < 0.003);
        // Cells that the faces of the cube cut count in full.
        assert!(
            (0.9..1.15).contains(&regions.smallest_volume.unwrap()),
            "{regions:?}"
        );
        assert!(regions.ellipsoid_volume > regions.smallest_volume.unwrap());
        let ball =
            4.0 / 3.0 * std::f64::consts::PI * regions.k_ellipsoid.powi(3) / 12_f64.powf(1.5);
        assert!((regions.ellipsoid_volume / ball - 1.0).abs() < 0.01);
    }

    #[test]
    fn strong_correlation_is_no_obstacle() {
        let columns = Sampled::new(17, 2, |s, y| {
            y[0] = s.normal();
            y[1] = y[0] + 1e-3 * s.normal();
        });
        let regions = joint(200_000, &columns).regions.unwrap();
        let area = std::f64::consts::PI * 5.9915 * 1e-3;
        assert!(
            (regions.smallest_volume.unwrap() / area - 1.0).abs() < 0.03,
            "{regions:?}"
        );
    }

    #[test]
    fn degenerate_outputs_have_no_region() {
        let line = Sampled::new(17, 2, |s, y| {
            y[0] = s.normal();
            y[1] = 3.0 - 2.0 * y[0];
        });
        let joint_line = joint(1000, &line);
        assert!((joint_line.correlation[(0, 1)] + 1.0).abs() < 1e-12);
        assert!(joint_line.regions.is_none());
        let constant = Sampled::new(17, 2, |s, y| y.copy_from_slice(&[s.normal(), 4.0]));
        assert!(joint(1000, &constant).regions.is_none());
    }

    #[test]
    fn incomplete_trials_are_left_out() {
        let source = Sampled::new(3, 2, |s, y| {
            y[0] = 2.0 * s.normal();
            y[1] = if s.uniform() < 0.5 { f64::NAN } else { y[0] };
        });
        for trials in [1000, 200_000] {
            let joint = joint(trials, &source);
            assert!((joint.correlation[(0, 1)] - 1.0).abs() < 1e-12);
            assert!((joint.covariance[(0, 1)] - 4.0).abs() < 0.8);
        }
    }

    #[test]
    fn four_outputs_have_an_ellipsoid_but_no_grid() {
        let columns = Sampled::new(17, 4, |s, y| y.iter_mut().for_each(|v| *v = s.normal()));
        let regions = joint(400_000, &columns).regions.unwrap();
        assert!((regions.k_ellipsoid - 3.0802).abs() < 0.02, "{regions:?}");
        assert_eq!(regions.smallest_cells, None);
    }
}
