//! The list of all functions, for calls, suggestions and the help.

use super::operation::{BINARY, UNARY};

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
}

const SAME: &str = "gives the unit of the elements, which must be of one dimension";

/// Reductions and special forms.
#[rustfmt::skip] // A table reads by lines.
const FORMS: &[FunctionInfo] = &[
    form("mean", "mean(x)", "arithmetic mean of the elements", SAME),
    form("sum", "sum(x)", "sum of the elements", SAME),
    form("prod", "prod(x)", "product of the elements", "gives the product of the units"),
    form("dot", "dot(x, y)", "sum of the products of corresponding elements", "gives the product of the units"),
    form("norm", "norm(x)", "square root of the sum of the squared elements", SAME),
    form("median", "median(x)", "middle element in order of size, or the mean of the middle two", SAME),
    form("sd", "sd(x)", "experimental standard deviation of the elements (divisor n - 1)", "gives the unit of differences between elements"),
    form("len", "len(x)", "number of elements", "gives a number"),
    form("slope", "slope(x, y)", "slope of the least-squares line y = a + b x", "gives the unit of y divided by that of x"),
    form("intercept", "intercept(x, y)", "value at x = 0 of the least-squares line y = a + b x", "gives the unit of y"),
    form("slope_through_origin", "slope_through_origin(x, y)", "slope of the least-squares line y = b x", "gives the unit of y divided by that of x"),
    form("pow", "pow(x, n)", "power, as x^n", "gives the power of the unit; n is a constant simple fraction unless x is a number"),
    form("kelvin", "kelvin(T)", "thermodynamic temperature of a temperature in °C or °F", "gives K"),
    form("value_in", "value_in(x, 'unit')", "the number of x in the stated unit", "gives a number"),
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
            });
        callable.chain(FORMS.iter().copied()).collect()
    })
}

/// Whether a row's name can be called, and is no operator.
fn is_identifier(name: &str) -> bool {
    name.chars().all(char::is_alphanumeric) && name != "not"
}

/// The function of a name.
pub fn find(name: &str) -> Option<&'static FunctionInfo> {
    functions().iter().find(|f| f.name == name)
}

/// The circle constant.
pub fn is_pi(name: &str) -> bool {
    matches!(name, "pi" | "π")
}

/// Whether a name belongs to the language.
pub fn is_reserved(name: &str) -> bool {
    is_pi(name) || find(name).is_some() || matches!(name, "then" | "else" | "and" | "or" | "not")
}
