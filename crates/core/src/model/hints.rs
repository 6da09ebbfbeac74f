//! What a reader must know about a model at a point: kinks, steps, poles near by.

use std::f64::consts::PI;

use super::faults::UNDEFINED;
use super::graph::{Graph, Id, Label, Op};
use super::jet::Jet;
use super::notice::{Notice, Office, shown};
use super::operation::{Rule, Smoothness};
use super::{ModelFault, Output, Place};
use gumption_fault::{Fault, Said, say};

/// Whether every operation is smooth inside its domain.
pub fn smooth(graph: &Graph) -> bool {
    let is_smooth = |op: &Op| !is_rough(op) && !matches!(op, Op::Select(..));
    graph.ops.iter().all(is_smooth)
}

/// Whether a function has corners, steps or branches.
fn is_rough(op: &Op) -> bool {
    match op {
        Op::Unary(row, _) => row.smoothness != Smoothness::Smooth,
        Op::Binary(row, ..) => row.smoothness != Smoothness::Smooth,
        _ => false,
    }
}

/// Operations whose derivative does not exist or hides something here.
pub fn irregularities(graph: &Graph, x: &[f64]) -> Vec<Notice> {
    let mut found = Vec::new();
    let solves = graph.ops.iter().any(|op| matches!(op, Op::Solve(_)));
    if solves || !smooth(graph) || !graph.tables.is_empty() {
        collect_irregularities(graph, x, &mut found);
    }
    found
}

fn collect_irregularities(graph: &Graph, x: &[f64], found: &mut Vec<Notice>) {
    let inputs: Vec<Jet<1>> = x.iter().map(|v| Jet::constant(*v)).collect();
    let values = graph.evaluate(&inputs);
    let at = |id: Id| values[id as usize].value();
    let (active, moving) = (active(graph, &values), moving(graph));
    let mut told: Vec<Corner> = Vec::new();
    let mut is_new = |corner: Corner| {
        let new = !told.contains(&corner);
        told.push(corner);
        new
    };
    let mut note = |notice: Notice| {
        if !found.contains(&notice) {
            found.push(notice);
        }
    };
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
            let mut within = Vec::new();
            collect_irregularities(&equation.residual, &inner, &mut within);
            within.into_iter().for_each(&mut note);
        }
        let label = is_rough(op).then(|| graph.labels.get(&(i as Id)));
        let Some(label) = label.flatten() else {
            continue;
        };
        let (call, argument) = (label.call.to_string(), label.argument.to_string());
        note(match *op {
            Op::Unary(row, _) if row.smoothness == Smoothness::Steps => Notice::Steps { call },
            Op::Unary(row, a) if row.smoothness == Smoothness::Corner && at(a) == 0.0 => {
                match is_new(Corner::zero_of(graph, a)) {
                    true => Notice::Kink { call, argument },
                    false => continue,
                }
            }
            Op::Binary(row, a, b) if row.smoothness == Smoothness::Corner && at(a) == at(b) => {
                match row.name {
                    "min" | "max" if is_new(Corner::between(a, b)) => Notice::Tie { call },
                    "min" | "max" => continue,
                    _ => Notice::Condition { call },
                }
            }
            Op::Binary(row, a, b)
                if row.smoothness == Smoothness::Branch && at(a) == 0.0 && at(b) <= 0.0 =>
            {
                Notice::Jump { call }
            }
            _ => continue,
        });
    }
    let used = |id: Id| active[id as usize];
    for table in graph.tables.iter().filter(|table| used(table.result)) {
        let (call, argument) = (table.call.to_string(), table.argument.to_string());
        let (x, inner) = (at(table.x), table.knots.len() - 1);
        let ends = [table.knots[0], table.knots[inner]];
        if x < ends[0] || x > ends[1] {
            note(Notice::BeyondTable {
                call,
                argument,
                at: x,
                ends,
            });
        } else if moving[table.x as usize] && table.knots[1..inner].contains(&x) {
            note(Notice::Knot {
                call,
                argument,
                at: x,
            });
        }
    }
}

