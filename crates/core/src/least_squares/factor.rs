//! Pivoted Householder QR and Cholesky factors, in f64 or in double-double arithmetic.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use nalgebra::DMatrix;

use crate::dd::Dd;

/// What the factorisations need of a number.
pub(super) trait Scalar:
    Copy
    + PartialOrd
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The nearest of its kind.
    fn of(x: Dd) -> Self;
    /// The nearest f64.
    fn value(self) -> f64;
    /// Square root.
    fn root(self) -> Self;
}

impl Scalar for f64 {
    fn of(x: Dd) -> f64 {
        x.value()
    }
    fn value(self) -> f64 {
        self
    }
    fn root(self) -> f64 {
        self.sqrt()
    }
}

impl Scalar for Dd {
    fn of(x: Dd) -> Dd {
        x
    }
    fn value(self) -> f64 {
        Dd::value(self)
    }
    fn root(self) -> Dd {
        self.sqrt()
    }
}

/// Σ a_i b_i.
pub(super) fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    let mut sum = T::from(0.0);
    for (a, b) in a.iter().zip(b) {
        sum += *a * *b;
    }
    sum
}

/// Σ a_i².
pub(super) fn square<T: Scalar>(a: &[T]) -> T {
    dot(a, a)
}

/// A matrix A as Q R, its columns scaled to similar length and taken in the order in which each
/// adds most to those before.
pub(super) struct Qr<T> {
    /// R above the diagonal, the Householder vectors below; in pivoted order.
    columns: Vec<Vec<T>>,
    /// First element of each Householder vector.
    heads: Vec<T>,
    /// 2/|v|² of each Householder vector; zero where the rest of the column is zero.
    factors: Vec<T>,
    /// R's diagonal.
    diagonal: Vec<T>,
    /// Which column of A stands here.
    pivots: Vec<usize>,
    /// Powers of two by which the columns of A were multiplied; in A's order.
    scales: Vec<f64>,
    rank: usize,
}

/// A power of two that brings the length of a column near one; one for a column of zeros.
fn scale_of<T: Scalar>(column: &[T]) -> f64 {
    let largest = column
        .iter()
        .fold(0.0, |largest: f64, x| largest.max(x.value().abs()));
    if largest == 0.0 || !largest.is_finite() {
        return 1.0;
    }
    let length = column
        .iter()
        .map(|x| (x.value() / largest).powi(2))
        .sum::<f64>()
        .sqrt();
    // Exponents by bits: neither logarithm nor overflow.
    let exponent = |x: f64| ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    let exponent = (exponent(largest) + exponent(length)).clamp(-1000, 1000);
    2.0_f64.powi(-exponent)
}

impl<T: Scalar> Qr<T> {
    /// Factors the matrix with these columns. A column that the others explain up to `tolerance`
    /// of its length counts as dependent on them.
    pub(super) fn new(mut columns: Vec<Vec<T>>, tolerance: f64) -> Qr<T> {
        let scales: Vec<f64> = columns.iter().map(|column| scale_of(column)).collect();
        for (column, scale) in columns.iter_mut().zip(&scales) {
            for cell in column.iter_mut() {
                *cell = *cell * T::from(*scale);
            }
        }
        let count = columns.len();
        let mut qr = Qr {
            columns,
            heads: Vec::with_capacity(count),
            factors: Vec::with_capacity(count),
            diagonal: Vec::with_capacity(count),
            pivots: (0..count).collect(),
            scales,
            rank: count,
        };
        let lengths: Vec<f64> = qr
            .columns
            .iter()
            .map(|c| square(c).value().sqrt())
            .collect();
        for step in 0..count {
            qr.pivot(step);
            qr.eliminate(step);
            let left = qr.diagonal[step].value().abs();
            if qr.rank == count && !(left > tolerance * lengths[qr.pivots[step]]) {
                qr.rank = step;
            }
        }
        qr
    }

