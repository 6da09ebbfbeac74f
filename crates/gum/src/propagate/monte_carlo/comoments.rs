//! Means and covariances of several outputs, over the trials in which none failed.

use gumption_lanes::moments::{all_finite, dot};
use gumption_lanes::{Block, LANES, Level, level, ops};
use nalgebra::DMatrix;

use super::moments::{Moments, Pivot};

/// Count, means and central products; as [`super::moments::Moments`], in the pivots' coordinates.
#[derive(Debug, Clone)]
pub(super) struct CoMoments {
    pivots: Vec<Pivot>,
    count: f64,
    means: Vec<f64>,
    /// Row by row, below the diagonal and on it; likewise the sums.
    products: Vec<f64>,
    /// The chunk that is being drawn: complete trials, Σ d_i and Σ d_i d_j.
    open: f64,
    sums: Vec<f64>,
    raw: Vec<f64>,
    deviations: Vec<Block>,
}

impl CoMoments {
    /// No trials yet.
    pub(super) fn new(pivots: &[Pivot]) -> Self {
        let m = pivots.len();
        CoMoments {
            pivots: pivots.to_vec(),
            count: 0.0,
            means: vec![0.0; m],
            products: vec![0.0; m * (m + 1) / 2],
            open: 0.0,
            sums: vec![0.0; m],
            raw: vec![0.0; m * (m + 1) / 2],
            deviations: vec![Block::ZERO; m],
        }
    }

    /// Of trials that are at hand, one column per output.
    pub(super) fn of(columns: &[Vec<f64>]) -> Self {
        let pivot = |column: &Vec<f64>| {
            let first = column.iter().copied().find(|value| value.is_finite());
            let rough = Pivot::new(first.unwrap_or(0.0), 1.0);
            let moments = Moments::of(column, rough);
            Pivot::new(moments.mean(), moments.sd())
        };
        let pivots: Vec<Pivot> = columns.iter().map(pivot).collect();
        let mut all = CoMoments::new(&pivots);
        let mut blocks = vec![Block::ZERO; columns.len()];
        let trials = columns.first().map_or(0, Vec::len);
        for start in (0..trials).step_by(LANES) {
            let end = trials.min(start + LANES);
            for (block, column) in blocks.iter_mut().zip(columns) {
                block.0[..end - start].copy_from_slice(&column[start..end]);
            }
            all.take(level(), &blocks, end - start);
        }
        let whole = all.close();
        all.merge(&whole);
        all
    }

    /// The same without trials.
    pub(super) fn emptied(&self) -> Self {
        CoMoments::new(&self.pivots)
    }

    /// Complete trials.
    pub(super) fn count(&self) -> u64 {
        self.count as u64
    }

    /// The next trials of a chunk.
    pub(super) fn take(&mut self, level: Level, outputs: &[Block], lanes: usize) {
        if lanes < LANES || !outputs.iter().all(|block| all_finite(level, block)) {
            (0..lanes).for_each(|lane| self.take_one(outputs, lane));
            return;
        }
        for ((d, block), pivot) in self.deviations.iter_mut().zip(outputs).zip(&self.pivots) {
            let [origin, factor] = pivot.coordinates();
            // One rounding: the factor is a power of two.
            ops::affine(level, block, factor, -origin * factor, d);
        }
        let ones = Block([1.0; LANES]);
        let mut place = 0;
        for (i, a) in self.deviations.iter().enumerate() {
            self.sums[i] += dot(level, a, &ones);
            for b in &self.deviations[..=i] {
                self.raw[place] += dot(level, a, b);
                place += 1;
            }
        }
        self.open += LANES as f64;
    }

    fn take_one(&mut self, outputs: &[Block], lane: usize) {
        if outputs.iter().any(|block| !block.0[lane].is_finite()) {
            return;
        }
        let d = |i: usize| {
            let [origin, factor] = self.pivots[i].coordinates();
            (outputs[i].0[lane] - origin) * factor
        };
        let mut place = 0;
        for i in 0..outputs.len() {
            self.sums[i] += d(i);
            for j in 0..=i {
                self.raw[place] += d(i) * d(j);
                place += 1;
            }
        }
        self.open += 1.0;
    }

