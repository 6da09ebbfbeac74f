//! The table of operations: everything that is to be known about an operation stands in its row.
//!
//! Values at the estimates and in blocks of trials come from the same functions as far as these have a
//! vector form, and otherwise from the `libm` crate: nothing depends on the platform's own library.
//!
//! An ordinary function of one argument is added by one entry in [`UNARY`]; the parser, the unit
//! check, derivatives, blocks, hints and the help all read the table.

use std::f64::consts::{FRAC_PI_2, LN_2, LN_10, PI};
use std::hash::{Hash, Hasher};

use gumption_lanes::{Block, LANES, Level, elementary, ops as kernels};

use super::jet::Jet;
use crate::special;

/// What a function does to units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DimensionRule {
    /// Dimension one in, dimension one out.
    One,
    /// An angle (dimension one, converted to rad) in, dimension one out.
    Angle,
    /// Dimension one in, an angle in rad out.
    ToAngle,
    /// All arguments of one dimension, which is also that of the value.
    Same,
    /// All arguments of one dimension; the value has dimension one.
    Ratio,
    /// Any dimension in, dimension one out.
    Sign,
    /// The n-th root of the argument's dimension.
    Root(i32),
    /// Handled by the rules of `*`, `/` and `^`.
    Operator,
    /// True or false in and out.
    Truth,
}

impl DimensionRule {
    /// In words, for the help.
    pub fn words(self) -> &'static str {
        match self {
            DimensionRule::One => "takes and gives a number (dimension one)",
            DimensionRule::Angle => "takes an angle (°, rad …), gives a number",
            DimensionRule::ToAngle => "takes a number, gives an angle",
            DimensionRule::Same => {
                "gives the unit of its arguments, which must be of one dimension"
            }
            DimensionRule::Ratio => "takes arguments of one dimension, gives a number or an angle",
            DimensionRule::Sign => "takes any unit, gives a number",
            DimensionRule::Root(2) => "gives the square root of the unit",
            DimensionRule::Root(_) => "gives the root of the unit",
            DimensionRule::Operator => "combines the units of its arguments",
            DimensionRule::Truth => "takes and gives true or false",
        }
    }
}

/// Where a function is not smooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Smoothness {
    /// Everywhere smooth inside its domain.
    Smooth,
    /// A corner where the argument is 0, or where both arguments are equal.
    Corner,
    /// Constant between steps: its derivative says nothing.
    Steps,
    /// A jump on the negative axis (atan2).
    Branch,
}

/// A function of one argument.
pub struct Unary {
    /// As it is called; names that are no identifiers belong to operators.
    pub name: &'static str,
    /// As a spreadsheet has it, of the cell `{a}`.
    pub cells: &'static str,
    pub signature: &'static str,
    pub doc: &'static str,
    pub dimension: DimensionRule,
    pub scalar: fn(f64) -> f64,
    /// f, f', f'', f'''.
    pub derivatives: fn(f64) -> [f64; 4],
    pub block: fn(Level, &Block, &mut Block),
    pub smoothness: Smoothness,
    /// The end of the domain or pole nearest to the argument.
    pub edge: Option<fn(f64) -> f64>,
}

/// A function of two arguments.
pub struct Binary {
    pub name: &'static str,
    /// As a spreadsheet has it, of the cells `{a}` and `{b}`.
    pub cells: &'static str,
    /// Empty for operators.
    pub signature: &'static str,
    pub doc: &'static str,
    pub dimension: DimensionRule,
    pub scalar: fn(f64, f64) -> f64,
    pub rule: Rule,
    pub block: fn(Level, &Block, &Block, &mut Block),
    pub smoothness: Smoothness,
}

/// How a function of two arguments is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Atan2,
    Hypot,
    /// Picks an argument: the value's own.
    Pick,
    /// Locally constant.
    Constant,
    /// Follows the first argument on average (the mean slope of a staircase).
    Staircase,
}