    /// Brings the column with the longest rest to the front.
    fn pivot(&mut self, step: usize) {
        let rest = |column: &Vec<T>| {
            column
                .iter()
                .skip(step)
                .map(|x| x.value() * x.value())
                .sum::<f64>()
        };
        let (mut best, mut longest) = (step, rest(&self.columns[step]));
        for candidate in step + 1..self.columns.len() {
            let length = rest(&self.columns[candidate]);
            // Ties go to the first, whatever the last bit says.
            if length > longest * (1.0 + 1e-12) {
                (best, longest) = (candidate, length);
            }
        }
        self.columns.swap(step, best);
        self.pivots.swap(step, best);
    }

    /// Reflects the rest of a column onto its first element.
    fn eliminate(&mut self, step: usize) {
        let zero = T::from(0.0);
        let (done, later) = self.columns.split_at_mut(step + 1);
        let column = &mut done[step];
        if step >= column.len() {
            self.heads.push(zero);
            self.factors.push(zero);
            self.diagonal.push(zero);
            return;
        }
        let length = square(&column[step..]).root();
        let first = column[step];
        let diagonal = if first > zero { -length } else { length };
        let head = first - diagonal;
        self.diagonal.push(diagonal);
        self.heads.push(head);
        if length == zero {
            self.factors.push(zero);
            return;
        }
        // |v|² = 2·length·|head|.
        let factor = T::from(1.0) / -(diagonal * head);
        self.factors.push(factor);
        column[step] = head;
        for other in later {
            reflect(&column[step..], factor, &mut other[step..]);
        }
        column[step] = diagonal;
    }

    /// Number of columns that the others do not explain.
    pub(super) fn is_full(&self) -> bool {
        self.rank == self.columns.len()
    }

    /// Qᵀ v.
    pub(super) fn transposed_times(&self, vector: &mut [T]) {
        for step in 0..self.columns.len() {
            self.reflect_at(step, vector);
        }
    }

    /// Q v.
    pub(super) fn times(&self, vector: &mut [T]) {
        for step in (0..self.columns.len()).rev() {
            self.reflect_at(step, vector);
        }
    }

    fn reflect_at(&self, step: usize, vector: &mut [T]) {
        if step >= vector.len() {
            return;
        }
        let tail = &self.columns[step][step + 1..];
        let head = self.heads[step];
        let product = (head * vector[step] + dot(tail, &vector[step + 1..])) * self.factors[step];
        vector[step] -= product * head;
        for (cell, v) in vector[step + 1..].iter_mut().zip(tail) {
            *cell -= product * *v;
        }
    }

    fn r(&self, row: usize, column: usize) -> T {
        if row == column {
            self.diagonal[row]
        } else {
            self.columns[column][row]
        }
    }

    /// The b that solves A b = Q c, of which the first elements are given: the least-squares
    /// estimate, if c = Qᵀ y.
    pub(super) fn solve(&self, c: &[T]) -> Vec<T> {
        let count = self.columns.len();
        let mut solution = vec![T::from(0.0); count];
        let mut inner = vec![T::from(0.0); count];
        for row in (0..count).rev() {
            let mut rest = c[row];
            for column in row + 1..count {
                rest -= self.r(row, column) * inner[column];
            }
            inner[row] = rest / self.diagonal[row];
            let place = self.pivots[row];
            solution[place] = inner[row] * T::from(self.scales[place]);
        }
        solution
    }

    /// The c that solves (A = Q R) Rᵀ c = a.
    pub(super) fn solve_transposed(&self, a: &[T]) -> Vec<T> {
        let mut inner: Vec<T> = Vec::with_capacity(a.len());
        for row in 0..self.columns.len() {
            let place = self.pivots[row];
            let mut rest = a[place] * T::from(self.scales[place]);
            for column in 0..row {
                rest -= self.r(column, row) * inner[column];
            }
            inner.push(rest / self.diagonal[row]);
        }
        inner
    }

    /// R⁻¹, one column for each column of Q; rows in A's order.
    pub(super) fn inverse(&self) -> Vec<Vec<T>> {
        let count = self.columns.len();
        (0..count)
            .map(|k| {
                let mut unit = vec![T::from(0.0); count];
                unit[k] = T::from(1.0);
                self.solve(&unit)
            })
            .collect()
    }

