//! The program for blocks of trials: instructions on few registers.

use std::sync::Arc;

use gumption_lanes::{Block, LANES, Level, level, ops};

use super::Model;
use super::graph::{Graph, Id, Op};
use super::implicit::Newton;
use super::operation::{Binary, Unary};

/// An input (below the number of inputs) or a register (from there on).
type Place = usize;

#[derive(Debug, Clone)]
enum Action {
    Unary(&'static Unary, Place),
    Binary(&'static Binary, Place, Place),
    AddScalar(Place, f64),
    MulScalar(Place, f64),
    /// scalar - block
    RsubScalar(Place, f64),
    /// scalar / block
    RdivScalar(Place, f64),
    Powi(Place, i32),
    Power(Place, f64),
    Select(Place, Place, Place),
    Solve {
        residual: Arc<Graph>,
        start: Place,
        parameters: Vec<Place>,
    },
}

#[derive(Debug, Clone)]
struct Instruction {
    action: Action,
    /// Register that takes the result.
    out: usize,
}

/// A graph arranged for blocks.
#[derive(Debug, Clone)]
pub struct Program {
    inputs: usize,
    instructions: Vec<Instruction>,
    /// Registers that hold constants, and these.
    constants: Vec<(usize, f64)>,
    registers: usize,
    outputs: Vec<Place>,
}

impl Program {
    /// Orders the operations so that few results wait, and gives them registers.
    pub fn new(graph: &Graph, inputs: usize) -> Self {
        let order = order(graph);
        let mut uses = vec![0usize; graph.ops.len()];
        for id in &order {
            operands(graph, *id, |a| uses[a as usize] += 1);
        }
        graph.outputs.iter().for_each(|id| uses[*id as usize] += 1);
        let mut allocator = Allocator {
            graph,
            uses,
            place: vec![None; graph.ops.len()],
            free: Vec::new(),
            program: Program {
                inputs,
                instructions: Vec::new(),
                constants: Vec::new(),
                registers: 0,
                outputs: Vec::new(),
            },
        };
        for id in order {
            allocator.emit(id);
        }
        let outputs = graph
            .outputs
            .iter()
            .map(|id| allocator.place(*id))
            .collect();
        Program {
            outputs,
            ..allocator.program
        }
    }
}

/// The operations in the order of evaluation: for each, the operand that was written last (as a rule
/// the one with the longest history) comes first, so that a sum over a vector needs one accumulator.
fn order(graph: &Graph) -> Vec<Id> {
    let mut done = vec![false; graph.ops.len()];
    let mut order = Vec::new();
    let mut open: Vec<(Id, bool)> = graph.outputs.iter().rev().map(|id| (*id, false)).collect();
    while let Some((id, ready)) = open.pop() {
        if done[id as usize] {
            continue;
        }
        if ready {
            done[id as usize] = true;
            if !matches!(graph.ops[id as usize], Op::Input(_) | Op::Constant(_)) {
                order.push(id);
            }
            continue;
        }
        open.push((id, true));
        let mut needed = Vec::new();
        operands(graph, id, |a| needed.push(a));
        needed.sort_unstable();
        open.extend(
            needed
                .into_iter()
                .filter(|a| !done[*a as usize])
                .map(|a| (a, false)),
        );
    }
    order
}

/// The operands that need a place; a constant that an instruction holds itself does not.
fn operands(graph: &Graph, id: Id, mut visit: impl FnMut(Id)) {
    let op = graph.ops[id as usize];
    match held(graph, op) {
        Some((_, a)) => visit(a),
        None => graph.operands(op, visit),
    }
}

/// Makes an instruction with a constant in it.
type MakeHeld = fn(Place, f64) -> Action;

/// The instruction with a constant in it that does an operation, with its operand.
fn held(graph: &Graph, op: Op) -> Option<(MakeHeld, Id)> {
    let Op::Binary(row, a, b) = op else {
        return None;
    };
    match (row.name, graph.constant(a), graph.constant(b)) {
        ("+", Some(_), _) => Some((Action::AddScalar, b)),
        ("+", _, Some(_)) => Some((Action::AddScalar, a)),
        ("-", _, Some(_)) => Some((|place, c| Action::AddScalar(place, -c), a)),
        ("-", Some(_), _) => Some((Action::RsubScalar, b)),
        ("*", Some(_), _) => Some((Action::MulScalar, b)),
        ("*", _, Some(_)) => Some((Action::MulScalar, a)),
        ("/", Some(_), _) => Some((Action::RdivScalar, b)),
        _ => None,
    }
}

struct Allocator<'g> {
    graph: &'g Graph,
    /// Uses still to come.
    uses: Vec<usize>,
    place: Vec<Option<Place>>,
    free: Vec<usize>,
    program: Program,
}

impl Allocator<'_> {
    fn emit(&mut self, id: Id) {
        let action = self.action(id);
        // The result is computed beside the registers, so it may take the place of an operand.
        let mut done = Vec::new();
        operands(self.graph, id, |a| done.push(a));
        for a in done {
            self.release(a);
        }
        let out = self.free.pop().unwrap_or_else(|| self.register());
        self.place[id as usize] = Some(self.program.inputs + out);
        self.program.instructions.push(Instruction { action, out });
    }

