//! How far the arithmetic knows a value: the model once in twice the precision, with the error that each operation
//! may add.
//!
//! Estimates and constants are the decimals of the file. What one operation does to them is exact to 31 digits for the
//! four operations, whole powers and roots, and to 16 for all other functions; the errors are carried on by the
//! slopes (see [`gumption_lanes::twice`], which has the four operations).

use super::graph::{Graph, Op};
use super::implicit;
use super::jet::Jet;
use super::operation::{self, Binary, DimensionRule, Rule, Unary};
use crate::dd::Dd;
use gumption_lanes::twice::{self, Known, ROUNDING, ROUNDING_TWICE};

/// What the arithmetic knows of an output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolved {
    /// The value by twice the precision.
    pub value: f64,
    /// How far it may be off.
    pub error: f64,
    /// How far the value by doubles may be off, as the trials of Monte Carlo and the derivatives are.
    pub error_of_doubles: f64,
}

/// Whole exponents up to here are products.
const PRODUCTS: f64 = 64.0;

/// The decimal that a double was read from, where its digits leave no other; of a longer one the double may have dropped half a
/// unit in its last place.
pub(super) fn decimal(x: f64) -> Known {
    let half = ROUNDING * x.abs();
    let of = |value: Dd, error: f64, doubles: f64| Known {
        value: value.into(),
        error,
        doubles,
    };
    if x.fract() == 0.0 && x.abs() < 1.0 / f64::EPSILON {
        return of(Dd::from(x), 0.0, 0.0);
    }
    if x == std::f64::consts::PI {
        // π and the double next to it.
        return of(
            Dd::from(x) + Dd::from(1.224_646_799_147_353_2e-16),
            0.0,
            half,
        );
    }
    if let Some(value) = twice::short_decimal(x) {
        return Known {
            value,
            error: 0.0,
            doubles: half,
        };
    }
    if twice::is_long(x) {
        return of(Dd::from(x), half, half);
    }
    // Very large and very small ones.
    let text = format!("{x:e}");
    let error = if is_short(&text) { 0.0 } else { half };
    let doubles = if x.fract() == 0.0 { 0.0 } else { half };
    of(Dd::nearest(x, &text), error, doubles)
}

/// The value of an operation on operands with these slopes; it adds `rounding`, relative to the value.
fn of(value: Dd, rounding: f64, operands: &[(Known, f64)]) -> Known {
    let size = value.value().abs();
    let carried = |error: fn(&Known) -> f64| -> f64 {
        let moved = |(operand, slope): &(Known, f64)| match error(operand) {
            0.0 => 0.0,
            error => error * slope.abs(),
        };
        operands.iter().map(moved).sum()
    };
    Known {
        value: value.into(),
        error: carried(|known| known.error) + rounding * size,
        doubles: carried(|known| known.doubles) + ROUNDING * size,
    }
}

fn high(known: &Known) -> f64 {
    known.value[0]
}

fn jet(known: &Known) -> Jet<1> {
    Jet::constant(high(known))
}

/// Whether the shortest decimal of a double, as `{:e}` writes it, has at most 15 digits, or 16 that stand farther apart
/// than doubles do.
fn is_short(text: &str) -> bool {
    let digits = text
        .bytes()
        .take_while(|byte| *byte != b'e')
        .filter(u8::is_ascii_digit);
    match digits.count() {
        0..=15 => true,
        16 => {
            // 16 digits d.ddd: a unit of the last is 10⁻¹⁵ of the leading power of ten, a double's 2⁻⁵² of its own.
            let mantissa: f64 = text
                .split('e')
                .next()
                .and_then(|m| m.parse().ok())
                .unwrap_or(0.0);
            mantissa.abs() * f64::EPSILON < 1e-15
        }
        _ => false,
    }
}

/// What the arithmetic knows of the outputs of a graph at these estimates.
pub fn resolved(graph: &Graph, x: &[f64]) -> Vec<Resolved> {
    let known = run(graph, x.iter().map(|x| decimal(*x)).collect());
    let of = |id: &u32| {
        let known = known[*id as usize];
        Resolved {
            value: high(&known),
            error: known.error,
            error_of_doubles: known.doubles,
        }
    };
    graph.outputs.iter().map(of).collect()
}

