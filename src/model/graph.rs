//! The program in static single assignment form, and its builder.
//!
//! Every operation refers to earlier ones, so one pass forward evaluates and one pass backward
//! differentiates. Equal operations are shared, constants are folded, and trivial algebra is done
//! while the graph is built.

use std::collections::HashMap;
use std::sync::Arc;

use super::Place;
use super::jet::Jet;
use super::operation::{self, Binary, Unary, binary_row, unary};
use super::syntax::Span;

/// Place of an operation in its graph.
pub type Id = u32;

/// One operation. Constants are held as bits so that operations can be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Op {
    /// An element of the input vector.
    Input(u32),
    Constant(u64),
    /// The unknown of the n-th `solve`; only while the graph is built.
    Unknown(u32),
    Unary(&'static Unary, Id),
    Binary(&'static Binary, Id, Id),
    /// A power with a constant exponent.
    Power(Id, u64),
    /// Condition, value if it holds, value if not.
    Select(Id, Id, Id),
    /// The root of the n-th implicit equation of the graph.
    Solve(u32),
}

/// An implicit equation F(y, p) = 0, to be solved for y.
#[derive(Debug, Clone)]
pub struct Implicit {
    pub start: Id,
    pub parameters: Vec<Id>,
    /// F, whose inputs are y and then the parameters, and whose only output is the residual.
    pub residual: Arc<Graph>,
}

/// How the user wrote an operation, for hints.
#[derive(Debug, Clone)]
pub struct Label {
    /// `ln(x - a)`
    pub call: Arc<str>,
    /// `x - a`: the argument or divisor.
    pub argument: Arc<str>,
    /// Where the call (the divisor, of a quotient) stands.
    pub place: Place,
    pub span: Span,
}

/// A table whose points are joined by straight lines, for hints.
#[derive(Debug, Clone)]
pub struct Table {
    pub result: Id,
    pub x: Id,
    /// Where the lines meet, and both ends; in rising order.
    pub knots: Vec<f64>,
    /// `interpolate(t, ts, ys)`
    pub call: Arc<str>,
    /// `t`
    pub argument: Arc<str>,
}

/// A program.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    pub ops: Vec<Op>,
    pub implicit: Vec<Implicit>,
    pub outputs: Vec<Id>,
    pub labels: HashMap<Id, Label>,
    pub tables: Vec<Table>,
}

impl Graph {
    /// Calls `visit` with every operand of an operation.
    pub fn operands(&self, op: Op, mut visit: impl FnMut(Id)) {
        match op {
            Op::Input(_) | Op::Constant(_) | Op::Unknown(_) => {}
            Op::Unary(_, a) | Op::Power(a, _) => visit(a),
            Op::Binary(_, a, b) => {
                visit(a);
                visit(b);
            }
            Op::Select(c, a, b) => {
                visit(c);
                visit(a);
                visit(b);
            }
            Op::Solve(n) => {
                let equation = &self.implicit[n as usize];
                visit(equation.start);
                equation.parameters.iter().for_each(|p| visit(*p));
            }
        }
    }