/// Measurands without a finite value here: the first operation whose operands are finite and whose
/// result is not, where the user wrote it.
pub fn undefined(graph: &Graph, x: &[f64], outputs: &[Output]) -> Vec<ModelFault> {
    let inputs: Vec<Jet<1>> = x.iter().map(|v| Jet::constant(*v)).collect();
    let values = graph.evaluate(&inputs);
    let mut found: Vec<ModelFault> = Vec::new();
    for (output, Output { name, source, .. }) in graph.outputs.iter().zip(outputs) {
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
                Place::Entry(*source),
                0..0,
                say!("an intermediate result is too large or is no number"),
                say!("no finite value"),
            ),
        };
        let fault = Fault::new(
            UNDEFINED,
            span,
            say!("{name} has no value at the estimates of its inputs: {why}"),
        )
        .label(label)
        .help(say!("check the estimates and the formula"));
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
fn reason(graph: &Graph, values: &[Jet<1>], id: Id, label: &Label) -> (Said, Said) {
    let at = |id: Id| values[id as usize].value();
    let (call, argument) = (&label.call, &label.argument);
    match graph.ops[id as usize] {
        Op::Solve(_) => (
            say!("the search for `{argument}` from its starting value finds no solution"),
            say!("no solution found"),
        ),
        Op::Binary(row, _, b) if row.name == "/" && at(b) == 0.0 => {
            (say!("the divisor `{argument}` is 0"), say!("is 0"))
        }
        Op::Unary(_, a) | Op::Power(a, _) => (
            say!(
                "`{call}` has no finite value where `{argument}` is {}",
                shown(at(a))
            ),
            say!("`{argument}` is {} here", shown(at(a))),
        ),
        _ => (say!("`{call}` has no finite value"), say!("not finite")),
    }
}

/// Quantities within `reach` standard uncertainties of a pole, of the end of a domain or of the jump of
/// a phase.
pub fn near_singular(graph: &Graph, x: &[f64], u: &[f64], reach: f64) -> Vec<Notice> {
    let spread = Spread::new(graph, x, u);
    let values = &spread.values;
    let (active, moving) = (active(graph, values), moving(graph));
    let mut nearest: Vec<Notice> = Vec::new();
    for (i, op) in graph.ops.iter().enumerate().filter(|(i, _)| active[*i]) {
        let Some(label) = graph.labels.get(&(i as Id)) else {
            continue;
        };
        let notice = if let Op::Binary(row, _, _) = op
            && row.smoothness == Smoothness::Branch
        {
            let left = PI - values[i].value().abs();
            let u = spread.u(i as Id);
            let call = label.call.to_string();
            match moving[i] {
                true if PI <= reach * u => Some(Notice::Filled { call, u }),
                // A phase that jumps just here is told of as such.
                true if left > 0.0 => Some(Notice::Wrap {
                    call,
                    distance: left / u,
                }),
                _ => None,
            }
        } else {
            edge(graph, *op, values)
                .filter(|(id, _, _)| moving[*id as usize])
                .map(|(id, edge, role)| Notice::Near {
                    argument: label.argument.to_string(),
                    role,
                    distance: (values[id as usize].value() - edge).abs() / spread.u(id),
                    edge,
                })
        };
        let Some(notice) = notice.filter(|notice| distance(notice) <= reach) else {
            continue;
        };
        match nearest.iter_mut().find(|known| is_same(known, &notice)) {
            Some(known) if distance(&notice) < distance(known) => *known = notice,
            Some(_) => {}
            None => nearest.push(notice),
        }
    }
    nearest
}

