//! Fractions of the trials between given limits: conformance probabilities (JCGM 106 clause 7).

use gumption_lanes::Block;

use super::budget_source::BudgetSource;
use super::engine::{Layout, Sink, simulate};
use super::thread_pool::ThreadPool;
use crate::budget::{Budget, Interval};
use crate::propagate::options::Workers;

/// For every output and interval the fraction of its finite trials inside, with the limits; `None` where no
/// trial is finite. The trials are those of a run with this seed, drawn again.
pub(crate) fn fractions(
    budget: &Budget,
    (seed, trials): (u64, u64),
    asked: &[(usize, Interval)],
    workers: Workers<'_>,
) -> Vec<Option<f64>> {
    let source = BudgetSource::new(budget, seed, workers.progress);
    let layout = Layout::new(trials);
    let sink = || Counter {
        asked,
        counts: vec![Count::default(); asked.len()],
    };
    let chunks = layout.chunks(0..1);
    let (chunks, _) = ThreadPool::with(workers.threads, chunks.end, |pool| {
        simulate(pool, &source, layout, chunks, sink)
    });
    let sum = |index: usize| {
        let counts = chunks.iter().filter_map(|chunk| chunk.get(index));
        counts.fold(Count::default(), |a, b| Count {
            inside: a.inside + b.inside,
            finite: a.finite + b.finite,
        })
    };
    (0..asked.len())
        .map(sum)
        .map(|count| (count.finite > 0).then(|| count.inside as f64 / count.finite as f64))
        .collect()
}

/// Trials of one question.
#[derive(Debug, Clone, Copy, Default)]
struct Count {
    inside: u64,
    finite: u64,
}

/// Counts the trials of a chunk.
struct Counter<'a> {
    asked: &'a [(usize, Interval)],
    counts: Vec<Count>,
}

impl Sink for Counter<'_> {
    type Chunk = Vec<Count>;

    fn take(&mut self, outputs: &[Block], lanes: usize) {
        for ((output, interval), count) in self.asked.iter().zip(&mut self.counts) {
            let values = outputs
                .get(*output)
                .map_or(&[][..], |block| &block.0[..lanes]);
            for value in values.iter().filter(|value| value.is_finite()) {
                count.inside += u64::from(interval.contains(*value));
                count.finite += 1;
            }
        }
    }

    fn close(&mut self) -> Vec<Count> {
        let fresh = vec![Count::default(); self.asked.len()];
        std::mem::replace(&mut self.counts, fresh)
    }
}
