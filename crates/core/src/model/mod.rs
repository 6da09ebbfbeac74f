//! The model language: text → syntax tree → checked → a flat tape; evaluation, derivatives, blocks,
//! printed form.
//!
//! A [`Model`] is what the five readings of a budget share: at the estimates ([`Model::values`]),
//! with derivatives ([`Model::gradients`], [`Model::along`]), on blocks of random numbers
//! ([`BlockRunner`]), with units (done by [`compile`]), and as formulas ([`Output::equation`]).
//! All numbers are in the user's units: the tape converts only where two units meet.

mod block;
mod catalogue;
mod check;
mod compiler;
mod complex;
mod curves;
mod cut;
mod digits;
mod exact;
mod exponent;
mod expressions;
pub mod faults;
mod forms;
mod functions;
mod graph;
mod hints;
mod implicit;
mod interaction;
mod jet;
mod lexer;
mod lower;
mod measurand;
mod notice;
mod operation;
mod outline;
mod parser;
mod printer;
mod reductions;
mod resolution;
mod revolutions;
mod rows;
mod scales;
mod space;
mod steps;
mod syntax;
mod terms;
mod tree;
mod twice;
mod units;

#[cfg(test)]
mod tests;

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;
use smol_str::SmolStr;

pub use block::BlockRunner;
pub use catalogue::{FunctionInfo, functions, is_reserved};
pub use check::compile;
pub use compiler::Compiler;
pub use cut::Cut;
pub use interaction::Neighbours;
pub use notice::{Notice, Office};
pub use outline::{Outline, outline};
pub use resolution::Resolved;
pub use rows::RowRunner;
pub use steps::{Operand, Step, Steps};
pub use tree::Leaf;

use jet::Jet;

use crate::quantity::{Unit, UnitTable};
use gumption_fault::Fault;

/// The names in a formula, each wherever it stands.
pub fn names(text: &str) -> Vec<(String, Range<usize>)> {
    let tokens = lexer::tokens(text, &mut Vec::new()).into_iter();
    let named = tokens.filter_map(|token| match token.kind {
        lexer::Kind::Name(name) => Some((name.to_string(), token.span)),
        _ => None,
    });
    named.collect()
}

/// A name that a model may use.
#[derive(Debug, Clone)]
pub struct Symbol {
    /// As the file calls it.
    pub name: SmolStr,
    /// Unit of its numbers; the unit one when none is stated.
    pub unit: Unit,
    /// What stands behind it.
    pub role: Role,
}

/// What stands behind a name.
#[derive(Debug, Clone)]
pub enum Role {
    /// A scalar input: its place in the input vector.
    Input(usize),
    /// A vector input: its elements occupy these places of the input vector.
    InputVector(Range<usize>),
    /// An exactly known scalar.
    Constant(f64),
    /// Exactly known numbers.
    ConstantVector(Vec<f64>),
    /// The value of another compiled model, in the symbol's unit.
    Result {
        /// The model.
        model: Arc<Model>,
        /// Which of its outputs.
        output: usize,
        /// Where each of its inputs stands in the input vector (anywhere, for those that the output
        /// does not use).
        places: Vec<usize>,
    },
}

/// A measurand as the budget file states it.
#[derive(Debug, Clone)]
pub struct MeasurandSource<'a> {
    /// As the file calls it.
    pub name: &'a str,
    /// Its own statements, the last of which gives the value; `None` where the shared model defines
    /// a quantity of this name.
    pub model: Option<&'a str>,
    /// The unit in which the value is wanted; `None` = dimension one, an error when it is not.
    pub unit: Option<Unit>,
}

/// Everything that [`compile`] needs.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    /// Inputs and constants.
    pub symbols: &'a [Symbol],
    /// Statements that every measurand sees.
    pub shared: Option<&'a str>,
    /// In the order of the file.
    pub measurands: &'a [MeasurandSource<'a>],
    /// The units that quoted unit texts may use.
    pub units: &'a UnitTable,
}

/// Which text a fault's span refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The shared model.
    Shared,
    /// The model text of this measurand.
    Measurand(usize),
    /// The entry of this measurand as a whole (missing model or unit): the span is meaningless.
    Entry(usize),
    /// The entry of this symbol as a whole (its unit is missing or unfit).
    Symbol(usize),
}

/// A fault and the text it is in.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelFault {
    /// The text.
    pub place: Place,
    /// Its spans are bytes of that text.
    pub fault: Fault,
}

