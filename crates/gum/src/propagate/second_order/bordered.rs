//! Symmetric matrices of few entries, bordered by full rows and columns.

use nalgebra::DMatrix;

use super::spread::Spread;
use gumption_core::model::Neighbours;

/// Second derivatives with respect to x and s.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bordered {
    /// A: per input the entries for its neighbours, in their order.
    pub few: Vec<f64>,
    /// B: per intermediate the entries for the inputs.
    pub border: Vec<Vec<f64>>,
    /// M: intermediates × intermediates.
    pub corner: DMatrix<f64>,
}

impl Bordered {
    /// Without entries, for inputs with these neighbours and so many intermediates.
    pub(super) fn zero(near: &Neighbours, intermediates: usize) -> Self {
        Bordered {
            few: vec![0.0; near.pairs()],
            border: vec![vec![0.0; near.inputs()]; intermediates],
            corner: DMatrix::zeros(intermediates, intermediates),
        }
    }

    /// Whether all entries are zero.
    pub(super) fn is_zero(&self) -> bool {
        let mut entries = self.few.iter().chain(self.border.iter().flatten());
        entries.all(|entry| *entry == 0.0) && self.corner.iter().all(|entry| *entry == 0.0)
    }

    /// Takes the columns of variables from their sum: no two inputs among them have an input for a neighbour in common,
    /// and no intermediate has any neighbour in common with the others. Each is its own neighbour.
    pub(super) fn set(
        &mut self,
        near: &Neighbours,
        neighbours: &Neighbours,
        variables: &[usize],
        sum: &[f64],
    ) {
        let n = near.inputs();
        for &j in variables {
            for &i in neighbours.of(j) {
                match (i.checked_sub(n), j.checked_sub(n)) {
                    (None, None) => {
                        if let Some(place) = near.place(i, j) {
                            self.few[place] = sum[i];
                        }
                    }
                    (None, Some(intermediate)) => self.border[intermediate][i] = sum[i],
                    (Some(row), Some(column)) => self.corner[(row, column)] = sum[i],
                    // The border is taken from its intermediate's column.
                    (Some(_), None) => {}
                }
            }
        }
    }

    /// A d.
    pub(super) fn times_few(&self, near: &Neighbours, d: &[f64]) -> Vec<f64> {
        let row = |i: usize| {
            let entries = near.of(i).iter().zip(&self.few[near.places(i)]);
            entries.map(|(j, entry)| entry * d[*j]).sum()
        };
        (0..near.inputs()).map(row).collect()
    }

    /// The product with a direction of x and s.
    pub(super) fn times(&self, near: &Neighbours, w: &[f64]) -> Vec<f64> {
        let (x, s) = w.split_at(near.inputs());
        let mut out = self.times_few(near, x);
        for (border, s) in self.border.iter().zip(s) {
            add_scaled(&mut out, *s, border);
        }
        for (k, border) in self.border.iter().enumerate() {
            out.push(dot(border, x) + self.in_corner(k, |l| s[l]));
        }
        out
    }

    /// w·(this)·w for a step of an input and what it moves the intermediates by.
    pub(super) fn along(&self, near: &Neighbours, input: usize, intermediates: &[Vec<f64>]) -> f64 {
        let step = |k: usize| intermediates[k][input];
        let own = near.place(input, input);
        let mut sum = own.map_or(0.0, |place| self.few[place]);
        for (k, border) in self.border.iter().enumerate() {
            sum += step(k) * (2.0 * border[input] + self.in_corner(k, step));
        }
        sum
    }

    /// A row of M times a direction of s.
    fn in_corner(&self, k: usize, s: impl Fn(usize) -> f64) -> f64 {
        (0..self.corner.ncols())
            .map(|l| self.corner[(k, l)] * s(l))
            .sum()
    }
}

/// The covariance of x and s to first order: that of x, C, bordered by K = C Sᵀ, with Q = S C Sᵀ.
pub(super) struct Lifted<'a> {
    spread: &'a Spread<'a>,
    k: Vec<Vec<f64>>,
    q: DMatrix<f64>,
}

impl<'a> Lifted<'a> {
    /// For intermediates with these derivatives S.
    pub(super) fn new(spread: &'a Spread<'a>, intermediates: &[Vec<f64>]) -> Self {
        let k: Vec<Vec<f64>> = intermediates
            .iter()
            .map(|intermediate| spread.times(intermediate))
            .collect();
        let q = DMatrix::from_fn(intermediates.len(), intermediates.len(), |a, b| {
            dot(&intermediates[a], &k[b])
        });
        Lifted { spread, k, q }
    }

    /// The trace of the product with a matrix.
    pub(super) fn trace(&self, near: &Neighbours, of: &Bordered) -> f64 {
        let borders = self.k.iter().zip(&of.border);
        let border: f64 = borders.map(|(k, b)| dot(k, b)).sum();
        self.spread.trace(near, &of.few) + 2.0 * border + self.q.dot(&of.corner)
    }

    /// The product with a direction of x and s.
    pub(super) fn times(&self, w: &[f64]) -> Vec<f64> {
        let (x, s) = w.split_at(w.len() - self.k.len());
        let mut out = self.spread.times(x);
        for (k, s) in self.k.iter().zip(s) {
            add_scaled(&mut out, *s, k);
        }
        for (a, k) in self.k.iter().enumerate() {
            let corner: f64 = s.iter().enumerate().map(|(b, s)| self.q[(a, b)] * s).sum();
            out.push(dot(k, x) + corner);
        }
        out
    }
}

/// a + c b in place of a.
pub(super) fn add_scaled(a: &mut [f64], c: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += c * b);
}

/// a·b.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
