//! The list of all functions, for calls, suggestions and the help.

use std::collections::HashMap;
use std::sync::LazyLock;

use foldhash::fast::RandomState;

use super::operation::{BINARY, DimensionRule, UNARY};

/// What the help says about a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FunctionInfo {
    /// Its name.
    pub name: &'static str,
    /// How it is called, e.g. `atan2(y, x)`.
    pub signature: &'static str,
    /// What it gives, in one line.
    pub doc: &'static str,
    /// What it does to units, in words.
    pub dimension: &'static str,
    /// Whether it is linear in its arguments, or in one while the others are held.
    pub is_linear: bool,
}

impl FunctionInfo {
    /// Whether its value is in the unit of its arguments, and in proportion to all of them together.
    pub fn keeps_unit(&self) -> bool {
        [SAME, DimensionRule::Same.words()].contains(&self.dimension)
    }
}

const SAME: &str = "gives the unit of the elements, which must be of one dimension";

/// Reductions and special forms.
#[rustfmt::skip] // A table reads by lines.
const FORMS: &[FunctionInfo] = &[
    linear("mean", "mean(x)", "arithmetic mean of the elements", SAME),
    linear("sum", "sum(x)", "sum of the elements", SAME),
    form("prod", "prod(x)", "product of the elements", "gives the product of the units"),
    linear("dot", "dot(x, y)", "sum of the products of corresponding elements", "gives the product of the units"),
    form("norm", "norm(x)", "square root of the sum of the squared elements", SAME),
    form("median", "median(x)", "middle element in order of size, or the mean of the middle two", SAME),
    form("sd", "sd(x)", "experimental standard deviation of the elements (divisor n - 1)", "gives the unit of differences between elements"),
    form("len", "len(x)", "number of elements", "gives a number"),
    form("slope", "slope(x, y)", "slope of the least-squares line y = a + b x", "gives the unit of y divided by that of x"),
    form("intercept", "intercept(x, y)", "value at x = 0 of the least-squares line y = a + b x", "gives the unit of y"),
    form("slope_through_origin", "slope_through_origin(x, y)", "slope of the least-squares line y = b x", "gives the unit of y divided by that of x"),
    linear("cmul", "cmul(a, b)", "product of two complex quantities [re, im]", "gives the product of the units"),
    form("cdiv", "cdiv(a, b)", "quotient of two complex quantities [re, im]", "gives the quotient of the units"),
    linear("conj", "conj(z)", "conjugate of a complex quantity [re, im]", "gives the unit of its argument"),
    form("cabs", "cabs(z)", "modulus of a complex quantity [re, im]", "gives the unit of its argument"),
    form("carg", "carg(z)", "argument (phase) of a complex quantity [re, im], from -π to π", "takes any unit, gives an angle"),
    form("csqrt", "csqrt(z)", "square root of a complex quantity [re, im], with a real part that is not negative", "gives the square root of the unit"),
    form("cexp", "cexp(z)", "exponential function of a complex number [re, im]", "takes and gives numbers (dimension one)"),
    form("polar", "polar(r, phi)", "the complex quantity [r cos(phi), r sin(phi)]", "takes an angle, gives the unit of r"),
    linear("cross", "cross(a, b)", "vector product of two vectors [x, y, z]", "gives the product of the units"),
    linear("rotate_x", "rotate_x(v, angle)", "the vector v = [x, y, z] turned about the x axis, from y towards z", "takes an angle, gives the unit of v"),
    linear("rotate_y", "rotate_y(v, angle)", "the vector v = [x, y, z] turned about the y axis, from z towards x", "takes an angle, gives the unit of v"),
    linear("rotate_z", "rotate_z(v, angle)", "the vector v = [x, y, z] turned about the z axis, from x towards y", "takes an angle, gives the unit of v"),
    form("linspace", "linspace(a, b, n)", "n evenly spaced values from a to b", "gives the unit of the ends, which must be of one dimension"),
    form("polyval", "polyval(c, x)", "c[1] + c[2] x + c[3] x^2 …; a list of coefficients may have different units", "gives the unit of the terms, which must be of one dimension"),
    linear("interpolate", "interpolate(x, xs, ys)", "value at x of the straight lines between the points of a table; the xs are exactly known and rise", "gives the unit of ys; x and xs must be of one dimension"),
    form("t_quantile", "t_quantile(p, nu)", "quantile of the t distribution with nu degrees of freedom; of exactly known numbers", "takes and gives a number (dimension one)"),
    form("chi_squared_quantile", "chi_squared_quantile(p, nu)", "quantile of the χ² distribution with nu degrees of freedom; of exactly known numbers", "takes and gives a number (dimension one)"),
    form("f_quantile", "f_quantile(p, nu1, nu2)", "quantile of the F distribution with nu1 and nu2 degrees of freedom; of exactly known numbers", "takes and gives a number (dimension one)"),
    form("gamma_function", "gamma_function(x)", "gamma function Γ(x) of an exactly known number", "takes and gives a number (dimension one)"),
    form("ln_gamma", "ln_gamma(x)", "natural logarithm of Γ(x) of an exactly known number", "takes and gives a number (dimension one)"),
    form("pow", "pow(x, n)", "power, as x^n", "gives the power of the unit; n is a constant simple fraction unless x is a number"),
    form("kelvin", "kelvin(T)", "thermodynamic temperature of a temperature in °C or °F", "gives K"),
    linear("value_in", "value_in(x, 'unit')", "the number of x in the stated unit", "gives a number"),
    form("if", "if(condition, a, b)", "a where the condition holds, otherwise b; also `if condition then a else b`", SAME),
    form("solve", "solve(equation, unknown, start)", "the root of an equation `a == b` near a start value, with its derivatives", "gives the unit of the start value"),
];