    /// Ends a chunk and gives what it held.
    pub(super) fn close(&mut self) -> CoMoments {
        let mut chunk = self.emptied();
        let n = std::mem::take(&mut self.open);
        chunk.count = n;
        if n > 0.0 {
            for (mean, sum) in chunk.means.iter_mut().zip(&self.sums) {
                *mean = sum / n;
            }
            let mut place = 0;
            for i in 0..self.sums.len() {
                for j in 0..=i {
                    chunk.products[place] = self.raw[place] - self.sums[i] * chunk.means[j];
                    place += 1;
                }
            }
        }
        self.sums.fill(0.0);
        self.raw.fill(0.0);
        chunk
    }

    /// Takes over a closed chunk.
    pub(super) fn merge(&mut self, other: &CoMoments) {
        let (na, nb) = (self.count, other.count);
        if nb == 0.0 {
            return;
        }
        let n = na + nb;
        let deltas: Vec<f64> = other
            .means
            .iter()
            .zip(&self.means)
            .map(|(b, a)| b - a)
            .collect();
        let mut place = 0;
        for i in 0..deltas.len() {
            for j in 0..=i {
                self.products[place] += other.products[place] + deltas[i] * deltas[j] / n * na * nb;
                place += 1;
            }
        }
        for (mean, delta) in self.means.iter_mut().zip(&deltas) {
            *mean += delta * nb / n;
        }
        self.count = n;
    }

    /// The means.
    pub(super) fn means(&self) -> Vec<f64> {
        let pairs = self.pivots.iter().zip(&self.means);
        pairs
            .map(|(pivot, mean)| {
                let [origin, factor] = pivot.coordinates();
                origin + mean / factor
            })
            .collect()
    }

    /// The covariance matrix, with divisor M − 1.
    pub(super) fn covariance(&self) -> DMatrix<f64> {
        let m = self.means.len();
        let factor = |i: usize| self.pivots[i].coordinates()[1];
        DMatrix::from_fn(m, m, |i, j| {
            let (i, j) = (i.max(j), i.min(j));
            let product = self.products[i * (i + 1) / 2 + j];
            product / (self.count - 1.0) / factor(i) / factor(j)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::Stream;
    use super::*;

    #[test]
    fn chunks_give_the_covariance_of_the_whole() {
        let mut stream = Stream::new(5);
        let pivots = [Pivot::new(1e6, 3.0), Pivot::new(0.0, 0.01)];
        let mut all = CoMoments::new(&pivots);
        let mut rows: Vec<[f64; 2]> = Vec::new();
        let mut thread = all.emptied();
        for lanes in [LANES, LANES, 100, LANES, 7] {
            let mut blocks = [Block::ZERO; 2];
            for lane in 0..lanes {
                let common = stream.normal();
                let mut row = [1e6 + 3.0 * common, 0.01 * (common + stream.normal())];
                if lane == 5 {
                    row[lanes % 2] = f64::NAN;
                } else {
                    rows.push(row);
                }
                blocks[0].0[lane] = row[0];
                blocks[1].0[lane] = row[1];
            }
            thread.take(level(), &blocks, lanes);
            all.merge(&thread.close());
        }
        let n = rows.len() as f64;
        assert_eq!(all.count(), rows.len() as u64);
        let mean = |j: usize| rows.iter().map(|r| r[j]).sum::<f64>() / n;
        let covariance = |i: usize, j: usize| {
            let (a, b) = (mean(i), mean(j));
            rows.iter().map(|r| (r[i] - a) * (r[j] - b)).sum::<f64>() / (n - 1.0)
        };
        for i in 0..2 {
            assert!((all.means()[i] - mean(i)).abs() < 1e-9);
            for j in 0..2 {
                let (found, exact) = (all.covariance()[(i, j)], covariance(i, j));
                assert!(
                    (found / exact - 1.0).abs() < 1e-8,
                    "{i} {j} {found} {exact}"
                );
            }
        }
    }
}
