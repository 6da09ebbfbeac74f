//! The power under which alone an input stands: 0.45 of U in sqrt(A + B*U^0.45).

use super::graph::{Graph, Id, Op};

/// How an operation depends on an input.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Dependence {
    None,
    /// In proportion to this power of it.
    Proportional(f64),
    /// By a function of this power of it.
    Through(f64),
    /// Otherwise, or not known to.
    Other,
}

use Dependence::{Other, Proportional, Through};

/// The power through which alone an output depends on an input; whether it is in proportion to that.
pub fn of(graph: &Graph, output: usize, input: usize) -> Option<(f64, bool)> {
    let mut known: Vec<Dependence> = Vec::with_capacity(graph.ops.len());
    for op in &graph.ops {
        let at = |id: Id| known[id as usize];
        let dependence = match *op {
            Op::Input(place) if place as usize == input => Proportional(1.0),
            Op::Unary(row, a) => at(a).raised(power_of(row.name)),
            Op::Power(a, exponent) => at(a).raised(Some(f64::from_bits(exponent))),
            Op::Binary(row, a, b) => match row.name {
                "*" => at(a).times(at(b), 1.0),
                "/" => at(a).times(at(b), -1.0),
                _ => at(a).beside(at(b)),
            },
            _ => {
                let mut all = Dependence::None;
                graph.operands(*op, |a| all = all.beside(at(a)));
                all
            }
        };
        known.push(dependence);
    }
    match known[*graph.outputs.get(output)? as usize] {
        Proportional(exponent) => Some((exponent, true)),
        Through(exponent) => Some((exponent, false)),
        Dependence::None | Other => None,
    }
}

/// The exponent of a function that is a power.
fn power_of(name: &str) -> Option<f64> {
    match name {
        "-" => Some(1.0),
        "^2" => Some(2.0),
        "sqrt" => Some(0.5),
        "cbrt" => Some(1.0 / 3.0),
        _ => None,
    }
}

impl Dependence {
    /// Of a power, or of any other function.
    fn raised(self, exponent: Option<f64>) -> Dependence {
        match (self, exponent) {
            (Proportional(own), Some(exponent)) => Proportional(own * exponent),
            _ => self.beside(Dependence::None),
        }
    }

    /// Of a product with a power of another operation.
    fn times(self, other: Dependence, exponent: f64) -> Dependence {
        match (self, other.raised(Some(exponent))) {
            (Proportional(a), Proportional(b)) => Proportional(a + b),
            (Proportional(a), Dependence::None) | (Dependence::None, Proportional(a)) => {
                Proportional(a)
            }
            (own, other) => own.beside(other),
        }
    }

    /// Of any function of two operations.
    fn beside(self, other: Dependence) -> Dependence {
        let power = |one: Dependence| match one {
            Proportional(exponent) | Through(exponent) => Some(exponent),
            Dependence::None | Other => None,
        };
        match (self, other) {
            (Dependence::None, Dependence::None) => Dependence::None,
            (Other, _) | (_, Other) => Other,
            (own, other) => match (power(own), power(other)) {
                (Some(a), Some(b)) if a != b => Other,
                (a, b) => a.or(b).map_or(Other, Through),
            },
        }
    }
}
