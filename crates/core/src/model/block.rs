//! The program for blocks of trials: instructions on few registers.

use std::sync::Arc;

use gumption_lanes::{Block, LANES, Level, level, ops, sum};

use super::Model;
use super::graph::{Graph, Id, Op};
use super::implicit::Newton;
use super::lower::Ids;
use super::operation::{Binary, Rule, Unary};
use super::terms::{self, Sums, Term};

/// An input (below the number of inputs) or a register (from there on).
type Place = usize;

#[derive(Debug, Clone)]
enum Action {
    Unary(&'static Unary, Place),
    Binary(&'static Binary, Place, Place),
    Sum(Vec<Term<Place>>),
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
    result: Target,
}

/// What takes a result.
#[derive(Debug, Clone, Copy)]
enum Target {
    Register(usize),
    /// An output, if nothing else needs the result.
    Output(usize),
}

/// A graph arranged for blocks.
#[derive(Debug, Clone)]
pub struct Program {
    inputs: usize,
    instructions: Vec<Instruction>,
    /// Registers that hold constants, and these.
    constants: Vec<(usize, f64)>,
    registers: usize,
    /// Outputs that are copied from somewhere, and from where.
    copied: Vec<(usize, Place)>,
}

impl Program {
    /// Orders the operations so that few results wait, and gives them registers.
    pub fn new(graph: &Graph, inputs: usize) -> Self {
        let operands = Operands {
            graph,
            sums: Sums::new(graph),
        };
        let (order, uses) = order(&operands);
        let mut allocator = Allocator {
            graph,
            operands,
            uses,
            place: vec![None; graph.ops.len()],
            free: Vec::new(),
            program: Program {
                inputs,
                instructions: Vec::new(),
                constants: Vec::new(),
                registers: 0,
                copied: Vec::new(),
            },
        };
        for id in order {
            allocator.emit(id);
        }
        allocator.program.copied = allocator.copied();
        allocator.program
    }
}

/// The operations in the order of evaluation: for each, the operand that was written last (as a rule
/// the one with the longest history) comes first, so that a sum over a vector needs one accumulator.
/// Beside them, how often each operation is used.
fn order(operands: &Operands) -> (Vec<Id>, Vec<usize>) {
    let graph = operands.graph;
    let mut uses = vec![0; graph.ops.len()];
    graph.outputs.iter().for_each(|id| uses[*id as usize] += 1);
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
        let first = open.len();
        operands.visit(id, |a| {
            uses[a as usize] += 1;
            open.extend((!done[a as usize]).then_some((a, false)));
        });
        open[first..].sort_unstable();
    }
    (order, uses)
}

/// What an operation takes from others when it becomes an instruction.
struct Operands<'g> {
    graph: &'g Graph,
    sums: Sums<'g>,
}

impl Operands<'_> {
    /// The operands that need a place: no constant that an instruction holds itself, and no part of a sum.
    fn visit(&self, id: Id, mut visit: impl FnMut(Id)) {
        let op = self.graph.ops[id as usize];
        if let Some((_, a)) = held(self.graph, op) {
            visit(a);
        } else if let Some(terms) = self.sums.terms(id) {
            for term in terms {
                term.map(&mut visit);
            }
        } else {
            self.graph.operands(op, visit);
        }
    }
}

/// Makes an instruction with a constant in it.
type MakeHeld = fn(Place, f64) -> Action;

/// The instruction with a constant in it that does an operation, with its operand.
fn held(graph: &Graph, op: Op) -> Option<(MakeHeld, Id)> {
    let Op::Binary(row, a, b) = op else {
        return None;
    };
    match (row.rule, graph.constant(a), graph.constant(b)) {
        (Rule::Add, Some(_), _) => Some((Action::AddScalar, b)),
        (Rule::Add, _, Some(_)) => Some((Action::AddScalar, a)),
        (Rule::Sub, _, Some(_)) => Some((|place, c| Action::AddScalar(place, -c), a)),
        (Rule::Sub, Some(_), _) => Some((Action::RsubScalar, b)),
        (Rule::Mul, Some(_), _) => Some((Action::MulScalar, b)),
        (Rule::Mul, _, Some(_)) => Some((Action::MulScalar, a)),
        (Rule::Div, Some(_), _) => Some((Action::RdivScalar, b)),
        _ => None,
    }
}

struct Allocator<'g> {
    graph: &'g Graph,
    operands: Operands<'g>,
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
        let mut done = Ids::new();
        self.operands.visit(id, |a| done.push(a));
        for a in done {
            self.release(a);
        }
        let result = match self.output_alone(id) {
            Some(output) => Target::Output(output),
            None => {
                let register = self.free.pop().unwrap_or_else(|| self.register());
                self.place[id as usize] = Some(self.program.inputs + register);
                Target::Register(register)
            }
        };
        let instruction = Instruction { action, result };
        self.program.instructions.push(instruction);
    }

    /// The output that is the only use of an operation that is still to be done.
    fn output_alone(&self, id: Id) -> Option<usize> {
        let mut outputs = self.graph.outputs.iter();
        let output = outputs.position(|output| *output == id)?;
        (self.uses[id as usize] == 1).then_some(output)
    }

    /// Outputs that no instruction writes, and where they are.
    fn copied(&mut self) -> Vec<(usize, Place)> {
        let graph = self.graph;
        let copied = graph.outputs.iter().enumerate().filter_map(|(output, id)| {
            let made = !matches!(graph.ops[*id as usize], Op::Input(_) | Op::Constant(_));
            let written = made && self.place[*id as usize].is_none();
            (!written).then(|| (output, self.place(*id)))
        });
        copied.collect()
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
        if let Some(terms) = self.operands.sums.terms(id) {
            let placed = terms.into_iter().map(|term| term.map(|a| self.place(a)));
            return Action::Sum(placed.collect());
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
        let program = model.program();
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

    /// Evaluates all outputs for 256 trials: `inputs[i]` and `outputs[o]` are blocks, of which there are as
    /// many as inputs and outputs.
    pub fn run(&mut self, inputs: &[Block], outputs: &mut [Block]) {
        for instruction in &self.program.instructions {
            let registers = &self.registers;
            let at = |place: Place| block(inputs, registers, place, self.program.inputs);
            let level = self.level;
            let out = match instruction.result {
                Target::Register(_) => &mut *self.spare,
                Target::Output(output) => &mut outputs[output],
            };
            match &instruction.action {
                Action::Unary(row, a) => (row.block)(level, at(*a), out),
                Action::Binary(row, a, b) => (row.block)(level, at(*a), at(*b), out),
                Action::Sum(parts) => {
                    let mut terms = [sum::Term::Plus(&ZERO); terms::MOST];
                    for (term, part) in terms.iter_mut().zip(parts) {
                        *term = part.map(at).of_blocks();
                    }
                    sum::sum(level, &terms[..parts.len()], out);
                }
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
            if let Target::Register(register) = instruction.result {
                std::mem::swap(&mut self.spare, &mut self.registers[register]);
            }
        }
        for (output, place) in &self.program.copied {
            outputs[*output] = *block(inputs, &self.registers, *place, self.program.inputs);
        }
    }
}

/// In the place of a term that is not there.
static ZERO: Block = Block::ZERO;

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
