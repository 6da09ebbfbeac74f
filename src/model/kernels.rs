//! Block kernels.
use gumption_lanes::{Block, LANES};
#[derive(Debug, Clone, Copy)]
pub struct Level;
pub fn level() -> Level { Level }
macro_rules! one { ($($n:ident = $f:expr;)*) => { $(pub fn $n(_: Level, a: &Block, out: &mut Block) { for i in 0..LANES { out.0[i] = $f(a.0[i]); } })* } }
macro_rules! two { ($($n:ident = $f:expr;)*) => { $(pub fn $n(_: Level, a: &Block, b: &Block, out: &mut Block) { for i in 0..LANES { out.0[i] = $f(a.0[i], b.0[i]); } })* } }
one! { neg = |x: f64| -x; abs = f64::abs; sqrt = f64::sqrt; sq = |x: f64| x * x; cbrt = libm::cbrt; exp = libm::exp; ln = libm::log; log10 = libm::log10; log2 = libm::log2;
 sin = libm::sin; cos = libm::cos; tan = libm::tan; asin = libm::asin; acos = libm::acos; atan = libm::atan; sinh = libm::sinh; cosh = libm::cosh; tanh = libm::tanh; asinh = libm::asinh; acosh = libm::acosh; atanh = libm::atanh;
 sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() }; floor = f64::floor; ceil = f64::ceil; round = f64::round_ties_even; }
two! { add = |a, b| a + b; sub = |a, b| a - b; mul = |a, b| a * b; div = |a, b| a / b; pow = libm::pow; atan2 = libm::atan2; hypot = libm::hypot; min = |a: f64, b: f64| if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }; max = |a: f64, b: f64| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }; }
pub fn add_scalar(_: Level, a: &Block, s: f64, out: &mut Block) { for i in 0..LANES { out.0[i] = a.0[i] + s; } }
pub fn mul_scalar(_: Level, a: &Block, s: f64, out: &mut Block) { for i in 0..LANES { out.0[i] = a.0[i] * s; } }
pub fn rsub_scalar(_: Level, a: &Block, s: f64, out: &mut Block) { for i in 0..LANES { out.0[i] = s - a.0[i]; } }
pub fn rdiv_scalar(_: Level, a: &Block, s: f64, out: &mut Block) { for i in 0..LANES { out.0[i] = s / a.0[i]; } }
pub fn powi(_: Level, a: &Block, n: i32, out: &mut Block) { for i in 0..LANES { out.0[i] = libm::pow(a.0[i], f64::from(n)); } }
pub fn select(_: Level, c: &Block, a: &Block, b: &Block, out: &mut Block) { for i in 0..LANES { out.0[i] = if c.0[i] != 0.0 { a.0[i] } else { b.0[i] }; } }