macro_rules! lanewise {
    ($f:expr) => {
        |_, a, out| {
            for lane in 0..LANES {
                out.0[lane] = $f(a.0[lane]);
            }
        }
    };
}

macro_rules! row {
    ($name:literal, $cells:literal, $doc:literal, $dimension:expr, $scalar:expr, $derivatives:expr, $block:expr) => {
        row!(
            $name,
            $cells,
            $doc,
            $dimension,
            $scalar,
            $derivatives,
            $block,
            Smoothness::Smooth,
            None
        )
    };
    ($name:literal, $cells:literal, $doc:literal, $dimension:expr, $scalar:expr, $derivatives:expr, $block:expr, $smoothness:expr, $edge:expr) => {
        Unary {
            name: $name,
            cells: $cells,
            signature: concat!($name, "(x)"),
            doc: $doc,
            dimension: $dimension,
            scalar: $scalar,
            derivatives: $derivatives,
            block: $block,
            smoothness: $smoothness,
            edge: $edge,
        }
    };
}

macro_rules! row2 {
    ($name:literal, $cells:literal, $signature:literal, $doc:literal, $dimension:expr, $scalar:expr, $rule:expr, $block:expr, $smoothness:expr) => {
        Binary {
            name: $name,
            cells: $cells,
            signature: $signature,
            doc: $doc,
            dimension: $dimension,
            scalar: $scalar,
            rule: $rule,
            block: $block,
            smoothness: $smoothness,
        }
    };
}

use DimensionRule::{Angle, One, Operator, Ratio, Root, Same, Sign, ToAngle, Truth};
use Smoothness::{Branch, Corner, Smooth, Steps};