    fn action(&mut self, id: Id) -> Action {
        let op = self.graph.ops[id as usize];
        if let (Some((make, a)), Op::Binary(_, x, y)) = (held(self.graph, op), op) {
            let constant = self
                .graph
                .constant(if a == x { y } else { x })
                .unwrap_or(f64::NAN);
            return make(self.place(a), constant);
        }
        match op {
            Op::Unary(row, a) => Action::Unary(row, self.place(a)),
            Op::Binary(row, a, b) => Action::Binary(row, self.place(a), self.place(b)),
            Op::Power(a, bits) => {
                let c = f64::from_bits(bits);
                let place = self.place(a);
                if c.fract() == 0.0 && c.abs() < 1e6 {
                    Action::Powi(place, c as i32)
                } else {
                    Action::Power(place, c)
                }
            }
            Op::Select(c, a, b) => Action::Select(self.place(c), self.place(a), self.place(b)),
            Op::Solve(n) => {
                let equation = &self.graph.implicit[n as usize];
                Action::Solve {
                    residual: Arc::clone(&equation.residual),
                    start: self.place(equation.start),
                    parameters: equation.parameters.iter().map(|p| self.place(*p)).collect(),
                }
            }
            Op::Input(_) | Op::Constant(_) | Op::Unknown(_) => {
                Action::AddScalar(self.place(id), 0.0)
            }
        }
    }

    fn place(&mut self, id: Id) -> Place {
        if let Some(place) = self.place[id as usize] {
            return place;
        }
        let place = match self.graph.ops[id as usize] {
            Op::Input(place) => place as usize,
            Op::Constant(bits) => {
                let register = self.register();
                self.program
                    .constants
                    .push((register, f64::from_bits(bits)));
                self.program.inputs + register
            }
            op => unreachable!("{op:?} is emitted before it is used"),
        };
        self.place[id as usize] = Some(place);
        place
    }

    fn register(&mut self) -> usize {
        self.program.registers += 1;
        self.program.registers - 1
    }

    fn release(&mut self, id: Id) {
        let uses = &mut self.uses[id as usize];
        *uses -= 1;
        let lasting = matches!(self.graph.ops[id as usize], Op::Input(_) | Op::Constant(_));
        if let (0, false, Some(place)) = (*uses, lasting, self.place[id as usize]) {
            self.free.push(place - self.program.inputs);
        }
    }
}

/// Runs a model over blocks of 256 trials; owns the scratch registers.
#[derive(Debug, Clone)]
pub struct BlockRunner<'m> {
    program: &'m Program,
    level: Level,
    #[expect(
        clippy::vec_box,
        reason = "registers change places by pointer, not by 2 KiB"
    )]
    registers: Vec<Box<Block>>,
    /// Takes a result, then changes places with its register.
    spare: Box<Block>,
}

impl<'m> BlockRunner<'m> {
    /// Prepares the scratch registers.
    pub fn new(model: &'m Model) -> Self {
        let program = &model.program;
        let mut registers = vec![Box::new(Block::ZERO); program.registers];
        for (register, value) in &program.constants {
            registers[*register].0 = [*value; LANES];
        }
        BlockRunner {
            program,
            level: level(),
            registers,
            spare: Box::new(Block::ZERO),
        }
    }

    /// Evaluates all outputs for 256 trials: `inputs[i]` and `outputs[o]` are blocks.
    pub fn run(&mut self, inputs: &[Block], outputs: &mut [Block]) {
        for instruction in &self.program.instructions {
            let registers = &self.registers;
            let at = |place: Place| block(inputs, registers, place, self.program.inputs);
            let (level, out) = (self.level, &mut *self.spare);
            match &instruction.action {
                Action::Unary(row, a) => (row.block)(level, at(*a), out),
                Action::Binary(row, a, b) => (row.block)(level, at(*a), at(*b), out),
                Action::AddScalar(a, s) => ops::add_scalar(level, at(*a), *s, out),
                Action::MulScalar(a, s) => ops::mul_scalar(level, at(*a), *s, out),
                Action::RsubScalar(a, s) => ops::rsub_scalar(level, at(*a), *s, out),
                Action::RdivScalar(a, s) => ops::rdiv_scalar(level, at(*a), *s, out),
                Action::Powi(a, n) => ops::powi(level, at(*a), *n, out),
                Action::Power(a, c) => {
                    for (out, a) in out.0.iter_mut().zip(&at(*a).0) {
                        *out = libm::pow(*a, *c);
                    }
                }
                Action::Select(c, a, b) => ops::select(level, at(*c), at(*a), at(*b), out),
                Action::Solve {
                    residual,
                    start,
                    parameters,
                } => {
                    let (start, parameters) = (at(*start), parameters.iter().map(|p| at(*p)));
                    let parameters: Vec<&Block> = parameters.collect();
                    let mut newton = Newton::new(residual);
                    for (lane, out) in out.0.iter_mut().enumerate() {
                        let root = newton.run(start.0[lane], parameters.iter().map(|p| p.0[lane]));
                        *out = root.map_or(f64::NAN, |(y, _)| y);
                    }
                }
            }
            std::mem::swap(&mut self.spare, &mut self.registers[instruction.out]);
        }
        for (out, place) in outputs.iter_mut().zip(&self.program.outputs) {
            *out = *block(inputs, &self.registers, *place, self.program.inputs);
        }
    }
}

fn block<'a>(
    inputs: &'a [Block],
    registers: &'a [Box<Block>],
    place: Place,
    count: usize,
) -> &'a Block {
    match place.checked_sub(count) {
        None => &inputs[place],
        Some(register) => &registers[register],
    }
}
