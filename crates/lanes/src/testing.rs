//! What the tests share: arithmetic in double-double (about 104 bits), bit comparison, arguments.

use crate::{Block, LANES, Level, levels};

/// An unevaluated sum of two numbers, the second below the last place of the first.
#[derive(Debug, Clone, Copy)]
pub struct Double(pub f64, pub f64);

const LN2: [f64; 3] = [
    std::f64::consts::LN_2,
    2.319_046_813_846_299_6e-17,
    5.707_708_438_416_212e-34,
];
const HALF_PI: [f64; 3] = [
    std::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
];

impl Double {
    fn two_sum(a: f64, b: f64) -> Double {
        let s = a + b;
        let back = s - a;
        Double(s, (a - (s - back)) + (b - back))
    }

    fn two_product(a: f64, b: f64) -> Double {
        let p = a * b;
        Double(p, a.mul_add(b, -p))
    }

    pub fn plus(self, other: Double) -> Double {
        let s = Double::two_sum(self.0, other.0);
        let t = Double::two_sum(self.1, other.1);
        let s = Double::two_sum(s.0, s.1 + t.0);
        Double::two_sum(s.0, s.1 + t.1)
    }

    pub fn times(self, other: Double) -> Double {
        let p = Double::two_product(self.0, other.0);
        let cross = self.0.mul_add(other.1, self.1 * other.0);
        Double::two_sum(p.0, p.1 + cross)
    }

    fn over(self, other: Double) -> Double {
        let q = self.0 / other.0;
        let rest = self.plus(other.times(Double(-q, 0.0)));
        let q2 = rest.0 / other.0;
        let rest = rest.plus(other.times(Double(-q2, 0.0)));
        Double::two_sum(q, q2).plus(Double(rest.0 / other.0, 0.0))
    }

    /// x − k·(parts), product by product.
    fn reduce(x: f64, k: f64, parts: [f64; 3]) -> Double {
        parts.iter().fold(Double(x, 0.0), |rest, &part| {
            rest.plus(Double::two_product(-k, part))
        })
    }

    /// first + first·x/(n(n+1))·… by the Taylor rule term(n) = term(n−1)·factor/divisor(n).
    fn taylor(first: Double, factor: Double, divisor: impl Fn(f64) -> f64) -> Double {
        let (mut sum, mut term) = (first, first);
        for n in 1..32 {
            term = term.times(factor).over(Double(divisor(f64::from(n)), 0.0));
            sum = sum.plus(term);
        }
        sum
    }

    /// eˣ = value·2ᵏ; returns (value, k).
    pub fn exp(x: f64) -> (Double, i32) {
        let k = (x / LN2[0]).round();
        let r = Double::reduce(x, k, LN2);
        (Double::taylor(Double(1.0, 0.0), r, |n| n), k as i32)
    }

    /// eˣ − 1 for |x| ≤ 700.
    pub fn expm1(x: f64) -> Double {
        if x.abs() < 0.35 {
            return Double::taylor(Double(x, 0.0), Double(x, 0.0), |n| n + 1.0);
        }
        let (value, k) = Double::exp(x);
        let scale = 2_f64.powi(k);
        Double(value.0 * scale, value.1 * scale).plus(Double(-1.0, 0.0))
    }

    /// ln x for a positive number.
    pub fn ln(x: f64) -> Double {
        let (mut m, mut k) = libm::frexp(x);
        if m < std::f64::consts::FRAC_1_SQRT_2 {
            (m, k) = (m * 2.0, k - 1);
        }
        // 2 artanh s, s = (m − 1)/(m + 1).
        let s = Double(m - 1.0, 0.0).over(Double::two_sum(m, 1.0));
        let z = s.times(s);
        let mut sum = Double(0.0, 0.0);
        for n in (0..26).rev() {
            let c = Double(2.0, 0.0).over(Double(f64::from(2 * n + 1), 0.0));
            sum = sum.times(z).plus(c);
        }
        let k = f64::from(k);
        LN2.iter().rev().fold(sum.times(s), |sum, &part| {
            sum.plus(Double::two_product(k, part))
        })
    }

    /// (sin x, cos x) for |x| up to 2²⁷.
    pub(crate) fn sin_cos(x: f64) -> (Double, Double) {
        let k = (x / HALF_PI[0]).round();
        let r = Double::reduce(x, k, HALF_PI);
        let square = r.times(r);
        let square = Double(-square.0, -square.1);
        let sin = Double::taylor(r, square, |n| 2.0 * n * (2.0 * n + 1.0));
        let cos = Double::taylor(Double(1.0, 0.0), square, |n| 2.0 * n * (2.0 * n - 1.0));
        let minus = |d: Double| Double(-d.0, -d.1);
        match (k as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, minus(sin)),
            2 => (minus(sin), minus(cos)),
            _ => (minus(cos), sin),
        }
    }

    /// |x − self| in units of the last place of `self`.
    pub(crate) fn ulps(self, x: f64) -> f64 {
        ((x - self.0) - self.1).abs() / ulp(self.0)
    }
}

/// The distance from |x| to the next larger number.
pub(crate) fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

/// Equal bits, where all NaN count as one.
pub fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Runs a kernel on every level and panics where the bits differ.
pub(crate) fn same_on_all_levels(what: &str, kernel: impl Fn(Level, &mut Block)) {
    let mut expected: Option<Block> = None;
    for level in levels() {
        let mut out = Block::ZERO;
        kernel(level, &mut out);
        let expected = expected.get_or_insert(out);
        for lane in 0..LANES {
            let (a, b) = (expected.0[lane], out.0[lane]);
            assert!(
                same(a, b),
                "{what}: lane {lane} of {level:?} is {b:e}, not {a:e}"
            );
        }
    }
}

/// The arguments at which functions go wrong, and ordinary ones of both signs and many sizes.
pub(crate) fn awkward() -> Block {
    const SPECIAL: [f64; 22] = [
        0.0,
        1.0,
        0.5,
        2.0,
        1.5,
        2.5,
        3.0,
        10.0,
        0.1,
        709.78,
        709.79,
        745.1,
        745.2,
        1e-8,
        1e-300,
        5e-324,
        2.3e-308,
        1e15,
        1e22,
        1.797e308,
        f64::INFINITY,
        f64::NAN,
    ];
    let mut block = Block::ZERO;
    let mut size = 1e-12;
    for (i, x) in block.0.iter_mut().enumerate() {
        size *= 1.3;
        let magnitude = SPECIAL.get(i / 2).copied().unwrap_or(size);
        *x = if i % 2 == 0 { magnitude } else { -magnitude };
    }
    block
}