/// Functions of one argument.
#[rustfmt::skip] // A table reads by lines.
pub static UNARY: &[Unary] = &[
    row!("-", "-{a}", "opposite", Same, |x| -x, |x| [-x, -1.0, 0.0, 0.0], kernels::neg),
    row!("not", "1-{a}", "negation of a condition", Truth, negate, |x| [negate(x), 0.0, 0.0, 0.0], kernels::not),
    row!("^2", "{a}^2", "square", Operator, |x| x * x, |x| [x * x, 2.0 * x, 2.0, 0.0], kernels::sq),
    row!("abs", "ABS({a})", "absolute value", Same, f64::abs, |x| [x.abs(), sign(x), 0.0, 0.0], kernels::abs, Corner, None),
    row!("sqrt", "SQRT({a})", "square root", Root(2), f64::sqrt, sqrt, kernels::sqrt, Smooth, Some(|_| 0.0)),
    row!("cbrt", "SIGN({a})*ABS({a})^(1/3)", "cube root", Root(3), libm::cbrt, cbrt, kernels::cbrt, Smooth, Some(|_| 0.0)),
    row!("exp", "EXP({a})", "exponential function", One, elementary::exp, |x| [elementary::exp(x); 4], kernels::exp),
    row!("ln", "LN({a})", "natural logarithm", One, elementary::ln, |x| logarithm(elementary::ln(x), x, 1.0), kernels::ln, Smooth, Some(|_| 0.0)),
    row!("log10", "LOG10({a})", "logarithm to base 10", One, libm::log10, |x| logarithm(libm::log10(x), x, LN_10), kernels::log10, Smooth, Some(|_| 0.0)),
    row!("log2", "LOG({a},2)", "logarithm to base 2", One, libm::log2, |x| logarithm(libm::log2(x), x, LN_2), kernels::log2, Smooth, Some(|_| 0.0)),
    row!("sin", "SIN({a})", "sine", Angle, elementary::sin, sin, kernels::sin),
    row!("cos", "COS({a})", "cosine", Angle, elementary::cos, cos, kernels::cos),
    row!("tan", "TAN({a})", "tangent", Angle, libm::tan, tan, kernels::tan, Smooth, Some(|x| ((x - FRAC_PI_2) / PI).round() * PI + FRAC_PI_2)),
    row!("asin", "ASIN({a})", "inverse sine", ToAngle, libm::asin, |x| arc(libm::asin(x), x, 1.0), kernels::asin, Smooth, Some(f64::signum)),
    row!("acos", "ACOS({a})", "inverse cosine", ToAngle, libm::acos, |x| arc(libm::acos(x), x, -1.0), kernels::acos, Smooth, Some(f64::signum)),
    row!("atan", "ATAN({a})", "inverse tangent", ToAngle, libm::atan, atan, kernels::atan),
    row!("sinh", "SINH({a})", "hyperbolic sine", One, libm::sinh, sinh, kernels::sinh),
    row!("cosh", "COSH({a})", "hyperbolic cosine", One, libm::cosh, cosh, kernels::cosh),
    row!("tanh", "TANH({a})", "hyperbolic tangent", One, libm::tanh, tanh, kernels::tanh),
    row!("asinh", "ASINH({a})", "inverse hyperbolic sine", One, libm::asinh, asinh, kernels::asinh),
    row!("acosh", "ACOSH({a})", "inverse hyperbolic cosine", One, libm::acosh, acosh, kernels::acosh, Smooth, Some(|_| 1.0)),
    row!("atanh", "ATANH({a})", "inverse hyperbolic tangent", One, libm::atanh, atanh, kernels::atanh, Smooth, Some(f64::signum)),
    row!("erf", "2*NORMSDIST({a}*SQRT(2))-1", "error function", One, libm::erf, erf, lanewise!(libm::erf)),
    row!("normal_cdf", "NORMSDIST({a})", "distribution function of the standard normal distribution", One, special::normal_cdf, normal_cdf, lanewise!(special::normal_cdf)),
    row!("normal_quantile", "NORMSINV({a})", "quantile of the standard normal distribution", One, special::normal_quantile, normal_quantile, lanewise!(special::normal_quantile), Smooth, Some(|p| p.round().clamp(0.0, 1.0))),
    row!("sign", "SIGN({a})", "-1, 0 or 1", Sign, sign, |x| [sign(x), 0.0, 0.0, 0.0], kernels::sign, Steps, None),
    row!("floor", "INT({a})", "next whole number below", One, f64::floor, |x| [x.floor(), 0.0, 0.0, 0.0], kernels::floor, Steps, None),
    row!("ceil", "-INT(-{a})", "next whole number above", One, f64::ceil, |x| [x.ceil(), 0.0, 0.0, 0.0], kernels::ceil, Steps, None),
    row!("round", "ROUND({a},0)", "nearest whole number, halves away from zero", One, f64::round, |x| [x.round(), 0.0, 0.0, 0.0], kernels::round, Steps, None),
];