/// How far the value of an output may be off: what each operation may add, carried on by all ways on which it reaches the output at
/// once, and not by each of them alone. Where they cancel, as in x/x, the digits that the decimal of x leaves open are in no doubt of
/// the output.
pub fn error_of(graph: &Graph, x: &[f64], output: usize) -> f64 {
    let of = graph.outputs[output];
    let inputs: Vec<Known> = x.iter().map(|x| decimal(*x)).collect();
    let all = run(graph, inputs.clone());
    let points: Vec<Jet<1>> = x.iter().map(|x| Jet::constant(*x)).collect();
    let adjoints = graph.adjoints(&graph.evaluate(&points), of);
    let certain = |id: u32| Known {
        error: 0.0,
        ..all[id as usize]
    };
    let added = graph.ops.iter().zip(&adjoints).map(|(op, adjoint)| {
        let own = step(graph, op, &inputs, certain).error;
        let carried = own * adjoint.value().abs();
        // What has no error adds none, whatever the slope.
        if own == 0.0 { 0.0 } else { carried }
    });
    // Each slope on the way is a double.
    let rounded = graph.ops.len() as f64 * ROUNDING * all[of as usize].error;
    added.sum::<f64>() + rounded
}

fn run(graph: &Graph, inputs: Vec<Known>) -> Vec<Known> {
    let mut all: Vec<Known> = Vec::with_capacity(graph.ops.len());
    for op in &graph.ops {
        let known = step(graph, op, &inputs, |id| all[id as usize]);
        all.push(known);
    }
    all
}

/// What is known of an operation on operands.
fn step(graph: &Graph, op: &Op, inputs: &[Known], at: impl Fn(u32) -> Known) -> Known {
    match *op {
        Op::Input(place) => inputs[place as usize],
        Op::Constant(bits) => decimal(f64::from_bits(bits)),
        Op::Unknown(_) => decimal(f64::NAN),
        Op::Unary(row, a) => unary(row, at(a)),
        Op::Binary(row, a, b) => binary(row, at(a), at(b)),
        Op::Power(a, c) => power(at(a), f64::from_bits(c)),
        Op::Select(c, a, b) => at(if high(&at(c)) != 0.0 { a } else { b }),
        Op::Solve(n) => {
            let equation = &graph.implicit[n as usize];
            let parameters: Vec<Known> = equation.parameters.iter().map(|p| at(*p)).collect();
            root(&equation.residual, high(&at(equation.start)), &parameters)
        }
    }
}

pub(super) fn unary(row: &Unary, a: Known) -> Known {
    let (value, slope) = (Dd::from(a.value), (row.derivatives)(high(&a))[1]);
    match row.name {
        "sqrt" => of(value.sqrt(), ROUNDING_TWICE, &[(a, slope)]),
        "abs" => of(value.abs(), 0.0, &[(a, slope)]),
        "-" => of(-value, 0.0, &[(a, slope)]),
        "^2" => of(value.squared(), ROUNDING_TWICE, &[(a, slope)]),
        _ => {
            let value = (row.scalar)(high(&a));
            of(moved(value, slope, a), 2.0 * ROUNDING, &[(a, slope)])
        }
    }
}

/// The value of a function beside the double at which it was taken.
fn moved(value: f64, slope: f64, at: Known) -> Dd {
    let rest = (Dd::from(at.value) - high(&at).into()).value();
    let change = slope * rest;
    match change.is_finite() {
        true => Dd::from(value) + Dd::from(change),
        false => Dd::from(value),
    }
}

fn binary(row: &Binary, a: Known, b: Known) -> Known {
    let (x, y) = (high(&a), high(&b));
    match row.rule {
        Rule::Add => twice::sum(a, b),
        Rule::Sub => twice::difference(a, b),
        Rule::Mul => twice::product(a, b),
        Rule::Div => twice::quotient(a, b),
        Rule::Pick => {
            let chosen = (row.scalar)(x, y);
            match (chosen == x, chosen == y) {
                (true, false) => a,
                (false, true) => b,
                // Equal doubles may be different decimals.
                _ if (row.name == "min") == (Dd::from(a.value) < Dd::from(b.value)) => a,
                _ => b,
            }
        }
        // A comparison is one of the difference with zero.
        Rule::Constant if row.dimension == DimensionRule::Ratio => {
            let truth = (row.scalar)((Dd::from(a.value) - b.value.into()).value(), 0.0);
            of(Dd::from(truth), 0.0, &[])
        }
        _ => {
            let (da, db) = row.slopes(jet(&a), jet(&b));
            let (da, db) = (da.value(), db.value());
            let value = moved((row.scalar)(x, y), da, a) + moved(0.0, db, b);
            of(value, 2.0 * ROUNDING, &[(a, da), (b, db)])
        }
    }
}