    /// The constant that an operation is, if it is one.
    pub fn constant(&self, id: Id) -> Option<f64> {
        match self.ops[id as usize] {
            Op::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Which operations the given ones need.
    fn needed(&self, outputs: &[Id]) -> Vec<bool> {
        let mut needed = vec![false; self.ops.len()];
        for id in outputs {
            needed[*id as usize] = true;
        }
        for (i, op) in self.ops.iter().enumerate().rev() {
            if needed[i] {
                self.operands(*op, |a| needed[a as usize] = true);
            }
        }
        needed
    }

    /// The places of the inputs that an operation depends on.
    pub fn inputs_of(&self, id: Id) -> impl Iterator<Item = usize> {
        let needed = self.needed(&[id]);
        let ops = self.ops.iter().zip(needed).filter(|(_, needed)| *needed);
        ops.filter_map(|(op, _)| match op {
            Op::Input(place) => Some(*place as usize),
            _ => None,
        })
    }

    /// Copies the operations marked `keep`; `replaced` says what stands for those that are not kept.
    fn copied(
        &self,
        keep: &[bool],
        mut replaced: HashMap<Id, Id>,
        mut out: Graph,
    ) -> (Graph, HashMap<Id, Id>) {
        for (i, op) in self.ops.iter().enumerate().filter(|(i, _)| keep[*i]) {
            let at = |id: Id| replaced[&id];
            let moved = match *op {
                Op::Input(_) | Op::Constant(_) | Op::Unknown(_) => *op,
                Op::Unary(row, a) => Op::Unary(row, at(a)),
                Op::Binary(row, a, b) => Op::Binary(row, at(a), at(b)),
                Op::Power(a, c) => Op::Power(at(a), c),
                Op::Select(c, a, b) => Op::Select(at(c), at(a), at(b)),
                Op::Solve(n) => {
                    let equation = &self.implicit[n as usize];
                    out.implicit.push(Implicit {
                        start: at(equation.start),
                        parameters: equation.parameters.iter().map(|p| at(*p)).collect(),
                        residual: Arc::clone(&equation.residual),
                    });
                    Op::Solve(out.implicit.len() as u32 - 1)
                }
            };
            let id = out.ops.len() as Id;
            out.ops.push(moved);
            if let Some(label) = self.labels.get(&(i as Id)) {
                out.labels.insert(id, label.clone());
            }
            replaced.insert(i as Id, id);
        }
        let moved = |table: &Table| {
            Some(Table {
                result: *replaced.get(&table.result)?,
                x: *replaced.get(&table.x)?,
                ..table.clone()
            })
        };
        out.tables.extend(self.tables.iter().filter_map(moved));
        (out, replaced)
    }
}

/// Builds a graph.
#[derive(Debug, Default)]
pub struct Builder {
    graph: Graph,
    known: HashMap<Op, Id>,
    unknowns: u32,
}

impl Builder {
    /// The constant that an operation was folded to.
    pub fn constant_at(&self, id: Id) -> Option<f64> {
        self.graph.constant(id)
    }

    pub fn constant(&mut self, value: f64) -> Id {
        self.push(Op::Constant(value.to_bits()))
    }

    pub fn input(&mut self, place: usize) -> Id {
        self.push(Op::Input(place as u32))
    }

    /// A new unknown.
    pub fn unknown(&mut self) -> Id {
        self.unknowns += 1;
        self.push(Op::Unknown(self.unknowns))
    }

    pub fn unary(&mut self, row: &'static Unary, a: Id) -> Id {
        if let Some(value) = self.constant_at(a) {
            return self.constant((row.scalar)(value));
        }
        match (row.name, self.graph.ops[a as usize]) {
            ("-", Op::Unary(inner, b)) if inner.name == "-" => b,
            _ => self.push(Op::Unary(row, a)),
        }
    }

    pub fn binary(&mut self, row: &'static Binary, a: Id, b: Id) -> Id {
        let (left, right) = (self.constant_at(a), self.constant_at(b));
        match (row.name, left, right) {
            (_, Some(x), Some(y)) => self.constant((row.scalar)(x, y)),
            ("+", Some(0.0), _) => b,
            ("+" | "-", _, Some(0.0)) => a,
            ("-", Some(0.0), _) => self.neg(b),
            ("*", Some(1.0), _) => b,
            ("*" | "/", _, Some(1.0)) => a,
            ("*", Some(-1.0), _) => self.neg(b),
            ("*" | "/", _, Some(-1.0)) => self.neg(a),
            ("*", _, _) if a == b => self.unary(row_of("^2"), a),
            // A sum or product is the same in either order; so are its bits.
            ("+" | "*", _, _) => self.push(Op::Binary(row, a.min(b), a.max(b))),
            ("^", _, Some(exponent)) => self.power(a, exponent),
            _ => self.push(Op::Binary(row, a, b)),
        }
    }

    /// a^exponent.
    pub fn power(&mut self, a: Id, exponent: f64) -> Id {
        if let Some(value) = self.constant_at(a) {
            return self.constant(libm::pow(value, exponent));
        }
        if exponent == 0.0 {
            self.constant(1.0)
        } else if exponent == 1.0 {
            a
        } else if exponent == 2.0 {
            self.unary(row_of("^2"), a)
        } else if exponent == 0.5 {
            self.unary(row_of("sqrt"), a)
        } else if exponent == -1.0 {
            let one = self.constant(1.0);
            self.div(one, a)
        } else {
            self.push(Op::Power(a, exponent.to_bits()))
        }
    }

    pub fn select(&mut self, condition: Id, yes: Id, no: Id) -> Id {
        match self.constant_at(condition) {
            Some(0.0) => no,
            Some(_) => yes,
            None if yes == no => yes,
            None => self.push(Op::Select(condition, yes, no)),
        }
    }

    pub fn neg(&mut self, a: Id) -> Id {
        self.unary(row_of("-"), a)
    }

    pub fn add(&mut self, a: Id, b: Id) -> Id {
        self.binary(row_of2("+"), a, b)
    }

    pub fn sub(&mut self, a: Id, b: Id) -> Id {
        self.binary(row_of2("-"), a, b)
    }

    pub fn mul(&mut self, a: Id, b: Id) -> Id {
        self.binary(row_of2("*"), a, b)
    }

    pub fn div(&mut self, a: Id, b: Id) -> Id {
        self.binary(row_of2("/"), a, b)
    }

    /// a·factor, by the operation that rounds once: a/1000 rather than a·0.001.
    pub fn scale(&mut self, a: Id, factor: f64) -> Id {
        let inverse = 1.0 / factor;
        if factor.fract() != 0.0 && inverse.fract() == 0.0 {
            let divisor = self.constant(inverse);
            self.div(a, divisor)
        } else {
            let factor = self.constant(factor);
            self.mul(a, factor)
        }
    }

    /// The root of residual = 0; `None` if the residual does not contain the unknown.
    pub fn solve(&mut self, unknown: Id, residual: Id, start: Id) -> Option<Id> {
        let graph = &self.graph;
        let needed = graph.needed(&[residual]);
        let mut moves = vec![false; graph.ops.len()];
        moves[unknown as usize] = true;
        for (i, op) in graph.ops.iter().enumerate() {
            graph.operands(*op, |a| moves[i] = moves[i] || moves[a as usize]);
        }
        if !moves[residual as usize] {
            return None;
        }
        // What does not depend on the unknown is computed once, outside; it becomes a parameter.
        let mut body = Graph {
            ops: vec![Op::Input(0)],
            ..Graph::default()
        };
        let mut replaced = HashMap::from([(unknown, 0)]);
        let mut parameters = Vec::new();
        for (_, op) in graph
            .ops
            .iter()
            .enumerate()
            .filter(|(i, _)| needed[*i] && moves[*i])
        {
            graph.operands(*op, |a| {
                if moves[a as usize] || replaced.contains_key(&a) {
                    return;
                }
                replaced.insert(a, body.ops.len() as Id);
                match graph.ops[a as usize] {
                    Op::Constant(bits) => body.ops.push(Op::Constant(bits)),
                    _ => {
                        parameters.push(a);
                        body.ops.push(Op::Input(parameters.len() as u32));
                    }
                }
            });
        }
        let keep: Vec<bool> = (0..graph.ops.len())
            .map(|i| needed[i] && moves[i] && i != unknown as usize)
            .collect();
        let (mut body, replaced) = graph.copied(&keep, replaced, body);
        body.outputs = vec![replaced[&residual]];
        self.graph.implicit.push(Implicit {
            start,
            parameters,
            residual: Arc::new(body),
        });
        let place = self.graph.implicit.len() as u32 - 1;
        Some(self.push(Op::Solve(place)))
    }

    /// Takes over one output of another graph, whose inputs stand at `places`; what it has in common
    /// with this graph is shared. Labels get the place that `relabel` gives them.
    pub fn embed(
        &mut self,
        other: &Graph,
        output: Id,
        places: &[usize],
        relabel: impl Fn(&Label) -> Label,
    ) -> Id {
        let needed = other.needed(&[output]);
        let mut moved: HashMap<Id, Id> = HashMap::new();
        for (i, op) in other.ops.iter().enumerate().filter(|(i, _)| needed[*i]) {
            let at = |id: Id| moved[&id];
            let op = match *op {
                Op::Input(place) => Op::Input(places[place as usize] as u32),
                Op::Constant(_) => *op,
                Op::Unknown(_) => {
                    self.unknowns += 1;
                    Op::Unknown(self.unknowns)
                }
                Op::Unary(row, a) => Op::Unary(row, at(a)),
                Op::Binary(row, a, b) if matches!(row.name, "+" | "*") => {
                    Op::Binary(row, at(a).min(at(b)), at(a).max(at(b)))
                }
                Op::Binary(row, a, b) => Op::Binary(row, at(a), at(b)),
                Op::Power(a, c) => Op::Power(at(a), c),
                Op::Select(c, a, b) => Op::Select(at(c), at(a), at(b)),
                Op::Solve(n) => {
                    let equation = &other.implicit[n as usize];
                    self.graph.implicit.push(Implicit {
                        start: at(equation.start),
                        parameters: equation.parameters.iter().map(|p| at(*p)).collect(),
                        residual: Arc::clone(&equation.residual),
                    });
                    Op::Solve(self.graph.implicit.len() as u32 - 1)
                }
            };
            let id = self.push(op);
            if let Some(label) = other.labels.get(&(i as Id)) {
                self.label(id, &relabel(label));
            }
            moved.insert(i as Id, id);
        }
        moved[&output]
    }

    /// Notes how the user wrote an operation.
    pub fn label(&mut self, id: Id, label: &Label) {
        self.graph.labels.entry(id).or_insert_with(|| label.clone());
    }

    /// Notes a table.
    pub fn table(&mut self, table: Table) {
        self.graph.tables.push(table);
    }

    /// The finished graph, without what the outputs do not need.
    pub fn finish(self, outputs: &[Id]) -> Graph {
        let keep = self.graph.needed(outputs);
        let (mut graph, replaced) = self.graph.copied(&keep, HashMap::new(), Graph::default());
        graph.outputs = outputs.iter().map(|id| replaced[id]).collect();
        graph
    }

    fn push(&mut self, op: Op) -> Id {
        let Builder { graph, known, .. } = self;
        *known.entry(op).or_insert_with(|| {
            graph.ops.push(op);
            graph.ops.len() as Id - 1
        })
    }
}

fn row_of(name: &str) -> &'static Unary {
    unary(name).expect("operators are in the table")
}

fn row_of2(name: &str) -> &'static Binary {
    binary_row(name).expect("operators are in the table")
}