/// Functions of two arguments, operators included.
#[rustfmt::skip] // A table reads by lines.
pub static BINARY: &[Binary] = &[
    row2!("+", "{a}+{b}", "", "sum", Same, |a, b| a + b, Rule::Add, kernels::add, Smooth),
    row2!("-", "{a}-{b}", "", "difference", Same, |a, b| a - b, Rule::Sub, kernels::sub, Smooth),
    row2!("*", "{a}*{b}", "", "product", Operator, |a, b| a * b, Rule::Mul, kernels::mul, Smooth),
    row2!("/", "{a}/{b}", "", "quotient", Operator, |a, b| a / b, Rule::Div, kernels::div, Smooth),
    row2!("^", "{a}^{b}", "", "power", Operator, libm::pow, Rule::Pow, kernels::pow, Smooth),
    row2!("atan2", "ATAN2({b},{a})", "atan2(y, x)", "angle of the point (x, y) seen from the origin, from -π to π", Ratio, libm::atan2, Rule::Atan2, kernels::atan2, Branch),
    row2!("hypot", "SQRT({a}^2+{b}^2)", "hypot(a, b, …)", "square root of the sum of squares", Same, libm::hypot, Rule::Hypot, kernels::hypot, Smooth),
    row2!("min", "MIN({a},{b})", "min(a, b, …)", "smallest argument or element", Same, smaller, Rule::Pick, kernels::min, Corner),
    row2!("max", "MAX({a},{b})", "max(a, b, …)", "largest argument or element", Same, larger, Rule::Pick, kernels::max, Corner),
    row2!("quantize", "ROUND({a}/{b},0)*{b}", "quantize(x, step)", "x rounded to the nearest multiple of a step; its derivative is the mean slope, 1", Same, quantize, Rule::Staircase, quantize_block, Smooth),
    row2!("<", "IF({a}<{b},1,0)", "", "less than", Ratio, |a, b| truth(a < b), Rule::Constant, kernels::lt, Corner),
    row2!("<=", "IF({a}<={b},1,0)", "", "at most", Ratio, |a, b| truth(a <= b), Rule::Constant, kernels::le, Corner),
    row2!(">", "IF({a}>{b},1,0)", "", "greater than", Ratio, |a, b| truth(a > b), Rule::Constant, kernels::gt, Corner),
    row2!(">=", "IF({a}>={b},1,0)", "", "at least", Ratio, |a, b| truth(a >= b), Rule::Constant, kernels::ge, Corner),
    row2!("==", "IF({a}={b},1,0)", "", "equal", Ratio, |a, b| truth(a == b), Rule::Constant, kernels::eq, Corner),
    row2!("!=", "IF({a}<>{b},1,0)", "", "different", Ratio, |a, b| truth(a != b), Rule::Constant, kernels::ne, Corner),
    row2!("and", "{a}*{b}", "", "both", Truth, |a, b| a * b, Rule::Constant, kernels::and, Smooth),
    row2!("or", "MAX({a},{b})", "", "at least one", Truth, larger, Rule::Constant, kernels::or, Smooth),
];

/// The row of a function or operator with one argument.
pub fn unary(name: &str) -> Option<&'static Unary> {
    UNARY.iter().find(|row| row.name == name)
}

/// The row of a function or operator with two arguments.
pub fn binary_row(name: &str) -> Option<&'static Binary> {
    BINARY.iter().find(|row| row.name == name)
}

impl Unary {
    /// f at a jet.
    pub fn value<const N: usize>(&self, x: Jet<N>) -> Jet<N> {
        if N == 1 {
            return Jet::constant((self.scalar)(x.value()));
        }
        x.compose(&(self.derivatives)(x.value()))
            .with_value((self.scalar)(x.value()))
    }

    /// f' at a jet.
    pub fn slope<const N: usize>(&self, x: Jet<N>) -> Jet<N> {
        x.compose(&(self.derivatives)(x.value())[1..])
    }
}

impl Binary {
    /// f at jets.
    pub fn value<const N: usize>(&self, a: Jet<N>, b: Jet<N>) -> Jet<N> {
        let value = || (self.scalar)(a.value(), b.value());
        match self.rule {
            Rule::Add => a + b,
            Rule::Sub => a - b,
            Rule::Mul => a * b,
            Rule::Div => a / b,
            _ if N == 1 => Jet::constant(value()),
            Rule::Pow if stays_zero(a, b) => Jet::constant(value()),
            Rule::Pow => {
                // exp(b ln a), where a and b both move.
                let exponent = b * a.compose(&logarithm(elementary::ln(a.value()), a.value(), 1.0));
                exponent.compose(&[value(); 3])
            }
            Rule::Atan2 => {
                // atan2(a, b) turned back by its own value is atan of this quotient, which is 0 here.
                let (a0, b0) = (Jet::constant(a.value()), Jet::constant(b.value()));
                let quotient = (b0 * a - a0 * b) / (b0 * b + a0 * a);
                quotient.compose(&[0.0, 1.0, 0.0]).with_value(value())
            }
            Rule::Hypot => {
                let value = value();
                let scale = Jet::constant(if value == 0.0 { 1.0 } else { value });
                let (p, q) = (a / scale, b / scale);
                (scale * (p * p + q * q).sqrt()).with_value(value)
            }
            Rule::Pick if value() == a.value() => a,
            Rule::Pick => b.with_value(value()),
            Rule::Constant => Jet::constant(value()),
            Rule::Staircase => a.with_value(value()),
        }
    }

