//! Trials of a budget's model.

use std::sync::atomic::{AtomicBool, Ordering};

use gumption_lanes::{Block, LANES};

use super::engine::Source;
use super::joint_draw::{JointDraw, Scratch};
use crate::budget::Budget;
use crate::propagate::progress::Progress;
use gumption_core::model::{BlockRunner, Model};

/// Draws the inputs of a budget and evaluates its model, block by block.
pub(super) struct BudgetSource<'b> {
    model: &'b Model,
    draw: JointDraw<'b>,
    progress: &'b Progress,
    /// All trials have been drawn once.
    settled: AtomicBool,
}

impl<'b> BudgetSource<'b> {
    /// Prepares the samplers of a budget.
    pub(super) fn new(budget: &'b Budget, seed: u64, progress: &'b Progress) -> Self {
        let draw = JointDraw::new(&budget.inputs, &budget.components, &budget.groups, seed);
        BudgetSource {
            model: &budget.model,
            draw,
            progress,
            settled: AtomicBool::new(false),
        }
    }
}

/// What a thread needs to draw trials.
pub(super) struct Worker<'b> {
    runner: BlockRunner<'b>,
    scratch: Scratch,
    inputs: Vec<Block>,
}

impl<'b> Source for BudgetSource<'b> {
    type Worker = Worker<'b>;

    fn outputs(&self) -> usize {
        self.model.outputs().len()
    }

    fn worker(&self) -> Worker<'b> {
        Worker {
            runner: BlockRunner::new(self.model),
            scratch: self.draw.scratch(),
            inputs: vec![Block::ZERO; self.model.inputs()],
        }
    }

    fn start(&self, worker: &mut Worker<'b>, chunk: u64) {
        self.draw.start(&mut worker.scratch, chunk);
    }

    fn is_over(&self) -> bool {
        self.progress.is_stopped() && !self.settled.load(Ordering::Relaxed)
    }

    /// Of a run that was stopped no trial has a value: nothing is drawn, and whoever takes trials in comes to its end.
    fn next(&self, worker: &mut Worker<'b>, outputs: &mut [Block]) {
        if self.is_over() {
            outputs.fill(Block([f64::NAN; LANES]));
            return;
        }
        self.draw.next(&mut worker.scratch, &mut worker.inputs);
        worker.runner.run(&worker.inputs, outputs);
    }

    fn drawn(&self, trials: u64) {
        self.progress.count(trials);
    }

    fn settle(&self) -> bool {
        self.settled.store(true, Ordering::Relaxed);
        self.progress.is_stopped()
    }
}