/// Phases within `reach` standard uncertainties of their jump, or on it, with their values.
pub fn phases_at_the_jump(graph: &Graph, x: &[f64], u: &[f64], reach: f64) -> Vec<(Id, f64)> {
    let phase = |op: &Op| matches!(op, Op::Binary(row, ..) if row.smoothness == Smoothness::Branch);
    if !graph.ops.iter().any(phase) {
        return Vec::new();
    }
    let spread = Spread::new(graph, x, u);
    let reached = |id: Id, value: f64| {
        let u = spread.u(id);
        u > 0.0 && value.is_finite() && PI - value.abs() <= reach * u
    };
    (0..graph.ops.len())
        .filter(|i| phase(&graph.ops[*i]))
        .map(|i| (i as Id, spread.values[i].value()))
        .filter(|(id, value)| reached(*id, *value))
        .collect()
}

/// Corners, conditions and steps that lie within `reach` standard uncertainties of the estimates, and not on them.
pub fn near_corners(graph: &Graph, x: &[f64], u: &[f64], reach: f64) -> Vec<Notice> {
    if smooth(graph) && graph.tables.is_empty() {
        return Vec::new();
    }
    let spread = Spread::new(graph, x, u);
    let at = |id: Id| spread.values[id as usize].value();
    let (active, moving) = (active(graph, &spread.values), moving(graph));
    let mut found: Vec<Notice> = Vec::new();
    let mut told: Vec<Corner> = Vec::new();
    let mut note = |call: &str, corner: Corner, away: f64, u: f64| {
        let distance = away.abs() / u;
        let known = |notice: &Notice| matches!(notice, Notice::Corner { call: c, .. } if c == call);
        let known = found.iter().any(known) || told.contains(&corner);
        if distance > 0.0 && distance <= reach && !known {
            let call = call.to_string();
            found.push(Notice::Corner { call, distance });
            told.push(corner);
        }
    };
    for (i, op) in graph.ops.iter().enumerate() {
        let label = graph.labels.get(&(i as Id));
        let Some(label) = label.filter(|_| active[i] && moving[i]) else {
            continue;
        };
        match *op {
            Op::Unary(row, a) if row.smoothness == Smoothness::Corner => {
                note(&label.call, Corner::zero_of(graph, a), at(a), spread.u(a));
            }
            Op::Unary(row, a) if row.smoothness == Smoothness::Steps => {
                // Steps lie at whole numbers, or half-way between them for `round`.
                let shift = if row.name == "round" { 0.5 } else { 0.0 };
                let from = at(a) - shift;
                let step = from.round();
                let corner = Corner::at(a, step + shift);
                note(&label.call, corner, from - step, spread.u(a));
            }
            Op::Binary(row, a, b) if row.smoothness == Smoothness::Corner => {
                let u = spread.u_of_difference(a, b);
                note(&label.call, Corner::between(a, b), at(a) - at(b), u);
            }
            _ => {}
        }
    }
    for table in graph
        .tables
        .iter()
        .filter(|table| active[table.result as usize])
    {
        let inner = &table.knots[1..table.knots.len() - 1];
        for knot in inner.iter().filter(|_| moving[table.x as usize]) {
            let corner = Corner::at(table.x, *knot);
            note(&table.call, corner, at(table.x) - knot, spread.u(table.x));
        }
    }
    found
}

/// Where functions have a corner, jump or step: one for all that share it, as max(a, b) and min(a, b) do.
#[derive(PartialEq, Eq)]
enum Corner {
    /// Two quantities are equal.
    Between(Id, Id),
    /// A quantity has a value, in bits.
    At(Id, u64),
}

impl Corner {
    fn between(a: Id, b: Id) -> Corner {
        Corner::Between(a.min(b), a.max(b))
    }

    /// Where a quantity is zero: a difference, where its parts are equal.
    fn zero_of(graph: &Graph, id: Id) -> Corner {
        match graph.ops[id as usize] {
            Op::Binary(row, a, b) if row.name == "-" => Corner::between(a, b),
            _ => Corner::at(id, 0.0),
        }
    }

    fn at(id: Id, value: f64) -> Corner {
        Corner::At(id, value.to_bits())
    }
}

fn distance(notice: &Notice) -> f64 {
    match notice {
        Notice::Near { distance, .. } | Notice::Wrap { distance, .. } => *distance,
        _ => 0.0,
    }
}