/// One measurand of a compiled model.
#[derive(Debug, Clone)]
pub struct Output {
    /// As the file calls it; `G[1]`, `G[2]` … for the elements of a vector.
    pub name: String,
    /// Index of the request's measurand that it belongs to: elements of a vector have one in common.
    pub source: usize,
    /// Unit of its value.
    pub unit: Unit,
    /// The defining statements in printed form, one per line (`R = V / I * cos(phi)`).
    pub equation: String,
}

/// Derivatives of one output along a direction d of input space, at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// ∂f/∂x_i, length = number of inputs.
    pub gradient: Vec<f64>,
    /// (H d)_i = Σ_j f_ij d_j.
    pub second: Vec<f64>,
    /// Σ_jk f_ijk d_j d_k.
    pub third: Vec<f64>,
}

/// A compiled model; what copies of it have in common is there once.
#[derive(Debug, Clone)]
pub struct Model {
    inputs: usize,
    outputs: Arc<[Output]>,
    graph: Arc<graph::Graph>,
    /// For trials; arranged when the first block is run, which not every use of a model does.
    program: Arc<OnceLock<block::Program>>,
    unused: Arc<[usize]>,
    plain_angles: Arc<[usize]>,
    /// What [`Model::interactions`] has found.
    blocks: Arc<OnceLock<Vec<Option<usize>>>>,
}

impl Model {
    /// Length of the input vector.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// The measurands, in the order of the file.
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// f(x) for every output, in its unit.
    pub fn values(&self, x: &[f64]) -> Vec<f64> {
        let values = self.graph.evaluate(&points(x));
        self.graph
            .outputs
            .iter()
            .map(|id| values[*id as usize].value())
            .collect()
    }

    /// f(x) for every output by twice the precision, and how far the arithmetic knows it.
    pub fn resolved(&self, x: &[f64]) -> Vec<Resolved> {
        resolution::resolved(&self.graph, x)
    }

    /// How far the arithmetic knows an output at most, with what cancels on the way; [`Model::resolved`] does not look for that.
    pub fn error_of(&self, x: &[f64], output: usize) -> f64 {
        resolution::error_of(&self.graph, x, output)
    }

    /// The value of the first output, and its derivatives by all inputs.
    pub fn value_and_slopes(&self, x: &[f64], slopes: &mut [f64]) -> f64 {
        let values = self.graph.evaluate(&points(x));
        let id = self.graph.outputs[0];
        let gradient = self.graph.gradient(&values, id, self.inputs);
        for (slope, derivative) in slopes.iter_mut().zip(gradient) {
            *slope = derivative.value();
        }
        values[id as usize].value()
    }

    /// ∂f_o/∂x_i, outputs × inputs, by one reverse sweep per output.
    pub fn gradients(&self, x: &[f64]) -> DMatrix<f64> {
        let values = self.graph.evaluate(&points(x));
        let mut out = DMatrix::zeros(self.outputs.len(), self.inputs);
        for (row, id) in self.graph.outputs.iter().enumerate() {
            for (column, slope) in self
                .graph
                .gradient(&values, *id, self.inputs)
                .iter()
                .enumerate()
            {
                out[(row, column)] = slope.value();
            }
        }
        out
    }

    /// The graph arranged for blocks.
    fn program(&self) -> &block::Program {
        let arranged = || block::Program::new(&self.graph, self.inputs);
        self.program.get_or_init(arranged)
    }

    /// First, second and third derivatives along `direction`, for every output.
    pub fn along(&self, x: &[f64], direction: &[f64]) -> Vec<Along> {
        self.graph.along(x, direction)
    }