    /// ∂f/∂a and ∂f/∂b at jets.
    pub fn slopes<const N: usize>(&self, a: Jet<N>, b: Jet<N>) -> (Jet<N>, Jet<N>) {
        let (zero, one) = (Jet::constant(0.0), Jet::constant(1.0));
        match self.rule {
            Rule::Add => (one, one),
            Rule::Sub => (one, -one),
            Rule::Mul => (b, a),
            Rule::Div => (b.recip(), -(a / b) / b),
            Rule::Pow if stays_zero(a, b) => (self.value(a, b - one) * b, zero),
            Rule::Pow => {
                let power = self.value(a, b);
                let log = a.compose(&logarithm(elementary::ln(a.value()), a.value(), 1.0));
                (self.value(a, b - one) * b, power * log)
            }
            Rule::Atan2 => {
                let square = a * a + b * b;
                (b / square, -a / square)
            }
            Rule::Hypot => {
                let h = self.value(a, b);
                (a / h, b / h)
            }
            Rule::Pick if (self.scalar)(a.value(), b.value()) == a.value() => (one, zero),
            Rule::Pick => (zero, one),
            Rule::Constant => (zero, zero),
            Rule::Staircase => (one, zero),
        }
    }
}

/// Whether a^b is 0 whatever the exponent does, as (dose/e)^b is without a dose: a is 0 and does not move, and b is positive. By way
/// of ln a it would have no derivative.
fn stays_zero<const N: usize>(a: Jet<N>, b: Jet<N>) -> bool {
    a.0.iter().all(|part| *part == 0.0) && b.value() > 0.0
}

/// x^c, for a constant exponent.
pub fn power(x: f64, c: f64) -> f64 {
    product(x, c).unwrap_or_else(|| libm::pow(x, c))
}

/// x^c and its first three derivatives.
pub fn power_derivatives(x: f64, c: f64) -> [f64; 4] {
    let mut value = power(x, c);
    let mut out = [value, 0.0, 0.0, 0.0];
    let (mut factor, mut exponent) = (1.0, c);
    for derivative in &mut out[1..] {
        factor *= exponent;
        exponent -= 1.0;
        if factor == 0.0 {
            break;
        }
        // x^(c − 1) = x^c / x spares a search for logarithms, unless x^c is zero, infinite or of few digits.
        value = match product(x, exponent) {
            Some(value) => value,
            None if value.is_normal() => value / x,
            None => libm::pow(x, exponent),
        };
        *derivative = factor * value;
    }
    out
}

/// x^c where it is a short product, as in blocks.
fn product(x: f64, c: f64) -> Option<f64> {
    match c {
        0.0 => Some(1.0),
        1.0 => Some(x),
        2.0 => Some(x * x),
        3.0 => Some(x * (x * x)),
        _ => None,
    }
}

/// A row of a table is itself only.
macro_rules! by_place {
    ($row:ident) => {
        impl PartialEq for $row {
            fn eq(&self, other: &Self) -> bool {
                std::ptr::eq(self, other)
            }
        }
        impl Eq for $row {}
        impl Hash for $row {
            fn hash<H: Hasher>(&self, state: &mut H) {
                std::ptr::hash(self, state);
            }
        }
        impl std::fmt::Debug for $row {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name)
            }
        }
    };
}
by_place!(Unary);
by_place!(Binary);

// --- values and derivatives that are too long for a table ------------------------------------