pub(super) fn power(a: Known, c: f64) -> Known {
    let (twice, slope) = (
        Dd::from(a.value),
        operation::power_derivatives(high(&a), c)[1],
    );
    if c.fract() != 0.0 || c.abs() > PRODUCTS {
        let value = match c == 0.5 {
            true => return of(twice.sqrt(), ROUNDING_TWICE, &[(a, slope)]),
            false => operation::power(high(&a), c),
        };
        return of(moved(value, slope, a), 2.0 * ROUNDING, &[(a, slope)]);
    }
    let product = (0..c.abs() as u32).fold(Dd::ONE, |product, _| product * twice);
    let value = if c < 0.0 { Dd::ONE / product } else { product };
    of(value, (c.abs() + 1.0) * ROUNDING_TWICE, &[(a, slope)])
}

/// The root of an equation: as far off as doubles know the residual there, divided by its slope.
fn root(residual: &Graph, start: f64, parameters: &[Known]) -> Known {
    let jets: Vec<Jet<1>> = parameters.iter().map(jet).collect();
    let y = implicit::root(residual, start, &jets);
    let slopes = implicit::slopes(residual, y, &jets);
    let mut inputs = vec![Known {
        value: [y.value(), 0.0],
        error: 0.0,
        doubles: 0.0,
    }];
    inputs.extend_from_slice(parameters);
    let values: Vec<Jet<1>> = inputs.iter().map(jet).collect();
    let values = residual.evaluate(&values);
    let output = residual.outputs[0];
    let by_y = residual.gradient(&values, output, inputs.len())[0].value();
    let left = run(residual, inputs)[output as usize].doubles / by_y.abs();
    let operands: Vec<(Known, f64)> = parameters
        .iter()
        .copied()
        .zip(slopes.iter().map(|slope| slope.value()))
        .collect();
    let known = of(Dd::from(y.value()), ROUNDING, &operands);
    Known {
        error: known.error.max(left),
        doubles: known.doubles.max(left),
        ..known
    }
}

#[cfg(test)]
mod tests {
    use crate::model::tests::model;

    fn known(text: &str, x: &[f64]) -> super::Resolved {
        model("a b", text, "1").resolved(x)[0]
    }

    /// Expected values are sums of the decimals themselves.
    #[test]
    fn decimals_cancel_exactly() {
        let clock = known("a - b", &[1_700_000_000.123_456, 1_700_000_000.123_45]);
        assert_eq!(clock.value, 6e-6);
        assert!(clock.error < 1e-20 && clock.error_of_doubles > 1e-7);
        assert_eq!(known("(a + 1e16) - 1e16", &[0.1, 0.0]).value, 0.1);
        assert_eq!(known("a - b", &[10.0021, 10.0011]).value, 0.001);
        assert_eq!(
            known("a^2 - b^2", &[1.000_000_1, 1.0]).value,
            2.000_000_1e-7
        );
    }

    #[test]
    fn what_cancels_leaves_nothing_in_doubt() {
        for v in 1..600 {
            let x = [f64::from(v) / 7.0, 0.3];
            for (text, wanted) in [
                ("a / a", 1.0),
                ("a / (a + a)", 0.5),
                ("2 * a / a", 2.0),
                ("sin(a) / sin(a)", 1.0),
            ] {
                let model = model("a b", text, "1");
                let error = model.error_of(&x, 0);
                assert_eq!(model.resolved(&x)[0].value, wanted, "{text} of {}", x[0]);
                assert!(error < 1e-26, "{text} of {}: {error}", x[0]);
            }
        }
        // Where nothing cancels it is what the operations add one by one.
        let lost = |text: &str, x: &[f64]| {
            let model = model("a b", text, "1");
            model.error_of(x, 0) / model.resolved(x)[0].error
        };
        let all = [
            lost("exp(a) - exp(b)", &[30.0, 30.000_000_000_000_1]),
            lost("a - b", &[1.0 / 7.0, 1.0 / 9.0]),
            lost("a * b + 1", &[1.0 / 7.0, 1.0 / 9.0]),
        ];
        assert!(
            all.iter().all(|ratio| (ratio - 1.0).abs() < 1e-12),
            "{all:?}"
        );
    }

    #[test]
    fn what_functions_lose_is_told() {
        let near = known("exp(a) - exp(b)", &[30.0, 30.000_000_000_000_1]);
        assert!(near.error > 1e-4 * near.value.abs());
        let far = known("exp(a) - exp(b)", &[30.0, 20.0]);
        assert!(far.error < 1e-14 * far.value);
    }
}
