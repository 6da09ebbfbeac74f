//! From random words to numbers of given shapes: kernels that the samplers are made of.
//!
//! They are shorter than those of [`crate::elementary`] because their arguments are of one kind. Largest
//! errors, relative unless said otherwise, as the tests measure them:
//!
//! | function | error |
//! |---|---|
//! | [`open_unit`], [`centred`] | exact |
//! | [`square_radius`] | 6·10⁻¹⁶ |
//! | [`normal_pair`] | 6·10⁻¹⁶ of the radius |
//! | [`sin_half_turns`] | 5·10⁻¹⁶ |
//! | [`exp2_m1`] | 3·10⁻¹⁵ |

use crate::elementary::{INTEGER, horner};
use crate::generator::open_unit;

const ONE: u64 = 1.0_f64.to_bits();

/// The upper 51 bits as a number in (−½, ½): an odd multiple of 2⁻⁵², symmetric about zero.
#[inline(always)]
pub(super) fn centred(word: u64) -> f64 {
    f64::from_bits(word >> 12 | (ONE | 1)) - 1.5
}

/// −2 ln u for the [`open_unit`] number u of a word.
#[inline(always)]
pub(super) fn square_radius(word: u64) -> f64 {
    minus_two_ln(open_unit(word))
}

/// −2 ln x for a positive normal number.
#[inline(always)]
pub(super) fn minus_two_ln(x: f64) -> f64 {
    const SERIES: [f64; 7] = [
        0.020_833_333_333_333_343,
        0.000_781_249_999_998_037_2,
        3.487_723_220_944_273e-5,
        1.695_420_161_040_884_5e-6,
        8.670_277_178_412_305e-8,
        4.569_209_098_981_631e-9,
        2.722_525_910_482_445e-10,
    ];
    const MANTISSA: u64 = (1 << 52) - 1;
    const ROOT_HALF: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    // An integer below 2⁵² becomes a float when it is put under the exponent of 2⁵².
    const FLOAT: u64 = 4_503_599_627_370_496.0_f64.to_bits();
    // x = 2ᵏ(1 + f), √½ ≤ 1 + f < √2.
    let bits = x.to_bits().wrapping_add(ONE - ROOT_HALF);
    let k = f64::from_bits(bits >> 52 | FLOAT) - (4_503_599_627_370_496.0 + 1023.0);
    let f = f64::from_bits((bits & MANTISSA) + ROOT_HALF) - 1.0;
    // −2 ln(1 + f) = 4 artanh(t/4) = t + t³(1/48 + …), t = −4f/(2 + f).
    let t = f / f.mul_add(-0.25, -0.5);
    let z = t * t;
    let rest = (t * z).mul_add(horner(z, SERIES), t);
    k.mul_add(-2.0 * std::f64::consts::LN_2, rest)
}

/// Two independent standard normal variables (Box-Muller, JCGM 101 C.4): the first word gives the radius;
/// of the second, the upper bits give an angle within an eighth of a turn of the axis, the lowest three
/// which axis and which of its ends.
#[inline(always)]
pub(super) fn normal_pair(radius: u64, angle: u64) -> (f64, f64) {
    let radius = square_radius(radius).sqrt();
    let (sin, cos) = sin_cos_quarter(centred(angle));
    let odd = angle & 1 != 0;
    let (x, y) = if odd { (sin, cos) } else { (cos, sin) };
    let signed = |x: f64, bit: u32| f64::from_bits(x.to_bits() ^ ((angle << (63 - bit)) & SIGN));
    (radius * signed(x, 1), radius * signed(y, 2))
}

const SIGN: u64 = 1 << 63;

/// (sin, cos) of x right angles, |x| ≤ ½.
#[inline(always)]
fn sin_cos_quarter(x: f64) -> (f64, f64) {
    const SIN: [f64; 7] = [
        std::f64::consts::FRAC_PI_2,
        -0.645_964_097_506_244_3,
        0.079_692_626_246_043_01,
        -0.004_681_754_132_340_976,
        0.000_160_441_150_742_190_9,
        -3.598_643_352_982_31e-6,
        5.633_933_781_537_854e-8,
    ];
    const COS: [f64; 7] = [
        1.0,
        -1.233_700_550_136_151_3,
        0.253_669_507_899_864_75,
        -0.020_863_480_734_946_57,
        0.000_919_259_950_041_661,
        -2.520_013_526_428_479e-5,
        4.655_296_187_486_762_3e-7,
    ];
    let z = x * x;
    (x * horner(z, SIN), horner(z, COS))
}

/// sin πw for the [`centred`] number w of a word: one coordinate of a random direction.
#[inline(always)]
pub(super) fn sin_half_turns(word: u64) -> f64 {
    sin_pi(centred(word))
}

/// sin πw for |w| ≤ ½, with an absolute error below 5·10⁻¹⁶.
#[inline(always)]
pub(crate) fn sin_pi(w: f64) -> f64 {
    const SERIES: [f64; 10] = [
        std::f64::consts::PI,
        -5.167_712_780_049_97,
        2.550_164_039_877_345_5,
        -0.599_264_529_320_786_9,
        0.082_145_886_610_993_56,
        -0.007_370_430_943_702_136,
        0.000_466_302_787_459_327_3,
        -2.191_525_030_185_137_5e-5,
        7.948_539_037_372_32e-7,
        -2.228_371_216_069_697e-8,
    ];
    w * horner(w * w, SERIES)
}

