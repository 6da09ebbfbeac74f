//! The measurand at 256 deviations of the components.

use gumption_lanes::{Block, LANES, Level, level, ops};

use crate::budget::{Budget, Input};
use gumption_core::model::BlockRunner;

/// Deviations of all components, and scratch space to evaluate the model there.
pub(super) struct Trial<'b> {
    inputs: &'b [Input],
    level: Level,
    /// One block per component.
    pub(super) deviations: Vec<Block>,
    values: Vec<Block>,
    output: [Block; 1],
    runner: BlockRunner<'b>,
}

impl<'b> Trial<'b> {
    /// All deviations zero.
    pub(super) fn new(budget: &'b Budget) -> Trial<'b> {
        let mut trial = Trial {
            inputs: &budget.inputs,
            level: level(),
            deviations: vec![Block::ZERO; budget.components.len()],
            values: vec![Block::ZERO; budget.model.inputs()],
            output: [Block::ZERO],
            runner: BlockRunner::new(&budget.model),
        };
        trial.move_all();
        trial
    }

    /// All inputs follow the deviations.
    pub(super) fn move_all(&mut self) {
        (0..self.inputs.len()).for_each(|input| self.follow(input));
    }

    /// These inputs follow the deviations; the others are where they were.
    pub(super) fn move_some(&mut self, inputs: &[usize]) {
        inputs.iter().for_each(|input| self.follow(*input));
    }

    fn follow(&mut self, input: usize) {
        let (of, value) = (&self.inputs[input], &mut self.values[input]);
        let mut terms = of.terms.iter().filter(|term| term.coefficient != 0.0);
        let Some(first) = terms.next() else {
            ops::fill(self.level, of.estimate, value);
            return;
        };
        let error = &self.deviations[first.component];
        if of.terms.len() == 1 {
            ops::affine(self.level, error, first.coefficient, of.estimate, value);
            return;
        }
        // The deviations are summed first, so that the estimate is added with one rounding.
        ops::mul_scalar(self.level, error, first.coefficient, value);
        for term in terms {
            let error = &self.deviations[term.component];
            ops::axpy(self.level, term.coefficient, error, value);
        }
        let sum = *value;
        ops::add_scalar(self.level, &sum, of.estimate, value);
    }

    /// The measurand's values where the inputs are.
    pub(super) fn value(&mut self) -> &Block {
        self.runner.run(&self.values, &mut self.output);
        &self.output[0]
    }
}

/// How far one standard uncertainty of each component moves the measurand up and down together, linear or not;
/// infinite where there is no value.
pub(super) fn effects(budget: &Budget) -> Vec<f64> {
    let components = &budget.components;
    let mut trial = Trial::new(budget);
    let mut effects = Vec::with_capacity(components.len());
    for start in (0..components.len()).step_by(LANES / 2 - 1) {
        let some = start..components.len().min(start + LANES / 2 - 1);
        for (component, of) in components.iter().enumerate() {
            let deviation = &mut trial.deviations[component];
            *deviation = Block::ZERO;
            if some.contains(&component) {
                let lane = 2 * (component - start);
                (deviation.0[lane], deviation.0[lane + 1]) = (of.u, -of.u);
            }
        }
        trial.move_all();
        let moved = trial.value();
        let centre = moved.0[LANES - 1];
        effects.extend(some.map(|component| {
            let lane = 2 * (component - start);
            let effect = (moved.0[lane] - centre).abs() + (moved.0[lane + 1] - centre).abs();
            if effect.is_nan() {
                f64::INFINITY
            } else {
                effect
            }
        }));
    }
    effects
}

/// Per component the inputs that it acts on.
pub(super) fn inputs_of(budget: &Budget) -> Vec<Vec<usize>> {
    let mut inputs = vec![Vec::new(); budget.components.len()];
    for (i, input) in budget.inputs.iter().enumerate() {
        for term in input.terms.iter().filter(|term| term.coefficient != 0.0) {
            inputs[term.component].push(i);
        }
    }
    inputs
}
