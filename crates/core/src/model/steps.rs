//! The calculation of an output step by step, each with the formula that spreadsheets have for it.

use super::graph::{Graph, Id, Op};
use super::jet::Jet;

/// A calculation.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    /// The steps, each of which uses earlier ones.
    pub steps: Vec<Step>,
    /// What holds the result.
    pub result: Operand,
}

/// One operation.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The formula, with `{a}`, `{b}` and `{c}` for its operands.
    pub form: &'static str,
    /// The operands.
    pub operands: Vec<Operand>,
    /// The value at each of the points.
    pub values: Vec<f64>,
}

/// What a step takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operand {
    /// An element of the input vector.
    Input(usize),
    /// A number.
    Number(f64),
    /// The value of an earlier step.
    Step(usize),
}

impl Step {
    /// The formula with its operands as they are written.
    pub fn written(&self, operand: impl Fn(Operand) -> String) -> String {
        let names = ["{a}", "{b}", "{c}"];
        let form = self.form.to_string();
        names
            .iter()
            .zip(&self.operands)
            .fold(form, |text, (name, of)| text.replace(name, &operand(*of)))
    }
}

impl Steps {
    pub(super) fn new(graph: &Graph, of: Id, points: &[Vec<f64>]) -> Option<Steps> {
        let needed = graph.needed(&[of]);
        let at = |x: &Vec<f64>| {
            let jets: Vec<Jet<1>> = x.iter().map(|x| Jet::constant(*x)).collect();
            graph.evaluate(&jets)
        };
        let values: Vec<Vec<Jet<1>>> = points.iter().map(at).collect();
        let mut places: Vec<Option<Operand>> = vec![None; graph.ops.len()];
        let mut steps = Vec::new();
        for (id, op) in graph.ops.iter().enumerate().filter(|(id, _)| needed[*id]) {
            let place = |id: Id| places[id as usize];
            let number = |bits| Operand::Number(f64::from_bits(bits));
            let (form, operands) = match *op {
                Op::Input(input) => {
                    places[id] = Some(Operand::Input(input as usize));
                    continue;
                }
                Op::Constant(bits) => {
                    places[id] = Some(number(bits));
                    continue;
                }
                Op::Unary(row, a) => (row.cells, vec![place(a)?]),
                Op::Binary(row, a, b) => (row.cells, vec![place(a)?, place(b)?]),
                Op::Power(a, exponent) => ("{a}^{b}", vec![place(a)?, number(exponent)]),
                Op::Select(condition, yes, no) => (
                    "IF({a}<>0,{b},{c})",
                    vec![place(condition)?, place(yes)?, place(no)?],
                ),
                Op::Solve(_) | Op::Unknown(_) => return None,
            };
            places[id] = Some(Operand::Step(steps.len()));
            steps.push(Step {
                form,
                operands,
                values: values.iter().map(|at| at[id].value()).collect(),
            });
        }
        Some(Steps {
            steps,
            result: places[of as usize]?,
        })
    }
}
