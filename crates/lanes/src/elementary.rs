//! `exp`, `expm1`, `ln`, `sin`, `cos`: one lane at a time, written so that loops over them
//! vectorise.
//!
//! No branches, no tables, no calls: exceptional arguments are dealt with by selection at the end.
//! Each function reduces its argument to a short interval, evaluates a polynomial there, and
//! undoes the reduction. The polynomials are Chebyshev interpolants computed with 60 digits; their
//! own error is below 0.06 of half a unit in the last place.
//!
//! Largest errors measured against double-double arithmetic, in units of the last place (ulp) of
//! the correctly rounded result:
//!
//! | function | argument | error / ulp |
//! |---|---|---|
//! | [`exp`] | where the result is normal | 0.63 |
//! | [`exp`] | where the result is subnormal | 0.74 |
//! | [`expm1`] | all | 1.01 |
//! | [`ln`] | all, subnormal too | 0.77 |
//! | [`sin`], [`cos`] | all up to [`REDUCIBLE`], zeros of the function included | 0.75 |
//! | [`sin`], [`cos`] | beyond | that of `libm`, below 1 |

/// Largest |x| that the vector range reduction of [`sin`] and [`cos`] takes, 2²⁶; larger arguments
/// go to `libm` one by one.
pub const REDUCIBLE: f64 = 67_108_864.0;

/// ln 2 in two parts; the first has 42 bits, so that its product with an exponent is exact.
const LN2: [f64; 2] = [0.693_147_180_559_890_3, 5.497_923_018_708_371e-14];

/// π/2 in three parts of 53 bits each.
const HALF_PI: [f64; 3] = [
    std::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
];

/// Adding 1.5·2⁵² to |x| < 2⁵¹ rounds to an integer, which then stands in the low bits.
pub(crate) const INTEGER: f64 = 6_755_399_441_055_744.0;

/// c₀ + c₁x + c₂x² + …, each step fused.
#[inline(always)]
pub(crate) fn horner<const N: usize>(x: f64, coefficients: [f64; N]) -> f64 {
    let mut sum = coefficients[N - 1];
    // By index: with an iterator the loop is still one when the loop around it is to be vectorised.
    let mut rest = N - 1;
    while rest > 0 {
        rest -= 1;
        sum = sum.mul_add(x, coefficients[rest]);
    }
    sum
}

/// eˣ = 2ᵏ(1 + r + tail) with |r| ≤ ½ ln 2 and a tail of r²/2 and less; returns (k, r, tail).
#[inline(always)]
fn exp_parts(x: f64) -> (f64, f64, f64) {
    const TAIL: [f64; 11] = [
        0.5,
        0.166_666_666_666_666_7,
        0.041_666_666_666_666_67,
        0.008_333_333_333_326_136,
        0.001_388_888_888_888_374_8,
        0.000_198_412_698_748_206_27,
        2.480_158_732_554_774_3e-5,
        2.755_725_540_020_642_2e-6,
        2.755_727_364_311_03e-7,
        2.510_521_700_472_074_5e-8,
        2.091_468_696_808_687_6e-9,
    ];
    let k = x.mul_add(std::f64::consts::LOG2_E, INTEGER) - INTEGER;
    // x − k·ln 2; what rounding takes from r goes to the tail.
    let first = k.mul_add(-LN2[0], x);
    let r = k.mul_add(-LN2[1], first);
    let low = k.mul_add(-LN2[1], first - r);
    (k, r, (r * r).mul_add(horner(r, TAIL), low))
}

/// 2ᵏ for an integer −1022 ≤ k ≤ 1023.
#[inline(always)]
pub(crate) fn power_of_two(k: f64) -> f64 {
    f64::from_bits((k + INTEGER).to_bits().wrapping_add(1023) << 52)
}

/// `x` within `lower ..= upper`; NaN stays NaN.
#[inline(always)]
fn clamp(x: f64, lower: f64, upper: f64) -> f64 {
    let x = if x < lower { lower } else { x };
    if x > upper { upper } else { x }
}