    /// One output, cut where many inputs meet in one value; see [`Cut`]. `None` where there are many such values,
    /// or an operation with many arguments.
    pub fn cut(&self, output: usize) -> Option<Cut<'_>> {
        let of = *self.graph.outputs.get(output)?;
        Cut::new(&self.graph, self.inputs, of)
    }

    /// Derivatives of up to third order of one output, divided by `unit`, for every input that it uses and whose
    /// variance is not zero, where each is used once; see [`Leaf`]. Takes one pass for any number of inputs.
    pub fn leaves(
        &self,
        x: &[f64],
        output: usize,
        variances: &[f64],
        unit: f64,
    ) -> Option<Vec<Leaf>> {
        let of = *self.graph.outputs.get(output)?;
        tree::leaves(&self.graph, x, of, variances, unit)
    }

    /// Whether each input takes part in any nonlinear operation; the others have no second derivatives.
    pub fn nonlinear_inputs(&self) -> Vec<bool> {
        let blocks = self.interactions();
        blocks.iter().map(Option::is_some).collect()
    }

    /// The block of each input: derivatives of second and higher order with respect to inputs of
    /// different blocks are zero. `None` for inputs that take part in no nonlinear operation.
    pub fn interactions(&self) -> Vec<Option<usize>> {
        let found = || interaction::blocks(&self.graph, self.inputs);
        self.blocks.get_or_init(found).clone()
    }

    /// For each input those with which it may have mixed derivatives, itself included; `None` where they are
    /// too many to be listed. Finer than [`Model::interactions`] where terms overlap.
    pub fn neighbours(&self) -> Option<Neighbours> {
        Neighbours::new(&self.graph, self.inputs)
    }

    /// Which inputs one output uses.
    pub fn inputs_of(&self, output: usize) -> Vec<bool> {
        let mut used = vec![false; self.inputs];
        if let Some(id) = self.graph.outputs.get(output) {
            for place in self.graph.inputs_of(*id) {
                used[place] = true;
            }
        }
        used
    }

    /// Whether every output is an affine function of these inputs while the others are held.
    pub fn is_affine_in(&self, inputs: &[usize]) -> bool {
        self.degree_in(inputs).is_some_and(|degree| degree <= 1)
    }

    /// The degree, up to the second, of the polynomials that all outputs are of these inputs together while the others
    /// are held; `None` where they are none, or of higher degree.
    pub fn degree_in(&self, inputs: &[usize]) -> Option<u8> {
        interaction::degree(&self.graph, inputs)
    }

    /// The power through which alone an output depends on an input, and whether it is in proportion to that: 0.45 of `U` in
    /// `sqrt(A + B*U^0.45)`, which is not.
    pub fn exponent_of(&self, input: usize, output: usize) -> Option<(f64, bool)> {
        exponent::of(&self.graph, output, input)
    }

    /// Which of the request's symbols no measurand depends on.
    pub fn unused_symbols(&self) -> Vec<usize> {
        self.unused.to_vec()
    }

    /// Inputs without a unit of which `sin`, `cos` or `tan` is taken as they are, in radians.
    pub fn plain_angles(&self) -> &[usize] {
        &self.plain_angles
    }

    /// Whether no operation has a corner, a step or a branch anywhere.
    pub fn is_smooth(&self) -> bool {
        hints::smooth(&self.graph)
    }

    /// Operations whose derivative does not exist or hides something at `x`: kinks, steps, branches, points
    /// of tables.
    pub fn irregularities(&self, x: &[f64]) -> Vec<Notice> {
        hints::irregularities(&self.graph, x)
    }

    /// Measurands that have no finite value at `x`, each with the operation that is to blame.
    pub fn undefined(&self, x: &[f64]) -> Vec<ModelFault> {
        hints::undefined(&self.graph, x, &self.outputs)
    }

    /// Divisors and function arguments that come within `reach` standard uncertainties of a pole or of
    /// the end of a domain, and phases that come so near to ±π, given the covariance-free u of every input.
    pub fn near_singular(&self, x: &[f64], u: &[f64], reach: f64) -> Vec<Notice> {
        hints::near_singular(&self.graph, x, u, reach)
    }

    /// The model for trials, where the distribution of a phase reaches the jump between -π and π: such phases are taken
    /// on the turn around their value at `x`, so that trials on both sides of the jump lie side by side. `None` where
    /// no phase comes within `reach` standard uncertainties of the jump.
    pub fn unrolled(&self, x: &[f64], u: &[f64], reach: f64) -> Option<Model> {
        let centres = hints::phases_at_the_jump(&self.graph, x, u, reach);
        if centres.is_empty() {
            return None;
        }
        let graph = self.graph.unrolled(&centres)?;
        Some(Model {
            graph: graph.into(),
            program: Arc::default(),
            blocks: Arc::default(),
            ..self.clone()
        })
    }

    /// Corners, conditions and steps within `reach` standard uncertainties, which first order does not see.
    pub fn near_corners(&self, x: &[f64], u: &[f64], reach: f64) -> Vec<Notice> {
        hints::near_corners(&self.graph, x, u, reach)
    }

    /// The calculation of one output step by step, as spreadsheets have it, with its values at these points. `None`
    /// where a step has no formula there.
    pub fn steps(&self, output: usize, points: &[Vec<f64>]) -> Option<Steps> {
        let of = *self.graph.outputs.get(output)?;
        Steps::new(&self.graph, of, points)
    }

    /// Roundings by `quantize` whose step is larger than the standard uncertainty of what they round.
    pub fn coarse_steps(&self, x: &[f64], u: &[f64]) -> Vec<Notice> {
        hints::coarse_steps(&self.graph, x, u)
    }
}

/// The point x, at rest.
fn points(x: &[f64]) -> Vec<Jet<1>> {
    x.iter().map(|x| Jet::constant(*x)).collect()
}