const fn form(
    name: &'static str,
    signature: &'static str,
    doc: &'static str,
    dimension: &'static str,
) -> FunctionInfo {
    FunctionInfo {
        name,
        signature,
        doc,
        dimension,
        is_linear: false,
    }
}

/// One that is linear in its arguments, or in one while the others are held.
const fn linear(
    name: &'static str,
    signature: &'static str,
    doc: &'static str,
    dimension: &'static str,
) -> FunctionInfo {
    FunctionInfo {
        is_linear: true,
        ..form(name, signature, doc, dimension)
    }
}

/// All functions of the language.
pub fn functions() -> &'static [FunctionInfo] {
    static ALL: std::sync::OnceLock<Vec<FunctionInfo>> = std::sync::OnceLock::new();
    ALL.get_or_init(|| {
        let one = UNARY.iter().filter(|row| is_identifier(row.name));
        let one = one.map(|row| (row.name, row.signature, row.doc, row.dimension));
        let two = BINARY.iter().filter(|row| !row.signature.is_empty());
        let two = two.map(|row| (row.name, row.signature, row.doc, row.dimension));
        let callable = one
            .chain(two)
            .map(|(name, signature, doc, rule)| FunctionInfo {
                name,
                signature,
                doc,
                dimension: rule.words(),
                is_linear: false,
            });
        callable.chain(FORMS.iter().copied()).collect()
    })
}

/// Whether a row's name can be called, and is no operator.
fn is_identifier(name: &str) -> bool {
    name.chars().all(|c| c.is_alphanumeric() || c == '_') && name != "not"
}

/// The function of a name.
pub fn find(name: &str) -> Option<&'static FunctionInfo> {
    static NAMED: LazyLock<HashMap<&str, &FunctionInfo, RandomState>> =
        LazyLock::new(|| functions().iter().rev().map(|f| (f.name, f)).collect());
    NAMED.get(name).copied()
}

/// The circle constant.
pub fn is_pi(name: &str) -> bool {
    matches!(name, "pi" | "π")
}

/// Whether a name belongs to the language.
pub fn is_reserved(name: &str) -> bool {
    is_pi(name) || find(name).is_some() || matches!(name, "then" | "else" | "and" | "or" | "not")
}