fn truth(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

fn negate(x: f64) -> f64 {
    1.0 - x
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// The smaller number; not a number if either is none.
fn smaller(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.min(b)
    }
}

fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

fn quantize(x: f64, step: f64) -> f64 {
    (x / step).round() * step
}

fn quantize_block(level: Level, x: &Block, step: &Block, out: &mut Block) {
    let mut steps = Block::ZERO;
    kernels::div(level, x, step, out);
    kernels::round(level, out, &mut steps);
    kernels::mul(level, &steps, step, out);
}

fn sqrt(x: f64) -> [f64; 4] {
    let s = x.sqrt();
    [s, 0.5 / s, -0.25 / (x * s), 0.375 / (x * x * s)]
}

fn cbrt(x: f64) -> [f64; 4] {
    let c = libm::cbrt(x);
    let d = 1.0 / (3.0 * c * c);
    [c, d, -2.0 * d / (3.0 * x), 10.0 * d / (9.0 * x * x)]
}

fn logarithm(value: f64, x: f64, base: f64) -> [f64; 4] {
    let r = 1.0 / x;
    [value, r / base, -r * r / base, 2.0 * r * r * r / base]
}

fn sin(x: f64) -> [f64; 4] {
    let (s, c) = (elementary::sin(x), elementary::cos(x));
    [s, c, -s, -c]
}

fn cos(x: f64) -> [f64; 4] {
    let (s, c) = (elementary::sin(x), elementary::cos(x));
    [c, -s, -c, s]
}

fn tan(x: f64) -> [f64; 4] {
    let t = libm::tan(x);
    let g = 1.0 + t * t;
    [t, g, 2.0 * t * g, 2.0 * g * (1.0 + 3.0 * t * t)]
}

/// asin (`side` 1) and acos (`side` -1).
fn arc(value: f64, x: f64, side: f64) -> [f64; 4] {
    // (1-x)(1+x) keeps its digits near the ends, 1-x² does not.
    let r = side / ((1.0 - x) * (1.0 + x)).sqrt();
    let r2 = r * r;
    [value, r, x * r * r2, (1.0 + 2.0 * x * x) * r * r2 * r2]
}

fn atan(x: f64) -> [f64; 4] {
    let q = 1.0 / (1.0 + x * x);
    [
        libm::atan(x),
        q,
        -2.0 * x * q * q,
        (6.0 * x * x - 2.0) * q * q * q,
    ]
}

fn sinh(x: f64) -> [f64; 4] {
    let (s, c) = (libm::sinh(x), libm::cosh(x));
    [s, c, s, c]
}

fn cosh(x: f64) -> [f64; 4] {
    let (s, c) = (libm::sinh(x), libm::cosh(x));
    [c, s, c, s]
}

fn tanh(x: f64) -> [f64; 4] {
    let (t, c) = (libm::tanh(x), libm::cosh(x));
    let g = 1.0 / (c * c);
    [t, g, -2.0 * t * g, g * (6.0 * t * t - 2.0)]
}

fn asinh(x: f64) -> [f64; 4] {
    let r = 1.0 / libm::hypot(1.0, x);
    let r3 = r * r * r;
    [libm::asinh(x), r, -x * r3, (2.0 * x * x - 1.0) * r3 * r * r]
}

fn acosh(x: f64) -> [f64; 4] {
    let r = 1.0 / ((x - 1.0) * (x + 1.0)).sqrt();
    let r3 = r * r * r;
    [libm::acosh(x), r, -x * r3, (2.0 * x * x + 1.0) * r3 * r * r]
}

fn atanh(x: f64) -> [f64; 4] {
    let q = 1.0 / ((1.0 - x) * (1.0 + x));
    [
        libm::atanh(x),
        q,
        2.0 * x * q * q,
        (2.0 + 6.0 * x * x) * q * q * q,
    ]
}

fn normal_cdf(x: f64) -> [f64; 4] {
    let d = special::normal_pdf(x);
    [special::normal_cdf(x), d, -x * d, (x * x - 1.0) * d]
}

fn normal_quantile(p: f64) -> [f64; 4] {
    let x = special::normal_quantile(p);
    let r = 1.0 / special::normal_pdf(x);
    [x, r, x * r * r, (1.0 + 2.0 * x * x) * r * r * r]
}

fn erf(x: f64) -> [f64; 4] {
    let d = std::f64::consts::FRAC_2_SQRT_PI * elementary::exp(-x * x);
    [libm::erf(x), d, -2.0 * x * d, (4.0 * x * x - 2.0) * d]
}
