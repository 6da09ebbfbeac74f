//! The model language: text → syntax tree → checked → a flat tape; evaluation, derivatives, blocks,
//! printed form.
//!
//! A [`Model`] is what the five readings of a budget share: at the estimates ([`Model::values`]),
//! with derivatives ([`Model::gradients`], [`Model::along`]), on blocks of random numbers
//! ([`BlockRunner`]), with units (done by [`compile`]), and as formulas ([`Output::equation`]).
//! All numbers are in the user's units: the tape converts only where two units meet.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::fault::Fault;
use crate::quantity::{Unit, UnitTable};

/// A name that a model may use.
#[derive(Debug, Clone)]
pub struct Symbol {
    pub name: String,
    pub unit: Unit,
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
}

/// A measurand as the budget file states it.
#[derive(Debug, Clone)]
pub struct MeasurandSource<'a> {
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
    pub symbols: &'a [Symbol],
    /// Statements that every measurand sees.
    pub shared: Option<&'a str>,
    pub measurands: &'a [MeasurandSource<'a>],
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
    pub place: Place,
    pub fault: Fault,
}

/// One measurand of a compiled model.
#[derive(Debug, Clone)]
pub struct Output {
    pub name: String,
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

/// A compiled model.
#[derive(Debug, Clone)]
pub struct Model {
    inputs: usize,
    outputs: Vec<Output>,
}

/// Checks names, shapes and units of a model and compiles it.
///
/// # Errors
/// All faults of all texts.
pub fn compile(_request: &Request<'_>) -> Result<Model, Vec<ModelFault>> {
    todo!()
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
    pub fn values(&self, _x: &[f64]) -> Vec<f64> {
        todo!()
    }

    /// ∂f_o/∂x_i, outputs × inputs, by one reverse sweep per output.
    pub fn gradients(&self, _x: &[f64]) -> DMatrix<f64> {
        todo!()
    }

    /// First, second and third derivatives along `direction`, for every output.
    pub fn along(&self, _x: &[f64], _direction: &[f64]) -> Vec<Along> {
        todo!()
    }

    /// Whether each input takes part in any nonlinear operation; the others have no second derivatives.
    pub fn nonlinear_inputs(&self) -> Vec<bool> {
        todo!()
    }

    /// Which of the request's symbols no measurand depends on.
    pub fn unused_symbols(&self) -> Vec<usize> {
        todo!()
    }

    /// Operations whose derivative does not exist or hides something at `x` (kink, step, branch), in
    /// words: `abs(x - a) has a kink at 0`.
    pub fn irregularities(&self, _x: &[f64]) -> Vec<String> {
        todo!()
    }

    /// Divisors and function arguments that come within `reach` standard uncertainties of a pole or of
    /// the end of a domain, given the covariance-free u of every input: `x2 (divisor) is 1.4 u from 0`.
    pub fn near_singular(&self, _x: &[f64], _u: &[f64], _reach: f64) -> Vec<String> {
        todo!()
    }
}

/// Runs a model over blocks of 256 trials; owns the scratch registers.
#[derive(Debug, Clone)]
pub struct BlockRunner<'m> {
    model: &'m Model,
}

impl<'m> BlockRunner<'m> {
    /// Prepares the scratch registers.
    pub fn new(model: &'m Model) -> Self {
        BlockRunner { model }
    }

    /// Evaluates all outputs for 256 trials: `inputs[i]` and `outputs[o]` are blocks.
    pub fn run(&mut self, _inputs: &[gumption_lanes::Block], _outputs: &mut [gumption_lanes::Block]) {
        let _ = self.model;
        todo!()
    }
}