    /// (Aᵀ A)⁻¹.
    pub(super) fn inverse_normal(&self) -> DMatrix<f64> {
        let inverse = self.inverse();
        let count = inverse.len();
        DMatrix::from_fn(count, count, |i, j| {
            let mut sum = T::from(0.0);
            for column in &inverse {
                sum += column[i] * column[j];
            }
            sum.value()
        })
    }

    /// Condition number of A with its columns scaled to length one.
    pub(super) fn condition(&self) -> f64 {
        let count = self.columns.len();
        let mut r = DMatrix::zeros(count, count);
        for column in 0..count {
            for row in 0..=column {
                r[(row, column)] = self.r(row, column).value();
            }
            let length = r.column(column).norm();
            if length > 0.0 {
                r.column_mut(column).unscale_mut(length);
            }
        }
        if r.iter().any(|x| !x.is_finite()) {
            return f64::NAN;
        }
        let singular = r.singular_values();
        singular.max() / singular.min()
    }

    /// The columns of A that take part in a linear dependence.
    pub(super) fn dependent(&self) -> Vec<usize> {
        let mut taking_part = vec![false; self.columns.len()];
        for dependent in self.rank..self.columns.len() {
            taking_part[self.pivots[dependent]] = true;
            // R₁₁ c = the part of the dependent column within the independent ones.
            let mut c = vec![0.0; self.rank];
            for row in (0..self.rank).rev() {
                let mut rest = self.columns[dependent][row].value();
                for column in row + 1..self.rank {
                    rest -= self.r(row, column).value() * c[column];
                }
                c[row] = rest / self.diagonal[row].value();
            }
            let largest = c.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            for (row, c) in c.iter().enumerate() {
                taking_part[self.pivots[row]] |= c.abs() > 1e-6 * largest;
            }
        }
        (0..taking_part.len()).filter(|k| taking_part[*k]).collect()
    }
}

/// x − v (v·x) factor.
fn reflect<T: Scalar>(v: &[T], factor: T, x: &mut [T]) {
    let product = dot(v, x) * factor;
    for (x, v) in x.iter_mut().zip(v) {
        *x -= product * *v;
    }
}

/// The lower triangular L with L Lᵀ = V, as its rows.
pub(super) struct Cholesky<T> {
    rows: Vec<Vec<T>>,
}

impl<T: Scalar> Cholesky<T> {
    /// None if V is not symmetric and positive definite beyond its rounding.
    pub(super) fn new(v: &DMatrix<f64>) -> Option<Cholesky<T>> {
        if !is_symmetric(v) {
            return None;
        }
        let n = v.nrows();
        let tolerance = 2.0 * n as f64 * f64::EPSILON;
        let mut rows: Vec<Vec<T>> = Vec::with_capacity(n);
        for i in 0..n {
            let mut row: Vec<T> = Vec::with_capacity(i + 1);
            for (j, other) in rows.iter().enumerate() {
                let rest = T::from(v[(i, j)]) - dot(&row, &other[..j]);
                row.push(rest / other[j]);
            }
            let rest = T::from(v[(i, i)]) - square(&row);
            if !(rest.value() > tolerance * v[(i, i)]) {
                return None;
            }
            row.push(rest.root());
            rows.push(row);
        }
        Some(Cholesky { rows })
    }

    /// L⁻¹ b.
    pub(super) fn lower(&self, b: &mut [T]) {
        for (i, row) in self.rows.iter().enumerate() {
            b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
        }
    }

    /// L⁻ᵀ b.
    pub(super) fn upper(&self, b: &mut [T]) {
        for (i, row) in self.rows.iter().enumerate().rev() {
            b[i] = b[i] / row[i];
            let known = b[i];
            for (cell, l) in b[..i].iter_mut().zip(row) {
                *cell -= *l * known;
            }
        }
    }
}

/// Symmetric up to the rounding of written digits.
pub(super) fn is_symmetric(v: &DMatrix<f64>) -> bool {
    (0..v.nrows()).all(|i| {
        (0..i).all(|j| (v[(i, j)] - v[(j, i)]).abs() <= 1e-9 * (v[(i, i)] * v[(j, j)]).abs().sqrt())
    })
}
