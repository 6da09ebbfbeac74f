//! Numbers of twice the precision, and what is known of a value that arithmetic has made of them: one by one, and in
//! blocks.
//!
//! Algorithms of Dekker (1971), Knuth and Hida, Li & Bailey (2001); products by fused multiply-add. What one operation
//! loses is exact to 31 digits; errors are carried on by the slopes (first-order running error analysis: Higham, Accuracy
//! and Stability of Numerical Algorithms, 2002, 3.3).

use std::f64::consts::PI;

use fearless_simd::{Level, dispatch};

use crate::{Block, LANES};

/// The unevaluated sum of two numbers, the first of which is the nearest double.
pub type Twice = [f64; 2];

/// a + b without error: the rounded sum, and what rounding took away.
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> Twice {
    let high = a + b;
    let part = high - a;
    [high, (a - (high - part)) + (b - part)]
}

/// The same for |a| ≥ |b|.
#[inline(always)]
fn quick_two_sum(a: f64, b: f64) -> Twice {
    let high = a + b;
    [high, b - (high - a)]
}

/// a·b without error.
#[inline(always)]
pub fn two_prod(a: f64, b: f64) -> Twice {
    let high = a * b;
    [high, a.mul_add(b, -high)]
}

/// a + b.
#[inline(always)]
pub fn add(a: Twice, b: Twice) -> Twice {
    let sum = two_sum(a[0], b[0]);
    let rest = two_sum(a[1], b[1]);
    let sum = quick_two_sum(sum[0], sum[1] + rest[0]);
    quick_two_sum(sum[0], sum[1] + rest[1])
}

/// −a.
#[inline(always)]
pub fn neg(a: Twice) -> Twice {
    [-a[0], -a[1]]
}

/// a·b.
#[inline(always)]
pub fn mul(a: Twice, b: Twice) -> Twice {
    let product = two_prod(a[0], b[0]);
    let low = a[0].mul_add(b[1], a[1] * b[0]) + product[1];
    quick_two_sum(product[0], low)
}

/// a/b.
#[inline(always)]
pub fn div(a: Twice, b: Twice) -> Twice {
    let first = a[0] / b[0];
    let rest = add(a, neg(mul(b, [first, 0.0])));
    let second = rest[0] / b[0];
    let rest = add(rest, neg(mul(b, [second, 0.0])));
    let third = rest[0] / b[0];
    let quotient = add(quick_two_sum(first, second), [third, 0.0]);
    let usable = first.is_finite() && b[0].is_finite();
    [
        if usable { quotient[0] } else { first },
        if usable { quotient[1] } else { 0.0 },
    ]
}

/// One of two numbers, by their bits: where one of them takes many operations, the compiler makes a branch of `if`, and then a loop
/// over lanes is not vectorised.
#[inline(always)]
pub(crate) fn select(first: bool, a: f64, b: f64) -> f64 {
    let mask = u64::from(first).wrapping_neg();
    f64::from_bits((a.to_bits() & mask) | (b.to_bits() & !mask))
}

/// Half a unit in the last place of a double, relative.
pub const ROUNDING: f64 = f64::EPSILON / 2.0;

/// What the four operations lose in twice the precision, relative.
pub const ROUNDING_TWICE: f64 = ROUNDING * ROUNDING * 16.0;

/// A value on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// By twice the precision.
    pub value: Twice,
    /// How far that may be off.
    pub error: f64,
    /// How far the value by doubles may be off.
    pub doubles: f64,
}

/// The error of an operand, carried on; none where there is none, whatever the slope.
#[inline(always)]
fn carried(error: f64, slope: f64) -> f64 {
    if error == 0.0 {
        0.0
    } else {
        error * slope.abs()
    }
}

#[inline(always)]
fn of_four_operations(value: Twice, [a, b]: [(Known, f64); 2]) -> Known {
    let size = value[0].abs();
    let error = carried(a.0.error, a.1) + carried(b.0.error, b.1);
    let doubles = carried(a.0.doubles, a.1) + carried(b.0.doubles, b.1);
    Known {
        value,
        error: error + ROUNDING_TWICE * size,
        doubles: doubles + ROUNDING * size,
    }
}