/// Whether two notices differ in the distance only.
fn is_same(a: &Notice, b: &Notice) -> bool {
    match (a, b) {
        (
            Notice::Near {
                argument: a,
                role: p,
                edge: e,
                ..
            },
            Notice::Near {
                argument: b,
                role: q,
                edge: f,
                ..
            },
        ) => a == b && p == q && e == f,
        (Notice::Wrap { call: a, .. }, Notice::Wrap { call: b, .. })
        | (Notice::Filled { call: a, .. }, Notice::Filled { call: b, .. }) => a == b,
        _ => false,
    }
}

/// Calls of `quantize` whose step exceeds the standard uncertainty of what is rounded: there the mean
/// slope of the staircase says nothing.
pub fn coarse_steps(graph: &Graph, x: &[f64], u: &[f64]) -> Vec<Notice> {
    let rounds = |op: &Op| matches!(op, Op::Binary(row, ..) if row.rule == Rule::Staircase);
    if !graph.ops.iter().any(rounds) {
        return Vec::new();
    }
    let spread = Spread::new(graph, x, u);
    let active = active(graph, &spread.values);
    let mut found = Vec::new();
    for (i, op) in graph.ops.iter().enumerate().filter(|(i, _)| active[*i]) {
        let Op::Binary(row, a, step) = op else {
            continue;
        };
        let label = (row.rule == Rule::Staircase).then(|| graph.labels.get(&(i as Id)));
        let Some(label) = label.flatten() else {
            continue;
        };
        let ratio = spread.values[*step as usize].value().abs() / spread.u(*a);
        if ratio > 1.0 && ratio.is_finite() {
            let call = label.call.to_string();
            found.push(Notice::CoarseStep { call, ratio });
        }
    }
    found
}

/// Values of all operations and their standard uncertainties, without covariances.
struct Spread<'a> {
    graph: &'a Graph,
    values: Vec<Jet<1>>,
    u: &'a [f64],
}

impl<'a> Spread<'a> {
    fn new(graph: &'a Graph, x: &[f64], u: &'a [f64]) -> Self {
        let inputs: Vec<Jet<1>> = x.iter().map(|v| Jet::constant(*v)).collect();
        Spread {
            graph,
            values: graph.evaluate(&inputs),
            u,
        }
    }

    fn u_of_difference(&self, a: Id, b: Id) -> f64 {
        let mut slopes = vec![0.0; self.u.len()];
        for (id, sign) in [(a, 1.0), (b, -1.0)] {
            for (place, slope) in self.graph.gradient_of_part(&self.values, id) {
                slopes[place] += sign * slope.value();
            }
        }
        let parts = slopes.iter().zip(self.u).map(|(slope, u)| slope * u);
        parts.fold(0.0, |sum: f64, part| sum + part * part).sqrt()
    }

    fn u(&self, id: Id) -> f64 {
        let gradient = self.graph.gradient_of_part(&self.values, id);
        let parts = gradient.iter().map(|(place, c)| c.value() * self.u[*place]);
        // The sum of no parts would be −0.
        parts.fold(0.0, |sum, part| sum + part * part).sqrt()
    }
}

/// The operand of an operation that must keep away from a pole or edge, that edge, and its role.
fn edge(graph: &Graph, op: Op, values: &[Jet<1>]) -> Option<(Id, f64, Office)> {
    match op {
        Op::Unary(row, a) => {
            let edge = row.edge?(values[a as usize].value());
            Some((a, edge, Office::Argument(row.name)))
        }
        Op::Binary(row, _, b) if row.name == "/" => Some((b, 0.0, Office::Divisor)),
        Op::Binary(row, a, b) if row.name == "^" && graph.constant(b).is_none() => {
            Some((a, 0.0, Office::Base))
        }
        Op::Power(a, bits) => {
            let c = f64::from_bits(bits);
            (c < 0.0 || c.fract() != 0.0).then_some((a, 0.0, Office::Base))
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
