//! The values of trials themselves, for whoever wants more of them than a summary.

use gumption_lanes::Block;

use super::budget_source::BudgetSource;
use super::engine::{Layout, Sink, simulate};
use super::thread_pool::ThreadPool;
use crate::budget::Budget;
use crate::propagate::options::Workers;

/// The values of all trials, one list for each measurand; the n-th values of the lists are of one trial.
pub fn draws(budget: &Budget, (seed, trials): (u64, u64), workers: Workers<'_>) -> Vec<Vec<f64>> {
    let source = BudgetSource::new(budget, seed, workers.progress);
    let layout = Layout::new(trials);
    let measurands = budget.model.outputs().len();
    let sink = || Keeper(vec![Vec::new(); measurands]);
    let chunks = layout.chunks(0..1);
    let (chunks, _) = ThreadPool::with(workers.threads, chunks.end, |pool| {
        simulate(pool, &source, layout, chunks, sink)
    });
    let of = |measurand: usize| chunks.iter().flat_map(move |chunk| chunk[measurand].iter());
    (0..measurands)
        .map(|at| of(at).copied().collect())
        .collect()
}

/// Keeps the trials of a chunk.
struct Keeper(Vec<Vec<f64>>);

impl Sink for Keeper {
    type Chunk = Vec<Vec<f64>>;

    fn take(&mut self, outputs: &[Block], lanes: usize) {
        for (kept, block) in self.0.iter_mut().zip(outputs) {
            kept.extend_from_slice(&block.0[..lanes]);
        }
    }

    fn close(&mut self) -> Self::Chunk {
        self.0.iter_mut().map(std::mem::take).collect()
    }
}