impl Graph {
    /// Every operation's value at `inputs`.
    pub fn evaluate<const N: usize>(&self, inputs: &[Jet<N>]) -> Vec<Jet<N>> {
        let mut values = Vec::with_capacity(self.ops.len());
        self.evaluate_into(inputs, &mut values);
        values
    }

    /// As [`evaluate`](Self::evaluate), into a vector that is used again and again.
    pub fn evaluate_into<const N: usize>(&self, inputs: &[Jet<N>], values: &mut Vec<Jet<N>>) {
        values.clear();
        for op in &self.ops {
            let at = |id: Id| values[id as usize];
            let value = match *op {
                Op::Input(place) => inputs[place as usize],
                Op::Constant(bits) => Jet::constant(f64::from_bits(bits)),
                Op::Unknown(_) => Jet::constant(f64::NAN),
                Op::Unary(row, a) => row.value(at(a)),
                Op::Binary(row, a, b) => row.value(at(a), at(b)),
                Op::Power(a, c) => power_value(at(a), f64::from_bits(c)),
                Op::Select(c, a, b) => at(if at(c).value() != 0.0 { a } else { b }),
                Op::Solve(n) => {
                    let equation = &self.implicit[n as usize];
                    let parameters: Vec<Jet<N>> =
                        equation.parameters.iter().map(|p| at(*p)).collect();
                    super::implicit::root(
                        &equation.residual,
                        at(equation.start).value(),
                        &parameters,
                    )
                }
            };
            values.push(value);
        }
    }

