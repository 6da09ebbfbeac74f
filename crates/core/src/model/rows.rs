//! Many points at once: values, first derivatives, what the arithmetic knows, and bounds of what lies beyond first order.
//!
//! Values and derivatives are those of [`Model::values`], [`Model::gradients`] and [`Model::resolved`], to the last bit:
//! each operation is the same, on 256 lanes or lane by lane.

use std::sync::Arc;

use gumption_lanes::bounds::{self, Bounds};
use gumption_lanes::twice::{self, Known, KnownBlock};
use gumption_lanes::{Block, LANES, Level, adjoint, level};

use super::Model;
use super::graph::{Graph, Id, Op};
use super::interaction;
use super::operation::{self, Rule, Smoothness};
use super::resolution;

/// Operations of the largest model that is taken: each has some 30 KB here.
const MOST_OPERATIONS: usize = 1024;

/// Evaluates a model at 256 points at once; owns the scratch memory.
#[derive(Debug)]
pub struct RowRunner {
    graph: Arc<Graph>,
    level: Level,
    values: Vec<Block>,
    /// First to third derivatives of functions of one argument.
    slopes: Vec<[Block; 3]>,
    adjoints: Vec<Block>,
    known: Vec<KnownBlock>,
    bounds: Vec<Bounds>,
    /// Whether an operation depends on an input.
    moves: Vec<bool>,
    /// Whether the operands of an operation have no input in common.
    apart: Vec<bool>,
    /// For each output the operations that it is a linear combination of, with the inputs of each.
    terms: Vec<Vec<(usize, Vec<usize>)>>,
    /// Marks the points that may be near a pole, or the end of a domain.
    doubt: Block,
}

impl RowRunner {
    /// `None` for a model with more than the four operations, powers and smooth functions of one argument.
    pub fn new(model: &Model) -> Option<Self> {
        let graph: &Graph = &model.graph;
        let plain = |op: &Op| match op {
            Op::Input(_) | Op::Constant(_) | Op::Power(..) => true,
            Op::Unary(row, _) => row.smoothness == Smoothness::Smooth && row.name != "not",
            Op::Binary(row, ..) => is_one_of_four(row.rule),
            Op::Unknown(_) | Op::Select(..) | Op::Solve(_) => false,
        };
        let count = graph.ops.len();
        if count > MOST_OPERATIONS || !graph.tables.is_empty() || !graph.ops.iter().all(plain) {
            return None;
        }
        let mut uses: Vec<Vec<u64>> = Vec::with_capacity(count);
        let mut apart = Vec::with_capacity(count);
        for op in &graph.ops {
            let mut own = vec![0u64; model.inputs.div_ceil(64)];
            if let Op::Input(place) = op {
                own[*place as usize / 64] |= 1 << (place % 64);
            }
            let mut separate = true;
            graph.operands(*op, |a| {
                for (own, more) in own.iter_mut().zip(&uses[a as usize]) {
                    separate &= *own & more == 0;
                    *own |= more;
                }
            });
            apart.push(separate);
            uses.push(own);
        }
        let inputs_of = |id: Id| {
            let own = &uses[id as usize];
            let uses = |place: &usize| own[place / 64] & (1 << (place % 64)) != 0;
            (id as usize, (0..model.inputs).filter(uses).collect())
        };
        let terms = graph.outputs.iter().map(|of| terms(graph, *of));
        let terms = terms.map(|terms| terms.into_iter().map(inputs_of).collect());
        let mut runner = RowRunner {
            terms: terms.collect(),
            graph: Arc::clone(&model.graph),
            level: level(),
            values: vec![Block::ZERO; count],
            slopes: vec![[Block::ZERO; 3]; count],
            adjoints: vec![Block::ZERO; count],
            known: vec![KnownBlock::ZERO; count],
            bounds: vec![Bounds::ZERO; count],
            moves: uses
                .iter()
                .map(|own| own.iter().any(|bits| *bits != 0))
                .collect(),
            apart,
            doubt: Block::ZERO,
        };
        for (id, op) in graph.ops.iter().enumerate() {
            if let Op::Constant(bits) = op {
                let constant = f64::from_bits(*bits);
                let known = resolution::decimal(constant);
                runner.values[id] = Block([constant; LANES]);
                (0..LANES).for_each(|lane| runner.known[id].set(lane, known));
            }
        }
        Some(runner)
    }