/// a + b + c with hardly more than one rounding, for |c| far below |b|, and |b| below |a| unless
/// a is 0.
#[inline(always)]
fn add_three(a: f64, b: f64, c: f64) -> f64 {
    let sum = a + b;
    sum + ((a - sum) + b + c)
}

/// eˣ.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    // The limits lie beyond overflow and beyond the underflow to zero. The power of two is
    // applied in two factors because −1077 ≤ k ≤ 1024 is more than one can hold.
    let (k, r, tail) = exp_parts(clamp(x, -746.0, 710.0));
    let half = (k * 0.5 + INTEGER) - INTEGER;
    add_three(1.0, r, tail) * power_of_two(half) * power_of_two(k - half)
}

/// eˣ − 1, accurate for small x too.
#[inline(always)]
pub fn expm1(x: f64) -> f64 {
    let (k, r, tail) = exp_parts(clamp(x, -40.0, 710.0));
    // (2ᵏ − 1) + 2ᵏ(r + tail), at half size because 2¹⁰²⁴ is not a number.
    let half_scale = power_of_two(k - 1.0);
    let result = 2.0 * add_three(half_scale - 0.5, half_scale * r, half_scale * tail);
    // The sum above would lose the sign of −0 and the last bits of a subnormal.
    if x.abs() < f64::MIN_POSITIVE {
        x
    } else {
        result
    }
}

/// The natural logarithm of a positive normal number.
#[inline(always)]
pub(crate) fn ln_normal(x: f64) -> f64 {
    ln_scaled(x, 0.0)
}

/// ln x − shift·ln 2 for a positive normal number.
#[inline(always)]
fn ln_scaled(x: f64, shift: f64) -> f64 {
    const SERIES: [f64; 8] = [
        0.666_666_666_666_666_6,
        0.400_000_000_000_008_8,
        0.285_714_285_708_028_5,
        0.222_222_223_918_870_64,
        0.181_817_956_216_327_82,
        0.153_862_407_089_696_65,
        0.132_687_461_955_965_95,
        0.130_869_078_879_650_27,
    ];
    const MANTISSA: u64 = (1 << 52) - 1;
    const ROOT_HALF: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    const ONE: u64 = 1.0_f64.to_bits();
    // An integer below 2⁵² becomes a float when it is put under the exponent of 2⁵².
    const FLOAT: u64 = 4_503_599_627_370_496.0_f64.to_bits();
    // x = 2ᵏ(1 + f), √½ ≤ 1 + f < √2.
    let bits = x.to_bits().wrapping_add(ONE - ROOT_HALF);
    let k = f64::from_bits(bits >> 52 | FLOAT) - (4_503_599_627_370_496.0 + 1023.0) - shift;
    let f = f64::from_bits((bits & MANTISSA) + ROOT_HALF) - 1.0;
    // ln(1 + f) = 2 artanh s = f − f²/2 + s(f²/2 + R(s²)), s = f/(2 + f).
    let s = f / (2.0 + f);
    let z = s * s;
    let half_square = 0.5 * f * f;
    let tail = s.mul_add(z.mul_add(horner(z, SERIES), half_square), k * LN2[1]);
    k.mul_add(LN2[0], f - (half_square - tail))
}

/// ln x; −∞ at zero, NaN below.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    // Subnormal numbers are multiplied by 2⁵⁴ to make them normal.
    let subnormal = x < f64::MIN_POSITIVE;
    let scaled = if subnormal {
        x * 18_014_398_509_481_984.0
    } else {
        x
    };
    let shift = if subnormal { 54.0 } else { 0.0 };
    let result = ln_scaled(scaled, shift);
    // Only positive finite numbers keep it; +∞ and NaN pass through.
    let result = if x < f64::INFINITY { result } else { x };
    let result = if x == 0.0 { f64::NEG_INFINITY } else { result };
    if x < 0.0 { f64::NAN } else { result }
}

