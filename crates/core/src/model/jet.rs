//! Numbers that carry derivatives along one direction.
//!
//! `Jet([f, f', f''])` is a function of a parameter t at t = 0, cut off after N − 1 derivatives.
//! `Jet<1>` is a plain number, `Jet<2>` a dual number, `Jet<3>` what second and third order need.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Value and the first N − 1 derivatives (N is 1, 2 or 3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet<const N: usize>(pub [f64; N]);

impl<const N: usize> Jet<N> {
    /// A number that does not depend on t.
    pub fn constant(value: f64) -> Self {
        let mut out = [0.0; N];
        out[0] = value;
        Jet(out)
    }

    /// value + slope·t.
    pub fn line(value: f64, slope: f64) -> Self {
        let mut out = Self::constant(value);
        if N > 1 {
            out.0[1] = slope;
        }
        out
    }

    /// The number itself.
    pub fn value(&self) -> f64 {
        self.0[0]
    }

    /// Whether value and derivatives are all zero.
    pub fn is_zero(&self) -> bool {
        self.0.iter().all(|c| *c == 0.0)
    }

    /// g(self), where `derivatives` holds g, g', g'' … at the value.
    ///
    /// A parameter that does not move leaves no derivative, even where g' is infinite.
    pub fn compose(&self, derivatives: &[f64]) -> Self {
        let mut out = [0.0; N];
        out[0] = derivatives[0];
        if N > 1 {
            out[1] = times(derivatives[1], self.0[1]);
        }
        if N > 2 {
            out[2] =
                times(derivatives[2], self.0[1] * self.0[1]) + times(derivatives[1], self.0[2]);
        }
        Jet(out)
    }

    /// 1/self.
    pub fn recip(&self) -> Self {
        let r = 1.0 / self.0[0];
        self.compose(&[r, -r * r, 2.0 * r * r * r])
    }

    /// √self.
    pub fn sqrt(&self) -> Self {
        let s = self.0[0].sqrt();
        self.compose(&[s, 0.5 / s, -0.25 / (s * self.0[0])])
    }

    /// This jet with another value; for functions whose derivatives come by another way.
    pub fn with_value(mut self, value: f64) -> Self {
        self.0[0] = value;
        self
    }
}

/// Product in which nothing times infinity is nothing.
fn times(factor: f64, movement: f64) -> f64 {
    if movement == 0.0 {
        0.0
    } else {
        factor * movement
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Jet(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Jet(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Jet(self.0.map(|c| -c))
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        let mut out = [0.0; N];
        out[0] = a[0] * b[0];
        if N > 1 {
            out[1] = times(a[0], b[1]) + times(b[0], a[1]);
        }
        if N > 2 {
            out[2] = times(a[0], b[2]) + 2.0 * a[1] * b[1] + times(b[0], a[2]);
        }
        Jet(out)
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        // The value by a true division: a·(1/b) would round twice.
        (self * other.recip()).with_value(self.0[0] / other.0[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotient_rule() {
        // (1 + t)/(2 - t) = 1/2 + 3/4 t + 3/8 t² …
        let q = Jet::<3>::line(1.0, 1.0) / Jet::line(2.0, -1.0);
        assert_eq!(q, Jet([0.5, 0.75, 0.75]));
    }

    #[test]
    fn a_resting_parameter_has_no_derivative_at_a_vertical_tangent() {
        assert_eq!(Jet::<3>::constant(0.0).sqrt(), Jet([0.0, 0.0, 0.0]));
        assert!(Jet::<2>::line(0.0, 1.0).sqrt().0[1].is_infinite());
    }
}