/// a + b.
#[inline(always)]
pub fn sum(a: Known, b: Known) -> Known {
    of_four_operations(add(a.value, b.value), [(a, 1.0), (b, 1.0)])
}

/// a − b.
#[inline(always)]
pub fn difference(a: Known, b: Known) -> Known {
    of_four_operations(add(a.value, neg(b.value)), [(a, 1.0), (b, -1.0)])
}

/// a·b.
#[inline(always)]
pub fn product(a: Known, b: Known) -> Known {
    let slopes = [(a, b.value[0]), (b, a.value[0])];
    of_four_operations(mul(a.value, b.value), slopes)
}

/// a/b.
#[inline(always)]
pub fn quotient(a: Known, b: Known) -> Known {
    let (x, y) = (a.value[0], b.value[0]);
    let slopes = [(a, 1.0 / y), (b, -(x / y) / y)];
    of_four_operations(div(a.value, b.value), slopes)
}

/// What is known of 256 values.
#[derive(Debug, Clone)]
pub struct KnownBlock {
    /// The values by twice the precision.
    pub value: [Block; 2],
    /// How far they may be off.
    pub error: Block,
    /// How far those by doubles may be off.
    pub doubles: Block,
}

impl KnownBlock {
    /// Zero, without error.
    pub const ZERO: KnownBlock = KnownBlock {
        value: [Block::ZERO; 2],
        error: Block::ZERO,
        doubles: Block::ZERO,
    };

    /// One of them.
    #[inline(always)]
    pub fn at(&self, lane: usize) -> Known {
        Known {
            value: [self.value[0].0[lane], self.value[1].0[lane]],
            error: self.error.0[lane],
            doubles: self.doubles.0[lane],
        }
    }

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, known: Known) {
        [self.value[0].0[lane], self.value[1].0[lane]] = known.value;
        self.error.0[lane] = known.error;
        self.doubles.0[lane] = known.doubles;
    }
}

