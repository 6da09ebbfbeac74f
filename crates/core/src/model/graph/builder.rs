//! Building a graph: equal operations become one, operations on constants their value.

use std::collections::HashMap;
use std::sync::Arc;

use foldhash::fast::RandomState;

use super::{Graph, Id, Implicit, Label, Op, Table};
use crate::model::operation::{self, Binary, Rule, Unary, binary_row, unary};

/// Builds a graph.
#[derive(Debug, Default)]
pub struct Builder {
    graph: Graph,
    known: HashMap<Op, Id, RandomState>,
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
        match (row.rule, left, right) {
            (_, Some(x), Some(y)) => self.constant((row.scalar)(x, y)),
            (Rule::Add, Some(0.0), _) => b,
            (Rule::Add | Rule::Sub, _, Some(0.0)) => a,
            (Rule::Sub, Some(0.0), _) => self.neg(b),
            (Rule::Mul, Some(1.0), _) => b,
            (Rule::Mul | Rule::Div, _, Some(1.0)) => a,
            (Rule::Mul, Some(-1.0), _) => self.neg(b),
            (Rule::Mul | Rule::Div, _, Some(-1.0)) => self.neg(a),
            (Rule::Mul, _, _) if a == b => self.unary(row_of("^2"), a),
            // A sum or product is the same in either order; so are its bits.
            (Rule::Add | Rule::Mul, _, _) => self.push(Op::Binary(row, a.min(b), a.max(b))),
            (Rule::Pow, _, Some(exponent)) => self.power(a, exponent),
            _ => self.push(Op::Binary(row, a, b)),
        }
    }

    /// a^exponent.
    pub fn power(&mut self, a: Id, exponent: f64) -> Id {
        if let Some(value) = self.constant_at(a) {
            return self.constant(operation::power(value, exponent));
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
        let mut replaced = vec![None; graph.ops.len()];
        replaced[unknown as usize] = Some(0);
        let mut parameters = Vec::new();
        for (_, op) in graph
            .ops
            .iter()
            .enumerate()
            .filter(|(i, _)| needed[*i] && moves[*i])
        {
            graph.operands(*op, |a| {
                if moves[a as usize] || replaced[a as usize].is_some() {
                    return;
                }
                replaced[a as usize] = Some(body.ops.len() as Id);
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
        body.outputs = vec![replaced[residual as usize]?];
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
        let mut moved: Vec<Id> = vec![0; other.ops.len()];
        for (i, op) in other.ops.iter().enumerate().filter(|(i, _)| needed[*i]) {
            let at = |id: Id| moved[id as usize];
            let op = match *op {
                Op::Input(place) => Op::Input(places[place as usize] as u32),
                Op::Unknown(_) => {
                    self.unknowns += 1;
                    Op::Unknown(self.unknowns)
                }
                Op::Binary(row, a, b) if matches!(row.rule, Rule::Add | Rule::Mul) => {
                    Op::Binary(row, at(a).min(at(b)), at(a).max(at(b)))
                }
                op => other.moved(op, at, &mut self.graph),
            };
            let id = self.push(op);
            if let Some(label) = other.labels.get(&(i as Id)) {
                self.label(id, &relabel(label));
            }
            moved[i] = id;
        }
        let tables = other
            .tables
            .iter()
            .filter(|table| needed[table.result as usize]);
        self.graph.tables.extend(tables.map(|table| Table {
            result: moved[table.result as usize],
            x: moved[table.x as usize],
            ..table.clone()
        }));
        moved[output as usize]
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
        let replaced = vec![None; keep.len()];
        let (mut graph, replaced) = self.graph.copied(&keep, replaced, Graph::default());
        let outputs = outputs.iter().filter_map(|id| replaced[*id as usize]);
        graph.outputs = outputs.collect();
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