/// 2ˣ − 1 for x ≥ 0, as 2¹⁰²⁰ beyond that.
#[inline(always)]
pub(super) fn exp2_m1(x: f64) -> f64 {
    const SERIES: [f64; 10] = [
        0.693_147_180_559_946_2,
        0.240_226_506_959_100_75,
        0.055_504_108_664_651_67,
        0.009_618_129_107_618_665,
        0.001_333_355_820_079_459_2,
        0.000_154_035_304_247_765_29,
        1.525_267_292_485_073_7e-5,
        1.321_545_162_333_214_3e-6,
        1.020_590_541_376_559_5e-7,
        7.070_977_866_508_138e-9,
    ];
    let x = if x < 1020.0 { x } else { 1020.0 };
    // The integer next to x, which stands in the low bits too.
    let shifted = x + INTEGER;
    let rest = x - (shifted - INTEGER);
    // 2ᵏ(1 + p) − 1.
    let scale = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    scale.mul_add(rest * horner(rest, SERIES), scale - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Double, ulp};

    /// Words from all over, with both ends.
    fn words() -> impl Iterator<Item = u64> {
        let ends = (0..52).flat_map(|bit| [1 << (12 + bit), !(1 << (12 + bit))]);
        let middle = (0..40_000_u64).map(|i| i.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        ends.chain([0, u64::MAX]).chain(middle)
    }

    #[test]
    fn units_stay_inside_the_open_interval() {
        assert_eq!(open_unit(0), 0.5 * f64::EPSILON);
        assert_eq!(open_unit(u64::MAX), 1.0 - 0.5 * f64::EPSILON);
        assert_eq!(open_unit(1 << 63), 0.5 + 0.5 * f64::EPSILON);
        for word in words() {
            let exact = ((word >> 13) as f64 + 0.5) * 2_f64.powi(-51) - 0.5;
            assert_eq!(centred(word), exact);
            assert_eq!(centred(!word), -exact);
        }
    }

    #[test]
    fn radii_keep_their_bound() {
        for word in words() {
            let exact = Double::ln(open_unit(word)).times(Double(-2.0, 0.0));
            let found = square_radius(word);
            let error = ((found - exact.0) - exact.1).abs() / exact.0;
            assert!(error < 6e-16, "{word:x}: {error:e}");
        }
        for x in [1e-300, 0.3, 1.0, 1.7, 1e9, 1e300] {
            let exact = Double::ln(x).times(Double(-2.0, 0.0)).0;
            assert!(
                (minus_two_ln(x) - exact).abs() <= 6e-16 * exact.abs(),
                "{x}"
            );
        }
    }

    #[test]
    fn directions_keep_their_bound() {
        for word in words() {
            let x = centred(word) * std::f64::consts::FRAC_PI_2;
            let (sin, cos) = sin_cos_quarter(centred(word));
            let exact = Double::sin_cos(x);
            // The argument is rounded once for the reference.
            assert!((sin - exact.0.0).abs() < 3e-16, "{word:x}");
            assert!((cos - exact.1.0).abs() < 3e-16, "{word:x}");
            let exact = Double::sin_cos(centred(word) * std::f64::consts::PI).0.0;
            let found = sin_half_turns(word);
            assert!(
                (found - exact).abs() <= 5e-16 * exact.abs() + 1e-300,
                "{word:x}"
            );
        }
        // Four ends of the axes, from the three lowest bits.
        let (_, angle) = (0, 1_u64 << 63);
        let ends: Vec<(bool, bool, bool)> = (0..8)
            .map(|low| normal_pair(1 << 60, angle | low))
            .map(|(x, y)| (x.abs() > y.abs(), x > 0.0, y > 0.0))
            .collect();
        let mut unique = ends.clone();
        unique.sort_unstable();
        unique.dedup();
        assert_eq!(unique.len(), 8, "{ends:?}");
    }

    #[test]
    fn powers_of_two_keep_their_bound() {
        for i in 0..40_000 {
            let x = f64::from(i).powi(3) * 1.5e-11;
            // 2ˣ with the argument in two parts.
            let argument = x * std::f64::consts::LN_2;
            let low = x.mul_add(std::f64::consts::LN_2, -argument) + x * 2.319_046_813_846_3e-17;
            let exact = if argument > 700.0 {
                continue;
            } else {
                Double::expm1(argument)
            };
            let exact = exact.0 + (exact.1 + (exact.0 + 1.0) * low);
            let error = (exp2_m1(x) - exact).abs();
            assert!(error <= 3e-15 * exact + ulp(0.0), "{x}: {error:e}");
        }
        assert_eq!(exp2_m1(0.0), 0.0);
        assert!(exp2_m1(1e9) > 1e306 && exp2_m1(1e9).is_finite());
    }
}
