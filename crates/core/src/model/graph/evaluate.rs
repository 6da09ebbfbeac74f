//! Values and derivatives of a graph: forwards with jets, backwards with adjoints.

use std::collections::BTreeMap;

use super::{Graph, Id, Op};
use crate::model::Along;
use crate::model::implicit;
use crate::model::jet::Jet;
use crate::model::operation::{self, Rule};

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
                    implicit::root(&equation.residual, at(equation.start).value(), &parameters)
                }
            };
            values.push(value);
        }
    }

    /// Derivatives of one operation with respect to all operations up to it, by one pass backward.
    pub fn adjoints<const N: usize>(&self, values: &[Jet<N>], of: Id) -> Vec<Jet<N>> {
        self.adjoints_of_sum(values, [(of, 1.0)])
    }

    /// The same of a weighted sum of operations, up to the last of them.
    fn adjoints_of_sum<const N: usize>(
        &self,
        values: &[Jet<N>],
        sum: impl IntoIterator<Item = (Id, f64)> + Clone,
    ) -> Vec<Jet<N>> {
        let last = sum.clone().into_iter().map(|(of, _)| of).max().unwrap_or(0);
        let mut adjoints = vec![Jet::constant(0.0); last as usize + 1];
        for (of, weight) in sum {
            adjoints[of as usize] = adjoints[of as usize] + Jet::constant(weight);
        }
        for id in (0..=last).rev() {
            let bar = adjoints[id as usize];
            if !bar.is_zero() {
                self.pass_on(values, id, bar, |operand, part| {
                    adjoints[operand as usize] = adjoints[operand as usize] + part;
                });
            }
        }
        adjoints
    }

    /// Gives each operand of an operation its part of the adjoint of the operation.
    fn pass_on<const N: usize>(
        &self,
        values: &[Jet<N>],
        id: Id,
        bar: Jet<N>,
        mut give: impl FnMut(Id, Jet<N>),
    ) {
        let at = |id: Id| values[id as usize];
        let mut pass = |id: Id, slope: Jet<N>| {
            // Where the slope is infinite but nothing moves, nothing is passed on.
            if !slope.is_zero() {
                give(id, bar * slope);
            }
        };
        match self.ops[id as usize] {
            Op::Input(_) | Op::Constant(_) | Op::Unknown(_) => {}
            Op::Unary(row, a) => pass(a, row.slope(at(a))),
            // Most of a large formula are sums, which need no product with a slope of 1.
            Op::Binary(row, a, b) if row.rule == Rule::Add => {
                give(a, bar);
                give(b, bar);
            }
            Op::Binary(row, a, b) if row.rule == Rule::Sub => {
                give(a, bar);
                give(b, -bar);
            }
            Op::Binary(row, a, b) => {
                let (da, db) = row.slopes(at(a), at(b));
                pass(a, da);
                pass(b, db);
            }
            Op::Power(a, c) => {
                let derivatives = operation::power_derivatives(at(a).value(), f64::from_bits(c));
                pass(a, at(a).compose(&derivatives[1..]));
            }
            Op::Select(c, a, b) => {
                let chosen = if at(c).value() != 0.0 { a } else { b };
                pass(chosen, Jet::constant(1.0));
            }
            Op::Solve(n) => {
                let equation = &self.implicit[n as usize];
                let parameters: Vec<Jet<N>> = equation.parameters.iter().map(|p| at(*p)).collect();
                let slopes = implicit::slopes(&equation.residual, at(id), &parameters);
                for (parameter, slope) in equation.parameters.iter().zip(slopes) {
                    pass(*parameter, slope);
                }
            }
        }
    }

    /// Derivatives of one operation with respect to the inputs that it uses, (place, derivative), in no
    /// particular order and without those that are zero: the time goes with what the operation is made of,
    /// not with the size of the graph.
    pub fn gradient_of_part<const N: usize>(
        &self,
        values: &[Jet<N>],
        of: Id,
    ) -> Vec<(usize, Jet<N>)> {
        /// A step from one operation to the next takes as long as a look at so many of them.
        const LOOKS: usize = 32;
        if let Op::Input(place) = self.ops[of as usize] {
            return vec![(place as usize, Jet::constant(1.0))];
        }
        let mut gradient = Vec::new();
        // Operands stand before what is made of them: the last one is complete.
        let mut open = BTreeMap::from([(of, Jet::constant(1.0))]);
        let mut steps = 0;
        while let Some((id, bar)) = open.pop_last() {
            self.step_back(values, id, bar, &mut gradient, |operand, part| {
                let sum = open.entry(operand).or_insert(Jet::constant(0.0));
                *sum = *sum + part;
            });
            steps += 1;
            if steps * LOOKS > id as usize {
                break;
            }
        }
        // What is left where the part is a good deal of the graph.
        let left = open.last_key_value().map_or(0, |(last, _)| last + 1);
        let mut adjoints = vec![Jet::constant(0.0); left as usize];
        for (id, bar) in open {
            adjoints[id as usize] = bar;
        }
        for id in (0..left).rev() {
            let bar = adjoints[id as usize];
            self.step_back(values, id, bar, &mut gradient, |operand, part| {
                adjoints[operand as usize] = adjoints[operand as usize] + part;
            });
        }
        gradient
    }

    /// Gives the adjoint of an operation to the gradient, if the operation is an input, or to its operands.
    fn step_back<const N: usize>(
        &self,
        values: &[Jet<N>],
        id: Id,
        bar: Jet<N>,
        gradient: &mut Vec<(usize, Jet<N>)>,
        give: impl FnMut(Id, Jet<N>),
    ) {
        if bar.is_zero() {
            return;
        }
        match self.ops[id as usize] {
            Op::Input(place) => gradient.push((place as usize, bar)),
            _ => self.pass_on(values, id, bar, give),
        }
    }

    /// First, second and third derivatives of every output along a direction.
    ///
    /// The reverse sweep is done in numbers that carry two derivatives along the direction, so the
    /// result is exact.
    pub fn along(&self, x: &[f64], direction: &[f64]) -> Vec<Along> {
        let values = self.evaluate(&line(x, direction));
        let sweep = |id: &Id| Along::new(&self.gradient(&values, *id, x.len()));
        self.outputs.iter().map(sweep).collect()
    }

    /// Third derivatives of a weighted sum of the outputs, twice along a direction.
    pub fn third_along(&self, x: &[f64], direction: &[f64], weights: &[f64]) -> Vec<f64> {
        let values = self.evaluate(&line(x, direction));
        let sum = self.outputs.iter().copied().zip(weights.iter().copied());
        let gradient = self.at_inputs(self.adjoints_of_sum(&values, sum), x.len());
        gradient.iter().map(|g| g.0[2]).collect()
    }

    /// Derivatives of one operation with respect to the inputs.
    pub fn gradient<const N: usize>(
        &self,
        values: &[Jet<N>],
        of: Id,
        inputs: usize,
    ) -> Vec<Jet<N>> {
        self.at_inputs(self.adjoints(values, of), inputs)
    }

    fn at_inputs<const N: usize>(&self, adjoints: Vec<Jet<N>>, inputs: usize) -> Vec<Jet<N>> {
        let mut gradient = vec![Jet::constant(0.0); inputs];
        for (op, adjoint) in self.ops.iter().zip(adjoints) {
            if let Op::Input(place) = op {
                gradient[*place as usize] = adjoint;
            }
        }
        gradient
    }
}

/// The point x, moving along a direction.
fn line(x: &[f64], direction: &[f64]) -> Vec<Jet<3>> {
    let pairs = x.iter().zip(direction);
    pairs.map(|(x, d)| Jet::line(*x, *d)).collect()
}

impl Along {
    fn new(gradient: &[Jet<3>]) -> Self {
        let part = |k: usize| gradient.iter().map(|g| g.0[k]).collect();
        Along {
            gradient: part(0),
            second: part(1),
            third: part(2),
        }
    }
}

fn power_value<const N: usize>(x: Jet<N>, c: f64) -> Jet<N> {
    if N == 1 {
        return Jet::constant(operation::power(x.value(), c));
    }
    x.compose(&operation::power_derivatives(x.value(), c))
}
