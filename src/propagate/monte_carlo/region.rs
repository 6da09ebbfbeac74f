//! Covariance and coverage regions of several outputs (JCGM 102:2011, 7.6 and 7.7).

use nalgebra::DMatrix;

use super::factor::lower_factor;
use super::interval::Ranks;
use crate::propagate::Regions;

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

/// Rows summed on their own before they are added to the total, which keeps long sums accurate.
const PART: usize = 1 << 14;

/// Joint results from trials, one column per output; trials in which any output failed are left out.
/// `None` with fewer than two outputs or two complete trials.
pub(super) fn joint(columns: &[Vec<f64>], p: f64) -> Option<Joint> {
    let rows = Rows::new(columns)?;
    let (mean, covariance) = rows.mean_and_covariance();
    let m = mean.len();
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
    let regions = regions(&rows, &mean, &sd, &correlation, p);
    Some(Joint {
        covariance,
        correlation,
        regions,
    })
}

/// The complete trials.
struct Rows<'a> {
    columns: &'a [Vec<f64>],
    /// Indices of complete trials; `None` when all are.
    complete: Option<Vec<usize>>,
    count: usize,
}

impl<'a> Rows<'a> {
    fn new(columns: &'a [Vec<f64>]) -> Option<Self> {
        if columns.len() < 2 {
            return None;
        }
        let trials = columns.first()?.len();
        let failed = columns.iter().flatten().any(|value| !value.is_finite());
        let complete = failed.then(|| {
            let finite = |row: &usize| columns.iter().all(|c| c[*row].is_finite());
            (0..trials).filter(finite).collect::<Vec<_>>()
        });
        let count = complete.as_ref().map_or(trials, Vec::len);
        (count >= 2).then_some(Rows {
            columns,
            complete,
            count,
        })
    }

    fn row(&self, index: usize) -> usize {
        self.complete
            .as_ref()
            .map_or(index, |complete| complete[index])
    }

    /// Calls `visit` with every complete trial less `origin`, in order; `pause` after every part.
    fn for_each(&self, origin: &[f64], mut visit: impl FnMut(&[f64], bool)) {
        let mut deviation = vec![0.0; self.columns.len()];
        for index in 0..self.count {
            let row = self.row(index);
            for ((d, column), o) in deviation.iter_mut().zip(self.columns).zip(origin) {
                *d = column[row] - o;
            }
            visit(
                &deviation,
                (index + 1) % PART == 0 || index + 1 == self.count,
            );
        }
    }

    /// Two passes: the mean from deviations about the first trial, then the covariance about it.
    fn mean_and_covariance(&self) -> (Vec<f64>, DMatrix<f64>) {
        let m = self.columns.len();
        let first = self.row(0);
        let mut mean: Vec<f64> = self.columns.iter().map(|c| c[first]).collect();
        let mut sums = Sums::new(m);
        self.for_each(&mean.clone(), |d, end| {
            sums.part.iter_mut().zip(d).for_each(|(s, d)| *s += d);
            sums.close_if(end);
        });
        mean.iter_mut()
            .zip(&sums.total)
            .for_each(|(y, s)| *y += s / self.count as f64);

        let mut products = Sums::new(m * m);
        self.for_each(&mean, |d, end| {
            for i in 0..m {
                for j in 0..=i {
                    products.part[i * m + j] += d[i] * d[j];
                }
            }
            products.close_if(end);
        });
        let divisor = (self.count - 1) as f64;
        let covariance = DMatrix::from_fn(m, m, |i, j| {
            products.total[i.max(j) * m + i.min(j)] / divisor
        });
        (mean, covariance)
    }
}

/// Totals made of partial sums.
struct Sums {
    part: Vec<f64>,
    total: Vec<f64>,
}

impl Sums {
    fn new(n: usize) -> Self {
        Sums {
            part: vec![0.0; n],
            total: vec![0.0; n],
        }
    }

    fn close_if(&mut self, end: bool) {
        if end {
            self.total
                .iter_mut()
                .zip(&self.part)
                .for_each(|(t, p)| *t += p);
            self.part.fill(0.0);
        }
    }
}

fn regions(
    rows: &Rows<'_>,
    mean: &[f64],
    sd: &[f64],
    correlation: &DMatrix<f64>,
    p: f64,
) -> Option<Regions> {
    let m = mean.len();
    let factor = lower_factor(correlation);
    let usable = |j: usize| factor[(j, j)].powi(2) > DEGENERATE && sd[j] > 0.0 && sd[j].is_finite();
    if !(0..m).all(usable) {
        return None;
    }
    let mut grid = Grid::new(m, rows.count);
    let mut squares = Vec::with_capacity(rows.count);
    let mut largest = Vec::with_capacity(rows.count);
    let mut white = vec![0.0; m];
    rows.for_each(mean, |deviation, _| {
        // 7.7.2 a) and b): L z = y − ȳ, here in units of u(y_j), and its length.
        for i in 0..m {
            let known: f64 = (0..i).map(|k| factor[(i, k)] * white[k]).sum();
            white[i] = (deviation[i] / sd[i] - known) / factor[(i, i)];
        }
        squares.push(white.iter().map(|z| z * z).sum::<f64>());
        largest.push(
            deviation
                .iter()
                .zip(sd)
                .map(|(d, s)| (d / s).abs())
                .fold(0.0, f64::max),
        );
        if let Some(grid) = &mut grid {
            grid.add(&white);
        }
    });
    let k_ellipsoid = value_of_rank(&mut squares, p).sqrt();
    // √det V = Π u_j · Π l_jj.
    let unit: f64 = (0..m).map(|j| sd[j] * factor[(j, j)]).product();
    let smallest = grid.map(|grid| grid.smallest(p));
    Some(Regions {
        k_ellipsoid,
        k_rectangle: value_of_rank(&mut largest, p),
        ellipsoid_volume: unit_ball(m) * k_ellipsoid.powi(m as i32) * unit,
        smallest_volume: smallest.map(|(_, volume)| volume * unit),
        smallest_cells: smallest.map(|(cells, _)| cells),
    })
}

