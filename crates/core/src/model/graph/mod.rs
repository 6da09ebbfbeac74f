//! The program in static single assignment form, and its builder.
//!
//! Every operation refers to earlier ones, so one pass forward evaluates and one pass backward
//! differentiates. Equal operations are shared, constants are folded, and trivial algebra is done
//! while the graph is built.

mod builder;
mod evaluate;

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::Arc;

use crate::model::Place;
use crate::model::operation::{Binary, Unary, binary_row, unary};
use crate::model::syntax::Span;

pub use builder::Builder;

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
    pub fn needed(&self, outputs: &[Id]) -> Vec<bool> {
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
        mut replaced: Vec<Option<Id>>,
        mut out: Graph,
    ) -> (Graph, Vec<Option<Id>>) {
        for (i, op) in self.ops.iter().enumerate().filter(|(i, _)| keep[*i]) {
            let moved = self.moved(
                *op,
                |id| replaced[id as usize].expect("operands are kept or replaced"),
                &mut out,
            );
            let id = out.ops.len() as Id;
            out.ops.push(moved);
            if let Some(label) = self.labels.get(&(i as Id)) {
                out.labels.insert(id, label.clone());
            }
            replaced[i] = Some(id);
        }
        let moved = |table: &Table| {
            Some(Table {
                result: replaced[table.result as usize]?,
                x: replaced[table.x as usize]?,
                ..table.clone()
            })
        };
        out.tables.extend(self.tables.iter().filter_map(moved));
        (out, replaced)
    }

    /// An operation with other operands; its equation, if it solves one, goes to `out`.
    fn moved(&self, op: Op, at: impl Fn(Id) -> Id, out: &mut Graph) -> Op {
        match op {
            Op::Input(_) | Op::Constant(_) | Op::Unknown(_) => op,
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
        }
    }

    /// The same outputs with the angles that `centres` has for some operations taken on the turn around these centres:
    /// θ − 2π·round((θ − centre)/2π).
    pub fn unrolled(&self, centres: &[(Id, f64)]) -> Option<Graph> {
        let [minus, times, over] = ["-", "*", "/"].map(binary_row);
        let (minus, times, over, round) = (minus?, times?, over?, unary("round")?);
        let mut out = Graph::default();
        let mut replaced: Vec<Id> = Vec::with_capacity(self.ops.len());
        for (i, op) in self.ops.iter().enumerate() {
            let moved = self.moved(*op, |id| replaced[id as usize], &mut out);
            let mut push = |op: Op| {
                out.ops.push(op);
                out.ops.len() as Id - 1
            };
            let angle = push(moved);
            let centre = centres.iter().find(|(id, _)| *id as usize == i);
            replaced.push(match centre {
                Some((_, centre)) => {
                    let constant = |x: f64| Op::Constant(x.to_bits());
                    let (centre, turn) = (push(constant(*centre)), push(constant(TAU)));
                    let away = push(Op::Binary(minus, angle, centre));
                    let turns = push(Op::Binary(over, away, turn));
                    let whole = push(Op::Unary(round, turns));
                    let back = push(Op::Binary(times, whole, turn));
                    push(Op::Binary(minus, angle, back))
                }
                None => angle,
            });
        }
        out.outputs = self
            .outputs
            .iter()
            .map(|id| replaced[*id as usize])
            .collect();
        Some(out)
    }

    /// The same output with some operations, in rising order, as further inputs: the output and then what these
    /// operations are made of. The new inputs have the places from `inputs` on.
    pub fn cut(&self, of: Id, intermediates: &[Id], inputs: usize) -> Graph {
        let mut out = Graph::default();
        let places = (0..intermediates.len()).map(|k| Op::Input((inputs + k) as u32));
        out.ops.extend(places);
        let mut replaced: Vec<Id> = vec![0; of as usize + 1];
        let mut made = Vec::with_capacity(intermediates.len());
        let needed = self.needed(&[of]);
        for id in (0..=of).filter(|id| needed[*id as usize]) {
            let at = |operand: Id| replaced[operand as usize];
            let moved = self.moved(self.ops[id as usize], at, &mut out);
            let mut place = out.ops.len() as Id;
            out.ops.push(moved);
            if let Ok(intermediate) = intermediates.binary_search(&id) {
                made.push(place);
                place = intermediate as Id;
            }
            replaced[id as usize] = place;
        }
        out.outputs.push(replaced[of as usize]);
        out.outputs.append(&mut made);
        out
    }
}
