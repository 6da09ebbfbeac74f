//! Functions of exactly known numbers: quantiles of distributions with parameters, the gamma function.

use super::catalogue::FunctionInfo;
use super::faults;
use super::lower::{Ids, Lowering, Value, wrong_count};
use super::printer;
use super::syntax::Expr;
use super::units::Operand;
use crate::quantity::Unit;
use crate::special;
use gumption_fault::{Fault, say};

/// A function of exactly known numbers.
struct Row {
    name: &'static str,
    arguments: usize,
    value: fn(&[f64]) -> f64,
    /// Where it has values.
    domain: &'static str,
}

#[rustfmt::skip] // A table reads by lines.
const ROWS: &[Row] = &[
    Row { name: "t_quantile", arguments: 2, value: |a| special::student_t_quantile(a[0], a[1]), domain: "0 < p < 1 and nu > 0" },
    Row { name: "chi_squared_quantile", arguments: 2, value: |a| special::chi_squared_quantile(a[0], a[1]), domain: "0 < p < 1 and nu > 0" },
    Row { name: "f_quantile", arguments: 3, value: |a| special::f_quantile(a[0], a[1], a[2]), domain: "0 < p < 1, nu1 > 0 and nu2 > 0" },
    Row { name: "gamma_function", arguments: 1, value: |a| special::gamma(a[0]), domain: "x > 0, up to 171" },
    Row { name: "ln_gamma", arguments: 1, value: |a| special::ln_gamma(a[0]), domain: "x > 0" },
];

/// Whether a function takes exactly known numbers only.
pub fn takes(name: &str) -> bool {
    ROWS.iter().any(|row| row.name == name)
}

/// A call of a function of exactly known numbers, element by element.
pub fn call(
    l: &mut Lowering<'_>,
    e: &Expr,
    info: &FunctionInfo,
    arguments: &[Expr],
) -> Option<Value> {
    let row = ROWS.iter().find(|row| row.name == info.name)?;
    if arguments.len() != row.arguments {
        return wrong_count(l, e, info.name, info.signature, arguments);
    }
    let values: Vec<Option<Value>> = arguments.iter().map(|a| pure(l, row.name, a)).collect();
    let values: Option<Vec<Value>> = values.into_iter().collect();
    let values = values?;
    let len = l.common_length(&values.iter().collect::<Vec<_>>(), &e.span)?;
    l.spend(len * 100, &e.span).then_some(())?;
    let columns: Vec<Option<Vec<f64>>> = values
        .iter()
        .zip(arguments)
        .map(|(value, expr)| numbers(l, row.name, expr, value))
        .collect();
    let columns: Option<Vec<Vec<f64>>> = columns.into_iter().collect();
    let columns = columns?;
    let mut elements = Ids::with_capacity(len);
    for i in 0..len {
        let at: Vec<f64> = columns
            .iter()
            .map(|column| column[i.min(column.len() - 1)])
            .collect();
        let value = (row.value)(&at);
        if !value.is_finite() {
            let list: Vec<String> = at.iter().map(f64::to_string).collect();
            let list = list.join(", ");
            l.report(
                Fault::new(
                    faults::UNDEFINED,
                    e.span.clone(),
                    say!("{}({list}) has no value", row.name),
                )
                .label(say!("expected {}", row.domain))
                .help(say!("check the arguments and their order")),
            );
            return None;
        }
        elements.push(l.builder.constant(value));
    }
    let first = elements[0];
    Some(Value {
        elements,
        vector: values.iter().any(|v| v.vector),
        ..Value::scalar(first, Unit::one())
    })
}

/// An argument as a pure number or vector of them.
fn pure(l: &mut Lowering<'_>, function: &str, e: &Expr) -> Option<Value> {
    let value = l.value(e)?;
    l.number(
        Operand {
            value: &value,
            expr: e,
        },
        say!("`{function}`"),
    )
}

/// An argument that is one exactly known number.
pub fn number(l: &mut Lowering<'_>, function: &str, e: &Expr) -> Option<f64> {
    let value = l.scalar(e)?;
    let value = l.number(
        Operand {
            value: &value,
            expr: e,
        },
        say!("`{function}`"),
    )?;
    numbers(l, function, e, &value)?.first().copied()
}

/// The numbers of an argument that must be exactly known.
pub fn numbers(l: &mut Lowering<'_>, function: &str, e: &Expr, value: &Value) -> Option<Vec<f64>> {
    let known: Option<Vec<f64>> = value
        .elements
        .iter()
        .map(|id| l.builder.constant_at(*id))
        .collect();
    if known.is_none() {
        let text = printer::expression(e);
        l.report(
            Fault::new(
                faults::NOT_EXACT,
                e.span.clone(),
                say!(
                    "`{function}` needs exactly known numbers here, but `{text}` depends on inputs"
                ),
            )
            .label(say!("not exactly known"))
            .help(say!("state it under [constant], or write the number")),
        );
    }
    known
}