/// 7.7.2 d), 7.7.3 d): the q-th smallest distance, q = pM.
fn value_of_rank(distances: &mut [f64], p: f64) -> f64 {
    let q = Ranks::new(distances.len(), p).covered.max(1);
    *distances.select_nth_unstable_by(q - 1, f64::total_cmp).1
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
struct Grid {
    outputs: usize,
    cell: f64,
    keys: Vec<u64>,
}

impl Grid {
    /// Bits of a cell's place along one axis; three axes fit into a key.
    const BITS: u32 = 21;

    /// For two and three outputs. The width 3.5·M^(−1/(m+2)) standard deviations balances resolution
    /// against counts in a cell (Scott's rule).
    fn new(outputs: usize, trials: usize) -> Option<Self> {
        let cell = 3.5 * libm::pow(trials as f64, -1.0 / (outputs as f64 + 2.0));
        (2..=3).contains(&outputs).then(|| Grid {
            outputs,
            cell,
            keys: Vec::with_capacity(trials),
        })
    }

    fn add(&mut self, white: &[f64]) {
        let half = f64::from(1 << (Self::BITS - 1));
        let key = white.iter().fold(0, |key, z| {
            let place = ((z / self.cell).floor() + half).clamp(0.0, 2.0 * half - 1.0);
            (key << Self::BITS) | place as u64
        });
        self.keys.push(key);
    }

    /// Number and volume of the fullest cells that together hold a fraction p of the trials.
    fn smallest(mut self, p: f64) -> (usize, f64) {
        self.keys.sort_unstable();
        let mut counts: Vec<usize> = self
            .keys
            .chunk_by(|a, b| a == b)
            .map(<[u64]>::len)
            .collect();
        counts.sort_unstable_by(|a, b| b.cmp(a));
        let wanted = p * self.keys.len() as f64;
        let mut held = 0;
        let mut cells = 0;
        for count in counts {
            if held as f64 >= wanted {
                break;
            }
            held += count;
            cells += 1;
        }
        (cells, cells as f64 * self.cell.powi(self.outputs as i32))
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::Stream;
    use super::*;

    fn columns(
        trials: usize,
        outputs: usize,
        draw: impl Fn(&mut Stream, &mut [f64]),
    ) -> Vec<Vec<f64>> {
        let mut stream = Stream::new(17);
        let mut row = vec![0.0; outputs];
        let mut columns = vec![Vec::with_capacity(trials); outputs];
        for _ in 0..trials {
            draw(&mut stream, &mut row);
            columns.iter_mut().zip(&row).for_each(|(c, v)| c.push(*v));
        }
        columns
    }

    #[test]
    fn two_normal_outputs_of_jcgm_102_9_2() {
        // Y1 = X1 + X3, Y2 = X2 + X3: r = 0.5, k_p = 2.448, k_q = 2.212.
        let columns = columns(400_000, 2, |s, y| {
            let common = s.normal();
            y[0] = s.normal() + common + 1e7;
            y[1] = s.normal() + common;
        });
        let joint = joint(&columns, 0.95).unwrap();
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
        let columns = columns(400_000, 3, |s, y| {
            y.iter_mut().for_each(|v| *v = s.uniform())
        });
        let regions = joint(&columns, 0.95).unwrap().regions.unwrap();
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
        let columns = columns(200_000, 2, |s, y| {
            y[0] = s.normal();
            y[1] = y[0] + 1e-3 * s.normal();
        });
        let regions = joint(&columns, 0.95).unwrap().regions.unwrap();
        let area = std::f64::consts::PI * 5.9915 * 1e-3;
        assert!(
            (regions.smallest_volume.unwrap() / area - 1.0).abs() < 0.03,
            "{regions:?}"
        );
    }

    #[test]
    fn degenerate_outputs_have_no_region() {
        let line = columns(1000, 2, |s, y| {
            y[0] = s.normal();
            y[1] = 3.0 - 2.0 * y[0];
        });
        let joint_line = joint(&line, 0.95).unwrap();
        assert!((joint_line.correlation[(0, 1)] + 1.0).abs() < 1e-12);
        assert!(joint_line.regions.is_none());
        let constant = columns(1000, 2, |s, y| y.copy_from_slice(&[s.normal(), 4.0]));
        assert!(joint(&constant, 0.95).unwrap().regions.is_none());
    }

    #[test]
    fn incomplete_trials_are_left_out() {
        let columns = vec![
            vec![1.0, f64::NAN, 3.0, 5.0],
            vec![2.0, 0.0, f64::INFINITY, 4.0],
        ];
        let joint = joint(&columns, 0.95).unwrap();
        assert_eq!(joint.covariance[(0, 0)], 8.0);
        assert_eq!(joint.covariance[(0, 1)], 4.0);
    }

    #[test]
    fn four_outputs_have_an_ellipsoid_but_no_grid() {
        let columns = columns(100_000, 4, |s, y| {
            y.iter_mut().for_each(|v| *v = s.normal())
        });
        let regions = joint(&columns, 0.95).unwrap().regions.unwrap();
        assert!((regions.k_ellipsoid - 3.0802).abs() < 0.02, "{regions:?}");
        assert_eq!(regions.smallest_cells, None);
    }
}