    /// Derivatives of one operation with respect to all operations up to it, by one pass backward.
    pub fn adjoints<const N: usize>(&self, values: &[Jet<N>], of: Id) -> Vec<Jet<N>> {
        let zero = Jet::constant(0.0);
        let mut adjoints = vec![zero; of as usize + 1];
        adjoints[of as usize] = Jet::constant(1.0);
        for i in (0..=of as usize).rev() {
            let bar = adjoints[i];
            if bar.is_zero() {
                continue;
            }
            let at = |id: Id| values[id as usize];
            let mut pass = |id: Id, slope: Jet<N>| {
                // Where the slope is infinite but nothing moves, nothing is passed on.
                if !slope.is_zero() {
                    adjoints[id as usize] = adjoints[id as usize] + bar * slope;
                }
            };
            match self.ops[i] {
                Op::Input(_) | Op::Constant(_) | Op::Unknown(_) => {}
                Op::Unary(row, a) => pass(a, row.slope(at(a))),
                Op::Binary(row, a, b) => {
                    let (da, db) = row.slopes(at(a), at(b));
                    pass(a, da);
                    pass(b, db);
                }
                Op::Power(a, c) => {
                    let derivatives = operation::power(at(a).value(), f64::from_bits(c));
                    pass(a, at(a).compose(&derivatives[1..]));
                }
                Op::Select(c, a, b) => {
                    let chosen = if at(c).value() != 0.0 { a } else { b };
                    pass(chosen, Jet::constant(1.0));
                }
                Op::Solve(n) => {
                    let equation = &self.implicit[n as usize];
                    let parameters: Vec<Jet<N>> =
                        equation.parameters.iter().map(|p| at(*p)).collect();
                    let slopes =
                        super::implicit::slopes(&equation.residual, values[i], &parameters);
                    for (parameter, slope) in equation.parameters.iter().zip(slopes) {
                        pass(*parameter, slope);
                    }
                }
            }
        }
        adjoints
    }

    /// Derivatives of one operation with respect to the inputs.
    pub fn gradient<const N: usize>(
        &self,
        values: &[Jet<N>],
        of: Id,
        inputs: usize,
    ) -> Vec<Jet<N>> {
        let adjoints = self.adjoints(values, of);
        let mut gradient = vec![Jet::constant(0.0); inputs];
        for (op, adjoint) in self.ops.iter().zip(adjoints) {
            if let Op::Input(place) = op {
                gradient[*place as usize] = adjoint;
            }
        }
        gradient
    }
}

fn power_value<const N: usize>(x: Jet<N>, c: f64) -> Jet<N> {
    if N == 1 {
        return Jet::constant(libm::pow(x.value(), c));
    }
    x.compose(&operation::power(x.value(), c))
}