/// sin(r + low) and cos(r + low) for |r| ≤ π/4 and |low| below the last place of r.
#[inline(always)]
fn sin_cos_core(r: f64, low: f64) -> (f64, f64) {
    const SIN: [f64; 7] = [
        -0.166_666_666_666_666_66,
        0.008_333_333_333_333_331,
        -0.000_198_412_698_412_650_63,
        2.755_731_921_933_731_2e-6,
        -2.505_210_623_180_283_7e-8,
        1.605_853_151_679_775_8e-10,
        -7.586_691_094_197_958e-13,
    ];
    const COS: [f64; 6] = [
        0.041_666_666_666_666_664,
        -0.001_388_888_888_888_739_8,
        2.480_158_729_876_456e-5,
        -2.755_731_727_114_514_4e-7,
        2.087_614_614_655_861e-9,
        -1.138_262_364_747_460_4e-11,
    ];
    let z = r * r;
    // sin(r + low) ≈ sin r + low·(1 − r²/2).
    let sin = r + (z * r).mul_add(horner(z, SIN), z.mul_add(-0.5, 1.0) * low);
    // 1 − z/2 rounds; what it loses is added to the small terms. cos(r + low) ≈ cos r − low·r.
    let half = 0.5 * z;
    let head = 1.0 - half;
    let cos = head + (z * z).mul_add(horner(z, COS), (1.0 - head - half) - r * low);
    (sin, cos)
}

/// Turns (sin, cos) by `quadrant` right angles.
#[inline(always)]
fn turn((sin, cos): (f64, f64), quadrant: u64) -> (f64, f64) {
    let odd = quadrant & 1 != 0;
    let (s, c) = if odd { (cos, sin) } else { (sin, cos) };
    let sign_of_sin = (quadrant & 2) << 62;
    let sign_of_cos = (quadrant.wrapping_add(1) & 2) << 62;
    (
        f64::from_bits(s.to_bits() ^ sign_of_sin),
        f64::from_bits(c.to_bits() ^ sign_of_cos),
    )
}

/// (sin x, cos x) for |x| ≤ [`REDUCIBLE`].
#[inline(always)]
fn sin_cos_reducible(x: f64) -> (f64, f64) {
    let shifted = x.mul_add(std::f64::consts::FRAC_2_PI, INTEGER);
    let k = shifted - INTEGER;
    // x − k·π/2 to twice the working precision. The first difference is exact: it is a multiple
    // of the last place of π/2 and below one. The second part may cancel it almost wholly when x
    // is near a multiple of π/2, so product and difference keep their rounding errors.
    let first = k.mul_add(-HALF_PI[0], x);
    let product = k * HALF_PI[1];
    let product_low = k.mul_add(HALF_PI[1], -product);
    let sum = first - product;
    let back = sum - first;
    let sum_low = (first - (sum - back)) - (product + back);
    let low = k.mul_add(-HALF_PI[2], sum_low - product_low);
    let r = sum + low;
    turn(sin_cos_core(r, (sum - r) + low), shifted.to_bits())
}

/// sin x for |x| ≤ [`REDUCIBLE`].
#[inline(always)]
pub(crate) fn sin_reducible(x: f64) -> f64 {
    let result = sin_cos_reducible(x).0;
    // The sum in the polynomial loses the sign of −0.
    if x == 0.0 { x } else { result }
}

/// cos x for |x| ≤ [`REDUCIBLE`].
#[inline(always)]
pub(crate) fn cos_reducible(x: f64) -> f64 {
    sin_cos_reducible(x).1
}

/// sin x.
#[inline(always)]
pub fn sin(x: f64) -> f64 {
    if x.abs() <= REDUCIBLE {
        sin_reducible(x)
    } else {
        libm::sin(x)
    }
}

/// cos x.
#[inline(always)]
pub fn cos(x: f64) -> f64 {
    if x.abs() <= REDUCIBLE {
        cos_reducible(x)
    } else {
        libm::cos(x)
    }
}

#[cfg(test)]
mod tests;
