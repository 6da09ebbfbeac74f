//! What a reader must know about a model at a point: kinks, steps, poles near by.

use super::faults::UNDEFINED;
use super::graph::{Graph, Id, Label, Op};
use super::jet::Jet;
use super::operation::Smoothness;
use super::{ModelFault, Place};
use crate::fault::Fault;

/// Operations whose derivative does not exist or hides something here, in words.
pub fn irregularities(graph: &Graph, x: &[f64]) -> Vec<String> {
    let mut found = Vec::new();
    collect_irregularities(graph, x, &mut found);
    found
}

fn collect_irregularities(graph: &Graph, x: &[f64], found: &mut Vec<String>) {
    let inputs: Vec<Jet<1>> = x.iter().map(|v| Jet::constant(*v)).collect();
    let values = graph.evaluate(&inputs);
    let at = |id: Id| values[id as usize].value();
    let (active, moving) = (active(graph, &values), moving(graph));
    for (i, op) in graph
        .ops
        .iter()
        .enumerate()
        .filter(|(i, _)| active[*i] && moving[*i])
    {
        if let Op::Solve(n) = *op {
            let equation = &graph.implicit[n as usize];
            let inner: Vec<f64> = std::iter::once(at(i as Id))
                .chain(equation.parameters.iter().map(|p| at(*p)))
                .collect();
            collect_irregularities(&equation.residual, &inner, found);
        }
        let Some(label) = graph.labels.get(&(i as Id)) else {
            continue;
        };
        let (call, argument) = (&label.call, &label.argument);
        let words = match *op {
            Op::Unary(row, _) if row.smoothness == Smoothness::Steps => {
                format!("{call} is a step function: its derivative is 0 although it jumps")
            }
            Op::Unary(row, a) if row.smoothness == Smoothness::Corner && at(a) == 0.0 => {
                format!("{call} has a kink where {argument} is 0, which is just here")
            }
            Op::Binary(row, a, b) if row.smoothness == Smoothness::Corner && at(a) == at(b) => {
                match row.name {
                    "min" | "max" => format!(
                        "{call} has a kink where two arguments are equal, which is just here"
                    ),
                    _ => format!("the condition {call} changes just here"),
                }
            }
            Op::Binary(row, a, b)
                if row.smoothness == Smoothness::Branch && at(a) == 0.0 && at(b) <= 0.0 =>
            {
                format!("{call} jumps from -π to π just here")
            }
            _ => continue,
        };
        if !found.contains(&words) {
            found.push(words);
        }
    }
}

/// Measurands without a finite value here: the first operation whose operands are finite and whose
/// result is not, where the user wrote it.
pub fn undefined<'a>(
    graph: &Graph,
    x: &[f64],
    names: impl Iterator<Item = &'a str>,
) -> Vec<ModelFault> {
    let inputs: Vec<Jet<1>> = x.iter().map(|v| Jet::constant(*v)).collect();
    let values = graph.evaluate(&inputs);
    let mut found: Vec<ModelFault> = Vec::new();
    for (index, (output, name)) in graph.outputs.iter().zip(names).enumerate() {
        if values[*output as usize].value().is_finite() {
            continue;
        }
        let blamed =
            culprit(graph, &values, *output).and_then(|id| Some((id, graph.labels.get(&id)?)));
        let (place, span, why, label) = match blamed {
            Some((id, label)) => {
                let (why, short) = reason(graph, &values, id, label);
                (label.place, label.span.clone(), why, short)
            }
            None => (
                Place::Entry(index),
                0..0,
                "an intermediate result is too large or is no number".to_string(),
                "no finite value".to_string(),
            ),
        };
        let fault = Fault::new(
            UNDEFINED,
            span,
            format!("{name} has no value at the estimates of its inputs: {why}"),
        )
        .label(label)
        .help("check the estimates and the formula");
        found.push(ModelFault { place, fault });
    }
    found
}

/// Goes from a result that is not finite to the operation that first made it so.
fn culprit(graph: &Graph, values: &[Jet<1>], output: Id) -> Option<Id> {
    let mut at = output;
    loop {
        let mut next = None;
        let op = graph.ops[at as usize];
        let mut consider = |id: Id| {
            if next.is_none() && !values[id as usize].value().is_finite() {
                next = Some(id);
            }
        };
        match op {
            // The branch that is not taken is not to blame.
            Op::Select(c, a, b) => {
                consider(c);
                consider(if values[c as usize].value() != 0.0 {
                    a
                } else {
                    b
                });
            }
            _ => graph.operands(op, consider),
        }
        match next {
            Some(id) => at = id,
            None => return Some(at),
        }
    }
}