    /// The values at these points, a block for each input, and what the derivatives need.
    pub fn evaluate(&mut self, x: &[Block]) {
        for id in 0..self.graph.ops.len() {
            let (done, rest) = self.values.split_at_mut(id);
            let out = &mut rest[0];
            let at = |a: Id| &done[a as usize];
            match self.graph.ops[id] {
                Op::Input(place) => *out = x[place as usize],
                Op::Binary(row, a, b) => (row.block)(self.level, at(a), at(b), out),
                Op::Unary(row, a) => {
                    let a = at(a);
                    let slopes = &mut self.slopes[id];
                    for lane in 0..LANES {
                        out.0[lane] = (row.scalar)(a.0[lane]);
                        keep(slopes, lane, (row.derivatives)(a.0[lane]));
                    }
                }
                Op::Power(a, bits) => {
                    let (a, c) = (at(a), f64::from_bits(bits));
                    let slopes = &mut self.slopes[id];
                    for lane in 0..LANES {
                        let derivatives = operation::power_derivatives(a.0[lane], c);
                        out.0[lane] = derivatives[0];
                        keep(slopes, lane, derivatives);
                    }
                }
                _ => {}
            }
        }
    }

    /// What the arithmetic knows of the values that were evaluated last, and bounds of what lies beyond first order;
    /// u is the standard uncertainty of each input, all of which are independent. Marks poles within `reach` of them.
    pub fn look_around(&mut self, u: &[Block], reach: f64) {
        self.doubt = Block::ZERO;
        for id in 0..self.graph.ops.len() {
            self.know(id);
            self.bound(id, u);
            self.look_for_edges(id, reach);
        }
    }

    fn know(&mut self, id: usize) {
        let (done, rest) = self.known.split_at_mut(id);
        let out = &mut rest[0];
        let at = |a: Id| &done[a as usize];
        let mut lane_by_lane = |a: &KnownBlock, one: &dyn Fn(Known) -> Known| {
            (0..LANES).for_each(|lane| out.set(lane, one(a.at(lane))));
        };
        match self.graph.ops[id] {
            Op::Unary(row, a) => lane_by_lane(at(a), &|a| resolution::unary(row, a)),
            Op::Power(a, bits) => {
                lane_by_lane(at(a), &|a| resolution::power(a, f64::from_bits(bits)));
            }
            Op::Input(_) => {
                let x = &self.values[id];
                if twice::decimals(self.level, x, out) {
                    for lane in (0..LANES).filter(|lane| x.0[*lane].is_finite()) {
                        if out.error.0[lane].is_nan() {
                            out.set(lane, resolution::decimal(x.0[lane]));
                        }
                    }
                }
            }
            Op::Binary(row, a, b) => {
                let operation = match row.rule {
                    Rule::Add => twice::sum_blocks,
                    Rule::Sub => twice::difference_blocks,
                    Rule::Mul => twice::product_blocks,
                    _ => twice::quotient_blocks,
                };
                operation(self.level, at(a), at(b), out);
            }
            _ => {}
        }
    }

    fn bound(&mut self, id: usize, u: &[Block]) {
        let (level, apart) = (self.level, self.apart[id]);
        let (done, rest) = self.bounds.split_at_mut(id);
        let out = &mut rest[0];
        let at = |a: Id| &done[a as usize];
        match self.graph.ops[id] {
            Op::Input(place) => out.first = u[place as usize],
            Op::Unary(_, a) | Op::Power(a, _) => {
                let [first, second, third] = &self.slopes[id];
                bounds::composed(level, [first, second, third], at(a), out);
            }
            Op::Binary(row, a, b) => {
                let values = [a, b].map(|a| &self.values[a as usize]);
                match row.rule {
                    Rule::Mul => bounds::product(level, values, at(a), at(b), apart, out),
                    Rule::Div => bounds::quotient(level, values, at(a), at(b), apart, out),
                    _ => bounds::sum(level, at(a), at(b), apart, out),
                }
            }
            _ => {}
        }
    }

    fn look_for_edges(&mut self, id: usize, reach: f64) {
        let mut edges = Block::ZERO;
        let a = match self.graph.ops[id] {
            Op::Binary(row, _, b) if row.rule == Rule::Div => b,
            Op::Power(a, bits) => {
                let c = f64::from_bits(bits);
                if c >= 0.0 && c.fract() == 0.0 {
                    return;
                }
                a
            }
            Op::Unary(row, a) => {
                let Some(edge) = row.edge else { return };
                let values = &self.values[a as usize];
                for (edge_of, x) in edges.0.iter_mut().zip(&values.0) {
                    *edge_of = edge(*x);
                }
                a
            }
            _ => return,
        };
        let a = a as usize;
        if self.moves[a] {
            let (value, of) = (&self.values[a], &self.bounds[a]);
            bounds::near(self.level, value, &edges, of, reach, &mut self.doubt);
        }
    }