/// `name(level, a, b, out)`, vectorised.
macro_rules! blocks {
    ($($(#[$doc:meta])+ $name:ident = $one:ident;)+) => {$(
        $(#[$doc])+
        pub fn $name(level: Level, a: &KnownBlock, b: &KnownBlock, out: &mut KnownBlock) {
            dispatch!(level, _ => for lane in 0..LANES {
                out.set(lane, $one(a.at(lane), b.at(lane)));
            })
        }
    )+};
}

blocks! {
    /// a + b.
    sum_blocks = sum;
    /// a − b.
    difference_blocks = difference;
    /// a·b.
    product_blocks = product;
    /// a/b.
    quotient_blocks = quotient;
}

/// 10⁰ to 10²², which are doubles.
pub const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Decimals whose digits are a whole number below this are farther apart than doubles: of these there is one at most that is
/// read as a double. That is all of 15 digits, and those of 16 up to 4.5.
const FARTHER_APART: f64 = 1.0 / f64::EPSILON;

/// The whole number next to the exact product of the two, below 2⁵²: the rounded product may be half a unit off.
#[inline(always)]
fn whole(x: f64, ten: f64) -> f64 {
    let scaled = x * ten;
    let digits = scaled.round_ties_even();
    digits + ((scaled - digits) + x.mul_add(ten, -scaled)).round_ties_even()
}

/// The whole number of `1/ten` that a decimal with a fraction is, if it is one of those that are [`FARTHER_APART`]: then it
/// is the only one of them that is read as x, since up to 10²² powers of ten are doubles, and the quotient is what the
/// decimal is read as.
#[inline(always)]
fn digits_of(x: f64, ten: f64) -> Option<f64> {
    let digits = whole(x, ten);
    (digits.abs() < FARTHER_APART && digits / ten == x).then_some(digits)
}

/// Whether a number has so many digits before those of 10⁻²² that, where it is no [`short_decimal`], it is none of any power
/// of ten: what is known of it is the double.
#[inline(always)]
pub fn is_long(x: f64) -> bool {
    (x.fract() != 0.0) & (x.abs() < FARTHER_APART) & (x.abs() * 1e22 >= FARTHER_APART)
}

/// The part of a decimal, so many digits over a power of ten, that the double next to it lacks. A double next to a quotient
/// leaves a remainder that is a double (Markstein 1990): this is rounded once, and the same by any power of ten.
#[inline(always)]
fn rest_of(x: f64, digits: f64, ten: f64) -> f64 {
    x.mul_add(-ten, digits) / ten
}

/// The decimal from which x was read, where that has a fraction and digits that only one decimal has; found without being
/// written.
pub fn short_decimal(x: f64) -> Option<Twice> {
    if x.fract() == 0.0 {
        return None;
    }
    let mut tens = TENS.iter().skip(1);
    let found = tens.find_map(|ten| Some((digits_of(x, *ten)?, *ten)));
    found.map(|(digits, ten)| [x, rest_of(x, digits, ten)])
}

/// Lanes that are looked at together.
const WIDTH: usize = 8;

/// Notes in `found` this power of ten for each number that is a [`FARTHER_APART`] whole one by it, and for which none is
/// noted yet; what has happened. As wide as the numbers, and without branches within the loops: so they are vectorised.
#[inline(always)]
fn look(x: &[f64; WIDTH], ten: f64, found: &mut [f64; WIDTH]) -> Look {
    let (mut near, mut open) = (0u64, 0u64);
    for lane in 0..WIDTH {
        let scaled = x[lane] * ten;
        let off = (scaled - whole(x[lane], ten)).abs();
        let unknown = (found[lane] == 0.0) & (scaled.abs() < FARTHER_APART);
        near |= u64::from(unknown & (off <= 2.0 * f64::EPSILON * scaled.abs()));
        open |= u64::from(unknown);
    }
    // Where the quotient of a number is x, the product is off by no more than two roundings: elsewhere there is
    // nothing to divide.
    if near == 0 {
        return if open == 0 { Look::Over } else { Look::Nothing };
    }
    for lane in 0..WIDTH {
        let digits = whole(x[lane], ten);
        let hit = (digits / ten == x[lane]) & (digits.abs() < FARTHER_APART) & (found[lane] == 0.0);
        found[lane] = if hit { ten } else { found[lane] };
    }
    Look::Near
}

/// What a power of ten has shown.
#[derive(PartialEq)]
enum Look {
    /// There may be numbers with so many decimals.
    Near,
    /// There are none.
    Nothing,
    /// No number is open that has digits left.
    Over,
}

/// What is known of the decimals from which numbers were read, as far as they are whole, [`short_decimal`]s or [long](is_long);
/// the error of all others, and of π, is NaN. Tells whether there are such.
pub fn decimals(level: Level, x: &Block, out: &mut KnownBlock) -> bool {
    let mut tens = Block::ZERO;
    dispatch!(level, _ => {
        let chunks = x.0.as_chunks::<WIDTH>().0.iter().zip(tens.0.as_chunks_mut::<WIDTH>().0);
        // The numbers of a column have about as many decimals.
        let mut usual = TENS[1];
        for (x, found) in chunks {
            for lane in 0..WIDTH {
                let whole = x[lane].fract() == 0.0 && x[lane].abs() < 1.0 / f64::EPSILON;
                found[lane] = if whole { 1.0 } else { 0.0 };
            }
            look(x, usual, found);
            if !found.contains(&0.0) {
                continue;
            }
            for ten in &TENS[1..] {
                match look(x, *ten, found) {
                    Look::Near => usual = *ten,
                    Look::Nothing => {}
                    Look::Over => break,
                }
            }
        }
    });
    let mut missed = 0u64;
    dispatch!(level, _ => for lane in 0..LANES {
        let (x, ten) = (x.0[lane], tens.0[lane]);
        // Of a whole number nothing is lacking.
        let low = rest_of(x, whole(x, ten), ten);
        let half = ROUNDING * x.abs();
        let open = ten == 0.0;
        let long = open & is_long(x) & (x != PI);
        out.value[0].0[lane] = x;
        out.value[1].0[lane] = select(open, 0.0, low);
        out.error.0[lane] = select(open, select(long, half, f64::NAN), 0.0);
        out.doubles.0[lane] = select(ten == 1.0, 0.0, half);
        missed += u64::from(open & !long);
    });
    missed > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels;

    /// Numbers of all sizes: whole, with a few decimals, with many.
    fn numbers(shift: usize) -> Block {
        let mut block = Block::ZERO;
        for (lane, x) in block.0.iter_mut().enumerate() {
            let k = (lane * 7 + shift) as f64;
            *x = match (lane + shift) % 6 {
                0 => k - 600.0,
                1 => (k * 1234.5).round() / 1e3,
                2 => (k + 1.0) / 7.0,
                3 => ((k - 500.0) * 1e7).round() / 1e12,
                4 => k * 1e10 + 0.25,
                _ => -(k + 0.3) * 1e-30,
            };
        }
        block
    }

    fn bits(known: Known) -> [u64; 4] {
        // What is not a number has any sign.
        let bits = |x: f64| if x.is_nan() { f64::NAN } else { x }.to_bits();
        [known.value[0], known.value[1], known.error, known.doubles].map(bits)
    }

    #[test]
    fn blocks_are_what_their_lanes_are_on_every_instruction_set() {
        type Both = (
            fn(Known, Known) -> Known,
            fn(Level, &KnownBlock, &KnownBlock, &mut KnownBlock),
        );
        let operations: [Both; 4] = [
            (sum, sum_blocks),
            (difference, difference_blocks),
            (product, product_blocks),
            (quotient, quotient_blocks),
        ];
        for level in levels() {
            let [mut a, mut b, mut out] = [KnownBlock::ZERO, KnownBlock::ZERO, KnownBlock::ZERO];
            decimals(level, &numbers(1), &mut a);
            decimals(level, &numbers(3), &mut b);
            for block in [&mut a, &mut b] {
                for error in &mut block.error.0 {
                    *error = if error.is_nan() { 1e-17 } else { *error };
                }
            }
            for (one, many) in operations {
                many(level, &a, &b, &mut out);
                for lane in 0..LANES {
                    assert_eq!(bits(out.at(lane)), bits(one(a.at(lane), b.at(lane))));
                }
            }
        }
    }

    /// Held against the shortest decimal that is read as the double, which the standard library writes.
    #[test]
    fn short_decimals_are_those_that_are_written() {
        let (mut short, mut long) = (0, 0);
        for k in 1..200_000u64 {
            // Spread over all mantissas and over numbers from 10⁻⁵ to 10⁸.
            let part = k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11;
            let ten = TENS[(k % 14) as usize];
            let mut x = part as f64 / (1u64 << 53) as f64 * ten / 1e5;
            if k % 3 == 0 {
                // Of fifteen to seventeen digits, as they are typed.
                let digits = (k % 9) as usize;
                x = format!("{x:.*e}", 9 + digits).parse().expect("a number");
            }
            let text = format!("{x:e}");
            let (mantissa, power) = text.split_once('e').expect("a power");
            let digits: u64 = mantissa.replace('.', "").parse().expect("digits");
            let behind =
                mantissa.len().saturating_sub(2) as i32 - power.parse::<i32>().expect("a power");
            if !(1..=22).contains(&behind) {
                continue;
            }
            let ten = TENS[behind as usize];
            let expected =
                ((digits as f64) < FARTHER_APART).then(|| [x, rest_of(x, digits as f64, ten)]);
            assert_eq!(short_decimal(x), expected, "{text}");
            assert!(expected.is_some() || is_long(x), "{text}");
            short += u32::from(expected.is_some());
            long += u32::from(expected.is_none());
        }
        assert!(short > 50_000 && long > 50_000, "{short} {long}");
    }

    #[test]
    fn decimals_are_found_as_one_by_one() {
        let x = numbers(0);
        for level in levels() {
            let mut out = KnownBlock::ZERO;
            assert!(decimals(level, &x, &mut out));
            for (lane, &x) in x.0.iter().enumerate() {
                let known = out.at(lane);
                let whole = x.fract() == 0.0;
                match short_decimal(x) {
                    _ if whole => assert_eq!((known.value, known.doubles), ([x, 0.0], 0.0)),
                    Some(value) => assert_eq!((known.value, known.error), (value, 0.0)),
                    None if is_long(x) => {
                        assert_eq!((known.value, known.error), ([x, 0.0], ROUNDING * x.abs()));
                    }
                    None => assert!(known.error.is_nan(), "{x}"),
                }
            }
        }
    }
}