/// Why an operation with finite operands has no finite result, and in short for the marked place.
fn reason(graph: &Graph, values: &[Jet<1>], id: Id, label: &Label) -> (String, String) {
    let at = |id: Id| values[id as usize].value();
    let (call, argument) = (&label.call, &label.argument);
    match graph.ops[id as usize] {
        Op::Solve(_) => (
            format!("the search for `{argument}` from its starting value finds no solution"),
            "no solution found".to_string(),
        ),
        Op::Binary(row, _, b) if row.name == "/" && at(b) == 0.0 => {
            (format!("the divisor `{argument}` is 0"), "is 0".to_string())
        }
        Op::Unary(_, a) | Op::Power(a, _) => (
            format!(
                "`{call}` has no finite value where `{argument}` is {}",
                shown(at(a))
            ),
            format!("`{argument}` is {} here", shown(at(a))),
        ),
        _ => (
            format!("`{call}` has no finite value"),
            "not finite".to_string(),
        ),
    }
}

/// Divisors and arguments within `reach` standard uncertainties of a pole or the end of a domain.
pub fn near_singular(graph: &Graph, x: &[f64], u: &[f64], reach: f64) -> Vec<String> {
    let inputs: Vec<Jet<1>> = x.iter().map(|v| Jet::constant(*v)).collect();
    let values = graph.evaluate(&inputs);
    let (active, moving) = (active(graph, &values), moving(graph));
    let mut nearest: Vec<(String, f64, f64)> = Vec::new();
    for (i, op) in graph.ops.iter().enumerate().filter(|(i, _)| active[*i]) {
        let (Some((id, edge, role)), Some(label)) =
            (edge(graph, *op, &values), graph.labels.get(&(i as Id)))
        else {
            continue;
        };
        if !moving[id as usize] {
            continue;
        }
        let gradient = graph.gradient(&values, id, x.len());
        let variance: f64 = gradient
            .iter()
            .zip(u)
            .map(|(c, u)| (c.value() * u).powi(2))
            .sum();
        let distance = (values[id as usize].value() - edge).abs() / variance.sqrt();
        if distance > reach || distance.is_nan() {
            continue;
        }
        let what = format!("{} ({role})", label.argument);
        match nearest
            .iter_mut()
            .find(|(known, _, e)| *known == what && *e == edge)
        {
            Some((_, least, _)) => *least = least.min(distance),
            None => nearest.push((what, distance, edge)),
        }
    }
    nearest
        .into_iter()
        .map(|(what, distance, edge)| format!("{what} is {distance:.1} u from {}", shown(edge)))
        .collect()
}

fn shown(edge: f64) -> String {
    if edge.fract() == 0.0 {
        format!("{edge}")
    } else {
        format!("{edge:.4}")
    }
}

/// The operand of an operation that must keep away from a pole or edge, that edge, and its role.
fn edge(graph: &Graph, op: Op, values: &[Jet<1>]) -> Option<(Id, f64, String)> {
    match op {
        Op::Unary(row, a) => {
            let edge = row.edge?(values[a as usize].value());
            Some((a, edge, format!("argument of {}", row.name)))
        }
        Op::Binary(row, _, b) if row.name == "/" => Some((b, 0.0, "divisor".to_string())),
        Op::Binary(row, a, b) if row.name == "^" && graph.constant(b).is_none() => {
            Some((a, 0.0, "base of a power".to_string()))
        }
        Op::Power(a, bits) => {
            let c = f64::from_bits(bits);
            (c < 0.0 || c.fract() != 0.0).then(|| (a, 0.0, "base of a power".to_string()))
        }
        _ => None,
    }
}

/// Which operations the outputs depend on when conditions are as they are here.
fn active(graph: &Graph, values: &[Jet<1>]) -> Vec<bool> {
    let mut active = vec![false; graph.ops.len()];
    graph
        .outputs
        .iter()
        .for_each(|id| active[*id as usize] = true);
    for (i, op) in graph
        .ops
        .iter()
        .enumerate()
        .rev()
        .filter(|(_, op)| !matches!(op, Op::Input(_)))
    {
        if !active[i] {
            continue;
        }
        if let Op::Select(c, a, b) = *op {
            active[c as usize] = true;
            active[if values[c as usize].value() != 0.0 {
                a
            } else {
                b
            } as usize] = true;
        } else {
            graph.operands(*op, |a| active[a as usize] = true);
        }
    }
    active
}

/// Which operations depend on an input.
fn moving(graph: &Graph) -> Vec<bool> {
    let mut moving = vec![false; graph.ops.len()];
    for (i, op) in graph.ops.iter().enumerate() {
        let mut moves = matches!(op, Op::Input(_));
        graph.operands(*op, |a| moves |= moving[a as usize]);
        moving[i] = moves;
    }
    moving
}