    /// The values of an output.
    pub fn values(&self, output: usize) -> &Block {
        &self.values[self.graph.outputs[output] as usize]
    }

    /// What the arithmetic knows of an output.
    pub fn known(&self, output: usize) -> &KnownBlock {
        &self.known[self.graph.outputs[output] as usize]
    }

    /// Bounds of the derivatives of an output, times the uncertainties.
    pub fn bounds(&self, output: usize) -> &Bounds {
        &self.bounds[self.graph.outputs[output] as usize]
    }

    /// The operations that an output is a linear combination of: the inputs of each, and its second derivatives' bound with
    /// the factor with which it enters. Holds of the output whose gradient was taken last.
    pub fn bends(&self, output: usize) -> impl Iterator<Item = (&[usize], &Block, &Block)> {
        let terms = self.terms[output].iter();
        terms.map(|(id, inputs)| {
            let (factor, second) = (&self.adjoints[*id], &self.bounds[*id].second);
            (inputs.as_slice(), factor, second)
        })
    }

    /// Not zero at the points where a pole or the end of a domain may be within reach.
    pub fn doubt(&self) -> &Block {
        &self.doubt
    }

    /// The derivatives of an output at the points that were evaluated last, a block for each input.
    pub fn gradient(&mut self, output: usize, gradient: &mut [Block]) {
        gradient.fill(Block::ZERO);
        let last = self.graph.outputs[output] as usize;
        self.adjoints[..=last].fill(Block::ZERO);
        self.adjoints[last] = Block([1.0; LANES]);
        let level = self.level;
        for id in (0..=last).rev() {
            let (operands, rest) = self.adjoints.split_at_mut(id);
            let bar = &rest[0];
            let value = |a: Id| &self.values[a as usize];
            match self.graph.ops[id] {
                Op::Input(place) => gradient[place as usize] = *bar,
                Op::Unary(_, a) | Op::Power(a, _) => {
                    adjoint::times(level, bar, &self.slopes[id][0], &mut operands[a as usize]);
                }
                Op::Binary(row, a, b) => {
                    let (at_a, at_b) = (a as usize, b as usize);
                    match row.rule {
                        Rule::Add => {
                            adjoint::term(level, bar, &mut operands[at_a]);
                            adjoint::term(level, bar, &mut operands[at_b]);
                        }
                        Rule::Sub => {
                            adjoint::term(level, bar, &mut operands[at_a]);
                            adjoint::subtracted(level, bar, &mut operands[at_b]);
                        }
                        Rule::Mul => {
                            adjoint::times(level, bar, value(b), &mut operands[at_a]);
                            adjoint::times(level, bar, value(a), &mut operands[at_b]);
                        }
                        _ => {
                            let quotient = [&self.values[id], value(b)];
                            adjoint::dividend(level, bar, value(b), &mut operands[at_a]);
                            adjoint::divisor(level, bar, quotient, &mut operands[at_b]);
                        }
                    }
                }
                _ => {}
            }
        }
    }
}

/// The operations that one is a linear combination of; itself where one of them is used in another way, too.
fn terms(graph: &Graph, of: Id) -> Vec<Id> {
    let mut reached = vec![0usize; graph.ops.len()];
    let mut uses = vec![0usize; graph.ops.len()];
    reached[of as usize] = 1;
    uses[of as usize] = 1;
    let mut found = Vec::new();
    for id in (0..=of).rev() {
        let op = graph.ops[id as usize];
        graph.operands(op, |a| uses[a as usize] += 1);
        if reached[id as usize] == 0 || matches!(op, Op::Constant(_)) {
            continue;
        }
        let mut bent = matches!(op, Op::Input(_) | Op::Power(..));
        interaction::varying_operands(graph, op, |_, nonlinear| bent |= nonlinear);
        match bent {
            true => found.push(id),
            false => graph.operands(op, |a| reached[a as usize] += 1),
        }
    }
    let only_so = |id: &Id| reached[*id as usize] == uses[*id as usize];
    match found.iter().all(only_so) {
        true => found,
        false => vec![of],
    }
}

/// Whether an operation is +, −, × or ÷.
fn is_one_of_four(rule: Rule) -> bool {
    matches!(rule, Rule::Add | Rule::Sub | Rule::Mul | Rule::Div)
}

fn keep(slopes: &mut [Block; 3], lane: usize, [_, derivatives @ ..]: [f64; 4]) {
    for (slope, derivative) in slopes.iter_mut().zip(derivatives) {
        slope.0[lane] = derivative;
    }
}
